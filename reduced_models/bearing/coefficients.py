"""`BearingCoefficients`: stiffness and damping over frequency, by `reduced_models.bearing.linear_balls`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.quantities import DAMPING, FORCE, FREQUENCY, HERTZ, LENGTH, RADIAN, SPEED, STIFFNESS
from ehlcontact.results.frequency import FrequencyResponse
from ehlcontact.results.table import Display
from ehlcontact.summary import span
from reduced_models.bearing.equilibrium import RingEquilibrium

_Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BearingCoefficients(FrequencyResponse):
    """Matrices of a small vibration of the ring, in the order x, y.

    Attributes
    ----------
    load : ndarray, shape (2,)
        Force on the ring [N].
    speed_rpm : float
        Of the shaft.
    cage_angle : float or None
        Of the first ball [rad]; None: means over a ball passage.
    omega : ndarray, shape (k,)
        Angular frequencies [rad/s]; ``hz`` has them in Hz.
    stiffness, damping : ndarray, shape (k, 2, 2)
        K [N/m] and C [N s/m].
    displacement : ndarray, shape (2,)
        Of the ring [m].
    swing : ndarray, shape (2,)
        How far the ring goes up and down while a ball passes slowly [m]; 0 at a given angle of the cage.
    """

    load: Annotated[_Floats, FORCE.over("axis")]
    speed_rpm: Annotated[float, SPEED]
    cage_angle: Annotated[float | None, RADIAN]
    omega: Annotated[_Floats, FREQUENCY.over("hz")]
    stiffness: Annotated[_Floats, STIFFNESS.over("hz axis by")]
    damping: Annotated[_Floats, DAMPING.over("hz axis by")]
    displacement: Annotated[_Floats, LENGTH.over("axis")]
    swing: Annotated[_Floats, LENGTH.over("axis")]

    DISPLAY: ClassVar[Display] = Display(
        rows="hz", panels=("stiffness", "damping"), labels={"axis": ("x", "y"), "by": ("x", "y")}, logs="x"
    )

    def _summary_lines(self) -> list[str]:
        x, y = self.load.tolist()
        K, C = self.stiffness, self.damping
        return [
            f"load ({x:.4g}, {y:.4g}) N at {self.speed_rpm:.5g} rev/min, {span(self.hz, 1.0, 'Hz')}",
            f"K_xx {span(K[:, 0, 0], 1e-6, 'N/µm')}, K_yy {span(K[:, 1, 1], 1e-6, 'N/µm')}",
            f"C_xx {span(C[:, 0, 0], 1.0, 'N s/m')}, C_yy {span(C[:, 1, 1], 1.0, 'N s/m')}",
            "means over a ball passage" if self.cage_angle is None else f"cage at {self.cage_angle:.4g} rad",
        ]

    @property
    def hz(self) -> Annotated[_Floats, HERTZ.over("hz")]:
        """The frequencies [Hz]."""
        return np.asarray(self.omega / (2.0 * np.pi))

    @classmethod
    def of(
        cls,
        load: _Floats,
        speed_rpm: float,
        cage_angle: float | None,
        omega: _Floats,
        matrices: tuple[_Floats, _Floats],
        standings: Sequence[RingEquilibrium],
    ) -> BearingCoefficients:
        """From the mean `matrices` K and C, shape (k, 2, 2), and the positions that they are the mean of."""
        places = np.array([standing.displacement for standing in standings])
        return cls(load, speed_rpm, cage_angle, omega, *matrices, places.mean(axis=0), np.ptp(places, axis=0))
