"""A ball bearing about static equilibrium: impedance at complex frequencies.

Every contact has an impedance Z along its own normal, a `reduced_models.elements.film_response.LinearFilm`: it
takes the place of the stiffness in the tangents of its ball. With the balance R of the ball over its place b and
the inner groove centre c, and the force P of the ring (`ball`),

    R_b = G_b - Z_i n_i n_i^T - Z_o n_o n_o^T - m s^2,    R_c = G_c + Z_i n_i n_i^T,
    dP = (P_c - P_b R_b^-1 R_c) dc.

G has what follows the place of the ball without memory: the direction of both forces (Q/l), inertia of its orbit
and spin, film over entrainment speed. m is the mass of a ball where it has inertia towards the rings. The states
behind Z, as matrices of first order: `ball_states`.

Rings and fits may lose more (`reduced_models.bearing.loss`). Balls stand still while the ring vibrates: what
changes as they travel is no part of it. Over a ball passage Z is the mean of positions of the cage, each with the
ring where one load puts it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduced_models.bearing.ball import Balls
from reduced_models.bearing.coefficients import stiffness_and_damping
from reduced_models.bearing.freedoms import PLANAR
from reduced_models.bearing.loss import Loss, response
from reduced_models.bearing.race_table import RaceForceTable
from reduced_models.bearing.ring import RingEquilibrium
from reduced_models.elements.film_filters import DIRECT
from reduced_models.elements.film_response import FilterRates, LinearFilm

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]


class LinearBalls(NamedTuple):
    """All balls of a bearing about static equilibrium, at one position of the cage or at several."""

    inner: LinearFilm  # of all contacts, (positions * balls,)
    outer: LinearFilm
    normals: _Floats  # (2, 2, positions * balls): inner and outer race; r and z
    geometric: _Floats  # (positions * balls, 5, 4) G of the balance and of the force of the ring
    maps: _Floats  # (positions * balls, 3, n) of `ring_maps`, for the n directions of the ring
    positions: int
    loss: Loss
    inertia: float  # of a ball [kg]

    @classmethod
    def of(cls, balls: Balls, equilibria: Sequence[RingEquilibrium], loss: Loss, inertia: float) -> LinearBalls:
        """From where the ring stands at each position."""
        records, angles, geometric, maps = (
            np.concatenate([getattr(at, name) for at in equilibria])
            for name in ("balls", "angles", "geometric", "maps")
        )
        inner, outer = (
            LinearFilm.stack([_about(law, balls.omega, j, ball) for ball in records])
            for j, law in enumerate((balls.inner, balls.outer))
        )
        normals = np.stack([np.cos(angles.T), np.sin(angles.T)], axis=1)
        return cls(inner, outer, normals, geometric, maps, len(equilibria), loss, inertia)

    def impedance(self, s: ArrayLike) -> _Complex:
        """Of the ring at frequencies s [1/s] of exp(s t), shape of `s` + (n, n)."""
        s = np.asarray(s, complex)[..., None]
        inner, _, by_b = self._tangents(s)
        G, n = self.geometric, self.normals[0]
        directions = self.maps.shape[-1]
        rows, columns = (1, 1) if directions == len(PLANAR) else (3, 2)  # x and y move grooves outward alone
        condensed = np.empty((*s.shape[:-1], len(G), rows, columns), complex)
        for j in range(columns):
            pressed = inner * (n[0] * n[j]), inner * (n[1] * n[j]), 0.0  # no moment by the normal force
            moved = _solve(by_b, (G[:, 0, 2 + j] + pressed[0], G[:, 1, 2 + j] + pressed[1]))
            for i in range(rows):
                own = G[:, 2 + i, 2 + j] + pressed[i]
                condensed[..., i, j] = own - self._carried(inner, moved, i)
        weights = np.einsum("kmi,klj->kmlij", self.maps[:, :rows], self.maps[:, :columns]).reshape(
            -1, directions * directions
        )
        Z = condensed.reshape(*s.shape[:-1], -1) @ weights
        share = response(self.loss, s[..., 0]) / self.positions
        return np.asarray(Z.reshape(*s.shape[:-1], directions, directions) * share[..., None, None])

    def force_of_heights(self, s: _Complex, inner: _Complex, outer: _Complex) -> _Complex:
        """Force of every ball on the ring, shape (k, contacts, n), by heights at both of its contacts at exp(s t).

        `s` has the shape (k,), heights broadcast against (k, contacts).
        """
        inner_z, outer_z, by_b = self._tangents(s[:, None])
        n_i, n_o = self.normals
        by_inner, by_outer = inner_z * inner, outer_z * outer
        pressed = [by_inner * n_i[j] for j in range(2)]
        moved = _solve(by_b, tuple(by_outer * n_o[j] - pressed[j] for j in range(2)))
        P = np.stack(
            [self._carried(inner_z, moved, i) + (pressed[i] if i < 2 else 0.0) for i in range(3)], axis=-1
        )
        P *= -response(self.loss, s)[:, None, None]
        return np.asarray(np.einsum("kci,cij->kcj", P, self.maps.astype(complex)))

    def _tangents(self, s: _Complex) -> tuple[_Complex, _Complex, list[_Complex]]:
        """Impedances of all contacts at s, shape (..., 1), and R_b by rows; all of shape (..., contacts)."""
        inner, outer = (np.asarray(race.impedance(s)) for race in (self.inner, self.outer))
        n_i, n_o = self.normals
        lost = inner + outer == 0.0  # nothing touches the ball: it carries nothing
        own = self.inertia * s * s + lost
        by_b = [
            self.geometric[:, i, j]
            - inner * (n_i[i] * n_i[j])
            - outer * (n_o[i] * n_o[j])
            - (own if i == j else 0.0)
            for i in range(2)
            for j in range(2)
        ]
        return inner, outer, by_b

    def _carried(self, inner: _Complex, moved: tuple[_Complex, _Complex], i: int) -> _Complex:
        """Component `i` of P_b times a motion of the balls."""
        G, n = self.geometric, self.normals[0]
        found = G[:, 2 + i, 0] * moved[0] + G[:, 2 + i, 1] * moved[1]
        return found - inner * n[i] * (n[0] * moved[0] + n[1] * moved[1]) if i < 2 else found

    def coefficients(self, omega: _Floats) -> tuple[_Floats, _Floats]:
        """Stiffness [N/m] and damping [N s/m], shape (k, n, n), at angular frequencies [rad/s], shape (k,)."""
        return stiffness_and_damping(self.impedance, omega)


def _solve(matrix: list[_Complex], right: tuple[_Complex, ...]) -> tuple[_Complex, _Complex]:
    """Solve 2 x 2 equations, the matrix by rows."""
    rr, rz, zr, zz = matrix
    det = rr * zz - rz * zr
    return (zz * right[0] - rz * right[1]) / det, (rr * right[1] - zr * right[0]) / det


def small_film(
    law: RaceForceTable, transit: float, speed_row: tuple[int, float], g: float, slope: float, stiffness: float
) -> LinearFilm:
    """Linear law of a film of dry compression `g` [m], whose static force has this slope and `stiffness` [N/m]."""
    root, (row, weight) = np.sqrt(g), speed_row
    rows, film_made = law.gains[row], law.film_made[row]
    if weight > 0.0:
        rows = rows + weight * (law.gains[row + 1] - rows)
        film_made = film_made + weight * (law.film_made[row + 1] - film_made)
    x = law.log_kn + 1.5 * np.log(g)
    gains, made = (
        np.array([np.interp(x, law.x, column) for column in rows.T]),
        float(np.interp(x, law.x, film_made)),
    )
    rates = FilterRates(gains.size - DIRECT, law.lag_rate, law.inlet_rate, law.fast_rate)
    return LinearFilm(stiffness, slope, transit * root, gains, rates, made)


def _about(law: RaceForceTable, omega: float, race: int, ball: np.void) -> LinearFilm:
    """Linear law of the contact of a ball of `RingEquilibrium` with a race."""
    slope, g = float(ball["slope"][race]), float(ball["compression"][race])
    if law.x.size == 0:
        return LinearFilm(slope, 0.0, 0.0, np.zeros(0), None)
    transit = law.contact_length_factor / (float(ball["speed_sum"][race]) * omega)
    return small_film(law, transit, (0, 0.0), g, 1.5 * float(ball["load"][race]) / g, slope)
