"""Contact elements from answers of the atlas at one or several loads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from reduced_models.atlas.frequency_curve import FrequencyCurve
from reduced_models.elements.film_contact import FilmContact, units_of
from reduced_models.elements.film_curve import approach_under, film_and_exponent
from reduced_models.elements.film_law import films
from reduced_models.elements.film_response import FilterRates, inlet_saturation_of
from reduced_models.elements.spring import SpringContact
from reduced_models.elements.validity import MARGIN, Band

_Floats = NDArray[np.float64]

LOAD_BAND = (0.9, 1.1)  # of the elements that stand for one load
LEAST_APPROACH = 0.2  # a cubic without a constant term needs some deformation
PASSIVE_MARGIN = 1.001
LEAST_SATURATION = 1e-6  # below, no motion that there is makes a film
ADDED_UP = (
    0.005  # film that errors of the tangents, up to .7 % by their bars, add up to over a decade or two of load
)
APART = 1.2  # ratio below which a load is left out beside the lightest or the heaviest


@dataclass(frozen=True)
class Loads:
    """Data of an element: answers at one or several loads, each in the units of its own load."""

    loads: _Floats  # (n,) in units of the reference load
    approach: _Floats  # (n,)
    tangent: _Floats  # (n,) static
    gains: _Floats  # (n, 3 + lags)
    rates: FilterRates
    lowest_omega: float
    highest_omega: float
    fit: Mapping[str, Any]
    source: Mapping[str, Any]


def passive_gains(rates: FilterRates, gains: _Floats) -> _Floats:
    """Rows of gains, the viscous one raised where the row would feed energy back."""
    rows = gains.copy()
    for row in rows:
        if not rates.passive(row):
            row[0] -= PASSIVE_MARGIN * rates.least_dissipation(row)
    return rows


def approaches_in_one_region(loads: _Floats, approach: _Floats, tangent: _Floats) -> _Floats:
    """Approaches of one contact whose oil reaches as far under all `loads` as under load 1, each in its own unit.

    The region of every answer is in semi-axes of its own load. Tangents depend less on it than approaches do, so
    the film is integrated from them, from that of load 1 on. A film below what their errors add up to hardly
    depends on the region, and stays that of the answers.
    """
    x, unit = np.log(loads), loads ** (2.0 / 3.0)
    own, reference = unit * (1.0 - approach), 1.0 - approach[np.argmin(np.abs(x))]
    rise = scipy.interpolate.PchipInterpolator(x, unit * (2.0 / 3.0 - 1.0 / tangent)).antiderivative()
    film = reference + rise(x) - rise(0.0)
    return np.asarray(1.0 - (own + (film - own) / (1.0 + (ADDED_UP / reference) ** 2)) / unit)


def memory_element(at: Loads, scales: Scales | None) -> FilmContact:
    """Film-memory element about one load; film and its slope over the load follow from approach and tangent."""
    film, exponent = film_and_exponent(float(at.approach[0]), float(at.tangent[0]))
    low, high = (approach_under(load, film, exponent) for load in LOAD_BAND)
    force, length, time = units_of(scales)
    return FilmContact.memory(
        film=film,
        exponent=exponent,
        inlet_saturation=0.0,
        **at.rates.coefficients,
        gains=at.gains[0],
        low=low * length,
        high=high * length,
        load_range=(LOAD_BAND[0] * force, LOAD_BAND[1] * force),
        omega_range=(at.lowest_omega / time, at.highest_omega / time),
        units="dimensionless" if scales is None else "SI",
        scales=scales,
        fit=at.fit,
        source=at.source,
    )


def wide_element(at: Loads, scales: Scales | None, *, saturating: bool = True) -> FilmContact:
    """Wide-range element for all loads at one speed; without `saturating` its inlet does not saturate."""
    approach = at.approach * at.loads ** (2.0 / 3.0)
    saturation = inlet_saturation_of(at.loads, approach, at.loads, at.gains)
    _, length, time = units_of(scales)
    return FilmContact.wide(
        loads=at.loads,
        approach=approach,
        gain_loads=at.loads,
        gains=at.gains,
        inlet_saturation=saturation if saturating else 0.0,
        **at.rates.coefficients,
        # beyond, closing makes more film than the static one; a starved contact hardly makes any
        rate=length / time / saturation if saturation > LEAST_SATURATION else None,
        omega_range=(at.lowest_omega / time, at.highest_omega / time),
        units="dimensionless" if scales is None else "SI",
        scales=scales,
        fit=at.fit,
        source=at.source,
    )


def speed_element(
    speeds: _Floats, rows: Sequence[FilmContact], omega: Band | None, scales: Scales | None
) -> FilmContact:
    """Element over speed from dimensionless ones of one reference load at `speeds` over that of the point.

    All rows get the loads of the lightest and the heaviest: beyond its own, the curve of a row goes on as that of
    its element, and its gains stay.
    """
    lightest, heaviest = min(row.loads[0] for row in rows), max(row.loads[-1] for row in rows)
    nodes = np.unique([load for row in rows for load in row.loads[1:-1]])
    nodes = nodes[(nodes > APART * lightest) & (nodes < heaviest / APART)]
    loads = np.concatenate([[lightest], nodes, [heaviest]])
    x, h, slope = np.log(loads), np.empty(loads.size), np.empty(loads.size)
    approach = []
    for row in rows:
        films(row.law, x, h, slope)
        approach.append(loads ** (2.0 / 3.0) - h)
    reference = rows[int(np.argmin(np.abs(np.log(speeds))))]
    _, length, time = units_of(scales)
    return FilmContact.over_speed(
        speeds=speeds,
        loads=loads,
        approach=approach,
        gain_loads=loads,
        gains=[row.gains_at(x).T for row in rows],
        inlet_saturation=[row.inlet_saturation for row in rows],
        **reference.rates.coefficients,
        rate=None if reference.rate is None else reference.rate * length / time,
        omega_range=None if omega is None else (omega[0] / time, omega[1] / time),
        units="dimensionless" if scales is None else "SI",
        scales=scales,
        fit=reference.fit,
        source=reference.source,
    )


def damper_band(Omega: _Floats, damping: FrequencyCurve, w: float) -> Band:
    """The frequencies about `w`, from the first to the last of `Omega`, at which C is C(w) within a twentieth."""
    places = np.unique(np.concatenate([*(np.linspace(a, b, 65) for a, b in pairwise(Omega.tolist())), [w]]))
    C, at = damping.at(places), int(np.searchsorted(places, w))
    off = np.flatnonzero(np.abs(C - C[at]) > MARGIN * abs(C[at]))
    low, high = off[off < at], off[off > at]
    return (
        float(places[low[-1] + 1] if low.size else places[0]),
        float(places[high[0] - 1] if high.size else places[-1]),
    )


def cubic_element(
    approach: float, stiffness: float, damping: float, band: Band, source: Mapping[str, Any]
) -> SpringContact:
    """The paper's viscous cubic, for vibrations of one band: load 1, tangent and curvature at its approach.

    The curvature is that of a dry contact on its film, F = (1 + 2/3 K (u - u_0))^(3/2), hence F'' = K^2/3.

    Raises
    ------
    InputError
        So light a load that a cubic without a constant term does not describe it.
    """
    u = approach
    if u < LEAST_APPROACH:
        raise InputError("model", "cubic", f"memory or wide where the film leaves an approach of {u:.3g}")
    powers = np.array([[u, u**2, u**3], [1.0, 2.0 * u, 3.0 * u**2], [0.0, 2.0, 6.0 * u]])
    k1, k2, k3 = np.linalg.solve(powers, [1.0, stiffness, stiffness**2 / 3.0]).tolist()
    low, high = (u + 1.5 / stiffness * (load ** (2.0 / 3.0) - 1.0) for load in LOAD_BAND)
    return SpringContact.cubic(
        K1=k1,
        K2=k2,
        K3=k3,
        C1=max(damping, 0.0),
        low=low,
        high=high,
        load_range=LOAD_BAND,
        omega_range=band,
        source=source,
    )
