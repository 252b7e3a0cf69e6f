"""Checks of inputs; each raises one line that names the input and its allowed range.

==================== ==========================================================================================
module               responsibility
==================== ==========================================================================================
``inputs``           numbers, arrays, choices: returned as plain Python or numpy objects
``frequency``        frequencies, named with their unit, exactly one given
``quantity``         what arguments of a call are: quantities with a unit, as of pint, put into SI; flags
``kinds``            other kinds of arguments: objects of a class, sequences of them, callbacks, paths, names
``parts``            ranges of the parts of machines: shafts, discs, bearings, supports, records
``machine``          number of threads, at most the cores of the machine
``admissible_range`` ranges of SI and Moes inputs, and the unit that a value outside was probably given in
==================== ==========================================================================================
"""

from ehlcontact.checks.inputs import (
    as_column,
    as_complex,
    as_float,
    as_numbers,
    as_rows,
    as_values,
    is_single,
    require_between,
    require_choice,
    require_finite,
    require_flag,
    require_instance,
    require_integer,
    require_names,
    require_no_others,
    require_nonnegative,
    require_positive,
    shown,
)

__all__ = [
    "as_column",
    "as_complex",
    "as_float",
    "as_numbers",
    "as_rows",
    "as_values",
    "is_single",
    "require_between",
    "require_choice",
    "require_finite",
    "require_flag",
    "require_instance",
    "require_integer",
    "require_names",
    "require_no_others",
    "require_nonnegative",
    "require_positive",
    "shown",
]


def __dir__() -> list[str]:
    """Public names, without the modules that they are in."""
    return sorted(__all__)
