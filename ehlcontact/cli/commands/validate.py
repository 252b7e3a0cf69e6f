"""``ehlcontact validate``: what a study will do, and its cost, without doing it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.table import Table

from ehlcontact.cli import options as o
from ehlcontact.cli.output import STDOUT, check_apart, check_json, check_place, say, show_table, write_json

if TYPE_CHECKING:
    from ehlcontact.cli.study.forecast import Forecast


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("validate")(validate)


def validate(
    study_file: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="What `run` would compute.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="DIR", help="Folder of the results; results/STUDY by default."),
    ] = None,
    jobs: Annotated[int, typer.Option("--jobs", min=1, max=16, help="Computations side by side.")] = 2,
    json_to: o.JsonTo = None,
) -> None:
    """Check a study file and say what `run` will do with it, and about how long it takes. Nothing is solved."""
    from ehlcontact.cli.study.forecast import forecast
    from ehlcontact.cli.study.schema import load_study

    study = load_study(study_file)
    check_json(json_to)
    check_apart({"--json": json_to}, (study_file,))
    folder = output if output is not None else Path("results") / study_file.stem
    check_place(folder)
    found = forecast(study, folder, min(jobs, os.cpu_count() or 1))
    write_json(found.to_dict(), json_to)
    _show(found, json_to)


def _show(found: Forecast, json_to: str | None) -> None:
    if json_to == STDOUT:
        return
    p, domain = found.operating_point, found.study.domain
    show_table(
        found.study.title,
        [
            ("M, L, kappa", f"{p['M']:.4g}, {p['L']:.4g}, {p['kappa']:.4g}", "most loaded ball"),
            ("load of that ball", f"{p['ball_load']:.4g} N", f"u_sum {p['u_sum']:.4g} m/s"),
            ("Hertz pressure", f"{p['p_hertz'] * 1e-9:.3g} GPa", ""),
            ("ellipse", f"{2e3 * p['a']:.3g} x {2e3 * p['b']:.3g} mm", "along rolling, across"),
            ("dry approach", f"{p['length'] * 1e6:.4g} µm", f"time unit 2a/u_sum {p['time'] * 1e6:.4g} µs"),
            ("central film", f"{p['h_central_expected'] * 1e6:.2g} µm", "by formula, incompressible"),
            ("rotor", f"{found.study.bearing.speed_rpm:g} rpm", f"Omega = {p['rotor_omega']:.3g}"),
            ("region", o.domain_text(domain), "Hertz semi-axes"),
        ],
        json_to,
    )
    _show_stages(found)
    for warning in found.warnings:
        say(f"warning: {warning}")
    say(f"whole study: about {_time(found.seconds)} with {found.jobs} side by side, good to a factor of two")


def _show_stages(found: Forecast) -> None:
    """One row per stage."""
    kappa = found.study.point.moes.kappa
    table = Table(pad_edge=False, box=None)
    for column in ("stage", "n", "nodes", "steps", "of T", "estimate"):
        table.add_column(column, justify="left" if column == "stage" else "right")
    for plan in found.plans:
        nodes = f"{plan.mesh.nodes(kappa):.0f}" + (f" x {plan.contacts}" if plan.contacts > 1 else "")
        cost = "kept" if plan.kept else "unknown" if plan.seconds is None else _time(plan.seconds)
        step = "" if plan.step is None else f"{plan.step:.3g}"
        table.add_row(plan.stage.title, str(plan.mesh.n), nodes, str(plan.steps or ""), step, cost)
    Console().print(table)


def _time(seconds: float) -> str:
    """Seconds, minutes or hours, to two figures."""
    if seconds < 90.0:
        return f"{seconds:.2g} s"
    minutes = seconds / 60.0
    return f"{minutes:.2g} min" if minutes < 90.0 else f"{minutes / 60.0:.2g} h"
