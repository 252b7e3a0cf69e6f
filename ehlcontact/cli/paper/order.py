"""Whether three grids show the order in the mesh, and what Richardson's extrapolation then makes of them.

The scheme is second order on fine meshes, but a number read off a fit on coarse ones need not be there yet:
extrapolating it all the same took the roots of Table 3 further from their limit than the finer grid was.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ehlcontact.cli.numerals import numeral

ORDER = 2.0  # of the scheme
# Orders taken for the second: what is extrapolated is then still five times nearer the limit than the finest grid.
SEEN = 1.8, 2.2


@dataclass(frozen=True)
class Limit:
    """A number on meshes halved twice, and its limit where they show one."""

    order: float | None  # seen; None where the changes do not shrink in one direction, or a grid is missing
    extrapolated: float | None  # None unless the second order is seen
    verdict: str  # in words


def limit(values: Sequence[float | None]) -> Limit:
    """The limit of a number as the mesh goes to zero.

    Parameters
    ----------
    values : sequence of float or None, length 3
        On n/4, n/2 and n intervals; None where there is none.

    Returns
    -------
    Limit
        ``order`` is log2 of the first change over the second one.
    """
    coarse, middle, fine = values
    if coarse is None or middle is None or fine is None:
        return Limit(None, None, "-")
    first, second = middle - coarse, fine - middle
    if first * second <= 0.0 or abs(second) >= abs(first):
        return Limit(None, None, "none")
    order = math.log2(first / second)
    if not SEEN[0] <= order <= SEEN[1]:
        return Limit(order, None, numeral(order, 3))
    return Limit(order, fine + second / (2.0**ORDER - 1.0), numeral(order, 3))
