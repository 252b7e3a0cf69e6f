"""``ehlcontact element``: a contact element from the atlas, without a solve."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from ehlcontact.checks import require_choice
from ehlcontact.cli import options as o
from ehlcontact.cli.contact import Contact, ContactAnswer, Frequencies, Surfaces
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.rows import Row, in_unit, quantity_rows, summary_rows
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint

SHOWN = 0.05, 1.0, math.tau  # dimensionless frequencies of the atlas that the table shows


if TYPE_CHECKING:
    from reduced_models.atlas.answer import AtlasAnswer


class Kind(o.Options):
    """Which element, and from which atlas; a cubic is for one frequency."""

    model: Annotated[str, typer.Option("--model", help="wide, memory or cubic.")] = "wide"
    atlas: Annotated[
        Path | None, typer.Option("--atlas", metavar="FILE", help="An atlas; the library's own by default.")
    ] = None


@o.grouped
def element(
    contact: Contact, surfaces: Surfaces, kind: Kind, frequencies: Frequencies, out: o.ElementOutput
) -> None:
    """Take a contact element from the atlas, in SI for a bearing: any load, any frequency, or one of each."""
    from reduced_models.atlas.atlas import MODELS, Atlas

    require_choice("--model", kind.model, MODELS)
    point = contact.point()
    at: dict[str, Any] = {}
    if kind.model == "cubic" or frequencies.given:
        ((name, values),) = frequencies.named(contact).items()
        if len(values) > 1:
            raise InputError(f"--{name}", values, "given once: a damper without memory is for one frequency")
        at = {name: values[0]}
    surfaces.check(contact)
    out.check(kind.atlas)
    table = Atlas(kind.atlas)
    with contact.called():
        answer, made = table.at(point), table.element(point, kind.model, **at)
    if contact.description:
        made = replace(made, source={**(made.source or {}), "contact": contact.description})
    title = f"{kind.model} element from the atlas, version {table.metadata['version']}"
    rows = [*_answer(answer, contact.speed_rpm), *summary_rows("element", made)]
    ContactAnswer(contact, point, made, answer, surfaces, answer.h_min).deliver(out, title, rows, save=made)


def _answer(answer: AtlasAnswer, rpm: float | None) -> list[Row]:
    """Approach, films and tangent with error bars; C at some frequencies, in SI at that of the shaft first."""
    si, moes = isinstance(answer.point, OperatingPoint), answer.dimensionless

    def row(name: str, value: float, bar: float, unit: str, remark: str) -> Row:
        unit = unit if si else ""
        return name, in_unit(value, unit), f"± {in_unit(bar, unit, 1)}{remark}"

    rows = quantity_rows(
        answer, dict.fromkeys(("approach", "h_central", "h_min", "moment"), ""), answer.error_bars
    )
    remark = "" if si else ", dimensionless, as C: time in 2a/u_sum"
    rows.append(row("static tangent", answer.stiffness[0], answer.error_bars["stiffness"][0], "N/m", remark))
    if rpm is not None:
        shaft, own = answer.impedance(rpm=rpm), ", the shaft's own frequency"
        hz = f"C at {numeral(rpm / 60.0)} Hz"
        rows.append(row(hz, shaft.damping[0], shaft.error_bars["damping"][0], "N s/m", own))
    names = [f"{numeral(hz, 3)} Hz" for hz in answer.hz] if si else [""] * moes.omega.size
    every = zip(moes.omega, names, answer.damping, answer.error_bars["damping"], strict=True)
    for w, hz, c, bar in every:
        if np.isclose(w, SHOWN, rtol=1e-9, atol=0.0).any():
            omega = f"Ω = {numeral(w, 3)}"
            rows.append(row(f"C at {hz or omega}", c, bar, "N s/m", f", {omega}" if hz else ""))
    return rows
