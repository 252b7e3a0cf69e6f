"""`BearingTables`: what is computed once from the inputs of a bearing, as the kernels and all others need it."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_numbers
from reduced_models.bearing.ball import Balls
from reduced_models.bearing.grooves import ball_inertia, grooves_of
from reduced_models.bearing.height_tables import heights_of
from reduced_models.bearing.internals import internals_of
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.loss import loss_of
from reduced_models.bearing.race import RACES, Race, race_of
from reduced_models.bearing.race_table import RaceForceTable, tabulate_dry_race, tabulate_race
from reduced_models.bearing.shoulders import shoulder_angle
from reduced_models.elements.film_contact import FilmContact
from reduced_models.life.internal_geometry import InternalGeometry

if TYPE_CHECKING:
    from reduced_models.bearing.ball_bearing import BallBearing

_Floats = NDArray[np.float64]


class BearingTables:
    """Contacts, elements, tables of force and heights of a bearing, each made when it is needed and kept.

    Attributes
    ----------
    races : dict of str to Race
        Contacts with the "inner" and the "outer" race.
    heights_in_films : dict of float to ndarray
        `heights` as films of a speed [rev/min] filter them, below 0 of a shaft that turns backward: see
        `film_heights`.
    warned : bool
        Whether the bearing has warned of damping that is left out.
    """

    def __init__(self, bearing: BallBearing) -> None:
        self._bearing = bearing
        self.races: dict[str, Race] = {name: race_of(bearing, name) for name in RACES}
        self.heights_in_films: dict[float, _Floats] = {}
        self.warned = False
        self._elements: dict[tuple[str, float], FilmContact] = {}
        self._balls: dict[tuple[float, ...], Balls] = {}

    @cached_property
    def end(self) -> tuple[float, str]:
        """Highest speed [rev/min] at which both races have films, and what ends there."""
        return min(race.end for race in self.races.values())

    @cached_property
    def shoulders(self) -> dict[str, float | None]:
        """Contact angles [rad] of the shoulders of both races; None where they are not given."""
        return {name: shoulder_angle(self._bearing, name) for name in RACES}

    @cached_property
    def heights(self) -> _Floats:
        """Heights of all features, as the kernels need them (`contact_heights`)."""
        return heights_of(self._bearing)

    @cached_property
    def internals(self) -> InternalGeometry:
        """What the standards of rating life need of the bearing."""
        return internals_of(self._bearing)

    @cached_property
    def dry(self) -> BallBearing:
        """The bearing without oil."""
        return replace(self._bearing, oil=None, supply=None, thermal=None)

    def element(self, race: str, speed: float) -> FilmContact:
        """Element of a ball's contact with one race [SI], at a speed that the bearing takes [rev/min]."""
        if (race, speed) not in self._elements:
            self._elements[race, speed] = self.races[race].element(speed)
        return self._elements[race, speed]

    def law(self, race: str, speeds_rpm: ArrayLike) -> RaceForceTable:
        """Table of the force of a contact with one race over increasing speeds [rev/min]."""
        bearing = self._bearing
        if bearing.oil is None:
            return tabulate_dry_race(self.races[race].kn)
        limit = inf if bearing.cutoff_gap is None else bearing.cutoff_gap
        speeds = np.atleast_1d(as_numbers("speeds_rpm", speeds_rpm)).tolist()
        return tabulate_race([bearing.element(race, speed) for speed in speeds], limit)

    def balls(self, speeds_rpm: ArrayLike) -> Balls:
        """Parameters of the compiled kernels over increasing speeds [rev/min].

        Between two speeds films grow as with the speed to the power of 0.67; outside them the kernels do not ask.
        """
        speeds = as_column("speeds_rpm", np.atleast_1d(as_numbers("speeds_rpm", speeds_rpm)), increasing=True)
        key = tuple(speeds.tolist())
        if key not in self._balls:
            bearing, omega = self._bearing, speeds * RPM_TO_RAD_S
            self._balls[key] = Balls(
                inner=self.law("inner", speeds),
                outer=self.law("outer", speeds),
                number=bearing.balls,
                grooves=grooves_of(bearing),
                omega=float(omega[0]),
                speeds=omega,
                loss=loss_of(bearing.loss_factor),
                inertia=ball_inertia(bearing),
                heights=self.heights,
            )
        return self._balls[key]
