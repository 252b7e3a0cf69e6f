"""The rotor on full contacts against the rotor on elements, and how much of it is the time step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ehlcontact.cli.study.reduction import MEMORY, Reduction
from ehlcontact.cli.study.rotor import build_rotor, load_rotor, run_reduced
from ehlcontact.cli.study.schema import Study
from reduced_models import Comparison, RotorResult, compare

WRONG = ("harmonic", "cubic")  # fitted in the contact's own band, hundreds of times above the rotor's


@dataclass(frozen=True)
class RotorComparison:
    """Runs and what their differences are."""

    full: RotorResult
    full_half: RotorResult  # half the step, shorter
    reduced: Mapping[str, RotorResult]  # "rotor_band" and, where they could be fitted, "memory" and "harmonic"
    whole: Mapping[str, Comparison]  # full against each reduced run, from the start
    last: Mapping[str, Comparison]  # likewise, the last revolution
    half: Comparison  # full against reduced, both with half the step
    step_full: Comparison  # full with the step against full with half of it
    step_reduced: Comparison  # the same for the reduced rotor: what the rotor's integrator contributes

    def to_dict(self) -> dict[str, Any]:
        """All numbers."""
        pairs = {"whole": self.whole, "last_revolution": self.last}
        return {
            **{name: {key: c.to_dict() for key, c in group.items()} for name, group in pairs.items()},
            "half_step": self.half.to_dict(),
            "step_full": self.step_full.to_dict(),
            "step_reduced": self.step_reduced.to_dict(),
            "evaluations_per_step": {
                "full": float(self.full.iterations[1:].mean()),
                "full_half_step": float(self.full_half.iterations[1:].mean()),
            },
        }


def compare_rotors(study: Study, reduction: Reduction, folder: Path) -> RotorComparison:
    """Run the reduced rotors and compare them with the stored full ones."""
    rotor = build_rotor(study)
    full = load_rotor(folder / "rotor_full.h5", rotor)
    full_half = load_rotor(folder / "rotor_half_step.h5", rotor)
    elements: dict[str, Any] = {"rotor_band": reduction.chosen}
    for name, element in ((MEMORY, reduction.memory_si), ("harmonic", reduction.element_si(*WRONG))):
        if element is not None:
            elements[name] = element
    r = study.rotor
    reduced = {name: run_reduced(study, element, 0, r.revolutions) for name, element in elements.items()}
    reduced_half = run_reduced(study, reduction.chosen, 1, r.check_revolutions)
    revolution = 60.0 / study.bearing.speed_rpm
    discard = float(full.t[-1]) - revolution
    return RotorComparison(
        full=full,
        full_half=full_half,
        reduced=reduced,
        whole={name: compare(full, run) for name, run in reduced.items()},
        last={name: compare(full, run, discard=discard) for name, run in reduced.items()},
        half=compare(full_half, reduced_half),
        step_full=compare(full, full_half),
        step_reduced=compare(reduced["rotor_band"], reduced_half),
    )
