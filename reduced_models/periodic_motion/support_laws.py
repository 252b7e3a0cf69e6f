"""Forces of the supports of a rotor along a motion that repeats itself, with their slopes.

A support is driven through the samples of a period, and a part of the one before, lap after lap until its forces
repeat: films forget within a few contact transits. Filters of the losses of rings and fits are slower, but linear:
one lap tells where they end.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from copy import deepcopy
from math import pi
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import shown
from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.bearing.equilibrium import angle_of
from reduced_models.bearing.motion import BallMotion, motion_of
from reduced_models.elements.validity import OutsideValidityWarning
from reduced_models.rotor.contact_protocol import TangentContact, has_tangents
from reduced_models.rotor.squeeze_film_damper import SqueezeFilmDamper
from reduced_models.rotor.supports import BearingMount, ContactMount

_Floats = NDArray[np.float64]

MOST_LAPS = 60
REPEATS = 1e-9  # of the largest force, within which two laps are the same
AHEAD = 4  # a lap begins with a part of the one before it, a fourth: films forget sooner


class Along(NamedTuple):
    """Forces at N samples of a period, n directions, and their slopes by places and velocities."""

    force: _Floats  # (N, n)
    stiffness: _Floats  # (N, n, n)
    damping: _Floats  # (N, n, n)


class SupportLaw(Protocol):
    """A support along a periodic motion.

    `remembers` says whether its forces depend on more than the sample that they are at and the one before.
    """

    remembers: bool

    def along(self, omega: float, dt: float, q: _Floats, v: _Floats) -> Along:
        """Forces in the periodic state of a motion with samples `q`, `v`, shape (N, n), at dt, ... N dt."""


class BallLaw:
    """A ball bearing: its cage turns on, or stands still at several positions over which forces are means.

    Parameters
    ----------
    mount : BearingMount
    speeds_rpm : sequence of float
        At which tables of the races are made.
    positions : int
        Of the cage that stands still; 0: it turns.
    """

    def __init__(self, mount: BearingMount, speeds_rpm: Sequence[float], positions: int) -> None:
        bearing = mount.ball_bearing
        if bearing.features:
            raise InputError(
                "features", len(bearing.features), "left out: periodic answers are of smooth bearings"
            )
        self.mount, self.pitch = mount, 2.0 * pi / bearing.balls
        first, count = angle_of(mount.cage_angle), max(positions, 1)
        self._angles = [first + self.pitch * k / count for k in range(count)]
        self._turns = positions == 0
        self._motions = [motion_of(bearing, list(speeds_rpm), mount.directions) for _ in self._angles]
        for motion in self._motions:
            motion.core.structure.cage_held = not self._turns
        self.remembers = bearing.oil is not None or bearing.loss_factor > 0.0 or bearing.ball_inertia
        self._nominal = bearing.clearance
        self.clearance: float | None = None  # another one than that of the bearing
        self.cage = (
            bearing.frequencies(1.0).bpfo * 60.0 / bearing.balls
        )  # its speed over that of the shaft, in the last lap

    def along(self, omega: float, dt: float, q: _Floats, v: _Floats) -> Along:
        """Means over the positions of the cage."""
        rows = [self._of(k, omega, dt, q, v) for k in range(len(self._motions))]
        return Along(*(sum(parts) / len(rows) for parts in zip(*rows, strict=True)))

    def largest(self, omega: float, dt: float, q: _Floats, v: _Floats) -> _Floats:
        """Largest force of a ball on the inner and the outer race over the period where `along` was last, (2,)."""
        loads = [motion.drive(omega, dt, q, v)[1] for motion in self._motions]
        return np.asarray(np.max(loads, axis=(0, 1, 2)))

    def _of(self, k: int, omega: float, dt: float, q: _Floats, v: _Floats) -> Along:
        motion, angle, samples = self._motions[k], self._angles[k], len(q)
        head, seat = motion.core.head(motion.state), motion.core.seat(motion.state)
        if self.clearance is not None:
            head["settings"]["clearance"] = self.clearance - self._nominal
        ahead = samples // AHEAD if self.remembers else 0  # a part of the lap before, for the films
        first = angle - self.pitch * self._turns * ahead / samples
        self._require(motion.rest(omega, first, q[-1 - ahead]), q[-1])
        motion.tangents(omega, dt, q[samples - ahead :], v[samples - ahead :])
        for lap in range(MOST_LAPS):
            # a passage later every ball is where the next one was
            head["angle"] = begin = angle + lap * self.pitch * self._turns
            bare, held = seat[1].copy(), seat[2:].copy()  # force without losses, filters of the losses
            force, stiffness, damping = motion.tangents(omega, dt, q, v)
            self._require(force, q[-1])
            self.cage = (motion.angle - begin) / (omega * dt * samples) if self._turns else 0.0
            if not self.remembers or np.abs(seat[1] - bare).max() <= REPEATS * np.abs(force).max():
                return Along(force + _seated(motion, held, dt, samples), stiffness, damping)
        raise ConvergenceError(f"films of a bearing do not repeat themselves within {MOST_LAPS} periods", None)

    @staticmethod
    def _require(force: _Floats, q: _Floats) -> None:
        if not np.isfinite(force).all():
            raise ConvergenceError(f"a ball finds no balance with the ring near {q.tolist()} m", None)


def _seated(motion: BallMotion, held: _Floats, dt: float, samples: int) -> _Floats:
    """Force beside that of a lap whose filters of losses began at `held`, had they begun as they end.

    They are linear: from z a lap leads to left z + what it adds, and z tells at every step what it left.
    """
    loss = motion.balls.loss
    if not loss.rates.size:
        return np.zeros((samples, held.shape[1]))
    left = np.exp(-loss.rates * dt * samples)[:, None]
    ends = motion.core.seat(motion.state)[2:]
    change = (ends - left * held) / (1.0 - left) - held
    ends += left * change
    fading = np.exp(-np.outer(np.arange(1, samples + 1) * dt, loss.rates))
    return np.asarray(-(fading * loss.gains) @ change)


class DamperLaw:
    """A squeeze film damper."""

    remembers = False

    def __init__(self, mount: BearingMount) -> None:
        assert isinstance(mount.bearing, SqueezeFilmDamper)
        self._damper = mount.bearing

    def along(self, omega: float, dt: float, q: _Floats, v: _Floats) -> Along:
        """Forces of the film and the spring; it must stay within its clearance."""
        most = float(self._damper.eccentricity(q).max())
        if most >= 1.0:
            raise ConvergenceError(f"a squeeze film damper touches: its eccentricity reaches {most:.3g}", None)
        return Along(*self._damper.forces(q, v))


class ContactLaw:
    """A contact with tangents, such as an element."""

    def __init__(self, mount: ContactMount) -> None:
        if not has_tangents(mount.contact):
            allowed = "elements: harmonic balance needs the tangents of a contact"
            raise InputError("contacts", shown(mount.contact), allowed)
        self._contact: TangentContact = deepcopy(mount.contact)  # that of the rotor stays where it is
        self._offset, self.remembers = mount.offset, mount.contact.save_state() is not None

    def along(self, omega: float, dt: float, q: _Floats, v: _Floats) -> Along:
        """Forces lap by lap, until they repeat themselves."""
        contact, approach, rate = self._contact, (q[:, 0] + self._offset).tolist(), v[:, 0].tolist()
        contact.rest(approach[-1])
        rows = np.zeros((len(q), 3))
        for _ in range(MOST_LAPS):
            last = rows[:, 0].copy()
            with warnings.catch_warnings():  # the motion is tried; the answer warns
                warnings.simplefilter("ignore", OutsideValidityWarning)
                for k, (u, du) in enumerate(zip(approach, rate, strict=True)):
                    rows[k] = contact.step_tangents(dt, u, du)
                    contact.advance(dt, u, du)
            if np.abs(rows[:, 0] - last).max() <= REPEATS * np.abs(rows[:, 0]).max():
                return Along(rows[:, :1], rows[:, 1:2, None], rows[:, 2:, None])
        raise ConvergenceError(f"a contact does not repeat itself within {MOST_LAPS} periods", None)
