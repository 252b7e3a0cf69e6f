"""Quantities with a unit, such as those of `pint`, as inputs in SI.

Duck typed, so that nothing has to be installed: what has ``m_as(unit)``, or ``to_base_units`` and ``to(unit)``
with a ``magnitude``. Dimensionless inputs refuse them.
Frequencies keep their meaning, which libraries of units lose: 50 Hz are 3000 rev/min and 314 rad/s, and 1/s is
refused, for it may be either.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import wraps
from inspect import signature
from math import pi
from typing import Any, ParamSpec, TypeVar

from ehlcontact.errors import InputError

P = ParamSpec("P")
Result = TypeVar("Result")

_RADIANS = {"rad/s": 1.0, "Hz": 2.0 * pi, "rev/min": pi / 30.0}  # rad/s in one of each
_SPELLED = {"Pa s": "Pa*s", "kg m": "kg*m", "kg m2": "kg*m**2", "kg/m3": "kg/m**3", "N s/m": "N*s/m",
            "m/s2": "m/s**2", "W/(m K)": "W/(m*K)", "1/Pa": "1/Pa", "degrees Celsius": "degC"}  # fmt: skip
_PER_SECOND = re.compile(r"hertz|hz", re.IGNORECASE)
_TURNING = re.compile(r"rad|rev|rpm|turn|cycle|degree", re.IGNORECASE)


def is_quantity(value: object) -> bool:
    """Whether `value` brings a unit of its own."""
    return hasattr(value, "m_as") or (hasattr(value, "to_base_units") and hasattr(value, "magnitude"))


def has_quantity(value: object) -> bool:
    """Whether `value` is one, or a list that begins with one."""
    return is_quantity(value) or (isinstance(value, list | tuple) and bool(value) and has_quantity(value[0]))


def in_unit(field: str, value: Any, unit: str) -> Any:
    """`value` as plain numbers in `unit`; plain numbers, which are in it already, as they are.

    Raises
    ------
    InputError
        A quantity of another kind, or a frequency of which it is not said whether it is turns or radians.
    """
    if isinstance(value, list | tuple) and has_quantity(value):
        return [in_unit(f"{field}[{k}]", one, unit) for k, one in enumerate(value)]
    if not is_quantity(value):
        return value
    try:
        return _turning(value, unit) if unit in _RADIANS else _magnitude(value, _SPELLED.get(unit, unit))
    except Exception:  # every library of units has errors of its own, and some raise those of Python
        allowed = "Hz, rad/s or rev/min (1/s may be turns or radians)" if unit in _RADIANS else unit
        raise InputError(field, _Shown(value), f"a number, or a quantity that can be put into {allowed}") from None


def takes(**units: str) -> Callable[[Callable[P, Result]], Callable[P, Result]]:
    """Let a call take quantities for its arguments in SI: ``takes(load="N")``.

    Parameters
    ----------
    **units : str
        Unit of each argument, by its name, in which the call itself has it.
    """

    def decorate(call: Callable[P, Result]) -> Callable[P, Result]:
        names = tuple(signature(call).parameters)

        def take(name: str, value: Any) -> Any:
            return in_unit(name, value, units[name]) if name in units else value

        @wraps(call)
        def converted(*args: P.args, **kwargs: P.kwargs) -> Result:
            if not any(map(has_quantity, (*args, *kwargs.values()))):
                return call(*args, **kwargs)
            given: list[Any] = list(args)
            given[: len(names)] = [take(name, value) for name, value in zip(names, args, strict=False)]
            named: Any = {name: take(name, value) for name, value in kwargs.items()}
            return call(*given, **named)

        return converted

    return decorate


def fields_take(**units: str) -> Callable[[type[Result]], type[Result]]:
    """`takes` for the fields of a class."""

    def decorate(cls: type[Result]) -> type[Result]:
        setattr(cls, "__init__", takes(**units)(cls.__init__))  # noqa: B010
        return cls

    return decorate


class _Shown:
    """A quantity in a message, as it prints itself."""

    def __init__(self, value: object) -> None:
        self.text = " ".join(str(value).split())

    def __repr__(self) -> str:
        return self.text


def _magnitude(value: Any, unit: str) -> Any:
    return value.m_as(unit) if hasattr(value, "m_as") else value.to(unit).magnitude


def _turning(value: Any, unit: str) -> Any:
    """A frequency in one of three units, by the name of its own: libraries take Hz for rad/s."""
    own = str(getattr(value, "units", ""))
    if _PER_SECOND.search(own):
        radians = _magnitude(value, "Hz") * _RADIANS["Hz"]
    elif _TURNING.search(own):
        radians = _magnitude(value, "rad/s")
    else:
        raise ValueError(own)
    return radians / _RADIANS[unit]
