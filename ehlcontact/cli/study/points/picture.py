"""Films, stiffness, damping and decay over the points of a study: a file of a picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.points.numbers import NUMBERS
from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import Line, Panel, Picture

AXES = {"speed_rpm": ("speed [rev/min]", "rpm"), "radial_load": ("radial load [N]", "N")}


def draw_points(rows: Sequence[Any], path: Path) -> None:
    """Draw a panel per number, over the list with the most numbers; a line for each choice of the other lists.

    What no point has, as the lambda ratio of a study without roughness, has no panel.

    Parameters
    ----------
    rows : sequence of Row
        With `numbers`, and the `point` that has what it chose of lists.
    path : Path
        Of the picture.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    coordinates = [_coordinates(row) for row in rows]
    names = [name for name in coordinates[0] if len({str(place[name][0]) for place in coordinates}) > 1]
    along = max((name for name in names if _is_number(coordinates, name)), key=_count(coordinates), default="")
    apart = [name for name in names if name != along]
    lines: dict[str, list[int]] = {}
    for k, place in enumerate(coordinates):
        lines.setdefault(", ".join(place[name][1] for name in apart), []).append(k)
    places = [float(place[along][0]) if along else float(k + 1) for k, place in enumerate(coordinates)]
    label = coordinates[0][along][2] if along else "number of the point"
    panels = []
    for name, one in NUMBERS.items():
        if not one.label or all(row.numbers[name] is None for row in rows):
            continue
        drawn = []
        for k, (words, own) in enumerate(lines.items()):
            order = sorted(own, key=lambda j: places[j])
            found = [rows[j].numbers[name] for j in order]
            values = np.array([np.nan if value is None else one.factor * value for value in found])
            drawn.append(Line(np.array([places[j] for j in order]), values, words, mark="osD^v*"[k % 6]))
        panels.append(Panel(drawn, label, one.label, bottom=0.0))
    draw(Picture(panels), path)


def _coordinates(row: Any) -> dict[str, tuple[Any, str, str]]:
    """Of a point by the names of lists: value, value in words, and the label of an axis."""
    found = {
        name: (row.numbers[name] or 0.0, f"{numeral(row.numbers[name] or 0.0)} {unit}", label)
        for name, (label, unit) in AXES.items()
    }
    return found | {choice.entry: (choice.value, choice.words, choice.head) for choice in row.point.chosen}


def _is_number(coordinates: Sequence[Mapping[str, Any]], name: str) -> bool:
    return all(type(place[name][0]) in (int, float) for place in coordinates)


def _count(coordinates: Sequence[Mapping[str, Any]]) -> Callable[[str], int]:
    return lambda name: len({place[name][0] for place in coordinates})
