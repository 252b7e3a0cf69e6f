"""Tasks of workers, on this machine or on a cluster: solve a stage of a point, finalise a point.

Workers write no stages: results are returned as the content of their files, which the run writes.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from ehlcontact.cli.study.points.finalise import Final, finalise
from ehlcontact.cli.study.schema import study_of
from ehlcontact.cli.study.stages import Outcome, stage_named
from ehlcontact.errors import InputError
from ehlcontact.jit import compilation_told
from ehlcontact.process.worker import report
from ehlcontact.status import Status

SPACING = 0.1  # seconds between reports


class Answer(NamedTuple):
    """How a task ended."""

    entry: dict[str, Any]  # status, message, seconds; of a point also what `Final` has
    content: bytes | None = None  # of the file of a stage, converged or not


def solve_stage(key: str, document: dict[str, Any], name: str) -> Answer:
    """Solve a stage of the study of one point; `key` is for the reports."""
    started = time.perf_counter()
    content: bytes | None = None
    with _progress() as update:
        try:
            outcome, content = stage_named(name).run(study_of(document), update)
        except InputError as error:
            outcome = Outcome(Status.FAILED, str(error))
    return Answer(_entry(outcome, started), content)


def finalise_point(key: str, document: dict[str, Any], folder: Path, seconds: dict[str, float]) -> Answer:
    """Finalise the study of one point in its folder; `key` is for the reports, `seconds` of its stages."""
    started = time.perf_counter()
    with _progress():
        return Answer(_entry(finalise(study_of(document), folder, seconds), started))


def _entry(outcome: Outcome | Final, started: float) -> dict[str, Any]:
    return outcome._asdict() | {"status": str(outcome.status), "seconds": time.perf_counter() - started}


@contextmanager
def _progress() -> Iterator[Any]:
    """Give ``update(done, total)``, which reports to the run, as compilations are; each kind seldom."""
    last = dict.fromkeys(("update", "compiling"), 0.0)

    def seldom(kind: str, value: tuple[float, float] | None) -> None:
        now = time.perf_counter()
        if now - last[kind] > SPACING:
            last[kind] = now
            report(value)

    with compilation_told(lambda: seldom("compiling", None)):
        yield lambda done, total: seldom("update", (done, total))
