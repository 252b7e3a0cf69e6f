"""`VariableList`: variables in the order of their value references; the lead of forces, of all FMUs."""

from __future__ import annotations

from typing import Any

from fmu.lead import Lead
from fmu.spec import Variable


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
