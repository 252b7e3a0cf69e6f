"""`verify`: an FMU against fmpy's rules and, state by state, its Python model, also before it is written."""

from __future__ import annotations

import os
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any, Unpack

import numpy as np

from ehlcontact.errors import InputError
from fmu.description_rules import findings
from fmu.fmu_file import FmuFile, opened
from fmu.isolated import isolated, require_path
from fmu.lead import CONTACT, ROTOR
from fmu.models import Exported, FmuModel, Keywords, fmu_model
from fmu.references.check import check_references
from fmu.references.series import References, visit, walk
from fmu.spec import ModelSpec, Variable
from fmu.verification import Verification

ROUNDING = 1e-12  # of a start value or its nominal value, within which both may differ
BALANCE = 1e-9  # of a state at rest, which a search finds
EXPORT_OPTIONS = {CONTACT.name, ROTOR.name}  # whose start values are chosen at export
REACH = 3.0  # validity intervals above `high` up to which `verify` compares the force


def verify(path: str | os.PathLike[str], model: Exported, **keywords: Unpack[Keywords]) -> Verification:
    """Run the FMU through fmpy and compare it with its model.

    It runs the native code in the FMU, with the rights of whoever calls it: in a child process with limits of time
    and memory (not on Windows), but behind no other wall. It finds faults, not malice. Verify what you would
    run.

    Without memory: one step of co-simulation each for a grid of approaches (inside, below and above the validity
    interval, lift-off included) and rates (both signs, up to where the damper alone cancels the force), and the
    same states in model exchange. With a memory: a motion with lift-off and a pulse of load, in steps from 1e-3 to
    1 of 2a/u_sum, against `drive`, and the film's states along it in model exchange against `state_rates`.
    A rotor: a run-up with forces that lift it off its supports, against the steps of `simulate_rotor`, and its
    accelerations and films at states of that run in model exchange.
    A bearing: a run of its ring with vibrations and lift-off, against the steps of `BearingMotion`, and
    forces and rates in model exchange at some states.

    A difference is relative to the magnitude of what is compared, with 1e-3 of its value at the upper end of the
    interval (under the reference load) as the floor, for a number that cancels to nearly nothing has no relative
    error to speak of.

    Parameters
    ----------
    path : path-like
        The FMU.
    model : ContactElement, BallBearing, BearingSet or Rotor
        What it should be.
    **keywords
        Those of its `export`, the start values of `lead` and of other options of the export apart.

    Raises
    ------
    InputError
        Not an FMU of such a model for this platform, or a keyword that the model does not take; a library that
        crashes, ends the process or does not end; an archive that unpacks to more than half a GiB.
    RuntimeError
        The FMU refuses a call; with its reason.

    See Also
    --------
    fmu.verify_references : without an element, against the reference results inside the FMU.
    """
    made = fmu_model(model, **keywords)

    def compared(file: Path) -> Verification:
        with opened(file) as opened_file:
            return verify_opened(opened_file, made)

    return isolated(compared, require_path(path), Verification.from_fields)


def verify_opened(file: FmuFile, model: FmuModel) -> Verification:
    """`verify` of an opened FMU."""
    known = _known_variables(file, model.spec)
    found = (*findings(file.path), *_declarations(model.spec, known))
    with file.running() as (slave, exchange):
        return replace(compare(slave, exchange, model.trials()), findings=found)


def compare(slave: Any, exchange: Any, trials: References) -> Verification:
    """What instances for co-simulation and, unless it is None, model exchange make of the trials of a model."""
    assert trials.steps is not None
    found = [trials.steps.differences(walk(slave, trials))]
    slave.raw.terminate()
    compared = [trials.steps]
    if exchange is not None and trials.points is not None:
        found.append(trials.points.differences(visit(exchange, trials)))
        compared.append(trials.points)
    largest: dict[str, float] = {}
    flags = 0
    for trial, gaps in zip(compared, found, strict=True):
        for name, gap in gaps.items():
            field = trial.fields[name]
            if field == "flags":
                flags += int((gap > 0.0).sum())
            else:
                largest[field] = max(largest.get(field, 0.0), float(gap.max()))
    numbers: Any = largest
    return Verification(
        states=trials.steps.time.size, outside=trials.outside, parted=trials.parted, flags=flags, **numbers
    )


def _known_variables(file: FmuFile, spec: ModelSpec) -> dict[str, Any]:
    """Variables of the FMU by name; raises `InputError` if one of the element's is missing."""
    known = {variable.name: variable for variable in file.description.modelVariables}
    for variable in spec.variables:
        if variable.name not in known or known[variable.name].valueReference != variable.value_reference:
            given, its = (str(one.description).split("; ")[0][:150] for one in (spec, file.description))
            lacks = f"{variable.name} as variable {variable.value_reference}"
            raise InputError("path", str(file.path), f"an FMU of {given!r}; it is one of {its!r}, without {lacks}")
    return known


def _declarations(spec: ModelSpec, known: dict[str, Any]) -> tuple[str, ...]:
    """Findings: variables whose unit or start value differs from the element's."""
    differences = []
    for variable in spec.variables:
        declared = known[variable.name]
        start = None if declared.start is None else float(declared.start)
        same = declared.unit == variable.unit and _same_start(start, variable)
        if not same and variable.name not in EXPORT_OPTIONS:
            differences.append(
                f"{variable.name}: start {start} [{declared.unit}] in the FMU, "
                f"{variable.declared_start} [{variable.unit}] in the element"
            )
    return tuple(differences)


def _same_start(start: float | None, variable: Variable) -> bool:
    """Whether a start value is that of a variable, but for the rounding of places in equilibrium."""
    expected, allowed = variable.declared_start, ROUNDING if variable.guess is None else BALANCE
    if start is None or expected is None:
        return start is expected
    return abs(start - expected) <= allowed * max(abs(expected), variable.nominal or 0.0)


class VerificationError(RuntimeError):
    """An FMU that differs from its model, in one line; ``found``: its `Verification`, None if it did not run."""

    def __init__(self, message: str, found: Verification | None = None) -> None:
        self.found = found
        super().__init__(" ".join(message.split()))


def require_finite(model: FmuModel) -> None:
    """Make sure that each contact has a finite force at every approach at which the FMU will be run.

    Raises
    ------
    InputError
        A force or stiffness is too large for a floating-point number.
    """
    for element in model.elements:
        low, high = element.validity.approach
        at = high + REACH * (high - low)
        for name, value in (("force", element.spring(at)), ("stiffness", element.spring_tangent(at))):
            if not np.isfinite(value):
                found = f"{name} {value:g} at approach {at:.4g}"
                raise InputError(
                    "element", found, "one with finite forces, also above its interval (wrong units?)"
                )


def require_verified(content: bytes, model: FmuModel) -> Verification:
    """Run an FMU, before it is written, against its Python model and against its own references.

    Raises
    ------
    VerificationError
        It does not load, does not run, or differs.
    """
    try:
        with tempfile.TemporaryDirectory(prefix="ehlcontact-verify-", ignore_cleanup_errors=True) as folder:
            trial = Path(folder) / "trial.fmu"
            trial.write_bytes(content)
            with opened(trial) as file:
                found = verify_opened(file, model)
                own = check_references(file)
    except InputError as error:
        raise VerificationError(f"the FMU is not {error.allowed}") from None
    except OSError as error:
        reason = error.strerror or str(error)
        raise VerificationError(f"no room to verify in {tempfile.gettempdir()} ({reason})") from None
    except Exception as error:  # fmpy raises bare Exception among others, also for a call that the FMU refuses
        raise VerificationError(f"the FMU does not run: {error}") from None
    if not found.passes:
        raise VerificationError(
            f"the FMU differs from what it was made from: {'; '.join(found.findings) or found}", found
        )
    if not own.passes:
        raise VerificationError(
            f"the FMU differs from its reference results: {'; '.join(own.findings) or own}", found
        )
    return found
