"""A planar bearing in continuous time: states that do not follow one another, their rates and forces in Python."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from fmu.bearing.trial import START
from fmu.bearing.variables import BallStates
from reduced_models.bearing.balls import POSITION, directions, speed_state
from reduced_models.bearing.continuous_time import bearing_rates
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import BallMotion

_Floats = NDArray[np.float64]

POINTS = 8
DEEP, FAST = 3e-6, 2e-3  # m and m/s, size of the ring's motion
CLOSER = 0.3  # of the nominal place of a ball: how far it is moved outward, so that the outer race carries it
SLOWER = 0.2  # of the speed of the shaft, at the last point


@dataclass(frozen=True)
class StatePoints:
    """States and inputs, and what follows from them.

    Attributes
    ----------
    states, rates : ndarray, shape (k, n)
        Angle of the cage, balls and films, seat, as the FMU has them.
    place, velocity : ndarray, shape (k, 2)
        Of the ring [m], [m/s].
    speed : ndarray, shape (k,)
        Of the shaft [rad/s].
    force : ndarray, shape (k, 2)
        On the inner ring [N].
    """

    states: _Floats
    rates: _Floats
    place: _Floats
    velocity: _Floats
    speed: _Floats
    force: _Floats


def state_points(model: BearingModel, count: int = POINTS, seed: int = 2) -> StatePoints:
    """States about rest under the start values of the inputs, moved at random; rates and forces there."""
    rng, made, motion = np.random.default_rng(seed), BallStates.of(model), model.motion()
    assert isinstance(motion, BallMotion)
    sizes = np.array([CLOSER * one.nominal for ball in made.balls for one in ball])
    kept = np.array([one.kind == "w" for ball in made.balls for one in ball], bool)
    fastest = float(model.speeds[-1]) * RPM_TO_RAD_S
    states = np.tile(_rest_states(model, motion, fastest), (count, 1))
    moved = rng.normal(size=(count, sizes.size)) * sizes
    states[:, 1 : 1 + sizes.size] += np.where(kept, np.abs(moved), moved)
    states[:, 0] += rng.uniform(0.0, 1.0, count)
    place = model.place + DEEP * rng.normal(size=(count, 2))
    velocity = FAST * rng.normal(size=(count, 2))
    speed = fastest * np.linspace(1.0, 1.0 - SLOWER, count)
    found = [rates_in_time(motion, *row) for row in zip(states, place, velocity, speed.tolist(), strict=True)]
    rates, force = (np.array(part) for part in zip(*found, strict=True))
    return StatePoints(states, rates, place, velocity, speed, force)


def _rest_states(model: BearingModel, motion: BallMotion, speed: float) -> _Floats:
    """States of the bearing at rest [rad], [m], [N]."""
    made, angle, place = BallStates.of(model), START, model.place
    force = motion.rest(speed, angle, place)
    balls = np.zeros((motion.balls.number, len(made.balls[0])))
    balls[:, :1] = motion.films.balls[:, POSITION : POSITION + min(1, balls.shape[1])]
    return np.concatenate([[angle], balls.ravel(), np.tile(force, len(made.seat) // 2)])


def rates_in_time(
    motion: BallMotion, states: _Floats, place: _Floats, velocity: _Floats, speed: float
) -> tuple[_Floats, _Floats]:
    """Rates of the states, and the force on the inner ring, shape (2,) [N]."""
    rates = np.zeros(states.size)
    balls, (gains, poles) = motion.balls, motion.balls.loss
    end = states.size - 2 * gains.size
    if end > 1:
        normals, force, of_balls = np.zeros((balls.number, 2)), np.zeros(2), np.zeros(end - 1)
        directions(balls, float(states[0]), normals)
        at_speed = speed_state(balls, speed)
        bearing_rates(balls, at_speed, normals, states[1:end], place, velocity, of_balls, force)
        rates[1:end] = of_balls
    else:  # dry balls are where they are at rest
        force = motion.rest(speed, float(states[0]), place)
    lost = force - states[end:].reshape(-1, 2)
    rates[0] = balls.cage * speed
    rates[end:] = (poles[:, None] * lost).ravel()
    return rates, -(force + gains @ lost)
