"""What makes a rotor move periodically: its unbalances, balls that pass the load, or a force.

Unbalances turn with the shaft, balls with the cage: both at once have no common period, and the motion is
quasi-periodic. An answer to unbalance has the mean bearing, balls at several positions of a cage that stands
still; one to ball passage leaves the unbalances out.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_finite, require_integer, require_positive, shown
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.supports import BearingMount, Mount, is_ball_bearing

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

UNBALANCE, PASSAGE, FORCE = "unbalance", "passage", "force"
KINDS = (UNBALANCE, PASSAGE)


@fields_take(amplitudes=Object(Mapping, "amplitudes by degree of freedom"), hz="Hz")
@dataclass(frozen=True, kw_only=True, eq=False)
class PeriodicForce(Summary):
    """Forces Re(sum over h of amplitude_h exp(2 pi i h hz t)) on degrees of freedom.

    Parameters
    ----------
    amplitudes : mapping of int to complex, or to a sequence of them
        By degree of freedom [N], or N m where it turns: of the first harmonic, or of harmonics 1, 2, ...
    hz : float
        Of the first harmonic [Hz].
    """

    amplitudes: Mapping[int, Any]
    hz: float

    def __post_init__(self) -> None:
        require_positive("hz", self.hz)
        if not self.amplitudes:
            raise InputError("amplitudes", {}, "at least one degree of freedom with its amplitude [N]")
        for place, values in self.amplitudes.items():
            require_integer("amplitudes", place, "degrees of freedom, whole numbers >= 0", 0)
            try:
                numbers = np.atleast_1d(np.asarray(values, complex))
            except (TypeError, ValueError):
                raise InputError(f"amplitudes[{place}]", shown(values), "complex numbers [N]") from None
            require_finite(f"amplitudes[{place}]", float(np.abs(numbers).max(initial=0.0)))

    def _summary_lines(self) -> list[str]:
        at = ", ".join(map(str, self.amplitudes))
        return [f"forces on degrees of freedom {at}, {self.hz:.6g} Hz"]

    def spectrum(self, size: int, harmonics: int, step: int) -> _Complex:
        """Amplitudes of a motion whose period is `step` periods of the force, shape (harmonics + 1, size)."""
        found = np.zeros((harmonics + 1, size), complex)
        for place, values in self.amplitudes.items():
            if place >= size:
                raise InputError("amplitudes", place, f"degrees of freedom from 0 to {size - 1}")
            for k, amplitude in enumerate(np.atleast_1d(np.asarray(values, complex)).tolist(), 1):
                if k * step > harmonics:
                    raise InputError("harmonics", harmonics, f"at least {k * step}: the force has so many")
                found[k * step, place] += amplitude
        return found


Excitation = str | PeriodicForce


def require_excitation(excitation: Any, rotor: Rotor) -> None:
    """Raise `InputError` for what does not excite this rotor."""
    if isinstance(excitation, PeriodicForce):
        return
    if excitation not in KINDS:
        raise InputError("excitation", shown(excitation), f"one of {', '.join(KINDS)}, or a PeriodicForce")
    if excitation == UNBALANCE and not rotor.unbalances:
        raise InputError("excitation", excitation, "of a rotor with an Unbalance; this one has none")
    if excitation == PASSAGE and not rotor.ball_bearings:
        raise InputError("excitation", excitation, "of a rotor on ball bearings; this one has none")


def name_of(excitation: Excitation) -> str:
    """Kind of an excitation, in a word."""
    return FORCE if isinstance(excitation, PeriodicForce) else excitation


@dataclass(frozen=True)
class Setting:
    """Numbers that a branch may follow, one of them at a time."""

    speed_rpm: float
    amplitude: float = 1.0
    clearance: float | None = None  # of all ball bearings [m]; None: their own
    preload: float | None = None  # offset of all mounts [m]; None: their own
    frequency: float | None = None  # of the first harmonic of a force [Hz]

    @property
    def omega(self) -> float:
        """Of the shaft [rad/s]."""
        return self.speed_rpm * RPM_TO_RAD_S


OVER = {"speed": "speed_rpm", **{name: name for name in ("amplitude", "clearance", "preload", "frequency")}}


def set_to(
    rotor: Rotor, speed_rpm: float, excitation: Excitation, over: str, value: float
) -> tuple[Rotor, float, Excitation]:
    """Rotor, speed [rev/min] and excitation with what a branch follows at a value."""
    if over == "speed":
        return rotor, value, excitation
    if over == "frequency" and isinstance(excitation, PeriodicForce):
        return rotor, speed_rpm, replace(excitation, hz=value)
    if over == "amplitude":
        if isinstance(excitation, PeriodicForce):
            scaled = {place: value * np.asarray(one, complex) for place, one in excitation.amplitudes.items()}
            return rotor, speed_rpm, replace(excitation, amplitudes=scaled)
        unbalances = tuple(replace(one, amount=value * one.amount) for one in rotor.unbalances)
        return replace(rotor, unbalances=unbalances), speed_rpm, excitation
    mounts: list[Mount] = []
    for mount in rotor.mounts:
        if not (isinstance(mount, BearingMount) and is_ball_bearing(mount)):
            mounts.append(mount)
        elif over == "clearance":
            mounts.append(replace(mount, bearing=replace(mount.ball_bearing, clearance=value)))
        else:
            mounts.append(replace(mount, offset=value))
    return replace(rotor, mounts=tuple(mounts)), speed_rpm, excitation
