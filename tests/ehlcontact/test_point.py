"""Moes numbers, SI scales and the identities that tie them together."""

from dataclasses import replace
from math import pi

import oracles
import pytest
from balls import OF_6205

from ehlcontact import Geometry, InputError, Lubricant, MoesPoint, OperatingPoint
from ehlcontact.film_formulas import nvm_central_film
from ehlcontact.hertz import elliptic_integrals, most_loaded_ball, shape_factor
from ehlcontact.lubricant import density, log_viscosity
from ehlcontact.point import moes_point, scales_of


@pytest.fixture
def operating_point():
    return OperatingPoint(Geometry(0.004, 0.03, 2.1e11, 0.28, 7e10, 0.21), Lubricant(0.08, 1.9e-8), 60.0, 1.3)


@pytest.mark.literature
@pytest.mark.parametrize(
    ("kappa", "lam", "alpha_bar"), [(1.0, 0.009387, 21.31), (0.5, 0.015627, 15.4917)], ids=["circle", "half"]
)
def test_anchored_values(kappa, lam, alpha_bar):
    """M = 200, L = 10: values re-derived independently by hand."""
    point = MoesPoint(200, 10, kappa)
    assert point.lam == pytest.approx(lam, rel=2e-4)
    assert point.alpha_bar == pytest.approx(alpha_bar, rel=2e-4)


@pytest.mark.parametrize(("M", "L"), [(5.0, 3.0), (200.0, 10.0), (3000.0, 19.0)])
def test_circular_formulas(M, L):
    """Venner and Lubrecht's circular contact."""
    point = MoesPoint(M, L, 1.0)
    assert point.lam == pytest.approx((128.0 * pi**3 / (3.0 * M**4)) ** (1.0 / 3.0), rel=1e-12)
    assert point.alpha_bar == pytest.approx(L / pi * (1.5 * M) ** (1.0 / 3.0), rel=1e-12)
    assert point.film_to_moes == pytest.approx((6.0 * pi / point.lam) ** 0.5, rel=1e-12)


@pytest.mark.parametrize("kappa", [0.1, 0.5, 2.0])
def test_published_elliptic_formulas(kappa):
    """The long forms of the paper, with Rx/Ry and elliptic integrals."""
    M, L = 321.0, 7.0
    K, E = oracles.agm_integrals(kappa)
    ratio = (K - E) / (E / kappa**2 - K)
    point = MoesPoint(M, L, kappa)
    lam = 16 * pi * M ** (-4 / 3) * (1 + ratio) ** (-5 / 3) * E**2 / (kappa * K**2)
    assert point.lam == pytest.approx(lam * (pi / (6 * kappa * E)) ** (1 / 3), rel=1e-11)
    alpha = L * M ** (1 / 3) * 3 * kappa / (2 * pi) * (pi / (6 * kappa * E)) ** (2 / 3) * (1 + ratio) ** (2 / 3)
    assert point.alpha_bar == pytest.approx(alpha, rel=1e-11)
    share = 1 / (1 + ratio)  # R/Rx
    film = (6 * kappa * E / pi) ** (2 / 3) * share ** (2 / 3) * K / (2 * share * E) * M ** (2 / 3)
    assert point.film_to_moes == pytest.approx(film, rel=1e-11)


def test_lambda_is_equation_2(operating_point):
    """lambda = 6 eta0 u_sum (2R)^2/(a^3 p_h) (E/K)^2, all in SI."""
    p, s = operating_point, operating_point.scales
    K, E = elliptic_integrals(p.moes.kappa)
    R = 1.0 / (1.0 / p.geometry.radius_x + 1.0 / p.geometry.radius_y)
    lam = 6.0 * p.lubricant.eta0 * p.u_sum * (2.0 * R) ** 2 / (s.a**3 * s.pressure) * (E / K) ** 2
    assert p.moes.lam == pytest.approx(lam, rel=1e-10)


def test_moes_numbers(operating_point):
    p, g = operating_point, operating_point.geometry
    e = 2.0 / ((1 - 0.28**2) / 2.1e11 + (1 - 0.21**2) / 7e10)
    assert g.e_reduced == pytest.approx(e, rel=1e-14)
    U = 0.08 * 1.3 / (e * 0.004)
    assert p.moes.M == pytest.approx(60.0 / (e * 0.004**2) / U**0.75, rel=1e-12)
    assert p.moes.L == pytest.approx(1.9e-8 * e * U**0.25, rel=1e-12)
    assert p.moes.kappa == pytest.approx(g.kappa, rel=1e-12)
    assert (p.moes.alpha, p.moes.eta0) == (1.9e-8, 0.08)


def test_scales(operating_point):
    p, s = operating_point, operating_point.scales
    a, b, pressure, approach = oracles.hertz_si(60.0, 0.004, 0.03, p.geometry.e_reduced)
    got = (s.a, s.b, s.pressure, s.length, s.force, s.time)
    assert got == pytest.approx((a, b, pressure, approach, 60.0, 2.0 * a / 1.3), rel=1e-9, abs=0.0)
    assert s.stiffness == pytest.approx(60.0 / approach, rel=1e-9, abs=0.0)
    assert s.damping == pytest.approx(60.0 / approach * 2.0 * a / 1.3, rel=1e-9, abs=0.0)
    assert s.rate == pytest.approx(approach * 1.3 / (2.0 * a), rel=1e-9, abs=0.0)


def test_scaled_axis_and_pressure_agree_with_si(operating_point):
    p, s = operating_point, operating_point.scales
    U = p.lubricant.eta0 * p.u_sum / (p.geometry.e_reduced * p.geometry.radius_x)
    assert p.moes.scaled_axis == pytest.approx(s.a / (p.geometry.radius_x * U**0.25), rel=1e-10)
    assert p.moes.p_hertz == pytest.approx(s.pressure, rel=1e-10)
    assert p.moes.alpha_bar == pytest.approx(p.lubricant.alpha * s.pressure, rel=1e-10)
    film = s.length / p.geometry.radius_x / U**0.5  # H = 1 in Moes' unit
    assert p.moes.film_to_moes == pytest.approx(film, rel=1e-10)


def test_film_to_be_expected():
    """What regions and grids follow: a sphere's load number is M, and the film is the published one."""
    assert MoesPoint(200, 10, 1.0).load_number == 200.0
    K, E = oracles.agm_integrals(0.1)
    ratio = (K - E) / (E / 0.1**2 - K)
    assert MoesPoint(200, 10, 0.1).load_number == pytest.approx(200.0 * ratio**0.5, rel=1e-9)
    point = MoesPoint(200, 10, 0.5)
    assert point.expected_film * point.film_to_moes == pytest.approx(nvm_central_film(200, 10, 0.5), rel=1e-14)
    assert point.inlet_width**1.5 == pytest.approx(point.expected_film, rel=1e-12)


def test_most_loaded_ball():
    stribeck = 4.37  # the limit of many balls
    assert most_loaded_ball(1000.0, 9) == pytest.approx(487.2, abs=0.1)
    assert most_loaded_ball(1000.0, 100) == pytest.approx(1000.0 * stribeck / 100, rel=2e-3)
    for load, balls in ((0.0, 9), (float("nan"), 9), (100.0, 2), (100.0, 9.0), (100.0, True)):
        with pytest.raises(InputError):
            most_loaded_ball(load, balls)


def test_omega_n_is_equation_5_with_the_speed_squared(operating_point):
    p = operating_point
    K, E = elliptic_integrals(p.moes.kappa)
    R = 1.0 / (1.0 / p.geometry.radius_x + 1.0 / p.geometry.radius_y)
    omega = (8.0 * p.load * R * E / (0.02 * p.u_sum**2 * K)) ** 0.5
    assert p.Omega_n(0.02) == pytest.approx(omega, rel=1e-10)


def test_swapped_axes_scale_alike():
    """A contact rolling along its other axis: same ellipse, pressure and approach; M and L with the other Rx."""
    oil = Lubricant(0.08, 1.9e-8)
    one = OperatingPoint(Geometry(0.004, 0.03), oil, 60.0, 1.3)
    other = OperatingPoint(Geometry(0.03, 0.004), oil, 60.0, 1.3)
    assert one.scales.a == pytest.approx(other.scales.b, rel=1e-9, abs=0.0)
    assert one.scales.pressure == pytest.approx(other.scales.pressure, rel=1e-9, abs=0.0)
    assert one.moes.kappa * other.moes.kappa == pytest.approx(1.0, rel=1e-9, abs=0.0)
    assert shape_factor(one.moes.kappa) == pytest.approx(1.0 - shape_factor(other.moes.kappa), abs=1e-9)


# A 6205 deep-groove ball bearing.
class TestBallBearing:
    def test_inner_radii(self):
        g = Geometry.ball_bearing(**OF_6205)
        assert g.radius_x == pytest.approx(1e-3 / (2 / 7.94 + 2 / 31.10), rel=1e-12)
        assert g.radius_y == pytest.approx(1e-3 / (2 / 7.94 - 1 / (0.52 * 7.94)), rel=1e-12)

    def test_outer_radii(self):
        g = Geometry.ball_bearing(**OF_6205, race="outer")
        assert g.radius_x == pytest.approx(1e-3 / (2 / 7.94 - 2 / 46.98), rel=1e-12)
        assert g.radius_y == pytest.approx(1e-3 * 0.52 * 7.94 / 0.04, rel=1e-12)

    def test_inner_contact_under_load(self):
        """1 kN on the ball, 3000 rpm: kappa 0.107 and, by the oracle, pressure and approach."""
        point = OperatingPoint.ball_bearing(Lubricant(0.037), speed_rpm=3000, load=1000.0, **OF_6205)
        g = point.geometry
        a, b, pressure, approach = oracles.hertz_si(1000.0, g.radius_x, g.radius_y, 2.06e11 / 0.91)
        assert point.moes.kappa == pytest.approx(a / b, rel=1e-9, abs=0.0)
        assert point.moes.kappa == pytest.approx(0.107, abs=5e-4)
        assert point.scales.pressure == pytest.approx(pressure, rel=1e-9, abs=0.0)
        assert point.scales.length == pytest.approx(approach, rel=1e-9, abs=0.0)
        assert point.moes.M == pytest.approx(6069, rel=1e-3, abs=0.0)
        assert point.moes.L == pytest.approx(20.79, rel=1e-3, abs=0.0)

    @pytest.mark.parametrize("race", ["inner", "outer"])
    def test_rolling_speed(self, race):
        """From the kinematics: cage at omega r_i/(r_i + r_o), both surfaces pass the contact alike."""
        point = OperatingPoint.ball_bearing(Lubricant(), speed_rpm=3000, load=100.0, race=race, **OF_6205)
        omega, ri, ro = 3000 * pi / 30, 0.5 * 31.10e-3, 0.5 * 46.98e-3
        cage = omega * ri / (ri + ro)
        surface = (omega - cage) * ri if race == "inner" else cage * ro
        assert point.u_sum == pytest.approx(2.0 * surface, rel=1e-12)

    def test_materials_reach_the_geometry(self):
        g = Geometry.ball_bearing(**OF_6205, e1=3.1e11, nu1=0.26)
        assert (g.e1, g.nu1, g.e2, g.nu2) == (3.1e11, 0.26, 2.06e11, 0.3)


@pytest.mark.parametrize("viscosity", ["roelands", "barus"])
@pytest.mark.parametrize("density_law", ["dowson-higginson", "incompressible"])
def test_oil_at_l_0_is_the_limit_of_small_l(viscosity, density_law):
    limit = MoesPoint(200, 0, 1.0, viscosity=viscosity, density=density_law)
    assert limit.p_hertz == limit.alpha_bar == 0.0
    for P in (0.0, 0.3, 1.0, 3.0):
        assert density(P, limit.law) == (1.0, 0.0)
        assert log_viscosity(P, limit.law) == (0.0, 0.0)
        for L in (1e-6, 1e-3, 0.01):
            law = replace(limit, L=L).law
            assert density(P, law) == pytest.approx((1.0, 0.0), abs=0.3 * L)
            assert log_viscosity(P, law) == pytest.approx((0.0, 0.0), abs=10.0 * L)


def test_either_kind_of_point(operating_point):
    point = MoesPoint(200, 10, 0.5)
    assert moes_point(point) is point
    assert moes_point(operating_point) is operating_point.moes
    assert scales_of(point) is None
    assert scales_of(operating_point) is operating_point.scales
    for wrong in ((200, 10, 0.5), None, "M200"):
        with pytest.raises(InputError, match=r"^point = "):
            moes_point(wrong)


def test_points_are_values():
    a, b = MoesPoint(200, 10, 0.5), MoesPoint(200.0, 10.0, 0.5)
    assert a == b
    assert hash(a) == hash(b)
    assert MoesPoint(**a.to_dict()) == a
    assert replace(a, M=100.0).M == 100.0
    with pytest.raises(AttributeError):
        a.M = 3.0


def test_ball_on_flat():
    glass = {"e1": 2.1e11, "nu1": 0.3, "e2": 7e10, "nu2": 0.21}
    geometry = Geometry.ball_on_flat(19.05e-3, **glass)
    assert (geometry.radius_x, geometry.radius_y, geometry.kappa) == (9.525e-3, 9.525e-3, pytest.approx(1.0))
    assert geometry.e_reduced == pytest.approx(1.112e11, rel=1e-3)
    oil = Lubricant(eta0=0.2, alpha=2.5e-8)
    at = {"ball_diameter": 19.05e-3, "entrainment_speed": 0.1, "load": 20.0}
    assert OperatingPoint.ball_on_flat(oil, **at, **glass) == OperatingPoint(geometry, oil, 20.0, 0.2)
    with pytest.raises(InputError, match=r"ball_diameter = 19\.05: .*in mm"):
        Geometry.ball_on_flat(19.05)
    with pytest.raises(InputError, match=r"entrainment_speed = 900\.0: .*in mm/s\? then 0\.9 m/s"):
        OperatingPoint.ball_on_flat(oil, **(at | {"entrainment_speed": 900.0}))
