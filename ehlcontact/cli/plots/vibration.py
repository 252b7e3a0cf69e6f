"""The rotor's own vibrations: free decay after a kick, and the response to unbalance over frequency."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.plots.rotor import DRAWN, LOOKS, MICRO, Names
from ehlcontact.cli.plots.style import legend_above, new_figure
from reduced_models import Decrement, RotorResult

DIRECTIONS = {"x": "horizontal", "y": "vertical"}


def decay(runs: Mapping[str, RotorResult], decrements: Mapping[str, Decrement], names: Names) -> Figure:
    """Height of the journal about its rest over time, and the logarithm of the amplitudes that were fitted."""
    figure = new_figure(5.8)
    above, below = figure.subplots(2, 1, height_ratios=(3, 2))
    for name, run in runs.items():
        found = decrements[name]
        if name in DRAWN:
            y = (run.journal[:, 1] - run.journal[0, 1]) * 1e6
            above.plot(run.t * 1e3, y, **LOOKS[name], label=names[name])
        periods = np.array([0.0, found.periods])
        label = f"{names[name]}: {numeral(found.decrement, 3)}"
        below.plot(periods, -found.decrement * periods, **LOOKS[name], label=label)
    above.set(xlabel="time [ms]", ylabel=f"journal y about rest [{MICRO}]", xlim=(0.0, 1e3 * float(run.t[-1])))
    below.set(xlabel="period of those fitted", ylabel="ln(amplitude/first)")
    below.set_xlim(0.0, min(found.periods for found in decrements.values()))
    legend_above(above)
    handles, labels = below.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, title="logarithmic decrement")
    figure.align_ylabels()
    return figure


def bode(
    hz: NDArray[np.float64],
    curves: Mapping[str, Mapping[str, NDArray[np.complex128]]],
    spans: Mapping[str, tuple[float, float]],
    names: Names,
) -> Figure:
    """Amplification and phase of the disc under unbalance, by direction, each over its span of frequency [Hz]."""
    figure = new_figure(5.8)
    panels: Any = figure.subplots(2, len(curves), squeeze=False, sharex="col", height_ratios=(3, 2))
    for column, (direction, found) in enumerate(curves.items()):
        upper, lower = panels[:, column]
        low, high = spans[direction]
        shown = (hz >= low) & (hz <= high)
        for name, whole in found.items():
            curve = whole[shown]
            upper.semilogy(hz[shown], np.abs(curve), **LOOKS[name], label=names[name])
            # behind the force of the unbalance, which in y comes a quarter of a turn after that in x
            behind = np.angle(curve * (1j if direction == "y" else 1.0), deg=True)
            lower.plot(hz[shown], np.where(behind > 90.0, behind - 360.0, behind), **LOOKS[name])
        upper.set_title(f"disc, {DIRECTIONS[direction]}")
        lower.set(xlabel="frequency of the unbalance [Hz]", xlim=(low, high))
        lower.set_yticks([0, -90, -180, -270])
    panels[0, 0].set_ylabel("displacement/eccentricity [-]")
    panels[1, 0].set_ylabel("phase [deg]")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    figure.align_ylabels()
    return figure
