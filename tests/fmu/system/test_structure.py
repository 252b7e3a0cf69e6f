"""What is in a system archive, and what is refused."""

import dataclasses
import io
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import pytest
from rotor_twins import carried

from ehlcontact.errors import InputError
from fmu import VerificationError, export_system, verify_references
from fmu.archive import pack
from fmu.system.check import schema_findings
from fmu.system.export import export_verified_system
from fmu.system.parts import RotorSystem
from fmu.system.structure import SSC, SSD, SSV
from fmu.verify import verify
from reduced_models import SpringContact, jeffcott_rotor


def description(path):
    with zipfile.ZipFile(path) as archive:
        return ElementTree.fromstring(archive.read("SystemStructure.ssd"))


def files(path):
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_schema_and_another_reader(system, system_3):
    for one in (system, system_3):
        assert schema_findings(one.path.read_bytes()) == ()
    from fmpy.ssp.ssd import read_ssd

    read = read_ssd(str(system.path))
    assert [part.name for part in read.system.elements] == ["rotor", "contact_1", "contact_2"]
    assert len(read.system.connections) == 6
    with zipfile.ZipFile(system.path) as archive:
        broken = archive.read("SystemStructure.ssd").replace(b'kind="input"', b'kind="sideways"', 1)
    assert schema_findings(pack({"SystemStructure.ssd": broken}))


def test_components_are_the_fmus_that_lie_there(system, tmp_path):
    root, there = description(system.path), files(system.path)
    for component in root.iter(f"{{{SSD}}}Component"):
        file = tmp_path / Path(component.attrib["source"]).name
        file.write_bytes(there.pop(component.attrib["source"]))
        known = {v.name: v for v in fmpy.read_model_description(str(file)).modelVariables}
        said = list(component.iter(f"{{{SSD}}}Connector"))
        assert said
        for connector in said:
            variable = known[connector.attrib["name"]]
            assert connector.attrib["kind"] == variable.causality
            assert connector.find(f"{{{SSC}}}Real").attrib["unit"] == variable.unit
        for parameter in component.iter(f"{{{SSV}}}Parameter"):
            assert known[parameter.attrib["name"]].causality == "input"
    assert list(there) == ["SystemStructure.ssd"]
    for k, mount in enumerate(system.rotor.contacts, start=1):
        assert verify(tmp_path / f"contact_{k}.fmu", mount.contact).passes
    assert all(verify_references(file).passes for file in tmp_path.glob("*.fmu"))


def test_wires(system):
    """Approach and rate out, force back, for every mount; nothing has two sources."""
    root = description(system.path)
    ends = [tuple(wire.attrib.values()) for wire in root.iter(f"{{{SSD}}}Connection")]
    expected = set()
    for k in (1, 2):
        expected |= {("rotor", f"contact[{k}].{what}", f"contact_{k}", what) for what in ("approach", "rate")}
        expected.add((f"contact_{k}", "force", "rotor", f"contact[{k}].force"))
    assert set(ends) == expected and len({end[2:] for end in ends}) == len(ends)


def test_it_starts_in_equilibrium(system):
    values = {
        (component.attrib["name"], parameter.attrib["name"]): float(parameter[0].attrib["value"])
        for component in description(system.path).iter(f"{{{SSD}}}Component")
        for parameter in component.iter(f"{{{SSV}}}Parameter")
    }
    rotor = system.rotor
    for k, u in enumerate(rotor.approaches(rotor.equilibrium()), start=1):
        assert values[f"contact_{k}", "approach"] == pytest.approx(u, rel=1e-14)
    forces = [values["rotor", f"contact[{k}].force"] for k in (1, 2)]
    assert forces == pytest.approx(carried(rotor), rel=1e-9)


def test_same_input_same_bytes(parts, system, tmp_path):
    """Progress counts all libraries meanwhile."""
    told = []
    report = {"progress": lambda done, total: told.append((done, total))}
    assert export_system(parts["xy"], tmp_path / "again.ssp", **report).read_bytes() == system.path.read_bytes()
    assert told[-1][0] == told[-1][1] == 3
    assert told == sorted(told)


def test_units_are_explained(system):
    units = {unit.attrib["name"] for unit in description(system.path).iter(f"{{{SSC}}}Unit")}
    used = {real.attrib["unit"] for real in description(system.path).iter(f"{{{SSC}}}Real")}
    assert used <= units


STEP = 5e-6  # s, the default of the system of the fixture
ELEMENT = SpringContact.cubic(1e8, 0.0, 0.0, 100.0, 3e-6, 9e-6, units="SI")
BODY = {"disc_mass": 40.0, "journal_mass": 1.0, "shaft_stiffness": 2e7, "bearings": 1}
ROTOR = jeffcott_rotor(**BODY).on([ELEMENT])


def impedance(omega):
    return 1e8 + 100j * omega


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"rotor": 3}, "rotor"),
        ({"rotor": ROTOR.on([None])}, r"contacts\[0\] = None: must be one per mount: see Rotor.on"),
        ({"rotor": ROTOR.on([impedance])}, r"contacts\[0\] = .*: must be a contact element for one speed"),
        ({"rotor": ROTOR.on([SpringContact.cubic(1.0, 0.0, 0.0, 0.01, 0.7, 1.0)])}, "SI"),
        ({"speeds_rpm": 3000.0}, "speeds_rpm = 3000.0: must be left out: the rotor has no ball bearing"),
        ({"path": "x.fmu"}, "ssp"),
        ({"path": "nowhere/x.ssp"}, "folder"),
        ({"model_name": " "}, "model_name"),
        ({"step": 0.0}, "step"),
        ({"step": float("nan")}, "step"),
        ({"fmi": 1}, "fmi"),
        ({"rotor": jeffcott_rotor(**BODY, gravity=(0.0, 0.0)).on([ELEMENT])}, "load"),
    ],
)
def test_bad_input(change, told, tmp_path):
    given = {"rotor": ROTOR, "path": "x.ssp"} | change
    given["path"] = tmp_path / given["path"]
    with pytest.raises(InputError, match=told) as caught:
        export_system(given.pop("rotor"), given.pop("path"), **given)
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_a_load_that_nothing_carries(tmp_path):
    lifted = jeffcott_rotor(**BODY, gravity=(0.0, 9.81)).on([ELEMENT])
    with pytest.raises(InputError, match="carry"):
        export_system(lifted, tmp_path / "x.ssp")


def test_a_file_that_is_there_stays(tmp_path):
    path = tmp_path / "x.ssp"
    path.write_text("mine")
    with pytest.raises(InputError, match="overwrite"):
        export_system(ROTOR, path)
    assert path.read_text() == "mine"
    export_system(ROTOR, path, overwrite=True)
    assert zipfile.is_zipfile(path)


def test_a_step_too_long_for_the_system_is_refused(tmp_path):
    """1e-4 s at a journal of 1e4 rad/s: the loop of any importer would blow up."""
    with pytest.raises(VerificationError, match=r"steps of 0\.0001 s"):
        export_system(ROTOR, tmp_path / "x.ssp", step=1e-4)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("wrong", ["swapped", "missing", "renamed"])
def test_verification_finds_wrong_wires(system, wrong):
    there = files(system.path)
    text = there["SystemStructure.ssd"].decode()
    if wrong == "swapped":
        text = text.replace('endConnector="contact[1].force"', 'endConnector="contact[0].force"')
        text = text.replace('endConnector="contact[2].force"', 'endConnector="contact[1].force"').replace(
            "contact[0].force", "contact[2].force"
        )
    elif wrong == "missing":
        lines = [line for line in text.splitlines() if 'startConnector="contact[2].approach"' not in line]
        assert len(lines) == len(text.splitlines()) - 1
        text = "\n".join(lines)
    else:
        text = text.replace('startConnector="contact[2].approach"', 'startConnector="approach"')
    there["SystemStructure.ssd"] = text.encode()
    made = RotorSystem.of(system.rotor)
    content = pack(there)
    if wrong == "renamed":
        with pytest.raises(VerificationError, match="does not run"):
            made.verify(content, STEP)
    else:
        assert not made.verify(content, STEP).passes
    right = made.verify(system.path.read_bytes(), STEP)
    assert right.passes and 0.0 < right.deviation < 1e-3


def test_contents_are_readable_as_a_plain_zip(system):
    with zipfile.ZipFile(io.BytesIO(system.path.read_bytes())) as archive:
        assert archive.testzip() is None
        assert {entry.compress_type for entry in archive.infolist()} <= {zipfile.ZIP_DEFLATED, zipfile.ZIP_STORED}


@pytest.mark.parametrize(
    ("journal_mass", "C1"),
    [
        (0.05, 0.0),
        pytest.param(0.05, 1e5, marks=pytest.mark.long),
        *(
            pytest.param(*case, marks=pytest.mark.slow)
            for case in ((0.05, 1.0), (0.05, 1e3), (50.0, 0.0), (50.0, 1e5))
        ),
    ],
)
def test_default_step_runs_any_system(tmp_path, C1, journal_mass):
    """Contacts without damper, and with one that stops the journal at once; journals light and heavy."""
    rotor = jeffcott_rotor(**(BODY | {"journal_mass": journal_mass})).on([dataclasses.replace(ELEMENT, C1=C1)])
    _, found = export_verified_system(RotorSystem.of(rotor), tmp_path / "x.ssp")
    assert found.passes and found.deviation < 0.005
