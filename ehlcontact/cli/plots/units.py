"""What the axes show: SI where a result has scales, dimensionless numbers otherwise."""

from __future__ import annotations

from typing import Any, NamedTuple

from ehlcontact import quantities as q
from ehlcontact.point import Scales


class Axis(NamedTuple):
    """Factor from the dimensionless number to the one on the axis, and the axis's name."""

    factor: float
    label: str

    def __call__(self, values: Any) -> Any:
        """`values`, dimensionless, as the axis shows them."""
        return values * self.factor


class Units(NamedTuple):
    """Axes of one contact."""

    x: Axis  # along rolling
    y: Axis  # across
    time: Axis
    approach: Axis
    film: Axis
    force: Axis
    pressure: Axis


# Of an axis: what it shows, in which part of the SI unit, its label with a unit of length and without one.
_AXES = {
    "x": (q.ALONG, 1e3, "x along rolling [mm]", "X = x/a along rolling"),
    "y": (q.ACROSS, 1e3, "y across [mm]", "Y = y/b across"),
    "time": (q.TIME, 1e3, "time [ms]", "time T = u_sum t/(2a)"),
    "approach": (q.LENGTH, 1e6, "approach [µm]", "approach u"),
    "film": (q.LENGTH, 1e6, "film [µm]", "film H [dry approach]"),
    "force": (q.FORCE, 1.0, "force [N]", "force f/f0"),
    "pressure": (q.PRESSURE, 1e-9, "pressure [GPa]", "pressure p/p_h"),
}


def units_of(scales: Scales | None) -> Units:
    """Millimetres, milliseconds, micrometres, newtons and gigapascals where there are `scales`."""
    found = {}
    for name, (quantity, part, label, plain) in _AXES.items():
        found[name] = Axis(1.0, plain) if scales is None else Axis(part * quantity.in_si(1.0, scales), label)
    return Units(**found)
