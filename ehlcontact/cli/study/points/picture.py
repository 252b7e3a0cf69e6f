"""Films, stiffness, damping and decay over the points of a study: a file of a picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.points.numbers import NUMBERS
from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import Line, Panel, Picture

Numbers = Mapping[str, float | None]
AXES = {"speed_rpm": ("speed [rev/min]", "rpm"), "radial_load": ("radial load [N]", "N")}


def draw_points(points: Sequence[Numbers], path: Path) -> None:
    """Draw a panel per number, over the speed, or over the load where there are more; a line for each other one.

    What no point has, as the lambda ratio of a study without roughness, has no panel.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    counts = {name: len({point[name] for point in points}) for name in AXES}
    along, apart = sorted(AXES, key=lambda name: -counts[name])
    x, others = (np.unique([float(point[name] or 0.0) for point in points]) for name in (along, apart))
    at = {(float(point[along] or 0.0), float(point[apart] or 0.0)): point for point in points}
    panels = []
    for name, one in NUMBERS.items():
        if not one.label or all(point[name] is None for point in points):
            continue
        lines = []
        for k, other in enumerate(others.tolist()):
            found = [(at.get((place, other)) or {}).get(name) for place in x.tolist()]
            values = np.array([np.nan if value is None else one.factor * value for value in found])
            name_of = f"{numeral(other)} {AXES[apart][1]}" if len(others) > 1 else ""
            lines.append(Line(x, values, name_of, mark="osD^v*"[k % 6]))
        panels.append(Panel(lines, AXES[along][0], one.label, bottom=0.0))
    draw(Picture(panels), path)
