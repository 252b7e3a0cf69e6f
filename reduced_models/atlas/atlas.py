"""The atlas: answers for any point of its box at once, from contacts solved beforehand."""

from __future__ import annotations

import math
import os
from dataclasses import asdict, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from ehlcontact.assumptions import assumptions
from ehlcontact.checks import require_choice
from ehlcontact.checks.box import INPUTS
from ehlcontact.checks.frequency import Frequency, by_name, dimensionless, one
from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint, Point, Scales, moes_point, scales_of
from reduced_models.atlas.answer import AtlasAnswer
from reduced_models.atlas.elements import (
    Loads,
    cubic_element,
    damper_band,
    memory_element,
    passive_gains,
    wide_element,
)
from reduced_models.atlas.surface import AtlasSurface
from reduced_models.atlas.table import AtlasTable, Box
from reduced_models.elements.film_response import DRY
from reduced_models.elements.kinds import CubicContact, FilmMemoryContact, WideRangeContact

_Floats = NDArray[np.float64]

SHIPPED = Path(__file__).with_name("atlas.npz")
MODELS = ("memory", "wide", "cubic")
# Loads of a wide-range element, as far as the box goes.
LOADS = np.array([0.01, 0.03, 0.07, 0.15, 0.3, 0.6, 1.0, 1.7, 3.0])
NEIGHBOURS = 1.2  # ratio below which a load is left out beside the end of the box


class Atlas:
    """Solved contacts over M, L and kappa, interpolated.

    Every answer comes with an error bar, from the errors of nearby points when each is left out. Outside the box
    it raises: nothing is extrapolated. L = 0 means the limit of small L, where oil is incompressible.

    Parameters
    ----------
    path : str or Path, optional
        An atlas of ``ehlcontact atlas build``; by default the one that comes with the library.

    Raises
    ------
    InputError
        No readable atlas.
    """

    def __init__(self, path: str | os.PathLike[str] | None = None) -> None:
        self._table = AtlasTable.load(SHIPPED if path is None else Path(path))
        self._surface = AtlasSurface(self._table)

    @property
    def box(self) -> Box:
        """Where it answers."""
        return self._table.box

    @property
    def metadata(self) -> dict[str, Any]:
        """Command, version, sample and meshes that made it."""
        return dict(self._table.metadata)

    def at(self, point: Point) -> AtlasAnswer:
        """Approach, films and impedance at a point.

        Raises
        ------
        InputError
            A point outside the box, or an oil of other laws: it names the axis and the box.
        """
        moes = self._inside(point)
        row = _rows(moes, np.ones(1))
        values, slopes, _ = self._surface.at(row)
        bars = self._surface.bars(row[0], values[0], slopes[0], self._oil_error(moes, float(values[0, 0])))
        named = self._named(values[0])
        return AtlasAnswer(
            moes, Omega=self._table.omega, **named, error=self._named(bars), scales=scales_of(point)
        )

    @by_name(3)
    def element(
        self,
        point: Point,
        model: str = "wide",
        *,
        Omega: float | None = None,
        omega: float | None = None,
        hz: float | None = None,
        rpm: float | None = None,
    ) -> FilmMemoryContact | WideRangeContact | CubicContact:
        """Contact element at a point, in SI for an `OperatingPoint`.

        Parameters
        ----------
        point : MoesPoint or OperatingPoint
        model : {"wide", "memory", "cubic"}
            Any load at this speed; this load at any frequency; this load at one frequency.
        Omega, omega, hz, rpm : float
            That frequency, in exactly one of these, for the cubic and for no other: dimensionless (2a/u_sum is the
            unit of time) at every point; at an `OperatingPoint` also in rad/s, Hz or rev/min. A damper without
            memory is right at one frequency only, so there is no default.

        Raises
        ------
        InputError
            A point outside the box, another model, a cubic without its frequency or at a load too light for it, a
            frequency for a model that serves them all.
        """
        require_choice("model", model, MODELS)
        moes, scales = self._inside(point), scales_of(point)
        w = self._frequency(model, scales, Omega=Omega, omega=omega, hz=hz, rpm=rpm)
        loads = self._loads(moes) if model == "wide" else np.ones(1)
        rows = _rows(moes, loads)
        values, slopes, shapes = self._surface.at(rows)
        reference = int(np.argmin(np.abs(loads - 1.0)))
        source = self._source(moes, rows[reference], values[reference], slopes[reference])
        source["scales"] = None if scales is None else asdict(scales)
        source["assumptions"] = assumptions(point).short()
        k = self._table.omega.size
        if w is not None:
            parts = values[0, 4 : 4 + k], values[0, 4 + k :]
            K, C = (float(np.interp(w, self._table.omega, part)) for part in parts)
            band = damper_band(self._table.omega, parts[1], w)
            cubic = cubic_element(float(values[0, 0]), K, max(C, 0.0), band, source)
            return cubic if scales is None else cubic.to_si(scales)
        gains = np.maximum(shapes * values[:, 3:4], 0.0)
        at = Loads(
            loads=loads,
            approach=values[:, 0],
            tangent=values[:, 4],
            gains=gains,
            rates=self._table.rates,
            highest_omega=float(self._table.metadata["highest_omega"]),
            fit=self._fit(gains, values[:, 4 + k :]),
            source=source,
        )
        make = wide_element if model == "wide" else memory_element
        try:
            return make(at, scales)
        except InputError:  # rarely: interpolated gains that would feed energy back
            return make(replace(at, gains=passive_gains(at.rates, gains)), scales)

    @cached_property
    def _basis(self) -> _Floats:
        """Damping at every frequency up to the highest of an element, of every filter."""
        omega = self._table.omega
        return self._table.rates.basis(omega[omega <= self._table.metadata["highest_omega"]]).real * DRY

    def _fit(self, gains: _Floats, damping: _Floats) -> dict[str, Any]:
        """How well the filters follow the damping of the atlas, over that at low frequency."""
        C = damping[:, : len(self._basis)]
        return {"rms": None, "damping_error_max": float(np.max(np.abs(gains @ self._basis.T - C) / C[:, :1]))}

    def _frequency(self, model: str, scales: Scales | None, **given: Unpack[Frequency]) -> float | None:
        """Omega of the cubic; None for the other models, which are made for all frequencies."""
        if model == "cubic":
            time = None if scales is None else scales.time
            return one("frequency", dimensionless(time, **given, most=float(self._table.omega[-1])))
        for name, value in given.items():
            if value is not None:
                highest = float(self._table.metadata["highest_omega"])
                allowed = f"left out with model {model!r}, which serves every frequency up to Omega = {highest:g}"
                raise InputError(name, value, allowed)
        return None

    def _inside(self, point: Point) -> MoesPoint:
        moes = moes_point(point)
        self.box.require_inside(moes)
        for name in ("viscosity", "density"):
            if getattr(moes, name) != self._table.metadata[name]:
                raise InputError(name, getattr(moes, name), f"{self._table.metadata[name]}, the law of the atlas")
        for name in ("alpha", "eta0"):
            low, high = getattr(self._table.oil, name)
            if not low <= getattr(moes, name) <= high:
                guess = INPUTS[name].slip(getattr(moes, name))
                allowed = f"between {low:g} and {high:g} {INPUTS[name].unit}, the range of the atlas"
                raise InputError(name, getattr(moes, name), f"{allowed} ({guess})" if guess else allowed)
        return moes

    def _loads(self, point: MoesPoint) -> _Floats:
        """Loads of a wide-range element: those whose M and Hertz pressure stay in the box."""
        lowest, highest = (M / point.M for M in self.box.M)
        if point.L > 0.0:
            highest = min(highest, (self.box.p_hertz / point.p_hertz) ** 3)
        low, high = max(LOADS[0], lowest), min(LOADS[-1], highest)
        inside = (LOADS > NEIGHBOURS * low) & (LOADS < high / NEIGHBOURS)
        inside |= (LOADS == 1.0) & (low < 1.0) & (high > 1.0)  # the reference is a node, or an end
        return np.concatenate([[low], LOADS[inside], [high]])

    def _oil_error(self, point: MoesPoint, approach: float) -> _Floats:
        """Error bars of the smooth variables for an oil whose alpha and eta0 are not those of the atlas."""
        meta, oil, k = self._table.metadata, self._table.oil, self._table.omega.size
        alpha, eta0 = abs(math.log(point.alpha / meta["alpha"])), abs(math.log(point.eta0 / meta["eta0"]))
        film, K, C = (slope[0] * alpha + slope[1] * eta0 for slope in (oil.film, oil.stiffness, oil.damping))
        return np.concatenate([[film, film, film, C], np.full(k, K * min(1.0 - approach, 1.0)), np.full(k, C)])

    def _named(self, row: _Floats) -> dict[str, Any]:
        k = self._table.omega.size
        named: dict[str, Any] = dict(zip(("approach", "h_central", "h_min"), row[:3].tolist(), strict=True))
        return named | {"stiffness": row[4 : 4 + k], "damping": row[4 + k :]}

    def _source(self, point: MoesPoint, row: _Floats, values: _Floats, slopes: _Floats) -> dict[str, Any]:
        bars = self._surface.bars(row, values, slopes, self._oil_error(point, float(values[0])))
        k = self._table.omega.size
        return {
            "atlas": self._table.metadata["version"],
            "point": point.to_dict(),
            "error": {
                "approach": float(bars[0]),
                "h_central": float(bars[1]),
                "tangent": float(bars[4]),
                "damping": float(bars[4 + k + self._table.interpolation.reference]),
            },
        }


def _rows(point: MoesPoint, loads: _Floats) -> _Floats:
    """Rows (M, L, kappa) of the point under these loads."""
    return np.column_stack([point.M * loads, np.full(loads.size, point.L), np.full(loads.size, point.kappa)])
