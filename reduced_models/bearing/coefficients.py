"""`BearingCoefficients`: response of a bearing to the motion of its ring, over frequency."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.quantities import DAMPING, FORCE, LENGTH, RADIAN, SPEED, Quantity
from ehlcontact.results.response import Response
from ehlcontact.results.table import Display
from ehlcontact.summary import note_line, span
from reduced_models.bearing.freedoms import FIVE, PLANAR, in_freedoms, labelled, load_words

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

TINY_OMEGA = 1e-3  # rad/s, stands for 0: films forget in less than a second


def stiffness_and_damping(impedance: Callable[[_Complex], _Complex], omega: _Floats) -> tuple[_Floats, _Floats]:
    """K and C, shape (k, n, n), of an impedance Z = K + i omega C at angular frequencies [rad/s], shape (k,)."""
    w = np.maximum(omega, TINY_OMEGA)
    Z = impedance(1j * w)
    return Z.real.copy(), Z.imag / w[:, None, None]


class RingAtRest(Protocol):
    """A ring in equilibrium at a position of the cage."""

    @property
    def displacement(self) -> _Floats:
        """Of its degrees of freedom [m], [rad]."""


@dataclass(frozen=True, eq=False, kw_only=True)
class BearingCoefficients(Response):
    """`Response` of a ring in n = 2 or 5 directions, x, y (, z, tilt_x, tilt_y), and where the load puts it.

    Its values are matrices, in SI. Tilts have rad for m and N m for N.

    Attributes
    ----------
    to, omega, value, slope, error_bars, point, film, residual, impedance, wavelength, wave_speed, units, seconds,
    beyond_data
        As of `ehlcontact.results.Response`: ``stiffness`` and ``damping`` have the shape (k, n, n) [N/m], [N s/m].
    layer_behind : None
        Of a response of one contact.
    load : ndarray, shape (n,)
        Force on the ring [N], [N m].
    speed_rpm : float
        Of the shaft.
    cage_angle : float or None
        Of the first ball [rad]; None: means over a ball passage.
    displacement : ndarray, shape (n,)
        Of the ring [m].
    peak_to_peak : ndarray, shape (n,)
        Peak-to-peak displacement of the ring while a ball passes slowly [m]; 0 at a given angle of the cage.
    outside : str
        Assumptions of films that do not hold at the most loaded ball: ``outside_assumptions``.
    signed_damping : ndarray, shape (k, n, n), or None
        C [N s/m] of the solved contacts under an oil supply, which at low frequency may be below zero; `damping`
        is that of the elements, which leave that out. None in flooded bearings.
    damping_left_out : str
        Below which frequency contacts under an oil supply have damping below zero, which `damping` leaves out, in
        words; empty where there is none.
    held_feed : str
        That a feed of oil is held, in words: under the layer of an `OilBalance`, `stiffness` and `signed_damping`
        include that layers follow the passes of the balls before (`reduced_models.bearing.oil_feedback`). Empty
        elsewhere.
    """

    load: Annotated[_Floats, FORCE.over("axis")]
    speed_rpm: Annotated[float, SPEED]
    cage_angle: Annotated[float | None, RADIAN]
    displacement: Annotated[_Floats, LENGTH.over("axis")]
    peak_to_peak: Annotated[_Floats, LENGTH.over("axis")]
    outside: str = ""
    signed_damping: Annotated[_Floats | None, DAMPING.over("omega axis by")] = None
    damping_left_out: str = ""
    held_feed: str = ""

    @property
    def outside_assumptions(self) -> str:
        """Assumptions of films that do not hold at the most loaded ball, in words; empty where none."""
        return self.outside

    def _quantities(self) -> Mapping[str, Quantity]:
        return in_freedoms(super()._quantities(), self.load.size)

    def _display(self) -> Display:
        return labelled(super()._display(), self.load.size)

    def _with_sign(self) -> _Floats:
        return self.damping if self.signed_damping is None else self.signed_damping

    def _summary_lines(self) -> list[str]:
        K, C = self.stiffness, self.damping
        axial = []
        if K.shape[1] > len(PLANAR):
            axial = [
                f"K_zz {span(K[:, 2, 2], 1e-6, 'N/µm')}, C_zz {span(C[:, 2, 2], 1.0, 'N s/m')}",
                f"tilt about x {span(K[:, 3, 3], 1e-3, 'N m/mrad')}, about y {span(K[:, 4, 4], 1e-3, 'N m/mrad')}",
            ]
        return [
            f"load {load_words(self.load)} at {self.speed_rpm:.5g} rev/min, {span(self.hz, 1.0, 'Hz')}",
            f"K_xx {span(K[:, 0, 0], 1e-6, 'N/µm')}, K_yy {span(K[:, 1, 1], 1e-6, 'N/µm')}",
            f"C_xx {span(C[:, 0, 0], 1.0, 'N s/m')}, C_yy {span(C[:, 1, 1], 1.0, 'N s/m')}",
            *axial,
            *self._signed_line(),
            "means over a ball passage" if self.cage_angle is None else f"cage at {self.cage_angle:.4g} rad",
            *filter(None, [self.damping_left_out, self.negative_damping, self.held_feed, self.reservation]),
            *note_line(self.outside_assumptions),
        ]

    def _signed_line(self) -> list[str]:
        if self.signed_damping is None:
            return []
        C = np.einsum("kii->ik", self.signed_damping)[:3]  # in x, y and z
        said = ", ".join(f"C_{2 * way} {span(row, 1.0, 'N s/m')}" for way, row in zip(FIVE, C, strict=False))
        return [f"of the solved contacts, below zero too: {said}"]

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        notes = {
            name: getattr(self, name)
            for name in ("damping_left_out", "held_feed", "beyond_data")
            if getattr(self, name)
        }
        own = {"outside_assumptions": self.outside_assumptions, "reservation": self.reservation}
        return super().to_dict() | own | notes

    @classmethod
    def of(
        cls,
        load: _Floats,
        speed_rpm: float,
        cage_angle: float | None,
        omega: _Floats,
        matrices: tuple[_Floats, _Floats],
        equilibria: Sequence[RingAtRest],
        outside_assumptions: str = "",
        signed_damping: _Floats | None = None,
        damping_left_out: str = "",
        held_feed: str = "",
        beyond_data: str = "",
    ) -> BearingCoefficients:
        """From the mean `matrices` K and C, shape (k, n, n), and the positions that they are the mean of."""
        places = np.array([at.displacement for at in equilibria])
        mean, peak_to_peak = places.mean(axis=0), np.ptp(places, axis=0)
        K, C = matrices
        return cls(
            omega=omega,
            value=K + 1j * omega[:, None, None] * C,
            slope=C,
            load=load,
            speed_rpm=speed_rpm,
            cage_angle=cage_angle,
            displacement=mean,
            peak_to_peak=peak_to_peak,
            outside=outside_assumptions,
            signed_damping=signed_damping,
            damping_left_out=damping_left_out,
            held_feed=held_feed,
            beyond_data=beyond_data,
        )
