"""Cubics between the nodes of the film, and where they are lowest; `solver.lowest_film` is the whole."""

from ehlcontact.jit import jit, jit_node

SAMPLES = 8  # intervals along either side of a cell, where it is sampled first
ZOOMED = 4  # cells, those lowest where sampled: the bottom may lie just beyond the side of the first
ZOOMS = 7  # each half as wide as the one before


@jit_node
def cubic_at(H, j, i, t, s):
    """Bicubic polynomial through the 4 x 4 nodes around cell (j, i), at (t, s) from 0 to 1; even across j = 0."""
    value = 0.0
    for a in range(4):
        row = abs(j + a - 1)
        along = (
            _weight(0, s) * H[row, i - 1]
            + _weight(1, s) * H[row, i]
            + _weight(2, s) * H[row, i + 1]
            + _weight(3, s) * H[row, i + 2]
        )
        value += _weight(a, t) * along
    return value


@jit_node
def _weight(a, x):
    """Weight of node a, at a - 1, in the cubic through nodes at -1, 0, 1, 2."""
    if a == 0:
        return x * (x - 1.0) * (2.0 - x) / 6.0
    if a == 1:
        return 0.5 * (x + 1.0) * (x - 1.0) * (x - 2.0)
    if a == 2:
        return 0.5 * (x + 1.0) * x * (2.0 - x)
    return (x + 1.0) * x * (x - 1.0) / 6.0


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
        k = samples[:, 0].argmin()
        value, t, s = zoom_in(H, lines[k], columns[k], samples[k, 0], samples[k, 1], samples[k, 2])
        samples[k, 0] = 1e300  # done
        if value <= lowest:
            lowest, line, column = value, lines[k] + t, columns[k] + s
    return lowest, line, column
