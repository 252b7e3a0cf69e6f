"""Oil on the surfaces beyond both ends of the computed region, which comes back after a reversal.

A layer that has left moves with the surfaces. So the oil beyond each end is a stack of layers over the distance
s = int U dT: forward motion adds layers to the stack behind the contact and removes layers from the stack ahead of
it. The layer at the bottom of a stack is unlimited.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Stack = tuple[tuple[float, Array], ...]  # depth and layer over Y, from the bottom up


@dataclass(frozen=True, slots=True)
class CarriedOil:
    """Layers beyond the region; depths are s behind it, -s ahead of it, as seen at T = 0."""

    way: float
    ahead: Stack
    behind: Stack

    @classmethod
    def at_rest(cls, entering: Array, leaving: Array, turned: bool) -> CarriedOil:
        """That of a steady film, whose layers go on for ever."""
        ahead, behind = (leaving, entering) if turned else (entering, leaving)
        return cls(0.0, ((0.0, ahead),), ((0.0, behind),))

    def entering(self, way: float, turned: bool) -> Array:
        """Layer that comes in, at the end of a step that leads to `way`."""
        return _layer(self.behind, way) if turned else _layer(self.ahead, -way)

    def moved(self, way: float, turned: bool, leaving: Array) -> CarriedOil:
        """After that step, at whose end the layer `leaving` goes out."""
        if turned:
            return CarriedOil(
                way, _cut(self.ahead, -way, leaving), _cut(self.behind, way, self.entering(way, True))
            )
        return CarriedOil(way, _cut(self.ahead, -way, self.entering(way, False)), _cut(self.behind, way, leaving))


def _layer(stack: Stack, depth: float) -> Array:
    """Layer at a depth, straight between entries."""
    above = stack[-1]
    if depth >= above[0]:
        return above[1]
    for below in reversed(stack[:-1]):
        if depth >= below[0]:
            share = (depth - below[0]) / (above[0] - below[0])
            return below[1] + share * (above[1] - below[1])
        above = below
    return above[1]


def _cut(stack: Stack, depth: float, layer: Array) -> Stack:
    """The stack up to a depth, where its layer is `layer`."""
    size = len(stack)
    while size and stack[size - 1][0] >= depth:
        size -= 1
    return (*stack[:size], (depth, layer))
