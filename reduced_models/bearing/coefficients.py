"""Small vibrations of a bearing about rest: stiffness and damping over frequency, film memory included.

Every contact has the impedance Z = k + i w (dF/dm) tau G(w tau) of `reduced_models.elements.film_response`; those
of a ball are in series, and those of all balls add along their directions. Rings and fits may lose more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.summary import Summary, span
from reduced_models.bearing.balls import Balls, SpeedState
from reduced_models.bearing.equilibrium import RingEquilibrium
from reduced_models.bearing.loss import response
from reduced_models.bearing.race_table import RaceForceTable, curve, film_cutoff
from reduced_models.elements.film_law import DIRECT
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]


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
        impedance: _Complex,
        standings: Sequence[RingEquilibrium],
    ) -> BearingCoefficients:
        """From the mean impedance, shape (k, 2, 2), and the positions that it is the mean of.

        `impedance` has in its imaginary part C, not w C, so that it is there at w = 0 too.
        """
        places = np.array([standing.displacement for standing in standings])
        K, C = impedance.real.copy(), impedance.imag.copy()
        return cls(load, speed_rpm, cage_angle, omega, K, C, places.mean(axis=0), np.ptp(places, axis=0))

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON but for the arrays."""
        return asdict(self)


def impedances(balls: Balls, at_speed: SpeedState, standing: RingEquilibrium, omega: _Floats) -> _Complex:
    """K + i C of the ring, shape (k, 2, 2), at angular frequencies [rad/s]."""
    w = np.maximum(omega, TINY_OMEGA)
    total = np.zeros((w.size, 2, 2), complex)
    for k, n in enumerate(standing.normals):
        u_inner, u_outer = standing.approach[k].tolist()
        inner = contact_impedance(balls.inner, at_speed.inner, at_speed.speed_row, u_inner, w)
        outer = contact_impedance(balls.outer, at_speed.outer, at_speed.speed_row, u_outer, w)
        outer = outer - balls.inertia * w * w
        both = inner + outer
        series = np.divide(inner * outer, both, out=np.zeros_like(both), where=both != 0.0)
        total += series[:, None, None] * np.outer(n, n)
    total *= np.array([response(balls.loss, 1j * one) for one in w.tolist()])[:, None, None]
    return np.asarray(total.real + 1j * total.imag / w[:, None, None])


TINY_OMEGA = 1e-3  # rad/s, stands for 0: films forget in less than a second


class SmallContact(NamedTuple):
    """A contact about rest: dF = stiffness du + slope dm, with dm the response of the filters to tau u'."""

    stiffness: float  # of the static force [N/m]
    slope: float  # dF/dm [N/m]
    tau: float  # its own time [s]
    gains: _Floats  # (DIRECT + lags,); none in a dry contact
    rates: FilterRates | None  # in own time; None in a dry contact


def small_contact(law: RaceForceTable, transit: float, speed_row: tuple[int, float], u: float) -> SmallContact:
    """What a contact at rest at approach `u` does with a small motion."""
    g, by_u, _ = curve(u, speed_row[0], speed_row[1], law, 0)
    root = np.sqrt(g)
    if law.x.size == 0:
        return SmallContact(1.5 * law.kn * root * by_u, 0.0, 0.0, np.zeros(0), None)
    rows = law.gains[speed_row[0]]
    if speed_row[1] > 0.0:
        rows = rows + speed_row[1] * (law.gains[speed_row[0] + 1] - rows)
    x = law.log_kn + 1.5 * np.log(g)
    gains = np.array([np.interp(x, law.x, column) for column in rows.T])
    rates = FilterRates(gains.size - DIRECT, law.lag_rate, law.inlet_rate, law.fast_rate)
    share, share_u = film_cutoff(u, law.cutoff_gap)
    slope = share * 1.5 * law.kn * root
    return SmallContact(slope * by_u + share_u * law.kn * g * root, slope, transit * root, gains, rates)


def contact_impedance(
    law: RaceForceTable, transit: float, speed_row: tuple[int, float], u: float, omega: _Floats
) -> _Complex:
    """K + i w C of one contact at rest at approach `u`, shape (k,)."""
    small = small_contact(law, transit, speed_row, u)
    if small.rates is None:
        return np.full(omega.size, small.stiffness, complex)
    own = omega * small.tau
    return np.asarray(small.stiffness + small.slope * 1j * own * (small.rates.basis(own) @ small.gains))
