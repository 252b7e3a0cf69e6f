"""Progress of computations: bars where stderr is a terminal, a line now and then where it is not."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Self

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

from ehlcontact.cli.numerals import spelled
from ehlcontact.cli.output import to_stderr

SPACING = 10.0  # seconds between lines, at least: what is done sooner needs none
SHARE = 0.1  # of the work after which there is a line,
SILENCE = 60.0  # and seconds after which there is one all the same
TICK = 0.5  # seconds between looks at the clock
JOBS = 2  # done, from which the time left is estimated: the first may compile, and may be of another size
COMPILING, ONCE = "compiling", ", which later runs need not"


def compiling_note() -> str:
    """What is shown while kernels are compiled."""
    from ehlcontact.kernel_cache import is_keeping

    return f"{COMPILING}{ONCE}" if is_keeping() else COMPILING


class Bars:
    """Bars with the time left, on a terminal."""

    def __init__(self, console: Console) -> None:
        columns = TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn()
        note = TextColumn("{task.fields[note]}")
        self._bars = Progress(*columns, note, console=console, transient=True)

    def add(self, description: str) -> Any:
        """Add a task; what is returned names it."""
        return self._bars.add_task(description, total=None, note="")

    def update(self, task: Any, done: float, total: float | None, note: str = "") -> None:
        """Move the bar of a task; `total` is None where it is not known."""
        self._bars.update(task, completed=done, total=total, note=note)

    def compiling(self, task: Any) -> None:
        """Show that kernels are compiled for a task, until its next update."""
        self._bars.update(task, note=compiling_note())

    def end(self, task: Any, line: str = "") -> None:
        """Remove a task, and print a last line."""
        self._bars.remove_task(task)
        if line:
            self._bars.console.print(line, highlight=False)

    def __enter__(self) -> Self:
        self._bars.start()
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._bars.stop()


@dataclass
class Task:
    """Progress of a task, and time of its last line."""

    description: str
    begun: float  # time
    last_line: float  # time; before the first, of the last line of any task
    lines: int = 0
    last_share: float = 0.0  # at its last line
    first: tuple[float, float] | None = None  # time and share of the first update: a run may go on from a file
    share: float | None = None  # None where the end is not known
    moved: float = 0.0  # time of the last update that had more of the work done
    jobs: int = 0  # such updates since the first
    note: str = ""
    compiling: bool = False  # since the last update

    def due(self, now: float) -> bool:
        """Whether it is time for a line."""
        silent = now - self.last_line
        if silent < SPACING:
            return False
        moved = self.share is not None and self.share - self.last_share >= SHARE
        first = not self.lines and now - self.begun >= SPACING
        return moved or first or silent >= SILENCE

    def line(self, now: float) -> str:
        """Line to be written now."""
        self.last_line, self.lines = now, self.lines + 1
        if self.share is None or self.compiling:
            parts = [f"{duration(now - self.begun)} so far", compiling_note() if self.compiling else self.note]
            return f"{self.description}: {', '.join(filter(None, parts))}"
        self.last_share = self.share
        left = self._left(now)
        about = f", about {duration(left)} left" if left > 0.0 else ""
        return f"{self.description}: {100.0 * self.share:.0f} %{about}"

    def move(self, now: float, share: float | None) -> None:
        """Take a share that is done now."""
        if share is not None and self.first is None:
            self.first, self.last_share = (now, share), share
        elif share is not None and share > (self.share or 0.0):
            self.moved, self.jobs = now, self.jobs + 1
        self.share = share

    def _left(self, now: float) -> float:
        """Time left by the work done between updates [s]; 0 where too little is done, or it takes longer."""
        if self.first is None or self.share is None or self.jobs < JOBS:
            return 0.0
        first, share = self.first
        return (self.moved - first) * (1.0 - self.share) / (self.share - share) - (now - self.moved)


class Lines:
    """Lines, rarely enough for a log; a thread writes those that are due, also where there is no update."""

    last = time.monotonic()  # time of the last line of any task: many short tasks write as few as a long one

    def __init__(self) -> None:
        self._tasks: list[Task] = []
        self._lock, self._over = threading.Lock(), threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def add(self, description: str) -> Task:
        """Add a task; what is returned names it."""
        task = Task(description, time.monotonic(), Lines.last)
        with self._lock:
            self._tasks.append(task)
        return task

    def update(self, task: Task, done: float, total: float | None, note: str = "") -> None:
        """Keep the progress of a task until a line is due; `total` is None where it is not known."""
        with self._lock:
            task.note, task.compiling = note, False
            task.move(time.monotonic(), done / total if total else None)

    def compiling(self, task: Task) -> None:
        """Note that kernels are compiled for a task, until its next update."""
        task.compiling = True

    def end(self, task: Task, line: str = "") -> None:
        """Remove a task, and write a last line."""
        with self._lock:
            self._tasks.remove(task)
            if line:
                to_stderr(line)

    def write_due(self, now: float) -> None:
        """Write all lines that are due."""
        with self._lock:
            for task in self._tasks:
                if task.due(now):
                    Lines.last = now
                    to_stderr(task.line(now))

    def _watch(self) -> None:
        while not self._over.wait(TICK):
            self.write_due(time.monotonic())

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._over.set()
        self._thread.join()


def progressing() -> Bars | Lines:
    """Bars where stderr is a terminal, lines where it is not."""
    console = Console(stderr=True)
    return Bars(console) if console.is_terminal else Lines()


@contextmanager
def progress(description: str) -> Iterator[Any]:
    """Show one task on stderr, and whether it is compiling; yields ``update(done, total, note="")``."""
    from ehlcontact.jit import compilation_told

    with progressing() as shown:
        task = shown.add(spelled(description, sys.stderr))

        def update(done: float, total: float | None, note: str = "") -> None:
            shown.update(task, done, total, note)

        with compilation_told(lambda: shown.compiling(task)):
            yield update


def duration(seconds: float) -> str:
    """Time in words: 25 s, 4 min, 1 h 10 min."""
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"
