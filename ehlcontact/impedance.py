"""`impedance`: stiffness and damping over frequency of the linearised steady contact.

A harmonic approach ``u + du exp(i Omega T)`` makes a pressure ``P + dP exp(i Omega T)`` with

    (J + i Omega B) dP = -(j + i Omega b) du      on the nodes with P > 0,

J and j being the derivatives of the steady Reynolds operator to P and u with full elasticity, B and b those of
the squeeze term. The impedance is ``Z(Omega) = 3/(2 pi) iint dP / du = K + i Omega C``: force over displacement,
the dynamic stiffness, not the mechanical impedance (force over velocity).

Both grids of half and a quarter of the intervals give an error estimate of K and C (`solver.error_grids`).

A few frequencies are solved. In the space of the real and imaginary parts of their solutions every other one is a
small least-squares problem, whose residual is the error measure: the frequency with the largest is solved next.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks.frequency import by_name, dimensionless
from ehlcontact.checks.machine import require_threads
from ehlcontact.conditions import FLOODED, Conditions
from ehlcontact.errors import ConvergenceError
from ehlcontact.heat import Heat
from ehlcontact.point import Point, require_solvable, scales_of
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.results import ImpedanceResult, SteadyResult
from ehlcontact.results.impedance_result import SLOW
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.error_estimate import response_error
from ehlcontact.solver.error_grids import settled_on_half
from ehlcontact.solver.film_heat import FilmHeat, FollowedViscosity
from ehlcontact.solver.grid import AUTOMATIC, Grid, require_grid
from ehlcontact.solver.linear import LinearFilm, NearCorrection, Preconditioner, solve_linear
from ehlcontact.solver.linear_heat import HeatedPreconditioner, HeatedSystem, LinearHeat
from ehlcontact.solver.mesh import Mesh, Solve
from ehlcontact.solver.mesh_choice import Purpose, wider_meshes
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.status import Status
from ehlcontact.steady import solve_steady
from ehlcontact.supply import OilLayer

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

TOLERANCE = 1e-5  # of the linear residuals; C is then within 3e-4 of the exact solve up to Omega = 30
LARGEST_OMEGA = 200.0
NEAR_ZERO = 1e-4  # where C(0) is evaluated
PRESCRIBED = Balance.of_approach(0.0)
KEEP_FACTORS = 5.0  # change of Omega for which the factors of short waves serve
MANY_NODES = 70_000  # beyond, factors of one band of frequencies are kept at a time: they take gigabytes
SOLVE_SHARE = 0.3  # of the tolerance, for the solves themselves
LEAST_INTERVALS = 12  # of the coarser grids that tell the error
SLOW_SHARE = 0.1  # of C at low frequency that is not in C at `SLOW`, from which it is slow oil: else 7 % at most
COARSE_CYCLES = 3  # of a coarser film with heat, after those at the viscosity of the finer one
SMALLEST_NEW_PART = 1e-10  # of a vector, outside the space so far


@by_name(1)
@one_blas_thread()
def impedance(
    point: Point,
    *,
    Omega: ArrayLike | None = None,
    omega: ArrayLike | None = None,
    hz: ArrayLike | None = None,
    rpm: ArrayLike | None = None,
    grid: Grid = AUTOMATIC,
    supply: OilLayer | None = None,
    thermal: Heat | bool | None = None,
    threads: int | None = None,
) -> ImpedanceResult:
    """Linearise the converged steady contact and return K(Omega) and C(Omega).

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    Omega, omega, hz, rpm : float or sequence of float
        Frequencies, in exactly one of these: dimensionless (time unit 2a/u_sum, from 0 to 200) at every point; at
        an `OperatingPoint` also in rad/s, Hz or rev/min.
    grid : Grid
        Intervals along X, by default as many as the inlet needs, 80 or more; computed region, by default that of
        `solve_steady` (C depends on it by about 1/extent^2); engine of the elastic deflection.
    supply : OilLayer, optional
        Oil that the surfaces carry to the contact, as in `solve_steady`. The front of the full film moves with the
        approach: the oil that it takes up and leaves behind is part of the problem.
    thermal : Heat, or True for ``Heat()``, optional
        Let the film heat up, as in `solve_steady`; its temperatures follow the vibration as fast as oil and
        surfaces can (docs/heat.md).
    threads : int, optional
        As in `solve_steady`.

    Raises
    ------
    InputError
        Frequencies not given in exactly one way, in SI at a dimensionless point, not finite, negative or above
        Omega = 200; a grid that would not fit into memory; more threads than cores.
    ConvergenceError
        The steady state did not converge.
    """
    started = time.perf_counter()
    moes, scales = require_solvable(point), scales_of(point)
    time_unit = None if scales is None else scales.time
    w = dimensionless(time_unit, Omega=Omega, omega=omega, hz=hz, rpm=rpm, most=LARGEST_OMEGA)
    require_grid(grid)
    threads = require_threads("threads", threads)
    meshes = wider_meshes(moes, Purpose.DAMPING, grid, solve=Solve.IMPEDANCE)
    conditions = Conditions.of(supply=supply, thermal=thermal).at(point)
    steady = film_to_linearise(point, meshes, grid.deflection, threads, conditions)
    moving = np.maximum(w, NEAR_ZERO)
    solved = held(steady, grid.deflection, threads)
    contact = linearised(steady, solved)
    Z, residual = contact.respond(moving, TOLERANCE)
    coarser = [other.respond(moving, TOLERANCE)[0] for other in coarser_contacts(steady, solved)]
    bars = response_error(moving, [Z, *coarser])
    # A front of full film is slow by itself
    heated = conditions.heat is not None
    still = LinearisedContact(solved) if heated and supply is not None else None
    by_slow_oil = 0.0 if not heated else slow_part(contact, moving, Z.imag / moving, still)
    return ImpedanceResult(
        point=moes,
        scales=scales,
        domain=steady.domain,
        n=steady.n,
        Omega=w,
        stiffness=Z.real.copy(),
        damping=Z.imag / moving,
        stiffness_error=bars[0],
        damping_error=bars[1] + by_slow_oil,
        residual=residual,
        approach=steady.approach,
        h_central=steady.h_central,
        h_min=steady.h_min,
        moment=steady.moment,
        supply=supply,
        temperature=steady.temperature,
        seconds=time.perf_counter() - started,
    )


def film_to_linearise(
    point: Point,
    meshes: Iterable[Mesh],
    deflection: str,
    threads: int,
    conditions: Conditions = FLOODED,
) -> SteadyResult:
    """The film to linearise, on the first of the meshes whose region holds it."""
    for mesh in meshes:
        own = Grid(mesh.n, mesh.domain, deflection)
        steady = solve_steady(point, grid=own, threads=threads, throw=False, **conditions.keywords)
        if steady.status not in (Status.OUT_OF_DOMAIN, Status.BEYOND_REGION):
            break
    if steady.status is Status.INTERRUPTED:
        raise KeyboardInterrupt  # there is nothing to keep: no frequency has been looked at
    if not steady.status.ok:
        raise ConvergenceError(f"steady solve {steady.status}: {steady.status.advice}", steady)
    return steady


def held(film: SteadyResult, deflection: str = "fft", threads: int = 1) -> Multigrid:
    """Levels that hold a steady film, `deflection` and `threads` as in `solve_steady`."""
    mesh = Mesh(film.n, film.domain, film.point.kappa)
    layer = film.layer
    supply = None if layer is None else lambda Y: np.interp(Y, film.Y, layer)
    multigrid = Multigrid(film.point, mesh, deflection=deflection, threads=threads, supply=supply)
    multigrid.finest.P[...] = film.P.T
    multigrid.u = film.approach
    multigrid.finest.update(multigrid.u)
    if (heat := heat_of(film, multigrid)) is not None:
        heat.set_viscosity(multigrid)
    return multigrid


def heat_of(film: SteadyResult, multigrid: Multigrid) -> FilmHeat | None:
    """Temperatures of a steady film on levels that hold it, or its coarser image; None of an isothermal one.

    A coarser image is solved with temperatures of its own.
    """
    found, level = film.temperature, multigrid.finest
    if found is None:
        return None
    assert film.scales is not None
    heat = FilmHeat(level, found.inputs.numbers(film.point, film.scales))
    if level.P.shape == film.P.T.shape:
        heat.walls[...] = found.surfaces.transpose(0, 2, 1)
        heat.rise[...] = found.mean.T - heat.walls.mean(axis=0)
    else:
        FollowedViscosity(multigrid, heat).settle(Balance.of_load(), COARSE_CYCLES)
    return heat


def coarser_films(solved: Multigrid) -> Iterator[Multigrid]:
    """The film on half and a quarter of the intervals, as far as they tell an error.

    A film that is negative somewhere still tells it on half of them, not on a quarter.
    """
    multigrid = solved
    for first in (True, False):
        if multigrid.mesh.n // 2 < LEAST_INTERVALS:
            return
        multigrid = settled_on_half(multigrid, Balance.of_load())
        lowest = multigrid.finest.H.min()
        if not np.isfinite(lowest) or not (first or lowest > 0.0):
            return
        yield multigrid


def coarser_contacts(film: SteadyResult, solved: Multigrid) -> Iterator[LinearisedContact]:
    """Derivatives at the `coarser_films`, as far as they have temperatures."""
    for multigrid in coarser_films(solved):
        with np.errstate(over="ignore", invalid="ignore"):  # of a coarse film that runs away
            heat = heat_of(film, multigrid)
        if heat is not None and not (np.isfinite(heat.rise).all() and np.isfinite(heat.walls).all()):
            return
        yield LinearisedContact(multigrid, heat)


def linearised(film: SteadyResult, multigrid: Multigrid) -> LinearisedContact:
    """Derivatives of a contact at a steady film on levels that hold it, or its coarser image."""
    return LinearisedContact(multigrid, heat_of(film, multigrid))


def slow_part(
    contact: LinearisedContact, omega: Array, damping: Array, still: LinearisedContact | None = None
) -> Array:
    """What oil that heats and cools slowly may add to C at low frequencies, (k,); 0 where it is not seen.

    It is what C changes below `SLOW`, less what it changes with temperatures that stand `still`, where given.

    Far ahead of the contact hot oil flows back beside colder oil that flows forward. Oil that warms flows back
    more and brings more heat: on few grids a line of nodes between both is near the end of its balance, and its
    temperature has a rate of some thousandths. Another n has none of it.
    """
    low, part = omega < SLOW, np.zeros_like(omega)
    if low.any():
        w = np.append(omega[low], SLOW)
        C = np.append(damping[low], contact.respond(w[-1:], TOLERANCE)[0].imag / SLOW)
        if still is not None:
            C -= still.respond(w, TOLERANCE)[0].imag / w
        part[low] = np.abs(C[:-1] - C[-1])
    return np.where(part > SLOW_SHARE * np.abs(damping), part, 0.0)


class LinearisedContact:
    """Derivatives of the contact at its steady state.

    Vectors hold the m nodes with P > 0. Sparse factors, for the short waves, serve a band of frequencies; dense
    ones, for the long waves, are made at each.

    Parameters
    ----------
    multigrid : Multigrid
        It holds the steady state: P, film and flow of its finest level, approach.
    heat : FilmHeat, optional
        Temperatures of its finest level, which follow the vibration; by default they stand still.
    """

    def __init__(self, multigrid: Multigrid, heat: FilmHeat | None = None) -> None:
        self._multigrid, self._heat = multigrid, heat
        level = self.level = multigrid.finest
        self._free = level.P > 0.0
        self.nodes = np.flatnonzero(self._free)
        self.weights = level.force_weights.ravel()[self.nodes]
        self._steady, self._unit = (LinearFilm(level, self._free, PRESCRIBED, c_t) for c_t in (0.0, 1.0))
        self.j = self._steady.by_approach[self.nodes]
        self.b = self._unit.by_approach[self.nodes] - self.j
        self._row_scale = 1.0 / np.abs(self._steady.diagonal()[self.nodes])
        self._near: list[tuple[float, NearCorrection]] = []

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
        return self._solve(omega, x, tolerance)[self.nodes]

    def _vector(self) -> Complex:
        """Unknowns at rest, with du = 1."""
        x = np.zeros(self._free.size * (1 if self._heat is None else 2) + 1, dtype=complex)
        x[self._free.size] = 1.0
        return x

    def _solve(self, omega: float, start: Complex, tolerance: float) -> Complex:
        """All unknowns at one frequency, improving on `start`, where du is 1."""
        system = self._equations(omega)
        b: NDArray[Any] = -system(start)
        b[self._free.size] = 0.0
        drop = tolerance * scipy.linalg.norm(self.j + 1j * omega * self.b) / scipy.linalg.norm(b)
        return np.asarray(start + self.change(omega, system, b, drop))

    def system(self, omega: float) -> LinearFilm:
        """Equations of a vibration of one frequency, at given viscosity."""
        return LinearFilm(self.level, self._free, PRESCRIBED, 1j * omega)

    def _equations(self, omega: float) -> Any:
        """The same, with temperatures that follow where there is heat."""
        film = self.system(omega)
        return film if self._heat is None else HeatedSystem(film, LinearHeat(self._heat, omega))

    def change(self, omega: float, system: LinearFilm | HeatedSystem, b: NDArray[Any], rtol: float) -> Complex:
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

    def respond(self, omega: Array, tolerance: float) -> tuple[Complex, Array]:
        """Impedance at each frequency > 0, and the relative residual of its linear system, both (k,).

        `tolerance` is for the residuals, their imaginary part counted relative to Omega below Omega = 1. Where
        a solve fails to reach it, the residual returned is larger.
        """
        if self.level.inflow.size or self._heat is not None:
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
                return Z, np.array([r for _, r, _ in solutions])
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

    def force_of(self, omega: Array, source: Callable[[LinearFilm, int], NDArray[Any]]) -> tuple[Complex, Array]:
        """Force by a source in Reynolds' equation at fixed approach, and relative residuals, both (k,).

        ``source(system, m)`` is its value at all nodes, flat, for the m-th of the frequencies.
        """
        force, residual = np.empty(omega.size, dtype=complex), np.empty(omega.size)
        for m in np.argsort(omega):
            w = float(omega[m])
            system = self.system(w)
            b: NDArray[Any] = np.zeros(self._free.size + 1, dtype=complex)
            b[self.nodes] = source(system, int(m))[self.nodes]
            x: NDArray[Any] = self.change(w, system, b, SOLVE_SHARE * TOLERANCE * min(1.0, w))
            force[m] = self.weights @ x[self.nodes]
            residual[m] = scipy.linalg.norm(b - system(x)) / scipy.linalg.norm(b)
        return force, residual

    def _respond_one_by_one(self, omega: Array, tolerance: float) -> tuple[Complex, Array]:
        """`respond` with a supply or heat: what comes later is not linear in Omega, and no space serves."""
        x = self._vector()
        Z, residual = np.empty(omega.size, dtype=complex), np.empty(omega.size)
        for k in np.argsort(omega):
            w = float(omega[k])
            x = self._solve(w, x, SOLVE_SHARE * tolerance * min(1.0, w))
            Z[k], residual[k] = self.weights @ x[self.nodes], self.residual(w, x)
        return Z, residual

    def residual(self, omega: float, x: Complex) -> float:
        """Relative residual of the equations of the nodes with the unknowns `x`, where du is 1."""
        system = self._equations(omega)
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
