"""Envelope, orders, sampling and features of signals whose answers are known."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ehlcontact import InputError
from ehlcontact.status import Status
from reduced_models import BallBearing
from reduced_models.rotor.result import RotorResult
from reduced_models.signals.indicators import indicators
from reduced_models.signals.sampling import (
    housing_acceleration,
    node_acceleration,
    require_sampling,
    sampled,
    shaft_angle,
)
from reduced_models.signals.spectra import envelope_spectrum, order_spectrum
from reduced_models.signals.transfer_path import MeasuredPath, ModalPath

RATE = 12_000.0
BAND = (2000.0, 5500.0)


def test_envelope_of_a_modulated_tone():
    t = np.arange(int(2.0 * RATE)) / RATE
    signal = (1.0 + 0.4 * np.cos(2.0 * np.pi * 107.0 * t)) * np.sin(2.0 * np.pi * 3600.0 * t)
    found = envelope_spectrum(signal + 5.0 * np.sin(2.0 * np.pi * 500.0 * t), RATE, BAND)
    assert found.line(107.0, 1.0) == pytest.approx((107.0, 0.4), rel=1e-3)
    assert found.mean == pytest.approx(1.0, rel=1e-3)
    assert found.line(214.0, 1.0).amplitude < 1e-3


def test_envelope_of_impulses_is_the_fourier_series_of_an_exponential():
    """Ring-downs that decay fast: harmonics k have 2/(T |s + 2 pi i k/T|) of the first value."""
    rate, f, zeta, hz = 48_000.0, 100.0, 0.02, 6000.0
    force = np.zeros(int(4.0 * rate))
    force[:: int(rate / f)] = 1.0
    moved = ModalPath(hz=hz, damping=zeta, mass=1.0).acceleration(force, rate)
    found = envelope_spectrum(moved, rate, (1000.0, 11_000.0))
    decay = zeta * 2.0 * np.pi * hz
    wanted = [abs(decay + 2j * np.pi * f) / abs(decay + 2j * np.pi * k * f) for k in (2, 3)]
    ratios = [found.line(k * f, 1.0).amplitude / found.line(f, 1.0).amplitude for k in (2, 3)]
    assert ratios == pytest.approx(wanted, rel=0.02)


def test_picture_of_an_envelope_has_unit_and_marks():
    """To 1 kHz, or as far as three multiples of a mark; BPFO and its multiples are marked."""
    t = np.arange(int(2.0 * RATE)) / RATE
    signal = (1.0 + 0.4 * np.cos(2.0 * np.pi * 107.0 * t)) * np.sin(2.0 * np.pi * 3600.0 * t)
    found = envelope_spectrum(signal, RATE, BAND, unit="N")
    panel = found.picture({"BPFO": 107.0}).panels[0]
    assert panel.x == ("frequency", "Hz") and panel.y == ("amplitude of the envelope", "N")
    assert panel.x_ends == (0.0, 1000.0) and panel.lines[0].x[-1] <= 1000.0
    assert [mark.text for mark in panel.marks] == ["BPFO", "2x", "3x", "4x", "5x", "6x", "7x", "8x", "9x"]
    assert [mark.at for mark in panel.marks[:2]] == [107.0, 214.0]
    assert found.picture({"BPFO": 900.0}).panels[0].x_ends == (0.0, 3150.0)
    assert found.picture(highest=1e5).panels[0].x_ends == (0.0, 6000.0)
    assert "0.4 N at 107 Hz" in repr(found) and envelope_spectrum(signal, RATE, BAND).unit == "m/s2"
    with pytest.raises(InputError, match="BPFO = 0"):
        found.plot(marks={"BPFO": 0.0})
    with pytest.raises(InputError, match=r"^marks = 'list': must be frequencies \[Hz\] by name"):
        found.plot(marks=[153.0])


def test_velocity_of_a_tone_and_of_noise():
    """Of a tone the amplitude over 2 pi f, also between lines; of white noise the integral over the band."""
    t = np.arange(int(4.0 * RATE)) / RATE
    tone = 10.0 * np.sin(2.0 * np.pi * 160.3 * t)
    far = 0.5 * np.sin(2.0 * np.pi * 4.0 * t) + 50.0 * np.sin(2.0 * np.pi * 1500.0 * t)
    expected = 1e3 * 10.0 / (2.0 * np.pi * 160.3) / np.sqrt(2.0)
    assert indicators(tone + far, RATE).velocity_rms_mm_s == pytest.approx(expected, rel=2e-3)
    noise = np.random.default_rng(3).standard_normal(int(20.0 * RATE))
    density = 2.0 / RATE  # m2/s4/Hz
    expected = 1e3 * np.sqrt(density * (1.0 / 10.0 - 1.0 / 1000.0)) / (2.0 * np.pi)
    assert indicators(noise, RATE).velocity_rms_mm_s == pytest.approx(expected, rel=0.05)
    assert indicators(tone).velocity_rms_mm_s is None
    assert indicators(tone[:3000], RATE).velocity_rms_mm_s is None  # a quarter of a second
    assert indicators(tone, 1000.0).velocity_rms_mm_s is None


def test_shapes_and_units_that_files_have():
    """Columns of scipy.io.loadmat, angles in degrees, a band up to half of the rate: named in one line."""
    t = np.arange(24000) / RATE
    angle = 2.0 * np.pi * np.cumsum((1500.0 + 300.0 * t) / 60.0) / RATE
    for speeds in (np.array([[1797.0]]), np.full((t.size, 1), 1797.0)):
        with pytest.raises(InputError, match=r"shape of speed_rpm = \(\d+, 1\): must be one-dimensional"):
            shaft_angle(t, speeds)
    with pytest.raises(InputError, match=r"at the highest speed, 1.203e\+05 rpm \(angle in degrees\?\)"):
        order_spectrum(np.sin(5.0 * angle), RATE, np.degrees(angle), turns=8)
    with pytest.raises(InputError, match="above 0 and below 6000 Hz, half the rate"):
        envelope_spectrum(np.sin(5.0 * angle), RATE, (2000.0, 6000.0))


def run_up(seconds=8.0, low=5.0, high=25.0, rate=RATE):
    """Times and turns of the shaft, from `low` to `high` turns per s."""
    t = np.arange(int(seconds * rate)) / rate
    return t, low * t + 0.5 * (high - low) / seconds * t**2


def test_orders_of_a_run_up():
    """A line of order 3.6 stays one line; in the spectrum over frequency it is smeared over a hundred Hz."""
    t, turns = run_up()
    signal = 0.7 * np.sin(2.0 * np.pi * 3.6 * turns) + 0.2 * np.sin(2.0 * np.pi * 11.3 * turns)
    found = order_spectrum(signal, RATE, 2.0 * np.pi * turns, turns=20)
    assert found.line(3.6, 0.2) == pytest.approx((3.6, 0.7), rel=2e-3)
    assert found.line(11.3, 0.2) == pytest.approx((11.3, 0.2), rel=2e-3)
    smeared = 2.0 * np.abs(np.fft.rfft(np.hanning(t.size) * signal)) / np.hanning(t.size).sum()
    assert smeared.max() < 0.1


def test_orders_of_a_run_up_have_no_alias():
    """A tone of 5 kHz passes orders 1000 to 200, above 50: an order spectrum to 50 has nothing of it."""
    t, turns = run_up()
    found = order_spectrum(np.sin(2.0 * np.pi * 5000.0 * t), RATE, 2.0 * np.pi * turns, turns=20)
    assert found.amplitude.max() < 1e-3


def test_angle_of_the_shaft():
    t, turns = run_up()
    speed = 60.0 * (5.0 + 20.0 / 8.0 * t)
    assert shaft_angle(t, speed) == pytest.approx(2.0 * np.pi * turns, abs=1e-8)


def test_sampled_has_no_alias():
    """The lower of two tones stays, at its amplitude and in phase; 6.1 kHz leaves nothing at 5.9 kHz."""
    dt = 1.0 / 48_000.0
    t = dt * np.arange(48_000)
    low = np.sin(2.0 * np.pi * 3000.0 * t + 0.3)
    found = sampled(low + np.sin(2.0 * np.pi * 6100.0 * t), dt, RATE)
    assert found.size == 12_000
    inner = slice(100, -100)
    assert found[inner] == pytest.approx(low[::4][inner], abs=3e-4)


def test_sampled_at_a_fraction():
    dt = 1.0 / 50_000.0
    t = dt * np.arange(20_000)
    tone = np.sin(2.0 * np.pi * 700.0 * t)
    found = sampled(np.column_stack([tone, 2.0 * tone]), dt, RATE)
    at = np.arange(len(found)) / RATE
    wanted = np.sin(2.0 * np.pi * 700.0 * at)
    assert found[100:-100, 1] == pytest.approx(2.0 * wanted[100:-100], abs=1e-3)


def test_features_of_a_sine_and_of_plain_sums():
    sine = indicators(3.0 * np.sin(2.0 * np.pi * np.arange(10_000) / 1000.0) + 7.0)
    assert (sine.rms, sine.crest_factor, sine.kurtosis) == pytest.approx(
        (3.0 / math.sqrt(2.0), math.sqrt(2.0), 1.5)
    )
    values = np.random.default_rng(1).gamma(2.0, size=50).tolist()
    mean = sum(values) / 50
    off = [value - mean for value in values]
    rms = math.sqrt(sum(x * x for x in off) / 50)
    size = sum(abs(x) for x in off) / 50
    root = (sum(math.sqrt(abs(x)) for x in off) / 50) ** 2
    peak = max(map(abs, off))
    wanted = {
        "rms": rms, "peak": peak, "crest_factor": peak / rms, "shape_factor": rms / size,
        "impulse_factor": peak / size, "clearance_factor": peak / root,
        "skewness": sum(x**3 for x in off) / 50 / rms**3, "kurtosis": sum(x**4 for x in off) / 50 / rms**4,
    }  # fmt: skip
    numbers = indicators(values).to_dict()
    assert numbers.pop("velocity_rms_mm_s") is None and numbers == pytest.approx(wanted, rel=1e-12)


def run_of(force, velocity, dt):
    """A run of one bearing with this force along y and one node, "disc"."""
    k, zero = force.size, np.zeros((force.size, 2))
    column = np.column_stack([np.zeros(k), force])
    return RotorResult(
        t=dt * np.arange(k), speed_rpm=np.full(k, 1800.0), displacement=zero,
        velocity=np.column_stack([np.zeros(k), velocity]), approach=zero, rate=zero, force=column,
        iterations=np.zeros(k, np.int64), largest_load=np.zeros((1, 2)), status=Status.CONVERGED,
        columns=("bearing 0 x", "bearing 0 y"), names=("disc x", "disc y"), places=np.array([0, 1]),
    )  # fmt: skip


def test_acceleration_of_nodes_and_housing():
    dt, f = 1.0 / 48_000.0, 1500.0
    t = dt * np.arange(24_000)
    w = 2.0 * np.pi * f
    run, path = (
        run_of(100.0 + np.sin(w * t), 1e-3 * np.cos(w * t), dt),
        ModalPath(hz=2700.0, damping=0.1, mass=3.0),
    )
    node = node_acceleration(run, "disc", RATE)
    inner = slice(1000, -50)
    assert node[inner, 1] == pytest.approx(-1e-3 * w * np.sin(w * t[::4][inner]), abs=1e-3 * w * 1e-3)
    assert not node[:, 0].any()
    housing = housing_acceleration(run, path, RATE)
    wanted = (path.response(f) * np.exp(1j * w * t[::4])).imag
    assert housing[inner] == pytest.approx(wanted[inner], abs=2e-3 * np.abs(wanted).max())
    hz = np.linspace(0.0, 6000.0, 3001)  # measured to half the output rate, far below that of the steps
    measured = housing_acceleration(run, MeasuredPath(hz, path.response(hz)), RATE)
    assert measured[inner] == pytest.approx(wanted[inner], abs=2e-3 * np.abs(wanted).max())
    with pytest.raises(InputError, match=r"rate = 12000\.0: must be at most 10000 Hz, twice the measured"):
        housing_acceleration(run, MeasuredPath(hz[:2501], path.response(hz[:2501])), RATE)
    with pytest.raises(InputError, match="axis"):
        housing_acceleration(run, path, RATE, axis="z")
    with pytest.raises(InputError, match="bearing"):
        housing_acceleration(run, path, RATE, bearing=1)
    with pytest.raises(InputError, match="steps of the run"):
        node_acceleration(replace(run, t=run.t[:3]), "disc", RATE)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: sampled(np.zeros(9), 1e-4, RATE), "at most 10000 Hz"),
        (lambda: sampled(np.zeros(9), 1e-5, 12_345.6789), "fraction"),
        (lambda: sampled([np.nan, 1.0], 1e-5, RATE), "values"),
        (lambda: require_sampling(BallBearing.catalogue("6205"), 3000.0, 2000.0), "at least 2166 Hz"),
        (lambda: envelope_spectrum(np.zeros(10), RATE, BAND), "signal"),
        (lambda: envelope_spectrum(np.zeros(100), RATE, (2000.0, 6000.0)), "half the rate"),
        (lambda: envelope_spectrum(np.zeros(100), RATE, (3000.0, 2000.0)), "band"),
        (lambda: envelope_spectrum(np.zeros(100), 1e6, (1e-3, 2e-3)), "from 1e.04 Hz, which the record resolves"),
        (lambda: envelope_spectrum(np.zeros(1200), RATE, (2000.0, 2015.0)), "20 Hz wide at least"),
        (lambda: envelope_spectrum(np.zeros(1200), RATE, (1.0, 200.0)), "band"),
        (lambda: order_spectrum(np.zeros(100), RATE, np.zeros(100)), "angle"),
        (lambda: order_spectrum(np.zeros(100), RATE, np.linspace(0.0, 1.0, 100)), "turns of the record"),
        (lambda: order_spectrum(np.zeros(100), RATE, np.linspace(0.0, 600.0, 100)), "half the rate"),
        (lambda: indicators(np.full(100, 3.0)), "not constant"),
        (lambda: indicators([1.0, 2.0]), "signal"),
    ],
)
def test_bad_input_is_one_line(call, word):
    with pytest.raises(InputError, match=word) as caught:
        call()
    assert "\n" not in str(caught.value)


def test_a_line_that_is_not_there():
    found = envelope_spectrum(np.random.default_rng(0).normal(size=1000), RATE, BAND)
    with pytest.raises(InputError, match="from 0 to 6000"):
        found.line(7000.0, 1.0)
    assert len(repr(found).splitlines()) == 2
