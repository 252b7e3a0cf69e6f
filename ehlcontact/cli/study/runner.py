"""Run the stages of a study side by side, each in its own process, with progress, resume and Ctrl-C.

Separate processes use the cores better than threaded linear algebra on matrices this small: each worker gets
one BLAS thread. What is finished is noted in ``stages.json`` with the fingerprint of the study sections it
depends on, and skipped the next time.
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
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.progress import Progress

from ehlcontact.cli.output import progress_bars, stderr_console, write_json
from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.study.stages import STAGES, Stage
from ehlcontact.files import parse_json, read_text
from ehlcontact.status import Status

LEDGER = "stages.json"
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
ROOT = Path(__file__).parents[3]  # holds the package, also in a checkout that is not installed
PATIENCE = 30.0  # seconds that an interrupted worker has for saving


class _Worker:
    """One process and the thread that reads its events into the common queue."""

    def __init__(self, stage: Stage, study_file: Path, folder: Path, events: queue.Queue) -> None:
        self.stage = stage
        self.last: dict[str, Any] = {}
        path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
        environment = os.environ | dict.fromkeys(THREADS, "1") | {"PYTHONPATH": path}
        command = [sys.executable, "-m", f"{__package__}.worker", str(study_file), str(folder), stage.name]
        self._errors = tempfile.TemporaryFile(mode="w+", encoding="utf-8")
        # Its own session: Ctrl-C in the terminal comes to us alone, and we pass it on once.
        self.process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            stdin=subprocess.DEVNULL,
            env=environment,
            text=True,
            start_new_session=True,
        )
        self._thread = threading.Thread(target=self._read, args=(events,), daemon=True)
        self._thread.start()

    def _read(self, events: queue.Queue) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            event = json.loads(line)
            if "status" in event:
                self.last = event
            else:
                events.put((self, event))
        events.put((self, None))

    def finish(self) -> dict[str, Any]:
        """Reap the process; its last event, or what it said on stderr if it died without one."""
        self._thread.join()
        assert self.process.stdout is not None
        self.process.stdout.close()
        code = self.process.wait()
        self._errors.seek(0)
        said = self._errors.read().strip().splitlines()
        self._errors.close()
        if not self.last:
            message = f"its process died: {said[-1] if said else f'exit code {code}'}"
            self.last = {"status": Status.FAILED, "message": message, "seconds": 0.0}
        return self.last


def read_ledger(folder: Path) -> dict[str, dict[str, Any]]:
    """What earlier runs finished here; nothing if there was none or its notes are unreadable."""
    try:
        ledger = parse_json(read_text(folder / LEDGER))
    except (OSError, ValueError):
        return {}
    return ledger if isinstance(ledger, dict) else {}


def is_done(stage: Stage, study: Study, folder: Path, ledger: Mapping[str, Any]) -> bool:
    """Whether the stage's file is there, converged, and belongs to this study."""
    note = ledger.get(stage.name, {})
    same = note.get("fingerprint") == study.fingerprint(*stage.sections)
    return same and note.get("status") == Status.CONVERGED and stage.file(folder).is_file()


def run_stages(study: Study, study_file: Path, folder: Path, jobs: int) -> dict[str, dict[str, Any]]:
    """Run what is not done yet; returns the ledger, which is on disk after every stage.

    A stage that fails does not stop the others. Ctrl-C lets the workers save their partial results, and then
    raises `KeyboardInterrupt`.
    """
    ledger = read_ledger(folder)
    todo = [stage for stage in STAGES if not is_done(stage, study, folder, ledger)]
    for stage in STAGES:
        if stage in todo:
            ledger.pop(stage.name, None)
    events: queue.Queue = queue.Queue()
    running: list[_Worker] = []
    console = stderr_console()
    with progress_bars(console) as bars:
        tasks = {stage.name: bars.add_task(stage.title, total=None, note="waiting", start=False) for stage in todo}

        def end(worker: _Worker) -> None:
            last = worker.finish()
            running.remove(worker)
            ledger[worker.stage.name] = last | {"fingerprint": study.fingerprint(*worker.stage.sections)}
            write_json(ledger, str(folder / LEDGER))
            bars.remove_task(tasks[worker.stage.name])
            ended = "done" if last["status"] == Status.CONVERGED else last["status"]
            console.print(f"{worker.stage.title}: {ended}, {last['seconds']:.1f} s", highlight=False)

        try:
            while todo or running:
                while todo and len(running) < jobs:
                    stage = todo.pop(0)
                    running.append(_Worker(stage, study_file, folder, events))
                    bars.start_task(tasks[stage.name])
                    bars.update(tasks[stage.name], note="")
                worker, event = events.get()
                if event is None:
                    end(worker)
                else:
                    bars.update(tasks[worker.stage.name], completed=event["done"], total=event["total"])
        except KeyboardInterrupt:
            _interrupt(running, bars)
            for worker in list(running):
                end(worker)
            raise
    return ledger


def _interrupt(running: list[_Worker], bars: Progress) -> None:
    for worker in running:
        worker.process.send_signal(signal.SIGINT)
    bars.stop()
    for worker in running:
        try:
            worker.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            worker.process.kill()
