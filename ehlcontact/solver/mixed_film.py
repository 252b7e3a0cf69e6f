"""Films that share the load with asperities (law of their pressure: `ehlcontact.asperities`).

The pressure of asperities at a gap adds to that of the oil: it deflects the bodies, ``film_shift``, and carries
part of the load. It hardly changes the gap, which the inlet determines. So it is updated after every multigrid
cycle, with under-relaxation where it carries much of the load.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.asperities import AsperityNumbers, greenwood_tripp
from ehlcontact.conditions import SMOOTH
from ehlcontact.errors import InputError
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.multigrid import Multigrid

Array = NDArray[np.float64]

FIRST_SHARE = 0.5  # of the load: largest change of what asperities carry in one cycle
LEAST_STEP = 0.05


class AsperityPressure:
    """Effect of asperities (`effects.Effect`): their pressure follows the gap after every cycle.

    Attributes
    ----------
    pressure : array (ny + 1, nx + 1)
        Of the asperities, over the Hertz pressure.
    """

    changes_film, slow = True, False

    def __init__(self, multigrid: Multigrid, numbers: AsperityNumbers) -> None:
        self.multigrid, self.numbers = multigrid, numbers
        self.pressure = np.zeros_like(multigrid.finest.P)
        self._last = 0.0  # change of their load in the last update, without relaxation
        self._step = 1.0

    def start(self, balance: Balance, advance: Callable[[Balance], float]) -> None:
        """Set the asperities' pressure from the film on the finest level."""
        self.follow()

    def follow(self, change: float = 0.0) -> float:
        """Update the asperities' pressure from the present gap, with relaxation, and then the film."""
        level = self.multigrid.finest
        own = self.numbers.unit * greenwood_tripp(level.H / self.numbers.rq) - self.pressure
        more = float(np.vdot(level.force_weights, own))
        given_way = self._last - more  # change of the residual load: Aitken's factor
        if self._last * given_way > 0.0:
            self._step = float(np.clip(self._step * self._last / given_way, LEAST_STEP, 1.0))
        if abs(more) > FIRST_SHARE:
            self._step = min(self._step, FIRST_SHARE / abs(more))
        self._last = more
        self.pressure += self._step * own
        self._press()
        return self._step * float(np.abs(own).max())

    def _press(self) -> None:
        """Deflection and load of the present pressure, and the film."""
        level = self.multigrid.finest
        level.asperity_load = float(np.vdot(level.force_weights, self.pressure))
        level.film_shift = level.deflection(self.pressure).copy()
        level.update(self.multigrid.u)

    def linear(self, still: bool = False) -> Any:
        """Refused: their pressure over a vibration is not known here."""
        raise InputError("asperities", "given", SMOOTH)

    def hold(self, results: Mapping[str, Mapping[str, Any]]) -> None:
        """Take over the pressure of a result."""
        self.pressure[...] = results["asperities"]["pressure"].T
        self._press()

    def settle(self, balance: Balance, cycles: int) -> None:
        """As of `effects.Effect`."""
        self.follow()
        for _ in range(cycles):
            self.follow(self.multigrid.cycle(balance))

    def result(self, before: float) -> dict[str, dict[str, Any]]:
        """Fields and numbers of an `AsperityContact`; the central film between smooth surfaces was `before`."""
        level = self.multigrid.finest
        numbers = {
            "pressure": self.pressure.T.copy(),
            "load_share": level.asperity_load / level.force(),
            "film_over_rq": level.central_film() / self.numbers.rq,
            "film_share": level.central_film() / before,
        }
        return {"asperities": numbers}
