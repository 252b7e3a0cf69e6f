"""The computed region in Hertz units: how far the inlet is flooded is a physical input."""

from __future__ import annotations

from dataclasses import dataclass

from ehlcontact.checks import require_finite, require_integer
from ehlcontact.errors import InputError

MOST_INTERVALS = 2048  # along X: beyond, grids of ten million nodes that no solver here affords
HELD_BY_MARGINS = 0.08  # growth of the Hertz ellipse (of a quarter more load) for which no region has to grow


@dataclass(frozen=True, slots=True)
class Domain:
    """Region [x_in, x_out] x [-y_max, y_max] in X = x/a, Y = y/b; pressure is zero on its border.

    Damping depends on it (by about 1/extent^2), stiffness hardly.

    Parameters
    ----------
    x_in, x_out : float
        Ends along rolling, over the semi-axis a: x_in = -4.5 is 3.5 semi-axes ahead of the contact.
    y_max : float
        Half the width across, over the semi-axis b.

    Raises
    ------
    InputError
        A bound not finite, or one that cuts into the Hertz ellipse (x_in > -1.2, x_out or y_max < 1.2).
    """

    x_in: float = -4.5
    x_out: float = 1.5
    y_max: float = 3.0

    def __post_init__(self) -> None:
        for name in ("x_in", "x_out", "y_max"):
            object.__setattr__(self, name, require_finite(name, getattr(self, name)))
        if not -100.0 <= self.x_in <= -1.2:
            raise InputError("x_in", self.x_in, "between -100 and -1.2 (left of the Hertz ellipse)")
        for name in ("x_out", "y_max"):
            if not 1.2 <= getattr(self, name) <= 100.0:
                raise InputError(name, getattr(self, name), "between 1.2 and 100 (beyond the Hertz ellipse)")

    @classmethod
    def for_load(cls, largest_load: float = 1.0) -> Domain:
        """Return the default region, widened with the Hertz ellipse of the largest load to come (static 1)."""
        growth = max(largest_load, 1.0) ** (1.0 / 3.0) - 1.0
        if growth < HELD_BY_MARGINS:
            return cls()
        return cls(-4.5 - growth, 1.5 + 3.0 * growth, 3.0 + 2.0 * growth)

    def scaled(self, factor: float) -> Domain:
        """Return the region stretched by `factor`."""
        return Domain(self.x_in * factor, self.x_out * factor, self.y_max * factor)

    def as_tuple(self) -> tuple[float, float, float]:
        """(x_in, x_out, y_max)."""
        return self.x_in, self.x_out, self.y_max


def check_intervals(n: object) -> int:
    """Return `n`, intervals along X, or raise `InputError` unless a multiple of 16 from 16 to 2048."""
    allowed = f"a multiple of 16 between 16 and {MOST_INTERVALS}"
    intervals = require_integer("n", n, allowed, 16)
    if intervals % 16 or intervals > MOST_INTERVALS:
        raise InputError("n", n, allowed)
    return intervals
