"""The rotor of a study on full contacts and on elements, turning with its unbalance: its runs."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import ceil, cos, radians
from typing import Any

import numpy as np

from ehlcontact.cli.study.response import at_rotor_speed, film_response
from ehlcontact.cli.study.schema import Study
from ehlcontact.errors import ConvergenceError
from ehlcontact.results import ImpedanceResult
from ehlcontact.solver.grid import Grid
from ehlcontact.status import Status
from ehlcontact.transient.full_contact import FullContact
from reduced_models import (
    ContactElement,
    JeffcottRotor,
    OutsideValidityWarning,
    RotorResult,
    RotorState,
    ScaledContact,
    linearise,
    local_contact,
    simulate_rotor,
)
from reduced_models.rotor.settling import run_until_settled

# Of the force balance on full films: at a third of it they take 2 to 3 solves per step in place of 2, and at ten
# times as much the journal's velocity under a light unbalance shows it.
TOLERANCE = 1e-6
EXACT = 1e-9  # likewise on elements, which cost nothing
# Before a run the film is led along the motion it starts on: so long, in its unit of time, of which it takes 2 to
# cross the contact; and so many steps at least.
LEAD_IN = (8.0, 3)


def build_rotor(study: Study, *, unbalance: bool = True) -> JeffcottRotor:
    """Rotor of the study, pressed down so that every contact carries the load of the operating point."""
    r, ball = study.rotor, study.ball_load
    vee = r.arrangement == "vee"
    half_angle = radians(r.half_angle_deg)
    bearings = 2
    needed = bearings * ball * (2.0 * cos(half_angle) if vee else 1.0)
    weight = (r.disc_mass + r.journal_mass) * 9.81
    settings: dict[str, Any] = {
        "disc_mass": r.disc_mass,
        "journal_mass": r.journal_mass,
        "shaft_stiffness": r.shaft_stiffness,
        "shaft_damping": r.shaft_damping,
        "disc_damping": r.disc_damping,
        "unbalance": r.unbalance if unbalance else 0.0,
        "speed_rpm": study.bearing.speed_rpm,
        "bearings": bearings,
        "load": (0.0, weight - needed),
    }
    if vee:
        return JeffcottRotor.vee(half_angle=half_angle, **settings)
    return JeffcottRotor.vertical(**settings)


def time_step(study: Study, halvings: int = 0) -> float:
    """Step of the turning rotor [s]."""
    return 60.0 / study.bearing.speed_rpm / (study.rotor.steps_per_revolution * 2**halvings)


def full_contacts(study: Study, rotor: JeffcottRotor) -> list[ScaledContact]:
    """Films at rest under the load of the operating point, one for every mount."""
    point = study.point
    films = [FullContact(point, grid=Grid(n=study.solver.n_transient, domain=study.domain)) for _ in rotor.mounts]
    return [ScaledContact(film, point.scales) for film in films]


def rest_of(rotor: JeffcottRotor, contacts: list[ScaledContact]) -> RotorState:
    """The rotor at rest on full contacts."""
    return rotor.state_at([c.contact.static_approach * c.scales.length for c in contacts])


def run_full(study: Study, halvings: int, callback: Callable[[int, int], None]) -> RotorResult:
    """Rotor with the whole film in every contact, from near its settled motion on."""
    rotor = build_rotor(study)
    contacts = full_contacts(study, rotor)
    start: Any = rest_of(rotor, contacts)
    try:
        orbit = first_orbit(study, rotor, halvings)
        _lead(contacts, orbit, study.point.scales.time)
        start = orbit.displacement[-1], orbit.velocity[-1]
    except ConvergenceError as error:  # a motion so wild that no element, or no film, follows it: then from rest
        if getattr(error.result, "status", None) is Status.INTERRUPTED:
            raise KeyboardInterrupt from None
        contacts = full_contacts(study, rotor)
    return simulate_rotor(
        rotor,
        contacts,
        dt=time_step(study, halvings),
        until=study.rotor.revolutions * 60.0 / study.bearing.speed_rpm,
        start=start,
        tolerance=TOLERANCE,
        callback=callback,
    )


def first_orbit(study: Study, rotor: JeffcottRotor, halvings: int) -> RotorResult:
    """A settled revolution on contacts with approach, stiffness and damping of the film at the rotor's speed."""
    response = film_response(study)
    element = contact_of(study, response)
    return _settled(study, rotor, element, halvings, 1)


def contact_of(study: Study, response: ImpedanceResult) -> ContactElement:
    """The film at the rotor's frequency as an element, from its impedance alone."""
    Z = at_rotor_speed(study, response)
    omega = 2.0 * np.pi * study.rotor_hz
    approach = response.approach * study.point.scales.length
    return local_contact(study.ball_load, approach, Z.real, Z.imag / omega)


def run_reduced(study: Study, element: ContactElement, halvings: int) -> RotorResult:
    """The same with an SI element in every contact, settled where it can be, the same revolutions long."""
    return _settled(study, build_rotor(study), element, halvings, study.rotor.revolutions)


def _settled(
    study: Study, rotor: JeffcottRotor, element: ContactElement, halvings: int, revolutions: int
) -> RotorResult:
    elements = [element.copy() for _ in rotor.mounts]
    linear = linearise(rotor, contacts=elements)
    with told_elsewhere():
        return run_until_settled(
            rotor,
            elements,
            steps=study.rotor.steps_per_revolution * 2**halvings,
            revolutions=revolutions,
            start=linear.orbit(),
            tolerance=EXACT,
        )


@contextmanager
def told_elsewhere() -> Iterator[None]:
    """No warnings about validity meanwhile: `contact_events` collects them, of the revolutions that are shown."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutsideValidityWarning)
        yield


def _lead(contacts: list[ScaledContact], orbit: RotorResult, film_time: float) -> None:
    """Move every film along the end of an orbit, so that it has the past that belongs to where it starts.

    From where the orbit passes its place of rest, so that no film is made to jump.
    """
    dt = float(orbit.t[1] - orbit.t[0])
    steps = max(LEAD_IN[1], ceil(LEAD_IN[0] * film_time / dt))
    for i, contact in enumerate(contacts):
        away = np.abs(orbit.approach[:, i] - contact.contact.static_approach * contact.scales.length)
        first = int(np.argmin(away[: max(1, away.size - steps)]))
        for u, v in zip(orbit.approach[first:, i], orbit.rate[first:, i], strict=True):
            contact.advance(dt, float(u), float(v))
