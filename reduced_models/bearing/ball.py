"""One ball between two races, compiled: the balance of its forces with exact tangents, in time steps and at rest.

The ring has the displacement q = (x, y, z, tilt about x, tilt about y) of the point of its axis in the plane of
its groove centres; tilts are small. At the ball at psi it moves the inner groove centre (`contact_angles`) to

    c_r = c_r0 + x cos psi + y sin psi
    c_z = c_z0 + z + groove_circle (tilt_x sin psi - tilt_y cos psi).

Contacts have their film memory (`race_contact`). With the inner groove centre at c, moving at c', and the ball at
b,

    u_i = |c - b| - inner,    u_i' = n_i . (c' - b'),    u_o = |b| - outer,    u_o' = n_o . b',

the ball goes where the forces R of both contacts, centrifugal force, gyroscopic moment and, of a ball with inertia
m towards the rings, m b'' balance: two unknowns b, by Newton's method. In a step b' follows from the places of the
last steps, and b'' from its rates (BDF 2). Without m that leaves out the vibration of a ball on its two contacts
(30 to 40 kHz for a 6205). At rest, with a gain of 0 from places to rates, the balance is the static law.

Films follow the angles of their ball, their thickness over that of the table and their time scale. At rest they
are those of the place; in a step, where they change slowly, they are extrapolated from the last two steps.
Centrifugal force and gyroscopic moment are those of the place; their derivatives, of little weight in the
tangents, are renewed after some steps, and at rest, those of the films with them, at every place.
"""

from __future__ import annotations

from math import cos, nan, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.jit import inner, jit_exact_loop, jit_exact_node
from reduced_models.bearing.contact_angles import (
    INNER,
    SHARED,
    Grooves,
    Rolling,
    ball_forces,
    film_factors,
    inner_span,
    rolling,
)
from reduced_models.bearing.contact_heights import FILM_SLOPE, HEIGHT, HEIGHT_RATE, HEIGHTS, full_film
from reduced_models.bearing.loss import Loss, Seat, loss_state_of
from reduced_models.bearing.race_contact import WORK, contact_force, curve
from reduced_models.bearing.race_table import RaceForceTable
from reduced_models.elements.film_filters import CHAIN, DIRECT

_Floats = NDArray[np.float64]

FREEDOMS = 5
# Imbalance of a ball, over its forces and in steps 1 N, from which one more step of Newton's method to first order
# ends the search; the second where races share the moment by their forces
NEARLY, NEARLY_SHARED = 1e-8, 1e-10
MOST_STEPS, MOST_AT_REST = 60, 12  # of that search: two, but where a ball lands
OVERSHOOT = 2.0  # growth of the imbalance that halves the way to the last place
SINGULAR = 1e-14  # of the squared stiffness: determinant of the tangent of a ball that nothing touches
STALE = 5  # steps of that search after which slopes are renewed
FAR = 0.05  # longest step over the distance of the groove centres
FIRST_STEP = 1e-7  # [m], outward, of a ball that nothing touches; doubled until a race is met
EPSILON = 2.0**-52
COMPLEX_STEP = 1e-30  # [m], of derivatives: nothing is subtracted, so it need not be large

# Rows of `BallFilms.kept`: place and rate of a ball at the last two ends of steps, and what its rate and its
# acceleration follow from
PLACE_NOW, PLACE_BEFORE, PLACE_HISTORY, RATE_NOW, RATE_BEFORE, RATE_HISTORY, KEPT = range(7)
TRANSIT = 3  # column of `BallFilms.speed_sum`


class Balls(NamedTuple):
    """A bearing as its kernels need it: at one speed, or in time at a range of them."""

    inner: RaceForceTable
    outer: RaceForceTable
    number: int
    grooves: Grooves
    omega: float  # of the shaft [rad/s], at rest: the first of `speeds`
    speeds: _Floats  # (rows of the tables,) of the shaft, increasing [rad/s]
    loss: Loss  # of rings and fits
    inertia: float  # of a ball towards the rings [kg]; 0: it has none
    heights: _Floats  # tables of features, see `contact_heights`


class BallFilms(NamedTuple):
    """States and work of a bearing: contacts 2 k (inner race) and 2 k + 1 of ball k; balls; cage; loss."""

    state: _Floats
    work: _Floats
    interval: NDArray[np.int64]  # (contacts, 2): of the curve used last, and of the gains that `work` has
    poisson: _Floats  # room for `prepare_filters`
    share: _Floats
    place: _Floats  # (balls, 2) b as tried last [m]
    kept: _Floats  # (balls, KEPT, 2) places and rates of earlier steps; rows above
    tried: _Floats  # (balls, 4) c and c' where `place` was found
    follow: _Floats  # (balls, 2, 2) its slopes by c, at rest
    film: _Floats  # (contacts, 4) film over that of the table: in this step, at the last two ends; v - u of
    # `film_curve` at the last end
    # (contacts, 4) sum of both surface speeds over the speed of the shaft [m], likewise; 2a/u_sum over sqrt(g) in
    # this step (TRANSIT)
    speed_sum: _Floats
    slopes: _Floats  # (balls, 5, 4) derivatives of `renew_slopes`
    orbit: _Floats  # (balls,) speed about the shaft, over that of the shaft
    force: _Floats  # (balls, 2) at the inner and at the outer race [N]
    largest: _Floats  # (2,) force that any ball has had at either race [N]
    cage: _Floats  # (4,) angle of the first ball [rad] in this step and at the end of the last; speed of the cage
    # over that of the shaft at the last two ends
    omega: _Floats  # (2,) speed of the shaft [rad/s] in this step and at the end of the last
    steps: NDArray[np.int64]  # (1,) made
    maps: _Floats  # (balls, 2, 3, 5) of `ring_map`, and their derivative by the angle of the ball
    tangents: _Floats  # (3, 5, 4) work, see `balance_ball`
    heights: _Floats  # (contacts, HEIGHTS) of features, see `contact_heights`
    turned: _Floats  # (1 + balls, 3) angles of the shaft and of all balls [rad], see there
    loss: Seat


def films_of(balls: Balls) -> BallFilms:
    """States and work for all its contacts and balls and filters, all zero."""
    lags = max(law.gains.shape[2] for law in (balls.inner, balls.outer)) - DIRECT
    n, contacts = balls.number, 2 * balls.number
    return BallFilms(
        state=np.zeros((contacts, CHAIN + lags + 1)),
        work=np.zeros((contacts, WORK + 3 * lags)),
        interval=np.zeros((contacts, 2), np.int64),
        poisson=np.zeros(lags + 3),
        share=np.zeros(lags + 3),
        place=np.full((n, 2), nan),
        kept=np.zeros((n, KEPT, 2)),
        tried=np.zeros((n, 4)),
        follow=np.zeros((n, 2, 2)),
        film=np.ones((contacts, 4)),
        speed_sum=np.ones((contacts, TRANSIT + 1)),
        slopes=np.zeros((n, 5, 4)),
        orbit=np.zeros(n),
        force=np.zeros((n, 2)),
        largest=np.zeros(2),
        cage=np.zeros(4),
        omega=np.zeros(2),
        steps=np.zeros(1, np.int64),
        maps=np.zeros((n, 2, 3, FREEDOMS)),
        tangents=np.zeros((3, 5, 4)),
        heights=np.zeros((contacts, HEIGHTS)),
        turned=np.zeros((1 + n, 3)),
        loss=loss_state_of(balls.loss, FREEDOMS),
    )


class Pressed(NamedTuple):
    """A ball at a place, and the forces on it."""

    l_i: float  # length of the inner spring [m], one over it, its direction
    per_i: float
    i_r: float
    i_z: float
    l_o: float
    per_o: float
    o_r: float
    o_z: float
    e_r: float  # velocity of the inner groove centre seen from the ball [m/s]
    e_z: float
    v_r: float  # velocity of the ball [m/s]
    v_z: float
    f_i: float  # force of the inner contact [N], its derivatives by approach, rate and film over that of the table
    k_i: float
    d_i: float
    film_i: float
    f_o: float
    k_o: float
    d_o: float
    film_o: float
    at: Rolling
    r_r: float  # sum of all forces on the ball [N]
    r_z: float
    p_r: float  # force of the ring on the ball [N], and its moment [N m]
    p_z: float
    moment: float


@jit_exact_loop
def ring_map(g, psi, out):
    """Rows by which the ring's displacement moves c_r and c_z, and its tilt follows a moment: (3, 5)."""
    c, s = cos(psi), sin(psi)
    out[:] = 0.0
    out[0, 0], out[0, 1] = c, s
    out[1, 2], out[1, 3], out[1, 4] = 1.0, g.groove_circle * s, -g.groove_circle * c
    out[2, 3], out[2, 4] = -s, c


@jit_exact_node
def film_of(films, c):
    """Film of a contact in this step, as `film_curve` takes it."""
    return films.film[c, 0], films.film[c, 3]


@jit_exact_node
def rolls(balls, b_r, b_z, c_r, c_z):
    """How a ball rolls at a place, and the dry compressions that share its gyroscopic moment."""
    g, g_i, g_o = balls.grooves, 0.0, 0.0
    if g.control in (INNER, SHARED):
        l_i, l_o = inner_span(b_r, b_z, c_r, c_z)[0], np.hypot(b_r, b_z)
        g_i, g_o = curve(l_i - g.inner, 0, 0.0, balls.inner, 0)[0], curve(l_o - g.outer, 0, 0.0, balls.outer, 0)[0]
    return rolling(g, b_r, b_z, c_r, c_z, g_i, g_o)


@jit_exact_node
def press_ball(balls, omega, row, films, k, c, gain, b_r, b_z):
    """Ball `k` at the place `b`, the groove centre at `c` = (c_r, c_z, c_r', c_z'): its residual."""
    g, kept, full_i, full_o = balls.grooves, films.kept[k], films.heights[2 * k], films.heights[2 * k + 1]
    mass = balls.inertia * gain
    l_i, x_r, x_z = inner_span(b_r, b_z, c[0], c[1])
    l_o = sqrt(b_r * b_r + b_z * b_z)
    per_i, per_o = 1.0 / l_i, 1.0 / l_o
    i_r, i_z, o_r, o_z = x_r * per_i, x_z * per_i, b_r * per_o, b_z * per_o
    v_r, v_z = gain * (b_r - kept[PLACE_HISTORY, 0]), gain * (b_z - kept[PLACE_HISTORY, 1])
    e_r, e_z = c[2] - v_r, c[3] - v_z
    rate_i, rate_o = i_r * e_r + i_z * e_z + full_i[HEIGHT_RATE], o_r * v_r + o_z * v_z + full_o[HEIGHT_RATE]
    u_i, u_o = l_i - (g.inner - full_i[HEIGHT]), l_o - (g.outer - full_o[HEIGHT])
    at = rolls(balls, b_r, b_z, c[0], c[1])
    inner_film, outer_film = film_of(films, 2 * k), film_of(films, 2 * k + 1)
    transit_i, transit_o = films.speed_sum[2 * k, TRANSIT], films.speed_sum[2 * k + 1, TRANSIT]
    if gain == 0.0 and balls.inner.x.size > 0:
        factors = film_factors(g, at)
        inner_film, outer_film = (factors[0], inner_film[1]), (factors[1], outer_film[1])
    f_i, k_i, d_i, film_i = contact_force(balls.inner, transit_i, row, inner_film, films, 2 * k, u_i, rate_i)
    f_o, k_o, d_o, film_o = contact_force(balls.outer, transit_o, row, outer_film, films, 2 * k + 1, u_o, rate_o)
    if full_i[FILM_SLOPE] > 0.0:
        f_i, k_i, d_i = full_film(full_i, l_i - g.inner)
    if full_o[FILM_SLOPE] > 0.0:
        f_o, k_o, d_o = full_film(full_o, l_o - g.outer)
    r_r, r_z, p_r, p_z, moment = ball_forces(g, omega, at, f_i, f_o)
    r_r, r_z = r_r - mass * (v_r - kept[RATE_HISTORY, 0]), r_z - mass * (v_z - kept[RATE_HISTORY, 1])
    return Pressed(
        l_i, per_i, i_r, i_z, l_o, per_o, o_r, o_z, e_r, e_z, v_r, v_z,
        f_i, k_i, d_i, film_i, f_o, k_o, d_o, film_o, at, r_r, r_z, p_r, p_z, moment,
    )  # fmt: skip


@inner
@jit_exact_loop
def renew_slopes(balls, omega, b, c, forces, by_film, out):
    """Derivatives of the forces on a ball, and of that of the ring, by b and c, without those by the approaches.

    Of centrifugal force and gyroscopic moment; of the contact `forces` [N] (inner, outer), whose directions turn;
    and of these forces by the films, `by_film`, that follow the place. By complex steps.
    """
    g, h, (b_r, b_z), c_r, c_z = balls.grooves, COMPLEX_STEP, b, c[0], c[1]
    l_i, l_o = inner_span(b_r, b_z, c_r, c_z)[0], np.hypot(b_r, b_z)
    g_i, by_i, _ = curve(l_i - g.inner, 0, 0.0, balls.inner, 0)
    g_o, by_o, _ = curve(l_o - g.outer, 0, 0.0, balls.outer, 0)
    with_films = by_film[0] != 0.0 or by_film[1] != 0.0
    for j in range(4):
        r, z = complex(b_r, h if j == 0 else 0.0), complex(b_z, h if j == 1 else 0.0)
        far_r, far_z = complex(c_r, h if j == 2 else 0.0), complex(c_z, h if j == 3 else 0.0)
        moved_i = inner_span(r, z, far_r, far_z)[0]
        moved_o = np.sqrt(r * r + z * z)
        at = rolling(g, r, z, far_r, far_z, g_i + by_i * (moved_i - l_i), g_o + by_o * (moved_o - l_o))
        q_i, q_o = complex(forces[0], 0.0), complex(forces[1], 0.0)
        if with_films:
            film_i, film_o = film_factors(g, at)
            q_i = complex(forces[0], by_film[0] * film_i.imag)
            q_o = complex(forces[1], by_film[1] * film_o.imag)
        moved = ball_forces(g, omega, at, q_i, q_o)
        for i in range(5):
            out[i, j] = moved[i].imag / h


@jit_exact_node
def by_place(now, slopes, gain, heavy):
    """Derivatives of the balance by b, their determinant and a stiffness to compare it with; first what they use.

    Rows by which the force of the inner contact follows c, that and c' as b moves, and by which that of the outer
    one follows b; how the inner force turns.
    """
    i_r, i_z, o_r, o_z = now.i_r, now.i_z, now.o_r, now.o_z
    k_i, d_i, k_o, d_o = now.k_i, now.d_i, now.k_o, now.d_o
    s_i, s_o = now.f_i * now.per_i, now.f_o * now.per_o  # forces that turn with their springs
    # rates at which springs turn
    t_i, t_o = (i_r * now.e_z - i_z * now.e_r) * now.per_i, (o_r * now.v_z - o_z * now.v_r) * now.per_o
    a_r, a_z = k_i * i_r - d_i * t_i * i_z, k_i * i_z + d_i * t_i * i_r
    h_r, h_z = a_r + d_i * gain * i_r, a_z + d_i * gain * i_z
    m_r, m_z = (k_o + d_o * gain) * o_r - d_o * t_o * o_z, (k_o + d_o * gain) * o_z + d_o * t_o * o_r
    turn_rr, turn_rz, turn_zz = s_i * i_z * i_z, -s_i * i_r * i_z, s_i * i_r * i_r
    by_rr = -i_r * h_r - turn_rr - o_r * m_r - s_o * o_z * o_z + slopes[0, 0] - heavy
    by_rz = -i_r * h_z - turn_rz - o_r * m_z + s_o * o_r * o_z + slopes[0, 1]
    by_zr = -i_z * h_r - turn_rz - o_z * m_r + s_o * o_r * o_z + slopes[1, 0]
    by_zz = -i_z * h_z - turn_zz - o_z * m_z - s_o * o_r * o_r + slopes[1, 1] - heavy
    det, stiff = by_rr * by_zz - by_rz * by_zr, k_i + k_o + gain * (d_i + d_o) + heavy
    return (
        (a_r, a_z),
        (h_r, h_z),
        (m_r, m_z),
        (turn_rr, turn_rz, turn_zz),
        (by_rr, by_rz, by_zr, by_zz),
        det,
        stiff,
    )


@jit_exact_node
def _following(by, per_det, off_r, off_z):
    """Motion of a ball that takes away an imbalance; `by` is that of `by_place`, by rows."""
    return (by[1] * off_z - by[3] * off_r) * per_det, (by[2] * off_r - by[0] * off_z) * per_det


@jit_exact_node
def balance_ball(balls, omega, row, films, k, c, gain, moving):
    """Balance ball `k` with the groove centre at `c` = (c_r, c_z, c_r', c_z'); False where it finds no balance.

    Rows 2 to 4 of ``films.tangents`` get the force of the ring on the ball (r, z) and its moment: derivatives by c
    and c' on the first page, those by z where the ring is `moving` in more than two directions, and the values in
    the last column of the second. The third has slopes as ``films.slopes``, where a long search in a step renews
    them for itself.
    """
    g, place, tried, follow = balls.grooves, films.place[k], films.tried[k], films.follow[k]
    slopes, w = films.slopes[k], films.tangents[0]
    heavy = balls.inertia * gain * gain
    b_r, b_z = place[0], place[1]
    if gain == 0.0:  # steps begin where the ball moves on to
        for j in range(2):
            moved = c[j] - tried[j]
            b_r, b_z = b_r + follow[0, j] * moved, b_z + follow[1, j] * moved
    reach, previous, last_r, last_z = FIRST_STEP, np.inf, b_r, b_z
    longest = FAR * (g.inner + g.outer)
    nearly = NEARLY_SHARED if g.control in (INNER, SHARED) else NEARLY
    for count in range(MOST_STEPS if gain > 0.0 else MOST_AT_REST):
        old = count % STALE == STALE - 1
        if old and omega > 0.0 and gain > 0.0:
            slopes = films.tangents[2]
            renew_slopes(balls, omega, (b_r, b_z), c, (0.0, 0.0), (0.0, 0.0), slopes)
        now = press_ball(balls, omega, row, films, k, c, gain, b_r, b_z)
        f_i, f_o, r_r, r_z = now.f_i, now.f_o, now.r_r, now.r_z
        size = sqrt(r_r * r_r + r_z * r_z)
        if not size < np.inf:
            return False
        free = f_i == 0.0 and f_o == 0.0 and now.d_i == 0.0 and now.d_o == 0.0 and heavy == 0.0
        if omega == 0.0 and free:  # at rest between the races
            w[:] = 0.0
            films.tangents[1, :, 3] = 0.0
            films.force[k] = 0.0
            follow[:] = 0.0
            place[0], place[1] = b_r, b_z
            for j in range(4):
                tried[j] = c[j]
            return True
        if size > OVERSHOOT * previous:  # a kink lies between
            b_r, b_z, previous = 0.5 * (b_r + last_r), 0.5 * (b_z + last_z), np.inf
            continue
        allowed = nearly * (1.0 + f_i + f_o)
        if gain == 0.0:
            allowed = nearly * (f_i + f_o) + EPSILON * (now.l_i + now.l_o) * (now.k_i + now.k_o)
            if (old or size <= allowed) and omega > 0.0:
                renew_slopes(balls, omega, (b_r, b_z), c, (0.0, 0.0), (now.film_i, now.film_o), slopes)
        a, h, m, turn, by, det, stiff = by_place(now, slopes, gain, heavy)
        if stiff <= 0.0 or abs(det) <= SINGULAR * stiff * stiff:  # nothing touches it
            b_r, b_z = b_r + reach * r_r / size, b_z + reach * r_z / size
            reach, previous = 2.0 * reach, np.inf
            continue
        per_det = 1.0 / det
        step_r, step_z = _following(by, per_det, r_r, r_z)
        if size > allowed:
            length, cut = step_r * step_r + step_z * step_z, 1.0
            if length > longest * longest:
                cut = longest / sqrt(length)
            last_r, last_z, previous = b_r, b_z, size
            b_r, b_z = b_r + cut * step_r, b_z + cut * step_z
            continue
        # by c and c', of the balance, then of the force of the ring, in which b follows c; by c' along the inner
        # contact alone
        i_r, i_z, d_i, out = now.i_r, now.i_z, now.d_i, films.tangents[1]
        p_rr, p_rz = -i_r * h[0] - turn[0] + slopes[2, 0], -i_r * h[1] - turn[1] + slopes[2, 1]
        own_r, own_z = i_r * a[0] + turn[0], i_z * a[0] + turn[1]
        x_r, x_z = _following(by, per_det, own_r + slopes[0, 2], own_z + slopes[1, 2])
        y_r, y_z = _following(by, per_det, i_r, i_z)
        w[2, 0] = own_r + slopes[2, 2] + p_rr * x_r + p_rz * x_z
        along = d_i * (i_r + p_rr * y_r + p_rz * y_z)
        w[2, 2] = along * i_r
        out[2, 3] = now.p_r + p_rr * step_r + p_rz * step_z
        if gain == 0.0:
            follow[0, 0], follow[1, 0] = x_r, x_z
        if moving > 2:
            p_zr, p_zz = -i_z * h[0] - turn[1] + slopes[3, 0], -i_z * h[1] - turn[2] + slopes[3, 1]
            m_r, m_z = slopes[4, 0], slopes[4, 1]
            side_r, side_z = i_r * a[1] + turn[1], i_z * a[1] + turn[2]
            z_r, z_z = _following(by, per_det, side_r + slopes[0, 3], side_z + slopes[1, 3])
            w[2, 1], w[2, 3] = side_r + slopes[2, 3] + p_rr * z_r + p_rz * z_z, along * i_z
            w[3, 0] = own_z + slopes[3, 2] + p_zr * x_r + p_zz * x_z
            w[3, 1] = side_z + slopes[3, 3] + p_zr * z_r + p_zz * z_z
            w[4, 0], w[4, 1] = slopes[4, 2] + m_r * x_r + m_z * x_z, slopes[4, 3] + m_r * z_r + m_z * z_z
            along = d_i * (i_z + p_zr * y_r + p_zz * y_z)
            w[3, 2], w[3, 3] = along * i_r, along * i_z
            along = d_i * (m_r * y_r + m_z * y_z)
            w[4, 2], w[4, 3] = along * i_r, along * i_z
            out[3, 3] = now.p_z + p_zr * step_r + p_zz * step_z
            out[4, 3] = now.moment + m_r * step_r + m_z * step_z
            if gain == 0.0:
                follow[0, 1], follow[1, 1] = z_r, z_z
        place[0], place[1] = b_r + step_r, b_z + step_z
        for j in range(4):
            tried[j] = c[j]
        films.force[k, 0] = f_i - h[0] * step_r - h[1] * step_z
        films.force[k, 1] = f_o + m[0] * step_r + m[1] * step_z
        return True
    return False
