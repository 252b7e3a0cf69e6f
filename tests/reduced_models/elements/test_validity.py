"""The validity box on its own, and in simulations; what elements make of it is in the contract tests."""

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

from reduced_models import OutsideValidityWarning, SpringContact, simulate_oscillator
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
