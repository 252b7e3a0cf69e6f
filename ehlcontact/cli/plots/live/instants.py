"""The scene of film and pressure through time: maps and mid-planes of one period, frame by frame."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_hex
from scipy.interpolate import RectBivariateSpline

from ehlcontact.cli.plots.instants import limits_of, steps_of
from ehlcontact.cli.plots.live.areas import COLOURS, LEVELS
from ehlcontact.cli.plots.live.scene import Scene
from ehlcontact.cli.plots.live.thinned import rounded
from ehlcontact.cli.plots.maps import FLATTEST, VIEW, scale_note
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, PURPLE, RED
from ehlcontact.cli.plots.units import Quantity, units_of
from ehlcontact.film import Film, film_of
from ehlcontact.point import moes_point
from ehlcontact.transient.result import SimulationResult

POINTS = (49, 81)  # of a map, along rolling and across
FLAT, HIGH = 200, 215  # px of the panels with lines

Axis = dict[str, Any]


def instants_scene(run: SimulationResult) -> Scene:
    """Pressure, film, both along the mid-plane, and force and film over time, with a slider through a period.

    A run that kept no whole fields is shown without the maps.
    """
    units, steps = units_of(run.scales), steps_of(run)
    times = units.time(run.T[steps])
    panels, moving, told = _maps(run, steps) if run.snapshot_T.size else ([], [], "")
    count = sum(len(panel["traces"]) for panel in panels)
    middle, moved = _midplane(run, steps, count)
    history, marked = _history(run, steps, count + len(middle["traces"]))
    for row, panel in enumerate((*panels, middle, history)):
        panel |= {"row": row, "column": 0, "notes": []}
    label, _, unit = units.time.label.rstrip("]").partition(" [")
    frames = {
        "label": label,
        "unit": unit,
        "values": rounded(times, fineness=1e3),
        "start": 0,
        "runs": True,
        "traces": [*moving, *moved, *marked],
    }
    every = f"{steps.size} of the {run.T.size} times of the run"
    return {
        "panels": [*panels, middle, history],
        "note": "",
        "frames": frames,
        "thinned": f"{told}{every}",
    }


def _axis(quantity: Quantity, ends: tuple[float, float] | None = None, colour: str | None = None) -> Axis:
    ends = None if ends is None else (float(ends[0]), float(ends[1]))
    shared = {"log": False, "ticks": None, "color": colour}
    return {"label": quantity.label, "alone": quantity.label, "range": ends, **shared}


def _seen(film: Film) -> Film:
    """The part of a film that maps show, on few points."""
    X = np.linspace(max(VIEW[0], film.X[0]), min(VIEW[1], film.X[-1]), POINTS[0])
    across = min(VIEW[2], film.Y[-1])
    Y = np.linspace(-across, across, POINTS[1])
    H, P = (RectBivariateSpline(film.X, film.Y, field)(X, Y) for field in (film.H, film.P))
    return Film(X, Y, H, P, film.scales)


def _maps(run: SimulationResult, steps: np.ndarray) -> tuple[list[Scene], list[Scene], str]:
    """Panels of pressure and film, their numbers in every frame, and what was thinned."""
    units, kappa = units_of(run.scales), moes_point(run.point).kappa
    films = [_seen(film_of(run, float(run.T[step]))) for step in steps.tolist()]
    seen = films[0]
    thinnest, thickest, most = limits_of(run, steps)
    rows = (
        (units.pressure, [np.maximum(film.P, 0.0) for film in films], "inferno", 0.0, most),
        (units.film, [np.clip(film.H, 0.0, thickest) for film in films], "viridis", thinnest, thickest),
    )
    flatness = kappa * (seen.X[-1] - seen.X[0]) / (seen.Y[-1] - seen.Y[0])
    note = scale_note(seen, kappa, upwards=True)
    panels, moving = [], []
    for number, (quantity, fields, colours, low, high) in enumerate(rows):
        z = [rounded(quantity(field), fineness=LEVELS) for field in fields]
        marks = [_ellipse(units)]
        name = quantity.label.split(" [")[0]
        panels.append(
            {
                "title": f"{name}; the surfaces move upwards{'; ' if note else ''}{note}",
                "height": FLAT,
                "x": _axis(units.y, (units.y(seen.Y[0]), units.y(seen.Y[-1]))),
                "y": _axis(units.x, (units.x(seen.X[0]), units.x(seen.X[-1]))),
                "equal": False,
                "box": round(max(float(flatness), FLATTEST), 4),
                "matches": {"x": 0 if number else None, "y": 0 if number else None},
                "traces": [
                    {
                        "type": "heatmap",
                        "x": rounded(units.y(seen.Y)),
                        "y": rounded(units.x(seen.X)),
                        "z": z[0],
                        "zmin": quantity(low),
                        "zmax": quantity(high),
                        "zsmooth": "best",
                        "colorscale": _colours(colours),
                        "label": quantity.label,
                    }
                ],
                "marks": marks,
            }
        )
        moving.append({"trace": number, "z": z})
    told = f"maps: {POINTS[0]} x {POINTS[1]} points of the part shown, films thicker than the colours cut off; "
    return panels, moving, told


def _ellipse(units: Any) -> Scene:
    a, b = float(units.x.factor), float(units.y.factor)
    line = {"color": "#ffffff", "dash": "dash", "width": 1.2}
    return {"kind": "ellipse", "x0": -b, "x1": b, "y0": -a, "y1": a, "line": line}


def _colours(name: str) -> list[list[Any]]:
    return [[float(at), to_hex(mpl.colormaps[name](at))] for at in np.linspace(0.0, 1.0, COLOURS)]


def _line(x: Any, y: Any, name: str, colour: str, dash: str = "solid") -> Scene:
    look = {"color": colour, "width": 2.0, "dash": dash}
    return {"type": "scatter", "mode": "lines", "name": name, "line": look, "x": rounded(x), "y": rounded(y)}


def _midplane(run: SimulationResult, steps: np.ndarray, first: int) -> tuple[Scene, list[Scene]]:
    """Pressure and film along y = 0, and what moves; `first` is the number of the panel's first trace."""
    units = units_of(run.scales)
    inside = (run.X >= VIEW[0]) & (run.X <= VIEW[1])
    x = units.x(run.X[inside])
    pressures, films = units.pressure(run.p_midplane[:, inside]), units.film(run.h_midplane[:, inside])
    highest = 3.0 * units.film(float(run.h_central[steps].max()))
    panel = {
        "title": "along rolling, y = 0; dotted: at rest",
        "height": HIGH,
        "x": _axis(units.x, (float(x[0]), float(x[-1]))),
        "y": _axis(units.pressure, (0.0, 1.08 * float(pressures[steps].max())), RED),
        "y2": _axis(units.film, (0.0, highest), BLUE),
        "equal": False,
        "box": None,
        "traces": [
            _line(x, pressures[steps[0]], "pressure", RED),
            _line(x, films[steps[0]], "film", BLUE) | {"second": True},
            _line(x, pressures[0], "", RED, "dot"),
            _line(x, films[0], "", BLUE, "dot") | {"second": True},
        ],
        "marks": [],
    }
    moved = [
        {"trace": first, "y": [rounded(pressures[step]) for step in steps.tolist()]},
        {"trace": first + 1, "y": [rounded(films[step]) for step in steps.tolist()]},
    ]
    return panel, moved


def _history(run: SimulationResult, steps: np.ndarray, first: int) -> tuple[Scene, list[Scene]]:
    """Force and central film over the run, with a dot at the time of the frame."""
    units = units_of(run.scales)
    t, force, film = units.time(run.T), units.force(run.force), units.film(run.h_central)
    dot = {"symbol": "circle", "size": 9, "color": RED, "line": {"color": RED, "width": 1.5}}
    now = {"type": "scatter", "mode": "markers", "marker": dot}
    lines = [
        _line(t, force, "force of the film", PURPLE),
        _line(t, units.force(run.load), "load", GREY, "dot"),
        _line(t, film, "film in the centre", GREEN) | {"second": True},
    ]
    at, forces, films = (rounded(values[steps]) for values in (t, force, film))
    dots = [
        now | {"name": "now", "x": at[:1], "y": forces[:1]},
        now | {"name": "", "x": at[:1], "y": films[:1], "second": True},
    ]
    panel = {
        "title": "over time",
        "height": HIGH,
        "x": _axis(units.time, (0.0, float(t[-1]))),
        "y": _axis(units.force, None, PURPLE),
        "y2": _axis(units.film, None, GREEN),
        "equal": False,
        "box": None,
        "traces": [*lines, *dots],
        "marks": [],
    }
    moved = [
        {"trace": first + len(lines) + k, "x": [[v] for v in at], "y": [[v] for v in values]}
        for k, values in enumerate((forces, films))
    ]
    return panel, moved
