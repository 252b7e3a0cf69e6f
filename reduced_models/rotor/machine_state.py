"""`machine_state`: a rotor on ball bearings at a speed, in the numbers that its designer asks for.

Its supports (`support_state`), modes, critical speeds, response to unbalance, the highest speed that the data
cover, and what does not hold. All of it is computed elsewhere. `single_bearing_state` is a bearing alone, as a
machine of one support.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.capacitance import BREAKDOWN
from ehlcontact.checks import as_column, parts, require_positive
from ehlcontact.checks.kinds import Object, Objects
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.results.picture import Panel, Picture
from ehlcontact.summary import Summary
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.coefficients import BearingCoefficients
from reduced_models.bearing.kinematics import RPM_TO_HZ, RPM_TO_RAD_S
from reduced_models.bearing.picture import load_zone
from reduced_models.bearing.race import beyond_data
from reduced_models.bearing.ring import RingEquilibrium
from reduced_models.bearing.ring_statics import state_of
from reduced_models.life.bearing_life import finite
from reduced_models.life.life_modification import BASIC_RELIABILITY
from reduced_models.life.system_life import HOURS, SystemLife
from reduced_models.rotor.bearing_set import BearingSet
from reduced_models.rotor.campbell import BESIDE, Campbell, CriticalSpeed, campbell_of
from reduced_models.rotor.damping_budget import DampingBudget, budget_of
from reduced_models.rotor.equilibrium import StaticRotor
from reduced_models.rotor.linearise import LinearRotor, linearise
from reduced_models.rotor.machine_numbers import machine_numbers
from reduced_models.rotor.machine_tiles import Tile, machine_concerns, machine_tiles
from reduced_models.rotor.modes import ALONG, RotorMode
from reduced_models.rotor.picture import campbell_picture
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.support_state import SupportState, states_of, support_of, support_state
from reduced_models.rotor.supports import BearingMount
from reduced_models.rotor.unbalance import amplification, response_of
from reduced_models.rotor.unbalance_result import UnbalanceResponse

_Floats = NDArray[np.float64]

MODES = 6  # of the machine, the slowest
# Speeds of the response: multiples of the operating speed over PARTS, up to UP_TO times the speed; of the diagram
# every second one, between which frequencies are straight within 1e-4
PARTS, UP_TO, EVERY = 15, 2.0, 2
ABOUT_A_PEAK = -1.0, -0.5, 0.0, 0.5, 1.0  # damping ratios beside a critical speed
SMALL = 0.3  # eccentricity ratio of a damper up to which a linear film stands for it
ROUNDING = 1e-9  # of a multiple of the speed
# Frequencies that the picture shows: multiples of that of the shaft at the highest speed, and room above a mode
SHOWN, SEEN = 2.0, 1.08
LOADED = re.compile(r"load of (bearing \d+) = \[[^\]]*\]: must be")  # of an `InputError`
LARGE = re.compile(r"\d\.\d+e\+\d+")  # a number with exponent in a message
# Whirl below which a mode turns backward; resonance of such a mode, or of one along the shaft, over the rest of
# the response to unbalance, above which unbalance excites it: as the amplification factor of API 617, below which
# a resonance is no critical speed
BACKWARD, EXCITED = -0.5, 2.5
# Where many machines are answered: such parts of the speed, and frequencies over that of the shaft at the highest
# speed up to which modes are followed; critical speeds are looked at again each
COARSE, FOLLOWED = 3, 1.5
AT_A_BEARING = "housing", "damper"  # parts that are numbered like the bearing there
SPEED_DIGITS = 1e-3  # of the highest speed that the data cover, to which it is looked for


class LargestResponse(NamedTuple):
    """Largest response to unbalance: semi-major axis of an orbit [m], its node, and the speed [rev/min]."""

    size: float
    node: str
    speed_rpm: float


@dataclass(frozen=True, eq=False, kw_only=True)
class MachineState(Summary):
    """A machine at a speed, or a bearing alone: then it has neither modes, critical speeds nor a response.

    Attributes
    ----------
    speed_rpm : float
    supports : tuple of SupportState
    modes : tuple of RotorMode
        The slowest first.
    budget : DampingBudget or None
        Who damps what in these modes; bearings by their labels.
    diagram : Campbell or None
        Modes over the speed.
    response : UnbalanceResponse or None
        Over the speeds of the diagram; None without an unbalance.
    amplifications : tuple of float
        Of each critical speed: resonance of its mode over the rest of the response to unbalance there; of equal
        unbalances at all nodes where the rotor has none. Empty where it is not known.
    peaks : UnbalanceResponse or None
        Over speeds about the critical ones that an unbalance excites: peaks are narrower than steps of `response`.
    ring_orbits : tuple of float
        Of each support: semi-major axis of the orbit of the inner ring in the outer one [m], under the unbalance
        at the speed; empty without an unbalance.
    eccentricities : tuple of (str, float)
        Of each squeeze film damper: its name, and its largest eccentricity ratio by the response to the unbalance
        at the speed, about static equilibrium, its film linear; empty without an unbalance.
    highest_speed : float
        Up to which the data cover this machine [rev/min]: films of the most loaded contacts are in the atlas, and
        its balls stay between the races; infinite where all bearings are dry, or it was not looked for.
    ends : str
        What ends there, in words.
    failed : tuple of str
        What could not be computed, and why.
    contamination : float, str or None
        Of the oil, for the modified rating life, as of `BearingState.life`; None: the basic one alone.
    reliability : float
        Of the modified rating life [%].
    clearances : tuple of (float, float) or None
        Of each support: limits within which its clearance probably is [m], as of its class or of an
        `OperatingClearance`, for the life at both; None where they are not known, empty where none is.
    voltage : float or None
        Between shaft and housing [V], for the field in the films; None: no field is asked for.
    breakdown : float
        Field [V/um] from which films are said to break down: a limit of the user, which no data here support.
    """

    speed_rpm: float
    supports: tuple[SupportState, ...]
    modes: tuple[RotorMode, ...] = ()
    budget: DampingBudget | None = None
    diagram: Campbell | None = None
    response: UnbalanceResponse | None = None
    amplifications: tuple[float, ...] = ()
    peaks: UnbalanceResponse | None = None
    ring_orbits: tuple[float, ...] = ()
    eccentricities: tuple[tuple[str, float], ...] = ()
    highest_speed: float = inf
    ends: str = ""
    failed: tuple[str, ...] = ()
    contamination: float | str | None = None
    reliability: float = BASIC_RELIABILITY
    clearances: tuple[tuple[float, float] | None, ...] = ()
    voltage: float | None = None
    breakdown: float = BREAKDOWN

    def _summary_lines(self) -> list[str]:
        tiles = [str(tile) for tile in self.tiles()]
        bearings = ", ".join(support.label for support in self.supports)
        return [f"{self.speed_rpm:.5g} rev/min on {bearings}", *tiles, *self.reservations]

    @property
    def hz(self) -> float:
        """Frequency of the shaft."""
        return self.speed_rpm * RPM_TO_HZ

    @cached_property
    def critical_speeds(self) -> tuple[CriticalSpeed, ...]:
        """Speeds at which a mode has the frequency of the shaft, in the range of the diagram."""
        return () if self.diagram is None else self.diagram.critical_speeds()

    @takes(critical=Object(CriticalSpeed, "a CriticalSpeed"))
    def margin(self, critical: CriticalSpeed) -> float:
        """By which share of the speed a critical speed lies above it; below 0 it lies below."""
        return critical.speed_rpm / self.speed_rpm - 1.0

    def is_axial(self, critical: CriticalSpeed) -> bool:
        """Whether its mode moves along the shaft."""
        if self.diagram is None:
            return False
        share = self.diagram.axial_share[:, critical.mode]
        return float(np.interp(critical.speed_rpm, self.diagram.speed_rpm, share)) > ALONG

    def is_excited(self, critical: CriticalSpeed) -> bool:
        """Whether an unbalance excites its mode.

        One across the shaft always, wherever its unbalance may be; one along the shaft or against the rotation
        where its resonance is 2.5 times the rest of the response: bearings couple it to what unbalance moves.
        """
        across = critical.whirl > BACKWARD and not self.is_axial(critical)
        return across or self.is_coupled(critical)

    def is_coupled(self, critical: CriticalSpeed) -> bool:
        """Whether its mode is along the shaft or against the rotation and unbalance excites it all the same."""
        across = critical.whirl > BACKWARD and not self.is_axial(critical)
        return not across and self.amplification(critical) > EXCITED

    @takes(critical=Object(CriticalSpeed, "a CriticalSpeed"))
    def amplification(self, critical: CriticalSpeed) -> float:
        """Of `amplifications`, that of a critical speed of this machine; 0 where it is not known."""
        known = zip(self.critical_speeds, self.amplifications, strict=False)
        return next((found for own, found in known if own == critical), 0.0)

    @property
    def nearest_critical(self) -> CriticalSpeed | None:
        """The critical speed nearest to the speed, of a mode that an unbalance excites where there is one."""
        excited = [one for one in self.critical_speeds if self.is_excited(one)]
        return min(excited or self.critical_speeds, key=lambda one: abs(self.margin(one)), default=None)

    @property
    def largest_response(self) -> LargestResponse | None:
        """Largest orbit at the speeds of `response`, which `largest_peak` exceeds."""
        return _largest(self.response)

    @property
    def largest_peak(self) -> LargestResponse | None:
        """Largest orbit at a critical speed, if vibrations stayed small enough for a linear answer."""
        return _largest(self.peaks)

    @property
    def response_at_speed(self) -> LargestResponse | None:
        """Largest orbit at the operating speed."""
        if self.response is None:
            return None
        k = int(np.argmin(np.abs(self.response.speed_rpm - self.speed_rpm)))
        return _orbit(self.response, k, int(np.argmax(self.response.major[k])))

    @property
    def worst_support(self) -> SupportState:
        """Support with the smallest film; where all are dry that with the largest ball load."""
        wet = [support for support in self.supports if support.h_min is not None]
        if wet:
            return min(wet, key=lambda one: one.h_min or inf)
        return max(self.supports, key=lambda one: one.ball_load)

    @cached_property
    def rating_life(self) -> SystemLife:
        """Rating life of every bearing and of all together, with the contamination and the reliability."""
        return self.life(contamination=self.contamination, reliability=self.reliability)

    def life(self, **options: Any) -> SystemLife:
        """Rating life of every bearing and of all together; options and errors as of `BearingState.life`."""
        names: list[str] = []
        for support in self.supports:
            several = len(support.bearings) > 1
            parts = [f" bearing {k}" if several else "" for k in range(len(support.bearings))]
            names += [f"{support.label or 'bearing'}{part}" for part in parts]
        states = (state for support in self.supports for _, state in support.bearings)
        return SystemLife(lives=tuple(state.life(**options) for state in states), names=tuple(names))

    @cached_property
    def lives_at_clearances(self) -> tuple[SystemLife, SystemLife] | None:
        """Rating life with the least and with the largest clearances, under the loads of this machine.

        None where no limits are known, or a bearing does not carry its load at them.
        """
        if not any(self.clearances):
            return None
        found = []
        for end in (0, 1):
            lives = list(self.rating_life)
            for k, (support, limits) in enumerate(zip(self.supports, self.clearances, strict=True)):
                if limits is not None and isinstance(support.bearing, BallBearing):
                    bearing, state = replace(support.bearing, clearance=limits[end]), support.state
                    try:
                        there = bearing.equilibrium(state.load, speed_rpm=state.speed_rpm)
                    except (ConvergenceError, InputError):
                        return None
                    lives[k] = there.life(contamination=self.contamination, reliability=self.reliability)
            found.append(replace(self.rating_life, lives=tuple(lives)))
        return found[0], found[1]

    @cached_property
    def numbers(self) -> dict[str, float | None]:
        """Single numbers of the machine, by `machine_numbers.QUANTITIES`."""
        return machine_numbers(self)

    @property
    def reservations(self) -> tuple[str, ...]:
        """What does not hold at this speed, a text with its number each."""
        growing = [
            f"the vibration of {mode.hz:.4g} Hz grows: damping ratio {mode.damping_ratio:.3g}"
            for mode in self.modes
            if mode.decrement < 0.0
        ]
        undamped = [f"{mode.hz:.4g} Hz: {mode.reservation}" for mode in self.modes if mode.reservation]
        own = (text for support in self.supports for text in support.reservations)
        moved = [f"{ratio:.2g} in the {name}" for name, ratio in self.eccentricities if ratio > SMALL]
        large = (
            f"linear dampers stand for their films up to an eccentricity ratio of {SMALL:g}; the response to"
            f" unbalance goes to {', '.join(moved)}: periodic answers"
            " ([periodic] of a study) are with the films as they are"
        )
        return (*self.failed, *growing, *undamped, *([large] if moved else []), *own)

    @property
    def concerns(self) -> tuple[str, ...]:
        """What is critical at this speed, a text each, with its number and what changes it."""
        return machine_concerns(self)

    @property
    def field_strength(self) -> float | None:
        """Largest field in a film [V/um] under the voltage; None without one, or where a bearing is dry."""
        each = [one.field_per_volt for one in self.supports]
        if self.voltage is None or None in each:
            return None
        return self.voltage * max(one for one in each if one is not None)

    def tiles(self) -> tuple[Tile, ...]:
        """The answer in a few numbers: what report, command line and explorer show first."""
        return machine_tiles(self)

    def picture(self) -> Picture:
        """Load zone of the bearing with the most loaded ball beside the Campbell diagram, round its speeds."""
        own = max(self.supports, key=lambda one: one.ball_load)
        _, state = own.bearings[own.heaviest_ball.bearing]
        panels: list[Any] = [load_zone(state, None, f"{own.label or 'bearing'}: force on the balls [N]")]
        if self.diagram is not None:
            modes = campbell_picture(self.diagram).panels[0]
            assert isinstance(modes, Panel)
            high = max(
                SHOWN * float(self.diagram.speed_rpm[-1]) * RPM_TO_HZ, SEEN * float(self.diagram.hz[:, 0].max())
            )
            end = min(high, SEEN * float(self.diagram.hz.max()))
            seen = [line for line in modes.lines if float(np.min(line.y)) <= end]
            panels.append(replace(modes, lines=seen, y_ends=(0.0, end)))
        return Picture(panels, f"{self.speed_rpm:g} rev/min", columns=len(panels), heights=(340.0,))

    def node_label(self, name: str) -> str:
        """A node in words: that of a bearing by the label of its support."""
        named = {f"bearing {number}": support.label for number, support in enumerate(self.supports)}
        return named.get(name) or name

    @property
    def labelled_response(self) -> UnbalanceResponse | None:
        """`response`, whose nodes at bearings have the labels of the supports."""
        own = self.response
        return None if own is None else replace(own, names=tuple(map(self.node_label, own.names)))

    def to_dict(self) -> dict[str, Any]:
        """All numbers, SI, ready for JSON."""
        largest, peak, own = self.largest_response, self.largest_peak, self.response_at_speed
        return {
            "speed_rpm": self.speed_rpm,
            "supports": [support.to_dict() for support in self.supports],
            "modes": [
                mode.to_dict() | {"damping_ratio": mode.damping_ratio, "axial_share": mode.axial_share}
                for mode in self.modes
            ],
            "budget": None if self.budget is None else self.budget.to_dict(),
            "critical_speeds": [
                {"speed_rpm": one.speed_rpm, "hz": one.hz, "margin": self.margin(one), "decrement": one.decrement}
                | {"axial": self.is_axial(one), "excited": self.is_excited(one)}
                | {"amplification": self.amplification(one)}
                for one in self.critical_speeds
            ],
            "largest_response": None if largest is None else largest._asdict(),
            "largest_peak": None if peak is None else peak._asdict(),
            "response_at_speed": None if own is None else own._asdict(),
            "life": self.rating_life.to_dict(),
            "life_at_clearances": self._ends_of_life(),
            "voltage": self.voltage,
            "breakdown": self.breakdown,
            "numbers": {name: finite(value) for name, value in self.numbers.items()},
            "highest_speed": None if self.highest_speed == inf else self.highest_speed,
            "ends": self.ends,
            "concerns": list(self.concerns),
            "reservations": list(self.reservations),
            "tiles": [tile._asdict() for tile in self.tiles()],
        }

    def _ends_of_life(self) -> dict[str, dict[str, float | None]] | None:
        """Lives with the least and with the largest clearances [h], by their kind."""
        if self.lives_at_clearances is None:
            return None
        ends = zip(("least", "largest"), self.lives_at_clearances, strict=True)
        return {end: {name: finite(getattr(life, name)) for name in HOURS} for end, life in ends}


def _orbit(response: UnbalanceResponse, k: int, node: int) -> LargestResponse:
    """Of a node at the speed of number `k`."""
    name = response.names[node] or f"node {node}"
    return LargestResponse(float(response.major[k, node]), name, float(response.speed_rpm[k]))


def _orbits(linear: LinearRotor, mounts: Sequence[BearingMount]) -> tuple[float, ...]:
    """Semi-major axes of the motions of bearings or dampers under the unbalances at the speed [m]."""
    q = linear._unbalanced(linear.speed_rpm * RPM_TO_RAD_S)
    moved = (mount.rows(q.size)[:2] @ q for mount in mounts)
    return tuple(float(0.5 * (abs(x + 1j * y) + abs(x - 1j * y))) for x, y in moved)


def _eccentricities(linear: LinearRotor, rotor: Rotor, labels: Mapping[str, str]) -> tuple[tuple[str, float], ...]:
    """Of the dampers of a rotor: static displacement and orbit together over the clearance."""
    mounts, size = rotor.film_dampers, rotor.size
    still = [np.linalg.norm(mount.rows(size)[:2] @ linear.rest) for mount in mounts]
    rows = zip(rotor.film_damper_names, mounts, still, _orbits(linear, mounts), strict=True)
    return tuple(
        (_part_label(labels, name), float(away + orbit) / mount.damper.clearance)
        for name, mount, away, orbit in rows
    )


def _largest(response: UnbalanceResponse | None) -> LargestResponse | None:
    if response is None:
        return None
    k, node = np.unravel_index(int(np.argmax(response.major)), response.major.shape)
    return _orbit(response, int(k), int(node))


def single_bearing_state(
    bearing: BallBearing | BearingSet,
    load: ArrayLike,
    speed_rpm: float,
    *,
    tilt: ArrayLike | None = None,
    name: str = "",
    fine: bool = True,
) -> MachineState:
    """A bearing alone, or a set, as a machine of one support; arguments and errors as of `support_state`.

    Not `fine`: the highest speed is not looked for, as in `machine_state`.
    """
    support = support_state(bearing, load, speed_rpm, tilt=tilt, name=name)

    def missing(speed: float) -> str:
        state = bearing.equilibrium(load, speed_rpm=speed, tilt=tilt)
        return "; ".join(one.reservation for one in states_of(state) if one.reservation)

    highest, ends = _highest_speed(missing, speed_rpm, bearing.highest_speed) if fine else (inf, "")
    return MachineState(speed_rpm=speed_rpm, supports=(support,), highest_speed=highest, ends=ends)


@takes(
    rotor=Object(Rotor, "a Rotor"), speed_rpm=parts.SPEED, highest_rpm=parts.SPEED_OR_NONE,
    names=Objects(str, "text"), positions=parts.PLACE,
)  # fmt: skip
def machine_state(
    rotor: Rotor,
    speed_rpm: float,
    *,
    highest_rpm: float | None = None,
    names: Sequence[str] = (),
    positions: Sequence[float] = (),
    fine: bool = True,
) -> MachineState:
    """State of a rotor on ball bearings at a speed: supports, vibrations, and how far the data reach.

    Parameters
    ----------
    rotor : Rotor
        On ball bearings, as `rotor_on_bearings` makes it; other supports are part of it, without a state here.
    speed_rpm : float
        Of the shaft [rev/min].
    highest_rpm : float, optional
        Up to which critical speeds and the response to unbalance are looked for [rev/min]; by default twice the
        speed, or as far as the data reach.
    names : sequence of str
        Of the ball bearings; by default those of the rotor.
    positions : sequence of float
        Of the ball bearings along the shaft [m].
    fine : bool
        False, for many machines: in a quarter of the time, with six speeds in diagram and response, which end
        where the data do. Critical speeds that an unbalance excites are looked at again, so that they, their
        damping and their peaks are those of the fine answer to 1e-3; the highest speed is not looked for, and
        there is no damping budget.

    Returns
    -------
    MachineState

    Raises
    ------
    InputError
        A rotor without ball bearings, a speed of 0, another number of names or positions than of ball bearings;
        what `linearise` refuses.
    ConvergenceError
        The supports do not hold the rotor.
    """
    speed, mounts = require_positive("speed_rpm", speed_rpm), rotor.ball_bearings
    if not mounts:
        raise InputError("rotor", "without ball bearings", "one on ball bearings: they are what a state is of")
    positions = as_column("positions", positions, least=0).tolist()
    for field, values in (("names", names), ("positions", positions)):
        if len(values) not in (0, len(mounts)):
            raise InputError(field, f"{len(values)} of them", f"one for each of {len(mounts)} ball bearings")
    linear = linearise(rotor, speed)
    supports = _supports(linear, names or rotor.ball_bearing_names, positions or [None] * len(mounts))
    most = min(mount.ball_bearing.highest_speed for mount in mounts)
    highest, ends = _highest_speed(lambda at: _missing(rotor, at), speed, most) if fine else (inf, "")
    labels = {own: support.label for own, support in zip(rotor.ball_bearing_names, supports, strict=True)}
    for own, label in labels.items():
        ends = ends.replace(own, label)
    failed: list[str] = []
    last = max(speed, min(highest, most, UP_TO * speed if highest_rpm is None else highest_rpm))
    steps, every = (PARTS, EVERY) if fine else (COARSE, 1)
    speeds = speed / steps * np.arange(1, max(int(steps * last / speed * (1.0 + ROUNDING)), steps) + 1)
    speeds[steps - 1] = speed  # not but for rounding
    shown = speeds[every - 1 :: every]  # in the diagram
    known = {speed: linear}  # diagram and response are of the same linearisations

    def linearised(at: float) -> LinearRotor:
        if at not in known:
            known[at] = linearise(rotor, at)
        return known[at]

    modes = _tried(lambda: linear.modes(MODES), "modes", failed) or ()
    budget = _tried(lambda: budget_of(linear, modes), "damping budget", failed) if modes and fine else None
    count = max(len(modes), 1)
    if rotor.unbalances and (said := _drop_slow(linearised, speeds[:steps].tolist())):
        speeds = speeds[len(said) :]
        failed.append(f"no response to unbalance below {speeds[0]:.5g} rev/min: {said[-1]}")
    if not fine:
        speeds = speeds[: _reached(linearised, speeds.tolist(), speed)]
        count = max(sum(mode.hz <= FOLLOWED * speeds[-1] * RPM_TO_HZ for mode in modes), 1)
    shown = shown[shown <= speeds[-1] * (1.0 + ROUNDING)]
    diagram = _tried(
        lambda: campbell_of(map(linearised, shown[shown >= speeds[0]].tolist()), count),
        "diagram over the speed",
        failed,
    )
    response = None
    if rotor.unbalances:
        response = _tried(
            lambda: response_of(rotor, [linearised(at) for at in speeds.tolist()]), "response to unbalance", failed
        )
    machine = MachineState(
        speed_rpm=speed,
        supports=supports,
        modes=modes,
        budget=None if budget is None else budget.renamed(partial(_part_label, labels)),
        diagram=diagram,
        response=response,
        ring_orbits=() if response is None else _orbits(linear, rotor.ball_bearings),
        eccentricities=() if response is None else _eccentricities(linear, rotor, labels),
        highest_speed=highest,
        ends=ends,
    )
    at = [one.speed_rpm for one in machine.critical_speeds]
    if not fine and at:
        looked = sorted({*speeds.tolist(), *at})
        diagram = _tried(lambda: campbell_of(map(linearised, looked), count), "critical speeds", failed)
        machine = replace(machine, diagram=diagram or machine.diagram)
    met = _tried(lambda: _met(machine, [linearised(one) for one in at]), "modes at critical speeds", failed) or []
    machine = replace(machine, amplifications=tuple(amplification(there, mode) for there, mode in met))
    return replace(
        machine,
        peaks=_peaks(machine, met) if rotor.unbalances else None,
        failed=tuple(_with_labels(text, labels) for text in failed),
    )


def _part_label(labels: Mapping[str, str], name: str) -> str:
    """A part in words: a bearing by its label, what is numbered like it, as "housing 1", as that of it."""
    if labels.get(name):
        return labels[name]
    kind, _, number = name.partition(" ")
    bearing = labels.get(f"bearing {number}", "")
    return f"{kind} of {bearing}" if bearing and kind in AT_A_BEARING else name


def _with_labels(text: str, labels: Mapping[str, str]) -> str:
    """The text of a failure with the label of a bearing in place of its number and its load."""
    return LOADED.sub(lambda found: f"load of {labels.get(found[1]) or found[1]} must be", text)


def _drop_slow(linearised: Callable[[float], LinearRotor], speeds: Sequence[float]) -> list[str]:
    """Why there is no answer at each of the slowest of some speeds; empty where there is one at the first."""
    said = []
    for at in speeds[:-1]:
        try:
            linearised(at)
        except (ConvergenceError, InputError) as error:
            said.append(str(error))
        else:
            break
    return said


def _reached(linearised: Callable[[float], LinearRotor], speeds: Sequence[float], speed: float) -> int:
    """How many of increasing speeds the data reach, the operating speed among them in any case."""
    for k, at in enumerate(speeds):
        try:
            linearised(at)
        except (ConvergenceError, InputError):
            if at > speed:
                return k
    return len(speeds)


def _met(machine: MachineState, linear: Sequence[LinearRotor]) -> list[tuple[LinearRotor, RotorMode]]:
    """The mode of each critical speed, by frequency, whirl and axial share, of the rotor linearised next to it."""
    diagram, found = machine.diagram, []
    for critical in machine.critical_speeds:
        assert diagram is not None
        there = min(linear, key=lambda one: abs(one.speed_rpm - critical.speed_rpm))
        along = float(np.interp(critical.speed_rpm, diagram.speed_rpm, diagram.axial_share[:, critical.mode]))

        def off(mode: RotorMode, critical: CriticalSpeed = critical, along: float = along) -> float:
            apart = abs(mode.whirl - critical.whirl) + abs(mode.axial_share - along)
            return apart + abs(float(np.log(mode.hz / critical.hz)))

        found.append((there, min(there.modes(diagram.omega.shape[1] + BESIDE), key=off)))
    return found


def _peaks(machine: MachineState, met: Sequence[tuple[LinearRotor, RotorMode]]) -> UnbalanceResponse | None:
    """Response about the modes that an unbalance excites, in steps of half the width of their peaks.

    Films are those of the critical speed, which the diagram has by straight lines; frequencies are exact.
    """
    peaks = {}
    for critical, (linear, mode) in zip(machine.critical_speeds, met, strict=False):
        if machine.is_excited(critical) and mode.decrement > 0.0:
            for step in ABOUT_A_PEAK:
                turning = mode.omega * (1.0 + mode.damping_ratio * step)
                peaks[turning / RPM_TO_RAD_S] = linear._unbalanced(turning)
    speeds = sorted(peaks)
    if not speeds:
        return None
    return UnbalanceResponse.of(met[0][0].rotor, np.array(speeds), np.array([peaks[at] for at in speeds]))


def _tried(compute: Callable[[], Any], what: str, failed: list[str]) -> Any:
    """What is computed; None, and the reason among `failed`, where it cannot be."""
    try:
        return compute()
    except (ConvergenceError, InputError) as error:
        failed.append(f"no {what}: {error}")
        return None


def _at_rest(rotor: Rotor, speed: float, q: _Floats | None = None) -> list[RingEquilibrium]:
    """Ball bearings of a rotor in static equilibrium, each in its own frame."""
    stiffness = rotor.matrices(speed * RPM_TO_RAD_S)[2]
    static = StaticRotor(rotor.mounts, rotor.load, stiffness, speed)
    return static.bearings(rotor.equilibrium(speed) if q is None else q)


def _missing(rotor: Rotor, speed: float) -> str:
    """What films of a rotor in equilibrium at a speed go beyond the data, in words; empty where they do not."""
    rows = zip(rotor.ball_bearings, _at_rest(rotor, speed), strict=True)
    said = (beyond_data(mount.ball_bearing, speed, [rest]) for mount, rest in rows)
    return "; ".join(filter(None, said))


def _highest_speed(missing: Callable[[float], str], speed: float, most: float) -> tuple[float, str]:
    """Highest speed up to `most` [rev/min] without anything `missing`, from a speed on, and what ends there."""

    def reason(at: float) -> str:
        try:
            return missing(at)
        except InputError as error:
            words = f"{error.field}: {error.allowed.split(' (here ')[0]}"
            return LARGE.sub(lambda number: f"{float(number[0]):.0f}", words)
        except ConvergenceError as error:
            return str(error)

    if most == inf:
        return inf, ""
    if said := reason(speed):
        return speed, said
    if not (said := reason(most)):
        return most, "the end of the atlas"
    low, high = speed, most
    while high > low * (1.0 + SPEED_DIGITS):
        middle = float(np.sqrt(low * high))
        if words := reason(middle):
            high, said = middle, words
        else:
            low = middle
    return low, said


def _supports(
    linear: LinearRotor, names: Sequence[str], positions: Sequence[float | None]
) -> tuple[SupportState, ...]:
    """Ball bearings of a linearised rotor, the first ball of each at the angle of its mount."""
    rotor, speed, omega = linear.rotor, linear.speed_rpm, np.array([linear.speed_rpm * RPM_TO_RAD_S])
    rows = zip(rotor.ball_bearings, _at_rest(rotor, speed, linear.rest), linear.balls, strict=True)
    found = []
    for k, (mount, rest, balls) in enumerate(rows):
        bearing = mount.ball_bearing
        state = state_of(bearing, rest, bearing.speed(speed), mount.cage_angle)
        words = linear.damping_left_out[k], "", beyond_data(bearing, speed, [rest], omega)
        coefficients = BearingCoefficients.of(
            rest.load,
            speed,
            None,
            omega,
            balls.coefficients(omega),
            [rest],
            state.outside_assumptions,
            None,
            *words,
        )
        found.append(support_of(names[k], positions[k], bearing, state, coefficients))
    return tuple(found)
