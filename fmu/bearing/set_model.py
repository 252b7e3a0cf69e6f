"""What the FMU of a set of bearings is made from: a rigid shaft without mass, moved from outside."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, require_instance
from ehlcontact.errors import InputError
from fmu.bearing.model import BearingModel, Seat
from reduced_models import BearingSet, Rotor
from reduced_models.bearing.freedoms import FIVE
from reduced_models.rotor.supports import BearingMount

_Floats = NDArray[np.float64]

MOST_BALLS = 128  # of all bearings, some 100 numbers each
MOST_BEARINGS = 32  # two bits of a number in core.h each
OUTER_RING = "outer_ring.z"  # displacement of outer rings on a spring


@dataclass(frozen=True)
class SetModel:
    """A `BearingSet` whose shaft is moved from outside.

    Outer rings that slide under a spring are moved from outside too: their place is where a mass or another
    balance has it, with the force that is an output, that of the spring included.

    Parameters
    ----------
    bearings : BearingSet
    speeds_rpm : float or (float, float)
        Speed of the shaft [rev/min], or lowest and highest one, as of `BearingModel`.
    load : sequence of float, optional
        (Fx, Fy, Fz, Mx, My) on the shaft at 0 [N], [N m], under which the FMU starts at rest; by default none in
        a set that is preloaded, and else all displacements are 0.
    permittivity : float, optional
        Of the oil of all bearings that have oil, as of `BearingModel`.

    Raises
    ------
    InputError
        No set, a speed or a load that it does not take, too many balls.
    """

    bearings: BearingSet
    speeds_rpm: Any
    load: Any = None
    permittivity: float | None = None

    def __post_init__(self) -> None:
        require_instance("bearings", self.bearings, BearingSet, "a BearingSet")
        balls = sum(bearing.balls for bearing in self.bearings.bearings)
        if balls > MOST_BALLS or len(self.bearings.bearings) > MOST_BEARINGS:
            allowed = f"at most {MOST_BALLS} in {MOST_BEARINGS} bearings"
            raise InputError("balls", f"{balls} in {len(self.bearings.bearings)} bearings", allowed)
        if self.permittivity is not None and all(bearing.oil is None for bearing in self.bearings.bearings):
            raise InputError("permittivity", self.permittivity, "left out for dry bearings: their rings touch")
        _ = self.place

    @cached_property
    def rotor(self) -> Rotor:
        """Shaft and outer rings with their mounts."""
        load = np.zeros(len(FIVE)) if self.load is None else as_column("load", self.load, size=len(FIVE))
        return self.bearings.rotor(load)

    @cached_property
    def seats(self) -> tuple[Seat, ...]:
        """All bearings, in their order."""
        models: dict[int, BearingModel] = {}
        made = []
        for k, mount in enumerate(self.rotor.mounts, start=1):
            assert isinstance(mount, BearingMount)
            bearing, size = mount.ball_bearing, self.rotor.size
            model = models.get(id(bearing))
            if model is None:
                oil = None if bearing.oil is None else self.permittivity
                model = models[id(bearing)] = BearingModel(
                    bearing, self.speeds_rpm, directions=mount.directions, permittivity=oil
                )
            made.append(Seat(f"bearing[{k}].", model, mount.rows(size), mount.shift))
        return tuple(made)

    @property
    def directions(self) -> tuple[str, ...]:
        """Displacements that are given."""
        return FIVE if self.rotor.size == len(FIVE) else (*FIVE, OUTER_RING)

    @property
    def angular(self) -> bool:
        """Whether contact angles vary."""
        return True

    @property
    def speeds(self) -> _Floats:
        """Speeds of the tables [rev/min]."""
        return self.seats[0].model.speeds

    @cached_property
    def constant_force(self) -> _Floats:
        """What acts beside the balls, shape (n,) [N]: the spring on outer rings."""
        force = self.rotor.load.copy()
        force[: len(FIVE)] = 0.0
        return force

    @cached_property
    def place(self) -> _Floats:
        """Where shaft and outer rings start [m], [rad]."""
        speed = float(self.speeds[-1])
        if self.load is None and not self.bearings.is_preloaded:
            return np.zeros(self.rotor.size)
        self.bearings.equilibrium(self.rotor.load[: len(FIVE)], speed_rpm=speed)  # refuses what it does not carry
        return self.rotor.equilibrium(speed)

    @cached_property
    def damping_left_out(self) -> str:
        """Damping below zero that elements leave out, in words with the bearing; empty where there is none."""
        said = ((seat.label.rstrip("."), seat.model.damping_left_out) for seat in self.seats)
        return "; ".join(f"{label}: {words}" for label, words in said if words)
