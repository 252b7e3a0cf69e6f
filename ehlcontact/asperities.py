"""`Asperities`: rough surfaces that carry part of the load beside the film (Greenwood and Tripp 1970).

Input, and law of the pressure of asperities; their share of the load in a solve: `ehlcontact.solver.mixed_film`;
equations and limits: docs/asperities.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from math import gamma, pi, sqrt
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import parts, require_between, require_positive
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint, Point
from ehlcontact.summary import Summary

Array = NDArray[np.float64]

RANGES = {"rq": (0.0, 2e-5), "summits": (0.005, 0.5), "rq_over_radius": (1e-6, 0.1)}
NO_CONTACT = 6.0  # gap over rq: the heights that remain carry 1e-10 of what they do at 0
PRESSED = -8.0  # gap over rq: only iterates have smaller ones


class AsperityNumbers(NamedTuple):
    """Dimensionless numbers of the law of pressure over gap at an operating point."""

    rq: float  # over the dry approach
    unit: float  # pressure of F_5/2 = 1, over the Hertz pressure


@fields_take(rq="m")
@dataclass(frozen=True, slots=True)
class Asperities(Summary):
    """Asperities of both surfaces together: summits of one radius, Gaussian heights, elastic.

    Parameters
    ----------
    rq : float
        Composite roughness, (Rq1^2 + Rq2^2)^(1/2) [m].
    summits : float
        Summits per area times their radius times `rq`; .03 to .05 on most finished surfaces.
    rq_over_radius : float
        `rq` over the radius of the summits; 1e-4 to 1e-2.

    Raises
    ------
    InputError
        A value outside its range.

    Notes
    -----
    J. A. Greenwood and J. H. Tripp, Proc. Instn Mech. Engrs 185 (1970) 625-634, for two rough planes.

    Examples
    --------
    >>> round(float(Asperities(0.1e-6).pressure(0.1e-6, 2.26e11)) / 1e6, 1)
    10.8
    """

    rq: float
    summits: float = 0.05
    rq_over_radius: float = 0.01

    def __post_init__(self) -> None:
        for name, ends in RANGES.items():
            value = require_positive(name, getattr(self, name))
            if name == "rq" and value > ends[1]:
                raise InputError("rq", value, f"up to {ends[1]:g} m (given in um?)")
            object.__setattr__(self, name, require_between(name, value, *ends))

    @classmethod
    def from_moments(cls, m0: float, m2: float, m4: float) -> Asperities:
        """From the moments of the profile's spectrum: mean squares of height [m2], slope [1] and curvature [1/m2].

        Of both surfaces together: the sum of theirs. Isotropic surfaces; J. I. McCool, Wear 107 (1986) 37-60.

        Raises
        ------
        InputError
            Moments that are not positive, or make a number out of range.
        """
        m0, m2, m4 = (require_positive(name, m) for name, m in (("m0", m0), ("m2", m2), ("m4", m4)))
        density, radius = m4 / (6.0 * pi * sqrt(3.0) * m2), 0.375 * sqrt(pi / m4)
        return cls(sqrt(m0), density * radius * sqrt(m0), sqrt(m0) / radius)

    @takes(e_reduced=parts.MODULUS)
    def unit(self, e_reduced: float) -> float:
        """Pressure [Pa] of F_5/2 = 1 at the reduced modulus E' of `Geometry` [Pa]."""
        shape = self.summits**2 * sqrt(self.rq_over_radius)
        return 8.0 * sqrt(2.0) * pi / 15.0 * shape * require_positive("e_reduced", e_reduced)

    @takes(gap=parts.FILM, e_reduced=parts.MODULUS)
    def pressure(self, gap: ArrayLike, e_reduced: float) -> Any:
        """Mean pressure [Pa] of the asperities at a gap [m] between the mean planes."""
        return self.unit(e_reduced) * greenwood_tripp(np.asarray(gap) / self.rq)

    @takes(gap=parts.FILM, e_reduced=parts.MODULUS)
    def stiffness(self, gap: ArrayLike, e_reduced: float) -> Any:
        """Increase of the pressure over decrease of the gap [Pa/m]."""
        return 2.5 * self.unit(e_reduced) / self.rq * greenwood_tripp(np.asarray(gap) / self.rq, 1.5)

    @takes(pressure=parts.ANY, e_reduced=parts.MODULUS)
    def gap(self, pressure: float, e_reduced: float) -> float:
        """Gap [m] at which they carry a pressure [Pa] alone, as at standstill when the oil has left.

        Raises
        ------
        InputError
            A pressure that is not positive, or one for which the gap would be below -8 rq.
        """
        wanted = require_positive("pressure", pressure) / self.unit(e_reduced)
        most = float(greenwood_tripp(PRESSED))
        if wanted > most:
            raise InputError(
                "pressure", pressure, f"up to {most * self.unit(e_reduced):.3g} Pa on these asperities"
            )
        last = np.nextafter(NO_CONTACT, 0.0)
        if wanted <= float(greenwood_tripp(last)):
            return NO_CONTACT * self.rq
        return self.rq * float(scipy.optimize.brentq(lambda x: np.log(greenwood_tripp(x) / wanted), PRESSED, last))

    @takes(h_central=parts.FILM, mean_pressure=parts.PRESSURE, e_reduced=parts.MODULUS)
    def load_share(self, h_central: ArrayLike, mean_pressure: ArrayLike, e_reduced: float) -> Any:
        """Share of the load by the central film [m] and the load over the Hertz ellipse [Pa], without a solve.

        ``1 - exp(-p/mean_pressure)`` with their pressure p at the central film. It agrees with solved films of
        wide contacts under bearing loads within 30 % where it is above 0.01 %, docs/asperities.md.
        """
        return -np.expm1(-self.pressure(h_central, e_reduced) / np.asarray(mean_pressure))

    def numbers(self, point: Point) -> AsperityNumbers:
        """Numbers of the law at an operating point.

        Raises
        ------
        InputError
            A dimensionless point.
        """
        if not isinstance(point, OperatingPoint):
            allowed = "left out at a dimensionless point: roughness is in metres, and asperities have a modulus"
            raise InputError("asperities", type(self).__name__, allowed)
        scales = point.scales
        return AsperityNumbers(self.rq / scales.length, self.unit(point.geometry.e_reduced) / scales.pressure)

    def to_dict(self) -> dict[str, float]:
        """Ready for JSON."""
        return asdict(self)

    @classmethod
    def from_dict(cls, entries: Mapping[str, Any]) -> Asperities:
        """Back from `to_dict`."""
        return cls(**entries)


def greenwood_tripp(ratio: ArrayLike, power: float = 2.5) -> Array:
    """F_n(x), the integral of (s - x)^n over Gaussian heights s above x.

    It is a parabolic cylinder function: Gamma(n + 1)/(2 pi)^(1/2) exp(-x^2/4) D_{-n-1}(x) (NIST DLMF 12.5.1).
    Taken as 0 from x = 6 on, and at x = -8 below it.
    """
    x = np.clip(np.asarray(ratio, dtype=float), PRESSED, NO_CONTACT)
    found = gamma(power + 1.0) / sqrt(2.0 * pi) * np.exp(-0.25 * x * x) * scipy.special.pbdv(-power - 1.0, x)[0]
    return np.where(x < NO_CONTACT, found, 0.0)
