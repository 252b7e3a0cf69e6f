"""``ehlcontact steady``: the film under constant load."""

from __future__ import annotations

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.output import FAILED, check_file, check_json, complain, progress, show_table, write_json
from ehlcontact.point import MoesPoint


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("steady")(steady)


def steady(
    M: o.LoadM,
    L: o.OilL,
    kappa: o.Kappa,
    alpha: o.Alpha = o.ALPHA,
    eta0: o.Eta0 = o.ETA0,
    viscosity: o.Viscosity = o.VISCOSITY,
    density: o.Density = o.DENSITY,
    n: o.ChosenIntervals = None,
    domain: o.Region = None,
    save: o.Save = None,
    figure: o.FigureTo = None,
    json_to: o.JsonTo = None,
) -> None:
    """Solve the steady film of a contact."""
    from ehlcontact.steady import solve_steady
    from ehlcontact.storage import save as store

    point = MoesPoint(M, L, kappa, alpha, eta0, viscosity, density)
    region = o.region(domain, n)
    check_file("--save", save, o.HDF5)
    check_file("--figure", figure, o.PICTURES)
    check_json(json_to)
    with progress("steady film") as update:
        result = solve_steady(
            point,
            n=n,
            domain=region,
            throw=False,
            callback=lambda cycle, residual: update(cycle, None, f"cycle {cycle}, residual {residual:.1e}"),
        )
    if save is not None:
        store(result, save)
    if figure is not None:
        from ehlcontact.cli.plots.film import steady_figure
        from ehlcontact.cli.plots.style import write_figure

        write_figure(steady_figure, result, figure)
    write_json(result.summary(), json_to)
    show_table(
        "steady film",
        [
            *o.point_rows(point),
            ("approach", f"{result.approach:.5f}", "of the dry Hertz approach"),
            ("central film", f"{result.h_central:.5f}", "of the dry Hertz approach"),
            ("minimum film", f"{result.h_min:.5f}", "of the dry Hertz approach"),
            ("maximum pressure", f"{result.p_max:.4f}", "of the Hertz pressure"),
            ("residual", f"{result.residual:.1e}", "of the dry start's"),
            ("load balance", f"{result.load_residual:.1e}", "of the load"),
            ("cycles", f"{result.cycles}", f"n = {result.n} on {o.domain_text(result.domain)}"),
            ("time", f"{result.seconds:.2f}", "s"),
            ("status", str(result.status), ""),
        ],
        json_to,
    )
    if not result.status.ok:
        kept = f"; partial result in {save}" if save else ""
        complain(f"{result.status}: {result.status.advice}{kept}")
        raise typer.Exit(FAILED)
