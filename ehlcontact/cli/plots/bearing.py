"""Ball bearings in a page: load zone, films, Campbell diagram, and the rotor on whole bearings.

`found` is a `BearingModels`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
import plotly.graph_objects as go

from ehlcontact.cli.plots.rotor import MICRO, equal
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, INK, ORANGE, RED, grid, label_axes, running, vertical
from ehlcontact.results.picture import COLOURS
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.picture import from_load
from reduced_models.rotor.picture import amplitudes, mode_name

LOOKS: dict[str, dict[str, Any]] = {
    "memory": {"color": BLUE},
    "dry": {"color": GREY},
    "constant": {"color": GREEN, "dash": "dash"},
    "usual": {"color": RED, "dash": "dashdot"},
}
ORDER = ("dry", "memory", "usual", "constant")  # in which they are drawn: lines over clouds
BODIES = {"ring": "inner ring, left", "disc": "disc"}
ORDERS = 12.0  # multiples of the speed, that a spectrum shows
DEEPEST = 1e-5  # of its largest line, the smallest that it shows
# Of the bearing at a speed: what, in what unit, its label.
COEFFICIENTS = (("stiffness", 1e-6, f"stiffness [N/{MICRO}]"), ("damping", 1.0, "damping [N s/m]"))
TURNS = 5.0  # of the shaft, on the orbits
BAR = 0.5  # width of a bar over the angle between two balls
ROOM = 1.25  # radius of the load zone over its longest bar
RACES = (("inner race", BLUE, 0.6), ("outer race", ORANGE, 1.0))  # name, colour, width of a bar

Names = Mapping[str, str]


def drawings(found: Any, names: Names) -> dict[str, Callable[[], go.Figure]]:
    """The figures by name, not drawn yet."""
    figures = {
        "whole_balls": lambda: balls(found.state),
        "whole_orbits": lambda: orbits(found, names),
        "whole_spectra": lambda: spectra(found, names),
        "whole_coefficients": lambda: coefficients(found, names),
        "whole_response": lambda: response(found, names),
    }
    if found.over_speed:
        figures["whole_speeds"] = lambda: speeds(found)
    if not isinstance(found.diagram, str):
        figures["whole_campbell"] = lambda: campbell(found.diagram)
    return figures


def balls(state: Any) -> go.Figure:
    """Load zone, and the smallest film under every ball."""
    figure = grid(1, 2, heights=[320], polar=((1, 1),))
    load_zone(figure, state)
    films(figure, state)
    return figure


def drawings_at_angles(found: Any) -> dict[str, Callable[[], go.Figure]]:
    """The figures of a bearing at contact angles and of the rotor between two of them, not drawn yet."""
    figures: dict[str, Callable[[], go.Figure]] = {
        f"angles_balls{k or ''}": partial(balls_at_angles, state)
        for k, state in enumerate(found.bearings.values())
    }
    figures["angles_coefficients"] = partial(five_coefficients, found)
    if not isinstance(found.diagram, str):
        figures["angles_campbell"] = lambda: campbell(found.diagram)
    return figures


def balls_at_angles(state: Any) -> go.Figure:
    """Load zone, contact angles around the ring, and the smallest film under every ball."""
    figure = grid(2, 2, heights=[320, 260], polar=((1, 1),))
    load_zone(figure, state)
    angles(figure, state, 1, 2)
    films(figure, state, 2, 1)
    spins(figure, state, 2, 2)
    return figure


def angles(figure: go.Figure, state: Any, row: int, col: int) -> None:
    """Contact angles of the balls at both races over their place."""
    _around(figure, state, np.degrees(state.contact_angles), row, col)
    label_axes(figure, "angle from the load [degrees]", "contact angle [degrees]", row, col)


def spins(figure: go.Figure, state: Any, row: int, col: int) -> None:
    """Spin over rolling at both races."""
    _around(figure, state, state.spin_to_roll, row, col)
    label_axes(figure, "angle from the load [degrees]", "spin/roll [-]", row, col)


def _around(figure: go.Figure, state: Any, values: Any, row: int, col: int) -> None:
    """Values of every ball at inner and outer race, over the place of the ball from the load."""
    place = from_load(state)
    order = np.argsort(place)
    for column, (name, colour, _) in enumerate(RACES):
        look: Any = {"mode": "lines+markers", "line_color": colour, "name": name}
        figure.add_scatter(x=place[order], y=values[order, column], **look, row=row, col=col)
    figure.update_xaxes(dtick=60, row=row, col=col)


def five_coefficients(found: Any) -> go.Figure:
    """K and C in all five degrees of freedom over the frequency of the vibration."""
    figure, at = grid(2, 2, heights=[270, 270]), found.over_frequency
    dashes = {"x": "dot", "y": "solid", "z": "solid", "tilt_x": "solid", "tilt_y": "dot"}
    colours = {"x": BLUE, "y": BLUE, "z": ORANGE, "tilt_x": GREEN, "tilt_y": GREEN}
    rows = (("x", "y", "z"), ("tilt_x", "tilt_y"))
    units = ((1e-6, f"stiffness [N/{MICRO}]", 1.0, "damping [N s/m]"),
             (1e-3, "tilt stiffness [N m/mrad]", 1.0, "tilt damping [N m s/rad]"))  # fmt: skip
    for row, (names, (k_unit, k_label, c_unit, c_label)) in enumerate(zip(rows, units, strict=True), start=1):
        columns = ((at.stiffness * k_unit, k_label), (at.damping * c_unit, c_label))
        for col, (values, label) in enumerate(columns, start=1):
            for name in names:
                k = FIVE.index(name)
                line = {"color": colours[name], "dash": dashes[name]}
                shown = name.replace("_", " about ")
                figure.add_scatter(x=at.hz, y=values[:, k, k], line=line, name=shown, row=row, col=col)
            figure.update_xaxes(type="log", row=row, col=col)
            scale = "linear" if col == 1 else "log"
            label_axes(figure, "frequency of the vibration [Hz]", label, row, col, type=scale)
            vertical(figure, found.state.speed_rpm / 60.0, "", row, col, ORANGE)
    return figure


def load_zone(figure: go.Figure, state: Any) -> None:
    """Force of every ball, outward from the centre, and the load."""
    angle, most = np.degrees(state.angles) % 360.0, float(state.force.max())
    for column in (1, 0):
        name, colour, share = RACES[column]
        width = [share * BAR * 360.0 / angle.size] * angle.size
        bars: Any = {"r": state.force[:, column], "theta": angle, "width": width, "marker_color": colour}
        figure.add_barpolar(**bars, name=name, row=1, col=1)
    if state.load.any():
        towards = float(np.degrees(np.arctan2(state.load[1], state.load[0]))) % 360.0
        arrow: Any = {"mode": "lines+markers", "line": {"color": RED, "width": 3}}
        marker = {"symbol": ["circle", "arrow"], "size": [0, 12], "angleref": "previous", "color": RED}
        at = {"theta": [towards] * 2, "r": [1.02 * most, 1.22 * most]}
        figure.add_scatterpolar(**at, **arrow, marker=marker, name="load", row=1, col=1)
    radius = {"range": [0.0, ROOM * most], "ticksuffix": " N"}
    figure.update_polars(barmode="overlay", radialaxis=radius, row=1, col=1)


def films(figure: go.Figure, state: Any, row: int = 1, col: int = 2) -> None:
    """Smallest film of every ball over its place, or the approaches of a dry bearing."""
    dry = state.h_min is None
    _around(figure, state, (state.approach if dry else state.h_min) * 1e6, row, col)
    label = f"approach [{MICRO}]; below 0 a gap" if dry else f"smallest film [{MICRO}]"
    label_axes(figure, "angle from the load [degrees]", label, row, col, type="linear" if dry else "log")
    if state.lambda_ratio is not None and not dry:
        rough = float(state.h_min.flat[0] / state.lambda_ratio.flat[0]) * 1e6
        name = f"composite roughness; least lambda {float(np.nanmin(state.lambda_ratio)):.3g}"
        line: Any = {"color": GREY, "dash": "dash", "width": 1.2}
        figure.add_scatter(x=[-180.0, 180.0], y=[rough] * 2, name=name, line=line, row=row, col=col)


def orbits(found: Any, names: Names) -> go.Figure:
    """Paths of the left ring and of the disc, each about its mean."""
    figure = grid(1, 2, heights=[380], titles=list(BODIES.values()))
    for col, body in enumerate(BODIES, start=1):
        for name in [name for name in ORDER if name in found.ran]:
            run = found.ran[name]
            path = getattr(run, body)[run.t >= run.t[-1] - TURNS * 60.0 / found.speed_rpm]
            x, y = ((path - path.mean(axis=0)) * 1e6).T
            line = {**LOOKS[name], "width": 1.2}
            figure.add_scatter(x=x, y=y, line=line, name=names[name], row=1, col=col)
        label_axes(figure, f"x [{MICRO}]", f"y [{MICRO}]", 1, col)
    return equal(figure)


def spectra(found: Any, names: Names) -> go.Figure:
    """Amplitudes of ring and disc up and down; dotted, the speed and the passage of the balls."""
    figure, speed = grid(1, 2, heights=[300], titles=list(BODIES.values())), found.speed_rpm / 60.0
    for col, body in enumerate(BODIES, start=1):
        highest = 0.0
        for name in [name for name in ORDER if name in found.ran]:
            run = found.ran[name]
            hz, size = amplitudes(getattr(run, body)[:, 1], float(run.t[1] - run.t[0]))
            shown = hz <= ORDERS * speed
            line = {**LOOKS[name], "width": 1.2}
            figure.add_scatter(x=hz[shown], y=size[shown] * 1e6, line=line, name=names[name], row=1, col=col)
            highest = max(highest, float(size[shown].max()) * 1e6)
        label_axes(figure, "frequency [Hz]", f"amplitude of y [{MICRO}]", 1, col, type="log")
        figure.update_xaxes(range=[0.0, ORDERS * speed], row=1, col=col)
        if highest > 0.0:
            ends = [float(np.log10(share * highest)) for share in (DEEPEST, 3.0)]
            figure.update_yaxes(range=ends, row=1, col=col)
        for at, text in ((speed, "1x"), (found.passage_hz, "ball passage")):
            vertical(figure, at, text, 1, col, ORANGE)
    return figure


def coefficients(found: Any, names: Names) -> go.Figure:
    """K and C of a bearing over the frequency of the vibration, beside those that are constant."""
    figure, at = grid(1, 2, heights=[280]), found.over_frequency
    for col, (name, unit, label) in enumerate(COEFFICIENTS, start=1):
        ways = (
            (1, "film memory, along the load", {"color": BLUE}),
            (0, "across it", {"color": BLUE, "dash": "dot"}),
        )
        for k, way, look in ways:
            y = getattr(at, name)[:, k, k] * unit
            figure.add_scatter(x=at.hz, y=y, line=look, name=way, row=1, col=col)
        for key, constant in found.constants.items():
            y = [constant[col - 1] * unit] * 2
            figure.add_scatter(x=at.hz[[0, -1]], y=y, line=LOOKS[key], name=names[key], row=1, col=col)
        figure.update_xaxes(type="log", row=1, col=col)
        scale = "linear" if col == 1 else "log"
        label_axes(figure, "frequency of the vibration [Hz]", label, 1, col, type=scale)
        vertical(figure, found.speed_rpm / 60.0, "", 1, col, ORANGE)
    return figure


def response(found: Any, names: Names) -> go.Figure:
    """Displacement of the disc over its eccentricity, over the frequency of the unbalance."""
    ways = "horizontal", "vertical"
    figure = grid(1, 2, heights=[290], titles=[f"disc, {way}" for way in ways])
    for col in (1, 2):
        for name in [name for name in ORDER if name in found.responses]:
            y = found.responses[name][:, col - 1]
            figure.add_scatter(x=found.response_hz, y=y, line=LOOKS[name], name=names[name], row=1, col=col)
        label_axes(figure, "frequency of the unbalance [Hz]", "displacement/eccentricity [-]", 1, col, type="log")
        figure.update_xaxes(type="log", row=1, col=col)
    return figure.update_yaxes(matches="y", row=1, col=2)


def speeds(found: Any) -> go.Figure:
    """Load zone, films, stiffness and damping of the bearing, with a slider through the speeds."""
    every = found.over_speed
    rpm = [one.state.speed_rpm for one in every]
    own = min(range(len(rpm)), key=lambda k: abs(rpm[k] - found.speed_rpm))
    return running([at_speed(one) for one in every], "speed", "rpm", rpm, own)


def at_speed(one: Any) -> go.Figure:
    """Load zone, films, stiffness and damping of the bearing at one speed."""
    figure = grid(2, 2, heights=[300, 250], polar=((1, 1),))
    load_zone(figure, one.state)
    films(figure, one.state)
    for col, (name, unit, label) in enumerate(COEFFICIENTS, start=1):
        for k, which, dash in ((1, "along the load", "solid"), (0, "across it", "dot")):
            y, look = getattr(one.small, name)[:, k, k] * unit, {"color": GREEN, "dash": dash}
            figure.add_scatter(x=one.small.hz, y=y, line=look, name=which, row=2, col=col)
        figure.update_xaxes(type="log", row=2, col=col)
        label_axes(figure, "frequency of the vibration [Hz]", label, 2, col, type="log")
    return figure


def campbell(diagram: Any) -> go.Figure:
    """Frequencies over the speed with the critical speeds, above the decrements."""
    figure, rpm, hz = grid(2, heights=[330, 180], shared=True), diagram.speed_rpm, diagram.hz
    dashes = "solid", "dash", "dot"
    for k in range(hz.shape[1]):
        line = {"color": COLOURS[k % len(COLOURS)], "dash": dashes[k // len(COLOURS) % 3]}
        name = f"{k + 1} {mode_name(diagram, k)}"
        for row, values in ((1, hz), (2, diagram.decrement)):
            figure.add_scatter(x=rpm, y=values[:, k], line=line, name=name, row=row, col=1)
    once: Any = {"color": GREY, "width": 1.2, "dash": "dashdot"}
    figure.add_scatter(x=rpm, y=rpm / 60.0, line=once, name="1x", row=1, col=1)
    critical = diagram.critical_speeds() if len(rpm) > 1 else ()
    if critical:
        at = {"x": [one.speed_rpm for one in critical], "y": [one.hz for one in critical]}
        ring: Any = {"mode": "markers", "marker": {"symbol": "circle-open", "size": 8, "color": INK}}
        figure.add_scatter(**at, **ring, name="critical speeds", row=1, col=1)
    label_axes(figure, "", "damped frequency [Hz]", range=[0.0, 1.08 * float(hz.max())])
    scale = "log" if diagram.decrement.min() > 0.0 else "linear"
    label_axes(figure, "speed [rev/min]", "decrement", 2, type=scale)
    figure.update_xaxes(range=[float(rpm.min()), float(rpm.max())])
    return figure
