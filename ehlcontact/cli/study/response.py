"""The film's impedance in a study, from below the rotor's frequency up, and linear rotors that follow from it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ehlcontact.cli.study.schema import Study
from ehlcontact.errors import ConvergenceError
from ehlcontact.impedance import impedance
from ehlcontact.results import ImpedanceResult
from ehlcontact.solver.grid import Grid
from reduced_models import (
    ContactElement,
    JeffcottRotor,
    LinearRotor,
    RotorMode,
    film_impedance,
    impedance_about,
    linearise,
)
from reduced_models.fitting.memory import OMEGAS
from reduced_models.rotor.impedance import Impedance

BELOW = 0.5  # of the rotor's frequency: the lowest one solved, but for rest


def film_response(study: Study) -> ImpedanceResult:
    """Impedance on the mesh of the transient films, from below the rotor's frequency to far above the contact's.

    It is the same every time: a stage that needs it solves it again, in the time of a few steps of its run.
    """
    return impedance(
        study.point, Omega=frequencies(study), grid=Grid(n=study.solver.n_transient, domain=study.domain)
    )


def frequencies(study: Study) -> list[float]:
    """Dimensionless angular frequencies of `film_response`: below those of a film memory as close as they are."""
    own, lowest = study.rotor_omega, OMEGAS[1]
    start = BELOW * own
    decades = np.log10(lowest / start) if start < lowest else 0.0
    below = np.geomspace(start, lowest, 1 + int(np.ceil(7.0 * decades)))[:-1].tolist() if decades else []
    return sorted({*OMEGAS, *below, own})


def at_rotor_speed(study: Study, response: ImpedanceResult) -> complex:
    """Impedance of one contact at the rotor's frequency [N/m]."""
    return complex(film_impedance(response)(np.array([study.rotor_hz * 2.0 * np.pi]))[0])


def linear_rotor(rotor: JeffcottRotor, impedance_of_one: Impedance) -> LinearRotor:
    """The rotor with this impedance in every contact."""
    return linearise(rotor, contacts=[impedance_of_one] * len(rotor.mounts))


def linear_rotors(
    study: Study, rotor: JeffcottRotor, response: ImpedanceResult, elements: Mapping[str, ContactElement]
) -> dict[str, LinearRotor]:
    """The rotor on the film, and on every element, linearised about rest."""
    impedances = {"full": film_impedance(response)}
    impedances |= {name: impedance_about(element, study.ball_load) for name, element in elements.items()}
    return {name: linear_rotor(rotor, one) for name, one in impedances.items()}


def bounce(linear: LinearRotor) -> RotorMode:
    """The slowest vibration up and down: the one that is kicked.

    Raises
    ------
    ConvergenceError
        None oscillates.
    """
    found = linear.slowest().get("y")
    if found is None:
        raise ConvergenceError("no vertical mode of this rotor oscillates: it is damped too much", None)
    return found
