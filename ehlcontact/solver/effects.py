"""Effects: what conditions make of a film, any of them beside the others.

What surfaces carry to a contact is known before a film is solved: it is part of the levels. Heat, shear thinning
and asperities follow from the film itself. They start from the film without them, and follow after every cycle.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

from ehlcontact.conditions import Conditions
from ehlcontact.point import MoesPoint, Point, Scales, moes_point, scales_of
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.film_heat import FilmHeat
from ehlcontact.solver.film_thinning import FilmThinning
from ehlcontact.solver.followed_viscosity import FollowedViscosity, ViscositySource
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

    def result(self, before: float) -> dict[str, dict[str, Any]]:
        """Fields and numbers of results, by condition; the central film without effects was `before`."""


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


def viscosity_of(
    conditions: Conditions, moes: MoesPoint, scales: Scales | None, multigrid: Multigrid
) -> FollowedViscosity | None:
    """Viscosity that follows heat and sliding, with the data of the oil; None where it follows neither."""
    sources: dict[str, ViscositySource] = {}
    if scales is None:  # both are in SI
        return None
    heat, sliding = None, conditions.sliding
    if conditions.heat is not None:
        law = None if sliding is None else sliding.law
        heat = sources["heat"] = FilmHeat(multigrid.finest, conditions.heat.numbers(moes, scales, law))
    if sliding is not None:
        newton = sliding.log_newton(moes.eta0, scales)
        sources["sliding"] = FilmThinning(multigrid, sliding.law, newton, heat)
    return FollowedViscosity(multigrid, sources) if sources else None


def effects_of(conditions: Conditions, point: Point, multigrid: Multigrid) -> list[Effect]:
    """Effects of conditions with the data of the oil, in the order in which they follow."""
    effects: list[Effect] = []
    viscosity = viscosity_of(conditions, moes_point(point), scales_of(point), multigrid)
    if viscosity is not None:
        effects.append(viscosity)
    if conditions.asperities is not None:
        effects.append(AsperityPressure(multigrid, conditions.asperities.numbers(point)))
    return effects
