"""A bearing in continuous time: states that do not follow one another, their rates and forces in Python."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from fmu.bearing.places import rates_of
from fmu.bearing.set_model import SetModel
from fmu.bearing.trial import START
from fmu.bearing.variables import BallStates
from fmu.references.series import rounded
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

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


def state_points(model: BearingModel | SetModel, count: int = POINTS, seed: int = 2) -> StatePoints:
    """States about rest under the start values of the inputs, moved at random; rates and forces there."""
    rng, n = np.random.default_rng(seed), len(model.directions)
    states_of = [_BallSizes(seat.model) for seat in model.seats]
    moved = [rng.normal(size=(count, own.sizes.size)) * own.sizes for own in states_of]
    turned = rng.uniform(0.0, 1.0, count)
    fastest = float(model.speeds[-1]) * RPM_TO_RAD_S
    size = np.ones(n)
    diameter = max(seat.model.bearing.pitch_diameter for seat in model.seats)
    size[[name.startswith("tilt") for name in model.directions]] = 2.0 / diameter
    place = rounded(model.place + DEEP * size * rng.normal(size=(count, n)))
    velocity = rounded(FAST * size * rng.normal(size=(count, n)))
    speed = fastest * np.linspace(1.0, 1.0 - SLOWER, count)
    force = np.tile(model.constant_force, (count, 1))
    columns = []
    for seat, own, by in zip(model.seats, states_of, moved, strict=True):
        in_time = rates_of(seat.model)
        rings = np.array([seat.ring(at) for at in place])
        if seat.model.angular:  # balls are near their balance there: little damps them across their contacts
            angles = (START + turned).tolist()
            states = np.array([in_time.rest(fastest, *at) for at in zip(angles, rings, strict=True)])
            states[:, 1 + own.sizes.size :] *= SETTLING
        else:
            states = np.tile(in_time.rest(fastest, START, seat.ring(model.place)), (count, 1))
        states[:, 0] = START + turned
        states[:, 1 : 1 + own.sizes.size] += np.where(own.kinds == "w", np.abs(by), by)
        states, moving = rounded(states), velocity @ seat.rows.T
        found = [in_time.at(*row) for row in zip(speed.tolist(), states, rings, moving, strict=True)]
        rates, pushed = (np.array(part) for part in zip(*found, strict=True))
        force -= pushed @ seat.rows
        columns.append((states, rates))
    states, rates = (np.concatenate(parts, axis=1) for parts in zip(*columns, strict=True))
    return StatePoints(states, rates, place, velocity, speed, force)


class _BallSizes:
    """Kinds of the states of the balls of a bearing, and how far they are moved."""

    def __init__(self, model: BearingModel) -> None:
        balls = BallStates.of(model).balls
        self.kinds = np.array([state.kind for ball in balls for state in ball], str)
        self.sizes = np.array([CLOSER * state.nominal for ball in balls for state in ball])
        self.sizes[self.kinds == "a"] *= ASIDE
