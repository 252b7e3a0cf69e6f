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
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from ehlcontact.cli.progress import Bars, Lines, progressing
from ehlcontact.cli.study.forecast import closing_cost, stage_cost
from ehlcontact.cli.study.periodic import Branch, branches_of, solve_branch
from ehlcontact.cli.study.points.finalise import TITLE, finalise_point
from ehlcontact.cli.study.points.folder import Log
from ehlcontact.cli.study.points.kept import BEGUN, FINALISE, Entry, Kept, final_key, stage_key
from ehlcontact.cli.study.points.lists import Point
from ehlcontact.cli.study.points.summary import withdraw
from ehlcontact.cli.study.stages import STAGES, Answer, Stage, solve_stage
from ehlcontact.cli.study.uncertain import Batch, batches_of, solve_batch
from ehlcontact.errors import InputError
from ehlcontact.executors import ProcessExecutor, executor_for
from ehlcontact.files import write_bytes
from ehlcontact.status import Status

PATIENCE = 30.0  # seconds that an interrupted worker has for saving
TICK = 0.1  # seconds between looks at interruptions
FORESEEN = 0.02  # share of the work from which the time left is shown: before it kernels may be compiled


class StorageError(Exception):
    """The result of a stage could not be written; the message has which, where and why."""


@dataclass(frozen=True)
class Task:
    """A stage, a branch or a batch of samples of a point, or, without one, the finalisation of the point."""

    point: Point
    stage: Stage | Branch | Batch | None

    @property
    def name(self) -> str:
        """Name among the tasks of a point."""
        return FINALISE if self.stage is None else self.stage.name

    @property
    def key(self) -> str:
        """Name among all tasks of the study."""
        return f"{self.point.name} {self.name}"

    @property
    def content_key(self) -> str:
        """Key of what it computes: the hash of its inputs."""
        study = self.point.study
        return final_key(study) if self.stage is None else stage_key(self.stage, study)

    @property
    def title(self) -> str:
        """Name for people."""
        return self.point.titled(TITLE if self.stage is None else self.stage.title)

    @property
    def cost(self) -> float:
        """Estimated, in convolutions."""
        study = self.point.study
        return closing_cost(study) if self.stage is None else stage_cost(self.stage, study)


class Scheduler:
    """Tasks of all points.

    Parameters
    ----------
    points : sequence of Point
    stages : sequence of Stage
        The longest first.
    root : Path
        Folder of the study, with the store of what is computed.
    log : Log
    final : bool
        Whether points are finalised.
    """

    def __init__(
        self, points: Sequence[Point], stages: Sequence[Stage], root: Path, log: Log, *, final: bool = True
    ) -> None:
        self.ended: dict[str, dict[str, Entry]] = {point.name: {} for point in points}
        self.log = log
        self._store = Kept(root)
        self.todo: list[Task] = []
        self.solved: list[str] = []
        self.kept: list[str] = []
        self._shown: Bars | Lines | None = None
        self._bars: dict[Task | None, Any] = {}
        for point in points:
            self._look(point, stages, final)
        self._tasks = {task.key: task for task in self.todo}
        self._costs = {task: task.cost for task in self.todo}
        self._shares = dict.fromkeys(self.todo, 0.0)
        self._open = {point.name: {task.name for task in self.todo if task.point is point} for point in points}

    def _look(self, point: Point, stages: Sequence[Stage], final: bool) -> None:
        """Enter the tasks that a point lacks, log those that it has, and write their files where they are not."""
        study, lacking = point.study, []
        wanted: list[Stage | Branch | Batch] = [stage for stage in stages if stage.wanted(study)]
        for stage in (*branches_of(study), *wanted, *batches_of(study)):
            task = Task(point, stage)
            found = self._store.get(task.content_key)
            if found is not None:
                entry, content = found
                _write(stage.file(point.folder), content)
                self._keep(task, entry)
                continue
            if self._store.is_damaged(task.content_key):
                self.log.warn(f"{task.title}: what was kept is damaged: it is made again")
            lacking.append(task)
        if final:
            entry_of_all = None if lacking else self._store.final(study, point.folder)
            if entry_of_all is None:
                lacking.append(Task(point, None))
            else:
                self._keep(Task(point, None), entry_of_all)
        self.todo += lacking

    def _keep(self, task: Task, entry: Entry) -> None:
        self.ended[task.point.name][task.name] = entry
        self.kept.append(task.key)
        self.log.line("kept", task.title)

    def seconds(self, point: Point) -> dict[str, float]:
        """Wall time of the stages of a point."""
        return {name: entry["seconds"] for name, entry in self.ended[point.name].items() if name != FINALISE}

    def show(self, shown: Bars | Lines) -> None:
        """Show progress there from now on, that of the whole study first."""
        self._shown = shown
        if len(self.todo) > 1:
            self._bars[None] = shown.add("whole study")
            self._show_whole()

    def take(self) -> Task | None:
        """Remove and return the next task that can begin: finalisation waits for all stages of its point."""
        for task in self.todo:
            if task.stage is not None or self._open[task.point.name] == {FINALISE}:
                self.todo.remove(task)
                return task
        return None

    def begin(self, task: Task) -> None:
        """Log and show that a task begins."""
        if self._shown is not None:
            self._bars[task] = self._shown.add(task.title)
        self.log.line("begun", task.title)

    def report(self, args: tuple[Any, ...], value: tuple[float, float] | None) -> None:
        """Show progress: (done, total) of the task whose key is the first of `args`; None while it is compiled."""
        task = self._tasks[args[0]]
        if value is not None:
            done, total = value
            self._shares[task] = min(1.0, done / total) if total else 0.0
        if self._shown is not None:
            if value is None:
                self._shown.compiling(self._bars[task])
            else:
                self._shown.update(self._bars[task], *value)
                self._show_whole()

    def _show_whole(self) -> None:
        """Show progress of the whole study, by the estimated costs of all tasks."""
        if self._shown is not None and None in self._bars:
            cost = sum(self._costs.values())
            share = sum(self._costs[task] * done for task, done in self._shares.items()) / cost
            ready = sum(1 for done in self._shares.values() if done == 1.0)
            note = f"{ready} of {len(self._costs)} tasks done"
            self._shown.update(self._bars[None], share, 1.0 if share >= FORESEEN else None, note)

    def end(self, task: Task, answer: Answer) -> None:
        """Keep what converged, write the file of a stage, and note how the task ended.

        Raises
        ------
        StorageError
            There is no room.
        """
        point, entry, full = task.point, answer.entry, ""
        try:
            self._write_files(task, answer)
        except InputError as error:
            full = str(error)
            entry = entry | {"status": str(Status.FAILED), "message": full}
        done = entry["status"] == Status.CONVERGED
        self._show_end(task, entry, done)
        self.ended[point.name][task.name] = entry
        for text in entry.get("warnings", ()):
            self.log.warn(point.titled(f"warning: {text}"))
        self._open[point.name].discard(task.name)
        if done:
            self.solved.append(task.key)
        else:  # a point is not finalised where a stage is missing
            self.todo = [other for other in self.todo if other.point is not point or other.stage is not None]
        if full:
            raise StorageError(full)

    def _write_files(self, task: Task, answer: Answer) -> None:
        """The file of a stage, of a converged result or of a partial one, and the entry of what converged."""
        point, stage, entry, content = task.point, task.stage, answer.entry, answer.content
        done = entry["status"] == Status.CONVERGED
        if stage is None:
            if done and entry["whole"]:
                self._store.put(task.content_key, entry)
        elif content is not None:
            _write((stage.file if done else stage.partial)(point.folder), content)
            if done:
                stage.partial(point.folder).unlink(missing_ok=True)
                self._store.put(task.content_key, entry, content)
            elif isinstance(stage, Batch):
                self._store.put(f"{task.content_key}{BEGUN}", entry, content)

    def begun(self, task: Task) -> bytes:
        """Samples that an interrupted batch has already."""
        found = self._store.get(f"{task.content_key}{BEGUN}")
        return b"" if found is None else found[1]

    def _show_end(self, task: Task, entry: dict[str, Any], done: bool) -> None:
        self._shares[task] = 1.0
        text = f"{task.title}: {'done' if done else entry['status']}, {entry['seconds']:.1f} s"
        if self._shown is not None and task in self._bars:
            self._shown.end(self._bars.pop(task), text)
            self._show_whole()
        self.log.line("solved" if done else "ended", text if done else f"{text}: {entry['message']}")

    def finish(self) -> None:
        """Remove the progress of the whole study."""
        if self._shown is not None and None in self._bars:
            self._shown.end(self._bars.pop(None))


def _write(path: Path, content: bytes) -> None:
    """Write a file that does not hold this yet; raises `InputError` where there is no room."""
    path.parent.mkdir(exist_ok=True)
    if not path.is_file() or path.read_bytes() != content:
        write_bytes(path, content, "file")


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

        def waiting() -> None:
            if interruptions():
                raise KeyboardInterrupt

        scheduler.show(shown)
        with executor_for(share.jobs, share.threads, report=scheduler.report) as here:
            assert isinstance(here, ProcessExecutor)
            if share.cluster is None:
                _run(scheduler, here, here, share, interruptions)
            else:
                with executor_for(share.jobs, scheduler=share.cluster, waiting=waiting) as there:
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
                point, stage = task.point, task.stage
                if stage is None:
                    future = here.submit(
                        finalise_point, task.key, point.study, point.folder, scheduler.seconds(point)
                    )
                elif isinstance(stage, Batch):
                    begun = scheduler.begun(task)
                    future = there.submit(solve_batch, task.key, point.study, stage, begun)
                elif isinstance(stage, Branch):
                    future = there.submit(solve_branch, task.key, point.study)
                else:
                    future = there.submit(solve_stage, task.key, point.study, stage.name)
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
