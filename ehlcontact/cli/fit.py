"""``ehlcontact fit``: simulated histories to a contact element."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.output import check_file, check_json, show_table, write_json
from ehlcontact.errors import InputError, require_choice

PLANNED = ("memory",)


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("fit")(fit)


def fit(
    files: Annotated[list[Path], typer.Argument(metavar="R.h5...", help="Results of `ehlcontact simulate`.")],
    model: Annotated[str, typer.Option("--model", help="linear, cubic, polynomial or power.")] = "cubic",
    window: Annotated[
        tuple[float, float] | None,
        typer.Option("--window", metavar="START END", help="Part of T to fit; the last two thirds by default."),
    ] = None,
    save: Annotated[Path | None, typer.Option("--save", metavar="FILE", help="Save the element as JSON.")] = None,
    json_to: o.JsonTo = None,
) -> None:
    """Fit a contact element to one or several simulations of the same contact."""
    from ehlcontact.results import SimulationResult
    from ehlcontact.storage import load
    from reduced_models import ContactRecord
    from reduced_models import fit as least_squares
    from reduced_models.estimators import ESTIMATORS

    if model in PLANNED and model not in ESTIMATORS:
        raise InputError("--model", model, f"one of {', '.join(ESTIMATORS)}; this one is not built yet")
    require_choice("--model", model, tuple(ESTIMATORS))
    check_file("--save", save, (".json",))
    check_json(json_to)
    records = []
    for file in files:
        result = load(file)
        if not isinstance(result, SimulationResult):
            raise InputError("file", str(file), "a simulation; this is a steady film")
        try:
            records.append(ContactRecord.from_result(result))
        except InputError as error:
            raise InputError(f"{file}: {error.field}", error.value, error.allowed) from None
    fitted = least_squares(records, model, window)
    if save is not None:
        fitted.element.save(save)
    write_json(fitted.to_dict(), json_to)
    valid = fitted.valid
    rows = [
        (name, f"{value:.5g}", f"{fitted.intervals[name][0]:.4g} .. {fitted.intervals[name][1]:.4g} (95 %)")
        for name, value in fitted.parameters.items()
    ]
    rows += [
        ("rms error", f"{100 * fitted.rms:.2f} %", "of the standard deviation of the force"),
        ("e_f (eq. 13)", f"{fitted.e_f:.1e}", ""),
        ("root", "-" if fitted.root is None else f"{fitted.root:.5f}", "approach under the static load"),
        ("tangent", "-" if fitted.tangent is None else f"{fitted.tangent:.4f}", "stiffness there"),
        ("valid", f"{valid['low']:.4f} .. {valid['high']:.4f}", f"|rate| <= {valid['rate']:.3g}"),
        (
            "condition",
            f"{fitted.condition:.3g}",
            f"{fitted.samples} samples, {fitted.independent_samples:.0f} of them independent",
        ),
    ]
    show_table(f"{model} element", rows, json_to)
