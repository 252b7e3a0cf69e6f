"""Operating point with its film, in SI where known: the input of the assumptions."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Protocol

from ehlcontact.checks import shown
from ehlcontact.errors import InputError
from ehlcontact.film_formulas import hamrock_dowson_minimum
from ehlcontact.hertz import elliptic_integrals, radius_ratio
from ehlcontact.point import MoesPoint, Point, Scales, moes_point, scales_of

NO_SI = "not judged: a dimensionless point has no speed and no size; an OperatingPoint has"


BY_FORMULA = "by Hamrock and Dowson's formula"
UNKNOWN = "as given"  # of a film that does not say where it is from


class KnownFilm(Protocol):
    """What a `SteadyResult`, or an answer of the atlas, says about the film.

    ``film_origin``, where it has one, says how it was found and how sure that is; ``domain`` is its region.
    """

    @property
    def h_central(self) -> float:
        """Film at the centre."""

    @property
    def h_min(self) -> float:
        """Smallest film."""


@dataclass(frozen=True, slots=True)
class Contact:
    """A point with its film, and in SI as far as the scales tell."""

    moes: MoesPoint
    scales: Scales | None
    central: float  # film in dry approaches
    smallest: float | None  # likewise, None where no formula has it
    origin: str = BY_FORMULA  # of the smallest film, in words

    @classmethod
    def of(cls, point: Point, film: KnownFilm | None) -> Contact:
        """Take the film that is known, or the one to be expected.

        Raises
        ------
        InputError
            A `film` that is none, or that of another point.
        """
        moes = moes_point(point)
        bare = cls(moes, scales_of(point), moes.expected_film, None)
        if film is not None:
            if not all(hasattr(film, name) for name in ("h_central", "h_min")):
                raise InputError("film", shown(film), "a steady film, or an answer of the atlas")
            origin = getattr(film, "film_origin", UNKNOWN)
            own = getattr(film, "point", None)
            if own is not None and own.moes != moes:
                other, this = (f"M {p.M:.4g}, L {p.L:.4g}, kappa {p.kappa:.4g}" for p in (own.moes, moes))
                raise InputError("film", f"of the point {other}", f"one of this point, {this}")
            film = getattr(film, "dimensionless", film)
            return cls(moes, bare.scales, float(film.h_central), float(film.h_min), origin)
        return cls(moes, bare.scales, bare.central, bare.expected_smallest() if bare.scales else None)

    def expected_smallest(self) -> float:
        """Smallest film of Hamrock and Dowson in dry approaches."""
        s, rx, modulus, u = self.require_si()
        oil = self.moes
        U, W = oil.eta0 * u / (modulus * rx), s.force / (modulus * rx * rx)
        return hamrock_dowson_minimum(U, oil.alpha * modulus, W, oil.kappa) * rx / s.length

    def require_si(self) -> tuple[Scales, float, float, float]:
        """Scales, Rx [m], E' [Pa] and mean speed [m/s], from Hertz' formulas backwards."""
        s = self.scales
        assert s is not None
        K, E = elliptic_integrals(self.moes.kappa)
        modulus = 3.0 * s.force * K / (pi * s.b * s.length)
        radius = s.a * s.a * K / (2.0 * E * s.length)
        return s, radius * (1.0 + radius_ratio(self.moes.kappa)), modulus, s.a / s.time
