"""`SpeedRangeContact`: contact element for any load and for a speed of the surfaces that changes over time."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_float, as_numbers, as_rows, require_between, require_finite
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from ehlcontact.store import stored
from reduced_models.elements.film_curve import curve_nodes
from reduced_models.elements.film_element import LARGEST_GAIN, FilmContact, require_step
from reduced_models.elements.film_filters import CHAIN, DIRECT, FAST, INLET
from reduced_models.elements.film_law import APPROACH, RATE, THETA, FilmLaw, film_rest, film_step, static
from reduced_models.elements.film_speed import AGES, FILM_GROWTH, film_speed, speed_step
from reduced_models.elements.wide_range import LOADS

_Floats = NDArray[np.float64]

SPEEDS = (1e-6, 1e6)  # over that of the point
STANDSTILL = 1e-6  # of the lowest speed of the tables: as good as none, and keeps steps from a division by 0


class _FilmSpeed(NamedTuple):
    """What a film keeps of the speeds of its surfaces."""

    speed: float  # at the end of the last step
    pace: float  # mean of the last step, in whose time its rate is
    film: float  # V of `film_speed`
    slowed: float  # pace over V, at most 1
    states: _Floats


class _Step(NamedTuple):
    """A step about to be made: its law, length and start in the time of its mean speed."""

    law: FilmLaw
    dt: float
    old: _Floats
    past: _FilmSpeed
    time: float  # that unit of time, in the units of the element


@stored("contact element")
@dataclass(frozen=True)
class SpeedRangeContact(FilmContact):
    """Contact at any load and at a speed that may change, with its film memory.

    At a constant speed it is the `WideRangeContact` of that speed. After `set_speed` the film in the contact is
    that of the speeds at which it was made (`film_speed`), so it follows a change of speed as late as one of the
    approach; rest and linear laws are those of the present speed. Only the magnitude of the speed is used: after a
    reversal the film moves on through the contact. Between the speeds of the tables ln h_s is linear in ln U,
    gains are linear in U^0.67; below the lowest both fall as U^0.67, to no film at standstill. Where the surfaces
    stop, the film in the contact keeps its thickness.

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
        As for `WideRangeContact`, in the units of load and speed of the row.
    inlet_saturation : sequence of float, length s
        As for `FilmMemoryContact`, at each speed.
    lag_rate, inlet_rate, fast_rate : float
        As there, the same at every load and speed in their own units.
    low, high, rate, load_range, omega_range, units, scales, fit, source
        As there; frequencies and `rate` for the speed of the reference.

    Raises
    ------
    InputError
        Tables that are no contact: it names the entry.
    """

    speeds: tuple[float, ...]
    loads: tuple[float, ...]
    approach: tuple[tuple[float, ...], ...]
    gain_loads: tuple[float, ...]
    gains: tuple[tuple[tuple[float, ...], ...], ...]
    inlet_saturation: tuple[float, ...]  # type: ignore[assignment]
    lag_rate: float
    inlet_rate: float
    fast_rate: float
    low: float | None = None  # type: ignore[assignment]
    high: float | None = None  # type: ignore[assignment]
    scales: Scales | None = field(default=None, kw_only=True)
    kind: str = field(default="speed", kw_only=True)

    kinds: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "speed": (
            "speeds",
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
    tables = ("speeds", "loads", "approach", "gain_loads", "gains", "inlet_saturation")
    beyond: ClassVar[Mapping[str, str]] = {}
    _laws: tuple[FilmLaw, ...] = field(init=False, repr=False, compare=False)
    _speed: float = field(init=False, repr=False, compare=False)
    _past: _FilmSpeed = field(init=False, repr=False, compare=False)

    def _check_coefficients(self) -> None:
        self._check_rates()
        for name, least in (("speeds", 2), ("loads", 2), ("gain_loads", 1)):
            column = as_column(name, getattr(self, name), least=least, increasing=True)
            object.__setattr__(self, name, tuple(column.tolist()))
            limits = SPEEDS if name == "speeds" else LOADS
            require_between(f"{name}[0]", column[0], *limits)
            require_between(f"{name}[-1]", column[-1], *limits)
        if not self.speeds[0] <= 1.0 <= self.speeds[-1]:
            raise InputError("speeds", self.speeds, "from at most 1 to at least 1, the speed of the reference")
        count, forces = len(self.speeds), len(self.loads)
        rows = as_rows("approach", self.approach, count, forces)
        object.__setattr__(self, "approach", tuple(tuple(row) for row in rows.tolist()))
        given = as_numbers("gains", self.gains, "rows of numbers for every speed")
        if given.ndim != 3 or given.shape[0] != count:
            allowed = f"({count}, {len(self.gain_loads)}, {DIRECT + 1} or more)"
            raise InputError("shape of gains", given.shape, allowed)
        tables = [as_rows("gains", one, len(self.gain_loads), DIRECT + 1).tolist() for one in given]
        object.__setattr__(self, "gains", tuple(tuple(tuple(row) for row in one) for one in tables))
        saturation = as_column("inlet_saturation", self.inlet_saturation, size=count)
        for k, one in enumerate(saturation.tolist()):
            require_between(f"inlet_saturation[{k}]", one, 0.0, LARGEST_GAIN)
        object.__setattr__(self, "inlet_saturation", tuple(saturation.tolist()))
        force, length = (1.0, 1.0) if self.scales is None else (self.scales.force, self.scales.length)
        for name, end in (("low", rows[:, 0].min()), ("high", rows[:, -1].max())):
            if getattr(self, name) is None:
                object.__setattr__(self, name, float(end) * length)
        if self.load_range is None:
            object.__setattr__(self, "load_range", (self.loads[0] * force, self.loads[-1] * force))

    def _tables(self) -> dict[str, _Floats]:
        raise NotImplementedError  # one for every speed: `_first_law`

    def _first_law(self) -> FilmLaw:
        x, laws = np.log(self.gain_loads), []
        for u, gains, saturation in zip(self.approach, self.gains, self.inlet_saturation, strict=True):
            tables = curve_nodes(self.loads, u) | {"gain_x": x, "gains": np.array(gains)}
            laws.append(self._law_of(tables, saturation))
        object.__setattr__(self, "_laws", tuple(laws))
        object.__setattr__(self, "_speed", 1.0)
        return self._law_at(1.0)

    def _law_at(self, speed: float) -> FilmLaw:
        """Law at a constant speed > 0, over that of the reference."""
        k = min(max(bisect_left(self.speeds, speed) - 1, 0), len(self.speeds) - 2)
        (low, high), a, b = self.speeds[k : k + 2], self._laws[k], self._laws[k + 1]
        if speed < low:
            share = (speed / low) ** FILM_GROWTH
            y, slope, gains, saturation = a.y + math.log(share), a.slope, a.gains * share, a.inlet_saturation
        else:
            w = math.log(speed / low) / math.log(high / low)
            y, slope = a.y + w * (b.y - a.y), a.slope + w * (b.slope - a.slope)
            saturation = a.inlet_saturation + w * (b.inlet_saturation - a.inlet_saturation)
            w = ((speed / low) ** FILM_GROWTH - 1.0) / ((high / low) ** FILM_GROWTH - 1.0)
            gains = a.gains + w * (b.gains - a.gains)
        u = np.exp(2.0 / 3.0 * a.x) - np.exp(y)
        return a._replace(y=y, slope=slope, u=u, gains=gains, inlet_saturation=saturation)

    @property
    def _rolling(self) -> float:
        """Magnitude of the present speed, over that of the reference; that which stands for 0 at standstill."""
        return self._moving(self._speed)

    def _moving(self, speed: float) -> float:
        return max(abs(speed), STANDSTILL * self.speeds[0])

    @property
    def _units(self) -> tuple[float, float, float]:
        f, length, time = super()._units
        return f, length, time / self._rolling

    @property
    def _reference_speed(self) -> float:
        """Unit of speed: 1, or u_sum of the reference [m/s]."""
        return 1.0 if self.scales is None else 2.0 * self.scales.a / self.scales.time

    @property
    def speed(self) -> float:
        """Speed given last: u_sum [m/s] of an element in SI, over that of the reference of any other."""
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
            A speed above those of the tables, or not finite.
        """
        speed = require_finite("u_sum", u_sum) / self._reference_speed
        most = self.speeds[-1] * (1.0 + 1e-9)
        if abs(speed) > most:
            raise InputError("u_sum", u_sum, f"at most {self.speeds[-1] * self._reference_speed:.6g} in magnitude")
        if speed != self._speed:
            object.__setattr__(self, "_speed", speed)
            object.__setattr__(self, "law", self._law_at(self._rolling))

    def _summary_lines(self) -> list[str]:
        low, high = (self._reference_speed * speed for speed in (self.speeds[0], self.speeds[-1]))
        return [*super()._summary_lines(), f"speeds {low:.4g} to {high:.4g}{' m/s' if self.units == 'SI' else ''}"]

    def copy(self) -> Self:
        """The same element at the present speed, with a state of its own, at rest."""
        found = replace(self)
        found.set_speed(self.speed)
        found.rest(found.approach_at(found._units[0]))
        return found

    def rest(self, approach: float) -> float:
        """Put the contact at rest at this approach and the present speed; returns the force."""
        f, length, _ = self._units
        force = float(film_rest(self.law, require_finite("approach", approach) / length, self._state)) * f
        states = np.full(AGES + self.lags, self._rolling**FILM_GROWTH)
        self._keep(_FilmSpeed(self._speed, self._rolling, self._rolling, 1.0, states))
        return force

    def _keep(self, past: _FilmSpeed) -> None:
        object.__setattr__(self, "_past", past)

    def _begin(self, dt: float) -> _Step:
        """The next step: mean speed, film of the speeds so far, and the law of that film."""
        past = self._past
        pace = self._moving(0.5 * (abs(past.speed) + abs(self._speed)))
        time = super()._units[2] / pace
        own, old, z = require_step(dt) / time, self._state.copy(), self._rolling**FILM_GROWTH
        old[RATE] *= past.pace / pace
        film, states = self._rolling, past.states
        if np.any(states != z):
            before, slowed = self._law_at(past.film), min(1.0, pace / past.film)
            x, g, _ = static(old[APPROACH] + 0.5 * own * old[RATE] / old[THETA], before)
            states = np.empty_like(past.states)
            rates = self.lag_rate, self.inlet_rate / slowed, self.fast_rate / slowed
            speed_step(past.states, states, z, own / math.sqrt(g), rates)
            film = film_speed(before, x, states) ** (1.0 / FILM_GROWTH)
        slowed = min(1.0, pace / film)
        old[INLET : FAST + 1] *= past.slowed / slowed
        law = self.law if film == self._rolling else self._law_at(film)
        return _Step(slow_law(law, slowed), own, old, _FilmSpeed(self._speed, pace, film, slowed, states), time)

    def advance(self, dt: float, approach: float, rate: float) -> float:
        """Force at the end of a step `dt` > 0, at approach, rate and speed of that end; moves the state there."""
        u, v = as_float("approach", approach), as_float("rate", rate)
        (f, length, _), step = self._units, self._begin(dt)
        force = float(film_step(step.law, step.old, self._next, step.dt, u / length, v / length * step.time)[0])
        if not math.isfinite(force):
            raise InputError("approach and rate", (u, v), "finite")
        old = self._state
        object.__setattr__(self, "_state", self._next)
        object.__setattr__(self, "_next", old)
        self._keep(step.past)
        self._watch(u, v, force * f)
        return force * f

    def step_tangents(self, dt: float, approach: float, rate: float) -> tuple[float, float, float]:
        """Force, dF/du and dF/du' at the end of a step from the present state, which stays where it is."""
        (f, length, _), step = self._units, self._begin(dt)
        u, v = as_float("approach", approach) / length, as_float("rate", rate) / length * step.time
        force, stiffness, damping = film_step(step.law, step.old, self._next, step.dt, u, v)
        return float(force) * f, float(stiffness) * f / length, float(damping) * f / length * step.time

    def save_state(self) -> object:
        """Copy of the film's state and of the speeds that it was made at."""
        *numbers, states = self._past
        return np.concatenate([self._state, numbers, states])

    def restore_state(self, state: object) -> None:
        """Go back to a saved state; `set_speed` still gives the speed at the end of the next step."""
        size, given = CHAIN + self.lags, np.asarray(state, float)
        self._state[:] = given[:size]
        speed, pace, film, slowed = given[size : size + 4].tolist()
        self._keep(_FilmSpeed(speed, pace, film, slowed, given[size + 4 :].copy()))

    def drive(self, T: ArrayLike, approach: ArrayLike, rate: ArrayLike, u_sum: ArrayLike | None = None) -> _Floats:
        """As of the other elements, at the present speed or at `u_sum`, shape (N,), from rest at its first."""
        if u_sum is None:
            return super().drive(T, approach, rate)
        t = as_column("T", T, increasing=True)
        given = {"approach": approach, "rate": rate, "u_sum": u_sum}
        u, v, speed = (as_column(name, values, size=t.size) for name, values in given.items())
        other = replace(self)
        other.set_speed(float(speed[0]))
        force = np.empty(t.size)
        force[0] = other.rest(float(u[0]))
        other._state[RATE] = other._state[THETA] * v[0] / other._units[1] * other._units[2]
        for k in range(1, t.size):
            other.set_speed(float(speed[k]))
            force[k] = other.advance(t[k] - t[k - 1], u[k], v[k])
        return force


def slow_law(law: FilmLaw, slowed: float) -> FilmLaw:
    """Law for steps in the time of surfaces at `slowed` times the speed of the film in the contact.

    What the film at the inlet resists depends on its thickness, not on the present speed. So dashpot, inlet and
    fast filter stay in the time of the film, and film that the rim makes too; the chain goes with the surfaces.
    """
    if slowed == 1.0:
        return law
    gains = law.gains.copy()
    gains[:, :DIRECT] *= slowed
    return law._replace(
        gains=gains,
        inlet_rate=law.inlet_rate / slowed,
        fast_rate=law.fast_rate / slowed,
        inlet_saturation=law.inlet_saturation * slowed,
        rim=law.rim * slowed,
    )
