"""Iteration of cycles or Newton steps until a film has converged or failed.

Steady films, steps in time and Newton share this loop, so that NaN, stagnation, divergence and negative films are
judged in one place.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import inf, isfinite
from typing import NamedTuple

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.level import Level
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.status import Status

STAGNATION_CYCLES = 6  # the last so many are held against all before them,
STAGNATION_FACTOR = 0.7  # and have to bring the least residual down to this share
DIVERGENCE_FACTOR = 1e3  # times the scale: a residual that large, and growing, does not come back,
# except where oil runs short, with smaller changes of P: a front that moves in a wide gap has one for a cycle.
FRONT_CHANGE = 0.05
# Where changes hardly fall, coarse corrections spoil what too few sweeps have left rough.
SLOW = (
    0.45  # change of the pressure over that of the iteration before, above which, twice, the sweeps are doubled,
)
LARGEST_SWEEP_FACTOR = 4  # up to so many times: what does not fall then is left to the next attempt
LEAST_FACTOR = 0.2  # assumed of what is to come: the first iterations fall faster
BORDER_SLOPE = 0.1  # of the maximum per semi-axis, at inlet and sides
BORDER_PRESSURE = 0.02  # of the maximum, beside the outlet; a film that ends outside the grid is not computed


class StoppingCriteria(NamedTuple):
    """Limits at which an iteration ends."""

    scale: float  # residual by which residuals are measured; fixed by the problem, not by the start
    tol: float  # share of it to be reached
    most: int  # iterations
    balance: float  # largest residual of the balance,
    approach: float  # and changes of u
    force: float = inf  # and of the force in the last iteration
    pressure: float = inf  # largest change of P that is still to come


@dataclass(slots=True)
class IterationHistory:
    """Residuals and changes of an iteration; entry 0 is the start."""

    residuals: list[float] = field(default_factory=list)  # mean |residual| over P > 0
    balance_residuals: list[float] = field(default_factory=list)
    approach_changes: list[float] = field(default_factory=list)  # one per iteration
    pressure_changes: list[float] = field(default_factory=list)  # largest of P, one per iteration

    @property
    def iterations(self) -> int:
        """Number of cycles or steps."""
        return len(self.residuals) - 1

    @property
    def pressure_error(self) -> float:
        """Largest change of P that is still to come: the last one, and all that follow if they go on falling so.

        The residual is a poorer measure: it weighs a node by its Poiseuille coefficient, most where pressure
        matters least.
        """
        return pressure_error(self.pressure_changes)


def pressure_error(changes: Sequence[float]) -> float:
    """Sum of the changes that follow `changes`, as a geometric series of the worse of the last two factors.

    Infinite before any iteration and where they do not fall; a single change stands for itself.
    """
    if len(changes) < 2:
        return changes[0] if changes else inf
    last = changes[-3:]
    factor = max(LEAST_FACTOR, *(b / a if a > 0.0 else 0.0 for a, b in pairwise(last)))
    return changes[-1] * factor / (1.0 - factor) if factor < 1.0 else inf


def falls_slowly(changes: Sequence[float]) -> bool:
    """Whether the last two changes were both more than SLOW times the one before."""
    return len(changes) > 2 and all(b > SLOW * a for a, b in pairwise(changes[-3:]))


def iterate(
    film: Multigrid,
    balance: Balance,
    advance: Callable[[Balance], float],
    goal: StoppingCriteria,
    track: IterationHistory,
    watch: Callable[[int, float], None] | None = None,
) -> Status:
    """Call `advance` until both residuals are below tolerance and approach and force have settled.

    Parameters
    ----------
    film : Multigrid
        Its finest level is up to date.
    balance : Balance
    advance : callable
        `Multigrid.cycle`, or a Newton step; returns the largest change of P.
    goal : StoppingCriteria
    track : IterationHistory
        Empty; filled as it goes, so that an interrupted caller still has it.
    watch : callable, optional
        Called with the number of the iteration and the residual after it, over the scale.
    """
    level = film.finest
    film.sweep_factor = film.least_sweep_factor
    change_of_u = change_of_force = inf
    while True:
        force = level.force()
        track.residuals.append(level.residual_norm())
        track.balance_residuals.append(balance.residual(film.u, force))
        if watch is not None and track.approach_changes:
            watch(track.iterations, track.residuals[-1] / goal.scale)
        settled = change_of_u < goal.approach and change_of_force <= goal.force
        settled = settled and abs(track.balance_residuals[-1]) < goal.balance
        settled = settled and track.pressure_error <= goal.pressure
        if not isfinite(track.balance_residuals[-1]):  # a pressure of NaN has no residual
            return Status.NONFINITE
        status = classify(track.residuals, goal, settled, track.pressure_changes)
        if status is Status.DIVERGED and level.inflow.size and track.pressure_changes[-1] < FRONT_CHANGE:
            status = None
        if status is not None:
            return judge(status, level)
        u = film.u
        track.pressure_changes.append(advance(balance))
        change_of_u, change_of_force = abs(film.u - u), abs(level.force() - force)
        track.approach_changes.append(change_of_u)
        if falls_slowly(track.pressure_changes) and not film.load_continuation:
            film.sweep_factor = min(2 * film.sweep_factor, LARGEST_SWEEP_FACTOR)


def classify(
    residuals: Sequence[float], goal: StoppingCriteria, settled: bool, changes: Sequence[float] = ()
) -> Status | None:
    """Status of an iteration with these residuals, or None to go on.

    `settled`: the other criteria hold; `changes`: those of the pressure, by which stagnation is judged.
    """
    last, cycles = residuals[-1], len(residuals) - 1
    if not isfinite(last):
        return Status.NONFINITE
    if last <= goal.tol * goal.scale and settled:
        return Status.CONVERGED
    if cycles > 0 and last > max(DIVERGENCE_FACTOR * goal.scale, residuals[-2]):  # a poor start may fall slowly
        return Status.DIVERGED
    if cycles >= goal.most:
        return Status.MAX_CYCLES
    if cycles > 2 * STAGNATION_CYCLES:
        judged = changes or residuals
        recent = min(judged[-STAGNATION_CYCLES:])
        if recent > STAGNATION_FACTOR * min(judged[:-STAGNATION_CYCLES]):
            return Status.STAGNATED
    return None


def judge(status: Status, level: Level) -> Status:
    """Status of a solve whose residuals say `status`: converged only with a film, and within the domain."""
    if level.front_beyond_border:  # where nothing settles
        return Status.BEYOND_REGION
    if status is Status.CONVERGED and not level.H.min() > 0.0:
        return Status.STARVED if level.starves else Status.UNRESOLVED
    if status is Status.CONVERGED and touches_border(level):
        return Status.OUT_OF_DOMAIN
    return status


def touches_border(level: Level) -> bool:
    """Whether pressure reaches the border of the domain: at the outlet, or steeply at inlet or sides."""
    P = level.P
    steepness = max(P[:, 1].max() / level.hx, P[-2].max() / level.hy)
    return bool(P[:, -2].max() > BORDER_PRESSURE * P.max() or steepness > BORDER_SLOPE * P.max())
