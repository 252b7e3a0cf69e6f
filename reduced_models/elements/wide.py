"""The wide-range element: one contact at one speed, from lift-off to overload."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from reduced_models.elements.file import numbers
from reduced_models.elements.film_curve import as_rows, curve_nodes, increasing, require_rising
from reduced_models.elements.film_element import FilmContact
from reduced_models.elements.film_law import DIRECT, FilmLaw
from reduced_models.elements.validity import Band

_SCALARS = ("squeeze", "lag_rate", "inlet_rate", "fast_rate")
_TABLES = ("loads", "approach", "gain_loads", "gains")


@dataclass(frozen=True)
class WideRangeContact(FilmContact):
    """Contact at any load for given geometry, lubricant and speed, with its film memory.

    The static curve interpolates the film h_s = F^(2/3) - u over the load, ln over ln; it is C1, rises always
    and fades as the surfaces part: below the lightest load it turns into that of rigid surfaces, F like h^-1/2.
    Gains interpolate linearly in ln F and stay as they are beyond the table.

    Parameters
    ----------
    loads : sequence of float, length n >= 2
        Increasing static loads in units of the reference load; inside their range or not, the reference is 1.
    approach : sequence of float, length n
        Static approach under each, in dry approaches of the reference load.
    gain_loads : sequence of float, length k >= 1
        Loads of the rows of `gains`.
    gains : sequence of k rows
        Viscous, inlet and fast gain, then one for every lag, in the units of that row's load
        (`reduced_models.elements.film_response.fit_gains`).
    squeeze, lag_rate, inlet_rate, fast_rate
        As for `FilmMemoryContact`, the same at every load in that load's own units.
    low, high, rate, load_range, omega_range, units, scales, fit, source
        As for `FilmMemoryContact`; `low` and `high` are the ends of `approach` by default.

    Raises
    ------
    InputError
        Tables that are no contact: it names the entry.
    """

    loads: tuple[float, ...]
    approach: tuple[float, ...]
    gain_loads: tuple[float, ...]
    gains: tuple[tuple[float, ...], ...]
    squeeze: float
    lag_rate: float
    inlet_rate: float
    fast_rate: float
    low: float | None = None  # type: ignore[assignment]
    high: float | None = None  # type: ignore[assignment]
    rate: float | None = None
    load_range: Band | None = None
    omega_range: Band | None = None
    units: str = "dimensionless"
    scales: Scales | None = None
    fit: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    source: Mapping[str, Any] | None = field(default=None, repr=False, compare=False)
    law: FilmLaw = field(init=False, repr=False, compare=False)

    kind = "wide"
    parameter_names = ()

    def __post_init__(self) -> None:
        for name, least in (("loads", 2), ("approach", 2), ("gain_loads", 1)):
            object.__setattr__(self, name, tuple(increasing(name, getattr(self, name), least).tolist()))
        if self.gain_loads[0] <= 0.0:
            raise InputError("gain_loads[0]", self.gain_loads[0], "> 0")
        rows = as_rows("gains", self.gains, len(self.gain_loads))
        object.__setattr__(self, "gains", tuple(tuple(row) for row in rows.tolist()))
        length = 1.0 if self.scales is None else self.scales.length
        force = 1.0 if self.scales is None else self.scales.force
        for name, end in (("low", self.approach[0]), ("high", self.approach[-1])):
            if getattr(self, name) is None:
                object.__setattr__(self, name, end * length)
        if self.load_range is None:
            object.__setattr__(self, "load_range", (self.loads[0] * force, self.loads[-1] * force))
        super().__post_init__()

    @property
    def lags(self) -> int:
        """Number of lags that carry the film through the contact."""
        return len(self.gains[0]) - DIRECT

    @property
    def parameters(self) -> dict[str, Any]:
        """Coefficients and tables by name, dimensionless."""
        tables = {name: list(getattr(self, name)) for name in ("loads", "approach", "gain_loads")}
        scalars = {name: getattr(self, name) for name in _SCALARS}
        return tables | {"gains": [list(row) for row in self.gains]} | scalars

    def _law(self) -> FilmLaw:
        law = FilmLaw(
            **curve_nodes(self.loads, self.approach),
            gain_x=np.log(np.array(self.gain_loads)),
            gains=np.array(self.gains),
            lag_rate=self.rates.lag_rate,
            inlet_rate=self.rates.inlet_rate,
            fast_rate=self.rates.fast_rate,
            squeeze=self.squeeze,
        )
        require_rising(law)
        return law

    @classmethod
    def _coefficients(cls, name: str, entries: Mapping[str, Any]) -> dict[str, Any]:
        tables = {key: entries.get(key) for key in _TABLES}
        for key, table in tables.items():
            if not isinstance(table, list):
                raise InputError(f"{name}: parameters.{key}", table, "a list of numbers")
        return {**numbers(name, "parameters", entries, _SCALARS), **tables}
