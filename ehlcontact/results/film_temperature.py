"""Temperatures of a film that was solved with heat."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.heat import Heat
from ehlcontact.summary import Summary

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FilmTemperature(Summary):
    """Temperatures above that of the inlet [K], at points in metres as at others.

    Attributes
    ----------
    inputs : Heat
        As given to `solve_steady`, with the data of the oil.
    mean : ndarray, shape (nx + 1, ny + 1)
        Mean over the film; without pressure that of the surfaces.
    surfaces : ndarray, shape (2, nx + 1, ny + 1)
        Of both surfaces, the faster one first.
    film_share : float
        Central film over that without heat, without thinning by sliding and between smooth surfaces, on the same
        grid.
    thermal_load : float
        Q = -d eta0/dT u_mean^2/k.
    balance : float
        Heat made in the film less heat given to the surfaces and carried away, over the former.
    """

    inputs: Heat
    mean: Array
    surfaces: Array
    film_share: float
    thermal_load: float
    balance: float

    def _summary_lines(self) -> list[str]:
        surfaces = float(self.surfaces.max())
        return [
            self.summary(False),
            f"above the inlet: film up to {self.largest:.3g} K, surfaces up to {surfaces:.3g} K",
            f"thermal load {self.thermal_load:.4g}; heat made and heat given away are {self.balance:.2g} apart",
        ]

    @property
    def largest(self) -> float:
        """Largest mean temperature [K]."""
        return float(self.mean.max())

    def summary(self, sliding: bool) -> str:
        """Loss of film by heat, together with sliding that thins the oil too, and the warmest oil, in words."""
        causes = "heat and sliding make" if sliding else "heat makes"
        loss = 100.0 * (1.0 - self.film_share)
        return f"{causes} the film {loss:.3g} % thinner in the centre; the oil warms by {self.largest:.3g} K"

    def to_dict(self) -> dict[str, Any]:
        """Numbers without the fields, ready for JSON."""
        numbers = {name: getattr(self, name) for name in ("film_share", "thermal_load", "balance", "largest")}
        return numbers | {"inputs": self.inputs.to_dict()}
