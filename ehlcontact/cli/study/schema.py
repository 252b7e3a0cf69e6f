"""The study file: TOML, checked field by field before anything is computed."""

from __future__ import annotations

import hashlib
import json
import tomllib
from math import pi
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from ehlcontact.errors import InputError
from ehlcontact.files import read_text
from ehlcontact.lubricant import Lubricant
from ehlcontact.origin import __version__
from ehlcontact.point import OperatingPoint, most_loaded_ball
from ehlcontact.solver.domain import Domain
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Grid = Annotated[int, Field(ge=16, le=2048, multiple_of=16, strict=True)]
Steps = Annotated[int, Field(ge=20, le=2000, strict=True)]
Amplitude = Annotated[float, Field(gt=0.0, lt=1.0, allow_inf_nan=False)]
Periods = Annotated[float, Field(ge=1.0, le=100.0, allow_inf_nan=False)]


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Bearing(_Section):
    """A radial ball bearing; the contact is that of its most loaded ball."""

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


class Oil(_Section):
    """Oil at the temperature of the inlet."""

    name: str = "oil"
    eta0: Positive  # Pa s
    alpha: Positive  # 1/Pa
    viscosity: Literal["roelands", "barus"] = "roelands"
    density: Literal["dowson-higginson", "incompressible"] = "dowson-higginson"


class Solver(_Section):
    """Grids and region."""

    n: Grid = 128  # of the steady film
    n_transient: Grid = 128  # of every transient film
    domain: tuple[Finite, Finite, Finite] = (-4.5, 1.5, 3.0)


class Free(_Section):
    """Free vibration of a mass on the contact."""

    omega_n: Positive = 2.56
    periods: Periods = 2.5
    steps_per_period: Steps = 80


class Harmonic(_Section):
    """Harmonic load in the band of the contact's own vibrations."""

    omega: Positive = pi
    amplitude: Amplitude = 0.1
    periods: Periods = 3.0
    steps_per_period: Steps = 80


class Rotor(_Section):
    """Jeffcott rotor in two such bearings, and the harmonic load at its speed that its element is fitted to."""

    arrangement: Literal["vee", "vertical"] = "vee"
    half_angle_deg: Annotated[float, Field(gt=0.0, lt=90.0, allow_inf_nan=False)] = 20.0
    disc_mass: Positive = 40.0  # kg
    journal_mass: Positive = 2.0  # kg, both journals
    shaft_stiffness: Positive = 2.5e7  # N/m
    shaft_damping: NotNegative = 1500.0  # N s/m
    disc_damping: NotNegative = 1000.0  # N s/m
    unbalance: Positive = 8e-4  # kg m
    revolutions: Periods = 3.0
    steps_per_revolution: Steps = 60
    check_revolutions: Periods = 1.0  # run again with half the step
    fit_amplitude: Amplitude = 0.25
    fit_periods: Periods = 2.0
    fit_steps_per_period: Steps = 40


class Study(_Section):
    """Everything that a study file says."""

    title: str = "contact study"
    bearing: Bearing
    oil: Oil
    solver: Solver = Solver()
    free: Free = Free()
    harmonic: Harmonic = Harmonic()
    rotor: Rotor = Rotor()

    @property
    def ball_load(self) -> float:
        """Load of the most loaded ball [N]."""
        return most_loaded_ball(self.bearing.radial_load, self.bearing.balls)

    @property
    def lubricant(self) -> Lubricant:
        """The oil as the solvers take it."""
        return Lubricant(self.oil.eta0, self.oil.alpha, self.oil.viscosity, self.oil.density)

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
    def free_motion(self) -> FreeVibration:
        """Motion of the free vibration."""
        return FreeVibration(self.free.omega_n)

    @property
    def harmonic_motion(self) -> HarmonicLoad:
        """Motion in the contact's band."""
        return HarmonicLoad(self.harmonic.omega, self.harmonic.amplitude)

    @property
    def rotor_motion(self) -> HarmonicLoad:
        """Harmonic load at the rotor's speed."""
        return HarmonicLoad(self.rotor_omega, self.rotor.fit_amplitude)

    def fingerprint(self, *sections: str) -> str:
        """Hash of the bearing, the oil, the version and further sections: what a stage's result depends on."""
        content = {name: self.model_dump()[name] for name in ("bearing", "oil", *sections)}
        text = json.dumps([__version__, content], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]


def load_study(path: Path) -> Study:
    """Read and check a study file.

    Raises
    ------
    InputError
        No such file, not TOML, an unknown, missing or impossible entry; the line names file, field, value and
        allowed range.
    """
    try:
        document = tomllib.loads(read_text(path))
    except OSError as error:
        raise InputError("study", str(path), f"a readable TOML file ({error.strerror})") from None
    except (ValueError, RecursionError) as error:
        reason = "nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise InputError("study", str(path), f"complete TOML ({reason})") from None
    try:
        study = Study.model_validate(document)
    except ValidationError as error:
        raise _first_error(path, error) from None
    try:
        for name in ("domain", "point", "free_motion", "harmonic_motion", "rotor_motion"):
            getattr(study, name)  # made here once, so that what the library refuses is refused now
    except InputError as error:
        raise InputError(f"{path}: {error.field}", error.value, error.allowed) from None
    return study


def _first_error(path: Path, error: ValidationError) -> InputError:
    first = error.errors()[0]
    field = ".".join(str(part) for part in first["loc"]) or "study"
    value = first["input"]
    match first["type"]:
        case "extra_forbidden":
            section = _section(first["loc"][:-1])
            return InputError(f"{path}: {field}", value, "left out; known here: " + ", ".join(section))
        case "missing":
            return InputError(f"{path}: {field}", None, "given")
    allowed = first["msg"].removeprefix("Input should be ").removeprefix("Value error, ")
    return InputError(f"{path}: {field}", value, allowed)


def _section(loc: tuple[int | str, ...]) -> list[str]:
    model: Any = Study
    for part in loc:
        model = model.model_fields[str(part)].annotation
    return list(model.model_fields)
