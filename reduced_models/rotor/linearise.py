"""A rotor on ball bearings about rest at one speed: modes, responses, stability."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_instance, require_integer, require_nonnegative
from ehlcontact.checks.frequency import Frequency, by_name, radians_per_second
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError
from ehlcontact.summary import Summary
from reduced_models.bearing.equilibrium import StaticBalls
from reduced_models.bearing.impedance import SmallBalls
from reduced_models.bearing.kinematics import RADIANS
from reduced_models.rotor.modes import (
    CANDIDATES,
    Matrices,
    WhirlMode,
    close,
    eigenvectors,
    is_new,
    shaped,
    unlike,
)
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]
Signals = Mapping[str, int] | Sequence[int] | None

SHOWN = 8  # modes, unless another number is asked for
SLOW = 1e-3  # rad/s, stands for rest where damping is asked for: films forget in less than a second
FREE = 1e-9  # of the largest stiffness, what rounding leaves where a rotor is free
UNLOADED = 1e-9  # of its heaviest ball, the load of a preloaded bearing that is the rounding of none


@dataclass(frozen=True, eq=False)
class LinearisedRotor(Summary):
    """A rotor about rest under its load, `linearise` makes it.

    Films are those of the speed and remember. Balls stand still while the rotor vibrates, at the angle of their
    mount or, over a ball passage, at all positions of the cage: then the impedance of a bearing is the mean of
    those, each with the ring where the bearing's share of the load puts it. That bearings change while the rotor
    vibrates is left out: a mode across the load of the beam in the tests, where stiffness changes by a quarter as
    balls pass, has 0.7 % more decrement and 0.2 % less frequency by that; one along the load nothing.

    Attributes
    ----------
    rotor : Rotor
    speed_rpm : float
        Of the shaft.
    passage : bool
        Mean over a ball passage, or at the angles of the mounts.
    rest : ndarray, shape (N,)
        Displacements at rest, balls at the angles of the mounts [m].
    loads : ndarray, shape (bearings, 2)
        Forces on the inner rings at rest [N].
    balls : tuple
        What a small vibration finds in each bearing.
    """

    rotor: Rotor
    speed_rpm: float
    passage: bool
    rest: _Floats
    loads: _Floats
    balls: tuple[SmallBalls, ...]

    @cached_property
    def matrices(self) -> Matrices:
        """Mass, damping with the gyroscopic part, and stiffness, without the bearings."""
        rotor = self.rotor
        return rotor.mass, rotor.damping + self.speed_rpm * RADIANS * rotor.gyroscopic, rotor.stiffness

    def bearing_impedance(self, s: complex) -> _Complex:
        """What the bearings add to the dynamic stiffness, shape (N, N) [N/m], at s [1/s] of exp(s t)."""
        rings = self._rings
        Z = np.zeros((len(rings), len(rings)), complex)
        for b, balls in enumerate(self.balls):
            at = slice(2 * b, 2 * b + 2)
            Z[at, at] = balls.impedance(s)
        return np.asarray(rings.T @ Z @ rings)

    def dynamic_stiffness(self, s: complex) -> _Complex:
        """Forces over displacements, shape (N, N), at s [1/s] of exp(s t)."""
        M, C, K = self.matrices
        return np.asarray(s * s * M + s * C + K + self.bearing_impedance(s))

    def modes(self, count: int | None = SHOWN) -> tuple[WhirlMode, ...]:
        """Modes that oscillate, the slowest first; None: all.

        Raises
        ------
        ConvergenceError
            A mode that was there with bearings of one stiffness and damping was not found with their memory.
        """
        if count is not None:
            require_integer("count", count, "a whole number >= 1", 1)
        undamped = self.bearing_impedance(SLOW)  # at a real s, real
        values, vectors = eigenvectors(self.matrices, undamped, SLOW)
        found: list[tuple[complex, _Complex]] = []
        for s, q in zip(values[:count], vectors.T[:count], strict=True):
            found += self._root(complex(s), q, found)
        pairs = [(m.x, m.y) for m in self.rotor.mounts] + [(u.x, u.y) for u in self.rotor.unbalances]
        modes = [shaped(s, q, pairs) for s, q in found if s.imag > 0.0]
        return tuple(sorted(modes, key=lambda mode: mode.omega))

    @property
    def growth(self) -> float:
        """Largest real part [1/s] of all modes that oscillate; below 0 they all die away."""
        return max((mode.eigenvalue.real for mode in self.modes(None)), default=-np.inf)

    @property
    def stable(self) -> bool:
        """Whether all vibrations die away, and no direction has a negative static stiffness."""
        _, _, K = self.matrices
        static = K + self.bearing_impedance(SLOW).real
        slopes = np.linalg.eigvalsh(0.5 * (static + static.T))
        return self.growth < 0.0 and bool(slopes[0] > -FREE * slopes[-1])

    @by_name(1)
    def receptance(self, **frequency: Unpack[Frequency]) -> _Complex:
        """Displacements over forces, shape (k, N, N) [m/N].

        Parameters
        ----------
        **frequency
            Exactly one of omega [rad/s], hz and rpm, shape (k,).
        """
        w = radians_per_second(None, **frequency)
        return np.array([np.linalg.inv(self.dynamic_stiffness(1j * one)) for one in w.tolist()])

    @by_name(1)
    def unbalance_response(self, **frequency: Unpack[Frequency]) -> _Complex:
        """Complex amplitudes [m], shape (k, N), of q(t) = Re(q exp(i w t)); the angle of the shaft is w t.

        Parameters
        ----------
        **frequency
            At which the unbalances turn, films, cage and gyroscopic forces being those of `speed_rpm` all the
            same: exactly one of omega [rad/s], hz and rpm, shape (k,).
        """
        w = radians_per_second(None, **frequency)
        out = np.zeros((w.size, self.rotor.size), complex)
        for k, one in enumerate(w.tolist()):
            out[k] = np.linalg.solve(self.dynamic_stiffness(1j * one), one * one * self._turning)
        return out

    def to_control(self, inputs: Signals = None, outputs: Signals = None, name: str = "rotor") -> Any:
        """Exact python-control ``StateSpace``, films' memory included, from forces [N] to displacements [m].

        Its states are those of `rotor_to_control`, and their units. With means over a ball passage all positions
        of all balls are states: better linearise with ``passage=False`` here.

        Parameters
        ----------
        inputs, outputs : mapping of str to int, or sequence of int, optional
            Degrees of freedom by name; without names they are F0, F1, ... and q0, q1, ... By default all.
        name : str
            Of the system.

        Raises
        ------
        InputError
            A degree of freedom that is not there.
        """
        from reduced_models.rotor.control import linear_block

        return linear_block(self, inputs, outputs, name)

    @cached_property
    def _rings(self) -> _Floats:
        return self.rotor.rings

    @cached_property
    def _turning(self) -> _Complex:
        force = np.zeros(self.rotor.size, complex)
        for unbalance in self.rotor.unbalances:
            force[[unbalance.x, unbalance.y]] += (
                unbalance.amount * np.exp(1j * unbalance.phase) * np.array([1.0, -1j])
            )
        return force

    def _root(
        self, s: complex, q: _Complex, found: list[tuple[complex, _Complex]]
    ) -> list[tuple[complex, _Complex]]:
        """The root near a mode without damping, none of those found; nothing where damping leaves fewer modes."""
        values, vectors = eigenvectors(self.matrices, self.bearing_impedance(1j * s.imag), s.imag)
        for k in np.argsort(unlike(s, q, values, vectors))[:CANDIDATES].tolist():
            root, shape = close(self.dynamic_stiffness, complex(values[k]), vectors[:, k])
            if is_new(root, shape, found):
                return [(root, shape)]
        if len(values) < self.rotor.size:
            return []
        raise ConvergenceError(f"mode near {s.imag / (2.0 * np.pi):.4g} Hz not found", None)


@takes(speed_rpm="rev/min")
def linearise(rotor: Rotor, speed_rpm: float, *, passage: bool = True) -> LinearisedRotor:
    """Linearise a rotor on ball bearings about rest under its load.

    Parameters
    ----------
    rotor : Rotor
    speed_rpm : float
        Of the shaft, for films, centrifugal and gyroscopic forces.
    passage : bool
        Bearings as means over a ball passage (as in `BallBearing.coefficients`, the load of a bearing being that
        with the balls as mounted); or with the balls as mounted.

    Raises
    ------
    InputError
        A speed or a load that a bearing does not take.
    ConvergenceError
        The bearings do not hold the rotor.
    """
    require_instance("rotor", rotor, Rotor, "a Rotor")
    speed = require_nonnegative("speed_rpm", speed_rpm)
    rest = rotor.equilibrium(speed)
    rings, loads, balls = rotor.rings @ rest, [], []
    for b, mount in enumerate(rotor.mounts):
        bearing, ring = mount.bearing, rings[2 * b : 2 * b + 2]
        kernel, at_speed = bearing.kernel(bearing.speed(speed)), bearing.speed_state(speed)
        held = StaticBalls(kernel, at_speed, mount.cage_angle)
        force = held.force(ring)
        if np.linalg.norm(force) < UNLOADED * held.films.force.max():
            force = np.zeros(2)
        found = bearing.standings(force, speed, None if passage else mount.cage_angle)
        loads.append(force)
        balls.append(SmallBalls.of(kernel, at_speed, found))
    return LinearisedRotor(rotor, speed, passage, rest, np.array(loads), tuple(balls))
