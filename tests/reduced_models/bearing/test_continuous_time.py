"""Bearings in continuous time: rest, origins of places, and steps by which scipy's Radau is reached."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ehlcontact import Lubricant
from reduced_models import BallBearing
from reduced_models.bearing.continuous_time import BearingRates
from reduced_models.bearing.core_bearing import ORIGIN
from reduced_models.bearing.freedoms import FIVE, PLANAR
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import BallMotion
from reduced_models.bearing.ring_statics import static_ring

RPM, ANGLE = 8000.0, -1.3
OMEGA = RPM * RPM_TO_RAD_S
SIZES = np.array([1.0, 1.0, 1.0, 50.0, 50.0])  # of tilts beside lengths
AT = np.array([1e-6, -9e-6, 1.2e-5, 1e-4, -2e-4])
ACROSS = 1e-6  # N s/m: balls follow within nanoseconds


OIL = Lubricant.iso_vg(46, temperature=70.0)
SIZE = {"balls": 4, "ball_diameter": 7.94e-3, "pitch_diameter": 38.5e-3}
CURVED = {"conformity_inner": 0.52, "conformity_outer": 0.53}


def angular(**changes):
    return BallBearing(**{**SIZE, **CURVED, "contact_angle": np.radians(25.0), "oil": OIL} | changes)


def planar(**changes):
    return BallBearing(**{**SIZE, **CURVED, "clearance": -2e-6, "oil": OIL} | changes)


def nominal(balls):
    """Origins on the line between both groove centres of a ring in the middle."""
    g, found = balls.grooves, np.zeros(balls.number, ORIGIN)
    found["place"] = g.outer * np.array([g.radial, g.axial]) / np.hypot(g.radial, g.axial)
    found["across"] = ACROSS
    return found


def made(bearing):
    directions = PLANAR if bearing.contact_angle is None else FIVE
    balls = bearing.tables.balls(RPM)
    return balls, directions, AT[: len(directions)]


BEARINGS = {
    "planar": planar,
    "loss": lambda: planar(loss_factor=0.05),
    "five": angular,
    "shared": lambda: angular(race_control="shared"),
    "inertia": lambda: angular(ball_inertia=True),
    "dry": lambda: angular(oil=None),
}
each_bearing = pytest.mark.parametrize("make", BEARINGS.values(), ids=BEARINGS)


@each_bearing
def test_balls_at_rest_stay(make):
    """Rates are those of rounding, beside those of a ring that moves; the force is that of the static ring."""
    bearing = make()
    balls, directions, q = made(bearing)
    rates = BearingRates(balls, directions, nominal(balls), cage_held=True)
    states = rates.rest(OMEGA, ANGLE, q)
    still, force = rates.at(OMEGA, states, q, 0.0 * q)
    moving, _ = rates.at(OMEGA, states, q, 1e-3 * SIZES[: q.size])
    assert np.abs(still[1:]).max(initial=0.0) <= 1e-6 * np.abs(moving[1:]).max(initial=0.0)
    ring = static_ring(bearing, RPM, ANGLE, q.size)
    ring.press(q)
    assert force == pytest.approx(ring.load, rel=1e-9, abs=1e-9 * np.abs(ring.load).max())
    found = ring.describe()[0]
    turning = OMEGA * np.average(found["orbit"], weights=found["load"][:, 0])
    assert still[0] == pytest.approx(turning, rel=1e-9)


@each_bearing
def test_places_count_from_any_origin(make):
    """With the inner groove centres moved there, or not: one ball, one rate."""
    balls, directions, q = made(make())
    origins, rng = nominal(balls), np.random.default_rng(4)
    here = BearingRates(balls, directions, origins)
    states = here.rest(OMEGA, ANGLE, q)
    places = 1 if directions == PLANAR else 2
    own = places * (2 if balls.inertia else 1 if balls.inner.x.size else 0)
    seat = balls.loss.gains.size * len(directions)
    of_balls = states[1 : states.size - seat].reshape(balls.number, -1)
    of_balls += 1e-9 * rng.normal(size=of_balls.shape)
    other = origins.copy()
    shift = rng.normal(size=(balls.number, 2)) * [1e-6, 0.0 if places == 1 else 1e-6]
    other["place"] += shift
    other["moved"] = rng.normal(size=(balls.number, 2)) * [1e-5, 0.0 if places == 1 else 1e-5]

    def turned(x, at, by):
        """Parts along `at` and across it of vectors with such parts about `by`."""
        e, f = (one["place"] / np.hypot(*one["place"].T)[:, None] for one in (at, by))
        along, aside = (e * f).sum(axis=1), f[:, 0] * e[:, 1] - f[:, 1] * e[:, 0]
        return np.stack([along * x[:, 0] + aside * x[:, 1], along * x[:, 1] - aside * x[:, 0]], axis=1)

    def recounted(balls_states, at, by, shift):
        found = balls_states.copy()
        for first in range(0, own, places):
            vectors = np.zeros((len(found), 2))
            vectors[:, :places] = found[:, first : first + places]
            vectors = turned(vectors, at, by)
            if first == 0:
                e = at["place"] / np.hypot(*at["place"].T)[:, None]
                vectors -= np.stack(
                    [(e * shift).sum(axis=1), e[:, 0] * shift[:, 1] - e[:, 1] * shift[:, 0]], axis=1
                )
            found[:, first : first + places] = vectors[:, :places]
        return found

    v = 1e-3 * SIZES[: q.size]
    expected, force = here.at(OMEGA, states, q, v)
    there, moved = BearingRates(balls, directions, other), states.copy()
    moved[1 : states.size - seat] = recounted(of_balls, other, origins, shift).ravel()
    found, pushed = there.at(OMEGA, moved, q, v)
    back = found[1 : states.size - seat].reshape(balls.number, -1)
    found[1 : states.size - seat] = recounted(back, origins, other, 0.0 * shift).ravel()
    assert pushed == pytest.approx(force, rel=1e-9, abs=1e-9 * np.abs(force).max())
    assert found == pytest.approx(expected, rel=1e-7, abs=1e-9 * np.abs(expected).max())


@pytest.mark.long
@pytest.mark.parametrize("kind", [planar, angular])
def test_steps_converge_to_it_with_second_order(kind):
    """Forces along a vibration of the ring by scipy's Radau, and by steps of three lengths."""
    balls, directions, q = made(kind(balls=3))
    times, size = 4e-6 * np.arange(1, 11), 1e-6 * SIZES[: q.size]
    turn = 2.0 * np.pi / 8e-5 * (1.0 + 0.1 * np.arange(q.size))

    def ring(t):
        return q + size * np.sin(turn * t) ** 2, size * turn * np.sin(2.0 * turn * t)

    rates = BearingRates(balls, directions, nominal(balls))
    start = rates.rest(OMEGA, ANGLE, q)
    unit = np.full(start.size, 1e-6)
    unit[0] = 1e-3
    run = solve_ivp(
        lambda t, x: rates.at(OMEGA, start + unit * x, *ring(t))[0] / unit,
        (0.0, times[-1]), 0.0 * start, method="Radau", rtol=1e-7, atol=1e-8,
        t_eval=times,
    )  # fmt: skip
    exact = np.array([
        rates.at(OMEGA, start + unit * x, *ring(at))[1] for at, x in zip(times, run.y.T, strict=True)
    ]) * SIZES[: q.size]  # fmt: skip
    errors = []
    for steps in (4, 8, 16):
        motion, dt = BallMotion(balls, directions), times[0] / steps
        motion.rest(OMEGA, ANGLE, q)
        motion.begin(OMEGA, dt)
        path, speed = np.array([ring(dt * k) for k in range(1, steps * times.size + 1)]).transpose(1, 0, 2)
        force, _ = motion.drive(OMEGA, dt, path, speed)
        errors.append(
            np.abs(force[steps - 1 :: steps] * SIZES[: q.size] - exact).max() / np.ptp(exact, axis=0).max()
        )
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.15)
    assert errors[2] < 1e-6
