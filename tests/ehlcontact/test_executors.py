"""Executors: results, errors, processes that die, interruption, and no worker without its parent."""

import math
import os
import subprocess
import sys
import threading
import time

import pytest
from programs import dask_cluster

from ehlcontact import executors
from ehlcontact.errors import ConvergenceError
from ehlcontact.executors import ProcessExecutor, WorkerDiedError, executor_for, results_of
from ehlcontact.process import worker

CHILD = "from ehlcontact.process.worker import serve; serve()"
HOLD = """
import time
from ehlcontact.executors import ProcessExecutor
executor = ProcessExecutor(1)
executor.submit(time.sleep, 100)
while not executor._busy:
    time.sleep(0.01)
print(executor._busy[0].popen.pid, flush=True)
time.sleep(100)
"""


@pytest.fixture(scope="module")
def executor():
    reports = []
    with ProcessExecutor(2, threads=1, report=lambda args, value: reports.append((args, value))) as executor:
        executor.reports = reports
        yield executor


def alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_results_and_errors_come_back(executor):
    assert list(executor.map(math.sqrt, [1.0, 4.0, 9.0])) == [1.0, 2.0, 3.0]
    assert executor.submit(os.getenv, "OPENBLAS_NUM_THREADS").result() == "1"
    with pytest.raises(ValueError, match="math domain error"):
        executor.submit(math.sqrt, -1.0).result()
    with pytest.raises(RuntimeError, match="cannot be sent"):
        executor.submit(threading.Lock).result()
    assert executor.submit(print, "on stdout").result() is None  # where answers leave, and is not in their way


def test_reports_arrive_with_the_arguments_of_their_task(executor):
    executor.submit(worker.report, 5).result()
    assert executor.reports == [((5,), 5)]
    worker.report(6)  # not in a worker: without effect
    assert len(executor.reports) == 1


def test_a_process_that_dies_fails_its_task_alone(executor):
    dying, well = executor.submit(os._exit, 3), executor.submit(math.sqrt, 4.0)
    with pytest.raises(WorkerDiedError, match="its process died: exit code 3"):
        dying.result()
    assert well.result() == 2.0 == executor.submit(math.sqrt, 4.0).result()


def test_a_task_whose_worker_dies_is_tried_again_and_named(executor, tmp_path):
    with pytest.raises(ConvergenceError, match=r"died 3 times at bad .*kept"):
        list(results_of(executor, os._exit, {"bad": 3}))
    assert dict(results_of(executor, math.sqrt, {"a": 1.0, "b": 4.0})) == {"a": 1.0, "b": 2.0}
    assert list(results_of(executor, math.sqrt, {})) == []


@pytest.mark.parametrize("hurry", [False, True])
def test_interruption_and_the_end_of_patience(hurry, tmp_path):
    """SIGINT raises `KeyboardInterrupt` in the task; one that does not listen is killed."""
    deaf = "import signal, time; signal.signal(signal.SIGINT, signal.SIG_IGN); " if hurry else "import time; "
    task = (exec, f"{deaf}open({str(tmp_path / 'begun')!r}, 'w').close(); time.sleep(100)")
    started = time.monotonic()
    with executor_for(1) as executor:
        running, waiting = executor.submit(*task), executor.submit(*task)
        while not (tmp_path / "begun").exists():
            time.sleep(0.01)
        executor.interrupt(20.0, lambda: hurry)
    assert isinstance(running.exception(), WorkerDiedError if hurry else KeyboardInterrupt)
    assert waiting.cancelled() and time.monotonic() - started < 20.0


def test_a_worker_ends_when_the_other_end_of_its_stdin_is_closed():
    child = subprocess.Popen([sys.executable, "-c", CHILD], stdin=subprocess.PIPE)
    time.sleep(0.5)
    assert child.poll() is None
    child.stdin.close()
    assert child.wait(10) == 1


def test_a_worker_ends_when_its_parent_is_killed():
    parent = subprocess.Popen([sys.executable, "-c", HOLD], stdout=subprocess.PIPE, text=True)
    pid = int(parent.stdout.readline())
    assert alive(pid)
    parent.kill()
    parent.communicate()
    until = time.monotonic() + 10.0
    while alive(pid):
        assert time.monotonic() < until
        time.sleep(0.02)


@pytest.mark.long
@pytest.mark.filterwarnings("always")
def test_a_scheduler_whose_workers_come_late(tmp_path, monkeypatch):
    """A warning, and the wait goes on until there is one, or it is ended."""
    pytest.importorskip("distributed")
    monkeypatch.setattr(executors, "WORKER_SECONDS", 0.5)
    late = []

    def interrupted():
        if time.monotonic() - started > 2.0:
            raise KeyboardInterrupt

    def begin(address):
        if not late and time.monotonic() - started > 2.0:
            module = [sys.executable, "-m", "distributed.cli.dask_worker", address, "--no-nanny", "--no-dashboard"]
            late.append(subprocess.Popen(module, cwd=tmp_path, stderr=subprocess.DEVNULL))

    with dask_cluster(tmp_path, workers=0) as (address, _):
        words, started = f"no worker is connected to {address}", time.monotonic()
        with pytest.warns(RuntimeWarning, match=words) as given, pytest.raises(KeyboardInterrupt):
            with executor_for(1, scheduler=address, waiting=interrupted):
                raise AssertionError
        assert len(given) == 1
        started = time.monotonic()
        with (
            pytest.warns(RuntimeWarning, match=words),
            executor_for(1, scheduler=address, waiting=lambda: begin(address)) as cluster,
        ):
            assert cluster.submit(math.sqrt, 4.0).result() == 2.0
        for worker_of_it in late:
            worker_of_it.kill()
            worker_of_it.wait()
