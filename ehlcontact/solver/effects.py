"""Effects: what conditions make of a film, any of them beside the others.

What surfaces carry to a contact is known before a film is solved: it is part of the levels. Heat, shear thinning
and asperities follow from the film itself. They start from the film without them, and follow after every cycle.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

from ehlcontact.conditions import Conditions
from ehlcontact.point import Point, moes_point, scales_of
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.film_heat import FilmHeat, FollowedViscosity
from ehlcontact.solver.film_thinning import FilmThinning
from ehlcontact.solver.mixed_film import AsperityPressure
from ehlcontact.solver.multigrid import Multigrid


class Effect(Protocol):
    """What a condition makes of the film on the finest level of a multigrid."""

    @property
    def changes_film(self) -> bool:
        """Whether the film with it is another one; else its result is all."""

    @property
    def slow(self) -> bool:
        """Whether cycles fall slowly because of it, and more sweeps do not help."""

    def start(self, balance: Balance, advance: Callable[[Balance], float]) -> None:
        """Begin at the film without it, which is on the levels; `advance` is a cycle, or a Newton step."""

    def follow(self, change: float) -> float:
        """Follow the film after a cycle with this largest change of P; returns that of a pressure of its own."""

    def result(self, before: float) -> dict[str, Any]:
        """Fields and numbers of a result; the central film without it was `before`."""


class CyclesWithEffects:
    """Cycles, or Newton steps, after each of which effects follow; `step` stands for one."""

    def __init__(
        self, multigrid: Multigrid, effects: Sequence[Effect], advance: Callable[[Balance], float]
    ) -> None:
        self.multigrid, self.effects, self._advance = multigrid, effects, advance
        self._slow = any(effect.slow for effect in effects)

    def start(self, balance: Balance) -> None:
        """Begin at the film without them."""
        for effect in self.effects:
            effect.start(balance, self._advance)

    def follow(self) -> None:
        """Let all effects follow the present film."""
        for effect in self.effects:
            effect.follow(0.0)

    def step(self, balance: Balance) -> float:
        """One of them; returns the largest change of a pressure."""
        if self._slow:
            self.multigrid.sweep_factor = self.multigrid.least_sweep_factor
        change = self._advance(balance)
        return max([change, *(effect.follow(change) for effect in self.effects)])


def effects_of(conditions: Conditions, point: Point, multigrid: Multigrid) -> dict[str, Effect]:
    """Effects of conditions with the data of the oil, by their names, in the order in which they follow."""
    moes, scales = moes_point(point), scales_of(point)
    effects: dict[str, Effect] = {}
    if scales is None:  # heat, sliding and asperities are in SI
        return effects
    if conditions.heat is not None:
        heat = FilmHeat(multigrid.finest, conditions.heat.numbers(moes, scales))
        effects["heat"] = FollowedViscosity(multigrid, heat)
    if (sliding := conditions.sliding) is not None:
        thinning = FilmThinning(multigrid, sliding.law, sliding.log_newton(moes.eta0, scales))
        effects["sliding"] = FollowedViscosity(multigrid, thinning)
    if conditions.asperities is not None:
        effects["asperities"] = AsperityPressure(multigrid, conditions.asperities.numbers(point))
    return effects
