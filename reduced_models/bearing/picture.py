"""Figures of bearings. Matplotlib is imported where one is drawn."""

from __future__ import annotations

import os
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact.files import write_bytes

INNER, OUTER, LOAD, GREY = "#0072b2", "#e69f00", "#d55e00", "#7f7f7f"  # Okabe and Ito, for colour-blind eyes
SIZE, DPI = (9.0, 4.4), 130  # inches; of files
BAR = 0.5  # width of a bar over the angle between two balls
ROOM = 1.25  # radius of the load zone over its longest bar


def draw_state(state: Any, path: str | os.PathLike[str] | None = None) -> Any:
    """Load zone of a `BearingState` beside the films of every ball; the file's ending gives its format."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE, layout="constrained")
    zone = figure.add_subplot(1, 2, 1, projection="polar")
    load_zone(zone, state)
    beside = figure.add_subplot(1, 2, 2)
    films(beside, state)
    speed = f"{state.speed_rpm:g} rev/min" if state.speed_rpm else "at rest"
    figure.suptitle(f"{state.name or 'ball bearing'}, {np.hypot(*state.load):.4g} N, {speed}")
    if path is not None:
        buffer = BytesIO()
        figure.savefig(buffer, format=Path(path).suffix[1:] or "png", dpi=DPI)
        write_bytes(path, buffer.getvalue())
    return figure


def load_zone(axes: Any, state: Any) -> None:
    """Force of every ball, outward from the centre, and the load."""
    width = BAR * 2.0 * np.pi / state.angles.size
    most = float(state.force.max())
    axes.bar(state.angles, state.force[:, 1], width=width, color=OUTER, label="outer race")
    axes.bar(state.angles, state.force[:, 0], width=0.6 * width, color=INNER, label="inner race")
    axes.set_rlim(0.0, ROOM * most)
    axes.set_rlabel_position(_free_angle(state))
    axes.grid(color="#dddddd", linewidth=0.6)
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


def films(axes: Any, state: Any) -> None:
    """Smallest film of every ball over its place, or the approaches of a dry bearing."""
    turned = np.degrees((state.angles - np.arctan2(state.load[1], state.load[0]) + np.pi) % (2.0 * np.pi) - np.pi)
    order = np.argsort(turned)
    if state.h_min is None:
        shown, title = state.approach * 1e6, "approach of the surfaces [um]; below 0 a gap"
    else:
        shown, title = state.h_min * 1e6, "smallest film [um]"
        axes.set_yscale("log")
    for column, (race, colour) in enumerate((("inner race", INNER), ("outer race", OUTER))):
        axes.plot(turned[order], shown[order, column], "o-", color=colour, label=race)
    axes.set_title(title)
    axes.set_xlabel("angle from the load [degrees]")
    axes.set_xticks(np.arange(-180, 181, 60))
    axes.grid(color="#dddddd", linewidth=0.6)
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
