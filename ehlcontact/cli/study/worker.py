"""One task in a process of its own: ``python -m ehlcontact.cli.study.worker STUDY.toml FOLDER TASK``.

A task is a stage of a study of one point, or what is made of all its stages.

Events go to stdout as lines of JSON: ``{"done": k, "total": n}``, ``{"compiling": true}`` and, last, ``{"status":
..., "message": ..., "seconds": ...}``. Interrupt it with SIGINT; it saves what it has.
"""

from __future__ import annotations

import json
import signal
import sys
import time
from pathlib import Path
from typing import Any

from ehlcontact.cli.study.points.closing import close
from ehlcontact.cli.study.points.ledger import CLOSING
from ehlcontact.cli.study.points.lists import load_points
from ehlcontact.cli.study.stages import stage_named
from ehlcontact.errors import InputError
from ehlcontact.jit import compilation_told
from ehlcontact.process.workers import end_when, stdin_closed
from ehlcontact.status import Status

SPACING = 0.1  # seconds between progress lines


def work(study_file: Path, folder: Path, name: str) -> None:
    """Do it and report on stdout."""
    end_when(stdin_closed)  # the runner holds the other end, and is gone then
    # A parent in the background may have left the signal ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    started = time.perf_counter()
    last = {"update": 0.0, "compiling": 0.0}

    def emit(**event: object) -> None:
        sys.stdout.write(json.dumps(event) + "\n")
        sys.stdout.flush()

    def seldom(kind: str, **event: object) -> None:
        now = time.perf_counter()
        if now - last[kind] > SPACING:
            last[kind] = now
            emit(**event)

    def update(done: float, total: float) -> None:
        seldom("update", done=done, total=total)

    outcome: dict[str, Any]
    try:
        (point,) = load_points(study_file, folder)
        with compilation_told(lambda: seldom("compiling", compiling=True)):
            if name == CLOSING:
                outcome = close(point.study, folder)._asdict()
            else:
                outcome = stage_named(name).run(point.study, folder, update)._asdict()
    except InputError as error:
        outcome = {"status": Status.FAILED, "message": str(error)}
    emit(**outcome, seconds=time.perf_counter() - started)


if __name__ == "__main__":
    work(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3])
