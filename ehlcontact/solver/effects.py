"""Effects: what conditions make of a film, any of them beside the others.

What surfaces carry to a contact is known before a film is solved: it is part of the levels. Heat, shear thinning
and asperities follow from the film itself. They start from the film without them and follow after every cycle;
vibrations have their derivatives.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

from numpy.typing import NDArray

from ehlcontact.conditions import Conditions
from ehlcontact.point import Point, moes_point, scales_of
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.film_heat import FilmHeat
from ehlcontact.solver.film_thinning import FilmThinning
from ehlcontact.solver.followed_viscosity import FollowedViscosity, ViscositySource
from ehlcontact.solver.linear import LinearFilm
from ehlcontact.solver.linear_heat import ViscosityChange
from ehlcontact.solver.mixed_film import AsperityPressure
from ehlcontact.solver.multigrid import Multigrid

Array = NDArray[Any]


class LinearEffect(Protocol):
    """Part of an effect in vibrations about the film at rest; one of a list at most has unknowns of its own."""

    @property
    def fields(self) -> int:
        """Unknowns at every node beside the pressure."""

    @property
    def beside(self) -> tuple[Any, Any] | None:
        """Derivatives of the Reynolds operator to pressure and film beside those of the level, sparse."""

    def system(self, film: LinearFilm, omega: float) -> Any:
        """Equations of a vibration of one frequency, with its unknowns after those of `film`."""

    def of_speed(self) -> ViscosityChange:
        """What a relative change of the speed makes of the viscosity at given pressure and film."""

    def of_unknowns(self, system: Any, fields: Array, dP: Array, dH: Array) -> ViscosityChange:
        """What its unknowns, and pressure and film beyond the slopes of the level, make of the viscosity."""


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

    def linear(self, still: bool = False) -> LinearEffect:
        """Its part in vibrations about the present film; with a state that stands `still`, if asked for.

        Raises
        ------
        InputError
            An effect without one.
        """

    def hold(self, results: Mapping[str, Mapping[str, Any]]) -> None:
        """Take over its state from results of the film that the levels hold, as of `result`."""

    def settle(self, balance: Balance, cycles: int) -> None:
        """Come to the state of its own of a film that is near, in so many cycles."""

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


def effects_of(conditions: Conditions, point: Point, multigrid: Multigrid) -> list[Effect]:
    """Effects of conditions with the data of the oil, in the order in which they follow."""
    effects: list[Effect] = []
    sources = _sources_of(conditions, point, multigrid)
    if sources:
        effects.append(FollowedViscosity(multigrid, sources))
    if conditions.asperities is not None:
        effects.append(AsperityPressure(multigrid, conditions.asperities.numbers(point)))
    return effects


def _sources_of(conditions: Conditions, point: Point, multigrid: Multigrid) -> list[ViscositySource]:
    """What changes the viscosity, with the data of the oil, in the order in which it follows."""
    moes, scales, heat, sliding = moes_point(point), scales_of(point), conditions.heat, conditions.sliding
    sources: list[ViscositySource] = []
    if scales is None:  # both are in SI
        return sources
    warm = None
    if heat is not None:
        warm = FilmHeat(multigrid.finest, heat.numbers(moes, scales, None if sliding is None else sliding.law))
        sources.append(warm)
    if sliding is not None:
        sources.append(FilmThinning(multigrid, sliding.law, sliding.log_newton(moes.eta0, scales), warm))
    return sources
