"""What the atlas says about one point, with its error bars; the same in SI; and about many points at once."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import pi
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks.frequency import by_name, dimensionless
from ehlcontact.point import MoesPoint, Scales
from ehlcontact.results import require_scales
from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.summary import Summary, contact_text, span
from reduced_models.atlas.frequency import AtlasImpedance, Between

_Floats = NDArray[np.float64]
_MOES = {
    **dict.fromkeys(("approach", "h_central", "h_min", "film_share"), ("delta_H", "")),
    "moment": ("f0 a", ""),
    "Omega": ("u_sum/(2a)", "Omega"),
    "stiffness": ("f0/delta_H", "Omega"),
    "damping": ("f0/delta_H 2a/u_sum", "Omega"),
}


@dataclass(frozen=True, eq=False)
class AtlasAnswer(Summary, Tabled):
    """One point, dimensionless; ``si`` has it in SI, ``impedance`` K and C at any frequency.

    Attributes
    ----------
    point : MoesPoint
    approach, h_central, h_min : float
        Mutual approach, film in the centre and the smallest, over the dry approach.
    film_share : float
        1 - approach: what the film takes from a dry approach.
    moment : float
        Of the pressure about the centre line, over load times a, > 0 where it resists rolling:
        `ehlcontact.SteadyResult.moment`.
    Omega : ndarray, shape (k,)
        Angular frequencies, per unit 2a/u_sum of time.
    stiffness, damping : ndarray, shape (k,)
        K(Omega) in f0/delta_H, the static tangent at Omega = 0, and C(Omega) in that times 2a/u_sum.
    error : dict
        Half widths of the error bars of all these, under these names and in the same units and shapes.
    scales : Scales or None
        Its units in SI; None for a dimensionless point.
    """

    point: MoesPoint
    approach: float
    h_central: float
    h_min: float
    film_share: float
    moment: float
    Omega: _Floats
    stiffness: _Floats
    damping: _Floats
    error: dict[str, Any]
    scales: Scales | None = None

    LAYOUT: ClassVar[Layout] = Layout(rows="Omega", panels=("stiffness", "damping"), quantities=_MOES, logs="xy")

    @property
    def film_origin(self) -> str:
        """How the smallest film was found, and how sure it is, in words."""
        return f"from the atlas, ± {100.0 * self.error['h_min'] / self.h_min:.2g} %"

    def _summary_lines(self) -> list[str]:
        s, bar = self.scales, self.error
        size, unit = (1.0, "of the dry approach") if s is None else (s.length * 1e6, "µm")
        rigid, damps = (1.0, 1.0) if s is None else (s.stiffness * 1e-6, s.damping)
        names = ("", "") if s is None else (" N/µm", " N s/m")
        return [
            contact_text(self.point, s),
            f"approach {size * self.approach:.5g} ± {size * bar['approach']:.1g} {unit}",
            f"film {size * self.h_central:.4g} ± {size * bar['h_central']:.1g} in the centre, "
            f"{size * self.h_min:.4g} ± {size * bar['h_min']:.1g} at least, {unit}",
            f"static tangent {rigid * self.stiffness[0]:.4g}{names[0]}, "
            f"damping {span(self.damping, damps)}{names[1]}",
        ]

    @by_name(1)
    def impedance(
        self,
        *,
        Omega: ArrayLike | None = None,
        omega: ArrayLike | None = None,
        hz: ArrayLike | None = None,
        rpm: ArrayLike | None = None,
    ) -> AtlasImpedance:
        """K and C at any frequency from 0 up to the highest of ``Omega``, with error bars.

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
        K, C = (Between(self.Omega, getattr(self, n), self.error[n]) for n in ("stiffness", "damping"))
        error = {"stiffness": K.bars(w), "damping": C.bars(w)}
        return AtlasImpedance(Omega=w, stiffness=K.at(w), damping=C.at(w), error=error, scales=self.scales)

    @property
    def si(self) -> AtlasSI:
        """All of it in SI, error bars too; raises `InputError` for a dimensionless point, which has no units."""
        return AtlasSI.of(self)

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON but for the arrays; of an SI point with ``si``."""
        return asdict(self) | ({} if self.scales is None else {"si": asdict(self.si)})


@dataclass(frozen=True, eq=False, kw_only=True)
class AtlasSI(Summary, Tabled):
    """An `AtlasAnswer` in SI.

    Attributes
    ----------
    approach, h_central, h_min : float
        Mutual approach, film in the centre and the smallest [m].
    film_share : float
        What the film takes from a dry approach [m].
    moment : float
        Rolling resistance of the film: moment of the pressure about the centre line [N m].
    force : float
        Static load [N].
    omega, hz : ndarray, shape (k,)
        The frequencies, in rad/s and in Hz.
    stiffness, damping : ndarray, shape (k,)
        K [N/m] and C [N s/m] of a small vibration.
    error : dict
        Half widths of the error bars of approach, h_central, h_min, film_share [m], moment [N m], stiffness [N/m]
        and damping [N s/m].
    """

    approach: float
    h_central: float
    h_min: float
    film_share: float
    moment: float
    force: float
    omega: _Floats
    hz: _Floats
    stiffness: _Floats
    damping: _Floats
    error: dict[str, Any]

    LAYOUT: ClassVar[Layout] = Layout(
        rows="hz",
        panels=("stiffness", "damping"),
        quantities={
            **dict.fromkeys(("approach", "h_central", "h_min", "film_share"), ("m", "")),
            "moment": ("N m", ""),
            "force": ("N", ""),
            "omega": ("rad/s", "hz"),
            "hz": ("Hz", "hz"),
            "stiffness": ("N/m", "hz"),
            "damping": ("N s/m", "hz"),
        },
        logs="xy",
    )

    @classmethod
    def of(cls, answer: AtlasAnswer) -> Self:
        """View of an answer; raises `InputError` if its point is dimensionless."""
        s = require_scales(answer.scales)
        units = dict.fromkeys(("approach", "h_central", "h_min", "film_share"), s.length)
        units |= {"moment": s.moment, "stiffness": s.stiffness, "damping": s.damping}
        values: dict[str, Any] = {name: getattr(answer, name) * unit for name, unit in units.items()}
        omega = answer.Omega / s.time
        error = {name: answer.error[name] * unit for name, unit in units.items()}
        return cls(**values, force=s.force, omega=omega, hz=omega / (2.0 * pi), error=error)


@dataclass(frozen=True, eq=False, kw_only=True)
class AtlasAnswers(Summary, Tabled):
    """Many points at once, dimensionless: what `AtlasAnswer` has of one, with a first axis for the points.

    Attributes
    ----------
    M, L, kappa : ndarray, shape (n,)
    approach, h_central, h_min, film_share, moment : ndarray, shape (n,)
    Omega : ndarray, shape (k,)
    stiffness, damping : ndarray, shape (n, k)
    error : dict
        Half widths of the error bars, in the same units and shapes.
    """

    M: _Floats
    L: _Floats
    kappa: _Floats
    approach: _Floats
    h_central: _Floats
    h_min: _Floats
    film_share: _Floats
    moment: _Floats
    Omega: _Floats
    stiffness: _Floats
    damping: _Floats
    error: dict[str, _Floats]

    LAYOUT: ClassVar[Layout] = Layout(
        rows="point",
        panels=("h_central", "h_min", "approach", "damping"),
        quantities={
            **{name: ("", "point") for name in ("M", "L", "kappa")},
            **{name: (unit, f"point {dims}".strip()) for name, (unit, dims) in _MOES.items() if name != "Omega"},
            "Omega": ("u_sum/(2a)", "Omega"),
        },
        first=0,
    )
