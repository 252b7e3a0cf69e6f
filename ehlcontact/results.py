"""Frozen results at rest: the steady film and its impedance; arrays are read-only.

Everything is dimensionless, with the SI scales beside. What a run leaves is in `transient.result`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.origin import Origin
from ehlcontact.status import Status

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SteadyResult(Origin):
    """Steady film of a contact under constant load, or at a prescribed approach."""

    X: Array  # (nx + 1,) x/a
    Y: Array  # (ny + 1,) y/b >= 0; fields are even in Y
    P: Array  # (nx + 1, ny + 1) pressure / p_hertz
    H: Array  # (nx + 1, ny + 1) film / dry approach
    approach: float  # mutual approach / dry approach
    force: float  # film force / static load
    h_central: float  # film at X = Y = 0 / dry approach
    h_min: float  # smallest film / dry approach, between the nodes too
    residuals: Array  # (cycles + 1,) mean |residual| over P > 0: start after full multigrid, then each cycle
    load_residuals: Array  # (cycles + 1,) residual of the load (or approach) equation, likewise
    approach_changes: Array  # (cycles,) change of the approach in each cycle
    dry_residual: float  # mean |residual| of the dry Hertz start on this grid: the scale
    status: Status

    @property
    def residual(self) -> float:
        """Last residual relative to that of the dry Hertz start."""
        return float(self.residuals[-1] / self.dry_residual)

    @property
    def load_residual(self) -> float:
        """Last residual of the load equation."""
        return float(self.load_residuals[-1])

    @property
    def cycles(self) -> int:
        """Number of V cycles on the finest grid."""
        return len(self.residuals) - 1

    @property
    def p_max(self) -> float:
        """Largest pressure / p_hertz."""
        return float(self.P.max())

    def summary(self) -> dict[str, Any]:
        """The JSON form of the command line."""
        return {
            "approach": self.approach,
            "force": self.force,
            "h_central": self.h_central,
            "h_min": self.h_min,
            "p_max": self.p_max,
            "residual": self.residual,
            "load_residual": self.load_residual,
            "cycles": self.cycles,
            "seconds": self.seconds,
            "status": str(self.status),
            "advice": self.status.advice,
            "n": self.n,
            "domain": list(self.domain.as_tuple()),
            "point": self.point.to_dict(),
            "version": self.version,
        }


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ImpedanceResult(Origin):
    """Stiffness and damping of a contact over frequency."""

    omega: Array  # (k,) dimensionless angular frequency
    stiffness: Array  # (k,) K(Omega) = Re Z
    damping: Array  # (k,) C(Omega) = Im Z/Omega, its limit at Omega = 0
    residual: Array  # (k,) relative residual of the linear system
    approach: float  # of the steady state / dry approach

    @property
    def impedance(self) -> NDArray[np.complex128]:
        """Z(Omega) = K + i Omega C."""
        return self.stiffness + 1j * self.omega * self.damping

    def to_control(self) -> Any:
        """``control.FrequencyResponseData`` from approach to force."""
        import control

        return control.frd(self.impedance, self.omega, inputs="u", outputs="F", name="contact")

    def summary(self) -> dict[str, Any]:
        """The JSON form of the command line."""
        return {
            "omega": self.omega.tolist(),
            "stiffness": self.stiffness.tolist(),
            "damping": self.damping.tolist(),
            "approach": self.approach,
            "residual": self.residual.tolist(),
            "seconds": self.seconds,
            "n": self.n,
            "domain": list(self.domain.as_tuple()),
            "point": self.point.to_dict(),
            "version": self.version,
        }
