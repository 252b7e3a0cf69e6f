import dataclasses
import importlib
import json
import os
import zipfile

import numpy as np
import pytest

from ehlcontact.errors import InputError
from fmu import export, verify
from fmu.references.contact_references import film_motion, state_grid
from reduced_models import BallBearing, BearingMount, Rotor, jeffcott_rotor


def test_fmu_agrees_with_element(fmus, elements, any_kind):
    found = verify(fmus[any_kind], elements[any_kind])
    assert found.passes
    assert found.findings == ()
    assert max(found.force, found.tangents, found.derivatives, found.exchange) <= 1e-12
    assert json.loads(json.dumps(found.to_dict()))["passes"] is True
    told = repr(found).splitlines()
    assert told[0].startswith(f"Verification: passes: {found.states} states compared, {found.outside} of them")
    assert f"force {found.force:.2g}, " in told[1] and len(told) == 2
    # The comparison is worth something: states of every kind were met.
    least = 5 if elements[any_kind].state_count else 100
    assert min(found.outside, found.parted, found.states - found.outside) > least


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")  # on purpose
def test_motion_of_a_film_parts_and_is_loaded(elements, film_kind):
    element = elements[film_kind]
    T, u, v = film_motion(element)
    force, time = element.drive(T, u, v) / element._units[0], element._units[2]
    assert force.min() == 0.0 and force.max() > 2.0
    assert np.diff(T).min() == pytest.approx(1e-3 * time) and np.diff(T).max() == pytest.approx(time)
    middle = slice(1, -1)
    slopes = (element.spring(u + 1e-6 * u.max()) - element.spring(u - 1e-6 * u.max()))[middle]
    assert (slopes >= 0.0).all() and np.sign(v).min() < 0.0 < np.sign(v).max()


def test_grid_reaches_every_branch(elements, spring_kind):
    element = elements[spring_kind]
    u, v = state_grid(element)
    spring = element.spring(u)
    assert (u > element.high).any()
    assert ((u < element.low) & (spring > 0)).any()
    assert (spring == 0).any()
    assert ((spring > 0) & (element.force(u, v) == 0)).any()  # clipped by the damper
    assert {element.low, element.high} <= set(u.tolist())


def test_element_without_damper(elements, tmp_path):
    from fmu import export

    element = dataclasses.replace(elements["cubic"], C1=0.0)
    found = verify(export(element, tmp_path / "x.fmu"), element)
    assert found.passes


@pytest.mark.parametrize("change", [{"K1": 0.624 * (1 + 1e-9)}, {"C1": 0.02}, {"high": 1.01}])
def test_another_element_is_found_out(fmus, elements, change):
    found = verify(fmus["cubic"], dataclasses.replace(elements["cubic"], **change))
    assert not found.passes and repr(found).startswith("Verification: fails: ")
    (finding,) = [line for line in found.findings if line.startswith(next(iter(change)))]
    assert "in the FMU" in finding
    assert max(found.force, found.tangents) > 1e-12


def test_units_are_compared(fmus, elements):
    same_numbers = dataclasses.replace(elements["cubic"], units="SI")
    found = verify(fmus["cubic"], same_numbers)
    assert not found.passes
    assert found.force <= 1e-12
    assert any(line.startswith("force:") and "[N]" in line for line in found.findings)


@pytest.mark.parametrize(
    ("name", "field"),
    [
        ("force", "force"),
        ("stiffness", "tangents"),
        ("damping", "tangents"),
        ("force / approach", "derivatives"),
        ("force / rate", "derivatives"),
        ("outside_validity", "flags"),
    ],
)
def test_whatever_an_fmu_gets_wrong_is_told(fmus, elements, monkeypatch, name, field):
    """Each output by itself; all else is as it should be."""
    verification = importlib.import_module("fmu.verify")
    walk = verification.walk

    def slightly_wrong(slave, trials):
        outputs, column = walk(slave, trials), list(trials.steps.unknowns).index(name)
        if field == "flags":
            outputs[:3, column] = 1.0 - outputs[:3, column]
        else:
            outputs[:, column] *= 1.0 + 1e-9
        return outputs

    monkeypatch.setattr(verification, "walk", slightly_wrong)
    found = verify(fmus["cubic"], elements["cubic"])
    wrong = {"force": 1e-9, "tangents": 1e-9, "derivatives": 1e-9, "flags": 3}
    assert not found.passes and found.findings == ()
    assert getattr(found, field) == pytest.approx(wrong[field], rel=1e-3)
    assert all(getattr(found, other) <= 1e-12 for other in wrong if other != field)


def rewritten(source, target, change, suffix=".xml"):
    """Copy of an FMU with `change` done to the content of the files ending in `suffix`."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            new.writestr(name, change(content) if name.endswith(suffix) else content)
    return target


def test_findings_of_fmpy_are_reported(fmus, elements, tmp_path):
    broken = rewritten(
        fmus["cubic"], tmp_path / "x.fmu", lambda xml: xml.replace(b'<Unit name="1">', b'<Unit name="one">')
    )
    found = verify(broken, elements["cubic"])
    assert not found.passes
    assert any("unit" in line.lower() for line in found.findings)


@pytest.mark.parametrize(
    "case",
    [
        (".xml", lambda c: c.replace(b'guid="{', b'guid="{0'), "wrong GUID"),
        (".xml", lambda c: c.replace(b'name="force"', b'name="power"'), "without force as variable"),
        (
            ".xml",
            lambda c: c.replace(b'valueReference="2"', b'valueReference="22"'),
            "an FMU of 'Rolling contact as a cubic spring with a viscous damper'; it is one of 'Rolling",
        ),
        (".xml", lambda c: c[: len(c) // 2], "readable"),
        (".so", lambda c: b"no library", "Failed to load shared library"),
    ],
)
def test_foreign_fmu_is_refused(fmus, elements, tmp_path, case, capfd):
    suffix, change, reason = case
    broken = rewritten(fmus["cubic"], tmp_path / "x.fmu", change, suffix)
    folder = os.getcwd()
    with pytest.raises(InputError, match=reason) as error:
        verify(broken, elements["cubic"])
    assert os.getcwd() == folder
    assert "\n" not in str(error.value)
    assert capfd.readouterr().out == ""


def test_not_an_fmu(elements, tmp_path):
    text = tmp_path / "x.fmu"
    for path in (tmp_path / "missing.fmu", text):
        with pytest.raises(InputError, match="a readable FMU") as error:
            verify(path, elements["cubic"])
        assert "\n" not in str(error.value)
        text.write_text("no zip")


def test_bad_element(fmus):
    with pytest.raises(InputError, match="element"):
        verify(fmus["cubic"], "cubic")


JEFFCOTT = jeffcott_rotor(
    bearings=1,
    disc_mass=2.0,
    journal_mass=0.3,
    shaft_stiffness=2e8,
    load=(0.0, -850.0),
    unbalance=4e-5,
    speed_rpm=8000.0,
)
BEARING = BallBearing.catalogue("6205")
ROTOR = Rotor(mass=np.eye(2), stiffness=np.zeros((2, 2)), mounts=(BearingMount(bearing=BEARING, x=0, y=1),))


def test_fmu_of_another_kind(fmus, elements):
    words = (
        r"must be an FMU of 'Rolling contact with a film memory.*'; it is one of 'Rolling contact as a cubic.*'"
    )
    with pytest.raises(InputError, match=words):
        verify(fmus["cubic"], elements["memory"])


@pytest.mark.parametrize(
    ("model", "keywords", "words"),
    [
        (JEFFCOTT, {}, r"^contacts = None: must be one per mount, 1, or outside=\('contact 0',\)"),
        (
            JEFFCOTT,
            {"outside": ["contact 1"]},
            r"^outside = 'contact 1': must be 'contact 0' \(its variables are contact\[1\]\), or 'all'$",
        ),
        (
            JEFFCOTT.on([np.exp]),
            {"outside": "all"},
            r"^contacts\[0\] = 'ufunc': must be a contact element for one speed",
        ),
        (
            JEFFCOTT,
            {"outside": "all", "speeds_rpm": 3e3},
            r"^speeds_rpm = 3000.0: must be left out: no ball bearing",
        ),
        (ROTOR, {}, r"^speeds_rpm = None: must be those of the ball bearings inside, or outside=\('bearing 0',\)"),
        (
            ROTOR,
            {"outside": "all", "speeds_rpm": 3000.0},
            "^speeds_rpm = 3000.0: must be left out: no ball bearing",
        ),
        (ROTOR, {"outside": "bearing 0", "load": 3.0}, r"^load = 3.0: must be left out for a Rotor"),
        (BEARING, {"outside": "all"}, r"^outside = 'all': must be left out for a ball bearing"),
        (
            BEARING,
            {"speeds_rpm": 3000.0, "directions": ("x",)},
            r"^directions = \['x'\]: must be \('x', 'y'\) or ",
        ),
        (
            "cubic",
            {},
            r"^model = 'cubic': must be a contact element .*, BallBearing, BearingSet or Rotor",
        ),
    ],
)
def test_keywords_are_those_of_the_model(fmus, tmp_path, model, keywords, words):
    """Of an export and of a verification alike."""
    for call in (
        lambda: export(model, tmp_path / "x.fmu", **keywords),
        lambda: verify(fmus["cubic"], model, **keywords),
    ):
        with pytest.raises(InputError, match=words) as caught:
            call()
        assert "\n" not in str(caught.value)
    assert not list(tmp_path.iterdir())
