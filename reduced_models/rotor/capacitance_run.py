"""`capacitance_of_run`: capacitance of a ball bearing over a run of its rotor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.capacitance import OIL, require_permittivity
from ehlcontact.checks import require_choice, require_instance, require_integer
from ehlcontact.errors import InputError
from ehlcontact.quantities import LENGTH, TIME
from ehlcontact.results.table import Display, QuantityTable
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.capacitance import FARAD, between_rings
from reduced_models.bearing.core_bearing import AT_REST
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import contact_films
from reduced_models.bearing.ring import StaticRing
from reduced_models.bearing.ring_statics import static_ring
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.supports import bearing_names

_Floats = NDArray[np.float64]

MOST_TIMES = 500  # that are computed where no more are asked for


@dataclass(frozen=True, eq=False, kw_only=True)
class CapacitanceHistory(QuantityTable):
    """Capacitance of a bearing over time; SI.

    Attributes
    ----------
    name : str
        Of the bearing.
    t : ndarray, shape (k,)
        Times [s].
    capacitance : ndarray, shape (k,)
        Between the rings [F].
    h_min : ndarray, shape (k,)
        Smallest film or gap of all contacts [m].
    """

    name: str
    t: Annotated[_Floats, TIME.over("t")]
    capacitance: Annotated[_Floats, FARAD.over("t")]
    h_min: Annotated[_Floats, LENGTH.over("t")]

    DISPLAY: ClassVar[Display] = Display(rows="t", panels=("capacitance", "h_min"))

    def _summary_lines(self) -> list[str]:
        pico = 1e12 * self.capacitance
        return [
            f"{self.name}, {self.t.size} times from {self.t[0]:.4g} to {self.t[-1]:.4g} s",
            f"{pico.min():.4g} to {pico.max():.4g} pF, mean {pico.mean():.4g} pF",
            f"smallest film {1e6 * self.h_min.min():.4g} µm",
        ]


def capacitance_of_run(
    rotor: Rotor,
    run: RotorResult,
    bearing: int | str = 0,
    permittivity: float = OIL,
    *,
    every: int | None = None,
) -> CapacitanceHistory:
    """Capacitance of a ball bearing where its ring was at each time of a run.

    Balls are in equilibrium with the ring where it is, under their centrifugal forces; films are those of these
    loads and of the speed, without their memory.

    Parameters
    ----------
    rotor : Rotor
        That ran.
    run : RotorResult
    bearing : int or str
        Which of the rotor's bearings: its name, as in the columns of the run, or its number from 0, in which both
        bearings of a pair count.
    permittivity : float
        Of the oil.
    every : int, optional
        Every so many steps alone; by default so many that 500 times at most are computed.

    Raises
    ------
    InputError
        No ball bearing with oil; a shaft that stands still; a run of another rotor.
    """
    require_instance("rotor", rotor, Rotor, "a Rotor")
    require_instance("run", run, RotorResult, "a result of simulate_rotor")
    e = require_permittivity("permittivity", permittivity)
    step = -(-run.t.size // MOST_TIMES) if every is None else every
    step = require_integer("every", step, "a whole number >= 1", 1)
    mounts = rotor.bearings
    names = bearing_names(mounts)
    if isinstance(bearing, str):
        require_choice("bearing", bearing, names)
        bearing = names.index(bearing)
    if not 0 <= require_integer("bearing", bearing, "a bearing of the rotor, from 0", 0) < len(mounts):
        raise InputError("bearing", bearing, f"below {len(mounts)}, the number of bearings of the rotor")
    mount = mounts[bearing]
    own = mount.bearing
    if not isinstance(own, BallBearing) or own.oil is None:
        raise InputError("bearing", bearing, "a ball bearing with oil: without films its rings touch")
    if not np.abs(run.speed_rpm).min() > 0.0:
        raise InputError(
            "run", "a shaft that stands still", "one of a shaft that turns: a bearing at rest has no film"
        )
    first = len(rotor.contacts) + sum(len(one.directions) for one in mounts[:bearing])
    size = len(mount.directions)
    if run.approach.shape[1] < first + size:
        raise InputError("run", f"{run.approach.shape[1]} columns", "a run of this rotor")
    cage = own.orders.ftf_order * RPM_TO_RAD_S * run.speed_rpm
    turned = np.concatenate([[0.0], np.cumsum(0.5 * (cage[1:] + cage[:-1]) * np.diff(run.t))])
    at = slice(None, None, step)
    speed, angle = np.abs(run.speed_rpm[at]), (mount.cage_angle + turned)[at]
    balls = _balls_at_rest(own, speed, angle, run.approach[at, first : first + size])
    film, smallest = np.empty((2, *balls["load"].shape))
    for one in np.unique(speed).tolist():
        same = np.flatnonzero(speed == one)
        found = contact_films(own, one, np.zeros(size), balls[same].ravel())
        film[same], smallest[same] = (values.reshape(same.size, own.balls, 2) for values in found[:2])
    return CapacitanceHistory(
        name=names[bearing],
        t=run.t[at],
        capacitance=between_rings(own.tables.internals, balls["load"], film, balls["angle"], e),
        h_min=smallest.min(axis=(1, 2)),
    )


def _balls_at_rest(own: BallBearing, speed: _Floats, angle: _Floats, place: _Floats) -> NDArray[np.void]:
    """Balls in equilibrium with the ring at places (times, n), records `AT_REST` of shape (times, balls)."""
    found = np.empty((speed.size, own.balls), AT_REST)
    ring: StaticRing | None = None
    for k in range(speed.size):
        if ring is None or speed[k] != speed[k - 1]:
            ring = static_ring(own, float(speed[k]), float(angle[k]), place.shape[1])
        else:
            ring.angle = float(angle[k])
        ring.press(place[k])
        found[k] = ring.describe()[0]
    return found
