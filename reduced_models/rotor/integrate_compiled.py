"""Time steps of a rotor on ball bearings and squeeze film dampers, in C. Other supports: `integrate_python`.

Newton's method works on the points at which supports act, with their exact tangents. Rings follow
the points: where several are on a shaft that is rigid along itself, there are fewer points than motions of rings.
``csrc/rotor_run.c`` makes the steps of a block; rotor, bearings, balls and films are numbers of one array.
"""

from __future__ import annotations

from collections.abc import Callable
from ctypes import byref
from math import inf

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError
from reduced_models.bearing.core_bearing import pointer
from reduced_models.rotor.core_rotor import CoreRotor, RunStructure, SupportStructure, rotor_library
from reduced_models.rotor.prepared_run import DISPLACEMENTS, PreparedRun
from reduced_models.rotor.squeeze_film_damper import CONTACT

_Floats = NDArray[np.float64]

DAMPER_ECCENTRICITY = 2  # among the numbers of a damper: ``csrc/damper_support.c``

# of a light ball under inner race control, say
UNBALANCED = "; friction may not hold its gyroscopic moment: another race_control, more preload"


class CompiledSteps:
    """Steps of a run on ball bearings and dampers alone.

    Parameters
    ----------
    run : PreparedRun
    tolerance : float
        Largest imbalance over the larger of the load and the forces of the unbalances.

    Attributes
    ----------
    core : CoreRotor
    bearing_states : list of ndarray
        Numbers of every ball bearing; views of those of `core`.
    """

    made = reached = 0  # steps, and the last one that was begun

    def __init__(self, run: PreparedRun, tolerance: float) -> None:
        self._run, self._tolerance = run, tolerance
        rotor, geometry = run.rotor, run.rotor.geometry
        load = max(float(np.linalg.norm(rotor.load)), float(np.abs(run.turning).max(initial=0.0)))
        self._allowed = tolerance * max(load, 1.0)
        self._farthest, self._applied = np.full(len(run.shift), inf), np.zeros(rotor.size)
        for at in run.ball_directions:
            self._farthest[at][:DISPLACEMENTS] = run.farthest
        supports = [SupportStructure() for _ in (*run.balls, *rotor.film_dampers)]
        for balls, support in zip(run.balls, supports, strict=False):
            rotor_library().bearing_support(balls.core.address, byref(support))
        self._dampers = [mount.damper.structure for mount in rotor.film_dampers]  # to which supports point
        for damper, support in zip(self._dampers, supports[len(run.balls) :], strict=True):
            rotor_library().damper_support(byref(damper), byref(support))
        first = np.array([at.start for at in (*run.ball_directions, *rotor.film_damper_columns)], np.intc)
        arrays = {"ties": geometry.normals, "shift": run.shift, "count": geometry.counts, "first": first}
        self.core = core = CoreRotor(rotor, run.dt, run.rho_inf, supports, arrays)
        core.structure.allowed = self._allowed
        sizes = [support.size for support in supports]
        starts = core.state.size - sum(sizes) + np.cumsum([0, *sizes])[:-1]
        parts = [core.state[at : at + size] for at, size in zip(starts, sizes, strict=True)]
        self.bearing_states, self._touched = parts[: len(run.balls)], parts[len(run.balls) :]  # and of dampers
        for part, balls in zip(self.bearing_states, run.balls, strict=True):
            part[:] = balls.state
        carried = geometry.normals.T @ (geometry.counts * run.histories.force[0])
        core.put(run.state, carried, run.applied(0))

    def advance(self, omega: float, first: int, end: int, progress: Callable[[int], None]) -> None:
        """Make the steps of one block, of matrices at `omega`; `progress` takes the number made, at its end.

        Raises
        ------
        ConvergenceError
            A step found no balance, a ring left its bearing, or the journal of a damper touched its housing.
        """
        run, core, here = self._run, self.core, slice(first + 1, end + 1)
        core.take_matrices(omega)
        names = "place", "velocity", "motion", "rate", "force", "iterations"
        out = {name: history[here].ctypes.data for name, history in zip(names, run.histories, strict=True)}
        block = RunStructure(
            steps=end - first, h=run.dt,
            omega=run.omega[first:].ctypes.data, turning=run.turning[here].ctypes.data,
            farthest=self._farthest.ctypes.data, applied=self._applied.ctypes.data, **out,
        )  # fmt: skip
        reason = core.library.rotor_run(core.address, byref(block), pointer(core.state), pointer(core.work))
        self.made = first + block.made
        for balls, part in zip(run.balls, self.bearing_states, strict=True):
            balls.state[:] = part
        lost = run.lost(first, self.made)
        if lost is not None:
            self.made = self.reached = lost[0]
            raise ConvergenceError(lost[1], None)
        self.reached = self.made + (reason is not None)
        if reason is not None:
            touching = block.refused - len(run.balls)
            if touching >= 0:
                ratio = self._touched[touching][DAMPER_ECCENTRICITY]
                name = run.rotor.film_damper_names[touching]
                raise ConvergenceError(f"the journal of {name} {CONTACT.format(ratio)}", None)
            raise ConvergenceError(f"no balance of the forces was found{self._hint(block.refused)}", None)
        progress(self.made)

    def _hint(self, refused: int) -> str:
        """What may help where a step found no balance; `refused` is the bearing that had no force, or -1."""
        run = self._run
        if refused >= 0:
            turned = UNBALANCED if run.rotor.ball_bearings[refused].z is not None else ""
            return f": a ball of {run.rotor.ball_bearing_names[refused]} finds none{turned}"
        motion = run.histories.motion[self.made]
        return self.core.rounding_hint(motion, self._allowed, self._allowed / self._tolerance)

    def rewind(self) -> None:
        """Nothing: a block is made as a whole."""
