"""Table of the atlas: solved points, their answers, settings of the interpolation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_choice
from ehlcontact.errors import InputError
from ehlcontact.film_formulas import moes_pressure
from ehlcontact.point import MoesPoint
from ehlcontact.store import stored
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]

# Answers at a point stand in one row: approach, films, low-frequency C, moment; then K and C over frequency.
LOW, HEAD = 3, 5
KERNELS = {"cubic": 1}  # radial functions with the degree of the polynomial beside them


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
        low, high = np.transpose([self.M, self.L, self.kappa])
        inside = np.all((low <= points) & (points <= high), axis=1)
        inside[inside] = [moes_pressure(*row) <= self.p_hertz * alpha for row in points[inside].tolist()]
        if not inside.all():
            M, L, kappa = points[int(np.argmin(inside))].tolist()
            self.require_inside(MoesPoint(M, L, kappa, alpha))

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
    """Settings of the interpolation; error bars of an atlas are valid for the settings of its build only.

    Raises
    ------
    InputError
        A kernel, or a degree, that this library does not know.
    """

    weights: tuple[float, ...]  # of the coordinates, in the order of `surface.coordinates`
    lobe_weights: tuple[float, ...]  # of the first four of them, for Hm/Hc
    light_load: float  # load number about which the default domain began to grow at the time of the build
    light_blend: float  # and the factor on it over which
    thick: float  # film, in dry approaches, beyond which the published one no longer leads
    asinh: float  # of the low-frequency damping: where asinh turns from ln to linear
    reference: int  # index of the frequency of the low-frequency damping
    nearest: int  # points whose errors make the error bar
    covered: float  # share of points that the error bar covers when each is left out
    kernel: str = "cubic"
    degree: int = 1

    def __post_init__(self) -> None:
        for name in ("weights", "lobe_weights"):
            object.__setattr__(self, name, tuple(float(weight) for weight in getattr(self, name)))
        require_choice("kernel of the atlas", self.kernel, tuple(KERNELS))
        if self.degree != KERNELS[self.kernel]:
            raise InputError("degree of the atlas", self.degree, f"{KERNELS[self.kernel]} beside {self.kernel!r}")


@dataclass(frozen=True)
class OtherOil:
    """Range of alpha and eta0 around those of the atlas; correction and wider error bars for another oil.

    At given M, L and kappa, alpha and eta0 enter through the curvature of Roelands' law and the compressibility.
    Pressures up to about 2/alpha form the film, so the atlas is read at an L with the secant of ln(eta) up to
    there in place of its slope at ambient pressure, each over that of the oil of the atlas. Error bars widen by
    what is left: the largest change of ln of films, K, C and moment per unit of ln alpha and of ln eta0.
    """

    alpha: tuple[float, float]  # range [1/Pa]
    eta0: tuple[float, float]  # range [Pa s]
    secant: float  # alpha p at the end of the secant
    film: tuple[float, float]
    stiffness: tuple[float, float]  # K changes the less the thinner the film
    damping: tuple[float, float]
    moment: tuple[float, float]

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            object.__setattr__(self, name, float(value) if name == "secant" else tuple(map(float, value)))


def require_shapes(table: object, shapes: Mapping[str, tuple[int, ...]]) -> None:
    """Raise `ValueError` unless arrays of a table have these shapes, and finite numbers."""
    for name, shape in shapes.items():
        array = getattr(table, name)
        if array.shape != shape or not np.isfinite(array).all():
            raise ValueError(f"{name} of shape {array.shape} in place of finite numbers of shape {shape}")


@stored("table of an atlas", 4)
@dataclass(frozen=True, eq=False)
class AtlasTable:
    """Arrays over the n solved points, in the units of each point's own load."""

    points: _Floats  # (n, 3) M, L, kappa
    omega: _Floats  # (k,)
    approach: _Floats  # (n,)
    h_central: _Floats  # (n,)
    h_min: _Floats  # (n,)
    moment: _Floats  # (n,)
    stiffness: _Floats  # (n, k) K(Omega)
    damping: _Floats  # (n, k) C(Omega)
    gains: _Floats  # (n, 3 + lags) of the film memory, over the damping at the lowest frequency > 0
    left_out: _Floats  # (n, 5 + 2 k) error at each point of an interpolation without it, see `surface`
    factor: _Floats  # (5 + 2 k,) from the errors of the nearest points to the error bar
    metadata: dict[str, Any]  # box, rates, interpolation, oil; command, version, sample, meshes, failures

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)

    @property
    def box(self) -> Box:
        """Ranges of M, L, kappa and Hertz pressure."""
        return Box.from_dict(self.metadata["box"])

    @property
    def rates(self) -> FilterRates:
        """Of the film memory, the same at all points."""
        return FilterRates(**self.metadata["rates"])

    @property
    def interpolation(self) -> Interpolation:
        """Settings of the interpolation."""
        return Interpolation(**self.metadata["interpolation"])

    @property
    def oil(self) -> OtherOil:
        """Accepted other oils."""
        return OtherOil(**self.metadata["oil"])

    @property
    def answers(self) -> _Floats:
        """Interpolated quantities, shape (n, 5 + 2 k)."""
        low = self.damping[:, self.interpolation.reference]
        head = self.approach, self.h_central, self.h_min, low, self.moment
        return np.column_stack([*head, self.stiffness, self.damping])

    def require_complete(self) -> None:
        """Raise `ValueError` or another error of damaged metadata unless all arrays are there and fit.

        Raises
        ------
        ValueError
            An array of another shape, or with numbers that are not finite.
        """
        n, k = self.approach.size, self.omega.size
        gains = 3 + self.rates.lags
        shapes = {"points": (n, 3), "omega": (k,), "left_out": (n, HEAD + 2 * k), "factor": (HEAD + 2 * k,)}
        shapes |= dict.fromkeys(("approach", "h_central", "h_min", "moment"), (n,)) | {"gains": (n, gains)}
        shapes |= dict.fromkeys(("stiffness", "damping"), (n, k))
        require_shapes(self, shapes)
        _ = self.box, self.oil, float(self.metadata["highest_omega"]), str(self.metadata["version"])
        if not 0 <= self.interpolation.reference < k:
            raise ValueError(f"reference {self.interpolation.reference} is no frequency of {k}")

    def rounded(self) -> Self:
        """Table in single precision but for the points, as in the file that comes with the library."""
        names = [f.name for f in fields(self) if f.name not in ("points", "omega", "metadata")]
        return replace(self, **{name: getattr(self, name).astype(np.float32).astype(float) for name in names})
