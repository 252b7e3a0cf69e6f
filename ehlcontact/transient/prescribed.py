"""Motions given by a table over time: a load on the bodies, or their approach itself."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from math import inf
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ehlcontact.checks import as_column, parts, require_positive
from ehlcontact.checks.frequency import by_name, fields_by_name
from ehlcontact.checks.kinds import STEPS, Callback
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint, Point
from ehlcontact.solver.balance import Balance
from ehlcontact.transient.bodies import (
    LONGEST_ABRUPT,
    MADE_AT,
    Array,
    Motion,
    MotionState,
    Start,
    UnderLoad,
    scales_at,
)
from ehlcontact.transient.motion import RampLoad

CORNER = 0.3  # jump of a table's slope, over its steepest, that counts as a corner; 1/20 period of a sine is 0.31
MISSED = 0.5  # of the range of a table, by which a row is beyond the values at both ends of a step
# Largest approach and load of a table, from which they hardly are dry approaches and static loads
FLATTEST, HEAVIEST = 1e-3, 20.0
FEWEST_ROWS = 4  # of a cubic spline; the same for straight tables
Table = tuple[Array, Array]  # times and values, shape (k,) each


def as_table(times: ArrayLike, values: ArrayLike, names: tuple[str, str] = ("T", "values")) -> Table:
    """Copies of both columns: four rows or more, with times that increase from 0; `names` are for messages."""
    of_times, of_values = names
    column = as_column(of_times, times, increasing=True)
    if column[0] != 0.0:
        raise InputError(f"{of_times}[0]", float(column[0]), "0, where the run begins")
    row = as_column(of_values, values, size=column.size)
    if column.size < FEWEST_ROWS:
        allowed = f"at least {FEWEST_ROWS}, in every table over time, for the cubic splines of approaches"
        raise InputError(f"length of {of_times}", column.size, allowed)
    return column, row


def corners_of(T: Array, values: Array) -> tuple[float, ...]:
    """Times of a table at which its slope jumps by more than `CORNER` of its steepest slope."""
    slope = np.diff(values) / np.diff(T)
    jump = np.abs(np.diff(slope)) > CORNER * np.abs(slope).max()
    return tuple(T[1:-1][jump].tolist())


def passed_over(table: Table, T: Array) -> bool:
    """Whether one of the steps between the times `T` passes over a change of the table and back, or all of it."""
    times, values = table
    if T.size < 2 or not np.ptp(values):
        return False
    inside = times <= T[-1]
    step = np.minimum(np.searchsorted(T, times[inside], side="right") - 1, T.size - 2)
    ends = np.interp(T, times, values)
    beyond = np.abs(values[inside] - np.clip(values[inside], *np.sort([ends[step], ends[step + 1]], axis=0)))
    return bool(T[1] >= times[-1] or beyond.max() > MISSED * np.ptp(values))


def passed_over_note(inputs: Iterable[object], T: Array, point: Point) -> str:
    """Note on inputs with a table over time that the steps between the times `T` pass over; else empty."""
    unit = point.scales.time
    for one in inputs:
        name, table = type(one).__name__, getattr(one, "_table", None)
        if table is None or not passed_over(table, T):
            continue
        step, end = float(np.diff(T).max()), float(table[0][-1])
        length, last, hint = f"T = {step:.3g}", f"T = {end:.3g}", ""
        if isinstance(point, OperatingPoint):
            length, last = f"{length} ({unit * step:.3g} s)", f"{last} ({unit * end:.3g} s)"
            hint = f"; {name}(T, ...) is in 2a/u_sum, {name}.at(point, ...) in seconds"
        return (
            f"steps pass over changes of the {name}: they are up to {length} long, "
            f"its table ends at {last}; take a smaller dt{hint}"
        )
    return ""


def unit_hint(motion: Motion, point: Point) -> str:
    """How to give a table in SI, where one at an `OperatingPoint` was hardly meant without; else empty."""
    if motion.made_at is not None or not isinstance(point, OperatingPoint):
        return ""
    if isinstance(motion, RampLoad):
        wrong = motion.ratio > HEAVIEST
        return "RampLoad(ratio, ...) is in static loads, RampLoad.at(point, load=...) in newton" if wrong else ""
    if not isinstance(motion, Tabulated):
        return ""
    largest = float(np.abs(motion._table[1]).max())
    if isinstance(motion, PrescribedApproach):
        wrong, unit, si = 0.0 < largest < FLATTEST, "dry approaches", "metres"
    else:
        wrong, unit, si = largest > HEAVIEST, "static loads", "newton"
    name = type(motion).__name__
    return f"{name}(T, values) is in {unit}, {name}.at(point, ...) in seconds and {si}" if wrong else ""


class Tabulated(Motion):
    """Time span of a motion given by a table."""

    __slots__ = ()
    film_step: ClassVar[float] = LONGEST_ABRUPT  # whatever lies between its rows is meant
    _table: Table

    @property
    def default_end(self) -> float:
        """End of the table."""
        return float(self._table[0][-1])

    @property
    def default_step(self) -> float:
        """Mean spacing of the table; a fixed step of a run is 0.1 at most."""
        return self.default_end / (len(self._table[0]) - 1)


@fields_take(made_at=MADE_AT)
@fields_by_name(2, omega_n="Omega_n, dimensionless")
@dataclass(frozen=True, slots=True, eq=False)
class PrescribedLoad(Tabulated, UnderLoad):
    """Load given by a table (linear interpolation) on bodies with (`Omega_n`) or without inertia.

    All of it is dimensionless; `at` takes a table in seconds and newton at an `OperatingPoint`.

    Parameters
    ----------
    T : array_like, shape (k,)
        Increasing times, four or more from 0 on, in 2a/u_sum.
    values : array_like, shape (k,)
        Load over the static one.
    Omega_n : float, optional
        Natural frequency of the bodies, in u_sum/(2a).

    Raises
    ------
    InputError
        Fewer than four times, or times that do not rise from 0; a load that is not positive.
    """

    T: ArrayLike
    values: ArrayLike
    Omega_n: float | None = None
    kind: ClassVar[str] = "load"
    _table: Table = field(init=False, repr=False)

    def __post_init__(self) -> None:
        table = as_table(self.T, self.values)
        if not (table[1] > 0.0).all():
            raise InputError("values", float(table[1].min()), "loads > 0 (the contact must stay loaded)")
        if self.Omega_n is not None:
            require_positive("Omega_n", self.Omega_n)
        object.__setattr__(self, "_table", table)

    @classmethod
    @takes(t="s", load=parts.PRELOAD, mass=parts.MASS)
    def at(
        cls, point: OperatingPoint, t: ArrayLike, load: ArrayLike, *, mass: float | None = None
    ) -> PrescribedLoad:
        """The same in SI: loads [N] over times [s], shape (k,) each, on bodies of a mass [kg] or without inertia.

        Raises
        ------
        InputError
            As of the class; a dimensionless point.
        """
        scales = scales_at(point, "PrescribedLoad(T, values)")
        times, values = as_table(t, load, ("t", "load"))
        Omega_n = None if mass is None else point.Omega_n(mass)
        return cls(times / scales.time, values / scales.force, Omega_n=Omega_n, made_at=point)

    @classmethod
    @takes(load=Callback("T"), steps=STEPS)
    @by_name(4, "given as Omega_n, dimensionless", omega_n="Omega_n, dimensionless")
    def from_function(
        cls, load: Callable[[float], float], until: float, steps: int = 1000, Omega_n: float | None = None
    ) -> PrescribedLoad:
        """Sample a function of T on [0, until]."""
        T = np.linspace(0.0, require_positive("until", until), steps + 1)
        return cls(T, [load(t) for t in T], Omega_n=Omega_n)

    @takes(T=parts.ANY)
    def load(self, T: float) -> float:
        """Applied load."""
        return float(np.interp(T, *self._table))

    @property
    def corners(self) -> tuple[float, ...]:
        """Times of the table at which its slope jumps by more than `CORNER` of its steepest slope."""
        return corners_of(*self._table)

    @property
    def largest_load(self) -> float:
        """Largest load of the table."""
        return float(self._table[1].max())

    @property
    def size(self) -> float:
        """Largest change of the load since T = 0."""
        _, values = self._table
        return float(np.abs(values - values[0]).max()) or inf  # at a constant load what moves is on the surfaces

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        T, values = self._table
        return {"kind": self.kind, "T": T.tolist(), "values": values.tolist(), "Omega_n": self.Omega_n}


@fields_take(made_at=MADE_AT)
@dataclass(frozen=True, slots=True, eq=False)
class PrescribedApproach(Tabulated):
    """Approach u(T) given by a table (cubic spline, so that the rate is continuous).

    All of it is dimensionless; `at` takes a table in seconds and metres at an `OperatingPoint`.

    Parameters
    ----------
    T : array_like, shape (k,)
        Increasing times, four or more from 0 on, in 2a/u_sum.
    values : array_like, shape (k,)
        Approach over the dry one.

    Raises
    ------
    InputError
        Fewer than four times, or times that do not rise from 0.
    """

    T: ArrayLike
    values: ArrayLike
    kind: ClassVar[str] = "approach"
    _table: Table = field(init=False, repr=False)
    _spline: Any = field(init=False, repr=False)

    def __post_init__(self) -> None:
        from scipy.interpolate import CubicSpline

        table = as_table(self.T, self.values)
        parts.DRY_APPROACHES.take("values", table[1], False)
        object.__setattr__(self, "_table", table)
        object.__setattr__(self, "_spline", CubicSpline(*table))

    @classmethod
    @takes(t="s", approach=parts.APPROACH)
    def at(cls, point: OperatingPoint, t: ArrayLike, approach: ArrayLike) -> PrescribedApproach:
        """The same in SI: approaches [m] over times [s], shape (k,) each.

        Raises
        ------
        InputError
            As of the class; a dimensionless point.
        """
        scales = scales_at(point, "PrescribedApproach(T, values)")
        times, values = as_table(t, approach, ("t", "approach"))
        return cls(times / scales.time, values / scales.length, made_at=point)

    def approach(self, T: float) -> float:
        """Prescribed approach."""
        return float(self._spline(T))

    def rate(self, T: float) -> float:
        """Rate of the prescribed approach."""
        return float(self._spline(T, 1))

    def applied(self, T: float, force: float) -> float:
        """The film force, which is what the drive has to bring up."""
        return force

    def held(self, static: float) -> Start:
        """The approach at T = 0."""
        u = self.approach(0.0)
        return Start(Balance.of_approach(u), u)

    def begin(self, u: float, force: float) -> MotionState:
        """At the table's rate."""
        return MotionState(0.0, u, self.rate(0.0), 0.0)

    def balance(self, now: MotionState, T: float, dT: float) -> tuple[Balance, float]:
        """The approach of the table."""
        u = self.approach(T)
        return Balance.of_approach(u), u

    def after(self, now: MotionState, u: float, T: float, dT: float) -> MotionState:
        """At the table's rate."""
        return MotionState(T, u, self.rate(T), 0.0)

    def slopes(self, T: Array, approach: Array, rate: Array, acceleration: Array) -> tuple[Array, Array]:
        """The table's rate, and its differences."""
        return rate, np.gradient(rate, T, edge_order=2)

    def free(self, approach: float, force: float) -> tuple[float, ...]:
        """The force alone."""
        return (force,)

    @property
    def largest_load(self) -> float:
        """Dry Hertz load at the largest approach."""
        return max(1.0, float(self._table[1].max())) ** 1.5

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        T, values = self._table
        return {"kind": self.kind, "T": T.tolist(), "values": values.tolist()}
