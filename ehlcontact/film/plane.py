"""Film at one instant: whole plane, mid-planes, horseshoe, fringes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import parts, require_finite, require_instance, require_positive
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint, Point
from ehlcontact.quantities import ACROSS, ALONG, LENGTH, NUMBER, PRESSURE, Quantity, quantities_of
from ehlcontact.results import SteadyResult
from ehlcontact.results.contact_map import ContactView, contact_panels, fields
from ehlcontact.results.table import Display, PointTable, QuantityTable
from ehlcontact.solver.lowest_film import lowest_film
from ehlcontact.summary import contact_text
from ehlcontact.transient.result import SimulationResult

Array = NDArray[np.float64]

LIGHT = (1e-8, 1e-4)  # m: wavelengths, from ultraviolet to infrared


@dataclass(frozen=True, slots=True, eq=False)
class Profile(PointTable):
    """Film and pressure along a line through the centre, in the units of their point.

    Attributes
    ----------
    point : MoesPoint or OperatingPoint
    x, h, p : ndarray, shape (k,)
        Place along the line [m; semi-axis along it], film [m; dry approach], pressure [Pa; Hertz pressure].
    across : bool
        Along y at x = 0, otherwise along x at y = 0.
    """

    point: Point
    x: Annotated[Array, ALONG.over("x")]
    h: Annotated[Array, LENGTH.over("x")]
    p: Annotated[Array, PRESSURE.over("x")]
    across: bool

    DISPLAY: ClassVar[Display] = Display(rows="x", panels=("h", "p"))

    def _quantities(self) -> Mapping[str, Quantity]:
        declared = quantities_of(Profile)
        return {**declared, "x": ACROSS.over("x")} if self.across else declared


@dataclass(frozen=True, slots=True, eq=False)
class Constriction(PointTable):
    """The horseshoe: where and how far the film is narrowed; on the mid-planes at the nodes.

    Attributes
    ----------
    point : MoesPoint or OperatingPoint
        Whose units the others have: [m], or dry approaches and semi-axes.
    central, minimum : float
        Film at x = y = 0, and the smallest.
    x, y : float
        Place of the minimum, y >= 0; its mirror image is at -y.
    exit_film, exit_place : float
        Least film along y = 0, and its x.
    side_film, side_place : float
        Least film along x = 0, and its y >= 0.
    """

    point: Point
    central: Annotated[float, LENGTH]
    minimum: Annotated[float, LENGTH]
    x: Annotated[float, ALONG]
    y: Annotated[float, ACROSS]
    exit_film: Annotated[float, LENGTH]
    exit_place: Annotated[float, ALONG]
    side_film: Annotated[float, LENGTH]
    side_place: Annotated[float, ACROSS]

    DISPLAY: ClassVar[Display] = Display(rows="")

    @property
    def ratio(self) -> float:
        """Central over minimum film."""
        return self.central / self.minimum


@dataclass(frozen=True, slots=True, eq=False)
class Film(PointTable):
    """Film and pressure at one instant over the whole plane, in the units of their point.

    Attributes
    ----------
    point : MoesPoint or OperatingPoint
    x, y : ndarray, shape (nx + 1,), (2 ny + 1,)
        Places along rolling and across, both signs [m; semi-axes a, b].
    h, p : ndarray, shape (nx + 1, 2 ny + 1)
        Film [m; dry approach], pressure [Pa; Hertz pressure].
    """

    point: Point
    x: Annotated[Array, ALONG.over("x")]
    y: Annotated[Array, ACROSS.over("y")]
    h: Annotated[Array, LENGTH.over("x y")]
    p: Annotated[Array, PRESSURE.over("x y")]

    DISPLAY: ClassVar[Display] = Display(rows="x y", panels=("p", "h"))

    def _panels(self) -> Iterator[Any]:
        view, (p, h) = ContactView.of(self.point, self.x, self.y), fields(self.point, self.p, self.h)
        central = float(self.h[int(np.argmin(np.abs(self.x))), self.y.size // 2])
        yield from contact_panels(view, p, h, central, self.point.scales.pressure)

    @property
    def along(self) -> Profile:
        """Mid-plane along rolling, y = 0."""
        middle = self.y.size // 2
        return Profile(self.point, self.x, self.h[:, middle], self.p[:, middle], False)

    @property
    def across(self) -> Profile:
        """Mid-plane across, x = 0; by linear interpolation where no node lies there."""
        i = int(np.clip(np.searchsorted(self.x, 0.0), 1, self.x.size - 1))
        share = float((0.0 - self.x[i - 1]) / (self.x[i] - self.x[i - 1]))
        h, p = ((1.0 - share) * field[i - 1] + share * field[i] for field in (self.h, self.p))
        return Profile(self.point, self.y, h, p, True)

    @property
    def constriction(self) -> Constriction:
        """Central and minimum film, and the least films of both mid-planes."""
        along, across = self.along, self.across
        minimum, row, column = lowest_film(self.h.T[self.y.size // 2 :])
        exit_at, side_at = int(np.argmin(along.h)), int(np.argmin(across.h))
        return Constriction(
            point=self.point,
            central=float(np.interp(0.0, along.x, along.h)),
            minimum=minimum,
            x=float(self.x[0] + column * (self.x[1] - self.x[0])),
            y=float(row * (self.y[1] - self.y[0])),
            exit_film=float(along.h[exit_at]),
            exit_place=float(along.x[exit_at]),
            side_film=float(across.h[side_at]),
            side_place=abs(float(across.x[side_at])),
        )


def film_of(result: SteadyResult | SimulationResult, t: float | None = None) -> Film:
    """Whole-plane film of a steady result, or of a simulation at one of its snapshots.

    Parameters
    ----------
    result : SteadyResult or SimulationResult
    t : float, optional
        Time of the snapshot [s; 2a/u_sum], to the nearest step; the last one by default. Only for a simulation.

    Raises
    ------
    InputError
        t given for a steady film, or no snapshot there.
    """
    require_instance("result", result, SteadyResult | SimulationResult, "a SteadyResult or a SimulationResult")
    if isinstance(result, SteadyResult):
        if t is not None:
            raise InputError("t", t, "left out: a steady film has no time")
        h, p = result.h, result.p
    else:
        k = _snapshot(result, t)
        h, p = result.snapshot_h[k], result.snapshot_p[k]
    y = np.concatenate([-result.y[:0:-1], result.y])
    return Film(result.point, result.x, y, _mirrored(h), _mirrored(p))


def _snapshot(run: SimulationResult, t: float | None) -> int:
    """Number of the snapshot within a time step of t."""
    kept = run.snapshot_t
    if kept.size == 0:
        raise InputError("snapshots", (), "asked for when simulating: this result kept no whole fields")
    if t is None:
        return kept.size - 1
    k = int(np.argmin(np.abs(kept - require_finite("t", t))))
    step = float(np.diff(run.t).max()) if run.steps else 0.0
    if abs(kept[k] - t) > step * (1.0 + 1e-9):
        raise InputError("t", t, "near a snapshot: " + ", ".join(f"{t:g}" for t in kept))
    return k


def interpolated(film: Film, x: Array, y: Array) -> Film:
    """A film at other places, by cubic splines between its nodes; pressures are not negative.

    Parameters
    ----------
    film : Film
    x, y : ndarray, shape (k,), (m,)
        Places in the units of the film, rising, within it.
    """
    from scipy.interpolate import RectBivariateSpline

    h, p = (RectBivariateSpline(film.x, film.y, field)(x, y) for field in (film.h, film.p))
    return Film(film.point, x, y, h, np.maximum(p, 0.0))


def _mirrored(field: Array) -> Array:
    """Both signs of y from the half that was computed."""
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


@takes(film=Object(Film, "a Film"), wavelength="m", refractive_index=parts.INDEX_OF_REFRACTION, phase=parts.ANY)
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
        A film of a `MoesPoint`, wavelength or index not positive, phase not finite.
    """
    wave = require_positive("wavelength", wavelength)
    if not LIGHT[0] <= wave <= LIGHT[1]:
        raise InputError("wavelength", wavelength, f"from {LIGHT[0]:g} to {LIGHT[1]:g} m (given in nm or um?)")
    index = require_positive("refractive_index", refractive_index)
    turn = require_finite("phase", phase) / (2.0 * np.pi)
    if isinstance(film.point, MoesPoint):
        allowed = "that of an OperatingPoint: light has a wavelength in m, and a dimensionless point no units"
        raise InputError("point of the film", contact_text(film.point), allowed)
    scales = film.point.scales
    order = 2.0 * index * film.h / wave + turn
    intensity = 0.5 * (1.0 + np.cos(2.0 * np.pi * order))
    return Interferogram(intensity, order, film.x, film.y, (scales.a, scales.b))
