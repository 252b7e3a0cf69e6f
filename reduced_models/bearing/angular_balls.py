"""Balls at contact angles in static equilibrium, compiled: force of the inner ring with five degrees of freedom.

The ring has the displacement q = (x, y, z, tilt about x, tilt about y) of the point of its axis in the plane of
its groove centres; tilts are small. At the ball at psi it moves the inner groove centre (`contact_angles`) to

    c_r = c_r0 + x cos psi + y sin psi
    c_z = c_z0 + z + groove_circle (tilt_x sin psi - tilt_y cos psi),

and the ball goes where contact forces, centrifugal force and gyroscopic moment balance: two unknowns b, by
Newton's method with the exact tangent. Contacts act as springs between groove centres, whose distance grows as the
ball is compressed. Without inertia forces their energy is convex, so that Newton's method with a line search
converges; the forces of inertia disturb this little. The result is the force of the ring on
the ball as a function of c alone, with its condensed tangent, geometric terms Q/l included.
"""

from __future__ import annotations

from math import cos, nan, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.jit import inner, jit_exact, jit_exact_loop
from reduced_models.bearing.contact_angles import Grooves, ball_forces, film_factors, inner_span, rolling
from reduced_models.bearing.loss import Loss
from reduced_models.bearing.race_contact import curve, film_curve, film_cutoff
from reduced_models.bearing.race_table import RaceForceTable

_Floats = NDArray[np.float64]

BALANCED = 1e-13  # imbalance of a ball over its forces that ends the search: rounding
BALANCED_BY_ROUNDING = 1e-9  # accepted where steps no longer help
MOST_STEPS = 100  # of that search: a handful, but where a ball lifts off
FAR = 0.05  # longest step over the distance of the groove centres
LIGHT = 1e-3  # stiffness of the inner contact over that of the outer one, below which a ball follows the outer one
ROUGHLY = 0.1  # of the forces along a step, that are left at the end of a search along it
EPSILON = 2.0**-52
COMPLEX_STEP = 1e-30  # [m], of derivatives: nothing is subtracted, so it need not be large
FIRST_STEP = 1e-7  # [m], outward, of a ball that nothing touches; doubled until a race is met
FREEDOMS = 5

# Quantities of a ball: contact angles, forces, approaches, slopes of the force by the approach, film over that of
# the table, sum of the surface speeds over the speed of the shaft (inner and outer race each), orbit, own rotation
# and beta
ANGLE, LOAD, APPROACH, SLOPE, FILM, SPEED_SUM = 0, 2, 4, 6, 8, 10
ORBIT, OWN_ROTATION, AXIS_ANGLE, ENTRIES = 12, 13, 14, 15


class AngularBalls(NamedTuple):
    """A bearing, for balls at contact angles: at one speed, or in time at a range of them."""

    inner: RaceForceTable
    outer: RaceForceTable
    number: int
    grooves: Grooves
    omega: float  # of the shaft [rad/s], at rest: the first of `speeds`
    speeds: _Floats  # (rows of the tables,) of the shaft, increasing [rad/s]
    loss: Loss  # of rings and fits
    inertia: float  # of a ball towards the rings [kg]; 0: it has none
    heights: _Floats  # tables of features, see `contact_heights`


class BallPlaces(NamedTuple):
    """Where all balls are, and what they carry."""

    place: _Floats  # (balls, 2) b [m]; not a number before the first search
    found: _Floats  # (balls, ENTRIES), see above
    geometric: _Floats  # (balls, 5, 4) forces of `ball_forces` by b and c, at constant approaches
    condensed: _Floats  # (balls, 3, 2) force of the ring on the ball and its moment, by c
    force: _Floats  # (balls, 3) the same force and moment
    height: _Floats  # (balls, 2) of features at both contacts [m]


def places_of(balls: AngularBalls) -> BallPlaces:
    """Room for all balls, none of them placed."""
    n = balls.number
    return BallPlaces(
        np.full((n, 2), nan),
        np.zeros((n, ENTRIES)),
        np.zeros((n, 5, 4)),
        np.zeros((n, 3, 2)),
        np.zeros((n, 3)),
        np.zeros((n, 2)),
    )


@inner
@jit_exact
def static_contact(law, u, film):
    """Static force [N] at approach `u` [m], its slopes by u and by `film`, the film over that of the table."""
    g, by_u, by_film, _, _ = film_curve(u, (film, 0.0), 0, 0.0, law, 0)
    root = sqrt(g)
    share, share_u = film_cutoff(u, law.cutoff_gap)
    force, by_g = law.kn * g * root, share * 1.5 * law.kn * root
    return share * force, by_g * by_u + share_u * force, by_g * by_film


@jit_exact
def _press(balls, h, b_r, b_z, c_r, c_z):
    """A ball at a given place: its rolling, both contacts (approach, force, slopes), all forces.

    `h` are the heights that its contacts meet [m].
    """
    g = balls.grooves
    l_i, l_o = inner_span(b_r, b_z, c_r, c_z)[0], np.hypot(b_r, b_z)
    free_i, free_o = g.inner - h[0], g.outer - h[1]
    g_i, by_i, _ = curve(l_i - free_i, 0, 0.0, balls.inner, 0)
    g_o, by_o, _ = curve(l_o - free_o, 0, 0.0, balls.outer, 0)
    at = rolling(g, b_r, b_z, c_r, c_z, g_i, g_o)
    film_i, film_o = film_factors(g, at)
    inner = at.l_i - free_i, *static_contact(balls.inner, at.l_i - free_i, film_i)
    outer = at.l_o - free_o, *static_contact(balls.outer, at.l_o - free_o, film_o)
    return at, inner, outer, ball_forces(g, balls.omega, at, inner[1], outer[1]), (g_i, by_i, g_o, by_o)


@inner
@jit_exact
def _geometric(balls, b_r, b_z, c_r, c_z, now, out):
    """Derivatives of all forces by b and c, both contact forces following their film but not their approach."""
    g, h = balls.grooves, COMPLEX_STEP
    at, inner, outer, _, (g_i, by_i, g_o, by_o) = now
    film_i, film_o = film_factors(g, at)
    for j in range(4):
        r, z = complex(b_r, h if j == 0 else 0.0), complex(b_z, h if j == 1 else 0.0)
        far_r, far_z = complex(c_r, h if j == 2 else 0.0), complex(c_z, h if j == 3 else 0.0)
        l_i = inner_span(r, z, far_r, far_z)[0]
        l_o = np.sqrt(r * r + z * z)
        moved = rolling(g, r, z, far_r, far_z, g_i + by_i * (l_i - at.l_i), g_o + by_o * (l_o - at.l_o))
        moved_i, moved_o = film_factors(g, moved)
        q_i, q_o = inner[1] + inner[3] * (moved_i - film_i), outer[1] + outer[3] * (moved_o - film_o)
        forces = ball_forces(g, balls.omega, moved, q_i, q_o)
        for i in range(5):
            out[i, j] = forces[i].imag / h


@inner
@jit_exact
def _stretched(geometric, at, k_i, k_o, out):
    """All derivatives by b and c, with the stiffness of both contacts."""
    n_i, n_o = (at.cos_i, at.sin_i), (at.cos_o, at.sin_o)
    for i in range(out.shape[0]):  # not out[:] = ...: the message for shapes that differ takes seconds to compile
        for j in range(out.shape[1]):
            out[i, j] = geometric[i, j]
    for i in range(2):
        for j in range(2):
            inner, outer = k_i * n_i[i] * n_i[j], k_o * n_o[i] * n_o[j]
            out[i, j] -= inner + outer
            out[i, 2 + j] += inner
            out[2 + i, j] -= inner
            out[2 + i, 2 + j] += inner


@jit_exact
def _start(balls, c_r, c_z):
    """First place of a ball: on the line between the groove centres, dry contacts in balance where they touch."""
    g = balls.grooves
    length = np.hypot(c_r, c_z)
    closer = length - g.inner - g.outer
    ratio = (balls.outer.kn / balls.inner.kn) ** (2.0 / 3.0)
    outward = g.outer + closer / (1.0 + ratio)
    if closer < 0.0:
        centrifugal = balls.omega * 0.5 * balls.omega * 0.5 * g.mass * 0.5 * g.pitch
        outward = g.outer + (centrifugal / balls.outer.kn) ** (2.0 / 3.0) if balls.omega > 0.0 else outward
    return outward * c_r / length, outward * c_z / length


@inner
@jit_exact
def _convex_step(at, inner, outer, forces):
    """Newton's step with the springs alone, whose stiffness k n n^T + Q/l (1 - n n^T) is positive definite."""
    side_i, side_o = inner[1] / at.l_i, outer[1] / at.l_o
    k_i, k_o = inner[2] - side_i, outer[2] - side_o
    rr = k_i * at.cos_i * at.cos_i + k_o * at.cos_o * at.cos_o + side_i + side_o
    zz = k_i * at.sin_i * at.sin_i + k_o * at.sin_o * at.sin_o + side_i + side_o
    rz = k_i * at.cos_i * at.sin_i + k_o * at.cos_o * at.sin_o
    det = rr * zz - rz * rz
    if not det > 0.0:
        return forces[0] / (rr + zz), forces[1] / (rr + zz)
    return (zz * forces[0] - rz * forces[1]) / det, (rr * forces[1] - rz * forces[0]) / det


@inner
@jit_exact
def _moved(b_r, b_z, d_r, d_z, t, arc):
    """Place of a ball after a share t of the step `d` and the direction of the step there.

    On an `arc` the ball follows the outer groove: a straight step would press it into the groove, or lift it, by
    far more than what holds a ball that the inner ring has left.
    """
    if not arc:
        return b_r + t * d_r, b_z + t * d_z, d_r, d_z
    length = np.hypot(b_r, b_z)
    n_r, n_z = b_r / length, b_z / length
    out, aside = d_r * n_r + d_z * n_z, d_z * n_r - d_r * n_z
    c, s, reach = cos(t * aside / length), sin(t * aside / length), length + t * out
    n_r, n_z = c * n_r - s * n_z, s * n_r + c * n_z
    aside *= reach / length
    return reach * n_r, reach * n_z, out * n_r - aside * n_z, out * n_z + aside * n_r


@jit_exact
def _line_search(balls, h, b_r, b_z, d_r, d_z, c_r, c_z, slope, arc):
    """Share of the step `d` at which the forces along it balance, roughly; `slope` is their sum at its start."""
    low, high, t = 0.0, 1.0, 1.0
    for _ in range(MOST_STEPS):
        r, z, e_r, e_z = _moved(b_r, b_z, d_r, d_z, t, arc)
        forces = _press(balls, h, r, z, c_r, c_z)[3]
        along = forces[0] * e_r + forces[1] * e_z
        if abs(along) <= ROUGHLY * slope:
            break
        if along > 0.0:
            low = t
        else:
            high = t
        if low == 1.0:
            break
        t = 0.5 * (low + high)
    return t


@inner
@jit_exact
def _search(balls, h, b_r, b_z, c_r, c_z, geometric, full):
    """Place of a ball in balance from `b`, and whether it was found."""
    reach, nearest, kept_r, kept_z, idle = FIRST_STEP, np.inf, b_r, b_z, 0
    longest = FAR * (balls.grooves.inner + balls.grooves.outer)
    now = _press(balls, h, b_r, b_z, c_r, c_z)
    for _ in range(MOST_STEPS):
        at, inner, outer, forces, _ = now
        size, stiff = np.hypot(forces[0], forces[1]), inner[2] + outer[2]
        rounding = EPSILON * (at.l_i + at.l_o) * stiff
        scale = inner[1] + outer[1] + size
        if not (size < np.inf and 0.0 < at.orbit < 1.0):  # nothing rolls at such angles
            return b_r, b_z, False
        if size <= BALANCED * scale + rounding:
            return b_r, b_z, True
        # near the balance the last steps only exchange rounding errors
        near = size <= BALANCED_BY_ROUNDING * scale + 100.0 * rounding
        if size < 0.5 * nearest:
            nearest, kept_r, kept_z, idle = size, b_r, b_z, 0
        elif near:
            idle += 1
            if idle > 2:
                return kept_r, kept_z, True
        _geometric(balls, b_r, b_z, c_r, c_z, now, geometric)
        _stretched(geometric, at, inner[2], outer[2], full)
        det = full[0, 0] * full[1, 1] - full[0, 1] * full[1, 0]
        if stiff <= 0.0 or not abs(det) > 1e-14 * stiff * stiff:  # nothing touches it
            b_r, b_z = b_r + reach * forces[0] / size, b_z + reach * forces[1] / size
            reach *= 2.0
            now = _press(balls, h, b_r, b_z, c_r, c_z)
            continue
        d_r = -(full[1, 1] * forces[0] - full[0, 1] * forces[1]) / det
        d_z = -(full[0, 0] * forces[1] - full[1, 0] * forces[0]) / det
        if forces[0] * d_r + forces[1] * d_z <= 0.0:  # away from the balance
            d_r, d_z = _convex_step(at, inner, outer, forces)
        cut = min(1.0, longest / np.hypot(d_r, d_z))
        d_r, d_z = cut * d_r, cut * d_z
        arc = inner[2] < LIGHT * outer[2]
        new_r, new_z, _, _ = _moved(b_r, b_z, d_r, d_z, 1.0, arc)
        now = _press(balls, h, new_r, new_z, c_r, c_z)
        if not np.hypot(now[3][0], now[3][1]) < 0.5 * size and not near:
            slope = forces[0] * d_r + forces[1] * d_z
            t = _line_search(balls, h, b_r, b_z, d_r, d_z, c_r, c_z, slope, arc)
            new_r, new_z, _, _ = _moved(b_r, b_z, d_r, d_z, t, arc)
            now = _press(balls, h, new_r, new_z, c_r, c_z)
        b_r, b_z = new_r, new_z
    return b_r, b_z, False


@inner
@jit_exact
def _seat(balls, k, c_r, c_z, places, full):
    """Balance ball `k`: its force and tangents; not a number where it finds no balance."""
    g, geometric, condensed = balls.grooves, places.geometric[k], places.condensed[k]
    h = places.height[k, 0], places.height[k, 1]
    geometric[:], condensed[:], places.force[k] = 0.0, 0.0, 0.0
    reach = g.inner + g.outer - (h[0] + h[1])
    if balls.omega == 0.0 and np.hypot(c_r, c_z) <= reach:  # at rest between both races
        b_r, b_z = _start(balls, c_r, c_z)
        _note(balls, _press(balls, h, b_r, b_z, c_r, c_z), places.found[k])
        places.place[k, 0], places.place[k, 1] = b_r, b_z
        return
    b_r, b_z, done = places.place[k, 0], places.place[k, 1], False
    if np.isfinite(b_r):
        b_r, b_z, done = _search(balls, h, b_r, b_z, c_r, c_z, geometric, full)
    if not done:
        b_r, b_z = _start(balls, c_r, c_z)
        b_r, b_z, done = _search(balls, h, b_r, b_z, c_r, c_z, geometric, full)
    if not done:
        places.place[k], places.force[k] = nan, nan
        return
    places.place[k, 0], places.place[k, 1] = b_r, b_z
    now = _press(balls, h, b_r, b_z, c_r, c_z)
    _note(balls, now, places.found[k])
    _geometric(balls, b_r, b_z, c_r, c_z, now, geometric)
    _stretched(geometric, now[0], now[1][2], now[2][2], full)
    for i in range(3):
        places.force[k, i] = now[3][2 + i]
    det = full[0, 0] * full[1, 1] - full[0, 1] * full[1, 0]
    for i in range(3):
        for j in range(2):
            # by c, and by b = -(R_b)^-1 R_c
            at_r = (full[1, 1] * full[0, 2 + j] - full[0, 1] * full[1, 2 + j]) / det
            at_z = (full[0, 0] * full[1, 2 + j] - full[1, 0] * full[0, 2 + j]) / det
            condensed[i, j] = full[2 + i, 2 + j] - full[2 + i, 0] * at_r - full[2 + i, 1] * at_z


@jit_exact
def _note(balls, now, found):
    """Write down the quantities of a ball."""
    at, inner, outer, _, _ = now
    found[ANGLE], found[ANGLE + 1] = np.arctan2(at.sin_i, at.cos_i), np.arctan2(at.sin_o, at.cos_o)
    found[LOAD], found[LOAD + 1] = inner[1], outer[1]
    found[APPROACH], found[APPROACH + 1] = inner[0], outer[0]
    found[SLOPE], found[SLOPE + 1] = inner[2], outer[2]
    found[FILM], found[FILM + 1] = film_factors(balls.grooves, at)
    found[SPEED_SUM], found[SPEED_SUM + 1] = at.u_i, at.u_o
    found[ORBIT], found[OWN_ROTATION] = at.orbit, at.ball_rotation
    found[AXIS_ANGLE] = np.arctan2(at.sin_b, at.cos_b)


@jit_exact_loop
def ring_map(g, psi, out):
    """Rows by which the ring's displacement moves c_r and c_z, and its tilt follows a moment: (3, 5)."""
    c, s = cos(psi), sin(psi)
    out[:] = 0.0
    out[0, 0], out[0, 1] = c, s
    out[1, 2], out[1, 3], out[1, 4] = 1.0, g.groove_circle * s, -g.groove_circle * c
    out[2, 3], out[2, 4] = -s, c


@jit_exact
def press_ring(balls, angle, q, places, force, stiffness):
    """Forces and moments (5,) of the ring at `q` on all balls, the first at `angle` [rad], and their tangent.

    Not a number where a ball finds no balance.
    """
    g, rows, full = balls.grooves, np.zeros((3, FREEDOMS)), np.zeros((5, 4))
    force[:], stiffness[:] = 0.0, 0.0
    for k in range(balls.number):
        ring_map(g, angle + 2.0 * pi * k / balls.number, rows)
        c_r, c_z = g.radial, g.axial
        for j in range(FREEDOMS):
            c_r += rows[0, j] * q[j]
            c_z += rows[1, j] * q[j]
        _seat(balls, k, c_r, c_z, places, full)
        for i in range(FREEDOMS):
            for m in range(3):
                force[i] += rows[m, i] * places.force[k, m]
                for j in range(FREEDOMS):
                    by_c = places.condensed[k, m, 0] * rows[0, j] + places.condensed[k, m, 1] * rows[1, j]
                    stiffness[i, j] += rows[m, i] * by_c
