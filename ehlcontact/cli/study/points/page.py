"""Report over several points: numbers of each over speed and load, and links to the reports of all."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.page import write_page
from ehlcontact.cli.plots.points import draw_points
from ehlcontact.cli.study.points.finalise import REPORT
from ehlcontact.cli.study.points.numbers import NUMBERS, Number
from ehlcontact.cli.study.points.summary import PICTURE, Row

COLUMNS = {name: one for name, one in NUMBERS.items() if one.head}  # of the table for people
NARROW = {name: one for name, one in COLUMNS.items() if one.narrow}


def cells(row: Row, columns: Mapping[str, Number] = COLUMNS) -> list[str]:
    """Numbers of a point in words; a dash where there is none."""
    return [
        numeral(None if (value := row.numbers[name]) is None else one.factor * value, one.figures)
        for name, one in columns.items()
    ]


def write_overview(rows: Sequence[Row], document: Mapping[str, Any], folder: Path) -> Path:
    """Write the picture and the page; returns where the page is.

    Raises
    ------
    InputError
        One of them cannot be written.
    """
    picture = ""
    if document["converged"]:
        draw_points([row.numbers for row in rows], folder / PICTURE)
        picture = base64.b64encode((folder / PICTURE).read_bytes()).decode("ascii")
    return write_page(
        folder / REPORT,
        "points.html.j2",
        {},
        picture=picture,
        summary=document,
        rows=rows,
        heads=[one.head for one in COLUMNS.values()],
        cells=cells,
    )
