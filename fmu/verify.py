"""An FMU against fmpy's rules and, state by state, against the Python element it was exported from."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import chdir, contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from fmu.spec import Element, ModelSpec, contact_spec

TOLERANCE = 1e-12


@dataclass(frozen=True, slots=True)
class Verification:
    """What was found; differences are relative, see `verify`."""

    findings: tuple[str, ...]  # of fmpy's validation, and start values or units unlike the element's
    states: int  # (approach, rate) pairs compared
    outside: int  # of these, with the approach outside the validity interval
    parted: int  # of these, with no force
    force: float  # largest difference of the force
    tangents: float  # of stiffness and damping
    derivatives: float  # of the directional derivatives of the force
    flags: int  # states where outside_validity is wrong

    @property
    def passes(self) -> bool:
        """No finding, and all differences within rounding."""
        differences = max(self.force, self.tangents, self.derivatives)
        return not self.findings and self.flags == 0 and differences <= TOLERANCE

    def to_dict(self) -> dict[str, Any]:
        """All fields and the verdict, for storage."""
        return asdict(self) | {"passes": self.passes}


def verify(path: str | os.PathLike[str], element: Element) -> Verification:
    """Run the FMU through fmpy as a co-simulation and compare it with the element.

    One step each for a grid of approaches (inside, below and above the validity interval, lift-off
    included) and rates (both signs, up to where the damper alone cancels the force). A difference is
    relative to the magnitude of what is compared, with 1e-3 of its value at the upper end of the interval as
    the floor, for a number that cancels to nearly nothing has no relative error to speak of.

    Parameters
    ----------
    path : path-like
        The FMU.
    element : LinearContact or CubicContact
        What it should be.

    Raises
    ------
    InputError
        Not an FMU with a contact element for this platform.
    """
    from fmpy.validation import validate_fmu

    file = Path(path)
    spec = contact_spec(element)
    approach, rate = state_grid(element)
    with opened(file) as (folder, description):
        known = _known_variables(description, spec, file)
        findings = (*validate_fmu(str(file)), *_declarations(spec, known))
        slave = _instantiate(file, folder, description)
        try:
            values, partials, flags = _run(slave, spec, approach, rate)
        finally:
            slave.freeInstance()
    expected = [np.asarray(f(approach, rate)) for f in (element.force, element.stiffness, element.damping)]
    scales = [float(f(element.high, 0.0)) for f in (element.force, element.stiffness, element.damping)]
    differences = [_difference(values[:, k], expected[k], scales[k]) for k in range(3)]
    outside = ~((element.low <= approach) & (approach <= element.high))
    return Verification(
        findings=findings,
        states=approach.size,
        outside=int(outside.sum()),
        parted=int((expected[0] == 0.0).sum()),
        force=differences[0],
        tangents=max(differences[1:]),
        derivatives=max(_difference(partials[:, k], expected[k + 1], scales[k + 1]) for k in range(2)),
        flags=int((flags != outside).sum()),
    )


def state_grid(element: Element) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Approaches and rates to compare at, each of shape (n,).

    Approaches go from beyond lift-off to three interval lengths above, with the ends of the interval, their
    floating-point neighbours and both sides of lift-off; rates from parting to three times the spring force.
    """
    length = element.high - element.low
    lift_off = element.low - 1.5 * element.force(element.low, 0.0) / element.stiffness(element.low, 0.0)
    ends = np.array([element.low, element.high])
    # At lift-off, and where the damper cancels the spring exactly, the last bit decides between contact and
    # none, and the tangents jump: stay a little off.
    fade = element.low - lift_off
    approaches = np.concatenate(
        [
            np.linspace(lift_off - length, element.high + 3.0 * length, 121),
            [lift_off - 0.02 * fade, lift_off + 0.02 * fade],
            ends,
            np.nextafter(ends, -np.inf),
            np.nextafter(ends, np.inf),
        ]
    )
    force, damping = element.force(element.high, 0.0), element.damping(element.high, 0.0)
    # Without a damper any rate will do; take one interval length per unit of time.
    unit = force / damping if damping > 0.0 else length
    u, v = np.meshgrid(approaches, unit * np.array([-3.0, -0.97, -0.31, -0.01, 0.0, 0.01, 0.5, 3.0]))
    return u.ravel(), v.ravel()


@contextmanager
def opened(file: Path) -> Iterator[tuple[str, Any]]:
    """Extract an FMU into a temporary folder; yields the folder and the model description.

    Raises
    ------
    InputError
        Not a readable FMU for this platform.
    """
    import fmpy

    folder = tempfile.mkdtemp(prefix="ehlcontact-verify-")
    try:
        try:
            fmpy.extract(str(file), unzipdir=folder)
            description = fmpy.read_model_description(folder, validate=False)
        except Exception as error:  # fmpy raises bare Exception among others
            reason = " ".join(str(error).split()) or type(error).__name__
            raise InputError("path", str(file), f"a readable FMU ({reason})") from None
        if description.coSimulation is None or fmpy.platform not in fmpy.supported_platforms(folder):
            raise InputError("path", str(file), f"an FMU for co-simulation on {fmpy.platform}")
        yield folder, description
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _known_variables(description: Any, spec: ModelSpec, file: Path) -> dict[str, Any]:
    """Variables of the FMU by name, once those of the element are sure to be among them."""
    known = {variable.name: variable for variable in description.modelVariables}
    for variable in spec.variables:
        if variable.name not in known or known[variable.name].valueReference != variable.value_reference:
            raise InputError("path", str(file), "an FMU of a contact element made by export_contact")
    return known


def _declarations(spec: ModelSpec, known: dict[str, Any]) -> tuple[str, ...]:
    """Unit and start value of each variable where the FMU says another than the element."""
    found = []
    for variable in spec.variables:
        declared = known[variable.name]
        start = None if declared.start is None else float(declared.start)
        if (declared.unit, start) != (variable.unit, variable.start):
            found.append(
                f"{variable.name}: start {start} [{declared.unit}] in the FMU, "
                f"{variable.start} [{variable.unit}] in the element"
            )
    return tuple(found)


def _instantiate(file: Path, folder: str, description: Any) -> Any:
    from fmpy.fmi2 import FMU2Slave

    messages: list[str] = []
    try:
        with chdir(Path.cwd()):  # fmpy leaves the process in another folder when a library does not load
            slave = FMU2Slave(
                guid=description.guid,
                unzipDirectory=folder,
                modelIdentifier=description.coSimulation.modelIdentifier,
                instanceName="verify",
            )
            slave.instantiate(callbacks=collecting_callbacks(messages))
    except Exception as error:  # fmpy raises bare Exception among others
        reason = " ".join([str(error), *messages])
        raise InputError("path", str(file), f"an FMU that can be instantiated ({reason})") from None
    return slave


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


def _run(
    slave: Any, spec: ModelSpec, approach: NDArray[np.float64], rate: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Step through all states; returns force and tangents, partial derivatives of the force, and flags."""
    inputs, outputs, flag = (
        [spec[name].value_reference for name in names]
        for names in (("approach", "rate"), ("force", "stiffness", "damping"), ("outside_validity",))
    )
    values, partials = np.empty((approach.size, 3)), np.empty((approach.size, 2))
    flags = np.empty(approach.size, dtype=bool)
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    for n, state in enumerate(zip(approach.tolist(), rate.tolist(), strict=True)):
        slave.setReal(inputs, list(state))
        slave.doStep(currentCommunicationPoint=float(n), communicationStepSize=1.0)
        values[n] = slave.getReal(outputs)
        flags[n] = bool(slave.getBoolean(flag)[0])
        for k in range(2):
            partials[n, k] = slave.getDirectionalDerivative(outputs[:1], [inputs[k]], [1.0])[0]
    slave.terminate()
    return values, partials, flags


def _difference(ours: NDArray[np.float64], expected: NDArray[np.float64], scale: float) -> float:
    size = np.maximum(np.abs(expected), 1e-3 * abs(scale))
    error = np.abs(ours - expected)
    if not np.all(np.isfinite(error)):
        return float("inf")
    return float(np.max(np.divide(error, size, out=np.where(error > 0.0, np.inf, 0.0), where=size > 0.0)))
