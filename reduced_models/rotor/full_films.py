"""A rotor with the whole film solved in every contact, started near its settled motion."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from math import ceil

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Grid, OperatingPoint, TransientContact
from ehlcontact.errors import ConvergenceError
from ehlcontact.status import Status
from reduced_models.elements.base import ContactElement
from reduced_models.elements.validity import OutsideValidityWarning
from reduced_models.rotor.linearise import linearise
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.settling import require_turning, run_until_settled
from reduced_models.rotor.simulate import simulate_rotor

_Floats = NDArray[np.float64]

# Of the force balance on full films: at a third of it they take 2 to 3 solves per step in place of 2, and at ten
# times as much the journal's velocity under a light unbalance shows it.
FILM_TOLERANCE = 1e-6
ELEMENT_TOLERANCE = 1e-9  # of the force balance on elements, which cost nothing
# Before a run the film is led along the motion it starts on: so long, in its unit of time, of which it takes 2 to
# cross the contact; and so many steps at least.
LEAD_IN = (8.0, 3)


def on_films(rotor: Rotor, point: OperatingPoint, grid: Grid) -> Rotor:
    """The rotor on films at rest under the load of the operating point."""
    return rotor.on([TransientContact(point, grid=grid) for _ in rotor.contacts])


def rest_on_films(rotor: Rotor) -> _Floats:
    """Displacements at rest on films that are at rest, shape (N,)."""
    return rotor.rest_at([mount.contact.static_approach for mount in rotor.contacts])


def settled_run(rotor: Rotor, element: ContactElement, *, steps: int, revolutions: int) -> RotorResult:
    """Settled revolutions with copies of an element in the contacts, from the orbit of the linearised rotor on."""
    rotor = rotor.on([element.copy() for _ in rotor.contacts])
    start = linearise(rotor).orbit()
    with warnings.catch_warnings():  # `contact_events` collects them, of the revolutions that are returned
        warnings.simplefilter("ignore", OutsideValidityWarning)
        return run_until_settled(
            rotor, steps=steps, revolutions=revolutions, start=start, tolerance=ELEMENT_TOLERANCE
        )


def simulate_on_films(
    rotor: Rotor,
    point: OperatingPoint,
    grid: Grid,
    element: ContactElement,
    *,
    steps: int,
    revolutions: float,
    callback: Callable[[int, int], None] | None = None,
) -> RotorResult:
    """Turn a rotor on full films, from near its settled motion on.

    Parameters
    ----------
    rotor : Rotor
        Turning.
    point : OperatingPoint
        Of every contact.
    grid : Grid
        Of every film.
    element : ContactElement
        Of the film at the speed of the rotor, in SI: the run starts on the settled motion of the rotor on it.
        Where that does not converge, or no film follows it, the run starts at rest.
    steps : int
        In a revolution.
    revolutions : float
    callback : callable, optional
        As of `simulate_rotor`.

    Raises
    ------
    KeyboardInterrupt
        Interrupted before the run itself.
    ConvergenceError
        As `simulate_rotor`.
    """
    turn = 60.0 / require_turning(rotor)
    whole = on_films(rotor, point, grid)
    start = rest_on_films(whole), np.zeros(rotor.size)
    try:
        orbit = settled_run(rotor, element, steps=steps, revolutions=1)
        _lead([mount.contact for mount in whole.contacts], orbit, point.scales.time)
        start = orbit.displacement[-1], orbit.velocity[-1]
    except ConvergenceError as error:  # a motion so wild that no element, or no film, follows it: then from rest
        if getattr(error.result, "status", None) is Status.INTERRUPTED:
            raise KeyboardInterrupt from None
        whole = on_films(rotor, point, grid)
    return simulate_rotor(
        whole,
        dt=turn / steps,
        until=revolutions * turn,
        start=start,
        tolerance=FILM_TOLERANCE,
        callback=callback,
    )


def _lead(contacts: Sequence[TransientContact], orbit: RotorResult, film_time: float) -> None:
    """Move every film along the end of an orbit, so that it has the past that belongs to where it starts.

    From where the orbit passes its place of rest, so that no film has to jump.
    """
    dt = float(orbit.t[1] - orbit.t[0])
    steps = max(LEAD_IN[1], ceil(LEAD_IN[0] * film_time / dt))
    for i, contact in enumerate(contacts):
        away = np.abs(orbit.approach[:, i] - contact.static_approach)
        first = int(np.argmin(away[: max(1, away.size - steps)]))
        for u, v in zip(orbit.approach[first:, i], orbit.rate[first:, i], strict=True):
            contact.advance(dt, float(u), float(v))
