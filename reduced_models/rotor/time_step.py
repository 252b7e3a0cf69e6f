"""Generalised-alpha time step of a rotor, everything linear condensed onto its supports.

Chung and Hulbert, J. Appl. Mech. 60 (1993) 371. Everything linear is condensed onto the displacements r = B q of
the points at which supports act, as the inner rings of bearings against the outer ones: the end of a step has

    D (r - r_free) + weight F(r, r') = 0,    r' = gain r + B v_history,    q = q_free - weight S^-1 B^T F.

q_free depends on the start of the step by one matrix, and on the forces by a few columns.
"""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]

ROUNDED = 0.1  # of the allowed imbalance: rounding in a sum of so much, and a step may not find its balance


class Steps(NamedTuple):
    """The linear part of a rotor for steps of one length, at one speed."""

    past: _Floats  # (3, N, N): what each displacement, velocity and acceleration at the start makes of q_free
    constant: _Floats  # (N,) q_free of the constant forces
    columns: _Floats  # (n, N): of unit forces at the supports, (S^-1 B^T)^T
    turning: _Floats  # (2 unbalances, N): of unit forces where the unbalances are
    D: _Floats  # (n, n)
    B: _Floats  # (n, N)
    dt: float
    weight: float  # of forces at the end of a step, 1 - alpha_f
    velocity: tuple[float, float, float, float]  # gain, then what d, v and a at the start make of v at the end
    acceleration: tuple[float, float, float, float]


class Histories(NamedTuple):
    """Histories of a run, from the start (entry 0) on: k entries."""

    displacement: _Floats  # (k, N)
    velocity: _Floats  # (k, N)
    motion: _Floats  # (k, directions of all supports)
    rate: _Floats
    force: _Floats
    evaluations: NDArray[np.int64]  # (k,) of every support in the step

    @classmethod
    def empty(cls, entries: int, size: int, directions: int) -> Self:
        """Room for a run, all zero."""
        d, v = np.zeros((2, entries, size))
        r, rate, force = np.zeros((3, entries, directions))
        return cls(d, v, r, rate, force, np.zeros(entries, np.int64))


def steps_of(
    matrices: tuple[_Floats, _Floats, _Floats],
    points: _Floats,
    at: _Floats,
    constant: _Floats,
    dt: float,
    rho_inf: float,
) -> Steps:
    """Condense mass, damping and stiffness, shape (N, N), for steps of `dt` [s].

    `points` is B; unbalances push where `at`, shape (N, k), has them.
    """
    M, C, K = matrices
    alpha_m, alpha_f = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0), rho_inf / (rho_inf + 1.0)
    gamma, beta = 0.5 - alpha_m + alpha_f, 0.25 * (1.0 - alpha_m + alpha_f) ** 2
    weight, ratio = 1.0 - alpha_f, gamma / beta
    velocity = ratio / dt, -ratio / dt, 1.0 - ratio, dt * (1.0 - 0.5 * ratio)
    acceleration = 1.0 / (beta * dt * dt), -1.0 / (beta * dt * dt), -1.0 / (beta * dt), 1.0 - 0.5 / beta
    S = (1.0 - alpha_m) * acceleration[0] * M + weight * (velocity[0] * C + K)
    past = [-weight * velocity[k] * C - (1.0 - alpha_m) * acceleration[k] * M for k in (1, 2, 3)]
    past[0] -= alpha_f * K
    past[1] -= alpha_f * C
    past[2] -= alpha_m * M
    inverse = np.linalg.inv(S)
    columns = inverse @ points.T
    D: _Floats = np.asarray(np.linalg.inv(points @ columns), np.float64)
    return Steps(
        np.array([(inverse @ part).T for part in past]), inverse @ constant, np.ascontiguousarray(columns.T),
        np.ascontiguousarray((inverse @ at).T), D, points, dt, weight, velocity, acceleration,
    )  # fmt: skip


def free_displacement(steps: Steps, state: _Floats, turning: _Floats, before: _Floats) -> _Floats:
    """Displacement at the end of a step without forces of the supports.

    Parameters
    ----------
    steps : Steps
    state : ndarray, shape (4, N)
        Displacement, velocity and acceleration at the start of the step; room.
    turning, before : ndarray, shape (k,)
        Forces of the unbalances at the end and at the start of the step [N].
    """
    held = steps.weight * turning + (1.0 - steps.weight) * before
    linear = state[:3].ravel() @ steps.past.reshape(-1, state.shape[1])
    return np.asarray(steps.constant + linear + held @ steps.turning)


def move_to(steps: Steps, state: _Floats, new: _Floats) -> None:
    """Move the state to the end of a step, of displacement `new`."""
    d, v, a = state[:3]
    (v0, v1, v2, v3), (a0, a1, a2, a3) = steps.velocity, steps.acceleration
    acceleration = a0 * new + a1 * d + a2 * v + a3 * a
    state[1] = v0 * new + (v1 * d + v2 * v + v3 * a)
    state[0], state[2] = new, acceleration


def rounding_hint(steps: Steps, r: _Floats, allowed: float, scale: float) -> str:
    """What to change where a step is so short that rounding of the places `r` hides the balance; else empty.

    Inertia resists with mass/dt^2: rounding of a place is a force that grows as steps get shorter.

    Parameters
    ----------
    steps : Steps
    r : ndarray
        Motions of the points that supports act at [m].
    allowed, scale : float
        Imbalance that a step may have, and the force that the tolerance is over [N].
    """
    noise = float(np.finfo(float).eps * np.abs(steps.D).sum(axis=1).max() * np.abs(r).max(initial=0.0))
    if noise < ROUNDED * allowed:
        return ""
    return (
        f": steps of dt = {steps.dt:g} s are so short that rounding is {noise:.2g} N, where {allowed:.2g} N is "
        f"allowed; take longer steps, or a tolerance of {2.0 * noise / (ROUNDED * scale):.1g} or more"
    )
