"""Differences between two runs of a rotor, reduced and full, relative to the motion of the full one."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from math import nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_nonnegative
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import Line, Panel, Picture
from ehlcontact.results.table import frame_of
from ehlcontact.summary import Summary
from reduced_models.rotor.result import RotorResult

_Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SignalDifference:
    """Difference of one signal; relative figures are None where the full signal is constant.

    Attributes
    ----------
    rms : float
        RMS of reduced - full, in the unit of the signal.
    offset : float
        Mean of reduced - full: another place of rest, not another vibration.
    maximum : float
        Largest magnitude of reduced - full.
    amplitude : float
        Half peak-to-peak of full.
    std : float
        Standard deviation of full.
    rms_over_amplitude, rms_over_std, maximum_over_amplitude : float or None
        Of those above.
    vibration_over_std : float or None
        RMS without the offset, over the standard deviation.
    """

    rms: float
    offset: float
    maximum: float
    amplitude: float
    std: float
    rms_over_amplitude: float | None
    rms_over_std: float | None
    vibration_over_std: float | None
    maximum_over_amplitude: float | None


@dataclass(frozen=True, eq=False)
class Comparison(Summary):
    """Differences by signal: disc_x, disc_y, journal_x, journal_y, approach_i [m], force_i [N]; i from 1.

    Attributes
    ----------
    signals : mapping of str to SignalDifference
    t_start, t_end : float
        What was compared [s].
    samples : int
        Of each signal.
    """

    signals: Mapping[str, SignalDifference]
    t_start: float
    t_end: float
    samples: int

    @property
    def displacement(self) -> float | None:
        """Largest `rms_over_std` of the nodes."""
        return self._worst(False, "rms_over_std")

    @property
    def force(self) -> float | None:
        """Largest `rms_over_std` of the contact forces."""
        return self._worst(True, "rms_over_std")

    @property
    def displacement_vibration(self) -> float | None:
        """Largest `vibration_over_std` of the nodes: without another place of rest."""
        return self._worst(False, "vibration_over_std")

    @property
    def force_vibration(self) -> float | None:
        """Largest `vibration_over_std` of the contact forces."""
        return self._worst(True, "vibration_over_std")

    def _summary_lines(self) -> list[str]:
        shares = {"displacements": self.displacement, "contact forces": self.force}
        lines = (f"{name} differ by {100.0 * share:.2g} %" for name, share in shares.items() if share is not None)
        return [
            f"{self.samples} samples from {self.t_start:.4g} to {self.t_end:.4g} s",
            ", ".join(lines) or "nothing moves",
            "percentages: largest rms difference, of the standard deviation of the full signal",
        ]

    def to_pandas(self) -> Any:
        """``pandas.DataFrame``, a row for each signal; raises `InputError` where pandas is not installed."""
        rows = [{"signal": name, **asdict(one)} for name, one in self.signals.items()]
        return frame_of(rows, "signal", {"t_start [s]": self.t_start, "t_end [s]": self.t_end})

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Matplotlib figure: error of every signal that moves; into a file too where a path is given.

        Raises
        ------
        InputError
            The file cannot be written.
        """
        names = np.array(list(self.signals))
        panels = []
        for figure, words in (("rms_over_std", "rms error"), ("vibration_over_std", "rms error without offset")):
            shares = (getattr(one, figure) for one in self.signals.values())
            values = np.array([nan if share is None else share for share in shares])
            panels.append(Panel([Line(names, values)], "signal", f"{words} / standard deviation"))
        return draw(Picture(panels, "Comparison: reduced less full"), path)

    def to_dict(self) -> dict[str, object]:
        """All figures, ready for JSON."""
        return {
            "t_start": self.t_start,
            "t_end": self.t_end,
            "samples": self.samples,
            "displacement": self.displacement,
            "force": self.force,
            "displacement_vibration": self.displacement_vibration,
            "force_vibration": self.force_vibration,
            "signals": {name: asdict(signal) for name, signal in self.signals.items()},
        }

    def _worst(self, forces: bool, figure: str) -> float | None:
        """Largest figure of the forces, or of the displacements of nodes."""
        approaches = (name for name in self.signals if name.startswith("approach_"))
        chosen = {name for name in self.signals if name.startswith("force_") == forces} - set(approaches)
        figures = [getattr(self.signals[name], figure) for name in chosen]
        return max((value for value in figures if value is not None), default=None)


@takes(full=Object(RotorResult, "a RotorResult"), reduced=Object(RotorResult, "a RotorResult"), discard="s")
def compare(full: RotorResult, reduced: RotorResult, *, discard: float = 0.0) -> Comparison:
    """Compare two runs over the time they share.

    Parameters
    ----------
    full, reduced : RotorResult
        Of rotors with the same contacts; `reduced` is interpolated linearly where its times differ.
    discard : float
        Transient to leave out at the beginning [s].

    Raises
    ------
    InputError
        Different numbers of contacts, or fewer than 2 shared times after `discard`.
    """
    if full.force.shape[1] != reduced.force.shape[1]:
        raise InputError(
            "contacts of reduced", reduced.force.shape[1], f"as many as of full, {full.force.shape[1]}"
        )
    begin = float(full.t[0]) + require_nonnegative("discard", discard)
    # Times are multiples of dt, so equal ones may differ by rounding.
    slack = 1e-9 * float(full.t[-1])
    shared = (full.t >= begin - slack) & (full.t <= reduced.t[-1] + slack)
    if np.count_nonzero(shared) < 2:
        raise InputError("discard", discard, "small enough to leave 2 times that both runs hold")
    t = full.t[shared]
    signals = {
        name: _difference(values[shared], np.interp(t, reduced.t, other))
        for (name, values), (_, other) in zip(_signals(full), _signals(reduced), strict=True)
    }
    return Comparison(signals, float(t[0]), float(t[-1]), int(t.size))


def _signals(result: RotorResult) -> Iterator[tuple[str, _Floats]]:
    for node in result.nodes:
        for axis, letter in enumerate("xy"):
            yield f"{node.replace(' ', '_')}_{letter}", result.node(node)[:, axis]
    for name in ("approach", "force"):
        for column, values in zip(result.columns, getattr(result, name).T, strict=True):
            yield f"{name}_{column.removeprefix('contact ').replace(' ', '_')}", values


def _difference(full: _Floats, reduced: _Floats) -> SignalDifference:
    error = reduced - full
    rms, maximum = float(np.sqrt(np.mean(error**2))), float(np.abs(error).max())
    offset, vibration = float(np.mean(error)), float(np.std(error))
    amplitude, std = 0.5 * float(np.ptp(full)), float(np.std(full))
    # A constant signal keeps rounding as its spread: nothing to be relative to.
    moves = amplitude > 1e-12 * float(np.abs(full).max())
    return SignalDifference(
        rms,
        offset,
        maximum,
        amplitude,
        std,
        rms / amplitude if moves else None,
        rms / std if moves else None,
        vibration / std if moves else None,
        maximum / amplitude if moves else None,
    )
