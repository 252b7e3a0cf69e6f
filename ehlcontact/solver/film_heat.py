"""Heat of a film: temperatures of oil and surfaces from pressure and film; equation numbers of docs/notes/heat.md.

The mean temperature follows from the heat of pressure-driven flow, sliding and compression, what the oil carries,
and what goes into both surfaces, which are half-spaces that move through the heat. All terms are per area of a
node, in units of p_h u_mean delta_H/a; temperatures are in K above that of the inlet.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.heat import HeatNumbers
from ehlcontact.solver.kernels.heat import sweep, warm_walls
from ehlcontact.solver.kernels.reynolds import FILM_FLOOR
from ehlcontact.solver.level import Level

Array = NDArray[np.float64]

INNER = 0.6  # of the heat of the pressure-driven flow; the rest arises at the surfaces and enters them (eq. 4)
NET, BACK = 8.0 / 7.0, 1.0 / 7.0  # shares of the net flow, and of the surfaces' own, that carry the rise (eq. 5)
BY_RISE, BY_PRESSURE, BY_SLIDING = 0.6, 12.0 / 175.0, 0.4  # temperature that the pressure-driven flow sees (eq. 8)
SETTLED = 1e-9  # change of the temperatures in one round, over the largest
ROUGHLY = 1e-6  # the same of a sweep between cycles
MOST_ROUNDS, MOST_SWEEPS = 100, 50


class Terms(NamedTuple):
    """Terms of the energy equation that belong to one state of pressure and film, (ny + 1, nx + 1) each."""

    wet: NDArray[np.bool_]  # part of the energy equation
    share: Array  # of the cell that is full
    H: Array
    along: Array  # mass through the faces behind the nodes, and to the next line
    across: Array
    heat_along: Array  # heat that a rise of 1 carries through them
    heat_across: Array
    pressed: Array  # made by the pressure-driven flow
    work: Array  # expansion times the work of compression
    exchange: Array  # given to the surfaces by a rise of 1
    cold: Array  # ln(eta) at the temperature of the inlet
    storage: Array | float = 0.0  # taken up in a step of time by a degree of mean temperature


class Sliding(NamedTuple):
    """Heat that sliding makes, and its slopes, (ny + 1, nx + 1) each."""

    made: Array
    by_mean: Array  # over the mean temperature, at most 0
    by_stress: Array  # over ln of Newton's stress


class FilmHeat:
    """Temperatures on one level.

    Attributes
    ----------
    rise : array (ny + 1, nx + 1)
        Mean temperature over the film less that of the surfaces there; 0 where there is no pressure.
    walls : array (2, ny + 1, nx + 1)
        Temperatures of both surfaces, the faster one first.
    """

    condition = "heat"

    def __init__(self, level: Level, numbers: HeatNumbers) -> None:
        self.level, self.numbers = level, numbers
        self.rise, self.walls = np.zeros(level.P.shape), np.zeros((2, *level.P.shape))
        # Behind the centre what pressure makes goes straight to the surfaces: in the oil it would only move the
        # pressure spike, which moves the heat, and cycles on fine grids would not settle.
        self.ahead = level.X <= 0.0
        behind = np.sqrt(np.append(0.0, (np.arange(level.nx + 1) + 0.5) * level.hx))
        # Rise of a surface at one node by heat in the cell of another: of a half-space that moves
        self.memory = scipy.linalg.toeplitz(2.0 * np.diff(behind), np.zeros(level.nx + 1)).T

    @property
    def speeds(self) -> tuple[float, float]:
        """Of both surfaces, over their mean, the faster one first."""
        return 1.0 + 0.5 * self.numbers.slide_roll, 1.0 - 0.5 * self.numbers.slide_roll

    @property
    def even(self) -> bool:
        """Whether both surfaces have the same temperature: in pure rolling, of the same material."""
        return self.numbers.slide_roll == 0.0 and self.numbers.walls[0] == self.numbers.walls[1]

    @property
    def changes_film(self) -> bool:
        """Whether the viscosity falls with temperature."""
        return self.numbers.exponent != 0.0

    @property
    def mean(self) -> Array:
        """Mean temperature over the film."""
        return self.rise + self.walls.mean(axis=0)

    def solve(self, rounds: int = MOST_ROUNDS) -> Array:
        """Temperatures at the present P, film and flow; returns what ``Flow.heat`` becomes by them (eqs. 8, 9)."""
        t, n = self.terms(), self.numbers
        enough = SETTLED if rounds == MOST_ROUNDS else ROUGHLY
        for _ in range(rounds):
            before = np.concatenate([self.rise[None], self.walls])
            slid, slope, _ = self.sliding(t)
            made = self._made(t) + slid - slope * self.rise
            for _ in range(MOST_SWEEPS):
                given = t.heat_along, t.heat_across, t.exchange + t.storage - slope, made, t.share
                if sweep(*given, self.rise) <= enough * np.abs(self.rise).max():
                    break
            lacking = np.array(
                [n.walls[k] * self.passed_on(k, heat) - self.walls[k] for k, heat in enumerate(self.into_walls(t))]
            )
            if not self.even:
                # of a change of the mean: heat that is not made, but for what the rise makes up
                made = 0.5 * slope * t.exchange / np.where(t.wet, t.exchange + t.storage - slope, 1.0)
                warm_walls(self.now, made, t.exchange / 12.0, lacking)
            self.walls += lacking
            after = np.concatenate([self.rise[None], self.walls])
            if np.abs(after - before).max() <= SETTLED * np.abs(after).max():
                break
        return self.numbers.heating(self.seen(t))

    def seen(self, t: Terms) -> Array:
        """Temperature that the pressure-driven flow sees (eq. 8)."""
        by_pressure, slid = t.pressed * self.ahead, self.sliding(t).made
        beside = t.H / self.numbers.conduction * (BY_PRESSURE * by_pressure + BY_SLIDING * slid)
        return self.walls.mean(axis=0) + BY_RISE * self.behind(self.rise, t.share) + beside

    def behind(self, rise: Array, share: Array) -> Array:
        """The same with the rise that the oil has left the pressure with at the nodes behind it.

        Else nodes at the outlet would change their viscosity once they are wet, and two films would be solutions.
        Nodes ahead of a front of full film take the rise at the front, between the nodes on either side of it.
        """
        wet = self.level.P > 0.0
        last = np.maximum.accumulate(np.where(wet, np.arange(self.level.nx + 1), 0), axis=1)
        found = np.take_along_axis(rise, last, axis=1)
        if self.level.inflow.size:
            first = np.maximum(wet.argmax(axis=1), 1)[:, None]
            before, at, part = (
                np.take_along_axis(f, i, axis=1) for f, i in ((rise, first - 1), (rise, first), (share, first - 1))
            )
            found = np.where((last == 0) & (first > 1), at + part * (before - at), found)
        return found

    def hold(self) -> Array:
        """What ``Flow.heat`` is by the present temperatures of surfaces and rise."""
        return self.numbers.heating(self.seen(self.terms()))

    def balance(self) -> float:
        """Heat made less heat given to the surfaces and carried away, over all that is made, in the whole film."""
        t, n = self.terms(), self.numbers
        slid, wall = self.sliding(t).made, self.walls.mean(axis=0)
        work = t.work * (n.inlet + self.mean)
        rise = np.pad(self.rise, ((0, 1), (0, 1)))
        along = np.maximum(t.heat_along, 0.0) * self.rise + np.minimum(t.heat_along, 0.0) * rise[:-1, 1:]
        across = np.maximum(t.heat_across, 0.0) * self.rise + np.minimum(t.heat_across, 0.0) * rise[1:, :-1]
        turned = self._turned(t)
        carried = np.where(t.wet | (turned != 0.0), divergence(along, across), 0.0)
        carried += np.where(t.wet, self.with_walls(t, wall) + self.stored(t, self.mean), -self.released(t))
        left = t.pressed + slid + work - sum(self.into_walls(t)) - carried
        weights = self.level.force_weights
        return float(abs(np.vdot(weights, left)) / np.vdot(weights, t.pressed + slid + np.abs(work)))

    @np.errstate(over="ignore", invalid="ignore")  # of a film that ran away: its status says so
    def result(self, before: float) -> dict[str, Any]:
        """Temperatures of the film as it is, as `described`."""
        self.solve()
        return self.described(before)

    def described(self, before: float) -> dict[str, Any]:
        """Fields and numbers of a `FilmTemperature`; the central film without heat was `before`."""
        return {
            "mean": self.mean.T.copy(),
            "surfaces": self.walls.transpose(0, 2, 1).copy(),
            "film_share": self.level.central_film() / before,
            "balance": self.balance(),
        }

    def terms(self) -> Terms:
        """Terms at the present state of the level (eqs. 2 to 5)."""
        level, n, s = self.level, self.numbers, self.level.stencil
        P, flow, H = level.P, level.fields.flow, np.maximum(level.H, FILM_FLOOR)
        along, across, back, by_x = (np.zeros_like(P) for _ in range(4))
        step_x, step_y = np.diff(P, axis=1), np.diff(P, axis=0)
        by_x[:, :-1] = s.cx * flow.along[:, :-1] * step_x**2
        through, share = level.full_flow(), (P > 0.0).astype(float)
        if level.inflow.size:
            self._enter_supply(through, share, by_x)
        along[:, :-1] = s.inv_hx * through[:, :-1] - s.cx * flow.along[:, :-1] * step_x
        across[:-1] = -s.cy * flow.across[:-1] * step_y
        back[:, :-1] = 0.5 * s.inv_hx * (flow.mass[:, :-1] + flow.mass[:, 1:])
        pressed = at_nodes(by_x[:, :-1], s.cy * flow.across[:-1] * step_y**2)
        work = at_nodes(along[:, :-1] * step_x, across[:-1] * step_y)
        log_eta = np.log(flow.rho * H**3 / (s.lam * flow.eps))
        wet = share > 0.0
        return Terms(
            wet=wet,
            share=share,
            H=H,
            along=along,
            across=across,
            heat_along=n.convection * (NET * along - BACK * back),
            heat_across=n.convection * NET * across,
            pressed=np.where(wet, pressed / flow.rho, 0.0),
            work=np.where(wet, n.expansion * work / flow.rho, 0.0),
            exchange=np.where(wet, share * n.conduction / H, 0.0),
            cold=(log_eta - flow.heat * level.law.q) / (1.0 + flow.heat),
        )

    def _enter_supply(self, through: Array, share: Array, by_x: Array) -> None:
        """What the surfaces carry where oil runs short; full shares, and heat, at the fronts of full film.

        The node before a front is full as far as the front has passed its cell, and takes part in the energy
        equation so far: so temperatures are continuous while nodes fill up. `through`, `share`, `by_x` written.
        """
        level, fronts = self.level, self.level.fronts()
        before = fronts.nodes - 1
        through[...] = level.carried
        through.ravel()[before] -= (
            (1.0 + level.fields.flow.open.ravel()[before]) * level.hx * fronts.back / level.speed
        )
        by_x.ravel()[before] = fronts.back * level.P.ravel()[fronts.nodes]
        share.ravel()[before] = np.clip(fronts.passed, 0.0, 1.0)
        self.rise[share == 0.0] = 0.0

    def _made(self, t: Terms) -> Array:
        """Heat that enters the rise, but for that of sliding."""
        wall = self.walls.mean(axis=0)
        made = t.work * (self.numbers.inlet + self.rise + wall) + INNER * t.pressed
        return made * self.ahead - np.where(t.wet, self.with_walls(t, wall) + self.stored(t, wall), 0.0)

    def stored(self, t: Terms, mean: Array) -> Array | float:
        """Heat that a mean temperature takes up in time: none in a steady film."""
        return 0.0

    def released(self, t: Terms) -> Array | float:
        """Heat of oil from which a front of full film has receded: none in a steady film."""
        return 0.0

    @property
    def now(self) -> Array:
        """Rise of each surface by a unit of heat at as many nodes upstream, in K, (2, nx + 1)."""
        return np.array([wall * self.memory[0] for wall in self.numbers.walls])

    def passed_on(self, k: int, heat: Array) -> Array:
        """Heat given to a surface, upstream of each node, over the root of the distance (eq. 7)."""
        return np.asarray(heat @ self.memory)

    def with_walls(self, t: Terms, wall: Array) -> Array:
        """What the oil carries on because it has the temperature of the surfaces."""
        along, across = np.zeros_like(wall), np.zeros_like(wall)
        along[:, :-1] = 0.5 * t.along[:, :-1] * (wall[:, :-1] + wall[:, 1:])
        across[:-1] = 0.5 * t.across[:-1] * (wall[:-1] + wall[1:])
        return self.numbers.convection * divergence(along, across)

    def into_walls(self, t: Terms) -> tuple[Array, Array]:
        """Heat that goes into each surface (eq. 6)."""
        straight = (1.0 - INNER * self.ahead) * t.pressed + ~self.ahead * t.work * (self.numbers.inlet + self.mean)
        half = 0.5 * (t.exchange * self.rise + straight + self._turned(t) + self.released(t))
        through = t.exchange / 12.0 * (self.walls[1] - self.walls[0])
        return half + through, half - through

    def _turned(self, t: Terms) -> Array:
        """Heat that oil carries out of the full film to where it is partly filled ahead, and lies on the surfaces.

        In the middle of a wide gap oil flows back to the front of the film, and turns round there.
        """
        turned = np.zeros_like(self.rise)
        if not self.level.inflow.size:
            return turned
        east, north = np.minimum(t.heat_along, 0.0), t.heat_across
        turned[:, :-1] = -east[:, :-1] * self.rise[:, 1:]
        turned[:-1] -= np.minimum(north[:-1], 0.0) * self.rise[1:]
        turned[1:] += np.maximum(north[:-1], 0.0) * self.rise[:-1]
        turned[:, 0] = turned[-1] = 0.0  # over the border it leaves
        return turned * (1.0 - t.share) * (self.ahead | t.wet)

    def sliding(self, t: Terms) -> Sliding:
        """Heat of sliding under the stress of its law at the mean temperature."""
        n, mean = self.numbers, self.mean
        if n.slide_roll == 0.0:
            return Sliding(*(np.zeros_like(mean) for _ in Sliding._fields))
        heat, above = n.heating(mean), t.cold + self.level.law.q
        newton = n.shear + t.cold + heat * above - np.log(t.H)  # ln of Newton's stress over that of the law
        stress, by_log = n.law.reduced(newton)
        slope = -by_log * above * n.exponent * (1.0 + heat) / (n.temperature_scale + mean)
        power = np.where(t.wet, n.stress * n.slide_roll, 0.0)
        return Sliding(power * stress, power * np.minimum(slope, 0.0), power * by_log)


def at_nodes(along: Array, across: Array) -> Array:
    """Half of what stands on the faces of a node, (ny + 1, nx) along and (ny, nx + 1) across, together."""
    found = np.zeros((along.shape[0], across.shape[1]), along.dtype)
    found[:, 1:-1] = 0.5 * (along[:, :-1] + along[:, 1:])
    found[1:-1] += 0.5 * (across[:-1] + across[1:])
    found[0] += across[0]
    return found


def divergence(along: Array, across: Array) -> Array:
    """What leaves a node through the faces behind it, less what comes through those before it."""
    found = np.zeros_like(along)
    found[:, 1:] = along[:, 1:] - along[:, :-1]
    found[1:] += across[1:] - across[:-1]
    found[0] += 2.0 * across[0]
    return found
