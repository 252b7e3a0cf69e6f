"""Result of a transient run: its history, and interpolation between its steps; arrays are read-only."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import parts
from ehlcontact.checks.inputs import require_number
from ehlcontact.checks.quantity import takes
from ehlcontact.conditions import Conditions
from ehlcontact.errors import InputError
from ehlcontact.origin import Origin, freeze
from ehlcontact.point import Point
from ehlcontact.quantities import (
    ACROSS,
    ALONG,
    FORCE,
    FREQUENCY,
    HERTZ,
    LENGTH,
    MASS,
    in_hertz,
)
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.results.steady_result import film_bars, grid_doubt
from ehlcontact.results.table import Display, PointTable, QuantityTable
from ehlcontact.shear_thinning import ShearThinning
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.status import Status
from ehlcontact.store import stored
from ehlcontact.summary import contact_text, counted, film_unit, span
from ehlcontact.supply import OilLayer, layer_on
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.prescribed import passed_over_note
from ehlcontact.transient.record import Columns, SmoothColumns
from ehlcontact.transient.speed import SpeedHistory
from ehlcontact.transient.time_step import coarse_step_note, coarse_tolerance_note

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Instants(SmoothColumns, PointTable):
    """A simulation between its steps, continuous with continuous slopes, in the units of its point.

    Attributes
    ----------
    point : MoesPoint or OperatingPoint
    t, approach, rate, force, load, h_central, h_min : ndarray, all of the shape of t
        As in `SimulationResult`; the load of a motion that prescribes the approach is the film force.
    """

    point: Point

    DISPLAY: ClassVar[Display] = Display(rows="t", panels=("force load", "approach", "h_central h_min"))

    def __post_init__(self) -> None:
        freeze(self)

    def _summary_lines(self) -> list[str]:
        t, u, f = (span(getattr(self, name), 1.0, self._unit(name)) for name in ("t", "approach", "force"))
        return [f"{self.t.size} times, t {t}", f"approach {u}, force {f}"]


@stored("result of simulate", 3)
@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SimulationResult(Columns, PointTable, Origin):
    """History of a transient contact, in the units of its point; entry 0 is the initial state at t = 0.

    Units are those at an `OperatingPoint` and, after the semicolon, at a `MoesPoint`.

    Attributes
    ----------
    motion : Motion
    speed : SpeedHistory or None
        Speed of the surfaces over time; None where it is constant.
    x, y : ndarray, shape (nx + 1,), (ny + 1,)
        Places along rolling and across [m; semi-axes a, b], y >= 0; fields are even in y.
    t : ndarray, shape (steps + 1,)
        Times [s; 2a/u_sum].
    approach, rate, acceleration : ndarray, shape (steps + 1,)
        Mutual approach [m; dry approach], and its derivatives to t [m/s, m/s2].
    force, load : ndarray, shape (steps + 1,)
        Film force, and applied load f_ext(t) [N; static load].
    h_central, h_min : ndarray, shape (steps + 1,)
        Film at x = y = 0, and the smallest, between the nodes too [m; dry approach].
    h_midplane, p_midplane : ndarray, shape (steps + 1, nx + 1)
        Film [m; dry approach] and pressure [Pa; Hertz pressure] along y = 0.
    residuals : ndarray, shape (steps + 1,)
        Residual of the last cycle of each step, relative to the central film at rest.
    load_residuals : ndarray, shape (steps + 1,)
        Residual of the equation that closed each step, over the static load.
    cycles : ndarray, shape (steps + 1,)
        Cycles of each step.
    snapshot_t : ndarray, shape (k,)
        Times of the whole fields kept [s; 2a/u_sum].
    snapshot_h, snapshot_p : ndarray, shape (k, nx + 1, ny + 1)
        Film [m; dry approach] and pressure [Pa; Hertz pressure] at these times.
    static_approach : float
        Approach of the steady state under the static load [m; dry approach].
    static_load : float
        Static load [N; 1].
    omega, hz : float or None
        Frequency of a harmonic load [rad/s; u_sum/(2a)], [Hz] at an `OperatingPoint`.
    mass : float or None
        Of bodies with inertia (eq. 5) [kg; f0/delta_H (2a/u_sum)^2, which is 1/Omega_n^2].
    status : Status
    tol : float or None
        Residual at which its steps counted as solved, relative to the central film at rest.
    supply : OilLayer or None
        As given to `simulate`; None of a flooded inlet, and with it the following two.
    layer : ndarray or None, shape (ny + 1,)
        Oil on both surfaces ahead of the contact [m; dry approach].
    layer_behind : ndarray or None, shape (steps + 1, ny + 1)
        Oil on both surfaces where they leave the computed region [m; dry approach].
    sliding : ShearThinning or None
        As given to `simulate`; None of a Newtonian film.
    temperature : FilmTemperature or None
        Of the film at t = 0; None of an isothermal film, and with it the following three.
    warmest_oil, warmest_surface : ndarray or None, shape (steps + 1,)
        Largest mean temperature over the film, and that of a surface [K above the inlet].
    heat_balance : ndarray or None, shape (steps + 1,)
        Heat made less what oil stores, what it carries away and what surfaces take, over the first, in each step.
    film_error : ErrorEstimate or None
        How far approach [m; dry approach] and films at t = 0 may be from those of an endless fine mesh on the same
        region; None of a start that is not solved.
    point, domain, n, seconds, version
        As in every result: `ehlcontact.origin.Origin`.
    """

    motion: Motion
    speed: SpeedHistory | None = None
    x: Annotated[Array, ALONG.over("x", listed=False)]
    y: Annotated[Array, ACROSS.over("y", listed=False)]
    static_approach: Annotated[float, LENGTH]
    status: Status
    tol: float | None = None
    film_error: ErrorEstimate | None = None
    supply: OilLayer | None = None
    layer: Annotated[Array | None, LENGTH.over("y", listed=False)] = None
    sliding: ShearThinning | None = None
    temperature: FilmTemperature | None = None

    DISPLAY: ClassVar[Display] = Display(
        rows="t", panels=("force load", "approach", "h_central h_min", "h_midplane")
    )

    def require_complete(self, **sizes: int) -> None:
        """Raise `ValueError` unless all arrays have the shapes of each other and of the grid."""
        QuantityTable.require_complete(self, x=self.n + 1, t=max(self.t.size, 1))

    @property
    def conditions(self) -> Conditions:
        """Conditions that it ran under, with the data of the oil."""
        heat = None if self.temperature is None else self.temperature.inputs
        return Conditions(supply=self.supply, heat=heat, sliding=self.sliding)

    @property
    def static_load(self) -> Annotated[float, FORCE.in_si_only()]:
        """Static load."""
        return self.point.scales.force

    @property
    def omega(self) -> Annotated[float | None, FREQUENCY.in_si_only()]:
        """Angular frequency of the load, None where it is not harmonic."""
        Omega: float | None = getattr(self.motion, "Omega", None)
        return None if Omega is None else Omega * self.point.scales.frequency

    @property
    def hz(self) -> Annotated[float | None, HERTZ.in_si_only()]:
        """Frequency of the load, None where it is not harmonic; raises `InputError` at a `MoesPoint`."""
        omega = self.omega
        return None if omega is None else float(in_hertz(self.point, omega))

    @property
    def mass(self) -> Annotated[float | None, MASS.in_si_only()]:
        """Mass of the bodies (eq. 5), None without inertia."""
        Omega_n: float | None = getattr(self.motion, "Omega_n", None)
        return None if Omega_n is None else self.point.scales.mass / Omega_n**2

    @property
    def supply_behind(self) -> OilLayer:
        """What the surfaces carry away at the end, as the supply of the next contact of the same size.

        Raises
        ------
        InputError
            The inlet was flooded.
        """
        if self.layer_behind is None:
            raise InputError("supply", None, "given: what leaves a flooded contact is not known")
        return layer_on(self.point, self.layer_behind[-1], self.y)

    @property
    def steps(self) -> int:
        """Number of time steps done."""
        return len(self.t) - 1

    @takes(t=parts.ANY)
    def at(self, t: ArrayLike) -> Instants:
        """Dense output: cubic Hermite polynomials between the steps.

        The approach takes its slopes from the recorded rate (fourth order where the bodies have inertia), force
        and films from second-order differences of the record (third order).

        Parameters
        ----------
        t : array_like
            Times within the record, of any shape, in the unit of `t`.

        Raises
        ------
        InputError
            A time that is not a number, or outside the record; a record of fewer than three times.
        """
        from scipy.interpolate import CubicHermiteSpline

        try:
            times = np.array(t, dtype=float)
        except (TypeError, ValueError):
            raise InputError("t", t, "numbers") from None
        if self.t.size < 3:
            raise InputError("steps", self.steps, "at least 2 to interpolate between")
        outside = times[~((times >= self.t[0]) & (times <= self.t[-1]))]
        if outside.size:
            raise InputError("t", float(outside.flat[0]), f"between {self.t[0]:g} and {self.t[-1]:g}")

        def smooth(values: Array) -> Array:
            return CubicHermiteSpline(self.t, values, np.gradient(values, self.t, edge_order=2))(times)

        approach = CubicHermiteSpline(self.t, self.approach, self.rate)
        force = smooth(self.force)
        s = self.point.scales
        moments = zip((times / s.time).flat, (force / s.force).flat, strict=True)
        loads = s.force * np.array([self.motion.applied(T, f) for T, f in moments])
        return Instants(
            point=self.point,
            t=times,
            approach=approach(times),
            rate=approach(times, 1),
            force=force,
            load=loads.reshape(times.shape),
            h_central=smooth(self.h_central),
            h_min=smooth(self.h_min),
        )

    def dissipated(self, start: float = 0.0, end: float = np.inf) -> float:
        """Work ``integral of force d(approach)`` over t in [start, end]: what the film took up [J; f0 delta_H].

        Raises
        ------
        InputError
            Ends that are no numbers, or in reverse order.
        """
        start, end = (require_number(name, t, "a time") for name, t in (("start", start), ("end", end)))
        if not end >= self.t[0]:
            raise InputError("end", end, f"at least {self.t[0]:g}, where the run starts")
        if not start <= min(end, self.t[-1]):
            raise InputError("start", start, f"at most end = {end:g}")
        keep = (self.t >= start) & (self.t <= end)
        return float(np.trapezoid(self.force[keep], self.approach[keep]))

    @property
    def reservation(self) -> str:
        """What a converged run leaves open, in words; else empty.

        Where the grid does not show the film at the start, where step or `tol` are coarse for the motion, and
        where steps pass over changes of a table.
        """
        if not self.status.ok:
            return ""
        tol = "" if self.tol is None else coarse_tolerance_note(self.motion, self.tol)
        T = self.t / self.point.scales.time
        over = passed_over_note((self.motion, self.speed), T, self.point)
        step = coarse_step_note(self.motion, T)
        return "; ".join(filter(None, [grid_doubt(self.film_error, "at the start"), step, tol, over]))

    def _summary_lines(self) -> list[str]:
        size, unit = film_unit(self.point)
        end = f"{1e3 * self.t[-1]:.4g} ms" if self._in_si() else f"t = {self.t[-1]:.4g}"
        films = span(self.approach, size, unit if self._in_si() else "")
        lines = [
            contact_text(self.point),
            f"{self.motion.kind}: {self.status} after {counted(self.steps, 'step')} on n = {self.n} to {end}",
            f"approach {films}, force {span(self.force, 1.0, 'N' if self._in_si() else '')}",
            f"film at least {size * self.h_min.min():.4g} {unit}",
        ]
        lines[-1] += "".join(
            f", {text}" for text in (self._oil_words, self._sliding_words, self._heat_words) if text
        )
        if self.film_error is not None:
            central, least = film_bars(self.film_error)
            lines[-1] += f"; at the start {central} in the centre, {least} at least"
        return [*lines, *filter(None, [self.reservation])]

    @property
    def _oil_words(self) -> str:
        """Layer of oil ahead of the contact, in words; empty of a flooded one."""
        if self.layer is None:
            return ""
        size, unit = film_unit(self.point)
        return f"under a layer of {size * self.layer[0]:.4g} {unit}"

    @property
    def _sliding_words(self) -> str:
        """Sliding that thins the film, in words; empty of a Newtonian one."""
        return "" if self.sliding is None else f"thinned by sliding ({self.sliding.slide_roll:.3g})"

    @property
    def _heat_words(self) -> str:
        """Largest warming of the oil, in words; empty of an isothermal film."""
        if self.warmest_oil is None:
            return ""
        return f"with heat: oil up to {self.warmest_oil.max():.3g} K above the inlet"

    def to_dict(self) -> dict[str, Any]:
        """Histories, status and origin, ready for JSON."""
        return (
            PointTable.to_dict(self)
            | {
                "status": str(self.status),
                "advice": self.status.advice,
                "steps": self.steps,
                "residual": float(self.residuals.max()),
                "load_residual": float(np.abs(self.load_residuals).max()),
                "tol": self.tol,
                "reservation": self.reservation,
                "motion": self.motion.to_dict(),
            }
            | ({} if self.supply is None else {"supply": self.supply.to_dict()})
            | ({} if self.sliding is None else {"sliding": self.sliding.to_dict()})
            | ({} if self.temperature is None else {"temperature": self.temperature.to_dict()})
            | self.origin_dict()
        )
