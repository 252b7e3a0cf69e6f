"""Supports of a rotor: one radial contact at a position around the shaft, a ball bearing, a bearing as K and C.

A support takes the motion of its degrees of freedom, one number for each of its directions (the approach of a
contact; x and y of an inner ring against the outer one), and gives as many forces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import cos, pi, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, as_numbers, require_finite, require_instance, require_integer
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import InputError
from ehlcontact.point import Point, moes_point
from ehlcontact.summary import Summary
from reduced_models.bearing.ball_bearing import BallBearing

_Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LinearBearing(Summary):
    """A bearing given by its stiffness and damping, constant or tabulated over the speed of the shaft.

    Parameters
    ----------
    stiffness, damping : array_like, shape (2, 2) or (k, 2, 2)
        In the order x, y [N/m], [N s/m].
    speeds_rpm : array_like, shape (k,), optional
        Increasing speeds [rev/min] of a table: straight lines between them, its ends beyond them.
    name : str

    Raises
    ------
    InputError
        Matrices that are not 2 by 2, or not one for each speed.
    """

    stiffness: Any
    damping: Any
    speeds_rpm: Any = None
    name: str = ""

    def __post_init__(self) -> None:
        speeds = None if self.speeds_rpm is None else as_column("speeds_rpm", self.speeds_rpm, increasing=True)
        shape = (2, 2) if speeds is None else (speeds.size, 2, 2)
        object.__setattr__(self, "speeds_rpm", speeds)
        for name in ("stiffness", "damping"):
            matrices = as_numbers(name, getattr(self, name))
            if matrices.shape != shape or not np.isfinite(matrices).all():
                raise InputError(name, getattr(self, name), f"finite, of shape {shape}")
            matrices.setflags(write=False)
            object.__setattr__(self, name, matrices)

    def _summary_lines(self) -> list[str]:
        table = "constant" if self.speeds_rpm is None else f"at {self.speeds_rpm.size} speeds"
        return [f"{self.name or 'linear bearing'}, stiffness and damping {table}"]

    def at(self, speed_rpm: float | _Floats) -> tuple[_Floats, _Floats]:
        """Stiffness [N/m] and damping [N s/m] at speeds [rev/min], shape (2, 2) or one for each."""
        if self.speeds_rpm is None:
            return self.stiffness, self.damping
        K, C = (
            np.stack([np.interp(speed_rpm, self.speeds_rpm, entries) for entries in table.reshape(-1, 4).T], -1)
            for table in (self.stiffness, self.damping)
        )
        return K.reshape(*np.shape(speed_rpm), 2, 2), C.reshape(*np.shape(speed_rpm), 2, 2)


@fields_take(cage_angle="rad")
@dataclass(frozen=True, kw_only=True)
class BearingMount(Summary):
    """A bearing between two degrees of freedom of the shaft and the ground, or those of a housing.

    Parameters
    ----------
    bearing : BallBearing or LinearBearing
    x, y : int
        Degrees of freedom of the shaft.
    housing : (int, int), optional
        Those of the housing, which the outer ring moves with.
    cage_angle : float
        Of the first ball at the start [rad].
    """

    bearing: BallBearing | LinearBearing
    x: int
    y: int
    housing: tuple[int, int] | None = None
    cage_angle: float = -pi / 2.0

    def _summary_lines(self) -> list[str]:
        on = "the ground" if self.housing is None else f"a housing at {self.housing[0]}, {self.housing[1]}"
        return [f"{self.bearing.name or 'ball bearing'} at degrees of freedom {self.x}, {self.y}, on {on}"]

    def __post_init__(self) -> None:
        require_bearing("bearing", self.bearing)
        if abs(require_finite("cage_angle", self.cage_angle)) > 2.0 * pi:
            raise InputError("cage_angle", self.cage_angle, "between -2 pi and 2 pi; angles are in radians")

    @property
    def ball_bearing(self) -> BallBearing:
        """The bearing, where it has balls."""
        assert isinstance(self.bearing, BallBearing)
        return self.bearing

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of its directions."""
        return ("x", "y")

    @property
    def ends(self) -> tuple[tuple[int | None, ...], ...]:
        """Degrees of freedom, x before y, of the shaft and of the housing where there is one."""
        return ((self.x, self.y),) if self.housing is None else ((self.x, self.y), self.housing)

    def rows(self, size: int) -> _Floats:
        """Inner ring against the outer one from the displacements of the rotor, shape (2, size)."""
        rows = np.zeros((2, size))
        rows[0, self.x] = rows[1, self.y] = 1.0
        if self.housing is not None:
            rows[0, self.housing[0]] -= 1.0
            rows[1, self.housing[1]] -= 1.0
        return rows


@fields_take(angle="rad", offset="m")
@dataclass(frozen=True, slots=True)
class ContactMount:
    """Where a contact sits: approach = n . q + offset, n = (cos angle, sin angle), q that of the shaft.

    Parameters
    ----------
    angle : float
        Direction from the centre of the shaft to the contact [rad]; -pi/2 is below.
    offset : float
        Approach with the shaft at the origin [m].
    point : OperatingPoint or MoesPoint, optional
        The contact that sits there: an element made for another speed, oil or shape then warns.
    contact : Contact or callable, optional
        In SI: an element, a full film in a `ScaledContact`, or for linear responses an impedance alone. A
        `JeffcottRotor` takes its contacts where it is run.
    x, y : int, optional
        Degrees of freedom of the shaft there; None where it does not move.
    count : int
        How many such contacts push there.

    Raises
    ------
    InputError
        Not finite, an angle beyond one turn (given in degrees?), or no operating point.
    """

    angle: float
    offset: float = 0.0
    point: Point | None = None
    contact: Any = None
    x: int | None = None
    y: int | None = None
    count: int = 1

    def __post_init__(self) -> None:
        if self.point is not None:
            moes_point(self.point)
        if abs(require_finite("angle", self.angle)) > 2.0 * pi:
            raise InputError("angle", self.angle, "between -2 pi and 2 pi; angles are in radians")
        require_finite("offset", self.offset)
        require_integer("count", self.count, "a whole number >= 1", 1)

    @property
    def normal(self) -> _Floats:
        """Unit vector from the shaft to the contact, shape (2,)."""
        return np.array([cos(self.angle), sin(self.angle)])

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of its directions: one, along the normal."""
        return ("",)

    @property
    def ends(self) -> tuple[tuple[int | None, ...], ...]:
        """Degrees of freedom, x before y, of the shaft."""
        return ((self.x, self.y),)

    def rows(self, size: int) -> _Floats:
        """Approach, but for the offset, from the displacements of the rotor, shape (1, size)."""
        rows = np.zeros((1, size))
        for at, share in zip((self.x, self.y), self.normal.tolist(), strict=True):
            if at is not None:
                rows[0, at] = share
        return rows


Mount = BearingMount | ContactMount


def support_rows(mounts: Sequence[Mount], size: int) -> _Floats:
    """Motions of all supports from the displacements of a rotor, shape (directions of all supports, size)."""
    return np.concatenate([mount.rows(size) for mount in mounts])


def support_columns(mounts: Sequence[Mount]) -> tuple[slice, ...]:
    """Where the directions of each support are among those of all."""
    ends = np.cumsum([0, *(len(mount.directions) for mount in mounts)]).tolist()
    return tuple(slice(first, end) for first, end in pairwise(ends))


def require_bearing(name: str, bearing: object) -> None:
    """Raise `InputError` for what is no bearing of a shaft."""
    if not isinstance(bearing, LinearBearing):
        require_instance(name, bearing, BallBearing, "a BallBearing")


def is_ball_bearing(mount: Mount) -> bool:
    """Whether the support is a ball bearing."""
    return isinstance(mount, BearingMount) and isinstance(mount.bearing, BallBearing)


class SupportGeometry(NamedTuple):
    """Where supports act: N degrees of freedom, n points, m motions of supports."""

    points: _Floats  # (n, N) displacements of the points at which supports act
    normals: _Floats  # (m, n) motions of the supports from the displacements of the points
    counts: _Floats  # (m,) how often each force acts


def support_geometry(
    contacts: Sequence[ContactMount], bearings: Sequence[BearingMount], size: int
) -> SupportGeometry:
    """Points of contacts, then of ball bearings, on a rotor of `size` degrees of freedom."""
    places = list(dict.fromkeys(place for mount in contacts for place in mount.ends[0] if place is not None))
    points = np.concatenate([np.eye(size)[places], *(mount.rows(size) for mount in bearings)])
    normals = np.zeros((len(contacts) + 2 * len(bearings), len(points)))
    for k, mount in enumerate(contacts):
        normals[k, : len(places)] = mount.rows(size)[0, places]
    normals[len(contacts) :, len(places) :] = np.eye(2 * len(bearings))
    counts = np.array([mount.count for mount in contacts] + [1.0] * 2 * len(bearings))
    ranks = [0 if k == 0 else np.linalg.matrix_rank(points[:k]) for k in range(len(points) + 1)]
    kept = [k for k in range(len(points)) if ranks[k + 1] > ranks[k]]
    if len(kept) < len(points):  # a contact on the journal of a bearing, say
        normals = np.asarray(normals @ np.linalg.lstsq(points[kept].T, points.T)[0].T)
    return SupportGeometry(points[kept], normals, counts)
