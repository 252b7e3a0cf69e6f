"""Load of the most loaded ball of a radially loaded bearing."""

from __future__ import annotations

from math import cos, pi

from ehlcontact.checks import require_positive
from ehlcontact.errors import InputError

STRIBECK = 4.37  # Q_max = 4.37 F_r/Z: the limit of many balls


def most_loaded_ball(radial_load: float, balls: int) -> float:
    """Load on the ball that stands under the load, at zero clearance and zero contact angle [N].

    Rigid rings that come closer by d in the load's direction compress the ball at angle psi by d cos(psi), so
    with Hertz' law Q(psi) = Q_max cos(psi)^(3/2) over the loaded half, and F_r = Q_max sum cos(psi)^(5/2).
    For 9 balls Q_max = 0.4872 F_r; Stribeck's 4.37/Z is 0.4856. Harris, Rolling Bearing Analysis, ch. 7.

    Raises
    ------
    InputError
        Load not positive, or fewer than 3 balls.
    """
    load = require_positive("radial_load", radial_load)
    if isinstance(balls, bool) or not isinstance(balls, int) or balls < 3:
        raise InputError("balls", balls, "a whole number >= 3")
    return load / sum(max(cos(2.0 * pi * k / balls), 0.0) ** 2.5 for k in range(balls))
