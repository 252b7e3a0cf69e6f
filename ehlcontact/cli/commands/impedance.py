"""``ehlcontact impedance``: stiffness and damping over frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ehlcontact.cli import options as o
from ehlcontact.cli.contact import Contact, Frequencies, Heating, Supply
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import complain
from ehlcontact.cli.progress import progress
from ehlcontact.cli.rows import Row, heat_rows, in_unit, outside_rows, run_rows

if TYPE_CHECKING:
    from ehlcontact.results import ImpedanceResult


@o.grouped
def impedance(
    contact: Contact, supply: Supply, heating: Heating, grid: o.Grid, frequencies: Frequencies, out: o.Output
) -> None:
    """Linearise the steady film: stiffness K and damping C over frequency."""
    from ehlcontact.impedance import impedance as solve

    chosen = grid.chosen() | {"supply": supply.chosen(contact), "thermal": heating.chosen(contact)}
    point = contact.solvable()
    at = frequencies.named(contact)
    out.check()
    with progress("linearised contact"):
        result = solve(point, **at, **chosen)
    found = contact.judged(point, result)
    static = "static load 1, dry approach 1, time unit 2a/u_sum"
    table = (
        f"impedance: force over approach, {static if result.scales is None else 'small vibrations about rest'}",
        [*contact.rows(point), *outside_rows(found), *_rows(result), *heat_rows(result), *run_rows(result)],
    )
    out.deliver({**result.to_dict(), **contact.about(point), "outside_assumptions": found.headline}, table)
    if result.reservation:
        complain(f"warning: {result.reservation}")


def _rows(result: ImpedanceResult) -> list[Row]:
    view = result if result.scales is None else result.si
    bars = view.error_bars or {}
    found = zip(result.Omega, view.stiffness, view.damping, bars["stiffness"], bars["damping"], strict=True)
    if result.scales is None:
        return [
            (f"Omega = {w:g}", f"K {k:.4f} ± {numeral(dk, 1)}", f"C {c:.5f} ± {numeral(dc, 1)}")
            for w, k, c, dk, dc in found
        ]
    return [
        (
            f"{numeral(hz)} Hz",
            f"K {_with_bar(k, dk, 'N/m')}",
            f"C {_with_bar(c, dc, 'N s/m')}; Omega = {numeral(w)}",
        )
        for hz, (w, k, c, dk, dc) in zip(result.si.hz, found, strict=True)
    ]


def _with_bar(value: float, bar: float, unit: str) -> str:
    return f"{in_unit(value, unit).split()[0]} ± {in_unit(bar, unit, 1)}"
