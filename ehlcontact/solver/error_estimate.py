"""Error estimate of a steady film from the differences of three grids.

With d the difference between the finest grid and the one of half its intervals, and r the ratio of the
difference before to d, an error that falls regularly is d/(r - 1). It does not always fall regularly: on a grid
that hardly resolves the inlet errors fall faster than they will later, some parts fall at first order, and where
parts cancel d is small by chance. So r is bounded, and the estimate is at least a share of the difference before.
Bounds and share were measured: docs/solver_development.md, "Accuracy and error estimates".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass
from math import inf
from typing import Self

import numpy as np

SLOWEST, FASTEST = 1.5, 3.0  # bounds of r: the estimate is between d/2 and 2 d,
FIRST_SHARE = 1.0 / 15.0  # but not less than this share of the difference before: second order over both halvings
ALL = 1.0  # no error is given as larger: then nothing is known


@dataclass(frozen=True, slots=True)
class ErrorEstimate:
    """Estimated discretisation error of a steady film, on its own region.

    Attributes
    ----------
    approach : float
        Error of the mutual approach, in dry approaches; of a result in SI in m.
    h_central, h_min : float
        Errors of the film at X = Y = 0 and of the smallest, each over that film; 1 where nothing is known.
    """

    approach: float
    h_central: float
    h_min: float

    @classmethod
    def of(cls, found: Sequence[tuple[float, float, float]]) -> Self:
        """Errors of the first of these approaches, central and smallest films; each mesh is twice the one before.

        From three meshes; of two, the difference. The smallest film is not known better than the central one.
        """
        if not np.isfinite(found).all():
            return cls(ALL, ALL, ALL)
        units = 1.0, *found[0][1:]
        errors = (regular_error(*values) for values in zip(*found, strict=True))
        approach, central, smallest = (min(e / unit, ALL) for e, unit in zip(errors, units, strict=True))
        return cls(approach, central, max(smallest, central))

    def within(self, limits: ErrorEstimate) -> bool:
        """Whether none of the three is above its limit."""
        return all(error <= limit for error, limit in zip(astuple(self), astuple(limits), strict=True))


def regular_error(fine: float, coarse: float, coarsest: float | None = None) -> float:
    """Estimated error of the first of these values, from those on coarser grids."""
    d = abs(fine - coarse)
    if coarsest is None:
        return d
    before = abs(coarse - coarsest)
    r = min(max(before / d if d > 0.0 else inf, SLOWEST), FASTEST)
    return max(d / (r - 1.0), FIRST_SHARE * before)
