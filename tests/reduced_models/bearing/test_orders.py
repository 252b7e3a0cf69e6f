"""Defect orders under load with slip of the cage, against speeds of points on balls and races."""

import numpy as np
import pytest
from refusals import refusals

from ehlcontact import Lubricant
from reduced_models import BallBearing
from reduced_models.bearing.kinematics import DefectOrders
from reduced_models.bearing.measured_order import angle_from_order, clearance_from_order

DRY = BallBearing.catalogue("6205", clearance=8e-6)


@pytest.mark.parametrize("degrees", [0.0, 12.0, 40.0])
@pytest.mark.parametrize("slip", [0.03, -0.002])
def test_slip_by_surface_speeds(degrees, slip):
    """Points of both races pass the ball at its two contacts; its surface has the mean of their speeds."""
    balls, D, pitch, angle = 9, 7.94e-3, 39.04e-3, np.radians(degrees)
    found = DefectOrders.of(balls, D / pitch, np.cos(angle)).with_slip(slip)
    inner, outer = (0.5 * (pitch + side * D * np.cos(angle)) for side in (-1.0, 1.0))
    cage = inner / (inner + outer) * (1.0 - slip)
    speeds = (1.0 - cage) * inner, cage * outer
    assert found.ftf_order == pytest.approx(cage, rel=1e-12)
    assert (found.bpfo_order, found.bpfi_order) == pytest.approx((balls * cage, balls * (1.0 - cage)), rel=1e-12)
    assert found.bsf_order == pytest.approx(np.mean(speeds) / (0.5 * D), rel=1e-12)


def test_orders_under_load():
    """Those of the state; the mean of the balls' own angles to first order; nothing changes without axial load."""
    found, state = DRY.orders_under(30.0, axial=32.0), DRY.equilibrium((0.0, -30.0, 32.0))
    assert found == state.orders == DRY.orders_under((0.0, -30.0, 32.0))
    angle = np.average(state.contact_angles.mean(axis=1), weights=state.force[:, 0])
    by_mean = DefectOrders.of(9, DRY.gamma, np.cos(angle))
    assert found.bpfo_order == pytest.approx(by_mean.bpfo_order, rel=2e-5)
    assert found.bpfo_order - DRY.orders.bpfo_order > 0.01
    assert DRY.orders_under(300.0) == DRY.orders
    slower = DRY.orders_under(30.0, axial=32.0, slip=0.01)
    assert slower.bpfo_order == pytest.approx(0.99 * found.bpfo_order)
    assert slower.bpfi_order + slower.bpfo_order == pytest.approx(9.0)


def test_slip_is_taken_out_of_a_measured_order():
    orders = DRY.orders_under(5.0, axial=20.0, slip=0.004)
    for order in ({"bpfo_order": orders.bpfo_order}, {"bpfi_order": orders.bpfi_order}):
        found = clearance_from_order(DRY, 20.0, **order, slip=0.004, radial=5.0)
        assert found.value == pytest.approx([8e-6], abs=2e-10)
    rolling = angle_from_order(DRY, bpfo_order=3.6, error=5e-4)
    slipping = angle_from_order(DRY, bpfo_order=3.6 * 0.99, error=5e-4 * 0.99, slip=0.01)
    assert tuple(slipping) == pytest.approx(tuple(rolling), rel=1e-9)


test_bad_input_is_one_line = refusals(
    (lambda: DRY.orders_under(30.0, slip=1.0), "slip = 1.0: must be above -0.5 and below 1"),
    (lambda: DRY.orders_under(30.0, slip=float("nan")), "slip = nan"),
    (lambda: DRY.orders_under((0.0, -30.0, 5.0), axial=3.0), "axial = 3.0: must be left out"),
    (lambda: DRY.orders_under(float("nan")), "load = nan"),
    (lambda: angle_from_order(DRY, bpfo_order=3.6, slip=2.0), "slip = 2.0"),
)


@pytest.mark.slow
def test_films_lower_bpfo():
    """Films lift the balls and so lower contact angle and BPFO: by four times the error of a measured order."""
    oily = BallBearing.catalogue("6205", clearance=8e-6, oil=Lubricant.iso_vg(68, temperature=50.0))
    dry, found = (one.orders_under(30.0, axial=32.0, speed_rpm=1797.0).bpfo_order for one in (DRY, oily))
    assert dry - found == pytest.approx(0.0019, abs=1e-4)
