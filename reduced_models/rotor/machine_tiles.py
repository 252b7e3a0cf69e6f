"""Tiles of a `MachineState`: its answer in a few numbers; and what is critical about it, with what changes it."""

from __future__ import annotations

from math import degrees, inf
from typing import Any, NamedTuple

from ehlcontact.summary import WIDTH
from reduced_models.life.life_modification import MOST_MODIFICATION
from reduced_models.rotor.modes import ALONG
from reduced_models.rotor.picture import STRAIGHT
from reduced_models.rotor.support_state import ABOVE_MEASURED, RELY_ON_SKF

WHIRLS = "forward", "backward"
AXIS = {"x": 0, "y": 1, "z": 2}
MARGIN = 0.15  # of the speed, least separation of a critical speed
FULL_FILM = 3.0  # lambda from which films keep the surfaces apart
BRIEF = 2  # parts of a note in a line, at most
HEAVIER = 0.01  # share of a ball load, above which the centrifugal force of the ball is named
SKF_WITHOUT_PRELOAD = "SKF's model has the load of a bearing alone: a clearance below 0 adds friction to it"
LINEAR = 1.0  # motion of a ring in the other by unbalance over the approach of the balls, up to which it is small


class Tile(NamedTuple):
    """One number of an answer; parts of its note are parted by semicolons."""

    name: str
    value: str
    unit: str
    note: str = ""
    critical: bool = False  # whether `machine_concerns` has something about it
    number: str = ""  # of `machine_numbers.QUANTITIES` that its value is, where it is one

    def __str__(self) -> str:
        note = f" ({self.note})" if self.note else ""
        return f"{self.name} {self.value} {self.unit}".rstrip() + note

    @property
    def brief(self) -> str:
        """The tile with those of the first parts of its note that a line of a terminal has room for."""
        told = self._replace(note="")
        for part in self.note.split("; ")[:BRIEF]:
            longer = self._replace(note=", ".join(filter(None, (told.note, part))))
            told = longer if len(str(longer)) <= WIDTH else told
        return str(told)


def digits(value: float, count: int = 3) -> str:
    """A number with so many digits, those before its point kept; without exponent from 1 to 1e15."""
    text = f"{value + 0.0:.{count}g}"
    if "e" not in text:
        return text
    return f"{float(text):.0f}" if 1.0 <= abs(value) < 1e15 else text


def machine_tiles(machine: Any) -> tuple[Tile, ...]:
    """Film, ball load, life, K and C, modes, critical speeds, response, friction, currents, highest speed."""
    rows = (
        _film,
        _ball_load,
        _life,
        _coefficients,
        _mode,
        _critical,
        _response,
        _friction,
        _capacitance,
        _field,
        _highest,
    )
    return tuple(tile for row in rows if (tile := row(machine)) is not None)


def machine_concerns(machine: Any) -> tuple[str, ...]:
    """Critical speed near by, growing vibration, surfaces that touch, a response that is no small vibration."""
    rows = (_near_critical, _growing, _thin_film, _large_response)
    return tuple(text for row in rows if (text := row(machine)))


def _others(machine: Any, own: Any, words: Any) -> list[str]:
    """Of the other supports: each by its label and what `words` has of it."""
    return [f"{one.label}: {text}" for one in machine.supports if one is not own and (text := words(one))]


def _note(*parts: str) -> str:
    return "; ".join(filter(None, parts))


def _of(machine: Any, own: Any) -> str:
    """Whose the value of a tile is, where there are several supports."""
    return own.label if len(machine.supports) > 1 else ""


def _film(machine: Any) -> Tile | None:
    own = machine.worst_support
    if own.h_min is None:
        return None

    def words(one: Any) -> str:
        if one.h_min is None:
            return "dry"
        beside = "" if one.lambda_ratio is None else f", lambda {digits(one.lambda_ratio)}"
        return f"{digits(1e6 * one.h_min)} µm{beside}"

    ratio = "" if own.lambda_ratio is None else f"lambda {digits(own.lambda_ratio)}"
    of = " ".join(filter(None, (_of(machine, own), f"{own.worst_contact.race_name} race")))
    errors = ", ".join(f"± {digits(100.0 * error, 2)} % {cause}" for cause, error in own.film_errors.items())
    sure = f"uncertain by {errors}" if errors else ""
    note = _note(ratio, of, *_others(machine, own, words), sure)
    return Tile("smallest film", digits(1e6 * own.h_min), "µm", note, bool(_thin_film(machine)), "h_min")


def _ball_load(machine: Any) -> Tile:
    own = max(machine.supports, key=lambda one: one.ball_load)

    def words(one: Any, of_pressure: str = "", of_angle: str = "") -> str:
        angles = one.contact_angles
        at = "" if angles is None else f" at {of_angle}{digits(round(degrees(angles[0]), 1))}°"
        return f"{of_pressure}{digits(1e-9 * one.p_hertz)} GPa{at}"

    def outer(one: Any) -> str:
        heavier = one.outer_load > one.ball_load * (1.0 + HEAVIER)
        return (
            f"at the inner race; {digits(one.outer_load)} N at the outer race, with centrifugal force"
            if heavier
            else ""
        )

    most = max(machine.supports, key=lambda one: one.p_hertz)
    higher = "" if most is own else f"largest Hertz pressure {digits(1e-9 * most.p_hertz)} GPa, {most.label}"
    others = _others(machine, own, lambda one: f"{digits(one.ball_load)} N, {words(one)}")
    pressed = words(own, "Hertz pressure ", "a contact angle of ")
    note = _note(pressed, _of(machine, own), higher, outer(own), *others)
    return Tile("largest ball load", digits(own.ball_load), "N", note, number="ball_load")


def _life(machine: Any) -> Tile | None:
    """Of all bearings together: the modified one where the contamination is known, else the basic one."""
    system = machine.rating_life
    hours = system.lnmrh or system.l10rh
    if hours is None or hours == inf:
        return None
    shortest = min(system, key=lambda one: one.l10rh)
    kind, needs = "basic, 90 %", "the modified one needs an oil and a contamination"
    if system.lnmrh is not None:
        film = "" if system.lnmrh_film is None else f", by the solved film {digits(system.lnmrh_film)} h"
        kind, needs = f"modified, {machine.reliability:g} %, by nu/nu1{film}; basic {digits(system.l10rh)} h", ""
    own = system.names[system.lives.index(shortest)]
    of = f"{own} {digits(shortest.l10rh)} h" if len(system) > 1 else ""
    safety = min(one.pressure_safety for one in system)
    ratings = f"C {digits(1e-3 * shortest.ratings.dynamic, 4)} kN {shortest.ratings.dynamic_source}"
    covered = f"not covered: {system.not_covered[0]}" if system.not_covered else ""
    safe = f"static safety {digits(safety)} by pressure"
    note = _note(kind, _at_cap(system), _by_clearance(machine), _light(system), of, needs, covered, safe, ratings)
    number = "l10rh" if system.lnmrh is None else "lnmrh"
    return Tile("rating life", digits(hours), "h", note, number=number)


def _by_clearance(machine: Any) -> str:
    """Life at both limits of the clearances, of the kind that the tile has."""
    if machine.lives_at_clearances is None:
        return ""
    name = "l10rh" if machine.rating_life.lnmrh is None else "lnmrh"
    lives = [getattr(life, name) for life in machine.lives_at_clearances]
    if None in lives or inf in lives:
        return ""
    given = [
        (one.label, limits)
        for one, limits in zip(machine.supports, machine.clearances, strict=True)
        if limits is not None
    ]
    alone = len({limits for _, limits in given}) == 1
    rows = [("", given[0][1])] if alone else [(f"{label} ", limits) for label, limits in given]
    least, largest = (
        ", ".join(f"{label}{digits(1e6 * limits[end])} µm" for label, limits in rows) for end in (0, 1)
    )
    ends = (
        f"{digits(lives[0])} h at the probable least clearance, {least}",
        f"{digits(lives[1])} h at the probable",
    )
    return f"{ends[0]}, and {ends[1]} largest, {largest}"


def _at_cap(system: Any) -> str:
    """Bearings whose a_ISO is the largest of the standard."""
    names = [name for name, one in zip(system.names, system.lives, strict=True) if one.a_iso == MOST_MODIFICATION]
    of = f" of {', '.join(names)}" if len(system) > 1 else ""
    return f"a_ISO{of} at its cap of {MOST_MODIFICATION:.0f}" if names else ""


def _light(system: Any) -> str:
    """Bearings whose axial load alone keeps them above the least load, which is a radial one by SKF's rule."""
    rows = [(name, one) for name, one in zip(system.names, system.lives, strict=True) if one.needs_axial_load]
    each = [
        f"{name + ': ' if len(system) > 1 else ''}radial load {digits(one.loads.radial)} N below the least load"
        f" {digits(one.least_load)} N against skidding"
        for name, one in rows
    ]
    return f"{', '.join(each)}, the axial load has to make up for it" if each else ""


def _coefficients(machine: Any) -> Tile:
    """Along y, the direction of the weight, of the support with the most loaded ball; with its axial ones."""

    def along(one: Any, axis: str) -> tuple[str, str]:
        k = AXIS[axis]
        return digits(1e-6 * float(one.stiffness[k, k])), digits(float(one.damping[k, k]))

    def axial(one: Any) -> str:
        if len(one.stiffness) <= AXIS["z"]:
            return ""
        K, C = along(one, "z")
        return f"axial {K} N/µm, {C} N s/m"

    def words(one: Any) -> str:
        K, C = along(one, "y")
        return f"{K} N/µm, {C} N s/m, {axial(one)}".removesuffix(", ")

    own = max(machine.supports, key=lambda one: one.ball_load)
    K, C = along(own, "y")
    note = _note(f"damping {C} N s/m", axial(own), _of(machine, own), *_others(machine, own, words))
    which = "stiffness of the most loaded bearing" if len(machine.supports) > 1 else "stiffness"
    return Tile(f"{which} at {digits(machine.hz, 4)} Hz", K, "N/µm", note)


def _mode(machine: Any) -> Tile | None:
    if not machine.modes:
        return None
    lowest, *others = machine.modes
    way = "along the shaft" if lowest.axial_share > ALONG else "across the shaft"
    across = [f"{digits(one.hz, 4)} Hz ({digits(one.damping_ratio, 2)})" for one in others]
    higher = f"higher modes (damping ratio): {', '.join(across)}" if across else ""
    damps = "" if machine.budget is None else machine.budget.share_words(0)
    by = f"damped by {damps}" if damps else ""
    note = _note(f"damping ratio {digits(lowest.damping_ratio, 2)}", way, by, higher)
    return Tile("lowest mode", digits(lowest.hz, 4), "Hz", note, number="mode_hz")


def _critical(machine: Any) -> Tile | None:
    if machine.diagram is None:
        return None
    own = machine.nearest_critical
    if own is None:
        rpm = machine.diagram.speed_rpm
        note = f"above {rpm[0]:.5g} rev/min"
        return Tile("critical speed", f"none up to {digits(float(rpm[-1]), 5)}", "rev/min", note)
    speeds = ", ".join(f"{digits(one.speed_rpm, 5)} {_way(machine, one)}" for one in machine.critical_speeds)
    way = f"{_way(machine, own)} whirl" if _way(machine, own) in WHIRLS else _way(machine, own)
    way += _though(machine, own) if machine.is_excited(own) else ": unbalance hardly excites it"
    note = _note(_side(machine, own), way, f"all: {speeds}" if len(machine.critical_speeds) > 1 else "")
    critical = bool(_near_critical(machine))
    number = "critical_rpm" if machine.is_excited(own) else ""
    return Tile("nearest critical speed", digits(own.speed_rpm, 5), "rev/min", note, critical, number)


def _way(machine: Any, critical: Any) -> str:
    """Along the shaft, forward, backward, or in a plane: how the mode of a critical speed moves."""
    if machine.is_axial(critical):
        return "along the shaft"
    if abs(critical.whirl) < STRAIGHT:
        return "in a plane"
    return "forward" if critical.whirl > 0.0 else "backward"


def _though(machine: Any, critical: Any) -> str:
    """That unbalance excites a mode by which it would not without the bearings; empty of any other."""
    if not machine.is_coupled(critical):
        return ""
    return f": unbalance excites it to {digits(machine.amplification(critical), 2)} times the response beside it"


def _side(machine: Any, critical: Any) -> str:
    """By how much a critical speed lies above or below the speed."""
    share = machine.margin(critical)
    return f"{digits(100.0 * abs(share), 2)} % {'above' if share >= 0.0 else 'below'} the speed"


def _response(machine: Any) -> Tile | None:
    """At the speed; and where it is largest, at steps of the speed and at critical speeds between them."""
    if machine.largest_response is None:
        return None
    most, own, peak = machine.largest_response, machine.response_at_speed, machine.largest_peak
    beside = "" if most == own else _orbit(most)
    narrow = "" if peak is None or peak.size < most.size else f"linear peak {_orbit(peak)}"
    critical = bool(_large_response(machine))
    note = _note(f"at the {machine.node_label(own.node)}", narrow, beside)
    return Tile(
        f"response to unbalance at {digits(own.speed_rpm, 5)} rev/min",
        digits(1e6 * own.size),
        "µm",
        note,
        critical,
        "response",
    )


def _orbit(response: Any) -> str:
    return f"{digits(1e6 * response.size)} µm at {digits(response.speed_rpm, 5)} rev/min"


def _friction(machine: Any) -> Tile | None:
    supports = machine.supports
    torques = [one.torque for one in supports]
    if None in torques:
        return None
    measured = [one.relies_on_skf for one in supports]
    by = "SKF's model" if all(measured) else "SKF's model and films" if any(measured) else "films and sliding"
    each = ", ".join(f"{one.label} {digits(one.torque)}" for one in supports) if len(supports) > 1 else ""
    cold = ", ".join(digits(one.film_torque) for one in supports)
    films = f"rolling of the films alone, without heat: {cold} N m"
    doubt = ABOVE_MEASURED if not all(measured) and machine.speed_rpm > RELY_ON_SKF else ""
    loss = f"{digits(sum(one.loss for one in supports))} W by {by}"
    tight = any(bearing.clearance < 0.0 for one in supports if one.relies_on_skf for bearing, _ in one.bearings)
    note = _note(loss, _other_torque(machine), each, films, doubt, SKF_WITHOUT_PRELOAD if tight else "")
    return Tile("friction torque", digits(sum(torques)), "N m", note, number="torque")


def _other_torque(machine: Any) -> str:
    """The torque on the other side of the speed from which on SKF's model counts, where all bearings have it."""
    by_films = [one.flooded_torque for one in machine.supports]
    by_skf = [one.skf_torque for one in machine.supports]
    if None in by_films or None in by_skf:
        return ""
    if machine.speed_rpm > RELY_ON_SKF:
        return f"films and sliding, which count up to {RELY_ON_SKF:.0f} rev/min: {digits(sum(by_films))} N m"
    return f"SKF's model, which counts above {RELY_ON_SKF:.0f} rev/min: {digits(sum(by_skf))} N m"


def _capacitance(machine: Any) -> Tile | None:
    """Of each bearing between shaft and housing; the largest field per volt where no voltage is known."""
    if any(one.capacitance is None for one in machine.supports):
        return None
    most = max(one.field_per_volt for one in machine.supports)
    field = "" if machine.voltage else f"{digits(most)} V/µm in the thinnest film per volt"
    several = len(machine.supports) > 1
    each = (
        ", ".join(f"{one.label} {digits(1e12 * one.capacitance)}" for one in machine.supports) if several else ""
    )
    total, least, largest = (
        digits(1e12 * sum(ends)) for ends in zip(*(one.capacitance_range for one in machine.supports), strict=True)
    )
    permittivity = f"{machine.supports[0].permittivity:g}"
    oil = f"between {least} and {largest} pF by where oil stands, of permittivity {permittivity}"
    return Tile("capacitance of the films", total, "pF", _note(field, each, oil), number="capacitance")


def _field(machine: Any) -> Tile | None:
    """Largest in the films, and the limit that the user has."""
    field = machine.field_strength
    if field is None:
        return None
    own = max(machine.supports, key=lambda one: one.field_per_volt)

    def words(one: Any) -> str:
        return f"{digits(machine.voltage * one.field_per_volt)} V/µm"

    under = f"{digits(machine.voltage)} V between shaft and housing"
    ratio = digits(field / machine.breakdown, 2)
    limit = f"{ratio} times the limit of {digits(machine.breakdown)} V/µm from which films are said to break down"
    note = _note(under, _of(machine, own), limit, *_others(machine, own, words))
    return Tile("largest field in a film", digits(field), "V/µm", note, number="field")


def _highest(machine: Any) -> Tile | None:
    if machine.highest_speed == inf:
        return None
    return Tile(
        "films are known up to",
        digits(machine.highest_speed),
        "rev/min",
        machine.ends,
    )


def _near_critical(machine: Any) -> str:
    """Nearest critical speed within `MARGIN` that an unbalance excites, and what moves it."""
    own = machine.nearest_critical
    if own is None or not machine.modes or not machine.is_excited(own) or abs(machine.margin(own)) >= MARGIN:
        return ""
    mode = min(machine.modes, key=lambda one: abs(one.hz - own.hz))
    springs = f", {digits(100.0 * mode.housing_share, 2)} % in springs of housings" if mode.housing_share else ""
    shaft = 1.0 - mode.support_share - mode.housing_share
    bends = f"{digits(100.0 * shaft, 2)} % of its strain energy is in the shaft, "
    bends += f"{digits(100.0 * mode.support_share, 2)} % in bearings{springs}"
    _, moves = max(
        (shaft, "a stiffer or shorter shaft moves it"),
        (mode.support_share, "more preload or stiffer bearings move it"),
        (mode.housing_share, "stiffer or softer springs of the housings move it"),
    )
    there = f"{digits(own.speed_rpm, 5)} rev/min, {_side(machine, own)}"
    way = f" {_way(machine, own)}" if machine.is_coupled(own) else ""
    return f"unbalance excites a mode{way} at {there}: {bends}, so {moves}"


def _growing(machine: Any) -> str:
    growing = [mode for mode in machine.modes if mode.decrement < 0.0]
    if not growing:
        return ""
    said = ", ".join(f"{digits(one.hz, 4)} Hz (damping ratio {digits(one.damping_ratio, 2)})" for one in growing)
    return f"vibrations grow at {said}: more damping or more oil keeps them down"


def _thin_film(machine: Any) -> str:
    own = machine.worst_support
    if own.lambda_ratio is None or own.lambda_ratio >= FULL_FILM:
        return ""
    need = f"a full film needs {digits(FULL_FILM)}: thicker oil or smoother surfaces"
    return f"lambda {digits(own.lambda_ratio)} at {own.label or 'the bearing'}, {need}"


def _large_response(machine: Any) -> str:
    """Motion of a ring in the other at the operating speed that is not small beside the approach of the balls."""
    if machine.response is None:
        return ""
    for support, moved in zip(machine.supports, machine.ring_orbits, strict=False):
        pressed = max(float(state.approach[state.heaviest].sum()) for _, state in support.bearings)
        if moved > LINEAR * pressed:
            size = f"{digits(1e6 * moved)} µm, its balls are pressed in by {digits(1e6 * pressed)} µm"
            return (
                f"unbalance moves the inner ring of {support.label} in its outer ring by {size}: no small"
                " vibration; balance better, or run it in time"
            )
    return ""
