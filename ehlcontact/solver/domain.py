"""Computed region of a film, in Hertz semi-axes: how far the inlet is flooded. Default regions: `mesh_choice`."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log

from ehlcontact.checks import require_finite, require_integer
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.parts import LARGEST_LOAD
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.film_formulas import lightness
from ehlcontact.point import MoesPoint

MOST_INTERVALS = 2048  # along X: beyond, grids of ten million nodes that no solver here affords
HELD_BY_MARGINS = 0.08  # growth of the Hertz ellipse (of a quarter more load) for which no region has to grow
# Where the film holds the bodies apart by much of a dry approach, pressure reaches far beyond the Hertz ellipse:
# at light loads the inlet grows with a power of the load number, outlet and sides with a power of its growth. That
# begins gently, from twice to half the load number of `formulas.LIGHT_LOAD`: answers have no kink there.
LIGHT_GROWTH, LIGHT_SIDES_GROWTH = 0.6, 1.2
MOST_LIGHT_GROWTH = 10.0


@dataclass(frozen=True, slots=True)
class Domain:
    """Region [x_in, x_out] x [-y_max, y_max] in X = x/a, Y = y/b; pressure is zero on its border.

    It belongs to the mesh and is in semi-axes at every point: a film needs the same region in these whatever its
    load, so that one `Grid` serves a range of operating points.

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
    @takes(largest_load=LARGEST_LOAD)
    def for_load(cls, largest_load: float = 1.0) -> Domain:
        """Return the default region, widened with the Hertz ellipse of the largest load to come (static 1)."""
        growth = max(largest_load, 1.0) ** (1.0 / 3.0) - 1.0
        if growth < HELD_BY_MARGINS:
            return cls()
        return cls(-4.5 - growth, 1.5 + 3.0 * growth, 3.0 + 2.0 * growth)

    @classmethod
    @takes(point=Object(MoesPoint, "a MoesPoint"))
    def for_point(cls, point: MoesPoint, largest_load: float = 1.0) -> Domain:
        """Return the default region of a contact, widened for a load that will rise and for a light one."""
        domain, light = cls.for_load(largest_load), lightness(log(point.load_number))
        if light == 0.0:
            return domain
        wider = min(exp(light * LIGHT_GROWTH), MOST_LIGHT_GROWTH)
        sides = wider**LIGHT_SIDES_GROWTH
        return cls(domain.x_in * wider, domain.x_out * sides, domain.y_max * sides)

    @classmethod
    def near(cls) -> Domain:
        """Return the region around a film so thin that oil further out makes no difference to the film.

        Approach and damping do depend on the oil further out.
        """
        return cls(-2.0, 1.35, 1.6)

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
