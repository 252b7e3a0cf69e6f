"""Specification of the FMU of a contact element, whatever its kind."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from fmu.c_headers import c_double
from fmu.spec import Choice, ModelSpec, Variable
from reduced_models import (
    CubicContact,
    FilmMemoryContact,
    LinearContact,
    PolynomialContact,
    PowerLawContact,
    WideRangeContact,
)
from reduced_models.elements.validity import MARGIN, frequency_text, text_of

Element = LinearContact | CubicContact | PolynomialContact | PowerLawContact | FilmMemoryContact | WideRangeContact
Film = FilmMemoryContact | WideRangeContact

SHARE_OF_TRANSIT = 0.05  # of 2a/u_sum, the default step
FAST_STEP = 0.1  # of the fastest motion, over its angular frequency: what the advice on steps is told for
LONGEST_NAME = 200  # characters of what an element says of its contact, in the description of an FMU
ALLOWED_ERROR = 1e-4  # of the force in a step that is cut inside, where the importer gives no tolerance

MEANINGS = Choice(
    "InputMeaning",
    (
        (
            "extrapolated",
            "inputs are those of the step's start: approach goes on by its rate, rate by its last change",
        ),
        ("end", "inputs are those of the step's end, for masters that iterate"),
        ("held", "inputs are those of the step's start and stay so: the force got is that of the start"),
    ),
)

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
    from fmu.film import film_parts
    from fmu.spring import spring_parts

    common = Common(element)
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
    """Bearing, oil, load and speed that elements were made for, in words, where whoever made them said so.

    A description is one line: what is not printable, as of a file that somebody wrote by hand, is left out.
    """
    given = (str((element.source or {}).get("contact") or "") for element in elements)
    said = ("".join(filter(str.isprintable, " ".join(text.split())))[:LONGEST_NAME] for text in given)
    return "".join(f"; {text}" for text in dict.fromkeys(said) if text)


def checked_name(name: object) -> str:
    """A model name as it is.

    Raises
    ------
    InputError
        Empty, too long or not printable.
    """
    if not isinstance(name, str) or not name.strip() or not name.isprintable() or len(name) > 100:
        raise InputError("model_name", name, "1 to 100 printable characters")
    return name


class Common:
    """The variables of every contact, numbered as they are made."""

    def __init__(self, element: Element) -> None:
        self.element = element
        self.variables: list[Variable] = []

    def unit(self, si: str) -> str:
        """The unit of a quantity of the element."""
        return si if self.element.units == "SI" else "1"

    def add(self, name: str, causality: str, variability: str, text: str, **more: Any) -> None:
        """Append a variable."""
        self.variables.append(Variable(name, len(self.variables), causality, variability, text, **more))

    def input(self, name: str, si: str, start: float, nominal: float, text: str) -> None:
        """Append an input."""
        rate = "rate" if name == "approach" else None
        self.add(
            name, "input", "continuous", text,
            unit=self.unit(si), start=start, nominal=_nominal(nominal), rate=rate,
        )  # fmt: skip

    def output(self, name: str, si: str, nominal: float, depends: tuple[str, ...], text: str) -> None:
        """Append a real output that is never negative."""
        self.add(
            name, "output", "continuous", text,
            unit=self.unit(si), minimum=0.0 if name == "force" else None,
            nominal=_nominal(nominal), depends=depends,
        )  # fmt: skip

    def constant(self, name: str, si: str, value: float, text: str) -> None:
        """Append a number that says something about the element."""
        self.add(name, "local", "constant", text, unit=self.unit(si), start=float(value))

    def meaning(self) -> None:
        """Append the parameter `input_meaning`."""
        self.add(
            "input_meaning", "parameter", "fixed",
            "What the inputs of a co-simulation step mean: 1 extrapolated, 2 end, 3 held",
            type="Enumeration", start=1, minimum=1, maximum=len(MEANINGS.items),
        )  # fmt: skip

    def flags(self, depends: tuple[str, ...], *, first: bool) -> None:
        """Append outside_validity (`first`), or the flags of its bounds."""
        texts = {
            "outside_validity": f"True where approach, rate or force leave their bounds by more than {MARGIN:.0%}",
            "outside_approach": "True where the approach is outside [low, high] by more than the margin",
            "outside_rate": "True where the rate is larger than rate_max by more than the margin",
            "outside_force": "True where the force is outside [force_min, force_max] by more than the margin",
        }
        for name in list(texts)[:1] if first else list(texts)[1:]:
            self.add(name, "output", "discrete", texts[name], type="Boolean", depends=depends)

    def box(self, *, low_high: bool, rate: bool = True) -> None:
        """Append what is known of the validity box; low and high, or the rate, may be there already."""
        element = self.element
        if low_high:
            self.constant(
                "low", "m", element.validity.approach[0], "Lower end of the validity interval of the approach"
            )
            self.constant(
                "high", "m", element.validity.approach[1], "Upper end of the validity interval of the approach"
            )
        if rate and element.rate is not None:
            self.constant("rate_max", "m/s", element.rate, "Largest rate, in magnitude, of the data")
        if element.load_range is not None:
            self.constant("force_min", "N", element.load_range[0], "Smallest force of the data")
            self.constant("force_max", "N", element.load_range[1], "Largest force of the data")
        if element.omega_range is not None:
            words = "angular frequency of the data"
            self.constant("omega_min", "rad/s", element.omega_range[0], f"Lowest {words}")
            self.constant("omega_max", "rad/s", element.omega_range[1], f"Highest {words}")

    def macros(self) -> dict[str, str]:
        """What config.h says of the box: a bound that is not known is infinite."""
        _, _, _, least, most = self.element.validity.reach
        known = any(variable.name == "rate_max" for variable in self.variables)
        return {
            "BOX_MARGIN": c_double(MARGIN),
            "BOX_RATE": "m->value[VR_rate_max]" if known else "HUGE_VAL",
            "BOX_LEAST_FORCE": c_double(least),
            "BOX_MOST_FORCE": c_double(most),
            "DEFAULT_TOLERANCE": c_double(ALLOWED_ERROR),
        }


def _nominal(value: float) -> float | None:
    size = abs(value)
    return size if math.isfinite(size) and size > 0.0 else None


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


def band_text(element: Element) -> str:
    """What a damper without memory is for, in words."""
    band = element.omega_range
    return "" if band is None else f", for motion of {frequency_text(band, element.units)}"


def _notes(element: Element) -> tuple[tuple[str, str], ...]:
    lines = [("Element", f"{type(element).__name__}, units: {element.units}")]
    if element.rate is not None:
        lines.append(("Largest rate of the data", repr(element.rate)))
    if element.omega_range is not None:
        lines.append(("Frequencies of the data", frequency_text(element.omega_range, element.units)))
    if element.load_range is not None:
        lines.append(("Forces of the data", text_of(element.load_range)))
    made = {name: value for name, value in asdict(element.made_for).items() if value is not None}
    for label, details in (("Made for", made), ("Fit", element.fit), ("Source", element.source)):
        if details:
            lines.append((label, _flat(details)))
    lines += [(label.capitalize(), f"{value}: {why}") for label, value, why in step_advice(element)]
    return tuple(lines)


def step_advice(element: Element) -> list[tuple[str, str, str]]:
    """Steps of a co-simulation, by the way of coupling, at the static load: which, how long, why."""
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
    """A value in words and short numbers, what it holds in brackets."""
    if isinstance(value, Mapping):
        return f"({', '.join(f'{key} {_plain(one)}' for key, one in value.items() if one is not None)})"
    if isinstance(value, list | tuple):
        return f"({', '.join(map(_plain, value))})"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
