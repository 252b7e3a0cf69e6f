"""Effects over time: what conditions make of a film that moves, each with a state between steps."""

from __future__ import annotations

from collections.abc import Callable
from math import log
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.conditions import Conditions
from ehlcontact.lubricant.traction_laws import TractionLaw
from ehlcontact.point import Scales
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.solver.film_thinning import FilmThinning
from ehlcontact.solver.followed_viscosity import ViscositySource
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.transient.heat_over_time import HeatOverTime, HeatState

Array = NDArray[np.float64]


class EffectOverTime(ViscositySource, Protocol):
    """What a condition makes of the viscosity of a film that moves in time."""

    def rest(self) -> None:
        """Forget all: the film is solved anew, at first without the effect."""

    def set_speed(self, speed: float) -> None:
        """Let the surfaces move at `speed` > 0, over that of the operating point."""

    def turn(self) -> None:
        """See all of its state from the other side."""

    def start(self, turned: bool, cold: float) -> FilmTemperature | None:
        """Take what a steady film has as the state; what results keep of it, over the central film `cold`."""

    def begin(
        self, dT: float, known: Callable[[Array, Array], Array], moved: float, turned: bool, source: Array | None
    ) -> None:
        """Begin a step, as of `HeatOverTime`."""

    def end(self, keeps: bool) -> None:
        """Take what was found as the state at the end of the step, as of `HeatOverTime`."""

    def columns(self) -> dict[str, float]:
        """Numbers of a record, by name."""

    @property
    def saved(self) -> HeatState | None:
        """State between steps, immutable; None without any."""

    def restore(self, state: HeatState | None) -> None:
        """Return to a saved state."""


class ThinningOverTime(FilmThinning):
    """Shear thinning of a film that moves in time: it follows at once, and has no state."""

    def __init__(
        self, multigrid: Multigrid, law: TractionLaw, log_newton: float, heat: HeatOverTime | None
    ) -> None:
        super().__init__(multigrid, law, log_newton, heat)
        self._at_unit_speed = log_newton

    saved = None

    def rest(self) -> None:
        """Let the viscosity be the same along and across."""
        self.multigrid.set_aside(np.zeros_like(self.multigrid.finest.P))

    def set_speed(self, speed: float) -> None:
        """Let the surfaces slide in proportion to the speed."""
        self.log_newton = self._at_unit_speed + log(speed)

    def turn(self) -> None:
        """Turn the viscosity along over that across."""
        if self.multigrid.aside is not None:
            self.multigrid.set_aside(self.multigrid.aside[:, ::-1].copy())

    def start(self, turned: bool, cold: float) -> None:
        """As of `EffectOverTime`: there is nothing to keep."""

    def begin(self, *step: Any) -> None:
        """As of `EffectOverTime`."""

    def end(self, keeps: bool) -> None:
        """As of `EffectOverTime`."""

    def columns(self) -> dict[str, float]:
        """None."""
        return {}

    def restore(self, state: HeatState | None) -> None:
        """As of `EffectOverTime`: the viscosities are part of the film."""


def effects_over_time(conditions: Conditions, multigrid: Multigrid, scales: Scales | None) -> list[EffectOverTime]:
    """Effects of conditions with the data of the oil, in the order in which they follow."""
    effects: list[EffectOverTime] = []
    heat, sliding, warm = conditions.heat, conditions.sliding, None
    if scales is None:  # both are in SI
        return effects
    if heat is not None:
        warm = HeatOverTime(multigrid, heat, scales, None if sliding is None else sliding.law)
        effects.append(warm)
    if sliding is not None:
        newton = sliding.log_newton(multigrid.point.eta0, scales)
        effects.append(ThinningOverTime(multigrid, sliding.law, newton, warm))
    return effects
