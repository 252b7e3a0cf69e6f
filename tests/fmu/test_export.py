import dataclasses
import importlib
import os
import stat
import zipfile
from pathlib import Path

import fmpy
import pytest
from programs import shell_script

import fmu.spec
from ehlcontact import binaries
from ehlcontact.binaries.compiler import compilers
from ehlcontact.errors import InputError
from fmu import BuildError, VerificationError, archive, export, verify
from fmu.contact_spec import contact_spec
from fmu.export import export_model
from fmu.models import fmu_model
from fmu.sources import CSRC

EXPORT = importlib.import_module("fmu.export")  # the function is `fmu.export`


@pytest.mark.parametrize("kind", [pytest.param("cubic_si", marks=pytest.mark.slow), "wide_si"])
def test_bytes_are_reproducible(fmus, elements, kind, tmp_path, monkeypatch):
    monkeypatch.setenv("EHLCONTACT_CACHE", str(tmp_path / "empty"))
    again = export(elements[kind], tmp_path / "again.fmu")
    assert again.read_bytes() == fmus[kind].read_bytes()


def spoiled(name, old, new):
    """`pack` with a library compiled from a source in which `old` is `new`."""
    pack = archive.pack

    def packed(files):
        code = {path[8:]: content for path, content in files.items() if path.startswith("sources/")}
        assert old.encode() in code[name]
        code[name] = code[name].replace(old.encode(), new.encode())
        units = [path for path in code if path.endswith(".c")]
        own = binaries.this_machine()
        (path,) = [path for path in files if path.startswith("binaries/")]
        library = binaries.build_binaries(code, units, "x", [own], fmi=2)[0].popitem()[1]
        return pack(files | {path: library})

    return packed


def test_guid_follows_content(fmus, elements, tmp_path):
    def guid(path):
        return fmpy.read_model_description(str(path)).guid

    renamed = export(elements["cubic"], tmp_path / "renamed.fmu", model_name="Other")
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
    assert "cc -std=c99" in page or "zig" in page


def test_shipped_licence_is_the_projects():
    root = Path(fmu.__file__).parents[1]
    if not (root / "LICENSE").is_file():
        pytest.skip("not a checkout")
    assert (CSRC / "licenses" / "license.txt").read_bytes() == (root / "LICENSE").read_bytes()


@pytest.mark.parametrize(
    "name", ["mit Leerzeichen und Umläuten ä ß.fmu", pytest.param("x.FMU", marks=pytest.mark.long)]
)
def test_any_file_name(elements, tmp_path, name):
    folder = tmp_path / "Prüf stand"
    folder.mkdir()
    path = export(elements["cubic_si"], folder / name, model_name="Lager 1: Wälzkontakt <&>")
    assert path == folder / name
    assert verify(path, elements["cubic_si"]).passes
    assert fmpy.read_model_description(str(path)).modelName == "Lager 1: Wälzkontakt <&>"


def test_a_file_that_is_there_is_kept_unless_it_may_go(fmus, elements, tmp_path):
    target = tmp_path / "x.fmu"
    target.write_bytes(b"old")
    with pytest.raises(InputError, match=r"a new file, or replaced with overwrite=True") as error:
        export(elements["cubic"], target)
    assert "\n" not in str(error.value) and target.read_bytes() == b"old"
    export(elements["cubic"], str(target), overwrite=True)
    assert os.listdir(tmp_path) == ["x.fmu"]
    assert target.read_bytes() == fmus["cubic"].read_bytes()
    mask = os.umask(0)
    os.umask(mask)
    assert stat.S_IMODE(target.stat().st_mode) == 0o666 & ~mask


def test_one_that_turns_up_meanwhile_is_kept(elements, tmp_path, monkeypatch):
    def meanwhile(*_):
        (tmp_path / "x.fmu").write_bytes(b"another's")

    monkeypatch.setattr(EXPORT, "require_verified", meanwhile)
    with pytest.raises(InputError, match="a new file"):
        export(elements["cubic"], tmp_path / "x.fmu")
    assert (tmp_path / "x.fmu").read_bytes() == b"another's"


def test_unwritable_target_is_one_line(elements, tmp_path, monkeypatch):
    monkeypatch.setattr(EXPORT, "fmu_files", None)  # never reached: it is told before anything is compiled
    (tmp_path / "x.fmu").mkdir()
    cases = {
        "folder that exists": tmp_path / "no" / "x.fmu",
        "not a folder": tmp_path / "x.fmu",
        "can be written": tmp_path / ("x" * 252 + ".fmu"),
        "folder that can be written to": "/proc/x.fmu",
    }
    for words, path in cases.items():
        with pytest.raises(InputError, match=words) as error:
            export(elements["cubic"], path, overwrite=True)
        assert "\n" not in str(error.value)
    assert os.listdir(tmp_path) == ["x.fmu"]


def test_the_longest_file_name_there_is(elements, tmp_path):
    """255 bytes; a temporary name that is made of it would be longer."""
    for name in ("x" * 251 + ".fmu", "ä" * 125 + "x.fmu"):
        assert len(os.fsencode(name)) == 255
        assert export(elements["cubic"], tmp_path / name).is_file()
    assert len(os.listdir(tmp_path)) == 2


def test_what_is_verified_is_what_is_written(fmus, elements, tmp_path):
    path, found = export_model(fmu_model(elements["cubic"]), tmp_path / "x.fmu")
    assert found.passes and found == verify(path, elements["cubic"])


@pytest.mark.parametrize("fault", ["differs", "computes otherwise", "does not run", "is no FMU"])
def test_nothing_is_written_that_is_not_right(elements, tmp_path, monkeypatch, fault):
    """Neither a new file nor in place of an old one."""
    (tmp_path / "old.fmu").write_bytes(b"old")
    monkeypatch.setattr(EXPORT, "require_finite", lambda model: None)
    if fault == "differs":
        wrong = dataclasses.replace(elements["cubic"], C1=0.02)
        model = dataclasses.replace(fmu_model(elements["cubic"]), spec=contact_spec(wrong))
        monkeypatch.setattr(EXPORT, "fmu_model", lambda *_, **__: model)
    elif fault == "computes otherwise":  # and says nothing wrong of itself
        monkeypatch.setattr(
            EXPORT, "pack", spoiled("model_contact.c", "times(3.0, law->K3)", "times(3.001, law->K3)")
        )
    elif fault == "does not run":
        step = "fault = model_step(&s->model, &motion, h, s->tolerance);"
        refusal = 'fault = (Fault){DISCARD, "nothing holds the ball"};'
        monkeypatch.setattr(EXPORT, "pack", spoiled("core_step.c", step, refusal))
    else:
        monkeypatch.setattr(EXPORT, "pack", lambda files: b"no zip")
    for name in ("new.fmu", "old.fmu"):
        with pytest.raises(VerificationError) as error:
            export(elements["cubic"], tmp_path / name, overwrite=True)
        assert "\n" not in str(error.value)
        if fault == "computes otherwise":
            assert error.value.found.findings == () and error.value.found.tangents > 1e-6
        if fault == "does not run":  # it says why
            assert "nothing holds the ball" in str(error.value)
    assert os.listdir(tmp_path) == ["old.fmu"] and (tmp_path / "old.fmu").read_bytes() == b"old"


@pytest.mark.parametrize("fmi", [4, 1, "2", True])
def test_only_fmi_2_and_3(elements, tmp_path, fmi):
    with pytest.raises(InputError, match="2 or 3"):
        export(elements["cubic"], tmp_path / "x.fmu", fmi=fmi)


@pytest.mark.parametrize("name", ["", "   ", "a\nb", "a\x00b", "x" * 101, 3])
def test_bad_model_name(elements, tmp_path, name):
    with pytest.raises(InputError, match="model_name"):
        export(elements["cubic"], tmp_path / "x.fmu", model_name=name)


def test_bad_element_and_suffix(elements, tmp_path):
    with pytest.raises(InputError, match="a contact element"):
        export(object(), tmp_path / "x.fmu")
    with pytest.raises(InputError, match=r"ending in \.fmu"):
        export(elements["cubic"], tmp_path / "x.zip")


def test_compiler_that_is_missing_or_fails(elements, tmp_path, monkeypatch):
    monkeypatch.setenv("EHLCONTACT_CC", "/nonexistent/cc -m64")
    with pytest.raises(BuildError, match="cannot start the C compiler"):
        export(elements["cubic"], tmp_path / "x.fmu")
    script = shell_script(tmp_path / "cc", "echo 'model.h: error: no such thing' >&2\nexit 3")
    monkeypatch.setenv("EHLCONTACT_CC", script)
    with pytest.raises(BuildError, match=r"exit code 3.*model\.h: error: no such thing") as error:
        export(elements["cubic"], tmp_path / "x.fmu")
    assert "\n" not in str(error.value)
    shell_script(tmp_path / "cc", "exit 0")
    with pytest.raises(BuildError, match="made no library"):
        export(elements["cubic"], tmp_path / "x.fmu")
    assert not (tmp_path / "x.fmu").exists()


@pytest.mark.parametrize("compiler", ["system", "zig"])
def test_either_compiler_gives_the_same_model(elements, tmp_path, monkeypatch, compiler):
    monkeypatch.delenv("EHLCONTACT_CC", raising=False)
    own = binaries.this_machine()
    found = [one for one in compilers(own) if one.is_zig == (compiler == "zig")]
    if not found:
        pytest.skip("no system C compiler")
    monkeypatch.setattr("ehlcontact.binaries.libraries.compilers", lambda target: found)
    path = export(elements["cubic"], tmp_path / "x.fmu")
    assert verify(path, elements["cubic"]).passes
    with zipfile.ZipFile(path) as archive:
        assert found[0].label in archive.read("documentation/index.html").decode()


def test_other_machines_are_told_what_to_ask_for(elements, tmp_path, monkeypatch):
    monkeypatch.setattr("platform.machine", lambda: "riscv64")
    with pytest.raises(InputError, match=r"not built for this machine, .* riscv64"):
        export(elements["cubic"], tmp_path / "x.fmu")


def test_no_library_is_called_like_a_device_of_windows(elements, tmp_path):
    assert contact_spec(elements["cubic"], "Com1").identifier == "mCom1"
    path = export(elements["cubic"], tmp_path / "x.fmu", model_name="NUL")
    with zipfile.ZipFile(path) as archive:
        (library,) = [Path(entry).stem for entry in archive.namelist() if entry.startswith("binaries/")]
    assert library == "mNUL" and fmpy.read_model_description(str(path)).modelName == "NUL"


def test_forces_beyond_floating_point_numbers(elements, tmp_path):
    """No element has them, so no FMU can."""
    with pytest.raises(InputError, match=r"spring at low = .*must be smaller or larger"):
        dataclasses.replace(elements["cubic"], K1=1e308, K2=0.0, K3=0.0)
