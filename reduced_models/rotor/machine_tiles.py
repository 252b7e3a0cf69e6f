"""Tiles of a `MachineState`: its answer in a few numbers, each with what belongs to it in a note."""

from __future__ import annotations

from math import degrees, inf
from typing import Any, NamedTuple

from reduced_models.rotor.modes import ALONG

HEAVIEST, SMALLEST = 1e4, 1e-3  # between which numbers are shown without exponent
AXIS = {"x": 0, "y": 1, "z": 2}


class Tile(NamedTuple):
    """One number of an answer."""

    name: str
    value: str
    unit: str
    note: str = ""

    def __str__(self) -> str:
        note = f" ({self.note})" if self.note else ""
        return f"{self.name} {self.value} {self.unit}".rstrip() + note


def digits(value: float, count: int = 3) -> str:
    """A number with so many digits, without exponent where it is neither large nor small; "-0" is 0."""
    text = f"{value + 0.0:.{count}g}"
    if "e" not in text:
        return text
    return f"{float(text):.0f}" if 1.0 <= abs(value) < 1e15 else text


def machine_tiles(machine: Any) -> tuple[Tile, ...]:
    """Film, ball load, stiffness, lowest mode, critical speeds, response, friction, highest speed."""
    rows = (_film, _ball_load, _stiffness, _damping, _mode, _critical, _response, _friction, _highest)
    return tuple(tile for row in rows if (tile := row(machine)) is not None)


def _others(machine: Any, own: Any, words: Any) -> list[str]:
    """Of the other supports: each by its label and what `words` has of it."""
    return [f"{one.label} {text}" for one in machine.supports if one is not own and (text := words(one))]


def _note(*parts: str) -> str:
    return "; ".join(filter(None, parts))


def _film(machine: Any) -> Tile | None:
    own = machine.worst_support
    if own.h_min is None:
        return None
    worst = own.worst_contact
    of = f"{own.label}, {worst.race_name} race"
    ratio = "" if own.lambda_ratio is None else f"lambda {digits(own.lambda_ratio)}"

    def words(one: Any) -> str:
        if one.h_min is None:
            return "dry"
        beside = "" if one.lambda_ratio is None else f", lambda {digits(one.lambda_ratio)}"
        return f"{digits(1e6 * one.h_min)} µm{beside}"

    return Tile("smallest film", digits(1e6 * own.h_min), "µm", _note(ratio, of, *_others(machine, own, words)))


def _ball_load(machine: Any) -> Tile:
    own = max(machine.supports, key=lambda one: one.ball_load)

    def words(one: Any) -> str:
        angles = one.contact_angles
        at = "" if angles is None else f" at {digits(degrees(angles[0]))} degrees"
        return f"{digits(1e-9 * one.p_hertz)} GPa{at}"

    others = _others(machine, own, lambda one: f"{digits(one.ball_load)} N, {words(one)}")
    return Tile("largest ball load", digits(own.ball_load), "N", _note(words(own), own.label, *others))


def _stiffness(machine: Any) -> Tile:
    return _coefficient(machine, "stiffness", 1e-6, "N/µm")


def _damping(machine: Any) -> Tile:
    return _coefficient(machine, "damping", 1.0, "N s/m")


def _coefficient(machine: Any, name: str, factor: float, unit: str) -> Tile:
    """Along y, the direction of the weight, of the support that has least, with x and z beside it."""

    def along(one: Any, axis: str) -> str:
        matrix, k = getattr(one, name), AXIS[axis]
        return digits(factor * float(matrix[k, k])) if k < len(matrix) else ""

    def words(one: Any) -> str:
        ways = [f"{axis} {value}" for axis in "xz" if (value := along(one, axis))]
        return ", ".join(ways)

    own = min(machine.supports, key=lambda one: float(getattr(one, name)[1, 1]))
    others = _others(machine, own, lambda one: f"y {along(one, 'y')}, {words(one)}")
    title = f"{name} at {digits(machine.hz, 4)} Hz, y"
    return Tile(title, along(own, "y"), unit, _note(words(own), own.label, *others))


def _mode(machine: Any) -> Tile | None:
    if not machine.modes:
        return None
    lowest, *others = machine.modes
    way = "along the shaft" if lowest.axial_share > ALONG else "across the shaft"
    note = f"damping ratio {digits(lowest.damping_ratio, 2)}, {way}"
    across = [f"{digits(one.hz, 4)} Hz ({digits(one.damping_ratio, 2)})" for one in others]
    return Tile("lowest mode", digits(lowest.hz, 4), "Hz", _note(note, ", ".join(across)))


def _critical(machine: Any) -> Tile | None:
    if machine.diagram is None:
        return None
    own = machine.nearest_critical
    if own is None:
        rpm = machine.diagram.speed_rpm
        return Tile("critical speeds", "none", f"from {rpm[0]:.5g} to {rpm[-1]:.5g} rev/min")
    share = machine.margin(own)
    side = "above" if share >= 0.0 else "below"
    speeds = ", ".join(digits(one.speed_rpm, 5) for one in machine.critical_speeds)
    note = f"{digits(100.0 * abs(share), 2)} % {side} the speed; all: {speeds}"
    return Tile("nearest critical speed", digits(own.speed_rpm, 5), "rev/min", note)


def _response(machine: Any) -> Tile | None:
    if machine.largest_response is None:
        return None
    most, own = machine.largest_response, machine.response_at_speed
    note = f"{most.node} at {digits(most.speed_rpm, 5)} rev/min"
    here = f"{digits(1e6 * own.size)} µm at {digits(own.speed_rpm, 5)} rev/min, {own.node}"
    return Tile("largest response to unbalance", digits(1e6 * most.size), "µm", _note(note, here))


def _friction(machine: Any) -> Tile | None:
    torques = [one.torque for one in machine.supports]
    if None in torques:
        return None
    by = "SKF" if all(one.relies_on_skf for one in machine.supports) else "films and sliding"
    each = ", ".join(f"{one.label} {digits(one.torque)}" for one in machine.supports)
    films = ", ".join(digits(one.film_torque) for one in machine.supports)
    loss = digits(sum(one.loss for one in machine.supports))
    note = _note(f"{loss} W by {by}", each if len(torques) > 1 else "", f"films resist rolling with {films} N m")
    return Tile("friction torque", digits(sum(torques)), "N m", note)


def _highest(machine: Any) -> Tile | None:
    if machine.highest_speed == inf:
        return None
    return Tile("data cover up to", digits(machine.highest_speed, 3), "rev/min", machine.ends)
