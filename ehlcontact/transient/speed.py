"""Speed of the surfaces over time: run-ups, stops, reversals, as an argument of `simulate`.

Small changes over frequency: `ehlcontact.response`.

With the scales of the operating point kept, of which u_sum is one, the Reynolds equation (eq. 1) becomes

    N(P) = d/dX(eps dP/dX) + kappa^2 d/dY(eps dP/dY) - U d(rho H)/dX - d(rho H)/dT,   U(T) = u_sum(T)/u_sum,

which at a constant U is the contact of load number M U^(-3/4) and material number L U^(1/4), and at U = 0 squeezes
its film out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ehlcontact.checks import require_finite, require_instance, require_positive
from ehlcontact.checks.kinds import STEPS, Callback
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint, Point
from ehlcontact.solver.grid import Grid
from ehlcontact.transient.bodies import MADE_AT, Array, OverTime, scales_at
from ehlcontact.transient.features import Surface
from ehlcontact.transient.prescribed import as_table, corners_of

LARGEST_SPEED = 100.0  # over that of the operating point: a film of other scales
LARGEST_CHANGE = 1e6  # of U over T: a speed that jumps


@fields_take(made_at=MADE_AT)
@dataclass(frozen=True, slots=True, eq=False)
class SpeedHistory(OverTime):
    """Speed of both surfaces over time, straight between its rows, constant after the last.

    All of it is dimensionless; `at` takes a table in seconds and m/s at an `OperatingPoint`.

    Parameters
    ----------
    T : array_like, shape (k,)
        Increasing times, four or more from 0 on, in 2a/u_sum of the operating point.
    values : array_like, shape (k,)
        u_sum(T) over that of the operating point; the surfaces roll back where it is negative.

    Raises
    ------
    InputError
        Fewer than four times, or times that do not rise from 0; speeds above 100 times that of the
        operating point, or that change at once.
    """

    T: ArrayLike
    values: ArrayLike
    _table: tuple[Array, Array] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        times, speeds = as_table(self.T, self.values)
        largest = float(np.abs(speeds).max())
        if largest > LARGEST_SPEED:
            allowed = f"speeds up to {LARGEST_SPEED:g} times that of the operating point"
            raise InputError("values", largest, allowed)
        steepest = float(np.abs(np.diff(speeds) / np.diff(times)).max())
        if steepest > LARGEST_CHANGE:
            raise InputError("values", steepest, f"speeds that change by at most {LARGEST_CHANGE:g} within T = 1")
        object.__setattr__(self, "_table", (times, speeds))

    @classmethod
    @takes(t="s", u_sum="m/s")
    def at(cls, point: OperatingPoint, t: ArrayLike, u_sum: ArrayLike) -> Self:
        """The same in SI: sums of both surfaces' speeds [m/s] over times [s], shape (k,) each.

        Raises
        ------
        InputError
            As of the class; a dimensionless point.
        """
        scales = scales_at(point, "SpeedHistory(T, values)")
        times, speeds = as_table(t, u_sum, ("t", "u_sum"))
        return cls(times / scales.time, speeds / point.u_sum, made_at=point)

    @classmethod
    @takes(speed=Callback("T"), steps=STEPS)
    def from_function(cls, speed: Callable[[float], float], until: float, steps: int = 1000) -> Self:
        """Sample a function of T on [0, until]."""
        T = np.linspace(0.0, require_positive("until", until), steps + 1)
        return cls(T, [speed(t) for t in T])

    def __call__(self, T: float) -> float:
        """U(T)."""
        return float(np.interp(T, *self._table))

    def way(self, T: float) -> float:
        """Way of the surfaces, the integral of U from 0 to T."""
        T = require_finite("T", T)
        times, speeds = self._table
        i = int(np.clip(np.searchsorted(times, T, side="right") - 1, 0, times.size - 1))
        whole = np.diff(times[: i + 1]) @ (0.5 * (speeds[:i] + speeds[1 : i + 1]))
        return float(whole + 0.5 * (T - times[i]) * (speeds[i] + self(T)))

    def farthest(self, until: float) -> float:
        """Largest way from 0 to a time."""
        return max(self.way(T) for T in (0.0, *(c for c in self.corners if c < until), until))

    @property
    def largest(self) -> float:
        """Largest ``abs(U)``."""
        return float(np.abs(self._table[1]).max())

    @property
    def reverses(self) -> bool:
        """Whether the surfaces roll in both directions, or back from the start."""
        return bool(self._table[1].min() < 0.0)

    @property
    def corners(self) -> tuple[float, ...]:
        """Times at which its slope jumps, and those at which the surfaces turn back."""
        T, U = self._table
        turns = np.flatnonzero(U[1:] * U[:-1] < 0.0)
        zeros = T[turns] - U[turns] * (T[turns + 1] - T[turns]) / (U[turns + 1] - U[turns])
        return tuple(sorted({*corners_of(T, U), *zeros.tolist()}))

    def to_dict(self) -> dict[str, Any]:
        """For storage."""
        return {"T": self._table[0].tolist(), "values": self._table[1].tolist()}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from `to_dict`."""
        return cls(**data)


def surface_at(surface: Surface | None, speed: SpeedHistory | None) -> Surface | None:
    """A surface that moves with a speed that changes: over the way of the surfaces in place of time."""
    if surface is None or speed is None:
        return surface
    return lambda X, Y, T: surface(X, Y, speed.way(T))


def require_speed(speed: SpeedHistory | None, grid: Grid, point: Point) -> None:
    """Raise `InputError` unless a run can be made with this speed and this grid at this point."""
    if speed is None:
        return
    require_instance("speed", speed, SpeedHistory, "a SpeedHistory(T, values)")
    speed.require_point("speed", point)
    if speed(0.0) == 0.0:
        allowed = "a speed other than 0: at standstill no film is steady; begin rolling, then stop"
        raise InputError("speed.values[0]", 0.0, allowed)
    if speed.reverses and grid.domain is not None and grid.domain.x_out != -grid.domain.x_in:
        allowed = f"{-grid.domain.x_in!r}, as far behind the contact as ahead of it, where the surfaces roll back"
        raise InputError("grid.domain.x_out", grid.domain.x_out, allowed)
