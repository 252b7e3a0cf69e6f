"""A bearing in continuous time: states that do not follow one another, their rates and forces in Python."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from fmu.bearing.places import counted_from
from fmu.bearing.trial import START
from fmu.bearing.variables import BallStates
from reduced_models.bearing.balls import directions, speed_state
from reduced_models.bearing.continuous_time import RestingBalls, bearing_rates, rates_with_cage
from reduced_models.bearing.freedoms import PLANAR
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import BallMotion
from reduced_models.bearing.race import RACES

_Floats = NDArray[np.float64]

POINTS = 8
DEEP, FAST = 3e-6, 2e-3  # m and m/s, size of the ring's motion
CLOSER = 0.3  # of the nominal place of a ball: how far it is moved outward, so that the outer race carries it
ASIDE = 0.1  # of that, across its contacts, where little damps a ball: it is never far from its balance
SETTLING = 0.9  # of the force, that the seat of such a ring remembers
SLOWER = 0.2  # of the speed of the shaft, at the last point


@dataclass(frozen=True)
class StatePoints:
    """States and inputs, and what follows from them.

    Attributes
    ----------
    states, rates : ndarray, shape (k, n)
        Angle of the cage, balls and films, seat, as the FMU has them.
    place, velocity : ndarray, shape (k, n)
        Of the ring [m] and [rad], [m/s] and [rad/s].
    speed : ndarray, shape (k,)
        Of the shaft [rad/s].
    force : ndarray, shape (k, n)
        On the inner ring [N], [N m].
    """

    states: _Floats
    rates: _Floats
    place: _Floats
    velocity: _Floats
    speed: _Floats
    force: _Floats


def state_points(model: BearingModel, count: int = POINTS, seed: int = 2) -> StatePoints:
    """States about rest under the start values of the inputs, moved at random; rates and forces there."""
    rng, made, motion, n = np.random.default_rng(seed), BallStates.of(model), model.motion(), len(model.names)
    kinds = np.array([one.kind for ball in made.balls for one in ball], str)
    sizes = np.array([CLOSER * one.nominal for ball in made.balls for one in ball])
    sizes[kinds == "a"] *= ASIDE
    fastest = float(model.speeds[-1]) * RPM_TO_RAD_S
    moved = rng.normal(size=(count, sizes.size)) * sizes
    turned = rng.uniform(0.0, 1.0, count)
    size = np.ones(n)
    size[3:] = 2.0 / model.bearing.pitch_diameter
    place = model.place + DEEP * size * rng.normal(size=(count, n))
    velocity = FAST * size * rng.normal(size=(count, n))
    speed = fastest * np.linspace(1.0, 1.0 - SLOWER, count)
    if n == len(PLANAR):
        states = np.tile(_rest_states(model, motion, fastest, START, model.place), (count, 1))
    else:  # a ball at contact angles is near its balance at the place of the ring
        angles = (START + turned).tolist()
        states = np.array([_rest_states(model, motion, fastest, *at) for at in zip(angles, place, strict=True)])
        states[:, 1 + sizes.size :] *= SETTLING
    states[:, 0] = START + turned
    states[:, 1 : 1 + sizes.size] += np.where(kinds == "w", np.abs(moved), moved)
    counted = counted_from(model)
    found = [
        rates_in_time(model, motion, *row, counted)
        for row in zip(states, place, velocity, speed.tolist(), strict=True)
    ]
    rates, force = (np.array(part) for part in zip(*found, strict=True))
    return StatePoints(states, rates, place, velocity, speed, force)


def _rest_states(model: BearingModel, motion: BallMotion, speed: float, angle: float, place: _Floats) -> _Floats:
    """States of the bearing at rest [rad], [m], [N], [N m]; those of films are 0."""
    made = BallStates.of(model)
    force = motion.rest(speed, angle, place)
    balls = np.zeros((motion.balls.number, len(made.balls[0])))
    if place.size == len(PLANAR):
        balls[:, :1] = [[motion.approach(k, RACES[1])][: balls.shape[1]] for k in range(motion.balls.number)]
    elif balls.size:
        counted = counted_from(model)
        (r, z), (e_r, e_z) = (motion.films.place - counted.place).T, counted.place[0] / np.hypot(*counted.place[0])
        balls[:, 0], balls[:, 1] = e_r * r + e_z * z, e_r * z - e_z * r
    return np.concatenate([[angle], balls.ravel(), np.tile(force, len(made.seat) // len(model.names))])


def rates_in_time(
    model: BearingModel,
    motion: BallMotion,
    states: _Floats,
    place: _Floats,
    velocity: _Floats,
    speed: float,
    counted: RestingBalls,
) -> tuple[_Floats, _Floats]:
    """Rates of the states, and the force on the inner ring, shape (n,) [N], [N m].

    Places of balls at contact angles are `counted` from theirs.
    """
    rates, n = np.zeros(states.size), place.size
    gains, poles = motion.balls.loss
    end, angle = states.size - n * gains.size, float(states[0])
    force, of_balls = np.zeros(n), np.zeros(end - 1)
    if end == 1:  # dry balls are where they are at rest
        force = motion.rest(speed, angle, place)
    if n > len(PLANAR):
        balls = motion.balls._replace(omega=speed)
        given = states[1:end], place, velocity, of_balls, force
        rates[0] = rates_with_cage(balls, counted, angle, *given) if end > 1 else speed * motion.films.cage[2]
    else:
        planar = model.bearing._kernel(model.speeds)
        rates[0] = planar.cage * speed
        if end > 1:
            normals = np.zeros((planar.number, 2))
            directions(planar, angle, normals)
            at_speed = speed_state(planar, speed)
            bearing_rates(planar, at_speed, normals, states[1:end], place, velocity, of_balls, force)
    rates[1:end] = of_balls
    lost = force - states[end:].reshape(-1, n)
    rates[end:] = (poles[:, None] * lost).ravel()
    return rates, -(force + gains @ lost)
