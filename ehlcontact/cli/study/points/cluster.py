"""Stages of a study solved by the workers of a Dask cluster, which need no file of ours: results are bytes."""

from __future__ import annotations

import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from ehlcontact.cli.study.points.board import Board, Task
from ehlcontact.cli.study.schema import study_of
from ehlcontact.cli.study.stages import Outcome, stage_named
from ehlcontact.errors import InputError
from ehlcontact.files import write_bytes
from ehlcontact.status import Status
from reduced_models.atlas.work import on_cluster, require_scheduler

FILES = ("file", "partial")  # of a stage, by the method that says where it stands


class Work(NamedTuple):
    """A stage, to be solved anywhere."""

    document: dict[str, Any]  # of a study of one point
    stage: str


def solve_stage(work: Work) -> dict[str, Any]:
    """Solve it; how it ended, and its file as bytes."""
    started, stage = time.perf_counter(), stage_named(work.stage)
    files: dict[str, bytes] = {}
    with TemporaryDirectory() as folder:
        try:
            outcome = stage.run(study_of(work.document), Path(folder), lambda done, total: None)
        except InputError as error:
            outcome = Outcome(Status.FAILED, str(error))
        for kind in FILES:
            path = getattr(stage, kind)(Path(folder))
            if path.is_file():
                files[kind] = path.read_bytes()
    last = outcome._asdict() | {"status": str(outcome.status), "stored": True}  # there is room where it came from
    return {"last": last | {"seconds": time.perf_counter() - started}, "files": files}


def solve_on_cluster(board: Board, scheduler: str) -> None:
    """Let the cluster solve all stages that are to do, and keep them as they come.

    Raises
    ------
    InputError
        ``dask.distributed`` is not installed, no scheduler answers there, or there is no room.
    StorageError
        No room for a result.
    ConvergenceError
        Workers keep dying at a stage.
    """
    require_scheduler(scheduler)
    tasks: dict[str, Task] = {}
    jobs = []
    for task in [task for task in board.todo if task.stage is not None]:
        name = f"{task.point.name}-{task.name}"
        document = task.point.study.model_dump(exclude_unset=True, exclude_none=True)
        tasks[name] = task
        jobs.append((name, Work(document, task.name)))
        board.claim(task)
    for name, found in on_cluster(solve_stage, jobs, scheduler) if jobs else ():
        task, last = tasks[name], found["last"]
        try:
            for kind, content in found["files"].items():
                assert task.stage is not None
                write_bytes(getattr(task.stage, kind)(task.point.folder), content, "file")
        except InputError as error:
            last |= {"status": str(Status.FAILED), "message": str(error), "stored": False}
        board.end(task, last)
