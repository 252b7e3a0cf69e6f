"""Run of a study: tasks of all points on worker processes or a cluster, with progress, resume and interruption.

Separate processes use the cores better than threads of one film: each gets one thread, unless told otherwise. What
is computed is kept by content (`points.kept`) and found the next time.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

from ehlcontact.cli.progress import progressing
from ehlcontact.cli.study.points.lists import Point
from ehlcontact.cli.study.points.log import Log
from ehlcontact.cli.study.points.scheduler import Scheduler, StorageError, Task
from ehlcontact.cli.study.points.summary import withdraw
from ehlcontact.cli.study.points.tasks import Answer, finalise_point, solve_stage
from ehlcontact.cli.study.stages import STAGES
from ehlcontact.executors import ProcessExecutor, executor_for
from ehlcontact.status import Status

PATIENCE = 30.0  # seconds that an interrupted worker has for saving
TICK = 0.1  # seconds between looks at interruptions


class Share(NamedTuple):
    """Processes of this machine, or a cluster."""

    jobs: int  # processes side by side
    threads: int = 1  # of each
    cluster: str | None = None  # address of the Dask scheduler of a cluster, which solves the stages


def run_points(points: Sequence[Point], root: Path, share: Share, log: Log, *, final: bool = True) -> Scheduler:
    """Run what is not computed yet; what a task computed is kept when it ends.

    A task that fails does not stop others, but its point is not finalised. Ctrl-C, SIGTERM, SIGHUP and a file that
    cannot be written let the workers save their partial results, and are raised then, signals as
    `KeyboardInterrupt`. No worker outlives the call.

    Parameters
    ----------
    points : sequence of Point
        Their folders hold their study files.
    root : Path
        Folder of the results of all.
    share : Share
        How many tasks run side by side, and where.
    log : Log
    final : bool
        Whether points are finalised: results and report made.

    Raises
    ------
    StorageError
        There is no room for the result of a stage.
    InputError
        There is no room for what is kept; no cluster at that address.
    """
    scheduler = Scheduler(points, STAGES, root, log, final=final)
    if gone := withdraw(root, [point.name for point in points], bool(scheduler.todo)) if final else ():
        log.line("removed", f"{', '.join(gone)}: of what the study was; made again in the end")
    with progressing() as shown, _interruptions() as interruptions:
        scheduler.show(shown)
        with executor_for(share.jobs, share.threads, report=scheduler.report) as here:
            assert isinstance(here, ProcessExecutor)
            if share.cluster is None:
                _run(scheduler, here, here, share, interruptions)
            else:
                with executor_for(share.jobs, scheduler=share.cluster) as there:
                    _run(scheduler, here, there, share, interruptions)
        scheduler.finish()
    return scheduler


def _run(
    scheduler: Scheduler, here: ProcessExecutor, there: Executor, share: Share, interruptions: Callable[[], int]
) -> None:
    """Run all that is to do: finalisation `here`, stages `there`."""
    running: dict[Future[Answer], Task] = {}
    slots = share.jobs if there is here else len(scheduler.todo)  # a cluster has its own queue
    try:
        while True:
            while len(running) < slots and (task := scheduler.take()) is not None:
                scheduler.begin(task)
                study = task.point.study.model_dump(exclude_unset=True, exclude_none=True)
                if task.stage is None:
                    future = here.submit(
                        finalise_point, task.key, study, task.point.folder, scheduler.seconds(task.point)
                    )
                else:
                    future = there.submit(solve_stage, task.key, study, task.stage.name)
                running[future] = task
            if not running:
                return
            for future in wait(running, timeout=TICK, return_when=FIRST_COMPLETED).done:
                scheduler.end(running.pop(future), _answer(future))
            if interruptions():
                raise KeyboardInterrupt
    except BaseException:
        here.interrupt(PATIENCE, lambda: interruptions() > 1)
        for future, task in running.items():
            if future.done() and not future.cancelled():
                with suppress(StorageError):  # the first error is raised
                    scheduler.end(task, _answer(future))
        raise


def _answer(future: Future[Answer]) -> Answer:
    """How a task ended; one that raised, or whose worker died, failed with that reason."""
    error = future.exception()
    if error is None:
        return future.result()
    status = Status.INTERRUPTED if isinstance(error, KeyboardInterrupt) else Status.FAILED
    message = str(error) or (
        "stopped before anything could be kept" if status is Status.INTERRUPTED else repr(error)
    )
    return Answer({"status": str(status), "message": message, "seconds": 0.0})


@contextmanager
def _interruptions() -> Iterator[Callable[[], int]]:
    """Count SIGINT, SIGTERM and SIGHUP in place of being ended by them; gives the count."""
    came: list[int] = []
    caught = []
    if threading.current_thread() is threading.main_thread():
        caught = [signal.SIGTERM, signal.SIGHUP]
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # ignored by jobs in the background
            caught.append(signal.SIGINT)
    before = {number: signal.signal(number, lambda number, frame: came.append(number)) for number in caught}
    try:
        yield lambda: len(came)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
