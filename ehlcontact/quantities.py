"""SI unit, dimensionless unit and axis label of every quantity of a result.

A class declares a quantity where it declares the field or property that holds it ::

    h_min: Annotated[float, LENGTH]
    stiffness: Annotated[Array, STIFFNESS.over("Omega")]

`ehlcontact.results.table` makes values in SI (``.si``), tables, dictionaries, axis labels and figures of that.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from math import pi
from typing import Any, get_type_hints

from ehlcontact.errors import InputError
from ehlcontact.point import Scales


@dataclass(frozen=True)
class Quantity:
    """Unit, scale and dimensions of a quantity.

    Parameters
    ----------
    unit : str
        In SI, "" for a pure number.
    moes : str
        Unit of the dimensionless value.
    to_si : callable, optional
        SI value of a dimensionless value at `Scales`; None for what has no unit, or is in SI already.
    dims : tuple of str
        Dimensions of an array in their order. A quantity named like its only dimension is its coordinate.
    listed : bool
        Whether `to_dict` has it.
    si_name : str
        Name in SI; by default the lower-case name.
    only_si : bool
        Dimensionless it is 1, or stands elsewhere: tables and dictionaries have it in SI only.
    """

    unit: str
    moes: str = ""
    to_si: Callable[[Any, Scales], Any] | None = None
    dims: tuple[str, ...] = ()
    listed: bool = True
    si_name: str = ""
    only_si: bool = False

    def over(self, dims: str, *, listed: bool = True) -> Quantity:
        """The same quantity as an array over `dims`, names separated by spaces."""
        return replace(self, dims=tuple(dims.split()), listed=listed)

    def in_si_only(self, si_name: str = "") -> Quantity:
        """The same quantity for tables and dictionaries in SI only."""
        return replace(self, only_si=True, si_name=si_name)

    def in_si(self, value: Any, scales: Scales) -> Any:
        """SI value of a dimensionless one; None stays None."""
        return value if value is None or self.to_si is None else self.to_si(value, scales)


NUMBER = Quantity("")
LENGTH = Quantity("m", "delta_H", lambda value, s: value * s.length)
ALONG = Quantity("m", "a", lambda value, s: value * s.a)
ACROSS = Quantity("m", "b", lambda value, s: value * s.b)
TIME = Quantity("s", "2a/u_sum", lambda value, s: value * s.time)
FREQUENCY = Quantity("rad/s", "u_sum/(2a)", lambda value, s: value / s.time)
SURFACE_SPEED = Quantity("m/s", "u_sum/2", lambda value, s: value * (s.a / s.time))
RATE = Quantity("m/s", "delta_H u_sum/(2a)", lambda value, s: value * s.rate)
ACCELERATION = Quantity("m/s2", "delta_H (u_sum/(2a))^2", lambda value, s: value * (s.rate / s.time))
FORCE = Quantity("N", "f0", lambda value, s: value * s.force)
MOMENT = Quantity("N m", "f0 a", lambda value, s: value * s.moment)
PRESSURE = Quantity("Pa", "p_h", lambda value, s: value * s.pressure)
STIFFNESS = Quantity("N/m", "f0/delta_H", lambda value, s: value * s.stiffness)
DAMPING = Quantity("N s/m", "f0/delta_H 2a/u_sum", lambda value, s: value * s.damping)
# Of a natural frequency: the mass that has it (eq. 5)
MASS = Quantity("kg", "u_sum/(2a)", lambda value, s: s.stiffness * (s.time / value) ** 2)
# Units without a dimensionless counterpart
HERTZ = Quantity("Hz")
RADIAN = Quantity("rad")
SPEED = Quantity("rev/min")
PER_SECOND = Quantity("1/s")

# By name in lower case: X and x, H and h, Omega and omega are one quantity in two units
WORDS = {
    "x": "place along rolling",
    "y": "place across",
    "p": "pressure",
    "h": "film",
    "t": "time",
    "h_central": "film in the centre",
    "h_min": "smallest film",
    "p_max": "largest pressure",
    "approach": "mutual approach",
    "rate": "rate of approach",
    "force": "contact force",
    "load": "applied load",
    "omega": "angular frequency",
    "hz": "frequency",
    "film_share": "film's share of the dry approach",
    "moment": "rolling resistance",
    "h_midplane": "film along the middle",
    "p_midplane": "pressure along the middle",
    "speed_rpm": "speed",
    "lambda_ratio": "smallest film over roughness",
    "major": "semi-major axis of the orbit",
    "angles": "angle of the ball",
}


def words(name: str) -> str:
    """Name of a quantity in words, for axes."""
    return WORDS.get(name.lower(), name.replace("_", " "))


def quantities_of(cls: Any) -> Mapping[str, Quantity]:
    """Quantities that a class declares, by name: annotated attributes in their order, then properties."""
    return _quantities(cls)


@cache
def _quantities(cls: Any) -> Mapping[str, Quantity]:
    found = {name: _declared(hint) for name, hint in get_type_hints(cls, include_extras=True).items()}
    for base in reversed(cls.__mro__):
        for name, member in vars(base).items():
            if isinstance(member, property) and "Annotated" in str(member.fget.__annotations__.get("return")):
                found[name] = _declared(get_type_hints(member.fget, include_extras=True)["return"])
    return {name: quantity for name, quantity in found.items() if quantity is not None}


def _declared(hint: Any) -> Quantity | None:
    return next((data for data in getattr(hint, "__metadata__", ()) if isinstance(data, Quantity)), None)


def si_quantities(declared: Mapping[str, Quantity]) -> dict[str, tuple[str, Quantity]]:
    """Own name and SI quantity of those that have a unit, by their SI name; frequencies in Hz too."""
    found: dict[str, tuple[str, Quantity]] = {}
    for name, quantity in declared.items():
        if quantity.to_si is None:
            continue
        dims = tuple(si_dimension(dim) for dim in quantity.dims)
        found[quantity.si_name or name.lower()] = name, replace(quantity, dims=dims)
        if name == "Omega":
            found["hz"] = name, replace(HERTZ, dims=dims, to_si=lambda value, s: value / s.time / (2.0 * pi))
    return found


def si_dimension(dim: str) -> str:
    """Name of a dimension in SI: that of its coordinate, which is ``hz`` for frequencies."""
    return "hz" if dim == "Omega" else dim.lower()


def require_scales(scales: Scales | None) -> Scales:
    """Return `scales`, or raise `InputError` where a dimensionless point has none."""
    if scales is None:
        allowed = "those of a result made from an OperatingPoint: a dimensionless point has no SI values"
        raise InputError("scales", None, allowed)
    return scales
