"""``ehlcontact bearing``: a ball bearing under a load: balls, films, stiffness and damping over speed."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from ehlcontact.cli import entries as e
from ehlcontact.cli import options as o
from ehlcontact.cli import orders as measured
from ehlcontact.cli import spall as defect
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import FAILED, STDOUT, complain, say, show_columns, show_table, write_to
from ehlcontact.cli.progress import progress
from ehlcontact.cli.rows import Row, in_unit
from ehlcontact.cli.study.bearing import OPTIONS, load_job
from ehlcontact.cli.study.loads import bearings_of
from ehlcontact.cli.study.oil_and_heat import columns, csv_text, skf_words
from ehlcontact.cli.study.schema import Study, oil_grade
from ehlcontact.errors import InputError
from ehlcontact.files import write_text
from ehlcontact.results.drawing import draw as drawn
from reduced_models.bearing.equilibrium_result import NOTICED
from reduced_models.bearing.freedoms import DECIMALS, FIVE, PLANAR
from reduced_models.bearing.kinematics import LEAST_SLIP, RPM_TO_HZ
from reduced_models.bearing.oil_and_heat import HEAT
from reduced_models.bearing.picture import over_speed_picture
from reduced_models.bearing.sliding import USUAL_LAW

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from ehlcontact.cli.study.bearing import BearingJob
    from reduced_models import BallBearing, BearingSet, Spall
    from reduced_models.bearing.coefficients import BearingCoefficients
    from reduced_models.bearing.equilibrium_result import BearingState
    from reduced_models.bearing.excitation import BearingExcitation
    from reduced_models.bearing.kinematics import DefectOrders
    from reduced_models.bearing.oil_and_heat import OilAndHeat
    from reduced_models.bearing.set_result import SetState
    from reduced_models.bearing.sliding import BearingFriction
    from reduced_models.rotor.machine_state import MachineState

CURVE = 15  # speeds of the curves of a figure
BESIDE = (0.5, 2.0)  # over a single speed: where its curves begin and end
DEFECTS = {  # names of the defect frequencies, and what they are of
    "FTF": "cage",
    "BPFO": "balls on the outer race",
    "BPFI": "balls on the inner race",
    "BSF": "spin of a ball",
}
AXIAL = FIVE.index("z")  # up to it directions have forces, beyond it tilts have moments
PASSAGE = "means over a ball passage"
FAST = 5000.0  # rpm, above which flooded films resist rolling more than measured bearings do: docs/bearings.md
SLIP_UNIT = "of the speed of the cage with balls that roll; in frequencies, orders under load and spall lines"
# Of the entries of the JSON, whatever they are nested in; other entries have no unit, or have it in their name.
UNITS = {
    "load": "N; radial; of a state (x, y), downwards is -y",
    "force": "N",
    "speed_rpm": "rev/min, of the shaft",
    "orders": "ftf_order, bpfo_order, bpfi_order, bsf_order: per turn of the shaft",
    "frequencies_hz": "ftf, bpfo, bpfi, bsf: Hz, at each speed",
    "coefficients": "of small vibrations at frequency_hz, means over a ball passage; in x, y",
    "stiffness": "N/m; of a state: slope of the static force",
    "damping": "N s/m",
    "mean_displacement": "m; of the inner ring, mean over a ball passage",
    "peak_to_peak": "m; displacement of the ring while a ball passes slowly",
    "states": "at rest with a ball right under the load",
    "displacement": "m; of the inner ring in that state",
    "angles": "rad",
    "cage_angle": "rad, of the first ball",
    "approach": "m",
    "h_central": "m",
    "h_min": "m",
    "lambda_ratio": "smallest film over composite roughness",
    "asperity_share": "of the load, on typical asperities of that roughness, an estimate",
    "moment": "N m",
    "rolling_torque": "N m",
    "skf_rolling": "N m; by SKF's published model, as skf_sliding",
    "skf_sliding": "N m",
    "friction": "N m, at each speed, of each bearing: rolling of the films with inlet heat, sliding, SKF's",
    "bearing": "SI, roughness and clearance too",
}
# Of those that a planar bearing does not have, or has otherwise.
UNITS_AT_ANGLES = {
    "load": "N; radial; of a state N, N m: (x, y, z, moments about x, y), downwards is -y",
    "axial_load": "N; along z",
    "moments": "N m; about x, y; null where tilts are held",
    "tilt": "rad; about x, y, at which the ring is held; null where it is not",
    "orders": "ftf_order, bpfo_order, bpfi_order, bsf_order: per turn of the shaft, at the angle without load",
    "orders_under_load": "the same at the contact angles of each speed",
    "coefficients": "of small vibrations at frequency_hz, means over a ball passage; in x, y, z, tilts about x, y",
    "stiffness": "N/m, N, N m; of a state: slope of the static force",
    "damping": "N s/m, N s, N m s",
    "mean_displacement": "m, rad; of the inner ring, mean over a ball passage",
    "peak_to_peak": "m, rad; displacement of the ring while a ball passes slowly",
    "displacement": "m, rad; of the inner ring in that state",
    "contact_angles": "rad",
    "spin_to_roll": "of both surfaces about their normal over that of rolling; its friction is not in the forces",
    "orbit": "speed of a ball about the shaft over that of the shaft",
    "ball_rotation": "speed of a ball about its own axis, seen from the cage, over that of the shaft",
}
# Of those that a pair has beside them, or has otherwise.
UNITS_OF_PAIRS = {
    "load": "N; radial; of a state N, N m: (x, y, z, moments about x, y), of the shaft in the middle of the pair",
    "pair": "SI",
    "axial_rigidity": "N/m; of the shaft, at each speed: slope of the static axial force",
    "lift_off": "N; axial load in +z and -z alone that unloads a bearing, at each speed; null where none does",
    "lift_off_at_rest": "the same of a preloaded pair at rest without films",
    "axial_forces": "N; of each bearing, along its facing",
    "orders_under_load": "the same at the contact angles of each speed, by bearing; null of an unloaded one",
    "frequencies_hz": "ftf, bpfo, bpfi, bsf: Hz, at each speed, bearing by bearing",
    "displacement": "m, rad; of the shaft, or of the inner ring of a bearing along its facing",
    "mean_displacement": "m, rad; of the shaft, mean over a ball passage",
    "bearings": "the state of each, in its own frame: z along its facing",
}
# Of those with a layer of oil or with heat.
UNITS_OF_OIL_AND_HEAT = {
    "oil_and_heat": "SI, at each speed: films ball by ball at both races, K and C in x, y (, z) at hz, torques",
}


@dataclass(frozen=True)
class BearingReport:
    """A bearing, or a pair, at speeds: rest with a ball under the load; K and C at frequencies of vibrations."""

    job: BearingJob
    answers: tuple[MachineState | None, ...]  # at each speed; None at rest
    states: tuple[BearingState | SetState, ...]
    coefficients: tuple[BearingCoefficients, ...]
    friction: tuple[tuple[BearingFriction, ...], ...] = ()  # at each speed, of each bearing in oil
    oil_and_heat: tuple[OilAndHeat, ...] = ()  # at each speed, where they are asked for
    spall: Spall | None = None
    excitations: tuple[BearingExcitation, ...] = ()
    slip: float = 0.0
    order: measured.MeasuredOrder | None = None
    allowed: measured.Found | None = None

    def summary(self) -> dict[str, Any]:
        """For JSON; arrays over balls have a row per ball, with inner and outer race."""
        job, bearing = self.job, self.job.bearing
        orders = [
            [_orders(bearing, one, self.slip) for one in bearings_of(state).values()] for state in self.states
        ]
        under_load = [[None if one is None else asdict(one) for one in row] for row in orders]
        hertz = [
            [None if one is None else asdict(one.at(state.speed_rpm)) for one in row]
            for state, row in zip(self.states, orders, strict=True)
        ]
        axial: dict[str, Any] = {}
        units = UNITS | ({} if job.planar else UNITS_AT_ANGLES)
        if not job.planar:
            axial = {"axial_load": job.load[2], "moments": job.load[3:] or None, "tilt": job.tilt}
            axial["orders_under_load"] = _single(under_load) if job.pair is None else under_load
        if self.spall is not None:
            units |= defect.UNITS
            axial["spall"] = defect.summary(self.spall, list(self.excitations))
        if job.designation is not None and job.designation.suffixes:
            axial["designation"] = {"given": job.designation.given, "suffixes": dict(job.designation.suffixes)}
        if self.slip:
            axial["cage_slip"], units["cage_slip"] = self.slip, SLIP_UNIT
        if self.order is not None and self.allowed is not None:
            units |= measured.UNITS
            axial["measured_order"] = measured.summary(self.order, self.allowed)
        if self.oil_and_heat:
            units |= UNITS_OF_OIL_AND_HEAT
            axial["oil_and_heat"] = [one.to_dict() for one in self.oil_and_heat]
        if job.pair is not None:
            units |= UNITS_OF_PAIRS
            pair = job.pair.to_dict()
            axial["pair"] = {name: pair[name] for name in ("facings", "positions", "offsets", "spring")}
            axial["pair"]["preload"] = job.preload
            axial["axial_rigidity"] = [state.stiffness[AXIAL, AXIAL] for state in self.states]
            axial["lift_off"] = [_lift_off(job.pair, state.speed_rpm) for state in self.states]
            axial["lift_off_at_rest"] = _at_rest(job)
        return {
            "units": units,
            "bearing": bearing.to_dict(),
            "load": -job.load[1],
            **axial,
            "highest_speed_rpm": bearing.highest_speed,
            "orders": asdict(bearing.orders),
            "speed_rpm": list(job.speeds),
            "tiles": [None if one is None else [tile._asdict() for tile in one.tiles()] for one in self.answers],
            "coefficients": [
                {
                    "speed_rpm": c.speed_rpm,
                    "frequency_hz": float(hz),
                    "stiffness": c.stiffness[k],
                    "damping": c.damping[k],
                    "mean_displacement": c.displacement,
                    "peak_to_peak": c.peak_to_peak,
                }
                for c in self.coefficients
                for k, hz in enumerate(c.hz)
            ],
            "frequencies_hz": _single(hertz) if job.pair is None else hertz,
            "friction": [[one.to_dict() for one in row] for row in self.friction],
            "states": [state.to_dict() for state in self.states],
        }


OWN = ("spall", "slip", "measured_order", "solve")  # options that are no entries of a file
_LOAD, _PAIR, _OIL, _BEARING = "Load", "Pair", "Oil", "Bearing"
_FILMS = "Oil supply and heat, beside flooded isothermal films"
# Others are given otherwise than in a file: speeds one by one, a grade by its name, a number or a class.
ENTRY_OPTIONS = {
    "--load --radial": _LOAD, "--axial": _LOAD, "--moment-x": _LOAD, "--moment-y": _LOAD, "--tilt-x": _LOAD,
    "--tilt-y": _LOAD, "--pair": _PAIR, "--preload": _PAIR, "--spring": _PAIR, "--distance-mm": _PAIR,
    "--nu40": _OIL, "--nu100": _OIL, "--temp": _OIL, "--contact-angle": _BEARING, "--race-control": _BEARING,
    "--rq": _BEARING, "--layer": _FILMS, "--layer-ratio": _FILMS,
}  # fmt: skip


@o.with_entries(Study, {names: (OPTIONS[names.split()[0]], panel) for names, panel in ENTRY_OPTIONS.items()})
class BearingOptions(o.Options):
    """What the bearing carries and runs in: in place of entries of its file, or beside its name."""

    speed_rpm: Annotated[
        list[float] | None,
        typer.Option("--speed-rpm"),
        e.meaning("speed of the shaft, rev/min; once each; a NAME needs one"),
    ] = None
    hz: Annotated[
        list[float] | None,
        typer.Option("--hz"),
        e.meaning("frequency of the vibration of stiffness and damping, Hz; once each; that of the shaft"),
    ] = None
    oil: Annotated[
        str | None,
        typer.Option(
            "--oil",
            metavar="GRADE",
            rich_help_panel=_OIL,
            help='ISO grade of a mineral oil, as "ISO VG 68"; without an oil the bearing is dry.',
        ),
    ] = None
    clearance: Annotated[
        str | None,
        typer.Option(
            "--clearance",
            metavar="UM|CLASS",
            rich_help_panel=_BEARING,
            help="Radial internal clearance, um, below 0 a preload; or C2, CN, C3, C4: the middle of that class.",
        ),
    ] = None
    spall: Annotated[
        str | None,
        typer.Option(
            "--spall",
            metavar="RACE,LENGTH,DEPTH",
            rich_help_panel=_BEARING,
            help="Lines of force of a spall: inner or outer, mm along the track, um, as outer,0.5,3.",
        ),
    ] = None
    slip: Annotated[
        float,
        typer.Option("--slip", metavar="PERCENT", rich_help_panel=_LOAD),
        e.meaning("slip of the cage, % of its speed with balls that roll, for the defect frequencies"),
    ] = 0.0
    measured_order: Annotated[
        str | None,
        typer.Option(
            "--measured-order",
            metavar="NAME,ORDER,ERROR",
            rich_help_panel=_BEARING,
            help="Contact angle, and with --axial the clearance, of a measured order, as bpfi,5.4021,0.0005.",
        ),
    ] = None
    thermal: Annotated[
        bool | None,
        typer.Option(
            "--thermal",
            rich_help_panel=_FILMS,
            help="Films that heat up, beside isothermal ones; with --oil and --temp.",
        ),
    ] = None
    solve: Annotated[
        bool,
        typer.Option(
            "--solve",
            rich_help_panel=_FILMS,
            help="Solve the contacts of the most loaded ball, a minute, and correct the tables by them. Where "
            "tables do not have the bearing, this is done anyway: K is then without the change of preload by "
            "thinner films.",
        ),
    ] = False

    def given(self) -> dict[str, Any]:
        """Values by option, of those that are given."""
        found = self.by_option(*(name for name in type(self).model_fields if name not in OWN))
        if self.oil is not None:
            found["--oil"] = oil_grade(self.oil, "--oil")
        if self.clearance is not None:
            with suppress(ValueError):  # the name of a class
                found["--clearance"] = float(self.clearance)
        return found


class BearingOutput(o.FigureOutput):
    """JSON, a picture, and the table of oil supply and heat."""

    csv: Annotated[
        Path | None,
        typer.Option("--csv", metavar="FILE", help="Films, K, C and torques under each condition as CSV."),
        o.Endings((".csv",)),
    ] = None


@o.grouped
def bearing(
    source: Annotated[
        str,
        typer.Argument(metavar="NAME|FILE.toml", help="As 6205, 7205 or 6205-2RS/C3; or a study of one support."),
    ],
    options: BearingOptions,
    out: BearingOutput,
) -> None:
    """Look at a ball bearing: loads, films, lambda and rolling resistance, stiffness and damping over speed.

    In the model: radial and axial load, moments and tilts on rigid rings;
    balls with contact angles, centrifugal force and gyroscopic moment, and
    with elastic contacts and oil films, memory included, at both races.
    Films are between smooth surfaces, flooded and isothermal. With --load
    alone axial motion and tilts are held, and contact angles are zero.
    With --pair two such bearings carry the load, which acts in their middle.
    With --thermal, --layer or --layer-ratio a table has films, stiffness,
    damping and torque with heat and with a layer of oil beside flooded
    isothermal ones.

    Not in it: flexible rings; sliding and spin in the forces; grease.

    Each answer names the assumptions of films that do not hold in it.
    """
    out.check(Path(source))
    spall = None if options.spall is None else defect.spall_of(options.spall)
    order = None if options.measured_order is None else measured.measured_order_of(options.measured_order)
    slip = _slip_of(options.slip)
    job = load_job(source, options.given())
    if out.csv is not None and job.supply is None and job.thermal is None:
        allowed = "given with --thermal, --layer or --layer-ratio, whose table it is"
        raise InputError("--csv", str(out.csv), allowed)
    if options.solve and job.supply is None and job.thermal is None:
        raise InputError(
            "--solve", True, "given with --thermal, --layer or --layer-ratio, whose contacts it solves"
        )
    with progress("bearing") as update, job.called():
        lines = () if spall is None else job.excitations(spall, options.spall or "", slip)
        found = None if order is None else measured.allowed_by(order, job, slip)
        report = replace(_computed(job), spall=spall, excitations=lines, slip=slip, order=order, allowed=found)
        report = replace(report, oil_and_heat=tuple(_oil_and_heat(job, update, options.solve)))

    def draw(path: Path) -> None:
        state = report.states[len(report.states) // 2]
        drawn(over_speed_picture(state, report.coefficients, curve(report)), path)

    def write(path: Path) -> None:
        write_text(path, csv_text(report.oil_and_heat), "--csv")

    out.deliver(
        report.summary(),
        partial(write_to, "--csv", out.csv, write),
        partial(_show, report, out.json_to),
        figure=draw,
    )
    if missing := [(one, key) for one in report.oil_and_heat for key in one.refused]:
        told = "; ".join(f"{key} at {numeral(one.state.speed_rpm)} rpm" for one, key in missing)
        complain(f"no films {told}: {_advice(missing)}")
        raise typer.Exit(FAILED)


def _advice(missing: list[tuple[OilAndHeat, str]]) -> str:
    """What to change, in options of this command."""
    if any(key != HEAT for _, key in missing):
        return "give a thicker layer, by --layer or --layer-ratio"
    return "leave --solve out, or --thermal"


def _oil_and_heat(
    job: BearingJob, update: Callable[[float, float, str], object], solve: bool
) -> Iterator[OilAndHeat]:
    """The bearing with a layer and with heat beside flooded isothermal films, speed by speed."""
    if job.supply is None and job.thermal is None:
        return
    for k, speed in enumerate(job.speeds):

        def told(done: int, total: int, words: str, k: int = k) -> None:
            update(k * total + done, len(job.speeds) * total, words)

        yield job.oil_and_heat(speed, told, solve=solve)


def _slip_of(percent: float) -> float:
    """Slip of the cage as a share."""
    low, high = 100.0 * LEAST_SLIP, 100.0
    if not low < percent < high:
        raise InputError("--slip", percent, f"above {low:g} and below {high:g} %")
    return 0.01 * percent


def _computed(job: BearingJob) -> BearingReport:
    answers = tuple(job.answer(speed) if speed > 0.0 else None for speed in job.speeds)
    supports = [None if one is None else one.supports[0] for one in answers]
    rows = list(zip(job.speeds, supports, strict=True))
    return BearingReport(
        job,
        answers,
        tuple(job.state(speed) if one is None else one.state for speed, one in rows),
        tuple(job.coefficients(speed) if one is None or job.hz else one.coefficients for speed, one in rows),
        tuple(() if one is None else one.friction for one in supports),
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
            found.append(report.job.coefficients(speed))
        except InputError:  # slower, the atlas has no films under such loads
            continue
    return found


def _show(report: BearingReport, json_to: str | None) -> None:
    if json_to == STDOUT:
        return
    job = report.job
    bearing = job.bearing
    name = bearing.name or "ball bearing" if job.pair is None else job.pair.name
    show_table(f"{name}, {_load_words(job)}", [*_name_rows(job), *_rows(bearing), *_pair_rows(job)], json_to)
    for k, (state, found) in enumerate(zip(report.states, report.coefficients, strict=True)):
        sliding = _sliding(report.friction[k])
        rows = _at_speed(bearing, state, found, sliding) if job.planar else _at_angles(job, state, found, sliding)
        rows += _defects(bearing, state, report.slip)
        answer = report.answers[k]
        tiles = (
            []
            if answer is None
            else [(tile.name, f"{tile.value} {tile.unit}", tile.note) for tile in answer.tiles()]
        )
        show_table(f"at {numeral(state.speed_rpm)} rpm", tiles + rows, json_to)
        if report.oil_and_heat:
            _show_conditions(report.oil_and_heat[k])
        for title, one in bearings_of(state).items():
            _show_balls(one, title)
        if report.spall is not None:
            defect.show(report.spall, _orders(bearing, one, report.slip), report.excitations[k])
    if report.order is not None and report.allowed is not None:
        measured.show(report.order, report.allowed)


def _show_conditions(found: OilAndHeat) -> None:
    """Table of a bearing under the conditions, of its most loaded ball and as a whole, with its notes."""
    heads, rows = columns(found)
    where = " and ".join(found.ways)
    show_columns(heads, rows, f"oil supply and heat: films of the most loaded ball, K and C {where}", named=True)
    for line in filter(None, (skf_words(found), *found.notes)):
        say(f"  {line.removesuffix('.')}.")


def _single(rows: list[list[Any]]) -> list[Any]:
    """The first of each row."""
    return [row[0] for row in rows]


def _load_words(job: BearingJob) -> str:
    """The load in words."""
    radial = f"{numeral(-job.load[1])} N"
    if job.planar:
        return radial
    given = " and ".join(map(numeral, job.load[3:]))
    moments = f", moments {given} N m about x and y" if given else ""
    tilt = "" if job.tilt is None else f", tilted by {' and '.join(numeral(1e3 * t) for t in job.tilt)} mrad"
    return f"{radial} radially, {numeral(job.load[2])} N axially{moments}{tilt}"


def _rows(b: BallBearing) -> list[Row]:
    """Dimensions and oil of the bearing."""
    oil = [("oil", "none: dry", "")]
    if b.oil is not None:
        oil = [
            ("oil", f"{numeral(b.oil.eta0)} Pa s", f"alpha {numeral(b.oil.alpha)} 1/Pa"),
            ("highest speed", f"{numeral(b.highest_speed, 5)} rpm", "beyond it the atlas has no films"),
        ]
    conformity = f"{numeral(b.conformity_inner)}, {numeral(b.conformity_outer)}"
    angle = [
        ("contact angle", f"{numeral(math.degrees(b.free_angle))}°", "without load"),
        ("race control", b.race_control, "what holds the gyroscopic moment of the balls"),
    ]
    play = [("clearance", in_unit(b.clearance, "m"), "below 0: preload")]
    return [
        ("balls", f"{b.balls} x {numeral(b.ball_diameter * 1e3)} mm", f"on {numeral(b.pitch_diameter * 1e3)} mm"),
        ("conformity", conformity, "inner, outer"),
        *(play if b.contact_angle is None else angle),
        *oil,
    ]


def _name_rows(job: BearingJob) -> list[Row]:
    """A name with suffixes as it was read."""
    named = job.designation
    return [("read as", named.name, named.words)] if named is not None and named.suffixes else []


def _pair_rows(job: BearingJob) -> list[Row]:
    """Arrangement of a pair, and axial loads that unload it at rest without films."""
    if job.pair is None:
        return []
    pair, unloads = job.pair, _at_rest(job)
    apart = f"planes {numeral(1e3 * (pair.positions[1] - pair.positions[0]))} mm apart"
    offsets = " and ".join(numeral(1e6 * one) for one in pair.offsets)
    rows = [("facings", ", ".join(pair.facings), apart)]
    if pair.sprung is not None:
        rows.append(
            ("spring", in_unit(pair.spring, "N"), f"on the outer ring of the bearing facing {pair.sprung}")
        )
    if job.preload is not None:
        rows.append(("preload", in_unit(job.preload, "N"), f"at mounting, by offsets of {offsets} µm"))
    rows += [
        ("unloaded from", in_unit(load, "N"), f"axial load in {direction} at rest without films")
        for direction, load in unloads.items()
    ]
    return rows


def _lift_off(pair: BearingSet, speed_rpm: float) -> dict[str, float]:
    """Axial loads alone that unload a bearing of a pair, by direction [N]; infinite where none does."""
    from reduced_models.bearing.freedoms import FACINGS

    return {one: pair.lift_off(one, speed_rpm=speed_rpm) for one in FACINGS}


def _at_rest(job: BearingJob) -> dict[str, float]:
    """Those of a preloaded pair without films, as catalogues state them."""
    dry = job.dry_pair
    found = {} if dry is None else _lift_off(dry, 0.0)
    return {one: load for one, load in found.items() if 0.0 < load < math.inf}


def _of_pair(job: BearingJob, state: Any) -> list[Row]:
    """Axial forces and axial rigidity of a pair, and whether its preload is used up."""
    if job.pair is None:
        return []
    forces, axial = (
        ", ".join(numeral(round(one, DECIMALS)) for one in state.axial_forces.tolist()),
        job.load[AXIAL],
    )
    beyond = any(axial * (1.0 if direction == "+z" else -1.0) >= load for direction, load in _at_rest(job).items())
    kept = "without them and at rest a bearing is unloaded: only films and centrifugal force press its balls"
    return [
        *([("PRELOAD USED UP", "", kept)] if beyond else []),
        ("axial forces", f"{forces} N", "of the bearings, along their facings"),
        ("axial rigidity", in_unit(state.stiffness[AXIAL, AXIAL], "N/m"), "static, with a ball under the load"),
    ]


def _at_speed(
    b: BallBearing, state: BearingState | SetState, at: BearingCoefficients, sliding: list[Row]
) -> list[Row]:
    """Deflection, stiffness, damping, resistance and frequencies at a speed."""
    return [
        *_outside(state, at),
        ("deflection", _micrometres(-at.displacement[1]), _at_passage(at)),
        *_small_vibrations(at, (("along the load", 1), ("across it", 0))),
        *_asperities(state),
        *_resistance(state),
        *sliding,
    ]


def _at_angles(
    job: BearingJob, state: BearingState | SetState, at: BearingCoefficients, sliding: list[Row]
) -> list[Row]:
    """The same of a bearing or a pair with contact angles: in all five degrees of freedom."""
    down, along = _micrometres(-at.displacement[1]), _micrometres(at.displacement[2])
    moments = " and ".join(numeral(round(one, DECIMALS)) for one in state.load[3:].tolist())
    turned = " and ".join(numeral(round(1e3 * one, DECIMALS)) for one in at.displacement[3:].tolist())
    return [
        *_outside(state, at),
        ("deflection", f"{down} down", _at_passage(at)),
        ("axial", along, f"displacement of the {'inner ring' if job.pair is None else 'shaft'} in +z"),
        ("tilts", f"{turned} mrad", f"moments {moments} N m, about x and y"),
        *_of_pair(job, state),
        ("contact angles", _angle_span(state), "of balls that carry, at both races"),
        (
            "spin",
            f"up to {numeral(_largest_spin(state), 3)}",
            "of rolling; its friction is in that of sliding, below",
        ),
        *_small_vibrations(
            at, (("axial", 2), ("along the load", 1), ("across it", 0), ("tilt about x", 3), ("tilt about y", 4))
        ),
        *_asperities(state),
        *_resistance(state),
        *sliding,
    ]


def _micrometres(displacement: float) -> str:
    """A displacement [m], 0 where it is rounding."""
    return f"{numeral(round(1e6 * displacement, DECIMALS))} µm"


def _at_passage(at: BearingCoefficients) -> str:
    """Vibration of the ring as balls pass slowly, in words."""
    return f"{numeral(round(1e9 * at.peak_to_peak[1], DECIMALS), 3)} nm up and down at ball passage"


def _angle_span(state: BearingState | SetState) -> str:
    """Least and largest contact angle of the balls that carry."""
    found = [
        one.contact_angles[one.force[:, 0] > 0.0]
        for one in bearings_of(state).values()
        if one.contact_angles is not None
    ]
    angles = np.concatenate(found)
    return f"{numeral(math.degrees(angles.min()))} .. {numeral(math.degrees(angles.max()))}°"


def _largest_spin(state: BearingState | SetState) -> float:
    """Largest spin-to-roll ratio of the balls that carry."""
    return max(one.largest_spin or 0.0 for one in bearings_of(state).values())


def _outside(state: BearingState | SetState, at: BearingCoefficients) -> list[Row]:
    """Assumptions that do not hold, loads and frequencies beyond the atlas."""
    outside = state.outside_assumptions.removeprefix("Outside what is assumed: ")
    rows = [("NOT AS ASSUMED", "", outside), ("BEYOND THE ATLAS", "", at.beyond_data)]
    return [row for row in rows if row[-1]]


def _small_vibrations(at: BearingCoefficients, directions: tuple[tuple[str, int], ...]) -> list[Row]:
    """Stiffness and damping in directions, at every frequency."""
    shaft, rows = at.speed_rpm * RPM_TO_HZ, []
    for k, hz in enumerate(at.hz.tolist()):
        for name, way in directions:
            stiffness, damping = at.stiffness[k, way, way], at.damping[k, way, way]
            if way <= AXIAL:
                rows += [(name, in_unit(stiffness, "N/m"), in_unit(damping, "N s/m"))]
            else:
                rows += [(name, f"{numeral(1e-3 * stiffness)} N m/mrad", f"{numeral(damping)} N m s/rad")]
        remark = ", ".join([*(["that of the shaft"] if math.isclose(hz, shaft) else []), PASSAGE])
        rows += [("these at" if len(directions) > len(PLANAR) else "both at", f"{numeral(hz)} Hz", remark)]
    return rows


def _asperities(state: BearingState | SetState) -> list[Row]:
    """Estimated load share of asperities at the heaviest contact of every bearing with a roughness."""
    return [
        ("on asperities", f"{100.0 * share:.2g} %", "of the most loaded ball, an estimate; not in the forces")
        for one in bearings_of(state).values()
        if one.asperity_share is not None and (share := one.asperity_share[one.heaviest].max()) > NOTICED
    ]


def _resistance(state: BearingState | SetState) -> list[Row]:
    """Rolling resistance of the films of a bearing in oil, or of both of a pair."""
    rows = []
    for name, remark in (
        ("rolling", "without sliding, cage, churning"),
        ("friction", "its sliding part by SKF's published model"),
    ):
        torques, losses = (
            [getattr(one, f"{name}_{what}") for one in bearings_of(state).values()] for what in ("torque", "loss")
        )
        if None not in torques:
            title = "films resist rolling" if name == "rolling" else "friction of the bearing"
            rows.append((title, in_unit(sum(torques), "N m"), f"{numeral(sum(losses))} W; {remark}"))
    by_skf = [one.skf_torque for one in bearings_of(state).values()]
    if None not in by_skf:
        fast = f"; above {numeral(FAST)} rpm rely on it" if state.speed_rpm > FAST else ""
        rows.append(("friction by SKF", in_unit(sum(by_skf), "N m"), f"fitted to measured bearings{fast}"))
    return rows


def _sliding(friction: tuple[BearingFriction, ...]) -> list[Row]:
    """Computed sliding moment of a bearing in oil, or of both of a pair."""
    if not friction:
        return []
    beside = [one.skf_sliding for one in friction if one.skf_sliding is not None]
    skf = f"; by SKF {in_unit(sum(beside), 'N m')}" if len(beside) == len(friction) else ""
    remark = f"computed: differential slip and spin, limiting shear stress {USUAL_LAW.coefficient:g} p{skf}"
    return [("sliding in contacts", in_unit(sum(one.sliding for one in friction), "N m"), remark)]


def _orders(b: BallBearing, state: BearingState, slip: float = 0.0) -> DefectOrders | None:
    """Defect frequencies per turn of the shaft, at the contact angles of the state where it has any.

    None of a bearing of a pair that carries nothing.
    """
    found = b.orders if state.contact_angles is None else state.orders
    return None if found is None else found.with_slip(slip)


def _defects(b: BallBearing, state: BearingState | SetState, slip: float) -> list[Row]:
    """Defect frequencies at a speed in Hz, with their orders."""
    rows = []
    for title, one in bearings_of(state).items():
        orders, which = _orders(b, one, slip), f"{title.partition(',')[0]}: " if title else ""
        if orders is None:
            continue
        frequencies = orders.at(state.speed_rpm)
        for name, meaning in DEFECTS.items():
            hertz = numeral(getattr(frequencies, name.lower()), 4)
            words = numeral(getattr(orders, f"{name.lower()}_order"), 5)
            rows.append((name, f"{hertz} Hz", f"{which}{words} per turn: {meaning}"))
    if slip:
        rows.append(("cage slip", f"{numeral(100.0 * slip)} %", "in these four"))
    return rows


def _show_balls(state: BearingState, title: str) -> None:
    """Every ball of a bearing at rest, from the one under the load on."""
    films = None if state.h_min is None else state.h_min * 1e6
    angles = None if state.contact_angles is None else state.contact_angles * 180.0 / math.pi
    columns = {"force [N]": state.force, "contact angle [°]": angles, "smallest film [µm]": films}
    spin = None if state.spin_to_roll is None else state.spin_to_roll.round(DECIMALS)
    columns |= {"lambda": state.lambda_ratio, "spin to roll": spin}
    known = {head: values for head, values in columns.items() if values is not None}
    turned = [math.degrees(angle - state.angles[0]) for angle in state.angles.tolist()]
    digits = 4 if state.contact_angles is None else 3  # so that seven columns fit
    rows = [
        [f"{degrees:.0f}°", *(", ".join(numeral(one, digits) for one in values[k]) for values in known.values())]
        for k, degrees in enumerate(turned)
    ]
    show_columns(["ball", *known], rows, title)
