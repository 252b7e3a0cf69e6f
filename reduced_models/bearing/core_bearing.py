"""`CoreBearing`: a ball bearing as the C core has it, with views of its state and of the work of a step.

The structures here are those of ``csrc/bearing.h`` and of the files that it includes, with the names of their
members; their sizes are compared with those of the library when it is loaded. State and work of a bearing are
arrays of numbers, which the C functions read and write in place: views of them show balls, films and surfaces.

C functions are called with pointers that are made once; no array is converted in a call.
"""

from __future__ import annotations

import ctypes
from ctypes import POINTER, c_double, c_int, c_size_t, c_void_p
from functools import cache
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduced_models import core
from reduced_models.bearing.ball import Balls
from reduced_models.bearing.contact_angles import Grooves
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.race_table import RaceForceTable
from reduced_models.elements.film_filters import DIRECT

_Floats = NDArray[np.float64]
_Record = NDArray[np.void]

NUMBER = np.dtype(np.float64).itemsize


class GroovesStructure(ctypes.Structure):
    """`Grooves` of ``bearing.h``."""

    _fields_ = [
        ("radial", c_double), ("axial", c_double),
        ("clearance", c_double),
        ("free_length", c_double * 2),
        ("circle", c_double), ("inner_radius", c_double),
        ("ball", c_double), ("pitch", c_double), ("mass", c_double),
        ("gyroscopic", c_double),
        ("spin_moment", c_double * 2),
        ("cosine", c_double),
        ("ring_speed", c_double * 2), ("sense", c_double),
    ]  # fmt: skip


class RaceStructure(ctypes.Structure):
    """`Race` of ``race_contact.h``."""

    _fields_ = [
        ("kn", c_double), ("log_kn", c_double), ("contact_length_factor", c_double),
        ("lag_rate", c_double), ("inlet_rate", c_double), ("fast_rate", c_double),
        ("cutoff_gap", c_double),
        ("lags", c_int),
        ("nodes", c_int),
        ("first", POINTER(c_int)),
        ("x", c_void_p), ("u", c_void_p), ("curve", c_void_p), ("cells", c_void_p),
        ("gains", c_void_p), ("made", c_void_p),
    ]  # fmt: skip


class _FilmTablesStructure(ctypes.Structure):
    """`FilmTables` of ``bearing.h``: outputs of FMUs, empty in Python."""

    _fields_ = [
        ("nodes", c_int),
        ("first", c_double * 2), ("step", c_double * 2), ("rolling_radius", c_double * 2),
        ("table", c_void_p),
        ("roughness", c_double),
    ]  # fmt: skip


class _CapacitanceStructure(ctypes.Structure):
    """`CapacitanceTable` of ``capacitance_table.h``: outputs of FMUs, empty in Python."""

    _fields_ = [
        ("of", c_void_p),
        ("terms", c_int),
        ("first", c_double), ("last", c_double),
        ("approach", c_double), ("plate", c_double), ("largest_load", c_double),
        ("flattest", c_double), ("steepest", c_double),
        ("power", c_void_p), ("coefficient", c_void_p),
    ]  # fmt: skip


class HeightsStructure(ctypes.Structure):
    """`HeightTables` of ``surface_heights.h``."""

    _fields_ = [("pages", c_int), ("rows", c_int), ("columns", c_int), ("heights", c_void_p)]


class BearingStructure(ctypes.Structure):
    """Structure `Bearing` of ``bearing.h``."""

    _fields_ = [
        ("directions", c_int), ("direction", c_int * len(FIVE)),
        ("balls", c_int), ("lags", c_int), ("speeds", c_int), ("filters", c_int),
        ("control", c_int),
        ("inertia", c_double),
        ("speed", c_void_p),
        ("filter_gains", c_void_p), ("filter_rates", c_void_p),
        ("grooves", GroovesStructure),
        ("race", RaceStructure * 2),
        ("films", _FilmTablesStructure), ("capacitance", _CapacitanceStructure * 2),
        ("most_speed", c_double), ("most_load", c_double * 2),
        ("largest_place", c_double), ("largest_tilt", c_double),
        ("heights", POINTER(HeightsStructure)),
        ("origin", c_void_p), ("cage_held", c_int),
    ]  # fmt: skip


def _numbers(**members: tuple[int, ...]) -> np.dtype[Any]:
    """Record of numbers, or of arrays of them, with these names and shapes."""
    return np.dtype([(name, np.float64, shape) for name, shape in members.items()])


SETTINGS = _numbers(clearance=(), offset=(), cage_angle=(), film=())
HEAD = np.dtype([("settings", SETTINGS), *_numbers(h=(), steps=(), omega=(), angle=(), cage=(2,)).descr])
BALL = _numbers(
    place=(2, 2), rate=(2, 2), factor=(2, 2), speed_sum=(2, 2), lift=(2,), force=(2,), film=(2,), cosine=(2,),
    sine=(2,), inertia=(5, 4),
)  # fmt: skip
FILM = _numbers(approach=(), rate=(), own=(), inlet=(), fast=(), entered=(), interval=())
FULL_FILM = _numbers(force=(), slope=(), approach=())
SURFACE = np.dtype(
    [
        *_numbers(angle=(), rotation=(), height=(2, 2)).descr, ("full", FULL_FILM, (2,)),
        *_numbers(largest=(2,), fatigue=(2, 2)).descr,
    ]
)  # fmt: skip
STEP = np.dtype(
    [
        *_numbers(h=(), gain=(), omega=(), cage=(), angle=(), lift=(), bare=(5,), force=(5,)).descr,
        ("row", np.int64), *_numbers(weight=(), slope=()).descr,
    ]
)  # fmt: skip
BALL_STEP = _numbers(
    x=(), y=(), history=(2,), rate_history=(2,), start=(2,), tried=(2,), follow=(2, 2), inertia=(5, 4),
    c=(2,), d=(2,), place=(2,), force=(2,), film=(2,), ring=(3,), slopes=(3, 4),
    transit=(2,), height=(2,), height_rate=(2,), thickness=(2, 2),
)  # fmt: skip
AT_REST = _numbers(
    angle=(2,),
    load=(2,),
    approach=(2,),
    compression=(2,),
    slope=(2,),
    factor=(2,),
    speed_sum=(2,),
    orbit=(),
    rotation=(),
    axis=(),
    share=(),
)
ORIGIN = _numbers(place=(2,), moved=(2,), across=())  # see `BallOrigin` of ``bearing.h``
# Each number has its derivative with it
RING_MOTION = _numbers(q=(5, 2), v=(5, 2), omega=(2,))
BALL_OUTPUTS = _numbers(load=(2, 2), approach=(2, 2), factor=(2, 2), speed_sum=(2, 2), angle=(2, 2), film=(2,))


class CoreBearing:
    """A bearing in C; what it points to lives as long as this.

    Parameters
    ----------
    balls : Balls
    directions : tuple of str
        Of `freedoms.FIVE`, in which the ring moves; in the others it is held at 0.

    Attributes
    ----------
    structure : BearingStructure
        Its numbers may be written.
    address : c_void_p
        Of the structure.
    state_size, work_size : int
        Numbers of its state, and of a step.
    """

    def __init__(self, balls: Balls, directions: tuple[str, ...]) -> None:
        self.library, self.directions, self.number = bearing_library(), directions, balls.number
        races = balls.inner, balls.outer
        self._kept: list[Any] = []
        self._lags = max(law.gains.shape[2] for law in races) - DIRECT
        heights = heights_structure(balls.heights)
        self._kept += [balls.heights, heights]
        self.structure = BearingStructure(
            directions=len(directions),
            direction=(c_int * len(FIVE))(*map(FIVE.index, directions)),
            balls=balls.number,
            lags=self._lags,
            speeds=balls.speeds.size,
            filters=balls.loss.gains.size,
            control=balls.grooves.control,
            inertia=balls.inertia,
            speed=self._array(balls.speeds),
            filter_gains=self._array(balls.loss.gains),
            filter_rates=self._array(balls.loss.rates),
            grooves=_grooves(balls.grooves),
            race=(RaceStructure * 2)(*(self._race(law) for law in races)),
            most_speed=inf,
            most_load=(inf, inf),
            largest_place=inf,
            largest_tilt=inf,
            heights=ctypes.pointer(heights),
        )
        self.address = c_void_p(ctypes.addressof(self.structure))
        self._filters = balls.loss.gains.size
        self._has_oil = balls.inner.x.size > 0
        self.state_size = int(self.library.bearing_state_size(self.address))
        self.work_size = int(self.library.bearing_work_size(self.address))

    def count_from(self, origins: _Record) -> None:
        """Count the places of balls in continuous time from records of `ORIGIN`, shape (balls,)."""
        self._origins = origins.copy()
        self.structure.origin = pointer(self._origins)

    def start(self) -> _Floats:
        """State of a bearing whose balls have not been placed: with the films that it has, the cage at 0."""
        state, settings = np.zeros(self.state_size), np.zeros(1, SETTINGS)
        settings["film"] = float(self._has_oil)
        why = reason(self.library.bearing_start(self.address, pointer(settings), pointer(state)))
        assert why is None, why
        return state

    def work(self) -> _Floats:
        """Room for a step."""
        return np.zeros(self.work_size)

    def head(self, state: _Floats) -> _Record:
        """View of the head of a state, shape (1,)."""
        return state[: HEAD.itemsize // NUMBER].view(HEAD)

    def balls(self, state: _Floats) -> _Record:
        """View of the balls of a state, shape (balls,)."""
        return self._part(state, HEAD.itemsize, BALL)

    def films(self, state: _Floats) -> _Record:
        """View of the films of a state, shape (balls, 2): inner and outer race."""
        kind = np.dtype([*FILM.descr, ("chain", np.float64, (self._lags,))])
        first = (HEAD.itemsize + self.number * BALL.itemsize) // NUMBER
        size = 2 * self.number * kind.itemsize // NUMBER
        return state[first : first + size].view(kind).reshape(self.number, 2)

    def seat(self, state: _Floats) -> _Floats:
        """View of the seat, (2 + filters, n): force with and without losses, and what its filters have of it."""
        size, n = (2 + self._filters) * len(self.directions), len(self.directions)
        end = self.state_size - 1 - self.number * SURFACE.itemsize // NUMBER
        return state[end - size : end].reshape(-1, n)

    def shaft(self, state: _Floats) -> _Floats:
        """View of the angle that the shaft has turned, shape (1,) [rad]."""
        place = self.state_size - 1 - self.number * SURFACE.itemsize // NUMBER
        return state[place : place + 1]

    def surfaces(self, state: _Floats) -> _Record:
        """View of the surfaces of a state, shape (balls,)."""
        return self._part(state, self.state_size * NUMBER - self.number * SURFACE.itemsize, SURFACE)

    def step(self, work: _Floats) -> _Record:
        """View of the head of a step, shape (1,)."""
        return work[: STEP.itemsize // NUMBER].view(STEP)

    def ball_steps(self, work: _Floats) -> _Record:
        """View of the balls in a step, shape (balls,)."""
        return self._part(work, STEP.itemsize, BALL_STEP)

    def _part(self, numbers: _Floats, first: int, kind: np.dtype[Any]) -> _Record:
        first //= NUMBER
        return numbers[first : first + self.number * kind.itemsize // NUMBER].view(kind)

    def _array(self, values: _Floats) -> c_void_p:
        """Pointer to an array, which is kept."""
        values = np.ascontiguousarray(values, np.float64)
        self._kept.append(values)
        return pointer(values)

    def _race(self, law: RaceForceTable) -> RaceStructure:
        return RaceStructure(
            law.kn,
            law.log_kn,
            law.contact_length_factor,
            law.lag_rate,
            law.inlet_rate,
            law.fast_rate,
            law.cutoff_gap,
            lags=law.gains.shape[2] - DIRECT,
            nodes=law.x.size,
            x=self._array(law.x),
            u=self._array(law.u),
            cells=self._array(law.cells),
            gains=self._array(law.gains),
            made=self._array(law.film_made),
        )


def heights_structure(heights: _Floats) -> HeightsStructure:
    """Tables of heights as C has them; the caller keeps the array."""
    return HeightsStructure(*heights.shape, pointer(heights))


def pointer(array: NDArray[Any]) -> c_void_p:
    """Pointer to the numbers of an array without gaps, as C functions take it; the caller keeps the array."""
    assert array.flags.c_contiguous
    return c_void_p(array.ctypes.data)


def reason(answer: bytes | None) -> str | None:
    """Why a C function has no answer; None where it has one."""
    return None if answer is None else answer.decode("ascii")


@cache
def bearing_library() -> ctypes.CDLL:
    """The C core, its structures of bearings compared with those here."""
    library = core.library()
    for name in ("bearing_state_size", "bearing_work_size"):
        getattr(library, name).restype = c_size_t
    for name in ("table_height", "contact_height"):
        getattr(library, name).restype = c_double
    for name in ("bearing_start", "bearing_press", "bearing_rest", "bearing_rest_at", "bearing_rates"):
        getattr(library, name).restype = ctypes.c_char_p
    for name in (
        "bearing_begin", "bearing_slopes", "bearing_accept", "bearing_describe", "bearing_states_of_step",
    ):  # fmt: skip
        getattr(library, name).restype = None
    here = [ctypes.sizeof(kind) for kind in (BearingStructure, GroovesStructure, RaceStructure, HeightsStructure)]
    here += [kind.itemsize for kind in (HEAD, BALL, FILM, SURFACE, STEP, BALL_STEP, AT_REST)]
    here += [kind.itemsize for kind in (ORIGIN, RING_MOTION, BALL_OUTPUTS)]
    there = (c_size_t * len(here))()
    library.bearing_sizes(there)
    assert list(there) == here, f"structures of bearings have {list(there)} bytes in C, {here} in Python"
    return library


def _grooves(g: Grooves) -> GroovesStructure:
    return GroovesStructure(
        radial=g.radial,
        axial=g.axial,
        free_length=(g.inner, g.outer),
        circle=g.groove_circle,
        inner_radius=g.radius,
        ball=g.ball,
        pitch=g.pitch,
        mass=g.mass,
        gyroscopic=g.gyroscopic,
        spin_moment=(g.inner_spin_moment, g.outer_spin_moment),
        cosine=g.cosine,
        ring_speed=g.ring_speed,
        sense=g.sense,
    )
