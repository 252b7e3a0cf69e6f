"""Richardson's extrapolation: only where three grids show the second order."""

import numpy as np
import pytest

from ehlcontact.cli.paper.tables import SEEN, limit


def on_grids(value, error, order):
    """A made-up number of that order on meshes halved twice."""
    return [value + error * 2.0 ** (-order * level) for level in range(3)]


@pytest.mark.parametrize(("value", "error"), [(0.87, 0.01), (0.87, -0.01), (1.5, 0.3), (0.011, 1e-4)])
def test_second_order_is_used(value, error):
    found = limit(on_grids(value, error, 2.0))
    assert found.order == pytest.approx(2.0)
    assert found.extrapolated == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize("order", [0.5, 1.0, 1.7, 2.3, 3.0, 3.5])
def test_another_order_is_not(order):
    found = limit(on_grids(0.87, 0.01, order))
    assert found.order == pytest.approx(order) and found.extrapolated is None
    assert found.verdict == f"{order:g}"


@pytest.mark.parametrize(
    "values",
    [
        (0.88, 0.87, 0.875),  # turns back
        (0.87, 0.88, 0.895),  # grows
        (0.87, 0.88, 0.89),  # does not shrink
        (0.87, 0.87, 0.87),
        (0.88, 0.87, 0.87),
    ],
)
def test_no_order_at_all(values):
    found = limit(values)
    assert (found.order, found.extrapolated, found.verdict) == (None, None, "none")


@pytest.mark.parametrize("missing", [0, 1, 2])
def test_a_missing_grid_is_no_evidence(missing):
    values = on_grids(0.87, 0.01, 2.0)
    values[missing] = None
    found = limit(values)
    assert (found.order, found.extrapolated, found.verdict) == (None, None, "-")


def test_what_is_extrapolated_is_five_times_nearer():
    """The reason of the band: whatever order in it goes on, the extrapolated number beats the finest grid."""
    for order in np.linspace(SEEN[0] + 1e-9, SEEN[1] - 1e-9, 9):
        values = on_grids(0.87, 0.01, order)
        assert abs(limit(values).extrapolated - 0.87) < abs(values[-1] - 0.87) / 5.0


def test_roots_of_table_3_are_left_alone():
    """On n = 32, 64, 128 and 256: what two grids were extrapolated to was further off than the finer grid."""
    root = {32: 0.88144, 64: 0.86823, 128: 0.86700, 256: 0.86689}  # case 1
    assert abs((4.0 * root[64] - root[32]) / 3.0 - root[256]) > 2.0 * abs(root[64] - root[256])
    assert limit([None, root[32], root[64]]).extrapolated is None
    assert limit([root[n] for n in (32, 64, 128)]).extrapolated is None
