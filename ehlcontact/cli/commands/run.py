"""``ehlcontact run``: a study file to elements, FMUs, rotor comparison and report, at one point or at several."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ehlcontact.checks.machine import require_threads
from ehlcontact.cli import options as o
from ehlcontact.cli.output import (
    FAILED,
    STDOUT,
    USAGE,
    complain,
    prepare_folder,
    say,
    show_columns,
    write_json,
)
from ehlcontact.errors import InputError
from ehlcontact.files import remove_leftovers, write_text
from ehlcontact.point import moes_point
from ehlcontact.process.early_interrupt import INTERRUPTED

if TYPE_CHECKING:
    from ehlcontact.cli.study.points.folder import Log
    from ehlcontact.cli.study.points.lists import Point
    from ehlcontact.cli.study.points.summary import Row
    from ehlcontact.cli.study.runner import Scheduler, Share
    from ehlcontact.cli.study.schema import Study


@o.grouped
def run(
    out: o.Output,
    options: o.StudyOptions,
    threads: Annotated[int, typer.Option("--threads", help="Threads of each, at most the cores.")] = 1,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Solve the stages on this Dask cluster.")
    ] = None,
    force: Annotated[
        bool,
        typer.Option("--force", help="Replace the results of another study, from another file, in the folder."),
    ] = False,
) -> None:
    """Do a whole study: steady film, transients, elements, FMUs, rotor, report.

    With lists of speeds, loads or other values at every point of them, and a report over all. Run it again to
    resume: what is finished in the folder and belongs to the same study is kept, and after a change only what
    changed is done.
    """
    from ehlcontact.cli.study.points.lists import load_points
    from ehlcontact.cli.study.points.origin import require_own, write_studies

    study_file, folder = options.study_file, options.folder
    points = load_points(study_file, folder)
    require_threads("threads", threads)
    for point in points:
        _require_room(point.study, study_file)
    out.check(study_file)
    changed = require_own(study_file, folder, force=force)
    if scheduler is not None:
        from ehlcontact.executors import require_scheduler

        require_scheduler(scheduler)
    prepare_folder(folder)

    from ehlcontact.cli.study.points.folder import LOG, Log, locked
    from ehlcontact.cli.study.runner import Share

    with locked(folder):
        write_studies(points, study_file, folder)
        log = Log(folder / LOG)
        if changed:
            complain(f"the study changed since the last run in {folder}: {changed}")
            log.line("changed", changed)
        share = Share(options.side_by_side, threads, scheduler)
        done, seconds = _compute(points, folder, share, log)
        _tell(points, folder, done, seconds, out.json_to)


def _require_room(study: Study, path: Path) -> None:
    """Raise `InputError` for a grid of the study that would not fit into memory."""
    from ehlcontact.solver.mesh import Mesh, Solve

    if study.contact is None:
        return
    for name, solve in (("n", Solve.CYCLES), ("n_transient", Solve.IMPEDANCE)):
        try:
            Mesh(getattr(study.contact, name), study.domain, moes_point(study.point).kappa).require_memory(solve)
        except InputError as error:
            raise InputError(f"{path}: contact.{name}", error.value, error.allowed) from None


def _compute(points: Sequence[Point], folder: Path, share: Share, log: Log) -> tuple[Scheduler, float]:
    """Everything that is not done yet, and how long it took [s]."""
    from ehlcontact.cli.study.points.folder import versions
    from ehlcontact.cli.study.runner import StorageError, run_points

    started = time.perf_counter()
    where = share.cluster or f"{share.jobs} side by side, threads of each: {share.threads}"
    log.line("run", f"{folder}, points: {len(points)}, {where}")
    log.line("versions", ", ".join(f"{name} {number}" for name, number in versions().items()))
    try:
        done = run_points(points, folder, share, log)
    except StorageError as error:
        log.line("stopped", str(error))
        complain(f"{error}; what was computed before is in {folder}, the same command resumes")
        raise typer.Exit(USAGE) from None
    except KeyboardInterrupt:
        log.line("stopped", "interrupted")
        complain(f"interrupted; what was computed is in {folder}, the same command resumes")
        raise typer.Exit(INTERRUPTED) from None
    return done, time.perf_counter() - started


def _tell(points: Sequence[Point], folder: Path, done: Scheduler, seconds: float, json_to: str | None) -> None:
    """Summary, table and report of all points; what failed, by the exit code too."""
    from ehlcontact.cli.study.points import summary as s
    from ehlcontact.cli.study.points.finalise import REPORT, read_results

    rows = [s.row_of(point, done.ended[point.name], folder) for point in points]
    several, log = len(rows) > 1, done.log
    run = {"seconds": seconds, "solved": done.solved, "kept": done.kept, "warnings": log.warnings}
    document = s.summary(rows, points[0].study_title, run)
    write_json(document, str(folder / s.SUMMARY), "file")
    write_text(folder / s.TABLE, s.table(rows), "file")
    failed = [(row, text) for row in rows for text in row.messages]
    for row, text in failed:
        log.warn(row.point.titled(f"{text}; what was reached is in {row.point.folder}"))
    for row in rows:
        for text in row.faults:
            log.warn(row.point.titled(f"{text}; the rest is in {row.point.folder}"))
    if several:
        report = s.write_overview(rows, document, folder)
        _show(rows, json_to)
        write_json(document, json_to)
    elif failed:
        write_json({"status": "not converged", "stages": done.ended[rows[0].point.name]}, json_to)
    else:
        report = folder / REPORT
        write_json(read_results(folder), json_to)
        say(str(rows[0].answer), json_to)
    if several or not failed:
        say(f"report: {report}", json_to)
    for row in rows:  # of runs that were killed
        remove_leftovers(row.point.folder)
        remove_leftovers(row.point.folder / "elements")
    remove_leftovers(folder)
    log.line("done", f"{len(done.solved)} solved, {len(done.kept)} kept, {seconds:.1f} s")
    if failed or any(row.faults for row in rows):
        bad_input = not several and any(
            done.ended[row.point.name].get("report", {}).get("bad_input") for row in rows
        )
        raise typer.Exit(USAGE if bad_input else FAILED)


def _show(rows: Sequence[Row], json_to: str | None) -> None:
    """A row per point, what is critical and what does not hold, unless JSON goes to stdout."""
    if json_to == STDOUT:
        return
    from rich.console import Console

    from ehlcontact.cli.study.points.summary import (
        columns_of,
        lines_of,
        narrowed,
        said_of,
        spectrum_words,
        torque_jump,
    )

    columns = narrowed(rows, columns_of(rows), Console().width)
    heads, *lines = lines_of(rows, columns)
    heads = [head.replace("[", "\\[") for head in heads]  # which rich would take for a style
    show_columns(heads, lines, rows[0].point.study_title, padding=(0, 1, 0, 0))
    if "torque" in columns and (why := torque_jump(rows)):
        say(f"torque: {why}", json_to)
    if spectrum := spectrum_words(rows):
        say(f"rating life over the load spectrum: {spectrum}", json_to)
    for words, name in (("critical", "critical"), ("does not hold", "limits")):
        for text, points in said_of(rows, name):
            say(f"{words}{f', {points}' if points else ''}: {text}", json_to)
