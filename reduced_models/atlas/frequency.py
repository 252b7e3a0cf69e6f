"""Impedance of the atlas between the frequencies that its contacts were solved at."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ehlcontact.point import Scales
from ehlcontact.quantities import DAMPING, FREQUENCY, STIFFNESS
from ehlcontact.results.frequency import ScaledResponse

_Floats = NDArray[np.float64]

SPLINE_SHARE = 0.5  # of the distance between cubic and straight line, that bars between the nodes have more


class Between:
    """K, or C, over frequency: exact at the nodes, a cubic over asinh(Omega) between, level at 0 (both are even).

    Against solves between the nodes, from Omega = 0 to 32, at seven contacts of the box from (3, 10, .12) to
    (2000, 1, .9), K is within 0.1 % and C within 0.6 % of its value at low frequency (straight lines: 0.2 %, at
    the first 7 %, and 0.9 %).

    Parameters
    ----------
    Omega : ndarray, shape (k,)
        The nodes, from 0 upwards.
    values, bars : ndarray, shape (k,)
        There, with half widths of error bars.
    """

    def __init__(self, Omega: _Floats, values: _Floats, bars: _Floats | None = None) -> None:
        self._Omega, self._values = Omega, values
        self._bars = np.zeros_like(values) if bars is None else bars

    @cached_property
    def _cubic(self) -> CubicSpline:
        return CubicSpline(np.arcsinh(self._Omega), self._values, bc_type=((1, 0.0), "not-a-knot"))

    def at(self, Omega: _Floats) -> _Floats:
        """Values, in the shape of `Omega`."""
        return np.asarray(self._cubic(np.arcsinh(Omega)))

    def bars(self, Omega: _Floats) -> _Floats:
        """Half widths of the error bars: those of the nodes beside, and more in the middle between them."""
        bent = np.abs(self.at(Omega) - np.interp(np.arcsinh(Omega), np.arcsinh(self._Omega), self._values))
        return np.asarray(np.interp(Omega, self._Omega, self._bars) + SPLINE_SHARE * bent)


@dataclass(frozen=True, eq=False, kw_only=True)
class AtlasImpedance(ScaledResponse):
    """Impedance of an `AtlasAnswer` at given frequencies, dimensionless; ``si`` has it in SI.

    Attributes
    ----------
    Omega : ndarray, shape (k,)
        Angular frequencies, per unit 2a/u_sum of time; in SI ``omega`` [rad/s] and ``hz``.
    stiffness, damping : ndarray, shape (k,)
        K(Omega) in f0/delta_H, the static tangent at Omega = 0, and C(Omega) in that times 2a/u_sum; in SI [N/m]
        and [N s/m].
    error_bars : dict
        Half widths of the error bars of stiffness and damping, in the same units and shapes.
    scales : Scales or None
        Its units in SI; None for a dimensionless point.
    """

    Omega: Annotated[_Floats, FREQUENCY.over("Omega")]
    stiffness: Annotated[_Floats, STIFFNESS.over("Omega")]
    damping: Annotated[_Floats, DAMPING.over("Omega")]
    error_bars: dict[str, _Floats]
    scales: Scales | None = None
