"""First-order lags of the film memory, compiled: over a step of any length, and in continuous time.

The filter of surface heights by a contact is another one: `reduced_models.bearing.height_tables`, `film_heights`.

Elements (`reduced_models.elements.film_law`) and bearings (``race_contact.c``) have the same
filters of the own rate i: an inlet lag s, a fast lag y, and a chain of lags q_1 ... which the film from the inlet
enters. Over a step of `span` in own time the input of a lag of rate p is

    i(t) = start + (end - start) t + 6 bump t (1 - t),    t from 0 to 1,

and the response of the lag at the end follows from its moments r_k: those to (1 - t)^k, with mu = p span.
"""

from __future__ import annotations

from math import exp

from ehlcontact.jit import jit_exact_node

INLET, FAST, CHAIN = range(3, 6)  # entries of a state of a step, behind three of its own; the chain is the rest
DIRECT = 3  # gains before those of the chain: viscous, inlet, fast
SHORTEST = 1e-100  # step over the lag, whose square is a number: a step of no length is none
FEW = 0.5  # mean of Poisson's law below which shares have to be summed: at it, differences lose two digits


@jit_exact_node
def lag_moments(mu, few):
    """Share of its state that one lag keeps over a step, and its moments r_0, r_1, r_2; below `few` by a sum."""
    kept = exp(-mu)
    if mu < SHORTEST:
        return kept, mu, 0.5 * mu, mu / 3.0
    if mu < few:  # or small differences would drown in rounding
        term, third, k = kept * mu * mu * mu / 6.0, 0.0, 4
        while term > 1e-17 * third:
            third += term
            term *= mu / k
            k += 1
        second = third + 0.5 * kept * mu * mu
        r0 = second + kept * mu
    else:
        r0 = 1.0 - kept
        second = r0 - kept * mu
        third = second - 0.5 * kept * mu * mu
    return kept, r0, second / mu, 2.0 * third / (mu * mu)


@jit_exact_node
def poisson_shares(mu, n, few, poisson, share):
    """Fill Poisson's weights of mean `mu`, and the share of what entered that k lags have passed on, to k = n.

    Below `few` shares are summed from the far end: each has full relative accuracy then, at twice the time.
    """
    weight, passed = exp(-mu), 1.0
    for k in range(n + 1):
        poisson[k], share[k] = weight, passed
        passed -= weight
        weight *= mu / (k + 1)
    if mu < few:  # or shares that are divided by mu would drown in rounding
        passed, k = 0.0, n
        while weight > 1e-17 * passed:
            passed += weight
            k += 1
            weight *= mu / (k + 1)
        for k in range(n, -1, -1):
            passed += poisson[k]
            share[k] = passed


@jit_exact_node
def chain_moments(j, per_mu, share):
    """Moments r_0, r_1, r_2 of `j` equal lags in a row, from `poisson_shares`; `per_mu` is 1/mu."""
    return share[j], j * share[j + 1] * per_mu, j * (j + 1) * share[j + 2] * per_mu * per_mu


@jit_exact_node
def pass_on(chain, poisson, held):
    """Add to `held` what each lag now has of what the `chain` held at the start of the step."""
    lags = chain.size
    for i in range(lags):  # not lag by lag: sums of their own do not wait for each other
        start = chain[i]
        for j in range(lags - i):
            held[i + j] += poisson[j] * start


@jit_exact_node
def filter_rates(law, made, tau, v, states, rates):
    """Fill the time derivatives of the states of one film: inlet, fast, chain; `tau` is its own time, v = u'.

    `made` is the film that enters the chain.
    """
    fed = tau * v
    rates[0] = law.inlet_rate * (fed - states[0]) / tau
    rates[1] = law.fast_rate * (fed - states[1]) / tau
    fed = made
    for k in range(DIRECT - 1, states.size):
        rates[k] = law.lag_rate * (fed - states[k]) / tau
        fed = states[k]
