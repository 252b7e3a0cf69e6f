"""`PeriodicBranch`: periodic answers over a parameter, with its folds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks.kinds import Callback, Count
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.quantities import NUMBER, Quantity
from ehlcontact.results.picture import Picture
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.status import Status
from ehlcontact.store import stored
from ehlcontact.summary import counted, span
from reduced_models.periodic_motion.answer import PeriodicAnswer
from reduced_models.periodic_motion.floquet import Bifurcation, bifurcations
from reduced_models.periodic_motion.picture import branch_picture

_Floats = NDArray[np.float64]

UNITS = {"speed": "rev/min", "amplitude": "", "clearance": "m", "preload": "m", "frequency": "Hz"}
STEPS = 128  # of a period, for multipliers
MIXED = Quantity("m, or rad where it turns")
NOT_STORED = {"stored": False}  # of a field that no file has


@stored("branch of periodic answers")
@dataclass(frozen=True, eq=False, kw_only=True)
class PeriodicBranch(QuantityTable):
    """Periodic answers over a parameter, along their branch: through folds, where the parameter turns back.

    Attributes
    ----------
    answers : tuple of PeriodicAnswer
        In the order of the branch.
    folds : tuple of int
        Places of the answers at folds.
    over : str
        The parameter: "speed", "amplitude", "clearance", "preload" or "frequency".
    status : Status
        How the branch ended.
    reservation : str
        Why, where it did not end at the end of the range; else empty.
    solve : callable
        ``solve(answer, value)``: the answer at a value of the parameter, near another one; `at` calls it. None
        of a branch from a file, as `measure` is.
    measure : callable
        ``measure(answer, count, steps)``: an answer with its multipliers; `with_multipliers` calls it.
    """

    answers: tuple[PeriodicAnswer, ...]
    folds: tuple[int, ...]
    over: str
    status: Status
    reservation: str = ""
    solve: Any = field(default=None, repr=False, metadata=NOT_STORED)  # answer at a value, from one beside it
    measure: Any = field(default=None, repr=False, metadata=NOT_STORED)  # an answer with its multipliers

    DISPLAY: ClassVar[Display] = Display(rows="answer", first=0)

    @property
    def value(self) -> Annotated[_Floats, MIXED.over("answer")]:
        """Of the parameter, shape (k,), in its unit."""
        return np.array([answer.value for answer in self.answers])

    @property
    def peak_to_peak(self) -> Annotated[_Floats, MIXED.over("answer dof")]:
        """Of all degrees of freedom, shape (k, N) [m], or rad where they turn."""
        return np.array([answer.peak_to_peak for answer in self.answers])

    @property
    def stable(self) -> Annotated[_Floats, NUMBER.over("answer")]:
        """1 where an answer is stable, 0 where it is not, not a number where multipliers were not computed."""
        return np.array([np.nan if answer.stable is None else float(answer.stable) for answer in self.answers])

    @property
    def fold_values(self) -> _Floats:
        """Values of the parameter at folds, in the order of the branch."""
        return self.value[list(self.folds)]

    def at(self, value: float) -> tuple[PeriodicAnswer, ...]:
        """All answers of the branch at a value of the parameter, in the order of the branch.

        They have multipliers where those of the branch have.

        Raises
        ------
        ConvergenceError
            No answer near those of the branch beside the value.
        InputError
            A branch from a file, which has no rotor.
        """
        self._require_rotor()
        values, found = self.value, []
        if not values.min() <= value <= values.max():
            raise InputError("value", value, f"from {values.min():.7g} to {values.max():.7g}, those of the branch")
        for k in range(len(values) - 1):
            low, high = values[k], values[k + 1]
            if (low - value) * (high - value) < 0.0 or low == value:
                near = self.answers[k if abs(low - value) <= abs(high - value) else k + 1]
                answer = self.solve(near, value)
                known = near.multipliers
                found.append(answer if known is None else self.measure(answer, max(len(known), 1), STEPS))
        if values.size and values[-1] == value:
            found.append(self.answers[-1])
        return tuple(found)

    @takes(count=Count(1, 1000), steps=Count(16, 100_000), callback=Callback("made, answers"))
    def with_multipliers(
        self, count: int = 6, *, steps: int = STEPS, callback: Callable[[int, int], object] | None = None
    ) -> Self:
        """The branch, its answers with their largest Floquet multipliers (`floquet.with_multipliers`).

        Parameters
        ----------
        count : int
            Of the multipliers of an answer.
        steps : int
            Time steps in a period of the excitation.
        callback : callable, optional
            Called as ``callback(made, answers)`` after every answer.

        Returns
        -------
        PeriodicBranch
            After Ctrl-C multipliers of the first answers alone.

        Raises
        ------
        InputError
            A branch from a file, which has no rotor.
        """
        self._require_rotor()
        answers = list(self.answers)
        try:
            for k, answer in enumerate(self.answers):
                answers[k] = self.measure(answer, count, steps)
                if callback is not None:
                    callback(k + 1, len(answers))
        except KeyboardInterrupt:
            return replace(self, answers=tuple(answers), status=Status.INTERRUPTED)
        return replace(self, answers=tuple(answers))

    def _require_rotor(self) -> None:
        if self.solve is None:
            allowed = "one that `periodic` returned: a file has no rotor, of which other answers are"
            raise InputError("branch", "from a file", allowed)

    def bifurcations(self) -> tuple[Bifurcation, ...]:
        """Folds, branch points, period doublings and Neimark-Sacker bifurcations between its answers.

        Raises
        ------
        InputError
            An answer without multipliers.
        """
        return bifurcations(self.answers)

    def picture(self) -> Picture:
        """Peak to peak over the parameter, stable and unstable, above the largest multiplier."""
        return branch_picture(self)

    def _unit(self, name: str) -> str:
        return UNITS[self.over] if name == "value" else super()._unit(name)

    def _summary_lines(self) -> list[str]:
        unit = UNITS[self.over]
        folds = ", ".join(f"{value:.6g}" for value in self.fold_values)
        lines = [
            f"{counted(len(self.answers), 'answer')} over {self.over}, {span(self.value)} {unit}".rstrip(),
            f"folds at {folds} {unit}".rstrip() if folds else "no fold",
        ]
        if all(answer.multipliers is not None for answer in self.answers):
            lines += [f"{one.kind} at {one.value:.6g} {unit}".rstrip() for one in self.bifurcations()]
        for low, high in self.multiple():
            lines.append(f"several answers between {low:.6g} and {high:.6g} {unit}".rstrip())
        residual = max(answer.residual for answer in self.answers)
        lines.append(f"{self.status}; residual at most {residual:.2g}")
        return [*lines, *filter(None, [self.reservation])]

    def multiple(self) -> list[tuple[float, float]]:
        """Ranges of the parameter between a fold and the next, in which there are several answers."""
        folds = self.fold_values.tolist()
        pairs = [(min(pair), max(pair)) for pair in zip(folds[::2], folds[1::2], strict=False)]
        return sorted(pairs)
