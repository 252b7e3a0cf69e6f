"""Coefficients of the elements with a film memory: names by kind, checks, and the film laws that they make.

A kind has one speed or a table of them, and at each a static film over the load and gains of its memory over the
load: a power of the load and one row of gains (memory), or tables of both.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import (
    as_column,
    as_numbers,
    as_rows,
    require_between,
    require_nonnegative,
)
from ehlcontact.errors import InputError
from reduced_models.elements.film_curve import LEAST_EXPONENT, curve_nodes, power_nodes, require_rising
from reduced_models.elements.film_filters import DIRECT
from reduced_models.elements.film_law import FilmLaw
from reduced_models.elements.film_response import FilterRates
from reduced_models.elements.validity import numbers, require_size

_Floats = NDArray[np.float64]

# All of them dimensionless, and of the order of 0.01 to 100 in the atlas.
RATES = (1e-6, 1e6)
FILMS = (1e-9, 1e6)
LARGEST_GAIN = 1e6
LARGEST_EXPONENT = 10.0  # films thin with the load to the power of 0.1 to 1
LOADS = (1e-12, 1e12)  # over the reference load
SPEEDS = (1e-6, 1e6)  # over that of the point
_FILTERS = ("inlet_saturation", "lag_rate", "inlet_rate", "fast_rate")
_TABLES = ("loads", "approach", "gain_loads", "gains")
_NUMBERS = ("film", "exponent", "lag_rate", "inlet_rate", "fast_rate")  # coefficients that are no tables
KINDS = {
    "memory": ("film", "exponent", *_FILTERS, "gains"),
    "wide": (*_TABLES, *_FILTERS),
    "speed": ("speeds", *_TABLES, *_FILTERS),
}
COEFFICIENTS = tuple(dict.fromkeys(name for names in KINDS.values() for name in names))


def checked_coefficients(kind: str, entries: Mapping[str, Any]) -> dict[str, Any]:
    """Coefficients of that kind as numbers and tuples; raises `InputError` that names the entry."""
    for name in COEFFICIENTS:
        if name not in KINDS[kind] and entries[name] is not None:
            raise InputError(name, entries[name], f"left out of an element of kind {kind!r}")
    checked: dict[str, Any] = {
        name: require_between(name, entries[name], *RATES) for name in ("lag_rate", "inlet_rate", "fast_rate")
    }
    if kind != "speed":
        checked["inlet_saturation"] = require_nonnegative("inlet_saturation", entries["inlet_saturation"])
        require_size("inlet_saturation", checked["inlet_saturation"], LARGEST_GAIN)
    if kind == "memory":
        checked["film"] = require_between("film", entries["film"], *FILMS)
        checked["exponent"] = require_between("exponent", entries["exponent"], LEAST_EXPONENT, LARGEST_EXPONENT)
        return checked | {"gains": tuple(as_column("gains", entries["gains"], least=DIRECT + 1).tolist())}
    axes = {"speeds": (2, SPEEDS)} if kind == "speed" else {}
    for name, (least, limits) in (axes | {"loads": (2, LOADS), "gain_loads": (1, LOADS)}).items():
        checked[name] = tuple(as_column(name, entries[name], least=least, increasing=True).tolist())
        require_between(f"{name}[0]", checked[name][0], *limits)
        require_between(f"{name}[-1]", checked[name][-1], *limits)
    if kind == "speed":
        return checked | _rows_of_speeds(entries, checked)
    gains = as_rows("gains", entries["gains"], len(checked["gain_loads"]), DIRECT + 1)
    approach = as_column("approach", entries["approach"], least=2, increasing=True)
    return checked | {"approach": tuple(approach.tolist()), "gains": _tuples(gains)}


def _rows_of_speeds(entries: Mapping[str, Any], axes: Mapping[str, tuple[float, ...]]) -> dict[str, Any]:
    """Tables of each speed."""
    speeds, rows = axes["speeds"], len(axes["gain_loads"])
    if not speeds[0] <= 1.0 <= speeds[-1]:
        raise InputError("speeds", speeds, "from at most 1 to at least 1, the speed of the reference")
    count = len(speeds)
    approach = as_rows("approach", entries["approach"], count, len(axes["loads"]))
    gains = as_numbers("gains", entries["gains"], "rows of numbers for every speed")
    if gains.ndim != 3 or gains.shape[0] != count:
        raise InputError("shape of gains", gains.shape, f"({count}, {rows}, {DIRECT + 1} or more)")
    tables = tuple(_tuples(as_rows("gains", table, rows, DIRECT + 1)) for table in gains)
    saturation = as_column("inlet_saturation", entries["inlet_saturation"], size=count).tolist()
    for k, value in enumerate(saturation):
        require_between(f"inlet_saturation[{k}]", value, 0.0, LARGEST_GAIN)
    return {"approach": _tuples(approach), "gains": tables, "inlet_saturation": tuple(saturation)}


def _tuples(rows: _Floats) -> tuple[tuple[float, ...], ...]:
    return tuple(map(tuple, rows.tolist()))


def film_laws(kind: str, c: Mapping[str, Any]) -> tuple[FilmLaw, ...]:
    """Laws of checked coefficients, one for every speed.

    Raises
    ------
    InputError
        Tables that are no contact, or gains that would feed energy into a vibration.
    """
    if kind == "memory":
        tables = power_nodes(c["film"], c["exponent"]) | {"gain_x": np.zeros(1), "gains": np.array([c["gains"]])}
        return (_law_of(tables, c, c["inlet_saturation"], rim=False),)
    rows = (c["approach"], c["gains"], c["inlet_saturation"])
    x, laws = np.log(np.array(c["gain_loads"])), []
    for u, gains, saturation in zip(*rows, strict=True) if kind == "speed" else (rows,):
        tables = curve_nodes(c["loads"], u) | {"gain_x": x, "gains": np.array(gains)}
        laws.append(_law_of(tables, c, saturation, rim=saturation > 0.0))  # for every load: made for growing
    return tuple(laws)


def _law_of(tables: Mapping[str, Any], c: Mapping[str, Any], saturation: float, *, rim: bool) -> FilmLaw:
    rates = {name: c[name] for name in ("lag_rate", "inlet_rate", "fast_rate")}
    law = FilmLaw(**tables, **rates, inlet_saturation=saturation, rim=1.0 if rim else 0.0)
    require_size("gains", float(np.abs(law.gains).max()), LARGEST_GAIN)
    require_rising(law)
    filters = FilterRates(law.gains.shape[1] - DIRECT, **rates)
    if not filters.passive(law.gains):
        least = min(filters.least_dissipation(row) for row in law.gains)
        raise InputError("least dissipation of gains", least, ">= 0 at every frequency (passive)")
    return law


def read_coefficients(kind: str, parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Entries ``parameters`` of a file as numbers and lists; raises `InputError` for another type."""
    single = _NUMBERS if kind == "speed" else (*_NUMBERS, "inlet_saturation")
    values: dict[str, Any] = {**numbers("parameters", parameters, tuple(n for n in KINDS[kind] if n in single))}
    for name in KINDS[kind]:
        if name not in single:
            values[name] = parameters.get(name)
            if not isinstance(values[name], list):
                raise InputError(f"parameters.{name}", values[name], "a list of numbers")
    return values
