"""The power-law element, F = K (u + u0)^n + F0 + C u', of the literature after Nonato and Cavalca (2010)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ehlcontact.checks import require_nonnegative, require_positive
from ehlcontact.jit import jit_exact
from ehlcontact.point import Scales
from ehlcontact.store import stored
from reduced_models.elements.spring import MemorylessContact, kernel_of


class PowerLaw(NamedTuple):
    """K (u + u0)^n + F0 between the ends, and C1 = C; see `reduced_models.elements.spring`."""

    low: float
    high: float
    K: float
    n: float
    u0: float
    F0: float
    C1: float
    C2: float = 0.0
    C3: float = 0.0
    B4: float = 0.0
    rate: float = math.inf
    o_low: float = math.nan
    A_low: float = math.nan
    o_high: float = math.nan
    A_high: float = math.nan


@kernel_of(PowerLaw)
@jit_exact
def power(u, law):
    """Force of the power law and its derivative, where u + u0 > 0."""
    reach = u + law.u0
    part = law.K * reach**law.n
    return part + law.F0, law.n * part / reach


@stored("contact element")
@dataclass(frozen=True)
class PowerLawContact(MemorylessContact):
    """F = K (u + u0)_+^n + F0 + C u' on [low, high].

    A dry point contact has n = 3/2, u0 = F0 = 0. Outside [low, high] the spring goes on like a Hertz contact, as
    that of every other element, so that it lets go where the surfaces part whatever F0 is.

    Parameters
    ----------
    K : float
        Factor, > 0; in SI N/m^n.
    n : float
        Exponent, > 0.
    u0 : float
        Shift of the approach, with u0 + low > 0.
    F0 : float
        Offset of the force.
    C : float
        Damping coefficient, >= 0.
    low, high, rate, load_range, omega_range, units, fit, source
        As for `ContactElement`.

    Raises
    ------
    InputError
        A value not finite or outside its range, or a spring that does not push at both ends.
    """

    K: float
    n: float
    u0: float
    F0: float
    C: float
    low: float
    high: float

    kind = "power"
    parameter_names = ("K", "n", "u0", "F0", "C")

    def _law(self) -> PowerLaw:
        for name in ("K", "n"):
            require_positive(name, getattr(self, name))
        require_nonnegative("C", self.C)
        require_positive("low + u0", self.low + self.u0)
        return PowerLaw(self.low, self.high, self.K, self.n, self.u0, self.F0, self.C)

    def _approach_between(self, force: float) -> float:
        return float(((force - self.F0) / self.K) ** (1.0 / self.n)) - self.u0

    def _si_factors(self, scales: Scales) -> dict[str, float]:
        unit = scales.force / scales.length**self.n
        return {"K": unit, "n": 1.0, "u0": scales.length, "F0": scales.force, "C": scales.damping}
