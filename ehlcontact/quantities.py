"""SI unit, dimensionless unit and axis label of every quantity of a result.

A class declares a quantity where it declares the field or property that holds it ::

    h_min: Annotated[float, LENGTH]
    stiffness: Annotated[Array, STIFFNESS.over("omega")]

`scaled` takes all of them from Moes units to SI, or back. `ehlcontact.results.table` makes tables, dictionaries,
axis labels and figures.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from math import pi
from typing import Any, get_type_hints

from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint, Point, Scales


@dataclass(frozen=True)
class Quantity:
    """Unit, scale and dimensions of a quantity.

    Parameters
    ----------
    unit : str
        In SI, "" for a pure number.
    moes : str
        Unit of the dimensionless value.
    scale : str
        Name of the SI value of the dimensionless unit in `Scales`; "" for what has no unit, or is in SI already.
    dims : tuple of str
        Dimensions of an array in their order. A quantity named like its only dimension is its coordinate.
    listed : bool
        Whether `to_dict` has it.
    only_si : bool
        Dimensionless it is 1, or stands elsewhere: tables and dictionaries have it in SI only.
    """

    unit: str
    moes: str = ""
    scale: str = ""
    dims: tuple[str, ...] = ()
    listed: bool = True
    only_si: bool = False

    def over(self, dims: str, *, listed: bool = True) -> Quantity:
        """The same quantity as an array over `dims`, names separated by spaces."""
        return replace(self, dims=tuple(dims.split()), listed=listed)

    def in_si_only(self) -> Quantity:
        """The quantity for tables and dictionaries in SI only."""
        return replace(self, only_si=True)

    def size(self, scales: Scales) -> float:
        """SI value of the dimensionless unit."""
        return float(getattr(scales, self.scale)) if self.scale else 1.0

    def unit_at(self, point: Point) -> str:
        """Unit of results at a point."""
        return self.moes if isinstance(point, MoesPoint) else self.unit


NUMBER = Quantity("")
LENGTH = Quantity("m", "delta_H", "length")
ALONG = Quantity("m", "a", "a")
ACROSS = Quantity("m", "b", "b")
TIME = Quantity("s", "2a/u_sum", "time")
FREQUENCY = Quantity("rad/s", "u_sum/(2a)", "frequency")
SURFACE_SPEED = Quantity("m/s", "u_sum/2", "surface_speed")
RATE = Quantity("m/s", "delta_H u_sum/(2a)", "rate")
ACCELERATION = Quantity("m/s2", "delta_H (u_sum/(2a))^2", "acceleration")
FORCE = Quantity("N", "f0", "force")
MOMENT = Quantity("N m", "f0 a", "moment")
PRESSURE = Quantity("Pa", "p_h", "pressure")
STIFFNESS = Quantity("N/m", "f0/delta_H", "stiffness")
DAMPING = Quantity("N s/m", "f0/delta_H 2a/u_sum", "damping")
MASS = Quantity("kg", "f0/delta_H (2a/u_sum)^2", "mass")
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
    "separation": "dry approach less approach",
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


def scaled(record: Any, scales: Scales, *, back: bool = False) -> dict[str, Any]:
    """Fields of a dataclass in Moes units whose units are those of `scales`, in SI by their names.

    Dataclasses in it, and dictionaries by names of its quantities, are taken with their own quantities.

    Parameters
    ----------
    record : dataclass
    scales : Scales
    back : bool
        From SI to Moes units.
    """
    own = getattr(record, "_quantities", None)
    declared = quantities_of(type(record)) if own is None else own()
    found: dict[str, Any] = {}
    for name, value in ((f.name, getattr(record, f.name)) for f in fields(record)):
        if value is None:
            continue
        if name in declared:
            if declared[name].scale:
                found[name] = _in_units(value, declared[name], scales, back)
        elif isinstance(value, Mapping) and declared.keys() & value.keys():
            found[name] = {
                key: _in_units(one, declared[key], scales, back) if key in declared else one
                for key, one in value.items()
            }
        elif hasattr(value, "in_units_of"):  # a result of its own
            continue
        elif is_dataclass(value) and _declares(value.__class__) and (inner := scaled(value, scales, back=back)):
            found[name] = replace(value, **inner)  # type: ignore[type-var]
    return found


def _in_units(value: Any, quantity: Quantity, scales: Scales, back: bool) -> Any:
    size = quantity.size(scales)
    return value / size if back else value * size


@cache
def _declares(cls: Any) -> bool:
    """Whether a class declares a quantity, without a look at annotations of classes that it does not import."""
    return any("Annotated" in str(vars(base).get("__annotations__", "")) for base in cls.__mro__)


def in_hertz(point: Point, omega: Any) -> Any:
    """Frequency [Hz] of an angular frequency of a result; raises `InputError` at a `MoesPoint`."""
    if isinstance(point, MoesPoint):
        raise InputError("hz", "asked for", "omega at a dimensionless point, which has no seconds")
    return omega / (2.0 * pi)
