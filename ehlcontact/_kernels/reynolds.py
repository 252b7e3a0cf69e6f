"""The discrete Reynolds equation (eq. 1): flow factor, operator and residual.

Fields are (ny + 1, nx + 1) with ``P[j, i]``, i along X, j along Y >= 0, so that a line of relaxation is
contiguous. Line j = 0 is the symmetry line; j = ny, i = 0 and i = nx carry P = 0. The operator

    N(P, H) = d/dX(eps dP/dX) + kappa^2 d/dY(eps dP/dY) - d(rho H)/dX - c_t rho H,   eps = rho H^3/(eta lambda)

has eps averaged to half nodes (`mean`), the wedge term third-order upstream-biased (two thirds central, one third
second-order upstream; central on the first line), and ``c_t rho H`` as the implicit part of the squeeze term.
After Venner and Lubrecht (2000), ch. 6, whose arithmetic mean and second-order upstream wedge leave an error of
the film ten to thirty times larger on the same grid.
"""

import math
from typing import NamedTuple

from ehlcontact._kernels.jit import jit
from ehlcontact._kernels.laws import density, log_viscosity
from ehlcontact._kernels.mean import flow_mean

FILM_FLOOR = 1e-8  # where iterates overlap; keeps eps > 0 without touching any converged film


class Mesh(NamedTuple):
    """Numbers of one grid that the kernels need."""

    cx: float  # 1/hx^2
    cy: float  # kappa^2/hy^2
    inv_hx: float  # 1/hx
    lam: float  # Reynolds coefficient lambda
    switch: float  # eps/hx^2 at which both relaxations have equal parts, in steady flow


@jit
def update_flow(P, H, law, mesh, eps, mass):
    """Flow factor `eps` and mass content `mass` = rho H of all nodes, both written."""
    for j in range(P.shape[0]):
        for i in range(P.shape[1]):
            rho = density(P[j, i], law)
            h = max(H[j, i], FILM_FLOOR)
            eps[j, i] = rho * h * h * h * math.exp(-log_viscosity(P[j, i], law)) / mesh.lam
            mass[j, i] = rho * H[j, i]


@jit
def operator_at(j, i, P, eps, mass, mesh, c_t):
    """N(P, H) at one interior node."""
    js = j - 1 if j > 0 else 1
    e = eps[j, i]
    p = P[j, i]
    east, west = flow_mean(e, eps[j, i + 1]), flow_mean(e, eps[j, i - 1])
    north, south = flow_mean(e, eps[j + 1, i]), flow_mean(e, eps[js, i])
    along = east * (P[j, i + 1] - p) + west * (P[j, i - 1] - p)
    across = north * (P[j + 1, i] - p) + south * (P[js, i] - p)
    if i > 1:
        change = 2.0 * mass[j, i + 1] + 3.0 * mass[j, i] - 6.0 * mass[j, i - 1] + mass[j, i - 2]
    else:
        change = 3.0 * (mass[j, i + 1] - mass[j, i - 1])
    return mesh.cx * along + mesh.cy * across - mesh.inv_hx / 6.0 * change - c_t * mass[j, i]


@jit
def residual(P, eps, mass, mesh, c_t, rhs, out):
    """``rhs - N(P, H)`` at all interior nodes; `out` written, its boundary left alone."""
    for j in range(P.shape[0] - 1):
        for i in range(1, P.shape[1] - 1):
            out[j, i] = rhs[j, i] - operator_at(j, i, P, eps, mass, mesh, c_t)
