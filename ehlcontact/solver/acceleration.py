"""Cycles that learn from the last ones: what falls slowly is extrapolated.

Where the coarse grid sees a pressure spike lower and elsewhere, or the outlet of thin oil, V cycles leave a few
smooth errors that fall by a third to a half in each, while all others are gone. Two remembered cycles tell how
they fall. Washio and Oosterlee (Electronic Transactions on Numerical Analysis 6, 1997) combine them so that the
residual is smallest; here it is the change of the pressure by a cycle, as in Anderson's mixing, because the
residual weighs a node by its flow factor.
"""

from __future__ import annotations

from itertools import pairwise
from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.multigrid import Multigrid

REMEMBERED = 2  # cycles before the last: one more gains little, and every one costs two fields
SLOW_FACTOR = 0.15  # change of P over that of the cycle before, from which combining pays for its residual
HARM = 0.7  # the same after a combination, by which it did harm: a boundary moved, and memory is of another film


class Cycle(NamedTuple):
    """What one cycle did."""

    change: NDArray[np.float64]  # of P
    P: NDArray[np.float64]  # that it led to,
    u: float  # and the approach


class AcceleratedCycles:
    """V cycles on the state of a `Multigrid`, combined where they fall slowly; `step` stands for its `cycle`."""

    def __init__(self, multigrid: Multigrid) -> None:
        self.multigrid = multigrid
        self._memory: list[Cycle] = []
        self._changes: list[float] = []  # largest of P, by cycle
        self._combined = False  # the state that the last cycle began with

    def step(self, balance: Balance) -> float:
        """One cycle, then the combination; returns the largest change of P by the cycle."""
        mg, level = self.multigrid, self.multigrid.finest
        before = level.P.copy()
        change = mg.cycle(balance)
        if not isfinite(change):
            return change
        self._changes.append(change)
        self._memory = [*self._memory[-REMEMBERED:], Cycle(level.P - before, level.P.copy(), mg.u)]
        if self._combined and self._falls_by(HARM):
            del self._memory[:-1]
            self._combined = False
        elif len(self._memory) > 1 and (self._combined or self._slow()):
            self._combine()
        return change

    def _slow(self) -> bool:
        return self._changes[-1] > SLOW_FACTOR * self._changes[-2]

    def _falls_by(self, share: float) -> bool:
        """Whether the last change is not below that share of the one before, in the mean."""
        *_, last, new = self._memory
        return bool(np.linalg.norm(new.change) > share * np.linalg.norm(last.change))

    def _combine(self) -> None:
        """The combination of the cycles remembered whose change would be smallest, in the mean."""
        mg, level = self.multigrid, self.multigrid.finest
        new = self._memory[-1]
        differences = np.array([(b.change - a.change).ravel() for a, b in pairwise(self._memory)])
        shares = np.linalg.lstsq(differences @ differences.T, differences @ new.change.ravel(), rcond=None)[0]
        P, u = new.P.copy(), new.u
        for share, (a, b) in zip(shares, pairwise(self._memory), strict=True):
            P -= share * (b.P - a.P)
            u -= float(share) * (b.u - a.u)
        P[new.P <= 0.0] = 0.0  # where oil cavitates is for the cycles to say
        level.P[...] = np.maximum(P, 0.0)
        mg.u = u
        level.update(u)
        self._combined = True
