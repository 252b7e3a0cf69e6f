"""``ehlcontact atlas``: building the table of solved contacts that elements are taken from."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from ehlcontact.checks import require_integer
from ehlcontact.cli import options as o
from ehlcontact.cli.output import check_apart, complain
from ehlcontact.cli.progress import progress
from ehlcontact.cli.usage import epilog
from ehlcontact.process.early_interrupt import INTERRUPTED

HELP = "Build the tables of solved contacts that elements are taken from."
group = typer.Typer(no_args_is_help=True, help=HELP)


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
    work: Annotated[
        Path | None,
        typer.Option("--work", metavar="FOLDER", help="Solved points; by default as the output, ending in .work."),
    ] = None,
    draws: Annotated[int, typer.Option("--draws", help="Sample points over the box.")] = 448,
    light_draws: Annotated[int, typer.Option("--light-draws", help="More of them at light loads.")] = 256,
    seed: Annotated[int, typer.Option("--seed", help="Of the sample.")] = 4,
    processes: Annotated[
        int | None, typer.Option("--processes", help="Of this machine; one per core by default.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Solve on this Dask cluster instead.")
    ] = None,
) -> None:
    """Solve the sample and write the atlas; stopped at any moment and started again, it goes on."""
    from reduced_models.atlas.build import build_atlas

    kept = output.with_suffix(".work") if work is None else work
    out.check(beside={"--output": (output, (".h5",))})
    check_apart({"--output": output, "--work": kept})
    for name, value in (("--draws", draws), ("--light-draws", light_draws), ("--seed", seed)):
        require_integer(name, value, "a whole number >= 0", 0)
    count = (os.cpu_count() or 1) if processes is None else processes
    require_integer("--processes", count, "a whole number > 0", 1)
    try:
        with progress("points") as update:
            table = build_atlas(
                output, kept, draws, light_draws, seed=seed, processes=count, scheduler=scheduler, progress=update
            )
    except KeyboardInterrupt:
        complain(f"interrupted; points that were solved are in {kept}, the same command goes on")
        raise typer.Exit(INTERRUPTED) from None
    left_out = sum(table.metadata["left_out"].values())
    rows = [
        ("points", str(table.metadata["points"]), f"{left_out} left out: not converged or too thin a film"),
        ("file", f"{output.stat().st_size / 1e6:.2f} MB", str(output)),
        ("box", "", str(table.box)),
    ]
    document = {"output": str(output), "work": str(kept), **table.metadata}
    out.deliver(document, ("atlas", rows))


@group.command("supply", epilog=epilog("atlas supply"))
@o.grouped
def supply(
    out: o.Output,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The table, HDF5.")] = Path(
        "supply.h5"
    ),
    work: Annotated[
        Path | None,
        typer.Option("--work", metavar="FOLDER", help="Solved points; by default as the output, ending in .work."),
    ] = None,
    draws: Annotated[int, typer.Option("--draws", help="Sample points over the box.")] = 256,
    seed: Annotated[int, typer.Option("--seed", help="Of the sample.")] = 31,
    processes: Annotated[
        int | None, typer.Option("--processes", help="Of this machine; one per core by default.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Solve on this Dask cluster instead.")
    ] = None,
) -> None:
    """Solve contacts under layers of oil and write what these change; started again, it goes on."""
    from reduced_models.atlas.supply_build import build_supply

    kept = output.with_suffix(".work") if work is None else work
    out.check(beside={"--output": (output, (".h5",))})
    check_apart({"--output": output, "--work": kept})
    for name, value in (("--draws", draws), ("--seed", seed)):
        require_integer(name, value, "a whole number >= 0", 0)
    count = (os.cpu_count() or 1) if processes is None else processes
    require_integer("--processes", count, "a whole number > 0", 1)
    try:
        with progress("points") as update:
            table = build_supply(
                output, kept, draws, seed=seed, processes=count, scheduler=scheduler, progress=update
            )
    except KeyboardInterrupt:
        complain(f"interrupted; points that were solved are in {kept}, the same command goes on")
        raise typer.Exit(INTERRUPTED) from None
    rows = [
        ("points", str(table.metadata["points"]), f"{table.metadata['left_out']} left out: not converged"),
        ("file", f"{output.stat().st_size / 1e6:.2f} MB", str(output)),
        ("box", "", str(table.box)),
    ]
    document = {"output": str(output), "work": str(kept), **table.metadata}
    out.deliver(document, ("table of oil supply", rows))


@group.command("waves", epilog=epilog("atlas waves"))
@o.grouped
def waves(
    out: o.Output,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The table, HDF5.")] = Path(
        "filters.h5"
    ),
    work: Annotated[
        Path | None,
        typer.Option("--work", metavar="FOLDER", help="Solved points; by default as the output, ending in .work."),
    ] = None,
    draws: Annotated[int, typer.Option("--draws", help="Sample points over the box.")] = 72,
    seed: Annotated[int, typer.Option("--seed", help="Of the sample.")] = 7,
    processes: Annotated[
        int | None, typer.Option("--processes", help="Of this machine; one per core by default.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Solve on this Dask cluster instead.")
    ] = None,
) -> None:
    """Solve waves on the surfaces of contacts and write the table of contact filters; goes on where it stopped."""
    from reduced_models.atlas.filter_build import build_filters

    kept = output.with_suffix(".work") if work is None else work
    out.check(beside={"--output": (output, (".h5",))})
    check_apart({"--output": output, "--work": kept})
    for name, value in (("--draws", draws), ("--seed", seed)):
        require_integer(name, value, "a whole number >= 0", 0)
    count = (os.cpu_count() or 1) if processes is None else processes
    require_integer("--processes", count, "a whole number > 0", 1)
    try:
        with progress("points") as update:
            table = build_filters(
                output, kept, draws, seed=seed, processes=count, scheduler=scheduler, progress=update
            )
    except KeyboardInterrupt:
        complain(f"interrupted; points that were solved are in {kept}, the same command goes on")
        raise typer.Exit(INTERRUPTED) from None
    rows = [
        ("points", str(table.metadata["points"]), f"{table.metadata['left_out']} left out: not converged"),
        ("file", f"{output.stat().st_size / 1e6:.2f} MB", str(output)),
        ("box", "", str(table.box)),
    ]
    document = {"output": str(output), "work": str(kept), **table.metadata}
    out.deliver(document, ("table of contact filters", rows))


@group.command("heat", epilog=epilog("atlas heat"))
@o.grouped
def heat(
    out: o.Output,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The table, HDF5.")] = Path(
        "heat.h5"
    ),
    work: Annotated[
        Path | None,
        typer.Option(
            "--work", metavar="FOLDER", help="Solved contacts; by default as the output, ending in .work."
        ),
    ] = None,
    draws: Annotated[int, typer.Option("--draws", help="Contacts drawn; some are none of a bearing.")] = 256,
    seed: Annotated[int, typer.Option("--seed", help="Of the sample.")] = 11,
    processes: Annotated[
        int | None, typer.Option("--processes", help="Of this machine; one per core by default.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Solve on this Dask cluster instead.")
    ] = None,
) -> None:
    """Solve contacts with heat and without, write the table of what heat changes; goes on where it stopped."""
    from reduced_models.atlas.heat_build import build_heat

    kept = output.with_suffix(".work") if work is None else work
    out.check(beside={"--output": (output, (".h5",))})
    check_apart({"--output": output, "--work": kept})
    for name, value in (("--draws", draws), ("--seed", seed)):
        require_integer(name, value, "a whole number >= 0", 0)
    count = (os.cpu_count() or 1) if processes is None else processes
    require_integer("--processes", count, "a whole number > 0", 1)
    try:
        with progress("contacts") as update:
            table = build_heat(
                output, kept, draws, seed=seed, processes=count, scheduler=scheduler, progress=update
            )
    except KeyboardInterrupt:
        complain(f"interrupted; contacts that were solved are in {kept}, the same command goes on")
        raise typer.Exit(INTERRUPTED) from None
    left_out = sum(table.metadata["left_out"].values())
    rows = [
        ("contacts", str(table.metadata["points"]), f"{left_out} left out: not converged"),
        ("file", f"{output.stat().st_size / 1e6:.3f} MB", str(output)),
    ]
    out.deliver({"output": str(output), "work": str(kept), **table.metadata}, ("table of heat", rows))
