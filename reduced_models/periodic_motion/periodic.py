"""`periodic` and `periodic_answer`: answers of a rotor that repeat themselves, by harmonic balance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import (
    parts,
    require_choice,
    require_finite,
    require_instance,
    require_integer,
    require_positive,
    shown,
)
from ehlcontact.checks.kinds import Callback, Count, Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError, InputError, warn_user
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.status import Status
from reduced_models.periodic_motion.answer import PeriodicAnswer
from reduced_models.periodic_motion.branch import BranchPoint, Continuation, Course
from reduced_models.periodic_motion.branch_result import PeriodicBranch
from reduced_models.periodic_motion.excitation import (
    OVER,
    PASSAGE,
    UNBALANCE,
    Excitation,
    PeriodicForce,
    Setting,
    require_excitation,
)
from reduced_models.periodic_motion.floquet import with_multipliers
from reduced_models.periodic_motion.harmonic_balance import Balance, HarmonicBalance
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.simulate import simulate_rotor

_Floats = NDArray[np.float64]

HARMONICS, SAMPLES, POSITIONS = 12, 256, 4
LEAST_SAMPLES = 4  # of a period over the highest harmonic
MOST, MOST_TO_BEGIN = 1000, 100  # answers of a branch, and on the way to the first one
LARGEST_PLAY = 1e-3  # m, of clearance and preload
SAME_FOLD = 1e-4  # of the range of the parameter, between folds
TOO_FEW = 1e-2  # residual from which more harmonics are needed
HARMONIC_COUNT = Count(1, 200)
SETTLED = 60  # periods of a run, after which Newton's method begins where an answer is far from rest


class TooFewHarmonicsWarning(UserWarning):
    """Harmonics beyond those kept move the rotor too."""


@takes(
    rotor=Object(Rotor, "a Rotor"), speed_rpm=parts.SPEEDS, harmonics=HARMONIC_COUNT, samples=Count(16, 100_000),
    positions=Count(1, 48), periods=Count(1, 16), bearing=Count(0, 100),
)  # fmt: skip
@one_blas_thread()
def periodic_answer(
    rotor: Rotor,
    speed_rpm: float | None = None,
    *,
    excitation: Excitation = UNBALANCE,
    start: PeriodicAnswer | None = None,
    amplitude: float = 1.0,
    harmonics: int = HARMONICS,
    samples: int = SAMPLES,
    positions: int = POSITIONS,
    periods: int = 1,
    bearing: int = 0,
) -> PeriodicAnswer:
    """The answer of a rotor that repeats itself, at one speed, by harmonic balance.

    Films are in the periodic state of the motion. Ball passage and unbalance have no common period: an answer to
    unbalance, or to a force, has bearings as means over positions of a cage that stands still; one to the passage
    of balls leaves unbalances out.

    Parameters
    ----------
    rotor : Rotor
        On ball bearings, elements and linear bearings.
    speed_rpm : float, optional
        Of the shaft [rev/min]; by default that of the rotor.
    excitation : "unbalance", "passage" or PeriodicForce
    start : PeriodicAnswer, optional
        Near which the answer is looked for, where there are several; by default static equilibrium.
    amplitude : float
        Factor of all unbalances, or of the force.
    harmonics, samples : int
        Harmonics kept, and samples of a period.
    positions : int
        Of the cage, over which bearings are means.
    periods : int
        Periods of the excitation after which the answer repeats itself: 2 or more of a sub-harmonic one.
    bearing : int
        Of which balls pass, among the ball bearings of the rotor; the others are means.

    Returns
    -------
    PeriodicAnswer

    Raises
    ------
    InputError
        What does not excite the rotor; a contact without tangents; bearings with features.
    ConvergenceError
        No answer of that period near the start; ``result`` is the last motion that was tried.
    """
    speed = _speed(rotor, speed_rpm)
    options = _options(harmonics, samples, positions, periods, bearing)
    problem = _problem(rotor, excitation, (speed, speed), options)
    setting = Setting(speed, amplitude=require_finite("amplitude", amplitude))
    return _answer(problem, setting, _begin(problem, setting, start), "speed")


@takes(
    rotor=Object(Rotor, "a Rotor"), harmonics=HARMONIC_COUNT, samples=Count(16, 100_000), positions=Count(1, 48),
    periods=Count(1, 16), bearing=Count(0, 100), most=Count(2, 100_000), callback=Callback("share, answers"),
    speed_rpm=parts.SPEEDS,
)  # fmt: skip
@one_blas_thread()
def periodic(
    rotor: Rotor,
    over: str = "speed",
    *,
    between: tuple[float, float],
    excitation: Excitation = UNBALANCE,
    speed_rpm: float | None = None,
    start: PeriodicAnswer | None = None,
    amplitude: float = 1.0,
    harmonics: int = HARMONICS,
    samples: int = SAMPLES,
    positions: int = POSITIONS,
    periods: int = 1,
    bearing: int = 0,
    most: int = MOST,
    callback: Callable[[float, int], object] | None = None,
) -> PeriodicBranch:
    """Periodic answers over a parameter, followed along their branch through its folds.

    Parameters
    ----------
    rotor, excitation, start, amplitude, harmonics, samples, positions, periods, bearing
        As of `periodic_answer`; `start` at the first value.
    over : {"speed", "amplitude", "clearance", "preload", "frequency"}
        Speed [rev/min]; factor of unbalances or force; clearance [m] of all ball bearings; offset [m] of all
        mounts; frequency of a force [Hz].
    between : (float, float)
        First and last value of that parameter; the branch ends where it leaves this range.
    speed_rpm : float, optional
        Of the shaft, unless it is the parameter.
    most : int
        Answers at most.
    callback : callable, optional
        Called as ``callback(share, answers)`` after every answer: share of the range, and number of answers.

    Returns
    -------
    PeriodicBranch
        With what there is until then after Ctrl-C, or where the branch leaves the atlas.

    Raises
    ------
    InputError
        As of `periodic_answer`; a parameter that the rotor or the excitation does not have.
    ConvergenceError
        No answer at the first value.
    """
    first, last = _between(between)
    _require_over(over, rotor, excitation)
    if over in ("clearance", "preload") and max(abs(first), abs(last)) > LARGEST_PLAY:
        value = f"({first:g}, {last:g})"
        raise InputError("between", value, f"at most {LARGEST_PLAY:g} m in magnitude (given in um?)")
    speed = max(abs(first), abs(last)) if over == "speed" else _speed(rotor, speed_rpm)
    ends = (first, last) if over == "speed" else (speed, speed)
    for end in ends:
        require_positive("between" if over == "speed" else "speed_rpm", end)
    problem = _problem(
        rotor, excitation, (min(ends), max(ends)), _options(harmonics, samples, positions, periods, bearing)
    )
    course = Course(Setting(speed, amplitude=require_finite("amplitude", amplitude)), over, first, last)
    continuation = Continuation(problem, course, _begin(problem, course.at(0.0), start))
    continuation.follow(most, callback)
    points = continuation.points
    answers = tuple(problem.answer(course.at(float(p.y[-1])), p.balance, over) for p in points)
    _warn_of_few_harmonics(max(answers, key=lambda answer: answer.residual))

    def solve(near: PeriodicAnswer, value: float) -> PeriodicAnswer:
        setting = replace(course.at(0.0), **{OVER[over]: value})
        return _answer(problem, setting, _balance_near(problem, setting, near), over)

    def measure(answer: PeriodicAnswer, count: int, steps: int) -> PeriodicAnswer:
        return with_multipliers(
            rotor, answer, excitation=excitation, count=count, steps=steps, positions=positions, bearing=bearing
        )

    return PeriodicBranch(
        answers=answers,
        folds=_folds(points),
        over=over,
        status=continuation.status,
        reservation=continuation.reason,
        solve=solve,
        measure=measure,
    )


def _folds(points: Sequence[BranchPoint]) -> tuple[int, ...]:
    """Places of the folds; two within the error of the answers are none."""
    kept: list[int] = []
    for k, point in enumerate(points):
        if point.fold:
            if kept and abs(point.y[-1] - points[kept[-1]].y[-1]) < SAME_FOLD:
                kept.pop()
            else:
                kept.append(k)
    return tuple(kept)


def _speed(rotor: Rotor, speed_rpm: float | None) -> float:
    speed = rotor.speed_rpm if speed_rpm is None else speed_rpm
    if speed is None:
        raise InputError("speed_rpm", None, "given: that of the shaft")
    return require_positive("speed_rpm", speed)


def _between(between: Any) -> tuple[float, float]:
    try:
        first, last = (require_finite("between", value) for value in between)
    except (TypeError, ValueError):
        raise InputError("between", shown(between), "two numbers: first and last value") from None
    if first == last:
        raise InputError("between", f"({first:g}, {last:g})", "two different values")
    return first, last


def _require_over(over: str, rotor: Rotor, excitation: Excitation) -> None:
    require_choice("over", over, tuple(OVER))
    if over == "frequency" and not isinstance(excitation, PeriodicForce):
        raise InputError("over", over, "the frequency of a PeriodicForce")
    if over == "amplitude" and excitation == "passage":
        raise InputError("over", over, "the amplitude of unbalances or of a PeriodicForce")
    if over in ("clearance", "preload") and not rotor.ball_bearings:
        raise InputError("over", over, "of a rotor on ball bearings")
    if over == "clearance" and any(m.ball_bearing.contact_angle is not None for m in rotor.ball_bearings):
        raise InputError("over", over, "of bearings without contact angle; these have preload")
    if over == "preload" and any(mount.z is None for mount in rotor.ball_bearings):
        raise InputError("over", over, "of bearings with five degrees of freedom")


def _options(harmonics: int, samples: int, positions: int, periods: int, bearing: int) -> dict[str, int]:
    least = LEAST_SAMPLES * harmonics
    if require_integer("samples", samples, "a whole number", 16) < least:
        raise InputError("samples", samples, f"at least {least}, {LEAST_SAMPLES} times the harmonics")
    return {
        "harmonics": harmonics, "samples": samples, "positions": positions, "periods": periods, "bearing": bearing,
    }  # fmt: skip


def _problem(
    rotor: Rotor, excitation: Excitation, speeds: tuple[float, float], options: dict[str, int]
) -> HarmonicBalance:
    require_excitation(excitation, rotor)
    if excitation == "passage" and options["bearing"] >= len(rotor.ball_bearings):
        last = len(rotor.ball_bearings) - 1
        raise InputError("bearing", options["bearing"], f"from 0 to {last}, of the ball bearings of the rotor")
    return HarmonicBalance(rotor, excitation, speeds, **options)


def _begin(problem: HarmonicBalance, setting: Setting, start: PeriodicAnswer | None) -> Balance:
    """Balance near another answer, or from static equilibrium: at once, else as the excitation grows."""
    if start is not None:
        require_instance("start", start, PeriodicAnswer, "a PeriodicAnswer")
        if start.run.displacement.shape[1] != problem.rotor.size:
            raise InputError("start", shown(start), f"of a rotor with {problem.rotor.size} degrees of freedom")
        return _balance_near(problem, setting, start)
    rest = np.zeros((problem.harmonics + 1, len(problem.units)), complex)
    rest[0] = problem.rows @ problem.rotor.equilibrium(setting.speed_rpm)
    x = problem.unknowns(rest)
    try:
        return problem.solve(setting, x)
    except ConvergenceError as error:
        if problem.excitation == PASSAGE:
            return problem.solve(setting, _settled(problem, setting))
        grows = Course(setting, "amplitude", 0.0, setting.amplitude)
        continuation = Continuation(problem, grows, problem.solve(grows.at(0.0), x))
        continuation.follow(MOST_TO_BEGIN)
        if continuation.status is Status.INTERRUPTED:
            raise KeyboardInterrupt from None
        last = continuation.points[-1]
        if last.y[-1] < 1.0:
            share = f"at {100.0 * float(last.y[-1]):.3g} % of the excitation {continuation.reason}"
            advice = "begin near an answer of another speed, or of `shoot`, with start="
            raise ConvergenceError(f"{error}; {share}; {advice}", last.balance) from error
        return problem.solve(setting, last.balance.x)


def _settled(problem: HarmonicBalance, setting: Setting) -> _Floats:
    """Unknowns of the last period of a run."""
    period, n = problem.period(setting), problem.samples
    run = simulate_rotor(problem.rotor, speed_rpm=setting.speed_rpm, dt=period / n, until=SETTLED * period)
    spectrum = np.fft.rfft(run.displacement[-n:], axis=0)[: problem.harmonics + 1] / n
    spectrum[1:] *= 2.0
    return problem.unknowns(spectrum @ problem.rows.T)


def _balance_near(problem: HarmonicBalance, setting: Setting, near: PeriodicAnswer) -> Balance:
    spectrum, each = near.harmonics @ problem.rows.T, max(problem.periods // near.periods, 1)
    r = np.zeros((problem.harmonics + 1, spectrum.shape[1]), complex)
    kept = spectrum[: problem.harmonics // each + 1]
    r[: each * len(kept) : each] = kept
    return problem.solve(setting, problem.unknowns(r))


def _answer(problem: HarmonicBalance, setting: Setting, at: Balance, over: str) -> PeriodicAnswer:
    answer = problem.answer(setting, at, over)
    _warn_of_few_harmonics(answer)
    return answer


def _warn_of_few_harmonics(answer: PeriodicAnswer) -> None:
    if answer.residual > TOO_FEW:
        left_out = f"harmonics that are left out move the rotor by {answer.residual:.2g} of those kept"
        warn_user(f"{left_out}: take more harmonics", TooFewHarmonicsWarning)
