"""`solve_steady`: what it promises about its result, and how it fails."""

import time
from dataclasses import fields, replace
from math import inf

import numpy as np
import pytest
from argument_groups import with_grid

from ehlcontact import (
    ConvergenceError,
    Domain,
    Geometry,
    Grid,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    solve_steady,
)
from ehlcontact import steady as steady_module
from ehlcontact.hertz import shape_factor
from ehlcontact.solver import mesh_choice as mesh
from ehlcontact.solver.attempts import CYCLES_TIME, FAILED_TIME, Attempt, Method
from ehlcontact.solver.grid_rules import coarsest_intervals
from ehlcontact.solver.level import build_hierarchy
from ehlcontact.solver.mesh import Mesh
from ehlcontact.status import Status

POINT = MoesPoint(200, 10, 0.5)
CASES = [(200, 10, 0.5), (20, 10, 1.0), (500, 15, 0.12)]


@pytest.mark.parametrize("case", CASES)
def test_convergence_promises(steady, case):
    """Design's must-show numbers, at the default tolerance."""
    result = steady(*case, 128)
    assert result.status is Status.CONVERGED
    assert result.approach_changes[-1] < 1e-6
    assert abs(result.load_residual) < 1e-6
    assert result.residuals[-1] < 1e-4 * result.dry_residual
    assert result.pressure_error <= 1e-5
    assert result.force == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("case", CASES)
def test_complementarity(steady, case):
    """P >= 0 everywhere; where P = 0 no residual asks for pressure beyond the tolerance."""
    result = steady(*case, 128)
    assert (result.p >= 0.0).all()
    level = build_hierarchy(
        result.point, Mesh(128, result.domain, result.point.kappa), coarsest_intervals(result.point, 128)
    )[-1]
    level.P[...] = result.p.T
    level.update_film(result.approach)
    np.testing.assert_allclose(level.H.T, result.h, atol=1e-12)
    level.update_residual()
    assert level.residual_norm() == pytest.approx(result.residuals[-1], rel=1e-6)
    inner = level.r[:-1, 1:-1]
    dry = level.P[:-1, 1:-1] == 0.0
    assert dry.any()
    assert inner[dry].min() > -30.0 * result.residuals[-1]
    assert (result.h > 0.0).all()


def test_shapes_and_symmetry_line(steady):
    result = steady(200, 10, 0.5, 64)
    assert result.x.shape == (65,)
    assert result.y[0] == 0.0
    assert result.p.shape == result.h.shape == (65, result.y.size)
    assert (result.p[[0, -1]] == 0.0).all()
    assert (result.p[:, -1] == 0.0).all()
    assert 0.0 < result.h_min <= result.h.min()  # between the nodes
    i = np.argmin(np.abs(result.x))
    assert result.h_central == pytest.approx(result.h[i, 0], rel=1e-2)
    assert result.p_max == result.p.max()
    assert result.cycles == len(result.residuals) - 1 == len(result.approach_changes)
    assert result.pressure_changes.shape == result.approach_changes.shape


def test_result_is_frozen(steady):
    result = steady(200, 10, 0.5, 64)
    with pytest.raises(AttributeError):
        result.approach = 1.0
    for f in fields(result):
        value = getattr(result, f.name)
        if isinstance(value, np.ndarray):
            with pytest.raises(ValueError, match="read-only"):
                value[...] = 0.0


def test_summary_is_plain(steady):
    import json

    summary = steady(200, 10, 0.5, 64).to_dict()
    assert json.loads(json.dumps(summary)) == summary
    wanted = (
        "approach force h_central h_min p_max moment pressure_error residual load_residual cycles seconds status "
        "n domain"
    )
    assert set(wanted.split()) <= set(summary)


@pytest.mark.parametrize("numbers", [(200, 10, 0.5), (20, 5, 0.3)])
def test_moment_of_pressure_is_the_rolling_resistance(steady, numbers):
    """It resists; the shear by the flow that pressure drives loses the power that the moment takes (docstring).

    ``iint h dp/dx = moment f a/Rx`` is ``iint H dP/dX = 4 pi/3 S moment`` in Hertz units, over all of Y.
    """
    result = steady(*numbers, 128)
    X, Y, P, H = result.x, result.y, result.p, result.h
    both = 2.0 * np.trapezoid(np.trapezoid(P * X[:, None], X, axis=0), Y)
    assert 0.0 < result.moment == pytest.approx(-1.5 / np.pi * both, rel=1e-12)
    drag = 2.0 * np.trapezoid(np.trapezoid(H * np.gradient(P, X, axis=0), X, axis=0), Y)
    assert drag == pytest.approx(4.0 * np.pi / 3.0 * shape_factor(numbers[2]) * result.moment, rel=0.01)


def test_pressure_error_is_what_further_cycles_change():
    """Ended early, a solve says how far its pressure still moves: within a factor of two here."""
    end = solve_steady(POINT, grid=Grid(n=64), tol=1e-10)
    for cycles in range(3, end.cycles - 2):
        early = solve_steady(POINT, grid=Grid(n=64), tol=1e-10, max_cycles=cycles, throw=False, method="multigrid")
        np.testing.assert_array_equal(early.pressure_changes, end.pressure_changes[:cycles])
        moved = np.abs(end.p - early.p).max()
        assert moved < 2.0 * early.pressure_error, cycles
    assert cycles > 3
    assert end.pressure_error <= 1e-10 < early.pressure_error


def test_tol_is_of_the_pressure():
    """The sharper solve goes on from where the looser one ended, which is as near as was asked."""
    ends = {tol: solve_steady(POINT, grid=Grid(n=64), tol=tol) for tol in (1e-3, 1e-5, 1e-10)}
    assert ends[1e-3].cycles <= ends[1e-5].cycles < ends[1e-10].cycles  # the approach settles to 1e-7 in all
    for tol in (1e-3, 1e-5):
        assert ends[tol].pressure_error <= tol
        assert np.abs(ends[tol].p - ends[1e-10].p).max() < tol


def test_a_grid_too_coarse_for_its_film_is_said_in_words():
    """The equations of a grid may be solved, and its film still be far from that of a finer one."""
    fine = solve_steady(MoesPoint(200, 10, 1), grid=Grid(n=128))
    assert fine.error_estimate.h_min_relative < 0.1 and fine.reservation == ""
    coarse = solve_steady(MoesPoint(200, 10, 1), grid=Grid(n=48))
    assert coarse.status.ok and abs(coarse.h_min / fine.h_min - 1.0) > 0.1
    said = coarse.reservation
    assert f"central film may be off by {100.0 * coarse.error_estimate.h_central_relative:.0f} %" in said
    assert coarse.error_estimate.h_min_relative == 1.0 and "smallest film may be off by anything" in said
    assert said in repr(coarse) and coarse.to_dict()["reservation"] == said
    assert replace(coarse, status=Status.MAX_CYCLES).reservation == ""


def test_prescribed_approach_is_the_inverse(steady):
    """The approach found under load 1 gives back load 1."""
    free = steady(200, 10, 0.5, 64)
    held = solve_steady(POINT, grid=Grid(n=64), approach=free.approach)
    assert held.approach == pytest.approx(free.approach, abs=1e-7)
    assert held.force == pytest.approx(1.0, abs=3e-5)
    np.testing.assert_allclose(held.p, free.p, atol=1e-3)
    more = solve_steady(POINT, grid=Grid(n=64), approach=free.approach + 0.05)
    assert more.force > 1.05


def test_operating_point_is_its_moes_point():
    op = OperatingPoint(Geometry(0.004, 0.01), Lubricant(0.08, 1.9e-8), 30.0, 1.3)
    si, plain = solve_steady(op, grid=Grid(n=32)), solve_steady(op.moes, grid=Grid(n=32))
    assert si.approach == plain.approach * op.scales.length
    assert si.point is op and plain.point == op.moes == si.dimensionless.point


def test_domain_is_reported_and_used(steady):
    wide = solve_steady(POINT, grid=Grid(n=96, domain=Domain(-6.0, 1.5, 4.5)))
    assert wide.domain.as_tuple() == (-6.0, 1.5, 4.5)
    assert (wide.x[0], wide.x[-1], wide.y[-1]) == (-6.0, 1.5, 4.5)
    assert wide.approach == pytest.approx(steady(200, 10, 0.5, 64).approach, abs=0.01)


def test_too_few_cycles_raise_with_the_result():
    with pytest.raises(
        ConvergenceError, match=r"max_cycles after 1 iterations on n = 64: The cycles ran out"
    ) as caught:
        solve_steady(POINT, grid=Grid(n=64), max_cycles=1)
    result = caught.value.result
    assert result.status is Status.MAX_CYCLES
    assert result.cycles == 1
    assert result.approach == pytest.approx(0.883, abs=0.02)


def test_throw_false_returns_the_same_kind():
    result = solve_steady(POINT, grid=Grid(n=64), max_cycles=1, throw=False)
    assert result.status is Status.MAX_CYCLES
    assert not result.status.ok


def test_pressure_at_the_outlet_is_not_called_converged():
    """A film still under pressure where the grid ends was not computed; more room settles it."""
    point = MoesPoint(5, 5, 0.12)
    narrow = solve_steady(point, grid=Grid(n=64, domain=Domain(-12.0, 1.5, 5.0)), throw=False)
    assert narrow.status is Status.OUT_OF_DOMAIN
    assert "domain" in narrow.status.advice
    assert solve_steady(point, grid=Grid(n=64, domain=Domain(-12.0, 4.0, 8.0))).status is Status.CONVERGED


def test_callback_sees_every_cycle():
    seen = []
    result = solve_steady(POINT, grid=Grid(n=32), callback=lambda cycle, residual: seen.append((cycle, residual)))
    assert [cycle for cycle, _ in seen] == list(range(1, result.cycles + 1))
    assert all(residual > 0.0 for _, residual in seen)


def test_repeats_bit_for_bit():
    one, other = solve_steady(POINT, grid=Grid(n=48)), solve_steady(POINT, grid=Grid(n=48))
    assert (one.p == other.p).all()
    assert one.approach == other.approach


@pytest.mark.parametrize(("M", "L", "kappa"), [(5, 1, 0.08), (7, 1, 0.08), (5, 25, 0.08)])
def test_lightest_corner_of_the_box(M, L, kappa):
    """The film holds the bodies apart by many dry approaches: u must be free to go far in few Newton steps."""
    result = solve_steady(MoesPoint(M, L, kappa))
    assert result.approach < -5.0
    assert result.n == 128


def test_prescribed_approach_above_one_gets_room():
    result = solve_steady(MoesPoint(200, 10, 0.5), approach=5.0)
    assert result.status == "converged"
    assert result.domain.x_out > 2.0
    assert result.force > 11.0


@pytest.mark.parametrize(("M", "kappa"), [(200, 1.0), (20, 0.2)])
def test_film_at_l_0_is_the_limit_of_small_l(M, kappa):
    """No jump: what is left of the difference falls with L, and with the viscosity at the Hertz pressure."""
    limit, *others = (
        solve_steady(MoesPoint(M, L, kappa), grid=Grid(n=64), tol=1e-8) for L in (0.0, 1e-6, 1e-3, 0.01)
    )
    for film in others:
        far = 10.0 * film.point.moes.alpha_bar
        for name in ("approach", "h_central", "h_min"):
            assert getattr(film, name) == pytest.approx(getattr(limit, name), rel=far), (film.point.moes.L, name)
    assert others[-1].h_central != limit.h_central


@pytest.fixture
def cycles_fail(monkeypatch):
    """No V cycles settle a film; Newton steps are for grids with at most so many nodes."""
    run = steady_module._Film.run

    def failing(attempt, **settings):
        return run(attempt, **settings) if attempt.method.newton else Status.STAGNATED

    monkeypatch.setattr(steady_module._Film, "run", failing)
    return lambda nodes: monkeypatch.setattr(mesh, "LARGEST_NEWTON", nodes)


@pytest.mark.long
def test_newton_on_a_coarser_grid_where_cycles_fail_on_one_too_large_for_it(cycles_fail):
    """Better a film whose error estimate tells what the coarser mesh costs than none; but not where n is given."""
    thin = MoesPoint(500, 10, 0.8)
    wanted = mesh.mesh_for(thin, mesh.Purpose.FILM)
    cycles_fail(wanted.nodes / 3.9)
    found = solve_steady(thin)
    assert found.status.ok and found.n == wanted.n // 2 and found.domain == wanted.domain
    alone = solve_steady(thin, grid=Grid(n=found.n, domain=wanted.domain), method="newton")
    assert found.error_estimate.h_min_relative > 0.0 and found.h_min == pytest.approx(alone.h_min, rel=1e-5)
    for left in ({"n": wanted.n}, {"method": "multigrid"}):
        assert solve_steady(thin, **with_grid(**left, throw=False)).status is Status.STAGNATED


@pytest.mark.slow
def test_a_contact_five_times_as_long_as_wide():
    """Its smallest film is known within the limits on n = 2048, too large for Newton steps: cycles settle it."""
    found = solve_steady(MoesPoint(43.93, 1.475, 4.847))
    assert found.n == 2048 and found.h_min == pytest.approx(0.00547, rel=0.01)
    assert found.error_estimate.h_min_relative < 0.03


@pytest.mark.slow  # up to a minute of one core each
@pytest.mark.parametrize(
    ("M", "L", "kappa"),
    [
        (1467.49, 11.942, 1.63943),
        (4450.34, 1.63101, 3.59249),
        (8401.19, 5.87443, 1.29327),
        (19730.4, 0.483425, 2.40502),
    ],
)
def test_thin_side_lobes_are_answered_within_the_budget(monkeypatch, M, L, kappa):
    """The last takes 63 s in two attempts and does not know its smallest film; a third was 32 s, in vain."""
    made, attempts = [], steady_module.attempts
    monkeypatch.setattr(
        steady_module, "attempts", lambda *a, **k: (made.append(one) or one for one in attempts(*a, **k))
    )
    solve_steady(MoesPoint(20, 8, 0.5))  # compiled
    made.clear()
    started = time.process_time()
    result = solve_steady(MoesPoint(M, L, kappa))
    assert time.process_time() - started < 1.5 * steady_module.BUDGET
    assert sum(one.expected_time for one in made) < steady_module.BUDGET
    error = result.error_estimate
    assert result.status is Status.CONVERGED and error.approach < 1e-3
    assert error.h_central_relative < 0.1  # that of the last moves from 5 to 8 % with the sixth digit of the point
    assert ("smallest film may be off" in result.reservation) == (error.h_min_relative > 0.1)


@pytest.mark.parametrize("given", [{}, {"n": 32}, {"method": "newton", "n": 32}, {"refine": False}])
def test_a_limit_of_cycles_ends_the_solve(monkeypatch, given):
    """No finer grid, no other method: that is not what whoever limits the work asks for."""
    runs, run = [], steady_module._Film.run
    monkeypatch.setattr(steady_module._Film, "run", lambda *a, **k: runs.append(1) or run(*a, **k))
    with pytest.raises(
        ConvergenceError, match=r"max_cycles after 1 iterations on n = \d+: The cycles ran out"
    ) as caught:
        solve_steady(MoesPoint(20, 8, 0.5), **with_grid(max_cycles=1, tol=1e-9, **given))
    assert caught.value.result.cycles == 1 and len(runs) == 1


@pytest.mark.long
def test_a_budget_ends_the_attempts_with_the_best_film(monkeypatch):
    """Time of one core that the grids let expect, the same on any machine; a given grid is solved in any case."""
    runs, run = [], steady_module._Film.run
    monkeypatch.setattr(
        steady_module._Film, "run", lambda film, **k: runs.append(film.mesh.nodes) or run(film, **k)
    )
    point = MoesPoint(246.7, 19.94, 1.298)
    full, every = solve_steady(point, budget=inf), runs[:]
    assert full.error_estimate.h_min_relative < 0.03 and len(every) == 3
    for count in (1, 3):  # the last grid has to fit even if it fails: there is a film already
        runs.clear()
        expected = CYCLES_TIME * sum(every[: count - 1]) + FAILED_TIME * every[count - 1]
        found = solve_steady(point, budget=1.01 * expected)
        assert runs == every[:count] and found.status.ok
        assert found.error_estimate.h_min_relative > 0.03 or count == 3
    assert found.h_min == full.h_min
    runs.clear()
    assert solve_steady(point, budget=1.01 * CYCLES_TIME * sum(every)).status.ok
    assert runs == every[:2]
    runs.clear()
    assert solve_steady(point, budget=1e-3, grid=Grid(n=64), throw=False).n == 64


def test_up_to_a_circle_a_finer_grid_is_expected_to_succeed():
    mesh = Mesh(512, Domain(), 0.75)
    first = Attempt(mesh, Method(False, 1), status=Status.CONVERGED)
    finer = Attempt(replace(mesh, n=1024), first.method, first)
    longer = Attempt(replace(finer.mesh, kappa=1.2), first.method, first)
    assert finer.expected_time == CYCLES_TIME * finer.mesh.nodes
    assert longer.expected_time == FAILED_TIME * longer.mesh.nodes


def test_an_attempt_that_the_budget_forbids_is_named(monkeypatch):
    monkeypatch.setattr(steady_module._Film, "run", lambda *_, **__: Status.STAGNATED)
    with pytest.raises(ConvergenceError, match=r"More would be tried with a budget above 1e-05 s"):
        solve_steady(MoesPoint(500, 10, 0.8), budget=1e-5)
    with pytest.raises(ConvergenceError) as caught:
        solve_steady(MoesPoint(500, 10, 0.8), budget=inf)
    assert "budget" not in str(caught.value)


@pytest.mark.parametrize("budget", [0.0, -1.0, float("nan"), "60"])
def test_budget_is_a_time(budget):
    with pytest.raises(InputError, match=r"budget = .*: must be "):
        solve_steady(MoesPoint(20, 8, 0.5), budget=budget)


@pytest.mark.parametrize("refine", ["no", None, 1])
def test_refine_is_a_truth_value(refine):
    with pytest.raises(InputError, match=r"refine = .*: must be True or False"):
        solve_steady(MoesPoint(20, 8, 0.5), refine=refine)


def test_pressure_at_the_side_border_is_told():
    """M = 5 at kappa = 0.12 floods this domain to its sides."""
    result = solve_steady(MoesPoint(5, 5, 0.12), grid=Grid(n=64, domain=Domain(-12.0, 2.5, 3.0)), throw=False)
    assert str(result.status) == "out_of_domain"
    assert "wider" in result.status.advice


def test_light_load_gets_room():
    """The default region of the same contact is wide enough, and the film carries it far apart."""
    result = solve_steady(MoesPoint(5, 5, 0.12), grid=Grid(n=64))
    assert result.approach < -5.0
    assert result.domain.x_in < -8.0


def test_film_below_the_grid_is_told():
    """Residuals below tolerance, but surfaces that overlap: no result to rely on."""
    with pytest.raises(ConvergenceError, match="raise n") as caught:
        solve_steady(MoesPoint(200, 10, 1.0), grid=Grid(n=16))
    assert str(caught.value.result.status) == "unresolved"
    assert caught.value.result.h_min < 0.0


def test_interrupted_steady_solve_keeps_what_it_has():
    def stop(cycle, residual):
        if cycle == 2:
            raise KeyboardInterrupt

    result = solve_steady(POINT, grid=Grid(n=32), callback=stop)
    assert str(result.status) == "interrupted" and result.cycles == 2


@pytest.mark.parametrize("status", list(Status))
def test_each_status_has_advice_in_one_sentence(status):
    assert status.advice.endswith(".")
    assert "\n" not in status.advice
    assert status.ok == (status is Status.CONVERGED)


def test_status_reads_back_from_text():
    assert Status(str(Status.STAGNATED)) is Status.STAGNATED
    assert f"{Status.MAX_CYCLES}" == "max_cycles"
