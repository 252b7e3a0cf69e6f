"""Duffing's oscillator as a rotor between two cubic contacts that press against each other.

m x'' + c x' + k x + k3 x^3 = f cos(w t), with k = 2 K1 + 6 K3 u0^2 and k3 = 2 K3 of contacts at the approach u0.
"""

import numpy as np
from scipy.integrate import solve_ivp

from reduced_models import ContactMount, Rotor, SpringContact

K1, K3, U0 = 1e6, 1e16, 1e-5
MASS, DAMPING = 1.0, 20.0
LINEAR, CUBIC = 2.0 * K1 + 6.0 * K3 * U0**2, 2.0 * K3
NATURAL = (LINEAR / MASS) ** 0.5  # rad/s


def rotor():
    """Of one degree of freedom."""
    contacts = [SpringContact.cubic(K1, 0.0, K3, 0.0, low=1e-7, high=1e-4, units="SI") for _ in range(2)]
    mounts = tuple(
        ContactMount(angle=angle, offset=U0, contact=contact, x=0)
        for angle, contact in zip((0.0, np.pi), contacts, strict=True)
    )
    return Rotor(mass=[[MASS]], stiffness=[[0.0]], damping=[[DAMPING]], mounts=mounts)


def answer(w, force, start):
    """Periodic answer near a start (x, x'): its state at t = 0, monodromy matrix, and displacements."""

    def rates(t, y):
        x, v = y[:2]
        by = np.array([[0.0, 1.0], [-(LINEAR + 3.0 * CUBIC * x * x) / MASS, -DAMPING / MASS]])
        pull = force * np.cos(w * t) - DAMPING * v - LINEAR * x - CUBIC * x**3
        return np.concatenate([[v, pull / MASS], (by @ y[2:].reshape(2, 2)).ravel()])

    state, period = np.array(start), 2.0 * np.pi / w
    for _ in range(20):
        first = np.concatenate([state, np.eye(2).ravel()])
        run = solve_ivp(
            rates, (0.0, period), first, rtol=1e-10, atol=1e-17, method="DOP853", max_step=period / 100.0
        )
        monodromy, off = run.y[2:, -1].reshape(2, 2), run.y[:2, -1] - state
        state = state + np.linalg.solve(np.eye(2) - monodromy, off)
        if np.abs(off).max() <= 1e-9 * np.abs(state).max():
            break
    return state, monodromy, run.y[0]
