"""``ehlcontact export``: an element file to an FMU."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.output import FAILED, check_apart, check_file, check_json, complain, show_table, write_json
from ehlcontact.errors import InputError


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("export")(export)


def export(
    file: Annotated[Path, typer.Argument(metavar="ELEMENT.json", help="Element saved by `fit` or `element`.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="X.fmu", help="FMU to write.")],
    fmi: Annotated[int, typer.Option("--fmi", help="FMI version; 2 is built.")] = 2,
    name: Annotated[str | None, typer.Option("--name", help="Model name.")] = None,
    json_to: o.JsonTo = None,
) -> None:
    """Export a contact element as an FMU for co-simulation and verify it."""
    if fmi == 3:
        raise InputError("--fmi", fmi, "2; FMI 3 is not built yet")
    if fmi != 2:
        raise InputError("--fmi", fmi, "2")
    if file.suffix.lower() == ".toml":
        raise InputError("file", str(file), "an element (.json); export of a bearing is not built yet")
    check_file("--output", output, (".fmu",))
    check_json(json_to)
    check_apart({"--output": output, "--json": json_to}, (file,))
    from fmu import BuildError, export_contact, verify
    from reduced_models import CubicContact, LinearContact, load_element

    element: Any = load_element(file)
    if not isinstance(element, LinearContact | CubicContact):
        kinds = f"{LinearContact.kind} or {CubicContact.kind}; FMUs of other kinds are not built yet"
        raise InputError(str(file), f"kind {element.kind!r}", kinds)
    try:
        with o.called(model_name="--name"):
            export_contact(element, output, fmi=fmi, model_name=name)
    except BuildError as error:
        complain(f"the FMU could not be compiled: {error}")
        raise typer.Exit(FAILED) from None
    found = verify(output, element)
    write_json({"fmu": str(output), "units": element.units, **found.to_dict()}, json_to)
    show_table(
        str(output),
        [
            ("element", element.kind, element.units),
            ("findings", str(len(found.findings)), "of fmpy's validation; none is right"),
            ("force", f"{found.force:.1e}", f"largest error, over the Python element's; {found.states} states"),
            ("tangents", f"{found.tangents:.1e}", "likewise"),
            ("verified", "yes" if found.passes else "NO", ""),
        ],
        json_to,
    )
    if not found.passes:
        complain(f"{output}: the FMU differs from the element: {'; '.join(found.findings) or found}")
        raise typer.Exit(FAILED)
