"""Where balls at contact angles are counted from, and the damping that they have across their contacts.

In the FMU both are of the bearing alone, so that balls that go round, and bearings that start elsewhere, have the
same: places are counted from where a ball is on the line between both groove centres of a ring in the middle.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from reduced_models.bearing.ball_states import ACROSS
from reduced_models.bearing.core_bearing import ORIGIN
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.linear_balls import small_film

LOAD = 100.0  # N on a ball, for which nominal values and damping are


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
