"""Verification of an FMU before it is written, against its Python model and its own reference results."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from ehlcontact.errors import InputError
from fmu.fmu_file import opened
from fmu.fmu_model import FmuModel
from fmu.references.check import check_references
from fmu.verification import Verification
from fmu.verify import verify_opened

REACH = 3.0  # validity intervals above `high` up to which `verify` compares the force


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
