"""`ModelSpec`: variables and C files of an FMU; XML, C headers and documentation follow from it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from ehlcontact.errors import InputError
from fmu.lead import Lead

# Exponents of the SI base units, by unit name; "1" has none.
UNITS: dict[str, dict[str, int]] = {
    "1": {},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N/s": {"kg": 1, "m": 1, "s": -3},
    "N/m": {"kg": 1, "s": -2},
    "F": {"kg": -1, "m": -2, "s": 4, "A": 2},
    "N.m-2": {"kg": 1, "m": -1, "s": -2},
    "N.m-3": {"kg": 1, "m": -2, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
    "N.s2.m-2": {"kg": 1, "m": -1},
    "N.s3.m-3": {"kg": 1, "m": -2, "s": 1},
    "N.s.m-2": {"kg": 1, "m": -1, "s": -1},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N.m/rad": {"kg": 1, "m": 2, "s": -2, "rad": -1},
    "N.m.s/rad": {"kg": 1, "m": 2, "s": -1, "rad": -1},
    "N.m/s": {"kg": 1, "m": 2, "s": -3},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "rad/s2": {"rad": 1, "s": -2},
    "1/s": {"s": -1},
    "s": {"s": 1},
    "kg": {"kg": 1},
    "kg.m": {"kg": 1, "m": 1},
    "kg.m2": {"kg": 1, "m": 2},
    "m/s2": {"m": 1, "s": -2},
}
# What an importer may show instead: name, and how many of them make one unit.
DISPLAY_UNITS: dict[str, tuple[str, float]] = {
    "m": ("um", 1e6),
    "m/s": ("mm/s", 1e3),
    "N": ("kN", 1e-3),
    "N/m": ("N/um", 1e-6),
    "rad/s": ("Hz", 0.15915494309189535),
    "kg.m": ("g.mm", 1e6),
    "F": ("pF", 1e12),
}

# File names that Windows keeps for devices, whatever the ending.
DEVICES = {"CON", "PRN", "AUX", "NUL", *(f"{name}{k}" for name in ("COM", "LPT") for k in range(10))}


@dataclass(frozen=True, slots=True)
class Variable:
    """One FMI variable.

    Inputs, parameters, constants and states have a start value; what is computed has none and names what it
    depends on. A state that is computed at the start has a `guess`: tools that do not let the FMU compute it, as
    CasADi, begin there.
    """

    name: str
    value_reference: int
    causality: str  # input, parameter, output, local
    variability: str  # continuous, tunable, fixed, discrete, constant
    description: str
    type: str = "Real"  # Real, Boolean
    unit: str | None = None  # key of UNITS; None of a Boolean, or of a unit that FMI cannot express
    start: float | None = None
    minimum: float | None = None
    maximum: float | None = None
    nominal: float | None = None
    depends: tuple[str, ...] = ()  # names of inputs, parameters and states
    derivative_of: str | None = None  # name of a state
    follows: tuple[str, ...] = ()  # of a state without a start value: names of inputs and parameters that give it
    guess: float | None = None  # of such a state: its value at the start values of these
    rate: str | None = None  # of an input: name of the input that is its rate

    @property
    def declared_start(self) -> float | None:
        """Start value in the model description."""
        return self.guess if self.start is None else self.start


@dataclass(frozen=True)
class ModelSpec:
    """One FMU: its variables and the C sources that compute them.

    Value references count from 0, in the order of the variables; states follow one another, and so do their
    derivatives.
    """

    name: str
    description: str
    sources: tuple[str, ...]  # C files of the model, compiled
    headers: tuple[str, ...]  # C headers of the model, shipped beside them
    variables: tuple[Variable, ...]
    notes: tuple[tuple[str, str], ...] = ()  # label and text, for the documentation only
    macros: Mapping[str, str] = field(default_factory=dict)  # of config.h, name to C text
    tables: Mapping[str, str] = field(default_factory=dict)  # generated files, name to C text; a .c is compiled
    step: float = 1e-3  # that resolves the contact
    tolerance: float = 1e-6  # relative, that model exchange needs for three digits of what moves
    time_unit: str = "s"
    # Whether it is for model exchange too, with partial derivatives, or for co-simulation alone.
    exchange: bool = True
    # Whether co-simulation has none of partial derivatives, those of outputs in time, and events.
    plain_steps: bool = False
    # Event indicators, one for each contact: name in FMI 3.0, and a variable that depends on the same.
    indicators: tuple[tuple[str, str], ...] = (("contact_indicator", "force"),)
    # Terminals of FMI 3.0: name, description, and the variables that are approach, rate and force.
    flanges: tuple[tuple[str, str, tuple[str, str, str]], ...] = (
        ("flange", "Mutual approach and its rate in, force between the bodies out", ("approach", "rate", "force")),
    )

    def __post_init__(self) -> None:
        names = [variable.name for variable in self.variables]
        references = [variable.value_reference for variable in self.variables]
        if len(set(names)) < len(names) or references != list(range(len(references))):
            raise InputError("variables", names, "unique in name, with value references from 0 on")
        if self.inputs != self.variables[: len(self.inputs)]:
            raise InputError("variables", names, "inputs first")

    @property
    def identifier(self) -> str:
        """Name of the library file: `name` as a C identifier."""
        text = re.sub(r"[^0-9A-Za-z_]", "_", self.name)
        taken = text.upper() in DEVICES  # con.dll would be the console
        return text if text[0].isalpha() and not taken else f"m{text}"

    @cached_property
    def _named(self) -> dict[str, Variable]:
        return {variable.name: variable for variable in self.variables}

    def __getitem__(self, name: str) -> Variable:
        return self._named[name]

    def index(self, name: str) -> int:
        """Position in the model description, from 1."""
        return 1 + self[name].value_reference

    @property
    def outputs(self) -> tuple[Variable, ...]:
        """Variables of causality output."""
        return tuple(variable for variable in self.variables if variable.causality == "output")

    @property
    def inputs(self) -> tuple[Variable, ...]:
        """Variables of causality input."""
        return tuple(variable for variable in self.variables if variable.causality == "input")

    @cached_property
    def derivatives(self) -> tuple[Variable, ...]:
        """Derivatives of the states, in their order."""
        return tuple(variable for variable in self.variables if variable.derivative_of is not None)

    @cached_property
    def states(self) -> tuple[Variable, ...]:
        """Continuous-time states."""
        return tuple(self[variable.derivative_of] for variable in self.derivatives if variable.derivative_of)

    @cached_property
    def _state_names(self) -> frozenset[str]:
        return frozenset(variable.name for variable in self.states)

    @property
    def partials(self) -> bool:
        """Whether co-simulation has partial derivatives, those of outputs in time too."""
        return self.exchange and not self.plain_steps

    def initially(self, variable: Variable) -> tuple[str, ...]:
        """Names of what a variable depends on at the start: for some states, what these follow from."""
        if variable.name in self._state_names:
            return variable.follows
        found = (self[name] for name in variable.depends)
        names = (v.follows if v.start is None and v.name in self._state_names else (v.name,) for v in found)
        return tuple(dict.fromkeys(name for group in names for name in group))

    def role(self, variable: Variable) -> str:
        """What the C sources call its part."""
        if variable.derivative_of is not None:
            return "DERIVATIVE"
        if variable.name in self._state_names:
            return "STATE"
        if variable.causality == "local" and variable.variability != "constant":
            return "MEASURE"
        if variable.variability == "constant":
            return "CONSTANT"
        if variable.causality == "parameter":
            return "TUNABLE" if variable.variability == "tunable" else "FIXED"
        return variable.causality.upper()


class VariableList:
    """Variables, numbered as they are appended."""

    def __init__(self) -> None:
        self.variables: list[Variable] = []

    def add(self, name: str, causality: str, variability: str, text: str, **more: Any) -> None:
        """Append a variable."""
        self.variables.append(Variable(name, len(self.variables), causality, variability, text, **more))

    def derivative(self, name: str, unit: str | None, depends: tuple[str, ...]) -> None:
        """Append the derivative of a state."""
        self.add(
            f"der({name})", "local", "continuous", f"Derivative of {name}",
            unit=unit, depends=depends, derivative_of=name,
        )  # fmt: skip

    def lead(self, kind: Lead, start: float) -> None:
        """Append the lead of forces."""
        self.add(
            kind.name, "parameter", "fixed", kind.text,
            unit="1", start=kind.check(start), minimum=0.0, maximum=kind.most,
        )  # fmt: skip
