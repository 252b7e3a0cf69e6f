"""The issue's rotor from 500 to 9000 rev/min: peaks at the crossings of the Campbell diagram, no jump."""

import numpy as np
import pytest
from core_races import CoreRace
from programs import script

from reduced_models import (
    BallBearing,
    Disc,
    Shaft,
    SpeedProfile,
    Support,
    campbell,
    rotor_on_bearings,
    simulate_rotor,
)
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import motion_of
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.speed_profile import law_speeds, turning_forces

RANGE = np.array([500.0, 9000.0])


def test_the_highest_speed_of_the_tables_holds_above_it(film):
    row = CoreRace(film.tables.balls([1000.0, 2000.0, 4000.0])).row
    assert row(9000.0 * RPM_TO_RAD_S) == (1, 1.0) == row(4000.0 * RPM_TO_RAD_S)
    assert row(2000.0 * RPM_TO_RAD_S) in ((0, 1.0), (1, 0.0))


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:a ball of bearing")  # more load than the atlas has at 1 rev/min
def test_a_run_up_from_rest_begins_dry_and_without_a_jump(film, beam):
    rotor, ramp = beam(film), SpeedProfile.ramp(0.0, 1000.0, 0.02)
    run = simulate_rotor(rotor, speed_rpm=ramp, dt=5e-5, until=0.02)
    np.testing.assert_array_equal(run.displacement[0], rotor.dry.equilibrium())
    sag = np.abs(run.displacement[0]).max()
    assert 0.0 < np.abs(run.displacement[1] - run.displacement[0]).max() < 0.02 * sag
    rolling = simulate_rotor(rotor, speed_rpm=SpeedProfile.ramp(1.0, 1000.0, 0.02), dt=5e-5, until=0.02)
    assert np.abs(run.displacement[-1] - rolling.displacement[-1]).max() < 0.02 * sag


def test_forces_at_rest_do_not_jump_where_laws_change(film):
    """Of a ring that stays: value and slope at every speed that laws are made at, and between them."""
    knots, place = law_speeds(RANGE), film.equilibrium((0.0, -500.0), speed_rpm=3000.0).displacement

    def force(rpm, speeds=knots):
        return motion_of(film, speeds.tolist(), ("x", "y")).rest(rpm * RPM_TO_RAD_S, -1.4, place)[1]

    assert knots.size == 14
    for speed in knots[1:-1]:
        steps = [force(speed * (1.0 + share)) for share in (-1e-3, -1e-9, 0.0, 1e-9, 1e-3)]
        left, right = (steps[2] - steps[0]) / 1e-3, (steps[4] - steps[2]) / 1e-3
        assert abs(steps[3] - steps[1] - 1e-9 * (left + right)) < 1e-10 * abs(steps[2])
        assert right == pytest.approx(left, rel=0.015)
    for speed in np.sqrt(knots[1:] * knots[:-1]):
        assert force(speed) == pytest.approx(force(speed, np.array([speed])), rel=1e-4)


HOUSING = {"housing_mass": 2.0, "housing_stiffness": (8e7, 2e8), "housing_damping": 300.0}


@pytest.fixture(scope="module")
def overhung(film, oil):
    """Two kinds of bearing, one in a housing on springs, and a disc beyond them; no mode too fast for steps."""
    loose = BallBearing.catalogue("6204", oil=oil, clearance=4e-6)
    return rotor_on_bearings(
        Shaft(length=0.3, diameter=0.025, density=0.0),
        discs=[Disc.cylinder(position=0.3, diameter=0.2, width=0.03, bore=0.025, unbalance=1e-5)],
        supports=[
            Support(position=0.02, bearing=film, journal_mass=0.5),
            Support(position=0.17, bearing=loose, journal_mass=0.5, **HOUSING),
        ],
    )


COURSE = SpeedProfile(np.array([0.0, 0.02, 0.04]), np.array([3000.0, 8000.0, 6000.0]))


@pytest.mark.long
def test_run_ups_are_of_second_order(overhung):
    """Up and down through four laws: errors fall fourfold with half the step."""
    ends = [
        simulate_rotor(overhung, speed_rpm=COURSE, dt=dt, until=0.04).displacement[:: round(2e-5 / dt)]
        for dt in (2e-5, 1e-5, 5e-6, 1.25e-6)
    ]
    errors = [np.sqrt(np.mean((end - ends[-1]) ** 2)) for end in ends[:-1]]
    assert errors[0] < 2e-4 * ends[-1].std()
    assert errors[1] < 0.3 * errors[0] and errors[2] < 0.075 * errors[0]


def test_energy_is_kept_as_the_speed_changes(overhung):
    """What unbalance, weight and gyroscopic forces put in is stored, or taken by bearings and dampers."""
    dt = 2.5e-6
    run = simulate_rotor(overhung, speed_rpm=COURSE, dt=dt, until=0.04, rho_inf=1.0)
    assert run.speed_rpm[-1] == pytest.approx(6000.0)
    q, v = run.displacement, run.velocity
    forces, at = turning_forces(overhung, *COURSE.at(run.t))
    power = np.einsum("ij,ij->i", forces, v @ at) + v @ overhung.load
    taken = np.einsum("ij,ij->i", run.force, v @ overhung.support_rows.T)
    taken += np.einsum("ij,jk,ik->i", v, overhung.damping, v)
    stored = 0.5 * np.einsum("ij,jk,ik->i", v, overhung.mass, v)
    stored += 0.5 * np.einsum("ij,jk,ik->i", q, overhung.stiffness, q)
    work, lost, moved = (np.sum(0.5 * (p[1:] + p[:-1])) * dt for p in (power, taken, np.abs(power)))
    assert abs(work - lost - (stored[-1] - stored[0])) < 1e-3 * moved
    assert abs(lost) > 0.01 * moved  # without what is taken it would not close


@pytest.fixture(scope="module")
def passage():
    return script("examples/studies/ball_passage.py")


@pytest.fixture(scope="module")
def runs(passage, film):
    return tuple(passage.run(film, course) for course in passage.courses())


@pytest.mark.slow
def test_modes_swing_most_at_the_crossings_of_the_diagram(passage, film, runs):
    """All four modes at the ball passage, up and down, and at twice it on the way up."""
    diagram = campbell(passage.rotor(film), passage.SPEEDS, count=4)
    found = passage.peaks(film, diagram, runs)
    assert [(peak.passages, peak.crossing.mode) for peak in found] == [(n, m) for n in (1, 2) for m in range(4)]
    for peak in found:
        crossing = peak.crossing.speed_rpm
        assert peak.height > 3.0
        assert crossing < peak.up < 1.05 * crossing
        assert peak.up == pytest.approx(peak.expected_up, rel=0.01)
        if peak.passages == 1:
            assert 0.95 * crossing < peak.down < crossing
            assert peak.down == pytest.approx(peak.expected_down, rel=0.005)
            assert 0.5 * (peak.up + peak.down) == pytest.approx(crossing, rel=0.005)


def roughness(run, speed):
    """Largest fourth difference of the rings' forces as the speed is passed, over the largest beside it."""
    at = int(np.searchsorted(run.speed_rpm, speed))
    rough = np.abs(np.diff(run.force[at - 400 : at + 400], n=4, axis=0))
    return (rough[394:402].max(axis=0) / np.concatenate([rough[:380], rough[420:]]).max(axis=0)).max()


@pytest.mark.slow
def test_forces_in_the_run_do_not_jump_where_laws_change(passage, runs):
    """No rougher than 20 ms beside; a jump by a thousandth of the load would be."""
    run = runs[0]
    for speed in law_speeds(RANGE)[1:-1]:
        assert roughness(run, speed) < 1.0
    slow = law_speeds(RANGE)[1:9]  # above, balls shake the rotor more than that
    for speed in slow:
        jumped = run.force.copy()
        jumped[run.speed_rpm >= speed, 1::2] += 0.5
        assert roughness(RotorResult(**(vars(run) | {"force": jumped})), speed) > 2.0


@pytest.mark.slow
def test_the_run_up_does_not_depend_on_the_step(passage, film, runs):
    """Of second order through four resonances that ring on; the mean deflection does not care."""
    x, up = [passage.rotor(film).nodes["disc"][k] for k in "xy"], passage.courses()[0]
    finest, fine = (passage.run(film, up, passage.DT / n) for n in (4, 2))
    orbits = [one.displacement[::n][:, x] for one, n in ((finest, 4), (fine, 2), (runs[0], 1))]
    near, far = (np.sqrt(np.mean((orbit - orbits[0]) ** 2)) / orbits[0].std() for orbit in orbits[1:])
    assert near < 0.008 and far < 0.035
    assert far > 4.0 * near  # 5, the finest having a quarter of the error of the other
    means = [orbit[:, 1].mean() for orbit in orbits]
    np.testing.assert_allclose(means, means[0], rtol=5e-5)


@pytest.mark.slow
def test_the_figure(passage, film, runs, tmp_path):
    diagram = campbell(passage.rotor(film), passage.SPEEDS, count=4)
    figure = passage.picture(tmp_path / "passage.png", film, diagram, runs)
    assert (tmp_path / "passage.png").read_bytes().startswith(b"\x89PNG") and len(figure.axes) == 5
