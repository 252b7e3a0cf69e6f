"""Contacts of a rotor about static equilibrium: elements as state spaces; solved films and others as impedances.

Contacts stay as their speed makes them: only the frequency of the excitation varies, not the speed that draws the
oil in.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import parts
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint
from ehlcontact.results import Response
from reduced_models.elements.base import ContactElement
from reduced_models.elements.film_response import StateSpace

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]
Impedance = Callable[[_Floats], _Complex]  # omega [rad/s], shape (k,) -> Z [N/m], shape (k,)

TINY_OMEGA = 1e-6  # rad/s, stands for 0: where damping is the slope of Z


@takes(element=Object(ContactElement, "a contact element"), load=parts.LOAD)
def impedance_about(element: ContactElement, load: float) -> Impedance:
    """Impedance of an SI element about static equilibrium under `load` [N], as a function of omega [rad/s]."""
    return lambda omega: element.impedance(omega=omega, load=load).value


@takes(response=Object(Response, "a Response"))
def film_impedance(response: Response) -> Impedance:
    """Impedance of a solved film over omega [rad/s], between its frequencies by monotone cubics.

    Below the lowest frequency and beyond the highest, stiffness and damping stay what they are there.

    Raises
    ------
    InputError
        A dimensionless point, or fewer than 2 frequencies.
    """
    if not isinstance(response.point, OperatingPoint):
        raise InputError("response.point", response.point, "an OperatingPoint, for a rotor in SI")
    scales, own = response.point.scales, response.dimensionless
    order = np.argsort(own.omega)
    if order.size < 2:
        raise InputError("response.omega", response.omega.tolist(), "at least 2 frequencies")
    known = own.omega[order]
    parts = [scipy.interpolate.PchipInterpolator(known, values[order]) for values in (own.stiffness, own.damping)]

    def impedance(omega: _Floats) -> _Complex:
        w = np.asarray(omega, dtype=np.float64)
        scaled = np.clip(w * scales.time, known[0], known[-1])
        K, C = (part(scaled) for part in parts)
        return np.asarray(K * scales.stiffness + 1j * w * C * scales.damping, dtype=np.complex128)

    return impedance


class ContactImpedance:
    """Contacts at one place of a rotor, known by Z on the imaginary axis alone.

    Parameters
    ----------
    impedance : callable
        Of one contact, over omega [rad/s] to N/m.
    count : int
        How many contacts there are.
    """

    def __init__(self, impedance: Impedance, count: int) -> None:
        self._impedance, self._count = impedance, count

    def impedance(self, s: ArrayLike) -> _Complex:
        """Impedance of all contacts [N/m] at s [1/s], shape of `s` + (1, 1): K + s C, both at its frequency."""
        s = np.asarray(s, complex)
        omega = np.maximum(s.imag, TINY_OMEGA)
        Z = np.asarray(self._impedance(omega.ravel()), complex).reshape(s.shape)
        impedance = np.where(s == 1j * omega, Z, Z.real + s * Z.imag / omega)
        return np.asarray(self._count * impedance[..., None, None])


class WithoutLoss:
    """A support about equilibrium of which the stiffness K of Z = K + s C is left, K and C real.

    Parameters
    ----------
    support : support about equilibrium
        Has ``impedance(s)``.
    """

    def __init__(self, support: Any) -> None:
        self._support = support

    def impedance(self, s: ArrayLike) -> _Complex:
        """Stiffness [N/m] at s [1/s], shape of `s` + (directions, directions), without what takes energy."""
        Z = np.asarray(self._support.impedance(s))
        turned = np.conj(np.swapaxes(Z, -1, -2))
        rate = np.asarray(s, complex)[..., None, None]
        ratio = np.divide(rate.real, rate.imag, out=np.zeros(rate.shape), where=rate.imag != 0.0)
        return np.asarray(0.5 * (Z + turned) + 0.5j * ratio * (Z - turned))


class LinearElement:
    """Elements at one place of a rotor about equilibrium, exact at every complex frequency with film memory.

    Parameters
    ----------
    space : StateSpace
        Of one element, from approach and rate to the force, SI.
    count : int
        How many there are.
    """

    def __init__(self, space: StateSpace, count: int) -> None:
        self.space = StateSpace(space.A, space.B, count * space.C, count * space.D)

    def impedance(self, s: ArrayLike) -> _Complex:
        """Impedance of all elements [N/m] at s [1/s], shape of `s` + (1, 1)."""
        A, driven, C, D = self.space
        rate = np.asarray(s, complex)[..., None, None]
        moved = np.concatenate([np.ones_like(rate), rate], axis=-2)
        return np.asarray(C @ np.linalg.solve(rate * np.eye(len(A)) - A, driven @ moved) + D @ moved)
