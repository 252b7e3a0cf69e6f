"""Places of balls from anywhere, compiled: where `ball.balance_ball` begins, and where it is lost."""

from __future__ import annotations

from math import cos, sin

import numpy as np

from ehlcontact.jit import inner, jit_exact_loop, jit_exact_node
from reduced_models.bearing.ball import (
    EPSILON,
    FAR,
    FIRST_STEP,
    PLACE_BEFORE,
    PLACE_NOW,
    SINGULAR,
    by_place,
    press_ball,
    renew_slopes,
)
from reduced_models.bearing.contact_heights import HEIGHT

BALANCED_ROUGHLY = 1e-9  # imbalance of a ball over its forces from which `balance_ball` goes on
MOST_STEPS = 100  # of the search at rest: a handful, but where a ball lifts off
LIGHT = 1e-3  # stiffness of the inner contact over that of the outer one, below which a ball follows the outer one
ROUGHLY = 0.1  # of the forces along a step, that are left at the end of a search along it
DOUBLED, HALVED = 40, 48  # steps of a search by bisection: to a bracket, and in it
BESIDE = (
    0.5  # rad, on either side of the line between the groove centres and of that across the shaft: of its angle
)


@jit_exact_node
def move_on(films, k):
    """Put ball `k` where it would be if it moved on as in the last step: where the search begins.

    It begins there however often a step is tried: a film that lets go pulls and pushes, so a ball may have several
    balances, and which one is found must not depend on where the ring was tried before.
    """
    for j in range(2):
        films.place[k, j] = 2.0 * films.kept[k, PLACE_NOW, j] - films.kept[k, PLACE_BEFORE, j]


@inner
@jit_exact_loop
def place_ball(balls, k, c, films):
    """First place of ball `k`: on the line between the groove centres, dry contacts in balance if they touch."""
    g, length = balls.grooves, np.hypot(c[0], c[1])
    free_i, free_o = g.inner - films.heights[2 * k, HEIGHT], g.outer - films.heights[2 * k + 1, HEIGHT]
    closer = length - free_i - free_o
    ratio = (balls.outer.kn / balls.inner.kn) ** (2.0 / 3.0)
    outward = free_o + closer / (1.0 + ratio)
    omega = films.omega[0]
    if closer < 0.0 and omega > 0.0:
        centrifugal = 0.125 * omega * omega * g.mass * g.pitch
        outward = free_o + (centrifugal / balls.outer.kn) ** (2.0 / 3.0)
    _put(films, k, c, outward * c[0] / length, outward * c[1] / length)


@jit_exact_node
def _put(films, k, c, b_r, b_z):
    films.place[k, 0], films.place[k, 1] = b_r, b_z
    films.follow[k] = 0.0
    for j in range(4):
        films.tried[k, j] = c[j]


@jit_exact_node
def _convex_step(now):
    """Newton's step with the springs alone, whose stiffness k n n^T + Q/l (1 - n n^T) is positive definite."""
    side_i, side_o = now.f_i * now.per_i, now.f_o * now.per_o
    k_i, k_o = now.k_i - side_i, now.k_o - side_o
    rr = k_i * now.i_r * now.i_r + k_o * now.o_r * now.o_r + side_i + side_o
    zz = k_i * now.i_z * now.i_z + k_o * now.o_z * now.o_z + side_i + side_o
    rz = k_i * now.i_r * now.i_z + k_o * now.o_r * now.o_z
    det = rr * zz - rz * rz
    if not det > 0.0:
        return now.r_r / (rr + zz), now.r_z / (rr + zz)
    return (zz * now.r_r - rz * now.r_z) / det, (rr * now.r_z - rz * now.r_r) / det


@jit_exact_node
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


@inner
@jit_exact_loop
def seek_ball(balls, omega, row, films, k, c):
    """Put ball `k` where its forces nearly balance at rest, searched from where it is; False where none is found.

    Newton's method with a search along each step. Contacts act as springs between groove centres, whose distance
    grows as the ball is compressed: without inertia forces their energy is convex, so that it converges; the
    forces of inertia disturb this little.
    """
    g, slopes = balls.grooves, films.slopes[k]
    b_r, b_z, reach = films.place[k, 0], films.place[k, 1], FIRST_STEP
    longest = FAR * (g.inner + g.outer)
    for _ in range(MOST_STEPS):
        now = press_ball(balls, omega, row, films, k, c, 0.0, b_r, b_z)
        size, stiff = np.hypot(now.r_r, now.r_z), now.k_i + now.k_o
        if not (size < np.inf and 0.0 < now.at.orbit < 1.0):  # nothing rolls at such angles
            return False
        rounding = EPSILON * (now.l_i + now.l_o) * stiff
        if size <= BALANCED_ROUGHLY * (now.f_i + now.f_o + size) + 100.0 * rounding:
            _put(films, k, c, b_r, b_z)
            return True
        renew_slopes(balls, omega, (b_r, b_z), c, (0.0, 0.0), (now.film_i, now.film_o), slopes)
        _, _, _, _, by, det, _ = by_place(now, slopes, 0.0, 0.0)
        if stiff <= 0.0 or not abs(det) > SINGULAR * stiff * stiff:  # nothing touches it
            b_r, b_z = b_r + reach * now.r_r / size, b_z + reach * now.r_z / size
            reach *= 2.0
            continue
        d_r, d_z = (by[1] * now.r_z - by[3] * now.r_r) / det, (by[2] * now.r_r - by[0] * now.r_z) / det
        if now.r_r * d_r + now.r_z * d_z <= 0.0:  # away from the balance
            d_r, d_z = _convex_step(now)
        cut = min(1.0, longest / np.hypot(d_r, d_z))
        d_r, d_z, arc, t = cut * d_r, cut * d_z, now.k_i < LIGHT * now.k_o, 1.0
        slope, low, high = now.r_r * d_r + now.r_z * d_z, 0.0, 1.0
        for _ in range(MOST_STEPS):  # to where the forces along the step balance, roughly
            new_r, new_z, e_r, e_z = _moved(b_r, b_z, d_r, d_z, t, arc)
            now = press_ball(balls, omega, row, films, k, c, 0.0, new_r, new_z)
            along = now.r_r * e_r + now.r_z * e_z
            if (t == 1.0 and np.hypot(now.r_r, now.r_z) < 0.5 * size) or abs(along) <= ROUGHLY * slope:
                break
            if along > 0.0:
                low = t
            else:
                high = t
            if low == 1.0:
                break
            t = 0.5 * (low + high)
        b_r, b_z = new_r, new_z
    return False


@inner
@jit_exact_loop
def search_ball(balls, omega, row, films, k, c, gain):
    """Place of ball `k` by bisection, for one that Newton's method loses between the races.

    In a pit or beside it nothing but the centrifugal force may act on a ball, which is constant: the imbalance has
    no slope that leads to the far race. Towards the outer race it falls, and so do, at one distance from the outer
    groove centre, the forces across with the angle: the angle is bisected for every distance.
    """
    far = np.arctan2(c[1], c[0])
    low, high = balls.grooves.outer, balls.grooves.outer
    reach = FIRST_STEP
    for side in range(2):  # first towards the groove centre, then away from it
        for _ in range(DOUBLED):
            length = low if side == 0 else high
            along = _along(balls, omega, row, films, k, c, gain, length, far)[0]
            if (side == 0 and along >= 0.0) or (side == 1 and along <= 0.0):
                break
            reach *= 2.0
            if side == 0:
                low = max(low - reach, 0.5 * low)
            else:
                high += reach
        reach = FIRST_STEP
    angle = far
    for _ in range(HALVED):
        middle = 0.5 * (low + high)
        along, angle = _along(balls, omega, row, films, k, c, gain, middle, far)
        if along > 0.0:
            low = middle
        else:
            high = middle
    _put(films, k, c, 0.5 * (low + high) * cos(angle), 0.5 * (low + high) * sin(angle))


@inner
@jit_exact_loop
def _along(balls, omega, row, films, k, c, gain, length, far):
    """Force on ball `k` away from the outer groove centre, `length` from it, where none is across; its angle."""
    low, high, angle, r, z = min(far, 0.0) - BESIDE, max(far, 0.0) + BESIDE, far, 0.0, 0.0
    for _ in range(HALVED):
        now = press_ball(balls, omega, row, films, k, c, gain, length * cos(angle), length * sin(angle))
        r, z = now.r_r, now.r_z
        across = z * cos(angle) - r * sin(angle)
        if across == 0.0:  # exactly, of balls between grooves in one plane, which stay in it
            break
        if across > 0.0:
            low = angle
        else:
            high = angle
        angle = 0.5 * (low + high)
    return r * cos(angle) + z * sin(angle), angle
