"""``ehlcontact impedance``: stiffness and damping over frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.contact import Contact, frequency
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.progress import progress
from ehlcontact.cli.rows import Row, in_unit, run_rows
from ehlcontact.errors import InputError

if TYPE_CHECKING:
    from ehlcontact.results import ImpedanceResult


class Frequencies(o.Options):
    """Frequencies of the small vibrations."""

    Omega: Annotated[
        list[float] | None,
        typer.Option(
            "--Omega",
            "--omega",
            help="Dimensionless angular frequency (unit of time 2a/u_sum), >= 0; give it once per frequency. "
            "Both names mean the same: neither is in rad/s.",
        ),
    ] = None
    hz: Annotated[
        list[float] | None,
        typer.Option(
            "--hz",
            show_default="that of the shaft",
            help="Frequency of a bearing's contact, Hz; give it once per frequency.",
        ),
    ] = None


@o.grouped
def impedance(contact: Contact, grid: o.Grid, frequencies: Frequencies, out: o.Output) -> None:
    """Linearise the steady film: stiffness K and damping C over frequency."""
    from ehlcontact.impedance import impedance as solve

    point, chosen = contact.solvable(), grid.chosen()
    at = frequency(contact, frequencies.Omega or None, frequencies.hz or None)
    if at is None:
        raise InputError("--Omega", None, "given: a dimensionless angular frequency (unit of time 2a/u_sum), >= 0")
    out.check()
    with progress("linearised contact"):
        result = solve(point, **at, **chosen)
    static = "static load 1, dry approach 1, time unit 2a/u_sum"
    table = (
        f"impedance: force over approach, {static if result.scales is None else 'small vibrations about rest'}",
        [
            *contact.rows(point),
            *_rows(result),
            *run_rows(result),
        ],
    )
    out.deliver({**result.to_dict(), **contact.about(point)}, table)


def _rows(result: ImpedanceResult) -> list[Row]:
    if result.scales is None:
        triples = zip(result.Omega, result.stiffness, result.damping, strict=True)
        return [(f"Omega = {w:g}", f"K {k:.4f}", f"C {c:.5f}") for w, k, c in triples]
    si = result.si
    fours = zip(si.hz, result.Omega, si.stiffness, si.damping, strict=True)
    return [
        (f"{numeral(f)} Hz", f"K {in_unit(k, 'N/m')}", f"C {in_unit(c, 'N s/m')}; Omega = {numeral(w)}")
        for f, w, k, c in fours
    ]
