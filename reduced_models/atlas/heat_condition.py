"""`HeatCondition`: change of answers of the atlas by heat, from the table of heat."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import exp, sqrt
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.heat import Heat, heat_given
from ehlcontact.point import OperatingPoint, Point
from ehlcontact.store import read as read_file
from reduced_models.atlas.change import Change
from reduced_models.atlas.frequency_curve import over_frequency
from reduced_models.atlas.heat_table import KNOWN, NUMBERS, HeatSurface, HeatTable, unit_of
from reduced_models.atlas.table import HEAD, LOW

_Floats = NDArray[np.float64]

SHIPPED = Path(__file__).with_name("heat.h5")
REFERENCE = 0.05  # Omega of the low-frequency damping
# Errors beside those of the interpolation, in the unit of changes (docs/heat.md): of the curves over Omega; of the
# meshes, of K and of all else but C, and of C; of data other than those of the table, per unit of their logarithm.
CURVE = 0.01
MESH, MESH_DAMPING = 0.03, 0.15
OTHER_DATA = {"heat_capacity": 0.55, "expansion": 0.3, "effusivity": 0.25}
BEYOND = 1.05  # factor by which Q and kappa may pass the ends of the sample
# Data that the contacts of the table have in common may be as far from those.
COMMON = {"heat_capacity": (1.4e6, 2.1e6), "expansion": (5e-4, 8e-4), "effusivity": (1.0e4, 1.6e4)}


@cache
def heat_surface() -> HeatSurface:
    """The table that comes with the library, read once."""
    return HeatSurface(read_file(SHIPPED, HeatTable, "table of heat"))


def rolling_heat(thermal: object) -> Heat | None:
    """Heat that is asked for, as by `heat_given`, of pure rolling.

    Raises
    ------
    InputError
        Neither, nor a `Heat` that the table has.
    """
    found = heat_given(thermal)
    if found is not None:
        require_rolling(found)
    return found


def largest_load() -> float:
    """Largest Q of the table."""
    return float(heat_surface().ends[1, KNOWN.index("thermal_load")])


def ellipses() -> tuple[float, float]:
    """Range of kappa of the table."""
    low, high = heat_surface().ends[:, KNOWN.index("kappa")].tolist()
    return low / BEYOND, high * BEYOND


def fastest(point: OperatingPoint, thermal: Heat) -> float:
    """Speed over that of the point at which the table ends: Q grows with its square."""
    return sqrt(largest_load() / thermal.at(point).load(point.moes, point.scales))


def require_rolling(thermal: Heat) -> None:
    """Raise `InputError` unless this heat is of pure rolling, with data near those of the table."""
    if thermal.slide_roll != 0.0:
        allowed = "0: answers of the atlas are those of pure rolling (solve_steady takes sliding)"
        raise InputError("slide_roll", thermal.slide_roll, allowed)
    if thermal.temperature_slope == 0.0:
        raise InputError("temperature_slope", 0.0, "above 0: an oil that heat does not change has no thermal load")
    for name, (low, high) in COMMON.items():
        for value in np.atleast_1d(getattr(thermal, name)).tolist():
            if not low <= value <= high:
                raise InputError(name, value, f"between {low:g} and {high:g}, near that of the table of heat")


@dataclass(frozen=True)
class HeatedFilm:
    """Heat of an `AtlasAnswer`.

    Attributes
    ----------
    inputs : Heat
        As given, with the data of the oil.
    film_share : float
        Central film over that without heat.
    thermal_load : float
        Q = -d eta0/dT u_mean^2/k.
    """

    inputs: Heat
    film_share: float
    thermal_load: float

    @property
    def summary(self) -> str:
        """Loss of film by heat, in words."""
        return f"heat makes the film {100.0 * (1.0 - self.film_share):.3g} % thinner in the centre"

    def to_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        return {"inputs": self.inputs.to_dict(), "film_share": self.film_share, "thermal_load": self.thermal_load}


class HeatCondition:
    """Heat of a film at a point; loads are in units of the point's.

    Raises
    ------
    InputError
        A dimensionless point, an oil without data; a contact or a heat that the table does not have.
    """

    name = "thermal"

    def __init__(self, point: Point, thermal: Heat) -> None:
        require_rolling(thermal)
        self.heat = thermal.at(point)
        assert isinstance(point, OperatingPoint)
        self._moes, self._scales = point.moes, point.scales
        self.thermal_load = self.heat.load(point.moes, point.scales)
        if self.thermal_load > BEYOND * (most := largest_load()):
            allowed = f"at most {most:.3g}, where the table of heat ends: a lower speed, or a thinner oil"
            raise InputError("thermal load Q", f"{self.thermal_load:.3g}", allowed)
        low, high = ellipses()
        if not low <= point.moes.kappa <= high:
            allowed = f"between {low:.3g} and {high:.3g}, as in the table of heat"
            raise InputError("kappa", f"{point.moes.kappa:.3g}", allowed)

    @property
    def fastest(self) -> float:
        """Speed over that of the point at which the table ends: Q grows with its square."""
        return sqrt(largest_load() / self.thermal_load)

    def change(self, loads: _Floats, values: _Floats, Omega: _Floats) -> Change:
        """Change of isothermal `values`, shape (n, 5 + 2 k), under `loads`, shape (n,), at `Omega`, shape (k,)."""
        g, k, half = unit_of(self.thermal_load), Omega.size, len(NUMBERS) + heat_surface().table.omega.size
        found, bars = (g * part for part in heat_surface().at(self._rows(loads)))
        bars = np.hypot(bars, g * self._other_errors(half, bars.shape[1]))
        along = over_frequency(heat_surface().table.omega, Omega)
        film, central, least, moment = np.exp(found[:, : len(NUMBERS)]).T
        K = np.exp(found[:, len(NUMBERS) : half] @ along)
        unit = values[:, [HEAD + k]] / values[:, [LOW]]  # of differences of C in the table over that of a `Change`
        C, low = unit * (found[:, half:] @ along), int(np.argmin(np.abs(Omega - REFERENCE)))
        between = np.where(np.isin(Omega, heat_surface().table.omega), 0.0, CURVE * g)
        stiff = K * np.hypot(bars[:, len(NUMBERS) : half] @ np.abs(along), between)
        damp = unit * np.hypot(bars[:, half:] @ np.abs(along), between)
        b_film, b_central, b_least, b_moment = (bars[:, : len(NUMBERS)] * np.exp(found[:, : len(NUMBERS)])).T
        return Change(
            np.column_stack([film, central, least, C[:, low], moment, K, C]),
            np.column_stack([b_film, b_central, b_least, damp[:, low], b_moment, stiff, damp]),
        )

    def _other_errors(self, half: int, columns: int) -> _Floats:
        """Errors of meshes and of other data, in the unit of changes, shape (columns,)."""
        usual, data = Heat(), 0.0
        for name, error in OTHER_DATA.items():
            ratio = np.divide(getattr(self.heat, name), getattr(usual, name))
            data += error * float(np.abs(np.log(ratio)).max())
        return np.hypot(np.where(np.arange(columns) < half, MESH, MESH_DAMPING), data)

    def _rows(self, loads: _Floats) -> _Floats:
        """Coordinates at which the table is read."""
        assert self.heat.temperature_slope is not None
        others = self._moes.L, self._moes.kappa, self.thermal_load, self.heat.temperature_slope
        return np.column_stack([self._moes.M * loads, *(np.full(loads.size, one) for one in others)])

    def noted(self, flooded: float, film: float) -> dict[str, Any]:
        """Heat of the answer."""
        changes, _ = heat_surface().at(self._rows(np.ones(1)))
        share = exp(unit_of(self.thermal_load) * changes[0, NUMBERS.index("h_central")])
        return {"temperature": HeatedFilm(self.heat, share, self.thermal_load)}

    def to_dict(self) -> dict[str, Any]:
        """Its inputs, ready for JSON."""
        return self.heat.to_dict()
