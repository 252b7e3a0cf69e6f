"""What a run leaves: its history, and the history between its steps; arrays are read-only.

Everything is dimensionless, with the SI scales beside.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.errors import InputError
from ehlcontact.origin import Origin, freeze
from ehlcontact.status import Status
from ehlcontact.transient.motion import Motion

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Instants:
    """A simulation between its steps: continuous with continuous slopes, every array of the shape of T."""

    T: Array  # times
    approach: Array  # mutual approach / dry approach
    rate: Array  # derivative of `approach`
    force: Array  # film force / static load
    load: Array  # of the motion itself; the film force where the approach is prescribed
    h_central: Array  # film at X = Y = 0 / dry approach
    h_min: Array  # smallest film / dry approach

    def __post_init__(self) -> None:
        freeze(self)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SimulationResult(Origin):
    """History of a transient contact; entry 0 is the initial state at T = 0."""

    motion: Motion
    X: Array  # (nx + 1,) x/a
    Y: Array  # (ny + 1,) y/b >= 0; fields are even in Y
    T: Array  # (steps + 1,) times
    approach: Array  # (steps + 1,) mutual approach / dry approach
    rate: Array  # (steps + 1,) d approach/dT
    acceleration: Array  # (steps + 1,) d rate/dT
    force: Array  # (steps + 1,) film force / static load
    load: Array  # (steps + 1,) applied load f_ext(T) / static load
    h_central: Array  # (steps + 1,) film at X = Y = 0 / dry approach
    h_min: Array  # (steps + 1,) smallest film / dry approach, between the nodes too
    h_midplane: Array  # (steps + 1, nx + 1) film along Y = 0 / dry approach
    p_midplane: Array  # (steps + 1, nx + 1) pressure along Y = 0 / p_hertz
    residuals: Array  # (steps + 1,) of each step's last cycle, relative to the central film at rest
    load_residuals: Array  # (steps + 1,) of the equation that closed each step, / static load
    cycles: Array  # (steps + 1,) cycles of each step
    snapshot_T: Array  # (k,) times of the whole fields kept
    snapshot_H: Array  # (k, nx + 1, ny + 1) film / dry approach
    snapshot_P: Array  # (k, nx + 1, ny + 1) pressure / p_hertz
    static_approach: float  # of the steady state under load 1 / dry approach
    status: Status

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
        loads = [self.motion.applied(t, f) for t, f in zip(times.flat, force.flat, strict=True)]
        return Instants(
            T=times,
            approach=approach(times),
            rate=approach(times, 1),
            force=force,
            load=np.array(loads).reshape(times.shape),
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
