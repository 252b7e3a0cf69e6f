"""Stiffness and damping of a bearing over frequency, film memory included (`reduced_models.bearing.impedance`)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.summary import Summary, span
from reduced_models.bearing.equilibrium import RingEquilibrium

_Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BearingCoefficients(Summary, Tabled):
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
        Angular frequencies [rad/s].
    stiffness, damping : ndarray, shape (k, 2, 2)
        K [N/m] and C [N s/m].
    displacement : ndarray, shape (2,)
        Of the ring [m].
    swing : ndarray, shape (2,)
        How far the ring goes up and down while a ball passes slowly [m]; 0 at a given angle of the cage.
    """

    load: _Floats
    speed_rpm: float
    cage_angle: float | None
    omega: _Floats
    stiffness: _Floats
    damping: _Floats
    displacement: _Floats
    swing: _Floats

    LAYOUT: ClassVar[Layout] = Layout(
        rows="hz",
        panels=("stiffness", "damping"),
        quantities={
            "omega": ("rad/s", "hz"),
            "hz": ("Hz", "hz"),
            "stiffness": ("N/m", "hz axis by"),
            "damping": ("N s/m", "hz axis by"),
            "load": ("N", "axis"),
            "displacement": ("m", "axis"),
            "swing": ("m", "axis"),
            "speed_rpm": ("rev/min", ""),
        },
        labels={"axis": ("x", "y"), "by": ("x", "y")},
        logs="x",
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
    def hz(self) -> _Floats:
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

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON but for the arrays."""
        return asdict(self)
