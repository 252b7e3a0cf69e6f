"""Comparison of the FMU of a contact with its Python element: forces, tangents, derivatives and flags."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.lead import CONTACT
from fmu.spec import ModelSpec
from fmu.verification import Verification
from reduced_models.elements.film_filters import CHAIN, DIRECT, INLET
from reduced_models.elements.film_law import RATE, THETA, film_entering, film_made, film_rest, film_step, static

_Floats = NDArray[np.float64]

STEPS = (1e-3, 1e-2, 0.05, 0.2, 0.02, 1.0)  # of 2a/u_sum, in turn, of the motion that a film is compared on
DURATION = 25.0  # of it
LEAST_THETA = 0.01  # below which the FMU bounds the clock of the film: csrc/film_law.h


def compare_spring(slave: Any, exchange: Any, element: Any, spec: ModelSpec) -> Verification:
    """Compare an element without memory, on `state_grid`."""
    approach, rate = state_grid(element)
    expected = [np.asarray(f(approach, rate)) for f in (element.force, element.stiffness, element.damping)]
    scales = element.step_tangents(1.0, element.high, 0.0)
    values, partials, flags = run(slave, approach, rate)
    exchange.start()
    none = np.empty(0)
    instant = [exchange.evaluate(none, approach=u, rate=v)[0] for u, v in zip(approach, rate, strict=True)]
    differences = [difference(values[:, k], expected[k], scales[k]) for k in range(3)]
    return Verification(
        states=approach.size,
        outside=int((~((element.low <= approach) & (approach <= element.high))).sum()),
        parted=int((expected[0] == 0.0).sum()),
        force=differences[0],
        tangents=max(differences[1:]),
        derivatives=max(difference(partials[:, k], expected[k + 1], scales[k + 1]) for k in range(2)),
        flags=int((flags != outside(element, approach, rate, expected[0])).sum()),
        exchange=difference(np.array(instant), expected[0], scales[0]),
    )


def run(slave: Any, approach: _Floats, rate: _Floats) -> tuple[_Floats, _Floats, NDArray[np.bool_]]:
    """Step through all states; returns force and tangents, partial derivatives of the force, and flags."""
    values, partials = np.empty((approach.size, 3)), np.empty((approach.size, 2))
    flags = np.empty(approach.size, dtype=bool)
    slave.start(lead=CONTACT.at_end)
    for n, (u, v) in enumerate(zip(approach.tolist(), rate.tolist(), strict=True)):
        slave.set(approach=u, rate=v)
        slave.step(1.0)
        values[n] = slave.get("force", "stiffness", "damping")
        flags[n] = slave.flag("outside_validity")
        partials[n] = slave.gradient("force", "approach"), slave.gradient("force", "rate")
    slave.raw.terminate()
    return values, partials, flags


def state_grid(element: Any) -> tuple[_Floats, _Floats]:
    """Approaches and rates to compare an element without memory at, each of shape (n,).

    Approaches go from beyond lift-off to three interval lengths above, with the ends of the interval, their
    floating-point neighbours and both sides of lift-off; rates from parting to three times the spring force.
    """
    length = element.high - element.low
    force, stiffness, _ = element.step_tangents(1.0, element.low, 0.0)
    lift_off = element.low - 1.5 * force / stiffness
    ends = np.array([element.low, element.high])
    # At lift-off, and where the damper cancels the spring exactly, the last bit decides between contact and
    # none, and the tangents jump: stay a little off.
    fade = element.low - lift_off
    approaches = np.concatenate(
        [
            np.linspace(lift_off - length, element.high + 3.0 * length, 121),
            [lift_off - 0.02 * fade, lift_off + 0.02 * fade],
            ends,
            np.nextafter(ends, -np.inf),
            np.nextafter(ends, np.inf),
        ]
    )
    force, _, damping = element.step_tangents(1.0, element.high, 0.0)
    # Without a damper any rate will do; take one interval length per unit of time.
    unit = force / damping if damping > 0.0 else length
    u, v = np.meshgrid(approaches, unit * np.array([-3.0, -0.97, -0.31, -0.01, 0.0, 0.01, 0.5, 3.0]))
    return u.ravel(), v.ravel()


def outside(element: Any, approach: _Floats, rate: _Floats, force: _Floats) -> NDArray[np.bool_]:
    """Whether motion or force is outside the validity box of an element."""
    return bounds(element, approach, rate, force)["outside_validity"]


def bounds(element: Any, approach: _Floats, rate: _Floats, force: _Floats) -> dict[str, NDArray[np.bool_]]:
    """Validity flags of an FMU by name: any bound, approach, rate, force."""
    low, high, fastest, least, most = element.validity.reach
    found = {
        "outside_approach": ~((low <= approach) & (approach <= high)),
        "outside_rate": ~(np.abs(rate) <= fastest),
        "outside_force": ~((least <= force) & (force <= most)),
    }
    return {"outside_validity": np.logical_or.reduce(list(found.values())), **found}


# ---- with a film memory


def film_motion(element: Any) -> tuple[_Floats, _Floats, _Floats]:
    """Times, approaches and rates with a lift-off and a pulse of load, in the units of the element."""
    _, length, time = element._units
    T = np.concatenate([[0.0], np.cumsum(np.resize(STEPS, round(DURATION / sum(STEPS)) * len(STEPS)))])
    u, v = element.approach_at(element._units[0]) / length + 0.4 * np.sin(2.5 * T), np.cos(2.5 * T)
    u, v = with_pulses(T, u, v, ((1.2, 7.0), (-2.5, 15.0)), 1.5)
    return T * time, u * length, v * length / time


def with_pulses(
    T: _Floats, u: _Floats, v: _Floats, pulses: Iterable[tuple[float, float]], width: float
) -> tuple[_Floats, _Floats]:
    """A motion and its rate with Gaussian pulses, each (size, time)."""
    for size, at in pulses:
        s = (T - at) / width
        pulse = size * np.exp(-s * s)
        u, v = u + pulse, v - 2.0 * s / width * pulse
    return u, v


def film_walk(
    element: Any, T: _Floats, approach: _Floats, rate: _Floats
) -> Iterator[tuple[float, float, float, _Floats]]:
    """Force, both tangents of the step and the states after each step from rest at the first approach."""
    f, length, time = element._units
    old, new = np.empty((2, CHAIN + element.lags))
    film_rest(element.law, approach[0] / length, old)
    old[RATE] = old[THETA] * rate[0] / length * time  # moving from the start, as `drive` has it
    for k in range(1, T.size):
        u, v = approach[k] / length, rate[k] / length * time
        force, K, C = film_step(element.law, old, new, (T[k] - T[k - 1]) / time, u, v)
        old, new = new, old
        yield force * f, K * f / length, C * f / length * time, old[INLET:].copy()


def film_rates_at(element: Any, states: _Floats, approach: float, rate: float) -> tuple[float, _Floats]:
    """Force and derivatives of the states in continuous time, the time scale bounded as in the FMU."""
    force, rates = element.continuous(states, approach, rate)
    theta = static(approach / element._units[1], element.law)[1] ** 0.5
    return force, rates * min(1.0, theta / LEAST_THETA)


def _terms(element: Any, states: _Floats, approach: float, rate: float) -> _Floats:
    """Size of the terms that cancel in each derivative: rate of the filter times its input and its state."""
    _, length, time = element._units
    law = element.law
    x, g, _ = static(approach / length, law)
    theta = g**0.5
    moved = theta * rate / length * time
    entering = film_made(x, law) * film_entering(states[0], law.inlet_saturation, law.rim)[0]
    fed = np.array([moved, moved, entering, *states[DIRECT - 1 : -1]])
    clock = np.full(states.size, law.lag_rate)
    clock[: DIRECT - 1] = law.inlet_rate, law.fast_rate
    return np.asarray(clock * (np.abs(fed) + np.abs(states)) / max(theta, LEAST_THETA) / time)


def compare_film(slave: Any, exchange: Any, element: Any, spec: ModelSpec) -> Verification:
    """Compare an element with a memory, along `film_motion`."""
    f, length, time = element._units
    T, u, v = film_motion(element)
    names = [variable.name for variable in spec.states]
    slave.start(lead=CONTACT.at_end, approach=u[0], rate=v[0])
    exchange.start()
    rows: list[list[float]] = []  # force, step tangents, tangents, derivatives, force in model exchange
    wanted: list[list[float]] = []
    rates = 0.0
    wrong = 0
    for k, (force, K, C, _) in enumerate(film_walk(element, T, u, v), start=1):
        slave.set(approach=u[k], rate=v[k])
        slave.step_to(T[k])
        states = np.array(slave.get(*names))
        now = tangents(element, states, u[k], v[k])
        instant, derivatives = exchange.evaluate(states, approach=u[k], rate=v[k])
        rows.append(
            slave.get("force", "step_stiffness", "step_damping", "stiffness", "damping")
            + [slave.gradient("force", name) for name in ("approach", "rate")] + [instant]
        )  # fmt: skip
        expected, expected_rates = film_rates_at(element, states, u[k], v[k])
        wanted.append([force, K, C, *now, *now, expected])
        # a derivative is a difference that may cancel: it is as good as its terms
        terms = _terms(element, states, u[k], v[k])
        rates = max(rates, over(np.abs(derivatives - expected_rates), terms))
        wrong += slave.flag("outside_validity") != bool(outside(element, u[k], v[k], np.asarray(force)))
    slave.raw.terminate()
    ours, theirs = np.array(rows), np.array(wanted)
    scales = [f, *[f / length, f / length * time] * 3, f]
    gaps = [difference(ours[:, k], theirs[:, k], scale) for k, scale in enumerate(scales)]
    return Verification(
        states=T.size - 1,
        outside=int(((u[1:] < element.low) | (u[1:] > element.high)).sum()),
        parted=int((theirs[:, 0] == 0.0).sum()),
        force=gaps[0],
        tangents=max(gaps[1:5]),
        derivatives=max(gaps[5:7]),
        flags=wrong,
        exchange=max(gaps[7], rates),
    )


def tangents(element: Any, states: _Floats, approach: float, rate: float) -> tuple[float, float]:
    """dF/du and dF/du' of an element with film memory at fixed states."""
    f, length, time = element._units
    law, v = element.law, rate / length * time
    x, g, g_u = static(approach / length, law)
    k = int(np.searchsorted(law.gain_x, x)) - 1
    inside = 0 <= k < law.gain_x.size - 1
    gains = element.gains_at(x)
    slopes = (law.gains[k + 1] - law.gains[k]) / (law.gain_x[k + 1] - law.gain_x[k]) if inside else 0.0 * gains
    made = float(film_made(x, law))  # what the chain holds is weighed with shares of it
    gains[DIRECT:] /= made
    if inside:
        width = law.gain_x[k + 1] - law.gain_x[k]
        low, high = (float(np.abs(row[DIRECT:]).sum()) for row in law.gains[k : k + 2])
        slopes[DIRECT:] = (slopes[DIRECT:] - gains[DIRECT:] * (high - low) / width) / made
    theta, x_u = g**0.5, 1.5 * g_u / g
    felt = np.array([theta * v, *states])
    w = g + gains @ felt
    if w <= 0.0:
        return 0.0, 0.0
    w_u = g_u + gains[0] * v * 0.5 * g_u / theta + (slopes @ felt) * x_u
    unit = 1.5 * w**0.5 * f / length
    return unit * w_u, unit * time * gains[0] * theta


def difference(ours: _Floats, expected: _Floats, scale: float | _Floats) -> float:
    """Largest difference, relative to the expected value or 1e-3 of `scale`, whichever is larger."""
    return over(np.abs(ours - expected), floored(expected, scale))


def floored(expected: _Floats, scale: float | _Floats) -> _Floats:
    """Magnitude of the expected values, at least 1e-3 of `scale`."""
    return np.asarray(np.maximum(np.abs(expected), 1e-3 * np.abs(scale)))


def over(error: _Floats, size: _Floats) -> float:
    """Largest error relative to `size`; infinite for an error where `size` is 0."""
    return float(np.max(each_over(error, size)))


def each_over(error: _Floats, size: _Floats) -> _Floats:
    """Error relative to `size` of each entry; infinite where it is not a number."""
    found = np.divide(error, size, out=np.where(error > 0.0, np.inf, 0.0), where=size > 0.0)
    return np.where(np.isfinite(error), found, np.inf)
