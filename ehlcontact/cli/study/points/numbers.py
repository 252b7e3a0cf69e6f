"""Numbers of a point of a study: unit, meaning, and how tables and pictures for people show them."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot
from typing import Any, NamedTuple

from ehlcontact.cli.study.points.lists import Point
from reduced_models.rotor.support_state import RELY_ON_SKF


class Number(NamedTuple):
    """A number of a point; those of a contact are of [contact], else of the worst bearing of the machine."""

    unit: str
    meaning: str = ""  # of what has a column, and where the name does not say it
    head: str = ""  # of its column in the table for people, which has no other numbers
    factor: float = 1.0  # from its unit to that of the table and the picture
    figures: int = 3
    label: str = ""  # of its panel in the picture, which has no other numbers


NUMBERS = {
    "speed_rpm": Number("rev/min", head="speed [rpm]", figures=6),
    "radial_load": Number("N", "on the bearing that the study is about", head="load [N]", figures=6),
    "ball_load": Number("N", "load of the most loaded ball", head="ball [N]"),
    "mode_hz": Number("Hz", "lowest mode of the machine", head="mode [Hz]", figures=4, label="lowest mode [Hz]"),
    "critical_rpm": Number(
        "rev/min",
        "critical speed nearest to the speed, of a mode that unbalance excites; empty where none is in the range",
        head="critical [rpm]",
        figures=5,
    ),
    "critical_damping": Number("-", "damping ratio of its mode"),
    "mode_damping": Number("-", "damping ratio of the lowest mode"),
    "peak": Number("m", "largest response to unbalance, linear peak"),
    "response": Number(
        "m",
        "largest response to unbalance, at the speed",
        head="response [µm]",
        factor=1e6,
        label="response to unbalance [µm]",
    ),
    "torque": Number(
        "N m",
        "friction of all bearings by films and sliding, "
        f"above {RELY_ON_SKF:.0f} rev/min by SKF's model where it has them, with a jump there",
        head="torque [N mm]",
        factor=1e3,
        label="friction torque [N mm]",
    ),
    "l10rh": Number("h", "basic rating life of all bearings together", head="L10rh [h]"),
    "lnmrh": Number(
        "h", "modified rating life of all bearings together", head="Lnmrh [h]", label="modified rating life [h]"
    ),
    "lnmrh_film": Number("h", "modified rating life with the viscosity ratios of the solved films"),
    "capacitance": Number(
        "F", "of the films of all bearings, shaft to housing", head="capacitance [pF]", factor=1e12
    ),
    "field": Number("V/um", "largest in a film, under the voltage between shaft and housing", head="field [V/µm]"),
    "M": Number("-"),
    "L": Number("-"),
    "kappa": Number("-"),
    "p_hertz": Number(
        "Pa", "largest Hertz pressure, of the machine or of the contact", head="p_h [GPa]", factor=1e-9
    ),
    "u_sum": Number("m/s"),
    "h_central": Number(
        "m", "central film of the contact", head="h_c [µm]", factor=1e6, label="central film [µm]"
    ),
    "h_central_error": Number("of h_central"),
    "h_min": Number(
        "m",
        "smallest film, of the contact or of the worst one of the machine",
        head="h_min [µm]",
        factor=1e6,
        label="smallest film [µm]",
    ),
    "h_min_error": Number("of h_min"),
    "lambda": Number(
        "-", "smallest film over the roughness of both surfaces", head="lambda", label="lambda ratio"
    ),
    "stiffness": Number(
        "N/m",
        "of one contact, at the frequency of the shaft",
        head="K [N/µm]",
        factor=1e-6,
        label="stiffness of a contact [N/µm]",
    ),
    "damping": Number(
        "N s/m",
        "of one contact, at the frequency of the shaft",
        head="C [N s/m]",
        label="damping of a contact [N s/m]",
    ),
    "decay_hz": Number("Hz", "vibration of the kicked rotor, on the full film", head="decay [Hz]", figures=4),
    "decrement": Number(
        "-", "logarithmic, of the vibration of the kicked rotor", head="decrement", label="logarithmic decrement"
    ),
}
UNITS = {name: one.unit for name, one in NUMBERS.items()}
MEANINGS = {name: one.meaning for name, one in NUMBERS.items() if one.meaning}


def numbers_of(point: Point, results: Mapping[str, Any] | None) -> dict[str, float | None]:
    """Numbers by `UNITS`; those that follow from the study alone do not depend on stages."""
    study, rough = point.study, point.study.roughness
    found: dict[str, float | None] = dict.fromkeys(UNITS)
    found |= {"speed_rpm": study.speed_rpm, "radial_load": study.operation.radial_load}
    if results is not None and (machine := results.get("machine")) is not None:
        found |= {name: machine["numbers"][name] for name in UNITS if name in machine["numbers"]}
    if study.contact is not None:
        found["radial_load"] = study.radial_load
        m, s = study.point.moes, study.point.scales
        found |= {"ball_load": study.ball_load, "M": m.M, "L": m.L, "kappa": m.kappa}
        found |= {"p_hertz": s.pressure, "u_sum": study.point.u_sum}
    if results is not None and "operating_point" in results:
        at, moved = results["operating_point"], results["at_rotor_speed"]
        h_central, h_min = (1e-6 * at[name] for name in ("h_central_um", "h_min_um"))
        found |= {"h_central": h_central, "h_min": h_min}
        found |= {name: at[name] for name in ("h_central_error", "h_min_error")}
        found |= {"lambda": None if rough is None else h_min / hypot(*rough)}
        found |= {name: moved[name] for name in ("stiffness", "damping")}
    if results is not None and "rotor" in results:
        decayed = results["rotor"]["decay"]["decrements"]["full"]
        found |= {"decay_hz": decayed["hz"], "decrement": decayed["decrement"]}
    return found
