"""The page of the catalogue, from the catalogue and the table of clearances themselves.

python docs/site/catalogue.py   # writes docs/guide/catalogue.md
"""

from __future__ import annotations

from pathlib import Path

from reduced_models import BallBearing
from reduced_models.bearing.catalogue import ROWS
from reduced_models.bearing.clearance import CLASSES, LIMITS, SMALLEST_BORE

PAGE = Path(__file__).parents[1] / "guide" / "catalogue.md"
HEAD = """# Bearings by name

`BallBearing.catalogue("6205", oil=oil, clearance="CN")`, `--bearing 6205` and `catalogue = "6205"` take their
dimensions from this table. FTF, BPFO, BPFI and BSF are the
[defect frequencies](glossary.md#bearings-and-rotors) per turn of the shaft, at zero contact angle.

| name | bore, mm | balls | ball, mm | pitch, mm | FTF | BPFO | BPFI | BSF | source |
|---|---|---|---|---|---|---|---|---|---|
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
catalogue of GMN (`tests/reduced_models/bearing/test_catalogue.py`).

Conformities are assumed to be 0.52, except for the 209, whose groove radii are printed.

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
    """Text of the page."""
    letters, lines = sources(), []
    for name, row in ROWS.items():
        orders = BallBearing.catalogue(name).orders
        bore = "" if row.bore is None else f"{1e3 * row.bore:.4g}"
        lengths = [f"{1e3 * row.ball_diameter:.3f}", f"{1e3 * row.pitch_diameter:.2f}"]
        numbers = [f"{getattr(orders, kind):.4f}" for kind in ("ftf", "bpfo", "bpfi", "bsf")]
        lines.append(
            " | ".join([f"| {name}", bore, str(row.balls), *lengths, *numbers, f"{letters[row.source]} |"])
        )
    named = "\n".join(f"- {letter}: {source}" for source, letter in letters.items())
    return HEAD + "\n".join(lines) + "\n" + RULE.format(sources=named) + clearances()


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
