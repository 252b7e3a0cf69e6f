"""Recipe of films: approach, film and impedance of flooded isothermal contacts over M, L and kappa.

Sample: three sets of scrambled Sobol points in the box with a margin: over the whole box; over its light loads,
where answers change more; and over those among them where the film turns from one that lifts rigid bodies to one
between flattened ones, where they change most. The first two are denser at small L.

Smooth variables: ln of 1 - u, of Hc, of C at the lowest frequency > 0 and of the moment, each over a published
central film; ln(Hm/Hc); ln K at each frequency; asinh of every C over a small share of that one (C may touch 0).

Coordinates: Wijnant's load number N, which separates rigid from elastic films, L^(2/3), kappa; how far N lies
below a light load, where the default domain grows with it (`formulas.lightness` is the rule of both); and the
published film. Three would do, but answers curve more sharply in them than in all five. Hm/Hc follows the side
lobes and bends elsewhere than the others: it has weights of its own, of the first four.

All numbers of the interpolation go into the file of a table and are read from there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Domain, Grid, MoesPoint, impedance, solve_steady
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.film_formulas import LIGHT_BLEND, LIGHT_LOAD, expected_film, lightness, load_number
from ehlcontact.hertz import radius_ratio
from ehlcontact.status import Status
from reduced_models.atlas.gain_fit import FLOOR, HIGHEST, RIDGE, smooth_gains
from reduced_models.atlas.mesh import film_grid, impedance_grid, near_grid
from reduced_models.atlas.other_oil import OtherOil
from reduced_models.atlas.recipe import (
    FEWEST,
    FILM,
    Entry,
    Recipe,
    between,
    columns_of,
    entry_of,
    overshot,
    sobol,
)
from reduced_models.atlas.table import Box, Interpolation, Table
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]

# Dense enough for the cubic between them (`reduced_models.atlas.frequency_curve`), where lags make K and C wave.
OMEGAS = (
    0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, np.pi, 3.5, 4.0, 4.5, 5.0,
    5.5, 2.0 * np.pi, 7.0, 8.0, 9.0, 10.0, 11.0, 4.0 * np.pi, 13.5, 15.0, 16.5, 18.0, 20.0, 22.5, 8.0 * np.pi,
    28.0, 32.0, 37.0, 43.0, 51.0, 60.0,
)  # fmt: skip
# Answers at a point stand in one row: approach, films, low-frequency C, moment; then K and C over frequency.
LOW, HEAD = 3, 5
LOBE = 2  # smooth variable ln(Hm/Hc)
THICKEST = 3.0  # film 1 - u up to which K of another oil differs the more the thicker the film

OVERSHOOT = 0.08  # share of the cube by which draws reach beyond it, to be moved onto its faces
PRESSURE_OVERSHOOT = 1.15  # and beyond the largest Hertz pressure
WARP_L = 1.5  # power of the draw, even in L at 1: denser at small L
INLET_SPARSE = 0.05  # inlet width below which every second point is left out: dear to solve, and changing slowly
LIGHT = 15.0  # load number up to which the second set reaches
TURN = (0.8, 10.0)  # and from where to where the third
BOX = Box(M=(1.0, 30000.0), L=(0.0, 30.0), kappa=(0.045, 1.0), p_hertz=4.1e9)
SAMPLED = Box(M=(0.95, 33000.0), L=(0.002, 31.0), kappa=(0.0432, 1.06), p_hertz=4.25e9)


@dataclass(frozen=True, kw_only=True)
class FilmInterpolation(Interpolation):
    """Settings of the interpolation of films."""

    lobe_weights: tuple[float, ...]  # of the first four coordinates, for Hm/Hc
    light_load: float  # load number about which the default domain began to grow when it was built
    light_blend: float  # and the factor on it over which
    thick: float  # film, in dry approaches, beyond which the published one no longer leads
    asinh: float  # of the low-frequency damping: where asinh turns from ln to linear
    reference: int  # index of the frequency of the low-frequency damping

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "lobe_weights", tuple(float(weight) for weight in self.lobe_weights))


# By tests/benchmarks/tune_atlas.py the slopes cover what is left at light, middle and heavy load.
OIL = OtherOil(
    alpha=(1e-8, 4e-8),
    eta0=(0.002, 1.0),
    secant=1.8,
    film=(0.06, 0.006),
    stiffness=(0.08, 0.01),
    damping=(0.13, 0.012),
    moment=(0.055, 0.01),
)
# That fit all points together, by that script: those of the atlas before, without light loads, fit a third worse.
RATES = FilterRates(lags=14, lag_rate=6.42, inlet_rate=14.9, fast_rate=43.0)


def published_films(points: _Floats) -> _Floats:
    """Published central film of rows (M, L, kappa) in dry approaches, shape (n,)."""
    return np.array([expected_film(*row) for row in points.tolist()])


class _Set(NamedTuple):
    """One sequence of draws."""

    name: str
    draws: int
    load_numbers: tuple[float, float] | None  # between which M is drawn; by default over the box
    warp: float

    def points(self, seed: int) -> Iterator[MoesPoint]:
        """All draws."""
        for u, v, w in overshot(sobol(3, self.draws, seed), OVERSHOOT).tolist():
            kappa, ends = between(SAMPLED.kappa, w), SAMPLED.M
            if self.load_numbers is not None:
                low, high = (N / load_number(1.0, kappa) for N in self.load_numbers)
                ends = max(SAMPLED.M[0], low), high
            L = SAMPLED.L[0] + (SAMPLED.L[1] - SAMPLED.L[0]) * v**self.warp
            yield MoesPoint(between(ends, u), L, kappa)


@entry_of
def solve_point(point: MoesPoint) -> dict[str, Any]:
    """Entry of a point: steady film and impedance on a mesh that resolves the film.

    ``film`` is the steady film on a finer mesh and ``close`` the answers on the near region, where there are such.
    """
    entry: dict[str, Any] = {"M": point.M, "L": point.L, "kappa": point.kappa, "alpha": point.alpha}
    entry |= {"eta0": point.eta0}
    try:
        grid, of_film, near = (choose(point) for choose in (impedance_grid, film_grid, near_grid))
    except InputError:  # too thin a film for any mesh that is affordable
        return entry | {"status": str(Status.UNRESOLVED)}
    entry |= respond(point, grid)
    entry |= fine_film(point, of_film, grid)
    if near != grid:
        with suppress(ConvergenceError):
            entry["close"] = respond(point, near)
    return entry


def fine_film(point: MoesPoint, wanted: Grid, coarse: Grid) -> dict[str, Any]:
    """The film on the grid wanted, or on half its intervals where that fails; nothing if `coarse` is as fine."""
    assert wanted.n is not None and coarse.n is not None
    for n in (wanted.n, wanted.n // 2):
        if wanted.domain == coarse.domain and n <= coarse.n:
            break
        with suppress(ConvergenceError):
            return {"film": _film(solve_steady(point, grid=replace(wanted, n=n)))}
    return {}


def respond(point: MoesPoint, grid: Grid) -> dict[str, Any]:
    """Steady film and impedance at `OMEGAS`."""
    answer = impedance(point, Omega=OMEGAS, grid=grid)
    return _film(answer.film) | {"stiffness": answer.stiffness.tolist(), "damping": answer.damping.tolist()}


def _film(result: Any) -> dict[str, Any]:
    """Approach and films of a result, and where it was solved."""
    numbers = {name: getattr(result, name) for name in FILM}
    return numbers | {"n": result.n, "domain": list(result.domain.as_tuple())}


def rows_of(table: Table) -> _Floats:
    """Interpolated answers, shape (n, 5 + 2 k)."""
    damping = table["damping"]
    low = damping[:, table.interpolation.reference]
    head = table["approach"], table["h_central"], table["h_min"], low, table["moment"]
    return np.column_stack([*head, table["stiffness"], damping])


def to_smooth(film: _Floats, answers: _Floats, by: FilmInterpolation) -> _Floats:
    """Smooth variables of rows of answers, both shape (n, 5 + 2 k), over a published film."""
    k = (answers.shape[1] - HEAD) // 2
    u, central, least, low, moment = answers[:, :HEAD].T
    expected = film / (by.thick + film)
    head = np.log([(1.0 - u) / expected, central / expected, least / central, low / expected, moment / expected])
    K, C = answers[:, HEAD : HEAD + k], answers[:, HEAD + k :]
    return np.column_stack([head.T, np.log(K), np.arcsinh(C / (by.asinh * low[:, None]))])


def from_smooth(film: _Floats, smooth: _Floats, by: FilmInterpolation) -> tuple[_Floats, _Floats]:
    """Answers of rows of smooth variables; and their derivatives to these."""
    k = (smooth.shape[1] - HEAD) // 2
    grown = np.exp(smooth[:, : HEAD + k])
    grown[:, [0, 1, LOW, HEAD - 1]] *= (film / (by.thick + film))[:, None]
    grown[:, 2] *= grown[:, 1]
    scale = by.asinh * grown[:, [LOW]]
    C = scale * np.sinh(smooth[:, HEAD + k :])
    slopes = np.column_stack([grown, np.hypot(scale, C)])  # cosh from sinh
    grown[:, 0] = 1.0 - grown[:, 0]
    return np.column_stack([grown, C]), slopes


class FilmRecipe(Recipe[MoesPoint]):
    """Films and impedances of flooded isothermal contacts."""

    name, title = "film", "atlas"
    why_left_out = "not converged or too thin a film"
    numbers: ClassVar = {"draws": 448, "light_draws": 256, "seed": 4}
    keeps_errors = True
    settings = FilmInterpolation
    # By that script, other weights lower the error of points left out by less than 2 %.
    interpolation = FilmInterpolation(
        weights=(0.4, 0.16, 0.33, 0.905, 0.476),
        lobe_weights=(0.112, 0.083, 0.223, 2.78),
        nearest=10,
        covered=0.98,
        light_load=LIGHT_LOAD,
        light_blend=LIGHT_BLEND,
        thick=0.1,
        asinh=0.02,
        reference=1,
    )
    apart = (LOBE,)
    box = BOX
    solve = staticmethod(solve_point)

    def sample(self, draws: int, light_draws: int = 0, seed: int = 0) -> dict[str, MoesPoint]:
        """Points to solve by name; more draws add to the fewer, a few of which fall away.

        What is drawn a little outside is moved onto the faces, so that the edges are interpolated too; a Hertz
        pressure a little too high is brought down by M, one far too high leaves the draw out. There are as many
        `draws` over the whole box, `light_draws` over light loads, and half as many again where the film turns.
        """
        sets = (
            _Set("all", draws, None, WARP_L),
            _Set("light", light_draws, (0.0, LIGHT), WARP_L),
            _Set("turn", light_draws // 2, TURN, 1.0),
        )
        points: dict[str, MoesPoint] = {}
        for k, which in enumerate(sets):
            thin = 0
            for i, point in enumerate(which.points(seed + k)):
                excess = point.p_hertz / SAMPLED.p_hertz
                if excess > PRESSURE_OVERSHOOT:
                    continue
                if point.inlet_width < INLET_SPARSE:  # not by i: its parity tells in which half of the cube it is
                    thin += 1
                    if thin % 2 == 0:
                        continue
                # pressure grows like M^(1/3)
                points[f"{which.name}-{i}"] = replace(point, M=point.M * max(excess, 1.0) ** -3.0)
        return points

    def assemble(self, entries: Sequence[Entry]) -> tuple[_Floats, dict[str, _Floats], dict[str, _Floats]]:
        """Points, frequencies and answers.

        Where the film is so thin that only the near domain was solved, what the oil further out adds to damping
        and moment and takes from the approach is learnt from the points that were solved on both.
        """
        omega, points = np.array(OMEGAS), columns_of(entries, "M", "L", "kappa")
        steady = [entry.get("film", entry) for entry in entries]
        film = dict(zip(FILM, columns_of(steady, *FILM).T, strict=True))
        K, C = (columns_of(entries, name)[:, 0] for name in ("stiffness", "damping"))
        outer = _OuterOil([entry for entry in entries if entry.get("close") is not None])
        near = np.array([_is_near(entry) for entry in entries])
        if near.any():
            C[near] += outer.correction("damping", points[near])
            film_near = np.array([_is_near(entry) for entry in steady])
            for name in ("approach", "moment"):
                film[name][film_near] += outer.correction(name, points[film_near])
        low = C[:, self.interpolation.reference]
        gains = [smooth_gains(omega, k, c, RATES, unit) for k, c, unit in zip(K, C, low, strict=True)]
        return points, {"omega": omega}, {**film, "stiffness": K, "damping": C, "gains": np.array(gains)}

    def metadata(self, entries: Sequence[Entry]) -> dict[str, Any]:
        """Rates, settings for other oils, meshes, and the oil of the table."""
        law = MoesPoint(entries[0]["M"], entries[0]["L"], entries[0]["kappa"])
        domains = ("the default domain", "the near domain")
        meshes = Counter((int(entry["n"]), domains[_is_near(entry)]) for entry in entries)
        return {
            "rates": asdict(RATES),
            "highest_omega": HIGHEST,
            "gain_fit": {"floor": FLOOR, "ridge": RIDGE},
            "oil": asdict(OIL),
            "sampled": SAMPLED.to_dict(),
            "meshes": {f"{n} on {region}": count for (n, region), count in sorted(meshes.items())},
            "near_domain": next((list(entry["domain"]) for entry in entries if _is_near(entry)), None),
            "alpha": float(entries[0]["alpha"]),
            "eta0": float(entries[0]["eta0"]),
            "viscosity": law.viscosity,
            "density": law.density,
        }

    def shapes(self, table: Table) -> dict[str, tuple[int, ...]]:
        """Shape of every axis and column."""
        n, k = len(table.points), table["omega"].size
        smooth = HEAD + 2 * k
        shapes = {"omega": (k,), "left_out": (n, smooth), "factor": (smooth,), **dict.fromkeys(FILM, (n,))}
        shapes |= dict.fromkeys(("stiffness", "damping"), (n, k))
        return shapes | {"gains": (n, 3 + FilterRates(**table.metadata["rates"]).lags)}

    def require_metadata(self, table: Table) -> None:
        """Raise any error unless the metadata have what is read from them."""
        meta = table.metadata
        _ = table.box, OtherOil(**meta["oil"]), float(meta["highest_omega"]), str(meta["version"])
        if not 0 <= table.interpolation.reference < table["omega"].size:
            raise ValueError(f"reference {table.interpolation.reference} is no frequency of {table['omega'].size}")

    def unit(self, table: Table, points: _Floats) -> _Floats:
        """Published central film."""
        return published_films(points)

    def coordinates(self, table: Table, points: _Floats, unit: _Floats) -> tuple[_Floats, ...]:
        """Coordinates, shape (n, 5), and those of Hm/Hc, shape (n, 4)."""
        by, (M, L, kappa) = table.interpolation, points.T
        log_load = np.log(M) + 0.5 * np.log([radius_ratio(k) for k in kappa.tolist()])
        light = [lightness(N, by.light_load, by.light_blend) for N in log_load.tolist()]
        unweighted = np.column_stack([log_load, L ** (2.0 / 3.0), np.log(kappa), light, np.log(unit)])
        return unweighted * np.array(by.weights), unweighted[:, :4] * np.array(by.lobe_weights)

    def smooth(self, table: Table, unit: _Floats) -> _Floats:
        """Smooth variables of a table, shape (n, 5 + 2 k)."""
        return to_smooth(unit, rows_of(table), table.interpolation)

    def beside(self, table: Table) -> _Floats:
        """Gains of the film memory, over the low-frequency damping."""
        return table["gains"]

    def values(
        self,
        table: Table,
        points: _Floats,
        unit: _Floats,
        smooth: _Floats,
        bars: _Floats,
        *,
        oil_error: _Floats | None = None,
        **more: Any,
    ) -> tuple[_Floats, _Floats]:
        """Answers and half widths of their error bars, both shape (n, 5 + 2 k).

        `oil_error`, per unit of the film 1 - u up to `THICKEST` for K, adds to the bars of the smooth variables;
        shape (5 + 2 k,).
        """
        values, slopes = from_smooth(unit, smooth, table.interpolation)
        k = (values.shape[1] - HEAD) // 2
        stiffness, damping = slice(HEAD, HEAD + k), slice(HEAD + k, None)
        if oil_error is not None and oil_error.any():
            added = np.tile(oil_error, (len(points), 1))
            added[:, stiffness] *= np.minimum(1.0 - values[:, :1], THICKEST)
            bars = bars + added
        error = slopes * bars
        # over the low-frequency damping, whose error comes on top
        error[:, damping] = np.hypot(error[:, damping], values[:, damping] * bars[:, [LOW]])
        return values, error


class _OuterOil:
    """Effect of the oil beyond the near domain: lambda of the Reynolds equation times a smooth function.

    The gap there is that of the dry contact. The function is linear in ln kappa, its square, and L.
    """

    def __init__(self, pairs: Sequence[Entry]) -> None:
        self._coefficients: dict[str, _Floats] = {}
        if len(pairs) < FEWEST:
            return
        points = columns_of(pairs, "M", "L", "kappa")
        basis, lam = self._basis(points), _lambda(points)
        for name in ("damping", "approach", "moment"):
            more = np.array([np.subtract(pair[name], pair["close"][name]) for pair in pairs])
            self._coefficients[name] = np.asarray(np.linalg.lstsq(basis, (more.T / lam).T)[0])

    @staticmethod
    def _basis(points: _Floats) -> _Floats:
        _, L, kappa = points.T
        return np.column_stack([np.ones_like(L), np.log(kappa), np.log(kappa) ** 2, L])

    def correction(self, name: str, points: _Floats) -> _Floats:
        """Correction of an answer at every point; 0 if too few points determine it."""
        if name not in self._coefficients:
            return np.zeros(1)
        return np.asarray(((self._basis(points) @ self._coefficients[name]).T * _lambda(points)).T)


def _lambda(points: _Floats) -> _Floats:
    return np.array([MoesPoint(*row).lam for row in points.tolist()])


def _is_near(entry: Entry) -> bool:
    """Whether an entry was solved on the near region."""
    return Domain(*entry["domain"]) == Domain.near()


RECIPE = FilmRecipe()
