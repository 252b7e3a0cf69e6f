"""Figures of bearings. Matplotlib is imported where one is drawn."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from ehlcontact.results.picture import GRID, written

INNER, OUTER, LOAD, GREY = "#0072b2", "#e69f00", "#d55e00", "#7f7f7f"  # Okabe and Ito, for colour-blind eyes
SIZE = (9.0, 4.4)  # inches
BAR = 0.5  # width of a bar over the angle between two balls
ROUNDING = 1e-9  # of a load over the force on a ball: none
LOOKS = "o-", "s--", "^:"  # of contact angles of the bearings of a set
ROOM = 1.25  # radius of the load zone over its longest bar


def draw_state(state: Any, path: str | os.PathLike[str] | None = None) -> Any:
    """Load zone of a `BearingState` beside the films of every ball; the file's ending gives its format."""
    from matplotlib.figure import Figure

    panels = 2 if state.contact_angles is None else 3
    figure = Figure(figsize=(0.5 * panels * SIZE[0], SIZE[1]), layout="constrained")
    zone = figure.add_subplot(1, panels, 1, projection="polar")
    load_zone(zone, state)
    films(figure.add_subplot(1, panels, 2), state)
    if panels == 3:
        contact_angles(figure.add_subplot(1, panels, 3), state)
    speed = f"{state.speed_rpm:g} rev/min" if state.speed_rpm else "at standstill"
    torque = state.rolling_torque
    resists = "" if torque is None else f"; films resist rolling by {torque * 1e3:.3g} N mm"
    figure.suptitle(f"{state.name or 'ball bearing'}, {_load(state)}, {speed}{resists}")
    return written(figure, path)


def draw_set(state: Any, path: str | os.PathLike[str] | None = None) -> Any:
    """Load zones of a `SetState` above contact angles, bearing by bearing; the file's ending gives its format."""
    from matplotlib.figure import Figure

    columns = len(state.bearings)
    figure = Figure(figsize=(0.42 * SIZE[0] * columns, 1.6 * SIZE[1]), layout="constrained")
    for k, one in enumerate(state.bearings):
        zone = figure.add_subplot(2, columns, 1 + k, projection="polar")
        load_zone(zone, one, max(float(each.force.max()) for each in state.bearings))
        zone.set_title(_bearing_title(state, k))
        contact_angles(figure.add_subplot(2, columns, 1 + columns + k), one)
    speed = f"{state.speed_rpm:g} rev/min" if state.speed_rpm else "at standstill"
    figure.suptitle(f"{state.name or 'set of bearings'}, {_load(state)}, {speed}")
    return written(figure, path)


def draw_over_speed(
    state: Any, points: Sequence[Any], curve: Sequence[Any], path: str | os.PathLike[str] | None = None
) -> Any:
    """Load zone and films at one speed, and contact angles where there are any, above K and C over speed.

    Of a set, load zones of its first two bearings and contact angles of all stand above.

    Parameters
    ----------
    state : BearingState or SetState
    points, curve : sequence of BearingCoefficients
        Shown as points and as lines, each at its first frequency.
    path : path, optional
        The file's ending gives its format.
    """
    from matplotlib.figure import Figure

    several = getattr(state, "bearings", ())
    at_angles = bool(several) or state.contact_angles is not None
    columns = 3 if at_angles else 2
    figure = Figure(figsize=(0.5 * columns * SIZE[0], 1.7 * SIZE[1]), layout="constrained")
    for k, one in enumerate(several[:2]):
        zone = figure.add_subplot(2, columns, 1 + k, projection="polar")
        load_zone(zone, one, max(float(each.force.max()) for each in several))
        zone.set_title(_bearing_title(state, k))
    if not several:
        load_zone(figure.add_subplot(2, columns, 1, projection="polar"), state)
        films(figure.add_subplot(2, columns, 2), state)
    if at_angles:
        angles = figure.add_subplot(2, columns, 3)
        for k, one in enumerate(several or (state,)):
            contact_angles(angles, one, f", bearing {k}" if several else "", LOOKS[k % len(LOOKS)])
    planar = (1, LOAD, "along the load"), (0, INNER, "across it")
    forces = (*planar, (2, OUTER, "axial")) if at_angles else planar
    panels = [
        ("stiffness", 1e-6, "stiffness [N/µm]", forces),
        ("damping", 1.0, "damping [N s/m]", forces),
        ("stiffness", 1e-3, "tilt stiffness [N m/mrad]", ((3, LOAD, "about x"), (4, INNER, "about y"))),
    ]
    for place, (name, unit, label, ways) in enumerate(panels[:columns], columns + 1):
        axes = figure.add_subplot(2, columns, place)
        for k, colour, direction in ways:
            for found, look in ((curve, "-"), (points, "o")):
                speeds, values = (
                    [at.speed_rpm for at in found],
                    [getattr(at, name)[0, k, k] * unit for at in found],
                )
                axes.plot(speeds, values, look, color=colour, label=direction if look == "-" else None)
        hz = {float(at.hz[0]) for at in points}
        shaft = all(np.isclose(at.hz[0], at.speed_rpm / 60.0) for at in points)
        frequency = "the frequency of the shaft" if shaft else f"{min(hz):g} Hz"
        axes.set(xlabel="speed [rev/min]")
        axes.set_title(f"{label}, at {frequency}", fontsize=10)
        axes.set_ylim(0.0, max(1.05 * axes.get_ylim()[1], 1.0))  # a dry bearing damps nothing
        axes.grid(**GRID)
        axes.legend(frameon=False, fontsize=8)
    at = f"above at {state.speed_rpm:g} rev/min, a ball under the load"
    figure.suptitle(f"{state.name or 'ball bearing'}, {_load(state)}; {at}")
    return written(figure, path)


def _load(state: Any) -> str:
    """Load of a state in words."""
    radial = f"{np.hypot(*state.load[:2]):.4g} N"
    return radial if state.load.size == 2 else f"{radial} radially, {state.load[2]:.4g} N axially"


def _bearing_title(state: Any, k: int) -> str:
    """Of the load zone of a bearing of a set."""
    force = state.axial_forces[k]
    return f"bearing {k}, facing {state.facings[k]}: {force:.4g} N axially\nforce on the balls [N]"


def contact_angles(axes: Any, state: Any, which: str = "", look: str = "o-") -> None:
    """Contact angles of every ball over its place; `which` is added to the names of the races."""
    turned, shown = from_load(state), np.degrees(state.contact_angles)
    order = np.argsort(turned)
    for column, (race, colour) in enumerate((("inner race", INNER), ("outer race", OUTER))):
        axes.plot(turned[order], shown[order, column], look, color=colour, label=race + which)
    axes.set_title("contact angle [degrees]")
    axes.set_xlabel("angle from the load [degrees]")
    axes.set_xticks(np.arange(-180, 181, 60))
    axes.grid(**GRID)
    axes.legend(frameon=False, fontsize=8)


def load_zone(axes: Any, state: Any, most: float | None = None) -> None:
    """Force of every ball, outward from the centre, up to `most` [N], and the load."""
    width = BAR * 2.0 * np.pi / state.angles.size
    most = float(state.force.max()) if most is None else most
    axes.bar(state.angles, state.force[:, 1], width=width, color=OUTER, label="outer race")
    axes.bar(state.angles, state.force[:, 0], width=0.6 * width, color=INNER, label="inner race")
    axes.set_rlim(0.0, ROOM * most)
    axes.set_rlabel_position(_free_angle(state))
    axes.grid(**GRID)
    axes.set_axisbelow(True)
    if np.hypot(*state.load[:2]) > ROUNDING * most:
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
