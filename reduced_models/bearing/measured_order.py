"""Contact angle and clearance from a measured defect order, with the interval that its error leaves.

The cage turns (1 - D/dm cos a)/2 times per turn of the shaft, so an order of an outer or an inner race gives the
mean contact angle a. An axial load and a clearance belong to it: smaller clearances to larger loads. Slip of the
cage lowers BPFO and raises BPFI as a smaller angle would: one order does not tell them apart, and neither do both,
whose sum is the number of balls. A slip that is known is taken out: BPFO over 1 - slip is that of rolling balls.
"""

from __future__ import annotations

from dataclasses import replace
from math import acos, cos
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_numbers, require_finite, require_nonnegative
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.grooves import LARGEST_ANGLE, LARGEST_PLAY
from reduced_models.bearing.kinematics import DefectFrequencies

_Floats = NDArray[np.float64]

SHARPEST = 1e-12  # m, of a clearance that is searched
BEYOND = 1.2  # times the clearance of the free angle, up to which it is searched


class Interval(NamedTuple):
    """A value and the bounds that the error of the measurement leaves; numbers, or arrays of one shape."""

    value: float | _Floats
    low: float | _Floats
    high: float | _Floats


def angle_from_order(
    bearing: BallBearing,
    *,
    bpfo: float | None = None,
    bpfi: float | None = None,
    error: float = 0.0,
    slip: float = 0.0,
) -> Interval:
    """Mean contact angle [rad] of a measured order, whatever clearance the bearing has.

    Parameters
    ----------
    bearing : BallBearing
    bpfo, bpfi : float
        Order of a defect of the outer or of the inner race, per turn of the shaft; one of them.
    error : float
        Of the order.
    slip : float
        By which share the cage turns slower than with balls that roll (0.01 for 1 %).

    Raises
    ------
    InputError
        No order or both; one that no contact angle up to 45 degrees has; an error that is negative, or that allows
        larger angles; a slip that is no share.
    """
    name, order, outer = _outer_order(bearing, bpfo, bpfi)
    slower = bearing.orders.with_slip(slip).ftf / bearing.orders.ftf
    outer, reach = outer / slower, require_nonnegative("error", error) / slower
    least, most = _bpfo(bearing, 0.0), _bpfo(bearing, LARGEST_ANGLE)
    if not least - reach <= outer <= most:
        low, high = slower * least, slower * most
        if name == "bpfi":
            low, high = bearing.balls - high, bearing.balls - low
        raise InputError(name, order, f"between {low:.5g} and {high:.5g}: contact angles from 0 to 45 degrees")
    if outer + reach > most:
        allowed = f"at most {slower * (most - outer):.4g}: a larger one allows contact angles above 45 degrees"
        raise InputError("error", error, allowed)
    value, low, high = (_angle(bearing, outer + part) for part in (0.0, -reach, reach))
    return Interval(value, low, high)


@takes(axial="N", radial="N", speed_rpm="rev/min")
def clearance_from_order(
    bearing: BallBearing,
    axial: ArrayLike,
    *,
    bpfo: float | None = None,
    bpfi: float | None = None,
    error: float = 0.0,
    slip: float = 0.0,
    radial: float = 0.0,
    speed_rpm: float = 0.0,
) -> Interval:
    """Clearances [m] with which a deep-groove bearing has a measured order under axial loads, shape (k,).

    Parameters
    ----------
    bearing : BallBearing
        A deep-groove bearing, of any clearance.
    axial : float or sequence of float
        Axial loads [N], above 0.
    bpfo, bpfi, error, slip
        As in `angle_from_order`.
    radial : float
        Radial load beside it [N].
    speed_rpm : float
        Speed of the shaft [rev/min], for films and the inertia of balls; 0 for a dry bearing only.

    Returns
    -------
    Interval
        Of arrays (k,). A lower bound below 0 is given as 0; not a number where no clearance has the order, as
        where the load alone, without clearance, has more.

    Raises
    ------
    InputError
        As `angle_from_order`; an angular contact bearing, whose clearance follows from its contact angle; loads
        that are not above 0, or that the bearing does not take.
    """
    if bearing.contact_angle is not None:
        raise InputError("contact_angle", bearing.contact_angle, "left out: a deep-groove bearing has a clearance")
    loads = np.atleast_1d(as_numbers("axial", axial))
    if loads.ndim != 1 or not loads.size or not (loads > 0.0).all():
        raise InputError("axial", loads.tolist(), "one load or a flat list, each > 0")
    require_nonnegative("radial", radial)
    angles = angle_from_order(bearing, bpfo=bpfo, bpfi=bpfi, error=error, slip=slip)
    solved = {
        angle: [_clearance(bearing, (0.0, -radial, one), speed_rpm, angle) for one in loads.tolist()]
        for angle in {float(angle) for angle in angles}
    }
    value, low, high = (np.array(solved[float(angle)]) for angle in angles)
    return Interval(value, np.where(np.isnan(low) & np.isfinite(high), 0.0, low), high)


def _outer_order(bearing: BallBearing, bpfo: float | None, bpfi: float | None) -> tuple[str, float, float]:
    """Name and value of the order that is given, and BPFO."""
    if (bpfo is None) == (bpfi is None):
        raise InputError("order", None if bpfo is None else "bpfo and bpfi", "given once, as bpfo or bpfi")
    name, order = ("bpfo", bpfo) if bpfo is not None else ("bpfi", bpfi)
    found = require_finite(name, order)
    return name, found, found if bpfo is not None else bearing.balls - found


def _bpfo(bearing: BallBearing, angle: float) -> float:
    return DefectFrequencies.of(bearing.balls, bearing.gamma, cos(angle)).bpfo


def _angle(bearing: BallBearing, bpfo: float) -> float:
    cosine = (1.0 - 2.0 * bpfo / bearing.balls) / bearing.gamma
    return acos(min(cosine, 1.0))


def _clearance(bearing: BallBearing, load: tuple[float, ...], speed_rpm: float, angle: float) -> float:
    """Clearance [m] with which BPFO under a load is that of a contact angle; not a number where there is none."""
    wanted = _bpfo(bearing, angle)

    def above(clearance: float) -> float:
        try:
            orders = replace(bearing, clearance=clearance).equilibrium(load, speed_rpm=speed_rpm).orders
        except InputError as error:
            if error.field != "load" or load[1] != 0.0:
                raise
            raise InputError("axial", load[2], error.allowed) from None
        assert orders is not None  # axial load presses balls
        return orders.bpfo - wanted

    distance = (bearing.conformity_inner + bearing.conformity_outer - 1.0) * bearing.ball_diameter
    # with the clearance of the free angle any load leads to a larger one, but for the inertia of balls
    most = min(BEYOND * (2.0 * distance * (1.0 - cos(angle))), LARGEST_PLAY * bearing.ball_diameter)
    if most <= SHARPEST or above(0.0) > 0.0 or above(most) < 0.0:
        return np.nan
    return float(scipy.optimize.brentq(above, 0.0, most, xtol=SHARPEST))
