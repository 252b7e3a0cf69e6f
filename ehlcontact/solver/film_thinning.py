"""Shear thinning by sliding: effective viscosities of the pressure-driven flow, along and across.

Equation numbers are those of docs/notes/traction.md. Nearly all of the stress comes from sliding, and the
pressure-driven flow is a small perturbation of it: its viscosity along the sliding is the slope of the law, across
it the ratio of stress to shear rate.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.lubricant.traction_laws import TractionLaw
from ehlcontact.solver.film_heat import FilmHeat
from ehlcontact.solver.kernels.reynolds import FILM_FLOOR
from ehlcontact.solver.linear import stencil_matrix
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
    heat : FilmHeat, optional
        Temperatures of the film, at whose mean the oil is sheared.
    """

    condition, changes_film = "sliding", True

    def __init__(
        self, multigrid: Multigrid, law: TractionLaw, log_newton: float, heat: FilmHeat | None = None
    ) -> None:
        self.multigrid, self.law, self.log_newton, self.heat = multigrid, law, log_newton, heat

    def newton(self) -> tuple[Array, Array]:
        """Logarithm of Newton's stress [Pa] at the present P and H, and ln(eta) + 9.67 at that of the inlet."""
        level = self.multigrid.finest
        flow, H = level.fields.flow, np.maximum(level.H, FILM_FLOOR)
        log_eta = np.log(flow.rho * H**3 / (level.stencil.lam * flow.eps))
        cold = (log_eta - flow.heat * level.law.q) / (1.0 + flow.heat)
        above = cold + level.law.q
        warm = cold if self.heat is None else cold + self.heat.numbers.heating(self.heat.mean) * above
        return self.log_newton + warm - np.log(H), above

    def solve(self, rounds: int = 1) -> Array:
        """Its part of ``Flow.heat`` at the present P and H (eq. 8); the flow across is set too (eq. 9)."""
        level = self.multigrid.finest
        newton, above = self.newton()
        along, across = self.law.thinning(newton)
        wet = level.P > 0.0
        self.multigrid.set_aside(np.where(wet, along - across, 0.0))
        return np.where(wet, along / above, 0.0)

    hold = solve  # it has no state

    def linear(self) -> LinearThinning:
        """Its derivatives at the present film."""
        return LinearThinning(self)

    def result(self, before: float) -> dict[str, Any]:
        """Share that it leaves of the central film without it, `before`."""
        return {"film_share": self.multigrid.finest.central_film() / before}


class LinearThinning:
    """Derivatives of the effective viscosities of a film at its present state, (ny + 1, nx + 1) each.

    Attributes
    ----------
    by_pressure, by_film : array
        Of ln(eps) along, beside those at a given heating of the viscosity.
    aside_by_pressure, aside_by_film : array
        Of ln of the viscosity along over that across.
    along, aside : array
        Of -ln(eps) along and of that ratio, to ln(eta) at the mean temperature.
    cold_slope : array
        Of ln(eta) at the temperature of the inlet, to the pressure.
    """

    def __init__(self, thinning: FilmThinning) -> None:
        level, heat = thinning.multigrid.finest, thinning.heat
        level.update_residual()  # for the slopes of the flow at a given heating, which `LinearViscosity` writes
        flow, H, wet = level.fields.flow, np.maximum(level.H, FILM_FLOOR), level.P > 0.0
        newton, above = thinning.newton()
        along, across = (np.where(wet, slope, 0.0) for slope in thinning.law.thinning_slopes(newton))
        self.level, self.along, self.aside = level, along, along - across
        self.cold_slope = (flow.mass_slope / (level.H * flow.rho) - flow.eps_slope) / (1.0 + flow.heat)
        warm_slope = self.cold_slope * (1.0 if heat is None else 1.0 + heat.numbers.heating(heat.mean))
        given = np.where(wet, thinning.law.thinning(newton)[0] / above, 0.0)
        self.by_pressure, self.by_film = given * self.cold_slope - along * warm_slope, along / H
        self.aside_by_pressure, self.aside_by_film = self.aside * warm_slope, -self.aside / H

    def matrix(self) -> Any:
        """Change of the Reynolds operator by that of ln of the ratio at the nodes, sparse."""
        level = self.level
        north = np.zeros_like(level.P)
        north[:-1] = 0.5 * level.stencil.cy * level.fields.flow.across[:-1] * np.diff(level.P, axis=0)
        south = np.zeros_like(north)
        south[1:] = -north[:-1]
        north[0] *= 2.0  # the line below the symmetry line is its image
        return stencil_matrix(((0, 0), (-1, 0), (1, 0)), np.array([north + south, south, north]), level.P.shape)
