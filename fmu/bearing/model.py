"""What the FMU of a ball bearing is made from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.capacitance import require_permittivity
from ehlcontact.checks import as_numbers, require_instance
from ehlcontact.errors import InputError
from reduced_models import BallBearing
from reduced_models.bearing.ball import Balls
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.freedoms import FIVE, PLANAR
from reduced_models.bearing.motion import BallMotion, motion_of
from reduced_models.bearing.race import RACES
from reduced_models.bearing.solved_balls import damping_left_out, warn_of_damping_left_out
from reduced_models.rotor.speed_profile import law_speeds

_Floats = NDArray[np.float64]

DIRECTIONS = PLANAR, FIVE[:3], FIVE  # in which the inner ring of an FMU may move
MOST_BALLS = 64  # of what an instance remembers, some 100 numbers each
MOST_CONTACTS = 64  # bits of a number in core.h: those that lift off, both of a ball with inertia, else the inner
TRIED = 5  # loads of a ball, from the heaviest to the lightest
MOST_SPEEDS = 4  # of the tables, which then leave an FMU with the binaries of five platforms below a megabyte


@dataclass(frozen=True, eq=False)
class Seat:
    """One bearing of an FMU.

    Attributes
    ----------
    label : str
        In front of its variables: ``bearing[1].``; empty of a bearing alone.
    model : BearingModel
    rows : ndarray, shape (directions, n)
        Motion of its inner ring against the outer one from that which is given.
    shift : ndarray, shape (directions,)
        Displacement of its inner ring beside that.
    """

    label: str
    model: BearingModel
    rows: _Floats
    shift: _Floats

    def ring(self, place: _Floats) -> _Floats:
        """Place of the inner ring, shape (directions,), at a place that is given, shape (n,)."""
        return np.asarray(self.rows @ place + self.shift, np.float64)


@dataclass(frozen=True)
class BearingModel:
    """A ball bearing whose inner ring is moved from outside.

    Under an oil supply it warns, once, where its elements leave out damping below zero (docs/oil_supply.md).

    Parameters
    ----------
    bearing : BallBearing
    speeds_rpm : float or (float, float)
        Speed of the shaft [rev/min], or lowest and highest one: tables of the races are made for these and some
        between.
    load : float or sequence of float, optional
        Force on the inner ring [N], [N m], as of `BallBearing.equilibrium`, under which the FMU starts at rest; a
        number is a weight, in -y. By default the ring starts in the middle, with all displacements 0.
    directions : sequence of str, optional
        In which the inner ring moves, the others are held: ``("x", "y")``, ``("x", "y", "z")``, or these and
        "tilt_x", "tilt_y". By default all five of an angular contact bearing, and of others under an axial load or
        a moment; else x and y.
    permittivity : float, optional
        Of the oil, relative: the capacitance between the rings is then an output.

    Raises
    ------
    InputError
        No bearing, a speed, a load, directions or a permittivity that it does not take, too many balls.
    """

    bearing: BallBearing
    speeds_rpm: Any
    load: Any = None
    directions: Any = None
    permittivity: float | None = None

    def __post_init__(self) -> None:
        require_instance("bearing", self.bearing, BallBearing, "a BallBearing")
        if self.bearing.balls > MOST_BALLS:
            raise InputError("bearing.balls", self.bearing.balls, f"at most {MOST_BALLS} in an FMU")
        if self.bearing.features:
            raise InputError(
                "bearing.features", len(self.bearing.features), "none: an FMU has smooth races and balls"
            )
        if self.permittivity is not None:
            require_permittivity("permittivity", self.permittivity)
            if self.bearing.oil is None:
                raise InputError("permittivity", self.permittivity, "left out for a dry bearing: its rings touch")
        object.__setattr__(self, "directions", self._directions())
        if self.bearing.ball_inertia and 2 * self.bearing.balls > MOST_CONTACTS:
            allowed = f"at most {MOST_CONTACTS // 2} in an FMU, of balls with inertia"
            raise InputError("bearing.balls", self.bearing.balls, allowed)
        _ = self.speeds
        _ = self.place
        self.motion()
        if self.bearing.supply is not None:
            name = self.bearing.name or "ball bearing"
            warn_of_damping_left_out(self.bearing, name, self.damping_left_out)

    @cached_property
    def speeds(self) -> _Floats:
        """Speeds of the tables [rev/min]."""
        given = np.atleast_1d(as_numbers("speeds_rpm", self.speeds_rpm)).astype(float)
        if given.ndim != 1 or given.size not in (1, 2) or (given.size == 2 and not given[0] < given[1]):
            raise InputError("speeds_rpm", given.tolist(), "one speed, or the lowest and the highest one")
        try:
            for speed in given.tolist():
                self.bearing.speed(speed)
        except InputError as error:
            raise InputError("speeds_rpm", error.value, error.allowed) from None
        if given[-1] == 0.0:
            raise InputError("speeds_rpm", 0.0, "> 0: the highest speed at which the bearing turns")
        found = law_speeds(given)
        if found.size > MOST_SPEEDS:
            found = np.geomspace(found[0], found[-1], MOST_SPEEDS)
        return np.asarray([self.bearing.speed(speed) for speed in found.tolist()])

    def _directions(self) -> tuple[str, ...]:
        size = 1 if self.load is None else np.atleast_1d(as_numbers("load", self.load)).size
        axial = self.bearing.contact_angle is not None or size > len(PLANAR)
        if self.directions is None:
            return FIVE if axial else PLANAR
        given = tuple(self.directions) if isinstance(self.directions, tuple | list) else (self.directions,)
        if given not in DIRECTIONS:
            raise InputError("directions", list(given), " or ".join(map(str, DIRECTIONS)))
        if axial and "z" not in given:
            allowed = "with z under an axial load or a moment, and for angular contact bearings"
            raise InputError("directions", list(given), allowed)
        if size > len(given):
            raise InputError("directions", list(given), "with tilts under a load with moments")
        return given

    @property
    def angular(self) -> bool:
        """Whether contact angles vary: balls are in the plane of the grooves where the ring has x and y alone."""
        return "z" in self.directions

    @cached_property
    def place(self) -> _Floats:
        """Where the inner ring starts [m], [rad]."""
        found, n = np.zeros(len(self.directions)), len(self.directions)
        if self._at_rest is not None:
            place = self._at_rest.displacement[:n]  # a load without moments leaves tilts 0
            found[: place.size] = place
        return found

    @cached_property
    def _at_rest(self) -> BearingState | None:
        """The bearing under `load` at the highest speed."""
        if self.load is None:
            return None
        given = as_numbers("load", self.load)
        load = np.array([0.0, -float(given)]) if np.ndim(given) == 0 else given
        return self.bearing.equilibrium(load, speed_rpm=float(self.speeds[-1]))

    @cached_property
    def damping_left_out(self) -> str:
        """Damping below zero under an oil supply, which elements leave out, in words; empty where there is none.

        At the highest speed, under `load`; without one under the largest load of a ball that has any, of `TRIED`.
        """
        bearing, speed = self.bearing, float(self.speeds[-1])
        if bearing.supply is None:
            return ""
        if self._at_rest is not None:
            return damping_left_out(bearing, speed, self._at_rest.force)
        races = [bearing.race(name) for name in RACES]
        low, high = max(one.loads(speed)[0] for one in races), min(one.heaviest(speed)[0] for one in races)
        for load in np.geomspace(high, low, TRIED).tolist():
            if words := damping_left_out(bearing, speed, np.full(len(RACES), load)):
                return f"where a ball carries {load:.3g} N, {words}"
        return ""

    @cached_property
    def seats(self) -> tuple[Seat, ...]:
        """The bearing, its ring moved as it is given."""
        size = len(self.directions)
        return (Seat("", self, np.eye(size), np.zeros(size)),)

    @property
    def constant_force(self) -> _Floats:
        """What acts on the ring beside the balls, shape (n,) [N], [N m]: nothing."""
        return np.zeros(len(self.directions))

    @cached_property
    def balls(self) -> Balls:
        """Grooves, races and losses of the bearing, as the core in Python has them."""
        return self.motion().balls

    def motion(self) -> BallMotion:
        """Balls and films of the bearing in time, in Python."""
        return motion_of(self.bearing, self.speeds.tolist(), self.directions)
