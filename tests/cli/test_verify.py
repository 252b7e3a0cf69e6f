"""``ehlcontact verify``: an FMU against the reference results inside it, without its element."""

import json
import zipfile

import pytest

from fmu import export
from reduced_models import SpringContact

CUBIC = SpringContact.cubic(K1=0.624, K2=0.750, K3=-0.174, C1=0.0130, low=0.75, high=1.0)


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    return export(CUBIC, tmp_path_factory.mktemp("good") / "mit Leerzeichen ä.fmu")


def without(source, target, part, change=lambda name, content: content):
    """Copy of an FMU without the files that have `part` in their names, the others changed."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            if part not in name:
                new.writestr(name, change(name, old.read(name)))
    return target


def test_an_fmu_that_is_right(call, good):
    result = call("verify", good)
    assert result.code == 0 and result.err == ""
    rows = [line.split() for line in result.out.splitlines()]
    assert ["verified", "yes"] in rows and ["FMI", "2.0"] in rows
    for name in ("co-simulation", "model"):
        assert any(row[:1] == [name] for row in rows)
    result = call("verify", good, "--json", "-")
    document = json.loads(result.out)
    assert document["passes"] is True and document["fmu"] == str(good) and document["tolerance"] == 1e-12
    assert [one["name"] for one in document["interfaces"]] == ["co-simulation", "model exchange"]


def test_an_fmu_that_differs_from_its_references(call, good, tmp_path):
    """Another force under the first approach: exit 1, each finding in a line, the table all the same."""

    def change(name, content):
        return content.replace(b"\n0,0.", b"\n0,1.", 1) if name.endswith("Contact_ref.csv") else content

    result = call("verify", without(good, tmp_path / "x.fmu", "nothing", change))
    assert result.code == 1
    checksum, force = result.err.splitlines()
    assert checksum.endswith("CubicContact_ref.csv: not the file whose checksum the manifest has")
    assert "x.fmu: co-simulation differs from its reference results, force at time 0: by " in force
    assert ["verified", "no"] in [line.split() for line in result.out.splitlines()]


def archive(path, name):
    with zipfile.ZipFile(path, "w") as file:
        file.writestr(name, "")
    return path


def test_what_is_no_such_fmu(refused, good, tmp_path):
    for path, words in {
        archive(tmp_path / "rotor.ssp", "SystemStructure.ssd"): ("a system archive, with FMUs in its resources/",),
        archive(tmp_path / "other.fmu", "x.py"): ("other.fmu", "a readable FMU (no modelDescription.xml in it)"),
        without(good, tmp_path / "bare.fmu", "extra/"): ("bare.fmu", "an FMU with reference results in extra/"),
        without(good, tmp_path / "sources.fmu", "binaries/"): ("sources.fmu", "an FMU for co-simulation on"),
    }.items():
        refused(words, "verify", path)
