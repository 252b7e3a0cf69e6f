"""Hybrid line relaxation: one unknown line along X at a time, even lines first, then odd lines.

Where flow through the gap dominates, this is Gauss-Seidel in P. Where the oil is stiff and mere transport is left,
a change of P is taken back in equal shares by the four neighbours: the deflection of such a distributed change
decays like 1/r^3 instead of 1/r, so a few near coefficients stand for all (distributive Jacobi; Venner and
Lubrecht 2000, ch. 6). Two neighbours exchange ``SHARE min(theta, theta')``. The weight theta is a *smooth*
function of the local ratio of flow and transport: a hard switch flips to and fro from sweep to sweep and leaves a
limit cycle along the switch line. And the *smaller* of both weights counts: what a stiff node gave to a neighbour
with a thousand times its flow factor, as there are on the flanks of the pressure, would leave a residual there a
thousand times its own.

The flow factor eps falls by orders of magnitude from one node to the next on those flanks. Taken as given, single
nodes there never settle; with its full derivatives they overshoot. Three quarters of them serve everywhere. And
the change of a whole line is cut where it is too large for its linear equations: cut node by node, it would no
longer be distributed.
"""

import numpy as np

from ehlcontact.jit import jit, jit_node
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


@jit_node
def distribution_weight(j, i, P, flow, stencil, switch):
    """Weight theta of the distributed change at one interior node; a dry one has no pressure to take back from."""
    if P[j, i] <= 0.0:
        return 0.0
    face = j - 1 if j > 0 else 0
    along = stencil.cx * max(flow.along[j, i - 1], flow.along[j, i])
    across = stencil.cy * max(flow.across[face, i], flow.across[j, i])
    ratio = max(along, across) / switch
    return 1.0 / (1.0 + ratio * ratio * ratio * ratio)


@jit_node
def switch_value(stencil, c_t):
    """eps/hx^2 at which both relaxations have equal parts.

    The squeeze term, unlike the wedge term, does not vanish for smooth changes. Plain changes of P, whose
    smooth part deflects the film far beyond the near coefficients, are then safe only at larger eps.
    """
    return SWITCH * stencil.crowding * (1.0 + SQUEEZE * c_t / (1.5 * stencil.inv_hx))


@jit
def distribution_weights(first, last, P, flow, stencil, c_t, theta):
    """Weights theta at the interior nodes of lines `first` to `last` - 1; `theta` written."""
    switch = switch_value(stencil, c_t)
    for j in range(first, last):
        for i in range(1, P.shape[1] - 1):
            theta[j, i] = distribution_weight(j, i, P, flow, stencil, switch)


@jit
def solve_band(band, b, m):
    """Solve the banded system in place; no pivoting, the leading part being upstream-triangular.

    ``band[PAD + c, BAND_UPPER + r - c]`` couples row r to row c: column by column, so that what one row does to
    the next ones lies side by side. The right-hand side ``b[PAD + r]`` becomes the solution. Both have `PAD`
    columns on either side, so that the inner loops need no limits.
    """
    for c in range(max(m - BAND_LOWER, 0), m):
        band[PAD + c, BAND_UPPER + m - c :] = 0.0  # not read, but what is left there would grow from line to line
    for r in range(m):
        own = band[PAD + r]
        pivot = 1.0 / own[BAND_UPPER]
        own[BAND_UPPER] = pivot
        factors = lower_factors(own, pivot)  # a tuple: read from the array they would be so for every column
        for s in range(BAND_LOWER):
            b[PAD + r + 1 + s] -= factors[s] * b[PAD + r]
        for c in range(1, BAND_UPPER + 1):
            other = band[PAD + r + c]
            above = other[BAND_UPPER - c]
            for s in range(BAND_LOWER):
                other[BAND_UPPER - c + 1 + s] -= factors[s] * above
    for r in range(m - 1, -1, -1):
        own = band[PAD + r]
        value = b[PAD + r] * own[BAND_UPPER]
        b[PAD + r] = value
        for c in range(1, BAND_UPPER + 1):
            b[PAD + r - c] -= own[BAND_UPPER - c] * value


@jit_node
def columns_around(band, r):
    """Columns of `band` that row r has an entry in."""
    return band[PAD + r - BAND_LOWER : PAD + r + BAND_UPPER + 1]


@jit_node
def lower_factors(column, pivot):
    """The `BAND_LOWER` entries of a column below its diagonal, times `pivot`."""
    a, b, c, d = column[BAND_UPPER + 1], column[BAND_UPPER + 2], column[BAND_UPPER + 3], column[BAND_UPPER + 4]
    e, f, g, h = column[BAND_UPPER + 5], column[BAND_UPPER + 6], column[BAND_UPPER + 7], column[BAND_UPPER + 8]
    return a * pivot, b * pivot, c * pivot, d * pivot, e * pivot, f * pivot, g * pivot, h * pivot


@jit_node
def shares_at(j, i, theta):
    """Shares of a change at one interior node that its neighbours W, E, S, N take back."""
    t = theta[j, i]
    south = j - 1 if j > 0 else 1
    return (
        SHARE * min(t, theta[j, i - 1]),
        SHARE * min(t, theta[j, i + 1]),
        SHARE * min(t, theta[south, i]),
        SHARE * min(t, theta[j + 1, i]),
    )


@jit_node
def response(line, shift, shares, near):
    """Film by a distributed unit change, `line` lines and `shift` nodes further, from the near coefficients."""
    west, east, south, north = shares
    film = near[abs(line), abs(shift)] - west * near[abs(line), abs(shift + 1)]
    film -= east * near[abs(line), abs(shift - 1)]
    return film - south * near[abs(line + 1), abs(shift)] - north * near[abs(line - 1), abs(shift)]


@jit
def responses(line, j, start, stop, theta, near, reach, films):
    """`response` of nodes `start` to `stop` - 1 of line j, `line` lines further and up to `reach` nodes aside.

    ``films[PAD + i, centre + shift]`` written, and 0 for `PAD` nodes beside them.
    """
    centre = films.shape[1] // 2
    films[start : PAD + start] = 0.0
    films[PAD + stop : 2 * PAD + stop] = 0.0
    here, beyond, before = near[abs(line)], near[abs(line + 1)], near[abs(line - 1)]
    for i in range(start, stop):
        west, east, south, north = shares_at(j, i, theta)
        film = films[PAD + i]
        film[centre] = here[0] - (west + east) * here[1] - south * beyond[0] - north * before[0]
        for shift in range(1, reach + 1):
            even = here[shift] - south * beyond[shift] - north * before[shift]
            film[centre + shift] = even - west * here[shift + 1] - east * here[shift - 1]
            film[centre - shift] = even - west * here[shift - 1] - east * here[shift + 1]


@jit_node
def assemble_at(j, i, P, flow, theta, stencil, c_t, films, near, band, r):
    """Row `r`, of one node, in the matrix of the distributed changes of its line; `band` written for `solve_band`.

    A unit change at node k of the line raises P there by 1, lowers its neighbours by their shares and deflects the
    film near it by ``films[k]``. The film of the next lines counts where oil flows there: beside the side lobes of
    long contacts pressure opens its own way out, by more than the flow that it drives through the gap as it is.
    Without that the last lines of a lobe move by twice what they should and more, and sweeps diverge. Where oil
    comes from the next line that term has the other sign: it would take away what holds the solve together.
    """
    pc, pw, pe, ps, pn, pww, hc, hw, he, hs, hn, hww = linearise_at(j, i, P, flow, stencil, c_t, FLOW_SLOPE)
    last = P.shape[1] - 1
    # Views, whose indices are constants: the columns of the row, and the films by these nodes.
    around, sources = columns_around(band, r), films[PAD + i - BAND_LOWER : PAD + i + BAND_UPPER + 1]
    for o in range(-BAND_LOWER, BAND_UPPER + 1):
        by, at = sources[BAND_LOWER + o], ALONG + FILM_MARGIN - o
        film = hc * by[at] + hw * by[at - 1] + hww * by[at - 2] + he * by[at + 1]
        around[BAND_LOWER + o, BAND_UPPER - o] = film
    hs, hn = min(hs, 0.0), min(hn, 0.0)
    if -(hs + hn) * near[1, 0] > LEAST_OPENING * abs(pc + hc * near[0, 0]):
        for o in range(max(-NEAR, 1 - i), min(NEAR, last - 1 - i) + 1):
            shares = shares_at(j, i + o, theta)
            film = hs * response(-1, -o, shares, near) + hn * response(1, -o, shares, near)
            around[BAND_LOWER + o, BAND_UPPER - o] += film
    own = theta[j, i]
    far_west = SHARE * min(theta[j, max(i - 3, 0)], theta[j, max(i - 2, 0)])
    west = SHARE * min(theta[j, max(i - 2, 0)], theta[j, i - 1])
    near_west, near_east = SHARE * min(theta[j, i - 1], own), SHARE * min(own, theta[j, i + 1])
    east = SHARE * min(theta[j, i + 1], theta[j, min(i + 2, last)])
    south = SHARE * min(own, theta[j - 1 if j > 0 else 1, i])
    north = SHARE * min(own, theta[j + 1, i])
    around[BAND_LOWER - 3, BAND_UPPER + 3] -= pww * far_west
    around[BAND_LOWER - 2, BAND_UPPER + 2] += pww - pw * west
    around[BAND_LOWER - 1, BAND_UPPER + 1] += pw - pww * west - pc * near_west
    # line 1 gives to the symmetry line twice: itself and its image
    across = pn * north + (2.0 * ps if j == 1 else ps) * south
    around[BAND_LOWER, BAND_UPPER] += pc - pw * near_west - pe * near_east - across
    around[BAND_LOWER + 1, BAND_UPPER - 1] += pe - pc * near_east
    around[BAND_LOWER + 2, BAND_UPPER - 2] -= pe * east


@jit
def relax_line(j, start, stop, fields, rhs, stencil, c_t, near, work):
    """Solve nodes `start` to `stop` - 1 of line j for their distributed changes; ``fields.w`` written there.

    A node joins the solve if P > 0 or if its residual asks for pressure (complementarity). `work` is
    ``(films, band, b)`` of `line_work`.
    """
    P, flow, theta, w = fields.P, fields.flow, fields.theta, fields.w
    films, band, b = work
    responses(0, j, start, stop, theta, near, ALONG, films)
    for i in range(start, stop):
        r = i - start
        b[PAD + r] = rhs[j, i] - operator_at(j, i, P, flow, stencil, c_t)
        if P[j, i] > 0.0 or b[PAD + r] < 0.0:
            assemble_at(j, i, P, flow, theta, stencil, c_t, films, near, band, r)
        else:
            around = columns_around(band, r)
            for o in range(-BAND_LOWER, BAND_UPPER + 1):
                around[BAND_LOWER + o, BAND_UPPER - o] = 0.0
            around[BAND_LOWER, BAND_UPPER] = 1.0
            b[PAD + r] = 0.0
    m = stop - start
    solve_band(band, b, m)
    largest = LARGEST_CHANGE
    for r in range(m):
        H = fields.H[j, start + r]
        relative = LARGEST_CHANGE / FILM_CHANGE * near[0, 0] / H if H > 0.0 else 0.0
        largest = max(largest, abs(b[PAD + r]) * max(1.0, relative))
    for r in range(m):
        w[j, start + r] = LARGEST_CHANGE / largest * b[PAD + r]


@jit
def line_work(nodes):
    """Work arrays of `relax_line` for lines of so many nodes."""
    columns = nodes + 2 * PAD
    return np.zeros((columns, 2 * (ALONG + FILM_MARGIN) + 1)), np.zeros((columns, BAND)), np.zeros(columns)


@jit
def relax_lines(first, last, colour, fields, rhs, stencil, c_t, near):
    """`relax_line` for the whole lines ``colour + 2 k``, k from `first` to `last` - 1, which are independent."""
    nodes = fields.P.shape[1]
    work = line_work(nodes)
    for k in range(first, last):
        relax_line(colour + 2 * k, 1, nodes - 1, fields, rhs, stencil, c_t, near, work)


@jit_node
def change_at(j, i, colour, P, theta, w):
    """Change of P at one interior node by the distributed changes of the lines of one colour."""
    if P[j, i] <= 0.0:
        return w[j, i] if (j - colour) % 2 == 0 else 0.0
    if (j - colour) % 2 == 0:
        change = w[j, i]
        change -= SHARE * min(theta[j, i - 1], theta[j, i]) * w[j, i - 1]
        return change - SHARE * min(theta[j, i + 1], theta[j, i]) * w[j, i + 1]
    north = SHARE * min(theta[j, i], theta[j + 1, i]) * w[j + 1, i]
    if j == 0:
        return -2.0 * north  # line 1 and its image
    return -north - SHARE * min(theta[j, i], theta[j - 1, i]) * w[j - 1, i]


@jit
def apply_lines(first, last, colour, fields, near):
    """Add the distributed changes of one colour to P of lines `first` to `last` - 1, and to H of the other's.

    H is for the odd lines, which are solved after the even ones (colour 0); only near coefficients, and neighbour
    lines, count for it.
    """
    P, theta, w = fields.P, fields.theta, fields.w
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    films = np.zeros((nx + 1 + 2 * PAD, 2 * NEAR + 1))
    for j in range(first, last):
        for i in range(1, nx):
            P[j, i] = max(P[j, i] + change_at(j, i, colour, P, theta, w), 0.0)
        if colour == 0 and j % 2 == 1:
            for source in (j - 1, j + 1):
                if source < ny:
                    responses(j - source, source, 1, nx, theta, near, NEAR, films)
                    near_film(fields.H[j], w[source], films)


@jit
def near_film(H, w, films):
    """Add to a line `H` of film what the distributed changes `w` of a line cause there; `films` by `responses`."""
    nx = H.shape[0] - 1
    for i in range(1, nx):
        change = 0.0
        for k in range(max(i - NEAR, 1), min(i + NEAR, nx - 1) + 1):
            change += w[k] * films[PAD + k, NEAR + i - k]
        H[i] += change
