"""What every solve of this library assumes, and the numbers that tell when it matters.

Isothermal, Newtonian, smooth, fully flooded, at constant speed, rolling in one direction, on elastic bodies. That
a film converged says nothing about any of these. Formulas, sources, scatter: docs/assumptions.md.

=========== ====================================================================
module      responsibility
=========== ====================================================================
``judge``   `assumptions`: the table of a point
``film``    isothermal, Newtonian, smooth, fully flooded
``bodies``  constant speed, one direction, elastic
``contact`` the point with its film, and in SI as far as it is known
``table``   `Assumption`, `Assumptions`
=========== ====================================================================
"""

from ehlcontact.assumptions.judge import assumptions
from ehlcontact.assumptions.table import Assumption, Assumptions

__all__ = ["Assumption", "Assumptions", "assumptions"]


def __dir__() -> list[str]:
    """Public names, without the rooms that they are in."""
    return sorted(__all__)
