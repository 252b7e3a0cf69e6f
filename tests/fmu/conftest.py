"""One compiled FMU per kind for the whole session, and a way to run it by hand."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from math import cos, radians
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from exported import Jeffcott, given
from fmpy import fmi2

from ehlcontact.point import Scales
from fmu import export
from fmu.driver import Exchange
from fmu.driver import Slave as DriverSlave
from reduced_models import (
    FilmContact,
    SpringContact,
)

# Table 3, case 2 of Nonato and Cavalca (2010) in round numbers; the interval is that of a free vibration.
CUBIC = SpringContact.cubic(K1=0.624, K2=0.750, K3=-0.174, C1=0.0130, low=0.75, high=1.0)
LINEAR = SpringContact.linear(K1=1.148, C1=0.0122, low=0.75, high=1.0)
SCALES = Scales(force=850.0, length=1.31e-5, time=2.1e-5, a=1.1e-4, b=9e-4, pressure=1.6e9)
ELEMENTS = {"cubic": CUBIC, "linear": LINEAR, "cubic_si": CUBIC.to_si(SCALES)}
BOX = {"low": 0.75, "high": 1.0, "rate": 1.2, "load_range": (0.8, 1.2), "omega_range": (3.0, 6.0)}
POLYNOMIAL = SpringContact.polynomial(0.806, 0.004, 0.346, 0.002, 0.054, -0.001, 0.010, **BOX)
POWER = SpringContact.power(0.95, 1.7, 0.15, -0.05, 0.013, **BOX)
# As they come out of the atlas at M = 200, L = 10, kappa = 0.5, in round numbers.
FILTERS = {"inlet_saturation": 0.25, "lag_rate": 5.4, "inlet_rate": 33.0, "fast_rate": 60.0}
GAINS = (0.001, 0.002, 0.005, 0.013, 0.0, 0.009, 0.011, 0.0, 0.0, 0.0, 0.021)
LOADS = np.array([0.005, 0.02, 0.1, 0.3, 1.0, 3.0])
CURVE = LOADS ** (2.0 / 3.0) - [0.0649, 0.0659, 0.0626, 0.0574, 0.0499, 0.0400]
ROWS = tuple(tuple(scale * g for g in GAINS) for scale in (2.0, 1.0, 0.6))
MEMORY = FilmContact.memory(film=0.129, exponent=0.13, gains=GAINS, **FILTERS, **BOX)
WIDE = FilmContact.wide(LOADS, CURVE, (0.03, 0.3, 2.0), ROWS, **FILTERS, **BOX)
SPRINGS = ELEMENTS | {"polynomial": POLYNOMIAL, "power": POWER, "power_si": POWER.to_si(SCALES)}
SPRINGS["polynomial without rate"] = SpringContact.polynomial(0.62, 0.02, 0.75, 0.0, -0.17, 0.0, 0.01, 0.75, 1.0)
FILMS = {"memory": MEMORY, "wide": WIDE, "wide_si": WIDE.to_si(SCALES)}
EXTRAPOLATED, END = 1.0, 0.0  # values of lead

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
VEE = {"half_angle": HALF, "offset": 1e-6, "load": (0.0, WEIGHT - 4.0 * BALL * cos(HALF)), **TURNING}
VERTICAL = {"bearings": 1, "load": (0.0, WEIGHT - BALL), **TURNING}


@dataclass(frozen=True)
class Unit:
    """One FMU: its file, its folder, what it was made from."""

    path: Path
    folder: str
    model: Jeffcott
    fmi: int

    @property
    def description(self) -> Any:
        return fmpy.read_model_description(self.folder)


def instantiate(folder: str, description: Any, logger: Callable) -> fmi2.FMU2Slave:
    """Like fmpy.instantiate_fmu, with a logger of its own.

    fmpy sends all loggers through one C function that remembers the last one, even when it is gone.
    """
    slave = fmi2.FMU2Slave(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="test",
    )
    callbacks = fmi2.fmi2CallbackFunctions()
    callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(logger)
    callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
    callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmpy.free)
    slave.instantiate(callbacks=callbacks)
    return slave


class Slave:
    """fmpy's co-simulation slave with variables by name; started, and freed at the end.

    Its inputs are those of the end of a step, unless another lead is asked for.
    """

    def __init__(self, folder: str, start: bool = True, lead: float = END, **values: float):
        description = fmpy.read_model_description(folder)
        self.reference = {v.name: v.valueReference for v in description.modelVariables}
        self.log: list[tuple[int, str, str]] = []  # status, category, message
        self.raw = instantiate(folder, description, self._logged)
        self.time = 0.0
        self.raw.setReal([self.reference["lead"]], [lead])
        self.set(**values)
        if start:
            self.raw.setupExperiment(startTime=0.0)
            self.raw.enterInitializationMode()
            self.raw.exitInitializationMode()

    def _logged(self, environment, name, status, category, message) -> None:
        self.log.append((status, category.decode(), message.decode()))

    def set(self, **values: float) -> None:
        self.raw.setReal([self.reference[name] for name in values], list(values.values()))

    def get(self, *names: str) -> list[float]:
        return self.raw.getReal([self.reference[name] for name in names])

    def outside(self) -> bool:
        return bool(self.raw.getBoolean([self.reference["outside_validity"]])[0])

    def step(self, h: float = 1e-3) -> None:
        self.raw.doStep(currentCommunicationPoint=self.time, communicationStepSize=h)
        self.time += h

    def flags(self) -> list[bool]:
        """Approach, rate and force outside their bounds."""
        names = [f"outside_{name}" for name in ("approach", "rate", "force")]
        return [bool(flag) for flag in self.raw.getBoolean([self.reference[name] for name in names])]

    def force(self, approach: float, rate: float, h: float = 1e-3) -> float:
        self.set(approach=approach, rate=rate)
        self.step(h)
        return self.get("force")[0]

    def gradient(self, unknown: str, known: str) -> float:
        return self.raw.getDirectionalDerivative([self.reference[unknown]], [self.reference[known]], [1.0])[0]


def exported(made_once: Callable, names: Iterable[str], fmi: int) -> dict[str, Path]:
    """FMUs of elements by their names."""

    def write(folder):
        for name in names:
            export((SPRINGS | FILMS)[name], folder / f"{name}.fmu", fmi=fmi)

    folder = made_once(f"fmus {fmi}", write)
    return {name: folder / f"{name}.fmu" for name in names}


@pytest.fixture(scope="session")
def fmus(made_once) -> dict[str, Path]:
    """Of all elements, in FMI 2."""
    return exported(made_once, SPRINGS | FILMS, 2)


@pytest.fixture(scope="session")
def fmus3(made_once) -> dict[str, Path]:
    """Of some, in FMI 3."""
    return exported(made_once, ("cubic", "polynomial", "power_si", "wide", "wide_si"), 3)


@pytest.fixture(scope="session")
def extracted(fmus, tmp_path_factory) -> dict[str, str]:
    folder = tmp_path_factory.mktemp("extracted")
    return {name: fmpy.extract(str(path), unzipdir=str(folder / name)) for name, path in fmus.items()}


@pytest.fixture
def slave(extracted) -> Iterator[Callable[..., Slave]]:
    """Make started slaves: ``slave("cubic")``."""
    with ExitStack() as stack:

        def make(name: str = "cubic", **options: Any) -> Slave:
            made = Slave(extracted[name], **options)
            stack.callback(made.raw.freeInstance)
            return made

        yield make


@pytest.fixture(params=list(ELEMENTS))
def kind(request) -> str:
    return request.param


@pytest.fixture(params=list(SPRINGS))
def spring_kind(request) -> str:
    """Any element without memory."""
    return request.param


@pytest.fixture(params=list(FILMS))
def film_kind(request) -> str:
    """Any element with a film memory."""
    return request.param


@pytest.fixture(params=list(SPRINGS | FILMS))
def any_kind(request) -> str:
    """Any element."""
    return request.param


@pytest.fixture(scope="session")
def elements() -> dict[str, Any]:
    return SPRINGS | FILMS


@pytest.fixture(scope="session")
def rotors(elements) -> dict[str, Jeffcott]:
    """Alone and closed, with two axes and with one, with equal contacts and with different ones."""
    scales = elements["wide_si"], elements["cubic_si"], elements["power_si"]
    wide, cubic, power = scales
    return {
        "alone": Jeffcott(VEE),
        "alone in y": Jeffcott(VERTICAL),
        "wide": Jeffcott(VEE, [wide, wide]),
        "cubic": Jeffcott(VEE, [cubic, cubic]),
        "mixed": Jeffcott(VEE, [wide, power]),
        "wide in y": Jeffcott(VERTICAL, [wide]),
    }


@pytest.fixture(scope="session")
def unit(rotors, tmp_path_factory) -> Callable[..., Unit]:
    """``unit("wide", 3)``: exported once."""
    made: dict[tuple[str, int], Unit] = {}

    def make(name: str, fmi: int = 2) -> Unit:
        if (name, fmi) not in made:
            folder, model = tmp_path_factory.mktemp("rotor"), rotors[name]
            source, keywords = given(model)
            path = export(source, folder / "x.fmu", fmi=fmi, **keywords)
            made[name, fmi] = Unit(path, fmpy.extract(str(path), unzipdir=str(folder / "x")), model, fmi)
        return made[name, fmi]

    return make


@pytest.fixture
def instance(unit) -> Iterator[Callable[..., Any]]:
    """Make instances, not yet started: ``instance("wide", exchange=True)``."""
    with ExitStack() as stack:

        def make(name: str, fmi: int = 2, *, exchange: bool = False) -> Any:
            one = unit(name, fmi)
            found = (Exchange if exchange else DriverSlave)(one.folder, one.description, [])
            stack.callback(found.free)
            return found

        yield make


@pytest.fixture(scope="session")
def by_hand() -> type[Slave]:
    """The class of the slaves, for FMUs of a test's own."""
    return Slave


@pytest.fixture
def instantiated() -> Callable:
    """Bare instance: ``instantiated(folder, description, logger)``."""
    return instantiate


@contextmanager
def _rollback(slave: Slave) -> Iterator[None]:
    state, time = slave.raw.getFMUState(), slave.time
    try:
        yield
    finally:
        slave.raw.setFMUState(state)
        slave.raw.freeFMUState(state)
        slave.time = time


@pytest.fixture
def rollback() -> Callable:
    """``with rollback(slave):`` undoes what is done to the slave inside."""
    return _rollback
