"""The steady film as a tribologist looks at it: maps, mid-planes, convergence."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.plots.fringes import REFRACTIVE_INDEX, one_light
from ehlcontact.cli.plots.maps import VIEW, draw_ellipse, draw_map, refined, scale_note
from ehlcontact.cli.plots.style import BLUE, GREY, ORANGE, RED, legend_above, new_figure
from ehlcontact.cli.plots.units import units_of
from ehlcontact.film import Film, Profile, film_of
from ehlcontact.point import moes_point
from ehlcontact.results import SteadyResult

WAVELENGTH = 600e-9  # m, of the fringes beside the maps
CONTOURS = np.array([0.92, 1.08, 1.3, 1.8])  # of the central film


def steady_figure(result: SteadyResult) -> Figure:
    """Pressure, film, fringes where there are scales, and both mid-planes: the figure of ``steady --figure``."""
    film = film_of(result)
    seen, si, units = refined(film), film.scales is not None, units_of(film.scales)
    kappa = moes_point(result.point).kappa
    figure = new_figure(6.8, 10.5)
    parts: Any = figure.subfigures(2, 1, height_ratios=(1.25, 1.0))
    maps, profiles = parts
    panels = maps.subplots(1, 3 if si else 2, sharey=True)
    maps.colorbar(
        _pressure(panels[0], seen, kappa), ax=panels[0], label=units_of(film.scales).pressure.label, location="top"
    )
    shown = _film(panels[1], seen, kappa, 2.0 * result.h_central)
    maps.colorbar(shown, ax=panels[1], label=units.film.label, location="top", extend="max")
    if si:
        shown = draw_map(panels[2], seen, one_light(seen, WAVELENGTH), kappa, cmap="gray", vmin=0.0, vmax=1.0)
        label = f"fringes at {WAVELENGTH * 1e9:.0f} nm, oil of index {REFRACTIVE_INDEX}"
        maps.colorbar(shown, ax=panels[2], label=label, location="top")
    for panel, colour in zip(panels, ("white", "white", RED), strict=False):
        draw_ellipse(panel, film, colour)
    for panel in panels[1:]:
        panel.set_ylabel("")
    maps.suptitle(scale_note(seen, kappa), fontsize=10, color=GREY)
    _midplanes(profiles.subplots(1, 2), film, (-VIEW[2], VIEW[2]))
    return figure


def film_maps(result: SteadyResult) -> Figure:
    """Pressure and film over the contact, the surfaces moving upwards."""
    film = refined(film_of(result))
    units, kappa = units_of(film.scales), moes_point(result.point).kappa
    figure = new_figure(5.8)
    upper, lower = figure.subplots(2, 1, sharex=True)
    figure.colorbar(_pressure(upper, film, kappa, upwards=True), ax=upper, label=units.pressure.label, pad=0.01)
    shown = _film(lower, film, kappa, 1.8 * result.h_central, upwards=True)
    figure.colorbar(shown, ax=lower, label=units.film.label, pad=0.01, extend="max")
    lower.contour(
        units.y(film.Y), units.x(film.X), film.H, CONTOURS * result.h_central, colors="white", linewidths=0.6
    )
    for axes in (upper, lower):
        draw_ellipse(axes, film, "white", upwards=True)
    upper.set(title="pressure; the surfaces move upwards, dashed: Hertz ellipse", xlabel="")
    lower.set_title(f"film; lines at {', '.join(numeral(level) for level in CONTOURS)} of the central film")
    figure.suptitle(scale_note(film, kappa, upwards=True), fontsize=10, color=GREY)
    return figure


def midplanes(result: SteadyResult) -> Figure:
    """Pressure and film along rolling, and across over one half."""
    figure = new_figure(3.6)
    _midplanes(figure.subplots(1, 2), film_of(result), (0.0, 1.6))
    return figure


def convergence(result: SteadyResult) -> Figure:
    """Changes of the pressure, and residuals, of the multigrid cycles."""
    figure = new_figure(3.2, 6.5)
    axes = figure.subplots()
    cycles = np.arange(len(result.residuals))
    floor = 1e-17
    lines = [
        ("residual of Reynolds, over the dry start's", "o-", BLUE, result.residuals / result.dry_residual),
        ("residual of the load balance, over the load", "s-", ORANGE, np.abs(result.load_residuals) + floor),
        ("change of approach, over the dry one", "^-", GREY, result.approach_changes + floor),
        ("largest change of pressure, over Hertz's", "D-", RED, result.pressure_changes + floor),
    ]
    for label, style, colour, values in lines:
        if values.size:  # files of earlier versions have no changes of pressure
            axes.semilogy(cycles[-values.size :], values, style, color=colour, label=label)
    axes.set(xlabel="cycle on the finest grid", ylabel="change or residual [-]", xlim=(0, None))
    axes.legend()
    return figure


def _pressure(axes: Axes, film: Film, kappa: float, *, upwards: bool = False) -> Any:
    values = units_of(film.scales).pressure(np.maximum(film.P, 0.0))  # the spline may swing below zero
    return draw_map(axes, film, values, kappa, upwards=upwards, cmap="inferno", vmin=0.0)


def _film(axes: Axes, film: Film, kappa: float, thickest: float, *, upwards: bool = False) -> Any:
    unit = units_of(film.scales).film
    limits = {"vmin": unit(float(film.H.min())), "vmax": unit(thickest)}
    return draw_map(axes, film, unit(film.H), kappa, upwards=upwards, cmap="viridis", **limits)


def _midplanes(panels: Any, film: Film, across: tuple[float, float]) -> None:
    _midplane(panels[0], film.along, (VIEW[0], VIEW[1]))
    _midplane(panels[1], film.across, across)


def _midplane(axes: Axes, profile: Profile, limits: tuple[float, float]) -> None:
    """Film and pressure along one mid-plane, with the dry Hertz pressure."""
    units = units_of(profile.scales)
    place = units.y if profile.across else units.x
    hertz = np.linspace(-1.0, 1.0, 201)
    axes.plot(place(hertz), units.pressure(np.sqrt(1.0 - hertz**2)), "--", color=GREY, label="dry Hertz")
    axes.plot(place(profile.X), units.pressure(profile.P), color=RED, label="pressure")
    axes.set(xlim=(place(limits[0]), place(limits[1])), ylim=(0.0, None))
    axes.set_xlabel(f"{place.label}; {'x' if profile.across else 'y'} = 0")
    axes.set_ylabel(units.pressure.label, color=RED)
    film = axes.twinx()
    film.plot(place(profile.X), units.film(profile.H), color=BLUE, label="film")
    film.set(ylim=(0.0, units.film(5.0 * float(np.interp(0.0, profile.X, profile.H)))))
    film.set_ylabel(units.film.label, color=BLUE)
    film.grid(False)
    film.spines["right"].set_visible(True)
    legend_above(axes, handles=[*axes.get_lines(), *film.get_lines()])
