"""``ehlcontact impedance``: stiffness and damping over frequency."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ehlcontact.cli import options as o
from ehlcontact.cli.contact import Contact, ContactAnswer, FilmConditions, Frequencies
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.progress import progress
from ehlcontact.cli.rows import Row, heat_rows, in_unit, run_rows, thinning_rows
from ehlcontact.point import OperatingPoint

if TYPE_CHECKING:
    from ehlcontact.results import Response


@o.grouped
def impedance(
    contact: Contact,
    conditions: FilmConditions,
    grid: o.Grid,
    frequencies: Frequencies,
    out: o.Output,
) -> None:
    """Linearise the steady film: stiffness K and damping C over frequency."""
    from ehlcontact.response import impedance as solve

    chosen = grid.chosen() | conditions.chosen(contact)
    point = contact.solvable()
    at = frequencies.named(contact)
    out.check()
    with progress("linearised contact"):
        result = solve(point, **at, **chosen)
    film = result.film
    assert film is not None
    si = isinstance(point, OperatingPoint)
    scale = "small vibrations about rest" if si else "static load 1, dry approach 1, time unit 2a/u_sum"
    run = run_rows(replace(film, seconds=result.seconds))
    rows = [*_rows(result, si), *thinning_rows(film), *heat_rows(film), *run]
    title = f"impedance: force over approach, {scale}"
    ContactAnswer(contact, point, result, film).deliver(out, title, rows)


def _rows(result: Response, si: bool) -> list[Row]:
    bars = result.error_bars
    numbers = result.stiffness, result.damping, bars["stiffness"], bars["damping"]
    found = zip(result.dimensionless.omega, *numbers, strict=True)
    if not si:
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
        for hz, (w, k, c, dk, dc) in zip(result.hz, found, strict=True)
    ]


def _with_bar(value: float, bar: float, unit: str) -> str:
    return f"{in_unit(value, unit).split()[0]} ± {in_unit(bar, unit, 1)}"
