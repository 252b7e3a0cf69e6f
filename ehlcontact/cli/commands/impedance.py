"""``ehlcontact impedance``: stiffness and damping over frequency."""

from __future__ import annotations

from typing import Annotated

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import check_json, show_table, write_json
from ehlcontact.cli.progress import progress

Frequencies = Annotated[
    list[float],
    typer.Option(
        "--Omega",
        "--omega",
        help="Dimensionless angular frequency (unit of time 2a/u_sum), >= 0; give it once per frequency. "
        "Both names mean the same: this command knows dimensionless points only.",
    ),
]


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("impedance")(impedance)


@o.grouped
def impedance(contact: o.Contact, Omega: Frequencies, grid: o.Grid, json_to: o.JsonTo = None) -> None:
    """Linearise the steady film: stiffness K and damping C over frequency."""
    from ehlcontact.impedance import impedance as solve

    point, chosen = contact.solvable(), grid.chosen()
    check_json(json_to)
    with progress("linearised contact"):
        result = solve(point, Omega=Omega, **chosen)
    write_json(result.summary(), json_to)
    triples = zip(result.Omega, result.stiffness, result.damping, strict=True)
    show_table(
        "impedance: force over approach, static load 1, dry approach 1, time unit 2a/u_sum",
        [
            *o.point_rows(point),
            *((f"Omega = {w:g}", f"K {k:.4f}", f"C {c:.5f}") for w, k, c in triples),
            ("grid", f"n = {result.n}", f"on {o.domain_text(result.domain)}"),
            ("computed in", f"{numeral(result.seconds, 3)} s", ""),
        ],
        json_to,
    )
