"""Tables of heights on races and balls, over angle and load, filtered by the contact; made before a run.

A contact is replaced by a strip of springs along its track (x), each pressed by its own overlap. With the
approach d of smooth surfaces and a height h(x), positive out of the surface, its force is that of the approach
d + H:

    (4/3) sqrt(2 R) (d + H)^1.5 = integral of (d + h(x) - x^2/(2 R))_+ dx,    R = a^2/(2 d).

With Hertz' semi-axis a in R the strip has Hertz' force and contact length at every load. For heights far below d,
H is their mean over the contact: the filter sin(k)/k of waves with the wave number k per semi-axis, that of dry
contacts (`ehlcontact.excitation`). Where d + h <= x^2/(2 R) all along, nothing touches, and H is the height at
which the strip would just touch. Near spalls and dents, which are deep, H is that of an elastic contact instead
(`elastic_heights`): there springs lose too much of their force.

H is tabulated over the angle of the contact on its track and the semi-axis. In a time step it is looked up at the
compression that the contact had at the end of the last one (`contact_heights`). In oil, runs have these tables
through the filter of the film (`film_heights`); equilibria have them as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil, cos, pi, sqrt
from typing import TYPE_CHECKING, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks.admissible_range import LIMITS
from ehlcontact.dry_contact import elastic_contact
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.hertz import hertz_contact
from reduced_models.bearing.contact_heights import RAISED, RING_SPEED, ROTATION, TABLE, contact_height
from reduced_models.bearing.elastic_heights import Track, highest_touch
from reduced_models.bearing.features import BallDiameter, Defect, Feature, Indentation, Spall, Waves
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES, Race

if TYPE_CHECKING:
    from reduced_models.bearing.ball_bearing import BallBearing

_Floats = NDArray[np.float64]

LOADS = 25  # semi-axes of a table, from 0 to that of the heaviest load of elastic steel
PER_AXIS, USUAL = 8.0, 0.2  # least places of a table per semi-axis; that usual semi-axis over the largest
PER_WAVE, PER_LENGTH, PER_EDGE = 16, 64, 2  # least places per wave, per defect, per edge of a defect
MOST_PLACES, ROUNDED = 2**16, 2**10  # places around a track: most, and a divisor of their number
SETTLED = 1e-7  # convergence of heights in `settle`, over the largest height
MOST_TIMES = 200  # iterations of `settle`; a few are usual
LEAST_STEPS = 3  # of a run while a ball meets a feature: of 6205 records within 2 % of those of 14
RELAXED = 0.7  # under-relaxation there: a contact that unloads becomes shorter, too


def heights_of(bearing: BallBearing) -> _Floats:
    """All features of a bearing as the array of `contact_heights`."""
    if not bearing.features:
        return np.zeros((0, 0, LOADS))
    numbers = np.zeros((1 + bearing.balls, LOADS))
    rings = bearing.ring_speeds
    numbers[0, ROTATION] = rings.sense * bearing.orders.bsf_order
    numbers[0, RING_SPEED : RING_SPEED + len(RACES)] = rings
    tracks: list[tuple[str, float, _Floats, list[Defect]]] = []
    for column, name in enumerate(RACES):
        for row in range(1 + bearing.balls):
            own = features_on(bearing, **({"race": name} if row == 0 else {"ball": row - 1}))
            if row > 0:
                numbers[row, RAISED] = 0.5 * sum(one.excess for one in own if isinstance(one, BallDiameter))
            if waves := [one for one in own if not isinstance(one, BallDiameter)]:
                radius = track_radius(bearing, name) if row == 0 else 0.5 * bearing.ball_diameter
                defects = [one for one in own if isinstance(one, Spall | Indentation)]
                tracks.append((name, radius, profile_of(bearing, waves, name, radius), defects))
                numbers[row, TABLE + column] = len(tracks)
    places = max((profile.size for _, _, profile, _ in tracks), default=0)
    found = np.zeros((1 + len(tracks), max(places + 1, len(numbers)), LOADS))
    found[0, : len(numbers)] = numbers
    for page, (name, radius, profile, defects) in zip(found[1:], tracks, strict=True):
        strip, axis = _strip(bearing.race(name))
        resampled, spacing = _resampled(profile, places), 2.0 * pi * radius / places
        page[:places] = filtered(resampled, spacing, strip, axis)
        if defects:
            body = bearing.race(name).geometry
            track = Track(resampled, spacing, strip, body.radius_x, elastic_contact(body.kappa))
            for column, a in enumerate(np.linspace(0.0, axis, LOADS).tolist()):
                near = _near(defects, radius, places, a)
                page[:places, column] = track.heights(a * a / (2.0 * strip), page[:places, column], near)
        page[-1, 0] = (LOADS - 1) / axis * sqrt(2.0 * strip)
    return found


def features_on(bearing: BallBearing, *, race: str | None = None, ball: int | None = None) -> list[Feature]:
    """Features of one race, or of one ball."""
    name, wanted = ("ball", ball) if race is None else ("race", race)
    return [one for one in bearing.features if getattr(one, name, None) == wanted]


class BallsAtRest(Protocol):
    """A ring in equilibrium: forces [N] and approaches [m] of all contacts, shape (balls, 2)."""

    @property
    def force(self) -> _Floats:
        """Forces."""

    @property
    def approach(self) -> _Floats:
        """Approaches, heights included."""


_AtRest = TypeVar("_AtRest", bound=BallsAtRest)


def settle(
    bearing: BallBearing, found: _Floats, angles: tuple[float, float], solve: Callable[[], _AtRest]
) -> _AtRest:
    """Equilibrium with heights that belong to its own compressions, by fixed-point iteration.

    Parameters
    ----------
    bearing : BallBearing
    found : ndarray, shape (balls, 2)
        Written: heights with which `solve` finds an equilibrium [m].
    angles : (float, float)
        Of the first ball and of the shaft [rad].
    solve : callable

    Raises
    ------
    ConvergenceError
        The heights do not settle.
    """
    heights, sense = bearing.tables.heights, bearing.ring_speeds.sense
    kn = np.array([bearing.race(name).kn for name in RACES])
    for _ in range(MOST_TIMES):
        at = solve()
        turns = sense * at.ball_rotation if hasattr(at, "ball_rotation") else heights[0, 0, ROTATION]
        own = np.broadcast_to(angles[1] * turns, len(found))
        pressed = np.where(at.force > 0.0, (np.maximum(at.force, 0.0) / kn) ** (2.0 / 3.0), at.approach)
        new = np.empty(found.shape)
        for k, race in np.ndindex(*found.shape):
            psi, turned = angles[0] + 2.0 * pi * k / bearing.balls, (angles[1], float(own[k]))
            compression = float(pressed[k, race] - found[k, race])
            new[k, race] = contact_height(heights, k, race, psi, turned, compression)
        change = new - found
        if np.abs(change).max() <= SETTLED * np.abs(new).max():
            return at
        found += RELAXED * change
    raise ConvergenceError("static equilibrium not found: heights of features do not converge", None)


def track_radius(bearing: BallBearing, name: str) -> float:
    """Radius of the track on a race [m], at the contact angle without load."""
    side = -1.0 if name == "inner" else 1.0
    return 0.5 * (bearing.pitch_diameter + side * bearing.ball_diameter * cos(bearing.free_angle))


PLACES_OF_A_DEFECT = 65  # at which depths of defects that overlap are added


def require_features_fit(bearing: BallBearing) -> None:
    """Raise `InputError` for features that do not fit on the bearing, or are too fine for a table."""
    for one in bearing.features:
        ball, race = getattr(one, "ball", None), getattr(one, "race", None)
        if ball is not None and bearing.race_control == "shared" and not isinstance(one, BallDiameter):
            allowed = "left out: with race_control = 'shared' it is open about which axis a ball turns"
            raise InputError("ball", ball, allowed)
        most = MOST_PLACES // PER_WAVE
        if isinstance(one, Waves) and one.waves > most:
            allowed = f"at most {most} of a bearing: {PER_WAVE} of the {MOST_PLACES} places of a table to a wave"
            raise InputError("waves", one.waves, allowed)
        if isinstance(one, Waves | BallDiameter):
            continue
        least, track, deepest = defect_limits(bearing, race)
        if not least <= one.length <= track:
            where = "around the ball" if race is None else f"around the {race} race"
            raise InputError("length", one.length, f"from {least:.2g} to {track:.4g} m, the track {where}")
        if one.depth > deepest:
            raise InputError("depth", one.depth, f"at most {deepest:.4g} m, a ball's radius")
    _require_shallow(bearing)


def _require_shallow(bearing: BallBearing) -> None:
    """Raise `InputError` for defects of one surface that are deeper together than a ball's radius."""
    for race, ball in {(one.race, one.ball) for one in bearing.features if isinstance(one, Spall | Indentation)}:
        there = [one for one in bearing.features if isinstance(one, Spall | Indentation)]
        there = [one for one in there if (one.race, one.ball) == (race, ball)]
        _, track, deepest = defect_limits(bearing, race)
        for one in there:
            x = one.angle / (2.0 * pi) * track + np.linspace(-0.5, 0.5, PLACES_OF_A_DEFECT) * one.length
            whole = np.zeros(x.size)
            for other in there:
                away = x - other.angle / (2.0 * pi) * track
                whole += other.height(away - track * np.rint(away / track))
            if -whole.min() > deepest:
                allowed = f"at most {deepest:.4g} m together, a ball's radius, where defects of a surface overlap"
                raise InputError("depth", float(-whole.min()), allowed)


def defect_limits(bearing: BallBearing, race: str | None) -> tuple[float, float, float]:
    """Least and largest length, and largest depth, of a defect of a race, or of a ball [m]."""
    radius = 0.5 * bearing.ball_diameter
    track = 2.0 * pi * (radius if race is None else track_radius(bearing, race))
    return PER_LENGTH * track / MOST_PLACES, track, radius


def shortest_meeting(bearing: BallBearing, speed_rpm: float, force: float) -> tuple[float, Feature] | None:
    """Shortest time [s] in which a ball under a force [N] meets a feature, and that feature; None without one.

    A spall or a dent is met over its length or that of the contact, whichever is shorter, waviness over half a
    wave.
    """
    radii = {name: track_radius(bearing, name) for name in RACES}
    speed = speed_rpm * RPM_TO_RAD_S * bearing.ring_speeds.from_outer(bearing.orders.ftf_order) * radii["outer"]
    bodies = [bearing.race(name).geometry for name in RACES]
    unit = min(2.0 * hertz_contact(1.0, one.radius_x, one.radius_y, one.e_reduced).a for one in bodies)
    contact = unit * float(np.cbrt(force)) if force > 0.0 else np.inf
    found: list[tuple[float, Feature]] = []
    for one in bearing.features:
        if isinstance(one, Waves):
            found.append((pi * radii.get(getattr(one, "race", ""), 0.5 * bearing.ball_diameter) / one.waves, one))
        elif not isinstance(one, BallDiameter):
            found.append((min(one.length, contact), one))
    length, feature = min(found, key=lambda pair: pair[0], default=(0.0, None))
    return None if feature is None or speed == 0.0 else (length / speed, feature)


def _strip(race: Race) -> tuple[float, float]:
    """Radius R of the strip of springs [m], and semi-axis under the heaviest load of elastic steel [m]."""
    body = race.geometry
    unit = hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced)
    return unit.a**2 / (2.0 * unit.approach), unit.a * LIMITS.p_hertz / unit.pressure


def profile_of(bearing: BallBearing, features: Sequence[Feature], name: str, radius: float) -> _Floats:
    """Heights of features of one track over its angle [m], at as many places as they and contacts need.

    The track has a `radius` [m], and its contacts are those of the race `name`.
    """
    axis = _strip(bearing.race(name))[1]
    needed = PER_AXIS * 2.0 * pi * radius / (USUAL * axis)
    for one in features:
        if isinstance(one, Waves):
            needed = max(needed, PER_WAVE * one.waves)
        elif not isinstance(one, BallDiameter):
            spacing = min(one.length / PER_LENGTH, (getattr(one, "edge", 0.0) or one.length) / PER_EDGE)
            needed = max(needed, 2.0 * pi * radius / spacing)
    places = min(ROUNDED * ceil(needed / ROUNDED), MOST_PLACES)
    return heights_along(features, radius, 2.0 * pi * np.arange(places) / places)


def heights_along(features: Sequence[Feature], radius: float, theta: _Floats) -> _Floats:
    """Height [m] of features of one track, but for diameters, at angles `theta` on it [rad]."""
    heights = np.zeros(theta.shape)
    for one in features:
        if isinstance(one, Waves):
            heights += one.amplitude * np.cos(one.waves * theta - one.phase)
        elif not isinstance(one, BallDiameter):
            heights += one.height(radius * (np.remainder(theta - one.angle + pi, 2.0 * pi) - pi))
    return heights


def _near(defects: Sequence[Defect], radius: float, places: int, a: float) -> NDArray[np.bool_]:
    """Which places around a track are within a defect, its rims, or some semi-axes a of it."""
    theta, near = 2.0 * pi * np.arange(places) / places, np.zeros(places, bool)
    for one in defects:
        away = radius * np.abs(np.remainder(theta - one.angle + pi, 2.0 * pi) - pi)
        near |= away <= one.length + 4.0 * a
    return near


def _resampled(profile: _Floats, places: int) -> _Floats:
    return np.interp(
        np.arange(places) * profile.size / places, np.arange(profile.size + 1), np.append(profile, profile[0])
    )


def filtered(profile: _Floats, spacing: float, strip: float, axis: float) -> _Floats:
    """H at all places of a periodic profile and all semi-axes of a table, shape (places, LOADS) [m]."""
    found = np.zeros((profile.size, LOADS))
    highest, lowest = max(float(profile.max()), 0.0), min(float(profile.min()), 0.0)
    envelope = highest_touch(profile, spacing, strip, highest - lowest)
    for column, a in enumerate(np.linspace(0.0, axis, LOADS).tolist()):
        approach = a * a / (2.0 * strip)
        pressed, flat = _pressed(profile, approach, highest, spacing, strip)
        touching = pressed > 0.0
        found[:, column] = np.where(touching, pressed - flat, np.minimum(envelope, -approach))
    return found


def _pressed(
    profile: _Floats, approach: float, highest: float, spacing: float, strip: float
) -> tuple[_Floats, float]:
    """Approach of smooth surfaces with the force of the strip, at all places and of a flat profile."""
    reach = ceil(sqrt(2.0 * strip * (approach + highest)) / spacing)
    total, flat = np.zeros(profile.size), 0.0
    for m in range(-reach, reach + 1):
        x = m * spacing
        gap, half = approach - x * x / (2.0 * strip), abs(x) / strip * 0.5 * spacing
        total += _mean_overlap(gap + np.roll(profile, -m), half)
        flat += float(_mean_overlap(np.array(gap), half))
    scale = 0.75 * spacing / sqrt(2.0 * strip)
    return (scale * total) ** (2.0 / 3.0), (scale * flat) ** (2.0 / 3.0)


def _mean_overlap(middle: _Floats, half: float) -> _Floats:
    """Mean over a cell of what is positive of a linear function from middle - half to middle + half."""
    if half == 0.0:
        return np.maximum(middle, 0.0)
    within = np.clip(middle + half, 0.0, 2.0 * half)
    return np.maximum(middle - half, 0.0) + within * within / (4.0 * half) + 0.0 * middle
