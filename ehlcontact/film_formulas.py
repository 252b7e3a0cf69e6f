"""Published formulas for film thickness and approach, and for film losses by heat and starvation.

Regions and grids are chosen from them (`solver.mesh_choice`, through the properties of a `MoesPoint`), the atlas
interpolates what its contacts have over them, `assumptions` judges by them, and tests compare; what a solver
converges to on its grid does not depend on them. They take plain numbers: the inputs stand above this module.
"""

from __future__ import annotations

from math import exp, hypot, log, pi
from typing import Any

from ehlcontact.hertz import radius_ratio, scaled_axis, shape_factor

# Wijnant's load number below which the film holds the bodies apart by much of a dry approach, and the factor on
# it, either way, over which that sets in.
LIGHT_LOAD, LIGHT_BLEND = 3.0, 2.0


def load_number(M: float, kappa: float) -> float:
    """N = sqrt(Rx/Ry) M, which separates thick films from thin ones at any kappa; Wijnant, thesis, Twente 1998."""
    return radius_ratio(kappa) ** 0.5 * M


def lightness(log_load: float, light_load: float = LIGHT_LOAD, blend: float = LIGHT_BLEND) -> float:
    """How far ln N lies below that of a light load; 0 for heavy ones, and smooth between.

    ``max(0, ln(light_load/N))`` with its corner replaced, from N = light_load/blend to light_load blend, by the
    quartic of the same ends, slopes and curvatures.

    Parameters
    ----------
    log_load : float
        ln N.
    light_load : float
        Load number of the corner.
    blend : float
        Ratio of load numbers, > 1.
    """
    half = log(blend)
    t = min(max(0.5 * ((log(light_load) - log_load) / half + 1.0), 0.0), 1.0)
    return max(log(light_load) - log_load, 0.0) if t in {0.0, 1.0} else 2.0 * half * t**3 * (1.0 - 0.5 * t)


def nvm_central_film(M: float, L: float, kappa: float) -> float:
    """Central film in Moes units, incompressible.

    Nijenbanning, Venner and Moes, Wear 176 (1994) 217-229, with lambda = Rx/Ry.
    """
    lam = radius_ratio(kappa)
    shape = 1.0 + 0.006 * log(lam) + 0.63 * lam ** (4.0 / 7.0)
    h_ri = 145.0 * (1.0 + 0.796 * lam ** (14.0 / 15.0)) ** (-15.0 / 7.0) / (lam * M * M)
    h_ei = 3.18 * shape ** (-14.0 / 25.0) * lam ** (-1.0 / 15.0) * M ** (-2.0 / 15.0)
    h_00 = 1.8 / lam
    s = 1.5 * (1.0 + exp(-1.2 * h_ei / h_ri))
    isoviscous = (h_ri**1.5 + (h_ei**-4 + h_00**-4) ** (-3.0 / 8.0)) ** (2.0 / 3.0)
    if L == 0.0:
        return isoviscous
    h_rp = 1.29 * (1.0 + 0.691 * lam) ** (-2.0 / 3.0) * L ** (2.0 / 3.0)
    h_ep = 1.48 * shape ** (-7.0 / 20.0) * lam ** (-1.0 / 24.0) * M ** (-1.0 / 12.0) * L**0.75
    piezoviscous = (h_rp**-8 + h_ep**-8) ** (-1.0 / 8.0)
    return (isoviscous**s + piezoviscous**s) ** (1.0 / s)


def film_scatter(M: float, L: float, kappa: float, eta0: float, alpha: float) -> float:
    """Relative scatter of the central film by those of viscosity and pressure-viscosity coefficient of its oil.

    The root of the sum of squares of what either changes in `nvm_central_film`; M goes with eta0^-3/4, L with
    alpha eta0^1/4.
    """
    own = expected_film(M, L, kappa)
    thicker = expected_film(M * (1.0 + eta0) ** -0.75, L * (1.0 + eta0) ** 0.25, kappa) / own - 1.0
    stiffer = expected_film(M, L * (1.0 + alpha), kappa) / own - 1.0
    return hypot(thicker, stiffer)


def film_to_moes(M: float, kappa: float) -> float:
    """Factor from a film in dry approaches to the Moes film (h/Rx) sqrt(E' Rx/(eta0 u_sum))."""
    return scaled_axis(M, kappa) ** 2 / (2.0 * shape_factor(kappa))


def expected_film(M: float, L: float, kappa: float) -> float:
    """Published central film (`nvm_central_film`) in dry approaches."""
    return nvm_central_film(M, L, kappa) / film_to_moes(M, kappa)


def moes_pressure(M: float, L: float, kappa: float) -> float:
    """Alpha times the Hertz pressure."""
    return 3.0 * L * kappa * M / (2.0 * pi * scaled_axis(M, kappa) ** 2)


def wijnant_approach(M: float, L: float, kappa: float) -> float:
    """Approach over dry approach: ``1 - p N^q`` with N = sqrt(Rx/Ry) M; Wijnant, thesis, Twente 1998."""
    N = load_number(M, kappa)
    p = ((4.0 - 0.2 * L) ** 7 + (3.5 + 0.1 * L) ** 7) ** (1.0 / 7.0)
    return 1.0 - p * N ** -(0.6 + 0.6 * (L + 3.0) ** -0.5)


def hamrock_dowson_minimum(U: float, G: float, W: float, kappa: float) -> float:
    """Smallest film over Rx, with the *mean* speed: U = eta0 u_mean/(E' Rx), G = alpha E', W = f/(E' Rx^2).

    Hamrock and Dowson, J. Lubrication Technology 99 (1977) 264-276, for kappa from 1/8 to 1.
    """
    return float(3.63 * U**0.68 * G**0.49 * W**-0.073 * (1.0 - exp(-0.68 / kappa)))


def gupta_heating(thermal_load: float, pressure: float) -> float:
    """Film in pure rolling over the isothermal one: what the shear of the inlet heats.

    Gupta, Cheng, Zhu, Forster and Schrand, Tribology Transactions 35 (1992) 269-274, after Zhu and Cheng; as
    written in Schwarz, Schaefer and Sauer, Lubricants 11 (2023) 369, eqs. 12-14. Greenwood and Kauzlarich,
    J. Lubrication Technology 95 (1973) 417-426, had found the effect.

    Parameters
    ----------
    thermal_load : float
        ``-d eta0/dT u_mean^2/k``, with the conductivity k of the oil.
    pressure : float
        Hertz pressure over E'.
    """
    factor = (1.0 - 13.2 * pressure * thermal_load**0.42) / (1.0 + 0.213 * thermal_load**0.64)
    return float(max(factor, 0.0))


def wilson_heating(thermal_load: float) -> float:
    """The same without pressure: ``1/(1 + 0.1 L^0.64)`` with L of the *sum* of the speeds, four times ours.

    Wilson and Sheu, J. Lubrication Technology 105 (1983) 187-188, in pure rolling.
    """
    return float(1.0 / (1.0 + 0.1 * (4.0 * thermal_load) ** 0.64))


def flooding_distance(film: float) -> float:
    """Distance m* of the oil's edge from the centre, in semi-axes a, from which on the film is fully flooded.

    ``1 + 3.06 ((Rx/a)^2 h_c/Rx)^0.58``: Hamrock and Dowson, J. Lubrication Technology 99 (1977) 15-23, whose edge
    takes 3 % of the central film.

    Parameters
    ----------
    film : float
        Flooded central film as ``h_c Rx/a^2``.
    """
    return float(1.0 + 3.06 * film**0.58)


def starved_film(distance: float, flooded: float) -> float:
    """Central film over the flooded one, with oil from `distance` on, short of m* = `flooded`; the same paper."""
    return float(((distance - 1.0) / (flooded - 1.0)) ** 0.29) if distance < flooded else 1.0


def film_of_layer(ratio: Any, sharpness: Any) -> Any:
    """Central film over the flooded one under a layer of `ratio` times what the flooded film lets through.

    ``r/(1 + r^g)^(1/g)``: Chevalier, Lubrecht, Cann, Colin and Dalmaz, J. Tribology 120 (1998) 126-133.

    Parameters
    ----------
    ratio, sharpness : float or ndarray
        r, and g: 2 to 5 for circles, rising for wide ellipses.
    """
    return ratio / (1.0 + ratio**sharpness) ** (1.0 / sharpness)


def layer_sharpness(kappa: float) -> float:
    """Exponent g of `film_of_layer`, ``2.9 kappa^-0.63``: within 10 % of those of four points solved here.

    Those are in docs/notes/oil_supply.md, with kappa from 0.11 to 1.
    """
    return float(2.9 * kappa**-0.63)
