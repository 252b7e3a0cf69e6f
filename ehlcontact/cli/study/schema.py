"""The study file: TOML, checked field by field before anything is computed."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cached_property
from math import cos, degrees, pi
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError

from ehlcontact.cli import entries as e
from ehlcontact.cli.entries import Section
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.schema_errors import first_error, in_other_kind, inputs_of
from ehlcontact.cli.toml import read_toml
from ehlcontact.content_store import key_of
from ehlcontact.errors import InputError
from ehlcontact.hertz import most_loaded_ball
from ehlcontact.lubricant import Lubricant
from ehlcontact.lubricant.oil import GRADES
from ehlcontact.point import OperatingPoint, require_solvable
from ehlcontact.solver.domain import Domain
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad
from reduced_models.bearing.catalogue import BY_DIMENSIONS, catalogue_row
from reduced_models.rotor.rotor import require_unbalance

BY_NUMBERS = ("eta0", "alpha")  # entries of an oil
BY_GRADE = ("iso_vg", "temperature", "viscosity_index", "density_15")
BY_SHEET = ("nu40", "nu100", "temperature", "density_15")  # of its data sheet
# As on the drum, and as people shorten it: "ISO VG 68", "VG68", "iso-vg 68", "68".
_GRADE = re.compile(r"(?:(?:iso[\s_-]*)?vg[\s_-]*|iso[\s_-]*)?(\d{1,4})", re.IGNORECASE)
ENTRIES = {  # as the library calls them
    "x_in": "solver.domain.0",
    "x_out": "solver.domain.1",
    "y_max": "solver.domain.2",
    "conformity": "bearing.conformity",
}


class Bearing(Section):
    """The bearing, its load and speed; the contact is that of its most loaded ball.

    Lists, as [1500.0, 3000.0], make a study of several points: every speed with every load.
    """

    catalogue: Annotated[
        e.Catalogue | None, e.meaning("name in the catalogue, in place of the dimensions below")
    ] = None
    name: Annotated[e.Text, e.meaning("as the report calls it")] = "ball bearing"
    balls: e.Balls
    ball_diameter_mm: e.BallDiameter
    pitch_diameter_mm: e.PitchDiameter
    conformity: e.Conformity
    race: e.Race = "inner"
    youngs_modulus: e.YoungsModulus = 2.06e11
    poisson_ratio: e.PoissonRatio = 0.3
    radial_load: Annotated[e.Load, e.meaning("radial load on this bearing, or a list")]
    speed_rpm: Annotated[e.Speed, e.meaning("speed of the shaft, or a list")]


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

    rq_ball_um: Annotated[e.Roughness | None, e.meaning("Rq of the balls; with rq_race_um or not at all")] = None
    rq_race_um: Annotated[e.Roughness | None, e.meaning("Rq of the races")] = None


class Solver(Section):
    """Grids and computed region. Finer ones take longer: `ehlcontact validate` says how long."""

    n: Annotated[e.Intervals, e.meaning("intervals along rolling, steady film")] = 128
    n_transient: Annotated[e.Intervals, e.meaning("intervals along rolling, every film in motion")] = 128
    domain: Annotated[
        tuple[e.Finite, e.Finite, e.Finite],
        Field(
            strict=False,
            description="inlet, outlet and half width in semi-axes of the contact; damping depends on it a little",
        ),
    ] = (-4.5, 1.5, 3.0)


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


class Rotor(Section):
    """Jeffcott rotor in two such bearings: it turns with its unbalance, and decays freely after a kick."""

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
    fit_amplitude: Annotated[
        e.Share, e.meaning("load at the rotor's speed that its element is fitted to, over the static load")
    ] = 0.25
    fit_periods: Annotated[e.Periods, e.meaning("periods of that load")] = 2.0
    fit_steps_per_period: e.Steps = 40


class WholeBearing(Section):
    """The same rotor on two whole bearings, a film with its memory under every ball: not without this section.

    With axial_load balls have contact angles, and bearings five degrees of freedom: loads and films of all balls,
    stiffness and damping, and vibrations of the rotor between them; then nothing is computed in time.
    The contact of the study is that of the most loaded ball, at its angle where the bearing has a contact angle.
    """

    conformity_other: Annotated[
        e.Conformity | None, e.meaning("of the race that [bearing] is not about; the same where left out")
    ] = None
    clearance_um: e.Clearance = 0.0
    revolutions: Annotated[
        e.Whole, Field(ge=10, le=1000, description="revolutions computed; the second half of them is shown")
    ] = 30
    steps_per_revolution: Annotated[e.Whole, Field(ge=200, le=10000, description="time steps in each of them")] = (
        500
    )
    axial_load: Annotated[
        e.Load | None,
        e.meaning("axial load on each of both bearings, from a spring on the outer ring of one of them"),
    ] = None
    moment_x: Annotated[
        e.Moment | None,
        e.meaning("moment on a bearing about x (horizontal): with it, or moment_y, its inner ring tilts freely"),
    ] = None
    moment_y: Annotated[e.Moment | None, e.meaning("moment about y (upwards)")] = None
    tilt_x_mrad: Annotated[
        e.Tilt | None, e.meaning("misalignment: tilt about x at which the inner ring of a bearing is held")
    ] = None
    tilt_y_mrad: Annotated[e.Tilt | None, e.meaning("the same about y")] = None
    contact_angle_deg: Annotated[
        e.ContactAngle | None,
        e.meaning(
            "free contact angle of an angular contact bearing; left out, that of bearing.catalogue, "
            "or of a deep-groove bearing from clearance_um"
        ),
    ] = None
    race_control: Annotated[
        e.RaceControl | None, e.meaning("what holds the gyroscopic moment of the balls; outer where left out")
    ] = None
    pair: Annotated[
        e.Arrangement | None,
        e.meaning("two such bearings hold the shaft at its left end, in this arrangement; the right one floats"),
    ] = None
    preload: Annotated[
        e.Preload | None, e.meaning("axial force between both of the pair at mounting, at rest and without films")
    ] = None
    distance_mm: Annotated[
        e.Distance | None, e.meaning("distance of the planes of the pair; side by side where left out")
    ] = None
    spall: Annotated[
        e.Text | None,
        e.meaning("spall whose force the report shows: race, mm along the track, um deep, as outer,0.5,0.3"),
    ] = None
    cage_slip_percent: Annotated[
        e.CageSlip | None,
        e.meaning("slip of the cage in orders and lines of the spall, of its speed with balls that roll"),
    ] = None
    span_mm: Annotated[
        e.Distance | None, e.meaning("distance of both bearings; 200 where left out with axial_load")
    ] = None
    layer_um: e.OilThickness | None = None
    layer_ratio: e.BearingLayerRatio | None = None
    thermal: Annotated[bool, e.meaning("films that heat up, beside isothermal ones")] = False


class Check(Section):
    """Checks of the study's own numbers: the error of its steps in time. They are done only if switched on."""

    half_step: Annotated[
        bool, e.meaning("the rotor on full films again with half the step; the study takes about twice as long")
    ] = False


class Study(Section):
    """A study file of one speed and load."""

    title: Annotated[e.Text, e.meaning("heads the report")] = "contact study"
    bearing: Bearing
    oil: Oil
    surface: Surface = Surface()
    solver: Solver = Solver()
    free: Free = Free()
    harmonic: Harmonic = Harmonic()
    rotor: Rotor = Rotor()
    whole_bearing: WholeBearing = WholeBearing()
    check: Check = Check()

    @cached_property
    def ball(self) -> tuple[float, float]:
        """Load [N] and contact angle [rad] of the most loaded ball at the race of the study, without films."""
        if self.whole_bearing.contact_angle_deg is None:
            return most_loaded_ball(self.bearing.radial_load, self.bearing.balls), 0.0
        from ehlcontact.cli.study.whole_bearing import heaviest_ball

        return heaviest_ball(self)

    @property
    def ball_load(self) -> float:
        """Load of the most loaded ball [N]."""
        return self.ball[0]

    @property
    def lubricant(self) -> Lubricant:
        """The oil as the solvers take it."""
        return self.oil.lubricant

    @property
    def roughness(self) -> tuple[float, float] | None:
        """Rq of ball and race [m], None where not given.

        Raises
        ------
        InputError
            Only one of them is given.
        """
        found = {"rq_ball_um": self.surface.rq_ball_um, "rq_race_um": self.surface.rq_race_um}
        given = {name: value * 1e-6 for name, value in found.items() if value is not None}
        if len(given) == 1:
            missing = next(name for name in found if name not in given)
            raise InputError(f"surface.{missing}", None, f"given, as {next(iter(given))} is")
        return (given["rq_ball_um"], given["rq_race_um"]) if given else None

    @property
    def domain(self) -> Domain:
        """Computed region."""
        return Domain(*self.solver.domain)

    @cached_property
    def point(self) -> OperatingPoint:
        """Operating point of the most loaded ball's contact.

        Curvature and surface speed at a contact angle a are those of the pitch diameter dm/cos a at n cos a.
        """
        b, (load, angle) = self.bearing, self.ball
        steel = {"e1": b.youngs_modulus, "nu1": b.poisson_ratio, "e2": b.youngs_modulus, "nu2": b.poisson_ratio}
        return OperatingPoint.ball_bearing(
            self.lubricant,
            ball_diameter=b.ball_diameter_mm * 1e-3,
            pitch_diameter=b.pitch_diameter_mm * 1e-3 / cos(angle),
            conformity=b.conformity,
            speed_rpm=b.speed_rpm * cos(angle),
            load=load,
            race=b.race,
            **steel,
        )

    @property
    def rotor_omega(self) -> float:
        """Dimensionless angular frequency of the rotor's speed."""
        return self.bearing.speed_rpm * pi / 30.0 * self.point.scales.time

    @property
    def rotor_hz(self) -> float:
        """Frequency of the rotor's speed [Hz]."""
        return self.bearing.speed_rpm / 60.0

    @property
    def free_motion(self) -> FreeVibration:
        """Motion of the free vibration."""
        _once("free", "Omega_n", self.free.Omega_n, self.free.hz)
        if self.free.hz is not None:
            return FreeVibration.at(self.point, hz=self.free.hz)
        return FreeVibration(Omega_n=2.56 if self.free.Omega_n is None else self.free.Omega_n)

    @property
    def harmonic_motion(self) -> HarmonicLoad:
        """Motion in the contact's band."""
        settings = self.harmonic
        _once("harmonic", "Omega", settings.Omega, settings.hz)
        if settings.hz is not None:
            return HarmonicLoad.at(self.point, hz=settings.hz, amplitude=settings.amplitude)
        return HarmonicLoad(Omega=pi if settings.Omega is None else settings.Omega, amplitude=settings.amplitude)

    @property
    def rotor_motion(self) -> HarmonicLoad:
        """Harmonic load at the rotor's speed."""
        return HarmonicLoad(Omega=self.rotor_omega, amplitude=self.rotor.fit_amplitude)

    @property
    def largest_load(self) -> float:
        """Largest load of the motions, in static loads."""
        return max(m.largest_load for m in (self.free_motion, self.harmonic_motion, self.rotor_motion))

    def fingerprint(self, *sections: str) -> str:
        """Hash of what a stage depends on: bearing and oil without their names, version, further sections."""
        dump = self.model_dump(exclude_none=True)  # so that an entry more in the schema changes nothing
        for section, name, value in (  # the same frequency, however it was given
            ("free", "Omega_n", self.free_motion.Omega_n),
            ("harmonic", "Omega", self.harmonic_motion.Omega),
        ):
            dump[section].pop("hz", None)
            dump[section][name] = value
        for section, key in (("bearing", "catalogue"), ("bearing", "name"), ("oil", "name")):
            dump[section].pop(key, None)
        if self.whole_bearing.contact_angle_deg is not None:
            dump["bearing"]["ball"] = self.ball
        return key_of({name: dump[name] for name in ("bearing", "oil", *sections)})


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


def study_of(document: dict[str, Any]) -> Study:
    """The study of a document, checked.

    Raises
    ------
    InputError
        As `load_study`, without the name of the file.
    """
    bearing = document.get("bearing")
    if isinstance(bearing, dict) and isinstance(bearing.get("catalogue"), str):
        entries = catalogue_entries(bearing["catalogue"])
        require_no_other(bearing, entries)
        document = document | {"bearing": entries | bearing} | _at_angle(document)
    try:
        study = Study.model_validate(document)
    except ValidationError as error:
        raise in_other_kind(first_error(error, Study), document, ("operation",), "bearing") from None
    given = inputs_of(study)
    try:
        _require_together(study)
        for name in ("domain", "lubricant", "roughness"):
            getattr(study, name)  # made here once, so that what the library refuses is refused now
        angular = study.whole_bearing.contact_angle_deg is not None
        if angular:
            _require_whole_bearing(study)
        for name in ("point", "free_motion", "harmonic_motion", "rotor_motion"):
            getattr(study, name)
        require_solvable(study.point, study.largest_load, given)
        if "whole_bearing" in study.model_fields_set and not angular:
            _require_whole_bearing(study)
    except InputError as error:
        raise InputError(ENTRIES.get(error.field, error.field), error.value, error.allowed) from None
    return study


def _require_whole_bearing(study: Study) -> None:
    from ehlcontact.cli.study.whole_bearing import require_whole_bearing

    require_whole_bearing(study)


def _at_angle(document: Mapping[str, Any]) -> dict[str, Any]:
    """Section [whole_bearing] with the contact angle of the catalogue; nothing for a deep-groove bearing.

    Raises
    ------
    InputError
        An angular contact bearing without an axial load.
    """
    name, angle = catalogue_angle(document["bearing"]["catalogue"])
    whole = document.get("whole_bearing", {})
    if angle is None or not isinstance(whole, dict):
        return {}
    if "axial_load" not in whole:
        allowed = f"given: {name} is an angular contact bearing, which carries axial load"
        raise InputError("whole_bearing.axial_load", None, allowed)
    return {"whole_bearing": {"contact_angle_deg": angle} | whole}


def catalogue_angle(name: str) -> tuple[str, float | None]:
    """Name as the catalogue has it, and contact angle of an angular contact bearing [degrees]."""
    known, row = catalogue_row(name)
    return known, None if row.contact_angle is None else round(degrees(row.contact_angle), 6)


def catalogue_entries(name: str) -> dict[str, Any]:
    """Entries of [bearing] that a name of the catalogue stands for.

    Raises
    ------
    InputError
        No such bearing; it names the nearest.
    """
    try:
        known, row = catalogue_row(name)
    except InputError as error:
        allowed = error.allowed.replace(BY_DIMENSIONS, "any other by its dimensions, balls = ...")
        raise InputError("bearing.catalogue", error.value, allowed) from None
    lengths = {"ball_diameter_mm": row.ball_diameter, "pitch_diameter_mm": row.pitch_diameter}
    in_mm = {key: round(1e3 * value, 6) for key, value in lengths.items()}  # 7.94, not 7.940000000000001
    return {"name": known, "balls": row.balls, **in_mm, "conformity": row.conformity}


def require_no_other(bearing: Mapping[str, Any], entries: Mapping[str, Any]) -> None:
    """Raise `InputError` for dimensions beside a name of the catalogue that are not those of that name.

    A conformity may be: it is each maker's own.
    """
    for key in ("balls", "ball_diameter_mm", "pitch_diameter_mm"):
        if bearing.get(key) not in (None, entries[key]):
            allowed = f"left out: catalogue = {bearing['catalogue']!r} has {entries[key]:g}"
            raise InputError(f"bearing.{key}", bearing[key], allowed)


def _require_together(study: Study) -> None:
    """Raise `InputError` for entries that are possible alone and impossible together."""
    bearing, rotor = study.bearing, study.rotor
    if not bearing.pitch_diameter_mm > bearing.ball_diameter_mm:
        allowed = f"above bearing.ball_diameter_mm = {bearing.ball_diameter_mm:g}"
        raise InputError("bearing.pitch_diameter_mm", bearing.pitch_diameter_mm, allowed)
    require_unbalance("rotor.unbalance", rotor.unbalance, rotor.disc_mass)
