"""The ring of a bearing in static equilibrium: loads that it takes, its balls, and the state for users."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.bearing.equilibrium import angle_of, direction_of
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.freedoms import FIVE, PLANAR, bearing_load
from reduced_models.bearing.grooves import ball_inertia
from reduced_models.bearing.height_tables import settle
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.bearing.loss import loss_of
from reduced_models.bearing.race import RACES, films_under
from reduced_models.bearing.ring import RingEquilibrium, StaticRing, require_in_groove, ring_equilibrium
from reduced_models.bearing.shoulders import require_below_shoulders
from reduced_models.bearing.skf_friction import friction_under

if TYPE_CHECKING:
    from reduced_models.bearing.ball_bearing import BallBearing

_Floats = NDArray[np.float64]

POSITIONS = 12  # of the cage over a ball passage for means: those of 6205 are within 1e-3 of those of 48


def require_load(bearing: BallBearing, load: ArrayLike) -> _Floats:
    """A load that a bearing of this kind takes, shape (2,), (3,) or (5,) [N], [N m]; else `InputError`."""
    force = bearing_load(load)
    if force.size == len(PLANAR) and bearing.contact_angle is not None:
        allowed = "(Fx, Fy, Fz) or (Fx, Fy, Fz, Mx, My): an angular contact bearing needs an axial load"
        raise InputError("load", force.tolist(), allowed)
    if bearing.contact_angle is not None and force[2] <= 0.0:
        allowed = "one with Fz > 0: an angular contact bearing carries axial load in +z only"
        raise InputError("load", force.tolist(), f"{allowed} (a BearingSet has others that face -z)")
    return force


def cage_angles(bearing: BallBearing, load: _Floats, cage_angle: float | None) -> list[float]:
    """Angles of the first ball [rad] over a ball passage, or the one that is given."""
    first = direction_of(load) if cage_angle is None else angle_of(cage_angle)
    steps = np.arange(POSITIONS) / POSITIONS if cage_angle is None else np.zeros(1)
    angles: list[float] = (first + 2.0 * pi / bearing.balls * steps).tolist()
    return angles


def static_ring(
    bearing: BallBearing, speed: float, angle: float, free: int, tilt: _Floats | None = None
) -> StaticRing:
    """Inner ring with `free` directions on its balls, at a speed that the bearing takes, the first at `angle`."""
    held = np.zeros(len(FIVE)) if tilt is None else np.concatenate([np.zeros(3), tilt])
    return StaticRing(bearing.tables.balls(speed), angle, free, held)


def equilibrium_under(
    bearing: BallBearing,
    load: _Floats,
    speed: float,
    angle: float,
    tilt: _Floats | None = None,
    turned: float | None = None,
) -> RingEquilibrium:
    """Ring in equilibrium, the first ball at `angle`; raises `InputError` for a load that it does not take.

    With the shaft `turned` by an angle [rad] its features are there; else it is smooth.
    """
    ring = static_ring(bearing, speed, angle, load.size, tilt)
    if load.size > len(PLANAR):
        _require_bearable_by_all(bearing, load, speed)
    try:
        at = ring_equilibrium(ring, load)
    except ConvergenceError:
        _require_bearable_by_all(bearing, load, speed)
        raise
    if turned is not None:
        first = at.displacement
        at = settle(bearing, ring.heights, (angle, turned), lambda: ring_equilibrium(ring, load, first))
    require_in_grooves(bearing, at.balls, load, speed)
    return at


def linear_balls(bearing: BallBearing, speed: float, places: Sequence[RingEquilibrium]) -> LinearBalls:
    """All balls about equilibrium, over positions of the cage."""
    loss = loss_of(bearing.loss_factor)
    return LinearBalls.of(bearing.tables.balls(speed), list(places), loss, ball_inertia(bearing))


def state_of(bearing: BallBearing, at: RingEquilibrium, speed: float, angle: float) -> BearingState:
    """State of the bearing with its ring where balls are in equilibrium, the first ball at `angle`."""
    balls = bearing.tables.balls(speed)
    rolling: dict[str, Any] = {
        "contact_angles": at.angles,
        "spin_to_roll": at.spin_to_roll,
        "gyroscopic_friction": at.gyroscopic_friction(balls.grooves, balls.omega),
        "orbit": bearing.ring_speeds.about_axis(at.orbit),
        "ball_rotation": at.ball_rotation,
    }
    return BearingState(
        name=bearing.name,
        load=at.load,
        speed_rpm=speed,
        cage_angle=angle,
        displacement=at.displacement,
        stiffness=at.stiffness,
        angles=np.asarray(angle + 2.0 * pi / bearing.balls * np.arange(bearing.balls)),
        force=at.force,
        approach=at.approach,
        **({} if at.load.size == len(PLANAR) else rolling),
        **({} if bearing.oil is None else films_under(bearing, speed, at)),
        **friction_under(bearing, at.load, speed),
        internals=bearing.tables.internals,
    )


def require_in_grooves(bearing: BallBearing, balls: NDArray[np.void], load: _Floats, speed: float) -> None:
    """Raise `InputError` for balls of a `RingEquilibrium` beyond what grooves and races bear."""
    require_in_groove(balls, load, bearing.contact_angle is not None)
    force = balls["load"]
    require_below_shoulders(bearing, balls["angle"], force, load)
    field: tuple[str, Any] = "load", load.tolist()
    if not load.any() and bearing.clearance < 0.0:
        field = "clearance", bearing.clearance
    for name, most in zip(RACES, force.max(axis=0).tolist(), strict=True):
        bearing.race(name).require_bearable(most, speed, *field)


def _require_bearable_by_all(bearing: BallBearing, load: _Floats, speed: float) -> None:
    """Raise `InputError` for a load that is too large even if all balls carried the same share of it."""
    moment = float(np.hypot.reduce(load[3:])) / (0.5 * bearing.pitch_diameter)
    share = max(float(np.hypot.reduce(load[:3])), moment) / bearing.balls
    for name in RACES:
        highest, end = bearing.race(name).heaviest(speed)
        if share > highest:
            allowed = f"such that a ball carries at most {highest:.4g} N on the {name} race, {end}"
            raise InputError("load", load.tolist(), f"{allowed} (here {share:.4g} N in the mean of all balls)")
