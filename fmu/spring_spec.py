"""Variables and C text of the contact elements without memory."""

from __future__ import annotations

from typing import Any

from fmu.contact_variables import ContactVariables, band_text
from fmu.lead import CONTACT
from reduced_models import CubicContact, LinearContact, PolynomialContact, PowerLawContact

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
    "C": ("N.s/m", "Damping coefficient"),
}
_ENDS = {
    "low": ("m", "Lower end of the validity interval of the approach"),
    "high": ("m", "Upper end of the validity interval of the approach"),
}
_POSITIVE = ("K", "n")
_VISCOUS = ("C1", "C")

Spring = LinearContact | CubicContact | PolynomialContact | PowerLawContact


def spring_parts(element: Spring, lead: float) -> dict[str, Any]:
    """Fields of the `ModelSpec` of an element without memory."""
    common = ContactVariables(element)
    coefficients = dict(_POWER if isinstance(element, PowerLawContact) else _POLYNOMIAL)
    seven = isinstance(element, PolynomialContact)
    if not seven:
        for name in ("C2", "C3", "B4"):
            coefficients.pop(name, None)
    damper = "seven-term" if seven else "viscous"
    levels_off = seven and element.rate is not None
    law = (*coefficients, *_ENDS, *(("rate_max",) if levels_off else ()))
    _variables(element, common, coefficients, law, levels_off, lead)
    return {
        "description": f"Rolling contact as a {element.kind} spring with a {damper} damper",
        "sources": ("core.c", "core_step.c", "validity.c", "model_contact.c"),
        "headers": ("core.h", "model.h", "validity.h", "dual.h"),
        "variables": tuple(common.variables),
        "macros": common.macros() | _macros(law, element, levels_off),
    }


def _variables(
    element: Spring,
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
    positive = _POSITIVE if isinstance(element, PolynomialContact) else (*_POSITIVE, *_VISCOUS)
    for name, (unit, text) in (coefficients | _ENDS).items():
        more = band_text(element) if name in _VISCOUS else ""
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


def _macros(law: tuple[str, ...], element: Spring, levels_off: bool) -> dict[str, str]:
    power, seven = isinstance(element, PowerLawContact), isinstance(element, PolynomialContact)
    damper = "C" if power else "C1"
    springs = ("K", "n", "u0", "F0") if power else ("K1", "K2", "K3")
    entries = {name: f"spring[{k}]" for k, name in enumerate(springs)}
    entries |= {damper: "C1", "rate_max": "rate"}
    pairs = ", ".join(f"law->{entries.get(name, name)} = read(value, seed, VR_{name})" for name in law)
    flags = {"LAW_POWER": "1"} if power else {}
    flags |= {"LAW_SEVEN": "1", "LAW_LEVELS_OFF": str(int(levels_off))} if seven else {}
    return flags | {
        "N_CACHE": "4",
        "LAW_READ": pairs,
        "LAW_REFERENCES": ", ".join(f"VR_{name}" for name in law),
        "LAW_NAMES": f'"{", ".join(law[:-1])} and {law[-1]}"',
        "LAW_DAMPER": f'"{damper}"',
    }
