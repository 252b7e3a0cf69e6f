"""The film as a tribologist looks at it: whole plane, mid-planes, horseshoe, fringes, histories, waves.

Everything works on a `SteadyResult` and on the snapshots of a `SimulationResult`. Upper-case attributes are
dimensionless as in `results`; their lower-case properties are SI and need an `OperatingPoint`'s scales.

Along Y = 0 what the inlet makes of the motion travels through at dX/dT = 1, the mean speed of the surfaces. In
compressible oil it is the mass rho H that is carried: a part of the film follows the pressure at once and shifts
the measured speed, by 1 % at Omega = pi and more in slower motion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_finite, require_instance, require_positive
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from ehlcontact.results import SteadyResult, require_scales
from ehlcontact.results.story import Told
from ehlcontact.solver.lowest_film import lowest_film
from ehlcontact.transient.result import SimulationResult

Array = NDArray[np.float64]

STATIONS = 25  # places at which a travelling wave is timed
OVERSAMPLING = 4  # of its records, for delays finer than the time step
FEWEST_STEPS = 4  # in the time a wave takes from start to end
SLOWEST = 4.0  # times slower than the surfaces: the slowest wave that is found


@dataclass(frozen=True, slots=True, eq=False)
class Profile(Told):
    """Film and pressure along a line through the centre.

    Attributes
    ----------
    X, H, P : ndarray, shape (k,)
        x/a or y/b, film over the dry approach, pressure over the Hertz pressure.
    scales : Scales or None
    across : bool
        Along Y at X = 0, otherwise along X at Y = 0.
    """

    X: Array
    H: Array
    P: Array
    scales: Scales | None
    across: bool

    @property
    def x(self) -> Array:
        """Place [m]."""
        scales = require_scales(self.scales)
        return self.X * (scales.b if self.across else scales.a)

    @property
    def h(self) -> Array:
        """Film [m]."""
        return self.H * require_scales(self.scales).length

    @property
    def p(self) -> Array:
        """Pressure [Pa]."""
        return self.P * require_scales(self.scales).pressure


@dataclass(frozen=True, slots=True, eq=False)
class Constriction:
    """The horseshoe: where and how far the film is narrowed; on the mid-planes at the nodes.

    Attributes
    ----------
    central, minimum : float
        Film at X = Y = 0, and the smallest, over the dry approach.
    X, Y : float
        Place of the minimum in semi-axes, Y >= 0; its mirror image is at -Y.
    exit_film, exit_place : float
        Least film along Y = 0, over the dry approach, and its X.
    side_film, side_place : float
        Least film along X = 0, over the dry approach, and its Y >= 0.
    """

    central: float
    minimum: float
    X: float
    Y: float
    exit_film: float
    exit_place: float
    side_film: float
    side_place: float

    @property
    def ratio(self) -> float:
        """Central over minimum film."""
        return self.central / self.minimum


@dataclass(frozen=True, slots=True, eq=False)
class Film(Told):
    """Film and pressure at one instant over the whole plane.

    Attributes
    ----------
    X, Y : ndarray, shape (nx + 1,), (2 ny + 1,)
        x/a and y/b, both signs.
    H, P : ndarray, shape (nx + 1, 2 ny + 1)
        Film over the dry approach, pressure over the Hertz pressure.
    scales : Scales or None
        Units in SI.
    """

    X: Array
    Y: Array
    H: Array
    P: Array
    scales: Scales | None

    @property
    def x(self) -> Array:
        """Place along rolling [m]."""
        return self.X * require_scales(self.scales).a

    @property
    def y(self) -> Array:
        """Place across [m]."""
        return self.Y * require_scales(self.scales).b

    @property
    def h(self) -> Array:
        """Film [m]."""
        return self.H * require_scales(self.scales).length

    @property
    def p(self) -> Array:
        """Pressure [Pa]."""
        return self.P * require_scales(self.scales).pressure

    @property
    def along(self) -> Profile:
        """Mid-plane along rolling, Y = 0."""
        middle = self.Y.size // 2
        return Profile(self.X, self.H[:, middle], self.P[:, middle], self.scales, False)

    @property
    def across(self) -> Profile:
        """Mid-plane across, X = 0; by linear interpolation where no node lies there."""
        i = int(np.clip(np.searchsorted(self.X, 0.0), 1, self.X.size - 1))
        share = float((0.0 - self.X[i - 1]) / (self.X[i] - self.X[i - 1]))
        H, P = ((1.0 - share) * field[i - 1] + share * field[i] for field in (self.H, self.P))
        return Profile(self.Y, H, P, self.scales, True)

    @property
    def constriction(self) -> Constriction:
        """Central and minimum film, and the least films of both mid-planes."""
        along, across = self.along, self.across
        minimum, row, column = lowest_film(self.H.T[self.Y.size // 2 :])
        exit_at, side_at = int(np.argmin(along.H)), int(np.argmin(across.H))
        return Constriction(
            central=float(np.interp(0.0, along.X, along.H)),
            minimum=minimum,
            X=float(self.X[0] + column * (self.X[1] - self.X[0])),
            Y=float(row * (self.Y[1] - self.Y[0])),
            exit_film=float(along.H[exit_at]),
            exit_place=float(along.X[exit_at]),
            side_film=float(across.H[side_at]),
            side_place=abs(float(across.X[side_at])),
        )


def film_of(result: SteadyResult | SimulationResult, T: float | None = None) -> Film:
    """Whole-plane film of a steady result, or of a simulation at one of its snapshots.

    Parameters
    ----------
    result : SteadyResult or SimulationResult
    T : float, optional
        Time of the snapshot, to the nearest step; the last one by default. Only for a simulation.

    Raises
    ------
    InputError
        T given for a steady film, or no snapshot there.
    """
    require_instance("result", result, SteadyResult | SimulationResult, "a SteadyResult or a SimulationResult")
    if isinstance(result, SteadyResult):
        if T is not None:
            raise InputError("T", T, "left out: a steady film has no time")
        H, P = result.H, result.P
    else:
        k = _snapshot(result, T)
        H, P = result.snapshot_H[k], result.snapshot_P[k]
    Y = np.concatenate([-result.Y[:0:-1], result.Y])
    return Film(result.X, Y, _mirrored(H), _mirrored(P), result.scales)


def _snapshot(run: SimulationResult, T: float | None) -> int:
    """Number of the snapshot within a time step of T."""
    kept = run.snapshot_T
    if kept.size == 0:
        raise InputError("snapshots", (), "asked for when simulating: this result kept no whole fields")
    if T is None:
        return kept.size - 1
    k = int(np.argmin(np.abs(kept - require_finite("T", T))))
    step = float(np.diff(run.T).max()) if run.steps else 0.0
    if abs(kept[k] - T) > step * (1.0 + 1e-9):
        raise InputError("T", T, "near a snapshot: " + ", ".join(f"{t:g}" for t in kept))
    return k


def _mirrored(field: Array) -> Array:
    """Both signs of Y from the half that was computed."""
    return np.concatenate([field[:, :0:-1], field], axis=1)


@dataclass(frozen=True, slots=True, eq=False)
class Interferogram(Told):
    """Fringes, shape (nx + 1, 2 ny + 1): `intensity` in [0, 1]; `order`, the path difference in wavelengths."""

    intensity: Array
    order: Array

    @property
    def resolved(self) -> NDArray[np.bool_]:
        """Where the grid resolves the fringes: less than half an order from node to node."""
        along, across = np.gradient(self.order)
        return np.maximum(np.abs(along), np.abs(across)) < 0.5


def interferogram(
    film: Film, wavelength: float, refractive_index: float = 1.5, phase: float = 0.0
) -> Interferogram:
    """Pseudo-interferogram of a film between a transparent and a reflecting surface.

    Two beams at normal incidence, of equal strength: ``I = (1 + cos(4 pi n h/wavelength + phase))/2`` (Born and
    Wolf, Principles of Optics, ch. 7; for EHL films Gohar and Cameron, Nature 200 (1963) 458).

    Parameters
    ----------
    film : Film
    wavelength : float
        Of the light, in vacuum [m].
    refractive_index : float
        Of the oil; its rise with pressure is left out.
    phase : float
        Phase [rad] that the reflections add: 0 makes h = 0 bright, pi dark.

    Raises
    ------
    InputError
        A film without SI scales, wavelength or index not positive, phase not finite.
    """
    wave = require_positive("wavelength", wavelength)
    index = require_positive("refractive_index", refractive_index)
    turn = require_finite("phase", phase) / (2.0 * np.pi)
    order = 2.0 * index * film.h / wave + turn
    return Interferogram(0.5 * (1.0 + np.cos(2.0 * np.pi * order)), order)


@dataclass(frozen=True, slots=True, eq=False)
class FilmHistory(Told):
    """Central and minimum film over time.

    Attributes
    ----------
    T, central, minimum : ndarray, shape (steps + 1,)
        Times in 2a/u_sum, films over the dry approach; units in SI are `scales`.
    """

    T: Array
    central: Array
    minimum: Array
    scales: Scales | None

    @property
    def t(self) -> Array:
        """Time [s]."""
        return self.T * require_scales(self.scales).time

    @property
    def h_central(self) -> Array:
        """Central film [m]."""
        return self.central * require_scales(self.scales).length

    @property
    def h_min(self) -> Array:
        """Minimum film [m]."""
        return self.minimum * require_scales(self.scales).length


def film_history(run: SimulationResult) -> FilmHistory:
    """Central and minimum film of a simulation over time."""
    return FilmHistory(run.T, run.h_central, run.h_min, run.scales)


@dataclass(frozen=True, slots=True, eq=False)
class FilmWave(Told):
    """Change of the film along Y = 0 over place and time: what the surfaces carry through.

    `X` is of shape (nx + 1,), `T` (steps + 1,), and `change` (steps + 1, nx + 1) the film less that at rest.
    """

    X: Array
    T: Array
    change: Array


@dataclass(frozen=True, slots=True, eq=False)
class WaveTrack(Told):
    """Delay of a film wave from place to place.

    Attributes
    ----------
    X, delay : ndarray, shape (k,)
        Stations, and the time in 2a/u_sum at which each sees what the first one saw.
    speed : float
        dX/dT of the line through them; that of the surfaces is 1.
    spread : float
        RMS departure of the delays from that line.
    """

    X: Array
    delay: Array
    speed: float
    spread: float


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
