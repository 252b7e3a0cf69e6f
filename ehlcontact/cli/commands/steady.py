"""``ehlcontact steady``: the film under constant load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import FAILED, complain
from ehlcontact.cli.progress import progress

if TYPE_CHECKING:
    from ehlcontact.results import SteadyResult


Refine = Annotated[
    bool,
    typer.Option(
        "--refine/--no-refine",
        help="Without --n: a finer grid where the errors estimated are above 0.2 % of the dry approach, "
        "1 % of the central and 3 % of the smallest film.",
        rich_help_panel="Discretisation",
    ),
]


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("steady")(steady)


@o.grouped
def steady(contact: o.Contact, grid: o.Grid, files: o.Files, refine: Refine = True) -> None:
    """Solve the steady film of a contact."""
    from ehlcontact.steady import solve_steady

    point, chosen = contact.solvable(), grid.chosen()
    files.check()
    with progress("steady film") as update:
        result = solve_steady(
            point,
            **chosen,
            refine=refine,
            throw=False,
            callback=lambda cycle, residual: update(cycle, None, f"cycle {cycle}, residual {residual:.1e}"),
        )
    files.deliver(result, "steady film", _rows(result), _draw)
    if not result.status.ok:
        kept = f"; partial result in {files.save}" if files.save else ""
        complain(f"{result.status}: {result.status.advice}{kept}")
        raise typer.Exit(FAILED)


def _draw(result: SteadyResult) -> Any:
    from ehlcontact.cli.plots.film import steady_figure

    return steady_figure(result)


def _rows(result: SteadyResult) -> list[tuple[str, str, str]]:
    approach = central = smallest = ""
    if (error := result.error) is not None:
        approach = f", ± {numeral(error.approach, 1)}"
        central, smallest = (f", ± {numeral(100.0 * e, 2)} % of it" for e in (error.h_central, error.h_min))
    return [
        *o.point_rows(result.point),
        ("approach", f"{result.approach:.5f}", f"of the dry Hertz approach{approach}"),
        ("central film", f"{result.h_central:.5f}", f"of the dry Hertz approach{central}"),
        ("minimum film", f"{result.h_min:.5f}", f"of the dry Hertz approach{smallest}"),
        ("maximum pressure", f"{result.p_max:.4f}", "of the Hertz pressure"),
        ("moment of pressure", f"{result.moment:.5f}", "of load times semi-axis a: the film's rolling resistance"),
        ("pressure to come", f"{result.pressure_error:.1e}", "of the Hertz pressure, by further cycles"),
        ("residual", f"{result.residual:.1e}", "over the dry start's"),
        ("load balance", f"{result.load_residual:.1e}", "over the load"),
        ("cycles", f"{result.cycles}", ""),
        ("grid", f"n = {result.n}", f"on {o.domain_text(result.domain)}"),
        ("computed in", f"{numeral(result.seconds, 3)} s", ""),
        ("status", str(result.status), ""),
    ]
