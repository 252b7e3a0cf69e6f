"""`RotorModel`: rotor, speeds and inertia of an FMU with the ball bearings inside."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ehlcontact.checks import require_instance, require_nonnegative
from ehlcontact.errors import InputError
from fmu.bearing.model import BearingModel
from fmu.shaft.model import MOST_INPUTS, ShaftModel
from fmu.steps import round_down
from reduced_models.rotor.prepared_run import LEAST_STEPS
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.supports import BearingMount

MOST_BALLS = 128  # of all bearings: a step keeps some hundred numbers of each on the stack
MOST_BEARINGS = 32  # two bits of a number each
LONGEST_STEP = 1e-5  # s


@dataclass(frozen=True, eq=False)
class RotorModel:
    """A rotor with its ball bearings inside.

    Parameters
    ----------
    rotor : Rotor
        On ball bearings; linear ones may be beside them.
    speeds_rpm : float or (float, float)
        Speed of the shaft [rev/min], or lowest and highest one: as of `BearingModel`.
    speed_rpm : float, optional
        Speed at the start, in equilibrium under the load; the highest by default.
    inertia : float, optional
        Polar moment of inertia [kg m2] of all that turns: the speed then follows from the torque of the motor,
        an input. By default the speed is an input.

    Raises
    ------
    InputError
        Contacts as supports, no ball bearing, too many balls; else as `ShaftModel` and `BearingModel`.
    """

    rotor: Rotor
    speeds_rpm: Any
    speed_rpm: float | None = None
    inertia: float | None = None

    def __post_init__(self) -> None:
        require_instance("rotor", self.rotor, Rotor, "a Rotor")
        shaft, stations = self.shaft, self.stations
        balls = sum(mount.ball_bearing.balls for mount in stations)
        if balls > MOST_BALLS or len(stations) > MOST_BEARINGS:
            allowed = f"at most {MOST_BALLS} in {MOST_BEARINGS} bearings"
            raise InputError("balls", f"{balls} in {len(stations)} bearings", allowed)
        inputs = len(shaft.points) + len(self.rotor.unbalances) + 1
        if inputs > MOST_INPUTS:
            allowed = f"at most {MOST_INPUTS}: forces along the directions of named nodes, unbalances, speed"
            raise InputError("inputs", inputs, allowed)

    @property
    def stations(self) -> tuple[BearingMount, ...]:
        """Mounts of the ball bearings."""
        return self.rotor.ball_bearings

    @cached_property
    def shaft(self) -> ShaftModel:
        """The rotor as the FMU of a shaft has it: named nodes, equilibrium at the start."""
        start = self.speed_rpm
        if start is None:
            start = float(self.bearings[0].speeds[-1]) if self.bearings else 0.0
        return ShaftModel(self.rotor, require_nonnegative("speed_rpm", start), self.inertia)

    @cached_property
    def bearings(self) -> tuple[BearingModel, ...]:
        """Each ball bearing as its own FMU has it."""
        return tuple(
            BearingModel(mount.ball_bearing, self.speeds_rpm, directions=mount.directions)
            for mount in self.stations
        )

    @cached_property
    def inner_step(self) -> float:
        """Longest step [s]: 10 us, and 16 in every turn of the shaft and ball passage, as of `simulate_rotor`."""
        fastest = float(self.bearings[0].speeds[-1])
        passages = [mount.ball_bearing.frequencies(fastest).bpfo for mount in self.stations]
        return round_down(min(LONGEST_STEP, 1.0 / (LEAST_STEPS * max(fastest / 60.0, *passages))))
