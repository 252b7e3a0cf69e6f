"""Hybrid line relaxation along X in zebra order: even lines first, then odd lines; eight lines at once.

Where flow through the gap dominates, this is Gauss-Seidel in P. Where the oil is stiff and mere transport is left,
a change of P is taken back in equal shares by the four neighbours: the deflection of such a distributed change
decays like 1/r^3 instead of 1/r, so a few near coefficients stand for all (distributive Jacobi; Venner and
Lubrecht 2000, ch. 6). Two neighbours exchange ``SHARE min(theta, theta')``. The weight theta is a *smooth*
function of the local ratio of flow and transport: a hard switch flips to and fro from sweep to sweep and leaves a
limit cycle along the switch line. And the *smaller* of both weights counts: what a stiff node gave to a neighbour
with a thousand times its Poiseuille coefficient, as there are on the flanks of the pressure, would leave a
residual there a thousand times its own.

The Poiseuille coefficient eps falls by orders of magnitude from one node to the next on those flanks. With eps
frozen, single nodes there never settle; with its full derivatives they overshoot. Three quarters of the
derivatives serve everywhere. And the change of a whole line is cut where it is too large for its linear
equations: cut node by node, it would no longer be distributed.

Eight lines of one colour, or segments of such lines, are solved side by side, one in each lane of a register: a
solve by itself is a chain of short steps that wait for each other. Their equations are made line by line, eight
nodes at a time.
"""

import numpy as np

from ehlcontact.jit import inner, jit, jit_loop, jit_node
from ehlcontact.lanes import LANES, at, eight, larger, put, put_transposed, smaller, where_positive
from ehlcontact.solver.kernels.linearise import linearise_at
from ehlcontact.solver.kernels.reynolds import operator_at

ALONG = 6  # nodes on either side whose film by a change counts in the equations of its line: with 2, sweeps
# diverge in stiff oil on lines 4 and more node distances apart, by local mode analysis and indeed
BAND_LOWER, BAND_UPPER = ALONG + 2, ALONG + 1  # the WW neighbour with all of them upstream, E with them downstream
BAND = BAND_LOWER + BAND_UPPER + 1  # diagonals, the main one with them
PAD = max(BAND_LOWER, BAND_UPPER)
FILM_MARGIN = 3  # zeros on either side of those films, so that no row has to look where they end
NEAR = 2  # lines and nodes on either side that feel a change in the film of other lines
SHARE = 0.25  # part of a distributed change that each neighbour takes back
SWITCH = 5.0  # eps/hx^2 at which theta = 1/2 in steady flow (Venner and Lubrecht's hard switch: 0.3),
# for meshes up to twice as fine along X as along Y, physically; in proportion more for finer ones
SQUEEZE = 10.0  # how much more the squeeze term raises it than the wedge term
FLOW_SLOPE = 0.75  # share of the derivatives of eps; see above
LARGEST_CHANGE = 0.3  # of P in one sweep, along one line; far from the solution the linear model overshoots
FILM_CHANGE = 1.0  # of the film there by the near coefficient alone, over the film: more would turn it negative
LEAST_OPENING = 0.003  # of a node's own term, from which the film of the next lines counts in its equation
ROWS = 128  # of eight systems made one after the other: fewer, and their fields come from memory in pieces
ROOM = ROWS + 3 * LANES  # in a line for them: before and behind, for eights that overlap
FROM_SOUTH, FROM_NORTH, OPENING, RESIDUAL = BAND, BAND + 1, BAND + 2, BAND + 3  # behind the entries of a row


@jit_node
def distribution_weight(j, i, P, flow, stencil, switch):
    """Weight theta of the distributed change at an interior node, or eight.

    A dry one has no pressure to take back from.
    """
    face = j - 1 if j > 0 else 0
    along = stencil.cx * larger(at(flow.along, j, i - 1), at(flow.along, j, i))
    across = stencil.cy * larger(at(flow.across, face, i), at(flow.across, j, i))
    ratio = larger(along, across) / switch
    return where_positive(at(P, j, i), 1.0 / (1.0 + ratio * ratio * ratio * ratio), 0.0)


@jit_node
def switch_value(stencil, c_t):
    """eps/hx^2 at which both relaxations have equal parts.

    The squeeze term, unlike the wedge term, does not vanish for smooth changes. Plain changes of P, whose
    smooth part deflects the film far beyond the near coefficients, are then safe only at larger eps.
    """
    return SWITCH * stencil.crowding * stencil.speed * (1.0 + SQUEEZE * c_t / (1.5 * stencil.inv_hx))


@jit_loop
def distribution_weights(first, last, P, flow, stencil, c_t, theta):
    """Weights theta at the interior nodes of lines `first` to `last` - 1; `theta` written."""
    switch, nx = switch_value(stencil, c_t), P.shape[1] - 1
    for j in range(first, last):
        for k in range(1, nx, LANES):
            i = eight(min(k, nx - LANES))
            put(theta, j, i, distribution_weight(j, i, P, flow, stencil, switch))


@inner
@jit_loop
def solve_bands(band, b, m):
    """Solve `LANES` banded systems of `m` rows in place; no pivoting, the leading part being upstream-triangular.

    ``band[r, (BAND_LOWER + c - r) LANES + k]`` couples row r to row c of system k; the right-hand side ``b[r, k]``
    becomes the solution. Both have `PAD` rows more, so that the inner loops need no limits.
    """
    band[m : m + PAD] = 0.0
    b[m : m + PAD] = 0.0
    for r in range(m):
        pivot = 1.0 / at(band, r, eight(BAND_LOWER * LANES))
        put(band, r, eight(BAND_LOWER * LANES), pivot)
        right, above = at(b, r, eight(0)), upper_entries(band, r)
        for s in range(1, BAND_LOWER + 1):
            factor = at(band, r + s, eight((BAND_LOWER - s) * LANES)) * pivot
            add(b, r + s, eight(0), -factor * right)
            for c in range(BAND_UPPER):
                add(band, r + s, eight((BAND_LOWER + 1 + c - s) * LANES), -factor * above[c])
    for r in range(m - 1, -1, -1):
        value, above = at(b, r, eight(0)), upper_entries(band, r)
        for c in range(BAND_UPPER - 1, -1, -1):  # what was solved last comes last
            value = value - above[c] * at(b, r + 1 + c, eight(0))
        put(b, r, eight(0), value * at(band, r, eight(BAND_LOWER * LANES)))


@jit_node
def add(a, j, i, value):
    """Add to one entry of an array, or to eight."""
    put(a, j, i, at(a, j, i) + value)


@jit_node
def upper_entries(band, r):
    """The `BAND_UPPER` entries of a row behind its diagonal."""
    first = eight((BAND_LOWER + 1) * LANES)
    return (
        at(band, r, first),
        at(band, r, first + LANES),
        at(band, r, first + 2 * LANES),
        at(band, r, first + 3 * LANES),
        at(band, r, first + 4 * LANES),
        at(band, r, first + 5 * LANES),
        at(band, r, first + 6 * LANES),
    )


@jit_node
def share(j, i, jq, iq, theta):
    """Share of a change at an interior node, or eight, that a neighbour takes back; the same for both."""
    return SHARE * smaller(at(theta, j, i), at(theta, jq, iq))


@jit_node
def shares_at(j, i, theta):
    """Shares of a change at an interior node, or eight, that the neighbours W, E, S, N take back."""
    south = j - 1 if j > 0 else 1
    return (
        share(j, i, j, i - 1, theta),
        share(j, i, j, i + 1, theta),
        share(j, i, south, i, theta),
        share(j, i, j + 1, i, theta),
    )


@jit_node
def response(line, shift, shares, near):
    """Film by a distributed unit change, `line` lines and `shift` nodes further, from the near coefficients."""
    west, east, south, north = shares
    film = near[abs(line), abs(shift)] - west * near[abs(line), abs(shift + 1)]
    film -= east * near[abs(line), abs(shift - 1)]
    return film - south * near[abs(line + 1), abs(shift)] - north * near[abs(line - 1), abs(shift)]


@jit_node
def responses(j, start, stop, theta, near, films):
    """`response` along line j of its nodes `start` to `stop` - 1.

    ``films[ALONG + FILM_MARGIN + shift, PAD + i]`` written, and 0 for `PAD` nodes beside them.
    """
    centre, nx = ALONG + FILM_MARGIN, theta.shape[1] - 1
    here, beside = near[0], near[1]
    for k in range(start, stop, LANES):
        i = eight(min(k, nx - LANES))
        west, east, south, north = shares_at(j, i, theta)
        across = south + north
        put(films, centre, i + PAD, here[0] - (west + east) * here[1] - across * beside[0])
        for shift in range(1, ALONG + 1):
            even = here[shift] - across * beside[shift]
            put(films, centre + shift, i + PAD, even - west * here[shift + 1] - east * here[shift - 1])
            put(films, centre - shift, i + PAD, even - west * here[shift - 1] - east * here[shift + 1])
    for row in range(centre - ALONG, centre + ALONG + 1):
        put(films, row, eight(start), 0.0)
        put(films, row, eight(PAD + stop), 0.0)


@jit_node
def assemble_at(j, i, P, flow, theta, rhs, stencil, c_t, films, near, rows, k):
    """Row of one node in the matrix of distributed changes of its line, or rows of eight; ``rows[:, k]`` written.

    A unit change at a node of the line raises P there by 1, lowers its neighbours by their shares and deflects the
    film near it by its column of `films`. ``rows[BAND_LOWER + o]`` is what a change `o` nodes further does.
    """
    pc, pw, pe, ps, pn, pww, hc, hw, he, hs, hn, hww = linearise_at(j, i, P, flow, stencil, c_t, FLOW_SLOPE)
    for o in range(-BAND_LOWER, BAND_UPPER + 1):
        q, n = ALONG + FILM_MARGIN - o, i + (PAD + o)
        film = hc * at(films, q, n) + hw * at(films, q - 1, n)
        put(rows, BAND_LOWER + o, k, film + hww * at(films, q - 2, n) + he * at(films, q + 1, n))
    near_west, near_east, south, north = shares_at(j, i, theta)
    east = share(j, i + 1, j, i + 2, theta)
    if i > 2:
        far_west, west = share(j, i - 3, j, i - 2, theta), share(j, i - 2, j, i - 1, theta)
    else:
        far_west, west = 0.0 * pc, 0.0 * pc  # the border takes nothing back
    add(rows, BAND_LOWER - 3, k, -pww * far_west)
    add(rows, BAND_LOWER - 2, k, pww - pw * west)
    add(rows, BAND_LOWER - 1, k, pw - pww * west - pc * near_west)
    # line 1 gives to the symmetry line twice: itself and its image
    across = pn * north + (2.0 if j == 1 else 1.0) * ps * south
    add(rows, BAND_LOWER, k, pc - pw * near_west - pe * near_east - across)
    add(rows, BAND_LOWER + 1, k, pe - pc * near_east)
    add(rows, BAND_LOWER + 2, k, -pe * east)
    hs, hn = smaller(hs, 0.0), smaller(hn, 0.0)
    own = pc + hc * near[0, 0]
    put(rows, FROM_SOUTH, k, hs)
    put(rows, FROM_NORTH, k, hn)
    put(rows, OPENING, k, -(hs + hn) * near[1, 0] - LEAST_OPENING * larger(own, -own))
    put(rows, RESIDUAL, k, at(rhs, j, i) - operator_at(j, i, P, flow, stencil, c_t))


@inner
@jit_loop
def add_film_of_next_lines(j, i, theta, near, rows, k):
    """Add the film of the next lines to the row of node i, ``rows[:, k]``.

    It counts where oil flows there: beside the side lobes of long contacts pressure opens its own way out, by more
    than the flow that it drives through the gap as it is. Without that the last lines of a lobe move by twice what
    they should and more, and sweeps diverge. Where oil comes from the next line that term has the other sign: it
    would take away what holds the solve together.
    """
    last = theta.shape[1] - 1
    north = np.int64(1)  # with its type `response` is compiled once for both
    for o in range(max(-NEAR, 1 - i), min(NEAR, last - 1 - i) + 1):
        shares = shares_at(j, i + o, theta)
        film = rows[FROM_SOUTH, k] * response(-north, -o, shares, near)
        rows[BAND_LOWER + o, k] += film + rows[FROM_NORTH, k] * response(north, -o, shares, near)


@jit_node
def joins(j, i, P, theta, near, rows, k):
    """Whether node i joins the solve: ``rows[:, k]``, its row, is that of no change where it does not.

    A node is active if P > 0 or if its residual is negative (complementarity).
    """
    if not (at(P, j, i) > 0.0 or at(rows, RESIDUAL, k) < 0.0):
        for o in range(BAND):
            put(rows, o, k, 0.0)
        put(rows, BAND_LOWER, k, 1.0)
        put(rows, RESIDUAL, k, 0.0)
        return False
    if at(rows, OPENING, k) > 0.0:
        add_film_of_next_lines(j, i, theta, near, rows, k)
    return True


@jit_node
def set_idle(r, lane, band, b):
    """Row r of a system: no change."""
    for o in range(BAND):
        put(band, r, o * LANES + lane, 0.0)
    put(band, r, BAND_LOWER * LANES + lane, 1.0)
    put(b, r, lane, 0.0)


@jit_node
def assemble_rows(j, start, stop, first, lane, fields, rhs, stencil, c_t, near, work):
    """Rows `first` to ``first + ROWS - 1`` of system `lane`, which is nodes `start` to `stop` - 1 of line j.

    Returns the number of the last node of them that joins, from 1, or 0.
    """
    P, flow, theta = fields.P, fields.flow, fields.theta
    films, _, _, rows, _ = work
    nx, m = P.shape[1] - 1, 0
    begin, end = start + first, min(start + first + ROWS, stop)
    column = lane * ROOM + LANES - begin  # of node 0
    responses(j, max(begin - PAD, start), min(end + PAD, stop), theta, near, films)
    for i in range(begin, min(end, 3)):  # beside the border
        assemble_at(j, i, P, flow, theta, rhs, stencil, c_t, films, near, rows, column + i)
    for k in range(max(begin, 3), end, LANES):
        i = min(k, nx - LANES)
        assemble_at(j, eight(i), P, flow, theta, rhs, stencil, c_t, films, near, rows, eight(column + i))
    for i in range(begin, end):
        if joins(j, i, P, theta, near, rows, column + i):
            m = i - start + 1
    return m


@jit_node
def turn_rows(first, count, work):
    """Rows of all systems, made node by node, in the order of the solve; from row `first` on, `count` at least."""
    _, band, b, _, lines = work
    for r in range(0, count, LANES):
        for o in range(BAND):
            put_transposed(band, first + r, o * LANES, lines, o * LANES, LANES + r)
        put_transposed(b, first + r, 0, lines, RESIDUAL * LANES, LANES + r)


@inner
@jit_loop
def relax_segments(found, fields, rhs, stencil, c_t, near, work):
    """Solve at most `LANES` segments of lines of one colour for distributed changes; ``fields.w`` written there.

    `found` has line, first node, and node after the last, of each; `work` is that of `line_work`.
    """
    _, band, b, _, _ = work
    m, longest = np.int64(0), 0  # m has one type from here on, for which `solve_bands` is compiled once
    for lane in range(len(found)):
        longest = max(longest, found[lane, 2] - found[lane, 1])
    for first in range(0, longest, ROWS):
        for lane in range(len(found)):
            j, start, stop = found[lane]
            if start + first < stop:
                m = max(m, assemble_rows(j, start, stop, first, lane, fields, rhs, stencil, c_t, near, work))
        turn_rows(first, min(ROWS, longest - first), work)
    for lane in range(LANES):
        own = found[lane, 2] - found[lane, 1] if lane < len(found) else 0
        for r in range(own, m):
            set_idle(r, lane, band, b)
    solve_bands(band, b, m)
    for lane in range(len(found)):
        j, start, stop = found[lane]
        take_change(j, start, stop, lane, m, fields, near, b)


@jit_node
def take_change(j, start, stop, lane, m, fields, near, b):
    """Change of one segment, scaled where it is too large; ``fields.w`` written there."""
    w, H = fields.w, fields.H
    largest = LARGEST_CHANGE
    for i in range(start, stop):
        change = at(b, i - start, lane) if i - start < m else 0.0
        put(w, j, i, change)
        film = at(H, j, i)
        relative = LARGEST_CHANGE / FILM_CHANGE * near[0, 0] / film if film > 0.0 else 0.0
        largest = max(largest, abs(change) * max(1.0, relative))
    for i in range(start, stop):
        w[j, i] *= LARGEST_CHANGE / largest


@inner
@jit
def line_work(nodes):
    """Work arrays of `relax_segments` for lines of so many nodes: films, matrices, right-hand sides, rows.

    Rows stand in lines of one entry each, first all of one system. The last array
    is the same with a line for each system.
    """
    columns = nodes + 2 * PAD
    lanes = np.int64(LANES)  # with its type `aligned` is compiled once, and not for this constant too
    films = aligned(2 * (ALONG + FILM_MARGIN) + 1, columns)
    films[...] = 0.0
    lines = aligned((BAND + 4) * lanes, ROOM)
    rows = lines.reshape(BAND + 4, lanes * ROOM)
    return films, aligned(columns, BAND * lanes), aligned(columns, lanes), rows, lines


@jit
def aligned(lines, columns):
    """An array of which eight numbers, from a multiple of eight on, are one line of the cache."""
    numbers = np.empty(lines * columns + LANES)
    first = (-numbers.ctypes.data % (8 * LANES)) // 8
    return numbers[first : first + lines * columns].reshape(lines, columns)


@jit
def relax_lines(first, last, colour, fields, rhs, stencil, c_t, near):
    """`relax_segments` for groups `first` to `last` - 1 of eight of the whole lines ``colour + 2 k`` each."""
    ny, nodes = fields.P.shape[0] - 1, fields.P.shape[1]
    work = line_work(nodes)
    found = np.empty((LANES, 3), np.int64)
    for group in range(first, last):
        start = colour + 2 * LANES * group
        count = min(LANES, (ny + 1 - start) // 2)
        for lane in range(count):
            found[lane, 0], found[lane, 1], found[lane, 2] = start + 2 * lane, 1, nodes - 1
        relax_segments(found[:count], fields, rhs, stencil, c_t, near, work)


@jit_node
def change_at(j, i, colour, P, theta, w):
    """Change of P at an interior node, or eight, by the distributed changes of the lines of one colour."""
    if (j - colour) % 2 == 0:
        own = at(w, j, i)
        taken = share(j, i, j, i - 1, theta) * at(w, j, i - 1) + share(j, i, j, i + 1, theta) * at(w, j, i + 1)
        return where_positive(at(P, j, i), own - taken, own)
    taken = share(j, i, j + 1, i, theta) * at(w, j + 1, i)
    if j == 0:
        taken = 2.0 * taken  # line 1 and its image
    else:
        taken += share(j, i, j - 1, i, theta) * at(w, j - 1, i)
    return where_positive(at(P, j, i), -taken, 0.0)


@jit
def apply_lines(first, last, colour, fields, near):
    """Add the distributed changes of one colour to P of lines `first` to `last` - 1, and to H of the other's.

    H is for the odd lines, which are solved after the even ones (colour 0); only near coefficients, and neighbour
    lines, count for it.
    """
    P, H, theta, w = fields.P, fields.H, fields.theta, fields.w
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    films = np.zeros((2 * NEAR + 1, nx + 1 + 2 * PAD))
    change = np.zeros((1, nx + 1))
    for j in range(first, last):
        for k in range(1, nx, LANES):
            i = eight(min(k, nx - LANES))
            put(change, 0, i, change_at(j, i, colour, P, theta, w))
        for i in range(1, nx):
            P[j, i] = max(P[j, i] + change[0, i], 0.0)
        if colour == 0 and j % 2 == 1:
            for source in (j - 1, j + 1):
                if source < ny:
                    near_film(j - source, source, theta, w, near, films, change)
                    for i in range(1, nx):
                        H[j, i] += change[0, i]


@inner
@jit_loop
def near_film(line, j, theta, w, near, films, change):
    """Film that the distributed changes of line j cause `line` lines further; ``change[0]`` written.

    `films` is work space, 0 beside the nodes of a line.
    """
    nx = theta.shape[1] - 1
    for k in range(1, nx, LANES):
        i = eight(min(k, nx - LANES))
        shares, own = shares_at(j, i, theta), at(w, j, i)
        for shift in range(-NEAR, NEAR + 1):
            put(films, NEAR + shift, i + PAD, own * response(line, shift, shares, near))
    for k in range(1, nx, LANES):
        i = eight(min(k, nx - LANES))
        film = at(films, NEAR, i + PAD)
        for shift in range(1, NEAR + 1):
            film += at(films, NEAR + shift, i + (PAD - shift)) + at(films, NEAR - shift, i + (PAD + shift))
        put(change, 0, i, film)
