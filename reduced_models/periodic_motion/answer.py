"""`PeriodicAnswer`: one period of a rotor that repeats its motion."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import Picture
from ehlcontact.status import Status
from ehlcontact.store import stored
from ehlcontact.summary import Summary
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.periodic_motion.picture import multipliers_picture
from reduced_models.rotor.result import RotorResult

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

FINE = 2048  # points of a period, of which the largest and the smallest are taken
ON_CIRCLE = 1e-6  # distance of a multiplier from the unit circle that rounding and steps may make


@stored("periodic answer")
@dataclass(frozen=True, eq=False, kw_only=True)
class PeriodicAnswer(Summary):
    """A motion of a rotor that repeats itself after a period.

    Attributes
    ----------
    run : RotorResult
        One period, its first sample at t = 0 and its last one a period later.
    excitation : str
        What makes the rotor move: "unbalance", "passage" of balls, or "force".
    over : str
        What a branch follows: "speed" [rev/min], "amplitude" (factor of unbalances or forces), "clearance" [m],
        "preload" [m], "frequency" [Hz].
    value : float
        Of that parameter here.
    periods : int
        Periods of the excitation after which the motion repeats itself: 1, or more of a sub-harmonic answer.
    residual : float
        Of an answer by harmonic balance: displacement in harmonics beyond those kept, over that within them; by
        shooting the difference between start and end over the largest displacement.
    multipliers : ndarray or None
        Floquet multipliers, the largest first; None where they were not computed.
    status : Status
    reservation : str
        What the answer leaves open, in words; else empty.
    """

    run: RotorResult
    excitation: str
    over: str = "speed"
    value: float
    periods: int = 1
    residual: float
    multipliers: _Complex | None = None
    status: Status = Status.CONVERGED
    reservation: str = ""

    HARMONICS_SHOWN: ClassVar[int] = 3

    @property
    def period(self) -> float:
        """After which the motion repeats itself [s]."""
        return float(self.run.t[-1])

    @property
    def omega(self) -> float:
        """Angular frequency of the motion [rad/s]."""
        return 2.0 * np.pi / self.period

    @property
    def speed_rpm(self) -> float:
        """Of the shaft [rev/min]."""
        return float(self.run.speed_rpm[0])

    @property
    def speed(self) -> float:
        """Of the shaft [rad/s]."""
        return self.speed_rpm * RPM_TO_RAD_S

    @property
    def harmonics(self) -> _Complex:
        """Amplitudes c of the degrees of freedom, shape (k, N): q(t) = Re(sum over h of c_h exp(i h omega t))."""
        spectrum = np.fft.rfft(self.run.displacement[:-1], axis=0) / (len(self.run.t) - 1)
        spectrum[1:] *= 2.0
        return np.asarray(spectrum)

    @property
    def peak_to_peak(self) -> _Floats:
        """Of every degree of freedom, shape (N,) [m], or rad where it turns; between the samples too."""
        n = len(self.run.t) - 1
        spectrum = np.fft.rfft(self.run.displacement[:-1], axis=0)
        fine = max(n, FINE)
        return np.asarray(np.ptp(np.fft.irfft(spectrum, fine, axis=0), axis=0) * (fine / n))

    @property
    def stable(self) -> bool | None:
        """Whether small disturbances die away; None where multipliers were not computed."""
        return (
            None if self.multipliers is None else bool(np.abs(self.multipliers).max(initial=0.0) < 1.0 + ON_CIRCLE)
        )

    def picture(self) -> Picture:
        """Floquet multipliers in the complex plane.

        Raises
        ------
        InputError
            Multipliers that were not computed.
        """
        if self.multipliers is None:
            raise InputError("multipliers", None, "computed: floquet.with_multipliers")
        return multipliers_picture(self)

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Matplotlib figure of the multipliers; into a file too where a path is given. Motions: ``run.plot()``."""
        return draw(self.picture(), path)

    def _summary_lines(self) -> list[str]:
        words = {True: "stable", False: "unstable", None: "stability not computed"}[self.stable]
        largest = "" if self.multipliers is None else f", largest multiplier {self.multipliers[0]:.4g}"
        many = "" if self.periods == 1 else f" ({self.periods} periods of the excitation)"
        return [
            f"{self.status} answer to {self.excitation} at {self.speed_rpm:.6g} rev/min, "
            f"period {1e3 * self.period:.5g} ms{many}",
            f"{words}{largest}; residual {self.residual:.2g}",
            *self.run._summary_lines()[1:],
            *filter(None, [self.reservation]),
        ]
