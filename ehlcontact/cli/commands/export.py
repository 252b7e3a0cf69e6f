"""``ehlcontact export``: an element file to an FMU."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.output import (
    USAGE,
    check_apart,
    check_file,
    check_json,
    complain,
    deliver,
    show_table,
    write_json,
)
from ehlcontact.cli.progress import progress
from ehlcontact.errors import InputError

if TYPE_CHECKING:
    from fmu import Verification


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("export")(export)


def export(
    file: Annotated[Path, typer.Argument(metavar="ELEMENT.json", help="Element saved by `fit` or `element`.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="X.fmu", help="FMU to write.")],
    fmi: Annotated[int, typer.Option("--fmi", help="FMI version, 2 or 3.")] = 2,
    name: Annotated[str | None, typer.Option("--name", help="Model name.")] = None,
    platform: Annotated[
        list[str] | None,
        typer.Option(
            "--platform",
            metavar="NAME",
            help="Binary for x86_64-linux, x86_64-windows, x86_64-darwin, aarch64-darwin, in FMI 3 also"
            " aarch64-linux, or `all`; may be repeated. This machine's by default.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the FMU if there is one.")] = False,
    json_to: o.JsonTo = None,
) -> None:
    """Export a contact element as an FMU for co-simulation and model exchange, once it is verified."""
    if fmi not in (2, 3):
        raise InputError("--fmi", fmi, "2 or 3")
    if file.suffix.lower() == ".toml":
        raise InputError("file", str(file), "an element (.json); export of a bearing is not built yet")
    check_file("--output", output, (".fmu",))
    check_json(json_to)
    check_apart({"--output": output, "--json": json_to}, (file,))
    if not force and output.exists():
        raise InputError("--output", str(output), "a new file, or replaced with --force")
    from fmu import BuildError, VerificationError
    from fmu.binaries import choose
    from fmu.contacts import step_advice
    from fmu.export import export_verified
    from reduced_models import load_element

    element: Any = load_element(file)
    try:
        names = {"model_name": "--name", "platforms": "--platform", "path": "--output", "element": str(file)}
        with progress("compiling") as told, o.called(**names):
            built = [one.name for one in choose(platform or None, fmi)]
            _, found = export_verified(
                element,
                output,
                fmi=fmi,
                model_name=name,
                platforms=platform or None,
                overwrite=force,
                progress=told,
            )
    except (BuildError, VerificationError) as error:
        complain(f"no FMU was written: {error}")
        raise typer.Exit(USAGE) from None
    verdict = {"passes": None} if found is None else found.to_dict()
    document = {"fmu": str(output), "units": element.units, "platforms": built, **verdict}
    rows = [("element", element.kind, element.units), ("binaries", str(len(built)), ", ".join(built))]
    rows += step_advice(element)
    deliver(
        lambda: write_json(document, json_to),
        lambda: show_table(str(output), [*rows, *_rows(found)], json_to),
    )


def _rows(found: Verification | None) -> list[tuple[str, str, str]]:
    """What the verification found."""
    if found is None:
        return [("verified", "no", "this machine can run no such FMU")]
    return [
        ("findings", str(len(found.findings)), "of fmpy's validation; none is right"),
        ("force", f"{found.force:.1e}", f"largest error, over the Python element's; {found.states} states"),
        ("tangents", f"{found.tangents:.1e}", "likewise"),
        ("verified", "yes", ""),
    ]
