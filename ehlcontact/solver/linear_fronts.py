"""Linearised fronts of full film where oil runs short: changes of the flow and of the energy equation there.

The balances are those of `kernels.supply` and of `FilmHeat`; docs/notes/heat.md has the equations.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.solver.film_heat import Terms
from ehlcontact.solver.level import Level

Array = NDArray[Any]


class LinearFronts:
    """Fronts of a starved film, linearised at its present state, for vibrations of one frequency.

    Parameters
    ----------
    level : Level
    rate : complex
        i Omega.
    heated : (Terms, array), optional
        Of a film with heat: terms of its energy equation, and the rise of `FilmHeat`.
    """

    def __init__(self, level: Level, rate: complex, heated: tuple[Terms, Array] | None = None) -> None:
        self._level, self._heated = level, heated
        fronts, flow = level.fronts(), level.fields.flow
        self.nodes, self.before = fronts.nodes, fronts.nodes - 1
        self._width = level.hx / level.speed
        self._half = 0.5 * rate * self._width
        self._full = level.P > 0.0
        self._enters = level.inflow < level.full_flow()[:, 0]
        # Flow pressed back, and its derivatives: to the pressure at given eps, and to ln(eps) on both sides
        self._back, slope = fronts.back, flow.film_slope.ravel()
        self._by_log = fronts.by_film / slope[self.nodes], fronts.by_film_before / slope[self.before]
        self._by_pressure = fronts.by_pressure - self._by_log[0] * flow.eps_slope.ravel()[self.nodes]
        given = level.carried.ravel()[self.before] - self._width * fronts.back
        self._room = level.full_flow().ravel()[self.before] - given
        self._moves = (fronts.passed > 0.0) & (fronts.passed < 1.0)
        # Where the rise is that between the nodes on either side of the first front of a line (`FilmHeat.behind`)
        first = self._full.argmax(axis=1)
        ahead = np.arange(level.nx + 1) < first[:, None]
        lines, columns = np.divmod(self.before, level.nx + 1)
        self._first = columns + 1 == first[lines]
        self._lines, self._ahead = lines[self._first], ahead

    def back(self, dP: Array, log_eps: Array) -> Array:
        """Change of the flow pressed back through the faces before the fronts, (k,)."""
        P, e = dP.ravel(), log_eps.ravel()
        by_log = self._by_log[0] * e[self.nodes] + self._by_log[1] * e[self.before]
        return np.asarray(self._by_pressure * P[self.nodes] + by_log)

    def made(self, dP: Array, back: Array) -> Array:
        """Change of the heat that the flow pressed back makes, (k,)."""
        front = self.nodes
        return np.asarray(back * self._level.P.ravel()[front] + self._back * dP.ravel()[front])

    def through(self, full: Array, pressed: Array, back: Array, layer: float = 0.0) -> Array:
        """Change of the flow through the face behind each node, from that of a full gap.

        Where the gap is partly filled oil that is pressed in (`pressed`, over the area of a node) is passed on
        with the surfaces, and so is the change of the `layer` that enters.
        """
        half, flow = self._half, full.astype(complex)
        flow[self._enters, 0] = layer
        for i in range(1, flow.shape[1] - 1):
            passed = ((1.0 - half) * flow[:, i - 1] + self._width * pressed[:, i]) / (1.0 + half)
            flow[:, i] = np.where(self._full[:, i], full[:, i], passed)
        flow.ravel()[self.before] -= self._width * half / (1.0 + half) * back
        return flow

    def share(self, full: Array, through: Array, back: Array) -> Array:
        """Change of the share of the cells before the fronts that is full, 0 elsewhere, (ny + 1, nx + 1)."""
        room = full.ravel()[self.before] - through.ravel()[self.before]
        passed = self._width * (back - self._back * room / self._room) / self._room
        found = np.zeros(full.shape, complex)
        found.ravel()[self.before] = np.where(self._moves, passed, 0.0)
        return found

    def comes(self, along: Array, across: Array, rise: Array) -> Array:
        """What comes into each node from those behind and beside it, of given flows, as of `FilmHeat`."""
        assert self._heated is not None
        t, found = self._heated[0], np.zeros(rise.shape, complex)
        north = across[:-1]
        found[:, :-1] = -np.where(t.heat_along < 0.0, along, 0.0)[:, :-1] * rise[:, 1:]
        found[:-1] -= np.where(t.heat_across[:-1] < 0.0, north, 0.0) * rise[1:]
        found[1:] += np.where(t.heat_across[:-1] > 0.0, north, 0.0) * rise[:-1]
        found[:, 0] = found[-1] = 0.0
        return found

    def seen_ahead(self, share: Array) -> Array:
        """Change of the rise that is seen ahead of the fronts, by that of the shares."""
        assert self._heated is not None
        rise, change = self._heated[1].ravel(), np.zeros(share.shape[0], complex)
        front, before = self.nodes[self._first], self.before[self._first]
        change[self._lines] = share.ravel()[before] * (rise[before] - rise[front])
        return np.asarray(change[:, None] * self._ahead)
