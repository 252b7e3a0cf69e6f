"""A run of the inner ring with lift-off, and the forces of the bearing along it, computed in Python."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from fmu.bearing.set_model import SetModel
from fmu.references.series import rounded
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

_Floats = NDArray[np.float64]

STEPS, DT = 160, 1e-5
TONES = 3  # vibrations of each displacement
LOWEST, HIGHEST = 300.0, 3000.0  # Hz
DEEP = 3e-6  # m, size of the vibration: of the approach of a ball under some hundred newton
STEEP = 3.0  # times as much along the shaft, which presses balls less
SPEED_CHANGE = 0.02  # of the speed, within the run
START = -np.pi / 2.0  # angle of the first ball


@dataclass(frozen=True)
class BearingTrial:
    """Ends of equal steps, the first one at rest.

    Attributes
    ----------
    time : ndarray, shape (k,)
    place, velocity : ndarray, shape (k, n)
    speed : ndarray, shape (k,)
        Of the shaft [rad/s].
    force : ndarray, shape (k, n)
        On the inner ring [N], [N m].
    balls : ndarray, shape (k, balls, 2)
        Load of every ball of all bearings at both races [N].
    """

    time: _Floats
    place: _Floats
    velocity: _Floats
    speed: _Floats
    force: _Floats
    balls: _Floats


def bearing_trial(
    model: BearingModel | SetModel, steps: int = STEPS, dt: float = DT, seed: int = 1
) -> BearingTrial:
    """A run from rest: vibrations in all directions, a speed that falls, balls that part from the ring."""
    rng, n = np.random.default_rng(seed), len(model.directions)
    time = np.asarray(dt * np.arange(steps + 1), np.float64)
    pressed, size = model.place.copy(), vibration_sizes(model)
    if isinstance(model, BearingModel) and model.load is None:
        pressed[0] = 0.5 * model.bearing.clearance + DEEP
        if n > 2:
            pressed[2] = DEEP
    omega = 2.0 * np.pi * rng.uniform(LOWEST, HIGHEST, (TONES, n))
    grows = np.sin(0.5 * np.pi * np.minimum(time / time[-1] * 2.0, 1.0)) ** 2
    faster = np.gradient(grows, time)
    tones = np.sin(omega * time[:, None, None]).sum(axis=1)
    slopes = (omega * np.cos(omega * time[:, None, None])).sum(axis=1)
    place = pressed + size * grows[:, None] * tones
    velocity = size * (grows[:, None] * slopes + faster[:, None] * tones)
    velocity[0] = 0.0
    top = float(model.speeds[-1]) * RPM_TO_RAD_S
    speed = np.asarray(top * (1.0 - SPEED_CHANGE * time / time[-1]), np.float64)
    return _forces(model, time, rounded(place), rounded(velocity), speed)


def vibration_sizes(model: BearingModel | SetModel) -> _Floats:
    """Sizes of vibrations of all displacements, shape (n,) [m], [rad]."""
    radius = 0.5 * max(seat.model.bearing.pitch_diameter for seat in model.seats)
    kinds = {"x": DEEP, "y": DEEP, "tilt_x": DEEP / radius, "tilt_y": DEEP / radius}
    return np.array([kinds.get(name, STEEP * DEEP) for name in model.directions])


def _forces(
    model: BearingModel | SetModel, time: _Floats, place: _Floats, velocity: _Floats, speed: _Floats
) -> BearingTrial:
    force = np.tile(model.constant_force, (time.size, 1))
    balls = []
    for seat in model.seats:
        motion, loads = seat.model.motion(), np.zeros((time.size, seat.model.bearing.balls, 2))
        force[0] -= seat.rows.T @ motion.rest(float(speed[0]), START, seat.ring(place[0]))
        loads[0] = motion.loads
        for k in range(1, time.size):
            motion.begin(float(speed[k]), float(time[k] - time[k - 1]))
            force[k] -= seat.rows.T @ motion.forces(seat.ring(place[k]), seat.rows @ velocity[k])[0]
            motion.accept()
            loads[k] = motion.loads
        balls.append(loads)
    return BearingTrial(time, place, velocity, speed, force, np.concatenate(balls, axis=1))
