"""A ball bearing: load zone and films at one speed, stiffness and damping over speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.plots.style import BLUE, RED, new_figure
from reduced_models import BearingCoefficients
from reduced_models.bearing.picture import films, load_zone

ROOM = 1.05  # height of a panel over its highest value


def bearing_figure(report: Any, curve: Sequence[BearingCoefficients]) -> Figure:
    """The middle one of the speeds ball by ball; K and C along `curve`, those asked for as points."""
    state = report.states[len(report.states) // 2]
    figure = new_figure(7.6)
    load_zone(figure.add_subplot(2, 2, 1, projection="polar"), state)
    films(figure.add_subplot(2, 2, 2), state)
    panels = figure.add_subplot(2, 2, 3), figure.add_subplot(2, 2, 4)
    for axes, name, unit, label in (
        (panels[0], "stiffness", 1e-6, "stiffness [N/µm]"),
        (panels[1], "damping", 1.0, "damping [N s/m]"),
    ):
        for k, colour, direction in ((1, RED, "along the load"), (0, BLUE, "across it")):
            line = [getattr(at, name)[0, k, k] * unit for at in curve]
            points = [getattr(at, name)[0, k, k] * unit for at in report.coefficients]
            axes.plot([at.speed_rpm for at in curve], line, color=colour, label=direction)
            axes.plot([at.speed_rpm for at in report.coefficients], points, "o", color=colour)
        axes.set(xlabel="speed [rev/min]", title=f"{label}, at the frequency of the shaft")
        axes.set_ylim(0.0, max(ROOM * axes.get_ylim()[1], 1.0))  # a dry bearing damps nothing
    panels[0].legend(loc="lower right")
    name, load = report.job.bearing.name or "ball bearing", numeral(report.job.load)
    figure.suptitle(f"{name}, {load} N; above at {numeral(state.speed_rpm)} rev/min, a ball under the load")
    return figure
