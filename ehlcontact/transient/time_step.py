"""Time step of a simulation: its default length, its error control, and how closely each step is solved.

Fixed steps. A motion has a step that resolves its own course (`Motion.default_step`), the film one that resolves
its transport (`Motion.film_step`), and a surface feature needs a fraction of the time in which it passes.

Controlled steps. The local error is Milne's estimate: the distance of the step from the quadratic through the
three times before it, times the share that the error constant of BDF2 has in that distance (Hairer, Norsett and
Wanner, Solving Ordinary Differential Equations I, ch. III.5 to III.7, for variable steps). The trapezoidal rule of
the motion has the smaller constant, so the estimate holds for it too. Step lengths follow the PI controller of
Gustafsson (ACM Trans. Math. Softw. 17 (1991) 533).

Tolerance. Where bodies are under a load, film, force and approach are found together by relaxation, until force
and approach change by less than a share of `tol` in a cycle: with `DEFAULT_TOL` by 1e-4 of the static load. That
is much of a small motion: with twenty steps a period of a load that swings by 0.01 of the static one C came out
5 % too small (docs/notes/solver.md). So the default is in proportion to the motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from ehlcontact.transient.bodies import LONGEST_ABRUPT, Motion
from ehlcontact.transient.features import Dent, Surface, TransverseRidge, Waviness
from ehlcontact.transient.record import Array, Entry
from ehlcontact.transient.roughness import Roughness
from ehlcontact.transient.speed import SpeedHistory
from ehlcontact.transient.transient_film import CHANGE_SHARE

# Steps in which a wave of a surface feature passes. Against four times as many, 40 steps leave an error of up to
# 1.2 % in the film along Y = 0 under dents (their radius in ten steps), 1.1 % under a ridge, 0.2 % under waviness;
# 20 steps leave 3, 2 and 0.6 %, and 15 % of the swing of the approach. Measured at (200, 10, 0.5), n = 64 and 128.
STEPS_PER_WAVE = 40
# Of a period of the load; fewer give a note in the result. Damping C against that of 80 steps, at (200, 10, 0.5),
# Omega = 3, n = 64, and at (1000, 10, 1), Omega = 1, n = 192: in 40 steps +0.9 and -0.7 %, in 30 +3.0 and -0.7 %,
# in 25 +4.6 and -1.4 %, in 20 +7.4 and -2.1 %, in 12 +19 and -7 %, in 10 +23 and -10 %, in 5 +26 and -28 %.
FEWEST_STEPS = 25
EQUAL_STEPS = 1e-6  # relative difference up to which steps count as equal; controlled steps differ by more

SAFETY = 0.85
SMALLEST_CUT, LARGEST_GROWTH = 0.2, 2.0  # BDF2 is stable up to steps growing by 1 + sqrt(2)
KEEP = (0.9, 1.2)  # factors within leave the step as it is, and with it the factors of the coarsest grid
FAILED_CUT = 0.25  # after a step whose film was not solved
LONGEST = 16.0  # steps of the motion's own length, so that nothing it does is jumped over
SHORTEST = 1e-4  # of that length, or of T = 1

DEFAULT_TOL = 3e-3  # residual of a step, relative to the central film at rest
USUAL_SIZE = 0.1  # of a motion, which DEFAULT_TOL resolves to a thousandth; smaller motions get a smaller tol
SMALLEST_TOL = 1e-6  # smallest default; smaller motions need a `tol` of their own
COARSE = 3.0  # times the fitting tol, above which a result has a note


def default_fixed_step(
    motion: Motion, surface: Surface | None, mesh: float, speed: SpeedHistory | None = None
) -> float:
    """Default fixed step of a run under this motion, on a grid of this mesh size along X."""
    film = motion.film_step if speed is None else min(motion.film_step, LONGEST_ABRUPT) / max(speed.largest, 1.0)
    faster = 1.0 if speed is None else max(speed.largest, 1.0)
    return min(motion.default_step, film, _feature_step(surface, mesh) / faster)


def _feature_step(surface: Surface | None, mesh: float) -> float:
    """Step over a surface feature: a fraction of its wave, or one node where the wavelength is not known."""
    if surface is None:
        return inf
    if isinstance(surface, Dent | TransverseRidge | Waviness):
        return surface.passing / STEPS_PER_WAVE
    speed = surface.speed if isinstance(surface, Roughness) else 1.0
    return mesh / speed if speed > 0.0 else inf


def coarse_step_note(motion: Motion, T: Array) -> str:
    """Note on fixed steps, between the times `T` of shape (steps + 1,), that are too long; else empty."""
    steps = np.diff(T)
    if not steps.size or np.ptp(steps) > EQUAL_STEPS * steps[0] or steps[0] * FEWEST_STEPS <= motion.load_period:
        return ""
    count = motion.load_period / steps[0]
    enough = round(motion.load_period / motion.default_step)
    return f"the step is coarse: {count:.3g} to a period of the load; for damping take steps_per_period = {enough}"


def default_tol(motion: Motion) -> float:
    """Default tolerance `tol` of a run under this motion."""
    share = round(min(motion.size / USUAL_SIZE, 1.0), 9)  # 0.1 made of a rate and a frequency is 0.1
    return max(DEFAULT_TOL * share, SMALLEST_TOL)


def coarse_tolerance_note(motion: Motion, tol: float) -> str:
    """Note on a `tol` that is too coarse for this motion; else empty."""
    if tol <= COARSE * _fitting_tol(motion):
        return ""
    left = 100.0 * CHANGE_SHARE * tol / motion.size
    return (
        f"tol = {tol:.3g} is coarse for so small a motion: force and approach settle to {left:.2g} % of it in a "
        f"step; before taking stiffness or damping from it give tol = {_fitting_tol(motion):.2g}"
    )


def _fitting_tol(motion: Motion) -> float:
    return DEFAULT_TOL * motion.size / USUAL_SIZE


@dataclass(slots=True)
class StepControl:
    """Step-size controller: the next step, and what its choice depends on."""

    tolerance: float  # local error allowed per step
    step: float  # to be tried next
    last_error: float = 1.0  # of the last accepted step, relative to `tolerance`
    first: int = 0  # number of the entry at which the smooth stretch began

    def accepted(self, dT: float, error: float) -> None:
        """Choose the next step after one of length `dT` and relative error `error` <= 1."""
        error = max(error, 1e-6)
        factor = SAFETY * error ** (-0.7 / 3.0) * self.last_error ** (0.4 / 3.0)
        if not KEEP[0] < factor < KEEP[1]:
            dT *= min(max(factor, SMALLEST_CUT), LARGEST_GROWTH)
        self.step, self.last_error = dT, error

    def refused(self, dT: float, error: float, order: int) -> None:
        """Shorten after a step whose local error, of order dT^order, was too large."""
        self.step = dT * max(SAFETY * error ** (-1.0 / order), SMALLEST_CUT)

    def failed(self, dT: float) -> None:
        """Shorten after a step whose film was not solved."""
        self.step = dT * FAILED_CUT


def longest_step(motion: Motion) -> float:
    """Return the step never exceeded."""
    return LONGEST * motion.default_step


def shortest_step(motion: Motion) -> float:
    """Return the step below which the integration gives up."""
    return SHORTEST * min(motion.default_step, 1.0)


def next_time(T: float, step: float, stops: Sequence[float], shortest: float) -> tuple[float, float]:
    """End and length of the next step: on the next of `stops`, or such that no sliver is left before it."""
    stop = next(s for s in stops if s > T + 0.5 * shortest)
    left = stop - T
    if left <= 1.01 * step:
        return stop, left
    if left < 2.0 * step:
        step = 0.5 * left
    return T + step, step


def local_error(before: Sequence[Entry], entry: Entry, motion: Motion) -> float:
    """Milne's estimate of the local error of `entry`, from the three entries before it."""
    t0, t1, t2 = (e.motion.T for e in before)
    T = entry.motion.T
    h, h1 = T - t2, t2 - t1
    weights = (
        (T - t1) * (T - t2) / ((t0 - t1) * (t0 - t2)),
        (T - t0) * (T - t2) / ((t1 - t0) * (t1 - t2)),
        (T - t0) * (T - t1) / ((t2 - t0) * (t2 - t1)),
    )
    bdf2 = h * (h1 + h) / (h1 + 2.0 * h)
    share = bdf2 / (bdf2 + T - t0)
    predicted = sum(w * _state(e) for w, e in zip(weights, before, strict=True))
    return share * _size(_state(entry) - predicted, entry, motion)


def difference(one: Entry, other: Entry, motion: Motion) -> float:
    """Distance of two results for the same time."""
    return _size(_state(one) - _state(other), other, motion)


def _state(entry: Entry) -> Array:
    """Approach, force, and film along the middle."""
    return np.concatenate(((entry.motion.u, entry.row["force"]), entry.row["h_midplane"]))


def _size(change: Array, entry: Entry, motion: Motion) -> float:
    """Largest change of what the motion leaves free and of the film, whose mean is weighted by pressure."""
    film, pressure = np.abs(change[2:]), entry.row["p_midplane"]
    total = float(pressure.sum())
    mean_film = float(np.vdot(pressure, film)) / total if total > 0.0 else 0.0
    return max(*motion.free(abs(change[0]), abs(change[1])), mean_film)
