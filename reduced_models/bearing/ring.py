"""Inner ring in static equilibrium on its balls, with five degrees of freedom or some of them held.

Displacements of the ring move groove centres linearly. Contacts act as springs between groove centres that only
pull, because the distance of the centres grows as the ball is compressed. At rest, and with centrifugal forces,
their potential is convex (nearly, for the orbits of balls depend on their angles), so that `equilibrium` needs
no first guess. The gyroscopic moment, which has no potential, is added then, in steps.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from ctypes import c_double
from dataclasses import dataclass, replace
from math import cos, degrees, pi

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.hertz import elliptic_integrals, hertz_contact
from ehlcontact.point import Geometry
from reduced_models.bearing.ball import Balls
from reduced_models.bearing.contact_angles import CONTROLS, Grooves
from reduced_models.bearing.core_bearing import AT_REST, CoreBearing, pointer, reason
from reduced_models.bearing.equilibrium import GUESS, OPEN, equilibrium
from reduced_models.bearing.freedoms import FIVE, PLANAR

_Floats = NDArray[np.float64]
_Record = NDArray[np.void]

FOLLOWED = 0.05  # step of a ring, over the distance of its groove centres, along which balls are followed
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
        self.size = n = len(PLANAR) if free == len(PLANAR) else len(FIVE)
        radius = balls.grooves.groove_circle
        # of a displacement, over a length
        self.unit = np.array([1.0, 1.0, 1.0, 1.0 / radius, 1.0 / radius])[:free]
        self.longest = FOLLOWED * (balls.grooves.inner + balls.grooves.outer)
        self.load, self.stiffness = np.zeros(n), np.zeros((n, n))
        self._place, self._still, self._damping = np.zeros(n), np.zeros(n), np.zeros((n, n))
        self._pressed_at: bytes | None = None
        self._core = core = CoreBearing(balls, FIVE[:n])
        self._state, self._work = core.start(), core.work()
        self._steps = core.ball_steps(self._work)
        state, work = pointer(self._state), pointer(self._work)
        self._begin = core.address, state, work, c_double(0.0), c_double(balls.omega)
        self._press = core.address, state, work, pointer(self._place), pointer(self._still), pointer(self.load)
        self._slopes = core.address, work, pointer(self.stiffness), pointer(self._damping)
        self.angle = angle

    @property
    def angle(self) -> float:
        """Of the first ball [rad]."""
        return float(self._core.head(self._state)["angle"][0])

    @angle.setter
    def angle(self, angle: float) -> None:
        """Turn the cage."""
        places, heights = self.places.copy(), self.heights.copy()
        self._core.head(self._state)["angle"] = angle
        self._core.library.bearing_begin(*self._begin)
        self.places, self.heights[:] = places, heights

    @property
    def places(self) -> _Floats:
        """Of all balls, from the outer groove centre, outward and along the shaft, shape (balls, 2) [m].

        They are where each ball was pressed last, and where it is looked for; 0 for balls that have no place.
        """
        return self._steps["start"]

    @places.setter
    def places(self, places: _Floats | float) -> None:
        """Look for balls there, wherever the ring is pressed next."""
        self._steps["start"], self._steps["follow"] = places, 0.0
        self.changed()

    @property
    def heights(self) -> _Floats:
        """Of features at both contacts of every ball, shape (balls, 2) [m]; may be written."""
        return self._steps["height"]

    def with_inertia(self, centrifugal: float, gyroscopic: float) -> None:
        """Give balls a share of their centrifugal forces and of their gyroscopic moments.

        Without any gyroscopic moment they run under outer race control.
        """
        g, own = self.balls.grooves, self._core.structure
        own.control = g.control if gyroscopic > 0.0 else CONTROLS.index("outer")
        own.grooves.mass, own.grooves.gyroscopic = centrifugal * g.mass, gyroscopic * g.gyroscopic
        self.changed()

    def changed(self) -> None:
        """Balls or heights are no longer those with which it was pressed last."""
        self._pressed_at = None

    def carried(self) -> float:
        """Forces of the ring on all balls where it was pressed last, added without their directions [N]."""
        return float(self._steps["force"][:, 0].sum())

    def displacement(self, q: _Floats) -> _Floats:
        """Displacement, shape (n,) [m], [rad], from a scaled one of the directions that move."""
        full = self.held[: self.size].copy()
        full[: self.free] = q * self.unit
        return full

    def force(self, q: _Floats) -> _Floats:
        """Scaled forces of the ring on the balls, shape (free,) [N]."""
        self.press(self.displacement(q))
        return self.load[: self.free] * self.unit

    def tangent(self, q: _Floats) -> _Floats:
        """Their derivative, shape (free, free) [N/m]."""
        self.press(self.displacement(q))
        return self.stiffness[: self.free, : self.free] * np.outer(self.unit, self.unit)

    def press(self, displacement: _Floats) -> None:
        """Set `load` and `stiffness`, those of the ring at a displacement, shape (n,) [m], [rad].

        Raises
        ------
        ConvergenceError
            A ball finds no balance.
        """
        place, library = displacement.tobytes(), self._core.library
        if place == self._pressed_at:
            return
        self._pressed_at, self._place[:] = None, displacement
        why = reason(library.bearing_press(*self._press))
        if why is not None:
            lost = np.flatnonzero(self.places[:, 0] == 0.0).tolist()
            what = f"ball {lost[0]} finds no balance" if lost else why
            raise ConvergenceError(f"{what} with the ring at {displacement.tolist()} (m, rad)", displacement)
        library.bearing_slopes(*self._slopes)
        self._pressed_at = place

    def describe(self) -> tuple[_Record, _Floats]:
        """All balls where they were pressed last: `balls` and `geometric` of `RingEquilibrium`."""
        balls, geometric = np.zeros(self.balls.number, AT_REST), np.zeros((self.balls.number, 5, 4))
        self._core.library.bearing_describe(*self._begin[:3], pointer(balls), pointer(geometric))
        return balls, geometric


@dataclass(frozen=True, eq=False)
class RingEquilibrium:
    """A ring in equilibrium, and its balls."""

    displacement: _Floats  # (n,) [m], [rad]
    load: _Floats  # (n,) [N], [N m], reactions of what is held included
    stiffness: _Floats  # (n, n)
    balls: _Record  # (balls,) of `AT_REST`
    geometric: _Floats  # (balls, 5, 4) derivatives of `LinearBalls`
    maps: _Floats  # (balls, 3, n) of `ring_maps`

    @property
    def angles(self) -> _Floats:
        """Contact angles, shape (balls, 2) [rad]: columns for inner and outer race, as of all following."""
        return self.balls["angle"]

    @property
    def force(self) -> _Floats:
        """Contact forces [N]."""
        return self.balls["load"]

    @property
    def approach(self) -> _Floats:
        """Mutual approaches [m]."""
        return self.balls["approach"]

    @property
    def speed_sum(self) -> _Floats:
        """Sum of both surface speeds over the speed of the shaft [m]."""
        return self.balls["speed_sum"]

    @property
    def orbit(self) -> _Floats:
        """Speed of every ball about the axis over that of the inner ring, seen from the outer one: (balls,)."""
        return self.balls["orbit"]

    @property
    def ball_rotation(self) -> _Floats:
        """Speed of every ball about its own axis, seen from the cage, over that of the shaft, shape (balls,)."""
        return self.balls["rotation"]

    def gyroscopic_friction(self, grooves: Grooves, omega: float) -> _Floats:
        """Friction across both contacts that holds the gyroscopic moment, over their forces, shape (balls, 2)."""
        balls = self.balls
        spin = grooves.sense * balls["rotation"] * np.sin(balls["axis"])
        orbit = grooves.sense * balls["orbit"] + grooves.ring_speed[1]
        friction = 0.2 * grooves.gyroscopic * grooves.mass * grooves.ball * orbit * spin * omega**2
        both = np.column_stack([balls["share"] * friction, (1.0 - balls["share"]) * friction])
        return np.divide(both, balls["load"], out=np.zeros_like(both), where=balls["load"] > 0.0)

    @property
    def spin_to_roll(self) -> _Floats:
        """Relative angular speed of both surfaces about their normal over that of rolling, with its sign."""
        inner, outer = self.angles.T
        axis, rotation, orbit = self.balls["axis"], self.ball_rotation, self.orbit
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
    balls, geometric = ring.describe()
    return RingEquilibrium(
        displacement=displacement,
        load=ring.load.copy(),
        stiffness=ring.stiffness.copy(),
        balls=balls,
        geometric=geometric,
        maps=ring_maps(ring.balls.grooves, ring.angle, ring.balls.number)[..., : ring.size],
    )


def ring_maps(grooves: Grooves, angle: float, balls: int) -> _Floats:
    """Rows by which the ring's displacement moves c_r and c_z, and its tilt follows a moment: (balls, 3, 5).

    The first ball is at an `angle` [rad]; c is the inner groove centre at a ball.
    """
    psi = angle + 2.0 * pi * np.arange(balls) / balls
    cosine, sine, maps = np.cos(psi), np.sin(psi), np.zeros((balls, 3, len(FIVE)))
    maps[:, 0, 0], maps[:, 0, 1], maps[:, 1, 2] = cosine, sine, 1.0
    maps[:, 1, 3], maps[:, 1, 4] = grooves.groove_circle * sine, -grooves.groove_circle * cosine
    maps[:, 2, 3], maps[:, 2, 4] = -sine, cosine
    return maps


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
    planar = all(ring.size == len(PLANAR) for ring in rings)  # contact angles of 0: no gyroscopic moment
    if planar or all(ring.balls.omega == 0.0 for ring in rings):
        return solve(None), 1.0

    def share(centrifugal: float, gyroscopic: float) -> None:
        for ring in rings:
            ring.with_inertia(centrifugal, gyroscopic)

    share(1.0, 0.0)
    try:
        place = solve(None)
    except ConvergenceError:  # centrifugal forces bend the potential: from light balls to those that there are
        for ring in rings:
            ring.places = 0.0
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
        kept = [ring.places.copy() for ring in rings]
        try:
            place = solve(place)
        except ConvergenceError:
            step *= 0.5
            for ring, places in zip(rings, kept, strict=True):
                ring.places = places
            if step < SMALLEST_SHARE:
                return place, done
        else:
            done = tried
    return place, 1.0


def require_in_groove(balls: _Record, load: _Floats, one_way: bool) -> None:
    """Raise `InputError` where a ball that both rings press leaves its groove.

    `balls` are those of a `RingEquilibrium`; with `one_way` they carry at positive contact angles only, as of an
    angular contact bearing.
    """
    force = balls["load"][:, 0]
    pressed = (balls["approach"].sum(axis=1) > 0.0) & (force > CARRIES * force.max())
    for k in np.flatnonzero(pressed).tolist():
        angle = balls["angle"][k]
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
