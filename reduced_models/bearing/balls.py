"""Balls of a planar bearing, compiled: force of the inner ring on all balls, two contacts in series at each.

The inner ring is at q, the outer one stands still; ball k at the angle psi_k with n = (cos, sin) psi_k lets both
rings come closer by

    delta = n . q - clearance/2,    split into w at the outer contact and delta - w at the inner one.

Along n, F_o(w) + m w'' = F_i(delta - w) + F_c with the centrifugal force F_c; balls have no inertia m there unless
it is asked for. So w is found from one scalar equation per ball, and the force of the ring on the balls is
F = sum F_i n. delta' includes the change of n by the speed of the cage. The loss factor of rings and fits (`loss`)
acts on F.
"""

from __future__ import annotations

from math import copysign, cos, inf, nan, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.jit import inner, jit_exact_called_node, jit_exact_loop, jit_exact_node
from reduced_models.bearing.contact_heights import (
    ANGLE_NOW,
    ANGLE_RATE,
    FILM_SLOPE,
    HEIGHT,
    HEIGHT_RATE,
    HEIGHTS,
    ROTATION,
    find_heights,
    full_film,
    keep_heights,
    rest_heights,
)
from reduced_models.bearing.loss import (
    Loss,
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
    prepare_filters,
)
from reduced_models.bearing.race_table import RaceForceTable
from reduced_models.elements.film_filters import CHAIN, DIRECT
from reduced_models.elements.film_law import interval
from reduced_models.elements.film_speed import FILM_GROWTH

_Floats = NDArray[np.float64]

# Imbalance of a ball, over its forces and 1 N, from which one step of Newton's method to first order ends the
# search: what that leaves is of its square
NEARLY = 1e-7
MOST_STEPS = 60  # of that search: a handful, but where a ball lands
HALVES_FROM = 20  # every other step from this one on halves the bracket: Newton's can go to and fro in it for ever
FIRST_STEP = 1e-7  # [m], to a ball that nothing touches; doubled until a race is met
# Newton's first step, at most, and twice as far in each that follows [m]. A film that has nearly let go has hardly
# a slope, and would send a ball so deep into the other race, so fast, that its law has no force there any more.
FARTHEST = 1e-5

# Entries of a ball: its position w as tried last, what its rate follows from, w at the last two ends of steps;
# delta where that was tried, and the slope of w by it; what its acceleration follows from, and its rates at the
# last two ends of steps.
POSITION, POSITION_HISTORY, POSITION_NOW, POSITION_BEFORE, TRIED_DELTA, BY_DELTA = range(6)
RATE_HISTORY, RATE_NOW, RATE_BEFORE, BALL_ENTRIES = range(6, 10)


class Balls(NamedTuple):
    """A bearing as its kernels need it. Angular speeds in rad/s."""

    inner: RaceForceTable
    outer: RaceForceTable
    number: int
    half_clearance: float  # m
    cage: float  # speed of the cage over that of the shaft
    centrifugal_factor: float  # F_c over the square of the cage's speed [kg m]
    speed_sum: float  # u_sum over the speed of the shaft [m]
    speeds: _Floats  # (rows of the laws,) of the shaft, increasing
    loss: Loss  # of rings and fits
    inertia: float  # of a ball along n [kg]; 0: it has none
    heights: _Floats  # tables of features, see `contact_heights`


class SpeedState(NamedTuple):
    """Contacts, cage and centrifugal force at one speed of the shaft."""

    speed_row: tuple[int, float]  # row of the laws, and weight of the next
    inner: float  # 2a/u_sum over sqrt(g) [s/m^0.5]
    outer: float
    cage: float  # rad/s
    centrifugal: float  # N


class Films(NamedTuple):
    """States and work of a bearing in time: contacts 2 k (inner race) and 2 k + 1 of ball k; balls; loss."""

    state: _Floats
    work: _Floats
    interval: NDArray[np.int64]  # (contacts, 2): of the curve used last, and of the gains that `work` has
    poisson: _Floats  # room for `prepare_filters`
    share: _Floats
    balls: _Floats  # (balls, BALL_ENTRIES) place of each ball, the approach w at its outer race; entries above
    force: _Floats  # (balls, 2) at the inner and at the outer race [N]
    largest: _Floats  # (2,) force that any ball has had at either race [N]
    heights: _Floats  # (contacts, HEIGHTS) of features, see `contact_heights`
    turned: _Floats  # (1 + balls, 3) angles of the shaft and of all balls [rad], see there
    loss: Seat


def films_of(balls: Balls) -> Films:
    """States and work for all its contacts and balls and filters, all zero."""
    lags = max(law.gains.shape[2] for law in (balls.inner, balls.outer)) - DIRECT
    contacts = 2 * balls.number
    return Films(
        state=np.zeros((contacts, CHAIN + lags + 1)),  # the film that enters the chain behind it
        work=np.zeros((contacts, WORK + 3 * lags)),
        interval=np.zeros((contacts, 2), np.int64),
        poisson=np.zeros(lags + 3),
        share=np.zeros(lags + 3),
        balls=np.zeros((balls.number, BALL_ENTRIES)),
        force=np.zeros((balls.number, 2)),
        largest=np.zeros(2),
        heights=np.zeros((contacts, HEIGHTS)),
        turned=np.zeros((1 + balls.number, 3)),
        loss=loss_state_of(balls.loss),
    )


@inner
@jit_exact_loop
def row_of_speed(speeds, omega):
    """Row of the tables made at increasing `speeds` of the shaft, and weight of the next, at the speed `omega`.

    Above the highest speed the tables of that speed hold.
    """
    if speeds.size < 2:
        return 0, 0.0
    omega = min(omega, speeds[-1])
    row = min(max(interval(speeds, omega), 0), speeds.size - 2)
    low, high = speeds[row] ** FILM_GROWTH, speeds[row + 1] ** FILM_GROWTH
    return row, (omega**FILM_GROWTH - low) / (high - low)


@jit_exact_loop
def speed_state(balls, omega):
    """Laws, cage and centrifugal force at the shaft speed `omega`, at most the highest of the laws.

    Below the lowest of the laws, down to standstill, films are those of the lowest.
    """
    rolling = max(omega, balls.speeds[0])
    cage = balls.cage * omega
    u_sum = balls.speed_sum * rolling
    inner = balls.inner.contact_length_factor / u_sum if u_sum > 0.0 else 0.0
    outer = balls.outer.contact_length_factor / u_sum if u_sum > 0.0 else 0.0
    centrifugal = balls.centrifugal_factor * cage * cage
    return SpeedState(row_of_speed(balls.speeds, rolling), inner, outer, cage, centrifugal)


@jit_exact_loop
def directions(balls, angle, normals):
    """Unit vectors to the balls, the first at `angle` [rad]."""
    for k in range(balls.number):
        psi = angle + 2.0 * pi * k / balls.number
        normals[k, 0], normals[k, 1] = cos(psi), sin(psi)


@jit_exact_loop
def turn_planar(balls, angle, films, gain):
    """Turn shaft and balls with the first ball to `angle`, and find the heights that contacts meet there."""
    if balls.heights.shape[0] == 0:
        return
    turned = films.turned
    turned[0, ANGLE_NOW] = (angle - turned[0, ANGLE_RATE]) / balls.cage
    for k in range(balls.number):
        turned[1 + k, ANGLE_NOW] = balls.heights[0, 0, ROTATION] * turned[0, ANGLE_NOW]
    find_heights(balls, films, angle, gain)


@jit_exact_loop
def begin_step(balls, at_speed, dt, films):
    """Begin a step of length `dt`, as long as the one before; returns the gain from w to its rate (BDF 2)."""
    for k in range(balls.number):
        ball = films.balls[k]
        ball[POSITION_HISTORY] = (4.0 * ball[POSITION_NOW] - ball[POSITION_BEFORE]) / 3.0
        ball[RATE_HISTORY] = (4.0 * ball[RATE_NOW] - ball[RATE_BEFORE]) / 3.0
        prepare_filters(balls.inner, at_speed.inner, at_speed.speed_row, None, dt, films, 2 * k)
        prepare_filters(balls.outer, at_speed.outer, at_speed.speed_row, None, dt, films, 2 * k + 1)
    begin_loss(balls.loss, dt, films.loss)
    return 1.5 / dt


@jit_exact_loop
def begin_rest(films):
    """Prepare `press_balls` for the static law; returns the gain from w to its rate, 0."""
    clear_filters(films)
    hold_still(films.loss)
    return 0.0


@jit_exact_node
def _ball(balls, at_speed, films, k, delta, rate, gain):
    """Balance ball `k`; returns the force of the ring on it, its derivatives by delta and delta'.

    In a step the search begins where the ball would be if it moved on as in the last one, however often it is
    asked for: a film that lets go pulls and pushes, so a ball may have several balances, and which one is found
    must not depend on where the ring was tried before.
    """
    ball, heavy, row = films.balls[k], balls.inertia * gain, at_speed.speed_row
    h_i, up_i = films.heights[2 * k, HEIGHT], films.heights[2 * k, HEIGHT_RATE]
    h_o, up_o = films.heights[2 * k + 1, HEIGHT], films.heights[2 * k + 1, HEIGHT_RATE]
    history = ball[POSITION_HISTORY]
    if gain > 0.0:
        w = 2.0 * ball[POSITION_NOW] - ball[POSITION_BEFORE]
    else:
        w = ball[POSITION] + ball[BY_DELTA] * (delta - ball[TRIED_DELTA])
    low, high, reach, most = -inf, inf, FIRST_STEP, FARTHEST
    for count in range(MOST_STEPS):
        v = gain * (w - history)
        u_i, v_i, u_o, v_o = delta - w + h_i, rate - v + up_i, w + h_o, v + up_o
        fi, ki, di, _ = contact_force(balls.inner, at_speed.inner, row, None, films, 2 * k, u_i, v_i)
        fo, ko, do, _ = contact_force(balls.outer, at_speed.outer, row, None, films, 2 * k + 1, u_o, v_o)
        if films.heights[2 * k, FILM_SLOPE] > 0.0:
            fi, ki, di = full_film(films.heights[2 * k], delta - w)
        if films.heights[2 * k + 1, FILM_SLOPE] > 0.0:
            fo, ko, do = full_film(films.heights[2 * k + 1], w)
        inner, held = ki + gain * di, ko + gain * do
        outer = held + heavy * gain
        balance, tangent = fo + heavy * (v - ball[RATE_HISTORY]) - fi - at_speed.centrifugal, inner + outer
        if abs(balance) <= NEARLY * (1.0 + fo + fi + at_speed.centrifugal):
            if tangent > 0.0:
                step = -balance / tangent
                w, fi, fo = w + step, fi - inner * step, fo + held * step
                ball[BY_DELTA] = ki / tangent
                ki, di = ki * outer / tangent, di * outer / tangent
            ball[POSITION], ball[TRIED_DELTA] = w, delta
            films.force[k, 0], films.force[k, 1] = fi, fo
            return fi, ki, di
        if balance > 0.0:
            high = w
        else:
            low = w
        if tangent > 0.0:
            w -= copysign(min(abs(balance) / tangent, most), balance)
        else:  # nothing touches it
            w -= copysign(reach, balance)
            reach *= 2.0
        most *= 2.0
        halves = count >= HALVES_FROM and count % 2 == 0
        if low > -inf and high < inf and (halves or not low < w < high):
            w = 0.5 * (low + high)
    return nan, nan, nan


@jit_exact_called_node
def press_balls(balls, at_speed, films, normals, q, v, gain, out):
    """Force that the ring at `q`, moving at `v`, exerts on the balls, and its derivatives by both.

    They are written into `out`, arrays of shape (2,), (2, 2) and (2, 2). The step is that begun last, with its
    `gain`. Not a number where a ball finds no balance.
    """
    force, stiffness, damping = out
    force[:], stiffness[:], damping[:] = 0.0, 0.0, 0.0
    for k in range(balls.number):
        x, y = normals[k]
        delta = x * q[0] + y * q[1] - balls.half_clearance
        rate = x * v[0] + y * v[1] + at_speed.cage * (x * q[1] - y * q[0])
        f, by_delta, by_rate = _ball(balls, at_speed, films, k, delta, rate, gain)
        force[0] += f * x
        force[1] += f * y
        by_x, by_y = by_delta * x - by_rate * at_speed.cage * y, by_delta * y + by_rate * at_speed.cage * x
        stiffness[0, 0] += x * by_x
        stiffness[0, 1] += x * by_y
        stiffness[1, 0] += y * by_x
        stiffness[1, 1] += y * by_y
        damping[0, 0] += by_rate * x * x
        damping[0, 1] += by_rate * x * y
        damping[1, 0] += by_rate * x * y
        damping[1, 1] += by_rate * y * y
    apply_loss(films.loss, force, stiffness, damping)


@jit_exact_loop
def accept_balls(balls, at_speed, films, normals, q, v, gain):
    """Move all films and balls to the end of the step, with the ring where `press_balls` was called last."""
    for k in range(balls.number):
        x, y = normals[k]
        delta = x * q[0] + y * q[1] - balls.half_clearance
        rate = x * v[0] + y * v[1] + at_speed.cage * (x * q[1] - y * q[0])
        ball = films.balls[k]
        w = ball[POSITION]
        own = gain * (w - ball[POSITION_HISTORY])
        row = at_speed.speed_row
        inner, outer = films.heights[2 * k], films.heights[2 * k + 1]
        u_i, v_i = delta - w + inner[HEIGHT], rate - own + inner[HEIGHT_RATE]
        u_o, v_o = w + outer[HEIGHT], own + outer[HEIGHT_RATE]
        accept_contact(balls.inner, at_speed.inner, row, None, films, 2 * k, u_i, v_i)
        accept_contact(balls.outer, at_speed.outer, row, None, films, 2 * k + 1, u_o, v_o)
        ball[POSITION_BEFORE], ball[POSITION_NOW] = ball[POSITION_NOW], w
        ball[RATE_BEFORE], ball[RATE_NOW] = ball[RATE_NOW], own
        films.largest[0] = max(films.largest[0], films.force[k, 0])
        films.largest[1] = max(films.largest[1], films.force[k, 1])
    keep_heights(balls, films)
    accept_loss(films.loss)


@jit_exact_loop
def rest_balls(balls, films, normals, q):
    """Put all films at rest, with the ring at `q` where `press_balls` was called last."""
    films.state[:] = 0.0
    for k in range(balls.number):
        w = films.balls[k, POSITION]
        delta = normals[k, 0] * q[0] + normals[k, 1] * q[1] - balls.half_clearance
        films.state[2 * k, APPROACH] = delta - w + films.heights[2 * k, HEIGHT]
        films.state[2 * k + 1, APPROACH] = w + films.heights[2 * k + 1, HEIGHT]
        films.balls[k, POSITION_NOW:RATE_HISTORY], films.balls[k, RATE_HISTORY:] = w, 0.0
    rest_heights(films)
    rest_loss(films.loss)
