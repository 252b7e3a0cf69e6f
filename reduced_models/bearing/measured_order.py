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
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.grooves import LARGEST_ANGLE, LARGEST_PLAY
from reduced_models.bearing.kinematics import DefectOrders

_Floats = NDArray[np.float64]

SHARPEST = 1e-12  # m, of a clearance that is searched
BEYOND = 1.2  # times the clearance of the free angle, up to which it is searched


class Interval(NamedTuple):
    """A value and the bounds that the error of the measurement leaves; numbers, or arrays of one shape."""

    value: float | _Floats
    low: float | _Floats
    high: float | _Floats


@takes(bearing=Object(BallBearing, "a BallBearing"))
def angle_from_order(
    bearing: BallBearing,
    *,
    bpfo_order: float | None = None,
    bpfi_order: float | None = None,
    error: float = 0.0,
    slip: float = 0.0,
) -> Interval:
    """Mean contact angle [rad] of a measured order, whatever clearance the bearing has.

    Parameters
    ----------
    bearing : BallBearing
    bpfo_order, bpfi_order : float
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
    name, order, outer = _outer_order(bearing, bpfo_order, bpfi_order)
    slower = bearing.orders.with_slip(slip, bearing.ring_speeds).bpfo_order / bearing.orders.bpfo_order
    outer, reach = outer / slower, require_nonnegative("error", error) / slower
    least, most = _order(bearing, 0.0), _order(bearing, LARGEST_ANGLE)
    if not least - reach <= outer <= most:
        low, high = slower * least, slower * most
        if name == "bpfi_order":
            low, high = bearing.balls - high, bearing.balls - low
        raise InputError(name, order, f"between {low:.5g} and {high:.5g}: contact angles from 0 to 45 degrees")
    if outer + reach > most:
        allowed = f"at most {slower * (most - outer):.4g}: a larger one allows contact angles above 45 degrees"
        raise InputError("error", error, allowed)
    value, low, high = (_angle(bearing, outer + part) for part in (0.0, -reach, reach))
    return Interval(value, low, high)


@takes(bearing=Object(BallBearing, "a BallBearing"), axial="N", radial="N", speed_rpm="rev/min")
def clearance_from_order(
    bearing: BallBearing,
    axial: ArrayLike,
    *,
    bpfo_order: float | None = None,
    bpfi_order: float | None = None,
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
    bpfo_order, bpfi_order, error, slip
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
    angles = angle_from_order(bearing, bpfo_order=bpfo_order, bpfi_order=bpfi_order, error=error, slip=slip)
    solved = {
        angle: [_clearance(bearing, (0.0, -radial, one), speed_rpm, angle) for one in loads.tolist()]
        for angle in {float(angle) for angle in angles}
    }
    value, low, high = (np.array(solved[float(angle)]) for angle in angles)
    return Interval(value, np.where(np.isnan(low) & np.isfinite(high), 0.0, low), high)


def _outer_order(
    bearing: BallBearing, bpfo_order: float | None, bpfi_order: float | None
) -> tuple[str, float, float]:
    """Name and value of the order that is given, and the order of the outer race."""
    if (bpfo_order is None) == (bpfi_order is None):
        both = None if bpfo_order is None else "bpfo_order and bpfi_order"
        raise InputError("order", both, "given once, as bpfo_order or bpfi_order")
    name, order = ("bpfo_order", bpfo_order) if bpfo_order is not None else ("bpfi_order", bpfi_order)
    value = require_finite(name, order)
    return name, value, value if bpfo_order is not None else bearing.balls - value


def _order(bearing: BallBearing, angle: float) -> float:
    return DefectOrders.of(bearing.balls, bearing.gamma, cos(angle)).bpfo_order


def _angle(bearing: BallBearing, order: float) -> float:
    cosine = (1.0 - 2.0 * order / bearing.balls) / bearing.gamma
    return acos(min(cosine, 1.0))


def _clearance(bearing: BallBearing, load: tuple[float, ...], speed_rpm: float, angle: float) -> float:
    """Clearance [m] with which BPFO under a load is that of a contact angle; not a number where there is none."""
    wanted = _order(bearing, angle)

    def above(clearance: float) -> float:
        try:
            orders = replace(bearing, clearance=clearance).equilibrium(load, speed_rpm=speed_rpm).orders
        except InputError as error:
            if error.field != "load" or load[1] != 0.0:
                raise
            raise InputError("axial", load[2], error.allowed) from None
        assert orders is not None  # axial load presses balls
        return orders.bpfo_order - wanted

    distance = (bearing.conformity_inner + bearing.conformity_outer - 1.0) * bearing.ball_diameter
    # with the clearance of the free angle any load leads to a larger one, but for the inertia of balls
    most = min(BEYOND * (2.0 * distance * (1.0 - cos(angle))), LARGEST_PLAY * bearing.ball_diameter)
    if most <= SHARPEST or above(0.0) > 0.0 or above(most) < 0.0:
        return np.nan
    return float(scipy.optimize.brentq(above, 0.0, most, xtol=SHARPEST))
