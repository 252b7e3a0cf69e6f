"""Transfer paths against the equation of motion, integrated, and against the formula of a harmonic force."""

import control
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ehlcontact import InputError
from reduced_models.signals.transfer_path import MeasuredPath, ModalPath, SystemPath

RATE, HZ, ZETA, MASS = 50_000.0, 2700.0, 0.05, 3.0
W0 = 2.0 * np.pi * HZ


def pulse(t):
    """Smooth force of 0.4 ms at 2 ms, and a step of a tenth of it that stays."""
    return np.exp(-(((t - 2e-3) / 2e-4) ** 2)) + 0.05 * (1.0 + np.tanh((t - 4e-3) / 3e-4))


def integrated(t, force):
    """Acceleration of a mass on spring and damper, step by step."""

    def moved(at, y):
        return [y[1], force(at) / MASS - 2.0 * ZETA * W0 * y[1] - W0**2 * y[0]]

    x, v = solve_ivp(moved, (0.0, t[-1]), [0.0, 0.0], t_eval=t, rtol=1e-9, atol=1e-16).y
    return force(t) / MASS - 2.0 * ZETA * W0 * v - W0**2 * x


def paths():
    one = ModalPath(hz=HZ, damping=ZETA, mass=MASS)
    hz = np.linspace(0.0, 25_000.0, 5001)
    return {
        "modal": one,
        "measured": MeasuredPath(hz, one.response(hz)),
        "system": SystemPath(control.tf([1.0 / MASS, 0.0, 0.0], [1.0, 2.0 * ZETA * W0, W0**2])),
    }


@pytest.mark.parametrize(("name", "error"), [("modal", 1e-4), ("measured", 2e-3), ("system", 1e-4)])
def test_pulse_as_the_equation_of_motion(name, error):
    t = np.arange(600) / RATE
    wanted = integrated(t, pulse)
    found = paths()[name].acceleration(pulse(t), RATE)
    assert np.abs(found - wanted).max() < error * np.abs(wanted).max()


def test_harmonic_force_has_the_amplitude_of_the_formula():
    t, f = np.arange(20_000) / RATE, 2500.0
    w = 2.0 * np.pi * f
    found = paths()["modal"].acceleration(np.sin(w * t), RATE)[-5000:-1000]
    wanted = w**2 / (MASS * abs(W0**2 - w**2 + 2j * ZETA * W0 * w))
    assert np.sqrt(2.0 * np.mean(found**2)) == pytest.approx(wanted, rel=1e-4)


def test_modes_add_up_and_a_negative_mass_is_the_other_side_of_a_node():
    both = ModalPath(hz=[HZ, 3500.0], damping=[ZETA, 0.02], mass=[MASS, -8.0])
    single = [ModalPath(hz=HZ, damping=ZETA, mass=MASS), ModalPath(hz=3500.0, damping=0.02, mass=8.0)]
    hz = np.array([100.0, 2600.0, 3500.0])
    assert both.response(hz) == pytest.approx(single[0].response(hz) - single[1].response(hz), rel=1e-14)
    assert both.decay_time == single[1].decay_time


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: ModalPath(hz=HZ, damping=-0.01, mass=1.0), "poles left of the imaginary axis"),
        (lambda: ModalPath(hz=HZ, damping=0.0, mass=1.0), "left of the imaginary axis"),
        (lambda: ModalPath(hz=HZ, damping=[5.0], mass=1.0), "per cent"),
        (lambda: paths()["measured"].response(np.array([1.0, 3e4])), "hz = 30000.0: must be at most 25000 Hz"),
        (lambda: ModalPath(hz=[HZ, 1.0], damping=0.1, mass=1.0), "as many as hz"),
        (lambda: ModalPath(hz=np.nan, damping=0.1, mass=1.0), "hz"),
        (lambda: ModalPath(hz=1e-3, damping=0.1, mass=1.0), "fades within 60 s"),
        (lambda: ModalPath(hz=HZ, damping=0.1, mass=0.0), "mass"),
        (lambda: SystemPath(control.tf([1.0], [1.0, -0.1, 1.0])), "left of the imaginary axis"),
        (lambda: SystemPath(control.tf([1.0], [1.0, 0.0, 1.0])), "left of the imaginary axis"),
        (lambda: SystemPath(3.0), "python-control"),
        (lambda: MeasuredPath([0.0, 1.0], [1.0, np.nan]), "accelerance"),
        (lambda: MeasuredPath([1.0, 0.0], [1.0, 1.0]), "hz"),
        (lambda: paths()["measured"].acceleration(np.zeros(9), 60_000.0), "at most 50000 Hz"),
        (lambda: paths()["modal"].acceleration([0.0, np.inf], RATE), "force"),
        (lambda: paths()["modal"].acceleration([0.0, 1.0], 0.0), "rate"),
    ],
)
def test_bad_input_is_one_line(make, word):
    with pytest.raises(InputError, match=word.replace(".", r"\.")) as caught:
        make()
    assert "\n" not in str(caught.value)
