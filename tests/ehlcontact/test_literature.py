"""Published numbers. Sources are given at each table; nothing here was computed by this library."""

from dataclasses import replace
from math import pi

import numpy as np
import oracles
import pytest

from ehlcontact import (
    Domain,
    FreeVibration,
    Geometry,
    Grid,
    HarmonicLoad,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    RampLoad,
    TimeSteps,
    simulate,
    solve_steady,
)
from ehlcontact.film_formulas import nvm_central_film, wijnant_approach
from reduced_models import ContactRecord, fit

pytestmark = pytest.mark.literature

POINT = MoesPoint(200, 10, 0.5)


@pytest.mark.parametrize(("n", "error"), [(64, 0.0015), (128, 0.0005), (256, 0.0005)])
def test_approach_of_the_paper_point(steady, n, error):
    """M = 200, L = 10, kappa = 0.5: limit 0.8700 of an independent solver; its errors: .0129, .0034, .0009.

    The paper gives 0.868 to 0.871.
    """
    assert steady(200, 10, 0.5, n).approach == pytest.approx(0.8700, abs=error)


def test_film_ratio_of_the_validation_case(steady):
    """Nonato and Cavalca (2010), section 3: h_c/h_m = 0.329/0.187; an independent solver gives 1.757."""
    film = steady(58.07, 4.62, 1.0, 256)
    assert film.h_central / film.h_min == pytest.approx(1.757, rel=0.015)
    assert film.h_central / film.h_min == pytest.approx(0.329 / 0.187, rel=0.015)


# PINN-EHL-Reproducibility (github.com/vachekivan495-design), converged 769^2 solutions of a steel ball, 12.68 mm,
# on glass: alpha [1/Pa], mean speed [m/s], eta0 [Pa s], load [N], then M, L (sum speed) and approach.
PUBLIC = {
    "te_001": (2.0000e-8, 1.500000, 0.067800, 20.00000, 26.159, 8.358, 0.65761),
    "te_003": (2.0000e-8, 0.800000, 0.067800, 37.50000, 78.591, 7.142, 0.85870),
    "te_007": (1.2000e-8, 1.500000, 0.067800, 37.50000, 49.048, 5.015, 0.82774),
    "tr_010": (2.0818e-8, 1.713668, 0.072054, 31.39561, 35.503, 9.132, 0.71615),
    "tr_021": (1.8928e-8, 1.379157, 0.063746, 47.73831, 69.646, 7.627, 0.84172),
}


@pytest.mark.parametrize("row", PUBLIC.values(), ids=PUBLIC)
def test_public_solutions(row):
    """On their domain, n = 256: approach within 0.5 %."""
    alpha, u_mean, eta0, load, M, L, approach = row
    geometry = Geometry(12.68e-3, 12.68e-3, 210e9, 0.3, 81e9, 0.208)
    assert geometry.e_reduced == pytest.approx(1.238782e11, rel=1e-6)
    point = OperatingPoint(geometry, Lubricant(eta0, alpha), load, 2.0 * u_mean)
    assert (point.moes.M, point.moes.L) == pytest.approx((M, L), rel=1e-4)
    film = solve_steady(point, grid=Grid(n=256, domain=Domain(-4.0, 2.0, 3.0)))
    assert film.dimensionless.approach == pytest.approx(approach, rel=0.005)


@pytest.mark.parametrize(("M", "L"), [(20, 10), (58.07, 4.62), (200, 10)])
def test_central_film_of_nijenbanning_venner_moes(steady, M, L):
    """The formula is for incompressible oil; within 2 % on a circle, n = 128."""
    film = steady(M, L, 1.0, 128, density="incompressible")
    assert film.h_central * film.point.film_to_moes == pytest.approx(nvm_central_film(M, L, 1.0), rel=0.02)


@pytest.mark.parametrize(("M", "L", "kappa"), [(58.07, 4.62, 1.0), (200, 10, 1.0), (200, 10, 0.5)])
def test_approach_of_wijnant(steady, M, L, kappa):
    """His fit to his own solutions (thesis, Twente 1998): within 2 %."""
    assert steady(M, L, kappa, 128).approach == pytest.approx(wijnant_approach(M, L, kappa), rel=0.02)


# Venner and Lubrecht's published FMG C program on [-4.5, 1.5] x [-3, 3]: Barus, incompressible, circle, L = 10.
# Central and minimum film in Moes units: Richardson limits from 257^2 and 513^2 nodes. On 65^2 and 129^2 that
# program itself gives (4.652, 2.885), (4.765, 2.946) at M = 20 and (3.254, 1.320), (4.173, 1.715) at M = 200.
VLC_LIMIT = {20: (4.804, 2.961), 200: (4.506, 1.886)}
BARUS = dict(viscosity="barus", density="incompressible")


@pytest.mark.parametrize(
    ("M", "n", "error"), [(20, 64, 0.008), (20, 128, 0.004), (200, 128, 0.006), (200, 256, 0.005)]
)
def test_limit_of_the_published_program(steady, M, n, error):
    """On much coarser grids than that program needs."""
    film = steady(M, 10, 1.0, n, **BARUS)
    unit = film.point.film_to_moes
    assert (film.h_central * unit, film.h_min * unit) == pytest.approx(VLC_LIMIT[M], rel=error)


# Nonato and Cavalca (2010), Tables 3 and 5: K1, K2, K3, C1 at M = 200, L = 10, kappa = 0.5. Of a cubic only the
# root of f(u) = 1 and the tangent there can be identified from +-10 % of motion.
CUBICS = {
    "3.1": (FreeVibration(Omega_n=10.26, start="opening"), (1.552, -1.414, 1.093, 0.011)),
    "3.2": (FreeVibration(Omega_n=5.13, start="opening"), (0.806, 0.346, 0.054, 0.013)),
    "3.3": (FreeVibration(Omega_n=2.56, start="opening"), (0.747, 0.502, -0.046, 0.015)),
    "5.4": (HarmonicLoad(Omega=pi), (0.703, 0.596, -0.097, 0.015)),
    "5.5": (HarmonicLoad(Omega=2.0 * pi), (0.603, 0.815, -0.215, 0.013)),
    "5.6": (HarmonicLoad(Omega=4.0 * pi), (0.413, 1.236, -0.444, 0.011)),
}


@pytest.mark.parametrize(
    "case", [pytest.param(name, marks=[] if name == "3.2" else pytest.mark.slow) for name in CUBICS]
)
def test_tables_3_and_5(case):
    """n = 128, the record and window a user gets by default (the last two thirds of the record).

    0.2 % of the root is not met by cases 1 and 2, and finer grids do not bring it nearer.
    """
    motion, (k1, k2, k3, c1) = CUBICS[case]
    result = fit(ContactRecord.from_result(simulate(POINT, motion, grid=Grid(n=128))), model="cubic")
    root, tangent = oracles.spring_root_and_tangent(k1, k2, k3)
    assert result.root == pytest.approx(root, rel=0.005)
    assert result.tangent == pytest.approx(tangent, rel=0.01)
    assert result.parameters["C1"] == pytest.approx(c1, rel=0.08)
    assert result.rms < 0.01


# Table 1: K1 and C1 of a line and a damper, whole records. C1 of case 3 is .0151 here, and .015 in Table 3.
LINEAR = {"1.1": ("3.1", (1.1521, 0.01037)), "1.2": ("3.2", (1.1519, 0.01238)), "1.3": ("3.3", (1.1507, None))}
MESHES = [pytest.param(64, marks=pytest.mark.long), pytest.param(128, marks=pytest.mark.slow)]


@pytest.mark.parametrize("n", MESHES)
@pytest.mark.parametrize("name", LINEAR)
def test_table_1(name, n):
    """The paper's vibrations begin by opening: K1 within .2 % at n = 128, and half a per cent off when closing."""
    same, (k1, c1) = LINEAR[name]
    motion, _ = CUBICS[same]
    record = ContactRecord.from_result(simulate(POINT, motion, grid=Grid(n=n)))
    result = fit(record, model="linear", window=(record.t[0], record.t[-1]))
    assert result.parameters["K1"] == pytest.approx(k1, rel=0.002 if n == 128 else 0.003)
    assert c1 is None or result.parameters["C1"] == pytest.approx(c1, rel=0.05)


@pytest.mark.parametrize("n", MESHES)
def test_figure_6(n):
    """First turn of the central film: "close to one dimensionless time unit the first valley occurs" (section 4).

    A vibration that begins by closing has a peak there.
    """
    motion, time = CUBICS["3.2"][0], TimeSteps(until=1.3)
    opening, closing = (
        simulate(POINT, replace(motion, rate=sign * motion.rate, start=None), grid=Grid(n=n), time=time)
        for sign in (1.0, -1.0)
    )
    T, h = opening.t, opening.h_central
    assert T[h.argmin()] == pytest.approx(1.0, abs=0.08)
    assert np.ptp(h[T < 0.5]) < 0.1 * np.ptp(h)  # "initially, its value remains constant"
    assert h[0] - h.min() > 5.0 * (h[: h.argmin()].max() - h[0])
    assert T[closing.h_central.argmax()] == pytest.approx(1.1, abs=0.1)
    assert closing.h_central[-1] < closing.h_central.max()


# The same of Table 6, of a ramp from 1 to 3.67 in T = 1.69.
RAMP_POINT, RAMP = MoesPoint(58.07, 4.62, 1.0), RampLoad(3.67, 1.69, Omega_n=2.4)
RAMP_DOMAIN, RAMP_END = Domain(-5.0, 3.0, 4.0), 5.6
RAMP_CUBIC = (0.8674, 0.3823, -0.0185, 0.033)


@pytest.mark.slow
def test_table_6():
    """By default a ramp is fitted as a whole: only its beginning visits load 1, of root and tangent."""
    grid, time = Grid(n=128, domain=RAMP_DOMAIN), TimeSteps(until=RAMP_END)
    record = simulate(RAMP_POINT, RAMP, grid=grid, time=time)
    result = fit(ContactRecord.from_result(record), model="cubic")
    assert result.window == (pytest.approx((0.0, RAMP_END)),)
    root, tangent = oracles.spring_root_and_tangent(*RAMP_CUBIC[:3])
    assert (root, tangent) == pytest.approx((0.8486, 1.476), abs=6e-4)
    assert result.root == pytest.approx(root, rel=0.005)
    assert result.tangent == pytest.approx(tangent, rel=0.01)
    assert result.parameters["C1"] == pytest.approx(RAMP_CUBIC[3], rel=0.1)
