"""Rough surfaces that travel through the contact: made with a given spectrum, or measured.

A map of heights, cubic splines between its samples, moves with one surface as the features of `surface` do. Only
Y >= 0 is computed, so the map is laid with its first column on the middle plane and mirrored there.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import ceil, log, pi, sqrt
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import require_finite, require_integer, require_nonnegative, require_positive
from ehlcontact.checks.inputs import as_numbers
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint
from ehlcontact.transient.bodies import OverTime, scales_at

Array = NDArray[np.float64]
Taps = tuple[NDArray[np.intp], Array]  # samples beside each place, and their weights, shape (4, ...)

FEWEST_NODES = 4.0  # of the mesh to the shortest wavelength: with fewer the film does not follow it
SAMPLES = 8.0  # of a made map to its shortest wavelength: the spline between them is then off by up to 3e-4 of rq
LENGTH, WIDTH = 8.0, 4.0  # of a made map, in semi-axes along and across
FEWEST_SAMPLES = 4  # of a map along either direction, which a cubic spline needs
MOST_SAMPLES = 20_000_000  # of a made map: 160 MB, and three times that while it is made


@fields_take()
@dataclass(frozen=True, slots=True, eq=False)
class Roughness(OverTime):
    """Rough surface that enters the contact from ``X0 + speed T`` on, with a smooth front.

    Heights are positive out of the surface, as instruments give them: a summit narrows the gap. `synthetic` makes
    a surface, `measured` takes one as it comes; here heights have to be level and smooth already.

    Parameters
    ----------
    heights : array_like, shape (k, m)
        In dry approaches. Along rolling the last row enters first; the first column lies at Y = 0, the m-th at
        ``Y = (m - 1) dy``.
    dx, dy : float
        Spacing along rolling in semi-axes a, and across in semi-axes b.
    shortest_wavelength : float
        Shortest wavelength in `heights`, in semi-axes a; it wants `FEWEST_NODES` of the mesh or more.
    start : float
        X0, where the front stands at T = 0.
    speed : float
        dX/dT: 1 in pure rolling, ``2 u_i/u_sum`` in general.
    front : float
        Length over which heights rise from nothing behind the front, in semi-axes a.
    kappa : float
        Of the point: waves are as long across as along in metres.
    periodic : bool
        Whether the map begins anew where it ends. Otherwise it has to be as long as the run, and as wide as the
        region.

    Raises
    ------
    InputError
        Heights that are no such table, or all the same; a number outside its range; `shortest_wavelength` below
        two samples.
    """

    heights: ArrayLike = field(repr=False)
    dx: float
    dy: float
    shortest_wavelength: float
    start: float = -2.5
    speed: float = 1.0
    front: float = 0.25
    kappa: float = 1.0
    periodic: bool = False
    MADE_BY: ClassVar[str] = "synthetic(..., point=point), or measured likewise,"
    _coefficients: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        heights = _table(self.heights)
        heights.setflags(write=False)
        object.__setattr__(self, "heights", heights)
        for name in ("dx", "dy", "shortest_wavelength", "front", "kappa"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name)))
        object.__setattr__(self, "start", require_finite("start", self.start))
        object.__setattr__(self, "speed", require_nonnegative("speed", self.speed))
        least = 2.0 * max(self.dx, self.dy / self.kappa)
        if self.shortest_wavelength < least * (1.0 - 1e-9):
            raise InputError(
                "shortest_wavelength", self.shortest_wavelength, f"at least {least:.4g}, two samples of the map"
            )
        object.__setattr__(self, "_coefficients", _spline(heights, self.periodic))

    @classmethod
    def synthetic(
        cls,
        rq: float,
        longest_wavelength: float,
        shortest_wavelength: float,
        *,
        hurst: float = 0.8,
        seed: int = 0,
        length: float | None = None,
        width: float | None = None,
        point: OperatingPoint | None = None,
        **course: Any,
    ) -> Self:
        """Gaussian heights of rms value `rq`, isotropic in metres, periodic, the same for the same arguments.

        Self-affine as ground and run-in surfaces are (Persson et al., J. Phys.: Condens. Matter 17 (2005) R1): the
        power spectrum is constant for wavelengths from `longest_wavelength` up and falls like
        ``q**(-2 (1 + hurst))`` down to `shortest_wavelength`, where it ends. Being even in Y, heights are larger
        by sqrt(2) on the middle plane itself.

        Parameters
        ----------
        rq : float
            In dry approaches, over the whole map; with a `point` in m.
        longest_wavelength, shortest_wavelength : float
            Wavelengths in semi-axes a; with a `point` in m.
        hurst : float
            Between 0 (jagged) and 1 (smooth).
        seed : int
            Of `numpy.random.default_rng`.
        length, width : float
            Of the map, in semi-axes a along and b across, where it is mirrored again; with a `point` in m. By
            default 8 and 4 semi-axes.
        point : OperatingPoint, optional
            Of the run: lengths are in m.
        **course
            `start`, `speed`, `front` and, without a `point`, `kappa`, as for the class; with one in m.

        Raises
        ------
        InputError
            A number outside its range; a map of more than `MOST_SAMPLES`.
        """
        rq, short = require_positive("rq", rq), require_positive("shortest_wavelength", shortest_wavelength)
        long = require_positive("longest_wavelength", longest_wavelength)
        if point is not None:
            scales = scales_at(point, "synthetic(...) without point")
            rq, long, short = rq / scales.length, long / scales.a, short / scales.a
            length = None if length is None else require_positive("length", length) / scales.a
            width = None if width is None else require_positive("width", width) / scales.b
            course = _course_at(point, course)
        length, width = LENGTH if length is None else length, WIDTH if width is None else width
        if short >= long:
            raise InputError("shortest_wavelength", short, f"below longest_wavelength = {long!r}")
        hurst = require_nonnegative("hurst", hurst)
        if hurst > 1.0:
            raise InputError("hurst", hurst, "between 0 and 1")
        require_integer("seed", seed, "a whole number >= 0", 0)
        kappa = require_positive("kappa", course.get("kappa", 1.0))
        for name, size, least in (("length", length, long), ("width", width, 0.5 * kappa * long)):
            if require_positive(name, size) < least:
                raise InputError(name, size, f"at least {least:.4g}, to hold longest_wavelength = {long!r}")
        wanted = SAMPLES * length / short, SAMPLES * width / (kappa * short)
        if wanted[0] * wanted[1] > MOST_SAMPLES:
            finest = SAMPLES * sqrt(length * width / (kappa * MOST_SAMPLES))
            raise InputError("shortest_wavelength", short, f"at least {finest:.2g}, or the map smaller")
        rows, columns = ceil(wanted[0]), ceil(wanted[1])
        dx, dy = length / rows, width / columns
        noise = np.random.default_rng(seed).standard_normal((rows, 2 * columns))
        along, across = np.fft.fftfreq(rows, dx), kappa * np.fft.rfftfreq(2 * columns, dy)
        waves = np.hypot(along[:, None], across[None, :])  # per semi-axis a
        strength = np.maximum(waves * long, 1.0) ** (-1.0 - hurst)
        strength[(waves * short > 1.0) | (waves == 0.0)] = 0.0
        whole = np.fft.irfft2(np.fft.rfft2(noise) * strength, noise.shape)
        whole += np.roll(whole[:, ::-1], 1, axis=1)  # and the same for -Y
        whole *= rq / np.sqrt(np.mean(whole * whole))
        return cls(whole[:, : columns + 1], dx, dy, short, periodic=True, **course)

    @classmethod
    def measured(
        cls,
        heights: ArrayLike,
        dx: float,
        dy: float,
        shortest_wavelength: float,
        *,
        point: OperatingPoint | None = None,
        **course: Any,
    ) -> Self:
        """A map as an instrument gives it: levelled, and smoothed to what the mesh can show.

        The least-squares plane is taken off; waves shorter than `shortest_wavelength` are damped by the Gaussian
        filter of ISO 16610-61, which leaves half of a wave of that length and 6 % of one half as long.

        Parameters
        ----------
        heights : array_like, shape (k, m)
            As for the class, in dry approaches; with a `point` in m.
        dx, dy, shortest_wavelength : float
            As for the class; with a `point` in m.
        point : OperatingPoint, optional
            Of the run: lengths are in m.
        **course
            `start`, `speed`, `front`, `periodic` and, without a `point`, `kappa`, as for the class; with one in m.

        Raises
        ------
        InputError
            As for the class.
        """
        table = _table(heights)
        dx, dy, short = (
            require_positive(name, value)
            for name, value in (("dx", dx), ("dy", dy), ("shortest_wavelength", shortest_wavelength))
        )
        if point is not None:
            scales = scales_at(point, "measured(...) without point")
            table, dx, dy, short = table / scales.length, dx / scales.a, dy / scales.b, short / scales.a
            course = _course_at(point, course)
        kappa = require_positive("kappa", course.get("kappa", 1.0))
        from scipy.ndimage import gaussian_filter

        spread = short * sqrt(0.5 * log(2.0)) / pi  # of the filter: half of `short` gets through
        ends = ("wrap" if course.get("periodic", False) else "mirror", "mirror")
        smooth = gaussian_filter(_levelled(table), (spread / dx, spread * kappa / dy), mode=ends)
        return cls(smooth, dx, dy, short, **course)

    @property
    def rms(self) -> float:
        """Root mean square of the heights over the whole map, in dry approaches."""
        return float(np.sqrt(np.mean(np.square(self.heights))))

    def __call__(self, X: Array, Y: Array, T: float) -> Array:
        """Height at time T, added to the gap."""
        X, Y = np.asarray(X, dtype=float), np.asarray(Y, dtype=float)
        rows, columns = self._coefficients.shape
        behind = self.start + self.speed * T - X  # how far the front has gone on
        places = (rows - 1.0) - behind / self.dx
        if not self.periodic:
            places = np.clip(places, 0.0, rows - 1.0)
        share = np.clip(behind / self.front, 0.0, 1.0)
        rise = share**3 * (10.0 + share * (6.0 * share - 15.0))
        along = _taps(places, rows, self.periodic)
        across = _taps(np.abs(Y) / self.dy, columns, False)
        return -rise * _between(self._coefficients, along, across)

    def require_fit(self, X: Array, Y: Array, until: float) -> None:
        """Raise `InputError` unless the grid shows the shortest wavelength and the map lasts until the end."""
        mesh = max(X[1] - X[0], (Y[1] - Y[0]) / self.kappa)
        least = FEWEST_NODES * mesh
        if self.shortest_wavelength < least * (1.0 - 1e-9):
            allowed = f"at least {least:.4g} semi-axes, {FEWEST_NODES:g} of the mesh of {mesh:.3g}: raise n"
            raise InputError(
                "surface.shortest_wavelength", self.shortest_wavelength, f"{allowed}, or smooth the surface"
            )
        if self.periodic:
            return
        rows, columns = self._coefficients.shape
        length, width = (rows - 1) * self.dx, (columns - 1) * self.dy
        needed = self.start + self.speed * until - X[0]
        if length < needed * (1.0 - 1e-9):
            allowed = f"at least {needed:.4g}, from x_in = {X[0]:g} to where its front is at T = {until:g}"
            raise InputError("length of surface.heights", length, f"{allowed}; or make it periodic")
        if width < Y[-1] * (1.0 - 1e-9):
            raise InputError("width of surface.heights", width, f"at least y_max = {Y[-1]:g}")


def _course_at(point: OperatingPoint, course: dict[str, Any]) -> dict[str, Any]:
    """Keywords of the class by those in m at a point, whose kappa they have."""
    if "kappa" in course:
        raise InputError("kappa", course["kappa"], "left out with a point, which has it")
    scales = point.scales
    checks = {"start": require_finite, "front": require_positive}
    own = {name: check(name, course[name]) / scales.a for name, check in checks.items() if name in course}
    return course | own | {"kappa": scales.a / scales.b, "made_at": point}


def _table(heights: ArrayLike) -> Array:
    """`heights` as an array of numbers, or `InputError`."""
    table = as_numbers("heights", heights, "a table of numbers, rows along rolling")
    if table.ndim != 2 or min(table.shape) < FEWEST_SAMPLES:
        allowed = f"of two dimensions with at least {FEWEST_SAMPLES} samples each"
        raise InputError("heights", f"of shape {table.shape}", allowed)
    if not np.isfinite(table).all():
        bad = int(table.size - np.isfinite(table).sum())
        raise InputError("heights", f"{bad} of {table.size} NaN or infinite", "finite: fill in what is missing")
    if not np.ptp(table) > 0.0:
        raise InputError("heights", f"all {table.flat[0]:g}", "of a rough surface")
    return table


def _levelled(table: Array) -> Array:
    """`table` less its least-squares plane."""
    rows, columns = (np.linspace(-1.0, 1.0, size) for size in table.shape)
    tilt = rows @ table.mean(axis=1) / (rows @ rows), columns @ table.mean(axis=0) / (columns @ columns)
    return table - table.mean() - tilt[0] * rows[:, None] - tilt[1] * columns


def _spline(heights: Array, periodic: bool) -> Array:
    """Coefficients of the cubic spline through `heights`, mirrored at every end or periodic along rolling."""
    from scipy.ndimage import spline_filter1d

    along = spline_filter1d(heights, 3, 0, mode="grid-wrap" if periodic else "mirror")
    return np.ascontiguousarray(spline_filter1d(along, 3, 1, mode="mirror"))


def _taps(places: Array, size: int, periodic: bool) -> Taps:
    """The four samples beside each of `places`, counted in samples, and their weights in a cubic spline."""
    first = np.floor(places)
    s = places - first
    r = 1.0 - s
    weights = np.array([r**3, 4.0 - 6.0 * s * s + 3.0 * s**3, 4.0 - 6.0 * r * r + 3.0 * r**3, s**3]) / 6.0
    samples = first.astype(np.intp) + np.arange(-1, 3).reshape(4, *(1,) * places.ndim)
    if periodic:
        return samples % size, weights
    samples = np.abs(samples) % (2 * size - 2)
    return np.minimum(samples, 2 * size - 2 - samples), weights


def _between(coefficients: Array, along: Taps, across: Taps) -> Array:
    """Value of the spline; for a row of places X and a column of places Y, as of grids, one after the other."""
    (i, a), (j, b) = along, across
    if i.ndim == 3 and i.shape[1] == 1 and j.shape[2:] == (1,):
        columns = sum(w[:, None] * coefficients[k] for k, w in zip(i[:, 0], a[:, 0], strict=True))
        return np.asarray(sum(w * columns.T[k] for k, w in zip(j[:, :, 0], b, strict=True)))
    pairs = ((k, w, m, v) for k, w in zip(i, a, strict=True) for m, v in zip(j, b, strict=True))
    return np.asarray(sum(w * v * coefficients[k, m] for k, w, m, v in pairs))
