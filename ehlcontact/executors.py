"""Executors of `concurrent.futures` for long tasks: processes of this machine, or a Dask cluster.

`executor_for` gives either; `results_of` runs a set of tasks on one, and repeats those whose worker died.
"""

from __future__ import annotations

import os
import pickle
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from typing import Any, TypeVar

from ehlcontact.errors import ConvergenceError, InputError, warn_user
from ehlcontact.process.beside import COMPILE_BESIDE, child_environment

T = TypeVar("T")
Work = TypeVar("Work")

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
ATTEMPTS = 3  # at a task whose worker dies
CONNECT_SECONDS = 10
WORKER_SECONDS = 5.0  # after which a scheduler without a worker is worth a warning
TICK = 0.05  # seconds between looks at processes that are to end


class WorkerDiedError(Exception):
    """A worker process ended before its task did; the message has its last words."""


class ProcessExecutor(Executor):
    """Executor whose tasks run in processes of their own sessions, so many side by side.

    A process that dies fails its task alone, with `WorkerDiedError`; another one takes its place. All end with
    this process, however it ends. As a context manager it kills, at the end of the block, what still runs.

    Parameters
    ----------
    processes : int
        At most so many.
    threads : int, optional
        Of each, in libraries of linear algebra; by default as in this process.
    report : callable, optional
        Called as ``report(args, value)``, in a thread, with the positional arguments of a task and what it gave to
        `ehlcontact.process.worker.report`.
    """

    def __init__(
        self,
        processes: int,
        threads: int | None = None,
        report: Callable[[tuple[Any, ...], Any], None] | None = None,
    ) -> None:
        self._pool = ThreadPoolExecutor(processes)
        self._environment = _environment(threads, beside=processes < 2)
        self._report = report
        self._lock = threading.Lock()
        self._idle: list[_Process] = []
        self._busy: list[_Process] = []
        self._closing = False

    def submit(self, fn: Callable[..., T], /, *args: Any, **kwargs: Any) -> Future[T]:
        """Run ``fn(*args, **kwargs)`` in a process; all of it must be picklable."""
        return self._pool.submit(self._run, fn, args, kwargs)

    def _run(self, fn: Callable[..., T], args: tuple[Any, ...], kwargs: dict[str, Any]) -> T:
        with self._lock:
            if self._closing:
                raise WorkerDiedError("the executor is shut down")
            process = self._idle.pop() if self._idle else _Process(self._environment)
            self._busy.append(process)
        try:
            result: T = process.call((fn, args, kwargs), lambda value: self._report and self._report(args, value))
        finally:
            with self._lock:
                self._busy.remove(process)
                if process.dead:
                    process.end()
                else:
                    self._idle.append(process)
        return result

    def interrupt(self, patience: float, impatient: Callable[[], bool] = lambda: False) -> None:
        """Begin nothing more; send SIGINT to what runs, and kill what still runs after `patience` seconds.

        Parameters
        ----------
        patience : float
            Seconds.
        impatient : callable
            Whether to kill at once; called again and again.
        """
        self._close()
        for process in self._busy_now():
            process.popen.send_signal(signal.SIGINT)
        deadline = time.monotonic() + patience
        while self._busy_now() and time.monotonic() < deadline and not impatient():
            time.sleep(TICK)
        self.kill()

    def kill(self) -> None:
        """Kill what runs; its futures raise `WorkerDiedError`."""
        self._close()
        for process in self._busy_now():
            process.popen.kill()
        self._pool.shutdown(wait=True)
        for process in self._idle:
            process.end()
        self._idle.clear()

    def _close(self) -> None:
        with self._lock:
            self._closing = True
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _busy_now(self) -> list[_Process]:
        with self._lock:
            return list(self._busy)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Accept no more tasks; wait for those that were submitted, unless told otherwise."""
        self._pool.shutdown(wait=wait, cancel_futures=cancel_futures)
        if wait:
            self.kill()

    def __exit__(self, *_: object) -> None:
        self.kill()


class _Process:
    """A worker process, and what it says on stderr."""

    def __init__(self, environment: Mapping[str, str]) -> None:
        self.dead = False
        self._begin = 0  # of what the task at hand says on stderr
        self._errors = tempfile.TemporaryFile(mode="w+", encoding="utf-8", errors="replace")
        # A session of its own: Ctrl-C in the terminal comes to the parent alone, which passes it on once.
        self.popen = subprocess.Popen(
            [sys.executable, "-c", "from ehlcontact.process.worker import serve; serve()"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            env=environment,
            start_new_session=True,
        )

    def call(self, task: Any, report: Callable[[Any], object]) -> Any:
        """Result of a task; raises what it raised, or `WorkerDiedError`."""
        assert self.popen.stdin is not None and self.popen.stdout is not None
        try:
            pickle.dump(pickle.dumps(task), self.popen.stdin)
            self.popen.stdin.flush()
            kind = "report"
            while kind == "report":
                kind, value = pickle.load(self.popen.stdout)
                if kind == "report":
                    report(value)
        except (EOFError, OSError, pickle.UnpicklingError):
            self.dead = True
            code = self.popen.wait()
            self._errors.seek(self._begin)
            lines = self._errors.read().strip().splitlines()
            raise WorkerDiedError(f"its process died: {lines[-1] if lines else f'exit code {code}'}") from None
        self._begin = os.fstat(self._errors.fileno()).st_size
        if kind == "error":
            raise value
        return value

    def end(self) -> None:
        """Close its stdin, upon which it ends, and reap it."""
        assert self.popen.stdin is not None and self.popen.stdout is not None
        with suppress(OSError):
            self.popen.stdin.close()
        self.popen.stdout.close()
        self.popen.wait()
        self._errors.close()


def _environment(threads: int | None, beside: bool) -> dict[str, str]:
    """Environment of a worker. Unless `beside`, it compiles alone: workers of a pool compile beside each other."""
    own = {} if threads is None else dict.fromkeys(THREADS, str(threads))
    if not beside:
        own[COMPILE_BESIDE] = "0"
    return child_environment() | own


@contextmanager
def executor_for(
    processes: int,
    threads: int | None = None,
    scheduler: str | None = None,
    report: Callable[[tuple[Any, ...], Any], None] | None = None,
    waiting: Callable[[], object] = lambda: None,
) -> Iterator[Executor]:
    """Executor of processes of this machine, or of the Dask cluster at an address; nothing outlives the block.

    The block begins once a worker of the cluster is there. A scheduler may be without one for long, as where its
    workers are jobs in a queue: after some seconds there is a `RuntimeWarning`.

    Parameters
    ----------
    processes, threads, report
        As in `ProcessExecutor`; without effect on a cluster.
    scheduler : str, optional
        Address of a Dask scheduler.
    waiting : callable, optional
        Called again and again until there is a worker; what it raises ends the wait.

    Raises
    ------
    InputError
        ``dask.distributed`` is not installed, or no scheduler answers there.
    """
    if scheduler is None:
        with ProcessExecutor(processes, threads, report) as executor:
            yield executor
        return
    require_scheduler(scheduler)
    import distributed

    try:
        client = distributed.Client(scheduler, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise _no_scheduler(scheduler, error) from None
    with client, client.get_executor(retries=ATTEMPTS, pure=False) as executor:
        try:
            _await_worker(client, scheduler, waiting)
            yield executor
        finally:
            executor.shutdown(wait=False)  # a cluster that is left may go on for a long time


def _await_worker(client: Any, scheduler: str, waiting: Callable[[], object]) -> None:
    """Wait until there is a worker.

    A first task is submitted, for some clusters start workers only then; it may also wait for tasks of others.
    """
    first, begin, warned = client.submit(int, pure=False), time.monotonic(), False
    try:
        while not first.done():
            waiting()
            if not warned and time.monotonic() - begin > WORKER_SECONDS:
                if client.nthreads():
                    return
                text = f"no worker is connected to {scheduler}: nothing begins until one is"
                warn_user(text, RuntimeWarning)
                warned = True
            time.sleep(TICK)
    finally:
        first.cancel()


def require_scheduler(scheduler: str) -> None:
    """Make sure that a scheduler answers, before anything is made or begun.

    A client of Dask that finds none goes on looking after it was thrown away: 20 s, and a traceback at the end.

    Raises
    ------
    InputError
        ``dask.distributed`` is not installed, no address, or no scheduler there.
    """
    try:
        from distributed.comm import get_address_host_port
    except ImportError:
        raise InputError("--scheduler", scheduler, "used with dask: pip install 'ehlcontact[cluster]'") from None
    try:
        socket.create_connection(get_address_host_port(scheduler), CONNECT_SECONDS).close()
    except (OSError, ValueError) as error:
        raise _no_scheduler(scheduler, error) from None


def _no_scheduler(scheduler: str, error: Exception) -> InputError:
    reason = str(error) or type(error).__name__
    return InputError("--scheduler", scheduler, f"the address of a Dask scheduler ({reason})")


def died(error: BaseException) -> bool:
    """Whether an exception of a future says that its worker died, here or on a cluster."""
    return isinstance(error, WorkerDiedError) or type(error).__name__ == "KilledWorker"


def results_of(
    executor: Executor, function: Callable[[Work], T], tasks: Mapping[str, Work]
) -> Iterator[tuple[str, T]]:
    """Run ``function(work)`` for all tasks; give name and result as they come.

    A task whose worker dies is tried again, three times in all.

    Raises
    ------
    ConvergenceError
        Workers keep dying at a task, which the message names.
    """
    running = {executor.submit(function, work): (name, 1) for name, work in tasks.items()}
    while running:
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            name, attempt = running.pop(future)
            error = future.exception()
            if error is None:
                yield name, future.result()
            elif not died(error):
                raise error
            elif attempt == ATTEMPTS or not isinstance(error, WorkerDiedError):
                reason = f"workers died {ATTEMPTS} times at {name} (out of memory?): {error}"
                raise ConvergenceError(f"{reason}; what was solved is kept", None)
            else:
                running[executor.submit(function, tasks[name])] = name, attempt + 1
