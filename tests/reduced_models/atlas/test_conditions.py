"""Answers and elements of the atlas under other conditions: factors, and differences of C."""

import numpy as np
import pytest

from ehlcontact import MoesPoint
from reduced_models.atlas import atlas as module
from reduced_models.atlas.atlas import Atlas
from reduced_models.atlas.conditions import Change, Condition, Rows, under
from reduced_models.atlas.film import HEAD, LOW, OMEGAS
from reduced_models.atlas.gain_fit import heated_gains

POINT = MoesPoint(300.0, 12.0, 0.2)
FADING = 1.0 / (1.0 + np.square(OMEGAS))


class Thinner(Condition):
    """Films times a factor, and a filter less in the impedance: less damping, and less stiffness with it."""

    name = "thinner"

    def __init__(self, film, less, error=0.0):
        self.film, self.less, self.error = film, less, error

    def change(self, loads, values, Omega, isothermal):
        """Change of these answers."""
        rows, k = np.ones_like(values), Omega.size
        rows[:, :LOW] = self.film
        rows[:, LOW] = -self.less * FADING[1]
        rows[:, HEAD + k :] = -self.less * FADING[:k]
        lost = self.less * values[:, [LOW]] * (1.0 - FADING[:k])
        rows[:, HEAD : HEAD + k] -= lost / values[:, HEAD : HEAD + k]
        return Change(rows, np.full_like(rows, self.error))

    def gains(self, gains, low, rates, before, after):
        """Gains as with heat."""
        rows = zip(before.impedance, after.impedance, np.maximum(gains, 0.0), low.tolist(), strict=True)
        return np.array([heated_gains(after.Omega, cold, hot, g, rates, unit) for cold, hot, g, unit in rows])

    def noted(self, flooded):
        """Nothing."""
        return {}

    def to_dict(self):
        """Inputs."""
        return {"film": self.film}


@pytest.fixture
def given(monkeypatch):
    """Puts the atlas under conditions, whatever its arguments are."""
    return lambda *those: monkeypatch.setattr(module, "conditions_at", lambda *_: list(those))


def test_factors_and_differences(given):
    flooded = Atlas().at(POINT)
    given(Thinner(0.8, 0.3))
    found = Atlas().at(POINT)
    assert found.h_central == pytest.approx(0.8 * flooded.h_central, rel=1e-14)
    assert found.h_min == pytest.approx(0.8 * flooded.h_min, rel=1e-14)
    assert found.separation == pytest.approx(0.8 * flooded.separation, rel=1e-12)
    low = flooded.damping[1]
    np.testing.assert_allclose(found.damping, flooded.damping - 0.3 * low * FADING, rtol=0, atol=1e-12 * low)
    assert found.stiffness[0] == flooded.stiffness[0]
    assert found.stiffness[-1] == pytest.approx(flooded.stiffness[-1] - 0.3 * low * (1.0 - FADING[-1]), rel=1e-12)


def test_one_after_the_other_is_the_product(given):
    flooded = Atlas().at(POINT)
    given(Thinner(0.8, 0.3), Thinner(0.5, 0.2))
    both = Atlas().at(POINT)
    assert both.h_central == pytest.approx(0.4 * flooded.h_central, rel=1e-14)
    less = 0.3 + (1.0 - 0.3 * FADING[1]) * 0.2
    assert both.damping[0] == pytest.approx(flooded.damping[0] - less * flooded.damping[1], rel=1e-12)


def test_bars_of_both_add_as_squares():
    k = 3
    values, bars = np.full((1, HEAD + 2 * k), 0.5), np.full((1, HEAD + 2 * k), 0.03)
    rows, error = under([Thinner(0.8, 0.3, 0.08)], np.ones(1), Rows(np.array(OMEGAS[:k]), values), bars)
    assert rows.values[0, 1] == pytest.approx(0.4)
    assert error[0, 1] == pytest.approx(np.hypot(0.8 * 0.03, 0.5 * 0.08))
    assert error[0, HEAD + k] == pytest.approx(np.hypot(0.03, 0.5 * 0.08))
    assert error[0, 0] == pytest.approx(np.hypot(0.8 * 0.03, 0.5 * 0.08))


@pytest.mark.parametrize("model", ["wide", "memory"])
def test_elements_follow_what_is_changed(given, model):
    flooded = Atlas().element(POINT, model)
    given(Thinner(0.8, 0.3))
    answer, element = Atlas().at(POINT), Atlas().element(POINT, model)
    Omega = np.array([0.05, 0.5, 1.5])
    C, before = (e.impedance(Omega=Omega).damping for e in (element, flooded))
    wanted = answer.impedance(Omega=Omega).damping
    np.testing.assert_allclose(C, wanted, rtol=0, atol=0.03 * before[0])
    assert C[0] < 0.75 * before[0]
    assert element.source["thinner"] == {"film": 0.8}


def test_no_change_leaves_the_damping_of_elements(given):
    flooded = Atlas().element(POINT)
    given(Thinner(1.0, 0.0))
    Omega = np.array([0.05, 0.3, 1.0, 3.0, 6.0, 20.0])
    C, before = (e.impedance(Omega=Omega).damping for e in (Atlas().element(POINT), flooded))
    np.testing.assert_allclose(C, before, rtol=1e-12)
