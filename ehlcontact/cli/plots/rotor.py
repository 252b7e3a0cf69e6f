"""The rotor on its contacts: orbits, time response, spectra, free decay, unbalance over frequency."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, grid, label_axes, shaded, vertical
from reduced_models.rotor.decay import Decrement
from reduced_models.rotor.resonance import Resonances
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.settling import Settling, steps_per_revolution

MICRO = "\N{MICRO SIGN}m"
# How each contact is drawn, wherever it is.
LOOKS: dict[str, dict[str, Any]] = {
    "full": {"color": BLUE},
    "rotor_band": {"color": RED, "dash": "dash"},
    "memory": {"color": GREEN, "dash": "dash"},
    "harmonic": {"color": ORANGE, "dash": "dashdot"},
    "undamped": {"color": PURPLE, "dash": "dot"},
    "dry": {"color": GREY, "dash": "dashdot"},
}
MARKERS = {"full": "circle-open", "rotor_band": "x-thin-open", "dry": "square-open"}
DRAWN = ("full", "rotor_band", "dry")  # where all would be too many
HARMONICS = 12.0  # of the speed, that a spectrum shows
DEEPEST = 1e-5  # of its largest line, the smallest that it shows
DIRECTIONS = {"x": "horizontal", "y": "vertical"}

Names = Mapping[str, str]


def settled_part(run: RotorResult, how: Settling) -> tuple[RotorResult, bool]:
    """The settled revolutions of a run and True, or its last revolution and False."""
    steps = steps_per_revolution(run)
    first = how.settled_from
    whole = (run.t.size - 1) // steps * steps
    begin = whole - steps if first is None else first * steps
    return run.part(begin, whole), first is not None


def orbit(runs: Mapping[str, RotorResult], how: Settling, names: Names) -> go.Figure:
    """Paths of disc and journal about their mean: the settled part heavy, what is before it thin.

    Of a rotor that moves only up and down, velocity against displacement.
    """
    planar = "x" in runs["full"].nodes["disc"]
    figure = grid(1, 2, heights=[360], titles=["disc", "journal"])
    labels = (f"x [{MICRO}]", f"y [{MICRO}]") if planar else (f"displacement y [{MICRO}]", "velocity [mm/s]")
    for col, body in ((1, "disc"), (2, "journal")):
        for name in [name for name in DRAWN if name in runs]:
            settled, _ = settled_part(runs[name], how)
            centre = getattr(settled, body)[1:].mean(axis=0)
            for part, look in ((runs[name], {"width": 1.0}), (settled, {"width": 2.0})):
                x, y = _path(part, body, centre, planar)
                options = {"name": names[name], "opacity": 1.0 if part is settled else 0.45}
                figure.add_scatter(x=x, y=y, line={**LOOKS[name], **look}, **options, row=1, col=col)
        label_axes(figure, *labels, 1, col)
    return equal(figure) if planar else figure


def equal(figure: go.Figure) -> go.Figure:
    """The figure with the same scale along x and y in every panel."""
    for x, y in zip(figure.select_xaxes(), figure.select_yaxes(), strict=True):
        y.update(scaleanchor=x.plotly_name.replace("axis", ""))
    return figure


def _path(run: RotorResult, body: str, centre: NDArray[np.float64], planar: bool) -> tuple[Any, Any]:
    """Displacements [um] about a centre, or that up and down and its velocity [mm/s]."""
    x, y = ((getattr(run, body) - centre) * 1e6).T
    return (x, y) if planar else (y, getattr(run, f"{body}_velocity")[:, 1] * 1e3)


def response(runs: Mapping[str, RotorResult], how: Settling, names: Names) -> go.Figure:
    """Journal displacement and force of contact 0 over time, and the differences of all reduced runs.

    Both about their mean: another place of rest is no other vibration. What is before the settled part is grey.
    """
    full = runs["full"]
    figure = grid(4, heights=[170, 125, 170, 125], shared=True)
    t = full.t * 1e3
    signals = (
        ("journal y", MICRO, lambda run: (run.journal[:, 1] - run.journal[1:, 1].mean()) * 1e6),
        ("force 0", "N", lambda run: run.force[:, 0]),
    )
    for row, (name, unit, signal) in zip((1, 3), signals, strict=True):
        for which, run in runs.items():
            look = {"name": names[which], "line": LOOKS[which], "col": 1}
            if which in ("full", "rotor_band"):
                figure.add_scatter(x=t, y=signal(run), **look, row=row)
            if which != "full":
                differ = signal(run) - signal(full)
                figure.add_scatter(x=t, y=differ - differ[1:].mean(), **look, row=row + 1)
        label_axes(figure, "", f"{name} [{unit}]", row)
        label_axes(figure, "time [ms]" if row == 3 else "", f"difference [{unit}]", row + 1)
    first = how.settled_from
    until = t[-1] if first is None else first * steps_per_revolution(full) * (t[1] - t[0])
    if until > 0.0:
        for row in range(1, 5):
            shaded(figure, (t[0], until), "not settled" if row == 1 else "", row)
    figure.update_xaxes(range=[t[0], t[-1]])
    return figure


def spectrum(runs: Mapping[str, RotorResult], how: Settling, names: Names) -> go.Figure:
    """Amplitudes of disc displacement and contact force over whole revolutions, which need no window."""
    figure = grid(1, 2, heights=[270])
    pairs = (
        (f"disc y [{MICRO}]", lambda run: run.disc[:, 1] * 1e6),
        ("force of contact 0 [N]", lambda run: run.force[:, 0]),
    )
    speed = float(runs["full"].speed_rpm[0]) / 60.0
    for col, (label, signal) in enumerate(pairs, start=1):
        highest = 0.0
        for name in [name for name in DRAWN if name in runs]:
            frequency, amplitude = spectrum_lines(settled_part(runs[name], how)[0], signal)
            seen = frequency <= HARMONICS * speed
            marker = {"symbol": MARKERS[name], "size": 8, "color": LOOKS[name]["color"], "line": {"width": 1.5}}
            look = {"mode": "markers", "marker": marker, "name": names[name]}
            figure.add_scatter(x=frequency[seen], y=amplitude[seen], **look, row=1, col=col)
            highest = max(highest, float(amplitude[seen].max()))
        ends = [float(np.log10(share * highest)) for share in (DEEPEST, 2.0)]
        label_axes(figure, "frequency [Hz]", label, 1, col, type="log", range=ends)
        figure.update_xaxes(range=[0.0, HARMONICS * speed], row=1, col=col)
        vertical(figure, speed, "1x", 1, col)
    return figure


def spectrum_lines(run: RotorResult, signal: Any) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz] above 0 and amplitudes of a signal over whole revolutions."""
    values = signal(run)[1:]
    amplitude = 2.0 / values.size * np.abs(np.fft.rfft(values))
    return np.fft.rfftfreq(values.size, float(run.t[1] - run.t[0]))[1:], amplitude[1:]


def decay(runs: Mapping[str, RotorResult], decrements: Mapping[str, Decrement], names: Names) -> go.Figure:
    """Height of the journal about its rest over time, and the logarithm of the amplitudes that were fitted."""
    figure = grid(2, heights=[230, 170])
    for name, run in runs.items():
        found = decrements[name]
        label = f"{names[name]}: decrement {numeral(found.decrement, 3)}"
        if name in DRAWN:
            y = (run.journal[:, 1] - run.journal[0, 1]) * 1e6
            figure.add_scatter(x=run.t * 1e3, y=y, name=label, line=LOOKS[name], row=1, col=1)
        periods = np.array([0.0, found.periods])
        figure.add_scatter(x=periods, y=-found.decrement * periods, name=label, line=LOOKS[name], row=2, col=1)
    label_axes(figure, "time [ms]", f"journal y about rest [{MICRO}]")
    label_axes(figure, "period of those fitted", "ln(amplitude/first)", 2)
    figure.update_xaxes(range=[0.0, 1e3 * float(run.t[-1])], row=1)
    figure.update_xaxes(range=[0.0, float(min(found.periods for found in decrements.values()))], row=2)
    return figure


def bode(responses: Resonances, names: Names) -> go.Figure:
    """Amplification and phase of the disc under unbalance, by direction, each over its span of frequency [Hz]."""
    hz, curves, spans = responses.hz, responses.curves, responses.spans
    titles = [f"disc, {DIRECTIONS[direction]}" for direction in curves]
    figure = grid(2, len(curves), heights=[240, 150], titles=titles, shared=True)
    for col, (direction, found) in enumerate(curves.items(), start=1):
        low, high = spans[direction]
        shown = (hz >= low) & (hz <= high)
        for name, whole in found.items():
            curve, look = whole[shown], {"name": names[name], "line": LOOKS[name], "col": col}
            figure.add_scatter(x=hz[shown], y=np.abs(curve), **look, row=1)
            # behind the force of the unbalance, which in y comes a quarter of a turn after that in x
            behind = np.angle(curve * (1j if direction == "y" else 1.0), deg=True)
            figure.add_scatter(x=hz[shown], y=np.where(behind > 90.0, behind - 360.0, behind), **look, row=2)
        label_axes(figure, "", "displacement/eccentricity [-]", 1, col, type="log")
        label_axes(figure, "frequency of the unbalance [Hz]", "phase [deg]", 2, col, dtick=90)
        figure.update_xaxes(range=[float(low), float(high)], col=col)
    return figure
