"""Statistical features of a vibration signal."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import ArrayLike

from ehlcontact.checks import as_column
from ehlcontact.errors import InputError


@dataclass(frozen=True)
class Indicators:
    """Features of a signal about its mean; without a unit but for the first two, which have that of the signal.

    Attributes
    ----------
    rms, peak : float
        Root of the mean square, largest magnitude.
    crest_factor, shape_factor, impulse_factor, clearance_factor : float
        Peak over rms, rms over mean magnitude, peak over mean magnitude, peak over the squared mean root of the
        magnitude.
    skewness, kurtosis : float
        Third and fourth central moment over powers of rms; the kurtosis of Gaussian noise is 3.
    """

    rms: float
    peak: float
    crest_factor: float
    shape_factor: float
    impulse_factor: float
    clearance_factor: float
    skewness: float
    kurtosis: float

    def to_dict(self) -> dict[str, float]:
        """All of it, ready for JSON."""
        return asdict(self)


def indicators(signal: ArrayLike) -> Indicators:
    """Features of a signal, shape (k,).

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
    )
