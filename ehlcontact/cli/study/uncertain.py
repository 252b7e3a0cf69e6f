"""Samples of a study with [uncertain]: what is drawn, the machine of each draw, batches as tasks of a run."""

from __future__ import annotations

import csv
import io
import json
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import partial
from math import ceil, isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args, get_origin

from pydantic import ValidationError

from ehlcontact.cli.entries import is_several, keys_of, section_of
from ehlcontact.cli.study.answer import answer_of
from ehlcontact.cli.study.machine import carrier_of, disc_of
from ehlcontact.cli.study.schema_errors import brief, first_error
from ehlcontact.cli.study.stages import Answer, reporting
from ehlcontact.content_store import key_of
from ehlcontact.errors import InputError
from ehlcontact.files import parse_json, write_text
from ehlcontact.status import Status
from reduced_models.margins.result import Uncertainty
from reduced_models.margins.samples import Sample, sample_of
from reduced_models.margins.spread import draws, spread_of
from reduced_models.rotor.machine_state import MachineState

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study

SECTION = "uncertain"
# Sections that are no part of a machine; entries of all others may be uncertain
BESIDE = {"title", "contact", "full_films", "in_time", "defect", "periodic", "uncertain", "export"}
SETTINGS = "operation.shares", "operation.hz"  # of these, entries that are no input of the machine
BALANCE = {"unbalance", "balance_grade"}  # of a disc: one stands in place of the other
SIZE, BATCHES = 10, 400  # samples of a batch, or more where batches would be too many
COST = 130.0  # of a sample, a bearing, in convolutions
FILES, TABLE = "samples", "samples.csv"


def entries_of(study: Study) -> dict[str, list[tuple[str, int | None, str]]]:
    """Entries of a study that may be uncertain, by their names: section, number of its table, key.

    An entry of several tables is that of all of them by its plain name, and of one by that with the name of the
    support, or the number of the disc.
    """
    found: dict[str, list[tuple[str, int | None, str]]] = {}
    for section in sections_of(study):
        declared = type(study).model_fields[section].annotation
        tables: Sequence[Any] = getattr(study, section) if is_several(declared) else (getattr(study, section),)
        if not is_several(declared) and tables[0] is None:
            continue
        for key, field in keys_of(section_of(declared)).items():
            name = f"{section}.{key}"
            if not _is_number(field.annotation) or name in SETTINGS:
                continue
            if not is_several(declared):
                found[name] = [(section, None, key)]
                continue
            found[name] = [(section, k, key) for k in range(len(tables))]
            numbers = tuple(str(k + 1) for k in range(len(tables)))
            names = study.names if section == "support" else numbers
            found |= {f"{section}.{names[k]}.{key}": [(section, k, key)] for k in range(len(tables))}
    return found


def sections_of(study: Study) -> list[str]:
    """Sections that the machine of a study depends on."""
    return [name for name in type(study).model_fields if name not in BESIDE]


def _is_number(kind: Any) -> bool:
    """Whether an entry takes any number of a range: no whole number, no list."""
    return kind is float or (get_origin(kind) is not tuple and any(_is_number(part) for part in get_args(kind)))


def require_uncertain(study: Study) -> None:
    """Raise `InputError` for ranges that are none, of entries that are none, or that reach beyond these."""
    if study.uncertain is None:
        return
    given, known = study.uncertain.spreads, entries_of(study)
    if not given:
        allowed = 'at least one entry with its range, as "support.clearance" = [5.0, 15.0]'
        raise InputError(SECTION, None, allowed)
    places: dict[tuple[str, int | None, str], str] = {}
    for entry, value in given.items():
        field = f"{SECTION}.{entry}"
        if entry not in known:
            close = get_close_matches(entry, known, 1)
            hint = f"{close[0]}? " if close else ""
            allowed = f"{hint}an entry of [{'], ['.join(sections_of(study))}] that is a number, with its section"
            section, _, rest = entry.partition(".")
            name, _, key = rest.rpartition(".")
            if section == "support" and name not in study.names and f"{section}.{key}" in known:
                allowed = f'of a support: {", ".join(study.names)}; or "{section}.{key}", that of all'
            raise InputError(field, brief(value), allowed)
        for place in known[entry]:
            if place in places:
                raise InputError(field, brief(value), f"left out beside {places[place]}, which has it too")
            places[place] = entry
        found = spread_of(field, value)
        for share in (0.0, 1.0) if _has_ends(found) else (0.025, 0.975):
            try:
                _require_parts(machine_of(study, {entry: float(found.ppf(share))}))
            except InputError as error:
                raise InputError(field, error.value, f"{error.field} {error.allowed}") from None


def _require_parts(study: Study) -> None:
    """Raise `InputError` for parts of a machine that the library refuses: oil, bearings, discs."""
    _ = study.lubricant, study.roughness
    for k in range(len(study.support)):
        carrier_of(study, k, oil=False)
    for k in range(len(study.disc)):
        disc_of(study, k)


def highest_of(study: Study, entry: str, nominal: float) -> float:
    """Upper end of the range of an entry, or the nominal value where that is higher, or no range is given."""
    given = {} if study.uncertain is None else study.uncertain.spreads
    if entry not in given:
        return nominal
    found = spread_of(f"{SECTION}.{entry}", given[entry])
    return max(nominal, float(found.ppf(1.0 if _has_ends(found) else 0.975)))


def _has_ends(distribution: Any) -> bool:
    return all(isfinite(end) for end in distribution.support())


def machine_of(study: Study, values: dict[str, float]) -> Study:
    """The study of a machine with these values of uncertain entries, its sections checked.

    Raises
    ------
    InputError
        A value beyond the range of its entry.
    """
    from ehlcontact.cli.study.schema import Study

    document = study.model_dump(exclude_unset=True, exclude=BESIDE - {"title"})
    known = entries_of(study)
    for entry, value in values.items():
        for section, k, key in known[entry]:
            table = document.setdefault(section, {}) if k is None else document[section][k]
            table[key] = value
            for other in BALANCE - {key} if key in BALANCE else ():
                table.pop(other, None)
    for disc in document.get("disc", ()):
        if "balance_grade" in disc:
            disc.setdefault("balance_speed_rpm", study.highest_rpm)  # of one machine, at all of its speeds
        else:
            disc.pop("balance_speed_rpm", None)
    try:
        return Study.model_validate(document)
    except ValidationError as error:
        raise first_error(error, Study, document) from None


def rows_of(study: Study) -> list[list[float]]:
    """Values of the uncertain entries of all samples."""
    given = study.uncertain
    assert given is not None
    spreads = [spread_of(f"{SECTION}.{entry}", value) for entry, value in given.spreads.items()]
    return [[float(value) for value in row] for row in draws(spreads, given.samples, given.seed)]


@dataclass(frozen=True)
class Batch:
    """A few samples, a task of a run: of numbers `first` to `last`, from 0 and without the last."""

    first: int
    last: int

    @property
    def name(self) -> str:
        """Name among the tasks of a point."""
        return f"samples_{self.first + 1}"

    @property
    def title(self) -> str:
        """Name for people."""
        return f"samples {self.first + 1} to {self.last}"

    def cost(self, study: Study) -> float:
        """Estimated, in convolutions."""
        return COST * (self.last - self.first) * len(study.support)

    def key(self, study: Study) -> str:
        """Hash of what it computes: the machine without its uncertain entries, and their values."""
        given = study.uncertain
        assert given is not None
        machine = study.model_dump(mode="json", exclude_none=True, exclude=BESIDE)
        known = entries_of(study)
        for section, k, key in (place for entry in given.spreads for place in known[entry]):
            (machine[section] if k is None else machine[section][k]).pop(key, None)
        return key_of(
            [FILES, machine, study.highest_rpm, list(given.spreads), study.sample_rows[self.first : self.last]]
        )

    def file(self, folder: Path) -> Path:
        """Where its samples stand."""
        return folder / FILES / f"{self.first + 1}.json"

    def partial(self, folder: Path) -> Path:
        """Where samples stand that did not get to the end."""
        return folder / FILES / f"{self.first + 1}.partial.json"


def batches_of(study: Study) -> tuple[Batch, ...]:
    """Batches of the samples of a study; none without [uncertain]."""
    if study.uncertain is None:
        return ()
    count = study.uncertain.samples
    size = max(SIZE, ceil(count / BATCHES))
    return tuple(Batch(first, min(first + size, count)) for first in range(0, count, size))


def solve_batch(key: str, study: Study, batch: Batch, begun: bytes = b"") -> Answer:
    """Answer the samples of a batch, on this machine or on a cluster; `key` is for the reports.

    What was `begun` is not answered again; an interrupted batch returns what it has.
    """
    started = time.perf_counter()
    entries = list(study.uncertain.spreads) if study.uncertain is not None else []
    samples: list[dict[str, Any]] = parse_json(begun) if begun else []
    status, message = Status.CONVERGED, Status.CONVERGED.advice
    rows = study.sample_rows[batch.first : batch.last]
    try:
        with reporting() as update:
            for row in rows[len(samples) :]:
                update(len(samples), len(rows))
                values = dict(zip(entries, row, strict=True))
                samples.append(sample_of(row, partial(_answer, study, values))._asdict())
    except KeyboardInterrupt:
        status, message = Status.INTERRUPTED, f"stopped after {len(samples)} of {len(rows)} samples"
    content = json.dumps(samples).encode() if samples else None
    return Answer({"status": str(status), "message": message, "seconds": time.perf_counter() - started}, content)


def _answer(study: Study, values: dict[str, float]) -> MachineState | str:
    return answer_of(machine_of(study, values), fine=False)


def uncertainty_of(study: Study, machine: MachineState | str, folder: Path) -> Uncertainty | None:
    """The samples that batches left in the folder, beside the machine as the file has it; their table is written.

    None without [uncertain].
    """
    if study.uncertain is None:
        return None
    samples = [
        Sample(**sample) for batch in batches_of(study) for sample in parse_json(batch.file(folder).read_bytes())
    ]
    entries = tuple(study.uncertain.spreads)
    found = Uncertainty.of(entries, samples, sample_of([], lambda: machine), study.uncertain.seed)
    write_text(folder / TABLE, _table(found), "file")
    return found


def _table(found: Uncertainty) -> str:
    """Content of ``samples.csv``: a row for each sample; what it does not have is left empty."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    columns = found.columns()
    writer.writerow(["sample", *columns, "failure", "beyond the data"])
    writer.writerows(_rows(found, columns))
    return stream.getvalue()


def _rows(found: Uncertainty, columns: dict[str, Any]) -> Iterator[list[Any]]:
    for k, (failure, beyond) in enumerate(zip(found.failures, found.beyond, strict=True)):
        own = [float(column[k]) for column in columns.values()]
        yield [k + 1, *(repr(value) if isfinite(value) else "" for value in own), failure, beyond]
