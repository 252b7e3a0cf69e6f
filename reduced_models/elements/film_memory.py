"""The film-memory element: one operating point, every frequency.

Its equations: `film_law`. Its matrices as a state space for small motion: `small_motion`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, require_between
from ehlcontact.point import Scales
from ehlcontact.store import stored
from reduced_models.elements.film_curve import LEAST_EXPONENT
from reduced_models.elements.film_element import FILMS, FilmContact
from reduced_models.elements.film_filters import DIRECT

_Floats = NDArray[np.float64]

LARGEST_EXPONENT = 10.0  # films thin with the load to the power of 0.1 to 1


def film_and_exponent(approach: float, tangent: float) -> tuple[float, float]:
    """Static film at load 1 and how it thins with the load, from approach and static tangent K_0 there.

    1/K_0 = 2/3 + exponent film, the derivative of u = F^(2/3) - film F^-exponent; but at least `LEAST_EXPONENT`.
    """
    film = 1.0 - approach
    return film, max((1.0 / tangent - 2.0 / 3.0) / film, LEAST_EXPONENT)


def approach_under(load: Any, film: float, exponent: float) -> Any:
    """Static approach u = F^(2/3) - film F^-exponent under a load F, a number or an array."""
    return load ** (2.0 / 3.0) - film * load**-exponent


def memory_curve(film: float, exponent: float) -> dict[str, _Floats]:
    """Static curve of `FilmLaw` for that film, with one row of gains."""
    x = np.array([-1.0, 1.0])  # a straight line: any two points
    y = math.log(film) - exponent * x
    return {
        "x": x,
        "y": y,
        "slope": np.full(2, -exponent),
        "u": np.exp(2.0 / 3.0 * x) - np.exp(y),
        "gain_x": np.zeros(1),
    }


@stored("contact element")
@dataclass(frozen=True)
class FilmMemoryContact(FilmContact):
    """Contact about one load, with the damping of every frequency: a dry Hertz spring on a film with memory.

    The static film is h_s = film F^-exponent, which approach and static tangent at the reference load fix; the
    memory is described in `reduced_models.elements.film_law`. Made by `reduced_models.fit_memory`.

    About one load it is the better one of the two with a memory; far from it each is ahead in some motions. Free
    vibrations at M = 200, L = 10, kappa = 0.5, n = 64, Omega_n = 2.56 / 5.13, error of the simulated approach over
    its spread: within 15 % of the load 0.98 / 1.56 % (`WideRangeContact` of the same grid 1.93 / 1.83 %), with the
    load between 0.25 and 1.96 5.5 / 7.3 % (5.4 / 10.0 %). The film curve of the wide one with these gains has
    1.77 / 1.86 and 6.4 / 7.8 %, so neither part of it is taken over.

    Parameters
    ----------
    film : float
        Static film at the reference load, 1 minus the static approach; > 0.
    exponent : float
        How it thins with the load; at least `film_curve.LEAST_EXPONENT`.
    inlet_saturation : float
        beta of phi, >= 0: film that a vibrating inlet makes on average.
    lag_rate, inlet_rate, fast_rate : float
        Rates nu, p_i and p_f of the filters, > 0.
    gains : sequence of float
        Viscous, inlet and fast gain, then one for every lag of the chain.
    low, high, rate, load_range, omega_range, units, fit, source
        As for `ContactElement`.
    scales : Scales, optional
        Of an element in SI.

    Raises
    ------
    InputError
        A coefficient outside its range, or gains that would feed energy into a vibration.
    """

    film: float
    exponent: float
    inlet_saturation: float
    lag_rate: float
    inlet_rate: float
    fast_rate: float
    gains: tuple[float, ...]
    low: float
    high: float
    scales: Scales | None = field(default=None, kw_only=True)
    kind: str = field(default="memory", kw_only=True)

    for_every_load = False
    kinds: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "memory": ("film", "exponent", "inlet_saturation", "lag_rate", "inlet_rate", "fast_rate", "gains")
    }
    tables = ("gains",)
    beyond: ClassVar[Mapping[str, str]] = {
        "motion": "it is for motion about one load: a WideRangeContact (model 'wide') is made for every load"
    }

    def _check_coefficients(self) -> None:
        super()._check_coefficients()
        object.__setattr__(self, "film", require_between("film", self.film, *FILMS))
        exponent = require_between("exponent", self.exponent, LEAST_EXPONENT, LARGEST_EXPONENT)
        object.__setattr__(self, "exponent", exponent)
        gains = as_column("gains", self.gains, least=DIRECT + 1)
        object.__setattr__(self, "gains", tuple(gains.tolist()))

    def _tables(self) -> dict[str, _Floats]:
        return memory_curve(self.film, self.exponent) | {"gains": np.array([self.gains])}
