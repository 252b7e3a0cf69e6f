"""Balls of a bearing about static equilibrium as matrices of first order: x' = A x + B u, with the films' memory.

A planar ball between two films has its place w at the outer race as a state, for both films damp: with the forces

    F = k u + H (c tau u' + sum g_j x_j)

of both contacts (u = delta - w at the inner one, w at the outer one), F_i = F_o gives w'; of a ball with inertia
w' is a state too. Beside it are those of the filters, x' = (what feeds it - x) rate/tau. Dry balls without inertia
have none.

A ball at contact angles has its place b, along and across the outer contact, as two states. With the balance of
`linear_angular` its rate follows from the dashpots d of both films:

    (d_i n_i n_i^T + d_o n_o n_o^T) b'
        = G_b b + G_c c + n_i (k_i n_i . (c - b) + d_i n_i . c' + g_i x_i) - n_o (k_o n_o . b + g_o x_o)

Both contacts are nearly on one line, and nothing damps a ball across it: it follows its forces there without
delay. `ACROSS` adds so little damping that it still does.

A bearing at several positions of the cage has all balls of all positions, each with its share of the force: the
mean, with so many times the states. Rings and fits that lose something have theirs after those of the balls: the
forces y_k of `reduced_models.bearing.loss`, in the order of directions, over `PER_METRE`, so that they are as
small as the others.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reduced_models.bearing.linear_angular import SmallAngularBalls
from reduced_models.bearing.linear_balls import SmallBalls
from reduced_models.bearing.loss import Loss
from reduced_models.elements.small_motion import SmallMotion, StateSpace

_Floats = NDArray[np.float64]

PER_METRE = 1e8  # N/m, of a bearing: turns the forces of a seat into displacements
# Damping of a ball across its outer contact, over that of both films. A ball rests there on some 1e6 N/m, with
# which it follows in less than a picosecond; stiffness and damping of a bearing change by less than 1e-8.
ACROSS = 1e-9


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


def across_damping(balls: SmallAngularBalls, k: int) -> float:
    """Damping that ball `k` has across its outer contact [N s/m]; of one with inertia none is needed."""
    films = (race.state_space(k).D[0, 1] for race in (balls.inner, balls.outer))
    return 0.0 if balls.inertia else ACROSS * float(sum(films))


def angular_ball(balls: SmallAngularBalls, k: int) -> tuple[_Floats, _Floats, _Floats]:
    """Rates of the states of ball `k`, force of the ring and its moment, as rows over these states, c and c'.

    Directions are along and across its outer contact; the map from the ring to them, shape (3, 5), comes last.
    """
    at_i, at_o = balls.angles[k]
    outward = np.array([[np.cos(at_o), np.sin(at_o)], [-np.sin(at_o), np.cos(at_o)]])
    both, whole = np.kron(np.eye(2), outward), np.eye(5)
    whole[:4, :4] = both
    G = whole @ balls.geometric[k] @ both.T
    maps = np.concatenate([outward @ balls.maps[k, :2], balls.maps[k, 2:]])
    n_i, n_o = np.array([np.cos(at_i - at_o), np.sin(at_i - at_o)]), np.array([1.0, 0.0])
    film_i, film_o = balls.inner.state_space(k), balls.outer.state_space(k)
    (k_i, d_i), (k_o, d_o) = film_i.D[0], film_o.D[0]
    own = 4 if balls.inertia else 2
    if film_i.A.size == 0 and not balls.inertia:
        own = 0
    held_i, held_o = (
        slice(own, own + len(film_i.A)),
        slice(own + len(film_i.A), own + len(film_i.A) + len(film_o.A)),
    )
    n = held_o.stop
    b, c, c_rate = np.zeros((3, 2, n + 4))
    c[:, n : n + 2] = c_rate[:, n + 2 :] = np.eye(2)
    f_i, f_o = (k_i * n_i) @ c + (d_i * n_i) @ c_rate, np.zeros(n + 4)
    rows = np.zeros((n, n + 4))
    if own == 0:  # dry: the ball follows the ring
        by_b = G[:2, :2] - k_i * np.outer(n_i, n_i) - k_o * np.outer(n_o, n_o)
        if k_i + k_o == 0.0:  # nothing touches it: it carries nothing
            by_b = by_b - np.eye(2)
        b = -np.linalg.solve(by_b, G[:2, 2:] + k_i * np.outer(n_i, n_i)) @ c
        f_i = f_i - (k_i * n_i) @ b
        return rows, _on_ring(G, b, c, n_i, f_i), maps
    b[:, :2] = np.eye(2)
    f_i -= (k_i * n_i) @ b
    f_o += (k_o * n_o) @ b
    f_i[held_i], f_o[held_o] = film_i.C[0], film_o.C[0]
    pulled = G[:2, :2] @ b + G[:2, 2:] @ c + np.outer(n_i, f_i) - np.outer(n_o, f_o)
    damping = d_i * np.outer(n_i, n_i) + d_o * np.outer(n_o, n_o)
    damping[1, 1] += across_damping(balls, k)
    b_rate = np.zeros((2, n + 4))
    if balls.inertia:
        b_rate[:, 2:4] = np.eye(2)
        rows[2:4] = (pulled - damping @ b_rate) / balls.inertia
    else:
        b_rate = np.linalg.solve(damping, pulled)
    rows[:2], rows[held_i, held_i], rows[held_o, held_o] = b_rate, film_i.A, film_o.A
    rows[held_i] += np.outer(film_i.B[:, 1], n_i @ (c_rate - b_rate))
    rows[held_o] += np.outer(film_o.B[:, 1], n_o @ b_rate)
    return rows, _on_ring(G, b, c, n_i, f_i - (d_i * n_i) @ b_rate), maps


def _on_ring(G: _Floats, b: _Floats, c: _Floats, n_i: _Floats, f_i: _Floats) -> _Floats:
    """Force of the ring on a ball and its moment, shape (3, inputs)."""
    return np.asarray(G[2:, :2] @ b + G[2:, 2:] @ c + np.outer(np.append(n_i, 0.0), f_i))


def bearing_system(balls: SmallBalls | SmallAngularBalls) -> StateSpace:
    """All balls of a bearing."""
    if isinstance(balls, SmallAngularBalls):
        found = [angular_ball(balls, k) for k in range(len(balls.maps))]
        parts = [(rows, force, maps[:2], maps) for rows, force, maps in found]
    else:
        planar = [ball_system(balls.inner, balls.outer, k, balls.inertia) for k in range(len(balls.normals))]
        parts = [
            (rows, force[None], normal[None], normal[None])
            for (rows, force), normal in zip(planar, balls.normals, strict=True)
        ]
    size, n = sum(len(part[0]) for part in parts), parts[0][3].shape[1]
    A, driven = np.zeros((size, size)), np.zeros((size, 2 * n))
    C, D = np.zeros((n, size)), np.zeros((n, 2 * n))
    at = 0
    for rows, force, moves, pulls in parts:  # motions of the ball's inner race, and forces, from those of the ring
        own, count = len(rows), len(moves)
        here, share = slice(at, at + own), pulls.T / balls.positions
        A[here, here], C[:, here] = rows[:, :own], share @ force[:, :own]
        for j in range(2):  # displacements, then their rates
            given = slice(own + count * j, own + count * (j + 1))
            driven[here, n * j : n * (j + 1)] = rows[:, given] @ moves
            D[:, n * j : n * (j + 1)] += share @ force[:, given] @ moves
        at += own
    return seated(StateSpace(A, driven, C, D), balls.loss)


def seated(bare: StateSpace, loss: Loss) -> StateSpace:
    """The same with the filters of its seat."""
    states, n = len(bare.A), len(bare.C)
    added = n * loss.gains.size
    A, driven = np.zeros((states + added, states + added)), np.zeros((states + added, 2 * n))
    C = np.zeros((n, states + added))
    A[:states, :states], driven[:states] = bare.A, bare.B
    rates = np.kron(loss.rates[:, None], np.eye(n)) / PER_METRE  # of all y by the force
    A[states:, :states], driven[states:] = rates @ bare.C, rates @ bare.D
    A[states:, states:] = -np.diag(np.repeat(loss.rates, n))
    lift = 1.0 + loss.gains.sum()
    C[:, :states], C[:, states:] = lift * bare.C, -PER_METRE * np.kron(loss.gains, np.eye(n))
    return StateSpace(A, driven, C, lift * bare.D)
