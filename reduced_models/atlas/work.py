"""The work of an atlas build: a file of solved points, safe against a kill at any moment, and who solves them."""

from __future__ import annotations

import json
import multiprocessing
import os
import socket
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TypeVar

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.files import parse_json
from ehlcontact.point import MoesPoint
from ehlcontact.process.workers import end_when, interrupts_held

Job = tuple[str, MoesPoint]
Entry = dict[str, Any]
Solve = Callable[[MoesPoint], Entry]
Work = TypeVar("Work")  # what one job is about: a point of an atlas, a stage of a study
Solved = Iterator[tuple[str, Entry]]

SCHEMA = "ehlcontact-atlas-work"
ATTEMPTS = 3  # at a point whose worker dies
CONNECT_SECONDS = 10


class WorkFile:
    """One JSON line per solved point under a header line; opened again it goes on where it ended.

    A line that a kill cut short is dropped. Use as a context manager.

    Parameters
    ----------
    path : Path
        Made if it does not exist.
    settings : mapping
        What makes entries comparable; a file with others is refused.

    Raises
    ------
    InputError
        The file cannot be written, is no work file, or was begun with other settings.
    """

    def __init__(self, path: Path, settings: Mapping[str, Any]) -> None:
        self.path, self.entries = path, dict[str, Entry]()
        header = {"schema": SCHEMA, **settings}
        with self._refusing():
            self._stream = path.open("a+b", buffering=0)  # nothing is left behind that is written later
        try:
            with self._refusing():
                self._read(header)
        except InputError:
            self._stream.close()
            raise

    @contextmanager
    def _refusing(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            reason = f"a file that can be written ({error.strerror}); what it holds stays"
            raise InputError("work file", str(self.path), reason) from None

    def _read(self, header: dict[str, Any]) -> None:
        self._stream.seek(0)
        *whole, torn = self._stream.readall().split(b"\n")
        try:
            lines = [parse_json(line) for line in whole]
            found = lines[0] if lines else None
            begun = found is not None or _line(header).startswith(torn)  # a file of others ends without a line
            if not begun or (found is not None and (not isinstance(found, dict) or found.get("schema") != SCHEMA)):
                raise ValueError("no header")
            self.entries = {line["point"]: line for line in lines[1:]}
            if not all(isinstance(name, str) for name in self.entries):
                raise ValueError("an entry without a point")
        except (ValueError, KeyError, TypeError) as error:
            raise InputError("work file", str(self.path), f"a work file of an atlas build ({error})") from None
        if found is not None and found != header:
            differing = sorted(k for k in {*found, *header} if found.get(k) != header.get(k))
            allowed = f"begun with the same {', '.join(differing)}: {[header.get(k) for k in differing]}"
            raise InputError("work file", f"{self.path} ({[found.get(k) for k in differing]})", allowed)
        if torn:
            self._stream.truncate(sum(len(line) + 1 for line in whole))
        if found is None:
            self._write(header)

    def add(self, name: str, entry: Mapping[str, Any]) -> None:
        """Keep the entry of a point, on the disk when this returns; one that is there already stays."""
        if name not in self.entries:
            self.entries[name] = {"point": name, **entry}
            self._write(self.entries[name])

    def _write(self, line: Mapping[str, Any]) -> None:
        size = self._stream.seek(0, os.SEEK_END)
        with self._refusing():
            try:
                rest = _line(line)
                while rest:  # a disk that becomes full takes part of it
                    rest = rest[self._stream.write(rest) :]
                os.fsync(self._stream.fileno())
            except OSError:
                self._stream.truncate(size)  # no torn line before the next one
                raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._stream.close()


def _line(entry: Mapping[str, Any]) -> bytes:
    return json.dumps(entry, allow_nan=False).encode() + b"\n"


def on_processes(solve: Solve, jobs: Sequence[Job], processes: int) -> Solved:
    """Solve on so many processes of this machine; yields name and entry as they come.

    A process that dies takes its points along: they are tried again by new ones, up to three times in all. All end
    with their parent, and at once where nobody asks for their answers any more (Ctrl-C, a full disk).

    Raises
    ------
    ConvergenceError
        Processes keep dying.
    """
    left = dict(jobs)
    for attempt in range(ATTEMPTS):
        context = multiprocessing.get_context("spawn")
        others = set(multiprocessing.active_children())
        pool = ProcessPoolExecutor(processes, context, initializer=_follow_parent)
        try:
            with interrupts_held():
                futures: dict[Future[Entry], str] = {
                    pool.submit(solve, point): name for name, point in left.items()
                }
            for future in as_completed(futures):
                entry = future.result()
                del left[futures[future]]
                yield futures[future], entry
            return
        except BrokenProcessPool:
            if attempt == ATTEMPTS - 1:
                message = f"processes died {ATTEMPTS} times (out of memory?); what was solved is kept"
                raise ConvergenceError(message, None) from None
        finally:
            if left:
                for process in set(multiprocessing.active_children()) - others:
                    process.kill()
            pool.shutdown(wait=True, cancel_futures=True)


def _follow_parent() -> None:
    """End with the parent, however that was: a killed build leaves nothing behind."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        end_when(parent.join)


def require_scheduler(scheduler: str) -> None:
    """Make sure that somebody listens there, before anything is made or begun.

    A client of Dask that finds nobody goes on looking when it is thrown away: 20 s, and a traceback at the end.

    Raises
    ------
    InputError
        ``dask.distributed`` is not installed, no address, or nobody there.
    """
    try:
        from distributed.comm import get_address_host_port
    except ImportError:
        raise InputError("--scheduler", scheduler, "used with dask: pip install 'ehlcontact[cluster]'") from None
    try:
        socket.create_connection(get_address_host_port(scheduler), CONNECT_SECONDS).close()
    except (OSError, ValueError) as error:
        reason = str(error) or type(error).__name__
        raise InputError("--scheduler", scheduler, f"the address of a Dask scheduler ({reason})") from None


def on_cluster(solve: Callable[[Work], Entry], jobs: Sequence[tuple[str, Work]], scheduler: str) -> Solved:
    """Solve on the Dask cluster at that address; what a lost worker was at goes to another one.

    Raises
    ------
    InputError
        ``dask.distributed`` is not installed, or no scheduler answers there.
    ConvergenceError
        Workers keep dying at a point.
    """
    require_scheduler(scheduler)
    import distributed

    try:
        client = distributed.Client(scheduler, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        reason = str(error) or type(error).__name__
        raise InputError("--scheduler", scheduler, f"the address of a Dask scheduler ({reason})") from None
    with client:
        futures = {
            client.submit(solve, work, key=f"ehlcontact-{name}-{os.getpid()}", retries=ATTEMPTS, pure=False): name
            for name, work in jobs
        }
        finished = distributed.as_completed(futures, loop=client.loop, with_results=True)
        try:
            for future, entry in finished:
                name = futures.pop(future)
                future.release()
                yield name, entry
        except distributed.KilledWorker as error:
            raise ConvergenceError(f"workers died: {error}; what was solved is kept", None) from None
