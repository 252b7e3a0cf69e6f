"""One instance of an FMU (FMI 2.0 or 3.0), driven through fmpy with variables by name."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import POINTER, c_double
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]


class _Instance:
    """Base of both kinds of instance."""

    section: ClassVar[str]  # of the model description
    maker: ClassVar[str]  # class of fmpy, behind the version
    raw: Any

    def __init__(self, folder: str, description: Any, messages: list[str], **options: Any) -> None:
        from fmpy import fmi2, fmi3

        self.description, self._messages = description, messages
        self.fmi = int(description.fmiVersion.partition(".")[0])
        self.types = {variable.name: variable.type for variable in description.modelVariables}
        self.reference = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.time = 0.0
        self.raw = getattr(fmi2 if self.fmi == 2 else fmi3, f"FMU{self.fmi}{self.maker}")(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=getattr(description, self.section).modelIdentifier,
            instanceName="verify",
        )
        self._get = self._named("getReal", "getFloat64")
        self._set = self._named("setReal", "setFloat64")
        if self.fmi == 2:
            self.raw.instantiate(callbacks=collecting_callbacks(messages), **options)
        else:
            self.raw.instantiate(logMessage=_collecting_logger(messages), **options)

    def _named(self, name2: str, name3: str) -> Any:
        """Method of fmpy that has another name in each FMI version."""
        return getattr(self.raw, name2 if self.fmi == 2 else name3)

    def _initialize(self, **values: float) -> None:
        with self._reasons():
            if self.fmi == 2:
                self.raw.setupExperiment(startTime=0.0)
            self.set(**values)
            self.raw.enterInitializationMode()
            self.raw.exitInitializationMode()
        self.time = 0.0

    @contextmanager
    def _reasons(self) -> Iterator[None]:
        """Add to the error of a call what the FMU has logged since: fmpy tells the status only."""
        first = len(self._messages)
        try:
            yield
        except Exception as error:
            error.args = (" ".join([str(error), *self._messages[first:]]),)
            raise

    def free(self) -> None:
        """Free the instance."""
        self.raw.freeInstance()

    def set(self, **values: float) -> None:
        """Set real variables."""
        self._set([self.reference[name] for name in values], [float(value) for value in values.values()])

    def get(self, *names: str) -> list[float]:
        """Read real variables."""
        return list(self._get([self.reference[name] for name in names]))

    def flag(self, name: str) -> bool:
        """Read a Boolean."""
        return bool(self.raw.getBoolean([self.reference[name]])[0])

    def read(self, *names: str) -> list[float]:
        """Read real variables, Booleans as 0 and 1, and partial derivatives, as "force / rate"."""
        real = [name for name in names if self.types.get(name) not in ("Boolean", None)]
        found = dict(zip(real, self.get(*real), strict=True)) if real else {}
        for name in names:
            if name not in found:
                found[name] = self.gradient(*name.split(" / ")) if " / " in name else float(self.flag(name))
        return [found[name] for name in names]

    def gradient(self, unknown: str, known: str) -> float:
        """Partial derivative of one variable by another."""
        references = [self.reference[unknown]], [self.reference[known]]
        return float(self.raw.getDirectionalDerivative(*references, [1.0])[0])


class Slave(_Instance):
    """A co-simulation instance, not yet started."""

    section, maker = "coSimulation", "Slave"

    def start(self, **values: float) -> None:
        """Go through initialization with these values of variables."""
        self._initialize(**values)

    def step(self, h: float) -> tuple[bool, ...]:
        """One communication step.

        In FMI 3.0 it returns whether it wants event handling, ends the run, returned early, and till when.
        """
        found = self._do_step(h)
        self.time = self.time + h if self.fmi == 2 else float(found[-1])
        return () if self.fmi == 2 else tuple(found)

    def step_to(self, time: float) -> None:
        """One communication step that ends at this very time."""
        self._do_step(time - self.time)
        self.time = time

    def _do_step(self, h: float) -> Any:
        with self._reasons():
            return self.raw.doStep(currentCommunicationPoint=self.time, communicationStepSize=h)


class Exchange(_Instance):
    """A model-exchange instance, not yet started."""

    section, maker = "modelExchange", "Model"

    def start(self, **values: float) -> None:
        """Go to continuous time."""
        self._initialize(**values)
        self._named("newDiscreteStates", "updateDiscreteStates")()
        self.raw.enterContinuousTimeMode()

    def place(self, states: _Floats, **inputs: float) -> _Floats:
        """Set states and inputs; returns the derivatives of the states."""
        if inputs:
            self.set(**inputs)
        x, rates = np.ascontiguousarray(states, np.float64), np.zeros(states.size)
        if states.size:
            self.raw.setContinuousStates(x.ctypes.data_as(POINTER(c_double)), x.size)
            ask = self._named("getDerivatives", "getContinuousStateDerivatives")
            ask(rates.ctypes.data_as(POINTER(c_double)), rates.size)
        return rates

    def evaluate(self, states: _Floats, **inputs: float) -> tuple[float, _Floats]:
        """Force of a contact, and derivatives of the states, at these states and inputs."""
        rates = self.place(states, **inputs)
        return self.get("force")[0], rates


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


def _collecting_logger(messages: list[str]) -> Any:
    """FMI 3 logger that appends messages to a list."""

    def log(environment: object, status: int, category: bytes, message: bytes) -> None:
        messages.append(message.decode("utf-8", "replace"))

    return log
