"""Balls at contact angles over time steps, compiled: force of the inner ring with five degrees of freedom.

The counterpart of `balls` for the geometry of `angular_balls`: contacts have their film memory (`race_contact`),
and each ball is where its forces balance at the end of every step. Unless a ball has inertia m towards the rings,
that leaves out its vibration on its two contacts (30 to 40 kHz for a 6205). With the inner groove centre at c,
moving at c', and the ball at b,

    u_i = |c - b| - inner,    u_i' = n_i . (c' - b'),    u_o = |b| - outer,    u_o' = n_o . b',

b' follows from the places of the last steps, and b'' from its rates (BDF 2). Films follow the angles of their
ball: their thickness over that of the table and their time scale change slowly and are extrapolated from the last
two steps. Centrifugal force and gyroscopic moment are those of the place at the end of the step; their
derivatives, of little weight in the tangents, are renewed after some steps.

All balls stand in one cage, which turns at the mean of the speeds at which they would roll alone, by their loads.
"""

from __future__ import annotations

from math import cos, nan, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.jit import inner, jit_exact_called_node, jit_exact_loop, jit_exact_node
from reduced_models.bearing.angular_balls import COMPLEX_STEP, FAR, FIRST_STEP, FREEDOMS, AngularBalls, ring_map
from reduced_models.bearing.balls import row_of_speed
from reduced_models.bearing.contact_angles import INNER, SHARED, ball_forces, film_factors, inner_span, rolling
from reduced_models.bearing.contact_heights import (
    ANGLE_LAST,
    ANGLE_NOW,
    ANGLE_RATE,
    FILM_SLOPE,
    HEIGHT,
    HEIGHT_RATE,
    HEIGHTS,
    find_heights,
    full_film,
    keep_heights,
    rest_heights,
)
from reduced_models.bearing.loss import (
    Seat,
    accept_loss,
    apply_loss,
    begin_loss,
    hold_still,
    loss_state_of,
    rest_loss,
)
from reduced_models.bearing.race_contact import (
    APPROACH,
    WORK,
    accept_contact,
    clear_filters,
    contact_force,
    curve,
    prepare_filters,
)
from reduced_models.elements.film_filters import CHAIN, DIRECT

_Floats = NDArray[np.float64]

# Imbalance of a ball, over its forces and 1 N, from which one more step of Newton's method to first order ends the
# search
NEARLY, NEARLY_SHARED = 1e-8, 1e-10  # the second where races share the moment by their forces
MOST_STEPS = 60  # of that search: two, but where a ball lands
OVERSHOOT = 2.0  # growth of the imbalance that halves the way to the last place
DOUBLED, HALVED = 40, 48  # steps of a search by bisection: to a bracket, and in it
BESIDE = (
    0.5  # rad, on either side of the line between the groove centres and of that across the shaft: of its angle
)
SINGULAR = 1e-14  # of the squared stiffness: determinant of the tangent of a ball that nothing touches
STALE = 5  # steps of that search after which they are renewed
RENEWED = 16  # time steps after which the derivatives of centrifugal force and gyroscopic moment are renewed
# Rows of `AngularFilms.kept`: place and rate of a ball at the last two ends of steps, and what its rate and its
# acceleration follow from
PLACE_NOW, PLACE_BEFORE, PLACE_HISTORY, RATE_NOW, RATE_BEFORE, RATE_HISTORY, KEPT = range(7)
TRANSIT = 3  # column of `AngularFilms.speed_sum`
SETTLED = 20  # times that films at rest are made to follow the angles of their balls: their effect is a thousandth


class AngularFilms(NamedTuple):
    """States and work of a bearing in time: contacts 2 k (inner race) and 2 k + 1 of ball k; balls; cage; loss."""

    state: _Floats
    work: _Floats
    interval: NDArray[np.int64]  # (contacts, 2): of the curve used last, and of the gains that `work` has
    poisson: _Floats  # room for `prepare_filters`
    share: _Floats
    place: _Floats  # (balls, 2) b as tried last [m]
    kept: _Floats  # (balls, KEPT, 2) places and rates of earlier steps; rows above
    tried: _Floats  # (balls, 4) c and c' where `place` was found
    follow: _Floats  # (balls, 2, 4) its slopes by both
    film: _Floats  # (contacts, 4) film over that of the table: in this step, at the last two ends; v - u of
    # `film_curve` at the last end
    # (contacts, 4) sum of both surface speeds over the speed of the shaft [m], likewise; 2a/u_sum over sqrt(g) in
    # this step (TRANSIT)
    speed_sum: _Floats
    inertia: _Floats  # (balls, 5, 4) derivatives of the forces of inertia, by b and c
    orbit: _Floats  # (balls,) speed about the shaft, over that of the shaft
    force: _Floats  # (balls, 2) at the inner and at the outer race [N]
    largest: _Floats  # (2,) force that any ball has had at either race [N]
    cage: _Floats  # (4,) angle of the first ball [rad] in this step and at the end of the last; speed of the cage
    # over that of the shaft at the last two ends
    omega: _Floats  # (2,) speed of the shaft [rad/s] in this step and at the end of the last
    steps: NDArray[np.int64]  # (1,) made
    maps: _Floats  # (balls, 2, 3, 5) of `ring_map`, and their derivative by the angle of the ball
    tangents: _Floats  # (3, 5, 4) work, see `_balance_ball`
    heights: _Floats  # (contacts, HEIGHTS) of features, see `contact_heights`
    turned: _Floats  # (1 + balls, 3) angles of the shaft and of all balls [rad], see there
    loss: Seat


def films_of_angular(balls: AngularBalls) -> AngularFilms:
    """States and work for all its contacts and balls and filters, all zero."""
    lags = max(law.gains.shape[2] for law in (balls.inner, balls.outer)) - DIRECT
    n, contacts = balls.number, 2 * balls.number
    return AngularFilms(
        state=np.zeros((contacts, CHAIN + lags + 1)),
        work=np.zeros((contacts, WORK + 3 * lags)),
        interval=np.zeros((contacts, 2), np.int64),
        poisson=np.zeros(lags + 3),
        share=np.zeros(lags + 3),
        place=np.full((n, 2), nan),
        kept=np.zeros((n, KEPT, 2)),
        tried=np.zeros((n, 4)),
        follow=np.zeros((n, 2, 4)),
        film=np.ones((contacts, 4)),
        speed_sum=np.ones((contacts, TRANSIT + 1)),
        inertia=np.zeros((n, 5, 4)),
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


@jit_exact_called_node
def begin_angular_step(balls, omega, dt, films):
    """Begin a step of length `dt`, as long as the one before, at whose end the shaft turns at `omega`."""
    films.omega[0], cage = omega, films.cage
    cage[0] = cage[1] + 0.5 * dt * (omega + films.omega[1]) * (1.5 * cage[2] - 0.5 * cage[3])
    _turn_maps(balls, films)
    if balls.heights.shape[0] > 0:
        swept = 0.5 * dt * (omega + films.omega[1])
        for k in range(balls.number + 1):
            turned = films.turned[k]
            turned[ANGLE_NOW] = turned[ANGLE_LAST] + swept * turned[ANGLE_RATE]
        find_heights(balls, films, cage[0], 1.5 / dt)
    rolling_speed = max(omega, balls.speeds[0])
    row = row_of_speed(balls.speeds, rolling_speed)
    for k in range(balls.number):
        kept = films.kept[k]
        for j in range(2):
            kept[PLACE_HISTORY, j] = (4.0 * kept[PLACE_NOW, j] - kept[PLACE_BEFORE, j]) / 3.0
            kept[RATE_HISTORY, j] = (4.0 * kept[RATE_NOW, j] - kept[RATE_BEFORE, j]) / 3.0
        for race in range(2):
            c = 2 * k + race
            law = balls.inner if race == 0 else balls.outer
            film, u = films.film[c], films.speed_sum[c]
            film[0], u[0] = 2.0 * film[1] - film[2], 2.0 * u[1] - u[2]
            middle, transit = 1.5 * u[1] - 0.5 * u[2], 0.0
            if rolling_speed > 0.0:
                transit = law.contact_length_factor / (middle * rolling_speed)
            u[TRANSIT] = law.contact_length_factor / (u[0] * rolling_speed) if rolling_speed > 0.0 else 0.0
            prepare_filters(law, transit, row, (film[0], film[3]), dt, films, c)
    begin_loss(balls.loss, dt, films.loss)


@jit_exact_loop
def begin_angular_rest(balls, omega, angle, films):
    """Prepare `press_angular` for the static law, at the speed `omega` and with the first ball at `angle`."""
    films.omega[:] = omega
    films.cage[:] = 0.0
    films.cage[0] = films.cage[1] = angle
    films.film[:] = 1.0
    films.film[:, 3] = 0.0
    films.follow[:] = 0.0
    _turn_maps(balls, films)
    clear_filters(films)
    hold_still(films.loss)


@inner
@jit_exact_loop
def _turn_maps(balls, films):
    """Maps from the ring to the groove centres at the angles that the balls have now."""
    for k in range(balls.number):
        psi = films.cage[0] + 2.0 * pi * k / balls.number
        ring_map(balls.grooves, psi, films.maps[k, 0])
        turned = films.maps[k, 1]
        c, s, groove_circle = cos(psi), sin(psi), balls.grooves.groove_circle
        turned[0, 0], turned[0, 1], turned[1, 3], turned[1, 4] = -s, c, groove_circle * c, groove_circle * s


@jit_exact_node
def _groove_centre(balls, films, k, q, v, cage):
    """Inner groove centre at ball `k`, and its velocity, seen in the plane of the ball."""
    rows, turned = films.maps[k, 0], films.maps[k, 1]
    c_r, c_z, d_r, d_z = balls.grooves.radial, balls.grooves.axial, 0.0, 0.0
    for j in range(q.size):
        c_r += rows[0, j] * q[j]
        c_z += rows[1, j] * q[j]
        d_r += rows[0, j] * v[j] + cage * turned[0, j] * q[j]
        d_z += rows[1, j] * v[j] + cage * turned[1, j] * q[j]
    return c_r, c_z, d_r, d_z


@jit_exact_node
def _film(films, c):
    """Film of a contact in this step, as `film_curve` takes it."""
    return films.film[c, 0], films.film[c, 3]


@jit_exact_node
def _rolls(balls, b_r, b_z, c_r, c_z):
    """How a ball rolls at a place, and the dry compressions that share its gyroscopic moment."""
    g, g_i, g_o = balls.grooves, 0.0, 0.0
    if g.control in (INNER, SHARED):
        l_i, l_o = inner_span(b_r, b_z, c_r, c_z)[0], np.hypot(b_r, b_z)
        g_i, g_o = curve(l_i - g.inner, 0, 0.0, balls.inner, 0)[0], curve(l_o - g.outer, 0, 0.0, balls.outer, 0)[0]
    return rolling(g, b_r, b_z, c_r, c_z, g_i, g_o)


@inner
@jit_exact_loop
def _renew_inertia(balls, omega, b_r, b_z, c_r, c_z, out):
    """Derivatives of centrifugal force and gyroscopic moment by b and c, by complex steps."""
    g, h = balls.grooves, COMPLEX_STEP
    l_i, l_o = inner_span(b_r, b_z, c_r, c_z)[0], np.hypot(b_r, b_z)
    g_i, by_i, _ = curve(l_i - g.inner, 0, 0.0, balls.inner, 0)
    g_o, by_o, _ = curve(l_o - g.outer, 0, 0.0, balls.outer, 0)
    for j in range(4):
        r, z = complex(b_r, h if j == 0 else 0.0), complex(b_z, h if j == 1 else 0.0)
        far_r, far_z = complex(c_r, h if j == 2 else 0.0), complex(c_z, h if j == 3 else 0.0)
        moved_i = inner_span(r, z, far_r, far_z)[0]
        moved_o = np.sqrt(r * r + z * z)
        at = rolling(g, r, z, far_r, far_z, g_i + by_i * (moved_i - l_i), g_o + by_o * (moved_o - l_o))
        forces = ball_forces(g, omega, at, 0.0, 0.0)
        for i in range(5):
            out[i, j] = forces[i].imag / h


@jit_exact_node
def _balance_ball(balls, omega, row, films, k, c, gain):
    """Balance ball `k` with the groove centre at `c` = (c_r, c_z, c_r', c_z'); False where it finds no balance.

    Rows 2 to 4 of ``films.tangents`` get the force of the ring on the ball (r, z) and its moment: derivatives by c
    and c' on the first page, the values in the last column of the second. The third has the forces of inertia as
    ``films.inertia``, where a long search renews them for itself.
    """
    g, place, tried, follow = balls.grooves, films.place[k], films.tried[k], films.follow[k]
    c_r, c_z, d_r, d_z = c
    history, swing, inertia = films.kept[k, PLACE_HISTORY], films.kept[k, RATE_HISTORY], films.inertia[k]
    w, mass = films.tangents[0], balls.inertia * gain
    heavy = mass * gain
    film_i, film_o = _film(films, 2 * k), _film(films, 2 * k + 1)
    transit_i, transit_o = films.speed_sum[2 * k, TRANSIT], films.speed_sum[2 * k + 1, TRANSIT]
    b_r, b_z = place[0], place[1]
    for j in range(4):
        moved = c[j] - tried[j]
        b_r, b_z = b_r + follow[0, j] * moved, b_z + follow[1, j] * moved
    full_i, full_o = films.heights[2 * k], films.heights[2 * k + 1]
    free_i, up_i = g.inner - full_i[HEIGHT], full_i[HEIGHT_RATE]
    free_o, up_o = g.outer - full_o[HEIGHT], full_o[HEIGHT_RATE]
    reach, previous, last_r, last_z = FIRST_STEP, np.inf, b_r, b_z
    longest = FAR * (g.inner + g.outer)
    nearly = NEARLY_SHARED if g.control in (INNER, SHARED) else NEARLY
    for count in range(MOST_STEPS):
        if count % STALE == STALE - 1 and omega > 0.0:
            inertia = films.tangents[2]
            _renew_inertia(balls, omega, b_r, b_z, c_r, c_z, inertia)
        l_i, x_r, x_z = inner_span(b_r, b_z, c_r, c_z)
        l_o = sqrt(b_r * b_r + b_z * b_z)
        per_i, per_o = 1.0 / l_i, 1.0 / l_o
        i_r, i_z, o_r, o_z = x_r * per_i, x_z * per_i, b_r * per_o, b_z * per_o
        v_r, v_z = gain * (b_r - history[0]), gain * (b_z - history[1])
        e_r, e_z = d_r - v_r, d_z - v_z
        rate_i, rate_o = i_r * e_r + i_z * e_z + up_i, o_r * v_r + o_z * v_z + up_o
        f_i, k_i, d_i = contact_force(balls.inner, transit_i, row, film_i, films, 2 * k, l_i - free_i, rate_i)
        f_o, k_o, d_o = contact_force(balls.outer, transit_o, row, film_o, films, 2 * k + 1, l_o - free_o, rate_o)
        if full_i[FILM_SLOPE] > 0.0:
            f_i, k_i, d_i = full_film(full_i, l_i - g.inner)
        if full_o[FILM_SLOPE] > 0.0:
            f_o, k_o, d_o = full_film(full_o, l_o - g.outer)
        at = _rolls(balls, b_r, b_z, c_r, c_z)
        r_r, r_z, p_r, p_z, moment = ball_forces(g, omega, at, f_i, f_o)
        r_r, r_z = r_r - mass * (v_r - swing[0]), r_z - mass * (v_z - swing[1])
        size = sqrt(r_r * r_r + r_z * r_z)
        if not size < np.inf:
            return False
        free = f_i == 0.0 and f_o == 0.0 and d_i == 0.0 and d_o == 0.0 and heavy == 0.0
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
        # slopes of f_i n_i by c, by c' and, but for the sign and the gain, by b; of f_o n_o by b
        s_i, s_o = f_i * per_i, f_o * per_o  # forces that turn with their springs
        t_i, t_o = (i_r * e_z - i_z * e_r) * per_i, (o_r * v_z - o_z * v_r) * per_o  # rates at which springs turn
        a_r, a_z = k_i * i_r - d_i * t_i * i_z, k_i * i_z + d_i * t_i * i_r
        h_r, h_z = a_r + d_i * gain * i_r, a_z + d_i * gain * i_z
        m_r, m_z = (k_o + d_o * gain) * o_r - d_o * t_o * o_z, (k_o + d_o * gain) * o_z + d_o * t_o * o_r
        turn_rr, turn_rz, turn_zz = s_i * i_z * i_z, -s_i * i_r * i_z, s_i * i_r * i_r
        by_rr = -i_r * h_r - turn_rr - o_r * m_r - s_o * o_z * o_z + inertia[0, 0] - heavy
        by_rz = -i_r * h_z - turn_rz - o_r * m_z + s_o * o_r * o_z + inertia[0, 1]
        by_zr = -i_z * h_r - turn_rz - o_z * m_r + s_o * o_r * o_z + inertia[1, 0]
        by_zz = -i_z * h_z - turn_zz - o_z * m_z - s_o * o_r * o_r + inertia[1, 1] - heavy
        det, stiff = by_rr * by_zz - by_rz * by_zr, k_i + k_o + gain * (d_i + d_o) + heavy
        if stiff <= 0.0 or abs(det) <= SINGULAR * stiff * stiff:  # nothing touches it
            b_r, b_z = b_r + reach * r_r / size, b_z + reach * r_z / size
            reach, previous = 2.0 * reach, np.inf
            continue
        step_r, step_z = (by_rz * r_z - by_zz * r_r) / det, (by_zr * r_r - by_rr * r_z) / det
        if size > nearly * (1.0 + f_i + f_o):
            length = sqrt(step_r * step_r + step_z * step_z)
            cut = min(1.0, longest / length)
            last_r, last_z, previous = b_r, b_z, size
            b_r, b_z = b_r + cut * step_r, b_z + cut * step_z
            continue
        # by c and c': of the balance, then of the force of the ring, in which b follows c
        w[0, 0], w[0, 1] = i_r * a_r + turn_rr + inertia[0, 2], i_r * a_z + turn_rz + inertia[0, 3]
        w[1, 0], w[1, 1] = i_z * a_r + turn_rz + inertia[1, 2], i_z * a_z + turn_zz + inertia[1, 3]
        w[0, 2], w[0, 3] = d_i * i_r * i_r, d_i * i_r * i_z
        w[1, 2], w[1, 3] = w[0, 3], d_i * i_z * i_z
        p_rr, p_rz = -i_r * h_r - turn_rr + inertia[2, 0], -i_r * h_z - turn_rz + inertia[2, 1]
        p_zr, p_zz = -i_z * h_r - turn_rz + inertia[3, 0], -i_z * h_z - turn_zz + inertia[3, 1]
        per_det = 1.0 / det
        for j in range(4):
            follow[0, j] = (by_rz * w[1, j] - by_zz * w[0, j]) * per_det
            follow[1, j] = (by_zr * w[0, j] - by_rr * w[1, j]) * per_det
        for j in range(4):
            own_r = w[0, j] - (inertia[0, 2 + j] - inertia[2, 2 + j] if j < 2 else 0.0)
            own_z = w[1, j] - (inertia[1, 2 + j] - inertia[3, 2 + j] if j < 2 else 0.0)
            w[2, j] = own_r + p_rr * follow[0, j] + p_rz * follow[1, j]
            w[3, j] = own_z + p_zr * follow[0, j] + p_zz * follow[1, j]
            own = inertia[4, 2 + j] if j < 2 else 0.0
            w[4, j] = own + inertia[4, 0] * follow[0, j] + inertia[4, 1] * follow[1, j]
        out = films.tangents[1]
        out[2, 3] = p_r + p_rr * step_r + p_rz * step_z
        out[3, 3] = p_z + p_zr * step_r + p_zz * step_z
        out[4, 3] = moment + inertia[4, 0] * step_r + inertia[4, 1] * step_z
        place[0], place[1] = b_r + step_r, b_z + step_z
        for j in range(4):
            tried[j] = c[j]
        films.force[k, 0] = f_i - h_r * step_r - h_z * step_z
        films.force[k, 1] = f_o + m_r * step_r + m_z * step_z
        return True
    return False


@jit_exact_node
def _move_on(films, k):
    """Put ball `k` where it would be if it moved on as in the last step: where the search begins, see `balls`."""
    films.follow[k] = 0.0
    for j in range(2):
        films.place[k, j] = 2.0 * films.kept[k, PLACE_NOW, j] - films.kept[k, PLACE_BEFORE, j]


@inner
@jit_exact_loop
def _place_ball(balls, k, c, films):
    """First place of ball `k`: on the line between the groove centres, dry contacts in balance if they touch."""
    g = balls.grooves
    length = np.hypot(c[0], c[1])
    closer = length - g.inner - g.outer
    ratio = (balls.outer.kn / balls.inner.kn) ** (2.0 / 3.0)
    outward = g.outer + closer / (1.0 + ratio)
    omega = films.omega[0]
    if closer < 0.0 and omega > 0.0:
        centrifugal = 0.125 * omega * omega * g.mass * g.pitch
        outward = g.outer + (centrifugal / balls.outer.kn) ** (2.0 / 3.0)
    films.place[k, 0], films.place[k, 1] = outward * c[0] / length, outward * c[1] / length
    films.follow[k] = 0.0
    for j in range(4):
        films.tried[k, j] = c[j]


@inner
@jit_exact_loop
def _imbalance(balls, omega, row, films, k, c, gain, b_r, b_z):
    """Sum of the forces on ball `k` at a place, radial and axial [N]."""
    g, kept, heights = balls.grooves, films.kept[k], films.heights
    mass = balls.inertia * gain
    transit_i, transit_o = films.speed_sum[2 * k, TRANSIT], films.speed_sum[2 * k + 1, TRANSIT]
    film_i, film_o = _film(films, 2 * k), _film(films, 2 * k + 1)
    l_i, x_r, x_z = inner_span(b_r, b_z, c[0], c[1])
    l_o = sqrt(b_r * b_r + b_z * b_z)
    v_r, v_z = gain * (b_r - kept[PLACE_HISTORY, 0]), gain * (b_z - kept[PLACE_HISTORY, 1])
    rate_i = (x_r * (c[2] - v_r) + x_z * (c[3] - v_z)) / l_i + heights[2 * k, HEIGHT_RATE]
    rate_o = (b_r * v_r + b_z * v_z) / l_o + heights[2 * k + 1, HEIGHT_RATE]
    u_i, u_o = l_i - g.inner + heights[2 * k, HEIGHT], l_o - g.outer + heights[2 * k + 1, HEIGHT]
    f_i = contact_force(balls.inner, transit_i, row, film_i, films, 2 * k, u_i, rate_i)[0]
    f_o = contact_force(balls.outer, transit_o, row, film_o, films, 2 * k + 1, u_o, rate_o)[0]
    if heights[2 * k, FILM_SLOPE] > 0.0:
        f_i = full_film(heights[2 * k], l_i - g.inner)[0]
    if heights[2 * k + 1, FILM_SLOPE] > 0.0:
        f_o = full_film(heights[2 * k + 1], l_o - g.outer)[0]
    forces = ball_forces(g, omega, _rolls(balls, b_r, b_z, c[0], c[1]), f_i, f_o)
    return forces[0] - mass * (v_r - kept[RATE_HISTORY, 0]), forces[1] - mass * (v_z - kept[RATE_HISTORY, 1])


@inner
@jit_exact_loop
def _search_ball(balls, omega, row, films, k, c, gain):
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
    films.place[k, 0], films.place[k, 1] = 0.5 * (low + high) * cos(angle), 0.5 * (low + high) * sin(angle)
    films.follow[k] = 0.0
    for j in range(4):
        films.tried[k, j] = c[j]


@inner
@jit_exact_loop
def _along(balls, omega, row, films, k, c, gain, length, far):
    """Force on ball `k` away from the outer groove centre, `length` from it, where none is across; its angle."""
    low, high, angle = min(far, 0.0) - BESIDE, max(far, 0.0) + BESIDE, far
    for _ in range(HALVED):
        r, z = _imbalance(balls, omega, row, films, k, c, gain, length * cos(angle), length * sin(angle))
        across = z * cos(angle) - r * sin(angle)
        if across == 0.0:  # exactly, of balls between grooves in one plane, which stay in it
            break
        if across > 0.0:
            low = angle
        else:
            high = angle
        angle = 0.5 * (low + high)
    return r * cos(angle) + z * sin(angle), angle


@jit_exact_node
def _add_ball(rows, turned, cage, tangents, moving, out):
    """Add the forces of one ball to those of the ring in the first `moving` directions.

    r moves x and y, z and the moment the others.
    """
    force, stiffness, damping = out
    w, found = tangents[0], tangents[1]
    p_r, p_z, moment = found[2, 3], found[3, 3], found[4, 3]
    for j in range(2):
        force[j] += rows[0, j] * p_r
    for j in range(2, moving):
        force[j] += rows[1, j] * p_z + rows[2, j] * moment
    for j in range(moving):
        # by the place and the rate of freedom j, for r, z and the moment
        row, at = (rows[0, j], 0) if j < 2 else (rows[1, j], 1)
        swept = cage * (turned[0, j] if j < 2 else turned[1, j])
        r, z = w[2, at] * row + w[2, 2 + at] * swept, w[3, at] * row + w[3, 2 + at] * swept
        m = w[4, at] * row + w[4, 2 + at] * swept
        r_rate, z_rate, m_rate = w[2, 2 + at] * row, w[3, 2 + at] * row, w[4, 2 + at] * row
        for i in range(2):
            stiffness[i, j] += rows[0, i] * r
            damping[i, j] += rows[0, i] * r_rate
        for i in range(2, moving):
            stiffness[i, j] += rows[1, i] * z + rows[2, i] * m
            damping[i, j] += rows[1, i] * z_rate + rows[2, i] * m_rate


@jit_exact_called_node
def press_angular(balls, films, q, v, gain, out):
    """Force that the ring at `q`, moving at `v`, exerts on the balls, and its derivatives by both.

    The ring moves in the first n directions, with `q` and `v` of shape (n,), and is held at 0 in the others. Its
    force and the derivatives are written into `out`, arrays of shape (5,), (5, 5) and (5, 5), of which the others
    stay 0. The step is that begun last; `gain` leads from places of balls to their rates, and is 0 at rest. Not a
    number where a ball finds no balance.
    """
    force, stiffness, damping = out
    force[:], stiffness[:], damping[:] = 0.0, 0.0, 0.0
    omega = films.omega[0]
    cage = omega * films.cage[2] if gain > 0.0 else 0.0
    row = row_of_speed(balls.speeds, max(omega, balls.speeds[0]))
    for k in range(balls.number):
        rows, turned = films.maps[k, 0], films.maps[k, 1]
        c = _groove_centre(balls, films, k, q, v, cage)
        done = False
        for attempt in range(3):
            if attempt == 0 and gain > 0.0:
                _move_on(films, k)
            if attempt == 1 or not np.isfinite(films.place[k, 0]):
                _place_ball(balls, k, c, films)
            if attempt == 2:
                _search_ball(balls, omega, row, films, k, c, gain)
            done = _balance_ball(balls, omega, row, films, k, c, gain)
            if done:
                break
        if not done:
            force[:] = nan
            return
        _add_ball(rows, turned, cage, films.tangents, q.size, out)
    apply_loss(films.loss, force, stiffness, damping)


@jit_exact_called_node
def accept_angular(balls, films, gain):
    """Move all films, balls and the cage to the end of the step, with the ring where `press_angular` was last."""
    g, omega = balls.grooves, films.omega[0]
    rolling_speed = max(omega, balls.speeds[0])
    row = row_of_speed(balls.speeds, rolling_speed)
    carried, turned, free = 0.0, 0.0, 0.0
    for k in range(balls.number):
        b_r, b_z = films.place[k, 0], films.place[k, 1]
        c_r, c_z, d_r, d_z = films.tried[k, 0], films.tried[k, 1], films.tried[k, 2], films.tried[k, 3]
        at = _rolls(balls, b_r, b_z, c_r, c_z)
        kept = films.kept[k]
        v_r, v_z = gain * (b_r - kept[PLACE_HISTORY, 0]), gain * (b_z - kept[PLACE_HISTORY, 1])
        i, o, heights = 2 * k, 2 * k + 1, films.heights
        rate_i = at.cos_i * (d_r - v_r) + at.sin_i * (d_z - v_z) + heights[i, HEIGHT_RATE]
        rate_o = at.cos_o * v_r + at.sin_o * v_z + heights[o, HEIGHT_RATE]
        film, u = films.film, films.speed_sum
        u_i, u_o = at.l_i - (g.inner - heights[i, HEIGHT]), at.l_o - (g.outer - heights[o, HEIGHT])
        film_i, film_o = _film(films, i), _film(films, o)
        film[i, 3] = accept_contact(balls.inner, u[i, TRANSIT], row, film_i, films, i, u_i, rate_i)
        film[o, 3] = accept_contact(balls.outer, u[o, TRANSIT], row, film_o, films, o, u_o, rate_o)
        factors = film_factors(g, at)
        film[i, 2], film[i, 1] = film[i, 1], factors[0]
        film[o, 2], film[o, 1] = film[o, 1], factors[1]
        u[i, 2], u[i, 1] = u[i, 1], at.u_i
        u[o, 2], u[o, 1] = u[o, 1], at.u_o
        for j in range(2):
            kept[PLACE_BEFORE, j], kept[PLACE_NOW, j] = kept[PLACE_NOW, j], films.place[k, j]
            kept[RATE_BEFORE, j] = kept[RATE_NOW, j]
            films.largest[j] = max(films.largest[j], films.force[k, j])
        kept[RATE_NOW, 0], kept[RATE_NOW, 1] = v_r, v_z
        films.orbit[k] = at.orbit
        own = films.turned[1 + k]
        own[ANGLE_LAST], own[ANGLE_RATE] = own[ANGLE_NOW], at.ball_rotation
        carried, turned, free = (
            carried + films.force[k, 0],
            turned + films.force[k, 0] * at.orbit,
            free + at.orbit / balls.number,
        )
        inclined = at.sin_i != 0.0 or at.sin_o != 0.0
        if omega > 0.0 and inclined and (g.control in (INNER, SHARED) or (films.steps[0] + k) % RENEWED == 0):
            _renew_inertia(balls, omega, b_r, b_z, c_r, c_z, films.inertia[k])
    films.steps[0] += 1
    films.turned[0, ANGLE_LAST] = films.turned[0, ANGLE_NOW]
    keep_heights(balls, films)
    cage = films.cage
    cage[1], cage[3], cage[2] = cage[0], cage[2], turned / carried if carried > 0.0 else free
    films.omega[1] = omega
    accept_loss(films.loss)


@jit_exact_loop
def rest_angular(balls, films, q, out):
    """Put balls, films and cage at rest with the ring at `q`; its force on the balls is left in `out`."""
    still, omega = out[3], films.omega[0]
    still[:] = 0.0
    for _ in range(SETTLED):
        press_angular(balls, films, q, still, 0.0, out[:3])
        if not np.isfinite(out[0][0]):
            return
        for k in range(balls.number):
            b_r, b_z, c_r, c_z = films.place[k, 0], films.place[k, 1], films.tried[k, 0], films.tried[k, 1]
            at = _rolls(balls, b_r, b_z, c_r, c_z)
            factors = film_factors(balls.grooves, at)
            for j in range(3):
                films.film[2 * k, j], films.film[2 * k + 1, j] = factors
                films.speed_sum[2 * k, j], films.speed_sum[2 * k + 1, j] = at.u_i, at.u_o
            films.orbit[k], films.turned[1 + k, ANGLE_RATE] = at.orbit, at.ball_rotation
            if omega > 0.0:
                _renew_inertia(balls, omega, b_r, b_z, c_r, c_z, films.inertia[k])
    press_angular(balls, films, q, still, 0.0, out[:3])
    films.state[:] = 0.0
    carried, turned, free = 0.0, 0.0, 0.0
    for k in range(balls.number):
        b_r, b_z, c_r, c_z = films.place[k, 0], films.place[k, 1], films.tried[k, 0], films.tried[k, 1]
        g, heights = balls.grooves, films.heights
        films.state[2 * k, APPROACH] = inner_span(b_r, b_z, c_r, c_z)[0] - (g.inner - heights[2 * k, HEIGHT])
        films.state[2 * k + 1, APPROACH] = np.hypot(b_r, b_z) - (g.outer - heights[2 * k + 1, HEIGHT])
        for j in range(2):
            films.kept[k, PLACE_NOW, j] = films.kept[k, PLACE_BEFORE, j] = films.place[k, j]
            films.kept[k, RATE_NOW, j] = films.kept[k, RATE_BEFORE, j] = 0.0
        carried += films.force[k, 0]
        turned += films.force[k, 0] * films.orbit[k]
        free += films.orbit[k] / balls.number
    films.cage[2] = films.cage[3] = turned / carried if carried > 0.0 else free
    films.turned[0, ANGLE_RATE] = 1.0
    rest_heights(films)
    rest_loss(films.loss)
