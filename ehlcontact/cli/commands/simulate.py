"""``ehlcontact simulate``: a motion drives the transient contact."""

from __future__ import annotations

from functools import partial
from os.path import realpath
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import typer

from ehlcontact.cli import entries as e
from ehlcontact.cli import options as o
from ehlcontact.cli.contact import NO_TIME, Contact, ContactAnswer, FilmConditions, Surfaces
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import FAILED, complain
from ehlcontact.cli.progress import progress
from ehlcontact.cli.rows import Row, in_unit, quantity_rows, run_rows, share_text
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.point import OperatingPoint, Point
from ehlcontact.process.early_interrupt import INTERRUPTED
from ehlcontact.status import Status
from ehlcontact.summary import film_unit
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.checkpoint import CheckpointError
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad, RampLoad
from ehlcontact.transient.settings import KeepSettings, RunSettings, TimeSteps

if TYPE_CHECKING:
    from ehlcontact.transient.result import SimulationResult

_MOTION, _TIME = "Motion (exactly one of --free, --harmonic, --ramp; of a bearing also in Hz)", "Time"
_RESTART = "Restart"


class MotionOptions(o.Options):
    """What drives the contact."""

    panel: ClassVar[str | None] = _MOTION
    free: Annotated[
        float | None, typer.Option("--free", metavar="OMEGA_N", help="Free vibration, dimensionless.")
    ] = None
    harmonic: Annotated[
        float | None, typer.Option("--harmonic", metavar="OMEGA", help="Harmonic load, dimensionless.")
    ] = None
    ramp: Annotated[
        tuple[float, float] | None,
        typer.Option(
            "--ramp",
            metavar="RATIO DURATION",
            help="Load rising to RATIO times the static one in DURATION of T; needs --Omega-n.",
        ),
    ] = None
    free_hz: Annotated[
        e.Positive | None,
        typer.Option(
            "--free-hz",
            metavar="HZ",
            help="Of a bearing: free vibration of a mass whose small dry vibrations have this frequency, Hz.",
        ),
    ] = None
    harmonic_hz: Annotated[
        e.Positive | None,
        typer.Option("--harmonic-hz", metavar="HZ", help="Of a bearing: harmonic load of this frequency, Hz."),
    ] = None
    Omega_n: Annotated[
        float | None,
        typer.Option("--Omega-n", help="Dimensionless Omega_n of the bodies, for --ramp and --harmonic."),
    ] = None
    offset: Annotated[
        float | None, typer.Option("--offset", help="Initial displacement in dry approaches, for --free.")
    ] = None
    rate: Annotated[float | None, typer.Option("--rate", help="Initial rate du/dT, for --free.")] = None
    start: Annotated[
        str | None,
        typer.Option(
            "--start", metavar="WAY", help="Sign of the first rate of --free: closing, the default, or opening."
        ),
    ] = None
    amplitude: Annotated[
        float | None, typer.Option("--amplitude", help="Of --harmonic, over the static load; 0.1 by default.")
    ] = None

    def chosen(self, point: Point) -> Motion:
        """Motion that the options ask for.

        Raises
        ------
        InputError
            Not exactly one motion, one in Hz at a point without a unit of time, or an option that belongs to
            another one.
        """
        in_hz = self.by_option("free_hz", "harmonic_hz")
        given = self.by_option("free", "harmonic", "ramp") | in_hz
        if len(given) != 1:
            raise InputError("motion", " ".join(given) or None, "exactly one of --free, --harmonic, --ramp")
        name, value = next(iter(given.items()))
        self._refuse_strangers(name.removesuffix("-hz"))
        if name in in_hz:
            if not isinstance(point, OperatingPoint):
                raise InputError(name, value, f"left out: {NO_TIME}, here {name.removesuffix('-hz')}")
            return self._in_hz(name, value, point)
        if self.free is not None:
            with o.called(Omega_n="--free"):
                return self._free(self.free)
        if self.harmonic is not None:
            with o.called(Omega="--harmonic"):
                return HarmonicLoad(Omega=self.harmonic, amplitude=self._amplitude, Omega_n=self.Omega_n)
        assert self.ramp is not None
        if self.Omega_n is None:
            raise InputError("--Omega-n", None, "given with --ramp: a finite number > 0")
        with o.called(ratio="--ramp RATIO", duration="--ramp DURATION"):
            return RampLoad(*self.ramp, Omega_n=self.Omega_n)

    def _in_hz(self, name: str, hz: Any, point: OperatingPoint) -> Motion:
        """The motion of a frequency in Hz; whatever else is said of it is dimensionless here too."""
        with o.called(Omega=f"{name}, dimensionless", Omega_n=f"{name}, as Omega_n dimensionless"):
            if name == "--free-hz":
                return self._free(FreeVibration.at(point, hz=hz).Omega_n)
            Omega = HarmonicLoad.at(point, hz=hz).Omega
            return HarmonicLoad(Omega=Omega, amplitude=self._amplitude, Omega_n=self.Omega_n)

    def _free(self, Omega_n: float) -> FreeVibration:
        return FreeVibration(Omega_n=Omega_n, offset=self.offset or 0.0, rate=self.rate, start=self.start)

    @property
    def _amplitude(self) -> float:
        return 0.1 if self.amplitude is None else self.amplitude

    def _refuse_strangers(self, chosen: str) -> None:
        """Make sure that no option was given that the chosen motion does not take."""
        owners = {
            "--offset": (self.offset, ("--free",)),
            "--rate": (self.rate, ("--free",)),
            "--start": (self.start, ("--free",)),
            "--amplitude": (self.amplitude, ("--harmonic",)),
            "--Omega-n": (self.Omega_n, ("--harmonic", "--ramp")),
        }
        for name, (value, motions) in owners.items():
            if value is not None and chosen not in motions:
                raise InputError(name, value, f"left out with {chosen}: it belongs to {' or '.join(motions)}")


class TimeOptions(o.Options):
    """How long, and in which steps."""

    panel: ClassVar[str | None] = _TIME
    until: Annotated[
        e.Positive | None,
        typer.Option(
            "--until",
            help="End: of a bearing in s, of --M --L --kappa in T = u_sum t/(2a); by default some periods.",
        ),
    ] = None
    dt: Annotated[
        e.Positive | None,
        typer.Option("--dt", help="Step in the unit of --until (1/80 period); with --local-error, the first."),
    ] = None
    local_error: Annotated[
        e.Positive | None,
        typer.Option(
            "--local-error",
            help="Control the step: error of each step by itself. Over a run of bodies with inertia these "
            "add up to its power 2/3: for an error of the run within 1 % give 0.001.",
        ),
    ] = None
    tol: Annotated[
        e.Positive | None,
        typer.Option(
            "--tol",
            help="Residual at which a step counts as solved, over the central film at rest; by default 0.003, "
            "less for motions below 0.1, and with --local-error at most three times that.",
        ),
    ] = None

    def chosen(self) -> TimeSteps:
        """The time steps that the options stand for."""
        with o.called(dt="--dt", local_error="--local-error"):
            return TimeSteps(until=self.until, dt=self.dt, local_error=self.local_error, tol=self.tol)


class RestartOptions(o.Options):
    """Files that an interrupted run goes on from."""

    panel: ClassVar[str | None] = _RESTART
    checkpoint: Annotated[
        Path | None, typer.Option("--checkpoint", metavar="FILE", help="Keep a file to restart from.")
    ] = None
    restart: Annotated[
        Path | None, typer.Option("--restart", metavar="FILE", help="Go on from a checkpoint of this run.")
    ] = None

    @property
    def other(self) -> Path | None:
        """The file to go on from, unless the checkpoints of this run replace it: that is how runs go on."""
        same = self.checkpoint is not None and realpath(self.checkpoint) == realpath(self.restart or "")
        return None if same else self.restart


@o.grouped
def simulate(
    contact: Contact,
    surfaces: Surfaces,
    conditions: FilmConditions,
    motion: MotionOptions,
    time: TimeOptions,
    grid: o.Grid,
    out: o.ResultOutput,
    restart: RestartOptions,
) -> None:
    """Simulate the transient contact under a motion; Ctrl-C keeps what was computed."""
    from ehlcontact.transient.simulate import simulate as integrate

    point = contact.solvable()
    arguments = (point, motion.chosen(point))
    surfaces.check(contact)
    chosen, steps, given = grid.chosen(), time.chosen(), conditions.chosen(contact)
    out.check(restart.other, beside={"--checkpoint": (restart.checkpoint, o.HDF5)})
    failure, unkept = "", None
    with progress("transient film") as update, o.called(dt="--dt", local_error="--local-error"):
        try:
            result = integrate(
                *arguments,
                grid=chosen["grid"],
                **given,
                time=steps,
                keep=KeepSettings(checkpoint=restart.checkpoint, restart=restart.restart),
                run=RunSettings(threads=chosen["threads"], callback=update),
            )
        except ConvergenceError as stopped:
            result, failure = stopped.result, str(stopped)
        except CheckpointError as error:
            result, unkept = error.result, error
    # stopped before the first step, there is nothing to draw
    drawn = partial(_draw, result) if result.steps else None
    answer = ContactAnswer(contact, point, result, _at_rest(result), surfaces, float(result.h_min.min()))
    answer.deliver(out, "transient film", _rows(result), save=result, figure=drawn)
    if unkept is not None:
        raise unkept
    own = result.dimensionless
    if not result.status.ok:
        message = failure or f"simulation {result.status} at T = {own.t[-1]:.6g}: {result.status.advice}"
        kept = [f"partial result in {out.save}"] if out.save else []
        kept += [f"go on with --restart {restart.checkpoint}"] if restart.checkpoint else []
        complain("; ".join([message, *kept]))
        raise typer.Exit(INTERRUPTED if result.status is Status.INTERRUPTED else FAILED)


def _at_rest(result: SimulationResult) -> Any:
    """Film at the start where it was solved with heat, for the assumptions; None of another."""
    if result.temperature is None:
        return None
    own = result.dimensionless
    films = {name: float(getattr(own, name)[0]) for name in ("h_central", "h_min")}
    return SimpleNamespace(**films, temperature=result.temperature)


def _draw(result: SimulationResult, path: Path) -> None:
    """Draw histories, the film wave, and the force against the approach."""
    from ehlcontact.film.over_time import film_wave
    from ehlcontact.results.drawing import draw
    from ehlcontact.results.picture import Line, Panel, Picture
    from ehlcontact.summary import contact_text

    units = ("m", "N") if isinstance(result.point, OperatingPoint) else ("", "")
    loop = Panel([Line(result.approach, result.force)], ("mutual approach", units[0]), ("contact force", units[1]))
    title = f"transient film: {contact_text(result.point)}"
    draw(Picture([*result.panels(), *film_wave(result).panels(), loop], title), path)


def _rows(result: SimulationResult) -> list[Row]:
    settings = [(k, v) for k, v in result.motion.to_dict().items() if isinstance(v, float | int)]
    steps = ""
    if result.steps:
        T = result.t[-1] / result.point.scales.time
        steps = f"to T = {numeral(T)} (unit 2a/u_sum), {result.cycles[1:].mean():.1f} cycles each"
    return [
        ("motion", result.motion.kind, ", ".join(f"{k} {numeral(v)}" for k, v in settings) + "; dimensionless"),
        *(_in_si(result) if isinstance(result.point, OperatingPoint) else []),
        *quantity_rows(result, {"static_approach": "", "approach": "", "force": "", "h_min": ""}),
        *_supply_rows(result),
        *_sliding_rows(result),
        *_heat_rows(result),
        ("steps", f"{result.steps}", steps),
        *_grid_error(result),
        ("tolerance", numeral(result.tol), "residual of a solved step, of the central film at rest"),
        *run_rows(result),
    ]


def _supply_rows(result: SimulationResult) -> list[Row]:
    """Layer of oil that arrives, and what leaves on the centre line over time."""
    if result.layer is None or result.layer_behind is None:
        return []
    size, unit = film_unit(result.point)
    behind = size * result.layer_behind[:, 0]
    leaves = f"{numeral(behind.min())} to {numeral(behind.max())} {unit} leave in the middle"
    return [("layer of oil", f"{numeral(size * result.layer[0])} {unit}", leaves)]


def _sliding_rows(result: SimulationResult) -> list[Row]:
    """Sliding that thins the film."""
    if result.sliding is None:
        return []
    law = f"thins the film by the law of {type(result.sliding.law).__name__}"
    return [("slide-to-roll ratio", numeral(result.sliding.slide_roll), law)]


def _heat_rows(result: SimulationResult) -> list[Row]:
    """Temperatures over time."""
    if result.warmest_oil is None or result.warmest_surface is None:
        return []
    warm = f"{result.warmest_oil.min():.3g} to {result.warmest_oil.max():.3g} K"
    surface = f"mean over the film, above the inlet; surfaces up to {result.warmest_surface.max():.3g} K"
    return [("warmest oil", warm, surface)]


def _in_si(result: SimulationResult) -> list[Row]:
    """What only a motion in SI has."""
    found = [
        ("frequency of the load", result.hz, "Hz"),
        ("mass of both bodies", result.mass, "kg"),
        ("end", result.t[-1], "s"),
    ]
    return [(name, in_unit(value, unit), "") for name, value, unit in found if value is not None]


def _grid_error(result: SimulationResult) -> list[Row]:
    if (error := result.film_error) is None:
        return []
    central, smallest = map(share_text, (error.h_central_relative, error.h_min_relative))
    return [("error of the grid", central, f"at the start, in the centre; {smallest} for the smallest film")]
