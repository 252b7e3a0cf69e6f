"""``ehlcontact impedance``: stiffness and damping over frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.contact import Contact, frequency
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import check_json, show_table, write_json
from ehlcontact.cli.progress import progress
from ehlcontact.errors import InputError

if TYPE_CHECKING:
    from ehlcontact.results import ImpedanceResult

Frequencies = Annotated[
    list[float] | None,
    typer.Option(
        "--Omega",
        "--omega",
        help="Dimensionless angular frequency (unit of time 2a/u_sum), >= 0; give it once per frequency. "
        "Both names mean the same: neither is in rad/s.",
    ),
]
Hertz = Annotated[
    list[float] | None,
    typer.Option(
        "--hz",
        show_default="that of the shaft",
        help="Frequency of a bearing's contact, Hz; give it once per frequency.",
    ),
]


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("impedance")(impedance)


@o.grouped
def impedance(
    contact: Contact, grid: o.Grid, Omega: Frequencies = None, hz: Hertz = None, json_to: o.JsonTo = None
) -> None:
    """Linearise the steady film: stiffness K and damping C over frequency."""
    from ehlcontact.impedance import impedance as solve

    point, chosen = contact.solvable(), grid.chosen()
    at = frequency(contact, Omega or None, hz or None)
    if at is None:
        raise InputError("--Omega", None, "given: a dimensionless angular frequency (unit of time 2a/u_sum), >= 0")
    check_json(json_to)
    with progress("linearised contact"):
        result = solve(point, **at, **chosen)
    write_json({**result.to_dict(), **contact.about(point)}, json_to)
    static = "static load 1, dry approach 1, time unit 2a/u_sum"
    show_table(
        f"impedance: force over approach, {static if result.scales is None else 'small vibrations about rest'}",
        [
            *contact.rows(point),
            *_rows(result),
            ("grid", f"n = {result.n}", f"on {o.domain_text(result.domain)}"),
            ("computed in", f"{numeral(result.seconds, 3)} s", ""),
        ],
        json_to,
    )


def _rows(result: ImpedanceResult) -> list[tuple[str, str, str]]:
    if result.scales is None:
        triples = zip(result.Omega, result.stiffness, result.damping, strict=True)
        return [(f"Omega = {w:g}", f"K {k:.4f}", f"C {c:.5f}") for w, k, c in triples]
    si = result.si
    fours = zip(si.hz, result.Omega, si.stiffness, si.damping, strict=True)
    return [
        (f"{numeral(f)} Hz", f"K {numeral(1e-6 * k)} N/µm", f"C {numeral(c)} N s/m; Omega = {numeral(w)}")
        for f, w, k, c in fours
    ]
