"""`VariableList`: variables in the order of their value references; the parameter `input_meaning` of all FMUs."""

from __future__ import annotations

from typing import Any

from fmu.spec import Choice, Variable

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

    def meaning(self) -> None:
        """Append the parameter `input_meaning`."""
        self.add(
            "input_meaning", "parameter", "fixed",
            "What the inputs of a co-simulation step mean: 1 extrapolated, 2 end, 3 held",
            type="Enumeration", start=1, minimum=1, maximum=len(MEANINGS.items),
        )  # fmt: skip
