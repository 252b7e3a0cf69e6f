"""A contact element in Python: references of its FMU, and the motions or states that an FMU is compared on.

References are a vibration with a load pulse and a lift-off. Compared are states of every kind or, with a film
memory, a wilder motion in steps of many lengths.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.contact_variables import Element, Film
from fmu.lead import CONTACT
from fmu.references.series import References, Trial, floored, rounded
from fmu.spec import ModelSpec
from fmu.steps import SHARE_OF_TRANSIT, round_down
from reduced_models.elements.film_contact import units_of
from reduced_models.elements.film_filters import CHAIN, DIRECT, INLET
from reduced_models.elements.film_law import (
    RATE,
    THETA,
    FilmLaw,
    film_entering,
    film_made,
    film_rest,
    film_step,
    static,
)
from reduced_models.elements.film_speed import slow_law

_Floats = NDArray[np.float64]

STEPS = (1e-3, 1e-2, 0.05, 0.2, 0.02, 1.0)  # of 2a/u_sum, in turn, of the motion that a film is compared on
DURATION = 25.0  # of it
LEAST_THETA = 0.01  # below which the FMU bounds the clock of the film: csrc/film_law.h
EVEN = 110, 0.1  # steps of one length, and that length in the unit of time; uneven ones follow
VIBRATION = 2.5, 0.3  # angular frequency in that unit, amplitude over the length scale
PULSES = 4.5, 8.5, 0.8  # when the load comes, when the surfaces part, how long either takes
POINTS = 12  # states of a film for model exchange
SLOWLY = 0.4  # angular frequency of the speed of the surfaces, in the unit of time
FAR = -30.0  # approach of one of them, from that under the reference load, over the length scale
MEMORY = 0.2  # size of the remembered rates there
FIELDS = {
    **{"force": "force", "outside_validity": "flags"},
    **dict.fromkeys(("stiffness", "damping", "step_stiffness", "step_damping"), "tangents"),
    **dict.fromkeys(("force / approach", "force / rate"), "derivatives"),
}  # of `Verification`


def contact_references(element: Element, spec: ModelSpec) -> References:
    """Reference inputs and results of the FMU of a contact element.

    Parameters
    ----------
    element : ContactElement
        It makes the results; its own state stays as it is.
    spec : ModelSpec
        Of its FMU.
    """
    points: Trial | None = None
    if isinstance(element, Film) and element.speeds is not None:
        time, approach, rate = _motion(spec.step / SHARE_OF_TRANSIT, *_reach_of_film(element))
        steps = _speed_steps(element, time, approach, rate, rounded(speed_course(element, time)))
    elif isinstance(element, Film):
        time, approach, rate = _motion(spec.step / SHARE_OF_TRANSIT, *_reach_of_film(element))
        steps = _film_steps(element, time, approach, rate)
        points = _film_points(element, [variable.name for variable in spec.states])
    else:
        time, approach, rate = _motion(*_reach_of_spring(element, spec))
        steps = _spring(element, time, approach, rate)
        every = slice(None, None, EVEN[0] // POINTS)
        points = _spring(element, np.arange(time[every].size, dtype=float), approach[every], rate[every])
    about = "A vibration from rest, with a pulse of load and a lift-off, computed by the element in Python"
    return References(steps, points, {CONTACT.name: CONTACT.at_end}, about=about)


def contact_trials(element: Element, spec: ModelSpec) -> References:
    """What the FMU of a contact element is compared on: `state_grid`, or `film_motion` and the states along it.

    Differences are over the value, and at least 1e-3 of that at the upper end of the interval, or under the
    reference load of a film.
    """
    if not isinstance(element, Film):
        return _spring_trials(element)
    return _film_trials(element, spec) if element.speeds is None else _speed_trials(element)


def _spring_trials(element: Any) -> References:
    approach, rate = state_grid(element)
    number = np.arange(approach.size, dtype=float)
    steps = _spring(element, number, approach, rate)
    names = "force", "stiffness", "damping"
    scales = dict(zip(names, element.step_tangents(1.0, element.high, 0.0), strict=True))
    unknowns = {name: steps.unknowns[name] for name in names}
    unknowns |= {"force / approach": unknowns["stiffness"], "force / rate": unknowns["damping"]}
    scales |= {"force / approach": scales["stiffness"], "force / rate": scales["damping"]}
    sizes = {name: floored(values, scales[name]) for name, values in unknowns.items()}
    knowns, force = steps.knowns, unknowns["force"]
    return References(
        Trial(
            number,
            knowns,
            unknowns | {"outside_validity": steps.unknowns["outside_validity"]},
            sizes | {"outside_validity": 1.0},
            FIELDS,
        ),
        Trial(number, knowns, {"force": force}, {"force": sizes["force"]}, {"force": "exchange"}),
        {CONTACT.name: CONTACT.at_end},
        outside=int((~((element.low <= approach) & (approach <= element.high))).sum()),
        parted=int((force == 0.0).sum()),
    )


def _speed_trials(element: Film) -> References:
    """Steps while the speed of the surfaces changes, down to standstill and back; without partial derivatives."""
    low, high = element.validity.approach
    T, u, v = film_motion(element)
    steps = _speed_steps(element, T, u, v, speed_course(element, T))
    unknowns, sizes = _compared(element, steps)
    return References(
        Trial(T, steps.knowns, unknowns, sizes, FIELDS),
        None,
        {CONTACT.name: CONTACT.at_end},
        outside=int((~((low <= u) & (u <= high))).sum()),
        parted=int((unknowns["force"] == 0.0).sum()),
    )


def _compared(element: Film, steps: Trial) -> tuple[dict[str, _Floats], dict[str, Any]]:
    """Columns of steps that are compared, and their sizes."""
    f, length, time = element._units
    unknowns = {name: steps.unknowns[name] for name in FIELDS if name in steps.unknowns}
    scales = dict.fromkeys(unknowns, f / length) | {"force": f}
    scales |= dict.fromkeys(("damping", "step_damping"), f / length * time)
    sizes: dict[str, Any] = {name: floored(values, scales[name]) for name, values in unknowns.items()}
    return unknowns, sizes | {"outside_validity": 1.0}


def _film_trials(element: Film, spec: ModelSpec) -> References:
    f, (low, high) = element._units[0], element.validity.approach
    T, u, v = film_motion(element)
    steps = _film_steps(element, T, u, v)
    unknowns, sizes = _compared(element, steps)
    for name, column in {"force / approach": "stiffness", "force / rate": "damping"}.items():
        unknowns[name], sizes[name] = unknowns[column], sizes[column]
    states = np.array([states for _, _, _, states in film_walk(element, T, u, v)])
    rows, terms = [], []
    for x, approach, rate in zip(states, u[1:].tolist(), v[1:].tolist(), strict=True):
        force, rates = film_rates_at(element, x, approach, rate)
        rows.append([force, *rates])
        terms.append(_terms(element, x, approach, rate))
    names = [variable.name for variable in spec.states]
    instant = dict(zip(("force", *(f"der({name})" for name in names)), np.array(rows).T, strict=True))
    within = {"force": floored(instant["force"], f)}
    within |= {f"der({name})": column for name, column in zip(names, np.array(terms).T, strict=True)}
    knowns = {"approach": u[1:], "rate": v[1:], **dict(zip(names, states.T, strict=True))}
    return References(
        Trial(T, steps.knowns, unknowns, sizes, FIELDS),
        Trial(np.arange(len(states), dtype=float), knowns, instant, within, dict.fromkeys(instant, "exchange")),
        {CONTACT.name: CONTACT.at_end},
        outside=int((~((low <= u) & (u <= high))).sum()),
        parted=int((unknowns["force"] == 0.0).sum()),
    )


def _reach_of_film(element: Film) -> tuple[float, float, float, float]:
    """Middle, length scale, load pulse and parting of the approach."""
    force, length, _ = element._units
    return element.approach_at(force), length, 1.2 * length, 2.5 * length


def _reach_of_spring(element: Any, spec: ModelSpec) -> tuple[float, float, float, float, float]:
    """Unit of time, then as for a film; the rates are those at which the damper counts."""
    length = element.high - element.low
    middle = 0.5 * (element.low + element.high)
    force, stiffness, _ = element.step_tangents(1.0, element.low, 0.0)
    lift_off = element.low - 1.5 * force / stiffness
    force, _, damping = element.step_tangents(1.0, element.high, 0.0)
    omega, share = VIBRATION
    fastest = element.rate if element.rate else share * force / damping if damping > 0.0 else 0.0
    # a rate so small or large that the time it takes is none: the default step has to do
    unit = share * omega * length / fastest if fastest > 0.0 else spec.step / SHARE_OF_TRANSIT
    return round_down(unit), middle, length, 0.9 * length, 1.5 * (middle - lift_off) + share * length


def _motion(
    unit: float, middle: float, length: float, pulse: float, parting: float
) -> tuple[_Floats, _Floats, _Floats]:
    """Times, approaches and rates; at rest at first."""
    steps, sample = EVEN
    omega, share = VIBRATION
    loaded, parted, width = PULSES
    T = np.concatenate([np.arange(steps + 1) * sample, steps * sample + np.cumsum(STEPS[:-1])])
    u = middle - share * length * np.cos(omega * T)
    v = share * length * omega * np.sin(omega * T)
    u, v = with_pulses(T, u, v, ((pulse, loaded), (-parting, parted)), width)
    v[0] = 0.0
    return rounded(T * unit), rounded(u), rounded(v / unit)


def _spring(element: Any, time: _Floats, approach: _Floats, rate: _Floats) -> Trial:
    laws = {"force": element.force, "stiffness": element.stiffness, "damping": element.damping}
    found = {name: np.asarray(law(approach, rate), float) for name, law in laws.items()}
    found |= bounds(element, approach, rate, found["force"])
    return Trial(time, {"approach": approach, "rate": rate}, found)


def _film_steps(element: Film, time: _Floats, approach: _Floats, rate: _Floats) -> Trial:
    rest = np.zeros(element.state_count)
    K, C = tangents(element, rest, approach[0], rate[0])
    force, _ = film_rates_at(element, rest, approach[0], rate[0])
    rows = [[force, K, C, K, C]]
    for k, (force, k_step, c_step, states) in enumerate(film_walk(element, time, approach, rate), start=1):
        now = tangents(element, states, approach[k], rate[k])
        rows.append([force, *now, k_step, c_step])
    names = ("force", "stiffness", "damping", "step_stiffness", "step_damping")
    found = dict(zip(names, np.array(rows).T, strict=True))
    found |= bounds(element, approach, rate, found["force"])
    return Trial(time, {"approach": approach, "rate": rate}, found)


def speed_course(element: Film, time: _Floats) -> _Floats:
    """Speeds over times: from that of the reference through standstill to the opposite one, and back."""
    return element._reference_speed * np.cos(SLOWLY * time / element._units[2])


def _speed_steps(element: Film, time: _Floats, approach: _Floats, rate: _Floats, speed: _Floats) -> Trial:
    rows = list(speed_walk(element, time, approach, rate, speed))
    names = ("force", "stiffness", "damping", "step_stiffness", "step_damping")
    found: dict[str, Any] = dict(zip(names, np.array(rows).T, strict=True))
    found |= bounds(element, approach, rate, found["force"])
    return Trial(time, {"approach": approach, "rate": rate, "u_sum": speed}, found)


def speed_walk(
    element: Any, T: _Floats, approach: _Floats, rate: _Floats, speed: _Floats
) -> Iterator[tuple[float, ...]]:
    """Force, tangents with the states as they are and those of the step, at the ends of steps of an own element.

    The first row is at rest, moving already as `drive` has it.
    """
    element = replace(element)
    element.set_speed(float(speed[0]))
    force, still = element.rest(float(approach[0])), np.zeros(element.state_count)
    start = _Film(element.law, element._units)
    force, _ = film_rates_at(element, still, approach[0], rate[0])
    now = tangents(start, still, approach[0], rate[0])
    _, length, time = element._units
    element._state[RATE] = element._state[THETA] * rate[0] / length * time
    yield (force, *now, *now)
    for k in range(1, T.size):
        element.set_speed(float(speed[k]))
        _, k_step, c_step = element.step_tangents(T[k] - T[k - 1], approach[k], rate[k])
        force = element._move(T[k] - T[k - 1], float(approach[k]), float(rate[k]))
        history, unit = element._history, units_of(element.scales)
        law = slow_law(element._range.at(history.film), history.slowed)
        film = _Film(law, (*unit[:2], unit[2] / history.pace))
        yield (force, *tangents(film, element._state[INLET:], approach[k], rate[k]), k_step, c_step)


class _Film:
    """A law with its units, as an element has them."""

    def __init__(self, law: FilmLaw, units: tuple[float, float, float]) -> None:
        self.law, self._units = law, units

    def gains_at(self, x: float) -> _Floats:
        """Gains at x = ln F."""
        return np.array([np.interp(x, self.law.gain_x, column) for column in self.law.gains.T])


def _film_points(element: Film, names: list[str]) -> Trial:
    """States with signs opposite to those of their inputs, so that no derivative is a small difference."""
    f, length, unit = element._units
    number = np.arange(POINTS)
    middle = element.approach_at(f)
    offsets = np.linspace(-2.0, 1.5, POINTS)
    offsets[0] = FAR  # where the clock of the film is bounded
    approach = rounded(middle + length * offsets)
    sign = 1.0 - 2.0 * (number % 2)
    rate = rounded(np.asarray(2.0 * MEMORY * length / unit * sign))
    order = np.arange(len(names))
    signs = np.where(order < DIRECT - 1, -1.0, 1.0 - 2.0 * (order % 2))  # the chain begins with what s is not
    states = np.round(np.outer(sign, signs * MEMORY * (1.0 + 0.05 * order)), 4)
    rows = []
    for u, v, x in zip(approach, rate, states, strict=True):
        force, rates = film_rates_at(element, x, u, v)
        rows.append([force, *tangents(element, x, u, v), *rates])
    outputs = ("force", "stiffness", "damping", *(f"der({name})" for name in names))
    found = dict(zip(outputs, np.array(rows).T, strict=True))
    found |= bounds(element, approach, rate, found["force"])
    knowns = {"approach": approach, "rate": rate, **dict(zip(names, states.T, strict=True))}
    return Trial(number.astype(float), knowns, found)


# ---- what is compared, and laws of a film in time


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


def bounds(element: Any, approach: _Floats, rate: _Floats, force: _Floats) -> dict[str, NDArray[np.bool_]]:
    """Validity flags of an FMU by name: any bound, approach, rate, force."""
    low, high, fastest, least, most = element.validity.reach
    found = {
        "outside_approach": ~((low <= approach) & (approach <= high)),
        "outside_rate": ~(np.abs(rate) <= fastest),
        "outside_force": ~((least <= force) & (force <= most)),
    }
    return {"outside_validity": np.logical_or.reduce(list(found.values())), **found}


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
