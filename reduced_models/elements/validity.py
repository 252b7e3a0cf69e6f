"""Where an element stands for data, and the warning for leaving it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MARGIN = 0.05  # share of the interval of approach, and of the largest rate, that goes unmentioned
STILL = 1e-6  # spread of an approach over its size, below which its frequency means nothing
OCTAVE = 2.0  # likewise of frequency: in the contact's own band damping changes by a fifth over an octave

Band = tuple[float, float]


class OutsideValidityWarning(UserWarning):
    """An element was used where no data stands behind it; it is told once per element."""


def frequency_of(approach: NDArray[np.float64], rate: NDArray[np.float64]) -> float | None:
    """RMS angular frequency of a motion; None where it hardly moves."""
    if approach.size == 0:
        return None
    spread = float(np.std(approach))
    return float(np.std(rate)) / spread if spread > STILL * float(np.abs(approach).max()) else None


def text_of(band: Band) -> str:
    """The band in words."""
    return f"{band[0]:.4g} to {band[1]:.4g}"
