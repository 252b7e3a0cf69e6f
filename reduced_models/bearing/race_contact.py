"""Time step of one ball on one race, compiled: force at its end, with derivatives by approach and rate.

The equations are those of `reduced_models.elements.film_law` without saturation of the inlet. The filters are then
linear in the own rate e at the end of the step and the travel t of the approach. `prepare_filters` reduces them,
once per step, to two times three numbers for each of two nodes of the gains,

    m = m_0 + m_e e + m_t t + (q_0 + q_e e + q_t t)/G,

the second for what the chain holds of earlier films and of the middle of the step, with G, the film that the inlet
makes, at the load of the end. So `contact_force`, which every iteration calls, evaluates the curve g(u) and a few
products. The length of the step in own time, and G of the film made within the step, have to be known before its
end: they are taken at the middle, extrapolated from the start. `film_step` of the elements takes the mean of both
ends. Both are of second order.
"""

from __future__ import annotations

from math import log, sqrt

from ehlcontact.jit import inner, jit_exact_called_node, jit_exact_loop, jit_exact_node
from reduced_models.bearing.race_table import CELLS
from reduced_models.elements.film_curve import RIGID_SLOPE
from reduced_models.elements.film_filters import (
    CHAIN,
    DIRECT,
    FAST,
    FEW,
    INLET,
    chain_moments,
    lag_moments,
    pass_on,
    poisson_shares,
)
from reduced_models.elements.film_law import interval
from reduced_models.elements.film_speed import FILM_GROWTH

# Entries of a state before those of its filters; the last one, behind the chain, is the film that enters it.
APPROACH, RATE, OWN_RATE = range(3)
# Entries of the work of a step: inlet, fast and middle of the film made as sums of 1, e and t; the sums of
# two rows of gains, and of what the chain carries; then, of all lags, what they hold, what they make of the film
# at the end, and of the hump.
S, Y, MIDDLE, ROW, NEXT, CARRIED, NEXT_CARRIED, HELD = 0, 3, 6, 9, 12, 15, 18, 21
WORK = HELD  # entries before those of the lags
MOST_STEPS = 100  # of Newton's method for the film of a contact: a handful
FOUND = 1e-7  # of g, its last step: what that leaves is of its square


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


@jit_exact_called_node
def curve(u, row, weight, law, k):
    """Dry compression g [m] at approach `u` and its slope, `weight` from one `row` of speeds to the next.

    `k` is where to begin to look for the interval of u; that found is returned too.
    """
    if law.x.size == 0:
        return max(u, 0.0), 1.0 if u > 0.0 else 0.0, 0
    g, slope, k = _at(u, law, row, k)
    if weight > 0.0:
        other, other_slope, _ = _at(u, law, row + 1, k)
        g += weight * (other - g)
        slope += weight * (other_slope - slope)
    return g, slope, k


@jit_exact_node
def _at(u, law, row, k):
    """Table of one speed."""
    nodes, cells, last = law.u, law.cells, law.x.size - 2
    while k > 0 and u < nodes[row, k]:
        k -= 1
    while k < last and u >= nodes[row, k + 1]:
        k += 1
    start = nodes[row, k]
    if u < start:  # wider than the table: F like h^-1/2
        g = cells[row, 0, 0, 0] * (u / start) ** (2.0 / 3.0 / RIGID_SLOPE)
        return g, g / u * (2.0 / 3.0 / RIGID_SLOPE), k
    per_u = CELLS / (nodes[row, k + 1] - start)
    t = (u - start) * per_u
    j = min(int(t), CELLS - 1)
    t -= j
    a, b, c, d = cells[row, k, j, 0], cells[row, k, j, 1], cells[row, k, j, 2], cells[row, k, j, 3]
    if t > 1.0 and k == last:  # an iteration went too far: straight on
        slope = b + 2.0 * c + 3.0 * d
        return a + b + c + d + slope * (t - 1.0), slope * per_u, k
    return a + t * (b + t * (c + t * d)), (b + t * (2.0 * c + 3.0 * d * t)) * per_u, k


@jit_exact_node
def film_curve(u, film, row, weight, law, k):
    """As `curve`, for a film that is not that of the table.

    With g(v) of the table, whose film is g(v) - v, a film that is f times as thick at the same force is right
    where (1 - f) g(v) + f v = u.

    Parameters
    ----------
    film : (float, float) or None
        f, and a guess of v - u; None: the film of the table.

    Returns
    -------
    tuple
        g, its slopes by u and by f, v - u, the interval.
    """
    if film is None or law.x.size == 0:
        g, slope, k = curve(u, row, weight, law, k)
        return g, slope, 0.0, 0.0, k
    f, lift = film
    v, g, slope, stretch = u + lift, 0.0, 1.0, 1.0
    for _ in range(MOST_STEPS):
        g, slope, k = curve(v, row, weight, law, k)
        if f == 1.0:
            return g, slope, slope * (g - v), v - u, k
        stretch = (1.0 - f) * slope + f
        step = (u - (1.0 - f) * g - f * v) / stretch
        v, g = v + step, g + slope * step
        if abs(step) <= FOUND * g:
            break
    return g, slope / stretch, slope * (g - v) / stretch, v - u, k


@jit_exact_node
def gain(law, speed_row, node, k):
    """Gain `k` at a node of the load, between two speeds."""
    row, weight = speed_row
    found = law.gains[row, node, k]
    if weight > 0.0:
        found += weight * (law.gains[row + 1, node, k] - found)
    return found


@jit_exact_node
def _made_at(law, speed_row, node):
    """As `film_made`, at a node of the load."""
    row, weight = speed_row
    found = law.film_made[row, node]
    if weight > 0.0:
        found += weight * (law.film_made[row + 1, node] - found)
    return found


@jit_exact_called_node
def film_made(law, speed_row, x):
    """Film that a unit of the inlet's state lets into the chain at x = ln F."""
    last = law.x.size - 2
    k = min(
        max(int((x - law.x[0]) / (law.x[last + 1] - law.x[0]) * last), 0), last
    )  # near it: nodes are nearly even
    while k > 0 and x < law.x[k]:
        k -= 1
    while k < last and x > law.x[k + 1]:
        k += 1
    here = _made_at(law, speed_row, k)
    weight = min(max((x - law.x[k]) / (law.x[k + 1] - law.x[k]), 0.0), 1.0)
    return here + weight * (_made_at(law, speed_row, k + 1) - here)


@jit_exact_called_node
def film_cutoff(u, cutoff_gap):
    """Share of its force that a film carries at approach `u`, and its slope."""
    gap = -u / cutoff_gap
    if gap <= 0.5:
        return 1.0, 0.0
    if gap >= 1.0:
        return 0.0, 0.0
    t = 2.0 * gap - 1.0
    return 1.0 - t * t * (3.0 - 2.0 * t), 12.0 * t * (1.0 - t) / cutoff_gap


@jit_exact_node
def prepare_filters(law, transit, speed_row, film, dt, films, c):
    """Reduce the filters of contact `c` over a step of length `dt`.

    `transit` is 2a/u_sum over sqrt(g), `speed_row` the row of speeds and the weight of the next, `film` as in
    `film_curve`.
    """
    state, work, poisson, share = films.state, films.work, films.poisson, films.share
    if law.x.size == 0:
        return
    ahead = state[c, APPROACH] + 0.5 * dt * state[c, RATE]
    interval = films.interval[c, 0]
    middle, _, _, _, films.interval[c, 0] = film_curve(ahead, film, speed_row[0], speed_row[1], law, interval)
    span = dt / (transit * sqrt(middle))
    p, start, inlet = law.inlet_rate, state[c, OWN_RATE], state[c, INLET]
    s_a, s_e, s_t = _lag(inlet, start, p, span)
    work[c, S], work[c, S + 1], work[c, S + 2] = s_a, s_e, s_t
    work[c, Y], work[c, Y + 1], work[c, Y + 2] = _lag(state[c, FAST], start, law.fast_rate, span)
    # the film that enters is that of both ends, and a hump that keeps its mean: G of the middle times
    # (t - (s - s_0)/p)/span
    lags = law.gains.shape[2] - DIRECT
    entered, mu = state[c, CHAIN + lags], law.lag_rate * span
    made = film_made(law, speed_row, law.log_kn + 1.5 * log(middle))
    work[c, MIDDLE] = -made * (s_a - inlet) / (p * span) - 0.5 * entered
    work[c, MIDDLE + 1], work[c, MIDDLE + 2] = -made * s_e / (p * span), made * (1.0 - s_t / p) / span
    poisson_shares(mu, lags + 2, FEW, poisson, share)
    per_mu = 1.0 / mu
    for j in range(lags):
        r0, r1, r2 = chain_moments(j + 1, per_mu, share)
        work[c, HELD + j], work[c, HELD + lags + j] = entered * r1, r0 - r1
        work[c, HELD + 2 * lags + j] = 6.0 * (r1 - r2)
    pass_on(state[c, CHAIN : CHAIN + lags], poisson, work[c, HELD : HELD + lags])
    films.interval[c, 1] = -1


@jit_exact_node
def _lag(old, start, rate, span):
    """One lag at the end of a step that travels t at an own rate from `start` to e: its sums of 1, e and t."""
    kept, r0, r1, r2 = lag_moments(rate * span, FEW)
    hump = r1 - r2
    return old * kept + start * (r1 - 3.0 * hump), r0 - r1 - 3.0 * hump, 6.0 * hump / span


@jit_exact_node
def _weigh(law, speed_row, node, work, c):
    """Sums of the gains of `node` and of the next over all filters."""
    held, ends, humps, lags = 0.0, 0.0, 0.0, law.gains.shape[2] - DIRECT
    next_held, next_ends, next_humps = 0.0, 0.0, 0.0
    for j in range(lags):
        here, after = gain(law, speed_row, node, DIRECT + j), gain(law, speed_row, node + 1, DIRECT + j)
        holds, end, hump = work[c, HELD + j], work[c, HELD + lags + j], work[c, HELD + 2 * lags + j]
        held, next_held = held + here * holds, next_held + after * holds
        ends, next_ends = ends + here * end, next_ends + after * end
        humps, next_humps = humps + here * hump, next_humps + after * hump
    _add(law, speed_row, node, work, c, (ROW, CARRIED), (held, ends, humps))
    _add(law, speed_row, node + 1, work, c, (NEXT, NEXT_CARRIED), (next_held, next_ends, next_humps))


@jit_exact_node
def _add(law, speed_row, node, work, c, to, chain):
    """Sums of one node from those of its chain."""
    at, carried = to
    held, ends, humps = chain
    inlet, fast = gain(law, speed_row, node, 1) + ends - 0.5 * humps, gain(law, speed_row, node, 2)
    for k in range(3):
        work[c, at + k] = inlet * work[c, S + k] + fast * work[c, Y + k]
        work[c, carried + k] = humps * work[c, MIDDLE + k]
    work[c, at + 1] += gain(law, speed_row, node, 0)
    work[c, carried] += held


@jit_exact_node
def contact_force(law, transit, speed_row, film, films, c, u, v):
    """Force [N] at approach `u` [m] and rate `v` [m/s] of the end of the step, dF/du, dF/dv and dF/df.

    f is the film over that of the table. With filters that are cleared it is the static force.
    """
    work = films.work
    g, g_u, g_f, _, k = film_curve(u, film, speed_row[0], speed_row[1], law, films.interval[c, 0])
    films.interval[c, 0] = k
    root = sqrt(g)
    if law.x.size == 0:
        return law.kn * g * root, 1.5 * law.kn * root * g_u, 0.0, 0.0
    x = law.log_kn + 1.5 * log(g)
    while k > 0 and x < law.x[k]:
        k -= 1
    while k < law.x.size - 2 and x > law.x[k + 1]:
        k += 1
    if k != films.interval[c, 1]:
        _weigh(law, speed_row, k, work, c)
        films.interval[c, 1] = k
    per_x = 1.0 / (law.x[k + 1] - law.x[k])
    weight = (x - law.x[k]) * per_x
    tau = transit * root
    e, t = tau * v, u - films.state[c, APPROACH]
    m0, me, mt = work[c, ROW], work[c, ROW + 1], work[c, ROW + 2]
    step_e, step_t = work[c, NEXT + 1] - me, work[c, NEXT + 2] - mt
    step = work[c, NEXT] - m0 + step_e * e + step_t * t
    me, mt = me + weight * step_e, mt + weight * step_t
    # what the chain carries, in shares of the film made at this load
    here, there = _made_at(law, speed_row, k), _made_at(law, speed_row, k + 1)
    per_made = 1.0 / (here + weight * (there - here))
    q0, qe, qt = work[c, CARRIED], work[c, CARRIED + 1], work[c, CARRIED + 2]
    more_e, more_t = work[c, NEXT_CARRIED + 1] - qe, work[c, NEXT_CARRIED + 2] - qt
    more = work[c, NEXT_CARRIED] - q0 + more_e * e + more_t * t
    qe, qt = qe + weight * more_e, qt + weight * more_t
    carried = per_made * (q0 + weight * (work[c, NEXT_CARRIED] - q0) + qe * e + qt * t)
    step += per_made * (more - carried * (there - here))
    w = g + m0 + weight * (work[c, NEXT] - m0) + me * e + mt * t + carried
    me, mt = me + per_made * qe, mt + per_made * qt
    if w <= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    bent = 0.5 * me * e + 1.5 * per_x * step
    w_u = g_u + mt + bent * g_u / g
    root = sqrt(w)
    force, slope = law.kn * w * root, 1.5 * law.kn * root
    share, share_u = film_cutoff(u, law.cutoff_gap)
    by_u, by_f = share * slope * w_u + share_u * force, share * slope * (g_f + bent * g_f / g)
    return share * force, by_u, share * slope * me * tau, by_f


@jit_exact_node
def accept_contact(law, transit, speed_row, film, films, c, u, v):
    """Move the state of contact `c` to the end of the step, at approach `u` and rate `v`.

    Returns v - u of `film_curve`, a guess for the next step.
    """
    state, work = films.state, films.work
    t = u - state[c, APPROACH]
    state[c, APPROACH], state[c, RATE] = u, v
    if law.x.size == 0:
        return 0.0
    interval = films.interval[c, 0]
    g, _, _, lift, films.interval[c, 0] = film_curve(u, film, speed_row[0], speed_row[1], law, interval)
    e = transit * sqrt(g) * v
    s = work[c, S] + work[c, S + 1] * e + work[c, S + 2] * t
    entered = s * film_made(law, speed_row, law.log_kn + 1.5 * log(g))
    hump = work[c, MIDDLE] + work[c, MIDDLE + 1] * e + work[c, MIDDLE + 2] * t - 0.5 * entered
    state[c, OWN_RATE], state[c, INLET] = e, s
    state[c, FAST] = work[c, Y] + work[c, Y + 1] * e + work[c, Y + 2] * t
    lags = law.gains.shape[2] - DIRECT
    for j in range(HELD, HELD + lags):
        state[c, CHAIN + j - HELD] = work[c, j] + work[c, j + lags] * entered + work[c, j + 2 * lags] * hump
    state[c, CHAIN + lags] = entered
    return lift


@inner
@jit_exact_loop
def clear_filters(films):
    """Clear what the filters add, so that `contact_force` gives the static force."""
    films.work[:] = 0.0
    films.interval[:, 1] = -1
