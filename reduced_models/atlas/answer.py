"""What the atlas says about one point, with its error bars; and the same in SI."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import pi
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.point import MoesPoint, Scales
from ehlcontact.results import require_scales

_Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class AtlasAnswer:
    """One point, dimensionless; ``si`` has it in SI.

    Attributes
    ----------
    point : MoesPoint
    approach, h_central, h_min : float
        Mutual approach, film in the centre and the smallest, over the dry approach.
    Omega : ndarray, shape (k,)
        Angular frequencies, per unit 2a/u_sum of time.
    stiffness, damping : ndarray, shape (k,)
        K(Omega) in f0/delta_H, the static tangent at Omega = 0, and C(Omega) in that times 2a/u_sum.
    error : dict
        Half widths of the error bars of approach, h_central, h_min, stiffness and damping, under these names and
        in the same units and shapes.
    scales : Scales or None
        Its units in SI; None for a dimensionless point.
    """

    point: MoesPoint
    approach: float
    h_central: float
    h_min: float
    Omega: _Floats
    stiffness: _Floats
    damping: _Floats
    error: dict[str, Any]
    scales: Scales | None = None

    @property
    def si(self) -> AtlasSI:
        """All of it in SI, error bars too; raises `InputError` for a dimensionless point, which has no units."""
        return AtlasSI.of(self)

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON but for the arrays; of an SI point with ``si``."""
        return asdict(self) | ({} if self.scales is None else {"si": asdict(self.si)})


@dataclass(frozen=True, eq=False, kw_only=True)
class AtlasSI:
    """An `AtlasAnswer` in SI.

    Attributes
    ----------
    approach, h_central, h_min : float
        Mutual approach, film in the centre and the smallest [m].
    force : float
        Static load [N].
    omega, hz : ndarray, shape (k,)
        The frequencies, in rad/s and in Hz.
    stiffness, damping : ndarray, shape (k,)
        K [N/m] and C [N s/m] of a small vibration.
    error : dict
        Half widths of the error bars of approach, h_central, h_min [m], stiffness [N/m] and damping [N s/m].
    """

    approach: float
    h_central: float
    h_min: float
    force: float
    omega: _Floats
    hz: _Floats
    stiffness: _Floats
    damping: _Floats
    error: dict[str, Any]

    @classmethod
    def of(cls, answer: AtlasAnswer) -> Self:
        """View of an answer; raises `InputError` if its point is dimensionless."""
        s = require_scales(answer.scales)
        units = dict.fromkeys(("approach", "h_central", "h_min"), s.length)
        units |= {"stiffness": s.stiffness, "damping": s.damping}
        values: dict[str, Any] = {name: getattr(answer, name) * unit for name, unit in units.items()}
        omega = answer.Omega / s.time
        error = {name: answer.error[name] * unit for name, unit in units.items()}
        return cls(**values, force=s.force, omega=omega, hz=omega / (2.0 * pi), error=error)
