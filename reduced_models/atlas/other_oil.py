"""`OtherOil`: reading the atlas for oils of another alpha and eta0 than its own."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks.admissible_range import INPUTS
from ehlcontact.errors import InputError
from ehlcontact.lubricant.oil_laws import secant_over_slope
from ehlcontact.point import MoesPoint

_Floats = NDArray[np.float64]


@dataclass(frozen=True)
class OtherOil:
    """Range of alpha and eta0 around those of the atlas; correction and wider error bars for another oil.

    At given M, L and kappa, alpha and eta0 enter through the curvature of Roelands' law and the compressibility.
    Pressures up to about 2/alpha form the film, so the atlas is read at an L with the secant of ln(eta) up to
    there in place of its slope at ambient pressure, each over that of the oil of the atlas. Error bars widen by
    what is left: the largest change of ln of films, K, C and moment per unit of ln alpha and of ln eta0.
    """

    alpha: tuple[float, float]  # range [1/Pa]
    eta0: tuple[float, float]  # range [Pa s]
    secant: float  # alpha p at the end of the secant
    film: tuple[float, float]
    stiffness: tuple[float, float]  # K changes the less the thinner the film
    damping: tuple[float, float]
    moment: tuple[float, float]

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            object.__setattr__(self, name, float(value) if name == "secant" else tuple(map(float, value)))

    def require_accepted(self, point: MoesPoint, own: Mapping[str, Any]) -> None:
        """Raise `InputError` for an oil of other laws than the `own` of the table, or outside the range."""
        for name in ("viscosity", "density"):
            if getattr(point, name) != own[name]:
                raise InputError(name, getattr(point, name), f"{own[name]}, the law of the atlas")
        for name in ("alpha", "eta0"):
            (low, high), value = getattr(self, name), getattr(point, name)
            if not low <= value <= high:
                guess = INPUTS[name].slip(value)
                allowed = f"between {low:g} and {high:g} {INPUTS[name].unit}, the range of the atlas"
                raise InputError(name, value, f"{allowed} ({guess})" if guess else allowed)

    def factors(self, alpha: float, eta0: float, own: Mapping[str, Any]) -> _Floats:
        """Factors on M, L and kappa at which a table with an oil of its `own` is read for another."""
        slope = secant_over_slope(own["alpha"], own["eta0"], self.secant)
        return np.array([1.0, secant_over_slope(alpha, eta0, self.secant) / slope, 1.0])

    def error(self, alpha: float, eta0: float, own: Mapping[str, Any], k: int) -> _Floats:
        """Error bars of the smooth variables of films that it adds, at `k` frequencies, shape (5 + 2 k,)."""
        away = abs(math.log(alpha / own["alpha"])), abs(math.log(eta0 / own["eta0"]))
        film, K, C, moment = (
            float(np.dot(slope, away)) for slope in (self.film, self.stiffness, self.damping, self.moment)
        )
        return np.concatenate([[film, film, film, C, moment], np.full(k, K), np.full(k, C)])
