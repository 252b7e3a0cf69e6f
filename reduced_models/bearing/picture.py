"""Figures of bearings. Matplotlib is imported where one is drawn."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from ehlcontact.results.picture import COLOURS, GRID, written

INNER, OUTER, LOAD, GREY = "#0072b2", "#e69f00", "#d55e00", "#7f7f7f"  # Okabe and Ito, for colour-blind eyes
SIZE = (9.0, 4.4)  # inches
BAR = 0.5  # width of a bar over the angle between two balls
ROOM = 1.25  # radius of the load zone over its longest bar
LAST_TURNS = 20.0  # of the shaft, that orbits show
WINDOW, FEWEST = 2.0, 5  # length of the pieces of a waterfall, see there; and that many at least side by side
ROWS, SPREAD = 120, 4.0  # spectra of a waterfall; its colours: decades below the highest
BEYOND = 1.1  # where a waterfall ends, over the highest line in it
LINE = 0.045  # height of a name over that of the diagram
STRAIGHT = 0.1  # |whirl| below which a mode is called so
DECADES = 6.0  # that spectra show
MICRO = 1e6  # um in a metre

_Ends = tuple[float | None, float]  # of the frequencies shown [Hz]: as asked for, and the usual one


def draw_state(state: Any, path: str | os.PathLike[str] | None = None) -> Any:
    """Load zone of a `BearingState` beside the films of every ball; the file's ending gives its format."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE, layout="constrained")
    zone = figure.add_subplot(1, 2, 1, projection="polar")
    load_zone(zone, state)
    beside = figure.add_subplot(1, 2, 2)
    films(beside, state)
    speed = f"{state.speed_rpm:g} rev/min" if state.speed_rpm else "at rest"
    torque = state.rolling_torque
    resists = "" if torque is None else f"; films resist rolling by {torque * 1e3:.3g} N mm"
    figure.suptitle(f"{state.name or 'ball bearing'}, {np.hypot(*state.load):.4g} N, {speed}{resists}")
    return written(figure, path)


def draw_over_speed(
    state: Any, points: Sequence[Any], curve: Sequence[Any], path: str | os.PathLike[str] | None = None
) -> Any:
    """Load zone and films at one speed, above K and C over speed.

    Parameters
    ----------
    state : BearingState
    points, curve : sequence of BearingCoefficients
        Shown as points and as lines, each at its first frequency.
    path : path, optional
        The file's ending gives its format.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(SIZE[0], 1.7 * SIZE[1]), layout="constrained")
    load_zone(figure.add_subplot(2, 2, 1, projection="polar"), state)
    films(figure.add_subplot(2, 2, 2), state)
    for place, name, unit, label in (
        (3, "stiffness", 1e-6, "stiffness [N/µm]"),
        (4, "damping", 1.0, "damping [N s/m]"),
    ):
        axes = figure.add_subplot(2, 2, place)
        for k, colour, direction in ((1, LOAD, "along the load"), (0, INNER, "across it")):
            for found, look in ((curve, "-"), (points, "o")):
                speeds, values = (
                    [at.speed_rpm for at in found],
                    [getattr(at, name)[0, k, k] * unit for at in found],
                )
                axes.plot(speeds, values, look, color=colour, label=direction if look == "-" else None)
        axes.set(xlabel="speed [rev/min]", title=f"{label}, at the frequency of the shaft")
        axes.set_ylim(0.0, max(1.05 * axes.get_ylim()[1], 1.0))  # a dry bearing damps nothing
        axes.grid(**GRID)
        axes.legend(frameon=False, fontsize=8)
    load, at = np.hypot(*state.load), f"above at {state.speed_rpm:g} rev/min, a ball under the load"
    figure.suptitle(f"{state.name or 'ball bearing'}, {load:.4g} N; {at}")
    return written(figure, path)


def load_zone(axes: Any, state: Any) -> None:
    """Force of every ball, outward from the centre, and the load."""
    width = BAR * 2.0 * np.pi / state.angles.size
    most = float(state.force.max())
    axes.bar(state.angles, state.force[:, 1], width=width, color=OUTER, label="outer race")
    axes.bar(state.angles, state.force[:, 0], width=0.6 * width, color=INNER, label="inner race")
    axes.set_rlim(0.0, ROOM * most)
    axes.set_rlabel_position(_free_angle(state))
    axes.grid(**GRID)
    axes.set_axisbelow(True)
    if state.load.any():
        angle = float(np.arctan2(state.load[1], state.load[0]))
        arrow = {"arrowstyle": "-|>", "color": LOAD, "linewidth": 1.6}
        axes.annotate("", xy=(angle, 1.22 * most), xytext=(angle, 1.02 * most), arrowprops=arrow)
    axes.set_title("force on the balls [N]")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.06), ncols=2, frameon=False, fontsize=8)


def _free_angle(state: Any) -> float:
    """Direction [degrees] for the numbers, away from the load and between two balls."""
    away = np.angle(-np.exp(1j * np.arctan2(state.load[1], state.load[0])))
    gaps = np.exp(1j * (state.angles + np.pi / state.angles.size))
    return float(np.degrees(np.angle(gaps[np.argmax((gaps * np.exp(-1j * away)).real)])))


def from_load(state: Any) -> Any:
    """Angles of the balls from the direction of the load [degrees], from -180 to 180."""
    turned = state.angles - np.arctan2(state.load[1], state.load[0])
    return np.degrees((turned + np.pi) % (2.0 * np.pi) - np.pi)


def films(axes: Any, state: Any) -> None:
    """Smallest film of every ball over its place, or the approaches of a dry bearing."""
    turned = from_load(state)
    order = np.argsort(turned)
    if state.h_min is None:
        shown, title = state.approach * 1e6, "approach of the surfaces [µm]; below 0 a gap"
    else:
        shown, title = state.h_min * 1e6, "smallest film [µm]"
        axes.set_yscale("log")
    for column, (race, colour) in enumerate((("inner race", INNER), ("outer race", OUTER))):
        axes.plot(turned[order], shown[order, column], "o-", color=colour, label=race)
    axes.set_title(title)
    axes.set_xlabel("angle from the load [degrees]")
    axes.set_xticks(np.arange(-180, 181, 60))
    axes.grid(**GRID)
    if state.lambda_ratio is not None and state.h_min is not None:
        least = float(np.nanmin(state.lambda_ratio))
        roughness = float(state.h_min.flat[0] / state.lambda_ratio.flat[0])
        axes.axhline(roughness * 1e6, color=GREY, linewidth=1.0, linestyle="--")
        axes.annotate(
            f"composite roughness; least lambda {least:.3g}",
            xy=(0.02, roughness * 1e6),
            xycoords=("axes fraction", "data"),
            va="bottom",
            fontsize=8,
            color=GREY,
        )
    axes.legend(frameon=False, fontsize=8)


def draw_run(
    run: Any,
    path: str | os.PathLike[str] | None,
    kind: str,
    most_hz: _Ends,
    shown: list[tuple[str, Any]],
) -> Any:
    """Orbits, spectra or waterfalls of motions of a `BearingRun` side by side, under their titles."""
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


def _amplitudes(signal: Any, dt: float) -> tuple[Any, Any]:
    """Frequencies [Hz] and amplitudes of the lines, by a Hann window; the mean is left out."""
    window = np.hanning(signal.size)
    lines = 2.0 * np.abs(np.fft.rfft((signal - signal.mean()) * window)) / window.sum()
    return np.fft.rfftfreq(signal.size, dt), lines


def _spectrum(axes: Any, run: Any, motion: Any, ends: _Ends, _: str) -> None:
    """Amplitudes of the second half of a run, when its start is forgotten."""
    most_hz = ends[0] or ends[1]
    half, dt = run.t.size // 2, float(run.t[1] - run.t[0])
    for k, (name, colour) in enumerate((("x", OUTER), ("y", INNER))):
        hz, lines = _amplitudes(motion[half:, k], dt)
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
    rows = [_amplitudes(motion[start : start + piece, 1], dt) for start in starts.tolist()]
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
        at = [one.speed_rpm for one in critical], [one.hz for one in critical]
        above.plot(*at, "o", color="black", markersize=5, fillstyle="none", label="critical speeds")
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
            f"{k + 1} {_whirl(float(campbell.whirl[-1, k]))}",
            xy=(1.01, last),
            xycoords="axes fraction",
            va="center",
            fontsize=8,
            color=COLOURS[k % len(COLOURS)],
        )


def _whirl(whirl: float) -> str:
    if abs(whirl) < STRAIGHT:
        return "straight"
    return "forward" if whirl > 0.0 else "backward"


def _place(response: Any, k: int) -> str:
    x, y = response.nodes[k].tolist()
    name = response.names[k] if response.names else ""
    return name or f"degrees of freedom {x}, {y}"


def draw_unbalance(response: Any, path: str | os.PathLike[str] | None) -> Any:
    """Largest displacement on the orbit of every node over the speed, and phases of x below."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(SIZE[0], 1.4 * SIZE[1]), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    rpm, major = response.speed_rpm, response.major
    for k, x in enumerate(response.nodes[:, 0].tolist()):
        colour, style = COLOURS[k % len(COLOURS)], ("-", "--", ":")[k % 3]
        above.semilogy(rpm, major[:, k] * MICRO, style, color=colour, linewidth=1.3, label=_place(response, k))
        phase = np.degrees(np.unwrap(np.angle(response.amplitude[:, x])))
        below.plot(rpm, phase, style, color=colour, linewidth=1.3)
    above.set_ylabel("half axis of the orbit [µm]")
    above.legend(frameon=False, fontsize=8)
    below.set_ylabel("phase of x [degrees]")
    below.set_xlabel("speed [rev/min]")
    for axes in (above, below):
        axes.margins(x=0.0)
        axes.grid(**GRID)
    figure.suptitle("unbalance response")
    return written(figure, path)
