"""Recipe of oil supply: what a layer of oil changes, over M, L, kappa and r; `Supplied` applies it to answers.

r is the layer over what the flooded film lets through. Every contact is solved flooded and under several layers on
one grid and region, so that the change has little of the errors of either.

Smooth variables, per point and r: ln of the central film's share over the curve ``r/(1 + r^g)^(1/g)`` with the g
of the ellipse; ln of the share of h_min/h_c; the changes of approach, over 1 - u, and of the moment, over
itself; ln of the factor on K at each frequency; asinh of the change of C over the flooded C there (or a small
share of that at low frequency, where it is smaller): far below -1 where the oil ahead of the contact comes and
goes in time with it.

Radial functions over M, L and kappa have all of these at every r of the table at once; between these cubics over
asinh(r). Beyond the last r all changes fade like 1/r; below the first the film follows the curve.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact import Domain, Grid, MoesPoint, OilLayer
from ehlcontact.checks import require_instance
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.film_formulas import film_of_layer, layer_sharpness, load_number
from ehlcontact.hertz import radius_ratio
from ehlcontact.jit import plain
from ehlcontact.lubricant import density
from ehlcontact.point import Point, moes_point, scales_of
from ehlcontact.response import NEAR_ZERO
from reduced_models.atlas.conditions import Change, Condition, Rows
from reduced_models.atlas.film import HEAD, LOW, OVERSHOOT, published_films
from reduced_models.atlas.frequency_curve import over_frequency
from reduced_models.atlas.gain_fit import FADED, fitted_gains
from reduced_models.atlas.recipe import (
    Entry,
    Recipe,
    between,
    columns_of,
    entry_of,
    linear_answer,
    overshot,
    sobol,
)
from reduced_models.atlas.surface import shipped
from reduced_models.atlas.table import Box, Interpolation, Table
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]

# Layers over what the flooded film lets through: closest where oil begins to pile up ahead of the contact.
RATIOS = (0.25, 0.5, 0.7, 0.85, 1.0, 1.15, 1.35, 1.7, 2.4, 4.0)
# Dense at the low end, where the oil ahead of the contact has time to come and go.
OMEGAS = (0.0, 0.003, 0.01, 0.025, 0.05, 0.1, 0.2, 0.4, 0.8, 1.4, 2.2, 4.0, 10.0)
# Inlet of the region over the default one, so that the front of the full film lies inside, and for thick layers of
# light contacts; on as many times the intervals.
LONGER, LONGEST, MORE_INTERVALS = 1.5, 2.5, 1.5
# For inlets of at least this width, in semi-axes: the mesh is 0.4 of it at most, half of it in the last.
INTERVALS = ((0.32, 64), (0.215, 96), (0.16, 128), (0.085, 192))
TOLERANCE = 1e-4  # of the linear residuals: C is then within 1e-4 of the flooded C at low frequency, or so
BOX = Box(M=(10.0, 20000.0), L=(4.0, 26.0), kappa=(0.08, 1.0), p_hertz=4.1e9)
SAMPLED = Box(M=(9.5, 21000.0), L=(3.8, 26.5), kappa=(0.077, 1.05), p_hertz=4.2e9)  # with a margin
LIGHTEST, MARGIN = 8.0, 0.9  # load number of the lightest contacts, and of the draws over it

NUMBERS = 4  # changes of central film, h_min/h_c, approach, moment; then K and C over frequency
FAINT = 0.05  # share of the low-frequency C below which changes of C are over that
REFERENCE = 0.05  # frequency of that C, as in the atlas
LOW_OMEGA = 0.01  # where frequencies begin to count by their ratio
BENT = 0.5  # share of the distance between cubic and straight line over r that error bars grow by
SLOWEST_FADE = 1.0  # power of r by which changes fade, at least, where the front lies ahead of the region

# Elements follow C from here on: below, the oil ahead of a wide contact comes and goes with the motion, and C
# falls below zero. Errors count over its largest value.
SLOWEST, FAINT_GAIN = 0.1, 1.0
# Of the growth of the dry approach, what a light film may grow by: slopes of the cubics between loads are up to
# three times those from load to load, and the approach rises between them too.
MOST_GROWN = 0.25
THINNEST = 0.02  # r, below which films are thinner than any that were solved by a factor of ten


@entry_of
def solve_supply(point: MoesPoint) -> dict[str, Any]:
    """Entry of a point under all of `RATIOS`."""
    return solve_layers(point, RATIOS, OMEGAS)


def solve_layers(point: MoesPoint, ratios: tuple[float, ...], Omega: tuple[float, ...]) -> dict[str, Any]:
    """Numbers of a point, flooded and under layers; None for a layer whose film begins ahead of the region."""
    grids = _grids(point)
    flooded = linear_answer(point, grids[0], Omega, NEAR_ZERO, TOLERANCE)
    full = flooded["h_central"] * float(plain(density)(1.0, point.law)[0])
    starved = [_under_layer(point, grids, Omega, OilLayer(H=ratio * full)) for ratio in ratios]
    entry = {"M": point.M, "L": point.L, "kappa": point.kappa, "Omega": list(Omega), "ratios": list(ratios)}
    return entry | {"flooded": flooded, "starved": starved, "n": grids[0].n}


def _grids(point: MoesPoint) -> tuple[Grid, Grid]:
    """Grid of a point, whose inlet must be as wide as the last of `INTERVALS`; and of a longer region."""
    n = next(n for width, n in INTERVALS if point.inlet_width >= width)
    region = Domain.for_point(point)
    long, longest = (replace(region, x_in=times * region.x_in) for times in (LONGER, LONGEST))
    return Grid(n, long), Grid(int(MORE_INTERVALS * n), longest)


def _under_layer(
    point: MoesPoint, grids: tuple[Grid, Grid], Omega: tuple[float, ...], supply: OilLayer
) -> dict[str, Any] | None:
    for grid in grids:
        with suppress(ConvergenceError):
            return linear_answer(point, grid, Omega, NEAR_ZERO, TOLERANCE, supply=supply)
    return None


def changes_of(entry: Entry) -> _Floats | None:
    """Smooth variables of an entry, (m, 4 + 2 k); None where the thinnest layers have no film.

    Layers so thick that the film begins ahead of the region are taken to fade from the last two that do not.
    """
    rows = [
        None if starved is None else _change(entry, starved, r)
        for r, starved in zip(entry["ratios"], entry["starved"], strict=True)
    ]
    known = [row for row in rows if row is not None]
    solved = len(known)
    if solved < len(rows) // 2 or any(row is None for row in rows[:solved]):
        return None
    r = np.array(entry["ratios"])
    for k in range(solved, len(rows)):
        before, last = known[solved - 2], known[solved - 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            power = np.log(before / last) / np.log(r[solved - 1] / r[solved - 2])
        power = np.maximum(np.nan_to_num(power, nan=SLOWEST_FADE, posinf=SLOWEST_FADE), SLOWEST_FADE)
        known.append(last * (r[solved - 1] / r[k]) ** power)
    return np.array(known)


def _change(entry: Entry, starved: Mapping[str, Any], ratio: float) -> _Floats:
    """Smooth variables of one layer."""
    flooded = entry["flooded"]
    share = starved["h_central"] / flooded["h_central"]
    curve = float(share_of_layer(np.array([ratio]), np.array([entry["kappa"]]))[0])
    lobe = starved["h_min"] / flooded["h_min"] / share
    approach = (starved["approach"] - flooded["approach"]) / (1.0 - flooded["approach"])
    moment = starved["moment"] / flooded["moment"] - 1.0
    K = np.log(np.divide(starved["stiffness"], flooded["stiffness"]))
    C = np.array(flooded["damping"])
    unit = np.maximum(C, FAINT * C[OMEGAS.index(REFERENCE)])
    damping = np.arcsinh((starved["damping"] - C) / unit)
    return np.concatenate([[math.log(share / curve), math.log(lobe), approach, moment], K, damping])


def share_of_layer(ratio: _Floats, kappa: _Floats) -> _Floats:
    """Central film over the flooded one by the curve with the g of the ellipse."""
    sharpness = np.array([layer_sharpness(k) for k in np.atleast_1d(kappa).tolist()])
    return np.asarray(film_of_layer(ratio, sharpness))


class SupplyRecipe(Recipe[MoesPoint]):
    """Changes by a layer of oil; places are rows (M, L, kappa, r)."""

    name, title = "supply", "table of oil supply"
    numbers: ClassVar = {"draws": 256, "seed": 31}
    precision = np.float16  # 5e-4 of each change
    # Weights for the smallest errors of points left out: kappa counts for more than of films, the film for less.
    interpolation = Interpolation(weights=(0.4, 0.2, 0.6, 0.25), nearest=10, covered=0.95)
    box = BOX
    solve = staticmethod(solve_supply)

    def sample(self, draws: int, seed: int = 0) -> dict[str, MoesPoint]:
        """Points to solve by name; those of too thin a film or too high a pressure fall away."""
        shares = overshot(sobol(3, draws, seed), OVERSHOOT)
        M, L, kappa = SAMPLED.M, SAMPLED.L, SAMPLED.kappa
        points: dict[str, MoesPoint] = {}
        for i, (u, v, w) in enumerate(shares.tolist()):
            point = MoesPoint(between(M, u), L[0] + (L[1] - L[0]) * v, between(kappa, w))
            light = point.load_number < MARGIN * LIGHTEST
            if not light and point.inlet_width >= INTERVALS[-1][0] and point.p_hertz <= SAMPLED.p_hertz:
                points[f"supply-{i}"] = point
        return points

    def usable(self, entry: Entry) -> bool:
        """Whether the thinnest layers of an entry have films."""
        return changes_of(entry) is not None

    def assemble(self, entries: Sequence[Entry]) -> tuple[_Floats, dict[str, _Floats], dict[str, _Floats]]:
        """Points, layers, frequencies and changes."""
        axes = {"ratios": np.array(RATIOS), "omega": np.array(OMEGAS)}
        changes = np.array([changes_of(entry) for entry in entries])
        return columns_of(entries, "M", "L", "kappa"), axes, {"changes": changes}

    def metadata(self, entries: Sequence[Entry]) -> dict[str, Any]:
        """Narrowest inlets [semi-axes], lightest load number, layers whose film begins ahead of the region."""
        ahead = sum(layer is None for entry in entries for layer in entry["starved"])
        meshes = {str(n): count for n, count in sorted(Counter(entry["n"] for entry in entries).items())}
        return {"narrowest": INTERVALS[-1][0], "lightest": LIGHTEST, "front_ahead": ahead, "meshes": meshes}

    def shapes(self, table: Table) -> dict[str, tuple[int, ...]]:
        """Shape of every axis and column."""
        m, k = table["ratios"].size, table["omega"].size
        return {"ratios": (m,), "omega": (k,), "changes": (len(table.points), m, NUMBERS + 2 * k)}

    def require_metadata(self, table: Table) -> None:
        """Raise any error unless the metadata have what is read from them."""
        _ = table.box, float(table.metadata["narrowest"]), float(table.metadata["lightest"])

    def unit(self, table: Table, points: _Floats) -> _Floats:
        """Published central film."""
        return published_films(points[:, :3])

    def coordinates(self, table: Table, points: _Floats, unit: _Floats) -> tuple[_Floats, ...]:
        """Coordinates of films but for that of light loads, which is 0 at all of these, shape (n, 4)."""
        M, L, kappa = points[:, :3].T
        log_load = np.log(M) + 0.5 * np.log([radius_ratio(k) for k in kappa.tolist()])
        unweighted = np.column_stack([log_load, L ** (2.0 / 3.0), np.log(kappa), np.log(unit)])
        return (unweighted * np.array(table.interpolation.weights),)

    def smooth(self, table: Table, unit: _Floats) -> _Floats:
        """Changes at all r of the table, shape (n, m (4 + 2 k))."""
        return table["changes"].reshape(len(table.points), -1)

    def values(
        self, table: Table, points: _Floats, unit: _Floats, smooth: _Floats, bars: _Floats, **more: Any
    ) -> tuple[_Floats, _Floats]:
        """Changes at rows (M, L, kappa, r) and half widths of their error bars, shape (n, 4 + 2 k)."""
        ratio, nodes = points[:, 3], table["ratios"]
        shape = len(points), nodes.size, -1
        smooth, bars = smooth.reshape(shape), bars.reshape(shape)
        x, place = np.arcsinh(nodes), np.arcsinh(np.clip(ratio, nodes[0], nodes[-1]))
        straight = _linear(x, place)
        rows, line = _between(x, smooth, place), np.einsum("nm,nmq->nq", straight, smooth)
        spread = np.einsum("nm,nmq->nq", straight, bars) + BENT * np.abs(rows - line)
        fade = np.minimum(nodes[-1] / ratio, 1.0)[:, None]
        return rows * fade, spread * fade


RECIPE = SupplyRecipe()


def _between(nodes: _Floats, values: _Floats, place: _Floats) -> _Floats:
    """Modified Akima's cubics, which do not overshoot, through values (n, m, q) at nodes (m,), at places (n,)."""
    cubics = scipy.interpolate.Akima1DInterpolator(nodes, values, axis=1, method="makima").c
    cell = np.clip(np.searchsorted(nodes, place, side="right") - 1, 0, nodes.size - 2)
    c, s = cubics[:, cell, np.arange(place.size)], (place - nodes[cell])[:, None]
    return np.asarray(((c[0] * s + c[1]) * s + c[2]) * s + c[3])


def _linear(nodes: _Floats, place: _Floats) -> _Floats:
    """Weights of the nodes in a straight line between them, shape (n, m)."""
    return np.array([np.interp(place, nodes, unit) for unit in np.eye(nodes.size)]).T


def table_of_supply() -> Table:
    """The table that comes with the library."""
    return shipped("supply").table


def supply_box() -> Box:
    """Ranges of the table."""
    return table_of_supply().box


def require_uniform(supply: OilLayer) -> None:
    """Raise `InputError` unless it is a uniform `OilLayer`."""
    require_instance("supply", supply, OilLayer, "an OilLayer(h) or OilLayer(over_flooded=r)")
    if supply.y is not None:
        raise InputError("supply", "a profile over y", "a uniform layer, where answers come from the atlas")


def lightest_load(moes: MoesPoint) -> float:
    """Load, in units of the point's, from which on the table of supply has contacts of its kappa."""
    table = table_of_supply()
    return max(table.box.M[0], table.metadata["lightest"] / load_number(1.0, moes.kappa)) / moes.M


def heaviest_load(moes: MoesPoint) -> float:
    """Load, in units of the point's, up to which the table of supply has contacts of its L and kappa."""
    box, narrowest = supply_box(), float(table_of_supply().metadata["narrowest"])
    most = min(box.M[1] / moes.M, (box.p_hertz / moes.p_hertz) ** 3)

    def spare(log_load: float) -> float:
        return float(np.log(_loaded(moes, np.exp(log_load)).inlet_width / narrowest))

    low, high = np.log(lightest_load(moes)), np.log(most)
    if low >= high or spare(high) >= 0.0:
        return float(most)
    return float(np.exp(scipy.optimize.brentq(spare, low, high))) if spare(low) > 0.0 else 0.0


def _loaded(moes: MoesPoint, load: float) -> MoesPoint:
    """The point under another load, in units of its own."""
    return replace(moes, M=moes.M * float(load))


class Supplied(Condition):
    """A uniform layer ahead of the contacts at a point: of one thickness, or in flooded isothermal films.

    Loads lighter than those of the table have the change of its lightest at the same r. Heavier ones are refused,
    unless lighter ones are asked for beside them: then they have the change of its heaviest, so that an element
    has all loads that the atlas has.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
        Loads are in units of its load.
    supply : OilLayer

    Raises
    ------
    InputError
        A profile over y; metres at a point without metres; an L or kappa outside the table.
    """

    name, slowest, one_region = "supply", SLOWEST, False

    def __init__(self, point: Point, supply: OilLayer) -> None:
        require_uniform(supply)
        self.moes, self.scales, self.supply = moes_point(point), scales_of(point), supply
        supply.unit(self.moes, self.scales, np.nan)  # which names metres that are missing
        box = supply_box()
        for name in ("L", "kappa"):
            low, high = getattr(box, name)
            if not low <= getattr(self.moes, name) <= high:
                allowed = f"between {low:g} and {high:g}, the box of the table of oil supply"
                raise InputError(name, getattr(self.moes, name), allowed)
        self._heaviest = heaviest_load(self.moes)

    @property
    def speeds(self) -> tuple[float, float]:
        """Lowest and highest speed, over that of the point, at which the table has its contact.

        Raises
        ------
        InputError
            A layer in flooded films, which is other oil at every speed.
        """
        if (given := self.supply.over_flooded) is not None:
            raise InputError("over_flooded", given, "left out: h in m, or H, is the same oil at every speed")
        moes, box, speed = self.moes, supply_box(), -4.0 / 3.0
        most = (lightest_load(moes)) ** speed
        if moes.L == 0.0:
            return (box.M[1] / moes.M) ** speed, most
        slow, fast = ((L / moes.L) ** 4 for L in box.L)

        def spare(log_speed: float) -> float:
            U = float(np.exp(log_speed))
            return heaviest_load(replace(moes, M=moes.M * U**-0.75, L=moes.L * U**0.25)) - 1.0

        low = np.log(max(slow, (box.M[1] / moes.M) ** speed))
        if low < 0.0 and spare(low) < 0.0 <= spare(0.0):
            low = scipy.optimize.brentq(spare, low, 0.0)
        return float(np.exp(low)), min(most, fast)

    def frequencies(self, Omega: _Floats) -> _Floats:
        """Frequencies of the table too, below those of the atlas."""
        slow = table_of_supply()["omega"]
        return np.unique(np.concatenate([Omega, slow[slow < Omega[1]]]))

    def ratio(self, loads: _Floats, h_central: _Floats, isothermal: _Floats) -> _Floats:
        """The layer over what the flooded films [dry approaches of their loads] let through.

        A given r is over the `isothermal` ones: it stands for as much oil where heat leaves thinner films.
        """
        if self.supply.over_flooded is not None:
            return float(self.supply.over_flooded) * (isothermal / h_central)
        squeezed = [float(plain(density)(1.0, _loaded(self.moes, load).law)[0]) for load in loads.tolist()]
        layer = self.supply.unit(self.moes, self.scales, np.nan) * float(self.supply.at(0.0))
        return np.asarray(layer / (loads ** (2.0 / 3.0) * h_central * squeezed))

    def change(self, loads: _Floats, values: _Floats, Omega: _Floats, isothermal: _Floats) -> Change:
        """Change of the flooded `values`, shape (n, 5 + 2 k) with K and C at `Omega`, under `loads`."""
        ratio = self.ratio(loads, values[:, 1], isothermal)
        self._require_inside(loads, ratio)
        surface, k = shipped("supply"), Omega.size
        nodes = surface.table["omega"]
        half = NUMBERS + nodes.size
        M = np.clip(loads, lightest_load(self.moes), self._heaviest) * self.moes.M
        others = (np.full(loads.size, number) for number in (self.moes.L, self.moes.kappa))
        rows, spread = surface.at(np.column_stack([M, *others, ratio]))
        along = over_frequency(nodes, np.minimum(Omega, nodes[-1]), LOW_OMEGA)
        film, lobe, approach, moment = rows[:, :NUMBERS].T
        share = share_of_layer(ratio, np.full(loads.size, self.moes.kappa)) * np.exp(film)
        K, C = np.exp(rows[:, NUMBERS:half] @ along), rows[:, half:] @ along
        unit = np.maximum(values[:, HEAD + k :] / values[:, [LOW]], FAINT)
        b_film, b_lobe, b_approach, b_moment = spread[:, :NUMBERS].T
        b_stiffness = spread[:, NUMBERS:half] @ np.abs(along)
        b_slope = spread[:, half:] @ np.abs(along)
        damping, b_damping = unit * np.sinh(C), unit * np.cosh(C) * b_slope
        low = int(np.searchsorted(Omega, REFERENCE))
        head = [1.0 - approach, share, share * np.exp(lobe), damping[:, low], 1.0 + moment]
        b_head = [b_approach, share * b_film, head[2] * np.hypot(b_film, b_lobe), b_damping[:, low], b_moment]
        head[0] = head[0] * np.minimum(ratio / surface.table["ratios"][0], 1.0)
        return Change(np.column_stack([*head, K, damping]), np.column_stack([*b_head, K * b_stiffness, b_damping]))

    def gains(self, gains: _Floats, low: _Floats, rates: FilterRates, before: Rows, after: Rows) -> _Floats:
        """Gains fitted to answers under the layer, from `SLOWEST` on.

        What `gains` are beside a fit of the flooded film is left as far as damping is: all of it would be more
        than a starved film has.
        """
        fit = fitted_gains(before.Omega, before.stiffness, before.damping, rates, low, FAINT_GAIN)
        followed = after.Omega >= SLOWEST
        C, whole = after.damping[:, followed], before.damping[:, -np.count_nonzero(followed) :]
        left = np.clip(C.sum(axis=1) / whole.sum(axis=1), 0.0, 1.0)[:, None] ** FADED
        K = after.stiffness[:, followed]
        return fitted_gains(after.Omega[followed], K, C, rates, low, FAINT_GAIN) + (gains - fit) * left

    def approaches(self, loads: _Floats, before: Rows, after: Rows) -> _Floats:
        """Approaches under increasing loads, which rise under one layer in m.

        Dry approach less approach is the central film and what the surfaces deflect less than dry ones at their
        centre. Under one layer the film falls with a light load, to the layer at most as that goes to zero, and
        the other part grows at most as it does flooded. What loads lighter than the table's borrow from its
        lightest is off by up to a tenth, more than the approach rises. It is raised by the least that keeps this.
        """
        flooded, approach = before.values, after.values[:, 0]
        if self.supply.over_flooded is not None:
            return approach
        unit = loads ** (2.0 / 3.0)
        film, full = (1.0 - approach) * unit, flooded[:, 1] * unit
        other = np.minimum(np.diff((1.0 - flooded[:, 0]) * unit - full), MOST_GROWN * np.diff(unit))
        may_grow = np.append(0.0, np.cumsum(np.maximum(np.diff(full), 0.0) + other))
        least = np.maximum.accumulate((film - may_grow)[::-1])[::-1] + may_grow
        raised = (least > film) & (loads < lightest_load(self.moes))
        return np.where(raised, 1.0 - least / unit, approach)

    def _require_inside(self, loads: _Floats, ratio: _Floats) -> None:
        if loads.min() > self._heaviest:
            most = self._heaviest * self.moes.M
            allowed = f"at most {most:.4g}, where the table of oil supply ends at these L and kappa"
            raise InputError("M", self.moes.M * float(loads.min()), allowed)
        # of lighter loads, which hardly deform, the thinnest layer is a film, not a dry contact
        thinnest = float(ratio[loads >= lightest_load(self.moes)].min(initial=np.inf))
        if thinnest < THINNEST:
            allowed = (
                f"at least {THINNEST:g} flooded films everywhere (under a layer like that the contact is dry)"
            )
            raise InputError("supply", f"{thinnest:.2g} flooded films", allowed)

    def noted(self, flooded: float) -> dict[str, Any]:
        """r, for which the flooded isothermal central film is needed."""
        isothermal = np.array([flooded])
        return {"over_flooded": float(self.ratio(np.ones(1), isothermal, isothermal)[0])}

    def to_dict(self) -> dict[str, Any]:
        """Its inputs, ready for JSON."""
        return self.supply.to_dict()
