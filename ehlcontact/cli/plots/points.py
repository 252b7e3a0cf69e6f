"""Films, stiffness, damping and decay over the points of a study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, new_figure

Numbers = Mapping[str, float | None]
AXES = {"speed_rpm": ("speed [rev/min]", "rpm"), "radial_load": ("radial load [N]", "N")}
PANELS = (  # number, what it is shown in, label
    ("h_central", 1e6, "central film [µm]"),
    ("h_min", 1e6, "smallest film [µm]"),
    ("lambda", 1.0, "lambda ratio"),
    ("stiffness", 1e-6, "stiffness of a contact [N/µm]"),
    ("damping", 1.0, "damping of a contact [N s/m]"),
    ("decrement", 1.0, "logarithmic decrement"),
)
ROOM = 1.05  # height of a panel over its highest value
COLOURS = (BLUE, RED, GREEN, ORANGE, PURPLE, GREY)
MARKS = "osD^v*"


def over_points(points: Sequence[Numbers]) -> Figure:
    """A panel per number, over the speed, or over the load where there are more; a line for each other one.

    What no point has, as the lambda ratio of a study without roughness, has no panel.
    """
    counts = {name: len({point[name] for point in points}) for name in AXES}
    along, apart = sorted(AXES, key=lambda name: -counts[name])
    panels = [panel for panel in PANELS if any(point[panel[0]] is not None for point in points)]
    rows = (len(panels) + 1) // 2
    figure = new_figure(2.6 * max(rows, 1) + 0.5)
    for k, (name, unit, label) in enumerate(panels, start=1):
        axes = figure.add_subplot(rows, 2, k)
        for i, value in enumerate(sorted({float(point[apart] or 0.0) for point in points})):
            found = [(point[along], point[name]) for point in points if point[apart] == value]
            line = sorted((x, unit * y) for x, y in found if x is not None and y is not None)
            # a colour and a mark for every line, also in print
            colour, mark = COLOURS[i % len(COLOURS)], MARKS[(i // len(COLOURS) + i) % len(MARKS)]
            said = f"{numeral(value)} {AXES[apart][1]}"
            axes.plot([x for x, _ in line], [y for _, y in line], marker=mark, color=colour, label=said)
        axes.set(xlabel=AXES[along][0], title=label)
        axes.set_ylim(0.0, ROOM * axes.get_ylim()[1])
        if k == 1 and counts[apart] > 1:
            axes.legend(ncols=1 + counts[apart] // 7)
    return figure
