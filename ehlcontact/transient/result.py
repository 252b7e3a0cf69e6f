"""Result of a transient run: its history, and interpolation between its steps; arrays are read-only.

Everything is dimensionless, with the SI scales beside.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.errors import InputError
from ehlcontact.origin import Origin, freeze
from ehlcontact.quantities import (
    ACCELERATION,
    ACROSS,
    ALONG,
    FORCE,
    FREQUENCY,
    LENGTH,
    MASS,
    NUMBER,
    PRESSURE,
    RATE,
    TIME,
)
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.results.steady_result import film_bars, grid_doubt
from ehlcontact.results.table import Display, QuantityTable, ScaledTable
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.status import Status
from ehlcontact.store import stored
from ehlcontact.summary import contact_text, span
from ehlcontact.supply import OilLayer
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.prescribed import passed_over_note
from ehlcontact.transient.speed import SpeedHistory
from ehlcontact.transient.time_step import coarse_step_note, coarse_tolerance_note

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Instants(QuantityTable):
    """A simulation between its steps, continuous with continuous slopes, dimensionless.

    Attributes
    ----------
    T, approach, rate, force, load, h_central, h_min : ndarray, all of the shape of T
        As in `SimulationResult`; the load of a motion that prescribes the approach is the film force.
    """

    T: Annotated[Array, TIME.over("T")]
    approach: Annotated[Array, LENGTH.over("T")]
    rate: Annotated[Array, RATE.over("T")]
    force: Annotated[Array, FORCE.over("T")]
    load: Annotated[Array, FORCE.over("T")]
    h_central: Annotated[Array, LENGTH.over("T")]
    h_min: Annotated[Array, LENGTH.over("T")]

    DISPLAY: ClassVar[Display] = Display(rows="T", panels=("force load", "approach", "h_central h_min"))
    UNITS = "dimensionless"

    def __post_init__(self) -> None:
        freeze(self)

    def _summary_lines(self) -> list[str]:
        return [
            f"{self.T.size} times, T {span(self.T)}",
            f"approach {span(self.approach)}, force {span(self.force)}",
        ]


@stored("result of simulate")
@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SimulationResult(ScaledTable, Origin):
    """History of a transient contact, dimensionless; entry 0 is the initial state at T = 0. ``si`` has it in SI.

    Attributes
    ----------
    motion : Motion
    speed : SpeedHistory or None
        Speed of the surfaces over time; None where it is constant.
    X, Y : ndarray, shape (nx + 1,), (ny + 1,)
        x/a and y/b >= 0; fields are even in Y. In SI ``x``, ``y`` [m].
    T : ndarray, shape (steps + 1,)
        Times, in 2a/u_sum; in SI ``t`` [s].
    approach, rate, acceleration : ndarray, shape (steps + 1,)
        Mutual approach over the dry approach, and its derivatives to T; in SI [m], [m/s], [m/s2].
    force, load : ndarray, shape (steps + 1,)
        Film force, and applied load f_ext(T), over the static load; in SI [N].
    h_central, h_min : ndarray, shape (steps + 1,)
        Film at X = Y = 0, and the smallest, between the nodes too, over the dry approach; in SI [m].
    h_midplane, p_midplane : ndarray, shape (steps + 1, nx + 1)
        Film over the dry approach and pressure over the Hertz pressure, along Y = 0; in SI [m], [Pa].
    residuals : ndarray, shape (steps + 1,)
        Of each step's last cycle, relative to the central film at rest.
    load_residuals : ndarray, shape (steps + 1,)
        Of the equation that closed each step, over the static load.
    cycles : ndarray, shape (steps + 1,)
        Cycles of each step.
    snapshot_T : ndarray, shape (k,)
        Times of the whole fields kept; in SI ``snapshot_t`` [s].
    snapshot_H, snapshot_P : ndarray, shape (k, nx + 1, ny + 1)
        Film over the dry approach and pressure over the Hertz pressure; in SI ``snapshot_h`` [m], ``snapshot_p``
        [Pa].
    static_approach : float
        Of the steady state under load 1, over the dry approach; in SI [m].
    static_load : float
        1; in SI [N].
    Omega : float or None
        Of a harmonic load; in SI ``omega`` [rad/s] and ``hz``.
    mass : float or None
        Of bodies with inertia (eq. 5), 1/Omega_n^2; in SI [kg].
    status : Status
    tol : float or None
        Residual at which its steps counted as solved, relative to the central film at rest.
    supply : OilLayer or None
        As given to `simulate`; None of a flooded inlet, and with it the following two.
    layer : ndarray or None, shape (ny + 1,)
        Oil on both surfaces ahead of the contact, over the dry approach; in SI [m].
    layer_behind : ndarray or None, shape (steps + 1, ny + 1)
        Oil on both surfaces where they leave the computed region; in SI [m].
    temperature : FilmTemperature or None
        Of the film at T = 0; None of an isothermal film, and with it the following three.
    warmest_oil, warmest_surface : ndarray or None, shape (steps + 1,)
        Largest mean temperature over the film, and that of a surface [K above the inlet].
    heat_balance : ndarray or None, shape (steps + 1,)
        Heat made less what oil stores, what it carries away and what surfaces take, over the first, in each step.
    film_error : ErrorEstimate or None
        How far approach and films at T = 0 may be from those of an endless fine mesh on the same region; None of a
        start that is not solved. In SI its approach is in m.
    point, scales, domain, n, seconds, version
        As in every result: `ehlcontact.origin.Origin`.
    """

    motion: Motion
    speed: SpeedHistory | None = None
    X: Annotated[Array, ALONG.over("X", listed=False)]
    Y: Annotated[Array, ACROSS.over("Y", listed=False)]
    T: Annotated[Array, TIME.over("T")]
    approach: Annotated[Array, LENGTH.over("T")]
    rate: Annotated[Array, RATE.over("T")]
    acceleration: Annotated[Array, ACCELERATION.over("T", listed=False)]
    force: Annotated[Array, FORCE.over("T")]
    load: Annotated[Array, FORCE.over("T")]
    h_central: Annotated[Array, LENGTH.over("T")]
    h_min: Annotated[Array, LENGTH.over("T")]
    h_midplane: Annotated[Array, LENGTH.over("T X", listed=False)]
    p_midplane: Annotated[Array, PRESSURE.over("T X", listed=False)]
    residuals: Annotated[Array, NUMBER.over("T", listed=False)]
    load_residuals: Annotated[Array, NUMBER.over("T", listed=False)]
    cycles: Annotated[Array, NUMBER.over("T", listed=False)]
    snapshot_T: Annotated[Array, TIME.over("snapshot_T", listed=False)]
    snapshot_H: Annotated[Array, LENGTH.over("snapshot_T X Y", listed=False)]
    snapshot_P: Annotated[Array, PRESSURE.over("snapshot_T X Y", listed=False)]
    static_approach: Annotated[float, LENGTH]
    status: Status
    tol: float | None = None
    film_error: ErrorEstimate | None = None
    supply: OilLayer | None = None
    layer: Annotated[Array | None, LENGTH.over("Y", listed=False)] = None
    layer_behind: Annotated[Array | None, LENGTH.over("T Y", listed=False)] = None
    temperature: FilmTemperature | None = None
    warmest_oil: Annotated[Array | None, NUMBER.over("T", listed=False)] = None
    warmest_surface: Annotated[Array | None, NUMBER.over("T", listed=False)] = None
    heat_balance: Annotated[Array | None, NUMBER.over("T", listed=False)] = None

    DISPLAY: ClassVar[Display] = Display(
        rows="T", panels=("force load", "approach", "h_central h_min", "h_midplane")
    )

    def require_complete(self, **sizes: int) -> None:
        """Raise `ValueError` unless all arrays have the shapes of each other and of the grid."""
        QuantityTable.require_complete(self, X=self.n + 1, T=max(self.T.size, 1))

    @property
    def static_load(self) -> Annotated[float, FORCE.in_si_only()]:
        """Static load: 1."""
        return 1.0

    @property
    def Omega(self) -> Annotated[float | None, FREQUENCY.in_si_only()]:
        """Angular frequency of the load, None where it is not harmonic."""
        return getattr(self.motion, "Omega", None)

    @property
    def mass(self) -> Annotated[float | None, MASS.in_si_only()]:
        """Mass of the bodies (eq. 5), 1/Omega_n^2; None without inertia."""
        Omega_n: float | None = getattr(self.motion, "Omega_n", None)
        return None if Omega_n is None else 1.0 / Omega_n**2

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
        return OilLayer(H=self.layer_behind[-1], y=self.Y)

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

        Where the grid does not show the film at the start, where step or `tol` are coarse for the motion, and
        where steps pass over changes of a table.
        """
        if not self.status.ok:
            return ""
        tol = "" if self.tol is None else coarse_tolerance_note(self.motion, self.tol)
        over = passed_over_note(
            (self.motion, self.speed), self.T, None if self.scales is None else self.scales.time
        )
        step = coarse_step_note(self.motion, self.T)
        return "; ".join(filter(None, [grid_doubt(self.film_error, "at the start"), step, tol, over]))

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
        lines[-1] += "".join(f", {text}" for text in (self._oil_words, self._heat_words) if text)
        if self.film_error is not None:
            central, least = film_bars(self.film_error)
            lines[-1] += f"; at the start {central} in the centre, {least} at least"
        return [*lines, *filter(None, [self.reservation])]

    @property
    def _oil_words(self) -> str:
        """Layer of oil ahead of the contact, in words; empty of a flooded one."""
        if self.layer is None:
            return ""
        unit, name = (1.0, "dry approaches") if self.scales is None else (1e6 * self.scales.length, "µm")
        return f"under a layer of {unit * self.layer[0]:.4g} {name}"

    @property
    def _heat_words(self) -> str:
        """Largest warming of the oil, in words; empty of an isothermal film."""
        if self.warmest_oil is None:
            return ""
        return f"with heat: oil up to {self.warmest_oil.max():.3g} K above the inlet"

    def to_dict(self) -> dict[str, Any]:
        """Histories, status and origin, ready for JSON; of an SI point with ``si``."""
        return (
            ScaledTable.to_dict(self)
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
            | ({} if self.temperature is None else {"temperature": self.temperature.to_dict()})
            | self.origin_dict()
        )
