"""Catalogue of deep-groove ball bearings: internal dimensions by name, each row with its source.

Makers print bore, outside diameter and width, and few print balls and pitch circle. Rows from GMN's catalogue,
from a measurement or from a data set are as printed there. Those of NSK are derived from its load ratings, which
ISO 76 and ISO 281 define by the balls,

    C0r/f0 = Z D^2,    Cr = 1.3 fc Z^(2/3) D^1.8,    dm = (d + D_outside)/2,    fc of D/dm,

with D in mm: Z and D are the number and the multiple of 1/64 inch that fit C0r, f0 and Cr best, within 1 %.
Bearings of one name differ between makers: by that rule NSK's 6200 has 8 balls of 4.762 mm, GMN prints 7 of
5.556 mm. For the other 13 rows of GMN the rule finds the balls that GMN prints.

Conformities are hardly ever known: where a row has none, 0.52 is assumed; 0.515 inside and 0.525 outside would
change the stiffness by 1 %.
"""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from itertools import groupby
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
    bore: float | None  # None where the source does not have it
    source: str
    sourced: bool  # balls and diameters are in the source; False: derived by the rule above
    conformity: float = USUAL_CONFORMITY
    conformity_known: bool = False


def _printed(balls: int, ball_mm: float, pitch_mm: float, bore_mm: float) -> Row:
    ball, pitch, bore = (round(1e-3 * length, 9) for length in (ball_mm, pitch_mm, bore_mm))
    return Row(balls, ball, pitch, bore, "GMN, catalogue 4000 0813 EN", True)


def _derived(balls: int, sixty_fourths: int, bore_mm: int, outside_mm: int) -> Row:
    ball, pitch = round(sixty_fourths / 64 * INCH, 6), round(0.5e-3 * (bore_mm + outside_mm), 7)
    source = "derived from the load ratings Cr, C0r and f0 of NSK's catalogue of rolling bearings"
    return Row(balls, ball, pitch, round(1e-3 * bore_mm, 4), source, False)


_CWRU = "Case Western Reserve University, Bearing Data Center"
# Dimensions of bearings, with their sources
ROWS: dict[str, Row] = {
    "6000": _printed(7, 4.762, 18.0, 10),
    "6001": _printed(8, 4.762, 20.0, 12),
    "6002": _printed(9, 4.762, 23.5, 15),
    "6003": _printed(10, 4.762, 26.0, 17),
    "6004": _printed(9, 6.350, 31.0, 20),
    "6005": _printed(10, 6.350, 36.0, 25),
    "6006": _printed(11, 7.144, 42.5, 30),
    "6007": _derived(11, 20, 35, 62),
    "6008": _derived(12, 20, 40, 68),
    "6009": _derived(13, 22, 45, 75),
    "6010": Row(14, 8.73e-3, 65.0e-3, 50e-3, "measured by J. Gerstmayr on a 6010/C3, examples of Exudyn", True),
    "6200": _printed(7, 5.556, 20.0, 10),
    "6201": _printed(7, 5.953, 22.0, 12),
    "6202": _printed(8, 5.953, 25.3, 15),
    "6203": Row(8, 0.2656 * INCH, 1.122 * INCH, 17e-3, f"{_CWRU}, fan end, 6203-2RS JEM SKF", True),
    "6204": _printed(8, 7.938, 33.5, 20),
    "6205": Row(9, 0.3126 * INCH, 1.537 * INCH, 25e-3, f"{_CWRU}, drive end, 6205-2RS JEM SKF", True),
    "6206": _printed(9, 9.525, 46.0, 30),
    "6207": _printed(9, 11.112, 53.5, 35),
    "6208": _printed(9, 11.906, 60.0, 40),
    "6209": _derived(10, 30, 45, 85),
    "6210": _derived(10, 32, 50, 90),
    "6211": _derived(10, 36, 55, 100),
    "6300": _derived(6, 18, 10, 35),
    "6301": _derived(6, 20, 12, 37),
    "6302": _derived(7, 20, 15, 42),
    "6303": _derived(7, 22, 17, 47),
    "6304": _derived(7, 24, 20, 52),
    "6305": _derived(8, 26, 25, 62),
    "6306": _derived(8, 30, 30, 72),
    "6307": _derived(8, 34, 35, 80),
    "6308": _derived(8, 38, 40, 90),
    "6309": _derived(8, 44, 45, 100),
    "6310": _derived(8, 48, 50, 110),
    "6311": _derived(8, 52, 55, 120),
    "6312": _derived(8, 56, 60, 130),
    "209": Row(
        9,
        12.7e-3,
        65.0e-3,
        45e-3,
        "Harris, Rolling Bearing Analysis, ch. 7: groove radii 6.60 mm",
        True,
        6.60 / 12.7,
        True,
    ),
    "UER204": Row(8, 7.92e-3, 34.55e-3, 20e-3, "LDK UER204 of the XJTU-SY bearing data sets", True),
    "ER-16K": Row(
        9, 7.9375e-3, 38.50e-3, INCH, "MB ER-16K of the machinery fault simulator, Curtin University", True
    ),
    "NICE": Row(8, 0.235 * INCH, 1.245 * INCH, None, "NICE bearing of the MFPT bearing fault data set", True),
}


def names_in_short(names: Sequence[str]) -> str:
    """Names of the catalogue in its order, neighbours of a series as "6200 to 6211"."""
    parts = []
    for series, group in groupby(names, lambda name: name[:2] if name.isdigit() and len(name) == 4 else name):
        found = list(group)
        whole = len(found) > 2 and len(series) == 2 and int(found[-1]) - int(found[0]) == len(found) - 1
        parts += [f"{found[0]} to {found[-1]}"] if whole else found
    return ", ".join(parts)


def catalogue_row(name: str) -> tuple[str, Row]:
    """Name as the catalogue has it, and its row.

    Raises
    ------
    InputError
        No such bearing; it names the nearest of the same kind of name, and the series.
    """
    wanted = str(name).strip().upper()
    if wanted in ROWS:
        return wanted, ROWS[wanted]
    # the first digit says what kind of bearing it is: a 7206 has the size of a 6206, and contact angles
    alike = [known for known in ROWS if known[0] == wanted[:1]]
    near = [known for known in alike if sorted(known) == sorted(wanted)]  # 6250 for 6205
    near += [known for known in get_close_matches(wanted, alike, NAMES_SHOWN, 0.0) if known not in near]
    near = near[:NAMES_SHOWN]
    every = names_in_short(list(ROWS))
    nearest = f"{', '.join(near)} (nearest) or of {every}" if near else f"{every}, all of them deep-groove"
    allowed = f"one of {nearest}"
    raise InputError("name", name, f"{allowed}; any other bearing by its dimensions: BallBearing(balls=, ...)")
