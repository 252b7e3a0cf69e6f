"""What ``ehlcontact bearing`` is asked: a study of one bearing and one load, at one speed or at several."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ehlcontact.cli.entries import entries_of, in_options, options_of
from ehlcontact.cli.study.loads import OF_A_ROTOR, life_options, load_alone, loaded
from ehlcontact.cli.study.machine import bearing_of, carrier_of
from ehlcontact.cli.study.points.lists import points_of, require_apart
from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.study.shared_entries import supply_and_heat, tilt_of
from ehlcontact.cli.toml import read_toml
from ehlcontact.errors import InputError
from reduced_models import BallBearing, BearingSet
from reduced_models.bearing.catalogue import designation_of
from reduced_models.rotor.machine_state import MachineState, single_bearing_state

if TYPE_CHECKING:
    from ehlcontact import Heat, OilLayer
    from reduced_models.bearing.coefficients import BearingCoefficients
    from reduced_models.bearing.designation import Designation

NOT_OF_A_BEARING = (  # entries that name something, and those of a bearing under a shaft
    *(f"support.{name}" for name in ("name", "bearing", "journal_mass", "housing_damping", *OF_A_ROTOR)),
    "oil.name",
    "operation.shares",  # of points, which `ehlcontact run` computes
    "defect.support",
    "defect.cage_slip_percent",  # of a bearing without a spall too
)
ENTRIES = entries_of(Study, ("operation", "support", "oil", "surface", "defect"), NOT_OF_A_BEARING)
LOADS = "operation.radial_load", "operation.axial_load"  # where an equilibrium lacks them
OF_OIL = "oil.iso_vg", "oil.nu40", "oil.nu100", "oil.temperature"


@dataclass(frozen=True)
class BearingJob:
    """A bearing alone, or a pair, under a load that is the same at all speeds."""

    studies: tuple[Study, ...]  # by speed
    source: str  # the file; empty of a name
    given: frozenset[str]  # entries that options have set

    @property
    def study(self) -> Study:
        """That of the lowest speed."""
        return self.studies[0]

    @cached_property
    def bearing(self) -> BallBearing:
        """The bearing; of a pair one of both."""
        return bearing_of(self.study, 0)

    @cached_property
    def bearing_or_pair(self) -> BallBearing | BearingSet:
        """What carries the load: the bearing, or the pair."""
        return carrier_of(self.study, 0)

    @property
    def pair(self) -> BearingSet | None:
        """The pair, if it is one."""
        return self.bearing_or_pair if isinstance(self.bearing_or_pair, BearingSet) else None

    @property
    def dry_pair(self) -> BearingSet | None:
        """The pair without films."""
        if self.pair is None:
            return None
        return replace(self.pair, bearings=[replace(one, oil=None) for one in self.pair.bearings])

    @cached_property
    def load(self) -> tuple[float, ...]:
        """On the inner ring [N], [N m]; of two components where axial motion and tilts are held."""
        return load_alone(self.study)

    @property
    def tilt(self) -> tuple[float, float] | None:
        """At which the ring is held [rad]."""
        return tilt_of(self.study.operation)

    @property
    def speeds(self) -> tuple[float, ...]:
        """Of the shaft, in their order [rev/min]."""
        return tuple(study.speed_rpm for study in self.studies)

    @property
    def supply_and_heat(self) -> tuple[OilLayer | None, Heat | None]:
        """Layer of oil and data of heat, where films with them are asked for beside flooded isothermal ones."""
        return supply_and_heat(self.study.operation, "operation", self.study.lubricant)

    @property
    def designation(self) -> Designation | None:
        """How the name of the bearing was read."""
        name = self.study.support[0].bearing
        return None if name is None else designation_of(name)

    def answer(self, speed_rpm: float) -> MachineState:
        """The bearing or pair in the numbers of a designer."""
        found = single_bearing_state(self.bearing_or_pair, self.load, speed_rpm, tilt=self.tilt)
        return replace(found, **life_options(self.study))

    def coefficients(self, speed_rpm: float) -> BearingCoefficients:
        """K and C at the frequencies that are asked for, or at that of the shaft; means over a ball passage."""
        hz = sorted(self.study.operation.hz or ())
        at = {"hz": hz} if hz else {"rpm": speed_rpm}
        return self.bearing_or_pair.coefficients(self.load, speed_rpm=speed_rpm, tilt=self.tilt, **at)

    @contextmanager
    def called(self) -> Iterator[None]:
        """Let an `InputError` of the library name the option or the entry of the file."""
        with _called(self.source, self.given), loaded(self.study):
            yield


def load_job(source: str, entries: Mapping[str, Any]) -> BearingJob:
    """Read the bearing of a study file, or one by its name, with entries in place of those of the file.

    Parameters
    ----------
    source : str
        A TOML file, or a name of the catalogue.
    entries : mapping
        Values by entry, as "operation.speed_rpm".

    Raises
    ------
    InputError
        No such file or name; an unknown, missing or impossible entry or option; a machine. The line names it.
    """
    is_file = source.lower().endswith(".toml") or os.path.isfile(source)  # of a name of any length
    document: dict[str, Any] = {"support": [{"bearing": source}], "operation": {}}
    if is_file:
        document = read_toml(source, "file")
    origin, given = source if is_file else "", frozenset(entries)
    with _called(origin, given):
        _require_bearing(document)
        for entry, value in entries.items():
            section, _, key = entry.partition(".")
            several = section in ("support", "defect")
            own = document.setdefault(section, [{}] if several else {})
            own = own[0] if isinstance(own, list) and own else own
            if isinstance(own, dict):
                own[key] = value
        points = points_of(document, Path(), at_rest=True)
        studies = tuple(sorted((point.study for point in points), key=lambda study: study.speed_rpm))
        if any(one.operation.radial_load != studies[0].operation.radial_load for one in studies):
            loads = document["operation"]["radial_load"]
            raise InputError("operation.radial_load", loads, "one load here; `ehlcontact run` takes a list")
        require_apart("operation.hz", studies[0].operation.hz or ())
        job = BearingJob(studies, origin, given)
        _ = job.bearing_or_pair, job.load, job.supply_and_heat
    return job


def _require_bearing(document: Mapping[str, Any]) -> None:
    """Raise `InputError` for the study of a machine, of which this is one bearing."""
    machine = "left out here: `ehlcontact run` is for a machine"
    if "shaft" in document:
        raise InputError("shaft", "[shaft]", machine)
    support = document.get("support")
    if isinstance(support, list) and len(support) > 1:
        raise InputError("support", f"{len(support)} of them", f"one bearing; {machine}")


@contextmanager
def _called(file: str, given: Collection[str]) -> Iterator[None]:
    """Name what was given as it was given: an option, an entry of the file, or the name."""
    try:
        yield
    except InputError as error:
        names = error.field.split(", ") if error.field != "support" else list(LOADS)
        as_option = [name in given or (not file and name in ENTRIES) for name in names]
        field = ", ".join(
            options_of(name)[0] if chosen else name for name, chosen in zip(names, as_option, strict=True)
        )
        allowed = error.allowed if file else in_options(error.allowed, ENTRIES)
        allowed = allowed if file else allowed.replace("balls = ...", "in a file as examples/bearing_6205.toml")
        if file and not all(as_option):
            field = f"{file}: {field}"
        elif names == ["support.bearing"]:
            field = "bearing"
        if error.value is None and names[0] in ENTRIES:
            if names[0] in OF_OIL:
                allowed = "given: an oil has --oil and --temp, or --nu40, --nu100 and --temp"
            allowed += f", or {options_of(names[0])[0]}" if file else ""
        raise InputError(field, error.value, allowed) from None
