"""The one rule for frequencies, on its own and wherever a frequency is asked for."""

from math import pi

import numpy as np
import pytest
from balls import OF_6205
from refusals import refusals

from ehlcontact import (
    FreeVibration,
    Grid,
    HarmonicLoad,
    InputError,
    MoesPoint,
    PrescribedLoad,
    RampLoad,
    impedance,
    response,
)
from ehlcontact.checks.frequency import dimensionless, radians_per_second
from ehlcontact.lubricant import Lubricant
from ehlcontact.point import OperatingPoint
from reduced_models import SpringContact

TIME = 2e-5
POINT = MoesPoint(200, 10, 0.5)
BEARING = OperatingPoint.ball_bearing(Lubricant(0.037, 2e-8), **OF_6205, speed_rpm=3000, load=20)
LINEAR = SpringContact.linear(K1=1.0, C1=0.1, low=0.5, high=1.5)


@pytest.mark.parametrize(
    "given", [{"Omega": 2 * pi * 50 * TIME}, {"omega": 2 * pi * 50}, {"hz": 50}, {"hz": [50.0]}, {"rpm": 3000}]
)
def test_one_frequency_in_four_units(given):
    assert dimensionless(TIME, **given) == pytest.approx([2 * pi * 50 * TIME], rel=1e-14)
    assert radians_per_second(TIME, **given) == pytest.approx([2 * pi * 50], rel=1e-14)


@pytest.mark.parametrize(
    ("time", "given", "line"),
    [
        (TIME, {}, "frequency = None: must be given once, as Omega (dimensionless), omega (rad/s), hz or rpm"),
        (None, {}, "frequency = None: must be given once, as Omega (dimensionless)"),
        (TIME, {"Omega": 1.0, "hz": 5}, "frequency = 'Omega and hz': must be given once, as Omega"),
        (None, {"hz": 50}, "hz = 50: must be left out: a dimensionless contact has no unit of time; give Omega"),
        (None, {"omega": 3.0}, "omega = 3.0: must be left out"),
        (None, {"rpm": 3000}, "rpm = 3000: must be left out"),
        (TIME, {"hz": -1}, "hz = -1.0: must be finite, >= 0"),
        (TIME, {"hz": [1.0, float("nan")]}, "hz = nan: must be finite, >= 0"),
        (TIME, {"rpm": "fast"}, "rpm = 'fast': must be numbers"),
        (TIME, {"hz": "50"}, "hz = '50': must be numbers"),
        (TIME, {"hz": True}, "hz = True: must be numbers"),
        (TIME, {"hz": 5 + 1j}, "hz = (5+1j): must be numbers"),
        (TIME, {"Omega": []}, "Omega = 'of shape (0,)': must be a number, or a flat list"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(time, given, line):
    with pytest.raises(InputError) as caught:
        dimensionless(time, **given)
    assert str(caught.value).startswith(line) and "\n" not in str(caught.value)


def test_one_of_several_is_asked_for_in_their_own_words():
    """Not with the Omega of 50 and 60 Hz, which nobody gave."""
    with pytest.raises(InputError, match=r"^frequency = '2 numbers': must be a single frequency$"):
        HarmonicLoad.at(BEARING, hz=[50.0, 60.0])  # type: ignore[arg-type]


def test_limits_are_told_in_the_unit_that_was_used():
    assert dimensionless(TIME, hz=1e6, most=200.0) == pytest.approx([40 * pi])
    with pytest.raises(InputError, match=r"^hz = 2000000.0: must be finite, >= 0 and <= 1.59155e\+06$"):
        dimensionless(TIME, hz=2e6, most=200.0)


def test_without_a_unit_of_time_there_is_no_dimensionless_one():
    assert radians_per_second(None, rpm=60) == pytest.approx([2 * pi])
    with pytest.raises(InputError, match=r"^Omega = 1.0: must be left out: .*give omega, hz or rpm$"):
        radians_per_second(None, Omega=1.0)


test_every_call_asks_for_a_name = refusals(
    (
        lambda: impedance(POINT, [0.05]),
        r"^frequency = \[0.05\]: must be named with its unit: Omega \(",
    ),
    (lambda: impedance(POINT, hz=50), r"^hz = 50: must be left out: a dimensionless contact .*give Omega$"),
    (lambda: impedance(BEARING), "^frequency = None"),
    (lambda: FreeVibration(omega_n=5.13), "^omega_n = 5.13: must be given as Omega_n, dimensionless"),
    (lambda: FreeVibration(50), "^frequency = 50: must be given as Omega_n, dimensionless; FreeVibration.at"),
    (lambda: HarmonicLoad(50), "^frequency = 50: must be given as Omega, dimensionless; HarmonicLoad.at"),
    (lambda: RampLoad(3.0, 1.0, 50), "^frequency = 50: must be given as Omega_n, dimensionless"),
    (lambda: HarmonicLoad(omega=1.0), "^omega = 1.0: must be given as Omega, dimensionless"),
    (lambda: HarmonicLoad(Omega=1.0, omega_n=2.0), "^omega_n = 2.0: must be given as Omega_n, dimensionless"),
    (lambda: RampLoad(3.0, 1.0, omega_n=2.0), "^omega_n = 2.0: must be given as Omega_n"),
    (
        lambda: PrescribedLoad.from_function(lambda t: 1.0, 2.0, omega_n=3.0),
        "^omega_n = 3.0",
    ),
    (lambda: HarmonicLoad.at(POINT, hz=50), r"^point = 'MoesPoint': must be .*takes HarmonicLoad\(Omega\)$"),
    (
        lambda: FreeVibration.at(POINT, hz=50),
        r"^point = 'MoesPoint': must be .*takes FreeVibration",
    ),
    (lambda: FreeVibration.at(BEARING), "^mass = None: must be given, or omega"),
    (lambda: FreeVibration.at(BEARING, mass=0.1, hz=3.0), "^mass = 0.1: must be given, or omega"),
    (lambda: HarmonicLoad.at(BEARING, amplitude=0.2), "^frequency = None"),
    (lambda: HarmonicLoad.at(BEARING, hz=[50, 60]), "^frequency = .*a single frequency"),
    (lambda: impedance(BEARING, freq=50), r"^freq = 50: must be named with its unit: Omega \("),
    (lambda: response(BEARING, frequency=50), r"^frequency = 50: must be named with its unit: Omega \("),
    (lambda: LINEAR.check(frequency=50), r"^frequency = 50: must be named with its unit: Omega \("),
    (lambda: LINEAR.is_valid(1.0, 0.0, f=50), r"^f = 50: must be named with its unit: Omega \("),
    (
        lambda: FreeVibration.at(BEARING, mass=0.1, offset=0.05),
        f"^offset = 0.05: must be at most {2 * BEARING.scales.length:.3g} m, 2 dry approaches",
    ),
)


def test_a_name_that_a_call_does_not_know_is_said_of_that_call():
    with pytest.raises(TypeError, match=r"^impedance\(\) got an unexpected keyword argument 'roughness'$"):
        impedance(BEARING, hz=50.0, roughness=None)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"^check\(\) got an unexpected keyword argument 'speed'$"):
        LINEAR.check(speed=1.0)  # type: ignore[call-arg]


def test_motions_of_a_point_in_si():
    time = BEARING.scales.time
    turning = HarmonicLoad.at(BEARING, amplitude=0.2, rpm=3000, mass=0.5)
    assert turning.Omega == pytest.approx(100 * pi * time, rel=1e-14)
    assert (turning.amplitude, turning.Omega_n) == (0.2, BEARING.Omega_n(0.5))
    free = FreeVibration.at(BEARING, mass=0.02, offset=0.1 * BEARING.scales.length)
    assert (free.Omega_n, free.offset) == (BEARING.Omega_n(0.02), pytest.approx(0.1))
    swings = FreeVibration.at(BEARING, hz=5000.0)
    assert swings.period * time == pytest.approx(1.0 / 5000.0)
    assert FreeVibration.at(BEARING, hz=5000.0, rate=1e-3).rate == pytest.approx(1e-3 / BEARING.scales.rate)


def test_impedance_at_a_frequency_in_hertz_is_that_at_its_Omega():
    Omega = 2 * pi * 50.0 * BEARING.scales.time
    by_hz, plain = (
        impedance(BEARING, hz=[50.0, 5000.0], grid=Grid(n=32)),
        impedance(BEARING.moes, Omega=Omega, grid=Grid(n=32)),
    )
    scales = BEARING.scales
    assert by_hz.dimensionless.omega == pytest.approx([Omega, 100 * Omega], rel=1e-14)
    assert by_hz.dimensionless.damping[0] == pytest.approx(plain.damping[0], rel=1e-3)
    np.testing.assert_allclose(by_hz.hz, [50.0, 5000.0])
    np.testing.assert_allclose(by_hz.omega, 2 * pi * by_hz.hz)
    np.testing.assert_allclose(by_hz.damping, by_hz.dimensionless.damping * scales.damping)
    assert by_hz.to_dict()["hz"] == by_hz.hz.tolist() and "hz" not in plain.to_dict()
    with pytest.raises(InputError, match="omega of a dimensionless response"):
        _ = plain.hz
