"""`Team`: every item once, whatever the number of threads; and what befalls its threads."""

import copy
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from itertools import pairwise

import numpy as np
import pytest
from argument_groups import grouped
from threadpoolctl import threadpool_limits

from ehlcontact import (
    Grid,
    HarmonicLoad,
    MoesPoint,
    TransientContact,
    impedance,
    simulate,
    solve_steady,
)
from ehlcontact.checks.machine import require_threads
from ehlcontact.process import threads as threads_module
from ehlcontact.process.threads import CALLING_THREAD, LEAST_CHUNK, Team, cores, team_of, threads_allowed

POINT = MoesPoint(200, 10, 0.5)
NUMBERS = [1, 2, 3, 7]


def count(first, last, counts, who):
    counts[first:last] += 1
    who[first:last] = threading.get_ident()
    time.sleep(0.02)  # lets the others begin


@pytest.mark.parametrize("threads", NUMBERS)
@pytest.mark.parametrize("items", [0, 1, LEAST_CHUNK, 2 * LEAST_CHUNK, 31, 1000])
def test_every_item_once(threads, items):
    counts, who = np.zeros(items, dtype=int), np.zeros(items, dtype=np.int64)
    Team(threads).run(count, items, counts, who)
    assert (counts == 1).all()
    assert np.unique(who).size <= threads
    if items == 1000:  # each chunk takes a while, so that all come to help
        assert np.unique(who).size == threads
    if items < 2 * LEAST_CHUNK:
        assert (who == threading.get_ident()).all()


def test_chunks_are_the_same_every_time():
    def note(first, last, chunks):
        chunks[first] = last

    team, bounds = Team(3), [100 * k // 12 for k in range(13)]
    for _ in range(20):
        chunks = {}
        team.run(note, 100, chunks)
        assert chunks == dict(pairwise(bounds))


def test_few_items_may_be_worth_a_thread():
    counts, who = np.zeros(2, dtype=int), np.zeros(2, dtype=np.int64)
    Team(2).run(count, 2, counts, who, least=1)
    assert (counts == 1).all() and np.unique(who).size == 2


def test_threads_are_started_once():
    team, before = Team(3), threading.active_count()
    for _ in range(5):
        team.run(lambda first, last: None, 100)
    assert threading.active_count() == before + 2
    assert all(thread.daemon for thread in threading.enumerate() if thread.name.startswith("ehlcontact-"))


@pytest.mark.parametrize("bad", [0, 40, 99])
def test_what_a_chunk_raises_comes_out(bad):
    begun, ended = set(), set()

    def kernel(first, last):
        begun.add(first)
        time.sleep(0.01)
        ended.add(first)
        if first <= bad < last:
            raise ZeroDivisionError(f"item {bad}")

    team = Team(3)
    with pytest.raises(ZeroDivisionError, match=f"item {bad}"):
        team.run(kernel, 100)
    assert begun == ended  # the others were waited for,
    counts = np.zeros(1000, dtype=int)
    team.run(count, 1000, counts, np.zeros(1000, dtype=np.int64))
    assert (counts == 1).all()  # and are there again


def test_ctrl_c_waits_for_the_others():
    begun, ended, main = set(), set(), threading.get_ident()

    def kernel(first, last):
        begun.add(first)
        if threading.get_ident() == main:
            while len(begun) < 2:  # until the other is at one, too
                time.sleep(0.001)
            os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.1)
        ended.add(first)

    with pytest.raises(KeyboardInterrupt):
        Team(2).run(kernel, 100)
    assert len(begun - ended) <= 1  # that of the caller
    assert len(ended) in (1, 2)
    seen = set(begun)
    time.sleep(0.15)
    assert begun == seen  # and nobody goes on


def test_ctrl_c_while_waiting_for_the_others():
    ended, main = set(), threading.get_ident()
    other = threading.Event()

    def kernel(first, last):
        if threading.get_ident() == main:
            assert other.wait(10.0)
            return
        other.set()
        time.sleep(0.05)
        os.kill(os.getpid(), signal.SIGINT)  # the caller is at the end of its work
        time.sleep(0.1)
        ended.add(first)

    with pytest.raises(KeyboardInterrupt):
        Team(2).run(kernel, 2, least=1)
    assert len(ended) == 1


def test_who_comes_late_is_not_waited_for(monkeypatch):
    """And finds nothing to do."""
    late = threading.Event()
    serve = threads_module._Help.work

    def sleepy(help):
        late.wait(10.0)
        serve(help)

    monkeypatch.setattr(threads_module._Help, "work", sleepy)
    counts, who, team = np.zeros(100, dtype=int), np.zeros(100, dtype=np.int64), Team(2)
    started = time.monotonic()
    for _ in range(3):
        team.run(count, 100, counts, who)
    assert time.monotonic() - started < 8.0
    assert (counts == 3).all() and (who == threading.get_ident()).all()
    late.set()
    time.sleep(0.05)
    assert (counts == 3).all()


def test_runs_within_and_beside_a_run():
    """The others are taken: such a run does its work alone."""
    team, inner = Team(2), np.zeros((100, 50), dtype=int)

    def outer(first, last):
        for k in range(first, last):
            team.run(lambda a, b, row: row.__iadd__(np.arange(50) >= a) if b == 50 else None, 50, inner[k])

    team.run(outer, 100)
    assert (inner == 1).all()


def test_copies_share_the_team():
    assert copy.deepcopy(team_of(2)) is pickle.loads(pickle.dumps(team_of(2))) is team_of(2)
    assert CALLING_THREAD.threads == 1


def _total(threads):
    counts, who = np.zeros(100, dtype=int), np.zeros(100, dtype=np.int64)
    team_of(threads).run(count, 100, counts, who)
    return int(counts.sum()), np.unique(who).size, threads_allowed()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_after_a_fork():
    """Its threads are not there any more, and one of them may have held a lock."""
    assert _total(2)[:2] == (100, 2)
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.apply_async(_total, (2,)).get(timeout=60) == (100, 2, 1)
    assert _total(2)[:2] == (100, 2)


def test_interpreter_ends_with_threads_at_work():
    """The end of a program waits for no thread, at rest or not."""
    script = """
import threading, time
from ehlcontact.process.threads import Team
team = Team(3)
team.run(lambda first, last: None, 100)
threading.Thread(target=team.run, args=(lambda first, last: time.sleep(60), 100), daemon=True).start()
time.sleep(0.2)
"""
    started = time.monotonic()
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=50)
    assert (done.returncode, done.stderr) == (0, "")
    assert time.monotonic() - started < 40


# How many ------------------------------------------------------------------------------------------------------


def test_default_is_within_the_limits_of_blas(monkeypatch):
    monkeypatch.setattr("ehlcontact.process.threads.cores", lambda: 3)
    with threadpool_limits(2, user_api="blas"):
        assert threads_allowed() == 2
    with threadpool_limits(5, user_api="blas"):
        assert threads_allowed() == 3
    with threadpool_limits(1, user_api="blas"):
        assert threads_allowed() == require_threads("threads", None) == 1


def test_cores_of_this_process():
    assert 1 <= cores() <= os.cpu_count()
    if hasattr(os, "sched_getaffinity"):
        script = "import os; os.sched_setaffinity(0, {min(os.sched_getaffinity(0))}); " + (
            "from ehlcontact.process.threads import cores; print(cores())"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
        assert done.stdout == "1\n"


@pytest.mark.parametrize("threads", [2, pytest.param(3, marks=pytest.mark.long)])
def test_results_are_the_same_bit_for_bit(threads, monkeypatch):
    """On grids large enough to be shared, whatever the machine has."""
    monkeypatch.setattr("ehlcontact.checks.machine.cores", lambda: 8)
    monkeypatch.setattr("ehlcontact.solver.level.SHARED_FROM", 500)
    one, more = (solve_steady(POINT, grid=Grid(n=128), threads=k) for k in (1, threads))
    np.testing.assert_array_equal(one.p, more.p)
    np.testing.assert_array_equal(one.h, more.h)
    assert one.approach == more.approach
    settings = dict(n=96, until=0.2, dt=0.05)
    one, more = (simulate(POINT, HarmonicLoad(Omega=3.0), **grouped(**settings, threads=k)) for k in (1, threads))
    for name in ("approach", "force", "h_min"):
        np.testing.assert_array_equal(getattr(one, name), getattr(more, name))
    one, more = (impedance(POINT, Omega=[0.0, 3.0], grid=Grid(n=96), threads=k) for k in (1, threads))
    np.testing.assert_array_equal(one.stiffness, more.stiffness)
    np.testing.assert_array_equal(one.damping, more.damping)


def test_full_contact_is_copied_with_its_team():
    contact = TransientContact(POINT, grid=Grid(n=32), threads=1)
    twin = copy.deepcopy(contact)
    assert twin.advance(0.1, 0.9) == contact.advance(0.1, 0.9)
