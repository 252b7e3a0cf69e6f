"""Run the stages of all points of a study side by side, each in its own process, with progress, resume and Ctrl-C.

Separate processes use the cores better than threads of one film: each worker gets one thread, unless told
otherwise. What is finished is noted (`points.ledger`) and skipped the next time. What is made of a point's
stages in the end is a task like them, that waits for them.
"""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

from ehlcontact.cli.progress import progressing
from ehlcontact.cli.study.points.board import Board, StorageError, Task
from ehlcontact.cli.study.points.journal import Journal
from ehlcontact.cli.study.points.lists import Point
from ehlcontact.cli.study.points.summary import withdraw
from ehlcontact.cli.study.stages import STAGES
from ehlcontact.errors import InputError
from ehlcontact.status import Status

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
ROOT = Path(__file__).parents[3]  # holds the package, also in a checkout that is not installed
PATIENCE = 30.0  # seconds that an interrupted worker has for saving


class Share(NamedTuple):
    """Of the machine, or whose machines."""

    jobs: int  # processes side by side
    threads: int = 1  # of each
    scheduler: str | None = None  # of a Dask cluster, which solves the stages


class _Worker:
    """One process and the thread that reads its events into the common queue."""

    def __init__(self, task: Task, events: queue.Queue, threads: int) -> None:
        self.task = task
        self.last: dict[str, Any] = {}
        path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
        # The code that runs here, not that of a checkout that one is in: it would be compiled once more.
        ours = {"PYTHONPATH": path, "PYTHONSAFEPATH": "1"}
        environment = os.environ | dict.fromkeys(THREADS, str(threads)) | ours
        where = str(task.point.study_file), str(task.point.folder)
        command = [sys.executable, "-m", f"{__package__}.worker", *where, task.name]
        self._errors = tempfile.TemporaryFile(mode="w+", encoding="utf-8")
        # Its own session: Ctrl-C in the terminal comes to us alone, and we pass it on once.
        self.process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            stdin=subprocess.PIPE,  # nothing comes through it: it closes when we end, and the worker ends, too
            env=environment,
            text=True,
            start_new_session=True,
        )
        self._thread = threading.Thread(target=self._read, args=(events,), daemon=True)
        self._thread.start()

    def _read(self, events: queue.Queue) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            try:
                event = json.loads(line)
            except ValueError:  # a library said something there: not ours to read
                continue
            if "status" in event:
                self.last = event
            else:
                events.put((self, event))
        events.put((self, None))

    def finish(self) -> dict[str, Any]:
        """Reap the process; its last event, or what it said on stderr if it died without one."""
        self._thread.join()
        assert self.process.stdout is not None and self.process.stdin is not None
        self.process.stdin.close()
        self.process.stdout.close()
        code = self.process.wait()
        self._errors.seek(0)
        said = self._errors.read().strip().splitlines()
        self._errors.close()
        if not self.last:
            message = f"its process died: {said[-1] if said else f'exit code {code}'}"
            self.last = {"status": Status.FAILED, "message": message, "seconds": 0.0}
        return self.last


def run_points(
    points: Sequence[Point], root: Path, share: Share, journal: Journal, *, closing: bool = True
) -> Board:
    """Run what is not done yet; what is done is noted on disk after every stage, and told by the board.

    One that fails does not stop the others, but nothing is made of the rest of its point. Ctrl-C, the signal of a
    `kill`, and a file that cannot be written let the workers save their partial results, and are raised then, the
    signal as `KeyboardInterrupt`. However this ends, no worker stays behind.

    Parameters
    ----------
    points : sequence of Point
        Their folders hold their study files.
    root : Path
        Of the results of all.
    share : Share
        How many run side by side, and where.
    journal : Journal
    closing : bool
        Whether results and report are made too.

    Raises
    ------
    StorageError
        There is no room for the result of a stage.
    InputError
        Nor for the notes; no cluster at that address.
    ConvergenceError
        Workers of the cluster keep dying.
    """
    board = Board(points, STAGES, root, journal, closing=closing)
    if gone := withdraw(root, [point.name for point in points], bool(board.todo)) if closing else ():
        journal.line("removed", f"{', '.join(gone)}: of what the study was; made again in the end")
    with progressing() as shown, _ended_like_ctrl_c() as interrupts:
        board.show(shown)
        if share.scheduler is not None:
            from ehlcontact.cli.study.points.cluster import solve_on_cluster

            solve_on_cluster(board, share.scheduler)
        _side_by_side(board, share, interrupts)
        board.finish()
    return board


def _side_by_side(board: Board, share: Share, interrupts: _Interrupts) -> None:
    """All that is left to do, on this machine."""
    events: queue.Queue = queue.Queue()
    running: list[_Worker] = []

    def end(worker: _Worker) -> None:
        last = worker.finish()
        running.remove(worker)
        board.end(worker.task, last)

    try:
        while True:
            while len(running) < share.jobs and (task := board.take()) is not None:
                with interrupts.held():  # else a process could begin and nobody would know
                    running.append(_Worker(task, events, share.threads))
                    board.begin(task)
            if not running:
                return
            worker, event = events.get()
            if event is None:
                with interrupts.held():
                    end(worker)
            elif "compiling" in event:
                board.compiling(worker.task)
            else:
                board.move(worker.task, event["done"], event["total"])
    except BaseException:
        _interrupt(running)
        for worker in list(running):
            with suppress(InputError, StorageError):  # the first error says why
                end(worker)
        raise
    finally:  # after a second Ctrl-C, or an error of our own
        for worker in running:
            worker.process.kill()
            worker.finish()


def _interrupt(running: list[_Worker]) -> None:
    """Let the workers save what they have; a second Ctrl-C, like the end of our patience, kills them."""
    for worker in running:
        worker.process.send_signal(signal.SIGINT)
    deadline = time.monotonic() + PATIENCE
    try:
        for worker in running:
            worker.process.wait(max(0.0, deadline - time.monotonic()))
    except (subprocess.TimeoutExpired, KeyboardInterrupt):
        for worker in running:
            worker.process.kill()


class _Interrupts:
    """What Ctrl-C and its like do: `KeyboardInterrupt`, but at the end of a block that holds it."""

    def __init__(self) -> None:
        self._holding = self._waiting = False

    def __call__(self, *_: object) -> None:
        """As a handler of signals."""
        if not self._holding:
            raise KeyboardInterrupt
        self._waiting = True

    @contextmanager
    def held(self) -> Iterator[None]:
        """No interrupt within the block."""
        self._holding = True
        try:
            yield
        finally:
            self._holding, waiting = False, self._waiting
            self._waiting = False
            if waiting:
                raise KeyboardInterrupt


@contextmanager
def _ended_like_ctrl_c() -> Iterator[_Interrupts]:
    """Let `kill`, `timeout` and the end of a session do as Ctrl-C does: workers have sessions of their own."""
    interrupts, asked = _Interrupts(), []
    if threading.current_thread() is threading.main_thread():
        asked = [signal.SIGTERM, signal.SIGHUP]
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # ignored by jobs in the background
            asked.append(signal.SIGINT)
    before = {number: signal.signal(number, interrupts) for number in asked}
    try:
        yield interrupts
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
