"""Hybrid line relaxation: one unknown line along X at a time, even lines first, then odd lines.

The change of pressure is written as ``dP = w - theta (mean of w over the four neighbours)``. Where flow
through the gap dominates, theta = 0 and this is Gauss-Seidel in P; where the oil is stiff and mere transport
is left, theta = 1: the deflection of such a distributed change decays like 1/r^3 instead of 1/r, so a few
near coefficients stand for all (distributive Jacobi; Venner and Lubrecht 2000, ch. 6). theta is a *smooth*
function of the local ratio of both terms: a hard switch flips to and fro from sweep to sweep and leaves a
limit cycle along the switch line.

The flow factor eps falls by orders of magnitude from one node to the next on the flanks of the pressure. Taken
as given, single nodes there never settle; with its full derivatives they overshoot. Three quarters of them
serve everywhere.
"""

from ehlcontact.jit import jit, jit_node
from ehlcontact.solver.kernels.linearise import linearise_at
from ehlcontact.solver.kernels.reynolds import operator_at, update_flow

BAND_LOWER, BAND_UPPER = 4, 3  # WW neighbour with two near coefficients upstream; E with two downstream
PAD = max(BAND_LOWER, BAND_UPPER)
NEAR = 2  # near influence coefficients kept on either side
SHARE = 0.25  # part of a distributed change that each neighbour takes back
SWITCH = 3.0  # eps/hx^2 at which theta = 1/2 in steady flow (Venner and Lubrecht's hard switch: 0.3),
# for meshes up to twice as fine along X as along Y, physically; in proportion more for finer ones
CAUTIOUS_SWITCH, CAUTIOUS_DAMPING = 5.0, 0.3  # where eps/hx^2 is near the switch all over the contact, as in very
# thin films of isoviscous oil: factor of the switch, and share by which distributed changes are cut
SQUEEZE = 10.0  # how much more the squeeze term raises it than the wedge term
FLOW_SLOPE = 0.75  # share of the derivatives of eps; see above
LARGEST_CHANGE = 0.15  # of P in one sweep; far from the solution the linear model overshoots


@jit
def distribution_weights(P, flow, stencil, c_t, theta):
    """Weight theta of the distributed change at every interior node; 0 where P = 0. `theta` written.

    The squeeze term, unlike the wedge term, does not vanish for smooth changes. Plain changes of P, whose
    smooth part deflects the film far beyond the near coefficients, are then safe only at larger eps.
    """
    switch = stencil.switch * (1.0 + SQUEEZE * c_t / (1.5 * stencil.inv_hx))
    for j in range(P.shape[0] - 1):
        face = j - 1 if j > 0 else 0
        for i in range(1, P.shape[1] - 1):
            along = stencil.cx * max(flow.along[j, i - 1], flow.along[j, i])
            across = stencil.cy * max(flow.across[face, i], flow.across[j, i])
            ratio = max(along, across) / switch
            theta[j, i] = 1.0 / (1.0 + ratio * ratio * ratio * ratio) if P[j, i] > 0.0 else 0.0


@jit
def solve_band(band, b, m):
    """Solve the banded system in place; no pivoting, the leading part being upstream-triangular.

    ``band[BAND_LOWER + o, r]`` couples row r to row r + o. Both arrays have `PAD` columns beyond m, so that the
    inner loops need no limits.
    """
    band[:, m:] = 0.0
    b[m:] = 0.0
    for r in range(m):
        pivot = 1.0 / band[BAND_LOWER, r]
        band[BAND_LOWER, r] = pivot
        for s in range(1, BAND_LOWER + 1):
            factor = band[BAND_LOWER - s, r + s] * pivot
            for c in range(1, BAND_UPPER + 1):
                band[BAND_LOWER - s + c, r + s] -= factor * band[BAND_LOWER + c, r]
            b[r + s] -= factor * b[r]
    for r in range(m - 1, -1, -1):
        value = b[r]
        for c in range(1, BAND_UPPER + 1):
            value -= band[BAND_LOWER + c, r] * b[r + c]
        b[r] = value * band[BAND_LOWER, r]


@jit_node
def assemble_at(j, i, P, flow, theta, stencil, c_t, near, spread, band):
    """Row of one node in the matrix of the distributed changes of line j; column ``i - 1`` of `band` written.

    A unit change at node k of the line raises P there by 1 and lowers its neighbours by SHARE theta_k, and
    deflects the film near it by ``near - theta_k spread``. So every entry is ``a - theta_k d``: `a` answers a
    plain change, `d` what a distributed one gives away.
    """
    pc, pw, pe, ps, pn, pww, hc, hw, he, _, _, hww = linearise_at(j, i, P, flow, stencil, c_t, FLOW_SLOPE)
    n0, n1, n2 = near[0, 0], near[0, 1], near[0, 2]
    s0, s1, s2 = spread[0, 0], spread[0, 1], spread[0, 2]
    across = pn + (2.0 * ps if j == 1 else ps)  # line 1 gives to the symmetry line twice: itself and its image
    r, last = i - 1, P.shape[1] - 1
    d = hww * s2
    band[0, r] = hww * n2 - theta[j, max(i - 4, 0)] * d
    d = hww * s1 + hw * s2 + SHARE * pww
    band[1, r] = hww * n1 + hw * n2 - theta[j, max(i - 3, 0)] * d
    d = hww * s0 + hw * s1 + hc * s2 + SHARE * pw
    band[2, r] = pww + hww * n0 + hw * n1 + hc * n2 - theta[j, max(i - 2, 0)] * d
    d = hww * s1 + hw * s0 + hc * s1 + he * s2 + SHARE * (pww + pc)
    band[3, r] = pw + hww * n1 + hw * n0 + hc * n1 + he * n2 - theta[j, i - 1] * d
    d = hww * s2 + hw * s1 + hc * s0 + he * s1 + SHARE * (pw + pe + across)
    band[4, r] = pc + hww * n2 + hw * n1 + hc * n0 + he * n1 - theta[j, i] * d
    d = hw * s2 + hc * s1 + he * s0 + SHARE * pc
    band[5, r] = pe + hw * n2 + hc * n1 + he * n0 - theta[j, i + 1] * d
    d = hc * s2 + he * s1 + SHARE * pe
    band[6, r] = hc * n2 + he * n1 - theta[j, min(i + 2, last)] * d
    band[7, r] = he * n2 - theta[j, min(i + 3, last)] * (he * s2)


@jit
def relax_line(j, fields, rhs, stencil, c_t, near, spread):
    """Solve line j for its distributed changes; ``fields.w[j]`` written.

    ``near[dj, di]`` are the influence coefficients and ``spread[dj, di]`` their mean over the four neighbours.
    A node joins the solve if P > 0 or if its residual asks for pressure (complementarity).
    """
    P, flow, band, b = fields.P, fields.flow, fields.band, fields.b
    m = P.shape[1] - 2
    for r in range(m):
        b[r] = rhs[j, r + 1] - operator_at(j, r + 1, P, flow, stencil, c_t)
        if P[j, r + 1] > 0.0 or b[r] < 0.0:
            assemble_at(j, r + 1, P, flow, fields.theta, stencil, c_t, near, spread, band)
        else:
            band[:, r] = 0.0
            band[BAND_LOWER, r] = 1.0
            b[r] = 0.0
    solve_band(band, b, m)
    for r in range(m):
        change = (1.0 - stencil.damping * fields.theta[j, r + 1]) * b[r]
        fields.w[j, r + 1] = min(max(change, -LARGEST_CHANGE), LARGEST_CHANGE)


@jit
def apply_line(j, P, theta, w):
    """Add line j's distributed changes to `P`; neighbours without pressure take no share."""
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    for i in range(1, nx):
        change = w[j, i]
        P[j, i] += change
        share = SHARE * theta[j, i] * change
        if share != 0.0:
            if P[j, i - 1] > 0.0:
                P[j, i - 1] -= share
            if P[j, i + 1] > 0.0:
                P[j, i + 1] -= share
            if j + 1 < ny and P[j + 1, i] > 0.0:
                P[j + 1, i] -= share
            if j > 0 and P[j - 1, i] > 0.0:
                P[j - 1, i] -= share if j > 1 else 2.0 * share  # the image line j = -1 gives as much


@jit
def near_film(j, H, theta, w, near, spread):
    """Add to line j of `H` the near deflection caused by both neighbour lines, whose ends have w = 0."""
    nx = H.shape[1] - 1
    for i in range(1, nx):
        change = 0.0
        for d in range(-NEAR, NEAR + 1):
            k = min(max(i + d, 0), nx)
            plain = w[j - 1, k] + w[j + 1, k]
            given = theta[j - 1, k] * w[j - 1, k] + theta[j + 1, k] * w[j + 1, k]
            change += near[1, abs(d)] * plain - spread[1, abs(d)] * given
        H[j, i] += change


@jit
def relax_lines(fields, rhs, law, stencil, c_t, near, spread):
    """One sweep over all lines, from the flow of P and H; P, H (near field only) and flow of `fields` written.

    The flow is that of the state between the colours then.
    """
    P, H, flow = fields.P, fields.H, fields.flow
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    for colour in range(2):
        if colour == 0:
            distribution_weights(P, flow, stencil, c_t, fields.theta)
        else:
            update_flow(P, H, law, stencil, flow)
        for j in range(colour, ny, 2):
            relax_line(j, fields, rhs, stencil, c_t, near, spread)
        for j in range(colour, ny, 2):
            apply_line(j, P, fields.theta, fields.w)
        for j in range(ny):
            for i in range(1, nx):
                P[j, i] = max(P[j, i], 0.0)
        if colour == 0:
            for j in range(1, ny, 2):
                near_film(j, H, fields.theta, fields.w, near, spread)
