"""``ehlcontact run``: a study file to elements, FMUs, rotor comparison and report."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ehlcontact.checks.machine import require_threads
from ehlcontact.cli import options as o
from ehlcontact.cli.output import FAILED, USAGE, check_apart, check_json, complain, prepare_folder, say, write_json
from ehlcontact.errors import InputError
from ehlcontact.files import read_text, write_text
from ehlcontact.point import moes_point
from ehlcontact.status import Status

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study

STUDY_COPY = "study.toml"


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("run")(run)


def run(
    study_file: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="What to compute; see examples/.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="DIR", help="Folder of the results; results/STUDY by default."),
    ] = None,
    jobs: Annotated[int, typer.Option("--jobs", min=1, max=16, help="Computations side by side.")] = 2,
    threads: Annotated[int, typer.Option("--threads", help="Threads of each, at most the cores.")] = 1,
    json_to: o.JsonTo = None,
) -> None:
    """Do a whole study: steady film, transients, elements, FMUs, rotor, report.

    Run it again to resume: what is finished in the folder and belongs to the same study is kept.
    """
    from ehlcontact.cli.study.schema import load_study

    study = load_study(study_file)
    folder = output if output is not None else Path("results") / study_file.stem
    require_threads("threads", threads)
    _require_room(study, study_file)
    check_json(json_to)
    check_apart({"--json": json_to}, (study_file,))
    prepare_folder(folder)
    copy = folder / STUDY_COPY
    if not copy.exists() or not copy.samefile(study_file):
        write_text(copy, read_text(study_file), "file")

    from ehlcontact.cli.study.runner import StorageError

    try:
        _compute(study, copy, folder, (min(jobs, os.cpu_count() or 1), threads), json_to)
    except StorageError as error:
        complain(f"{error}; what was computed before is in {folder}, the same command resumes")
        raise typer.Exit(USAGE) from None
    except KeyboardInterrupt:
        complain(f"interrupted; what was computed is in {folder}, the same command resumes")
        raise typer.Exit(FAILED) from None


def _require_room(study: Study, path: Path) -> None:
    """Raise `InputError` for a grid of the study that would not fit into memory."""
    from ehlcontact.solver.memory import Solve
    from ehlcontact.solver.mesh import Mesh, require_room

    for name, solve in (("n", Solve.CYCLES), ("n_transient", Solve.IMPEDANCE)):
        try:
            require_room(Mesh(getattr(study.solver, name), study.domain), moes_point(study.point), solve)
        except InputError as error:
            raise InputError(f"{path}: solver.{name}", error.value, error.allowed) from None


def _compute(study: Study, copy: Path, folder: Path, share: tuple[int, int], json_to: str | None) -> None:
    """Stages, so many side by side with so many threads each, then elements, FMUs, reduced rotors and report."""
    from ehlcontact.cli.study.runner import run_stages

    ledger = run_stages(study, copy, folder, *share)
    failed = {name: note for name, note in ledger.items() if note["status"] != Status.CONVERGED}
    if failed:
        for name, note in failed.items():
            complain(f"{name}: {note['status']}: {note['message']}; what was reached is in {folder}")
        write_json({"status": "not converged", "stages": ledger}, json_to)
        raise typer.Exit(FAILED)

    from ehlcontact.cli.progress import progress
    from ehlcontact.cli.study.report import write_report
    from ehlcontact.cli.study.results import evaluate

    with progress("elements, their rotors and FMUs"):
        found = evaluate(study, folder, ledger)
    write_json(found.to_dict(), str(folder / "results.json"), "file")
    write_json(found.to_dict(), json_to)
    with progress("report"):
        report = write_report(found, folder / "report.html")
    say(f"{found.answer}\nreport: {report}", json_to)
    missing = [entry for entry in found.fmus if not entry["passes"]]
    for entry in missing:
        complain(f"{entry['file']}: {entry.get('error') or 'differs from the element'}; the rest is in {folder}")
    if missing:
        raise typer.Exit(FAILED)
