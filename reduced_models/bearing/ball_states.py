"""Balls of a bearing about static equilibrium as matrices of first order: x' = A x + B u, with the films' memory.

A ball between two films has its place b, along and across the outer contact, as two states. With the forces of
both contacts

    F = k u + H (c tau u' + sum g_j x_j)

and the balance of `linear_balls` its rate follows from the dashpots d of both films:

    (d_i n_i n_i^T + d_o n_o n_o^T) b'
        = G_b b + G_c c + n_i (k_i n_i . (c - b) + d_i n_i . c' + g_i x_i) - n_o (k_o n_o . b + g_o x_o)

Both contacts are nearly on one line, and nothing damps a ball across it: it follows its forces there without
delay. `ACROSS` adds so little damping that it still does. Where only x and y of the ring move, the ball has its
place along the contacts alone. A ball with inertia has its rates as states too. Beside the place are the states of
the filters, x' = (what feeds it - x) rate/tau. Dry balls without inertia have none.

A bearing at several positions of the cage has all balls of all positions, each with its share of the force: the
mean, with so many times the states. Rings and fits that lose something have theirs after those of the balls: the
forces y_k of `reduced_models.bearing.loss`, in the order of directions, over `PER_METRE`, so that they are as
small as the others.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from reduced_models.bearing.freedoms import PLANAR
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.bearing.loss import Loss
from reduced_models.elements.film_response import StateSpace

_Floats = NDArray[np.float64]

PER_METRE = 1e8  # N/m, of a bearing: turns the forces of a seat into displacements
# Damping of a ball across its outer contact, over that of both films. A ball rests there on some 1e6 N/m, with
# which it follows in less than a picosecond; stiffness and damping of a bearing change by less than 1e-8.
ACROSS = 1e-9


def across_damping(balls: LinearBalls, k: int) -> float:
    """Damping that ball `k` has across its outer contact [N s/m]; of one with inertia none is needed."""
    films = (balls.films.state_space(race, k).D[0, 1] for race in range(2))
    return 0.0 if balls.inertia else ACROSS * float(sum(films))


def ball_system(balls: LinearBalls, k: int) -> tuple[_Floats, _Floats, _Floats]:
    """Rates of the states of ball `k`, force of the ring and its moment, as rows over these states, c and c'.

    Directions are along and across its outer contact; the map from the ring to them, shape (3, n), comes last.
    """
    G, maps, (n_i, n_o) = balls.geometric[k], balls.maps[k], balls.normals[..., k]
    film_i, film_o = balls.films.state_space(0, k), balls.films.state_space(1, k)
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
    force = _on_ring(G, b, c, n_i, f_i - (d_i * n_i) @ b_rate)
    if maps.shape[1] == len(PLANAR):  # it stays where it is across
        along = np.delete(np.arange(n + 4), np.arange(1, own, 2))
        rows, force = rows[np.ix_(along[along < n], along)], force[:, along]
    return rows, force, maps


def _on_ring(G: _Floats, b: _Floats, c: _Floats, n_i: _Floats, f_i: _Floats) -> _Floats:
    """Force of the ring on a ball and its moment, shape (3, inputs)."""
    return np.asarray(G[2:, :2] @ b + G[2:, 2:] @ c + np.outer(np.append(n_i, 0.0), f_i))


def ring_system(balls: LinearBalls, k: int) -> StateSpace:
    """Ball `k` between motions of the ring, displacements, then their rates, and its share of the force."""
    rows, force, maps = ball_system(balls, k)
    own, share = len(rows), maps.T / balls.positions
    through = np.kron(np.eye(2), maps[:2])  # motions of the ball's inner race
    return StateSpace(
        rows[:, :own], rows[:, own:] @ through, share @ force[:, :own], share @ force[:, own:] @ through
    )


def parallel(parts: Sequence[StateSpace]) -> StateSpace:
    """Systems with one motion, whose forces add up."""
    A, driven, C, D = zip(*parts, strict=True)
    return StateSpace(scipy.linalg.block_diag(*A), np.concatenate(driven), np.hstack(C), np.sum(D, axis=0))


def bearing_system(balls: LinearBalls) -> StateSpace:
    """All balls of a bearing."""
    return seated(parallel([ring_system(balls, k) for k in range(len(balls.maps))]), balls.loss)


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
