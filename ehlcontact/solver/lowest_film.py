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

from ehlcontact.solver.kernels.lowest import lowest_of_cells

Array = NDArray[np.float64]

NEAR = 1.1  # times the lowest node: cells with no node below that are not searched


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
    lowest, row, column = lowest_of_cells(H, rows, columns, np.empty((rows.size, 3)))
    return (lowest, row, column) if 0.0 < lowest < node else at_node


def _cells_near(H: Array, limit: float) -> NDArray[np.bool_]:
    """Cells (ny, nx) with a node at most `limit` high and all nodes that their cubics need."""
    low = H <= limit
    cells = low[:-1, :-1] | low[1:, :-1] | low[:-1, 1:] | low[1:, 1:]
    cells[-1] = cells[:, 0] = cells[:, -1] = False
    return cells
