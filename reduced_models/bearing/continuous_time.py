"""Balls and films of a bearing in continuous time, compiled: rates of the states of `ball_states`, for any motion.

Both contacts of a ball have the force

    F = share k_n (g(u) + c tau u' + sum g_j x_j)_+^(3/2)

with g_j/G for the states of the chain (`film_law`).
A ball without inertia has F_o = F_i + F_c, from which w' follows: it lies above the rate at which the outer
contact lets go, and below the rate at which the inner one does or the outer one carries F_c alone. A ball with
inertia has w' as a state, and m w'' = F_i + F_c - F_o.
"""

from __future__ import annotations

from math import log, nan, sqrt

import numpy as np

from ehlcontact.jit import jit_exact
from reduced_models.bearing.race_contact import curve, film_cutoff, film_made, gain
from reduced_models.elements.film_filters import DIRECT, filter_rates

SMALL_STEP = 1e-14  # of the rates, that ends the search for w': rounding
MOST_STEPS = 60  # of it: a handful


@jit_exact
def _held(law, transit, speed_row, u, states, first):
    """Film without its dashpot [m], dashpot c tau [s], k_n that the film carries, own time [s], film G made."""
    g, _, _ = curve(u, speed_row[0], speed_row[1], law, 0)
    if law.x.size == 0:
        return g, 0.0, law.kn, 0.0, 1.0
    tau, x, last = transit * sqrt(g), law.log_kn + 1.5 * log(g), law.x.size - 2
    row = min(max(np.searchsorted(law.x, x) - 1, 0), last)
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


@jit_exact
def bearing_rates(balls, at_speed, normals, states, r, v, rates, force):
    """Fill the rates of all balls' states [m/s] and the force of the ring at `r`, moving at `v`, on the balls."""
    wet, first = balls.inner.x.size > 0, 2 if balls.inertia > 0.0 else 1
    size_i = balls.inner.gains.shape[2] - 1 if wet else 0
    size_o = balls.outer.gains.shape[2] - 1 if wet else 0
    force[:] = 0.0
    for k in range(balls.number):
        x, y, at = normals[k, 0], normals[k, 1], k * (first + size_i + size_o)
        delta = x * r[0] + y * r[1] - balls.half_clearance
        rate = x * v[0] + y * v[1] + at_speed.cage * (x * r[1] - y * r[0])
        w, second = states[at], at + first + size_i
        inner = _held(balls.inner, at_speed.inner, at_speed.speed_row, delta - w, states, at + first)
        outer = _held(balls.outer, at_speed.outer, at_speed.speed_row, w, states, second)
        if first == 2:
            own = states[at + 1]
            pushed = _pushed(inner[2], inner[0] + inner[1] * (rate - own))[0]
            held = _pushed(outer[2], outer[0] + outer[1] * own)[0]
            rates[at + 1] = (pushed + at_speed.centrifugal - held) / balls.inertia
        else:
            pushed, own = _balance(inner, outer, rate, at_speed.centrifugal)
        rates[at] = own
        if wet:
            at_i, at_o = slice(at + first, second), slice(second, second + size_o)
            filter_rates(balls.inner, 0.0, inner[4], inner[3], rate - own, states[at_i], rates[at_i])
            filter_rates(balls.outer, 0.0, outer[4], outer[3], own, states[at_o], rates[at_o])
        force[0] += pushed * x
        force[1] += pushed * y
