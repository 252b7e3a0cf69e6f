"""Numbers for people, in pages, pictures and tables of a terminal: the one place that rounds and spells them.

A number has four significant figures unless asked otherwise, keeps every digit before its point, and has no
exponent from 1e-3 to 1e5. JSON never comes here: it has all digits.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import SupportsFloat, TextIO

PLAIN = 1e-3, 1e5  # from the first to below the second a number is written without exponent
# What a terminal of few characters gets for those of units and symbols; the length of a word decides nothing.
SPELLED = str.maketrans(
    {
        "µ": "u",
        "Ω": "Omega",
        "ω": "omega",
        "η": "eta",
        "α": "alpha",
        "κ": "kappa",
        "π": " pi",
        "δ": "delta",
        "±": "+-",
        "≤": "<=",
        "≥": ">=",
        "×": "x",
        "°": " deg",
        "²": "^2",
        "³": "^3",
        "·": " ",
        "–": "-",
        "…": "...",
    }
)


def numeral(value: SupportsFloat | None, digits: int = 4) -> str:
    """The number as people write it.

    Parameters
    ----------
    value : number or None
        None gives a dash.
    digits : int
        Significant figures; zeros at the end of a fraction are left out.

    Returns
    -------
    str
        10000, 1234, 0.08702 or 1.07e-8.
    """
    if value is None:
        return "-"
    number = float(value)
    if number == 0.0 or not math.isfinite(number):
        return f"{number + 0.0:g}"  # no "-0"
    mantissa, exponent = f"{number:.{digits - 1}e}".split("e")
    if not PLAIN[0] <= abs(float(f"{mantissa}e{exponent}")) < PLAIN[1]:
        return f"{_short(mantissa)}e{int(exponent)}"
    return _short(f"{number:.{max(0, digits - 1 - int(exponent))}f}")


def percent(share: SupportsFloat | None, digits: int = 3) -> str:
    """A share in per cent; of what stands beside it."""
    return "-" if share is None else f"{numeral(100.0 * float(share), digits)} %"


def between(values: Iterable[float], digits: int = 3, unit: str = "") -> str:
    """Smallest to largest of some numbers in words, one where they are alike; a dash where there are none."""
    found = sorted(values)
    if not found:
        return "-"
    low, high = numeral(found[0], digits), numeral(found[-1], digits)
    return f"{low if low == high else f'{low} to {high}'}{unit and ' '}{unit}"


def spelled(text: str, stream: TextIO | None) -> str:
    """The text in characters that the stream knows, as far as they can be spelled: um for µm, Omega for Ω."""
    try:
        text.encode(getattr(stream, "encoding", None) or "utf-8", "surrogatepass")
    except UnicodeError:
        return text.translate(SPELLED)
    return text


def _short(digits: str) -> str:
    """Without zeros at the end of a fraction."""
    return digits.rstrip("0").rstrip(".") if "." in digits else digits
