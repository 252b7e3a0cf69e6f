"""Which contact a command is about: a ball of a bearing or on a disc in SI, or Moes' dimensionless numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property, partial
from math import sqrt
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import typer

from ehlcontact.asperities import Asperities
from ehlcontact.assumptions import Assumptions, assumptions
from ehlcontact.checks import require_between
from ehlcontact.checks.admissible_range import INPUTS, Given
from ehlcontact.cli import entries as e
from ehlcontact.cli.entries import entries_of, in_options
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.options import Options, Output, called, option_of, with_entries
from ehlcontact.cli.output import complain
from ehlcontact.cli.rows import Row, outside_rows
from ehlcontact.cli.study.schema import Oil, Study
from ehlcontact.errors import InputError
from ehlcontact.heat import RANGES, Heat
from ehlcontact.hertz import most_loaded_ball
from ehlcontact.lubricant import Eyring, LimitingShear, Lubricant, TractionLaw
from ehlcontact.lubricant.traction_laws import LARGEST_SLIDE_ROLL
from ehlcontact.point import MoesPoint, OperatingPoint, Point, require_solvable
from ehlcontact.shear_thinning import ShearThinning
from ehlcontact.supply import OilLayer

if TYPE_CHECKING:
    from ehlcontact.results import SteadyResult, Traction

_SI, _MOES, _OIL = "A ball of a bearing, in SI", "Or a point without dimensions", "The oil and its laws"
_DISC = "Or a ball on a disc, in SI (with --oil, --temp, --load)"
BESIDE = (
    "or a ball of a bearing: --bearing, --oil, --temp, --speed-rpm, --load; "
    "or a ball on a disc: --ball-diameter, --entrainment, --oil, --temp, --load"
)
NO_TIME = (
    "a point of --M --L --kappa has no unit of time; its frequencies are given as --Omega, 2a/u_sum times rad/s"
)


def known_bearings() -> list[str]:
    """Names of the catalogue, for the completion of a shell."""
    from reduced_models.bearing.catalogue import DEEP_GROOVE

    return list(DEEP_GROOVE)


_moes = partial(typer.Option, rich_help_panel=_MOES, show_default=False)
_disc = partial(typer.Option, rich_help_panel=_DISC, show_default=False)
_oil = partial(typer.Option, rich_help_panel=_OIL)
OIL_NAME = typer.Option("--oil", metavar="GRADE", help='ISO grade of a mineral oil, as "ISO VG 68".')


@with_entries(entries_of(Study, ("oil",), ("oil.name",)), {"oil": _OIL})
class Contact(Options):
    """Which contact it is: that of a bearing's most loaded ball, of a ball on a disc, or M, L and kappa."""

    panel: ClassVar[str | None] = _SI
    bearing: Annotated[
        e.Catalogue | None,
        typer.Option("--bearing", metavar="NAME", autocompletion=known_bearings, show_default=False),
    ] = None
    speed_rpm: Annotated[e.Speed | None, typer.Option("--speed-rpm", show_default=False)] = None
    load: Annotated[e.Load | None, typer.Option("--load", show_default=False)] = None
    race: Annotated[e.Race | None, typer.Option("--contact", metavar="RACE", show_default="inner")] = None
    ball_diameter: Annotated[e.BallDiameter | None, _disc("--ball-diameter", metavar="MM")] = None
    entrainment: Annotated[e.Entrainment | None, _disc("--entrainment", metavar="M/S")] = None
    flat: Annotated[e.Flat | None, _disc("--flat", metavar="MATERIAL", show_default="steel")] = None
    M: Annotated[float | None, _moes("--M"), e.meaning("Moes load parameter, > 0")] = None
    L: Annotated[float | None, _moes("--L"), e.meaning("Moes lubricant parameter, >= 0")] = None
    kappa: Annotated[float | None, _moes("--kappa"), e.meaning("ellipse ratio a/b, 0.01 to 100")] = None
    eta0: Annotated[e.Eta0 | None, _oil("--eta0", show_default="0.04, or the oil's")] = None
    alpha: Annotated[e.Alpha | None, _oil("--alpha", show_default="2.2e-8, or the oil's")] = None

    def _missing(self, name: str, beside: str = "") -> InputError:
        """The error for an option that has to be given."""
        field = type(self).model_fields[name]
        words = "; ".join(part for part in (e.meaning_of(field), e.allowed_of(field)) if part)
        return InputError(option_of(type(self), name), None, f"given ({words}){beside}")

    @property
    def in_si(self) -> bool:
        """Whether a ball of a bearing or on a disc is given: answers are in SI then."""
        return bool(self._of_bearing or self._of_disc)

    @property
    def _of_bearing(self) -> dict[str, Any]:
        return self.by_option("bearing", "oil", "nu40", "nu100", "temp", "load", "speed_rpm", "race")

    @property
    def _of_disc(self) -> dict[str, Any]:
        return self.by_option("ball_diameter", "entrainment", "flat")

    def point(self) -> Point:
        """Check the options and make the operating point of them.

        Raises
        ------
        InputError
            An option of a kind that is missing, or impossible; some of two kinds.
        """
        numbers = "M", "L", "kappa"
        given, of_bearing = self.by_option(*numbers), self._of_bearing
        if given and (of_bearing or self._of_disc):
            self._refuse_mixture(given, self._of_disc or of_bearing)
        if self._of_disc:
            return self._ball_on_disc()
        if of_bearing:
            return self._ball()
        for name in numbers:
            if getattr(self, name) is None:
                raise self._missing(name, f", {BESIDE}")
        laws = {name: getattr(self, name) for name in ("alpha", "eta0") if getattr(self, name) is not None}
        laws |= {name: law for name in ("viscosity", "density") if (law := getattr(self, name)) is not None}
        return MoesPoint(M=self.M, L=self.L, kappa=self.kappa, **laws)  # type: ignore[arg-type]

    @staticmethod
    def _refuse_mixture(numbers: dict[str, Any], of_bearing: dict[str, Any]) -> None:
        """Raise `InputError` for the option that is the odd one out."""
        if len(of_bearing) == 1:
            name, value = next(iter(of_bearing.items()))
            why = NO_TIME if name == "--speed-rpm" else "that is a point without dimensions"
            raise InputError(name, value, f"left out where {next(iter(numbers))} is given: {why}")
        name, value = next(iter(numbers.items()))
        other = next(iter(of_bearing))
        whose = (
            "a bearing"
            if other in ("--bearing", "--oil", "--nu40", "--nu100", "--temp", "--speed-rpm", "--load")
            else "a contact in SI"
        )
        raise InputError(name, value, f"left out where {other} is given: {whose} has its own")

    def _ball_on_disc(self) -> OperatingPoint:
        for name in ("--bearing", "--speed-rpm", "--contact"):
            if name in self._of_bearing:
                allowed = f"left out where {next(iter(self._of_disc))} is given: a ball on a disc is of no bearing"
                raise InputError(name, self._of_bearing[name], allowed)
        for name in ("ball_diameter", "entrainment", "load"):
            if getattr(self, name) is None:
                raise self._missing(name)
        modulus, ratio = e.FLATS[self.flat or "steel"]
        with self.called():
            return OperatingPoint.ball_on_flat(
                self.lubricant(),
                ball_diameter=1e-3 * (self.ball_diameter or 0.0),
                entrainment_speed=self.entrainment or 0.0,
                load=self.load or 0.0,
                e2=modulus,
                nu2=ratio,
            )

    def _ball(self) -> OperatingPoint:
        from reduced_models.bearing.catalogue import BY_DIMENSIONS, deep_groove_row

        for name in ("bearing", "speed_rpm", "load"):
            if getattr(self, name) is None:
                raise self._missing(name)
        try:
            _, row = deep_groove_row(self.bearing or "")
        except InputError as error:
            dimensions = "any other by its dimensions, in a study as `ehlcontact init` writes it"
            allowed = error.allowed.replace(BY_DIMENSIONS, dimensions)
            raise InputError("--bearing", error.value, allowed) from None
        assert self.speed_rpm is not None
        with self.called():
            return OperatingPoint.ball_bearing(
                self.lubricant(),
                ball_diameter=row.ball_diameter,
                pitch_diameter=row.pitch_diameter,
                conformity=row.conformity,
                speed_rpm=self.speed_rpm,
                load=most_loaded_ball(self.load or 0.0, row.balls),
                race=self.race or "inner",
            )

    def lubricant(self) -> Lubricant:
        """The oil of a bearing: by its grade and temperature, or by its numbers.

        Raises
        ------
        InputError
            Given in no way, in part, or in both ways; an oil that the library refuses.
        """
        try:
            return self._sheet.lubricant
        except InputError as error:
            field, allowed = (in_options(text, self.ENTRIES.values()) for text in (error.field, error.allowed))
            raise InputError(field, error.value, allowed) from None

    @property
    def _sheet(self) -> Oil:
        """The oil as a study has it."""
        return Oil(**{entry.removeprefix("oil."): value for entry, value in self.entries().items()})

    @contextmanager
    def called(self) -> Iterator[None]:
        """Let an `InputError` about a ball's point not name options that were not given."""
        if not self.in_si:
            yield
            return
        names = {name: f"{name} of this contact" for name in ("M", "L", "kappa")}
        if not self._of_disc:
            names |= {"load": "load of the ball"}
        names |= {name: f"{name} of the oil" for name in ("eta0", "alpha") if getattr(self, name) is None}
        with called(**names):
            yield

    def solvable(self) -> Point:
        """The point, for a solver: also refused is what no solver is made for."""
        point = self.point()
        with self.called():
            require_solvable(point, 1.0, self._given())
        return point

    def _given(self) -> Given | None:
        """What a user gave in place of a point's own inputs."""
        if not self.in_si:
            return None
        values = {"--load": (self.load, "load"), "--speed-rpm": (self.speed_rpm, "speed_rpm")}
        values |= {"--eta0": (self.eta0, "eta0"), "--alpha": (self.alpha, "alpha")}
        values |= {"--entrainment": (self.entrainment, "entrainment_speed")}
        return {name: (value, INPUTS[key]) for name, (value, key) in values.items() if value is not None}

    def about(self, point: Point) -> dict[str, Any]:
        """For JSON: whose contact it is; nothing of a dimensionless point."""
        if not isinstance(point, OperatingPoint):
            return {}
        oil = {"name": self._oil_name(), "eta0": point.lubricant.eta0, "alpha": point.lubricant.alpha}
        of_ball: dict[str, Any] = {"bearing": self._name, "race": self.race or "inner"}
        of_ball |= {"speed_rpm": self.speed_rpm, "radial_load": self.load}
        if self._of_disc:
            of_ball = {"ball_diameter": 2.0 * point.geometry.radius_x, "flat": self.flat or "steel"}
            of_ball |= {"entrainment_speed": self.entrainment}
        numbers = {"ball_load": point.load, "u_sum": point.u_sum, "p_hertz": point.scales.pressure, "oil": oil}
        return {"contact": of_ball | numbers}

    def rows(self, point: Point) -> list[Row]:
        """Rows of a table that say which contact this is."""
        if not isinstance(point, OperatingPoint):
            return [("M, L, kappa", ", ".join(map(numeral, (point.M, point.L, point.kappa))), "")]
        s, oil = point.scales, point.lubricant
        ellipse = f"{numeral(2e3 * s.a, 3)} x {numeral(2e3 * s.b, 3)} mm"
        if self._of_disc:
            ball = f"steel ball of {numeral(self.ball_diameter)} mm on {self.flat or 'steel'}"
            whose = [("contact", ball, f"under {numeral(point.load)} N")]
            whose += [("entrainment", f"{numeral(self.entrainment)} m/s", "mean of both surface speeds")]
        else:
            ball = f"{numeral(point.load)} N of {numeral(self.load)} N: the most loaded ball, without clearance"
            rolls = f"surfaces roll at {numeral(point.u_sum / 2.0)} m/s each"
            whose = [("contact", f"{self._name}, {self.race or 'inner'} race", ball)]
            whose += [("speed", f"{numeral(self.speed_rpm)} rpm", rolls)]
        return [
            *whose,
            ("oil", self._oil_name(), f"{numeral(oil.eta0, 3)} Pa s, alpha {numeral(oil.alpha, 3)} 1/Pa"),
            ("Hertz pressure", f"{numeral(s.pressure * 1e-9, 3)} GPa", f"on {ellipse}, along and across rolling"),
            ("M, L, kappa", ", ".join(numeral(getattr(point.moes, k)) for k in ("M", "L", "kappa")), ""),
        ]

    @property
    def description(self) -> str:
        """Bearing, race, load, speed and oil in one line; empty for a dimensionless point."""
        if not self.in_si:
            return ""
        oil = f"oil of {numeral(self.eta0)} Pa s" if self.eta0 is not None else self._oil_name()
        if self._of_disc:
            ball = f"steel ball of {numeral(self.ball_diameter)} mm on {self.flat or 'steel'}"
            return f"{ball}, {numeral(self.load)} N, entrainment {numeral(self.entrainment)} m/s, {oil}"
        ball = f"most loaded ball of {numeral(self.load)} N at {numeral(self.speed_rpm)} rpm"
        return f"{self._name}, {self.race or 'inner'} race, {ball}, {oil}"

    @property
    def _name(self) -> str:
        return (self.bearing or "").strip().upper()

    def _oil_name(self) -> str:
        return self._sheet.label if self.eta0 is None else "by its numbers"


class Surfaces(Options):
    """How rough ball and race are, for the lambda ratio: films are solved between smooth surfaces."""

    panel: ClassVar[str | None] = _SI
    rq: Annotated[
        e.Roughness | None,
        typer.Option(
            "--rq", help="Roughness of ball and race together, µm: how many times higher the film is (lambda)."
        ),
    ] = None

    def check(self, contact: Contact) -> None:
        """Raise `InputError` for a roughness at a point without a unit of length."""
        if self.rq is not None and not contact.in_si:
            raise InputError("--rq", self.rq, "left out: a point of --M --L --kappa has no unit of length")

    def lambda_ratio(self, h_min: float) -> float | None:
        """Smallest film [m] over roughness; None where none was given."""
        return None if self.rq is None else h_min / (1e-6 * self.rq)

    def rows(self, h_min: float) -> list[Row]:
        """For a table: the lambda ratio where a roughness was given."""
        ratio = self.lambda_ratio(h_min)
        said = f"smallest film over a roughness of {numeral(self.rq)} µm"
        return [] if ratio is None else [("lambda", numeral(ratio, 3), said)]

    def about(self, h_min: float) -> dict[str, float]:
        """For JSON, likewise."""
        ratio = self.lambda_ratio(h_min)
        return {} if ratio is None else {"lambda_ratio": ratio}


class Mixed(Options):
    """Whether asperities carry beside the film."""

    panel: ClassVar[str | None] = _SI
    asperities: Annotated[
        bool, typer.Option("--asperities", help="Let asperities carry part of the load; with --rq.")
    ] = False

    def chosen(self, surfaces: Surfaces) -> Asperities | None:
        """The asperities, or None for smooth surfaces.

        Raises
        ------
        InputError
            No roughness, or none at all.
        """
        if not self.asperities:
            return None
        if not surfaces.rq:
            raise InputError(
                "--asperities", True, "given with --rq above 0, the roughness of ball and race together"
            )
        return Asperities(1e-6 * surfaces.rq)


_supply = partial(typer.Option, rich_help_panel="Oil supply (flooded if left out)", help=None)
_slides = partial(typer.Option, rich_help_panel="Sliding (pure rolling if left out)")


class FilmConditions(Options):
    """How much oil reaches the contact, whether the film heats up, whether the surfaces slide."""

    layer: Annotated[e.OilThickness | None, _supply("--layer")] = None
    layer_ratio: Annotated[e.LayerRatio | None, _supply("--layer-ratio")] = None
    thermal: Annotated[
        bool,
        typer.Option(
            "--thermal",
            rich_help_panel="Heat (isothermal if left out)",
            help="Let the film heat up and its viscosity follow; with --oil and --temp.",
        ),
    ] = False
    slide_roll: Annotated[
        float | None,
        _slides(
            "--slide-roll",
            show_default="0",
            help="Slide-to-roll ratio, difference over mean of the surface speeds: 0 to 2, with --thermal 0 to 1.",
        ),
    ] = None
    eyring: Annotated[
        float | None, _slides("--eyring-mpa", show_default="5", help="Eyring stress of the oil, MPa.")
    ] = None
    limiting_shear: Annotated[
        float | None,
        _slides(
            "--limiting-shear", help="Limiting shear stress over pressure, as 0.05, in place of Eyring's law."
        ),
    ] = None
    thinning: Annotated[
        bool, _slides("--thinning", help="Shear thinning of the film by sliding, by Eyring's law.")
    ] = False

    def chosen(self, contact: Contact, *, traction: bool = False) -> dict[str, Any]:
        """``supply``, ``thermal`` and ``sliding`` for a solver.

        Parameters
        ----------
        contact : Contact
        traction : bool
            Whether the traction of the film is an answer of the command, and not only what sliding makes of it.

        Raises
        ------
        InputError
            Options that exclude each other; lengths, heat or stress at a point without units; an oil without its
            temperature; sliding without heat, thinning or traction.
        """
        supply = self._layer_of(contact)
        self._check_sliding(contact, traction=traction)
        return {"supply": supply, "sliding": self._thinned(), "thermal": self._heat(contact)}

    def traction(self, film: SteadyResult) -> Traction | None:
        """Traction of a film that has converged; None in pure rolling."""
        return None if self.slide_roll is None or not film.status.ok else film.traction(self.slide_roll, self._law)

    def _layer_of(self, contact: Contact) -> OilLayer | None:
        if self.layer is not None and self.layer_ratio is not None:
            raise InputError("--layer", self.layer, "given without --layer-ratio")
        if self.layer is not None and not contact.in_si:
            allowed = "--layer-ratio instead: a point of --M --L --kappa has no unit of length"
            raise InputError("--layer", self.layer, allowed)
        if self.layer is not None:
            return OilLayer(1e-6 * self.layer)
        return None if self.layer_ratio is None else OilLayer(over_flooded=self.layer_ratio)

    def _heat(self, contact: Contact) -> Heat | None:
        if not self.thermal:
            return None
        if not contact.in_si:
            allowed = "left out: a point of --M --L --kappa has no metres, seconds and kelvin"
            raise InputError("--thermal", True, allowed)
        if "oil.iso_vg" not in contact.entries():
            allowed = (
                "given with --oil and --temp: an oil by its grade has the change of viscosity with temperature"
            )
            raise InputError("--thermal", True, allowed)
        if not isinstance(self._law, Eyring):
            allowed = "left out with --thermal: Eyring's stress heats the film (--eyring-mpa)"
            raise InputError("--limiting-shear", self.limiting_shear, allowed)
        return Heat(slide_roll=self.slide_roll or 0.0, eyring_stress=self._law.stress)

    @property
    def _law(self) -> TractionLaw:
        """Traction law; raises `InputError` for numbers out of range, or both laws."""
        if self.limiting_shear is None:
            stress = 5.0 if self.eyring is None else require_between("--eyring-mpa", self.eyring, 0.1, 1000.0)
            return Eyring(1e6 * stress)
        if self.eyring is not None:
            raise InputError("--eyring-mpa", self.eyring, "left out with --limiting-shear: one traction law")
        return LimitingShear(require_between("--limiting-shear", self.limiting_shear, 1e-3, 0.5))

    def _check_sliding(self, contact: Contact, *, traction: bool) -> None:
        """Raise `InputError` for sliding that has no traction, or no heat, before anything is solved."""
        if self.slide_roll is None:
            still = "left out without --slide-roll: in pure rolling nothing slides"
            thin = "given with --slide-roll: in pure rolling nothing thins the oil"
            for name, value in (("--eyring-mpa", self.eyring), ("--limiting-shear", self.limiting_shear)):
                if value is not None:
                    raise InputError(name, value, still)
            if self.thinning:
                raise InputError("--thinning", True, thin)
            return
        most = RANGES["slide_roll"][1] if self.thermal else LARGEST_SLIDE_ROLL
        require_between("--slide-roll", self.slide_roll, 0.0, most)
        if not contact.in_si:
            allowed = "left out: a point of --M --L --kappa has no pascals, which a traction law needs"
            raise InputError("--slide-roll", self.slide_roll, allowed)
        self._law  # noqa: B018  # which checks its numbers
        if not (traction or self.thermal or self.thinning):
            allowed = "given with --thermal or --thinning: else it changes nothing of this film"
            raise InputError("--slide-roll", self.slide_roll, allowed)

    def _thinned(self) -> ShearThinning | None:
        if not self.thinning:
            return None
        if self.limiting_shear is not None:
            allowed = "left out with --thinning: it leaves no viscosity along the sliding (--eyring-mpa)"
            raise InputError("--limiting-shear", self.limiting_shear, allowed)
        return ShearThinning(self.slide_roll or 0.0, self._law)


@dataclass(frozen=True)
class ContactAnswer:
    """Answer of a command about a contact: whose it is, assumptions that do not hold, lambda, and the result."""

    contact: Contact
    point: Point
    result: Any  # with `to_dict`
    film: Any  # for the assumptions; None where they are those of the formulas
    surfaces: Surfaces | None = None
    h_min: float = 0.0  # of the film over which lambda is

    @cached_property
    def assumptions(self) -> Assumptions:
        """At this contact with its oil, and with the roughness where one is given."""
        rq = None if self.surfaces is None or self.surfaces.rq is None else 1e-6 * self.surfaces.rq / sqrt(2.0)
        rough = None if rq is None else (rq, rq)
        domain = None if self.film is not None else getattr(self.result, "domain", None)
        return assumptions(self.point, film=self.film, roughness=rough, domain=domain)

    def deliver(
        self, out: Output, title: str, rows: Sequence[Row], *, judged: bool = True, more: Any = None, **files: Any
    ) -> None:
        """Write and show it: rows of the contact, of what does not hold, and those given.

        Parameters
        ----------
        out : Output
        title : str
        rows : sequence of Row
        judged : bool
            False where a film that has not converged says nothing of assumptions.
        more : mapping, optional
            Further entries of the JSON.
        **files
            As of `Output.deliver`.
        """
        about = self.contact.about(self.point) | (more or {})
        shown = [*self.contact.rows(self.point), *(outside_rows(self.assumptions) if judged else ()), *rows]
        if self.surfaces is not None and isinstance(self.point, OperatingPoint):
            about |= self.surfaces.about(self.h_min)
            shown += self.surfaces.rows(self.h_min)
        about["outside_assumptions"] = self.assumptions.headline if judged else ""
        out.deliver({**self.result.to_dict(), **about}, (title, shown), **files)
        for text in (getattr(self.result, name, "") for name in ("negative_damping", "reservation")):
            if text:
                complain(f"warning: {text}")


class Frequencies(Options):
    """Frequencies of small vibrations, by one of their four names."""

    panel: ClassVar[str | None] = "Frequency (one name; each option once per frequency)"
    Omega: Annotated[
        list[float] | None,
        typer.Option("--Omega", help="Dimensionless angular frequency (unit of time 2a/u_sum), >= 0."),
    ] = None
    omega: Annotated[list[float] | None, typer.Option("--omega", help="Of a bearing's contact, rad/s.")] = None
    hz: Annotated[
        list[float] | None,
        typer.Option("--hz", show_default="that of the shaft", help="Of a bearing's contact, Hz."),
    ] = None
    rpm: Annotated[list[float] | None, typer.Option("--rpm", help="Of a bearing's contact, turns per minute.")] = (
        None
    )

    @property
    def given(self) -> dict[str, list[float]]:
        """The frequencies by their names."""
        return {name: values for name, values in self.model_dump().items() if values}

    def named(self, contact: Contact) -> dict[str, Any]:
        """The frequencies by their one name; of a bearing that of the shaft where none is given.

        Raises
        ------
        InputError
            Two names; none, or one with a unit, at a point without a unit of time.
        """
        first, *others = self.given or ("rpm" if contact.speed_rpm is not None else "Omega",)
        values = self.given.get(first)
        if others:
            allowed = f"left out where --{first} is given: a frequency has one name"
            raise InputError(f"--{others[0]}", self.given[others[0]], allowed)
        if first != "Omega" and not contact.in_si:
            raise InputError(f"--{first}", values, f"left out: {NO_TIME}")
        if values is None and contact.in_si and contact.speed_rpm is None:
            raise InputError(
                "--hz", None, "given, or another frequency: a ball on a disc has no shaft whose it could be"
            )
        if values is None and not contact.in_si:
            raise InputError(
                "--Omega", None, "given: a dimensionless angular frequency (unit of time 2a/u_sum), >= 0"
            )
        return {first: values or [contact.speed_rpm or 0.0]}
