"""Study files in the folder of results: whose results these are, and what changed of the study since."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ehlcontact.cli.study.points.lists import STUDY_FILE, Point
from ehlcontact.cli.toml import read_toml, toml_of
from ehlcontact.errors import InputError
from ehlcontact.files import read_text, write_text

ORIGIN = "study_file.txt"  # the path of the file that the study was read from
MOST = 6  # entries that are named


def require_own(path: Path, folder: Path, *, force: bool = False) -> str:
    """Make sure that a folder of results is that of the study, and tell what changed of it.

    Parameters
    ----------
    path : Path
        The study file.
    folder : Path
        Of the results; it need not exist.
    force : bool
        Whether results of a study from another file are replaced; where that file is gone they are in any case.

    Returns
    -------
    str
        Entries that changed since the last run, in words; empty where none did, and of a new folder.

    Raises
    ------
    InputError
        The folder has the results of another study, from another file.
    """
    copy = folder / STUDY_FILE
    if not copy.is_file() or copy.resolve() == path.resolve() or read_text(copy) == read_text(path):
        return ""
    known = folder / ORIGIN
    origin = Path(read_text(known).strip()) if known.is_file() else None
    if origin is not None and origin != path.resolve() and origin.exists() and not force:
        allowed = (
            f"a folder without the results of another study, of {origin}; or with --force, which replaces them"
        )
        raise InputError("--output", str(folder), allowed)
    try:
        before = read_toml(copy, "study")
    except InputError:
        return "all of it"
    names = _differences(before, read_toml(path, "study"))
    more = len(names) - MOST
    return ", ".join(names[:MOST]) + (f" and {more} more" if more > 0 else "") or "comments"


def _differences(before: Mapping[str, Any], after: Mapping[str, Any]) -> list[str]:
    """Entries that two documents do not share."""
    old, new = dict(_entries(before)), dict(_entries(after))
    return [name for name in {**old, **new} if name not in old or name not in new or old[name] != new[name]]


def _entries(value: Any, above: str = "") -> Iterator[tuple[str, Any]]:
    """Entries of a document by their names; tables that stand several times by their numbers."""
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _entries(inner, f"{above}.{name}" if above else name)
    elif isinstance(value, list) and any(isinstance(one, Mapping) for one in value):
        for k, inner in enumerate(value):
            yield from _entries(inner, above if len(value) == 1 else f"{above}.{k + 1}")
    else:
        yield above, value


def write_studies(points: Sequence[Point], path: Path, folder: Path) -> None:
    """Copy the study file, and its path, to the folder of results; write the study of each of several points."""
    copy = folder / STUDY_FILE
    if not copy.exists() or not copy.samefile(path):
        write_text(copy, read_text(path), "file")
        origin, text = folder / ORIGIN, f"{path.resolve()}\n"
        if not origin.is_file() or read_text(origin) != text:
            write_text(origin, text, "file")
    for point in points:
        if point.of_several:
            point.folder.mkdir(parents=True, exist_ok=True)
            entries = point.study.model_dump(exclude_unset=True, exclude_none=True)
            write_text(point.study_file, f"# One point of {path.name}\n{toml_of(entries)}", "file")
