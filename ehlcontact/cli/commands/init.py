"""``ehlcontact init``: a commented study file to begin with."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer
from pydantic import Field

from ehlcontact.cli import entries as e
from ehlcontact.cli import options as o
from ehlcontact.cli.contact import OIL_NAME, known_bearings
from ehlcontact.cli.entries import entries_of
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import check_new, say
from ehlcontact.cli.study.bearing import NOT_OF_A_BEARING
from ehlcontact.cli.study.schema import Study
from ehlcontact.errors import InputError
from ehlcontact.files import write_text

SEVERAL = "given several times, the study runs at all of them"
MOST_BEARINGS = 2
LOAD = 100.0  # N, on a bearing alone
PANELS = {
    "operation": "Load, speed, oil supply and heat",
    "support": "Bearing and pair",
    "oil": "Oil",
    "surface": "Roughness",
    "shaft": "Machine: two bearings under a shaft",
    "disc": "Machine: a disc in the middle of both bearings",
}
ENTRIES = entries_of(
    Study, PANELS, (*NOT_OF_A_BEARING, *(f"disc.{name}" for name in ("position_mm", "radial_load", "axial_load")))
)
_operation, _machine = (partial(typer.Option, rich_help_panel=PANELS[name]) for name in ("operation", "shaft"))


@o.with_entries(ENTRIES, PANELS)
class Wish(o.Options):
    """What the study is about; in place of these options stand entries of the file afterwards."""

    bearing: Annotated[
        list[e.Catalogue],
        typer.Option(
            "--bearing", metavar="NAME", autocompletion=known_bearings, rich_help_panel=PANELS["support"]
        ),
        e.meaning("name of a ball bearing in the catalogue, as 6205; two of them, left and right, are a machine"),
    ] = Field(["6205"])
    oil: Annotated[str, OIL_NAME] = "ISO VG 68"
    temp: Annotated[e.Temperature, typer.Option("--temp", rich_help_panel=PANELS["oil"])] = 50.0
    speed_rpm: Annotated[list[e.Speed], _operation("--speed-rpm"), e.meaning(f"speed of the shaft; {SEVERAL}")] = (
        Field([3000.0])
    )
    load: Annotated[
        list[e.Load] | None,
        _operation("--load", show_default="100 on a bearing, none on a machine"),
        e.meaning(f"radial load on the bearing; {SEVERAL}; of a machine on its disc, beside the weight"),
    ] = None
    preload: Annotated[
        e.Preload | None,
        typer.Option("--preload", rich_help_panel=PANELS["support"]),
        e.meaning("of the pair, or of a spring on the second bearing"),
    ] = None
    span: Annotated[e.Distance | None, _machine("--span"), e.meaning("distance of both bearings")] = None
    positions: Annotated[
        tuple[float, float] | None,
        _machine(
            "--positions", metavar="LEFT RIGHT", help="Of both from the left end of the shaft, mm; or --span."
        ),
    ] = None
    shaft_length: Annotated[
        e.Length | None, _machine("--shaft-length", show_default="1.2 spans"), e.meaning("length of the shaft")
    ] = None
    shaft_diameter: Annotated[
        e.Diameter | None,
        _machine("--shaft-diameter", show_default="the larger bore"),
        e.meaning("diameter of the shaft"),
    ] = None
    contact: Annotated[
        bool, _machine("--contact", help="The full film of the most loaded ball too, as of a bearing alone.")
    ] = False


@o.grouped
def init(
    wish: Wish,
    out: o.Output,
    file: Annotated[Path, typer.Argument(metavar="[FILE.toml]", help="Study file to write.")] = Path("study.toml"),
    force: Annotated[bool, typer.Option("--force", help="Replace the file if there is one.")] = False,
) -> None:
    """Write a study to begin with: every entry explained, defaults as comments, for `validate` and `run`."""
    from ehlcontact.cli.starter import study_text

    out.check(beside={"FILE.toml": (file, (".toml",))})
    check_new("FILE.toml", file, force)
    bearings = [name.strip().upper() for name in wish.bearing]
    if len(bearings) > MOST_BEARINGS:
        allowed = "given once or twice; others are added in the file, [[support]]"
        raise InputError("--bearing", len(bearings), allowed)
    machine = len(bearings) == MOST_BEARINGS
    entries = _machine_entries(wish, bearings) if machine else _alone(wish, bearings[0])
    text = study_text(entries, file.name, ("contact",) if wish.contact or not machine else (), ENTRIES)
    write_text(file, text, "FILE.toml")
    oil = f"ISO VG {entries['oil.iso_vg']}" if "oil.iso_vg" in entries else "an oil of that data sheet"
    about = f"{' and '.join(bearings)} in {oil} at {numeral(wish.temp)} °C"
    speeds = ", ".join(map(numeral, wish.speed_rpm))
    loads = f"{', '.join(map(numeral, wish.load or [LOAD]))} N at " if not machine else ""
    told = partial(
        say,
        f"{file}: {about}, {loads}{speeds} rpm\n"
        f"what it will do:  ehlcontact validate {file}\ndo it:            ehlcontact run {file}",
        out.json_to,
    )
    numbers = {key: entries.get(f"operation.{key}") for key in ("speed_rpm", "radial_load")}
    known = {"bearing": bearings if machine else bearings[0], "oil": oil, "temperature": wish.temp}
    out.deliver({"study": str(file), **known, **numbers}, told)


def _alone(wish: Wish, bearing: str) -> dict[str, Any]:
    """A bearing alone under its loads."""
    parts = (name for name, entry in wish.ENTRIES.items() if entry.partition(".")[0] in ("shaft", "disc"))
    for name in ("span", "positions", *parts):
        if (value := getattr(wish, name)) is not None:
            option = f"--{name.replace('_', '-')}"
            raise InputError(option, value, "given with two bearings, --bearing LEFT --bearing RIGHT")
    loads = [float(load) for load in wish.load or [LOAD]]
    return _shared(wish, [bearing]) | {"support.0.bearing": bearing, "operation.radial_load": _one_or_all(loads)}


def _shared(wish: Wish, bearings: list[str]) -> dict[str, Any]:
    """Entries that the options set as they are, those of [[support]] of every bearing."""
    found: dict[str, Any] = {"title": f"study of {' and '.join(bearings)}"}
    given = wish.entries() | {"operation.speed_rpm": _one_or_all([float(speed) for speed in wish.speed_rpm])}
    if {"oil.nu40", "oil.nu100", "oil.eta0", "oil.alpha"} & set(given):
        given.pop("oil.iso_vg")
    several = {"support": range(len(bearings)), "disc": range(1)}
    for entry, value in given.items():
        section, _, key = entry.partition(".")
        names = [f"{section}.{k}.{key}" for k in several[section]] if section in several else [entry]
        found |= dict.fromkeys(names, value)
    return found


def _machine_entries(wish: Wish, bearings: list[str]) -> dict[str, Any]:
    """A shaft with a disc on two bearings."""
    from ehlcontact.cli.starter import machine_of

    if wish.span is None and wish.positions is None:
        raise InputError("--span", None, "given, with two bearings: their distance [mm]; or --positions")
    if wish.span is not None and wish.positions is not None:
        raise InputError("--span", wish.span, "left out where --positions are given")
    if wish.positions is not None and wish.positions[0] == wish.positions[1]:
        allowed = "two places: two bearings at one place are a pair, --pair"
        raise InputError("--positions", wish.positions, allowed)
    if wish.load is not None and len(wish.load) > 1:
        raise InputError("--load", tuple(wish.load), "given once, of a machine")
    found = _shared(wish, bearings)
    if not any(entry.startswith(f"disc.0.{key}") for entry in found for key in ("mass", "diameter", "width")):
        raise InputError("--disc-mass", None, "given, with two bearings: what they carry; or --disc-diameter")
    loads = {
        "disc.0.radial_load": None if wish.load is None else float(wish.load[0]),
        "disc.0.axial_load": found.pop("operation.axial_load", None),
    }
    for entry in ("operation.radial_load", *(f"support.{k}.{key}" for k in (0, 1) for key in ("pair", "preload"))):
        found.pop(entry, None)
    names = "shaft_length", "shaft_diameter", "positions", "pair", "preload"
    with o.called(name="--bearing"):
        found |= machine_of(bearings, span=wish.span or 0.0, **{name: getattr(wish, name) for name in names})
    return found | {entry: value for entry, value in loads.items() if value is not None}


def _one_or_all(values: list[float]) -> float | list[float]:
    """As the file has it: a list where there are several."""
    return values[0] if len(values) == 1 else values
