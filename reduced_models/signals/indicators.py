"""Statistical features of a vibration signal."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, require_positive
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary, wrapped

VELOCITY_BAND = (10.0, 1000.0)  # Hz, of vibration severity in ISO 20816-1
SEGMENT, SHORTEST = 1.0, 0.3  # s: of an averaged spectrum; three periods of the lowest frequency


@dataclass(frozen=True)
class Indicators(Summary):
    """Features of a signal about its mean, without a unit but for rms, peak and velocity.

    Attributes
    ----------
    rms, peak : float
        Root of the mean square, largest magnitude, in the unit of the signal.
    crest_factor, shape_factor, impulse_factor, clearance_factor : float
        Peak over rms, rms over mean magnitude, peak over mean magnitude, peak over the squared mean root of the
        magnitude.
    skewness, kurtosis : float
        Third and fourth central moment over powers of rms; the kurtosis of Gaussian noise is 3.
    velocity_rms_mm_s : float or None
        Root of the mean square of the velocity between 10 and 1000 Hz [mm/s], the severity of ISO 20816, of a
        signal that is an acceleration [m/s2]. None without a rate, of less than 0.3 s, and at less than 2 kHz.
    """

    rms: float
    peak: float
    crest_factor: float
    shape_factor: float
    impulse_factor: float
    clearance_factor: float
    skewness: float
    kurtosis: float
    velocity_rms_mm_s: float | None = None

    def _summary_lines(self) -> list[str]:
        shares = ("crest_factor", "shape_factor", "impulse_factor", "clearance_factor", "skewness", "kurtosis")
        velocity = "" if self.velocity_rms_mm_s is None else f", velocity {self.velocity_rms_mm_s:.4g} mm/s rms"
        return [
            f"rms {self.rms:.4g}, peak {self.peak:.4g} in the unit of the signal{velocity}",
            *wrapped([f"{name.replace('_', ' ')} {getattr(self, name):.4g}" for name in shares]),
        ]

    def to_dict(self) -> dict[str, float | None]:
        """All of it, ready for JSON."""
        return asdict(self)


@takes(rate="Hz")
def indicators(signal: ArrayLike, rate: float | None = None) -> Indicators:
    """Features of a signal, shape (k,).

    Parameters
    ----------
    signal : array_like, shape (k,)
        For the velocity an acceleration [m/s2].
    rate : float, optional
        Of its samples [Hz], for the velocity.

    Raises
    ------
    InputError
        Fewer than 4 samples, what is not finite, a constant signal.
    """
    column = as_column("signal", signal, least=4)
    about = column - column.mean()
    size = np.abs(about)
    peak = float(size.max())
    if peak <= np.finfo(float).eps * np.abs(column).max():
        raise InputError("signal", float(column[0]), "not constant")
    scaled = about / peak  # powers of small signals stay numbers
    rms, mean = float(np.sqrt(np.mean(scaled**2))), float(np.abs(scaled).mean())
    return Indicators(
        rms=peak * rms,
        peak=peak,
        crest_factor=1.0 / rms,
        shape_factor=rms / mean,
        impulse_factor=1.0 / mean,
        clearance_factor=float(np.sqrt(np.abs(scaled)).mean() ** -2),
        skewness=float(np.mean(scaled**3)) / rms**3,
        kurtosis=float(np.mean(scaled**4)) / rms**4,
        velocity_rms_mm_s=None if rate is None else _velocity(about, require_positive("rate", rate)),
    )


def _velocity(acceleration: NDArray[np.float64], rate: float) -> float | None:
    """Root of the mean square of the velocity in its band [mm/s], from a spectrum with Hann windows."""
    from scipy.signal import welch

    low, high = VELOCITY_BAND
    if acceleration.size < SHORTEST * rate or rate < 2.0 * high:
        return None
    hz, density = welch(acceleration, rate, "hann", min(acceleration.size, ceil(SEGMENT * rate)))
    inside = (low <= hz) & (hz <= high)
    squares = density[inside] / (2.0 * pi * hz[inside]) ** 2
    return float(1e3 * np.sqrt(squares.sum() * hz[1]))
