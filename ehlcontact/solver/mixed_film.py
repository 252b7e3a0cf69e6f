"""Films that share the load with asperities.

What asperities press at a gap is a pressure beside that of the oil: it deflects the bodies, ``film_shift``, and
carries part of the load. The gap is hardly another for that, since the inlet sets it, so the asperities' pressure
follows the film after every cycle, as far as the oil can give way.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ehlcontact.asperities import AsperityNumbers, greenwood_tripp
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.multigrid import Multigrid

Array = NDArray[np.float64]

FIRST_SHARE = 0.5  # of the load, that asperities take at most in one cycle
LEAST_STEP = 0.05


class MixedCycles:
    """Cycles after each of which the asperities follow the film; `step` stands for one.

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
        self._last = 0.0  # what the asperities would have carried more
        self._step = 1.0

    def start(self) -> None:
        """Let asperities carry at the film that is on the finest level."""
        self._follow()

    def step(self, balance: Balance) -> float:
        """One cycle; returns the largest change of either pressure."""
        change = self._advance(balance)
        return max(change, self._follow())

    def _follow(self) -> float:
        """Take over the asperities' pressure at the present gap, and update the film."""
        mg, level = self.multigrid, self.multigrid.finest
        change = self.numbers.unit * greenwood_tripp(level.H / self.numbers.rq) - self.pressure
        more = float(np.vdot(level.force_weights, change))
        given_way = self._last - more  # by the film, over what they took: Aitken's step
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
