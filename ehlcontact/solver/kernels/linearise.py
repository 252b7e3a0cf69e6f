"""Derivatives of the discrete Reynolds operator; `reynolds.operator_at` is the operator itself.

``dN_k = sum_q p_coef[q, k] dP_q + sum_q h_coef[q, k] dH_q`` over the neighbours q of node k, numbered
C, W, E, S, N, WW. The elastic part ``dH = -du + K dP`` is left to the caller: transforms, dense or truncated.
"""

import numpy as np

from ehlcontact.jit import inner, jit, jit_loop, jit_node
from ehlcontact.lanes import at, where_positive

NEIGHBOURS = 6


@jit_loop
def neighbour(q, j, i):
    """Line and column of neighbour q of node (j, i); the line below the symmetry line is its image."""
    if q == 1:
        return j, i - 1
    if q == 2:
        return j, i + 1
    if q == 3:
        return (j - 1 if j > 0 else 1), i
    if q == 4:
        return j + 1, i
    if q == 5:
        return j, i - 2
    return j, i


@jit_node
def _face(flow, jq, iq, coupling, mean, skew, drop):
    """Flow from neighbour (jq, iq): coupling, derivatives to ln(eps) of the node, to P and H of the neighbour."""
    other = drop * coupling * (0.5 * mean - skew)
    a = coupling * mean
    own = drop * coupling * (0.5 * mean + skew)
    return a, own, a + other * at(flow.eps_slope, jq, iq), other * at(flow.film_slope, jq, iq)


@jit_node
def linearise_at(j, i, P, flow, stencil, c_t, share):
    """Derivatives at one interior node, or eight from the second on: six to P, then six to H.

    `share` is `flow_slope` of `linearise`.
    """
    js, face, side = (j - 1, j - 1, -1.0) if j > 0 else (1, 0, 1.0)  # the line below line 0 is its image
    p, cx, cy, inv_hx = at(P, j, i), stencil.cx, stencil.cy, stencil.inv_hx
    along, skew, across, slant = flow.along, flow.along_skew, flow.across, flow.across_skew
    west, east = share * (at(P, j, i - 1) - p), share * (at(P, j, i + 1) - p)
    south, north = share * (at(P, js, i) - p), share * (at(P, j + 1, i) - p)
    aw, dw, pw, hw = _face(flow, j, i - 1, cx, at(along, j, i - 1), -at(skew, j, i - 1), west)
    ae, de, pe, he = _face(flow, j, i + 1, cx, at(along, j, i), at(skew, j, i), east)
    as_, ds, ps, hs = _face(flow, js, i, cy, at(across, face, i), side * at(slant, face, i), south)
    an, dn, pn, hn = _face(flow, j + 1, i, cy, at(across, j, i), at(slant, j, i), north)
    # the wedge term of `reynolds.transport_at`, behind a closed face the flow out of the node alone
    if i > 1:
        face_open, c2 = at(flow.open, j, i - 1), inv_hx / 3.0
        c0 = where_positive(face_open, 0.5 * inv_hx, 5.0 / 6.0 * inv_hx)
        c1 = where_positive(face_open, -inv_hx, -inv_hx / 6.0)
        c5 = where_positive(face_open, inv_hx / 6.0, 0.0)
        pww, hww = -c5 * at(flow.mass_slope, j, i - 2), -c5 * at(flow.rho, j, i - 2)
    else:
        c0, c1, c2 = 0.0 * p, 0.0 * p - 0.5 * inv_hx, 0.5 * inv_hx  # of the type of P
        pww, hww = 0.0 * p, 0.0 * p
    c0 += c_t
    jumps = dw + de + ds + dn
    pc = jumps * at(flow.eps_slope, j, i) - (aw + ae + as_ + an) - c0 * at(flow.mass_slope, j, i)
    hc = jumps * at(flow.film_slope, j, i) - c0 * at(flow.rho, j, i)
    pw -= c1 * at(flow.mass_slope, j, i - 1)
    hw -= c1 * at(flow.rho, j, i - 1)
    pe -= c2 * at(flow.mass_slope, j, i + 1)
    he -= c2 * at(flow.rho, j, i + 1)
    return pc, pw, pe, ps, pn, pww, hc, hw, he, hs, hn, hww


@jit_loop
def linearise(P, flow, stencil, c_t, flow_slope, p_coef, h_coef):
    """Derivatives at all interior nodes; `p_coef` and `h_coef`, both (6, ny+1, nx+1), written.

    `flow_slope` is the share of the derivatives of the Poiseuille coefficient eps that is taken: 1 is Newton's
    linearisation, 0 takes eps as given (Picard).
    """
    for j in range(P.shape[0] - 1):
        for i in range(1, P.shape[1] - 1):
            derivatives = linearise_at(j, i, P, flow, stencil, c_t, flow_slope)
            for q in range(NEIGHBOURS):
                p_coef[q, j, i] = derivatives[q]
                h_coef[q, j, i] = derivatives[NEIGHBOURS + q]


@inner
@jit
def films_of_lines(kernel):
    """Film on line j by unit pressures on line l and its image, (ny + 1, ny, 2 nx + 1); the last by i - k + nx."""
    ny, nx = kernel.shape[0] // 2, kernel.shape[1] - 1
    films = np.empty((ny + 1, ny, 2 * nx + 1))
    for j in range(ny + 1):
        for line in range(ny):
            for lag in range(nx + 1):
                film = kernel[abs(j - line), lag]
                if line > 0:
                    film += kernel[j + line, lag]
                films[j, line, nx + lag] = film
                films[j, line, nx - lag] = film
    return films


@jit
def dense_jacobian(free, p_coef, h_coef, kernel, number, J):
    """Jacobian over the free interior nodes with full elasticity; `J` written, its column m is dN/du.

    `free` (m,) lists flat node numbers ``j (nx + 1) + i``, ascending; `kernel` holds the influence coefficients by
    lag; `number` is work space for one integer per node.

    Line by line, because the film by a line of pressures depends on distances along it only: sums over its nodes
    run through memory one after the other.
    """
    width = p_coef.shape[2]
    m, nx = free.shape[0], width - 1
    # Written out: array expressions, slices and rows take as long to compile as all the rest.
    lines, columns = np.empty(m, np.int64), np.empty(m, np.int64)
    for k in range(number.size):
        number[k] = -1
    for c in range(m):
        lines[c], columns[c] = free[c] // width, free[c] % width
        number[free[c]] = c
    films = films_of_lines(kernel)
    row = np.empty(width, J.dtype)
    for r in range(m):
        j, i = lines[r], columns[r]
        south = j - 1 if j > 0 else 1  # the line below the symmetry line is its image
        hc, hw, he = h_coef[0, j, i], h_coef[1, j, i], h_coef[2, j, i]
        hs, hn, hww = h_coef[3, j, i], h_coef[4, j, i], h_coef[5, j, i]
        begin = 0
        while begin < m:
            line, start = lines[begin], columns[begin]
            end = begin + 1
            while end < m and lines[end] == line:
                end += 1
            first = nx + start - i
            for k in range(columns[end - 1] - start + 1):
                at = first + k
                along = hc * films[j, line, at] + hw * films[j, line, at + 1] + he * films[j, line, at - 1]
                along += hww * films[j, line, at + 2]
                row[k] = along + hs * films[south, line, at] + hn * films[j + 1, line, at]
            for c in range(begin, end):
                J[r, c] = row[columns[c] - start]
            begin = end
        J[r, m] = -(hc + hw + he + hs + hn + hww)
        for q in range(NEIGHBOURS):
            jq, iq = neighbour(q, j, i)
            if iq >= 0 and number[jq * width + iq] >= 0:
                J[r, number[jq * width + iq]] += p_coef[q, j, i]
