"""The benchmarks' own pieces: that they measure what they say, on a small grid; no time is asserted."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ehlcontact import Grid, MoesPoint, solve_steady

FOLDER = Path(__file__).parent / "benchmarks"
POINT = MoesPoint(200, 10, 0.5)


@pytest.fixture(scope="module", autouse=True)
def tools():
    """Scripts import each other as neighbours."""
    known = set(sys.modules)
    sys.path.insert(0, str(FOLDER))
    yield
    sys.path.remove(str(FOLDER))
    for name in set(sys.modules) - known:
        if str(FOLDER) in str(getattr(sys.modules[name], "__file__", "")):
            sys.modules.pop(name)


@pytest.fixture(scope="module")
def row(tools):
    import time_to_accuracy as accuracy

    return accuracy.measure(POINT, 64, newton_nodes=10_000, default=True, threads=2)


def test_no_ratio_where_the_processor_was_shared():
    """What threads share is no waiting; what the wall saw alone is."""
    import conv

    with conv.Bracket(lambda: (4e-3, 4e-3)) as bracket:
        pass
    row = bracket.ratios({"accurate": {"seconds": 1.0, "cpu": 2.0}, "full": {"seconds": 2.0, "cpu": 1.6}})
    assert row["accurate"]["conv"] == pytest.approx(250.0)
    assert row["full"]["conv"] is None
    assert row["full"]["cpu_conv"] == pytest.approx(400.0)
    assert row["refused"] == "2 s for 1.6 s of work: the processor was shared"


def test_conv_is_the_smallest_of_its_runs(monkeypatch):
    import conv

    wall, cpu = iter([0.0, 3.0, 10.0, 11.0, 20.0, 22.0]), iter([0.0, 0.5, 1.0, 1.7, 2.0, 2.6])
    monkeypatch.setattr(conv.time, "perf_counter", lambda: next(wall))
    monkeypatch.setattr(conv.time, "process_time", lambda: next(cpu))
    assert conv.convolution(3) == (1.0, 0.5)


@pytest.mark.parametrize(("after", "ratio"), [(4.5e-3, 1.0 / 4.25e-3), (4.7e-3, None), (3.4e-3, None)])
def test_no_ratio_where_conv_drifts(after, ratio):
    """Before it is 4 ms: 12.5 % is quiet, 17.5 % either way is not."""
    import conv

    times = iter([(4e-3, 4e-3), (after, 4e-3)])
    with conv.Bracket(lambda: next(times)) as bracket:
        pass
    row = bracket.ratios({"seconds": 1.0, "cpu": 0.9, "full": {"seconds": 1.1, "cpu": 1.0}, "cycles": 3})
    assert row["conv_ms"] == [4.0, 1e3 * after]
    assert row["conv"] == (ratio and pytest.approx(ratio))
    assert row["full"]["cpu_conv"] == pytest.approx(250.0)
    assert (row["refused"] is None) == (ratio is not None)
    if ratio is None:
        assert "4.00 ms before" in row["refused"]


def test_errors_are_against_the_converged_film(row):
    assert row["reference"]["uncertainty"] < 1e-12
    assert row["verdict"] == "converges"
    falling = row["errors"]
    assert falling[row["full"]["cycles"]] <= 1e-8 < falling[row["full"]["cycles"] - 1]
    assert falling[row["accurate"]["cycles"]] <= 1e-3
    assert 0 < row["accurate"]["cycles"] < row["full"]["cycles"]
    assert row["factor"] == pytest.approx(
        (falling[row["full"]["cycles"]] / falling[0]) ** (1 / row["full"]["cycles"])
    )
    assert row["start"]["seconds"] < row["accurate"]["seconds"] < row["full"]["seconds"]
    assert row["peak_mb"] > 50.0


def test_two_threads_are_timed_over_the_same_cycles(row):
    for name in ("accurate", "full"):
        shared = row[f"{name}_shared"]
        assert shared["threads"] == 2 and shared["cycles"] == row[name]["cycles"]
        assert shared["cpu_conv"] / shared["cpu"] == pytest.approx(row[name]["cpu_conv"] / row[name]["cpu"])
    assert 0.0 < row["accurate_shared"]["seconds"] < row["full_shared"]["seconds"]


def test_converged_film_is_that_of_newton(row):
    assert row["newton_gap"]["P"] < 1e-9
    assert row["newton_gap"]["uncertainty"] < 1e-9


def test_converged_film_is_that_of_solve_steady(row):
    """Its own tolerance leaves the error that the row tells; a loose one is told to be none of that."""
    import time_to_accuracy as accuracy

    exact = accuracy.converge(POINT, accuracy.mesh_for(POINT, accuracy.Purpose.FILM, grid=Grid(n=64)))
    result = solve_steady(POINT, grid=Grid(n=64))
    error = float(np.abs(result.p.T - exact.state.P).max())
    assert row["solve_steady"]["errors"]["P"] == pytest.approx(error, rel=1e-3)
    assert row["solve_steady"]["accurate"]


def test_an_unconverged_film_is_not_accurate():
    import time_to_accuracy as accuracy

    film, start, advance = accuracy.film_on(
        POINT, accuracy.mesh_for(POINT, accuracy.Purpose.FILM, grid=Grid(n=64))
    )
    start()
    first = accuracy.State.of(film)
    found = accuracy.settle(film, advance, 60)
    assert found.knows(accuracy.FULL)
    assert not accuracy.Errors.between(first, found.state).accurate
    assert accuracy.Errors.between(accuracy.State.of(film), found.state).accurate
    start()
    assert not accuracy.settle(film, advance, 3).knows(accuracy.FULL)
    assert not accuracy.settle(film, lambda: None, 3).knows(accuracy.FULL)


def test_work_of_a_cycle_is_counted_in_sweeps():
    """Twice the sweeps on all levels are twice the work."""
    import time_to_accuracy as accuracy

    film, start, _ = accuracy.film_on(POINT, accuracy.mesh_for(POINT, accuracy.Purpose.FILM, grid=Grid(n=64)))
    start()
    work = accuracy.count_work(film)
    for level in film.levels[1:]:
        for _ in range(6):
            level.relax()
    assert work() == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("errors", "told", "over"),
    [
        ([1.0, 1e-3, 1e-6, 9e-9, 1e-9], "converges", True),
        ([1.0, 1e-3, 1e-6, 9e-9], "converges", False),
        ([1.0, 3.0, 1e3], "diverges", True),
        ([1.0, float("nan")], "diverges", True),
        ([1.0, *[1e-3] * 30], "stagnates at 1e-03", True),
        ([0.8**k for k in range(40)], "too slow: 2e-04 after 39", False),
    ],
)
def test_verdicts(errors, told, over):
    import time_to_accuracy as accuracy

    assert accuracy.verdict(errors) == told
    assert accuracy.is_over(errors) is over


def test_reached_is_reached_for_good():
    import time_to_accuracy as accuracy

    def errors(P):
        return accuracy.Errors(P, 0.0, 0.0, 0.0, 0.0)

    assert accuracy.first([errors(P) for P in (1.0, 1e-9, 1e-2, 1e-9, 1e-9)], accuracy.is_full) == 3
    assert accuracy.first([errors(1.0)], accuracy.is_full) is None


@pytest.mark.parametrize("motion", [pytest.param("free", marks=pytest.mark.long), "harmonic"])
def test_step_in_the_middle_of_a_run(motion):
    import time_to_accuracy

    row = time_to_accuracy.measure_step(POINT, motion, 64, steps=5, repeat=1)
    assert row["verdict"] == "converges"
    assert row["errors"][row["full"]["cycles"]] <= 1e-8
    assert row["accurate"]["cycles"] <= row["full"]["cycles"]
    assert row["simulate"]["status"] == "converged"
    assert row["errors"][row["simulate"]["cycles"]] == pytest.approx(row["simulate"]["errors"]["P"], rel=1e-6)


def doubled(x):
    return {"twice": 2 * x}


def test_rows_survive_and_only_missing_ones_are_measured(tmp_path, capsys):
    import row_file

    path = tmp_path / "rows.json"
    tasks = [row_file.Task(str(k), doubled, (k,), 1.0) for k in range(3)]
    first = row_file.RowFile(path, "tool")
    first.put("0", {"twice": "kept"})
    first.put("1", {"twice": 0, "refused": "busy"})
    second = row_file.RowFile(path, "tool")
    assert [task.key for task in second.missing(tasks)] == ["1", "2"]
    for task in second.missing(tasks):
        second.put(task.key, task.work(*task.arguments))
    assert [row["twice"] for row in json.loads(path.read_text())["rows"]] == ["kept", 2, 4]
    row_file.measure_missing(second, tasks, lambda key, row: "never")
    assert "3 of 3 known" in capsys.readouterr().out
    with pytest.raises(SystemExit, match="--again"):
        row_file.RowFile(path, "another")
    assert row_file.RowFile(path, "another", again=True).rows == {}


def test_a_process_that_dies_takes_no_row_along(tmp_path):
    import row_file

    rows = row_file.RowFile(tmp_path / "rows.json", "tool")
    # functions that a fresh process finds: a row of its own, and the end
    kept = row_file.Task("kept", dict, ([("twice", 2)],), 1.0)
    tasks = [kept, row_file.Task("dies", os._exit, (1,), 1.0), kept._replace(key="after")]
    row_file.measure_missing(rows, tasks, lambda key, row: "", lasting=True, tries=2)
    assert {key: row.get("twice") for key, row in rows.rows.items()} == {"kept": 2, "dies": None, "after": 2}
    assert rows.rows["dies"]["status"] == "process died"


def test_points_are_24_and_resolved_somewhere():
    import cycles

    assert len(set(cycles.POINTS)) == 24
    tasks = cycles.tasks(cycles.chosen([]), [128, 1024], "cycles")
    assert {task.key.split()[0] for task in tasks} == {f"{M:g}:{L:g}:{k:g}" for M, L, k in cycles.POINTS}
    assert "500:8:3 128" not in {task.key for task in tasks}
    assert cycles.chosen(["4", "20:10:.7"]) == [(2900, 19, 0.107), (20.0, 10.0, 0.7)]


def test_a_row_short_of_what_is_asked_for_says_so(row):
    import cycles

    assert cycles.fault(row) == ""
    assert "more than 12" in cycles.fault(row | {"full": {"cycles": 13}})
    far = row["newton_gap"] | {"P": 2e-9}
    assert cycles.fault(row | {"newton_gap": far}) == "2e-09 of P from Newton's solution"
    assert "above 0.3" in cycles.fault(row | {"factor_v21": 0.31})
    assert "stagnates" in cycles.fault(row | {"full": None, "verdict": "stagnates at 1e-03"})


def test_more_points_of_the_box_add_to_the_fewer():
    import box

    few, many = box.box_points(40, 5), box.box_points(300, 5)
    assert len(many) == 300
    assert many[:40] == few
    assert all(point.p_hertz < box.MEASURED.p_hertz for point in many)


def test_thinnest_films_are_solved_on_twice_the_grid():
    import box

    row = box.solve(100.0, 5.0, 0.5) | {"key": "0"}
    assert row["status"] == "converged"
    finer = box.solve_finer(row)
    twice = solve_steady(MoesPoint(100.0, 5.0, 0.5), grid=Grid(n=2 * row["n"]))
    assert finer["move"] == pytest.approx(abs(row["h_min"] / twice.h_min - 1.0), rel=1e-3)
    assert 0.0 < finer["move"] < 0.1
    text = "\n".join(box.summary([row, row | {"status": "nonfinite"}], [finer | {"move": 0.5}]))
    assert "converged 1 of 2 (50.0%): 1 converged, 1 nonfinite" in text
    assert "1 move by more than 10 %" in text
    too_fine = box.solve_finer(row | {"n": 2048})
    assert too_fine["move"] is None
    assert too_fine["status"].startswith("not solved")


def test_films_with_close_lines_are_solved_on_twice_the_grid():
    """Which `solve_steady` does not: it knows no close lines where n is given."""
    import box

    point = MoesPoint(97.0, 10.56, 1.489)
    coarse = box.finer_close_lines(point, box.Mesh(64, box.Domain(), point.kappa, 2))
    row = coarse._asdict() | {"M": point.M, "L": point.L, "kappa": point.kappa, "key": "0", "n": 64, "apart": 0.5}
    finer = box.solve_finer(row | {"domain": box.Domain().as_tuple(), "error_estimate": {"h_min_relative": 0.2}})
    again = box.finer_close_lines(point, box.Mesh(128, box.Domain(), point.kappa, 2))
    assert finer["status"] == "converged"
    assert finer["move"] == pytest.approx(abs(coarse.h_min / again.h_min - 1.0))
    assert finer["move"] > 1e-3


def test_page_holds_a_place_for_every_table(row):
    import page

    text = page.PAGE.read_text(encoding="utf-8")
    run = {"tool": "run.py", "rows": [row | {"key": "steady 200-10-1 256"}]}
    for name in ("steady", "steps", "others", "published", "cycles", "box"):
        assert (
            page.replaced(text, name, "x").count(f"<!-- {name}, made by page.py -->\nx\n<!-- end of {name} -->")
            == 1
        )
    new, left = page.remade(text, [run])
    assert left == ["steps", "others", "cycles", "box"]
    assert f"| 200, 10, 0.5 | 64 | {page.reached(row['accurate'])} |" in new
    assert f" | {page.shared_ratio(row, 'full')} | " in new
    assert page.remade(new, [run])[0] == new


def test_tables_of_points_and_box(row):
    import page

    text = page.PAGE.read_text(encoding="utf-8")
    lost = {"key": "5:12:0.12 128", "verdict": "stagnates at 1e-03", "n": 128, "date": "d", "commit": "c"}
    points = {"tool": "cycles.py", "settings": {}, "rows": [row | {"key": "200:10:0.5 64"}, lost]}
    good = {"M": 5.0, "L": 1.0, "kappa": 1.0, "status": "converged", "seconds": 3.0}
    found = [
        good | {"key": "0"},
        good | {"key": "1", "status": "diverged"},
        {"key": "thin 0", "of": "0", "move": 0.2},
    ]
    box = {"tool": "box.py", "settings": {"seed": 77}, "made": {"date": "d", "commit": "c"}, "rows": found}
    new, _ = page.remade(text, [points, box])
    full = f"{row['full']['cycles']}, {page.number(row['factor_v21'])}"
    assert f"| 200, 10, 0.5 | {full} |  |\n| 5, 12, 0.12 |  | stagnates at 1e-03 |" in new
    assert "1 of 2 reach 1e-8" in new
    assert "| 77 | 2 | 1 (50.0%) | 1 `diverged` | 3.00 s / 0.1 min | 1 of 1, worst 20.0% |" in new


@pytest.mark.parametrize(
    ("value", "text"),
    [(None, "-"), (0.123456, "0.12"), (12.3, "12"), (775.0, "775"), (1234.5, "1234"), (2e-7, "2.0e-07")],
)
def test_numbers_in_tables(value, text):
    import page

    assert page.number(value, 2 if value is None or value < 100 else 4) == text


def test_sweeps_smooth_whatever_the_oil():
    """By local mode analysis, where lines lie up to four node distances apart; two nodes along one do not do."""
    import modes

    for apart in (1.0, 2.0, 4.0):
        assert max(modes.smoothing_factor(flow, apart) for flow in modes.FLOWS) < 0.5
    assert modes.smoothing_factor(0.01, 4.0, along=2) > 0.9


def test_local_modes_without_film_are_gauss_seidel_by_lines():
    """Where flow is all there is, the zebra factor of Poisson's equation: 1/4 on squares (Trottenberg 2001)."""
    import modes

    assert modes.smoothing_factor(1e6, 1.0) == pytest.approx(0.25, rel=0.02)


def test_steps_of_an_fmu_are_timed_from_c(tmp_path):
    import fmu_steps

    timed = fmu_steps.prepare("cubic", "extrapolated", tmp_path)
    *rest, _, _ = timed
    row = fmu_steps.median_step([*rest, "10", "3"])  # periods, repetitions
    assert 0.0 < row["us"] == row["cpu"] <= row["seconds"] + 0.01
    timed[2] = "{another}"  # GUID
    refused = subprocess.run(timed, capture_output=True, text=True)
    assert (refused.returncode, refused.stderr) == (1, "no instance\n")
