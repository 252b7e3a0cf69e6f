"""Figure of the force of a bearing with a spall, for pages.

Four panels: force over the turns of the shaft, one passage of a ball, envelope spectrum, lines of the force.
`found` is a `StudyDefect`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import plotly.graph_objects as go

from ehlcontact.cli.plots.style import BLUE, GREY, ORANGE, grid, label_axes, vertical
from reduced_models.bearing.kinematics import RPM_TO_HZ

LOOKS: dict[str, tuple[str, dict[str, Any]]] = {  # bare heights first: the film is drawn over them
    "none": ("bare step under the ball", {"color": ORANGE, "width": 1.0}),
    "film": ("filtered by contact and film", {"color": BLUE, "width": 1.6}),
}
SHOWN = 1.5  # turns of the shaft, over time
MULTIPLES = 6  # of the order of the spall, in the spectrum
DEEPEST = 3e-4  # of the largest line, the smallest that is shown
TITLES = ["over turns of the shaft", "one passage", "envelope", "lines of the force"]


def signal(found: Any) -> go.Figure:
    """Force over the turns, one passage of it, the spectrum of its envelope, and its lines over the frequency."""
    figure = grid(2, 2, heights=[280, 280], titles=TITLES)
    hertz, largest = found.order * found.speed_rpm * RPM_TO_HZ, 0.0
    for name, (text, line) in LOOKS.items():
        look: Any = {"line": line, "name": text, "legendgroup": name}
        for col, (low, high) in enumerate(((0.0, SHOWN), found.passage), start=1):
            shown = (low <= found.turns) & (found.turns <= high)
            figure.add_scatter(
                x=found.turns[shown], y=found.force[name][shown], **look, showlegend=col == 1, row=1, col=col
            )
        envelope, lines = found.envelope[name], found.lines[name]
        within = envelope.hz <= (MULTIPLES + 0.5) * hertz
        figure.add_scatter(
            x=envelope.hz[within], y=envelope.amplitude[within], **look, showlegend=False, row=2, col=1
        )
        sizes = lines.amplitude[lines.order > 0.0, 1]
        dots: Any = {"mode": "markers", "marker": {"color": line["color"], "size": 4}, "name": text}
        at = lines.hz[lines.order > 0.0] * 1e-3
        figure.add_scatter(x=at, y=sizes, **dots, legendgroup=name, showlegend=False, row=2, col=2)
        largest = max(largest, float(sizes.max(initial=0.0)))
    for col in (1, 2):
        label_axes(figure, "turns of the shaft", "change of the force [N]", 1, col)
    label_axes(figure, "frequency [Hz]", "amplitude of the envelope [N]", 2, 1)
    label_axes(figure, "frequency [kHz]", "amplitude of a line [N]", 2, 2, type="log")
    if largest > 0.0:
        ends = [float(np.log10(share * largest)) for share in (DEEPEST, 2.0)]
        figure.update_yaxes(range=ends, row=2, col=2)
    for j in range(1, MULTIPLES + 1):
        vertical(figure, j * hertz, f"{j}x" if j > 1 else found.name, 2, 1, GREY)
    return figure
