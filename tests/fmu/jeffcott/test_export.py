"""Export of Jeffcott rotors: what it refuses, what it does not write, and what it says of itself."""

import zipfile
from dataclasses import replace
from xml.etree import ElementTree

import fmpy
import numpy as np
import pytest
from exported import given, model_of, verified

from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from fmu import VerificationError, export, sources, verify
from reduced_models import OutsideValidityWarning, simulate_rotor

SAYS_NOTHING = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
SCALES = Scales(force=850.0, length=1.31e-5, time=2.1e-5, a=1.1e-4, b=9e-4, pressure=1.6e9)


@pytest.mark.parametrize(
    ("contacts", "words"),
    [
        (lambda e: [e["cubic_si"]], ("contacts", "1", "one per mount, 2")),
        (lambda e: [e["cubic_si"], e["cubic"]], ("contacts[1].units", "dimensionless", "OperatingPoint")),
        (lambda e: [e["cubic_si"], 3.0], ("contacts[1]", "3.0", "contact element")),
        (lambda e: e["cubic_si"], ("contacts", "SpringContact", "list")),
    ],
)
def test_contacts_that_do_not_fit_are_refused(rotors, elements, contacts, words, tmp_path):
    with pytest.raises(InputError) as caught:
        export(rotors["alone"].rotor.on(contacts(elements)), tmp_path / "x.fmu")
    assert all(word in str(caught.value) for word in words) and "\n" not in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_what_is_no_rotor_or_no_start_is_refused(rotors, elements, tmp_path):
    for rotor, start, word in (
        (3.0, None, "BearingSet or Rotor"),
        (rotors["alone"].rotor, 3.0, "displacements and velocities"),
    ):
        with pytest.raises(InputError, match=word):
            export(rotor, tmp_path / "x.fmu", outside="all", start=start)
    rotor = rotors["alone"].rotor
    with pytest.raises(InputError, match=r"34 supports.: must be at most 128 in 32 supports"):
        export(replace(rotor, mounts=rotor.mounts * 17), tmp_path / "x.fmu", outside="all")


@pytest.mark.parametrize("load", [(0.0, 5000.0), (1e5, 0.0)])
def test_contacts_that_do_not_carry_the_load_are_refused(rotors, elements, load, tmp_path):
    """Pulled out of the vee upwards, or sideways beyond it."""
    rotor = rotors["alone"].changed(load=load).rotor
    with pytest.raises(InputError, match="static load") as caught:
        export(rotor.on([elements["cubic_si"]] * 2), tmp_path / "x.fmu")
    assert "\n" not in str(caught.value) and not list(tmp_path.iterdir())


def test_a_file_that_is_there_is_kept(rotors, tmp_path):
    target = tmp_path / "x.fmu"
    target.write_text("kept")
    with pytest.raises(InputError, match="overwrite"):
        export(rotors["alone"].rotor, target, outside="all")
    assert target.read_text() == "kept"
    export(rotors["alone"].rotor, target, outside="all", overwrite=True)
    assert zipfile.is_zipfile(target)


def altered(monkeypatch, tmp_path, file, old, new):
    """C sources with one line that is wrong."""
    import shutil

    folder = tmp_path / "csrc"
    for here in sources.SOURCE_FOLDERS:
        shutil.copytree(here, folder, dirs_exist_ok=True)
    path = next(folder.rglob(file))
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))
    monkeypatch.setattr(sources, "SOURCE_FOLDERS", (folder,))


@SAYS_NOTHING
@pytest.mark.parametrize(
    ("name", "file", "old", "new"),
    [
        ("alone", "model_rotor.c", "r.rho = 0.8;", "r.rho = 0.9;"),
        pytest.param(
            *("cubic", "rotor_supports.c", "push = r->count[i] * force[i]", "push = force[i]"),
            marks=pytest.mark.slow,
        ),
        ("wide in y", "contact_law.c", "VR_rate].start = before", "VR_rate].start = 0.0 * before"),
        pytest.param(
            *(
                "cubic",
                "model_rotor.c",
                "rotor_take(&r, numbers + at.carried, 1.0, net)",
                "rotor_take(&r, numbers + at.carried, -1.0, net)",
            ),
            marks=pytest.mark.slow,
        ),
    ],
)
def test_nothing_wrong_is_written(rotors, monkeypatch, tmp_path, name, file, old, new):
    altered(monkeypatch, tmp_path, file, old, new)
    model, target = rotors[name], tmp_path / "x.fmu"
    source, keywords = given(model)
    with pytest.raises(VerificationError):
        export(source, target, **keywords)
    assert not target.exists()


@SAYS_NOTHING
def test_verification_tells_another_rotor(unit, rotors):
    one = unit("cubic")
    assert verified(one.path, one.model).passes
    stiffer = 1.001 * one.model.settings["shaft_stiffness"]
    for change in ({"shaft_stiffness": stiffer}, {"bearings": 3}):
        other = replace(one.model.changed(**change), start=one.model.state)
        assert not verified(one.path, other).passes
    with pytest.raises(InputError, match=r"must be an FMU of .*2 supports outside.; it is one of"):
        verified(one.path, rotors["alone"])
    with pytest.raises(
        InputError, match=r"^contacts = None: must be one per mount, 2, or outside=\('contact 0', "
    ):
        verify(one.path, rotors["alone"].rotor)


@SAYS_NOTHING
def test_page_of_a_rotor_reads_well(unit):
    """What its references are is said once."""
    one = unit("mixed")
    page = zipfile.ZipFile(one.path).read("documentation/index.html").decode()
    assert page.lower().count("from each row") == 1 and "unbalances grow" in page


def test_least_inner_step_is_declared(rotors):
    """So that an importer refuses it itself, before it repeats what is refused for ever."""
    spec = model_of(rotors["mixed"]).spec
    assert 0.0 < spec["inner_step"].minimum <= 1e-6 * spec["inner_step"].start


def test_elements_for_another_speed_say_so(rotors, elements, tmp_path):
    with pytest.warns(OutsideValidityWarning, match="133"):
        export(rotors["alone"].rotor.on([elements["wide_si"]] * 2), tmp_path / "x.fmu")


@SAYS_NOTHING
def test_a_start_is_where_it_begins(rotors, tmp_path):
    rest, _ = rotors["alone"].state
    start = rest + np.repeat([1e-6, -2e-6], 2), np.array([0.1, 0.2, 0.3, 0.4])
    path = export(rotors["alone"].rotor, tmp_path / "x.fmu", outside="all", start=start)
    starts = {v.name: v.start for v in fmpy.read_model_description(str(path)).modelVariables}
    found = [
        float(starts[f"{body}.{what}{axis}"])
        for what in ("", "velocity_")
        for body in ("disc", "journal")
        for axis in "xy"
    ]
    assert found == np.concatenate(start).tolist()


@SAYS_NOTHING
def test_units_flanges_and_what_depends_on_what(unit):
    description = fmpy.read_model_description(str(unit("alone").path))
    known = {v.name: v for v in description.modelVariables}
    wanted = {
        "journal.x": "m",
        "disc.velocity_y": "m/s",
        "contact[1].force": "N",
        "unbalance[1]": "kg.m",
        "speed": "rad/s",
    }
    assert {name: known[name].unit for name in wanted} == wanted
    by = {v.variable.name: [d.name for d in v.dependencies] for v in description.outputs}
    assert by["journal.x"] == ["journal.x"] and by["contact[2].approach"] == [
        "journal.x",
        "journal.y",
    ]  # no feedthrough
    with zipfile.ZipFile(unit("alone", 3).path) as archive:
        flanges = ElementTree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml")).findall(
            ".//Terminal"
        )
    members = [[m.get("variableName") for m in flange] for flange in flanges]
    assert members[:2] == [[f"contact[{i}].approach", f"contact[{i}].rate", f"contact[{i}].force"] for i in (1, 2)]
    with zipfile.ZipFile(unit("wide", 3).path) as archive:
        icons = ElementTree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    assert {flange.get("name") for flange in icons.findall(".//Terminal")} == {
        f"{body}_{axis}" for body in ("disc", "journal") for axis in "xy"
    }


def test_spec_of_one_axis_names_no_other(rotors):
    assert not any(v.name.endswith(("_x", "_x)")) for v in model_of(rotors["wide in y"]).spec.variables)


@pytest.mark.long
@SAYS_NOTHING
def test_without_a_load_nothing_stands(rotors, elements, tmp_path):
    """A rotor alone needs none."""
    still = {"gravity": (0.0, 0.0), "load": (0.0, 0.0), "unbalance": 0.0, "speed_rpm": 0.0}
    rotor = rotors["alone"].changed(**still).rotor
    assert export(rotor, tmp_path / "x.fmu", outside="all").exists()
    with pytest.raises(InputError, match="static load"):
        export(rotor.on([elements["cubic_si"]] * 2), tmp_path / "y.fmu")
    state = rotors["cubic"].state
    assert export(rotor.on([elements["cubic_si"]] * 2), tmp_path / "z.fmu", start=state).exists()


@SAYS_NOTHING
def test_it_is_much_faster_than_simulate_rotor(instance, rotors):
    """At least five times here, under fmpy and on a machine that does other things; 15 and more alone."""
    from time import perf_counter

    model, steps, dt = rotors["wide"], 400, 1e-5
    slave = instance("wide")
    slave.start(force_lead=0.0, inner_step=dt)
    slave.step(dt)
    ratios = []
    for _ in range(3):
        began = perf_counter()
        for _ in range(steps):
            slave.step(dt)
        ours, began = perf_counter() - began, perf_counter()
        simulate_rotor(model.running(), dt=dt, until=steps * dt)
        ratios.append((perf_counter() - began) / ours)
    assert max(ratios) > 5.0
