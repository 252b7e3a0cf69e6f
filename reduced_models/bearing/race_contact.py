"""Static law of one contact of a ball and a race, compiled: dry compression over approach, by tables.

As ``race_contact.c`` has it, whose steps bearings run. The equations of its films are those of
`reduced_models.elements.film_law` without saturation of the inlet.
"""

from __future__ import annotations

from ehlcontact.jit import inner, jit_exact_called_node, jit_exact_loop, jit_exact_node
from reduced_models.bearing.race_table import CELLS
from reduced_models.elements.film_curve import RIGID_SLOPE
from reduced_models.elements.film_law import interval
from reduced_models.elements.film_speed import FILM_GROWTH

MOST_STEPS = 100  # of Newton's method for the film of a contact: a handful
FOUND = 1e-7  # of g, its last step: what that leaves is of its square


@inner
@jit_exact_loop
def row_of_speed(speeds, omega):
    """Row of the tables made at increasing `speeds` of the shaft, and weight of the next, at the speed `omega`.

    Above the highest speed the tables of that speed hold.
    """
    if speeds.size < 2:
        return 0, 0.0
    omega = min(omega, speeds[-1])
    row = min(max(interval(speeds, omega), 0), speeds.size - 2)
    low, high = speeds[row] ** FILM_GROWTH, speeds[row + 1] ** FILM_GROWTH
    return row, (omega**FILM_GROWTH - low) / (high - low)


@jit_exact_called_node
def curve(u, row, weight, law, k):
    """Dry compression g [m] at approach `u` and its slope, `weight` from one `row` of speeds to the next.

    `k` is where to begin to look for the interval of u; that found is returned too.
    """
    if law.x.size == 0:
        return max(u, 0.0), 1.0 if u > 0.0 else 0.0, 0
    g, slope, k = _at(u, law, row, k)
    if weight > 0.0:
        other, other_slope, _ = _at(u, law, row + 1, k)
        g += weight * (other - g)
        slope += weight * (other_slope - slope)
    return g, slope, k


@jit_exact_node
def _at(u, law, row, k):
    """Table of one speed."""
    nodes, cells, last = law.u, law.cells, law.x.size - 2
    while k > 0 and u < nodes[row, k]:
        k -= 1
    while k < last and u >= nodes[row, k + 1]:
        k += 1
    start = nodes[row, k]
    if u < start:  # wider than the table: F like h^-1/2
        g = cells[row, 0, 0, 0] * (u / start) ** (2.0 / 3.0 / RIGID_SLOPE)
        return g, g / u * (2.0 / 3.0 / RIGID_SLOPE), k
    per_u = CELLS / (nodes[row, k + 1] - start)
    t = (u - start) * per_u
    j = min(int(t), CELLS - 1)
    t -= j
    a, b, c, d = cells[row, k, j, 0], cells[row, k, j, 1], cells[row, k, j, 2], cells[row, k, j, 3]
    if t > 1.0 and k == last:  # an iteration went too far: straight on
        slope = b + 2.0 * c + 3.0 * d
        return a + b + c + d + slope * (t - 1.0), slope * per_u, k
    return a + t * (b + t * (c + t * d)), (b + t * (2.0 * c + 3.0 * d * t)) * per_u, k


@jit_exact_node
def film_curve(u, film, row, weight, law, k):
    """As `curve`, for a film that is not that of the table.

    With g(v) of the table, whose film is g(v) - v, a film that is f times as thick at the same force is right
    where (1 - f) g(v) + f v = u.

    Parameters
    ----------
    film : (float, float) or None
        f, and a guess of v - u; None: the film of the table.

    Returns
    -------
    tuple
        g, its slopes by u and by f, v - u, the interval.
    """
    if film is None or law.x.size == 0:
        g, slope, k = curve(u, row, weight, law, k)
        return g, slope, 0.0, 0.0, k
    f, lift = film
    v, g, slope, stretch = u + lift, 0.0, 1.0, 1.0
    for _ in range(MOST_STEPS):
        g, slope, k = curve(v, row, weight, law, k)
        if f == 1.0:
            return g, slope, slope * (g - v), v - u, k
        stretch = (1.0 - f) * slope + f
        step = (u - (1.0 - f) * g - f * v) / stretch
        v, g = v + step, g + slope * step
        if abs(step) <= FOUND * g:
            break
    return g, slope / stretch, slope * (g - v) / stretch, v - u, k


@jit_exact_node
def gain(law, speed_row, node, k):
    """Gain `k` at a node of the load, between two speeds."""
    row, weight = speed_row
    found = law.gains[row, node, k]
    if weight > 0.0:
        found += weight * (law.gains[row + 1, node, k] - found)
    return found


@jit_exact_node
def _made_at(law, speed_row, node):
    """As `film_made`, at a node of the load."""
    row, weight = speed_row
    found = law.film_made[row, node]
    if weight > 0.0:
        found += weight * (law.film_made[row + 1, node] - found)
    return found


@jit_exact_called_node
def film_made(law, speed_row, x):
    """Film that a unit of the inlet's state lets into the chain at x = ln F."""
    last = law.x.size - 2
    k = min(
        max(int((x - law.x[0]) / (law.x[last + 1] - law.x[0]) * last), 0), last
    )  # near it: nodes are nearly even
    while k > 0 and x < law.x[k]:
        k -= 1
    while k < last and x > law.x[k + 1]:
        k += 1
    here = _made_at(law, speed_row, k)
    weight = min(max((x - law.x[k]) / (law.x[k + 1] - law.x[k]), 0.0), 1.0)
    return here + weight * (_made_at(law, speed_row, k + 1) - here)


@jit_exact_called_node
def film_cutoff(u, cutoff_gap):
    """Share of its force that a film carries at approach `u`, and its slope."""
    gap = -u / cutoff_gap
    if gap <= 0.5:
        return 1.0, 0.0
    if gap >= 1.0:
        return 0.0, 0.0
    t = 2.0 * gap - 1.0
    return 1.0 - t * t * (3.0 - 2.0 * t), 12.0 * t * (1.0 - t) / cutoff_gap
