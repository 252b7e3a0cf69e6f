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
from reduced_models.periodic_motion.krylov import largest
from reduced_models.periodic_motion.shooting import converge
from reduced_models.periodic_motion.step_map import StepMap
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

DIFFERENCE = 3e-4  # of central differences, over what the numbers go through
CLOSE, MOST = 1e-5, 12  # of the answer of steps to which the given one leads; iterations to it
TOLERANCE = 1e-4  # of what the vectors of the multipliers miss
PRODUCTS = 4  # of the derivative, at most, over the number of freedoms; and so many more for films
MORE_PRODUCTS = 24
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
    count: int = 6,
    steps: int = 128,
    forces: NDArray[np.complex128] | None = None,
) -> PeriodicAnswer:
    """The answer with its largest Floquet multipliers, by the derivative of a period of time steps.

    Steps begin with the motion of the answer, which films and balls follow first, and go to their own fixed point,
    of which the multipliers are: those of an answer by harmonic balance have the errors of steps too. Film states,
    balls and losses are in them.

    Parameters
    ----------
    rotor : Rotor
        Whose answer it is.
    answer : PeriodicAnswer
    count : int
        Of the multipliers; fewer where a period forgets all others.
    steps : int
        Time steps in a period of the excitation.
    forces : ndarray, shape (h, N), optional
        As of `shoot`.

    Raises
    ------
    InputError
        What `StepMap` refuses.
    ConvergenceError
        Steps have no such answer.
    """
    require_instance("answer", answer, PeriodicAnswer, "a PeriodicAnswer")
    steps_of = StepMap(
        rotor,
        answer.speed_rpm,
        answer.excitation,
        periods=answer.periods,
        steps=steps,
        forces=forces,
        period=answer.period / answer.periods,
        start=answer,
    )
    converge(steps_of, CLOSE, MOST)
    return replace(answer, multipliers=multipliers_of(steps_of, count))


def multipliers_of(steps_of: StepMap, count: int) -> _Complex:
    """Largest eigenvalues of the derivative of a map at its numbers, a fixed point, the largest first."""
    require_integer("count", count, "a whole number >= 1", 1)
    start, n = np.zeros(steps_of.numbers.size), steps_of.rotor.size
    start[n : 2 * n] = np.random.default_rng(0).standard_normal(n)  # velocities: places would bend stiff shafts
    numbers, most = steps_of.numbers, PRODUCTS * n + MORE_PRODUCTS
    found = largest(lambda v: steps_of.along(numbers, v, DIFFERENCE), start, count, TOLERANCE, most).values
    return found[np.abs(found) > FORGOTTEN * np.abs(found).max(initial=0.0)]


def unstable_kinds(multipliers: _Complex) -> tuple[int, int, int]:
    """How many multipliers are outside the unit circle: beyond +1, beyond -1, and pairs."""
    outside = multipliers[np.abs(multipliers) > 1.0]
    real = np.abs(outside.imag) <= REAL * np.abs(outside)
    above, below = outside[real & (outside.real > 0.0)], outside[real & (outside.real < 0.0)]
    return above.size, below.size, int(np.count_nonzero(~real)) // 2


def bifurcations(answers: Sequence[PeriodicAnswer]) -> tuple[Bifurcation, ...]:
    """Bifurcations between neighbouring answers of a branch that have their multipliers.

    Raises
    ------
    InputError
        An answer without multipliers.
    """
    for k, answer in enumerate(answers):
        if answer.multipliers is None:
            raise InputError(f"answers[{k}].multipliers", None, "computed: with_multipliers")
    values = [answer.value for answer in answers]
    found = []
    for k in range(len(answers) - 1):
        before, after = (answers[i].multipliers for i in (k, k + 1))
        assert before is not None and after is not None
        change = np.subtract(unstable_kinds(after), unstable_kinds(before))
        if abs(change[0]) == 2 and change[2] == -change[0] // 2:  # a pair that comes apart outside the circle
            change[:] = 0, change[1], 0
        for kind, changed in zip((FOLD, DOUBLING, NEIMARK_SACKER), change.tolist(), strict=True):
            if changed:
                turns = kind == FOLD and _turns(values, k)
                name = BRANCH_POINT if kind == FOLD and not turns else kind
                value = _between(values[k : k + 2], before, after, kind)
                if turns:
                    value = _extreme(values, k)
                found.append(Bifurcation(kind=name, over=answers[k].over, value=value, after=k))
    return tuple(found)


def _turns(values: Sequence[float], k: int) -> bool:
    """Whether the parameter turns around between answers k - 1 and k + 2."""
    steps = np.diff(values[max(k - 1, 0) : k + 3])
    return bool(steps.min() < 0.0 < steps.max())


def _extreme(values: Sequence[float], k: int) -> float:
    """The farthest value where the parameter turns around: of the parabola through the three answers around it."""
    first = min(max(k - 1, 0), max(len(values) - 3, 0))
    rises = np.diff(values[first : first + 4])
    turn = first + 1 + int(np.argmax(rises[:-1] * rises[1:] < 0.0)) if rises.size > 1 else k
    a, b, c = values[turn - 1], values[turn], values[turn + 1]
    curved = a - 2.0 * b + c
    return float(b - (c - a) ** 2 / (8.0 * curved)) if curved else float(b)


def _between(values: Sequence[float], before: _Complex, after: _Complex, kind: str) -> float:
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
