"""Search for the settings of an atlas: weights of the coordinates, rates of the filters, slopes for other oils.

    python tests/benchmarks/tune_atlas.py --weights --lobes --rates --oil [--atlas FILE]

Weights of the coordinates and rates of the filters are varied from those of the atlas to where its own points are
interpolated best, each from the others, and fitted best. What another oil changes is solved for anew. It prints
and changes nothing: what a build uses stands in `reduced_models.atlas.film` and goes into the file it makes.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import log
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from ehlcontact import MoesPoint
from ehlcontact.lubricant.oil_laws import secant_over_slope
from ehlcontact.store import read
from reduced_models.atlas.film import HEAD, LOBE, OIL, RECIPE, THICKEST, respond
from reduced_models.atlas.gain_fit import gain_equations, smooth_gains
from reduced_models.atlas.mesh import impedance_grid
from reduced_models.atlas.surface import left_out_errors, shipped_file
from reduced_models.atlas.table import Table
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]

FIRST_MOVE = 0.3  # of the logarithms, in the search
SETTLED = 2e-3  # of the logarithms: a thousandth more or less of a weight changes nothing that counts
# Light, middle and heavy load at which other oils are solved for.
OIL_POINTS = (MoesPoint(20.0, 5.0, 0.5), MoesPoint(200.0, 10.0, 0.5), MoesPoint(2900.0, 19.0, 0.11))
OIL_SHIFTS = (0.5, 2.0)  # factors on alpha, and on eta0


class Found(NamedTuple):
    """Settings of the atlas and the best ones found, each with its error."""

    used: tuple[float, ...]
    error: float
    best: tuple[float, ...]
    least: float


def weights_error(table: Table, weights: Sequence[float]) -> float:
    """Error of points that are left out: its rms for each smooth variable, and of these the geometric mean.

    So every answer counts alike, whatever its scale: else the asinh of a damping near 0 would outweigh all.
    """
    table = _with(table, weights=weights)
    unit = RECIPE.unit(table, table.points)
    x, _ = RECIPE.coordinates(table, table.points, unit)
    squares = np.mean(left_out_errors(x, RECIPE.smooth(table, unit)) ** 2, axis=0)
    # C at the reference frequency is its own measure: no error but rounding; Hm/Hc has its own weights
    own = HEAD + table["omega"].size + table.interpolation.reference
    squares = np.delete(squares, [LOBE, own])
    return float(np.exp(0.5 * np.mean(np.log(squares))))


def best_weights(table: Table, most: int = 300) -> Found:
    """Weights of least error; the first is held, since only their ratios count."""
    first, *others = table.interpolation.weights
    return _least(lambda rest: weights_error(table, (first, *rest)), others, most, (first,))


def lobe_error(table: Table, weights: Sequence[float]) -> float:
    """Error of points that are left out: rms of ln(Hm/Hc)."""
    table = _with(table, lobe_weights=weights)
    unit = RECIPE.unit(table, table.points)
    _, x = RECIPE.coordinates(table, table.points, unit)
    return float(np.sqrt(np.mean(left_out_errors(x, RECIPE.smooth(table, unit)[:, [LOBE]]) ** 2)))


def _with(table: Table, **settings: Sequence[float]) -> Table:
    """The table with other settings of its interpolation."""
    interpolation = table.metadata["interpolation"] | settings
    return replace(table, metadata=table.metadata | {"interpolation": interpolation})


def rates_of(table: Table) -> FilterRates:
    """Rates of the filters of a table."""
    return FilterRates(**table.metadata["rates"])


def best_lobe_weights(table: Table, most: int = 300) -> Found:
    """Weights for Hm/Hc of least error; the first is held, since only their ratios count."""
    first, *others = table.interpolation.lobe_weights
    return _least(lambda rest: lobe_error(table, (first, *rest)), others, most, (first,))


def rates_error(table: Table, rates: FilterRates) -> float:
    """Rms misfit of the gains at each point, 5 % of C or 1 % of K counting as 1; the mean over the points."""
    misfits = []
    for K, C in zip(table["stiffness"], table["damping"], strict=True):
        low = C[table.interpolation.reference]
        rows, target = gain_equations(table["omega"], K, C, rates, low)
        gains = smooth_gains(table["omega"], K, C, rates, low)
        misfits.append(np.sqrt(np.mean((rows @ gains - target)[: -gains.size] ** 2)))
    return float(np.mean(misfits))


def best_rates(table: Table, most: int = 300) -> Found:
    """Rates of lags, inlet and fast filter of least misfit, for the lags of the atlas."""
    rates = rates_of(table)
    start = rates.lag_rate, rates.inlet_rate, rates.fast_rate
    return _least(lambda found: rates_error(table, FilterRates(rates.lags, *found)), start, most)


def oil_slopes(points: Sequence[MoesPoint] = OIL_POINTS) -> dict[str, tuple[float, float]]:
    """Largest error of ln of films, of K, of C and of the moment per unit of ln alpha, and per unit of ln eta0.

    The error is against the oil of the atlas at the L at which another oil is read (`OtherOil`). That of K is over
    the film 1 - u, up to `THICKEST`. C counts where it is above a tenth of its largest value; its bar has the
    slope twice, in C over the low-frequency damping and in that: a slope of 0.13 covers a change of 0.18.
    """
    slopes = {name: [0.0, 0.0] for name in ("film", "stiffness", "damping", "moment")}
    for point in points:
        for i, name in enumerate(("alpha", "eta0")):
            for factor in OIL_SHIFTS:
                oil = replace(point, **{name: factor * getattr(point, name)})
                other, read = answers(oil), answers(read_at(oil, point))
                for kind, (value, weight) in read.items():
                    change = np.abs(np.log(other[kind][0] / value))[weight > 0.0] / weight[weight > 0.0]
                    slopes[kind][i] = max(slopes[kind][i], float(change.max()) / abs(log(factor)))
    return {name: (first, second) for name, (first, second) in slopes.items()}


def read_at(oil: MoesPoint, own: MoesPoint) -> MoesPoint:
    """`own`, a point in the oil of the atlas, at the L at which the atlas is read for that of `oil`."""
    secants = [secant_over_slope(one.alpha, one.eta0, OIL.secant) for one in (oil, own)]
    return replace(own, L=own.L * secants[0] / secants[1])


def answers(point: MoesPoint) -> dict[str, tuple[_Floats, _Floats]]:
    """Films, K, C and moment of a point solved, each with what its changes are divided by; 0 leaves one out."""
    found = respond(point, impedance_grid(point))
    film = np.array([1.0 - found["approach"], found["h_central"], found["h_min"]])
    K, C = np.array(found["stiffness"]), np.array(found["damping"])
    return {
        "film": (film, np.ones(3)),
        "stiffness": (K, np.full(K.size, min(film[0], THICKEST))),
        "damping": (C, (C > 0.1 * C.max()).astype(float)),
        "moment": (np.array([found["moment"]]), np.ones(1)),
    }


def _least(
    error: Callable[[tuple[float, ...]], float],
    start: Sequence[float],
    most: int,
    held: tuple[float, ...] = (),
) -> Found:
    """Search by Nelder and Mead in the logarithms, with at most so many evaluations."""
    origin = np.log(start)
    found = minimize(
        lambda x: error(tuple(np.exp(x))),
        origin,
        method="Nelder-Mead",
        options={
            "initial_simplex": origin + FIRST_MOVE * np.vstack([np.zeros(origin.size), np.eye(origin.size)]),
            "xatol": SETTLED,
            "fatol": 1e-6,
            "maxfev": most,
        },
    )
    best = tuple(np.exp(found.x).tolist())
    return Found((*held, *start), error(tuple(start)), (*held, *best), float(found.fun))


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Settings of an atlas.")
    for option in ("--weights", "--lobes", "--rates", "--oil"):
        parser.add_argument(option, action="store_true")
    parser.add_argument("--atlas", type=Path, default=shipped_file("film"))
    asked = parser.parse_args(arguments)
    table = read(asked.atlas, Table)
    for name, search in (("weights", best_weights), ("lobes", best_lobe_weights), ("rates", best_rates)):
        if getattr(asked, name):
            found = search(table)
            sys.stdout.write(f"{name}: {_row(found.used)} error {found.error:.4g}\n")
            sys.stdout.write(f"{'best':>{len(name)}}: {_row(found.best)} error {found.least:.4g}\n")
    if asked.oil:
        for kind, slopes in oil_slopes().items():
            sys.stdout.write(f"{kind}: {_row(slopes)} (in the atlas {_row(table.metadata['oil'][kind])})\n")


def _row(values: Sequence[float]) -> str:
    return " ".join(f"{value:.4g}" for value in values)


if __name__ == "__main__":
    main()
