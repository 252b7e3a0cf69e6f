"""References of a contact element: its force in a vibration with a load pulse and a lift-off."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.comparison import STEPS, bounds, film_rates_at, film_walk, tangents, with_pulses
from fmu.contact_variables import Element, Film
from fmu.lead import CONTACT
from fmu.references.series import References, Trial
from fmu.spec import ModelSpec
from fmu.steps import SHARE_OF_TRANSIT, round_down
from reduced_models.elements.film_filters import DIRECT

_Floats = NDArray[np.float64]

EVEN = 110, 0.1  # steps of one length, and that length in the unit of time; uneven ones follow
VIBRATION = 2.5, 0.3  # angular frequency in that unit, amplitude over the length scale
PULSES = 4.5, 8.5, 0.8  # when the load comes, when the surfaces part, how long either takes
DIGITS = 7  # of times and inputs, which are exact in the files then
POINTS = 12  # states of a film for model exchange
FAR = -30.0  # approach of one of them, from that under the reference load, over the length scale
MEMORY = 0.2  # size of the remembered rates there


def contact_references(element: Element, spec: ModelSpec) -> References:
    """Reference inputs and results of the FMU of a contact element.

    Parameters
    ----------
    element : ContactElement
        It makes the results; its own state stays as it is.
    spec : ModelSpec
        Of its FMU.
    """
    if isinstance(element, Film):
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
    return _rounded(T * unit), _rounded(u), _rounded(v / unit)


def _rounded(values: _Floats) -> _Floats:
    return np.array([float(f"{value:.{DIGITS}g}") for value in values])


def _spring(element: Any, time: _Floats, approach: _Floats, rate: _Floats) -> Trial:
    laws = {"force": element.force, "stiffness": element.stiffness, "damping": element.damping}
    found = {name: np.asarray(law(approach, rate), float) for name, law in laws.items()}
    found |= bounds(element, approach, rate, found["force"])
    return Trial(time, {"approach": approach, "rate": rate}, found)


def _film_steps(element: Film, time: _Floats, approach: _Floats, rate: _Floats) -> Trial:
    rest = np.zeros(element.state_count)
    K, C = tangents(element, rest, approach[0], rate[0])
    rows = [[float(element.spring(approach[0])), K, C, K, C]]
    for k, (force, k_step, c_step, states) in enumerate(film_walk(element, time, approach, rate), start=1):
        now = tangents(element, states, approach[k], rate[k])
        rows.append([force, *now, k_step, c_step])
    names = ("force", "stiffness", "damping", "step_stiffness", "step_damping")
    found = dict(zip(names, np.array(rows).T, strict=True))
    found |= bounds(element, approach, rate, found["force"])
    return Trial(time, {"approach": approach, "rate": rate}, found)


def _film_points(element: Film, names: list[str]) -> Trial:
    """States with signs opposite to those of their inputs, so that no derivative is a small difference."""
    f, length, unit = element._units
    number = np.arange(POINTS)
    middle = element.approach_at(f)
    offsets = np.linspace(-2.0, 1.5, POINTS)
    offsets[0] = FAR  # where the clock of the film is bounded
    approach = _rounded(middle + length * offsets)
    sign = 1.0 - 2.0 * (number % 2)
    rate = _rounded(np.asarray(2.0 * MEMORY * length / unit * sign))
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
