"""Rows of tables on a terminal: quantities of results, from their declarations, in the units that people use."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import Any

import numpy as np

from ehlcontact.assumptions import Assumptions
from ehlcontact.assumptions.judge import judged
from ehlcontact.cli.numerals import numeral
from ehlcontact.point import MoesPoint
from ehlcontact.quantities import quantities_of, words
from ehlcontact.solver.domain import Domain

Row = tuple[str, str, str]  # quantity, value with its unit, remark
# Units of a table: size of one in SI units.
UNITS = {
    "m": ("µm", 1e-6),
    "Pa": ("GPa", 1e9),
    "N m": ("N mm", 1e-3),
    "N/m": ("N/µm", 1e6),
    "s": ("ms", 1e-3),
    "kg": ("g", 1e-3),
    "rad": ("°", pi / 180.0),
}
# What a dimensionless value is measured in.
SCALES = {
    "delta_H": "of the dry Hertz approach",
    "f0": "of the static load",
    "p_h": "of the Hertz pressure",
    "f0 a": "of load times semi-axis a",
    "f0/delta_H": "of load over dry approach",
    "f0/delta_H 2a/u_sum": "dimensionless: time in 2a/u_sum",
}


def in_unit(value: Any, unit: str, digits: int = 4) -> str:
    """A value in SI in the unit of tables; smallest to largest of an array."""
    shown, size = UNITS.get(unit, (unit, 1.0))
    ends = np.unique([np.min(value), np.max(value)]) / size
    return " ".join((" .. ".join(numeral(end, digits) for end in ends), shown)).rstrip()


def quantity_rows(result: Any, remarks: Mapping[str, str], error: Mapping[str, float] | None = None) -> list[Row]:
    """Rows of quantities of a result, at an `OperatingPoint` with the dimensionless value beside.

    Parameters
    ----------
    result : QuantityTable
    remarks : mapping
        By the name of a quantity, what else there is to say about it.
    error : mapping, optional
        Half widths of error bars, by the name of a quantity.
    """
    rows, s = [], result.point.scales
    for name, remark in remarks.items():
        quantity, value, bar = quantities_of(type(result))[name], getattr(result, name), (error or {}).get(name)
        kind = SCALES.get(quantity.moes, quantity.moes)
        if isinstance(result.point, MoesPoint):
            shown, beside = in_unit(value, "", 5), kind
            bars = "" if bar is None else f"± {numeral(bar, 1)}"
        else:
            shown = in_unit(value, quantity.unit, 5)
            beside = f"{in_unit(value / quantity.size(s), '', 4)} {kind}"
            bars = "" if bar is None else f"± {in_unit(bar, quantity.unit, 1)}"
        rows.append((words(name), shown, ", ".join(filter(None, (beside, bars, remark)))))
    return rows


def columns_over(result: Any, heads: Mapping[str, str], digits: int = 4) -> tuple[list[str], list[list[str]]]:
    """Heads and rows of quantities along their first dimension; values over further ones share a cell.

    Parameters
    ----------
    result : QuantityTable
        Quantities that it does not have are left out; those with error bars have them.
    heads : mapping
        Head of the column by the name of the quantity; words of its declaration where empty.
    digits : int
        Significant figures.
    """
    shown, columns = [], []
    bars = getattr(result, "error_bars", None) or {}
    for name, head in heads.items():
        if getattr(result, name) is None:
            continue
        values, (said, unit) = result.axis(name)
        unit, size = UNITS.get(unit, (SCALES.get(unit, unit), 1.0))
        rows = np.asarray(values).reshape(len(values), -1) / size
        cells = [", ".join(numeral(value, digits) for value in row) for row in rows.tolist()]
        if name in bars:
            cells = [f"{cell} ± {numeral(bar / size, 1)}" for cell, bar in zip(cells, bars[name], strict=True)]
        shown.append(f"{head or said}{f' [{unit}]' if unit else ''}")
        columns.append(cells)
    return shown, [list(row) for row in zip(*columns, strict=True)]


def summary_lines(result: Any) -> list[str]:
    """Lines of the summary of a library object, without the name of its class."""
    return [line.strip() for line in repr(result).partition(": ")[2].splitlines()]


def summary_rows(name: str, result: Any) -> list[Row]:
    """Those lines as rows, the first one with a name."""
    return [(name if k == 0 else "", "", line) for k, line in enumerate(summary_lines(result))]


def outside_rows(found: Assumptions) -> list[Row]:
    """A row for each assumption that does not hold."""
    return [(f"NOT {one.name}", "", one.verdict) for one in found.out_of_range]


def thinning_rows(result: Any) -> list[Row]:
    """Film that sliding leaves."""
    if result.thinned_share is None:
        return []
    return [("film by sliding", f"{result.thinned_share:.4g}", "of the Newtonian film")]


def heat_rows(result: Any) -> list[Row]:
    """Loss of film by heat, beside published formulas, and temperatures."""
    found = result.temperature
    if found is None:
        return []
    row = judged(result)["isothermal"]
    gupta, wilson = row.details["gupta"], row.details["wilson"]
    flooded = "" if result.supply is None else "; flooded"
    beside = f"of the isothermal film; {gupta:.3g} by Gupta et al., {wilson:.3g} by Wilson and Sheu{flooded}"
    return [
        ("film by heat", f"{found.film_share:.4g}", beside),
        (
            "warmest oil",
            f"{found.largest:.3g} K",
            f"mean over the film, above the inlet; Q = {found.thermal_load:.3g}",
        ),
        ("warmest surface", f"{found.surfaces.max():.3g} K", "above the inlet"),
        ("heat balance", f"{found.balance:.1e}", "over the heat made"),
    ]


def share_text(error: float) -> str:
    """Error bar of a film, a share of it, in per cent."""
    return f"± {numeral(100.0 * error, 2)} % of it"


def run_rows(result: Any) -> list[Row]:
    """Grid, region and time of a computation, and its status where the result has one."""
    status = getattr(result, "status", None)
    return [
        ("grid", f"n = {result.n}", f"on {domain_text(result.domain)}"),
        ("computed in", f"{numeral(result.seconds, 3)} s", ""),
        *([] if status is None else [("status", str(status), "")]),
    ]


def domain_text(domain: Domain) -> str:
    """The region in words."""
    return f"[{domain.x_in:g}, {domain.x_out:g}] x [-{domain.y_max:g}, {domain.y_max:g}] Hertz semi-axes"
