"""`PreparedRun`: a rotor and its supports as the arrays that time steps need, and their state at the start."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, shown
from ehlcontact.errors import InputError
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import BallMotion, motion_of, require_short_steps
from reduced_models.rotor.contact_steps import ContactSteps
from reduced_models.rotor.core_rotor import rotor_gain
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.speed_profile import SpeedProfile, shaft_course
from reduced_models.rotor.supports import AXIAL

_Floats = NDArray[np.float64]

LONGEST_BLOCK = 4096  # steps between two looks at Ctrl-C
SPEED_PER_BLOCK = 2e-3  # change of the speed, over the highest, at which gyroscopic forces are renewed
FARTHEST = 0.05  # of a ball diameter, that a ring may go from the middle: no clearance is as large
DISPLACEMENTS = 3  # of the motions of a ring; tilts follow


class Histories(NamedTuple):
    """Histories of a run, from the start (entry 0) on: k entries."""

    displacement: _Floats  # (k, N)
    velocity: _Floats  # (k, N)
    motion: _Floats  # (k, directions of all supports)
    rate: _Floats
    force: _Floats
    evaluations: NDArray[np.int64]  # (k,) of every support in the step

    @classmethod
    def empty(cls, entries: int, size: int, directions: int) -> Self:
        """Room for a run, all zero."""
        d, v = np.zeros((2, entries, size))
        r, rate, force = np.zeros((3, entries, directions))
        return cls(d, v, r, rate, force, np.zeros(entries, np.int64))


class PreparedRun:
    """Arrays of a run of `steps` steps; entry 0 is the start.

    Attributes
    ----------
    t, omega, angle : ndarray, shape (steps + 1,)
        Times [s], speeds of the shaft [rad/s], its angle [rad].
    shift : ndarray, shape (directions of contacts, ball bearings and dampers,)
        Displacement of rings beside that of the rotor [m]; 0 of contacts and dampers.
    turning : ndarray, shape (steps + 1, 2 unbalances)
        Forces of the unbalances [N]; `at`, shape (N, 2 unbalances), is where they act.
    contacts : ContactSteps
        All contacts; they come first among the motions of the supports, and dampers last.
    balls : tuple of BallMotion
        Balls and films of every ball bearing.
    state : ndarray, shape (3, N)
        Displacement, velocity and acceleration at the start.
    histories : Histories
        With its first entry.
    """

    def __init__(
        self, rotor: Rotor, speed_rpm: float | SpeedProfile, dt: float, steps: int, start: Any, rho_inf: float
    ) -> None:
        self.rotor, self.dt, self.steps, self.rho_inf = rotor, dt, steps, rho_inf
        self.t: _Floats = np.asarray(dt * np.arange(steps + 1), np.float64)
        course = shaft_course(rotor, speed_rpm, self.t)
        self.omega, self.angle, self.turning, self.at = course.omega, course.angle, course.turning, course.at
        self._require_short_steps()
        backward = bool(self.omega.min() < 0.0)
        if backward:
            rotor.require_either_way(float(self.omega.min()) / RPM_TO_RAD_S)
        speeds = course.law_speeds.tolist()
        self.balls: tuple[BallMotion, ...] = tuple(
            motion_of(mount.ball_bearing, speeds, mount.directions, backward=backward)
            for mount in rotor.ball_bearings
        )
        mounts = (*rotor.ball_bearings, *rotor.film_dampers)
        shifts = [np.zeros(len(rotor.contacts)), *(mount.shift for mount in mounts)]
        self.shift = np.concatenate(shifts)
        self.histories = Histories.empty(steps + 1, rotor.size, len(rotor.geometry.normals))
        self.contacts = ContactSteps(rotor.contacts, dt, rotor_gain(dt, rho_inf))
        self.state = self._begin(start)

    @property
    def ball_directions(self) -> tuple[slice, ...]:
        """Places of every ball bearing among the motions of all supports."""
        return self.rotor.ball_columns

    @property
    def compiled(self) -> bool:
        """Whether all supports that are not linear are in C."""
        return bool(self.balls or self.rotor.film_dampers) and not self.rotor.contacts

    @property
    def farthest(self) -> float:
        """How far a ring may go from the middle of its bearing [m]."""
        balls = (mount.ball_bearing.ball_diameter for mount in self.rotor.ball_bearings)
        return FARTHEST * min(balls, default=inf)

    def lost(self, first: int, end: int) -> tuple[int, str] | None:
        """The first step after `first`, up to `end`, at whose end a ring has left its bearing, and that in words.

        A ring of an angular contact bearing must not go against its facing beyond the plane in which both grooves
        face each other: its balls would be pressed on the side that has no shoulder.
        """
        found = []
        rotor = self.rotor
        rows = zip(rotor.ball_bearings, rotor.ball_bearing_names, self.ball_directions, self.balls, strict=True)
        for mount, name, at, one in rows:
            place = (self.histories.motion[first + 1 : end + 1, at] + self.shift[at])[:, :DISPLACEMENTS]
            far, against = (np.abs(place) > self.farthest).any(axis=1), np.zeros(len(place), bool)
            if mount.ball_bearing.contact_angle is not None:
                against = place[:, AXIAL] < -one.balls.grooves.axial
            for k in np.flatnonzero(far | against)[:1].tolist():
                how = f", {1e3 * float(np.linalg.norm(place[k])):.3g} mm from the middle"
                if against[k]:
                    back = -1e3 * float(place[k, AXIAL])
                    how = f"s balls, {back:.3g} mm against its facing, where none carries it"
                found.append((first + 1 + k, f"the ring of {name} has left it{how}"))
        return min(found, default=None)

    def blocks(self) -> Iterator[tuple[int, int, float]]:
        """Steps made before and after each block, and the speed [rad/s] in its middle, of its matrices."""
        first = 0
        while first < self.steps:
            end = min(first + LONGEST_BLOCK, self.steps)
            if self.rotor.changes_with_speed:
                change = np.abs(self.omega[first : end + 1] - self.omega[first])
                off = change > SPEED_PER_BLOCK * np.abs(self.omega).max()
                end = first + max(int(np.argmax(off)), 1) if off.any() else end
            yield first, end, float(0.5 * (self.omega[first] + self.omega[end]))
            first = end

    def applied(self, step: int) -> _Floats:
        """Forces on the freedoms at the end of a step but for those of supports, shape (N,) [N]."""
        return self.rotor.load + self.at @ self.turning[step]

    def _begin(self, start: Any) -> _Floats:
        """State and supports at the start, and the first entries of the histories."""
        rotor, geometry = self.rotor, self.rotor.geometry
        d, v = self._start(start)
        r, rate = geometry.normals @ (geometry.points @ d), geometry.normals @ (geometry.points @ v)
        force, first = np.zeros(len(r)), len(rotor.contacts)
        if isinstance(start, str):
            for place, approach in zip(rotor.contacts, r.tolist(), strict=False):
                place.contact.rest(approach + place.offset)
        force[:first] = self.contacts.start(r[:first], rate[:first])
        for mount, at, balls in zip(rotor.ball_bearings, self.ball_directions, self.balls, strict=True):
            force[at] = balls.rest(self.omega[0], mount.cage_angle, r[at] + self.shift[at])
        for mount, at in zip(rotor.film_dampers, rotor.film_damper_columns, strict=True):
            force[at] = mount.damper.forces(r[at], rate[at]).force
        M, C, K = rotor.matrices(self.omega[0])
        carried = geometry.points.T @ (geometry.normals.T @ (geometry.counts * force))
        net = self.applied(0) - carried
        a = np.linalg.solve(M, net - C @ v - K @ d)
        for history, value in zip(self.histories, (d, v, r, rate, force), strict=False):
            history[0] = value
        return np.array([d, v, a])

    def _start(self, start: Any) -> tuple[_Floats, _Floats]:
        size = self.rotor.size
        if isinstance(start, str):
            if start != "static":
                raise InputError("start", start, "'static', or displacements and velocities")
            speed = abs(float(self.omega[0] / RPM_TO_RAD_S))
            return (self.rotor.equilibrium(speed) if speed else self.rotor.dry.equilibrium()), np.zeros(size)
        try:
            d, v = start
        except (TypeError, ValueError):
            raise InputError("start", shown(start), "'static', or displacements and velocities") from None
        return np.array(as_column("displacements", d, size=size)), np.array(as_column("velocities", v, size=size))

    def _require_short_steps(self) -> None:
        fastest = float(np.abs(self.omega).max())
        for mount in self.rotor.ball_bearings:
            require_short_steps(mount.ball_bearing, fastest / RPM_TO_RAD_S, self.dt)
