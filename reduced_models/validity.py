"""Where an element stands for data, and the warning for leaving it."""

from __future__ import annotations

MARGIN = 0.05  # share of the interval of approach, and of the largest rate, that goes unmentioned
OCTAVE = 2.0  # likewise of frequency: in the contact's own band damping changes by a fifth over an octave

Band = tuple[float, float]


class OutsideValidityWarning(UserWarning):
    """An element was used where no data stands behind it; it is told once per element."""


def text_of(band: Band) -> str:
    """The band in words."""
    return f"{band[0]:.4g} to {band[1]:.4g}"
