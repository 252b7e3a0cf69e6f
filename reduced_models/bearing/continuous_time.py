"""Balls and films of a bearing in continuous time, compiled: rates of the states of `ball_states`, for any motion.

Both contacts of a ball have the force

    F = share k_n (g(u) + c tau u' + sum g_j x_j)_+^(3/2)

with g_j/G for the states of the chain (`film_law`).
A ball without inertia has its rate b' from the balance of both contact forces along their normals, centrifugal
force and friction that turns its axis: the minimum of a convex function, for both forces rise with their rates.
Along the outer contact that rate lies above the one at which this contact lets go, and below the one at which the
inner contact does or the outer one carries all other forces. A ball with inertia m has b' as a state. Between
rings that are held along the shaft and cannot tilt a ball moves along its outer contact alone.

Films follow the angles and speeds of their ball at once; the cage turns at the mean speed of the balls by their
loads, as in steps. Places are counted from rest, so that small changes keep their digits.
"""

from __future__ import annotations

from math import cos, inf, log, nan, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.jit import jit_exact
from reduced_models.bearing.ball import Balls
from reduced_models.bearing.contact_angles import ball_forces, film_factors, inner_span, rolling
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.race_contact import curve, film_curve, film_cutoff, film_made, gain, row_of_speed
from reduced_models.elements.film_filters import DIRECT, filter_rates
from reduced_models.elements.film_law import interval

_Floats = NDArray[np.float64]

FREEDOMS = len(FIVE)
SMALL_STEP = 1e-14  # of the rates, that ends the search for w': rounding
MOST_STEPS = 60  # of it: a handful
CAGE_ROUNDS = 3  # evaluations that find the speed of a cage and the forces that it depends on, a thousandth each
BALANCED = 1e-12  # imbalance of a ball across its contacts over its forces, below which only rounding is left


@jit_exact
def _held(law, transit, speed_row, film, u, states, first):
    """Film without its dashpot [m], dashpot c tau [s], k_n that the film carries, own time [s], film G made.

    `film` as in `film_curve`.
    """
    g, _, _, _, _ = film_curve(u, film, speed_row[0], speed_row[1], law, 0)
    if law.x.size == 0:
        return g, 0.0, law.kn, 0.0, 1.0
    tau, x, last = transit * sqrt(g), law.log_kn + 1.5 * log(g), law.x.size - 2
    row = min(max(interval(law.x, x), 0), last)
    weight = min(max((x - law.x[row]) / (law.x[row + 1] - law.x[row]), 0.0), 1.0)
    film, carried, dashpot, made = g, 0.0, 0.0, film_made(law, speed_row, x)
    for j in range(law.gains.shape[2]):
        low, high = gain(law, speed_row, row, j), gain(law, speed_row, row + 1, j)
        here = low + weight * (high - low)
        if j == 0:
            dashpot = here * tau
        elif j < DIRECT:
            film += here * states[first + j - 1]
        else:
            carried += here * states[first + j - 1]
    return film + carried / made, dashpot, law.kn * film_cutoff(u, law.cutoff_gap)[0], tau, made


@jit_exact
def _pushed(kn, film):
    """Force and its slope by the film."""
    if film <= 0.0:
        return 0.0, 0.0
    root = sqrt(film)
    return kn * film * root, 1.5 * kn * root


@jit_exact
def _balance(inner, outer, rate, centrifugal):
    """Force on the ring and w' of a ball whose contacts are (film, dashpot, k_n, own time, film made)."""
    (ai, di, ki, _, _), (ao, do, ko, _, _) = inner, outer
    if ko <= 0.0:  # nothing at the outer race: the ball stays where it is if nothing presses it outward
        force = _pushed(ki, ai + di * rate)[0]
        return (0.0, 0.0) if force + centrifugal == 0.0 else (nan, nan)
    low = -ao / do
    high = max(rate + ai / di, ((centrifugal / ko) ** (2.0 / 3.0) - ao) / do)
    alike = (ki / ko) ** (2.0 / 3.0)
    z = (alike * (ai + di * rate) - ao) / (do + alike * di)
    scale = SMALL_STEP * (abs(ao) / do + abs(ai) / di)
    for _ in range(MOST_STEPS):
        z = min(max(z, low), high)
        fi, si = _pushed(ki, ai + di * (rate - z))
        fo, so = _pushed(ko, ao + do * z)
        off, slope = fo - fi - centrifugal, so * do + si * di
        if off > 0.0:
            high = z
        else:
            low = z
        step = -off / slope if slope > 0.0 else 0.5 * (high - low)
        if not low <= z + step <= high:
            step = 0.5 * (low + high) - z
        z += step
        if abs(step) <= scale:
            break
    return _pushed(ki, ai + di * (rate - z))[0], z


class RestingBalls(NamedTuple):
    """Balls at contact angles at rest, from which their states are counted."""

    place: _Floats  # (balls, 2) b [m]
    moved: _Floats  # (balls, 2) inner groove centre from its free place [m]
    across: _Floats  # (balls,) damping across the outer contact [N s/m]
    inertia: float  # of a ball [kg]; 0: it has none


@jit_exact
def _rates_in_balance(inner, outer, normal, moving, pushed, across):
    """Rates of a ball along and across its outer contact at which its forces balance; not a number without any.

    The inner contact has the `normal` (cos, sin) there, the inner groove centre moves at `moving`, and `pushed`
    are the forces beside those of the contacts. At every rate across there is one along.
    """
    (ai, di, ki, _, _), do, (c, s) = inner, outer[1], normal
    seen = ai, c * di, c * ki, 0.0, 1.0  # the inner contact, along the outer one
    low, high, t, p, last = -inf, inf, 0.0, 0.0, inf
    for _ in range(2 * MOST_STEPS):
        rate = moving[0] + s / c * (moving[1] - t)
        force, p = _balance(seen, outer, rate, max(pushed[0], 0.0))
        off = pushed[1] + s / c * force - across * t
        if not abs(off) < inf:
            return nan, nan
        if off == 0.0 or (abs(off) > 0.5 * last and abs(off) <= BALANCED * (force + abs(pushed[0]))):
            break
        last = abs(off)
        if off > 0.0:
            low = t
        else:
            high = t
        a = _pushed(ki, ai + c * di * (rate - p))[1] * di
        b = _pushed(outer[2], outer[0] + do * p)[1] * do
        both = c * c * a + b
        step = off / (across + (a * b * s * s / both if both > 0.0 else 0.0))
        if t + step == t:
            break
        if not low < t + step < high:
            step = 0.5 * (low + high) - t
        t += step
    return p, t


@jit_exact
def _ring_map(g, psi, out):
    """Rows by which the ring's displacement moves c_r and c_z, and its tilt follows a moment: (3, 5)."""
    c, s = cos(psi), sin(psi)
    out[:] = 0.0
    out[0, 0], out[0, 1] = c, s
    out[1, 2], out[1, 3], out[1, 4] = 1.0, g.groove_circle * s, -g.groove_circle * c
    out[2, 3], out[2, 4] = -s, c


@jit_exact
def bearing_rates(balls, rest, angle, cage, states, q, v, rates, force):
    """Fill the rates of all balls' states and the force of the ring at `q`, moving at `v`, on the balls.

     The ring moves in the first n directions, `q` and `v` have shape (n,). The first ball is at `angle` [rad], and
    the  cage turns at `cage` [rad/s]; returned is the speed at which the balls would turn it.
    """
    g, omega, inertia = balls.grooves, balls.omega, rest.inertia
    places = 1 if q.size == 2 else 2  # of a ball: along and across its outer contact
    wet, first = balls.inner.x.size > 0, 2 * places if inertia > 0.0 else places
    rolling_speed = max(omega, balls.speeds[0])
    row = row_of_speed(balls.speeds, rolling_speed)
    size_i = balls.inner.gains.shape[2] - 1 if wet else 0
    size_o = balls.outer.gains.shape[2] - 1 if wet else 0
    rows, turned = np.zeros((3, FREEDOMS)), np.zeros((2, FREEDOMS))
    force[:] = 0.0
    carried, driven, free = 0.0, 0.0, 0.0
    for k in range(balls.number):
        psi, at = angle + 2.0 * pi * k / balls.number, k * (first + size_i + size_o)
        _ring_map(g, psi, rows)
        turned[0, 0], turned[0, 1] = -sin(psi), cos(psi)
        turned[1, 3], turned[1, 4] = g.groove_circle * cos(psi), g.groove_circle * sin(psi)
        m_r, m_z, d_r, d_z = 0.0, 0.0, 0.0, 0.0
        for j in range(q.size):
            m_r += rows[0, j] * q[j]
            m_z += rows[1, j] * q[j]
            d_r += rows[0, j] * v[j] + cage * turned[0, j] * q[j]
            d_z += rows[1, j] * v[j] + cage * turned[1, j] * q[j]
        # at rest: ball, inner groove centre, both springs; along and across the outer one are the states
        rest_r, rest_z = rest.place[k, 0], rest.place[k, 1]
        from_r, from_z = rest.moved[k, 0], rest.moved[k, 1]
        s_r, s_z = g.radial + from_r - rest_r, g.axial + from_z - rest_z
        rest_o, rest_i = sqrt(rest_r * rest_r + rest_z * rest_z), sqrt(s_r * s_r + s_z * s_z)
        e_r, e_z, w = rest_r / rest_o, rest_z / rest_o, states[at]
        a = states[at + 1] if places == 2 else 0.0
        x_r, x_z = e_r * w - e_z * a, e_z * w + e_r * a
        m_r, m_z = m_r - from_r, m_z - from_z
        y_r, y_z = m_r - x_r, m_z - x_z
        b_r, b_z = rest_r + x_r, rest_z + x_z
        c_r, c_z = g.radial + from_r + m_r, g.axial + from_z + m_z
        l_i, n_r, n_z = inner_span(b_r, b_z, c_r, c_z)
        l_o = sqrt(b_r * b_r + b_z * b_z)
        u_o = rest_o - g.outer + (2.0 * rest_o * w + w * w + a * a) / (l_o + rest_o)
        u_i = rest_i - g.inner + (2.0 * (s_r * y_r + s_z * y_z) + y_r * y_r + y_z * y_z) / (l_i + rest_i)
        # between both normals: b x c
        across = rest_r * s_z - rest_z * s_r + (x_r * c_z - x_z * c_r) + (rest_r * m_z - rest_z * m_r)
        if c_r < b_r:  # beyond the groove, along its wall
            u_i, across = l_i - g.inner, b_r * n_z - b_z * n_r
        o_r, o_z, sine = b_r / l_o, b_z / l_o, across / (l_i * l_o)
        normal = (b_r * n_r + b_z * n_z) / (l_i * l_o), sine
        dry_i, dry_o = curve(u_i, 0, 0.0, balls.inner, 0)[0], curve(u_o, 0, 0.0, balls.outer, 0)[0]
        rolls = rolling(g, b_r, b_z, c_r, c_z, dry_i, dry_o)
        film_i, film_o = film_factors(g, rolls)
        transit_i = balls.inner.contact_length_factor / (rolls.u_i * rolling_speed) if wet else 0.0
        transit_o = balls.outer.contact_length_factor / (rolls.u_o * rolling_speed) if wet else 0.0
        second = at + first + size_i
        inner = _held(balls.inner, transit_i, row, (film_i, 0.0), u_i, states, at + first)
        outer = _held(balls.outer, transit_o, row, (film_o, 0.0), u_o, states, second)
        r_r, r_z, p_r, p_z, moment = ball_forces(g, omega, rolls, 0.0, 0.0)
        pushed = o_r * r_r + o_z * r_z, o_r * r_z - o_z * r_r
        moving = o_r * d_r + o_z * d_z, o_r * d_z - o_z * d_r
        if inertia > 0.0:
            by_w, by_a = states[at + places], states[at + 3] if places == 2 else 0.0
            v_r, v_z = e_r * by_w - e_z * by_a, e_z * by_w + e_r * by_a
            along, aside = o_r * v_r + o_z * v_z, o_r * v_z - o_z * v_r
            f_i = _pushed(
                inner[2], inner[0] + inner[1] * (normal[0] * (moving[0] - along) + sine * (moving[1] - aside))
            )[0]
            net_p = pushed[0] + normal[0] * f_i - _pushed(outer[2], outer[0] + outer[1] * along)[0]
            net_t = pushed[1] + sine * f_i
            net_r, net_z = (o_r * net_p - o_z * net_t) / inertia, (o_z * net_p + o_r * net_t) / inertia
            rates[at + places] = e_r * net_r + e_z * net_z
            if places == 2:
                rates[at + 3] = e_r * net_z - e_z * net_r
        else:
            along, aside = _rates_in_balance(inner, outer, normal, moving, pushed, rest.across[k])
            v_r, v_z = o_r * along - o_z * aside, o_z * along + o_r * aside
        rates[at] = e_r * v_r + e_z * v_z
        if places == 2:
            rates[at + 1] = e_r * v_z - e_z * v_r
        rate_i = normal[0] * (moving[0] - along) + sine * (moving[1] - aside)
        f_i = _pushed(inner[2], inner[0] + inner[1] * rate_i)[0]
        if wet:
            at_i, at_o = slice(at + first, second), slice(second, second + size_o)
            filter_rates(balls.inner, inner[4] * states[at_i][0], inner[3], rate_i, states[at_i], rates[at_i])
            filter_rates(balls.outer, outer[4] * states[at_o][0], outer[3], along, states[at_o], rates[at_o])
        p_r, p_z = p_r + f_i * n_r / l_i, p_z + f_i * n_z / l_i
        for j in range(q.size):
            force[j] += rows[0, j] * p_r + rows[1, j] * p_z + rows[2, j] * moment
        carried, driven, free = carried + f_i, driven + f_i * rolls.orbit, free + rolls.orbit / balls.number
    return omega * (driven / carried if carried > 0.0 else free)


def rates_with_cage(
    balls: Balls,
    rest: RestingBalls,
    angle: float,
    states: _Floats,
    q: _Floats,
    v: _Floats,
    rates: _Floats,
    force: _Floats,
) -> float:
    """`bearing_rates` with the cage at the speed that the balls give it, which is returned [rad/s]."""
    cage = 0.0
    for _ in range(CAGE_ROUNDS):
        cage = float(bearing_rates(balls, rest, angle, cage, states, q, v, rates, force))
    return cage
