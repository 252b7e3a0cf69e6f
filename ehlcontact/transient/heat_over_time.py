"""Heat of a film over time: storage in oil and surfaces, and its transport; eqs. 10 and 11 of docs/notes/heat.md.

Differences in time are those of the film. The heat given to the surfaces is stored for the time that they take
through the computed region, or for all time where they turn back, and is linear between the steps: all of this is
of second order in the step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import takewhile
from math import log, sqrt
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.heat import Heat
from ehlcontact.lubricant.traction_laws import Carreau, Eyring
from ehlcontact.point import Scales
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.solver.film_heat import FilmHeat, Terms
from ehlcontact.solver.multigrid import Multigrid

Array = NDArray[np.float64]

PAIRS = "stored", "of_rise", "pressure"  # now and a step before
LAST_ROUNDS = 5  # of the temperatures of a solved step, whose viscosity stays


@dataclass(frozen=True, slots=True, eq=False)
class HeatState:
    """Temperatures between steps, and what the next ones need of the past; its arrays are never written."""

    rise: Array
    walls: Array
    stored: tuple[Array, Array]  # in the oil, now and a step before
    of_rise: tuple[Array, Array]  # the part of it by which the oil is warmer than the surfaces
    pressure: tuple[Array, Array]  # likewise
    T: float
    way: float  # of the surfaces since T = 0, as seen at T = 0
    given: tuple[tuple[float, float, Array], ...]  # T, way, and heat of both surfaces, (2, ...), latest first

    def turned(self) -> HeatState:
        """The same, seen from the other side."""
        fields = {name: getattr(self, name)[..., ::-1].copy() for name in ("rise", "walls")}
        pairs = {name: tuple(one[:, ::-1].copy() for one in getattr(self, name)) for name in PAIRS}
        given = tuple((T, way, heat[..., ::-1].copy()) for T, way, heat in self.given)
        changed: dict[str, Any] = fields | pairs
        return replace(self, **changed, given=given)


class HeatOverTime(FilmHeat):
    """Temperatures on the finest level that move in time, from those of a steady film.

    Parameters
    ----------
    multigrid : Multigrid
    inputs : Heat
        With the data of the oil.
    scales : Scales
    law : Eyring or Carreau, optional
        Of the stress of sliding, as of `Heat.numbers`.
    """

    def __init__(
        self, multigrid: Multigrid, inputs: Heat, scales: Scales, law: Eyring | Carreau | None = None
    ) -> None:
        super().__init__(multigrid.finest, inputs.numbers(multigrid.point, scales, law))
        self._inputs = inputs
        self._load = inputs.load(multigrid.point, scales)
        self._at_unit_speed = self.numbers
        # What is known of the differences in time of heat, of its part by which oil is warmer, and of pressure
        self._step: tuple[Array, Array, Array] | None = None
        self._source: Array | None = None
        self._now: list[Array] = []
        self._before: list[Array] = []
        self._end = 0.0, 0.0  # of the step: time and way
        self._begun = False
        self.state: HeatState

    def rest(self) -> None:
        """Let the temperatures be those of a steady film, of the inlet at first."""
        self.rise[...] = 0.0
        self.walls[...] = 0.0
        self._step = None

    def set_speed(self, speed: float) -> None:
        """Let the surfaces move at `speed` > 0, over that of the operating point; they slide in proportion."""
        unit = self._at_unit_speed
        self.numbers = unit._replace(shear=unit.shear + log(speed), stress=unit.stress * speed)

    def turn(self) -> None:
        """See all of it from the other side."""
        if self._begun:
            self.restore(self.state.turned())

    def begin(
        self,
        dT: float,
        known: Callable[[Array, Array], Array],
        moved: float,
        turned: bool,
        source: Array | None = None,
    ) -> None:
        """Begin a step in which the surfaces go on by `moved`.

        ``known(now, before)`` is the known part of a difference in time; `turned` says that fields are those seen
        from the other side. A `source` of oil, which corrects how features are carried, has the temperature of the
        film.
        """
        self._source = source
        state, convection = self.state, self.numbers.convection
        stored, of_rise = (convection * known(*pair) for pair in (state.stored, state.of_rise))
        self._step = stored, of_rise, known(*state.pressure)
        self._end = state.T + dT, state.way + moved
        past = [*reversed(state.given)]
        T = np.array([*(one[0] for one in past), self._end[0]])
        way = np.array([*(one[1] for one in past), self._end[1]]) * (-1.0 if turned else 1.0)
        self._now, self._before = [], []
        nx = self.level.nx
        for k, speed in enumerate(self.speeds[:1] if self.even else self.speeds):
            weights = sqrt(speed) * passage(T[-1] - T, (way[-1] - way) * speed / self.level.hx, nx)
            self._now.append(scipy.linalg.toeplitz(weights[-1, nx::-1], weights[-1, nx:]))
            before = np.zeros_like(self.rise)
            for j, at in zip(*np.nonzero(weights[:-1]), strict=True):
                _add_behind(weights[j, at] * past[j][2][k], int(at) - nx, before)
            self._before.append(before)

    def start(self, turned: bool, cold: float) -> FilmTemperature:
        """Take what was found of a steady film as the state; `turned` as of `begin`.

        Returns its temperatures; the central film would be `cold` without heat.
        """
        self.solve()
        found = self._state((0.0, 0.0), ())
        longest = self._longest  # over this way, and before, the film has been the same
        way = longest if turned else -longest
        steady = (-longest / self.level.speed, way, found.given[0][2])
        self.state, self._begun = replace(found, given=(*found.given, steady)), True
        return FilmTemperature(inputs=self._inputs, thermal_load=self._load, **self.described(cold))

    def end(self, keeps: bool) -> None:
        """Take what was found as the state at the end of the step.

        Where surfaces turn back, it `keeps` what was given to those that have left the region.
        """
        self.solve(LAST_ROUNDS)
        before, past = self.state, self.state.given
        if not keeps:
            near = tuple(takewhile(lambda one: abs(one[1] - self._end[1]) < self._longest, past))
            past = past[: len(near) + 1]
        found = self._state(self._end, past)
        pairs: dict[str, Any] = {name: (getattr(found, name)[0], getattr(before, name)[0]) for name in PAIRS}
        self.state = replace(found, **pairs)

    def _state(self, when: tuple[float, float], past: tuple[tuple[float, float, Array], ...]) -> HeatState:
        """State of the present temperatures, as one that has not changed."""
        t, level = self.terms(), self.level
        stored, of_rise = self._heat_of_oil(t)
        pressure = level.P.copy()
        return HeatState(
            rise=self.rise.copy(),
            walls=self.walls.copy(),
            stored=(stored, stored),
            of_rise=(of_rise, of_rise),
            pressure=(pressure, pressure),
            T=when[0],
            way=when[1],
            given=((*when, np.array(self.into_walls(t))), *past),
        )

    @property
    def _longest(self) -> float:
        """Way over which a surface crosses the region."""
        return (self.level.nx + 1) * self.level.hx / min(self.speeds)

    def _heat_of_oil(self, t: Terms) -> tuple[Array, Array]:
        """Heat in the oil of cells, over its heat capacity, and the part by which it is warmer than the surfaces.

        All oil of a cell has the temperature of the surfaces, that of the full film the rise too, and behind it
        oil keeps the rise.
        """
        level, oil = self.level, self.level.oil
        full = np.where(t.wet, t.share * level.fields.flow.mass, oil)
        behind = np.logical_or.accumulate(level.P > 0.0, axis=1)
        rise = np.where(t.wet, self.rise, np.where(behind, self.behind(self.rise, t.share), 0.0))
        return oil * (rise + self.walls.mean(axis=0)) + (full - oil) * rise, full * rise

    def columns(self) -> dict[str, float]:
        """Warmest oil and surface [K above the inlet], and the balance of energy over the heat made."""
        warmest = {"warmest_oil": float(self.mean.max()), "warmest_surface": float(self.walls.max())}
        return warmest | {"heat_balance": self.balance()}

    @property
    def saved(self) -> HeatState:
        """State between steps."""
        return self.state

    def restore(self, state: HeatState | None) -> None:
        """Return to a saved state."""
        assert state is not None
        self.state = state
        self.rise[...], self.walls[...] = state.rise, state.walls

    def terms(self) -> Terms:
        """As of a steady film, with what oil stores, and the heat of compression in time."""
        t = super().terms()
        if self._step is None:
            return t
        level, n = self.level, self.numbers
        squeezed = n.expansion * t.H * (level.c_t * level.P + self._step[2])
        storage = level.c_t * n.convection * level.fields.flow.mass * t.share
        if self._source is not None:
            storage = storage - n.convection * self._source
        return t._replace(work=t.work + np.where(t.wet, squeezed, 0.0), storage=np.where(t.wet, storage, 0.0))

    def stored(self, t: Terms, mean: Array) -> Array | float:
        """Heat that a mean temperature takes up in time (eqs. 10, 12)."""
        if self._step is None:
            return 0.0
        found = t.storage * mean + self._step[0]
        if self.level.inflow.size:
            oil = self.level.c_t * self.numbers.convection * self.level.oil
            found += (oil - t.storage) * self.walls.mean(axis=0)
        return found

    def released(self, t: Terms) -> Array | float:
        """Heat of oil from which a front of full film has receded: the surfaces take it."""
        if self._step is None or not self.level.inflow.size:
            return 0.0
        ahead = ~np.logical_or.accumulate(self.level.P > 0.0, axis=1)
        return np.where(ahead & ~t.wet, -self._step[1], 0.0)

    @property
    def now(self) -> Array:
        """As of a steady film, by the heat of this step alone."""
        if self._step is None:
            return super().now / sqrt(self.level.speed)
        pairs = zip(self.numbers.walls, (self._now[0], self._now[-1]), strict=True)
        return np.array([wall * now[0] for wall, now in pairs])

    def passed_on(self, k: int, heat: Array) -> Array:
        """Rise of a surface by heat given to it, upstream of each node and earlier (eq. 11)."""
        if self._step is None:
            return super().passed_on(k, heat) / sqrt(self.level.speed)
        own = k if len(self._now) > 1 else 0
        return np.asarray(heat @ self._now[own] + self._before[own])


def passage(ages: Array, lags: Array, nx: int) -> Array:
    """Weights of past heat in the rise of a surface: integrals over 1/sqrt(age), (steps, 2 nx + 1).

    Parameters
    ----------
    ages : array, shape (steps,)
        Of the ends of the steps, oldest first, the last 0; heat is linear in time between them.
    lags : array, shape (steps,)
        Nodes by which a place of the surface has moved since then.
    nx : int
        Largest lag that counts; columns are lags from -nx on.
    """
    weights = np.zeros((ages.size, 2 * nx + 1))
    for j in range(ages.size - 1):
        first, last = lags[j], lags[j + 1]
        low, high = min(first, last), max(first, last)
        if low > nx + 0.5 or high < -nx - 0.5:
            continue
        # The cell of a node reaches half a node to both sides
        shares = (np.arange(np.ceil(low - 0.5), np.ceil(high - 0.5)) + 0.5 - first) / (last - first or 1.0)
        edges = ages[j] + (ages[j + 1] - ages[j]) * np.array([0.0, *sorted(shares), 1.0])
        share = 0.5 * (edges[1:] + edges[:-1] - 2.0 * ages[j]) / (ages[j + 1] - ages[j])
        columns = np.rint(first + share * (last - first)).astype(int) + nx
        roots = np.sqrt(np.maximum(edges, 0.0))
        whole = 2.0 * (roots[:-1] - roots[1:])
        mean = (edges[:-1] + roots[:-1] * roots[1:] + edges[1:]) / 3.0  # age, with these weights
        older = (mean - ages[j + 1]) / (ages[j] - ages[j + 1])
        inside = (columns >= 0) & (columns <= 2 * nx)
        for row, part in ((j, older), (j + 1, 1.0 - older)):
            np.add.at(weights[row], columns[inside], (whole * part)[inside])
    return weights


def _add_behind(heat: Array, lag: int, found: Array) -> None:
    """Add what was `lag` nodes upstream; `found` written."""
    nodes = found.shape[1]
    if lag >= 0:
        found[:, lag:] += heat[:, : nodes - lag]
    else:
        found[:, :lag] += heat[:, -lag:]
