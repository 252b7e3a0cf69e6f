"""Static equilibrium of a rotor on its supports, films as at a speed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.bearing.equilibrium import GUESS, OPEN
from reduced_models.bearing.equilibrium import equilibrium as solve
from reduced_models.bearing.freedoms import FIVE, PLANAR
from reduced_models.bearing.ring import RingEquilibrium, equilibrium_at, grow_gyroscopic
from reduced_models.bearing.ring_statics import require_in_grooves, static_ring
from reduced_models.rotor.contact_protocol import has_tangents
from reduced_models.rotor.nodes import LENGTHS
from reduced_models.rotor.squeeze_film_damper import CONTACT
from reduced_models.rotor.supports import (
    BearingMount,
    ContactMount,
    Mount,
    bearing_names,
    is_ball_bearing,
    is_damper,
    support_columns,
    support_rows,
)

_Floats = NDArray[np.float64]

NOT_HELD = "one that presses balls in all directions: more preload, or a bearing of the other facing, holds it"
NO_FILM = "one with a stiffness, or a housing on springs: a squeeze film carries no static force"
HELD = 1e-12  # smallest stiffness of a rotor over its largest, beam included: below is rounding


class StaticSupport(Protocol):
    """A support in static equilibrium: force and its derivative over its motion."""

    def force(self, r: _Floats) -> _Floats:
        """Force that it carries, shape (directions,) [N]."""

    def tangent(self, r: _Floats) -> _Floats:
        """Its derivative, shape (directions, directions) [N/m]."""


class StaticContact:
    """A contact in static equilibrium, or several alike, after its static law; its state stays."""

    def __init__(self, mount: ContactMount) -> None:
        if not has_tangents(mount.contact):
            allowed = "reduced elements, or start from rotor.rest_at(approaches)"
            raise InputError("contacts", "without static law", allowed)
        self._contact, self._offset, self._count = mount.contact, mount.offset, mount.count

    def force(self, r: _Floats) -> _Floats:
        """Force that the contacts carry, shape (1,) [N]."""
        return np.array([self._count * self._contact.spring(float(r[0]) + self._offset)])

    def tangent(self, r: _Floats) -> _Floats:
        """Its derivative, shape (1, 1) [N/m]."""
        return np.array([[self._count * self._contact.spring_tangent(float(r[0]) + self._offset)]])


class StaticBearing:
    """A ball bearing of n directions in static equilibrium."""

    def __init__(self, mount: BearingMount, speed_rpm: float, name: str) -> None:
        bearing, self._name = mount.ball_bearing, name
        self.bearing, self._shift, self.speed = bearing, mount.shift, bearing.speed(speed_rpm)
        self.ring = static_ring(bearing, self.speed, mount.cage_angle, len(mount.directions))

    def press(self, r: _Floats) -> None:
        """Balance all balls under this motion of the ring."""
        self.ring.press(r + self._shift)

    def force(self, r: _Floats) -> _Floats:
        """Forces and moments that the bearing carries, shape (n,) [N], [N m]."""
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
        return float(self.ring.describe()[0]["approach"][:, 0].max())

    def require_bearable(self, r: _Floats) -> None:
        """Raise `InputError` where a ball leaves its groove or carries more than the atlas has."""
        load, balls = self.force(r), self.ring.describe()[0]
        shown = np.array([float(f"{component:.4g}") for component in load])
        try:
            require_in_grooves(self.bearing, balls, shown, self.speed)
        except InputError as error:
            other = "; or change its facing" if self.bearing.contact_angle is not None else ""
            raise InputError(f"{error.field} of {self._name}", error.value, error.allowed + other) from None


class StaticDamper:
    """A squeeze film damper in static equilibrium: its spring alone."""

    def __init__(self, mount: BearingMount, name: str) -> None:
        self._damper, self.name = mount.damper, name

    @property
    def is_bare(self) -> bool:
        """Whether it has no spring."""
        return self._damper.stiffness == 0.0

    def force(self, r: _Floats) -> _Floats:
        """Force that it carries, shape (2,) [N]."""
        return np.asarray(self._damper.stiffness * r)

    def tangent(self, r: _Floats) -> _Floats:
        """Its derivative, shape (2, 2) [N/m]."""
        return self._damper.stiffness * np.eye(r.size)

    def require_clear(self, r: _Floats) -> None:
        """Raise `InputError` where the journal rests on its housing."""
        ratio = float(self._damper.eccentricity(r))
        if ratio >= 1.0:
            allowed = "one that leaves it clear: a stiffer spring, or a larger clearance"
            raise InputError("load", f"under which the journal of {self.name} {CONTACT.format(ratio)}", allowed)


def static_supports(mounts: Sequence[Mount], speed_rpm: float) -> list[tuple[slice, StaticSupport]]:
    """Every support that is not linear, with its place among the directions of all supports.

    Raises
    ------
    InputError
        A speed that a bearing does not take, a contact without static law.
    """
    supports: list[tuple[slice, StaticSupport]] = []
    names = iter(bearing_names(mounts))
    for columns, mount in zip(support_columns(mounts), mounts, strict=True):
        if isinstance(mount, ContactMount):
            supports.append((columns, StaticContact(mount)))
            continue
        name = next(names)
        if is_ball_bearing(mount):
            supports.append((columns, StaticBearing(mount, speed_rpm, name)))
        elif is_damper(mount):
            supports.append((columns, StaticDamper(mount, name)))
    return supports


def equilibrium(mounts: Sequence[Mount], load: _Floats, stiffness: _Floats, speed_rpm: float) -> _Floats:
    """Displacements, shape (N,), at which supports and stiffness carry the load: see `Rotor.equilibrium`."""
    static = StaticRotor(mounts, load, stiffness, speed_rpm)
    static.require_springs()
    try:
        q, share = static.search()
    except ConvergenceError as error:
        if static.mounted and (unsupported := static.unsupported(error.result)):
            raise InputError("load", f"not held by {unsupported}", NOT_HELD) from error
        raise
    if share < 1.0:
        allowed = "those at which friction holds the gyroscopic moment of all balls under this load"
        raise InputError("speed_rpm", speed_rpm, f"{allowed} (found to {share:.2g} of it)")
    for columns, support in static.mounted:
        if columns.stop - columns.start == len(FIVE):  # runs on others begin beyond the atlas too, and warn of it
            support.require_bearable(static.rows[columns] @ q)
    for columns, own in static.supports:
        if isinstance(own, StaticDamper):
            own.require_clear(static.rows[columns] @ q)
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
        self.mounted = [
            (columns, support) for columns, support in self.supports if isinstance(support, StaticBearing)
        ]
        self._mounts, self._stiffness, self._load = mounts, stiffness, load
        self._held = np.zeros(load.size)
        for place, displacement in (held or {}).items():
            self._held[place] = displacement
        self.free = np.setdiff1d(np.arange(load.size), list(held or {}))
        self._both_ways = _across(mounts, load.size)  # springs in both directions where a rotor stands on contacts
        self.pressed = 0.0  # forces of supports and stiffness, beside which the load may be small [N]

    def search(self) -> tuple[_Floats, float]:
        """Displacements in equilibrium, shape (N,), and the share of the gyroscopic moments that they are for.

        Raises
        ------
        ConvergenceError
            None was found; ``result`` is the last displacement.
        """
        if not self.mounted:
            return self._solve(None), 1.0
        return grow_gyroscopic([support.ring for _, support in self.mounted], self._solve)

    def carried(self, q: _Floats) -> _Floats:
        """Forces that supports and stiffness carry at `q`, shape (N,): the load, and reactions of what is held."""
        return self._imbalance(q) + self._load

    def slopes(self, q: _Floats) -> _Floats:
        """Derivative of `carried`, shape (N, N)."""
        return self._slopes(q, 0.0)

    def bearings(self, q: _Floats) -> list[RingEquilibrium]:
        """Ball bearings at `q`, each in its own frame."""
        return [support.at(self.rows[columns] @ q) for columns, support in self.mounted]

    def _solve(self, first: _Floats | None) -> _Floats:
        """Displacements in equilibrium, searched from `first` or from springs in place of the supports."""
        q = self._first() if first is None else first
        size = float(np.linalg.norm(self._load[self.free]))
        return self._displaced(solve(self, q[self.free], size))

    def imbalance(self, moved: _Floats) -> _Floats:
        """Forces on what moves at its displacements, shape (free,), less the load."""
        return self._imbalance(self._displaced(moved))[self.free]

    def tangent(self, moved: _Floats) -> _Floats:
        """Derivative of these forces, shape (free, free)."""
        return self._slopes(self._displaced(moved), OPEN)[np.ix_(self.free, self.free)]

    def too_long(self, step: _Floats) -> float:
        """At least 1: how many times further than balls follow a step moves a ring."""
        moves = self.rows[:, self.free] @ step
        lengths = [
            float(np.abs(moves[columns])[: len(LENGTHS)].max()) / support.ring.longest
            for columns, support in self.mounted
        ]
        return max([*lengths, 1.0])

    def _displaced(self, moved: _Floats) -> _Floats:
        """All displacements, shape (N,), from those of what moves."""
        q = self._held.copy()
        q[self.free] = moved
        return q

    def require_springs(self) -> None:
        """Raise `InputError` where a load moves what a damper without a spring, and nothing else, would hold."""
        bare = [(at, one) for at, one in self.supports if isinstance(one, StaticDamper) and one.is_bare]
        if not bare:
            return
        largest = float(np.abs(self._stiffness).max()) or 1.0
        holds = self._stiffness / largest + self._both_ways
        for columns in (at for at, one in self.supports if (at, one) not in bare):
            holds = holds + self.rows[columns].T @ self.rows[columns]
        values, vectors = np.linalg.eigh(0.5 * (holds + holds.T))
        for free in vectors.T[values <= HELD * values[-1]]:
            if abs(free @ self._load) <= HELD * np.linalg.norm(self._load):
                continue
            moved = [(one.name, np.abs(self.rows[at] @ free)) for at, one in bare]
            name, along = max(moved, key=lambda one: float(one[1].max()))
            if along.max() > 0.0:
                raise InputError("load", f"not held by {name} in {PLANAR[int(np.argmax(along))]}", NO_FILM)

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
        moved = np.linalg.solve(springs[np.ix_(free, free)], right[free])
        return self._displaced(moved / self.too_long(moved))

    def _imbalance(self, q: _Floats) -> _Floats:
        r, forces = self.rows @ q, np.zeros(len(self.rows))
        for columns, support in self.supports:
            forces[columns] = support.force(r[columns])
        bent = self._stiffness @ q
        self.pressed = float(np.linalg.norm(forces) + np.linalg.norm(np.abs(self._stiffness) @ np.abs(q)))
        return np.asarray(bent + self.rows.T @ forces - self._load)

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
            places = [place for place in mount.ends[0] if place is not None]
            held[places, places] = 1.0
    return held
