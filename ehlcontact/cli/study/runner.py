"""Run the stages of a study side by side, each in its own process, with progress, resume and Ctrl-C.

Separate processes use the cores better than threads of one film: each worker gets one thread, unless told
otherwise. What is finished is noted in ``stages.json`` with the fingerprint of the study sections it depends on
and a checksum of its file, and skipped the next time.
"""

from __future__ import annotations

import hashlib
import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from ehlcontact.cli.output import complain, write_json
from ehlcontact.cli.progress import progressing
from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.study.stages import STAGES, Stage
from ehlcontact.errors import InputError
from ehlcontact.files import parse_json, read_text
from ehlcontact.status import Status

LEDGER = "stages.json"
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
ROOT = Path(__file__).parents[3]  # holds the package, also in a checkout that is not installed
PATIENCE = 30.0  # seconds that an interrupted worker has for saving


class StorageError(Exception):
    """The result of a stage could not be written; the message says which, where and why."""


class _Worker:
    """One process and the thread that reads its events into the common queue."""

    def __init__(self, stage: Stage, study_file: Path, folder: Path, events: queue.Queue, threads: int) -> None:
        self.stage = stage
        self.last: dict[str, Any] = {}
        path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
        environment = os.environ | dict.fromkeys(THREADS, str(threads)) | {"PYTHONPATH": path}
        command = [sys.executable, "-m", f"{__package__}.worker", str(study_file), str(folder), stage.name]
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


def read_ledger(folder: Path) -> dict[str, dict[str, Any]]:
    """What earlier runs finished here; nothing where there was none or its notes are unreadable."""
    try:
        found = parse_json(read_text(folder / LEDGER))
    except (OSError, ValueError):
        return {}
    notes = found if isinstance(found, dict) else {}
    return {stage.name: notes[stage.name] for stage in STAGES if _is_note(notes.get(stage.name))}


def _is_note(note: Any) -> bool:
    texts, seconds = ("status", "message", "fingerprint"), (int, float)
    if not isinstance(note, dict) or not isinstance(note.get("seconds"), seconds):
        return False
    return all(isinstance(note.get(key), str) for key in texts)


def is_done(stage: Stage, study: Study, folder: Path, ledger: Mapping[str, Any]) -> bool:
    """Whether the stage's file is there, converged, and belongs to this study."""
    note = ledger.get(stage.name, {})
    same = note.get("fingerprint") == study.fingerprint(*stage.sections)
    return same and note.get("status") == Status.CONVERGED and stage.file(folder).is_file()


def is_sound(stage: Stage, study: Study, folder: Path, note: Mapping[str, Any]) -> bool:
    """Whether the file of a stage that is done is what was written: by its checksum, where one was noted."""
    if "sha256" in note:
        return bool(note["sha256"] == checksum(stage.file(folder)))
    try:
        stage.load(study, stage.file(folder))
    except InputError:
        return False
    return True


def checksum(path: Path) -> str | None:
    """SHA-256 of a file, None where it cannot be read."""
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return None


def _to_do(study: Study, folder: Path, ledger: Mapping[str, Mapping[str, Any]]) -> list[Stage]:
    """Stages whose file is not there, belongs to another study, or is damaged, which is said."""
    todo = []
    for stage in STAGES:
        if not is_done(stage, study, folder, ledger):
            todo.append(stage)
        elif not is_sound(stage, study, folder, ledger[stage.name]):
            complain(f"{stage.file(folder)} is damaged: it is made again")
            todo.append(stage)
    return todo


def run_stages(
    study: Study, study_file: Path, folder: Path, jobs: int, threads: int = 1
) -> dict[str, dict[str, Any]]:
    """Run what is not done yet; returns the ledger, which is on disk after every stage.

    `jobs` of them run side by side, with `threads` each. One that fails does not stop the others. Ctrl-C, the
    signal of a `kill`, and a file that cannot be written let the workers save their partial results, and are
    raised then, the signal as `KeyboardInterrupt`. However this ends, no worker stays behind.

    Raises
    ------
    StorageError
        There is no room for the result of a stage.
    InputError
        Nor for the ledger.
    """
    ledger = read_ledger(folder)
    todo = _to_do(study, folder, ledger)
    for stage in todo:
        ledger.pop(stage.name, None)
    events: queue.Queue = queue.Queue()
    running: list[_Worker] = []
    with progressing() as shown, _ended_like_ctrl_c():
        tasks = {stage.name: shown.add(stage.title, started=False) for stage in todo}

        def end(worker: _Worker) -> None:
            last = worker.finish()
            running.remove(worker)
            stage, done = worker.stage, last["status"] == Status.CONVERGED
            ended = "done" if done else last["status"]
            shown.end(tasks[stage.name], f"{stage.title}: {ended}, {last['seconds']:.1f} s")
            ledger[stage.name] = last | {"fingerprint": study.fingerprint(*stage.sections)}
            if done:
                ledger[stage.name]["sha256"] = checksum(stage.file(folder))
            write_json(ledger, str(folder / LEDGER), "file")
            if not last.get("stored", True):
                raise StorageError(last["message"])

        try:
            while todo or running:
                while todo and len(running) < jobs:
                    stage = todo.pop(0)
                    running.append(_Worker(stage, study_file, folder, events, threads))
                    shown.start(tasks[stage.name])
                worker, event = events.get()
                if event is None:
                    end(worker)
                elif "compiling" in event:
                    shown.compiling(tasks[worker.stage.name])
                else:
                    shown.update(tasks[worker.stage.name], event["done"], event["total"])
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
    return ledger


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


@contextmanager
def _ended_like_ctrl_c() -> Iterator[None]:
    """Let `kill`, `timeout` and the end of a session do as Ctrl-C does: workers have sessions of their own."""

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    asked = [signal.SIGTERM, signal.SIGHUP] if threading.current_thread() is threading.main_thread() else []
    before = {number: signal.signal(number, interrupt) for number in asked}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
