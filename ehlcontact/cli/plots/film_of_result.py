"""One figure of a steady film: pressure, film, fringes where there are SI scales, and both mid-planes."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from numpy.typing import NDArray

from ehlcontact.cli.plots.style import BLUE, GREY, RED, legend_above, new_figure
from ehlcontact.film import Film, Profile, film_of, interferogram
from ehlcontact.results import SteadyResult

VIEW = (-1.9, 1.4, 1.4)  # along X from, to; across to: of the maps, in semi-axes
WAVELENGTH, REFRACTIVE_INDEX = 600e-9, 1.5  # of the fringes

Array = NDArray[np.float64]


def draw_steady(result: SteadyResult) -> Figure:
    """Maps of pressure, film and fringes above the mid-planes; in SI where the result has scales."""
    film = film_of(result)
    si = film.scales is not None
    figure = new_figure(6.8, 10.5)
    parts: Any = figure.subfigures(2, 1, height_ratios=(1.25, 1.0))
    maps, profiles = parts
    panels = maps.subplots(1, 3 if si else 2, sharey=True)
    places = (film.x * 1e3, film.y * 1e3) if si else (film.X, film.Y)
    pressure, gap = (film.p * 1e-9, film.h * 1e6) if si else (film.P, film.H)
    central = float(np.interp(0.0, film.along.X, gap[:, film.Y.size // 2]))
    shown = _map(panels[0], places, pressure, "inferno", 0.0, float(pressure.max()))
    maps.colorbar(shown, ax=panels[0], label="pressure [GPa]" if si else "pressure P = p/p_h", location="top")
    shown = _map(panels[1], places, gap, "viridis", float(gap.min()), 2.0 * central)
    maps.colorbar(
        shown, ax=panels[1], label="film [um]" if si else "film H = h/dry approach", location="top", extend="max"
    )
    if si:
        fringes = interferogram(film, WAVELENGTH, REFRACTIVE_INDEX)
        shown = _map(panels[2], places, np.where(fringes.resolved, fringes.intensity, 0.5), "gray", 0.0, 1.0)
        label = f"fringes at {WAVELENGTH * 1e9:.0f} nm, oil of index {REFRACTIVE_INDEX}"
        maps.colorbar(shown, ax=panels[2], label=label, location="top")
    for panel, colour in zip(panels, ("white", "white", RED), strict=False):
        _frame(panel, film, colour)
    panels[0].set_ylabel("y across [mm]" if si else "Y = y/b across")
    for axes, profile in zip(profiles.subplots(1, 2), (film.along, film.across), strict=True):
        _midplane(axes, profile, si)
    return figure


def _map(axes: Axes, places: tuple[Array, Array], field: Array, cmap: str, low: float, high: float) -> object:
    return axes.pcolormesh(*places, field.T, cmap=cmap, vmin=low, vmax=high, shading="gouraud", rasterized=True)


def _frame(axes: Axes, film: Film, colour: str) -> None:
    """Hertz ellipse, limits and label of a map."""
    a, b = (film.scales.a * 1e3, film.scales.b * 1e3) if film.scales else (1.0, 1.0)
    axes.add_patch(Ellipse((0.0, 0.0), 2 * a, 2 * b, fill=False, edgecolor=colour, linestyle="--", linewidth=0.9))
    axes.set(xlim=(VIEW[0] * a, VIEW[1] * a), ylim=(-VIEW[2] * b, VIEW[2] * b))
    axes.set_xlabel("x along rolling [mm]" if film.scales else "X = x/a along rolling")
    axes.set_box_aspect(2.0 * VIEW[2] / (VIEW[1] - VIEW[0]))  # the ellipse as a circle
    axes.grid(False)


def _midplane(axes: Axes, profile: Profile, si: bool) -> None:
    """Film and pressure along one mid-plane, with the dry Hertz pressure."""
    place, film, pressure = profile.X, profile.H, profile.P
    hertz = np.linspace(-1.0, 1.0, 201)
    dry = np.sqrt(1.0 - hertz**2)
    name = "Y = y/b across, X = 0" if profile.across else "X = x/a along rolling, Y = 0"
    unit = 1.0
    if si and profile.scales:
        place, film, pressure = profile.x * 1e3, profile.h * 1e6, profile.p * 1e-9
        dry = dry * profile.scales.pressure * 1e-9
        name = "y across [mm], x = 0" if profile.across else "x along rolling [mm], y = 0"
        unit = (profile.scales.b if profile.across else profile.scales.a) * 1e3
    low = -VIEW[2] if profile.across else VIEW[0]
    axes.plot(hertz * unit, dry, "--", color=GREY, label="dry Hertz")
    axes.plot(place, pressure, color=RED, label="pressure")
    axes.set(xlabel=name, xlim=(low * unit, VIEW[1] * unit), ylim=(0.0, None))
    axes.set_ylabel("pressure [GPa]" if si else "pressure P", color=RED)
    right = axes.twinx()
    right.plot(place, film, color=BLUE, label="film")
    right.set(ylim=(0.0, 5.0 * float(np.interp(0.0, place, film))))
    right.set_ylabel("film [um]" if si else "film H", color=BLUE)
    right.grid(False)
    right.spines["right"].set_visible(True)
    legend_above(axes, handles=[*axes.get_lines(), *right.get_lines()])
