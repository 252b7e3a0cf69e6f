"""Load share of the asperities of a film that was solved with them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.asperities import Asperities
from ehlcontact.quantities import PRESSURE

Array = NDArray[np.float64]

PRESSED = 0.5  # central film over Rq, below which asperities are no longer single summits


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AsperityContact:
    """Load share of asperities beside a film.

    Attributes
    ----------
    inputs : Asperities
        As given to `solve_steady`.
    pressure : ndarray, shape (nx + 1, ny + 1)
        Mean pressure of the asperities [Pa; Hertz pressure], beside that of the oil.
    load_share : float
        Part of the force that they carry.
    film_over_rq : float
        Central film over `inputs.rq`; the lambda ratio of other results has the smallest film.
    film_share : float
        Central film over that between smooth surfaces, and without heat, on the same grid.
    """

    inputs: Asperities
    pressure: Annotated[Array, PRESSURE.over("x y")]
    load_share: float
    film_over_rq: float
    film_share: float

    @property
    def summary(self) -> str:
        """Load share of the asperities, in words."""
        share, ratio = 100.0 * self.load_share, self.film_over_rq
        return f"asperities carry {share:.3g} % of the load, the central film being {ratio:.3g} times their Rq"

    @property
    def reservation(self) -> str:
        """Caveat in words where the gap is below the range of the model of asperities; else empty."""
        if self.film_over_rq >= PRESSED:
            return ""
        return f"the central film is {self.film_over_rq:.2g} Rq: asperities are a model from {PRESSED:g} Rq on"

    def to_dict(self) -> dict[str, Any]:
        """Numbers without the field, ready for JSON."""
        numbers = {name: getattr(self, name) for name in ("load_share", "film_over_rq", "film_share")}
        return numbers | {"inputs": self.inputs.to_dict()}
