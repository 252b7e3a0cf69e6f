"""Smallest film of a grid, between the nodes too.

The film is thinnest in a valley a few cells wide that runs aslant to the grid: the lowest node lies above its
bottom, at n = 128 by up to one per cent, and by another amount on the next grid or at the next step. Cubics
through the nodes see the bottom. They join from cell to cell, so the smallest film follows a film that changes
without jumps; a polynomial about the lowest node alone would jump with it along the valley. What is left is the
error of the film itself, made by the steep flank of the pressure beside the valley, within a quarter of a
semi-axis.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ehlcontact.jit import jit, jit_node

Array = NDArray[np.float64]

NEAR = 1.1  # times the lowest node: cells with no node below that are not searched
SAMPLES = 8  # intervals along either side of a cell, where it is sampled first
ZOOMED = 4  # cells, those lowest where sampled: the bottom may lie just beyond the side of the first
ZOOMS = 7  # each half as wide as the one before


def lowest_film(H: Array) -> tuple[float, float, float]:
    """Smallest film and where it is.

    Parameters
    ----------
    H : (ny + 1, nx + 1) array
        Film at the nodes, along the first axis from Y = 0, across which it is even, to the side.

    Returns
    -------
    film : float
        Smallest value of the bicubic polynomials through the 4 x 4 nodes around every cell, the cells on the
        border but the symmetry line left out. Never above the lowest node; its own film where the polynomials have
        none, and where surfaces overlap.
    row, column : float
        Its place, in cells from Y = 0 and from the first node along X. The valley is flat along its bottom: the
        place is known to a few cells only.
    """
    j, i = (int(k) for k in np.unravel_index(int(np.argmin(H)), H.shape))
    node = float(H[j, i])
    at_node = node, float(j), float(i)
    if not (node > 0.0 and np.isfinite(H).all()):
        return at_node
    rows, columns = np.nonzero(_cells_near(H, NEAR * node))
    if not rows.size:
        return at_node
    film, lines, places = np.array(H, order="C"), np.array(rows), np.array(columns)  # of any layout: compiled once
    lowest, row, column = lowest_of_cells(film, lines, places, np.empty((rows.size, 3)))
    return (lowest, row, column) if 0.0 < lowest < node else at_node


def beside_lowest(H: Array) -> float:
    """Mean film at both nodes beside the lowest one along X, over its own; infinite where that has no film."""
    j, i = (int(k) for k in np.unravel_index(int(np.argmin(H)), H.shape))
    row, lowest = H[j], float(H[j, i])
    beside = float(row[max(i - 1, 0)] + row[min(i + 1, row.size - 1)])
    return 0.5 * beside / lowest if lowest > 0.0 else float("inf")


def _cells_near(H: Array, limit: float) -> NDArray[np.bool_]:
    """Cells (ny, nx) with a node at most `limit` high and all nodes that their cubics need."""
    low = H <= limit
    cells = low[:-1, :-1] | low[1:, :-1] | low[:-1, 1:] | low[1:, 1:]
    cells[-1] = cells[:, 0] = cells[:, -1] = False
    return cells


@jit_node
def cubic_at(H, j, i, t, s):
    """Bicubic polynomial through the 4 x 4 nodes around cell (j, i), at (t, s) from 0 to 1; even across j = 0."""
    value, w, w_line = 0.0, _weights(s), _weights(t)
    for a in range(4):
        row = abs(j + a - 1)
        along = w[0] * H[row, i - 1] + w[1] * H[row, i] + w[2] * H[row, i + 1] + w[3] * H[row, i + 2]
        value += w_line[a] * along
    return value


@jit_node
def _weights(x):
    """Weights of the nodes at -1, 0, 1, 2 in the cubic through them."""
    return (
        x * (x - 1.0) * (2.0 - x) / 6.0,
        0.5 * (x + 1.0) * (x - 1.0) * (x - 2.0),
        0.5 * (x + 1.0) * x * (2.0 - x),
        (x + 1.0) * x * (x - 1.0) / 6.0,
    )


@jit
def sample(H, j, i):
    """Lowest of the samples of a cell: value, t, s."""
    lowest, t_lowest, s_lowest = H[j, i], 0.0, 0.0
    for a in range(SAMPLES + 1):
        for b in range(SAMPLES + 1):
            t, s = a / SAMPLES, b / SAMPLES
            value = cubic_at(H, j, i, t, s)
            if value < lowest:
                lowest, t_lowest, s_lowest = value, t, s
    return lowest, t_lowest, s_lowest


@jit
def zoom_in(H, j, i, lowest, t_lowest, s_lowest):
    """Lowest place of a cell next to the one given: value, t, s."""
    width = 0.5 / SAMPLES
    for _ in range(ZOOMS):
        t_centre, s_centre = t_lowest, s_lowest
        for a in range(-2, 3):
            for b in range(-2, 3):
                t = min(max(t_centre + a * width, 0.0), 1.0)
                s = min(max(s_centre + b * width, 0.0), 1.0)
                value = cubic_at(H, j, i, t, s)
                if value < lowest:
                    lowest, t_lowest, s_lowest = value, t, s
        width *= 0.5
    return lowest, t_lowest, s_lowest


@jit
def lowest_of_cells(H, lines, columns, samples):
    """Lowest place in the cells at `lines`, `columns` (k,): value, line, column; `samples` (k, 3) is written."""
    for k in range(lines.size):
        samples[k, 0], samples[k, 1], samples[k, 2] = sample(H, lines[k], columns[k])
    lowest, line, column = samples[0, 0], lines[0] + samples[0, 1], columns[0] + samples[0, 2]
    for _ in range(min(ZOOMED, lines.size)):
        k = 0  # not argmin of the column, which takes a second to compile
        for m in range(lines.size):
            if samples[m, 0] < samples[k, 0]:
                k = m
        value, t, s = zoom_in(H, lines[k], columns[k], samples[k, 0], samples[k, 1], samples[k, 2])
        samples[k, 0] = 1e300  # done
        if value <= lowest:
            lowest, line, column = value, lines[k] + t, columns[k] + s
    return lowest, line, column
