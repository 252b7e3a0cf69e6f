"""``ehlcontact element``: a contact element from the atlas, without a solve."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from ehlcontact.checks import require_choice
from ehlcontact.cli import options as o
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import check_apart, check_file, check_json, deliver, show_table, write_json, write_to
from ehlcontact.errors import InputError
from reduced_models.elements.validity import MARGIN, frequency_text, text_of


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("element")(element)


@o.grouped
def element(
    contact: o.Contact,
    model: Annotated[str, typer.Option("--model", help="wide, memory or cubic.")] = "wide",
    Omega: Annotated[
        float | None,
        typer.Option(
            "--Omega",
            "--omega",
            help="Of a cubic, which has to be told: the dimensionless angular frequency (unit of time 2a/u_sum) "
            "that its damper is for. Both names mean the same: this command knows dimensionless points only.",
        ),
    ] = None,
    atlas: Annotated[
        Path | None,
        typer.Option("--atlas", metavar="FILE", help="An atlas; the library's own by default."),
    ] = None,
    save: Annotated[Path | None, typer.Option("--save", metavar="FILE", help="Save the element as JSON.")] = None,
    json_to: o.JsonTo = None,
) -> None:
    """Take a contact element from the atlas: any load, any frequency, or one of each."""
    from reduced_models.atlas.atlas import MODELS, Atlas

    require_choice("--model", model, MODELS)
    if model == "cubic" and Omega is None:
        raise InputError("--Omega", None, "given with --model cubic: a damper without memory is for one frequency")
    point = contact.point()
    check_file("--save", save, (".json",))
    check_json(json_to)
    check_apart({"--save": save, "--json": json_to}, (atlas,))
    table = Atlas(atlas)
    answer, made = table.at(point), table.element(point, model, Omega=Omega)
    error = answer.error
    at = [
        (f"C at Ω = {numeral(w, 3)}", f"{c:.5f}", f"± {numeral(bar, 1)}")
        for w, c, bar in zip(answer.Omega, answer.damping, error["damping"], strict=True)
        if w in (0.05, 1.0) or abs(w - 6.2832) < 1e-3
    ]
    shown = partial(
        show_table,
        f"{model} element from the atlas, version {table.metadata['version']}",
        [
            *o.point_rows(point),
            ("approach", f"{answer.approach:.5f}", f"± {numeral(error['approach'], 1)} of the dry Hertz approach"),
            ("central film", f"{answer.h_central:.5f}", f"± {numeral(error['h_central'], 1)} likewise"),
            ("minimum film", f"{answer.h_min:.5f}", f"± {numeral(error['h_min'], 1)} likewise"),
            ("moment of pressure", f"{answer.moment:.5f}", f"± {numeral(error['moment'], 1)} of load times a"),
            (
                "static tangent",
                f"{answer.stiffness[0]:.4f}",
                f"± {numeral(error['stiffness'][0], 1)} dimensionless, as C: time in 2a/u_sum",
            ),
            *at,
            *_damper(made),
            (
                "valid approach",
                f"{made.low:.4f} .. {made.high:.4f}",
                "" if made.load_range is None else f"load {text_of(made.load_range)}",
            ),
        ],
        json_to,
    )
    kept = partial(write_to, "--save", save, made.save)
    deliver(kept, lambda: write_json(made.to_dict(), json_to), shown)


def _damper(made: Any) -> list[tuple[str, str, str]]:
    """The one damping of a cubic, and the band it is for."""
    if not hasattr(made, "C1"):
        return []
    return [
        ("damper C1", f"{made.C1:.5f}", f"within {MARGIN:.0%} for {frequency_text(made.omega_range, made.units)}")
    ]
