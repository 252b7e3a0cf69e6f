"""Balls and films of a bearing in continuous time: rates of their states, for any motion, by the C core.

The equations are at ``bearing_rates`` in ``bearing.h``. The states are, in this order,

- the angle of the first ball in its cage [rad];
- of every ball its place from its origin, along the line from the outer groove centre to there, and across it
  where contact angles vary [m]; with inertia their rates [m/s]; of a dry ball without inertia nothing. Then inlet,
  fast and chain filters of the films at its inner and its outer race [m];
- filters of the losses of rings and fits, in the directions of the ring each [N], [N m].
"""

from __future__ import annotations

from ctypes import c_double, c_int
from functools import partial
from math import nan

import numpy as np
from numpy.typing import NDArray

from reduced_models.bearing.ball import Balls
from reduced_models.bearing.core_bearing import (
    BALL_OUTPUTS,
    RING_MOTION,
    CoreBearing,
    pointer,
    reason,
)

_Floats = NDArray[np.float64]
_Record = NDArray[np.void]


class BearingRates:
    """A bearing in continuous time.

    Parameters
    ----------
    balls : Balls
    directions : tuple of str
        Of `freedoms.FIVE`, the n in which the ring moves.
    origins : ndarray, shape (balls,)
        Records of `core_bearing.ORIGIN`, from which the places of the balls are counted.
    cage_held : bool
        Whether the cage stands still.
    """

    def __init__(
        self, balls: Balls, directions: tuple[str, ...], origins: _Record, cage_held: bool = False
    ) -> None:
        self._core = core = CoreBearing(balls, directions)
        core.count_from(origins)
        core.structure.cage_held = cage_held
        self._state, self._work = core.start(), core.work()
        self.size = int(core.library.bearing_states(core.address))
        n = len(directions)
        self._place, self._pressed = np.zeros((2, n))
        self._motion, self._outputs = np.zeros(1, RING_MOTION), np.zeros(balls.number, BALL_OUTPUTS)
        self._states, self._rates = np.zeros((2, self.size, 2))  # values and, all 0, derivatives
        self._force = np.zeros((n, 2))
        own = core.address, pointer(self._state), pointer(self._work)
        self._rest = partial(core.library.bearing_rest_at, *own)
        arrays = map(pointer, (self._states, self._rates, self._force, self._outputs))
        self._evaluate = partial(core.library.bearing_rates, *own, pointer(self._motion), c_int(0), *arrays)

    def rest(self, omega: float, angle: float, q: _Floats) -> _Floats:
        """States with all balls at rest, the ring at `q` and the first ball at `angle` [rad].

        Films are those of the speed `omega` of the shaft [rad/s]. Not numbers where a ball finds no balance.
        """
        self._place[:] = q
        states = np.zeros(self.size)
        why = self._rest(c_double(omega), c_double(angle), pointer(self._place), pointer(self._pressed))
        if reason(why) is not None:
            return np.full(self.size, nan)
        self._core.library.bearing_states_of_step(self._core.address, pointer(self._state), pointer(states))
        return states

    def at(self, omega: float, states: _Floats, q: _Floats, v: _Floats) -> tuple[_Floats, _Floats]:
        """Rates of the states; force of the ring at `q`, moving at `v`, on the balls, shape (n,) [N], [N m].

        Not numbers where a ball finds no balance.
        """
        n = q.size
        self._states[:, 0] = states
        motion = self._motion[0]
        motion["q"][:n, 0], motion["v"][:n, 0], motion["omega"][0] = q, v, omega
        if reason(self._evaluate()) is not None:
            return np.full(self.size, nan), np.full(n, nan)
        return self._rates[:, 0].copy(), self._force[:, 0].copy()
