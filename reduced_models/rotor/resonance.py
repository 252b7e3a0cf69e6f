"""Resonances of linear rotors under unbalance: frequencies that resolve their modes, responses, highest points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduced_models.rotor.linearise import LinearRotor
from reduced_models.rotor.modes import RotorMode
from reduced_models.rotor.nodes import PLANE

SPAN = (0.3, 1.7)  # of the slowest mode, and of the fastest shown, at the ends of the frequencies
SHOWN = (0.75, 1.25)  # of a resonance, at the ends of what a picture shows
POINTS = 300  # evenly on the logarithm, beside those near resonances
# Round every resonance: how far, in half widths of its peak, and points, evenly on the area hyperbolic sine.
NEAR = (50.0, 81)


@dataclass(frozen=True)
class Resonance:
    """Highest point of the response along one direction."""

    hz: float
    amplitude: float  # of the disc, over the eccentricity of the unbalance


@dataclass(frozen=True, eq=False)
class Resonances:
    """Responses of several rotors by direction, "x" or "y", and name of the rotor.

    The unbalance turns at `hz`; films are those of the speed of each rotor.
    """

    hz: NDArray[np.float64]
    curves: Mapping[str, Mapping[str, NDArray[np.complex128]]]  # of the disc, over the eccentricity
    peaks: Mapping[str, Mapping[str, Resonance]]

    @property
    def spans(self) -> dict[str, tuple[float, float]]:
        """Frequencies worth showing of every direction [Hz]: round its resonances, or all where it has none."""
        bands = {}
        for direction in self.curves:
            peaks = [peak.hz for peak in self.peaks[direction].values()]
            around = (
                (SHOWN[0] * min(peaks), SHOWN[1] * max(peaks))
                if peaks
                else (float(self.hz[0]), float(self.hz[-1]))
            )
            bands[direction] = around
        return bands

    def to_dict(self) -> dict[str, Any]:
        """The resonances, ready for JSON."""
        return {
            direction: {name: asdict(peak) for name, peak in peaks.items()}
            for direction, peaks in self.peaks.items()
        }


def resonances(rotors: Mapping[str, LinearRotor], eccentricity: float) -> Resonances:
    """Responses of the disc over frequencies that show the slowest mode along every direction of every rotor.

    Parameters
    ----------
    rotors : mapping of str to LinearRotor
        With the same nodes, "disc" among them.
    eccentricity : float
        Of the unbalance [m]; amplitudes are over it.
    """
    slowest = {name: linear.slowest() for name, linear in rotors.items()}
    hz = frequencies_near([mode for by_direction in slowest.values() for mode in by_direction.values()])
    places = next(iter(rotors.values())).rotor.nodes["disc"]
    columns = {direction: place for direction, place in places.items() if direction in PLANE}
    curves: dict[str, dict[str, NDArray[np.complex128]]] = {direction: {} for direction in columns}
    peaks: dict[str, dict[str, Resonance]] = {direction: {} for direction in columns}
    for name, linear in rotors.items():
        amplitudes = linear.unbalance_response(hz=hz).amplitude / eccentricity
        for direction, column in columns.items():
            curves[direction][name] = amplitudes[:, column]
            if direction in slowest[name]:
                peaks[direction][name] = _peak(hz, np.abs(amplitudes[:, column]), slowest[name][direction])
    return Resonances(hz, curves, peaks)


def frequencies_near(modes: list[RotorMode]) -> NDArray[np.float64]:
    """Frequencies [Hz] from below the slowest mode to above the fastest, close together near each of them."""
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
