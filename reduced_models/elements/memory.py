"""The film-memory element: one operating point, every frequency."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ehlcontact.checks import require_finite, require_positive
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from reduced_models.elements.file import numbers
from reduced_models.elements.film_curve import LEAST_EXPONENT, as_rows, require_rising
from reduced_models.elements.film_element import FilmContact
from reduced_models.elements.film_law import DIRECT, FilmLaw
from reduced_models.elements.validity import Band

_SCALARS = ("film", "exponent", "squeeze", "lag_rate", "inlet_rate", "fast_rate")


@dataclass(frozen=True)
class FilmMemoryContact(FilmContact):
    """Contact about one load, with the damping of every frequency: a dry spring on a film that remembers.

    The static film is h_s = film F^-exponent, which approach and static tangent at the reference load fix; the
    memory is described in `reduced_models.elements.film_law`. Made by `reduced_models.fit_memory`.

    Parameters
    ----------
    film : float
        Static film at the reference load, 1 minus the static approach; > 0.
    exponent : float
        How it thins with the load; at least 0.02.
    squeeze : float
        beta of phi, >= 0: film that a vibrating inlet makes on average.
    lag_rate, inlet_rate, fast_rate : float
        Rates nu, p_i and p_f of the filters, > 0.
    gains : sequence of float
        Viscous, inlet and fast gain, then one for every lag of the chain.
    low, high, rate, load_range, omega_range, units, fit, source
        As for `LinearContact`.
    scales : Scales, optional
        Of an element in SI.

    Raises
    ------
    InputError
        A coefficient outside its range, or gains that would feed energy into a vibration.
    """

    film: float
    exponent: float
    squeeze: float
    lag_rate: float
    inlet_rate: float
    fast_rate: float
    gains: tuple[float, ...]
    low: float
    high: float
    rate: float | None = None
    load_range: Band | None = None
    omega_range: Band | None = None
    units: str = "dimensionless"
    scales: Scales | None = None
    fit: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    source: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    law: FilmLaw = field(init=False, repr=False, compare=False)

    kind = "memory"
    parameter_names = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "film", require_positive("film", self.film))
        object.__setattr__(self, "exponent", require_finite("exponent", self.exponent))
        if self.exponent < LEAST_EXPONENT:
            raise InputError("exponent", self.exponent, f"at least {LEAST_EXPONENT}")
        row = as_rows("gains", [self.gains], 1)[0]
        object.__setattr__(self, "gains", tuple(row.tolist()))
        super().__post_init__()

    @property
    def lags(self) -> int:
        """Number of lags that carry the film through the contact."""
        return len(self.gains) - DIRECT

    @property
    def parameters(self) -> dict[str, Any]:
        """Coefficients by name, dimensionless."""
        return {name: getattr(self, name) for name in _SCALARS} | {"gains": list(self.gains)}

    def _law(self) -> FilmLaw:
        x = np.array([-1.0, 1.0])  # a straight line: any two points
        y = math.log(self.film) - self.exponent * x
        law = FilmLaw(
            x=x,
            y=y,
            slope=np.full(2, -self.exponent),
            u=np.exp(2.0 / 3.0 * x) - np.exp(y),
            gain_x=np.zeros(1),
            gains=np.array([self.gains]),
            lag_rate=self.rates.lag_rate,
            inlet_rate=self.rates.inlet_rate,
            fast_rate=self.rates.fast_rate,
            squeeze=self.squeeze,
        )
        require_rising(law)
        return law

    @classmethod
    def _coefficients(cls, name: str, entries: Mapping[str, Any]) -> dict[str, Any]:
        gains = entries.get("gains")
        if not isinstance(gains, list):
            raise InputError(f"{name}: parameters.gains", gains, "a list of numbers")
        return {**numbers(name, "parameters", entries, _SCALARS), "gains": gains}
