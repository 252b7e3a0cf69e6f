"""FMUs of rotors with their ball bearings inside, beside `simulate_rotor`; parameters, torque, faults, masters."""

from dataclasses import replace

import numpy as np
import pytest
from bearing_fmus import (
    OIL,
    POLAR,
    Exported,
    assert_speeds_are_reached,
    assert_states_start_as_declared,
    pressed_pair,
)
from exported import OfRotor, given, verified
from fmpy.fmi1 import FMICallException

from ehlcontact import InputError, Lubricant, OilLayer
from fmu import export, verify, verify_references
from fmu.rotor.model import RotorModel
from reduced_models import (
    BallBearing,
    BearingSet,
    Disc,
    Rotor,
    Shaft,
    Support,
    Unbalance,
    rotor_on_bearings,
    simulate_rotor,
)
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.rotor.speed_profile import SpeedProfile
from reduced_models.rotor.supports import BearingMount

SPEEDS, INERTIA, STEP = (6000.0, 7000.0), 0.03, 1e-5
RINGS = [f"bearing[{b}].{k}" for b in (1, 2) for k in "xy"]
FORCES = [f"bearing[{b}].force_{k}" for b in (1, 2) for k in "xy"]


def flexible(**more):
    """On two 6205, with a disc out of the middle and an unbalance of 90 N at 7000 rev/min, which lifts it."""
    bearing = BallBearing.catalogue("6205", oil=OIL, clearance=5e-6)
    disc = Disc(position=0.25, mass=4.0, unbalance=1.7e-4, phase=0.3, **more)
    return rotor_on_bearings(
        Shaft(length=0.4, diameter=0.03, damping_time=1e-5, elements=2, density=0.0),
        discs=[disc],
        supports=[Support(position=at, bearing=bearing, journal_mass=0.2) for at in (0.02, 0.38)],
    )


def rigid():
    """On two bearings that differ: a dry one, whose balls part, and one whose films lose their force."""
    dry = BallBearing.catalogue("6205", clearance=5e-6)
    thin = BallBearing.catalogue("6204", oil=OIL, clearance=4e-6, cutoff_gap=1e-6, loss_factor=0.05)
    return Rotor(
        mass=np.diag([2.0, 2.0, 1.5, 1.5]),
        stiffness=np.zeros((4, 4)),
        mounts=(BearingMount(bearing=dry, x=0, y=1), BearingMount(bearing=thin, x=2, y=3)),
        load=np.array([0.0, -40.0, 10.0, -30.0]),
        unbalances=(Unbalance(x=2, y=3, amount=1e-4, phase=-0.7),),
        nodes={"a": {"x": 0, "y": 1}, "b": {"x": 2, "y": 3}},
    )


def axial():
    """A shaft that is rigid along itself, so that its bearings share a direction."""
    bearing = BallBearing.catalogue("6205", oil=OIL, clearance=5e-6)
    return rotor_on_bearings(
        Shaft(length=0.4, diameter=0.03, elements=2, damping_time=1e-5),
        discs=[Disc(position=0.25, mass=4.0, unbalance=1e-4, load=(0.0, 0.0, 80.0))],
        supports=[Support(position=at, bearing=bearing) for at in (0.02, 0.38)],
    )


def let_go():
    """On two 6305 under 2 kN each: light journals, which forces of the trial throw off at 8 m/s."""
    bearing = BallBearing.catalogue("6305", oil=Lubricant.iso_vg(46, temperature=80.0))
    bent = np.kron(np.outer([0.5, -1.0, 0.5], [0.5, -1.0, 0.5]), np.eye(2))  # the disc against both journals' mean
    return Rotor(
        mass=np.diag(np.repeat([0.15, 2.0, 0.15], 2)),
        stiffness=2e8 * bent,
        damping=60.0 * bent + np.diag([0.0, 0.0, 1.0, 1.0, 0.0, 0.0]),
        mounts=tuple(BearingMount(bearing=bearing, x=k, y=k + 1) for k in (0, 4)),
        load=np.array([0.0, -1.5, 0.0, -3997.0, 0.0, -1.5]),
        unbalances=(Unbalance(x=2, y=3, amount=4e-5),),
        nodes={name: {"x": k, "y": k + 1} for k, name in ((0, "left"), (4, "right"), (2, "disc"))},
    )


def layered():
    """On two 6305 with a thin layer of oil."""
    oil = Lubricant.iso_vg(46, temperature=80.0)
    bearing = BallBearing.catalogue("6305", oil=oil, supply=OilLayer(3e-7))
    return rotor_on_bearings(
        Shaft(length=0.4, diameter=0.03, damping_time=1e-5, elements=2),
        discs=[Disc(position=0.25, mass=4.0, unbalance=1e-4, load=(0.0, -2000.0, 0.0))],
        supports=[Support(position=at, bearing=bearing) for at in (0.02, 0.38)],
    )


MODELS = {
    "layered": lambda: OfRotor(layered(), {"speeds_rpm": (2000.0, 10000.0)}),
    "let go": lambda: OfRotor(let_go(), {"speeds_rpm": 10000.0}),
    "flexible": lambda: OfRotor(flexible(), {"speeds_rpm": SPEEDS, "speed_rpm": SPEEDS[0]}),
    "motor": lambda: OfRotor(flexible(), {"speeds_rpm": SPEEDS, "speed_rpm": SPEEDS[0], "inertia": INERTIA}),
    "rigid": lambda: OfRotor(rigid(), {"speeds_rpm": 6000.0}),
    "five": lambda: OfRotor(pressed_pair(), {"speeds_rpm": 3000.0, "inertia": POLAR}),
    "axial": lambda: OfRotor(axial(), {"speeds_rpm": 3000.0}),
}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """``made("motor", 3)``: exported once."""
    known = {}

    def make(name, fmi=2):
        if (name, fmi) not in known:
            model, path = MODELS[name](), tmp_path_factory.mktemp("whole") / "x.fmu"
            source, keywords = given(model)
            export(source, path, fmi=fmi, **keywords)
            known[name, fmi] = Exported(path, model, fmi)
        return known[name, fmi]

    return make


@pytest.mark.parametrize(
    ("name", "fmi"),
    [
        ("five", 2),
        pytest.param("flexible", 2, marks=pytest.mark.long),
        *(pytest.param(name, 3, marks=pytest.mark.long) for name in ("motor", "rigid", "let go")),
        pytest.param(
            "layered",
            2,
            marks=[
                pytest.mark.long,
                pytest.mark.filterwarnings("ignore:.*below zero:reduced_models.OutsideValidityWarning"),
            ],
        ),
        pytest.param("axial", 3, marks=pytest.mark.slow),
    ],
)
def test_verifies(made, name, fmi):
    one = made(name, fmi)
    found = verified(one.path, one.model)
    assert found.passes and found.motion < 1e-9
    # with oil all over, a ball always carries a little
    assert (found.parted > 100) == (name in ("rigid", "let go", "layered"))
    assert verify_references(one.path).passes


@pytest.mark.long
@pytest.mark.parametrize("name", ["flexible", "let go"])
def test_a_fault_of_a_millionth_is_found(made, name):
    """A force that is 1e-6 too large, and a mass: with few balls that part, and with hundreds."""
    one, rotor = made(name), MODELS[name]().rotor
    bearing = rotor.mounts[0].bearing
    stiffer = replace(bearing, youngs_modulus=bearing.youngs_modulus * (1.0 + 1e-6))
    for faulty in (
        replace(rotor, mounts=tuple(replace(mount, bearing=stiffer) for mount in rotor.mounts)),
        replace(rotor, mass=rotor.mass * (1.0 + 1e-6)),
    ):
        found = verified(one.path, OfRotor(faulty, one.model.keywords))
        assert found.motion > 1e-6 and not found.passes
        assert all(": start " in one for one in found.findings)  # places at rest, which are other ones


def run_up(one, profile, steps):
    slave, found = one.started(speed=profile.at(np.zeros(1))[0][0], force_lead=1.0), []
    for k in range(1, steps + 1):
        slave.set(speed=profile.at(np.array([k * STEP]))[0][0])
        slave.step_to(k * STEP)
        found.append(slave.get("disc.x", "disc.y", *RINGS, *FORCES))
    slave.free()
    return np.array(found)


def by_simulate_rotor(rotor, profile, steps, **more):
    found = simulate_rotor(rotor, speed_rpm=profile, dt=STEP, until=steps * STEP, **more)
    disc = found.displacement[:, [rotor.nodes["disc"][k] for k in "xy"]]
    return np.column_stack([disc, found.ring.reshape(len(disc), -1), -found.force])[1:]


def test_is_simulate_rotor(made):
    """In a run-up of two turns whose unbalance lifts the rotor off, with one table of speeds for both."""
    one, steps = made("flexible"), 2000
    profile = SpeedProfile.ramp(*SPEEDS, STEP * steps)
    assert one.model.model.bearings[0].speeds.tolist() == pytest.approx([6000.0, 7000.0])
    wanted = by_simulate_rotor(one.model.rotor, profile, steps)[:-1]  # the ramp has ended at the last of them
    found = run_up(one, profile, steps - 1)
    assert wanted[:, 7].min() < -20.0 < 20.0 < wanted[:, 7].max()  # N: pushed up, and down
    assert (np.abs(found - wanted).max(axis=0) < 1e-9 * np.ptp(wanted, axis=0)).all()
    coarse = by_simulate_rotor(one.model.rotor, profile, steps, rho_inf=0.7)[:-1]
    assert np.abs(coarse - wanted).max(axis=0).max() > 1e-6 * np.ptp(wanted, axis=0).max()


def test_a_preload_that_is_set_is_that_of_the_mount(made):
    one = made("five")
    rotor = one.model.rotor
    tighter = replace(rotor, mounts=(rotor.mounts[0], replace(rotor.mounts[1], offset=11e-6)))
    rest = tighter.equilibrium(3000.0)
    slave = one.started(**{"bearing[2].offset": 3e-6})
    found = slave.get(*(f"rotor.{name}" for name in rotor.nodes["rotor"]))
    slave.free()
    assert found == pytest.approx(rest, rel=1e-6, abs=1e-15)
    assert abs(rest[2]) > 1e-6


def test_states_start_as_declared(made):
    one = made("five")
    own = 2 * one.model.rotor.size + 2  # motions, angle and speed
    assert_states_start_as_declared(one, len(one.description.derivatives) - own)


def test_starts_in_equilibrium_with_the_parameters_that_are_set(made, tmp_path):
    one = made("flexible")
    rotor = one.model.rotor
    wide = replace(rotor.ball_bearings[1], bearing=replace(rotor.ball_bearings[1].bearing, clearance=12e-6))
    other = replace(
        rotor,
        mounts=(rotor.mounts[0], wide),
        mass=1.3 * rotor.mass,
        stiffness=0.8 * rotor.stiffness,
        damping=2.0 * rotor.damping,
        load=0.9 * rotor.load,
    )
    values = {
        "mass_scale": 1.3,
        "stiffness_scale": 0.8,
        "damping_scale": 2.0,
        "load_scale": 0.9,
        "bearing[2].clearance": 12e-6,
    }
    profile = SpeedProfile.constant(SPEEDS[0])
    slave, found = one.started(speed=SPEEDS[0] * RPM_TO_RAD_S, force_lead=1.0, **values), []
    rest = other.equilibrium(SPEEDS[0])
    assert slave.get("disc.y")[0] == pytest.approx(rest[other.nodes["disc"]["y"]], rel=1e-8)
    assert abs(rest[other.nodes["disc"]["y"]] - rotor.equilibrium(SPEEDS[0])[other.nodes["disc"]["y"]]) > 1e-6
    for k in range(1, 101):
        slave.step_to(k * STEP)
        found.append(slave.get("disc.x", "disc.y", *RINGS, *FORCES))
    slave.free()
    # tables of the FMU are for two speeds: here those of the first hold
    wanted = by_simulate_rotor(other, profile, 100)
    assert (np.abs(np.array(found) - wanted).max(axis=0) < 1e-7 * np.ptp(wanted, axis=0)).all()


def test_a_force_that_is_given_before_the_first_step_acts_from_then_on(made):
    found = []
    for reads in (False, True):
        slave = made("flexible").started()
        slave.set(**{"disc.force_x": 200.0})
        if reads:
            assert abs(slave.get("disc.x")[0]) < 1e-12
        for _ in range(20):
            slave.step(STEP)
        found.append(slave.get("disc.x"))
        slave.free()
    assert found[0] == found[1] and found[0][0] > 5e-7


def test_a_step_is_cut(made):
    found = []
    for h in (1e-4, STEP):
        slave = made("flexible").started()
        for k in range(1, round(2e-3 / h) + 1):
            slave.step_to(k * h)
        found.append(slave.get(*RINGS, *FORCES))
        slave.free()
    assert found[0] == pytest.approx(found[1], rel=1e-9)


def test_torque_of_motor_and_films_turns_the_shaft(made):
    slave = made("motor", 3).started(**{"unbalance[1]": 0.0})
    drag, first = sum(slave.get("bearing[1].rolling_torque", "bearing[2].rolling_torque")), slave.get("speed")[0]
    for _ in range(100):
        slave.step(STEP)
    assert 1e-3 < drag < 0.2
    assert slave.get("speed")[0] - first == pytest.approx(-drag / INERTIA * 100 * STEP, rel=2e-2)
    slave.set(torque=-1e4)  # brakes: the shaft stands, and does not turn backwards
    slave.step(5e-3)
    assert slave.get("speed") == [0.0]
    slave.free()


def test_says_where_a_bearing_is_outside_its_tables(made):
    one = made("flexible")
    slave = one.started()
    assert not slave.flag("outside_validity")
    slave.set(speed=1.1 * SPEEDS[1] * RPM_TO_RAD_S)
    slave.step(STEP)
    assert slave.flag("outside_validity") and slave.flag("bearing[2].outside_speed")
    assert "speed above the tables" in one.messages[-1]
    slave.free()


@pytest.mark.parametrize("lead", [0.0, 0.5, 1.0])
def test_the_speed_that_is_given_is_reached_whatever_the_lead(made, lead):
    slave = made("flexible").started(speed=700.0, force_lead=lead)
    assert_speeds_are_reached(slave, [700.0, 700.0, 650.0, 650.0, 100.0, 0.0, 0.0])
    slave.free()


def test_a_remainder_of_a_step_is_taken_with_the_next(made):
    """As masters leave that stop at events: forces are those without it."""
    found = []
    for h in (None, 1e-9, 1e-11, 1e-12, 1e-15):
        slave = made("flexible").started()
        for length in (1e-4, h, 1e-4, h, h, 1e-4):
            if length is not None:
                slave.step(length)
        found.append(slave.get(*FORCES, "angle"))
        slave.free()
    largest = max(map(abs, found[0][:-1]))
    for one in found[1:]:
        assert one == pytest.approx(found[0], rel=1e-4, abs=1e-5 * largest)


def test_an_input_that_is_no_number_is_named(made):
    one = made("flexible")
    slave = one.started()
    slave.set(**{"unbalance[1]": float("nan")})
    with pytest.raises(FMICallException):
        slave.step(STEP)
    assert "unbalance[1] must be finite" in one.messages[-1] and "disc" not in one.messages[-1]
    slave.free()


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"mass_scale": 0.0}, "mass_scale must be"),
        ({"damping_scale": -1.0}, "damping_scale and load_scale must be"),
        ({"inner_step": 0.0}, "inner_step must be"),
        ({"bearing[1].film": 2.0}, "film must be 0 (dry) or 1"),
        ({"bearing[1].clearance": 1.0}, "clearance is too large"),
        ({"load_scale": 1e9}, "no equilibrium under this load"),
    ],
)
def test_bad_parameters(made, wrong, words):
    one = made("flexible")
    with pytest.raises(FMICallException):
        one.started(**wrong)
    assert words in one.messages[-1]


@pytest.mark.parametrize(
    ("wrong", "words"), [({"speed": -1.0}, "speed must be >= 0"), ({"disc.force_x": 1e12}, "ball|farther|balance")]
)
def test_a_step_that_fails_leaves_a_usable_instance(made, wrong, words):
    one = made("flexible")
    slave = one.started()
    slave.step(STEP)
    before = slave.get(*RINGS)
    slave.set(**wrong)
    with pytest.raises(FMICallException):
        slave.step(STEP)
    assert any(word in one.messages[-1] for word in words.split("|"))
    assert slave.get(*RINGS) == before
    slave.set(speed=SPEEDS[0] * RPM_TO_RAD_S, **{"disc.force_x": 0.0})
    slave.step(STEP)
    slave.free()


def test_bad_models():
    rotor = flexible()
    for wrong, field in (
        ({"rotor": "shaft"}, "rotor"),
        ({"speed_rpm": -1.0}, "speed_rpm"),
        ({"speeds_rpm": (7e3, 6e3)}, "speeds_rpm"),
        ({"inertia": 0.0}, "inertia"),
    ):
        with pytest.raises(InputError) as error:
            RotorModel(**{"rotor": rotor, "speeds_rpm": SPEEDS} | wrong)
        assert error.value.field == field


@pytest.mark.long
def test_a_set_is_its_rigid_shaft(tmp_path):
    """A preloaded pair whose shaft starts beside its equilibrium, beside `simulate_rotor` of its rotor."""
    pair = BearingSet.pair(BallBearing.catalogue("7205", oil=OIL), "back to back", preload=300.0)
    mass, load, rpm, steps = np.diag([4.0, 4.0, 4.0, 0.02, 0.02]), (0.0, -40.0, 20.0, 0.0, 0.5), 6000.0, 400
    rotor = pair.rotor(load, mass=mass)
    start = rotor.equilibrium(rpm) + np.array([2e-7, -3e-7, 4e-7, 1e-6, -2e-6]), np.zeros(5)
    keywords = {"speeds_rpm": rpm, "mass": mass, "load": load, "start": start}
    with pytest.raises(InputError, match=r"^start = .*: must be left out for a BearingSet without mass="):
        export(pair, tmp_path / "x.fmu", **{**keywords, "mass": None})
    one = Exported(export(pair, tmp_path / "x.fmu", **keywords))
    assert verify(one.path, pair, **keywords).passes
    assert not verify(one.path, pair, **{**keywords, "mass": 1.001 * mass}).passes
    wanted = simulate_rotor(rotor, speed_rpm=rpm, dt=STEP, until=steps * STEP, start=start)
    names = [f"shaft.{name}" for name in rotor.nodes["shaft"]]
    slave, found = one.started(speed=rpm * RPM_TO_RAD_S), []
    for k in range(1, steps + 1):
        slave.step_to(k * STEP)
        found.append(slave.get(*names, *FORCES))
    slave.free()
    held = [wanted.columns.index(f"bearing {b} {k}") for b in (0, 1) for k in "xy"]
    expected = np.column_stack([wanted.displacement, -wanted.force[:, held]])[1:]
    assert (np.abs(np.array(found) - expected).max(axis=0) < 1e-9 * np.ptp(expected, axis=0)).all()
