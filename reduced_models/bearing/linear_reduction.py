"""Fewer states for a linear bearing: balanced residualisation of its balls, of positions of the cage, of all.

The mean over a ball passage has all balls at all positions of the cage, with the lags of both films each: some
3000 states of a bearing. Lags in chains are alike, and the force of the ring sees the sum of all balls, so that a
few dozen states give it. Displacements of the ring are the only input: with x = z + B' r the rates r' of
x' = A x + B r + B' r' drop out. In balanced states, whose singular values are those of the product of both
Gramians, the last ones follow the others without delay (Fernando and Nicholson 1982): static stiffness stays, and
twice the sum of their singular values bounds the error of the impedance at every frequency (Glover 1984).

Errors are relative to the static stiffness K in any motion, that about the pressure centre of an angular contact
bearing, where it is softest, included: E of the impedance is that of K^-1/2 E K^-1/2.
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.process.blas import one_blas_thread
from reduced_models.bearing.ball_states import parallel, ring_system, seated
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.elements.film_response import StateSpace

_Floats = NDArray[np.float64]

ROUNDING = 1e-14  # of the largest singular value: below is that of the Gramians
STATIC_OMEGA = 1e-3  # rad/s, where the stiffness is static
REDUCTIONS = 3  # reductions in a row: of a ball, of a position of the cage, of the bearing


@one_blas_thread()  # matrices are small
def reduced_system(balls: LinearBalls, tolerance: float) -> tuple[StateSpace, float]:
    """All balls of a bearing with few states, and the bound of the error of its impedance.

    Parameters
    ----------
    balls : LinearBalls
    tolerance : float
        Largest error, over the static stiffness in any motion of the ring.
    """
    static = balls.impedance(STATIC_OMEGA).real
    stiffness, along = np.linalg.eigh(0.5 * (static + static.T))
    scale = (along / np.sqrt(np.abs(stiffness))) @ along.T
    number = len(balls.maps) // balls.positions
    error, positions = 0.0, []
    for first in range(0, len(balls.maps), number):
        own = [ring_system(balls, k) for k in range(first, first + number)]
        reductions = [_reduced(space, scale, tolerance / REDUCTIONS / len(balls.maps)) for space in own]
        whole = _reduced(
            parallel([space for space, _ in reductions]), scale, tolerance / REDUCTIONS / balls.positions
        )
        positions.append(whole[0])
        error += whole[1] + sum(part for _, part in reductions)
    space, last = _reduced(parallel(positions), scale, tolerance / REDUCTIONS)
    return seated(space, balls.loss), error + last


def _residualised(space: StateSpace, kept: NDArray[np.bool_]) -> StateSpace:
    """States that are not kept follow the others without delay."""
    A, driven, C, D = space
    if kept.all():
        return space
    follow = -np.linalg.solve(A[np.ix_(~kept, ~kept)], np.hstack([A[np.ix_(~kept, kept)], driven[~kept]]))
    by_states, by_inputs = np.split(follow, [int(kept.sum())], axis=1)
    across, seen = A[np.ix_(kept, ~kept)], C[:, ~kept]
    return StateSpace(
        A[np.ix_(kept, kept)] + across @ by_states,
        driven[kept] + across @ by_inputs,
        C[:, kept] + seen @ by_states,
        D + seen @ by_inputs,
    )


def _reduced(space: StateSpace, scale: _Floats, tolerance: float) -> tuple[StateSpace, float]:
    """As few states as the tolerance allows, and the bound of the error; all of a system that is not stable."""
    A, driven, C, D = space
    n = len(C)
    if A.size == 0 or scipy.linalg.eigvals(A).real.max() >= 0.0:
        return space, 0.0
    by_rate = driven[:, n:]
    by_place, through = A @ by_rate + driven[:, :n], D[:, :n] + C @ by_rate
    pushed, seen = by_place @ scale, scale @ C
    reached = _factor(scipy.linalg.solve_continuous_lyapunov(A, -pushed @ pushed.T))
    observed = _factor(scipy.linalg.solve_continuous_lyapunov(A.T, -seen.T @ seen))
    left, values, right = np.linalg.svd(observed.T @ reached)
    known = values > ROUNDING * values[0]
    root = np.sqrt(values[known])
    back, forth = reached @ right[known].T / root, (left[:, : known.size][:, known] / root).T @ observed.T
    tails = 2.0 * np.cumsum(values[::-1])[::-1]  # bound of the error where this state and all behind it go
    kept = tails[known] > tolerance
    balanced = StateSpace(forth @ A @ back, forth @ by_place, C @ back, through)
    few = _residualised(balanced, kept)
    error = float(tails[kept.sum()]) if kept.sum() < values.size else 0.0
    inputs = np.hstack([few.B, np.zeros((len(few.A), n))])
    return StateSpace(few.A, inputs, few.C, np.hstack([few.D, D[:, n:]])), error


def _factor(gramian: _Floats) -> _Floats:
    """Square root L, with L L^T the Gramian but for its rounding."""
    values, vectors = np.linalg.eigh(0.5 * (gramian + gramian.T))
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))
