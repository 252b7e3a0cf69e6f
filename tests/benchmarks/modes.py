"""Local mode analysis of the line relaxation: what a sweep leaves of the errors that a coarser grid does not see.

    python tests/benchmarks/modes.py

Uniform oil and film, steady, without end and without cavitation; eps/hx^2 from transport to flow, lines from one
to sixteen node distances apart. A sweep over the even lines and then the odd ones couples errors exp(i (kx + ly))
only with those of l + pi: it is a matrix of two by two. Printed is the mean factor per sweep of two, at worst over
the waves that the next coarser grid does not carry (Venner and Lubrecht 2000, ch. 3), with the weight theta of
`kernels.relax`, for as many nodes along a line as it counts (`relax.ALONG`) and for the two of the textbook.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ehlcontact.solver.deflection.coefficients import influence_coefficients
from ehlcontact.solver.grid_rules import LINES_APART
from ehlcontact.solver.kernels import relax

WAVES = 32  # angles over the circle
LAGS = 64  # of the film beyond which a window ends it: longer waves than any that is judged
SWEEPS = 2
APART = (1.0, 2.0, 4.0, 8.0, 16.0)  # distance of lines over that of nodes, in metres
FLOWS = (0.01, 0.1, 0.3, 1.0, 2.0, 4.0, 8.0, 32.0, 128.0)  # eps/hx^2
MESH = 0.05  # hx; it cancels out

Matrix = NDArray[np.complex128]


@cache
def film_of_waves(apart: float) -> tuple[NDArray[np.float64], Matrix]:
    """Coefficients at lags of line and node, and the film of P = exp(i (k x + l y)), shape (l, k)."""
    K = influence_coefficients(LAGS + 1, LAGS + 1, MESH, apart * MESH, 1.0)
    lags = np.arange(-LAGS, LAGS + 1)
    window = np.cos(0.5 * np.pi * lags / (LAGS + 1)) ** 2
    whole = K[np.abs(lags)[:, None], np.abs(lags)] * np.outer(window, window)
    angles = 2.0 * np.pi * np.arange(WAVES) / WAVES
    phases = np.exp(-1j * np.outer(lags, angles))
    return K, phases.T @ whole @ phases


def near_film(apart: float, line: int, nodes: int, k: float) -> complex:
    """Film, `line` lines away, of exp(i k x) on one line: of so many nodes on either side only."""
    K, _ = film_of_waves(apart)
    return sum(K[abs(line), abs(shift)] * np.exp(-1j * k * shift) for shift in range(-nodes, nodes + 1))


def weight(flow: float, apart: float) -> float:
    """Theta where both couplings are known, as `relax.distribution_weight` has it."""
    switch = relax.SWITCH * max(1.0, 0.5 * apart)
    return float(1.0 / (1.0 + (flow * max(1.0, apart**-2.0) / switch) ** 4))


def sweep(flow: float, apart: float, along: int, ik: int, il: int) -> Matrix:
    """What a sweep makes of the waves (k, l) and (k, l + pi)."""
    k = 2.0 * np.pi * ik / WAVES
    lines = [il, (il + WAVES // 2) % WAVES]
    ls = 2.0 * np.pi * np.array(lines) / WAVES
    share, across = relax.SHARE * weight(flow, apart), flow / apart**2
    upstream = (1.5 - 2.0 * np.exp(-1j * k) + 0.5 * np.exp(-2j * k)) / MESH
    film = np.diag(film_of_waves(apart)[1][lines, ik])
    couplings = np.diag(flow * (2.0 * np.cos(k) - 2.0) + across * (2.0 * np.cos(ls) - 2.0))
    deposit = np.diag(1.0 - 2.0 * share * np.cos(k) - 2.0 * share * np.cos(ls))
    own = 1.0 - 2.0 * share * np.cos(k)  # of the deposit on the line itself
    near = [near_film(apart, line, along, k) for line in (0, 1)]
    equation = flow * (2.0 * np.cos(k) - 2.0) * own - 2.0 * across * (own + share)
    equation -= upstream * (near[0] * own - 2.0 * share * near[1])
    felt = [near_film(apart, line, relax.NEAR, k) for line in (0, 1, 2)]
    neighbour = felt[1] * own - share * (felt[0] + felt[2])
    even, odd = 0.5 * np.array([[1, 1], [1, 1]]), 0.5 * np.array([[1, -1], [-1, 1]])
    change = -even @ (couplings - upstream * film) / equation
    after = np.eye(2) + deposit @ change
    residual = couplings @ after - upstream * (film + np.diag(2.0 * neighbour * np.cos(ls)) @ change)
    return np.asarray(after - deposit @ odd @ residual / equation)


def left_to_sweeps(apart: float) -> Iterator[tuple[int, int, NDArray[np.float64]]]:
    """Waves (k, l), each with what of it and of (k, l + pi) the next coarser grid does not carry."""
    angles = np.arange(WAVES)
    long = np.minimum(angles, WAVES - angles) < WAVES // 4
    for ik in range(WAVES // 2 + 1):
        for il in range(WAVES // 2):
            pair = (il, il + WAVES // 2)
            # lines closer together than nodes are halved alone, as nodes are where lines lie far apart
            carried = [(long[ik] or apart < 1.0) and (apart >= LINES_APART or long[line]) for line in pair]
            yield ik, il, np.diag(1.0 - np.array(carried))


def smoothing_factor(flow: float, apart: float, along: int = relax.ALONG) -> float:
    """Mean factor per sweep, at worst over the waves left to sweeps."""
    worst = 0.0
    for ik, il, left in left_to_sweeps(apart):
        after = left @ np.linalg.matrix_power(sweep(flow, apart, along, ik, il), SWEEPS)
        worst = max(worst, float(np.abs(np.linalg.eigvals(after)).max()))
    return worst ** (1.0 / SWEEPS)


def main() -> None:
    """Print the table of docs/notes/solver_development.md."""
    print("| eps/hx^2 | " + " | ".join(f"{apart:g}" for apart in APART) + " |")
    print("|---" * (len(APART) + 1) + "|")
    for flow in FLOWS:
        pairs = [[smoothing_factor(flow, apart, along) for along in (relax.ALONG, relax.NEAR)] for apart in APART]
        print(f"| {flow:g} | " + " | ".join(f"{now:.2f} ({two:.2f})" for now, two in pairs) + " |")


if __name__ == "__main__":
    main()
