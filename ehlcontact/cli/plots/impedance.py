"""Stiffness and damping of the contact over frequency, and what the elements have of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, RED, new_figure
from ehlcontact.results import ImpedanceResult
from reduced_models import FitResult


def impedance(
    response: ImpedanceResult, memory: Any, cubics: Sequence[FitResult], frequencies: tuple[float, float]
) -> Figure:
    """K and C of the film, of the film-memory element where there is one, and of cubics at their frequency.

    `frequencies` are those of the rotor's speed and of its vertical mode, dimensionless.
    """
    figure = new_figure(3.6)
    panels = figure.subplots(1, 2)
    own, highest = frequencies[0], float(response.Omega[-1])
    moving = response.Omega > 0.0
    for axes, values in zip(panels, (response.stiffness, response.damping), strict=True):
        axes.plot(response.Omega[moving], values[moving], "o", color=BLUE, markersize=3.5, label="film")
    if memory is not None:
        w = np.geomspace(min(0.5 * own, float(response.Omega[moving][0])), highest, 300)
        Z = memory.impedance(Omega=w)
        for axes, values in zip(panels, (Z.real, Z.imag / w), strict=True):
            axes.plot(w, values, color=GREEN, label="film memory, one element")
    found = [cubic for cubic in cubics if cubic.tangent is not None]
    at = [float(np.mean(cubic.valid["omega"])) for cubic in found]
    points = ([cubic.tangent for cubic in found], [cubic.parameters["C1"] for cubic in found])
    for axes, known, label in zip(panels, points, ("stiffness K [-]", "damping C [-]"), strict=True):
        if found:
            axes.plot(at, known, "s", color=RED, label="cubic element of each record")
        for omega, name in zip(frequencies, ("speed", "mode"), strict=True):
            axes.axvline(omega, color=GREY, linestyle=":")
            axes.annotate(f" {name}", (omega, 0.5), xycoords=("data", "axes fraction"), color=GREY)
        axes.set(xscale="log", xlabel="frequency \N{GREEK CAPITAL LETTER OMEGA} [-]", ylabel=label)
    panels[1].set_yscale("log")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure
