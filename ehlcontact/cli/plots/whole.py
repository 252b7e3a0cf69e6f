"""The rotor on whole bearings: load zone, orbits, spectra, K and C over frequency, Campbell diagram.

`found` is what `cli.study.whole` found.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure

from ehlcontact.cli.plots.rotor import MICRO
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, RED, new_figure
from reduced_models.bearing.picture import draw_campbell, films, load_zone

LOOKS: dict[str, dict[str, Any]] = {
    "memory": {"color": BLUE, "linestyle": "-"},
    "dry": {"color": GREY, "linestyle": "-"},
    "constant": {"color": GREEN, "linestyle": "--"},
    "usual": {"color": RED, "linestyle": "-."},
}
ORDER = ("dry", "memory", "usual", "constant")  # in which they are drawn: lines over clouds
ORDERS = 12.0  # multiples of the speed, that a spectrum shows
DEEPEST = 1e-5  # of its largest line, the smallest that it shows
# Of the bearing at a speed: place of the panel, what, in what unit, its label.
COEFFICIENTS = ((3, "stiffness", 1e-6, f"stiffness [N/{MICRO}]"), (4, "damping", 1.0, "damping [N s/m]"))
TURNS = 5.0  # of the shaft, on the orbits

Names = Mapping[str, str]


def drawings(found: Any, names: Names) -> dict[str, Callable[[], Figure]]:
    """The figures by name, not drawn yet."""
    figures = {
        "whole_balls": lambda: balls(found),
        "whole_orbits": lambda: orbits(found, names),
        "whole_spectra": lambda: spectra(found, names),
        "whole_coefficients": lambda: coefficients(found, names),
        "whole_speeds": lambda: speeds(found),
        "whole_response": lambda: response(found, names),
    }
    if not isinstance(found.diagram, str):
        diagram = found.diagram
        figures["whole_campbell"] = lambda: draw_campbell(diagram, None)
    return figures


def balls(found: Any) -> Figure:
    """Load zone, and the smallest film under every ball."""
    figure = new_figure(4.6)
    load_zone(figure.add_subplot(1, 2, 1, projection="polar"), found.state)
    films(figure.add_subplot(1, 2, 2), found.state)
    return figure


def orbits(found: Any, names: Names) -> Figure:
    """Paths of the left ring and of the disc, each about its mean."""
    figure = new_figure(4.8)
    for axes, body in zip(figure.subplots(1, 2), ("ring", "disc"), strict=True):
        for name in [name for name in ORDER if name in found.ran]:
            run = found.ran[name]
            last = run.t >= run.t[-1] - TURNS * 60.0 / found.speed_rpm
            path = getattr(run, body)[last]
            x, y = ((path - path.mean(axis=0)) * 1e6).T
            axes.plot(x, y, **LOOKS[name], label=names[name], linewidth=1.0)
        axes.set(
            title="inner ring, left" if body == "ring" else body, xlabel=f"x [{MICRO}]", ylabel=f"y [{MICRO}]"
        )
        axes.set_aspect("equal", adjustable="datalim")
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def spectra(found: Any, names: Names) -> Figure:
    """Amplitudes of ring and disc up and down; dotted, the speed and the passage of the balls."""
    figure = new_figure(4.0)
    speed = found.speed_rpm / 60.0
    for axes, body in zip(figure.subplots(1, 2), ("ring", "disc"), strict=True):
        highest = 0.0
        for name in [name for name in ORDER if name in found.ran]:
            hz, size = lines(found.ran[name], body)
            shown = hz <= ORDERS * speed
            axes.semilogy(hz[shown], size[shown] * 1e6, **LOOKS[name], label=names[name], linewidth=1.0)
            highest = max(highest, float(size[shown].max()) * 1e6)
        for at, text in ((speed, " 1x"), (found.passage_hz, " ball passage")):
            axes.axvline(at, color=ORANGE, linestyle=":", linewidth=1.0)
            axes.annotate(text, (at, 0.97), xycoords=("data", "axes fraction"), va="top", color=ORANGE, fontsize=9)
        axes.set(title="inner ring, left" if body == "ring" else body, xlabel="frequency [Hz]")
        axes.set_ylabel(f"amplitude of y [{MICRO}]")
        axes.set_xlim(0.0, ORDERS * speed)
        if highest > 0.0:
            axes.set_ylim(DEEPEST * highest, 3.0 * highest)
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def lines(run: Any, body: str) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz] and amplitudes [m] of the height of ring or disc, through a Hann window."""
    y = getattr(run, body)[:, 1]
    window = np.hanning(y.size)
    size = 2.0 * np.abs(np.fft.rfft((y - y.mean()) * window)) / window.sum()
    return np.fft.rfftfreq(y.size, float(run.t[1] - run.t[0])), size


def coefficients(found: Any, names: Names) -> Figure:
    """K and C of a bearing over the frequency of the vibration, beside those that are constant."""
    figure = new_figure(3.8)
    at = found.over_frequency
    panels = figure.subplots(1, 2)
    for axes, name, unit, label in (
        (panels[0], "stiffness", 1e-6, f"stiffness [N/{MICRO}]"),
        (panels[1], "damping", 1.0, "damping [N s/m]"),
    ):
        axes.plot(at.hz, getattr(at, name)[:, 1, 1] * unit, color=BLUE, label="film memory, along the load")
        axes.plot(at.hz, getattr(at, name)[:, 0, 0] * unit, color=BLUE, linestyle=":", label="across it")
        for key, constant in found.constants.items():
            value = constant[0 if name == "stiffness" else 1] * unit
            axes.axhline(value, **LOOKS[key], linewidth=1.2, label=names[key])
        axes.axvline(found.speed_rpm / 60.0, color=ORANGE, linestyle=":", linewidth=1.0)
        axes.set_xscale("log")
        axes.set(xlabel="frequency of the vibration [Hz]", ylabel=label)
    panels[1].set_yscale("log")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def response(found: Any, names: Names) -> Figure:
    """Displacement of the disc over its eccentricity, over the frequency of the unbalance."""
    figure = new_figure(3.9)
    for k, (axes, way) in enumerate(
        zip(figure.subplots(1, 2, sharey=True), ("horizontal", "vertical"), strict=True)
    ):
        for name in [name for name in ORDER if name in found.responses]:
            axes.loglog(
                found.response_hz, found.responses[name][:, k], **LOOKS[name], label=names[name], linewidth=1.2
            )
        axes.set(title=f"disc, {way}", xlabel="frequency of the unbalance [Hz]")
        axes.margins(x=0.0)
    figure.axes[0].set_ylabel("displacement/eccentricity [-]")
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def at_speed(one: Any) -> Figure:
    """Load zone, films, stiffness and damping of the bearing at one speed."""
    figure = new_figure(7.4)
    load_zone(figure.add_subplot(2, 2, 1, projection="polar"), one.state)
    films(figure.add_subplot(2, 2, 2), one.state)
    for place, name, unit, label in COEFFICIENTS:
        axes = figure.add_subplot(2, 2, place)
        for k, which, look in ((1, "along the load", "-"), (0, "across it", ":")):
            axes.plot(one.small.hz, getattr(one.small, name)[:, k, k] * unit, look, color=GREEN, label=which)
        axes.set(xscale="log", yscale="log", xlabel="frequency of the vibration [Hz]", ylabel=label)
    return figure


def speeds(found: Any) -> Figure:
    """Smallest films of the balls, and K and C along the load, a line for each speed."""
    figure = new_figure(6.6)
    panels: Any = figure.subplots(2, 2)
    ends = 0.05, 0.85  # of the colours, the rest being too bright
    shades = colormaps["viridis"](np.linspace(*ends, max(len(found.over_speed), 2)))
    for one, shade in zip(found.over_speed, shades, strict=False):
        label, state = f"{one.state.speed_rpm:.0f} rpm", one.state
        place = np.degrees(
            (state.angles - np.arctan2(state.load[1], state.load[0]) + np.pi) % (2.0 * np.pi) - np.pi
        )
        order = np.argsort(place)
        for race, axes in enumerate(panels[0]):
            if state.h_min is not None:
                axes.semilogy(
                    place[order], state.h_min[order, race] * 1e6, "o-", color=shade, label=label, markersize=3
                )
        for axes, (_, name, unit, _) in zip(panels[1], COEFFICIENTS, strict=True):
            axes.loglog(one.small.hz, getattr(one.small, name)[:, 1, 1] * unit, color=shade)
    for axes, name in zip(panels[0], ("inner", "outer"), strict=True):
        axes.set(title=f"{name} race", xlabel="angle from the load [degrees]", ylabel=f"smallest film [{MICRO}]")
    for axes, (*_, label) in zip(panels[1], COEFFICIENTS, strict=True):
        axes.set(xlabel="frequency of the vibration [Hz]", ylabel=label)
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure
