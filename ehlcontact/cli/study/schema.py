"""The study file: TOML, checked field by field before anything is computed."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cached_property
from math import cos, hypot, pi
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, ValidationError, field_validator

from ehlcontact.checks.admissible_range import INPUTS
from ehlcontact.cli import entries as e
from ehlcontact.cli.entries import Section
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.parts import Part
from ehlcontact.cli.study.schema_errors import first_error, inputs_of, names_of, require_sections
from ehlcontact.cli.study.sections import (
    Contact,
    Damper,
    Defect,
    Disc,
    Electric,
    Export,
    FullFilms,
    InTime,
    Operation,
    Periodic,
    Shaft,
    Support,
    Surface,
    Uncertain,
)
from ehlcontact.cli.toml import read_toml
from ehlcontact.content_store import key_of
from ehlcontact.errors import InputError
from ehlcontact.lubricant import Lubricant
from ehlcontact.lubricant.oil import GRADES
from ehlcontact.point import OperatingPoint, require_solvable
from ehlcontact.solver.domain import Domain
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad
from reduced_models.life.life_modification import require_contamination
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

    @field_validator("iso_vg", mode="before")
    @classmethod
    def _grade_of_name(cls, value: Any) -> Any:
        """The grade of a name, 100 of "ISO VG 100", as `--oil` takes it; a number in quotes stays refused."""
        found = _GRADE.fullmatch(value.strip()) if isinstance(value, str) else None
        return value if found is None or value.strip() == found[1] else int(found[1])

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
        return lubricant_of(*self._given)

    @property
    def part(self) -> Part:
        """The call that makes `lubricant`."""
        return oil_part(*self._given)

    @property
    def _given(self) -> tuple[dict[str, Any], dict[str, str], Callable[[str], str]]:
        given = {name: getattr(self, name) for name in {*BY_NUMBERS, *BY_GRADE, *BY_SHEET}}
        return given, {"viscosity": self.viscosity, "density": self.density}, lambda name: f"oil.{name}"


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
    part = oil_part(given, laws, called)
    try:
        found: Lubricant = part.made()
    except InputError as error:
        raise InputError(called(error.field), error.value, error.allowed) from None
    return found


def oil_part(given: Mapping[str, Any], laws: Mapping[str, str], called: Callable[[str], str]) -> Part:
    """The call that makes the oil of `lubricant_of`, whose arguments and errors it has."""
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
    if own is BY_GRADE:
        grade = known.pop("iso_vg")
        return Part(Lubricant, {**known, **laws}, "iso_vg", (grade,))
    return Part(Lubricant, {**known, **laws}, "" if own is BY_NUMBERS else "from_viscosities")


def oil_grade(text: str, field: str, others: str = "its eta0 and alpha") -> int:
    """The grade in the name of an oil, 68 of "ISO VG 68"; `field` is what it was given as, for the message.

    `others` are what any other oil is given by.

    Raises
    ------
    InputError
        Any other name, or a grade that the library does not have.
    """
    found = _GRADE.fullmatch(text.strip())
    if found is None or int(found[1]) not in GRADES:
        *most, last = map(str, GRADES)
        raise InputError(field, text, f"ISO VG {', '.join(most)} or {last}; any other oil by {others}")
    return int(found[1])


class Study(Section):
    """A study file of one speed and load."""

    title: Annotated[e.Text, e.meaning("heads the report")] = "study of a machine"
    operation: Operation
    oil: Oil | None = None
    surface: Surface = Surface()
    electric: Electric = Electric()
    shaft: Shaft | None = None
    disc: Annotated[tuple[Disc, ...], Field(strict=False)] = ()
    support: Annotated[tuple[Support, ...], Field(strict=False, min_length=1)]
    damper: Annotated[tuple[Damper, ...], Field(strict=False)] = ()
    contact: Contact | None = None
    full_films: FullFilms | None = None
    in_time: InTime | None = None
    periodic: Periodic | None = None
    defect: Annotated[tuple[Defect, ...], Field(strict=False)] = ()
    uncertain: Uncertain | None = None
    export: Export | None = None

    @property
    def speed_rpm(self) -> float:
        """Speed of the shaft [rev/min]."""
        return self.operation.speed_rpm

    @cached_property
    def highest_rpm(self) -> float:
        """Highest speed of the shaft [rev/min], with that of [uncertain]."""
        from ehlcontact.cli.study.uncertain import highest_of

        return highest_of(self, "operation.speed_rpm", self.speed_rpm)

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
    def loads_at_rest(self) -> Any:
        """Loads on the ball bearings of the machine at rest, once for all that asks for them."""
        from ehlcontact.cli.study.loads import loads_at_rest

        return loads_at_rest(self)

    @cached_property
    def sample_rows(self) -> list[list[float]]:
        """Values of the uncertain entries of all samples, with [uncertain]."""
        from ehlcontact.cli.study.uncertain import rows_of

        return rows_of(self)

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
            allowed = f"given, as {next(iter(given))} is; or rq_um in place of both, of ball and race together"
            raise InputError(f"surface.{missing}", None, allowed)
        return (given["rq_ball_um"], given["rq_race_um"]) if given else None

    @property
    def contamination(self) -> float | str | None:
        """Of the oil, for the modified rating life: factor or class; None where it is not given.

        Raises
        ------
        InputError
            No such class.
        """
        given = self.operation.contamination
        try:
            return None if given is None else require_contamination(given)
        except InputError as error:
            raise InputError("operation.contamination", given, error.allowed) from None

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
        from ehlcontact.cli.study.machine import disc_of

        disc, balanced = self.disc[0], disc_of(self, 0)
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
            "unbalance": balanced.unbalance,
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
    from ehlcontact.cli.study.exports import require_export
    from ehlcontact.cli.study.loads import require_machine
    from ehlcontact.cli.study.machine import support_field
    from ehlcontact.cli.study.periodic import require_periodic
    from ehlcontact.cli.study.uncertain import require_uncertain

    at = support_field(study, study.at, "").rstrip(".")
    given = inputs_of({at: study.carrier, "operation": study.operation, "oil": study.oil})
    try:
        for name in ("lubricant", "roughness", "contamination"):
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
        require_export(study)
        require_periodic(study)
        require_uncertain(study)
    except InputError as error:
        names = ENTRIES | {"conformity": support_field(study, study.at, "conformity")}
        raise InputError(names.get(error.field, error.field), error.value, error.allowed) from None
    return study


def _require_together(study: Study) -> None:
    """Raise `InputError` for entries that are possible alone and impossible together."""
    from ehlcontact.cli.study.machine import carrier_of

    if study.shaft is None:
        parts = {"[[disc]]": study.disc, "[[damper]]": study.damper, "[in_time]": study.in_time}
        for name, given in (*parts.items(), ("[periodic]", study.periodic)):
            if given:
                raise InputError("shaft", None, f"given, with {name}")
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
