"""``ehlcontact bearing``: a ball bearing under a load: balls, films, stiffness and damping over speed."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property, partial
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
from ehlcontact.cli.rows import Row, columns_over, in_unit, summary_lines
from ehlcontact.cli.study.bearing import ENTRIES, load_job
from ehlcontact.cli.study.loads import bearings_of, spall_in
from ehlcontact.cli.study.oil_and_heat import columns, csv_text, skf_words
from ehlcontact.errors import InputError
from ehlcontact.files import write_text
from ehlcontact.results.drawing import draw as drawn
from reduced_models.bearing.equilibrium_result import NOTICED
from reduced_models.bearing.freedoms import DECIMALS, FACINGS, FIVE
from reduced_models.bearing.kinematics import RPM_TO_HZ
from reduced_models.bearing.oil_and_heat import HEAT, oil_and_heat
from reduced_models.bearing.picture import over_speed_picture
from reduced_models.bearing.sliding import USUAL_LAW

if TYPE_CHECKING:
    from ehlcontact.cli.study.bearing import BearingJob
    from reduced_models import BearingSet
    from reduced_models.bearing.coefficients import BearingCoefficients
    from reduced_models.bearing.equilibrium_result import BearingState
    from reduced_models.bearing.excitation import BearingExcitation
    from reduced_models.bearing.kinematics import DefectOrders
    from reduced_models.bearing.oil_and_heat import OilAndHeat
    from reduced_models.bearing.set_result import SetState
    from reduced_models.rotor.machine_state import MachineState
    from reduced_models.rotor.support_state import SupportState

CURVE = 15  # speeds of the curves of a figure
BESIDE = (0.5, 2.0)  # over a single speed: where its curves begin and end
DEFECTS = {  # names of the defect frequencies, and what they are of
    "FTF": "cage",
    "BPFO": "balls on the outer race",
    "BPFI": "balls on the inner race",
    "BSF": "spin of a ball",
}
WAYS = {"z": "axial", "y": "along the load", "x": "across it", "tilt_x": "tilt about x", "tilt_y": "tilt about y"}
AXIAL = FIVE.index("z")
BALLS = {  # columns of the table of balls, with heads where words of the quantity are long
    "force": "force",
    "contact_angles": "contact angle",
    "h_min": "",
    "lambda_ratio": "lambda",
    "asperity_share": "share on asperities",
    "spin_to_roll": "",
}
# Of entries of the JSON that are no quantities of a result, wherever they are nested.
UNITS = {
    "bearing": "SI, roughness and clearance too",
    "load": "N; radial; of a state N, N m along x, y, z and about x, y, downwards is -y",
    "axial_load": "N; along z",
    "moments": "N m; about x, y; null where tilts are held",
    "tilt": "rad; about x, y, at which the ring is held; null where it is not",
    "orders": "per turn of the shaft, at the angle without load",
    "orders_under_load": "per turn of the shaft at the contact angles of each speed; null of an unloaded bearing",
    "frequencies_hz": "ftf, bpfo, bpfi, bsf: Hz, at each speed, of a pair bearing by bearing",
    "cage_slip": "of the speed of the cage with balls that roll; in frequencies, orders under load, spall lines",
    "coefficients": "of small vibrations at frequency_hz, means over a ball passage",
    "friction": "N m, at each speed, of each bearing: rolling of the films with inlet heat, sliding, SKF's",
    "life": "SI, at each speed, as in results.json of a study; lives in million turns, those with rh in h",
    "oil_and_heat": "SI, at each speed: films ball by ball at both races, K and C in x, y (, z) at hz, torques",
    "states": "at rest with a ball right under the load; bearings of a pair each in its frame, z along its facing",
    "pair": "SI",
    "axial_rigidity": "N/m; of the shaft, at each speed: slope of the static axial force",
    "lift_off": "N; axial load in +z and -z alone that unloads a bearing, at each speed; null where none does",
    "lift_off_at_rest": "N; that of a preloaded pair at rest without films",
}
PANELS = {
    "operation": "Load, speed, oil supply and heat",
    "support": "Bearing and pair",
    "oil": "Oil",
    "surface": "Roughness",
    "defect": "Defect",
}


@dataclass(frozen=True)
class AtSpeed:
    """A bearing or a pair at one speed: its answer, K and C at the frequencies asked for, and further answers."""

    machine: MachineState
    coefficients: BearingCoefficients
    slip: float
    oil_and_heat: OilAndHeat | None
    excitation: BearingExcitation | None  # by a spall

    @property
    def state(self) -> BearingState | SetState:
        """At rest with a ball right under the load."""
        return self.machine.supports[0].state

    @cached_property
    def orders(self) -> dict[str, DefectOrders | None]:
        """Defect frequencies per turn of the shaft, by the bearing, at its contact angles where it has any.

        None of a bearing of a pair that carries nothing.
        """
        bearings = self.machine.supports[0].bearings
        rows = zip(bearings_of(self.state).items(), bearings, strict=True)
        return {name: _with_slip(one, bearing, self.slip) for (name, one), (bearing, _) in rows}

    @property
    def frequencies(self) -> list[dict[str, float] | None]:
        """Those in Hz."""
        return [None if one is None else asdict(one.at(self.state.speed_rpm)) for one in self.orders.values()]


def _with_slip(state: BearingState, bearing: Any, slip: float) -> DefectOrders | None:
    orders = bearing.orders if state.contact_angles is None else state.orders
    return None if orders is None else orders.with_slip(slip, bearing.ring_speeds)


@o.with_entries(ENTRIES, PANELS)
class BearingOptions(o.Options):
    """What the bearing carries and runs in: in place of entries of its file, or beside its name."""

    speed_rpm: Annotated[
        list[float] | None,
        typer.Option("--speed-rpm", rich_help_panel=PANELS["operation"]),
        e.meaning("speed of the shaft, rev/min; once each; a NAME needs one"),
    ] = None
    spall: Annotated[
        str | None,
        typer.Option(
            "--spall",
            metavar="RACE,LENGTH,DEPTH",
            rich_help_panel=PANELS["defect"],
            help="Lines of force of a spall: inner or outer, mm along the track, um, as outer,0.5,3.",
        ),
    ] = None
    slip: Annotated[
        e.CageSlip | None,
        typer.Option("--slip", metavar="PERCENT", rich_help_panel=PANELS["defect"]),
        e.meaning("slip of the cage, % of its speed with balls that roll, for the defect frequencies"),
    ] = None
    measured_order: Annotated[
        str | None,
        typer.Option(
            "--measured-order",
            metavar="NAME,ORDER,ERROR",
            rich_help_panel=PANELS["defect"],
            help="Contact angle, and with --axial the clearance, of a measured order, as bpfi,5.4021,0.0005.",
        ),
    ] = None
    solve: Annotated[
        bool,
        typer.Option(
            "--solve",
            rich_help_panel=PANELS["operation"],
            help="Solve the contacts of the most loaded ball, a minute, and correct the tables by them. Where "
            "tables do not have the bearing, this is done anyway: K is then without the change of preload by "
            "thinner films.",
        ),
    ] = False


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
    order = None if options.measured_order is None else measured.MeasuredOrder.of(options.measured_order)
    job = load_job(source, options.entries())
    for name, given in (("--csv", out.csv), ("--solve", options.solve or None)):
        if given is not None and not any(job.supply_and_heat):
            value = given if given is True else str(given)
            raise InputError(
                name, value, "given with --thermal, --layer or --layer-ratio, whose contacts it shows"
            )
    slip = 0.01 * (options.slip or next((one.cage_slip_percent for one in job.study.defect), None) or 0.0)
    with progress("bearing") as update, job.called():
        orders = [] if order is None else [measured.order_answer(order, job, slip)]
        found = [
            _at(job, k, slip, partial(_update, update, job, k), solve=options.solve)
            for k in range(len(job.studies))
        ]
    conditions = [one.oil_and_heat for one in found if one.oil_and_heat is not None]

    def draw(path: Path) -> None:
        points = [one.coefficients for one in found]
        drawn(over_speed_picture(found[len(found) // 2].state, points, curve(job)), path)

    out.deliver(
        document(job, found, slip, orders),
        partial(write_to, "--csv", out.csv, lambda path: write_text(path, csv_text(conditions), "--csv")),
        partial(_show, job, found, out.json_to),
        *(partial(one.show, out.json_to) for one in orders),
        figure=draw,
    )
    if missing := [(one, key) for one in conditions for key in one.refused]:
        told = "; ".join(f"{key} at {numeral(one.state.speed_rpm)} rpm" for one, key in missing)
        thicker = "give a thicker layer, by --layer or --layer-ratio"
        advice = thicker if any(key != HEAT for _, key in missing) else "leave --solve out, or --thermal"
        complain(f"no films {told}: {advice}")
        raise typer.Exit(FAILED)


def _update(update: Callable[..., object], job: BearingJob, k: int, done: int, total: int, words: str) -> None:
    """Progress of conditions at the speed of number `k` as that of all speeds."""
    update(k * total + done, len(job.studies) * total, words)


def _at(job: BearingJob, k: int, slip: float, update: Callable[..., object], *, solve: bool) -> AtSpeed:
    """All answers at the speed of number `k`."""
    speed, (supply, thermal) = job.speeds[k], job.supply_and_heat
    machine, conditions, excitation = job.answer(speed), None, None
    if supply is not None or thermal is not None:
        given: dict[str, Any] = {"supply": supply, "thermal": thermal, "tilt": job.tilt}
        conditions = oil_and_heat(
            job.bearing_or_pair, job.load, speed_rpm=speed, solve=solve, callback=update, **given
        )
    if job.study.defect:
        excitation = job.bearing.excitation([spall_in(job.study, 0)], job.load, speed_rpm=speed, slip=slip)
    own = job.coefficients(speed) if job.study.operation.hz else machine.supports[0].coefficients
    return AtSpeed(machine, own, slip, conditions, excitation)


def curve(job: BearingJob) -> list[BearingCoefficients]:
    """K and C over speed between those given, as far as the atlas has them."""
    low, high = job.speeds[0], job.speeds[-1]
    if low == high:
        low, high = BESIDE[0] * low, min(BESIDE[1] * high, job.bearing.highest_speed)
    found = []
    for k in range(CURVE):
        share = k / (CURVE - 1)
        speed = low * (high / low) ** share if low > 0.0 else share * high
        try:
            found.append(job.coefficients(speed))
        except InputError:  # slower, the atlas has no films under such loads
            continue
    return found


def document(
    job: BearingJob, found: Sequence[AtSpeed], slip: float, orders: Sequence[measured.OrderAnswer] = ()
) -> dict[str, Any]:
    """For JSON; arrays over balls have a row per ball, with inner and outer race."""

    def each(rows: list[list[Any]]) -> list[Any]:
        return [row[0] for row in rows] if job.pair is None else rows

    under_load = [[None if one is None else asdict(one) for one in at.orders.values()] for at in found]
    content: dict[str, Any] = {"bearing": job.bearing.to_dict(), "load": -job.load[1]}
    if len(job.load) > AXIAL:
        content |= {"axial_load": job.load[AXIAL], "moments": job.load[3:] or None, "tilt": job.tilt}
        content["orders_under_load"] = each(under_load)
    if job.study.defect:
        content["spall"] = defect.summary(
            spall_in(job.study, 0), [one.excitation for one in found if one.excitation]
        )
    if job.designation is not None and job.designation.suffixes:
        content["designation"] = {"given": job.designation.given, "suffixes": dict(job.designation.suffixes)}
    if slip:
        content["cage_slip"] = slip
    for one in orders:
        content["measured_order"] = one.to_dict()
    if any(job.supply_and_heat):
        content["oil_and_heat"] = [one.oil_and_heat.to_dict() for one in found if one.oil_and_heat is not None]
    if job.pair is not None:
        pair = job.pair.to_dict()
        content["pair"] = {name: pair[name] for name in ("facings", "positions", "offsets", "spring")}
        content["pair"]["preload"] = job.study.support[0].preload
        content["axial_rigidity"] = [one.state.stiffness[AXIAL, AXIAL] for one in found]
        content["lift_off"] = [_lift_off(job.pair, speed) for speed in job.speeds]
        content["lift_off_at_rest"] = _at_rest(job)
    content |= {
        "highest_speed_rpm": job.bearing.highest_speed,
        "orders": asdict(job.bearing.orders),
        "speed_rpm": list(job.speeds),
        "tiles": [[tile._asdict() for tile in one.machine.tiles()] for one in found],
        "coefficients": [entry for one in found for entry in _coefficients(one.coefficients)],
        "frequencies_hz": each([one.frequencies for one in found]),
        "life": [one.machine.rating_life.to_dict() for one in found],
        "friction": [[one.to_dict() for one in at.machine.supports[0].friction] for at in found],
        "states": [one.state.to_dict() for one in found],
    }
    return {"units": _units(content, found[0])} | content


def _coefficients(at: BearingCoefficients) -> list[dict[str, Any]]:
    """K and C, a row for each frequency."""
    names = {"mean_displacement": at.displacement, "peak_to_peak": at.peak_to_peak}
    return [
        {"speed_rpm": at.speed_rpm, "frequency_hz": hz, "stiffness": K, "damping": C} | names
        for hz, K, C in zip(at.hz.tolist(), at.stiffness, at.damping, strict=True)
    ]


def _units(content: dict[str, Any], at: AtSpeed) -> dict[str, str]:
    """Units of its entries: those that results declare, and words on others."""
    own = at.coefficients.units_by_name()
    found = {name: own[name] for name in ("stiffness", "damping", "peak_to_peak")}
    found["mean_displacement"] = own["displacement"]
    for state in (at.state, *bearings_of(at.state).values()):
        found |= state.units_by_name()
    found |= {name: words for name, words in UNITS.items() if name in content}
    found |= defect.UNITS if "spall" in content else {}
    found |= measured.UNITS if "measured_order" in content else {}
    return {name: unit for name, unit in found.items() if unit}


def _show(job: BearingJob, found: Sequence[AtSpeed], json_to: str | None) -> None:
    if json_to == STDOUT:
        return
    named = job.designation
    if named is not None and named.suffixes:
        say(f"read as {named.name}: {named.words}")
    name = job.bearing.name or "ball bearing" if job.pair is None else job.pair.name
    say(f"{name}, {_load_words(job)}")
    for one in (job.bearing,) if job.pair is None else (job.pair, job.bearing):
        say("\n".join(f"  {line}" for line in summary_lines(one)))
    if job.pair is not None:
        show_table("", _pair_rows(job), json_to)
    for at in found:
        show_table(f"at {numeral(at.state.speed_rpm)} rpm", _rows(job, at), json_to)
        if at.oil_and_heat is not None:
            _show_conditions(at.oil_and_heat)
        for title, state in bearings_of(at.state).items():
            _show_balls(state, title)
        if at.excitation is not None:
            (orders,) = at.orders.values()
            defect.show(spall_in(job.study, 0), orders, at.excitation)


def _rows(job: BearingJob, at: AtSpeed) -> list[Row]:
    """Tiles, what does not hold, motion of the ring, friction and frequencies at a speed."""
    (support,) = at.machine.supports
    rows = [(tile.name, f"{tile.value} {tile.unit}", tile.note) for tile in at.machine.tiles()]
    rows += [("NOT AS ASSUMED", "", text.removeprefix(f"{support.label}: ")) for text in at.machine.reservations]
    rows += _pair_state(job, at.state)
    rows += [row for k in range(at.coefficients.hz.size) for row in _motion(at.coefficients, k)]
    return rows + _friction(support) + _defects(at)


def _friction(support: SupportState) -> list[Row]:
    """Sliding part of the friction torque, and the torque by SKF's model, also of a pair."""
    rows = []
    if support.friction:
        sliding = sum(one.sliding for one in support.friction)
        law = f"differential slip and spin, limiting shear stress {USUAL_LAW.coefficient:g} p"
        rows.append(("sliding in contacts", in_unit(sliding, "N m"), law))
    if support.skf_torque is not None:
        parts = (sum(getattr(one, f"skf_{name}") for one in support.friction) for name in ("rolling", "sliding"))
        of = " and ".join(in_unit(part, "N m") for part in parts)
        rows.append(("friction by SKF", in_unit(support.skf_torque, "N m"), f"rolling and sliding {of}"))
    return rows


def _motion(at: BearingCoefficients, k: int) -> list[Row]:
    """Displacement of the ring, and K and C of its small vibrations at a frequency, direction by direction."""
    rows = []
    for axis, name in WAYS.items():
        way = FIVE.index(axis)
        if way >= at.load.size:
            continue
        tilts = way > AXIAL
        stiffness, damping = at.stiffness[k, way, way], at.damping[k, way, way]
        size, unit = (1e3, "mrad") if tilts else (1e6, "µm")
        K = f"{numeral(1e-3 * stiffness)} N m/mrad" if tilts else in_unit(stiffness, "N/m")
        place = numeral(round(size * at.displacement[way], DECIMALS))
        passage = numeral(round(1e3 * size * at.peak_to_peak[way], DECIMALS), 3)
        moves = f"{axis} = {place} {unit}, varies by {passage} {'µrad' if tilts else 'nm'} as balls pass"
        rows.append((name, K, f"{numeral(damping)} {'N m s/rad' if tilts else 'N s/m'}; {moves}"))
    shaft = ", that of the shaft" if math.isclose(at.hz[k], at.speed_rpm * RPM_TO_HZ) else ""
    return [*rows, ("all at", f"{numeral(at.hz[k])} Hz", f"means over a ball passage{shaft}")]


def _show_conditions(found: OilAndHeat) -> None:
    """Table of a bearing under the conditions, of its most loaded ball and as a whole, with its notes."""
    heads, rows = columns(found)
    where = " and ".join(found.ways)
    show_columns(heads, rows, f"oil supply and heat: films of the most loaded ball, K and C {where}", named=True)
    for line in filter(None, (skf_words(found), *found.notes)):
        say(f"  {line.removesuffix('.')}.")


def _load_words(job: BearingJob) -> str:
    """The load in words."""
    radial = f"{numeral(-job.load[1])} N"
    if len(job.load) <= AXIAL:
        return radial
    given = " and ".join(map(numeral, job.load[3:]))
    moments = f", moments {given} N m about x and y" if given else ""
    tilt = "" if job.tilt is None else f", tilted by {' and '.join(numeral(1e3 * t) for t in job.tilt)} mrad"
    return f"{radial} radially, {numeral(job.load[AXIAL])} N axially{moments}{tilt}"


def _pair_rows(job: BearingJob) -> list[Row]:
    """Preload of a pair by offsets, and axial loads that unload it at rest without films."""
    preload = job.study.support[0].preload
    rows = [] if preload is None else [("preload", in_unit(preload, "N"), "at mounting, by offsets")]
    return rows + [
        ("unloaded from", in_unit(load, "N"), f"axial load in {direction} at rest without films")
        for direction, load in _at_rest(job).items()
    ]


def _lift_off(pair: BearingSet, speed_rpm: float) -> dict[str, float]:
    """Axial loads alone that unload a bearing of a pair, by direction [N]; infinite where none does."""
    return {one: pair.lift_off(one, speed_rpm=speed_rpm) for one in FACINGS}


def _at_rest(job: BearingJob) -> dict[str, float]:
    """Those of a preloaded pair without films, as catalogues state them."""
    found = {} if job.dry_pair is None else _lift_off(job.dry_pair, 0.0)
    return {one: load for one, load in found.items() if 0.0 < load < math.inf}


def _pair_state(job: BearingJob, state: Any) -> list[Row]:
    """Axial forces and axial rigidity of a pair, and whether its preload is used up."""
    if job.pair is None:
        return []
    forces = ", ".join(numeral(round(one, DECIMALS)) for one in state.axial_forces.tolist())
    beyond = any(
        job.load[AXIAL] * (1.0 if direction == "+z" else -1.0) >= load for direction, load in _at_rest(job).items()
    )
    kept = "without them and at rest a bearing is unloaded: only films and centrifugal force press its balls"
    return [
        *([("PRELOAD USED UP", "", kept)] if beyond else []),
        ("axial forces", f"{forces} N", "of the bearings, along their facings"),
        ("axial rigidity", in_unit(state.stiffness[AXIAL, AXIAL], "N/m"), "static, with a ball under the load"),
    ]


def _defects(at: AtSpeed) -> list[Row]:
    """Defect frequencies at a speed in Hz, with their orders."""
    rows = []
    for (title, orders), hertz in zip(at.orders.items(), at.frequencies, strict=True):
        if orders is None or hertz is None:
            continue
        which = f"{title.partition(',')[0]}: " if title else ""
        for name, meaning in DEFECTS.items():
            order = numeral(getattr(orders, f"{name.lower()}_order"), 5)
            rows.append((name, f"{numeral(hertz[name.lower()])} Hz", f"{which}{order} per turn: {meaning}"))
    if at.slip:
        rows.append(("cage slip", f"{numeral(100.0 * at.slip)} %", "in these four"))
    return rows


def _show_balls(state: BearingState, title: str) -> None:
    """Every ball of a bearing at rest, from the one under the load on."""
    few = state.asperity_share is None or state.asperity_share.max() <= NOTICED
    heads = {name: head for name, head in BALLS.items() if not (few and name == "asperity_share")}
    digits = 4 if state.contact_angles is None else 3  # so that seven columns fit
    shown, rows = columns_over(state, heads, digits)
    turned = np.degrees(state.angles - state.angles[0])
    show_columns(
        ["ball", *shown], [[f"{angle:.0f}°", *row] for angle, row in zip(turned, rows, strict=True)], title
    )
