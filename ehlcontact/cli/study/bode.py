"""Response to unbalance over frequency, of the linear rotors of a study, and their resonances."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduced_models import LinearRotor, RotorMode

SPAN = (0.3, 1.7)  # of the slowest resonance, and of the fastest shown, at the ends of the frequencies
SHOWN = (0.75, 1.25)  # likewise, of what a picture shows
POINTS = 300  # evenly on the logarithm, beside those near resonances
# Round every resonance: how far, in half widths of its peak, and points, evenly on the area hyperbolic sine.
NEAR = (50.0, 81)


@dataclass(frozen=True)
class Resonance:
    """Highest point of one direction."""

    hz: float
    amplitude: float  # of the disc, over the eccentricity of the unbalance

    def to_dict(self) -> dict[str, float]:
        """Both numbers."""
        return {"hz": self.hz, "amplitude": self.amplitude}


@dataclass(frozen=True, eq=False)
class Bode:
    """Disc displacement by direction, "x" or "y", and contact: the unbalance turns at `hz`, the film does not."""

    hz: NDArray[np.float64]
    curves: Mapping[str, Mapping[str, NDArray[np.complex128]]]  # over the eccentricity, unbalance/disc mass
    peaks: Mapping[str, Mapping[str, Resonance]]

    @property
    def spans(self) -> dict[str, tuple[float, float]]:
        """Frequencies worth showing of every direction [Hz]: round its resonances, or all where it has none."""
        found = {}
        for direction in self.curves:
            at = [peak.hz for peak in self.peaks[direction].values()]
            around = (SHOWN[0] * min(at), SHOWN[1] * max(at)) if at else (float(self.hz[0]), float(self.hz[-1]))
            found[direction] = around
        return found

    def to_dict(self) -> dict[str, Any]:
        """The peaks."""
        return {
            direction: {name: peak.to_dict() for name, peak in found.items()}
            for direction, found in self.peaks.items()
        }


def bode(rotors: Mapping[str, LinearRotor], eccentricity: float) -> Bode:
    """Response over frequencies that show the slowest mode of every direction of every rotor."""
    slowest = {name: linear.slowest() for name, linear in rotors.items()}
    modes = [mode for by_direction in slowest.values() for mode in by_direction.values()]
    hz = _frequencies(modes)
    disc = next(iter(rotors.values())).rotor.nodes["disc"]
    curves: dict[str, dict[str, NDArray[np.complex128]]] = {direction: {} for direction in disc}
    peaks: dict[str, dict[str, Resonance]] = {direction: {} for direction in disc}
    for name, linear in rotors.items():
        amplitudes = linear.unbalance_response(hz=hz).amplitude / eccentricity
        for direction, column in disc.items():
            curve = amplitudes[:, column]
            curves[direction][name] = curve
            if direction in slowest[name]:
                peaks[direction][name] = _peak(hz, np.abs(curve), slowest[name][direction])
    return Bode(hz, curves, peaks)


def _frequencies(modes: list[RotorMode]) -> NDArray[np.float64]:
    centres = [mode.hz for mode in modes]
    parts = [np.geomspace(SPAN[0] * min(centres), SPAN[1] * max(centres), POINTS)]
    spread = np.sinh(np.linspace(-np.arcsinh(NEAR[0]), np.arcsinh(NEAR[0]), NEAR[1]))
    for mode in modes:
        half_width = abs(mode.eigenvalue.real) / (2.0 * pi)
        parts.append(mode.hz + half_width * spread)
    every = np.unique(np.concatenate(parts))
    return np.asarray(every[(every >= parts[0][0]) & (every <= parts[0][-1])])


def _peak(hz: NDArray[np.float64], amplitude: NDArray[np.float64], mode: RotorMode) -> Resonance:
    """Highest sample within ten half widths of the mode."""
    width = 10.0 * abs(mode.eigenvalue.real) / (2.0 * pi)
    near = np.abs(hz - mode.hz) <= width
    highest = int(np.argmax(np.where(near, amplitude, 0.0)))
    return Resonance(float(hz[highest]), float(amplitude[highest]))
