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
from ehlcontact.cli.study.points.summary import PICTURE, Row

# Columns of the table for people: head, number, factor, figures.
COLUMNS = (
    ("speed [rpm]", "speed_rpm", 1.0, 6),
    ("load [N]", "radial_load", 1.0, 6),
    ("p_h [GPa]", "p_hertz", 1e-9, 3),
    ("h_c [µm]", "h_central", 1e6, 3),
    ("h_min [µm]", "h_min", 1e6, 3),
    ("lambda", "lambda", 1.0, 3),
    ("K [N/µm]", "stiffness", 1e-6, 3),
    ("C [N s/m]", "damping", 1.0, 3),
    ("decay [Hz]", "decay_hz", 1.0, 4),
    ("decrement", "decrement", 1.0, 3),
)


NARROW = tuple(column for column in COLUMNS if column[1] not in ("p_hertz", "decay_hz"))  # for 80 characters


def cells(row: Row, columns: Sequence[tuple[str, str, float, int]] = COLUMNS) -> list[str]:
    """Numbers of a point in words; a dash where there is none."""
    return [
        numeral(None if (value := row.numbers[name]) is None else factor * value, figures)
        for _, name, factor, figures in columns
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
        heads=[head for head, *_ in COLUMNS],
        cells=cells,
    )
