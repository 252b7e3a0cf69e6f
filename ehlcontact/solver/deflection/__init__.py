"""Elastic deflection of the two half spaces: a discrete convolution of the pressure (eq. 3, last term).

Pressure is piecewise constant on the cells around the nodes, and the kernel is integrated over a cell exactly
(Love 1929), as in Venner and Lubrecht (2000), app. A. Fields are even in Y and hold Y >= 0 only. Three engines
evaluate the same sum:

================ ==================================================================================
module           engine
================ ==================================================================================
``fft``          ``"fft"``, by zero-padded fast transforms, O(N log N) and exact to rounding: the default
``mlmi``         ``"mlmi"``, multilevel multi-integration, O(N log N) to below the discretisation error: the
                 way of the paper
``direct``       ``"direct"``, term by term, O(N^2): the check of both
``coefficients`` what they sum
================ ==================================================================================
"""

from __future__ import annotations

from typing import Protocol

from ehlcontact.checks import require_choice
from ehlcontact.process.threads import Team
from ehlcontact.solver.deflection.coefficients import Array
from ehlcontact.solver.deflection.direct import DirectSum
from ehlcontact.solver.deflection.fft import FastFourier
from ehlcontact.solver.deflection.mlmi import Mlmi


class Deflection(Protocol):
    """What the engines have in common; an instance serves one caller at a time."""

    nx: int
    ny: int
    kernel: Array  # influence coefficients, lags 0..2 ny along Y and 0..nx along X
    team: Team  # that an engine may share its work with

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1), zero on the outer border nodes."""
        ...


ENGINES: dict[str, type[DirectSum] | type[FastFourier] | type[Mlmi]] = {
    "fft": FastFourier,
    "mlmi": Mlmi,
    "direct": DirectSum,
}


def make_deflection(nx: int, ny: int, hx: float, hy: float, kappa: float, engine: str = "fft") -> Deflection:
    """Make an engine for a half domain of (ny + 1) x (nx + 1) nodes.

    Parameters
    ----------
    nx, ny : int
        Intervals along X and along Y >= 0.
    hx, hy : float
        Mesh sizes.
    kappa : float
        Ellipse ratio a/b.
    engine : {"fft", "mlmi", "direct"}
        Way of summing.

    Raises
    ------
    InputError
        No such engine.
    """
    return ENGINES[require_choice("deflection", engine, tuple(ENGINES))](nx, ny, hx, hy, kappa)
