"""A ball bearing with five degrees of freedom about static equilibrium: impedance at complex frequencies.

As in `linear_balls` every contact has an impedance Z along its own normal, which here takes the place of the
stiffness in the tangent of its ball. With the balance R of the ball over its place b and the inner groove centre
c, and the force P of the ring (`angular_balls`),

    R_b = G_b - Z_i n_i n_i^T - Z_o n_o n_o^T - m s^2,    R_c = G_c + Z_i n_i n_i^T,
    dP = (P_c - P_b R_b^-1 R_c) dc.

G has what follows the place of the ball without memory: the direction of both forces (Q/l), inertia of its orbit
and spin, film over entrainment speed. m is the mass of a ball where it has inertia towards the rings.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduced_models.bearing.angular_balls import SLOPE, AngularBalls
from reduced_models.bearing.five_degrees import AngularEquilibrium
from reduced_models.bearing.linear_balls import small_film, stiffness_and_damping
from reduced_models.bearing.loss import Loss, response
from reduced_models.bearing.race_contact import curve, film_cutoff
from reduced_models.bearing.race_table import RaceForceTable
from reduced_models.elements.small_motion import SmallMotion

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]


class SmallAngularBalls(NamedTuple):
    """All balls of a bearing about static equilibrium, at one position of the cage or at several."""

    inner: SmallMotion  # of all contacts, (positions * balls,)
    outer: SmallMotion
    angles: _Floats  # (positions * balls, 2) contact angles [rad]
    geometric: _Floats  # (positions * balls, 5, 4) G of the balance and of the force of the ring
    maps: _Floats  # (positions * balls, 3, 5) of `ring_map`
    positions: int
    loss: Loss
    inertia: float  # of a ball [kg]

    @classmethod
    def of(
        cls, balls: AngularBalls, equilibria: Sequence[AngularEquilibrium], loss: Loss, inertia: float
    ) -> SmallAngularBalls:
        """From where the ring stands at each position."""
        force, approach, speed_sum, angles, geometric, maps = (
            np.concatenate([getattr(at, name) for at in equilibria])
            for name in ("force", "approach", "speed_sum", "angles", "geometric", "maps")
        )
        slope = np.concatenate([at.found[:, SLOPE : SLOPE + 2] for at in equilibria])
        inner, outer = (
            SmallMotion.stack(
                [
                    _about(law, balls.omega, *row)
                    for row in zip(force[:, j], approach[:, j], slope[:, j], speed_sum[:, j], strict=True)
                ]
            )
            for j, law in enumerate((balls.inner, balls.outer))
        )
        return cls(inner, outer, angles, geometric, maps, len(equilibria), loss, inertia)

    def impedance(self, s: ArrayLike) -> _Complex:
        """Of the ring at frequencies s [1/s] of exp(s t), shape of `s` + (5, 5)."""
        s = np.asarray(s, complex)[..., None]
        both = [np.asarray(race.impedance(s))[..., None, None] for race in (self.inner, self.outer)]
        normals = np.stack([np.cos(self.angles), np.sin(self.angles)], axis=-1)  # (contacts, race, 2)
        inner, outer = (z * normals[:, j, :, None] * normals[:, j, None, :] for j, z in enumerate(both))
        heavy = self.inertia * (s * s)[..., None, None] * np.eye(2)
        by_b = self.geometric[:, :2, :2] - inner - outer - heavy
        by_c = self.geometric[:, :2, 2:] + inner
        pressed = np.concatenate(
            [inner, np.zeros_like(inner[..., :1, :])], axis=-2
        )  # no moment by the normal force
        lost = (np.abs(both[0] + both[1]) == 0.0) * np.eye(2)  # nothing touches the ball: it carries nothing
        moved = np.linalg.solve(by_b - lost, by_c)
        condensed = self.geometric[:, 2:, 2:] + pressed - (self.geometric[:, 2:, :2] - pressed) @ moved
        of_balls = self.maps.transpose(0, 2, 1) @ condensed @ self.maps[:, :2]
        share = response(self.loss, s[..., 0]) / self.positions
        return np.asarray(of_balls.sum(axis=-3) * share[..., None, None])

    def coefficients(self, omega: _Floats) -> tuple[_Floats, _Floats]:
        """Stiffness and damping, shape (k, 5, 5), at angular frequencies [rad/s], shape (k,)."""
        return stiffness_and_damping(self.impedance, omega)


def _about(
    law: RaceForceTable, omega: float, force: float, u: float, slope: float, speed_sum: float
) -> SmallMotion:
    """Linear law of one contact under its static force, whose derivative by the approach is `slope`."""
    if law.x.size == 0:
        return SmallMotion(slope, 0.0, 0.0, np.zeros(0), None)
    share = film_cutoff(u, law.cutoff_gap)[0]
    g = (force / (share * law.kn)) ** (2.0 / 3.0) if share > 0.0 else curve(u, 0, 0.0, law, 0)[0]
    by_film = share * 1.5 * law.kn * np.sqrt(g)
    return small_film(law, law.contact_length_factor / (speed_sum * omega), (0, 0.0), g, by_film, slope)
