"""The cycle: fixed points, agreement with Newton on one grid, and its rate of convergence."""

from math import inf

import numpy as np
import pytest

from ehlcontact import Domain, Grid, MoesPoint, solve_steady, steady
from ehlcontact.solver.attempts import CLOSE_LAST_RESORT, CLOSE_METHODS, CONTINUATION, FROM_HALF, METHODS
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.grid_rules import coarsest_intervals
from ehlcontact.solver.iterate import IterationHistory, StoppingCriteria, iterate
from ehlcontact.solver.level import Level
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.mesh_choice import NEAREST_DOMAIN, is_last
from ehlcontact.solver.multigrid import CONTINUATION_LOADING, Multigrid, initial_approach
from ehlcontact.status import Status

LOAD = Balance.of_load()


def residual_of(mg):
    mg.finest.update_film(mg.u)
    mg.finest.update_residual()
    return mg.finest.residual_norm()


@pytest.mark.parametrize("kappa", [0.3, 1.0])
def test_two_algorithms_one_discretisation(solve_by_newton, kappa):
    """Cycles over two grids end where Newton on the finest alone ends."""
    point = MoesPoint(20, 8, kappa)
    level, u = solve_by_newton(point)
    cycles = Multigrid(point, Mesh(32, Domain(), point.kappa))
    assert len(cycles.levels) == 2
    cycles.full_multigrid(LOAD)
    for _ in range(25):
        cycles.cycle(LOAD)
    assert residual_of(cycles) < 1e-10
    assert cycles.u == pytest.approx(u, abs=1e-10)
    np.testing.assert_allclose(cycles.finest.P, level.P, atol=1e-9)


def test_solution_is_a_fixed_point_of_the_cycle():
    mg = Multigrid(MoesPoint(20, 8, 0.5), Mesh(64, Domain(), 0.5))
    mg.full_multigrid(LOAD)
    for _ in range(30):
        mg.cycle(LOAD)
    P, u = mg.finest.P.copy(), mg.u
    assert residual_of(mg) < 1e-10
    mg.cycle(LOAD)
    assert mg.u == pytest.approx(u, abs=1e-11)
    np.testing.assert_allclose(mg.finest.P, P, atol=1e-10)


@pytest.mark.parametrize("balance", [Balance.of_approach(0.7), Balance(3.0, 1.0, 3.2)], ids=["approach", "motion"])
def test_other_balances_close_the_cycle(balance):
    mg = Multigrid(MoesPoint(20, 8, 0.5), Mesh(64, Domain(), 0.5))
    mg.full_multigrid(balance)
    for _ in range(20):
        mg.cycle(balance)
    assert residual_of(mg) < 1e-8
    assert abs(balance.residual(mg.u, mg.finest.force())) < 1e-9


CASES = [(20, 10, 1), (58.07, 4.62, 1), (200, 10, 0.5), (200, 10, 1), (500, 15, 0.12)]


@pytest.mark.parametrize(("M", "L", "kappa"), CASES)
def test_residual_falls_fourfold_per_cycle(M, L, kappa):
    """Five V(2,1) cycles after full multigrid, n = 128: geometric mean of the factors at least 4."""
    result = solve_steady(MoesPoint(M, L, kappa), grid=Grid(n=128), tol=1e-13, max_cycles=6, throw=False)
    residuals = result.residuals
    assert (residuals[0] / residuals[5]) ** 0.2 >= 4.0


@pytest.mark.parametrize(("M", "L", "kappa"), CASES)
def test_no_limit_cycle(M, L, kappa):
    """The classical hybrid relaxation stalls around 1e-3 to 1e-4; this goes on to rounding."""
    result = solve_steady(MoesPoint(M, L, kappa), grid=Grid(n=64), tol=1e-12, max_cycles=60, throw=False)
    assert result.residual < 1e-10


@pytest.mark.parametrize(("kappa", "L", "M"), [(0.11, 19.0, 2900.0), (0.1, 15.0, 1e4), (2.0, 10.0, 200.0)])
def test_hard_points_converge(M, L, kappa):
    """Real bearings live at high M; an ellipse along rolling is the weak direction of X lines."""
    result = solve_steady(MoesPoint(M, L, kappa), grid=Grid(n=128))
    assert result.residual < 1e-4


@pytest.mark.parametrize(
    ("M", "L", "kappa", "viscosity"), [(500, 15, 0.12, "barus"), (2900, 19, 0.11, "roelands")]
)
def test_incompressible_oil_at_high_pressure(M, L, kappa, viscosity):
    """Steep flanks without compressibility: nodes there swing to and fro if relaxation takes eps as given."""
    result = solve_steady(MoesPoint(M, L, kappa, viscosity=viscosity, density="incompressible"), grid=Grid(n=128))
    assert result.residual < 1e-4


@pytest.mark.parametrize(("M", "L", "kappa"), [(152.9, 3.33, 0.084), (200, 10, 3.0), (50, 5, 5.0)])
def test_narrow_ellipses_converge(M, L, kappa):
    """Long axis across or along rolling: mesh, switch value and coarsest grid follow kappa.

    The equations are solved; whether 128 intervals resolve the film of a long ellipse is another matter, and told.
    """
    result = solve_steady(MoesPoint(M, L, kappa), grid=Grid(n=128), throw=False)
    assert result.residual < 1e-4 and abs(result.load_residual) < 1e-6
    assert result.status in (("converged",) if result.h_min > 0.0 else ("unresolved",))


@pytest.mark.slow
def test_where_single_sweeps_fail_twice_as_many_take_over():
    """Oil so stiff on lines so far apart that cycles swing by more than the Hertz pressure."""
    point = MoesPoint(4200, 30, 0.057)
    plain, result = (
        solve_steady(point, grid=Grid(n=512), method=m, throw=False) for m in ("multigrid", "automatic")
    )
    assert not plain.status.ok
    assert result.status.ok and result.pressure_error < 1e-5
    assert result.h_central == pytest.approx(solve_steady(point, grid=Grid(n=256)).h_central, rel=2e-3)


def test_each_way_of_a_method_is_tried_in_turn(monkeypatch):
    """Twice the sweeps, from a new start; then the film on half the intervals as a start; at last Newton steps."""
    tried = []

    def failing(attempt, *_, **__):
        tried.append((attempt.method, attempt.multigrid.sweep_factor, attempt.multigrid.least_sweep_factor))
        return Status.STAGNATED

    monkeypatch.setattr(steady._Film, "run", failing)
    monkeypatch.setattr("ehlcontact.solver.attempts.remedy", lambda *_, **__: None)
    every = METHODS["automatic"]
    for name, n, ways, sweep_factors in (
        ("automatic", 256, every, [1, 2, 1, 2]),
        ("automatic", 128, (*every[:2], every[3]), [1, 2, 2]),
        ("multigrid", 32, METHODS["multigrid"], [1]),
        ("newton", 32, METHODS["newton"], [1]),
    ):
        tried.clear()
        assert solve_steady(MoesPoint(20, 8, 0.5), grid=Grid(n), method=name, throw=False).status == "stagnated"
        assert tried == [(way, e, e) for way, e in zip(ways, sweep_factors, strict=True)]
    assert [way.newton for way in every] == [False, False, False, True]
    assert [way.from_half for way in every] == [False, False, True, False]


@pytest.mark.parametrize("sweep_factor", [1, 2, 4])
def test_effort_repeats_the_sweeps_of_a_cycle(monkeypatch, sweep_factor):
    """Two sweeps on the way down, one on the way up, flanks before the last of each; all of it so many times."""
    mg = Multigrid(MoesPoint(20, 8, 0.5), Mesh(64, Domain(), 0.5), sweep_factor=sweep_factor)
    mg.full_multigrid(LOAD)
    moves = []
    for name in ("relax", "relax_flanks"):
        plain = getattr(Level, name)
        monkeypatch.setattr(Level, name, lambda level, n=name, f=plain: (moves.append((n, level.nx)), f(level))[1])
    mg.cycle(LOAD)
    down, up = ["relax", "relax_flanks", "relax"] * sweep_factor, ["relax_flanks", "relax"] * sweep_factor
    sizes = [level.nx for level in mg.levels[1:]]
    expected = [(name, nx) for nx in sizes[::-1] for name in down] + [(name, nx) for nx in sizes for name in up]
    assert moves == expected


@pytest.mark.parametrize(("M", "L", "kappa"), [(20, 10, 1.0), (200, 0, 0.35)])
def test_more_effort_makes_a_cycle_converge_faster(M, L, kappa):
    """Where sweeps are what limits it, as in isoviscous oil."""
    ends = []
    for sweep_factor in (1, 2):
        mg = Multigrid(MoesPoint(M, L, kappa), Mesh(128, Domain(), kappa), sweep_factor=sweep_factor)
        mg.full_multigrid(LOAD)
        ends.append([mg.cycle(LOAD) for _ in range(4)][-1])
    assert ends[1] < 0.2 * ends[0]


def test_a_cycle_tells_the_largest_change_of_the_pressure():
    mg = Multigrid(MoesPoint(20, 8, 0.5), Mesh(64, Domain(), 0.5))
    mg.full_multigrid(LOAD)
    for _ in range(4):
        before = mg.finest.P.copy()
        change = mg.cycle(LOAD)
        assert change == max(abs(after - p) for after, p in zip(mg.finest.P.flat, before.flat, strict=True)) > 0.0


def test_a_cycle_leaves_film_and_residual_of_its_pressure():
    mg = Multigrid(MoesPoint(20, 8, 0.5), Mesh(64, Domain(), 0.5))
    mg.full_multigrid(LOAD)
    mg.cycle(LOAD)
    H, r = mg.finest.H.copy(), mg.finest.r.copy()
    mg.finest.update(mg.u)
    np.testing.assert_array_equal((mg.finest.H, mg.finest.r), (H, r))


@pytest.mark.parametrize("kappa", [0.19, 0.09])
def test_coarsening_along_x_alone_ends_where_newton_ends(solve_by_newton, kappa):
    """The same film from levels halved along X, both, and Y; the restricted equations lose nothing on the way."""
    point = MoesPoint(20, 8, kappa)
    level, u = solve_by_newton(point)
    mg = Multigrid(point, Mesh(32, Domain(), point.kappa))
    assert (mg.finest.nx, mg.finest.ny) == (level.nx, level.ny)
    assert [(k.nx, k.ny) for k in mg.levels] == [(16, 8), (16, 16), (32, 16)]
    mg.full_multigrid(LOAD)
    for _ in range(25):
        mg.cycle(LOAD)
    assert residual_of(mg) < 1e-10
    assert mg.u == pytest.approx(u, abs=1e-10)
    np.testing.assert_allclose(mg.finest.P, level.P, atol=1e-9)


@pytest.mark.parametrize("kappa", [0.05, 0.09, 0.3])
def test_lines_far_apart_cost_no_cycles(kappa):
    """Halved along X first, the change of the pressure falls fivefold a cycle, however far the lines lie apart."""
    mg = Multigrid(MoesPoint(200, 10, kappa), Mesh(128, Domain(), kappa))
    mg.full_multigrid(LOAD)
    changes = [mg.cycle(LOAD) for _ in range(8)]
    assert (changes[1] / changes[7]) ** (1.0 / 6.0) >= 5.0


@pytest.mark.long
def test_close_lines_show_side_lobes():
    """Of a film that comes out negative on lines as far apart as the nodes; cycles fall as fast as elsewhere."""
    point, domain = MoesPoint(1351.4385, 3.4935, 4.7044), Domain(-1.5, 1.2, 1.25)
    mg = Multigrid(point, Mesh(512, domain, point.kappa, 4))
    assert mg.halved().mesh == Mesh(256, domain, point.kappa, 4)
    mg.full_multigrid(LOAD)
    for _ in range(11):  # after the tenth 1.0e-4, by how kernels round
        change = mg.cycle(LOAD)
    assert change < 1e-4 and mg.finest.H.min() > 1e-4
    assert {level.M for level in mg.levels} == {point.M}


LOBES = MoesPoint(11268.36, 1.25058, 3.411192)  # of the box: side lobes a thirtieth as thick as the centre


@pytest.mark.slow
def test_a_careful_start_finds_side_lobes_that_cycles_lose():
    """From a coarsest level of six lines across, in steps of the load by four, the first cycles swing for good."""
    film = steady._Film(LOBES, Mesh(1024, NEAREST_DOMAIN, LOBES.kappa, 4), CLOSE_METHODS[1], "fft", 1)
    assert film.run(LOAD, 1e-5, 20, None) is Status.CONVERGED
    assert film.multigrid.levels[0].nx == 128
    assert film.multigrid.finest.lowest_film() == pytest.approx(2.08e-5, rel=0.01)


@pytest.mark.parametrize("most", [1.3, 1.0], ids=["small steps settle", "none does"])
def test_careful_steps_of_the_load_are_taken_back_where_they_do_not_settle(monkeypatch, most):
    """Halved from a factor of two until one settles, and on with that; pressure and approach as before it."""
    mg = Multigrid(LOBES, Mesh(64, Domain(), LOBES.kappa), load_continuation=True)
    level, settled, tried = mg.finest, [100.0], []
    mg.u = 0.25

    def repeat(self, k, cycles, balance):
        assert (level.P.max(), self.u) == (0.0, 0.25) or cycles == 1
        if level.M > most * settled[-1]:
            level.P[3, 3] += 0.2
            self.u += 1.0
        elif cycles == 1:
            settled.append(level.M)
        tried.append(level.M)

    monkeypatch.setattr(Multigrid, "_repeat", repeat)
    last = len(mg.levels) - 1
    assert mg._raise_load(last, 100.0, 180.0, LOAD) == len(settled) - 1
    assert level.M == 180.0
    if most == 1.0:
        assert len(settled) == 1
        assert tried[::2] == pytest.approx([180.0, *(100.0 * 2.0 ** (0.5**k) for k in range(1, 5))])
    else:
        assert settled == pytest.approx([100.0, 100.0 * 2.0**0.25, 100.0 * 2.0**0.5, 100.0 * 2.0**0.75, 180.0])
        assert mg.u == 0.25 and not level.P.any()


@pytest.mark.parametrize("fault", ["swings", "negative"])
def test_a_start_of_a_finer_grid_carries_what_leaves_its_film_positive(monkeypatch, fault):
    """The finer one goes on from there: on half the intervals side lobes may be negative under the whole load."""
    mg = Multigrid(LOBES, Mesh(128, Domain(), LOBES.kappa), load_continuation=True).halved()
    level, most = mg.finest, 300.0
    mg.u = 0.25

    def repeat(self, k, cycles, balance):
        level.P[3, 3] += 0.2 if fault == "swings" and level.M > most else 0.001

    def update_film(u):
        level.H[...] = -1e-9 if fault == "negative" and level.M > most else 1.0

    monkeypatch.setattr(Multigrid, "_repeat", repeat)
    monkeypatch.setattr(level, "update_film", update_film)
    mg._raise_load(len(mg.levels) - 1, 100.0, LOBES.M, LOAD)
    assert most / CONTINUATION_LOADING**0.125 < level.M <= most
    assert mg.u == 0.25 and 0.0 < level.P.max() < 0.05  # as the last step that settled left it


@pytest.mark.parametrize(("load_continuation", "sweep_factor"), [(False, 4), (True, 1)])
def test_sweeps_of_a_careful_film_are_not_repeated(load_continuation, sweep_factor):
    """However slowly its changes fall: repeated, they let side lobes grow."""
    mg = Multigrid(MoesPoint(20, 8, 0.5), Mesh(64, Domain(), 0.5), load_continuation=load_continuation)
    mg.full_multigrid(LOAD)
    iterate(mg, LOAD, lambda balance: 1.0, StoppingCriteria(1e9, 1e-9, 8, 1e-7, 1e-7), IterationHistory())
    assert mg.sweep_factor == sweep_factor


@pytest.mark.long
def test_where_cycles_fail_on_close_lines_a_careful_start_follows(monkeypatch):
    tried = []

    def run(attempt, **_):
        tried.append((attempt.method.load_continuation, attempt.mesh.y_refinement))
        return Status.CONVERGED if attempt.method.load_continuation else Status.DIVERGED

    monkeypatch.setattr(steady._Film, "run", run)
    assert solve_steady(LOBES, budget=inf, throw=False).status is Status.CONVERGED
    assert tried[-2:] == [(False, 4), (True, 4)]
    assert set(tried[:-2]) == {(False, 1)}
    tried.clear()
    assert solve_steady(LOBES, budget=inf, method="multigrid", throw=False).status is Status.DIVERGED
    assert not any(load_continuation for load_continuation, _ in tried)


@pytest.mark.long
def test_after_all_affordable_grids_one_more_is_tried_carefully(monkeypatch):
    """And Newton steps on a coarser one after it, whose film is the last word."""
    tried = []

    def run(attempt, **_):
        tried.append((attempt.mesh, attempt.method))
        return Status.DIVERGED

    monkeypatch.setattr(steady._Film, "run", run)
    assert solve_steady(LOBES, budget=inf, throw=False).status is Status.DIVERGED
    last = [(mesh, method) for mesh, method in tried if is_last(mesh)]
    assert last == [(Mesh(2048, NEAREST_DOMAIN, LOBES.kappa, 4), CONTINUATION)]
    assert tried[-2:] == [*last, (Mesh(512, NEAREST_DOMAIN, LOBES.kappa, 4), CLOSE_LAST_RESORT)]


def test_initial_approach_is_bounded():
    assert initial_approach(MoesPoint(1e-3, 5, 1.0)) == -1.0
    assert initial_approach(MoesPoint(1e6, 0, 1.0)) == 0.99


def test_coarsest_grid_follows_the_load():
    assert coarsest_intervals(MoesPoint(200, 10, 1.0), 128) == 16
    assert coarsest_intervals(MoesPoint(2900, 19, 0.11), 128) > 16


@pytest.mark.parametrize("kappa", [0.05, 0.107, 1.0, 1.5, 3.0, 4.7044])
@pytest.mark.parametrize("y_refinement", [1, 2, 4])
@pytest.mark.parametrize("domain", [Domain(), NEAREST_DOMAIN])
def test_half_a_grid_has_half_its_lines(kappa, y_refinement, domain):
    """The film of the one is restricted to the other node by node; 96 lines to 64 read beyond the array."""
    point = MoesPoint(1351.4385, 3.4935, kappa)
    mg = Multigrid(point, Mesh(256, domain, kappa, y_refinement))
    while mg.finest.nx > mg.levels[0].nx and mg.mesh.n > 64:
        half = mg.halved()
        assert (2 * half.finest.nx, 2 * half.finest.ny) == (mg.finest.nx, mg.finest.ny)
        mg = half


@pytest.mark.long
def test_from_the_film_on_half_the_intervals_the_film_comes_out_the_same():
    point, ways = MoesPoint(60, 12, 2.0), []
    for method in (METHODS["automatic"][0], FROM_HALF):
        film = steady._Film(point, Mesh(256, Domain(), point.kappa), method, "fft", 1)
        assert film.run(balance=LOAD, tol=1e-7, most=40) is Status.CONVERGED
        ways.append(film)
    np.testing.assert_allclose(ways[1].multigrid.finest.H, ways[0].multigrid.finest.H, rtol=0.0, atol=1e-6)
    assert ways[1].track.residuals[0] < ways[0].track.residuals[0]


@pytest.mark.slow
def test_the_spike_of_stiff_oil_settles_on_the_finest_grid_too():
    """Cycles from full multigrid leave it in a wrong place on 1024 intervals, where 128 to 512 converge."""
    point = MoesPoint(10.578275745164795, 22.686698423096647, 3.702352703409106)
    coarse, fine = (solve_steady(point, grid=Grid(n)) for n in (512, 1024))
    assert fine.h_central == pytest.approx(coarse.h_central, rel=5e-4)
    assert fine.h_min == pytest.approx(coarse.h_min, rel=1e-3)
