"""``ehlcontact atlas build``: building a table of solved contacts that elements are taken from."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from ehlcontact.checks import require_choice
from ehlcontact.checks.kinds import Count
from ehlcontact.cli import options as o
from ehlcontact.cli.output import check_apart, complain
from ehlcontact.cli.progress import progress
from ehlcontact.cli.usage import epilog
from ehlcontact.process.early_interrupt import INTERRUPTED

HELP = "Build the tables of solved contacts that elements are taken from."
group = typer.Typer(no_args_is_help=True, help=HELP)

MOST_PROCESSES = 1024  # of one machine
MOST_DRAWS = 10_000_000  # of a sample: years of solves


@group.callback(help=HELP)
def _group() -> None:
    """Subcommands of the atlas."""


@group.command("build", epilog=epilog("atlas build"))
@o.grouped
def build(
    out: o.Output,
    recipe: Annotated[
        str,
        typer.Option(
            metavar="film|supply|heat|waves",
            help="Films and impedances; what a layer of oil, or heat, changes; contact filters of waves.",
        ),
    ] = "film",
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="The table, HDF5; by default the recipe's name.h5."),
    ] = None,
    work: Annotated[
        Path | None,
        typer.Option("--work", metavar="FOLDER", help="Solved points; by default as the output, ending in .work."),
    ] = None,
    draws: Annotated[
        int | None, typer.Option("--draws", help="Sample points over the box; those of the recipe by default.")
    ] = None,
    light_draws: Annotated[
        int | None, typer.Option("--light-draws", help="More of them at light loads, for films.")
    ] = None,
    seed: Annotated[int | None, typer.Option("--seed", help="Of the sample; the recipe's by default.")] = None,
    processes: Annotated[
        int | None, typer.Option("--processes", help="Of this machine; one per core by default.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Solve on this Dask cluster instead.")
    ] = None,
) -> None:
    """Solve the sample of a recipe and write its table; stopped at any moment and started again, it goes on."""
    from reduced_models.atlas.build import build as build_table
    from reduced_models.atlas.table import RECIPES, recipe_named

    kind = recipe_named(require_choice("--recipe", recipe, RECIPES))
    path = Path(f"{recipe}.h5") if output is None else output
    folder = path.with_suffix(".work") if work is None else work
    out.check(beside={"--output": (path, (".h5",))})
    check_apart({"--output": path, "--work": folder})
    numbers = {"draws": draws, "light_draws": light_draws, "seed": seed}
    among = Count(0, MOST_DRAWS)
    sample = {
        name: among.take(f"--{name.replace('_', '-')}", value, True)
        for name, value in numbers.items()
        if value is not None
    }
    count = (os.cpu_count() or 1) if processes is None else processes
    Count(1, MOST_PROCESSES).take("--processes", count, True)
    try:
        with progress(kind.things) as update:
            table = build_table(
                recipe, path, folder, sample, processes=count, scheduler=scheduler, progress=update
            )
    except KeyboardInterrupt:
        complain(f"interrupted; {kind.things} that were solved are in {folder}, the same command goes on")
        raise typer.Exit(INTERRUPTED) from None
    lost = sum(table.metadata["left_out"].values())
    rows = [
        (kind.things, str(table.metadata["points"]), f"{lost} left out: {kind.why_left_out}"),
        ("file", f"{path.stat().st_size / 1e6:.3g} MB", str(path)),
        *([] if kind.box is None else [("box", "", str(table.box))]),
    ]
    out.deliver({"output": str(path), "work": str(folder), **table.metadata}, (kind.title, rows))
