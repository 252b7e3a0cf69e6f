"""Local line relaxation along the steep flanks of the pressure.

On the way out of the contact the flow factor falls by orders of magnitude within one cell: what relaxation solves
for changes from plain to distributed changes there, and how far the flank has come is settled node by node.
Everywhere else two or three sweeps suffice between corrections from coarser grids. So the few nodes along that
front, some per cent of all, are relaxed several times after the sweeps: segments of lines, in two colours, with
the near film of what has changed.
"""

import numpy as np

from ehlcontact.jit import jit, jit_node
from ehlcontact.solver.kernels.relax import (
    NEAR,
    change_at,
    distribution_weight,
    line_work,
    relax_line,
    response,
    shares_at,
    switch_value,
)
from ehlcontact.solver.kernels.reynolds import update_across, update_along, update_node

JUMP = 2.7  # ratio of the flow factors of neighbours that makes a front: what sweeps settle has less
FRONT_REACH = 2  # nodes on either side of it, as many as the near film of a change there reaches
# Passes of both colours: a front moves by a node or two between coarse corrections, and what it moves is exchanged
# along it, which is as many nodes long as the grid has.
INTERVALS_EACH = 64  # intervals along X per pass,
LEAST_PASSES, MOST_PASSES = 6, 16  # from so many to so many
SOLVED, FELT = 2, 1  # marks: the larger one stands where both fall


@jit
def mark_front(P, eps, marks):
    """Mark the nodes within FRONT_REACH of a front, and those that feel their film; `marks` (bytes) written."""
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    marks[:] = 0
    for j in range(ny):
        for i in range(1, nx):
            if P[j, i] > 0.0:
                e, east, north = eps[j, i], eps[j, i + 1], eps[j + 1, i]
                steep = P[j, i + 1] > 0.0 and max(e, east) > JUMP * min(e, east)
                if steep or (P[j + 1, i] > 0.0 and max(e, north) > JUMP * min(e, north)):
                    _mark(j, i, FRONT_REACH, SOLVED, marks)
                    _mark(j, i, FRONT_REACH + NEAR, FELT, marks)


@jit
def _mark(j, i, reach, mark, marks):
    ny, nx = marks.shape[0] - 1, marks.shape[1] - 1
    for jj in range(max(j - reach, 0), min(j + reach + 1, ny - 1) + 1):
        for ii in range(max(i - reach, 1), min(i + reach + 1, nx - 1) + 1):
            marks[jj, ii] = max(marks[jj, ii], mark)


@jit
def segments(marks, mark):
    """Segments of lines of at least this mark: (number, 3) of line, first node, and node after the last."""
    count = 0
    for j in range(marks.shape[0]):
        for i in range(1, marks.shape[1]):
            if marks[j, i] >= mark and marks[j, i - 1] < mark:
                count += 1
    found = np.empty((count, 3), np.int64)
    count = 0
    for j in range(marks.shape[0]):
        for i in range(1, marks.shape[1]):
            inside, before = marks[j, i] >= mark, marks[j, i - 1] >= mark
            if inside and not before:
                found[count, 0] = j
                found[count, 1] = i
            if before and not inside:
                found[count, 2] = i
                count += 1
    return found


@jit_node
def film_at(j, i, colour, theta, w, near):
    """Film at one node by the distributed changes of the lines of one colour within NEAR lines and nodes."""
    film = 0.0
    ny, nx = w.shape[0] - 1, w.shape[1] - 1
    for line in range(-NEAR, NEAR + 1):
        source = abs(j - line)
        if (source - colour) % 2 == 0 and source < ny:
            toward = line if j >= line else -line  # the image of a line lies, and gives, the other way round
            for k in range(max(i - NEAR, 1), min(i + NEAR, nx - 1) + 1):
                if w[source, k] != 0.0:
                    film += w[source, k] * response(toward, i - k, shares_at(source, k, theta), near)
    return film


@jit
def solve_segments(first, last, solved, colour, fields, rhs, stencil, c_t, near):
    """`relax_line` on those of segments `first` to `last` - 1 that lie on lines of one colour."""
    work = line_work(fields.P.shape[1])
    for s in range(first, last):
        if solved[s, 0] % 2 == colour:
            relax_line(solved[s, 0], solved[s, 1], solved[s, 2], fields, rhs, stencil, c_t, near, work)


@jit
def spread_segments(first, last, felt, colour, fields, law, stencil, near):
    """P, film and flow at nodes of segments `first` to `last` - 1 by the changes of the lines of one colour."""
    P, H, flow, theta, w = fields.P, fields.H, fields.flow, fields.theta, fields.w
    for s in range(first, last):
        j = felt[s, 0]
        for i in range(felt[s, 1], felt[s, 2]):
            P[j, i] = max(P[j, i] + change_at(j, i, colour, P, theta, w), 0.0)
            H[j, i] += film_at(j, i, colour, theta, w, near)
            update_node(j, i, P, H, law, stencil, flow)


@jit
def update_between_segments(first, last, felt, flow):
    """Flow between the nodes of segments `first` to `last` - 1 and all their neighbours.

    Faces between two segments are done by both, which write the same.
    """
    for s in range(first, last):
        j = felt[s, 0]
        for i in range(felt[s, 1] - 1, felt[s, 2]):
            update_along(j, i, flow)
        for i in range(felt[s, 1], felt[s, 2]):
            update_across(j, i, flow)
            if j > 0:
                update_across(j - 1, i, flow)


@jit
def weigh_segments(first, last, felt, fields, stencil, c_t):
    """Weights of the distributed changes at the nodes of segments `first` to `last` - 1."""
    switch = switch_value(stencil, c_t)
    for s in range(first, last):
        j = felt[s, 0]
        for i in range(felt[s, 1], felt[s, 2]):
            fields.theta[j, i] = distribution_weight(j, i, fields.P, fields.flow, stencil, switch)


@jit
def passes_of(nx):
    """Passes of both colours on a grid of `nx` intervals."""
    return min(max(nx // INTERVALS_EACH, LEAST_PASSES), MOST_PASSES)


@jit
def relax_flanks(fields, rhs, law, stencil, c_t, near, marks):
    """Relax along the fronts of ``fields.theta``; P, and near them H, flow and theta of `fields` written.

    By one thread: a pass takes less than another thread needs to wake (shared, n = 1024 took twice as long).
    """
    mark_front(fields.P, fields.flow.eps, marks)
    solved, felt = segments(marks, SOLVED), segments(marks, FELT)
    if len(solved) == 0:
        return
    fields.w[:] = 0.0
    for _ in range(passes_of(fields.P.shape[1] - 1)):
        for colour in range(2):
            solve_segments(0, len(solved), solved, colour, fields, rhs, stencil, c_t, near)
            spread_segments(0, len(felt), felt, colour, fields, law, stencil, near)
            update_between_segments(0, len(felt), felt, fields.flow)
        weigh_segments(0, len(felt), felt, fields, stencil, c_t)
