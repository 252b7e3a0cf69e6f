"""Answers of the atlas under conditions that its contacts were not solved under: an oil supply, heat.

Each has a table of its own, from which it gives a `Change`: factors, and differences of C, which may touch zero.
Under several conditions one is applied to what the other leaves: products of factors, an assumption.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.heat import Heat
from ehlcontact.point import Point
from ehlcontact.supply import OilLayer
from reduced_models.atlas.table import HEAD, LOW

_Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Change:
    """What a condition does to rows of answers in the order of `AtlasTable.answers`, shape (n, 5 + 2 k).

    Attributes
    ----------
    rows : ndarray, shape (n, 5 + 2 k)
        Factors on 1 - approach, both films, moment and K; for every C, that at low frequency included, what is
        added to it, over the C at low frequency.
    bars : ndarray, shape (n, 5 + 2 k)
        Half widths of the error bars of `rows`.
    """

    rows: _Floats
    bars: _Floats

    def of(self, values: _Floats, bars: _Floats) -> tuple[_Floats, _Floats]:
        """Changed answers and half widths of their error bars."""
        damping = _is_damping(values.shape[1])
        unit = np.where(damping, values[:, [LOW]], values)
        unit[:, 0] = 1.0 - values[:, 0]
        changed = np.where(damping, values + unit * self.rows, unit * self.rows)
        changed[:, 0] = 1.0 - changed[:, 0]
        grown = np.where(damping, 1.0, self.rows)
        return changed, np.hypot(grown * bars, unit * self.bars)


class Condition(Protocol):
    """A condition at a point: it changes answers under loads in units of the point's."""

    name: str  # of the argument that it is given by

    def change(self, loads: _Floats, values: _Floats) -> Change:
        """Change of the flooded isothermal `values`, shape (n, 5 + 2 k), under `loads`, shape (n,)."""

    def noted(self, flooded: float, film: float) -> dict[str, Any]:
        """Fields of an `AtlasAnswer` that tell of it; central film without and with all conditions."""

    def to_dict(self) -> dict[str, Any]:
        """Its inputs, ready for JSON."""


def conditions_at(point: Point, supply: OilLayer | None, thermal: Heat | None) -> list[Condition]:
    """The conditions given at a point, in the order in which they are applied.

    Raises
    ------
    InputError
        A supply or heat that its table does not have.
    """
    found: list[Condition] = []
    for name, value in (("supply", supply), ("thermal", thermal)):
        if value is not None:
            raise InputError(name, type(value).__name__, "left out: no table of it is there")
    return found


def changed(
    conditions: Sequence[Condition], loads: _Floats, values: _Floats, bars: _Floats
) -> tuple[_Floats, _Floats]:
    """Answers under all conditions, and half widths of their error bars; without any, the same arrays."""
    flooded = values
    for one in conditions:
        values, bars = one.change(loads, flooded).of(values, bars)
    return values, bars


def _is_damping(columns: int) -> NDArray[np.bool_]:
    """Which columns of answers are C."""
    which = np.zeros(columns, dtype=bool)
    which[LOW] = which[(HEAD + columns) // 2 :] = True
    return which
