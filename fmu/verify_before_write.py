"""Verification of an FMU before it is written: nothing unverified is."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from ehlcontact.errors import InputError
from fmu.contact_variables import Element
from fmu.references.check import check_references
from fmu.rotor.model import RotorModel
from fmu.verify import Verification, opened, verify_opened

REACH = 3.0  # validity intervals above `high` up to which `verify` asks for a force


class VerificationError(RuntimeError):
    """An FMU that is not what it was exported from: one line; ``found`` says what is wrong, if it came to that."""

    def __init__(self, message: str, found: Verification | None = None) -> None:
        self.found = found
        super().__init__(" ".join(message.split()))


def require_finite(element: Element | RotorModel) -> None:
    """Make sure that an element, or each of a rotor's, has a force wherever an FMU will be asked for one.

    Raises
    ------
    InputError
        It is too large for a floating-point number.
    """
    if isinstance(element, RotorModel):
        for one in element.elements:
            require_finite(one)
        return
    low, high = element.validity.approach
    at = high + REACH * (high - low)
    for name, value in (("force", element.spring(at)), ("stiffness", element.spring_tangent(at))):
        if not np.isfinite(value):
            found = f"{name} {value:g} at approach {at:.4g}"
            raise InputError("element", found, "one with finite forces, also above its interval (wrong units?)")


def require_verified(content: bytes, element: Element | RotorModel) -> Verification:
    """Run an FMU, before it is written, against the element or rotor and against its own references.

    Raises
    ------
    VerificationError
        It does not load, does not run, or differs.
    """
    try:
        with tempfile.TemporaryDirectory(prefix="ehlcontact-verify-", ignore_cleanup_errors=True) as folder:
            trial = Path(folder) / "trial.fmu"
            trial.write_bytes(content)
            with opened(trial) as (unpacked, description):
                found = verify_opened(trial, unpacked, description, element)
                own = check_references(trial, unpacked, description)
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
