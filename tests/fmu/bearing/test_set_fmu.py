"""FMUs of sets of bearings whose shaft is moved from outside, beside the set in Python."""

from pathlib import Path

import numpy as np
import pytest
from bearing_fmus import OIL, Exported
from fmpy.fmi1 import FMICallException

from ehlcontact import InputError
from fmu import export, verify, verify_references
from fmu.bearing.references import force_scales
from fmu.bearing.set_model import SetModel
from fmu.bearing.set_variables import set_spec
from fmu.bearing.trial import START, bearing_trial
from fmu.bearing.variables import FORCES, RATES, bearing_spec
from reduced_models import BallBearing, BearingSet
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

RPM = 8000.0
LOAD = (20.0, -150.0, 60.0, 0.2, 0.5)
SPINDLE = BallBearing.catalogue("7205", oil=OIL)
SETS = {
    "pair": BearingSet.pair(SPINDLE, "back to back", preload=300.0),
    "spring": BearingSet.pair(SPINDLE, "back to back", spring=250.0),
    "three": BearingSet(
        bearings=(SPINDLE, SPINDLE, SPINDLE), facings=("+z", "+z", "-z"), positions=(-0.03, 0.0, 0.03)
    ).preloaded(400.0),
    # deep groove, with losses and inertia of the balls, beside a dry one
    "mixed": BearingSet(
        bearings=(
            BallBearing.catalogue("6205", oil=OIL, clearance="CN", loss_factor=0.05, ball_inertia=True),
            BallBearing.catalogue("7205"),
        ),
        facings=("+z", "-z"),
        positions=(-0.03, 0.05),
        offsets=(2e-5, 5e-6),
        may_lift_off=True,
    ),
}


FORCES_OF_SHAFT = ("force_x", "force_y", "force_z", "moment_x", "moment_y")


class ExportedSet(Exported):
    """The FMU of a set."""

    def started(self, **values):
        labels = (seat.label for seat in self.model.seats)
        return super().started(lead=0.0, **{f"{label}cage_angle_start": START for label in labels}, **values)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """``made("pair", 2)``: exported once."""
    known = {}

    def make(name, fmi=2):
        if (name, fmi) not in known:
            path = tmp_path_factory.mktemp("set") / "x.fmu"
            export(SETS[name], path, speeds_rpm=RPM, load=LOAD, fmi=fmi)
            known[name, fmi] = ExportedSet(path, SetModel(SETS[name], RPM, LOAD), fmi)
        return known[name, fmi]

    return make


def driven(slave, model, trial):
    """Forces of an FMU along a trial, shape (k, n)."""
    names = (*model.directions, *(RATES[name] for name in model.directions), "speed")
    rows = np.column_stack([trial.place, trial.velocity, trial.speed]).tolist()
    found = []
    for time, row in zip(trial.time.tolist(), rows, strict=True):
        slave.set(**dict(zip(names, row, strict=True)))
        if time > 0.0:
            slave.step_to(time)
        found.append(slave.get(*(FORCES[name] for name in model.directions)))
    slave.free()
    return np.array(found)


def test_variables_of_a_set():
    """Those of a bearing alone under its label; the loose ring is moved from outside, its spring in the force."""
    dry = BearingSet.pair(BallBearing.catalogue("7205", ball_inertia=True), spring=250.0)
    model = SetModel(dry, RPM, LOAD)
    spec = set_spec(model)
    assert model.directions == ("x", "y", "z", "tilt_x", "tilt_y", "outer_ring.z")
    alone = bearing_spec(model.seats[0].model)
    for name in ("force_z", "ball[3].contact_angle_inner", "ball[2].w", "offset", "outside_load"):
        assert spec[f"bearing[2].{name}"].unit == alone[name].unit
    assert [v.name for v in spec.inputs][:7] == [*model.directions, "velocity_x"]
    assert set(spec["bearing[2].force_x"].depends) >= {"z", "outer_ring.z", "bearing[2].ball[1].w", "speed"}
    assert "bearing[1].ball[1].w" not in spec["bearing[2].force_x"].depends
    assert "outer_ring.z" not in spec["bearing[1].force_x"].depends
    moved = spec["outer_ring.force_z"].depends
    assert "bearing[2].ball[1].w" in moved and "bearing[1].ball[1].w" not in moved
    assert model.constant_force.tolist() == [0.0] * 5 + [250.0]
    assert len(spec.states) == 2 * len(alone.states) == len(spec.derivatives)


@pytest.mark.long
@pytest.mark.parametrize(("name", "fmi"), [("spring", 2), ("pair", 3), ("three", 2), ("mixed", 2)])
def test_forces_are_those_of_python(made, name, fmi):
    """Another run than that of the verification: longer, other vibrations, the speed falls."""
    one = made(name, fmi)
    trial = bearing_trial(one.model, steps=250, dt=8e-6, seed=7)
    gaps = np.abs(driven(one.started(), one.model, trial) - trial.force) / force_scales(trial)
    assert gaps.max() < 1e-9
    found = verify(one.path, SETS[name], speeds_rpm=RPM, load=LOAD)
    assert found.passes and 0.0 < found.bearing < 1e-9
    assert verify_references(one.path).passes
    assert Path(one.path).stat().st_size < 6e5
    other = BearingSet.from_dict(SETS[name].to_dict() | {"positions": [1.001 * at for at in SETS[name].positions]})
    assert not verify(one.path, other, speeds_rpm=RPM, load=LOAD).passes


@pytest.mark.long
@pytest.mark.parametrize("name", ["spring", "pair"])
def test_it_starts_in_equilibrium(made, name):
    """Forces on the shaft are against the load, those on rings under the spring none."""
    one, bearings = made(name), SETS[name]
    rest = bearings.equilibrium(LOAD, speed_rpm=RPM, cage_angle=START)
    slave = one.started()
    assert slave.get(*FORCES_OF_SHAFT) == pytest.approx(-np.array(LOAD), rel=1e-6, abs=0.0)
    assert slave.get(*one.model.directions[:5]) == pytest.approx(rest.displacement, rel=1e-5, abs=0.0)
    if name == "spring":
        assert abs(slave.get("outer_ring.force_z")[0]) < 1e-6 * bearings.spring
    along = slave.get("bearing[1].force_z", "bearing[2].force_z")
    assert -np.array(along) == pytest.approx(rest.axial_forces, rel=1e-6, abs=0.0)
    assert slave.get("bearing[2].force_z")[0] < 0.0 < slave.get("bearing[2].smallest_film")[0]
    slave.free()


@pytest.mark.long
def test_offsets_are_parameters(made):
    """Offsets and clearances of each bearing are those of its preload until others are set."""
    one = made("pair")
    known = {variable.name: variable for variable in one.description.modelVariables}
    more = BearingSet.pair(SPINDLE, "back to back", preload=350.0)
    for k in (1, 2):
        assert float(known[f"bearing[{k}].offset"].start) == SETS["pair"].offsets[k - 1]
    model = SetModel(more, RPM, LOAD)
    trial = bearing_trial(model, steps=40)
    given = {f"bearing[{k}].offset": more.offsets[k - 1] for k in (1, 2)}
    place = dict(zip(model.directions, model.place.tolist(), strict=True))
    gaps = np.abs(driven(one.started(**given, **place), model, trial) - trial.force) / force_scales(trial)
    assert gaps.max() < 1e-9
    for wrong in ({"bearing[2].offset": float("nan")}, {"bearing[2].film": -1.0}):
        with pytest.raises(FMICallException):
            one.started(**wrong)


@pytest.mark.long
def test_leaving_the_tables_names_the_bearing(made):
    one = made("pair")
    slave = one.started()
    slave.set(speed=1.5 * RPM * RPM_TO_RAD_S)
    slave.step(1e-6)
    assert slave.flag("outside_validity") and slave.flag("bearing[1].outside_speed")
    slave.set(speed=RPM * RPM_TO_RAD_S, z=1.5e-4)
    for _ in range(20):
        slave.step(1e-6)
    assert slave.flag("bearing[1].outside_load") and not slave.flag("bearing[2].outside_load")
    slave.free()
    words = [message for message in one.messages if "tables" in message]
    assert len(words) == 2 and "speed above the tables" in words[0] and "bearing[1]" in words[1]


@pytest.mark.parametrize(
    ("keywords", "field"),
    [
        ({"speeds_rpm": RPM, "outside": "all"}, "outside"),
        ({"speeds_rpm": RPM, "inertia": 0.1}, "inertia"),
        ({"speeds_rpm": RPM, "directions": ("x", "y")}, "directions"),
        ({"speeds_rpm": RPM, "mass": np.eye(5), "directions": ("x", "y")}, "directions"),
        ({"speeds_rpm": 1e6}, "speeds_rpm"),
        ({"speeds_rpm": RPM, "load": (0.0, 0.0, 1e6, 0.0, 0.0)}, "load"),
        ({"speeds_rpm": RPM, "load": 500.0}, "shape of load"),
        ({}, "speeds_rpm"),
    ],
)
def test_bad_keywords(tmp_path, keywords, field):
    with pytest.raises(InputError) as error:
        export(SETS["pair"], tmp_path / "x.fmu", **keywords)
    assert error.value.field == field


def test_sets_that_are_too_large():
    many = BearingSet.tandem(SPINDLE, 12)
    with pytest.raises(InputError, match=r"^balls = '156 in 12 bearings': must be at most 128 in 32 bearings"):
        SetModel(many, RPM)
