"""Balls of a bearing about rest as matrices of first order, the films' memory as states: x' = A x + B u.

A ball between two films has its place w at the outer race as a state, for both films damp: with the forces

    F = k u + H (c tau u' + sum g_j x_j)

of both contacts (u = delta - w at the inner one, w at the outer one), F_i = F_o gives w'; of a ball with inertia
w' is a state too. Beside it are those of the filters, x' = (what feeds it - x) rate/tau. Dry balls without inertia
have none. A bearing at several positions of the cage has all balls of all positions, each with its share of the
force: the mean, with so many times the states. Rings and fits that lose something have theirs after those of the
balls: the forces y_k of `reduced_models.bearing.loss`, x before y, over `PER_METRE`, so that they are as small as
the others.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reduced_models.bearing.linear_balls import SmallBalls
from reduced_models.bearing.loss import Loss
from reduced_models.elements.small_motion import SmallMotion, StateSpace

_Floats = NDArray[np.float64]

PER_METRE = 1e8  # N/m, of a bearing: turns the forces of a seat into displacements


def ball_system(inner: SmallMotion, outer: SmallMotion, k: int, inertia: float) -> tuple[_Floats, _Floats]:
    """Rates of a ball's states, and its force, as rows over these states, delta and delta'."""
    ki, ko = (float(np.asarray(race.stiffness)[k]) for race in (inner, outer))
    if inner.rates is None and not inertia:
        return np.zeros((0, 2)), np.array([ki * ko / (ki + ko) if ki + ko > 0.0 else 0.0, 0.0])
    film_i, film_o = inner.state_space(k), outer.state_space(k)
    held_i, di = film_i.C[0], float(film_i.D[0, 1])
    held_o, do = film_o.C[0], float(film_o.D[0, 1])
    first = 2 if inertia else 1
    n = first + held_i.size + held_o.size
    at_i, at_o = slice(first, first + held_i.size), slice(first + held_i.size, n)
    own, pulled = np.zeros(n + 2), np.zeros(n + 2)  # w', and F_i - F_o without what w' does to it
    pulled[0], pulled[at_i], pulled[at_o], pulled[n], pulled[n + 1] = -(ki + ko), held_i, -held_o, ki, di
    rows = np.zeros((n, n + 2))
    if inertia:
        own[1] = 1.0
        rows[1] = (pulled - (di + do) * own) / inertia
    elif di + do > 0.0:
        own = pulled / (di + do)
    other = -own  # delta' - w'
    other[n + 1] += 1.0
    rows[0], rows[at_i, at_i], rows[at_o, at_o] = own, film_i.A, film_o.A
    rows[at_i] += np.outer(film_i.B[:, 1], other)
    rows[at_o] += np.outer(film_o.B[:, 1], own)
    force = di * other
    force[0] -= ki
    force[n] += ki
    force[at_i] += held_i
    return rows, force


def bearing_system(balls: SmallBalls) -> StateSpace:
    """All balls of a bearing."""
    parts = [ball_system(balls.inner, balls.outer, k, balls.inertia) for k in range(len(balls.normals))]
    size = sum(len(rows) for rows, _ in parts)
    A, driven = np.zeros((size, size)), np.zeros((size, 4))
    C, D = np.zeros((2, size)), np.zeros((2, 4))
    at = 0
    for normal, (rows, force) in zip(balls.normals, parts, strict=True):
        n = len(rows)
        here, share = slice(at, at + n), normal / balls.positions
        A[here, here], C[:, here] = rows[:, :n], np.outer(share, force[:n])
        for j in range(2):  # delta = n . r, then delta'
            driven[here, 2 * j : 2 * j + 2] = np.outer(rows[:, n + j], normal)
            D[:, 2 * j : 2 * j + 2] += np.outer(share, normal) * force[n + j]
        at += n
    return seated(StateSpace(A, driven, C, D), balls.loss)


def seated(bare: StateSpace, loss: Loss) -> StateSpace:
    """The same with the filters of its seat."""
    states, added = len(bare.A), 2 * loss.gains.size
    A, driven = np.zeros((states + added, states + added)), np.zeros((states + added, 4))
    C = np.zeros((2, states + added))
    A[:states, :states], driven[:states] = bare.A, bare.B
    rates = np.kron(loss.rates[:, None], np.eye(2)) / PER_METRE  # of all y by the force
    A[states:, :states], driven[states:] = rates @ bare.C, rates @ bare.D
    A[states:, states:] = -np.diag(np.repeat(loss.rates, 2))
    lift = 1.0 + loss.gains.sum()
    C[:, :states], C[:, states:] = lift * bare.C, -PER_METRE * np.kron(loss.gains, np.eye(2))
    return StateSpace(A, driven, C, lift * bare.D)
