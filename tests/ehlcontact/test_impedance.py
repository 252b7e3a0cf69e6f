"""Linearised contact: against a full solve at one frequency, and against the motion in time."""

from math import pi

import numpy as np
import pytest

from ehlcontact import InputError, MoesPoint
from ehlcontact.full_contact import FullContact
from ehlcontact.impedance import LinearisedContact, impedance
from ehlcontact.steady import solve_steady

POINT = MoesPoint(200, 10, 0.5)


def test_reduced_space_equals_the_complex_solve(steady):
    film = steady(200, 10, 0.5, 48)
    system = LinearisedContact.at(POINT, film.domain, 48, film.P, film.approach)
    omega = np.array([0.0, 0.25, pi, 4.0 * pi, 30.0])
    result = impedance(POINT, omega, n=48)
    for k, w in enumerate(omega):
        dP = np.linalg.solve(system.J + 1j * w * system.B, -(system.j + 1j * w * system.b))
        exact = system.weights @ dP
        assert result.impedance[k].real == pytest.approx(exact.real, rel=1e-3)
        if w > 0.0:
            assert result.damping[k] == pytest.approx(exact.imag / w, rel=3e-3)


def test_static_stiffness_is_the_slope_of_the_load_curve():
    u = solve_steady(POINT, n=48, tol=1e-7).approach
    h = 2e-3
    force = [solve_steady(POINT, n=48, approach=u + s * h, tol=1e-7).force for s in (-1, 1)]
    assert impedance(POINT, [0.0], n=48).stiffness[0] == pytest.approx((force[1] - force[0]) / (2 * h), rel=2e-3)


def test_agrees_with_small_motion_in_time():
    """A small harmonic approach on the full contact, last period of four, first harmonic of the force."""
    omega, amplitude, steps = pi, 2e-3, 80
    contact = FullContact(POINT, n=32, tol=1e-6)
    T = 2.0 * pi / omega * np.arange(1, 3 * steps + 1) / steps
    force = np.array([contact.advance(T[0], contact.static_approach + amplitude * np.sin(omega * t)) for t in T])
    last = slice(2 * steps, 3 * steps)
    c = 2.0 / steps / amplitude
    K = c * np.sum(force[last] * np.sin(omega * T[last]))
    C = c * np.sum(force[last] * np.cos(omega * T[last])) / omega
    result = impedance(POINT, [omega], n=32)
    assert result.stiffness[0] == pytest.approx(K, rel=5e-3)
    assert result.damping[0] == pytest.approx(C, rel=0.05)


@pytest.mark.parametrize("omegas", [[], [-1.0], [float("nan")], [float("inf")], [201.0], ["fast"], [[1.0]]])
def test_bad_frequencies_are_named(omegas):
    with pytest.raises(InputError, match=r"^omegas = .*: must be "):
        impedance(POINT, omegas, n=32)


def test_too_fine_a_grid_is_refused():
    with pytest.raises(InputError, match=r"^n = 144"):
        impedance(POINT, [1.0], n=144)
