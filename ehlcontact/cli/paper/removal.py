"""Table 2: what one coefficient of the seven-term polynomial is worth."""

from __future__ import annotations

from collections.abc import Mapping

from ehlcontact.cli.paper.data import paper_sensitivity
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import FREE
from ehlcontact.cli.paper.table import Cell, Table


def sensitivity_table(fits: Fits) -> Table:
    """The paper's errors and ours of every case, for each coefficient left out."""
    columns: tuple[str, ...] = ("removed", "paper e_f", "paper e_acc")
    found = {case: fits.sensitivity(case) for case in FREE}
    kept = {case: table for case, table in found.items() if table is not None}
    for case in kept:
        columns += tuple(f"case {case}: {name}" for name in ("rms", "e_f", "e_acc", "BIC", "rms struck out"))
    rows: list[tuple[Cell, ...]] = []
    sums: dict[str, dict[str, float]] = {name: {} for name in ("paper", *(f"case {case}" for case in kept))}
    for k, (removed, errors) in enumerate(paper_sensitivity().items()):
        row: list[Cell] = ["none" if removed is None else removed, *errors]
        if removed is not None:
            sums["paper"][removed] = errors[0]
        for case, table in kept.items():
            ours = table.rows[k]
            assert ours.removed == removed
            if removed is not None:
                sums[f"case {case}"][removed] = ours.e_f
            row += [
                ours.rms,
                -ours.e_f,
                None if ours.e_acc is None else -ours.e_acc,
                ours.bic,
                ours.rms_without_refit,
            ]
        rows.append(tuple(row))
    title = "Residuals when one coefficient is left out of the seven-term polynomial"
    by_rms = [f"case {case}: {', '.join(table.ranking)}" for case, table in kept.items()]
    notes = [
        f"Most harmful removal first. By rms: {'; '.join(by_rms)}. By the size of e_f: {_ranked(sums)}.",
        *(f"Case {case}: {table.warning}." for case, table in kept.items() if table.warning),
        "As in the paper the other six are fitted again, while 'struck out' leaves them as they were. rms is of "
        "the force, over its standard deviation; BIC the change from the full model, negative where the term is "
        "not worth keeping; e_f and e_acc are fitted less simulated, eq. 13 with the other sign. The paper does "
        "not name its case.",
        "e_f and e_acc are signed sums, near zero by construction whatever the fit, so rms judges. What acts of "
        "two dampers is (C1 + B4 u) u': either can stand in for a part of the other, but only B4 lets the damping "
        "grow with the approach.",
    ]
    return Table(2, title, columns, tuple(rows), tuple(notes))


def _ranked(sums: Mapping[str, Mapping[str, float]]) -> str:
    return "; ".join(
        f"{whose}: {', '.join(sorted(found, key=lambda name: -abs(found[name])))}" for whose, found in sums.items()
    )
