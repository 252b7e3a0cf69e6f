"""Answers of the atlas, with error bars: one contact and many contacts at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.assumptions.judge import judged
from ehlcontact.checks.frequency import by_name, dimensionless
from ehlcontact.point import Point
from ehlcontact.quantities import (
    DAMPING,
    FORCE,
    FREQUENCY,
    HERTZ,
    LENGTH,
    MOMENT,
    NUMBER,
    STIFFNESS,
    in_hertz,
)
from ehlcontact.results.response import Response
from ehlcontact.results.table import Display, PointTable, QuantityTable
from ehlcontact.summary import contact_text, film_unit, note_line, span
from ehlcontact.supply import OilLayer
from reduced_models.atlas.frequency_curve import FrequencyCurve
from reduced_models.atlas.heat import HeatedFilm

_Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class AtlasAnswer(PointTable):
    """One contact, in the units of its point; ``impedance`` has K and C at any frequency.

    Units are those at an `OperatingPoint` and, after the semicolon, at a `MoesPoint`.

    Attributes
    ----------
    point : MoesPoint or OperatingPoint
    approach, h_central, h_min : float
        Mutual approach, film in the centre and the smallest [m; dry approach].
    separation : float
        By which the film holds the bodies apart: dry approach less approach [m; dry approach].
    moment : float
        Of the pressure about the centre line, > 0 where it resists rolling: `ehlcontact.SteadyResult.moment`
        [N m; load times a].
    force : float
        Static load [N; 1].
    omega, hz : ndarray, shape (k,)
        Angular frequencies [rad/s; u_sum/(2a)]; frequencies [Hz] at an `OperatingPoint`.
    stiffness, damping : ndarray, shape (k,)
        K(omega), the static tangent at omega = 0 [N/m; f0/delta_H], and C(omega) [N s/m; that times 2a/u_sum].
    error_bars : dict
        Half widths of the error bars of all these, under these names and in the same units and shapes.
    over_flooded : float or None
        r of an oil supply: its layer over what the flooded isothermal film lets through, with heat too; None where
        the inlet is flooded.
    temperature : HeatedFilm or None
        What heat takes of the film; None where it is isothermal.
    """

    point: Point
    approach: Annotated[float, LENGTH]
    h_central: Annotated[float, LENGTH]
    h_min: Annotated[float, LENGTH]
    separation: Annotated[float, LENGTH]
    moment: Annotated[float, MOMENT]
    omega: Annotated[_Floats, FREQUENCY.over("omega")]
    stiffness: Annotated[_Floats, STIFFNESS.over("omega")]
    damping: Annotated[_Floats, DAMPING.over("omega")]
    error_bars: dict[str, Any]
    over_flooded: Annotated[float | None, NUMBER] = None
    temperature: HeatedFilm | None = None

    DISPLAY: ClassVar[Display] = Display(rows="omega", panels=("stiffness", "damping"), logs="xy")

    @property
    def force(self) -> Annotated[float, FORCE.in_si_only()]:
        """Static load."""
        return self.point.scales.force

    @property
    def hz(self) -> Annotated[_Floats, HERTZ.over("omega").in_si_only()]:
        """Frequencies [Hz]; raises `InputError` at a `MoesPoint`."""
        return np.asarray(in_hertz(self.point, self.omega))

    @property
    def supply(self) -> OilLayer | None:
        """Its oil supply; None where the inlet is flooded."""
        return None if self.over_flooded is None else OilLayer(over_flooded=self.over_flooded)

    @property
    def film_origin(self) -> str:
        """Source of the smallest film and its error bar, in words."""
        return f"from the atlas, ± {100.0 * self.error_bars['h_min'] / self.h_min:.2g} %"

    @property
    def outside_assumptions(self) -> str:
        """Assumptions that do not hold at this contact, in words (`ehlcontact.assumptions`); empty where none."""
        return judged(self).headline

    def _summary_lines(self) -> list[str]:
        bar, si = self.error_bars, self._in_si()
        size, unit = film_unit(self.point)
        rigid, names = (1e-6, (" N/µm", " N s/m")) if si else (1.0, ("", ""))
        film = "flooded films" if self.temperature is None else "flooded isothermal films"
        return [
            contact_text(self.point),
            f"approach {size * self.approach:.5g} ± {size * bar['approach']:.1g} {unit}",
            f"film {size * self.h_central:.4g} ± {size * bar['h_central']:.1g} in the centre, "
            f"{size * self.h_min:.4g} ± {size * bar['h_min']:.1g} at least, {unit}",
            f"static tangent {rigid * self.stiffness[0]:.4g}{names[0]}, damping {span(self.damping)}{names[1]}",
            *([] if self.over_flooded is None else [f"under a layer of {self.over_flooded:.4g} {film}"]),
            *([] if self.temperature is None else [self.temperature.summary]),
            *note_line(self.outside_assumptions),
        ]

    @by_name(1)
    def impedance(
        self,
        *,
        Omega: ArrayLike | None = None,
        omega: ArrayLike | None = None,
        hz: ArrayLike | None = None,
        rpm: ArrayLike | None = None,
    ) -> Response:
        """Response to approach at any frequency from 0 up to the highest of ``omega``, in the units of the point.

        Parameters
        ----------
        Omega, omega, hz, rpm : float or sequence of float
            Frequencies, in exactly one of these: dimensionless at every point; at an `OperatingPoint` also in
            rad/s, Hz or rev/min. At 0 K is the static tangent.

        Raises
        ------
        InputError
            Frequencies not given in exactly one way, in SI at a dimensionless point, not finite, negative or above
            the highest.
        """
        time = self.point.scales.time if self._in_si() else None
        own = self.dimensionless
        highest = float(own.omega[-1]) * (1.0 + 1e-12)  # but for rounding
        w = dimensionless(time, Omega=Omega, omega=omega, hz=hz, rpm=rpm, most=highest)
        K, C = (FrequencyCurve(own.omega, getattr(own, n), own.error_bars[n]) for n in ("stiffness", "damping"))
        error = {"stiffness": K.bars(w), "damping": C.bars(w)}
        damping = C.at(w)
        value = K.at(w) + 1j * w * damping
        found = Response(omega=w, value=value, slope=damping, error_bars=error, point=own.point)
        return found.in_units_of(self.point)

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        document = super().to_dict() | {"point": self.point.to_dict()}
        document |= {} if self.temperature is None else {"temperature": self.temperature.to_dict()}
        return document | {"outside_assumptions": self.outside_assumptions}


@dataclass(frozen=True, eq=False, kw_only=True)
class AtlasAnswers(QuantityTable):
    """Many points at once, dimensionless: what `AtlasAnswer` has of one, with a first axis for the points.

    Attributes
    ----------
    M, L, kappa : ndarray, shape (n,)
    approach, h_central, h_min, separation, moment : ndarray, shape (n,)
    omega : ndarray, shape (k,)
    stiffness, damping : ndarray, shape (n, k)
    error_bars : dict
        Half widths of the error bars, in the same units and shapes.
    """

    M: Annotated[_Floats, NUMBER.over("point")]
    L: Annotated[_Floats, NUMBER.over("point")]
    kappa: Annotated[_Floats, NUMBER.over("point")]
    approach: Annotated[_Floats, LENGTH.over("point")]
    h_central: Annotated[_Floats, LENGTH.over("point")]
    h_min: Annotated[_Floats, LENGTH.over("point")]
    separation: Annotated[_Floats, LENGTH.over("point")]
    moment: Annotated[_Floats, MOMENT.over("point")]
    omega: Annotated[_Floats, FREQUENCY.over("omega")]
    stiffness: Annotated[_Floats, STIFFNESS.over("point omega")]
    damping: Annotated[_Floats, DAMPING.over("point omega")]
    error_bars: dict[str, _Floats]

    DISPLAY: ClassVar[Display] = Display(
        rows="point", panels=("h_central", "h_min", "approach", "damping"), first=0
    )
    UNITS = "dimensionless"
