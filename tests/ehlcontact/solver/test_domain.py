"""Region and grid size."""

import numpy as np
import pytest

from ehlcontact import Domain
from ehlcontact.solver.domain import check_intervals


def test_default_is_the_documented_region():
    assert Domain().as_tuple() == (-4.5, 1.5, 3.0)


@pytest.mark.parametrize("load", [0.2, 1.0, 1.2])
def test_usual_loads_need_no_wider_region(load):
    assert Domain.for_load(load) == Domain()


def test_region_grows_with_the_hertz_ellipse():
    wide = Domain.for_load(8.0)  # ellipse twice as large
    assert wide.x_in == pytest.approx(-5.5)
    assert wide.x_out == pytest.approx(4.5)
    assert wide.y_max == pytest.approx(5.0)
    assert wide.x_out > 2.0 * Domain().x_out / 1.5  # the outlet still lies beyond the ellipse


@pytest.mark.parametrize("n", [16, 64, 2048, 48, np.int64(32)])
def test_good_grid(n):
    assert check_intervals(n) == n
