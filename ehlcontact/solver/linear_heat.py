"""Linearised film with heat: temperatures that follow a vibration, with pressure and approach.

Fronts of films under a layer of oil may move (`linear_fronts`).

With ``g``, the relative change of ln(eta) + 9.67 by temperature, as a further unknown, the equations of `linear`
become

    Jp dP + Jh (K dP - du) + Jg dg = r,      dg - G(Omega) [dP, K dP - du, dg] = 0,

and G is the response of the linearised energy equation: oil and surfaces store heat, the oil is compressed in time
too, and heat given to a surface upstream arrives later, by the distance over its speed (eqs. 10, 11 of
docs/notes/heat.md). Vectors hold dP, du and dg of all nodes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError
from ehlcontact.solver.film_heat import (
    BACK,
    BY_PRESSURE,
    BY_RISE,
    BY_SLIDING,
    INNER,
    NET,
    FilmHeat,
    at_nodes,
    divergence,
)
from ehlcontact.solver.film_thinning import LinearThinning
from ehlcontact.solver.kernels.heat import warm_walls
from ehlcontact.solver.level import Level
from ehlcontact.solver.linear import CROSS, SPARSE_LU, LinearFilm, Preconditioner, stencil_matrix
from ehlcontact.solver.linear_fronts import LinearFronts

Array = NDArray[Any]

SETTLED = 1e-9  # change of the temperatures of the surfaces in one round, over the largest
MOST_ROUNDS = 100
STILL = 1e-12  # least Omega in `_memory`: as good as 0, without a division by it


class Forcing(NamedTuple):
    """What changes in the equations at fixed pressure, approach and heating; of nodes (ny + 1, nx + 1).

    With a change of `speed`, what follows of it stands over the speed: surfaces then carry what they do, and all
    that the oil does in time is less.
    """

    flow: Array  # of the Reynolds operator at all nodes, flat
    height: Any = 0.0  # of the film
    source: Any = None  # of oil, which corrects how features are carried and has the temperature of the film
    log_eps: Any = 0.0  # of ln(eps)
    ratio: Any = 0.0  # of ln of the viscosity along over that across
    layer: float = 0.0  # of oil that enters
    speed: float = 0.0  # of both surfaces, over itself


NO_FORCING = Forcing(np.zeros(0))


class Changes(NamedTuple):
    """Changes of the terms of the energy equation by pressure, film and heating, (ny + 1, nx + 1) each."""

    along: Array
    across: Array
    heat_along: Array
    heat_across: Array
    pressed: Array
    work: Array
    exchange: Array
    slid: Array
    mass: Array
    share: Any = 0.0  # of the cells before fronts of full film


class LinearHeat:
    """Energy equation of a film, linearised at its present state, for vibrations of one frequency.

    Parameters
    ----------
    heat : FilmHeat
        Its temperatures belong to the state of its level.
    omega : float
        Angular frequency, per unit 2a/u_sum of time.
    thinning : LinearThinning, optional
        Of a film that sliding thins: the slopes of the flow of the level are those with it.
    """

    def __init__(self, heat: FilmHeat, omega: float, thinning: LinearThinning | None = None) -> None:
        level, n = heat.level, heat.numbers
        self.thinning = thinning
        self.heat, self.level, self.rate = heat, level, 1j * omega
        self.terms = t = heat.terms()
        self.wall, self.mean = heat.walls.mean(axis=0), heat.mean
        self._slid = heat.sliding(t)
        self.above = t.cold + level.law.q
        self.rho_slope = level.fields.flow.mass_slope / t.H / level.fields.flow.rho  # d ln(rho)/dP
        seen = heat.seen(t)
        self._by_seen = -n.exponent * (1.0 + heat.numbers.heating(seen)) / (n.temperature_scale + seen)
        self._by_mean_temperature = -n.exponent * (1.0 + n.heating(self.mean)) / (n.temperature_scale + self.mean)
        self._storage = np.where(t.wet, self.rate * n.convection * level.fields.flow.mass, 0.0)
        self._storage_of_walls = self._storage
        # Of a unit of mean temperature: what compression and sliding make
        self._warmer = t.work * heat.ahead + self._slid.by_mean
        self._fronts = LinearFronts(level, self.rate, (t, heat.rise)) if level.inflow.size else None
        if self._fronts is not None:
            # Walls see the oil in the cells, the rise the part of it that is in the full film
            self._storage *= t.share
            self._storage_of_walls = np.where(t.wet, self.rate * n.convection * level.oil, 0.0)
            self._turns = (1.0 - t.share) * (heat.ahead | t.wet)
        # Heat that each surface takes more when both are warmer by 1, but for what the oil carries
        kept = self._warmer - self._storage_of_walls
        own = np.where(t.wet, t.exchange - self._warmer + self._storage, 1.0)
        self._by_mean = 0.5 * t.exchange * kept / own
        self._factorise()
        self._memories = [_memory(level.nx, level.hx, omega / speed) for speed in heat.speeds]
        self._omega = omega

    def _factorise(self) -> None:
        t, shape = self.terms, self.level.P.shape
        along, across = t.heat_along, t.heat_across
        west, south = np.zeros(shape), np.zeros(shape)
        west[:, 1:], south[1:], south[0] = along[:, :-1], across[:-1], -across[0]
        taken = (-np.maximum(west, 0.0), np.minimum(along, 0.0), -np.maximum(south, 0.0), np.minimum(across, 0.0))
        given = np.maximum(along, 0.0) - np.minimum(west, 0.0) + np.maximum(across, 0.0) - np.minimum(south, 0.0)
        own = given + t.exchange - self._warmer + self._storage
        # Where the cell before a front is partly full the rest of the heat that comes turns round
        matrix = stencil_matrix(CROSS, np.array([own, *(t.share * part for part in taken)]), shape)
        self._nodes = np.flatnonzero(t.wet)
        self._lu = scipy.sparse.linalg.splu(matrix[self._nodes][:, self._nodes].tocsc(), **SPARSE_LU)

    def weight(self) -> float:
        """Norm of the change of the Reynolds operator by a heating, over that of the heating; 1 without it."""
        heating = self.level.fields.flow.heat
        size = scipy.linalg.norm(heating)
        return float(scipy.linalg.norm(viscous(self.level, self.above * heating)) / size) if size > 0.0 else 1.0

    def changes(
        self, dP: Array, dH: Array, dg: Array, aside: Array | None = None, by: Forcing = NO_FORCING
    ) -> Changes:
        """Changes of the terms; `aside` is that of ln of the viscosity along over that across by temperature."""
        level, n, t = self.level, self.heat.numbers, self.terms
        flow, s, P = level.fields.flow, level.stencil, level.P
        step_x, step_y = np.diff(P, axis=1), np.diff(P, axis=0)
        change_x, change_y = np.diff(dP, axis=1), np.diff(dP, axis=0)
        log_eps = flow.eps_slope * dP + flow.film_slope * dH - self.above * dg + by.log_eps
        mean_x, mean_y = flow_changes(level, log_eps)
        flow_x, flow_y = flow.along[:, :-1], flow.across[:-1]
        if (thinning := self.thinning) is not None:
            ratio = thinning.aside_by_pressure * dP + thinning.aside_by_film * dH + by.ratio
            ratio = ratio if aside is None else ratio + aside
            mean_y = mean_y + 0.5 * flow_y * (ratio[:-1] + ratio[1:])
        mass = flow.mass_slope * dP + flow.rho * dH
        through: Array = level.full_flow(mass)
        share: Any = 0.0
        by_pressure = s.cx * (mean_x * step_x + flow_x * change_x)
        across = padded(-s.cy * (mean_y * step_y + flow_y * change_y), 0)
        back = padded(0.5 * s.inv_hx * (mass[:, :-1] + mass[:, 1:]), 1)
        by_x = s.cx * (mean_x * step_x + 2.0 * flow_x * change_x) * step_x
        if (fronts := self._fronts) is not None:
            pressed_back, full = fronts.back(dP, log_eps), through
            pressed_in = divergence(padded(by_pressure, 1), -across)
            through = fronts.through(full, pressed_in, pressed_back, by.layer)
            share = fronts.share(full, through, pressed_back)
            by_x = padded(by_x, 1).astype(complex)
            by_x.ravel()[fronts.before] = fronts.made(dP, pressed_back)
            by_x = by_x[:, :-1]
        along = s.inv_hx * through
        along[:, :-1] -= by_pressure
        pressed = at_nodes(by_x, s.cy * (mean_y * step_y + 2.0 * flow_y * change_y) * step_y)
        work = at_nodes(
            along[:, :-1] * step_x + t.along[:, :-1] * change_x, across[:-1] * step_y + t.across[:-1] * change_y
        )
        lighter = self.rho_slope * dP
        return Changes(
            along=along,
            across=across,
            heat_along=n.convection * (NET * along - BACK * back),
            heat_across=n.convection * NET * across,
            pressed=np.where(t.wet, pressed / flow.rho, 0.0) - lighter * t.pressed,
            work=np.where(t.wet, n.expansion * work / flow.rho, 0.0) - lighter * t.work,
            exchange=np.where(t.wet, share * n.conduction / t.H, 0.0)
            - t.exchange * dH / t.H
            - by.speed * t.exchange,
            slid=self._sliding(dP, dH, by.speed),
            mass=mass,
            share=share,
        )

    def _sliding(self, dP: Array, dH: Array, speed: float) -> Array:
        """Change of the heat of sliding at given temperatures, over the speed."""
        if self.heat.numbers.slide_roll == 0.0:
            return np.zeros_like(dP)
        flow = self.level.fields.flow
        warm = 1.0 + self.heat.numbers.heating(self.mean)
        if self.thinning is None:
            thicker = warm / (1.0 + flow.heat) * (self.rho_slope - flow.eps_slope) * dP
        else:
            thicker = warm * self.thinning.cold_slope * dP  # of ln(eta), at the mean temperature
        return self._slid.by_stress * (thicker - dH / self.terms.H + speed)

    def to_change(self, by: Forcing) -> Array:
        """What follows of a change at fixed pressure, as of `respond`."""
        still = np.zeros(self.level.P.shape, complex)
        fields = np.array([still] * (1 if self.thinning is None else 2))
        return self.respond(still, still + by.height, fields, by)

    def respond(self, dP: Array, dH: Array, fields: Array, by: Forcing = NO_FORCING) -> Array:
        """Heating dg by the temperatures that follow from dP, dH and `fields`: dg itself; all (ny + 1, nx + 1).

        With thinning a second field follows, the change of ln of the viscosity along over that across. The height
        of `by` is part of dH.
        """
        heat, n, t = self.heat, self.heat.numbers, self.terms
        c = self.changes(dP, dH, fields[0], fields[1] if len(fields) > 1 else None, by)
        # Compression in time, by the change of pressure at the node
        squeezed = np.where(t.wet, self.rate * n.expansion * t.H * dP, 0.0)
        compressed = (c.work + squeezed) * (n.inlet + self.mean)
        rise, walls = self._temperatures(c, compressed, by)
        slid = c.slid + self._slid.by_mean * (rise + walls.mean(axis=0)) + by.speed * self._slid.made
        beside = BY_PRESSURE * (c.pressed + by.speed * t.pressed) * heat.ahead + BY_SLIDING * slid
        was = BY_PRESSURE * t.pressed * heat.ahead + BY_SLIDING * self._slid.made
        of_rise = heat.behind(rise, t.share)
        if self._fronts is not None:
            of_rise = of_rise + self._fronts.seen_ahead(c.share)
        seen = walls.mean(axis=0) + BY_RISE * of_rise + (t.H * beside + dH * was) / n.conduction
        heating = self._by_seen * seen
        if self.thinning is None:
            return np.array([heating])
        thicker = self._by_mean_temperature * (rise + walls.mean(axis=0))
        return np.array([heating + self.thinning.along * thicker, self.thinning.aside * self.above * thicker])

    def _temperatures(self, c: Changes, compressed: Array, by: Forcing) -> tuple[Array, Array]:
        """Changes of the rise and of both surfaces; `compressed` is the heat of compression."""
        heat, n, t = self.heat, self.heat.numbers, self.terms
        lost = self._lost(c)
        if by.source is not None:
            lost = lost - np.where(t.wet, n.convection * by.source * self.mean, 0.0)
        exchanged = c.exchange * heat.rise
        made = (compressed + INNER * c.pressed) * heat.ahead + c.slid - lost - exchanged
        straight = (1.0 - INNER * heat.ahead) * c.pressed + ~heat.ahead * compressed + exchanged
        if (fronts := self._fronts) is not None:
            came = fronts.comes(t.heat_along, t.heat_across, heat.rise)
            straight = straight + self._turns * fronts.comes(c.heat_along, c.heat_across, heat.rise)
            straight -= np.where(self._turns > 0.0, c.share * came, 0.0)
        through = c.exchange / 12.0 * (heat.walls[1] - heat.walls[0])
        now = np.array([wall * memory[0] for wall, memory in zip(n.walls, self._memories, strict=True)])
        walls, rise = np.zeros((2, *made.shape), complex), np.zeros(made.shape, complex)
        moved = by.speed * self._moved() if by.speed else walls
        for _ in range(MOST_ROUNDS):
            wall = walls.mean(axis=0)
            warmed = (self._warmer - self._storage_of_walls) * wall
            rhs = made + warmed - n.convection * _with(t.along, t.across, wall)
            rise.ravel()[self._nodes] = self._lu.solve(rhs.ravel()[self._nodes].astype(complex))
            half = 0.5 * (t.exchange * rise + straight + ~heat.ahead * t.work * (rise + wall))
            if self._fronts is not None:
                half += 0.5 * self._turns * self._fronts.comes(t.heat_along, t.heat_across, rise)
            cross = through + t.exchange / 12.0 * (walls[1] - walls[0])
            given = enumerate((half + cross, half - cross))
            lacking = np.array([n.walls[k] * (one @ self._memories[k]) - walls[k] for k, one in given])
            if by.speed:
                lacking += moved
            if not heat.even:
                warm_walls(now, self._by_mean, t.exchange / 12.0, lacking)
            walls += lacking
            if np.abs(lacking).max() <= SETTLED * np.abs(walls).max():
                return rise, walls
        raise ConvergenceError("temperatures of the surfaces do not converge: the film is too thin", None)

    def _moved(self) -> Array:
        """Changes of both surfaces by a unit of speed at the heat that they are given over it (eq. 11)."""
        heat, level = self.heat, self.level
        found = []
        for k, (given, speed) in enumerate(zip(heat.into_walls(self.terms), heat.speeds, strict=True)):
            places = _places(level.nx, level.hx, self._omega / speed)
            found.append(heat.numbers.walls[k] * (given @ (self._memories[k] + places)))
        return np.array(found)

    def _lost(self, c: Changes) -> Array:
        """Change of the heat that leaves a node and is stored there, at given temperatures."""
        heat, n, t, fronts = self.heat, self.heat.numbers, self.terms, self._fronts
        carried = _with(c.along, c.across, self.wall)
        if fronts is None:
            carried = carried + self.rate * c.mass * self.mean
            return _upwind(c.heat_along, c.heat_across, t, heat.rise) + n.convection * carried
        # By the balance of oil, what is stored in a cell is what does not leave it
        carried -= divergence(c.along, c.across) * self.wall
        stored = t.share * c.mass + c.share * self.level.fields.flow.mass
        carried += self.rate * stored * heat.rise
        came = fronts.comes(t.heat_along, t.heat_across, heat.rise)
        comes = fronts.comes(c.heat_along, c.heat_across, heat.rise)
        lost = _upwind(c.heat_along, c.heat_across, t, heat.rise) + (1.0 - t.share) * comes - c.share * came
        return lost + n.convection * carried


class ViscosityChange(NamedTuple):
    """Change of the viscosity of the pressure-driven flow; of nodes (ny + 1, nx + 1)."""

    log_eps: Any = 0.0  # of ln(eps)
    ratio: Any = 0.0  # of ln of that along over that across
    flow: Any = 0.0  # of the Reynolds operator by `ratio`, flat


class LinearViscosity:
    """Part of a viscosity that follows heat and sliding in vibrations about the present film of a level.

    What sliding makes follows at once: it is part of the derivatives to pressure and film, and the slopes of the
    flow of the level are written. What heat makes follows later: further unknowns.
    """

    def __init__(self, level: Level, heat: FilmHeat | None, thinning: LinearThinning | None) -> None:
        self.heat, self.thinning = heat, thinning
        self.fields = 0 if heat is None else 1 if thinning is None else 2  # further unknowns at every node
        self.beside: tuple[Any, Any] | None = None  # as of `LinearFilm`
        self.by_aside: Any = None
        if thinning is not None:
            level.fields.flow.eps_slope[...] += thinning.by_pressure
            level.fields.flow.film_slope[...] += thinning.by_film
            self.by_aside = thinning.matrix()
            aside = thinning.aside_by_pressure, thinning.aside_by_film
            self.beside = tuple(self.by_aside @ scipy.sparse.diags(slope.ravel()) for slope in aside)

    def system(self, film: LinearFilm, omega: float) -> LinearFilm | HeatedSystem:
        """Equations of a vibration of one frequency, with its unknowns beside those of the film."""
        if self.heat is None:
            return film
        return HeatedSystem(film, LinearHeat(self.heat, omega, self.thinning), self.by_aside)

    def of_speed(self) -> ViscosityChange:
        """As of `effects.LinearEffect`: sliding thins more."""
        if self.thinning is None:
            return ViscosityChange()
        ratio = self.thinning.aside
        return ViscosityChange(-self.thinning.along, ratio, self.by_aside @ ratio.ravel())

    def of_unknowns(self, system: Any, fields: Array, dP: Array, dH: Array) -> ViscosityChange:
        """As of `effects.LinearEffect`."""
        log_eps: Any = -system.heat.above * fields[0] if len(fields) else 0.0
        ratio: Any = fields[1] if len(fields) > 1 else 0.0
        if self.thinning is not None:
            ratio = ratio + self.thinning.aside_by_pressure * dP + self.thinning.aside_by_film * dH
        return ViscosityChange(log_eps, ratio)


class HeatedSystem:
    """Equations of a vibration, with the heating beside pressure and approach; vectors (2 nodes + 1,).

    With thinning (3 nodes + 1,): `by_aside` is the change of the operator by that of ln of the viscosity along
    over that across.
    """

    def __init__(self, film: LinearFilm, heat: LinearHeat, by_aside: Any = None) -> None:
        self.film, self.heat, self.by_aside = film, heat, by_aside
        self._cut = film.free.size + 1
        # Scales the rows of the heating to their effect on the rows of the film
        self.weight = heat.weight()

    def split(self, x: Array) -> tuple[Array, Array]:
        """Pressure and approach, and the further fields."""
        return x[: self._cut], x[self._cut :]

    def __call__(self, x: Array) -> Array:
        """Left-hand sides."""
        film, fields = self.split(x)
        left = self.film(film)
        given = fields.reshape(-1, *self.film.free.shape)
        log_eps = -self.heat.above * given[0]
        changed = viscous(self.heat.level, log_eps).ravel()
        if self.by_aside is not None:
            changed = changed + self.by_aside @ given[1].ravel()
        left[:-1] += self.film.with_supply(changed, log_eps.ravel()) * self.film.free.ravel()
        return np.concatenate([left, self.weight * (fields - self.response(film, fields))])

    def response(self, film: Array, fields: Array) -> Array:
        """Heating that follows from pressure, approach and heating, flat."""
        shape = self.film.free.shape
        dP = film[:-1].reshape(shape)
        dH = self.film.deflect(film[:-1]).reshape(shape) - film[-1]
        return self.heat.respond(dP, dH, fields.reshape(-1, *shape)).ravel()


class HeatedPreconditioner:
    """Film at given heating first, then the heating that follows from it."""

    def __init__(self, film: Preconditioner) -> None:
        self._film = film

    def __call__(self, system: HeatedSystem, b: Array) -> Array:
        """Approximate solution of ``system(x) = b``."""
        left, g = system.split(b)
        film = self._film(system.film, left)
        return np.concatenate([film, g / system.weight + system.response(film, np.zeros_like(g))])


def viscous(level: Level, log_eps: Array) -> Array:
    """Change of the Reynolds operator by a change of ln(eps), (ny + 1, nx + 1)."""
    s, P = level.stencil, level.P
    along, across = flow_changes(level, log_eps)
    along, across = s.cx * along * np.diff(P, axis=1), s.cy * across * np.diff(P, axis=0)
    return divergence(padded(along, 1), padded(across, 0))


def flow_changes(level: Level, log_eps: Array) -> tuple[Array, Array]:
    """Change of the coefficients on the faces by that of ln(eps) at nodes, (ny + 1, nx) and (ny, nx + 1)."""
    flow, d = level.fields.flow, log_eps
    mean, skew = flow.along[:, :-1], flow.along_skew[:, :-1]
    along = (0.5 * mean + skew) * d[:, :-1] + (0.5 * mean - skew) * d[:, 1:]
    mean, skew = flow.across[:-1], flow.across_skew[:-1]
    return along, (0.5 * mean + skew) * d[:-1] + (0.5 * mean - skew) * d[1:]


def padded(faces: Array, axis: int) -> Array:
    """Values on faces with zeros behind the last node along an axis."""
    return np.pad(faces, [(0, int(k == axis)) for k in (0, 1)])


def _upwind(along: Array, across: Array, t: Any, rise: Array) -> Array:
    """What leaves a node with the rise of where the steady flow comes from, of given flows through the faces."""
    ahead, beside = np.pad(rise[:, 1:], ((0, 0), (0, 1))), np.pad(rise[1:], ((0, 1), (0, 0)))
    return divergence(
        along * np.where(t.heat_along > 0.0, rise, ahead), across * np.where(t.heat_across > 0.0, rise, beside)
    )


def _with(along: Array, across: Array, wall: Array) -> Array:
    """What leaves a node with the temperature of the surfaces, of given flows through the faces."""
    east = 0.5 * (wall + np.pad(wall[:, 1:], ((0, 0), (0, 1))))
    north = 0.5 * (wall + np.pad(wall[1:], ((0, 1), (0, 0))))
    return divergence(along * east, across * north)


def _memory(nx: int, hx: float, omega: float) -> Array:
    """Rise of a surface at one node by a vibration of the heat in the cell of another upstream (eq. 11)."""
    w = max(omega, STILL)
    edges = np.append(0.0, (np.arange(nx + 1) + 0.5) * hx)
    sine, cosine = scipy.special.fresnel(np.sqrt(2.0 * w * edges / np.pi))
    weights = np.diff(np.sqrt(2.0 * np.pi / w) * (cosine - 1j * sine))
    return scipy.linalg.toeplitz(weights, np.zeros(nx + 1)).T


def _places(nx: int, hx: float, omega: float) -> Array:
    """Change of the rise of a surface at one node by its speed, which shifts where it was given its heat.

    By a vibration of its speed a surface was ``(1 - exp(-i Omega a))/(i Omega)`` times the amplitude further
    upstream at an age a, which is integrated by parts over the cells as of `_memory`.
    """
    w = max(omega, STILL)
    edges = (np.arange(nx + 1) + 0.5) * hx
    way = np.append(0.0, -np.expm1(-1j * w * edges) / (1j * w) / np.sqrt(edges))
    return scipy.linalg.toeplitz(-np.diff(way), np.zeros(nx + 1)).T
