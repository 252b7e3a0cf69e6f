"""The rotor on full contacts against the rotor on elements."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, RED, legend_above, new_figure
from reduced_models import RotorResult

FULL, REDUCED = "full film in the loop", "element of this band"
OTHERS = {"memory": ("film memory", GREEN), "harmonic": ("element of the contact band", ORANGE)}


def orbit(full: RotorResult, reduced: RotorResult) -> Figure:
    """Paths of disc and journal, the last revolution heavy.

    Of a rotor that moves only up and down, velocity against displacement.
    """
    figure = new_figure(4.4)
    steps = round(60.0 / full.rotor.speed_rpm / float(full.t[1] - full.t[0]))
    planar = float(np.ptp(full.journal[:, 0])) > 0.0
    for axes, body in zip(figure.subplots(1, 2), ("disc", "journal"), strict=True):
        centre = getattr(full, body)[0] * 1e6
        for run, style, colour, label in ((full, "-", BLUE, FULL), (reduced, "--", RED, REDUCED)):
            path = getattr(run, body) * 1e6 - centre
            x, y = path[:, 0], path[:, 1]
            if not planar:
                x, y = y, getattr(run, f"{body}_velocity")[:, 1] * 1e3
            axes.plot(x, y, style, color=colour, linewidth=0.7, alpha=0.45)
            last = slice(-steps - 1, None)
            axes.plot(x[last], y[last], style, color=colour, label=label)
        axes.set(title=body, xlabel="x [um]" if planar else "displacement y [um]")
        axes.set_ylabel("y [um]" if planar else "velocity [mm/s]")
        if planar:
            axes.set_aspect("equal", adjustable="datalim")
        axes.margins(0.12)
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def response(full: RotorResult, runs: Mapping[str, RotorResult]) -> Figure:
    """Journal displacement and force of contact 1 over time, and the differences of all reduced runs."""
    reduced = runs["rotor_band"]
    figure = new_figure(7.2)
    panels = figure.subplots(4, 1, sharex=True, height_ratios=(2, 1, 2, 1))
    t = full.t * 1e3
    signals = (
        ("journal y", "um", lambda run: (run.journal[:, 1] - full.journal[0, 1]) * 1e6),
        ("force 1", "N", lambda run: run.force[:, 0]),
    )
    for k, (name, unit, signal) in enumerate(signals):
        upper, lower = panels[2 * k], panels[2 * k + 1]
        upper.plot(t, signal(full), color=BLUE, label=FULL)
        upper.plot(t, signal(reduced), "--", color=RED, label=REDUCED)
        upper.set_ylabel(f"{name} [{unit}]")
        lower.plot(t, signal(reduced) - signal(full), color=RED, label=REDUCED)
        for other, (label, colour) in OTHERS.items():
            if other in runs:
                lower.plot(t, signal(runs[other]) - signal(full), color=colour, label=label, linewidth=1.2)
        lower.set_ylabel(f"difference\n[{unit}]")
        lower.axhline(0.0, color=GREY, linewidth=0.8)
    legend_above(panels[0])
    legend_above(panels[1])
    panels[-1].set(xlabel="time [ms]", xlim=(t[0], t[-1]))
    figure.align_ylabels()
    return figure


def spectrum(full: RotorResult, reduced: RotorResult) -> Figure:
    """Amplitudes of disc displacement and contact force, Hann window over the whole run."""
    figure = new_figure(3.6)
    pairs = (
        ("disc y [um]", lambda run: run.disc[:, 1] * 1e6),
        ("force of contact 1 [N]", lambda run: run.force[:, 0]),
    )
    for axes, (label, signal) in zip(figure.subplots(1, 2), pairs, strict=True):
        for run, style, colour, name in ((full, "-", BLUE, FULL), (reduced, "--", RED, REDUCED)):
            values = signal(run)[1:]
            window = np.hanning(values.size)
            amplitude = 2.0 * np.abs(np.fft.rfft((values - values.mean()) * window)) / window.sum()
            frequency = np.fft.rfftfreq(values.size, float(run.t[1] - run.t[0]))
            axes.semilogy(frequency, amplitude, style, color=colour, label=name)
        speed = run.rotor.speed_rpm / 60.0
        axes.axvline(speed, color=GREY, linestyle=":")
        axes.annotate(" 1x", (speed, 0.97), xycoords=("data", "axes fraction"), va="top", color=GREY)
        axes.set(xlabel="frequency [Hz]", ylabel=label, xlim=(0.0, 12.0 * speed))
        seen = amplitude[frequency <= 12.0 * speed]
        axes.set_ylim(max(float(seen.max()) * 1e-5, 0.3 * float(seen[1:].min())), 2.0 * float(seen.max()))
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure
