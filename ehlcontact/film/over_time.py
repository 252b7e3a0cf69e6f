"""Film over time: central and smallest film, and film waves, which travel with the surfaces.

Along Y = 0 a change of the film at the inlet crosses the contact at dX/dT = 1, the mean speed of the surfaces. In
compressible oil the surfaces carry the mass rho H: a part of the film follows the pressure at once and shifts the
measured speed, by 1 % at Omega = pi and by more in slower motion.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_finite, require_instance
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from ehlcontact.quantities import ALONG, LENGTH, SURFACE_SPEED, TIME
from ehlcontact.results.picture import INK, Line, Map, Panel
from ehlcontact.results.table import Display, QuantityTable, ScaledTable
from ehlcontact.transient.result import SimulationResult

Array = NDArray[np.float64]

STATIONS = 25  # places at which a travelling wave is timed
OVERSAMPLING = 4  # of its records, for delays finer than the time step
FEWEST_STEPS = 4  # in the time a wave takes from start to end
WITHIN, CARRIED = 1.1, 0.9  # semi-axes: what a picture of the wave shows, and whose film sets its colours
PASSAGE = 2.0  # 2a/u_sum, in which the surfaces cross the contact
SLOWEST = 4.0  # times slower than the surfaces: the slowest wave that is found


@dataclass(frozen=True, slots=True, eq=False)
class FilmHistory(ScaledTable):
    """Central and smallest film over time; ``si`` has them in SI.

    Attributes
    ----------
    T : ndarray, shape (steps + 1,)
        Times in 2a/u_sum; in SI ``t`` [s].
    h_central, h_min : ndarray, shape (steps + 1,)
        Films over the dry approach; in SI [m].
    scales : Scales or None
    """

    T: Annotated[Array, TIME.over("T")]
    h_central: Annotated[Array, LENGTH.over("T")]
    h_min: Annotated[Array, LENGTH.over("T")]
    scales: Scales | None

    DISPLAY: ClassVar[Display] = Display(rows="T", panels=("h_central h_min",))


def film_history(run: SimulationResult) -> FilmHistory:
    """Central and smallest film of a simulation over time."""
    return FilmHistory(run.T, run.h_central, run.h_min, run.scales)


@dataclass(frozen=True, slots=True, eq=False)
class FilmWave(QuantityTable):
    """Change of the film along Y = 0 over place and time.

    `X` is of shape (nx + 1,), `T` (steps + 1,), and `change` (steps + 1, nx + 1) the film less that at rest.
    """

    X: Annotated[Array, ALONG.over("X")]
    T: Annotated[Array, TIME.over("T")]
    change: Annotated[Array, LENGTH.over("T X")]

    DISPLAY: ClassVar[Display] = Display(rows="T X", panels=("change",))
    UNITS = "dimensionless"

    def _panels(self) -> Iterator[Panel | Map]:
        """Beyond a little more than the contact the film follows the approach at once, and is not shown."""
        near = np.abs(self.X) <= WITHIN
        change = self.change[:, near]
        inside = np.abs(change[:, np.abs(self.X[near]) < CARRIED])
        most = float(np.percentile(inside, 99.0)) or float(inside.max()) or 1.0
        starts = np.arange(0.0, float(self.T[-1]), PASSAGE).tolist()
        carried = [Line([at, at + PASSAGE], [-1.0, 1.0], "", INK, "--", width=1.0) for at in starts]
        yield Map(
            (self.T, self._axis("T")),
            (self.X[near], self._axis("X")),
            (change, ("change of the film", self._unit("change"))),
            title="dashed: carried through at the mean surface speed",
            colours="RdBu_r",
            limits=(-most, most),  # white is no change
            view=((float(self.T[0]), float(self.T[-1])), (-WITHIN, WITHIN)),
            lines=carried,
        )


@dataclass(frozen=True, slots=True, eq=False)
class WaveTrack(QuantityTable):
    """Delay of a film wave from place to place.

    Attributes
    ----------
    X, delay : ndarray, shape (k,)
        Stations, and delays of their films behind that of the first station, in 2a/u_sum.
    speed : float
        dX/dT of the line through them; that of the surfaces is 1.
    spread : float
        RMS departure of the delays from that line.
    """

    X: Annotated[Array, ALONG.over("X")]
    delay: Annotated[Array, TIME.over("X")]
    speed: Annotated[float, SURFACE_SPEED]
    spread: Annotated[float, TIME]

    DISPLAY: ClassVar[Display] = Display(rows="X", panels=("delay",))
    UNITS = "dimensionless"


def film_wave(run: SimulationResult) -> FilmWave:
    """Film along Y = 0 less the film at rest, which is that of T = 0, over place and time.

    Raises
    ------
    InputError
        `run` is no result of `simulate`.
    """
    require_instance("run", run, SimulationResult, "a result of simulate")
    return FilmWave(run.X, run.T, run.h_midplane - run.h_midplane[0])


def track_wave(wave: FilmWave, start: float = -0.6, end: float = 0.6) -> WaveTrack:
    """Speed of a film wave: the delay from station to station, and a straight line through the delays.

    The delay of a station is the shift of the first station's record that correlates best with its own, sought
    near the delay of the station before, so that a periodic wave keeps its crest. What the surfaces carry moves
    at dX/dT = 1 (Venner and Lubrecht 2000, ch. 7).

    Parameters
    ----------
    wave : FilmWave
        Over at least twice the time that the way from start to end takes at dX/dT = 1.
    start, end : float
        First and last station, within the contact: outside it the film follows the approach at once.

    Raises
    ------
    InputError
        Stations out of order or outside the grid; a record too short, of too long steps, or without a wave.
    """
    first, last = require_finite("start", start), require_finite("end", end)
    if not wave.X[0] <= first < last <= wave.X[-1]:
        raise InputError("start, end", (first, last), f"in order within [{wave.X[0]:g}, {wave.X[-1]:g}]")
    length = float(wave.T[-1] - wave.T[0])
    coarsest = (last - first) / FEWEST_STEPS
    if wave.T.size < 3 or float(np.diff(wave.T).max()) > coarsest:
        raise InputError("wave", f"a record of {wave.T.size - 1} steps", f"one in steps of {coarsest:.3g} at most")
    if length < 2.0 * (last - first):
        raise InputError("wave", f"a record of {length:g}", f"one of at least {2.0 * (last - first):g}")
    stations = np.linspace(first, last, STATIONS)
    T = np.linspace(wave.T[0], wave.T[-1], OVERSAMPLING * wave.T.size)
    places = np.array([np.interp(stations, wave.X, row) for row in wave.change])
    records = np.array([np.interp(T, wave.T, column) for column in places.T])
    if not np.ptp(records, axis=1).min() > 0.0:
        raise InputError("wave", "a film at rest", "one that changes at every station")
    step = length / (T.size - 1)
    reach = max(2, round(SLOWEST * (last - first) / (STATIONS - 1) / step))
    delays = [0.0]
    for record in records[1:]:
        delays.append(_delay(records[0], record, delays[-1], reach))
    delay = step * np.array(delays)
    slope, offset = np.polyfit(stations, delay, 1)
    return WaveTrack(stations, delay, float(1.0 / slope), float(np.std(delay - slope * stations - offset)))


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
