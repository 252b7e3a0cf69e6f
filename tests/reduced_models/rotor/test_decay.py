"""Log decrement of a damped oscillator that is known in closed form, and of a rotor."""

from math import pi

import numpy as np
import pytest
from rotor_twins import C, K, one_mass, spring

from ehlcontact import InputError
from reduced_models import SpringContact, linearise, simulate_rotor
from reduced_models.rotor.decay import log_decrement


@pytest.mark.parametrize("delta", [-0.02, 0.0, 0.003, 0.03, 0.3, 1.0])
@pytest.mark.parametrize("guess", [0.85, 1.0, 1.2])
def test_exact_decay(delta, guess):
    """Samples of a decay with a mean: all its numbers come out, whatever the guess of the frequency."""
    t, omega = np.linspace(0.0, 0.008, 320), 2.0 * pi * 1000.0
    y = 3e-7 + 5e-8 * np.exp(-delta * 1000.0 * t) * np.cos(omega * t + 0.7)
    found = log_decrement(t, y, omega=guess * omega)
    assert found.decrement == pytest.approx(delta, abs=1e-7) and found.hz == pytest.approx(1000.0, rel=1e-7)
    assert found.amplitude == pytest.approx(5e-8, rel=1e-6) and found.misfit < 1e-6
    assert found.periods == pytest.approx(8.0, rel=1e-6)
    assert found.to_dict()["decrement"] == found.decrement


def test_a_guess_in_hertz_warns():
    """Six times too low, the search ends where it has to: that is no decrement."""
    t = np.linspace(0.0, 0.02, 2000)
    y = np.exp(-30.0 * t) * np.cos(2.0 * pi * 800.0 * t)
    with pytest.warns(UserWarning, match=r"^no decay found within 30% of omega = 800 rad/s, .* angular frequency"):
        log_decrement(t, y, omega=800.0)


def test_interval_covers_noise():
    """Of 60 decays with noise the 95 % interval holds the truth in most, and not in all."""
    generator, t = np.random.default_rng(5), np.linspace(0.0, 0.008, 320)
    clean = np.exp(-0.03 * 1000.0 * t) * np.sin(2.0 * pi * 1000.0 * t)
    hits, widths = [], []
    for _ in range(60):
        found = log_decrement(t, clean + 0.02 * generator.standard_normal(t.size), omega=6283.0)
        low, high = found.interval
        hits.append(low <= 0.03 <= high)
        widths.append(high - low)
    assert 52 <= sum(hits) <= 59 + (min(widths) > 0)
    assert 0.0 < np.mean(widths) < 0.01


def test_decay_of_a_rotor_is_that_of_its_mode():
    """One mass on a linear contact, kicked and integrated, against the eigenvalue."""
    element = SpringContact.linear(K, C, low=1e-8, high=1e-4, units="SI")
    rotor = one_mass(unbalance=0.0)
    mode = linearise(rotor.on([spring])).modes()[0]
    run = simulate_rotor(
        rotor.on([element]),
        dt=2.0 * pi / mode.omega / 60,
        until=10 * 2.0 * pi / mode.omega,
        start=(rotor.on([element]).equilibrium(), np.full(2, 1e-3)),
        tolerance=1e-12,
    )
    found = log_decrement(run.t[60:], run.journal[60:, 1], omega=mode.omega)
    assert found.decrement == pytest.approx(mode.decrement, rel=0.02)
    assert found.omega == pytest.approx(mode.omega, rel=2e-3) and found.misfit < 1e-3


def test_refused():
    t = np.linspace(0.0, 0.001, 50)
    with pytest.raises(InputError, match="periods"):
        log_decrement(t, np.sin(t), omega=6283.0)
    with pytest.raises(InputError, match="standing still"):
        log_decrement(10 * t, np.full(50, 3e-7), omega=6283.0)
    with pytest.raises(InputError, match="signal"):
        log_decrement(10 * t, np.ones(49), omega=6283.0)
