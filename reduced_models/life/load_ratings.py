"""`LoadRatings`: basic dynamic and static load rating and fatigue load limit of a ball bearing.

Basic dynamic radial load rating of ISO 281:2007, one row, lengths in mm, ratings in N:

    C = bm fc (cos a)^0.7 Z^(2/3) Dw^1.8,    above 25.4 mm with 3.647 Dw^1.4 in place of Dw^1.8,    bm = 1.3

The standard tabulates fc over g = Dw cos a/Dpw for grooves of 0.52. Its formula is in ISO/TR 1281-1:

    fc = 0.41 A lambda (1 + q^(10/3))^-0.3 g^0.3 (1 - g)^1.39/(1 + g)^(1/3) (2 ri/(2 ri - Dw))^0.41
    q = 1.04 ((1 - g)/(1 + g))^1.72 (ri/re (2 re - Dw)/(2 ri - Dw))^0.41

with A = 98.0665 and lambda = 0.95; it is within 0.1 % of all entries. Grooves closer than 0.52 do not raise a
rating; wider ones lower it.

The basic static load rating of ISO 76 is the radial load under which the most loaded ball, with five times the
mean, has a Hertz pressure of 4.2 GPa. The fatigue load limit is the simple estimate of ISO 281, annex B: C0/22,
above a pitch diameter of 100 mm times (100 mm/Dpw)^0.5.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import cos
from typing import Any

from ehlcontact.checks import require_positive
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary
from reduced_models.life.internal_geometry import InternalGeometry

MATERIAL = 1.3  # bm of radial ball bearings of contemporary steel
RATING_CONSTANT, REDUCTION = 0.41 * 98.0665, 0.95  # of fc
RATED_GROOVE = 0.52  # closest groove that raises a rating
LARGE_BALL, LARGE_FACTOR = 25.4, 3.647  # mm
RATED_PRESSURE = 4.2e9  # Pa, of the most loaded ball under C0
STRIBECK = 5.0  # most loaded ball over mean ball under a radial load
LIMIT_SHARE, LIMIT_PITCH = 22.0, 100e-3  # C0 over Cu; m, from which larger bearings have less
FAR = 10.0  # over the rating of the geometry or below it: a slip of the unit
SIGNIFICANT = 4  # digits of ratings in messages
FROM_GEOMETRY, GIVEN = "from the geometry", "given"


@dataclass(frozen=True, kw_only=True)
class LoadRatings(Summary):
    """Ratings of a bearing with their sources.

    Attributes
    ----------
    dynamic, static, fatigue_limit : float
        C, C0, Cu [N].
    dynamic_source, static_source, fatigue_source : str
        From the geometry, from a catalogue, or given.
    """

    dynamic: float
    static: float
    fatigue_limit: float
    dynamic_source: str
    static_source: str
    fatigue_source: str

    def _summary_lines(self) -> list[str]:
        rows = (("C", "dynamic"), ("C0", "static"), ("Cu", "fatigue_limit"))
        sources = self.dynamic_source, self.static_source, self.fatigue_source
        return [
            f"{symbol} {1e-3 * getattr(self, name):.4g} kN, {source}"
            for (symbol, name), source in zip(rows, sources, strict=True)
        ]

    def to_dict(self) -> dict[str, Any]:
        """Ratings [N] and sources, ready for JSON."""
        return asdict(self)

    @classmethod
    def of(
        cls,
        geometry: InternalGeometry,
        *,
        dynamic: float | None = None,
        static: float | None = None,
        fatigue_limit: float | None = None,
    ) -> LoadRatings:
        """Ratings as they are given here [N]; else those of the bearing or its catalogue; else of the geometry.

        Raises
        ------
        InputError
            A rating that is not > 0, or ten times away from that of the geometry.
        """
        by_size = dynamic_rating(geometry), static_rating(geometry)
        given = ("dynamic_rating", dynamic, by_size[0]), ("static_rating", static, by_size[1])
        printed = (
            (geometry.printed_dynamic, geometry.dynamic_source),
            (geometry.printed_static, geometry.static_source),
        )
        ratings: list[tuple[float, str]] = []
        for (field, value, own), (known, source) in zip(given, printed, strict=True):
            if value is not None:
                ratings.append((require_rating(field, value, own), GIVEN))
            else:
                ratings.append((own, FROM_GEOMETRY) if known is None else (known, source))
        (c, c_source), (c0, c0_source) = ratings
        usual = fatigue_load_limit(c0, geometry.pitch_diameter)
        limit = usual if fatigue_limit is None else require_rating("fatigue_limit", fatigue_limit, usual)
        return cls(
            dynamic=c,
            static=c0,
            fatigue_limit=limit,
            dynamic_source=c_source,
            static_source=c0_source,
            fatigue_source="from C0" if fatigue_limit is None else GIVEN,
        )


def fc_factor(gamma: float, conformity_inner: float, conformity_outer: float) -> float:
    """Factor fc of ISO 281 from Dw cos a/Dpw and the conformities of both grooves."""
    inner, outer = (max(one, RATED_GROOVE) for one in (conformity_inner, conformity_outer))
    both = (1.0 + strength_ratio(gamma, inner, outer, 1.04) ** (10.0 / 3.0)) ** -0.3
    size = gamma**0.3 * (1.0 - gamma) ** 1.39 / (1.0 + gamma) ** (1.0 / 3.0)
    return RATING_CONSTANT * REDUCTION * both * size * (2.0 * inner / (2.0 * inner - 1.0)) ** 0.41


def strength_ratio(gamma: float, inner: float, outer: float, constant: float) -> float:
    """Rated load of the inner over that of the outer race; ISO 281 has 1.04, ISO/TS 16281 has 1.044."""
    grooves = inner / outer * (2.0 * outer - 1.0) / (2.0 * inner - 1.0)
    return float(constant * ((1.0 - gamma) / (1.0 + gamma)) ** 1.72 * grooves**0.41)


def dynamic_rating(geometry: InternalGeometry) -> float:
    """Basic dynamic radial load rating C from the geometry [N]."""
    g, ball = geometry, 1e3 * geometry.ball_diameter
    size = ball**1.8 if ball <= LARGE_BALL else LARGE_FACTOR * ball**1.4
    fc = fc_factor(g.gamma, g.conformity_inner, g.conformity_outer)
    return MATERIAL * fc * cos(g.contact_angle) ** 0.7 * g.balls ** (2.0 / 3.0) * size


def static_rating(geometry: InternalGeometry) -> float:
    """Basic static radial load rating C0 from the geometry [N]."""
    ball = (RATED_PRESSURE / max(geometry.unit_pressures)) ** 3
    return geometry.balls * ball / STRIBECK * cos(geometry.contact_angle)


def fatigue_load_limit(static: float, pitch_diameter: float) -> float:
    """Fatigue load limit Cu [N] of a ball bearing with this C0 [N] and pitch diameter [m]."""
    return static / LIMIT_SHARE * min((LIMIT_PITCH / pitch_diameter) ** 0.5, 1.0)


def rated_loads(geometry: InternalGeometry, dynamic: float) -> tuple[float, float]:
    """Loads of a ball [N] under which the inner and the outer race have a life of a million turns: Q_ci, Q_ce."""
    g = geometry
    ratio = strength_ratio(g.gamma, g.conformity_inner, g.conformity_outer, 1.044)
    share = dynamic / (g.balls * cos(g.contact_angle) ** 0.7)
    inner = share / 0.407 * (1.0 + ratio ** (10.0 / 3.0)) ** 0.3
    outer = share / 0.389 * (1.0 + ratio ** (-10.0 / 3.0)) ** 0.3
    return inner, outer


def require_rating(field: str, value: float, own: float) -> float:
    """A rating that is given [N]; raises `InputError` far from that of the geometry, with the unit meant."""
    rating = require_positive(field, value)
    if own / FAR < rating < own * FAR:
        return rating
    guess = f"; did you mean {grouped(1e3 * rating)} N?" if own / FAR < 1e3 * rating < own * FAR else ""
    allowed = f"in N, near that of the geometry, {grouped(own)} N{guess}"
    raise InputError(field, value, allowed)


def grouped(value: float) -> str:
    """A number of at most four digits that count, its thousands parted by spaces: 14 000."""
    rounded = float(f"{value:.{SIGNIFICANT}g}")
    return f"{rounded:,.0f}".replace(",", " ") if rounded >= 1e3 else f"{rounded:g}"
