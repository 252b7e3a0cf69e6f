"""Pseudo-interferograms: the film as an optical rig would show it."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.plots.maps import draw_ellipse, draw_map, refined, scale_note
from ehlcontact.cli.plots.style import GREY, new_figure
from ehlcontact.film import Film, Interferogram, film_of, interferogram
from ehlcontact.point import moes_point
from ehlcontact.results import SteadyResult
from ehlcontact.transient.result import SimulationResult

LIGHTS = (630e-9, 532e-9, 467e-9)  # m, red, green and blue
REFRACTIVE_INDEX = 1.5  # of the oil
COHERENCE = 1.5e-6  # m of film over which the fringes of the three lights fade
FRINGES_AT_REST = 3  # to the central film, where there is no unit of length
FADING = 2.5  # central films over which these fade

Array = NDArray[np.float64]


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


def one_light(film: Film, wavelength: float) -> Array:
    """Fringes of one light, for one of the maps of a film."""
    return brightness(interferogram(film, wavelength, REFRACTIVE_INDEX))


def three_lights(result: SteadyResult) -> Figure:
    """Fringes of red, green and blue light on top of one another; zero film is dark."""
    film = refined(film_of(result))
    channels = [
        brightness(interferogram(film, light, REFRACTIVE_INDEX, np.pi), film.si.h / COHERENCE) for light in LIGHTS
    ]
    kappa = moes_point(result.point).kappa
    figure = new_figure(3.5)
    axes = figure.subplots()
    draw_map(axes, film, np.stack(channels, axis=-1), kappa, upwards=True)
    draw_ellipse(axes, film, "white", upwards=True)
    axes.set_title(f"pseudo-interferogram: red, green and blue light, oil of index {REFRACTIVE_INDEX}")
    figure.suptitle(scale_note(film, kappa, upwards=True), fontsize=10, color=GREY)
    return figure


def snapshots(run: SimulationResult) -> Figure:
    """Fringes at each snapshot of a simulation without a unit of length: three to the central film at rest."""
    count = run.snapshot_T.size
    columns = min(count, 4)
    rows = -(-count // columns)
    kappa, growth = moes_point(run.point).kappa, max(1.0, float(run.load.max())) ** (1.0 / 3.0)
    figure = new_figure(2.35 * rows + 0.55)
    panels = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True).ravel()
    for axes, T in zip(panels, run.snapshot_T, strict=False):
        film = refined(film_of(run, float(T)), growth)
        depth = film.H / run.h_central[0]
        order = FRINGES_AT_REST * depth
        intensity = 0.5 * (1.0 + np.cos(2.0 * np.pi * order))
        fringes = Interferogram(intensity, order, film.X, film.Y, (1.0, 1.0))
        draw_map(axes, film, brightness(fringes, depth / FADING), kappa, cmap="gray", vmin=0.0, vmax=1.0)
        axes.set(title=f"T = {numeral(T)}", xlabel="", ylabel="")
    for axes in panels[count:]:
        axes.set_visible(False)
    figure.suptitle(scale_note(film, kappa), fontsize=10, color=GREY)
    figure.supxlabel("X = x/a (surfaces move to the right)", fontsize=10)
    figure.supylabel("Y = y/b", fontsize=10)
    return figure
