"""Points of a study file: every speed with every load, each a study of its own in a folder of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from math import isclose
from pathlib import Path
from typing import Any

from ehlcontact.cli.study.schema import Study, study_of
from ehlcontact.cli.study.schema_errors import SEVERAL
from ehlcontact.cli.toml import read_toml, toml_of
from ehlcontact.errors import InputError
from ehlcontact.files import read_text, write_text

LISTS = [name.removeprefix("operation.") for name in SEVERAL]
MOST = 100  # points: at some minutes each what a night has room for
SAME = 1e-6  # share by which two numbers of a list differ at least: they name folders and rows of tables
TITLE = Study.model_fields["title"].default
STUDY_FILE, POINTS = "study.toml", "points"


@dataclass(frozen=True)
class Point:
    """One speed and load of a study."""

    study: Study
    name: str  # "3000rpm_100N"
    folder: Path  # of its results
    study_title: str = ""  # of all points together
    of_several: bool = False

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
        Speeds in the order of the file, and under each the loads.

    Raises
    ------
    InputError
        As `load_study`; lists that are empty, name a number twice, or make too many points.
    """
    document = read_toml(path, "study")
    try:
        return points_of(document, folder)
    except InputError as error:
        raise InputError(f"{path}: {error.field}", error.value, error.allowed) from None


def points_of(document: Mapping[str, Any], folder: Path, *, at_rest: bool = False) -> tuple[Point, ...]:
    """The points of a document, as `load_points` without the name of the file; `at_rest`: speeds may be 0."""
    documents = expanded(document)
    several = len(documents) > 1
    points = []
    for one in documents:
        try:
            study = study_of(one, at_rest=at_rest)
        except InputError as error:
            where = f", at {_said(one)}" if several and not error.field.startswith("operation.") else ""
            raise InputError(error.field, error.value, error.allowed + where) from None
        name = point_name(study)
        title = str(document.get("title", TITLE)) if several else study.title
        points.append(Point(study, name, folder / POINTS / name if several else folder, title, several))
    return tuple(points)


def expanded(document: Mapping[str, Any]) -> list[dict[str, Any]]:
    """A document without lists for every point of it.

    Raises
    ------
    InputError
        A list that is none of several numbers.
    """
    operation = document.get("operation")
    if not isinstance(operation, Mapping) or not any(isinstance(operation.get(key), list) for key in LISTS):
        return [dict(document)]
    values = [
        _values(key, operation[key]) if isinstance(operation.get(key), list) else [operation.get(key)]
        for key in LISTS
    ]
    count = len(values[0]) * len(values[1])
    if count > MOST:
        allowed = f"at most {MOST} points: speeds times loads"
        raise InputError(", ".join(SEVERAL), f"{len(values[0])} x {len(values[1])}", allowed)
    found = []
    for pair in product(*values):
        own = {key: value for key, value in zip(LISTS, pair, strict=True) if value is not None}
        one = dict(document) | {"operation": dict(operation) | own}
        if count > 1 and isinstance(document.get("title", ""), str):
            one["title"] = f"{document.get('title', TITLE)}, {_said(one)}"
        found.append(one)
    return found


def _values(key: str, given: list[Any]) -> list[Any]:
    """The numbers of a list, each once."""
    field = f"operation.{key}"
    if not given:
        raise InputError(field, given, f"a number, or a list of 1 to {MOST} numbers, as [1000, 3000]")
    for value in given:
        if isinstance(value, list | dict):
            raise InputError(field, value, "a number, in a list of numbers")
    require_apart(field, given)
    return given


def require_apart(field: str, given: Sequence[Any]) -> None:
    """Raise `InputError` for a number that a list has twice, or nearly so."""
    for i, value in enumerate(given):
        if value in given[:i]:
            raise InputError(field, value, "once in its list")
        for other in given[:i]:
            if all(isinstance(one, int | float) for one in (value, other)) and isclose(value, other, rel_tol=SAME):
                raise InputError(field, value, f"further from {other!r}, in its list, than {SAME:g} of it")


def _said(document: Mapping[str, Any]) -> str:
    """Speed and load of a document of one point, in words."""
    speed, load = (document["operation"].get(key) for key in LISTS)
    return f"{speed} rpm" if load is None else f"{speed} rpm, {load} N"


def point_name(study: Study) -> str:
    """Name of a point and of its folder, different for different points."""
    speed, load = (getattr(study.operation, key) for key in LISTS)
    return f"{_short(speed)}rpm" + ("" if load is None else f"_{_short(load)}N")


def _short(value: float) -> str:
    """Shortest text of a number that gives all its digits."""
    text = f"{value:g}"
    return text if float(text) == value else repr(value)


def write_studies(points: tuple[Point, ...], path: Path, folder: Path) -> None:
    """Copy the study file to the folder of its results, and write the study of each of several points."""
    copy = folder / STUDY_FILE
    if not copy.exists() or not copy.samefile(path):
        write_text(copy, read_text(path), "file")
    for point in points:
        if point.of_several:
            point.folder.mkdir(parents=True, exist_ok=True)
            entries = point.study.model_dump(exclude_unset=True, exclude_none=True)
            write_text(point.study_file, f"# One point of {path.name}\n{toml_of(entries)}", "file")
