"""Slow, obvious twins of the compiled kernels, written from the formulas and not from the code.

All of them work on the *whole* domain, both signs of Y, with plain loops; `mirrored` takes a half-domain field
there, so the symmetry line is checked too.
"""

from math import cosh, exp, inf, log, pi, sqrt

import numpy as np
from scipy.integrate import dblquad


def mirrored(half):
    """Field on Y = -y_max..y_max from the one on Y = 0..y_max; the symmetry line is row ny."""
    return np.concatenate([half[:0:-1], half])


def agm_integrals(kappa):
    """K and E of the parameter 1 - kappa^2 by the arithmetic-geometric mean (Gauss), for any kappa > 0."""
    a, g, c2 = 1.0, kappa, 1.0 - kappa**2
    total, power = 0.5 * c2, 0.5
    for _ in range(12):
        a, g, c = 0.5 * (a + g), sqrt(a * g), 0.5 * (a - g)
        power *= 2.0
        total += power * c * c
    K = pi / (2.0 * a)
    return K, K * (1.0 - total)


def hertz_si(load, radius_x, radius_y, e_reduced):
    """(a, b, p_h, approach) with kappa by bisection on Johnson's Rx/Ry = (K - E)/(E/kappa^2 - K)."""
    low, high = 1e-6, 1.0 - 1e-9
    assert radius_x < radius_y
    for _ in range(200):
        kappa = 0.5 * (low + high)
        K, E = agm_integrals(kappa)
        if (K - E) / (E / kappa**2 - K) > radius_x / radius_y:
            high = kappa
        else:
            low = kappa
    R = 1.0 / (1.0 / radius_x + 1.0 / radius_y)
    b = (6.0 * E * load * R / (pi * kappa**2 * e_reduced)) ** (1.0 / 3.0)
    a = kappa * b
    p = 1.5 * load / (pi * a * b)
    # Point load potential of the Hertz pressure at the centre: 2 p b kappa K/E' (half spaces of E'/2 together).
    return a, b, p, 2.0 * p * a * K / e_reduced


def viscosity(p, alpha, eta0, law):
    """Viscosity at pressure p [Pa]."""
    if law == "barus":
        return eta0 * exp(alpha * p)
    p0 = 1.96e8
    z = alpha * p0 / (log(eta0) + 9.67)
    return eta0 * exp((log(eta0) + 9.67) * ((1.0 + p / p0) ** z - 1.0))


def density(p, law):
    """Density ratio at pressure p [Pa]; Dowson and Higginson's 1 + 0.6e-9 p/(1 + 1.7e-9 p) as V&L round it."""
    return 1.0 if law == "incompressible" else (5.9e8 + 1.34 * p) / (5.9e8 + p)


def flow_and_mass(P, H, point):
    """eps = rho H^3/(eta lambda) and rho H, node by node, through SI pressures."""
    eps, mass = np.empty_like(P), np.empty_like(P)
    for k in np.ndindex(P.shape):
        p = P[k] * point.p_hertz
        rho = density(p, point.density)
        eta = viscosity(p, point.alpha, point.eta0, point.viscosity) / point.eta0
        eps[k] = rho * max(H[k], 1e-8) ** 3 / (eta * point.lam)
        mass[k] = rho * H[k]
    return eps, mass


def flow_mean(a, b):
    """Mean of two Poiseuille coefficients by cosh of half their log ratio."""
    x = 0.5 * log(a / b)
    s = cosh(x) - 1.0
    return sqrt(a * b) * (1.0 + 0.5 * s * s / (1.0 + 0.5 * s))


def operator(P, eps, mass, hx, hy, kappa, c_t):
    """N(P, H) of half-domain fields, at interior nodes; NaN on the border."""
    ny = P.shape[0] - 1
    P, eps, mass = mirrored(P), mirrored(eps), mirrored(mass)
    out = np.full(P.shape, np.nan)
    for j in range(1, P.shape[0] - 1):
        for i in range(1, P.shape[1] - 1):
            east = flow_mean(eps[j, i], eps[j, i + 1]) * (P[j, i + 1] - P[j, i]) / hx
            west = flow_mean(eps[j, i], eps[j, i - 1]) * (P[j, i] - P[j, i - 1]) / hx
            north = flow_mean(eps[j, i], eps[j + 1, i]) * (P[j + 1, i] - P[j, i]) / hy
            south = flow_mean(eps[j, i], eps[j - 1, i]) * (P[j, i] - P[j - 1, i]) / hy
            if i == 1:
                wedge = (mass[j, 2] - mass[j, 0]) / (2.0 * hx)
            else:
                central = (mass[j, i + 1] - mass[j, i - 1]) / (2.0 * hx)
                upstream = (3.0 * mass[j, i] - 4.0 * mass[j, i - 1] + mass[j, i - 2]) / (2.0 * hx)
                wedge = (2.0 * central + upstream) / 3.0
            squeeze = c_t * mass[j, i]
            out[j, i] = (east - west) / hx + kappa**2 * (north - south) / hy - wedge - squeeze
    return out[ny:]


def influence(x, y, hx, hy, kappa):
    """Deflection at distance (x, y) from unit pressure on one cell: Love's corner formula with logarithms."""

    def corner(s, t):
        r = sqrt(s * s + t * t)
        return s * log(t + r) + t * log(s + r)

    k = kappa * hx
    s = kappa * abs(x)
    K, _ = agm_integrals(kappa)
    total = 0.0
    for ds, sign_s in ((0.5 * k, 1.0), (-0.5 * k, -1.0)):
        for dt, sign_t in ((0.5 * hy, 1.0), (-0.5 * hy, -1.0)):
            total += sign_s * sign_t * corner(s + ds, abs(y) + dt)
    return total / (pi * K * kappa)


def influence_by_quadrature(x, y, hx, hy, kappa):
    """The same by numerical integration, for cells that do not hold their own singularity."""
    K, _ = agm_integrals(kappa)
    value, _ = dblquad(
        lambda t, s: 1.0 / sqrt(kappa**2 * (x - s) ** 2 + (y - t) ** 2),
        -0.5 * hx,
        0.5 * hx,
        -0.5 * hy,
        0.5 * hy,
        epsabs=1e-13,
    )
    return value / (pi * K)


def deflection(P, hx, hy, kappa):
    """Direct sum over all cells of both halves, shape of the half domain."""
    full = mirrored(P)
    rows, columns = full.shape
    table = np.array([[influence(i * hx, j * hy, hx, hy, kappa) for i in range(columns)] for j in range(rows)])
    ny = P.shape[0] - 1
    out = np.zeros_like(P)
    lag = np.abs(np.arange(columns)[:, None] - np.arange(columns)[None, :])
    for j in range(ny + 1):
        for source in range(rows):
            out[j] += table[abs(j + ny - source)][lag] @ full[source]
    return out


def full_weighting(fine, along=2, across=2):
    """Full weighting of a half-domain field to a mesh so many times as coarse, interior; NaN on the border."""
    ny = fine.shape[0] - 1
    full = mirrored(fine)
    halved, kept = np.array([0.25, 0.5, 0.25]), np.array([0.0, 1.0, 0.0])
    stencil = np.outer(halved if across == 2 else kept, halved if along == 2 else kept)
    coarse = np.full((ny // across + 1, (fine.shape[1] - 1) // along + 1), np.nan)
    for j in range(coarse.shape[0] - 1):
        for i in range(1, coarse.shape[1] - 1):
            row, column = ny + across * j, along * i
            coarse[j, i] = np.sum(stencil * full[row - 1 : row + 2, column - 1 : column + 2])
    return coarse


def bilinear(coarse, j, i, along=2, across=2):
    """Bilinear interpolation of a coarse field to fine node (j, i) of a mesh so many times as fine."""
    y, x = j / across, i / along
    j0, i0 = min(int(y), coarse.shape[0] - 2), min(int(x), coarse.shape[1] - 2)
    t, s = y - j0, x - i0
    return (1 - t) * ((1 - s) * coarse[j0, i0] + s * coarse[j0, i0 + 1]) + t * (
        (1 - s) * coarse[j0 + 1, i0] + s * coarse[j0 + 1, i0 + 1]
    )


def nodes_of_a_distributed_change(j, i, theta):
    """Nodes of the whole domain and their parts of a unit change at (j, i), j and `theta` of the whole domain too.

    A neighbour takes back a quarter of what both nodes' weights allow, the smaller one.
    """
    parts = {(j, i): 1.0}
    for node in ((j, i - 1), (j, i + 1), (j - 1, i), (j + 1, i)):
        parts[node] = -0.25 * min(theta[j, i], theta[node])
    return parts


def distribution_weight(eps, j, i, hx, hy, kappa, c_t):
    """Weight theta of one node: half where eps/h^2 towards its largest neighbour equals the switch."""
    below = eps[1, i] if j == 0 else eps[j - 1, i]
    along = max(flow_mean(eps[j, i], other) for other in (eps[j, i - 1], eps[j, i + 1])) / hx**2
    across = max(flow_mean(eps[j, i], other) for other in (below, eps[j + 1, i])) * kappa**2 / hy**2
    switch = 5.0 * max(1.0, 0.5 * hy / (kappa * hx)) * (1.0 + 10.0 * c_t * hx / 1.5)
    ratio = max(along, across) / switch
    return 1.0 / (1.0 + ratio**4)


def spring_root_and_tangent(k1, k2, k3):
    """Approach at which a cubic spring carries 1, nearest to 0.87, and the tangent there."""
    roots = [z.real for z in np.roots([k3, k2, k1, -1.0]) if abs(z.imag) < 1e-9]
    u = min(roots, key=lambda z: abs(z - 0.87), default=inf)
    return u, k1 + 2.0 * k2 * u + 3.0 * k3 * u * u


def hertz_gap_share(kappa):
    """S from the geometry: S = (R/Rx)(E/K) with 1/R = 1/Rx + 1/Ry."""
    K, E = agm_integrals(kappa)
    if kappa == 1.0:
        return 0.5
    ratio = (K - E) / (E / kappa**2 - K)  # Rx/Ry
    return E / K / (1.0 + ratio)
