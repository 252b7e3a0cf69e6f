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
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import check_new, say
from ehlcontact.cli.study.schema import oil_grade
from ehlcontact.errors import InputError
from ehlcontact.files import write_text

SEVERAL = "given several times, the study runs at all of them"
MOST_BEARINGS = 2
LOAD = 100.0  # N, on a bearing alone
MACHINE = (
    "span",
    "positions",
    "shaft_length",
    "shaft_diameter",
    "disc_mass",
    "disc_diameter",
    "disc_width",
    "unbalance",
)
_machine = partial(typer.Option, rich_help_panel="Machine: two bearings under a shaft")


class Wish(o.Options):
    """What the study is about; in place of these options stand entries of the file afterwards."""

    bearing: Annotated[
        list[e.Catalogue],
        typer.Option("--bearing", metavar="NAME", autocompletion=known_bearings),
        e.meaning("name of a ball bearing in the catalogue, as 6205; two of them, left and right, are a machine"),
    ] = Field(["6205"])
    oil: Annotated[str, OIL_NAME] = "ISO VG 68"
    nu40: Annotated[e.Nu40 | None, typer.Option("--nu40"), e.meaning("mm2/s at 40 C, in place of --oil")] = None
    nu100: Annotated[e.Nu100 | None, typer.Option("--nu100"), e.meaning("mm2/s at 100 C, with --nu40")] = None
    temp: Annotated[e.Temperature, typer.Option("--temp")] = 50.0
    speed_rpm: Annotated[
        list[e.Speed], typer.Option("--speed-rpm"), e.meaning(f"speed of the shaft; {SEVERAL}")
    ] = Field([3000.0])
    load: Annotated[
        list[e.Load] | None,
        typer.Option("--load", show_default="100 on a bearing, none on a machine"),
        e.meaning(f"radial load on the bearing; {SEVERAL}; of a machine on its disc, beside the weight"),
    ] = None
    axial: Annotated[
        e.Load | None, typer.Option("--axial"), e.meaning("axial load; an angular contact bearing needs one")
    ] = None
    clearance: Annotated[
        str | None,
        typer.Option(
            "--clearance",
            metavar="UM|CLASS",
            help="Radial internal clearance, um, below 0 a preload; or C2, CN, C3, C4: the middle of that class.",
        ),
    ] = None
    rq: Annotated[
        e.Roughness | None, typer.Option("--rq"), e.meaning("roughness of ball and race together, for lambda")
    ] = None
    pair: Annotated[e.Arrangement | None, typer.Option("--pair"), e.meaning("two of the first bearing")] = None
    preload: Annotated[
        e.Preload | None, typer.Option("--preload"), e.meaning("of the pair, or of a spring on the second bearing")
    ] = None
    layer: Annotated[e.OilThickness | None, typer.Option("--layer")] = None
    layer_ratio: Annotated[e.BearingLayerRatio | None, typer.Option("--layer-ratio")] = None
    thermal: Annotated[
        bool, typer.Option("--thermal", help="Films of the bearing with heat, beside isothermal ones.")
    ] = False
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
    disc_mass: Annotated[
        e.Mass | None, _machine("--disc-mass"), e.meaning("mass of a disc in the middle of both bearings")
    ] = None
    disc_diameter: Annotated[
        e.Diameter | None, _machine("--disc-diameter"), e.meaning("its diameter, in place of its mass")
    ] = None
    disc_width: Annotated[e.Width | None, _machine("--disc-width"), e.meaning("its width along the shaft")] = None
    unbalance: Annotated[
        e.Unbalance | None, _machine("--unbalance"), e.meaning("mass times eccentricity of that disc")
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
    bearings, grade = (
        [name.strip().upper() for name in wish.bearing],
        oil_grade(wish.oil, "--oil", "its --nu40 and --nu100"),
    )
    sheet = {f"oil.{key}": value for key in ("nu40", "nu100") if (value := getattr(wish, key)) is not None}
    entries = _entries(wish, bearings) | (sheet or {"oil.iso_vg": grade}) | {"oil.temperature": wish.temp}
    machine = len(bearings) == MOST_BEARINGS
    text = study_text(entries, file.name, ("contact",) if wish.contact or not machine else ())
    write_text(file, text, "FILE.toml")
    oil = "an oil of that data sheet" if sheet else f"ISO VG {grade}"
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


def _entries(wish: Wish, bearings: list[str]) -> dict[str, Any]:
    """Entries of the file that the options set, but those of the oil."""
    from ehlcontact.cli.starter import machine_of

    speeds = [float(speed) for speed in wish.speed_rpm]
    found: dict[str, Any] = {"title": f"study of {' and '.join(bearings)}"}
    found["operation.speed_rpm"] = _one_or_all(speeds)
    for key, value in (("layer_um", wish.layer), ("layer_ratio", wish.layer_ratio), ("thermal", wish.thermal)):
        if value:
            found[f"operation.{key}"] = value
    if wish.rq is not None:
        found["surface.rq_um"] = wish.rq
    if len(bearings) > MOST_BEARINGS:
        raise InputError(
            "--bearing", len(bearings), "given once or twice; others are added in the file, [[support]]"
        )
    found |= _alone(wish, bearings[0]) if len(bearings) == 1 else _machine_entries(wish, bearings, machine_of)
    if wish.clearance is not None:
        for k in range(len(bearings)):
            found[f"support.{k}.clearance"] = _clearance(wish.clearance)
    return found


def _alone(wish: Wish, bearing: str) -> dict[str, Any]:
    """A bearing alone under its loads."""
    for name in MACHINE:
        if (value := getattr(wish, name)) is not None:
            option = f"--{name.replace('_', '-')}"
            raise InputError(option, value, "given with two bearings, --bearing LEFT --bearing RIGHT")
    found: dict[str, Any] = {"support.0.bearing": bearing}
    found |= {"support.0.pair": wish.pair, "support.0.preload": wish.preload, "operation.axial_load": wish.axial}
    loads = [float(load) for load in wish.load or [LOAD]]
    return {key: value for key, value in found.items() if value is not None} | {
        "operation.radial_load": _one_or_all(loads)
    }


def _machine_entries(wish: Wish, bearings: list[str], machine_of: Any) -> dict[str, Any]:
    """A shaft with a disc on two bearings."""
    if wish.span is None and wish.positions is None:
        raise InputError("--span", None, "given, with two bearings: their distance [mm]; or --positions")
    if wish.span is not None and wish.positions is not None:
        raise InputError("--span", wish.span, "left out where --positions are given")
    if wish.positions is not None and wish.positions[0] == wish.positions[1]:
        allowed = "two places: two bearings at one place are a pair, --pair"
        raise InputError("--positions", wish.positions, allowed)
    if wish.load is not None and len(wish.load) > 1:
        raise InputError("--load", tuple(wish.load), "given once, of a machine")
    given = {
        name: getattr(wish, name) for name in ("shaft_length", "shaft_diameter", "positions", "pair", "preload")
    }
    with o.called(name="--bearing"):
        found: dict[str, Any] = machine_of(bearings, span=wish.span or 0.0, **given)
    disc = {"mass": wish.disc_mass, "diameter_mm": wish.disc_diameter, "width_mm": wish.disc_width}
    if not any(disc.values()):
        raise InputError("--disc-mass", None, "given, with two bearings: what they carry; or --disc-diameter")
    disc |= {"unbalance": wish.unbalance, "radial_load": None if wish.load is None else float(wish.load[0])}
    disc["axial_load"] = wish.axial
    return found | {f"disc.0.{key}": value for key, value in disc.items() if value is not None}


def _clearance(text: str) -> float | str:
    """A number of micrometres, or the class as it is."""
    try:
        return float(text)
    except ValueError:
        return text.strip().upper()


def _one_or_all(values: list[float]) -> float | list[float]:
    """As the file has it: a list where there are several."""
    return values[0] if len(values) == 1 else values
