"""Summary and figure of an element: kind, validity, quality of the fit."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ehlcontact.errors import InputError
from ehlcontact.quantities import DAMPING, FORCE, FREQUENCY, LENGTH, STIFFNESS, Quantity
from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import Line, Panel, Picture, stiffness_and_damping
from ehlcontact.summary import Summary
from reduced_models.elements.validity import frequency_text, text_of

if TYPE_CHECKING:
    from reduced_models.elements.validity import Band, Validity


BAND = 0.01, 30.0  # Omega of figures, of an element without a known band
BEYOND = 0.25  # of the interval of approach, that figures show on either side of it


PARAMETER_UNITS = {  # of coefficients of springs and dampers in SI
    "K1": "N/m", "K2": "N/m2", "K3": "N/m3", "K": "N/m^n", "u0": "m", "F0": "N",
    "C1": "N s/m", "C2": "N s2/m2", "C3": "N s3/m3", "B4": "N s/m2",
}  # fmt: skip


def parameter_text(parameters: Mapping[str, Any], units: str) -> str:
    """Coefficients of an element with their units; those of a film are dimensionless in SI too."""
    numbers = {name: value for name, value in parameters.items() if isinstance(value, int | float)}
    known = PARAMETER_UNITS if units == "SI" else {}
    texts = [f"{name} {value:.4g} {known.get(name, '')}".rstrip() for name, value in numbers.items()]
    tables = ", ".join(name for name in parameters if name not in numbers)
    return ", ".join(texts) + f"; tables of {tables}" * bool(tables)


class ElementSummary(Summary):
    """Base of the elements: summary and figure."""

    kind: str
    units: str
    validity: Validity
    load_range: Band | None
    omega_range: Band | None
    fit: Mapping[str, Any] | None
    parameters: Any
    state_count: Any
    low: float
    high: float
    time: Any
    spring: Any
    impedance: Any

    def _summary_name(self) -> str:
        return f"{type(self).__name__} ({self.kind})"

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Matplotlib figure of static force, and of K and C over frequency; into a file too where a path is given.

        Beyond the interval that the element stands for, the force has another colour. An element in SI without
        unit of time and band has no such panels.

        Raises
        ------
        InputError
            The file cannot be written.
        """
        reach = BEYOND * (self.high - self.low)
        u = np.linspace(self.low - reach, self.high + reach, 301)
        force, inside = np.asarray(self.spring(u)), (u >= self.low) & (u <= self.high)
        lines = [
            Line(u, np.where(inside, force, np.nan), "within its validity box"),
            Line(u, np.where(inside, np.nan, force), "beyond"),
        ]
        law = Panel(lines, ("mutual approach", self._unit(LENGTH)), ("static force", self._unit(FORCE)))
        return draw(Picture([law, *self._over_frequency()], f"{self._summary_name()}, {self.units}"), path)

    def _over_frequency(self) -> list[Panel]:
        """K and C about rest under the load that the element was made at, or at the middle of its interval."""
        si, band = self.units == "SI", self.omega_range
        if si and band is None and self.time is None:
            return []
        low, high = band or tuple(end / (self.time if si else 1.0) for end in BAND)
        w = np.geomspace(max(low, 1e-3 * high), high, 121)
        frequency = {"omega" if si else "Omega": w}
        try:
            found = self.impedance(**frequency)
        except InputError:  # a load that is not known
            found = self.impedance(load=float(self.spring(0.5 * (self.low + self.high))), **frequency)
        x = w / (2.0 * np.pi) if si else w
        return stiffness_and_damping(
            lambda name: [Line(x, getattr(found, name))],
            ("frequency", "Hz") if si else ("angular frequency", FREQUENCY.moes),
            (self._unit(STIFFNESS), self._unit(DAMPING)),
        )

    def _unit(self, quantity: Quantity) -> str:
        return quantity.unit if self.units == "SI" else quantity.moes

    def _summary_lines(self) -> list[str]:
        si = self.units == "SI"
        own = ", its coefficients dimensionless" if si else ""
        lines = [
            f"{self.units}, {f'{self.state_count} states{own}' if self.state_count else 'no memory'}",
            parameter_text(self.parameters, self.units),
            f"approach {text_of(self.validity.approach)}{' m' if si else ''}",
        ]
        if self.load_range is not None:
            lines[-1] += f", load {text_of(self.load_range)}{' N' if si else ''}"
        if self.omega_range is not None:
            lines.append(frequency_text(self.omega_range, self.units))
        rms = None if self.fit is None else self.fit.get("rms")
        if isinstance(rms, int | float):
            lines.append(f"rms error {100.0 * rms:.2g} % of the standard deviation of the force it was fitted to")
        return lines
