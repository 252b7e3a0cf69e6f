"""Tolerances of seats and of bearings: classes of ISO 286-2 for shafts and housings, ISO 492 (normal) for rings.

A deviation is what a diameter is above its nominal size [m]; limits are (lower, upper).

The rows below are those of the standards for diameters to 500 mm, quoted from memory: they were not compared with
the printed standards. A class is a fundamental deviation with the width of its grade: j6 of 25 mm is +9 to -4 um.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Mapping

from ehlcontact.checks import as_column
from ehlcontact.errors import InputError

Limits = tuple[float, float]

UM = 1e-6
IN_METRES = ", or its limits in metres"  # in messages: what stands in place of a class
LARGEST = 1e-3  # m, of a deviation
# mm: a row of the tables is for diameters above the bound before it, up to its own
BOUNDS = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
GRADES = {
    4: (3, 4, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20),
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
}
# Fundamental deviations [um]: upper ones of f and g, lower ones of j to p
ABOVE = {
    "f": (-6, -10, -13, -16, -20, -25, -30, -36, -43, -50, -56, -62, -68),
    "g": (-2, -4, -5, -6, -7, -9, -10, -12, -14, -15, -17, -18, -20),
    "h": (0,) * 13,
}
BELOW = {
    "j": (-2, -2, -2, -3, -4, -5, -7, -9, -11, -13, -16, -18, -20),
    "k": (0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5),
    "m": (2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    "n": (4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40),
    "p": (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68),
}
SHAFT_GRADES = {"j": (5, 6), "k": (4, 5, 6, 7)}  # of letters whose row is not that of every grade
# Upper deviations of holes J to P [um]; F, G and H are the mirror images of f, g and h
HOLES = {
    "J6": (2, 5, 5, 6, 8, 10, 13, 16, 18, 22, 25, 29, 33),
    "J7": (4, 6, 8, 10, 12, 14, 18, 22, 26, 30, 36, 39, 43),
    "K6": (0, 2, 2, 2, 2, 3, 4, 4, 4, 5, 5, 7, 8),
    "K7": (0, 3, 5, 6, 6, 7, 9, 10, 12, 13, 16, 17, 18),
    "M6": (-2, -1, -3, -4, -4, -4, -5, -6, -8, -8, -9, -10, -10),
    "M7": (-2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0),
    "N6": (-4, -5, -7, -9, -11, -12, -14, -16, -20, -22, -25, -26, -27),
    "N7": (-4, -4, -4, -5, -7, -8, -9, -10, -12, -14, -14, -16, -17),
    "P6": (-6, -9, -12, -15, -18, -21, -26, -30, -36, -41, -47, -51, -55),
    "P7": (-6, -8, -9, -11, -14, -17, -21, -24, -28, -33, -36, -41, -45),
}
# ISO 492, class normal: lower deviations of the mean bore and outside diameter [um]; the upper ones are 0
BORES = {10: 8, 18: 8, 30: 10, 50: 12, 80: 15, 120: 20, 180: 25, 250: 30, 315: 35, 400: 40, 500: 45}
OUTSIDES = {18: 8, 30: 9, 50: 11, 80: 13, 120: 15, 150: 18, 180: 25, 250: 30, 315: 35, 400: 40, 500: 45}
# ISO 15: outside diameter [mm] of the bore [mm], by series
DIMENSIONS = {
    "60": {10: 26, 12: 28, 15: 32, 17: 35, 20: 42, 25: 47, 30: 55, 35: 62, 40: 68, 45: 75, 50: 80, 55: 90, 60: 95,
           65: 100, 70: 110, 75: 115, 80: 125, 85: 130, 90: 140, 95: 145, 100: 150},
    "62": {10: 30, 12: 32, 15: 35, 17: 40, 20: 47, 25: 52, 30: 62, 35: 72, 40: 80, 45: 85, 50: 90, 55: 100,
           60: 110, 65: 120, 70: 125, 75: 130, 80: 140, 85: 150, 90: 160},
    "63": {10: 35, 12: 37, 15: 42, 17: 47, 20: 52, 25: 62, 30: 72, 35: 80, 40: 90, 45: 100, 50: 110, 55: 120,
           60: 130},
    "160": {20: 42, 25: 47, 30: 55, 35: 62, 40: 68, 45: 75, 50: 80},
    "619": {25: 42},
}  # fmt: skip
SERIES = {"60": "60", "62": "62", "63": "63", "72": "62", "73": "63", "160": "160", "619": "619", "2": "62"}
SINGLE = {"608": 22, "UER204": 47, "ER-16K": 52}  # mm


def shaft_limits(fit: str, diameter: float) -> Limits:
    """Limits of the deviation [m] of a shaft of a class, as "k5", at a diameter [m].

    Raises
    ------
    InputError
        No class of a shaft that is in the table; a diameter outside it.
    """
    row = _row("fit", diameter)
    letter, grade = _parts(fit, "shaft", "k5")
    if letter != letter.lower():
        raise InputError("fit", fit, f"a class of a shaft, as {fit.lower()}: shaft first, housing second")
    width = GRADES[grade][row] * UM
    if letter == "js":
        return -0.5 * width, 0.5 * width
    if letter in ABOVE:
        upper = ABOVE[letter][row] * UM
        return upper - width, upper
    if letter in BELOW and grade in SHAFT_GRADES.get(letter, GRADES):
        lower = BELOW[letter][row] * UM
        return lower, lower + width
    letters = ", ".join([*ABOVE, "js", *BELOW])
    raise InputError("fit", fit, f"a class of a shaft: {letters} of grade 4 to 8 (j5, j6, k4 to k7)")


def housing_limits(fit: str, diameter: float) -> Limits:
    """Limits of the deviation [m] of the bore of a housing of a class, as "H7", at a diameter [m].

    Raises
    ------
    InputError
        No class of a housing that is in the table; a diameter outside it.
    """
    row = _row("fit", diameter)
    letter, grade = _parts(fit, "housing", "H7")
    if letter != letter.upper():
        raise InputError("fit", fit, f"a class of a housing, as {fit.upper()}: shaft first, housing second")
    width = GRADES[grade][row] * UM
    if letter == "JS":
        return -0.5 * width, 0.5 * width
    if letter in ("F", "G", "H"):
        lower = -ABOVE[letter.lower()][row] * UM
        return lower, lower + width
    upper = HOLES.get(f"{letter}{grade}")
    if upper is None:
        raise InputError("fit", fit, f"a class of a housing: F, G, H or JS of grade 4 to 8, or {', '.join(HOLES)}")
    return upper[row] * UM - width, upper[row] * UM


def bore_limits(bore: float) -> Limits:
    """Limits of the deviation [m] of the mean bore of a bearing, class normal of ISO 492."""
    return -_lower(BORES, "bore", bore), 0.0


def outside_limits(outside: float) -> Limits:
    """Limits of the deviation [m] of the mean outside diameter of a bearing, class normal of ISO 492."""
    return -_lower(OUTSIDES, "outside", outside), 0.0


def outside_of(name: str, bore: float | None) -> float | None:
    """Outside diameter [m] of a bearing of the catalogue by its series and bore; None where it is not known."""
    digits = "".join(re.findall(r"\d+", name)[:1])
    if name in SINGLE:
        return 1e-3 * SINGLE[name]
    table = SERIES.get(digits[:-2], "")
    if bore is None or table not in DIMENSIONS:
        return None
    found = DIMENSIONS[table].get(round(1e3 * bore))
    return None if found is None else 1e-3 * found


def deviation(name: str, given: float | tuple[float, float]) -> Limits:
    """Limits of a deviation [m] that are given as two numbers, or as one.

    Raises
    ------
    InputError
        Not lower before upper; beyond 1 mm, with the guess of micrometres.
    """
    low, high = as_column(name, given if isinstance(given, tuple | list) else (given, given), size=2).tolist()
    if not low <= high:
        raise InputError(name, given, "lower deviation before upper deviation, in metres")
    if max(abs(low), abs(high)) > LARGEST:
        guess = f"in µm? then {low * UM:g} and {high * UM:g} m"
        raise InputError(name, given, f"between -{LARGEST:g} and {LARGEST:g} m ({guess})")
    return low, high


def _parts(fit: str, seat: str, example: str) -> tuple[str, int]:
    found = re.fullmatch(r"([a-zA-Z]{1,2})\s*(\d{1,2})", fit.strip()) if isinstance(fit, str) else None
    if found is None or int(found[2]) not in GRADES:
        allowed = f"a class of ISO 286 for the {seat}, as {example!r}, of grade 4 to 8{IN_METRES}"
        raise InputError("fit", fit, allowed)
    return found[1], int(found[2])


def _row(name: str, diameter: float) -> int:
    size = round(1e3 * diameter, 6)
    if not 1.0 <= size <= BOUNDS[-1]:
        allowed = f"for seats of 1 to {BOUNDS[-1]} mm; limits in metres for any other"
        raise InputError(name, f"on {size:g} mm", allowed)
    return bisect_left(BOUNDS, size)


def _lower(table: Mapping[int, int], name: str, diameter: float) -> float:
    size, bounds = round(1e3 * diameter, 6), list(table)
    if not 0.6 <= size <= bounds[-1]:
        raise InputError(name, diameter, f"at most {1e-3 * bounds[-1]:g} m, as ISO 492 is known here")
    return table[bounds[bisect_left(bounds, size)]] * UM
