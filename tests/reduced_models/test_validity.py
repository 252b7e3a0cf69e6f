"""The validity box: what it says, and that leaving it is told once, by simulations only."""

import pickle
import warnings
from dataclasses import replace

import numpy as np
import pytest

from ehlcontact.errors import InputError
from reduced_models import LinearContact, OutsideValidityWarning, simulate_oscillator


@pytest.fixture
def boxed():
    return LinearContact(1.15, 0.012, 0.75, 1.0, rate=1.0, load_range=(0.8, 1.2), omega_range=(3.0, 6.0))


def test_is_valid_looks_at_every_bound_that_is_known(boxed, linear):
    assert boxed.is_valid(0.9, 0.5, omega=4.0)
    assert (
        not boxed.is_valid(0.9, 1.1) and not boxed.is_valid(1.1, 0.5) and not boxed.is_valid(0.9, 0.5, omega=7.0)
    )
    assert linear.is_valid(0.9, 1e9, omega=1e9)
    np.testing.assert_array_equal(boxed.is_valid([0.7, 0.8, 0.8], [0.0, -0.5, -2.0]), [False, True, False])


@pytest.mark.parametrize(
    ("approach", "rate", "words"),
    [(1.2, 0.0, r"approach 1\.2 \(fitted 0\.75 to 1\)"), (0.9, -3.0, r"rate 3 \(fitted up to 1\)")],
)
def test_a_step_outside_warns_once_per_element(boxed, approach, rate, words):
    with pytest.warns(OutsideValidityWarning, match=words) as told:
        for _ in range(3):
            boxed.advance(0.1, approach, rate)
    assert len(told) == 1
    with pytest.warns(OutsideValidityWarning):  # another element, its own warning
        replace(boxed).advance(0.1, approach, rate)


def test_steps_inside_and_questions_anywhere_say_nothing(boxed):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        boxed.advance(0.1, 0.75, -1.0)
        boxed.advance(0.1, 1.01, 1.04)  # within the margin
        boxed.force(5.0, 0.0), boxed.stiffness(0.1, 9.0), boxed.approach_at(9.0)
        boxed.force(np.linspace(0, 5, 9), 0.0)


def test_control_block_warns(boxed):
    pytest.importorskip("control")
    block = boxed.to_control()
    with pytest.warns(OutsideValidityWarning):
        block.output(0.0, [], [3.0, 0.0])


def test_oscillation_at_another_frequency_is_told():
    element = LinearContact(1.0, 0.01, 0.5, 1.5, omega_range=(3.0, 3.0))
    T = np.linspace(0.0, 3.0, 301)
    simulate_oscillator(element, T, omega_n=4.0, u0=1.1)
    with pytest.warns(OutsideValidityWarning, match=r"angular frequency .* \(fitted 3 to 3\)"):
        simulate_oscillator(element, T, omega_n=20.0, u0=1.1)


def test_warned_elements_are_still_equal_hashable_and_pickled(boxed):
    with pytest.warns(OutsideValidityWarning):
        boxed.advance(0.1, 9.0, 0.0)
    assert replace(boxed) == boxed and hash(replace(boxed)) == hash(boxed)
    assert pickle.loads(pickle.dumps(boxed)) == boxed


@pytest.mark.parametrize("name", ["load_range", "omega_range"])
@pytest.mark.parametrize("bad", [3.0, (1.0,), (2.0, 1.0), (0.0, np.nan)])
def test_bad_bounds_are_named(name, bad):
    with pytest.raises(InputError) as caught:
        LinearContact(1.0, 0.0, 0.5, 1.0, **{name: bad})
    assert caught.value.field == name
