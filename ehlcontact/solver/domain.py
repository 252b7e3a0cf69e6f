"""The computed region in Hertz units: how far the inlet is flooded is a physical input."""

from __future__ import annotations

from dataclasses import dataclass

from ehlcontact.checks import require_finite, require_instance, require_integer
from ehlcontact.errors import InputError
from ehlcontact.hertz import radius_ratio
from ehlcontact.point import MoesPoint

LIGHT_LOAD = 3.0  # N below which the default region grows


@dataclass(frozen=True, slots=True)
class Domain:
    """Region [x_in, x_out] x [-y_max, y_max] in X = x/a, Y = y/b; pressure is zero on its border.

    Damping depends on it (by about 1/extent^2), stiffness hardly.

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
        if growth < 0.08:  # a quarter more load: the margins hold it
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
    allowed = "a multiple of 16 between 16 and 2048"
    intervals = require_integer("n", n, allowed, 16)
    if intervals % 16 or intervals > 2048:
        raise InputError("n", n, allowed)
    return intervals


def default_domain(point: MoesPoint, largest_load: float = 1.0) -> Domain:
    """Return the default region, widened for a load that will rise and for a light one.

    Where the film holds the bodies apart by much of a dry approach, pressure reaches far beyond the Hertz
    ellipse: below N = sqrt(Rx/Ry) M = 3, Wijnant's load number, inlet and sides grow with N^-0.6.
    """
    domain = Domain.for_load(largest_load)
    N = radius_ratio(point.kappa) ** 0.5 * point.M
    if N >= LIGHT_LOAD:
        return domain
    wider = min((LIGHT_LOAD / N) ** 0.6, 10.0)
    return Domain(domain.x_in * wider, domain.x_out * wider**0.7, domain.y_max * wider)


def check_domain(domain: Domain | None, point: MoesPoint, largest_load: float = 1.0) -> Domain:
    """Return `domain`, or the default for the point and the largest load to come."""
    if domain is None:
        return default_domain(point, largest_load)
    require_instance("domain", domain, Domain, "a Domain(x_in, x_out, y_max)")
    return domain
