"""What an FMU is, said once: the XML, the C header, the documentation and the tests all read it from here."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass

from ehlcontact.errors import InputError
from reduced_models import CubicContact, LinearContact
from reduced_models.elements.validity import frequency_text, text_of

Element = LinearContact | CubicContact

# Exponents of the SI base units, by unit name; "1" has none.
UNITS: dict[str, dict[str, int]] = {
    "1": {},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N.m-2": {"kg": 1, "m": -1, "s": -2},
    "N.m-3": {"kg": 1, "m": -2, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
}

# File names that Windows keeps for devices, whatever the ending.
DEVICES = {"CON", "PRN", "AUX", "NUL", *(f"{name}{k}" for name in ("COM", "LPT") for k in range(10))}


@dataclass(frozen=True, slots=True)
class Variable:
    """One FMI variable.

    Inputs and parameters have a start value, outputs have none and name what they depend on.
    """

    name: str
    value_reference: int
    causality: str  # input, parameter, output
    variability: str  # continuous, tunable, discrete
    description: str
    type: str = "Real"  # Real, Boolean
    unit: str | None = None  # key of UNITS; None for a Boolean
    start: float | None = None
    minimum: float | None = None
    depends: tuple[str, ...] = ()  # names of inputs and parameters


@dataclass(frozen=True, slots=True)
class ModelSpec:
    """One FMU: its variables and the C sources that compute them."""

    name: str
    description: str
    header: str  # declares the C struct Model
    sources: tuple[str, ...]  # C files, compiled
    headers: tuple[str, ...]  # C headers, shipped beside them
    variables: tuple[Variable, ...]
    notes: tuple[tuple[str, str], ...] = ()  # label and text, for the documentation only

    def __post_init__(self) -> None:
        names = [variable.name for variable in self.variables]
        references = [variable.value_reference for variable in self.variables]
        if len(set(names)) < len(names) or len(set(references)) < len(references):
            raise InputError("variables", names, "unique in name and value reference")

    @property
    def identifier(self) -> str:
        """Name of the library file: `name` as a C identifier."""
        text = re.sub(r"[^0-9A-Za-z_]", "_", self.name)
        taken = text.upper() in DEVICES  # con.dll would be the console
        return text if text[0].isalpha() and not taken else f"m{text}"

    def __getitem__(self, name: str) -> Variable:
        return next(variable for variable in self.variables if variable.name == name)

    def index(self, name: str) -> int:
        """Position in the model description, from 1."""
        return 1 + [variable.name for variable in self.variables].index(name)

    @property
    def outputs(self) -> tuple[Variable, ...]:
        """Variables of causality output."""
        return tuple(variable for variable in self.variables if variable.causality == "output")

    @property
    def inputs(self) -> tuple[Variable, ...]:
        """Variables of causality input."""
        return tuple(variable for variable in self.variables if variable.causality == "input")


def contact_spec(element: Element, model_name: str | None = None) -> ModelSpec:
    """Specification of a contact element's FMU.

    Units follow the element: SI, or "1" throughout for a dimensionless one. A linear element is the cubic one
    with K2 = K3 = 0, so both have the same variables. The approach starts in the middle of the validity
    interval, the rate at zero.

    Parameters
    ----------
    element : LinearContact or CubicContact
    model_name : str, optional
        Name of the model; the class of the element by default.

    Raises
    ------
    InputError
        Another kind of element, or a name that is empty, too long or not printable.
    """
    if not isinstance(element, LinearContact | CubicContact):
        raise InputError("element", type(element).__name__, "a LinearContact or a CubicContact")
    name = type(element).__name__ if model_name is None else model_name
    if not isinstance(name, str) or not name.strip() or not name.isprintable() or len(name) > 100:
        raise InputError("model_name", name, "1 to 100 printable characters")
    system = "SI units" if element.units == "SI" else _DIMENSIONLESS
    return ModelSpec(
        name=name,
        description=f"Rolling contact as a {element.kind} spring with a viscous damper; {system}",
        header="model_contact.h",
        sources=("fmi2.c", "fmi2_access.c", "fmi2_unsupported.c", "model_contact.c"),
        headers=("fmi2_instance.h", "model.h", "model_contact.h"),
        variables=_contact_variables(element),
        notes=_notes(element),
    )


_DIMENSIONLESS = "dimensionless: force in static loads, approach in dry Hertz approaches, time in 2a/u_sum"


def _contact_variables(element: Element) -> tuple[Variable, ...]:
    def unit(si: str) -> str:
        return si if element.units == "SI" else "1"

    inputs = ("approach", "rate")
    spring = ("K1", "K2", "K3", "low", "high")
    law = (*inputs, *spring, "C1")
    values = {"K2": 0.0, "K3": 0.0} | element.parameters | {"low": element.low, "high": element.high}

    def parameter(reference: int, name: str, si: str, text: str, minimum: float | None = None) -> Variable:
        start = float(values[name])
        return Variable(name, reference, "parameter", "tunable", text, unit=unit(si), start=start, minimum=minimum)

    def entry(reference: int, name: str, si: str, start: float, text: str) -> Variable:
        return Variable(name, reference, "input", "continuous", text, unit=unit(si), start=start)

    def output(reference: int, name: str, si: str, text: str) -> Variable:
        return Variable(name, reference, "output", "continuous", text, unit=unit(si), depends=law)

    middle = 0.5 * (element.low + element.high)
    return (
        entry(0, "approach", "m", middle, "Mutual approach, positive when the bodies come closer"),
        entry(1, "rate", "m/s", 0.0, "Rate of the approach"),
        output(2, "force", "N", "Contact force, positive = repulsive, never negative"),
        output(3, "stiffness", "N/m", "Tangent d(force)/d(approach)"),
        output(4, "damping", "N.s/m", "Tangent d(force)/d(rate)"),
        Variable(
            "outside_validity",
            5,
            "output",
            "discrete",
            "True where the approach is outside [low, high] and the spring is continued like a Hertz contact",
            type="Boolean",
            depends=("approach", "low", "high"),
        ),
        parameter(6, "K1", "N/m", "Coefficient of the approach in the spring force"),
        parameter(7, "K2", "N.m-2", "Coefficient of the squared approach in the spring force"),
        parameter(8, "K3", "N.m-3", "Coefficient of the cubed approach in the spring force"),
        parameter(9, "C1", "N.s/m", f"Damping coefficient{_band(element)}", minimum=0.0),
        parameter(10, "low", "m", "Lower end of the validity interval of the approach"),
        parameter(11, "high", "m", "Upper end of the validity interval of the approach"),
    )


def _band(element: Element) -> str:
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
    return tuple(lines)


def _flat(details: Mapping[str, object]) -> str:
    return "; ".join(f"{key}: {details[key]}" for key in sorted(details))
