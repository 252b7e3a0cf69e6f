"""Where the lambda ratio takes its smallest film from, and what the formula for it is worth beside the atlas."""

import numpy as np
import pytest
from scipy.stats import qmc

from ehlcontact import Grid, InputError, Lubricant, MoesPoint, OperatingPoint, assumptions, impedance, solve_steady
from ehlcontact.assumptions.film import FORMULA_SCATTER
from ehlcontact.film_formulas import film_to_moes, hamrock_dowson_minimum
from reduced_models import Atlas

ATLAS = Atlas()
OIL = Lubricant.iso_vg(68, temperature=50.0)
ROUGH = (5e-8, 1e-7)


def by_formula(M, L, kappa, G=4500.0):
    """Smallest film of Hamrock and Dowson in dry approaches; in Moes' numbers it hardly depends on G."""
    U = (L / G) ** 4  # of the sum of the speeds
    return hamrock_dowson_minimum(0.5 * U, G, M * U**0.75, kappa) / U**0.5 / film_to_moes(M, kappa)


def test_scatter_of_the_formula():
    """docs/notes/assumptions.md: nine of ten within -12 and +59 %, thrice as high in heavily loaded circles."""
    ratios, circles = [], []
    for x, y, z in qmc.Sobol(3, seed=2).random(1024):
        M, L, kappa = 10.0 * 3000.0**x, 2.0 + 23.0 * y, 0.05 * 20.0**z
        try:
            film = ATLAS.at(MoesPoint(M, L, kappa))
        except InputError:
            continue
        if film.error_bars["h_min"] < 0.1 * film.h_min:
            ratios.append(by_formula(M, L, kappa) / film.h_min)
            if kappa > 0.7 and M > 3000.0:
                circles.append(ratios[-1])
    assert len(ratios) > 900 and len(circles) > 5
    assert np.quantile(ratios, [0.05, 0.95]) == pytest.approx([0.88, 1.59], abs=0.06)
    assert np.median(circles) == pytest.approx(2.4, abs=0.3)
    assert "12 % below to 59 % above" in FORMULA_SCATTER


def disc(load):
    """A steel ball on a steel disc: a circle, where the formula is worst."""
    from ehlcontact import Geometry

    return OperatingPoint(Geometry(radius_x=0.01, radius_y=0.01), OIL, load=load, u_sum=1.0)


def test_film_of_the_atlas_makes_the_lambda_ratio():
    point = disc(200.0)
    answer = ATLAS.at(point)
    bare, known = (assumptions(point, film=film, roughness=ROUGH)["smooth"] for film in (None, answer))
    assert known.value == pytest.approx(answer.h_min / np.hypot(*ROUGH), rel=1e-12)
    assert bare.value > 1.2 * known.value
    bar = 100.0 * answer.error_bars["h_min"] / answer.h_min
    assert f"(from the atlas, ± {bar:.2g} %)" in known.verdict
    assert "(by Hamrock and Dowson's formula)" in bare.verdict
    assert FORMULA_SCATTER in bare.scatter and FORMULA_SCATTER not in known.scatter
    assert assumptions(point, film=answer)["fully flooded"].value is None  # the atlas has no region


def test_origin_of_a_solved_film():
    point = MoesPoint(200, 10, 0.5)
    solved = solve_steady(point, grid=Grid(n=64))
    assert solved.film_origin == f"solved, ± {100.0 * solved.error_estimate.h_min_relative:.2g} %"
    assert impedance(point, Omega=[0.0], grid=Grid(n=64)).film.film_origin.startswith("solved, ±")
    stopped = solve_steady(point, grid=Grid(n=64), max_cycles=1, throw=False)
    assert stopped.film_origin == f"not solved: {stopped.status}"


def test_elements_of_the_atlas_are_judged_by_its_film():
    point = disc(200.0)
    kept = ATLAS.element(point, model="wide").source["assumptions"]
    assert kept == assumptions(point, film=ATLAS.at(point)).short() != assumptions(point).short()


def test_what_is_no_film_is_named():
    with pytest.raises(InputError, match=r"^film = 1e-07: must be a steady film"):
        assumptions(disc(10.0), film=1e-7)
