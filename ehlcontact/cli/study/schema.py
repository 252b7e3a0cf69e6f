"""The study file: TOML, checked field by field before anything is computed."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cached_property
from math import cos, hypot, pi
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError

from ehlcontact.checks.admissible_range import INPUTS
from ehlcontact.cli import entries as e
from ehlcontact.cli.entries import Section
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.schema_errors import first_error, inputs_of, names_of, require_sections
from ehlcontact.cli.toml import read_toml
from ehlcontact.content_store import key_of
from ehlcontact.errors import InputError
from ehlcontact.lubricant import Lubricant
from ehlcontact.lubricant.oil import GRADES
from ehlcontact.point import OperatingPoint, require_solvable
from ehlcontact.solver.domain import Domain
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad
from reduced_models.rotor.rotor import require_unbalance

BY_NUMBERS = ("eta0", "alpha")  # entries of an oil
BY_GRADE = ("iso_vg", "temperature", "viscosity_index", "density_15")
BY_SHEET = ("nu40", "nu100", "temperature", "density_15")  # of its data sheet
# As on the drum, and as people shorten it: "ISO VG 68", "VG68", "iso-vg 68", "68".
_GRADE = re.compile(r"(?:(?:iso[\s_-]*)?vg[\s_-]*|iso[\s_-]*)?(\d{1,4})", re.IGNORECASE)
ENTRIES = {  # as the library calls them
    "x_in": "contact.domain.0",
    "x_out": "contact.domain.1",
    "y_max": "contact.domain.2",
}
LOADS = ("radial_load", "axial_load", "moment_x", "moment_y", "tilt_x_mrad", "tilt_y_mrad")  # of [operation]
BALL_PARTS = ("balls", "ball_diameter_mm", "pitch_diameter_mm")  # dimensions of a bearing without a name
LOAD_DIGITS = 10  # of a load: an equilibrium is found to some 1e-14 of it, and fits would answer to the rest
OF_JEFFCOTT = ("disc_mass", "journal_mass", "shaft_stiffness", "shaft_damping", "disc_damping", "unbalance")


class Operation(Section):
    """Speed and loads. Loads are for a bearing alone: with [shaft] the discs and their weight are the load.

    Lists, as [1500.0, 3000.0], make a study of several points: every speed with every radial load.
    """

    speed_rpm: Annotated[e.SpeedOrRest, e.meaning("speed of the shaft, or a list")]
    radial_load: Annotated[e.LoadOrNone | None, e.meaning("radial load on the bearing, downwards")] = None
    axial_load: Annotated[
        e.AxialLoad | None,
        e.meaning(
            "axial load on the bearing: with it balls have contact angles; angular contact bearings need it"
        ),
    ] = None
    moment_x: Annotated[
        e.Moment | None,
        e.meaning("moment about x (horizontal): with it, or moment_y, the inner ring tilts freely"),
    ] = None
    moment_y: Annotated[e.Moment | None, e.meaning("moment about y (upwards)")] = None
    tilt_x_mrad: Annotated[
        e.Tilt | None, e.meaning("misalignment: tilt about x at which the inner ring is held")
    ] = None
    tilt_y_mrad: Annotated[e.Tilt | None, e.meaning("tilt about y at which the inner ring is held")] = None
    hz: Annotated[
        tuple[e.NotNegative, ...] | None,
        Field(strict=False, min_length=1, description="frequencies of K and C, Hz; those about the shaft's"),
    ] = None
    layer_um: e.OilThickness | None = None
    layer_ratio: e.BearingLayerRatio | None = None
    thermal: Annotated[bool, e.meaning("films that heat up, beside isothermal ones")] = False


class Oil(Section):
    """The oil in the inlet: a grade and a temperature; nu40, nu100 and a temperature, or eta0 and alpha."""

    name: Annotated[e.Text, e.meaning("as the report calls it; by its grade where left out")] = "oil"
    eta0: e.Eta0 | None = None
    alpha: e.Alpha | None = None
    iso_vg: e.Grade | None = None
    nu40: e.Nu40 | None = None
    nu100: e.Nu100 | None = None
    temperature: e.Temperature | None = None
    viscosity_index: e.ViscosityIndex | None = None
    density_15: e.Density15 | None = None
    viscosity: e.ViscosityLaw = "roelands"
    density: e.DensityLaw = "dowson-higginson"

    @property
    def label(self) -> str:
        """Its name; by its grade where it has none of its own."""
        if "name" in self.model_fields_set:
            return self.name
        if self.nu40 is not None:
            viscosities = f"{numeral(self.nu40)} and {numeral(self.nu100)} mm2/s at 40 and 100 °C"
            return f"oil of {viscosities}, at {numeral(self.temperature)} °C"
        if self.iso_vg is None:
            return self.name
        return f"ISO VG {self.iso_vg} at {numeral(self.temperature)} °C"

    @property
    def lubricant(self) -> Lubricant:
        """The oil as the solvers take it.

        Raises
        ------
        InputError
            Given in no way, in part, or in two ways; or an oil that the library refuses.
        """
        given = {name: getattr(self, name) for name in {*BY_NUMBERS, *BY_GRADE, *BY_SHEET}}
        laws = {"viscosity": self.viscosity, "density": self.density}
        return lubricant_of(given, laws, lambda name: f"oil.{name}")


def lubricant_of(given: Mapping[str, Any], laws: Mapping[str, str], called: Callable[[str], str]) -> Lubricant:
    """The oil of inputs: by its numbers, by its grade and temperature, or by its viscosities at 40 and 100 C.

    Parameters
    ----------
    given : mapping
        Inputs by their names in [oil]; None where one is left out.
    laws : mapping
        ``viscosity`` and ``density``.
    called : callable
        The user's name of an input, for messages.

    Raises
    ------
    InputError
        Given in no way, in part, or in two ways; or an oil that the library refuses.
    """
    known = {name: given[name] for name in (*BY_GRADE, *BY_SHEET, *BY_NUMBERS) if given.get(name) is not None}
    own = BY_NUMBERS if not known or set(known) & set(BY_NUMBERS) else BY_GRADE
    own = BY_SHEET if own is BY_GRADE and set(known) & set(BY_SHEET[:2]) else own
    for name, value in known.items():
        if name not in own:
            other = called(next(one for one in own if one in known))
            ways = "by its numbers or by its grade" if own is BY_NUMBERS else "by its grade or by its viscosities"
            raise InputError(called(name), value, f"left out where {other} is given: the oil is given {ways}")
    for name in own if own is BY_NUMBERS else BY_SHEET[:3] if own is BY_SHEET else BY_GRADE[:2]:
        if name not in known:
            grade, sheet, numbers = (
                " and ".join(map(called, names[:2])) for names in (BY_GRADE, BY_SHEET, BY_NUMBERS)
            )
            raise InputError(called(name), None, f"given: {grade}, or {numbers}, or {sheet} in their place")
    make = {BY_NUMBERS: Lubricant, BY_GRADE: _of_grade, BY_SHEET: Lubricant.from_viscosities}[own]
    try:
        return make(**known, **laws)  # type: ignore[operator]
    except InputError as error:
        raise InputError(called(error.field), error.value, error.allowed) from None


def _of_grade(iso_vg: int, **more: Any) -> Lubricant:
    return Lubricant.iso_vg(iso_vg, **more)


def oil_grade(text: str, field: str) -> int:
    """The grade in the name of an oil, 68 of "ISO VG 68"; `field` is what it was given as, for the message.

    Raises
    ------
    InputError
        Any other name, or a grade that the library does not have.
    """
    found = _GRADE.fullmatch(text.strip())
    if found is None or int(found[1]) not in GRADES:
        *most, last = map(str, GRADES)
        raise InputError(field, text, f"ISO VG {', '.join(most)} or {last}; any other oil by its eta0 and alpha")
    return int(found[1])


class Surface(Section):
    """Roughness, for the lambda ratio alone: films are solved between smooth surfaces."""

    rq_um: Annotated[e.Roughness | None, e.meaning("Rq of ball and race together, in place of that of each")] = (
        None
    )
    rq_ball_um: Annotated[e.Roughness | None, e.meaning("Rq of the balls; with rq_race_um or not at all")] = None
    rq_race_um: Annotated[e.Roughness | None, e.meaning("Rq of the races")] = None


class Shaft(Section):
    """The shaft of a machine, on two supports or more: round, or without mass, by its stiffness."""

    length_mm: Annotated[e.Length, e.meaning("its length; positions are distances from its left end")]
    diameter_mm: Annotated[e.Diameter | None, e.meaning("its diameter")] = None
    bore_mm: Annotated[e.Bore, e.meaning("diameter of a bore through it")] = 0.0
    density: e.Density = 7800.0
    youngs_modulus: Annotated[e.YoungsModulus, e.meaning("Young's modulus of the shaft")] = 2.06e11
    stiffness: Annotated[
        e.Stiffness | None,
        e.meaning("of a shaft without mass, in the middle between supports at its ends; in place of diameter_mm"),
    ] = None
    damping: Annotated[e.NotNegative, e.meaning("N s/m, of the shaft itself, with stiffness")] = 0.0
    damping_time: Annotated[
        e.NotNegative, e.meaning("s, of a round shaft: its damping over its stiffness, in the fixed frame")
    ] = 0.0


class Disc(Section):
    """A rigid disc on the shaft: a cylinder by its size, or by its mass."""

    position_mm: Annotated[e.Position, e.meaning("of its middle, from the left end of the shaft")]
    diameter_mm: Annotated[e.Diameter | None, e.meaning("its diameter; with width_mm")] = None
    width_mm: Annotated[e.Diameter | None, e.meaning("its width along the shaft")] = None
    bore_mm: Annotated[
        e.Bore | None, e.meaning("of its bore, which the shaft fills; the diameter of the shaft if left out")
    ] = None
    density: e.Density | None = None
    mass: Annotated[e.Mass | None, e.meaning("its mass, in place of its size")] = None
    diametral_inertia: Annotated[e.Inertia | None, e.meaning("kg m2, about a diameter, with mass")] = None
    polar_inertia: Annotated[e.Inertia | None, e.meaning("kg m2, about the shaft, with mass")] = None
    unbalance: Annotated[e.NotNegative, e.meaning("kg m, mass times eccentricity")] = 0.0
    radial_load: Annotated[e.Force, e.meaning("N, beside its weight, downwards")] = 0.0
    axial_load: Annotated[e.Force, e.meaning("N, along the shaft, to the right")] = 0.0
    damping: Annotated[e.NotNegative, e.meaning("N s/m, of the air about it")] = 0.0


class Support(Section):
    """A bearing, or a pair of them, under the shaft: by its name in the catalogue, or by its dimensions."""

    name: Annotated[e.Text | None, e.meaning("of this support; left, right of two")] = None
    position_mm: Annotated[e.Position | None, e.meaning("from the left end of the shaft; with [shaft]")] = None
    bearing: Annotated[
        e.Catalogue | None, e.meaning("name in the catalogue, in place of the dimensions below")
    ] = None
    balls: e.Balls | None = None
    ball_diameter_mm: e.BallDiameter | None = None
    pitch_diameter_mm: e.PitchDiameter | None = None
    conformity: Annotated[
        e.Conformity | None, e.meaning("groove radius over ball diameter, of both races; 0.52 if left out")
    ] = None
    conformity_inner: Annotated[e.Conformity | None, e.meaning("of the inner race, in its place")] = None
    conformity_outer: Annotated[e.Conformity | None, e.meaning("of the outer race, in its place")] = None
    contact_angle_deg: Annotated[
        e.ContactAngle | None,
        e.meaning("free contact angle of an angular contact bearing; that of its name if left out"),
    ] = None
    clearance: Annotated[
        e.Clearance | str | None,
        e.meaning('radial internal clearance, um, below 0 a preload; or a class, as "CN"; 0 if left out'),
    ] = None
    facing: Annotated[
        Literal["+z", "-z"] | None,
        e.meaning("direction in which the shaft presses the inner ring; +z is to the right"),
    ] = None
    spring: Annotated[
        e.RingSpring | None,
        e.meaning("N, of a spring that presses its outer ring, which slides, against facing; 0: it floats"),
    ] = None
    offset_um: Annotated[e.Finite | None, e.meaning("um, of a ground ring or spacer that presses it")] = None
    pair: e.Arrangement | None = None
    preload: e.Preload | None = None
    pair_spring: Annotated[
        e.Spring | None,
        e.meaning("force of a spring on the outer ring of the second of the pair, in place of preload"),
    ] = None
    distance_mm: Annotated[
        e.Distance | None, e.meaning("distance of the planes of the pair; side by side where left out")
    ] = None
    journal_mass: Annotated[
        e.NotNegative,
        e.meaning("kg, beside that of the shaft: inner ring, sleeve; a share of a shaft without mass"),
    ] = 0.0
    housing_stiffness: Annotated[
        e.Stiffness | None, e.meaning("between housing and ground, with housing_mass")
    ] = None
    housing_mass: Annotated[e.Mass | None, e.meaning("of what moves with the outer ring")] = None
    housing_damping: Annotated[e.NotNegative, e.meaning("N s/m, between housing and ground")] = 0.0
    race_control: Annotated[
        e.RaceControl | None, e.meaning("what holds the gyroscopic moment of the balls; outer where left out")
    ] = None
    loss_factor: Annotated[e.NotNegative | None, e.meaning("of rings and fits, measured")] = None
    ball_inertia: Annotated[bool | None, e.meaning("balls vibrate between the rings; from some kHz on")] = None
    cutoff_gap_um: Annotated[
        e.Positive | None, e.meaning("um, beyond which the film of an unloaded ball is gone")
    ] = None
    youngs_modulus: e.YoungsModulus = 2.06e11
    poisson_ratio: e.PoissonRatio = 0.3

    @property
    def label(self) -> str:
        """Its own name, or that of its bearing."""
        return self.name or self.bearing or "ball bearing"


class Free(Section):
    """Free vibration of a mass on the contact, which a cubic element is fitted to."""

    Omega_n: Annotated[
        e.Frequency | None, e.meaning("of mass and dry contact, in u_sum/(2a); 2.56 where neither is given")
    ] = None
    hz: Annotated[e.Positive | None, e.meaning("Hz, in its place: the frequency of small dry vibrations")] = None
    periods: e.Periods = 2.5
    steps_per_period: e.Steps = 80


class Harmonic(Section):
    """Harmonic load in the band of the contact's own vibrations, which another element is fitted to."""

    Omega: Annotated[e.Frequency | None, e.meaning("frequency, in u_sum/(2a); pi where neither is given")] = None
    hz: Annotated[e.Positive | None, e.meaning("frequency in Hz, in its place")] = None
    amplitude: Annotated[e.Share, e.meaning("over the static load")] = 0.1
    periods: e.Periods = 3.0
    steps_per_period: e.Steps = 80


class RotorBand(Section):
    """Harmonic load at the speed of the shaft, which the element of the FMU is fitted to."""

    amplitude: Annotated[e.Share, e.meaning("over the static load")] = 0.25
    periods: e.Periods = 2.0
    steps_per_period: e.Steps = 40


class Contact(Section):
    """The film of the most loaded ball of a bearing, in full: its motions, and elements fitted to them."""

    support: Annotated[e.Text | None, e.meaning("name of the support; the first one if left out")] = None
    race: e.Race = "inner"
    n: Annotated[e.Intervals, e.meaning("intervals along rolling, steady film")] = 128
    n_transient: Annotated[e.Intervals, e.meaning("intervals along rolling, every film in motion")] = 128
    domain: Annotated[
        tuple[e.Finite, e.Finite, e.Finite],
        Field(
            strict=False,
            description="inlet, outlet and half width in semi-axes of the contact; damping depends on it a little",
        ),
    ] = (-4.5, 1.5, 3.0)
    free: Free = Free()
    harmonic: Harmonic = Harmonic()
    rotor_band: RotorBand = RotorBand()


class FullFilms(Section):
    """Jeffcott rotor on computed films and on elements: it turns with its unbalance, and decays after a kick.

    Mass, stiffness and unbalance are those of the machine where its shaft has a stiffness and one disc.
    """

    arrangement: Annotated[
        Literal["vee", "vertical"], e.meaning("balls that carry each journal: two at an angle, or one below")
    ] = "vee"
    half_angle_deg: Annotated[e.Finite, Field(gt=0.0, lt=90.0, description="degrees, of a vee")] = 20.0
    disc_mass: Annotated[e.Mass, e.meaning("mass of the disc")] = 2.0
    journal_mass: Annotated[e.Mass, e.meaning("mass of both journals together")] = 0.3
    shaft_stiffness: Annotated[e.Stiffness, e.meaning("of the shaft between the bearings at the disc")] = 2e8
    shaft_damping: Annotated[e.NotNegative, e.meaning("N s/m, of the shaft itself")] = 60.0
    disc_damping: Annotated[e.NotNegative, e.meaning("N s/m, of the air about the disc")] = 1.0
    unbalance: Annotated[e.Unbalance, e.meaning("mass times eccentricity")] = 4e-5
    revolutions: Annotated[
        e.Whole,
        Field(ge=2, le=100, description="revolutions computed on full films, from near the settled motion on"),
    ] = 3
    steps_per_revolution: e.Steps = 60
    kick: Annotated[e.Share, e.meaning("amplitude of the contacts' load after the kick, over that at rest")] = 0.05
    decay_periods: Annotated[
        e.Finite, Field(ge=4.0, le=100.0, description="periods of the vibration after the kick")
    ] = 8.0
    decay_steps_per_period: e.Steps = 40
    half_step: Annotated[
        bool, e.meaning("everything on full films again with half the step; the study takes about twice as long")
    ] = False


class InTime(Section):
    """The machine in time on models of its bearings: films with memory, dry, constant K and C.

    Its two bearings are alike and planar: no axial load, spring, pair or housing.
    """

    revolutions: Annotated[
        e.Whole, Field(ge=10, le=1000, description="revolutions computed; the second half of them is shown")
    ] = 30
    steps_per_revolution: Annotated[e.Whole, Field(ge=200, le=10000, description="time steps in each of them")] = (
        500
    )


class Defect(Section):
    """A spall in a bearing: its orders, and its force over time and as an envelope."""

    support: Annotated[e.Text | None, e.meaning("name of the support; the first one if left out")] = None
    spall: Annotated[e.Text, e.meaning("race, mm along the track, um deep, as outer,0.5,0.3")]
    cage_slip_percent: Annotated[
        e.CageSlip | None,
        e.meaning("slip of the cage in orders and lines of the spall, of its speed with balls that roll"),
    ] = None


class Study(Section):
    """A study file of one speed and load."""

    title: Annotated[e.Text, e.meaning("heads the report")] = "study of a machine"
    operation: Operation
    oil: Oil | None = None
    surface: Surface = Surface()
    shaft: Shaft | None = None
    disc: Annotated[tuple[Disc, ...], Field(strict=False)] = ()
    support: Annotated[tuple[Support, ...], Field(strict=False, min_length=1)]
    contact: Contact | None = None
    full_films: FullFilms | None = None
    in_time: InTime | None = None
    defect: Annotated[tuple[Defect, ...], Field(strict=False)] = ()

    @property
    def speed_rpm(self) -> float:
        """Speed of the shaft [rev/min]."""
        return self.operation.speed_rpm

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the supports: their own; left and right of two; else by their number."""
        return names_of([one.name for one in self.support])

    def index(self, name: str | None, field: str) -> int:
        """Place of a support in the file; the first one where no name is given.

        Raises
        ------
        InputError
            No such support.
        """
        if name is None:
            return 0
        if name not in self.names:
            raise InputError(field, name, f"the name of a support: {', '.join(self.names)}")
        return self.names.index(name)

    @property
    def at(self) -> int:
        """Place of the support that the study is about: that of [contact], else the first."""
        return self.index(None if self.contact is None else self.contact.support, "contact.support")

    @property
    def carrier(self) -> Support:
        """The support that the study is about."""
        return self.support[self.at]

    @cached_property
    def ball(self) -> tuple[float, float]:
        """Load [N] and contact angle [rad] of the most loaded ball at the race of [contact]."""
        from ehlcontact.cli.study.loads import heaviest_ball

        return heaviest_ball(self)

    @property
    def ball_load(self) -> float:
        """Load of the most loaded ball [N]."""
        return self.ball[0]

    @cached_property
    def radial_load(self) -> float:
        """Radial load on the bearing that the study is about [N], with the digits that an equilibrium has."""
        from ehlcontact.cli.study.loads import ring_load

        load = ring_load(self, self.at)
        return float(f"{hypot(load[0], load[1]):.{LOAD_DIGITS}g}")

    @cached_property
    def lubricant(self) -> Lubricant | None:
        """The oil as the solvers take it; None of a dry machine."""
        return None if self.oil is None else self.oil.lubricant

    @property
    def roughness(self) -> tuple[float, float] | None:
        """Rq of ball and race [m], None where not given.

        Raises
        ------
        InputError
            Only one of them is given, or the roughness of both together beside them.
        """
        found = {"rq_ball_um": self.surface.rq_ball_um, "rq_race_um": self.surface.rq_race_um}
        given = {name: value * 1e-6 for name, value in found.items() if value is not None}
        if self.surface.rq_um is not None:
            for name in given:
                raise InputError(f"surface.{name}", found[name], "left out where surface.rq_um is given")
            return 0.0, self.surface.rq_um * 1e-6
        if len(given) == 1:
            missing = next(name for name in found if name not in given)
            raise InputError(f"surface.{missing}", None, f"given, as {next(iter(given))} is")
        return (given["rq_ball_um"], given["rq_race_um"]) if given else None

    @property
    def domain(self) -> Domain:
        """Computed region."""
        assert self.contact is not None
        return Domain(*self.contact.domain)

    @cached_property
    def point(self) -> OperatingPoint:
        """Operating point of the contact of the most loaded ball.

        Curvature and surface speed at a contact angle a are those of the pitch diameter dm/cos a at n cos a.

        Raises
        ------
        InputError
            A dry machine, which has no film.
        """
        from ehlcontact.cli.study.machine import dimensions_of

        assert self.contact is not None
        if self.lubricant is None:
            raise InputError("oil", None, "given, with [contact]: its film is that of an oil")
        (load, angle), sizes, carrier = self.ball, dimensions_of(self, self.at), self.carrier
        e1, nu1 = carrier.youngs_modulus, carrier.poisson_ratio
        return OperatingPoint.ball_bearing(
            self.lubricant,
            ball_diameter=sizes.ball_diameter,
            pitch_diameter=sizes.pitch_diameter / cos(angle),
            conformity=sizes.conformity[self.contact.race == "outer"],
            speed_rpm=self.speed_rpm * cos(angle),
            load=load,
            race=self.contact.race,
            e1=e1, nu1=nu1, e2=e1, nu2=nu1,
        )  # fmt: skip

    @property
    def rotor_omega(self) -> float:
        """Dimensionless angular frequency of the rotor's speed."""
        return self.speed_rpm * pi / 30.0 * self.point.scales.time

    @property
    def rotor_hz(self) -> float:
        """Frequency of the rotor's speed [Hz]."""
        return self.speed_rpm / 60.0

    @property
    def jeffcott(self) -> FullFilms:
        """[full_films] with masses, stiffness and unbalance of the machine where its shaft has a stiffness.

        Raises
        ------
        InputError
            One of them in [full_films] too.
        """
        films = self.full_films
        assert films is not None
        if self.shaft is None or self.shaft.stiffness is None or len(self.disc) != 1:
            return films
        disc = self.disc[0]
        for name in OF_JEFFCOTT:
            if name in films.model_fields_set:
                allowed = "left out: it is that of [shaft], [[disc]] and [[support]]"
                raise InputError(f"full_films.{name}", getattr(films, name), allowed)
        own = {
            "disc_mass": disc.mass,
            "journal_mass": sum(one.journal_mass for one in self.support),
            "shaft_stiffness": self.shaft.stiffness,
            "shaft_damping": self.shaft.damping,
            "disc_damping": disc.damping,
            "unbalance": disc.unbalance,
        }
        return films.model_copy(update=own)

    @property
    def free_motion(self) -> FreeVibration:
        """Motion of the free vibration."""
        assert self.contact is not None
        settings = self.contact.free
        _once("contact.free", "Omega_n", settings.Omega_n, settings.hz)
        if settings.hz is not None:
            return FreeVibration.at(self.point, hz=settings.hz)
        return FreeVibration(Omega_n=2.56 if settings.Omega_n is None else settings.Omega_n)

    @property
    def harmonic_motion(self) -> HarmonicLoad:
        """Motion in the contact's band."""
        assert self.contact is not None
        settings = self.contact.harmonic
        _once("contact.harmonic", "Omega", settings.Omega, settings.hz)
        if settings.hz is not None:
            return HarmonicLoad.at(self.point, hz=settings.hz, amplitude=settings.amplitude)
        return HarmonicLoad(Omega=pi if settings.Omega is None else settings.Omega, amplitude=settings.amplitude)

    @property
    def rotor_motion(self) -> HarmonicLoad:
        """Harmonic load at the rotor's speed."""
        assert self.contact is not None
        return HarmonicLoad(Omega=self.rotor_omega, amplitude=self.contact.rotor_band.amplitude)

    @property
    def largest_load(self) -> float:
        """Largest load of the motions, in static loads."""
        return max(m.largest_load for m in (self.free_motion, self.harmonic_motion, self.rotor_motion))

    def fingerprint(self, *parts: str) -> str:
        """Hash of what a stage depends on: the contact, its oil, version, and further parts.

        Parameters
        ----------
        *parts : str
            "grid", "free", "harmonic", "rotor_band" and "full_films".
        """
        from ehlcontact.cli.study.machine import dimensions_of

        assert self.contact is not None
        dump = self.contact.model_dump(exclude_none=True)
        dump["grid"] = {name: dump.pop(name) for name in ("n", "n_transient", "domain")}
        for section, name, value in (  # the same frequency, however it was given
            ("free", "Omega_n", self.free_motion.Omega_n),
            ("harmonic", "Omega", self.harmonic_motion.Omega),
        ):
            dump[section].pop("hz", None)
            dump[section][name] = value
        if self.full_films is not None:
            dump["full_films"] = self.jeffcott.model_dump(exclude={"half_step"})
        oil = {} if self.oil is None else self.oil.model_dump(exclude_none=True, exclude={"name"})
        bearing = dimensions_of(self, self.at), self.carrier.youngs_modulus, self.carrier.poisson_ratio
        contact = {"bearing": bearing, "race": self.contact.race, "speed": self.speed_rpm, "ball": self.ball}
        return key_of({"contact": contact, "oil": oil, **{name: dump[name] for name in parts}})


def _once(section: str, name: str, *given: float | None) -> None:
    if None not in given:
        raise InputError(
            f"{section}.hz", given[1], f"left out where {section}.{name} is given: one frequency, one name"
        )


def load_study(path: Path) -> Study:
    """Read and check a study file of one speed and load.

    Raises
    ------
    InputError
        No such file, not TOML, an unknown, missing or impossible entry, or a contact that the solvers are not made
        for; the line names file, field, value, allowed range and, where there is one, a likely slip.
    """
    document = read_toml(path, "study")
    try:
        return study_of(document)
    except InputError as error:
        raise InputError(f"{path}: {error.field}", error.value, error.allowed) from None


def study_of(document: dict[str, Any], *, at_rest: bool = False) -> Study:
    """The study of a document, checked; `at_rest`: its speed may be 0.

    Raises
    ------
    InputError
        As `load_study`, without the name of the file.
    """
    require_sections(document)
    try:
        study = Study.model_validate(document)
    except ValidationError as error:
        raise first_error(error, Study, document) from None
    if not at_rest:
        INPUTS["speed_rpm"].require("operation.speed_rpm", study.speed_rpm)
    from ehlcontact.cli.study.loads import require_machine
    from ehlcontact.cli.study.machine import support_field

    at = support_field(study, study.at, "").rstrip(".")
    given = inputs_of({at: study.carrier, "operation": study.operation, "oil": study.oil})
    try:
        for name in ("lubricant", "roughness"):
            getattr(study, name)  # made here once, so that what the library refuses is refused now
        _require_together(study)
        if study.contact is None:
            require_machine(study)
        else:
            for name in ("domain", "point", "free_motion", "harmonic_motion", "rotor_motion"):
                getattr(study, name)
            require_solvable(study.point, study.largest_load, given)
            if study.shaft is not None or study.operation.axial_load is not None or study.in_time is not None:
                require_machine(study)
    except InputError as error:
        names = ENTRIES | {"conformity": support_field(study, study.at, "conformity")}
        raise InputError(names.get(error.field, error.field), error.value, error.allowed) from None
    return study


def _require_together(study: Study) -> None:
    """Raise `InputError` for entries that are possible alone and impossible together."""
    from ehlcontact.cli.study.machine import carrier_of

    if study.shaft is None:
        for name, given in (("disc", study.disc), ("in_time", study.in_time)):
            if given:
                raise InputError("shaft", None, f"given, with {'[[disc]]' if name == 'disc' else '[in_time]'}")
        if len(study.support) > 1:
            raise InputError("shaft", None, f"given: {len(study.support)} bearings hold a shaft")
    else:
        for name in LOADS:
            if (value := getattr(study.operation, name)) is not None:
                where = (
                    ": disc.radial_load"
                    if name == "radial_load"
                    else ": disc.axial_load"
                    if "axial" in name
                    else ""
                )
                allowed = f"left out with [shaft], whose loads are weight and loads of discs{where}"
                raise InputError(f"operation.{name}", value, allowed)
    for name in {name for name in study.names if study.names.count(name) > 1}:
        raise InputError("support.name", name, "once: results are told by the name of the support")
    _ = study.at
    for k in range(len(study.support)):
        carrier_of(study, k, oil=False)
    if study.full_films is not None:
        if study.contact is None:
            raise InputError("contact", None, "given, with [full_films]: its films are those of that contact")
        films = study.jeffcott
        require_unbalance("full_films.unbalance", films.unbalance, films.disc_mass)
