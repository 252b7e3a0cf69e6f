"""Recipe of waves: contact filter G/Z of `ehlcontact.excitation` over M, L, kappa and wavelength.

Smooth variables, at every wave number k per semi-axis: G/Z less that of dry contacts, sin(k)/k, over h/(0.1 + h)
with the published central film h in dry approaches: thin films change little of the dry filter. Coordinates: ln
M, L^(2/3), ln kappa and the logarithm of the width of the inlet. Between the wave numbers there is a cubic
spline, at k = 0 the filter is 1. For waves shorter than those of the table the filter is given as 0, and its
size is below the error bar.

Sample: scrambled Sobol points over M, L and kappa of the contacts of ball bearings. Where the film is so thin
that a table cannot afford its mesh, there is no point; the filter changes slowly there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact import MoesPoint, excitation, impedance
from ehlcontact.checks import as_numbers
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint, Point, moes_point
from ehlcontact.quantities import ALONG, NUMBER
from ehlcontact.response import LONGEST
from ehlcontact.results.table import Display, PointTable
from ehlcontact.summary import contact_text, span
from reduced_models.atlas.film import published_films
from reduced_models.atlas.mesh import TableGrid
from reduced_models.atlas.recipe import Entry, Recipe, columns_of, entry_of, overshot, sobol
from reduced_models.atlas.surface import shipped
from reduced_models.atlas.table import Box, Interpolation, Table

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

# Wave numbers per semi-axis: wavelengths from 63 a down to 1 a.
WAVE_NUMBERS = (
    0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.3, 3.7, 4.1, 4.6, 5.1, 5.7,
    2.0 * np.pi,
)  # fmt: skip
BOX = Box(M=(20.0, 20000.0), L=(2.0, 30.0), kappa=(0.06, 0.5), p_hertz=4e9)
OVERSHOOT = 0.04  # share of the box by which draws reach beyond it, to be moved onto its faces
# A shortest wave of 16 nodes on the default region, and of 8 where the film is thick.
GRIDS = (
    TableGrid(0.2, 96, False),
    TableGrid(0.09, 128, False),
    TableGrid(0.05, 128, True),
    TableGrid(0.03, 192, True),
)
THICK = 0.1  # film, in dry approaches, beyond which deviations from the dry filter grow no more
LAST_SURE = 2.0  # wave number per semi-axis up to which the ratio of film and dry filter is taken
SHORTER = 0.03  # |G/Z| that waves shorter than the table's stay below: error bar of the 0 given for them


@entry_of
def solve_waves(point: MoesPoint) -> dict[str, Any]:
    """Entry of a point: G/Z of waves on one surface in pure rolling, with the error that the mesh leaves."""
    grid = next(grid for grid in GRIDS if point.inlet_width >= grid.least_inlet).on(point)
    k = np.array(WAVE_NUMBERS)
    waves, approach = excitation(point, Omega=k, grid=grid), impedance(point, Omega=k, grid=grid)
    ratio = waves.value / (approach.stiffness + 1j * k * approach.damping)
    entry: dict[str, Any] = {"M": point.M, "L": point.L, "kappa": point.kappa}
    entry |= {"real": ratio.real.tolist(), "imag": ratio.imag.tolist()}
    entry["error"] = np.asarray(waves.error_bars["contact_filter"]).tolist()
    assert waves.film is not None
    return entry | {"n": waves.film.n, "domain": list(waves.film.domain.as_tuple())}


def dry_filter(k: ArrayLike) -> _Floats:
    """Mean of a wave over a dry contact, sin(k)/k, weighted by the pressure of a small approach."""
    return np.sinc(np.asarray(k, float) / np.pi)


class WavesRecipe(Recipe[MoesPoint]):
    """Contact filters over the wave numbers of the table."""

    name, title = "waves", "table of contact filters"
    numbers: ClassVar = {"draws": 72, "seed": 7}
    keeps_errors = True
    # Of ln M, L^(2/3) and ln kappa, as of films, and of the width of the inlet.
    interpolation = Interpolation(weights=(0.4, 0.16, 0.33, 1.2), nearest=10, covered=0.98)
    box = BOX
    solve = staticmethod(solve_waves)

    def sample(self, draws: int, seed: int = 0) -> dict[str, MoesPoint]:
        """Points to solve by name, in the order of their draws; more draws add to the fewer.

        What is drawn a little outside the box is moved onto its faces; a Hertz pressure above that of the box is
        brought down by M.
        """
        low, high = np.transpose([np.log(BOX.M), BOX.L, np.log(BOX.kappa)])
        shares = overshot(sobol(3, draws, seed), OVERSHOOT)
        points = {}
        for i, (M, L, kappa) in enumerate((low + shares * (high - low)).tolist()):
            point = MoesPoint(float(np.exp(M)), L, float(np.exp(kappa)))
            excess = max(point.p_hertz / BOX.p_hertz, 1.0)
            point = replace(point, M=point.M * excess**-3.0)  # pressure grows like M^(1/3)
            if point.inlet_width >= GRIDS[-1].least_inlet:
                points[f"waves-{i}"] = point
        return points

    def assemble(self, entries: Sequence[Entry]) -> tuple[_Floats, dict[str, _Floats], dict[str, _Floats]]:
        """Points, wave numbers and G/Z."""
        parts = {name: np.array([entry[name] for entry in entries]) for name in ("real", "imag")}
        return columns_of(entries, "M", "L", "kappa"), {"k": np.array(WAVE_NUMBERS)}, parts

    def metadata(self, entries: Sequence[Entry]) -> dict[str, Any]:
        """Meshes and the error that they leave."""
        meshes = Counter(f"{entry['n']} from X = {entry['domain'][0]:.3g}" for entry in entries)
        error = np.median([entry["error"] for entry in entries], axis=0)
        return {"meshes": dict(sorted(meshes.items())), "mesh_error": error.round(4).tolist()}

    def shapes(self, table: Table) -> dict[str, tuple[int, ...]]:
        """Shape of every axis and column."""
        n, m = len(table.points), table["k"].size
        return {"k": (m,), **dict.fromkeys(("real", "imag", "left_out"), (n, m)), "factor": (m,)}

    def unit(self, table: Table, points: _Floats) -> _Floats:
        """h/(0.1 + h) with the published central film h in dry approaches."""
        film = published_films(points)
        return film / (THICK + film)

    def coordinates(self, table: Table, points: _Floats, unit: _Floats) -> tuple[_Floats, ...]:
        """Coordinates of rows (M, L, kappa), shape (n, 4)."""
        M, L, kappa = points.T
        width = [MoesPoint(*row).inlet_width for row in points.tolist()]
        unweighted = np.column_stack([np.log(M), L ** (2.0 / 3.0), np.log(kappa), np.log(width)])
        return (unweighted * np.array(table.interpolation.weights),)

    def smooth(self, table: Table, unit: _Floats) -> _Floats:
        """Real and imaginary parts of G/Z less that of dry contacts, over the unit, shape (n, 2 m)."""
        deviation = (table["real"] + 1j * table["imag"] - dry_filter(table["k"])) / unit[:, None]
        return np.hstack([deviation.real, deviation.imag])

    def sizes(self, errors: _Floats) -> _Floats:
        """Sizes of the complex errors, shape (n, m)."""
        m = errors.shape[1] // 2
        return np.hypot(errors[:, :m], errors[:, m:])

    def values(
        self, table: Table, points: _Floats, unit: _Floats, smooth: _Floats, bars: _Floats, **more: Any
    ) -> tuple[Any, _Floats]:
        """G/Z and half widths of its error bars, whatever its phase, shape (n, m)."""
        share, m = unit[:, None], smooth.shape[1] // 2
        return dry_filter(table["k"]) + share * (smooth[:, :m] + 1j * smooth[:, m:]), share * bars


RECIPE = WavesRecipe()


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
        k = np.asarray(k, float)
        k = np.broadcast_to(k, np.broadcast_shapes(k.shape, (self._count,)))
        i = np.clip(np.searchsorted(self._k, k, side="right") - 1, 0, self._k.size - 2)
        contact = np.arange(self._count)
        x, (a, b, c, d) = k - self._k[i], self._spline[:, i, contact]
        share = x / (self._k[i + 1] - self._k[i])
        bar = self._bars[i, contact] * (1.0 - share) + self._bars[i + 1, contact] * share
        shorter = k > self._k[-1]
        return np.where(shorter, 0.0, ((a * x + b) * x + c) * x + d), np.where(shorter, SHORTER, bar)


def filters_of(points: _Floats) -> ContactFilters:
    """Filters of contacts by rows (M, L, kappa); one outside the box has that of the nearest inside."""
    surface = shipped("waves")
    nodes, bars = surface.at(np.clip(points, *surface.table.box.ends))
    still = np.ones((1, len(points)))  # waves without end are an approach
    k = np.append(0.0, surface.table["k"])
    return ContactFilters(k, np.vstack([still, nodes.T]), np.vstack([0.0 * still, bars.T]))


def filter_box() -> Box:
    """Ranges of the table."""
    return shipped("waves").table.box


def last_wave_number() -> float:
    """Wave number per semi-axis of the shortest waves of the table."""
    return float(shipped("waves").table["k"][-1])


@dataclass(frozen=True, eq=False)
class FilterAnswer(PointTable):
    """Contact filter of one point over wavelength, with error bars.

    Attributes
    ----------
    point : MoesPoint or OperatingPoint
    wavelength : ndarray, shape (m,)
        Along rolling [m; a].
    in_phase, quadrature : ndarray, shape (m,)
        Real and imaginary part of `ratio`.
    error : ndarray, shape (m,)
        Half width of the error bar of `ratio`, whatever its phase.
    """

    point: Point
    wavelength: Annotated[_Floats, ALONG.over("wavelength")]
    in_phase: Annotated[_Floats, NUMBER.over("wavelength")]
    quadrature: Annotated[_Floats, NUMBER.over("wavelength")]
    error: Annotated[_Floats, NUMBER.over("wavelength")]

    DISPLAY: ClassVar[Display] = Display(rows="wavelength", panels=("contact_filter",), logs="x")

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
        unit = (1e6, "µm") if isinstance(self.point, OperatingPoint) else (1.0, "semi-axes")
        return [
            contact_text(self.point.moes),
            f"contact filter {span(self.contact_filter)} at wavelengths of {span(self.wavelength, *unit)}",
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
        Along rolling, in the units of the point: m at an `OperatingPoint`, semi-axes a at a `MoesPoint`. For waves
        shorter than the table has it is 0 within its error bar.

    Raises
    ------
    InputError
        A point outside the box of the table; wavelengths that are not positive.
    """
    moes, unit = moes_point(point), point.scales.a
    filter_box().require_inside(moes)
    waves = np.atleast_1d(as_numbers("wavelength", wavelength))
    if waves.ndim != 1 or not waves.size or not (np.isfinite(waves) & (waves > 0.0)).all():
        raise InputError("wavelength", np.asarray(wavelength).tolist(), "finite and > 0, one or a flat list")
    if isinstance(point, OperatingPoint) and waves.max() > LONGEST * unit:
        allowed = f"at most {LONGEST * unit:.3g} m at an OperatingPoint (given in semi-axes a?)"
        raise InputError("wavelength", float(waves.max()), allowed)
    waves = waves / unit
    row = np.array([[moes.M, moes.L, moes.kappa]])
    ratio, error = filters_of(np.repeat(row, waves.size, axis=0)).at(2.0 * np.pi / waves)
    return FilterAnswer(moes, waves, ratio.real.copy(), ratio.imag.copy(), error).in_units_of(point)


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
    numbers = np.atleast_1d(as_numbers("k", k))
    if not (np.isfinite(numbers) & (numbers >= 0.0)).all():
        raise InputError("k", np.asarray(k).tolist(), "finite and >= 0")
    moes = moes_point(point)
    filter_box().require_inside(moes)
    return films_over_dry(np.array([[moes.M, moes.L, moes.kappa]]), numbers[:, None])[:, 0]


def films_over_dry(points: _Floats, k: _Floats) -> _Complex:
    """`film_over_dry` of contacts by rows (M, L, kappa), at wave numbers of shape (..., contacts).

    A contact outside the box of the table has the filter of the nearest inside.
    """
    filters, known = filters_of(points), np.minimum(k, LAST_SURE)
    ratio, last = filters.at(known)[0] / dry_filter(known), filters.at(LAST_SURE)[0] / dry_filter(LAST_SURE)
    reach = k / LAST_SURE
    beyond = np.abs(last) ** (reach * reach) * np.exp(1j * np.angle(last) * reach)
    return np.where(k <= LAST_SURE, ratio, beyond)
