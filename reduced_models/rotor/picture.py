"""Pictures of rotors: orbits, spectra, waterfalls, Campbell diagram, unbalance response."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ehlcontact.results.picture import (
    BLUE,
    COLOURS,
    DASHES,
    GREY,
    INK,
    ORANGE,
    PASTELS,
    WHITE,
    AnyPanel,
    Label,
    Line,
    Map,
    Mark,
    Panel,
    Picture,
)
from reduced_models.rotor.modes import ALONG

LAST_TURNS = 20.0  # of the shaft, that orbits show
WINDOW, FEWEST = 2.0, 5  # length of the pieces of a waterfall, see there; and that many at least side by side
ROWS, SPREAD = 120, 4.0  # spectra of a waterfall; its colours: decades below the highest
BEYOND = 1.1  # where a waterfall ends, over the highest line in it
STRAIGHT = 0.1  # |whirl| below which a mode is called so
DECADES = 6.0  # that spectra show
MICRO = 1e6  # µm in a metre
RESPONSE = "displacement/eccentricity"
SPEED = "speed", "rev/min"
QUOTE = "'"
STACKED = *COLOURS, GREY, *PASTELS, INK  # of the parts of a stack

_Ends = tuple[float | None, float]  # of the frequencies shown [Hz]: as asked for, and the usual one


def run_picture(run: Any, kind: str, most_hz: _Ends, shown: Sequence[tuple[str, Any]]) -> Picture:
    """Orbits, spectra or waterfalls of motions of a `RotorResult` side by side, under their titles."""
    describe: Any = {"orbit": _orbit, "spectrum": _spectrum, "waterfall": _waterfall}[kind]
    panels: list[AnyPanel] = [
        describe(run, motion, name, most_hz, COLOURS[k % len(COLOURS)]) for k, (name, motion) in enumerate(shown)
    ]
    low, high = float(run.speed_rpm.min()), float(run.speed_rpm.max())
    speed = f"{low:g} rev/min" if low == high else f"{low:g} to {high:g} rev/min"
    return Picture(panels, f"{kind}, {speed}", columns=max(len(shown), 1), heights=(330.0,))


def _orbit(run: Any, motion: Any, name: str, _: _Ends, colour: str) -> Panel:
    """Path over the last turns; a dot where it ends."""
    turned = (
        np.concatenate([[0.0], np.cumsum(0.5 * (run.speed_rpm[1:] + run.speed_rpm[:-1]) * np.diff(run.t))]) / 60.0
    )
    x, y = motion[turned >= turned[-1] - LAST_TURNS].T
    return orbit_panel([Line(x, y, "", colour, width=0.8), Line(x[-1:], y[-1:], "", INK, "", "o")], name)


def orbit_panel(lines: Sequence[Line], title: str, labels: tuple[Label, Label] | None = None) -> Panel:
    """Paths in the plane across the shaft; with `labels` of other axes those need not have one scale."""
    x, y = (("x", "m"), ("y", "m")) if labels is None else labels
    return Panel(lines, x, y, title=title, equal=labels is None)


def amplitudes(signal: Any, dt: float) -> tuple[Any, Any]:
    """Frequencies [Hz] and amplitudes of the lines, by a Hann window; the mean is left out."""
    window = np.hanning(signal.size)
    lines = 2.0 * np.abs(np.fft.rfft((signal - signal.mean()) * window)) / window.sum()
    return np.fft.rfftfreq(signal.size, dt), lines


def _spectrum(run: Any, motion: Any, name: str, ends: _Ends, _: str) -> Panel:
    """Amplitudes of the second half of a run, when its start is forgotten."""
    half, dt = run.t.size // 2, float(run.t[1] - run.t[0])
    lines = [
        Line(*amplitudes(motion[half:, k], dt), axis, colour, width=1.0)
        for k, (axis, colour) in enumerate((("x", ORANGE), ("y", BLUE)))
    ]
    return spectrum_panel(lines, ends[0] or ends[1], title=name)


def spectrum_panel(
    lines: Iterable[Line],
    most_hz: float,
    label: Label = ("amplitude", "m"),
    *,
    decades: float = DECADES,
    title: str = "",
    marks: Sequence[Mark] = (),
) -> Panel:
    """Amplitudes over frequencies above 0, those of the highest line and so many decades below it."""
    kept = []
    for line in lines:
        x, y = np.asarray(line.x), np.asarray(line.y)
        shown = (x > 0.0) & (x <= most_hz)
        kept.append(Line(x[shown], y[shown], line.name, line.colour, line.dash, line.mark, line.width))
    top = 2.0 * max((float(line.y.max(initial=0.0)) for line in kept), default=0.0)
    return Panel(
        kept,
        ("frequency", "Hz"),
        label,
        title=title,
        logs="Y" if top > 0.0 else "",
        x_ends=(0.0, most_hz),
        y_ends=(top / 10.0**decades, top) if top > 0.0 else None,
        marks=marks,
    )


def _waterfall(run: Any, motion: Any, name: str, ends: _Ends, _: str) -> Map:
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
    over, label = (run.speed_rpm[middle], SPEED) if over_speed else (run.t[middle], "time [s]")
    once = run.speed_rpm[middle] / 60.0
    if over[-1] < over[0]:
        over, level, once = over[::-1], level[::-1], once[::-1]
    most = float(level.max())
    seen = hz[shown][(level > most - SPREAD).any(axis=0)]
    turning = float(run.speed_rpm.max()) / 60.0
    last = float(hz[shown][-1])
    last = last if ends[0] else min(last, BEYOND * max(float(seen.max()), turning))
    return Map(
        (hz[shown], ("frequency", "Hz")),
        (over, label),
        (level.T, "lg(amplitude of y / µm)"),
        title=name,
        limits=(most - SPREAD, most),
        colours="viridis",
        view=((0.0, last), (float(over[0]), float(over[-1]))),
        lines=[Line(once, over, "1x", WHITE, "--", width=0.8)],
    )


def campbell_picture(campbell: Any) -> Picture:
    """Frequencies over the speed with the critical speeds, above the decrements."""
    rpm, hz = campbell.speed_rpm, campbell.hz
    modes = [
        (f"{k + 1} {mode_name(campbell, k)}", COLOURS[k % len(COLOURS)], DASHES[k // len(COLOURS) % len(DASHES)])
        for k in range(hz.shape[1])
    ]
    above = [Line(rpm, hz[:, k], *mode) for k, mode in enumerate(modes)]
    above.append(Line(rpm, rpm / 60.0, "1x", GREY, "-.", width=1.0))
    critical = campbell.critical_speeds() if len(rpm) > 1 else ()
    if critical:
        at = [one.speed_rpm for one in critical], [one.hz for one in critical]
        above.append(Line(*at, "critical speeds", INK, "", "o "))
    below = [Line(rpm, campbell.decrement[:, k], *mode) for k, mode in enumerate(modes)]
    ends = (float(rpm.min()), float(rpm.max())) if len(rpm) > 1 else None
    most = 1.08 * float(hz.max())
    panels = (
        Panel(above, SPEED, ("damped frequency", "Hz"), x_ends=ends, y_ends=(0.0, most), named_at_ends=True),
        Panel(below, SPEED, "decrement", x_ends=ends, logs="y", named_at_ends=True),
    )
    return Picture(panels, "Campbell diagram", columns=1, heights=(330.0, 180.0), shared=True)


def mode_name(campbell: Any, k: int) -> str:
    """Axial, forward, backward or in a plane: mode `k` of the diagram at the highest speed."""
    whirl = float(campbell.whirl[-1, k])
    if campbell.axial_share[-1, k] > ALONG:
        return "axial"
    if abs(whirl) < STRAIGHT:
        return "in a plane"
    return "forward" if whirl > 0.0 else "backward"


def unbalance_picture(response: Any) -> Picture:
    """Largest displacement on the orbit of every node over the speed, and phases of x."""
    names = [_place(response, k) for k in range(len(response.nodes))]
    across = np.where(response.nodes[:, 0] < 0, response.nodes[:, 1], response.nodes[:, 0])  # y where x is held
    phases = np.unwrap(np.angle(response.amplitude[:, across]), axis=0)
    panels = [
        Panel(
            [Line(response.speed_rpm, values[:, k], name) for k, name in enumerate(names)], SPEED, label, logs=logs
        )
        for values, label, logs in (
            (response.major, ("semi-major axis of the orbit", "m"), "y"),
            (phases, ("phase of x", "rad"), ""),
        )
    ]
    return Picture(panels, "unbalance response")


def _place(response: Any, k: int) -> str:
    x, y = response.nodes[k].tolist()
    name = response.names[k] if response.names else ""
    return name or f"degrees of freedom {x}, {y}"


def shares_picture(parts: Sequence[str], share: Any, columns: tuple[str, ...], label: Label) -> Picture:
    """Stacked bars: share of every part, shape (parts, columns); what feeds vibration hangs below zero."""
    # bars over one word would be one
    places = [f"{word}{QUOTE * columns[:k].count(word)}" for k, word in enumerate(columns)]
    above, below = np.zeros((2, len(places)))
    lines = []
    for k, (part, row) in enumerate(zip(parts, 100.0 * share, strict=True)):
        base = np.where(row >= 0.0, above, below)
        lines.append(Line(places, row, part, STACKED[k % len(STACKED)], base=base))
        above, below = above + np.maximum(row, 0.0), below + np.minimum(row, 0.0)
    panel = Panel(lines, label, "share of the damping [%]")
    return Picture([panel], "who damps what", heights=(380.0,))
