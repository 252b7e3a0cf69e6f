"""Maps over the contact's plane: a field, the Hertz ellipse and the axes."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Ellipse
from numpy.typing import NDArray
from scipy.interpolate import RectBivariateSpline

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.plots.units import units_of
from ehlcontact.film import Film

VIEW = (-1.8, 1.5, 1.5)  # along X from, to; across to: in semi-axes
POINTS = (331, 701)  # of a refined film
FLATTEST = 0.3  # height over width of a map with the surfaces moving upwards: a flatter one is stretched

Array = NDArray[np.float64]


def refined(film: Film, growth: float = 1.0) -> Film:
    """The part of a film that maps show, interpolated smoothly, so that no picture shows the grid.

    Parameters
    ----------
    film : Film
    growth : float
        Semi-axes over those of the film's scales, where the load has risen.
    """
    first, last, across = (growth * edge for edge in VIEW)
    X = np.linspace(max(first, film.X[0]), min(last, film.X[-1]), POINTS[0])
    across = min(across, film.Y[-1])
    Y = np.linspace(-across, across, POINTS[1])
    H, P = (RectBivariateSpline(film.X, film.Y, field)(X, Y) for field in (film.H, film.P))
    return Film(X, Y, H, P, film.scales)


def draw_map(axes: Axes, film: Film, values: Array, kappa: float, *, upwards: bool = False, **image: Any) -> Any:
    """Draw `values` over the plane of a film, and the image is returned for a colour bar.

    Parameters
    ----------
    axes : Axes
    film : Film
        Says where.
    values : array, shape (nx, ny) or (nx, ny, 3)
        Numbers to colour, or red, green and blue.
    kappa : float
        Ratio a/b of the ellipse.
    upwards : bool
        Let the surfaces move upwards; otherwise they move to the right, and the ellipse is drawn as a circle.
        What is not to scale `scale_note` says.
    **image
        Colour map and limits.
    """
    units = units_of(film.scales)
    along, across = units.x(film.X[[0, -1]]), units.y(film.Y[[0, -1]])
    options: dict[str, Any] = {"origin": "lower", "aspect": "auto", "interpolation": "bilinear"} | image
    if upwards:
        shown = axes.imshow(values, extent=(*across, *along), **options)
        axes.set(xlabel=units.y.label, ylabel=units.x.label)
        axes.set_box_aspect(max(_flatness(film, kappa), FLATTEST))
    else:
        shown = axes.imshow(np.swapaxes(values, 0, 1), extent=(*along, *across), **options)
        axes.set(xlabel=units.x.label, ylabel=units.y.label)
        axes.set_box_aspect(float((film.Y[-1] - film.Y[0]) / (film.X[-1] - film.X[0])))
    axes.grid(False)
    return shown


def scale_note(film: Film, kappa: float, *, upwards: bool = False) -> str:
    """How far a map of `draw_map` is from true proportions, in words; empty where it is to scale."""
    flatness = _flatness(film, kappa)
    stretch = max(1.0, FLATTEST / flatness) if upwards else 1.0 / kappa
    if abs(stretch - 1.0) < 0.01:
        return ""
    longer, shorter, times = ("x", "y", stretch) if stretch > 1.0 else ("y", "x", 1.0 / stretch)
    return f"not to scale: {longer} stretched {numeral(times, 2)} times against {shorter}"


def _flatness(film: Film, kappa: float) -> float:
    """True length of a map along rolling over that across."""
    return float(kappa * (film.X[-1] - film.X[0]) / (film.Y[-1] - film.Y[0]))


def draw_ellipse(axes: Axes, film: Film, colour: str, *, upwards: bool = False) -> None:
    """Edge of the dry contact, dashed."""
    units = units_of(film.scales)
    axes_of = (units.y.factor, units.x.factor) if upwards else (units.x.factor, units.y.factor)
    width, height = (2.0 * semi_axis for semi_axis in axes_of)
    axes.add_patch(Ellipse((0.0, 0.0), width, height, fill=False, edgecolor=colour, linestyle="--", linewidth=1.0))
