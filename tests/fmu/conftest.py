"""One compiled FMU per kind for the whole session, and a way to run it by hand."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import fmpy
import pytest
from fmpy import fmi2

from ehlcontact.point import Scales
from fmu import export_contact
from reduced_models.elements.kinds import CubicContact, LinearContact

# Table 3, case 2 of Nonato and Cavalca (2010) in round numbers; the interval is that of a free vibration.
CUBIC = CubicContact(K1=0.624, K2=0.750, K3=-0.174, C1=0.0130, low=0.75, high=1.0)
LINEAR = LinearContact(K1=1.148, C1=0.0122, low=0.75, high=1.0)
SCALES = Scales(force=850.0, length=1.31e-5, time=2.1e-5, a=1.1e-4, b=9e-4, pressure=1.6e9)
ELEMENTS = {"cubic": CUBIC, "linear": LINEAR, "cubic_si": CUBIC.to_si(SCALES)}


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
    """fmpy's co-simulation slave with variables by name; started, and freed at the end."""

    def __init__(self, folder: str, start: bool = True):
        description = fmpy.read_model_description(folder)
        self.reference = {v.name: v.valueReference for v in description.modelVariables}
        self.log: list[tuple[int, str, str]] = []  # status, category, message
        self.raw = instantiate(folder, description, self._logged)
        self.time = 0.0
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

    def force(self, approach: float, rate: float, h: float = 1e-3) -> float:
        self.set(approach=approach, rate=rate)
        self.step(h)
        return self.get("force")[0]

    def gradient(self, unknown: str, known: str) -> float:
        return self.raw.getDirectionalDerivative([self.reference[unknown]], [self.reference[known]], [1.0])[0]


@pytest.fixture(scope="session")
def fmus(tmp_path_factory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("fmus")
    return {name: export_contact(element, folder / f"{name}.fmu") for name, element in ELEMENTS.items()}


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


@pytest.fixture
def elements() -> dict[str, CubicContact | LinearContact]:
    return ELEMENTS


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
