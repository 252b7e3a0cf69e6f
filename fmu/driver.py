"""FMUs by hand, through fmpy: one instance for co-simulation or model exchange, variables by name."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]


class _Instance:
    """What both kinds of instance have in common."""

    raw: Any

    def __init__(self, folder: str, description: Any, messages: list[str]) -> None:
        self.reference = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.description = description
        self.raw = self._make(folder, description)
        self.raw.instantiate(callbacks=collecting_callbacks(messages))

    def _make(self, folder: str, description: Any) -> Any:
        raise NotImplementedError

    def free(self) -> None:
        """Free the instance."""
        self.raw.freeInstance()

    def set(self, **values: float) -> None:
        """Set real variables."""
        self.raw.setReal([self.reference[name] for name in values], [float(v) for v in values.values()])

    def choose(self, **values: int) -> None:
        """Set enumerations."""
        self.raw.setInteger([self.reference[name] for name in values], list(values.values()))

    def get(self, *names: str) -> list[float]:
        """Read real variables."""
        return list(self.raw.getReal([self.reference[name] for name in names]))

    def flag(self, name: str) -> bool:
        """Read a Boolean."""
        return bool(self.raw.getBoolean([self.reference[name]])[0])

    def gradient(self, unknown: str, known: str) -> float:
        """Partial derivative of one variable by another."""
        references = [self.reference[unknown]], [self.reference[known]]
        return float(self.raw.getDirectionalDerivative(*references, [1.0])[0])


class Slave(_Instance):
    """A co-simulation instance, not yet started."""

    def _make(self, folder: str, description: Any) -> Any:
        from fmpy.fmi2 import FMU2Slave

        return FMU2Slave(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="verify",
        )

    def start(self, meaning: int, **values: float) -> None:
        """Go through initialization with these values of variables and of `input_meaning`."""
        self.raw.setupExperiment(startTime=0.0)
        self.choose(input_meaning=meaning)
        self.set(**values)
        self.raw.enterInitializationMode()
        self.raw.exitInitializationMode()
        self.time = 0.0

    def step(self, h: float) -> None:
        """One communication step."""
        self.raw.doStep(currentCommunicationPoint=self.time, communicationStepSize=h)
        self.time += h


class Exchange(_Instance):
    """A model-exchange instance, not yet started."""

    def _make(self, folder: str, description: Any) -> Any:
        from fmpy.fmi2 import FMU2Model

        return FMU2Model(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.modelExchange.modelIdentifier,
            instanceName="verify",
        )

    def start(self) -> None:
        """Go to continuous time."""
        self.raw.setupExperiment(startTime=0.0)
        self.raw.enterInitializationMode()
        self.raw.exitInitializationMode()
        self.raw.newDiscreteStates()
        self.raw.enterContinuousTimeMode()

    def evaluate(self, states: _Floats, **inputs: float) -> tuple[float, _Floats]:
        """Force and derivatives of the states at these states and inputs."""
        rates = self.rates(states, **inputs)
        return self.get("force")[0], rates

    def rates(self, states: _Floats, **inputs: float) -> _Floats:
        """Derivatives of the states alone."""
        if inputs:
            self.set(**inputs)
        x, rates = np.ascontiguousarray(states, np.float64), np.zeros(states.size)
        if states.size:
            self.raw.setContinuousStates(x.ctypes.data_as(pointer()), x.size)
            self.raw.getDerivatives(rates.ctypes.data_as(pointer()), rates.size)
        return rates


def pointer() -> Any:
    """Ctypes' type of an array of doubles."""
    from ctypes import POINTER, c_double

    return POINTER(c_double)


def collecting_callbacks(messages: list[str]) -> Any:
    """FMI 2 callbacks that append log messages to a list.

    fmpy's own print, and run through a C function that remembers one logger for the whole process, whether
    it still exists or not. Messages of our FMUs need no formatting.
    """
    from fmpy import calloc, fmi2, free

    def log(environment: object, instance: bytes, status: int, category: bytes, message: bytes) -> None:
        messages.append(message.decode("utf-8", "replace"))

    callbacks = fmi2.fmi2CallbackFunctions()
    callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(log)
    callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(calloc)
    callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(free)
    return callbacks
