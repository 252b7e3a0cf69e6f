"""The compiled bearing against slow twins, and its tangents against differences."""

from math import pi

import numpy as np
import pytest
from beam_rotor import still_motion
from bearing_twins import SlowBearing, SlowContact, SlowElement

from ehlcontact import Lubricant, OilLayer
from reduced_models import BallBearing
from reduced_models.bearing.freedoms import FIVE, PLANAR
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import BearingMotion, motion_of

RPM = 3000.0
POSITION = np.array([1e-6, -12e-6])

# the elements of light balls say what the bearing does not: that they are below the lightest load of the atlas
light = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")


def motion(bearing, dt, rpm=RPM, angle=-pi / 2.0):
    return BearingMotion(bearing, rpm, dt, angle)


def assert_same_forces(fast, slow, q, v, dt):
    """Of all balls, over a motion in steps of `dt`."""
    _, balls = fast.drive(q, v)
    for place, rate, found in zip(q, v, balls, strict=True):
        forces, _ = slow.step(dt, place, rate)
        np.testing.assert_allclose(found, forces, rtol=0.0, atol=1e-10 * forces.max())


@pytest.mark.parametrize("clearance", [0.0, 2e-5, -5e-6])
@pytest.mark.parametrize("rpm", [RPM, 9000.0])
def test_at_rest_it_is_two_elements_in_series(oil, clearance, rpm):
    bearing = BallBearing.catalogue("6205", oil=oil, clearance=clearance)
    fast = motion(bearing, 1e-5, rpm, 0.3)
    force = fast.rest(POSITION)
    forces, net = SlowBearing(bearing, rpm, SlowElement, 0.3).rest(POSITION)
    np.testing.assert_allclose(fast._motion.loads, forces, rtol=0.0, atol=1e-10 * forces.max())
    np.testing.assert_allclose(force, net, rtol=0.0, atol=1e-10 * forces.max())


@pytest.mark.parametrize("dt", [1e-6, 2e-5, 1e-4])
def test_in_motion_it_is_its_twin(film, shake, dt):
    q, v = shake(dt, 12)
    fast, slow = motion(film, dt), SlowBearing(film, RPM, SlowContact)
    fast.rest(POSITION)
    slow.rest(POSITION)
    assert_same_forces(fast, slow, q, v, dt)


def test_films_that_stop_carrying(oil, shake):
    """A limit at which some films carry all, some a part and some nothing."""
    limited = BallBearing.catalogue("6205", oil=oil, cutoff_gap=8e-6)
    q, v = shake(2e-5, 8)
    fast, slow = motion(limited, 2e-5), SlowBearing(limited, RPM, lambda e: SlowContact(e, 8e-6))
    fast.rest(POSITION)
    forces, _ = slow.rest(POSITION)
    np.testing.assert_allclose(fast._motion.loads, forces, rtol=0.0, atol=1e-10 * forces.max())
    assert 0 < np.count_nonzero(forces == 0.0) < forces.size
    assert_same_forces(fast, slow, q, v, 2e-5)


@light
def test_small_motions_are_those_of_two_elements(film):
    """Where the contacts keep their size, that own time is foreseen makes no difference."""
    dt, size = 2e-5, 1e-12
    t = dt * np.arange(1, 9)
    q = POSITION + size * np.column_stack([np.sin(4e3 * t), np.cos(3e3 * t)])
    v = size * np.column_stack([4e3 * np.cos(4e3 * t), -3e3 * np.sin(3e3 * t)])
    fast, slow = still_motion(film, RPM, dt), SlowBearing(film, RPM, SlowElement)
    slow.cage = slow.centrifugal = 0.0
    fast.rest(POSITION)
    slow.rest(POSITION)
    assert_same_forces(fast, slow, q, v, dt)


@light
def test_large_motions_are_nearly_those_of_two_elements(film, shake):
    """That own time is foreseen at the start of a step, and not the mean of both ends, is hardly felt."""
    worst = []
    for dt in (2e-5, 1e-5):
        q, v = shake(dt, round(8e-4 / dt))
        fast, slow = motion(film, dt), SlowBearing(film, RPM, SlowElement)
        fast.rest(POSITION)
        slow.rest(POSITION)
        force, _ = fast.drive(q, v)
        net = np.array([slow.step(dt, place, rate)[1] for place, rate in zip(q, v, strict=True)])
        worst.append(np.abs(force - net).max() / np.ptp(net[:, 1]))
    assert worst[0] < 1e-6  # of the swing; own time frozen at the start costs 3e-5
    assert worst[1] < 0.7 * worst[0]


@pytest.mark.parametrize("speeds", [RPM, (2000.0, 3700.0)])  # a law of its own, or between two
@pytest.mark.parametrize("changes", [{}, {"cutoff_gap": 8e-6}, {"loss_factor": 0.2}])
@pytest.mark.parametrize("dt", [1e-6, 2e-5, 1e-3])
def test_tangents_are_those_of_differences(oil, shake, dt, changes, speeds):
    bearing = BallBearing.catalogue("6205", oil=oil, clearance=3e-6, **changes)
    q, v = shake(dt, 6)
    it, omega = motion_of(bearing, np.atleast_1d(speeds).tolist(), PLANAR), RPM * RPM_TO_RAD_S
    it.rest(omega, 0.2, POSITION)
    it.drive(omega, dt, q[:5], v[:5])
    it.begin(omega, dt)
    _, stiffness, damping = it.forces(q[5], v[5])
    for k in range(2):
        for matrix, size, moves in ((stiffness, 1e-9, (1.0, 0.0)), (damping, 1e-2 * np.abs(v).max(), (0.0, 1.0))):

            def at(steps, size=size, moves=moves, k=k):
                move = steps * size * np.eye(2)[k]
                return it.forces(q[5] + moves[0] * move, v[5] + moves[1] * move)[0]

            slope = (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12.0 * size)
            np.testing.assert_allclose(slope, matrix[:, k], rtol=0.0, atol=1e-6 * np.abs(matrix).max())


def test_trying_does_not_move(film, shake):
    q, v = shake(2e-5, 3)
    once, often = motion(film, 2e-5), motion(film, 2e-5)
    for it in (once, often):
        it.rest(POSITION)
    for place, rate in zip(q, v, strict=True):
        for _ in range(2):
            often.forces(place + 1e-6, rate - 1e-3)
        often.forces(place, rate)
        often.accept()
    once.drive(q, v)
    np.testing.assert_allclose(often._motion.state, once._motion.state, rtol=1e-9, atol=1e-20)
    assert often.cage_angle == once.cage_angle


def test_dry_balls_in_motion_are_hertzian(dry, shake):
    q, v = shake(2e-5, 5)
    it = motion(dry, 2e-5, 0.0)
    it.rest(POSITION)
    force, balls = it.drive(q, v)
    kn = [dry.race(race).kn ** (-2.0 / 3.0) for race in ("inner", "outer")]
    psi = -pi / 2.0 + 2.0 * pi / 9.0 * np.arange(9)
    delta = np.maximum(np.outer(q[:, 0], np.cos(psi)) + np.outer(q[:, 1], np.sin(psi)), 0.0)
    expected = (delta / sum(kn)) ** 1.5
    np.testing.assert_allclose(balls, np.repeat(expected[:, :, None], 2, axis=2), atol=1e-7)
    np.testing.assert_allclose(force[:, 1], expected @ np.sin(psi), rtol=1e-9)


@pytest.mark.parametrize(
    ("name", "speed", "k"),
    [("6305", None, 18), ("7205", 6.0, 6), ("7205", 12.0, 5)],  # the last one's search renews forces of inertia
)
def test_the_balance_of_a_ball_does_not_depend_on_where_the_ring_was_tried(name, speed, k):
    """A ring that leaves balls at some m/s: their films hold and push, and they have several balances."""
    bearing = BallBearing.catalogue(name, oil=Lubricant.iso_vg(46, temperature=80.0))
    dt, n = 1e-5, 2 if speed is None else 5
    start, t = np.zeros(n), np.arange(1, k + 2) * dt
    start[1:3] = (-3e-5, 1e-5)[: n - 1]
    q, v = np.tile(start, (k + 1, 1)), np.zeros((k + 1, n))
    if speed is None:
        w, size = 2.0 * pi / (20.0 * dt), 2e-4
        q[:, 0], v[:, 0] = size * np.sin(w * t), size * w * np.cos(w * t)
        q[:, 1], v[:, 1] = q[:, 1] + size * (np.cos(1.3 * w * t) - 1.0), -1.3 * size * w * np.sin(1.3 * w * t)
    else:
        since = np.maximum(t - 4.0 * dt, 0.0)
        q[:, 1], v[:, 1] = q[:, 1] + speed * since**2 / (8.0 * dt), speed * since / (4.0 * dt)
    found = []
    for away in (0.0, 1e-5, 2e-5, -5e-5, 1e-4):
        it = BearingMotion(bearing, 10000.0, dt, directions=FIVE[:n])
        it.rest(start)
        it.drive(q[:k], v[:k])
        if away:
            it.forces(q[k] + away * np.eye(n)[1], v[k])
        found.append([*it.forces(q[k], v[k])[0], *it._motion.core.ball_steps(it._motion.work)["force"].ravel()])
    np.testing.assert_array_equal(found, [found[0]] * len(found))


@pytest.mark.parametrize(
    ("speeds", "dt"),
    [([2000.0], 1e-5), pytest.param([2000.0, 3400.0, 5800.0, 10000.0], 1e-6, marks=pytest.mark.long)],
)
def test_balls_of_a_ring_that_is_thrown_find_their_balance(speeds, dt):
    """Films that let go: Newton's method leaps where the law has no force, or goes to and fro."""
    oil = Lubricant.iso_vg(46, temperature=80.0)
    bearing = BallBearing.catalogue("6305", oil=oil, supply=OilLayer(3e-7))
    balls, rng = motion_of(bearing, speeds, PLANAR), np.random.default_rng(0)
    omega, since = 1.2 * speeds[0] * RPM_TO_RAD_S, dt * np.arange(1, 9)
    for _ in range(600):
        start = np.array([0.0, -1e-5 * rng.uniform(0.2, 2.0)])
        thrown = rng.normal(size=2) * rng.choice([1e3, 1e4, 1e5]) * 1e-5 / dt
        balls.rest(omega, -pi / 2.0, start)
        for t in since:
            balls.begin(omega, dt)
            force, _, _ = balls.forces(start + 0.5 * thrown * t * t, thrown * t)
            assert np.isfinite(force).all()
            balls.accept()
