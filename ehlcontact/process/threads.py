"""Threads for compiled loops over independent items: whole fields, and lines of one colour.

Chunks only divide the items among the threads, so results are the same, bit for bit, for any number of threads.

Waking a thread costs 40 us, as long as many a loop lasts: the caller starts, and takes chunk after chunk; helpers
join when they are awake. At the end the caller waits only for helpers that are at work on a chunk.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from functools import cache
from itertools import pairwise
from multiprocessing import parent_process
from typing import Any

from ehlcontact.process.blas import blas_threads

LEAST_CHUNK = 4  # items, lines of a grid: a chunk costs some 5 us beside them, as much as a line of 100 nodes
CHUNKS_EACH = 4  # chunks per thread: with fewer, who waits at the end waits longer

Kernel = Callable[..., object]  # of first, last and the arguments of the run


class Team:
    """The calling thread and `threads` - 1 others, which sleep between runs.

    One run at a time has the others: whoever comes meanwhile, from another thread or from a kernel, does its run
    alone. They are started by the first run that needs them, again after a fork, and end with the process.

    Parameters
    ----------
    threads : int
        At least 1, which is the calling thread.
    """

    def __init__(self, threads: int = 1) -> None:
        self.threads = threads
        self._begin()

    def _begin(self) -> None:
        self._process = os.getpid()
        self._free = threading.Lock()
        self._others: list[_Worker] = []

    def run(self, kernel: Kernel, count: int, *args: Any, least: int = LEAST_CHUNK) -> None:
        """Call ``kernel(first, last, *args)`` on chunks of ``range(count)``, side by side, and wait for all.

        Parameters
        ----------
        kernel : callable
            Its items must not depend on each other, and it should release the interpreter lock.
        count : int
            Items.
        *args
            What else the kernel takes.
        least : int
            Items of the smallest chunk worth a call of its own.

        Raises
        ------
        Exception
            What the kernel raised, that of the first chunk where several did; nothing runs on by then.
        """
        chunks = min(CHUNKS_EACH * self.threads, count // least)
        if self.threads < 2 or chunks < 2 or not self._take():
            kernel(0, count, *args)
            return
        try:
            self._share(_Share(kernel, [count * k // chunks for k in range(chunks + 1)], args), chunks)
        finally:
            self._free.release()

    def _take(self) -> bool:
        if self._process != os.getpid():  # a fork: its parent's threads are not here
            self._begin()
        return self._free.acquire(blocking=False)

    def _share(self, share: _Share, chunks: int) -> None:
        while len(self._others) < self.threads - 1:
            self._others.append(_Worker(len(self._others) + 1))
        helpers: list[_Help] = []
        try:
            for worker in self._others[: chunks - 1]:
                helpers.append(worker.call(share))
            share.work()
        finally:
            share.stop()
            _wait(helpers)
        if share.errors:
            raise min(share.errors, key=lambda found: found[0])[1]

    def __reduce__(self) -> tuple[Callable[[int], Team], tuple[int]]:
        return team_of, (self.threads,)  # threads are not copied with what uses them


class _Share:
    """Chunks of a run, taken one after the other by the caller and its helpers."""

    def __init__(self, kernel: Kernel, bounds: list[int], args: tuple[Any, ...]) -> None:
        self._kernel, self._args = kernel, args
        self._chunks = iter(list(pairwise(bounds)))  # of a list: atomic
        self.errors: list[tuple[int, BaseException]] = []

    def work(self) -> None:
        """Take chunks until there are none left; an error is kept, and ends the run."""
        kernel, args = self._kernel, self._args
        for first, last in self._chunks:
            try:
                kernel(first, last, *args)
            except BaseException as error:
                self.errors.append((first, error))
                self.stop()

    def stop(self) -> None:
        """Leave no chunks to helpers that join late."""
        for _ in self._chunks:
            pass


class _Help:
    """A request to another thread to join a run."""

    __slots__ = ("begun", "done", "ended", "share")

    def __init__(self, share: _Share) -> None:
        self.share = share
        self.begun = self.done = False
        self.ended = threading.Lock()
        self.ended.acquire()

    def work(self) -> None:
        self.begun = True  # before it looks for a chunk: who has not begun by the end of the chunks will find none
        self.share.work()
        self.done = True
        self.ended.release()


class _Worker:
    """A helper thread; a request that comes before it woke replaces the one before."""

    def __init__(self, number: int) -> None:
        self._asked: _Help | None = None
        self._bell = threading.Lock()
        self._bell.acquire()
        threading.Thread(target=self._serve, name=f"ehlcontact-{number}", daemon=True).start()

    def call(self, share: _Share) -> _Help:
        self._asked = asked = _Help(share)
        if self._bell.locked():  # else it rings already
            self._bell.release()
        return asked

    def _serve(self) -> None:
        while True:
            self._bell.acquire()
            asked, self._asked = self._asked, None
            if asked is not None:
                asked.work()
            del asked  # the arrays of a run may go before the next one comes


def _wait(helpers: list[_Help]) -> None:
    """Wait until all who have begun have ended, also where Ctrl-C comes meanwhile, which is raised then."""
    interrupt: BaseException | None = None
    for helper in helpers:
        while helper.begun and not helper.done:
            try:
                helper.ended.acquire()
            except BaseException as error:  # of a signal handler: arrays must not go while they are written
                interrupt = error
    if interrupt is not None:
        raise interrupt


@cache
def team_of(threads: int) -> Team:
    """The team of so many threads; all solves of a process share it."""
    return Team(threads)


CALLING_THREAD = Team()


def cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def threads_allowed() -> int:
    """How many threads a solve takes by itself: the cores, within what BLAS is limited to.

    That limit is set by ``OPENBLAS_NUM_THREADS`` or ``threadpool_limits``. One thread in a process that
    `multiprocessing` has started, such as a Dask worker: the other cores are those of the other workers.
    """
    if parent_process() is not None:
        return 1
    return min(cores(), blas_threads() or cores())
