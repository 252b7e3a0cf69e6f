"""Frequencies as arguments: named with their unit, exactly one given.

======== ==================================================================== ==================
name     is                                                                   taken by
======== ==================================================================== ==================
``Omega`` dimensionless angular frequency, per unit 2a/u_sum of time          every contact
``omega`` angular frequency [rad/s]                                           contacts in SI
``hz``   frequency [Hz]                                                       contacts in SI
``rpm``  turns per minute                                                     contacts in SI
======== ==================================================================== ==================

A contact in SI is an `OperatingPoint`, or was made from one: its unit of time in seconds is known.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from inspect import Parameter, signature
from math import inf, pi
from typing import ParamSpec, TypedDict, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks.inputs import as_numbers
from ehlcontact.checks.quantity import in_unit
from ehlcontact.errors import InputError

Array = NDArray[np.float64]
P = ParamSpec("P")
Result = TypeVar("Result")

_RADIANS = {"omega": 1.0, "hz": 2.0 * pi, "rpm": pi / 30.0}  # rad/s in one of each
_UNITS = {"Omega": "", "omega": "rad/s", "hz": "Hz", "rpm": "rev/min"}
_IN_SI = "omega (rad/s), hz or rpm"
_LOOSE = {"frequency", "frequencies", "freq", "freqs", "f"}  # names without a unit
_KEYWORDS = f"Omega (dimensionless), {_IN_SI}"


class Frequency(TypedDict, total=False):
    """A frequency as keyword arguments."""

    Omega: ArrayLike | None
    omega: ArrayLike | None
    hz: ArrayLike | None
    rpm: ArrayLike | None


def is_given(
    Omega: ArrayLike | None = None,
    omega: ArrayLike | None = None,
    hz: ArrayLike | None = None,
    rpm: ArrayLike | None = None,
) -> bool:
    """Whether any is."""
    return any(value is not None for value in (Omega, omega, hz, rpm))


def dimensionless(
    time: float | None,
    *,
    Omega: ArrayLike | None = None,
    omega: ArrayLike | None = None,
    hz: ArrayLike | None = None,
    rpm: ArrayLike | None = None,
    most: float = inf,
) -> Array:
    """Omega of the one frequency that is given, shape (k,).

    Parameters
    ----------
    time : float or None
        The contact's unit of time, 2a/u_sum [s]; None for a dimensionless contact.
    Omega, omega, hz, rpm : array_like
        The frequency: a number or a flat list of them.
    most : float
        Largest Omega that is allowed.

    Raises
    ------
    InputError
        None is given, or several; omega, hz or rpm of a contact without a unit of time; no numbers, or negative,
        infinite or too large ones. The line says what to give instead.
    """
    keywords = "Omega (dimensionless)" if time is None else _KEYWORDS
    name, value = _the_one(keywords, {"Omega": Omega, "omega": omega, "hz": hz, "rpm": rpm})
    if name == "Omega":
        return _checked(name, value, most)
    if time is None:
        raise InputError(name, value, "left out: a dimensionless contact has no unit of time; give Omega")
    unit = _RADIANS[name] * time
    return _checked(name, value, most / unit) * unit


def radians_per_second(
    time: float | None,
    *,
    Omega: ArrayLike | None = None,
    omega: ArrayLike | None = None,
    hz: ArrayLike | None = None,
    rpm: ArrayLike | None = None,
) -> Array:
    """Angular frequency [rad/s], shape (k,), of something in SI; without a `time` it does not take Omega.

    Raises
    ------
    InputError
        As `dimensionless`.
    """
    keywords = _IN_SI if time is None and Omega is None else _KEYWORDS
    name, value = _the_one(keywords, {"Omega": Omega, "omega": omega, "hz": hz, "rpm": rpm})
    if name != "Omega":
        return _checked(name, value, inf) * _RADIANS[name]
    if time is None:
        raise InputError(
            name, value, "left out: the unit of time of this contact is not known; give omega, hz or rpm"
        )
    return _checked(name, value, inf) / time


def one(name: str, found: Array) -> float:
    """The single frequency of an array; raises `InputError` where there are several."""
    if found.size != 1:
        raise InputError(name, f"{found.size} numbers", "a single frequency")
    return float(found[0])


def by_name(
    positional: int | None, how: str = "", **mistaken: str
) -> Callable[[Callable[P, Result]], Callable[P, Result]]:
    """Let a call say in one line how its frequency is given, where it has no name or that of another unit.

    Parameters
    ----------
    positional : int or None
        Arguments that it takes without a name: one more is taken for a frequency that lacks its own. None for any.
    how : str
        How a frequency is given; by default "named with its unit" and those that the call takes.
    **mistaken : str
        How a frequency is given, by a name that it does not have: ``omega_n`` of a dimensionless `Omega_n`.
    """

    def decorate(call: Callable[P, Result]) -> Callable[P, Result]:
        parameters = signature(call).parameters
        of_frequency = parameters.get("frequency")
        open_ended = of_frequency is not None and of_frequency.kind is Parameter.VAR_KEYWORD
        loose = _LOOSE if open_ended else _LOOSE - set(parameters)
        in_si = "hz" in parameters and "Omega" not in parameters
        named = how or f"named with its unit: {_IN_SI if in_si else _KEYWORDS}"
        if in_si:
            mistaken.setdefault("Omega", f"{_IN_SI}: there is no unit of time that it counts in")

        @wraps(call)
        def checked(*args: P.args, **kwargs: P.kwargs) -> Result:
            if positional is not None and len(args) > positional:
                raise InputError("frequency", args[positional], named)
            for name in mistaken.keys() & kwargs.keys():
                raise InputError(name, kwargs[name], f"given as {mistaken[name]}")
            for name in loose & kwargs.keys():
                raise InputError(name, kwargs[name], named)
            unknown = kwargs.keys() - parameters.keys() - _UNITS.keys() if open_ended else set[str]()
            for name in unknown:
                raise TypeError(f"{call.__name__}() got an unexpected keyword argument {name!r}")
            return call(*args, **kwargs)

        return checked

    return decorate


def fields_by_name(positional: int, **mistaken: str) -> Callable[[type[Result]], type[Result]]:
    """`by_name` for the fields of a class, so many of which need no name; its frequency is the first one."""

    def decorate(cls: type[Result]) -> type[Result]:
        how = f"given as {next(iter(mistaken.values()))}"
        named = by_name(positional + 1, how, **mistaken)(cls.__init__)  # and self
        setattr(cls, "__init__", named)  # noqa: B010
        return cls

    return decorate


def _the_one(keywords: str, values: Mapping[str, ArrayLike | None]) -> tuple[str, ArrayLike]:
    given = {name: value for name, value in values.items() if value is not None}
    if len(given) != 1:
        raise InputError("frequency", " and ".join(given) or None, f"given once, as {keywords}")
    name, value = next(iter(given.items()))
    return name, in_unit(name, value, _UNITS[name])


def _checked(name: str, value: ArrayLike, most: float) -> Array:
    try:
        found = np.atleast_1d(as_numbers(name, value))
    except InputError as error:  # with the value, which is short
        raise InputError(name, value, error.allowed) from None
    if found.ndim != 1 or found.size == 0:
        raise InputError(name, f"of shape {np.shape(found)}", "a number, or a flat list of at least one")
    bad = found[~(np.isfinite(found) & (found >= 0.0) & (found <= most))]
    if bad.size:
        limit = "" if most == inf else f" and <= {most:.6g}"
        raise InputError(name, float(bad[0]), f"finite, >= 0{limit}")
    return found
