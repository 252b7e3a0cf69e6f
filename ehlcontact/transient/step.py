"""Error of a time step and the length of the next one.

The local error is Milne's estimate: the distance of the step from the quadratic through the three times before
it, times the share that the error constant of BDF2 has in that distance (Hairer, Norsett and Wanner, Solving
Ordinary Differential Equations I, ch. III.5 to III.7, for variable steps). The trapezoidal rule of the motion has
the smaller constant, so the estimate holds for it too. Step lengths follow the PI controller of Gustafsson (ACM
Trans. Math. Softw. 17 (1991) 533).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.record import Array, Entry

SAFETY = 0.85
SMALLEST_CUT, LARGEST_GROWTH = 0.2, 2.0  # BDF2 is stable up to steps growing by 1 + sqrt(2)
KEEP = (0.9, 1.2)  # factors within leave the step as it is, and with it the factors of the coarsest grid
FAILED_CUT = 0.25  # after a step whose film was not solved
LONGEST = 16.0  # steps of the motion's own length, so that nothing it does is jumped over
SHORTEST = 1e-4  # of that length, or of T = 1


@dataclass(slots=True)
class StepControl:
    """Length of the next step; its fields are the controller's whole memory."""

    error: float  # tolerated local error per step
    step: float  # to be tried next
    last_error: float = 1.0  # of the last accepted step, relative to `error`
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
    return np.concatenate(((entry.motion.u, entry.force), entry.film))


def _size(change: Array, entry: Entry, motion: Motion) -> float:
    """Largest change of what the motion leaves free and of the film, whose mean is weighted by pressure."""
    film = np.abs(change[2:])
    total = float(entry.pressure.sum())
    mean_film = float(np.vdot(entry.pressure, film)) / total if total > 0.0 else 0.0
    return max(*motion.free(abs(change[0]), abs(change[1])), mean_film)
