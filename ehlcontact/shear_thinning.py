"""`ShearThinning`: shear thinning of a film by sliding, as an input.

How the solver uses it: `ehlcontact.solver.film_thinning`; equations and sources: docs/notes/traction.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import log
from typing import Any

from ehlcontact.checks import require_between, shown
from ehlcontact.errors import InputError
from ehlcontact.lubricant.traction_laws import LARGEST_SLIDE_ROLL, Eyring, TractionLaw, require_law
from ehlcontact.point import Scales
from ehlcontact.summary import Summary


@dataclass(frozen=True, slots=True)
class ShearThinning(Summary):
    """Sliding that shears the oil and so lowers its effective viscosity in the pressure-driven flow.

    Parameters
    ----------
    slide_roll : float
        Slide-to-roll ratio, difference over mean of the surface speeds: 0 to 2.
    law : Eyring or Carreau
        `Eyring` or `Carreau`; a limiting stress would leave no viscosity along the sliding.

    Raises
    ------
    InputError
        A ratio outside its range, or another law.
    """

    slide_roll: float
    law: Any = field(default_factory=Eyring)

    def __post_init__(self) -> None:
        slide = require_between("slide_roll", self.slide_roll, 0.0, LARGEST_SLIDE_ROLL)
        object.__setattr__(self, "slide_roll", slide)
        require_law(self.law)
        if not self.law.thins:
            allowed = "Eyring or Carreau: a limiting stress leaves no viscosity along the sliding"
            raise InputError("law", shown(self.law), allowed)

    def log_newton(self, eta0: float, scales: Scales) -> float:
        """Logarithm of Newton's stress [Pa] at ambient viscosity in a film of one dry approach, or -inf."""
        speed = self.slide_roll * scales.a / scales.time
        return log(eta0 * speed / scales.length) if speed > 0.0 else -float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        return {"slide_roll": self.slide_roll, "law": self.law.to_dict()}

    @classmethod
    def from_dict(cls, entries: Mapping[str, Any]) -> ShearThinning:
        """Back from `to_dict`."""
        return cls(entries["slide_roll"], TractionLaw.from_dict(entries["law"]))
