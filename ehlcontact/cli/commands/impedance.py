"""``ehlcontact impedance``: stiffness and damping over frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ehlcontact.cli import options as o
from ehlcontact.cli.contact import Contact, Frequencies
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.progress import progress
from ehlcontact.cli.rows import Row, in_unit, outside_rows, run_rows

if TYPE_CHECKING:
    from ehlcontact.results import ImpedanceResult


@o.grouped
def impedance(contact: Contact, grid: o.Grid, frequencies: Frequencies, out: o.Output) -> None:
    """Linearise the steady film: stiffness K and damping C over frequency."""
    from ehlcontact.impedance import impedance as solve

    point, chosen = contact.solvable(), grid.chosen()
    at = frequencies.named(contact)
    out.check()
    with progress("linearised contact"):
        result = solve(point, **at, **chosen)
    found = contact.judged(point, result)
    static = "static load 1, dry approach 1, time unit 2a/u_sum"
    table = (
        f"impedance: force over approach, {static if result.scales is None else 'small vibrations about rest'}",
        [
            *contact.rows(point),
            *outside_rows(found),
            *_rows(result),
            *run_rows(result),
        ],
    )
    out.deliver({**result.to_dict(), **contact.about(point), "outside_assumptions": found.headline}, table)


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
