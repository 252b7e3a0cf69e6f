"""``ehlcontact bearing``: a ball bearing under a load: balls, films, stiffness and damping over speed."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ehlcontact.cli import entries as e
from ehlcontact.cli import options as o
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import STDOUT, show_columns, show_table
from ehlcontact.cli.progress import progress
from ehlcontact.cli.rows import Row, in_unit
from ehlcontact.cli.study.schema import oil_grade
from ehlcontact.errors import InputError

if TYPE_CHECKING:
    from ehlcontact.cli.study.bearing import BearingJob
    from reduced_models import BallBearing, BearingState
    from reduced_models.bearing.linear_balls import BearingCoefficients

CURVE = 15  # speeds of the curves of a figure
BESIDE = (0.5, 2.0)  # over a single speed: where its curves begin and end
DEFECTS = {  # names of the defect frequencies, and what they are of
    "FTF": "cage",
    "BPFO": "balls on the outer race",
    "BPFI": "balls on the inner race",
    "BSF": "spin of a ball",
}
_OIL, _BEARING = "Oil", "Bearing"
# Of the entries of the JSON, whatever they are nested in; other entries have no unit, or have it in their name.
UNITS = {
    "load": "N; (x, y), downwards is -y",
    "force": "N",
    "speed_rpm": "rev/min, of the shaft",
    "orders": "FTF, BPFO, BPFI, BSF: per turn of the shaft",
    "frequencies_hz": "FTF, BPFO, BPFI, BSF: Hz, at each speed",
    "coefficients": "of small vibrations at frequency_hz, that of the shaft; means over a ball passage; in x, y",
    "stiffness": "N/m; of a state: slope of the static force",
    "damping": "N s/m",
    "mean_displacement": "m; of the inner ring, mean over a ball passage",
    "swing": "m; peak to peak, as a ball passes slowly",
    "states": "at rest with a ball right under the load",
    "displacement": "m; of the inner ring in that state",
    "angles": "rad",
    "cage_angle": "rad, of the first ball",
    "approach": "m",
    "h_central": "m",
    "h_min": "m",
    "lambda_ratio": "smallest film over composite roughness",
    "moment": "N m",
    "rolling_torque": "N m",
    "skf_rolling": "N m; by SKF's published model, as skf_sliding",
    "skf_sliding": "N m",
    "bearing": "SI, roughness and clearance too",
}


@dataclass(frozen=True)
class BearingReport:
    """A bearing at several speeds: rest with a ball under the load; K and C at the frequency of the shaft."""

    job: BearingJob
    states: tuple[BearingState, ...]
    coefficients: tuple[BearingCoefficients, ...]

    def summary(self) -> dict[str, Any]:
        """For JSON; arrays over balls have a row per ball, with inner and outer race."""
        bearing = self.job.bearing
        return {
            "units": UNITS,
            "bearing": bearing.to_dict(),
            "load": self.job.load,
            "highest_speed_rpm": bearing.highest_speed,
            "orders": asdict(bearing.orders),
            "speed_rpm": list(self.job.speeds),
            "coefficients": [
                {
                    "frequency_hz": float(c.hz[0]),
                    "stiffness": c.stiffness[0],
                    "damping": c.damping[0],
                    "mean_displacement": c.displacement,
                    "swing": c.swing,
                }
                for c in self.coefficients
            ],
            "frequencies_hz": [asdict(bearing.frequencies(speed)) for speed in self.job.speeds],
            "states": [state.to_dict() for state in self.states],
        }


class BearingOptions(o.Options):
    """What the bearing carries and runs in: in place of entries of its file, or beside its name."""

    load: Annotated[e.NotNegative | None, typer.Option("--load"), e.meaning("radial load, N; a NAME needs it")] = (
        None
    )
    speed_rpm: Annotated[
        list[float] | None,
        typer.Option("--speed-rpm"),
        e.meaning("speed of the shaft, rev/min; once each; a NAME needs one"),
    ] = None
    oil: Annotated[
        str | None,
        typer.Option(
            "--oil",
            metavar="GRADE",
            help='ISO grade of a mineral oil, as "ISO VG 68"; without an oil the bearing is dry.',
            rich_help_panel=_OIL,
        ),
    ] = None
    temp: Annotated[e.Temperature | None, typer.Option("--temp", rich_help_panel=_OIL)] = None
    clearance: Annotated[
        str | None,
        typer.Option(
            "--clearance",
            metavar="UM|CLASS",
            help="Radial internal clearance, um, below 0 a preload; or C2, CN, C3, C4: the middle of that class.",
            rich_help_panel=_BEARING,
        ),
    ] = None
    rq: Annotated[
        e.Roughness | None,
        typer.Option("--rq", rich_help_panel=_BEARING),
        e.meaning("roughness of ball and race together"),
    ] = None

    def given(self) -> dict[str, Any]:
        """Values by option, None where one is not given."""
        grade = None if self.oil is None else oil_grade(self.oil, "--oil")
        values = {"--load": self.load, "--speed-rpm": self.speed_rpm or None, "--oil": grade, "--temp": self.temp}
        return values | {"--clearance": _clearance(self.clearance), "--rq": self.rq}


def _clearance(text: str | None) -> float | str | None:
    """A number [um], or the name of a class."""
    try:
        return None if text is None else float(text)
    except ValueError:
        return text


@o.grouped
def bearing(
    source: Annotated[str, typer.Argument(metavar="NAME|FILE.toml", help="As 6205; or a file with dimensions.")],
    options: BearingOptions,
    out: o.FigureOutput,
) -> None:
    """Look at a ball bearing: loads, films, lambda and rolling resistance, stiffness and damping over speed.

    In the model: radial load on rigid rings at zero contact angle, and balls
    with elastic contacts and oil films, memory included, at both races.
    Films are flooded, isothermal and between smooth surfaces.

    Not in it: axial load and preload, contact angles, tilted or flexible
    rings; heat in the inlet, starvation, grease, sliding.

    Each answer names the assumptions of films that do not hold in it.
    """
    from ehlcontact.cli.study.bearing import load_job

    out.check(Path(source))
    job = load_job(source, options.given())
    with progress("bearing"), job.called():
        report = _computed(job)

    def draw(path: Path) -> None:
        from reduced_models.bearing.picture import draw_over_speed

        draw_over_speed(report.states[len(report.states) // 2], report.coefficients, curve(report), path)

    out.deliver(report.summary(), partial(_show, report, out.json_to), figure=draw)


def _computed(job: BearingJob) -> BearingReport:
    weight = (0.0, -job.load)
    return BearingReport(
        job,
        tuple(job.bearing.equilibrium(weight, speed_rpm=speed) for speed in job.speeds),
        tuple(job.bearing.coefficients(weight, speed_rpm=speed, rpm=speed) for speed in job.speeds),
    )


def curve(report: BearingReport) -> list[BearingCoefficients]:
    """K and C over speed between those given, as far as the atlas has them."""
    low, high = report.job.speeds[0], report.job.speeds[-1]
    if low == high:
        low, high = BESIDE[0] * low, min(BESIDE[1] * high, report.job.bearing.highest_speed)
    found = []
    for k in range(CURVE):
        share = k / (CURVE - 1)
        speed = low * (high / low) ** share if low > 0.0 else share * high
        try:
            found.append(report.job.bearing.coefficients((0.0, -report.job.load), speed_rpm=speed, rpm=speed))
        except InputError:  # slower, the atlas has no films under such loads
            continue
    return found


def _show(report: BearingReport, json_to: str | None) -> None:
    if json_to == STDOUT:
        return
    bearing = report.job.bearing
    show_table(f"{bearing.name or 'ball bearing'}, {numeral(report.job.load)} N", _rows(bearing), json_to)
    for state, found in zip(report.states, report.coefficients, strict=True):
        show_table(f"at {numeral(state.speed_rpm)} rpm", _at_speed(bearing, state, found), json_to)
        _show_balls(state)


def _rows(b: BallBearing) -> list[Row]:
    """Dimensions and oil of the bearing."""
    oil = [("oil", "none: dry", "")]
    if b.oil is not None:
        oil = [
            ("oil", f"{numeral(b.oil.eta0)} Pa s", f"alpha {numeral(b.oil.alpha)} 1/Pa"),
            ("highest speed", f"{numeral(b.highest_speed, 5)} rpm", "where the atlas ends"),
        ]
    conformity = f"{numeral(b.conformity_inner)}, {numeral(b.conformity_outer)}"
    return [
        ("balls", f"{b.balls} x {numeral(b.ball_diameter * 1e3)} mm", f"on {numeral(b.pitch_diameter * 1e3)} mm"),
        ("conformity", conformity, "inner, outer"),
        ("clearance", in_unit(b.clearance, "m"), "below 0: preload"),
        *oil,
    ]


def _at_speed(b: BallBearing, state: BearingState, at: BearingCoefficients) -> list[Row]:
    """Deflection, stiffness, damping, resistance and frequencies at a speed."""
    K, C, swing = at.stiffness[0], at.damping[0], at.swing[1] * 1e9
    deflection = in_unit(-at.displacement[1], "m")
    outside = state.outside_assumptions.removeprefix("Outside what is assumed: ")
    return [
        *([("NOT AS ASSUMED", "", outside)] if outside else []),
        ("deflection", deflection, f"{numeral(swing, 3)} nm up and down at ball passage"),
        ("along the load", in_unit(K[1, 1], "N/m"), in_unit(C[1, 1], "N s/m")),
        ("across it", in_unit(K[0, 0], "N/m"), in_unit(C[0, 0], "N s/m")),
        ("both at", f"{numeral(at.omega[0] / math.tau)} Hz", "that of the shaft"),
        *_resistance(state),
        *_defects(b, at.speed_rpm),
    ]


def _resistance(state: BearingState) -> list[Row]:
    """Rolling resistance of the films of a bearing in oil."""
    if state.rolling_torque is None or state.rolling_loss is None:
        return []
    loss = f"{numeral(state.rolling_loss)} W; without sliding, cage, churning"
    rows = [("films resist rolling", in_unit(state.rolling_torque, "N m"), loss)]
    if state.friction_torque is not None and state.friction_loss is not None:
        loss = f"{numeral(state.friction_loss)} W; its sliding part by SKF's published model"
        rows.append(("friction of the bearing", in_unit(state.friction_torque, "N m"), loss))
    return rows


def _defects(b: BallBearing, speed_rpm: float) -> list[Row]:
    """Defect frequencies at a speed in Hz, with their orders."""
    hz, orders = asdict(b.frequencies(speed_rpm)), asdict(b.orders)
    return [
        (name, f"{numeral(hz[name.lower()], 4)} Hz", f"{numeral(orders[name.lower()], 5)} per turn: {meaning}")
        for name, meaning in DEFECTS.items()
    ]


def _show_balls(state: BearingState) -> None:
    """Every ball of a bearing at rest, from the one under the load on."""
    films = None if state.h_min is None else state.h_min * 1e6
    columns = {"force [N]": state.force, "smallest film [µm]": films, "lambda": state.lambda_ratio}
    known = {head: values for head, values in columns.items() if values is not None}
    turned = [math.degrees(angle - state.angles[0]) for angle in state.angles.tolist()]
    rows = [
        [f"{degrees:.0f}°", *(", ".join(map(numeral, values[k])) for values in known.values())]
        for k, degrees in enumerate(turned)
    ]
    show_columns(["ball", *known], rows)
