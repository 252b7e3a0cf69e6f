"""The validity box on its own, and in simulations; what elements make of it is in the contract tests."""

import json
import pickle
import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ehlcontact import Lubricant, OperatingPoint
from reduced_models import Atlas, OutsideValidityWarning, SpringContact, simulate_oscillator
from reduced_models.elements.validity import Validity


@pytest.fixture
def boxed():
    return SpringContact.linear(1.15, 0.012, 0.75, 1.0, rate=1.0, load_range=(0.8, 1.2), omega_range=(3.0, 6.0))


def test_unknown_bounds_do_not_count(boxed, linear):
    assert linear.is_valid(0.9, 1e9, Omega=1e9) and not linear.is_valid(1.1, 1e9)
    assert boxed.is_valid(0.9, 0.5, Omega=4.0) and not boxed.is_valid(0.9, 1.1)
    assert linear.validity == Validity((0.75, 1.0)) and linear.validity.excess([0.9], [1e9], 1e9, [1e9]) == []


def test_box_round_samples_goes_to_elements_files_and_units(scales):
    box = Validity.of([0.9, 0.8, 1.1], [-3.0, 0.5, 2.0], [0.7, 1.2, 0.9], [4.0, 2.0])
    assert box == Validity((0.8, 1.1), 3.0, (0.7, 1.2), (2.0, 4.0))
    assert SpringContact.linear(1.0, 0.0, **box.fields()).validity == box
    for one in (box, Validity((0.8, 1.1)), box.to_si(scales)):
        assert Validity.from_dict(json.loads(json.dumps(one.to_dict()))) == one
    si = box.to_si(scales)
    assert si.approach == (0.8 * scales.length, 1.1 * scales.length) and si.rate == 3.0 * scales.rate
    assert si.load == (0.7 * scales.force, 1.2 * scales.force)
    assert si.omega == pytest.approx((2.0 / scales.time, 4.0 / scales.time), rel=1e-15)  # rad/s
    said = f"approach 5.2e-06 m (fitted {0.8 * 4e-6:.4g} to {1.1 * 4e-6:.4g} m)"
    assert si.excess([1.3 * scales.length], units="SI") == [said]
    fast, force = 5.0 * scales.rate, 2.0 * scales.force
    rate, load = si.excess(rate=[fast], force=[force], units="SI")
    assert rate == f"rate {fast:.4g} m/s (fitted up to {3.0 * scales.rate:.4g} m/s)"
    assert load == f"force {force:.4g} N (fitted {0.7 * scales.force:.4g} to {1.2 * scales.force:.4g} N)"


def test_control_block_warns(boxed):
    pytest.importorskip("control")
    block = boxed.to_control()
    with pytest.warns(OutsideValidityWarning):
        block.output(0.0, [], [3.0, 0.0])


def test_oscillation_at_another_frequency_warns():
    element = SpringContact.linear(1.0, 0.01, 0.5, 1.5, omega_range=(3.0, 3.0))
    T = np.linspace(0.0, 3.0, 301)
    simulate_oscillator(element, T, Omega_n=4.0, u0=1.1)
    with pytest.warns(OutsideValidityWarning, match=r"Omega .* \(fitted Omega 3\)"):
        simulate_oscillator(element, T, Omega_n=20.0, u0=1.1)


def test_warned_elements_are_still_equal_hashable_and_pickled(boxed):
    with pytest.warns(OutsideValidityWarning):
        boxed.advance(0.1, 9.0, 0.0)
    assert replace(boxed) == boxed and hash(replace(boxed)) == hash(boxed)
    assert pickle.loads(pickle.dumps(boxed)) == boxed


def harmonic(omega, cycles=20, per_cycle=40, amplitude=0.02, mean=0.9):
    """Approach and rate of a vibration, as an integrator gives them one by one."""
    angle = 2.0 * np.pi * np.arange(cycles * per_cycle) / per_cycle
    return mean + amplitude * np.sin(angle), amplitude * omega * np.cos(angle)


def values_of(element, approach, rate):
    for u, v in zip(approach.tolist(), rate.tolist(), strict=True):
        element.force(u, v)


@pytest.fixture
def banded():
    return SpringContact.linear(1.15, 0.012, 0.75, 1.0, omega_range=(3.0, 6.0))


STEPS = {
    "force": lambda element, u, v: element.force(u, v),
    "advance": lambda element, u, v: element.advance(0.1, u, v),
    "state_rates": lambda element, u, v: element.state_rates([], u, v),
}


@pytest.mark.parametrize("omega", [1.2, 14.0])
@pytest.mark.parametrize("step", STEPS)
def test_frequency_in_a_loop_of_the_reader(banded, step, omega):
    """It is that of the motion within the sampling, and is warned of once."""
    u, v = harmonic(omega)
    with pytest.warns(OutsideValidityWarning, match=r"\(fitted Omega 3 to 6\); it is for the band") as said:
        for pair in zip(u.tolist(), v.tolist(), strict=True):
            STEPS[step](banded, *pair)
    assert len(said) == 1 and said[0].filename == __file__
    assert float(re.search(r"Omega ([\d.]+)", str(said[0].message))[1]) == pytest.approx(omega, rel=0.01)


def test_a_cubic_fitted_at_13_khz_and_used_at_1_khz():
    """Its damper is six times too small there; scipy's own integrator drives it, in SI."""
    oil = Lubricant(eta0=0.037, alpha=2.0e-8)
    point = OperatingPoint.ball_bearing(
        oil, ball_diameter=7.94e-3, pitch_diameter=39.04e-3, conformity=0.52, speed_rpm=3000, load=486
    )
    element, slow = Atlas().element(point, "cubic", hz=13e3), Atlas().element(point, "cubic", hz=1e3)
    assert 5.0 < slow.C1 / element.C1 < 7.0
    rest = element.approach_at(486.0)
    stiffness = element.spring_tangent(rest)

    def moved(hz):
        mass, driven = stiffness / (2.0 * np.pi * hz) ** 2, element.copy()

        def rates(t, y):
            return [y[1], (486.0 - driven.force(float(y[0]), float(y[1]))) / mass]

        solve_ivp(rates, (0.0, 30.0 / hz), [0.99 * rest, 0.0], rtol=1e-6, atol=1e-12)

    moved(13e3)  # in its band: no warning, which would be an error
    with pytest.warns(OutsideValidityWarning, match=r"9\d\d(\.\d)? Hz|10\d\d Hz"):
        moved(1e3)


def quiet():
    """Motions without a frequency outside the band: name, approach, rate."""
    rng = np.random.default_rng(1)
    u, v = harmonic(4.0)
    yield "in the band", u, v
    yield "eight cycles", *(values[: 8 * 40 - 20] for values in harmonic(1.0))
    yield "an octave aside", *harmonic(11.0)
    drift = np.linspace(-0.05, 0.05, u.size)
    yield "drift and vibration", u + drift, v + np.ptp(drift) / (20 * 2.0 * np.pi / 4.0)
    yield "noise", u, v + 0.01 * np.ptp(v) * rng.normal(size=v.size)
    yield "at rest, rounded", 0.9 + 1e-15 * rng.normal(size=500), 1e-12 * rng.normal(size=500)
    yield "ramp", np.linspace(0.75, 1.0, 500), np.full(500, 1e-3)
    grid = np.meshgrid(np.linspace(0.76, 0.99, 40), np.linspace(-1.0, 1.0, 20))
    yield "table of rates", grid[0].T.ravel(), grid[1].T.ravel()
    yield "table of approaches", grid[0].ravel(), grid[1].ravel()


@pytest.mark.parametrize(("name", "approach", "rate"), list(quiet()))
def test_no_frequency_where_there_is_none(banded, name, approach, rate):
    """A warning is an error in these tests."""
    values_of(banded, approach, rate)


def test_the_larger_of_two_frequencies_counts(banded):
    """Slow motion with a fast one of 0.3 of its rate on top; the fast one is in the band."""
    slow, fast = harmonic(0.05, 20, 8000, 0.1), harmonic(5.0, 2000, 80, 0.0003, 0.0)
    with pytest.warns(OutsideValidityWarning, match=r"Omega 0\.0\d+ \("):
        values_of(banded, slow[0] + fast[0], slow[1] + fast[1])
