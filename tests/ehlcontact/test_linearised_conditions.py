"""Linearised films under conditions: at rest, differences of neighbouring steady films."""

import numpy as np
import pytest

from ehlcontact import Grid, Heat, Lubricant, OilLayer, OperatingPoint, ShearThinning, solve_steady
from ehlcontact.linearised_film import held, linearised
from ehlcontact.lubricant import Carreau

OIL = Lubricant.iso_vg(68, temperature=50.0)
BALL = OperatingPoint.ball_bearing(
    OIL, ball_diameter=7.938e-3, pitch_diameter=39.1e-3, conformity=0.52, speed_rpm=3000, load=200
)
STEP = 2e-5  # dry approaches
THIN = {"sliding": ShearThinning(0.5)}
CONDITIONS = {
    "flooded": {},
    "thinned": THIN,
    "by Carreau": {"sliding": ShearThinning(0.5, Carreau(5e6, 0.5))},
    "heated": {"thermal": Heat(slide_roll=0.5)},
    "heated and thinned": THIN | {"thermal": True},
    "starved and thinned": THIN | {"supply": OilLayer(over_flooded=0.9)},
    "all": THIN | {"supply": OilLayer(over_flooded=0.9), "thermal": True},
}


@pytest.mark.long
@pytest.mark.parametrize("name", CONDITIONS)
def test_stiffness_at_rest_is_that_of_neighbours(name):
    given = CONDITIONS[name]
    film = solve_steady(BALL, grid=Grid(64), tol=1e-8, **given)
    contact = linearised(film, held(film))
    Z, residual = contact.respond(np.array([1e-4]), 1e-6)
    if film.layer is not None:
        given = given | {"supply": OilLayer(H=float(film.layer[0]))}
    given = given | {"grid": Grid(64, film.domain), "tol": 1e-9, "throw": False}
    sides = [solve_steady(BALL, approach=film.approach + side, **given) for side in (STEP, -STEP)]
    slope = (sides[0].force - sides[1].force) / (2.0 * STEP)
    assert Z[0].real == pytest.approx(slope, rel=1e-6) and residual[0] < 1e-6
    if "thermal" in given:
        still = contact.still().respond(np.array([1e-4]), 1e-6)[0]
        assert abs(still[0].real / slope - 1.0) > 1e-5
