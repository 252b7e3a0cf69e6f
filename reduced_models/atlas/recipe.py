"""`Recipe`: what a table of the atlas is made of; its sample, coordinates and smooth variables."""

from __future__ import annotations

import functools
import math
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Grid, __version__, solve_steady
from ehlcontact.errors import ConvergenceError
from ehlcontact.linearised_film import held, linearised
from ehlcontact.status import Status
from reduced_models.atlas.table import Box, Interpolation, Table

_Floats = NDArray[np.float64]
Entry = Mapping[str, Any]
Solve = Callable[[Any], dict[str, Any]]  # entry of a point with `to_dict` and `inlet_width`
P = TypeVar("P")  # point of a sample

FEWEST = 20  # converged points of a table
FILM = ("approach", "h_central", "h_min", "moment")  # of the steady state


class Recipe(ABC, Generic[P]):
    """How a table of the atlas is sampled, solved, put together and interpolated.

    Points of a table are rows of `width` coordinates. Its answers are turned into smooth variables over a `unit`
    that depends on the point, interpolated over `coordinates` and turned back to `values`.
    """

    name: ClassVar[str]  # of its module
    title: ClassVar[str]  # in messages
    things: ClassVar[str] = "points"  # what is solved, in messages
    why_left_out: ClassVar[str] = "not converged"
    numbers: ClassVar[Mapping[str, int]]  # of the sample: draws and seed of the table that comes with the library
    width: ClassVar[int] = 3
    keeps_errors: ClassVar[bool] = False  # in the file; otherwise they are computed when it is read
    precision: ClassVar[type[np.floating[Any]]] = np.float32
    settings: ClassVar[type[Interpolation]] = Interpolation
    interpolation: ClassVar[Interpolation]  # of a build
    apart: ClassVar[tuple[int, ...]] = ()  # smooth variables with coordinates of their own
    clipped: ClassVar[bool] = False  # places outside of all points take the coordinates of the nearest inside
    box: ClassVar[Box | None] = None
    # Entry of a point in the work folder, in JSON types; a function that workers import.
    solve: ClassVar[staticmethod[[Any], dict[str, Any]]]

    # building

    @abstractmethod
    def sample(self, *args: Any, **kwargs: Any) -> dict[str, P]:
        """Points to solve by name, given its `numbers`; more draws add to the fewer."""

    def usable(self, entry: Entry) -> bool:
        """Whether an entry that converged goes into the table."""
        return True

    @abstractmethod
    def assemble(self, entries: Sequence[Entry]) -> tuple[_Floats, dict[str, _Floats], dict[str, _Floats]]:
        """Points, axes and columns of a table of these entries."""

    @abstractmethod
    def metadata(self, entries: Sequence[Entry]) -> dict[str, Any]:
        """Settings and sources of a table of these entries, beside those of every table."""

    # reading

    @abstractmethod
    def shapes(self, table: Table) -> dict[str, tuple[int, ...]]:
        """Shape of every axis and column."""

    def require_metadata(self, table: Table) -> None:
        """Raise any error unless the metadata have what is read from them."""
        _ = table.box

    # interpolating

    @abstractmethod
    def unit(self, table: Table, points: _Floats) -> _Floats:
        """Unit of the smooth variables at rows of coordinates, shape (n,)."""

    @abstractmethod
    def coordinates(self, table: Table, points: _Floats, unit: _Floats) -> tuple[_Floats, ...]:
        """Weighted coordinates of the interpolation, shape (n, d); then those of every column of `apart`."""

    @abstractmethod
    def smooth(self, table: Table, unit: _Floats) -> _Floats:
        """Smooth variables of a table, shape (n, m)."""

    def beside(self, table: Table) -> _Floats:
        """Columns that are interpolated as they are, without error bars."""
        return np.empty((len(table.points), 0))

    def sizes(self, errors: _Floats) -> _Floats:
        """Errors of the smooth variables as error bars count them."""
        return errors

    @abstractmethod
    def values(
        self, table: Table, points: _Floats, unit: _Floats, smooth: _Floats, bars: _Floats, **more: Any
    ) -> tuple[_Floats, _Floats]:
        """Answers of rows of smooth variables with their error bars."""


def entry_of(solve: Solve) -> Solve:
    """Solve that returns an entry with status, version and seconds, whatever comes of it."""

    @functools.wraps(solve)
    def entry(point: Any) -> dict[str, Any]:
        started = time.perf_counter()
        try:
            answer = {"status": str(Status.CONVERGED)} | solve(point)
        except ConvergenceError as error:
            answer = {"status": "unknown" if error.result is None else str(error.result.status)}
        return answer | {"version": __version__, "seconds": time.perf_counter() - started}

    return entry


def linear_answer(
    point: Any, grid: Grid, Omega: Sequence[float], least: float, tolerance: float, **conditions: Any
) -> dict[str, Any]:
    """Steady film and impedance under conditions; `least` stands for lower frequencies."""
    film = solve_steady(point, grid=grid, **conditions)
    moving = np.maximum(Omega, least)
    Z = linearised(film, held(film)).respond(moving, tolerance).force
    own = film.dimensionless
    numbers = {name: float(getattr(own, name)) for name in FILM}
    return numbers | {"stiffness": Z.real.tolist(), "damping": (Z.imag / moving).tolist()}


def columns_of(entries: Sequence[Entry], *names: str) -> _Floats:
    """Numbers of entries, shape (n, names)."""
    return np.array([[entry[name] for name in names] for entry in entries])


def sobol(axes: int, draws: int, seed: int) -> _Floats:
    """Scrambled Sobol points of the unit cube, shape (draws, axes); more draws add to the fewer."""
    from scipy.stats import qmc  # of all that is imported here it takes longest

    # Sobol sequences are balanced by powers of 2, but any beginning will do here.
    shares = qmc.Sobol(axes, seed=seed).random_base2(math.ceil(math.log2(max(draws, 1))))
    return np.asarray(shares[:draws])


def overshot(shares: _Floats, by: float) -> _Floats:
    """Draws stretched beyond the cube by a share of it and moved onto its faces, so that edges are sampled too."""
    return np.clip(shares * (1.0 + 2.0 * by) - by, 0.0, 1.0)


def between(ends: tuple[float, float], share: float) -> float:
    """Geometric mean of two ends, weighted by a share."""
    return ends[0] * (ends[1] / ends[0]) ** share
