"""Variables that the FMU of every contact element has."""

from __future__ import annotations

import math

from fmu.c_headers import c_double
from fmu.lead import CONTACT
from fmu.spec import VariableList
from reduced_models import (
    FilmContact,
)
from reduced_models.elements.spring import SpringContact
from reduced_models.elements.validity import MARGIN

Element = SpringContact | FilmContact
Film = FilmContact

ALLOWED_ERROR = 1e-4  # of the force in a step that is cut inside, where the importer gives no tolerance


class ContactVariables(VariableList):
    """The variables of one contact, in the units of its element."""

    def __init__(self, element: Element) -> None:
        super().__init__()
        self.element = element

    def unit(self, si: str) -> str:
        """The unit of a quantity of the element."""
        return si if self.element.units == "SI" else "1"

    def input(self, name: str, si: str, start: float, nominal: float, text: str) -> None:
        """Append an input."""
        rate = "rate" if name == "approach" else None
        self.add(
            name, "input", "continuous", text,
            unit=self.unit(si), start=start, nominal=_nominal(nominal), rate=rate,
        )  # fmt: skip

    def speed(self, name: str, start: float, most: float, text: str) -> None:
        """Append a speed of the surfaces as an input; `most` is the highest one of the tables."""
        self.add(
            name, "input", "continuous", text,
            unit=self.unit("m/s"), start=start, nominal=most, minimum=-most, maximum=most,
        )  # fmt: skip

    def output(self, name: str, si: str, nominal: float, depends: tuple[str, ...], text: str) -> None:
        """Append a real output that is never negative."""
        self.add(
            name, "output", "continuous", text,
            unit=self.unit(si), minimum=0.0 if name == "force" else None,
            nominal=_nominal(nominal), depends=depends,
        )  # fmt: skip

    def constant(self, name: str, si: str, value: float, text: str) -> None:
        """Append a constant of the element."""
        self.add(name, "local", "constant", text, unit=self.unit(si), start=float(value))

    def flags(self, depends: tuple[str, ...], *, first: bool) -> None:
        """Append outside_validity (`first`), or the flags of its bounds."""
        texts = {
            "outside_validity": f"True where approach, rate or force leave their bounds by more than {MARGIN:.0%}",
            "outside_approach": "True where the approach is outside [low, high] by more than the margin",
            "outside_rate": "True where the rate is larger than rate_max by more than the margin",
            "outside_force": "True where the force is outside [force_min, force_max] by more than the margin",
        }
        if isinstance(self.element, Film) and self.element.speeds is not None:
            texts["outside_speed"] = "True above the highest speed of the tables, whose films then hold"
        for name in list(texts)[:1] if first else list(texts)[1:]:
            self.add(name, "output", "discrete", texts[name], type="Boolean", depends=depends)

    def box(self, *, low_high: bool, rate: bool = True) -> None:
        """Append the known bounds of the validity box, except those that are variables already."""
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
        """Macros of the validity box for config.h; an unknown bound is infinite."""
        _, _, _, least, most = self.element.validity.reach
        known = any(variable.name == "rate_max" for variable in self.variables)
        return {
            "BOX_MARGIN": c_double(MARGIN),
            "BOX_RATE": "m->value[VR_rate_max]" if known else "HUGE_VAL",
            "BOX_LEAST_FORCE": c_double(least),
            "BOX_MOST_FORCE": c_double(most),
            "DEFAULT_TOLERANCE": c_double(ALLOWED_ERROR),
            "FORCE_SIGN": "(-1.0)",  # against the approach
            **CONTACT.macros,
        }


def _nominal(value: float) -> float | None:
    size = abs(value)
    return size if math.isfinite(size) and size > 0.0 else None
