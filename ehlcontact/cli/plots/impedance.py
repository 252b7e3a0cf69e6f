"""Stiffness and damping of the contact over frequency, and what the elements have of them."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, RED, new_figure
from ehlcontact.cli.study.reduction import RECORDS, Reduction


def impedance(reduction: Reduction, rotor_omega: float) -> Figure:
    """K and C of the film, of the film-memory element, and of the cubics at their frequency."""
    figure = new_figure(3.6)
    panels = figure.subplots(1, 2)
    response, found = reduction.impedance, reduction.memory
    if response is not None:
        w = response.omega[1:]
        for axes, values in zip(panels, (response.stiffness, response.damping), strict=True):
            axes.plot(w, values[1:], "o", color=BLUE, markersize=3.5, label="film")
    if response is not None and not isinstance(found, str):
        w = np.geomspace(0.5 * rotor_omega, float(response.omega[-1]), 300)
        Z = found.element.impedance(w)
        for axes, values in zip(panels, (Z.real, Z.imag / w), strict=True):
            axes.plot(w, values, color=GREEN, label="film memory, one element")
    label = "cubic element of each record"
    for record in RECORDS:
        cubic = reduction.fits.get((record, "cubic"))
        if cubic is not None and cubic.tangent is not None:
            at = np.array(cubic.valid["omega"])
            for axes, value in zip(panels, (cubic.tangent, cubic.parameters["C1"]), strict=True):
                axes.plot(at.mean(), value, "s", color=RED, label=label)
            label = "_"
    for axes, label in zip(panels, ("stiffness K [-]", "damping C [-]"), strict=True):
        axes.axvline(rotor_omega, color=GREY, linestyle=":")
        axes.annotate(" rotor", (rotor_omega, 0.5), xycoords=("data", "axes fraction"), color=GREY)
        axes.set(xscale="log", xlabel="frequency Omega [-]", ylabel=label)
    panels[1].set_yscale("log")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure
