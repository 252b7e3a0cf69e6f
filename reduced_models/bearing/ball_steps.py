"""All balls of a bearing, compiled: time steps with their films, rest, and the force of the inner ring.

Balls are those of `ball`. They stand in one cage, which turns at the mean of the speeds at which they would roll
alone, by their loads.
"""

from __future__ import annotations

from math import nan, pi

import numpy as np

from ehlcontact.jit import inner, jit_exact_called_node, jit_exact_loop, jit_exact_node
from reduced_models.bearing.ball import (
    PLACE_BEFORE,
    PLACE_HISTORY,
    PLACE_NOW,
    RATE_BEFORE,
    RATE_HISTORY,
    RATE_NOW,
    SINGULAR,
    TRANSIT,
    balance_ball,
    film_of,
    press_ball,
    renew_slopes,
    ring_map,
    rolls,
)
from reduced_models.bearing.ball_search import move_on, place_ball, search_ball, seek_ball
from reduced_models.bearing.contact_angles import INNER, SHARED, film_factors
from reduced_models.bearing.contact_heights import (
    ANGLE_LAST,
    ANGLE_NOW,
    ANGLE_RATE,
    HEIGHT,
    HEIGHT_RATE,
    find_heights,
    keep_heights,
    rest_heights,
)
from reduced_models.bearing.loss import accept_loss, apply_loss, begin_loss, hold_still, rest_loss
from reduced_models.bearing.race_contact import (
    APPROACH,
    accept_contact,
    clear_filters,
    prepare_filters,
    row_of_speed,
)

RENEWED = 16  # time steps after which the derivatives of centrifugal force and gyroscopic moment are renewed

# Quantities of a ball at rest: contact angles, forces, approaches, slopes of the force by the approach, film over
# that of the table, sum of the surface speeds over the speed of the shaft (inner and outer race each), orbit, own
# rotation and beta
ANGLE, LOAD, CLOSER, SLOPE, FILM, SPEED_SUM = 0, 2, 4, 6, 8, 10
ORBIT, OWN_ROTATION, AXIS_ANGLE, ENTRIES = 12, 13, 14, 15


@jit_exact_called_node
def begin_step(balls, omega, dt, films):
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
def begin_rest(balls, omega, angle, films):
    """Prepare `press_balls` for the static law, at the speed `omega` and with the first ball at `angle`."""
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
        rows, turned, groove_circle = films.maps[k, 0], films.maps[k, 1], balls.grooves.groove_circle
        ring_map(balls.grooves, psi, rows)
        c, s = rows[0, 0], rows[0, 1]
        turned[0, 0], turned[0, 1], turned[1, 3], turned[1, 4] = -s, c, groove_circle * c, groove_circle * s


@jit_exact_node
def _groove_centre(balls, films, k, q, v, cage):
    """Inner groove centre at ball `k`, and its velocity, seen in the plane of the ball, by `ring_map`."""
    rows, turned = films.maps[k, 0], films.maps[k, 1]
    cosine, sine = rows[0, 0], rows[0, 1]
    c_r = balls.grooves.radial + cosine * q[0] + sine * q[1]
    d_r = cosine * v[0] + cage * turned[0, 0] * q[0] + (sine * v[1] + cage * turned[0, 1] * q[1])
    c_z, d_z = balls.grooves.axial, 0.0
    for j in range(2, q.size):
        c_z += rows[1, j] * q[j]
        d_z += rows[1, j] * v[j] + cage * turned[1, j] * q[j]
    return c_r, c_z, d_r, d_z


@jit_exact_node
def _add_ball(rows, turned, cage, tangents, moving, out):
    """Add the forces of one ball to those of the ring in the first `moving` directions.

    r moves x and y, z and the moment the others.
    """
    force, stiffness, damping = out
    w, found = tangents[0], tangents[1]
    p_r, by_r, by_rate = found[2, 3], w[2, 0], w[2, 2]
    cosine, sine = rows[0, 0], rows[0, 1]
    force[0] += cosine * p_r
    force[1] += sine * p_r
    by_x, by_y = by_r * cosine + by_rate * (cage * turned[0, 0]), by_r * sine + by_rate * (cage * turned[0, 1])
    stiffness[0, 0] += cosine * by_x
    stiffness[1, 0] += sine * by_x
    stiffness[0, 1] += cosine * by_y
    stiffness[1, 1] += sine * by_y
    by_x, by_y = by_rate * cosine, by_rate * sine
    damping[0, 0] += cosine * by_x
    damping[1, 0] += sine * by_x
    damping[0, 1] += cosine * by_y
    damping[1, 1] += sine * by_y
    if moving == 2:
        return
    p_z, moment = found[3, 3], found[4, 3]
    for j in range(2, moving):
        force[j] += rows[1, j] * p_z + rows[2, j] * moment
    for j in range(moving):
        # by the place and the rate of freedom j, for r, z and the moment
        row, at = (rows[0, j], 0) if j < 2 else (rows[1, j], 1)
        swept = cage * (turned[0, j] if j < 2 else turned[1, j])
        if j >= 2:
            r, r_rate = w[2, 1] * row + w[2, 3] * swept, w[2, 3] * row
            for i in range(2):
                stiffness[i, j] += rows[0, i] * r
                damping[i, j] += rows[0, i] * r_rate
        z, m = w[3, at] * row + w[3, 2 + at] * swept, w[4, at] * row + w[4, 2 + at] * swept
        z_rate, m_rate = w[3, 2 + at] * row, w[4, 2 + at] * row
        for i in range(2, moving):
            stiffness[i, j] += rows[1, i] * z + rows[2, i] * m
            damping[i, j] += rows[1, i] * z_rate + rows[2, i] * m_rate


@jit_exact_node
def _reach(balls, films, k):
    """Distance of the groove centres at which ball `k` touches both races, by more than rounding [m]."""
    g, heights = balls.grooves, films.heights
    return (g.inner + g.outer - (heights[2 * k, HEIGHT] + heights[2 * k + 1, HEIGHT])) * (1.0 + 10.0 * SINGULAR)


@inner
@jit_exact_loop
def _balance_lost_ball(balls, omega, row, films, k, c, gain, moving):
    """`balance_ball`, of a ball that finds no balance from where it is: from elsewhere, then by a search."""
    known = np.isfinite(films.place[k, 0])
    for attempt in range(1 if known else 0, 3):
        if gain > 0.0:
            if attempt == 2:
                search_ball(balls, omega, row, films, k, c, gain)
            else:
                place_ball(balls, k, c, films)
        else:
            if attempt == 2 or not np.isfinite(films.place[k, 0]):
                place_ball(balls, k, c, films)
            if not seek_ball(balls, omega, row, films, k, c):
                continue
        if balance_ball(balls, omega, row, films, k, c, gain, moving):
            return True
    return False


@jit_exact_called_node
def press_balls(balls, films, q, v, gain, out):
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
    still = gain == 0.0 and omega == 0.0 and balls.inner.x.size == 0
    for k in range(balls.number):
        rows, turned = films.maps[k, 0], films.maps[k, 1]
        c = _groove_centre(balls, films, k, q, v, cage)
        if still and np.hypot(c[0], c[1]) <= _reach(balls, films, k):  # between both races, without films
            place_ball(balls, k, c, films)
            films.force[k] = 0.0
            continue
        if gain > 0.0:
            move_on(films, k)
        done = np.isfinite(films.place[k, 0]) and balance_ball(balls, omega, row, films, k, c, gain, q.size)
        done = done or _balance_lost_ball(balls, omega, row, films, k, c, gain, q.size)
        if not done:
            force[:] = nan
            if gain == 0.0:
                films.place[k] = nan
            return
        _add_ball(rows, turned, cage, films.tangents, q.size, out)
    apply_loss(films.loss, force, stiffness, damping)


@jit_exact_called_node
def accept_balls(balls, films, gain):
    """Move all films, balls and the cage to the end of the step, with the ring where `press_balls` was last."""
    g, omega = balls.grooves, films.omega[0]
    rolling_speed = max(omega, balls.speeds[0])
    row = row_of_speed(balls.speeds, rolling_speed)
    carried, turned, free = 0.0, 0.0, 0.0
    for k in range(balls.number):
        b_r, b_z = films.place[k, 0], films.place[k, 1]
        c_r, c_z, d_r, d_z = films.tried[k, 0], films.tried[k, 1], films.tried[k, 2], films.tried[k, 3]
        at = rolls(balls, b_r, b_z, c_r, c_z)
        kept = films.kept[k]
        v_r, v_z = gain * (b_r - kept[PLACE_HISTORY, 0]), gain * (b_z - kept[PLACE_HISTORY, 1])
        i, o, heights = 2 * k, 2 * k + 1, films.heights
        rate_i = at.cos_i * (d_r - v_r) + at.sin_i * (d_z - v_z) + heights[i, HEIGHT_RATE]
        rate_o = at.cos_o * v_r + at.sin_o * v_z + heights[o, HEIGHT_RATE]
        film, u = films.film, films.speed_sum
        u_i, u_o = at.l_i - (g.inner - heights[i, HEIGHT]), at.l_o - (g.outer - heights[o, HEIGHT])
        film_i, film_o = film_of(films, i), film_of(films, o)
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
            c = c_r, c_z, d_r, d_z
            renew_slopes(balls, omega, (b_r, b_z), c, (0.0, 0.0), (0.0, 0.0), films.slopes[k])
    films.steps[0] += 1
    films.turned[0, ANGLE_LAST] = films.turned[0, ANGLE_NOW]
    keep_heights(balls, films)
    cage = films.cage
    cage[1], cage[3], cage[2] = cage[0], cage[2], turned / carried if carried > 0.0 else free
    films.omega[1] = omega
    accept_loss(films.loss)


@jit_exact_loop
def rest_balls(balls, films, q, out):
    """Put balls, films and cage at rest with the ring at `q`; its force on the balls is left in `out`."""
    still, omega = out[3], films.omega[0]
    still[:] = 0.0
    press_balls(balls, films, q, still, 0.0, out[:3])
    if not np.isfinite(out[0][0]):
        return
    g, heights = balls.grooves, films.heights
    films.state[:] = 0.0
    carried, turned, free = 0.0, 0.0, 0.0
    for k in range(balls.number):
        b_r, b_z, i, o = films.place[k, 0], films.place[k, 1], 2 * k, 2 * k + 1
        c = films.tried[k, 0], films.tried[k, 1], 0.0, 0.0
        at = rolls(balls, b_r, b_z, c[0], c[1])
        factors = film_factors(g, at)
        for j in range(3):
            films.film[i, j], films.film[o, j] = factors
            films.speed_sum[i, j], films.speed_sum[o, j] = at.u_i, at.u_o
        films.orbit[k], films.turned[1 + k, ANGLE_RATE] = at.orbit, at.ball_rotation
        if omega > 0.0:  # of steps, in which films are known beforehand
            renew_slopes(balls, omega, (b_r, b_z), c, (0.0, 0.0), (0.0, 0.0), films.slopes[k])
        films.state[i, APPROACH] = at.l_i - (g.inner - heights[i, HEIGHT])
        films.state[o, APPROACH] = at.l_o - (g.outer - heights[o, HEIGHT])
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


@jit_exact_loop
def describe_balls(balls, films, found, geometric):
    """Quantities of all balls (balls, ENTRIES) where they were balanced last, at rest.

    `geometric`, shape (balls, 5, 4), gets what `renew_slopes` has with both contact forces and films.
    """
    omega = films.omega[0]
    row = row_of_speed(balls.speeds, max(omega, balls.speeds[0]))
    for k in range(balls.number):
        b_r, b_z, c = films.place[k, 0], films.place[k, 1], (films.tried[k, 0], films.tried[k, 1], 0.0, 0.0)
        now = press_ball(balls, omega, row, films, k, c, 0.0, b_r, b_z)
        at, own, heights = now.at, found[k], films.heights
        own[ANGLE], own[ANGLE + 1] = np.arctan2(at.sin_i, at.cos_i), np.arctan2(at.sin_o, at.cos_o)
        own[LOAD], own[LOAD + 1] = now.f_i, now.f_o
        own[CLOSER] = now.l_i - (balls.grooves.inner - heights[2 * k, HEIGHT])
        own[CLOSER + 1] = now.l_o - (balls.grooves.outer - heights[2 * k + 1, HEIGHT])
        own[SLOPE], own[SLOPE + 1] = now.k_i, now.k_o
        own[FILM], own[FILM + 1] = film_factors(balls.grooves, at)
        own[SPEED_SUM], own[SPEED_SUM + 1] = at.u_i, at.u_o
        own[ORBIT], own[OWN_ROTATION] = at.orbit, at.ball_rotation
        own[AXIS_ANGLE] = np.arctan2(at.sin_b, at.cos_b)
        by_film = now.film_i, now.film_o
        renew_slopes(balls, omega, (b_r, b_z), c, (now.f_i, now.f_o), by_film, geometric[k])
