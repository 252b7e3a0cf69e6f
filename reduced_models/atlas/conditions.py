"""Conditions of answers of the atlas that its flooded isothermal contacts do not have: oil supply, heat.

Each condition changes answers by its own table: by factors, and for C by differences, because C may be zero. With
both, the joint film is T S(r/T): T the share that heat leaves, S the curve over supply, r the layer over the
flooded isothermal film. K and C are changed alike; docs/notes/heat.md has them beside solved ones.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from reduced_models.atlas.film import HEAD, LOW
from reduced_models.atlas.frequency_curve import FrequencyCurve
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]


class Rows(NamedTuple):
    """Answers of contacts, and the frequencies of their K and C."""

    Omega: _Floats  # (k,)
    values: _Floats  # (n, 5 + 2 k)

    @property
    def stiffness(self) -> _Floats:
        """K, shape (n, k)."""
        return self.values[:, HEAD : HEAD + self.Omega.size]

    @property
    def damping(self) -> _Floats:
        """C, shape (n, k)."""
        return self.values[:, HEAD + self.Omega.size :]

    @property
    def impedance(self) -> NDArray[np.complex128]:
        """K + i C, shape (n, k)."""
        return self.stiffness + 1j * self.damping


@dataclass(frozen=True)
class Change:
    """Change of rows of answers by a condition, shape (n, 5 + 2 k).

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
        damping = np.zeros(values.shape[1], dtype=bool)
        damping[LOW] = damping[(HEAD + values.shape[1]) // 2 :] = True
        unit = np.where(damping, values[:, [LOW]], values)
        unit[:, 0] = 1.0 - values[:, 0]
        changed = np.where(damping, values + unit * self.rows, unit * self.rows)
        changed[:, 0] = 1.0 - changed[:, 0]
        grown = np.where(damping, 1.0, self.rows)
        return changed, np.hypot(grown * bars, unit * self.bars)


class Condition(ABC):
    """A condition at a point; it changes answers under loads in units of the point's."""

    name: ClassVar[str]  # of its keyword argument
    slowest: ClassVar[float] = 0.0  # frequency from which elements follow C
    one_region: ClassVar[bool] = True  # whether oil reaches as far ahead under all loads as under the point's own

    @property
    def speeds(self) -> tuple[float, float]:
        """Lowest and highest speed, over that of the point, at which its table has the contact."""
        return 0.0, np.inf

    def frequencies(self, Omega: _Floats) -> _Floats:
        """Frequencies that answers at `Omega` need under it."""
        return Omega

    @abstractmethod
    def change(self, loads: _Floats, values: _Floats, Omega: _Floats, isothermal: _Floats) -> Change:
        """Change of `values`, shape (n, 5 + 2 k) with K and C at `Omega`, under `loads`, shape (n,).

        `isothermal` are flooded central films without heat, shape (n,).
        """

    def apply(self, loads: _Floats, rows: Rows, bars: _Floats, isothermal: _Floats) -> tuple[Rows, _Floats]:
        """Answers under it and half widths of their error bars."""
        Omega, values = self.frequencies(rows.Omega), rows.values
        if Omega is not rows.Omega:
            values, bars = (_refined(part, rows.Omega, Omega) for part in (values, bars))
        values, bars = self.change(loads, values, Omega, isothermal).of(values, bars)
        return Rows(Omega, values), bars

    @abstractmethod
    def gains(self, gains: _Floats, low: _Floats, rates: FilterRates, before: Rows, after: Rows) -> _Floats:
        """Gains of elements under it, from those without, all over the flooded isothermal damping `low`."""

    def approaches(self, loads: _Floats, before: Rows, after: Rows) -> _Floats:
        """Approaches of elements under increasing `loads`."""
        return after.values[:, 0]

    @abstractmethod
    def noted(self, flooded: float) -> dict[str, Any]:
        """Fields of an `AtlasAnswer` for it, given the flooded isothermal central film."""

    @abstractmethod
    def to_dict(self) -> dict[str, Any]:
        """Its inputs, ready for JSON."""


def under(conditions: Sequence[Condition], loads: _Floats, rows: Rows, bars: _Floats) -> tuple[Rows, _Floats]:
    """Answers under all conditions, one after the other, and half widths of their error bars."""
    isothermal = rows.values[:, 1]
    for condition in conditions:
        rows, bars = condition.apply(loads, rows, bars, isothermal)
    return rows, bars


def _refined(rows: _Floats, Omega: _Floats, nodes: _Floats) -> _Floats:
    """Rows of answers, or of their error bars, at nodes between and beside the frequencies that they have."""
    k = Omega.size
    parts = (rows[:, HEAD : HEAD + k], rows[:, HEAD + k :])
    return np.hstack([rows[:, :HEAD], *([FrequencyCurve(Omega, row).at(nodes) for row in part] for part in parts)])
