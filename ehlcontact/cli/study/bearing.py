"""The file of ``ehlcontact bearing``: a ball bearing, its oil, load and speeds; options replace its entries."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, StrictBool, ValidationError

from ehlcontact.cli import entries as e
from ehlcontact.cli.entries import Section
from ehlcontact.cli.spall import OPTION, require_fit
from ehlcontact.cli.study.points.lists import require_apart
from ehlcontact.cli.study.schema import Oil
from ehlcontact.cli.study.schema_errors import first_error, in_other_kind
from ehlcontact.cli.study.shared_entries import moments_of, pair_of, supply_and_heat, tilt_of
from ehlcontact.cli.toml import read_toml
from ehlcontact.errors import InputError
from reduced_models import BallBearing, BearingSet
from reduced_models.bearing.catalogue import BY_DIMENSIONS, designation_of
from reduced_models.bearing.designation import Designation

if TYPE_CHECKING:
    from ehlcontact import Heat, OilLayer
    from reduced_models import Spall
    from reduced_models.bearing.coefficients import BearingCoefficients
    from reduced_models.bearing.equilibrium_result import BearingState
    from reduced_models.bearing.excitation import BearingExcitation
    from reduced_models.bearing.oil_and_heat import OilAndHeat
    from reduced_models.bearing.set_result import SetState

OPTIONS = {
    "--load": "operation.radial_load",
    "--axial": "operation.axial_load",
    "--moment-x": "operation.moment_x",
    "--moment-y": "operation.moment_y",
    "--tilt-x": "operation.tilt_x_mrad",
    "--tilt-y": "operation.tilt_y_mrad",
    "--speed-rpm": "operation.speed_rpm",
    "--hz": "operation.hz",
    "--layer-ratio": "operation.layer_ratio",
    "--layer": "operation.layer_um",
    "--thermal": "operation.thermal",
    "--pair": "pair.arrangement",
    "--preload": "pair.preload",
    "--spring": "pair.spring",
    "--distance-mm": "pair.distance_mm",
    "--contact-angle": "bearing.contact_angle_deg",
    "--race-control": "bearing.race_control",
    "--oil": "oil.iso_vg",
    "--nu40": "oil.nu40",
    "--nu100": "oil.nu100",
    "--temp": "oil.temperature",
    "--clearance": "bearing.clearance_um",
    "--rq": "surface.rq_um",
}
# What the library calls some entries.
ENTRIES = {
    "load": "operation.radial_load",
    "speed_rpm": "operation.speed_rpm",
    "name": "bearing.catalogue",
    "balls": "bearing.balls",
    "conformity_inner": "bearing.conformity_inner",
    "conformity_outer": "bearing.conformity_outer",
    "clearance": "bearing.clearance_um",
    "loss_factor": "bearing.loss_factor",
    "contact_angle": "bearing.contact_angle_deg",
    "tilt": "operation.tilt_x_mrad",
    "hz": "operation.hz",
    "arrangement": "pair.arrangement",
    "preload": "pair.preload",
    "spring": "pair.spring",
    "preload and spring": "pair.spring",
}
OF_OIL = "--oil", "--nu40", "--nu100", "--temp"
LOADS = "--load", "--axial", "--moment-x", "--moment-y"
AXIAL = "axial_load", "moment_x", "moment_y", "tilt_x_mrad", "tilt_y_mrad"  # with these, balls have contact angles
STUDY = ("free", "harmonic", "rotor", "solver")  # sections that only a study has
NEEDED = ("balls", "ball_diameter_mm", "pitch_diameter_mm")  # of a bearing without a name


class Bearing(Section):
    """A bearing of the catalogue, with other values where they are given; or its dimensions."""

    catalogue: str | None = None
    name: e.Text | None = None
    balls: e.Balls | None = None
    ball_diameter_mm: e.BallDiameter | None = None
    pitch_diameter_mm: e.PitchDiameter | None = None
    conformity_inner: e.Conformity | None = None
    conformity_outer: e.Conformity | None = None
    clearance_um: e.Clearance | str | None = None  # or a class, as CN
    contact_angle_deg: e.ContactAngle | None = None
    race_control: e.RaceControl | None = None
    cutoff_gap_um: e.Positive | None = None
    loss_factor: e.NotNegative | None = None  # of rings and fits
    ball_inertia: StrictBool | None = None  # balls vibrate between the rings
    youngs_modulus: e.YoungsModulus | None = None
    poisson_ratio: e.PoissonRatio | None = None


class Surface(Section):
    """Roughness for the lambda ratio: of ball and race, or of both together."""

    rq_ball_um: e.Roughness | None = None
    rq_race_um: e.Roughness | None = None
    rq_um: e.Roughness | None = None


class Operation(Section):
    """What the bearing carries, and how fast the shaft turns."""

    radial_load: e.NotNegative | None = None  # N, downwards; 0 where it is left out beside an axial load
    axial_load: e.AxialLoad | None = None
    moment_x: e.Moment | None = None
    moment_y: e.Moment | None = None
    tilt_x_mrad: e.Tilt | None = None
    tilt_y_mrad: e.Tilt | None = None
    speed_rpm: Annotated[list[e.NotNegative], Field(min_length=1)]
    hz: Annotated[list[e.NotNegative] | None, Field(min_length=1)] = None
    layer_um: e.OilThickness | None = None
    layer_ratio: e.BearingLayerRatio | None = None
    thermal: StrictBool = False

    def load(self, *, paired: bool) -> tuple[float, ...]:
        """Force on the inner ring, or on the shaft of a pair: (Fx, Fy) [N], with Fz, or with moments [N m]."""
        if self.radial_load is None and self.axial_load is None and not paired:
            raise InputError("operation.radial_load", None, "given, or an axial load")
        radial = 0.0, -(self.radial_load or 0.0)
        if all(getattr(self, name) is None for name in AXIAL) and not paired:
            return radial
        return (*radial, self.axial_load or 0.0, *moments_of(self, "operation"))

    @property
    def tilt(self) -> tuple[float, float] | None:
        """Tilts at which the inner ring is held [rad]."""
        return tilt_of(self)


class Pair(Section):
    """Two such bearings on one shaft, about its middle; a load is that of the shaft there."""

    arrangement: e.Arrangement
    preload: e.Preload | None = None
    spring: e.Spring | None = None
    distance_mm: e.Distance | None = None


class BearingFile(Section):
    """A bearing file; without [oil] the bearing is dry."""

    bearing: Bearing
    oil: Oil = Oil()
    surface: Surface = Surface()
    pair: Pair | None = None
    operation: Operation


@dataclass(frozen=True)
class BearingJob:
    """What is asked: a bearing under a load (`BallBearing.equilibrium`), or a pair of them, at speeds [rev/min].

    `hz` are frequencies of small vibrations; empty: that of the shaft at each speed.
    """

    bearing: BallBearing
    pair: BearingSet | None
    preload: float | None  # of the pair, by offsets [N]
    load: tuple[float, ...]
    tilt: tuple[float, float] | None
    speeds: tuple[float, ...]
    hz: tuple[float, ...]
    supply: OilLayer | None
    thermal: Heat | None
    source: str
    given: frozenset[str]
    designation: Designation | None = None  # of a bearing by its name

    @property
    def planar(self) -> bool:
        """Axial motion and tilts are held: balls have no contact angles."""
        return len(self.load) == 2

    @property
    def bearing_or_pair(self) -> BallBearing | BearingSet:
        """What carries the load: the bearing, or the pair."""
        return self.bearing if self.pair is None else self.pair

    @property
    def dry_pair(self) -> BearingSet | None:
        """The pair without films."""
        if self.pair is None:
            return None
        return replace(self.pair, bearings=[replace(one, oil=None) for one in self.pair.bearings])

    def state(self, speed_rpm: float) -> BearingState | SetState:
        """At rest with a ball under the load."""
        return self.bearing_or_pair.equilibrium(self.load, speed_rpm=speed_rpm, tilt=self.tilt)

    def coefficients(self, speed_rpm: float) -> BearingCoefficients:
        """Means over a ball passage."""
        at = {"hz": self.hz} if self.hz else {"rpm": speed_rpm}
        return self.bearing_or_pair.coefficients(self.load, speed_rpm=speed_rpm, tilt=self.tilt, **at)

    def oil_and_heat(
        self, speed_rpm: float, callback: Callable[[int, int, str], object], *, solve: bool
    ) -> OilAndHeat:
        """Films, K, C and torque with heat and with the layer, where given, beside flooded isothermal ones."""
        from reduced_models.bearing.oil_and_heat import oil_and_heat

        return oil_and_heat(
            self.bearing_or_pair,
            self.load,
            speed_rpm=speed_rpm,
            supply=self.supply,
            thermal=self.thermal,
            tilt=self.tilt,
            solve=solve,
            callback=callback,
        )

    def excitations(self, spall: Spall, text: str, slip: float) -> tuple[BearingExcitation, ...]:
        """Lines of force of the spall, given as `text`, at every speed, with slip of the cage.

        Raises
        ------
        InputError
            A pair, or a ring that is held at a tilt; a spall that the bearing has no place for.
        """
        for given, option in ((self.pair, "--pair"), (self.tilt, "--tilt-x, --tilt-y")):
            if given is not None:
                raise InputError(OPTION, text, f"without {option}")
        require_fit(spall, self.bearing, OPTION, text)
        return tuple(
            self.bearing.excitation([spall], self.load, speed_rpm=speed, slip=slip) for speed in self.speeds
        )

    @contextmanager
    def called(self) -> Iterator[None]:
        """Let an `InputError` of the library name the option or the entry of the file."""
        tilt = 0.0 if self.tilt is None else 1e3 * self.tilt[0]
        load = -self.load[1] if self.planar else (-self.load[1], *self.load[2:])
        with _called(self.source, self.given, {"load": load, "tilt": tilt}):
            try:
                yield
            except InputError as error:
                loose = self.pair is not None and self.preload is None and self.pair.sprung is None
                if not (loose and error.allowed.startswith("one that seats the ring")):
                    raise
                missing = "pair.preload or pair.spring" if self.source else "--preload or --spring"
                allowed = f"{error.allowed.partition(';')[0]}; {missing} is missing"
                raise InputError(error.field, error.value, allowed) from None


def load_job(source: str, options: Mapping[str, Any]) -> BearingJob:
    """Read what stands in a file, or a bearing by its name, with the options that are given.

    Parameters
    ----------
    source : str
        A TOML file, or a name of the catalogue.
    options : mapping
        Values by option, of `OPTIONS`; None where it is not given.

    Raises
    ------
    InputError
        No such file or name; an unknown, missing or impossible entry or option; no bearing. The line names it.
    """
    given = frozenset(option for option, value in options.items() if value is not None)
    is_file = source.lower().endswith(".toml") or Path(source).is_file()
    document = read_toml(source, "file") if is_file else {"bearing": {"catalogue": source}, "operation": {}}
    for option in given:
        section, _, key = OPTIONS[option].partition(".")
        entries = document.setdefault(section, {})
        if isinstance(entries, dict):
            entries[key] = options[option]
    origin = source if is_file else ""
    with _called(origin, given, {}):
        try:
            found = BearingFile.model_validate(document)
        except ValidationError as error:
            raise in_other_kind(first_error(error, BearingFile), document, STUDY, "run") from None
        bearing, asked = _bearing(found), found.operation
        named = None if found.bearing.catalogue is None else designation_of(found.bearing.catalogue)
        pair = _pair(found.pair, bearing)
        load = asked.load(paired=pair is not None)
        tandem = found.pair is not None and found.pair.arrangement == "tandem"
        if asked.axial_load is None and (tandem or (len(load) == 2 and bearing.contact_angle is not None)):
            which = "bearings in tandem need" if tandem else "an angular contact bearing needs"
            raise InputError("operation.axial_load", None, f"given: {which} an axial load, in +z")
        supply, thermal = supply_and_heat(asked, "operation", bearing.oil)
        require_apart("operation.speed_rpm", asked.speed_rpm)
        require_apart("operation.hz", asked.hz or ())
    speeds, hz = (tuple(sorted(values or ())) for values in (asked.speed_rpm, asked.hz))
    preload = None if found.pair is None else found.pair.preload
    return BearingJob(bearing, pair, preload, load, asked.tilt, speeds, hz, supply, thermal, origin, given, named)


def _pair(given: Pair | None, bearing: BallBearing) -> BearingSet | None:
    if given is None:
        return None
    more = {"preload": given.preload, "spring": given.spring, "distance_mm": given.distance_mm}
    return pair_of(bearing, given.arrangement, **more)


def _bearing(found: BearingFile) -> BallBearing:
    b, surface = found.bearing, found.surface
    in_m = {"ball_diameter": (b.ball_diameter_mm, 1e-3), "pitch_diameter": (b.pitch_diameter_mm, 1e-3),
            "cutoff_gap": (b.cutoff_gap_um, 1e-6),
            "rq_ball": (surface.rq_ball_um, 1e-6), "rq_race": (surface.rq_race_um, 1e-6)}  # fmt: skip
    lengths = {name: value * unit for name, (value, unit) in in_m.items() if value is not None}
    if surface.rq_um is not None:
        both = [name for name in ("rq_ball", "rq_race") if name in lengths]
        if both:
            raise InputError(f"surface.{both[0]}_um", lengths[both[0]] * 1e6, "left out where rq_um is given")
        lengths["rq_race"] = surface.rq_um * 1e-6
    names = ["name", "balls", "conformity_inner", "conformity_outer", "loss_factor", "ball_inertia"]
    names += ["youngs_modulus", "poisson_ratio", "race_control"]
    others = {name: getattr(b, name) for name in names if getattr(b, name) is not None}
    oil = found.oil.lubricant if "oil" in found.model_fields_set else None
    if b.clearance_um is not None:
        clearance = b.clearance_um
        others["clearance"] = clearance if isinstance(clearance, str) else clearance * 1e-6
    if b.contact_angle_deg is not None:
        others["contact_angle"] = radians(b.contact_angle_deg)
    arguments = {**others, **lengths, "oil": oil}
    if b.catalogue is not None:
        return BallBearing.catalogue(b.catalogue, **arguments)
    for name in NEEDED:
        if getattr(b, name) is None:
            raise InputError(f"bearing.{name}", None, "given, or bearing.catalogue in place of all dimensions")
    return BallBearing(**arguments)


@contextmanager
def _called(file: str, given: frozenset[str], values: Mapping[str, Any]) -> Iterator[None]:
    """Name what was given as it was given: an option, an entry of the file, or the name."""
    try:
        yield
    except InputError as error:
        entry, value = ENTRIES.get(error.field, error.field), values.get(error.field, error.value)
        dimensions = "any other by its dimensions, in a file as examples/bearing_6205.toml"
        allowed = error.allowed.replace(BY_DIMENSIONS, dimensions).removesuffix(" (or may_lift_off=True)")
        if error.field == "clearance" and not isinstance(error.value, str):
            value, allowed = error.value * 1e6, f"{allowed} (it is given in um)"  # type: ignore[operator]
        option = next((name for name, known in OPTIONS.items() if entry.startswith(known)), None)
        if isinstance(value, tuple):  # a load with an axial part
            names = ", ".join(OPTIONS[name] if file else name for name in LOADS[: len(value)])
            raise InputError(f"{file}: {names}" if file else names, value, allowed) from None
        if option is not None and (option in given or not file):
            entry = option
        elif file:
            entry = f"{file}: {entry}"
        elif entry == "bearing.catalogue":
            entry = "bearing"
        if value is None and option == "--pair":
            allowed = "given with a preload, spring or distance: those of a pair; a single bearing has its --axial"
        elif value is None and option is not None:
            if option in OF_OIL:
                allowed = "given: an oil has --oil and --temp, or --nu40, --nu100 and --temp"
            allowed += f", or {option}" if file else ""
        raise InputError(entry, value, allowed) from None
