"""FMUs of ball bearings beside the bearings in Python: forces, parameters, films, faults, a mass on the ring."""

import re
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from bearing_fmus import RPM, ExportedBearing, bearing, inputs
from core_races import CoreRace
from exported import verified
from fmpy.fmi1 import FMICallException
from mass_on_bearing import decay, in_one_run

from ehlcontact import InputError, OilLayer
from fmu import export, verify_references
from fmu.bearing.model import BearingModel
from fmu.bearing.references import force_scales
from fmu.bearing.tables import _curve, _halved, _race
from fmu.bearing.trial import START, bearing_trial
from fmu.bearing.variables import FORCES
from fmu.driver import Slave
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

# Largest difference over the largest force. Planar balls are found by both to rounding; those at angles in Python
# to first order from 1e-6 of the forces, which counts where centrifugal forces do.
ALLOWED = {
    "planar": 1e-10,
    "range": 1e-10,
    "five": 1e-10,
    "held": 1e-10,
    "heavy five": 1e-9,
    "dry": 1e-12,
    "angular": 1e-8,
    "inner": 1e-8,
    "shared": 1e-8,
    "turning": 1e-8,
}


def driven(slave, model, trial, shift=None):
    """Forces of an FMU along a trial, shape (k, n)."""
    names = [FORCES[name] for name in model.directions]
    found = [slave.get(*names)]
    for k in range(1, trial.time.size):
        values = inputs(model, trial, k)
        slave.set(**values | ({} if shift is None else {name: values[name] - by for name, by in shift.items()}))
        slave.step_to(float(trial.time[k]))
        found.append(slave.get(*names))
    slave.free()
    return np.array(found)


@pytest.mark.parametrize(
    ("name", "fmi"),
    [
        *(("planar", 2), ("five", 2), ("angular", 2), ("planar", 3)),
        *(
            pytest.param(name, 2, marks=pytest.mark.slow)
            for name in ("range", "dry", "inner", "shared", "held", "heavy five", "turning")
        ),
        pytest.param("five", 3, marks=pytest.mark.slow),
    ],
)
def test_forces_are_those_of_python(made, name, fmi):
    """Another run than that of the verification at export: longer, other vibrations, with lift-off."""
    one = made(name, fmi)
    trial = bearing_trial(one.model, steps=300, dt=8e-6, seed=7)
    assert trial.balls.max() > 300.0 and trial.balls[:, :, 0].min() < 1e-3 * trial.balls.max()
    found = driven(one.started(**inputs(one.model, trial, 0)), one.model, trial)
    assert largest_difference(found, trial) < ALLOWED[name]
    assert verify_references(one.path).passes
    if name in ("planar", "five"):
        found = verified(one.path, one.model)
        assert found.passes and found.rates > 0.0
        page = (Path(one.folder) / "documentation" / "index.html").read_text(encoding="utf-8")
        assert "for co-simulation and model exchange;" in page


def largest_difference(found, trial):
    """Of forces and moments from those of a trial, over the largest of each kind."""
    return float((np.abs(found - trial.force) / force_scales(trial)).max())


def test_clearance_offset_and_film_are_parameters(made):
    planar, dry, five = made("planar"), made("dry"), made("five")
    other = BearingModel(bearing(clearance=9e-6, loss_factor=0.05, ball_inertia=True), RPM, 500.0)
    trial = bearing_trial(other, steps=60)
    found = driven(planar.started(clearance=9e-6, **inputs(other, trial, 0)), other, trial)
    assert largest_difference(found, trial) < 1e-10
    without = BearingModel(bearing(clearance="CN", oil=None, loss_factor=0.05), RPM, (0.0, -500.0, 200.0))
    trial = bearing_trial(without, steps=60)
    found = driven(five.started(film=0.0, **inputs(without, trial, 0)), without, trial)
    assert largest_difference(found, trial) < 1e-10
    trial = bearing_trial(five.model, steps=60)
    first = inputs(five.model, trial, 0)
    shifted = five.started(offset=3e-6, **first | {"z": first["z"] - 3e-6})
    assert largest_difference(driven(shifted, five.model, trial, {"z": 3e-6}), trial) < 1e-10
    trial = bearing_trial(dry.model, steps=5)
    with pytest.raises(FMICallException):
        dry.started(clearance=1.0, **inputs(dry.model, trial, 0))


def test_steps_of_any_length_follow_one_motion(made):
    """Alternating lengths give the force of even steps to the error of either, which falls with the step."""
    one = made("five")
    gaps = []
    for n in (200, 400):
        trial = bearing_trial(one.model, steps=n, dt=1e-3 / n)
        fine = bearing_trial(one.model, steps=4 * n, dt=0.25e-3 / n)
        slave = one.started(**inputs(one.model, fine, 0))
        at = [0]
        while at[-1] < 4 * n:
            at.append(min(at[-1] + (3 if len(at) % 2 else 5), 4 * n))
        found = []
        for k in at[1:]:
            slave.set(**inputs(one.model, fine, k))
            slave.step_to(float(fine.time[k]))
            found.append(slave.get("force_y")[0])
        slave.free()
        gaps.append(np.abs(np.array(found) - fine.force[at[1:], 1]).max() / np.abs(fine.force[:, 1]).max())
        assert trial.time[-1] == pytest.approx(fine.time[-1])
    assert gaps[0] < 0.02
    assert gaps[1] < 0.5 * gaps[0]


# At contact angles films follow speeds and radii by their powers (Hamrock and Dowson); in Python, by the atlas.
@pytest.mark.parametrize(("name", "within"), [("planar", 0.003), ("five", 0.03)])
def test_films_and_torque_are_those_at_rest(made, name, within):
    one = made(name)
    state = one.model.bearing.equilibrium(
        one.model.load if name == "five" else (0.0, -500.0), speed_rpm=RPM, cage_angle=START
    )
    place = dict(zip(one.model.directions, one.model.place.tolist(), strict=True))
    slave = one.started(**place, speed=RPM * RPM_TO_RAD_S)
    balls = one.model.bearing.balls
    for column, race in enumerate(("inner", "outer")):
        load = slave.get(*(f"ball[{k + 1}].load_{race}" for k in range(balls)))
        film = slave.get(*(f"ball[{k + 1}].film_{race}" for k in range(balls)))
        pressed = state.force[:, column] > 1.0
        assert load == pytest.approx(state.force[:, column], rel=1e-6, abs=1e-3)
        assert np.array(film)[pressed] == pytest.approx(state.h_central[pressed, column], rel=within)
    torque, smallest, lam = slave.get("rolling_torque", "smallest_film", "smallest_lambda")
    assert torque == pytest.approx(state.rolling_torque, rel=within)
    pressed = state.force > 1.0
    assert smallest == pytest.approx(state.h_min[pressed].min(), rel=within)
    assert lam == pytest.approx(smallest / one.model.bearing.roughness)
    slave.free()


def test_a_state_that_is_set_again_repeats_the_run_to_the_bit(made):
    one = made("five")
    trial = bearing_trial(one.model, steps=40)
    slave = one.started(lead=1.5, **inputs(one.model, trial, 0))

    def run():
        found = []
        for k in range(20, 40):
            slave.set(**inputs(one.model, trial, k))
            slave.step_to(float(trial.time[k]))
            found.append(slave.get("force_x", "force_z", "moment_y"))
        return found

    for k in range(1, 20):
        slave.set(**inputs(one.model, trial, k))
        slave.step_to(float(trial.time[k]))
    kept, time = slave.raw.getFMUState(), slave.time
    first = run()
    slave.raw.setFMUState(kept)
    slave.time = time
    assert run() == first
    slave.raw.freeFMUState(kept)
    slave.free()


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"speed": -1.0}, "speed must be >= 0"),
        ({"speed": float("nan")}, "must be finite"),
        ({"y": 0.5}, "farther from the outer one than"),
        ({"tilt_x": 1.0}, "farther from the outer one than"),
    ],
)
def test_what_no_bearing_does_is_told_and_leaves_a_usable_instance(made, wrong, words):
    one, messages = made("five"), []
    trial = bearing_trial(one.model, steps=3)
    slave = Slave(one.folder, one.description, messages, loggingOn=True)
    slave.start(lead=0.0, cage_angle_start=START, **inputs(one.model, trial, 0))
    slave.set(**wrong)
    with pytest.raises(FMICallException):
        slave.step_to(1e-5)
    assert words in messages[-1]
    slave.set(**inputs(one.model, trial, 1))
    slave.step_to(float(trial.time[1]))
    assert slave.get("force_y")[0] == pytest.approx(trial.force[1, 1], rel=1e-9)
    slave.free()


@pytest.mark.parametrize(
    ("name", "film", "words"),
    [
        ("planar", 2.0, r"film must be 0 \(dry\) or 1"),
        ("planar", 0.5, r"film must be 0 \(dry\) or 1"),
        ("planar", float("nan"), r"film must be 0 \(dry\) or 1"),
        ("dry", 1.0, "film must be 0: this bearing is dry"),
    ],
)
def test_a_film_is_there_or_not(made, name, film, words):
    one, messages = made(name), []
    slave = Slave(one.folder, one.description, messages, loggingOn=True)
    with pytest.raises(FMICallException):
        slave.start(film=film)
    assert re.search(words, messages[-1])


def test_films_hold_above_the_highest_speed_of_the_tables(made):
    """At rest: films of that speed, which would be a fifth thicker."""
    found = []
    for share in (1.0, 1.3):
        slave = made("range").started(x=0.0, y=-1.3e-5, speed=share * RPM * RPM_TO_RAD_S)
        found.append(slave.get("smallest_film", "force_y"))
        slave.free()
    assert found[1] == pytest.approx(found[0], rel=5e-3)


def test_tilts_have_terminals_too(made):
    with zipfile.ZipFile(made("five", 3).path) as archive:
        root = ElementTree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    found = {one.get("name"): one for one in root.iter("Terminal")}
    assert list(found) == ["x", "y", "z", "tilt_x", "tilt_y"]
    assert [m.get("variableName") for m in found["tilt_y"]] == ["tilt_y", "tilt_rate_y", "moment_y"]
    assert [m.get("memberName") for m in found["tilt_y"]] == ["phi", "w", "tau"]
    assert "Rotational" in found["tilt_y"].get("terminalKind")
    assert "Translational" in found["z"].get("terminalKind")


def test_speed_and_loads_beyond_the_tables_are_flagged(made):
    one = made("planar")
    slave = one.started(x=0.0, y=-1.3e-5, velocity_x=0.0, velocity_y=0.0, speed=RPM * RPM_TO_RAD_S)
    assert not slave.flag("outside_validity")
    slave.set(speed=1.1 * RPM * RPM_TO_RAD_S)
    slave.step(1e-5)
    assert slave.flag("outside_speed") and slave.flag("outside_validity") and not slave.flag("outside_load")
    slave.set(speed=RPM * RPM_TO_RAD_S, y=-4e-4)
    slave.step(1e-5)
    assert slave.flag("outside_load") and not slave.flag("outside_speed")
    slave.free()


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ((bearing(), (3000.0, 2000.0)), "speeds_rpm"),
        ((bearing(), 0.0), "speeds_rpm"),
        ((bearing(), 1e6), "speeds_rpm"),
        ((bearing(), float("nan")), "speeds_rpm"),
        ((bearing(), 3000.0, 1e7), "load"),
        ((bearing("7205"), 3000.0, (0.0, -100.0)), "load"),
        ((bearing(), 3000.0, None, ("x", "z")), "directions"),
        ((bearing(), 3000.0, None, 5), "directions"),
        ((bearing(), 3000.0, (0.0, -100.0, 50.0, 0.0, 1.0), ("x", "y", "z")), "directions"),
        ((bearing(), 3000.0, (0.0, -100.0, 50.0), ("x", "y")), "directions"),
        (("6205", 3000.0), "bearing"),
    ],
)
def test_bad_models(arguments, field):
    with pytest.raises(InputError) as error:
        BearingModel(*arguments)
    assert error.value.field == field


@pytest.mark.parametrize(("dt", "within"), [(1e-5, 0.005), pytest.param(3e-5, 0.05, marks=pytest.mark.slow)])
def test_a_mass_that_holds_the_force_keeps_the_damping(tmp_path, dt, within):
    """5 kg on a 6305, both stepping at once: decay of half the difference of two runs, kicked up and down."""
    model, mass, load, until, kick = BearingModel(bearing("6305"), RPM, 500.0), 5.0, 500.0, 0.012, 1e-4
    path = tmp_path / "6305.fmu"
    export(model.bearing, path, speeds_rpm=RPM, load=load)
    one = ExportedBearing(path, model)
    steps = round(until / dt)

    def fmu(v):
        q, rate, pull = model.place.copy(), np.array([0.0, v]), np.array([0.0, -load])
        slave = one.started(lead=1.5, x=q[0], y=q[1], velocity_y=v, speed=RPM * RPM_TO_RAD_S)
        a, kept = (slave.get("force_x", "force_y") + pull) / mass, [q[1]]
        for _ in range(steps):
            slave.set(x=q[0], y=q[1], velocity_x=rate[0], velocity_y=rate[1])
            slave.step(dt)
            q, rate = q + dt * (rate + 0.5 * dt * a), rate + dt * a
            a = (slave.get("force_x", "force_y") + pull) / mass
            kept.append(q[1])
        slave.free()
        return np.array(kept)

    wanted = in_one_run(model, mass, load, until, kick)
    assert decay(fmu(kick) - fmu(-kick), dt) == pytest.approx(wanted, rel=within)


@pytest.mark.parametrize(
    ("dt", "struck", "told"), [(2e-5, False, False), (2e-5, True, False), (8e-5, False, True)]
)
def test_steps_that_are_too_long_for_the_motion_are_told(made, dt, struck, told):
    """A vibration of 650 Hz; blows now and then are none of the step's."""
    one, messages, omega = made("planar"), [], 2.0 * np.pi * 650.0
    slave = Slave(one.folder, one.description, messages, loggingOn=True)
    slave.start(lead=1.5, cage_angle_start=START, y=-1.3e-5, speed=RPM * RPM_TO_RAD_S)
    for k in range(400):
        t = k * dt
        slave.set(
            y=-1.3e-5 + 1e-6 * np.sin(omega * t),
            velocity_y=1e-6 * omega * np.cos(omega * t) + (1e-3 if struck and k % 300 > 150 else 0.0),
        )
        slave.step(dt)
    slave.free()
    words = "the communication steps are too long for this motion"
    assert sum(words in message for message in messages) == int(told)


def messages_of(one, motion, dt, steps=400):
    """What an FMU logs while its ring has ``x, y, velocity_x, velocity_y = motion(t)``."""
    messages = []
    slave = Slave(one.folder, one.description, messages, loggingOn=True)
    slave.start(lead=1.5, cage_angle_start=START, y=-1.3e-5, speed=RPM * RPM_TO_RAD_S)
    for k in range(steps):
        slave.set(**dict(zip(("x", "y", "velocity_x", "velocity_y"), motion(k * dt), strict=True)))
        slave.step(dt)
    slave.free()
    return messages


def test_a_small_fast_motion_beside_a_slow_one_is_told(made):
    """Across, 3 um at 400 Hz, for which the steps are short enough; along the load 0.3 um at 650 Hz."""
    slow, fast = 2.0 * np.pi * 400.0, 2.0 * np.pi * 650.0

    def motion(t, a=3e-6, b=3e-7):
        velocities = a * slow * np.cos(slow * t), b * fast * np.cos(fast * t)
        return a * np.sin(slow * t), -1.3e-5 + b * np.sin(fast * t), *velocities

    words = "the communication steps are too long for this motion"
    assert any(words in message for message in messages_of(made("planar"), motion, 4.5e-5))
    alone = messages_of(made("planar"), lambda t: motion(t, b=0.0), 4.5e-5)
    assert not any(words in message for message in alone)


def test_what_is_left_of_a_motion_is_not_told(made):
    """A vibration that has decayed to a thousandth, and beside it one for which the steps would be too long."""
    omega = 2.0 * np.pi * 650.0

    def motion(t):
        size = 1e-6 if t < 4e-3 else 1e-9
        w = omega if t < 4e-3 else 4.0 * omega
        return 0.0, -1.3e-5 + size * np.sin(w * t), 0.0, size * w * np.cos(w * t)

    assert not any("too long" in message for message in messages_of(made("planar"), motion, 2e-5, 800))


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0, 2.0])
@pytest.mark.parametrize("lead", [0.0, 1.0, 1.5])
def test_a_displacement_that_does_not_change_as_its_rate_says_is_told_once(made, lead, share):
    """A recorded motion of 1000 Hz, played with a share of its rate."""
    one, messages, omega, dt = made("planar"), [], 2e3 * np.pi, 5e-6
    slave = Slave(one.folder, one.description, messages, loggingOn=True)
    slave.start(lead=lead, cage_angle_start=START, y=-1.2e-5, speed=RPM * RPM_TO_RAD_S)
    for t in dt * np.arange(400):
        y, rate = -1.2e-5 + 2e-7 * np.sin(omega * t), share * 2e-7 * omega * np.cos(omega * t)
        slave.set(y=y, velocity_y=rate)
        slave.step(dt)
    slave.free()
    words = "y does not change as velocity_y says: set both"
    assert sum(words in message for message in messages) == int(share != 1.0)
    assert not any("x does not change" in message for message in messages)


@pytest.mark.parametrize("lead", [0.0, 0.5, 1.0, 1.5])
def test_a_coast_down_ends_at_standstill(made, lead):
    """The speed goes on by none of its changes: beyond its last value it could be below 0, or above the tables."""
    one, messages, highest = made("planar"), [], RPM * RPM_TO_RAD_S
    slave = Slave(one.folder, one.description, messages, loggingOn=True)
    slave.start(lead=lead, cage_angle_start=START, y=-1.3e-5, speed=0.5 * highest)
    for share in (*np.linspace(0.5, 1.0, 30), 1.0, 1.0, *np.linspace(1.0, 0.0, 40), 0.0, 0.0):
        slave.set(y=-1.3e-5, velocity_y=0.0, speed=share * highest)
        slave.step(1e-4)
        assert slave.get("force_y")[0] > 0.0
    slave.free()
    assert not messages


def test_powers_of_a_curve_that_are_zero():
    """A coefficient of an interval may come out as exactly 0; that of a 6205 in ISO VG 68 at 3000 rev/min did."""
    law = bearing().tables.law("inner", [RPM])
    cells = law.cells.copy()
    cells[:, 1, :, 0], cells[:, 1, :, 1:] = 0.5, 0.0  # the second interval is constant
    place = _halved(law)[1]
    powers, first = _curve(law._replace(cells=cells), place)
    assert powers[first[1] : first[2]] == pytest.approx([0.5, 0.0], abs=1e-12)
    as_it_is, ends = _curve(law, place)
    np.testing.assert_array_equal(powers[: first[1]], as_it_is[: ends[1]])
    np.testing.assert_array_equal(powers[first[2] :], as_it_is[ends[2] :])


def test_the_curve_of_a_layer_that_runs_dry():
    """Within an interval it bends: one polynomial is 9e-5 of it off, and there are more, with gains as before."""
    balls = bearing("6305", supply=OilLayer(3e-7)).tables.balls([2000.0, 5000.0])
    law, core = balls.inner, CoreRace(balls)
    halved, place = _halved(law)
    powers, first = _curve(halved, place)
    assert halved.x.size > law.x.size
    assert _race("race", law)[1]["nodes"] == str(halved.x.size)  # of all tables in C
    for row, (u, nodes) in enumerate(zip(halved.u, law.u, strict=True)):
        np.testing.assert_array_equal(np.isin(nodes, u), True)
        for at in np.random.default_rng(0).uniform(-1e-6, 2e-6, 3000):
            k = np.searchsorted(u, at) - 1
            first_of, end = first[row * (u.size - 1) + k : row * (u.size - 1) + k + 2]
            s = 2.0 * (at - u[k]) / (u[k + 1] - u[k]) - 1.0
            expected = core.curve(at, (row, 0.0))[0]
            assert np.polyval(powers[first_of:end][::-1], s) == pytest.approx(expected, rel=2e-9)
        for gains, before in zip(halved.gains[row].T, law.gains[row].T, strict=True):
            np.testing.assert_allclose(gains, np.interp(halved.x, law.x, before), rtol=1e-10, atol=1e-14)
        np.testing.assert_allclose(
            halved.film_made[row], np.interp(halved.x, law.x, law.film_made[row]), rtol=1e-12
        )


def test_export_leaves_nothing_behind_where_it_fails(tmp_path):
    with pytest.raises(InputError):
        export(bearing(), tmp_path / "x.fmu", speeds_rpm=1e6)
    assert not list(tmp_path.iterdir())
