"""Parts of a rotor on bearings: shaft, discs, bearings with their housings. SI units.

Positions are along the shaft, from its left end.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import (
    as_column,
    as_numbers,
    require_finite,
    require_instance,
    require_integer,
    require_nonnegative,
)
from ehlcontact.checks import parts as ranges
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary, span
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.freedoms import FACINGS, FIVE, facing_signs
from reduced_models.rotor.beam import ShaftElement
from reduced_models.rotor.bearing_set import BearingSet
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.rotor import Unbalance, require_unbalance
from reduced_models.rotor.squeeze_film_damper import SqueezeFilmDamper
from reduced_models.rotor.supports import BearingMount, require_bearing

_Floats = NDArray[np.float64]

DENSITY = 7800.0  # kg/m3 of steel, as of the balls
RING_SECTION = 0.75  # of an outer ring, over the ball diameter squared: 6205 has 0.7, 6305 0.8
ROUNDING = 1e-9  # share by which a polar inertia may pass that of a disc without thickness
MOST_ELEMENTS = 1000
ELEMENTS = f"a whole number from 1 to {MOST_ELEMENTS}"
WIDEST_GYRATION = 10.0  # m, radius of gyration of a disc


@fields_take(
    length=ranges.SHAFT_LENGTH, diameter=ranges.SHAFT_DIAMETER, bore=ranges.BORE,
    youngs_modulus=ranges.SHAFT_MODULUS,
    density=ranges.DENSITY_OR_NONE, damping_time=ranges.DAMPING_TIME,
)  # fmt: skip
@dataclass(frozen=True, kw_only=True, eq=False)
class Shaft(Summary):
    """A round shaft, of one section or several from left to right, bending and shearing as a Timoshenko beam.

    Parameters
    ----------
    length, diameter : float or array_like, shape (sections,)
        In m.
    bore : float or array_like, shape (sections,)
        Inner diameter [m].
    youngs_modulus, poisson_ratio, density : float
        In Pa, -, kg/m3; with density 0 it has no mass, as that of a Jeffcott rotor.
    shear : bool
        False: Euler's and Bernoulli's beam, which only bends (its sections still have rotary inertia).
    damping_time : float
        Stiffness-proportional damping in the fixed frame, C over K [s]. There is no rotating (internal) damping,
        so no instability from it.
    elements : int
        Elements of the shaft at least, all about as long.

    Raises
    ------
    InputError
        A value outside its range.
    """

    length: Any
    diameter: Any
    bore: Any = 0.0
    youngs_modulus: float = 2.06e11
    poisson_ratio: float = 0.3
    density: float = DENSITY
    shear: bool = True
    damping_time: float = 0.0
    elements: int = 8

    def _summary_lines(self) -> list[str]:
        sections = f"{self.length.size} sections" if self.length.size > 1 else "one section"
        hollow = f", bore {span(self.bore, 1e3, 'mm')}" if self.bore.any() else ""
        beam = "Timoshenko" if self.shear else "Euler and Bernoulli"
        area = 0.25 * pi * (self.diameter**2 - self.bore**2)
        weighs = f"{self.density * float(np.sum(area * self.length)):.4g} kg" if self.density else "without mass"
        return [
            f"{1e3 * self.end:.5g} mm long in {sections}, diameter {span(self.diameter, 1e3, 'mm')}{hollow}",
            f"{1e-9 * self.youngs_modulus:.4g} GPa, {weighs}, beam of {beam} in {self.elements} pieces or more",
        ]

    def __post_init__(self) -> None:
        lengths = as_column("length", np.atleast_1d(as_numbers("length", self.length)))
        for name in ("length", "diameter", "bore"):
            given = np.atleast_1d(as_numbers(name, getattr(self, name)))
            column = as_column(
                name, np.full(lengths.size, given[0]) if given.size == 1 else given, size=lengths.size
            )
            object.__setattr__(self, name, column)
        if np.any(self.bore >= self.diameter):
            raise InputError("bore", self.bore.tolist(), f"below the diameter {self.diameter.tolist()}")
        if not -1.0 < require_finite("poisson_ratio", self.poisson_ratio) <= 0.5:
            raise InputError("poisson_ratio", self.poisson_ratio, "above -1 and at most 0.5")
        if require_integer("elements", self.elements, ELEMENTS, 1) > MOST_ELEMENTS:
            raise InputError("elements", self.elements, ELEMENTS)

    @classmethod
    @takes(stiffness=ranges.STIFFNESS, span=ranges.SHAFT_LENGTH, damping=ranges.DAMPING)
    def jeffcott(cls, stiffness: float, span: float, *, damping: float = 0.0) -> Self:
        """Shaft without mass that only bends, of given stiffness in the middle between bearings at its ends.

        Parameters
        ----------
        stiffness, damping : float
            Of its middle against both ends together [N/m], [N s/m].
        span : float
            Its length [m].
        """
        k, length = float(stiffness), float(span)
        inertia = k * length**3 / (48.0 * cls.youngs_modulus)
        time = damping / k
        diameter = (64.0 * inertia / pi) ** 0.25
        return cls(length=length, diameter=diameter, density=0.0, shear=False, damping_time=time, elements=1)

    @property
    def end(self) -> float:
        """Position of its right end [m]."""
        return float(np.sum(self.length))

    def shaft_elements(self, stations: _Floats) -> list[ShaftElement]:
        """Between neighbouring stations, at all of which sections may end."""
        ends = np.cumsum(self.length)
        section = np.searchsorted(ends, 0.5 * (stations[1:] + stations[:-1]))
        material = self.youngs_modulus, self.poisson_ratio, self.density, self.shear
        return [
            ShaftElement(float(length), float(self.diameter[k]), float(self.bore[k]), *material)
            for length, k in zip(np.diff(stations), section.tolist(), strict=True)
        ]


@fields_take(
    position=ranges.PLACE, mass=ranges.MASS, diametral_inertia=ranges.INERTIA, polar_inertia=ranges.INERTIA,
    unbalance="kg m", phase="rad", damping=ranges.DAMPING, load=ranges.FORCE,
)  # fmt: skip
@dataclass(frozen=True, kw_only=True)
class Disc(Summary):
    """A rigid disc on the shaft.

    Parameters
    ----------
    position : float
        In m.
    mass : float
        In kg.
    diametral_inertia, polar_inertia : float
        About a diameter and about the shaft [kg m2]; both 0: it is a point.
    unbalance, phase : float
        Mass times eccentricity [kg m], and its angle ahead of the shaft's [rad].
    damping : float
        To the ground [N s/m].
    load : (float, float) or (float, float, float)
        Constant force beside its weight [N], along x, y and z.
    """

    position: float
    mass: float
    diametral_inertia: float = 0.0
    polar_inertia: float = 0.0
    unbalance: float = 0.0
    phase: float = 0.0
    damping: float = 0.0
    load: tuple[float, ...] = (0.0, 0.0)

    def _summary_lines(self) -> list[str]:
        turns = f"inertias {self.diametral_inertia:.4g} and {self.polar_inertia:.4g} kg m2"
        body = turns if self.diametral_inertia else "a point"
        return [
            f"{self.mass:.4g} kg at {1e3 * self.position:.5g} mm, {body}",
            f"unbalance {1e6 * self.unbalance:.4g} g mm, load ({', '.join(f'{one:.4g}' for one in self.load)}) N",
        ]

    def __post_init__(self) -> None:
        require_nonnegative("unbalance", self.unbalance)
        most = WIDEST_GYRATION**2 * self.mass
        for name in ("diametral_inertia", "polar_inertia"):
            if (inertia := getattr(self, name)) > most:
                guess = f" ({slip})" if (slip := ranges.INERTIA._replace(usual=(0.0, most)).slip(inertia)) else ""
                raise InputError(name, inertia, f"at most {most:g} kg m2, (10 m)^2 times the mass{guess}")
        if self.polar_inertia > 2.0 * self.diametral_inertia * (1.0 + ROUNDING):
            most = 2.0 * self.diametral_inertia
            raise InputError(
                "polar_inertia", self.polar_inertia, f"at most twice the diametral one, {most:.6g} kg m2"
            )
        Unbalance(x=0, y=1, amount=self.unbalance, phase=self.phase)
        require_unbalance("unbalance", self.unbalance, self.mass)
        size = 3 if np.size(self.load) == 3 else 2
        object.__setattr__(self, "load", tuple(as_column("load", self.load, size=size).tolist()))

    @classmethod
    @takes(
        position=ranges.PLACE, diameter=ranges.SHAFT_DIAMETER, width=ranges.SHAFT_DIAMETER, bore=ranges.BORE,
        density=ranges.DENSITY,
    )  # fmt: skip
    def cylinder(
        cls,
        *,
        position: float,
        diameter: float,
        width: float,
        bore: float = 0.0,
        density: float = DENSITY,
        **others: Any,
    ) -> Self:
        """A disc of one material, `position` being that of its middle.

        Parameters
        ----------
        diameter, width, bore : float
            In m; the bore is filled by the shaft.
        density : float
            In kg/m3.
        **others
            Unbalance, phase, damping and load, as of the class.
        """
        outer, thick, hole, rho = float(diameter), float(width), float(bore), float(density)
        if hole >= outer:
            raise InputError("bore", bore, f"below the diameter, {outer:g} m")
        mass = rho * 0.25 * pi * (outer**2 - hole**2) * thick
        polar = mass * (outer**2 + hole**2) / 8.0
        across = 0.5 * polar + mass * thick**2 / 12.0
        return cls(position=position, mass=mass, diametral_inertia=across, polar_inertia=polar, **others)


class Seat(NamedTuple):
    """A bearing on the shaft at a support."""

    bearing: BallBearing | LinearBearing
    facing: str
    offset: float  # m
    arm: float  # m, axial distance of the plane of its groove centres from the node
    slides: bool  # its outer ring is free along the shaft


@fields_take(
    position=ranges.PLACE, cage_angle="rad", journal_mass=ranges.MASS_OR_NONE, housing_mass=ranges.MASS,
    housing_stiffness=ranges.STIFFNESS, housing_damping=ranges.DAMPING, offset="m", preload=ranges.PRELOAD,
    preload_stiffness=ranges.STIFFNESS_OR_NONE, outer_ring_mass=ranges.RING_MASS,
)  # fmt: skip
@dataclass(frozen=True, kw_only=True, eq=False)
class Support(Summary):
    """A bearing under the shaft, on the ground or in a housing on springs.

    Parameters
    ----------
    position : float
        In m.
    bearing : BallBearing, LinearBearing or BearingSet
        All bearings of a set are on the shaft at this position, each with the arm of its own position in the set;
        facings, offsets and spring are those of the set.
    cage_angle : float
        Of the first ball at the start [rad]; -pi/2, in -y, where it is left out.
    journal_mass : float
        Beside that of the shaft [kg]: inner ring, sleeve, or, of a shaft without mass, its share.
    housing_mass : float, optional
        Of what moves with the outer ring [kg]; without it that stands on the ground.
    housing_stiffness, housing_damping : float, (float, float) or (float, float, float), optional
        Between the housing and the ground, along x, y and z [N/m], [N s/m]; of two values z has the first.
    facing : {"+z", "-z"}
        Direction in which the inner ring is pressed against the outer one; z runs from the left end of the shaft
        to the right. "+z" left and "-z" right is back to back, the reverse face to face.
    offset : float
        Displacement of the inner ring along its facing beside that of the shaft [m]; positive presses the bearing:
        rigid preload by ground rings or spacers; growth of a shaft, which relieves bearings back to back.
    preload : float, optional
        Force of a spring on an outer ring that is free to move along the shaft, pressing the bearing [N]; 0: a
        floating deep-groove bearing. By default the outer ring is fixed along the shaft. The spring pushes the
        outer ring against `facing`.
    preload_stiffness : float
        Of that spring [N/m]; 0: its force is constant.
    damper : SqueezeFilmDamper, optional
        Between the housing and the ground, beside the springs of the housing, which are its squirrel cage.
    outer_ring_mass : float, optional
        Of an outer ring that is free [kg]; by default that of steel with a section of 3/4 of the ball diameter
        squared.

    Raises
    ------
    InputError
        A value outside its range; a spring on the outer ring of a bearing in a housing.
    """

    position: float
    bearing: BallBearing | LinearBearing | BearingSet
    cage_angle: float = -pi / 2.0
    journal_mass: float = 0.0
    housing_mass: float | None = None
    housing_stiffness: Any = None
    housing_damping: Any = 0.0
    facing: str = FACINGS[0]
    offset: float = 0.0
    preload: float | None = None
    preload_stiffness: float = 0.0
    outer_ring_mass: float | None = None
    damper: SqueezeFilmDamper | None = None

    def _summary_lines(self) -> list[str]:
        lines = [f"{self.bearing.name or 'ball bearing'} at {1e3 * self.position:.5g} mm"]
        if self.needs_axial and not isinstance(self.bearing, BearingSet):
            held = f"offset {1e6 * self.offset:.4g} µm"
            lines.append(
                f"facing {self.facing}, {held if self.preload is None else f'spring {self.preload:.4g} N'}"
            )
        if self.housing_mass is None:
            return [f"{lines[0]}, on the ground", *lines[1:]]
        springs = span(self.housing_stiffness, 1e-6, "N/µm")
        film = "" if self.damper is None else " and a squeeze film damper"
        return [*lines, f"in a housing of {self.housing_mass:.4g} kg on springs of {springs}{film}"]

    def __post_init__(self) -> None:
        facing_signs(self.facing)
        if isinstance(self.bearing, BearingSet):
            own = {"facing": FACINGS[0], "offset": 0.0, "preload": None}
            for name, default in own.items():
                if getattr(self, name) != default:
                    raise InputError(name, getattr(self, name), "left out: the BearingSet has its own")
        else:
            require_bearing("bearing", self.bearing)
        z, tilt_x, tilt_y = (2, 3, 4) if self.needs_axial else (None, None, None)
        for seat in self.seats:
            BearingMount(
                bearing=seat.bearing, x=0, y=1, z=z, tilt_x=tilt_x, tilt_y=tilt_y, cage_angle=self.cage_angle,
                facing=seat.facing, offset=seat.offset, arm=seat.arm,
            )  # fmt: skip
        if (self.housing_mass is None) != (self.housing_stiffness is None):
            missing = "housing_mass" if self.housing_mass is None else "housing_stiffness"
            raise InputError(missing, None, "given: a housing has a mass and springs")
        if self.damper is not None:
            require_instance("damper", self.damper, SqueezeFilmDamper, "a SqueezeFilmDamper")
            if self.housing_mass is None:
                raise InputError("housing_mass", None, "given: the damper is between the housing and the ground")
        if self.housing_mass is not None:
            for name in ("housing_stiffness", "housing_damping"):
                given = np.atleast_1d(as_numbers(name, getattr(self, name)))
                size = 3 if given.size == 3 else 2
                column = as_column(name, np.full(size, given[0]) if given.size == 1 else given, size=size)
                object.__setattr__(self, name, column)
        if self.preload is not None:
            if self.preload == self.preload_stiffness == 0.0 and getattr(self.bearing, "contact_angle", None):
                allowed = "> 0: nothing else keeps an angular contact bearing together whose outer ring is free"
                raise InputError("preload", self.preload, allowed)
            if self.offset != 0.0:
                raise InputError("offset", self.offset, "left out beside preload: the outer ring gives way to it")
        if self.spring is not None and self.housing_mass is not None:
            raise InputError("preload", self.spring, "left out with a housing, whose springs hold it along z")

    @property
    def seats(self) -> tuple[Seat, ...]:
        """Bearings that are on the shaft here."""
        if not isinstance(self.bearing, BearingSet):
            return (Seat(self.bearing, self.facing, self.offset, 0.0, self.preload is not None),)
        rows = zip(
            self.bearing.bearings, self.bearing.facings, self.bearing.offsets, self.bearing.positions, strict=True
        )
        return tuple(Seat(*row, row[1] == self.bearing.sprung) for row in rows)

    @property
    def spring(self) -> float | None:
        """Force of the spring on outer rings that are free to move along the shaft [N]; None: all are fixed."""
        if isinstance(self.bearing, BearingSet):
            return self.bearing.spring if self.bearing.sprung is not None else None
        return self.preload

    @property
    def needs_axial(self) -> bool:
        """Whether it needs axial motion of the shaft."""
        if isinstance(self.bearing, BearingSet):
            return True
        angle = getattr(self.bearing, "contact_angle", None)
        five = isinstance(self.bearing, LinearBearing) and self.bearing.stiffness.shape[-1] == len(FIVE)
        own = self.facing != FACINGS[0] or self.offset != 0.0 or self.preload is not None
        return own or five or angle is not None

    @property
    def ring_mass(self) -> float:
        """Mass of the outer rings that are free to move along the shaft [kg]."""
        if self.outer_ring_mass is not None:
            return self.outer_ring_mass
        mass = 0.0
        for bearing in (seat.bearing for seat in self.seats if seat.slides):
            if isinstance(bearing, LinearBearing):
                raise InputError("outer_ring_mass", None, "given: a bearing of matrices has no dimensions")
            ball = bearing.ball_diameter
            mass += bearing.density * pi * (bearing.pitch_diameter + ball) * RING_SECTION * ball**2
        return mass
