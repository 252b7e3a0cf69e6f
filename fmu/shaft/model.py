"""What the FMU of a shaft is made from: a rotor in its modes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.checks import as_column, require_instance, require_nonnegative, require_positive
from ehlcontact.errors import InputError
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import motion_of
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.supports import BearingMount

_Floats = NDArray[np.float64]

MOST_MODES = 100  # of the tables, which have two square matrices
MOST_INPUTS = 64  # of the core: one bit for each
ROUNDING = 1e-9  # of the largest entry: asymmetry of a stiffness; stiffness of a mode that is none
SPEED_LIMITED = "constant, without speeds_rpm: matrices of the shaft's FMU do not change with the speed"


class Modes(NamedTuple):
    """A rotor in its undamped modes at standstill, r of them, each of mass 1."""

    shapes: _Floats  # (N, r)
    stiffness: _Floats  # (r,) [1/s2]
    damping: _Floats  # (r, r) [1/s]
    gyroscopic: _Floats  # (r, r), for 1 rad/s
    load: _Floats  # (r,)


@dataclass(frozen=True, eq=False)
class ShaftModel:
    """A rotor whose ball bearings are outside.

    Parameters
    ----------
    rotor : Rotor
        Its ball bearings become ports of the FMU, in their order, each in the frame of its mount; linear bearings
        stay inside.
    speed_rpm : float
        At which it starts, at rest under its load on its bearings.
    inertia : float, optional
        Polar moment of inertia [kg m2] of all that turns: torques of the motor and of the bearings then decide on
        the speed. By default the speed is an input.
    start : (array_like, array_like), optional
        Displacements and velocities to start from, shape (N,) each.

    Raises
    ------
    InputError
        Contacts as supports, no ball bearing, a linear bearing whose matrices depend on the speed, a stiffness
        that is not symmetric, too many degrees of freedom.
    """

    rotor: Rotor
    speed_rpm: float = 0.0
    inertia: float | None = None
    start: Any = None

    def __post_init__(self) -> None:
        require_instance("rotor", self.rotor, Rotor, "a Rotor")
        require_nonnegative("speed_rpm", self.speed_rpm)
        if self.inertia is not None:
            require_positive("inertia", self.inertia)
        if self.rotor.contacts:
            raise InputError("rotor.mounts", "contacts", "ball bearings, and linear ones")
        if not self.stations:
            raise InputError("rotor.mounts", "no ball bearing", "one at least")
        for mount in self.rotor.bearings:
            if isinstance(mount.bearing, LinearBearing) and mount.bearing.speeds_rpm is not None:
                raise InputError("bearing", mount.bearing.name or "a table over the speed", SPEED_LIMITED)
        if self.rotor.size > MOST_MODES:
            raise InputError("degrees of freedom", self.rotor.size, f"at most {MOST_MODES}: reduce the rotor")
        inputs = sum(len(mount.directions) + 1 for mount in self.stations) + len(self.rotor.unbalances) + 1
        if inputs > MOST_INPUTS:
            raise InputError("inputs", inputs, f"at most {MOST_INPUTS}: forces of bearings, unbalances, torques")
        _, _, K = self.rotor.matrices(0.0)
        if np.abs(K - K.T).max() > ROUNDING * np.abs(K).max():
            raise InputError("stiffness", "one that is not symmetric", "symmetric, of a rotor that has modes")
        _ = self.motion

    @property
    def stations(self) -> tuple[BearingMount, ...]:
        """Ball bearings, one port each."""
        return self.rotor.ball_bearings

    @cached_property
    def modes(self) -> Modes:
        """All modes of the rotor."""
        M, C, K = self.rotor.matrices(0.0)
        stiffness, shapes = scipy.linalg.eigh(0.5 * (K + K.T), 0.5 * (M + M.T))
        stiffness[np.abs(stiffness) < ROUNDING * np.abs(stiffness).max()] = 0.0
        return Modes(
            shapes,
            stiffness,
            shapes.T @ C @ shapes,
            shapes.T @ self.rotor.gyroscopic @ shapes,
            shapes.T @ self.rotor.load,
        )

    @cached_property
    def motion(self) -> tuple[_Floats, _Floats]:
        """Displacements and velocities at the start, shape (N,) each."""
        if self.start is None:
            return self.rotor.equilibrium(self.speed_rpm), np.zeros(self.rotor.size)
        try:
            q, v = self.start
        except (TypeError, ValueError):
            raise InputError("start", type(self.start).__name__, "displacements and velocities") from None
        size = self.rotor.size
        return as_column("displacements", q, size=size), as_column("velocities", v, size=size)

    @cached_property
    def forces(self) -> tuple[_Floats, ...]:
        """Of each bearing at rest at the start on the inner ring, in the frame of its mount [N], [N m]."""
        q, _ = self.motion
        found = []
        for mount in self.stations:
            balls = motion_of(mount.ball_bearing, [self.speed_rpm], mount.directions)
            ring = mount.rows(self.rotor.size) @ q + mount.shift
            found.append(-balls.rest(self.speed_rpm * RPM_TO_RAD_S, mount.cage_angle, ring))
        return tuple(found)

    @cached_property
    def rows(self) -> _Floats:
        """Motions of the rings, then those of named nodes, from the displacements of the rotor."""
        size = self.rotor.size
        return np.vstack(
            [
                *(mount.rows(size) for mount in self.stations),
                *(np.eye(size)[[place]] for _, _, place in self.points),
            ]
        )

    @property
    def shifts(self) -> _Floats:
        """What is added to motions of `rows`: offsets of the rings [m]."""
        return np.concatenate([*(mount.shift for mount in self.stations), np.zeros(len(self.points))])

    @property
    def points(self) -> tuple[tuple[str, str, int], ...]:
        """Node, direction and degree of freedom of all named nodes."""
        return tuple((node, name, place) for node, at in self.rotor.nodes.items() for name, place in at.items())
