"""FMUs of FMI 3.0 by hand, through fmpy, with the face of `fmu.driver`."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.driver import pointer

_Floats = NDArray[np.float64]


class _Instance3:
    """What both kinds of instance have in common."""

    raw: Any
    time: float

    def __init__(self, folder: str, description: Any, messages: list[str], **options: Any) -> None:
        self.reference = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.description = description
        self.raw = self._make(folder, description)

        def log(environment: object, status: int, category: bytes, message: bytes) -> None:
            messages.append(message.decode("utf-8", "replace"))

        self.raw.instantiate(logMessage=log, **options)

    def _make(self, folder: str, description: Any) -> Any:
        raise NotImplementedError

    def free(self) -> None:
        """Free the instance."""
        self.raw.freeInstance()

    def set(self, **values: float) -> None:
        """Set real variables."""
        self.raw.setFloat64([self.reference[name] for name in values], [float(v) for v in values.values()])

    def choose(self, **values: int) -> None:
        """Set enumerations."""
        self.raw.setInt64([self.reference[name] for name in values], list(values.values()))

    def get(self, *names: str) -> list[float]:
        """Read real variables."""
        return list(self.raw.getFloat64([self.reference[name] for name in names]))

    def flag(self, name: str) -> bool:
        """Read a Boolean."""
        return bool(self.raw.getBoolean([self.reference[name]])[0])

    def gradient(self, unknown: str, known: str) -> float:
        """Partial derivative of one variable by another."""
        references = [self.reference[unknown]], [self.reference[known]]
        return float(self.raw.getDirectionalDerivative(*references, [1.0])[0])


class Slave3(_Instance3):
    """A co-simulation instance, not yet started."""

    def _make(self, folder: str, description: Any) -> Any:
        from fmpy.fmi3 import FMU3Slave

        return FMU3Slave(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="verify",
        )

    def start(self, meaning: int, **values: float) -> None:
        """Go through initialization with these values of variables and of `input_meaning`."""
        self.choose(input_meaning=meaning)
        if values:
            self.set(**values)
        self.raw.enterInitializationMode()
        self.raw.exitInitializationMode()
        self.time = 0.0

    def step(self, h: float) -> tuple[bool, ...]:
        """One communication step; whether it wants event handling, ends the run, returned early, and till when."""
        found = self.raw.doStep(currentCommunicationPoint=self.time, communicationStepSize=h)
        self.time = float(found[-1])
        return tuple(found)


class Exchange3(_Instance3):
    """A model-exchange instance, not yet started."""

    def _make(self, folder: str, description: Any) -> Any:
        from fmpy.fmi3 import FMU3Model

        return FMU3Model(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.modelExchange.modelIdentifier,
            instanceName="verify",
        )

    def start(self) -> None:
        """Go to continuous time."""
        self.raw.enterInitializationMode()
        self.raw.exitInitializationMode()
        self.raw.updateDiscreteStates()
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
            self.raw.getContinuousStateDerivatives(rates.ctypes.data_as(pointer()), rates.size)
        return rates
