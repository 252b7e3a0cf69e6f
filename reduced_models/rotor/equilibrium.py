"""Static equilibrium of a rotor on its supports, films as at a speed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.bearing.angular_balls import APPROACH, AngularBalls
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.ring import RingEquilibrium, equilibrium_at, grow_gyroscopic
from reduced_models.rotor.nodes import LENGTHS
from reduced_models.rotor.scaled_contact import has_tangents
from reduced_models.rotor.supports import (
    BearingMount,
    ContactMount,
    Mount,
    bearing_names,
    is_ball_bearing,
    support_columns,
    support_rows,
)

_Floats = NDArray[np.float64]

GUESS = 1e8  # N/m, springs in place of the supports from which the search starts
OPEN = 1.0  # N/m, beside the slopes of a support that is open in some direction
BALANCED = 1e-12  # imbalance over the load that ends the search
BY_ROUNDING = 1e-9  # imbalance over the load that is accepted where steps no longer help
ROUGHLY = 0.1  # of the forces along a step, that are left at the end of a search along it
NOT_HELD = "one that presses balls in all directions: more preload, or a bearing of the other facing, holds it"
HELD = 1e-12  # smallest stiffness of a rotor over its largest, beam included: below is rounding
MOST_STEPS, MOST_HALVINGS = 60, 30  # of the search
_NOTHING: tuple[AngularBalls | None, _Floats] = (
    None,
    np.empty(0),
)  # balls with their inertia, and motion of the ring


class StaticSupport(Protocol):
    """A support in static equilibrium: force and its derivative over its motion."""

    def force(self, r: _Floats) -> _Floats:
        """What it carries, shape (directions,) [N]."""

    def tangent(self, r: _Floats) -> _Floats:
        """Its derivative, shape (directions, directions) [N/m]."""


class StaticContact:
    """A contact in static equilibrium, or several alike, after its static law; its state stays."""

    def __init__(self, mount: ContactMount) -> None:
        if not has_tangents(mount.contact):
            allowed = "reduced elements, or start from rotor.state_at(approaches)"
            raise InputError("contacts", "without static law", allowed)
        self._contact, self._offset, self._count = mount.contact, mount.offset, mount.count

    def force(self, r: _Floats) -> _Floats:
        """What it carries, shape (1,) [N]."""
        return np.array([self._count * self._contact.spring(float(r[0]) + self._offset)])

    def tangent(self, r: _Floats) -> _Floats:
        """Its derivative, shape (1, 1) [N/m]."""
        return np.array([[self._count * self._contact.spring_tangent(float(r[0]) + self._offset)]])


class StaticAngularBalls:
    """A ball bearing of n directions in static equilibrium."""

    def __init__(self, mount: BearingMount, speed_rpm: float, name: str) -> None:
        bearing, self._name = mount.ball_bearing, name
        self.bearing, self._shift, self.speed = bearing, mount.shift, bearing.speed(speed_rpm)
        self.ring = bearing._static_ring(self.speed, mount.cage_angle, len(mount.directions))
        self._pressed = _NOTHING

    def press(self, r: _Floats) -> None:
        """Balance all balls under this motion of the ring."""
        balls, motion = self._pressed
        if balls is self.ring.balls and np.array_equal(motion, r):
            return
        self._pressed = _NOTHING  # should a ball find no balance
        self.ring.press(r + self._shift)
        self._pressed = self.ring.balls, r.copy()

    def force(self, r: _Floats) -> _Floats:
        """What it carries, shape (n,) [N], [N m]."""
        self.press(r)
        return self.ring.load.copy()

    def tangent(self, r: _Floats) -> _Floats:
        """Its derivative, shape (n, n)."""
        self.press(r)
        return self.ring.stiffness.copy()

    def at(self, r: _Floats) -> RingEquilibrium:
        """Its balls in equilibrium, in its own frame."""
        self.press(r)
        return equilibrium_at(self.ring, r + self._shift)

    @property
    def closest(self) -> float:
        """Largest approach of a ball to the inner race where it was pressed last [m]."""
        return float(self.ring.places.found[:, APPROACH].max())

    def require_bearable(self, r: _Floats) -> None:
        """Raise `InputError` where a ball leaves its groove or carries more than the atlas has."""
        load, found = self.force(r), self.ring.places.found
        shown = np.array([float(f"{one:.4g}") for one in load])
        try:
            self.bearing._require_in_grooves(found, shown, self.speed)
        except InputError as error:
            other = "; or change its facing" if self.bearing.contact_angle is not None else ""
            raise InputError(f"{error.field} of {self._name}", error.value, error.allowed + other) from None


def static_supports(mounts: Sequence[Mount], speed_rpm: float) -> list[tuple[slice, StaticSupport]]:
    """Every support that is not linear, with its place among the directions of all supports.

    Raises
    ------
    InputError
        A speed that a bearing does not take, a contact without static law.
    """
    found: list[tuple[slice, StaticSupport]] = []
    names = iter(bearing_names(mounts))
    for columns, mount in zip(support_columns(mounts), mounts, strict=True):
        if isinstance(mount, ContactMount):
            found.append((columns, StaticContact(mount)))
            continue
        name = next(names)
        if is_ball_bearing(mount):
            found.append((columns, StaticAngularBalls(mount, speed_rpm, name)))
    return found


def equilibrium(mounts: Sequence[Mount], load: _Floats, stiffness: _Floats, speed_rpm: float) -> _Floats:
    """Displacements, shape (N,), at which supports and stiffness carry the load: see `Rotor.equilibrium`."""
    static = StaticRotor(mounts, load, stiffness, speed_rpm)
    try:
        q, share = static.search()
    except ConvergenceError as error:
        if static.angular and (unsupported := static.unsupported(error.result)):
            raise InputError("load", f"not held by {unsupported}", NOT_HELD) from error
        raise
    if share < 1.0:
        allowed = "those at which friction holds the gyroscopic moment of all balls under this load"
        raise InputError("speed_rpm", speed_rpm, f"{allowed} (found to {share:.2g} of it)")
    for columns, support in static.angular:
        support.require_bearable(static.rows[columns] @ q)
    return q


def require_held(mounts: Sequence[Mount], q: _Floats, stiffness: _Floats, speed_rpm: float) -> None:
    """Raise `InputError` where nothing holds a rotor on bearings with five degrees of freedom at `q`."""
    if any(is_ball_bearing(mount) and len(mount.directions) == len(FIVE) for mount in mounts):
        static = StaticRotor(mounts, np.zeros(q.size), stiffness, speed_rpm)
        if unsupported := static.unsupported(q):
            raise InputError("load", f"without hold at {unsupported}", NOT_HELD)


class StaticRotor:
    """Forces on a rotor in static equilibrium, and the search for their balance.

    Parameters
    ----------
    mounts : sequence of Mount
    load : ndarray, shape (N,)
        Constant forces [N], [N m].
    stiffness : ndarray, shape (N, N)
        Without the supports that are not linear.
    speed_rpm : float
        For films and the inertia of balls.
    held : mapping of int to float, optional
        Degrees of freedom that do not move, and their displacements [m], [rad].
    """

    def __init__(
        self,
        mounts: Sequence[Mount],
        load: _Floats,
        stiffness: _Floats,
        speed_rpm: float,
        held: Mapping[int, float] | None = None,
    ) -> None:
        self.supports, self.rows = static_supports(mounts, speed_rpm), support_rows(mounts, load.size)
        self.angular = [(at, one) for at, one in self.supports if isinstance(one, StaticAngularBalls)]
        self._mounts, self._stiffness, self._load = mounts, stiffness, load
        self._held = np.zeros(load.size)
        for place, displacement in (held or {}).items():
            self._held[place] = displacement
        self.free = np.setdiff1d(np.arange(load.size), list(held or {}))
        self._both_ways = _across(mounts, load.size)  # springs in both directions where a rotor stands on contacts
        self._carried = 0.0  # forces of preloaded bearings, beside which the load may be small

    def search(self) -> tuple[_Floats, float]:
        """Displacements in equilibrium, shape (N,), and the share of the gyroscopic moments that they are for.

        Raises
        ------
        ConvergenceError
            None was found; ``result`` is the last displacement.
        """
        if not self.angular:
            return self._solve(None), 1.0
        return grow_gyroscopic([support.ring for _, support in self.angular], self._solve)

    def carried(self, q: _Floats) -> _Floats:
        """Forces that supports and stiffness carry at `q`, shape (N,): the load, and reactions of what is held."""
        return self._imbalance(q) + self._load

    def slopes(self, q: _Floats) -> _Floats:
        """Derivative of `carried`, shape (N, N)."""
        return self._slopes(q, 0.0)

    def bearings(self, q: _Floats) -> list[RingEquilibrium]:
        """Ball bearings at `q`, each in its own frame."""
        return [support.at(self.rows[columns] @ q) for columns, support in self.angular]

    def _solve(self, first: _Floats | None) -> _Floats:
        """Displacements in equilibrium, searched from `first` or from springs in place of the supports."""
        q = self._first() if first is None else first
        residual, size = self._imbalance(q), float(np.linalg.norm(self._load[self.free]))
        for _ in range(MOST_STEPS):
            scale, error = max(size, self._carried, 1.0), self._error(residual)
            if error <= BALANCED * scale:
                return q
            step = self._newton_step(q, residual)
            if error <= BY_ROUNDING * scale:  # whole steps, while they help
                new = self._imbalance(q + step)
                if not self._error(new) < 0.5 * error:
                    return q
                q, residual = q + step, new
            elif self.angular:
                q, residual = self._along(q, residual, step)
            else:
                for _ in range(MOST_HALVINGS):
                    new = self._imbalance(q + step)
                    if self._error(new) < error:
                        break
                    step *= 0.5
                q, residual = q + step, new
        raise ConvergenceError(
            f"no equilibrium: the supports do not hold {self._error(residual):.3g} N of {size:.3g} N", q
        )

    def _error(self, imbalance: _Floats) -> float:
        """Imbalance of what moves [N]."""
        return float(np.linalg.norm(imbalance[self.free]))

    def _newton_step(self, q: _Floats, residual: _Floats) -> _Floats:
        step, free = np.zeros(q.size), self.free
        step[free] = np.linalg.solve(self._slopes(q, OPEN)[np.ix_(free, free)], -residual[free])
        return step

    def _along(self, q: _Floats, residual: _Floats, step: _Floats) -> tuple[_Floats, _Floats]:
        """Place on the way from `q` along a step, and the imbalance there: where forces along it balance, roughly.

        Springs that only pull (groove centres move apart as a ball is compressed) have a convex potential; at its
        minimum along the step the imbalance may be larger.
        """
        if step @ residual >= 0.0:  # inertia of balls makes slopes unsymmetric
            step = np.zeros(q.size)
            step[self.free] = -(residual / np.diag(self._slopes(q, OPEN)))[self.free]
        step = step / self._too_long(step)
        low, high, t = 0.0, math.inf, 1.0
        error, slope = self._error(residual), abs(float(step @ residual))
        for _ in range(MOST_HALVINGS):
            try:
                new = self._imbalance(q + t * step)
            except ConvergenceError:  # of a ball
                new = np.full(q.size, math.nan)
            along = float(step @ new)
            if self._error(new) < 0.5 * error or abs(along) <= ROUGHLY * slope:
                break
            if along < 0.0:
                low = t
            else:
                high = t
            if low >= 1.0:
                break
            t = 0.5 * (low + high)
        return q + t * step, new

    def unsupported(self, q: _Floats) -> str:
        """Bearing and direction in which nothing holds the rotor at `q`; empty where all is held."""
        slopes = self._slopes(q, 0.0)
        values, vectors = np.linalg.eigh(0.5 * (slopes + slopes.T))
        if values[0] > HELD * values[-1]:
            return ""
        moved = np.abs(self.rows @ vectors[:, 0])
        bearings = [mount for mount in self._mounts if isinstance(mount, BearingMount)]
        names = [
            f"{name} in {direction}"
            for name, mount in zip(bearing_names(bearings), bearings, strict=True)
            for direction in mount.directions
        ]
        return names[int(np.argmax(moved[-len(names) :]))]

    def _first(self) -> _Floats:
        """Displacements on springs in place of the supports."""
        rows, mounts, free = self.rows, self._mounts, self.free
        shifts = [mount.shift if isinstance(mount, BearingMount) else [mount.offset] for mount in mounts]
        springs = self._stiffness + GUESS * (rows.T @ rows) + GUESS * self._both_ways
        right = self._load - GUESS * rows.T @ np.concatenate(shifts) - springs @ self._held
        moved = np.zeros(right.size)
        moved[free] = np.linalg.solve(springs[np.ix_(free, free)], right[free])
        return np.asarray(self._held + moved / self._too_long(moved))

    def _too_long(self, step: _Floats) -> float:
        """At least 1: how many times further than balls follow a step moves a ring."""
        lengths = [
            float(np.abs(self.rows[columns] @ step)[: len(LENGTHS)].max()) / support.ring.longest
            for columns, support in self.angular
        ]
        return max([*lengths, 1.0])

    def _imbalance(self, q: _Floats) -> _Floats:
        r, forces = self.rows @ q, np.zeros(len(self.rows))
        for columns, support in self.supports:
            forces[columns] = support.force(r[columns])
        if self.angular:
            self._carried = float(np.linalg.norm(forces))
        return np.asarray(self._stiffness @ q + self.rows.T @ forces - self._load)

    def _slopes(self, q: _Floats, more: float) -> _Floats:
        """Derivative of the imbalance, `more` [N/m] added where supports may be open."""
        rows = self.rows
        r, slopes = rows @ q, np.zeros((len(rows), len(rows)))
        for columns, support in self.supports:
            slopes[columns, columns] = support.tangent(r[columns]) + more * np.eye(columns.stop - columns.start)
        return np.asarray(self._stiffness + rows.T @ slopes @ rows + more * self._both_ways)


def _across(mounts: Sequence[Mount], size: int) -> _Floats:
    """Unit springs at the degrees of freedom of contacts, shape (N, N): a contact alone holds one direction."""
    held = np.zeros((size, size))
    for mount in mounts:
        if isinstance(mount, ContactMount):
            at = [place for place in mount.ends[0] if place is not None]
            held[at, at] = 1.0
    return held
