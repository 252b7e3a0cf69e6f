"""Points of an atlas build: solved by an executor, and kept in a store by content as they come."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ehlcontact.content_store import ContentStore, key_of
from ehlcontact.executors import executor_for, results_of
from ehlcontact.files import parse_json

Solve = Callable[[Any], dict[str, Any]]  # of a point with `to_dict` and `inlet_width`


def solve_points(
    points: Mapping[str, Any],
    folder: Path,
    solve: Solve,
    *,
    processes: int = 1,
    scheduler: str | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> list[dict[str, Any]]:
    """Entries of all points, in their order; those that the folder holds are not solved again.

    Parameters
    ----------
    points : mapping
        By name: `MoesPoint`, or others with `to_dict` and `inlet_width`.
    folder : Path
        Of the store; made if it does not exist.
    solve : callable
        Gives the entry of a point; JSON must be able to hold it, and workers find the function by its name.
    processes : int
        Of this machine.
    scheduler : str, optional
        Address of a Dask scheduler, whose workers solve instead.
    progress : callable, optional
        Called with the numbers of points done and in all.

    Raises
    ------
    InputError
        The folder cannot be written to; no scheduler at that address.
    ConvergenceError
        Workers keep dying.
    """
    store = ContentStore(folder, "work folder")
    keys = {
        name: key_of([solve.__module__, solve.__qualname__, point.to_dict()]) for name, point in points.items()
    }
    entries = {name: parse_json(content) for name, key in keys.items() if (content := store.get(key)) is not None}
    # Thin films take longest and are begun first, so that no process ends up with them alone.
    missing = dict(sorted(points.items(), key=lambda item: item[1].inlet_width))
    missing = {name: point for name, point in missing.items() if name not in entries}
    if missing:
        with executor_for(processes, scheduler=scheduler) as executor:
            for name, entry in results_of(executor, solve, missing):
                content = json.dumps(entry, allow_nan=False).encode()
                store.put(keys[name], content)
                entries[name] = parse_json(content)
                if progress is not None:
                    progress(len(entries), len(points))
    return [{"point": name, **entries[name]} for name in points]
