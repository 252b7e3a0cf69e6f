"""The discrete Reynolds equation (eq. 1): Poiseuille coefficient, operator and residual.

Fields are (ny + 1, nx + 1) with ``P[j, i]``, i along X, j along Y >= 0, so that a line of relaxation is
contiguous. Line j = 0 is the symmetry line; j = ny, i = 0 and i = nx carry P = 0. The operator

    N(P, H) = d/dX(eps dP/dX) + kappa^2 d/dY(eps dP/dY) - d(rho H)/dX - c_t rho H,   eps = rho H^3/(eta lambda)

has eps averaged to half nodes (`flow_mean`), the wedge term third-order upstream-biased (two thirds central, one
third second-order upstream; central on the first line), and ``c_t rho H`` as the implicit part of the squeeze
term. After Venner and Lubrecht (2000), ch. 6, whose arithmetic mean and second-order upstream wedge leave an error
of the film ten to thirty times larger on the same grid.
"""

from typing import Any, NamedTuple

import numpy as np

from ehlcontact.elementary import exponential
from ehlcontact.jit import jit_loop, jit_node
from ehlcontact.lanes import LANES, at, eight, larger, put, root, where_positive
from ehlcontact.lubricant import density, heated, log_viscosity

FILM_FLOOR = 1e-8  # where iterates overlap; keeps eps > 0 without touching any converged film
TINY = 1e-290  # keeps 0/0 out where both Poiseuille coefficients underflow


class Stencil(NamedTuple):
    """Numbers of one grid that the kernels need."""

    cx: float  # 1/hx^2
    cy: float  # kappa^2/hy^2
    inv_hx: float  # U/hx: of the first derivative, which transport alone has
    lam: float  # Reynolds coefficient lambda
    speed: float  # U, of the surfaces over that of the operating point
    crowding: float  # 1, and more where nodes lie closer along X than the lines: half the ratio of their distances


class Flow(NamedTuple):
    """What the equations take from P and H, with derivatives: arrays (ny + 1, nx + 1) at nodes or half nodes.

    Half nodes carry the index of the node before them; the mean and skew of `flow_mean` are kept there,
    because roots and divisions are what an evaluation costs.
    """

    eps: Any  # Poiseuille coefficient
    eps_slope: Any  # d ln(eps)/dP at fixed H
    film_slope: Any  # d ln(eps)/dH
    mass: Any  # rho H
    mass_slope: Any  # d(rho H)/dP at fixed H
    rho: Any  # density
    along: Any  # mean of eps between i and i + 1
    along_skew: Any
    across: Any  # mean of eps between j and j + 1
    across_skew: Any
    # Between i and i + 1: 1, and before a front of full film, through which a given flow comes, 0 or, in steps in
    # time, less by the share of the flow pressed back that is felt behind it (`kernels.supply`)
    open: Any
    aside: Any  # between j and j + 1: viscosity along over that across, an input; 1 but in oil that sliding thins
    heat: Any  # of ln(eta) + 9.67: its relative change by temperature, an input; 0 at that of the inlet


def new_flow(shape: tuple[int, int]) -> Flow:
    """Return a `Flow` of zeros with all faces open."""
    flow = Flow(*(np.zeros(shape) for _ in Flow._fields))
    flow.open[...] = flow.aside[...] = 1.0
    return flow


@jit_node
def flow_mean(a, b):
    """Mean of two Poiseuille coefficients, which may differ by orders of magnitude, and its skew.

    The derivatives to ln(a) and ln(b) are ``mean/2 +- skew``. Along the inlet ln(eps) is nearly straight, so the
    value midway is the geometric mean; the arithmetic mean is too large by cosh(x), with 2x the log ratio, and is
    what makes the classical scheme need fine grids. But with the geometric mean the flow down a steep flank, P
    falling towards the outlet, stops answering to the upstream pressure (x > 1), and relaxation there never
    settles. The mean used is ``g (1 + s^2/(2 + s))`` with the geometric mean g and ``s = cosh(x) - 1``: geometric
    for neighbours that are alike (it differs by x^4/8), arithmetic for those far apart, and a flow that always
    falls with the downstream pressure and rises with the upstream one.
    """
    g = root(a * b) + TINY
    s = 0.5 * (a + b) / g - 1.0
    share = 1.0 / (2.0 + s)
    return g * (1.0 + s * s * share), 0.25 * (a - b) * s * (4.0 + s) * share * share


@jit_node
def update_node(j, i, P, H, law, stencil, flow):
    """What `flow` holds at one node, or eight."""
    p, film = at(P, j, i), at(H, j, i)
    rho, rho_slope = density(p, law)
    log_eta, log_eta_slope = heated(log_viscosity(p, law), at(flow.heat, j, i), law)
    h = larger(film, FILM_FLOOR)
    put(flow.eps, j, i, rho * h * h * h * exponential(-log_eta) / stencil.lam)
    put(flow.eps_slope, j, i, rho_slope / rho - log_eta_slope)
    put(flow.film_slope, j, i, 3.0 / h)
    put(flow.mass, j, i, rho * film)
    put(flow.mass_slope, j, i, rho_slope * film)
    put(flow.rho, j, i, rho)


@jit_node
def update_along(j, i, flow):
    """Mean and skew between nodes i and i + 1; of eight nodes likewise."""
    mean, skew = flow_mean(at(flow.eps, j, i), at(flow.eps, j, i + 1))
    felt = larger(at(flow.open, j, i), -at(flow.open, j, i))
    put(flow.along, j, i, felt * mean)
    put(flow.along_skew, j, i, felt * skew)


@jit_node
def update_across(j, i, flow):
    """Mean and skew between nodes j and j + 1; of eight nodes likewise."""
    mean, skew = flow_mean(at(flow.eps, j, i), at(flow.eps, j + 1, i))
    aside = at(flow.aside, j, i)
    put(flow.across, j, i, aside * mean)
    put(flow.across_skew, j, i, aside * skew)


@jit_loop
def update_lines(first, last, P, H, law, stencil, flow):
    """All of `flow` on lines `first` to `last` - 1."""
    nx = P.shape[1] - 1
    for j in range(first, last):
        for i in range(0, nx + 1, LANES):  # the last eight overlap those before
            update_node(j, eight(min(i, nx + 1 - LANES)), P, H, law, stencil, flow)
        for i in range(0, nx, LANES):
            update_along(j, eight(min(i, nx - LANES)), flow)


@jit_loop
def update_between_lines(first, last, flow):
    """Flow between lines `first` to `last` - 1 and the ones after them."""
    nodes = flow.eps.shape[1]
    for j in range(first, last):
        for i in range(0, nodes, LANES):
            update_across(j, eight(min(i, nodes - LANES)), flow)


@jit_loop
def update_flow(P, H, law, stencil, flow):
    """All of `flow` from P and H."""
    update_lines(0, P.shape[0], P, H, law, stencil, flow)
    update_between_lines(0, P.shape[0] - 1, flow)


@jit_node
def transport_at(j, i, mass, stencil, c_t):
    """``d(mass)/dX + c_t mass`` at one interior node, or eight from the second on."""
    east, own, west = at(mass, j, i + 1), at(mass, j, i), at(mass, j, i - 1)
    if i > 1:
        change = 2.0 * east + 3.0 * own - 6.0 * west + at(mass, j, i - 2)
    else:
        change = 3.0 * (east - west)
    return stencil.inv_hx / 6.0 * change + c_t * own


@jit_node
def given_flow(j, i, flow, stencil):
    """What a full film would carry through the face before a node, over its length, where that face is closed.

    There a given flow comes instead, part of the right-hand side (`kernels.supply`). Of one node, or eight.
    """
    own, west = at(flow.mass, j, i), at(flow.mass, j, i - 1)
    full = 2.0 * own + 5.0 * west
    if i > 1:  # the face before the first node is always open
        full = full - at(flow.mass, j, i - 2)
    return where_positive(at(flow.open, j, i - 1), 0.0, stencil.inv_hx / 6.0 * full)


@jit_node
def operator_at(j, i, P, flow, stencil, c_t):
    """N(P, H) at one interior node, or eight from the second on."""
    below, face = (j - 1, j - 1) if j > 0 else (1, 0)  # the line below the symmetry line is its image
    p = at(P, j, i)
    along = at(flow.along, j, i) * (at(P, j, i + 1) - p) + at(flow.along, j, i - 1) * (at(P, j, i - 1) - p)
    across = at(flow.across, j, i) * (at(P, j + 1, i) - p) + at(flow.across, face, i) * (at(P, below, i) - p)
    carried = transport_at(j, i, flow.mass, stencil, c_t)
    return stencil.cx * along + stencil.cy * across - carried - given_flow(j, i, flow, stencil)


@jit_loop
def residual_lines(first, last, P, flow, stencil, c_t, rhs, out):
    """`residual` on lines `first` to `last` - 1."""
    nx = P.shape[1] - 1
    for j in range(first, last):
        i = np.int64(1)  # with its type `operator_at` is compiled once for any i
        out[j, i] = rhs[j, i] - operator_at(j, i, P, flow, stencil, c_t)
        for k in range(2, nx, LANES):
            eight_nodes = eight(min(k, nx - LANES))
            put(out, j, eight_nodes, at(rhs, j, eight_nodes) - operator_at(j, eight_nodes, P, flow, stencil, c_t))


@jit_loop
def residual(P, flow, stencil, c_t, rhs, out):
    """``rhs - N(P, H)`` at all interior nodes; `out` written, its boundary left alone."""
    residual_lines(0, P.shape[0] - 1, P, flow, stencil, c_t, rhs, out)


@jit_loop
def transport(mass, stencil, c_t, known, out):
    """``d(mass)/dX + c_t mass + known`` at all interior nodes; `out` written, its boundary left alone."""
    for j in range(mass.shape[0] - 1):
        for i in range(1, mass.shape[1] - 1):
            out[j, i] = known[j, i] + transport_at(j, i, mass, stencil, c_t)
