"""What is to do for all points of a study, how far it is, and what is noted of what is done."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ehlcontact.cli.progress import Progressing
from ehlcontact.cli.study.forecast import closing_cost, stage_cost
from ehlcontact.cli.study.points.closing import TITLE
from ehlcontact.cli.study.points.journal import Journal
from ehlcontact.cli.study.points.ledger import (
    CLOSING,
    Ledger,
    adopted,
    checksum,
    closing_fingerprint,
    is_closed,
    is_done,
    is_sound,
    read_ledger,
    write_ledger,
)
from ehlcontact.cli.study.points.lists import POINTS, Point
from ehlcontact.cli.study.stages import Stage
from ehlcontact.status import Status

FORESEEN = 0.02  # share of the work from which the time left is told: before it kernels may be compiled


class StorageError(Exception):
    """The result of a stage could not be written; the message says which, where and why."""


@dataclass(frozen=True)
class Task:
    """A stage of a point, or, with none, what is made of its stages."""

    point: Point
    stage: Stage | None

    @property
    def name(self) -> str:
        """As a worker and the ledger call it."""
        return CLOSING if self.stage is None else self.stage.name

    @property
    def title(self) -> str:
        """As people read it."""
        return self.point.titled(TITLE if self.stage is None else self.stage.title)

    @property
    def cost(self) -> float:
        """Estimated, in convolutions."""
        study = self.point.study
        return closing_cost(study) if self.stage is None else stage_cost(self.stage.name, study)


class Board:
    """Tasks of all points.

    Parameters
    ----------
    points : sequence of Point
    stages : sequence of Stage
        The longest first.
    root : Path
        Of the study's results: contents are looked for there and in the folders of points.
    journal : Journal
    closing : bool
        Whether results and report are made.
    """

    def __init__(
        self,
        points: Sequence[Point],
        stages: Sequence[Stage],
        root: Path,
        journal: Journal,
        *,
        closing: bool = True,
    ) -> None:
        self.ledgers: dict[str, Ledger] = {point.name: read_ledger(point.folder) for point in points}
        self.journal, self.root = journal, root
        self.todo: list[Task] = []
        self.solved: list[str] = []
        self.kept: list[str] = []
        self._shares: dict[Task, float] = {}
        self._shown: Progressing | None = None
        self._bars: dict[Task | None, Any] = {}
        others = [root, *sorted(path for path in (root / POINTS).glob("*") if path.is_dir())]
        for point in points:
            self._look(point, stages, others, closing)
        self._costs = {task: task.cost for task in self.todo}
        self._open = {point.name: {task.name for task in self.todo if task.point is point} for point in points}

    def _look(self, point: Point, stages: Sequence[Stage], others: Iterable[Path], closing: bool) -> None:
        """Enter what a point lacks; what it has is told to the journal."""
        ledger, lacking = self.ledgers[point.name], []
        for stage in (stage for stage in stages if stage.wanted(point.study)):
            if self._keeps(point, stage, others):
                self._keep(Task(point, stage))
            else:
                ledger.pop(stage.name, None)
                lacking.append(Task(point, stage))
        if closing and (lacking or not is_closed(point.study, point.folder, ledger)):
            ledger.pop(CLOSING, None)
            lacking.append(Task(point, None))
        elif closing:
            self._keep(Task(point, None))
        self.todo += lacking

    def _keeps(self, point: Point, stage: Stage, others: Iterable[Path]) -> bool:
        """Whether a stage is finished, here or elsewhere."""
        study, folder, ledger = point.study, point.folder, self.ledgers[point.name]
        if is_done(stage, study, folder, ledger):
            if is_sound(stage, folder, ledger[stage.name]):
                return True
            self.journal.warn(f"{stage.file(folder)} is damaged: it is made again")
        note = adopted(stage, study, folder, others)
        if note is None:
            return False
        ledger[stage.name] = note
        write_ledger(ledger, folder)
        return True

    def _keep(self, task: Task) -> None:
        self.kept.append(f"{task.point.name} {task.name}")
        self.journal.line("kept", task.title)

    def show(self, shown: Progressing) -> None:
        """Tell progress there from now on, that of the whole first."""
        self._shown = shown
        if len(self.todo) > 1:
            self._bars[None] = shown.add("whole study")
            self._tell_whole()

    def take(self) -> Task | None:
        """The next task that can begin: results and report wait for all stages of their point."""
        for task in self.todo:
            if task.stage is not None or self._open[task.point.name] == {CLOSING}:
                self.claim(task)
                return task
        return None

    def claim(self, task: Task) -> None:
        """Somebody does it."""
        self.todo.remove(task)

    def begin(self, task: Task) -> None:
        """It has been begun."""
        if self._shown is not None:
            self._bars[task] = self._shown.add(task.title)
        self.journal.line("begun", task.title)

    def move(self, task: Task, done: float, total: float) -> None:
        """How far it is."""
        self._shares[task] = min(1.0, done / total) if total else 0.0
        if self._shown is not None:
            self._shown.update(self._bars[task], done, total)
            self._tell_whole()

    def compiling(self, task: Task) -> None:
        """Kernels are compiled for it."""
        if self._shown is not None:
            self._shown.compiling(self._bars[task])

    def _tell_whole(self) -> None:
        """By what all tasks are estimated to cost."""
        if self._shown is not None and None in self._bars:
            cost = sum(self._costs.values())
            share = sum(self._costs[task] * done for task, done in self._shares.items()) / cost
            ready = sum(1 for done in self._shares.values() if done == 1.0)
            note = f"{ready} of {len(self._costs)} tasks done"
            self._shown.update(self._bars[None], share, 1.0 if share >= FORESEEN else None, note)

    def end(self, task: Task, last: dict[str, Any]) -> None:
        """Note how it ended.

        Raises
        ------
        StorageError
            There was no room for its result.
        InputError
            Nor for the note.
        """
        point, ledger = task.point, self.ledgers[task.point.name]
        done = last["status"] == Status.CONVERGED
        self._shares[task] = 1.0
        said = f"{task.title}: {'done' if done else last['status']}, {last['seconds']:.1f} s"
        if self._shown is not None and task in self._bars:
            self._shown.end(self._bars.pop(task), said)
            self._tell_whole()
        self.journal.line("solved" if done else "ended", said if done else f"{said}: {last['message']}")
        if task.stage is None:
            ledger[CLOSING] = last | {"fingerprint": closing_fingerprint(point.study, ledger)}
            for text in last.get("warnings", ()):
                self.journal.warn(point.titled(f"warning: {text}"))
        else:
            ledger[task.name] = last | {"fingerprint": point.study.fingerprint(*task.stage.sections)}
            if done:
                ledger[task.name]["sha256"] = checksum(task.stage.file(point.folder))
        write_ledger(ledger, point.folder)
        self._open[point.name].discard(task.name)
        if done:
            self.solved.append(f"{point.name} {task.name}")
        else:  # nothing is made of stages of which one is missing
            self.todo = [other for other in self.todo if other.point is not point or other.stage is not None]
        if not last.get("stored", True):
            raise StorageError(last["message"])

    def finish(self) -> None:
        """Take the whole off the screen."""
        if self._shown is not None and None in self._bars:
            self._shown.end(self._bars.pop(None))
