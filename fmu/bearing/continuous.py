"""A bearing in continuous time: states that do not follow one another, their rates and forces in Python."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from fmu.bearing.places import rates_of
from fmu.bearing.trial import START
from fmu.bearing.variables import BallStates
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


def state_points(model: BearingModel, count: int = POINTS, seed: int = 2) -> StatePoints:
    """States about rest under the start values of the inputs, moved at random; rates and forces there."""
    rng, in_time, n = np.random.default_rng(seed), rates_of(model), len(model.directions)
    made = BallStates.of(model)
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
        states = np.array([in_time.rest(fastest, *at) for at in zip(angles, place, strict=True)])
        states[:, 1 + sizes.size :] *= SETTLING
    else:
        states = np.tile(in_time.rest(fastest, START, model.place), (count, 1))
    states[:, 0] = START + turned
    states[:, 1 : 1 + sizes.size] += np.where(kinds == "w", np.abs(moved), moved)
    found = [in_time.at(*row) for row in zip(speed.tolist(), states, place, velocity, strict=True)]
    rates, pushed = (np.array(part) for part in zip(*found, strict=True))
    return StatePoints(states, rates, place, velocity, speed, -pushed)
