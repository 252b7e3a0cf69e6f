"""Film laws over the speed, and the speed at which the film in a contact was made while that changes.

Films of different speeds are in a contact at the same time: that at the inlet is of the present speed, that on its
way through the contact of earlier ones. A static film grows as U^p, p = `FILM_GROWTH`, so the mean film in the
contact is that of the speed V with

    V^p = (c z + g_i s + g_f y + sum_k g_k q_k)/(c + g_i + g_f + sum_k g_k),    z = U^p,

where s, y and q_k are the filters of `film_law`, with z as their input in the place of the own rate (and without
saturation), and the gains are those of the film memory: the film of a past speed is forgotten as that of a past
motion is. All states are z at constant speed, and V = U then.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.jit import jit_exact
from reduced_models.elements.film_filters import (
    DIRECT,
    FAST,
    INLET,
    chain_moments,
    lag_moments,
    pass_on,
    poisson_shares,
)
from reduced_models.elements.film_law import APPROACH, RATE, THETA, FilmLaw, interval, static

_Floats = NDArray[np.float64]

STANDSTILL = 1e-6  # of the lowest speed of the tables: as good as none, and keeps steps from a division by 0
FILM_GROWTH = 0.67  # of films with speed (Hamrock and Dowson 1977)
NOW, SLOW_INLET, QUICK, AGES = range(4)  # entries of the state of a film's speed: z, s, y, and the chain


@jit_exact
def _lag(old, start, end, rate, span):
    """One lag at the end of a step whose input goes straight from `start` to `end`."""
    kept, r0, r1, _ = lag_moments(rate * span, 3.0)
    return old * kept + start * r1 + end * (r0 - r1)


@jit_exact
def speed_step(old, new, z, span, rates):
    """Advance the state `old` into `new` while the input goes straight to `z`.

    `span` is the length of the step in own time; `rates` are those of chain, inlet and fast filter.
    """
    lags, start = old.size - AGES, old[NOW]
    lag_rate, inlet_rate, fast_rate = rates
    s = _lag(old[SLOW_INLET], start, z, inlet_rate, span)
    new[NOW], new[SLOW_INLET], new[QUICK] = z, s, _lag(old[QUICK], start, z, fast_rate, span)
    # into the chain goes s: its ends, and a bump that keeps its mean
    mean = 0.5 * (start + z) - (s - old[SLOW_INLET]) / (inlet_rate * span)
    bump = mean - 0.5 * (old[SLOW_INLET] + s)
    mu = lag_rate * span
    poisson, share = np.empty(lags + 3), np.empty(lags + 3)
    poisson_shares(mu, lags + 2, lags + 2.0, poisson, share)
    new[AGES:] = 0.0
    pass_on(old[AGES:], poisson, new[AGES:])
    for j in range(1, lags + 1):
        r0, r1, r2 = chain_moments(j, 1.0 / mu, share)
        new[AGES + j - 1] += old[SLOW_INLET] * r1 + s * (r0 - r1) + 6.0 * bump * (r1 - r2)


@jit_exact
def film_speed(law, x, state):
    """V^p of a state, with the gains of `law` at x = ln F."""
    last = law.gain_x.size - 2
    row = min(max(interval(law.gain_x, x), 0), max(last, 0))
    weight = 0.0
    if last >= 0:
        weight = min(max((x - law.gain_x[row]) / (law.gain_x[row + 1] - law.gain_x[row]), 0.0), 1.0)
    total, gains = 0.0, 0.0
    for k in range(state.size):
        gain = law.gains[row, k]
        if weight > 0.0:
            gain += weight * (law.gains[row + 1, k] - gain)
        total += gain * state[k]
        gains += gain
    return total / gains


class SpeedHistory(NamedTuple):
    """Speeds of the surfaces that the film in the contact was made at."""

    speed: float  # at the end of the last step
    pace: float  # mean of the last step, in whose time the rate of the state is
    film: float  # V
    slowed: float  # pace over V, at most 1
    states: _Floats  # filters of z

    @classmethod
    def constant(cls, speed: float, moving: float, lags: int) -> SpeedHistory:
        """Surfaces that have always been at this speed; `moving` as `SpeedRange.moving` of it."""
        return cls(speed, moving, moving, 1.0, np.full(AGES + lags, moving**FILM_GROWTH))


class SpeedStep(NamedTuple):
    """A step about to be made: its law, length and start in the time of its mean speed."""

    law: FilmLaw
    dt: float
    old: _Floats
    history: SpeedHistory  # at its end
    time: float  # that unit of time, in the units of the element


class SpeedRange(NamedTuple):
    """Film laws over the speed of the surfaces, which is over that of the reference."""

    speeds: tuple[float, ...]
    laws: tuple[FilmLaw, ...]

    def moving(self, speed: float) -> float:
        """Magnitude of a speed; that which stands for 0 at standstill."""
        return max(abs(speed), STANDSTILL * self.speeds[0])

    def at(self, speed: float) -> FilmLaw:
        """Law at a constant speed > 0.

        Between the speeds of the tables ln h_s is linear in ln U, gains are linear in U^0.67; below the lowest
        both fall as U^0.67.
        """
        k = min(max(bisect_left(self.speeds, speed) - 1, 0), len(self.speeds) - 2)
        (low, high), a, b = self.speeds[k : k + 2], self.laws[k], self.laws[k + 1]
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

    def begin(
        self, state: _Floats, history: SpeedHistory, speed: float, law: FilmLaw, dt: float, unit: float
    ) -> SpeedStep:
        """The next step from a state, to a speed at its end, whose law is `law`.

        `dt` and `unit`, that of time at the reference speed, are in the units of the element.
        """
        rolling, pace = self.moving(speed), self.moving(0.5 * (abs(history.speed) + abs(speed)))
        time = unit / pace
        own, old, z = dt / time, state.copy(), rolling**FILM_GROWTH
        old[RATE] *= history.pace / pace
        film, states = rolling, history.states
        if np.any(states != z):
            before, slowed = self.at(history.film), min(1.0, pace / history.film)
            x, g, _ = static(old[APPROACH] + 0.5 * own * old[RATE] / old[THETA], before)
            states = np.empty_like(history.states)
            rates = before.lag_rate, before.inlet_rate / slowed, before.fast_rate / slowed
            speed_step(history.states, states, z, own / math.sqrt(g), rates)
            film = film_speed(before, x, states) ** (1.0 / FILM_GROWTH)
        slowed = min(1.0, pace / film)
        old[INLET : FAST + 1] *= history.slowed / slowed
        law = slow_law(law if film == rolling else self.at(film), slowed)
        return SpeedStep(law, own, old, SpeedHistory(speed, pace, film, slowed, states), time)


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
