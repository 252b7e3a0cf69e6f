"""The smallest film between the nodes.

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

Array = NDArray[np.float64]

NEAR = 1.1  # times the lowest node: cells with no node below that are not searched
ZOOMED = 4  # cells, those lowest where sampled: the bottom may lie just beyond the side of the first
ZOOMS = (1.0 / 8.0, 1.0 / 64.0, 1.0 / 512.0)  # half widths in cells, each about the lowest sample before
_STENCIL = np.arange(-1, 3)  # nodes of a cell from 0 to 1 and their neighbours
_TO_POWERS = np.linalg.inv(np.vander(_STENCIL.astype(float)))
_COARSE, _FINE = np.linspace(0.0, 1.0, 9), np.linspace(-1.0, 1.0, 17)


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
    above = H[np.abs(rows[:, None, None] + _STENCIL[:, None]), columns[:, None, None] + _STENCIL] - node
    weights = _weights(_COARSE)
    values = (weights @ above @ weights.T).reshape(rows.size, -1)
    drop, t, s = 0.0, float(j), float(i)
    for k in np.argsort(values.min(axis=1))[:ZOOMED]:
        a, b = divmod(int(np.argmin(values[k])), _COARSE.size)
        lower, t_k, s_k = _zoom_in(above[k], float(_COARSE[a]), float(_COARSE[b]))
        if lower < drop:
            drop, t, s = lower, float(rows[k]) + t_k, float(columns[k]) + s_k
    return (node + drop, t, s) if drop > -node else at_node


def _cells_near(H: Array, limit: float) -> NDArray[np.bool_]:
    """Cells (ny, nx) with a node at most `limit` high and all nodes that their cubics need."""
    low = H <= limit
    cells = low[:-1, :-1] | low[1:, :-1] | low[:-1, 1:] | low[1:, 1:]
    cells[-1] = cells[:, 0] = cells[:, -1] = False
    return cells


def _zoom_in(nodes: Array, t: float, s: float) -> tuple[float, float, float]:
    """Smallest value of the polynomial through `nodes` (4, 4) next to (t, s) within their cell, and its place."""
    value = 0.0
    for width in ZOOMS:
        along_t, along_s = (np.clip(x + width * _FINE, 0.0, 1.0) for x in (t, s))
        values = _weights(along_t) @ nodes @ _weights(along_s).T
        a, b = np.unravel_index(int(np.argmin(values)), values.shape)
        value, t, s = float(values[a, b]), float(along_t[a]), float(along_s[b])
    return value, t, s


def _weights(x: Array) -> Array:
    """Weights of the four nodes in the cubic through them at x (k,) of the cell: (k, 4)."""
    return np.vander(x, 4) @ _TO_POWERS
