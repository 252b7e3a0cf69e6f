"""The rotor of a study on full films and on elements: turning with its unbalance, and decaying after a kick."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from math import cos, radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.study.sections import FullFilms
from ehlcontact.errors import ConvergenceError
from ehlcontact.response import impedance
from ehlcontact.results import Response
from ehlcontact.solver.grid import Grid
from reduced_models import OutsideValidityWarning, Rotor, jeffcott_rotor, linearise
from reduced_models.elements.base import ContactElement
from reduced_models.fitting.memory_fit import OMEGAS
from reduced_models.rotor.baselines import local_contact
from reduced_models.rotor.free_decay import initial_velocity, simulate_decay
from reduced_models.rotor.full_films import (
    ELEMENT_TOLERANCE,
    FILM_TOLERANCE,
    on_films,
    rest_on_films,
    settled_run,
    simulate_on_films,
)
from reduced_models.rotor.linear_contact import film_impedance, impedance_about
from reduced_models.rotor.linearise import LinearRotor
from reduced_models.rotor.modes import RotorMode
from reduced_models.rotor.result import RotorResult

BELOW = 0.5  # of the rotor's frequency: the lowest one of the impedance, but for rest


def build_rotor(study: Study, *, unbalance: bool = True) -> Rotor:
    """Rotor of the study, pressed down so that every contact carries the load of the operating point."""
    r, ball = study.jeffcott, study.ball_load
    vee = r.arrangement == "vee"
    half_angle = radians(r.half_angle_deg)
    bearings = 2
    needed = bearings * ball * (2.0 * cos(half_angle) if vee else 1.0)
    weight = (r.disc_mass + r.journal_mass) * 9.81
    return jeffcott_rotor(
        disc_mass=r.disc_mass,
        journal_mass=r.journal_mass,
        shaft_stiffness=r.shaft_stiffness,
        shaft_damping=r.shaft_damping,
        disc_damping=r.disc_damping,
        unbalance=r.unbalance if unbalance else 0.0,
        speed_rpm=study.speed_rpm,
        bearings=bearings,
        half_angle=half_angle if vee else None,
        load=(0.0, weight - needed),
    )


def film_response(study: Study) -> Response:
    """Impedance on the mesh of the transient films, from below the rotor's frequency to far above the contact's.

    It is the same every time: a stage that needs it solves it again, in the time of a few steps of its run.
    """
    return impedance(study.point, Omega=frequencies(study), grid=_grid(study))


def frequencies(study: Study) -> list[float]:
    """Dimensionless angular frequencies of `film_response`: below those of a film memory as close as they are."""
    own, lowest = study.rotor_omega, OMEGAS[1]
    start = BELOW * own
    decades = np.log10(lowest / start) if start < lowest else 0.0
    below = np.geomspace(start, lowest, 1 + int(np.ceil(7.0 * decades)))[:-1].tolist() if decades else []
    return sorted({*OMEGAS, *below, own})


def stiffness_and_damping(response: Response, omega: float) -> tuple[float, float]:
    """Of one contact [N/m] and [N s/m], by its impedance at a frequency [rad/s]."""
    Z = complex(film_impedance(response)(np.array([omega]))[0])
    return Z.real, Z.imag / omega


def linear_rotors(
    study: Study, response: Response, elements: Mapping[str, ContactElement]
) -> dict[str, LinearRotor]:
    """The rotor on the film, "full", and on every element, linearised about rest."""
    rotor, impedances = build_rotor(study), {"full": film_impedance(response)}
    impedances |= {name: impedance_about(element, study.ball_load) for name, element in elements.items()}
    return {name: linearise(rotor.on([one] * len(rotor.mounts))) for name, one in impedances.items()}


def kicked_mode(study: Study, response: Response) -> RotorMode:
    """The slowest vertical mode on the film: that of the kick whatever then carries the rotor.

    Raises
    ------
    ConvergenceError
        None oscillates.
    """
    found = linear_rotors(study, response, {})["full"].slowest().get("y")
    if found is None:
        raise ConvergenceError("no vertical mode of this rotor oscillates: it is damped too much", None)
    return found


def run_full(study: Study, halvings: int, callback: Callable[[int, int], None]) -> RotorResult:
    """Rotor with the whole film in every contact, from near its settled motion on."""
    response, omega = film_response(study), 2.0 * np.pi * study.rotor_hz
    film = response.dimensionless.film
    assert film is not None
    approach = film.approach * study.point.scales.length
    return simulate_on_films(
        build_rotor(study),
        study.point,
        _grid(study),
        local_contact(study.ball_load, approach, *stiffness_and_damping(response, omega)),
        steps=_films(study).steps_per_revolution * 2**halvings,
        revolutions=_films(study).revolutions,
        callback=callback,
    )


def run_reduced(study: Study, element: ContactElement, halvings: int) -> RotorResult:
    """The same with an SI element in every contact, settled where it can be, the same revolutions long."""
    films = _films(study)
    steps = films.steps_per_revolution * 2**halvings
    return settled_run(build_rotor(study), element, steps=steps, revolutions=films.revolutions)


def run_decay_full(study: Study, halvings: int, callback: Callable[[int, int], None]) -> RotorResult:
    """Decay with the whole film in every contact."""
    response, rotor = film_response(study), build_rotor(study, unbalance=False)
    mode, whole = kicked_mode(study, response), on_films(rotor, study.point, _grid(study))
    start = rest_on_films(whole), _kick(study, rotor, mode, response)
    settings = _decay_settings(study, halvings)
    return simulate_decay(whole, start, mode, tolerance=FILM_TOLERANCE, callback=callback, **settings)


def run_decay_reduced(
    study: Study, element: ContactElement, mode: RotorMode, response: Response, halvings: int
) -> RotorResult:
    """Decay after the same kick with an SI element in every contact, from its own rest."""
    rotor = build_rotor(study, unbalance=False)
    rotor = rotor.on([element.copy() for _ in rotor.mounts])
    with warnings.catch_warnings():  # `contact_events` collects them
        warnings.simplefilter("ignore", OutsideValidityWarning)
        rest = rotor.equilibrium()
        for mount, approach in zip(rotor.contacts, rotor.approaches(rest).tolist(), strict=True):
            mount.contact.rest(approach)
        start, settings = (rest, _kick(study, rotor, mode, response)), _decay_settings(study, halvings)
        return simulate_decay(rotor, start, mode, tolerance=ELEMENT_TOLERANCE, **settings)


def _grid(study: Study) -> Grid:
    """Of every film in motion."""
    assert study.contact is not None
    return Grid(n=study.contact.n_transient, domain=study.domain)


def _films(study: Study) -> FullFilms:
    assert study.full_films is not None  # of a stage that is wanted
    return study.full_films


def _decay_settings(study: Study, halvings: int) -> dict[str, Any]:
    steps = _films(study).decay_steps_per_period * 2**halvings
    return {"periods": _films(study).decay_periods, "steps_per_period": steps}


def _kick(study: Study, rotor: Rotor, mode: RotorMode, response: Response) -> NDArray[np.float64]:
    """Velocities of the mode, as fast as the entry `kick` of the study has it."""
    stiffness = float(abs(film_impedance(response)(np.array([mode.omega]))[0]))
    load, load_share = study.ball_load, _films(study).kick
    return initial_velocity(rotor, mode, stiffness=stiffness, load=load, load_share=load_share)
