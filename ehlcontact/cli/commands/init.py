"""``ehlcontact init``: a commented study file to begin with."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from pydantic import Field

from ehlcontact.cli import entries as e
from ehlcontact.cli import options as o
from ehlcontact.cli.contact import OIL_NAME, known_bearings
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import check_new, say
from ehlcontact.cli.study.schema import oil_grade
from ehlcontact.files import write_text

SEVERAL = "given several times, the study runs at all of them"


class Wish(o.Options):
    """What the study is about; in place of these options stand entries of the file afterwards."""

    bearing: Annotated[e.Catalogue, typer.Option("--bearing", metavar="NAME", autocompletion=known_bearings)] = (
        "6205"
    )
    oil: Annotated[str, OIL_NAME] = "ISO VG 68"
    temp: Annotated[e.Temperature, typer.Option("--temp")] = 50.0
    speed_rpm: Annotated[
        list[e.Speed], typer.Option("--speed-rpm"), e.meaning(f"speed of the shaft; {SEVERAL}")
    ] = Field([3000.0])
    load: Annotated[list[e.Load], typer.Option("--load"), e.meaning(f"radial load on the bearing; {SEVERAL}")] = (
        Field([100.0])
    )
    axial: Annotated[
        e.Load | None, typer.Option("--axial"), e.meaning("axial load; an angular contact bearing needs one")
    ] = None
    layer: Annotated[e.OilThickness | None, typer.Option("--layer")] = None
    layer_ratio: Annotated[e.BearingLayerRatio | None, typer.Option("--layer-ratio")] = None
    thermal: Annotated[
        bool, typer.Option("--thermal", help="Films of the whole bearing with heat, beside isothermal ones.")
    ] = False


@o.grouped
def init(
    wish: Wish,
    out: o.Output,
    file: Annotated[Path, typer.Argument(metavar="[FILE.toml]", help="Study file to write.")] = Path("study.toml"),
    force: Annotated[bool, typer.Option("--force", help="Replace the file if there is one.")] = False,
) -> None:
    """Write a study to begin with: every entry explained, defaults as comments, for `validate` and `run`."""
    from ehlcontact.cli.starter import OPTIONS, study_text

    out.check(beside={"FILE.toml": (file, (".toml",))})
    check_new("FILE.toml", file, force)
    bearing, grade = wish.bearing.strip().upper(), oil_grade(wish.oil, "--oil")
    given = wish.by_option() | {"--bearing": bearing, "--oil": grade}
    given |= {"--load": _one_or_all(wish.load), "--speed-rpm": _one_or_all(wish.speed_rpm)}
    entries = {entry: given[option] for entry, option in OPTIONS.items() if given.get(option)}
    text = study_text({"title": f"study of a {bearing}", **entries}, file.name)
    write_text(file, text, "FILE.toml")
    oil = f"ISO VG {grade}"
    loads, speeds = (", ".join(map(numeral, values)) for values in (wish.load, wish.speed_rpm))
    about = {"bearing": bearing, "oil": oil, "temperature": wish.temp}
    numbers = {name: entries[f"bearing.{name}"] for name in ("speed_rpm", "radial_load")}
    told = partial(
        say,
        f"{file}: {bearing} in {oil} at {numeral(wish.temp)} °C, {loads} N at {speeds} rpm\n"
        f"what it will do:  ehlcontact validate {file}\ndo it:            ehlcontact run {file}",
        out.json_to,
    )
    out.deliver({"study": str(file), **about, **numbers}, told)


def _one_or_all(values: list[float]) -> float | list[float]:
    """As the file has it: a list where there are several."""
    return float(values[0]) if len(values) == 1 else [float(value) for value in values]
