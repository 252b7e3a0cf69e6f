"""Static equilibrium of a rotor on its supports, films as at a speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.bearing.five_degrees import grow_gyroscopic
from reduced_models.bearing.freedoms import FIVE
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
# Imbalance over the load that ends the search: with balls, which are balanced to first order in 1e-7, and without
BALANCED_BALLS, BALANCED = 1e-10, 1e-12
ROUGHLY = 0.1  # of the forces along a step, that are left at the end of a search along it
BY_ROUNDING = 1e-9  # imbalance over the load that is accepted where steps no longer help
NOT_HELD = "one that presses balls in all directions: more preload, or a bearing of the other facing, holds it"
HELD = 1e-12  # smallest stiffness of a rotor over its largest, beam included: below is rounding
MOST_STEPS, MOST_HALVINGS = 60, 30  # of the search


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
    """A ball bearing with five degrees of freedom in static equilibrium."""

    def __init__(self, mount: BearingMount, speed_rpm: float, name: str) -> None:
        bearing, self._name = mount.ball_bearing, name
        self.bearing, self._shift, self.speed = bearing, mount.shift, bearing.speed(speed_rpm)
        self.ring = bearing._static_ring(self.speed, mount.cage_angle, len(mount.directions))

    def force(self, r: _Floats) -> _Floats:
        """What it carries, shape (5,) [N], [N m]."""
        self.ring.press(r + self._shift)
        return self.ring.load.copy()

    def tangent(self, r: _Floats) -> _Floats:
        """Its derivative, shape (5, 5)."""
        self.ring.press(r + self._shift)
        return self.ring.stiffness.copy()

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
        if not is_ball_bearing(mount):
            continue
        elif mount.z is not None:
            found.append((columns, StaticAngularBalls(mount, speed_rpm, name)))
        else:
            bearing = mount.ball_bearing
            found.append((columns, bearing._static_balls(bearing.speed(speed_rpm), mount.cage_angle)))
    return found


def equilibrium(mounts: Sequence[Mount], load: _Floats, stiffness: _Floats, speed_rpm: float) -> _Floats:
    """Displacements, shape (N,), at which supports and stiffness carry the load: see `Rotor.equilibrium`."""
    supports, rows = static_supports(mounts, speed_rpm), support_rows(mounts, load.size)
    balance = _Balance(mounts, supports, rows, stiffness, load)
    angular = [(columns, one) for columns, one in supports if isinstance(one, StaticAngularBalls)]
    if not angular:
        return balance.solve(None)
    try:
        q, share = grow_gyroscopic([one.ring for _, one in angular], balance.solve)
    except ConvergenceError as error:
        if unsupported := balance.unsupported(error.result):
            raise InputError("load", f"not held by {unsupported}", NOT_HELD) from error
        raise
    if share < 1.0:
        allowed = "those at which friction holds the gyroscopic moment of all balls under this load"
        raise InputError("speed_rpm", speed_rpm, f"{allowed} (found to {share:.2g} of it)")
    for columns, one in angular:
        one.require_bearable(rows[columns] @ q)
    return q


def require_held(mounts: Sequence[Mount], q: _Floats, stiffness: _Floats, speed_rpm: float) -> None:
    """Raise `InputError` where nothing holds a rotor on bearings with five degrees of freedom at `q`."""
    if any(is_ball_bearing(mount) and len(mount.directions) == len(FIVE) for mount in mounts):
        supports = static_supports(mounts, speed_rpm)
        balance = _Balance(mounts, supports, support_rows(mounts, q.size), stiffness, np.zeros(q.size))
        if unsupported := balance.unsupported(q):
            raise InputError("load", f"without hold at {unsupported}", NOT_HELD)


class _Balance:
    """Forces on a rotor in static equilibrium, and the search for their balance."""

    def __init__(
        self,
        mounts: Sequence[Mount],
        supports: Sequence[tuple[slice, StaticSupport]],
        rows: _Floats,
        stiffness: _Floats,
        load: _Floats,
    ) -> None:
        self._mounts, self._supports, self._rows = mounts, supports, rows
        self._stiffness, self._load = stiffness, load
        self._allowed = BALANCED_BALLS if any(isinstance(mount, BearingMount) for mount in mounts) else BALANCED
        self._both_ways = _across(mounts, load.size)  # springs in both directions where a rotor stands on contacts
        self._rings = [(at, one.ring) for at, one in supports if isinstance(one, StaticAngularBalls)]
        self._carried = 0.0  # forces of preloaded bearings, beside which the load may be small

    def solve(self, first: _Floats | None) -> _Floats:
        """Displacements in equilibrium, searched from `first` or from springs in place of the supports.

        Raises
        ------
        ConvergenceError
            None was found; ``result`` is the last displacement.
        """
        q = self._first() if first is None else first
        residual, size = self._imbalance(q), float(np.linalg.norm(self._load))
        for _ in range(MOST_STEPS):
            scale = max(size, self._carried, 1.0)
            if np.linalg.norm(residual) <= self._allowed * scale:
                return q
            step: _Floats = np.asarray(np.linalg.solve(self._slopes(q, OPEN), -residual), np.float64)
            if self._rings:
                q, residual = self._along(q, residual, step)
                continue
            for _ in range(MOST_HALVINGS):
                new = self._imbalance(q + step)
                if np.linalg.norm(new) < np.linalg.norm(residual):
                    break
                step *= 0.5
            else:
                if np.linalg.norm(residual) <= BY_ROUNDING * scale:
                    return q
            q, residual = q + step, self._imbalance(q + step)
        raise ConvergenceError(
            f"no equilibrium: the supports do not hold {np.linalg.norm(residual):.3g} N of {size:.3g} N", q
        )

    def _along(self, q: _Floats, residual: _Floats, step: _Floats) -> tuple[_Floats, _Floats]:
        """Place on the way from `q` along a step, and the imbalance there: where forces along it balance, roughly.

        Springs that only pull (groove centres move apart as a ball is compressed) have a convex potential; at its
        minimum along the step the imbalance may be larger.
        """
        if step @ residual >= 0.0:  # inertia of balls makes slopes unsymmetric
            step = -residual / np.diag(self._slopes(q, OPEN))
        longest = [np.abs(self._rows[at] @ step)[:3].max() / ring.longest for at, ring in self._rings]
        step = step / max(*longest, 1.0)
        low, high, t = 0.0, math.inf, 1.0
        error, slope = float(np.linalg.norm(residual)), abs(float(step @ residual))
        for _ in range(MOST_HALVINGS):
            try:
                new = self._imbalance(q + t * step)
            except ConvergenceError:  # of a ball
                new = np.full(q.size, math.nan)
            along = float(step @ new)
            if np.linalg.norm(new) < 0.5 * error or abs(along) <= ROUGHLY * slope:
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
        moved = np.abs(self._rows @ vectors[:, 0])
        bearings = [mount for mount in self._mounts if isinstance(mount, BearingMount)]
        names = [
            f"{name} in {direction}"
            for name, mount in zip(bearing_names(bearings), bearings, strict=True)
            for direction in mount.directions
        ]
        return names[int(np.argmax(moved[-len(names) :]))]

    def _first(self) -> _Floats:
        rows, mounts = self._rows, self._mounts
        shifts = [mount.shift if isinstance(mount, BearingMount) else [mount.offset] for mount in mounts]
        springs = self._stiffness + GUESS * (rows.T @ rows) + GUESS * self._both_ways
        right = self._load - GUESS * rows.T @ np.concatenate(shifts)
        return np.asarray(np.linalg.solve(springs, right), np.float64)

    def _imbalance(self, q: _Floats) -> _Floats:
        r, forces = self._rows @ q, np.zeros(len(self._rows))
        for columns, support in self._supports:
            forces[columns] = support.force(r[columns])
        if self._rings:
            self._carried = float(np.linalg.norm(forces))
        return np.asarray(self._stiffness @ q + self._rows.T @ forces - self._load)

    def _slopes(self, q: _Floats, more: float) -> _Floats:
        """Derivative of the imbalance, `more` [N/m] added where supports may be open."""
        rows = self._rows
        r, slopes = rows @ q, np.zeros((len(rows), len(rows)))
        for columns, support in self._supports:
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
