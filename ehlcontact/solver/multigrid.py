"""Full-approximation-scheme multigrid, with force balance or equation of motion inside the cycle.

Venner and Lubrecht (2000), ch. 3 and 6, with changes that make its convergence independent of the mesh: the blend
of both relaxations is smooth and gives nothing to nodes of the other kind (`kernels.relax`), the steep flanks of
the pressure and the cavitation boundary get local passes (`kernels.flanks`, `kernels.boundary`), lines that lie
far apart are coarsened along X first (`level.build_hierarchy`), and the coarsest grid is solved by Newton together
with u (`coarse`) instead of being relaxed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import ceil, log, sqrt
from typing import Any

import numpy as np
import scipy

from ehlcontact.point import MoesPoint
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.coarse_newton import CoarseNewton
from ehlcontact.solver.compiled_beside import await_compilation
from ehlcontact.solver.grid_rules import (
    LEAST_NESTED,
    LOBE_SHARE,
    coarsest_intervals,
    is_long,
    level_is_useful,
    resolved_load,
)
from ehlcontact.solver.kernels import transfer
from ehlcontact.solver.kernels.supply import FITTING, WIDER_GAP
from ehlcontact.solver.level import Array, Level, build_hierarchy
from ehlcontact.solver.mesh import Mesh

PRE_SWEEPS, POST_SWEEPS = 2, 1
REPEATED_LEVELS = 2  # of a long contact: the finest, which alone repeat their sweeps
CYCLES_PER_LEVEL = 1  # of full multigrid, before the finest level
LARGEST_LOADING = 5.0  # factor by which the load of a level rises at once,
CONTINUATION_LOADING = 2.0  # and in load continuation: at most,
LEAST_LOADING = 1.05  # and at least so much
SETTLED_CHANGE = 0.05  # of P by the last cycle after a step of load continuation; a larger one halves the step
CYCLES_AFTER_LOADING = 3  # on a level that carries more load than the one below
FRONT_CYCLES, FRONT_SETTLED = 3, 0.02  # most of them while more than this share of the nodes fill up or empty
# Power of load over that of a level by which its layer is thicker: films go as -2/3, inlets as -4/9.
LAYER_POWER = 2.0 / 9.0
NESTED_CYCLES = 4  # on a grid of half the intervals, its lines as close: its film is solved, and a start


Supply = Callable[[Array], Array]


class Multigrid:
    """A hierarchy of levels and the cycle on it; the state is P on the finest level and the approach u.

    Film, flow and residual of the finest level belong to that state after `full_multigrid` and `cycle`; who
    changes it in other ways calls ``finest.update(u)``.

    Parameters
    ----------
    point : MoesPoint
    mesh : Mesh
    deflection : {"fft", "mlmi", "direct"}
        Engine of the elastic deflection.
    sweep_factor : int
        How often the relaxation sweeps of a cycle are repeated.
    load_continuation : bool
        Raise the load in small steps during full multigrid, from a coarsest level with more lines: for films whose
        side lobes come out negative otherwise. Sweeps are not repeated then, because repeated sweeps let those
        negative films grow.
    threads : int
        Threads that share the work; results do not depend on their number.
    across : int, optional
        Intervals along Y of the finest level; by default what the mesh asks for.
    supply : callable, optional
        Layer of oil that enters at the lines Y, in dry approaches; by default as much as the gap has room for.
    """

    def __init__(
        self,
        point: MoesPoint,
        mesh: Mesh,
        *,
        deflection: str = "fft",
        sweep_factor: int = 1,
        load_continuation: bool = False,
        threads: int = 1,
        across: int | None = None,
        supply: Supply | None = None,
    ) -> None:
        await_compilation()
        self.point, self.mesh, self.supply = point, mesh, supply
        self._options: dict[str, Any] = {
            "supply": supply,
            "deflection": deflection,
            "sweep_factor": sweep_factor,
            "load_continuation": load_continuation,
            "threads": threads,
        }
        levels = build_hierarchy(point, mesh, coarsest_intervals(point, mesh.n), deflection, across)
        self.levels = [level for level in levels if level_is_useful(point, level.nx, mesh.n, load_continuation)]
        self.load_continuation = load_continuation
        for level in self.levels:
            level.share(threads)
        self.sweep_factor = self.least_sweep_factor = sweep_factor  # how often the sweeps of a cycle are repeated
        self.aside: Array | None = None  # as of `set_aside`
        self.is_start = False  # of a finer grid, which goes on from whatever load is carried here
        if supply is not None:
            self.finest.set_supply(supply(self.finest.Y))
        self.newton = CoarseNewton(self.levels[0], is_long(point))
        self.u = initial_approach(point)

    @property
    def finest(self) -> Level:
        """The level on which the solution lives."""
        return self.levels[-1]

    def halved(self) -> Multigrid:
        """One on half the intervals along X and Y, made as this one was, as a start; it holds no film yet.

        Left to itself the smaller mesh may have more than half the lines: transfers between both would read nodes
        that are not there.
        """
        mesh, across = replace(self.mesh, n=self.mesh.n // 2), self.finest.ny // 2
        half = Multigrid(self.point, mesh, across=across, **self._options)
        half.is_start = True
        half.set_heat(self.finest.fields.flow.heat[: 2 * half.finest.ny + 1 : 2, ::2])
        if self.aside is not None:
            half.set_aside(self.aside[: 2 * half.finest.ny + 1 : 2, ::2])
        return half

    def set_heat(self, heat: Array) -> None:
        """Heating of the oil at the nodes of the finest level (`kernels.reynolds.Flow`), on all levels."""
        for level in self.levels:
            across, along = self.finest.ny // level.ny, self.finest.nx // level.nx
            level.fields.flow.heat[...] = heat[::across, ::along]

    def set_aside(self, log_ratio: Array) -> None:
        """Viscosity along over that across at the nodes of the finest level, by its logarithm, on all levels."""
        self.aside = log_ratio
        for level in self.levels:
            across, along = self.finest.ny // level.ny, self.finest.nx // level.nx
            own = log_ratio[::across, ::along]
            level.fields.flow.aside[:-1] = np.exp(0.5 * (own[:-1] + own[1:]))

    def set_time_coefficient(self, c_t: float) -> None:
        """Coefficient of rho H in the implicit part of the squeeze term, on all levels."""
        for level in self.levels:
            level.c_t = c_t

    def full_multigrid(self, balance: Balance, nested: bool = True) -> None:
        """Solve from the coarsest level upwards, with few cycles on each level below the finest.

        Every level carries the load that its mesh can resolve: a film thinner than its errors comes out negative
        there, and is no start for anything. In Hertz units the pressure hardly changes with load. Where lines lie
        close, it starts from the grid of half the intervals instead, unless `nested` is False.
        """
        if nested and self.mesh.y_refinement > 1 and self.mesh.n > LEAST_NESTED:
            self._start_from_half(balance, self.point.M)
        else:
            self._start_from_coarsest(balance, self.point.M)
        self.finest.update(self.u)

    def start_from(self, half: Multigrid) -> None:
        """Take over the film of `halved`."""
        _interpolate_solution(half.finest, self.finest)
        self.u = half.u
        self.finest.update(self.u)

    def _start_from_half(self, balance: Balance, M: float) -> None:
        """From the film on half the intervals, its lines as close, under the load M at last.

        The levels of this grid have ever fewer lines before they have fewer nodes: side lobes are negative there.
        """
        half, last = self.halved(), len(self.levels) - 1
        load = min(resolved_load(self.point, max(half.finest.hx, half.finest.hy) / LOBE_SHARE), M)
        if half.mesh.n > LEAST_NESTED:
            half._start_from_half(balance, load)
        else:
            half._start_from_coarsest(balance, load)
        half.finest.update(half.u)
        for _ in range(NESTED_CYCLES):
            half.cycle(balance)
        _interpolate_solution(half.finest, self.finest)
        self.u = half.u
        self._set_load(last, half.finest.M)
        self._raise_load(last, half.finest.M, M, balance)

    def _start_from_coarsest(self, balance: Balance, M: float) -> None:
        """Level by level, under the load M at last."""
        share = LOBE_SHARE if is_long(self.point) and self.least_sweep_factor > 1 else 1.0
        sizes = [max(level.hx, level.hy) / share for level in self.levels[:-1]]
        loads = [*(min(resolved_load(self.point, size), M) for size in sizes), M]
        self._set_load(0, loads[0])
        self.levels[0].set_dry_hertz()
        self.u = self.newton.solve(
            self.u, balance, max_steps=60, tol=1e-3
        )  # a start: finer levels change it by more
        for k in range(1, len(self.levels)):
            coarse, fine = self.levels[k - 1], self.levels[k]
            fine.rhs[...] = 0.0
            fine.film_shift = 0.0
            _interpolate_solution(coarse, fine)
            if not self._raise_load(k, coarse.M, loads[k], balance):
                self._set_load(k, loads[k])
                self._repeat(k, CYCLES_PER_LEVEL if fine is not self.finest else 0, balance)

    def _raise_load(self, k: int, lower: float, higher: float, balance: Balance) -> int:
        """Take level k from one Moes load to another; returns in how many steps, none where they are the same."""
        if self.load_continuation:
            return self._continue_load(k, lower, higher, balance)
        steps = ceil(log(higher / lower) / log(LARGEST_LOADING) - 1e-9)
        for step in range(1, steps + 1):
            self._set_load(k, lower * (higher / lower) ** (step / steps))
            self._repeat(k, CYCLES_AFTER_LOADING, balance)
        return steps

    def _continue_load(self, k: int, lower: float, higher: float, balance: Balance) -> int:
        """As `_raise_load`; a step that its cycles do not settle is taken back, and half of it tried.

        Where even small ones do not, the film comes out negative on this mesh: that is for the driver to see. A
        start of a finer grid ends there, under the last load that left its film positive.
        """
        level, load, loading, steps = self.levels[k], lower, CONTINUATION_LOADING, 0
        while load < higher:
            P, u = level.P.copy(), self.u
            raised = min(load * loading, higher)
            if self._settles(k, raised, balance):
                load, steps = raised, steps + 1
            elif loading > LEAST_LOADING:
                level.P[...], self.u, loading = P, u, sqrt(loading)
            else:
                if self.is_start:
                    level.P[...], self.u = P, u
                self._set_load(k, load if self.is_start else higher)
                break
        return steps

    def _settles(self, k: int, M: float, balance: Balance) -> bool:
        """Whether few cycles settle level k under this Moes load; in a start, with a positive film too."""
        level = self.levels[k]
        self._set_load(k, M)
        self._repeat(k, CYCLES_AFTER_LOADING - 1, balance)
        before = level.P.copy()
        self._repeat(k, 1, balance)
        if np.abs(level.P - before).max() > SETTLED_CHANGE:
            return False
        if not self.is_start:
            return True
        level.update_film(self.u)
        return bool(level.H.min() > 0.0)

    def _set_load(self, k: int, M: float) -> None:
        """Moes load on levels 0 to k."""
        if self.levels[0].M != M:
            self.newton.factors = None
        for level in self.levels[: k + 1]:
            level.set_point(replace(self.point, M=M))
        self._enter_supply(k)

    def _enter_supply(self, k: int) -> None:
        """Layer that enters on level k where it is the finest; on the way, under a smaller load, another one.

        The film is thicker there over the dry approach, and would begin further ahead of the contact with the same
        layer over the flooded film: the front begins about where it will be with a layer that is the thinner, as
        the inlet is wider. Where it may lie beyond the border all the same, such films are flooded; that of the
        coarsest level also where the front may lie far ahead, which is not found from a dry contact.
        """
        level = self.levels[k]
        if self.supply is None:
            return
        layer = self.supply(level.Y) * (self.point.M / level.M) ** LAYER_POWER
        wider = max(1.0, self.point.kappa**-WIDER_GAP) if k == 0 else 1.0
        flooded = level.M < self.point.M and level.gap[0, 0] < FITTING * wider * layer.max()
        starts = not flooded and k > 0 and not self.levels[k - 1].inflow.size
        level.set_supply(None if flooded else layer)
        if starts:
            level.empty_inlet(self.u)

    def _repeat(self, k: int, cycles: int, balance: Balance) -> None:
        for _ in range(cycles):
            self.levels[k].update(self.u)
            self.u = self._cycle(k, self.u, balance)
        if cycles and self.levels[k].inflow.size:
            self._settle_front(k, balance)

    def _settle_front(self, k: int, balance: Balance) -> None:
        """Further cycles on level k while the front of the full film still moves by many nodes."""
        level = self.levels[k]
        for _ in range(FRONT_CYCLES):
            full = level.P > 0.0
            level.update(self.u)
            self.u = self._cycle(k, self.u, balance)
            if np.count_nonzero(full != (level.P > 0.0)) <= FRONT_SETTLED * np.count_nonzero(full):
                return

    def settle(self, k: int, u: float, balance: Balance, cycles: int, shift: Array | float = 0.0) -> float:
        """Cycles on level k by itself, from the pressure that it holds and approach `u`; returns the approach.

        `shift` is what lies on its surfaces, shape (ny + 1, nx + 1).
        """
        level = self.levels[k]
        level.rhs[...] = 0.0
        level.film_shift = shift
        if self.supply is not None:
            level.set_supply(self.supply(level.Y))
        level.update(u)
        for _ in range(cycles):
            u = self._cycle(k, u, balance)
            level.update(u)
        return u

    def cycle(self, balance: Balance) -> float:
        """One V cycle on the finest level; returns the largest change of P."""
        before = self.finest.P.copy()
        self.u = self._cycle(len(self.levels) - 1, self.u, balance)
        self.finest.update(self.u)
        return float(np.abs(self.finest.P - before).max())

    def _cycle(self, k: int, u: float, balance: Balance) -> float:
        """One V cycle on level k, from the state of its last `update`; P written, returns u."""
        fine = self.levels[k]
        if k == 0:
            return self.newton.correct(u, balance)
        short = fine.squeeze_dominates
        for sweep in self._sweeps(fine, PRE_SWEEPS, not short):
            sweep()
            r = fine.update(u)
        coarse = self.levels[k - 1]
        along, across = fine.nx // coarse.nx, fine.ny // coarse.ny
        r[fine.P <= 0.0] = 0.0
        transfer.restrict_pressure(fine.P, coarse.P, along, across)
        start = coarse.P.copy()
        # Full approximation: right-hand sides for which the restricted solution has the restricted residual.
        coarse.film_shift = 0.0
        coarse.update_film(u)
        coarse.film_shift = fine.H[::across, ::along] - coarse.H
        coarse.H[...] = fine.H[::across, ::along]
        coarse.rhs[...] = 0.0
        defect = coarse.full_film_residual().copy()
        transfer.full_weighting(r, coarse.rhs, along, across)
        coarse.rhs -= defect
        coarse.restrict_supply(fine)
        shift = balance.weight * (coarse.force() - fine.force())
        u = self._cycle(k - 1, u, balance.shifted(shift))
        transfer.add_correction(coarse.P, start, fine.P, along, across)
        if fine.inflow.size:
            transfer.drain(coarse.P, start, fine.P, along, across, int(np.searchsorted(fine.X, 0.0)))
        for sweep in self._sweeps(fine, POST_SWEEPS, not short or fine is self.finest):
            fine.update(u)
            sweep()
        return u

    def _sweeps(self, level: Level, count: int, flanks: bool) -> Sequence[Callable[[], None]]:
        """Sweeps on a level before or after its coarse correction, the last of them along its `flanks` first."""
        last = level.relax_flanks_first if flanks else level.relax
        # Coarse levels of a long contact see its side lobes on a line or two: more sweeps lead away from there.
        once = is_long(self.point) and level not in self.levels[-REPEATED_LEVELS:]
        return (*(level.relax,) * (count - 1), last) * (1 if once else self.sweep_factor)


def initial_approach(point: MoesPoint) -> float:
    """First guess of the approach, after Venner and Lubrecht (2000), app. (circular contact)."""
    return float(np.clip(1.897 - 1.67 * point.M ** (-1.0 / 9.0) - 0.004 * point.L, -1.0, 0.99))


def _interpolate_solution(coarse: Level, fine: Level) -> None:
    """Bicubic interpolation of the pressure, zero where the coarse grid cavitates on all sides."""
    P = np.concatenate([coarse.P[:0:-1], coarse.P])
    Y = np.concatenate([-coarse.Y[:0:-1], coarse.Y])
    fine.P[...] = np.maximum(scipy.interpolate.RectBivariateSpline(Y, coarse.X, P, s=0)(fine.Y, fine.X), 0.0)
    wet = np.zeros(fine.P.shape, dtype=bool)
    source = coarse.P > 0.0
    along, across = fine.nx // coarse.nx, fine.ny // coarse.ny
    wet[::across, ::along] = source
    if across == 2:
        wet[1::2, ::along] = source[:-1] | source[1:]
    if along == 2:
        wet[:, 1::2] = wet[:, :-1:2] | wet[:, 2::2]
    fine.P[~wet] = 0.0
    fine.P[:, [0, -1]] = 0.0
    fine.P[-1] = 0.0
