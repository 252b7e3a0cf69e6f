"""The FMU of a rotor in co-simulation, against `simulate_rotor` and against what can be solved by hand."""

from itertools import pairwise

import fmpy
import numpy as np
import pytest
from bearing_fmus import assert_speeds_are_reached
from fmpy.fmi1 import FMICallException
from rotor_twins import applied_force, carried, omega_of
from scipy.linalg import expm

from fmu import export
from fmu.driver import Slave
from reduced_models import SpeedProfile, simulate_rotor

EXTRAPOLATED, END, HELD = 0.0, 1.0, 0.5  # values of force_lead
# the elements are for other frequencies than that of the speed
pytestmark = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")


def run(slave, names, steps, h, *, lead=EXTRAPOLATED, inputs=None, **settings):
    """What is read at the start and after every step; `inputs` are histories of those of the ends."""
    inputs = inputs or {}
    slave.start(force_lead=lead, **settings, **{name: values[0] for name, values in inputs.items()})
    found = [slave.get(*names)]
    for n in range(1, steps + 1):
        if inputs:
            slave.set(**{name: values[n if lead == END else n - 1] for name, values in inputs.items()})
        slave.step(h)
        found.append(slave.get(*names))
    return np.array(found)


def reference(model, steps, dt, **options):
    # its own imbalances shake a rotor that is hardly damped: at 1e-10 they make 7e-7 of the orbit in a second
    return simulate_rotor(model.running(), dt=dt, until=steps * dt, tolerance=1e-11, **options)


@pytest.mark.parametrize(
    ("name", "fmi"),
    [
        *(("wide", 2), ("cubic", 2), ("wide in y", 2), ("mixed", 3)),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in (("mixed", 2), ("wide", 3), ("wide in y", 3))),
    ],
)
def test_closed_rotor_is_that_of_simulate_rotor(instance, rotors, motion_of, moving, name, fmi):
    """Orbit, velocities and forces, from the static equilibrium on."""
    model, steps, dt = rotors[name], 1500, 1e-5
    expected = reference(model, steps, dt)
    forces = [f"contact[{i + 1}].force" for i in range(len(model.elements))]
    names = [*moving(model.rotor), *forces]
    found = run(instance(name, fmi), names, steps, dt, inner_step=dt)
    wanted = np.hstack([motion_of(expected), expected.force])
    size = np.ptp(wanted, axis=0)
    # a velocity follows from positions over a step: what is left of an imbalance shows 1/(w dt) times as much
    allowed = np.where([("velocity" in one) for one in names], 1e-5, 1e-7)
    assert (np.abs(found - wanted).max(axis=0) <= allowed * size).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["wide", "cubic"])
def test_a_second_of_it(instance, rotors, motion_of, moving, name):
    model, dt = rotors[name], 1e-5
    wanted = motion_of(reference(model, 100_000, dt))[:100_001, :4]
    found = run(instance(name), moving(model.rotor)[:4], 100_000, dt, inner_step=dt)
    assert (np.abs(found - wanted).max(axis=0) <= 1e-7 * np.ptp(wanted, axis=0)).all()


@pytest.mark.parametrize("name", ["wide", "cubic", "mixed"])
def test_it_rests_where_it_starts(instance, rotors, moving, name):
    """Without unbalance nothing moves; every contact has the force that the statics give."""
    slave, rotor = instance(name), rotors[name].rotor
    names = moving(rotor)
    found = run(slave, names, 100, 1e-5, **{"unbalance[1]": 0.0})
    approach = np.abs(rotors[name].state[0][2:]).max()
    assert np.abs(found - found[0])[:, :4].max() <= 1e-10 * approach
    assert slave.get("contact[1].force", "contact[2].force") == pytest.approx(carried(rotor), rel=1e-9)


def test_communication_step_is_cut_into_inner_steps(instance, rotors, moving):
    """Of nearly two revolutions, as if each had been asked for; the step of the inner ones decides."""
    names = moving(rotors["wide"].rotor)
    fine = run(instance("wide"), names, 1500, 1e-5, inner_step=1e-5)
    coarse = run(instance("wide"), names, 15, 1e-3, inner_step=1.0001e-5)
    assert np.abs(coarse - fine[::100]).max(axis=0) == pytest.approx(0.0, abs=1e-12)
    one = run(instance("wide"), names, 15, 1e-3, inner_step=1e-3)
    assert np.abs(one - fine[::100]).max() > 1e-7


def test_default_inner_step_resolves_shaft_and_contacts(rotors):
    for name, model in rotors.items():
        of = model.settings
        shaft = np.sqrt(of["shaft_stiffness"] * (1.0 / of["disc_mass"] + 1.0 / of["journal_mass"]))
        assert shaft * model.inner_step < 0.11, name
        for element in model.elements:
            if element.time is not None:
                assert model.inner_step <= 0.05 * element.time, name


def test_default_inner_step_follows_a_stiffer_shaft(instance, rotors, moving):
    """A shaft 400 times as stiff is resolved as the exported one is; a step of one's own is taken as it is."""
    rotor, default = rotors["alone"].rotor, rotors["alone"].inner_step
    shaft = rotors["alone"].settings["shaft_stiffness"]
    names, start = moving(rotor), {"disc.y": 1e-5}
    stiff = {
        "shaft_stiffness": 400.0 * shaft,
        "shaft_damping": 0.0,
        "disc_damping": 0.0,
    }
    exact = run(instance("alone"), names, 50, default, inner_step=default / 200.0, **stiff, **start)
    size = np.ptp(exact, axis=0).max()
    found = run(instance("alone"), names, 50, default, **stiff, **start)
    longer = np.nextafter(default, 1.0)  # set, and so not the default
    coarse = run(instance("alone"), names, 50, default, inner_step=longer, **stiff, **start)
    error, before = (np.abs(one - exact).max() / size for one in (found, coarse))
    print(error, before)
    assert error < 0.1 * before


def test_rotor_alone_under_the_forces_of_its_contacts(instance, rotors, moving, motion_of):
    """What the contacts gave the closed one moves it just so: they are the forces of one bearing."""
    model, steps, dt = rotors["wide"], 400, 1e-5
    expected = reference(model, steps, dt)
    inputs = {f"contact[{i + 1}].force": expected.force[:, i] for i in range(2)}
    wanted = motion_of(expected)
    names = [
        *moving(model.rotor),
        "contact[1].approach",
        "contact[2].approach",
        "contact[1].rate",
        "contact[2].rate",
    ]
    start = dict(zip(names, wanted[0], strict=False))
    found = run(instance("alone"), names, steps, dt, lead=END, inputs=inputs, inner_step=dt, **start)
    wanted = np.hstack([wanted, expected.approach, expected.rate])
    assert (np.abs(found - wanted).max(axis=0) <= 1e-5 * np.ptp(wanted, axis=0)).all()
    assert (np.abs(found - wanted).max(axis=0)[:4] <= 1e-7 * np.ptp(wanted, axis=0)[:4]).all()


def twin(rotor, T, forces):
    """Motion of the rotor alone by matrix exponentials, under forces that are straight between the times."""
    M, C, K = rotor.matrices(0.0)
    n, h = len(M), T[1] - T[0]
    A = np.zeros((2 * n, 2 * n))
    A[:n, n:], A[n:, :n], A[n:, n:] = np.eye(n), -np.linalg.solve(M, K), -np.linalg.solve(M, C)
    B = np.vstack([np.zeros((n, n)), np.linalg.inv(M)])
    whole = expm(
        h * np.block([[A, B, 0 * B], [np.zeros((n, 2 * n)), np.zeros((n, n)), np.eye(n)], [np.zeros((n, 4 * n))]])
    )
    x = [np.concatenate([rotor.rest_at([mount.offset for mount in rotor.contacts]), np.zeros(n)])]
    for now, then in pairwise(forces):
        x.append(whole[: 2 * n] @ np.concatenate([x[-1], now, (then - now) / h]))
    return np.array(x)


@pytest.mark.parametrize("name", ["alone", "alone in y"])
def test_rotor_alone_converges_to_its_analytic_twin(instance, rotors, moving, name):
    """With forces on disc, journal and contacts, of second order in the inner step; held inputs of first."""
    rotor = rotors[name].rotor
    axes = list(rotor.nodes["disc"])
    names = moving(rotor)
    errors = {}
    for lead in (EXTRAPOLATED, END, HELD):
        for refined in (1, 2):
            steps, h = 200 * refined, 1e-5 / refined
            T = h * np.arange(steps + 1)
            inputs = {f"journal.force_{a}": 300.0 * np.sin(4e3 * T + k) for k, a in enumerate(axes)}
            inputs |= {f"disc.force_{a}": 200.0 * np.cos(3e3 * T + k) for k, a in enumerate(axes)}
            inputs |= {
                f"contact[{i + 1}].force": 850.0 + 50.0 * np.sin(2e3 * T + i) for i in range(len(rotor.mounts))
            }
            journal, disc = (
                np.stack([inputs[f"{b}.force_{a}"] for a in axes], axis=1) for b in ("journal", "disc")
            )
            pressed = [mount.count * inputs[f"contact[{i + 1}].force"] for i, mount in enumerate(rotor.contacts)]
            applied = np.array([applied_force(rotor, t) for t in T])
            forces = applied + np.hstack([disc, journal]) - np.stack(pressed, axis=1) @ rotor.support_rows
            wanted = twin(rotor, T, forces)
            inner = 1e-6 if lead == HELD else h
            found = run(instance(name), names, steps, h, lead=lead, inputs=inputs, inner_step=inner)
            errors[lead, refined] = np.abs(found - wanted).max(axis=0) / np.ptp(wanted, axis=0)
    for lead, order in ((EXTRAPOLATED, 2.0), (END, 2.0), (HELD, 1.0)):
        assert errors[lead, 1].max() < 0.1
        ratio = np.log2(np.linalg.norm(errors[lead, 1]) / np.linalg.norm(errors[lead, 2]))
        assert ratio == pytest.approx(order, abs=0.3), lead


def test_a_force_that_jumps_is_felt_at_once(instance, rotors):
    """Between two steps, held: half an acceleration times the square of the time, from the next step on."""
    slave, rotor, h, force = instance("alone"), rotors["alone"].rotor, 1e-6, 1000.0
    F = dict(zip(("contact[1].force", "contact[2].force"), carried(rotor), strict=True))
    slave.start(force_lead=HELD, inner_step=h, **F, **{"unbalance[1]": 0.0})
    for _ in range(3):
        slave.step(h)
    before = np.array(slave.get("journal.x", "journal.y"))
    assert np.abs(before).max() < 1e-16
    slave.set(**{"journal.force_x": force})
    slave.step(h)
    moved, velocity = slave.get("journal.x", "journal.velocity_x")
    assert moved == pytest.approx(0.5 * force / rotor.mass[2, 2] * h**2, rel=1e-3)
    assert velocity == pytest.approx(force / rotor.mass[2, 2] * h, rel=1e-3)


def test_speed_and_unbalance_are_inputs(instance, rotors, motion_of, moving):
    """The angle goes on; the unbalance is of the new speed from there."""
    model, dt = rotors["wide"], 1e-5
    slave = instance("wide")
    slave.start(force_lead=EXTRAPOLATED, inner_step=dt)
    for _ in range(300):
        slave.step(dt)
    turned = slave.get("angle")[0]
    assert turned == pytest.approx(300 * dt * omega_of(model.rotor), rel=1e-12)
    slave.set(speed=0.0)
    slave.step(dt)
    turned = slave.get("angle")[0]
    for _ in range(10):
        slave.step(dt)
    assert slave.get("angle")[0] == turned
    slave.set(speed=0.0, **{"unbalance[1]": 0.0})
    slave.step(dt)
    slave.set(speed=100.0 * np.pi)
    slave.step(dt)  # at the mean of the speeds before and now
    assert slave.get("angle")[0] == pytest.approx(turned + 0.5 * dt * 100.0 * np.pi, rel=1e-12)


@pytest.mark.parametrize("lead", [EXTRAPOLATED, HELD, END])
def test_the_speed_that_is_given_is_reached_whatever_the_lead(instance, lead):
    slave = instance("alone")
    slave.start(force_lead=lead, speed=300.0)
    assert_speeds_are_reached(slave, [300.0, 250.0, 250.0, 100.0, 0.0, 0.0])


def test_angle_loses_nothing_in_many_steps(instance, rotors):
    slave = instance("alone in y")
    slave.start(force_lead=EXTRAPOLATED, inner_step=1e-6, speed=7654.321)
    for _ in range(200):
        slave.step(1e-4)
    assert slave.get("angle")[0] == pytest.approx(200 * 1e-4 * 7654.321, rel=3e-15)


@pytest.mark.parametrize("name", ["wide", "wide in y"])
def test_a_run_up_is_that_of_simulate_rotor(instance, rotors, motion_of, moving, name):
    """The unbalance has a force from the angular acceleration too, a tenth of the other one here at the start."""
    model, dt, steps = rotors[name], 1e-5, 1000
    profile = SpeedProfile.ramp(3000.0, 15000.0, (steps + 1) * dt)
    speed, angle, rise = profile.at(dt * np.arange(steps + 1))
    expected = reference(model, steps, dt, speed_rpm=profile)
    inputs = {"speed": speed, "angular_acceleration": rise}
    names = [*moving(model.rotor)[: model.rotor.size], "angle"]
    found = run(instance(name), names, steps, dt, lead=END, inputs=inputs, inner_step=dt)
    wanted = np.column_stack([motion_of(expected)[:, : len(names) - 1], angle])
    assert (np.abs(found - wanted).max(axis=0) <= 1e-7 * np.ptp(wanted, axis=0)).all()


OTHER = {
    "disc_mass": 2.6,
    "journal_mass": 0.2,
    "shaft_stiffness": 1.5e8,
    "shaft_damping": 90.0,
    "disc_damping": 3.0,
}


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("name", ["alone", "wide", "mixed", "wide in y"])
def test_other_masses_springs_and_dampers(instance, rotors, motion_of, moving, name, fmi):
    """Set before initialization: the run of a rotor that has them, from its own equilibrium on."""
    model, steps, dt = rotors[name], 500, 1e-5
    other = model.changed(**OTHER)
    names = moving(other.rotor)
    found = run(instance(name, fmi), names, steps, dt, inner_step=dt if model.elements else 1e-6, **OTHER)
    start = np.concatenate(other.state)
    assert found[0] == pytest.approx(start, rel=1e-12, abs=1e-12 * np.abs(start).max())
    if model.elements:
        wanted = motion_of(reference(other, steps, dt))
        allowed = np.where([("velocity" in one) for one in names], 1e-5, 1e-7)
        assert (np.abs(found - wanted).max(axis=0) <= allowed * np.ptp(wanted, axis=0)).all()
    else:
        T = dt * np.arange(steps + 1)
        wanted = twin(other.rotor, T, np.array([applied_force(other.rotor, t) for t in T]))
        assert (np.abs(found - wanted).max(axis=0) <= 1e-3 * np.ptp(wanted, axis=0)).all()


def test_equilibrium_follows_until_a_start_is_set(instance, rotors, moving):
    """In any order of calls; a start of one's own stays, whatever the masses."""
    slave = instance("wide")
    slave.raw.setupExperiment(startTime=0.0)
    slave.raw.enterInitializationMode()
    found = []
    for mass in (OTHER["disc_mass"], 4.0):
        slave.set(disc_mass=mass)
        rest, _ = rotors["wide"].changed(disc_mass=mass).state
        found.append(slave.get("journal.y", "disc.y"))
        assert found[-1] == pytest.approx([rest[3], rest[1]], rel=1e-12)
    slave.set(**{"journal.y": 1e-6})
    slave.set(disc_mass=3.0)
    assert slave.get("journal.y", "disc.y") == [1e-6, found[-1][1]]


def test_masses_that_the_contacts_do_not_carry(rotors, tmp_path):
    """Lifted from its contact by its load, once it is lighter."""
    model, messages = rotors["wide in y"], []
    path = export(model.changed(load=(0.0, 15.0)).rotor, tmp_path / "x.fmu")
    folder = fmpy.extract(str(path), unzipdir=str(tmp_path / "x"))
    slave = Slave(folder, fmpy.read_model_description(str(path)), messages)
    slave.raw.fmi2SetDebugLogging(slave.raw.component, True, 0, None)
    with pytest.raises(FMICallException):
        slave.start(force_lead=0.0, disc_mass=1.0)
    slave.free()
    assert len(messages) == 1 and "no equilibrium under this load" in messages[0]


def test_a_start_of_ones_own(instance, rotors, motion_of, moving):
    """Kicked: start values of states are set before initialization."""
    model, dt = rotors["cubic"], 1e-5
    kicked = model.state[0] + np.array([1e-6, 2e-6, 0.0, -1e-6]), np.array([0.0, 0.0, 0.01, -0.02])
    wanted = motion_of(simulate_rotor(model.running(), dt=dt, until=300 * dt, start=kicked, tolerance=1e-10))
    names = moving(model.rotor)
    start = dict(zip(names, wanted[0], strict=True))
    found = run(instance("cubic"), names, 300, dt, inner_step=dt, **start)
    assert (np.abs(found - wanted)[:, :4].max(axis=0) <= 1e-7 * np.ptp(wanted, axis=0)[:4]).all()


def test_lift_off_and_impact(instance, rotors, motion_of, moving):
    """Torn up by the shaft until both contacts part, and falling back: the same motion, and no force pulls."""
    model, dt, steps = rotors["mixed"], 2e-6, 1500
    rotor, (rest, none) = model.running(), model.state
    torn = rest + np.array([3e-5, 1.2e-4, 0.0, 0.0]), none
    for mount, approach in zip(rotor.contacts, rotor.approaches(rest).tolist(), strict=True):
        mount.contact.rest(approach)
    expected = simulate_rotor(rotor, dt=dt, until=steps * dt, start=torn, tolerance=1e-10, max_iterations=60)
    names, wanted = moving(model.rotor)[:4], motion_of(expected)[:, :4]
    start = dict(zip(names, wanted[0], strict=True))
    found = run(
        instance("mixed"), ["contact[1].force", "contact[2].force", *names], steps, dt, inner_step=dt, **start
    )
    parted = int(np.argmax(expected.force.max(axis=1) < 1.0))
    assert parted > 0 and expected.force[parted:].max() > 2000.0 and found[:, :2].min() >= 0.0
    assert (np.abs(found[:, 2:] - wanted).max(axis=0) <= 1e-7 * np.ptp(wanted, axis=0)).all()
