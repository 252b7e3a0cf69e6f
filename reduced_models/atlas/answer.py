"""Answers of the atlas, with error bars: one contact and many contacts at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.assumptions.judge import judged
from ehlcontact.checks.frequency import by_name, dimensionless
from ehlcontact.point import MoesPoint, OperatingPoint, Scales
from ehlcontact.quantities import DAMPING, FORCE, FREQUENCY, LENGTH, MOMENT, NUMBER, STIFFNESS
from ehlcontact.results.response import Response
from ehlcontact.results.table import Display, QuantityTable, ScaledTable, plain
from ehlcontact.summary import contact_text, note_line, span
from ehlcontact.supply import OilLayer
from reduced_models.atlas.frequency_curve import FrequencyCurve
from reduced_models.atlas.heat import HeatedFilm

_Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class AtlasAnswer(ScaledTable):
    """One point, dimensionless; ``si`` has it in SI, ``impedance`` K and C at any frequency.

    Attributes
    ----------
    point : MoesPoint
    approach, h_central, h_min : float
        Mutual approach, film in the centre and the smallest, over the dry approach; in SI (``si``) [m].
    film_share : float
        1 - approach: what the film takes from a dry approach; in SI [m].
    moment : float
        Of the pressure about the centre line, over load times a, > 0 where it resists rolling:
        `ehlcontact.SteadyResult.moment`; in SI [N m].
    force : float
        Static load: 1; in SI [N].
    Omega : ndarray, shape (k,)
        Angular frequencies, per unit 2a/u_sum of time; in SI ``omega`` [rad/s] and ``hz``.
    stiffness, damping : ndarray, shape (k,)
        K(Omega) in f0/delta_H, the static tangent at Omega = 0, and C(Omega) in that times 2a/u_sum; in SI [N/m]
        and [N s/m].
    error_bars : dict
        Half widths of the error bars of all these, under these names and in the same units and shapes.
    scales : Scales or None
        Its units in SI; None for a dimensionless point.
    over_flooded : float or None
        r of an oil supply: its layer over what the flooded isothermal film lets through, with heat too; None where
        the inlet is flooded.
    temperature : HeatedFilm or None
        What heat takes of the film; None where it is isothermal.
    given : OperatingPoint or None
        The point in SI; None for a dimensionless one.
    """

    point: MoesPoint
    approach: Annotated[float, LENGTH]
    h_central: Annotated[float, LENGTH]
    h_min: Annotated[float, LENGTH]
    film_share: Annotated[float, LENGTH]
    moment: Annotated[float, MOMENT]
    Omega: Annotated[_Floats, FREQUENCY.over("Omega")]
    stiffness: Annotated[_Floats, STIFFNESS.over("Omega")]
    damping: Annotated[_Floats, DAMPING.over("Omega")]
    error_bars: dict[str, Any]
    scales: Scales | None = None
    over_flooded: Annotated[float | None, NUMBER] = None
    temperature: HeatedFilm | None = None
    given: OperatingPoint | None = None

    DISPLAY: ClassVar[Display] = Display(rows="Omega", panels=("stiffness", "damping"), logs="xy")

    @property
    def force(self) -> Annotated[float, FORCE.in_si_only()]:
        """Static load: 1."""
        return 1.0

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
        s, bar = self.scales, self.error_bars
        size, unit = (1.0, "of the dry approach") if s is None else (s.length * 1e6, "µm")
        rigid, damps = (1.0, 1.0) if s is None else (s.stiffness * 1e-6, s.damping)
        names = ("", "") if s is None else (" N/µm", " N s/m")
        film = "flooded films" if self.temperature is None else "flooded isothermal films"
        return [
            contact_text(self.point) + ("" if s is None else f"; {s.force:.4g} N, {s.pressure * 1e-9:.3g} GPa"),
            f"approach {size * self.approach:.5g} ± {size * bar['approach']:.1g} {unit}",
            f"film {size * self.h_central:.4g} ± {size * bar['h_central']:.1g} in the centre, "
            f"{size * self.h_min:.4g} ± {size * bar['h_min']:.1g} at least, {unit}",
            f"static tangent {rigid * self.stiffness[0]:.4g}{names[0]}, "
            f"damping {span(self.damping, damps)}{names[1]}",
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
        """Response to approach at any frequency from 0 up to the highest of ``Omega``, in the units of the point.

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
        time = None if self.scales is None else self.scales.time
        w = dimensionless(time, Omega=Omega, omega=omega, hz=hz, rpm=rpm, most=float(self.Omega[-1]))
        K, C = (FrequencyCurve(self.Omega, getattr(self, n), self.error_bars[n]) for n in ("stiffness", "damping"))
        error = {"stiffness": K.bars(w), "damping": C.bars(w)}
        damping = C.at(w)
        found = Response(
            omega=w, value=K.at(w) + 1j * w * damping, slope=damping, error_bars=error, point=self.point
        )
        return found if self.given is None else found.in_units_of(self.given)

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON; of an SI point with ``si``."""
        document = super().to_dict() | {"point": self.point.to_dict(), "scales": plain(self.scales)}
        document |= {} if self.temperature is None else {"temperature": self.temperature.to_dict()}
        return document | {"outside_assumptions": self.outside_assumptions}


@dataclass(frozen=True, eq=False, kw_only=True)
class AtlasAnswers(QuantityTable):
    """Many points at once, dimensionless: what `AtlasAnswer` has of one, with a first axis for the points.

    Attributes
    ----------
    M, L, kappa : ndarray, shape (n,)
    approach, h_central, h_min, film_share, moment : ndarray, shape (n,)
    Omega : ndarray, shape (k,)
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
    film_share: Annotated[_Floats, LENGTH.over("point")]
    moment: Annotated[_Floats, MOMENT.over("point")]
    Omega: Annotated[_Floats, FREQUENCY.over("Omega")]
    stiffness: Annotated[_Floats, STIFFNESS.over("point Omega")]
    damping: Annotated[_Floats, DAMPING.over("point Omega")]
    error_bars: dict[str, _Floats]

    DISPLAY: ClassVar[Display] = Display(
        rows="point", panels=("h_central", "h_min", "approach", "damping"), first=0
    )
    UNITS = "dimensionless"
