"""One step of the generalised-alpha method with everything linear condensed onto the journal.

Chung and Hulbert, J. Appl. Mech. 60 (1993) 371: second order, unconditionally stable, and with a chosen
spectral radius ``rho_inf`` at infinite frequency. The contact forces enter as those at the ends of the steps,
which is what `Contact.advance` returns.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]


class Motion(NamedTuple):
    """Displacement, velocity, acceleration and applied force of all degrees of freedom at one time."""

    d: _Floats
    v: _Floats
    a: _Floats
    p: _Floats


class Pending(NamedTuple):
    """A step that waits for the contact forces at its end.

    The end of the step has journal position q and net contact force F on it with
    ``D (q - q_free) + weight F = 0``, and journal velocity ``velocity_gain q + v_history``.
    """

    d_free: _Floats
    v_history: _Floats
    a_history: _Floats
    p: _Floats
    q_free: _Floats


class CondensedRotor:
    """The linear part of a rotor for steps of one length `dt` [s].

    Parameters
    ----------
    matrices : tuple of ndarray, shape (N, N)
        Mass, damping and stiffness.
    journal : ndarray of int
        Degrees of freedom that the contacts act on.
    rho_inf : float
        0 annihilates what dt does not resolve, 1 keeps its amplitude (average acceleration).
    """

    def __init__(
        self, matrices: tuple[_Floats, _Floats, _Floats], journal: NDArray[np.intp], dt: float, rho_inf: float
    ):
        self.M, self.C, self.K = matrices
        self.journal = journal
        self._dt = dt
        self._alpha_m = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0)
        self._alpha_f = rho_inf / (rho_inf + 1.0)
        self._gamma = 0.5 - self._alpha_m + self._alpha_f
        self._beta = 0.25 * (1.0 - self._alpha_m + self._alpha_f) ** 2
        self.weight = 1.0 - self._alpha_f
        self.velocity_gain = self._gamma / (self._beta * dt)
        self._acceleration_gain = 1.0 / (self._beta * dt * dt)
        self._S_inverse = np.linalg.inv(
            (1.0 - self._alpha_m) * self._acceleration_gain * self.M
            + self.weight * (self.velocity_gain * self.C + self.K)
        )
        self._column = self._S_inverse[:, journal]
        self.D = np.linalg.inv(self._column[journal])

    def begin(self, start: Motion, contact_force: _Floats, p: _Floats) -> Pending:
        """Everything of the step that does not depend on the contact forces at its end.

        Parameters
        ----------
        start : Motion
            At the start of the step.
        contact_force : ndarray, shape (N,)
            Net force that the contacts take from the rotor at the start of the step.
        p : ndarray, shape (N,)
            Applied force at the end of the step.
        """
        h, d, v, a = self._dt, start.d, start.v, start.a
        ratio = self._gamma / self._beta
        v_history = -self.velocity_gain * d + (1.0 - ratio) * v + h * (1.0 - 0.5 * ratio) * a
        a_history = -self._acceleration_gain * (d + h * v) - (0.5 / self._beta - 1.0) * a
        right = (
            self.weight * (p - self.C @ v_history)
            + self._alpha_f * (start.p - contact_force - self.C @ v - self.K @ d)
            - self.M @ (self._alpha_m * a + (1.0 - self._alpha_m) * a_history)
        )
        d_free = self._S_inverse @ right
        return Pending(d_free, v_history, a_history, p, d_free[self.journal])

    def finish(self, pending: Pending, q: _Floats) -> Motion:
        """End of the step whose journal is at `q`."""
        d = pending.d_free + self._column @ (self.D @ (q - pending.q_free))
        return Motion(
            d,
            self.velocity_gain * d + pending.v_history,
            self._acceleration_gain * d + pending.a_history,
            pending.p,
        )
