"""What the axes show: SI where a result has scales, dimensionless numbers otherwise."""

from __future__ import annotations

from typing import Any, NamedTuple

from ehlcontact.point import Scales


class Quantity(NamedTuple):
    """Factor from the dimensionless number to the one on the axis, and the axis's name."""

    factor: float
    label: str

    def __call__(self, values: Any) -> Any:
        """`values`, dimensionless, as the axis shows them."""
        return values * self.factor


class Units(NamedTuple):
    """Quantities of one contact."""

    x: Quantity  # along rolling
    y: Quantity  # across
    time: Quantity
    approach: Quantity
    film: Quantity
    force: Quantity
    pressure: Quantity


DIMENSIONLESS = Units(
    x=Quantity(1.0, "X = x/a along rolling"),
    y=Quantity(1.0, "Y = y/b across"),
    time=Quantity(1.0, "time T = u_sum t/(2a)"),
    approach=Quantity(1.0, "approach u"),
    film=Quantity(1.0, "film H [dry approach]"),
    force=Quantity(1.0, "force f/f0"),
    pressure=Quantity(1.0, "pressure p/p_h"),
)


def units_of(scales: Scales | None) -> Units:
    """Millimetres, milliseconds, micrometres, newtons and gigapascals where there are `scales`."""
    if scales is None:
        return DIMENSIONLESS
    return Units(
        x=Quantity(scales.a * 1e3, "x along rolling [mm]"),
        y=Quantity(scales.b * 1e3, "y across [mm]"),
        time=Quantity(scales.time * 1e3, "time [ms]"),
        approach=Quantity(scales.length * 1e6, "approach [µm]"),
        film=Quantity(scales.length * 1e6, "film [µm]"),
        force=Quantity(scales.force, "force [N]"),
        pressure=Quantity(scales.pressure * 1e-9, "pressure [GPa]"),
    )
