"""A bearing with heat and with a layer of oil in a page: films around the ring, K and C over the frequency.

`found` is an `OilAndHeat`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import plotly.graph_objects as go

from ehlcontact.cli.plots.bearing import COEFFICIENTS
from ehlcontact.cli.plots.rotor import MICRO
from ehlcontact.cli.plots.style import BLUE, GREEN, INK, ORANGE, RED, grid, label_axes, vertical
from reduced_models.bearing.oil_and_heat import BOTH, FLOODED, HEAT, LAYER
from reduced_models.bearing.picture import from_load
from reduced_models.bearing.race import RACES

LOOKS: dict[str, dict[str, Any]] = {
    FLOODED: {"color": INK, "dash": "dash"},
    HEAT: {"color": RED},
    LAYER: {"color": BLUE},
    BOTH: {"color": GREEN, "dash": "dot"},
}


def films(found: Any) -> go.Figure:
    """Central films of the balls that carry around the ring, at both races."""
    figure = grid(1, 2, heights=[290], titles=[f"{race} race" for race in RACES])
    state = found.state
    place = from_load(state)
    order = [k for k in np.argsort(place) if state.approach[k].sum() > 0.0]
    for col in range(len(RACES)):
        for key, one in found.conditions.items():
            look: Any = {"mode": "lines+markers", "line": LOOKS[key], "name": key}
            figure.add_scatter(x=place[order], y=1e6 * one.h_central[order, col], **look, row=1, col=col + 1)
        label_axes(
            figure, "angle from the load [degrees]", f"central film [{MICRO}]", 1, col + 1, rangemode="tozero"
        )
    return figure.update_yaxes(matches="y")


def coefficients(found: Any) -> go.Figure:
    """K and C over the frequency of a small vibration, in the first of the directions."""
    figure, way = grid(1, 2, heights=[290]), next(iter(found.ways.values()))
    order = np.argsort(found.hz)
    for col, (name, unit, label) in enumerate(COEFFICIENTS, start=1):
        for key, one in found.conditions.items():
            y = getattr(one, name)[order, way] * unit
            figure.add_scatter(x=found.hz[order], y=y, line=LOOKS[key], name=key, row=1, col=col)
        figure.update_xaxes(type="log", row=1, col=col)
        label_axes(figure, "frequency of the vibration [Hz]", label, 1, col)
        vertical(figure, float(found.hz[0]), "", 1, col, ORANGE)
    return figure
