"""Building the atlas: every sample point solved once, kept in a work file that survives a kill."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from ehlcontact import __version__
from reduced_models.atlas.assemble import assemble
from reduced_models.atlas.sample import SAMPLED, sample_points
from reduced_models.atlas.solve import OMEGAS, solve_point
from reduced_models.atlas.table import AtlasTable
from reduced_models.atlas.work import WorkFile
from reduced_models.atlas.workers import Job, Solve, on_cluster, on_processes

DRAWS, LIGHT_DRAWS, SEED = 384, 256, 4
Progress = Callable[[int, int], None]


def solve_samples(
    work: Path,
    draws: int = DRAWS,
    light_draws: int = LIGHT_DRAWS,
    *,
    seed: int = SEED,
    processes: int = 1,
    scheduler: str | None = None,
    progress: Progress | None = None,
    solve: Solve = solve_point,
) -> list[dict[str, Any]]:
    """Solve the sample points that the work file does not hold yet, and return the entries of all.

    Killed at any moment and called again it goes on; the entries come out the same. A work file may be carried on
    with more draws.

    Parameters
    ----------
    work : Path
        Work file, made if it does not exist.
    draws, light_draws : int
        Over the box, and over its light loads; see `reduced_models.atlas.sample.sample_points`.
    seed : int
        Of the Sobol sequence.
    processes : int
        Of this machine.
    scheduler : str, optional
        Address of a Dask scheduler, whose workers solve instead.
    progress : callable, optional
        Called with the numbers of points done and in all.
    solve : callable
        Of one point; to be found by name in every worker.

    Raises
    ------
    InputError
        A work file of other settings, or no scheduler at that address.
    """
    points = sample_points(draws, light_draws, seed)
    with WorkFile(work, settings(seed)) as file:
        # Thin films take longest and are begun first, so that no process ends up with them alone.
        jobs: list[Job] = [(name, point) for name, point in points.items() if name not in file.entries]
        jobs.sort(key=lambda job: job[1].inlet_width)
        found: Iterable[tuple[str, dict[str, Any]]] = ()
        if jobs and scheduler is not None:
            found = on_cluster(solve, jobs, scheduler)
        elif jobs:
            found = on_processes(solve, jobs, processes)
        done = len(points) - len(jobs)
        for name, entry in found:
            file.add(name, entry)
            done += 1
            if progress is not None:
                progress(done, len(points))
        return [file.entries[name] for name in points]


def build_atlas(
    output: Path,
    work: Path,
    draws: int = DRAWS,
    light_draws: int = LIGHT_DRAWS,
    *,
    seed: int = SEED,
    processes: int = 1,
    scheduler: str | None = None,
    progress: Progress | None = None,
    solve: Solve = solve_point,
) -> AtlasTable:
    """Solve what is missing, put the table together and write it; arguments as for `solve_samples`.

    The file does not depend on who solved the points, nor on how often the build was interrupted.
    """
    entries = solve_samples(
        work,
        draws,
        light_draws,
        seed=seed,
        processes=processes,
        scheduler=scheduler,
        progress=progress,
        solve=solve,
    )
    made_by = {
        "command": f"ehlcontact atlas build --draws {draws} --light-draws {light_draws} --seed {seed}",
        "version": __version__,
        "sampled": SAMPLED.to_dict(),
    }
    table = assemble(entries, made_by)
    table.save(output)
    return table


def settings(seed: int) -> dict[str, Any]:
    """What the entries of a work file have in common, in the form JSON gives back."""
    found = {"seed": seed, "box": SAMPLED.to_dict(), "omega": list(OMEGAS), "version": __version__}
    return dict(json.loads(json.dumps(found)))
