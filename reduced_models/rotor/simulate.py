"""Transient motion of a Jeffcott rotor on contacts, full or reduced, by implicit steps."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Status
from ehlcontact.checks import require_integer, require_positive
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.store import stored
from ehlcontact.summary import Summary, span
from reduced_models.elements.validity import frequency_of
from reduced_models.rotor.contact import Contact
from reduced_models.rotor.jeffcott import JeffcottRotor, RotorState
from reduced_models.rotor.step import RotorStepper

_Floats = NDArray[np.float64]
RotorStatus = Status  # its public name; a run ends as converged, interrupted or failed


@stored("run of a rotor")
@dataclass(frozen=True, eq=False)
class RotorResult(Summary, Tabled):
    """Histories of a rotor run in SI; entry 0 is the start.

    Attributes
    ----------
    t : ndarray, shape (N,)
        Times [s].
    disc, journal : ndarray, shape (N, 2)
        Positions [m].
    disc_velocity, journal_velocity : ndarray, shape (N, 2)
        Velocities [m/s].
    approach, rate : ndarray, shape (N, contacts)
        Of every contact [m], [m/s].
    force : ndarray, shape (N, contacts)
        On one contact of one bearing [N].
    iterations : ndarray, shape (N,)
        Evaluations of every contact in the step.
    status : Status
    rotor : JeffcottRotor
    """

    t: _Floats
    disc: _Floats
    disc_velocity: _Floats
    journal: _Floats
    journal_velocity: _Floats
    approach: _Floats
    rate: _Floats
    force: _Floats
    iterations: NDArray[np.int64]
    status: Status
    rotor: JeffcottRotor

    LAYOUT: ClassVar[Layout] = Layout(
        rows="t",
        panels=("disc", "journal", "approach", "force"),
        quantities={
            "t": ("s", "t"),
            **dict.fromkeys(("disc", "journal"), ("m", "t axis")),
            **dict.fromkeys(("disc_velocity", "journal_velocity"), ("m/s", "t axis")),
            "approach": ("m", "t contact"),
            "rate": ("m/s", "t contact"),
            "force": ("N", "t contact"),
            "iterations": ("", "t"),
        },
        labels={"axis": ("x", "y")},
    )

    def _summary_lines(self) -> list[str]:
        swing = 1e6 * np.ptp(self.disc, axis=0)
        return [
            f"{self.status} after {len(self.t) - 1} steps to {self.t[-1]:.4g} s, {self.force.shape[1]} contacts",
            f"disc moves over {swing[0]:.4g} x {swing[1]:.4g} µm",
            f"contact forces {span(self.force, 1.0, 'N')}",
        ]

    def __post_init__(self) -> None:
        for values in vars(self).values():
            if isinstance(values, np.ndarray):
                values.setflags(write=False)


@takes(dt="s", until="s")
def simulate_rotor(
    rotor: JeffcottRotor,
    contacts: Sequence[Contact],
    *,
    dt: float,
    until: float,
    start: str | RotorState = "static",
    tolerance: float = 1e-6,
    max_iterations: int = 30,
    rho_inf: float = 0.8,
    callback: Callable[[int, int], object] | None = None,
) -> RotorResult:
    """Integrate the rotor from t = 0 to `until` in steps of `dt`.

    Generalised-alpha steps (second order); disc, shaft and journal mass are condensed exactly, so that each
    step solves only for the journal. Reduced elements, memory included, are iterated by Newton with their exact
    tangents, contacts without tangents by secants; every evaluation starts each contact from its state at the
    start of the step. Elements warn, once: before the run where the rotor's speed lies outside their band, or a
    mount knows of another contact than they were made for; after it where it left their validity box.

    Parameters
    ----------
    rotor : JeffcottRotor
    contacts : sequence of Contact
        One per mount, in SI (see `ScaledContact`); those with a memory each their own object. They are left at
        the state of the end.
    dt, until : float
        Step and end [s]; the last step may pass `until` by less than dt.
    start : "static" or RotorState
        "static" finds the equilibrium of reduced elements and puts them at rest there. Full contacts need
        ``rotor.state_at(approaches)``. A given state leaves the contacts as they are, so that a run can go on:
        those with a memory must be at the state that belongs to it (`FilmMemoryContact.rest`).
    tolerance : float
        Largest imbalance of the forces on the journal, relative to the static load (or to the unbalance or
        the forces of the start, if one of them is larger). Not below the noise of a full contact's solver.
    max_iterations : int
        Evaluations of the contacts allowed in one step.
    rho_inf : float
        0 to 1: share of amplitude that frequencies far above 1/dt keep per step.
    callback : callable, optional
        Called as ``callback(step, steps)`` after every step.

    Returns
    -------
    RotorResult
        With status "interrupted" and what was computed, after Ctrl-C.

    Raises
    ------
    InputError
        Wrong number of contacts, one with a memory in two mounts, or a value outside its range.
    ConvergenceError
        A step, or a contact in it, did not converge; ``result`` holds the steps before it.
    """
    dt, until = require_positive("dt", dt), require_positive("until", until)
    tolerance = require_positive("tolerance", tolerance)
    if not 0.0 <= rho_inf <= 1.0:
        raise InputError("rho_inf", rho_inf, "between 0 and 1")
    max_iterations = require_integer("max_iterations", max_iterations, "a whole number >= 1", 1)
    _check_contacts(rotor, contacts)
    rotor.check(contacts, stacklevel=3)
    state = _start_state(rotor, contacts, start)
    steps = max(1, math.ceil(until / dt - 1e-9))  # but for rounding of the quotient
    run = RotorStepper(
        rotor,
        contacts,
        state,
        dt=dt,
        steps=steps,
        rho_inf=rho_inf,
        tolerance=tolerance,
        max_iterations=max_iterations,
    )
    status = Status.CONVERGED
    try:
        for step in range(1, steps + 1):
            run.advance()
            if callback is not None:
                callback(step, steps)
    except KeyboardInterrupt:
        run.rewind()
        status = Status.INTERRUPTED
    except ConvergenceError as error:
        run.rewind()
        partial = RotorResult(**run.histories(), status=Status.FAILED, rotor=rotor)
        raise ConvergenceError(f"rotor at t = {run.time:.6g} s: {error}", partial) from error
    result = RotorResult(**run.histories(), status=status, rotor=rotor)
    _warn_outside(contacts, result)
    return result


def _check_contacts(rotor: JeffcottRotor, contacts: Sequence[Contact]) -> None:
    if len(contacts) != len(rotor.mounts):
        raise InputError("contacts", len(contacts), f"one per mount, {len(rotor.mounts)}")
    for i, contact in enumerate(contacts):
        if not isinstance(contact, Contact):
            raise InputError(
                f"contacts[{i}]", type(contact).__name__, "a Contact (advance, save and restore state)"
            )
        if getattr(contact, "units", "SI") != "SI":
            raise InputError(f"contacts[{i}].units", contact.units, "SI; see to_si and ScaledContact")  # type: ignore[attr-defined]
        if any(contact is other for other in contacts[:i]) and contact.save_state() is not None:
            raise InputError(f"contacts[{i}]", "used twice", "its own object: it has a memory (take a copy)")


def _start_state(rotor: JeffcottRotor, contacts: Sequence[Contact], start: str | RotorState) -> RotorState:
    if isinstance(start, RotorState):
        return start
    if start != "static":
        raise InputError("start", start, "'static' or a RotorState")
    state = rotor.static_equilibrium(contacts)
    for contact, approach in zip(contacts, rotor.approaches(state.journal).tolist(), strict=True):
        contact.rest(approach)  # type: ignore[attr-defined]
    return state


def _warn_outside(contacts: Sequence[Contact], result: RotorResult) -> None:
    """Let the elements warn where the run left their validity box."""
    for i, contact in enumerate(contacts):
        warn = getattr(contact, "warn_outside", None)
        if warn is not None:
            u, v, f = result.approach[:, i], result.rate[:, i], result.force[:, i]
            warn(u, v, force=f, omega=frequency_of(u, v), stacklevel=4)
