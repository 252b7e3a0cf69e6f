"""Finalisation of a point: fits, elements, FMUs, reduced rotors, results and report from its stages."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ehlcontact.cli.output import one_line, write_json
from ehlcontact.cli.study.schema import Study
from ehlcontact.content_store import checksum
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.files import parse_json, read_text
from ehlcontact.status import Status

RESULTS, REPORT = "results.json", "report.html"
TITLE = "elements, FMUs, rotors, report"


class Final(NamedTuple):
    """How the finalisation ended."""

    status: Status
    message: str = ""
    whole: bool = False  # also all FMUs
    warnings: tuple[str, ...] = ()
    bad_input: bool = False  # the study is to blame, or there is no room
    files: Mapping[str, str | None] = {}  # checksums, by where they are in the folder


def finalise(study: Study, folder: Path, seconds: Mapping[str, float]) -> Final:
    """Compute results of a point and write them, with report, elements and FMUs, to its folder.

    `seconds` are the wall times of its stages, whose files are there.
    """
    from ehlcontact.cli.study.headline import document
    from ehlcontact.cli.study.report import write_report
    from ehlcontact.cli.study.results import evaluate

    said: list[warnings.WarningMessage]
    try:
        with warnings.catch_warnings(record=True) as said:
            found = evaluate(study, folder, seconds)
            results = document(found)
            write_json(results, str(folder / RESULTS), "file")
            write_report(found, folder / REPORT)
    except KeyboardInterrupt:
        return Final(Status.INTERRUPTED, "stopped before it was done")
    except InputError as error:
        return Final(Status.FAILED, str(error), bad_input=True)
    except ConvergenceError as error:
        return Final(Status.FAILED, str(error))
    told = tuple(dict.fromkeys(one_line(str(one.message)) for one in said))
    files = {name: checksum(folder / name) for name in products(results).values()}
    return Final(Status.CONVERGED, "", not _broken_fmus(results), told, files=files)


def read_results(folder: Path) -> dict[str, Any]:
    """``results.json``, which `finalise` has written."""
    found = parse_json(read_text(folder / RESULTS))
    assert isinstance(found, dict)
    return found


def products(results: Mapping[str, Any]) -> dict[str, str]:
    """Files of the finalisation, relative to the folder, by their meaning."""
    made = {"results": RESULTS, "report": REPORT}
    for row in results["fits"]:
        if "refused" not in row:
            name = f"{row['record']}_{row['model']}"
            made[f"element {name}"] = f"elements/{name}.json"
            made[f"element {name}, SI"] = f"elements/{name}_si.json"
    if "refused" not in results["memory"]:
        made |= {"element memory": "elements/memory.json", "element memory, SI": "elements/memory_si.json"}
    for entry in _fmus(results):
        if entry["passes"]:
            made[f"FMU {Path(entry['file']).stem}"] = entry["file"]
    return made


def faults(results: Mapping[str, Any]) -> list[str]:
    """FMUs that could not be made and conditions of oil and heat without films, with reasons."""
    return [*_broken_fmus(results), *_without_films(results.get("oil_and_heat"))]


def _without_films(found: Mapping[str, Any] | str | None) -> list[str]:
    if found is None or isinstance(found, str):
        return [] if found is None else [f"oil supply and heat of the whole bearing: {found}"]
    return [f"no films of the whole bearing {key}: {reason}" for key, reason in found["refused"].items()]


def _broken_fmus(results: Mapping[str, Any]) -> list[str]:
    return [
        f"{entry['file']}: {entry.get('error') or 'differs from the element'}"
        for entry in _fmus(results)
        if not entry["passes"]
    ]


def _fmus(results: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [entry for entry in (results["fmu"], results["film_fmu"]) if entry is not None]
