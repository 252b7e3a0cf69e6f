"""Floquet multipliers of periodic answers, and the bifurcations between the answers of a branch.

A small disturbance of the state of a rotor, of its balls and films too, is multiplied by a multiplier in every
period (Nayfeh and Balachandran, Applied Nonlinear Dynamics, 1995, ch. 3): an answer is stable where all lie within
the unit circle. A real one that leaves it at +1 is a fold of the branch, one at -1 the beginning of an answer of
twice the period, a pair that of a quasi-periodic motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_instance, require_integer
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary
from reduced_models.periodic_motion.answer import PeriodicAnswer
from reduced_models.periodic_motion.excitation import Excitation, set_to
from reduced_models.periodic_motion.krylov import largest
from reduced_models.periodic_motion.shooting import fixed_point
from reduced_models.periodic_motion.step_map import POSITIONS, StepMap
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

DIFFERENCE = 3e-5  # along which the derivative is taken, over what the numbers go through
CLOSE, MOST = 1e-3, 12  # of the answer of steps to which the given one leads; iterations to it
FAR = 0.2  # of what places and velocities go through: distance at which it is another answer
TOLERANCE = 1e-4  # of what the vectors of the multipliers miss
PRODUCTS = 4  # of the derivative, at most, over the number of freedoms; and so many more for films
MORE_PRODUCTS = 24
NEAR = 5  # answers, within which a multiplier that crosses at +1 belongs to a turn of the branch
FORGOTTEN = 1e-5  # of the largest: noise of differences
REAL = 1e-6  # of its size: imaginary part of a real multiplier

FOLD, BRANCH_POINT, DOUBLING, NEIMARK_SACKER = KINDS = (
    "fold", "branch point", "period doubling", "Neimark-Sacker"
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Bifurcation(Summary):
    """Where a multiplier crosses the unit circle between two answers of a branch.

    Attributes
    ----------
    kind : str
        "fold", "branch point" (+1, the branch going on), "period doubling" (-1), "Neimark-Sacker" (a pair).
    over : str
        Parameter of the branch.
    value : float
        Of the parameter there, between those of the answers; of a fold the farthest of theirs.
    after : int
        Place, in the branch, of the answer before it.
    """

    kind: str
    over: str
    value: float
    after: int

    KINDS: ClassVar[tuple[str, ...]] = KINDS

    def _summary_lines(self) -> list[str]:
        return [f"{self.kind} at {self.over} {self.value:.6g}, between answers {self.after} and {self.after + 1}"]


def with_multipliers(
    rotor: Rotor,
    answer: PeriodicAnswer,
    *,
    excitation: Excitation | None = None,
    count: int = 6,
    steps: int = 128,
    positions: int = POSITIONS,
    bearing: int | None = 0,
) -> PeriodicAnswer:
    """The answer with its largest Floquet multipliers, by the derivative of a period of time steps.

    Steps begin with the motion of the answer, which films and balls follow first, and go to their own fixed point,
    of which the multipliers are: those of an answer by harmonic balance have the errors of steps too. Film states,
    balls and losses are in them. Where steps have no such fixed point, as within their error of a fold,
    multipliers are of the motion of the answer itself, and its reservation has what the steps miss.

    Parameters
    ----------
    rotor : Rotor
        Whose answer it is, without what its branch follows: that is set to the value of the answer.
    answer : PeriodicAnswer
    excitation : PeriodicForce, optional
        Of an answer to a force.
    count : int
        Of the multipliers; fewer where a period forgets all others.
    steps : int
        Time steps in a period of the excitation.
    positions, bearing
        As of `shoot`.

    Raises
    ------
    InputError
        What `StepMap` refuses; an answer to a force without it.
    ConvergenceError
        A step found no balance.
    """
    require_instance("answer", answer, PeriodicAnswer, "a PeriodicAnswer")
    excited = answer.excitation if excitation is None else excitation
    here, speed, excited = set_to(rotor, answer.speed_rpm, excited, answer.over, answer.value)
    steps_of = StepMap(
        here, speed, excited, periods=answer.periods, steps=steps, positions=positions, bearing=bearing,
        period=answer.period / answer.periods, start=answer,
    )  # fmt: skip
    begin, n = steps_of.numbers, 2 * steps_of.rotor.size
    numbers, error = fixed_point(steps_of, CLOSE, MOST)
    far = float(np.abs((numbers - begin)[:n] / steps_of.scale[:n]).max())
    reservation = answer.reservation
    if error > CLOSE or far > FAR:
        error = float(np.abs((steps_of(begin) - begin) / steps_of.scale).max())
        words = f"multipliers are of a motion from which time steps differ by {error:.2g} after a period"
        numbers, reservation = begin, "; ".join(filter(None, [reservation, words]))
    steps_of.begin(numbers)
    return replace(answer, multipliers=multipliers_of(steps_of, count), reservation=reservation)


def multipliers_of(steps_of: StepMap, count: int) -> _Complex:
    """Largest eigenvalues of the derivative of a map at its numbers, a fixed point, the largest first."""
    require_integer("count", count, "a whole number >= 1", 1)
    start, n = np.zeros(steps_of.numbers.size), steps_of.rotor.size
    start[n : 2 * n] = np.random.default_rng(0).standard_normal(n)  # velocities: places would bend stiff shafts
    numbers, most = steps_of.numbers, PRODUCTS * n + MORE_PRODUCTS
    after = steps_of(numbers)
    found = largest(lambda v: steps_of.along(numbers, after, v, DIFFERENCE), start, count, TOLERANCE, most).values
    return found[np.abs(found) > FORGOTTEN * np.abs(found).max(initial=0.0)]


def unstable_kinds(multipliers: _Complex) -> tuple[int, int, int]:
    """How many multipliers are outside the unit circle: beyond +1, beyond -1, and pairs."""
    outside = multipliers[np.abs(multipliers) > 1.0]
    real = np.abs(outside.imag) <= REAL * np.abs(outside)
    above, below = outside[real & (outside.real > 0.0)], outside[real & (outside.real < 0.0)]
    return above.size, below.size, int(np.count_nonzero(~real)) // 2


def bifurcations(answers: Sequence[PeriodicAnswer]) -> tuple[Bifurcation, ...]:
    """Bifurcations between neighbouring answers of a branch, of which multipliers were computed.

    Raises
    ------
    InputError
        An answer without multipliers.
    """
    for k, answer in enumerate(answers):
        if answer.multipliers is None:
            raise InputError(f"answers[{k}].multipliers", None, "computed: with_multipliers")
    values = np.array([answer.value for answer in answers])
    turns = _turns(values)
    found = []
    for k in range(len(answers) - 1):
        before, after = (answers[i].multipliers for i in (k, k + 1))
        assert before is not None and after is not None
        change = np.subtract(unstable_kinds(after), unstable_kinds(before))
        if abs(change[0]) == 2 and change[2] == -change[0] // 2:  # a pair that comes apart outside the circle
            change[:] = 0, change[1], 0
        for kind, changed in zip((FOLD, DOUBLING, NEIMARK_SACKER), change.tolist(), strict=True):
            if not changed:
                continue
            name, value = kind, _between(values[k : k + 2], before, after, kind)
            if kind == FOLD:
                near = [turn for turn in turns if abs(turn - k - 0.5) < NEAR]
                name = FOLD if near else BRANCH_POINT
                value = float(values[near[0]]) if near else value
                turns = [turn for turn in turns if turn not in near[:1]]
            found.append(Bifurcation(kind=name, over=answers[k].over, value=value, after=k))
    return tuple(found)


def _turns(values: _Floats) -> list[int]:
    """Places of the answers where the parameter turns around."""
    rises = np.diff(values)
    return (1 + np.flatnonzero(rises[:-1] * rises[1:] < 0.0)).tolist()


def _between(values: _Floats, before: _Complex, after: _Complex, kind: str) -> float:
    """Value at which a multiplier of this kind crosses the circle, by a straight line of what is 0 there."""
    tests = [_test(multipliers, kind) for multipliers in (before, after)]
    share = tests[0] / (tests[0] - tests[1]) if tests[0] * tests[1] < 0.0 else 0.5
    return float(values[0] + share * (values[1] - values[0]))


def _test(multipliers: _Complex, kind: str) -> float:
    """What changes its sign where a multiplier crosses the circle: at +1, at -1, or as the largest pair."""
    if kind == NEIMARK_SACKER:
        pairs = multipliers[np.abs(multipliers.imag) > REAL * np.abs(multipliers)]
        return float(np.abs(pairs).max(initial=0.0)) - 1.0
    return float(np.prod(1.0 - multipliers if kind == FOLD else 1.0 + multipliers).real)
