"""The impedance that the atlas gives at any frequency, between those that its contacts were solved at."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ehlcontact.point import Scales
from ehlcontact.results import require_scales
from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.summary import Summary

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
class AtlasImpedance(Summary, Tabled):
    """Impedance of an `AtlasAnswer` at frequencies of one's own, dimensionless; ``si`` has it in SI.

    Attributes
    ----------
    Omega : ndarray, shape (k,)
        Angular frequencies, per unit 2a/u_sum of time.
    stiffness, damping : ndarray, shape (k,)
        K(Omega) in f0/delta_H, the static tangent at Omega = 0, and C(Omega) in that times 2a/u_sum.
    error : dict
        Half widths of the error bars of stiffness and damping, in the same units and shapes.
    scales : Scales or None
        Its units in SI; None for a dimensionless point.
    """

    Omega: _Floats
    stiffness: _Floats
    damping: _Floats
    error: dict[str, _Floats]
    scales: Scales | None = None

    LAYOUT: ClassVar[Layout] = Layout(
        rows="Omega",
        panels=("stiffness", "damping"),
        quantities={
            "Omega": ("u_sum/(2a)", "Omega"),
            "stiffness": ("f0/delta_H", "Omega"),
            "damping": ("f0/delta_H 2a/u_sum", "Omega"),
        },
        logs="xy",
    )

    @property
    def impedance(self) -> NDArray[np.complex128]:
        """Z(Omega) = K + i Omega C, shape (k,)."""
        return self.stiffness + 1j * self.Omega * self.damping

    @property
    def si(self) -> AtlasImpedanceSI:
        """All of it in SI; raises `InputError` for a dimensionless point, which has no units."""
        s = require_scales(self.scales)
        units, omega = {"stiffness": s.stiffness, "damping": s.damping}, self.Omega / s.time
        values = {name: getattr(self, name) * unit for name, unit in units.items()}
        error = {name: self.error[name] * unit for name, unit in units.items()}
        return AtlasImpedanceSI(omega=omega, hz=omega / (2.0 * pi), **values, error=error)


@dataclass(frozen=True, eq=False, kw_only=True)
class AtlasImpedanceSI(Summary, Tabled):
    """An `AtlasImpedance` in SI.

    Attributes
    ----------
    omega, hz : ndarray, shape (k,)
        The frequencies, in rad/s and in Hz.
    stiffness, damping : ndarray, shape (k,)
        K [N/m] and C [N s/m].
    error : dict
        Half widths of the error bars of stiffness [N/m] and damping [N s/m].
    """

    omega: _Floats
    hz: _Floats
    stiffness: _Floats
    damping: _Floats
    error: dict[str, _Floats]

    LAYOUT: ClassVar[Layout] = Layout(
        rows="hz",
        panels=("stiffness", "damping"),
        quantities={
            "omega": ("rad/s", "hz"),
            "hz": ("Hz", "hz"),
            "stiffness": ("N/m", "hz"),
            "damping": ("N s/m", "hz"),
        },
        logs="xy",
    )

    @property
    def impedance(self) -> NDArray[np.complex128]:
        """Z = K + i omega C [N/m], shape (k,)."""
        return self.stiffness + 1j * self.omega * self.damping
