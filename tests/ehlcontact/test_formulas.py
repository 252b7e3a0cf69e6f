"""Published fits, against the values computed by hand from them."""

import pytest

from ehlcontact.formulas import nvm_central_film, wijnant_approach

pytestmark = pytest.mark.literature


@pytest.mark.parametrize(
    ("M", "L", "kappa", "expected"),
    [
        (20, 10, 1.0, 4.708),
        (58.07, 4.62, 1.0, 3.012),
        (200, 10, 1.0, 4.380),
        (1000, 10, 1.0, 4.035),
        (20, 0, 1.0, 1.448),
        (200, 10, 0.5, 5.195),
    ],
)
def test_nvm(M, L, kappa, expected):
    assert nvm_central_film(M, L, kappa) == pytest.approx(expected, abs=6e-4)


def test_nvm_is_continuous_at_l_zero():
    assert nvm_central_film(20, 1e-6, 1.0) == pytest.approx(nvm_central_film(20, 0.0, 1.0), rel=1e-4)


@pytest.mark.parametrize(
    ("M", "L", "kappa", "expected"),
    [(58.07, 4.62, 1.0, 0.8535), (200, 10, 1.0, 0.9224), (200, 10, 0.5, 0.8842), (26.159, 8.358, 1.0, 0.6573)],
)
def test_wijnant(M, L, kappa, expected):
    assert wijnant_approach(M, L, kappa) == pytest.approx(expected, abs=6e-5)
