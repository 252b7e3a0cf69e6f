"""Table of the contact filter of waves, G/Z of `ehlcontact.excitation` over M, L, kappa and wavelength.

What is interpolated, at every wave number k per semi-axis, is G/Z less that of dry contacts, sin(k)/k, over
h/(0.1 + h) with the published central film h in dry approaches: thin films change little of the dry filter. As
coordinates serve ln M, L^(2/3), ln kappa and the logarithm of the width of the inlet. Between the wave numbers
there is a cubic spline, at k = 0 the filter is 1. For waves shorter than those of the table the filter is given as
0, and its size is below the error bar.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_numbers
from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint, Point, moes_point
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.quantities import NUMBER
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.store import read, stored
from ehlcontact.summary import contact_text, span
from reduced_models.atlas.interpolation import Neighbours, Radial, error_factor, films, left_out_errors
from reduced_models.atlas.table import Box, require_shapes

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

SHIPPED = Path(__file__).with_name("filters.h5")
WEIGHTS = (0.4, 0.16, 0.33, 1.2)  # of ln M, L^(2/3) and ln kappa, as of the atlas, and of the width of the inlet
THICK = 0.1  # film, in dry approaches, beyond which deviations from the dry filter grow no more
NEAREST, COVERED = 10, 0.98  # points whose errors make the error bar; share of points left out that it covers
LAST_SURE = 2.0  # wave number per semi-axis up to which the ratio of film and dry filter is taken
SHORTER = 0.03  # |G/Z| that waves shorter than the table's stay below: error bar of the 0 given for them


@stored("table of contact filters", 1)
@dataclass(frozen=True, eq=False)
class FilterTable:
    """Solved points, and the errors of the interpolation at each without it."""

    points: _Floats  # (n, 3) M, L, kappa
    k: _Floats  # (m,) wave numbers per semi-axis
    real: _Floats  # (n, m) G/Z
    imag: _Floats  # (n, m)
    left_out: _Floats  # (n, m) size of the error, over `film_share`
    factor: _Floats  # (m,) from the errors of the nearest points to the error bar
    metadata: dict[str, Any]  # box; command, version, meshes

    @property
    def box(self) -> Box:
        """Ranges of M, L, kappa and Hertz pressure."""
        return Box.from_dict(self.metadata["box"])

    @property
    def deviation(self) -> _Complex:
        """G/Z less that of dry contacts, over `film_share`, shape (n, m)."""
        found = self.real + 1j * self.imag - dry_filter(self.k)
        return np.asarray(found / film_share(self.points)[:, None])

    def require_complete(self) -> None:
        """Raise `ValueError` or another error of damaged metadata unless all arrays are there and fit.

        Raises
        ------
        ValueError
            An array of another shape, or with numbers that are not finite.
        """
        n, m = len(self.points), self.k.size
        each = dict.fromkeys(("real", "imag", "left_out"), (n, m))
        require_shapes(self, {"points": (n, 3), "k": (m,), **each, "factor": (m,)})
        _ = self.box

    def judged(self) -> Self:
        """Table with leave-one-out errors, from which its error bars follow."""
        x, wanted = coordinates(self.points), self.deviation
        parts = left_out_errors(x, np.hstack([wanted.real, wanted.imag]))
        errors = np.hypot(parts[:, : self.k.size], parts[:, self.k.size :])
        return replace(self, left_out=errors, factor=error_factor(x, errors, NEAREST, COVERED))


def dry_filter(k: ArrayLike) -> _Floats:
    """Mean of a wave over a dry contact, sin(k)/k, weighted by the pressure of a small approach."""
    return np.sinc(np.asarray(k, float) / np.pi)


def film_share(points: _Floats) -> _Floats:
    """h/(0.1 + h) with the published central film h in dry approaches, at rows (M, L, kappa)."""
    found = films(points)
    return found / (THICK + found)


def coordinates(points: _Floats) -> _Floats:
    """Coordinates of rows (M, L, kappa), shape (n, 4)."""
    M, L, kappa = points.T
    width = [MoesPoint(*row).inlet_width for row in points.tolist()]
    return np.column_stack([np.log(M), L ** (2.0 / 3.0), np.log(kappa), np.log(width)]) * np.array(WEIGHTS)


class ContactFilters:
    """G/Z of many contacts at any wave number, by splines through its values at the wave numbers of the table.

    Parameters
    ----------
    k : ndarray, shape (m,)
        Wave numbers per semi-axis, from 0.
    nodes : ndarray, shape (m, contacts)
        G/Z there.
    bars : ndarray, shape (m, contacts)
        Half widths of its error bars, whatever its phase.
    """

    def __init__(self, k: _Floats, nodes: _Complex, bars: _Floats) -> None:
        spline = scipy.interpolate.CubicSpline(k, np.concatenate([nodes.real, nodes.imag], axis=1)).c
        self._k, self._bars, self._count = k, bars, nodes.shape[1]
        self._spline = spline[..., : self._count] + 1j * spline[..., self._count :]

    def at(self, k: ArrayLike) -> tuple[_Complex, _Floats]:
        """G/Z and error bars, shape (..., contacts), at wave numbers k >= 0, one for each contact or for all."""
        given = np.asarray(k, float)
        given = np.broadcast_to(given, np.broadcast_shapes(given.shape, (self._count,)))
        i = np.clip(np.searchsorted(self._k, given, side="right") - 1, 0, self._k.size - 2)
        contact = np.arange(self._count)
        x, (a, b, c, d) = given - self._k[i], self._spline[:, i, contact]
        share = x / (self._k[i + 1] - self._k[i])
        bar = self._bars[i, contact] * (1.0 - share) + self._bars[i + 1, contact] * share
        shorter = given > self._k[-1]
        return np.where(shorter, 0.0, ((a * x + b) * x + c) * x + d), np.where(shorter, SHORTER, bar)


class FilterSurface:
    """The table as a function of rows (M, L, kappa)."""

    @one_blas_thread()
    def __init__(self, table: FilterTable) -> None:
        self.table, x = table, coordinates(table.points)
        self._radial = Radial(x, np.hstack([table.deviation.real, table.deviation.imag]))
        self._neighbours = Neighbours(x, table.left_out, NEAREST)

    @one_blas_thread()
    def contacts(self, points: _Floats) -> ContactFilters:
        """Filters of contacts by rows (M, L, kappa); one outside the box has that of the nearest inside."""
        table, box = self.table, self.table.box
        low, high = np.transpose([box.M, box.L, box.kappa])
        inside = np.clip(points, low, high)
        x, m = coordinates(inside), table.k.size
        distance = scipy.spatial.distance.cdist(x, self._radial.x)
        (grown, local), share = self._neighbours.at(distance), film_share(inside)[:, None]
        found = self._radial.at(x, distance)
        nodes = dry_filter(table.k) + share * (found[:, :m] + 1j * found[:, m:])
        bars = share * grown * table.factor * local
        still = np.ones((1, len(points)))  # waves without end are an approach
        return ContactFilters(
            np.append(0.0, table.k), np.vstack([still, nodes.T]), np.vstack([0.0 * still, bars.T])
        )


@lru_cache(maxsize=1)
def shipped_filters() -> FilterSurface:
    """The table that comes with the library, read once."""
    return FilterSurface(read(SHIPPED, FilterTable))


@dataclass(frozen=True, eq=False)
class FilterAnswer(QuantityTable):
    """Contact filter of one point over wavelength, with error bars.

    Attributes
    ----------
    point : MoesPoint
    wavelength : ndarray, shape (m,)
        Along rolling, in semi-axes a.
    in_phase, quadrature : ndarray, shape (m,)
        Real and imaginary part of `ratio`.
    error : ndarray, shape (m,)
        Half width of the error bar of `ratio`, whatever its phase.
    """

    point: MoesPoint
    wavelength: Annotated[_Floats, NUMBER.over("wavelength")]
    in_phase: Annotated[_Floats, NUMBER.over("wavelength")]
    quadrature: Annotated[_Floats, NUMBER.over("wavelength")]
    error: Annotated[_Floats, NUMBER.over("wavelength")]

    DISPLAY: ClassVar[Display] = Display(rows="wavelength", panels=("contact_filter",), logs="x")
    UNITS = "dimensionless"

    @property
    def ratio(self) -> _Complex:
        """G/Z, shape (m,): force of a wave on one surface in pure rolling over that of an approach as high.

        With ``exp(i Omega T)`` and the summit of the wave in the middle of the contact.
        """
        return np.asarray(self.in_phase + 1j * self.quadrature)

    @property
    def contact_filter(self) -> Annotated[_Floats, NUMBER.over("wavelength")]:
        """Size of `ratio`: share of the height that acts like an approach, shape (m,)."""
        return np.abs(self.ratio)

    def _summary_lines(self) -> list[str]:
        return [
            contact_text(self.point, None),
            f"contact filter {span(self.contact_filter)} at wavelengths of {span(self.wavelength)} semi-axes",
            f"error bars up to {self.error.max():.2g}",
        ]


def contact_filter(point: Point, *, wavelength: ArrayLike) -> FilterAnswer:
    """Contact filter of waves at a point, from the table that comes with the library.

    As `ehlcontact.excitation` computes it, for the oil of the table: inlets are flooded, surfaces roll without
    sliding. G is this filter times the impedance, as `Atlas.at` gives it at ``Omega = 2 pi/wavelength``.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    wavelength : float or sequence of float
        Along rolling, in semi-axes a. For waves shorter than the table has it is 0 within its error bar.

    Raises
    ------
    InputError
        A point outside the box of the table; wavelengths that are not positive.
    """
    moes, surface = moes_point(point), shipped_filters()
    surface.table.box.require_inside(moes)
    found = np.atleast_1d(as_numbers("wavelength", wavelength))
    if found.ndim != 1 or not found.size or not (np.isfinite(found) & (found > 0.0)).all():
        raise InputError("wavelength", np.asarray(wavelength).tolist(), "finite and > 0, one or a flat list")
    row = np.array([[moes.M, moes.L, moes.kappa]])
    ratio, error = surface.contacts(np.repeat(row, found.size, axis=0)).at(2.0 * np.pi / found)
    return FilterAnswer(moes, found, ratio.real.copy(), ratio.imag.copy(), error)


def film_over_dry(point: Point, k: ArrayLike) -> _Complex:
    """What the film of a contact leaves of heights that a dry contact has filtered, at wave numbers k >= 0.

    Ratio of the filter of the film to that of the dry contact up to k = 2 per semi-axis. Beyond, where the dry
    filter has zeros, the ratio is continued as the transform of a Gaussian with the same delay. Heights of
    `reduced_models.bearing.height_tables`, filtered by it, are those of a contact with its film.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    k : float or sequence of float
        Per semi-axis a.

    Raises
    ------
    InputError
        A point outside the box of the table; wave numbers below 0.
    """
    given = np.atleast_1d(as_numbers("k", k))
    if not (np.isfinite(given) & (given >= 0.0)).all():
        raise InputError("k", np.asarray(k).tolist(), "finite and >= 0")
    moes = moes_point(point)
    shipped_filters().table.box.require_inside(moes)
    return films_over_dry(np.array([[moes.M, moes.L, moes.kappa]]), given[:, None])[:, 0]


def films_over_dry(points: _Floats, k: _Floats) -> _Complex:
    """The same of contacts by rows (M, L, kappa), at wave numbers of shape (..., contacts).

    A contact outside the box of the table has the filter of the nearest inside.
    """
    filters, known = shipped_filters().contacts(points), np.minimum(k, LAST_SURE)
    found, last = filters.at(known)[0] / dry_filter(known), filters.at(LAST_SURE)[0] / dry_filter(LAST_SURE)
    reach = k / LAST_SURE
    beyond = np.abs(last) ** (reach * reach) * np.exp(1j * np.angle(last) * reach)
    return np.where(k <= LAST_SURE, found, beyond)
