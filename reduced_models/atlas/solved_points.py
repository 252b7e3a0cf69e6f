"""Points of a table: solved by an executor, kept in a store by content as they come, and put together."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence, Sized
from pathlib import Path
from typing import Any, TypedDict, TypeVar, Unpack

from ehlcontact import __version__
from ehlcontact.content_store import ContentStore, key_of
from ehlcontact.errors import InputError
from ehlcontact.executors import executor_for, require_scheduler, results_of
from ehlcontact.files import parse_json

Solve = Callable[[Any], dict[str, Any]]  # of a point with `to_dict` and `inlet_width`
Entry = Mapping[str, Any]
T = TypeVar("T")

FEWEST = 20  # converged points of a table, and pairs from which the atlas learns the oil further out


class Solving(TypedDict, total=False):
    """Who solves points, and who is told: arguments of `solve_points`."""

    processes: int
    scheduler: str | None
    progress: Callable[[int, int], None] | None


def require_enough(things: str, found: Sized, advice: str) -> None:
    """Raise `InputError` unless a table can be made of these."""
    if len(found) < FEWEST:
        raise InputError(things, len(found), f"at least {FEWEST}{advice}")


def solved_table(
    points: Mapping[str, Any],
    folder: Path,
    solve: Solve,
    assemble: Callable[[Sequence[Entry], Mapping[str, Any]], T],
    command: str,
    **solving: Unpack[Solving],
) -> T:
    """Table that `assemble` makes of the entries of all points, with the command and the version for its metadata.

    Other arguments and errors as of `solve_points`; a scheduler is looked for before the folder is made.
    """
    if (scheduler := solving.get("scheduler")) is not None:
        require_scheduler(scheduler)
    entries = solve_points(points, folder, solve, **solving)
    return assemble(entries, {"command": command, "version": __version__})


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
