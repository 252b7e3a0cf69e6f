"""Film-memory element: its law against an oracle, steps of any length, passivity, units, bad input."""

import json
import math
from dataclasses import replace
from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ehlcontact import InputError, read, save
from reduced_models.elements.film_filters import filter_rates
from reduced_models.elements.film_response import FilterRates, fit_gains

OMEGAS = np.concatenate([[0.0], np.geomspace(0.03, 60.0, 24)])


def wave(omega, steps, periods=1.0, amplitude=0.05, centre=0.87):
    T = np.linspace(0.0, periods * 2.0 * pi / omega, round(steps * periods) + 1)
    return T, centre + amplitude * np.sin(omega * T), amplitude * omega * np.cos(omega * T)


def test_starts_at_rest_under_the_reference_load(memory):
    u = memory.approach_at(1.0)
    assert u == pytest.approx(1.0 - memory.film, rel=1e-12)
    assert memory.advance(0.1, u, 0.0) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("u", [-50.0, -0.5, 0.3, 0.871, 1.0, 3.0])
def test_static_curve_is_the_film_law(memory, u):
    F = memory.spring(u)
    assert F > 0.0
    assert F ** (2.0 / 3.0) - memory.film * F**-memory.exponent == pytest.approx(u, rel=1e-10)


def test_force_fades_where_the_surfaces_part(memory):
    u = np.linspace(-20.0, 1.5, 4000)
    F = memory.spring(u)
    assert (F > 0.0).all() and (np.diff(F) > 0.0).all() and F[0] < 1e-12
    assert memory.spring(-1e30) < 1e-100


@pytest.mark.parametrize("omega", [1.0, pi, 4.0 * pi])
def test_law_agrees_with_its_equations_integrated_otherwise(memory, omega):
    """The continuous-time system of `to_control`, by an explicit method with tight tolerance."""
    T, u, v = wave(omega, 400)
    system = memory.to_control()
    n = memory.lags + 2

    def motion(t):
        return np.array([0.87 + 0.05 * math.sin(omega * t), 0.05 * omega * math.cos(omega * t)])

    def rates(t, x):
        return system.updfcn(t, x, motion(t), {})

    solved = solve_ivp(rates, (0.0, T[-1]), np.zeros(n), method="DOP853", rtol=1e-9, atol=1e-12, t_eval=T)
    exact = np.array([system.outfcn(t, x, motion(t), {})[0] for t, x in zip(T, solved.y.T, strict=True)])
    assert np.abs(memory.drive(T, u, v) - exact)[1:].max() < 2e-5


def test_steps_are_second_order_or_better(memory):
    omega = 2.0 * pi
    ends = [memory.drive(*wave(omega, steps, 1.25))[-1] for steps in (16, 32, 1024)]
    assert abs(ends[1] - ends[2]) < 0.3 * abs(ends[0] - ends[2])
    assert abs(ends[0] - ends[2]) < 5e-3


def test_rotor_steps_give_the_damping_of_slow_motion(memory):
    """Steps of 9, five transits of the film each, at Omega = 0.05: the first harmonic against the impedance."""
    omega, amplitude, periods = 0.05, 1e-3, 9
    T, u, v = wave(omega, 2.0 * pi / omega / 9.0, periods, amplitude, memory.approach_at(1.0))
    assert T[1] == pytest.approx(9.0, rel=0.01)
    force = memory.drive(T, u, v)[1:]
    columns = np.column_stack([np.ones(T.size - 1), np.sin(omega * T[1:]), np.cos(omega * T[1:])])
    _, K, wC = np.linalg.lstsq(columns, force, rcond=None)[0] / amplitude
    Z = memory.impedance(Omega=omega).value[0]
    assert K == pytest.approx(Z.real, rel=5e-3)
    assert wC == pytest.approx(Z.imag, rel=0.03)


def test_a_long_step_ends_on_the_static_force(memory):
    for dt in (1e3, 1e6, 1e12):
        memory.rest(0.5)
        assert memory.advance(dt, 1.1, 0.0) == pytest.approx(memory.spring(1.1), rel=1e-3 if dt < 1e4 else 1e-6)


def test_a_jump_of_approach_is_felt_even_at_zero_rate(memory):
    memory.rest(0.8)
    assert memory.advance(0.01, 0.9, 0.0) > memory.spring(0.9) + 0.005


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_no_step_blows_up(memory):
    rng = np.random.default_rng(5)
    for _ in range(3000):
        dt = 10.0 ** rng.uniform(-9.0, 6.0)
        force = memory.advance(dt, rng.uniform(-3.0, 2.0), rng.normal())
        assert math.isfinite(force) and force >= 0.0
    for _ in range(3):
        force = memory.advance(1e4, 0.87, 0.0)
    assert force == pytest.approx(memory.spring(0.87), rel=1e-6)


def test_impedance_is_that_of_a_small_motion(memory):
    for omega in (0.2, pi, 20.0):
        periods = max(2, math.ceil(3.0 * omega))
        T, u, v = wave(omega, 100, periods, 1e-5, memory.approach_at(1.0))
        last = slice(-101, -1)
        force = memory.drive(T, u, v)[last]
        columns = np.column_stack([np.ones(100), np.sin(omega * T[last]), np.cos(omega * T[last])])
        _, K, wC = np.linalg.lstsq(columns, force, rcond=None)[0] / 1e-5
        assert complex(K, wC) == pytest.approx(memory.impedance(Omega=omega).value[0], rel=1e-3)


@pytest.mark.parametrize("load", [0.4, 1.0])
def test_linear_law_has_the_matrices_of_the_rates(memory, load):
    """Column by column: `filter_rates` of every state alone, and of the rate."""
    film = memory.linear_film(load)
    A, B, *_ = film.state_space()
    for k, state in enumerate(np.eye(memory.state_count)):
        rates = np.empty(state.size)
        filter_rates(memory.law, film.made * state[0], film.tau, 0.0, state, rates)
        np.testing.assert_allclose(A[:, k], rates, rtol=1e-14)
    filter_rates(memory.law, 0.0, film.tau, 1.0, np.zeros(memory.state_count), rates)
    np.testing.assert_allclose(B[:, 1], rates, rtol=1e-14)
    assert not B[:, 0].any()


def test_least_dissipation_is_the_minimum_over_all_frequencies():
    rng = np.random.default_rng(2)
    omega = np.concatenate([[0.0], np.geomspace(1e-3, 1e5, 20000)])
    for lags in (1, 4, 12, 16):
        rates = FilterRates(lags, 0.7 * lags, 30.0, 80.0)
        response = rates.basis(omega).real
        for _ in range(10):
            gains = rng.normal(size=3 + lags)
            least = rates.least_dissipation(gains)
            assert least == pytest.approx((response @ gains).min(), abs=1e-5)
            for margin in (-1.0, -1e-3, -1e-7, 1e-7, 1e-3, 1.0):
                shifted = gains.copy()
                shifted[0] += margin - least
                assert rates.passive(shifted) == (margin > 0.0)
                assert rates.passive([shifted, np.ones(3 + lags) * [1.0, *[0.0] * (2 + lags)]]) == (margin > 0.0)


def test_fit_of_gains_is_exact_on_its_own_data_and_enforces_passivity(memory):
    rates, w = memory.rates, OMEGAS
    Z = memory.impedance(Omega=w).value
    C = 1.5 * (rates.basis(w) @ np.array(memory.gains)).real
    fitted = fit_gains(rates, w, Z.real, C, Z.real[0])
    np.testing.assert_allclose(fitted.damping, C, rtol=1e-6)
    # Data up to Omega = 0.9 that call for a wave whose damping turns negative beyond.
    rates, wave_gains = FilterRates(8, 5.0, 30.0, 60.0), np.zeros(11)
    wave_gains[-1] = 0.05
    w = np.linspace(0.0, 0.9, 12)
    G = rates.basis(w) @ wave_gains
    assert rates.least_dissipation(wave_gains) < 0.0 < G.real.min()
    enforced = fit_gains(rates, w, 1.4 - 1.5 * w * G.imag, 1.5 * G.real, 1.4)
    assert enforced.gains[0] > 0.0
    assert rates.least_dissipation(enforced.gains) >= 0.0


def test_active_gains_are_refused(memory):
    with pytest.raises(InputError, match="passive"):
        replace(memory, gains=(0.0,) * 10 + (0.05,))


def test_impedance_and_steps_in_si(memory, scales):
    si, moes = memory.to_si(scales), memory.copy()
    np.testing.assert_allclose(
        si.impedance(omega=pi / scales.time).value, memory.impedance(Omega=pi).value * scales.stiffness
    )
    for i in range(1, 40):
        at = np.array([0.05, 0.87 + 0.05 * np.sin(0.05 * pi * i), 0.1])
        force = si.advance(*(at * [scales.time, scales.length, scales.rate]))
        assert force == pytest.approx(moes.advance(*at) * scales.force, rel=1e-12)


@pytest.mark.parametrize(
    ("section", "key", "value", "message"),
    [
        ("parameters", "gains", 1.0, "parameters.gains"),
        ("parameters", "gains", [1.0, "x", 2.0, 3.0], "gains"),
        ("parameters", "film", -1.0, "film"),
        ("parameters", "lag_rate", 0.0, "lag_rate"),
        (None, "scales", [1.0], "scales"),
        (None, "units", "SI", "scales"),
        ("valid", "low", 5.0, "low"),
    ],
)
def test_wrong_files_name_the_entry(memory, tmp_path, section, key, value, message):
    path = save(memory, tmp_path / "wrong.json")
    document = json.loads(path.read_text())
    (document if section is None else document[section])[key] = value
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match=message) as caught:
        read(path)
    assert "wrong.json" in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"film": 0.0}, "film"),
        ({"exponent": 0.0}, "exponent"),
        ({"inlet_saturation": -0.1}, "inlet_saturation"),
        ({"gains": (0.1, 0.1, 0.1)}, "gains"),
        ({"gains": (0.1, math.nan, 0.1, 0.1)}, "gains"),
    ],
)
def test_bad_coefficients(memory, changes, message):
    with pytest.raises(InputError, match=message):
        replace(memory, **changes)


@pytest.mark.parametrize("dt", [0.0, -1.0, math.nan, math.inf])
def test_bad_steps(memory, dt):
    with pytest.raises(InputError, match="dt"):
        memory.advance(dt, 0.9, 0.0)


def test_not_a_number_leaves_the_state(memory):
    before = memory.save_state()
    with pytest.raises(InputError, match="finite"):
        memory.advance(0.1, math.nan, 0.0)
    np.testing.assert_array_equal(memory.save_state(), before)
