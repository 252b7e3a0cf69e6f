"""Answers of the atlas with an oil supply and with heat, which its flooded isothermal contacts do not have.

Each condition has its own table and gives a `Change`: factors, and for C differences, because C may be zero. With
both, the joint film is T S(r/T): T the share that heat leaves, S the curve over supply, r the layer over the
flooded isothermal film. K and C are changed likewise; docs/heat.md has them beside solved ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.heat import Heat
from ehlcontact.point import Point
from ehlcontact.supply import OilLayer
from reduced_models.atlas.change import Change
from reduced_models.atlas.heat_condition import HeatCondition, rolling_heat
from reduced_models.atlas.supply_condition import SupplyCondition

_Floats = NDArray[np.float64]


class Condition(Protocol):
    """A condition at a point: it changes answers under loads in units of the point's."""

    name: str  # of its keyword argument

    def change(self, loads: _Floats, values: _Floats, Omega: _Floats) -> Change:
        """Change of flooded isothermal `values`, shape (n, 5 + 2 k) with K and C at `Omega`, under `loads`."""

    def noted(self, flooded: float, film: float) -> dict[str, Any]:
        """Fields of an `AtlasAnswer` for it; central films, flooded and isothermal, and under all."""

    def to_dict(self) -> dict[str, Any]:
        """Its inputs, ready for JSON."""


Given = Sequence[Condition | SupplyCondition]


def conditions_at(
    point: Point, supply: OilLayer | None, thermal: Heat | bool | None
) -> list[Condition | SupplyCondition]:
    """The conditions given at a point, in the order in which they are applied; True stands for ``Heat()``.

    Raises
    ------
    InputError
        A supply or heat that its table does not have.
    """
    found: list[Condition | SupplyCondition] = []
    if (heat := rolling_heat(thermal)) is not None:
        found.append(HeatCondition(point, heat))
    if supply is not None:
        found.append(SupplyCondition(point, supply))
    return found


def changed(
    conditions: Sequence[Condition], loads: _Floats, values: _Floats, bars: _Floats, Omega: _Floats
) -> tuple[_Floats, _Floats]:
    """Answers under all conditions, and half widths of their error bars; without any, the same arrays."""
    flooded = values
    for one in conditions:
        values, bars = one.change(loads, flooded, Omega).of(values, bars)
    return values, bars
