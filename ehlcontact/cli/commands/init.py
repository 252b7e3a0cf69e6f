"""``ehlcontact init``: a commented study file to begin with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from ehlcontact.checks import require_finite, require_positive
from ehlcontact.cli import options as o
from ehlcontact.cli.contact import MEANING, known_bearings
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.oils import OIL_HELP, TEMP_HELP, oil_grade
from ehlcontact.cli.output import check_apart, check_file, check_json, deliver, say, write_json
from ehlcontact.errors import InputError
from ehlcontact.files import write_text

SEVERAL = "given several times, the study runs at all of them"
RPM, LOAD = [3000.0], [100.0]  # of a study that nobody asked more of


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("init")(init)


def init(
    file: Annotated[Path, typer.Argument(metavar="[FILE.toml]", help="Study file to write.")] = Path("study.toml"),
    bearing: Annotated[
        str,
        typer.Option("--bearing", metavar="NAME", help=f"{MEANING['--bearing']}.", autocompletion=known_bearings),
    ] = "6205",
    oil: Annotated[str, typer.Option("--oil", metavar="GRADE", help=OIL_HELP)] = "ISO VG 68",
    temp: Annotated[float, typer.Option("--temp", "--temperature", help=TEMP_HELP)] = 50.0,
    rpm: Annotated[list[float], typer.Option("--rpm", help=f"{MEANING['--rpm']}; {SEVERAL}.")] = RPM,
    load: Annotated[list[float], typer.Option("--load", help=f"{MEANING['--load']}; {SEVERAL}.")] = LOAD,
    force: Annotated[bool, typer.Option("--force", help="Replace the file if there is one.")] = False,
    json_to: o.JsonTo = None,
) -> None:
    """Write a study to begin with: every entry explained, defaults as comments, for `validate` and `run`."""
    from ehlcontact.cli.starter.text import Wish, study_text

    check_file("FILE.toml", file, (".toml",))
    check_json(json_to)
    check_apart({"FILE.toml": file, "--json": json_to})
    if not force and file.exists():
        raise InputError("FILE.toml", str(file), "a new file, or replaced with --force")
    for option, values in (("--rpm", rpm), ("--load", load)):
        for value in values:
            require_positive(option, value)
    require_finite("--temp", temp)
    grade = oil_grade(oil, "--oil")
    wish = Wish(bearing=bearing.strip().upper(), grade=grade, temperature=temp, rpm=tuple(rpm), load=tuple(load))
    text = study_text(wish, file.name)
    write_text(file, text, "FILE.toml")
    oil, at = f"ISO VG {grade}", f"{numeral(temp)} °C, {_listed(load)} N at {_listed(rpm)} rpm"
    about = {"bearing": wish.bearing, "oil": oil, "temperature": temp}
    deliver(
        lambda: write_json({"study": str(file), **about, **_numbers(rpm, load)}, json_to),
        lambda: say(
            f"{file}: {wish.bearing} in {oil} at {at}\n"
            f"what it will do:  ehlcontact validate {file}\ndo it:            ehlcontact run {file}",
            json_to,
        ),
    )


def _listed(values: Sequence[float]) -> str:
    return ", ".join(map(numeral, values))


def _numbers(rpm: list[float], load: list[float]) -> dict[str, float | list[float]]:
    """For JSON: a number where there is one, as in the file."""
    given = {"speed_rpm": rpm, "radial_load": load}
    return {name: values[0] if len(values) == 1 else values for name, values in given.items()}
