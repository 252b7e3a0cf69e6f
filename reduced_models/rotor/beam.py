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
PLANE_X = (0, 3, 4, 7)  # of x, y, turn about x, turn about y at both ends: x, and the turn about y, its slope
PLANE_Y = (1, 2, 5, 6)  # y, and minus its slope, the turn about x
SIGN = np.array([1.0, -1.0, 1.0, -1.0])  # of the plane of y


class Piece(NamedTuple):
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


def matrices(piece: Piece) -> tuple[_Floats, _Floats, _Floats]:
    """Mass, stiffness and gyroscopic matrix, shape (8, 8): x, y and the turns about x and y at either end."""
    mass, stiffness, turning = _plane(piece)
    M, K, G = np.zeros((3, 8, 8))
    for found, one in ((M, mass), (K, stiffness)):
        found[np.ix_(PLANE_X, PLANE_X)] = one
        found[np.ix_(PLANE_Y, PLANE_Y)] = one * np.outer(SIGN, SIGN)
    across = 2.0 * turning * SIGN  # of the slopes in one plane on those in the other
    G[np.ix_(PLANE_X, PLANE_Y)], G[np.ix_(PLANE_Y, PLANE_X)] = across, -across.T
    return M, K, G


def _plane(piece: Piece) -> tuple[_Floats, _Floats, _Floats]:
    """Mass, stiffness, and turning inertia of one plane, shape (4, 4)."""
    L, E, nu = piece.length, piece.youngs_modulus, piece.poisson_ratio
    area = 0.25 * pi * (piece.diameter**2 - piece.bore**2)
    inertia = pi / 64.0 * (piece.diameter**4 - piece.bore**4)
    rigid = shear_coefficient(nu, piece.bore / piece.diameter) * 0.5 * E / (1.0 + nu) * area  # against shear [N]
    phi = 12.0 * E * inertia / (rigid * L * L) if piece.shear else 0.0
    mass, stiffness, turning = np.zeros((3, 4, 4))
    places, weights = np.polynomial.legendre.leggauss(POINTS)
    for x, weight in zip(0.5 * (places + 1.0), 0.5 * L * weights, strict=True):
        v, slope, turn, bend = _shapes(float(x), L, phi)
        mass += weight * piece.density * area * np.outer(v, v)
        turning += weight * piece.density * inertia * np.outer(turn, turn)
        stiffness += weight * E * inertia * np.outer(bend, bend)
        if piece.shear:
            stiffness += weight * rigid * np.outer(slope - turn, slope - turn)
    return mass + turning, stiffness, turning


def _shapes(x: float, L: float, phi: float) -> tuple[_Floats, _Floats, _Floats, _Floats]:
    """Displacement, its slope, turn of the section and curvature at x L, of unit displacements and slopes."""
    v = np.array([
        1.0 + phi * (1.0 - x) - x * x * (3.0 - 2.0 * x), L * x * (1.0 - x) * (1.0 - x + 0.5 * phi),
        x * x * (3.0 - 2.0 * x) + phi * x, -L * x * (1.0 - x) * (x + 0.5 * phi),
    ])  # fmt: skip
    slope = np.array([
        -phi / L - 6.0 * x * (1.0 - x) / L, 1.0 - 4.0 * x + 3.0 * x * x + 0.5 * phi * (1.0 - 2.0 * x),
        phi / L + 6.0 * x * (1.0 - x) / L, -2.0 * x + 3.0 * x * x - 0.5 * phi * (1.0 - 2.0 * x),
    ])  # fmt: skip
    turn = np.array([
        -6.0 * x * (1.0 - x) / L, 1.0 - 4.0 * x + 3.0 * x * x + phi * (1.0 - x),
        6.0 * x * (1.0 - x) / L, -2.0 * x + 3.0 * x * x + phi * x,
    ])  # fmt: skip
    bend = np.array([
        (12.0 * x - 6.0) / L**2, (6.0 * x - 4.0 - phi) / L, (6.0 - 12.0 * x) / L**2, (6.0 * x - 2.0 + phi) / L,
    ])  # fmt: skip
    share = 1.0 / (1.0 + phi)
    return share * v, share * slope, share * turn, share * bend
