"""A mass on a bearing in one run, and the decay of its vibration: what a mass on the bearing's FMU is to have."""

import numpy as np

from fmu.bearing.trial import START
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

FINE = 4e-6  # s


def trapezoidal(model, mass, load, dt, steps, v):
    """Heights of a mass on the bearing in Python, by the trapezoidal rule and Newton's method."""
    motion, q, v = model.motion(), model.place.copy(), np.array([0.0, v])
    omega, pull = float(model.speeds[-1]) * RPM_TO_RAD_S, np.array([0.0, -load])
    a = (pull - motion.rest(omega, START, q)) / mass
    kept = [q[1]]
    for _ in range(steps):
        motion.begin(omega, dt)
        q1 = q + dt * (v + 0.5 * dt * a)
        for _ in range(20):
            v1 = 2.0 / dt * (q1 - q) - v
            a1 = 2.0 / dt * (v1 - v) - a
            force, stiffness, damping = motion.forces(q1, v1)
            left = mass * a1 + force - pull
            by = np.linalg.solve(4.0 * mass / dt**2 * np.eye(2) + stiffness + 2.0 / dt * damping, left)
            q1 = q1 - by
            if np.abs(by).max() < 1e-16:
                break
        v1 = 2.0 / dt * (q1 - q) - v
        a1 = 2.0 / dt * (v1 - v) - a
        motion.forces(q1, v1)
        motion.accept()
        q, v, a = q1, v1, a1
        kept.append(q[1])
    return np.array(kept)


def decay(heights, dt):
    """Decay [1/s] and frequency [Hz] of a vibration."""
    from scipy.optimize import least_squares

    t, y = dt * np.arange(heights.size), heights / np.abs(heights).max()
    spectrum = np.abs(np.fft.rfft(y, 8 * y.size))
    hz = np.fft.rfftfreq(8 * y.size, dt)[spectrum.argmax()]

    def off(p):
        return p[0] * np.exp(-p[1] * t) * np.sin(p[2] * t + p[3]) - y

    found = least_squares(off, [1.0, 20.0, 2.0 * np.pi * hz, 0.0]).x
    return found[1], found[2] / (2.0 * np.pi)


def in_one_run(model, mass, load, until, kick):
    """Decay and frequency of half the difference of two runs, kicked up and down."""
    runs = [trapezoidal(model, mass, load, FINE, round(until / FINE), v) for v in (kick, -kick)]
    return decay(runs[0] - runs[1], FINE)
