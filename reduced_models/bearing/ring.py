"""Inner ring in static equilibrium on its balls, with five degrees of freedom or some of them held.

Displacements of the ring move groove centres linearly. Contacts act as springs between groove centres that only
pull, because the distance of the centres grows as the ball is compressed. At rest, and with centrifugal forces,
their potential is convex (nearly, for the orbits of balls depend on their angles), so that `equilibrium` needs
no first guess. The gyroscopic moment, which has no potential, is added then, in steps.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import cos, degrees, pi

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.hertz import elliptic_integrals, hertz_contact
from ehlcontact.point import Geometry
from reduced_models.bearing.ball import FAR, FREEDOMS, Balls, films_of, ring_map
from reduced_models.bearing.ball_steps import (
    ANGLE,
    AXIS_ANGLE,
    CLOSER,
    ENTRIES,
    LOAD,
    ORBIT,
    OWN_ROTATION,
    SPEED_SUM,
    begin_rest,
    describe_balls,
    press_balls,
)
from reduced_models.bearing.contact_angles import CONTROLS
from reduced_models.bearing.contact_heights import HEIGHT
from reduced_models.bearing.equilibrium import GUESS, OPEN, equilibrium
from reduced_models.bearing.freedoms import FIVE, PLANAR

_Floats = NDArray[np.float64]

SEATED = 1e-9  # least stiffness of a ring over its largest: below is rounding
SMALLEST_SHARE = 0.02  # of the gyroscopic moments by which a search that fails may grow
CARRIES = 1e-3  # force of a ball over the largest, above which it counts as one that carries
STEEPEST = pi / 3.0  # contact angle that the shoulder of no groove reaches


class StaticRing:
    """All balls in equilibrium at one angle of the cage, as `equilibrium` wants contacts.

    There, displacements are lengths and loads forces: tilts are multiplied, moments divided by the radius of the
    circle of inner groove centres. Elsewhere a ring has n = 2 directions where only x and y move, else 5.

    Parameters
    ----------
    balls : Balls
    angle : float
        Of the first ball [rad].
    free : int
        How many of the five degrees of freedom move, in their order.
    held : ndarray, shape (5,)
        Displacement [m], [rad] of those that are held.
    """

    def __init__(self, balls: Balls, angle: float, free: int, held: _Floats) -> None:
        self.balls, self.free, self.held = balls, free, held
        self.size = len(PLANAR) if free == len(PLANAR) else FREEDOMS
        radius = balls.grooves.groove_circle
        self.unit = np.array([1.0, 1.0, 1.0, 1.0 / radius, 1.0 / radius])[
            :free
        ]  # of a displacement, over a length
        self.films = films_of(balls)
        self.longest = FAR * (balls.grooves.inner + balls.grooves.outer)
        n = self.size
        self._whole = np.zeros(FREEDOMS), np.zeros((FREEDOMS, FREEDOMS)), np.zeros((FREEDOMS, FREEDOMS))
        self.load, self.stiffness = self._whole[0][:n], self._whole[1][:n, :n]
        self._still, self._pressed_at = np.zeros(n), np.full(n, np.nan)
        self.angle = angle

    @property
    def angle(self) -> float:
        """Of the first ball [rad]."""
        return float(self.films.cage[0])

    @angle.setter
    def angle(self, angle: float) -> None:
        """Turn the cage."""
        begin_rest(self.balls, self.balls.omega, angle, self.films)
        self.changed()

    @property
    def heights(self) -> _Floats:
        """Of features at both contacts of every ball, shape (balls, 2) [m]; may be written."""
        return self.films.heights[:, HEIGHT].reshape(-1, 2)

    def with_inertia(self, whole: Balls, centrifugal: float, gyroscopic: float) -> None:
        """Balls with a share of the centrifugal forces and of the gyroscopic moments of `whole`.

        Without any gyroscopic moment they run under outer race control.
        """
        g = whole.grooves
        control = g.control if gyroscopic > 0.0 else CONTROLS.index("outer")
        part = g._replace(mass=centrifugal * g.mass, control=control, gyroscopic=gyroscopic * g.gyroscopic)
        self.balls = whole if centrifugal == gyroscopic == 1.0 else whole._replace(grooves=part)
        self.changed()

    def changed(self) -> None:
        """Balls or heights are no longer those with which it was pressed last."""
        self._pressed_at[:] = np.nan

    def carried(self) -> float:
        """Forces of the ring on all balls where it was pressed last, added without their directions [N]."""
        return float(self.films.force[:, 0].sum())

    def displacement(self, q: _Floats) -> _Floats:
        """Displacement, shape (n,) [m], [rad], from a scaled one of the directions that move."""
        full = self.held[: self.size].copy()
        full[: self.free] = q * self.unit
        return full

    def force(self, q: _Floats) -> _Floats:
        """Scaled forces of the ring on the balls, shape (free,) [N]."""
        self._press(q)
        return self.load[: self.free] * self.unit

    def tangent(self, q: _Floats) -> _Floats:
        """Their derivative, shape (free, free) [N/m]."""
        self._press(q)
        return self.stiffness[: self.free, : self.free] * np.outer(self.unit, self.unit)

    def press(self, displacement: _Floats) -> None:
        """Set `load` and `stiffness`, those of the ring at a displacement, shape (n,) [m], [rad].

        Raises
        ------
        ConvergenceError
            A ball finds no balance.
        """
        self._pressed_at[:] = displacement
        press_balls(self.balls, self.films, self._pressed_at, self._still, 0.0, self._whole)
        if not np.isfinite(self.load[0]):
            ball = int(np.flatnonzero(~np.isfinite(self.films.place[:, 0]))[-1])
            where = f"the ring at {displacement.tolist()} (m, rad)"
            raise ConvergenceError(f"ball {ball} finds no balance with {where}", displacement)

    def _press(self, q: _Floats) -> None:
        """Press it at a scaled displacement, unless it was there last."""
        displacement = self.displacement(q)
        if not np.array_equal(displacement, self._pressed_at):
            self.press(displacement)

    def describe(self) -> tuple[_Floats, _Floats]:
        """Quantities of all balls where they were pressed last: `found` and `geometric` of `RingEquilibrium`."""
        found, geometric = np.zeros((self.balls.number, ENTRIES)), np.zeros((self.balls.number, 5, 4))
        describe_balls(self.balls, self.films, found, geometric)
        return found, geometric


@dataclass(frozen=True, eq=False)
class RingEquilibrium:
    """A ring in equilibrium, and its balls."""

    displacement: _Floats  # (n,) [m], [rad]
    load: _Floats  # (n,) [N], [N m], reactions of what is held included
    stiffness: _Floats  # (n, n)
    found: _Floats  # (balls, ENTRIES), see `ball_steps`
    geometric: _Floats  # (balls, 5, 4)
    maps: _Floats  # (balls, 3, n) of `ring_map`

    @property
    def angles(self) -> _Floats:
        """Contact angles, shape (balls, 2) [rad]: columns for inner and outer race, as of all following."""
        return self.found[:, ANGLE : ANGLE + 2]

    @property
    def force(self) -> _Floats:
        """Contact forces [N]."""
        return self.found[:, LOAD : LOAD + 2]

    @property
    def approach(self) -> _Floats:
        """Mutual approaches [m]."""
        return self.found[:, CLOSER : CLOSER + 2]

    @property
    def speed_sum(self) -> _Floats:
        """Sum of both surface speeds over the speed of the shaft [m]."""
        return self.found[:, SPEED_SUM : SPEED_SUM + 2]

    @property
    def orbit(self) -> _Floats:
        """Speed of every ball about the shaft, over that of the shaft, shape (balls,)."""
        return self.found[:, ORBIT]

    @property
    def ball_rotation(self) -> _Floats:
        """Speed of every ball about its own axis, seen from the cage, over that of the shaft, shape (balls,)."""
        return self.found[:, OWN_ROTATION]

    @property
    def spin_to_roll(self) -> _Floats:
        """Relative angular speed of both surfaces about their normal over that of rolling, with its sign."""
        inner, outer = self.angles.T
        axis, rotation, orbit = self.found[:, AXIS_ANGLE], self.ball_rotation, self.orbit
        by_i = (1.0 - orbit) * np.sin(inner) + rotation * np.sin(inner - axis)
        roll_i = (1.0 - orbit) * np.cos(inner) + rotation * np.cos(axis - inner)
        by_o = rotation * np.sin(outer - axis) - orbit * np.sin(outer)
        roll_o = rotation * np.cos(axis - outer) - orbit * np.cos(outer)
        return np.column_stack([by_i / roll_i, by_o / roll_o])


def ring_equilibrium(ring: StaticRing, load: _Floats, first: _Floats | None = None) -> RingEquilibrium:
    """Ring in equilibrium under `load`, shape (2,), (3,) or (5,) [N], [N m].

    Parameters
    ----------
    first : ndarray, shape (n,), optional
        Displacement from which it is searched [m], [rad].

    Raises
    ------
    InputError
        A load that does not seat it.
    ConvergenceError
        No balance was found.
    """
    near = None if first is None else first[: ring.free] / ring.unit
    ring.changed()  # heights may be others
    q = search(ring, load, near)
    require_seated(ring.tangent(q), load, FIVE[: ring.free])
    found = equilibrium_at(ring, ring.displacement(q))
    return replace(found, load=np.append(load, found.load[load.size :]))


def equilibrium_at(ring: StaticRing, displacement: _Floats) -> RingEquilibrium:
    """Balls in equilibrium with the ring held at a displacement, shape (n,) [m], [rad]."""
    ring.press(displacement)
    balls, (found, geometric) = ring.balls, ring.describe()
    maps = np.zeros((balls.number, 3, FREEDOMS))
    for k in range(balls.number):
        ring_map(balls.grooves, ring.angle + 2.0 * pi * k / balls.number, maps[k])
    return RingEquilibrium(
        displacement=displacement,
        load=ring.load.copy(),
        stiffness=ring.stiffness.copy(),
        found=found,
        geometric=geometric,
        maps=maps[..., : ring.size],
    )


def require_seated(stiffness: _Floats, load: _Floats, names: Sequence[str]) -> None:
    """Raise `InputError` where a stiffness leaves one of its degrees of freedom, with these `names`, free."""
    values, vectors = np.linalg.eigh(0.5 * (stiffness + stiffness.T))
    if not values[0] > SEATED * values[-1]:
        free = names[int(np.argmax(np.abs(vectors[:, 0])))]
        allowed = f"one that seats the ring: nothing holds it in {free}; more axial load or preload would"
        if len(names) == len(PLANAR):
            allowed = (
                "one that presses balls on both sides of its direction; or preload the bearing (clearance < 0)"
            )
        raise InputError("load", load.tolist(), allowed)


class _LoadedRing:
    """A ring under a scaled load, as the springs of `equilibrium`."""

    def __init__(self, ring: StaticRing, load: _Floats) -> None:
        self._ring, self._load = ring, load
        self.pressed = 0.0

    def imbalance(self, q: _Floats) -> _Floats:
        """Scaled forces on the balls, less the load, shape (free,) [N]."""
        force = self._ring.force(q)
        self.pressed = self._ring.carried()
        return force - self._load

    def tangent(self, q: _Floats) -> _Floats:
        """Derivative of the forces, shape (free, free) [N/m]."""
        return self._ring.tangent(q) + OPEN * np.eye(q.size)

    def too_long(self, step: _Floats) -> float:
        """At least 1: how many times further than balls follow a step moves the ring."""
        return max(float(np.linalg.norm(step)) / self._ring.longest, 1.0)


def search(ring: StaticRing, load: _Floats, near: _Floats | None = None) -> _Floats:
    """Scaled displacement of a ring under a load, from one that is near if it is given."""
    force = load * ring.unit
    springs, size = _LoadedRing(ring, force), float(np.linalg.norm(force))

    def solve(first: _Floats | None) -> _Floats:
        if first is None:
            first = force / GUESS / springs.too_long(force / GUESS)
        return equilibrium(springs, first, size)

    if near is not None:
        try:
            return solve(near)
        except ConvergenceError:
            pass  # searched from anywhere
    place, share = grow_gyroscopic([ring], solve)
    if share < 1.0:
        allowed = "one under which friction holds the gyroscopic moment of all balls at this speed"
        raise InputError("load", load.tolist(), f"{allowed} (found to {share:.2g} of it)")
    return place


def grow_gyroscopic(
    rings: Sequence[StaticRing], solve: Callable[[_Floats | None], _Floats]
) -> tuple[_Floats, float]:
    """Solve for an equilibrium first without the gyroscopic moments of all balls, then with growing ones.

    Where none is found without them, that of light balls is followed as their centrifugal forces grow.

    Parameters
    ----------
    rings : sequence of StaticRing
        Those that `solve` presses.
    solve : callable
        ``solve(first)`` returns the place of equilibrium, searched from ``first`` or, with None, from anywhere;
        raises `ConvergenceError` where it finds none.

    Returns
    -------
    place : ndarray
    share : float
        Of the gyroscopic moments that it is for: 1 where the search succeeded.
    """
    wholes = [ring.balls for ring in rings]
    planar = all(ring.size == len(PLANAR) for ring in rings)  # contact angles of 0: no gyroscopic moment
    if planar or all(whole.omega == 0.0 for whole in wholes):
        return solve(None), 1.0

    def share(centrifugal: float, gyroscopic: float) -> None:
        for ring, whole in zip(rings, wholes, strict=True):
            ring.with_inertia(whole, centrifugal, gyroscopic)

    share(1.0, 0.0)
    try:
        place = solve(None)
    except ConvergenceError:  # centrifugal forces bend the potential: from light balls to those that there are
        for ring in rings:
            ring.films.place[:] = np.nan
        share(SMALLEST_SHARE, 0.0)
        place, found = _grow(rings, solve, lambda of: share(of, 0.0), solve(None), SMALLEST_SHARE)
        if found < 1.0:
            raise
    return _grow(rings, solve, lambda of: share(1.0, of), place, 0.0)


def _grow(
    rings: Sequence[StaticRing],
    solve: Callable[[_Floats | None], _Floats],
    set_share: Callable[[float], None],
    place: _Floats,
    done: float,
) -> tuple[_Floats, float]:
    """Follow an equilibrium from a share of something to all of it, in steps; returns it and the share reached."""
    step = 1.0
    while done < 1.0:
        tried = min(done + step, 1.0)
        set_share(tried)
        kept = [ring.films.place.copy() for ring in rings]
        try:
            place = solve(place)
        except ConvergenceError:
            step *= 0.5
            for ring, places in zip(rings, kept, strict=True):
                ring.films.place[:], ring.films.follow[:] = places, 0.0
            if step < SMALLEST_SHARE:
                return place, done
        else:
            done = tried
    return place, 1.0


def require_in_groove(found: _Floats, load: _Floats, one_way: bool) -> None:
    """Raise `InputError` where a ball that both rings press leaves its groove.

    `found` has shape (balls, ENTRIES), see `ball_steps`; with `one_way` balls carry at positive contact angles
    only, as of an angular contact bearing.
    """
    inner, outer = found[:, CLOSER], found[:, CLOSER + 1]
    pressed = (inner + outer > 0.0) & (found[:, LOAD] > CARRIES * found[:, LOAD].max())
    for k in np.flatnonzero(pressed).tolist():
        angle = found[k, ANGLE : ANGLE + 2]
        if np.abs(angle).max() > STEEPEST:
            steep = f"{degrees(np.abs(angle).max()):.3g} degrees at ball {k}"
            allowed = f"one whose contact angles stay below {degrees(STEEPEST):.3g} degrees (here {steep})"
            raise InputError("load", load.tolist(), allowed)
        if one_way and angle.min() < 0.0:
            allowed = (
                "one with more axial force in +z: an angular contact bearing carries it in this direction only"
            )
            raise InputError(
                "load", load.tolist(), f"{allowed} (ball {k} runs at {degrees(angle.min()):.3g} degrees)"
            )


def spin_moment_factor(body: Geometry, kn: float) -> float:
    """W of `contact_angles` over the square of the dry approach."""
    hertz = hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced)
    return float(kn ** (4.0 / 3.0) * hertz.b * elliptic_integrals(hertz.kappa)[1])


def groove_distance(ball_diameter: float, inner: float, outer: float) -> float:
    """Distance A of the groove centres of a ball that just touches both races of these conformities [m]."""
    return (inner + outer - 1.0) * ball_diameter


def free_clearance(distance: float, contact_angle: float) -> float:
    """Radial clearance [m] with which a ball just touches both races at a contact angle [rad]."""
    return 2.0 * distance * (1.0 - cos(contact_angle))
