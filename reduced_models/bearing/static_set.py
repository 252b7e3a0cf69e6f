"""Forces of the bearings of a `BearingSet` summed in the frame of its shaft: in static equilibrium and about it.

The ring of bearing k, in its own frame, is at

    q_k = S_k (T_k q) + (offset_k + a_k) e_z,

with the displacement q = (x, y, z, tilt_x, tilt_y) of the shaft at 0, the move T_k to the bearing's plane and the
signs S_k of its facing. a_k is 0, or one displacement a for all bearings whose outer rings slide along the shaft
under a spring: the sixth degree of freedom, whose load is the force of the spring.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduced_models.bearing.five_degrees import AngularEquilibrium, StaticRing, equilibrium_at
from reduced_models.bearing.freedoms import FIVE, facing_signs
from reduced_models.bearing.linear_angular import SmallAngularBalls
from reduced_models.bearing.linear_balls import stiffness_and_damping

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

AXIAL = FIVE.index("z")
SLIDE = len(FIVE)  # index of a
NAMES = (*FIVE, "z of the outer rings on the spring")


def ring_rows(facing: str, position: float, slides: bool) -> _Floats:
    """Rows by which the displacement of the shaft and a move a ring in its own frame, shape (5, 6)."""
    rows = np.eye(len(FIVE), len(NAMES))
    rows[0, 4], rows[1, 3] = position, -position
    rows *= facing_signs(facing)[:, None]
    rows[AXIAL, SLIDE] = float(slides)
    return rows


def without_slide(matrix: NDArray[Any]) -> NDArray[Any]:
    """Matrices over the shaft's five degrees of freedom, the outer rings on the spring following without force."""
    five, slide = matrix[..., :SLIDE, :SLIDE], matrix[..., SLIDE, SLIDE]
    if not slide.any():  # none slides
        return five
    columns, row = matrix[..., :SLIDE, SLIDE:], matrix[..., SLIDE:, :SLIDE]
    return five - columns @ row / slide[..., None, None]


@dataclass(frozen=True, eq=False)
class SetEquilibrium:
    """A shaft in equilibrium on its bearings."""

    displacement: _Floats  # (5,) of the shaft [m], [rad]
    load: _Floats  # (5,) [N], [N m], reactions of what is held included
    stiffness: _Floats  # (5, 5)
    bearings: list[AngularEquilibrium]  # each in its own frame


class StaticSet:
    """All bearings in static equilibrium, as `reduced_models.bearing.five_degrees.search` wants them.

    Parameters
    ----------
    rings : sequence of StaticRing
    rows : sequence of ndarray, shape (5, 6)
        Of `ring_rows`.
    offsets : sequence of float
        Of each ring along its own z [m].
    free : int
        How many of the five degrees of freedom move, in their order.
    tilt : ndarray, shape (2,)
        Tilts that are held, where free < 5 [rad].
    """

    def __init__(
        self,
        rings: Sequence[StaticRing],
        rows: Sequence[_Floats],
        offsets: Sequence[float],
        free: int,
        tilt: _Floats,
    ) -> None:
        self.rings, self.rows, self.free = rings, rows, free
        self.shifts = [np.eye(len(FIVE))[AXIAL] * offset for offset in offsets]
        slides = any(one[AXIAL, SLIDE] for one in rows)
        self.moves = np.array([*range(free), SLIDE] if slides else range(free))
        self.held = np.append(np.zeros(3), np.append(tilt, 0.0))
        self.groove_circle = float(np.mean([ring.balls.grooves.groove_circle for ring in rings]))
        self.unit = np.array([1.0, 1.0, 1.0, 1.0 / self.groove_circle, 1.0 / self.groove_circle, 1.0])[self.moves]
        self.longest = min(ring.longest for ring in rings)

    def displacement(self, q: _Floats) -> _Floats:
        """All six of a scaled displacement of those that move."""
        full = self.held.copy()
        full[self.moves] = q * self.unit
        return full

    def force(self, q: _Floats) -> _Floats:
        """Scaled forces on the bearings [N]."""
        return self._pressed(q)[0][self.moves] * self.unit

    def tangent(self, q: _Floats) -> _Floats:
        """Their derivative [N/m]."""
        return self._pressed(q)[1][np.ix_(self.moves, self.moves)] * np.outer(self.unit, self.unit)

    def pressed(self) -> float:
        """Forces of the rings on all balls with what moves at the origin, added without their directions [N]."""
        self._pressed(np.zeros(self.moves.size))
        return float(sum(ring.carried() for ring in self.rings))

    def _pressed(self, q: _Floats) -> tuple[_Floats, _Floats]:
        """Loads (6,) and stiffness (6, 6) at a scaled displacement."""
        full = self.displacement(q)
        load, stiffness = np.zeros(len(NAMES)), np.zeros((len(NAMES), len(NAMES)))
        for ring, rows, shift in zip(self.rings, self.rows, self.shifts, strict=True):
            ring.press(rows @ full + shift)
            load += rows.T @ ring.load
            stiffness += rows.T @ ring.stiffness @ rows
        return load, stiffness

    def at(self, q: _Floats) -> SetEquilibrium:
        """Shaft and balls at a scaled displacement where they are in equilibrium."""
        full = self.displacement(q)
        load, stiffness = self._pressed(q)
        places = zip(self.rings, self.rows, self.shifts, strict=True)
        bearings = [equilibrium_at(ring, rows @ full + shift) for ring, rows, shift in places]
        return SetEquilibrium(full[:SLIDE], load[:SLIDE], without_slide(stiffness), bearings)


class SmallSet(NamedTuple):
    """All bearings about static equilibrium."""

    bearings: list[SmallAngularBalls]
    rows: list[_Floats]  # (5, 6) of `ring_rows`

    def impedance(self, s: ArrayLike) -> _Complex:
        """Of the shaft at frequencies s [1/s] of exp(s t), shape of `s` + (5, 5)."""
        parts = [rows.T @ one.impedance(s) @ rows for rows, one in zip(self.rows, self.bearings, strict=True)]
        return without_slide(np.sum(parts, axis=0))

    def coefficients(self, omega: _Floats) -> tuple[_Floats, _Floats]:
        """Stiffness and damping, shape (k, 5, 5), at angular frequencies [rad/s], shape (k,)."""
        return stiffness_and_damping(self.impedance, omega)
