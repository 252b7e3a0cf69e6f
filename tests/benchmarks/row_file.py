"""Rows of a benchmark in a JSON file that survives an interruption, measured in processes of their own."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple

from rich.console import Console
from rich.progress import BarColumn, Progress, TimeElapsedColumn, TimeRemainingColumn

Row = dict[str, Any]

LASTING = 30  # tasks of a process that takes several


class Task(NamedTuple):
    """One row to be measured: ``work(*arguments)`` returns it; `weight` is its share of all the time."""

    key: str
    work: Callable[..., Row]
    arguments: tuple[Any, ...]
    weight: float


class RowFile:
    """Rows by key in a JSON file, written after each; without a path, in memory only.

    Parameters
    ----------
    path : Path, optional
        An existing file of the same `tool` and `settings` is gone on with; one of another is refused.
    tool : str
    settings : dict
        On which all rows depend, such as a seed.
    again : bool
        Forget what an existing file holds.
    """

    def __init__(self, path: Path | None, tool: str, settings: Row | None = None, again: bool = False) -> None:
        self.path, self.head = path, {"tool": tool, "settings": settings or {}}
        self.rows: dict[str, Row] = {}
        self.more: Row = {}
        if path is not None and path.exists() and not again:
            stored = json.loads(path.read_text(encoding="utf-8"))
            if {name: stored.get(name) for name in self.head} != self.head:
                sys.exit(f"{path}: is not of {tool} with {settings or 'these settings'}; --again overwrites it")
            self.rows = {row["key"]: row for row in stored["rows"]}
            self.more = {name: value for name, value in stored.items() if name not in {*self.head, "rows"}}

    def put(self, key: str, row: Row) -> None:
        """Add or replace a row."""
        self.rows[key] = {"key": key, **row}
        self.write()

    def write(self) -> None:
        """Replace the file in one move, so that an interruption leaves the old one or the new one."""
        if self.path is None:
            return
        new = self.path.with_name(self.path.name + ".new")
        text = ",\n".join(json.dumps(row) for row in self.rows.values())
        head = json.dumps(self.head | self.more)[:-1]
        new.write_text(f'{head}, "rows": [\n{text}\n]}}\n', encoding="utf-8")
        new.replace(self.path)

    def missing(self, tasks: list[Task]) -> list[Task]:
        """Those without a row, or whose row was refused: the machine was busy, or the process died."""
        return [task for task in tasks if self.rows.get(task.key, {"refused": "unknown"}).get("refused")]


def in_processes(tasks: list[Task], jobs: int = 1, lasting: bool = False) -> Iterator[tuple[Task, Row]]:
    """Rows as they come, each from a fresh process: peak memory is its own, and one that dies takes none along.

    With `lasting`, each of the `jobs` processes takes `LASTING` tasks or so, which is for many small ones; where
    one dies, all that is left of these falls with it. BLAS has one thread in each: outside solves
    a second one would spin, which counts as processor time.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    size = jobs * LASTING if lasting else jobs
    groups = [tasks[k : k + size] for k in range(0, len(tasks), size)]
    for group in groups:
        with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
            waiting = {pool.submit(task.work, *task.arguments): task for task in group}
            try:
                for future in as_completed(waiting):
                    try:
                        row = future.result()
                    except BrokenProcessPool:
                        row = {"verdict": "process died", "status": "process died", "refused": "process died"}
                    except Exception as fault:
                        row = {"verdict": f"{type(fault).__name__}: {fault}", "status": "error"}
                    yield waiting[future], row
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise


def measure_missing(
    file: RowFile,
    tasks: list[Task],
    line: Callable[[str, Row], str],
    *,
    jobs: int = 1,
    lasting: bool = False,
    tries: int = 1,
) -> None:
    """Measure what the file lacks and print a line for each; those refused are tried again, `tries` in all.

    Again means in a process of its own.
    """
    for attempt in range(tries):
        missing = file.missing(tasks)
        if attempt == 0 and len(missing) < len(tasks):
            print(f"{len(tasks) - len(missing)} of {len(tasks)} known")
        columns = (BarColumn(), TimeElapsedColumn(), TimeRemainingColumn())
        with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
            bar = progress.add_task("", total=sum(task.weight for task in missing))
            for task, row in in_processes(missing, jobs, lasting and attempt == 0):
                file.put(task.key, row)
                if told := line(task.key, row):
                    print(told, flush=True)
                progress.advance(bar, task.weight)
