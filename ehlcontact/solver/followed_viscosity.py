"""Viscosity that follows heat and sliding: what both make of a film, at rest and in vibrations about it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import inf
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.film_heat import MOST_ROUNDS, SETTLED, FilmHeat
from ehlcontact.solver.film_thinning import FilmThinning
from ehlcontact.solver.linear_heat import LinearViscosity
from ehlcontact.solver.multigrid import Multigrid

Array = NDArray[np.float64]

ROUNDS = 1  # after a cycle, whose film changes by more
LARGE_CHANGE, STEP = 0.3, 0.8  # of the heating in a cycle, over itself, of which it takes this share
ROUGH = 0.5  # change of the pressure in a cycle, above which the temperatures stay: they would be those of no film
FRONT_ROUGH, FRONT_CYCLES = 0.1, 3  # tolerance and cycles of a film whose front moves
# Change of the heating from which it is taken as it is where such a front moves: nodes that fill up are no series
FRONT_FINE = 5e-4
START = 0.75  # of the heating of an isothermal film: one with heat is thinner and has thinner oil
REMEMBERED = 2  # cycles before the last
HOTTEST = -0.95  # heating: ln(eta) + 9.67 stays above 0


class ViscositySource(Protocol):
    """What changes the viscosity of a film: `FilmHeat`, or `FilmThinning`."""

    @property
    def condition(self) -> str:
        """Name of its condition, as of `Conditions`."""

    @property
    def changes_film(self) -> bool:
        """Whether the viscosity is another one."""

    def solve(self, rounds: int = ..., /) -> Array:
        """Its part of ``Flow.heat`` at the present film."""

    def hold(self) -> Array:
        """That part without a change of its own state."""

    def result(self, before: float) -> dict[str, Any]:
        """Fields and numbers of a result; the central film without it was `before`."""


class FollowedViscosity:
    """Effect of heat and sliding (`effects.Effect`): the viscosity follows them after a cycle or a Newton step.

    A cycle at given viscosity leaves little. How fast the viscosity settles depends on what pressure and film make
    of it: a change comes back from the inlet by a fifth, with the other sign, and from where the pressure ends by
    half, with its own. So changes are combined as in `acceleration`.

    Parameters
    ----------
    multigrid : Multigrid
    sources : sequence
        What changes the viscosity, in the order in which it follows.
    """

    slow = True  # what falls slowly is not the cycles' part

    def __init__(self, multigrid: Multigrid, sources: Sequence[ViscositySource]) -> None:
        self.multigrid, self.sources = multigrid, sources
        self.heat = next((one for one in sources if isinstance(one, FilmHeat)), None)
        self._rough = inf  # what sliding thins follows any film
        if self.heat is not None:
            self._rough = FRONT_ROUGH if multigrid.finest.inflow.size else ROUGH
        self._last: tuple[Array, Array] | None = None  # what the heating became, and its change
        self._differences: list[tuple[Array, Array]] = []  # of both, from cycle to cycle

    @property
    def changes_film(self) -> bool:
        """Whether the viscosity is another one."""
        return any(source.changes_film for source in self.sources)

    def solve(self, rounds: int) -> Array:
        """What ``Flow.heat`` becomes at the present film."""
        return sum_of(source.solve(rounds) for source in self.sources)

    def start(self, balance: Balance, advance: Callable[[Balance], float]) -> None:
        """Full multigrid with what the isothermal film, which is on the levels, would heat, less some of it.

        From the isothermal pressure itself cycles on fine grids diverge where the pressure ends. Temperatures
        follow after a cycle: what full multigrid leaves on such grids is far from any film.
        """
        self.multigrid.set_heat(START * self.solve(ROUNDS))
        self.multigrid.full_multigrid(balance)
        starved = bool(self.multigrid.finest.inflow.size)
        for _ in range(FRONT_CYCLES if starved else 0):
            if advance(balance) < self._rough:
                break
        if starved or self._rough == inf:
            self.follow()

    def hold(self, results: Mapping[str, Mapping[str, Any]]) -> None:
        """Take over the temperatures of a result."""
        if self.heat is not None:
            warm = results["heat"]
            self.heat.walls[...] = warm["surfaces"].transpose(0, 2, 1)
            self.heat.rise[...] = warm["mean"].T - self.heat.walls.mean(axis=0)

    def settle(self, balance: Balance, cycles: int) -> None:
        """So many cycles from a film that is near; viscosity and temperatures belong together at last."""
        if self.heat is not None:
            self.heat.solve()
        self.follow()
        for _ in range(cycles):
            self.multigrid.sweep_factor = self.multigrid.least_sweep_factor
            self.follow(self.multigrid.cycle(balance))
        if self.heat is not None:
            self.heat.solve()
        self.set_viscosity()

    def set_viscosity(self) -> None:
        """Viscosity of the present temperatures on all levels, with what the flow heats beside the surfaces."""
        mg = self.multigrid
        for _ in range(MOST_ROUNDS):
            heating = sum_of(source.hold() for source in self.sources)
            settled = np.abs(heating - mg.finest.fields.flow.heat).max() <= SETTLED
            mg.set_heat(heating)
            mg.finest.update(mg.u)
            if settled:
                break

    def follow(self, change: float = 0.0) -> float:
        """Viscosity of the present temperatures, and residuals with it, but after a rough cycle; returns 0."""
        if change < self._rough:
            self._renew()
        return 0.0

    def linear(self, still: bool = False) -> LinearViscosity:
        """Its part in vibrations about the present film; with temperatures that stand `still`, if asked for."""
        thinning = next((one for one in self.sources if isinstance(one, FilmThinning)), None)
        heat = None if still else self.heat
        return LinearViscosity(self.multigrid.finest, heat, None if thinning is None else thinning.linear())

    def result(self, before: float) -> dict[str, dict[str, Any]]:
        """Fields and numbers of results by condition; the central film without any of them was `before`."""
        return {source.condition: source.result(before) for source in self.sources}

    def _renew(self) -> None:
        """Viscosity of the present temperatures; residuals with it."""
        mg = self.multigrid
        before = mg.finest.fields.flow.heat
        heat = self.solve(ROUNDS)
        change = heat - before
        large = bool(np.abs(change).max() > LARGE_CHANGE * np.abs(heat).max())
        if self._last is not None and not large:
            new = heat - self._last[0], change - self._last[1]
            self._differences = [*self._differences, new][-REMEMBERED:]
        self._last = None if large else (heat, change)
        mg.set_heat(before + STEP * change if large else np.maximum(self._combined(heat, change), HOTTEST))
        mg.finest.update(mg.u)

    def _combined(self, heat: Array, change: Array) -> Array:
        """The combination of what was remembered whose change would be smallest, in the mean."""
        changes = [c for _, c in self._differences]
        products = [[float(np.vdot(a, b)) for b in changes] for a in changes]
        starved = self.heat is not None and self.multigrid.finest.inflow.size
        fine = starved and np.abs(change).max() < FRONT_FINE
        if fine or not changes or not np.isfinite(products).all():
            return heat
        shares = np.linalg.lstsq(products, [float(np.vdot(c, change)) for c in changes], rcond=None)[0]
        return heat - sum(share * h for share, (h, _) in zip(shares, self._differences, strict=True))


def sum_of(parts: Iterable[Array]) -> Array:
    """Sum of arrays of one shape, of which there is one at least."""
    first, *others = parts
    return sum(others, start=first)
