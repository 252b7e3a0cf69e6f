"""`Uncertainty`: intervals of the numbers of a machine, what moves them, what failed; its picture."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import BLUE, INK, PALE_BLUE, SHOWN, Band, Line, Mark, Panel, Picture
from ehlcontact.summary import Summary, counted
from reduced_models.margins.samples import OF_CRITICAL, Sample, matched, words_of
from reduced_models.margins.statistics import Influence, Interval, influence_of, interval_of
from reduced_models.rotor.machine_tiles import digits

_Floats = NDArray[np.float64]

# Numbers of a machine in the picture and the summary: all of the first row, the first there is of the others
DRAWN = (*OF_CRITICAL, "peak", "response"), (("lambda", "h_min"), ("lnmrh", "l10rh"), ("mode_damping",))
NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?")  # in a message
ROW, AROUND = 34.0, 40.0  # px of a row of a tornado, and beside its rows
MOST_DRAWN = 6  # numbers that are all drawn
WIDE = 9.0  # of a bar
STRONG = 2.0  # standard errors of a correlation from which an input is named
NAMED = 3  # inputs that are named at a number, and numbers in a sentence, at most
UNITS = SHOWN | {"F": ("pF", 1e12)}  # of tables
LINES = 4  # numbers in a summary
FIGURES, OF_UNITS = 3, {"rev/min": 5, "Hz": 4}  # of a number


class Reason(NamedTuple):
    """Why samples have no answer, or how their machines are beyond the data."""

    samples: int
    sample: int  # the first of them, from 0
    text: str  # of that sample
    answered: bool  # whether they have numbers all the same


@dataclass(frozen=True, eq=False, kw_only=True)
class Uncertainty(Summary):
    """Numbers of sampled machines.

    Attributes
    ----------
    inputs : tuple of str
    values : ndarray, shape (samples, inputs)
        In the units in which the inputs were given.
    numbers : mapping of str to ndarray, shape (samples,)
        NaN where a machine has none: it has no such critical speed in the range, or no answer (`failures`).
    nominal : mapping of str to float or None
        Numbers of the machine without samples: as it is given, or with every input at its median.
    failures, beyond : tuple of str
        What of each sample could not be answered, and what is beyond the data; empty where nothing is.
    seed : int
        Of the draws.
    nearest : mapping of str to str
        Names here of the numbers of the critical speed that is nearest to the speed of the nominal machine.
    """

    inputs: tuple[str, ...]
    values: _Floats
    numbers: Mapping[str, _Floats]
    nominal: Mapping[str, float | None]
    failures: tuple[str, ...]
    beyond: tuple[str, ...]
    seed: int
    nearest: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, inputs: Sequence[str], samples: Sequence[Sample], nominal: Sample, seed: int) -> Self:
        """From samples in their order, and that of the nominal machine."""
        rows, own = matched(samples, nominal)
        names = dict.fromkeys(name for row in (own, *rows) for name in row)
        numbers = {
            name: np.array([np.nan if (value := row.get(name)) is None else value for row in rows], float)
            for name in names
        }
        return cls(
            inputs=tuple(inputs),
            values=np.array([one.values for one in samples], float),
            numbers={name: column for name, column in numbers.items() if np.isfinite(column).any()},
            nominal=own,
            failures=tuple(one.failure for one in samples),
            beyond=tuple(one.beyond for one in samples),
            seed=seed,
            nearest=_nearest(nominal, own),
        )

    def _summary_lines(self) -> list[str]:
        said = [f"{counted(len(self.values), 'sample')} of {counted(len(self.inputs), 'input')}, seed {self.seed}"]
        said += [self.line(name) for name in self.drawn[:LINES]]
        return [*said, *self.remarks[:1]]

    @cached_property
    def _intervals(self) -> dict[str, Interval | None]:
        return {name: interval_of(column) for name, column in self.numbers.items()}

    @cached_property
    def _influences(self) -> dict[str, Influence | None]:
        return {name: influence_of(self.values, column) for name, column in self.numbers.items()}

    def interval(self, name: str) -> Interval | None:
        """Interval of a number that contains 95 % of the machines, and its error; None where few machines have it.

        Raises
        ------
        InputError
            No such number.
        """
        return self._intervals[self._known(name)]

    def influence(self, name: str) -> Influence | None:
        """How each input moves a number: rank correlations with their errors; None where nothing moves it.

        Raises
        ------
        InputError
            No such number.
        """
        return self._influences[self._known(name)]

    def _known(self, name: str) -> str:
        if name not in self.numbers:
            raise InputError("name", name, f"one of {', '.join(self.numbers)}")
        return name

    @property
    def drawn(self) -> tuple[str, ...]:
        """Numbers of picture and summary: all that move, of many critical speeds, responses, films and life."""
        every, firsts = DRAWN
        known = [name for name in self.numbers if self._influences[name] is not None]
        if len(known) <= MOST_DRAWN:
            return tuple(known)
        bases = {name: re.sub(r"_\d+$", "", name) for name in known}
        found = [name for base in every for name in known if base == bases[name]]
        found += [name for row in firsts for name in [one for one in row if one in known][:1]]
        return tuple(found or known)

    @property
    def rows(self) -> Iterator[tuple[str, Interval, Influence | None]]:
        """Numbers that have an interval, with it and what moves them."""
        for name in self.numbers:
            if (interval := self._intervals[name]) is not None:
                yield name, interval, self._influences[name]

    def words(self, name: str, values: Sequence[float | None]) -> list[str]:
        """Values of a number with the digits and in the unit of tables; a dash where there is none."""
        factor = UNITS.get(words_of(name)[1], ("", 1.0))[1]
        count = OF_UNITS.get(words_of(name)[1], FIGURES)
        return ["-" if value is None else digits(factor * value, count) for value in values]

    @staticmethod
    def unit(name: str) -> str:
        """Unit of a number in tables."""
        unit = words_of(name)[1]
        return UNITS.get(unit, (unit, 1.0))[0]

    def between(self, name: str) -> str:
        """The interval of a number in words; empty where it has none."""
        interval = self._intervals.get(name)
        if interval is None:
            return ""
        low, high = self.words(name, (interval.low, interval.high))
        return f"{percent(interval)} {low} to {high}" if low != high else ""

    def moved_by(self, name: str) -> str:
        """Inputs that move a number, the strongest first, with rank correlations; empty where none does."""
        found = self._influences.get(name)
        if found is None:
            return ""
        order = np.argsort(-np.abs(found.correlation))[:NAMED].tolist()
        strong = [k for k in order if abs(found.correlation[k]) > STRONG * found.error[k]]
        return ", ".join(f"{self.inputs[k]} {found.correlation[k]:+.2f}" for k in strong)

    def line(self, name: str) -> str:
        """A number in a line: nominal value, interval, and what moves it."""
        label, _ = words_of(name)
        (nominal,) = self.words(name, (self.nominal.get(name),))
        moved = self.moved_by(name)
        said = ", ".join(filter(None, (f"{label} {nominal} {self.unit(name)}".rstrip(), self.between(name))))
        return f"{said}; by {moved}" if moved else said

    def alike(self, name: str) -> str:
        """Name here of a number of the nominal machine, whose nearest critical speed is one of several."""
        return self.nearest.get(name, name)

    @property
    def share(self) -> str:
        """What an interval of all samples contains on average, in words."""
        found = interval_of(np.arange(len(self.values), dtype=float))
        return "" if found is None else percent(found)

    @property
    def sure(self) -> str:
        """What an interval of all samples contains, in words."""
        found = interval_of(np.arange(len(self.values), dtype=float))
        if found is None:
            return ""
        low, high = (digits(100.0 * share, 3) for share in found.contains)
        of = f"an interval of {found.known} samples contains {low} to {high} % of all machines"
        return f"{of}, with 95 % confidence"

    @property
    def reasons(self) -> tuple[Reason, ...]:
        """What failed or is beyond the data, each reason with its number of samples, the most frequent first."""
        found: dict[tuple[bool, str], list[int]] = {}
        answered = [
            any(np.isfinite(column[k]) for column in self.numbers.values()) for k in range(len(self.values))
        ]
        for texts in (self.failures, self.beyond):
            for k, text in enumerate(texts):
                if text:
                    found.setdefault((answered[k], NUMBER.sub("#", text)), []).append(k)
        rows = [
            Reason(len(own), own[0], (self.failures[own[0]] or self.beyond[own[0]]), known)
            for (known, _), own in found.items()
        ]
        return tuple(sorted(rows, key=lambda one: -one.samples))

    @property
    def remarks(self) -> list[str]:
        """Failures, missing numbers, and nominal values outside of their intervals, in sentences."""
        total, said = len(self.values), []
        for one in self.reasons:
            inputs = ", ".join(
                f"{name} {value:.4g}" for name, value in zip(self.inputs, self.values[one.sample], strict=True)
            )
            how = "are not answered in full" if one.answered else "have no answer, and are in no interval"
            said.append(
                f"{one.samples} of {total} samples {how}, as number {one.sample + 1} ({inputs}): {one.text}"
            )
        failed = np.array([bool(text) for text in self.failures])
        for name, column in self.numbers.items():
            missing = int((~np.isfinite(column) & ~failed).sum())
            if missing and name.startswith(OF_CRITICAL[0]):
                said.append(f"{missing} of {total} samples have no {words_of(name)[0]} in the range of speeds")
        return [*said, *self._nominal_outside()]

    def _nominal_outside(self) -> list[str]:
        """Numbers of which the machine as given is no sample of these ranges, in a sentence."""
        names = []
        for name, interval in self._intervals.items():
            own = self.nominal.get(name)
            if interval is None or own is None or interval.low <= own <= interval.high or not self.between(name):
                continue
            if self.words(name, (own,))[0] not in self.words(name, (interval.low, interval.high)):
                names.append(words_of(name)[0])
        if not names:
            return []
        more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
        return [f"the nominal value lies outside of the range: {', '.join(names[:NAMED])}{more}"]

    def picture(self) -> Picture:
        """Of each number rank correlations with the inputs, and its distribution with the interval."""
        panels: list[Panel] = []
        for name in self.drawn:
            label, unit = words_of(name)
            influence = self._influences[name]
            assert influence is not None
            panels += [self._tornado(label, influence), self._distribution(name, label, unit)]
        note = "Bars: rank correlation (Spearman) of each input with the number, lines: ± standard error. Shaded:"
        return Picture(
            panels,
            heights=(AROUND + ROW * max(len(self.inputs), 4),),
            note=f"{note} the interval; dotted: the machine as given.",
        )

    def _tornado(self, label: str, found: Influence) -> Panel:
        order = np.argsort(-np.abs(found.correlation)).tolist()
        lines = []
        for row, k in enumerate(order):
            r, error = float(found.correlation[k]), float(found.error[k])
            lines += [
                Line(np.array([0.0, r]), np.array([row, row], float), colour=BLUE, width=WIDE, dash="-"),
                Line(
                    np.array([r - error, r + error]), np.array([row, row], float), colour=INK, width=2.0, dash="-"
                ),
            ]
        rows = [self.inputs[k] for k in order]
        return Panel(
            lines, "rank correlation", "", title=label, x_ends=(-1.05, 1.05), rows=rows, marks=(Mark(0.0),)
        )

    def _distribution(self, name: str, label: str, unit: str) -> Panel:
        x = np.sort(self.numbers[name][np.isfinite(self.numbers[name])])
        share = 100.0 * (np.arange(x.size) + 0.5) / x.size
        interval, nominal = self._intervals[name], self.nominal.get(name)
        bands = () if interval is None else (Band(interval.low, interval.high, percent(interval), PALE_BLUE),)
        marks = () if nominal is None else (Mark(nominal),)
        below: Any = (label, unit) if unit else label
        return Panel((Line(x, share),), below, "machines below [%]", y_ends=(0.0, 100.0), bands=bands, marks=marks)

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Matplotlib figure of the picture; into a file too where a path is given.

        Raises
        ------
        InputError
            The file cannot be written, or nothing moves.
        """
        if not self.drawn:
            raise InputError("samples", len(self.values), "some whose numbers differ")
        return draw(self.picture(), path)

    def columns(self) -> dict[str, _Floats]:
        """Inputs and numbers of all samples by their names, shape (samples,) each; with units in the names."""
        found = {name: self.values[:, k] for k, name in enumerate(self.inputs)}
        for name, column in self.numbers.items():
            unit = words_of(name)[1]
            found[f"{name} [{unit}]" if unit else name] = column
        return found

    def to_dict(self) -> dict[str, Any]:
        """Intervals, influences and remarks, SI, ready for JSON; samples themselves are in `columns`."""
        found = {}
        for name, interval, influence in self.rows:
            found[name] = {"nominal": self.nominal.get(name), **interval._asdict()}
            if influence is not None:
                r, error = influence.correlation.tolist(), influence.error.tolist()
                found[name]["rank_correlation"] = dict(zip(self.inputs, r, strict=True))
                found[name]["rank_correlation_error"] = dict(zip(self.inputs, error, strict=True))
                found[name]["explained"] = influence.explained
        return {
            "samples": len(self.values),
            "seed": self.seed,
            "inputs": list(self.inputs),
            "nearest": dict(self.nearest),
            "numbers": found,
            "failed": sum(map(bool, self.failures)),
            "remarks": self.remarks,
        }


def percent(interval: Interval) -> str:
    """What an interval contains on average, in words."""
    return f"{digits(100.0 * interval.share, 2)} %"


def _nearest(nominal: Sample, numbered: Mapping[str, float | None]) -> dict[str, str]:
    """Names among numbered critical speeds of the numbers of the nearest one."""
    speed, _ = OF_CRITICAL
    own = nominal.numbers.get(speed)
    alike = [name for name, value in numbered.items() if name.startswith(speed) and value == own]
    if own is None or not alike:
        return {}
    return {name: f"{name}{alike[0].removeprefix(speed)}" for name in OF_CRITICAL}
