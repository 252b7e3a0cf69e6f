"""The study file that ``ehlcontact init`` writes: every entry of the schema, explained, with its default.

Meaning, range and default come from the schema. Values that were asked for, and grids that suit the film, are
entries; all others are defaults, as comments.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from textwrap import wrap
from typing import Any

from pydantic.fields import FieldInfo

from ehlcontact.cli.entries import allowed_of, keys_of, meaning_of
from ehlcontact.cli.study.points.lists import points_of
from ehlcontact.cli.study.schema import Study, catalogue_angle, catalogue_entries
from ehlcontact.cli.study.whole_bearing import require_whole_bearing
from ehlcontact.cli.toml import toml_value
from ehlcontact.errors import InputError
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.grid import Grid
from ehlcontact.solver.mesh_choice import Purpose, mesh_for
from reduced_models.bearing.catalogue import catalogue_row

WIDTH = 115  # characters of a line, as in the files of examples/
COMMENT = 34  # of them before the comment
# Entries of the file by the option that sets them.
OPTIONS = {
    "bearing.catalogue": "--bearing",
    "bearing.radial_load": "--load",
    "bearing.speed_rpm": "--speed-rpm",
    "oil.iso_vg": "--oil",
    "oil.temperature": "--temp",
    "whole_bearing.axial_load": "--axial",
    "whole_bearing.layer_um": "--layer",
    "whole_bearing.layer_ratio": "--layer-ratio",
    "whole_bearing.thermal": "--thermal",
}
HEAD = """\
# A study of one bearing. What it will do, and about how long that takes; then the study itself:
#   ehlcontact validate {name}
#   ehlcontact run {name}
# A line that begins with # and a name shows the default: take the # away to change it. `name = ?` has none."""


def study_text(asked: Mapping[str, Any], name: str) -> str:
    """The file, which `load_study` takes as it is.

    Parameters
    ----------
    asked : mapping
        Entries that the study is about, by ``section.key``; ``bearing.catalogue`` is among them.
    name : str
        Name of the file, for its first lines.

    Raises
    ------
    InputError
        The entries are no study; it names the option that sets the entry.
    """
    entries = dict(asked)
    whole = any(entry.startswith("whole_bearing.") for entry in asked)
    try:
        first = _written(entries, name, None if whole else "")
        studies = [point.study for point in points_of(tomllib.loads(first), Path())]
        entries |= _fitting(studies)
        try:
            for study in studies:
                require_whole_bearing(study)
        except InputError as error:  # the rest of the study runs without
            if whole:
                raise
            return _written(entries, name, str(error))
        text = _written(entries, name)
        points_of(tomllib.loads(text), Path())
    except InputError as error:
        raise InputError(OPTIONS.get(error.field, error.field), error.value, error.allowed) from None
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
        found["solver.domain"] = domain.as_tuple()
    for key, purpose in (("n", Purpose.FILM), ("n_transient", Purpose.RUN)):
        n = max(mesh_for(study.point.moes, purpose, grid=Grid(domain=domain)).n for study in studies)
        if n > getattr(studies[0].solver, key):
            found[f"solver.{key}"] = n
    return found


def _outward(end: float) -> float:
    """To a tenth, away from the contact."""
    return (int(abs(end) * 10.0) + 1) / 10.0 * (1.0 if end > 0.0 else -1.0)


def _written(entries: Mapping[str, Any], name: str, no_whole: str | None = None) -> str:
    """The text, with the section of the whole bearing as a comment where there is a reason why it is not run."""
    shown = {f"bearing.{key}": value for key, value in catalogue_entries(entries["bearing.catalogue"]).items()}
    angle = catalogue_angle(entries["bearing.catalogue"])[1]
    shown |= {} if angle is None else {"whole_bearing.contact_angle_deg": angle}
    lines = [HEAD.format(name=name), ""]
    for section, field in Study.model_fields.items():
        model = field.annotation
        if not keys_of(model):
            lines.append(_line(section, field, entries, shown))
            continue
        lines += ["", *_comment(" ".join((model.__doc__ or "").split()))]
        if section == "whole_bearing" and no_whole is not None:
            lines += [*_comment(f"Left out here: {no_whole}"), f"# [{section}]"]
        else:
            lines.append(f"[{section}]")
        if section == "bearing":
            lines += _comment(f"dimensions: {catalogue_row(entries['bearing.catalogue'])[1].source}")
        lines += [_line(f"{section}.{key}", entry, entries, shown) for key, entry in keys_of(model).items()]
    return "\n".join(lines) + "\n"


def _line(name: str, entry: FieldInfo, entries: Mapping[str, Any], shown: Mapping[str, Any]) -> str:
    """One entry: its value, or its default behind a #, and what it is."""
    key = name.rpartition(".")[2]
    default = shown.get(name, None if entry.is_required() else entry.default)
    value = entries.get(name, default)
    allowed = allowed_of(entry).removeprefix("a finite number ")
    what = "; ".join(part for part in (meaning_of(entry), allowed) if part)
    if name in entries and default is not None and name not in shown:
        what += (
            f" (default {toml_value(default)}{', too small for this film' if name.startswith('solver.') else ''})"
        )
    written = f"{'' if name in entries else '# '}{key} = {'?' if value is None else toml_value(value)}"
    line = f"{written.ljust(COMMENT - 1)} # {what}"
    if len(line) <= WIDTH:
        return line
    return "\n".join([*_comment(f"{key}: {what}"), written])


def _comment(text: str) -> list[str]:
    return [f"# {line}" for line in wrap(text, WIDTH - 2)]
