"""Sample of heated contacts for the table of heat: balls in races of bearings, in mineral oils of all grades.

A Sobol sequence over ball, pitch circle, conformity, oil, temperature, thermal load Q and load; races take turns.
Draws that no bearing runs at, that the atlas does not have or whose film needs a finer grid are left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ehlcontact import Domain, Geometry, Heat, InputError, Lubricant, OperatingPoint
from ehlcontact.heat import MINERAL_OIL
from ehlcontact.hertz import hertz_contact
from reduced_models.atlas.sample import between, sobol
from reduced_models.atlas.table import Box

GRADES = (15, 22, 32, 46, 68, 100, 150)
BALL = (0.005, 0.026)  # m
PITCH = (3.2, 6.5)  # over the ball diameter
OSCULATION = (0.006, 0.045)  # conformity less a half
TEMPERATURE = (28.0, 95.0)  # C
THERMAL_LOAD = (0.01, 5.0)
FASTEST = 25.0  # m/s, mean surface speed: 1.2e6 mm/min of pitch circle times speed
PRESSURE = 4.1e9  # Pa
LIGHTEST = 0.95  # M
MORE_LOAD = 0.65  # power of the draw: denser at high load
MESH, WIDEST_MESH = 0.25, 0.33  # over the inlet width, at most; and on the finest grid
INTERVALS = (64, 96, 128, 160, 192)
DEAR_SPARSE = 4  # one contact of so many on the finest grid is solved: they take as long as all others


@dataclass(frozen=True)
class HeatedContact:
    """Ball on a race in pure rolling, with the heat of its film."""

    point: OperatingPoint
    heat: Heat

    @property
    def inlet_width(self) -> float:
        """As `MoesPoint` has it: the order of a batch."""
        return self.point.moes.inlet_width

    def to_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        return {"point": asdict(self.point), "heat": self.heat.to_dict()}


def intervals_of(point: OperatingPoint) -> int | None:
    """Intervals along X that the inlet needs on the default region; None where more than a batch affords.

    The mesh is at most a quarter of the width of the inlet: what heat changes is then within 3 % of that on finer
    grids (docs/heat.md).
    """
    region = Domain.for_point(point.moes)
    inlets = (region.x_out - region.x_in) / point.moes.inlet_width
    for n in INTERVALS:
        if inlets <= MESH * n:
            return n
    return INTERVALS[-1] if inlets <= WIDEST_MESH * INTERVALS[-1] else None


def sample_heated(draws: int, seed: int, box: Box) -> dict[str, HeatedContact]:
    """Contacts by name; more draws add to the fewer."""
    contacts: dict[str, HeatedContact] = {}
    dear = 0
    for i, one in enumerate(_drawn(draws, seed, box)):
        if one is None or (n := intervals_of(one.point)) is None:
            continue
        dear += n == INTERVALS[-1]
        if n < INTERVALS[-1] or dear % DEAR_SPARSE == 1:
            contacts[f"{seed}-{i}"] = one
    return contacts


def _drawn(draws: int, seed: int, box: Box) -> Iterator[HeatedContact | None]:
    for i, share in enumerate(sobol(7, draws, seed).tolist()):
        try:
            yield _contact(("inner", "outer")[i % 2], share, box)
        except InputError:  # an oil, a speed or a load that there is not
            yield None


def _contact(race: str, share: list[float], box: Box) -> HeatedContact | None:
    grade = GRADES[int(share[0] * len(GRADES))]
    oil = Lubricant.iso_vg(grade, temperature=float(np.interp(share[1], (0.0, 1.0), TEMPERATURE)))
    heat = Heat()
    assert oil.temperature_slope is not None
    speed = math.sqrt(between(THERMAL_LOAD, share[2]) * MINERAL_OIL / (oil.temperature_slope * oil.eta0))
    ball, osculation = between(BALL, share[3]), between(OSCULATION, share[4])
    pitch = ball * float(np.interp(share[5], (0.0, 1.0), PITCH))
    body = Geometry.ball_bearing(ball, pitch, 0.5 + osculation, race)
    unit = OperatingPoint(body, oil, 1.0, 2.0 * speed).moes
    pressure = hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).pressure
    most = min((PRESSURE / pressure) ** 3, box.M[1] / unit.M)
    point = OperatingPoint(body, oil, between((LIGHTEST / unit.M, most), share[6] ** MORE_LOAD), 2.0 * speed)
    return HeatedContact(point, heat) if speed <= FASTEST and box.L[0] <= unit.L <= box.L[1] else None
