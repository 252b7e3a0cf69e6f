"""Tables of heights for runs of bearings in oil: those of `height_tables`, filtered by the film.

A table has the heights that dry contacts meet, over the angle on a track, in columns of one semi-axis a, so of one
load. Each column is a sum of waves around the track. A wave with k radians per semi-axis is multiplied by what the
film leaves of it, the filter G/Z of the film over that of the dry contact (`atlas.waves.films_over_dry`),
at the load of the column. G/Z is for waves met as exp(i Omega T), so for contacts that move towards larger angles,
as on the outer race and on balls. On the inner race they move towards smaller ones, where its complex conjugate
holds. Where the outer ring turns, or the inner one backward, it is the other way round.

The filter is that of films at one speed of the shaft. Where the speed changes, films at that speed are the mean of
those at the lowest and the highest one. Loads below the table of filters have the filter of its lightest load.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from reduced_models.atlas.waves import films_over_dry, filter_box
from reduced_models.bearing.contact_heights import TABLE
from reduced_models.bearing.height_tables import LOADS, track_radius
from reduced_models.bearing.race import RACES, Race
from reduced_models.elements.film_speed import FILM_GROWTH

if TYPE_CHECKING:
    from reduced_models.bearing.ball_bearing import BallBearing

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]


def heights_in_runs(bearing: BallBearing, speeds_rpm: Sequence[float], backward: bool = False) -> _Floats:
    """All features of a bearing as the array of `contact_heights`, with films of runs at these speeds [rev/min].

    The shaft turns forward or `backward`.

    Those of a dry bearing, and of one without features, are the heights in equilibria.
    """
    if bearing.oil is None or not bearing.features:
        return bearing.tables.heights
    speed = mean_film_speed(min(speeds_rpm), max(speeds_rpm)) * (-1.0 if backward else 1.0)
    found = bearing.tables.heights_in_films
    if speed not in found:
        found[speed] = _with_films(bearing, speed)
    return found[speed]


def mean_film_speed(lowest: float, highest: float) -> float:
    """Speed whose films are the mean of those at two speeds; films grow as `FILM_GROWTH` has it."""
    if lowest == highest:
        return lowest
    return float((0.5 * (lowest**FILM_GROWTH + highest**FILM_GROWTH)) ** (1.0 / FILM_GROWTH))


def _with_films(bearing: BallBearing, speed_rpm: float) -> _Floats:
    found = bearing.tables.heights.copy()
    places, way = found.shape[1] - 1, bearing.ring_speeds.sense * speed_rpm
    tables = found[0, : 1 + bearing.balls, TABLE : TABLE + len(RACES)].astype(int)
    for row, column in np.argwhere(tables).tolist():
        table, name = found[tables[row, column]], RACES[column]
        radius = track_radius(bearing, name) if row == 0 else 0.5 * bearing.ball_diameter
        around = np.arange(places // 2 + 1) / radius
        filters = _filters(bearing.race(name), abs(speed_rpm), table[places, 0], around)
        backwards = (row == 0 and name == "inner") == (way > 0.0)
        waves = np.fft.rfft(table[:places], axis=0) * (filters.conj() if backwards else filters)
        table[:places] = np.fft.irfft(waves, places, axis=0)
    return found


def _filters(race: Race, speed_rpm: float, columns: float, waves: _Floats) -> _Complex:
    """Of waves [rad/m] under the loads of all columns, which are numbered `columns` per root of compression."""
    unit = race.point(1.0, speed_rpm)
    lightest = filter_box().M[0] / unit.moes.M
    load = np.maximum(race.kn * (np.arange(LOADS) / columns) ** 3, lightest)
    rows = np.column_stack([unit.moes.M * load, np.full((LOADS, 2), (unit.moes.L, unit.moes.kappa))])
    return films_over_dry(rows, waves[:, None] * unit.scales.a * np.cbrt(load))
