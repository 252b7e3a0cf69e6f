"""`Table`: contacts solved for the atlas, by any recipe: points, named columns, metadata; their file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_choice
from ehlcontact.errors import InputError
from ehlcontact.film_formulas import moes_pressure
from ehlcontact.point import MoesPoint
from ehlcontact.store import stored

if TYPE_CHECKING:
    from reduced_models.atlas.recipe import Recipe

_Floats = NDArray[np.float64]

RECIPES = ("film", "supply", "heat", "waves")  # modules of this package
KERNELS = {"cubic": 1}  # radial functions with the degree of the polynomial beside them


def recipe_named(name: str) -> Recipe[Any]:
    """Recipe of a table; raises `ValueError` for a name that there is not."""
    if name not in RECIPES:
        raise ValueError(f"no recipe {name!r}")
    recipe: Recipe[Any] = import_module(f"{__package__}.{name}").RECIPE
    return recipe


@dataclass(frozen=True)
class Box:
    """Ranges of M, L and kappa, and the largest Hertz pressure [Pa]; closed."""

    M: tuple[float, float]
    L: tuple[float, float]
    kappa: tuple[float, float]
    p_hertz: float

    def require_inside(self, point: MoesPoint) -> None:
        """Raise `InputError` naming the axis and the box unless the point lies inside."""
        for name in ("M", "L", "kappa"):
            low, high = getattr(self, name)
            value = getattr(point, name)
            if not low <= value <= high:
                raise InputError(name, value, f"between {low:g} and {high:g}, the box of the atlas ({self})")
        if point.p_hertz > self.p_hertz:
            allowed = f"at most {self.p_hertz / 1e9:g}e9 Pa, the limit of the atlas ({self})"
            raise InputError("Hertz pressure", f"{point.p_hertz:.4g} Pa", allowed)

    def require_all_inside(self, points: _Floats, alpha: float) -> None:
        """Raise `InputError` for the first of many rows (M, L, kappa) that lies outside."""
        low, high = self.ends
        inside = np.all((low <= points) & (points <= high), axis=1)
        inside[inside] = [moes_pressure(*row) <= self.p_hertz * alpha for row in points[inside].tolist()]
        if not inside.all():
            M, L, kappa = points[int(np.argmin(inside))].tolist()
            self.require_inside(MoesPoint(M, L, kappa, alpha))

    @property
    def ends(self) -> _Floats:
        """Smallest and largest M, L and kappa, shape (2, 3)."""
        return np.transpose([self.M, self.L, self.kappa])

    def __str__(self) -> str:
        M, L, kappa = (f"{low:g}..{high:g}" for low, high in (self.M, self.L, self.kappa))
        return f"M {M}, L {L}, kappa {kappa}, Hertz pressure up to {self.p_hertz / 1e9:g} GPa"

    def to_dict(self) -> dict[str, Any]:
        """All fields, for storage."""
        return asdict(self)

    @classmethod
    def from_dict(cls, entries: Mapping[str, Any]) -> Self:
        """Box of the fields of `to_dict`."""
        M, L, kappa = ((float(low), float(high)) for low, high in (entries[name] for name in ("M", "L", "kappa")))
        return cls(M, L, kappa, float(entries["p_hertz"]))


@dataclass(frozen=True)
class Interpolation:
    """Settings of the interpolation; error bars of a table are valid for the settings of its build only.

    Raises
    ------
    InputError
        A kernel, or a degree, that this library does not have.
    """

    weights: tuple[float, ...]  # of the coordinates, in the order of the recipe
    nearest: int  # points whose errors make the error bar
    covered: float  # share of points that the error bar covers when each is left out
    kernel: str = "cubic"
    degree: int = 1

    def __post_init__(self) -> None:
        object.__setattr__(self, "weights", tuple(float(weight) for weight in self.weights))
        require_choice("kernel of the atlas", self.kernel, tuple(KERNELS))
        if self.degree != KERNELS[self.kernel]:
            raise InputError("degree of the atlas", self.degree, f"{KERNELS[self.kernel]} beside {self.kernel!r}")


@stored("table of an atlas")
@dataclass(frozen=True, eq=False)
class Table:
    """Solved points of a recipe; ``table[name]`` is an axis or a column in double precision.

    Attributes
    ----------
    recipe : str
        Name of the recipe.
    points : ndarray, shape (n, d)
        Coordinates of the solved points.
    axes : dict of ndarray
        What columns are over beside the points: frequencies, layers, wave numbers.
    columns : dict of ndarray
        Answers, in single precision once they are `rounded`. Where the recipe keeps them, ``left_out``: errors at
        each point of an interpolation without it, and ``factor``: from the errors of the nearest points to the
        error bar.
    metadata : dict
        Box and settings; command, version, sample, meshes, failures.
    """

    recipe: str
    points: _Floats
    axes: dict[str, _Floats]
    columns: dict[str, _Floats]
    metadata: dict[str, Any]

    def __post_init__(self) -> None:
        for array in (self.points, *self.axes.values(), *self.columns.values()):
            array.setflags(write=False)

    def __getitem__(self, name: str) -> _Floats:
        return np.asarray(self.axes[name] if name in self.axes else self.columns[name], float)

    @cached_property
    def box(self) -> Box:
        """Ranges of M, L, kappa and Hertz pressure."""
        return Box.from_dict(self.metadata["box"])

    @cached_property
    def ends(self) -> _Floats:
        """Smallest and largest coordinates of its points, shape (2, d)."""
        return np.array([self.points.min(axis=0), self.points.max(axis=0)])

    @cached_property
    def interpolation(self) -> Any:
        """Settings of the interpolation: `Interpolation`, or what the recipe makes of it."""
        return recipe_named(self.recipe).settings(**self.metadata["interpolation"])

    def rounded(self) -> Self:
        """Table with columns in the precision of the recipe, stored as single; points and axes stay."""
        precision = recipe_named(self.recipe).precision
        columns: dict[str, Any] = {
            name: array.astype(precision).astype(np.float32) for name, array in self.columns.items()
        }
        return replace(self, columns=columns)

    def require_complete(self) -> None:
        """Raise `ValueError` or another error of damaged metadata unless all arrays are there and fit.

        Raises
        ------
        ValueError
            An array of another shape, or with numbers that are not finite; a recipe that there is not.
        """
        recipe = recipe_named(self.recipe)
        for name, shape in {"points": (len(self.points), recipe.width), **recipe.shapes(self)}.items():
            array = self.points if name == "points" else self[name]
            if array.shape != shape or not np.isfinite(array).all():
                raise ValueError(f"{name} of shape {array.shape} in place of finite numbers of shape {shape}")
        _ = self.interpolation
        recipe.require_metadata(self)
