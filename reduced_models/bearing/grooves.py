"""Grooves of a bearing: checks of its dimensions, and what the kernels need of its geometry."""

from __future__ import annotations

from math import acos, cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from ehlcontact.checks import require_finite
from ehlcontact.errors import InputError
from reduced_models.bearing.contact_angles import CONTROLS, Grooves
from reduced_models.bearing.kinematics import ball_mass
from reduced_models.bearing.race import RACES
from reduced_models.bearing.ring import free_clearance, groove_distance, spin_moment_factor

if TYPE_CHECKING:
    from reduced_models.bearing.ball_bearing import BallBearing

LARGEST_PLAY = 0.05  # clearance or preload over ball diameter: five times what C5 or a heavy fit has
LARGEST_ANGLE = pi / 4.0  # rad: beyond it, a thrust bearing
SAME_CLEARANCE = 0.01  # by which a clearance beside a contact angle may be rounded


def grooves_of(bearing: BallBearing) -> Grooves:
    """Grooves, balls and race control of a bearing."""
    distance, angle = distance_of_centres(bearing), bearing.contact_angle
    conformities = bearing.conformity_inner, bearing.conformity_outer
    inner, outer = ((conformity - 0.5) * bearing.ball_diameter for conformity in conformities)
    # without a given angle the outer groove is at 0 along the shaft, and the inner one with it
    free = distance - 0.5 * bearing.clearance, 0.0
    if angle is not None:
        free = distance * cos(angle), distance * sin(angle)
    moments = [spin_moment_factor(race.geometry, race.kn) for race in map(bearing.race, RACES)]
    return Grooves(
        radial=free[0],
        axial=free[1],
        inner=inner,
        outer=outer,
        groove_circle=0.5 * bearing.pitch_diameter + inner * cos(bearing.free_angle),
        radius=bearing.conformity_inner * bearing.ball_diameter,
        ball=bearing.ball_diameter,
        pitch=bearing.pitch_diameter,
        mass=ball_mass(bearing.ball_diameter, bearing.density),
        control=CONTROLS.index(bearing.race_control),
        gyroscopic=-1.0 if bearing.race_control == "harris" else 1.0,
        inner_spin_moment=moments[0],
        outer_spin_moment=moments[1],
        cosine=table_cosine(bearing),
        ring_speed=(bearing.ring_speeds.inner, bearing.ring_speeds.outer),
        sense=bearing.ring_speeds.sense,
    )


def distance_of_centres(bearing: BallBearing) -> float:
    """Distance of the groove centres of a ball that just touches both races [m]."""
    return groove_distance(bearing.ball_diameter, bearing.conformity_inner, bearing.conformity_outer)


def angle_without_load(bearing: BallBearing) -> float:
    """Contact angle with the balls just touching both races [rad]: 0 without clearance."""
    if bearing.contact_angle is not None:
        return bearing.contact_angle
    return acos(1.0 - 0.5 * max(bearing.clearance, 0.0) / distance_of_centres(bearing))


def table_cosine(bearing: BallBearing) -> float:
    """Cosine of the contact angle for which both races are tabulated."""
    return 1.0 if bearing.contact_angle is None else cos(bearing.contact_angle)


def ball_inertia(bearing: BallBearing) -> float:
    """Inertia of a ball towards the rings [kg]; 0 where it has none."""
    return ball_mass(bearing.ball_diameter, bearing.density) if bearing.ball_inertia else 0.0


def require_room(bearing: BallBearing) -> None:
    """Raise `InputError` for balls that overlap, and for a clearance that no bearing of this kind has."""
    room = bearing.pitch_diameter * sin(pi / bearing.balls)
    if bearing.ball_diameter >= room:
        most = int(pi / np.arcsin(bearing.ball_diameter / bearing.pitch_diameter))
        raise InputError("balls", bearing.balls, f"at most {most} on this pitch circle: they overlap")
    play = LARGEST_PLAY * bearing.ball_diameter
    if isinstance(bearing.clearance, str):
        allowed = 'a number [m]; classes need a bore, as BallBearing.catalogue("6205", clearance="CN") has'
        raise InputError("clearance", bearing.clearance, allowed)
    if not abs(require_finite("clearance", bearing.clearance)) <= play:
        raise InputError("clearance", bearing.clearance, f"between {-play:.3g} and {play:.3g} m")
    if bearing.contact_angle is not None and bearing.clearance != 0.0:
        own = free_clearance(distance_of_centres(bearing), bearing.contact_angle)
        if abs(bearing.clearance - own) > SAME_CLEARANCE * own:
            allowed = f"left out beside a contact angle, which makes it {own:.4g} m with these conformities"
            raise InputError("clearance", bearing.clearance, allowed)


def require_contact_angle(angle: float) -> None:
    """Raise `InputError` for a contact angle [rad] that no angular contact bearing has."""
    if not 0.0 < require_finite("contact_angle", angle) <= LARGEST_ANGLE:
        allowed = f"above 0 and at most {LARGEST_ANGLE:.4g} rad (45 degrees)"
        guess = f"; {angle:g} degrees are {np.radians(angle):.4g} rad" if LARGEST_ANGLE < angle <= 45.0 else ""
        guess = '; a bearing of the other hand has facing="-z" in its set or mount' if angle < 0.0 else guess
        raise InputError("contact_angle", angle, allowed + guess)
