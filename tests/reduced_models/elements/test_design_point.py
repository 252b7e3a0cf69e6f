"""Speed, oil, load and band that an element was made for: one warning where it is used for others."""

import linecache
import math
from dataclasses import asdict, replace

import numpy as np
import pytest
from balls import OF_6205

from ehlcontact import InputError, Lubricant, OperatingPoint, read, save
from reduced_models import (
    ContactMount,
    OutsideValidityWarning,
    jeffcott_rotor,
    simulate_oscillator,
    simulate_rotor,
)
from reduced_models.atlas.atlas_elements import damper_band
from reduced_models.atlas.frequency_curve import FrequencyCurve
from reduced_models.elements.design_point import DesignPoint

OIL = Lubricant(0.037, 2e-8)
POINT = OperatingPoint.ball_bearing(OIL, **OF_6205, speed_rpm=3000, load=486)
FASTER = OperatingPoint.ball_bearing(OIL, **OF_6205, speed_rpm=6000, load=486)
THINNER = OperatingPoint.ball_bearing(Lubricant(0.02, 2e-8), **OF_6205, speed_rpm=3000, load=486)
HEAVIER = OperatingPoint.ball_bearing(OIL, **OF_6205, speed_rpm=3000, load=800)
BODY = {"disc_mass": 40.0, "journal_mass": 2.0, "shaft_stiffness": 2.5e7, "load": (0.0, -100.0)}


def rotor(**changes):
    return jeffcott_rotor(bearings=1, **(BODY | {"unbalance": 8e-4, "speed_rpm": 3000.0} | changes))


@pytest.fixture(params=["wide", "memory", "cubic"])
def element(shipped, request):
    return shipped.element(POINT, request.param, **({"rpm": 3000} if request.param == "cubic" else {}))


def test_speed_and_oil_in_si_without_dimensions_and_from_the_file(element, shipped, tmp_path):
    made = element.design_point
    assert made.u_sum == pytest.approx(POINT.u_sum) and (made.eta0, made.alpha) == (0.037, 2e-8)
    assert read(save(element, tmp_path / "e.json")).design_point == made
    plain = shipped.element(POINT.moes, "memory")
    assert plain.design_point == replace(made, u_sum=None)
    assert plain.to_si(POINT.scales).design_point.u_sum == pytest.approx(POINT.u_sum)
    assert replace(element, source=None, units=element.units).design_point == DesignPoint()


@pytest.mark.parametrize(
    ("point", "words"),
    [
        (FASTER, r"u_sum = 11\.76 m/s \(made for 5\.879 m/s\)$"),
        (THINNER, r"eta0 = 0\.02 Pa s \(made for 0\.037 Pa s\)$"),
        (FASTER.moes, r"L = 22\.48 \(made for 18\.9\)$"),
    ],
)
def test_another_speed_or_oil_warns_once(element, point, words):
    with pytest.warns(OutsideValidityWarning, match=f"another contact than it was made for: {words}") as told:
        element.check(point)
        element.check(point)
    assert len(told) == 1 and told[0].filename == __file__


def test_the_own_point_and_another_load_of_a_wide_element_are_no_news(shipped):
    shipped.element(POINT, "wide").check(HEAVIER, hz=50)
    for model in ("wide", "memory"):
        for point in (POINT, POINT.moes):
            shipped.element(POINT, model).check(point, rpm=3000)
            shipped.element(POINT.moes, model).check(point)


def test_another_load_than_that_of_a_memory_names_the_wide_element(shipped):
    with pytest.warns(OutsideValidityWarning, match=r"force 800 N \(fitted 437.4 to 534.6 N\).*model 'wide'"):
        shipped.element(POINT, "memory").check(HEAVIER)
    with pytest.warns(OutsideValidityWarning, match=r"model 'wide'"):
        memory = shipped.element(POINT, "memory")
        memory.advance(1e-5, 1.5 * memory.approach_at(486.0), 0.0)


def test_the_path_of_an_integrator_of_ones_own(element):
    """`force` and `state_rates` of single states; what tries places (`continuous`) and arrays is not told."""
    far = 6.0 * element.approach_at(486.0)
    states = np.zeros(element.state_count)
    element.state_rates(states, element.approach_at(486.0), 0.0)
    element.continuous(states, far, 0.0), element.step_tangents(1e-5, far, 0.0)
    calls = [lambda e: e.state_rates(states, far, 0.0)]
    if element.state_count == 0:
        calls += [lambda e: e.force(far, 0.0), lambda e: e.force(np.float64(far), 0)]
        element.force(np.full(3, far), 0.0)
    for call in calls:
        fresh = element.copy()
        with pytest.warns(OutsideValidityWarning, match=r"used outside .*approach .*, force ") as told:
            for _ in range(3):
                call(fresh)
        assert len(told) == 1 and told[0].filename == __file__


def test_force_beyond_the_load_band_warns_though_approach_and_rate_are_inside(element):
    u = element.approach_at(486.0)
    strict = replace(element, load_range=(600.0, 700.0))
    with pytest.warns(OutsideValidityWarning, match=r"box: force 486 N \(fitted 600 to 700 N\)"):
        for _ in range(2):
            strict.state_rates(np.zeros(strict.state_count), u, 0.0)


def test_speed_of_a_rotor_is_checked_before_the_run(shipped):
    fast = shipped.element(POINT, "cubic", hz=25e3)  # of the contact's own band
    for start in (lambda: simulate_rotor(rotor().on([fast.copy()]), dt=1e-4, until=2e-4),
                  lambda: rotor().on([fast.copy()]).check_contacts()):  # fmt: skip
        with pytest.warns(
            OutsideValidityWarning, match=r": 50 Hz \(fitted 23420 to 25940 Hz\); it is for the band"
        ):
            start()
    for model, at in (("cubic", {"rpm": 3000}), ("memory", {}), ("wide", {})):
        rotor(speed_rpm=1000.0).on([shipped.element(POINT, model, **at)]).check_contacts()
    rotor(speed_rpm=0.0).on([fast]).check_contacts()


def test_a_warning_is_at_the_line_of_the_call(shipped):
    cubic, wide = shipped.element(POINT, "cubic", hz=25e3), shipped.element(POINT, "wide")
    far = 6.0 * cubic.approach_at(486.0)
    calls = {
        "simulate_rotor": lambda: simulate_rotor(rotor().on([cubic.copy()]), dt=1e-4, until=2e-4),
        "check_contacts": lambda: rotor(point=FASTER).on([wide.copy()]).check_contacts(),
        "simulate_oscillator": lambda: simulate_oscillator(cubic.copy(), [0.0, 1e-5], mass=1.0, u0=far),
    }
    for name, call in calls.items():
        with pytest.warns(OutsideValidityWarning) as told:
            call()
        assert {one.filename for one in told} == {__file__}
        assert all(name in linecache.getline(__file__, one.lineno) for one in told)


def test_operating_point_of_a_mount_is_checked(shipped):
    wide = shipped.element(POINT, "wide")
    with pytest.warns(OutsideValidityWarning, match="u_sum = 11.76 m/s"):
        rotor(point=FASTER).on([wide]).check_contacts()
    vee = jeffcott_rotor(half_angle=0.35, point=THINNER, **BODY)
    with pytest.warns(OutsideValidityWarning, match=r"eta0 = 0\.02") as told:
        vee.on([wide.copy(), shipped.element(POINT.moes, "wide").to_si(POINT.scales)]).check_contacts()
    assert len(told) == 2
    with pytest.raises(InputError, match=r"^point = '6205'"):
        ContactMount(0.0, point="6205")


def test_every_reason_warns_once(shipped):
    memory = shipped.element(POINT, "memory")
    with pytest.warns(OutsideValidityWarning) as told:
        memory.advance(1e-5, 2.0 * memory.high, 0.0)
        memory.check(FASTER, hz=1e6)
        memory.check(FASTER, hz=1e6)
    assert [str(w.message).split(":")[0].rsplit(" ", 2)[-2:] for w in told] == [
        ["validity", "box"], ["made", "for"], ["validity", "box"]
    ]  # fmt: skip
    assert "Hz" in str(told[2].message) and "approach" not in str(told[2].message)


def test_band_of_a_damper_is_where_it_is_right(shipped):
    answer = shipped.at(POINT).dimensionless
    for w in (0.0, 0.012, 1.0, 6.0, 60.0):
        low, high = damper_band(answer.omega, FrequencyCurve(answer.omega, answer.damping), w)
        inside = np.linspace(low, high, 50)
        C = answer.impedance(Omega=inside).damping / answer.impedance(Omega=w).damping
        assert low <= w <= high and np.all(np.abs(C - 1.0) <= 0.05)
    si = shipped.element(POINT, "cubic", rpm=3000)
    assert si.omega_range[0] == 0.0 and si.omega_range[1] > 2.0 * 100 * math.pi
    assert si.source["scales"] == asdict(POINT.scales)


def test_memoryless_elements_have_one_damping(shipped):
    si = shipped.element(POINT, "cubic", rpm=3000)
    found = si.impedance(hz=[0.0, 10.0, 50.0])[1:]
    Z = found.value
    np.testing.assert_allclose(found.damping, si.C1)
    np.testing.assert_allclose(found.hz, [10.0, 50.0])
    np.testing.assert_allclose(found.stiffness, si.spring_tangent(si.approach_at(486.0)))
    assert si.impedance(Omega=2 * math.pi * 50 * POINT.scales.time).value == pytest.approx(Z[1:], rel=1e-12)
    unknown = replace(si, source=None)
    assert unknown.impedance(rpm=3000, load=486.0).value == pytest.approx(Z[1:], rel=1e-9)
    with pytest.raises(InputError, match=r"^load = None: must be given in N"):
        unknown.impedance(rpm=3000)
    with pytest.raises(InputError, match=r"^Omega = 1.0: must be left out: .*give omega, hz or rpm"):
        unknown.impedance(Omega=1.0, load=486.0)
    with pytest.raises(InputError, match=r"^frequency = 314.0: must be named with its unit"):
        si.impedance(314.0)
    with pytest.raises(InputError, match=r"^hz = 50: must be left out: a dimensionless contact"):
        shipped.element(POINT.moes, "memory").impedance(hz=50)
