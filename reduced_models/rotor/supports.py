"""Supports of a rotor: one radial contact at a position around the shaft; a bearing, a damper.

A support takes the motion of its degrees of freedom, one number for each of its directions (the approach of a
contact; x and y, or all five, of an inner ring against the outer one), and gives as many forces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import cos, pi, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import parts, require_finite, require_instance, require_integer, shown
from ehlcontact.checks.kinds import INDEX, INDEX_OR_NONE, NAME, Count, Objects
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import InputError
from ehlcontact.point import Point, moes_point
from ehlcontact.summary import Summary
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.freedoms import FACINGS, FIVE, PLANAR, facing_signs, require_offset
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.squeeze_film_damper import SqueezeFilmDamper

_Floats = NDArray[np.float64]

AXIAL = FIVE.index("z")


@fields_take(
    x=INDEX, y=INDEX, z=INDEX, tilt_x=INDEX, tilt_y=INDEX, housing=Objects(object, "a number"),
    cage_angle="rad", offset="m", arm="m", name=NAME,
)  # fmt: skip
@dataclass(frozen=True, kw_only=True)
class BearingMount(Summary):
    """A bearing between degrees of freedom of the shaft and the ground, or those of a housing.

    It is planar (directions x and y), or with `z` has the five degrees of freedom of
    `reduced_models.bearing.freedoms`.

    Parameters
    ----------
    bearing : BallBearing, LinearBearing or SqueezeFilmDamper
    x, y : int
        Degrees of freedom of the shaft, across it. Of a damper, which is planar, those of what is its journal: the
        housing of a ball bearing, say.
    z, tilt_x, tilt_y : int, optional
        Those along the shaft, and of its turns about x and y: all of them, or none.
    housing : tuple of int or None, optional
        Those of the housing along x, y and, with `z`, z, which the outer ring moves with; None: the ground.
    cage_angle : float
        Of the first ball at the start [rad]; -pi/2, in -y, where it is left out.
    facing : {"+z", "-z"}
        Direction in which the inner ring is pressed against the outer one: of an angular contact bearing that of
        the axial force of the shaft that it carries.
    offset : float
        Displacement of the inner ring along its facing beside that of the shaft [m]; positive presses the bearing:
        preload by ground rings or spacers, axial growth of the shaft.
    arm : float
        Distance of the plane of the groove centres from the node of the shaft, along z [m].
    name : str
        In results and messages; by default "bearing" with its number among those of the rotor, or "damper".

    Raises
    ------
    InputError
        An angular contact bearing without `z`, facing, offset or arm without it, an angle in degrees.
    """

    bearing: BallBearing | LinearBearing | SqueezeFilmDamper
    x: int
    y: int
    z: int | None = None
    tilt_x: int | None = None
    tilt_y: int | None = None
    housing: tuple[int | None, ...] | None = None
    cage_angle: float = -pi / 2.0
    facing: str = FACINGS[0]
    offset: float = 0.0
    arm: float = 0.0
    name: str = ""

    def _summary_lines(self) -> list[str]:
        on = "the ground" if self.housing is None else f"a housing at {', '.join(map(str, self.housing))}"
        at = ", ".join(map(str, self.ends[0]))
        return [f"{kind_of(self.bearing)} at degrees of freedom {at}, on {on}"]

    def __post_init__(self) -> None:
        require_bearing("bearing", self.bearing)
        if abs(require_finite("cage_angle", self.cage_angle)) > 2.0 * pi:
            raise InputError("cage_angle", self.cage_angle, "between -2 pi and 2 pi; angles are in radians")
        facing_signs(self.facing)
        require_finite("arm", self.arm)
        axial = (self.z, self.tilt_x, self.tilt_y)
        if self.z is None:
            if axial != (None, None, None):
                raise InputError("z, tilt_x, tilt_y", axial, "all given, or none")
            require_planar(self)
        elif None in axial:
            raise InputError("z, tilt_x, tilt_y", axial, "all given, or none")
        if isinstance(self.bearing, LinearBearing):
            size = self.bearing.stiffness.shape[-1]
            if size != len(self.directions):
                allowed = f"of {len(self.directions)} degrees of freedom, as those of its mount"
                raise InputError("bearing", f"matrices of {size}", allowed)
            if self.offset != 0.0:
                raise InputError("offset", self.offset, "left out: matrices are about static equilibrium")
        elif isinstance(self.bearing, SqueezeFilmDamper):
            if self.z is not None:
                raise InputError("z, tilt_x, tilt_y", axial, "left out of a squeeze film damper, which is planar")
        else:
            require_offset("offset", self.offset, self.bearing.ball_diameter)
        for k, place in enumerate(self.housing or ()):
            INDEX_OR_NONE.take(f"housing[{k}]", place, True)
        if self.housing is not None and len(self.housing) != (2 if self.z is None else 3):
            raise InputError("housing", self.housing, "(x, y), or (x, y, z) with five degrees of freedom")

    @property
    def ball_bearing(self) -> BallBearing:
        """The bearing, where it has balls."""
        assert isinstance(self.bearing, BallBearing)
        return self.bearing

    @property
    def damper(self) -> SqueezeFilmDamper:
        """The damper, where it is one."""
        assert isinstance(self.bearing, SqueezeFilmDamper)
        return self.bearing

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of its directions."""
        return PLANAR if self.z is None else FIVE

    @property
    def ends(self) -> tuple[tuple[int | None, ...], ...]:
        """Degrees of freedom, x before y, of the shaft and of the housing where there is one."""
        shaft = (self.x, self.y) if self.z is None else (self.x, self.y, self.z, self.tilt_x, self.tilt_y)
        return (shaft,) if self.housing is None else (shaft, self.housing)

    @property
    def shift(self) -> _Floats:
        """Displacement of the inner ring beside that which `rows` gives, shape (directions,) [m], [rad]."""
        found = np.zeros(len(self.directions))
        if self.z is not None:
            found[AXIAL] = self.offset
        return found

    def rows(self, size: int) -> _Floats:
        """Inner ring against the outer one from the displacements of the rotor, shape (directions, size)."""
        rows = np.zeros((len(self.directions), size))
        for k, place in enumerate(self.ends[0]):
            rows[k, place] = 1.0
        if self.z is not None:
            rows[0, self.tilt_y], rows[1, self.tilt_x] = self.arm, -self.arm
        for k, place in enumerate(self.housing or ()):
            if place is not None:
                rows[k, place] -= 1.0
        return rows if self.z is None else facing_signs(self.facing)[:, None] * rows


def require_contact(field: str, contact: Any) -> None:
    """Raise `InputError` for what neither pushes nor answers; None stands for a contact that comes later."""
    if contact is not None and not (callable(contact) or hasattr(contact, "advance")):
        allowed = "a contact element, a full film, or an impedance as a function of omega"
        raise InputError(field, shown(contact), allowed)


@fields_take(angle="rad", offset=parts.APPROACH, x=INDEX, y=INDEX, count=Count(1, 1000))
@dataclass(frozen=True, slots=True)
class ContactMount(Summary):
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
        In SI: an element, a full film (`TransientContact`), or for linear responses an impedance alone. `Rotor.on`
        gives a rotor others.
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
        require_contact("contact", self.contact)
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


def bearing_names(mounts: Sequence[Mount]) -> tuple[str, ...]:
    """Names of the bearings and dampers among supports, in their order; each kind is counted by itself."""
    counts = {"bearing": 0, "damper": 0}
    names = []
    for mount in mounts:
        if isinstance(mount, BearingMount):
            kind = "damper" if is_damper(mount) else "bearing"
            names.append(mount.name or f"{kind} {counts[kind]}")
            counts[kind] += 1
    return tuple(names)


def support_rows(mounts: Sequence[Mount], size: int) -> _Floats:
    """Motions of all supports from the displacements of a rotor, shape (directions of all supports, size)."""
    return np.concatenate([mount.rows(size) for mount in mounts])


def support_columns(mounts: Sequence[Mount]) -> tuple[slice, ...]:
    """Where the directions of each support are among those of all."""
    ends = np.cumsum([0, *(len(mount.directions) for mount in mounts)]).tolist()
    return tuple(slice(first, end) for first, end in pairwise(ends))


def require_planar(mount: BearingMount) -> None:
    """Raise `InputError` for what a bearing without axial motion and tilts does not have."""
    angle = getattr(mount.bearing, "contact_angle", None)
    needed = "five degrees of freedom: z, tilt_x and tilt_y given (rotor_on_bearings(..., axial=True))"
    if angle is not None:
        raise InputError("contact_angle", angle, f"in a mount of {needed}")
    for name, default in (("facing", FACINGS[0]), ("offset", 0.0), ("arm", 0.0)):
        if getattr(mount, name) != default:
            raise InputError(name, getattr(mount, name), f"left out, or {needed}")


def require_bearing(name: str, bearing: object) -> None:
    """Raise `InputError` for what is no bearing of a shaft."""
    if not isinstance(bearing, LinearBearing | SqueezeFilmDamper):
        require_instance(name, bearing, BallBearing, "a BallBearing")


def is_ball_bearing(mount: Mount) -> bool:
    """Whether the support is a ball bearing."""
    return isinstance(mount, BearingMount) and isinstance(mount.bearing, BallBearing)


def is_damper(mount: Mount) -> bool:
    """Whether the support is a squeeze film damper."""
    return isinstance(mount, BearingMount) and isinstance(mount.bearing, SqueezeFilmDamper)


def kind_of(bearing: BallBearing | LinearBearing | SqueezeFilmDamper) -> str:
    """Name of a bearing or damper, or what it is."""
    kinds = {LinearBearing: "linear bearing", SqueezeFilmDamper: "squeeze film damper"}
    return bearing.name or kinds.get(type(bearing), "ball bearing")


def bearing_columns(contacts: Sequence[ContactMount], bearings: Sequence[BearingMount]) -> tuple[slice, ...]:
    """Where the directions of each bearing are among those of contacts, then these bearings."""
    return support_columns([*contacts, *bearings])[len(contacts) :]


class SupportGeometry(NamedTuple):
    """Where supports act: N degrees of freedom, n points, m motions of supports."""

    points: _Floats  # (n, N) displacements of the points at which supports act
    normals: _Floats  # (m, n) motions of the supports from the displacements of the points
    counts: _Floats  # (m,) how often each force acts


def support_geometry(
    contacts: Sequence[ContactMount], bearings: Sequence[BearingMount], size: int
) -> SupportGeometry:
    """Points of contacts, then of bearings and dampers, on a rotor of `size` degrees of freedom."""
    places = list(dict.fromkeys(place for mount in contacts for place in mount.ends[0] if place is not None))
    points = np.concatenate([np.eye(size)[places], *(mount.rows(size) for mount in bearings)])
    directions = len(points) - len(places)
    normals = np.zeros((len(contacts) + directions, len(points)))
    for k, mount in enumerate(contacts):
        normals[k, : len(places)] = mount.rows(size)[0, places]
    normals[len(contacts) :, len(places) :] = np.eye(directions)
    counts = np.array([mount.count for mount in contacts] + [1.0] * directions)
    ranks = [0 if k == 0 else np.linalg.matrix_rank(points[:k]) for k in range(len(points) + 1)]
    kept = [k for k in range(len(points)) if ranks[k + 1] > ranks[k]]
    if len(kept) < len(points):  # a contact on the journal of a bearing, say
        normals = np.asarray(normals @ np.linalg.lstsq(points[kept].T, points.T)[0].T)
    return SupportGeometry(points[kept], normals, counts)
