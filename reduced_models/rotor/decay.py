"""Logarithmic decrement of a free decay, by a fit over all of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, require_positive
from ehlcontact.errors import InputError, warn_user
from ehlcontact.summary import Summary

_Floats = NDArray[np.float64]

FEWEST_PERIODS = 2.0  # of a decay: from less, damping and a drift of the mean look alike
# How far a decay is looked for: about 0 in the decrement, and about the first guess, relative, in frequency.
SEARCH = (2.0, 0.3)
STILL = 1e-9  # spread of a signal over its largest value, below which nothing vibrates


@dataclass(frozen=True)
class Decrement(Summary):
    """A decaying vibration A exp(-decrement t/period) cos(omega t + phase) + mean, fitted to samples.

    Attributes
    ----------
    decrement : float
        By which ln(amplitude) falls in a period.
    interval : (float, float)
        95 %, if the samples were independent; a growth of the misfit widens it.
    omega : float
        Damped angular frequency [rad/s].
    amplitude : float
        At the first sample, in the unit of the signal.
    misfit : float
        RMS of what the fit leaves, over the standard deviation of the signal.
    periods : float
        Covered.
    """

    FIELD_UNITS: ClassVar[Mapping[str, str]] = {"omega": "rad/s"}

    decrement: float
    interval: tuple[float, float]
    omega: float
    amplitude: float
    misfit: float
    periods: float

    @property
    def hz(self) -> float:
        """Damped frequency [Hz]."""
        return self.omega / (2.0 * pi)

    def to_dict(self) -> dict[str, object]:
        """All numbers, ready for JSON."""
        return {
            "decrement": self.decrement,
            "interval": list(self.interval),
            "hz": self.hz,
            "amplitude": self.amplitude,
            "misfit": self.misfit,
            "periods": self.periods,
        }


def log_decrement(t: ArrayLike, signal: ArrayLike, *, omega: float) -> Decrement:
    """Fit one damped vibration and a mean to all samples of a decay.

    Amplitude, phase and mean are linear and drop out (variable projection); decrement and frequency are found by
    least squares. Leave out the first period, in which what was kicked beside the mode dies away.

    Parameters
    ----------
    t : array_like, shape (N,)
        Increasing times [s].
    signal : array_like, shape (N,)
    omega : float
        First guess of the angular frequency [rad/s], within a quarter of it. Where the fit ends at the limits of
        its search, a warning says so.

    Raises
    ------
    InputError
        Too short, or a signal that stands still.
    """
    times = as_column("t", t, least=8, increasing=True)
    values = as_column("signal", signal, size=times.size)
    guess = require_positive("omega", omega)
    periods = float(times[-1] - times[0]) * guess / (2.0 * pi)
    if periods > 0.5 * times.size:
        raise InputError(
            "omega", guess, f"at most {guess * 0.5 * times.size / periods:.3g} rad/s, two times a period"
        )
    if periods < FEWEST_PERIODS:
        raise InputError("t", f"{periods:.3g} periods", f"at least {FEWEST_PERIODS:g} periods of omega")
    spread = float(np.std(values))
    if not spread > STILL * float(np.abs(values).max()):
        raise InputError("signal", f"standing still at {float(values[0]):.4g}", "a vibration")
    since, scaled = times - times[0], values / spread

    def basis(x: _Floats) -> _Floats:
        w = guess * (1.0 + x[1])
        envelope = np.exp(-x[0] * w * since / (2.0 * pi))
        return np.column_stack([envelope * np.cos(w * since), envelope * np.sin(w * since), np.ones_like(since)])

    def left(x: _Floats) -> _Floats:
        columns = basis(x)
        return np.asarray(scaled - columns @ np.linalg.lstsq(columns, scaled, rcond=None)[0])

    limits = ([-SEARCH[0], -SEARCH[1]], SEARCH)
    starts = [scipy.optimize.least_squares(left, [d, 0.0], bounds=limits, x_scale=[0.1, 0.01]) for d in (0.0, 0.3)]
    found = min(starts, key=lambda solution: float(solution.cost))
    cosine, sine, _ = np.linalg.lstsq(basis(found.x), scaled, rcond=None)[0]
    if np.isclose(np.abs(found.x), SEARCH, rtol=1e-3).any():
        where = f"within {SEARCH[1]:.0%} of omega = {guess:.5g} rad/s, with a decrement up to {SEARCH[0]:g}"
        warn_user(f"no decay found {where}: is that the signal's angular frequency?")
    w = guess * (1.0 + float(found.x[1]))
    half = _half_width(found, since.size)
    delta = float(found.x[0])
    return Decrement(
        decrement=delta,
        interval=(delta - half, delta + half),
        omega=w,
        amplitude=float(np.hypot(cosine, sine)) * spread,
        misfit=float(np.sqrt(2.0 * found.cost / since.size)),
        periods=float(since[-1]) * w / (2.0 * pi),
    )


def _half_width(solution: scipy.optimize.OptimizeResult, samples: int) -> float:
    """Half width of the decrement's interval: by the slope of the residuals, which hang together."""
    residual = solution.fun
    freedom = samples - 5  # three linear unknowns and two others
    covariance = np.linalg.pinv(solution.jac.T @ solution.jac)
    # An AR(1) of the residuals' own correlation: (1 + r)/(1 - r) times fewer of them are independent.
    energy = float(residual @ residual)
    r = float(residual[1:] @ residual[:-1]) / energy if energy > 0.0 else 0.0
    fewer = (1.0 + max(r, 0.0)) / max(1.0 - r, 1e-3)
    variance = energy / freedom * float(covariance[0, 0]) * fewer
    return float(scipy.special.stdtrit(max(freedom / fewer, 1.0), 0.975)) * float(np.sqrt(variance))
