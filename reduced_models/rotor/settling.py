"""Steady state of a run: comparison of successive revolutions; runs until it is reached."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import parts, require_integer
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import Line, Panel, Picture
from reduced_models.elements.validity import OutsideValidityWarning
from reduced_models.rotor.decay import STILL
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.simulate import simulate_rotor

_Floats = NDArray[np.float64]

SETTLED = 0.01  # change from one revolution to the next, over a signal's standard deviation, of a settled run
# Where revolutions cost nothing they go on until one is so much like the other.
QUIET = 1e-4
MOST_REVOLUTIONS = 128  # that are given to it
FIRST_REVOLUTIONS = 8  # after which it is looked at first, and again each time their number has doubled


@dataclass(frozen=True)
class Settling:
    """How a run of whole revolutions settled.

    Attributes
    ----------
    changes : tuple of float
        Of each revolution from the one before, from the second on.
    limit : float
        Change up to which a revolution counts as settled.
    """

    changes: tuple[float, ...]
    limit: float

    @property
    def settled_from(self) -> int | None:
        """First revolution, counted from 0, from which on all changes are below the limit; None without one.

        A settled revolution is like the one before it, so that one belongs to the settled part already.
        """
        first = None
        for k in range(len(self.changes) - 1, -1, -1):
            if self.changes[k] > self.limit:
                break
            first = k
        return first

    @property
    def settled(self) -> bool:
        """Whether the run ends settled."""
        return self.settled_from is not None

    @property
    def last_change(self) -> float | None:
        """Change of the last revolution; None where there was only one."""
        return self.changes[-1] if self.changes else None

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Matplotlib figure: changes over the revolutions; into a file too where a path is given.

        Raises
        ------
        InputError
            The file cannot be written.
        """
        turns = 1 + np.arange(len(self.changes))
        lines = [
            Line(turns, self.changes, "change"),
            Line(turns, np.full(turns.size, self.limit), "settled below"),
        ]
        panel = Panel(lines, "revolution", "change over the revolution before", logs="y")
        return draw(Picture([panel], "Settling"), path)

    def to_dict(self) -> dict[str, object]:
        """All of it, ready for JSON."""
        return {
            "changes": list(self.changes),
            "limit": self.limit,
            "settled_from_revolution": self.settled_from,
            "settled": self.settled,
        }


@takes(result=Object(RotorResult, "a RotorResult"), limit=parts.TOLERANCE)
def settling(result: RotorResult, *, limit: float = SETTLED) -> Settling:
    """Compare successive revolutions of a run at constant speed.

    The change of a revolution is the largest, over all displacements and forces,
    of the RMS difference from the revolution before over the standard deviation of the signal in the revolution.

    Parameters
    ----------
    result : RotorResult
        With a whole number of steps in a revolution; what is beyond the last whole revolution is left out.
    limit : float
        Change up to which a revolution counts as settled.

    Raises
    ------
    InputError
        No speed, or no whole number of steps in a revolution.
    """
    steps = steps_per_revolution(result)
    signals = _signals(result)
    changes = []
    for k in range(1, (len(signals) - 1) // steps):
        before, now = (signals[1 + i * steps : 1 + (i + 1) * steps] for i in (k - 1, k))
        spread, size = now.std(axis=0), np.abs(signals).max(axis=0)
        moves = spread > STILL * size
        differ = np.sqrt(np.mean((now - before) ** 2, axis=0))
        changes.append(float((differ[moves] / spread[moves]).max(initial=0.0)))
    return Settling(tuple(changes), limit)


def steps_per_revolution(result: RotorResult) -> int:
    """Number of steps in a revolution.

    Raises
    ------
    InputError
        No speed, a speed that changes, or no whole number.
    """
    speed = float(result.speed_rpm[0])
    if speed == 0.0 or result.t.size < 2 or np.ptp(result.speed_rpm) > 0.0:
        raise InputError("run", f"{result.t.size} times at {speed:g} rpm", "of a turning rotor, at one speed")
    steps = 60.0 / abs(speed) / float(result.t[1] - result.t[0])
    if abs(steps - round(steps)) > 1e-6 * steps:
        raise InputError("steps per revolution", steps, "a whole number")
    return round(steps)


def require_turning(rotor: Rotor) -> float:
    """Speed of a rotor [rev/min]; raises `InputError` where it has none."""
    if not rotor.speed_rpm:
        raise InputError("speed_rpm", rotor.speed_rpm, "> 0: the rotor turns")
    return rotor.speed_rpm


def run_until_settled(
    rotor: Rotor,
    *,
    steps: int,
    revolutions: int,
    start: tuple[_Floats, _Floats],
    tolerance: float = 1e-6,
) -> RotorResult:
    """Let a rotor on elements turn until it has settled, and return its last revolutions, from t = 0 on.

    Parameters
    ----------
    rotor : Rotor
        Turning, on elements in SI; copies of them run, at rest at the start. Whether the run stays in their
        validity box is not reported here: see `contact_events` of the revolutions that are returned.
    steps : int
        In a revolution.
    revolutions : int
        Returned; `settling` has whether they are settled.
    start : (ndarray, ndarray)
        Near the settled motion, as of `LinearRotor.orbit`.
    tolerance : float
        Of `simulate_rotor`.

    Raises
    ------
    InputError, ConvergenceError
        As `simulate_rotor`.
    """
    require_integer("steps", steps, "a whole number >= 8", 8)
    require_integer("revolutions", revolutions, "a whole number >= 1", 1)
    speed = require_turning(rotor)
    contacts = [mount.contact.copy() for mount in rotor.contacts]
    for contact, approach in zip(contacts, rotor.approaches(start[0]).tolist(), strict=True):
        contact.rest(approach)
    rotor, state = rotor.on(contacts), start
    dt = 60.0 / speed / steps
    turns, done = max(FIRST_REVOLUTIONS, revolutions + 1), 0
    while True:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", OutsideValidityWarning)
            run = simulate_rotor(rotor, dt=dt, until=turns * steps * dt, start=state, tolerance=tolerance)
        done += turns
        change = settling(run).last_change
        if done >= MOST_REVOLUTIONS or (change is not None and change <= QUIET):
            return run.part(run.t.size - 1 - revolutions * steps, keep_time=False)
        state, turns = (run.displacement[-1], run.velocity[-1]), max(done, revolutions + 1)


def _signals(result: RotorResult) -> _Floats:
    """Displacements and forces, shape (N, signals)."""
    return np.hstack([result.displacement, result.force])
