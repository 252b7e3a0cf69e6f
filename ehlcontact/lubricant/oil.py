"""Mineral oils by their viscosities at 40 and 100 C, or by ISO viscosity grade and viscosity index.

Walther's line through both viscosities gives any other (ASTM D341), and thermal expansion the density
(ASTM D1250). Data sheets print both. A grade is the one at 40 C (ISO 3448), and the viscosity index gives the one
at 100 C (ASTM D2270).
None of this says how viscosity rises with pressure: that is a correlation over measured oils, and its scatter is
the largest uncertainty of all. Formulas, sources and checks: docs/notes/assumptions.md.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from math import exp, log, log10
from numbers import Real
from operator import attrgetter
from typing import NamedTuple

from ehlcontact.checks import require_finite
from ehlcontact.checks.admissible_range import Quantity
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import InputError

KELVIN = 273.15  # of 0 C
GRADES = (10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460, 680)  # ISO 3448: mm2/s at 40 C; thinner ones have no VI
GRADE_SCATTER = 0.10  # relative, of the viscosity at 40 C: what ISO 3448 allows a grade
SHEET_SCATTER = 0.05  # relative, our judgement: batches of a product about the values of its data sheet
# C: around 40 and 100, between which Walther's line is drawn; colder, oils leave it, hotter, few are run
TEMPERATURES = (20.0, 120.0)
INDICES = (80.0, 120.0)  # of API group I and II oils (API 1509): the mineral oils that the correlations are of
ALL_INDICES = (-100.0, 400.0)  # from traction fluids to the thinnest silicone oils
USUAL_INDEX = 95.0
DENSITIES = (800.0, 950.0)  # kg/m3 at 15 C, of any mineral oil
USUAL_DENSITY_15 = 875.0
USUAL_DENSITY = 850.0  # kg/m3, of mineral oils at 50 C within 2 %: of an oil known by eta0 alone
WALTHER_SHIFT = 0.7  # mm2/s, ASTM D341; good down to the viscosity below
THINNEST = 2.0  # mm2/s, for which ASTM D341 and D2270 hold without further terms
KINEMATIC = Quantity("mm2/s", (THINNEST, 2000.0), (THINNEST, 2000.0), {"m2/s": 1e6, "St": 100.0})
EXPANSION = 0.6278  # kg/(m3 K): K1 of lubricating oils, ASTM D1250 (API MPMS 11.1), table 54D; K0 is 0

# alpha = s nu^t over the secant from 0 to 200 MPa, of mineral oils: Gold, Schmidt, Dicke, Loos and Assmann,
# J. Synthetic Lubrication 18 (2001) 51-79; nu in mm2/s at the temperature, s in 1/Pa
GOLD_S, GOLD_T = 9.904e-9, 0.1390
GOLD_PRESSURE = 2e8  # Pa, the end of that secant
# Relative, our judgement: the correlation is 3 to 10 % below the secants measured of FVA 3 (ISO VG 100) between 20
# and 100 C, and 3 to 13 % below what is quoted for VG 68 at 50 C; oils of another crude differ as much again.
ALPHA_SCATTER = 0.20
# Oils with another viscosity index than the correlation's are hydrocracked or synthetic: Gold et al. measured a
# quarter (polyalphaolefins) to a third (esters) less than of mineral oils of the same viscosity.
OTHER_ALPHA_SCATTER = 0.35

# -d ln(eta)/dT over ln(nu + 0.7), 1/K: within 15 % of ASTM D341 for VG 22 to 220 at 40 to 80 C
TYPICAL_SLOPE = 0.0112
LEAST_SLOPE = 0.01  # 1/K, where that formula ends: of liquids thinner than any oil, water has 0.02 and hexane 0.01
TYPICAL_DENSITY = 860.0  # kg/m3, of a warm mineral oil: only to tell nu from eta0 in that slope


class _IndexRow(NamedTuple):
    """L and H of ASTM D2270 as ``a Y^2 + b Y + c`` and ``d Y^2 + e Y + f`` from this viscosity at 100 C on."""

    least: float  # mm2/s
    a: float
    b: float
    c: float
    d: float
    e: float
    f: float


INDEX_ROWS = (  # ASTM D2270, table X2.1
    _IndexRow(2.0, 1.14673, 1.7576, -0.109, 0.84155, 1.5521, -0.077),
    _IndexRow(3.8, 3.38095, -15.4952, 33.196, 0.78571, 1.7929, -0.183),
    _IndexRow(4.4, 2.5000, -7.2143, 13.812, 0.82143, 1.5679, 0.119),
    _IndexRow(5.0, 0.10100, 16.6350, -45.469, 0.04985, 9.1613, -18.557),
    _IndexRow(6.4, 3.35714, -23.5643, 78.466, 0.22619, 7.7369, -16.656),
    _IndexRow(7.0, 0.01191, 21.4750, -72.870, 0.79762, -0.7321, 14.610),
    _IndexRow(7.7, 0.41858, 16.1558, -56.040, 0.05794, 10.5156, -28.240),
    _IndexRow(9.0, 0.88779, 7.5527, -16.600, 0.26665, 6.7015, -10.810),
    _IndexRow(12.0, 0.76720, 10.7972, -38.180, 0.20073, 8.4658, -22.490),
    _IndexRow(15.0, 0.97305, 5.3135, -2.200, 0.28889, 5.9741, -4.930),
    _IndexRow(18.0, 0.97256, 5.2500, -0.980, 0.24504, 7.4160, -16.730),
    _IndexRow(22.0, 0.91413, 7.4759, -21.820, 0.20323, 9.1267, -34.230),
    _IndexRow(28.0, 0.87031, 9.7157, -50.770, 0.18411, 10.1015, -46.750),
    _IndexRow(40.0, 0.84703, 12.6752, -133.310, 0.17029, 11.4866, -80.620),
    _IndexRow(55.0, 0.85921, 11.1009, -83.190, 0.17130, 11.3680, -76.940),
    _IndexRow(70.0, 0.83531, 14.6731, -216.246, 0.16841, 11.8493, -96.947),
)
INDEX_PER_POWER = 0.00715  # ASTM D2270, procedure B
INDEX_ROUNDING = 0.05  # where rows of the table meet
HALVINGS = 60  # of the interval for the viscosity at 100 C: to the last bit


def viscosity_index(nu_40: float, nu_100: float) -> float:
    """Viscosity index from the kinematic viscosities at 40 and 100 C [mm2/s]; ASTM D2270, procedures A and B."""
    row = INDEX_ROWS[max(bisect_right(INDEX_ROWS, nu_100, key=attrgetter("least")) - 1, 0)]
    y = nu_100
    low, high = row.a * y * y + row.b * y + row.c, row.d * y * y + row.e * y + row.f
    if nu_40 >= high:
        return 100.0 * (low - nu_40) / (low - high)
    power: float = (high / nu_40) ** (1.0 / log10(y))  # antilog of (lg H - lg U)/lg Y
    return (power - 1.0) / INDEX_PER_POWER + 100.0


def viscosity_at_100(nu_40: float, index: float) -> float:
    """Viscosity at 100 C [mm2/s] that gives an oil of `nu_40` this index: ASTM D2270, inverted."""
    low, high = THINNEST, nu_40
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if viscosity_index(nu_40, middle) < index else (low, middle)
    return low


def typical_temperature_slope(eta0: float) -> float:
    """-d ln(eta)/dT [1/K] of a mineral oil of which only the viscosity [Pa s] is known; within some 15 %."""
    return max(TYPICAL_SLOPE * log(eta0 / TYPICAL_DENSITY * 1e6 + WALTHER_SHIFT), LEAST_SLOPE)


@fields_take(nu40=KINEMATIC, nu100=KINEMATIC, temperature="degrees Celsius", density_15="kg/m3")
@dataclass(frozen=True, slots=True)
class MineralOil:
    """A mineral oil at a temperature, by its viscosities at 40 and 100 C; `of_grade` has it by its grade.

    Parameters
    ----------
    nu40, nu100 : float
        Kinematic viscosities at 40 and 100 C [mm2/s], 2 to 2000.
    temperature : float
        In degrees Celsius, 20 to 120.
    density_15 : float
        Density at 15 C [kg/m3]; those of one grade differ by 1 to 2 %.

    Raises
    ------
    InputError
        A value outside its range; viscosities of no oil; or an oil so thin and hot (below 2 mm2/s) that no
        standard covers it.
    """

    nu40: float
    nu100: float
    temperature: float
    density_15: float = USUAL_DENSITY_15
    walther_slope: float = field(init=False)  # B of lg lg(nu + 0.7) = A - B lg(T/K)

    def __post_init__(self) -> None:
        if not self.nu100 < self.nu40:
            raise InputError("nu100", self.nu100, f"below nu40 = {self.nu40:g} mm2/s: oils are thinner at 100 C")
        hint = " (degrees Celsius; given in K?)" if _looks_kelvin(self.temperature) else " degrees Celsius"
        self._require("temperature", TEMPERATURES, hint)
        hint = " kg/m3 (given in g/cm3?)" if _looks_gram(self.density_15) else " kg/m3"
        self._require("density_15", DENSITIES, hint)
        if not ALL_INDICES[0] <= self.viscosity_index <= ALL_INDICES[1]:
            allowed = (
                f"that of an oil with {self.nu40:g} mm2/s at 40 C: a viscosity index of {ALL_INDICES[0]:g} to"
            )
            raise InputError("nu100", self.nu100, f"{allowed} {ALL_INDICES[1]:g}, not {self.viscosity_index:.4g}")
        slope = (_double_log(self.nu40) - _double_log(self.nu100)) / _log_ratio(100.0)
        object.__setattr__(self, "walther_slope", slope)
        if self.kinematic_viscosity < THINNEST:
            nu = f"one with at least {THINNEST:g} mm2/s (ASTM D341); this oil has"
            raise InputError("temperature", self.temperature, f"{nu} {self.kinematic_viscosity:.2f}")

    @classmethod
    def of_grade(
        cls,
        grade: int,
        temperature: float,
        viscosity_index: float = USUAL_INDEX,
        density_15: float = USUAL_DENSITY_15,
    ) -> MineralOil:
        """A mineral oil by its ISO viscosity grade, the kinematic viscosity at 40 C [mm2/s]; 10 to 680.

        Raises
        ------
        InputError
            Another grade; a viscosity index outside 80 to 120, as API groups I and II have; what the class
            refuses.
        """
        nu40 = _require_grade(grade)
        index = require_finite("viscosity_index", viscosity_index)
        if not INDICES[0] <= index <= INDICES[1]:
            allowed = f"between {INDICES[0]:g} and {INDICES[1]:g}, as mineral oils have"
            raise InputError("viscosity_index", index, f"{allowed}; any other oil by nu40 and nu100")
        return cls(nu40, viscosity_at_100(nu40, index), temperature, density_15)

    @property
    def viscosity_index(self) -> float:
        """ASTM D2270."""
        return viscosity_index(self.nu40, self.nu100)

    @property
    def kinematic_viscosity(self) -> float:
        """Viscosity at the temperature [mm2/s]: Walther's line, ASTM D341."""
        line = _double_log(self.nu40) - self.walther_slope * _log_ratio(self.temperature)
        return float(10.0**10.0**line) - WALTHER_SHIFT

    @property
    def density(self) -> float:
        """Density at the temperature [kg/m3]: ``rho15 exp(-x - 0.8 x^2)``, x = K1 (T - 15 C)/rho15; ASTM D1250."""
        x = EXPANSION / self.density_15 * (self.temperature - 15.0)
        return self.density_15 * exp(-x * (1.0 + 0.8 * x))

    @property
    def eta0(self) -> float:
        """Dynamic viscosity at ambient pressure [Pa s]."""
        return self.kinematic_viscosity * 1e-6 * self.density

    @property
    def temperature_slope(self) -> float:
        """-d ln(eta0)/dT [1/K]: of Walther's line, and of the density."""
        nu, kelvin = self.kinematic_viscosity, self.temperature + KELVIN
        shifted = nu + WALTHER_SHIFT
        expansion = EXPANSION / self.density_15
        of_density = expansion * (1.0 + 1.6 * expansion * (self.temperature - 15.0))
        return self.walther_slope * shifted * log(shifted) / (nu * kelvin) + of_density

    @property
    def alpha_secant(self) -> float:
        """``ln(eta/eta0)/p`` at 200 MPa [1/Pa], within `alpha_scatter`: Gold et al. (2001)."""
        return float(GOLD_S * self.kinematic_viscosity**GOLD_T)

    @property
    def alpha_scatter(self) -> float:
        """How far, relative, the oil may be from that correlation: more, where it has another viscosity index."""
        usual = INDICES[0] - INDEX_ROUNDING <= self.viscosity_index <= INDICES[1] + INDEX_ROUNDING
        return ALPHA_SCATTER if usual else OTHER_ALPHA_SCATTER

    def _require(self, name: str, allowed: tuple[float, float], unit: str) -> None:
        value = require_finite(name, getattr(self, name))
        if not allowed[0] <= value <= allowed[1]:
            raise InputError(name, value, f"between {allowed[0]:g} and {allowed[1]:g}{unit}")
        object.__setattr__(self, name, value)


def _require_grade(grade: object) -> int:
    if isinstance(grade, bool) or not isinstance(grade, Real) or grade not in GRADES:
        raise InputError("iso_vg", grade, "one of " + ", ".join(map(str, GRADES)))
    return int(float(grade))


def _double_log(nu: float) -> float:
    return log10(log10(nu + WALTHER_SHIFT))


def _log_ratio(temperature: float) -> float:
    """Decimal logarithm of the absolute temperature over that of the grade, 40 C."""
    return log10((temperature + KELVIN) / (40.0 + KELVIN))


def _looks_kelvin(temperature: object) -> bool:
    return (
        isinstance(temperature, int | float)
        and TEMPERATURES[0] + KELVIN <= temperature <= TEMPERATURES[1] + KELVIN
    )


def _looks_gram(density: object) -> bool:
    return isinstance(density, int | float) and DENSITIES[0] * 1e-3 <= density <= DENSITIES[1] * 1e-3
