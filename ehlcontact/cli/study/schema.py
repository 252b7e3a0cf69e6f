"""The study file: TOML, checked field by field before anything is computed."""

from __future__ import annotations

import hashlib
import json
import tomllib
from math import pi
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from ehlcontact.cli.contact import RQ_UM
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.slips import ROTOR, broken_line, first_error, in_other_kind, inputs_of
from ehlcontact.errors import InputError
from ehlcontact.files import read_text
from ehlcontact.hertz import most_loaded_ball
from ehlcontact.lubricant import Lubricant
from ehlcontact.point import OperatingPoint, require_solvable
from ehlcontact.solver.domain import Domain
from ehlcontact.transient.motion import FASTEST, SLOWEST, FreeVibration, HarmonicLoad
from ehlcontact.version import __version__
from reduced_models.bearing.catalogue import catalogue_row

MOST_ECCENTRIC = 0.01  # m of the disc's centre of mass: balanced rotors have some 1e-6, and none runs with more
ENTRIES = {  # as the library calls them
    "x_in": "solver.domain.0",
    "x_out": "solver.domain.1",
    "y_max": "solver.domain.2",
    "conformity": "bearing.conformity",
}

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Frequency = Annotated[float, Field(ge=SLOWEST, le=FASTEST, allow_inf_nan=False)]
Grid = Annotated[int, Field(ge=16, le=2048, multiple_of=16, strict=True)]
Steps = Annotated[int, Field(ge=20, le=2000, strict=True)]
Amplitude = Annotated[float, Field(gt=0.0, lt=1.0, allow_inf_nan=False)]
Roughness = Annotated[float, Field(ge=RQ_UM[0], le=RQ_UM[1], allow_inf_nan=False)]
Periods = Annotated[float, Field(ge=1.0, le=100.0, allow_inf_nan=False)]


class Section(BaseModel):
    """A section of a file: unknown keys are refused."""

    # strict: in a study `true` is no length of 1 mm, and "7.94" no number. A whole number is a number still.
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class Bearing(Section):
    """A radial ball bearing, by its dimensions or its name; the contact is that of its most loaded ball."""

    catalogue: str | None = None  # other entries replace those of the catalogue
    name: str = "ball bearing"
    balls: Annotated[int, Field(ge=3, le=200, strict=True)]
    ball_diameter_mm: Positive
    pitch_diameter_mm: Positive
    conformity: Annotated[float, Field(gt=0.5, le=10.0, allow_inf_nan=False)]
    race: Literal["inner", "outer"] = "inner"
    youngs_modulus: Positive = 2.06e11
    poisson_ratio: Annotated[float, Field(ge=0.0, le=0.5, allow_inf_nan=False)] = 0.3
    radial_load: Positive  # N on this bearing
    speed_rpm: Positive


class Oil(Section):
    """Oil at the temperature of the inlet: its numbers, or its grade and that temperature."""

    name: str = "oil"
    eta0: Positive | None = None  # Pa s
    alpha: Positive | None = None  # 1/Pa
    iso_vg: Annotated[int, Field(strict=True)] | None = None
    temperature: Finite | None = None  # C
    viscosity_index: Finite | None = None
    density_15: Finite | None = None  # kg/m3 at 15 C
    viscosity: Literal["roelands", "barus"] = "roelands"
    density: Literal["dowson-higginson", "incompressible"] = "dowson-higginson"

    @property
    def label(self) -> str:
        """Its name; by its grade where it has none of its own."""
        if self.iso_vg is None or "name" in self.model_fields_set:
            return self.name
        return f"ISO VG {self.iso_vg} at {numeral(self.temperature)} °C"

    @property
    def lubricant(self) -> Lubricant:
        """The oil as the solvers take it.

        Raises
        ------
        InputError
            Given in no way, in part, or in both ways; or an oil that the library refuses.
        """
        numbers, grade = ("eta0", "alpha"), ("iso_vg", "temperature", "viscosity_index", "density_15")
        given = [name for name in (*numbers, *grade) if getattr(self, name) is not None]
        by_grade = any(name in grade for name in given)
        if by_grade and any(name in numbers for name in given):
            extra = next(name for name in given if name in grade)
            allowed = "left out where eta0 or alpha are given: the oil is given by its numbers or by its grade"
            raise InputError(f"oil.{extra}", getattr(self, extra), allowed)
        missing = [name for name in (grade[:2] if by_grade else numbers) if name not in given]
        if missing:
            ways = "given: eta0 and alpha, or iso_vg and temperature in their place"
            raise InputError(f"oil.{missing[0]}", None, ways)
        laws = {"viscosity": self.viscosity, "density": self.density}
        if not by_grade:
            return Lubricant(self.eta0, self.alpha, **laws)  # type: ignore[arg-type]
        try:
            details = {name: getattr(self, name) for name in given if name != "iso_vg"}
            return Lubricant.iso_vg(self.iso_vg, **details, **laws)  # type: ignore[arg-type]
        except InputError as error:
            raise InputError(f"oil.{error.field}", error.value, error.allowed) from None


class Surface(Section):
    """Roughness of ball and race, for the lambda ratio alone: films are solved between smooth surfaces."""

    rq_ball_um: Roughness | None = None
    rq_race_um: Roughness | None = None


class Solver(Section):
    """Grids and region."""

    n: Grid = 128  # of the steady film
    n_transient: Grid = 128  # of every transient film
    domain: Annotated[tuple[Finite, Finite, Finite], Field(strict=False)] = (-4.5, 1.5, 3.0)  # TOML has lists


class Free(Section):
    """Free vibration of a mass on the contact, by its Omega_n or the frequency of small dry vibrations."""

    Omega_n: Frequency | None = None  # dimensionless; 2.56 where neither is given
    hz: Positive | None = None
    periods: Periods = 2.5
    steps_per_period: Steps = 80


class Harmonic(Section):
    """Harmonic load in the band of the contact's own vibrations."""

    Omega: Frequency | None = None  # dimensionless; pi where neither is given
    hz: Positive | None = None
    amplitude: Amplitude = 0.1
    periods: Periods = 3.0
    steps_per_period: Steps = 80


class Rotor(Section):
    """Jeffcott rotor in two such bearings, and the harmonic load at its speed that its element is fitted to."""

    arrangement: Literal["vee", "vertical"] = "vee"
    half_angle_deg: Annotated[float, Field(gt=0.0, lt=90.0, allow_inf_nan=False)] = 20.0
    disc_mass: Positive = 2.0  # kg
    journal_mass: Positive = 0.3  # kg, both journals
    shaft_stiffness: Positive = 2e8  # N/m
    shaft_damping: NotNegative = 60.0  # N s/m
    disc_damping: NotNegative = 1.0  # N s/m
    unbalance: Positive = 4e-5  # kg m
    revolutions: Annotated[int, Field(ge=2, le=100, strict=True)] = 3  # from near the settled motion on
    steps_per_revolution: Steps = 60
    kick: Amplitude = 0.05  # swing of the contacts' load after it, in their load at rest
    decay_periods: Annotated[float, Field(ge=4.0, le=100.0, allow_inf_nan=False)] = 8.0
    decay_steps_per_period: Steps = 40
    fit_amplitude: Amplitude = 0.25
    fit_periods: Periods = 2.0
    fit_steps_per_period: Steps = 40


class WholeBearing(Section):
    """The rotor on two whole bearings, two films with memory on every ball; left out, it is not run on them."""

    conformity_other: Annotated[float, Field(gt=0.5, le=10.0, allow_inf_nan=False)] | None = None  # None: the same
    clearance_um: Finite = 0.0  # radial internal clearance; below 0 the bearing is preloaded
    revolutions: Annotated[int, Field(ge=10, le=1000, strict=True)] = 30  # the second half of them is shown
    steps_per_revolution: Annotated[int, Field(ge=200, le=10000, strict=True)] = 500


class Check(Section):
    """Checks of the study's own numbers, which cost as much again and more; none unless they are switched on."""

    half_step: bool = False


class Study(Section):
    """Everything that a study file says."""

    title: str = "contact study"
    bearing: Bearing
    oil: Oil
    surface: Surface = Surface()
    solver: Solver = Solver()
    free: Free = Free()
    harmonic: Harmonic = Harmonic()
    rotor: Rotor = Rotor()
    whole_bearing: WholeBearing = WholeBearing()
    check: Check = Check()

    @property
    def ball_load(self) -> float:
        """Load of the most loaded ball [N]."""
        return most_loaded_ball(self.bearing.radial_load, self.bearing.balls)

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

    @property
    def point(self) -> OperatingPoint:
        """Operating point of the most loaded ball's contact."""
        b = self.bearing
        steel = {"e1": b.youngs_modulus, "nu1": b.poisson_ratio, "e2": b.youngs_modulus, "nu2": b.poisson_ratio}
        return OperatingPoint.ball_bearing(
            self.lubricant,
            ball_diameter=b.ball_diameter_mm * 1e-3,
            pitch_diameter=b.pitch_diameter_mm * 1e-3,
            conformity=b.conformity,
            speed_rpm=b.speed_rpm,
            load=self.ball_load,
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
        content = {name: dump[name] for name in ("bearing", "oil", *sections)}
        text = json.dumps([__version__, content], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]


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
    document = read_document(path)
    try:
        return study_of(document)
    except InputError as error:
        raise InputError(f"{path}: {error.field}", error.value, error.allowed) from None


def read_document(path: Path) -> dict[str, Any]:
    """What a study file says, not checked yet.

    Raises
    ------
    InputError
        No such file, or not TOML.
    """
    text = ""
    try:
        text = read_text(path)
        return tomllib.loads(text)
    except OSError as error:
        raise InputError("study", str(path), f"a readable TOML file ({error.strerror})") from None
    except (ValueError, RecursionError) as error:
        raise InputError("study", str(path), f"complete TOML ({broken_line(text, error)})") from None


def study_of(document: dict[str, Any]) -> Study:
    """Check what a study file says.

    Raises
    ------
    InputError
        As `load_study`, without the name of the file.
    """
    bearing = document.get("bearing")
    if isinstance(bearing, dict) and isinstance(bearing.get("catalogue"), str):
        document = document | {"bearing": catalogue_entries(bearing["catalogue"]) | bearing}
    try:
        study = Study.model_validate(document)
    except ValidationError as error:
        raise in_other_kind(first_error(error, Study), document, ("operation",), "bearing") from None
    given = inputs_of(study)
    try:
        for name, (value, quantity) in {**given, **inputs_of(study, ROTOR)}.items():
            quantity.require(name, value)
        _require_together(study)
        for name in ("domain", "point", "roughness", "free_motion", "harmonic_motion", "rotor_motion"):
            getattr(study, name)  # made here once, so that what the library refuses is refused now
        require_solvable(study.point, study.largest_load, given)
        if "whole_bearing" in study.model_fields_set:
            from ehlcontact.cli.study.whole_input import require_whole_bearing

            require_whole_bearing(study)
    except InputError as error:
        raise InputError(ENTRIES.get(error.field, error.field), error.value, error.allowed) from None
    return study


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
        allowed = f"{error.allowed.partition('; any other bearing')[0]}; any other by its dimensions, balls = ..."
        raise InputError("bearing.catalogue", error.value, allowed) from None
    lengths = {"ball_diameter_mm": row.ball_diameter, "pitch_diameter_mm": row.pitch_diameter}
    in_mm = {key: round(1e3 * value, 6) for key, value in lengths.items()}  # 7.94, not 7.940000000000001
    return {"name": known, "balls": row.balls, **in_mm, "conformity": row.conformity}


def _require_together(study: Study) -> None:
    """Raise `InputError` for entries that are possible alone and impossible together."""
    bearing, rotor = study.bearing, study.rotor
    if not bearing.pitch_diameter_mm > bearing.ball_diameter_mm:
        allowed = f"above bearing.ball_diameter_mm = {bearing.ball_diameter_mm:g}"
        raise InputError("bearing.pitch_diameter_mm", bearing.pitch_diameter_mm, allowed)
    if not rotor.unbalance <= MOST_ECCENTRIC * rotor.disc_mass:
        guess = ROTOR["rotor.unbalance"].slip(rotor.unbalance)
        allowed = (
            f"at most {MOST_ECCENTRIC * rotor.disc_mass:g} kg m, {1e3 * MOST_ECCENTRIC:g} mm times the disc's mass"
        )
        raise InputError("rotor.unbalance", rotor.unbalance, f"{allowed} ({guess})" if guess else allowed)
