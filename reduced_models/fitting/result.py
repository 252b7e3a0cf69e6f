"""What every fit gives, whatever the model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from reduced_models.elements.base import ContactElement


@dataclass(frozen=True, eq=False, kw_only=True)
class ElementFit:
    """An element and how well it stands for its data; judge by ``rms``."""

    element: ContactElement
    model: str
    parameters: Mapping[str, Any]
    rms: float | None  # RMS error of the force / standard deviation of the force; None without records
    e_f: float | None  # eq. 13 for the force: sum(f - f_fit)/sum(f); near zero by construction
    root: float | None  # approach where the spring carries the static load (1, dimensionless)
    tangent: float | None  # spring tangent there
    valid: Mapping[str, Any]  # low, high: fitted approach; rate: largest |rate|; load, omega: (low, high)
    condition: float | None  # of the column-scaled design matrix, or Jacobian; None where there is none

    def to_dict(self) -> dict[str, Any]:
        """Everything but the element, ready for JSON."""
        return {
            "model": self.model,
            "parameters": dict(self.parameters),
            "rms": self.rms,
            "e_f": self.e_f,
            "root": self.root,
            "tangent": self.tangent,
            "valid": {k: list(v) if isinstance(v, tuple) else v for k, v in self.valid.items()},
            "condition": self.condition,
        }

    def quality(self) -> dict[str, Any]:
        """What the element keeps of `to_dict`: its coefficients and its box stand elsewhere in its file."""
        return {key: value for key, value in self.to_dict().items() if key not in ("parameters", "valid")}
