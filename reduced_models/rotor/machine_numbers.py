"""A `MachineState` in single numbers: what tables, pictures over many machines and their samples have of it."""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple

from reduced_models.life.system_life import HOURS


class Quantity(NamedTuple):
    """A number of a machine in words, and its unit."""

    words: str
    unit: str


QUANTITIES = {
    "critical_rpm": Quantity("critical speed", "rev/min"),
    "critical_damping": Quantity("damping ratio at the critical speed", ""),
    "peak": Quantity("largest response to unbalance, linear peak", "m"),
    "response": Quantity("response to unbalance at the speed", "m"),
    "mode_hz": Quantity("lowest mode", "Hz"),
    "mode_damping": Quantity("damping ratio of the lowest mode", ""),
    "h_min": Quantity("smallest film", "m"),
    "lambda": Quantity("lambda", ""),
    "ball_load": Quantity("largest ball load", "N"),
    "p_hertz": Quantity("largest Hertz pressure", "Pa"),
    "l10rh": Quantity("basic rating life", "h"),
    "lnmrh": Quantity("modified rating life", "h"),
    "lnmrh_film": Quantity("modified rating life by the solved film", "h"),
    "torque": Quantity("friction torque", "N m"),
    "capacitance": Quantity("capacitance of the films", "F"),
    "field": Quantity("largest field in a film", "V/um"),
}


def machine_numbers(machine: Any) -> dict[str, float | None]:
    """Numbers of a machine by `QUANTITIES`, of its worst bearing or of all together; None where there is none.

    The critical speed is that nearest to the speed, of a mode that an unbalance excites.
    """
    supports = machine.supports
    found: dict[str, float | None] = dict.fromkeys(QUANTITIES)
    found["ball_load"] = max(one.ball_load for one in supports)
    found["p_hertz"] = max(one.p_hertz for one in supports)
    films = [one for one in supports if one.h_min is not None]
    if films:
        thinnest = min(films, key=lambda one: float(one.h_min))
        found |= {"h_min": thinnest.h_min, "lambda": thinnest.lambda_ratio}
    if machine.modes:
        found |= {"mode_hz": machine.modes[0].hz, "mode_damping": machine.modes[0].damping_ratio}
    nearest = machine.nearest_critical
    if nearest is not None and machine.is_excited(nearest):
        found |= {"critical_rpm": nearest.speed_rpm, "critical_damping": damping_ratio(nearest)}
    for name, orbit in (("response", machine.response_at_speed), ("peak", largest_orbit(machine))):
        found[name] = None if orbit is None else orbit.size
    found |= {name: getattr(machine.rating_life, name) for name in HOURS}
    for name in ("torque", "capacitance"):
        each = [getattr(one, name) for one in supports]
        found[name] = sum(each) if each and None not in each else None
    found["field"] = machine.field_strength
    return found


def damping_ratio(critical: Any) -> float:
    """Damping ratio of the mode of a critical speed."""
    decrement = float(critical.decrement)
    return decrement / float((4.0 * pi * pi + decrement * decrement) ** 0.5)


def largest_orbit(machine: Any) -> Any:
    """The larger of the responses at critical speeds and between them; None without an unbalance."""
    orbits = [one for one in (machine.largest_response, machine.largest_peak) if one is not None]
    return max(orbits, key=lambda one: float(one.size), default=None)
