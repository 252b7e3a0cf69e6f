"""`SystemLife` of several bearings, `SpectrumLife` over a load spectrum.

All bearings of a system survive together with the slope 10/9 of ball bearings: L = (sum of L_k^(-10/9))^(-9/10).
In a spectrum damages of its states add up (Palmgren and Miner): with shares q of the time, 1/L is the sum of
q_k/L_k, in hours.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import fsum, inf
from typing import Any

from ehlcontact.checks import require_nonnegative
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary
from reduced_models.life.bearing_life import PER_HOUR, SLOPE, BearingLife, finite

SUM = 1e-6  # by which shares may miss 1
HOURS = ("l10rh", "lnmrh", "lnmrh_film")  # lives of a bearing that a system has too
KIND_OF_LIFE = {
    "l10rh": "basic reference",
    "lnmrh": "modified, kappa nu/nu1",
    "lnmrh_film": "modified, kappa of the film",
}


class _Hours(Summary):
    """Lives in hours, summed in the way of the class."""

    def _of(self, name: str) -> float | None:
        raise NotImplementedError

    @property
    def l10rh(self) -> float | None:
        """Basic reference rating life [h]; None where a part has none, as at rest."""
        return self._of("l10rh")

    @property
    def lnmrh(self) -> float | None:
        """Modified reference rating life with nu/nu1 [h]; None where a part has none."""
        return self._of("lnmrh")

    @property
    def lnmrh_film(self) -> float | None:
        """Modified reference rating life with the viscosity ratios of films [h]; None where a part has none."""
        return self._of("lnmrh_film")

    def _words(self) -> str:
        rows = ((KIND_OF_LIFE[name], getattr(self, name)) for name in HOURS)
        found = [f"{kind} {life:.4g} h" for kind, life in rows if life is not None]
        return "; ".join(found) or "no life in hours: at rest"


@dataclass(frozen=True, kw_only=True)
class SystemLife(_Hours):
    """Rating life of several bearings that have to survive together.

    Attributes
    ----------
    lives : tuple of BearingLife
    names : tuple of str
    """

    lives: tuple[BearingLife, ...]
    names: tuple[str, ...]

    def _summary_lines(self) -> list[str]:
        rows = zip(self.names, self.lives, strict=True)
        each = [f"{name}: {'no hours' if one.l10rh is None else f'L10rh {one.l10rh:.4g} h'}" for name, one in rows]
        covered = [f"not covered: {text}" for text in self.not_covered[:1]]
        return [f"{len(self.lives)} bearings together: {self._words()}", "; ".join(each), *covered]

    def __iter__(self) -> Iterator[BearingLife]:
        return iter(self.lives)

    def __getitem__(self, k: int) -> BearingLife:
        return self.lives[k]

    def __len__(self) -> int:
        return len(self.lives)

    @property
    def not_covered(self) -> tuple[str, ...]:
        """What the standards do not cover, a text with the name of its bearing each."""
        rows = zip(self.names, self.lives, strict=True)
        return tuple(f"{name}: {text}" for name, one in rows for text in one.not_covered)

    def _of(self, name: str) -> float | None:
        return together([getattr(one, name) for one in self.lives])

    def to_dict(self) -> dict[str, Any]:
        """Lives of the system [h] and of its bearings, ready for JSON."""
        bearings = [{**one.to_dict(), "name": name} for name, one in zip(self.names, self.lives, strict=True)]
        return {**{name: finite(getattr(self, name)) for name in HOURS}, "bearings": bearings}


@dataclass(frozen=True, kw_only=True)
class SpectrumLife(_Hours):
    """Rating life under states that follow each other.

    Attributes
    ----------
    shares : tuple of float
        Of the time, 1 together.
    lives : tuple of BearingLife or SystemLife
        Of the states.
    """

    shares: tuple[float, ...]
    lives: tuple[BearingLife | SystemLife, ...]

    def _summary_lines(self) -> list[str]:
        damage = [f"{share:.3g} of the time {100.0 * own:.3g} %" for share, own in self._rows()]
        covered = [f"not covered: {text}" for text in self.not_covered[:1]]
        return [f"{len(self.lives)} states: {self._words()}", f"damage: {', '.join(damage)}", *covered]

    def _rows(self) -> Iterator[tuple[float, float]]:
        return zip(self.shares, self.damage, strict=True)

    @property
    def damage(self) -> tuple[float, ...]:
        """Share of each state in the damage, by the basic life; 0 of all where nothing is loaded."""
        lives = [one.l10rh for one in self.lives]
        own = [0.0 if life is None else share / life for share, life in zip(self.shares, lives, strict=True)]
        return tuple(one / (fsum(own) or 1.0) for one in own)

    @property
    def speed_rpm(self) -> float:
        """Mean speed of the shaft [rev/min]."""
        speeds = [
            one[0].loads.speed_rpm if isinstance(one, SystemLife) else one.loads.speed_rpm for one in self.lives
        ]
        return fsum(share * speed for share, speed in zip(self.shares, speeds, strict=True))

    @property
    def l10r(self) -> float | None:
        """Basic reference rating life [million turns]."""
        return None if self.l10rh is None else PER_HOUR * self.speed_rpm * self.l10rh

    @property
    def not_covered(self) -> tuple[str, ...]:
        """What the standards do not cover, a text with the number of its state each."""
        return tuple(f"state {k + 1}: {text}" for k, one in enumerate(self.lives) for text in one.not_covered)

    def _of(self, name: str) -> float | None:
        return over_spectrum(self.shares, [getattr(one, name) for one in self.lives])

    def to_dict(self) -> dict[str, Any]:
        """Lives of the spectrum [h] and of its states, ready for JSON."""
        states = [
            {"share": share, "damage": damage, **one.to_dict()}
            for (share, damage), one in zip(self._rows(), self.lives, strict=True)
        ]
        lives = {name: finite(getattr(self, name)) for name in HOURS}
        return {**lives, "l10r": finite(self.l10r), "speed_rpm": self.speed_rpm, "states": states}


def together(lives: Sequence[float | None]) -> float | None:
    """Life of several that have to survive together; None where one has none."""
    known = [life for life in lives if life is not None]
    if len(known) < len(lives):
        return None
    damage = fsum(life**-SLOPE for life in known)
    return float(damage ** (-1.0 / SLOPE)) if damage > 0.0 else inf


def over_spectrum(shares: Sequence[float], lives: Sequence[float | None]) -> float | None:
    """Life under states with shares of the time and lives in hours; None where a state that lasts has none."""
    lasting = [(share, life) for share, life in zip(shares, lives, strict=True) if share > 0.0]
    damage = 0.0
    for share, life in lasting:
        if life is None:
            return None
        damage += share / life
    return 1.0 / damage if damage > 0.0 else inf


def life_of_spectrum(states: Sequence[tuple[float, Any]], **options: Any) -> SpectrumLife:
    """Rating life under a load spectrum: states that each last a share of the time.

    Parameters
    ----------
    states : sequence of (float, state)
        Shares of the time, 1 together, with a `BearingState` or a `SetState` each: whatever has ``life``.
    **options
        Of ``state.life``, for all of them.

    Raises
    ------
    InputError
        Shares that are no shares or do not sum to 1; no states; what ``life`` refuses.
    """
    if not isinstance(states, Sequence) or isinstance(states, str):
        raise InputError("states", states, "pairs of a share of the time and a state")
    pairs = [tuple(pair) if isinstance(pair, list | tuple) else () for pair in states]
    if not pairs or any(len(pair) != 2 for pair in pairs):
        raise InputError("states", f"{len(pairs)} entries", "pairs of a share of the time and a state")
    shares = require_shares("shares", [share for share, _ in pairs])
    calls: list[Callable[..., Any]] = []
    for _, state in pairs:
        call = getattr(state, "life", None)
        if call is None:
            raise InputError(
                "states", type(state).__name__, "states of a bearing or a set, as `equilibrium` has them"
            )
        calls.append(call)
    return SpectrumLife(shares=shares, lives=tuple(call(**options) for call in calls))


def require_shares(field: str, values: Sequence[float]) -> tuple[float, ...]:
    """Shares of the time; raises `InputError` unless they are >= 0 and sum to 1."""
    shares = tuple(require_nonnegative(field, value) for value in values)
    total = fsum(shares)
    if abs(total - 1.0) > SUM:
        guess = "; did you mean percent?" if abs(total - 100.0) < 100.0 * SUM else ""
        raise InputError(field, list(shares), f"1 in sum, not {total:.6g}{guess}")
    return shares
