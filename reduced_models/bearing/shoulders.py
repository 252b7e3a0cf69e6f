"""Shoulders of the grooves: how far up their sides contact ellipses may reach.

A groove of the radius f D ends at the height h of its shoulder above its bottom, at the angle

    cos theta = 1 - h/(f D)

from the bottom, seen from the groove centre. A contact at the angle alpha whose ellipse has the semi-axis b across
the groove reaches alpha + asin(b/(f D)). Beyond theta the ellipse is cut off, and the shoulder's edge carries.
"""

from __future__ import annotations

from math import acos, cos, degrees
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_positive
from ehlcontact.errors import InputError
from ehlcontact.hertz import hertz_contact

_Floats = NDArray[np.float64]

SIDES = {"inner": 1.0, "outer": -1.0}  # of the shoulder's radius less that of the bottom


def shoulder_angle(bearing: Any, race: str) -> float | None:
    """Angle of the shoulder of a race of a `BallBearing` from the bottom of its groove [rad]; None if not given.

    Raises
    ------
    InputError
        A diameter at which no groove ends.
    """
    name = f"shoulder_{race}"
    diameter = getattr(bearing, name)
    if diameter is None:
        return None
    radius = getattr(bearing, f"conformity_{race}") * bearing.ball_diameter
    side = SIDES[race]
    # groove centres are (f - 1/2) D cos(angle) beside the pitch circle, outside it at the inner race
    centre = 0.5 * bearing.pitch_diameter + side * (radius - 0.5 * bearing.ball_diameter) * cos(bearing.free_angle)
    bottom = centre - side * radius
    height = side * (0.5 * require_positive(name, diameter) - bottom)
    if not 0.0 < height < radius:
        ends = sorted((2.0 * bottom, 2.0 * centre))
        allowed = f"between {ends[0]:.4g} and {ends[1]:.4g} m, the bottom of the groove and its centre"
        raise InputError(name, diameter, allowed)
    return acos(1.0 - height / radius)


def require_below_shoulders(bearing: Any, angles: _Floats, force: _Floats, load: _Floats) -> None:
    """Raise `InputError` where a contact ellipse reaches over a shoulder that is given.

    `angles` [rad] and `force` [N] have shape (balls, 2): columns for inner and outer race.
    """
    for column, race in enumerate(SIDES):
        end = bearing.tables.shoulders[race]
        if end is None:
            continue
        body = bearing.race(race).geometry
        across = hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).b
        radius = getattr(bearing, f"conformity_{race}") * bearing.ball_diameter
        edges = np.abs(angles[:, column]) + np.arcsin(np.cbrt(force[:, column]) * across / radius)
        edges = np.where(force[:, column] > 0.0, edges, 0.0)
        ball = int(np.argmax(edges))
        if edges[ball] > end:
            reached = f"here {degrees(edges[ball]):.3g} degrees of {degrees(end):.3g} at ball {ball}"
            allowed = f"one whose contact ellipses end below the shoulder of the {race} race ({reached})"
            raise InputError("load", load.tolist(), allowed)
