"""Specification of the FMU of a contact element: name, description, variables, C text and notes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from fmu.c_headers import c_double, c_table
from fmu.contact_variables import ContactVariables, Element, Film
from fmu.lead import CONTACT, HELD_PARALLEL
from fmu.spec import ModelSpec
from fmu.steps import default_step, step_advice
from reduced_models.elements.film_law import FilmLaw, film_made
from reduced_models.elements.spring import SpringContact
from reduced_models.elements.validity import frequency_text, text_of

LONGEST_NAME = 200  # characters of the name of a contact in the description of an FMU

_DIMENSIONLESS = "dimensionless: force in static loads, approach in dry Hertz approaches, time in 2a/u_sum"
LAW = "film_law", "film_filters"  # C files of the film law, each with its header
SPEED = "u_sum"  # input of an element over the speed
HISTORY = 74  # numbers that it remembers beside the lags: inlet, fast, whether it has begun, `SpeedHistory` in C
TABLES = (
    "ln F_s, ln h_s, its slope and the approach at the nodes of the static curve; ln F_s of the rows of gains;"
    " viscous, inlet and fast gain and those of the chain of every row"
)
# Unit and description of every coefficient.
_POLYNOMIAL = {
    "K1": ("N/m", "Coefficient of the approach in the spring force"),
    "K2": ("N.m-2", "Coefficient of the squared approach in the spring force"),
    "K3": ("N.m-3", "Coefficient of the cubed approach in the spring force"),
    "C1": ("N.s/m", "Damping coefficient"),
    "C2": ("N.s2.m-2", "Coefficient of the squared rate"),
    "C3": ("N.s3.m-3", "Coefficient of the cubed rate"),
    "B4": ("N.s.m-2", "Coefficient of approach times rate"),
}
_POWER = {
    "K": (
        None,
        "Factor K of the spring force K (u + u0)^n + F0",
    ),  # N/m^n: not a unit of FMI
    "n": ("1", "Exponent of the spring force"),
    "u0": ("m", "Shift of the approach in the spring force"),
    "F0": ("N", "Offset of the spring force"),
    "C1": ("N.s/m", "Damping coefficient"),
}
_ENDS = {
    "low": ("m", "Lower end of the validity interval of the approach"),
    "high": ("m", "Upper end of the validity interval of the approach"),
}


def contact_spec(element: Element, model_name: str | None = None, lead: float = HELD_PARALLEL) -> ModelSpec:
    """Specification of a contact element's FMU.

    Units follow the element: SI, or "1" throughout for a dimensionless one. A linear element is the cubic one
    with K2 = K3 = 0, so both have the same variables. The approach of an element without memory starts in the
    middle of the validity interval, that of a film under its reference load; the rate starts at zero.

    Parameters
    ----------
    element : ContactElement
        Of any kind.
    model_name : str, optional
        Name of the model; the kind of the element, as CubicContact, by default.
    lead : float
        Start value of the parameter `lead`, 0 to 2 communication steps.

    Raises
    ------
    InputError
        No contact element, a name that is empty, too long or not printable, or another lead.
    """
    if not isinstance(element, Element):
        raise InputError("element", type(element).__name__, "a contact element (linear, cubic, ..., speed)")
    name = checked_name(f"{element.kind.capitalize()}Contact" if model_name is None else model_name)
    parts = _film_parts(element, lead) if isinstance(element, Film) else _spring_parts(element, lead)
    system = "SI units" if element.units == "SI" else _DIMENSIONLESS
    return ModelSpec(
        name=name,
        description=f"{parts.pop('description')}; {system}{source_text([element])}",
        notes=_notes(element),
        step=default_step(element),
        exchange=element.kind != "speed",
        time_unit="s" if element.units == "SI" else "1",
        **parts,
    )


def source_text(elements: Iterable[Element]) -> str:
    """Bearing, oil, load and speed of elements in words, where their source names them.

    A description is one line: characters that are not printable are left out.
    """
    given = (str((element.source or {}).get("contact") or "") for element in elements)
    texts = ("".join(filter(str.isprintable, " ".join(text.split())))[:LONGEST_NAME] for text in given)
    return "".join(f"; {text}" for text in dict.fromkeys(texts) if text)


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


def _notes(element: Element) -> tuple[tuple[str, str], ...]:
    lines = [("Element", f"{element.kind}, units: {element.units}")]
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


def _flat(details: Mapping[str, object]) -> str:
    return "; ".join(f"{key}: {_plain(details[key])}" for key in sorted(details) if details[key] is not None)


def _plain(value: object) -> str:
    """A value as text: short numbers, entries of a container in brackets."""
    if isinstance(value, Mapping):
        return f"({', '.join(f'{key} {_plain(one)}' for key, one in value.items() if one is not None)})"
    if isinstance(value, list | tuple):
        return f"({', '.join(map(_plain, value))})"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _spring_parts(element: SpringContact, lead: float) -> dict[str, Any]:
    """Fields of the `ModelSpec` of an element without memory."""
    common = ContactVariables(element)
    coefficients = dict(_POWER if element.kind == "power" else _POLYNOMIAL)
    seven = element.kind == "polynomial"
    if not seven:
        for name in ("C2", "C3", "B4"):
            coefficients.pop(name, None)
    damper = "seven-term" if seven else "viscous"
    levels_off = seven and element.rate is not None
    law = (*coefficients, *_ENDS, *(("rate_max",) if levels_off else ()))
    _spring_variables(element, common, coefficients, law, levels_off, lead)
    return {
        "description": f"Rolling contact as a {element.kind} spring with a {damper} damper",
        "sources": ("core.c", "core_step.c", "validity.c", "model_contact.c"),
        "headers": ("core.h", "model.h", "validity.h", "dual.h"),
        "variables": tuple(common.variables),
        "macros": common.macros() | _spring_macros(law, element, levels_off),
    }


def _spring_variables(
    element: SpringContact,
    common: ContactVariables,
    coefficients: dict[str, Any],
    law: tuple[str, ...],
    levels_off: bool,
    lead: float,
) -> None:
    values = {"K2": 0.0, "K3": 0.0} | element.parameters | {"low": element.low, "high": element.high}
    force, stiffness, damping = element.step_tangents(1.0, float(element.high), 0.0)
    depends = ("approach", "rate", *law)
    middle, length = 0.5 * (element.low + element.high), element.high - element.low
    rate = element.rate if element.rate else force / damping if damping > 0.0 else length
    common.input("approach", "m", middle, element.high, "Mutual approach, positive when the bodies come closer")
    common.input("rate", "m/s", 0.0, rate, "Rate of the approach")
    common.output("force", "N", force, depends, "Contact force, positive = repulsive, never negative")
    common.output("stiffness", "N/m", stiffness, depends, "Tangent d(force)/d(approach)")
    common.output("damping", "N.s/m", damping, depends, "Tangent d(force)/d(rate)")
    common.flags(depends, first=True)
    # a seven-term damper may start below zero where its other terms make up for it
    positive = ("K", "n") if element.kind == "polynomial" else ("K", "n", "C1")
    for name, (unit, text) in (coefficients | _ENDS).items():
        more = _band_text(element) if name == "C1" else ""
        common.add(
            name, "parameter", "tunable", text + more,
            unit=None if unit is None and element.units == "SI" else common.unit(unit or "1"),
            start=float(values[name]), minimum=0.0 if name in positive else None,
        )  # fmt: skip
    if levels_off:
        common.add(
            "rate_max", "parameter", "tunable", "Largest rate of the data, beyond which the damper levels off",
            unit=common.unit("m/s"), start=float(element.rate or 0.0), minimum=0.0,
        )  # fmt: skip
    common.lead(CONTACT, lead)
    common.flags(depends, first=False)
    common.box(low_high=False, rate=not levels_off)


def _band_text(element: Element) -> str:
    """Frequency band of a damper without memory, as text."""
    band = element.omega_range
    return "" if band is None else f", for motion of {frequency_text(band, element.units)}"


def _spring_macros(law: tuple[str, ...], element: SpringContact, levels_off: bool) -> dict[str, str]:
    pairs = ", ".join(f"law->{name.removesuffix('_max')} = read(value, seed, VR_{name})" for name in law)
    return {
        "LAW_POWER": str(int(element.kind == "power")),
        "LAW_SEVEN": str(int(element.kind == "polynomial")),
        "LAW_LEVELS_OFF": str(int(levels_off)),
        "N_CACHE": "4",
        "LAW_READ": pairs,
        "LAW_REFERENCES": ", ".join(f"VR_{name}" for name in law),
        "LAW_NAMES": f'"{", ".join(law[:-1])} and {law[-1]}"',
    }


def _film_parts(element: Film, lead: float) -> dict[str, Any]:
    """Fields of the `ModelSpec` of an element with a film memory."""
    common, lags, speeds = ContactVariables(element), element.lags, element.speeds
    states = () if speeds else ("s", "y", *(f"q[{k}]" for k in range(1, lags + 1)))
    force, length, time = element._units
    u = element.approach_at(force)
    K = element.spring_tangent(u)
    C = float(element.step_tangents(time, u, 0.0)[2])
    rate = element.rate if element.rate else length / time
    depends = ("approach", "rate", *((SPEED,) if speeds else ()), *states)
    common.input("approach", "m", u, length, "Mutual approach, positive when the bodies come closer")
    common.input("rate", "m/s", 0.0, rate, "Rate of the approach")
    if speeds:
        text = "Sum of both surface speeds; the film follows its changes, and its sign says nothing"
        common.speed(SPEED, element.speed, speeds[-1] * element._reference_speed, text)
    common.output("force", "N", force, depends, "Contact force, positive = repulsive, never negative")
    common.output("stiffness", "N/m", K, depends, "d(force)/d(approach), the states of the film as they are")
    common.output("damping", "N.s/m", C, depends, "d(force)/d(rate), the states of the film as they are")
    common.flags(depends, first=True)
    words = "at the end of the last inner step, through the film's memory too"
    for name, of, unit in (("step_stiffness", "approach", "N/m"), ("step_damping", "rate", "N.s/m")):
        common.add(name, "local", "discrete", f"d(force)/d({of}) {words}", unit=common.unit(unit))
    common.lead(CONTACT, lead)
    common.flags(depends, first=False)
    common.box(low_high=True)
    if not speeds:
        nominal = max(rate * time / length, 1e-3)
        _film_states(common, states, nominal, float(film_made(0.0, element.law)), element.law.rim > 0.0)
    law = (*LAW, "film_speed") if speeds else LAW
    what = "film memory over the speed" if speeds else "film memory"
    return {
        "description": f"Rolling contact with a {what} ({element.kind} element, {lags} lags)",
        "sources": ("core.c", "core_step.c", "validity.c", "model_film.c", *(f"{name}.c" for name in law)),
        "headers": ("core.h", "model.h", "validity.h", "jet.h", *(f"{name}.h" for name in law)),
        "variables": tuple(common.variables),
        "macros": common.macros() | _film_macros(element),
        "tables": {"film_tables.h": _film_tables(element)},
    }


def _film_tables(element: Film) -> str:
    """C text of the tables of a film: of one law, or of those at all speeds."""
    laws = element._range.laws
    if element.speeds is None:
        return _header(TABLES, _law_tables(element.law))
    text = _header(TABLES, {"film_speeds": np.array(element.speeds)})
    rows = []
    for k, law in enumerate(laws):
        tables = {f"{name}_{k}": values for name, values in _law_tables(law).items()}
        text += "".join(f"{c_table(name, values)}\n" for name, values in tables.items())
        numbers = (law.lag_rate, law.inlet_rate, law.fast_rate, law.inlet_saturation, law.rim)
        rows.append(", ".join(["CURVE_NODES, GAIN_ROWS, LAGS", *tables, *(c_double(float(x)) for x in numbers)]))
    laws_text = ",\n".join(f"    {{{row}}}" for row in rows)
    return f'#include "film_speed.h"\n\n{text}static const FilmLaw film_laws[] = {{\n{laws_text}}};\n'


def _law_tables(law: FilmLaw) -> dict[str, NDArray[np.float64]]:
    return {
        "film_x": law.x,
        "film_y": law.y,
        "film_slope": law.slope,
        "film_u": law.u,
        "film_gain_x": law.gain_x,
        "film_gains": law.gains.ravel(),
    }


def _film_states(
    common: ContactVariables, states: tuple[str, ...], nominal: float, made: float, rim: bool
) -> None:
    texts = ("State of the inlet lag", "State of the fast lag")
    for k, name in enumerate(states):
        text = texts[k] if k < len(texts) else f"Film at the end of lag {k - 1} of the chain"
        size = nominal if k < len(texts) else max(made * nominal, 1e-6)  # the chain holds film made
        common.add(name, "local", "continuous", text, unit="1", start=0.0, nominal=size)
    unit = "1/s" if common.element.units == "SI" else "1"
    for k, name in enumerate(states):
        if k < len(texts):
            depends: tuple[str, ...] = ("approach", "rate", name)
        else:
            fed = ("s",) if k == len(texts) else (states[k - 1],)
            depends = ("approach", "rate", *dict.fromkeys(("s", *fed)), name) if rim else ("approach", *fed, name)
        common.derivative(name, unit, depends)


def _film_macros(element: Film) -> dict[str, str]:
    law = element.law
    numbers = {
        "LAG_RATE": law.lag_rate,
        "INLET_RATE": law.inlet_rate,
        "FAST_RATE": law.fast_rate,
        "INLET_SATURATION": law.inlet_saturation,
        **dict(zip(("SCALE_FORCE", "SCALE_LENGTH", "SCALE_TIME"), element._units, strict=True)),
    }
    speeds = () if element.speeds is None else element.speeds
    if speeds:
        numbers |= {"SCALE_SPEED": element._reference_speed, "BOX_SPEED": speeds[-1] * element._reference_speed}
    counts = {
        "N_CACHE": 5 + (HISTORY + element.lags if speeds else 0),
        "SPEEDS": len(speeds),
        "LAGS": element.lags,
        "CURVE_NODES": law.x.size,
        "GAIN_ROWS": law.gain_x.size,
        "RIM": int(law.rim > 0.0),
    }
    return {k: str(v) for k, v in counts.items()} | {k: c_double(float(v)) for k, v in numbers.items()}


def _header(text: str, tables: dict[str, NDArray[np.float64]]) -> str:
    lines = [
        f"/* Generated by ehlcontact: {text}. */",
        *(c_table(name, values) for name, values in tables.items()),
    ]
    return "\n".join([*lines, ""])
