"""The study file that ``ehlcontact init`` writes: every entry of the schema, explained, with its default.

Meaning, range and default come from the schema. Values that were asked for, and grids that suit the film, are
entries; all others are defaults, as comments; sections that the study does not have are comments as a whole.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from textwrap import wrap
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from ehlcontact.cli.entries import allowed_of, in_options, is_several, keys_of, meaning_of, section_of
from ehlcontact.cli.study.points.lists import points_of
from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.toml import toml_value
from ehlcontact.errors import InputError
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.grid import Grid
from ehlcontact.solver.mesh_choice import Purpose, mesh_for
from reduced_models.bearing.catalogue import BY_DIMENSIONS, catalogue_row

WIDTH = 115  # characters of a line, as in the files of examples/
COMMENT = 34  # of them before the comment
OF_A_MACHINE = {  # options that set entries of parts
    "name": "--bearing",
    "support.bearing": "--bearing",
    "support.spring": "--preload",
    "support.position_mm": "--positions",
    "disc.radial_load": "--load",
    "disc.axial_load": "--axial",
}
IN_THE_FILE = "any other by its dimensions, in the file, balls = ..."
OVERHANG = 1.2  # of a shaft whose length is not given, over the distance of its bearings
HEAD = """\
# {about} What the study will do, and about how long that takes; then the study itself:
#   ehlcontact validate {name}
#   ehlcontact run {name}
# A line that begins with # and a name shows the default: take the # away to change it. `name = ?` has none.
# A section whose lines begin with # and no space is left out: take that # away from its lines to have it."""


def machine_of(
    bearings: Sequence[str],
    *,
    span: float,
    shaft_length: float | None = None,
    shaft_diameter: float | None = None,
    positions: tuple[float, float] | None = None,
    pair: str | None = None,
    preload: float | None = None,
) -> dict[str, Any]:
    """Entries of a shaft on two bearings, the second one pressed by a spring, or floating beside a pair.

    Parameters
    ----------
    bearings : sequence of str
        Two names of the catalogue, from left to right.
    span : float
        Distance of both [mm], where no `positions` are given.
    shaft_length, shaft_diameter : float, optional
        Of the shaft [mm]: by default 1.2 times the span, and as large as the larger bore.
    positions : (float, float), optional
        Of both from its left end [mm]; by default in the middle of the shaft.
    pair : str, optional
        Arrangement of two such bearings in place of the first.
    preload : float, optional
        Of the pair, or of the spring [N].
    """
    if positions is not None:
        span = abs(positions[1] - positions[0])
    length = shaft_length or (OVERHANG * span if positions is None else sum(positions))
    left = 0.5 * (length - span)
    places = positions or (left, left + span)
    bores = [1e3 * bore for name in bearings if (bore := catalogue_row(name)[1].bore) is not None]
    found: dict[str, Any] = {
        "shaft.length_mm": float(length),
        "shaft.diameter_mm": float(shaft_diameter or round(max(bores, default=0.1 * span), 6)),
        "disc.0.position_mm": 0.5 * (places[0] + places[1]),
    }
    for k, (name, place) in enumerate(zip(bearings, places, strict=True)):
        found[f"support.{k}.name"] = ("left", "right")[k]
        found[f"support.{k}.position_mm"] = float(place)
        found[f"support.{k}.bearing"] = name
    if pair is not None:
        found |= {"support.0.pair": pair, "support.0.preload": preload, "support.1.spring": 0.0}
    elif preload is not None:
        found["support.1.spring"] = preload
    return {entry: value for entry, value in found.items() if value is not None}


def study_text(asked: Mapping[str, Any], name: str, sections: Sequence[str], options: Collection[str] = ()) -> str:
    """The file, which `load_study` takes as it is.

    Parameters
    ----------
    asked : mapping
        Entries that the study is about, by ``section.key``, or ``section.number.key`` of one of several.
    name : str
        Name of the file, for its first lines.
    sections : sequence of str
        Sections that the study has, beside those of these entries.
    options : collection of str
        Entries that options of the command have set.

    Raises
    ------
    InputError
        The entries are no study; it names the option that sets the entry.
    """
    entries = dict(asked)
    try:
        studies = [point.study for point in points_of(tomllib.loads(_written(entries, name, sections)), Path())]
        if studies[0].contact is not None:
            entries |= _fitting(studies)
        text = _written(entries, name, sections)
        points_of(tomllib.loads(text), Path())
    except InputError as error:
        entry, allowed = (
            re.sub(r"\b(support|disc)\.\w+\.(?=\w)", r"\1.", text) for text in (error.field, error.allowed)
        )
        allowed = in_options(allowed, options).replace(BY_DIMENSIONS, IN_THE_FILE)
        raise InputError(OF_A_MACHINE.get(entry) or in_options(entry, options), error.value, allowed) from None
    return text


def _fitting(studies: Sequence[Study]) -> dict[str, Any]:
    """Grids and region that suit the films of all points, where those of the schema do not."""
    found: dict[str, Any] = {}
    own = studies[0].domain
    wide = [Domain.for_point(study.point.moes, study.largest_load) for study in studies]
    ends = own.as_tuple(), *(domain.as_tuple() for domain in wide)
    x_in, x_out, y_max = min(e[0] for e in ends), max(e[1] for e in ends), max(e[2] for e in ends)
    domain = own
    if (x_in, x_out, y_max) != own.as_tuple():
        domain = type(own)(*(_outward(end) for end in (x_in, x_out, y_max)))
        found["contact.domain"] = domain.as_tuple()
    for key, purpose in (("n", Purpose.FILM), ("n_transient", Purpose.RUN)):
        n = max(mesh_for(study.point.moes, purpose, grid=Grid(domain=domain)).n for study in studies)
        if n > getattr(studies[0].contact, key):
            found[f"contact.{key}"] = n
    return found


def _outward(end: float) -> float:
    """To a tenth, away from the contact."""
    return (int(abs(end) * 10.0) + 1) / 10.0 * (1.0 if end > 0.0 else -1.0)


def _written(entries: Mapping[str, Any], name: str, sections: Sequence[str]) -> str:
    """The text of the file."""
    names = [value for entry, value in sorted(entries.items()) if entry.endswith(".bearing")]
    about = f"A {'bearing' if len(names) == 1 else 'machine'}: {', '.join(names)}."
    lines = [HEAD.format(about=about, name=name), ""]
    live = {entry.partition(".")[0] for entry in entries} | set(sections)
    for section, field in Study.model_fields.items():
        model = section_of(field.annotation)
        if model is None:
            lines.append(_line(section, field, entries, {}))
        elif is_several(field.annotation):
            count = len({entry.split(".")[1] for entry in entries if entry.startswith(f"{section}.")})
            for k in range(max(count, 1)):
                text = _section(f"[[{section}]]", model, f"{section}.{k}", entries, explained=k == 0)
                lines += text if count else _left_out(text)
        else:
            text = list(_section(f"[{section}]", model, section, entries))
            lines += text if section in live else _left_out(text)
    return "\n".join(lines) + "\n"


def _left_out(lines: Sequence[str]) -> list[str]:
    """A section that the study does not have: its lines but those that are comments already begin with #."""
    each = [part for line in lines for part in line.split("\n")]
    return [line if not line or (line.startswith("# ") and " = " not in line) else f"#{line}" for line in each]


def _section(
    head: str, model: type[BaseModel], name: str, entries: Mapping[str, Any], *, explained: bool = True
) -> list[str]:
    """A section with its entries, and after them the sections in it."""
    shown = {}
    if f"{name}.bearing" in entries:
        shown = {f"{name}.{key}": value for key, value in _dimensions(entries[f"{name}.bearing"]).items()}
    comment = _comment(" ".join((model.__doc__ or "").split())) if explained else []
    lines, inner = ["", *comment, head], []
    if shown and explained:
        lines += _comment(f"dimensions: {catalogue_row(entries[f'{name}.bearing'])[1].source}")
    for key, entry in keys_of(model).items():
        if (below := section_of(entry.annotation)) is not None:
            inner += _section(f"[{name}.{key}]", below, f"{name}.{key}", entries)
        elif explained or f"{name}.{key}" in entries:
            lines.append(_line(f"{name}.{key}", entry, entries, shown))
    return lines + inner


def _dimensions(name: str) -> dict[str, Any]:
    """Dimensions of a bearing of the catalogue, as comments show them."""
    row = catalogue_row(name)[1]
    lengths = {"ball_diameter_mm": row.ball_diameter, "pitch_diameter_mm": row.pitch_diameter}
    return {"balls": row.balls, **{key: round(1e3 * value, 6) for key, value in lengths.items()}}


def _line(name: str, entry: FieldInfo, entries: Mapping[str, Any], shown: Mapping[str, Any]) -> str:
    """One entry: its value, or its default behind a #, and what it is."""
    key = name.rpartition(".")[2]
    default = shown.get(name, None if entry.is_required() else entry.default)
    value = entries.get(name, default)
    allowed = allowed_of(entry).removeprefix("a finite number ")
    what = "; ".join(part for part in (meaning_of(entry), allowed) if part)
    if name in entries and default is not None and name not in shown:
        what += (
            f" (default {toml_value(default)}{', too small for this film' if name.startswith('contact.') else ''})"
        )
    written = f"{'' if name in entries else '# '}{key} = {'?' if value is None else toml_value(value)}"
    line = f"{written.ljust(COMMENT - 1)} # {what}"
    if len(line) < WIDTH:  # with the # of a section that is left out
        return line
    return "\n".join([*_comment(f"{key}: {what}"), written])


def _comment(text: str) -> list[str]:
    return [f"# {line}" for line in wrap(text, WIDTH - 2)]
