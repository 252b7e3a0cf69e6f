"""Sliding within the contacts of a bearing: against slow twins and closed forms, beside SKF; slip of the cage."""

import math

import numpy as np
import pytest
from balls import OF_6205
from scipy.special import ellipe

from ehlcontact import InputError, Lubricant, OperatingPoint
from ehlcontact.lubricant import Eyring, LimitingShear
from reduced_models import BallBearing
from reduced_models.bearing.cage_slip import cage_slip
from reduced_models.bearing.sliding import (
    SlidingContact,
    bearing_friction,
    oiled_state,
    radius_across,
    sliding_contact,
)

OIL = Lubricant.iso_vg(68, temperature=60.0)
POINT = OperatingPoint.ball_bearing(OIL, **OF_6205, speed_rpm=3000.0, load=300.0)
ACROSS = radius_across(0.52, 7.94e-3)
LAW = LimitingShear(0.07)  # the one traction parameter of docs/notes/traction.md
STIFF = LimitingShear(0.001)  # reaches its limit at once: Coulomb's friction


@pytest.fixture(scope="module")
def bearing():
    """6205 in the middle of the clearance CN."""
    return BallBearing.catalogue("6205", oil=OIL, clearance=12e-6)


def twin(point, film, law, slip, spin):
    """Traction along rolling and power by a sum over squares of the ellipse, Roelands' law written out."""
    s, oil, n = point.scales, point.lubricant, 300
    u, z = 0.5 * point.u_sum, oil.alpha * 1.96e8 / (math.log(oil.eta0) + 9.67)
    X, Y = np.meshgrid(*2 * ((np.arange(n) + 0.5) * 2.0 / n - 1.0,))
    inside = X**2 + Y**2 < 1.0
    p = s.pressure * np.sqrt(np.maximum(1.0 - X**2 - Y**2, 0.0))
    eta = np.exp((math.log(oil.eta0) + 9.67) * (1.0 + p / 1.96e8) ** z - 9.67)
    rx, y = point.geometry.radius_x, s.b * Y
    along = u * (slip + y * y / (2.0 * ACROSS * rx) + spin * y / rx)
    across = -u * spin * s.a * X / rx
    speed = np.hypot(along, across)
    newton = eta * speed / film
    if isinstance(law, Eyring):
        stress = law.stress * np.arcsinh(newton / law.stress)
    else:
        most = law.coefficient * p + 1e-300
        stress = most * (1.0 - np.exp(-newton / most))
    cell = s.a * s.b * (2.0 / n) ** 2
    return cell * (stress * along / speed)[inside].sum(), cell * (stress * speed)[inside].sum()


@pytest.mark.parametrize("law", [Eyring(5e6), LAW], ids=lambda law: type(law).__name__)
@pytest.mark.parametrize(("slip", "spin"), [(-0.004, 0.0), (0.01, 0.0), (-0.003, 0.05)])
def test_against_its_twin(law, slip, spin):
    contact = SlidingContact(POINT, 0.25e-6, law, ACROSS, spin)
    traction, power = twin(POINT, 0.25e-6, law, slip, spin)
    assert contact.power(slip) == pytest.approx(power, rel=5e-3)
    # what is left of both signs: its error is that of the whole
    assert contact.traction(slip) == pytest.approx(traction, abs=5e-3 * LAW.coefficient * POINT.load)


def test_two_lines_roll():
    """Free: no traction; the race is slower in the middle, so the slip changes its sign twice across."""
    contact = SlidingContact(POINT, 0.25e-6, LAW, ACROSS)
    slip = contact.slip()
    largest = POINT.scales.b**2 / (2.0 * ACROSS * POINT.geometry.radius_x)
    assert -largest < slip < 0.0
    assert contact.traction(slip) == pytest.approx(0.0, abs=1e-6 * contact.traction(0.1))
    assert contact.traction(contact.slip(2.0)) == pytest.approx(2.0, rel=1e-6)


def test_spin_under_coulomb_friction():
    """Moment 3/8 mu Q b E of a contact that only spins (Harris, Rolling Bearing Analysis, ch. 8)."""
    spin, s = 0.2, POINT.scales
    power = SlidingContact(POINT, 0.1e-6, STIFF, 1e6, spin).power(0.0)
    angular = spin * 0.5 * POINT.u_sum / POINT.geometry.radius_x
    moment = 0.375 * 0.001 * POINT.load * s.b * ellipe(1.0 - (s.a / s.b) ** 2)
    assert power == pytest.approx(moment * angular, rel=0.01)


def test_differential_slip_under_coulomb_friction():
    """Power grows as load^(5/3), as SKF's sliding moment, where the limiting stress is reached everywhere."""
    lighter = OperatingPoint(POINT.geometry, OIL, POINT.load / 8.0, POINT.u_sum)
    heavy, light = (SlidingContact(one, 1e-12, STIFF, ACROSS) for one in (POINT, lighter))
    assert heavy.power(heavy.slip()) == pytest.approx(32.0 * light.power(light.slip()), rel=0.01)


@pytest.mark.literature
@pytest.mark.parametrize("rpm", [3000.0, 10_000.0])
@pytest.mark.parametrize("load", [1000.0, 2000.0])
def test_sliding_part_beside_skf(bearing, rpm, load):
    """One traction parameter: the sliding moment is SKF's within 12 %, where films are full."""
    found = bearing_friction(bearing, (0.0, -load), speed_rpm=rpm, law=LAW)
    assert found.sliding == pytest.approx(found.skf_sliding, rel=0.12)
    assert found.sliding == pytest.approx(found.by_contact.sum(), rel=1e-12)
    assert found.total == pytest.approx(found.rolling + found.sliding)
    assert 0.8 < found.inlet_heat < 1.0
    assert repr(found).startswith("BearingFriction: rolling ")


@pytest.mark.literature
@pytest.mark.slow
def test_sum_beside_skf(bearing):
    """1000 to 10 000 rev/min, 100 to 2000 N: 11 of 16 within 20 %, all .66 to 1.52 (docs/notes/traction.md)."""
    ratios = []
    for rpm in (1000.0, 3000.0, 6000.0, 10_000.0):
        for load in (100.0, 500.0, 1000.0, 2000.0):
            found = bearing_friction(bearing, (0.0, -load), speed_rpm=rpm, law=LAW)
            ratios.append(found.total / found.skf_total)
    off = np.abs(np.array(ratios) - 1.0)
    assert (off < 0.2).sum() == 11
    assert min(ratios) == pytest.approx(0.66, abs=0.01)
    assert max(ratios) == pytest.approx(1.52, abs=0.01)


def test_spin_of_an_axial_load(bearing):
    """Under an axial load all balls spin; without spin less is lost."""
    state = oiled_state(bearing, (0.0, 0.0, 500.0), 3000.0, LAW)
    spinning = sliding_contact(bearing, state, 0, 0, LAW)
    still = SlidingContact(
        bearing.race("inner").point(float(state.force[0, 0]), 3000.0), float(state.h_central[0, 0]), LAW, ACROSS
    )
    assert abs(state.spin_to_roll[0, 0]) > 0.01
    assert spinning.power(spinning.slip()) > 1.2 * still.power(still.slip())
    found = bearing_friction(bearing, (0.0, 0.0, 500.0), speed_rpm=3000.0, law=LAW)
    assert found.by_contact[:, 0] == pytest.approx(found.by_contact[0, 0], rel=1e-3)


@pytest.mark.long
def test_cage_slip(bearing):
    """Without drag the cage is a little faster the heavier the load; drag slows it down, less under more load."""
    free = [cage_slip(bearing, (0.0, -load), speed_rpm=1500.0, law=LAW) for load in (100.0, 500.0)]
    assert -0.005 < free[1] < free[0] < 0.0
    light, heavy = (
        cage_slip(bearing, (0.0, -load), speed_rpm=1500.0, law=LAW, drag=3.0) - slip
        for load, slip in zip((100.0, 500.0), free, strict=True)
    )
    assert light > 3.0 * heavy > 0.0
    with pytest.raises(InputError, match=r"drag = 1000.0: must be below .* N, what the traction"):
        cage_slip(bearing, (0.0, -100.0), speed_rpm=1500.0, law=LAW, drag=1000.0)


def test_bad_input(bearing):
    for call in (bearing_friction, cage_slip):
        with pytest.raises(InputError, match=r"law = 0\.07"):
            call(bearing, (0.0, -100.0), speed_rpm=1000.0, law=0.07)
        with pytest.raises(InputError, match="oil = None"):
            call(BallBearing.catalogue("6205"), (0.0, -100.0), speed_rpm=1000.0, law=LAW)
        with pytest.raises(InputError, match="speed_rpm"):
            call(bearing, (0.0, -100.0), speed_rpm=math.nan, law=LAW)
    with pytest.raises(InputError, match=r"drag = -1\.0"):
        cage_slip(bearing, (0.0, -100.0), speed_rpm=1000.0, law=LAW, drag=-1.0)
    with pytest.raises(InputError, match="load = 3"):
        cage_slip(bearing, (0.0, -100.0, 10.0), speed_rpm=1000.0, law=LAW)
    plain = BallBearing.catalogue("6205", oil=Lubricant(0.03, 2e-8))
    with pytest.raises(InputError, match="temperature_slope"):
        bearing_friction(plain, (0.0, -100.0), speed_rpm=1000.0, law=LAW)
    assert bearing_friction(plain, (0.0, -100.0), speed_rpm=1000.0, law=LAW, heat=False).inlet_heat == 1.0
