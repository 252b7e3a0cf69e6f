"""Frozen results of the solvers; arrays are read-only. Everything is dimensionless, with the SI scales beside."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint, Scales
from ehlcontact.solver.domain import Domain
from ehlcontact.status import Status
from ehlcontact.transient.motion import Motion, PrescribedApproach

Array = NDArray[np.float64]


def _freeze(result: Any) -> None:
    for f in fields(result):
        value = getattr(result, f.name)
        if isinstance(value, np.ndarray):
            value.setflags(write=False)


@dataclass(frozen=True, slots=True, eq=False)
class SteadyResult:
    """Steady film of a contact under constant load, or at a prescribed approach."""

    point: MoesPoint
    scales: Scales | None  # None for a purely dimensionless point
    domain: Domain
    n: int  # intervals along X
    X: Array  # (nx + 1,)
    Y: Array  # (ny + 1,), Y >= 0; fields are even in Y
    P: Array  # (nx + 1, ny + 1) pressure / p_hertz
    H: Array  # (nx + 1, ny + 1) film / dry approach
    approach: float  # mutual approach / dry approach
    force: float  # film force / static load
    h_central: float  # film at X = Y = 0
    h_min: float  # smallest film, between the nodes too
    residuals: Array  # mean |residual| over P > 0: start after full multigrid, then each cycle
    load_residuals: Array  # residual of the load (or approach) equation, likewise
    approach_changes: Array  # change of the approach in each cycle
    dry_residual: float  # mean |residual| of the dry Hertz start on this grid: the scale
    status: Status
    seconds: float
    version: str

    def __post_init__(self) -> None:
        _freeze(self)

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


@dataclass(frozen=True, slots=True, eq=False)
class Instants:
    """A simulation between its steps: continuous with continuous slopes, every array of the shape of T."""

    T: Array
    approach: Array
    rate: Array  # derivative of `approach`
    force: Array
    load: Array  # of the motion itself; the film force where the approach is prescribed
    h_central: Array
    h_min: Array

    def __post_init__(self) -> None:
        _freeze(self)


@dataclass(frozen=True, slots=True, eq=False)
class SimulationResult:
    """History of a transient contact; entry 0 is the initial state at T = 0."""

    point: MoesPoint
    scales: Scales | None
    domain: Domain
    n: int
    motion: Motion
    X: Array  # (nx + 1,)
    Y: Array  # (ny + 1,)
    T: Array  # (steps + 1,)
    approach: Array
    rate: Array  # d approach/dT
    acceleration: Array
    force: Array  # film force
    load: Array  # applied load f_ext(T)
    h_central: Array
    h_min: Array
    h_midplane: Array  # (steps + 1, nx + 1) film along Y = 0
    p_midplane: Array  # (steps + 1, nx + 1) pressure along Y = 0
    residuals: Array  # relative residual of each step's last cycle
    load_residuals: Array
    cycles: Array  # cycles of each step
    snapshot_T: Array  # (k,)
    snapshot_H: Array  # (k, nx + 1, ny + 1)
    snapshot_P: Array  # (k, nx + 1, ny + 1)
    static_approach: float  # of the steady state under load 1
    status: Status
    seconds: float
    version: str

    def __post_init__(self) -> None:
        _freeze(self)

    @property
    def steps(self) -> int:
        """Number of time steps done."""
        return len(self.T) - 1

    def at(self, T: ArrayLike) -> Instants:
        """Dense output: cubic Hermite polynomials between the steps.

        The approach takes its slopes from the recorded rate (fourth order where the bodies have inertia), force
        and films from second-order differences of the record (third order).

        Parameters
        ----------
        T : array_like
            Times within the record, of any shape.

        Raises
        ------
        InputError
            A time that is not a number, or outside the record; a record of fewer than three times.
        """
        from scipy.interpolate import CubicHermiteSpline

        try:
            times = np.array(T, dtype=float)
        except (TypeError, ValueError):
            raise InputError("T", T, "numbers") from None
        if self.T.size < 3:
            raise InputError("steps", self.steps, "at least 2 to interpolate between")
        outside = times[~((times >= self.T[0]) & (times <= self.T[-1]))]
        if outside.size:
            raise InputError("T", float(outside.flat[0]), f"between {self.T[0]:g} and {self.T[-1]:g}")

        def smooth(values: Array) -> Array:
            return CubicHermiteSpline(self.T, values, np.gradient(values, self.T, edge_order=2))(times)

        approach = CubicHermiteSpline(self.T, self.approach, self.rate)
        force = smooth(self.force)
        motion = self.motion
        return Instants(
            T=times,
            approach=approach(times),
            rate=approach(times, 1),
            force=force,
            load=force.copy()
            if isinstance(motion, PrescribedApproach)
            else np.array([motion.load(t) for t in times.flat]).reshape(times.shape),
            h_central=smooth(self.h_central),
            h_min=smooth(self.h_min),
        )

    def dissipated(self, start: float = 0.0, end: float = np.inf) -> float:
        """Work ``integral of force d(approach)`` over T in [start, end]: what the film took up."""
        keep = (self.T >= start) & (self.T <= end)
        return float(np.trapezoid(self.force[keep], self.approach[keep]))

    def summary(self) -> dict[str, Any]:
        """The JSON form of the command line."""
        arrays = ("T", "approach", "rate", "force", "load", "h_central", "h_min")
        return {
            "status": str(self.status),
            "advice": self.status.advice,
            "steps": self.steps,
            "seconds": self.seconds,
            **{name: getattr(self, name).tolist() for name in arrays},
            "residual": float(self.residuals.max()),
            "load_residual": float(np.abs(self.load_residuals).max()),
            "n": self.n,
            "domain": list(self.domain.as_tuple()),
            "motion": self.motion.to_dict(),
            "point": self.point.to_dict(),
            "version": self.version,
        }
