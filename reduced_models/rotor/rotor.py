"""Any linear rotor on ball bearings: its matrices, where the bearings sit, what loads it.

    M q'' + (C + omega G) q' + K q + B^T F(B q, B q') = load + unbalance

Where the matrices come from does not matter: own beams, ROSS, a reduction that keeps the nodes of the bearings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import (
    as_column,
    as_rows,
    require_finite,
    require_instance,
    require_integer,
)
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.summary import Summary
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.equilibrium import StaticBalls

_Floats = NDArray[np.float64]

GUESS = 1e8  # N/m, springs in place of the bearings from which the search for the equilibrium starts
SUPPORT = 1.0  # N/m, beside the slopes of a bearing that is open in some direction
BALANCED = 1e-10  # imbalance over the load that ends it
MOST_STEPS, MOST_HALVINGS = 60, 30  # of that search


@fields_take(cage_angle="rad")
@dataclass(frozen=True, kw_only=True)
class BearingMount(Summary):
    """A bearing between two degrees of freedom of the shaft and the ground, or those of a housing.

    Parameters
    ----------
    bearing : BallBearing
    x, y : int
        Degrees of freedom of the shaft.
    housing : (int, int), optional
        Those of the housing, which the outer ring moves with.
    cage_angle : float
        Of the first ball at the start [rad].
    """

    bearing: BallBearing
    x: int
    y: int
    housing: tuple[int, int] | None = None
    cage_angle: float = -pi / 2.0

    def _summary_lines(self) -> list[str]:
        on = "the ground" if self.housing is None else f"a housing at {self.housing[0]}, {self.housing[1]}"
        return [f"{self.bearing.name or 'ball bearing'} at degrees of freedom {self.x}, {self.y}, on {on}"]

    def __post_init__(self) -> None:
        require_instance("bearing", self.bearing, BallBearing, "a BallBearing")
        if abs(require_finite("cage_angle", self.cage_angle)) > 2.0 * pi:
            raise InputError("cage_angle", self.cage_angle, "between -2 pi and 2 pi; angles are in radians")


class _Names(dict[str, tuple[int, int]]):
    """Degrees of freedom by name; a name that is not there is told with those that are."""

    def __missing__(self, name: object) -> tuple[int, int]:
        raise InputError("node", name, f"one of {', '.join(self)}" if self else "none: the rotor has no names")


@fields_take(amount="kg m", phase="rad")
@dataclass(frozen=True, kw_only=True)
class Unbalance:
    """Mass times eccentricity [kg m] at two degrees of freedom; `phase` [rad] ahead of the shaft's angle.

    Parameters
    ----------
    x, y : int
        The two degrees of freedom, across the shaft.
    amount : float
        Mass times eccentricity [kg m].
    phase : float
        Ahead of the angle of the shaft [rad].
    """

    x: int
    y: int
    amount: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        require_finite("amount", self.amount)
        if abs(require_finite("phase", self.phase)) > 2.0 * pi:
            raise InputError("phase", self.phase, "between -2 pi and 2 pi; angles are in radians")


@dataclass(frozen=True, kw_only=True, eq=False)
class Rotor(Summary):
    """A linear rotor on ball bearings, SI units.

    Parameters
    ----------
    mass, stiffness : array_like, shape (N, N)
        Without the bearings; the stiffness may leave the rotor free.
    damping, gyroscopic : array_like, shape (N, N), optional
        The damping force is ``(damping + omega gyroscopic) q'`` at the speed omega [rad/s].
    mounts : tuple of BearingMount
    load : array_like, shape (N,), optional
        Constant forces [N], weight for one.
    unbalances : tuple of Unbalance
    nodes : mapping of str to (int, int), optional
        Names for degrees of freedom x, y, as "disc".

    Raises
    ------
    InputError
        Matrices that do not fit together, or a degree of freedom that is not there or taken.
    """

    mass: _Floats
    stiffness: _Floats
    mounts: tuple[BearingMount, ...]
    damping: _Floats = None  # type: ignore[assignment]
    gyroscopic: _Floats = None  # type: ignore[assignment]
    load: _Floats = None  # type: ignore[assignment]
    unbalances: tuple[Unbalance, ...] = ()
    nodes: Mapping[str, tuple[int, int]] = field(default_factory=dict)

    def _summary_lines(self) -> list[str]:
        bearings = ", ".join(mount.bearing.name or "ball bearing" for mount in self.mounts)
        amounts = ", ".join(f"{1e6 * abs(unbalance.amount):.4g}" for unbalance in self.unbalances)
        return [
            f"{len(self.mass)} degrees of freedom on {len(self.mounts)} bearings: {bearings}",
            f"nodes {', '.join(self.nodes)}" if self.nodes else "nodes without names",
            f"unbalances {amounts} g mm" if amounts else "no unbalance",
        ]

    def __post_init__(self) -> None:
        size = len(np.atleast_1d(np.asarray(self.mass, float)))
        for name in ("mass", "stiffness", "damping", "gyroscopic"):
            given = getattr(self, name)
            matrix = as_rows(name, np.zeros((size, size)) if given is None else given, size, size)
            object.__setattr__(self, name, matrix)
            if matrix.shape != (size, size):
                raise InputError(f"shape of {name}", matrix.shape, f"({size}, {size}), as that of mass")
        if np.linalg.eigvalsh(0.5 * (self.mass + self.mass.T)).min() <= 0.0:
            raise InputError(
                "mass", "a matrix that is not positive definite", "one with inertia in every direction"
            )
        load = as_column("load", np.zeros(size) if self.load is None else self.load, size=size)
        object.__setattr__(self, "load", load)
        object.__setattr__(self, "mounts", tuple(self.mounts))
        object.__setattr__(self, "unbalances", tuple(self.unbalances))
        if not self.mounts:
            raise InputError("mounts", (), "at least one BearingMount")
        taken: list[tuple[int, int]] = []
        for i, mount in enumerate(self.mounts):
            require_instance(f"mounts[{i}]", mount, BearingMount, "a BearingMount")
            ends = [(mount.x, mount.y), *([mount.housing] if mount.housing is not None else [])]
            for x, y in ends:
                self._require_there(f"mounts[{i}]", (x, y))
            if ends[0] in taken:
                raise InputError(f"mounts[{i}]", ends[0], "at degrees of freedom that no other bearing has")
            taken.append(ends[0])
        for i, unbalance in enumerate(self.unbalances):
            self._require_there(f"unbalances[{i}]", (unbalance.x, unbalance.y))
        object.__setattr__(
            self, "nodes", MappingProxyType(_Names((k, (at[0], at[1])) for k, at in self.nodes.items()))
        )
        for name, pair in self.nodes.items():
            self._require_there(f"nodes[{name!r}]", pair)

    def _require_there(self, field: str, pair: Any) -> None:
        allowed = f"two different degrees of freedom from 0 to {self.size - 1}"
        for value in pair:
            if require_integer(field, value, allowed, 0) >= self.size:
                raise InputError(field, pair, allowed)
        if pair[0] == pair[1]:
            raise InputError(field, pair, allowed)

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return len(self.mass)

    @property
    def rings(self) -> _Floats:
        """Displacements of the inner rings against the outer ones from those of the rotor, (2 bearings, N)."""
        rows = np.zeros((2 * len(self.mounts), self.size))
        for b, mount in enumerate(self.mounts):
            rows[2 * b, mount.x] = rows[2 * b + 1, mount.y] = 1.0
            if mount.housing is not None:
                rows[2 * b, mount.housing[0]] -= 1.0
                rows[2 * b + 1, mount.housing[1]] -= 1.0
        return rows

    def equilibrium(self, speed_rpm: float = 0.0) -> _Floats:
        """Displacements at rest under the load, films as at a speed, shape (N,) [m].

        Raises
        ------
        InputError
            A speed that a bearing does not take.
        ConvergenceError
            The bearings do not hold it.
        """
        to_rings, load = self.rings, self.load
        held = [
            StaticBalls(
                m.bearing.kernel(m.bearing.speed(speed_rpm)), m.bearing.speed_state(speed_rpm), m.cage_angle
            )
            for m in self.mounts
        ]

        def imbalance(q: _Floats) -> _Floats:
            r = to_rings @ q
            forces = np.concatenate([ring.force(r[2 * b : 2 * b + 2]) for b, ring in enumerate(held)])
            return np.asarray(self.stiffness @ q + to_rings.T @ forces - load)

        springs = self.stiffness + GUESS * to_rings.T @ to_rings
        q: _Floats = np.asarray(np.linalg.solve(springs, load), np.float64)
        residual, size = imbalance(q), float(np.linalg.norm(load))
        for _ in range(MOST_STEPS):
            if np.linalg.norm(residual) <= BALANCED * max(size, 1.0):
                return q
            r, slopes = to_rings @ q, np.zeros((len(to_rings), len(to_rings)))
            for b, ring in enumerate(held):
                at = slice(2 * b, 2 * b + 2)
                slopes[at, at] = ring.tangent(r[at]) + SUPPORT * np.eye(2)
            step = np.linalg.solve(self.stiffness + to_rings.T @ slopes @ to_rings, -residual)
            for _ in range(MOST_HALVINGS):
                new = imbalance(q + step)
                if np.linalg.norm(new) < np.linalg.norm(residual):
                    break
                step *= 0.5
            q, residual = q + step, imbalance(q + step)
        raise ConvergenceError(
            f"no equilibrium: {np.linalg.norm(residual):.3g} N of {size:.3g} N are not carried", q
        )
