"""Recipe of heat: what heat changes in rolling contacts; `Heated` applies it to answers.

Coordinates: M, L, kappa, the thermal load Q and the slope of the oil. In pure rolling, Q = -d eta0/dT u^2/k is
what the published factors depend on; their g = ln(1 + 0.1 (4 Q)^0.64)
(`ehlcontact.film_formulas.wilson_heating`) is the unit of all changes here. At given M, L, kappa and Q the
Peclet number of film and surfaces and Roelands' S0 follow the slope of the oil, -d ln(eta0)/dT, up to what alpha
and E' differ in. What else differs between oils is in the error bars.

Smooth variables, against the isothermal contact on the same grid: ln of the factors on 1 - u, both films, moment
and K over g; changes of C over C at Omega = 0 and g. So nothing changes where Q is 0. Outside the sample its
nearest coordinates are taken, and error bars grow with the distance from its points.

Sample: balls in races of bearings, in mineral oils of all grades: a Sobol sequence over ball, pitch circle,
conformity, oil, temperature, Q and load; races take turns. Draws that no bearing runs at, that the atlas does not
have or whose film needs a finer grid are left out.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from math import exp, log, sqrt
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Domain, Geometry, Grid, Heat, Lubricant, OperatingPoint
from ehlcontact.errors import InputError
from ehlcontact.film_formulas import load_number, wilson_heating
from ehlcontact.heat import MINERAL_OIL
from ehlcontact.hertz import hertz_contact
from ehlcontact.point import Point
from ehlcontact.response import TOLERANCE
from ehlcontact.status import Status
from reduced_models.atlas.conditions import Change, Condition, Rows
from reduced_models.atlas.film import BOX, HEAD, LOW, OMEGAS
from reduced_models.atlas.frequency_curve import over_frequency
from reduced_models.atlas.gain_fit import heated_gains
from reduced_models.atlas.recipe import Entry, Recipe, between, columns_of, entry_of, linear_answer, sobol
from reduced_models.atlas.surface import shipped
from reduced_models.atlas.table import Interpolation, Table
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]

# Frequencies of films; what heat changes follows them within 0.01 of the damping at low frequency, and 0.4 % of K.
HEAT_OMEGAS = tuple(OMEGAS[k] for k in (0, 3, 6, 8, 10, 13, 16, 19, 22, 25, 28, 33, 41))
# Stands for 0: on few grids oil far ahead of the contact has a slow temperature of a rate of
# 2e-3, which adds to C at lower frequencies (docs/notes/heat.md).
SLOWEST = 0.02
GRADES = (15, 22, 32, 46, 68, 100, 150)
BALL = (0.005, 0.026)  # m
PITCH = (3.2, 6.5)  # over the ball diameter
OSCULATION = (0.006, 0.045)  # conformity less a half
TEMPERATURE = (28.0, 95.0)  # C
THERMAL_LOAD = (0.01, 5.0)
FASTEST = 25.0  # m/s, mean surface speed: 1.2e6 mm/min of pitch circle times speed
PRESSURE = 4.1e9  # Pa
LIGHTEST = 0.95  # M
MORE_LOAD = 0.65  # power of the draw: denser at high load
MESH, WIDEST_MESH = 0.25, 0.33  # over the inlet width, at most; and on the finest grid
INTERVALS = (64, 96, 128, 160, 192)
DEAR_SPARSE = 4  # one contact of so many on the finest grid is solved: they take as long as all others

NUMBERS = ("film_share", "h_central", "h_min", "moment")  # then K and C over frequency
KNOWN = ("M", "L", "kappa", "thermal_load", "slope")  # coordinates of a contact
REFERENCE = 0.05  # Omega of the low-frequency damping
# Errors beside those of interpolation, in units of changes (docs/notes/heat.md): of the curves over Omega; of the
# meshes, of K and of all else but C, and of C; of data other than those of the table, per unit of their logarithm.
CURVE = 0.01
MESH_ERROR, MESH_ERROR_DAMPING = 0.03, 0.15
OTHER_DATA = {"heat_capacity": 0.55, "expansion": 0.3, "effusivity": 0.25}
BEYOND = 1.05  # factor by which Q and kappa may pass the ends of the sample
# Data that the contacts of the table have in common may be as far from those.
COMMON = {"heat_capacity": (1.4e6, 2.1e6), "expansion": (5e-4, 8e-4), "effusivity": (1.0e4, 1.6e4)}


@dataclass(frozen=True)
class HeatedContact:
    """Ball on a race in pure rolling, with the heat of its film."""

    point: OperatingPoint
    heat: Heat

    @property
    def inlet_width(self) -> float:
        """As `MoesPoint` has it: the order of a batch."""
        return self.point.moes.inlet_width

    def to_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        return {"point": asdict(self.point), "heat": self.heat.to_dict()}


def intervals_of(point: OperatingPoint) -> int | None:
    """Intervals along X that the inlet needs on the default region; None where more than a batch affords.

    The mesh is at most a quarter of the width of the inlet: what heat changes is then within 3 % of that on finer
    grids (docs/notes/heat.md).
    """
    region = Domain.for_point(point.moes)
    inlets = (region.x_out - region.x_in) / point.moes.inlet_width
    for n in INTERVALS:
        if inlets <= MESH * n:
            return n
    return INTERVALS[-1] if inlets <= WIDEST_MESH * INTERVALS[-1] else None


def _drawn(draws: int, seed: int) -> Iterator[HeatedContact | None]:
    for i, share in enumerate(sobol(7, draws, seed).tolist()):
        try:
            yield _contact(("inner", "outer")[i % 2], share)
        except InputError:  # an oil, a speed or a load that there is not
            yield None


def _contact(race: str, share: list[float]) -> HeatedContact | None:
    grade = GRADES[int(share[0] * len(GRADES))]
    oil = Lubricant.iso_vg(grade, temperature=float(np.interp(share[1], (0.0, 1.0), TEMPERATURE)))
    heat = Heat()
    assert oil.temperature_slope is not None
    speed = sqrt(between(THERMAL_LOAD, share[2]) * MINERAL_OIL / (oil.temperature_slope * oil.eta0))
    ball, osculation = between(BALL, share[3]), between(OSCULATION, share[4])
    pitch = ball * float(np.interp(share[5], (0.0, 1.0), PITCH))
    body = Geometry.ball_bearing(ball, pitch, 0.5 + osculation, race)
    unit = OperatingPoint(body, oil, 1.0, 2.0 * speed).moes
    pressure = hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).pressure
    most = min((PRESSURE / pressure) ** 3, BOX.M[1] / unit.M)
    point = OperatingPoint(body, oil, between((LIGHTEST / unit.M, most), share[6] ** MORE_LOAD), 2.0 * speed)
    return HeatedContact(point, heat) if speed <= FASTEST and BOX.L[0] <= unit.L <= BOX.L[1] else None


@entry_of
def solve_heated(contact: HeatedContact) -> dict[str, Any]:
    """Entry of a contact: film and impedance with heat, and isothermal on the same grid."""
    point = contact.point
    moes, heat = point.moes, contact.heat.at(point)
    numbers = heat.numbers(moes, point.scales)
    entry: dict[str, Any] = {name: getattr(moes, name) for name in ("M", "L", "kappa", "alpha", "eta0", "p_hertz")}
    entry |= {"thermal_load": heat.load(moes, point.scales), "slope": heat.temperature_slope}
    entry |= {"numbers": numbers._asdict() | {"shear": None}, "temperature": heat.temperature}
    entry |= {"u_sum": point.u_sum, "scales": asdict(point.scales)}
    if (n := intervals_of(point)) is None:
        return entry | {"status": str(Status.UNRESOLVED)}
    cold, warm = (respond(point, Grid(n, Domain.for_point(moes)), heat) for heat in (None, contact.heat))
    return entry | {"cold": cold, "warm": warm, "n": n}


def respond(point: OperatingPoint, grid: Grid, heat: Heat | None) -> dict[str, Any]:
    """Steady film and impedance at `HEAT_OMEGAS`."""
    return linear_answer(point, grid, HEAT_OMEGAS, SLOWEST, TOLERANCE, thermal=heat)


def unit_of(thermal_load: float) -> float:
    """g: unit of all changes, minus ln of Wilson and Sheu's factor, at Q."""
    return -log(wilson_heating(thermal_load))


def changes_of(entry: Entry) -> _Floats:
    """Smooth variables of an entry, shape (4 + 2 k,)."""
    cold, warm = entry["cold"], entry["warm"]
    share = [1.0 - answer["approach"] for answer in (warm, cold)]
    films = [warm[name] / cold[name] for name in NUMBERS[1:]]
    stiffness = np.divide(warm["stiffness"], cold["stiffness"])
    damping = np.subtract(warm["damping"], cold["damping"]) / cold["damping"][0]
    row = np.concatenate([np.log([share[0] / share[1], *films, *stiffness]), damping])
    return np.asarray(row / unit_of(entry["thermal_load"]))


class HeatRecipe(Recipe[HeatedContact]):
    """Changes by heat; places are rows (M, L, kappa, Q, slope [1/K])."""

    name, title, things = "heat", "table of heat", "contacts"
    numbers: ClassVar = {"draws": 256, "seed": 11}
    width = len(KNOWN)
    # Weights of least error of points left out, about.
    interpolation = Interpolation(weights=(0.6, 0.145, 0.08, 0.45, 0.5), nearest=10, covered=0.97)
    clipped = True
    solve = staticmethod(solve_heated)

    def sample(self, draws: int, seed: int = 0) -> dict[str, HeatedContact]:
        """Contacts by name; more draws add to the fewer."""
        contacts: dict[str, HeatedContact] = {}
        dear = 0
        for i, contact in enumerate(_drawn(draws, seed)):
            if contact is None or (n := intervals_of(contact.point)) is None:
                continue
            dear += n == INTERVALS[-1]
            if n < INTERVALS[-1] or dear % DEAR_SPARSE == 1:
                contacts[f"{seed}-{i}"] = contact
        return contacts

    def assemble(self, entries: Sequence[Entry]) -> tuple[_Floats, dict[str, _Floats], dict[str, _Floats]]:
        """Contacts, frequencies and changes."""
        changes = np.array([changes_of(entry) for entry in entries])
        return columns_of(entries, *KNOWN), {"omega": np.array(HEAT_OMEGAS)}, {"changes": changes}

    def metadata(self, entries: Sequence[Entry]) -> dict[str, Any]:
        """Meshes."""
        return {"meshes": {str(n): count for n, count in sorted(Counter(entry["n"] for entry in entries).items())}}

    def shapes(self, table: Table) -> dict[str, tuple[int, ...]]:
        """Shape of every axis and column."""
        k = table["omega"].size
        return {"omega": (k,), "changes": (len(table.points), len(NUMBERS) + 2 * k)}

    def require_metadata(self, table: Table) -> None:
        """Nothing is read from them but the interpolation."""

    def unit(self, table: Table, points: _Floats) -> _Floats:
        """G of every contact."""
        return np.array([unit_of(load) for load in points[:, KNOWN.index("thermal_load")].tolist()])

    def coordinates(self, table: Table, points: _Floats, unit: _Floats) -> tuple[_Floats, ...]:
        """Weighted ln N, L^(2/3), ln kappa, ln Q and ln of the slope, shape (n, 5)."""
        M, L, kappa, load, slope = points.T
        N = [load_number(*row) for row in zip(M.tolist(), kappa.tolist(), strict=True)]
        unweighted = np.column_stack([np.log(N), L ** (2.0 / 3.0), np.log(kappa), np.log(load), np.log(slope)])
        return (unweighted * np.array(table.interpolation.weights),)

    def smooth(self, table: Table, unit: _Floats) -> _Floats:
        """Changes over g, shape (n, 4 + 2 k)."""
        return table["changes"]

    def values(
        self, table: Table, points: _Floats, unit: _Floats, smooth: _Floats, bars: _Floats, **more: Any
    ) -> tuple[_Floats, _Floats]:
        """Changes and half widths of their error bars, shape (n, 4 + 2 k)."""
        return unit[:, None] * smooth, unit[:, None] * bars


RECIPE = HeatRecipe()


def _ends() -> _Floats:
    """Smallest and largest coordinates of the contacts of the table, shape (2, 5)."""
    return shipped("heat").table.ends


def largest_load() -> float:
    """Largest Q of the table."""
    return float(_ends()[1, KNOWN.index("thermal_load")])


def ellipses() -> tuple[float, float]:
    """Range of kappa of the table."""
    low, high = _ends()[:, KNOWN.index("kappa")].tolist()
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


class Heated(Condition):
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
    def speeds(self) -> tuple[float, float]:
        """Lowest and highest speed, over that of the point, at which the table has it: Q grows with its square."""
        return 0.0, sqrt(largest_load() / self.thermal_load)

    def change(self, loads: _Floats, values: _Floats, Omega: _Floats, isothermal: _Floats) -> Change:
        """Change of isothermal `values`, shape (n, 5 + 2 k), under `loads`, shape (n,), at `Omega`, shape (k,)."""
        surface, g, k = shipped("heat"), unit_of(self.thermal_load), Omega.size
        nodes = surface.table["omega"]
        numbers, half = len(NUMBERS), len(NUMBERS) + nodes.size
        rows, spread = surface.at(self._rows(loads))
        spread = np.hypot(spread, g * self._other_errors(half, spread.shape[1]))
        along = over_frequency(nodes, Omega)
        film, central, least, moment = np.exp(rows[:, :numbers]).T
        K = np.exp(rows[:, numbers:half] @ along)
        unit = values[:, [HEAD + k]] / values[:, [LOW]]  # of differences of C in the table over that of a `Change`
        C, low = unit * (rows[:, half:] @ along), int(np.argmin(np.abs(Omega - REFERENCE)))
        off_nodes = np.where(np.isin(Omega, nodes), 0.0, CURVE * g)
        stiff = K * np.hypot(spread[:, numbers:half] @ np.abs(along), off_nodes)
        damp = unit * np.hypot(spread[:, half:] @ np.abs(along), off_nodes)
        b_film, b_central, b_least, b_moment = (spread[:, :numbers] * np.exp(rows[:, :numbers])).T
        return Change(
            np.column_stack([film, central, least, C[:, low], moment, K, C]),
            np.column_stack([b_film, b_central, b_least, damp[:, low], b_moment, stiff, damp]),
        )

    def gains(self, gains: _Floats, low: _Floats, rates: FilterRates, before: Rows, after: Rows) -> _Floats:
        """Gains fitted to answers with heat, near those of the isothermal element."""
        rows = zip(before.impedance, after.impedance, np.maximum(gains, 0.0), low.tolist(), strict=True)
        return np.array([heated_gains(after.Omega, cold, hot, g, rates, unit) for cold, hot, g, unit in rows])

    def _other_errors(self, half: int, columns: int) -> _Floats:
        """Errors of meshes and of other data, in the unit of changes, shape (columns,)."""
        usual, data = Heat(), 0.0
        for name, error in OTHER_DATA.items():
            ratio = np.divide(getattr(self.heat, name), getattr(usual, name))
            data += error * float(np.abs(np.log(ratio)).max())
        return np.hypot(np.where(np.arange(columns) < half, MESH_ERROR, MESH_ERROR_DAMPING), data)

    def _rows(self, loads: _Floats) -> _Floats:
        """Coordinates at which the table is read."""
        assert self.heat.temperature_slope is not None
        others = self._moes.L, self._moes.kappa, self.thermal_load, self.heat.temperature_slope
        return np.column_stack([self._moes.M * loads, *(np.full(loads.size, number) for number in others)])

    def noted(self, flooded: float) -> dict[str, Any]:
        """Heat of the answer."""
        changes, _ = shipped("heat").at(self._rows(np.ones(1)))
        share = exp(changes[0, NUMBERS.index("h_central")])
        return {"temperature": HeatedFilm(self.heat, share, self.thermal_load)}

    def to_dict(self) -> dict[str, Any]:
        """Its inputs, ready for JSON."""
        return self.heat.to_dict()
