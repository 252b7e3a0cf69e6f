"""Wide-range element from solves: steady films over the load, impedances at some loads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact import Grid, impedance, solve_steady
from ehlcontact.checks import as_column
from ehlcontact.checks.frequency import by_name
from ehlcontact.checks.parts import ANY, LARGEST_LOAD
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.origin import source_of
from ehlcontact.point import POINT, OperatingPoint, Point, moes_point, require_solvable
from ehlcontact.results import Response
from reduced_models.elements.film_contact import FilmContact
from reduced_models.elements.film_response import FilterRates, fit_gains, inlet_saturation_of
from reduced_models.fitting.memory_fit import OMEGAS, RATE_STARTS, SEARCH, SEARCH_LIMITS, TRANSIT_TIME

_Floats = NDArray[np.float64]

# Loads, in units of the reference load, of the steady films that give the static curve, about evenly on the
# logarithm; and of the impedances that give the gains.
LOADS = (0.005, 0.01, 0.02, 0.04, 0.08, 0.15, 0.3, 0.6, 1.0, 1.7, 3.0)
MEMORY_LOADS = (0.03, 0.1, 0.3, 1.0, 2.0)


def wide_range_contact(
    loads: ArrayLike,
    approach: ArrayLike,
    gain_loads: ArrayLike,
    responses: Sequence[Response],
    *,
    lags: int = 12,
    memory: FilmContact | None = None,
    source: dict[str, Any] | None = None,
) -> FilmContact:
    """Element from tables, every row in the units of its own load, as solves at that load give them.

    Parameters
    ----------
    loads : array_like, shape (n,)
        In units of the reference load.
    approach : array_like, shape (n,)
        Static approach under each, in the dry approach of that load.
    gain_loads : array_like, shape (k,)
        Loads of the impedances.
    responses : sequence of k Response
        Impedances, dimensionless: in the units of their loads.
    lags : int
        Length of the chain, where `memory` does not set it.
    memory : FilmContact, optional
        Element fitted at the reference load, whose rates and inlet saturation are taken. Without it the rates are
        fitted to all impedances together, and the saturation is that of `inlet_saturation_of`.
    source : dict, optional
        Kept in the file.

    Raises
    ------
    InputError
        Tables that make no contact.
    """
    at, places = (
        as_column("loads", loads, least=2, increasing=True),
        as_column("gain_loads", gain_loads, increasing=True),
    )
    if len(responses) != places.size:
        raise InputError("number of responses", len(responses), f"one per load of gain_loads, {places.size}")
    u = np.asarray(approach, float) * at ** (2.0 / 3.0)
    if memory is not None:
        rates = memory.rates
    else:
        rates = _common_rates(responses, lags)
    gains = [fit_gains(rates, r.omega, r.stiffness, r.damping, _static(r)).gains.tolist() for r in responses]
    saturation = inlet_saturation_of(at, u, places, gains) if memory is None else memory.inlet_saturation
    bands = [(float(np.min(r.omega)), float(np.max(r.omega))) for r in responses]
    return FilmContact.wide(
        loads=at,
        approach=u,
        gain_loads=places,
        gains=gains,
        inlet_saturation=saturation,
        **rates.coefficients,
        omega_range=(min(low for low, _ in bands), max(high for _, high in bands)),
        source=source,
    )


@takes(point=POINT, loads=LARGEST_LOAD, memory_loads=LARGEST_LOAD, Omega=ANY)
@by_name(2)
def wide_range_from_solves(
    point: Point,
    loads: Sequence[float] = LOADS,
    *,
    memory_loads: Sequence[float] = MEMORY_LOADS,
    Omega: Sequence[float] = OMEGAS,
    memory: FilmContact | None = None,
    lags: int = 12,
    n: int = 128,
) -> FilmContact:
    """Solve at M times each load and build the element; the domain of every solve is that of its own load.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
        The reference: its load is 1. The element is in its units.
    loads, memory_loads : sequence of float
        Loads of the steady solves and of the impedances, increasing, in units of the reference load.
    Omega : sequence of float
        Dimensionless frequencies of the impedances, in the time of each load.
    memory, lags
        As for `wide_range_contact`.
    n : int
        Intervals along X.

    Raises
    ------
    InputError
        Loads that are not increasing and > 0, or that the solvers are not made for; tables that make no contact.
    ConvergenceError
        A solve did not converge.
    """
    at, places = (
        as_column("loads", loads, least=2, increasing=True),
        as_column("memory_loads", memory_loads, increasing=True),
    )
    for name, values in (("loads[0]", at), ("memory_loads[0]", places)):
        if values[0] <= 0.0:
            raise InputError(name, float(values[0]), "> 0")
    moes = moes_point(point)
    for f in sorted({*at.tolist(), *places.tolist()}):  # all of them before the first solve
        require_solvable(replace(moes, M=moes.M * f))
    steady = [solve_steady(replace(moes, M=moes.M * f), grid=Grid(n=n)) for f in at.tolist()]
    responses = [impedance(replace(moes, M=moes.M * f), Omega=Omega, grid=Grid(n=n)) for f in places.tolist()]
    approach, domains = [s.approach for s in steady], [list(s.domain.as_tuple()) for s in steady]
    source = source_of(point, n, domains)
    found = wide_range_contact(at, approach, places, responses, lags=lags, memory=memory, source=source)
    return found.to_si(point.scales) if isinstance(point, OperatingPoint) else found


def _static(response: Response) -> float:
    """Tangent at rest: K at the lowest frequency."""
    return float(response.stiffness[np.argmin(response.omega)])


def _common_rates(responses: Sequence[Response], lags: int) -> FilterRates:
    """Rates that serve all impedances best, each in its own time."""

    def rates(p: _Floats) -> FilterRates:
        return FilterRates(lags, *(float(value) for value in np.exp(p)))

    def residuals(p: _Floats) -> _Floats:
        fits = [fit_gains(rates(p), r.omega, r.stiffness, r.damping, _static(r)) for r in responses]
        return np.concatenate([fit.residuals for fit in fits])

    lower, upper = np.log(np.array(SEARCH_LIMITS[:3])).T
    solutions = [
        scipy.optimize.least_squares(
            residuals, np.log([lags / TRANSIT_TIME, *start]), bounds=(lower, upper), **SEARCH
        )
        for start in RATE_STARTS
    ]
    return rates(min(solutions, key=lambda solution: solution.cost).x)
