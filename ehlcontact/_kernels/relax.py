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

from ehlcontact._kernels.jit import jit
from ehlcontact._kernels.linearise import NEIGHBOURS, linearise, neighbour
from ehlcontact._kernels.mean import flow_mean
from ehlcontact._kernels.reynolds import operator_at, update_flow

BAND_LOWER, BAND_UPPER = 4, 3  # WW neighbour with two near coefficients upstream; E with two downstream
NEAR = 2  # near influence coefficients kept on either side
SHARE = 0.25  # part of a distributed change that each neighbour takes back
SWITCH = 3.0  # eps/hx^2 at which theta = 1/2 in steady flow (Venner and Lubrecht's hard switch: 0.3),
# for meshes up to twice as fine along X as along Y, physically; in proportion more for finer ones
SQUEEZE = 10.0  # how much more the squeeze term raises it than the wedge term
FLOW_SLOPE = 0.75  # share of the derivatives of eps; see below
LARGEST_CHANGE = 0.15  # of P in one sweep; far from the solution the linear model overshoots


@jit
def distribution_weights(P, eps, mesh, c_t, theta):
    """Weight theta of the distributed change at every interior node; 0 where P = 0. `theta` written.

    The squeeze term, unlike the wedge term, does not vanish for smooth changes. Plain changes of P, whose
    smooth part deflects the film far beyond the near coefficients, are then safe only at larger eps.
    """
    switch = mesh.switch * (1.0 + SQUEEZE * c_t / (1.5 * mesh.inv_hx))
    for j in range(P.shape[0] - 1):
        js = j - 1 if j > 0 else 1
        for i in range(1, P.shape[1] - 1):
            e = eps[j, i]
            along = mesh.cx * flow_mean(e, max(eps[j, i - 1], eps[j, i + 1]))
            across = mesh.cy * flow_mean(e, max(eps[js, i], eps[j + 1, i]))
            ratio = max(along, across) / switch
            theta[j, i] = 1.0 / (1.0 + ratio**4) if P[j, i] > 0.0 else 0.0


@jit
def solve_band(band, b, m):
    """Solve the banded system in place; no pivoting, the leading part being upstream-triangular."""
    for r in range(m):
        pivot = 1.0 / band[r, BAND_LOWER]
        for s in range(1, min(BAND_LOWER, m - 1 - r) + 1):
            factor = band[r + s, BAND_LOWER - s] * pivot
            if factor != 0.0:
                for c in range(1, BAND_UPPER + 1):
                    band[r + s, BAND_LOWER - s + c] -= factor * band[r, BAND_LOWER + c]
                b[r + s] -= factor * b[r]
    for r in range(m - 1, -1, -1):
        value = b[r]
        for c in range(1, min(BAND_UPPER, m - 1 - r) + 1):
            value -= band[r, BAND_LOWER + c] * b[r + c]
        b[r] = value / band[r, BAND_LOWER]


@jit
def relax_line(j, fields, rhs, mesh, c_t, near, spread):
    """Solve line j for its distributed changes; ``fields.w[j]`` written.

    ``near[dj, di]`` are the influence coefficients and ``spread[dj, di]`` their mean over the four neighbours.
    A node joins the solve if P > 0 or if its residual asks for pressure (complementarity).
    """
    P, eps, mass, theta = fields.P, fields.eps, fields.mass, fields.theta
    band, b = fields.band, fields.b
    nx = P.shape[1] - 1
    m = nx - 1
    for r in range(m):
        i = r + 1
        band[r, :] = 0.0
        res = rhs[j, i] - operator_at(j, i, P, eps, mass, mesh, c_t)
        if P[j, i] <= 0.0 and res >= 0.0:
            band[r, BAND_LOWER] = 1.0
            b[r] = 0.0
            continue
        b[r] = res
        for q in range(NEIGHBOURS):
            jq, iq = neighbour(q, j, i)
            c = BAND_LOWER + iq - i
            in_line = jq == j
            a = fields.p_coef[q, j, i]
            if in_line:
                band[r, c] += a
                if iq - 1 >= 1:
                    band[r, c - 1] -= a * SHARE * theta[j, iq - 1]
                if iq + 1 < nx:
                    band[r, c + 1] -= a * SHARE * theta[j, iq + 1]
            else:
                # line 1 gives to the symmetry line twice, itself and through its image
                band[r, c] -= a * SHARE * theta[j, i] * (2.0 if j == 1 and jq == 0 else 1.0)
            a = fields.h_coef[q, j, i]
            if a != 0.0 and in_line:
                for d in range(max(-NEAR, 1 - iq), min(NEAR, nx - 1 - iq) + 1):
                    band[r, c + d] += a * (near[0, abs(d)] - theta[j, iq + d] * spread[0, abs(d)])
    for r in range(BAND_LOWER):  # entries that point off the line
        band[r, : BAND_LOWER - r] = 0.0
    for r in range(m - BAND_UPPER, m):
        band[r, BAND_LOWER + m - r :] = 0.0
    solve_band(band, b, m)
    for r in range(m):
        fields.w[j, r + 1] = min(max(b[r], -LARGEST_CHANGE), LARGEST_CHANGE)


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
    """Add to line j of `H` the near part of the deflection caused by both neighbour lines."""
    nx = H.shape[1] - 1
    for i in range(1, nx):
        change = 0.0
        for jj in (j - 1, j + 1):
            for d in range(max(-NEAR, 1 - i), min(NEAR, nx - 1 - i) + 1):
                change += w[jj, i + d] * (near[1, abs(d)] - theta[jj, i + d] * spread[1, abs(d)])
        H[j, i] += change


@jit
def relax_lines(fields, rhs, law, mesh, c_t, near, spread):
    """One sweep over all lines; P, H (near field only), eps and mass of `fields` written."""
    P, H = fields.P, fields.H
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    for colour in range(2):
        update_flow(P, H, law, mesh, fields.eps, fields.mass)
        if colour == 0:
            distribution_weights(P, fields.eps, mesh, c_t, fields.theta)
        linearise(P, H, fields.eps, law, mesh, c_t, FLOW_SLOPE, fields.p_coef, fields.h_coef)
        for j in range(colour, ny, 2):
            relax_line(j, fields, rhs, mesh, c_t, near, spread)
        for j in range(colour, ny, 2):
            apply_line(j, P, fields.theta, fields.w)
        for j in range(ny):
            for i in range(1, nx):
                P[j, i] = max(P[j, i], 0.0)
        if colour == 0:
            for j in range(1, ny, 2):
                near_film(j, H, fields.theta, fields.w, near, spread)
    update_flow(P, H, law, mesh, fields.eps, fields.mass)
