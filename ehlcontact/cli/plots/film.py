"""The steady film as a tribologist looks at it."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from numpy.typing import NDArray
from scipy.interpolate import RectBivariateSpline

from ehlcontact.cli.plots.style import BLUE, GREY, ORANGE, RED, legend_above, new_figure
from ehlcontact.film import Film
from ehlcontact.film import interferogram as fringes_of
from ehlcontact.point import Scales
from ehlcontact.results import SteadyResult

WAVELENGTHS = (630e-9, 532e-9, 467e-9)  # m, red, green and blue light
REFRACTIVE_INDEX = 1.5  # of the oil
COHERENCE = 1.5e-6  # m of film over which the fringes fade
VIEW = 1.4  # half-width of the maps, in semi-axes


def _mirrored(field: NDArray[np.float64]) -> NDArray[np.float64]:
    """Both signs of Y from the half that was computed, shape (along x, along y)."""
    return np.concatenate([field[:, :0:-1], field], axis=1)


def _refined(field: NDArray[np.float64], result: SteadyResult, scales: Scales) -> tuple[NDArray[np.float64], ...]:
    """Smoothly interpolated field over the view: y [mm], x [mm], values (x, y)."""
    X, Y = np.linspace(-1.8, 1.5, 331), np.linspace(-VIEW, VIEW, 701)
    both = np.concatenate([-result.Y[:0:-1], result.Y])
    values = RectBivariateSpline(result.X, both, _mirrored(field))(X, Y)
    return Y * scales.b * 1e3, X * scales.a * 1e3, values


def _frame(axes: Axes, scales: Scales, colour: str) -> None:
    """Hertz ellipse, limits, and labels; across the page y, for the ellipse is long in y."""
    a, b = scales.a * 1e3, scales.b * 1e3
    axes.add_patch(Ellipse((0.0, 0.0), 2 * b, 2 * a, fill=False, edgecolor=colour, linestyle="--", linewidth=1.0))
    axes.set(xlim=(-VIEW * b, VIEW * b), ylim=(-1.8 * a, 1.5 * a), xlabel="y across [mm]", ylabel="x rolling [mm]")
    axes.grid(False)


def film_maps(result: SteadyResult, scales: Scales) -> Figure:
    """Pressure and film over the contact."""
    figure = new_figure(5.6)
    upper, lower = figure.subplots(2, 1, sharex=True)
    y, x, P = _refined(result.P, result, scales)
    extent = (y[0], y[-1], x[0], x[-1])
    shown = upper.imshow(
        np.maximum(P, 0.0) * scales.pressure * 1e-9, cmap="inferno", origin="lower", extent=extent, aspect="auto"
    )
    figure.colorbar(shown, ax=upper, label="pressure [GPa]", pad=0.01)
    H = _refined(result.H, result, scales)[2]
    unit = scales.length * 1e6
    thin, thick = result.h_min * unit, 1.8 * result.h_central * unit
    shown = lower.imshow(
        H * unit, cmap="viridis", origin="lower", extent=extent, aspect="auto", vmin=thin, vmax=thick
    )
    figure.colorbar(shown, ax=lower, label="film [um]", pad=0.01, extend="max")
    levels = np.array([0.92, 1.08, 1.3, 1.8]) * result.h_central * unit
    lower.contour(y, x, H * unit, levels=levels, colors="white", linewidths=0.6)
    _frame(upper, scales, "white")
    _frame(lower, scales, "white")
    upper.set(title="pressure; the surfaces move upwards, dashed: Hertz ellipse", xlabel="")
    lower.set_title("film; lines at 0.92, 1.08, 1.3 and 1.8 of the central film")
    return figure


def midplane(result: SteadyResult, scales: Scales) -> Figure:
    """Pressure and film along rolling and across."""
    figure = new_figure(3.6)
    i0 = int(np.argmin(np.abs(result.X)))
    cuts = (
        ("x rolling [mm], y = 0", result.X, scales.a * 1e3, result.P[:, 0], result.H[:, 0], (-2.0, 1.5)),
        ("y across [mm], x = 0", result.Y, scales.b * 1e3, result.P[i0], result.H[i0], (0.0, 1.6)),
    )
    for axes, (label, where, unit, P, H, limits) in zip(figure.subplots(1, 2), cuts, strict=True):
        dry = np.sqrt(np.maximum(0.0, 1.0 - where**2))
        axes.plot(where * unit, dry * scales.pressure * 1e-9, "--", color=GREY, label="dry Hertz")
        axes.plot(where * unit, P * scales.pressure * 1e-9, color=RED, label="pressure")
        axes.set(xlabel=label, xlim=(limits[0] * unit, limits[1] * unit), ylim=(0.0, None))
        axes.set_ylabel("pressure [GPa]", color=RED)
        film = axes.twinx()
        film.plot(where * unit, H * scales.length * 1e6, color=BLUE, label="film")
        film.set(ylim=(0.0, 5.0 * result.h_central * scales.length * 1e6))
        film.set_ylabel("film [um]", color=BLUE)
        film.grid(False)
        film.spines["right"].set_visible(True)
        handles = [*axes.get_lines(), *film.get_lines()]
        legend_above(axes, handles=handles)
    return figure


def interferogram(result: SteadyResult, scales: Scales) -> Figure:
    """What an optical rig with three lines of light would show of this film."""
    y, x, H = _refined(result.H, result, scales)
    film = Film(x / (scales.a * 1e3), y / (scales.b * 1e3), H, np.zeros_like(H), scales)
    contrast = np.exp(-((film.h / COHERENCE) ** 2))
    fringes = [fringes_of(film, wave, REFRACTIVE_INDEX, np.pi).intensity for wave in WAVELENGTHS]
    channels = [0.5 + contrast * (intensity - 0.5) for intensity in fringes]
    figure = new_figure(3.0)
    axes = figure.subplots()
    axes.imshow(
        np.stack(channels, axis=-1),
        origin="lower",
        extent=(y[0], y[-1], x[0], x[-1]),
        aspect="auto",
        interpolation="bilinear",
    )
    _frame(axes, scales, "white")
    axes.set_title("pseudo-interferogram: red, green and blue light, oil of index 1.5")
    return figure


def convergence(result: SteadyResult) -> Figure:
    """Residuals of the multigrid cycles."""
    figure = new_figure(3.2, 6.5)
    axes = figure.subplots()
    cycles = np.arange(len(result.residuals))
    floor = 1e-17
    axes.semilogy(
        cycles, result.residuals / result.dry_residual, "o-", color=BLUE, label="Reynolds, of the dry start's"
    )
    axes.semilogy(cycles, np.abs(result.load_residuals) + floor, "s-", color=ORANGE, label="load balance")
    axes.semilogy(cycles[1:], result.approach_changes + floor, "^-", color=GREY, label="change of approach")
    axes.set(xlabel="V(2,1) cycle on the finest grid", ylabel="residual [-]", xlim=(0, None))
    axes.legend()
    return figure
