"""A ball bearing about static equilibrium: impedance at complex frequencies.

Every contact has an impedance Z along its own normal, a `reduced_models.elements.film_response.LinearFilm`: it
takes the place of the stiffness in the tangents of its ball. With the balance R of the ball over its place b and
the inner groove centre c, and the force P of the ring (`ball`),

    R_b = G_b - Z_i n_i n_i^T - Z_o n_o n_o^T - m s^2,    R_c = G_c + Z_i n_i n_i^T,
    dP = (P_c - P_b R_b^-1 R_c) dc.

Both contacts are nearly on one line, along which films are far stiffer than G. So equations are those along and
across the outer contact: elimination of the place along it leaves what acts across without a small difference.

G has what follows the place of the ball without memory: the direction of both forces (Q/l), inertia of its orbit
and spin, film over entrainment speed. Friction that holds the gyroscopic moment and follows the place of its ball
without delay is not the gradient of a potential: it takes energy from the shaft, with which undamaged bearings in
flooded films would vibrate by themselves; how fast it follows is not known. G is taken as its symmetric part, and
K is symmetric. Where the axis of a ball follows the forces at both races ("inner" and "shared" race control), that
friction follows the films as well, and G has the direction of the forces alone.

m is the mass of a ball where it has inertia towards the rings. The states
behind Z, as matrices of first order: `ball_states`.

Rings and fits may lose more (`reduced_models.bearing.loss`). Balls stand still while the ring vibrates: what
changes as they travel is no part of it. Over a ball passage Z is the mean of positions of the cage, each with the
ring where one load puts it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduced_models.bearing.ball import Balls
from reduced_models.bearing.coefficients import stiffness_and_damping
from reduced_models.bearing.contact_angles import FOLLOWING, Grooves
from reduced_models.bearing.loss import Loss, response
from reduced_models.bearing.race_table import RaceForceTable
from reduced_models.bearing.ring import RingEquilibrium
from reduced_models.elements.film_filters import DIRECT
from reduced_models.elements.film_response import FilterRates, LinearFilm

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]


INNER, OUTER, SEAT = LOSSES = "inner films", "outer films", "rings and fits"  # what takes energy in a bearing


class Taken(NamedTuple):
    """What parts of a bearing take from a motion u exp(s t) of its ring: Im(u^H Z u) of each [N m]."""

    by: dict[str, float]
    mass: float  # kg m2, of its balls: the sum of m |b|^2


@dataclass(frozen=True, eq=False)
class LinearBalls:
    """All balls of a bearing about static equilibrium, at one position of the cage or at several."""

    films: LinearFilm  # of all contacts, (2, positions * balls): inner and outer race
    normals: _Floats  # (2, 2, positions * balls): inner and outer race; along and across the outer contact
    geometric: _Floats  # (positions * balls, 5, 4) G of the balance and of the force of the ring, along and across
    maps: _Floats  # (positions * balls, 3, n) of `ring_maps`, along and across, for the n directions of the ring
    positions: int
    loss: Loss
    inertia: float  # of a ball [kg]
    lossless: frozenset[str] = frozenset()  # those of LOSSES that are left out; their stiffness stays

    @classmethod
    def of(cls, balls: Balls, equilibria: Sequence[RingEquilibrium], loss: Loss, inertia: float) -> LinearBalls:
        """From where the ring stands at each position."""
        records, angles, geometric, maps = (
            np.concatenate([getattr(at, name) for at in equilibria])
            for name in ("balls", "angles", "geometric", "maps")
        )
        films = [_about(law, balls.omega, j, records) for j, law in enumerate((balls.inner, balls.outer))]
        if balls.omega > 0.0:
            follows = balls.grooves.control in FOLLOWING
            geometric = _of_directions(balls.grooves, records) if follows else _of_a_potential(geometric)
        turned = angles.T - angles[:, 1]
        normals = np.stack([np.cos(turned), np.sin(turned)], axis=1)
        frame, outward = np.zeros((len(records), 5, 5)), _outward(angles[:, 1])
        frame[:, :2, :2] = frame[:, 2:4, 2:4] = outward
        frame[:, 4, 4] = 1.0
        geometric, maps = frame @ geometric @ frame[:, :4, :4].swapaxes(1, 2), frame[:, 2:, 2:] @ maps
        return cls(LinearFilm.stack(films), normals, geometric, maps, len(equilibria), loss, inertia)

    def impedance(self, s: ArrayLike) -> _Complex:
        """Of the ring at frequencies s [1/s] of exp(s t), shape of `s` + (n, n)."""
        s = np.asarray(s, complex)
        flat = s.reshape(-1, 1)
        _, tangents = self._tangents(flat)
        condensed = _eliminated(tangents, len(self._acting))
        by_row = condensed.reshape(-1, *condensed.shape[2:]) @ self._weights
        Z = by_row.sum(axis=0) * self._seat(flat)
        return np.asarray(Z.reshape(*s.shape, *self.maps.shape[2:], -1))

    @property
    def losses(self) -> tuple[str, ...]:
        """Those of `LOSSES` that this bearing has."""
        wet = not isinstance(self.films, LinearFilm) or self.films.rates is not None
        has = {INNER: wet, OUTER: wet, SEAT: self.loss.gains.size > 0}
        return tuple(name for name in LOSSES if has[name] and name not in self.lossless)

    def taken(self, s: complex, u: _Complex) -> Taken:
        """What each of `losses` takes from a motion u exp(s t) of the ring, u of shape (n,).

        Films take what their contacts do in their own motions, times Re r, with r the filters of the seat, which
        act on the force of all balls; rings and fits take Im r times the stiffness of the balls.
        """
        rate, count = np.array([[s]], complex), len(self._acting)
        films, equations = self._tangents(rate)
        grooves = (self.maps[:, self._acting] @ u).T
        by_ball, by_ring = equations[:count, :count, 0], equations[:count, count:, 0]
        pushed = -np.einsum("ijk,jk->ki", by_ring, grooves)
        balls = np.linalg.solve(np.moveaxis(by_ball, -1, 0), pushed[..., None])[..., 0].T
        approaches = np.einsum("rjk,jk->rk", self._along, np.concatenate([balls, grooves]))
        lost = (films[:, 0].imag * np.abs(approaches) ** 2).sum(axis=1).real / self.positions
        mass = self.inertia * float((np.abs(balls) ** 2).sum()) / self.positions
        seat = complex(self._seat(rate)[0, 0])
        held = complex(u.conj() @ self.impedance(s) @ u) / seat
        by = {INNER: seat.real * float(lost[0]), OUTER: seat.real * float(lost[1]), SEAT: seat.imag * held.real}
        return Taken({name: by[name] for name in self.losses}, seat.real * mass)

    def _seat(self, s: _Complex) -> _Complex:
        """Filters of rings and fits, of the shape of `s`."""
        filters = response(self.loss, s)
        return without_loss(filters, s) if SEAT in self.lossless else filters

    def force_of_heights(self, s: _Complex, inner: _Complex, outer: _Complex) -> _Complex:
        """Force of every ball on the ring, shape (k, contacts, n), by heights at both of its contacts at exp(s t).

        `s` has the shape (k,), heights broadcast against (k, contacts).
        """
        films, tangents = self._tangents(s[:, None])
        by_inner, by_outer = (
            heights * film * rows[:, None, None]
            for heights, film, rows in zip((inner, outer), films, self._pressed, strict=True)
        )
        balls = len(self._acting)
        forces = _eliminated(np.concatenate([tangents[:, :balls], by_inner - by_outer], axis=1), balls)[:, 0]
        forces *= -self._seat(s)[:, None]
        return np.asarray(np.einsum("ikc,cij->kcj", forces, self.maps[:, self._rows].astype(complex)))

    def approaches(self, s: _Complex, heights: _Complex) -> tuple[_Complex, _Complex]:
        """Approaches of all contacts at exp(s t), by the ring and by `heights` at both contacts of every ball.

        Parameters
        ----------
        s : ndarray, shape (k,)
        heights : ndarray, shape (2, k, contacts)

        Returns
        -------
        ndarray, shape (2, k, contacts, n) and (2, k, contacts)
            Of the bodies [m], without the heights themselves: by a unit of each direction of the ring, and by the
            heights while the ring is held.
        """
        films, tangents = self._tangents(s[:, None])
        by_inner, by_outer = heights * films
        pressed = by_inner * self._pressed[0][:, None, None] - by_outer * self._pressed[1][:, None, None]
        equations = np.concatenate([tangents, pressed], axis=1)
        rows = np.zeros((2, *equations.shape[1:]), complex)
        rows[:, : tangents.shape[1]] = self._along[:, :, None]
        balls = len(self._acting)
        found = _eliminated(np.concatenate([equations[:balls], rows]), balls)
        signs = np.array([1.0, -1.0])[
            :, None, None, None
        ]  # the outer contact approaches as the ball moves outward
        by_grooves, by_heights = signs * found[:, :-1], signs[..., 0] * found[:, -1]
        maps = self.maps[:, self._acting].astype(complex)
        return np.asarray(np.einsum("rjkc,cjn->rkcn", by_grooves, maps)), np.asarray(by_heights)

    def _tangents(self, s: _Complex) -> tuple[_Complex, _Complex]:
        """Impedances of all contacts at s, shape (k, 1): (2, k, contacts); and the equations of all balls.

        Their rows are the balance of a ball and the force of the ring on it, their columns b and c, shape (rows,
        columns, k, contacts): along the directions that act.
        """
        films = np.moveaxis(np.asarray(self.films.impedance(s[..., None])), -2, 0)
        left_out = [race for race, name in enumerate((INNER, OUTER)) if name in self.lossless]
        if left_out:
            films[left_out] = without_loss(films[left_out], s)
        (inner, outer), (by_inner, by_outer) = films, self._stretched
        tangents = self._fixed + by_inner * inner + by_outer * outer
        lost = inner + outer == 0.0  # nothing touches the ball: it carries nothing
        own = self.inertia * s * s + lost
        for j in range(len(self._acting)):
            tangents[j, j] -= own
        return films, tangents

    @cached_property
    def _acting(self) -> list[int]:
        """Directions along and across in which anything acts: nothing does across in a planar ring."""
        along = [np.abs(self.normals[:, 1]), np.abs(self.maps[:, 1]), np.abs(self.geometric[:, 0::2, 1::2])]
        return [0, 1] if any(part.any() for part in along) else [0]

    @cached_property
    def _rows(self) -> list[int]:
        """Rows of `maps` along which the ring has a force on a ball: directions that act, and a moment."""
        return [*self._acting, *([2] if self.maps[:, 2].any() else [])]

    @cached_property
    def _pressed(self) -> _Floats:
        """Rows of the equations by a unit force of both contacts, shape (2, rows, contacts)."""
        balls = len(self._acting)
        rows = np.zeros((2, balls + len(self._rows), len(self.maps)))
        rows[:, :balls] = self.normals[:, self._acting]
        rows[0, balls : 2 * balls] = rows[0, :balls]  # no moment by the normal force
        return rows

    @cached_property
    def _along(self) -> _Floats:
        """Motion along the normals of both contacts by b and c, shape (2, columns, contacts)."""
        n = self.normals[:, self._acting]
        return np.concatenate([-n, n * [[[1.0]], [[0.0]]]], axis=1)  # the outer groove stands still

    @cached_property
    def _stretched(self) -> _Floats:
        """Equations by a unit impedance of both contacts, shape (2, rows, columns, 1, contacts)."""
        return np.asarray(self._pressed[:, :, None, None] * self._along[:, None, :, None])

    @cached_property
    def _fixed(self) -> _Floats:
        """Equations without films and inertia, shape (rows, columns, 1, contacts)."""
        acting = np.array(self._acting)
        rows, columns = [*acting, *(2 + np.array(self._rows))], [*acting, *(2 + acting)]
        return np.asarray(np.moveaxis(self.geometric[:, rows][:, :, columns], 0, -1)[:, :, None])

    @cached_property
    def _weights(self) -> _Complex:
        """Impedance of the ring by the entries of all balls, shape (rows * columns, contacts, n * n)."""
        n = self.maps.shape[2]
        weights = np.einsum("kmi,klj->mlkij", self.maps[:, self._rows], self.maps[:, self._acting])
        return np.asarray(weights.reshape(-1, len(self.maps), n * n) / self.positions, complex)

    def coefficients(self, omega: _Floats) -> tuple[_Floats, _Floats]:
        """Stiffness [N/m] and damping [N s/m], shape (k, n, n), at angular frequencies [rad/s], shape (k,)."""
        return stiffness_and_damping(self.impedance, omega)


def without_loss(Z: _Complex, s: _Complex) -> _Complex:
    """Stiffness K of Z = K + s C with real K and C, whose shapes broadcast; at a real s all of Z."""
    ratio = np.divide(s.real, s.imag, out=np.zeros(np.shape(s)), where=np.asarray(s.imag) != 0.0)
    return np.asarray(Z.real - ratio * Z.imag, complex)


def _of_directions(grooves: Grooves, balls: NDArray[np.void]) -> _Floats:
    """Derivatives of forces that turn with their contacts, as `geometric` of `RingEquilibrium`."""
    found = np.zeros((len(balls), 5, 4))
    for j, free in enumerate((grooves.inner, grooves.outer)):
        across = _outward(balls["angle"][:, j])[:, 1]
        turned = balls["load"][:, j] / (free + balls["approach"][:, j])
        rows = turned[:, None, None] * across[:, :, None] * across[:, None, :]
        found[:, :2, :2] -= rows
        if j == 0:  # the outer groove stands still
            found[:, 2:4, :2] -= rows
            found[:, :2, 2:] += rows
            found[:, 2:4, 2:] += rows
    return found


def _of_a_potential(geometric: _Floats) -> _Floats:
    """Symmetric part of `geometric` of `RingEquilibrium`: forces on the ball and of the ring by one energy."""
    found = np.zeros_like(geometric)  # without friction at the inner race the ring has no moment by it
    energy = geometric[:, :4] * np.array([-1.0, -1.0, 1.0, 1.0])[:, None]
    found[:, :4] = 0.5 * (energy + energy.swapaxes(1, 2)) * np.array([-1.0, -1.0, 1.0, 1.0])[:, None]
    return found


def _outward(angle: _Floats) -> _Floats:
    """Directions along and across outer contacts, as rows over r and z, shape (contacts, 2, 2)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.moveaxis(np.array([[cosine, sine], [-sine, cosine]]), -1, 0)


def _eliminated(equations: _Complex, count: int) -> _Complex:
    """The other equations after elimination of the first `count` unknowns, shape (rows, columns, ...)."""
    for _ in range(count):
        equations = equations[1:, 1:] - equations[1:, :1] * (equations[:1, 1:] / equations[:1, :1])
    return equations


def small_film(
    law: RaceForceTable,
    transit: float | _Floats,
    speed_row: tuple[int, float],
    g: float | _Floats,
    slope: float | _Floats,
    stiffness: float | _Floats,
) -> LinearFilm:
    """Linear law of films of dry compressions `g` [m], whose static force has this slope and `stiffness` [N/m]."""
    root, (row, weight) = np.sqrt(g), speed_row
    rows, film_made = law.gains[row], law.film_made[row]
    if weight > 0.0:
        rows = rows + weight * (law.gains[row + 1] - rows)
        film_made = film_made + weight * (law.film_made[row + 1] - film_made)
    x = law.log_kn + 1.5 * np.log(g)
    gains = np.stack([np.interp(x, law.x, column) for column in rows.T], axis=-1)
    rates = FilterRates(len(rows.T) - DIRECT, law.lag_rate, law.inlet_rate, law.fast_rate)
    return LinearFilm(stiffness, slope, transit * root, gains, rates, np.interp(x, law.x, film_made))


def _about(law: RaceForceTable, omega: float, race: int, balls: NDArray[np.void]) -> LinearFilm:
    """Linear law of the contacts of all balls of `RingEquilibrium` with a race."""
    slope, g = balls["slope"][:, race], balls["compression"][:, race]
    if law.x.size == 0:
        none = np.zeros(slope.size)
        return LinearFilm(slope, none, none, none[:, None][:, :0], None, none)
    transit = law.contact_length_factor / (balls["speed_sum"][:, race] * omega)
    return small_film(law, transit, (0, 0.0), g, 1.5 * balls["load"][:, race] / g, slope)
