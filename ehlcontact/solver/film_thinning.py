"""Shear thinning by sliding: effective viscosities of the pressure-driven flow, along and across.

Equation numbers are those of docs/traction.md. Nearly all of the stress comes from sliding, and the
pressure-driven flow is a small perturbation of it: its viscosity along the sliding is the slope of the law, across
it the ratio of stress to shear rate.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.lubricant.traction_laws import TractionLaw
from ehlcontact.solver.kernels.reynolds import FILM_FLOOR
from ehlcontact.solver.multigrid import Multigrid

Array = NDArray[np.float64]


class FilmThinning:
    """Viscosities of the film on the finest level of a multigrid, for `FollowedViscosity`.

    Parameters
    ----------
    multigrid : Multigrid
    law : TractionLaw
    log_newton : float
        ln of Newton's stress [Pa] at ambient viscosity in a film of one dry approach.
    """

    def __init__(self, multigrid: Multigrid, law: TractionLaw, log_newton: float) -> None:
        self.multigrid, self.law, self.log_newton = multigrid, law, log_newton

    changes_film = True

    def solve(self, rounds: int = 1) -> Array:
        """What ``Flow.heat`` becomes at the present P and H (eq. 8); the flow across is set too (eq. 9)."""
        level = self.multigrid.finest
        flow, H = level.fields.flow, np.maximum(level.H, FILM_FLOOR)
        log_eta = np.log(flow.rho * H**3 / (level.stencil.lam * flow.eps))
        cold = (log_eta - flow.heat * level.law.q) / (1.0 + flow.heat)
        along, across = self.law.thinning(self.log_newton + cold - np.log(H))
        wet = level.P > 0.0
        self.multigrid.set_aside(np.where(wet, along - across, 0.0))
        return np.where(wet, along / (cold + level.law.q), 0.0)

    def result(self, before: float) -> dict[str, Any]:
        """Share that it leaves of the central film without it, `before`."""
        return {"film_share": self.multigrid.finest.central_film() / before}
