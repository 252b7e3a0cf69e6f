"""Traction of films: laws and sums against slow twins, their limits, one curve of Eyring's points, bad input."""

import math
from functools import cache

import numpy as np
import pytest
from balls import LARGE
from programs import script
from refusals import refusals

from ehlcontact import (
    Geometry,
    Grid,
    Heat,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    read,
    save,
    solve_steady,
)
from ehlcontact.lubricant import Carreau, Eyring, LimitingShear
from ehlcontact.lubricant.traction_laws import TractionLaw
from ehlcontact.traction import traction_curve

OIL = Lubricant.iso_vg(68, temperature=50.0)
SMALL = Grid(64)
POINT = OperatingPoint.ball_bearing(
    OIL, ball_diameter=7.938e-3, pitch_diameter=39.1e-3, conformity=0.52, speed_rpm=3000.0, load=50.0
)
LAWS = (Eyring(), Carreau(2e6, 0.4), LimitingShear(0.05, 1e6))


@cache
def isothermal_film():
    return solve_steady(POINT, grid=SMALL)


def twin_stress(law, newton, p):
    """Stress of a law as textbooks write it."""
    if isinstance(law, Eyring):
        return law.stress * math.asinh(newton / law.stress)
    if isinstance(law, Carreau):
        return newton * (1.0 + (newton / law.stress) ** 2) ** (0.5 * (law.exponent - 1.0))
    most = law.base + law.coefficient * p
    return most * (1.0 - math.exp(-newton / most))


def twin_force(film, ratio, law):
    """Traction of a film by loops over its nodes, with Roelands' law written out in SI, both halves of y."""
    oil = POINT.lubricant
    z = oil.alpha * 1.96e8 / (math.log(oil.eta0) + 9.67)
    dx, dy = film.x[1] - film.x[0], film.y[1] - film.y[0]
    total = 0.0
    for i, row in enumerate(film.p):
        for j, p in enumerate(row):
            if p <= 0.0:
                continue
            h = film.h[i, j]
            log_eta = (math.log(oil.eta0) + 9.67) * (1.0 + p / 1.96e8) ** z
            if film.temperature is not None:
                heat = film.temperature.inputs
                cold = heat.temperature + 135.0
                slope = heat.temperature_slope * cold / (math.log(oil.eta0) + 9.67)
                log_eta *= ((cold + film.temperature.mean[i, j]) / cold) ** -slope
            newton = math.exp(log_eta - 9.67) * ratio * 0.5 * POINT.u_sum / h
            total += (1.0 if j == 0 else 2.0) * dx * dy * twin_stress(law, newton, p)
    return total


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_laws_against_their_twins(law):
    """Over twelve decades; Newtonian for little sliding."""
    p = 0.7e9
    newton = np.geomspace(1.0, 1e12, 49)
    expected = [twin_stress(law, one, p) for one in newton]
    assert law.of(np.log(newton), p) == pytest.approx(expected, rel=1e-9)
    assert law.of(math.log(1e3), p) == pytest.approx(1e3, rel=1e-3)
    assert law.of(-math.inf, p) == 0.0
    assert TractionLaw.from_dict(law.to_dict()) == law


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_force_against_its_twin(law):
    """Sum over the film, its power and its mean stress."""
    found = isothermal_film().traction([1e-4, 0.05, 2.0], law)
    expected = [twin_force(isothermal_film(), ratio, law) for ratio in found.slide_roll]
    assert found.force == pytest.approx(expected, rel=1e-9)
    assert found.coefficient == pytest.approx(found.force / 50.0, rel=1e-6)
    assert found.power == pytest.approx(found.force * found.slide_roll * 0.5 * POINT.u_sum)
    s = POINT.scales
    assert found.mean_stress == pytest.approx(found.force / (math.pi * s.a * s.b))
    assert found.stress[isothermal_film().p == 0.0].max() == 0.0


def test_limits():
    """No sliding, no traction; a limiting stress is approached from below, and reached under all of the load."""
    law = LimitingShear(0.05)
    curve = isothermal_film().traction([0.0, *np.geomspace(1e-6, 2.0, 20)], law)
    assert curve.force[0] == curve.power[0] == 0.0
    assert (np.diff(curve.coefficient) > 0.0).all()
    assert curve.limit == pytest.approx(0.05, rel=1e-3)  # of the pressure's sum, which is the load
    assert 0.9 * curve.limit < curve.coefficient[-1] < curve.limit
    heavy = solve_steady(
        OperatingPoint.ball_bearing(
            OIL, ball_diameter=7.938e-3, pitch_diameter=39.1e-3, conformity=0.52, speed_rpm=1000.0, load=300.0
        ),
        grid=SMALL,
    ).traction(2.0, law)
    assert heavy.coefficient[0] > 0.97 * heavy.limit
    assert isothermal_film().traction(0.1, Eyring()).limit == math.inf


def test_heated_isothermal_film():
    """Viscosity follows the temperatures; at much sliding heat takes traction. One film for each ratio."""
    curve = traction_curve(POINT, [0.001, 0.3], Eyring(), thermal=Heat(), grid=SMALL)
    cold = isothermal_film().traction(curve.slide_roll, Eyring())
    share = curve.coefficient / cold.coefficient
    assert 0.9 < share[0] < 1.0
    assert share[1] < 0.9
    assert curve.warming[1] > curve.warming[0]
    warm = solve_steady(POINT, grid=SMALL, thermal=Heat(slide_roll=0.3))
    assert curve.force[1] == pytest.approx(twin_force(warm, 0.3, Eyring()), rel=1e-9)
    with pytest.raises(InputError, match=r"slide_roll = 0\.1: must be 0\.3, as of this heated film"):
        warm.traction(0.1, Eyring())
    with pytest.raises(InputError, match=r"law = 'Carreau'.*Eyring with thermal"):
        traction_curve(POINT, 0.1, Carreau(), thermal=Heat())


def test_one_curve():
    """Films that the exponents of docs/notes/traction.md were not fitted to fall on asinh within 5 %."""
    points = (
        OperatingPoint.ball_bearing(
            Lubricant.iso_vg(100, temperature=40.0),
            **LARGE | {"conformity": 0.53},
            speed_rpm=500.0,
            load=700.0,
            race="outer",
        ),
        OperatingPoint.ball_on_flat(
            Lubricant(0.02, 1.5e-8, viscosity="barus"), ball_diameter=25e-3, entrainment_speed=0.5, load=50.0
        ),
        OperatingPoint(Geometry(radius_x=15e-3, radius_y=12e-3), Lubricant(0.05, 2e-8), 80.0, 1.0),
    )
    module = script("docs/site/traction.py")
    rows = module.curve([solve_steady(point, grid=Grid(128)) for point in points], np.geomspace(1e-4, 2.0, 7))
    _, shear, stress = rows.T
    assert (rows[:, 0] > module.HEAVY).all()
    assert stress.max() / stress.min() > 50.0
    assert stress == pytest.approx(np.arcsinh(shear), rel=0.05)


def test_result(tmp_path):
    """It is stored, drawn, and listed."""
    found = isothermal_film().traction([0.01, 0.1], LimitingShear(0.04))
    again = read(save(found, tmp_path / "traction.h5"))
    assert again.law == found.law
    assert (again.force == found.force).all()
    assert (again.stress == found.stress).all()
    assert found.to_dict()["law"] == {"law": "LimitingShear", "coefficient": 0.04, "base": 0.0}
    assert isothermal_film().traction(0.1, Eyring()).to_dict()["limit"] is None
    found.plot(tmp_path / "traction.png")
    assert "at most 0.04" in repr(found)


test_bad_input = refusals(
    (lambda: isothermal_film().traction(-0.1, Eyring()), "slide_roll = -0.1: must be between 0 and 2"),
    (
        lambda: isothermal_film().traction([0.1, 5.0], Eyring()),
        "slide_roll = 5.0: must be between 0 and 2.*per cent",
    ),
    (
        lambda: isothermal_film().traction(math.nan, Eyring()),
        r"slide_roll\[0\] = nan: must be a finite number",
    ),
    (lambda: isothermal_film().traction([], Eyring()), "length of slide_roll = 0"),
    (lambda: isothermal_film().traction(0.1, 5e6), "law = 5000000.0: must be a traction law"),
    (lambda: Eyring(5.0), r"stress = 5.0: .*in MPa\? then 5e\+06 Pa"),
    (lambda: Eyring(0.0), "stress = 0.0: must be between"),
    (lambda: Eyring(math.inf), "stress = inf: must be between"),
    (lambda: Carreau(-5e6), "stress = -5000000.0: must be between"),
    (lambda: Carreau(exponent=1.5), "exponent = 1.5: must be between 0.01 and 1"),
    (lambda: LimitingShear(5.0), "coefficient = 5.0: must be between 0.001 and 0.5"),
    (lambda: LimitingShear(0.05, -1.0), "base = -1.0: must be between"),
    (lambda: LimitingShear(math.nan), "coefficient = nan: must be between"),
    (lambda: TractionLaw.from_dict({"law": "Ree"}), "law = 'Ree': must be one of Eyring, Carreau"),
    (lambda: traction_curve(MoesPoint(20.0, 10.0, 1.0), 0.1, Eyring()), "point = 'MoesPoint'.*no units"),
    (lambda: traction_curve(POINT, 0.1, Eyring(), thermal="hot"), "thermal = 'hot': must be True or a Heat"),
)


def test_films_that_have_no_traction():
    """A dimensionless film has no pascals; one that has not converged is no film."""
    film = solve_steady(MoesPoint(20.0, 10.0, 1.0), grid=Grid(32))
    with pytest.raises(InputError, match=r"traction = 'asked for'.*no units"):
        film.traction(0.1, Eyring())
    half = solve_steady(POINT, grid=SMALL, max_cycles=1, throw=False)
    with pytest.raises(InputError, match=r"film = .*converged"):
        half.traction(0.1, Eyring())
