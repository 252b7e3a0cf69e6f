"""How far a computation is: bars where stderr is a terminal, now and then a line where it is not."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Protocol, Self

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

from ehlcontact.cli.numerals import spelled
from ehlcontact.cli.output import to_stderr

SPACING = 10.0  # seconds between lines, at least: what is done sooner needs none
SHARE = 0.1  # of the work after which there is a line,
SILENCE = 60.0  # and seconds after which there is one all the same
TICK = 0.5  # seconds between looks at the clock
COMPILING = "compiling, which later runs need not"


class Progressing(Protocol):
    """What bars and lines have in common."""

    def add(self, description: str, started: bool = True) -> Any:
        """Announce a task; returns what names it."""

    def start(self, task: Any) -> None:
        """Begin a task that was added without."""

    def update(self, task: Any, done: float, total: float | None, note: str = "") -> None:
        """Say how far it is."""

    def compiling(self, task: Any) -> None:
        """Say that kernels are compiled for it, until the next update."""

    def end(self, task: Any, line: str = "") -> None:
        """Take it off, with a last line."""

    def __enter__(self) -> Self: ...

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None: ...


class Bars:
    """Bars with the time left, on a terminal."""

    def __init__(self, console: Console) -> None:
        columns = TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn()
        note = TextColumn("{task.fields[note]}")
        self._bars = Progress(*columns, note, console=console, transient=True)

    def add(self, description: str, started: bool = True) -> Any:
        """Announce a task."""
        return self._bars.add_task(description, total=None, note="" if started else "waiting", start=started)

    def start(self, task: Any) -> None:
        """Begin a task that was added without."""
        self._bars.start_task(task)
        self._bars.update(task, note="")

    def update(self, task: Any, done: float, total: float | None, note: str = "") -> None:
        """Move its bar."""
        self._bars.update(task, completed=done, total=total, note=note)

    def compiling(self, task: Any) -> None:
        """Note it beside the bar."""
        self._bars.update(task, note=COMPILING)

    def end(self, task: Any, line: str = "") -> None:
        """Take its bar off."""
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
    """A task told by lines: what was last heard of it, and when there was last a line."""

    description: str
    begun: float | None = None  # time, None while it waits
    told: float = 0.0  # time of its last line; before that, of the last one of any task
    lines: int = 0
    told_share: float = 0.0
    first: tuple[float, float] | None = None  # time and share of the first news: a run may go on from a file
    share: float | None = None  # None where the end is not known
    note: str = ""
    compiling: bool = False  # since the last news

    def due(self, now: float) -> bool:
        """Whether it is time for a line."""
        silent = now - self.told
        if self.begun is None or silent < SPACING:
            return False
        moved = self.share is not None and self.share - self.told_share >= SHARE
        unheard = not self.lines and now - self.begun >= SPACING
        return moved or unheard or silent >= SILENCE

    def line(self, now: float) -> str:
        """What to say now."""
        self.told, self.lines = now, self.lines + 1
        if self.share is None or self.compiling:
            said = [f"{duration(now - (self.begun or now))} so far", COMPILING if self.compiling else self.note]
            return f"{self.description}: {', '.join(filter(None, said))}"
        self.told_share = self.share
        first, share = self.first or (now, self.share)
        moved = self.share - share
        left = f", about {duration((now - first) * (1.0 - self.share) / moved)} left" if moved > 0.0 else ""
        return f"{self.description}: {100.0 * self.share:.0f} %{left}"


class Lines:
    """The same told by lines, rarely enough for a log: a thread looks at the clock, so that silence ends too."""

    last = time.monotonic()  # time of the last line: many short tasks are as silent as a long one

    def __init__(self) -> None:
        self._tasks: list[Task] = []
        self._lock, self._over = threading.Lock(), threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def add(self, description: str, started: bool = True) -> Task:
        """Announce a task."""
        task = Task(description)
        if started:
            self.start(task)
        with self._lock:
            self._tasks.append(task)
        return task

    def start(self, task: Task) -> None:
        """Begin a task that was added without."""
        task.begun, task.told = time.monotonic(), Lines.last

    def update(self, task: Task, done: float, total: float | None, note: str = "") -> None:
        """Keep the news until a line is due."""
        with self._lock:
            task.note, task.share, task.compiling = note, done / total if total else None, False
            if task.first is None and task.share is not None:
                task.first, task.told_share = (time.monotonic(), task.share), task.share

    def compiling(self, task: Task) -> None:
        """Keep it for a line that is due meanwhile."""
        task.compiling = True

    def end(self, task: Task, line: str = "") -> None:
        """Say the last line."""
        with self._lock:
            self._tasks.remove(task)
            if line:
                to_stderr(line)

    def tell(self, now: float) -> None:
        """Say all lines that are due."""
        with self._lock:
            for task in self._tasks:
                if task.due(now):
                    Lines.last = now
                    to_stderr(task.line(now))

    def _watch(self) -> None:
        while not self._over.wait(TICK):
            self.tell(time.monotonic())

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._over.set()
        self._thread.join()


def progressing() -> Progressing:
    """Bars or lines, whatever stderr is."""
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
    """A time as one says it: 25 s, 4 min, 1 h 10 min."""
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"
