"""Catalogue of ball bearings, deep groove and angular contact: internal dimensions by name, each with its source.

Makers print bore, outside diameter and width, and few print balls and pitch circle. Rows from GMN's catalogue,
from a measurement or from a data set are as printed there. Those of NSK are derived from its load ratings, which
ISO 76 and ISO 281 define by the balls,

    C0r/f0 = Z D^2,    Cr = 1.3 fc Z^(2/3) D^1.8,    dm = (d + D_outside)/2,    fc of D/dm,

with D in mm: Z and D are the number and the multiple of 1/64 inch that fit C0r, f0 and Cr best, within 1 %. The
ratings of the angular contact bearings (series 72 and 73), of series 160 and of the 608 are quoted from memory:
they were not compared with the printed table. Both equations hold for them within 1 %.
Bearings of one name differ between makers: by that rule NSK's 6200 has 8 balls of 4.762 mm, GMN prints 7 of
5.556 mm. For the other 13 rows of GMN the rule finds the balls that GMN prints. The derived balls of the 6210,
6211, 6303, 6304 and 6309 to 6312 are those of the pass orders that Timken prints for these sizes, within 0.2 %.

For angular contact bearings of contact angle a both standards have

    C0r/f0 = Z D^2 cos a,    Cr = 1.3 fc (cos a)^0.7 Z^(2/3) D^1.8,    fc and f0 of D cos a/dm.

The letter behind the name of an angular contact bearing of NSK is its angle: A 30 degrees, B 40, C 15. Without a
letter it is A, as in most makers' lists. Spindle bearings of GMN are S ... C with 15 degrees and S ... E with 25.

Conformities are hardly ever known: where a row has none, 0.52 is assumed; 0.515 inside and 0.525 outside would
change the stiffness by 1 %.
"""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from itertools import groupby
from math import degrees, radians
from typing import NamedTuple

from ehlcontact.errors import InputError
from reduced_models.bearing.designation import Designation, designation, kind_of, squeezed

INCH = 0.0254  # m
USUAL_CONFORMITY = 0.52  # groove radius over ball diameter; 0.515 to 0.53 in print
BY_DIMENSIONS = "any other bearing by its dimensions: BallBearing(balls=, ...)"
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
    contact_angle: float | None = None  # rad; None: deep groove


def _printed(balls: int, ball_mm: float, pitch_mm: float, bore_mm: float) -> Row:
    ball, pitch, bore = (round(1e-3 * length, 9) for length in (ball_mm, pitch_mm, bore_mm))
    return Row(balls, ball, pitch, bore, "GMN, catalogue 4000 0813 EN", True)


def _derived(balls: int, sixty_fourths: int, bore_mm: int, outside_mm: int) -> Row:
    ball, pitch = round(sixty_fourths / 64 * INCH, 6), round(0.5e-3 * (bore_mm + outside_mm), 7)
    source = "derived from the load ratings Cr, C0r and f0 of NSK's catalogue of rolling bearings"
    return Row(balls, ball, pitch, round(1e-3 * bore_mm, 4), source, False)


def _from_memory(balls: int, sixty_fourths: int, bore_mm: int, outside_mm: int) -> Row:
    row = _derived(balls, sixty_fourths, bore_mm, outside_mm)
    return row._replace(source=f"{row.source}, quoted from memory")


def _angular(balls: int, sixty_fourths: int, bore_mm: int, outside_mm: int, angle: float) -> Row:
    row = _from_memory(balls, sixty_fourths, bore_mm, outside_mm)
    return row._replace(contact_angle=radians(angle))


def _spindle(balls: int, ball_mm: float, pitch_mm: float, bore_mm: float, angle: float) -> Row:
    return _printed(balls, ball_mm, pitch_mm, bore_mm)._replace(contact_angle=radians(angle))


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
    "16004": _from_memory(10, 14, 20, 42),
    "16005": _from_memory(12, 14, 25, 47),
    "16006": _from_memory(12, 16, 30, 55),
    "16007": _from_memory(13, 16, 35, 62),
    "16008": _from_memory(15, 16, 40, 68),
    "16009": _from_memory(14, 18, 45, 75),
    "16010": _from_memory(15, 18, 50, 80),
    "608": _from_memory(7, 10, 8, 22),
    "209": Row(
        9,
        12.7e-3,
        65.0e-3,
        45e-3,
        "Harris, Rolling Bearing Analysis, ch. 7: groove radii 6.60 mm",
        True,
        6.60 / 12.7,
    ),
    "UER204": Row(8, 7.92e-3, 34.55e-3, 20e-3, "LDK UER204 of the XJTU-SY bearing data sets", True),
    "ER-16K": Row(
        9, 7.9375e-3, 38.50e-3, INCH, "MB ER-16K of the machinery fault simulator, Curtin University", True
    ),
    "NICE": Row(8, 0.235 * INCH, 1.245 * INCH, None, "NICE bearing of the MFPT bearing fault data set", True),
    "7204 A": _angular(11, 20, 20, 47, 30),
    "7204 B": _angular(11, 20, 20, 47, 40),
    "7204 C": _angular(10, 20, 20, 47, 15),
    "7205 A": _angular(13, 20, 25, 52, 30),
    "7205 B": _angular(13, 20, 25, 52, 40),
    "7205 C": _angular(12, 20, 25, 52, 15),
    "7206 A": _angular(13, 24, 30, 62, 30),
    "7206 B": _angular(13, 24, 30, 62, 40),
    "7206 C": _angular(12, 24, 30, 62, 15),
    "7207 A": _angular(13, 28, 35, 72, 30),
    "7207 B": _angular(13, 28, 35, 72, 40),
    "7207 C": _angular(12, 28, 35, 72, 15),
    "7208 A": _angular(14, 30, 40, 80, 30),
    "7208 B": _angular(14, 30, 40, 80, 40),
    "7208 C": _angular(13, 30, 40, 80, 15),
    "7305 A": _angular(11, 28, 25, 62, 30),
    "7305 B": _angular(11, 28, 25, 62, 40),
    "7306 A": _angular(13, 30, 30, 72, 30),
    "7306 B": _angular(13, 30, 30, 72, 40),
    "S 6000 C": _spindle(10, 4.762, 18.0, 10, 15),
    "S 6000 E": _spindle(10, 4.762, 18.0, 10, 25),
    "S 6004 C": _spindle(13, 6.35, 31.0, 20, 15),
    "S 6004 E": _spindle(13, 6.35, 31.0, 20, 25),
    "S 6205 C": _spindle(13, 7.938, 38.5, 25, 15),
    "S 6205 E": _spindle(13, 7.938, 38.5, 25, 25),
    "S 6008 C": _spindle(18, 7.938, 54.0, 40, 15),
    "S 6008 E": _spindle(18, 7.938, 54.0, 40, 25),
    "S 6010 C": _spindle(19, 8.731, 65.0, 50, 15),
    "S 6010 E": _spindle(19, 8.731, 65.0, 50, 25),
    "S 6020 C": _spindle(22, 15.081, 125.0, 100, 15),
    "S 6020 E": _spindle(22, 15.081, 125.0, 100, 25),
    "S 61905 C": _spindle(17, 4.762, 33.5, 25, 15),
    "S 61905 E": _spindle(17, 4.762, 33.5, 25, 25),
    "218": Row(
        16,
        22.23e-3,
        125.3e-3,
        90e-3,
        "Harris, Rolling Bearing Analysis: the 218 angular contact bearing",
        True,
        0.5232,
        radians(40.0),
    ),
}
DEEP_GROOVE = {name: row for name, row in ROWS.items() if row.contact_angle is None}


_NAMES = {squeezed(name): name for name in ROWS}


def names_in_short(names: Sequence[str]) -> str:
    """Names of the catalogue in its order, neighbours of a series as "6200 to 6211"."""
    parts = []
    for series, group in groupby(names, lambda name: name[:-2] if name.isdigit() and len(name) > 3 else name):
        found = list(group)
        whole = len(found) > 2 and series != found[0] and int(found[-1]) - int(found[0]) == len(found) - 1
        parts += [f"{found[0]} to {found[-1]}"] if whole else found
    return ", ".join(parts)


def designation_of(name: str) -> Designation:
    """A name as people type it, with its suffixes: "SKF 6205-2RS/C3" is the 6205 with seals and clearance C3.

    Raises
    ------
    InputError
        No such bearing; it names the nearest of the same kind of name, and the series, or the kind of bearing that
        is not in the library.
    """
    read = designation(name, ROWS)
    if read is not None:
        return read
    if kind := kind_of(name):
        allowed = f"a ball bearing of one row, deep groove or angular contact: {name} is one of the {kind}"
        raise InputError("name", name, f"{allowed}, which are not in this library")
    wanted = squeezed(name)
    steel = designation(wanted[1:], DEEP_GROOVE) if wanted[:1] == "S" else None
    if steel is not None:
        spindle = [f"{known} with {degrees(row.contact_angle or 0.0):.0f} degrees" for known, row in ROWS.items()
                   if known.startswith(f"S {steel.name} ")]  # fmt: skip
        others = f", or a spindle bearing by its letter: {' or '.join(spindle)}" if spindle else ""
        raise InputError("name", name, f"{steel.name} for one of stainless steel{others}")
    # the first character says what kind of bearing it is: a 7206 has the size of a 6206, and contact angles
    alike = [known for known in _NAMES if known[0] == wanted[:1]]
    near = [known for known in alike if sorted(known) == sorted(wanted)]  # 6250 for 6205
    near += [known for known in get_close_matches(wanted, alike, NAMES_SHOWN, 0.0) if known not in near]
    nearest = f"{', '.join(_NAMES[known] for known in near[:NAMES_SHOWN])} (nearest) or of " if near else ""
    every = names_in_short([_NAMES[known] for known in alike] or list(ROWS))
    allowed = f"one of {nearest}{every}"
    raise InputError("name", name, f"{allowed}; {BY_DIMENSIONS}")


def catalogue_row(name: str) -> tuple[str, Row]:
    """Name as the catalogue has it, and its row; raises `InputError` as `designation_of`."""
    known = designation_of(name).name
    return known, ROWS[known]


def deep_groove_row(name: str) -> tuple[str, Row]:
    """As `catalogue_row`, for what has no contact angle in the direction of its load.

    Raises
    ------
    InputError
        No such bearing, or an angular contact bearing.
    """
    known, row = catalogue_row(name)
    if row.contact_angle is not None:
        allowed = "a deep-groove bearing here; `ehlcontact bearing` and BallBearing take angular contact bearings"
        raise InputError("name", name, allowed)
    return known, row
