"""Time integration: implicit second-order steps of Reynolds equation, film and equation of motion, by multigrid.

The squeeze term is differenced backwards over two steps (BDF2, variable step); the motion follows Newmark's
rule with beta = 1/4, gamma = 1/2, evaluated inside the multigrid cycle through its `Balance`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import accumulate
from math import nan, prod
from typing import Any, TypeVar

import numpy as np

from ehlcontact.conditions import FLOODED, Conditions
from ehlcontact.errors import ConvergenceError
from ehlcontact.point import MoesPoint, Scales
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.coarse_newton import Factors
from ehlcontact.solver.effects import CyclesWithEffects
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.solver.error_grids import estimate_error
from ehlcontact.solver.followed_viscosity import FollowedViscosity
from ehlcontact.solver.iterate import IterationHistory, StoppingCriteria, iterate
from ehlcontact.solver.level import Array, Level
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid, Supply
from ehlcontact.status import Status
from ehlcontact.transient.carried_oil import CarriedOil
from ehlcontact.transient.effects_over_time import effects_over_time
from ehlcontact.transient.features import SurfaceStep
from ehlcontact.transient.heat_over_time import HeatState

Quantity = TypeVar("Quantity", float, Array)

STEP_CYCLES = 25
CHANGE_SHARE = 1.0 / 30.0  # of the tolerance, for changes of u and force: they are means over the field
SMALLEST_SCALE = 0.01  # of the residuals, in dry approaches
PAST = 3  # states before the present one, whose polynomial predicts the next step
FEWER_PAST = 2  # such states where inertia predicts the approach better, or features move by a node a step
LARGEST_EXTRAPOLATION = 2.0  # step ratio up to which past pressures predict the next
NEGLIGIBLE_FORCE = 0.01  # below which it does not matter what the border cuts off, unless a load is to be carried


@dataclass(frozen=True, slots=True)
class FilmState:
    """State of a transient film between steps; immutable, so saving it costs one copy of the pressure."""

    P: Array
    past: tuple[tuple[float, Array], ...]  # step that followed, and pressure, latest first
    mass: Array  # rho H, or the oil in the cells where it runs short
    mass_before: Array
    u: float
    dT: float  # the step that led here
    surface: Array | float
    factors: Factors | None  # of the coarsest grid; immutable, so the reference is enough
    past_u: tuple[float, ...]  # approach at the same times as the pressures of `past`
    turned: bool = False  # the surfaces roll back: fields are those seen from the other side
    effects: tuple[HeatState | None, ...] = ()  # states of the effects
    speed: float = 1.0  # at the end of the step that led here
    beyond: CarriedOil | None = None  # where oil runs short and surfaces turn back
    heating: Array | None = None  # of a viscosity that follows effects, as of `Flow.heat`
    aside: Array | None = None  # ln of that along over that across


@dataclass(frozen=True, slots=True)
class Step:
    """Outcome of one time step."""

    residual: float  # mean |residual| over P > 0, relative to the central film at rest
    load_residual: float
    cycles: int
    status: Status


class TransientFilm:
    """A film that can be advanced in time, starting from a steady state at rest.

    Parameters
    ----------
    point : MoesPoint
    mesh : Mesh
    tol : float
        Residual at which a step counts as solved, relative to the central film at rest: the size of the
        transport term d(rho H)/dX.
    deflection : {"fft", "mlmi", "direct"}
        Engine, as in `solve_steady`.
    threads : int
        As there.
    supply : callable, optional
        Layer of oil that enters at the lines Y, in dry approaches; by default the inlet is flooded.
    conditions : Conditions
        With effects that follow from the film, and the data of the oil; the supply is an argument of its own.
    scales : Scales, optional
        Of the point, which effects take.

    Attributes
    ----------
    effects : list of EffectOverTime
    temperature : FilmTemperature or None
        Of the film at rest, with heat.
    """

    def __init__(
        self,
        point: MoesPoint,
        mesh: Mesh,
        tol: float,
        deflection: str = "fft",
        threads: int = 1,
        supply: Supply | None = None,
        conditions: Conditions = FLOODED,
        scales: Scales | None = None,
    ) -> None:
        self.multigrid = Multigrid(point, mesh, deflection=deflection, threads=threads, supply=supply)
        self.effects = effects_over_time(conditions, self.multigrid, scales)
        self.temperature: FilmTemperature | None = None
        self.tol = tol
        self.scale = 1.0
        self._past: tuple[tuple[float, Array], ...] = ()
        self._past_u: tuple[float, ...] = ()
        self._mass = self.level.P.copy()
        self._mass_before = self._mass.copy()
        self._dT = 0.0
        self.turned = False
        self.keeps_oil = False  # beyond both ends, for surfaces that turn back; set before `start_steady`
        self._speed = self._next_speed = 1.0
        self._beyond: CarriedOil | None = None

    @classmethod
    def under(
        cls,
        conditions: Conditions,
        point: MoesPoint,
        scales: Scales | None,
        mesh: Mesh,
        tol: float,
        deflection: str,
        threads: int,
    ) -> TransientFilm:
        """Film under conditions, with the data of the oil.

        Raises
        ------
        ConvergenceError
            The flooded film, which the supply is given over, was not solved.
        """
        supply = conditions.supply
        following: dict[str, Any] = {"conditions": conditions, "scales": scales}
        if supply is None:
            return cls(point, mesh, tol, deflection, threads, **following)
        flooded = nan
        if supply.needs_flooded:
            film = cls(point, mesh, tol, deflection, threads)
            step = film.start_steady(Balance.of_load())
            if not step.status.ok:
                raise ConvergenceError(f"flooded film {step.status}: {step.status.advice}", step)
            flooded = film.level.central_film()
        lines = supply.lines(point, scales, flooded)
        return cls(point, mesh, tol, deflection, threads, lines, **following)

    @property
    def level(self) -> Level:
        """Finest level, holding P and H."""
        return self.multigrid.finest

    @property
    def u(self) -> float:
        """Mutual approach."""
        return self.multigrid.u

    @property
    def midplane(self) -> tuple[Array, Array]:
        """Film and pressure along Y = 0, (nx + 1,) each."""
        return self._seen(self.level.H)[0].copy(), self._seen(self.level.P)[0].copy()

    @property
    def fields(self) -> tuple[Array, Array]:
        """Film and pressure, (nx + 1, ny + 1) each."""
        return self._seen(self.level.H).T.copy(), self._seen(self.level.P).T.copy()

    def _seen(self, field: Array) -> Array:
        return field[:, ::-1] if self.turned else field

    def set_speed(self, speed: float) -> None:
        """Let the surfaces move at `speed`, over that of the operating point; the next steps are at it.

        Where it turns back, the fields are turned round, for the equations look upstream to the left.
        """
        if speed != 0.0 and (speed < 0.0) != self.turned:
            self.turned = not self.turned
            self._mass, self._mass_before = self._mass[:, ::-1].copy(), self._mass_before[:, ::-1].copy()
            self._past = tuple((dT, P[:, ::-1].copy()) for dT, P in self._past)
            self.level.P[...] = self.level.P[:, ::-1].copy()
            self.level.film_shift = _turned(self.level.film_shift)
            self.level.update_film(self.u)
            self.multigrid.newton.factors = None
            if self.effects:
                self.multigrid.set_heat(self.level.fields.flow.heat[:, ::-1].copy())
            for effect in self.effects:
                effect.turn()
        self._next_speed = speed
        for level in self.multigrid.levels:
            level.set_speed(abs(speed))
        for effect in self.effects:
            effect.set_speed(self.level.speed)

    def start_steady(self, balance: Balance, u: float | None = None, surface: Array | float = 0.0) -> Step:
        """Solve the steady film over a resting `surface` and make it the state for all T <= 0."""
        mg = self.multigrid
        if self.turned:
            surface = _turned(surface)
        mg.set_time_coefficient(0.0)
        if u is not None:
            mg.u = u
        if self.effects:
            mg.set_heat(np.zeros_like(self.level.P))
        for effect in self.effects:
            effect.rest()
        mg.full_multigrid(balance)
        self.level.film_shift = surface
        self.level.excess[...] = 0.0
        self.level.update_film(mg.u)
        # full multigrid may still overlap in the centre
        self.scale = max(self.level.central_film(), SMALLEST_SCALE)
        step = self._solve(balance, 2 * STEP_CYCLES)
        cycles = self._following()
        if cycles is not None and step.status.ok:
            cold = self.level.central_film()
            cycles.start(balance)
            self.level.film_shift = surface
            step = self._solve(balance, 2 * STEP_CYCLES, cycles.step)
            for effect in self.effects:
                self.temperature = effect.start(self.turned, cold) or self.temperature
        self._mass = self.level.oil.copy()
        self._mass_before = self._mass
        self.forget_past()
        self._speed = self._next_speed
        if self.level.inflow.size and self.keeps_oil:
            self._beyond = CarriedOil.at_rest(self.level.inflow, self.level.leaving(), self.turned)
        return step

    def error_at_rest(self, balance: Balance) -> ErrorEstimate | None:
        """Error of the film that `start_steady` left under this balance; None where there is no coarser grid.

        The levels below the finest are written, and nothing that steps go on from.
        """
        newton = self.multigrid.newton
        factors = newton.factors  # those of the film, which a state of it keeps
        with np.errstate(over="ignore", invalid="ignore"):  # of a coarse film that runs away: off by anything
            error = estimate_error(self.multigrid, balance)
        newton.factors = factors
        return error

    def forget_past(self) -> None:
        """Begin anew from here, as after rest: what moves the film is about to change its slope."""
        self._past, self._past_u = (), ()
        self._dT = 0.0

    @property
    def last_step(self) -> float:
        """Length of the step that led here; 0 from rest."""
        return self._dT

    def advance(self, dT: float, balance: Balance, u_guess: float, surface: SurfaceStep | None = None) -> Step:
        """One step of length dT, closed by `balance`; the state moves to the end of the step.

        `surface` holds the features on the surfaces, over this step and the one of length `last_step` before.
        """
        level, mg = self.level, self.multigrid
        if surface is not None and self.turned:
            surface = SurfaceStep(*(one[:, ::-1] for one in surface))
        # From rest or a corner the past is not smooth: the first step is backward Euler, the limit ratio = 0.
        ratio = dT / self._dT if self._dT > 0.0 else 0.0
        mg.set_time_coefficient((1.0 + 2.0 * ratio) / (1.0 + ratio) / dT)
        level.rhs[...] = _known(dT, ratio, self._mass, self._mass_before)
        level.film_shift = 0.0 if surface is None else surface.height
        way, source = 0.0, None
        if self._beyond is not None:
            way = self._beyond.way + 0.5 * dT * (self._speed + self._next_speed)
            level.set_supply(self._beyond.entering(way, self.turned))
        P_now, u_now = level.P.copy(), mg.u
        mg.u = u_guess
        if self._past and ratio <= LARGEST_EXTRAPOLATION:
            inert = balance.stiffness > 0.0 and balance.weight > 0.0
            count = FEWER_PAST if inert or surface is not None else PAST
            steps, pressures = zip(*self._past[:count], strict=True)
            level.P[...] = np.maximum(extrapolate(dT, P_now, steps, pressures), 0.0)
            level.P[P_now <= 0.0] = 0.0
            if balance.stiffness == 0.0 and self._past_u:
                # A load does not say where it leads. The polynomial of P gives that of the film: it hardly moves.
                mg.u = extrapolate(dT, u_now, steps, self._past_u[:count])
        if surface is not None:
            # A feature much deeper than the film is carried exactly: the differences would leave a multiple of
            # its fourth derivative as a source, which eats up the film at its rim.
            known = _known(dT, ratio, surface.at_start, surface.at_previous_start)
            if level.inflow.size:
                level.carry_exactly(surface.height, known, surface.rate)
            else:
                source = level.density() * (level.transport(surface.height, known) - surface.rate)
                level.rhs -= source
        for effect in self.effects:
            moved = 0.5 * dT * (self._speed + self._next_speed)
            effect.begin(dT, partial(_known, dT, ratio), moved, self.turned, source)
        cycles = self._following()
        if cycles is None:
            step = self._solve(balance, STEP_CYCLES)
        else:
            level.update(mg.u)
            cycles.follow()
            step = self._solve(balance, STEP_CYCLES, cycles.step)
        for effect in self.effects:
            effect.end(self.keeps_oil)
        self._past = ((dT, P_now), *self._past)[:PAST]
        self._past_u = (u_now, *self._past_u)[:PAST]
        self._mass_before, self._mass = self._mass, level.oil.copy()
        self._dT, self._speed = dT, self._next_speed
        if self._beyond is not None:
            self._beyond = self._beyond.moved(way, self.turned, level.leaving())
        return step

    def _following(self) -> CyclesWithEffects | None:
        """Cycles after which the viscosity follows what changes it; None where nothing does."""
        if not self.effects:
            return None
        viscosity = FollowedViscosity(self.multigrid, self.effects)
        return CyclesWithEffects(self.multigrid, [viscosity], self.multigrid.cycle)

    def _solve(self, balance: Balance, most: int, advance: Callable[[Balance], float] | None = None) -> Step:
        """Cycle until the residual, the balance and the last changes of u and force are below tolerance."""
        mg, level = self.multigrid, self.level
        small = CHANGE_SHARE * self.tol
        goal = StoppingCriteria(
            self.scale, self.tol, most, 0.1 * small * max(1.0, balance.stiffness), small, small
        )
        track = IterationHistory()
        level.update(mg.u)
        status = iterate(mg, balance, advance or mg.cycle, goal, track)
        if status is Status.OUT_OF_DOMAIN and balance.stiffness > 0.0 and level.force() < NEGLIGIBLE_FORCE:
            status = Status.CONVERGED  # bodies that come back after a separation squeeze a film beyond any domain
        return Step(track.residuals[-1] / self.scale, track.balance_residuals[-1], track.iterations, status)

    def save_state(self) -> FilmState:
        """Everything needed to come back here."""
        # mass arrays are replaced, never written, by advance: no copy needed
        return FilmState(
            P=self.level.P.copy(),
            past=self._past,
            mass=self._mass,
            mass_before=self._mass_before,
            u=self.u,
            dT=self._dT,
            surface=self.level.film_shift,
            factors=self.multigrid.newton.factors,
            past_u=self._past_u,
            turned=self.turned,
            effects=tuple(effect.saved for effect in self.effects),
            speed=self._speed,
            beyond=self._beyond,
            heating=self.level.fields.flow.heat.copy() if self.effects else None,
            aside=self.multigrid.aside,
        )

    def restore_state(self, state: FilmState) -> None:
        """Return to a saved state."""
        self.level.P[...] = state.P
        self._past, self._past_u = state.past, state.past_u
        self._mass, self._mass_before = state.mass, state.mass_before
        self.multigrid.u, self._dT, self.turned = state.u, state.dT, state.turned
        self._speed, self._beyond = state.speed, state.beyond
        self.level.film_shift = state.surface
        self.multigrid.newton.factors = state.factors
        for effect, saved in zip(self.effects, state.effects, strict=True):
            effect.restore(saved)
        if state.heating is not None:
            self.multigrid.set_heat(state.heating)
        if state.aside is not None:
            self.multigrid.set_aside(state.aside)
        self.level.update_film(state.u)


def _turned(height: Array | float) -> Array | float:
    """A surface seen from the other side."""
    return height[:, ::-1].copy() if isinstance(height, np.ndarray) else height


def _known(dT: float, ratio: float, now: Array, before: Array) -> Array:
    """Part of the backward difference in time that is known at the beginning of the step."""
    return before * (ratio * ratio / (1.0 + ratio) / dT) - now * ((1.0 + ratio) / dT)


def extrapolate(dT: float, now: Quantity, steps: Sequence[float], past: Sequence[Quantity]) -> Quantity:
    """Value `dT` ahead: polynomial through `now` and `past`, latest first, each with the step from it."""
    times = [0.0, *accumulate(-step for step in steps[: len(past)])]
    weights = [prod((dT - t) / (time - t) for t in times if t != time) for time in times]
    ahead = weights[0] * now
    for weight, value in zip(weights[1:], past, strict=True):
        ahead = ahead + weight * value
    return ahead
