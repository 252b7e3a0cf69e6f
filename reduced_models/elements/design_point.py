"""`DesignPoint`: speed, oil and shape of the contact at which an element was fitted; differences from another."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint, Point, Scales, moes_point
from reduced_models.elements.validity import MARGIN

UNIT = {"u_sum": " m/s", "eta0": " Pa s", "alpha": " 1/Pa"}
SAME_SCALES = 1e-6  # relative; more than a rounded file or another order of the same arithmetic makes
POWER = {"L": 0.25}  # of the speed, which is what a difference in L stands for


def known_scale(source: Mapping[str, Any] | None, name: str) -> float | None:
    """SI value of a unit of the point that an element was made at, where its source has it."""
    scales = (source or {}).get("scales")
    return _number(scales, name) if isinstance(scales, Mapping) else None


def require_own_scales(scales: Scales, source: Mapping[str, Any] | None) -> None:
    """Raise `InputError` where the source of an element has other scales."""
    made_at = {name: known_scale(source, name) for name in ("force", "length", "time")}
    known = {name: value for name, value in made_at.items() if value is not None}
    wanted = {name: getattr(scales, name) for name in known}
    if any(not math.isclose(wanted[name], known[name], rel_tol=SAME_SCALES) for name in known):
        raise InputError("scales", wanted, f"those of the point the element was fitted at: {known}")


@dataclass(frozen=True)
class DesignPoint:
    """Speed, oil and shape of the contact that an element was made for; None where its source does not say.

    Attributes
    ----------
    u_sum : float or None
        Sum of the surface speeds [m/s]; of an element in SI only.
    eta0 : float or None
        Viscosity [Pa s].
    alpha : float or None
        Pressure-viscosity coefficient [1/Pa].
    M, L, kappa : float or None
        Moes' load and lubricant parameter, and the ellipse ratio.
    """

    u_sum: float | None = None
    eta0: float | None = None
    alpha: float | None = None
    M: float | None = None
    L: float | None = None
    kappa: float | None = None

    @classmethod
    def of(cls, source: Mapping[str, Any] | None, in_si: bool) -> Self:
        """Design point from the source of an element."""
        entries = (source or {}).get("point")
        point = entries if isinstance(entries, Mapping) else {}
        a, time = (known_scale(source, name) if in_si else None for name in ("a", "time"))
        u_sum = 2.0 * a / time if a is not None and time is not None else None
        return cls(u_sum, *(_number(point, name) for name in ("eta0", "alpha", "M", "L", "kappa")))

    def differences(self, point: Point) -> list[str]:
        """How a point differs from this one in all but its load, in words; a twentieth goes unmentioned."""
        moes = moes_point(point)
        theirs = {"eta0": moes.eta0, "alpha": moes.alpha, "kappa": moes.kappa}
        # Where both speeds are known, L follows from speed, oil and shape.
        by_speed = isinstance(point, OperatingPoint) and self.u_sum is not None
        theirs |= {"u_sum": point.u_sum} if by_speed else {"L": moes.L}  # type: ignore[union-attr]
        differences = []
        for name in ("u_sum", "L", "eta0", "alpha", "kappa"):
            made = getattr(self, name)
            if name in theirs and made is not None and _differs(theirs[name], made, POWER.get(name, 1.0)):
                unit = UNIT.get(name, "")
                differences.append(f"{name} = {theirs[name]:.4g}{unit} (made for {made:.4g}{unit})")
        return differences

    def load_of(self, point: Point) -> float | None:
        """Static load of a point in units of the load that this was made at; None where that is not known."""
        return moes_point(point).M / self.M if self.M else None


def _differs(one: float, other: float, power: float) -> bool:
    margin = (1.0 + MARGIN) ** power
    return not other / margin <= one <= other * margin


def _number(entries: Mapping[str, Any], name: str) -> float | None:
    value = entries.get(name)
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None
