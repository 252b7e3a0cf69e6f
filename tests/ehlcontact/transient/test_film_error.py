"""The error of the grid of a run: that of the film it starts from, said as a steady film says it."""

from dataclasses import replace

import numpy as np
import pytest
from argument_groups import grouped

from ehlcontact import (
    Dent,
    FreeVibration,
    Grid,
    HarmonicLoad,
    KeepSettings,
    MoesPoint,
    PrescribedApproach,
    RampLoad,
    RunSettings,
    TimeSteps,
    read,
    save,
    simulate,
    solve_steady,
)
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.solver.mesh_choice import Purpose, mesh_for
from ehlcontact.status import Status
from ehlcontact.transient.transient_film import TransientFilm

POINT, NARROW = MoesPoint(200, 10, 0.5), MoesPoint(20, 5, 0.1)
HISTORY = ("approach", "rate", "force", "h_central", "h_min", "h_midplane", "p_midplane", "residuals", "cycles")
RUNS = {
    "harmonic": (POINT, HarmonicLoad(Omega=3.0), {"n": 32}),
    "let go": (POINT, FreeVibration(Omega_n=5.13, offset=0.05), {"n": 32}),
    "driven": (POINT, PrescribedApproach([0.0, 0.1, 0.2, 0.3], [0.85, 0.86, 0.86, 0.85]), {"n": 32}),
    "controlled": (POINT, RampLoad(1.5, 0.1, Omega_n=5.13), {"n": 32, "local_error": 1e-3}),
    "dent": (POINT, HarmonicLoad(Omega=3.0), {"n": 64, "surface": Dent(0.05, 0.8, start=-0.5, kappa=0.5)}),
    # whose levels have the same lines at first: another grid is made for the estimate
    "narrow": (NARROW, HarmonicLoad(Omega=3.0), {"n": 64}),
}


@pytest.mark.parametrize("name", RUNS)
def test_nothing_that_a_run_goes_on_from_is_changed(name, monkeypatch):
    point, motion, options = RUNS[name]
    told = simulate(point, motion, **grouped(until=0.1, snapshots=(0.0, 0.1), **options))
    monkeypatch.setattr(TransientFilm, "error_at_rest", lambda self, balance: None)
    silent = simulate(point, motion, **grouped(until=0.1, snapshots=(0.0, 0.1), **options))
    assert told.film_error is not None and silent.film_error is None
    for field in (*HISTORY, "snapshot_h", "snapshot_p"):
        np.testing.assert_array_equal(getattr(told, field), getattr(silent, field))


def test_the_state_of_the_film_stays():
    """Of the levels below the finest a state has the factors alone, which are those of the film itself."""
    film = TransientFilm(POINT, mesh_for(POINT, Purpose.RUN, grid=Grid(n=32)), 3e-3)
    film.start_steady(Balance.of_load())
    before = film.save_state()
    assert film.error_at_rest(Balance.of_load()) is not None
    after = film.save_state()
    assert after.factors is before.factors is not None
    assert after.u == before.u
    for name in ("P", "mass", "mass_before"):
        np.testing.assert_array_equal(getattr(after, name), getattr(before, name))


def test_it_is_that_of_the_steady_film():
    """Under the load at the start, or at the approach that holds the bodies there."""
    steady = solve_steady(POINT, grid=Grid(n=64))
    run = simulate(POINT, HarmonicLoad(Omega=3.0), grid=Grid(n=64), time=TimeSteps(until=0.02, dt=0.02, tol=1e-6))
    assert run.film_error.h_central_relative == pytest.approx(steady.error_estimate.h_central_relative, rel=0.02)
    assert run.film_error.approach == pytest.approx(steady.error_estimate.approach, rel=0.02)
    held = simulate(
        POINT,
        FreeVibration(Omega_n=5.13, offset=-0.2),
        grid=Grid(n=64),
        time=TimeSteps(until=0.02, dt=0.02, tol=1e-6),
    )
    there = solve_steady(POINT, grid=Grid(n=64, domain=held.domain), approach=float(held.approach[0]))
    assert held.film_error.approach == there.error_estimate.approach == 0.0
    assert held.film_error.h_central_relative == pytest.approx(there.error_estimate.h_central_relative, rel=0.02)


def test_what_lies_on_the_surfaces_at_rest_is_part_of_it():
    """A film of half the intervals without the dent would differ by all that the dent lets in, a twentieth."""
    dent = Dent(0.2, 1.0, start=0.0, kappa=0.5)
    run = simulate(
        POINT, HarmonicLoad(Omega=3.0), grid=Grid(n=128), time=TimeSteps(until=0.02, dt=0.02), surface=dent
    )
    assert run.h_central[0] > 1.05 * solve_steady(POINT, grid=Grid(n=128)).h_central
    assert run.film_error.h_central_relative < 0.015


def test_a_grid_too_coarse_is_said_in_the_words_of_the_steady_film():
    run = simulate(POINT, HarmonicLoad(Omega=3.0), grid=Grid(n=32), time=TimeSteps(until=0.02, dt=0.02))
    said = solve_steady(POINT, grid=Grid(n=32)).reservation
    assert said and run.reservation == said.replace("coarse: the", "coarse: at the start the")
    assert run.reservation in repr(run) and run.to_dict()["reservation"] == run.reservation
    assert run.to_dict()["film_error"]["h_central_relative"] == run.film_error.h_central_relative
    assert f"at the start ± {100.0 * run.film_error.h_central_relative:.2g} % in the centre" in repr(run)
    assert replace(run, status=Status.MAX_CYCLES).reservation == ""
    assert replace(run, film_error=ErrorEstimate(0.0, 0.05, 0.09)).reservation == ""
    both = replace(run, tol=1.0).reservation
    assert both.startswith(f"{run.reservation}; tol = 1 is coarse")


def test_it_is_kept_in_files_and_not_found_again_by_a_restart(tmp_path, monkeypatch):
    motion, file = HarmonicLoad(Omega=3.0), tmp_path / "run.h5"
    whole = simulate(POINT, motion, grid=Grid(n=32), time=TimeSteps(until=0.1, dt=0.02))
    simulate(
        POINT, motion, grid=Grid(n=32), time=TimeSteps(until=0.06, dt=0.02), keep=KeepSettings(checkpoint=file)
    )
    monkeypatch.setattr(TransientFilm, "error_at_rest", lambda self, balance: pytest.fail("found again"))
    resumed = simulate(
        POINT, motion, grid=Grid(n=32), time=TimeSteps(until=0.1, dt=0.02), keep=KeepSettings(restart=file)
    )
    assert resumed.film_error == whole.film_error
    for field in HISTORY:
        np.testing.assert_array_equal(getattr(resumed, field), getattr(whole, field))
    again = read(save(whole, tmp_path / "result.h5"))
    assert (again.film_error, again.reservation) == (whole.film_error, whole.reservation)


def test_a_start_that_fails_has_none():
    failed = simulate(
        MoesPoint(100, 8, 2.5),
        HarmonicLoad(Omega=3.0),
        grid=Grid(n=32),
        time=TimeSteps(until=0.1),
        run=RunSettings(throw=False),
    )
    assert not failed.status.ok and failed.steps == 0
    assert failed.film_error is None and failed.reservation == ""
