"""Generalised-alpha steps of a rotor, with everything linear condensed onto the journal.

Chung and Hulbert, J. Appl. Mech. 60 (1993) 371: second order, unconditionally stable, and with a chosen
spectral radius ``rho_inf`` at infinite frequency. The contact forces enter as those at the ends of the steps,
which is what `Contact.advance` returns: each step balances them on the journal alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError
from reduced_models.rotor.contact import Contact, ContactForces
from reduced_models.rotor.jeffcott import JeffcottRotor, RotorState

_Floats = NDArray[np.float64]

NOISE = 3.0  # change of force, over the allowed imbalance of one bearing, that a secant needs to be believed
OVERSHOOT = 2.0  # growth of the imbalance that halves the way to the last place: a contact opens or closes


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


class RotorStepper:
    """State and history of one simulation; the arguments are those of `simulate_rotor`, checked there."""

    def __init__(
        self,
        rotor: JeffcottRotor,
        contacts: Sequence[Contact],
        state: RotorState,
        *,
        dt: float,
        steps: int,
        rho_inf: float,
        tolerance: float,
        max_iterations: int,
    ):
        axes = list(rotor.axes)
        size = len(axes)
        self._rotor, self._axes, self._dt = rotor, axes, dt
        self._journal = np.arange(size, 2 * size)
        self._normals, self._offsets = rotor.normals, rotor.offsets
        self._linear = CondensedRotor(rotor.matrices(), self._journal, dt, rho_inf)
        d = np.concatenate([state.disc[axes], state.journal[axes]])
        v = np.concatenate([state.disc_velocity[axes], state.journal_velocity[axes]])
        p = rotor.applied_force(0.0)
        u, rate = self._kinematics(d[size:], v[size:])
        self._contacts = ContactForces(contacts, dt, self._linear.velocity_gain)
        force = self._contacts.start(u, rate)

        M, C, K = rotor.matrices()
        static, shaft = np.linalg.norm(rotor.static_load), np.abs(K @ d).max()
        scale = float(max(static, shaft, rotor.unbalance * rotor.omega**2, np.abs(self._net(force)).max()))
        self._allowed = tolerance * (scale if scale > 0.0 else 1.0)
        self._max_iterations = max_iterations
        self._contacts.noise = NOISE * self._allowed / self._rotor.bearings

        a = np.linalg.solve(M, p - self._net(force) - C @ v - K @ d)
        self._motion = Motion(d, v, a, p)
        self._done = -1
        self._d, self._v = np.zeros((2, steps + 1, 2 * size))
        self._u, self._rate, self._force = np.zeros((3, steps + 1, len(rotor.mounts)))
        self._iterations = np.zeros(steps + 1, dtype=np.int64)
        self._store(u, rate, force, 0)

    @property
    def time(self) -> float:
        """End of the step that is under way."""
        return (self._done + 1) * self._dt

    def advance(self) -> None:
        """Make one step, or raise and leave the history as it was."""
        net = self._net(self._force[self._done])
        pending = self._linear.begin(self._motion, net, self._rotor.applied_force(self.time))
        self._contacts.begin()
        q, u, rate, force, iterations = self._balance(pending, self._predict(pending))
        self._motion = self._linear.finish(pending, q)
        self._store(u, rate, force, iterations)

    def rewind(self) -> None:
        """Contacts back to the end of the last step that is in the history."""
        if self._torn:
            self._contacts.rewind()

    def histories(self) -> dict[str, NDArray]:
        """What `RotorResult` shows, so far."""
        end, size = self._done + 1, len(self._axes)
        both: dict[str, NDArray] = {}
        for name, values in (("", self._d), ("_velocity", self._v)):
            for body, columns in (("disc", slice(0, size)), ("journal", slice(size, None))):
                both[body + name] = np.zeros((end, 2))
                both[body + name][:, self._axes] = values[:end, columns]
        return both | {
            "t": np.arange(end, dtype=np.float64) * self._dt,
            "approach": self._u[:end].copy(),
            "rate": self._rate[:end].copy(),
            "force": self._force[:end].copy(),
            "iterations": self._iterations[:end].copy(),
        }

    def _predict(self, pending: Pending) -> _Floats:
        """Journal position from extrapolated approaches and forces, tied together by the slopes.

        Extrapolating the force alone fails where the contact is stiffer than the inertia in a step, the
        approach alone where it is softer; the linear model through both is good in either case.
        """
        u, rate, force = (self._extrapolated(history) for history in (self._u, self._rate, self._force))
        slopes = self._contacts.slopes(u, rate)
        at_origin = self._normals.T @ (force + slopes * (self._offsets - u))
        right = self._linear.D @ pending.q_free - self._linear.weight * self._rotor.bearings * at_origin
        return np.asarray(np.linalg.solve(self._slope_matrix(slopes), right), dtype=np.float64)

    def _balance(self, pending: Pending, q: _Floats) -> tuple[_Floats, _Floats, _Floats, _Floats, int]:
        """Newton or secant iteration for ``D (q - q_free) + weight sum F n = 0`` [N]."""
        linear = self._linear
        v_history = pending.v_history[self._journal]
        error, previous, last = math.inf, math.inf, q
        for iteration in range(1, self._max_iterations + 1):
            u, rate = self._kinematics(q, linear.velocity_gain * q + v_history)
            self._torn = True
            force = self._contacts.at(u, rate)
            residual = linear.D @ (q - pending.q_free) + linear.weight * self._net(force)[self._journal]
            error = float(np.linalg.norm(residual))
            if error <= self._allowed:
                self._contacts.accept(u, rate)
                return q, u, rate, force, iteration
            if not math.isfinite(error):
                break
            if error > OVERSHOOT * previous:
                q = 0.5 * (q + last)  # a kink lies between
                continue
            previous, last = error, q
            q = q - np.linalg.solve(self._slope_matrix(self._contacts.last_slopes), residual)
        raise ConvergenceError(
            f"force imbalance {error:.3g} N above {self._allowed:.3g} N in {iteration} iterations", None
        )

    def _slope_matrix(self, slopes: _Floats) -> _Floats:
        stiffness = self._rotor.bearings * (self._normals.T * slopes) @ self._normals
        return self._linear.D + self._linear.weight * stiffness

    def _kinematics(self, q: _Floats, velocity: _Floats) -> tuple[_Floats, _Floats]:
        return self._normals @ q + self._offsets, self._normals @ velocity

    def _net(self, force: _Floats) -> _Floats:
        net = np.zeros(2 * len(self._axes))
        net[self._journal] = self._rotor.bearings * self._normals.T @ force
        return net

    def _extrapolated(self, history: _Floats) -> _Floats:
        n = self._done
        if n >= 3:
            return 4.0 * (history[n] + history[n - 2]) - 6.0 * history[n - 1] - history[n - 3]
        if n == 2:
            return 3.0 * (history[n] - history[n - 1]) + history[n - 2]
        return 2.0 * history[n] - history[n - 1] if n == 1 else history[0]

    def _store(self, u: _Floats, rate: _Floats, force: _Floats, iterations: int) -> None:
        n = self._done + 1
        self._d[n], self._v[n] = self._motion.d, self._motion.v
        self._u[n], self._rate[n], self._force[n], self._iterations[n] = u, rate, force, iterations
        # Last, for Ctrl-C may come between any two lines.
        self._done, self._torn = n, False
