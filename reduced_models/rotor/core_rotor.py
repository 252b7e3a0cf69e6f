"""`CoreRotor`: a rotor as the C core has it, with its state; steps by the generalised-alpha method.

Chung and Hulbert, J. Appl. Mech. 60 (1993) 371. Everything linear is condensed onto the displacements r = B q of
the points at which supports act, as the inner rings of bearings against the outer ones: the end of a step has

    D (r - r_free) + weight F(r, r') = 0,    r' = gain r + history,    q = q_free - weight S^-1 B^T F.

``csrc/rotor_step.c`` makes the step, of which F may be that of supports in C (`integrate_compiled`) or of supports
that the caller asks (`integrate_python`). The structures here are those of ``csrc/rotor.h`` and
``csrc/support.h``, with the names of their members.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from ctypes import POINTER, byref, c_double, c_int, c_size_t, c_void_p
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from reduced_models.bearing.core_bearing import bearing_library, pointer, reason
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]

ROUNDED = 0.1  # of the allowed imbalance: rounding in a sum of so much, and a step may not find its balance


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


class FreeStepStructure(ctypes.Structure):
    """`FreeStep` of ``rotor.h``."""

    _fields_ = [
        ("gain", c_double), ("weight", c_double),
        *((name, POINTER(c_double)) for name in ("free", "history", "stiffness")),
    ]  # fmt: skip


class FreeStep(NamedTuple):
    """What n points do in a step without forces of the supports at its end; arrays are views."""

    gain: float
    weight: float
    free: _Floats  # (n,) where they are at the end
    history: _Floats  # (n,)
    stiffness: _Floats  # (n, n), D


class CoreRotor:
    """A rotor in C; what it points to lives as long as this.

    Parameters
    ----------
    rotor : Rotor
    dt : float
        Of all steps [s].
    rho_inf : float
        As of `simulate_rotor`.
    supports : sequence of SupportStructure
        Supports in C.
    arrays : mapping of str to ndarray
        Of their motions: `ties`, `shift`, `count`, `first` of ``rotor.h``.

    Attributes
    ----------
    structure : RotorStructure
    address : pointer to it
    state, work : ndarray
        Of the rotor, then of the supports; of a step.
    """

    def __init__(
        self,
        rotor: Rotor,
        dt: float,
        rho_inf: float,
        supports: Sequence[SupportStructure] = (),
        arrays: Mapping[str, NDArray[Any]] | None = None,
    ) -> None:
        self.library, self._rotor, self.dt = rotor_library(), rotor, dt
        places = [-1 if at is None else at for one in rotor.unbalances for at in (one.x, one.y)]
        given: dict[str, NDArray[Any]] = {
            "M": rotor.mass, "L": rotor.load, "B": rotor.geometry.points,
            "unbalance_at": np.array(places, np.intc), **(arrays or {}),
        }  # fmt: skip
        self._arrays = {name: np.ascontiguousarray(array) for name, array in given.items()}
        self.structure = RotorStructure(
            freedoms=rotor.size, points=len(rotor.geometry.points), motions=len(given.get("shift", ())),
            supports=len(supports), unbalances=len(rotor.unbalances),
            mass=1.0, damping=1.0, stiffness=1.0, load=1.0, rho=rho_inf,
            support=(POINTER(SupportStructure) * len(supports))(*map(ctypes.pointer, supports)),
            **{name: array.ctypes.data for name, array in self._arrays.items()},
        )  # fmt: skip
        self.address = byref(self.structure)
        self.state = np.zeros(self.library.rotor_size(self.address))
        self.work = np.zeros(self.library.rotor_work(self.address))
        self._applied, self._place, self._reaction, self._carried = (
            np.zeros(size) for size in (rotor.size, *3 * (len(rotor.geometry.points),))
        )
        self._free_step, numbers = FreeStepStructure(), (pointer(self.state), pointer(self.work))
        self._views: FreeStep | None = None
        applied = pointer(self._applied)
        self._free = partial(
            self.library.rotor_free_step, self.address, applied, c_double(dt), c_double(), *numbers,
            byref(self._free_step),
        )  # fmt: skip
        points = map(pointer, (self._place, self._reaction, self._carried))
        self._end = partial(self.library.rotor_end_step, self.address, applied, *points, *numbers)

    @property
    def motion(self) -> _Floats:
        """Displacements, velocities and accelerations at the end of the last step, shape (3, N); a view."""
        return self.state[: 3 * self._rotor.size].reshape(3, -1)

    def put(self, motion: _Floats, carried: _Floats, applied: _Floats) -> None:
        """Put the rotor in a motion, shape (3, N), with forces of the points (n,) and on the freedoms (N,)."""
        arrays = [np.ascontiguousarray(array) for array in (motion, carried, applied)]
        self.library.rotor_put(self.address, *map(pointer, arrays), pointer(self.state))

    def take_matrices(self, omega: float) -> None:
        """Take damping and stiffness at a speed [rad/s]."""
        for name, matrix in zip("CK", self._rotor.matrices(omega)[1:], strict=True):
            self._arrays[name] = np.ascontiguousarray(matrix)
            setattr(self.structure, name, self._arrays[name].ctypes.data)
        self.library.rotor_renew(self.address, pointer(self.state))

    def free_step(self, applied: _Floats) -> FreeStep:
        """Begin a step at whose end forces `applied`, shape (N,), act on the freedoms.

        Raises
        ------
        FloatingPointError
            Numbers too small or too large for a step of this length.
        """
        self._applied[:] = applied
        why = reason(self._free())
        if why is not None:
            raise FloatingPointError(why)
        if self._views is None:  # of places in state and work that stay
            step, n = self._free_step, self._place.size
            free, history = (np.ctypeslib.as_array(numbers, (n,)) for numbers in (step.free, step.history))
            stiffness = np.ctypeslib.as_array(step.stiffness, (n, n))
            self._views = FreeStep(step.gain, step.weight, free, history, stiffness)
        return self._views

    def end_step(self, place: _Floats, reaction: _Floats, carried: _Floats) -> None:
        """End the step with the points at `place`, shape (n,), where `reaction` has brought them.

        `carried` are the forces of the supports on the points: the reaction, but for what the balance left.
        """
        self._place[:], self._reaction[:], self._carried[:] = place, reaction, carried
        self._end()

    def rounding_hint(self, r: _Floats, allowed: float, scale: float) -> str:
        """What to change where steps are so short that rounding of the places `r` hides the balance; else empty.

        Inertia resists with mass/dt^2: rounding of a place is a force that grows as steps get shorter.

        Parameters
        ----------
        r : ndarray
            Motions of the points that supports act at [m].
        allowed, scale : float
            Imbalance that a step may have, and the force that the tolerance is over [N].
        """
        D = self.free_step(self._applied).stiffness
        noise = float(np.finfo(float).eps * np.abs(D).sum(axis=1).max() * np.abs(r).max(initial=0.0))
        if noise < ROUNDED * allowed:
            return ""
        return (
            f": steps of dt = {self.dt:g} s are so short that rounding is {noise:.2g} N, where {allowed:.2g} N is "
            f"allowed; take longer steps, or a tolerance of {2.0 * noise / (ROUNDED * scale):.1g} or more"
        )


def rotor_gain(dt: float, rho_inf: float) -> float:
    """Factor from displacements to velocities at the end of a step of `dt` [s]."""
    return float(rotor_library().rotor_gain(c_double(rho_inf), c_double(dt)))


@cache
def rotor_library() -> ctypes.CDLL:
    """The C core, its structures of rotors compared with those here."""
    library = bearing_library()
    for name in ("rotor_size", "rotor_work"):
        getattr(library, name).restype = c_size_t
    for name in ("bearing_support", "damper_support", "rotor_put", "rotor_renew", "rotor_sizes"):
        getattr(library, name).restype = None
    for name in ("rotor_run", "rotor_free_step", "rotor_end_step"):
        getattr(library, name).restype = ctypes.c_char_p
    library.rotor_gain.restype = c_double
    kinds = RotorStructure, RunStructure, SupportStructure, FreeStepStructure
    here, there = [ctypes.sizeof(kind) for kind in kinds], (c_size_t * len(kinds))()
    library.rotor_sizes(there)
    assert list(there) == here, f"structures of rotors have {list(there)} bytes in C, {here} in Python"
    return library
