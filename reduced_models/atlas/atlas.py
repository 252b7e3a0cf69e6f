"""`Atlas`: films, impedance and elements of any point of its box, interpolated from solved contacts."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from copy import deepcopy
from dataclasses import asdict, replace
from functools import cached_property, partial
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.assumptions import assumptions
from ehlcontact.checks import as_column, as_numbers, parts, require_choice, require_positive
from ehlcontact.checks.frequency import Frequency, by_name, dimensionless, one
from ehlcontact.checks.quantity import takes
from ehlcontact.conditions import Conditions
from ehlcontact.errors import InputError, warn_user
from ehlcontact.heat import Heat
from ehlcontact.point import MoesPoint, Point, Scales, moes_point, scales_of
from ehlcontact.supply import OilLayer
from reduced_models.atlas.answer import AtlasAnswer, AtlasAnswers
from reduced_models.atlas.atlas_elements import (
    Loads,
    approaches_in_one_region,
    cubic_element,
    damper_band,
    memory_element,
    passive_gains,
    speed_element,
    wide_element,
)
from reduced_models.atlas.conditions import Condition, Rows, under
from reduced_models.atlas.film import HEAD, LOW
from reduced_models.atlas.frequency_curve import FrequencyCurve
from reduced_models.atlas.heat import Heated
from reduced_models.atlas.other_oil import OtherOil
from reduced_models.atlas.supply import Supplied
from reduced_models.atlas.surface import opened, shipped_file
from reduced_models.atlas.table import Box
from reduced_models.elements.film_contact import FilmContact
from reduced_models.elements.film_response import DRY, LEAST_VISCOUS, FilterRates
from reduced_models.elements.spring import SpringContact
from reduced_models.elements.validity import OutsideValidityWarning

_Floats = NDArray[np.float64]

MODELS = ("memory", "wide", "cubic")
NUMBERS = ("approach", "h_central", "h_min", "separation", "moment")  # beside what is over frequency
# Loads of a wide-range element, as far as the box goes.
LOADS = np.array([0.01, 0.03, 0.07, 0.15, 0.3, 0.6, 1.0, 1.7, 3.0])
INSIDE = 1e-9  # relative, that speeds keep from the ends of the box
USUAL_SPEEDS = 10.0  # and its inverse: speeds of such an element over that of its point, unless given
SPEED_STEP, SUPPLIED_STEP = 1.6, 1.2  # ratio of the speeds of an element over speed, at most; under a layer
NEGATIVE = 0.02  # share of the flooded C below which a negative one is as good as zero
NEIGHBOURS = 1.2  # ratio below which a load is left out beside the end of the box


class Atlas:
    """Solved contacts over M, L and kappa, interpolated.

    Every answer comes with an error bar, from the errors of nearby points when each is left out. Outside the box
    it raises: nothing is extrapolated. L = 0 means the limit of small L, where oil is incompressible. Inlets are
    flooded as far as the default domain reaches: below a load number of 1 or so that sets the film.

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
        self._surface = opened(shipped_file("film") if path is None else path, "film")
        self._table = self._surface.table

    @cached_property
    def _omega(self) -> _Floats:
        """Frequencies of the table."""
        return self._table["omega"]

    @cached_property
    def _rates(self) -> FilterRates:
        """Rates of the film memory, equal at all points."""
        return FilterRates(**self._table.metadata["rates"])

    @cached_property
    def _oil(self) -> OtherOil:
        """Accepted other oils."""
        return OtherOil(**self._table.metadata["oil"])

    @property
    def box(self) -> Box:
        """Ranges of M, L, kappa and Hertz pressure."""
        return self._table.box

    @property
    def metadata(self) -> dict[str, Any]:
        """Command, version, sample and meshes of the build."""
        return deepcopy(self._table.metadata)

    def at(
        self, point: Point, *, supply: OilLayer | None = None, thermal: Heat | bool | None = None
    ) -> AtlasAnswer:
        """Approach, films, rolling resistance and impedance at a point.

        Parameters
        ----------
        point : MoesPoint or OperatingPoint
        supply, thermal : optional
            As in `element`.

        Raises
        ------
        InputError
            A point outside the box, or an oil of other laws: it names the axis and the box. What a table of
            supply or heat does not have.
        """
        return self._answer(point, conditions_at(point, Conditions.of(supply=supply, thermal=thermal)))

    @takes(M=parts.ANY, L=parts.ANY, kappa=parts.ANY, alpha="1/Pa", eta0="Pa s")
    def over(
        self,
        M: ArrayLike,
        L: ArrayLike,
        kappa: ArrayLike,
        *,
        alpha: float | None = None,
        eta0: float | None = None,
        supply: OilLayer | None = None,
        thermal: Heat | bool | None = None,
    ) -> AtlasAnswers:
        """Answers of `at` for many points at once, in arrays: 10 to 30 us a point from a thousand up.

        Parameters
        ----------
        M, L, kappa : array_like, shape (n,)
            Or numbers, which hold for all.
        alpha, eta0 : float, optional
            Of the oil [1/Pa, Pa s]; by default those of the atlas.
        supply : OilLayer, optional
            In flooded films or dry approaches, one number for all points; some milliseconds a point.
        thermal : optional
            Refused: heat depends on the speed and the viscosity in SI. `at` takes it at an `OperatingPoint`.

        Raises
        ------
        InputError
            A point outside the box, the first one by its own numbers; other shapes; another oil. A layer in metres
            or one that the table of supply does not have; heat.
        """
        if Conditions.of(thermal=thermal).heat is not None:
            raise InputError("thermal", thermal, "left out: `at` takes it at an OperatingPoint, in SI")
        meta = self._table.metadata
        oil = float(meta["alpha"]) if alpha is None else alpha, float(meta["eta0"]) if eta0 is None else eta0
        points = _points(M, L, kappa)
        first = points[0].tolist()
        self._inside(MoesPoint(first[0], first[1], first[2], *oil))  # the oil, which is that of all
        self.box.require_all_inside(points, oil[0])
        added = self._oil.error(*oil, meta, self._omega.size)
        values, bars = self._surface.at(points * self._oil.factors(*oil, meta), oil_error=added)
        Omega = self._omega
        if supply is not None:
            supplied = []
            for (m, ell, k), value, bar in zip(points.tolist(), values[:, None], bars[:, None], strict=True):
                layer = Supplied(MoesPoint(m, ell, k, *oil), supply)
                supplied.append(under([layer], np.ones(1), Rows(Omega, value), bar))
            Omega = supplied[0][0].Omega
            values = np.vstack([rows.values for rows, _ in supplied])
            bars = np.vstack([bar for _, bar in supplied])
        named, error = _named(values), _named(bars)
        error["separation"], named["separation"] = error["approach"], 1.0 - named["approach"]
        axes = dict(zip(("M", "L", "kappa"), points.T, strict=True))
        return AtlasAnswers(**axes, omega=Omega, **named, error_bars=error)

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
        supply: OilLayer | None = None,
        thermal: Heat | bool | None = None,
    ) -> FilmContact | SpringContact:
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
        supply : OilLayer, optional
            Oil that the surfaces carry to the contact; by default it is flooded. A cubic warns where its damper
            would be below zero, and has none.
        thermal : Heat, or True for ``Heat()``, optional
            Let the film heat up; by default it is isothermal. With both the factors of both are multiplied.

        Raises
        ------
        InputError
            A point outside the box, another model, a cubic without its frequency or at a load too light for it, a
            frequency for a model that serves them all. What a table of supply or heat does not have.
        """
        require_choice("model", model, MODELS)
        moes, scales = self._inside(point), scales_of(point)
        w = self._frequency(model, scales, Omega=Omega, omega=omega, hz=hz, rpm=rpm)
        conditions = conditions_at(point, Conditions.of(supply=supply, thermal=thermal))
        if w is not None:
            return self._cubic(point, w, conditions)
        if model == "memory":
            return self._remembering(point, None, conditions)
        return self._remembering(point, self._loads(moes), conditions, one_region=True)

    def wide(
        self,
        point: Point,
        loads: ArrayLike,
        *,
        supply: OilLayer | None = None,
        thermal: Heat | bool | None = None,
        saturating: bool = True,
    ) -> FilmContact:
        """Wide element through answers at loads of one's own choice, in units of the point's, the reference load.

        As fine as wanted and as far as the box goes. The approach is that of `at` under each load, whose region
        goes with its own contact. In `element` oil reaches as far ahead under all loads as under the reference.

        Parameters
        ----------
        point : MoesPoint or OperatingPoint
        loads : array_like, shape (n,), n >= 2
            Increasing.
        supply, thermal : optional
            As in `element`.
        saturating : bool
            False: its inlet does not saturate, as in the contacts of a bearing (`inlet_saturation` 0).

        Raises
        ------
        InputError
            A point or a load outside the box: it names the axis and the box. What a table of supply or heat does
            not have.
        """
        column, moes = as_column("loads", loads, least=2, increasing=True), self._inside(point)
        require_positive("loads[0]", float(column[0]))
        self.box.require_all_inside(_rows(moes, column), moes.alpha)
        conditions = conditions_at(point, Conditions.of(supply=supply, thermal=thermal))
        element = self._remembering(point, column, conditions, saturating=saturating)
        assert isinstance(element, FilmContact)
        return element

    def element_over_speed(
        self,
        point: Point,
        speeds: tuple[float, float] | None = None,
        *,
        supply: OilLayer | None = None,
        thermal: Heat | bool | None = None,
    ) -> FilmContact:
        """Contact element at any load and a speed that may change, in SI for an `OperatingPoint`.

        Parameters
        ----------
        point : MoesPoint or OperatingPoint
            Its load and speed are the references; the element begins at its speed.
        speeds : (float, float), optional
            Lowest and highest u_sum [m/s] of the tables, or over the speed of a `MoesPoint`; that of the point is
            between. By default a tenth and ten times that, as far as the box has the load of the point. Below the
            lowest, films fall as U^0.67.
        supply : OilLayer, optional
            The same oil at all speeds, so no ``over_flooded``; by default the inlet is flooded.
        thermal : Heat, or True for ``Heat()``, optional
            Let the film heat up, at every speed as much as a steady one; by default it is isothermal.

        Raises
        ------
        InputError
            A point outside the box, or speeds at which its load is outside, or what a table of supply or heat does
            not have: it names the range that there is. An ``over_flooded`` layer.
        """
        moes, scales = self._inside(point), scales_of(point)
        unit = 1.0 if scales is None else 2.0 * scales.a / scales.time
        given = Conditions.of(supply=supply, thermal=thermal)
        lowest, most = self._speeds(point, given)
        inside = max(1.0 / USUAL_SPEEDS, lowest * (1.0 + INSIDE)), min(USUAL_SPEEDS, most * (1.0 - INSIDE))
        between = f"{lowest * unit:.4g} to {most * unit:.4g}"
        allowed = f"from {between}, with the speed of the point, {unit:.4g}, between"
        low, high = inside if speeds is None else (speed / unit for speed in _two_ends(speeds, allowed))
        if not lowest <= low <= 1.0 <= high <= most or not low < high:
            raise InputError("speeds", speeds, allowed)
        step = SPEED_STEP if supply is None else SUPPLIED_STEP
        places = np.concatenate([_steps(low, 1.0, step)[:-1], _steps(1.0, high, step)])
        rows, slowest = [], 0.0
        for U in places.tolist():
            at = replace(moes, M=moes.M * U**-0.75, L=moes.L * U**0.25)
            own = at if isinstance(point, MoesPoint) else replace(point, u_sum=point.u_sum * U)
            row = self._remembering(at, self._loads(at), conditions_at(own, given), one_region=True)
            assert isinstance(row, FilmContact)
            assert row.omega_range is not None
            rows.append(row)
            slowest = max(slowest, U * row.omega_range[0])
        return speed_element(places, rows, (slowest, float(self._table.metadata["highest_omega"])), scales)

    def _speeds(self, point: Point, given: Conditions) -> tuple[float, float]:
        """Lowest and highest speed, over that of the point, at which the atlas and its tables have its load."""
        moes = self._inside(point)
        lowest, most = sorted((M / moes.M) ** (-4.0 / 3.0) for M in self.box.M)
        if moes.L > 0.0:
            most = min(most, (self.box.L[1] / moes.L) ** 4)
        for condition in conditions_at(point, given):
            slow, fast = condition.speeds
            lowest, most = max(lowest, slow), min(most, fast)
        return lowest, most

    def _answer(self, point: Point, conditions: Sequence[Condition]) -> AtlasAnswer:
        """Answer under conditions."""
        moes, load = self._inside(point), np.ones(1)
        error = self._oil.error(moes.alpha, moes.eta0, self._table.metadata, self._omega.size)
        flooded, flooded_bars = self._surface.at(self._rows(moes, load), oil_error=error)
        (Omega, values), rows_bars = under(conditions, load, Rows(self._omega, flooded), flooded_bars)
        named, bars = ({n: v[0] for n, v in _named(part).items()} for part in (values, rows_bars))
        bars["separation"], named["separation"] = bars["approach"], 1.0 - named["approach"]
        for numbers in (named, bars):
            numbers |= {name: float(numbers[name]) for name in NUMBERS}
        for condition in conditions:
            named |= condition.noted(float(flooded[0, 1]))
        return AtlasAnswer(moes, omega=Omega, **named, error_bars=bars).in_units_of(point)

    def _cubic(self, point: Point, w: float, conditions: Sequence[Condition]) -> SpringContact:
        moes, scales = self._inside(point), scales_of(point)
        load = np.ones(1)
        flooded, _ = self._surface.beside(self._rows(moes, load))
        rows, _ = under(conditions, load, Rows(self._omega, flooded), np.zeros_like(flooded))
        K, C = (FrequencyCurve(rows.Omega, part[0]) for part in (rows.stiffness, rows.damping))
        place = np.array([w])
        tangent, damper, band = float(K.at(place)[0]), float(C.at(place)[0]), damper_band(rows.Omega, C, w)
        if damper < 0.0:
            size = f"{damper:.3g}" if scales is None else f"{damper * scales.damping:.3g} N s/m"
            message = f"under this layer the solver finds damping below zero at this frequency ({size})"
            warn_user(f"{message}; the cubic element leaves it out, its C1 is 0", OutsideValidityWarning)
        approach, source = float(rows.values[0, 0]), self._whence(point, conditions)
        cubic = cubic_element(approach, tangent, damper, band, source)
        return cubic if scales is None else cubic.to_si(scales)

    def _remembering(
        self,
        point: Point,
        over: _Floats | None,
        conditions: Sequence[Condition],
        *,
        one_region: bool = False,
        saturating: bool = True,
    ) -> FilmContact:
        """Wide-range element over these loads, or film memory about the point's own load.

        `one_region`: where oil floods the inlet, of all loads as far as under the point's own.
        """
        moes, scales = self._inside(point), scales_of(point)
        loads = np.ones(1) if over is None else over
        flooded, shapes = self._surface.beside(self._rows(moes, loads))
        rows, low, isothermal = Rows(self._omega, flooded), flooded[:, LOW], flooded[:, 1]
        at_rest, approach, slowest = rows.damping[:, 0], flooded[:, 0], 0.0
        for condition in conditions:
            before = rows
            rows, _ = condition.apply(loads, before, np.zeros_like(before.values), isothermal)
            shapes = condition.gains(shapes, low, self._rates, before, rows)
            approach = condition.approaches(loads, before, rows)
            slowest, one_region = max(slowest, condition.slowest), one_region and condition.one_region
        gains = np.maximum(shapes * low[:, None], 0.0)
        gains[:, 0] = np.maximum(gains[:, 0], LEAST_VISCOUS / DRY * low)  # as fitted: rates need it
        if one_region:
            approach = approaches_in_one_region(loads, approach, rows.stiffness[:, 0])
        followed = rows.Omega >= slowest
        made_of = Loads(
            loads=loads,
            approach=approach,
            tangent=rows.stiffness[:, 0],
            gains=gains,
            rates=self._rates,
            lowest_omega=_negative_below(rows, low) if slowest else 0.0,
            highest_omega=float(self._table.metadata["highest_omega"]),
            fit=self._fit(rows.Omega[followed], gains, rows.damping[:, followed], at_rest),
            source=self._whence(point, conditions),
        )
        make = memory_element if over is None else partial(wide_element, saturating=saturating)
        try:
            return make(made_of, scales)
        except InputError:  # rarely: interpolated gains that would feed energy back
            return make(replace(made_of, gains=passive_gains(made_of.rates, gains)), scales)

    def _whence(self, point: Point, conditions: Sequence[Condition]) -> dict[str, Any]:
        """Origin of an element: point, atlas and conditions."""
        scales, answer = scales_of(point), self._answer(point, conditions)
        source = self._source(answer) | {condition.name: condition.to_dict() for condition in conditions}
        source["scales"] = None if scales is None else asdict(scales)
        if answer.over_flooded is not None:
            source["least_damping"] = float(answer.damping.min())  # elements leave out what is below 0
        return source | {"assumptions": assumptions(point, film=answer).short()}

    def _fit(self, omega: _Floats, gains: _Floats, damping: _Floats, low: _Floats) -> dict[str, Any]:
        """Misfit between the damping of the filters and of the atlas, over `low`, the flooded one at rest."""
        used = omega <= self._table.metadata["highest_omega"]
        filtered = gains @ (self._rates.basis(omega[used]).real * DRY).T
        error = np.abs(filtered - damping[:, used]) / low[:, None]
        return {"rms": None, "damping_error_max": float(np.max(error))}

    def _frequency(self, model: str, scales: Scales | None, **given: Unpack[Frequency]) -> float | None:
        """Omega of the cubic element; None for the other models, which are valid at all frequencies."""
        if model == "cubic":
            time = None if scales is None else scales.time
            return one("frequency", dimensionless(time, **given, most=float(self._omega[-1])))
        for name, value in given.items():
            if value is not None:
                highest = float(self._table.metadata["highest_omega"])
                allowed = f"left out with model {model!r}, which serves every frequency up to Omega = {highest:g}"
                raise InputError(name, value, allowed)
        return None

    def _inside(self, point: Point) -> MoesPoint:
        moes = moes_point(point)
        self.box.require_inside(moes)
        self._oil.require_accepted(moes, self._table.metadata)
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

    def _rows(self, point: MoesPoint, loads: _Floats) -> _Floats:
        """M, L and kappa at which the table is read for loads in units of the point's, shape (n, 3)."""
        return _rows(point, loads) * self._oil.factors(point.alpha, point.eta0, self._table.metadata)

    def _source(self, answer: AtlasAnswer) -> dict[str, Any]:
        bars, low = answer.error_bars, self._table.interpolation.reference
        return {
            "atlas": self._table.metadata["version"],
            "point": answer.point.moes.to_dict(),
            "error_bars": {
                "approach": bars["approach"],
                "h_central": bars["h_central"],
                "tangent": float(bars["stiffness"][0]),
                "damping": float(bars["damping"][low]),
            },
        }


def conditions_at(point: Point, given: Conditions) -> list[Condition]:
    """Conditions of the tables at a point, in the order in which they are applied.

    A supply comes last: its table is read at the layer over the film that heat leaves.

    Raises
    ------
    InputError
        A supply or heat that its table does not have.
    """
    conditions: list[Condition] = []
    if given.heat is not None:
        conditions.append(Heated(point, given.heat))
    if given.supply is not None:
        conditions.append(Supplied(point, given.supply))
    return conditions


def _named(rows: _Floats) -> dict[str, Any]:
    k = (rows.shape[1] - HEAD) // 2
    u, central, least, _, moment = rows[:, :HEAD].T
    named = {"approach": u, "h_central": central, "h_min": least, "moment": moment}
    return named | {"stiffness": rows[:, HEAD : HEAD + k], "damping": rows[:, HEAD + k :]}


def _negative_below(rows: Rows, low: _Floats) -> float:
    """Frequency from 0 up to which C is below zero under some load, by more than a small share of `low`."""
    reach = np.cumprod(rows.damping < -NEGATIVE * low[:, None], axis=1).any(axis=0)
    return float(rows.Omega[reach].max(initial=0.0))


def _two_ends(speeds: ArrayLike, allowed: str) -> tuple[float, float]:
    """The lowest and the highest speed; raises `InputError` for anything but two numbers."""
    ends = as_numbers("speeds", speeds, f"a pair of numbers, {allowed}")
    if ends.shape != (2,):
        raise InputError("speeds", speeds, f"a pair of numbers, {allowed}")
    return float(ends[0]), float(ends[1])


def _steps(low: float, high: float, ratio: float) -> _Floats:
    """From `low` to `high` in equal ratios of at most `ratio`."""
    return np.geomspace(low, high, 1 + math.ceil(math.log(high / low) / math.log(ratio) - INSIDE))


def _points(M: ArrayLike, L: ArrayLike, kappa: ArrayLike) -> _Floats:
    """Rows (M, L, kappa)."""
    try:
        columns = np.broadcast_arrays(*(np.atleast_1d(np.asarray(v, dtype=float)) for v in (M, L, kappa)))
    except (TypeError, ValueError):
        raise InputError(
            "M, L, kappa", "no numbers of one shape", "numbers, or flat lists of one length"
        ) from None
    if columns[0].ndim != 1 or not columns[0].size:
        raise InputError("M, L, kappa", f"of shape {columns[0].shape}", "numbers, or flat lists of one length")
    return np.column_stack(columns)


def _rows(point: MoesPoint, loads: _Floats) -> _Floats:
    """Rows (M, L, kappa) of the point under these loads."""
    return np.column_stack([point.M * loads, np.full(loads.size, point.L), np.full(loads.size, point.kappa)])
