"""Reference results inside an FMU, and the check of an FMU against them alone: it has to be able to fail."""

import dataclasses
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import numpy as np
import pytest
from fmpy.util import read_csv, read_ref_opt_file

from ehlcontact.binaries import build_binaries, this_machine
from ehlcontact.errors import InputError
from fmu import VerificationError, export, verify, verify_references
from fmu.archive import pack
from fmu.contact_spec import contact_spec
from fmu.references.contact_references import contact_references
from fmu.references.files import FOLDER, MANIFEST, _manifest, reference_files
from fmu.references.series import References, Trial, floored


def altered(source, target, change):
    """Copy of an FMU whose files by path have been through `change`."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name, content in change({name: old.read(name) for name in old.namelist()}).items():
            new.writestr(name, content)
    return target


def resealed(files):
    """The files with a manifest that knows them as they are."""
    inner = {name.removeprefix(f"{FOLDER}/"): text for name, text in files.items() if name.startswith(FOLDER)}
    del inner[MANIFEST]
    return files | {f"{FOLDER}/{MANIFEST}": _manifest(inner)}


def test_every_kind_is_what_its_references_say(fmus, any_kind):
    found = verify_references(fmus[any_kind])
    assert found.passes and found.findings == () and found.fmi == "2.0" and found.tolerance == 1e-12
    assert [one.name for one in found.interfaces] == ["co-simulation", "model exchange"]
    assert all(0.0 < one.difference <= 1e-14 for one in found.interfaces)  # what 15 digits are good for
    assert {"force", "stiffness", "damping", "outside_force"} <= set(found.interfaces[0].variables)
    assert found.to_dict()["passes"] is True
    told = repr(found).splitlines()
    assert told[0] == "ReferenceCheck: passes: FMI 2.0, differences up to 1e-12 are allowed" and len(told) == 3
    assert [line.split(":")[0].strip() for line in told[1:]] == ["co-simulation", "model exchange"]


@pytest.mark.parametrize("kind", ["power_si", "wide"])
def test_so_it_is_in_fmi_3(fmus3, kind):
    found = verify_references(fmus3[kind])
    assert found.passes and found.fmi == "3.0" and len(found.interfaces) == 2


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_the_motion_loads_and_parts(elements, any_kind):
    """A pulse of load beyond the box, a lift-off and a return; every flag of the motion is seen on and off."""
    element = elements[any_kind]
    found = contact_references(element, contact_spec(element))
    u, v, force = (*found.steps.knowns.values(), found.steps.unknowns["force"])
    parted = force == 0.0
    assert u.max() > element.high and 5 < parted.sum() < 60
    assert not parted[0] and not parted[-1] and v[0] == 0.0
    assert {True, False} == set(found.steps.unknowns["outside_validity"].tolist())
    steps = np.diff(found.steps.time)
    assert steps.min() == pytest.approx(0.01 * steps[0], rel=1e-3) and steps.max() == pytest.approx(2.0 * steps[0])
    if element.state_count:
        driven = element.drive(found.steps.time, u, v)
        assert np.all(np.abs(force - driven) <= 1e-14 * floored(driven, force.max()))
        rates = [column for name, column in found.points.unknowns.items() if name.startswith("der(")]
        assert len(rates) == element.state_count
        # no derivative is a small difference of large numbers
        assert all(np.median(np.abs(column)) > 1.0 / element._units[2] for column in rates)
        assert 0 < (found.points.unknowns["force"] > 0.0).sum()
    else:
        assert np.all(np.abs(force - element.force(u, v)) <= 1e-15 * floored(force, force.max()))


def test_files_are_small_and_the_same_again(elements, any_kind, fmus):
    element = elements[any_kind]
    spec = contact_spec(element)
    files = reference_files(contact_references(element, spec), spec)
    with zipfile.ZipFile(fmus[any_kind]) as archive:
        stored = {entry.filename: entry for entry in archive.infolist() if entry.filename.startswith(FOLDER)}
        assert {name: archive.read(name) for name in stored} == files
    assert sum(entry.compress_size for entry in stored.values()) < 11_000


def test_files_are_those_of_the_cross_check(fmus, tmp_path):
    folder = Path(fmpy.extract(str(fmus["wide"]), unzipdir=str(tmp_path))) / FOLDER
    given, results = read_csv(folder / "WideContact_in.csv"), read_csv(folder / "WideContact_ref.csv")
    options = read_ref_opt_file(folder / "WideContact_ref.opt")
    assert given.dtype.names == ("time", "approach", "rate") and results.dtype.names[:2] == ("time", "force")
    assert options["StopTime"] == results["time"][-1] and options["StepSize"] == results["time"][1]
    parts = {entry.get("source") for entry in ElementTree.parse(folder / MANIFEST).getroot()}
    assert parts | {MANIFEST} == {path.name for path in folder.iterdir()}


@pytest.mark.parametrize("kind", ["cubic", "memory", "wide_si"])
def test_any_importer_finds_them_again(fmus, kind, tmp_path):
    """As fmpy simulates: inputs at the start of a step, and its end is looked at; the finer the closer."""
    unpacked = str(fmpy.extract(str(fmus[kind]), unzipdir=str(tmp_path)))
    name = fmpy.read_model_description(unpacked).coSimulation.modelIdentifier
    stem = str(Path(unpacked, FOLDER, name))
    given, results, options = (
        read_csv(f"{stem}_in.csv"),
        read_csv(f"{stem}_ref.csv"),
        read_ref_opt_file(f"{stem}_ref.opt"),
    )
    errors = []
    for parts in (1, 5):
        run = fmpy.simulate_fmu(
            unpacked, input=given, stop_time=options["StopTime"], output_interval=options["StepSize"] / parts,
            output=["force"], relative_tolerance=options["RelTol"], fmi_type="CoSimulation",
            start_values={"lead": 1.0},
        )  # fmt: skip
        gap = np.interp(results["time"], run["time"], run["force"]) - results["force"]
        errors.append(np.abs(gap).max() / results["force"].max())
    assert errors[1] < 5e-3 and errors[1] < 0.5 * errors[0]


@pytest.mark.parametrize(
    ("kind", "source", "old", "new", "wrong"),
    [
        ("cubic", "model_contact.c", "times(3.0, law->K3)", "times(3.0000001, law->K3)", "stiffness"),
        pytest.param(
            *("wide", "config.h", "#define LAG_RATE 5.4", "#define LAG_RATE 5.4000001", "force"),
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_coefficient_altered_in_the_source_is_found(fmus, tmp_path, kind, source, old, new, wrong):
    def change(files):
        code = {path[8:]: text for path, text in files.items() if path.startswith("sources/")}
        assert old.encode() in code[source]
        code[source] = code[source].replace(old.encode(), new.encode())
        units = [path for path in code if path.endswith(".c")]
        (path,) = [path for path in files if path.startswith("binaries/")]
        library = build_binaries(code, units, "x", [this_machine()], fmi=2)[0].popitem()[1]
        return files | {path: library}

    found = verify_references(altered(fmus[kind], tmp_path / "x.fmu", change))
    assert not found.passes and found.findings == ()
    assert {one.variable for one in found.interfaces} & {wrong, f"step_{wrong}", "der(q[1])"}
    assert max(one.difference for one in found.interfaces) > 1e-10


def number_changed(name, column, row):
    """Change of a table of an FMU: one number, by a part in 1e9, or from false to true."""

    def change(files):
        path = next(path for path in files if path.endswith(name))
        lines = files[path].decode().splitlines()
        words = lines[1 + row].split(",")
        k = [word.strip('"') for word in lines[0].split(",")].index(column)
        value = float(words[k])
        words[k] = repr(value * (1.0 + 1e-9)) if not column.startswith("outside") else repr(1.0 - value)
        lines[1 + row] = ",".join(words)
        return files | {path: ("\n".join(lines) + "\n").encode()}

    return change


@pytest.mark.parametrize(
    ("table", "column", "row"),
    [
        ("_ref.csv", "force", 0),
        ("_ref.csv", "stiffness", 40),
        ("_ref.csv", "damping", 115),
        ("_ref.csv", "step_damping", 60),
        ("_ref.csv", "outside_rate", 30),
        ("_me_ref.csv", "force", 8),
        ("_me_ref.csv", "der(y)", 11),
        ("_me_ref.csv", "der(q[8])", 11),
        ("_in.csv", "approach", 50),
        ("_me_in.csv", "q[3]", 4),
    ],
)
def test_a_number_altered_in_the_references_is_found(fmus, tmp_path, table, column, row):
    """By the checksum of the file; and with another checksum by the number."""
    table = f"WideContact{table}"
    change = number_changed(table, column, row)
    found = verify_references(altered(fmus["wide"], tmp_path / "a.fmu", change))
    assert not found.passes
    assert found.findings == (f"{table}: not the file whose checksum the manifest has",)
    found = verify_references(altered(fmus["wide"], tmp_path / "b.fmu", lambda files: resealed(change(files))))
    assert not found.passes and found.findings == ()
    worst = max(found.interfaces, key=lambda one: one.difference)
    assert worst.name == ("model exchange" if "_me_" in table else "co-simulation")
    if table.endswith("ref.csv"):
        assert worst.variable == column and worst.difference >= 0.99e-9


def cut(name):
    return lambda files: {path: text for path, text in files.items() if not path.endswith(name)}


def replaced(name, old, new):
    def change(files):
        path = next(path for path in files if path.endswith(name))
        assert old in files[path]
        return resealed(files | {path: files[path].replace(old, new, 1)})

    return change


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda files: {p: t for p, t in files.items() if "extra" not in p}, "an FMU with reference results in"),
        (cut("_ref.csv"), "readable reference results .*No such file"),
        (replaced("_in.csv", b"\n", b"\nx"), r"_in\.csv, row 2: time is 'x0', must be a finite number"),
        (replaced("_ref.csv", b"\n", b"\n1,2\n"), r"_ref\.csv, row 2: 2 entries, there must be \d+"),
        (replaced("_ref.csv", b"force", b"power"), "no variable power in the FMU"),
        (replaced("_ref.csv", b"\n0,", b"\nnan,"), r"_ref\.csv, row 2: time is 'nan', must be a finite number"),
        (replaced("_me_in.csv", b"\n1,", b"\n7,"), "times that do not increase"),
        (replaced("experiments.exp", b"1e-12", b"1e12"), "tolerance"),
        (replaced("experiments.exp", b"<Experiments", b"<Experiment"), "mismatched tag"),
        (replaced(".ssv", b'"0.0"', b'"nil"'), "readable reference results"),
        (lambda files: files | {"modelDescription.xml": b"<x/>"}, "a readable FMU"),
        (lambda files: {p: t for p, t in files.items() if "binaries" not in p}, "an FMU for co-simulation on"),
    ],
)
def test_what_cannot_be_read_is_said_in_one_line(fmus, tmp_path, change, words):
    with pytest.raises(InputError, match=words) as error:
        verify_references(altered(fmus["cubic"], tmp_path / "x.fmu", change))
    assert "\n" not in str(error.value) and str(tmp_path) in str(error.value)


def test_what_is_missing_or_does_not_run_is_a_finding(fmus, tmp_path):
    """The manifest itself, a file of it; one interface of two without references; a step that is refused."""
    found = verify_references(altered(fmus["cubic"], tmp_path / "a.fmu", cut(MANIFEST)))
    assert not found.passes and found.findings[0].startswith(MANIFEST)
    found = verify_references(altered(fmus["cubic"], tmp_path / "b.fmu", cut(".opt")))
    assert found.findings == ("CubicContact_ref.opt: in the manifest, but not in the FMU",)
    renamed = replaced("experiments.exp", b'name="model exchange"', b'name="something else"')
    found = verify_references(altered(fmus["cubic"], tmp_path / "c.fmu", renamed))
    assert found.findings == ("model exchange: no reference results",) and len(found.interfaces) == 1
    wild = replaced("CubicContact_in.csv", b"\n0,0.8,", b"\n0,1e300,")
    found = verify_references(altered(fmus["cubic"], tmp_path / "d.fmu", wild))
    (finding,) = found.findings
    assert finding.startswith("co-simulation: does not run (")


def test_export_does_not_write_what_its_references_contradict(elements, tmp_path, monkeypatch):
    """Made of another element than what the FMU was verified against."""
    other = dataclasses.replace(elements["cubic"], C1=0.0131)
    monkeypatch.setattr("fmu.models.contact_references", lambda element, spec: contact_references(other, spec))
    with pytest.raises(VerificationError, match=r"differs from its reference results: .*damping"):
        export(elements["cubic"], tmp_path / "x.fmu")
    assert list(tmp_path.iterdir()) == []


def test_references_of_other_models(elements, tmp_path):
    """Nothing in the files is of contacts: other inputs and parameters, or one interface alone."""
    spec = contact_spec(elements["cubic"])
    time = np.array([0.0, 1.0, 2.0])
    trial = Trial(time, {"rate": np.array([0.0, 0.1, 0.2])}, {"force": np.array([1.0, 2.0, 3.0])})
    files = reference_files(References(trial, None, {"K1": 0.7, "lead": 0.5}, 1e-9), spec)
    assert {Path(name).name for name in files} == {
        MANIFEST, "experiments.exp", "CubicContact.ssv",
        *(f"CubicContact_{ending}" for ending in ("in.csv", "ref.csv", "ref.opt")),
    }  # fmt: skip
    path = export(elements["cubic"], tmp_path / "x.fmu")
    with zipfile.ZipFile(path) as archive:
        old = {n: archive.read(n) for n in archive.namelist() if not n.startswith("extra")}
    (tmp_path / "y.fmu").write_bytes(pack(old | files))
    found = verify_references(tmp_path / "y.fmu")
    assert found.tolerance == 1e-9 and found.findings == ("model exchange: no reference results",)
    assert found.interfaces[0].rows == 3 and found.interfaces[0].difference > 0.1


def test_a_rate_of_a_film_is_compared_to_its_own_terms(fmus, elements):
    """A lag that is wrong by 2e-11 is told as that, and not as a share of the fastest filter."""
    slower = dataclasses.replace(elements["wide"], lag_rate=elements["wide"].lag_rate * (1.0 + 2e-11))
    found = verify(fmus["wide"], slower)
    assert 1.5e-11 < found.exchange < 2.5e-11
