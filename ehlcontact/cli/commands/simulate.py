"""``ehlcontact simulate``: a motion drives the transient contact."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ehlcontact.checks import require_positive
from ehlcontact.cli import options as o
from ehlcontact.cli.output import FAILED, check_file, check_json, complain, progress, show_table, write_json
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.point import MoesPoint
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad, Motion, RampLoad

_MOTION, _TIME = "Motion (exactly one of --free, --harmonic, --ramp)", "Time"
_RESTART = "Restart"


def register(app: typer.Typer) -> None:
    """Add the subcommand."""
    app.command("simulate")(simulate)


def simulate(
    M: o.LoadM,
    L: o.OilL,
    kappa: o.Kappa,
    free: Annotated[
        float | None,
        typer.Option("--free", metavar="OMEGA_N", help="Free vibration.", rich_help_panel=_MOTION),
    ] = None,
    harmonic: Annotated[
        float | None,
        typer.Option("--harmonic", metavar="OMEGA", help="Harmonic load.", rich_help_panel=_MOTION),
    ] = None,
    ramp: Annotated[
        tuple[float, float] | None,
        typer.Option(
            "--ramp",
            metavar="RATIO DURATION",
            help="Load rising to RATIO; needs --omega-n.",
            rich_help_panel=_MOTION,
        ),
    ] = None,
    omega_n: Annotated[
        float | None,
        typer.Option(
            "--omega-n", help="Omega_n of the bodies, for --ramp and --harmonic.", rich_help_panel=_MOTION
        ),
    ] = None,
    offset: Annotated[
        float | None,
        typer.Option("--offset", help="Initial displacement, for --free.", rich_help_panel=_MOTION),
    ] = None,
    rate: Annotated[
        float | None, typer.Option("--rate", help="Initial rate, for --free.", rich_help_panel=_MOTION)
    ] = None,
    amplitude: Annotated[
        float | None,
        typer.Option("--amplitude", help="Of --harmonic; 0.1 by default.", rich_help_panel=_MOTION),
    ] = None,
    until: Annotated[
        float | None,
        typer.Option("--until", help="End; by default some periods.", rich_help_panel=_TIME),
    ] = None,
    dt: Annotated[
        float | None,
        typer.Option("--dt", help="Step (1/80 period); with --error, the first.", rich_help_panel=_TIME),
    ] = None,
    error: Annotated[
        float | None,
        typer.Option("--error", help="Control the step: local error per step.", rich_help_panel=_TIME),
    ] = None,
    alpha: o.Alpha = o.ALPHA,
    eta0: o.Eta0 = o.ETA0,
    viscosity: o.Viscosity = o.VISCOSITY,
    density: o.Density = o.DENSITY,
    n: o.ChosenIntervals = None,
    domain: o.Region = None,
    save: o.Save = None,
    figure: o.FigureTo = None,
    json_to: o.JsonTo = None,
    checkpoint: Annotated[
        Path | None,
        typer.Option(
            "--checkpoint", metavar="FILE", help="Keep a file to restart from.", rich_help_panel=_RESTART
        ),
    ] = None,
    restart: Annotated[
        Path | None,
        typer.Option(
            "--restart", metavar="FILE", help="Go on from a checkpoint of this run.", rich_help_panel=_RESTART
        ),
    ] = None,
) -> None:
    """Simulate the transient contact under a motion; Ctrl-C keeps what was computed."""
    from ehlcontact.storage import save as store
    from ehlcontact.transient.simulate import simulate as integrate

    point = MoesPoint(M, L, kappa, alpha, eta0, viscosity, density)
    region = o.region(domain, n)
    motion = choose_motion(free, harmonic, ramp, omega_n, offset, rate, amplitude)
    for name, value in (("until", until), ("dt", dt), ("error", error)):
        if value is not None:
            require_positive(name, value)
    check_file("--save", save, o.HDF5)
    check_file("--checkpoint", checkpoint, o.HDF5)
    check_file("--figure", figure, o.PICTURES)
    check_json(json_to)
    failure = ""
    with progress("transient film") as update:
        try:
            result = integrate(
                point,
                motion,
                n=n,
                domain=region,
                until=until,
                dT=dt,
                error=error,
                callback=update,
                checkpoint=checkpoint,
                restart=restart,
            )
        except ConvergenceError as stopped:
            result, failure = stopped.result, str(stopped)
    if save is not None:
        store(result, save)
    if figure is not None and result.steps:  # stopped before the first step, there is nothing to draw
        from ehlcontact.cli.plots.motion import simulation_figure
        from ehlcontact.cli.plots.style import write_figure

        write_figure(simulation_figure, result, figure)
    write_json(result.summary(), json_to)
    show_table(
        "transient film",
        [
            *o.point_rows(point),
            ("motion", motion.kind, ", ".join(f"{k} {v:g}" for k, v in _settings(motion))),
            ("static approach", f"{result.static_approach:.5f}", "of the dry Hertz approach"),
            ("approach", f"{result.approach.min():.4f} .. {result.approach.max():.4f}", ""),
            ("force", f"{result.force.min():.4f} .. {result.force.max():.4f}", "of the static load"),
            ("minimum film", f"{result.h_min.min():.5f}", "of the dry Hertz approach"),
            ("steps", f"{result.steps}", f"to T = {result.T[-1]:.4g}, {result.cycles[1:].mean():.1f} cycles each")
            if result.steps
            else ("steps", "0", ""),
            ("grid", f"{result.n}", f"on {o.domain_text(result.domain)}"),
            ("time", f"{result.seconds:.1f}", "s"),
            ("status", str(result.status), ""),
        ],
        json_to,
    )
    if not result.status.ok:
        message = failure or f"simulation {result.status} at T = {result.T[-1]:.6g}: {result.status.advice}"
        kept = [f"partial result in {save}"] if save else []
        kept += [f"go on with --restart {checkpoint}"] if checkpoint else []
        complain("; ".join([message, *kept]))
        raise typer.Exit(FAILED)


def choose_motion(
    free: float | None,
    harmonic: float | None,
    ramp: tuple[float, float] | None,
    omega_n: float | None,
    offset: float | None,
    rate: float | None,
    amplitude: float | None,
) -> Motion:
    """Motion that the options ask for.

    Raises
    ------
    InputError
        Not exactly one motion, or an option that belongs to another one.
    """
    motions = {"--free": free, "--harmonic": harmonic, "--ramp": ramp}
    chosen = [name for name, value in motions.items() if value is not None]
    if len(chosen) != 1:
        raise InputError("motion", " ".join(chosen) or None, "exactly one of --free, --harmonic, --ramp")
    allowed = {
        "--free": ("--offset", "--rate"),
        "--harmonic": ("--amplitude", "--omega-n"),
        "--ramp": ("--omega-n",),
    }
    given = {"--offset": offset, "--rate": rate, "--amplitude": amplitude, "--omega-n": omega_n}
    for name, value in given.items():
        if value is not None and name not in allowed[chosen[0]]:
            owners = " or ".join(motion for motion, names in allowed.items() if name in names)
            raise InputError(name, value, f"left out with {chosen[0]}: it belongs to {owners}")
    if free is not None:
        return FreeVibration(free, offset or 0.0, rate)
    if harmonic is not None:
        return HarmonicLoad(harmonic, 0.1 if amplitude is None else amplitude, omega_n)
    assert ramp is not None
    if omega_n is None:
        raise InputError("--omega-n", None, "given with --ramp: a finite number > 0")
    return RampLoad(*ramp, omega_n)


def _settings(motion: Motion) -> list[tuple[str, float]]:
    return [(k, v) for k, v in motion.to_dict().items() if isinstance(v, float | int)]
