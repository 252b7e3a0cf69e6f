"""Free decay of a rotor after an initial velocity in the shape of one mode, and its logarithmic decrement."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np
from numpy.typing import NDArray

from reduced_models.rotor.decay import Decrement, log_decrement
from reduced_models.rotor.modes import RotorMode
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.simulate import simulate_rotor

_Floats = NDArray[np.float64]

LEFT_OUT = 1.0  # periods at the beginning of a decay that are not fitted: what is excited beside the mode


def initial_velocity(
    rotor: Rotor, mode: RotorMode, *, stiffness: float, load: float, load_share: float
) -> _Floats:
    """Velocities in the shape of a mode, shape (N,) [m/s].

    Parameters
    ----------
    rotor : Rotor
    mode : RotorMode
    stiffness : float
        Of one contact at the frequency of the mode [N/m].
    load : float
        Of a contact in static equilibrium [N].
    load_share : float
        Amplitude of the load of a contact without damping, over `load`.
    """
    shape = mode.shape.real
    along = np.abs(rotor.support_rows @ shape).max()
    return np.asarray(mode.omega * load_share * load / (stiffness * float(along)) * shape)


def simulate_decay(
    rotor: Rotor,
    start: tuple[_Floats, _Floats],
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
    return simulate_rotor(rotor, dt=dt, until=until, start=start, tolerance=tolerance, callback=callback)


def decay_decrement(run: RotorResult, mode: RotorMode) -> Decrement:
    """Decrement of the height of the journal, fitted after the first period of the mode."""
    # slightly before the end of a period, on which a sample lies: rounding must not decide whether it counts
    fitted = run.t >= LEFT_OUT * 2.0 * pi / mode.omega * (1.0 - 1e-9)
    return log_decrement(run.t[fitted], run.journal[fitted, 1], omega=mode.omega)
