"""Oils by name on the command line: the one place that reads "ISO VG 68"."""

from __future__ import annotations

import re

from ehlcontact.errors import InputError
from ehlcontact.lubricant.oil import GRADES, TEMPERATURES

# as on the drum, and as people shorten it: "ISO VG 68", "VG68", "iso-vg 68", "68"
_GRADE = re.compile(r"(?:(?:iso[\s_-]*)?vg[\s_-]*|iso[\s_-]*)?(\d{1,4})", re.IGNORECASE)
OIL_HELP = 'ISO grade of a mineral oil, as "ISO VG 68".'
TEMP_HELP = f"Of the oil in the inlet, °C; {TEMPERATURES[0]:g} to {TEMPERATURES[1]:g}."


def oil_grade(text: str, field: str) -> int:
    """The grade that a name of an oil says, 68 of "ISO VG 68".

    Parameters
    ----------
    text : str
    field : str
        What it was given as, for the message.

    Raises
    ------
    InputError
        Any other name, or a grade that the library does not know.
    """
    found = _GRADE.fullmatch(str(text).strip())
    if found is None or int(found[1]) not in GRADES:
        *most, last = (f"{grade}" for grade in GRADES)
        raise InputError(field, text, f"ISO VG {', '.join(most)} or {last}; any other oil by its eta0 and alpha")
    return int(found[1])
