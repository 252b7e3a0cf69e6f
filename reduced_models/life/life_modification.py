"""Factors of modified rating life: viscosity ratio, contamination, a_ISO of ball bearings, a1.

ISO 281:2007. The viscosity ratio kappa is the viscosity of the oil over the one that the speed needs, with n in
rev/min, Dpw in mm and viscosities in mm2/s,

    nu1 = 45000 n^-0.83 Dpw^-0.5  below 1000 rev/min,    4500 n^-0.5 Dpw^-0.5  from there on.

From a film it is about Lambda^1.3 with the film over the composite roughness. Radial ball bearings have

    a_ISO = 0.1 (1 - (2.5671 - b/kappa^c)^0.83 (ec Cu/P)^(1/3))^-9.3,    at most 50,

b, c = 2.2649, 0.054381 from 0.1 on, 1.9987, 0.19087 from 0.4 on, 1.9987, 0.071739 from 1 to 4; larger ratios count
as 4.

Annex A: ec = min(c1 kappa^0.68 Dpw^0.55, 1) (1 - c2/Dpw^(1/3)), constants by the cleanliness of oil or grease.

ISO/TR 1281-2: a1 = 0.95 (ln(100/S)/ln(100/90))^(2/3) + 0.05 for a reliability of S %; the table of ISO 281 rounds
it.
"""

from __future__ import annotations

from math import inf, log
from typing import NamedTuple

from ehlcontact.checks import require_between, require_finite, require_positive
from ehlcontact.errors import InputError

LEAST_RATIO, MOST_RATIO = 0.1, 4.0  # viscosity ratios of the standard
MOST_MODIFICATION = 50.0
FILM_POWER = 1.3  # of Lambda
SLOW = 1000.0  # rev/min
BASIC_RELIABILITY, MOST_RELIABILITY = 90.0, 99.95  # %
REGIONS = ((1.0, 1.9987, 0.071739), (0.4, 1.9987, 0.19087), (0.0, 2.2649, 0.054381))  # from kappa: b, c
PERCENT = 5.0  # from which a contamination is one in percent
LARGE_PITCH = 0.5  # m, from which grease with slight contamination has another constant


class Cleanliness(NamedTuple):
    """Constants of the contamination factor."""

    c1: float
    c2: float
    c2_large: float | None = None  # above `LARGE_PITCH`


CLASSES = {  # of grease in words; of oil by the code of ISO 4406, in a bath or filtered offline, or inline
    "high cleanliness": Cleanliness(0.0864, 0.6796),
    "normal cleanliness": Cleanliness(0.0432, 1.141),
    "slight contamination": Cleanliness(0.0177, 1.887, 1.677),
    "severe contamination": Cleanliness(0.0115, 2.662),
    "very severe contamination": Cleanliness(0.00617, 4.06),
    "-/13/10": Cleanliness(0.0864, 0.5796),
    "-/15/12": Cleanliness(0.0288, 1.141),
    "-/17/14": Cleanliness(0.0133, 1.67),
    "-/19/16": Cleanliness(0.00864, 2.5164),
    "-/21/18": Cleanliness(0.00411, 3.8974),
    "-/13/10 filtered": Cleanliness(0.0864, 0.5663),
    "-/15/12 filtered": Cleanliness(0.0432, 0.9987),
    "-/17/14 filtered": Cleanliness(0.0288, 1.6329),
    "-/19/16 filtered": Cleanliness(0.0216, 2.3362),
}


def reference_viscosity(speed_rpm: float, pitch_diameter: float) -> float:
    """Kinematic viscosity nu1 [m2/s] that a speed [rev/min] and a pitch diameter [m] need."""
    pitch = (1e3 * pitch_diameter) ** -0.5
    return 1e-6 * pitch * (45000.0 * speed_rpm**-0.83 if speed_rpm < SLOW else 4500.0 * speed_rpm**-0.5)


def film_ratio(lambda_ratio: float) -> float:
    """Viscosity ratio that a film over the composite roughness stands for."""
    return float(lambda_ratio**FILM_POWER)


def require_contamination(value: float | str) -> float | str:
    """Contamination as a factor or a class; raises `InputError` for anything else."""
    if isinstance(value, str):
        words = value.strip().lower()
        if words not in CLASSES:
            raise InputError("contamination", value, f"a factor above 0 and at most 1, or {', '.join(CLASSES)}")
        return words
    factor = require_finite("contamination", value)
    if not 0.0 < factor <= 1.0:
        guess = f" ({factor:g} % is {0.01 * factor:g})" if PERCENT <= factor <= 100.0 else ""
        raise InputError(
            "contamination", value, f"above 0 and at most 1, which is clean{guess}; or a class by name"
        )
    return factor


def contamination_factor(contamination: float | str, viscosity_ratio: float, pitch_diameter: float) -> float:
    """Contamination factor ec: as it is given, or of a class at a viscosity ratio and a pitch diameter [m].

    Raises
    ------
    InputError
        Contamination beyond (0, 1], or an unknown class.
    """
    given = require_contamination(contamination)
    if not isinstance(given, str):
        return given
    own, pitch = CLASSES[given], 1e3 * pitch_diameter
    c2 = own.c2_large if own.c2_large is not None and pitch_diameter >= LARGE_PITCH else own.c2
    return max(min(own.c1 * viscosity_ratio**0.68 * pitch**0.55, 1.0) * (1.0 - c2 / pitch ** (1.0 / 3.0)), 0.0)


def require_viscosity_ratio(value: float) -> float:
    """A viscosity ratio of the standard; raises `InputError` outside it."""
    return require_between("viscosity_ratio", value, LEAST_RATIO, MOST_RATIO)


def life_modification(viscosity_ratio: float, limit_ratio: float) -> float:
    """Life modification factor a_ISO of radial ball bearings.

    Parameters
    ----------
    viscosity_ratio : float
        0.1 to 4.
    limit_ratio : float
        Contamination factor times fatigue load limit over equivalent load, ec Cu/P.

    Raises
    ------
    InputError
        A viscosity ratio outside the standard.
    """
    kappa = require_viscosity_ratio(viscosity_ratio)
    if limit_ratio == inf:
        return MOST_MODIFICATION
    b, c = next((b, c) for least, b, c in REGIONS if kappa >= least)
    left = 1.0 - (2.5671 - b / kappa**c) ** 0.83 * limit_ratio ** (1.0 / 3.0)
    return MOST_MODIFICATION if left <= 0.0 else min(0.1 * left**-9.3, MOST_MODIFICATION)


def reliability_factor(reliability: float) -> float:
    """Factor a1 of a reliability of 90 to 99.95 %; raises `InputError` outside."""
    percent = require_reliability(reliability)
    return float(0.95 * (log(100.0 / percent) / log(100.0 / BASIC_RELIABILITY)) ** (2.0 / 3.0) + 0.05)


def require_reliability(value: float) -> float:
    """A reliability [%] of the standard; raises `InputError` outside it."""
    number = require_positive("reliability", value)
    if not BASIC_RELIABILITY <= number <= MOST_RELIABILITY:
        guess = f"; did you mean {100.0 * number:g}?" if BASIC_RELIABILITY <= 100.0 * number <= 100.0 else ""
        raise InputError("reliability", value, f"between 90 and 99.95 %{guess}")
    return number
