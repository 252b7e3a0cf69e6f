"""Free decay of a study's rotor after an initial velocity, on full contacts and on elements, and its decrement."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np

from ehlcontact.cli.study.response import bounce, film_response, linear_rotor
from ehlcontact.cli.study.rotor import EXACT, TOLERANCE, build_rotor, full_contacts, rest_of, told_elsewhere
from ehlcontact.cli.study.schema import Study
from ehlcontact.results import ImpedanceResult
from reduced_models import (
    ContactElement,
    Decrement,
    JeffcottRotor,
    RotorMode,
    RotorResult,
    RotorState,
    film_impedance,
    log_decrement,
    simulate_rotor,
)

LEFT_OUT = 1.0  # periods at the beginning of a decay that are not fitted: what was kicked beside the mode


def kicked_mode(study: Study, response: ImpedanceResult) -> RotorMode:
    """The mode that is kicked: that on the film, whatever then carries the rotor, so that all kicks are alike."""
    return bounce(linear_rotor(build_rotor(study, unbalance=False), film_impedance(response)))


def decay_step(study: Study, mode: RotorMode, halvings: int) -> float:
    """Step of the decay [s]."""
    return 2.0 * pi / mode.omega / (study.rotor.decay_steps_per_period * 2**halvings)


def run_decay_full(study: Study, halvings: int, callback: Callable[[int, int], None]) -> RotorResult:
    """Decay with the whole film in every contact."""
    response = film_response(study)
    mode = kicked_mode(study, response)
    rotor = build_rotor(study, unbalance=False)
    contacts = full_contacts(study, rotor)
    start = kicked(study, rest_of(rotor, contacts), mode, response)
    return _run(study, rotor, contacts, start, mode, halvings, callback)


def run_decay_reduced(
    study: Study, element: ContactElement, mode: RotorMode, response: ImpedanceResult, halvings: int
) -> RotorResult:
    """Decay after the same kick with an SI element in every contact, from its own rest."""
    rotor = build_rotor(study, unbalance=False)
    elements = [element.copy() for _ in rotor.mounts]
    with told_elsewhere():
        rest = rotor.static_equilibrium(elements)
        for contact, approach in zip(elements, rotor.approaches(rest.journal).tolist(), strict=True):
            contact.rest(approach)
        start = kicked(study, rest, mode, response)
        return _run(study, rotor, elements, start, mode, halvings)


def kicked(study: Study, rest: RotorState, mode: RotorMode, response: ImpedanceResult) -> RotorState:
    """The state at rest with the velocities of the mode, as fast as the entry `kick` of the study has it.

    So fast that without damping the load of a contact would swing by that share of the load at rest.
    """
    rotor = build_rotor(study)
    stiffness = abs(film_impedance(response)(np.array([mode.omega]))[0])
    along = np.abs(rotor.normals @ mode.journal.real[list(rotor.axes)]).max()
    speed = mode.omega * study.rotor.kick * study.ball_load / (stiffness * float(along))
    return RotorState(rest.disc, rest.journal, speed * mode.disc.real, speed * mode.journal.real)


def decrement_of(run: RotorResult, mode: RotorMode) -> Decrement:
    """Fit the decay of the journal's height."""
    # a hair before the end of a period, on which a sample lies: rounding must not say whether it counts
    fitted = run.t >= LEFT_OUT * 2.0 * pi / mode.omega * (1.0 - 1e-9)
    return log_decrement(run.t[fitted], run.journal[fitted, 1], omega=mode.omega)


def _run(
    study: Study,
    rotor: JeffcottRotor,
    contacts: list,
    start: RotorState,
    mode: RotorMode,
    halvings: int,
    callback: Callable[[int, int], None] | None = None,
) -> RotorResult:
    return simulate_rotor(
        rotor,
        contacts,
        dt=decay_step(study, mode, halvings),
        until=study.rotor.decay_periods * 2.0 * pi / mode.omega,
        start=start,
        tolerance=EXACT if callback is None else TOLERANCE,
        callback=callback,
    )
