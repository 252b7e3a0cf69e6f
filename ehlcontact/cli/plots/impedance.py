"""Stiffness and damping of the contact over frequency, and what the elements have of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go

from ehlcontact.cli.plots.style import BLUE, GREEN, RED, grid, label_axes, vertical
from ehlcontact.results import ImpedanceResult
from reduced_models.fitting.result import FitResult


def impedance(
    response: ImpedanceResult, memory: Any, cubics: Sequence[FitResult], frequencies: tuple[float, float]
) -> go.Figure:
    """K and C of the film, of the film-memory element where there is one, and of cubics at their frequency.

    `frequencies` are those of the rotor's speed and of its vertical mode, dimensionless.
    """
    figure = grid(1, 2, heights=[270])
    moving = response.Omega > 0.0
    found = [cubic for cubic in cubics if cubic.tangent is not None]
    at = [float(np.mean(cubic.valid["omega"])) for cubic in found]
    Omega = response.Omega[moving]
    w = np.geomspace(min(0.5 * frequencies[0], float(Omega[0])), float(Omega[-1]), 300)
    Z = None if memory is None else memory.impedance(Omega=w)
    panels = (
        (response.stiffness, [cubic.tangent for cubic in found], "stiffness K [-]", "linear"),
        (response.damping, [cubic.parameters["C1"] for cubic in found], "damping C [-]", "log"),
    )
    for col, (values, known, label, scale) in enumerate(panels, start=1):
        cell: Any = {"row": 1, "col": col}
        dots: Any = {"mode": "markers", "marker": {"color": BLUE, "size": 5}}
        figure.add_scatter(x=Omega, y=values[moving], name="film", **dots, **cell)
        if Z is not None:
            smooth = Z.real if col == 1 else Z.imag / w
            figure.add_scatter(x=w, y=smooth, name="film memory, one element", line_color=GREEN, **cell)
        if found:
            squares: Any = {"mode": "markers", "marker": {"color": RED, "size": 8, "symbol": "square"}}
            figure.add_scatter(x=at, y=known, name="cubic element of each record", **squares, **cell)
        label_axes(figure, "frequency Ω [-]", label, **cell, type=scale)
        figure.update_xaxes(type="log", **cell)
        for omega, name in zip(frequencies, ("speed", "mode"), strict=True):
            vertical(figure, omega, name, **cell)
    return figure
