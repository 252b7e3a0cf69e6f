"""Checks of inputs: plain ones, and what the solvers are made for.

============= =================================================================================================
room          responsibility
============= =================================================================================================
``inputs``    each returns what it was given, in its plain form, or raises one line that names it
``frequency`` the one rule for frequencies: named with their unit, exactly one given
``quantity``  numbers with a unit of their own, as pint's, where an input is in SI
``machine``   threads, within the cores there are
``box``       what the solvers are made for, and the slip of unit that a number outside betrays
============= =================================================================================================
"""

from ehlcontact.checks.inputs import (
    as_column,
    as_rows,
    require_choice,
    require_finite,
    require_instance,
    require_integer,
    require_nonnegative,
    require_positive,
)

__all__ = [
    "as_column",
    "as_rows",
    "require_choice",
    "require_finite",
    "require_instance",
    "require_integer",
    "require_nonnegative",
    "require_positive",
]


def __dir__() -> list[str]:
    """Public names, without the rooms that they are in."""
    return sorted(__all__)
