"""Free decay of a rotor after an initial velocity in the shape of one mode, and its logarithmic decrement."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi
from typing import Any

import numpy as np

from reduced_models.rotor.decay import Decrement, log_decrement
from reduced_models.rotor.jeffcott import JeffcottRotor, RotorState
from reduced_models.rotor.modes import RotorMode
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.simulate import simulate_rotor

LEFT_OUT = 1.0  # periods at the beginning of a decay that are not fitted: what is excited beside the mode


def initial_velocity(
    rotor: JeffcottRotor, rest: RotorState, mode: RotorMode, *, stiffness: float, load: float, load_share: float
) -> RotorState:
    """The state in static equilibrium with the velocities of a mode.

    Parameters
    ----------
    rotor : JeffcottRotor
    rest : RotorState
    mode : RotorMode
    stiffness : float
        Of one contact at the frequency of the mode [N/m].
    load : float
        Of a contact in static equilibrium [N].
    load_share : float
        Amplitude of the load of a contact without damping, over `load`.
    """
    along = np.abs(rotor.normals @ mode.journal.real[list(rotor.axes)]).max()
    speed = mode.omega * load_share * load / (stiffness * float(along))
    return RotorState(rest.disc, rest.journal, speed * mode.disc.real, speed * mode.journal.real)


def simulate_decay(
    rotor: JeffcottRotor,
    contacts: Sequence[Any],
    start: RotorState,
    mode: RotorMode,
    *,
    periods: float,
    steps_per_period: int,
    tolerance: float,
    callback: Callable[[int, int], None] | None = None,
) -> RotorResult:
    """Free motion over periods of a mode; arguments and errors as of `simulate_rotor`."""
    period = 2.0 * pi / mode.omega
    dt, until = period / steps_per_period, periods * 2.0 * pi / mode.omega
    return simulate_rotor(rotor, contacts, dt=dt, until=until, start=start, tolerance=tolerance, callback=callback)


def decay_decrement(run: RotorResult, mode: RotorMode) -> Decrement:
    """Decrement of the height of the journal, fitted after the first period of the mode."""
    # slightly before the end of a period, on which a sample lies: rounding must not decide whether it counts
    fitted = run.t >= LEFT_OUT * 2.0 * pi / mode.omega * (1.0 - 1e-9)
    return log_decrement(run.t[fitted], run.journal[fitted, 1], omega=mode.omega)
