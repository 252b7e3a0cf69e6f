"""The film at rest."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from math import nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.origin import Origin
from ehlcontact.results.si import SteadySI
from ehlcontact.solver.accuracy import ErrorEstimate
from ehlcontact.status import Status

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SteadyResult(Origin):
    """Steady film of a contact under constant load, or at a prescribed approach, dimensionless; ``si`` is in SI.

    Attributes
    ----------
    X, Y : ndarray, shape (nx + 1,), (ny + 1,)
        x/a and y/b >= 0; fields are even in Y.
    P, H : ndarray, shape (nx + 1, ny + 1)
        Pressure over the Hertz pressure, and film over the dry approach.
    approach : float
        Mutual approach over the dry approach.
    force : float
        Film force over the static load.
    h_central, h_min : float
        Film at X = Y = 0 and the smallest, between the nodes too, over the dry approach.
    residuals : ndarray, shape (cycles + 1,)
        Mean |residual| over P > 0: at the start after full multigrid, then after each cycle. It weighs a node by
        its flow factor, so it is most where pressure matters least: what is solved is judged by `pressure_error`.
    load_residuals : ndarray, shape (cycles + 1,)
        Of the load (or approach) equation, likewise.
    approach_changes : ndarray, shape (cycles,)
        Change of the approach in each cycle.
    pressure_changes : ndarray, shape (cycles,)
        Largest change of P in each cycle; empty in results that were stored before it was kept.
    dry_residual : float
        Mean |residual| of the dry Hertz start on this grid: the scale.
    status : Status
    error : ErrorEstimate or None
        How far approach and films may be from those of an endless fine mesh on the same region; None of a film
        that is not converged, and of files written before there were estimates.
    point, scales, domain, n, seconds, version
        As in every result: `ehlcontact.origin.Origin`.
    """

    X: Array
    Y: Array
    P: Array
    H: Array
    approach: float
    force: float
    h_central: float
    h_min: float
    residuals: Array
    load_residuals: Array
    approach_changes: Array
    dry_residual: float
    status: Status
    # files of earlier versions have neither
    pressure_changes: Array = field(default_factory=lambda: np.empty(0), metadata={"later": True})
    error: ErrorEstimate | None = field(default=None, metadata={"later": True})

    @property
    def si(self) -> SteadySI:
        """All of it in SI; raises `InputError` for a dimensionless point, which has no units."""
        return SteadySI.of(self)

    @property
    def pressure_error(self) -> float:
        """Largest change of P that further cycles would still make: what `tol` of `solve_steady` is held against.

        Infinite where the changes do not fall, NaN where `pressure_changes` is empty.
        """
        from ehlcontact.solver.iterate import pressure_error  # and all kernels, which a stored result needs not

        changes = self.pressure_changes.tolist()
        return pressure_error(changes) if changes else nan

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
            "pressure_error": self.pressure_error,
            "residual": self.residual,
            "load_residual": self.load_residual,
            "cycles": self.cycles,
            "seconds": self.seconds,
            "error": None if self.error is None else asdict(self.error),
            "status": str(self.status),
            "advice": self.status.advice,
            "n": self.n,
            "domain": list(self.domain.as_tuple()),
            "point": self.point.to_dict(),
            "version": self.version,
            **({} if self.scales is None else {"si": self.si.summary()}),
        }
