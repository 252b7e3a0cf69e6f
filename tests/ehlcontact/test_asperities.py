"""Asperities beside a film: their law against sums over summits, films against the equations they solve."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import dblquad, quad

from ehlcontact import (
    Asperities,
    Grid,
    Lubricant,
    MoesPoint,
    OilLayer,
    OperatingPoint,
    read,
    save,
    solve_steady,
)
from ehlcontact.asperities import greenwood_tripp
from ehlcontact.errors import InputError
from ehlcontact.heat import Heat
from ehlcontact.hertz import hertz_contact
from ehlcontact.solver.level import Level

OIL = Lubricant.iso_vg(68, temperature=60.0)
GRID = Grid(64)
MODULUS = 2.26e11


def ball(speed_rpm=3000.0, load=480.0):
    return OperatingPoint.ball_bearing(
        OIL, ball_diameter=7.938e-3, pitch_diameter=39.04e-3, conformity=0.52, speed_rpm=speed_rpm, load=load
    )


@pytest.fixture(scope="module")
def smooth():
    return solve_steady(ball(), grid=GRID)


@pytest.fixture(scope="module")
def mixed():
    return solve_steady(ball(), grid=GRID, asperities=Asperities(0.2e-6))


@pytest.mark.parametrize("power", [1.5, 2.5])
@pytest.mark.parametrize("x", [-3.0, -0.5, 0.0, 1.0, 2.5, 4.0])
def test_the_function_is_its_integral(x, power):
    direct = quad(lambda s: (s - x) ** power * np.exp(-0.5 * s * s), x, x + 12.0, epsabs=0.0, epsrel=1e-11)[0]
    assert float(greenwood_tripp(x, power)) == pytest.approx(direct / sqrt(2.0 * pi), rel=1e-8, abs=0.0)


def test_the_function_is_near_its_usual_fit():
    """4.4086e-5 (4 - x)^6.804, widely used; source: as quoted in the literature on piston rings."""
    x = np.linspace(0.0, 2.0, 5)
    assert 4.4086e-5 * (4.0 - x) ** 6.804 == pytest.approx(greenwood_tripp(x), rel=0.15)
    assert greenwood_tripp(6.5) == 0.0


def test_the_pressure_is_the_sum_over_pairs_of_summits():
    """Paraboloids of radius beta with axes r apart press each other w - r^2/(4 beta) deep, as Hertz has it."""
    rough = Asperities(0.2e-6, summits=0.04, rq_over_radius=0.005)
    beta, sigma, gap = rough.rq / rough.rq_over_radius, rough.rq, 0.9 * rough.rq
    density = rough.summits / (beta * sigma)

    def of_pairs(r, s):  # with heights together s sigma, at a distance r
        deep = s * sigma - gap - r * r / (4.0 * beta)
        force = 4.0 / 3.0 * (0.5 * MODULUS) * sqrt(0.5 * beta) * max(deep, 0.0) ** 1.5
        return density**2 * 2.0 * pi * r * force * np.exp(-0.5 * s * s) / sqrt(2.0 * pi)

    most = lambda s: 2.0 * sqrt(beta * max(s * sigma - gap, 0.0))  # noqa: E731
    direct = dblquad(of_pairs, gap / sigma, 7.0, 0.0, most, epsrel=1e-7)[0]
    assert rough.pressure(gap, MODULUS) == pytest.approx(direct, rel=1e-5)


def test_stiffness_and_gap_belong_to_the_pressure():
    rough = Asperities(0.15e-6)
    for gap in (0.05e-6, 0.2e-6, 0.5e-6):
        by_step = (rough.pressure(gap - 1e-12, MODULUS) - rough.pressure(gap + 1e-12, MODULUS)) / 2e-12
        assert rough.stiffness(gap, MODULUS) == pytest.approx(by_step, rel=1e-5, abs=0.0)
        assert rough.gap(float(rough.pressure(gap, MODULUS)), MODULUS) == pytest.approx(gap, rel=1e-9, abs=0.0)
    assert rough.gap(1e-9, MODULUS) == 6.0 * rough.rq


def test_moments_of_a_profile():
    """All lengths twice as large: Rq and radius too, the product without unit the same."""
    one, two = Asperities.from_moments(1e-14, 1e-3, 1e9), Asperities.from_moments(4e-14, 1e-3, 0.25e9)
    assert two.rq == pytest.approx(2.0 * one.rq)
    assert (two.summits, two.rq_over_radius) == pytest.approx((one.summits, one.rq_over_radius))
    radius, density = one.rq / one.rq_over_radius, one.summits * one.rq_over_radius / one.rq**2
    assert radius == pytest.approx(0.375 * sqrt(pi / 1e9)) and density == pytest.approx(3.063e10, rel=1e-3)


def test_a_mixed_film_solves_its_equations(mixed):
    """Film, load and the law from the fields alone, with deflection and Reynolds' equation of a fresh level."""
    point, mixed = ball(), mixed.dimensionless
    rough = mixed.asperities
    level = Level(mixed.point, mixed.domain, mixed.n, mixed.y.size - 1)
    pressed = rough.pressure.T
    numbers = rough.inputs.numbers(point)
    law = numbers.unit * greenwood_tripp(mixed.h.T / numbers.rq)
    assert pressed == pytest.approx(law, abs=1e-5 * law.max())
    film = level.gap - mixed.approach + level.deflection(mixed.p.T + pressed)
    assert mixed.h.T == pytest.approx(film, abs=1e-9)
    both = [float(np.vdot(level.force_weights, P)) for P in (mixed.p.T, pressed)]
    assert sum(both) == pytest.approx(1.0, abs=1e-6) and mixed.force == pytest.approx(sum(both), abs=1e-12)
    assert rough.load_share == pytest.approx(both[1] / sum(both), rel=1e-9)
    level.P[...], level.H[...] = mixed.p.T, mixed.h.T
    level.update_residual()
    assert level.residual_norm() < 1e-2 * mixed.dry_residual


def test_asperities_take_load_and_lift_the_film(smooth, mixed):
    rough = mixed.asperities
    assert mixed.h_central > smooth.h_central and mixed.h_min > smooth.h_min
    assert rough.film_share == pytest.approx(mixed.h_central / smooth.h_central, rel=1e-4)
    assert rough.film_over_rq == pytest.approx(mixed.h_central / 0.2e-6)
    higher = solve_steady(ball(), grid=GRID, asperities=Asperities(0.3e-6)).asperities
    assert 0.003 < rough.load_share < higher.load_share < 0.05


def test_fine_surfaces_are_smooth(smooth):
    fine = solve_steady(ball(), grid=GRID, asperities=Asperities(5e-9))
    assert fine.asperities.load_share == 0.0
    assert fine.h_central == pytest.approx(smooth.h_central, rel=1e-5)
    assert fine.reservation == smooth.reservation


def test_strong_asperities_take_most_of_the_load():
    """A light contact on rough ones, where one follows the other by steps."""
    found = solve_steady(ball(load=15.0), grid=GRID, asperities=Asperities(0.3e-6, 0.2, 0.05))
    assert found.status.ok and found.asperities.load_share > 0.6
    assert found.force == pytest.approx(15.0, rel=1e-6)


def test_a_starved_film_shares_the_load_too():
    given = {"grid": GRID, "supply": OilLayer(0.25e-6), "asperities": Asperities(0.2e-6)}
    found, flooded = solve_steady(ball(), **given), solve_steady(ball(), **given | {"supply": None})
    assert found.h_central < flooded.h_central
    assert found.asperities.load_share > flooded.asperities.load_share


def test_the_share_without_a_solve(mixed):
    point, rough = ball(), mixed.asperities.inputs
    h = hertz_contact(point.load, point.geometry.radius_x, point.geometry.radius_y, point.geometry.e_reduced)
    mean = point.load / (pi * h.a * h.b)
    share = rough.load_share(mixed.h_central, mean, point.geometry.e_reduced)
    assert share == pytest.approx(mixed.asperities.load_share, rel=0.3)


HEATED = [(3000.0, 480.0), (3000.0, 100.0), (10_000.0, 480.0), (500.0, 200.0), (6000.0, 1000.0)]


@pytest.mark.long
@pytest.mark.parametrize(("speed", "load"), HEATED)
def test_asperities_beside_a_film_that_heats_up(speed, load):
    """Smooth surfaces, and an oil that heat hardly changes: each alone. Energy and load are closed."""
    point, rough = ball(speed, load), Asperities(0.1e-6)
    both = solve_steady(point, grid=GRID, asperities=rough, thermal=True)
    warm, cold = (solve_steady(point, grid=GRID, thermal=t) for t in (True, None))
    smooth = solve_steady(point, grid=GRID, asperities=Asperities(1e-9), thermal=True)
    assert smooth.h_central == pytest.approx(warm.h_central, rel=1e-6)
    assert smooth.temperature.mean == pytest.approx(warm.temperature.mean, rel=1e-5, abs=1e-9)
    faint = solve_steady(point, grid=GRID, asperities=rough, thermal=Heat(temperature_slope=1e-7))
    alone = solve_steady(point, grid=GRID, asperities=rough)
    assert faint.h_central == pytest.approx(alone.h_central, rel=1e-5)
    assert faint.asperities.load_share == pytest.approx(alone.asperities.load_share, rel=1e-4, abs=1e-12)
    assert both.force == pytest.approx(both.point.load, rel=1e-6)
    assert both.temperature.balance < 1e-6
    assert both.temperature.film_share == both.asperities.film_share
    assert both.asperities.load_share >= alone.asperities.load_share
    assert warm.h_central <= both.h_central * (1.0 + 1e-6) and warm.h_central < cold.h_central


def test_a_film_is_kept_with_its_asperities(mixed, tmp_path):
    again = read(save(mixed, tmp_path / "film.h5"))
    assert np.array_equal(again.asperities.pressure, mixed.asperities.pressure)
    assert again.to_dict() == mixed.to_dict() and again.asperities.inputs == mixed.asperities.inputs
    assert f"asperities carry {100.0 * mixed.asperities.load_share:.3g} %" in repr(mixed)


def test_a_film_thinner_than_the_model_says_so():
    found = solve_steady(ball(), grid=GRID, asperities=Asperities(0.5e-6))
    assert "asperities are a model from 0.5 Rq on" in found.reservation


@pytest.mark.parametrize(
    ("words", "call"),
    [
        ("rq = 0.1: must be up to 2e-05 m (given in um?)", lambda: Asperities(0.1)),
        ("rq = -1e-07", lambda: Asperities(-1e-7)),
        ("rq = nan", lambda: Asperities(np.nan)),
        ("summits = 3.0", lambda: Asperities(1e-7, summits=3.0)),
        ("rq_over_radius = 0.0", lambda: Asperities(1e-7, rq_over_radius=0.0)),
        ("m4 = -1.0", lambda: Asperities.from_moments(1e-14, 1e-3, -1.0)),
        ("pressure = 1000000000000.0", lambda: Asperities(1e-7).gap(1e12, MODULUS)),
        ("asperities = 1e-07", lambda: solve_steady(ball(), asperities=1e-7)),
        (
            "asperities = 'given': must be left out with heat of sliding",
            lambda: solve_steady(ball(), asperities=Asperities(1e-7), thermal=Heat(slide_roll=0.1)),
        ),
        (
            "left out at a dimensionless point",
            lambda: solve_steady(MoesPoint(20, 10, 1), asperities=Asperities(1e-7)),
        ),
    ],
)
def test_bad_input(words, call):
    with pytest.raises(InputError) as caught:
        call()
    assert words in str(caught.value)
