"""Speed of a shaft over time: angle, forces of unbalances, speeds at which race tables are made."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, parts, require_nonnegative
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.quantities import SPEED, TIME
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.summary import span
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]

EITHER_WAY = parts.SPEED_OR_NONE._replace(signed=True)
SPEED_RATIO = 1.25  # of neighbouring speeds at which laws are made


@fields_take(t="s", speed_rpm=EITHER_WAY)
@dataclass(frozen=True, eq=False)
class SpeedProfile(QuantityTable):
    """Speed of the shaft over time, straight between given times.

    Parameters
    ----------
    t : array_like, shape (k,), k >= 2
        Increasing, from 0 on [s].
    speed_rpm : array_like, shape (k,)
        Speeds [rev/min], >= 0; or <= 0 of a shaft that turns backward, from y to x. Constant before the first and
        after the last time.
    """

    t: Annotated[_Floats, TIME.over("t")]
    speed_rpm: Annotated[_Floats, SPEED.over("t")]

    DISPLAY: ClassVar[Display] = Display(rows="t", panels=("speed_rpm",))

    def _summary_lines(self) -> list[str]:
        over = f"{self.t.size} times from {self.t[0]:.4g} to {self.t[-1]:.4g} s"
        return [f"{span(self.speed_rpm, 1.0, 'rev/min')}, {over}"]

    def __post_init__(self) -> None:
        object.__setattr__(self, "t", as_column("t", self.t, least=2, increasing=True))
        object.__setattr__(self, "speed_rpm", as_column("speed_rpm", self.speed_rpm, size=self.t.size))
        require_nonnegative("t[0]", float(self.t[0]))
        low, high = float(self.speed_rpm.min()), float(self.speed_rpm.max())
        if low < 0.0 < high:
            allowed = "all >= 0, or all <= 0: between them the shaft would stand still, where films do not hold"
            raise InputError("speed_rpm", [low, high], allowed)

    @classmethod
    @takes(speed_rpm=EITHER_WAY)
    def constant(cls, speed_rpm: float) -> SpeedProfile:
        """One speed all the time."""
        return cls(np.array([0.0, 1.0]), np.full(2, speed_rpm))

    @classmethod
    @takes(first_rpm=EITHER_WAY, last_rpm=EITHER_WAY, seconds=parts.SECONDS)
    def ramp(cls, first_rpm: float, last_rpm: float, seconds: float) -> SpeedProfile:
        """From one speed to another at a constant rate: a run-up, or a coast-down."""
        return cls(np.array([0.0, seconds]), np.array([first_rpm, last_rpm]))

    @takes(t=parts.ANY)
    def at(self, t: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Speed [rad/s], angle of the shaft [rad] and angular acceleration [rad/s2]."""
        knots = np.concatenate([[0.0], self.t, [np.inf]]) if self.t[0] > 0.0 else np.append(self.t, np.inf)
        speeds = np.interp(knots, self.t, self.speed_rpm) * RPM_TO_RAD_S
        turned = np.concatenate([[0.0], np.cumsum(0.5 * (speeds[1:-1] + speeds[:-2]) * np.diff(knots[:-1]))])
        rise = np.append(np.diff(speeds[:-1]) / np.diff(knots[:-1]), 0.0)
        k = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(rise) - 1)
        since = t - knots[k]
        omega = speeds[k] + rise[k] * since
        return omega, turned[k] + since * (speeds[k] + 0.5 * rise[k] * since), rise[k]


class ShaftCourse(NamedTuple):
    """What turns with the shaft, at given times."""

    omega: _Floats  # (k,) speed [rad/s]
    angle: _Floats  # (k,) of the shaft [rad]
    turning: _Floats  # (k, 2 unbalances) forces of the unbalances [N]
    at: _Floats  # (N, 2 unbalances) where they act
    law_speeds: _Floats  # speeds [rev/min] at which the tables of races are made


def shaft_course(rotor: Rotor, speed_rpm: float | SpeedProfile, t: _Floats) -> ShaftCourse:
    """Speed, angle and forces of the unbalances of a rotor at the times `t` [s]."""
    profile = speed_rpm if isinstance(speed_rpm, SpeedProfile) else SpeedProfile.constant(speed_rpm)
    omega, angle, rise = profile.at(t)
    turning, at = turning_forces(rotor, omega, angle, rise)
    return ShaftCourse(omega, angle, turning, at, law_speeds(omega / RPM_TO_RAD_S))


def law_speeds(rpm: _Floats) -> _Floats:
    """Speeds at which laws are made for a course, in either direction."""
    low, high = float(np.abs(rpm).min()), float(np.abs(rpm).max())
    if low == high:
        return np.array([low])
    low = max(low, 1e-3 * high)
    count = max(ceil(np.log(high / low) / np.log(SPEED_RATIO)), 1)
    return np.geomspace(low, high, count + 1)


def turning_forces(rotor: Rotor, omega: _Floats, angle: _Floats, rise: _Floats) -> tuple[_Floats, _Floats]:
    """Forces of all unbalances over time, shape (k, 2 unbalances), and where they act, shape (N, 2 unbalances)."""
    forces = np.zeros((omega.size, 2 * len(rotor.unbalances)))
    unit = np.zeros((rotor.size, 2 * len(rotor.unbalances)))
    for i, u in enumerate(rotor.unbalances):
        c, s = np.cos(angle + u.phase), np.sin(angle + u.phase)
        forces[:, 2 * i] = u.amount * (omega**2 * c + rise * s)
        forces[:, 2 * i + 1] = u.amount * (omega**2 * s - rise * c)
        for k, place in enumerate((u.x, u.y)):
            if place is not None:
                unit[place, 2 * i + k] = 1.0
    return forces, unit
