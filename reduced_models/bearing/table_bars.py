"""`TableBars`: half widths of the error bars of a bearing's films, K and C from the tables of the atlas.

Those of films are of the most loaded ball. Those of K and C are of its two contacts in series, whose errors are
added with their signs alike, times what the bearing has of its stiffness:

    dK = (K_2^2 dK_1 + K_1^2 dK_2)/(K_1 + K_2)^2 K_bearing/K_ball,    dC likewise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reduced_models.bearing.race import Race

_Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TableBars:
    """Half widths of error bars.

    Attributes
    ----------
    h_central, h_min : ndarray, shape (2,)
        Of the most loaded ball's films at inner and outer race [m].
    stiffness, damping : ndarray, shape (k, n)
        Of K [N/m] and C [N s/m] of the bearing at the frequencies, in x, y and, with contact angles, z.
    """

    h_central: _Floats
    h_min: _Floats
    stiffness: _Floats
    damping: _Floats


def table_bars(
    races: Sequence[Race], forces: Sequence[float], speed_rpm: float, hz: _Floats, stiffness: _Floats
) -> TableBars:
    """Error bars from both contacts of the most loaded ball.

    Parameters
    ----------
    races : sequence of Race, length 2
        Its inner and outer one, with their oil supply and heat.
    forces : sequence of float, length 2
        On them [N].
    speed_rpm : float
        Of the shaft [rev/min].
    hz : ndarray, shape (k,)
    stiffness : ndarray, shape (k, n)
        Of the bearing [N/m].
    """
    answers = [race.answer(force, speed_rpm) for race, force in zip(races, forces, strict=True)]
    films = [one.error_bars for one in answers]
    Z = [one.impedance(hz=hz) for one in answers]
    K = np.array([one.stiffness for one in Z])
    share, ball = np.square(K[::-1] / K.sum(axis=0)), np.prod(K, axis=0) / K.sum(axis=0)
    series = {name: share * [one.error_bars[name] for one in Z] for name in ("stiffness", "damping")}
    small = {name: (one.sum(axis=0) / ball)[:, None] * stiffness for name, one in series.items()}
    central, smallest = (np.array([one[name] for one in films]) for name in ("h_central", "h_min"))
    return TableBars(central, smallest, **small)
