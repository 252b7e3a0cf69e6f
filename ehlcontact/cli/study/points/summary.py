"""All points of a study in numbers, with units and files: ``summary.json``, ``summary.csv``; a page over them.

Two runs of one study give the same summary, however often they were interrupted: what differs between them, as
times do, stands under ``run``, and in ``run.log``.
"""

from __future__ import annotations

import base64
import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from textwrap import wrap
from typing import Any

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import plain
from ehlcontact.cli.page import write_page
from ehlcontact.cli.study.forecast import cautions
from ehlcontact.cli.study.periodic import Branch, branches_of
from ehlcontact.cli.study.points.finalise import REPORT, faults, products, read_results
from ehlcontact.cli.study.points.folder import LOG, versions
from ehlcontact.cli.study.points.kept import FINALISE, Entry
from ehlcontact.cli.study.points.lists import STUDY_FILE, Point
from ehlcontact.cli.study.points.numbers import MEANINGS, NUMBERS, UNITS, Number, numbers_of
from ehlcontact.cli.study.points.picture import draw_points
from ehlcontact.cli.study.sections import Support
from ehlcontact.cli.study.stages import Stage, stages_of
from ehlcontact.cli.study.uncertain import batches_of
from ehlcontact.errors import InputError
from ehlcontact.files import parse_json, read_text
from ehlcontact.status import Status
from reduced_models.life.bearing_life import finite
from reduced_models.life.system_life import HOURS, KIND_OF_LIFE, over_spectrum
from reduced_models.rotor.machine_tiles import digits
from reduced_models.rotor.support_state import RELY_ON_SKF

FORMAT = 1  # of the summary
SUMMARY, TABLE, PICTURE = "summary.json", "summary.csv", "summary.png"
HEAD = 10  # characters of a line of a head
# of a narrow table, in this order
LEFT_OUT = (
    "field", "capacitance", "l10rh", "lnmrh", "p_hertz", "ball_load", "decay_hz", "torque", "mode_hz", "response",
)  # fmt: skip
COLUMNS = {name: one for name, one in NUMBERS.items() if one.head}  # of the table for people


@dataclass(frozen=True)
class Row:
    """One point: status, numbers and files."""

    point: Point
    status: str
    messages: tuple[str, ...]  # by stages that did not converge, and why
    critical: tuple[str, ...]  # at its speed, and what changes it
    limits: tuple[str, ...]  # what does not hold
    warnings: tuple[str, ...]
    numbers: Mapping[str, float | None]  # by `UNITS`; None where not reached
    files: Mapping[str, str]  # by what they are, relative to the folder of the study
    stages: Mapping[str, str]  # how each ended
    answer: str | None
    faults: tuple[str, ...]  # what is missing in the results of a point that is done: `finalise.faults`
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)  # with [uncertain], of its numbers

    @property
    def ok(self) -> bool:
        """Whether its numbers can be relied on."""
        return self.status == Status.CONVERGED

    def to_dict(self) -> dict[str, Any]:
        """Content of its entry in ``summary.json``."""
        return {
            "name": self.point.name,
            "status": self.status,
            **({} if self.point.share is None else {"share": self.point.share}),
            "lists": {choice.entry: choice.value for choice in self.point.chosen},
            "messages": list(self.messages),
            "critical": list(self.critical),
            "does_not_hold": list(self.limits),
            "warnings": list(self.warnings),
            **self.numbers,
            **({"intervals": dict(self.intervals)} if self.intervals else {}),
            "answer": self.answer,
            "stages": dict(self.stages),
            "files": dict(self.files),
        }


def row_of(point: Point, ended: Mapping[str, Entry], root: Path) -> Row:
    """Row of a point from its folder and how its tasks ended."""
    computed: list[Stage | Branch] = [*stages_of(point.study), *branches_of(point.study)]
    batches = batches_of(point.study)
    names = [*(stage.name for stage in computed), *(batch.name for batch in batches), FINALISE]
    stages = {name: ended[name]["status"] for name in names if name in ended}
    lacking = [name for name, status in stages.items() if status != Status.CONVERGED]
    final = stages.get(FINALISE) == Status.CONVERGED
    results = read_results(point.folder) if final else None
    made = {"study": STUDY_FILE} | ({} if results is None else products(results))
    made |= {
        stage.title: stage.file(Path()).name for stage in computed if stages.get(stage.name) == Status.CONVERGED
    }
    made |= {
        f"{stage.title}, as far as it went": stage.partial(Path()).name
        for stage in computed
        if stage.name in lacking and stage.partial(point.folder).is_file()
    }
    below = point.folder.relative_to(root)
    broken = () if results is None else tuple(faults(results))
    return Row(
        point=point,
        status=str(Status.CONVERGED) if final else _worst(stages, lacking),
        messages=tuple(f"{name}: {stages[name]}: {ended[name]['message']}" for name in lacking),
        critical=() if results is None else tuple((results["machine"] or {}).get("concerns", ())),
        limits=() if results is None else tuple(results["does_not_hold"]),
        warnings=(
            *cautions(point.study),
            *ended.get(FINALISE, {}).get("warnings", ()),
            *broken,
        ),
        numbers=numbers_of(point, results),
        files={what: (below / name).as_posix() for what, name in made.items()},
        stages=stages,
        answer=None if results is None else results["answer"],
        faults=broken,
        intervals=_intervals(results),
    )


def _intervals(results: Mapping[str, Any] | None) -> dict[str, tuple[float, float]]:
    """Ends of the intervals of a point with [uncertain], by the names of its numbers."""
    found = None if results is None else results.get("uncertainty")
    if found is None:
        return {}
    known = {name: found["numbers"].get(found["nearest"].get(name, name)) for name in UNITS}
    return {name: (one["low"], one["high"]) for name, one in known.items() if one is not None}


def _worst(stages: Mapping[str, str], lacking: Sequence[str]) -> str:
    """Status of a point that is not finalised: of its first stage that did not converge."""
    return next((stages[name] for name in lacking), str(Status.INTERRUPTED))


def summary(rows: Sequence[Row], title: str, run: Mapping[str, Any]) -> dict[str, Any]:
    """Content of ``summary.json``; `run` is what may differ between two runs of one study."""
    first, several, first_share = rows[0].point.study, len(rows) > 1, rows[0].point.share
    files = {"study": STUDY_FILE, "summary": SUMMARY, "table": TABLE, "log": LOG}
    converged = sum(row.ok for row in rows)
    files |= {"report": REPORT} if several or converged else {}
    files |= {"picture": PICTURE} if several and converged else {}
    return {
        "format": FORMAT,
        "title": title,
        "bearing": ", ".join(_bearing(one) for one in first.support),
        "oil": None if first.oil is None else first.oil.label,
        "status": "converged" if converged == len(rows) else "not converged",
        "converged": converged,
        **({} if first_share is None else {"spectrum_life": life_over(rows)}),
        "units": UNITS,
        "meanings": MEANINGS,
        "points": [row.to_dict() for row in rows],
        "files": files,
        "versions": versions(),
        "run": dict(run),
    }


def life_over(rows: Sequence[Row]) -> dict[str, float | None]:
    """Rating lives over the load spectrum of the points [h]; None where a point that lasts has none."""
    shares = [row.point.share or 0.0 for row in rows]
    lives = {name: [row.numbers[name] for row in rows] for name in HOURS}
    return {name: finite(over_spectrum(shares, own)) for name, own in lives.items()}


def spectrum_words(rows: Sequence[Row]) -> str:
    """Rating lives over the load spectrum in words; empty where the points are none, or have no lives."""
    if rows[0].point.share is None:
        return ""
    lives = [(KIND_OF_LIFE[name], life) for name, life in life_over(rows).items() if life is not None]
    return "; ".join(f"{kind} {digits(life)} h" for kind, life in lives)


def _bearing(support: Support) -> str:
    """Name of a support and of its bearing."""
    beside = "" if support.bearing in (None, support.label) else f" {support.bearing}"
    return f"{support.label}{beside}"


def withdraw(folder: Path, names: Sequence[str], changes: bool) -> tuple[str, ...]:
    """Remove a summary that a run is about to make untrue, lest it is read if the run does not get to its end.

    Parameters
    ----------
    folder : Path
        Of the study.
    names : sequence of str
        Its points, as they are now.
    changes : bool
        Whether there is anything to do for them.

    Returns
    -------
    tuple of str
        Files that are gone.
    """
    try:
        found = [point["name"] for point in parse_json(read_text(folder / SUMMARY))["points"]]
    except (OSError, ValueError, KeyError, TypeError, InputError):  # none, or none of ours: what is there is old
        found = []
    if found == list(names) and not changes:
        return ()
    over_all = (REPORT,) if len(found) > 1 else ()  # else that of the point itself, which is made again
    gone = tuple(name for name in (SUMMARY, TABLE, PICTURE, *over_all) if (folder / name).is_file())
    for name in gone:
        (folder / name).unlink()
    return gone


def table(rows: Sequence[Row]) -> str:
    """Content of ``summary.csv``: a row per point, units in the first line; what was not reached is left empty.

    The last columns say in words how the point ended, what is critical, what does not hold, and its warnings,
    parted by semicolons.
    """
    chosen = [choice.head for choice in rows[0].point.chosen]
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    heads = (f"{name} [{unit}]" for name, unit in UNITS.items())
    sampled = [name for name in UNITS if any(name in row.intervals for row in rows)]
    ends = [f"{name} interval {end} [{UNITS[name]}]" for name in sampled for end in ("from", "to")]
    writer.writerow(["point", *chosen, *heads, *ends, "status", "critical", "does not hold", "warnings"])
    for row in rows:
        values = plain(dict(row.numbers))
        numbers = ("" if v is None else repr(float(v)) for v in values.values())
        between = (repr(end) for name in sampled for end in row.intervals.get(name, ("", "")))
        texts = ("; ".join(texts) for texts in (row.critical, row.limits, row.warnings))
        values_of_lists = (choice.value for choice in row.point.chosen)
        writer.writerow([row.point.name, *values_of_lists, *numbers, *between, row.status, *texts])
    return stream.getvalue()


def columns_of(rows: Sequence[Row]) -> dict[str, Number]:
    """Columns of a table for people, of numbers that some point has."""
    return {name: one for name, one in COLUMNS.items() if any(row.numbers[name] is not None for row in rows)}


def heads_of(rows: Sequence[Row], columns: Mapping[str, Number]) -> list[str]:
    """Heads of the number of a point, of lists, and of these columns."""
    return ["point", *(choice.head for choice in rows[0].point.chosen), *(one.head for one in columns.values())]


def cells(row: Row, columns: Mapping[str, Number]) -> list[str]:
    """What a point has of lists, and its numbers in words; a dash where there is none."""
    numbers = [
        " ".join(filter(None, (_shown(one, row.numbers[name]), _between(one, row.intervals.get(name)))))
        for name, one in columns.items()
    ]
    return [*(choice.shown for choice in row.point.chosen), *numbers]


def _shown(one: Number, value: float | None) -> str:
    return numeral(None if value is None else one.factor * value, one.figures)


def _between(one: Number, ends: tuple[float, float] | None) -> str:
    """The interval of a number in a table; empty where it has none."""
    return "" if ends is None or ends[0] == ends[1] else f"({_shown(one, ends[0])} to {_shown(one, ends[1])})"


def lines_of(rows: Sequence[Row], columns: Mapping[str, Number]) -> list[list[str]]:
    """Lines of a table in a terminal, heads with their units below; how points ended where not all converged."""
    heads = ["\n".join(_head_lines(head)) for head in heads_of(rows, columns)]
    lines = [[str(k + 1), *cells(row, columns)] for k, row in enumerate(rows)]
    if all(row.ok for row in rows):
        return [heads, *lines]
    return [[*heads, "status"], *([*line, row.status] for line, row in zip(lines, rows, strict=True))]


def _head_lines(head: str) -> list[str]:
    """Short lines of a head, its unit in one of its own."""
    label, _, unit = head.partition(" [")
    return [*wrap(label, HEAD, break_long_words=False), *([f"[{unit}"] if unit else [])]


def narrowed(rows: Sequence[Row], columns: Mapping[str, Number], width: int) -> dict[str, Number]:
    """Columns of a table of that many characters: those that can be missed most are left out."""
    kept = dict(columns)
    for name in ("", *LEFT_OUT):
        kept.pop(name, None)
        parts = (
            [len(line) for text in column for line in text.split("\n")]
            for column in zip(*lines_of(rows, kept), strict=True)
        )
        if sum(max(lengths) + 1 for lengths in parts) <= width:
            break
    return kept


def torque_jump(rows: Sequence[Row]) -> str:
    """Why the torque jumps between points at speeds below and above that of SKF's model; empty where none are."""
    speeds = [row.numbers["speed_rpm"] for row in rows if row.numbers["torque"] is not None]
    above = [speed is not None and speed > RELY_ON_SKF for speed in speeds]
    return NUMBERS["torque"].meaning if any(above) and not all(above) else ""


def said_of(rows: Sequence[Row], name: str) -> list[tuple[str, str]]:
    """Texts ``critical`` or ``limits`` of the points, each with "point 2" or "points 1, 3"; none where of all."""
    said: dict[str, list[str]] = {}
    for k, row in enumerate(rows):
        for text in getattr(row, name):
            said.setdefault(text, []).append(str(k + 1))
    return [
        (text, "" if len(of) == len(rows) else f"point{'s' if len(of) > 1 else ''} {', '.join(of)}")
        for text, of in said.items()
    ]


def write_overview(rows: Sequence[Row], document: Mapping[str, Any], folder: Path) -> Path:
    """Write the picture and the page; returns where the page is.

    Raises
    ------
    InputError
        One of them cannot be written.
    """
    picture, columns = "", columns_of(rows)
    if document["converged"]:
        draw_points(rows, folder / PICTURE)
        picture = base64.b64encode((folder / PICTURE).read_bytes()).decode("ascii")
    return write_page(
        folder / REPORT,
        "points.html.j2",
        {},
        picture=picture,
        summary=document,
        rows=rows,
        heads=heads_of(rows, columns),
        cells=partial(cells, columns=columns),
        legend=[(one.head.partition(" [")[0], one.meaning) for one in columns.values() if one.meaning],
        spectrum=spectrum_words(rows),
        labels=[one.label.partition(" [")[0] for one in columns.values() if one.label],
        critical=said_of(rows, "critical"),
        limits=said_of(rows, "limits"),
        messages=said_of(rows, "messages"),
        warnings=said_of(rows, "warnings"),
    )
