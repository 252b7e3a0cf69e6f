"""Points of a study file: every value of a list with every one of the others, each a study in a folder of its own.

An entry of a section that is one number, one text or one choice may be a list of these.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from itertools import product
from math import isclose, prod
from pathlib import Path
from typing import Any, NamedTuple, get_args, get_origin

from ehlcontact.cli.entries import is_several, quantity_of, section_of
from ehlcontact.cli.study.schema import Study, study_of
from ehlcontact.cli.study.schema_errors import entry_name
from ehlcontact.cli.study.sections import plain_names
from ehlcontact.cli.toml import read_toml
from ehlcontact.errors import InputError
from reduced_models.life.system_life import require_shares

SHARES, SPEED = "operation.shares", "operation.speed_rpm"
UNITS = "mm", "um", "deg", "rpm", "mrad"  # at the end of names of entries
USUAL = {"operation.speed_rpm": "rpm", "operation.radial_load": "N"}  # entries that every point is named by
MOST = 100  # points: at some minutes each what a night has room for
SAME = 1e-6  # share by which two numbers of a list differ at least: they name folders and rows of tables
TITLE = Study.model_fields["title"].default
STUDY_FILE, POINTS = "study.toml", "points"  # in the folder of the results


class Chosen(NamedTuple):
    """What a point has of a list of the file."""

    entry: str  # "support.fan end.spring"
    unit: str
    value: Any

    @property
    def label(self) -> str:
        """The entry in words: without the section where that is plain, and without its unit."""
        name = self.entry.removeprefix("operation.").removeprefix("support.")
        return re.sub(f"_({'|'.join(UNITS)})$", "", name).replace(".", " ").replace("_", " ")

    @property
    def head(self) -> str:
        """The label with the unit."""
        return f"{self.label} [{self._unit}]" if self._unit else self.label

    @property
    def words(self) -> str:
        """Label, value and unit."""
        return f"{self.label} {self.shown} {self._unit}".rstrip()

    @property
    def _unit(self) -> str:
        """That of a number; a class of clearance has none."""
        return self.unit if isinstance(self.value, float | int) else ""

    @property
    def shown(self) -> str:
        """The value in words."""
        return short_text(self.value) if isinstance(self.value, float | int) else str(self.value)


class _List(NamedTuple):
    """A list of the file, by where it stands."""

    path: tuple[str | int, ...]
    entry: str
    unit: str
    values: list[Any]


@dataclass(frozen=True)
class Point:
    """One point of a study."""

    study: Study
    name: str  # "3000rpm_100N"
    folder: Path  # of its results
    study_title: str = ""  # of all points together
    of_several: bool = False
    chosen: tuple[Chosen, ...] = ()  # of lists beside those of speed and load
    share: float | None = None  # of the time, of a load spectrum

    @property
    def study_file(self) -> Path:
        """The study of this point alone, in its folder."""
        return self.folder / STUDY_FILE

    def titled(self, text: str) -> str:
        """Text with the name of the point in front where there are several."""
        return f"{self.name}: {text}" if self.of_several else text


def load_points(path: Path, folder: Path) -> tuple[Point, ...]:
    """Read and check a study file of one point or of several.

    Parameters
    ----------
    path : Path
        The study.
    folder : Path
        Of its results: of the point itself where there is one, else of a folder for each, below ``points/``.

    Returns
    -------
    tuple of Point
        In the order of the lists: under each speed the loads, under these what other lists have.

    Raises
    ------
    InputError
        As `load_study`; lists that are empty, have a value twice, or make too many points.
    """
    document = read_toml(path, "study")
    try:
        return points_of(document, folder)
    except InputError as error:
        raise InputError(f"{path}: {error.field}", error.value, error.allowed) from None


def points_of(document: Mapping[str, Any], folder: Path, *, at_rest: bool = False) -> tuple[Point, ...]:
    """The points of a document, as `load_points` without the name of the file.

    `at_rest`: of a bearing whose speed may be 0, and whose speeds and loads alone may be lists.
    """
    document, shares = _without_shares(document)
    found = expanded(document, tuple(USUAL) if at_rest else None)
    several = len(found) > 1
    points: list[Point] = []
    for one, chosen in found:
        try:
            study = study_of(one, at_rest=at_rest)
        except InputError as error:
            own = [error.field.startswith("operation."), *(choice.entry == error.field for choice in chosen)]
            where = f", at {_said(one, chosen)}" if several and not any(own) else ""
            raise InputError(error.field, error.value, error.allowed + where) from None
        name = point_name(study, chosen)
        if name in [point.name for point in points]:
            fields = ", ".join(choice.entry for choice in chosen)
            raise InputError(fields, chosen[-1].shown, "told from the others by its letters and digits")
        title = str(document.get("title", TITLE)) if several else study.title
        place = folder / POINTS / name if several else folder
        points.append(Point(study, name, place, title, several, chosen))
    return _with_shares(points, shares)


def _without_shares(document: Mapping[str, Any]) -> tuple[Mapping[str, Any], Any]:
    """The document of the points, and the shares of the time that it has of all of them."""
    operation = document.get("operation")
    if not isinstance(operation, Mapping) or "shares" not in operation:
        return document, None
    rest = {name: value for name, value in operation.items() if name != "shares"}
    return {**document, "operation": rest}, operation["shares"]


def _with_shares(points: Sequence[Point], shares: Any) -> tuple[Point, ...]:
    """Points with their shares of the time; raises `InputError` for shares that are none of them."""
    if shares is None:
        return tuple(points)
    if not isinstance(shares, list) or len(shares) != len(points):
        count = f"{len(shares)} of them" if isinstance(shares, list) else shares
        allowed = f"a list of one for each point, of which this study has {len(points)}"
        guess = _with_commas(shares, len(points)) if isinstance(shares, list) else ""
        raise InputError(SHARES, count, f"{allowed} ({guess})" if guess else allowed)
    return tuple(
        replace(point, share=share) for point, share in zip(points, require_shares(SHARES, shares), strict=True)
    )


def _with_commas(shares: Sequence[Any], points: int) -> str:
    """What shares with decimal commas were probably meant as, in words: TOML reads 0,6 as two numbers."""
    if len(shares) != 2 * points or not all(type(one) is int and one >= 0 for one in shares):
        return ""
    meant = (f"{whole}.{decimals}" for whole, decimals in zip(shares[::2], shares[1::2], strict=True))
    return f"[{', '.join(meant)}]? decimals have a point"


def expanded(
    document: Mapping[str, Any], allowed: Sequence[str] | None = None
) -> list[tuple[dict[str, Any], tuple[Chosen, ...]]]:
    """A document without lists for every point of it, and what it has of lists beside those of speed and load.

    Parameters
    ----------
    document : mapping
    allowed : sequence of str, optional
        Entries that may be lists; by default all that are one value.

    Raises
    ------
    InputError
        A list that is none of several values.
    """
    lists = [one for one in lists_of(document) if allowed is None or one.entry in allowed]
    for one in lists:
        _require_values(one)
        _require_certain(one, document)
    count = prod(len(one.values) for one in lists)
    if count > MOST:
        sizes = " x ".join(str(len(one.values)) for one in lists)
        most = f"at most {MOST} points: every value of a list with every one of the others"
        raise InputError(", ".join(one.entry for one in lists), sizes, most)
    found = []
    for values in product(*(one.values for one in lists)):
        own, chosen = deepcopy(dict(document)), []
        for one, value in zip(lists, values, strict=True):
            *above, key = one.path
            section: Any = own
            for part in above:
                section = section[part]
            section[key] = value
            if len(one.values) > 1 and one.entry not in USUAL:
                chosen.append(Chosen(one.entry, one.unit, value))
        for speeds in (one.values for one in lists if one.entry == SPEED):
            _balance(own, speeds)
        if count > 1 and isinstance(document.get("title", ""), str):
            own["title"] = f"{document.get('title', TITLE)}, {_said(own, chosen)}"
        found.append((own, tuple(chosen)))
    return found


def _balance(document: dict[str, Any], speeds: Sequence[Any]) -> None:
    """Give balance grades without a speed the highest of a list: one rotor has one unbalance at all of them."""
    numbers = [speed for speed in speeds if isinstance(speed, int | float)]
    discs = document.get("disc")
    for disc in discs if numbers and isinstance(discs, list) else ():
        if isinstance(disc, dict) and "balance_grade" in disc:
            disc.setdefault("balance_speed_rpm", float(max(numbers)))


def lists_of(document: Mapping[str, Any]) -> list[_List]:
    """Lists of a document in the place of one value, in the order of the schema."""
    return list(_lists(document, Study, (), document))


def _lists(section: Any, model: Any, above: tuple[str | int, ...], document: Mapping[str, Any]) -> Iterator[_List]:
    if not isinstance(section, Mapping):
        return
    for key, field in model.model_fields.items():
        value, path = section.get(key), (*above, key)
        inner = section_of(field.annotation)
        if inner is not None and is_several(field.annotation):
            for k, table in enumerate(value if isinstance(value, list) else ()):
                yield from _lists(table, inner, (*path, k), document)
        elif inner is not None:
            yield from _lists(value, inner, path, document)
        elif above and isinstance(value, list) and not _is_list(field.annotation):
            quantity = quantity_of(field)
            unit = "" if quantity is None else quantity.unit
            yield _List(path, entry_name(path, Study, document), unit, value)


def _is_list(kind: Any) -> bool:
    """Whether an entry is a list in every point."""
    return get_origin(kind) is tuple or any(_is_list(part) for part in get_args(kind))


def _require_values(one: _List) -> None:
    """Raise `InputError` for a list that is none of values, each once."""
    if not one.values:
        raise InputError(one.entry, one.values, f"one value, or a list of 1 to {MOST}, as [1000, 3000]")
    for value in one.values:
        if isinstance(value, list | dict):
            raise InputError(one.entry, value, "one value, in a list of values")
    require_apart(one.entry, one.values)


def _require_certain(one: _List, document: Mapping[str, Any]) -> None:
    """Raise `InputError` for a list of an entry that [uncertain] has too."""
    given = document.get("uncertain")
    names = [name for name, _ in plain_names(given)] if isinstance(given, Mapping) else []
    section, *_, key = (str(part) for part in one.path)
    for name in names:
        if name in (one.entry, f"{section}.{key}"):
            raise InputError(one.entry, one.values, f"one value, beside its range in [uncertain]: {name}")


def require_apart(field: str, given: Sequence[Any]) -> None:
    """Raise `InputError` for a value that a list has twice, or nearly so."""
    for i, value in enumerate(given):
        if value in given[:i]:
            raise InputError(field, value, "once in its list")
        for other in given[:i]:
            if all(isinstance(one, int | float) for one in (value, other)) and isclose(value, other, rel_tol=SAME):
                raise InputError(field, value, f"further from {other!r}, in its list, than {SAME:g} of it")


def _said(document: Mapping[str, Any], chosen: Sequence[Chosen]) -> str:
    """A point in words: speed and load, and what it has of other lists."""
    usual = [(document["operation"].get(name.partition(".")[2]), unit) for name, unit in USUAL.items()]
    shown = [(f"{value:.15g}" if isinstance(value, float) else value, unit) for value, unit in usual]
    parts = [f"{value} {unit}" for value, unit in shown if value is not None]
    return ", ".join([*parts, *(choice.words for choice in chosen)])


def point_name(study: Study, chosen: Sequence[Chosen] = ()) -> str:
    """Name of a point and of its folder."""
    usual = [(getattr(study.operation, name.partition(".")[2]), unit) for name, unit in USUAL.items()]
    parts = [f"{short_text(value)}{unit}" for value, unit in usual if value is not None]
    return "_".join([*parts, *(_plain(f"{choice.label}_{choice.shown}") for choice in chosen)])


def _plain(text: str) -> str:
    """Text that names a folder anywhere."""
    return re.sub(r"[^\w.+-]+", "_", text)


def short_text(value: float) -> str:
    """Shortest text of a number that gives all its digits."""
    text = f"{value:g}"
    return text if float(text) == value else repr(value)
