"""Catalogue of deep-groove ball bearings: internal dimensions by name, each row with its source.

Makers print bore, outside diameter and width; balls and pitch circle are measured, or handed down. Only rows with
a source that could be read say so. Conformities are hardly ever known: where a row has none, 0.52 is assumed;
0.515 inside and 0.525 outside would change the stiffness by 1 %.
"""

from __future__ import annotations

from difflib import get_close_matches
from typing import NamedTuple

from ehlcontact.errors import InputError

INCH = 0.0254  # m
USUAL_CONFORMITY = 0.52  # groove radius over ball diameter; 0.515 to 0.53 in print
NAMES_SHOWN = 3  # of the catalogue, nearest to one that is unknown


class Row(NamedTuple):
    """Lengths in m."""

    balls: int
    ball_diameter: float
    pitch_diameter: float
    source: str
    sourced: bool  # False: commonly used, from nowhere that could be read
    conformity: float = USUAL_CONFORMITY
    conformity_known: bool = False


_USED = "commonly used values, no source that could be read"
_CWRU = "Case Western Reserve University, Bearing Data Center"
# Dimensions of bearings, with their sources
ROWS: dict[str, Row] = {
    "6202": Row(8, 5.953e-3, 25.00e-3, _USED, False),
    "6203": Row(8, 0.2656 * INCH, 1.122 * INCH, f"{_CWRU}, fan end, 6203-2RS JEM SKF", True),
    "6204": Row(8, 7.938e-3, 33.50e-3, _USED, False),
    "6205": Row(9, 0.3126 * INCH, 1.537 * INCH, f"{_CWRU}, drive end, 6205-2RS JEM SKF", True),
    "6206": Row(9, 9.525e-3, 46.00e-3, _USED, False),
    "6305": Row(7, 11.5e-3, 44.6e-3, _USED, False),
    "6306": Row(8, 12.0e-3, 52.0e-3, _USED, False),
    "6010": Row(14, 8.73e-3, 65.0e-3, "measured by J. Gerstmayr on a 6010/C3, examples of Exudyn", True),
    "209": Row(
        9,
        12.7e-3,
        65.0e-3,
        "Harris, Rolling Bearing Analysis, ch. 7: groove radii 6.60 mm",
        True,
        6.60 / 12.7,
        True,
    ),
    "UER204": Row(8, 7.92e-3, 34.55e-3, "LDK UER204 of the XJTU-SY bearing data sets", True),
    "ER-16K": Row(9, 7.9375e-3, 38.50e-3, "MB ER-16K of the machinery fault simulator, Curtin University", True),
}


def catalogue_row(name: str) -> tuple[str, Row]:
    """Name as the catalogue has it, and its row.

    Raises
    ------
    InputError
        No such bearing; it names the nearest of the same kind of name, and all others.
    """
    wanted = str(name).strip().upper()
    if wanted in ROWS:
        return wanted, ROWS[wanted]
    # the first digit says what kind of bearing it is: a 7206 has the size of a 6206, and contact angles
    near = get_close_matches(wanted, [known for known in ROWS if known[0] == wanted[:1]], NAMES_SHOWN, 0.0)
    others = ", ".join(known for known in ROWS if known not in near)
    nearest = f"{', '.join(near)} (nearest) or of {others}" if near else f"{others}, all of them deep-groove"
    allowed = f"one of {nearest}"
    raise InputError("name", name, f"{allowed}; any other bearing by its dimensions: BallBearing(balls=, ...)")
