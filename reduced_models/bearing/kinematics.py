"""Kinematics of a ball bearing: speeds of cage and balls, defect frequencies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_finite
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary

_Floats = NDArray[np.float64]

RPM_TO_HZ, RPM_TO_RAD_S = 1.0 / 60.0, pi / 30.0  # per second, of one turn per minute
LEAST_SLIP = -0.5  # of a cage: one that turns half as fast again is an error of sign


@dataclass(frozen=True, slots=True)
class DefectFrequencies(Summary):
    """Frequencies [Hz] of a ball bearing whose outer ring stands still, at a speed of its shaft.

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
    """`DefectFrequencies` per turn of the shaft.

    Attributes
    ----------
    ftf_order, bpfo_order, bpfi_order, bsf_order : float
    """

    ftf_order: float
    bpfo_order: float
    bpfi_order: float
    bsf_order: float

    @classmethod
    def of(cls, balls: int, ratio: float, cosine: float = 1.0) -> DefectOrders:
        """Orders for `balls` balls of diameter `ratio` D/dm, rolling without slip.

        At a contact angle, of that `cosine`, the cage follows gamma = D/dm cos(angle). A ball turns dm/(2 D)
        (1 - gamma^2) times: over its diameter, not over gamma (Harris, Rolling Bearing Analysis, ch. 8).
        """
        gamma = ratio * cosine
        return cls(
            ftf_order=cage_ratio(gamma),
            bpfo_order=balls * cage_ratio(gamma),
            bpfi_order=balls * 0.5 * (1.0 + gamma),
            bsf_order=0.5 * (1.0 - gamma * gamma) / ratio,
        )

    def at(self, speed_rpm: float) -> DefectFrequencies:
        """Frequencies [Hz] at a speed of the shaft [rev/min]."""
        turns = speed_rpm * RPM_TO_HZ
        return DefectFrequencies(
            ftf=self.ftf_order * turns,
            bpfo=self.bpfo_order * turns,
            bpfi=self.bpfi_order * turns,
            bsf=self.bsf_order * turns,
        )

    def with_slip(self, slip: float) -> DefectOrders:
        """Orders with a cage that turns slower by the share `slip`, as `cage_slip` gives it.

        A spot of the inner race meets more balls then. A ball slides by as much on both races, so its surface has
        the mean of their speeds, seen from the cage: its rotation loses slip gamma/(1 + gamma).

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
        shaft = self.ftf_order + self.bpfi_order * self.ftf_order / self.bpfo_order
        gamma, slower = 1.0 - 2.0 * self.ftf_order / shaft, 1.0 - slip
        balls = self.bpfo_order / self.ftf_order
        return DefectOrders(
            ftf_order=self.ftf_order * slower,
            bpfo_order=self.bpfo_order * slower,
            bpfi_order=balls * (shaft - self.ftf_order * slower),
            bsf_order=self.bsf_order * (1.0 - slip * gamma / (1.0 + gamma)),
        )


def cage_ratio(gamma: float) -> float:
    """Speed of the cage over that of the shaft; `gamma` is ball over pitch diameter."""
    return 0.5 * (1.0 - gamma)


def speed_sum_per_omega(pitch_diameter: float, gamma: float) -> float:
    """Sum of the surface speeds in either contact over the angular speed of the shaft [m]."""
    return 0.5 * pitch_diameter * (1.0 - gamma * gamma)


def ball_mass(ball_diameter: float, density: float) -> float:
    """Mass of a ball [kg]."""
    return density * pi / 6.0 * ball_diameter**3


def rolling_torque(inner: _Floats, outer: _Floats, ball_diameter: float, pitch_diameter: float) -> float:
    """Torque on the inner ring [N m] that the films' rolling resistance takes, outer ring still.

    By the power that is lost. Both films of a ball are entrained at the same u = u_sum/2
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
