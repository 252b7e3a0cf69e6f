"""Static equilibrium of a rotor on its supports, films as at a speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.rotor.scaled_contact import has_tangents
from reduced_models.rotor.supports import (
    BearingMount,
    ContactMount,
    Mount,
    is_ball_bearing,
    support_columns,
    support_rows,
)

_Floats = NDArray[np.float64]

GUESS = 1e8  # N/m, springs in place of the supports from which the search starts
OPEN = 1.0  # N/m, beside the slopes of a support that is open in some direction
# Imbalance over the load that ends the search: with balls, which are balanced to first order in 1e-7, and without
BALANCED_BALLS, BALANCED = 1e-10, 1e-12
BY_ROUNDING = 1e-9  # imbalance over the load that is accepted where steps no longer help
MOST_STEPS, MOST_HALVINGS = 60, 30  # of the search


class StaticSupport(Protocol):
    """A support at rest: force and its derivative over its motion."""

    def force(self, r: _Floats) -> _Floats:
        """What it carries, shape (directions,) [N]."""

    def tangent(self, r: _Floats) -> _Floats:
        """Its derivative, shape (directions, directions) [N/m]."""


class StaticContact:
    """A contact at rest, or several alike, after its static law; its state stays."""

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


def static_supports(mounts: Sequence[Mount], speed_rpm: float) -> list[tuple[slice, StaticSupport]]:
    """Every support that is not linear, with its place among the directions of all supports.

    Raises
    ------
    InputError
        A speed that a bearing does not take, a contact without static law.
    """
    found: list[tuple[slice, StaticSupport]] = []
    for columns, mount in zip(support_columns(mounts), mounts, strict=True):
        if isinstance(mount, ContactMount):
            found.append((columns, StaticContact(mount)))
        elif is_ball_bearing(mount):
            bearing = mount.ball_bearing
            found.append((columns, bearing._static_balls(bearing.speed(speed_rpm), mount.cage_angle)))
    return found


def equilibrium(mounts: Sequence[Mount], load: _Floats, stiffness: _Floats, speed_rpm: float) -> _Floats:
    """Displacements, shape (N,), at which supports and stiffness carry the load: see `Rotor.equilibrium`."""
    supports, rows = static_supports(mounts, speed_rpm), support_rows(mounts, load.size)

    def imbalance(q: _Floats) -> _Floats:
        r, forces = rows @ q, np.zeros(len(rows))
        for columns, support in supports:
            forces[columns] = support.force(r[columns])
        return np.asarray(stiffness @ q + rows.T @ forces - load)

    allowed = BALANCED_BALLS if any(isinstance(mount, BearingMount) for mount in mounts) else BALANCED
    loose = _across(mounts, load.size)  # springs in both directions where a rotor stands on contacts
    offsets = np.array([getattr(mount, "offset", 0.0) for mount in mounts for _ in mount.directions])
    springs = stiffness + GUESS * (rows.T @ rows) + GUESS * loose
    q: _Floats = np.asarray(np.linalg.solve(springs, load - GUESS * rows.T @ offsets), np.float64)
    residual, size = imbalance(q), float(np.linalg.norm(load))
    for _ in range(MOST_STEPS):
        if np.linalg.norm(residual) <= allowed * max(size, 1.0):
            return q
        r, slopes = rows @ q, np.zeros((len(rows), len(rows)))
        for columns, support in supports:
            slopes[columns, columns] = support.tangent(r[columns]) + OPEN * np.eye(columns.stop - columns.start)
        step = np.linalg.solve(stiffness + rows.T @ slopes @ rows + OPEN * loose, -residual)
        for _ in range(MOST_HALVINGS):
            new = imbalance(q + step)
            if np.linalg.norm(new) < np.linalg.norm(residual):
                break
            step *= 0.5
        else:
            if np.linalg.norm(residual) <= BY_ROUNDING * max(size, 1.0):
                return q
        q, residual = q + step, imbalance(q + step)
    raise ConvergenceError(
        f"no equilibrium: the supports do not hold {np.linalg.norm(residual):.3g} N of {size:.3g} N", q
    )


def _across(mounts: Sequence[Mount], size: int) -> _Floats:
    """Unit springs at the degrees of freedom of contacts, shape (N, N): a contact alone holds one direction."""
    held = np.zeros((size, size))
    for mount in mounts:
        if isinstance(mount, ContactMount):
            at = [place for place in mount.ends[0] if place is not None]
            held[at, at] = 1.0
    return held
