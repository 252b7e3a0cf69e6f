"""``ehlcontact fit``: simulated histories to a contact element."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ehlcontact.checks import require_choice
from ehlcontact.cli import options as o
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.rows import Row, summary_rows
from ehlcontact.errors import InputError

if TYPE_CHECKING:
    from reduced_models.fitting.result import ElementFit, FitResult


@o.grouped
def fit(
    out: o.ElementOutput,
    files: Annotated[list[Path], typer.Argument(metavar="R.h5...", help="Results of `ehlcontact simulate`.")],
    model: Annotated[str, typer.Option("--model", help="linear, cubic, polynomial, power or memory.")] = "cubic",
    window: Annotated[
        tuple[float, float] | None,
        typer.Option(
            "--window",
            metavar="START END",
            help="Part of t to fit, in its unit; by default the last two thirds, of a ramp all.",
        ),
    ] = None,
) -> None:
    """Fit a contact element to one or several simulations of the same contact, in their units."""
    from ehlcontact.store import read
    from ehlcontact.transient.result import SimulationResult
    from reduced_models import ContactRecord
    from reduced_models import fit as fit_records
    from reduced_models.fitting.fit import MEMORY, MODELS
    from reduced_models.fitting.records import repeated
    from reduced_models.fitting.result import FitResult

    require_choice("--model", model, MODELS)
    if model == MEMORY and window is not None:
        raise InputError("--window", window, "left out with --model memory, which takes whole records")
    out.check(*files)
    records = []
    for file in files:
        result = read(file, SimulationResult)
        try:
            records.append(ContactRecord.from_result(result))
        except InputError as error:
            raise InputError(f"{file}: {error.field}", error.value, error.allowed) from None
    again = repeated(records)
    if again is not None:
        first, second = (str(files[k]) for k in again)
        raise InputError("file", second, f"given once: it holds the record of {first}")
    with o.called(window="--window", start="--window START"):
        try:
            fitted = fit_records(records, model, window)
        except InputError as error:
            name, allowed = (_with_files(text, files) for text in (error.field, error.allowed))
            raise InputError(name, error.value, allowed) from None
    element = fitted.element
    rows = _coefficients(fitted) if isinstance(fitted, FitResult) else _memory(fitted)
    valid, units = fitted.valid, "N, m, s" if element.units == "SI" else "static loads, dry approaches, 2a/u_sum"
    table = (
        f"{model} element, {element.units}: {units}",
        [
            *rows,
            ("root", numeral(fitted.root, 5), "approach under the static load"),
            ("tangent", numeral(fitted.tangent, 5), "stiffness there"),
            ("rms error", f"{100 * (fitted.rms or 0.0):.2f} %", "of the standard deviation of the force"),
            (
                "e_f (eq. 13)",
                f"{fitted.e_f:.1e}",
                "sum of force less fit over sum of force: near zero by construction",
            ),
            (
                "valid approach",
                f"{numeral(valid['low'])} .. {numeral(valid['high'])}",
                f"|rate| <= {numeral(valid['rate'], 3)}",
            ),
        ],
    )
    out.deliver(fitted.to_dict(), table, save=element)


def _with_files(text: str, files: list[Path]) -> str:
    """The text with names of files where the library numbers its records."""
    return re.sub(r"records\[(\d+)\]", lambda found: str(files[int(found[1])]), text)


def _coefficients(fitted: FitResult) -> list[Row]:
    rows = [
        (name, numeral(value, 5), "{} .. {} (95 %)".format(*map(numeral, fitted.intervals[name])))
        for name, value in fitted.parameters.items()
    ]
    worth = f"{fitted.samples} samples, {fitted.independent_samples:.0f} of them independent"
    return [*rows, ("condition", numeral(fitted.condition, 3), f"number; {worth}")]


def _memory(fitted: ElementFit) -> list[Row]:
    from reduced_models.elements.validity import frequency_text

    found, units = fitted.to_dict(), fitted.element.units
    of = f"largest error of K and of C beside the impedance, for {frequency_text(fitted.valid['omega'], units)}"
    errors = (f"{100.0 * found[f'{name}_error_max']:.2g} %" for name in ("stiffness", "damping"))
    return [*summary_rows("element", fitted.element), ("K(Ω), C(Ω)", ", ".join(errors), of)]
