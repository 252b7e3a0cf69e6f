"""Rating life: the standard's formulas on loads by hand, systems, spectra, runs, and what is refused."""

import re
from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from refusals import refused

from ehlcontact import Lubricant, OilLayer, read, save
from reduced_models import BallBearing, BearingMount, BearingSet, Rotor, life_of_spectrum, simulate_rotor
from reduced_models.bearing.skf_friction import friction_under, skf_friction
from reduced_models.life import life_modification as factors
from reduced_models.life.bearing_life import BallLoads, life_of_bearing
from reduced_models.life.equivalent_load import axial_factors, dynamic_load, static_load
from reduced_models.life.load_ratings import GIVEN, dynamic_rating, fatigue_load_limit, fc_factor

OIL = Lubricant.iso_vg(68, temperature=50.0)
ROUGH = {"oil": OIL, "rq_ball": 5e-8, "rq_race": 2e-7}
DRY = BallBearing.catalogue("6205")
WET = BallBearing.catalogue("6205", **ROUGH)


def state(load=(0.0, -1000.0), speed_rpm=3000.0, bearing=WET):
    return bearing.equilibrium(load, speed_rpm=speed_rpm)


def test_lives_by_hand():
    """All balls alike: the rated loads of both races make L = ((Q/Qci)^(10/3) + (Q/Qce)^(10/3))^-0.9."""
    loads = BallLoads.at_rest(np.full((9, 2), 400.0), np.array([0.0, -900.0, 500.0, 0.0, 0.0]), 1500.0)
    life = life_of_bearing(DRY.tables.internals, loads, dynamic_rating=14e3)
    by_hand = ((400.0 / life.q_ci) ** (10 / 3) + (400.0 / life.q_ce) ** (10 / 3)) ** -0.9
    assert life.l10r == pytest.approx(by_hand, rel=1e-14)
    assert life.l10rh == pytest.approx(by_hand * 1e6 / (60.0 * 1500.0), rel=1e-14)
    assert (14e3 / life.reference_load) ** 3 == pytest.approx(life.l10r, rel=1e-12)
    ratio = 1.044 * ((1 - DRY.gamma) / (1 + DRY.gamma)) ** 1.72
    assert life.q_ci == pytest.approx(14e3 / (0.407 * 9) * (1 + ratio ** (10 / 3)) ** 0.3, rel=1e-12)
    assert life.q_ce == pytest.approx(14e3 / (0.389 * 9) * (1 + ratio ** (-10 / 3)) ** 0.3, rel=1e-12)


def test_means_of_balls_have_the_exponents_of_their_races():
    force = np.array([[100.0, 100.0], [0.0, 50.0], [300.0, -1.0]])
    loads = BallLoads.at_rest(force, np.array([0.0, -300.0]), 0.0)
    assert loads.inner == pytest.approx(((100.0**3 + 300.0**3) / 3) ** (1 / 3), rel=1e-14)
    assert loads.outer == pytest.approx(((100.0 ** (10 / 3) + 50.0 ** (10 / 3)) / 3) ** 0.3, rel=1e-14)


def test_ratings_name_their_source():
    assert state().life().ratings.dynamic == 14e3 and "NSK" in state().life().ratings.dynamic_source
    others = replace(WET, balls=8)
    assert state(bearing=others).life().ratings.dynamic == dynamic_rating(others.tables.internals)
    assert state().life(dynamic_rating=13e3, static_rating=7e3, fatigue_limit=300.0).ratings.to_dict() == {
        "dynamic": 13e3, "static": 7e3, "fatigue_limit": 300.0,
        "dynamic_source": GIVEN, "static_source": GIVEN, "fatigue_source": GIVEN,
    }  # fmt: skip
    assert fatigue_load_limit(2200.0, 0.05) == 100.0 and fatigue_load_limit(2200.0, 0.4) == 50.0


def test_grooves_and_large_balls_change_the_rating():
    assert fc_factor(0.2, 0.51, 0.52) == fc_factor(0.2, 0.52, 0.52) > fc_factor(0.2, 0.52, 0.54)
    assert fc_factor(0.2, 0.52, 0.52) > fc_factor(0.2, 0.54, 0.52)
    sizes = {"balls": 8, "conformity_inner": 0.52, "conformity_outer": 0.52}
    below, above = (
        dynamic_rating(BallBearing(ball_diameter=d, pitch_diameter=5.0 * d, **sizes).tables.internals)
        for d in (25.4e-3, 25.4001e-3)
    )
    assert above == pytest.approx(below, rel=1e-3)


def test_least_load_is_a_radial_one():
    """SKF's rule: an axial load may make up for a radial one below it."""
    least = state().life().least_load
    for radial, axial, needed in ((0.5, 3.0, True), (0.5, 0.0, False), (1.5, 3.0, False)):
        life = state((0.0, -radial * least, axial * least)).life()
        assert life.needs_axial_load is needed
        assert (life.equivalent_load < least) is (radial < 1.0 and axial == 0.0)


def test_viscosity_is_that_of_the_data_sheet():
    """nu [mm2/s] as the oil was given, of any density; of one known by eta0 alone with 850 kg/m3."""
    sheet = {"nu40": 100.0, "nu100": 11.2, "density_15": 950.0}
    for oil, nu in (
        (Lubricant.iso_vg(100, temperature=40.0), 100.0),
        (Lubricant.from_viscosities(**sheet, temperature=40.0), 100.0),
        (Lubricant.from_viscosities(**sheet, temperature=100.0), 11.2),
        (Lubricant(0.085), 100.0),
        (Lubricant(0.085, rho0=900.0), 0.085 / 900.0 * 1e6),
    ):
        bearing = replace(WET, oil=oil)
        life, own = state(bearing=bearing).life(), bearing.tables.internals.kinematic_viscosity
        assert 1e6 * life.kinematic_viscosity == pytest.approx(nu, rel=1e-12)
        assert life.least_load == WET.tables.internals.least_load.at(3000.0, own)
        published = skf_friction("6205", radial=1000.0, speed_rpm=3000.0, kinematic_viscosity=own)
        assert friction_under(bearing, (0.0, -1000.0), 3000.0)["skf_rolling"] == published.rolling


def test_viscosity_ratio_of_the_standard_and_of_the_film():
    life = state().life(contamination=0.5)
    nu1 = 4500.0 * 3000.0**-0.5 * (1e3 * WET.pitch_diameter) ** -0.5
    assert life.viscosity_ratio == pytest.approx(1e6 * OIL.kinematic_viscosity / nu1, rel=1e-12)
    ratio = state().lambda_ratio[state().heaviest].min()
    assert life.film_ratio == pytest.approx(ratio**1.3, rel=1e-12)
    assert life.a_iso > life.a_iso_film > 1.0  # a rough race, and clean enough oil
    assert life.lnmr_film == pytest.approx(life.a_iso_film * life.l10r, rel=1e-14)
    slow = factors.reference_viscosity(999.9, 0.05), factors.reference_viscosity(1000.0, 0.05)
    assert slow[0] == pytest.approx(slow[1], rel=0.05)


def test_a_iso_over_the_viscosity_ratio():
    """Three regions that meet; clean oil without load and a thick film have 50, a thin film 0.1."""
    for end in (0.4, 1.0):
        below, above = (factors.life_modification(end * (1.0 + side), 0.3) for side in (-1e-9, 1e-9))
        assert below == pytest.approx(above, rel=2e-3)
    ratios = [factors.life_modification(kappa, 0.2) for kappa in (0.1, 0.2, 0.4, 0.7, 1.0, 2.0, 4.0)]
    assert all(np.diff(ratios) > 0.0) and ratios[0] == pytest.approx(0.1, rel=0.01)
    assert factors.life_modification(4.0, 5.0) == factors.life_modification(0.5, inf) == 50.0
    by_hand = 0.1 * (1 - (2.5671 - 1.9987 / 2.0**0.071739) ** 0.83 * 0.2 ** (1 / 3)) ** -9.3
    assert factors.life_modification(2.0, 0.2) == pytest.approx(by_hand, rel=1e-12)


def test_contamination_by_class_is_cleaner_with_larger_bearings():
    grease = [factors.contamination_factor("normal cleanliness", 1.0, pitch) for pitch in (0.02, 0.05, 0.2)]
    assert all(np.diff(grease) > 0.0) and 0.0 < grease[0] and grease[-1] < 1.0
    words = ("high cleanliness", "normal cleanliness", "slight contamination", "severe contamination")
    assert all(np.diff([factors.contamination_factor(one, 1.0, 0.06) for one in words]) < 0.0)
    assert factors.contamination_factor(" Normal Cleanliness ", 1.0, 0.05) == grease[1]
    assert factors.contamination_factor("very severe contamination", 1.0, 0.02) == 0.0
    large = [factors.contamination_factor("slight contamination", 1.0, pitch) for pitch in (0.4999, 0.5)]
    assert large[1] > 1.01 * large[0]


def test_reliability_shortens_life():
    basic, sure = (state().life(contamination=0.5, reliability=one) for one in (90.0, 99.0))
    assert basic.a1 == 1.0 and sure.lnmr == pytest.approx(factors.reliability_factor(99.0) * basic.lnmr, rel=1e-14)
    assert sure.l10r == basic.l10r


def test_equivalent_loads():
    small = {"contact_angle": 0.0, "balls": 9, "ball_diameter": 10e-3}
    assert dynamic_load(1000.0, 100.0, **small) == 1000.0
    assert dynamic_load(0.0, 0.172 * 900.0, **small) == pytest.approx(2.30 * 0.172 * 900.0)
    assert axial_factors(np.radians(40.0), 3.0) == pytest.approx((0.35, 1.14, 0.57))
    assert axial_factors(np.radians(22.5), 3.0) == pytest.approx((0.42, 0.625, 0.935))
    assert axial_factors(np.radians(15.0), 1.38) == pytest.approx((0.44, 0.47, 1.19))
    assert static_load(1000.0, 100.0, 0.0) == 1000.0 and static_load(100.0, 1000.0, 0.0) == 560.0


def test_static_safety_from_the_pressure():
    """Under C0 of its geometry the most loaded ball of a bearing without clearance has some 4.2 GPa."""
    c0 = 7948.255
    life = DRY.equilibrium((0.0, -c0)).life(static_rating=c0)
    assert life.static_safety == pytest.approx(1.0, rel=1e-6)
    assert life.pressure_safety == pytest.approx(5.0 / 4.37, rel=0.05)  # Stribeck's 5 has room for clearance


def test_ratings_of_a_bearing_are_those_of_its_maker():
    """Given with the bearing, in sets and files too; C0 stays NSK's where C alone is given."""
    own = BallBearing.catalogue("6205", dynamic_rating=14.8e3)
    life = own.equilibrium((0.0, -1000.0)).life()
    plain = BallBearing.catalogue("6205").equilibrium((0.0, -1000.0)).life()
    assert (life.ratings.dynamic, life.ratings.dynamic_source) == (14.8e3, "given")
    assert (life.ratings.static, life.ratings.static_source) == (7850.0, plain.ratings.static_source)
    assert life.l10r == pytest.approx(plain.l10r * (14.8 / 14.0) ** 3, rel=1e-12)
    assert own.equilibrium((0.0, -1000.0)).life(dynamic_rating=14e3).l10r == plain.l10r
    assert BallBearing.from_dict(own.to_dict()) == own
    pair = BearingSet.pair(BallBearing.catalogue("7205 C", dynamic_rating=18e3, static_rating=11e3), preload=200.0)
    ratings = [one.ratings for one in pair.equilibrium((0.0, -500.0, 100.0)).life()]
    assert [(one.dynamic, one.static) for one in ratings] == [(18e3, 11e3)] * 2


def test_a_set_lives_shorter_than_each_bearing():
    pair = BearingSet.pair(BallBearing.catalogue("7205 C", **ROUGH), preload=200.0)
    system = pair.equilibrium((0.0, -500.0, 100.0), speed_rpm=6000.0).life(contamination=0.5)
    each = [one.l10rh for one in system]
    assert len(system) == 2 and system[1].l10rh == each[1]
    assert system.l10rh == pytest.approx(sum(one ** (-10 / 9) for one in each) ** -0.9, rel=1e-14)
    assert system.l10rh < min(each)
    assert system.lnmrh < min(one.lnmrh for one in system)
    assert [one["name"] for one in system.to_dict()["bearings"]] == ["bearing 0", "bearing 1"]


def test_a_spectrum_of_two_loads_by_hand():
    heavy, light = state(), state((0.0, -500.0), 1500.0)
    found = life_of_spectrum([(0.3, heavy), (0.7, light)], contamination=0.5)
    lives = heavy.life(contamination=0.5), light.life(contamination=0.5)
    assert found.l10rh == pytest.approx(1.0 / (0.3 / lives[0].l10rh + 0.7 / lives[1].l10rh), rel=1e-14)
    assert found.lnmrh == pytest.approx(1.0 / (0.3 / lives[0].lnmrh + 0.7 / lives[1].lnmrh), rel=1e-14)
    assert found.speed_rpm == pytest.approx(0.3 * 3000.0 + 0.7 * 1500.0, rel=1e-14)
    assert found.l10r == pytest.approx(found.l10rh * 60e-6 * found.speed_rpm, rel=1e-14)
    assert sum(found.damage) == pytest.approx(1.0) and found.damage[0] > 0.8
    alone = life_of_spectrum([(1.0, heavy)])
    assert alone.l10rh == pytest.approx(heavy.life().l10rh, rel=1e-14) and alone.lnmrh is None
    assert found.to_dict()["states"][1]["share"] == 0.7


def test_no_load_lives_for_ever():
    idle = life_of_bearing(DRY.tables.internals, BallLoads.at_rest(np.zeros((9, 2)), np.zeros(2), 1000.0))
    assert idle.l10r == inf == idle.l10 and idle.to_dict()["l10r"] is None and "infinite" in repr(idle)
    assert idle.static_safety == inf == idle.pressure_safety


@pytest.mark.long
def test_what_the_standard_does_not_cover_is_said():
    def said(**changes):
        load, speed = changes.pop("load", (0.0, -1000.0)), changes.pop("speed_rpm", 3000.0)
        found = state(load, speed, replace(WET, **changes)).life(contamination=0.5)
        return "; ".join(found.not_covered)

    assert said() == ""
    assert "ceramic" in said(density=3200.0)
    assert "starved" in said(supply=OilLayer(over_flooded=1.0))
    assert "lambda" in said(rq_race=1e-6)
    assert "skid" in said(load=(0.0, -50.0))
    assert "C/2" in said(load=(0.0, -8000.0)) and "n dm" in said(oil=None, speed_rpm=26000.0)
    slow = state((0.0, -1000.0), 100.0, DRY).life(contamination=0.5, kinematic_viscosity=1e-6)
    assert slow.viscosity_ratio < 0.1 and slow.a_iso is None and "below 0.1" in "; ".join(slow.not_covered)
    tilted = WET.equilibrium((0.0, -1000.0, 500.0), speed_rpm=3000.0, tilt=(4e-3, 0.0)).life()
    assert any("misalignment 4 mrad" in text for text in tilted.not_covered)


def test_life_survives_its_file(tmp_path):
    path = tmp_path / "state.h5"
    save(state(), path)
    assert read(path).life(contamination=0.5).to_dict() == state().life(contamination=0.5).to_dict()


def rotor_on(bearing, load):
    free = {"x": 0, "y": 1} if len(load) == 2 else {"x": 0, "y": 1, "z": 2, "tilt_x": 3, "tilt_y": 4}
    mass = np.diag([1.0, 1.0, 1.0, 1e-3, 1e-3][: len(load)])
    mounts = (BearingMount(bearing=bearing, **free),)
    return Rotor(mass=mass, stiffness=np.zeros(mass.shape), load=load, mounts=mounts)


def run_over_passages(bearing, load, speed_rpm, passages=9, steps=96):
    passage = (
        60.0 / speed_rpm / (bearing.equilibrium(load, speed_rpm=speed_rpm).orders or bearing.orders).bpfo_order
    )
    rotor = rotor_on(bearing, load)
    return simulate_rotor(rotor, speed_rpm=speed_rpm, dt=passage / steps, until=passages * passage)


@pytest.mark.parametrize("load", [(0.0, -1000.0), (0.0, -800.0, 500.0, 0.0, 0.0)])
def test_a_run_of_a_constant_load_has_the_static_life(load):
    """Balls pass all places of the load zone: the mean of the static states of the cage over a passage."""
    bearing = replace(DRY, clearance=10e-6)
    life = run_over_passages(bearing, load, 30.0).life()[0]
    angles = -pi / 2.0 + 2.0 * pi / 9.0 / 96.0 * np.arange(96)
    places = [bearing.equilibrium(load, speed_rpm=30.0, cage_angle=one).life() for one in angles]
    inner = np.mean([one.q_ei**3 for one in places]) ** (1 / 3)
    outer = np.mean([one.q_ee ** (10 / 3) for one in places]) ** 0.3
    static = replace(places[0], loads=replace(places[0].loads, inner=inner, outer=outer))
    assert life.l10r == pytest.approx(static.l10r, rel=1e-6)
    assert life.loads.radial == pytest.approx(-load[1], rel=1e-5)


def test_a_run_in_oil_under_axial_load_has_the_static_life(tmp_path):
    """All balls alike, at any place of the cage; a file keeps what life needs."""
    load = (0.0, 0.0, 1000.0, 0.0, 0.0)
    run = run_over_passages(WET, load, 1200.0, passages=2, steps=40)
    life, static = run.life(contamination=0.5)[0], state(load, 1200.0).life(contamination=0.5)
    assert life.l10r == pytest.approx(static.l10r, rel=1e-6)
    assert life.lnmrh == pytest.approx(static.lnmrh, rel=1e-6) and life.film_ratio is None
    assert run.life(rotating_load=True)[0].l10r == pytest.approx(life.l10r, rel=1e-12)
    save(run, tmp_path / "run.h5")
    assert read(tmp_path / "run.h5").life(contamination=0.5).to_dict() == run.life(contamination=0.5).to_dict()


def test_each_ball_has_its_mean_load():
    """Over a whole turn of the cage all balls have met the same loads."""
    run = run_over_passages(replace(DRY, clearance=10e-6), (0.0, -1000.0), 30.0)
    means = run.ball_bearings[0].mean_loads
    assert means.shape == (9, 2, 2)
    np.testing.assert_allclose(means, np.broadcast_to(means[:1], means.shape), rtol=1e-4)
    assert (means[..., 1] > means[..., 0]).all()


CALLS = {
    "C in kN": lambda: state().life(dynamic_rating=14.0),
    "C0 in kN": lambda: state().life(static_rating=7.85),
    "Cu in kN": lambda: state().life(fatigue_limit=0.335),
    "contamination beyond 1": lambda: state().life(contamination=1.2),
    "contamination of 0": lambda: state().life(contamination=0.0),
    "contamination in percent": lambda: state().life(contamination=50.0),
    "contamination unknown": lambda: state().life(contamination="dirty"),
    "viscosity ratio outside": lambda: state().life(viscosity_ratio=5.0),
    "viscosity ratio below": lambda: state().life(viscosity_ratio=0.05),
    "viscosity in mm2/s": lambda: state().life(kinematic_viscosity=68.0),
    "states that are a number": lambda: life_of_spectrum(5),
    "a share below 0": lambda: life_of_spectrum([(1.5, state()), (-0.5, state())]),
    "reliability as a share": lambda: state().life(reliability=0.95),
    "shares": lambda: life_of_spectrum([(0.3, state()), (0.6, state())]),
    "shares in percent": lambda: life_of_spectrum([(30, state()), (70, state())]),
    "no states": lambda: life_of_spectrum([]),
    "no states but numbers": lambda: life_of_spectrum([(1.0, 2.0)]),
    "state without bearing": lambda: replace(state(), internals=None).life(),
    "run without ball bearings": lambda: replace(
        run_over_passages(DRY, (0.0, -1000.0), 30.0, 1, 40), ball_bearings=()
    ).life(),
}
MESSAGES = {
    "C in kN": "dynamic_rating = 14.0: must be in N, near that of the geometry, 14 030 N; did you mean 14 000 N?",
    "C0 in kN": "did you mean 7 850 N?",
    "Cu in kN": "did you mean 335 N?",
    "contamination beyond 1": "contamination = 1.2: must be above 0 and at most 1",
    "contamination of 0": "contamination = 0.0: must be above 0 and at most 1",
    "contamination in percent": "50 % is 0.5",
    "contamination unknown": "normal cleanliness",
    "viscosity ratio outside": "viscosity_ratio = 5.0: must be between 0.1 and 4",
    "viscosity ratio below": "viscosity_ratio = 0.05: must be between 0.1 and 4",
    "viscosity in mm2/s": "in mm2/s? then 6.8e-05 m2/s",
    "states that are a number": "states = 5: must be pairs of a share of the time and a state",
    "a share below 0": "shares = -0.5: must be a finite number >= 0",
    "reliability as a share": "did you mean 95?",
    "shares": "shares = [0.3, 0.6]: must be 1 in sum, not 0.9",
    "shares in percent": "did you mean percent?",
    "no states": "pairs of a share of the time and a state",
    "no states but numbers": "states of a bearing or a set",
    "state without bearing": "one that `equilibrium` of a bearing made",
    "run without ball bearings": "one of a rotor on ball bearings",
}


@pytest.mark.parametrize("case", CALLS)
def test_refusals(case):
    refused(re.escape(MESSAGES[case]), CALLS[case])
