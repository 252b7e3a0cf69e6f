"""Contact angle and clearance from measured orders: there and back, and orders of the CWRU bearings."""

import numpy as np
import pytest
from refusals import refusals

from ehlcontact import Lubricant
from reduced_models import BallBearing
from reduced_models.bearing.measured_order import angle_from_order, clearance_from_order

BEARING = BallBearing(balls=9, ball_diameter=7.94e-3, pitch_diameter=39.04e-3)
MEASURED = {
    "105": {"bpfi_order": 5.4021},
    "106": {"bpfi_order": 5.4030},
    "107": {"bpfi_order": 5.4021},
    "130": {"bpfo_order": 3.5970},
}
DEGREES = {"105": 9.7, "106": 9.4, "107": 9.7, "130": 9.4}
ERROR = 5e-4  # of an order


def test_angles_of_measured_orders():
    """The table of the CWRU bearings, in which every interval meets all others."""
    found = {name: angle_from_order(BEARING, **order, error=ERROR) for name, order in MEASURED.items()}
    for name, one in found.items():
        assert np.degrees(one.value) == pytest.approx(DEGREES[name], abs=0.06)
        assert 0.1 < np.degrees(one.high - one.low) < 0.5 and one.low < one.value < one.high
    assert max(one.low for one in found.values()) < min(one.high for one in found.values())


@pytest.mark.parametrize("clearance", [3e-6, 12e-6])
@pytest.mark.parametrize("speed", [0.0, pytest.param(1797.0, marks=pytest.mark.slow)])
def test_clearance_there_and_back(clearance, speed):
    oil = {"oil": Lubricant.iso_vg(68, temperature=50.0)} if speed else {}
    bearing = BallBearing(balls=9, ball_diameter=7.94e-3, pitch_diameter=39.04e-3, clearance=clearance, **oil)
    orders = bearing.equilibrium((0.0, -5.0, 20.0), speed_rpm=speed).orders
    for order in ({"bpfo_order": orders.bpfo_order}, {"bpfi_order": orders.bpfi_order}):
        found = clearance_from_order(bearing, 20.0, **order, radial=5.0, speed_rpm=speed)
        assert found.value == pytest.approx([clearance], abs=2e-10)
        np.testing.assert_array_equal(found.low, found.value)


def test_curves_of_clearance_over_load():
    """7.9, 6.8 and 5.6 um at 9.6 degrees; those of the four files overlap within the error of their orders."""
    loads = [5.0, 15.0, 30.0]
    order = 9 * 0.5 * (1.0 - BEARING.gamma * np.cos(np.radians(9.6)))
    assert 1e6 * clearance_from_order(BEARING, loads, bpfo_order=order).value == pytest.approx(
        [7.9, 6.8, 5.6], abs=0.06
    )
    files = [MEASURED[name] for name in ("105", "106", "130")]  # 107 has the order of 105
    found = [clearance_from_order(BEARING, loads[::2], **order, error=ERROR) for order in files]
    for one in found:
        assert (np.diff(one.value) < 0.0).all() and (one.low < one.value).all() and (one.value < one.high).all()
    assert (np.max([one.low for one in found], axis=0) < np.min([one.high for one in found], axis=0)).all()


def test_a_load_that_needs_no_clearance():
    """At 60 N the bearing without clearance has an angle already: smaller ones have no clearance."""
    alone = BEARING.equilibrium((0.0, 0.0, 60.0)).orders.bpfo_order
    assert np.isnan(clearance_from_order(BEARING, 60.0, bpfo_order=alone - 1e-3).value).all()
    found = clearance_from_order(BEARING, 60.0, bpfo_order=alone + 1e-4, error=1e-3)
    assert found.low[0] == 0.0 < found.value[0] < found.high[0]


test_bad_input_is_one_line = refusals(
    (lambda: angle_from_order(BEARING), "order = None: must be given once"),
    (
        lambda: angle_from_order(BEARING, bpfo_order=3.6, bpfi_order=5.4),
        "order = 'bpfo_order and bpfi_order': must be given once",
    ),
    (lambda: angle_from_order(BEARING, bpfo_order=3.5), r"bpfo_order = 3.5: must be between 3.58\d+ and 3.8"),
    (lambda: angle_from_order(BEARING, bpfi_order=5.5), r"bpfi_order = 5.5: must be between 5.1\d+ and 5.41"),
    (
        lambda: angle_from_order(BEARING, bpfi_order=162.0, error=0.5),
        r"bpfi_order = 162.0: must be between 5.1\d+ and 5.41",
    ),
    (lambda: angle_from_order(BEARING, bpfo_order=3.6, error=-1.0), "error = -1.0"),
    (lambda: angle_from_order(BEARING, bpfo_order=3.6, error=5.0), r"error = 5.0: must be at most 0.25\d*: .* 45"),
    (lambda: clearance_from_order(BEARING, [0.0], bpfo_order=3.6), "axial = .*each > 0"),
    (
        lambda: clearance_from_order(BEARING, [5.0, 5e4], bpfo_order=3.59),
        r"^axial = 50000\.0: must be such that a ball",
    ),
    (
        lambda: clearance_from_order(BallBearing.catalogue("7205 C"), 10.0, bpfo_order=3.6),
        "contact_angle = .*deep-groove",
    ),
)
