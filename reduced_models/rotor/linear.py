"""A rotor linearised about rest: its modes and its response to unbalance, each contact an impedance Z(omega).

Z is taken on the real axis. A mode sees that of its own frequency, which is found by iteration: exact where it is
hardly damped, and to first order in the damping otherwise. The contacts stay as their speed makes them: what
varies in a frequency response is the frequency of the excitation alone, not the speed that draws the oil in.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import pi
from typing import Unpack

import numpy as np
from numpy.typing import NDArray
from scipy import linalg
from scipy.interpolate import PchipInterpolator

from ehlcontact import ImpedanceResult
from ehlcontact.checks.frequency import Frequency, by_name, radians_per_second
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.summary import Summary
from reduced_models.elements.base import ContactElement
from reduced_models.rotor.jeffcott import JeffcottRotor, RotorState

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]
Impedance = Callable[[_Floats], _Complex]  # omega [rad/s], shape (k,) -> Z [N/m], shape (k,)

SAME_FREQUENCY = 1e-10  # relative change that ends the iteration for a mode; few rounds where Z changes slowly
MOST_ROUNDS = 100  # of it


def impedance_about(element: ContactElement, load: float) -> Impedance:
    """Impedance of an SI element about rest under `load` [N], as a function of omega [rad/s]."""
    return lambda omega: element.impedance(omega=omega, load=load)


def film_impedance(response: ImpedanceResult) -> Impedance:
    """Impedance of a solved film over omega [rad/s], between its frequencies by monotone cubics.

    Below the lowest frequency and beyond the highest, stiffness and damping stay what they are there.

    Raises
    ------
    InputError
        A dimensionless point, or fewer than 2 frequencies.
    """
    scales = response.scales
    if scales is None:
        raise InputError("response.scales", None, "of an OperatingPoint, for a rotor in SI")
    order = np.argsort(response.Omega)
    if order.size < 2:
        raise InputError("response.Omega", response.Omega.tolist(), "at least 2 frequencies")
    known = response.Omega[order]
    parts = [PchipInterpolator(known, values[order]) for values in (response.stiffness, response.damping)]

    def impedance(omega: _Floats) -> _Complex:
        w = np.asarray(omega, dtype=np.float64)
        at = np.clip(w * scales.time, known[0], known[-1])
        K, C = (part(at) for part in parts)
        return np.asarray(K * scales.stiffness + 1j * w * C * scales.damping, dtype=np.complex128)

    return impedance


@dataclass(frozen=True, eq=False)
class RotorMode(Summary):
    """One damped vibration of the rotor on its contacts.

    Attributes
    ----------
    eigenvalue : complex
        s of exp(s t) [1/s].
    disc, journal : ndarray, shape (2,)
        Complex shape, the largest displacement 1.
    contact_share : float
        Of the strain energy, in the contacts; the rest bends the shaft.
    """

    eigenvalue: complex
    disc: _Complex
    journal: _Complex
    contact_share: float

    def _summary_lines(self) -> list[str]:
        return [
            f"{self.hz:.5g} Hz, logarithmic decrement {self.decrement:.4g}",
            f"{100.0 * self.contact_share:.3g} % of the strain energy in the contacts",
        ]

    @property
    def omega(self) -> float:
        """Damped angular frequency [rad/s]."""
        return self.eigenvalue.imag

    @property
    def hz(self) -> float:
        """Damped frequency [Hz]."""
        return self.omega / (2.0 * pi)

    @property
    def decrement(self) -> float:
        """Logarithmic decrement, by which ln(amplitude) falls in a period."""
        return -2.0 * pi * self.eigenvalue.real / self.omega

    @property
    def vertical_share(self) -> float:
        """Share of the squared displacements that is up and down."""
        squares = np.abs(np.stack([self.disc, self.journal])) ** 2
        return float(squares[:, 1].sum() / squares.sum())


@dataclass(frozen=True, eq=False)
class LinearRotor(Summary):
    """A rotor and the impedance of each of its contacts about rest [N/m] over omega [rad/s].

    Parameters
    ----------
    rotor : JeffcottRotor
    impedances : sequence of callable
        Of each mount, over omega [rad/s] to N/m: `film_impedance` and `impedance_about` make them.

    Raises
    ------
    InputError
        Not one impedance per mount.
    """

    rotor: JeffcottRotor
    impedances: Sequence[Impedance]
    _normals: _Floats = field(init=False, repr=False)

    def _summary_lines(self) -> list[str]:
        return [f"about rest, {len(self.impedances)} contacts in each bearing", *self.rotor._summary_lines()]

    def __post_init__(self) -> None:
        if len(self.impedances) != len(self.rotor.mounts):
            raise InputError("impedances", len(self.impedances), f"one per mount, {len(self.rotor.mounts)}")
        size = len(self.rotor.axes)
        normals = np.hstack([np.zeros((len(self.rotor.mounts), size)), self.rotor.normals])
        object.__setattr__(self, "_normals", normals)

    def contact_stiffness(self, *, omega: float) -> _Complex:
        """Dynamic stiffness of all contacts [N/m] at `omega` [rad/s], shape (N, N), in the order of
        `JeffcottRotor.matrices`.
        """
        Z = np.array([complex(impedance(np.array([omega]))[0]) for impedance in self.impedances])
        return np.asarray(self.rotor.bearings * (self._normals.T * Z) @ self._normals)

    def modes(self) -> tuple[RotorMode, ...]:
        """All modes that oscillate, the slowest first."""
        start, _ = self._eigen(0.0)
        guesses = sorted((s for s in start if s.imag > SAME_FREQUENCY * abs(s)), key=lambda s: s.imag)
        return tuple(self._mode(guess) for guess in guesses)

    @by_name(1)
    def unbalance_response(self, **frequency: Unpack[Frequency]) -> _Complex:
        """Complex amplitudes of the displacements [m], shape (k, N), q(t) = Re(q exp(i omega t)).

        Parameters
        ----------
        **frequency
            At which the unbalance turns instead of at the rotor's speed: exactly one of omega [rad/s], hz and rpm,
            shape (k,).
        """
        M, C, K = self.rotor.matrices()
        frequencies = radians_per_second(None, **frequency)
        turning = np.zeros(len(M), dtype=np.complex128)
        size = len(self.rotor.axes)
        turning[:size] = np.array([1.0, -1j])[list(self.rotor.axes)]
        amplitudes = np.empty((frequencies.size, len(M)), dtype=np.complex128)
        for k, w in enumerate(frequencies.tolist()):
            dynamic = K + 1j * w * C - w * w * M + self.contact_stiffness(omega=w)
            amplitudes[k] = np.linalg.solve(dynamic, self.rotor.unbalance * w * w * turning)
        return amplitudes

    def orbit_state(self, rest: RotorState) -> RotorState:
        """State at t = 0 on the periodic response to the unbalance at the rotor's speed, about `rest`."""
        w = self.rotor.omega
        q = self.unbalance_response(omega=w)[0]
        moved, speed = self._planes(q.real), self._planes((1j * w * q).real)
        return RotorState(rest.disc + moved[0], rest.journal + moved[1], speed[0], speed[1])

    def _mode(self, guess: complex) -> RotorMode:
        s = guess
        for _ in range(MOST_ROUNDS):
            values, vectors = self._eigen(s.imag)
            nearest = int(np.argmin(np.abs(values - s)))
            change, s = abs(values[nearest] - s), complex(values[nearest])
            if change <= SAME_FREQUENCY * abs(s):
                return self._shaped(s, vectors[:, nearest])
        raise ConvergenceError(f"mode near {guess.imag / (2.0 * pi):.4g} Hz not found", None)

    def _shaped(self, s: complex, vector: _Complex) -> RotorMode:
        size = len(self.rotor.matrices()[0])
        shape = vector[:size] / vector[np.argmax(np.abs(vector[:size]))]
        _, _, K = self.rotor.matrices()
        in_contacts = float(np.real(shape.conj() @ self.contact_stiffness(omega=s.imag).real @ shape))
        in_shaft = float(np.real(shape.conj() @ K @ shape))
        disc, journal = self._planes(shape)
        return RotorMode(s, disc, journal, in_contacts / (in_contacts + in_shaft))

    def _eigen(self, omega: float) -> tuple[_Complex, _Complex]:
        """Eigenvalues and vectors of the state matrix with the contacts as they are at `omega`."""
        M, C, K = self.rotor.matrices()
        w = max(omega, 1e-6 * self.rotor.omega, 1e-6)
        Z = self.contact_stiffness(omega=w)
        size = len(M)
        A = np.zeros((2 * size, 2 * size))
        A[:size, size:] = np.eye(size)
        A[size:, :size] = -np.linalg.solve(M, K + Z.real)
        A[size:, size:] = -np.linalg.solve(M, C + Z.imag / w)
        values, vectors = linalg.eig(A)
        return values, vectors

    def _planes(self, q: NDArray) -> tuple[NDArray, NDArray]:
        """Disc and journal as (x, y), where a direction that does not move is 0."""
        size, axes = len(self.rotor.axes), list(self.rotor.axes)
        both = np.zeros((2, 2), dtype=q.dtype)
        both[0, axes], both[1, axes] = q[:size], q[size:]
        return both[0], both[1]
