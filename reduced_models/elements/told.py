"""What an element says of itself at the prompt: kind, where it holds, how well it fits; arrays left out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ehlcontact.results.story import Told
from reduced_models.elements.validity import frequency_text, text_of

if TYPE_CHECKING:
    from reduced_models.elements.validity import Band, Validity


class ToldElement(Told):
    """Base of the elements, for that."""

    units: str
    validity: Validity
    load_range: Band | None
    omega_range: Band | None
    fit: Mapping[str, Any] | None
    parameters: Any
    state_count: Any

    def _story(self) -> list[str]:
        si = self.units == "SI"
        numbers = {k: v for k, v in self.parameters.items() if isinstance(v, int | float)}
        arrays = [k for k in self.parameters if k not in numbers]
        told = [
            f"{self.units}, {f'{self.state_count} states' if self.state_count else 'no memory'}",
            ", ".join(
                [*(f"{name} {value:.4g}" for name, value in numbers.items()), *(f"{k} [..]" for k in arrays)]
            ),
            f"approach {text_of(self.validity.approach)}{' m' if si else ''}",
        ]
        if self.load_range is not None:
            told[-1] += f", load {text_of(self.load_range)}{' N' if si else ''}"
        if self.omega_range is not None:
            told.append(frequency_text(self.omega_range, self.units))
        rms = None if self.fit is None else self.fit.get("rms")
        if isinstance(rms, int | float):
            told.append(f"rms error {100.0 * rms:.2g} % of the standard deviation of the force it was fitted to")
        return told
