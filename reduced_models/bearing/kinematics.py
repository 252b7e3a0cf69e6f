"""Kinematics of a ball bearing: speeds of cage and balls, defect frequencies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, require_finite
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary

_Floats = NDArray[np.float64]

RPM_TO_HZ, RPM_TO_RAD_S = 1.0 / 60.0, pi / 30.0  # per second, of one turn per minute
LEAST_SLIP = -0.5  # of a cage: one that turns half as fast again is an error of sign


class RingSpeeds(NamedTuple):
    """Speeds of both rings about the axis of the bearing, over the speed of one against the other.

    Rolling depends on the latter alone: seen from the outer ring all goes as in a bearing whose inner ring turns.
    The cage has the speed of the outer ring beside its own there; balls have the centrifugal force of their sum.
    """

    inner: float
    outer: float

    @classmethod
    def of(cls, turning: Any) -> RingSpeeds:
        """Of "inner" or "outer", the ring that turns, or of the speeds of both, inner ring first.

        Raises
        ------
        InputError
            Another word; what is not two numbers, or two speeds that are the same.
        """
        if isinstance(turning, str):
            if turning not in BY_RING:
                raise InputError("turning", turning, ALLOWED)
            return BY_RING[turning]
        try:
            inner, outer = as_column("turning", turning, size=2).tolist()
        except InputError:
            raise InputError("turning", turning, ALLOWED) from None
        if inner == outer:
            raise InputError("turning", turning, f"{ALLOWED}, which differ: else nothing rolls")
        between = abs(inner - outer)
        return cls(inner / between, outer / between)

    @property
    def sense(self) -> float:
        """1 where the inner ring turns forward as seen from the outer one, else -1."""
        return 1.0 if self.inner > self.outer else -1.0

    def about_axis(self, orbit: Any) -> Any:
        """Speed about the axis of what has the speed `orbit` seen from the outer ring, forward as balls go."""
        return self.outer + self.sense * orbit

    def from_outer(self, cage: Any) -> Any:
        """Speed seen from the outer ring, forward as balls go, of what turns at `cage` about the axis."""
        return self.sense * (cage - self.outer)


INNER_TURNS = RingSpeeds(1.0, 0.0)
BY_RING = {"inner": INNER_TURNS, "outer": RingSpeeds(0.0, 1.0)}
ALLOWED = '"inner", "outer", or the speeds of inner and outer ring, as (12000.0, -9000.0)'


@dataclass(frozen=True, slots=True)
class DefectFrequencies(Summary):
    """Frequencies [Hz] of a ball bearing at the speed of its rings against each other.

    Attributes
    ----------
    ftf : float
        Fundamental train frequency: turns of the cage.
    bpfo, bpfi : float
        Balls that pass a spot on the outer and on the inner race.
    bsf : float
        Turns of a ball. A spot on it meets a race twice per turn: what some tables print as the ball's is 2 BSF.
    """

    FIELD_UNITS: ClassVar[Mapping[str, str]] = {"ftf": "Hz", "bpfo": "Hz", "bpfi": "Hz", "bsf": "Hz"}

    ftf: float
    bpfo: float
    bpfi: float
    bsf: float


@dataclass(frozen=True, slots=True)
class DefectOrders(Summary):
    """`DefectFrequencies` per turn of the shaft, or of one ring against the other.

    Attributes
    ----------
    ftf_order, bpfo_order, bpfi_order, bsf_order : float
        That of the cage is below 0 where it turns backward, as between rings that turn against each other.
    """

    ftf_order: float
    bpfo_order: float
    bpfi_order: float
    bsf_order: float

    @classmethod
    def of(cls, balls: int, ratio: float, cosine: float = 1.0, rings: RingSpeeds = INNER_TURNS) -> DefectOrders:
        """Orders for `balls` balls of diameter `ratio` D/dm, rolling without slip.

        At a contact angle, of that `cosine`, the cage follows gamma = D/dm cos(angle). A ball turns dm/(2 D)
        (1 - gamma^2) times: over its diameter, not over gamma (Harris, Rolling Bearing Analysis, ch. 8).
        """
        gamma = ratio * cosine
        return cls(
            ftf_order=rings.about_axis(cage_ratio(gamma)),
            bpfo_order=balls * cage_ratio(gamma),
            bpfi_order=balls * 0.5 * (1.0 + gamma),
            bsf_order=0.5 * (1.0 - gamma * gamma) / ratio,
        )

    @classmethod
    def at_speeds(cls, balls: int, cage: float, rotation: float, rings: RingSpeeds = INNER_TURNS) -> DefectOrders:
        """Orders for a cage and balls with these speeds, about the axis and about their own axes."""
        return cls(
            ftf_order=cage,
            bpfo_order=balls * (rings.sense * (cage - rings.outer)),
            bpfi_order=balls * (rings.sense * (rings.inner - cage)),
            bsf_order=rotation,
        )

    def at(self, speed_rpm: float) -> DefectFrequencies:
        """Frequencies [Hz] at a speed of the shaft [rev/min]."""
        turns = abs(speed_rpm) * RPM_TO_HZ
        return DefectFrequencies(
            ftf=abs(self.ftf_order) * turns,
            bpfo=self.bpfo_order * turns,
            bpfi=self.bpfi_order * turns,
            bsf=self.bsf_order * turns,
        )

    def with_slip(self, slip: float, rings: RingSpeeds = INNER_TURNS) -> DefectOrders:
        """Orders with a cage that turns slower by the share `slip`, as `cage_slip` gives it.

        A spot of the inner race meets more balls then; where the outer ring turns alone, one of the outer race
        does. A ball slides by as much on both races, so its surface has the mean of their speeds, seen from the
        cage: with the inner ring turning its rotation loses slip gamma/(1 + gamma).

        Raises
        ------
        InputError
            A slip that is not above -0.5 and below 1.
        """
        if slip == 0.0:
            return self
        if not LEAST_SLIP < require_finite("slip", slip) < 1.0:
            raise InputError(
                "slip", slip, f"above {LEAST_SLIP:g} and below 1: a share of the speed of the cage (in per cent?)"
            )
        rolls = rings.from_outer(self.ftf_order)  # seen from the outer ring, as all here
        between = rolls + self.bpfi_order * rolls / self.bpfo_order
        gamma, lost = 1.0 - 2.0 * rolls / between, slip * (rings.sense * self.ftf_order / rolls)
        slower = 1.0 - lost
        balls = self.bpfo_order / rolls
        return DefectOrders(
            ftf_order=self.ftf_order * (1.0 - slip),
            bpfo_order=self.bpfo_order * slower,
            bpfi_order=balls * (between - rolls * slower),
            bsf_order=self.bsf_order * (1.0 - lost * gamma / (1.0 + gamma)),
        )


def cage_ratio(gamma: float) -> float:
    """Speed of the cage over that of the shaft, the outer ring still; `gamma` is ball over pitch diameter."""
    return 0.5 * (1.0 - gamma)


def speed_sum_per_omega(pitch_diameter: float, gamma: float) -> float:
    """Sum of the surface speeds in either contact over the angular speed of the shaft [m]."""
    return 0.5 * pitch_diameter * (1.0 - gamma * gamma)


def ball_mass(ball_diameter: float, density: float) -> float:
    """Mass of a ball [kg]."""
    return density * pi / 6.0 * ball_diameter**3


def rolling_torque(inner: _Floats, outer: _Floats, ball_diameter: float, pitch_diameter: float) -> float:
    """Torque between the rings [N m] that the films' rolling resistance takes.

    It is the same on both rings, in opposite directions. By the power that is lost at the speed omega of one ring
    against the other: both films of a ball are entrained at the same u = u_sum/2
    (`speed_sum_per_omega`), and a film whose pressure has the moment m about its centre line loses m u/Rx
    (`ehlcontact.SteadyResult.moment`). So

        T omega = u sum (m_i/Rx_i + m_o/Rx_o),    Rx = D/2 (1 -+ D/dm)
        2 T = sum m_i (dm/D + 1) + m_o (dm/D - 1):

    the moment at one race acts with the radius of the other over the diameter of the ball. Tractions that keep a
    ball in balance do no work as long as it rolls without slip; the tests have them, in the balance of forces.

    Parameters
    ----------
    inner, outer : ndarray, shape (balls,)
        Moments of the pressure at both races [N m].
    ball_diameter, pitch_diameter : float
        D and dm, in one unit.
    """
    ratio = pitch_diameter / ball_diameter
    return float(0.5 * ((ratio + 1.0) * inner.sum() + (ratio - 1.0) * outer.sum()))


def centrifugal_factor(ball_diameter: float, pitch_diameter: float, density: float) -> float:
    """Centrifugal force on a ball over the square of the cage's angular speed [kg m]."""
    return ball_mass(ball_diameter, density) * 0.5 * pitch_diameter
