"""Derivatives of the discrete Reynolds operator; `reynolds.operator_at` is the operator itself.

``dN_k = sum_q p_coef[q, k] dP_q + sum_q h_coef[q, k] dH_q`` over the neighbours q of node k, numbered
C, W, E, S, N, WW. The elastic part ``dH = -du + K dP`` is left to the caller: transforms, dense or truncated.
"""

from ehlcontact._kernels.jit import jit
from ehlcontact._kernels.laws import density, density_slope, log_viscosity_slope
from ehlcontact._kernels.mean import flow_mean_slopes
from ehlcontact._kernels.reynolds import FILM_FLOOR

NEIGHBOURS = 6


@jit
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


@jit
def linearise(P, H, eps, law, mesh, c_t, flow_slope, p_coef, h_coef):
    """Derivatives at all interior nodes; `p_coef` and `h_coef`, both (6, ny+1, nx+1), written.

    `flow_slope` is the share of the derivatives of the flow factor eps that is taken: 1 is Newton's
    linearisation, 0 takes eps as given (Picard).
    """
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    for j in range(ny):
        for i in range(1, nx):
            p = P[j, i]
            p_centre = 0.0
            jumps = 0.0
            for q in range(1, 5):
                coupling = mesh.cx if q < 3 else mesh.cy
                jq, iq = neighbour(q, j, i)
                own, other = flow_mean_slopes(eps[j, i], eps[jq, iq])
                a = coupling * (own + other)  # the mean is the sum of its slopes
                p_coef[q, j, i] = a
                p_centre -= a
                drop = flow_slope * coupling * (P[jq, iq] - p)
                jumps += drop * own
                p_coef[q, j, i] += drop * other * log_flow_slope(P[jq, iq], law)
                h_coef[q, j, i] = drop * other * 3.0 / max(H[jq, iq], FILM_FLOOR)
            p_centre += jumps * log_flow_slope(p, law)
            h_coef[0, j, i] = jumps * 3.0 / max(H[j, i], FILM_FLOOR)
            c0 = mesh.inv_hx * (0.5 if i > 1 else 0.0) + c_t
            c1 = mesh.inv_hx * (-1.0 if i > 1 else -0.5)
            c2 = mesh.inv_hx * (1.0 / 3.0 if i > 1 else 0.5)
            c5 = mesh.inv_hx / 6.0 if i > 1 else 0.0
            far = i - 2 if i > 1 else 0
            p_coef[0, j, i] = p_centre - c0 * density_slope(p, law) * H[j, i]
            h_coef[0, j, i] -= c0 * density(p, law)
            p_coef[1, j, i] -= c1 * density_slope(P[j, i - 1], law) * H[j, i - 1]
            h_coef[1, j, i] -= c1 * density(P[j, i - 1], law)
            p_coef[2, j, i] -= c2 * density_slope(P[j, i + 1], law) * H[j, i + 1]
            h_coef[2, j, i] -= c2 * density(P[j, i + 1], law)
            p_coef[5, j, i] = -c5 * density_slope(P[j, far], law) * H[j, far]
            h_coef[5, j, i] = -c5 * density(P[j, far], law)


@jit
def log_flow_slope(P, law):
    """D ln(eps)/dP at fixed H."""
    return density_slope(P, law) / density(P, law) - log_viscosity_slope(P, law)


@jit
def dense_jacobian(free, p_coef, h_coef, kernel, number, J):
    """Jacobian over the free interior nodes with full elasticity; `J` written, its column m is dN/du.

    `free` (m,) lists flat node numbers ``j (nx + 1) + i``; `kernel` holds the influence coefficients by lag;
    `number` is work space for one integer per node.
    """
    width = p_coef.shape[2]
    m = free.shape[0]
    number[:] = -1
    for c in range(m):
        number[free[c]] = c
    for r in range(m):
        j, i = free[r] // width, free[r] % width
        J[r, : m + 1] = 0.0
        for q in range(NEIGHBOURS):
            h = h_coef[q, j, i]
            p = p_coef[q, j, i]
            if h == 0.0 and p == 0.0:
                continue
            jq, iq = neighbour(q, j, i)
            J[r, m] -= h
            for c in range(m):
                jc, ic = free[c] // width, free[c] % width
                lag = abs(iq - ic)
                k = kernel[abs(jq - jc), lag]
                if jc > 0:  # the image at Y < 0
                    k += kernel[jq + jc, lag]
                J[r, c] += h * k
            if number[jq * width + iq] >= 0:
                J[r, number[jq * width + iq]] += p
