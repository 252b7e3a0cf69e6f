"""Figures of rotors: orbits, spectra, waterfalls, Campbell diagram, unbalance response.

Matplotlib is imported where one is drawn.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from ehlcontact.results.picture import COLOURS, GRID, Panel, draw, written
from reduced_models.rotor.modes import ALONG

SIZE = (9.0, 4.4)  # inches
GREY, INNER, OUTER = "#7f7f7f", "#0072b2", "#e69f00"
LAST_TURNS = 20.0  # of the shaft, that orbits show
WINDOW, FEWEST = 2.0, 5  # length of the pieces of a waterfall, see there; and that many at least side by side
ROWS, SPREAD = 120, 4.0  # spectra of a waterfall; its colours: decades below the highest
BEYOND = 1.1  # where a waterfall ends, over the highest line in it
LINE = 0.045  # height of a name over that of the diagram
STRAIGHT = 0.1  # |whirl| below which a mode is called so
DECADES = 6.0  # that spectra show
MICRO = 1e6  # µm in a metre

_Ends = tuple[float | None, float]  # of the frequencies shown [Hz]: as asked for, and the usual one


def draw_run(
    run: Any,
    path: str | os.PathLike[str] | None,
    kind: str,
    most_hz: _Ends,
    shown: list[tuple[str, Any]],
) -> Any:
    """Orbits, spectra or waterfalls of motions of a `RotorResult` side by side, under their titles."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(max(4.6 * len(shown), SIZE[0]), SIZE[1]), layout="constrained")
    draw = {"orbit": _orbit, "spectrum": _spectrum, "waterfall": _waterfall}[kind]
    for k, (name, motion) in enumerate(shown):
        axes = figure.add_subplot(1, len(shown), k + 1)
        draw(axes, run, motion, most_hz, COLOURS[k % len(COLOURS)])
        axes.set_title(name, fontsize=10)
    low, high = float(run.speed_rpm.min()), float(run.speed_rpm.max())
    speed = f"{low:g} rev/min" if low == high else f"{low:g} to {high:g} rev/min"
    figure.suptitle(f"{kind}, {speed}")
    return written(figure, path)


def _orbit(axes: Any, run: Any, motion: Any, _: _Ends, colour: str) -> None:
    """Path over the last turns; a dot where it ends."""
    turned = (
        np.concatenate([[0.0], np.cumsum(0.5 * (run.speed_rpm[1:] + run.speed_rpm[:-1]) * np.diff(run.t))]) / 60.0
    )
    x, y = motion[turned >= turned[-1] - LAST_TURNS].T * MICRO
    axes.plot(x, y, color=colour, linewidth=0.7)
    axes.plot(x[-1], y[-1], "o", color="black", markersize=4)
    axes.set_aspect("equal", adjustable="datalim")
    axes.ticklabel_format(useOffset=False)
    axes.locator_params(nbins=6)
    axes.set_xlabel("x [µm]")
    axes.set_ylabel("y [µm]")
    axes.grid(**GRID)


def amplitudes(signal: Any, dt: float) -> tuple[Any, Any]:
    """Frequencies [Hz] and amplitudes of the lines, by a Hann window; the mean is left out."""
    window = np.hanning(signal.size)
    lines = 2.0 * np.abs(np.fft.rfft((signal - signal.mean()) * window)) / window.sum()
    return np.fft.rfftfreq(signal.size, dt), lines


def _spectrum(axes: Any, run: Any, motion: Any, ends: _Ends, _: str) -> None:
    """Amplitudes of the second half of a run, when its start is forgotten."""
    most_hz = ends[0] or ends[1]
    half, dt = run.t.size // 2, float(run.t[1] - run.t[0])
    for k, (name, colour) in enumerate((("x", OUTER), ("y", INNER))):
        hz, lines = amplitudes(motion[half:, k], dt)
        shown = (hz > 0.0) & (hz <= most_hz)
        axes.semilogy(hz[shown], lines[shown] * MICRO, color=colour, linewidth=0.9, label=name)
    top = 2.0 * max(float(line.get_ydata().max()) for line in axes.lines)
    if top > 0.0:
        axes.set_ylim(top / 10.0**DECADES, top)
    axes.set_xlim(0.0, most_hz)
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("amplitude [µm]")
    axes.grid(**GRID)
    axes.legend(frameon=False, fontsize=8)


def _waterfall(axes: Any, run: Any, motion: Any, ends: _Ends, _: str) -> None:
    """Spectra of y piece by piece, over the time, or over the speed where it changes one way."""
    dt, count = float(run.t[1] - run.t[0]), run.t.size
    # a line that moves by r Hz/s is sharpest in pieces of 1/sqrt(r) s; the window sees half of one
    rate = np.ptp(run.speed_rpm) / 60.0 / (dt * count)
    piece = min(int(WINDOW / np.sqrt(rate) / dt), count // FEWEST) if rate > 0.0 else count // FEWEST
    piece = max(piece, min(16, count))
    starts = np.unique(np.linspace(0, max(count - piece, 0), ROWS).astype(int))
    middle = np.minimum(starts + piece // 2, count - 1)
    rows = [amplitudes(motion[start : start + piece, 1], dt) for start in starts.tolist()]
    hz = rows[0][0]
    shown = hz <= (ends[0] or ends[1])
    level = np.log10(np.array([row[1][shown] for row in rows]) * MICRO + 1e-12)
    rises = np.diff(run.speed_rpm)
    over_speed = bool(rises.any() and (np.all(rises >= 0.0) or np.all(rises <= 0.0)))
    over = run.speed_rpm[middle] if over_speed else run.t[middle]
    most = float(level.max())
    mesh = axes.pcolormesh(
        hz[shown], over, level, vmin=most - SPREAD, vmax=most, cmap="viridis", shading="nearest", rasterized=True
    )
    axes.figure.colorbar(mesh, ax=axes, label="lg(amplitude of y / µm)")
    axes.plot(run.speed_rpm[middle] / 60.0, over, color="white", linewidth=0.8, linestyle="--")
    axes.annotate(
        "1x",
        xy=(run.speed_rpm[middle][-1] / 60.0, over[-1]),
        xytext=(3, -10),
        textcoords="offset points",
        color="white",
        fontsize=8,
    )
    seen = hz[shown][(level > most - SPREAD).any(axis=0)]
    turning = float(run.speed_rpm.max()) / 60.0
    last = hz[shown][-1]
    axes.set_xlim(0.0, last if ends[0] else min(last, BEYOND * max(float(seen.max()), turning)))
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("speed [rev/min]" if over_speed else "time [s]")


def draw_campbell(campbell: Any, path: str | os.PathLike[str] | None) -> Any:
    """Frequencies over the speed with the critical speeds, above the decrements."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(SIZE[0], 1.4 * SIZE[1]), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    rpm, hz = campbell.speed_rpm, campbell.hz
    for k in range(hz.shape[1]):
        colour, style = COLOURS[k % len(COLOURS)], ("-", "--", ":")[k // len(COLOURS) % 3]
        above.plot(rpm, hz[:, k], style, color=colour, linewidth=1.3)
        below.plot(rpm, campbell.decrement[:, k], style, color=colour, linewidth=1.3)
    above.plot(rpm, rpm / 60.0, color=GREY, linewidth=1.0, linestyle="-.", label="1x")
    critical = campbell.critical_speeds() if len(campbell.speed_rpm) > 1 else ()
    if critical:
        points = [one.speed_rpm for one in critical], [one.hz for one in critical]
        above.plot(*points, "o", color="black", markersize=5, fillstyle="none", label="critical speeds")
    most = 1.08 * float(hz.max())
    above.set_ylim(0.0, most)
    _name_modes(above, campbell, most)
    above.set_ylabel("damped frequency [Hz]")
    above.legend(fontsize=8, loc="best", edgecolor="none")
    below.set_yscale("log" if campbell.decrement.min() > 0.0 else "linear")
    below.set_ylabel("decrement")
    below.set_xlabel("speed [rev/min]")
    for axes in (above, below):
        axes.margins(x=0.0)
        axes.grid(**GRID)
    figure.suptitle("Campbell diagram")
    return written(figure, path)


def _name_modes(axes: Any, campbell: Any, most: float) -> None:
    """Names at the ends of the lines, one above the other where lines end together."""
    ends, last = campbell.hz[-1] / most, -1.0
    for k in np.argsort(ends).tolist():
        last = max(float(ends[k]), last + LINE)
        axes.annotate(
            f"{k + 1} {mode_name(campbell, k)}",
            xy=(1.01, last),
            xycoords="axes fraction",
            va="center",
            fontsize=8,
            color=COLOURS[k % len(COLOURS)],
        )


def mode_name(campbell: Any, k: int) -> str:
    """Axial, forward, backward or straight: mode `k` of the diagram at the highest speed."""
    whirl = float(campbell.whirl[-1, k])
    if campbell.axial_share[-1, k] > ALONG:
        return "axial"
    if abs(whirl) < STRAIGHT:
        return "straight"
    return "forward" if whirl > 0.0 else "backward"


def _place(response: Any, k: int) -> str:
    x, y = response.nodes[k].tolist()
    name = response.names[k] if response.names else ""
    return name or f"degrees of freedom {x}, {y}"


def draw_unbalance(response: Any, path: str | os.PathLike[str] | None) -> Any:
    """Largest displacement on the orbit of every node over the speed, and phases of x."""
    speed = response.speed_rpm, ("speed", "rev/min")
    names = [_place(response, k) for k in range(len(response.nodes))]
    across = np.where(response.nodes[:, 0] < 0, response.nodes[:, 1], response.nodes[:, 0])  # y where x is held
    phases = np.degrees(np.unwrap(np.angle(response.amplitude[:, across]), axis=0))
    half_axes = [(name, response.major[:, k], None) for k, name in enumerate(names)]
    behind = [(name, phases[:, k], None) for k, name in enumerate(names)]
    panels = (
        Panel(speed, half_axes, ("semi-major axis of the orbit", "m"), "y"),
        Panel(speed, behind, "phase of x [degrees]"),
    )
    return draw("unbalance response", panels, path)
