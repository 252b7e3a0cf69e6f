"""Slow, obvious twins of the compiled bearing: matrix exponentials for filters, scipy's roots for balls."""

from math import cos, pi, sin, sqrt

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from reduced_models.elements.film_filters import DIRECT
from reduced_models.elements.film_law import static


def lags_after(held, rate, start, mean, end, span):
    """A chain of equal lags after an input from `start` to `end`, quadratic, with that mean."""
    n = len(held)
    bow = 6.0 * (mean - 0.5 * (start + end))
    # the input is a + b t + c t^2 of t = time over span; its powers are states too
    A = np.zeros((n + 3, n + 3))
    for k in range(n):
        A[k, k] = -rate
        if k:
            A[k, k - 1] = rate
    A[0, n:] = rate * np.array([start, end - start + bow, -bow])
    A[n + 1, n], A[n + 2, n + 1] = 1.0 / span, 2.0 / span
    state = np.concatenate([held, [1.0, 0.0, 0.0]])
    return (expm(A * span) @ state)[:n]


class SlowContact:
    """One contact with memory in SI, from the element alone; `law` only lends the fade of unloaded films."""

    def __init__(self, element, cutoff_gap=np.inf):
        self.law, self.scales, self.cutoff_gap = element.law, element.scales, cutoff_gap
        self.u = self.v = self.own = self.s = self.y = self.entered = 0.0
        self.q = np.zeros(element.lags)

    def g(self, u):
        x, g, _ = static(u / self.scales.length, self.law)
        return x, g * self.scales.length

    def tau(self, g):
        return self.scales.time * sqrt(g / self.scales.length)

    def rest(self, u):
        self.u, self.v, self.own, self.s, self.y, self.entered = u, 0.0, 0.0, 0.0, 0.0, 0.0
        self.q[:] = 0.0

    def spring(self, u):
        return self._force(self.g(u)[1], u)

    def _force(self, w, u):
        t = min(max(-2.0 * u / self.cutoff_gap - 1.0, 0.0), 1.0)
        force = self.scales.force * (w / self.scales.length) ** 1.5 if w > 0.0 else 0.0
        return force * (1.0 - t * t * (3.0 - 2.0 * t))

    def step(self, dt, u, v):
        """Force at the end of the step, and the state there."""
        law = self.law
        x, g = self.g(u)
        x_middle, middle = self.g(self.u + 0.5 * dt * self.v)
        span = dt / self.tau(middle)
        end, mean = self.tau(g) * v, (u - self.u) / span
        s = lags_after([self.s], law.inlet_rate, self.own, mean, end, span)[0]
        y = lags_after([self.y], law.fast_rate, self.own, mean, end, span)[0]
        gains, at_middle = (
            np.array([np.interp(place, law.gain_x, column) for column in law.gains.T]) for place in (x, x_middle)
        )
        made = np.abs(gains[DIRECT:]).sum()
        entered = made * s
        between = np.abs(at_middle[DIRECT:]).sum() * (mean - (s - self.s) / (law.inlet_rate * span))
        q = lags_after(self.q, law.lag_rate, self.entered, between, entered, span)
        m = gains[0] * end + gains[1] * s + gains[2] * y + gains[DIRECT:] @ q / made
        return self._force(g + m, u), (u, v, end, s, y, q, entered)

    def accept(self, state):
        self.u, self.v, self.own, self.s, self.y, self.q, self.entered = state


class SlowElement:
    """A reduced element of the library behind the same face."""

    def __init__(self, element):
        self.element = element.copy()

    def rest(self, u):
        self.element.rest(u)

    def spring(self, u):
        return self.element.spring(u)

    def step(self, dt, u, v):
        return self.element.step_tangents(dt, u, v)[0], (dt, u, v)

    def accept(self, state):
        self.element.advance(*state)


class SlowBearing:
    """Balls between two such contacts each."""

    def __init__(self, bearing, speed_rpm, make, cage_angle=-pi / 2.0):
        self.bearing, self.angle = bearing, cage_angle
        omega = speed_rpm * pi / 30.0
        gamma = bearing.ball_diameter / bearing.pitch_diameter
        self.cage = 0.5 * omega * (1.0 - gamma)
        mass = bearing.density * pi / 6.0 * bearing.ball_diameter**3
        self.centrifugal = mass * 0.5 * bearing.pitch_diameter * self.cage**2
        self.contacts = [
            [make(bearing.element(race, speed_rpm)) for race in ("inner", "outer")] for _ in self.balls
        ]
        self.w = np.zeros((len(self.contacts), 2))

    def pair(self, make, speed_rpm):
        return [make(self.bearing.element(race, speed_rpm)) for race in ("inner", "outer")]

    @property
    def balls(self):
        return range(self.bearing.balls)

    def normals(self, turned=0.0):
        psi = [self.angle + turned + 2.0 * pi * k / self.bearing.balls for k in self.balls]
        return np.array([[cos(a), sin(a)] for a in psi])

    def rest(self, q):
        normals, forces = self.normals(), []
        for k, (inner, outer) in enumerate(self.contacts):
            delta = normals[k] @ q - 0.5 * self.bearing.clearance

            def balance(w, inner=inner, outer=outer, delta=delta):
                return outer.spring(w) - inner.spring(delta - w) - self.centrifugal

            w = brentq(balance, -3e-4, 3e-4, xtol=1e-18, rtol=1e-14)
            inner.rest(delta - w)
            outer.rest(w)
            self.w[k] = w
            forces.append((inner.spring(delta - w), outer.spring(w)))
        return np.array(forces), normals.T @ np.array(forces)[:, 0]

    def step(self, dt, q, v):
        """Forces on the balls at the end of the step; accepts it."""
        normals, forces = self.normals(self.cage * dt), []
        for k, (inner, outer) in enumerate(self.contacts):
            n, across = normals[k], np.array([-normals[k][1], normals[k][0]])
            delta = n @ q - 0.5 * self.bearing.clearance
            rate = n @ v + self.cage * (across @ q)
            now, before = self.w[k]

            def both(w, inner=inner, outer=outer, delta=delta, rate=rate, now=now, before=before):
                own = (1.5 * w - 2.0 * now + 0.5 * before) / dt
                return inner.step(dt, delta - w, rate - own), outer.step(dt, w, own)

            def balance(w, both=both):
                (fi, _), (fo, _) = both(w)
                return fo - fi - self.centrifugal

            w = brentq(balance, now - 3e-6, now + 3e-6, xtol=1e-18, rtol=1e-14)
            (fi, inner_state), (fo, outer_state) = both(w)
            inner.accept(inner_state)
            outer.accept(outer_state)
            self.w[k] = w, now
            forces.append((fi, fo))
        self.angle += self.cage * dt
        return np.array(forces), normals.T @ np.array(forces)[:, 0]
