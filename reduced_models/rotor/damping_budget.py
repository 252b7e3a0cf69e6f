"""`DampingBudget`: who damps what, damping ratios of the modes of a rotor by the parts that take their energy.

The parts, what each takes and why the sum is exact: `reduced_models.rotor.loss_parts`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError
from ehlcontact.quantities import HERTZ, NUMBER, SPEED
from ehlcontact.results.table import Display
from ehlcontact.store import stored
from ehlcontact.summary import counted
from reduced_models.rotor.modes import RotorMode
from reduced_models.rotor.part_shares import PartShares, sizes

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

TOLD = 4  # modes that the summary has


class LossyRotor(Protocol):
    """A linear rotor whose parts take energy: `LinearRotor`."""

    @property
    def speed_rpm(self) -> float:
        """Of the shaft."""

    @property
    def losses(self) -> tuple[str, ...]:
        """Names of what takes energy."""

    def taken(self, s: complex, q: _Complex) -> tuple[dict[str, float], float]:
        """What each part takes from a motion q exp(s t), and its inertia."""

    def refined(self, mode: RotorMode) -> tuple[complex, _Complex]:
        """Eigenvalue and shape of a mode from one near it."""

    def without(self, *names: str) -> Self:
        """The rotor without the loss of these parts."""


@stored("damping budget")
@dataclass(frozen=True, eq=False, kw_only=True)
class DampingBudget(PartShares):
    """Damping ratios of n modes by p parts: each part adds its `contribution`, exactly, and all are the ratio.

    A part that feeds vibration, as a starved film or cross-coupled stiffness, contributes less than 0.

    Attributes
    ----------
    speed_rpm : float
        Of the shaft.
    parts : tuple of str
        Names of what takes energy, as "bearing 0, inner films", "bearing 0, rings and fits", "shaft".
    hz : ndarray, shape (n,)
        Damped frequencies.
    damping_ratio : ndarray, shape (n,)
        Shares of critical damping.
    contribution : ndarray, shape (p, n)
        Of each part to them.
    remaining : ndarray, shape (p, n)
        Damping ratios without the loss of a part, whose stiffness stays; nan where the mode is no longer one.
        Beyond small damping they are not the difference to the contribution: the shape changes.
    """

    speed_rpm: Annotated[float, SPEED]
    parts: tuple[str, ...]
    hz: Annotated[_Floats, HERTZ.over("mode")]
    damping_ratio: Annotated[_Floats, NUMBER.over("mode")]
    contribution: Annotated[_Floats, NUMBER.over("part mode")]
    remaining: Annotated[_Floats, NUMBER.over("part mode")]

    DISPLAY: ClassVar[Display] = Display(rows="part")

    def _display(self) -> Display:
        return replace(self.DISPLAY, labels={"part": self.parts, "mode": self.modes})

    def _summary_lines(self) -> list[str]:
        rows = [
            f"{hz:.4g} Hz, damping ratio {ratio:.3g}: {self.share_words(k) or 'nothing damps'}"
            for k, (hz, ratio) in enumerate(zip(self.hz[:TOLD], self.damping_ratio[:TOLD], strict=True))
        ]
        return [f"{counted(self.hz.size, 'mode')} at {self.speed_rpm:.5g} rev/min", *rows]

    @property
    def modes(self) -> tuple[str, ...]:
        """Number and frequency of each mode in words."""
        return tuple(f"{k + 1}: {hz:.4g} Hz" for k, hz in enumerate(self.hz.tolist()))

    @property
    def amounts(self) -> _Floats:
        """`contribution`."""
        return self.contribution

    @property
    def columns(self) -> tuple[tuple[str, ...], str]:
        """Frequencies of the modes."""
        return tuple(f"{hz:.4g}" for hz in self.hz.tolist()), "mode: damped frequency [Hz]"

    @property
    def share(self) -> Annotated[_Floats, NUMBER.over("part mode")]:
        """Contributions over the sum of their sizes, shape (p, n); without parts that feed vibration 1 in sum."""
        return self._share()

    @property
    def residual(self) -> Annotated[_Floats, NUMBER.over("mode")]:
        """Damping ratios less all contributions, over the sum of their sizes: what rounding leaves."""
        return np.asarray((self.damping_ratio - self.contribution.sum(axis=0)) / sizes(self.contribution))

    def to_dict(self) -> dict[str, Any]:
        """All numbers, ready for JSON; nan as None."""
        remaining = [[None if np.isnan(one) else one for one in row] for row in self.remaining.tolist()]
        return super().to_dict() | {"parts": list(self.parts), "remaining": remaining}


def budget_of(linear: LossyRotor, modes: Sequence[RotorMode]) -> DampingBudget:
    """The budget of modes of a linear rotor."""
    parts = linear.losses
    contribution, remaining = np.zeros((2, len(parts), len(modes)))
    for k, mode in enumerate(modes):
        s, q = linear.refined(mode)
        taken, mass = linear.taken(s, q)
        contribution[:, k] = [taken[part] / (2.0 * mass * s.imag * abs(s)) for part in parts]
    for row, part in enumerate(parts):
        rest = linear.without(part)
        remaining[row] = [_ratio(rest, mode) for mode in modes]
    return DampingBudget(
        speed_rpm=linear.speed_rpm,
        parts=parts,
        hz=np.array([mode.hz for mode in modes]),
        damping_ratio=np.array([mode.damping_ratio for mode in modes]),
        contribution=contribution,
        remaining=remaining,
    )


def _ratio(linear: LossyRotor, mode: RotorMode) -> float:
    """Damping ratio of a mode near that of another rotor; nan where there is none."""
    try:
        s, _ = linear.refined(mode)
    except ConvergenceError:
        return float("nan")
    return -s.real / abs(s)
