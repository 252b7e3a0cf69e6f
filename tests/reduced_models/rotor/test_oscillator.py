"""One mass on an element: exact linear solution, energy, no inertia, units, failure."""

import numpy as np
import pytest

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models import OutsideValidityWarning, SpringContact, simulate_oscillator
from reduced_models.elements.spring_law import O_LOW

T = np.linspace(0.0, 2.0, 101)


@pytest.fixture
def wide():
    """Linear within any motion of these tests."""
    return SpringContact.linear(K1=1.5, C1=0.05, low=0.01, high=5.0)


def free_vibration(times):
    omega_n, k, c, u0, load = 5.13, 1.5, 0.05, 0.8, 1.0
    wn, delta = omega_n * np.sqrt(k), 0.5 * c * omega_n**2
    wd, rest = np.sqrt(wn**2 - delta**2), load / k
    a = u0 - rest
    return rest + np.exp(-delta * times) * a * (np.cos(wd * times) + delta / wd * np.sin(wd * times))


@pytest.mark.parametrize(
    ("method", "rtol", "error"), [("Radau", 1e-9, 1e-8), ("DOP853", 1e-10, 1e-9), ("RK23", 1e-6, 1e-4)]
)
def test_linear_motion_is_the_textbook_one(wide, method, rtol, error):
    result = simulate_oscillator(wide, T, Omega_n=5.13, u0=0.8, method=method, rtol=rtol)
    exact = free_vibration(T)
    assert np.abs(result.approach - exact).max() < error
    np.testing.assert_allclose(result.force, 1.5 * result.approach + 0.05 * result.rate, rtol=1e-13)
    assert result.status == "converged"


def test_energy_lost_is_the_work_of_the_damper(cubic):
    times = np.linspace(0.0, 1.5, 3001)
    r = simulate_oscillator(cubic, times, Omega_n=5.13, u0=0.93)
    grid = np.linspace(0.0, 1.2, 400_001)
    potential = np.interp(r.approach, grid, np.cumsum(np.asarray(cubic.spring(grid))) * (grid[1] - grid[0]))
    energy = 0.5 * r.rate**2 / 5.13**2 + potential - r.approach
    lost = np.trapezoid(np.asarray(cubic.damper(r.approach)) * r.rate**2, times)
    assert energy[0] - energy[-1] == pytest.approx(lost, rel=2e-3) and lost > 1e-4


def test_without_inertia_the_force_is_the_load(cubic):
    def load(time):
        return 1.0 + 0.1 * np.sin(2 * np.pi * time)

    r = simulate_oscillator(cubic, T, Omega_n=None, load=load, u0=0.87)
    np.testing.assert_allclose(r.force, load(T), rtol=1e-12)
    # Against the same equation at a very light mass.
    light = simulate_oscillator(cubic, T, Omega_n=400.0, load=load, u0=0.87, v0=r.rate[0])
    assert np.abs(light.approach - r.approach).max() < 1e-4


def test_polynomial_without_inertia_meets_the_load_at_every_rate(cubic):
    terms = {"C2": 0.004, "C3": -0.001, "B4": 0.002} | cubic.parameters
    element = SpringContact.polynomial(**terms, low=0.75, high=1.0, rate=1.5)
    r = simulate_oscillator(
        element, T, Omega_n=None, load=lambda t: 1.0 + 0.1 * np.sin(2 * np.pi * t), u0=0.87, method="RK23"
    )
    np.testing.assert_allclose(r.force, r.load, rtol=1e-12)
    assert np.abs(r.rate).max() > 0.3


def test_linear_without_inertia_is_a_first_order_lag(wide):
    r = simulate_oscillator(wide, T, Omega_n=None, load=1.2, u0=0.5)
    exact = 0.8 + (0.5 - 0.8) * np.exp(-1.5 / 0.05 * T)
    np.testing.assert_allclose(r.approach, exact, atol=1e-8)


def test_load_as_array_is_straight_between_samples(wide):
    ramp = 1.0 + 0.2 * T
    by_array = simulate_oscillator(wide, T, Omega_n=3.0, load=ramp, u0=0.6)
    by_function = simulate_oscillator(wide, T, Omega_n=3.0, load=lambda time: 1.0 + 0.2 * time, u0=0.6)
    np.testing.assert_allclose(by_array.approach, by_function.approach, atol=1e-8)
    np.testing.assert_allclose(by_array.load, ramp, rtol=1e-14)


def test_si_motion_is_the_scaled_one(cubic, scales):
    s = scales
    r = simulate_oscillator(cubic, T, Omega_n=5.13, u0=0.95)
    mass = s.force * s.time**2 / (s.length * 5.13**2)
    si = simulate_oscillator(cubic.to_si(s), T * s.time, mass=mass, load=s.force, u0=0.95 * s.length)
    np.testing.assert_allclose(si.approach / s.length, r.approach, atol=1e-7)
    np.testing.assert_allclose(si.force / s.force, r.force, atol=1e-6)
    with pytest.raises(InputError, match=r"^Omega_n = 5.0: must be left out with an element in SI: give its mass"):
        simulate_oscillator(cubic.to_si(s), T, Omega_n=5.0, u0=1e-6)
    with pytest.raises(InputError, match=r"^mass = 5.0: must be left out with a dimensionless element: give Om"):
        simulate_oscillator(cubic, T, mass=5.0, u0=0.9)
    with pytest.raises(InputError, match=r"^omega_n = 5.0: must be given as Omega_n"):
        simulate_oscillator(cubic, T, omega_n=5.0, u0=0.9)


def test_mass_that_leaves_the_contact_flies_and_comes_back(cubic):
    times = np.linspace(0.0, 3.0, 601)
    with pytest.warns(OutsideValidityWarning, match=r"approach -1\.8.* \(fitted 0\.75 to 1\)"):
        r = simulate_oscillator(cubic, times, Omega_n=5.13, u0=2.5)
    assert r.force.min() == 0.0 and r.approach.min() < cubic.law[O_LOW] and r.force[-1] >= 0.0
    flying = r.force == 0.0
    np.testing.assert_allclose(np.diff(r.rate, 2)[flying[:-2] & flying[2:]], 0.0, atol=1e-6)


class BlowsUp(SpringContact):
    """Pushes outwards with the square of the approach."""

    def continuous(self, states, approach, rate):
        return -(approach**2), states

    def stiffness(self, approach, rate):
        return -2.0 * np.asarray(approach)

    def damping(self, approach, rate):
        return 0.0 * np.asarray(approach)


def test_broken_integration_keeps_what_it_reached():
    element = BlowsUp.linear(1.0, 0.1, 0.1, 1.0)
    with pytest.raises(ConvergenceError, match="broke off at T") as caught:
        simulate_oscillator(element, np.linspace(0, 20, 201), Omega_n=2.0, u0=1.0, rtol=1e-6)
    partial = caught.value.result
    assert partial.status == "failed" and 2 < partial.T.size < 201 and np.all(np.isfinite(partial.approach))


@pytest.mark.parametrize(
    "changes",
    [
        {"T": [0.0]},
        {"T": [0.0, 0.0, 1.0]},
        {"T": [[0.0, 1.0]]},
        {"Omega_n": 0.0},
        {"u0": np.nan},
        {"v0": np.inf},
        {"load": np.nan},
        {"load": [1.0, 1.0]},
        {"load": lambda time: np.nan},
        {"method": "Euler"},
        {"rtol": 0.0},
        {"Omega_n": None, "load": -1.0},
        {"Omega_n": None, "u0": -5.0},
    ],
)
def test_bad_inputs(cubic, changes):
    arguments = {"T": T, "Omega_n": 5.0, "u0": 0.9} | changes
    with pytest.raises(InputError):
        simulate_oscillator(cubic, arguments.pop("T"), **arguments)
