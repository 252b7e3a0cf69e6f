"""Film over time: central and smallest film, and film waves, which travel with the surfaces.

Along y = 0 a change of the film at the inlet crosses the contact at u_sum/2, the mean speed of the surfaces. In
compressible oil the surfaces carry the mass rho h: a part of the film follows the pressure at once and shifts the
measured speed, by 1 % at Omega = pi and by more in slower motion.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_finite, require_instance
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.point import Point
from ehlcontact.quantities import ALONG, LENGTH, SURFACE_SPEED, TIME
from ehlcontact.results.picture import BLACK, Line, Map, Panel
from ehlcontact.results.table import Display, PointTable
from ehlcontact.transient.result import SimulationResult

Array = NDArray[np.float64]

STATIONS = 25  # places at which a travelling wave is timed
OVERSAMPLING = 4  # of its records, for delays finer than the time step
FEWEST_STEPS = 4  # in the time a wave takes from start to end
WITHIN, CARRIED = 1.1, 0.9  # semi-axes: what a picture of the wave shows, and whose film sets its colours
PASSAGE = 2.0  # 2a/u_sum, in which the surfaces cross the contact
SLOWEST = 4.0  # times slower than the surfaces: the slowest wave that is found


@dataclass(frozen=True, slots=True, eq=False)
class FilmHistory(PointTable):
    """Central and smallest film over time, in the units of their point.

    Attributes
    ----------
    point : MoesPoint or OperatingPoint
    t : ndarray, shape (steps + 1,)
        Times [s; 2a/u_sum].
    h_central, h_min : ndarray, shape (steps + 1,)
        Films [m; dry approach].
    """

    point: Point
    t: Annotated[Array, TIME.over("t")]
    h_central: Annotated[Array, LENGTH.over("t")]
    h_min: Annotated[Array, LENGTH.over("t")]

    DISPLAY: ClassVar[Display] = Display(rows="t", panels=("h_central h_min",))


@takes(run=Object(SimulationResult, "a result of simulate"))
def film_history(run: SimulationResult) -> FilmHistory:
    """Central and smallest film of a simulation over time."""
    return FilmHistory(run.point, run.t, run.h_central, run.h_min)


@dataclass(frozen=True, slots=True, eq=False)
class FilmWave(PointTable):
    """Change of the film along y = 0 over place and time, in the units of its `point`.

    `x` is of shape (nx + 1,), `t` (steps + 1,), and `change` (steps + 1, nx + 1) the film less that at rest.
    """

    point: Point
    x: Annotated[Array, ALONG.over("x")]
    t: Annotated[Array, TIME.over("t")]
    change: Annotated[Array, LENGTH.over("t x")]

    DISPLAY: ClassVar[Display] = Display(rows="t x", panels=("change",))

    def _panels(self) -> Iterator[Panel | Map]:
        """Beyond a little more than the contact the film follows the approach at once, and is not shown."""
        s = self.point.scales
        near = np.abs(self.x) <= WITHIN * s.a
        change = self.change[:, near]
        inside = np.abs(change[:, np.abs(self.x[near]) < CARRIED * s.a])
        most = float(np.percentile(inside, 99.0)) or float(inside.max()) or 1.0
        starts = np.arange(0.0, float(self.t[-1]), PASSAGE * s.time).tolist()
        carried = [Line([at, at + PASSAGE * s.time], [-s.a, s.a], "", BLACK, "--", width=1.0) for at in starts]
        yield Map(
            (self.t, self._axis("t")),
            (self.x[near], self._axis("x")),
            (change, ("change of the film", self._unit("change"))),
            title="dashed: carried by the surfaces",
            colours="RdBu_r",
            limits=(-most, most),  # white is no change
            view=((float(self.t[0]), float(self.t[-1])), (-WITHIN * s.a, WITHIN * s.a)),
            lines=carried,
        )


@dataclass(frozen=True, slots=True, eq=False)
class WaveTrack(PointTable):
    """Delay of a film wave from place to place, in the units of its point.

    Attributes
    ----------
    point : MoesPoint or OperatingPoint
    x, delay : ndarray, shape (k,)
        Stations [m; a], and delays of their films behind that of the first station [s; 2a/u_sum].
    speed : float
        Slope of the line through them [m/s; u_sum/2, the mean speed of the surfaces].
    spread : float
        RMS departure of the delays from that line [s; 2a/u_sum].
    """

    point: Point
    x: Annotated[Array, ALONG.over("x")]
    delay: Annotated[Array, TIME.over("x")]
    speed: Annotated[float, SURFACE_SPEED]
    spread: Annotated[float, TIME]

    DISPLAY: ClassVar[Display] = Display(rows="x", panels=("delay",))


def film_wave(run: SimulationResult) -> FilmWave:
    """Film along y = 0 less the film at rest, which is that of t = 0, over place and time.

    Raises
    ------
    InputError
        `run` is no result of `simulate`.
    """
    require_instance("run", run, SimulationResult, "a result of simulate")
    return FilmWave(run.point, run.x, run.t, run.h_midplane - run.h_midplane[0])


@takes(wave=Object(FilmWave, "a FilmWave"))
def track_wave(wave: FilmWave, start: float = -0.6, end: float = 0.6) -> WaveTrack:
    """Speed of a film wave: the delay from station to station, and a straight line through the delays.

    The delay of a station is the shift of the first station's record that correlates best with its own, sought
    near the delay of the station before, so that a periodic wave keeps its crest. What the surfaces carry moves
    at u_sum/2 (Venner and Lubrecht 2000, ch. 7).

    Parameters
    ----------
    wave : FilmWave
        Over at least twice the time that the surfaces take from start to end.
    start, end : float
        First and last station x/a, within the contact: outside it the film follows the approach at once.

    Raises
    ------
    InputError
        Stations out of order or outside the grid; a record too short, of too long steps, or without a wave.
    """
    point, wave = wave.point, wave.dimensionless
    first, last = require_finite("start", start), require_finite("end", end)
    if not wave.x[0] <= first < last <= wave.x[-1]:
        raise InputError("start, end", (first, last), f"in order within [{wave.x[0]:g}, {wave.x[-1]:g}]")
    length = float(wave.t[-1] - wave.t[0])
    coarsest = (last - first) / FEWEST_STEPS
    if wave.t.size < 3 or float(np.diff(wave.t).max()) > coarsest:
        raise InputError("wave", f"a record of {wave.t.size - 1} steps", f"one in steps of {coarsest:.3g} at most")
    if length < 2.0 * (last - first):
        raise InputError("wave", f"a record of {length:g}", f"one of at least {2.0 * (last - first):g}")
    stations = np.linspace(first, last, STATIONS)
    T = np.linspace(wave.t[0], wave.t[-1], OVERSAMPLING * wave.t.size)
    places = np.array([np.interp(stations, wave.x, row) for row in wave.change])
    records = np.array([np.interp(T, wave.t, column) for column in places.T])
    if not np.ptp(records, axis=1).min() > 0.0:
        raise InputError("wave", "a film at rest", "one that changes at every station")
    step = length / (T.size - 1)
    reach = max(2, round(SLOWEST * (last - first) / (STATIONS - 1) / step))
    delays = [0.0]
    for record in records[1:]:
        delays.append(_delay(records[0], record, delays[-1], reach))
    delay = step * np.array(delays)
    slope, offset = np.polyfit(stations, delay, 1)
    spread = float(np.std(delay - slope * stations - offset))
    return WaveTrack(wave.point, stations, delay, float(1.0 / slope), spread).in_units_of(point)


def _delay(reference: Array, record: Array, near: float, reach: int) -> float:
    """Shift in samples of `reference` that correlates best with `record`, within `reach` of `near`."""
    size = reference.size
    shifts = range(round(near) - reach, round(near) + reach + 1)
    match = []
    for shift in shifts:
        early = reference[max(0, -shift) : size - max(0, shift)]
        late = record[max(0, shift) : size + min(0, shift)]
        match.append(np.corrcoef(early, late)[0, 1])
    k = int(np.clip(np.argmax(match), 1, len(shifts) - 2))
    below, best, above = match[k - 1 : k + 2]
    bend = below - 2.0 * best + above
    return float(shifts[k] + (0.5 * (below - above) / bend if bend < 0.0 else 0.0))
