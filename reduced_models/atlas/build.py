"""`build`: a table of the atlas by any recipe, from a sample solved on workers.

Points are kept in a store by content as they come: killed at any moment and called again, a build goes on.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence, Sized
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, TypedDict, Unpack

from ehlcontact import __version__
from ehlcontact.content_store import ContentStore, key_of
from ehlcontact.errors import InputError
from ehlcontact.executors import executor_for, require_scheduler, results_of
from ehlcontact.files import parse_json
from ehlcontact.store import save
from reduced_models.atlas.recipe import FEWEST, Entry, Solve
from reduced_models.atlas.surface import errors_of
from reduced_models.atlas.table import Table, recipe_named


class Solving(TypedDict, total=False):
    """Who solves points, and who is told: arguments of `solve_points`."""

    processes: int
    scheduler: str | None
    progress: Callable[[int, int], None] | None


def build(
    recipe: str,
    output: Path,
    work: Path,
    numbers: Mapping[str, int] | None = None,
    *,
    solve: Solve | None = None,
    **solving: Unpack[Solving],
) -> Table:
    """Solve the missing points of a sample, put the table together and write it.

    Killed at any moment and called again it goes on, also with more draws. The file does not depend on who solved
    the points, nor on how often the build was interrupted.

    Parameters
    ----------
    recipe : {"film", "supply", "heat", "waves"}
    output : Path
        The table.
    work : Path
        Folder of solved points, made if it does not exist.
    numbers : mapping, optional
        Numbers of the sample, ``draws`` and ``seed``, of films also ``light_draws``; those left out are the
        recipe's.
    solve : callable, optional
        Solution of one point, in place of the recipe's; to be found by name in every worker.
    **solving
        Processes, scheduler and progress, as of `solve_points`.

    Raises
    ------
    InputError
        No folder, no scheduler at that address, too few points that converged, or a number that the sample of
        this recipe does not have.
    """
    kind = recipe_named(recipe)
    for name, value in ({} if numbers is None else numbers).items():
        if name not in kind.numbers:
            allowed = f"left out with recipe {recipe!r}, whose sample has {', '.join(kind.numbers)}"
            raise InputError(name, value, allowed)
    sample = {**kind.numbers, **({} if numbers is None else numbers)}
    points = kind.sample(**sample)
    draws = " and ".join(f"{name} = {sample[name]}" for name in sample if name != "seed")
    _require_enough(kind.things, points, f"; {draws} have too few in the box")  # before they are solved
    if (scheduler := solving.get("scheduler")) is not None:
        require_scheduler(scheduler)
    entries = solve_points(points, work, kind.solve if solve is None else solve, **solving)
    options = " ".join(f"--{name.replace('_', '-')} {value}" for name, value in sample.items())
    command = f"ehlcontact atlas build --recipe {recipe} {options}"
    table = assemble(recipe, entries, {"command": command, "version": __version__}).rounded()
    save(table, output, kind.title)
    return table


def assemble(recipe: str, entries: Sequence[Entry], made_by: Mapping[str, Any]) -> Table:
    """Table of the converged entries, with errors where the recipe keeps them; `made_by` goes into its metadata.

    Raises
    ------
    InputError
        Too few converged.
    """
    kind = recipe_named(recipe)
    good = [entry for entry in entries if entry["status"] == "converged" and kind.usable(entry)]
    _require_enough(f"converged {kind.things}", good, " (more draws)")
    lost = Counter(str(entry["status"]) for entry in entries if entry["status"] != "converged")
    if unusable := len(entries) - len(good) - lost.total():
        lost["unusable"] = unusable
    points, axes, columns = kind.assemble(good)
    metadata = {
        **({} if kind.box is None else {"box": kind.box.to_dict()}),
        "interpolation": asdict(kind.interpolation),
        "points": len(good),
        "left_out": dict(lost),
        **kind.metadata(good),
        **made_by,
    }
    table = Table(recipe, points, axes, columns, metadata)
    return with_errors(table) if kind.keeps_errors else table


def with_errors(table: Table) -> Table:
    """Table with leave-one-out errors, from which its error bars follow."""
    left_out, factor = errors_of(table)
    return replace(table, columns=table.columns | {"left_out": left_out, "factor": factor})


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
    keys = {name: entry_key(solve, point) for name, point in points.items()}
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


def entry_key(solve: Solve, point: Any) -> str:
    """Name of the entry of a point in a work folder."""
    return key_of([solve.__module__, solve.__qualname__, point.to_dict()])


def _require_enough(things: str, entries: Sized, advice: str) -> None:
    """Raise `InputError` unless a table can be made of these."""
    if len(entries) < FEWEST:
        raise InputError(things, len(entries), f"at least {FEWEST}{advice}")
