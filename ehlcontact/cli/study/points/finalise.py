"""Finalisation of a point: fits, elements, FMUs, reduced rotors, results and report from its stages."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ehlcontact.assumptions import assumptions
from ehlcontact.cli.output import one_line, write_json
from ehlcontact.cli.study.answer import answer_of, over_frequency, run_models
from ehlcontact.cli.study.defect import defects_of
from ehlcontact.cli.study.differences import compare_rotors
from ehlcontact.cli.study.exports import export_fmu, write_exports
from ehlcontact.cli.study.forecast import films_words
from ehlcontact.cli.study.oil_and_heat import run_oil_and_heat
from ehlcontact.cli.study.periodic import branch_of
from ehlcontact.cli.study.reduction import RECORDS, contact_text, reduce_records, save_elements
from ehlcontact.cli.study.results import ContactFindings, Findings
from ehlcontact.cli.study.rotor import film_response
from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.study.stages import Answer, reporting
from ehlcontact.cli.study.uncertain import TABLE, uncertainty_of
from ehlcontact.content_store import checksum
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.files import parse_json, read_text
from ehlcontact.results import SteadyResult
from ehlcontact.status import Status
from ehlcontact.store import read
from ehlcontact.transient.result import SimulationResult

RESULTS, REPORT = "results.json", "report.html"
TITLE = "results and report"


def finalise_point(key: str, study: Study, folder: Path, seconds: Mapping[str, float]) -> Answer:
    """Compute results of a point and write them, with report, elements and FMUs, to its folder.

    Parameters
    ----------
    key : str
        Of the task, for the reports.
    study : Study
    folder : Path
        With the files of the stages.
    seconds : mapping
        Wall times of the stages.

    Returns
    -------
    Answer
        Beside status, message and seconds: ``whole``, whether all FMUs are there too; ``warnings``; ``bad_input``,
        whether the study is to blame, or there is no room; ``files``, their checksums by where they are.
    """
    from ehlcontact.cli.study.headline import document
    from ehlcontact.cli.study.report import write_report

    started = time.perf_counter()
    status, message = Status.FAILED, ""
    entry: dict[str, Any] = {"whole": False, "warnings": (), "bad_input": False, "files": {}}
    try:
        with reporting(), warnings.catch_warnings(record=True) as said:
            found = evaluate(study, folder, seconds)
            results = document(found)
            write_json(results, str(folder / RESULTS), "file")
            write_report(found, folder / REPORT)
        entry["warnings"] = tuple(dict.fromkeys(one_line(str(one.message)) for one in said))
        entry["files"] = {name: checksum(folder / name) for name in products(results).values()}
        entry["whole"], status = not _broken_fmus(results), Status.CONVERGED
    except KeyboardInterrupt:
        status, message = Status.INTERRUPTED, "stopped before it was done"
    except (InputError, ConvergenceError) as error:
        message, entry["bad_input"] = str(error), isinstance(error, InputError)
    return Answer({"status": str(status), "message": message, "seconds": time.perf_counter() - started, **entry})


def evaluate(study: Study, folder: Path, seconds: Mapping[str, float]) -> Findings:
    """Reduce, export and compare what the stages left in the folder; files are written on the way.

    `seconds` are the wall times of the stages.
    """
    times = dict(seconds)
    contact = rotors = None
    if study.contact is not None:
        with _timed(times, "elements, FMUs, reduced rotors"):
            contact = _contact(study, folder)
            rotors = contact.rotors
    with _timed(times, "machine"):
        machine = answer_of(study)
        small = over_frequency(study, machine)
    with _timed(times, "samples", study.uncertain is not None):
        uncertainty = uncertainty_of(study, machine, folder)
    with _timed(times, "machine in time on models", study.in_time is not None):
        whole = run_models(study, folder)
    branch = branch_of(study, folder)
    with _timed(times, "oil supply and heat", bool(films_words(study))):
        conditions = run_oil_and_heat(study)
    with _timed(times, "defects", bool(study.defect)):
        defects = defects_of(study)
    with _timed(times, "export", study.export is not None):
        exports = write_exports(study, folder)
    found = study, machine, small, whole, conditions, defects, contact, rotors, exports, times
    return Findings(*found, uncertainty, branch)


@contextmanager
def _timed(times: dict[str, float], name: str, noted: bool = True) -> Iterator[None]:
    """Note the wall time of a block."""
    started = time.perf_counter()
    yield
    if noted:
        times[name] = time.perf_counter() - started


def _contact(study: Study, folder: Path) -> ContactFindings:
    """Elements, FMUs and reduced rotors of what the stages left."""
    steady = read(folder / "steady.h5", SteadyResult)
    simulations = {name: read(folder / f"{name}.h5", SimulationResult) for name in RECORDS}
    assumed = assumptions(study.point, film=steady, roughness=study.roughness).short()
    response = film_response(study)
    known = {"assumptions": assumed, "contact": contact_text(study)}
    reduction = reduce_records(simulations, response, study.point.scales, known)
    save_elements(reduction, folder)
    exported = export_fmu(reduction.chosen, folder / "contact.fmu", study)
    film = reduction.memory_element
    exported_film = None if film is None else export_fmu(film, folder / "contact_film.fmu", study)
    rotors = None
    if study.full_films is not None:
        rotors = compare_rotors(study, response, reduction.rotor_elements, folder)
    return ContactFindings(study, steady, simulations, reduction, rotors, exported, exported_film)


def read_results(folder: Path) -> dict[str, Any]:
    """``results.json``, which `finalise` has written."""
    found = parse_json(read_text(folder / RESULTS))
    assert isinstance(found, dict)
    return found


def products(results: Mapping[str, Any]) -> dict[str, str]:
    """Files of the finalisation, relative to the folder, by their meaning."""
    made = {"results": RESULTS, "report": REPORT} | ({"samples": TABLE} if results.get("uncertainty") else {})
    if results.get("periodic"):
        made["periodic answers, table"] = results["periodic"]["file"]
    exports = results.get("export", {})
    for entry in (*(exports[name] for name in exports if name != "matrices"), *exports.get("matrices", ())):
        if entry.get("passes", True):
            made[entry["file"]] = entry["file"]
    if "fits" not in results:  # no contact
        return made
    for row in results["fits"]:
        if "refused" not in row:
            name = f"{row['record']}_{row['model']}"
            made[f"element {name}"] = f"elements/{name}.json"
    if "refused" not in results["memory"]:
        made["element memory"] = "elements/memory.json"
    for entry in (one for one in (results["fmu"], results["film_fmu"]) if one is not None):
        if entry["passes"]:
            made[f"FMU {Path(entry['file']).stem}"] = entry["file"]
    return made


def faults(results: Mapping[str, Any]) -> list[str]:
    """FMUs that could not be made and conditions of oil and heat without films, with reasons."""
    return [*_broken_fmus(results), *_without_films(results["oil_and_heat"])]


def _without_films(found: Mapping[str, Any]) -> list[str]:
    said = []
    for name, one in found.items():
        of = "the bearing" if len(found) == 1 else name
        if isinstance(one, str):
            said.append(f"oil supply and heat of {of}: {one}")
        else:
            said += [f"no films of {of} {key}: {reason}" for key, reason in one["refused"].items()]
    return said


def _broken_fmus(results: Mapping[str, Any]) -> list[str]:
    return [
        f"{entry['file']}: {entry.get('error') or 'differs from its model'}"
        for entry in _fmus(results)
        if not entry["passes"]
    ]


def _fmus(results: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    every = results.get("fmu"), results.get("film_fmu"), results.get("export", {}).get("fmu")
    return [entry for entry in every if entry is not None]
