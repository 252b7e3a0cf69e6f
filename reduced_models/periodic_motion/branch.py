"""Branches of periodic answers over a parameter, by continuation along their arc length.

Arc length s, of unknown harmonics over the vibration at the start and of the parameter over its range, goes on
where the parameter turns back: at a fold. Each step goes along the tangent and then across it, by Newton's method,
to the branch (Seydel, Practical Bifurcation and Stability Analysis, chapter 4).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.status import Status
from reduced_models.periodic_motion.excitation import OVER, Setting
from reduced_models.periodic_motion.harmonic_balance import Balance, HarmonicBalance, solved

_Floats = NDArray[np.float64]

FIRST, SHORTEST = 0.01, 1e-6  # steps of the arc length
LONGEST, LONGEST_SHARE = 0.1, 0.02  # of the vibration and of the range of the parameter, in a step
DRIFT = 0.1  # of the vibration, that a point may be off the tangent: farther off it may be of another branch
LEAST_SIZE = 0.1  # of a vibration, in units of the unknowns
ONE_PERIOD = 0.05  # of its vibration that is sub-harmonic: an answer of several periods shrinks to that of one
WANTED, WANTED_OF_FILMS = 5, 6  # iterations of a step; of supports that remember
MOST_ITERATIONS = 16
STRAIGHT = 0.9  # cosine between neighbouring tangents, at least
KINK = 1e-2  # of the longest step, below which a branch bends as it likes: a ball or a film lets go
CONVERGED, CONVERGED_OF_FILMS = 1e-9, 1e-7  # last step of Newton's method
NUDGE = 1e-7  # of the range of the parameter, over which its derivative is taken
SHARP = 1e-3  # of a step, within which a fold is found: the parameter is flat there


class BranchPoint(NamedTuple):
    """A point of a branch."""

    y: _Floats  # unknowns over their size, then the parameter over its range
    tangent: _Floats
    balance: Balance
    fold: bool = False


@dataclass
class Course:
    """A parameter between two values, and the settings that it makes."""

    setting: Setting
    over: str
    first: float
    last: float

    def at(self, share: float) -> Setting:
        """Setting at a share of the way."""
        return replace(self.setting, **{OVER[self.over]: self.first + share * (self.last - self.first)})


class Continuation:
    """Points of a branch from one of them on.

    Parameters
    ----------
    problem : HarmonicBalance
    course : Course
    start : Balance
        In balance at the first value of the course.
    """

    def __init__(self, problem: HarmonicBalance, course: Course, start: Balance) -> None:
        self._problem, self._course = problem, course
        films = problem.remembers
        self._wanted, self._converged = (WANTED_OF_FILMS, CONVERGED_OF_FILMS) if films else (WANTED, CONVERGED)
        self._size = max(self._vibration(start), LEAST_SIZE)
        along = np.zeros(start.x.size + 1)
        along[-1] = 1.0
        self.points = [self._point(np.append(start.x / self._size, 0.0), along, start)]
        self.status, self.reason = Status.CONVERGED, ""

    def follow(self, most: int, callback: Callable[[float, int], object] | None = None) -> None:
        """Go on until the parameter leaves its range, or for so many points.

        `callback` takes the share of the course and the number of points.
        """
        step = min(FIRST, self._longest(self.points[0]))
        try:
            while len(self.points) < most:
                if self._ended():
                    return
                step = self._advance(self.points[-1], step)
                if callback is not None:
                    callback(float(self.points[-1].y[-1]), len(self.points))
            self.status, self.reason = Status.MAX_CYCLES, f"stopped after {most} answers: raise `most`"
        except KeyboardInterrupt:
            self.status, self.reason = Status.INTERRUPTED, "interrupted: the answers so far are kept"
        except (ConvergenceError, InputError) as error:
            self.status, self.reason = Status.FAILED, f"the branch ends here: {error}"

    def _ended(self) -> bool:
        """Whether the last point is beyond an end of the range, to which it goes back, or periods became one."""
        last = self.points[-1]
        if len(self.points) > 1 and not 0.0 < last.y[-1] < 1.0:
            end = float(last.y[-1] > 0.0)
            balance = self._problem.solve(self._course.at(end), last.balance.x)
            self.points[-1] = last._replace(y=np.append(balance.x / self._size, end), balance=balance)
            if end == 0.0:
                self.reason = "the branch turned back and left the range where it began"
            return True
        folds = [k for k, point in enumerate(self.points) if point.fold]
        if self._problem.periods > 1 and folds and self._subharmonic(self.points[folds[-1]].balance) < ONE_PERIOD:
            fold = self.points[folds[-1]]
            self.points = [*self.points[: folds[-1]], fold._replace(fold=False)]
            self.reason = f"it ends where {self._problem.periods} periods become one, at a period doubling"
            return True
        return False

    def _subharmonic(self, balance: Balance) -> float:
        """Share of a vibration that is not of the period of the excitation."""
        m, periods = len(self._problem.units), self._problem.periods
        rows = balance.x.reshape(-1, m)[1:]
        others = (1 + np.arange(len(rows)) // 2) % periods != 0
        return float(np.linalg.norm(rows[others]) / max(self._vibration(balance), LEAST_SIZE))

    def _advance(self, last: BranchPoint, step: float) -> float:
        """One step, with the folds within it; returns the length of the next."""
        reason = ""
        while step >= SHORTEST:
            ends = self._to_the_end(last, step)
            try:
                point, iterations = self._corrected(last, ends)
            except ConvergenceError as error:
                reason, step = str(error), 0.5 * step
                self._problem.renew(self._course.at(float(last.y[-1])), last.balance)
                continue
            off = float(np.linalg.norm((point.y - last.y - ends * last.tangent)[:-1])) * self._size
            far = off > DRIFT * max(self._vibration(last.balance), LEAST_SIZE)
            if (far or float(point.tangent @ last.tangent) < STRAIGHT) and step > KINK * self._longest(last):
                step = 0.5 * step
                continue
            if len(self.points) > 1 and not last.fold:
                before = self.points[-2]
                if (point.y[-1] - last.y[-1]) * (last.y[-1] - before.y[-1]) < 0.0:
                    self._mark_fold(last, before, point)
            self.points.append(point)
            if iterations > self._wanted:
                self._problem.renew(self._course.at(float(point.y[-1])), point.balance)
            return min(step * float(np.clip(self._wanted / max(iterations, 1), 0.5, 2.0)), self._longest(point))
        raise ConvergenceError(f"steps became too short ({reason or 'the branch bends'})", last.balance)

    def _vibration(self, balance: Balance) -> float:
        """Size of a motion without its mean, in units of the unknowns."""
        return float(np.linalg.norm(balance.x[len(self._problem.units) :]))

    def _longest(self, point: BranchPoint) -> float:
        """Longest step from a point: a share of its vibration, and of the range of the parameter."""
        moved = float(np.linalg.norm(point.tangent[:-1])) * self._size
        shares = (
            (LONGEST * max(self._vibration(point.balance), LEAST_SIZE), moved),
            (LONGEST_SHARE, point.tangent[-1]),
        )
        return float(min(most / max(abs(by), SHORTEST) for most, by in shares))

    def _to_the_end(self, last: BranchPoint, step: float) -> float:
        """The step, or what is left of it to just beyond the end of the range."""
        rise = float(last.tangent[-1])
        left = (1.0 - last.y[-1]) / rise if rise > 0.0 else last.y[-1] / -rise if rise < 0.0 else step
        return min(step, max(left, 0.0) + SHORTEST) if left < step else step

    def _corrected(self, last: BranchPoint, step: float) -> tuple[BranchPoint, int]:
        """The point of the branch on the plane across the tangent at its end, and the iterations."""
        problem, tangent = self._problem, last.tangent
        y = last.y + step * tangent
        balance = problem.balance(self._course.at(float(y[-1])), y[:-1] * self._size)
        for iteration in range(1, MOST_ITERATIONS + 1):
            slopes = problem.slopes(balance)
            system = self._system(balance, slopes, float(y[-1]), tangent)
            across = float(tangent @ (y - last.y)) - step
            change = solved(system, -np.append(balance.residual / self._size, across))
            if np.linalg.norm(change) <= self._converged:
                return self._point(y, tangent, balance), iteration
            if not np.isfinite(change).all() or np.linalg.norm(change) > 10.0 * max(step, FIRST):
                break
            y = y + change
            there = problem.balance(self._course.at(float(y[-1])), y[:-1] * self._size)
            problem.learn(balance, slopes, there)
            balance = there
        raise ConvergenceError("Newton's method found no point of the branch", last.balance)

    def _point(self, y: _Floats, along: _Floats, balance: Balance) -> BranchPoint:
        """A point with the unit tangent there, in the direction of `along`."""
        unit = np.zeros(y.size)
        unit[-1] = 1.0
        tangent = solved(self._system(balance, self._problem.slopes(balance), float(y[-1]), along), unit)
        return BranchPoint(y, np.asarray(tangent / np.linalg.norm(tangent)), balance)

    def _system(self, balance: Balance, slopes: _Floats, share: float, tangent: _Floats) -> _Floats:
        """Derivatives of the residual by unknowns and parameter, and the tangent."""
        n = balance.x.size
        system = np.zeros((n + 1, n + 1))
        system[:n, :n] = self._problem.jacobian(balance, slopes)
        there = self._course.at(share + NUDGE)
        system[:n, n] = self._problem.change(balance, there) / (NUDGE * self._size)
        system[n] = tangent
        return system

    def _mark_fold(self, last: BranchPoint, before: BranchPoint, end: BranchPoint) -> None:
        """A fold near the last point, after `before`: towards `end` the parameter turns back.

        The parameter along the branch about there has its extreme value at the fold; tangents are not asked, for
        those of supports with a memory are not exact.
        """
        low, high = (float(last.tangent @ (point.y - last.y)) for point in (before, end))
        sign = 1.0 if last.y[-1] > before.y[-1] else -1.0
        tried = {0.0: last, low: before, high: end}

        def beyond(step: float) -> float:
            if step not in tried:
                tried[step] = self._corrected(last, step)[0]
            return -sign * float(tried[step].y[-1])

        try:
            if low < 0.0 < high:
                scipy.optimize.minimize_scalar(beyond, (low, 0.0, high), tol=SHARP)
        except ConvergenceError:
            pass  # the largest of those that there are
        step = min(tried, key=beyond)
        fold = tried[step]._replace(fold=True)
        if fold.y is last.y:
            self.points[-1] = fold
        else:
            self.points.insert(len(self.points) - (step < 0.0), fold)
