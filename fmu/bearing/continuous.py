"""A bearing in continuous time: states that do not follow one another, their rates and forces in Python."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from fmu.bearing.places import counted_from
from fmu.bearing.trial import START
from fmu.bearing.variables import BallStates
from reduced_models.bearing.continuous_time import RestingBalls, rates_with_cage
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import BallMotion

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
    rng, made, motion, n = np.random.default_rng(seed), BallStates.of(model), model.motion(), len(model.directions)
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
    if (
        model.angular
    ):  # balls are near their balance at the place of the ring: little damps them across their contacts
        angles = (START + turned).tolist()
        states = np.array([rest_states(model, motion, fastest, *at) for at in zip(angles, place, strict=True)])
        states[:, 1 + sizes.size :] *= SETTLING
    else:
        states = np.tile(rest_states(model, motion, fastest, START, model.place), (count, 1))
    states[:, 0] = START + turned
    states[:, 1 : 1 + sizes.size] += np.where(kinds == "w", np.abs(moved), moved)
    counted = counted_from(model)
    found = [
        rates_in_time(model, motion, *row, counted)
        for row in zip(states, place, velocity, speed.tolist(), strict=True)
    ]
    rates, force = (np.array(part) for part in zip(*found, strict=True))
    return StatePoints(states, rates, place, velocity, speed, force)


def rest_states(model: BearingModel, motion: BallMotion, speed: float, angle: float, place: _Floats) -> _Floats:
    """States of the bearing at rest [rad], [m], [N], [N m]; those of films are 0."""
    made, counted = BallStates.of(model), counted_from(model)
    force = motion.rest(speed, angle, place)
    (r, z), (e_r, e_z) = (motion.places - counted.place).T, counted.place[0] / np.hypot(*counted.place[0])
    own = {"w": e_r * r + e_z * z, "a": e_r * z - e_z * r}
    balls = [
        [own[state.kind][k] if state.kind in own else 0.0 for state in ball] for k, ball in enumerate(made.balls)
    ]
    return np.concatenate([[angle], np.ravel(balls), np.tile(force, len(made.seat) // len(model.directions))])


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

    Places of balls are `counted` from theirs.
    """
    rates, n, count = np.zeros(states.size), place.size, motion.balls.number
    gains, poles = motion.balls.loss
    end, angle = states.size - n * gains.size, float(states[0])
    if end == 1:  # dry balls are where they are at rest
        force = motion.rest(speed, angle, place)
        rates[0] = speed * motion.cage
    else:  # directions, and places of balls, that the FMU does not have stay 0
        all_own = ("w", "a", "v", "v_a") if counted.inertia else ("w", "a")
        kinds = [state.kind for state in BallStates.of(model).balls[0]]
        own = [all_own.index(kind) for kind in kinds if kind in all_own]
        films = len(kinds) - len(own)
        columns = [*own, *range(len(all_own), len(all_own) + films)]
        of_balls, ball_rates = np.zeros((count, len(all_own) + films)), np.zeros(count * (len(all_own) + films))
        of_balls[:, columns] = states[1:end].reshape(count, -1)
        q, v, pushed = np.zeros((3, len(FIVE)))
        q[:n], v[:n] = place, velocity
        balls = motion.balls._replace(omega=speed)
        rates[0] = rates_with_cage(balls, counted, angle, of_balls.ravel(), q, v, ball_rates, pushed)
        rates[1:end] = ball_rates.reshape(count, -1)[:, columns].ravel()
        force = pushed[:n]
    lost = force - states[end:].reshape(-1, n)
    rates[end:] = (poles[:, None] * lost).ravel()
    return rates, -(force + gains @ lost)
