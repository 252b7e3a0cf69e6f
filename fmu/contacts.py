"""Specification of the FMU of a contact element: name, variables, notes and advice on steps."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from fmu.contact_variables import MEANINGS, ContactVariables, Element, Film
from fmu.film import film_parts
from fmu.spec import ModelSpec
from fmu.spring import spring_parts
from reduced_models.elements.validity import frequency_text, text_of

SHARE_OF_TRANSIT = 0.05  # of 2a/u_sum, the default step
FAST_STEP = 0.1  # of the fastest motion, over its angular frequency: what the advice on steps is told for
LONGEST_NAME = 200  # characters of what an element says of its contact, in the description of an FMU

_DIMENSIONLESS = "dimensionless: force in static loads, approach in dry Hertz approaches, time in 2a/u_sum"


def contact_spec(element: Element, model_name: str | None = None) -> ModelSpec:
    """Specification of a contact element's FMU.

    Units follow the element: SI, or "1" throughout for a dimensionless one. A linear element is the cubic one
    with K2 = K3 = 0, so both have the same variables. The approach of an element without memory starts in the
    middle of the validity interval, that of a film under its reference load; the rate starts at zero.

    Parameters
    ----------
    element : ContactElement
        Of any kind.
    model_name : str, optional
        Name of the model; the class of the element by default.

    Raises
    ------
    InputError
        No contact element, or a name that is empty, too long or not printable.
    """
    if not isinstance(element, Element):
        raise InputError("element", type(element).__name__, "a contact element (linear, cubic, ..., wide)")
    name = checked_name(type(element).__name__ if model_name is None else model_name)
    common = ContactVariables(element)
    parts = film_parts(element, common) if isinstance(element, Film) else spring_parts(element, common)
    system = "SI units" if element.units == "SI" else _DIMENSIONLESS
    return ModelSpec(
        name=name,
        description=f"{parts.pop('description')}; {system}{whose([element])}",
        notes=_notes(element),
        choices=(MEANINGS,),
        step=default_step(element),
        time_unit="s" if element.units == "SI" else "1",
        **parts,
    )


def whose(elements: Iterable[Element]) -> str:
    """Bearing, oil, load and speed of elements in words, where their source names them.

    A description is one line: what is not printable, as of a file that somebody wrote by hand, is left out.
    """
    given = (str((element.source or {}).get("contact") or "") for element in elements)
    said = ("".join(filter(str.isprintable, " ".join(text.split())))[:LONGEST_NAME] for text in given)
    return "".join(f"; {text}" for text in dict.fromkeys(said) if text)


def checked_name(name: object) -> str:
    """Check of a model name; returns it.

    Raises
    ------
    InputError
        Empty, too long or not printable.
    """
    if not isinstance(name, str) or not name.strip() or not name.isprintable() or len(name) > 100:
        raise InputError("model_name", name, "1 to 100 printable characters")
    return name


def default_step(element: Element) -> float:
    """A step that resolves the contact, 1, 2 or 5 times a power of ten.

    A twentieth of 2a/u_sum; of an element in SI that does not know its scales, the 60th part of its fastest
    period, or of the time that its largest rate takes through its interval.
    """
    if element.units == "dimensionless" or element.time is not None:
        return round_down(SHARE_OF_TRANSIT * (1.0 if element.time is None else element.time))
    times = [1e-3]
    if element.omega_range is not None and element.omega_range[1] > 0.0:
        times.append(0.1 / element.omega_range[1])
    if element.rate:
        low, high = element.validity.approach
        times.append(SHARE_OF_TRANSIT * (high - low) / element.rate)
    return round_down(min(times))


def round_down(value: float) -> float:
    """1, 2 or 5 times a power of ten, at most `value` > 0."""
    power = math.floor(math.log10(value))
    digit = max(d for d in (1, 2, 5) if d <= value / 10.0**power * (1.0 + 1e-12))
    return float(f"{digit}e{power}")


def _notes(element: Element) -> tuple[tuple[str, str], ...]:
    lines = [("Element", f"{type(element).__name__}, units: {element.units}")]
    if element.rate is not None:
        lines.append(("Largest rate of the data", repr(element.rate)))
    if element.omega_range is not None:
        lines.append(("Frequencies of the data", frequency_text(element.omega_range, element.units)))
    if element.load_range is not None:
        lines.append(("Forces of the data", text_of(element.load_range)))
    made = {name: value for name, value in asdict(element.design_point).items() if value is not None}
    for label, details in (("Made for", made), ("Fit", element.fit), ("Source", element.source)):
        if details:
            lines.append((label, _flat(details)))
    lines += [(label.capitalize(), f"{value}: {why}") for label, value, why in step_advice(element)]
    return tuple(lines)


def step_advice(element: Element) -> list[tuple[str, str, str]]:
    """Advice on co-simulation steps at the static load: (name, largest step, reason) per way of coupling."""
    unit = " s" if element.units == "SI" else ""
    low, high = element.validity.approach
    lines = [("default step", f"{default_step(element):g}{unit}", "resolves the contact")]
    try:
        u = element.approach_at(element._static_load(None))
    except InputError:
        u = 0.5 * (low + high)
    K, load = float(element.spring_tangent(u)), float(element.spring(u))
    if not (K > 0.0 and 0.0 < load < math.inf):
        return lines
    C = damping_at(element, load)
    late = C / K
    return [
        *lines,
        (
            "largest step, inputs held",
            f"{late:.3g}{unit}",
            f"a force one step h late takes K h off the damping C; K = {K:.4g}, C = {C:.4g}",
        ),
        (
            "largest step, inputs extrapolated",
            f"{late / FAST_STEP**2:.3g}{unit}",
            f"where K h (w h)^2 is C, twice the damping then, at w h = {FAST_STEP:g} of the fastest "
            "motion w; it goes like (w h)^-2",
        ),
        (
            "largest step, force read after inputs are set, or iterated",
            "the master's",
            "set, get, then doStep has no delay; input_meaning 2 (end) is for rollback",
        ),
    ]


def damping_at(element: Element, load: float) -> float:
    """Damping coefficient of slow motion about rest under a load."""
    return float(element._response(_slow(element), load)[0].imag / _slow(element)[0])


def _slow(element: Element) -> NDArray[np.float64]:
    time = 1.0 if element.time is None else element.time
    return np.array([0.1 / time])


def _flat(details: Mapping[str, object]) -> str:
    return "; ".join(f"{key}: {_plain(details[key])}" for key in sorted(details) if details[key] is not None)


def _plain(value: object) -> str:
    """A value as text: short numbers, entries of a container in brackets."""
    if isinstance(value, Mapping):
        return f"({', '.join(f'{key} {_plain(one)}' for key, one in value.items() if one is not None)})"
    if isinstance(value, list | tuple):
        return f"({', '.join(map(_plain, value))})"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
