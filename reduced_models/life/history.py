"""`BearingHistory`: what a run leaves of the loads of all balls of a bearing, for its rating life."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reduced_models.life.bearing_life import STANDING, TURNING, BallLoads, exponents, power_mean
from reduced_models.life.internal_geometry import InternalGeometry

_Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True)
class BearingHistory:
    """Loads of all balls of a bearing over a run.

    Attributes
    ----------
    name : str
    internals : InternalGeometry
    mean_loads : ndarray, shape (balls, 2, 2)
        Force of every ball at the inner and the outer race, mean over the turns of the shaft with the exponents 3
        and 10/3 [N].
    """

    name: str
    internals: InternalGeometry
    mean_loads: _Floats

    def loads(self, force: _Floats, speed_rpm: _Floats, largest: _Floats, *, rotating: bool = False) -> BallLoads:
        """Loads of the balls for rating life.

        Parameters
        ----------
        force : ndarray, shape (k, n)
            Of the ring over the run, n = 2 or 5 [N], [N m].
        speed_rpm : ndarray, shape (k,)
            Of the shaft, in equal steps of time [rev/min].
        largest : ndarray, shape (2,)
            Largest force of a ball at both races [N].
        rotating : bool
            Whether the load turns with the shaft, or with the outer ring where that turns alone: this race stands
            still against it.
        """
        rings = self.internals.ring_speeds
        powers = exponents(rings, (rings[0] or rings[1]) if rotating else 0.0)
        inner, outer = (self.mean_loads[:, k, int(power == STANDING)] for k, power in enumerate(powers))
        forces = (
            np.hypot(force[:, 0], force[:, 1]),
            np.abs(force[:, 2] if force.shape[1] > 2 else 0.0 * force[:, 0]),
        )
        turning = bool(speed_rpm.any())
        radial, axial = (
            float(np.average(one**TURNING, weights=np.abs(speed_rpm) if turning else None) ** (1.0 / TURNING))
            for one in forces
        )
        return BallLoads(
            speed_rpm=abs(float(np.mean(speed_rpm))),
            radial=radial,
            axial=axial,
            inner=power_mean(inner, powers[0]),
            outer=power_mean(outer, powers[1]),
            largest=(float(largest[0]), float(largest[1])),
        )
