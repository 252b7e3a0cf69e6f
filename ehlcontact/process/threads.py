"""Threads for compiled loops over independent items: whole fields and lines of one colour.

Chunks only split the items among the threads, so results are the same, bit for bit, for any number of them.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from functools import cache
from multiprocessing import parent_process
from queue import SimpleQueue
from typing import Any

from ehlcontact.process.blas import blas_threads

LEAST_CHUNK = 4  # items, a line of a grid at least: a chunk costs some 10 us, as much as a line of 200 nodes

Kernel = Callable[..., object]  # of first, last and the arguments of the run


class Team:
    """The calling thread and `threads` - 1 others, which wait between runs.

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
        self._queues: list[SimpleQueue[_Chunk]] = []

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
            Items of the smallest chunk worth a thread of its own.

        Raises
        ------
        Exception
            What the kernel raised, that of the first chunk where several did; all chunks have ended by then.
        """
        chunks = min(self.threads, count // least)
        if chunks < 2 or not self._take():
            kernel(0, count, *args)
            return
        try:
            self._share(kernel, [count * k // chunks for k in range(chunks + 1)], args)
        finally:
            self._free.release()

    def _take(self) -> bool:
        if self._process != os.getpid():  # a fork: its parent's threads are not here
            self._begin()
        return self._free.acquire(blocking=False)

    def _share(self, kernel: Kernel, bounds: list[int], args: tuple[Any, ...]) -> None:
        while len(self._queues) < len(bounds) - 2:
            self._queues.append(_start_thread(len(self._queues)))
        given = []
        try:
            for queue, first, last in zip(self._queues, bounds[1:], bounds[2:], strict=False):
                chunk = _Chunk(kernel, first, last, args)
                queue.put(chunk)
                given.append(chunk)  # not before it is given: Ctrl-C in between would wait for ever
            kernel(bounds[0], bounds[1], *args)
        finally:
            _wait(given)
        for chunk in given:
            if chunk.error is not None:
                raise chunk.error

    def __reduce__(self) -> tuple[Callable[[int], Team], tuple[int]]:
        return team_of, (self.threads,)  # threads are not copied with what uses them


class _Chunk:
    """A share of a run for one of the others."""

    __slots__ = ("args", "done", "ended", "error", "first", "kernel", "last")

    def __init__(self, kernel: Kernel, first: int, last: int, args: tuple[Any, ...]) -> None:
        self.kernel, self.first, self.last, self.args = kernel, first, last, args
        self.error: BaseException | None = None
        self.done = False
        self.ended = threading.Lock()
        self.ended.acquire()

    def work(self) -> None:
        try:
            self.kernel(self.first, self.last, *self.args)
        except BaseException as error:
            self.error = error
        self.done = True
        self.ended.release()


def _start_thread(number: int) -> SimpleQueue[_Chunk]:
    queue: SimpleQueue[_Chunk] = SimpleQueue()

    def work() -> None:
        while True:
            queue.get().work()  # kept in no name: the arrays of a run may go before the next one comes

    threading.Thread(target=work, name=f"ehlcontact-{number + 1}", daemon=True).start()
    return queue


def _wait(given: list[_Chunk]) -> None:
    """Wait until all chunks have ended, also where Ctrl-C comes meanwhile, which is raised then."""
    interrupt: BaseException | None = None
    for chunk in given:
        while not chunk.done:
            try:
                chunk.ended.acquire()
            except BaseException as error:  # of a signal handler: arrays must not go while they are written
                interrupt = error
    if interrupt is not None:
        raise interrupt


@cache
def team_of(threads: int) -> Team:
    """The team of so many threads; all solves of a process share it."""
    return Team(threads)


ALONE = Team()


def cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def threads_allowed() -> int:
    """How many threads a solve takes by itself: the cores, within what BLAS is limited to.

    That is where whoever knows better says so (``OPENBLAS_NUM_THREADS``, ``threadpool_limits``). One in a process
    that `multiprocessing` has started, Dask workers among them: the other cores are those of its siblings.
    """
    if parent_process() is not None:
        return 1
    return min(cores(), blas_threads() or cores())
