"""`TransientContact`: the transient EHL film as a force element, with the interface of a fitted element."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

from ehlcontact.checks import require_finite, require_instance, require_positive
from ehlcontact.checks.machine import require_threads
from ehlcontact.conditions import Conditions, between_smooth_surfaces
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.heat import Heat
from ehlcontact.point import OperatingPoint, Point, require_solvable, scales_of
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.quantities import FORCE, scaled
from ehlcontact.results.steady_result import grid_doubt
from ehlcontact.shear_thinning import ShearThinning
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.grid import AUTOMATIC, Grid, require_grid
from ehlcontact.solver.lowest_film import beside_lowest
from ehlcontact.solver.mesh_choice import Purpose, wider_meshes
from ehlcontact.status import Status
from ehlcontact.summary import Summary, contact_text, film_unit
from ehlcontact.supply import OilLayer
from ehlcontact.transient.features import Surface, require_surface, surface_height, surface_step
from ehlcontact.transient.time_step import DEFAULT_TOL
from ehlcontact.transient.transient_film import FilmState, Step, TransientFilm

FAR = 100.0  # dry approaches, beyond which an approach is hardly one in the units of the point


@dataclass(frozen=True, slots=True)
class ContactState(FilmState):
    """State of a film, and the time since it was at rest."""

    T: float = 0.0


class TransientContact(Summary):
    """Transient EHL contact driven by its approach, for a rotor or any other time integrator.

    It starts at rest, steady under the load of its point, whose units it has. At an `OperatingPoint` these are m,
    m/s, s and N; at a `MoesPoint` dry approaches, times of 2a/u_sum and static loads.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    grid : Grid
        Intervals along X, by default as many as the inlet needs, 80 or more; computed region, by default wide
        enough for `largest_load` and widened until it holds the film at rest; engine of the elastic deflection.
    supply : OilLayer, optional
        Oil that the surfaces carry to the contact, as in `simulate`; by default the inlet is flooded.
    surface : callable, optional
        Height added to the gap, as in `simulate`, over the time since this contact was made; it rests on it.
    thermal : Heat, or True for ``Heat()``, optional
        Let the film heat up, as in `simulate`.
    sliding : ShearThinning, optional
        Shear thinning of the film by sliding, as in `simulate`.
    largest_load : float
        Largest force to expect, in static loads.
    tol : float
        Residual at which a step counts as solved, relative to the central film at rest. The approach is given, so
        the error of the force falls with the motion, and there is nothing for it to follow as in `simulate`.
    threads : int, optional
        As in `solve_steady`.

    Attributes
    ----------
    tol : float
        As given.
    units : {"SI", "dimensionless"}
        Those of the point.
    force : float
        Of the film [N; static load].
    static_approach : float
        Approach at rest under the load of the point [m; dry approach].
    h_central, h_min : float
        Film in the centre, and the smallest [m; dry approach].
    film_error : ErrorEstimate or None
        How far approach [m; dry approach] and films at rest may be from those of an endless fine mesh on the same
        region; None without a coarser grid to compare with.

    Raises
    ------
    InputError
        An argument outside its range; a grid that would not fit into memory, or does not resolve the surface.
    ConvergenceError
        The steady state at the start did not converge.
    """

    @between_smooth_surfaces
    @one_blas_thread()
    def __init__(
        self,
        point: Point,
        *,
        grid: Grid = AUTOMATIC,
        supply: OilLayer | None = None,
        surface: Surface | None = None,
        thermal: Heat | bool | None = None,
        sliding: ShearThinning | None = None,
        largest_load: float = 1.0,
        tol: float = DEFAULT_TOL,
        threads: int | None = None,
    ) -> None:
        load = require_positive("largest_load", largest_load)
        moes = require_solvable(point, load)
        self.point, self.scales = point, point.scales
        require_grid(grid)
        conditions = Conditions.of(supply=supply, thermal=thermal, sliding=sliding).at(point)
        require_surface(surface, point)
        self._surface, self._T = surface, 0.0
        self.tol = tol = require_positive("tol", tol)
        threads = require_threads("threads", threads)
        left: Step | None = None
        for mesh in wider_meshes(moes, Purpose.CONTACT, grid, largest_load=load):
            given = (conditions, moes, scales_of(point), mesh, tol, grid.deflection, threads)
            self._film = TransientFilm.under(*given)
            self.n, self.domain = mesh.n, mesh.domain
            level = self._film.level
            start = self._film.start_steady(
                Balance.of_load(), surface=surface_height(surface, level.X, level.Y, 0.0)
            )
            if start.status not in (Status.OUT_OF_DOMAIN, Status.BEYOND_REGION):
                break
            left = left or start
        self._check(start if start.status.ok else left or start)
        error = self._film.error_at_rest(Balance.of_load())
        self.film_error = None if error is None else replace(error, **scaled(error, self.scales))
        self.static_approach = self._film.u * self.scales.length

    def _summary_lines(self) -> list[str]:
        size, unit = film_unit(self.point)
        force = f"{self.force:.5g} {FORCE.unit_at(self.point)}"
        return [
            contact_text(self.point),
            f"whole film on n = {self.n}, x from {self.domain.x_in:g} to {self.domain.x_out:g} semi-axes",
            f"now: force {force}, film {size * self.h_central:.4g} {unit} in the centre, "
            f"{size * self.h_min:.4g} {unit} at least",
            f"at rest approach {size * self.static_approach:.5g} {unit}",
            *filter(None, [self.reservation]),
        ]

    @property
    def units(self) -> str:
        """Those of the point: "SI" or "dimensionless"."""
        return "SI" if isinstance(self.point, OperatingPoint) else "dimensionless"

    @property
    def coarseness(self) -> float:
        """`tol` over its default: how much coarser the force is than usual."""
        return self.tol / DEFAULT_TOL

    @property
    def reservation(self) -> str:
        """Where the grid does not show the film at rest, in words; else empty."""
        return grid_doubt(self.film_error, "at rest")

    @one_blas_thread()
    def advance(self, dt: float, approach: float, rate: float = 0.0) -> float:
        """Move to `approach` [m; dry approach] within `dt` [s; 2a/u_sum]: force at the end of the step.

        The film equations need the approach at both ends only; `rate` belongs to the common interface of
        contacts and is not used.

        Raises
        ------
        InputError
            dt not positive, or approach not finite.
        ConvergenceError
            The step was not solved; ``error.result`` is the `Step`, and the contact is left unchanged.
        """
        dT = require_positive("dt", dt) / self.scales.time
        u = require_finite("approach", approach) / self.scales.length
        require_finite("rate", rate)
        film, T = self._film, self._T + dT
        feature = surface_step(self._surface, film.level.X, film.level.Y, T, dT, film.last_step)
        state = film.save_state()
        try:
            self._check(film.advance(dT, Balance.of_approach(u), u, feature), self._unit_hint(u))
        except ConvergenceError:
            film.restore_state(state)
            raise
        self._T = T
        return self.force

    @property
    def force(self) -> float:
        """Force of the film [N; static load]."""
        return self._film.level.force() * self.scales.force

    @property
    def h_central(self) -> float:
        """Film at the centre of the contact [m; dry approach]."""
        return self._film.level.central_film() * self.scales.length

    @property
    def h_min(self) -> float:
        """Smallest film [m; dry approach]."""
        return self._film.level.lowest_film() * self.scales.length

    @property
    def beside_h_min(self) -> float:
        """Film at the nodes beside the lowest one along X, over its own: near 1 where the grid resolves it."""
        return beside_lowest(self._film.level.H)

    def save_state(self) -> ContactState:
        """Everything needed to come back to the present."""
        film = self._film.save_state()
        return ContactState(**{one.name: getattr(film, one.name) for one in fields(film)}, T=self._T)

    @one_blas_thread()
    def restore_state(self, state: ContactState) -> None:
        """Return to a saved state; raises `InputError` for one of another contact."""
        require_instance("state", state, ContactState, "what save_state made")
        if state.P.shape != self._film.level.P.shape:
            raise InputError("state", f"of {state.P.shape} nodes", f"one of this grid, {self._film.level.P.shape}")
        if [type(one) for one in state.effects] != [type(effect.saved) for effect in self._film.effects]:
            raise InputError("state", "of other conditions", "one of this contact, with its heat and sliding")
        self._film.restore_state(state)
        self._T = state.T

    def _check(self, step: Step, hint: str = "") -> None:
        if step.status is not Status.CONVERGED:
            raise ConvergenceError(f"EHL step {step.status}: {step.status.advice}{hint}", step)

    def _unit_hint(self, u: float) -> str:
        """For a step that fails: what the units are, where `u` dry approaches are none of the contact's."""
        if abs(u) < FAR or self.units != "SI":
            return ""
        rest = f"{self.static_approach:.3g} m at rest"
        return f" Are the units right? approach = {u * self.scales.length:.3g} m here ({rest}), dt counts in s."
