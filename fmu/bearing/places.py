"""States of the FMU: where balls at contact angles are counted from, their damping across the contacts, and rest.

In the FMU origins and damping are of the bearing alone, so that balls that go round, and bearings that start
elsewhere, have them in common: places are counted from where a ball is on the line between both groove centres of
a ring in the middle.
"""

from __future__ import annotations

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from reduced_models.bearing.ball_states import ACROSS
from reduced_models.bearing.continuous_time import BearingRates
from reduced_models.bearing.core_bearing import ORIGIN
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.linear_balls import small_film

_Floats = NDArray[np.float64]

LOAD = 100.0  # N on a ball, for which nominal values and damping are
DIGITS = 12  # of states at rest, which a search for the balance of balls gives


def rolling_speed_sum(model: BearingModel) -> float:
    """Sum of both surface speeds of a ball over the speed of the shaft, at a contact angle of 0 [m]."""
    bearing = model.bearing
    return float(0.5 * bearing.pitch_diameter * (1.0 - bearing.gamma**2))


def counted_from(model: BearingModel) -> NDArray[np.void]:
    """Records of `ORIGIN`, shape (balls,), of all balls alike."""
    balls = model.balls
    g, bearing = balls.grooves, model.bearing
    radial = g.radial + (0.5 * bearing.clearance if bearing.contact_angle is None else 0.0)
    place = g.outer * np.array([radial, g.axial]) / np.hypot(radial, g.axial)
    across = 0.0
    for law in (balls.inner, balls.outer):
        if law.x.size:
            transit = law.contact_length_factor / (rolling_speed_sum(model) * model.speeds[-1] * RPM_TO_RAD_S)
            film = (LOAD / law.kn) ** (2.0 / 3.0)
            slope = 1.5 * law.kn * np.sqrt(film)
            about = small_film(law, transit, (len(law.gains) - 1, 0.0), film, slope, slope)
            across += ACROSS * float(about.state_space().D[0, 1])
    origins = np.zeros(balls.number, ORIGIN)
    origins["place"], origins["across"] = place, across
    return origins


def rates_of(model: BearingModel) -> BearingRates:
    """The bearing in continuous time, its states those of the FMU."""
    return BearingRates(model.balls, model.directions, counted_from(model))


def rest_states(model: BearingModel, speed_rpm: float, angle: float, place: _Floats) -> list[float | None]:
    """States at rest, the ring at `place` and the first ball at `angle` [rad]; None where there is no balance."""
    states = rates_of(model).rest(speed_rpm * RPM_TO_RAD_S, angle, place).tolist()
    return [float(f"{value:.{DIGITS}g}") if isfinite(value) else None for value in states]
