"""Rotating shaft element, a Timoshenko beam of round cross section: mass, stiffness and gyroscopic matrix.

Nelson, J. Mech. Des. 102 (1980) 793, by his shape functions; degrees of freedom of a plane: displacement and
rotation of the cross section at the left end, then at the right one.
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]

POINTS = 4  # of Gauss, exact up to the 7th power; products of shape functions have the 6th
PLANE_X = (0, 3, 4, 7)  # of x, y, rotation about x, rotation about y at both ends: x, and the rotation about y
PLANE_Y = (1, 2, 5, 6)  # y, and the rotation about x, with the opposite sign
SIGN = np.array([1.0, -1.0, 1.0, -1.0])  # of the plane of y


class ShaftElement(NamedTuple):
    """Length, outer and inner diameter [m], Young's modulus [Pa], Poisson's ratio, density, whether it shears."""

    length: float
    diameter: float
    bore: float
    youngs_modulus: float
    poisson_ratio: float
    density: float
    shear: bool

    @property
    def mass(self) -> float:
        """In kg."""
        return self.density * 0.25 * pi * (self.diameter**2 - self.bore**2) * self.length


def shear_coefficient(poisson_ratio: float, bore: float) -> float:
    """Timoshenko's, of a circle with a concentric hole; `bore` is a share of the diameter.

    Hutchinson, J. Appl. Mech. 68 (2001) 87.
    """
    nu, b2 = poisson_ratio, bore * bore
    own = 7.0 + 34.0 * b2 + 7.0 * b2 * b2 + nu * (12.0 + 48.0 * b2 + 12.0 * b2 * b2)
    return 6.0 * (1.0 + b2) ** 2 * (1.0 + nu) ** 2 / (own + nu * nu * (4.0 + 16.0 * b2 + 4.0 * b2 * b2))


def matrices(element: ShaftElement) -> tuple[_Floats, _Floats, _Floats]:
    """Mass, stiffness and gyroscopic matrix, shape (8, 8): x, y and the rotations about x and y at either end."""
    mass, stiffness, rotary = _plane(element)
    M, K, G = np.zeros((3, 8, 8))
    for matrix, plane in ((M, mass), (K, stiffness)):
        matrix[np.ix_(PLANE_X, PLANE_X)] = plane
        matrix[np.ix_(PLANE_Y, PLANE_Y)] = plane * np.outer(SIGN, SIGN)
    coupling = 2.0 * rotary * SIGN  # gyroscopic, of the rotations in one plane and in the other
    G[np.ix_(PLANE_X, PLANE_Y)], G[np.ix_(PLANE_Y, PLANE_X)] = coupling, -coupling.T
    return M, K, G


def _plane(element: ShaftElement) -> tuple[_Floats, _Floats, _Floats]:
    """Mass (with rotary inertia), stiffness, and rotary inertia of one plane, shape (4, 4)."""
    L, E, nu = element.length, element.youngs_modulus, element.poisson_ratio
    area = 0.25 * pi * (element.diameter**2 - element.bore**2)
    inertia = pi / 64.0 * (element.diameter**4 - element.bore**4)
    shear_rigidity = shear_coefficient(nu, element.bore / element.diameter) * 0.5 * E / (1.0 + nu) * area
    phi = 12.0 * E * inertia / (shear_rigidity * L * L) if element.shear else 0.0
    mass, stiffness, rotary = np.zeros((3, 4, 4))
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    for x, weight in zip(0.5 * (points + 1.0), 0.5 * L * weights, strict=True):
        v, slope, rotation, curvature = _shapes(float(x), L, phi)
        mass += weight * element.density * area * np.outer(v, v)
        rotary += weight * element.density * inertia * np.outer(rotation, rotation)
        stiffness += weight * E * inertia * np.outer(curvature, curvature)
        if element.shear:
            stiffness += weight * shear_rigidity * np.outer(slope - rotation, slope - rotation)
    return mass + rotary, stiffness, rotary


def _shapes(x: float, L: float, phi: float) -> tuple[_Floats, _Floats, _Floats, _Floats]:
    """Displacement, its slope, rotation of the section and curvature at x L, for unit values at the ends."""
    v = np.array([
        1.0 + phi * (1.0 - x) - x * x * (3.0 - 2.0 * x), L * x * (1.0 - x) * (1.0 - x + 0.5 * phi),
        x * x * (3.0 - 2.0 * x) + phi * x, -L * x * (1.0 - x) * (x + 0.5 * phi),
    ])  # fmt: skip
    slope = np.array([
        -phi / L - 6.0 * x * (1.0 - x) / L, 1.0 - 4.0 * x + 3.0 * x * x + 0.5 * phi * (1.0 - 2.0 * x),
        phi / L + 6.0 * x * (1.0 - x) / L, -2.0 * x + 3.0 * x * x - 0.5 * phi * (1.0 - 2.0 * x),
    ])  # fmt: skip
    rotation = np.array([
        -6.0 * x * (1.0 - x) / L, 1.0 - 4.0 * x + 3.0 * x * x + phi * (1.0 - x),
        6.0 * x * (1.0 - x) / L, -2.0 * x + 3.0 * x * x + phi * x,
    ])  # fmt: skip
    curvature = np.array([
        (12.0 * x - 6.0) / L**2, (6.0 * x - 4.0 - phi) / L, (6.0 - 12.0 * x) / L**2, (6.0 * x - 2.0 + phi) / L,
    ])  # fmt: skip
    share = 1.0 / (1.0 + phi)
    return share * v, share * slope, share * rotation, share * curvature
