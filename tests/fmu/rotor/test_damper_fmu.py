"""FMUs of rotors in squeeze film dampers, beside `simulate_rotor`: a jump, contact, partial derivatives."""

from ctypes import POINTER, c_double

import numpy as np
import pytest
from bearing_fmus import Exported
from exported import OfRotor, given, verified
from fmpy.fmi1 import FMICallException
from squeeze_films import CLEARANCE, MASS, damper, in_series, on_orbit, orbits, rigid

from ehlcontact import InputError
from fmu import export, export_system, verify_references
from fmu.driver import Exchange
from fmu.rotor.model import RotorModel
from reduced_models import SpeedProfile, simulate_rotor
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

STEP = 1e-4
FASTER = (640.0 / RPM_TO_RAD_S, 720.0 / RPM_TO_RAD_S)


MODELS = {
    "sagging": lambda: OfRotor(rigid(load=(0.0, -100.0)), {"speed_rpm": 6000.0}),
    "motor": lambda: OfRotor(rigid(load=(0.0, -100.0), seals="sealed"), {"speed_rpm": 600.0, "inertia": 0.1}),
    "jumping": lambda: OfRotor(rigid(), {"speed_rpm": FASTER[0], "start": on_orbit(orbits(640.0)[2], 640.0)}),
    "sinking": lambda: OfRotor(rigid(spring=1e3, eccentric=0.0), {"speed_rpm": 300.0}),
    "in series": lambda: OfRotor(in_series(), {"speeds_rpm": 6000.0}),
}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """``made("jumping", 3)``: exported once."""
    known = {}

    def make(name, fmi=2):
        if (name, fmi) not in known:
            model, path = MODELS[name](), tmp_path_factory.mktemp("films") / "x.fmu"
            source, keywords = given(model)
            export(source, path, fmi=fmi, **keywords)
            known[name, fmi] = Exported(path, model, fmi)
        return known[name, fmi]

    return make


@pytest.mark.parametrize(
    ("name", "fmi"),
    [("sagging", 2), *(pytest.param(*one, marks=pytest.mark.long) for one in (("motor", 3), ("in series", 2)))],
)
def test_verifies(made, name, fmi):
    one = made(name, fmi)
    found = verified(one.path, one.model)
    assert found.passes and found.motion < 1e-9
    assert verify_references(one.path).passes


@pytest.mark.long
def test_a_fault_is_found(made):
    one = made("sagging")
    thicker = rigid(load=(0.0, -100.0), viscosity=3.4e-3 * (1.0 + 1e-5))
    assert not verified(one.path, OfRotor(thicker, one.model.keywords)).passes


@pytest.mark.long
def test_a_jump_is_that_of_simulate_rotor(made):
    """Off the large orbit as the speed rises: the same motion and forces."""
    one, steps = made("jumping"), 6000
    profile = SpeedProfile.ramp(*FASTER, STEP * steps)
    start = one.model.keywords["start"]
    run = simulate_rotor(
        one.model.rotor, speed_rpm=profile, dt=STEP, until=STEP * steps, start=start, tolerance=1e-11
    )
    names = "disc.x", "disc.y", "damper[1].force_x", "damper[1].force_y", "damper[1].eccentricity_ratio"
    slave, found = one.started(speed=FASTER[0] * RPM_TO_RAD_S, force_lead=1.0, inner_step=STEP), []
    for k in range(1, steps):
        slave.set(speed=profile.at(np.array([k * STEP]))[0][0])
        slave.step_to(k * STEP)
        found.append(slave.get(*names))
    slave.free()
    wanted = np.column_stack([run.displacement, -run.force, np.hypot(*run.displacement.T) / CLEARANCE])[1:-1]
    assert wanted[:, 4].max() > 0.7 and wanted[-1, 4] < 0.55
    assert (np.abs(np.array(found) - wanted).max(axis=0) < 1e-9 * np.ptp(wanted, axis=0)).all()


@pytest.mark.long
def test_contact_is_named(made):
    """A step that would end in contact is refused, and leaves an instance that goes on."""
    one = made("sinking")
    slave = one.started(force_lead=1.0)
    slave.set(**{"disc.force_y": -2e3})
    ratios = [0.0]
    with pytest.raises(FMICallException):
        for _ in range(100_000):
            slave.step(STEP)
            ratios.append(slave.get("damper[1].eccentricity_ratio")[0])
    assert "touches its housing: the eccentricity ratio is 1 or more" in one.messages[-1]
    assert any("damper[1]: its film is thinner than a hundredth" in text for text in one.messages)
    assert 0.99 < ratios[-1] < 1.0 and (np.diff(ratios) > 0.0).all()
    slave.set(**{"disc.force_y": 2e3})
    slave.step(STEP)
    assert slave.get("damper[1].eccentricity_ratio")[0] < ratios[-1]
    slave.free()


@pytest.mark.parametrize("name", ["sagging", pytest.param("motor", marks=pytest.mark.long)])
def test_every_partial_derivative_against_differences(made, name):
    one = made(name)
    model = Exchange(one.folder, one.description, [])
    model.start()
    known = [variable.variable.name[4:-1] for variable in one.description.derivatives]
    state = np.array([0.4 * CLEARANCE, -0.5 * CLEARANCE, 0.03, -0.01, 0.3, 60.0])[: len(known)]
    outputs = "damper[1].force_x", "damper[1].force_y", "damper[1].eccentricity_ratio"
    for output in outputs:
        for k, h in enumerate((1e-5 * CLEARANCE, 1e-5 * CLEARANCE, 1e-7, 1e-7)):
            ends = []
            for way in (h, -h):
                model.place(state + way * np.eye(state.size)[k])
                ends.append(model.get(output)[0])
            model.place(state)
            difference = (ends[0] - ends[1]) / (2.0 * h)
            found = model.gradient(output, known[k])
            assert found == pytest.approx(difference, rel=1e-5, abs=1e-4 * (output == outputs[2] and k > 1))
            if name == "sagging" and output in outputs[:2]:  # the motor's shaft follows its unbalance
                rate = f"der({known[2 + outputs.index(output)]})"
                assert MASS * model.gradient(rate, known[k]) == pytest.approx(found, rel=1e-9)
    model.free()


def test_the_event_indicator_is_what_is_left_of_the_clearance(made):
    one = made("sagging")
    model, found = Exchange(one.folder, one.description, []), np.zeros(1)
    assert one.description.numberOfEventIndicators == 1
    model.start()
    for e in (0.2, 0.7):
        model.place(np.array([0.6 * e * CLEARANCE, -0.8 * e * CLEARANCE, 0.0, 0.0, 0.0]))
        model.raw.getEventIndicators(found.ctypes.data_as(POINTER(c_double)), 1)
        assert found[0] == pytest.approx(1.0 - e, rel=1e-12)
    model.free()


def test_a_damper_stays_inside(tmp_path):
    rotor = rigid()
    assert [station.name for station in RotorModel(rotor, "all").inside] == ["damper 0"]
    with pytest.raises(InputError, match="damper 0"):
        RotorModel(rotor, outside="damper 0")
    with pytest.raises(InputError, match="dampers stay inside a rotor"):
        export_system(rotor, tmp_path / "x.ssp")
    assert RotorModel(rigid(spring=0.0)).inner_step == STEP and damper().stiffness == 0.0
