"""``ehlcontact validate``: what a study will do, and its cost, without doing it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ehlcontact.cli import options as o
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import STDOUT, check_place, say, show_columns, show_table
from ehlcontact.cli.rows import Row, domain_text

if TYPE_CHECKING:
    from ehlcontact.cli.study.forecast import Forecast
    from ehlcontact.cli.study.points.lists import Point


@o.grouped
def validate(out: o.Output, options: o.StudyOptions) -> None:
    """Check a study file and say what `run` will do with it, and about how long it takes. Nothing is solved."""
    from ehlcontact.cli.study.forecast import forecast
    from ehlcontact.cli.study.points.lists import load_points

    study_file, folder = options.study_file, options.folder
    points = load_points(study_file, folder)
    out.check(study_file)
    check_place(folder)
    found = [forecast(point.study, point.folder, options.side_by_side, folder) for point in points]
    if len(found) == 1:
        out.deliver(found[0].to_dict(), partial(_show, found[0], out.json_to))
        return
    document = whole(points, found, folder)
    out.deliver(document, partial(_show_points, document, out.json_to))


def whole(points: Sequence[Point], found: Sequence[Forecast], folder: Path) -> dict[str, Any]:
    """What a study of several points will do."""
    warnings: dict[str, list[str]] = {}
    for point, one in zip(points, found, strict=True):
        for text in one.warnings:
            warnings.setdefault(text, []).append(point.name)
    compiling = max(one.compiling for one in found)  # once for all
    return {
        "title": points[0].study_title,
        "folder": str(folder),
        "points": [
            {"name": point.name, "speed_rpm": point.study.speed_rpm}
            | {"radial_load": point.study.operation.radial_load}
            | one.to_dict()
            for point, one in zip(points, found, strict=True)
        ],
        "jobs": found[0].jobs,
        "compiling_seconds": compiling,
        "seconds": sum(one.work for one in found) / found[0].jobs + compiling,
        "warnings": [f"{', '.join(names)}: {text}" for text, names in warnings.items()],
    }


def _show_points(document: Mapping[str, Any], json_to: str | None) -> None:
    """One row per point."""
    if json_to == STDOUT:
        return
    rows = []
    of_film = ("M", "L", "kappa", "p_h [GPa]", "h_c by formula [µm]", "kept")
    for one in document["points"]:
        contact = (
            [] if one["operating_point"] is None else [*_numbers(one["operating_point"]), _kept(one["stages"])]
        )
        rows.append([one["name"], *contact, _time(one["seconds"])])
    heads = ("point", *(of_film if len(rows[0]) > len(("point", "to do")) else ()), "to do")
    show_columns(heads, rows, document["title"], named=True)
    for films in sorted({one["films"] for one in document["points"]} - {""}):
        say(f"bearing: beside flooded isothermal films also {films}")
    for warning in document["warnings"]:
        say(f"warning: {warning}")
    _say_whole(document["seconds"], document["jobs"], document["compiling_seconds"])


def _kept(stages: Sequence[Mapping[str, Any]]) -> str:
    """How many stages of a point are kept."""
    return f"{sum(stage['kept'] for stage in stages)} of {len(stages)}"


def _numbers(p: Mapping[str, Any]) -> list[str]:
    """Of the contact of a point."""
    numbers = (numeral(p[key]) for key in ("M", "L", "kappa"))
    return [*numbers, numeral(p["p_hertz"] * 1e-9, 3), numeral(p["h_central_expected"] * 1e6, 2)]


def _say_whole(seconds: float, jobs: int, compiling: float) -> None:
    once = f", {_time(compiling)} of it to compile the solver, which later runs need not" if compiling else ""
    idle = "good to a factor of two on cores with nothing else to do"
    say(f"whole study: about {_time(seconds)}, {jobs} side by side{once}; {idle}")


def _show(found: Forecast, json_to: str | None) -> None:
    if json_to == STDOUT:
        return
    study = found.study
    rows = [
        (name, one.bearing or one.label, "" if one.position_mm is None else f"at {numeral(one.position_mm)} mm")
        for name, one in zip(study.names, study.support, strict=True)
    ]
    show_table(study.title, [*rows, ("speed", f"{numeral(study.speed_rpm)} rpm", "")], json_to)
    if found.operating_point is not None:
        show_table("contact of the most loaded ball", _contact(found, found.operating_point), json_to)
        _show_stages(found)
    if (given := study.uncertain) is not None:
        of = ", ".join(given.spreads)
        say(f"{given.samples} samples of {of}: about {_time(found.samples)} of one processor")
    if (asked := study.periodic) is not None:
        span = f"{numeral(asked.from_rpm, 6)} to {numeral(asked.to_rpm, 6)} rpm"
        say(f"periodic answers to {asked.excitation}, {span}: about {_time(found.branch)} of one processor")
    if found.films:
        say(f"bearing: beside flooded isothermal films also {found.films}")
    for warning in found.warnings:
        say(f"warning: {warning}")
    _say_whole(found.seconds, found.jobs, found.compiling)


def _contact(found: Forecast, p: Mapping[str, Any]) -> list[Row]:
    """The contact that films are computed of."""
    width = "length along rolling, width across"
    return [
        ("M, L, kappa", ", ".join(numeral(p[key]) for key in ("M", "L", "kappa")), "most loaded ball"),
        ("load of that ball", f"{numeral(p['ball_load'])} N", f"u_sum {numeral(p['u_sum'])} m/s"),
        ("Hertz pressure", f"{numeral(p['p_hertz'] * 1e-9, 3)} GPa", ""),
        ("ellipse", f"{numeral(2e3 * p['a'], 3)} x {numeral(2e3 * p['b'], 3)} mm", width),
        (
            "dry approach",
            f"{numeral(p['length'] * 1e6)} µm",
            f"time unit 2a/u_sum {numeral(p['time'] * 1e6)} µs",
        ),
        ("central film", f"{numeral(p['h_central_expected'] * 1e6, 2)} µm", "by formula, incompressible"),
        ("shaft's Ω", numeral(p["rotor_omega"], 3), "ω 2a/u_sum"),
        ("region", domain_text(found.study.domain), ""),
    ]


def _show_stages(found: Forecast) -> None:
    """One row per stage, from the compilation of kernels to the report."""
    from ehlcontact.cli.study.points.finalise import TITLE

    rows = []
    for plan in found.plans:
        nodes = f"{plan.mesh.nodes:.0f}" + (f" x {plan.contacts}" if plan.contacts > 1 else "")
        cost = "kept" if plan.kept else _time(plan.seconds)
        step = "" if plan.step is None else numeral(plan.step, 3)
        rows.append([plan.stage.title, str(plan.mesh.n), nodes, str(plan.steps or ""), step, cost])
    blank = [""] * 4
    if found.compiling:
        rows.insert(0, ["compiling, once", *blank, _time(found.compiling)])
    rows.append([TITLE, *blank, "kept" if found.closed else _time(found.closing)])
    show_columns(("stage", "n", "nodes", "steps", "step in T", "wall time"), rows, named=True)


def _time(seconds: float) -> str:
    """Seconds, minutes or hours, to two figures."""
    if seconds < 90.0:
        return f"{numeral(seconds, 2)} s"
    minutes = seconds / 60.0
    return f"{numeral(minutes, 2)} min" if minutes < 90.0 else f"{numeral(minutes / 60.0, 2)} h"
