"""`OilLayer`: the oil that the surfaces carry to a contact, as an input.

How the solver uses it: `ehlcontact.solver.kernels.supply`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, is_single, parts, require_nonnegative
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.jit import plain
from ehlcontact.lubricant import density
from ehlcontact.point import MoesPoint, Point, Scales
from ehlcontact.summary import Summary

Array = NDArray[np.float64]

THICKEST = {"h": 1e-3, "over_flooded": 1e6, "H": 1e6}  # in m; flooded films; dry approaches
UNITS = {"h": "m", "over_flooded": "flooded films", "H": "dry approaches"}
NARROWEST = 0.01  # y/b: below, the places of a profile were given in m
SLIP = 0.05  # m: below, a thickness that is too large is one in um


@fields_take(h="m")
@dataclass(frozen=True, slots=True)
class OilLayer(Summary):
    """Layer of oil on both surfaces together, ahead of the contact; exactly one of `h`, `over_flooded` and `H`.

    Parameters
    ----------
    h : float or array_like, shape (k,)
        Thickness [m], at an `OperatingPoint`.
    over_flooded : float or array_like, shape (k,)
        Thickness over that of the flooded central film as a layer, which is the film times its density under the
        Hertz pressure: the r of the literature. The flooded film is solved on the same grid, at the temperature of
        the inlet: with heat too, r stands for the same oil.
    H : float or array_like, shape (k,)
        Thickness over the dry approach, as results have it.
    y : array_like, shape (k,), optional
        Places across, y/b >= 0 and increasing, of the k thicknesses: the layer is even in y, linear between them
        and constant beyond. Left out for a uniform layer.

    Raises
    ------
    InputError
        None or several of the three; a thickness below 0, above 1 mm, or 0 everywhere; places that do not fit, or
        are in m.

    Examples
    --------
    >>> OilLayer(0.4e-6).h
    4e-07
    """

    h: Any = None
    over_flooded: Any = None
    H: Any = None
    y: Any = None

    def __post_init__(self) -> None:
        given = [name for name in UNITS if getattr(self, name) is not None]
        if len(given) != 1:
            raise InputError("supply", " and ".join(given) or None, "exactly one of h, over_flooded and H")
        name = given[0]
        values = _thickness(name, getattr(self, name))
        places = None if self.y is None else as_column("y of the supply", self.y, increasing=True)
        if (places is None) != np.isscalar(values):
            raise InputError("y of the supply", places, "given with several thicknesses, and left out with one")
        if places is not None:
            if places.size != np.size(values):
                raise InputError("length of y of the supply", places.size, f"{np.size(values)}, as of the layer")
            if places[0] < 0.0:
                raise InputError("y of the supply", float(places[0]), ">= 0: the layer is even in y")
            if 0.0 < places[-1] < NARROWEST:
                allowed = f"over the semi-axis b, the largest at least {NARROWEST:g} (given in m?)"
                raise InputError("y of the supply", float(places[-1]), allowed)
            object.__setattr__(self, "y", tuple(places.tolist()))
        object.__setattr__(self, name, values)

    @property
    def _name(self) -> str:
        return next(name for name in UNITS if getattr(self, name) is not None)

    @property
    def needs_flooded(self) -> bool:
        """Whether its thickness is that of a flooded film, which has to be solved first."""
        return self.over_flooded is not None

    @takes(Y=parts.ANY)
    def at(self, Y: ArrayLike) -> Array:
        """Thickness at y/b >= 0, in its own unit."""
        values, places = getattr(self, self._name), np.asarray(Y, dtype=float)
        return np.full(places.shape, values) if self.y is None else np.interp(places, self.y, values)

    def unit(self, point: MoesPoint, scales: Scales | None, flooded: float) -> float:
        """Dry approaches in the unit of its thickness; `flooded` is the flooded central film, or NaN.

        Raises
        ------
        InputError
            A thickness in metres at a point without metres.
        """
        if self.h is not None:
            if scales is None:
                raise InputError("supply", "h in m", "over_flooded or H at a dimensionless point")
            return 1.0 / scales.length
        return flooded * float(plain(density)(1.0, point.law)[0]) if self.needs_flooded else 1.0

    def lines(self, point: MoesPoint, scales: Scales | None, flooded: float) -> Callable[[Array], Array]:
        """Layer at the lines Y in dry approaches, as the solver takes it; arguments as of `unit`."""
        unit = self.unit(point, scales, flooded)
        return lambda Y: unit * self.at(Y)

    def to_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        value = getattr(self, self._name)
        given = {self._name: list(value) if isinstance(value, tuple) else value}
        return given if self.y is None else given | {"y": list(self.y)}

    @classmethod
    def from_dict(cls, entries: Mapping[str, Any]) -> OilLayer:
        """Back from `to_dict`."""
        return cls(**entries)


def layer_on(point: Point, h: Array, y: Array) -> OilLayer:
    """Layer that a result at a point has over its y, as a supply of contacts of the same size."""
    places = y / point.scales.b
    return OilLayer(H=h, y=places) if isinstance(point, MoesPoint) else OilLayer(h=h, y=places)


def _thickness(name: str, value: Any) -> float | tuple[float, ...]:
    """Thickness, or several of them, that a layer can have."""
    most = THICKEST[name]
    field = f"{name} of the supply"
    values = np.atleast_1d(require_nonnegative(field, value) if is_single(value) else as_column(field, value))
    for number in values.tolist():
        if not 0.0 <= number <= most:
            slip = "; is it in um?" if name == "h" and number > SLIP else ""
            raise InputError(field, number, f"between 0 and {most:g} {UNITS[name]}{slip}")
    if not values.any():
        raise InputError(field, 0.0, "> 0 somewhere: without oil the contact is dry")
    return float(values[0]) if is_single(value) else tuple(values.tolist())
