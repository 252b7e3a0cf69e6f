"""``ehlcontact reproduce``: the paper's tables and figures, ours beside them."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.output import FAILED, complain, prepare_folder, say, write_json
from ehlcontact.errors import InputError
from ehlcontact.process.early_interrupt import INTERRUPTED
from ehlcontact.solver.domain import check_intervals

PAGE, DOCUMENT = "reproduction.html", "reproduction.json"


@o.grouped
def reproduce(
    out: o.Output,
    table: Annotated[
        list[int] | None, typer.Option("--table", metavar="N", help="Only these tables, 1 to 6; may be repeated.")
    ] = None,
    figure: Annotated[
        list[int] | None,
        typer.Option("--figure", metavar="N", help="Only these figures, 2 and 4 to 19; may be repeated."),
    ] = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="DIR", help="Folder of the simulations and the page.")
    ] = Path("results/reproduction"),
    n: Annotated[int, typer.Option("--n", help="Intervals along X, a multiple of 16.")] = 128,
) -> None:
    """Make the tables and figures of Nonato and Cavalca (2010), ours beside theirs.

    Run it again to resume: simulations that are finished in the folder are kept.
    """
    from ehlcontact.cli.paper.figures import FIGURES
    from ehlcontact.cli.paper.page import reproduce as make
    from ehlcontact.cli.paper.page import write_reproduction
    from ehlcontact.cli.paper.tables import TABLE_CASES

    everything = not table and not figure
    tables = _chosen("--table", table, tuple(TABLE_CASES), everything)
    figures = _chosen("--figure", figure, tuple(FIGURES), everything)
    check_intervals(n)
    out.check()
    prepare_folder(output)

    try:
        found = make(tables, figures, output, n)
    except KeyboardInterrupt:
        complain(f"interrupted; finished simulations are in {output}, the same command resumes")
        raise typer.Exit(INTERRUPTED) from None
    page = write_reproduction(found, output / PAGE)
    write_json(found.to_dict(), str(output / DOCUMENT), "file")
    out.deliver(found.to_dict(), partial(say, f"page: {page}", out.json_to))
    for name, why in found.failed.items():
        complain(f"{name}: {why}")
    if found.failed:
        raise typer.Exit(FAILED)


def _chosen(field: str, given: list[int] | None, known: tuple[int, ...], everything: bool) -> list[int]:
    """Numbers asked for, in order and once each; all if nothing at all was asked for.

    Raises
    ------
    InputError
        A number that the paper does not have, or whose table or figure holds no result.
    """
    for number in given or ():
        if number not in known:
            raise InputError(field, number, "one of " + ", ".join(map(str, known)))
    return sorted(set(known if everything else given or ()))
