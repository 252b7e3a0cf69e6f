"""Error estimates of a steady film, and of its stiffness and damping, from the differences of three grids.

With d the difference between the finest grid and the one of half its intervals, and r the ratio of the
difference before to d, an error that falls regularly is d/(r - 1). It does not always fall regularly: on a grid
that hardly resolves the inlet errors fall faster than they will later, some parts fall at first order, and where
parts cancel d is small by chance. So r is bounded, and the estimate is at least a share of the difference before.
Bounds and share were measured: docs/notes/solver_development.md, "Accuracy and error estimates".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass
from itertools import pairwise
from typing import Annotated, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.quantities import LENGTH

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

SLOWEST, FASTEST = 1.5, 3.0  # bounds of r: the estimate is between d/2 and 2 d,
FIRST_SHARE = 1.0 / 15.0  # but not less than this share of the difference before: second order over both halvings
RESPONSE_SHARE = 1.0 / 6.0  # the same of stiffness and damping,
NOISE = 1e-3, 5e-3  # and what is added to their errors, over themselves
ALL = 1.0  # no error is given as larger: then nothing is known


@dataclass(frozen=True, slots=True)
class ErrorEstimate:
    """Estimated discretisation error of a steady film, on its own region.

    Attributes
    ----------
    approach : float
        Error of the mutual approach [m; dry approach], in the units of its result.
    h_central_relative, h_min_relative : float
        Errors of the film at X = Y = 0 and of the smallest, each over that film; 1 where nothing is known.
    """

    approach: Annotated[float, LENGTH]
    h_central_relative: float
    h_min_relative: float

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
    return float(_falling(d, abs(coarse - coarsest), FIRST_SHARE))


def response_error(omega: Floats, found: Sequence[Complex]) -> tuple[Floats, Floats]:
    """Estimated errors of the stiffness and the damping of the first of these impedances, both shape (k,).

    The film carried through the contact turns in phase with frequency, and so does its error: a difference that is
    small in one of the two and large in the other counts in both. Towards rest, where both are even in frequency,
    that share of the other vanishes. `NOISE` is added, because the edge of the pressure moves by whole nodes from
    mesh to mesh. Measured: docs/notes/solver_development.md, "Accuracy and error estimates".

    Parameters
    ----------
    omega : ndarray, shape (k,)
        Frequencies > 0.
    found : sequence of ndarray, shape (k,)
        Impedances at them; each mesh is twice the one after. From three; of two, the difference. Of one alone
        nothing is known: as much as it is.
    """
    Z = found[0]
    K, C = np.abs(Z.real), np.abs(Z.imag) / omega
    if len(found) == 1:
        return K, C
    differences = [_turned(omega, one - other) for one, other in pairwise(found)]
    if len(differences) == 1:
        stiffness, damping = differences[0]
    else:
        stiffness, damping = (_falling(d, before, RESPONSE_SHARE) for d, before in zip(*differences, strict=True))
    return stiffness + NOISE[0] * K, damping + NOISE[1] * C


def wave_error(found: Sequence[Complex], impedance: Floats) -> Floats:
    """Estimated error of the first of these forces of waves, shape (k,), whatever its phase.

    `NOISE` is over the impedance: where both halves of the contact cancel, the force is no measure.

    Parameters
    ----------
    found : sequence of ndarray, shape (k,)
        Forces, as in `response_error`.
    impedance : ndarray, shape (k,)
        Size of the impedance.
    """
    differences = [np.abs(one - other) for one, other in pairwise(found)]
    if not differences:
        return np.maximum(np.abs(found[0]), impedance)
    error = differences[0] if len(differences) == 1 else _falling(differences[0], differences[1], RESPONSE_SHARE)
    return np.asarray(error + NOISE[0] * impedance)


def _turned(omega: Floats, difference: Complex) -> tuple[Floats, Floats]:
    """Size of a difference in stiffness and in damping, whatever its phase."""
    stiffness, damping = np.abs(difference.real), np.abs(difference.imag) / omega
    return np.hypot(stiffness, omega * damping), np.hypot(damping, np.minimum(omega, 1.0 / omega) * stiffness)


def _falling(d: ArrayLike, before: ArrayLike, share: float) -> Floats:
    """Estimated error from the last difference of three meshes and the one before."""
    with np.errstate(divide="ignore", invalid="ignore"):  # no difference at all: the bound holds
        r = np.clip(np.nan_to_num(np.divide(before, d), nan=FASTEST), SLOWEST, FASTEST)
    return np.asarray(np.maximum(d / (r - 1.0), np.multiply(share, before)))
