"""The steady film in a page: maps of pressure, film and fringes, both mid-planes, convergence."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.plots.maps import (
    HIGHEST,
    VIEW,
    add_film,
    add_pressure,
    map_axes,
    move_together,
    refined,
    scale_note,
)
from ehlcontact.cli.plots.style import BLUE, GREY, ORANGE, RED, grid, label_axes
from ehlcontact.cli.plots.units import units_of
from ehlcontact.film import film_of, interferogram
from ehlcontact.film.plane import Film, Interferogram, Profile
from ehlcontact.point import moes_point
from ehlcontact.results import SteadyResult

POINTS = (111, 175)  # of a map, along rolling and across
FINE = (166, 351)  # of one that shows fringes
CONTOURS = (0.92, 1.08, 1.3, 1.8)  # of the central film; the last ends its colours
LIGHTS = (630e-9, 532e-9, 467e-9)  # m, red, green and blue
REFRACTIVE_INDEX = 1.5  # of the oil
COHERENCE = 1.5e-6  # m of film over which the fringes of the three lights fade

Array = NDArray[np.float64]


def film_maps(result: SteadyResult) -> go.Figure:
    """Pressure and film over the contact, the surfaces moving upwards."""
    film, kappa = refined(film_of(result), POINTS), moes_point(result.point).kappa
    levels = ", ".join(map(numeral, CONTOURS))
    titles = "pressure; the surfaces move upwards", "film"
    figure = grid(2, heights=[HIGHEST] * 2, titles=titles)
    add_pressure(figure, film, kappa, 1, result.p_max)
    add_film(figure, film, kappa, 2, (float(film.H.min()), CONTOURS[-1] * result.h_central))
    move_together(figure)
    _contours(figure, film, film.H / result.h_central)
    return noted(figure, f"{scale_note(film, kappa)} White lines: {levels} of the central film.".lstrip())


def noted(figure: go.Figure, note: str) -> go.Figure:
    """The figure, with a sentence for the page to say beside it."""
    return figure.update_layout(meta={**figure.layout.meta, "note": note})


def _contours(figure: go.Figure, film: Film, depth: Array) -> None:
    """White lines of equal film: plotly's levels are equally far apart, so the film is bent to them."""
    units, last = units_of(film.scales), len(CONTOURS)
    level = np.interp(depth, (0.0, *CONTOURS, 2.0 * CONTOURS[-1]), np.arange(-1.0, last + 1.0))
    lines = {"start": 0, "end": last - 1, "size": 1, "coloring": "none"}
    look = {"showscale": False, "hoverinfo": "skip", "line": {"color": "white", "width": 0.8}}
    figure.add_contour(x=units.y(film.Y), y=units.x(film.X), z=level, contours=lines, **look, row=2, col=1)


def interferogram_picture(result: SteadyResult) -> go.Figure:
    """Fringes of red, green and blue light on top of one another; zero film is dark."""
    film, kappa = refined(film_of(result), FINE), moes_point(result.point).kappa
    fringes = [interferogram(film, light, REFRACTIVE_INDEX, np.pi) for light in LIGHTS]
    colours = np.stack([brightness(one, film.si.h / COHERENCE) for one in fringes], axis=-1)
    title = f"red, green and blue light, oil of index {REFRACTIVE_INDEX}"
    figure = grid(heights=[HIGHEST], titles=[title])
    x, y = map_axes(figure, film, kappa)
    places = {"x0": x[0], "dx": x[1] - x[0], "y0": y[0], "dy": y[1] - y[0]}
    figure.add_image(z=np.rint(255.0 * colours).astype(int).tolist(), **places, hoverinfo="skip")
    return noted(figure, scale_note(film, kappa))


def brightness(fringes: Interferogram, path: Array | float = 0.0) -> Array:
    """Fringes as a camera sees them: fading with the film, grey where the grid does not resolve them.

    Parameters
    ----------
    fringes : Interferogram
    path : array
        Film over the length in which the fringes fade; 0 where they do not.
    """
    contrast = np.exp(-(np.asarray(path) ** 2)) * fringes.resolved
    return 0.5 + contrast * (fringes.intensity - 0.5)


def midplanes(result: SteadyResult) -> go.Figure:
    """Pressure and film along rolling, and across over one half."""
    film = film_of(result)
    figure = grid(1, 2, second=((1, 1), (1, 2)), heights=[270])
    for col, profile, ends in ((1, film.along, VIEW[:2]), (2, film.across, (0.0, 1.6))):
        _midplane(figure, profile, ends, col)
    return figure


def _midplane(figure: go.Figure, profile: Profile, ends: tuple[float, float], col: int) -> None:
    """Film and pressure along one mid-plane, with the dry Hertz pressure."""
    units = units_of(profile.scales)
    place = units.y if profile.across else units.x
    hertz, at = np.linspace(-1.0, 1.0, 201), {"row": 1, "col": col}
    dry = units.pressure(np.sqrt(1.0 - hertz**2))
    figure.add_scatter(x=place(hertz), y=dry, name="dry Hertz", line={"color": GREY, "dash": "dash"}, **at)
    x, (first, last) = place(profile.X), (place(end) for end in ends)
    figure.add_scatter(x=x, y=units.pressure(profile.P), name="pressure", line_color=RED, **at)
    figure.add_scatter(x=x, y=units.film(profile.H), name="film", line_color=BLUE, **at, secondary_y=True)
    label = f"{place.label}; {'x' if profile.across else 'y'} = 0"
    figure.update_xaxes(title_text=label, range=[first, last], **at)
    highest = units.pressure(1.05 * float(max(profile.P.max(), 1.0)))
    label_axes(figure, label, units.pressure.label, **at, range=[0.0, highest], title_font_color=RED)
    thickest = units.film(5.0 * float(np.interp(0.0, profile.X, profile.H)))
    look = {"title_text": units.film.label, "title_font_color": BLUE}
    figure.update_yaxes(range=[0.0, thickest], **look, **at, secondary_y=True)


def convergence(result: SteadyResult) -> go.Figure:
    """Changes of the pressure, and residuals, of the multigrid cycles."""
    figure, cycles = grid(heights=[270]), np.arange(len(result.residuals))
    floor = 1e-17
    lines = [
        ("residual of Reynolds, over the dry start's", "circle", BLUE, result.residuals / result.dry_residual),
        ("residual of the load balance, over the load", "square", ORANGE, np.abs(result.load_residuals) + floor),
        ("change of approach, over the dry one", "triangle-up", GREY, result.approach_changes + floor),
        ("largest change of pressure, over Hertz's", "diamond", RED, result.pressure_changes + floor),
    ]
    for name, symbol, colour, values in lines:
        look = {"mode": "lines+markers", "marker": {"symbol": symbol, "size": 8}, "line_color": colour}
        figure.add_scatter(x=cycles[cycles.size - values.size :], y=values, name=name, **look)
    label_axes(figure, "cycle on the finest grid", "change or residual [-]", type="log")
    return figure
