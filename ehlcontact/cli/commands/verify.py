"""``ehlcontact verify``: an FMU against the reference results inside it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.output import FAILED, complain
from ehlcontact.cli.rows import Row, summary_lines

if TYPE_CHECKING:
    from fmu.references.check import ReferenceCheck


@o.grouped
def verify(
    file: Annotated[Path, typer.Argument(metavar="X.fmu", help="FMU written by `export` or `run`.")],
    out: o.Output,
) -> None:
    """Check an FMU against the reference results inside it; no element is needed. Runs its native code.

    That code runs with your rights, in a child process with limits of time and memory (not on Windows): verify
    what you would run.

    Exit code 1 if it differs from them, or fmpy finds something in it; 2 if it cannot be read or has none.
    """
    out.check(file)
    from fmu import verify_references

    with o.called(path="file"):
        found = verify_references(file)
    out.deliver({"fmu": str(file), **found.to_dict()}, (str(file), _rows(found)))
    for finding in found.findings:
        complain(f"{file}: {finding}")
    for one in found.interfaces:
        if not one.difference <= found.tolerance:
            place = f"{one.variable} at {'time' if one.name == 'co-simulation' else 'row'} {one.time:g}"
            complain(f"{file}: {one.name} differs from its reference results, {place}: by {one.difference:.2e}")
    if not found.passes:
        raise typer.Exit(FAILED)


def _rows(found: ReferenceCheck) -> list[Row]:
    """What was compared, and how large the differences are."""
    _, *lines = summary_lines(found)
    compared = [(name, "", text) for name, _, text in (line.partition(": ") for line in lines)]
    tolerance = "tolerance", f"{found.tolerance:.0e}", "of the differences"
    return [("FMI", found.fmi, ""), *compared, tolerance, ("verified", "yes" if found.passes else "no", "")]
