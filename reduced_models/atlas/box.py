"""The box of the atlas: where it answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Self

from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint


@dataclass(frozen=True)
class Box:
    """Ranges of M, L and kappa, and the largest Hertz pressure [Pa]; closed."""

    M: tuple[float, float]
    L: tuple[float, float]
    kappa: tuple[float, float]
    p_hertz: float

    def require_inside(self, point: MoesPoint) -> None:
        """Raise `InputError` naming the axis and the box unless the point lies inside."""
        for name in ("M", "L", "kappa"):
            low, high = getattr(self, name)
            value = getattr(point, name)
            if not low <= value <= high:
                raise InputError(name, value, f"between {low:g} and {high:g}, the box of the atlas ({self})")
        if point.L > 0.0 and point.p_hertz > self.p_hertz:
            allowed = f"at most {self.p_hertz / 1e9:g}e9 Pa, the limit of the atlas ({self})"
            raise InputError("Hertz pressure", f"{point.p_hertz:.4g} Pa", allowed)

    def __str__(self) -> str:
        M, L, kappa = (f"{low:g}..{high:g}" for low, high in (self.M, self.L, self.kappa))
        return f"M {M}, L {L}, kappa {kappa}, Hertz pressure up to {self.p_hertz / 1e9:g} GPa"

    def to_dict(self) -> dict[str, Any]:
        """All fields, for storage."""
        return asdict(self)

    @classmethod
    def from_dict(cls, entries: Mapping[str, Any]) -> Self:
        """The box of such fields."""
        M, L, kappa = ((float(low), float(high)) for low, high in (entries[name] for name in ("M", "L", "kappa")))
        return cls(M, L, kappa, float(entries["p_hertz"]))


BOX = Box(M=(5.0, 30000.0), L=(0.0, 25.0), kappa=(0.08, 1.0), p_hertz=3.5e9)
