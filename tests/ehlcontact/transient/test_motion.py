"""Loads, defaults, bad input and the stored form of every motion."""

import pickle
from dataclasses import replace
from math import pi

import numpy as np
import pytest

from ehlcontact import (
    FreeVibration,
    Geometry,
    HarmonicLoad,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedApproach,
    PrescribedLoad,
    RampLoad,
    SpeedHistory,
    simulate,
)
from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.prescribed import unit_hint

NAN, INF = float("nan"), float("inf")
T = np.linspace(0.0, 2.0, 9)


def test_free_vibration_defaults():
    motion = FreeVibration(Omega_n=5.13)
    assert motion.period == pytest.approx(5.13 / 5.13, rel=1e-3)
    assert motion.initial_rate == pytest.approx(0.1 * 1.5**0.5 * 5.13)
    assert FreeVibration(Omega_n=5.13, offset=0.1).initial_rate == 0.0
    assert FreeVibration(Omega_n=5.13, rate=-0.2).initial_rate == -0.2
    assert motion.load(3.0) == 1.0
    assert motion.default_end == pytest.approx(2.5 * motion.period)
    assert motion.default_step <= motion.period / 40
    assert motion.largest_load >= 1.15 - 1e-12


def test_free_vibration_starts_by_closing_or_opening():
    closing, opening = (FreeVibration(Omega_n=5.13, start=start) for start in ("closing", "opening"))
    assert closing == FreeVibration(Omega_n=5.13) == FreeVibration(Omega_n=5.13, rate=-opening.rate)
    assert opening.rate == -closing.rate and opening.size == closing.size
    assert opening.largest_load == closing.largest_load
    assert FreeVibration(Omega_n=5.13, rate=-0.2, start="opening").rate == -0.2
    in_seconds = FreeVibration.at(SI, mass=0.2, start="opening")
    assert in_seconds.rate == -FreeVibration.at(SI, mass=0.2).rate
    assert opening.to_dict() == {"kind": "free", "Omega_n": 5.13, "offset": 0.0, "rate": opening.rate}


def test_harmonic_load():
    motion = HarmonicLoad(Omega=pi, amplitude=0.2)
    assert motion.period == pytest.approx(2.0)
    assert motion.load(0.5) == pytest.approx(1.2)
    assert motion.load(1.5) == pytest.approx(0.8)
    assert motion.largest_load == pytest.approx(1.2)
    assert motion.default_end >= 2.0 + motion.period
    assert HarmonicLoad(Omega=0.01).default_step <= 0.5
    assert HarmonicLoad(Omega=50.0).default_end >= 2.0


def test_ramp_load():
    motion = RampLoad(3.67, 1.69, Omega_n=2.4)
    assert motion.load(0.0) == 1.0
    assert motion.load(0.5 * 1.69) == pytest.approx(0.5 * 4.67)
    assert motion.load(5.0) == pytest.approx(3.67)
    assert motion.default_end > motion.duration
    assert motion.largest_load >= 3.67


def test_prescribed_load():
    motion = PrescribedLoad(T, 1.0 + 0.1 * T)
    assert motion.load(0.3) == pytest.approx(1.03)
    assert motion.default_end == 2.0
    assert motion.default_step == pytest.approx(0.25)
    assert motion.largest_load == pytest.approx(1.2)
    assert PrescribedLoad.from_function(lambda t: 1.0 + t, 3.0, steps=30).load(1.5) == pytest.approx(2.5)


SI = OperatingPoint(Geometry(0.01, 0.02), Lubricant(eta0=0.04, alpha=2.2e-8), load=50.0, u_sum=2.0)


def test_tables_and_ramps_in_si():
    """Seconds, newton, metres and kilograms over the units of the point, as the frequencies of other motions."""
    s, mass = SI.scales, 0.02
    t, load = [0.0, 1e-4, 2e-4, 4e-4], [50.0, 60.0, 55.0, 50.0]
    given = PrescribedLoad.at(SI, t, load, mass=mass)
    assert given.load(1e-4 / s.time) == pytest.approx(1.2) and given.load(1.5e-4 / s.time) == pytest.approx(1.15)
    assert given.default_end * s.time == pytest.approx(4e-4)
    assert given.Omega_n == SI.Omega_n(mass) == FreeVibration.at(SI, mass=mass).Omega_n
    assert PrescribedLoad.at(SI, t, load).Omega_n is None
    driven = PrescribedApproach.at(SI, t, np.array([0.9, 0.95, 0.97, 1.0]) * s.length)
    assert driven.approach(2e-4 / s.time) == pytest.approx(0.97)
    ramp = RampLoad.at(SI, load=75.0, duration=1e-4, mass=mass)
    assert (ramp.ratio, ramp.duration * s.time) == pytest.approx((1.5, 1e-4))


IN_SI = {
    "motion": [
        FreeVibration.at(SI, mass=0.2),
        HarmonicLoad.at(SI, hz=1000.0),
        RampLoad.at(SI, load=75.0, duration=1e-4, mass=0.2),
        PrescribedLoad.at(SI, [0.0, 1e-4, 2e-4, 4e-4], [50.0, 60.0, 55.0, 50.0]),
        PrescribedApproach.at(SI, [0.0, 1e-4, 2e-4, 4e-4], [SI.scales.length] * 4),
    ],
    "speed": [SpeedHistory.at(SI, [0.0, 1e-4, 2e-4, 4e-4], [2.0, 3.0, 2.0, 2.0])],
}


@pytest.mark.parametrize(("name", "made"), [(n, one) for n, every in IN_SI.items() for one in every])
def test_what_was_made_at_a_point_is_refused_at_another(name, made):
    other = replace(SI, load=60.0)
    arguments = {"motion": HarmonicLoad(Omega=pi), name: made}
    for point in (other, other.moes):
        with pytest.raises(InputError, match=rf"^{name} = 'made at another .*{type(made).__name__}\.at\(point"):
            simulate(point, **arguments)
    for point in (SI, replace(SI), SI.moes):
        made.require_point(name, point)
    assert pickle.loads(pickle.dumps(made)).made_at == SI
    assert type(made).from_dict(made.to_dict()).made_at is None


def test_the_point_where_a_motion_was_made_is_no_part_of_it():
    made = HarmonicLoad.at(SI, hz=1000.0)
    plain = HarmonicLoad(Omega=made.Omega)
    assert (made, hash(made), repr(made), made.to_dict()) == (plain, hash(plain), repr(plain), plain.to_dict())


SECONDS = [0.0, 1e-4, 2e-4, 3e-4]
MEANT = r"{0}\(T, values\) is in .*, {0}\.at\(point, \.\.\.\) in seconds and "


@pytest.mark.filterwarnings("error")
def test_tables_that_were_meant_in_si_name_what_takes_them():
    with pytest.raises(InputError, match="^M under the largest load = .*; " + MEANT.format("PrescribedLoad")):
        simulate(SI, PrescribedLoad(SECONDS, [50.0, 5000.0, 50.0, 50.0]))
    for motion in (PrescribedLoad(SECONDS, [50.0] * 4), PrescribedApproach(SECONDS, [6.8e-6] * 4)):
        with pytest.raises(
            RuntimeWarning, match="^the motion hardly fits .*" + MEANT.format(type(motion).__name__)
        ):
            simulate(SI, motion)
        assert not unit_hint(motion, SI.moes)
    for motion in (
        PrescribedApproach(SECONDS, [0.9, 1.0, 1.1, 1.0]),
        PrescribedLoad(SECONDS, [1.0, 2.0, 1.0, 1.0]),
        PrescribedLoad.at(SI, SECONDS, [50.0, 1500.0, 50.0, 50.0]),
    ):
        assert not unit_hint(motion, SI)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: PrescribedLoad.at(SI, [1e-4, 2e-4, 3e-4, 4e-4], [50.0] * 4),
            r"t\[0\] = 0.0001: must be 0",
        ),
        (lambda: PrescribedApproach.at(SI, [0.0, 1e-4, 2e-4, 3e-4], [1e-6] * 3), "length of approach = 3"),
        (lambda: PrescribedLoad.at(MoesPoint(200, 10, 0.5), T, T), "an OperatingPoint; a dimensionless one takes"),
        (lambda: RampLoad.at(SI, load=-1.0, duration=1.0, mass=1.0), r"load = -1.0: must be"),
    ],
)
def test_bad_tables_in_si(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_load_period_is_that_of_a_load_that_swings():
    assert HarmonicLoad(Omega=pi, Omega_n=5.0).load_period == pytest.approx(2.0)
    for motion in (FreeVibration(Omega_n=5.0), RampLoad(2.0, 1.0, Omega_n=2.0), PrescribedLoad(T, 1.0 + T)):
        assert motion.load_period == INF


def test_prescribed_approach():
    motion = PrescribedApproach(T, 0.9 + 0.1 * T**2)
    assert motion.approach(0.37) == pytest.approx(0.9 + 0.1 * 0.37**2, rel=1e-12)
    assert motion.rate(0.37) == pytest.approx(0.074, rel=1e-9)
    assert motion.largest_load >= 1.3**1.5 - 1e-12


MOTIONS = [
    FreeVibration(Omega_n=5.13, offset=0.05),
    FreeVibration(Omega_n=5.13),
    HarmonicLoad(Omega=pi, amplitude=0.2, Omega_n=12.0),
    RampLoad(3.67, 1.69, Omega_n=2.4),
    PrescribedLoad(T, 1.0 + 0.1 * T, Omega_n=3.0),
    PrescribedApproach(T, 0.9 + 0.01 * T),
]


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda m: m.kind)
def test_stored_form_rebuilds_the_motion(motion):
    again = Motion.from_dict(motion.to_dict())
    assert type(again) is type(motion)
    assert again.to_dict() == motion.to_dict()
    name = "approach" if isinstance(motion, PrescribedApproach) else "load"
    for t in (0.0, 0.3, 1.9):
        assert getattr(again, name)(t) == getattr(motion, name)(t)


def test_tables_are_copied():
    values = np.ones(T.size)
    motion = PrescribedLoad(T, values)
    values[:] = 5.0
    assert motion.load(1.0) == 1.0
    assert motion.largest_load == 1.0
