"""The page of the catalogue, from the catalogue and the table of clearances themselves.

python docs/site/catalogue.py   # writes docs/guide/catalogue.md
"""

from __future__ import annotations

from math import degrees
from pathlib import Path

from reduced_models import BallBearing
from reduced_models.bearing.catalogue import DEEP_GROOVE, ROWS, Row
from reduced_models.bearing.clearance import CLASSES, LIMITS, SMALLEST_BORE

PAGE = Path(__file__).parents[1] / "guide" / "catalogue.md"
HEAD = """# Bearings by name

`BallBearing.catalogue("6205", oil=oil, clearance="CN")`, `ehlcontact bearing 7205 --axial 200`, `--bearing 6205`
and `bearing = "6205"` of a study take their dimensions from these tables. Spaces, hyphens, capitals and the
maker do not matter, and suffixes are read: SKF 6205-2RS/C3 is a 6205 with clearance class C3 unless another
clearance is given. Roller bearings (NU205, 22228, 30205) are not in the library. FTF, BPFO, BPFI and BSF are the
[defect frequencies](glossary.md#bearings-and-rotors) per turn of the shaft, at the contact angle of the table.
Under an axial load they are those of `BallBearing.equilibrium(load).orders`.

## Deep groove, at zero contact angle

"""
ORDERS = "ftf_order", "bpfo_order", "bpfi_order", "bsf_order"
COLUMNS = "| name | bore, mm | balls | ball, mm | pitch, mm | {angle}FTF | BPFO | BPFI | BSF | source |\n"
ANGULAR = """
## Angular contact

A name without its letter, as 7205, is the bearing of 30 degrees (A). B has 40 degrees, C 15 degrees; of GMN's
spindle bearings C has 15 degrees and E 25. These bearings carry axial load in one direction, +z. Commands
of a single contact take deep-groove bearings only.

"""
RULE = """
Makers print bore, outside diameter and width; few print balls and pitch circle, and bearings of one name differ
between makers: compare with your own where a frequency or a stiffness matters to a few per cent. Sources:

{sources}

**Derived rows.** Load ratings are defined by the balls: ISO 76 has C0r/f0 = Z D^2, ISO 281 has Cr = 1.3 fc
Z^(2/3) D^1.8 for grooves of 0.52 (D in mm, fc from D/dm). With the printed Cr, C0r and f0 and dm, the mean of
bore and outside diameter, Z and D are the number of balls and the multiple of 1/64 inch that fit best; both
equations then hold within 1 %. For 17 bearings whose balls are printed elsewhere the rule finds the printed
balls of 16. The exception is the 6200: 8 balls of 4.762 mm by the ratings of NSK, and 7 of 5.556 mm in the
catalogue of GMN (`tests/reduced_models/bearing/test_catalogue.py`). With the contact angle a both standards have
C0r/f0 = Z D^2 cos a and Cr = 1.3 fc (cos a)^0.7 Z^(2/3) D^1.8, f0 and fc from D cos a/dm; bore and outside
diameter of 72 and 73 are those of 62 and 63. The load ratings of series 72, 73 and 160 and of the 608 were quoted
from memory: compare them with the maker's table. Both equations hold for them within 1 %.

Conformities, groove radius over ball diameter, are assumed to be 0.52, except for the 209 and the 218, whose
groove radii are printed. Values of 0.501 to 0.7 are allowed: grooves of bearings have 0.505 to 0.60. Some programs
and papers give the groove radius over the radius of the ball (1.04), or the inverse (0.9615): both are refused,
and the message has the value meant, 0.52.

## Balls from load ratings

For a bearing that is not in the tables the maker's C and C0 give its balls, by the rule of the derived rows:

```python
from reduced_models import geometry_from_ratings

found = geometry_from_ratings(25e-3, 52e-3, dynamic_rating=14e3, static_rating=7850.0)  # bore, outside, C, C0
found.balls, found.ball_diameter  # 9, 7.938 mm
found.balls_interval, found.ball_interval, found.pitch_interval  # all that fit within 2 %
bearing = found.bearing(name="spare 6205", clearance="CN")
bearing.name  # 'spare 6205, balls estimated from C and C0': in summaries, reports, JSON and FMUs
```

Balls have multiples of 1/64 inch or of 0.5 mm, inch sizes first, and room between the rings and beside each other.
A printed `f0` narrows the interval. Angular contact bearings need their `contact_angle`.

| C and C0 of | balls from | bearings | number and diameter as printed |
|---|---|---|---|
| NSK | GMN and others, the rows with letters of these tables | 17 | 16: the 6200 has other balls |
| NSK | pass orders of Timken, outer rings of series 62 and 63 | 19 | 13; 8 of these rows were derived |
| GMN | GMN, deep groove, `conformity=(0.515, 0.53)` | 16 | 16 |
| GMN | GMN, spindle bearings with 15 and 25 degrees | 8 | 6, with the conformity of a deep groove bearing |

Where they agree the diameters are within 1 %, those of the pass orders within 0.2 %. The other six of Timken have
balls that are 8 % smaller to 13 % larger than NSK's. The 46 rows derived from NSK's ratings are found too, but
show only that the rule is the same.

Ratings do not say how their maker rates. Two practices differ from the standards:

* NSK's newer tables and SKF's Explorer bearings have a C some 5 % above the standards with a C0 of the standards:
  `dynamic_excess=0.08` allows for it, with a wider interval.
* GMN rates the grooves that it grinds, where the standards rate 0.52: C is 11 % below to 9 % above the standards,
  by the size of the ball. With `conformity=(0.515, 0.53)` balls are found with the conformity for which C and C0
  fit. In a deep groove bearing they have some 190 degrees between the first and the last, as in these
  tables. In an angular contact bearing the number is open by two or three balls. The conformity of a deep groove
  bearing of this maker with balls of this size settles it:

```python
from math import radians

own = (
    geometry_from_ratings(20e-3, 42e-3, dynamic_rating=9800.0, static_rating=5350.0, conformity=(0.515, 0.53))
    .candidates[0]
    .conformity
)  # GMN 6004: 9 balls of 6.35 mm in grooves of 0.518
spindle = geometry_from_ratings(
    20e-3, 42e-3, dynamic_rating=12200.0, static_rating=7600.0, contact_angle=radians(15.0), conformity=own
)  # S 6004 C: 13 balls; with 0.52 they would be 14
```

Without either, 13 of the 24 bearings of GMN are refused with the nearest balls, 4 are found, and 7 get another
number of balls. `found.reservation` says where the balls are of no inch size or few.

## Radial clearance by class

Least and largest radial internal clearance in um before mounting, for cylindrical bores: ISO 5753-1, as printed
in makers' catalogues. `clearance="CN"` takes the middle. Interference fits and an inner ring that is warmer
than the outer one reduce the clearance, so the number of a mounted bearing is smaller.

"""


def sources() -> dict[str, str]:
    """Letters of the sources in their order."""
    found = dict.fromkeys(row.source for row in ROWS.values())
    return {source: chr(ord("a") + k) for k, source in enumerate(found)}


def page() -> str:
    """Text of the pages' tables and their rule."""
    letters = sources()
    angular = {name: row for name, row in ROWS.items() if name not in DEEP_GROOVE}
    named = "\n".join(f"- {letter}: {source}" for source, letter in letters.items())
    tables = table(DEEP_GROOVE, letters) + ANGULAR + table(angular, letters, "angle, degrees | ")
    return HEAD + tables + RULE.format(sources=named) + clearances()


def table(rows: dict[str, Row], letters: dict[str, str], angle: str = "") -> str:
    """Rows of the catalogue; with a column of contact angles where `angle` heads one."""
    heads = COLUMNS.format(angle=angle)
    lines = [heads + "|---" * (heads.count("|") - 1) + "|"]
    for name, row in rows.items():
        orders = BallBearing.catalogue(name).orders
        bore = "" if row.bore is None else f"{1e3 * row.bore:.4g}"
        lengths = [f"{1e3 * row.ball_diameter:.3f}", f"{1e3 * row.pitch_diameter:.2f}"]
        lengths += [] if row.contact_angle is None else [f"{degrees(row.contact_angle):.4g}"]
        numbers = [f"{getattr(orders, kind):.4f}" for kind in ORDERS]
        lines.append(
            " | ".join([f"| {name}", bore, str(row.balls), *lengths, *numbers, f"{letters[row.source]} |"])
        )
    return "\n".join(lines) + "\n"


def clearances() -> str:
    """Table of clearances by class and bore."""
    lines, above = [f"| bore, mm | {' | '.join(CLASSES)} |", "|---" * (1 + len(CLASSES)) + "|"], SMALLEST_BORE
    for bore, limits in LIMITS.items():
        first = "from" if above == SMALLEST_BORE else "above"
        ends = " | ".join(f"{low} to {high}" for low, high in limits)
        lines.append(f"| {first} {above:g} to {bore} | {ends} |")
        above = bore
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(PAGE)
