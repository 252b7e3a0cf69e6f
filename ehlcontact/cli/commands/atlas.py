"""``ehlcontact atlas``: building the table of solved contacts that elements are taken from."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from ehlcontact.checks import require_integer
from ehlcontact.cli import options as o
from ehlcontact.cli.output import check_apart, complain
from ehlcontact.cli.progress import progress
from ehlcontact.cli.usage import epilog
from ehlcontact.process.early_interrupt import INTERRUPTED

HELP = "Build the tables of solved contacts that elements are taken from."
group = typer.Typer(no_args_is_help=True, help=HELP)

Table = Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The table, HDF5.")]
WORK = "Solved {}; by default as the output, ending in .work."
Work = Annotated[Path | None, typer.Option("--work", metavar="FOLDER", help=WORK.format("points"))]
Draws = Annotated[int, typer.Option("--draws", help="Sample points over the box.")]
Seed = Annotated[int, typer.Option("--seed", help="Of the sample.")]
Processes = Annotated[int | None, typer.Option("--processes", help="Of this machine; one per core by default.")]
Scheduler = Annotated[
    str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Solve on this Dask cluster instead.")
]


@group.callback(help=HELP)
def _group() -> None:
    """Subcommands are one for each table."""


@group.command("build", epilog=epilog("atlas build"))
@o.grouped
def build(
    out: o.Output,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The atlas, HDF5.")] = Path(
        "atlas.h5"
    ),
    work: Work = None,
    draws: Draws = 448,
    light_draws: Annotated[int, typer.Option("--light-draws", help="More of them at light loads.")] = 256,
    seed: Seed = 4,
    processes: Processes = None,
    scheduler: Scheduler = None,
) -> None:
    """Solve the sample and write the atlas; stopped at any moment and started again, it goes on."""
    from reduced_models.atlas.build import build_atlas

    sample = {"draws": draws, "light_draws": light_draws, "seed": seed}
    why = "not converged or too thin a film"
    _make(build_atlas, "atlas", out, output, work, sample, processes, scheduler, left_out=why)


@group.command("supply", epilog=epilog("atlas supply"))
@o.grouped
def supply(
    out: o.Output,
    output: Table = Path("supply.h5"),
    work: Work = None,
    draws: Draws = 256,
    seed: Seed = 31,
    processes: Processes = None,
    scheduler: Scheduler = None,
) -> None:
    """Solve contacts under layers of oil and write what these change; started again, it goes on."""
    from reduced_models.atlas.supply_build import build_supply

    sample = {"draws": draws, "seed": seed}
    _make(build_supply, "table of oil supply", out, output, work, sample, processes, scheduler)


@group.command("waves", epilog=epilog("atlas waves"))
@o.grouped
def waves(
    out: o.Output,
    output: Table = Path("filters.h5"),
    work: Work = None,
    draws: Draws = 72,
    seed: Seed = 7,
    processes: Processes = None,
    scheduler: Scheduler = None,
) -> None:
    """Solve waves on the surfaces of contacts and write the table of contact filters; goes on where it stopped."""
    from reduced_models.atlas.filter_build import build_filters

    sample = {"draws": draws, "seed": seed}
    _make(build_filters, "table of contact filters", out, output, work, sample, processes, scheduler)


@group.command("heat", epilog=epilog("atlas heat"))
@o.grouped
def heat(
    out: o.Output,
    output: Table = Path("heat.h5"),
    work: Annotated[Path | None, typer.Option("--work", metavar="FOLDER", help=WORK.format("contacts"))] = None,
    draws: Annotated[int, typer.Option("--draws", help="Contacts drawn; some are none of a bearing.")] = 256,
    seed: Seed = 11,
    processes: Processes = None,
    scheduler: Scheduler = None,
) -> None:
    """Solve contacts with heat and without, write the table of what heat changes; goes on where it stopped."""
    from reduced_models.atlas.heat_build import build_heat

    sample = {"draws": draws, "seed": seed}
    _make(
        build_heat, "table of heat", out, output, work, sample, processes, scheduler, things="contacts", digits=3
    )


def _make(
    builder: Callable[..., Any],
    title: str,
    out: o.Output,
    output: Path,
    work: Path | None,
    sample: dict[str, int],
    processes: int | None,
    scheduler: str | None,
    *,
    things: str = "points",
    left_out: str = "not converged",
    digits: int = 2,
) -> None:
    """Build a table and tell of it; `sample` has the arguments of the builder that say what is solved."""
    kept = output.with_suffix(".work") if work is None else work
    out.check(beside={"--output": (output, (".h5",))})
    check_apart({"--output": output, "--work": kept})
    for name, value in sample.items():
        require_integer(f"--{name.replace('_', '-')}", value, "a whole number >= 0", 0)
    count = (os.cpu_count() or 1) if processes is None else processes
    require_integer("--processes", count, "a whole number > 0", 1)
    try:
        with progress(things) as update:
            table = builder(output, kept, **sample, processes=count, scheduler=scheduler, progress=update)
    except KeyboardInterrupt:
        complain(f"interrupted; {things} that were solved are in {kept}, the same command goes on")
        raise typer.Exit(INTERRUPTED) from None
    without = table.metadata["left_out"]  # in all, or by status
    lost = sum(without.values()) if isinstance(without, dict) else without
    rows = [
        (things, str(table.metadata["points"]), f"{lost} left out: {left_out}"),
        ("file", f"{output.stat().st_size / 1e6:.{digits}f} MB", str(output)),
    ]
    if "box" in table.metadata:
        rows.append(("box", "", str(table.box)))
    out.deliver({"output": str(output), "work": str(kept), **table.metadata}, (title, rows))
