"""What is computed of a study, in one store by content: stages of all points, and what is made of them.

A stage is found by its inputs, whatever point asks for it and wherever its file belongs.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ehlcontact.cli.study.periodic import Branch, branches_of
from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.study.stages import Stage, stages_of
from ehlcontact.cli.study.uncertain import Batch, batches_of
from ehlcontact.content_store import ContentStore, checksum, key_of
from ehlcontact.files import parse_json

STORE = "store"  # folder of the entries, in that of the study
BEGUN = "-begun"  # at the end of the key of a batch that was interrupted
FINALISE = "report"  # name of what is made of all stages

Entry = dict[str, Any]  # status, message and seconds of a task, and what else it has to say


def stage_key(stage: Stage | Batch | Branch, study: Study) -> str:
    """Key of a stage: the hash of its inputs."""
    if not isinstance(stage, Stage):
        return stage.key(study)
    return key_of([stage.name, study.fingerprint(*stage.parts)])


def final_key(study: Study) -> str:
    """Key of results and report: the hash of the whole study, names and all, and of its stages."""
    tasks: tuple[Stage | Batch | Branch, ...] = (*stages_of(study), *branches_of(study), *batches_of(study))
    stages = [stage_key(task, study) for task in tasks]
    return key_of([FINALISE, study.model_dump(mode="json", exclude_none=True), stages])


class Kept:
    """Entries of converged stages with the content of their files, and of finalised points.

    Parameters
    ----------
    root : Path
        Folder of the study.

    Raises
    ------
    InputError
        There is no room for the store.
    """

    def __init__(self, root: Path) -> None:
        self._store = ContentStore(root / STORE, "folder")

    def get(self, key: str) -> tuple[Entry, bytes] | None:
        """Entry of a task and content of its file; None where it is not computed, or damaged."""
        found = self._store.get(key)
        if found is None:
            return None
        entry, _, content = found.partition(b"\n")
        return parse_json(entry.decode()), content

    def put(self, key: str, entry: Entry, content: bytes = b"") -> None:
        """Keep a converged task; raises `InputError` where there is no room."""
        self._store.put(key, json.dumps(entry).encode() + b"\n" + content)

    def final(self, study: Study, folder: Path) -> Entry | None:
        """Entry of a finalised point whose results, report, elements and FMUs are all as they were written."""
        found = self.get(final_key(study))
        if found is None or any(checksum(folder / name) != kept for name, kept in found[0]["files"].items()):
            return None
        return found[0]

    def is_damaged(self, key: str) -> bool:
        """Whether a task is there, but not as it was written."""
        return (self._store.folder / key).exists() and self.get(key) is None
