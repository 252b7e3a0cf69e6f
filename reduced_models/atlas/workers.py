"""Who solves the points of an atlas: processes of this machine, or a Dask cluster."""

from __future__ import annotations

import multiprocessing
import os
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.point import MoesPoint

Job = tuple[str, MoesPoint]
Solve = Callable[[MoesPoint], dict[str, Any]]
ATTEMPTS = 3  # at a point whose worker dies
CONNECT_SECONDS = 10


def on_processes(solve: Solve, jobs: Sequence[Job], processes: int) -> Iterator[tuple[str, dict[str, Any]]]:
    """Solve on so many processes of this machine; yields name and entry as they come.

    A process that dies takes its points along: they are tried again by new ones, up to three times in all.

    Raises
    ------
    ConvergenceError
        Processes keep dying.
    """
    left = dict(jobs)
    for attempt in range(ATTEMPTS):
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(processes, context, initializer=_follow_parent) as pool:
            futures: dict[Future[dict[str, Any]], str] = {
                pool.submit(solve, point): name for name, point in left.items()
            }
            try:
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
                pool.shutdown(wait=True, cancel_futures=True)


def _follow_parent() -> None:
    """End this process when its parent ends, however that was: a killed build leaves nothing behind."""
    parent = multiprocessing.parent_process()
    if parent is not None:

        def watch() -> None:
            parent.join()
            os._exit(1)

        threading.Thread(target=watch, daemon=True).start()


def on_cluster(solve: Solve, jobs: Sequence[Job], scheduler: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """Solve on the Dask cluster at that address; what a lost worker was at goes to another one.

    Raises
    ------
    InputError
        ``dask.distributed`` is not installed, or no scheduler answers there.
    ConvergenceError
        Workers keep dying at a point.
    """
    try:
        import distributed
    except ImportError:
        raise InputError("--scheduler", scheduler, "used with dask: pip install 'ehlcontact[cluster]'") from None
    try:
        client = distributed.Client(scheduler, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        reason = str(error) or type(error).__name__
        raise InputError("--scheduler", scheduler, f"the address of a Dask scheduler ({reason})") from None
    with client:
        futures = {
            client.submit(solve, point, key=f"atlas-{name}-{os.getpid()}", retries=ATTEMPTS, pure=False): name
            for name, point in jobs
        }
        finished = distributed.as_completed(futures, loop=client.loop, with_results=True)
        try:
            for future, entry in finished:
                name = futures.pop(future)
                future.release()
                yield name, entry
        except distributed.KilledWorker as error:
            raise ConvergenceError(f"workers died: {error}; what was solved is kept", None) from None
