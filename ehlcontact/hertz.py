"""Dry elliptic contact after Hertz; its pressure, approach and semi-axes are used as scales throughout.

Semi-axes a along rolling (x) and b across (y), ``kappa = a/b``. Complete elliptic integrals K, E of the
parameter ``m = 1 - kappa**2`` hold for kappa above 1 too, where m is negative.
Nonato and Cavalca (2010), eqs. 2-4; Johnson, Contact Mechanics (1985), section 4.2.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, log, pi

import scipy

from ehlcontact.checks import parts, require_integer, require_positive
from ehlcontact.checks.kinds import Count
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError


def elliptic_integrals(kappa: float) -> tuple[float, float]:
    """Complete elliptic integrals K and E of the parameter 1 - kappa**2."""
    m = 1.0 - kappa * kappa
    return float(scipy.special.ellipk(m)), float(scipy.special.ellipe(m))


def shape_factor(kappa: float) -> float:
    """Share S of the undeformed gap ``S X^2 + (1-S) Y^2``; 1/2 for a circle, S(kappa) + S(1/kappa) = 1."""
    m = 1.0 - kappa * kappa
    if abs(m) < 1e-3:
        # (E - kappa^2 K)/((1 - kappa^2) K) is 0/0 on the circle: series of K and E in m.
        return 0.5 - m / 16.0 - m * m / 32.0
    K, E = elliptic_integrals(kappa)
    return (E - kappa * kappa * K) / (m * K)


def radius_ratio(kappa: float) -> float:
    """Rx/Ry of the undeformed surfaces for ellipse ratio kappa = a/b."""
    S = shape_factor(kappa)
    return kappa * kappa * (1.0 - S) / S


def scaled_axis(M: float, kappa: float) -> float:
    """A = a/(Rx U^(1/4)) under the Moes load M, with U = eta0 u_sum/(E' Rx)."""
    K, _ = elliptic_integrals(kappa)
    return (6.0 * kappa * shape_factor(kappa) * K * M / pi) ** (1.0 / 3.0)


def ellipse_ratio(radius_x: float, radius_y: float) -> float:
    """Ellipse ratio kappa = a/b from the radii of relative curvature.

    Raises
    ------
    InputError
        A radius is not a positive number, or the ratio is outside what the Hertz ellipse covers here
        (kappa between 1e-3 and 1e3).
    """
    target = log(require_positive("radius_x", radius_x) / require_positive("radius_y", radius_y))

    def mismatch(log_kappa: float) -> float:
        return log(radius_ratio(2.0**log_kappa)) - target

    bound = 10.0
    if mismatch(-bound) * mismatch(bound) > 0.0:
        raise InputError("radius_x/radius_y", radius_x / radius_y, "such that 1e-3 < kappa < 1e3")
    return float(2.0 ** scipy.optimize.brentq(mismatch, -bound, bound, xtol=1e-15, rtol=1e-14))


@dataclass(frozen=True, slots=True)
class HertzContact:
    """Dry Hertz solution in SI units."""

    a: float  # semi-axis along rolling [m]
    b: float  # semi-axis across [m]
    pressure: float  # maximum pressure p_h [Pa]
    approach: float  # mutual approach delta_H [m]
    kappa: float  # a/b


def hertz_contact(load: float, radius_x: float, radius_y: float, e_reduced: float) -> HertzContact:
    """Semi-axes, pressure and approach of the dry contact.

    Parameters
    ----------
    load : float
        Normal force [N].
    radius_x, radius_y : float
        Radii of relative curvature along rolling and across [m].
    e_reduced : float
        E' with 2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2 [Pa].

    Raises
    ------
    InputError
        An argument is not a positive number.
    """
    load = require_positive("load", load)
    e_reduced = require_positive("e_reduced", e_reduced)
    kappa = ellipse_ratio(radius_x, radius_y)
    K, E = elliptic_integrals(kappa)
    R = 1.0 / (1.0 / radius_x + 1.0 / radius_y)
    # b^3 = 6 E f R/(pi kappa^2 E') with E of 1 - kappa^2: in a it holds for kappa above 1 too.
    a = (6.0 * kappa * E * load * R / (pi * e_reduced)) ** (1.0 / 3.0)
    b = a / kappa
    return HertzContact(a, b, 1.5 * load / (pi * a * b), a * a * K / (2.0 * R * E), kappa)


@takes(radial_load=parts.FORCE, balls=Count(1, 10_000))
def most_loaded_ball(radial_load: float, balls: int) -> float:
    """Load on the ball that stands under the radial load of a bearing, without clearance or contact angle [N].

    Rigid rings that come closer by d in the load's direction compress the ball at angle psi by d cos(psi), so
    with Hertz' law Q(psi) = Q_max cos(psi)^(3/2) over the loaded half, and F_r = Q_max sum cos(psi)^(5/2).
    For 9 balls Q_max = 0.4872 F_r; Stribeck's 4.37/Z, the limit of many, is 0.4856. Harris, Rolling Bearing
    Analysis, ch. 7.

    Raises
    ------
    InputError
        Load not positive, or fewer than 3 balls.
    """
    load = require_positive("radial_load", radial_load)
    count = require_integer("balls", balls, "a whole number >= 3", 3)
    return load / sum(max(cos(2.0 * pi * k / count), 0.0) ** 2.5 for k in range(count))
