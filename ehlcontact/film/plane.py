"""Film at one instant: whole plane, mid-planes, horseshoe, fringes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_finite, require_instance, require_positive
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from ehlcontact.quantities import ACROSS, ALONG, LENGTH, NUMBER, PRESSURE, Quantity, quantities_of, require_scales
from ehlcontact.results import SteadyResult
from ehlcontact.results.contact_map import ContactView, contact_panels, fields
from ehlcontact.results.table import Display, QuantityTable, ScaledTable
from ehlcontact.solver.lowest_film import lowest_film
from ehlcontact.transient.result import SimulationResult

Array = NDArray[np.float64]

LIGHT = (1e-8, 1e-4)  # m: wavelengths, from ultraviolet to infrared


@dataclass(frozen=True, slots=True, eq=False)
class Profile(ScaledTable):
    """Film and pressure along a line through the centre; ``si`` has them in SI.

    Attributes
    ----------
    X, H, P : ndarray, shape (k,)
        x/a or y/b, film over the dry approach, pressure over the Hertz pressure. In SI ``x`` [m] (across too),
        ``h`` [m], ``p`` [Pa].
    scales : Scales or None
    across : bool
        Along Y at X = 0, otherwise along X at Y = 0.
    """

    X: Annotated[Array, ALONG.over("X")]
    H: Annotated[Array, LENGTH.over("X")]
    P: Annotated[Array, PRESSURE.over("X")]
    scales: Scales | None
    across: bool

    DISPLAY: ClassVar[Display] = Display(rows="X", panels=("H", "P"))

    def _quantities(self) -> Mapping[str, Quantity]:
        declared = quantities_of(Profile)
        return {**declared, "X": ACROSS.over("X")} if self.across else declared


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
class Film(ScaledTable):
    """Film and pressure at one instant over the whole plane; ``si`` has them in SI.

    Attributes
    ----------
    X, Y : ndarray, shape (nx + 1,), (2 ny + 1,)
        x/a and y/b, both signs; in SI ``x``, ``y`` [m].
    H, P : ndarray, shape (nx + 1, 2 ny + 1)
        Film over the dry approach, pressure over the Hertz pressure; in SI ``h`` [m], ``p`` [Pa].
    scales : Scales or None
        Units in SI.
    """

    X: Annotated[Array, ALONG.over("X")]
    Y: Annotated[Array, ACROSS.over("Y")]
    H: Annotated[Array, LENGTH.over("X Y")]
    P: Annotated[Array, PRESSURE.over("X Y")]
    scales: Scales | None

    DISPLAY: ClassVar[Display] = Display(rows="X Y", panels=("P", "H"))

    def _drawn(self) -> Film:
        return self  # in SI and without, as a contact is drawn

    def _panels(self) -> Iterator[Any]:
        s = self.scales
        view, (p, h) = ContactView.of(self.X, self.Y, None, s), fields(s, self.P, self.H)
        central = float(h[0][int(np.argmin(np.abs(self.X))), self.Y.size // 2])
        yield from contact_panels(view, p, h, central, 1.0 if s is None else s.pressure)

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


def interpolated(film: Film, X: Array, Y: Array) -> Film:
    """A film at other places, by cubic splines between its nodes; pressures are not negative.

    Parameters
    ----------
    film : Film
    X, Y : ndarray, shape (k,), (m,)
        x/a and y/b, rising, within the film.
    """
    from scipy.interpolate import RectBivariateSpline

    H, P = (RectBivariateSpline(film.X, film.Y, field)(X, Y) for field in (film.H, film.P))
    return Film(X, Y, H, np.maximum(P, 0.0), film.scales)


def _mirrored(field: Array) -> Array:
    """Both signs of Y from the half that was computed."""
    return np.concatenate([field[:, :0:-1], field], axis=1)


@dataclass(frozen=True, slots=True, eq=False)
class Interferogram(QuantityTable):
    """Fringes of a film, where its grid resolves them `resolved`.

    Attributes
    ----------
    intensity, order : ndarray, shape (nx + 1, 2 ny + 1)
        Brightness in [0, 1], and the path difference in wavelengths.
    x, y : ndarray, shape (nx + 1,), (2 ny + 1,)
        Places along rolling and across [m].
    axes : (float, float)
        Semi-axes of the Hertz ellipse along and across [m].
    """

    intensity: Annotated[Array, NUMBER.over("x y")]
    order: Annotated[Array, NUMBER.over("x y")]
    x: Annotated[Array, ALONG.over("x")]
    y: Annotated[Array, ACROSS.over("y")]
    axes: tuple[float, float]

    DISPLAY: ClassVar[Display] = Display(rows="x y", panels=("intensity",))

    def _panels(self) -> Iterator[Any]:
        seen = np.where(self.resolved, self.intensity, np.nan)  # finer fringes would be false ones
        view = ContactView(self.x, self.y, self.axes, (self._axis("x"), self._axis("y")))
        yield view.map(seen, "intensity; blank where the grid is too coarse for it", "gray", (0.0, 1.0))

    @property
    def resolved(self) -> NDArray[np.bool_]:
        """Where the grid resolves the fringes: less than half an order from node to node."""
        along, across = np.gradient(self.order)
        return np.maximum(np.abs(along), np.abs(across)) < 0.5


@takes(film=Object(Film, "a Film"), wavelength="m", phase="rad")
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
    if not LIGHT[0] <= wave <= LIGHT[1]:
        raise InputError("wavelength", wavelength, f"from {LIGHT[0]:g} to {LIGHT[1]:g} m (given in nm or um?)")
    index = require_positive("refractive_index", refractive_index)
    turn = require_finite("phase", phase) / (2.0 * np.pi)
    si, scales = film.si, require_scales(film.scales)
    order = 2.0 * index * si.h / wave + turn
    intensity = 0.5 * (1.0 + np.cos(2.0 * np.pi * order))
    return Interferogram(intensity, order, si.x, si.y, (scales.a, scales.b))
