"""Time steps of a rotor on ball bearings, compiled. Other supports: `integrate_python`.

The step is that of `time_step`, on the displacements r of the points at which bearings act; Newton's method works
on r alone, with the exact tangents of the bearings. Rings follow r: where several are on a shaft that is rigid
along itself, there are fewer points than motions of rings. Every ring has five directions; those in which it is
held follow no point.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError
from ehlcontact.jit import inner, jit_exact_loop
from reduced_models.bearing.ball import BallFilms, films_of
from reduced_models.bearing.ball_steps import accept_balls, begin_rest, begin_step, press_balls, rest_balls
from reduced_models.bearing.compiled_list import CompiledList
from reduced_models.bearing.contact_heights import HEIGHT, find_heights
from reduced_models.bearing.freedoms import FIVE
from reduced_models.rotor.prepared_run import DISPLACEMENTS, PreparedRun
from reduced_models.rotor.time_step import Steps, rounding_hint

_Floats = NDArray[np.float64]

MOST_ITERATIONS = 30  # of a step: two or three, but where balls land
OVERSHOOT = 2.0  # growth of the imbalance that halves the way to the last place: a ball lands or leaves
# of a light ball under inner race control, say
UNBALANCED = "; friction may not hold its gyroscopic moment: another race_control, more preload"
DONE, NO_BALANCE, LOST = 0, 1, 2  # how a block of steps ends


class RingState(NamedTuple):
    """State and work of a run at its bearings: n points, 5 directions of each of b rings."""

    r: _Floats  # (3, n) at the last three ends of steps, the newest first
    force: _Floats  # (n,) of the rings on the balls, at the last end
    tried: _Floats  # (6, n), see below
    system: _Floats  # (n, n + 1) slopes of the imbalance, and the step
    turned: _Floats  # (k,) turning forces at the last end
    pushed: tuple[_Floats, _Floats, _Floats]  # of one bearing: force, stiffness, damping
    moving: NDArray[np.int64]  # (b,) directions in which each ring moves: the first ones
    ties: _Floats  # (5 b, n) motions of the rings from those of the points
    ring: _Floats  # (3, 5 b) place, rate and force of the rings
    shift: _Floats  # (5 b,) of the rings beside what the points give
    slopes: _Floats  # (5, n) work


POSITION, VELOCITY, RING_FORCE = range(3)  # rows of `ring`
R, RATE, FORCE, IMBALANCE, FREE, HISTORY = range(6)  # rows of `tried`: r, r', F, imbalance, r_free, B v_history


class CompiledSteps:
    """Steps of a run on ball bearings alone.

    Parameters
    ----------
    run : PreparedRun
    tolerance : float
        Largest imbalance over the larger of the load and the forces of the unbalances.
    """

    made = reached = 0  # steps, and the last one that was begun

    def __init__(self, run: PreparedRun, tolerance: float) -> None:
        self._run, self._tolerance = run, tolerance
        load = max(float(np.linalg.norm(run.rotor.load)), float(np.abs(run.turning).max(initial=0.0)))
        self._limits = tolerance * max(load, 1.0), run.farthest
        force = run.histories.force[0]
        self._balls = CompiledList(one.balls for one in run.balls)
        self._films = CompiledList(_films_at_rest(run, b) for b in range(len(run.balls)))
        points, self._ties, _ = run.rotor.geometry
        moving, d = np.array([len(one.directions) for one in run.balls]), len(FIVE)
        named = np.concatenate([d * b + np.arange(count) for b, count in enumerate(moving.tolist())])
        pushed = np.zeros(d), np.zeros((d, d)), np.zeros((d, d))
        r, n = points @ run.histories.displacement[0], len(points)
        ties, shift = np.zeros((d * moving.size, n)), np.zeros(d * moving.size)
        ties[named], shift[named] = self._ties, run.shift
        self._rings = RingState(
            np.tile(r, (3, 1)), self._ties.T @ force, np.zeros((6, n)), np.zeros((n, n + 1)),
            run.turning[0].copy(), pushed, moving, ties, np.zeros((3, len(ties))), shift, np.zeros((d, n)),
        )  # fmt: skip

    def advance(self, steps: Steps, first: int, end: int, progress: Callable[[int], None]) -> None:
        """Make the steps of one block; `progress` takes the number of steps made, at its end.

        Raises
        ------
        ConvergenceError
            A step found no balance, or a ring left its bearing.
        """
        run, here = self._run, slice(first + 1, end + 1)
        course = run.omega[here], run.turning[here]
        d, v, r, rate, force, iterations = (history[here] for history in run.histories)
        out = d, v, r, force, iterations
        made, how = run_block(steps, self._balls, self._films, self._rings, run.state, course, self._limits, out)
        rate[:] = v @ steps.B.T @ self._ties.T
        self.made = first + int(made)
        for one, films in zip(run.balls, self._films, strict=True):
            one.core.surfaces(one.state)["largest"][0] = films.largest
        lost = run.lost(first, self.made)
        if lost is not None:
            self.made = self.reached = lost[0]
            raise ConvergenceError(lost[1], None)
        self.reached = self.made + (how == NO_BALANCE)
        if how == NO_BALANCE:
            found = run.histories.motion[self.made]
            hint = rounding_hint(steps, found, self._limits[0], self._limits[0] / self._tolerance)
            forces = self._rings.ring[RING_FORCE].reshape(-1, len(FIVE))
            for b, name in enumerate(run.rotor.ball_bearing_names):
                if np.isnan(forces[b]).any():
                    turned = UNBALANCED if run.rotor.ball_bearings[b].z is not None else ""
                    hint = f": a ball of {name} finds none{turned}"
            raise ConvergenceError(f"no balance of the forces was found{hint}", None)
        progress(self.made)

    def rewind(self) -> None:
        """Nothing: a block is made as a whole."""


def _films_at_rest(run: PreparedRun, b: int) -> BallFilms:
    """Balls and films of bearing `b` where the run starts."""
    balls, at, n = run.balls[b].balls, run.ball_directions[b], len(FIVE)
    place, films = run.histories.motion[0, at] + run.shift[at], films_of(balls)
    mount, out = run.rotor.ball_bearings[b], (np.zeros(n), np.zeros((n, n)), np.zeros((n, n)))
    begin_rest(balls, float(run.omega[0]), mount.cage_angle, films)
    for _ in range(60):
        rest_balls(balls, films, place, (*out, np.zeros(place.size)))
        before = films.heights[:, HEIGHT].copy()
        if balls.heights.shape[0] > 0:
            find_heights(balls, films, mount.cage_angle, 0.0)
        if np.abs(before - films.heights[:, HEIGHT]).max() <= 1e-9 * np.abs(films.heights[:, HEIGHT]).max():
            break
    return films


@jit_exact_loop
def run_block(steps, balls, films, rings, state, course, limits, out):
    """Steps along `course`; returns how many were made and how it ended.

    Parameters
    ----------
    steps : Steps
    balls, films : CompiledList
        `Balls` and `BallFilms` of every bearing.
    rings : RingState
    state : ndarray, shape (4, N)
        Displacement, velocity and acceleration; room.
    course : tuple of ndarray
        At the end of every step: speed [rad/s], shape (k,); turning forces [N], shape (k, turning).
    limits : (float, float)
        Imbalance allowed [N], and how far a ring may go [m].
    out : tuple of ndarray
        Displacement and velocity (k, N), displacement and force of the rings in the directions in which they move
        (k, m), iterations (k,).
    """
    speed, forces = course
    d = rings.pushed[0].size
    for i in range(speed.size):
        _foresee(steps, rings, state, forces[i])
        for b in range(len(balls)):
            begin_step(balls[b], speed[i], steps.dt, films[b])
        count = _balance(steps, balls, films, rings, limits[0])
        if count == 0:
            return i, NO_BALANCE
        _finish(steps, rings, state, forces[i])
        farthest, column = 0.0, 0
        for b in range(len(balls)):
            accept_balls(balls[b], films[b], 1.5 / steps.dt)
            for j in range(rings.moving[b]):
                k = d * b + j
                moved = rings.ring[POSITION, k]
                out[2][i, column], out[3][i, column] = moved - rings.shift[k], rings.ring[RING_FORCE, k]
                column += 1
                if j < DISPLACEMENTS:
                    farthest = max(farthest, abs(moved))
        for k in range(state.shape[1]):
            out[0][i, k], out[1][i, k] = state[0, k], state[1, k]
        out[4][i] = count
        if farthest > limits[1]:
            return i + 1, LOST
    return speed.size, DONE


@jit_exact_loop(inline="always")
def _foresee(steps, rings, state, forces):
    """Where the step would end without forces of the bearings at its end, and where it is expected to."""
    size, share = state.shape[1], 1.0 - steps.weight
    for k in range(size):
        state[3, k] = steps.constant[k]
    for i in range(3):  # not row by row: sums of their own do not wait for each other
        for j in range(size):
            moved = state[i, j]
            for k in range(size):
                state[3, k] += steps.past[i, j, k] * moved
    for j in range(forces.size):
        pushed = steps.weight * forces[j] + share * rings.turned[j]
        for k in range(size):
            state[3, k] += steps.turning[j, k] * pushed
    for j in range(rings.force.size):
        pushed = share * rings.force[j]
        for k in range(size):
            state[3, k] -= steps.columns[j, k] * pushed
    tried, r = rings.tried, rings.r
    _, by_d, by_v, by_a = steps.velocity
    for j in range(rings.force.size):
        free, history = 0.0, 0.0
        for k in range(size):
            free += steps.B[j, k] * state[3, k]
            history += steps.B[j, k] * (by_d * state[0, k] + by_v * state[1, k] + by_a * state[2, k])
        tried[FREE, j], tried[HISTORY, j] = free, history
        tried[R, j] = 3.0 * (r[0, j] - r[1, j]) + r[2, j]


@jit_exact_loop(inline="always")
def _balance(steps, balls, films, rings, allowed):
    """Newton's method for D (r - r_free) + weight F = 0; returns how often it asked, 0 where it does not end."""
    tried, system, n, ring, ties = rings.tried, rings.system, rings.force.size, rings.ring, rings.ties
    force, stiffness, damping = rings.pushed
    d, previous = force.size, inf
    for count in range(1, MOST_ITERATIONS + 1):
        error = 0.0
        for j in range(n):
            tried[RATE, j] = steps.velocity[0] * tried[R, j] + tried[HISTORY, j]
            tried[FORCE, j] = 0.0
            for k in range(n):
                system[j, k] = steps.D[j, k]
        for b in range(len(balls)):
            first, moving = d * b, rings.moving[b]
            for i in range(first, first + moving):
                ring[POSITION, i], ring[VELOCITY, i] = rings.shift[i], 0.0
                for j in range(n):
                    ring[POSITION, i] += ties[i, j] * tried[R, j]
                    ring[VELOCITY, i] += ties[i, j] * tried[RATE, j]
            q, v = ring[POSITION, first : first + moving], ring[VELOCITY, first : first + moving]
            press_balls(balls[b], films[b], q, v, 1.5 / steps.dt, rings.pushed)
            for i in range(moving):
                ring[RING_FORCE, first + i] = force[i]
                for j in range(n):
                    tried[FORCE, j] += ties[first + i, j] * force[i]
                    rings.slopes[i, j] = 0.0
                for k in range(moving):
                    slope = steps.weight * (stiffness[i, k] + steps.velocity[0] * damping[i, k])
                    for j in range(n):
                        rings.slopes[i, j] += slope * ties[first + k, j]
            for i in range(moving):
                for j in range(n):
                    tie = ties[first + i, j]
                    if tie != 0.0:
                        for k in range(n):
                            system[j, k] += tie * rings.slopes[i, k]
        for j in range(n):
            imbalance = steps.weight * tried[FORCE, j]
            for k in range(n):
                imbalance += steps.D[j, k] * (tried[R, k] - tried[FREE, k])
            tried[IMBALANCE, j] = imbalance
            error += imbalance * imbalance
        error = sqrt(error)
        if error <= allowed:
            return count
        if not error < inf:
            return 0
        back = error > OVERSHOOT * previous  # a kink lies between
        if not back:
            previous = error
            for j in range(n):
                system[j, n] = -tried[IMBALANCE, j]
            _solve(system)
        for j in range(n):
            if back:
                system[j, n] *= 0.5
                tried[R, j] -= system[j, n]
            else:
                tried[R, j] += system[j, n]
    return 0


@inner
@jit_exact_loop
def _solve(system):
    """Gauss with pivots: the last column becomes the solution."""
    n = system.shape[0]
    for k in range(n):
        pivot = k
        for j in range(k + 1, n):
            if abs(system[j, k]) > abs(system[pivot, k]):
                pivot = j
        for i in range(n + 1):
            system[k, i], system[pivot, i] = system[pivot, i], system[k, i]
        for j in range(k + 1, n):
            factor = system[j, k] / system[k, k]
            for i in range(k, n + 1):
                system[j, i] -= factor * system[k, i]
    for k in range(n - 1, -1, -1):
        for i in range(k + 1, n):
            system[k, n] -= system[k, i] * system[i, n]
        system[k, n] /= system[k, k]


@jit_exact_loop(inline="always")
def _finish(steps, rings, state, forces):
    """Move rotor and rings to the end of the step."""
    tried, r = rings.tried, rings.r
    v0, v1, v2, v3 = steps.velocity
    a0, a1, a2, a3 = steps.acceleration
    for j in range(rings.force.size):
        pushed = steps.weight * tried[FORCE, j]
        for k in range(state.shape[1]):
            state[3, k] -= steps.columns[j, k] * pushed
    for k in range(state.shape[1]):
        d, v, a, new = state[0, k], state[1, k], state[2, k], state[3, k]
        state[0, k] = new
        state[1, k] = v0 * new + v1 * d + v2 * v + v3 * a
        state[2, k] = a0 * new + a1 * d + a2 * v + a3 * a
    for j in range(rings.force.size):
        r[2, j], r[1, j], r[0, j] = r[1, j], r[0, j], tried[R, j]
        rings.force[j] = tried[FORCE, j]
    for j in range(forces.size):
        rings.turned[j] = forces[j]
