"""Heat of a film: temperatures against an inlet resolved across the film, power, limits, and what is refused."""

import re
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from balls import LARGE
from scipy import linalg, sparse
from scipy.sparse.linalg import spsolve

from ehlcontact import (
    Grid,
    Heat,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    assumptions,
    read,
    save,
    solve_steady,
)
from ehlcontact.film_formulas import wilson_heating
from ehlcontact.linearised_film import held
from ehlcontact.lubricant import MineralOil
from ehlcontact.solver.film_heat import FilmHeat
from ehlcontact.solver.kernels.heat import warm_walls
from ehlcontact.solver.level import Level

OIL = Lubricant.iso_vg(68, temperature=50.0)
SMALL = Grid(64)


def bearing(rpm=10_000.0, oil=OIL):
    """Inner race of a 6305."""
    return OperatingPoint.ball_bearing(oil, **LARGE, speed_rpm=rpm, load=800.0)


POINT = bearing()


@cache
def cold():
    return solve_steady(POINT, grid=SMALL)


@cache
def warm():
    return solve_steady(POINT, grid=SMALL, thermal=Heat())


class Inlet:
    """Inlet of a line contact under given viscosity, with its temperature resolved across the film.

    Finite volumes over x and z, upwind, in SI; walls at the temperature of the inlet. Pressure and film are those
    of the gap beside a line contact under the viscosity of Barus: the flow through every section is the same.
    """

    def __init__(self, point, slide, convection=True, lines=48):
        s, oil = point.scales, point.lubricant
        self.u, self.slide, self.lines = s.a / s.time, slide * s.a / s.time, lines
        self.k, self.rc = Heat().conductivity, Heat().heat_capacity * convection
        self.h_star = 0.05 * s.length
        self.X = np.linspace(-3.0, -1.02, 1500)
        x, Y = self.X * s.a, -self.X
        opening = Y * np.sqrt(Y * Y - 1.0) - np.log(Y + np.sqrt(Y * Y - 1.0))
        self.h = self.h_star + 0.5 * s.length * opening
        # reduced pressure: 1 - exp(-alpha p) = alpha int 12 eta0 u (h - h*)/h^3 dx
        slope = 12.0 * oil.eta0 * self.u * (self.h - self.h_star) / self.h**3
        rise = np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(x))])
        rise *= 0.95 / oil.alpha / rise[-1]  # up to alpha p = 3
        factor = 0.95 / oil.alpha / np.trapezoid(slope, x)
        self.eta0 = oil.eta0 * factor  # the viscosity that makes it so
        self.p = -np.log1p(-oil.alpha * rise) / oil.alpha
        self.eta = self.eta0 * np.exp(oil.alpha * self.p)
        self.px = 12.0 * self.eta * self.u * (self.h - self.h_star) / self.h**3
        self.x = x

    def temperature(self):
        """Temperature, shape (sections, lines), and places across, 0 to 1."""
        n, m, x, h = self.x.size, self.lines, self.x, self.h
        dx, dz = x[1] - x[0], 1.0 / m
        z = (np.arange(m) + 0.5) * dz
        edge = np.linspace(0.0, 1.0, m + 1)

        def stream(h, px, eta):
            """Flow below each height: of sliding and of pressure."""
            H, P = h[:, None], (px / eta)[:, None]
            u1 = self.u + 0.5 * self.slide
            return H * (u1 * edge - 0.5 * self.slide * edge**2 + 0.5 * H**2 * P * (edge**3 / 3.0 - edge**2 / 2.0))

        psi = stream(h, self.px, self.eta)
        psi *= (self.u * self.h_star / psi[:, -1])[:, None]
        at = np.concatenate([psi[:1], 0.5 * (psi[1:] + psi[:-1]), psi[-1:]])
        east, up = self.rc * np.diff(at, axis=1), -self.rc * np.diff(at, axis=0)
        node = np.arange(n * m).reshape(n, m)
        c = np.broadcast_to((self.k * dx / (h * dz))[:, None], (n, m))
        own = (
            np.maximum(east[1:], 0)
            - np.minimum(east[:-1], 0)
            + np.maximum(up[:, 1:], 0)
            - np.minimum(up[:, :-1], 0)
        )
        own = own + 2.0 * c
        own[:, 0] += c[:, 0]
        own[:, -1] += c[:, -1]
        entries = [
            (node, node, own),
            (node[1:], node[:-1], -np.maximum(east[1:-1], 0)),
            (node[:-1], node[1:], np.minimum(east[1:-1], 0)),
            (node[:, 1:], node[:, :-1], -np.maximum(up[:, 1:-1], 0) - c[:, 1:]),
            (node[:, :-1], node[:, 1:], np.minimum(up[:, 1:-1], 0) - c[:, 1:]),
        ]
        rows, columns, values = (np.concatenate([e[k].ravel() for e in entries]) for k in range(3))
        shear = -self.slide / h[:, None] + (self.px / self.eta)[:, None] * h[:, None] * (z - 0.5)
        heat = self.eta[:, None] * shear**2 * dx * h[:, None] * dz
        matrix = sparse.csc_matrix((values, (rows, columns)))
        return spsolve(matrix, heat.ravel()).reshape(n, m), z

    def seen(self, T, z):
        """Temperature that the flow by pressure sees: by how much a small change of fluidity changes the flow."""
        eps, dz, flows = 1e-6, z[1] - z[0], []
        for sign in (1.0, -1.0):
            f, H = (1.0 + sign * eps * T) / self.eta[:, None], self.h[:, None]
            m0, m1, m2 = ((f * (z * H) ** k).sum(axis=1) * dz * self.h for k in range(3))
            wall = (-self.slide - self.px * m1) / m0  # shear stress at z = 0
            flows.append(wall * (self.h * m0 - m1) + self.px * (self.h * m1 - m2))
        by_pressure = -(self.h**3) * self.px / (12.0 * self.eta)
        return (flows[0] - flows[1]) / (2.0 * eps) / by_pressure


def lumped(inlet, point, slide, convection):
    """Mean temperature of `FilmHeat` on pressure and film of an inlet, and the one that its flow sees; line 0."""
    s = point.scales
    heat = Heat(slide, temperature_slope=1e-6, eyring_stress=1e9, expansion=0.0).at(point)
    oil = replace(point.lubricant, eta0=inlet.eta0, viscosity="barus", density="incompressible")
    moes = replace(point.moes, eta0=oil.eta0, viscosity="barus", density="incompressible")
    numbers = heat.numbers(moes, s)._replace(walls=(0.0, 0.0))
    numbers = numbers if convection else numbers._replace(convection=0.0)
    level = Level(moes, SimpleNamespace(x_in=-3.0, x_out=-1.02, y_max=1.0), 512, 4)
    level.stencil = level.stencil._replace(lam=level.stencil.lam * inlet.eta0 / point.lubricant.eta0)
    level.P[...] = np.interp(level.X, inlet.X, inlet.p / s.pressure)
    level.H[...] = np.interp(level.X, inlet.X, inlet.h / s.length)
    level.update_residual()
    film = FilmHeat(level, numbers)
    seen = film.solve()
    temperature = numbers.temperature_scale * np.expm1(-np.log1p(seen) / numbers.exponent)
    return level.X, film.mean[0], temperature[0]


@pytest.mark.parametrize(("slide", "convection"), [(0.0, False), (0.0, True), (0.5, False), (0.5, True)])
def test_temperatures_are_those_of_a_resolved_inlet(slide, convection):
    """With reverse flow in most of the inlet: h is above 3 h* there."""
    inlet = Inlet(POINT, slide, convection)
    T, z = inlet.temperature()
    X, mean, seen = lumped(inlet, POINT, slide, convection)
    near = (X > -1.4) & (X < -1.05)
    tolerance = 0.065 if convection else 0.01
    for ours, theirs in ((mean, T.mean(axis=1)), (seen, inlet.seen(T, z))):
        expected = np.interp(X[near], inlet.X, theirs)
        np.testing.assert_allclose(ours[near], expected, atol=tolerance * expected.max())


def test_without_a_slope_the_film_is_the_isothermal_one():
    """Bit for bit; it is warm all the same."""
    still = solve_steady(POINT, grid=SMALL, thermal=Heat(temperature_slope=0.0))
    np.testing.assert_array_equal(still.p, cold().p)
    np.testing.assert_array_equal(still.h, cold().h)
    assert (still.approach, still.temperature.film_share) == (cold().approach, 1.0)
    assert still.temperature.largest > warm().temperature.largest > 10.0


def test_film_with_heat():
    """Both residuals, and the film left: published formulas have .70 to .78 here."""
    assert warm().status.ok
    assert abs(warm().load_residual) < 1e-7
    assert warm().residual < cold().residual + 1e-4
    found = warm().temperature
    assert found.thermal_load == pytest.approx(OIL.temperature_slope * OIL.eta0 * (0.5 * POINT.u_sum) ** 2 / 0.134)
    assert found.film_share == pytest.approx(warm().h_central / cold().h_central, abs=2e-4)
    assert 0.70 < solve_steady(POINT, grid=Grid(128), thermal=Heat()).temperature.film_share < 0.78


@pytest.mark.parametrize(
    "given",
    [Heat(), Heat(0.3), Heat(-0.3, effusivity=(13_000.0, 1_500.0))],
)
def test_energy_is_balanced(given):
    film = solve_steady(POINT, grid=SMALL, thermal=given)
    assert film.temperature.balance < 1e-6
    assert film.status.ok


def test_heat_of_the_flow_by_pressure_is_the_power_of_the_surfaces():
    """Of incompressible oil, -u iint p dh/dx; but for what the faces beside dry nodes make."""
    point = replace(bearing(oil=replace(OIL, density="incompressible")), load=100.0)
    film = solve_steady(point, grid=SMALL, tol=1e-8)
    level = held(film).finest
    made = FilmHeat(level, Heat().at(point).numbers(point.moes, point.scales)).terms().pressed
    power = -film.dimensionless.p.T * level.transport(level.H, np.zeros_like(level.H))
    assert np.vdot(level.force_weights, made) == pytest.approx(np.vdot(level.force_weights, power), rel=0.01)


def test_faster_surfaces_and_poor_conductors_stay_behind():
    """A glass disc under a steel ball is the hotter one; which body is faster counts."""
    pair = (13_000.0, 1_500.0)
    slow_glass, fast_glass = (
        solve_steady(POINT, grid=SMALL, thermal=Heat(slide, effusivity=pair)).temperature.surfaces.max(axis=(1, 2))
        for slide in (0.3, -0.3)
    )
    assert slow_glass[1] > 2.0 * slow_glass[0]  # the faster one first: steel
    assert fast_glass[0] > 2.0 * fast_glass[1]
    assert slow_glass[1] > fast_glass[0]


def test_roelands_follows_walther():
    """With the slope at 50 C, over 40 K more."""
    for grade in (32, 68, 150):
        oil = Lubricant.iso_vg(grade, temperature=50.0)
        point = bearing(oil=oil)
        numbers = Heat().at(point).numbers(point.moes, point.scales)
        for warmer in (10.0, 40.0):
            factor = (1.0 + warmer / numbers.temperature_scale) ** -numbers.exponent
            ours = np.exp((np.log(oil.eta0) + 9.67) * factor - 9.67)
            assert ours == pytest.approx(MineralOil.of_grade(grade, 50.0 + warmer).eta0, rel=0.001 * warmer)


@pytest.mark.slow
def test_films_against_published_factors():
    """Pure rolling over Q .01 to 1.1: within 5 % of Wilson and Sheu."""
    for rpm in (1000.0, 3000.0, 6000.0, 9000.0):
        for load_ in (100.0, 400.0, 1500.0):
            point = replace(bearing(rpm), load=load_)
            found = solve_steady(point, grid=Grid(128), thermal=Heat()).temperature
            assert found.film_share == pytest.approx(wilson_heating(found.thermal_load), rel=0.05)


def test_neighbouring_films_lie_on_one_line():
    """With sliding on glass; with cold nodes behind the outlet two films are solutions, forces 5e-6 apart."""
    given = {"grid": Grid(48), "thermal": Heat(0.3, effusivity=(13_000.0, 1_500.0)), "tol": 1e-9}
    film = solve_steady(POINT, **given)
    s = POINT.scales
    at = [film.approach + s.length * du for du in (-4e-4, -2e-4, 2e-4, 4e-4)]
    near = [solve_steady(POINT, approach=u, **given).force / s.force for u in at]
    slopes = np.diff(np.insert(near, 2, 1.0)) / 2e-4
    np.testing.assert_allclose(slopes, slopes.mean(), rtol=1e-3)


def test_bodies_of_different_material_settle_in_pure_rolling():
    film = solve_steady(bearing(4000.0), grid=SMALL, thermal=Heat(effusivity=(13_000.0, 1_500.0)))
    assert film.cycles < 10


STEEL_GLASS = (13_000.0, 1_500.0)


def disc(speed, load=20.0):
    """A steel ball on a glass disc."""
    oil = Lubricant(0.1154, 2.34e-8, temperature=34.0, temperature_slope=0.05)
    glass = {"e1": 2.1e11, "e2": 7e10, "nu2": 0.21}
    return OperatingPoint.ball_on_flat(oil, ball_diameter=19.05e-3, entrainment_speed=speed, load=load, **glass)


def test_surfaces_exchange_heat_however_thin_the_film():
    """Of .2 um, where rounds at given exchange grow; against a dense solve of each line."""
    point = disc(0.2)
    film = solve_steady(point, grid=SMALL, thermal=Heat(effusivity=STEEL_GLASS))
    assert film.status.ok
    level = held(film).finest
    heat = FilmHeat(level, film.temperature.inputs.numbers(point.moes, point.scales))
    exchange = heat.terms().exchange / 12.0
    assert heat.now[1, 0] * exchange.max() > 2.0  # the gain of such a round
    rng = np.random.default_rng(1)
    by_mean, lacking = -exchange * rng.random(exchange.shape), rng.normal(size=(2, *exchange.shape))
    found = lacking.copy()
    warm_walls(heat.now, by_mean, exchange, found)
    one, two = (linalg.toeplitz(w, np.zeros(level.nx + 1)) for w in heat.now)
    for j in (0, level.ny // 2):
        same, other = np.diag(0.5 * by_mean[j] - exchange[j]), np.diag(0.5 * by_mean[j] + exchange[j])
        matrix = np.block([[one @ same, one @ other], [two @ other, two @ same]])
        expected = linalg.solve(np.eye(matrix.shape[0]) - matrix, lacking[:, j].ravel())
        np.testing.assert_allclose(found[:, j].ravel(), expected, rtol=1e-10, atol=1e-10)


@pytest.mark.long
@pytest.mark.parametrize("speed", np.geomspace(0.05, 3.0, 8))
def test_steel_on_glass_at_all_speeds(speed):
    """Films of 75 nm to 1 um: as thin as Wilson and Sheu have them, within what warm glass adds."""
    found = solve_steady(disc(speed), refine=False, thermal=Heat(effusivity=STEEL_GLASS))
    heat = found.temperature
    assert found.status.ok
    assert heat.balance < 1e-6
    assert heat.film_share < 1.0
    assert heat.film_share == pytest.approx(wilson_heating(heat.thermal_load), rel=0.03)


@pytest.mark.long
@pytest.mark.parametrize("pair", [STEEL_GLASS, (13_000.0, 13_000.0), (1_500.0, 1_500.0), (13_000.0, 11_000.0)])
@pytest.mark.parametrize(("speed", "slide", "load"), [(0.1, 1.0, 20.0), (0.4, -0.5, 50.0), (3.0, -1.0, 20.0)])
def test_films_that_slide_settle_between_all_surfaces(pair, speed, slide, load):
    found = solve_steady(disc(speed, load), refine=False, thermal=Heat(slide, effusivity=pair))
    assert found.status.ok
    assert found.temperature.balance < 1e-6
    assert 0.5 < found.temperature.film_share < 1.0


@pytest.mark.slow
def test_fast_films_and_fine_grids_settle():
    """Q above 5; cycles of n = 512 in the first attempt."""
    hot = solve_steady(bearing(20_000.0), grid=Grid(256), thermal=Heat())
    assert hot.temperature.thermal_load > 5.0
    assert solve_steady(POINT, grid=Grid(512), thermal=Heat(), method="multigrid").cycles < 15


@pytest.mark.slow
def test_film_converges_with_the_grid():
    shares = [solve_steady(POINT, grid=Grid(n), thermal=Heat()).temperature.film_share for n in (128, 256, 512)]
    assert abs(shares[2] - shares[1]) < 0.6 * abs(shares[1] - shares[0]) < 0.003


def test_results_do_not_depend_on_threads():
    given = {"grid": Grid(256), "thermal": Heat(0.1), "max_cycles": 2, "throw": False}
    one, two = (solve_steady(POINT, threads=threads, **given) for threads in (1, 2))
    np.testing.assert_array_equal(one.p, two.p)


def test_kept_and_said(tmp_path):
    again = read(save(warm(), tmp_path / "film.h5"))
    assert again.temperature.inputs == warm().temperature.inputs
    np.testing.assert_array_equal(again.temperature.surfaces, warm().temperature.surfaces)
    assert again.to_dict() == warm().to_dict()
    assert "heat makes the film" in repr(warm())
    assert "isothermal" not in warm().outside_assumptions
    assert "isothermal" in cold().outside_assumptions
    row = assumptions(POINT, film=warm())["isothermal"]
    assert row.verdict.startswith("not assumed: solved with heat, film 25 %")
    assert row.details["gupta"] == pytest.approx(assumptions(POINT)["isothermal"].value, rel=1e-9)
    warm().plot(tmp_path / "film.png")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"slide_roll": 1.5}, "slide_roll = 1.5: must be between -1 and 1: near 2 one surface stands still"),
        ({"slide_roll": float("nan")}, "slide_roll = nan: must be a finite number"),
        ({"temperature": float("nan")}, "temperature = nan: must be a finite number"),
        ({"temperature": 323.0}, "temperature = 323.0: must be between -50 and 250"),
        ({"temperature_slope": -0.04}, "temperature_slope = -0.04"),
        ({"conductivity": 0.0}, "conductivity = 0.0"),
        ({"heat_capacity": 2000.0}, "heat_capacity = 2000.0: must be between 500000 and 5e+06"),
        ({"effusivity": (1e4, 1e4, 1e4)}, "one number, or a pair"),
        ({"effusivity": float("nan")}, "effusivity = nan"),
        ({"eyring_stress": 5.0}, "eyring_stress = 5.0"),
    ],
)
def test_data_that_are_none(given, message):
    with pytest.raises(InputError, match=re.escape(message)):
        Heat(**given)


def test_what_is_missing():
    bare = bearing(oil=Lubricant(0.04, 2e-8))
    with pytest.raises(InputError, match=r"typical mineral oil of 0\.04 Pa s has 0\.043"):
        solve_steady(bare, thermal=Heat())
    with pytest.raises(InputError, match="temperature = None: must be given in Heat"):
        solve_steady(bare, thermal=Heat(temperature_slope=0.04))
    with pytest.raises(InputError, match="left out at a dimensionless point"):
        solve_steady(MoesPoint(200, 10, 0.5), thermal=Heat())
    with pytest.raises(InputError, match="thermal = 'hot': must be True or a Heat"):
        solve_steady(POINT, thermal="hot")
    with pytest.raises(InputError, match=r"temperature = 20\.0: must be left out: .* viscosity at 50 C"):
        solve_steady(POINT, thermal=Heat(temperature=20))


def test_true_is_the_heat_of_the_oil():
    given = {"grid": Grid(32), "max_cycles": 1, "throw": False}
    one, two = (solve_steady(POINT, thermal=heat, **given) for heat in (True, Heat()))
    assert one.temperature.inputs == two.temperature.inputs
    assert solve_steady(POINT, thermal=False, **given).temperature is None
