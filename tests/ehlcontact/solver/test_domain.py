"""Region and grid size."""

import pytest

from ehlcontact import Domain, InputError
from ehlcontact.solver.domain import check_intervals

NAN, INF = float("nan"), float("inf")


def test_default_is_the_documented_region():
    assert Domain().as_tuple() == (-4.5, 1.5, 3.0)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        *(("x_in", v) for v in (-1.0, 0.0, -101.0, NAN, -INF, None, "far", True)),
        *(("x_out", v) for v in (1.0, 0.0, -2.0, 101.0, NAN, INF, None, True)),
        *(("y_max", v) for v in (1.0, 0.0, -2.0, 101.0, NAN, INF, [3.0, 4.0], False)),
    ],
)
def test_bad_bound_is_named(field, value):
    with pytest.raises(InputError, match=f"^{field} = .*: must be ") as caught:
        Domain(**{field: value})
    assert caught.value.field == field


@pytest.mark.parametrize("load", [0.2, 1.0, 1.2])
def test_usual_loads_need_no_wider_region(load):
    assert Domain.for_load(load) == Domain()


def test_region_grows_with_the_hertz_ellipse():
    wide = Domain.for_load(8.0)  # ellipse twice as large
    assert wide.x_in == pytest.approx(-5.5)
    assert wide.x_out == pytest.approx(4.5)
    assert wide.y_max == pytest.approx(5.0)
    assert wide.x_out > 2.0 * Domain().x_out / 1.5  # the outlet still lies beyond the ellipse


@pytest.mark.parametrize("n", [16, 64, 2048, 48])
def test_good_grid(n):
    assert check_intervals(n) == n


@pytest.mark.parametrize("n", [0, -16, 8, 15, 100, 2064, 64.5, True])
def test_bad_grid_is_named(n):
    with pytest.raises(InputError, match=r"^n = .*: must be a multiple of 16 between 16 and 2048"):
        check_intervals(n)
