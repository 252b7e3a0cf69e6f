"""BLAS on one thread within a solve, and as it was afterwards."""

import threading

import pytest
import scipy
from threadpoolctl import threadpool_info, threadpool_limits

from ehlcontact import (
    FreeVibration,
    Grid,
    InputError,
    MoesPoint,
    TimeSteps,
    TransientContact,
    impedance,
    simulate,
    solve_steady,
)
from ehlcontact.process.blas import blas_threads, one_blas_thread
from ehlcontact.process.threads import threads_allowed

POINT = MoesPoint(200, 10, 0.5)


def limits():
    return [library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"]


@pytest.fixture(autouse=True)
def three():
    """As on a machine of three cores."""
    with threadpool_limits(3, user_api="blas"):
        assert limits(), "no BLAS found"
        assert set(limits()) == {3}
        yield
        assert set(limits()) == {3}


def test_blocks_nest():
    with one_blas_thread():
        assert set(limits()) == {1}
        with one_blas_thread():
            assert set(limits()) == {1}
        assert set(limits()) == {1}
        assert blas_threads() == 3  # what it has outside
    assert blas_threads() == 3


def test_blocks_overlap_in_two_threads():
    """The first to begin is not the last to end."""
    begun, end = threading.Event(), threading.Event()

    def other():
        with one_blas_thread():
            begun.set()
            end.wait(10.0)

    thread = threading.Thread(target=other)
    with one_blas_thread():
        thread.start()
        assert begun.wait(10.0)
    assert set(limits()) == {1}
    end.set()
    thread.join()


def test_default_of_a_solve_within_a_block(monkeypatch):
    monkeypatch.setattr("ehlcontact.process.threads.cores", lambda: 8)
    with one_blas_thread():
        assert threads_allowed() == 3


def test_after_an_error():
    with pytest.raises(InputError):
        solve_steady(POINT, grid=Grid(n=17))
    assert set(limits()) == {3}


CALLS = {
    "film": lambda: solve_steady(POINT, grid=Grid(n=32)),
    "newton": lambda: solve_steady(POINT, grid=Grid(n=32), method="newton"),
    "run": lambda: simulate(POINT, FreeVibration(Omega_n=5.13), grid=Grid(n=32), time=TimeSteps(until=0.1)),
    "response": lambda: impedance(POINT, Omega=[0.0], grid=Grid(n=32)),
    "contact": lambda: TransientContact(POINT, grid=Grid(n=32)).advance(0.1, 0.9),
}


@pytest.mark.parametrize("call", CALLS)
def test_every_solve(call, monkeypatch):
    """Wherever a dense matrix is factorised."""
    seen, factors = [], scipy.linalg.lu_factor

    def watched(*args, **kwargs):
        seen.extend(limits())
        return factors(*args, **kwargs)

    monkeypatch.setattr(scipy.linalg, "lu_factor", watched)
    CALLS[call]()
    assert set(seen) == {1}


def test_solves_in_a_step_of_a_contact(monkeypatch):
    contact, seen = TransientContact(POINT, grid=Grid(n=32)), []
    advance = contact._film.advance
    monkeypatch.setattr(contact._film, "advance", lambda *args: seen.extend(limits()) or advance(*args))
    contact.advance(0.1, 0.9)
    assert set(seen) == {1}
