"""Heat of a film over time: storage in oil and surfaces, and its transport; eqs. 10 and 11 of docs/heat.md.

Differences in time are those of the film. The heat given to the surfaces is stored for the time that they take
through the computed region, and is linear between the steps: all of this is of second order in the step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import takewhile

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.heat import Heat, require_heat
from ehlcontact.point import Point, Scales
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.solver.film_heat import FilmHeat, Terms
from ehlcontact.solver.level import Level
from ehlcontact.solver.multigrid import Multigrid

Array = NDArray[np.float64]

LAST_ROUNDS = 5  # of the temperatures of a solved step, whose viscosity stays


@dataclass(frozen=True, slots=True, eq=False)
class HeatState:
    """Temperatures between steps, and what the next ones need of the past; its arrays are never written."""

    rise: Array
    walls: Array
    heating: Array  # of the viscosity
    stored: tuple[Array, Array]  # in the oil, now and a step before
    pressure: tuple[Array, Array]  # likewise
    T: float
    given: tuple[tuple[float, Array], ...]  # to the surfaces, (2, ny + 1, nx + 1), latest first, with the times


class HeatOverTime(FilmHeat):
    """Temperatures on the finest level that move in time, from those of a steady film.

    Parameters
    ----------
    multigrid : Multigrid
    inputs : Heat
        With the data of the oil.
    scales : Scales
    """

    def __init__(self, multigrid: Multigrid, inputs: Heat, scales: Scales) -> None:
        super().__init__(multigrid.finest, inputs.numbers(multigrid.point, scales))
        self._multigrid, self._inputs = multigrid, inputs
        self._load = inputs.load(multigrid.point, scales)
        level: Level = multigrid.finest
        self._weights = self.memory[0]  # of heat in a cell, by its distance
        edges = np.append(0.0, (np.arange(level.nx + 1) + 0.5) * level.hx)
        distance = np.diff(edges**1.5) / 1.5 / self._weights  # mean with these weights
        self._delays = [distance / speed for speed in self.speeds]
        self._step: tuple[Array, Array] | None = None  # what is known of the differences of heat and pressure
        self._now: list[Array] = []
        self._before: list[Array] = []
        self.state: HeatState

    def rest(self) -> None:
        """Let the temperatures be those of a steady film, of the inlet at first."""
        self.rise[...] = 0.0
        self.walls[...] = 0.0
        self._step = None
        self._multigrid.set_heat(np.zeros_like(self.rise))

    def begin(self, dT: float, known: Callable[[Array, Array], Array]) -> None:
        """Begin a step; ``known(now, before)`` is the known part of a difference in time."""
        state = self.state
        stored = self.numbers.convection * known(*state.stored)
        self._step = stored, known(*state.pressure)
        parts = [np.clip(1.0 - delay / dT, 0.0, 1.0) for delay in self._delays]
        nothing = np.zeros(self.level.nx + 1)
        self._now = [scipy.linalg.toeplitz(self._weights * part, nothing).T for part in parts]
        self._before = [self._brought(k, dT) for k in range(1 if self.even else 2)]

    def _brought(self, k: int, dT: float) -> Array:
        """What a surface brings of the heat given to it in earlier steps, to the end of a step."""
        state, delays = self.state, self._delays[k]
        times = np.array([T for T, _ in reversed(state.given)])
        fields = [heat[k] for _, heat in reversed(state.given)]
        found = np.zeros_like(self.rise)
        nodes, last = self.level.nx + 1, len(times) - 1
        for lag in range(nodes):
            T = state.T + dT - delays[lag]
            if T >= state.T:
                heat = min(delays[lag] / dT, 1.0) * fields[last][:, : nodes - lag]
            else:
                i = int(np.searchsorted(times, T))
                heat = fields[i][:, : nodes - lag]
                if i > 0:
                    part = (T - times[i - 1]) / (times[i] - times[i - 1])
                    heat = part * heat + (1.0 - part) * fields[i - 1][:, : nodes - lag]
            found[:, lag:] += self._weights[lag] * heat
        return found

    def end(self, dT: float) -> None:
        """Take what was found as the state; a `dT` of 0 is that of rest."""
        resting = dT == 0.0
        self.solve(*() if resting else (LAST_ROUNDS,))
        t, level = self.terms(), self.level
        mean = self.behind(self.rise, t.share) + self.walls.mean(axis=0)
        stored, P = level.fields.flow.mass * mean, level.P.copy()
        T = 0.0 if resting else self.state.T + dT
        given: tuple[tuple[float, Array], ...] = ((T, np.array(self.into_walls(t))),)
        if not resting:
            longest = max(float(delay[-1]) for delay in self._delays)
            young = tuple(takewhile(lambda entry: entry[0] > T - longest, self.state.given))
            given += self.state.given[: len(young) + 1]
        self.state = HeatState(
            rise=self.rise.copy(),
            walls=self.walls.copy(),
            heating=level.fields.flow.heat.copy(),
            stored=(stored, stored if resting else self.state.stored[0]),
            pressure=(P, P if resting else self.state.pressure[0]),
            T=T,
            given=given,
        )

    def at_rest(self, cold: float) -> FilmTemperature:
        """Temperatures of a steady film whose central film would be `cold` without heat."""
        return FilmTemperature(
            inputs=self._inputs,
            mean=self.mean.T.copy(),
            surfaces=self.walls.transpose(0, 2, 1).copy(),
            film_share=self.level.central_film() / cold,
            thermal_load=self._load,
            balance=self.balance(),
        )

    def numbers_of_record(self) -> tuple[float, float, float]:
        """Warmest oil and surface [K above the inlet], and the balance of energy over the heat made."""
        return float(self.mean.max()), float(self.walls.max()), self.balance()

    def restore(self, state: HeatState) -> None:
        """Return to a saved state."""
        self.state = state
        self.rise[...], self.walls[...] = state.rise, state.walls
        self._multigrid.set_heat(state.heating)

    def terms(self) -> Terms:
        """As of a steady film, with what oil stores, and the heat of compression in time."""
        t = super().terms()
        if self._step is None:
            return t
        level, n = self.level, self.numbers
        squeezed = n.expansion * t.H * (level.c_t * level.P + self._step[1])
        storage = level.c_t * n.convection * level.fields.flow.mass
        return t._replace(work=t.work + np.where(t.wet, squeezed, 0.0), storage=np.where(t.wet, storage, 0.0))

    def stored(self, t: Terms, mean: Array) -> Array | float:
        """Heat that a mean temperature takes up in time (eq. 10)."""
        return 0.0 if self._step is None else t.storage * mean + self._step[0]

    def passed_on(self, k: int, heat: Array) -> Array:
        """Heat given to a surface, upstream of each node and earlier, over the root of the distance (eq. 11)."""
        if self._step is None:
            return super().passed_on(k, heat)
        return np.asarray(heat @ self._now[k] + self._before[k if len(self._before) > 1 else 0])


def require_heat_over_time(thermal: Heat, point: Point, **others: object) -> Heat:
    """Heat with the data of the oil; raises `InputError` where there are `others` that it does not go with."""
    require_heat(thermal)
    for name, value in others.items():
        if value is not None:
            raise InputError(name, type(value).__name__, "left out with heat")
    return thermal.at(point)
