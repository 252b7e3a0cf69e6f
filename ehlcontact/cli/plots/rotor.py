"""The rotor under its unbalance, on full contacts against elements and what there is without them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, legend_above, new_figure
from reduced_models import RotorResult, Settling
from reduced_models.rotor.settled import part_of, steps_per_revolution

MICRO = "\N{MICRO SIGN}m"
# How each contact is drawn, wherever it is.
LOOKS: dict[str, dict[str, Any]] = {
    "full": {"color": BLUE, "linestyle": "-"},
    "rotor_band": {"color": RED, "linestyle": "--"},
    "memory": {"color": GREEN, "linestyle": "--"},
    "harmonic": {"color": ORANGE, "linestyle": "-."},
    "undamped": {"color": PURPLE, "linestyle": ":"},
    "dry": {"color": GREY, "linestyle": "-."},
}
MARKERS = {"full": "o", "rotor_band": "x", "dry": "s"}
DRAWN = ("full", "rotor_band", "dry")  # where all would be too many
HARMONICS = 12.0  # of the speed, that a spectrum shows
DEEPEST = 1e-5  # of its largest line, the smallest that it shows

Names = Mapping[str, str]


def settled_part(run: RotorResult, how: Settling) -> tuple[RotorResult, bool]:
    """The settled revolutions of a run and True, or its last revolution and False."""
    steps = steps_per_revolution(run)
    first = how.settled_from
    whole = (run.t.size - 1) // steps * steps
    begin = whole - steps if first is None else first * steps
    return part_of(run, begin, whole), first is not None


def orbit(runs: Mapping[str, RotorResult], how: Settling, names: Names) -> Figure:
    """Paths of disc and journal about their mean: the settled part heavy, what is before it thin.

    Of a rotor that moves only up and down, velocity against displacement.
    """
    figure = new_figure(4.4)
    full = runs["full"]
    planar = len(full.rotor.axes) == 2
    for axes, body in zip(figure.subplots(1, 2), ("disc", "journal"), strict=True):
        for name in DRAWN:
            if name in runs:
                _path(axes, runs[name], how, body, planar, {**LOOKS[name], "label": names[name]})
        axes.set(title=body, xlabel=f"x [{MICRO}]" if planar else f"displacement y [{MICRO}]")
        axes.set_ylabel(f"y [{MICRO}]" if planar else "velocity [mm/s]")
        if planar:
            axes.set_aspect("equal", adjustable="datalim")
        axes.margins(0.12)
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _path(axes: Axes, run: RotorResult, how: Settling, body: str, planar: bool, look: Mapping[str, Any]) -> None:
    settled, _ = settled_part(run, how)
    centre = getattr(settled, body)[1:].mean(axis=0)
    for part, width, alpha in ((run, 0.7, 0.45), (settled, None, 1.0)):
        path = (getattr(part, body) - centre) * 1e6
        x, y = path[:, 0], path[:, 1]
        if not planar:
            x, y = y, getattr(part, f"{body}_velocity")[:, 1] * 1e3
        shown = dict(look) if part is settled else {k: v for k, v in look.items() if k != "label"}
        axes.plot(x, y, **shown, linewidth=width, alpha=alpha)


def response(runs: Mapping[str, RotorResult], how: Settling, names: Names) -> Figure:
    """Journal displacement and force of contact 1 over time, and the differences of all reduced runs.

    Both about their mean: another place of rest is no other vibration. What is before the settled part is grey.
    """
    full = runs["full"]
    figure = new_figure(7.2)
    panels = figure.subplots(4, 1, sharex=True, height_ratios=(2, 1, 2, 1))
    t = full.t * 1e3
    signals = (
        ("journal y", MICRO, lambda run: (run.journal[:, 1] - run.journal[1:, 1].mean()) * 1e6),
        ("force 1", "N", lambda run: run.force[:, 0]),
    )
    for k, (name, unit, signal) in enumerate(signals):
        upper, lower = panels[2 * k], panels[2 * k + 1]
        for which, run in runs.items():
            if which in ("full", "rotor_band"):
                upper.plot(t, signal(run), **LOOKS[which], label=names[which])
            if which != "full":
                differ = signal(run) - signal(full)
                lower.plot(t, differ - differ[1:].mean(), **LOOKS[which], label=names[which], linewidth=1.2)
        upper.set_ylabel(f"{name} [{unit}]")
        lower.set_ylabel(f"difference\n[{unit}]")
        lower.axhline(0.0, color=GREY, linewidth=0.8)
    first = how.settled_from
    until = t[-1] if first is None else first * steps_per_revolution(full) * (t[1] - t[0])
    if until > 0.0:
        for axes in panels:
            axes.axvspan(t[0], until, color="#f2f2f2", zorder=0)
        where: dict[str, Any] = {"xycoords": ("data", "axes fraction"), "ha": "center"}
        panels[0].annotate("not settled", (0.5 * until, 0.05), color=GREY, **where)
    legend_above(panels[0])
    handles, labels = panels[1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    panels[-1].set(xlabel="time [ms]", xlim=(t[0], t[-1]))
    figure.align_ylabels()
    return figure


def spectrum(runs: Mapping[str, RotorResult], how: Settling, names: Names) -> Figure:
    """Amplitudes of disc displacement and contact force over whole revolutions, which need no window."""
    figure = new_figure(3.6)
    pairs = (
        (f"disc y [{MICRO}]", lambda run: run.disc[:, 1] * 1e6),
        ("force of contact 1 [N]", lambda run: run.force[:, 0]),
    )
    speed = runs["full"].rotor.speed_rpm / 60.0
    for axes, (label, signal) in zip(figure.subplots(1, 2), pairs, strict=True):
        highest = 0.0
        for name in DRAWN:
            if name not in runs:
                continue
            frequency, amplitude = lines(settled_part(runs[name], how)[0], signal)
            seen = frequency <= HARMONICS * speed
            look = {"color": LOOKS[name]["color"], "marker": MARKERS[name], "fillstyle": "none", "markersize": 6}
            axes.semilogy(frequency[seen], amplitude[seen], linestyle="none", **look, label=names[name])
            highest = max(highest, float(amplitude[seen].max()))
        axes.axvline(speed, color=GREY, linestyle=":")
        axes.annotate(" 1x", (speed, 0.97), xycoords=("data", "axes fraction"), va="top", color=GREY)
        axes.set(xlabel="frequency [Hz]", ylabel=label, xlim=(0.0, HARMONICS * speed))
        axes.set_ylim(DEEPEST * highest, 2.0 * highest)
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def lines(run: RotorResult, signal: Any) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz] above 0 and amplitudes of a signal over whole revolutions."""
    values = signal(run)[1:]
    amplitude = 2.0 / values.size * np.abs(np.fft.rfft(values))
    return np.fft.rfftfreq(values.size, float(run.t[1] - run.t[0]))[1:], amplitude[1:]
