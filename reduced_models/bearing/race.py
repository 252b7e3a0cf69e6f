"""One race: its contact with a ball, and the law of that contact at a speed. The one place that asks the atlas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import log
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Geometry, Lubricant, OperatingPoint
from ehlcontact.errors import InputError
from ehlcontact.hertz import hertz_contact, radius_ratio
from reduced_models.atlas.atlas import LOADS, NEIGHBOURS, Atlas
from reduced_models.bearing.kinematics import RADIANS, rolling_radius
from reduced_models.bearing.law import scales_of
from reduced_models.elements.kinds import WideRangeContact

_Floats = NDArray[np.float64]

INSIDE = 1e-9  # relative, that points asked for keep from the ends of the atlas: those are rounded
APART = 10.0  # ratio of the loads that elements are put together of
POWER_OF_SPEED = 4.0  # L is the fourth root of a speed
SOME_SPEED = 1000.0  # rev/min, at which an oil is tried


@lru_cache(maxsize=4)
def shared_atlas(path: str | None) -> Atlas:
    """The atlas of a file, or the shipped one, read once."""
    return Atlas(path)


@dataclass(frozen=True)
class Race:
    """Contact of a ball with one race.

    Parameters
    ----------
    name : {"inner", "outer"}
    geometry : Geometry
    ball_diameter : float
        In m.
    conformity : float
        Groove radius over ball diameter.
    oil : Lubricant or None
        None is dry.
    rolling : float
        Sum of the surface speeds over the angular speed of the shaft [m].
    atlas : str or None
        File of another atlas than the shipped one.
    """

    name: str
    geometry: Geometry
    ball_diameter: float
    conformity: float
    oil: Lubricant | None
    rolling: float
    atlas: str | None = None

    @cached_property
    def kn(self) -> float:
        """Force over approach^1.5 of the dry contact [N/m^1.5]."""
        body = self.geometry
        return float(hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).approach ** -1.5)

    def point(self, load: float, speed_rpm: float) -> OperatingPoint:
        """Operating point of the contact under a load [N] at a speed of the shaft."""
        assert self.oil is not None
        return OperatingPoint(self.geometry, self.oil, load, self.rolling * speed_rpm * RADIANS)

    @property
    def highest_speed(self) -> float:
        """Speed of the shaft [rev/min] up to which the atlas reaches."""
        L = self.point(1.0, 1.0).moes.L
        return float((shared_atlas(self.atlas).box.L[1] / L) ** POWER_OF_SPEED * (1.0 - INSIDE))

    def loads(self, speed_rpm: float) -> tuple[float, float]:
        """Range of loads [N] that the atlas knows at this speed."""
        box, unit = shared_atlas(self.atlas).box, self.point(1.0, speed_rpm).moes
        highest = min(box.M[1] / unit.M, (box.p_hertz / unit.p_hertz) ** 3)
        return box.M[0] / unit.M * (1.0 + INSIDE), highest * (1.0 - INSIDE)

    def element(self, speed_rpm: float) -> WideRangeContact:
        """Contact element of all loads that the atlas knows at this speed, in SI.

        The atlas gives a wide element about one load, best there; several, `APART` in load, are put together.
        """
        atlas, (low, high) = shared_atlas(self.atlas), self.loads(speed_rpm)
        steps = max(int(np.ceil(log(high / LOADS[-1] / low) / log(APART))), 1)
        at = np.geomspace(low, high / LOADS[-1], steps + 1)
        found = [atlas.element(self.point(load, speed_rpm), "wide") for load in at.tolist()]
        return _joined([element for element in found if isinstance(element, WideRangeContact)])

    def films(self, speed_rpm: float, load: _Floats, gap: _Floats) -> tuple[_Floats, _Floats]:
        """Central and smallest film [m] under loads [N] at this speed.

        Below the lightest load that the atlas has, the bodies are as good as rigid: both are the `gap`.
        """
        atlas, lightest = shared_atlas(self.atlas), self.loads(speed_rpm)[0]
        central, smallest = gap.copy(), gap.copy()
        for k in np.flatnonzero(load >= lightest).tolist():
            answer = atlas.at(self.point(float(load[k]), speed_rpm)).si
            central[k], smallest[k] = answer.h_central, answer.h_min
        return central, smallest

    def require_in_atlas(self) -> None:
        """Raise `InputError` for a conformity whose ellipse, or an oil, that the atlas does not have."""
        low, high = shared_atlas(self.atlas).box.kappa
        if not low <= self.geometry.kappa <= high:
            ends = [_conformity(self, kappa) for kappa in (low, high)]
            between = f"at least {ends[0]:.4f}" if ends[1] is None else f"between {ends[0]:.4f} and {ends[1]:.4f}"
            allowed = f"{between}: its ellipse, a/b = {self.geometry.kappa:.4g}, lies outside the atlas"
            raise InputError(f"conformity_{self.name}", self.conformity, f"{allowed} ({low:g} to {high:g})")
        self.element(min(self.highest_speed, SOME_SPEED))  # raises where the oil is none of the atlas


def race_of(bearing: Any, name: str) -> Race:
    """Contact of a `BallBearing` with one race; what is wrong with its conformity is said of that race's."""
    conformity = getattr(bearing, f"conformity_{name}")
    material = {"e1": bearing.youngs_modulus, "e2": bearing.youngs_modulus}
    material |= {"nu1": bearing.poisson_ratio, "nu2": bearing.poisson_ratio}
    try:
        body = Geometry.ball_bearing(bearing.ball_diameter, bearing.pitch_diameter, conformity, name, **material)
    except InputError as error:
        own = {"conformity": f"conformity_{name}", "e1": "youngs_modulus", "nu1": "poisson_ratio"}
        raise InputError(own.get(error.field, error.field), error.value, error.allowed) from None
    rolling = rolling_radius(bearing.pitch_diameter, bearing.gamma)
    return Race(name, body, bearing.ball_diameter, conformity, bearing.oil, rolling, bearing.atlas)


def _joined(pieces: Sequence[WideRangeContact]) -> WideRangeContact:
    """One element of those about one load each: near every load, what the element nearest to it says."""
    unit = scales_of(pieces[-1])
    rows = []
    for piece in pieces:
        force, length = scales_of(piece).force / unit.force, scales_of(piece).length / unit.length
        for load, u, gain in zip(piece.loads, piece.approach, piece.gains, strict=True):
            rows.append((abs(log(load)), log(load * force), u * length, gain))
    taken: list[Any] = []
    for row in sorted(rows, key=itemgetter(0)):
        if all(abs(row[1] - other[1]) > log(NEIGHBOURS) for other in taken):
            taken.append(row)
    _, x, approach, gains = zip(*sorted(taken, key=itemgetter(1)), strict=True)
    loads = tuple(np.exp(x).tolist())
    return WideRangeContact(
        loads=loads,
        approach=approach,
        gain_loads=loads,
        gains=gains,
        squeeze=0.0,
        lag_rate=pieces[0].lag_rate,
        inlet_rate=pieces[0].inlet_rate,
        fast_rate=pieces[0].fast_rate,
        omega_range=pieces[0].omega_range,
        units="SI",
        scales=unit,
        fit=pieces[-1].fit,
        source=pieces[-1].source,
    )


def _conformity(race: Race, kappa: float) -> float | None:
    """Conformity at which this contact has the ellipse ratio `kappa`; None where none is so wide."""
    closeness = 2.0 - race.ball_diameter * radius_ratio(kappa) / race.geometry.radius_x
    return 1.0 / closeness if closeness > 0.0 else None
