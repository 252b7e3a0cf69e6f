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

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reduced_models.bearing.impedance import Contacts, SmallBalls
from reduced_models.bearing.loss import Loss
from reduced_models.elements.film_law import DIRECT

_Floats = NDArray[np.float64]

PER_METRE = 1e8  # N/m, of a bearing: turns the forces of a seat into displacements
FILTERS = DIRECT - 1  # states of a film before those of its chain: inlet and fast


class System(NamedTuple):
    """States of ball after ball, driven by place and velocity of the ring: force f = C x + D (r, r')."""

    A: _Floats  # (n, n)
    B: _Floats  # (n, 4)
    C: _Floats  # (2, n)
    D: _Floats  # (2, 4)


def filters(contacts: Contacts, k: int) -> tuple[_Floats, _Floats, _Floats, float]:
    """Film of ball `k`: x' = A x + b u', and the force per state and per u'."""
    rates, tau = contacts.rates, float(contacts.tau[k])
    if rates is None:
        return np.zeros((0, 0)), np.zeros(0), np.zeros(0), 0.0
    size = FILTERS + rates.lags
    A = np.diag(np.array([-rates.inlet_rate, -rates.fast_rate, *[-rates.lag_rate] * rates.lags]) / tau)
    for j in range(FILTERS, size):
        A[j, 0 if j == FILTERS else j - 1] = rates.lag_rate / tau
    b = np.zeros(size)
    b[:FILTERS] = rates.inlet_rate, rates.fast_rate
    slope, gains = float(contacts.slope[k]), contacts.gains[k]
    return A, b, slope * gains[1:], slope * float(gains[0]) * tau


def ball_system(inner: Contacts, outer: Contacts, k: int, inertia: float) -> tuple[_Floats, _Floats]:
    """Rates of a ball's states, and its force, as rows over these states, delta and delta'."""
    ki, ko = float(inner.stiffness[k]), float(outer.stiffness[k])
    if inner.rates is None and not inertia:
        return np.zeros((0, 2)), np.array([ki * ko / (ki + ko) if ki + ko > 0.0 else 0.0, 0.0])
    own_i, bi, held_i, di = filters(inner, k)
    own_o, bo, held_o, do = filters(outer, k)
    first = 2 if inertia else 1
    n = first + len(bi) + len(bo)
    at_i, at_o = slice(first, first + len(bi)), slice(first + len(bi), n)
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
    rows[0], rows[at_i, at_i], rows[at_o, at_o] = own, own_i, own_o
    rows[at_i] += np.outer(bi, other)
    rows[at_o] += np.outer(bo, own)
    force = di * other
    force[0] -= ki
    force[n] += ki
    force[at_i] += held_i
    return rows, force


def bearing_system(balls: SmallBalls) -> System:
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
    return seated(System(A, driven, C, D), balls.loss)


def seated(bare: System, loss: Loss) -> System:
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
    return System(A, driven, C, lift * bare.D)
