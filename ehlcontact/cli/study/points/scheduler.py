"""Scheduler of a study: tasks of all points, in what order they can run, how far they are, how they ended."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ehlcontact.cli.progress import Bars, Lines
from ehlcontact.cli.study.forecast import closing_cost, stage_cost
from ehlcontact.cli.study.points.finalise import TITLE
from ehlcontact.cli.study.points.kept import FINALISE, Entry, Kept
from ehlcontact.cli.study.points.lists import Point
from ehlcontact.cli.study.points.log import Log
from ehlcontact.cli.study.points.tasks import Answer
from ehlcontact.cli.study.stages import Stage
from ehlcontact.errors import InputError
from ehlcontact.files import write_bytes
from ehlcontact.status import Status

FORESEEN = 0.02  # share of the work from which the time left is shown: before it kernels may be compiled


class StorageError(Exception):
    """The result of a stage could not be written; the message has which, where and why."""


@dataclass(frozen=True)
class Task:
    """A stage of a point, or, without one, the finalisation of the point."""

    point: Point
    stage: Stage | None

    @property
    def name(self) -> str:
        """Name among the tasks of a point."""
        return FINALISE if self.stage is None else self.stage.name

    @property
    def key(self) -> str:
        """Name among all tasks of the study."""
        return f"{self.point.name} {self.name}"

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
        for stage in (stage for stage in stages if stage.wanted(study)):
            task, found = Task(point, stage), self._store.stage(stage, study)
            if found is not None:
                entry, content = found
                _write(stage.file(point.folder), content)
                self._keep(task, entry)
                continue
            if self._store.is_damaged(stage, study):
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
                self._store.put_final(point.study, entry)
        elif content is not None:
            _write((stage.file if done else stage.partial)(point.folder), content)
            if done:
                stage.partial(point.folder).unlink(missing_ok=True)
                self._store.put_stage(stage, point.study, entry, content)

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
    if not path.is_file() or path.read_bytes() != content:
        write_bytes(path, content, "file")
