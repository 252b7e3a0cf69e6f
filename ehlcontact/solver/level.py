"""Levels of the multigrid hierarchy: arrays and equations on one mesh each, ordered from coarse to fine."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.hertz import shape_factor
from ehlcontact.lanes import LANES
from ehlcontact.point import MoesPoint
from ehlcontact.process.threads import CALLING_THREAD, Kernel, team_of
from ehlcontact.solver.deflection import make_deflection
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.grid_rules import LINES_APART, is_long, longer_axis
from ehlcontact.solver.kernels import cavitation, flanks, fronts, relax, reynolds, supply
from ehlcontact.solver.kernels.linearise import NEIGHBOURS
from ehlcontact.solver.lowest_film import lowest_film
from ehlcontact.solver.mesh import Mesh

Array = NDArray[np.float64]

FLANK_SQUEEZE = 0.5  # squeeze term over wedge term, above which a step needs few passes along the flanks
STANDSTILL = 1e-9  # speed that is as good as none, and keeps sweeps from a division by zero
STANDSTILL_FRONT = 1e-6  # the same where oil runs short: flows over it, at fronts, keep ten digits
FORCE_FACTOR = 1.5 / np.pi  # eq. 4: force = 3/(2 pi) iint P
LEAST_ACROSS = 4  # intervals along Y of the coarsest level
SHARED_FROM = 20000  # nodes: on smaller levels threads wait longer for each other than they work
LIGHT = 128  # lines of the smallest chunk of a light kernel: with fewer it is done before another thread wakes
# Lines of a block of local passes: more than they reach beyond it, so that every other one is apart. Side lobes of
# a long contact lie across all lines, which are one block there: of several, cycles leave a hundred times more.
BLOCK = 24
SLOW_FRONT = 0.1  # speed below which differences carry a feature: what steps before have moved is no flow
STARVED_SHARE = 0.2  # layer over flooded film, below which a film that is not positive is for want of oil


class Fields(NamedTuple):
    """Work arrays of a level, each (ny + 1, nx + 1) unless stated; the kernels write them in place."""

    P: Array
    H: Array
    flow: reynolds.Flow
    theta: Array  # distribution weight of the relaxation
    w: Array  # distributed change
    p_coef: Array  # (6, ny + 1, nx + 1)
    h_coef: Array  # (6, ny + 1, nx + 1)


class Fronts(NamedTuple):
    """First full nodes behind partly filled ones, arrays (k,) each (`kernels.supply`)."""

    nodes: NDArray[np.int64]  # flat numbers
    back: Array  # flow pressed back through the face before them, over a cell's area
    by_pressure: Array  # derivatives of the flow pressed back over a cell's area: to their pressure,
    by_film: Array  # to their film,
    by_film_before: Array  # and to that of the node before
    passed: Array  # way of the front over the cell between: 0 at the full node, 1 at the one before
    stored: Array  # what the first full node stores while the front passes, over the flow pressed back meanwhile


class Level:
    """One mesh of nx intervals along X and ny along Y >= 0, with its state P, H and its equations.

    The equations are ``N(P, H) = rhs`` and ``H = film_shift - u + gap + deflection(P)``; the right-hand sides
    carry history terms on the finest level and the full-approximation corrections below it. The kernels take eight
    nodes at a time, from the third on: a line has 11 intervals at least.
    """

    def __init__(self, point: MoesPoint, domain: Domain, nx: int, ny: int, deflection: str = "fft") -> None:
        if nx < LANES + 3:
            raise ValueError(f"nx = {nx}: at least {LANES + 3}")
        self.nx, self.ny = nx, ny
        self.X = np.linspace(domain.x_in, domain.x_out, nx + 1)
        self.Y = np.linspace(0.0, domain.y_max, ny + 1)
        self.hx, self.hy = (domain.x_out - domain.x_in) / nx, domain.y_max / ny
        self.speed = 1.0
        self.set_point(point)
        S = shape_factor(point.kappa)
        self.gap = S * self.X**2 + (1.0 - S) * self.Y[:, None] ** 2
        self.team = CALLING_THREAD
        self.block = ny if is_long(point) else BLOCK
        self.passes = flanks.passes_of(nx, is_long(point))
        self.deflection = make_deflection(nx, ny, self.hx, self.hy, point.kappa, deflection)
        self.near = self.deflection.kernel[: relax.NEAR + 2, : relax.ALONG + 2].copy()
        shape = (ny + 1, nx + 1)
        self.fields = Fields(
            P=np.zeros(shape),
            H=np.zeros(shape),
            flow=reynolds.new_flow(shape),
            theta=np.zeros(shape),
            w=np.zeros(shape),
            p_coef=np.zeros((NEIGHBOURS, *shape)),
            h_coef=np.zeros((NEIGHBOURS, *shape)),
        )
        self.rhs = np.zeros(shape)
        # Where oil runs short: the layer that enters, what differences make a full gap carry too much of a feature
        # and what the surfaces carry through the face behind each node, what its cell holds, and right-hand sides
        self.inflow = np.zeros(0)
        self.excess, self.carried, self.stored, self.supplied = (np.zeros((0, 0)) for _ in range(4))
        self.film_shift: Array | float = 0.0
        self.asperity_load = 0.0  # that is carried beside the film
        self.c_t = 0.0
        self.r = np.zeros(shape)  # residual of the Reynolds equation, zero on the border
        self.marks = np.zeros(shape, dtype=np.uint8)
        self.nodes = np.zeros(shape[0] * shape[1], dtype=np.int64)
        self.couplings = np.zeros((self.nodes.size, cavitation.COUPLINGS))
        self.force_weights = np.full(shape, 2.0 * FORCE_FACTOR * self.hx * self.hy)
        self.force_weights[0] *= 0.5

    def share(self, threads: int) -> None:
        """Let so many threads do the work on this level, if it is large enough for more than one."""
        if self.gap.size >= SHARED_FROM:
            self.team = self.deflection.team = team_of(threads)

    def set_point(self, point: MoesPoint) -> None:
        """Numbers that the kernels need at `point`, whose kappa must be that of the level."""
        self.M, self.kappa = point.M, point.kappa
        self.law, self.expected_film = point.law, point.inlet_width**1.5
        self.stencil = reynolds.Stencil(
            cx=self.hx**-2,
            cy=point.kappa**2 * self.hy**-2,
            inv_hx=self.speed / self.hx,
            lam=point.lam,
            speed=self.speed,
            # On a mesh finer along X, smooth changes of P deflect the film further beyond the near coefficients.
            crowding=max(1.0, 0.5 * self.hy / (point.kappa * self.hx)),
        )

    def set_speed(self, speed: float) -> None:
        """Let the surfaces move at `speed`, over that of the operating point; 0 is taken as `STANDSTILL`."""
        self.speed = max(speed, STANDSTILL_FRONT if self.inflow.size else STANDSTILL)
        self.stencil = self.stencil._replace(speed=self.speed, inv_hx=self.speed / self.hx)

    def set_supply(self, layer: Array | None) -> None:
        """Let a layer of this thickness enter on each line, shape (ny + 1,), or a full gap for None."""
        if layer is None:
            if self.inflow.size:
                supply.open_faces(0, self.ny, self.fields.flow)
            self.inflow = np.zeros(0)
            return
        if not self.carried.size:
            self.excess, self.carried, self.stored, self.supplied = (np.zeros_like(self.rhs) for _ in range(4))
        self.inflow = layer

    def empty_inlet(self, u: float) -> None:
        """Take the pressure away where the gap is much wider than the layer, as a start; P, H written."""
        self.update_film(u)
        most = supply.FRONT_GAP * max(1.0, self.kappa**-supply.WIDER_GAP)
        self.P[(most * self.inflow[:, None] < self.H) & (self.X < 0.0)] = 0.0

    @property
    def front_beyond_border(self) -> bool:
        """Whether a film is full up to the inlet border, where the layer does not fill the gap."""
        if not self.inflow.size:
            return False
        return bool(((self.P[:, 1] > 0.0) & (self.inflow < self.full_flow()[:, 0])).any())

    @property
    def starves(self) -> bool:
        """Whether the layer is a small part of the flooded film."""
        return bool(self.inflow.size) and self.inflow.max() < STARVED_SHARE * self.expected_film

    @property
    def supply_arrays(self) -> tuple[Array, ...]:
        """What the passes along the cavitation boundary carry a supply with, or go without one."""
        return self.rhs, self.inflow, self.excess, self.carried, self.stored, self.given

    @property
    def oil(self) -> Array:
        """What the cell of each node holds, over its area: what changes in time in the equations."""
        return self.stored if self.inflow.size else self.fields.flow.mass

    @property
    def given(self) -> Array:
        """Right-hand side of `reynolds.operator_at`, with what partly filled nodes carry."""
        return self.supplied if self.inflow.size else self.rhs

    def full_flow(self, mass: Array | None = None) -> Array:
        """Couette flow of a full gap, or of a given `mass`, through the face behind each node; 0 of the last."""
        m = self.fields.flow.mass if mass is None else mass
        full = np.zeros_like(m)
        full[:, 1:-1] = (2.0 * m[:, 2:] + 5.0 * m[:, 1:-1] - m[:, :-2]) / 6.0
        full[:, 0] = (2.0 * m[:, 0] + 5.0 * m[:, 1] - m[:, 2]) / 6.0
        return full - self.excess if mass is None and self.inflow.size else full

    def carry_exactly(self, content: Array, history: Array, rate: Array) -> None:
        """Let films pass on a `content` of the gap as it moves, where oil runs short.

        A feature much deeper than the film would lose some of it by differences, the more the less smooth it is:
        ``d(content)/dX + d(content)/dT`` is to be `rate`, and what is off is taken out of the flow of a full gap,
        so that no oil is lost; not where the surfaces all but stand. `history` as of `transport`. That flow is
        known but for a constant on each line: its mean is that of a derivative, 0.
        """
        self.excess[...] = 0.0
        if self.speed < SLOW_FRONT:
            return
        off = np.cumsum(self.transport(content, history) - rate, axis=1) * (self.hx / self.speed)
        off -= off.mean(axis=1, keepdims=True)
        self.excess[...] = off * self.full_flow(self.density())

    def leaving(self) -> Array:
        """Layer that the surfaces carry away on each line, shape (ny + 1,); empty where the inlet is flooded.

        The last line, on the border, takes that of the line before it.
        """
        if not self.inflow.size:
            return np.zeros(0)
        behind = self.carried[:, -2].copy()
        behind[-1] = behind[-2]
        return behind

    def restrict_supply(self, fine: Level) -> None:
        """Take over from `fine` how much is missing of a full gap; rhs, of a full film, gets what goes with it.

        The flow of this level belongs to its restricted pressure and film, with all faces open.
        """
        if not fine.inflow.size:
            self.set_supply(None)
            return
        across, along = fine.ny // self.ny, fine.nx // self.nx
        missing = fine.full_flow()[:, 0]
        short = np.zeros_like(self.rhs)
        short[:-1, :-1] = (fine.full_flow() - fine.carried)[:-1:across, :-1:along]
        self.rhs[:-1, 1:-1] += (short[:-1, 1:-1] - short[:-1, :-2]) / (self.hx / self.speed)
        full = self.full_flow()
        self.set_supply(full[:, 0] - (missing - fine.inflow)[::across])
        if self.c_t > 0.0:
            f = self.fields
            supply.store_supply(0, self.ny, f.P, f.flow, self.stencil, full - short, self.stored)
            self.rhs[:-1, 1:-1] += self.c_t * (f.flow.mass - self.stored)[:-1, 1:-1]
        self._carry_supply()

    def feeds(self, derivatives: tuple[Array, Array]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Flat numbers of partly filled nodes with flow by pressure into them, and of the full ones that get it.

        `derivatives` at the former are written: those of that flow. Both empty where oil does not run short.
        """
        if not self.inflow.size:
            return np.zeros(0, np.int64), np.zeros(0, np.int64)
        f, target = self.fields, np.empty(self.rhs.shape, np.int64)
        supply.linearise_pressed_in(f.P, f.flow, self.stencil, *derivatives, target)
        feeding = np.flatnonzero(target >= 0)
        return feeding, target.ravel()[feeding]

    def fronts(self) -> Fronts:
        """Where full film begins behind partly filled nodes."""
        f = self.fields
        before = np.flatnonzero(f.flow.open.ravel() <= 0.0)
        slopes = np.empty((4, before.size))
        supply.linearise_pressed_back(before, f.P, f.flow, self.stencil, slopes)
        full = self.full_flow().ravel()
        back = self.hx / self.speed * slopes[3]
        given = self.carried.ravel()[before] - back
        room, own = full[before] - given, f.flow.mass.ravel()[before + 1]
        stored = (own - 0.5 * (given + full[before + 1])) / room
        return Fronts(before + 1, slopes[3], slopes[0], slopes[1], slopes[2], back / room, stored)

    @property
    def P(self) -> Array:
        """Pressure."""
        return self.fields.P

    @property
    def H(self) -> Array:
        """Film thickness."""
        return self.fields.H

    def force(self) -> float:
        """Force ``3/(2 pi) iint P`` (eq. 4), with what asperities carry."""
        return float(np.vdot(self.force_weights, self.fields.P)) + self.asperity_load

    def update_film(self, u: float) -> None:
        """H from P and the approach u (eq. 3)."""
        np.add(self.gap, self.film_shift - u, out=self.fields.H)
        self.fields.H[...] += self.deflection(self.fields.P)

    def update(self, u: float) -> Array:
        """Film, flow and residual from P and the approach u; returns ``self.r``."""
        self.update_film(u)
        return self.update_residual()

    def update_residual(self) -> Array:
        """Flow and residual ``rhs - N(P, H)`` from P and H; returns ``self.r``."""
        f = self.fields
        self._update_flow()
        given = (f.P, f.flow, self.stencil, self.c_t, self.given, self.r)
        self.team.run(reynolds.residual_lines, self.ny, *given, least=LIGHT)
        return self.r

    def full_film_residual(self) -> Array:
        """As `update_residual`, of a film that is full wherever it is."""
        self.set_supply(None)
        return self.update_residual()

    def _update_flow(self) -> None:
        f = self.fields
        self.team.run(reynolds.update_lines, self.ny + 1, f.P, f.H, self.law, self.stencil, f.flow)
        self.team.run(reynolds.update_between_lines, self.ny, f.flow, least=LIGHT)
        self._carry_supply()

    def _carry_supply(self) -> None:
        f = self.fields
        if self.inflow.size:
            given = (f.P, f.flow, self.rhs, self.inflow, self.excess, self.stencil, self.c_t)
            written = (self.carried, self.stored, self.supplied)
            self.team.run(supply.carry_supply, self.ny, *given, *written, least=LIGHT)

    def density(self) -> Array:
        """Density at the present P, over ambient density."""
        self._update_flow()
        return self.fields.flow.rho

    def transport(self, content: Array, history: Array) -> Array:
        """Discrete ``d(content)/dX + d(content)/dT``; `history` is the known part of the latter, as in `rhs`."""
        change = np.zeros_like(content)
        reynolds.transport(content, self.stencil, self.c_t, history, change)
        return change

    def dry_residual(self) -> float:
        """Mean |residual| of the dry Hertz pressure on this grid, the scale of all others; P and H written."""
        self.set_dry_hertz()
        self.update(1.0)
        return self.residual_norm()

    def central_film(self) -> float:
        """Film at X = Y = 0, by quadratic interpolation where no node lies there."""
        i = int(np.clip(np.searchsorted(self.X, 0.0) - 1, 1, self.nx - 2))
        s = -self.X[i] / self.hx
        left, centre, right = self.H[0, i - 1 : i + 2]
        return float(centre + 0.5 * s * (right - left) + 0.5 * s * s * (right - 2.0 * centre + left))

    def lowest_film(self) -> float:
        """Smallest film, between the nodes too; not above that of the lowest node."""
        return lowest_film(self.H)[0]

    def residual_norm(self) -> float:
        """Mean of |r| over the nodes of the whole domain with P > 0, from the last `update`."""
        wet = self.force_weights * (self.fields.P > 0.0)
        total = float(wet.sum())
        return float(np.vdot(wet, np.abs(self.r))) / total if total > 0.0 else 0.0

    def relax(self) -> None:
        """One relaxation sweep from the state of the last `update`; P written, the rest left to the next one."""
        f, numbers, lines = self.fields, self.stencil, self.ny
        self._weigh()
        for colour in (0, 1):
            if colour == 1:
                self._update_flow()
            groups = -(-((lines + 1 - colour) // 2) // LANES)
            self.team.run(relax.relax_lines, groups, colour, f, self.given, numbers, self.c_t, self.near, least=1)
            self.team.run(relax.apply_lines, lines, colour, f, self.near)
        own = self.near[0, 0]
        if self.inflow.size:
            work = (f.theta, f.w)
            self._run_blocks(fronts.settle_fronts, f.P, f.flow, self.supply_arrays, numbers, self.c_t, own, *work)
        given = (f.P, f.H, f.flow, self.supply_arrays, self.law, numbers, self.c_t, own)
        self._run_blocks(cavitation.relax_boundary_blocks, *given, (self.nodes, self.couplings, self.marks))

    @property
    def squeeze_dominates(self) -> bool:
        """Whether a step in time is so short that its squeeze term holds the flanks, once they are right."""
        return self.c_t > FLANK_SQUEEZE * 1.5 * self.stencil.inv_hx

    def relax_flanks(self) -> None:
        """Passes along the steep flanks from the state of the last `update`; P, H and flow written there."""
        self._weigh()
        given = (self.fields, self.given, self.law, self.stencil, self.c_t, self.near, self.marks, self.passes)
        self._run_blocks(flanks.relax_flank_blocks, *given)

    def _run_blocks(self, kernel: Kernel, *args: Any) -> None:
        """Call `kernel` on every other block of lines, which do not feel each other, then on those between."""
        blocks = -(-self.ny // self.block)
        for colour in (0, 1)[:blocks]:
            self.team.run(kernel, (blocks + 1 - colour) // 2, colour, self.block, *args, least=1)

    def relax_flanks_first(self) -> None:
        """`relax_flanks`, then `relax`: away from them the film hardly feels their distributed changes."""
        self.relax_flanks()
        self.relax()

    def _weigh(self) -> None:
        """Weights of the distributed changes, from the state of the last `update`."""
        f = self.fields
        given = (f.P, f.flow, self.stencil, self.c_t, f.theta)
        self.team.run(relax.distribution_weights, self.ny, *given, least=LIGHT)

    def set_dry_hertz(self) -> None:
        """Dry Hertz pressure, the start of every solve."""
        self.fields.P[...] = np.sqrt(np.maximum(0.0, 1.0 - self.X**2 - self.Y[:, None] ** 2))


def build_hierarchy(
    point: MoesPoint, mesh: Mesh, coarsest: int, deflection: str = "fft", across: int | None = None
) -> list[Level]:
    """Levels coarse to fine, halving the mesh while at least `coarsest` intervals are left.

    Physically, lines across a wide contact lie many node distances apart. The near coefficients of a line then
    stand for too little of what a change that is smooth along X, but differs from line to line, does to the film:
    sweeps leave such stripes (factor .96 each at kappa = .09, n = 512), and a grid with half the lines does not
    see them. One with half the nodes on every line does. So these meshes are coarsened along X until lines lie
    less than LINES_APART node distances apart.

    Where lines lie closer together than nodes (`Mesh.y_refinement`), only their number is halved at first: sweeps
    along X then relax pointwise across, and the next grid has to be coarser across only
    (`tests/benchmarks/modes.py`).

    `across` gives the intervals along Y of the finest level; there are fewer levels then where they do not halve.
    """
    n, domain = mesh.n, mesh.domain
    halvings = 0
    while (n >> halvings) % 2 == 0 and (n >> (halvings + 1)) >= coarsest:
        halvings += 1
    hx = (domain.x_out - domain.x_in) / n
    # hy as near to hx as the halvings allow, but physically no finer unless asked for: where the lines lie closer
    # together than their nodes, relaxation by lines along X fails if both meshes are halved
    hy = hx * longer_axis(point.kappa)
    if across is None:
        ny = max(LEAST_ACROSS, round(domain.y_max / hy / 2**halvings)) * 2**halvings
    else:
        ny = across // mesh.y_refinement
        while halvings and (ny % 2**halvings or ny >> halvings < LEAST_ACROSS):
            halvings -= 1
    sizes, last = [(n, ny * mesh.y_refinement)], (n >> halvings, ny >> halvings)
    while sizes[-1] != last:
        nx, ny = sizes[-1]
        if nx == n and ny * mesh.y_refinement > sizes[0][1]:
            sizes.append((nx, ny // 2))
            continue
        apart = (domain.y_max / ny) / (point.kappa * (domain.x_out - domain.x_in) / nx)
        both = apart < LINES_APART or nx == last[0]
        sizes.append((nx // 2 if nx > last[0] else nx, ny // 2 if both and ny > last[1] else ny))
    return [Level(point, domain, nx, ny, deflection) for nx, ny in reversed(sizes)]
