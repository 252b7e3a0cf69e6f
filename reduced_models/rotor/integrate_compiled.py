"""Time steps of a rotor on ball bearings, in C. Other supports: `integrate_python`.

The step is ``csrc/rotor_step.c``, that of `time_step` on the displacements r of the points at which bearings act;
Newton's method works on r alone, with the exact tangents of the bearings. Rings follow r: where several are on a
shaft that is rigid along itself, there are fewer points than motions of rings. ``csrc/rotor_run.c`` makes all
steps of a block; rotor, bearings, balls and films are numbers of one array.

The structures here are those of ``csrc/rotor.h`` and ``csrc/support.h``, with the names of their members.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from ctypes import POINTER, byref, c_double, c_int, c_size_t, c_void_p
from functools import cache
from math import inf

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError
from reduced_models.bearing.core_bearing import bearing_library, pointer
from reduced_models.rotor.prepared_run import DISPLACEMENTS, PreparedRun
from reduced_models.rotor.time_step import rounding_hint

_Floats = NDArray[np.float64]

# of a light ball under inner race control, say
UNBALANCED = "; friction may not hold its gyroscopic moment: another race_control, more preload"


class SupportStructure(ctypes.Structure):
    """`Support` of ``support.h``, filled by the library."""

    _fields_ = [
        ("own", c_void_p),
        ("motions", c_int), ("states", c_int), ("indicators", c_int),
        ("size", c_size_t), ("work", c_size_t),
        *((name, c_void_p) for name in ("start", "rest", "begin", "press", "slopes", "accept")),
        *((name, c_void_p) for name in ("torque", "show", "evaluate", "along")),
    ]  # fmt: skip


class RotorStructure(ctypes.Structure):
    """`Rotor` of ``rotor.h``."""

    _fields_ = [
        *((name, c_int) for name in ("freedoms", "points", "motions", "supports", "unbalances")),
        *((name, c_double) for name in ("mass", "damping", "stiffness", "load")),
        *((name, c_void_p) for name in ("M", "C", "G", "K", "L", "M_inverse", "B", "ties", "shift", "count")),
        ("unbalance_at", c_void_p), ("phase", c_void_p),
        *((name, c_double) for name in ("inertia", "rho", "allowed", "floor", "balanced", "rested")),
        ("held", c_int),
        ("support", POINTER(POINTER(SupportStructure))),
        ("first", c_void_p),
    ]  # fmt: skip


class RunStructure(ctypes.Structure):
    """`RotorRun` of ``rotor.h``: steps of a block; `presses` and `refused` are its `Search`."""

    _fields_ = [
        *((name, c_int) for name in ("steps", "made", "presses", "refused")),
        ("h", c_double),
        *((name, c_void_p) for name in ("omega", "turning", "farthest", "applied")),
        *((name, c_void_p) for name in ("place", "velocity", "motion", "rate", "force", "iterations")),
    ]  # fmt: skip


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
        self._run, self._tolerance, self._library = run, tolerance, rotor_library()
        rotor, geometry = run.rotor, run.rotor.geometry
        load = max(float(np.linalg.norm(rotor.load)), float(np.abs(run.turning).max(initial=0.0)))
        self._allowed = tolerance * max(load, 1.0)
        self._supports = (SupportStructure * len(run.balls))()
        for balls, support in zip(run.balls, self._supports, strict=True):
            self._library.bearing_support(balls.core.address, byref(support))
        places = [-1 if at is None else at for one in rotor.unbalances for at in (one.x, one.y)]
        self._farthest, self._applied = np.full(len(run.shift), inf), np.zeros(rotor.size)
        for at in run.ball_directions:
            self._farthest[at][:DISPLACEMENTS] = run.farthest
        self._arrays: dict[str, NDArray[np.generic]] = {
            "M": rotor.mass, "L": rotor.load, "B": geometry.points, "ties": geometry.normals, "shift": run.shift,
            "count": geometry.counts, "unbalance_at": np.array(places, np.intc),
            "first": np.array([at.start for at in run.ball_directions], np.intc),
        }  # fmt: skip
        self._arrays = {name: np.ascontiguousarray(array) for name, array in self._arrays.items()}
        self._rotor = RotorStructure(
            freedoms=rotor.size, points=len(geometry.points), motions=len(run.shift), supports=len(run.balls),
            unbalances=len(rotor.unbalances), mass=1.0, damping=1.0, stiffness=1.0, load=1.0,
            rho=run.rho_inf, allowed=self._allowed,
            support=(POINTER(SupportStructure) * len(run.balls))(*map(ctypes.pointer, self._supports)),
            **{name: array.ctypes.data for name, array in self._arrays.items()},
        )  # fmt: skip
        self._state, self._work, self._parts = self._begin()

    def _begin(self) -> tuple[_Floats, _Floats, list[_Floats]]:
        """State and work of rotor and bearings at the start, and the parts of the state that are the bearings."""
        run = self._run
        state = np.zeros(self._library.rotor_size(byref(self._rotor)))
        work = np.zeros(self._library.rotor_work(byref(self._rotor)))
        ends = state.size - np.cumsum([balls.state.size for balls in run.balls][::-1])[::-1]
        parts = np.split(state, ends)[1:]
        for part, balls in zip(parts, run.balls, strict=True):
            part[:] = balls.state
        carried = run.rotor.geometry.normals.T @ run.histories.force[0]
        motion = np.ascontiguousarray(run.state[:3])
        self._library.rotor_put(
            byref(self._rotor), pointer(motion), pointer(carried), pointer(run.turning), pointer(state)
        )
        return state, work, parts

    def advance(self, omega: float, first: int, end: int, progress: Callable[[int], None]) -> None:
        """Make the steps of one block, of matrices at `omega`; `progress` takes the number made, at its end.

        Raises
        ------
        ConvergenceError
            A step found no balance, or a ring left its bearing.
        """
        run, rotor, here = self._run, self._rotor, slice(first + 1, end + 1)
        _, damping, stiffness = (np.ascontiguousarray(matrix) for matrix in run.rotor.matrices(omega))
        rotor.C, rotor.K = damping.ctypes.data, stiffness.ctypes.data
        names = "place", "velocity", "motion", "rate", "force", "iterations"
        out = {name: history[here].ctypes.data for name, history in zip(names, run.histories, strict=True)}
        block = RunStructure(
            steps=end - first, h=run.dt,
            omega=run.omega[first:].ctypes.data, turning=run.turning[here].ctypes.data,
            farthest=self._farthest.ctypes.data, applied=self._applied.ctypes.data, **out,
        )  # fmt: skip
        reason = self._library.rotor_run(byref(rotor), byref(block), pointer(self._state), pointer(self._work))
        self.made = first + block.made
        for balls, part in zip(run.balls, self._parts, strict=True):
            balls.state[:] = part
        lost = run.lost(first, self.made)
        if lost is not None:
            self.made = self.reached = lost[0]
            raise ConvergenceError(lost[1], None)
        self.reached = self.made + (reason is not None)
        if reason is not None:
            raise ConvergenceError(f"no balance of the forces was found{self._hint(omega, block.refused)}", None)
        progress(self.made)

    def _hint(self, omega: float, refused: int) -> str:
        """What may help where a step found no balance; `refused` is the bearing that had no force, or -1."""
        run = self._run
        if refused >= 0:
            turned = UNBALANCED if run.rotor.ball_bearings[refused].z is not None else ""
            return f": a ball of {run.rotor.ball_bearing_names[refused]} finds none{turned}"
        motion = run.histories.motion[self.made]
        return rounding_hint(run.steps_at(omega), motion, self._allowed, self._allowed / self._tolerance)

    def rewind(self) -> None:
        """Nothing: a block is made as a whole."""


@cache
def rotor_library() -> ctypes.CDLL:
    """The C core, its structures of rotors compared with those here."""
    library = bearing_library()
    for name in ("rotor_size", "rotor_work"):
        getattr(library, name).restype = c_size_t
    for name in ("bearing_support", "rotor_put", "rotor_sizes"):
        getattr(library, name).restype = None
    library.rotor_run.restype = ctypes.c_char_p
    here = [ctypes.sizeof(kind) for kind in (RotorStructure, RunStructure, SupportStructure)]
    there = (c_size_t * len(here))()
    library.rotor_sizes(there)
    assert list(there) == here, f"structures of rotors have {list(there)} bytes in C, {here} in Python"
    return library
