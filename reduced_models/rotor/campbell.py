"""Modes of a rotor on ball bearings over its speed, each tracked from speed to speed; critical speeds."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import pi
from typing import Annotated, ClassVar, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, parts, require_integer, require_positive
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.quantities import FREQUENCY, HERTZ, NUMBER, PER_SECOND, SPEED
from ehlcontact.results.picture import Picture
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.store import stored
from ehlcontact.summary import counted, span
from reduced_models.rotor.linearise import DEFAULT_MODES, LinearRotor, linearise
from reduced_models.rotor.modes import RotorMode, mode_distance
from reduced_models.rotor.picture import campbell_picture
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]

BESIDE = 4  # modes beyond those that are followed, among which these may turn up at another speed


@dataclass(frozen=True)
class CriticalSpeed:
    """A speed at which a multiple of the speed meets a mode.

    Attributes
    ----------
    speed_rpm : float
        Of the shaft [rev/min].
    hz : float
        Of the mode.
    mode : int
        Column of the diagram.
    decrement : float
        Logarithmic, of the mode there.
    whirl : float
        As in `RotorMode`; an unbalance hardly excites one near -1.
    """

    speed_rpm: float
    hz: float
    mode: int
    decrement: float
    whirl: float


class CriticalSpeeds(tuple[CriticalSpeed, ...]):
    """Critical speeds of a diagram; where there are none, `searched` names what was looked through.

    Attributes
    ----------
    searched : str
        Speeds and modes among which they were looked for.
    """

    searched: str

    def __new__(cls, found: Iterable[CriticalSpeed] = (), searched: str = "") -> Self:
        """The speeds `found` among what was `searched`."""
        speeds = super().__new__(cls, found)
        speeds.searched = searched
        return speeds

    def __repr__(self) -> str:
        return super().__repr__() if self else f"() no critical speed {self.searched}".rstrip()


@stored("Campbell diagram")
@dataclass(frozen=True, eq=False, kw_only=True)
class Campbell(QuantityTable):
    """Modes over the speed of the shaft; a column of an array is one mode, followed from speed to speed.

    Attributes
    ----------
    speed_rpm : ndarray, shape (k,)
        In rev/min.
    omega, growth : ndarray, shape (k, n)
        Imaginary and real part of the eigenvalues: damped angular frequency [rad/s], and real part [1/s], by
        which a vibration grows where it is above 0.
    whirl : ndarray, shape (k, n)
        1 forward, -1 backward, 0 on straight lines.
    axial_share : ndarray, shape (k, n)
        Share of the squared displacements that is along the shaft.
    """

    speed_rpm: Annotated[_Floats, SPEED.over("speed_rpm")]
    omega: Annotated[_Floats, FREQUENCY.over("speed_rpm mode")]
    growth: Annotated[_Floats, PER_SECOND.over("speed_rpm mode")]
    whirl: Annotated[_Floats, NUMBER.over("speed_rpm mode")]
    axial_share: Annotated[_Floats, NUMBER.over("speed_rpm mode")]

    DISPLAY: ClassVar[Display] = Display(rows="speed_rpm", first=0)

    def _summary_lines(self) -> list[str]:
        lines = [
            f"{counted(self.omega.shape[1], 'mode')} at {counted(self.speed_rpm.size, 'speed')}, "
            f"{span(self.speed_rpm)} rev/min",
            f"{span(self.hz, 1.0, 'Hz')}, logarithmic decrements {span(self.decrement)}",
        ]
        if self.speed_rpm.size > 1:
            critical = self.critical_speeds()
            speeds = ", ".join(f"{speed.speed_rpm:.5g}" for speed in critical)
            above, below = _sides(self.hz - self.speed_rpm[:, None] / 60.0)
            none = f"no critical speed among them: {above} modes stay above the speed, {below} below"
            lines.append(f"critical speeds {speeds} rev/min" if critical else none)
        return lines

    @property
    def hz(self) -> Annotated[_Floats, HERTZ.over("speed_rpm mode")]:
        """Damped frequencies [Hz]."""
        return np.asarray(self.omega / (2.0 * pi))

    @property
    def decrement(self) -> Annotated[_Floats, NUMBER.over("speed_rpm mode")]:
        """Logarithmic decrements."""
        return np.asarray(-2.0 * pi * self.growth / self.omega)

    def critical_speeds(self, order: float = 1.0) -> tuple[CriticalSpeed, ...]:
        """Where `order` times the speed meets a mode, in the order of speeds; straight between the speeds given.

        Parameters
        ----------
        order : float
            1 for unbalance; ``bearing.orders.bpfo_order`` for the balls that pass.

        Returns
        -------
        tuple of CriticalSpeed
            Where it is empty, its ``searched``, and what it shows at the prompt, say between which speeds there is
            none, and on which side of it the modes lie: faster ones want higher speeds in the diagram.

        Raises
        ------
        InputError
            A diagram of one speed, between which nothing can be met.
        """
        off = self.hz - require_positive("order", order) * self.speed_rpm[:, None] / 60.0
        if len(self.speed_rpm) < 2:
            raise InputError("speeds_rpm", self.speed_rpm.tolist(), "at least two, between which modes are met")
        critical = []
        for k, mode in zip(*np.nonzero((off[:-1] > 0.0) != (off[1:] > 0.0)), strict=True):
            share = off[k, mode] / (off[k, mode] - off[k + 1, mode])
            rpm, hz, decrement, whirl = (
                float(values[k] + share * (values[k + 1] - values[k]))
                for values in (self.speed_rpm, self.hz[:, mode], self.decrement[:, mode], self.whirl[:, mode])
            )
            critical.append(CriticalSpeed(rpm, hz, int(mode), decrement, whirl))
        return CriticalSpeeds(sorted(critical, key=lambda speed: speed.speed_rpm), self._searched(order, off))

    def _searched(self, order: float, off: _Floats) -> str:
        """Speeds and modes in words, by how far [Hz] the modes lie above `order` times the speed."""
        above, below = _sides(off)
        low, high = (order * float(rpm) / 60.0 for rpm in (self.speed_rpm[0], self.speed_rpm[-1]))
        multiple = "" if order == 1.0 else f"{order:.5g} times "
        return (
            f"between {self.speed_rpm[0]:.5g} and {self.speed_rpm[-1]:.5g} rev/min: of {off.shape[1]} modes at "
            f"{span(self.hz, 1.0, 'Hz')} {above} stay above {multiple}the speed, {low:.4g} to {high:.4g} Hz, "
            f"and {below} below"
        )

    def picture(self) -> Picture:
        """Frequencies over the speed with the critical speeds, above the decrements."""
        return campbell_picture(self)


def _sides(off: _Floats) -> tuple[int, int]:
    """Number of columns of `off` that stay above 0, and of those that stay below."""
    return int((off > 0.0).all(axis=0).sum()), int((off <= 0.0).all(axis=0).sum())


@takes(rotor=Object(Rotor, "a Rotor"), speeds_rpm=parts.SPEEDS)
def campbell(
    rotor: Rotor,
    speeds_rpm: ArrayLike,
    *,
    count: int = DEFAULT_MODES,
    passage: bool = True,
    signed_damping: bool = False,
) -> Campbell:
    """Modes of a rotor on ball bearings at increasing speeds.

    Parameters
    ----------
    rotor : Rotor
    speeds_rpm : array_like, shape (k,)
        In rev/min; 0 and below as in `linearise`.
    count : int
        Modes: the slowest at the first speed, which are then followed by frequency and shape.
    passage, signed_damping : bool
        Bearings as means over a ball passage, and with the signed damping of solved contacts, as in `linearise`.

    Raises
    ------
    InputError
        A speed that a bearing does not take.
    ConvergenceError
        A mode was not found, or is damped so much at one of the speeds that it does not oscillate.
    """
    speeds = as_column("speeds_rpm", speeds_rpm, increasing=True)
    count = require_integer("count", count, "a whole number >= 1", 1)
    linear = (linearise(rotor, s, passage=passage, signed_damping=signed_damping) for s in speeds.tolist())
    return campbell_of(linear, count)


def campbell_of(linear: Iterable[LinearRotor], count: int) -> Campbell:
    """The diagram of a rotor that is linearised at increasing speeds; errors of modes as of `campbell`."""
    speeds: list[float] = []
    rows: list[list[RotorMode]] = []
    for one in linear:
        modes = list(one.modes(count + BESIDE))
        if rows and len(modes) < len(rows[-1]):
            what = f"{len(modes)} of {len(rows[-1])} modes oscillate at {one.speed_rpm:g} rev/min"
            raise ConvergenceError(f"Campbell diagram: only {what}: ask for fewer (count)", None)
        rows.append(_tracked(rows[-1], modes) if rows else modes[:count])
        speeds.append(one.speed_rpm)
    columns = np.array([[(m.omega, m.eigenvalue.real, m.whirl, m.axial_share) for m in row] for row in rows])
    omega, growth, whirl, axial_share = np.moveaxis(columns, -1, 0)
    return Campbell(speed_rpm=np.array(speeds), omega=omega, growth=growth, whirl=whirl, axial_share=axial_share)


def _tracked(before: list[RotorMode], modes: list[RotorMode]) -> list[RotorMode]:
    """Mode tracking: of the modes `found`, those nearest to the ones before (`mode_distance`), in their order."""
    values, shapes = np.array([m.eigenvalue for m in modes]), np.array([m.shape for m in modes]).T
    cost = [mode_distance(old.eigenvalue, old.shape, values, shapes) for old in before]
    return [modes[column] for column in scipy.optimize.linear_sum_assignment(cost)[1].tolist()]
