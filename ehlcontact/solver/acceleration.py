"""Anderson (Washio-Oosterlee) acceleration of V cycles.

V cycles leave a few smooth errors that fall by only a third to a half in each cycle: where the coarse grid shows
the pressure spike too low and displaced, or at the outlet of thin oil. The changes of the last cycles show how
these errors fall. Washio and Oosterlee (Electronic Transactions on Numerical Analysis 6, 1997) combine the last
cycles so that the residual is smallest; here it is the change of the pressure by a cycle, as in Anderson's
mixing, because the residual weighs a node by its Poiseuille coefficient.
"""

from __future__ import annotations

from math import inf, isfinite
from typing import NamedTuple

import numpy as np
from numpy.linalg import norm
from numpy.typing import NDArray

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.multigrid import Multigrid

REMEMBERED = 2  # cycles before the last: one more gains little, and every one costs two fields
SLOW_FACTOR = 0.15  # change of P over that of the cycle before, from which combining pays for its residual
RESET_RATIO = 0.7  # the same after a combination, from which on the kept cycles are dropped: a boundary has moved
FRONT_MOVES = 0.002  # share of the full nodes: where as many fill up or empty in a cycle, none are combined


class Cycle(NamedTuple):
    """What one cycle did, or by how much that differs from what the one before did."""

    change: NDArray[np.float64]  # of P
    P: NDArray[np.float64]  # that it led to,
    u: float  # and the approach

    def minus(self, other: Cycle) -> Cycle:
        """The difference of two."""
        return Cycle(self.change - other.change, self.P - other.P, self.u - other.u)


class AcceleratedCycles:
    """V cycles on the state of a `Multigrid`, combined where they fall slowly; `step` stands for its `cycle`."""

    def __init__(self, multigrid: Multigrid) -> None:
        self.multigrid = multigrid
        self._last: Cycle | None = None
        self._differences: list[Cycle] = []  # from cycle to cycle
        self._largest = inf  # change of P in the last cycle
        self._combined = False  # the state that the last cycle began with

    def step(self, balance: Balance) -> float:
        """One cycle, then the combination; returns the largest change of P by the cycle."""
        P = self.multigrid.finest.P
        before = P.copy()
        change = self.multigrid.cycle(balance)
        if not isfinite(change):
            return change
        last, self._last = self._last, Cycle(P - before, P.copy(), self.multigrid.u)
        slow = change > SLOW_FACTOR * self._largest
        self._largest = change
        if last is None:
            return change
        if self._front_moves(before):
            self._differences.clear()
            self._combined = False
            return change
        if self._combined and norm(self._last.change) > RESET_RATIO * norm(last.change):
            self._differences.clear()
            self._combined = False
            return change
        self._differences = [*self._differences, self._last.minus(last)][-REMEMBERED:]
        if self._combined or slow:
            self._combine(self._last)
        return change

    def _front_moves(self, before: NDArray[np.float64]) -> bool:
        """Whether the front of full film moved in the cycle since pressure `before`; combining would lose it."""
        level = self.multigrid.finest
        full = before > 0.0
        moved = np.count_nonzero(full != (level.P > 0.0))
        return level.inflow.size > 0 and bool(moved > FRONT_MOVES * np.count_nonzero(full))

    def _combine(self, new: Cycle) -> None:
        """The combination of the cycles remembered whose change would be smallest, in the mean."""
        mg, level, differences = self.multigrid, self.multigrid.finest, self._differences
        products = [[float(np.vdot(a.change, b.change)) for b in differences] for a in differences]
        shares = np.linalg.lstsq(
            products, [float(np.vdot(d.change, new.change)) for d in differences], rcond=None
        )[0]
        for share, difference in zip(shares, differences, strict=True):
            level.P[...] -= share * difference.P
            mg.u -= float(share) * difference.u
        level.P[new.P <= 0.0] = 0.0  # where oil cavitates is for the cycles to say
        np.maximum(level.P, 0.0, out=level.P)
        level.update(mg.u)
        self._combined = True
