"""`Conditions`: what a film is under beside load and speed, made once from the keywords of a call.

Oil supply, heat, sliding and asperities. Which of them go together is decided here, and nowhere else; what each
does to a film is in `ehlcontact.solver`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import wraps
from math import nan
from typing import Any, ParamSpec, TypeVar

from ehlcontact.asperities import Asperities
from ehlcontact.checks import require_instance, shown
from ehlcontact.errors import InputError
from ehlcontact.heat import LARGEST_HEATED, STANDING, Heat
from ehlcontact.point import OperatingPoint, Point, moes_point, scales_of
from ehlcontact.shear_thinning import ShearThinning
from ehlcontact.supply import OilLayer

P = ParamSpec("P")
Result = TypeVar("Result")

SMOOTH = "left out of vibrations and runs, whose films are between smooth surfaces: solve_steady takes asperities"
KEYWORDS = {"supply": "supply", "heat": "thermal", "sliding": "sliding", "asperities": "asperities"}
WANTED = {
    "supply": (OilLayer, "an OilLayer(h, ...)"),
    "heat": (Heat, "True or a Heat(slide_roll=..., ...)"),
    "sliding": (ShearThinning, "a ShearThinning(slide_roll, law)"),
    "asperities": (Asperities, "Asperities(rq, ...)"),
}
# The first is left out with the second, and why
APART = {
    ("sliding", "asperities"): "left out with asperities: it thins films of smooth surfaces",
}
FRICTION = "left out with heat of sliding: that of asperity friction is not known"


@dataclass(frozen=True, slots=True)
class Conditions:
    """Conditions of a film; by default it is flooded, at the temperature of the inlet, between smooth surfaces.

    Parameters
    ----------
    supply : OilLayer, optional
        Oil that the surfaces carry to the contact.
    heat : Heat, optional
        That of the film, with which its viscosity changes.
    sliding : ShearThinning, optional
        Shear thinning of the film.
    asperities : Asperities, optional
        They carry part of the load.

    Raises
    ------
    InputError
        One of them is not what it should be, or two do not go together.

    Examples
    --------
    >>> Conditions.of(thermal=True).heat.slide_roll
    0.0
    """

    supply: OilLayer | None = None
    heat: Heat | None = None
    sliding: ShearThinning | None = None
    asperities: Asperities | None = None

    def __post_init__(self) -> None:
        for name, (kind, allowed) in WANTED.items():
            if getattr(self, name) is not None:
                require_instance(KEYWORDS[name], getattr(self, name), kind, allowed)
        for (name, other), allowed in APART.items():
            if getattr(self, name) is not None and getattr(self, other) is not None:
                raise InputError(KEYWORDS[name], "given", allowed)
        if self.asperities is not None and self.heat is not None and self.heat.slide_roll != 0.0:
            raise InputError("asperities", "given", FRICTION)
        if self.heat is not None and self.sliding is not None:
            _require_one_sliding(self.heat, self.sliding)

    @classmethod
    def of(
        cls,
        *,
        supply: OilLayer | None = None,
        thermal: Heat | bool | None = None,
        sliding: ShearThinning | None = None,
        asperities: Asperities | None = None,
    ) -> Conditions:
        """From the keywords of a call, of which ``thermal=True`` stands for ``Heat()``, and False for none.

        Raises
        ------
        InputError
            As of the class.
        """
        heat = Heat() if thermal is True else None if thermal is False else thermal
        return cls(supply, heat, sliding, asperities)

    @property
    def keywords(self) -> dict[str, Any]:
        """Those that are given, by the names that they have in a call."""
        given = {keyword: getattr(self, name) for name, keyword in KEYWORDS.items()}
        return {keyword: value for keyword, value in given.items() if value is not None}

    @property
    def viscosity_follows(self) -> bool:
        """Whether the viscosity of the oil follows from the film, with the data of the oil."""
        return self.sliding is not None or (self.heat is not None and self.heat.temperature_slope != 0.0)

    def at(self, point: Point) -> Conditions:
        """The same with the data of the oil of this point, and one slide-to-roll ratio.

        Raises
        ------
        InputError
            A dimensionless point with conditions in SI; an oil without the data that heat takes.
        """
        if self.sliding is not None and not isinstance(point, OperatingPoint):
            allowed = "left out at a dimensionless point: stresses of an oil are in pascals"
            raise InputError("sliding", shown(self.sliding), allowed)
        if self.supply is not None:
            self.supply.unit(moes_point(point), scales_of(point), nan)
        if self.asperities is not None:
            self.asperities.numbers(point)
        if self.heat is None:
            return self
        heat = self.heat.at(point)
        if self.sliding is not None and heat.slide_roll == 0.0:
            heat = replace(heat, slide_roll=self.sliding.slide_roll)
        return replace(self, heat=heat)


def between_smooth_surfaces(call: Callable[P, Result]) -> Callable[P, Result]:
    """Let a call that takes the other conditions refuse asperities with the reason: they are not linearised."""

    @wraps(call)
    def checked(*args: P.args, **kwargs: P.kwargs) -> Result:
        if kwargs.pop("asperities", None) is not None:
            raise InputError("asperities", "given", SMOOTH)
        return call(*args, **kwargs)

    return checked


def _require_one_sliding(heat: Heat, sliding: ShearThinning) -> None:
    """Raise `InputError` unless both mean the same sliding, of which heat is known."""
    if sliding.slide_roll > LARGEST_HEATED:
        raise InputError("slide_roll of sliding", sliding.slide_roll, f"{STANDING}: with thermal")
    if heat.slide_roll != 0.0 and abs(heat.slide_roll) != sliding.slide_roll:
        allowed = f"left out of thermal with sliding, or {sliding.slide_roll:g} as there"
        raise InputError("slide_roll", heat.slide_roll, allowed)


FLOODED = Conditions()  # isothermal too, between smooth surfaces
