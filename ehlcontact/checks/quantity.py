"""What the arguments of a call are: quantities with a unit, such as those of `pint`, ranges, flags.

`takes` and `fields_take` declare it once, by the names of arguments. Quantities are duck typed, so that nothing
has to be installed: what has ``m_as(unit)``, or ``to_base_units`` and ``to(unit)`` with a ``magnitude``.
Dimensionless inputs refuse them. Frequencies keep their meaning, which libraries of units lose: 50 Hz are
3000 rev/min and 314 rad/s, and 1/s is refused, for it may be either.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import wraps
from inspect import Parameter, signature
from math import pi
from typing import Any, ParamSpec, Protocol, TypeVar

from ehlcontact.checks.inputs import as_numbers, has_quantity, is_quantity, require_flag
from ehlcontact.errors import InputError

P = ParamSpec("P")
Result = TypeVar("Result")

_RADIANS = {"rad/s": 1.0, "Hz": 2.0 * pi, "rev/min": pi / 30.0}  # rad/s in one of each
_SPELLED = {"Pa s": "Pa*s", "kg m": "kg*m", "kg m2": "kg*m**2", "kg/m3": "kg/m**3", "N s/m": "N*s/m",
            "m/s2": "m/s**2", "W/(m K)": "W/(m*K)", "1/Pa": "1/Pa", "degrees Celsius": "degC",
            "mm2/s": "mm**2/s"}  # fmt: skip
_PER_SECOND = re.compile(r"hertz|hz", re.IGNORECASE)
_TURNING = re.compile(r"rad|rev|rpm|turn|cycle|degree", re.IGNORECASE)


class Kind(Protocol):
    """What an argument is: numbers of a range, objects of a class, a path."""

    @property
    def unit(self) -> str:
        """SI unit in which the call has it; empty of what is no quantity."""

    def take(self, field: str, value: Any, number: bool) -> Any:
        """The value, or raise `InputError`; `number`: a single number, no array."""


def in_unit(field: str, value: Any, unit: str) -> Any:
    """`value` as plain numbers in `unit`; plain numbers, which are in it already, as they are.

    Raises
    ------
    InputError
        A quantity of another kind, or a frequency of which it is not said whether it is turns or radians.
    """
    if isinstance(value, list | tuple) and has_quantity(value):
        for k, one in enumerate(value):
            if not has_quantity(one):  # of which unit is it?
                raise InputError(
                    f"{field}[{k}]", one, f"a quantity in {unit} as the others, or all of them numbers"
                )
        return [in_unit(f"{field}[{k}]", one, unit) for k, one in enumerate(value)]
    if not is_quantity(value):
        return value
    try:
        return _turning(value, unit) if unit in _RADIANS else _magnitude(value, _SPELLED.get(unit, unit))
    except Exception:  # every library of units has errors of its own, and some raise those of Python
        allowed = "Hz, rad/s or rev/min (1/s may be turns or radians)" if unit in _RADIANS else unit
        raise InputError(field, _Shown(value), f"a number, or a quantity that can be put into {allowed}") from None


def takes(**kinds: str | Kind) -> Callable[[Callable[P, Result]], Callable[P, Result]]:
    """Let a call take quantities for its arguments in SI, and refuse what its arguments are not.

    ``takes(load="N", density=DENSITY, folder=FOLDER)``. An argument that is annotated as a bool is a flag, which
    needs no entry.

    Parameters
    ----------
    **kinds : str or Kind
        Of each argument, by its name: the unit in which the call itself has it, or its kind with unit and range.
    """

    def decorate(call: Callable[P, Result]) -> Callable[P, Result]:
        parameters = signature(call).parameters
        names = tuple(parameters)
        units = {name: kind if isinstance(kind, str) else kind.unit for name, kind in kinds.items()}
        checks = {name: _check_of(kind, parameters[name]) for name, kind in kinds.items()}
        checks |= {name: require_flag for name, one in parameters.items() if one.annotation in ("bool", bool)}

        def convert(name: str, value: Any) -> Any:
            return in_unit(name, value, units[name]) if units.get(name) else value

        def check(name: str, value: Any) -> Any:
            return checks[name](name, value) if name in checks else value

        def each(
            change: Callable[[str, Any], Any], args: tuple[Any, ...], kwargs: dict[str, Any]
        ) -> tuple[tuple[Any, ...], dict[str, Any]]:
            given = [change(name, value) for name, value in zip(names, args, strict=False)]
            return (*given, *args[len(names) :]), {name: change(name, value) for name, value in kwargs.items()}

        @wraps(call)
        def taken(*args: P.args, **kwargs: P.kwargs) -> Result:
            given: Any = args, kwargs
            if any(map(has_quantity, (*args, *kwargs.values()))):
                given = each(convert, *given)
            if checks:
                given = each(check, *given)
            return call(*given[0], **given[1])

        return taken

    return decorate


def fields_take(**kinds: str | Kind) -> Callable[[type[Result]], type[Result]]:
    """`takes` for the fields of a class, whose summary has their units (`ehlcontact.summary`)."""

    def decorate(cls: type[Result]) -> type[Result]:
        setattr(cls, "__init__", takes(**kinds)(cls.__init__))  # noqa: B010
        units = {name: kind if isinstance(kind, str) else kind.unit for name, kind in kinds.items()}
        own = getattr(cls, "FIELD_UNITS", {})
        setattr(cls, "FIELD_UNITS", {name: unit for name, unit in units.items() if unit} | dict(own))  # noqa: B010
        return cls

    return decorate


def _check_of(kind: str | Kind, parameter: Parameter) -> Callable[[str, Any], Any]:
    """Check of one argument; None is what leaves it out where that is its default.

    Of a quantity without a range of its own arrays are looked at; calls refuse single numbers themselves.
    """
    number = parameter.annotation in ("float", "float | None", float)

    def numbers(name: str, value: Any) -> Any:
        if isinstance(value, list | tuple | dict | set):
            as_numbers(name, value)  # type: ignore[arg-type]
        return value

    if isinstance(kind, str):
        return numbers

    def check(name: str, value: Any) -> Any:
        return None if value is None and parameter.default is None else kind.take(name, value, number)

    return check


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
