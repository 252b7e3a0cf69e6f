"""Differences between the rotor on full contacts, on every element, and on baselines without a film."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from ehlcontact import store
from ehlcontact.cli.study.reduction import DRY, FULL, ROTOR_BAND, UNDAMPED
from ehlcontact.cli.study.rotor import kicked_mode, linear_rotors, run_decay_reduced, run_reduced
from ehlcontact.cli.study.schema import Study
from ehlcontact.errors import ConvergenceError
from ehlcontact.results import Response
from reduced_models import compare
from reduced_models.elements.base import ContactElement
from reduced_models.rotor.compare import Comparison
from reduced_models.rotor.decay import Decrement
from reduced_models.rotor.events import ContactEvents, contact_events
from reduced_models.rotor.free_decay import decay_decrement
from reduced_models.rotor.linearise import LinearRotor
from reduced_models.rotor.modes import RotorMode
from reduced_models.rotor.resonance import Resonances, resonances
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.settling import Settling, settling

DECIDES = 0.2  # share of a full decrement that contacts without a film must miss for the film to decide it

Events = Mapping[str, tuple[ContactEvents, ...]]


@dataclass(frozen=True)
class HalfStep:
    """The rotor under its unbalance once more with half the step: what half_step of [full_films] finds."""

    full: RotorResult
    half: Comparison  # full against the chosen element, both with half the step
    step_full: Comparison  # full with the step against full with half of it, the whole run
    step_reduced: Comparison  # the same for the chosen element: what the rotor's integrator contributes


@dataclass(frozen=True)
class Unbalance:
    """The settled rotor under its unbalance."""

    full: RotorResult
    reduced: Mapping[str, RotorResult]  # by element and baseline; the chosen one is among them
    settling: Mapping[str, Settling]  # also of the full one
    events: Events
    whole: Mapping[str, Comparison]  # full against each reduced run, from the start
    settled: Mapping[str, Comparison]  # likewise, where the full one has settled; empty where it has not
    check: HalfStep | None

    @property
    def best(self) -> Mapping[str, Comparison]:
        """The settled part where there is one, the whole run otherwise."""
        return self.settled or self.whole

    @property
    def step_share(self) -> float | None:
        """Change of the full run by half the step, over the standard deviation of a signal, the largest."""
        if self.check is None:
            return None
        return max(self.check.step_full.displacement or 0.0, self.check.step_full.force or 0.0)

    def to_dict(self) -> dict[str, Any]:
        """All numbers."""
        pairs = {"whole": self.whole, "settled": self.settled}
        solves, check = {"full": float(self.full.iterations[1:].mean())}, {}
        if self.check is not None:
            solves["full_half_step"] = float(self.check.full.iterations[1:].mean())
            check = {
                "half_step": self.check.half.to_dict(),
                "step_full": self.check.step_full.to_dict(),
                "step_reduced": self.check.step_reduced.to_dict(),
            }
        return {
            **{name: {key: c.to_dict() for key, c in group.items()} for name, group in pairs.items()},
            **check,
            "settling": {name: s.to_dict() for name, s in self.settling.items()},
            "events": events_dict(self.events),
            "evaluations_per_step": solves,
        }


@dataclass(frozen=True)
class Decay:
    """The rotor after a kick."""

    mode: RotorMode  # on the film, linearised: the one that is kicked
    runs: Mapping[str, RotorResult]
    decrements: Mapping[str, Decrement]
    half_step: Mapping[str, Decrement]  # of the full film and of the chosen element; empty without half_step
    events: Events

    def off(self, name: str) -> float:
        """How far a decrement is from that of the full film, as a share of it."""
        return self.decrements[name].decrement / self.decrements[FULL].decrement - 1.0

    @property
    def nearest_without(self) -> float | None:
        """How near contacts without a film, or its damping, come: the smaller `off`; None where neither ran."""
        without = [abs(self.off(name)) for name in (UNDAMPED, DRY) if name in self.decrements]
        return min(without, default=None)

    @property
    def film_decides(self) -> bool:
        """Whether neither dry contacts nor undamped ones come near."""
        return self.nearest_without is not None and self.nearest_without > DECIDES

    @property
    def step_share(self) -> float | None:
        """Change of the full film's decrement by half the step, as a share of it."""
        if not self.half_step:
            return None
        return abs(self.half_step[FULL].decrement / self.decrements[FULL].decrement - 1.0)

    def to_dict(self) -> dict[str, Any]:
        """All numbers."""
        return {
            "decrements": {name: d.to_dict() for name, d in self.decrements.items()},
            "off_full": {name: self.off(name) for name in self.decrements if name != FULL},
            **({"half_step": {name: d.to_dict() for name, d in self.half_step.items()}} if self.half_step else {}),
            "film_decides": self.film_decides,
            "events": events_dict(self.events),
        }


@dataclass(frozen=True)
class RotorFindings:
    """Everything about the rotor."""

    unbalance: Unbalance
    decay: Decay
    linear: Mapping[str, LinearRotor]
    kicked: Mapping[str, RotorMode]  # the mode next to the kicked one, on every contact
    resonances: Resonances
    failed: Mapping[str, str]  # contacts that the rotor could not be run on, and why

    def to_dict(self) -> dict[str, Any]:
        """All numbers."""
        return self.unbalance.to_dict() | {
            "decay": self.decay.to_dict(),
            "modes": {name: [one.to_dict() for one in linear.modes()] for name, linear in self.linear.items()},
            "resonance": self.resonances.to_dict(),
            "failed": dict(self.failed),
        }


def compare_rotors(
    study: Study, response: Response, elements: Mapping[str, ContactElement], folder: Path
) -> RotorFindings:
    """Run the rotor on SI elements, by name, and compare it with the stored runs on full contacts.

    An element on which the rotor does not converge is left out and reported; the chosen one raises.
    """
    mode = kicked_mode(study, response)
    ran: dict[str, _RunsOn] = {}
    failed: dict[str, str] = {}
    for name, element in elements.items():
        try:
            turning = run_reduced(study, element, 0)
            ran[name] = _RunsOn(element, turning, run_decay_reduced(study, element, mode, response, 0))
        except ConvergenceError as error:
            if name == ROTOR_BAND[0]:
                raise
            failed[name] = str(error)
    linear = linear_rotors(study, response, {name: one.element for name, one in ran.items()})
    return RotorFindings(
        unbalance=_unbalance(study, ran, folder),
        decay=_decay(study, mode, ran, response, folder),
        linear=linear,
        kicked={name: one.nearest(mode) for name, one in linear.items()},
        resonances=resonances(linear, study.jeffcott.unbalance / study.jeffcott.disc_mass),
        failed=failed,
    )


class _RunsOn(NamedTuple):
    """An element and the rotor on it: turning with unbalance, and decaying after the kick."""

    element: ContactElement
    turning: RotorResult
    decaying: RotorResult


def events_dict(events: Events) -> dict[str, list[dict[str, Any]]]:
    """Contact by contact, for JSON."""
    return {name: [contact.to_dict() for contact in contacts] for name, contacts in events.items()}


def _unbalance(study: Study, ran: Mapping[str, _RunsOn], folder: Path) -> Unbalance:
    load = study.ball_load
    full = store.read(folder / "rotor_full.h5", RotorResult)
    reduced = {name: one.turning for name, one in ran.items()}
    settled = settling(full)
    after: dict[str, Comparison] = {}
    if settled.settled_from is not None:
        begin = settled.settled_from * 60.0 / study.speed_rpm
        after = {name: compare(full, run, discard=begin) for name, run in reduced.items()}
    return Unbalance(
        full=full,
        reduced=reduced,
        settling={FULL: settled} | {name: settling(run) for name, run in reduced.items()},
        events={FULL: contact_events(full, load)}
        | {name: _events(one, one.turning, load) for name, one in ran.items()},
        whole={name: compare(full, run) for name, run in reduced.items()},
        settled=after,
        check=_half_step(study, full, ran[ROTOR_BAND[0]], folder) if _checked(study) else None,
    )


def _checked(study: Study) -> bool:
    return study.full_films is not None and study.full_films.half_step


def _half_step(study: Study, full: RotorResult, chosen: _RunsOn, folder: Path) -> HalfStep:
    full_half = store.read(folder / "rotor_half_step.h5", RotorResult)
    reduced_half = run_reduced(study, chosen.element, 1)
    return HalfStep(
        full=full_half,
        half=compare(full_half, reduced_half),
        step_full=compare(full, full_half),
        step_reduced=compare(chosen.turning, reduced_half),
    )


def _decay(study: Study, mode: RotorMode, ran: Mapping[str, _RunsOn], response: Response, folder: Path) -> Decay:
    load = study.ball_load
    full = store.read(folder / "decay.h5", RotorResult)
    runs = {FULL: full} | {name: one.decaying for name, one in ran.items()}
    half: dict[str, RotorResult] = {}
    if _checked(study):
        half[FULL] = store.read(folder / "decay_half_step.h5", RotorResult)
        half[ROTOR_BAND[0]] = run_decay_reduced(study, ran[ROTOR_BAND[0]].element, mode, response, 1)
    return Decay(
        mode=mode,
        runs=runs,
        decrements={name: decay_decrement(run, mode) for name, run in runs.items()},
        half_step={name: decay_decrement(run, mode) for name, run in half.items()},
        events={FULL: contact_events(full, load)}
        | {name: _events(one, one.decaying, load) for name, one in ran.items()},
    )


def _events(ran: _RunsOn, run: RotorResult, load: float) -> tuple[ContactEvents, ...]:
    return contact_events(run, load, [ran.element] * run.force.shape[1])
