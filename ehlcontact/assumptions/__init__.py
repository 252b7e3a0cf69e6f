"""Assumptions of every solve, each with the number that shows whether it holds.

Isothermal, Newtonian, smooth, fully flooded, at constant speed, rolling in one direction, elastic bodies.
A converged film does not show whether any of these holds. Formulas, sources, scatter: docs/notes/assumptions.md.

=========== ====================================================================
module      responsibility
=========== ====================================================================
``judge``   `assumptions`: all assumptions of an operating point
``film``    isothermal, Newtonian, smooth, fully flooded
``bodies``  constant speed, one direction, elastic
``contact`` operating point with its film, in SI where known
``table``   `Assumption`, `Assumptions`
=========== ====================================================================
"""

from ehlcontact.assumptions.judge import assumptions
from ehlcontact.assumptions.table import Assumption, Assumptions

__all__ = ["Assumption", "Assumptions", "assumptions"]


def __dir__() -> list[str]:
    """Public names, without the modules that they are in."""
    return sorted(__all__)
