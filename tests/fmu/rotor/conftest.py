"""Rotors and their FMUs, compiled once, and instances of them by hand."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from math import cos, radians
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest

from fmu import RotorModel, export_rotor
from fmu.driver import Exchange, Slave
from reduced_models import JeffcottRotor

BALL = 850.0  # N, on a contact at rest
BODIES = {
    "disc_mass": 2.0,
    "journal_mass": 0.3,
    "shaft_stiffness": 2e8,
    "shaft_damping": 60.0,
    "disc_damping": 1.0,
}
TURNING = {"unbalance": 4e-5, "speed_rpm": 8000.0, **BODIES}
HALF = radians(20.0)
WEIGHT = 2.3 * 9.81
VEE = JeffcottRotor.vee(half_angle=HALF, offset=1e-6, load=(0.0, WEIGHT - 4.0 * BALL * cos(HALF)), **TURNING)
VERTICAL = JeffcottRotor.vertical(load=(0.0, WEIGHT - BALL), **TURNING)


@dataclass(frozen=True)
class Unit:
    """One FMU: its file, its folder, what it was made from."""

    path: Path
    folder: str
    model: RotorModel
    fmi: int

    @property
    def description(self) -> Any:
        return fmpy.read_model_description(self.folder)


@pytest.fixture(scope="session")
def rotors(elements) -> dict[str, RotorModel]:
    """Alone and closed, with two axes and with one, with equal contacts and with different ones."""
    scales = elements["wide_si"], elements["cubic_si"], elements["power_si"]
    wide, cubic, power = scales
    return {
        "alone": RotorModel(VEE),
        "alone in y": RotorModel(VERTICAL),
        "wide": RotorModel(VEE, [wide, wide]),
        "cubic": RotorModel(VEE, [cubic, cubic]),
        "mixed": RotorModel(VEE, [wide, power]),
        "wide in y": RotorModel(VERTICAL, [wide]),
    }


@pytest.fixture(scope="session")
def unit(rotors, tmp_path_factory) -> Callable[..., Unit]:
    """``unit("wide", 3)``: exported once."""
    made: dict[tuple[str, int], Unit] = {}

    def make(name: str, fmi: int = 2) -> Unit:
        if (name, fmi) not in made:
            folder, model = tmp_path_factory.mktemp("rotor"), rotors[name]
            path = export_rotor(model.rotor, folder / "x.fmu", model.contacts, fmi=fmi)
            made[name, fmi] = Unit(path, fmpy.extract(str(path), unzipdir=str(folder / "x")), model, fmi)
        return made[name, fmi]

    return make


@pytest.fixture
def instance(unit) -> Iterator[Callable[..., Any]]:
    """Make instances, not yet started: ``instance("wide", exchange=True)``."""
    with ExitStack() as stack:

        def make(name: str, fmi: int = 2, *, exchange: bool = False) -> Any:
            one = unit(name, fmi)
            found = (Exchange if exchange else Slave)(one.folder, one.description, [])
            stack.callback(found.free)
            return found

        yield make


def names_of(rotor: JeffcottRotor) -> list[str]:
    """Positions and velocities, as `motion_of` has them."""
    axes = [("x", "y")[k] for k in rotor.axes]
    return [f"{body}{what}_{axis}" for what in ("", "_velocity") for body in ("disc", "journal") for axis in axes]


@pytest.fixture
def moving() -> Callable[[JeffcottRotor], list[str]]:
    """Names of positions and velocities."""
    return names_of


@pytest.fixture
def motion_of() -> Callable[..., np.ndarray]:
    """Positions and velocities of a `RotorResult`, shape (N, 2 freedoms)."""

    def stacked(result: Any) -> np.ndarray:
        axes = list(result.rotor.axes)
        parts = (result.disc, result.journal, result.disc_velocity, result.journal_velocity)
        return np.hstack([part[:, axes] for part in parts])

    return stacked
