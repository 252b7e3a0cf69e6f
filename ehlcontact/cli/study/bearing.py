"""What ``ehlcontact bearing`` is asked: a bearing of a study, or of the catalogue, with options for entries."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ehlcontact.cli.spall import OPTION, require_fit
from ehlcontact.cli.study.loads import load_alone, loaded
from ehlcontact.cli.study.machine import bearing_of, carrier_of
from ehlcontact.cli.study.points.lists import points_of, require_apart
from ehlcontact.cli.study.shared_entries import supply_and_heat, tilt_of
from ehlcontact.cli.toml import read_toml
from ehlcontact.errors import InputError
from reduced_models import BallBearing, BearingSet
from reduced_models.bearing.catalogue import designation_of
from reduced_models.bearing.designation import Designation

if TYPE_CHECKING:
    from ehlcontact import Heat, OilLayer
    from ehlcontact.cli.study.schema import Study
    from reduced_models import Spall
    from reduced_models.bearing.coefficients import BearingCoefficients
    from reduced_models.bearing.equilibrium_result import BearingState
    from reduced_models.bearing.excitation import BearingExcitation
    from reduced_models.bearing.oil_and_heat import OilAndHeat
    from reduced_models.bearing.set_result import SetState
    from reduced_models.rotor.machine_state import MachineState

OPTIONS = {  # and the entries of a study that they set
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
    "--pair": "support.pair",
    "--preload": "support.preload",
    "--spring": "support.pair_spring",
    "--distance-mm": "support.distance_mm",
    "--contact-angle": "support.contact_angle_deg",
    "--race-control": "support.race_control",
    "--clearance": "support.clearance",
    "--oil": "oil.iso_vg",
    "--nu40": "oil.nu40",
    "--nu100": "oil.nu100",
    "--temp": "oil.temperature",
    "--rq": "surface.rq_um",
}
BY_ENTRY = {entry: option for option, entry in OPTIONS.items()}
LOADS = "operation.radial_load", "operation.axial_load"  # where an equilibrium lacks them
OF_OIL = "--oil", "--nu40", "--nu100", "--temp"


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
    study: Study  # at the first speed
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

    def answer(self, speed_rpm: float) -> MachineState:
        """The bearing or pair in the numbers of a designer, at a speed above 0."""
        from reduced_models.rotor.machine_state import single_bearing_state

        return single_bearing_state(self.bearing_or_pair, self.load, speed_rpm, tilt=self.tilt)

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
        with _called(self.source, self.given), loaded(self.study):
            yield


def load_job(source: str, options: Mapping[str, Any]) -> BearingJob:
    """Read the bearing of a study file, or one by its name, with the options that are given.

    Parameters
    ----------
    source : str
        A TOML file, or a name of the catalogue.
    options : mapping
        Values by option, of `OPTIONS`; None where it is not given.

    Raises
    ------
    InputError
        No such file or name; an unknown, missing or impossible entry or option; a machine. The line names it.
    """
    given = frozenset(option for option, value in options.items() if value is not None)
    is_file = source.lower().endswith(".toml") or Path(source).is_file()
    document: dict[str, Any] = {"support": [{"bearing": source}], "operation": {}}
    if is_file:
        document = read_toml(source, "file")
    origin = source if is_file else ""
    with _called(origin, given):
        _require_bearing(document)
        for option in given:
            section, _, key = OPTIONS[option].partition(".")
            entries = document["support"][0] if section == "support" else document.setdefault(section, {})
            if isinstance(entries, dict):
                entries[key] = options[option]
        studies = sorted(
            (point.study for point in points_of(document, Path(), at_rest=True)), key=lambda study: study.speed_rpm
        )
        study = studies[0]
        if any(one.operation.radial_load != study.operation.radial_load for one in studies):
            loads = document["operation"]["radial_load"]
            raise InputError("operation.radial_load", loads, "one load here; `ehlcontact run` takes a list")
        require_apart("operation.hz", study.operation.hz or ())
        carrier, bearing = carrier_of(study, 0), bearing_of(study, 0)
        supply, thermal = supply_and_heat(study.operation, "operation", study.lubricant)
        name = study.support[0].bearing
    return BearingJob(
        bearing=bearing,
        pair=carrier if isinstance(carrier, BearingSet) else None,
        preload=study.support[0].preload,
        load=load_alone(study),
        tilt=tilt_of(study.operation),
        speeds=tuple(one.speed_rpm for one in studies),
        hz=tuple(sorted(study.operation.hz or ())),
        supply=supply,
        thermal=thermal,
        study=study,
        source=origin,
        given=given,
        designation=None if name is None else designation_of(name),
    )


def _require_bearing(document: Mapping[str, Any]) -> None:
    """Raise `InputError` for the study of a machine, of which this is one bearing."""
    machine = "left out here: `ehlcontact run` is for a machine"
    if "shaft" in document:
        raise InputError("shaft", "[shaft]", machine)
    support = document.get("support")
    if isinstance(support, list) and len(support) > 1:
        raise InputError("support", f"{len(support)} of them", f"one bearing; {machine}")


@contextmanager
def _called(file: str, given: frozenset[str]) -> Iterator[None]:
    """Name what was given as it was given: an option, an entry of the file, or the name."""
    try:
        yield
    except InputError as error:
        names = error.field.split(", ") if error.field != "support" else list(LOADS)
        found = [BY_ENTRY.get(name, "") for name in names]
        as_options = [
            option if option and (option in given or not file) else name
            for name, option in zip(names, found, strict=True)
        ]
        field, option, allowed = ", ".join(as_options), found[0], error.allowed
        if any(name not in given for name in as_options) and file:
            field = f"{file}: {field}"
        elif names == ["support.bearing"]:
            field = "bearing"
        if error.value is None and option:
            if option in OF_OIL:
                allowed = "given: an oil has --oil and --temp, or --nu40, --nu100 and --temp"
            allowed += f", or {option}" if file else ""
        for entry in sorted(() if file else BY_ENTRY, key=len, reverse=True):
            allowed = allowed.replace(entry, BY_ENTRY[entry])
        allowed = allowed.replace(
            "any other by its dimensions, balls = ...",
            "any other by its dimensions, in a file as examples/bearing_6205.toml",
        )
        raise InputError(field, error.value, allowed) from None
