"""Extra line relaxation where the Poiseuille coefficient jumps between neighbouring nodes: edge of the Hertz zone.

The Poiseuille coefficient eps changes there by orders of magnitude within one node spacing, relaxation switches
from plain to distributed changes of the pressure, and where the edge lies is settled node by node. Elsewhere two
or three sweeps suffice between corrections from coarser grids. So the few nodes along that edge, some per cent
of all, are relaxed several times after the sweeps: segments of lines in two colours, with the elastic deflection
near them.
"""

import numpy as np

from ehlcontact.jit import inner, jit, jit_loop, jit_node
from ehlcontact.lanes import LANES, any_positive, at, eight, larger, smaller
from ehlcontact.solver.kernels.relax import (
    NEAR,
    change_at,
    distribution_weight,
    line_work,
    relax_segments,
    response,
    shares_at,
    switch_value,
)
from ehlcontact.solver.kernels.reynolds import update_across, update_along, update_node

JUMP = 2.7  # ratio of the Poiseuille coefficients of neighbours that makes a front: what sweeps settle has less
FRONT_REACH = 2  # nodes on either side of it, as many as the near film of a change there reaches
# Passes of both colours: a front moves by a node or two between coarse corrections, and what it moves is exchanged
# along it, which is as many nodes long as the grid has.
INTERVALS_EACH = 64  # intervals along X per pass,
LEAST_PASSES, MOST_PASSES = 3, 16  # from so many to so many
LEAST_ALONG_ROLLING = 6  # fewest in a long contact: with three, cycles diverge across its side lobes
# Marks: the larger one stands where both fall. With a type: of plain constants kernels are compiled for each.
SOLVED, FELT = np.uint8(2), np.uint8(1)


@jit_node
def front_among(j, i, eps):
    """Whether one of the nodes `i` to ``i + 7`` may be at a front, wherever the film cavitates."""
    own, east, north = at(eps, j, eight(i)), at(eps, j, eight(i + 1)), at(eps, j + 1, eight(i))
    least, most = smaller(own, smaller(east, north)), larger(own, larger(east, north))
    return any_positive(most - JUMP * least)


@inner
@jit_loop
def mark_front(first, last, P, eps, marks):
    """Mark the nodes of lines `first` to `last` - 1 within FRONT_REACH of a front, and all that feel their film.

    `marks` (bytes) written, on these lines, NEAR more on either side, and the next: 0 elsewhere.
    """
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    marks[max(first - NEAR, 0) : min(last + NEAR, ny) + 1] = 0
    for j in range(max(first - FRONT_REACH - 1, 0), min(last + FRONT_REACH, ny)):
        low, high = max(j - FRONT_REACH, first), min(j + FRONT_REACH + 2, last)
        for i in range(1, nx):
            if (i - 1) % LANES == 0:
                steep_ahead = front_among(j, min(i, nx - LANES), eps)
            if steep_ahead and P[j, i] > 0.0:
                e, east, north = eps[j, i], eps[j, i + 1], eps[j + 1, i]
                steep = P[j, i + 1] > 0.0 and max(e, east) > JUMP * min(e, east)
                if steep or (P[j + 1, i] > 0.0 and max(e, north) > JUMP * min(e, north)):
                    _mark(low, high, i, FRONT_REACH, SOLVED, marks)
                    _mark(max(low - NEAR, 0), min(high + NEAR, ny), i, FRONT_REACH + NEAR, FELT, marks)


@inner
@jit_loop
def _mark(low, high, i, reach, mark, marks):
    for j in range(low, high):
        for ii in range(max(i - reach, 1), min(i + reach + 2, marks.shape[1] - 1)):
            marks[j, ii] = max(marks[j, ii], mark)


@inner
@jit
def segments(first, last, marks, mark):
    """Segments of at least this mark on lines `first` to `last` - 1.

    Returns (number, 3) of line, first node, and node after the last.
    """
    count = 0
    for j in range(first, last):
        for i in range(1, marks.shape[1]):
            if marks[j, i] >= mark and marks[j, i - 1] < mark:
                count += 1
    found = np.empty((count, 3), np.int64)
    count = 0
    for j in range(first, last):
        for i in range(1, marks.shape[1]):
            inside, before = marks[j, i] >= mark, marks[j, i - 1] >= mark
            if inside and not before:
                found[count, 0] = j
                found[count, 1] = i
            if before and not inside:
                found[count, 2] = i
                count += 1
    return found


@inner
@jit_loop
def add_films(solved, colour, theta, w, near, H):
    """Add to film H what the changes of the segments on lines of one colour cause within NEAR lines and nodes."""
    ny, nx = H.shape[0] - 1, H.shape[1] - 1
    for s in range(solved.shape[0]):
        source = solved[s, 0]
        if source % 2 != colour:
            continue
        for line in range(-NEAR if source > 0 else 0, min(NEAR, ny - 1 - source) + 1):
            target = abs(source + line)  # at Y < 0: what the image of this change does at Y > 0
            images = 2.0 if target == 0 and source > 0 else 1.0
            for k in range(solved[s, 1], solved[s, 2]):
                shares, change = shares_at(source, k, theta), images * w[source, k]
                for i in range(max(k - NEAR, 1), min(k + NEAR, nx - 1) + 1):
                    H[target, i] += change * response(line, i - k, shares, near)


@jit(inline="always")  # one caller: what it calls is optimised one time less
def solve_segments(solved, colour, fields, rhs, stencil, c_t, near, work):
    """`relax_segments` on those segments that lie on lines of one colour; `work` by `line_work`."""
    found = np.empty((LANES, 3), np.int64)
    count = 0
    for s in range(solved.shape[0]):
        if solved[s, 0] % 2 == colour:
            # not found[count] = ...: the message for shapes that differ takes seconds to compile
            found[count, 0], found[count, 1], found[count, 2] = solved[s, 0], solved[s, 1], solved[s, 2]
            count += 1
        if count == LANES or (count > 0 and s == solved.shape[0] - 1):
            relax_segments(found[:count], fields, rhs, stencil, c_t, near, work)
            count = 0


@inner
@jit_loop
def spread_segments(solved, felt, colour, fields, law, stencil, near):
    """P, film and flow at the nodes of segments `felt` by the changes of those `solved` on lines of one colour."""
    P, H, flow, theta, w = fields.P, fields.H, fields.flow, fields.theta, fields.w
    add_films(solved, colour, theta, w, near, H)
    for s in range(felt.shape[0]):
        j = felt[s, 0]
        for i in range(felt[s, 1], felt[s, 2]):
            P[j, i] = max(P[j, i] + change_at(j, i, colour, P, theta, w), 0.0)
        for i in range(felt[s, 1], felt[s, 2], LANES):  # nodes beside the segment come out as they were
            update_node(j, eight(min(i, P.shape[1] - LANES)), P, H, law, stencil, flow)


@inner
@jit_loop
def update_between_segments(felt, flow):
    """Flow between the nodes of segments and all their neighbours.

    Faces between two segments are done by both, which write the same.
    """
    for s in range(felt.shape[0]):
        j = felt[s, 0]
        for i in range(felt[s, 1] - 1, felt[s, 2]):
            update_along(j, i, flow)
        for i in range(felt[s, 1], felt[s, 2]):
            update_across(j, i, flow)
            if j > 0:
                update_across(j - 1, i, flow)


@inner
@jit_loop
def weigh_segments(felt, fields, stencil, c_t):
    """Weights of the distributed changes at the nodes of segments."""
    switch = switch_value(stencil, c_t)
    for s in range(felt.shape[0]):
        j = felt[s, 0]
        for i in range(felt[s, 1], felt[s, 2]):
            fields.theta[j, i] = distribution_weight(j, i, fields.P, fields.flow, stencil, switch)


def passes_of(nx, long):
    """Passes of both colours on a grid of `nx` intervals, `long` where the contact is long along rolling."""
    return min(max(nx // INTERVALS_EACH, LEAST_ALONG_ROLLING if long else LEAST_PASSES), MOST_PASSES)


@jit(inline="always")  # likewise
def relax_flanks(first, last, fields, rhs, law, stencil, c_t, near, marks, passes, work):
    """Relax along the fronts of ``fields.theta`` on lines `first` to `last` - 1.

    P, and within NEAR lines H, flow and theta of `fields` written.
    """
    ny = fields.P.shape[0] - 1
    mark_front(first, last, fields.P, fields.flow.eps, marks)
    solved = segments(first, last, marks, SOLVED)
    if len(solved) == 0:
        return
    felt = segments(max(first - NEAR, 0), min(last + NEAR, ny), marks, FELT)
    fields.w[max(first - NEAR - 1, 0) : min(last + NEAR, ny) + 1] = 0.0
    for _ in range(passes):
        for colour in range(2):
            solve_segments(solved, colour, fields, rhs, stencil, c_t, near, work)
            spread_segments(solved, felt, colour, fields, law, stencil, near)
            update_between_segments(felt, fields.flow)
        weigh_segments(felt, fields, stencil, c_t)


@jit
def relax_flank_blocks(first, last, colour, lines, fields, rhs, law, stencil, c_t, near, marks, passes):
    """`relax_flanks` on the blocks of `lines` lines ``colour + 2 k``, k from `first` to `last` - 1.

    Blocks of one colour do not feel each other.
    """
    ny = fields.P.shape[0] - 1
    work = line_work(fields.P.shape[1])
    for k in range(first, last):
        start = (colour + 2 * k) * lines
        stop = min(start + lines, ny)
        relax_flanks(start, stop, fields, rhs, law, stencil, c_t, near, marks, passes, work)
