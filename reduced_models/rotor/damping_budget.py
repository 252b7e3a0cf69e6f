"""`DampingBudget`: who damps what, damping ratios of the modes of a rotor by the parts that take their energy.

The parts, what each takes and why the sum is exact: `reduced_models.rotor.loss_parts`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError
from ehlcontact.quantities import HERTZ, NUMBER, SPEED
from ehlcontact.results.picture import Picture
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.store import stored
from ehlcontact.summary import counted
from reduced_models.rotor.modes import RotorMode
from reduced_models.rotor.picture import budget_picture

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

TOLD, LEAST = 4, 0.005  # modes and least share that the summary has


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
class DampingBudget(QuantityTable):
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
    def share(self) -> Annotated[_Floats, NUMBER.over("part mode")]:
        """Contributions over the sum of their sizes, shape (p, n); without parts that feed vibration 1 in sum."""
        return self.contribution / _or_one(np.abs(self.contribution).sum(axis=0))

    @property
    def residual(self) -> Annotated[_Floats, NUMBER.over("mode")]:
        """Damping ratios less all contributions, over the sum of their sizes: what rounding leaves."""
        left = self.damping_ratio - self.contribution.sum(axis=0)
        return np.asarray(left / _or_one(np.abs(self.contribution).sum(axis=0)))

    @property
    def kinds(self) -> dict[str, _Floats]:
        """Shares of alike parts of all bearings together, shape (n,): "inner films", "rings and fits", ..."""
        found: dict[str, _Floats] = {}
        for part, row in zip(self.parts, self.share, strict=True):
            kind = part.rpartition(", ")[2]
            found[kind] = found.get(kind, 0.0) + row
        return found

    def share_words(self, mode: int) -> str:
        """Shares of alike parts in a mode, in words, the largest first; empty where nothing damps."""
        shares = [(float(row[mode]), kind) for kind, row in self.kinds.items()]
        told = sorted((one for one in shares if abs(one[0]) >= LEAST), key=lambda one: -abs(one[0]))
        return ", ".join(f"{kind} {100.0 * share:.3g} %" for share, kind in told)

    def renamed(self, name_of: Callable[[str], str]) -> Self:
        """The budget with other names of bearings and nodes: `name_of` has them by the old ones."""
        rows = (part.partition(", ") for part in self.parts)
        return replace(self, parts=tuple(f"{name_of(name)}{comma}{kind}" for name, comma, kind in rows))

    def to_dict(self) -> dict[str, Any]:
        """All numbers, ready for JSON; nan as None."""
        remaining = [[None if np.isnan(one) else one for one in row] for row in self.remaining.tolist()]
        return super().to_dict() | {"parts": list(self.parts), "remaining": remaining}

    def picture(self) -> Picture:
        """Shares of the parts in each mode, stacked, below its damping ratio."""
        return budget_picture(self)


def _or_one(sizes: _Floats) -> _Floats:
    return np.where(sizes > 0.0, sizes, 1.0)


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
