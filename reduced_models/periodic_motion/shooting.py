"""`shoot`: a periodic answer of a rotor as the fixed point of a period of its steps."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_integer, require_positive
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.status import Status
from ehlcontact.summary import counted
from reduced_models.periodic_motion.answer import PeriodicAnswer
from reduced_models.periodic_motion.excitation import UNBALANCE, Excitation, name_of
from reduced_models.periodic_motion.krylov import solved
from reduced_models.periodic_motion.step_map import POSITIONS, StepMap
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]

DIFFERENCE = 1e-4  # change along which the derivative is taken, over what the numbers go through
LINEAR = 1e-2  # share of the imbalance that the linear equations of an iteration leave
MORE_PRODUCTS = 40  # of the derivative beside three for every freedom, before films are given up
ROUNDED = 1e-6  # difference after a period that rounding may leave
SHORTEST = 1e-2  # share of Newton's step
CAGE = 1e-9  # by which a cage may miss its pitch; and so many times its period is corrected
CORRECTIONS = 6
MOST_PERIODS, DRIFT = 4, 200  # periods of a sub-harmonic answer that are looked for, and of runs to it
REPEATS = 1e-3  # difference of places after a period, over their range, of a motion that repeats itself


def shoot(
    rotor: Rotor,
    speed_rpm: float,
    excitation: Excitation = UNBALANCE,
    *,
    start: Any = "static",
    periods: int = 1,
    steps: int = 256,
    positions: int = POSITIONS,
    bearing: int | None = 0,
    settle: int = 0,
    tolerance: float = 1e-8,
    most: int = 30,
    rho_inf: float = 0.8,
) -> PeriodicAnswer:
    """Periodic answer of a rotor by shooting: a state that a period of time steps leads back to itself.

    Newton's method on all numbers of the state, balls and films among them, with linear equations solved in Krylov
    spaces of the map's derivative. It finds unstable answers and sub-harmonic ones too. The steps are those of
    `simulate_rotor`, of which the answer has the errors: second order in the length of a step.

    Parameters
    ----------
    rotor : Rotor
    speed_rpm : float
        Of the shaft [rev/min].
    excitation : "unbalance", "passage" or PeriodicForce
    start : PeriodicAnswer, (ndarray, ndarray) or "static"
        Near the answer: another answer, places and velocities at t = 0 of shape (N,) each, or equilibrium.
    periods : int
        Periods of the excitation after which the motion repeats itself.
    steps : int
        Time steps in a period of the excitation.
    positions : int
        Of the cage that stands still, over which bearings are means under unbalance and forces.
    bearing : int, optional
        Of which balls pass, among the ball bearings of the rotor, the others being means; None: of all of them,
        which have one passage frequency then.
    settle : int
        Periods that are run from the start before the search: near a stable answer.
    tolerance : float
        Largest difference of any number between end and start, over what it goes through in the period; where
        rounding is more, as with contact angles, up to 1e-6 is left.
    most : int
        Iterations of Newton's method.
    rho_inf : float
        As of `simulate_rotor`.

    Raises
    ------
    InputError
        What `StepMap` refuses.
    ConvergenceError
        No such answer near the start; the message names what a run from there does. ``result`` is a
        `PeriodicAnswer` of the last period, with status "failed".
    """
    require_integer("settle", settle, "a whole number >= 0", 0)
    require_integer("most", most, "a whole number >= 1", 1)
    require_positive("tolerance", tolerance)
    if isinstance(start, PeriodicAnswer) and start.periods != periods:
        start = repeated(start, periods)
    steps_of = StepMap(
        rotor, speed_rpm, excitation, periods=periods, steps=steps, positions=positions, bearing=bearing,
        start=start, rho_inf=rho_inf,
    )  # fmt: skip
    steps_of.march(steps_of.numbers, settle)
    steps_of.settle(steps_of.numbers)
    for _ in range(CORRECTIONS):
        numbers, error = fixed_point(steps_of, tolerance, most)
        if error > max(tolerance, ROUNDED):
            raise _failure(steps_of, numbers, error)
        steps_of.settle(numbers)
        if steps_of.cage_left <= CAGE:
            break
        steps_of = steps_of.at(rotor, speed_rpm, excitation, steps_of.passage)
    return answer_of(steps_of)


def answer_of(steps_of: StepMap, status: Status = Status.CONVERGED) -> PeriodicAnswer:
    """The period from a map's numbers as an answer."""
    return PeriodicAnswer(
        run=steps_of.result(steps_of.numbers),
        excitation=name_of(steps_of.excitation),
        value=steps_of.speed_rpm,
        periods=steps_of.periods,
        residual=steps_of.residual,
        status=status,
        reservation=steps_of.reservation,
    )


def repeated(answer: PeriodicAnswer, periods: int) -> PeriodicAnswer:
    """An answer of more periods, which repeats one of fewer.

    Raises
    ------
    InputError
        A number of periods that is no multiple.
    """
    many, left = divmod(periods, answer.periods)
    if left:
        raise InputError("periods", periods, f"a multiple of {answer.periods}, of the start")
    run = answer.run
    longer: dict[str, Any] = {
        name: np.concatenate([getattr(run, name)[:-1]] * many + [getattr(run, name)[-1:]])
        for name in ("speed_rpm", "displacement", "velocity", "approach", "rate", "force", "iterations")
    }
    t = np.linspace(0.0, many * answer.period, len(longer["speed_rpm"]))
    return replace(answer, periods=periods, run=replace(run, t=t, **longer))


def fixed_point(steps_of: StepMap, tolerance: float, most: int) -> tuple[_Floats, float]:
    """Numbers near those of a map that it leads back to themselves, by Newton's method.

    Returns
    -------
    numbers : ndarray
    error : float
        Largest difference after a period, over the scale of the map: above `tolerance` where no further step of
        the method makes it smaller, or after `most` of them.
    """
    numbers, scale = steps_of.numbers, steps_of.scale
    after = steps_of(numbers)
    off = (after - numbers) / scale
    products = 3 * steps_of.rotor.size + MORE_PRODUCTS
    for _ in range(most):
        if np.abs(off).max() <= tolerance:
            break
        way = solved(lambda v: steps_of.along(numbers, after, v, DIFFERENCE), off, LINEAR, products)  # noqa: B023
        share, found = 1.0, None
        while found is None and share > SHORTEST:
            found = _tried(steps_of, numbers + share * scale * way, float(np.linalg.norm(off)))
            share *= 0.5
        if found is None:
            break
        numbers, after = found
        off = (after - numbers) / scale
    return numbers, float(np.abs(off).max())


def _tried(steps_of: StepMap, numbers: _Floats, before: float) -> tuple[_Floats, _Floats] | None:
    """These numbers and those after a period, where their difference is smaller than before."""
    try:
        after = steps_of(numbers)
    except ConvergenceError:
        return None
    return (numbers, after) if np.linalg.norm((after - numbers) / steps_of.scale) < before else None


def _failure(steps_of: StepMap, numbers: _Floats, error: float) -> ConvergenceError:
    """The error for a map without a fixed point nearby, with what a run does there."""
    many = "period" if steps_of.periods == 1 else f"{steps_of.periods} periods"
    steps_of.numbers = numbers
    failed = answer_of(steps_of, Status.FAILED)
    words = f"no answer that repeats itself after {many} is near the start: residual {error:.2g}"
    return ConvergenceError(f"{words}; {_drift(steps_of)}", failed)


def _drift(steps_of: StepMap) -> str:
    """What a run from a map's numbers does, in words."""
    n = steps_of.rotor.size
    try:
        steps_of.march(steps_of.numbers, DRIFT)
        run = steps_of.result(steps_of.numbers)
        places = [steps_of.numbers[:n]]
        for _ in range(MOST_PERIODS):
            places.append(steps_of.march(steps_of.numbers, 1)[:n])
    except ConvergenceError as error:
        return f"a run from there ends: {error}"
    size = float(np.ptp(run.displacement, axis=0).max())
    motion = f"a motion of {size:.3g} m peak to peak"
    for many in range(1, MOST_PERIODS + 1):
        if np.abs(places[many] - places[0]).max() <= REPEATS * size:
            after = counted(many * steps_of.periods, "period")
            return f"a run from there comes to {motion} that repeats itself after {after}"
    most = counted(MOST_PERIODS * steps_of.periods, "period")
    return f"a run from there comes to {motion} that does not repeat itself within {most}"
