"""The film at one instant: whole plane, mid-planes, horseshoe, fringes.

Upper-case attributes are dimensionless as in `results`; their lower-case properties are SI and need an
`OperatingPoint`'s scales.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_finite, require_instance, require_positive
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from ehlcontact.results import SteadyResult, require_scales
from ehlcontact.results.contact_map import ContactMap, contact_panels
from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.solver.lowest_film import lowest_film
from ehlcontact.summary import Summary
from ehlcontact.transient.result import SimulationResult

Array = NDArray[np.float64]

LIGHT = (1e-8, 1e-4)  # m: wavelengths, from ultraviolet to infrared

IN_SI = Layout(
    rows="x y",
    panels=("p", "h"),
    quantities={"x": ("m", "x"), "y": ("m", "y"), "p": ("Pa", "x y"), "h": ("m", "x y")},
)


@dataclass(frozen=True, slots=True, eq=False)
class Profile(Summary, Tabled):
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

    LAYOUT: ClassVar[Layout] = Layout(
        rows="X",
        panels=("H", "P"),
        quantities={"X": ("semi-axes", "X"), "H": ("delta_H", "X"), "P": ("p_h", "X")},
    )

    def _layout(self) -> Layout:
        if self.scales is None:
            return self.LAYOUT
        return Layout(rows="x", panels=("h", "p"), quantities={"x": ("m", "x"), "h": ("m", "x"), "p": ("Pa", "x")})

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
class Film(Summary, Tabled):
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

    LAYOUT: ClassVar[Layout] = Layout(
        rows="X Y",
        panels=("P", "H"),
        quantities={"X": ("a", "X"), "Y": ("b", "Y"), "P": ("p_h", "X Y"), "H": ("delta_H", "X Y")},
    )

    def _layout(self) -> Layout:
        return self.LAYOUT if self.scales is None else IN_SI

    def _panels(self) -> Iterator[Any]:
        central = float(self.H[int(np.argmin(np.abs(self.X))), self.Y.size // 2])
        yield from contact_panels((self.X, self.Y), (self.P, self.H), central, None, self.scales)

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
class Interferogram(Summary, Tabled):
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

    intensity: Array
    order: Array
    x: Array
    y: Array
    axes: tuple[float, float]

    LAYOUT: ClassVar[Layout] = Layout(
        rows="x y",
        panels=("intensity",),
        quantities={"x": ("m", "x"), "y": ("m", "y"), "intensity": ("", "x y"), "order": ("", "x y")},
    )

    def _panels(self) -> Iterator[Any]:
        seen = np.where(self.resolved, self.intensity, np.nan)  # finer fringes would be false ones
        labels = "x along rolling [µm]", "y across [µm]", "intensity; blank where the grid is too coarse for it"
        a, b = (1e6 * axis for axis in self.axes)
        yield ContactMap(1e6 * self.x, 1e6 * self.y, seen, labels, (a, b), "gray", (0.0, 1.0))

    @property
    def resolved(self) -> NDArray[np.bool_]:
        """Where the grid resolves the fringes: less than half an order from node to node."""
        along, across = np.gradient(self.order)
        return np.maximum(np.abs(along), np.abs(across)) < 0.5


@takes(wavelength="m", phase="rad")
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
    order = 2.0 * index * film.h / wave + turn
    scales = require_scales(film.scales)
    intensity = 0.5 * (1.0 + np.cos(2.0 * np.pi * order))
    return Interferogram(intensity, order, film.x, film.y, (scales.a, scales.b))
