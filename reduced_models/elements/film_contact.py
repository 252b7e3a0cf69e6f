"""`FilmContact`: elements with a film memory; equations in `film_law`, of a speed that changes in `film_speed`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any, ClassVar, Self, Unpack

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import (
    as_column,
    as_float,
    as_values,
    require_finite,
    require_positive,
)
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from ehlcontact.store import stored
from reduced_models.elements.base import Box, ContactElement, as_approaches
from reduced_models.elements.film_filters import CHAIN, DIRECT
from reduced_models.elements.film_law import (
    RATE,
    THETA,
    FilmLaw,
    film_drive,
    film_made,
    film_rate,
    film_rates,
    film_rest,
    film_step,
    static,
    static_forces,
)
from reduced_models.elements.film_response import DRY, FilterRates, LinearFilm, StateSpace
from reduced_models.elements.film_speed import SpeedHistory, SpeedRange
from reduced_models.elements.film_tables import (
    COEFFICIENTS,
    KINDS,
    checked_coefficients,
    film_laws,
    read_coefficients,
)
from reduced_models.elements.motion_errors import UNLOADING, WITHIN, motion_errors
from reduced_models.elements.validity import numbers

_Floats = NDArray[np.float64]

_SCALES = tuple(f.name for f in fields(Scales))


def units_of(scales: Scales | None) -> tuple[float, float, float]:
    """Units of force, approach and time: N, m and s, or 1 of a dimensionless element."""
    return (1.0, 1.0, 1.0) if scales is None else (scales.force, scales.length, scales.time)


class FilmBox(Box, total=False):
    """Fields that all elements with a film memory have, as keyword arguments of their constructors."""

    scales: Scales | None


@stored("contact element")
@dataclass(frozen=True, kw_only=True)
class FilmContact(ContactElement):
    """Dry Hertz spring on a film with memory, made by one of its constructors.

    `memory` is for motion about one load, `wide` for every load, from lift-off to overload, both at one speed of
    the surfaces; `over_speed` is for every load and a speed that may change (`set_speed`). They are one law, a
    static film and gains of its memory, with tables over load and speed.

    The element carries a state and starts at rest under its reference load; one element must not serve two
    contacts (take a `copy`). Its coefficients are dimensionless always; in SI it holds the ``scales`` and
    converts what goes in and out.

    Parameters
    ----------
    kind : {"memory", "wide", "speed"}
    film, exponent, speeds, loads, approach, gain_loads, gains, inlet_saturation
        As for the constructor of the kind; None where the kind has no such coefficient.
    lag_rate, inlet_rate, fast_rate : float
        Rates nu, p_i and p_f of the filters, > 0, the same at every load and speed in their own units.
    low, high, rate, load_range, omega_range, units, fit, source
        As for `ContactElement`; `low` and `high` are the ends of `approach` by default. Frequencies and `rate` are
        for the speed of the reference.
    scales : Scales, optional
        Of an element in SI.

    Attributes
    ----------
    law : FilmLaw
        Static curve, filters and gains at the present speed.

    Raises
    ------
    InputError
        A coefficient outside its range, tables that are no contact (it names the entry), or gains that would feed
        energy into a vibration.
    """

    film: float | None = None
    exponent: float | None = None
    speeds: Any = None  # tables: tuples of float, of rows, of rows for every speed
    loads: Any = None
    approach: Any = None
    gain_loads: Any = None
    gains: Any
    inlet_saturation: Any
    lag_rate: float
    inlet_rate: float
    fast_rate: float
    low: float | None = None  # type: ignore[assignment]
    high: float | None = None  # type: ignore[assignment]
    scales: Scales | None = None

    kinds: ClassVar[Mapping[str, tuple[str, ...]]] = KINDS
    law: FilmLaw = field(init=False, repr=False, compare=False)  # at the present speed
    _range: SpeedRange = field(init=False, repr=False, compare=False)
    _speed: float = field(init=False, repr=False, compare=False)  # present one, over that of the reference
    _history: SpeedHistory = field(init=False, repr=False, compare=False)
    _units: tuple[float, float, float] = field(init=False, repr=False, compare=False)  # at the present speed
    _state: _Floats = field(init=False, repr=False, compare=False)
    _next: _Floats = field(init=False, repr=False, compare=False)

    @classmethod
    def memory(
        cls,
        film: float,
        exponent: float,
        inlet_saturation: float,
        lag_rate: float,
        inlet_rate: float,
        fast_rate: float,
        gains: ArrayLike,
        low: float,
        high: float,
        **box: Unpack[FilmBox],
    ) -> Self:
        """Contact about one load, with the damping of every frequency; made by `reduced_models.fit_memory`.

        The static film is h_s = film F^-exponent, which approach and static tangent at the reference load fix.
        About one load it is better than a wide one; far from it each is ahead in some motions. Free vibrations at
        M = 200, L = 10, kappa = 0.5, n = 64, Omega_n = 2.56 / 5.13, error of the simulated approach over its
        spread: within 15 % of the load 0.98 / 1.56 % (wide, of the same grid, 1.93 / 1.83 %), with the load
        between 0.25 and 1.96 5.5 / 7.3 % (5.4 / 10.0 %). The film curve of the wide one with these gains has
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
            As for the class.
        gains : sequence of float
            Viscous, inlet and fast gain, then one for every lag of the chain.
        low, high : float
            Ends of the approach; other bounds and `scales` as for the class.
        """
        return cls(
            kind="memory",
            film=film,
            exponent=exponent,
            inlet_saturation=inlet_saturation,
            lag_rate=lag_rate,
            inlet_rate=inlet_rate,
            fast_rate=fast_rate,
            gains=gains,
            low=low,
            high=high,
            **box,
        )

    @classmethod
    def wide(
        cls,
        loads: ArrayLike,
        approach: ArrayLike,
        gain_loads: ArrayLike,
        gains: ArrayLike,
        inlet_saturation: float,
        lag_rate: float,
        inlet_rate: float,
        fast_rate: float,
        low: float | None = None,
        high: float | None = None,
        **box: Unpack[FilmBox],
    ) -> Self:
        """Contact at any load for given geometry, lubricant and speed.

        The static curve interpolates the film h_s = F^(2/3) - u over the load, ln over ln; it is C1, rises always
        and fades as the surfaces part: below the lightest load it turns into that of rigid surfaces, F like
        h^-1/2.
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
        inlet_saturation : float
            beta of phi, >= 0.
        lag_rate, inlet_rate, fast_rate : float
            As for the class.
        low, high : float, optional
            Ends of the approach; other bounds and `scales` as for the class.
        """
        return cls(
            kind="wide",
            loads=loads,
            approach=approach,
            gain_loads=gain_loads,
            gains=gains,
            inlet_saturation=inlet_saturation,
            lag_rate=lag_rate,
            inlet_rate=inlet_rate,
            fast_rate=fast_rate,
            low=low,
            high=high,
            **box,
        )

    @classmethod
    def over_speed(
        cls,
        speeds: ArrayLike,
        loads: ArrayLike,
        approach: ArrayLike,
        gain_loads: ArrayLike,
        gains: ArrayLike,
        inlet_saturation: ArrayLike,
        lag_rate: float,
        inlet_rate: float,
        fast_rate: float,
        low: float | None = None,
        high: float | None = None,
        **box: Unpack[FilmBox],
    ) -> Self:
        """Contact at any load and at a speed of the surfaces that may change from step to step.

        At a constant speed it is the `wide` element of that speed. After `set_speed` the film in the contact is
        that of the speeds at which it was made (`film_speed`), so it follows a change of speed as late as one of
        the approach; rest and linear laws are those of the present speed. Only the magnitude of the speed is used:
        after a reversal the film moves on through the contact. Between the speeds of the tables ln h_s is linear
        in ln U, gains are linear in U^0.67; below the lowest both fall as U^0.67, to no film at standstill. Where
        the surfaces stop, the film in the contact keeps its thickness.

        Parameters
        ----------
        speeds : sequence of float, length s >= 2
            Increasing, over u_sum of the reference; from at most to at least 1.
        loads : sequence of float, length n >= 2
            Increasing static loads in units of the reference load.
        approach : sequence of s rows
            Static approach under each load at each speed, in dry approaches of the reference load.
        gain_loads : sequence of float, length k >= 1
            Loads of the rows of gains.
        gains : sequence of s sequences of k rows
            As for `wide`, in the units of load and speed of the row.
        inlet_saturation : sequence of float, length s
            beta of phi, >= 0, at each speed.
        lag_rate, inlet_rate, fast_rate : float
            As for the class.
        low, high : float, optional
            Ends of the approach; other bounds and `scales` as for the class.
        """
        return cls(
            kind="speed",
            speeds=speeds,
            loads=loads,
            approach=approach,
            gain_loads=gain_loads,
            gains=gains,
            inlet_saturation=inlet_saturation,
            lag_rate=lag_rate,
            inlet_rate=inlet_rate,
            fast_rate=fast_rate,
            low=low,
            high=high,
            **box,
        )

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.scales is None) != (self.units == "dimensionless"):
            raise InputError("scales", self.scales, "given for an element in SI, and only there")
        laws = film_laws(self.kind, self._coefficients())
        self._put(_range=SpeedRange(self.speeds or (1.0,), laws), _speed=1.0, _units=units_of(self.scales))
        self._put(law=self._range.laws[0] if self.speeds is None else self._range.at(1.0))
        self._put(_state=np.zeros(CHAIN + self.lags), _next=np.zeros(CHAIN + self.lags))
        self.rest(self.approach_at(self._units[0]))

    def _put(self, **values: Any) -> None:
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def _coefficients(self) -> dict[str, Any]:
        """All coefficients by name, None of another kind."""
        return {name: getattr(self, name) for name in COEFFICIENTS}

    def _check_coefficients(self) -> None:
        self._put(**checked_coefficients(self.kind, self._coefficients()))
        if self.kind == "memory":
            return
        u, (force, length, _) = np.atleast_2d(np.asarray(self.approach)), units_of(self.scales)
        for name, end in (("low", u[:, 0].min()), ("high", u[:, -1].max())):
            if getattr(self, name) is None:
                self._put(**{name: float(end) * length})
        if self.load_range is None:
            self._put(load_range=(self.loads[0] * force, self.loads[-1] * force))

    @property
    def _beyond(self) -> Mapping[str, str]:
        texts = {
            "memory": "it is for motion about one load: a wide element (model 'wide') is made for every load",
            "wide": "`motion_errors` has what fast closing of parted surfaces costs",
        }
        return {"motion": texts[self.kind]} if self.kind in texts else {}

    @property
    def parameters(self) -> dict[str, Any]:
        """Coefficients and tables by name, dimensionless."""
        return {name: np.asarray(getattr(self, name)).tolist() for name in self.parameter_names}

    @property
    def lags(self) -> int:
        """Number of lags that carry the film through the contact."""
        return int(self.law.gains.shape[1]) - DIRECT

    @property
    def rates(self) -> FilterRates:
        """Rates of the filters."""
        return FilterRates(self.lags, self.lag_rate, self.inlet_rate, self.fast_rate)

    @property
    def time(self) -> float | None:
        """Unit of time [s] of an element in SI."""
        return None if self.scales is None else self.scales.time

    @property
    def motion_errors(self) -> dict[str, float]:
        """RMS error of the force over its standard deviation, by kind of motion; of wide elements only.

        Estimated from full solves at three points, by the film under the reference load; typical, not bounds.
        The error grows with the rate of the motion, and those are at one rate each (docs/notes/elements.md).
        """
        if self.kind != "wide":
            return {}
        f, length, _ = self._units
        return motion_errors(1.0 - self.approach_at(f) / length)

    @property
    def rms(self) -> float | None:
        """RMS error of the force over its standard deviation: of the fit, or of vibrations in contact."""
        fitted, errors = super().rms, self.motion_errors
        return max(errors[WITHIN], errors[UNLOADING]) if fitted is None and errors else fitted

    def _summary_lines(self) -> list[str]:
        lines, errors = super()._summary_lines(), self.motion_errors
        if errors:
            worst = max(errors, key=lambda kind: errors[kind])
            values = ", ".join(f"{kind} {100.0 * errors[kind]:.2g} %" for kind in dict.fromkeys((WITHIN, worst)))
            lines.append(f"rms error of the force (faster motions more): {values}")
        if self.speeds is not None:
            low, high = (self._reference_speed * speed for speed in (self.speeds[0], self.speeds[-1]))
            lines.append(f"speeds {low:.4g} to {high:.4g}{' m/s' if self.units == 'SI' else ''}")
        return lines

    # ---- speed of the surfaces

    @property
    def _reference_speed(self) -> float:
        """Unit of speed: 1, or u_sum of the reference [m/s]."""
        return 1.0 if self.scales is None else 2.0 * self.scales.a / self.scales.time

    @property
    def speed(self) -> float:
        """Present speed: u_sum [m/s] of an element in SI, over that of the reference of any other."""
        return self._speed * self._reference_speed

    def set_speed(self, u_sum: float) -> None:
        """Let the surfaces be at this speed at the end of the next step, and stay at it.

        Within that step it goes straight from that of the step before. For `rest` it has always been there.

        Parameters
        ----------
        u_sum : float
            Sum of both surface speeds [m/s], or over that of the reference of an element without units.

        Raises
        ------
        InputError
            An element for one speed; a speed above those of the tables, or not finite.
        """
        if self.speeds is None:
            raise InputError("u_sum", u_sum, f"left out: an element of kind {self.kind!r} is for one speed")
        speed = require_finite("u_sum", u_sum) / self._reference_speed
        most = self.speeds[-1] * (1.0 + 1e-9)
        if abs(speed) > most:
            raise InputError("u_sum", u_sum, f"at most {self.speeds[-1] * self._reference_speed:.6g} in magnitude")
        if speed != self._speed:
            (f, length, time), rolling = units_of(self.scales), self._range.moving(speed)
            self._put(_speed=speed, law=self._range.at(rolling), _units=(f, length, time / rolling))

    def copy(self) -> Self:
        """An equal element at the present speed, with a state of its own, at rest."""
        element = replace(self)
        if self.speeds is not None:
            element.set_speed(self.speed)
            element.rest(element.approach_at(element._units[0]))
        return element

    # ---- motion

    def _begin(self, dt: float) -> tuple[FilmLaw, float, _Floats, float, SpeedHistory | None]:
        """Law, length and start of the next step in its own time, that unit of time, and the speeds at its end."""
        if self.speeds is None:
            time = self._units[2]
            return self.law, require_step(dt) / time, self._state, time, None
        unit = units_of(self.scales)[2]
        step = self._range.begin(self._state, self._history, self._speed, self.law, require_step(dt), unit)
        return step.law, step.dt, step.old, step.time, step.history

    def advance(self, dt: float, approach: float, rate: float) -> float:
        """Force at the end of a step `dt` > 0, at approach, rate and speed of that end; moves the state there.

        The step may have any length: between its ends the approach is taken as the cubic through both
        approaches and rates, and every filter is integrated exactly.
        """
        u, v = as_float("approach", approach), as_float("rate", rate)
        force = self._move(dt, u, v)
        self._watch(u, v, force)
        return force

    def _move(self, dt: float, u: float, v: float) -> float:
        """Move the state through a step; returns the force at its end."""
        f, length, _ = self._units
        law, own, old, time, history = self._begin(dt)
        force = float(film_step(law, old, self._next, own, u / length, v / length * time)[0])
        if not math.isfinite(force):
            raise InputError("approach and rate", (u, v), "finite")
        old = self._state
        object.__setattr__(self, "_state", self._next)
        object.__setattr__(self, "_next", old)
        if history is not None:
            object.__setattr__(self, "_history", history)
        return force * f

    def step_tangents(self, dt: float, approach: float, rate: float) -> tuple[float, float, float]:
        """Force, dF/du and dF/du' at the end of a step from the present state, which stays where it is.

        These are the exact derivatives of what `advance` would return, memory included.
        """
        f, length, _ = self._units
        law, own, old, time, _ = self._begin(dt)
        u, v = as_float("approach", approach) / length, as_float("rate", rate) / length * time
        force, stiffness, damping = film_step(law, old, self._next, own, u, v)
        return float(force) * f, float(stiffness) * f / length, float(damping) * f / length * time

    def save_state(self) -> object:
        """Copy of the film's state, and of the speeds that it was made at where they may change."""
        if self.speeds is None:
            return self._state.copy()
        *values, states = self._history
        return np.concatenate([self._state, values, states])

    def restore_state(self, state: object) -> None:
        """Go back to a saved state; `set_speed` still gives the speed at the end of the next step."""
        size, saved = self._state.size, as_column("state", state)  # type: ignore[arg-type]
        whole = size if self.speeds is None else len(self.save_state())  # type: ignore[arg-type]
        if saved.size != whole:
            raise InputError("state", f"of {saved.size} numbers", f"one that save_state made, of {whole}")
        self._state[:] = saved[:size]
        if self.speeds is not None:
            speed, pace, film, slowed = saved[size : size + 4].tolist()
            self._put(_history=SpeedHistory(speed, pace, film, slowed, saved[size + 4 :].copy()))

    def rest(self, approach: float) -> float:
        """Put the contact at rest at this approach and the present speed, its film that of a steady contact.

        Returns
        -------
        float
            The static force.
        """
        f, length, _ = self._units
        force = float(film_rest(self.law, require_finite("approach", approach) / length, self._state)) * f
        self._put(_history=SpeedHistory.constant(self._speed, self._range.moving(self._speed), self.lags))
        return force

    def drive(self, T: ArrayLike, approach: ArrayLike, rate: ArrayLike, u_sum: ArrayLike | None = None) -> _Floats:
        """Force along a whole record, from rest at its first approach; the element's own state stays.

        Parameters
        ----------
        T, approach, rate : array_like, shape (N,)
            Increasing times and the motion, in the units of the element. The motion sets in with ``rate[0]``.
        u_sum : array_like, shape (N,), optional
            Speed of the surfaces as for `set_speed`, from rest at its first; by default the present one.

        Returns
        -------
        ndarray, shape (N,)
            Outside the validity box it warns, once per element.

        Raises
        ------
        InputError
            Times that do not increase, another number of approaches or rates, an entry that is not finite; `u_sum`
            of an element for one speed.
        """
        f, length, time = self._units
        t = as_column("T", T, increasing=True)
        motion = {"approach": approach, "rate": rate}
        u, v = (as_column(name, values, size=t.size) for name, values in motion.items())
        force = np.empty(t.size)
        if u_sum is None:
            film_drive(self.law, t / time, u / length, v / length * time, force)
            self.warn_outside(u, v, force=force * f)
            return force * f
        element, speed = replace(self), as_column("u_sum", u_sum, size=t.size)
        element.set_speed(float(speed[0]))
        force[0] = element.rest(float(u[0]))
        element._state[RATE] = element._state[THETA] * v[0] / element._units[1] * element._units[2]
        for k in range(1, t.size):
            element.set_speed(float(speed[k]))
            force[k] = element.advance(t[k] - t[k - 1], u[k], v[k])
        return force

    def spring(self, approach: ArrayLike) -> float | _Floats:
        """Static force."""
        f, length, _ = self._units
        u = as_approaches(approach) / length
        force = np.empty(u.size)
        static_forces(self.law, u.ravel(), force)
        return force.reshape(u.shape) * f if u.ndim else float(force[0]) * f

    def spring_tangent(self, approach: float) -> float:
        """Slope of the static force."""
        f, length, _ = self._units
        _, g, g_u = static(require_finite("approach", approach) / length, self.law)
        return 1.5 * math.sqrt(g) * g_u * f / length

    def approach_at(self, force: float) -> float:
        """Static approach under `force` > 0."""
        f, length, _ = self._units
        target = require_positive("force", force) / f
        x = math.log(target)
        k = int(np.clip(np.searchsorted(self.law.x, x) - 1, 0, self.law.x.size - 2))
        low, high = self.law.u[k], self.law.u[k + 1]
        reach = high - low
        while self._static_x(low) > x:
            low, reach = low - reach, 2.0 * reach
        while self._static_x(high) < x:
            high, reach = high + reach, 2.0 * reach
        root = scipy.optimize.brentq(lambda u: self._static_x(u) - x, low, high, xtol=1e-15, rtol=1e-14)
        return float(root) * length

    def _static_x(self, u: float) -> float:
        return float(static(u, self.law)[0])

    # ---- small motion and continuous time

    def _response(self, w: _Floats, load: float | None = None) -> NDArray[np.complex128]:
        """As `impedance`, at angular frequencies in the units of the element, shape (k,)."""
        return self.linear_film(load).impedance(1j * w)

    def linear_film(self, load: float | None = None) -> LinearFilm:
        """Linear law about rest under `load`, by default the reference load, in the units of the element."""
        f, length, time = self._units
        share = 1.0 if load is None else require_positive("load", load) / f
        own = share ** (1.0 / 3.0)  # length of the contact, and so its time, over that under the reference load
        tangent = self.spring_tangent(self.approach_at(share * f))
        x = math.log(share)
        slope, tau, made = DRY * own * f / length, own * time, float(film_made(x, self.law))
        return LinearFilm(tangent, slope, tau, self.gains_at(x), self.rates, made)

    def gains_at(self, x: float | _Floats) -> _Floats:
        """Gains at x = ln F, shape (3 + lags,) + that of x, with F in units of the reference load."""
        x = as_values("x", x)
        return np.array([np.interp(x, self.law.gain_x, column) for column in self.law.gains.T])

    @property
    def state_count(self) -> int:
        """Number of states of the film in continuous time."""
        return 2 + self.lags

    def continuous(self, states: _Floats, approach: float, rate: float) -> tuple[float, _Floats]:
        """Force and d(states)/dt in continuous time: what `advance` does with a motion cubic within the step."""
        f, length, time = self._units
        rates = np.empty(states.size)
        force = film_rates(self.law, np.ascontiguousarray(states), approach / length, rate / length * time, rates)
        return float(force) * f, rates / time

    def rate_under(self, states: _Floats, approach: float, force: float) -> float:
        """Rate at which the contact carries `force` > 0: the motion without inertia."""
        f, length, time = self._units
        states = np.ascontiguousarray(states)  # of any layout: compiled once
        return float(film_rate(self.law, states, approach / length, force / f)) * length / time

    @property
    def _state_names(self) -> list[str]:
        return ["s", "y", *(f"q{k}" for k in range(1, self.lags + 1))]

    def state_space(self, load: float | None = None) -> StateSpace:
        """Linear law about rest under `load`; states s, y, q1 ... are those of `state_rates`."""
        A, fed, C, D = self.linear_film(load).state_space()
        unit = self._units[1]
        return StateSpace(A, fed / unit, C * unit, D)

    # ---- files

    def _si_coefficients(self, scales: Scales) -> dict[str, Any]:
        return {"scales": scales}  # the coefficients stay dimensionless

    def to_dict(self) -> dict[str, Any]:
        """All of it, ready for JSON; ``parameters`` dimensionless, ``scales`` of an SI element."""
        return super().to_dict() | {"scales": None if self.scales is None else asdict(self.scales)}

    @classmethod
    def _read_coefficients(cls, kind: str, entries: Mapping[str, Any]) -> dict[str, Any]:
        values, scales = read_coefficients(kind, entries["parameters"]), entries.get("scales")
        if scales is not None:
            if not isinstance(scales, dict):
                raise InputError("scales", scales, "an object or null")
            values["scales"] = Scales(**numbers("scales", scales, _SCALES))
        return values


def require_step(dt: float) -> float:
    """Return a length of a step, or raise `InputError`."""
    if not 0.0 < as_float("dt", dt) < math.inf:
        raise InputError("dt", dt, "finite and > 0")
    return float(dt)
