"""Films that share the load with asperities (law of their pressure: `ehlcontact.asperities`).

The pressure of asperities at a gap adds to that of the oil: it deflects the bodies, ``film_shift``, and carries
part of the load. It hardly changes the gap, which the inlet determines. So it is updated after every multigrid
cycle, with under-relaxation where it carries much of the load.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ehlcontact.asperities import AsperityNumbers, greenwood_tripp
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.multigrid import Multigrid

Array = NDArray[np.float64]

FIRST_SHARE = 0.5  # of the load: largest change of what asperities carry in one cycle
LEAST_STEP = 0.05


class MixedCycles:
    """Multigrid cycles, each followed by an update of the asperities' pressure; `step` does one.

    Attributes
    ----------
    pressure : array (ny + 1, nx + 1)
        Of the asperities, over the Hertz pressure.
    """

    def __init__(
        self, multigrid: Multigrid, numbers: AsperityNumbers, advance: Callable[[Balance], float]
    ) -> None:
        self.multigrid, self.numbers, self._advance = multigrid, numbers, advance
        self.pressure = np.zeros_like(multigrid.finest.P)
        self._last = 0.0  # change of their load in the last update, without relaxation
        self._step = 1.0

    def start(self) -> None:
        """Set the asperities' pressure from the film on the finest level."""
        self._follow()

    def step(self, balance: Balance) -> float:
        """One cycle; returns the largest change of either pressure."""
        change = self._advance(balance)
        return max(change, self._follow())

    def _follow(self) -> float:
        """Update the asperities' pressure from the present gap, with relaxation, and then the film."""
        mg, level = self.multigrid, self.multigrid.finest
        change = self.numbers.unit * greenwood_tripp(level.H / self.numbers.rq) - self.pressure
        more = float(np.vdot(level.force_weights, change))
        given_way = self._last - more  # change of the residual load: Aitken's factor
        if self._last * given_way > 0.0:
            self._step = float(np.clip(self._step * self._last / given_way, LEAST_STEP, 1.0))
        if abs(more) > FIRST_SHARE:
            self._step = min(self._step, FIRST_SHARE / abs(more))
        self._last = more
        self.pressure += self._step * change
        level.asperity_load = float(np.vdot(level.force_weights, self.pressure))
        level.film_shift = level.deflection(self.pressure).copy()
        level.update(mg.u)
        return self._step * float(np.abs(change).max())
