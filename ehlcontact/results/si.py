"""Every quantity of a result at rest in SI: what ``.si`` gives, where the point is one in SI.

m, N, N m, Pa, N/m, N s/m; frequencies in rad/s and in Hz.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from math import pi
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.origin import freeze
from ehlcontact.point import Scales
from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.solver.accuracy import ErrorEstimate
from ehlcontact.summary import Summary

if TYPE_CHECKING:  # they import this module
    from ehlcontact.results.impedance import ImpedanceResult
    from ehlcontact.results.steady import SteadyResult

Array = NDArray[np.float64]


def require_scales(scales: Scales | None) -> Scales:
    """Return `scales`, or raise `InputError` where a dimensionless point has none."""
    if scales is None:
        allowed = "those of a result made from an OperatingPoint: a dimensionless point has no SI values"
        raise InputError("scales", None, allowed)
    return scales


def error_in_si(error: ErrorEstimate | None, scales: Scales) -> ErrorEstimate | None:
    """The same with the approach in m."""
    return error and replace(error, approach=error.approach * scales.length)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class View(Summary, Tabled):
    """Numbers in SI, arrays read-only."""

    def __post_init__(self) -> None:
        freeze(self)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SteadySI(View):
    """A `SteadyResult` in SI.

    Attributes
    ----------
    x, y : ndarray, shape (nx + 1,), (ny + 1,)
        Places along rolling and across, y >= 0 [m]; fields are even in y.
    p, h : ndarray, shape (nx + 1, ny + 1)
        Pressure [Pa] and film [m].
    approach : float
        Mutual approach of the bodies [m].
    force : float
        Of the film [N].
    h_central, h_min : float
        Film in the centre, and the smallest [m].
    p_max : float
        Largest pressure [Pa].
    moment : float
        Of the pressure about the centre line, the film's rolling resistance [N m].
    pressure_error : float
        Largest change of the pressure that further cycles would still make [Pa].
    error : ErrorEstimate or None
        That of the result, its approach in m; films relative as there.
    """

    x: Array
    y: Array
    p: Array
    h: Array
    approach: float
    force: float
    h_central: float
    h_min: float
    p_max: float
    moment: float
    pressure_error: float
    error: ErrorEstimate | None

    LAYOUT: ClassVar[Layout] = Layout(
        rows="x y",
        panels=("p", "h"),
        quantities={
            "x": ("m", "x"),
            "y": ("m", "y"),
            "p": ("Pa", "x y"),
            "h": ("m", "x y"),
            "approach": ("m", ""),
            "force": ("N", ""),
            "h_central": ("m", ""),
            "h_min": ("m", ""),
            "p_max": ("Pa", ""),
            "moment": ("N m", ""),
            "pressure_error": ("Pa", ""),
        },
    )

    @classmethod
    def of(cls, result: SteadyResult) -> Self:
        """View of a result; raises `InputError` if its point is dimensionless."""
        s = require_scales(result.scales)
        return cls(
            x=result.X * s.a,
            y=result.Y * s.b,
            p=result.P * s.pressure,
            h=result.H * s.length,
            approach=result.approach * s.length,
            force=result.force * s.force,
            h_central=result.h_central * s.length,
            h_min=result.h_min * s.length,
            p_max=result.p_max * s.pressure,
            moment=result.moment * s.moment,
            pressure_error=result.pressure_error * s.pressure,
            error=error_in_si(result.error, s),
        )

    def summary(self) -> dict[str, Any]:
        """Its numbers, for JSON."""
        names = ("approach", "force", "h_central", "h_min", "p_max", "moment", "pressure_error")
        error = None if self.error is None else asdict(self.error)
        return {name: getattr(self, name) for name in names} | {"error": error}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ImpedanceSI(View):
    """An `ImpedanceResult` in SI.

    Attributes
    ----------
    omega, hz : ndarray, shape (k,)
        The frequencies, in rad/s and in Hz.
    stiffness, damping : ndarray, shape (k,)
        K [N/m] and C [N s/m] of a small vibration.
    approach : float
        Mutual approach at rest [m].
    force : float
        Static load [N].
    h_central, h_min : float
        Film at rest, in the centre and the smallest [m].
    moment : float
        Of the pressure at rest about the centre line, the film's rolling resistance [N m].
    """

    omega: Array
    hz: Array
    stiffness: Array
    damping: Array
    approach: float
    force: float
    h_central: float
    h_min: float
    moment: float

    LAYOUT: ClassVar[Layout] = Layout(
        rows="hz",
        panels=("stiffness", "damping"),
        quantities={
            "omega": ("rad/s", "hz"),
            "hz": ("Hz", "hz"),
            "stiffness": ("N/m", "hz"),
            "damping": ("N s/m", "hz"),
            "approach": ("m", ""),
            "force": ("N", ""),
            "h_central": ("m", ""),
            "h_min": ("m", ""),
            "moment": ("N m", ""),
        },
        logs="xy",
    )

    @classmethod
    def of(cls, result: ImpedanceResult) -> Self:
        """View of a result; raises `InputError` if its point is dimensionless."""
        s = require_scales(result.scales)
        omega = result.Omega / s.time
        return cls(
            omega=omega,
            hz=omega / (2.0 * pi),
            stiffness=result.stiffness * s.stiffness,
            damping=result.damping * s.damping,
            approach=result.approach * s.length,
            force=s.force,
            h_central=result.h_central * s.length,
            h_min=result.h_min * s.length,
            moment=result.moment * s.moment,
        )

    @property
    def impedance(self) -> NDArray[np.complex128]:
        """Z = K + i omega C [N/m], shape (k,)."""
        return self.stiffness + 1j * self.omega * self.damping

    def to_control(self) -> Any:
        """``control.FrequencyResponseData`` from approach [m] to force [N], over rad/s."""
        import control

        return control.frd(self.impedance, self.omega, inputs="u", outputs="F", name="contact")

    def summary(self) -> dict[str, Any]:
        """All of it, for JSON."""
        arrays = {name: getattr(self, name).tolist() for name in ("omega", "hz", "stiffness", "damping")}
        return arrays | {
            name: getattr(self, name) for name in ("approach", "force", "h_central", "h_min", "moment")
        }
