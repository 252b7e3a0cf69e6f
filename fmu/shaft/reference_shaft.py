"""The step of a shaft's FMU in Python: matrix exponentials of modes, linear equations for what couples them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from fmu.shaft.model import ShaftModel
from fmu.shaft.variables import RESOLVED
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.rotor.speed_profile import turning_forces

_Floats = NDArray[np.float64]

STEPS, DT, TOP = 200, 2e-6, 3000.0  # of the trial: steps, s, rev/min
PUSH = 0.3  # of the forces at the start, by which they vary
PASSES = 8  # of speed and motion, which hardly depend on one another


@dataclass(frozen=True, slots=True, eq=False)
class ShaftTrial:
    """Ends of equal steps.

    Attributes
    ----------
    time : ndarray, shape (k,)
    inputs : ndarray, shape (k, inputs)
        In the order of the FMU; each row is held over the step that begins there.
    motion, velocity : ndarray, shape (k, rows)
        Of the rings and named nodes.
    angle, speed : ndarray, shape (k,)
        [rad], [rad/s].
    """

    time: _Floats
    inputs: _Floats
    motion: _Floats
    velocity: _Floats
    angle: _Floats
    speed: _Floats


def shaft_trial(model: ShaftModel) -> ShaftTrial:
    """A run with forces that vary and a speed that rises, step by step."""
    rng = np.random.default_rng(1)
    start = np.concatenate(model.forces)
    drive = 1 if model.inertia is None else 1 + len(model.stations)
    unbalances = [unbalance.amount for unbalance in model.rotor.unbalances]
    time = np.asarray(DT * np.arange(STEPS + 1), np.float64)
    inputs = np.zeros((STEPS + 1, start.size + len(unbalances) + drive))
    size = np.maximum(np.abs(start), 0.1 * np.abs(start).max()) if start.any() else np.ones(start.size)
    omega = 2.0 * np.pi * rng.uniform(50.0, 2000.0, start.size)
    inputs[:, : start.size] = start + PUSH * size * np.sin(omega * time[:, None])
    inputs[:, start.size : start.size + len(unbalances)] = np.array(unbalances) + 1e-5
    first = TOP * RPM_TO_RAD_S
    if model.inertia is None:
        inputs[:, -1] = first * (1.0 + 0.1 * time / time[-1])
    else:
        inputs[:, -drive] = 0.1 * first * model.inertia / time[-1]
        inputs[:, 1 - drive :] = 0.01 * inputs[:, [-drive]]
    return run_shaft(model, DT, inputs, first)


def run_shaft(model: ShaftModel, dt: float, inputs: _Floats, omega: float) -> ShaftTrial:
    """Equal steps from where the shaft starts, at a speed [rad/s], under inputs that are held over each."""
    modes, inverse = model.modes, model.modes.shapes.T @ model.rotor.mass
    responses = _responses(modes.stiffness, np.diag(modes.damping), dt)
    q, v = (inverse @ one for one in model.motion)
    angle, kept = 0.0, [(q, v, 0.0, omega)]
    for row in inputs[:-1]:
        q, v, angle, omega = _step(model, responses, q, v, angle, omega, row, dt)
        kept.append((q, v, angle, omega))
    places, rates, angles, speeds = (np.array(one) for one in zip(*kept, strict=True))
    rows = model.rows @ modes.shapes
    time = np.asarray(dt * np.arange(len(inputs)), np.float64)
    return ShaftTrial(time, inputs, places @ rows.T + model.shifts, rates @ rows.T, angles, speeds)


_Responses = tuple[_Floats, _Floats, _Floats, _Floats]


def _step(
    model: ShaftModel,
    responses: _Responses,
    q: _Floats,
    v: _Floats,
    angle: float,
    omega: float,
    inputs: _Floats,
    h: float,
) -> tuple[_Floats, _Floats, float, float]:
    modes, rotor = model.modes, model.rotor
    ports = sum(len(mount.directions) for mount in model.stations)
    unbalances = len(rotor.unbalances)
    amounts, drive = inputs[ports : ports + unbalances], inputs[ports + unbalances :]
    held = modes.load + (model.rows[:ports] @ modes.shapes).T @ inputs[:ports]
    place, rate, to_place, to_rate = responses
    between = modes.damping - np.diag(np.diag(modes.damping))
    alpha, later = 0.0, v
    for _ in range(PASSES):
        middle = omega + 0.5 * h * alpha
        at_middle = angle + 0.5 * h * (omega + 0.25 * h * alpha)
        force, slowed = held.copy(), 0.0
        for u, amount in enumerate(amounts.tolist()):
            turning, at = turning_forces(rotor, *(np.array([one]) for one in (middle, at_middle, alpha)))
            both = at[:, 2 * u : 2 * u + 2].T @ modes.shapes
            along = turning[0, 2 * u : 2 * u + 2] / rotor.unbalances[u].amount
            force += amount * along @ both
            a = both @ (later - v) / h
            pointer = at_middle + rotor.unbalances[u].phase
            slowed += amount * float(a[1] * np.cos(pointer) - a[0] * np.sin(pointer))
        # mean rate d: h d = (place - 1) q + ... + to_place (force - (between + omega G) d)
        coupled = between + middle * modes.gyroscopic
        free = (place[:, 0] - 1.0) * q + place[:, 1] * v + to_place * force
        d = np.linalg.solve(h * np.eye(q.size) + to_place[:, None] * coupled, free)
        force = force - coupled @ d
        later = rate[:, 0] * q + rate[:, 1] * v + to_rate * force
        if model.inertia is None:
            alpha = float(drive[0] - omega) / h
        else:
            alpha = float(drive[0] - slowed - drive[1:].sum()) / model.inertia
    return q + h * d, later, angle + h * (omega + 0.5 * h * alpha), omega + h * alpha


def _responses(stiffness: _Floats, damping: _Floats, h: float) -> _Responses:
    """Of every mode after a step: place and rate by those before, shape (r, 2), then by a held force, (r,)."""
    place, rate, to_place, to_rate = [], [], [], []
    for k, c in zip(stiffness.tolist(), damping.tolist(), strict=True):
        w = np.sqrt(k)
        damped = max(c, 2.0 * w) if w * h > RESOLVED else c
        whole = scipy.linalg.expm(h * np.array([[0.0, 1.0, 0.0], [-k, -damped, 1.0], [0.0, 0.0, 0.0]]))
        place.append(whole[0, :2])
        rate.append(whole[1, :2])
        to_place.append(whole[0, 2])
        to_rate.append(whole[1, 2])
    return np.array(place), np.array(rate), np.array(to_place), np.array(to_rate)
