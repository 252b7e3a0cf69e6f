"""Projected point Gauss-Seidel along the cavitation boundary.

Line relaxation with clipping leaves residuals on the last lines before the free boundary, where P is tiny:
the second stall of the classical scheme, besides the switch line. A few local passes at frozen film remove
them. Only where flow through the gap dominates: elsewhere the film answers to the pressure at once, and a
frozen film makes these passes diverge.
"""

from ehlcontact.jit import inner, jit_loop, jit_node
from ehlcontact.lanes import LANES, any_positive, at, eight, larger, put, where_positive
from ehlcontact.solver.kernels.linearise import NEIGHBOURS, neighbour
from ehlcontact.solver.kernels.reynolds import operator_at, transport_at, update_across, update_along, update_node
from ehlcontact.solver.kernels.supply import carry_line

# Coarse corrections end some way before the boundary, not some nodes: what is left to passes grows with the grid.
NODES_EACH = 64  # intervals along X per node of reach,
LEAST_REACH, MOST_REACH = 3, 8  # from so many nodes on either side of the boundary to so many
PASSES_EACH = 2  # passes per node of reach, which a change has to cross
UPDATED = 255  # mark: the largest byte, above every reach
DOMINANCE = 10.0  # flow term over wedge term, in proportion more on meshes finer along X,
NEAREST = 3.0  # up to this distance from the boundary; as its cube more beyond, where smoother changes are relaxed
SQUEEZE_DOMINANCE = 300.0  # flow term over squeeze term: short steps fail by the passes where it is smaller
COUPLINGS = 6  # numbers of a node in `couple`


@inner
@jit_loop
def reach_of(nx):
    """Nodes on either side of the boundary that are relaxed."""
    return min(max(nx // NODES_EACH, LEAST_REACH), MOST_REACH)


@jit_node
def boundary_among(j, i, P):
    """Whether one of the nodes `i` to ``i + 7`` is not as its neighbour E or N, of P > 0 and P = 0."""
    own = where_positive(at(P, j, eight(i)), 1.0, 0.0)
    east = own - where_positive(at(P, j, eight(i + 1)), 1.0, 0.0)
    north = own - where_positive(at(P, j + 1, eight(i)), 1.0, 0.0)
    return any_positive(east * east + north * north)


@inner
@jit_loop
def mark_boundary(first, last, P, reach, marks):
    """Mark the nodes within `reach` of a change between P > 0 and P = 0, by 1 at the farthest, reach + 1 at it.

    `marks` (bytes) written on lines `first` to `last` - 1 and on one more on either side: 0 elsewhere.
    """
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    marks[max(first - 1, 0) : last + 1] = 0
    for j in range(max(first - reach - 1, 0), min(last + reach, ny)):
        for k in range(1, nx, LANES):
            if not boundary_among(j, min(k, nx - LANES), P):
                continue
            for i in range(k, min(k + LANES, nx)):
                wet = P[j, i] > 0.0
                east = i + 1 < nx and (P[j, i + 1] > 0.0) != wet
                north = j + 1 < ny and (P[j + 1, i] > 0.0) != wet
                if east or north:
                    for jj in range(max(j - reach, first), min(j + reach + 2, last)):
                        for ii in range(max(i - reach, 1), min(i + reach + 2, nx)):
                            away = max(abs(jj - j), abs(ii - i))
                            marks[jj, ii] = max(marks[jj, ii], reach + 1 - min(away, reach))


@jit_node
def total_flow(j, i, flow, stencil):
    """Sum of the four couplings of one node."""
    face = j - 1 if j > 0 else 0
    along = flow.along[j, i - 1] + flow.along[j, i]
    return stencil.cx * along + stencil.cy * (flow.across[face, i] + flow.across[j, i])


@inner
@jit_loop
def update_marked(first, last, P, H, law, stencil, flow, marks):
    """Flow at marked nodes, their neighbours and the faces between; `marks` of the neighbours become UPDATED."""
    for j in range(first, last):
        for i in range(1, P.shape[1] - 1):
            if 0 < marks[j, i] < UPDATED:
                update_node(j, i, P, H, law, stencil, flow)
                for q in range(1, NEIGHBOURS):
                    jq, iq = neighbour(q, j, i)
                    if iq >= 0 and marks[jq, iq] == 0:
                        update_node(jq, iq, P, H, law, stencil, flow)
                        marks[jq, iq] = UPDATED
    for j in range(first, last):
        for i in range(1, P.shape[1] - 1):
            if 0 < marks[j, i] < UPDATED:
                update_along(j, i - 1, flow)
                update_along(j, i, flow)
                update_across(j - 1 if j > 0 else 0, i, flow)
                update_across(j, i, flow)


@jit_node
def couple(j, i, s, flow, rhs, stencil, c_t, own, couplings):
    """What the passes need of a node at frozen film and flow, a full film; ``couplings[s]`` written.

    Its new pressure is a sum over the four neighbours, W, E, S, N, and itself, less a constant.
    """
    south, north = flow.across[j - 1 if j > 0 else 0, i], flow.across[j, i]
    if j == 0:
        south, north = 0.0, south + north  # the image of line 1
    total = total_flow(j, i, flow, stencil)
    share = 1.0 / (total + own)
    couplings[s, 0] = share * stencil.cx * flow.along[j, i - 1]
    couplings[s, 1] = share * stencil.cx * flow.along[j, i]
    couplings[s, 2] = share * stencil.cy * south
    couplings[s, 3] = share * stencil.cy * north
    couplings[s, 4] = share * own
    couplings[s, 5] = share * (rhs[j, i] + transport_at(j, i, flow.mass, stencil, c_t))


@jit_node
def relax_coupled(node, s, P, couplings):
    """Relax the pressure of one node, by its flat number, with ``couplings[s]``."""
    width = P.shape[1]
    south = node - width if node >= width else node
    p = at(couplings, s, 4) * at(P, 0, node) - at(couplings, s, 5)
    p += at(couplings, s, 2) * at(P, 0, south) + at(couplings, s, 3) * at(P, 0, node + width)
    # what was relaxed last comes last
    p += at(couplings, s, 1) * at(P, 0, node + 1) + at(couplings, s, 0) * at(P, 0, node - 1)
    put(P, 0, node, larger(p, 0.0))


@jit_loop(inline="always")  # one caller: what it calls is optimised one time less
def relax_boundary(first, last, P, H, flow, supply, law, stencil, c_t, self_deflection, nodes, couplings, marks):
    """Relax P near the cavitation boundary on lines `first` to `last` - 1, at frozen film and flow.

    `P` and, there and on the next lines, `flow` are written, and what `supply` holds (for `carry_line`); `nodes`,
    `couplings` and `marks` are work space.
    """
    rhs, inflow, excess, carried, stored, supplied = supply
    width = P.shape[1]
    reach = reach_of(width - 1)
    mark_boundary(first, last, P, reach, marks)
    update_marked(first, last, P, H, law, stencil, flow, marks)
    transport = DOMINANCE * stencil.crowding * 1.5 * stencil.inv_hx + SQUEEZE_DOMINANCE * c_t
    film = (1.5 * stencil.inv_hx + c_t) * self_deflection
    begin = end = first * width
    for j in range(first, last):
        for i in range(1, width - 1):
            away = max(1.0, (reach + 1 - marks[j, i]) / NEAREST)
            least = transport * self_deflection * away * away * away
            if 0 < marks[j, i] < UPDATED and total_flow(j, i, flow, stencil) > least:
                nodes[end] = j * width + i
                couple(j, i, end, flow, rhs, stencil, c_t, film, couplings)
                end += 1
    for sweep in range(PASSES_EACH * reach):
        line = -1
        for step in range(end - begin):
            s = begin + step if sweep % 2 == 0 else end - 1 - step
            node = nodes[s]
            if len(inflow) == 0:
                relax_coupled(node, s, P, couplings)
                continue
            j, i = node // width, node % width
            if j != line:
                carry_line(j, width - 1, P, flow, rhs, inflow, excess, stencil, c_t, carried, stored, supplied)
                line = j
            own = total_flow(j, i, flow, stencil) + film
            res = supplied[j, i] - operator_at(j, i, P, flow, stencil, c_t)
            P[j, i] = max(P[j, i] - res / own, 0.0)


@jit_loop
def relax_boundary_blocks(first, last, colour, lines, P, H, flow, supply, law, stencil, c_t, own, work):
    """`relax_boundary` on the blocks of `lines` lines ``colour + 2 k``, k from `first` to `last` - 1.

    Blocks of one colour do not see each other.
    """
    nodes, couplings, marks = work
    for k in range(first, last):
        start = (colour + 2 * k) * lines
        stop = min(start + lines, P.shape[0] - 1)
        relax_boundary(start, stop, P, H, flow, supply, law, stencil, c_t, own, nodes, couplings, marks)
