"""What a run leaves: its history, and the history between its steps; arrays are read-only.

Everything is dimensionless, with the SI scales beside.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.errors import InputError
from ehlcontact.origin import Origin, freeze
from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.results.steady import film_bars, grid_doubt
from ehlcontact.solver.accuracy import ErrorEstimate
from ehlcontact.status import Status
from ehlcontact.summary import Summary, contact_text, span
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.si import SimulationSI
from ehlcontact.transient.time_step import coarse_step_note, coarse_tolerance_note

Array = NDArray[np.float64]
HISTORY = {
    "T": ("2a/u_sum", "T"),
    "approach": ("delta_H", "T"),
    "rate": ("delta_H u_sum/(2a)", "T"),
    "force": ("f0", "T"),
    "load": ("f0", "T"),
    "h_central": ("delta_H", "T"),
    "h_min": ("delta_H", "T"),
}


@dataclass(frozen=True, slots=True, eq=False)
class Instants(Summary, Tabled):
    """A simulation between its steps, continuous with continuous slopes, dimensionless.

    Attributes
    ----------
    T, approach, rate, force, load, h_central, h_min : ndarray, all of the shape of T
        As in `SimulationResult`; the load of a motion that prescribes the approach is the film force.
    """

    T: Array
    approach: Array
    rate: Array
    force: Array
    load: Array
    h_central: Array
    h_min: Array

    LAYOUT: ClassVar[Layout] = Layout(
        rows="T", panels=("force load", "approach", "h_central h_min"), quantities=HISTORY
    )

    def __post_init__(self) -> None:
        freeze(self)

    def _summary_lines(self) -> list[str]:
        return [
            f"{self.T.size} times, T {span(self.T)}",
            f"approach {span(self.approach)}, force {span(self.force)}",
        ]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SimulationResult(Summary, Tabled, Origin):
    """History of a transient contact, dimensionless; entry 0 is the initial state at T = 0. ``si`` has it in SI.

    Attributes
    ----------
    motion : Motion
    X, Y : ndarray, shape (nx + 1,), (ny + 1,)
        x/a and y/b >= 0; fields are even in Y.
    T : ndarray, shape (steps + 1,)
        Times, in 2a/u_sum.
    approach, rate, acceleration : ndarray, shape (steps + 1,)
        Mutual approach over the dry approach, and its derivatives to T.
    force, load : ndarray, shape (steps + 1,)
        Film force, and applied load f_ext(T), over the static load.
    h_central, h_min : ndarray, shape (steps + 1,)
        Film at X = Y = 0, and the smallest, between the nodes too, over the dry approach.
    h_midplane, p_midplane : ndarray, shape (steps + 1, nx + 1)
        Film over the dry approach and pressure over the Hertz pressure, along Y = 0.
    residuals : ndarray, shape (steps + 1,)
        Of each step's last cycle, relative to the central film at rest.
    load_residuals : ndarray, shape (steps + 1,)
        Of the equation that closed each step, over the static load.
    cycles : ndarray, shape (steps + 1,)
        Cycles of each step.
    snapshot_T : ndarray, shape (k,)
        Times of the whole fields kept.
    snapshot_H, snapshot_P : ndarray, shape (k, nx + 1, ny + 1)
        Film over the dry approach and pressure over the Hertz pressure.
    static_approach : float
        Of the steady state under load 1, over the dry approach.
    status : Status
    tol : float or None
        Residual at which its steps counted as solved, relative to the central film at rest; None of files written
        before it was kept.
    film_error : ErrorEstimate or None
        How far approach and films at T = 0 may be from those of an endless fine mesh on the same region; None of a
        start that is not solved, and of files written before it was kept.
    point, scales, domain, n, seconds, version
        As in every result: `ehlcontact.origin.Origin`.
    """

    motion: Motion
    X: Array
    Y: Array
    T: Array
    approach: Array
    rate: Array
    acceleration: Array
    force: Array
    load: Array
    h_central: Array
    h_min: Array
    h_midplane: Array
    p_midplane: Array
    residuals: Array
    load_residuals: Array
    cycles: Array
    snapshot_T: Array
    snapshot_H: Array
    snapshot_P: Array
    static_approach: float
    status: Status
    tol: float | None = field(default=None, metadata={"later": True})
    film_error: ErrorEstimate | None = field(default=None, metadata={"later": True})

    LAYOUT: ClassVar[Layout] = Layout(
        rows="T",
        panels=("force load", "approach", "h_central h_min", "h_midplane"),
        quantities={
            **HISTORY,
            "acceleration": ("delta_H (u_sum/(2a))^2", "T"),
            "residuals": ("", "T"),
            "cycles": ("", "T"),
            "X": ("a", "X"),
            "Y": ("b", "Y"),
            "h_midplane": ("delta_H", "T X"),
            "p_midplane": ("p_h", "T X"),
            "snapshot_T": ("2a/u_sum", "snapshot_T"),
            "snapshot_H": ("delta_H", "snapshot_T X Y"),
            "snapshot_P": ("p_h", "snapshot_T X Y"),
            "static_approach": ("delta_H", ""),
        },
    )

    @property
    def si(self) -> SimulationSI:
        """All of it in SI; raises `InputError` for a dimensionless point, which has no units."""
        return SimulationSI.of(self)

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

    @property
    def reservation(self) -> str:
        """What a converged run leaves open, in words; else empty.

        Where the grid does not show the film at the start, and where step or `tol` are coarse for the motion.
        """
        if not self.status.ok:
            return ""
        tol = "" if self.tol is None else coarse_tolerance_note(self.motion, self.tol)
        return "; ".join(
            filter(None, [grid_doubt(self.film_error, "at the start"), coarse_step_note(self.motion, self.T), tol])
        )

    def _summary_lines(self) -> list[str]:
        lines = [
            contact_text(self.point, self.scales),
            f"{self.motion.kind}: {self.status} after {self.steps} steps on n = {self.n} to T = {self.T[-1]:.4g}",
        ]
        if self.scales is None:
            lines += [
                f"approach {span(self.approach)}, force {span(self.force)}",
                f"film at least {self.h_min.min():.4g}",
            ]
        else:
            s = self.scales
            lines[1] += f", {1e3 * s.time * self.T[-1]:.4g} ms"
            lines += [
                f"approach {span(self.approach, 1e6 * s.length, 'µm')}, force {span(self.force, s.force, 'N')}"
            ]
            lines += [f"film at least {1e6 * s.length * self.h_min.min():.4g} µm"]
        if self.film_error is not None:
            central, least = film_bars(self.film_error)
            lines[-1] += f"; at the start {central} in the centre, {least} at least"
        return [*lines, *filter(None, [self.reservation])]

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
            "tol": self.tol,
            "film_error": None if self.film_error is None else asdict(self.film_error),
            "reservation": self.reservation,
            "n": self.n,
            "domain": list(self.domain.as_tuple()),
            "motion": self.motion.to_dict(),
            "point": self.point.to_dict(),
            "version": self.version,
            **({} if self.scales is None else {"si": self.si.summary()}),
        }
