"""``--spall`` of ``ehlcontact bearing``: a spall in words, and the strongest lines of force that it makes."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import show_columns, show_table
from ehlcontact.errors import InputError
from reduced_models.bearing.features import Spall
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.height_tables import defect_limits

if TYPE_CHECKING:
    from reduced_models import BallBearing
    from reduced_models.bearing.excitation import BearingExcitation
    from reduced_models.bearing.kinematics import DefectOrders

OPTION = "--spall"
WORDS = "race,length,depth, as outer,0.5,3: mm along the track, um"
SHOWN = 10  # lines in a table
ROUNDING = 1e-12  # of the largest force, below which another one is rounding
UNITS = {
    "spall": "SI; its middle at angle [rad], on the outer race under the load",
    "lines": "of the force on the ring, linear in the depth; reservation: where they are not",
    "hz": "Hz; order times the speed of the shaft",
    "amplitude": "N, N m; of each line, along x, y, z, moments about x, y",
}


def spall_of(text: str) -> Spall:
    """The spall that an option gives: race, length in mm, depth in um.

    Raises
    ------
    InputError
        Not three of these; what a `Spall` refuses.
    """
    race, *sizes = (part.strip() for part in text.split(","))
    try:
        length, depth = map(float, sizes)
    except ValueError:
        raise InputError(OPTION, text, WORDS) from None
    try:
        return Spall(race=race, angle=-pi / 2.0, length=1e-3 * length, depth=1e-6 * depth)
    except InputError as error:
        raise InputError(OPTION, text, f"{WORDS}; {error.field}: {error.allowed}") from None


def require_fit(spall: Spall, bearing: BallBearing, field: str, text: str) -> None:
    """Raise `InputError` for a spall, given as `text`, that the bearing has no place for."""
    assert spall.race is not None
    least, track, deepest = defect_limits(bearing, spall.race)
    if not least <= spall.length <= track:
        allowed = f"from {1e3 * least:.2g} to {1e3 * track:.4g} mm, the track around the {spall.race} race"
        raise InputError(field, text, f"{WORDS}; length: {allowed}")
    if spall.depth > deepest:
        raise InputError(field, text, f"{WORDS}; depth: at most {1e6 * deepest:.4g} um, a ball's radius")


def summary(spall: Spall, found: list[BearingExcitation]) -> dict[str, Any]:
    """For JSON: the spall, and the lines at every speed."""
    names = "order", "hz", "amplitude", "phase", "speed_rpm", "reservation"
    lines = [{name: getattr(one, name) for name in names} for one in found]
    return {"race": spall.race, "angle": spall.angle, "length": spall.length, "depth": spall.depth, "lines": lines}


def show(spall: Spall, orders: DefectOrders | None, found: BearingExcitation) -> None:
    """Table of the strongest lines at one speed, by order; without forces where a ball loses its load."""
    assert orders is not None  # a bearing that is loaded
    defect, name = (orders.bpfi_order, "BPFI") if spall.race == "inner" else (orders.bpfo_order, "BPFO")
    axes = FIVE[: min(found.load.size, 3)]
    forces = found.amplitude[:, : len(axes)]
    forces = np.where(forces > ROUNDING * forces.max(), forces, 0.0)
    strongest = np.sort(np.where(found.order > 0.0, forces.max(axis=1), 0.0).argsort()[::-1][:SHOWN])
    rows = [
        [
            numeral(float(found.order[k]), 5),
            _of_defect(float(found.order[k]), defect, name),
            numeral(float(found.hz[k]), 5),
            *(numeral(float(value), 3) for value in forces[k] if not found.loses_load),
        ]
        for k in strongest.tolist()
    ]
    size = f"{numeral(1e3 * spall.length)} mm, {numeral(1e6 * spall.depth)} um deep"
    title = f"spall of the {spall.race} race, {size}"
    sizes = [] if found.loses_load else [f"{axis} [N]" for axis in axes]
    show_columns(["line", "of", "Hz", *sizes], rows, title)
    if found.reservation:
        show_table("", [("NOT LINEAR", "", found.reservation)], None)


def _of_defect(order: float, defect: float, name: str) -> str:
    """An order as multiples of the defect's and of the shaft's, as ``2 BPFI - 1``."""
    most = int(order / defect) + 10
    times, turns = min(
        ((j, round(order - j * defect)) for j in range(-most, most + 1)),
        key=lambda pair: (round(abs(order - pair[0] * defect - pair[1]), 6), abs(pair[1])),
    )
    parts = [f"{times if times != 1 else ''} {name}".strip()] if times else []
    parts += [f"{'-' if turns < 0 else '+'} {abs(turns)}"] if turns else []
    return " ".join(parts)
