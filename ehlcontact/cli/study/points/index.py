"""Index of what is computed in the folder of a point: ``stages.json``, with hashes of inputs and of files.

A stage with the same inputs that another point of the study has computed is copied, not solved again.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ehlcontact.cli.output import write_json
from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.study.stages import STAGES, Stage, stages_of
from ehlcontact.content_store import checksum, key_of
from ehlcontact.files import parse_json, read_text, replacing
from ehlcontact.status import Status

INDEX = "stages.json"
FINALISE = "report"  # its entry of what is made of all stages

Entry = Mapping[str, Any]
Index = dict[str, dict[str, Any]]


def read_index(folder: Path) -> Index:
    """Entries of earlier runs; none where there is no index, or none that can be read."""
    try:
        found = parse_json(read_text(folder / INDEX))
    except (OSError, ValueError):
        return {}
    entries = found if isinstance(found, dict) else {}
    names = [*(stage.name for stage in STAGES), FINALISE]
    return {name: entries[name] for name in names if _is_entry(entries.get(name))}


def write_index(index: Index, folder: Path) -> None:
    """Write the index in one move.

    Raises
    ------
    InputError
        There is no room.
    """
    write_json(index, str(folder / INDEX), "file")


def _is_entry(entry: Any) -> bool:
    texts, seconds = ("status", "message", "fingerprint"), (int, float)
    if not isinstance(entry, dict) or not isinstance(entry.get("seconds"), seconds):
        return False
    return all(isinstance(entry.get(key), str) for key in texts)


def is_done(stage: Stage, study: Study, folder: Path, index: Mapping[str, Entry]) -> bool:
    """Whether the file of a stage is there, converged, and of this study."""
    return _holds(stage, study, index.get(stage.name, {})) and stage.file(folder).is_file()


def _holds(stage: Stage, study: Study, entry: Entry) -> bool:
    """Whether an entry is of a converged result for the same inputs."""
    own = study.fingerprint(*stage.sections)
    return bool(entry.get("fingerprint") == own and entry.get("status") == Status.CONVERGED)


def is_sound(stage: Stage, folder: Path, entry: Entry) -> bool:
    """Whether the file of a stage is as it was written, by its checksum."""
    return bool(entry.get("sha256") == checksum(stage.file(folder)))


def copied(stage: Stage, study: Study, folder: Path, others: Iterable[Path]) -> dict[str, Any] | None:
    """Copy the file of a stage from another folder that has it for the same inputs; its entry there, or None.

    Raises
    ------
    InputError
        There is no room for the copy.
    """
    for other in others:
        entry = read_index(other).get(stage.name, {})
        if other != folder and _holds(stage, study, entry) and is_sound(stage, other, entry):
            with replacing(stage.file(folder), "file") as temporary:
                shutil.copyfile(stage.file(other), temporary)
            return dict(entry)
    return None


def final_fingerprint(study: Study, index: Mapping[str, Entry]) -> str:
    """Hash of what results and report are made of: the whole study, names and all, and the files of its stages."""
    files = {stage.name: index.get(stage.name, {}).get("sha256") for stage in stages_of(study)}
    return key_of([study.model_dump(mode="json", exclude_none=True), study.fingerprint(), files])


def is_final(study: Study, folder: Path, index: Mapping[str, Entry]) -> bool:
    """Whether results, report, elements and FMUs are all there, as they were written, and of this study."""
    entry = index.get(FINALISE, {})
    files = entry.get("files")
    if not isinstance(files, dict) or entry.get("fingerprint") != final_fingerprint(study, index):
        return False
    return bool(entry.get("whole")) and all(checksum(folder / name) == kept for name, kept in files.items())
