"""Admissible ranges of inputs, checked before any solve, with the unit that a value outside was probably given in.

Solves far outside the range do not fail at once: they refine, turn to Newton, and end after minutes. And a
number that far outside is usually an input in another unit: a viscosity in mPa s, or a diameter in mm. So every
solve begins with `point.require_solvable`, and a study calls it before all of its computations.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from numbers import Number
from typing import Any, NamedTuple

import numpy as np

from ehlcontact.checks.inputs import as_numbers, require_number
from ehlcontact.errors import InputError

MADE_FOR = "what the solvers are made for"
ROUNDED = 1e-12  # of a limit


class Quantity(NamedTuple):
    """What a number with a unit can be, what it usually is, and the units it may have been given in instead."""

    unit: str
    limits: tuple[float, float]  # beyond them it is no rolling contact, and no part of a machine
    usual: tuple[float, float]  # where a corrected value has to lie to be suggested
    others: Mapping[str, float] = {}  # other unit: its size in `unit`
    zero: bool = False  # 0 leaves it out
    signed: bool = False  # limits and usual values are magnitudes, of which the lower limit is 0
    shifts: Mapping[str, float] = {}  # other unit of the same size: what is to be added, as for K
    most: int = 10**9  # numbers of an array
    definitions: Mapping[str, tuple[float, int]] = {}  # other definition: (factor, power) of such a value
    slips: bool = False  # a value within the limits is refused that another unit would make a usual one

    def slip(self, value: float) -> str:
        """The unit that an unusual value betrays, and what it is then; empty if none makes it usual."""
        low, high = self.usual
        size = abs(value) if self.signed else value
        if low <= size <= high:
            return ""
        corrected = {unit: value * its for unit, its in self.others.items()}
        corrected |= {unit: value + shift for unit, shift in self.shifts.items()}
        for other, then in corrected.items():
            if low <= (abs(then) if self.signed else then) <= high:
                return f"in {other}? then {then:.4g} {self.unit}".rstrip()
        for definition, (factor, power) in self.definitions.items():
            if value > 0.0 and low <= (then := factor * value**power) <= high:
                return f"as {definition}? then {then:.4g} {self.unit}".rstrip()
        return ""

    def in_unit(self, unit: str) -> Quantity:
        """The same, for a user who gives it in another unit, one of `others`."""
        size = self.others[unit]
        others = {other: its / size for other, its in self.others.items() if other != unit}
        limits, usual = ((ends[0] / size, ends[1] / size) for ends in (self.limits, self.usual))
        return self._replace(unit=unit, limits=limits, usual=usual, others={self.unit: 1.0 / size, **others})

    @property
    def allowed(self) -> str:
        """The limits in words."""
        low, high = self._ends()
        return f"{'0, or ' if self.zero else ''}between {low:g} and {high:g} {self.unit}".rstrip()

    def _ends(self) -> tuple[float, float]:
        """Limits, wider by what the conversion of a number at an end may round."""
        low, high = (-self.limits[1], self.limits[1]) if self.signed else self.limits
        return low - ROUNDED * abs(low), high + ROUNDED * abs(high)

    def require(self, field: str, value: float) -> None:
        """Raise `InputError` with the guess if `value` lies outside the limits."""
        low, high = self._ends()
        if not (low <= value <= high or (self.zero and value == 0.0)):
            guess = self.slip(value)
            raise InputError(field, value, self.allowed + (f" ({guess})" if guess else ""))
        if self.slips and (guess := self.slip(value)):
            low, high = self.usual
            raise InputError(field, value, f"in {self.unit}, usually between {low:g} and {high:g} ({guess})")

    def take(self, field: str, value: Any, number: bool) -> Any:
        """The value, a `number` or an array, or raise `InputError`: no number, or one outside the limits."""
        if number or isinstance(value, Number) or not hasattr(value, "__len__"):
            self.require(field, require_number(field, value, f"a number {self.allowed}"))
            return value
        array = as_numbers(field, value, f"numbers {self.allowed}")
        if array.size > self.most:
            raise InputError(f"length of {field}", array.size, f"at most {self.most}")
        low, high = self._ends()
        bad = ~((array >= low) & (array <= high) | (self.zero & (array == 0.0)))
        if self.slips:
            bad |= np.vectorize(lambda one: bool(self.slip(one)), otypes=[bool])(array)
        if bad.any():
            place = np.unravel_index(int(np.argmax(bad)), bad.shape)
            many = array.size > 1
            self.require(f"{field}[{', '.join(map(str, place))}]" if many else field, float(array[place]))
        return value


# Groove radius over ball diameter. Bearings have 0.505 to 0.60, miniature ones the widest grooves. A larger number
# is another definition of such a groove; a contact with any other radii is `Geometry(radius_x, radius_y)`.
CONFORMITY = Quantity(
    "",
    (0.501, 0.7),
    (0.503, 0.65),
    {"%": 0.01},
    definitions={
        "groove radius over ball radius": (0.5, 1),
        "ball radius over groove radius": (0.5, -1),
        "ball diameter over groove radius": (1.0, -1),
    },
)

# Lengths: from the balls of a watch to the pitch circle of a wind turbine's main bearing. Moduli: from soft rubber
# to diamond. Viscosities: from hot refrigerant to oils beyond ISO VG 680 at 20 C (3.4 Pa s): above are mPa s.
# Pressure-viscosity coefficients: from water up. m2/s is the kinematic viscosity of data sheets, times the density
# of an oil.
INPUTS: Mapping[str, Quantity] = {
    "radius_x": Quantity("m", (1e-5, 1.0), (2e-4, 0.1), {"mm": 1e-3, "inches": 0.0254}),
    "radius_y": Quantity("m", (1e-5, 1e3), (2e-4, 10.0), {"mm": 1e-3, "inches": 0.0254}),
    "ball_diameter": Quantity("m", (1e-4, 0.5), (5e-4, 0.15), {"mm": 1e-3, "inches": 0.0254}),
    "pitch_diameter": Quantity("m", (5e-4, 10.0), (2e-3, 5.0), {"mm": 1e-3, "inches": 0.0254}),
    "conformity": CONFORMITY,
    "speed_rpm": Quantity("rev/min", (1e-3, 1e6), (30.0, 2e5), {"rad/s": 30.0 / pi, "rev/s": 60.0}),
    "e1": Quantity("Pa", (1e6, 2e12), (1e9, 1.3e12), {"GPa": 1e9, "MPa": 1e6}),
    "e2": Quantity("Pa", (1e6, 2e12), (1e9, 1.3e12), {"GPa": 1e9, "MPa": 1e6}),
    "load": Quantity("N", (1e-6, 1e8), (0.1, 1e6), {"kN": 1e3}),
    "u_sum": Quantity("m/s", (1e-6, 1e3), (1e-2, 200.0), {"mm/s": 1e-3}),
    "entrainment_speed": Quantity("m/s", (5e-7, 500.0), (5e-3, 100.0), {"mm/s": 1e-3}),
    "eta0": Quantity("Pa s", (1e-4, 5.0), (1e-3, 2.0), {"mPa s": 1e-3, "m2/s": 870.0}),
    "alpha": Quantity("1/Pa", (1e-10, 1e-6), (5e-9, 5e-8), {"1/GPa": 1e-9, "1/MPa": 1e-6}),
}


class Limits(NamedTuple):
    """Of the dimensionless numbers, both ends included."""

    M: tuple[float, float]
    L: tuple[float, float]
    kappa: tuple[float, float]
    p_hertz: float  # Pa, at most
    log_viscosity: float  # ln(eta/eta0) at the Hertz pressure, at most


MEASURED = Limits((5.0, 30000.0), (0.0, 25.0), (0.08, 5.0), 3.5e9, 80.0)  # docs/notes/solver.md
SMALLEST_L = (
    1e-6  # of one that is not 0: formulas of its powers overflow at 1e-50, the Hertz pressure is 20 Pa here
)
LIMITS = Limits((0.1, 60000.0), (0.0, 40.0), (0.04, 8.0), 5e9, 120.0)

Given = Mapping[str, tuple[float, Quantity]]  # a user's inputs, by the user's name for each


def require_admissible(cases: Mapping[str, Mapping[str, float]], given: Given) -> None:
    """Raise `InputError` for the first input or number outside its range, with the slips that the inputs betray.

    Parameters
    ----------
    cases : mapping
        For each load ``M``, ``L``, ``kappa``, ``p_hertz`` [Pa] and ``log_viscosity``; the key is added to the name
        of the number in messages, such as " under the largest load".
    given : mapping
        What they were made of.
    """
    for name, (value, quantity) in given.items():
        quantity.require(name, value)
    slips = [f"{name} = {value:g} {guess}" for name, (value, q) in given.items() if (guess := q.slip(value))]
    if "radius_x" in given and "" in cases and (kappa := cases[""]["kappa"]) > LIMITS.kappa[1]:
        slips = [f"radius_x is that along rolling; are both exchanged? then kappa = {1.0 / kappa:.4g}"]
    for when, numbers in cases.items():
        pressure = numbers["p_hertz"] * 1e-9
        here = ", ".join(f"{name} = {numbers[name]:.4g}" for name in ("M", "L", "kappa"))
        note = f", {MADE_FOR} ({'; '.join(slips) or f'{here}, {pressure:.3g} GPa'})"
        if 0.0 < numbers["L"] < SMALLEST_L:
            raise InputError(f"L{when}", numbers["L"], f"0, or between {SMALLEST_L:g} and {LIMITS.L[1]:g}{note}")
        for name in ("M", "L", "kappa"):
            low, high = getattr(LIMITS, name)
            if not low <= numbers[name] <= high:
                raise InputError(name + when, _short(numbers[name]), f"between {low:g} and {high:g}{note}")
        if not numbers["p_hertz"] <= LIMITS.p_hertz:
            allowed = f"at most {LIMITS.p_hertz * 1e-9:g}{note}"
            raise InputError(f"Hertz pressure{when} in GPa", _short(pressure), allowed)
        if not numbers["log_viscosity"] <= LIMITS.log_viscosity:
            field, allowed = f"ln(eta/eta0) at the Hertz pressure{when}", f"at most {LIMITS.log_viscosity:g}{note}"
            raise InputError(field, _short(numbers["log_viscosity"]), allowed)


def _short(value: float) -> float:
    return float(f"{value:.4g}")
