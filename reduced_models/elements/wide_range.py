"""The wide-range element: one contact at one speed over a wide range of loads, from lift-off to overload."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_rows, require_between
from ehlcontact.point import Scales
from ehlcontact.store import stored
from reduced_models.elements.film_curve import curve_nodes
from reduced_models.elements.film_element import FilmContact
from reduced_models.elements.film_filters import DIRECT
from reduced_models.elements.motion_errors import UNLOADING, WITHIN, motion_errors

_Floats = NDArray[np.float64]

LOADS = (1e-12, 1e12)  # over the reference load


def inlet_saturation_of(loads: ArrayLike, approach: ArrayLike, gain_loads: ArrayLike, gains: ArrayLike) -> float:
    """Beta at which opening takes away at most the static film at load 1: film made per own rate over that film.

    Parameters as for `WideRangeContact`.
    """
    places, x = np.log(np.asarray(gain_loads, float)), np.log(np.asarray(loads, float))
    made = np.interp(0.0, places, np.abs(np.asarray(gains, float)[:, DIRECT:]).sum(axis=1))
    film = np.interp(0.0, x, np.exp(2.0 / 3.0 * x) - np.asarray(approach, float))
    return float(made / film)


@stored("contact element")
@dataclass(frozen=True)
class WideRangeContact(FilmContact):
    """Contact at any load for given geometry, lubricant and speed, with its film memory.

    The static curve interpolates the film h_s = F^(2/3) - u over the load, ln over ln; it is C1, rises always
    and fades as the surfaces part: below the lightest load it turns into that of rigid surfaces, F like h^-1/2.
    Gains interpolate linearly in ln F and stay as they are beyond the table. Where closing lets the contact
    grow, its whole rim makes film; with `inlet_saturation` 0 only the inlet does.

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
    inlet_saturation, lag_rate, inlet_rate, fast_rate
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
    inlet_saturation: float
    lag_rate: float
    inlet_rate: float
    fast_rate: float
    low: float | None = None  # type: ignore[assignment]
    high: float | None = None  # type: ignore[assignment]
    scales: Scales | None = field(default=None, kw_only=True)
    kind: str = field(default="wide", kw_only=True)

    kinds: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "wide": (
            "loads",
            "approach",
            "gain_loads",
            "gains",
            "inlet_saturation",
            "lag_rate",
            "inlet_rate",
            "fast_rate",
        )
    }
    tables = ("loads", "approach", "gain_loads", "gains")
    beyond: ClassVar[Mapping[str, str]] = {
        "motion": "`motion_errors` has what fast closing of parted surfaces costs"
    }

    def _check_coefficients(self) -> None:
        super()._check_coefficients()
        for name, least in (("loads", 2), ("approach", 2), ("gain_loads", 1)):
            column = as_column(name, getattr(self, name), least=least, increasing=True)
            object.__setattr__(self, name, tuple(column.tolist()))
        for name in ("loads", "gain_loads"):
            require_between(f"{name}[0]", getattr(self, name)[0], *LOADS)
            require_between(f"{name}[-1]", getattr(self, name)[-1], *LOADS)
        rows = as_rows("gains", self.gains, len(self.gain_loads), DIRECT + 1)
        object.__setattr__(self, "gains", tuple(tuple(row) for row in rows.tolist()))
        force, length = (1.0, 1.0) if self.scales is None else (self.scales.force, self.scales.length)
        for name, end in (("low", self.approach[0]), ("high", self.approach[-1])):
            if getattr(self, name) is None:
                object.__setattr__(self, name, end * length)
        if self.load_range is None:
            object.__setattr__(self, "load_range", (self.loads[0] * force, self.loads[-1] * force))

    @property
    def motion_errors(self) -> dict[str, float]:
        """RMS error of the force over its standard deviation, by kind of motion (`elements.motion_errors`).

        Estimated from full solves at three points, by the film under the reference load; typical, not bounds.
        The error grows with the rate of the motion, and those are at one rate each (docs/elements.md).
        """
        f, length, _ = self._units
        return motion_errors(1.0 - self.approach_at(f) / length)

    @property
    def rms(self) -> float | None:
        """RMS error of the force over its standard deviation: of the fit, or else of vibrations in contact."""
        fitted = super().rms
        errors = self.motion_errors
        return max(errors[WITHIN], errors[UNLOADING]) if fitted is None else fitted

    def _summary_lines(self) -> list[str]:
        errors = self.motion_errors
        worst = max(errors, key=lambda kind: errors[kind])
        said = ", ".join(f"{kind} {100.0 * errors[kind]:.2g} %" for kind in dict.fromkeys((WITHIN, worst)))
        return [*super()._summary_lines(), f"rms error of the force (faster motions more): {said}"]

    def _tables(self) -> dict[str, _Floats]:
        gains = {"gain_x": np.log(np.array(self.gain_loads)), "gains": np.array(self.gains)}
        return curve_nodes(self.loads, self.approach) | gains
