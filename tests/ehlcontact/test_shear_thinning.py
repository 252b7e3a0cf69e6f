"""Films that sliding thins: viscosities against the flow resolved across the film, limits, and what is refused."""

import math
from functools import cache

import numpy as np
import pytest
from refusals import refusals
from scipy.optimize import brentq

from ehlcontact import (
    Asperities,
    Domain,
    Geometry,
    Grid,
    Heat,
    InputError,
    Lubricant,
    MoesPoint,
    OilLayer,
    OperatingPoint,
    ShearThinning,
    read,
    save,
    solve_steady,
)
from ehlcontact.lubricant import Carreau, Eyring, LimitingShear
from ehlcontact.solver.film_thinning import FilmThinning
from ehlcontact.solver.level import Level

OIL = Lubricant.iso_vg(68, temperature=50.0)
SMALL = Grid(64)
DISC = OperatingPoint.ball_on_flat(OIL, ball_diameter=19.05e-3, entrainment_speed=1.0, load=30.0)


@cache
def newtonian_film():
    return solve_steady(DISC, grid=SMALL)


@cache
def thin():
    return solve_steady(DISC, grid=SMALL, sliding=ShearThinning(1.5))


def rate(law, eta, stress):
    """Shear rate of a stress, by the law turned round."""
    newton = brentq(lambda ln: float(law.of(ln, 1.0)) - stress, -40.0, 60.0, xtol=1e-13)
    return math.exp(newton) / eta


def flow(law, eta, h, slide, gradient):
    """Volume flow along and across, less u h, of oil between walls, resolved over the gap by its own law.

    The stress is linear over the gap, (t_x + z p_x, t_y + z p_y); its middle follows from the speeds of the walls.
    """
    z = (np.arange(40) + 0.5) / 40 * h - 0.5 * h
    middle = np.array([float(law.of(math.log(eta * slide / h), 1.0)), 0.0])

    def rates(at):
        along, across = at[0] + gradient[0] * z, at[1] + gradient[1] * z
        size = np.hypot(along, across)
        share = np.array([rate(law, eta, one) for one in size]) / size
        return share * along, share * across

    for _ in range(6):  # Newton's method for the walls
        missing = np.array([one.mean() * h for one in rates(middle)]) - (slide, 0.0)
        step = 1e-5 * middle[0]
        slopes = np.column_stack(
            [
                (np.array([one.mean() * h for one in rates(middle + step * unit)]) - missing - (slide, 0.0)) / step
                for unit in np.eye(2)
            ]
        )
        middle = middle - np.linalg.solve(slopes, missing)
    # int u dz = [u z] - int z du/dz dz, with the walls alike about the mean
    return np.array([-(one * z).mean() * h for one in rates(middle)])


@pytest.mark.parametrize("law", [Eyring(5e6), Carreau(5e6, 0.4)], ids=lambda law: type(law).__name__)
@pytest.mark.parametrize("ratio", [0.3, 3.0, 100.0])
def test_viscosities_against_the_flow_over_the_gap(law, ratio):
    """A small gradient of pressure along and across beside the stress of sliding, eqs. 8 and 9."""
    eta, h = 2.0, 0.3e-6
    slide = ratio * 5e6 * h / eta
    small = 1e-3 * 5e6 / h
    along, across = law.thinning(math.log(eta * slide / h))
    q = [flow(law, eta, h, slide, (small, 0.0))[0], flow(law, eta, h, slide, (0.0, small))[1]]
    q[0] -= flow(law, eta, h, slide, (0.0, 0.0))[0]
    midpoint = 1.0 - 1.0 / 40**2  # of the sum over z^2 in place of its integral
    newton = -(h**3) * small / (12.0 * eta) * midpoint
    assert q[0] / newton == pytest.approx(math.exp(-along), rel=2e-3)
    assert q[1] / newton == pytest.approx(math.exp(-across), rel=2e-3)


@pytest.mark.parametrize("law", [Eyring(3e6), Carreau(3e6, 0.3), Carreau(3e6, 1.0)], ids=str)
def test_thinning_is_the_slope_and_the_ratio_of_the_law(law):
    """Over twenty decades; nothing thins without sliding."""
    x = np.linspace(-30.0, 30.0, 61)
    step = 1e-5
    slope = (law.of(x + step, 1.0) - law.of(x - step, 1.0)) / (np.exp(x + step) - np.exp(x - step))
    along, across = law.thinning(x)
    assert np.exp(along) == pytest.approx(slope, rel=1e-6, abs=0.0)
    assert np.exp(across) == pytest.approx(law.of(x, 1.0) / np.exp(x), rel=1e-9, abs=0.0)
    assert law.thinning(-math.inf) == (0.0, 0.0)


def test_film_solves_reynolds_equation_with_these_viscosities():
    """Residual of the thinned film with and without them, on a level of its own."""
    film = thin().dimensionless
    level = Level(film.point, film.domain, film.n, film.y.size - 1)
    level.P[...] = film.p.T
    inside = level.P > 0.0
    newtonian = np.abs(level.update(film.approach))[inside].mean()
    alone = type("Alone", (), {"finest": level, "set_aside": lambda self, ratio: set_aside(level, ratio)})()
    thinning = FilmThinning(alone, film.sliding.law, film.sliding.log_newton(film.point.eta0, DISC.scales))
    level.fields.flow.heat[...] = thinning.solve()
    assert np.abs(level.update(film.approach))[inside].mean() < 1e-3 * newtonian


def set_aside(level, ratio):
    """Viscosity along over that across between the lines."""
    level.fields.flow.aside[:-1] = np.exp(0.5 * (ratio[:-1] + ratio[1:]))


def test_film_falls_with_sliding():
    """Not by little of it; slightly by much."""
    shares = [
        solve_steady(DISC, grid=SMALL, sliding=ShearThinning(slide)).thinned_share for slide in (0.0, 0.02, 0.5)
    ]
    assert shares[0] == pytest.approx(1.0, abs=2e-5)
    assert shares[1] == pytest.approx(1.0, abs=1e-3)
    assert 0.985 < shares[2] < 0.998
    assert 0.94 < thin().thinned_share < 0.985
    assert thin().thinned_share == pytest.approx(thin().h_central / newtonian_film().h_central, rel=1e-4)
    newton = solve_steady(DISC, grid=SMALL, sliding=ShearThinning(0.5, Carreau(exponent=1.0)))
    assert newton.thinned_share == pytest.approx(1.0, abs=2e-5)


STARVED = [(60.0, 6.0), (40.0, 8.0), (200.0, 2.0), (100.0, 1.0), (200.0, 6.0)]  # N, m/s


@pytest.mark.long
@pytest.mark.parametrize(("load", "speed"), STARVED)
def test_starved_films_are_thinned(load, speed):
    """Much oil, little sliding, thin layers: the flooded film, the Newtonian one, the layer; no oil is lost."""
    point = OperatingPoint(Geometry.ball_bearing(7.94e-3, 38.5e-3, 0.52), OIL, load, speed)
    grid = Grid(128, Domain(x_in=-9.0))

    def film(slide=0.1, r=None, tol=1e-5):
        supply = None if r is None else OilLayer(over_flooded=r)
        sliding = None if slide is None else ShearThinning(slide)
        return solve_steady(point, grid=grid, supply=supply, sliding=sliding, tol=tol)

    flooded, starved = film(), film(r=0.8, tol=1e-7)
    assert film(r=1.5).thinned_share - 1.0 == pytest.approx(flooded.thinned_share - 1.0, rel=0.1, abs=0.0)
    assert film(slide=0.0, r=0.8).h_central == pytest.approx(film(slide=None, r=0.8).h_central, rel=3e-6, abs=0.0)
    assert abs(film(r=0.4).thinned_share - 1.0) < 0.02 * abs(flooded.thinned_share - 1.0)
    weights = np.r_[0.5, np.ones(starved.y.size - 2), 0.0]
    assert weights @ starved.layer_behind == pytest.approx(weights @ starved.layer, rel=1e-8, abs=0.0)


@pytest.mark.long
@pytest.mark.parametrize(("load", "speed"), STARVED)
def test_heated_films_are_thinned(load, speed):
    """Without a slope it is the thinned film, with little sliding the heated one; energy is closed."""
    point, grid = OperatingPoint(Geometry.ball_bearing(7.94e-3, 38.5e-3, 0.52), OIL, load, speed), Grid(64)

    def film(slide=0.5, heat=None):
        sliding = None if slide is None else ShearThinning(slide)
        return solve_steady(point, grid=grid, sliding=sliding, thermal=heat, tol=1e-7)

    both, thinned, heated = film(heat=True), film(), film(slide=None, heat=Heat(slide_roll=0.5))
    assert both.temperature.inputs.slide_roll == 0.5
    assert both.temperature.balance < 1e-6
    assert both.h_central < min(thinned.h_central, heated.h_central)
    assert film(heat=Heat(temperature_slope=0.0)).h_central == pytest.approx(thinned.h_central, rel=1e-6, abs=0.0)
    assert film(slide=1e-5, heat=True).h_central == pytest.approx(film(None, True).h_central, rel=1e-6, abs=0.0)


def test_slow_films_are_thinned_alone():
    slow = OperatingPoint.ball_on_flat(OIL, ball_diameter=19.05e-3, entrainment_speed=0.03, load=2.0)
    cold, warm = (
        solve_steady(slow, grid=SMALL, sliding=ShearThinning(1.0), thermal=heat) for heat in (None, True)
    )
    assert warm.h_central == pytest.approx(cold.h_central, rel=1e-3)


@pytest.mark.long
def test_starved_films_are_heated_and_thinned():
    """Oil and energy are balanced; the stress that heats is that of the law."""
    given = {"grid": Grid(128, Domain(x_in=-9.0)), "sliding": ShearThinning(0.5, Carreau(5e6, 0.5)), "tol": 1e-7}
    point = OperatingPoint(Geometry.ball_bearing(7.94e-3, 38.5e-3, 0.52), OIL, 60.0, 6.0)
    all_three = solve_steady(point, supply=OilLayer(over_flooded=0.8), thermal=True, **given)
    weights = np.r_[0.5, np.ones(all_three.y.size - 2), 0.0]
    assert weights @ all_three.layer_behind == pytest.approx(weights @ all_three.layer, rel=1e-8, abs=0.0)
    assert all_three.temperature.balance < 1e-6


@pytest.mark.parametrize("law", [Eyring(3e6), Carreau(3e6, 0.3)], ids=str)
def test_slopes_of_laws_are_differences(law):
    x, step = np.linspace(-12.0, 30.0, 43), 1e-6
    ahead, behind = (np.array(law.thinning(x + side * step)) for side in (1.0, -1.0))
    np.testing.assert_allclose(law.thinning_slopes(x), (ahead - behind) / (2.0 * step), atol=1e-8)
    ratio = x - math.log(3e6)
    stress, slope = law.reduced(ratio)
    np.testing.assert_allclose(3e6 * stress, law.of(x, 0.0), rtol=1e-12)
    ahead, behind = (law.reduced(ratio + side * step)[0] for side in (1.0, -1.0))
    np.testing.assert_allclose(slope, (ahead - behind) / (2.0 * step), rtol=1e-6, atol=3e-9)


def test_result(tmp_path):
    """Stored and shown; its traction is that of its own sliding."""
    again = read(save(thin(), tmp_path / "thin.h5"))
    assert again.sliding == thin().sliding
    assert again.thinned_share == thin().thinned_share
    assert "% of the Newtonian one" in repr(thin())
    assert thin().to_dict()["sliding"] == {"slide_roll": 1.5, "law": {"law": "Eyring", "stress": 5e6}}
    assert "sliding" not in newtonian_film().to_dict()
    found = thin().traction(1.5, Eyring()).coefficient
    assert found == pytest.approx(newtonian_film().traction(1.5, Eyring()).coefficient, rel=0.01)
    with pytest.raises(InputError, match=r"slide_roll and law = 0\.1: must be 1\.5 and Eyring"):
        thin().traction(0.1, Eyring())
    with pytest.raises(InputError, match="slide_roll and law"):
        thin().traction(1.5, Eyring(4e6))


test_bad_input = refusals(
    (lambda: ShearThinning(-0.1), "slide_roll = -0.1: must be between 0 and 2"),
    (lambda: ShearThinning(5.0), "slide_roll = 5.0: must be between 0 and 2"),
    (lambda: ShearThinning(math.nan), "slide_roll = nan"),
    (lambda: ShearThinning(0.1, 5e6), "law = 5000000.0: must be a traction law"),
    (lambda: ShearThinning(0.1, LimitingShear()), "law = 'LimitingShear': must be Eyring or Carreau"),
    (lambda: solve_steady(DISC, sliding=0.1), "sliding = 0.1: must be a ShearThinning"),
    (lambda: solve_steady(MoesPoint(20.0, 10.0, 1.0), sliding=ShearThinning(0.1)), "sliding = .*pascals"),
    (
        lambda: solve_steady(DISC, sliding=ShearThinning(0.1), thermal=Heat(slide_roll=0.2)),
        "slide_roll = 0.2: must be left out of thermal with sliding, or 0.1 as there",
    ),
    (
        lambda: solve_steady(DISC, sliding=ShearThinning(1.5), thermal=True),
        "slide_roll of sliding = 1.5: must be between -1 and 1: near 2 one surface stands still",
    ),
    (
        lambda: solve_steady(DISC, sliding=ShearThinning(0.1), asperities=Asperities(1e-7)),
        "sliding = .*asperities",
    ),
)
