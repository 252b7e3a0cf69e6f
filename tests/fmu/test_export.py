import os
import stat
import zipfile
from pathlib import Path

import fmpy
import pytest

import fmu
from ehlcontact.errors import InputError
from fmu import BuildError, export_contact, verify
from fmu.build import CSRC, find_compiler


def test_bytes_are_reproducible(fmus, elements, kind, tmp_path):
    again = export_contact(elements[kind], tmp_path / "again.fmu")
    assert again.read_bytes() == fmus[kind].read_bytes()


def test_guid_follows_content(fmus, elements, tmp_path):
    def guid(path):
        return fmpy.read_model_description(str(path)).guid

    renamed = export_contact(elements["cubic"], tmp_path / "renamed.fmu", model_name="Other")
    assert len({guid(fmus["cubic"]), guid(fmus["cubic_si"]), guid(fmus["linear"]), guid(renamed)}) == 4


def test_archive_layout(fmus):
    with zipfile.ZipFile(fmus["cubic"]) as archive:
        names = archive.namelist()
        assert archive.testzip() is None
        assert {i.date_time for i in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        page = archive.read("documentation/index.html").decode()
    assert names == sorted(names)
    assert "binaries/linux64/CubicContact.so" in names
    assert {"documentation/licenses/license.txt", "documentation/licenses/fmi2-headers.txt"} <= set(names)
    assert {f"sources/{f}" for f in ("config.h", "fmi2.c", "model_contact.c", "fmi2Functions.h")} <= set(names)
    assert "outside_validity" in page
    assert "ziglang cc" in page or "cc -std=c99" in page


def test_shipped_licence_is_the_projects():
    root = Path(fmu.__file__).parents[1]
    if not (root / "LICENSE").is_file():
        pytest.skip("not a checkout")
    assert (CSRC / "licenses" / "license.txt").read_bytes() == (root / "LICENSE").read_bytes()


@pytest.mark.parametrize("name", ["mit Leerzeichen und Umläuten ä ß.fmu", "x.FMU"])
def test_any_file_name(elements, tmp_path, name):
    folder = tmp_path / "Prüf stand"
    folder.mkdir()
    path = export_contact(elements["cubic_si"], folder / name, model_name="Lager 1: Wälzkontakt <&>")
    assert path == folder / name
    assert verify(path, elements["cubic_si"]).passes
    assert fmpy.read_model_description(str(path)).modelName == "Lager 1: Wälzkontakt <&>"


def test_replaces_in_one_move_and_leaves_nothing_behind(fmus, elements, tmp_path):
    target = tmp_path / "x.fmu"
    target.write_bytes(b"old")
    export_contact(elements["cubic"], str(target))
    assert os.listdir(tmp_path) == ["x.fmu"]
    assert target.read_bytes() == fmus["cubic"].read_bytes()
    mask = os.umask(0)
    os.umask(mask)
    assert stat.S_IMODE(target.stat().st_mode) == 0o666 & ~mask


def test_unwritable_target_is_one_line(elements, tmp_path):
    with pytest.raises(InputError, match="folder that exists") as missing:
        export_contact(elements["cubic"], tmp_path / "no" / "x.fmu")
    (tmp_path / "x.fmu").mkdir()
    with pytest.raises(InputError, match="can be written") as directory:
        export_contact(elements["cubic"], tmp_path / "x.fmu")
    for error in (missing, directory):
        assert "\n" not in str(error.value)
    assert os.listdir(tmp_path) == ["x.fmu"]


@pytest.mark.parametrize("fmi", [3, 1, "2", True])
def test_only_fmi_2(elements, tmp_path, fmi):
    with pytest.raises(InputError, match="FMI 3 is not built yet"):
        export_contact(elements["cubic"], tmp_path / "x.fmu", fmi=fmi)


@pytest.mark.parametrize("name", ["", "   ", "a\nb", "a\x00b", "x" * 101, 3])
def test_bad_model_name(elements, tmp_path, name):
    with pytest.raises(InputError, match="model_name"):
        export_contact(elements["cubic"], tmp_path / "x.fmu", model_name=name)


def test_bad_element_and_suffix(elements, tmp_path):
    with pytest.raises(InputError, match="a contact element"):
        export_contact(object(), tmp_path / "x.fmu")
    with pytest.raises(InputError, match=r"ending in \.fmu"):
        export_contact(elements["cubic"], tmp_path / "x.zip")


def test_compiler_that_is_missing_or_fails(elements, tmp_path, monkeypatch):
    monkeypatch.setenv("EHLCONTACT_CC", "/nonexistent/cc -m64")
    assert find_compiler() == ("/nonexistent/cc", "-m64")
    with pytest.raises(BuildError, match="cannot start the C compiler"):
        export_contact(elements["cubic"], tmp_path / "x.fmu")
    script = tmp_path / "cc"
    script.write_text("#!/bin/sh\necho 'model.h: no such thing' >&2\nexit 3\n")
    script.chmod(0o755)
    monkeypatch.setenv("EHLCONTACT_CC", str(script))
    with pytest.raises(BuildError, match=r"exit code 3(.|\n)*model\.h: no such thing"):
        export_contact(elements["cubic"], tmp_path / "x.fmu")
    script.write_text("#!/bin/sh\nexit 0\n")
    with pytest.raises(BuildError, match="made no library"):
        export_contact(elements["cubic"], tmp_path / "x.fmu")
    assert not (tmp_path / "x.fmu").exists()


def test_no_compiler_at_all(monkeypatch):
    monkeypatch.delenv("EHLCONTACT_CC", raising=False)
    monkeypatch.setattr("fmu.build.find_spec", lambda name: None)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(BuildError, match="no C compiler: install"):
        find_compiler()


def test_system_compiler_gives_the_same_model(elements, tmp_path, monkeypatch):
    monkeypatch.setattr("fmu.build.find_spec", lambda name: None)
    monkeypatch.delenv("EHLCONTACT_CC", raising=False)
    try:
        find_compiler()
    except BuildError:
        pytest.skip("no system C compiler")
    assert verify(export_contact(elements["cubic"], tmp_path / "x.fmu"), elements["cubic"]).passes


def test_other_platforms_are_refused(elements, tmp_path, monkeypatch):
    monkeypatch.setattr("platform.machine", lambda: "riscv64")
    with pytest.raises(BuildError, match="not on Linux riscv64"):
        export_contact(elements["cubic"], tmp_path / "x.fmu")
