"""Derivatives of a contact at its steady film: its force by what vibrates, over frequency.

A few frequencies are solved. In the space of the real and imaginary parts of their solutions every other one is a
small least-squares problem, whose residual is the error measure: the frequency with the largest is solved next.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.solver.balance import Balance
from ehlcontact.solver.effects import Effect
from ehlcontact.solver.followed_viscosity import sum_of
from ehlcontact.solver.linear import LinearFilm, NearCorrection, Preconditioner, solve_linear
from ehlcontact.solver.linear_heat import Forcing, HeatedPreconditioner, HeatedSystem, viscous
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.solver.passing_layer import arriving, layer_behind

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

TOLERANCE = 1e-5  # of the linear residuals; C is then within 3e-4 of the exact solve up to Omega = 30
PRESCRIBED = Balance.of_approach(0.0)
KEEP_FACTORS = 5.0  # change of Omega for which the factors of short waves serve
MANY_NODES = 70_000  # beyond, factors of one band of frequencies are kept at a time: they take gigabytes
SOLVE_SHARE = 0.3  # of the tolerance, for the solves themselves
SMALLEST_NEW_PART = 1e-10  # of a vector, outside the space so far


class Forces(NamedTuple):
    """Forces over a unit of what vibrates, at k frequencies."""

    force: Complex  # (k,)
    residual: Array  # (k,), relative, of the linear system
    behind: Complex | None = None  # (k, ny + 1): layer behind on each line, by the approach or the layer ahead


class LinearisedContact:
    """Derivatives of the contact at its steady state.

    Vectors hold the m nodes with P > 0. Sparse factors, for the short waves, serve a band of frequencies; dense
    ones, for the long waves, are made at each.

    Parameters
    ----------
    multigrid : Multigrid
        It holds the steady state: P, film and flow of its finest level, approach.
    effects : sequence of Effect
        Those that follow the vibration; by default what they change stands still.
    still : bool
        Let the temperatures stand still.
    """

    def __init__(self, multigrid: Multigrid, effects: Sequence[Effect] = (), still: bool = False) -> None:
        self._multigrid, self._effects = multigrid, effects
        level = self.level = multigrid.finest
        self._parts = [effect.linear(still) for effect in effects]
        self._fields = sum(part.fields for part in self._parts)
        beside = [part.beside for part in self._parts if part.beside is not None]
        self._beside = (sum_of(one[0] for one in beside), sum_of(one[1] for one in beside)) if beside else None
        self._free = level.P > 0.0
        self.nodes = np.flatnonzero(self._free)
        self.weights = level.force_weights.ravel()[self.nodes]
        self._steady, self._unit = (self._film(c_t) for c_t in (0.0, 1.0))
        self.j = self._steady.by_approach[self.nodes]
        self.b = self._unit.by_approach[self.nodes] - self.j
        self._row_scale = 1.0 / np.abs(self._steady.diagonal()[self.nodes])
        self._near: list[tuple[float, NearCorrection]] = []

    def still(self) -> LinearisedContact:
        """The same with temperatures that stand still."""
        return LinearisedContact(self._multigrid, self._effects, still=True)

    def products(self, dP: Array) -> tuple[Array, Array]:
        """J dP and B dP."""
        x = np.zeros(self._free.size)
        x[self.nodes] = dP
        film = self._steady.deflect(x)
        steady, unit = (system.at_nodes(x, film)[self.nodes] for system in (self._steady, self._unit))
        return steady, unit - steady

    def solve(self, omega: float, start: Complex, tolerance: float) -> Complex:
        """Complex solution dP for du = 1 at one frequency, improving on `start`, both (m,)."""
        x = self._vector()
        x[self.nodes] = start
        return self._solve(omega, self._equations(omega), x, tolerance)[self.nodes]

    def _vector(self) -> Complex:
        """Unknowns at rest, with du = 1."""
        x = np.zeros(self._free.size * (1 + self._fields) + 1, dtype=complex)
        x[self._free.size] = 1.0
        return x

    def _solve(self, omega: float, system: Any, start: Complex, tolerance: float) -> Complex:
        """All unknowns at one frequency, improving on `start`, where du is 1; `system` is that of omega."""
        b: NDArray[Any] = -system(start)
        b[self._free.size] = 0.0
        drop = tolerance * scipy.linalg.norm(self.j + 1j * omega * self.b) / scipy.linalg.norm(b)
        return np.asarray(start + self.change(omega, system, b, drop))

    def system(self, omega: float) -> LinearFilm:
        """Equations of a vibration of one frequency, at given temperatures."""
        return self._film(1j * omega)

    def _film(self, c_t: complex) -> LinearFilm:
        return LinearFilm(self.level, self._free, PRESCRIBED, c_t, self._beside)

    def _equations(self, omega: float) -> Any:
        """The same, with temperatures that follow where there is heat."""
        system: Any = self.system(omega)
        for part in self._parts:
            system = part.system(system, omega)
        return system

    def change(self, omega: float, system: Any, b: NDArray[Any], rtol: float) -> Complex:
        """Solution of ``system(x) = b`` to ``|b - system(x)| <= rtol |b|``, system that of omega."""
        film = system.film if isinstance(system, HeatedSystem) else system
        reach = [abs(omega - w) for w, _ in self._near]
        if not reach or min(reach) > KEEP_FACTORS:
            if self._free.size > MANY_NODES:
                self._near.clear()
                reach.clear()
            self._near.append((omega, NearCorrection(self.level, film)))
            reach.append(0.0)
        near = self._near[int(np.argmin(reach))][1]
        preconditioner: Any = Preconditioner(self._multigrid.levels, film, near)
        if isinstance(system, HeatedSystem):
            preconditioner = HeatedPreconditioner(preconditioner)
        return np.asarray(solve_linear(system, preconditioner, b, rtol).x)

    def respond(self, omega: Array, tolerance: float) -> Forces:
        """Impedance at each frequency > 0, and the relative residual of its linear system.

        Under a supply with the layer behind. `tolerance` is for the residuals, their imaginary part counted
        relative to Omega below Omega = 1. Where a solve fails to reach it, the residual returned is larger.
        """
        if self.level.inflow.size or self._fields:
            return self._respond_one_by_one(omega, tolerance)
        basis: list[Array] = []
        products: list[Array] = [self.j, self.b]
        done: set[int] = set()
        while True:
            space = np.array(basis).reshape(len(basis), self.nodes.size)
            # Every residual is a combination of these columns: their triangular factor stands for them.
            columns = np.array(products).T * self._row_scale[:, None]
            R = scipy.linalg.qr(columns, mode="r", overwrite_a=True, check_finite=False)[0][: columns.shape[1]]
            solutions = [_least_squares(R, w) for w in omega]
            error = np.array([e for _, _, e in solutions])
            error[list(done)] = 0.0
            worst = int(np.argmax(error))
            if error[worst] < tolerance:
                Z = np.array([(space @ self.weights) @ y for y, _, _ in solutions])
                return Forces(Z, np.array([r for _, r, _ in solutions]))
            done.add(worst)
            w = float(omega[worst])
            dP = self.solve(w, solutions[worst][0] @ space, SOLVE_SHARE * tolerance * min(1.0, w))
            for part in (dP.real, dP.imag):
                x = part / scipy.linalg.norm(part)
                for _ in range(2):  # the second time for rounding
                    x = x - (space @ x) @ space
                size = scipy.linalg.norm(x)
                if size > SMALLEST_NEW_PART:
                    basis.append(x / size)
                    space = np.array(basis)
                    products += self.products(basis[-1])

    def force_of_waves(self, omega: Array, k: Array) -> Forces:
        """Force per height of waves of wave numbers k, at fixed approach.

        Waves of height ``exp(i (Omega T - k X))``, positive out of the surface, move with ``Omega/k``. The exact
        change along X is put in the place of the differenced one, as runs with a surface do
        (`transient.transient_film`), under a supply as of `Level.carry_exactly`.
        """
        return self._force_of(omega, lambda film, m: self._by_waves(film, float(k[m])))

    def force_of_speed(self, omega: Array) -> Forces:
        """Force over a relative change of speed, at fixed approach.

        Over the speed, all flow by pressure changes in a film whose surfaces carry what they do: where oil runs
        short that moves the fronts too. Surfaces slide in proportion to the speed, and are given heat elsewhere.
        """
        return self._force_of(omega, lambda film, m: self._by_speed(film))

    def force_of_layer(self, omega: Array) -> Forces:
        """Force and layer behind over a uniform change of the layer ahead, at fixed approach, under a supply."""
        return self._force_of(omega, lambda film, m: Forcing(arriving(self.level, film.c_t), layer=1.0))

    def _by_waves(self, film: LinearFilm, k: float) -> Forcing:
        level = self.level
        height = np.broadcast_to(-np.exp(-1j * k * level.X), level.P.shape)
        still = np.zeros_like(level.P)
        differenced = level.transport(height.real.copy(), still) + 1j * level.transport(height.imag.copy(), still)
        off = differenced + 1j * k * height
        if not level.inflow.size:
            source = level.fields.flow.rho * off
            return Forcing(film.by_film @ height.ravel() + source.ravel(), height, source)
        off[:, [0, -1]] = 0.0
        flow = np.cumsum(off, axis=1) * (level.hx / level.speed)
        flow = (flow - flow.mean(axis=1, keepdims=True)) * level.full_flow(level.fields.flow.rho)
        given = level.fields.flow.open <= 0.0  # what comes to a front
        before = np.where(given, 0.0, flow)[:, :-1]
        source = np.zeros_like(flow)
        source[:-1, 1:] = (flow[:, 1:] - before)[:-1] * (level.speed / level.hx)
        return Forcing(film.by_film @ height.ravel() + source.ravel(), height)

    def _by_speed(self, film: LinearFilm) -> Forcing:
        level, log_eps = self.level, np.full(self.level.P.shape, -1.0)
        if not level.inflow.size and not self._parts:
            flow = -level.transport(level.fields.flow.mass, np.zeros_like(level.P)).ravel()
            return Forcing(flow)
        changes = [part.of_speed() for part in self._parts]
        log_eps = sum((one.log_eps for one in changes), start=log_eps)
        change = sum((one.flow for one in changes), start=viscous(level, log_eps).ravel())
        ratio = sum(one.ratio for one in changes)
        flow = film.with_supply(change, log_eps.ravel())
        return Forcing(flow, log_eps=log_eps, ratio=ratio, speed=1.0)

    def _force_of(self, omega: Array, change: Callable[[LinearFilm, int], Forcing]) -> Forces:
        """Force by a change in the equations at fixed pressure and approach.

        ``change(system, m)`` is that of the m-th of the frequencies.
        """
        force, residual = np.empty(omega.size, dtype=complex), np.empty(omega.size)
        behind = np.empty((omega.size, self.level.inflow.size), dtype=complex)
        for m in np.argsort(omega):
            w = float(omega[m])
            system = self._equations(w)
            heated = isinstance(system, HeatedSystem)
            film = system.film if heated else system
            by = change(film, int(m))
            b: NDArray[Any] = np.zeros(self._vector().size, dtype=complex)
            b[self.nodes] = -by.flow[self.nodes]
            if heated:
                b[self._free.size + 1 :] = system.weight * system.heat.to_change(by).ravel()
            x: NDArray[Any] = self.change(w, system, b, SOLVE_SHARE * TOLERANCE * min(1.0, w))
            force[m], size = self.weights @ x[self.nodes], float(scipy.linalg.norm(b))
            # A coarse film may have no front that a layer reaches
            residual[m] = scipy.linalg.norm(b - system(x)) / size if size > 0.0 else 0.0
            if by.layer:
                behind[m] = self._layer_behind(system, x, by.layer)
        return Forces(force, residual, behind if behind.size else None)

    def _layer_behind(self, system: Any, x: Complex, layer: float = 0.0) -> Complex:
        """Change of the layer behind on each line by all unknowns, and by that of the layer ahead."""
        film, others = system, np.zeros(0)
        if self._fields:
            film, (x, others) = system.film, system.split(x)
        dP: Any = x[:-1].reshape(self.level.P.shape)
        dH = film.deflect(dP).reshape(dP.shape) - x[-1]
        fields = others.reshape(-1, *dP.shape)
        changes = [part.of_unknowns(system, fields, dP, dH) for part in self._parts]
        log_eps, ratio = (sum(one[k] for one in changes) for k in (0, 1))
        return layer_behind(self.level, film.c_t, dP, dH, log_eps, ratio, layer)

    def _respond_one_by_one(self, omega: Array, tolerance: float) -> Forces:
        """`respond` with a supply or heat: what comes later is not linear in Omega, and no space serves."""
        x = self._vector()
        Z, residual = np.empty(omega.size, dtype=complex), np.empty(omega.size)
        behind = np.empty((omega.size, self.level.inflow.size), dtype=complex)
        for k in np.argsort(omega):
            w = float(omega[k])
            system = self._equations(w)
            x = self._solve(w, system, x, SOLVE_SHARE * tolerance * min(1.0, w))
            Z[k], residual[k] = self.weights @ x[self.nodes], self._residual(system, x)
            if behind.size:
                behind[k] = self._layer_behind(system, x)
        return Forces(Z, residual, behind if behind.size else None)

    def _residual(self, system: Any, x: Complex) -> float:
        """Relative residual of the equations of the nodes with the unknowns `x`, where du is 1."""
        alone = system(self._vector())[self.nodes]
        return float(scipy.linalg.norm(system(x)[self.nodes]) / scipy.linalg.norm(alone))


def _least_squares(R: Array, w: float) -> tuple[Complex, float, float]:
    """Coefficients of the best solution at one frequency, its relative residual, and that weighted for C.

    The weight makes the imaginary part count relative to Omega: K comes from the real part, Omega C from the
    other.
    """
    matrix, rhs = R[:, 2::2] + 1j * w * R[:, 3::2], -(R[:, 0] + 1j * w * R[:, 1])
    y = np.zeros(0, dtype=complex)
    if matrix.shape[1]:
        y = scipy.linalg.lstsq(matrix, rhs, check_finite=False, lapack_driver="gelsy")[0]
    r = rhs - matrix @ y
    size = scipy.linalg.norm(rhs)
    weighted = np.hypot(scipy.linalg.norm(r.real), scipy.linalg.norm(r.imag) / min(1.0, w))
    return y, float(scipy.linalg.norm(r) / size), float(weighted / size)
