"""Ball bearings under an oil supply: films, damping of either sign, and what cannot be asked."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from ehlcontact import InputError, Lubricant, OilLayer, solve_steady
from reduced_models import (
    Atlas,
    BallBearing,
    Disc,
    OilBalance,
    Shaft,
    Support,
    linearise,
    rotor_on_bearings,
    simulate_rotor,
)
from reduced_models.atlas.supply import lightest_load
from reduced_models.bearing import ross_bearing
from reduced_models.bearing.oil_and_heat import oil_and_heat
from reduced_models.bearing.race import RACES
from reduced_models.elements.validity import OutsideValidityWarning

OIL = Lubricant.iso_vg(68, temperature=50.0)
LOAD = (0.0, -1000.0)


def bearing(supply=None, **changes):
    return BallBearing.catalogue("6205", supply=supply, **{"oil": OIL} | changes)


@pytest.fixture(scope="module")
def at_r():
    return {r: bearing(OilLayer(over_flooded=r)) for r in (0.6, 1.0, 1.5)}


def test_films_are_those_of_the_atlas_at_every_ball(at_r):
    state = at_r[1.0].equilibrium(LOAD, speed_rpm=3000.0)
    for ball in np.flatnonzero(state.force[:, 0] > 1.0):
        for column, name in enumerate(RACES):
            race = at_r[1.0].race(name)
            point = race.point(float(state.force[ball, column]), 3000.0)
            answer = Atlas().at(point, supply=OilLayer(over_flooded=1.0))
            assert state.h_central[ball, column] == pytest.approx(answer.h_central, rel=1e-12)
            assert state.h_min[ball, column] == pytest.approx(answer.h_min, rel=1e-12)


@pytest.mark.long
def test_the_less_oil_the_thinner_the_film_and_the_less_the_damping(at_r):
    supplies = {**at_r, 1e4: bearing(OilLayer(over_flooded=1e4)), np.inf: bearing()}
    films, damping = [], []
    for r in sorted(supplies):
        state = supplies[r].equilibrium(LOAD, speed_rpm=3000.0)
        films.append(state.h_central[state.heaviest, 0])
        damping.append(
            supplies[r].coefficients(LOAD, speed_rpm=3000.0, cage_angle=-np.pi / 2, hz=1000).damping[0, 1, 1]
        )
    assert np.all(np.diff(films[:-1]) > 0.0) and np.all(np.diff(damping[:-1]) > 0.0)
    assert films[-2] == pytest.approx(films[-1], rel=1e-3)
    assert damping[-2] == pytest.approx(damping[-1], rel=0.02)


def test_signed_damping_is_that_of_both_contacts_of_every_ball_in_series(at_r):
    """Beside a sum over balls written out here, at one angle of the cage."""
    one, hz = at_r[1.0], np.array([50.0, 1000.0])
    found = one.coefficients(LOAD, speed_rpm=3000.0, cage_angle=-np.pi / 2, hz=hz)
    state = one.equilibrium(LOAD, speed_rpm=3000.0, cage_angle=-np.pi / 2)
    omega, Z = 2.0 * np.pi * hz, np.zeros((2, 2, 2), complex)
    for ball in np.flatnonzero(state.force[:, 0] > 1.0):
        compliance = np.zeros(2, complex)
        for column, name in enumerate(RACES):
            point = one.race(name).point(float(state.force[ball, column]), 3000.0)
            at = Atlas().at(point, supply=OilLayer(over_flooded=1.0)).impedance(hz=hz)
            compliance += 1.0 / (at.stiffness + 1j * omega * at.damping)
        n = np.array([np.cos(state.angles[ball]), np.sin(state.angles[ball])])
        Z += np.outer(n, n) / compliance[:, None, None]
    expected = Z.imag / omega[:, None, None]
    np.testing.assert_allclose(found.signed_damping[:, 1, 1], expected[:, 1, 1], rtol=0.02, atol=1.0)
    assert found.signed_damping[0, 1, 1] < 0.0 < found.signed_damping[1, 1, 1]
    assert found.damping[:, 1, 1].min() >= 0.0
    assert "below zero too" in str(found)
    assert bearing().coefficients(LOAD, speed_rpm=3000.0, hz=50).signed_damping is None
    slow = one.coefficients(LOAD, speed_rpm=3000.0, cage_angle=-np.pi / 2, hz=[0.0, 0.5]).signed_damping[:, 1, 1]
    assert slow[0] == pytest.approx(slow[1], rel=1e-3) and slow[0] < found.signed_damping[0, 1, 1]


def test_layer_in_metres_is_the_same_under_all_balls():
    one = bearing(OilLayer(0.3e-6))
    race = one.race("inner")
    shares = [race.answer(load, 3000.0).over_flooded for load in (30.0, 100.0, 400.0)]
    assert shares[0] < shares[1] < shares[2]
    faster = race.answer(100.0, 6000.0).over_flooded
    assert faster < shares[1]


def test_axial_loads_and_angular_contact_bearings():
    found = {}
    for supply in (None, OilLayer(over_flooded=1.0)):
        one = BallBearing.catalogue("7205", oil=OIL, supply=supply)
        state = one.equilibrium((100.0, 0.0, 500.0), speed_rpm=3000.0)
        found[supply] = state.h_central.max()
    assert 0.8 < found[supply] / found[None] < 0.99


def test_layer_of_an_oil_balance():
    whole = {"bearing": bearing(), "load": LOAD, "speed_rpm": 3000.0}
    starting = OilBalance(**whole)
    balance = OilBalance(**whole, feed=starting.feed_for(0.6 * starting.full_layer))
    supplied = bearing(balance.lasting_supply)
    film = supplied.equilibrium(LOAD, speed_rpm=3000.0)
    assert film.h_central[film.heaviest, 0] == pytest.approx(balance.films(balance.lasting_layer)[0], rel=0.05)
    with pytest.raises(InputError, match="without any no layer lasts"):
        _ = starting.lasting_supply
    with pytest.raises(InputError, match="lasting_supply"):
        OilBalance(bearing=supplied, load=LOAD, speed_rpm=3000.0)


def test_stored_and_read_again():
    for one in (bearing(), bearing(OilLayer(0.3e-6)), bearing(OilLayer(over_flooded=1.5))):
        again = BallBearing.from_dict(one.to_dict())
        assert again == one and again.supply == one.supply
    assert bearing().to_dict()["supply"] is None
    assert "0.3 µm" in str(bearing(OilLayer(0.3e-6))) and "flooded" in str(bearing())


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"oil": None, "supply": OilLayer(0.3e-6)}, "dry bearing"),
        ({"supply": OilLayer(H=0.1)}, "dry approaches differ from ball to ball"),
        ({"supply": OilLayer([0.1e-6, 0.2e-6], y=[0.0, 1.0])}, "profile"),
        ({"supply": 0.3e-6}, "an OilLayer"),
        ({"supply": OilLayer(0.3e-6), "conformity_inner": 0.509}, "kappa"),
    ],
)
def test_bad_supply_is_one_line(changes, words):
    with pytest.raises(InputError) as caught:
        BallBearing.catalogue("6205", **{"oil": OIL, **changes})
    assert words in str(caught.value) and "\n" not in str(caught.value)


def test_an_element_that_cannot_be_made_names_layer_and_contact(monkeypatch):
    made = bearing(OilLayer(3e-7))

    def falling(*_, **__):
        raise InputError("approach[3]", -0.88, "above the one before")

    monkeypatch.setattr(Atlas, "wide", falling)
    words = r"supply = '0\.3 µm': .* outer race at 3000 rev/min .* thicker .*layer_ratio.* approach\[3\] = -0\.88"
    with pytest.raises(InputError, match=words):
        made.element("outer", 3000.0)
    with pytest.raises(InputError, match=r"^approach\[3\]"):
        bearing().element("outer", 3000.0)


def test_what_takes_no_supply_says_so():
    with pytest.raises(InputError, match=r"bearing\.supply.*left out of the bearing"):
        oil_and_heat(
            bearing(OilLayer(over_flooded=1.0)), LOAD, speed_rpm=3000.0, supply=OilLayer(over_flooded=0.5)
        )
    with pytest.raises(InputError, match="table of oil supply"):
        bearing(OilLayer(over_flooded=1.0)).equilibrium((0.0, -9000.0), speed_rpm=3000.0)
    with pytest.raises(InputError, match="flooded films everywhere"):
        bearing(OilLayer(1e-9)).equilibrium(LOAD, speed_rpm=3000.0)


def test_modes_and_runs_in_time_have_less_damping():
    """A rotor on two bearings: the same unbalance moves it further the less oil there is."""
    decrement, reach = [], []
    for supply in (None, OilLayer(over_flooded=0.6)):
        one = bearing(supply)
        rotor = rotor_on_bearings(
            Shaft(length=0.2, diameter=0.025),
            discs=[Disc.cylinder(position=0.1, diameter=0.15, width=0.05, bore=0.025, unbalance=1e-5)],
            supports=[Support(position=0.02, bearing=one), Support(position=0.18, bearing=one)],
        )
        if supply is not None:
            with pytest.warns(OutsideValidityWarning, match="bearing 0: under this layer"):
                linearise(rotor, 3000.0)
        decrement.append(linearise(rotor, 3000.0).modes()[0].decrement)
        run = simulate_rotor(rotor, speed_rpm=3000.0, dt=1e-4, until=0.02)
        assert np.isfinite(run.ring).all()
        reach.append(np.ptp(run.ring[-100:, 0, 0]))
    assert 0.0 < decrement[1] < 0.5 * decrement[0]
    assert reach[1] > reach[0]


def starved_rotor(axial):
    """Stiff shaft and disc on 6008, preloaded by 4 um."""
    one = BallBearing.catalogue(
        "6008", oil=Lubricant.iso_vg(100, temperature=60.0), clearance=-4e-6, supply=OilLayer(over_flooded=1.0)
    )
    return rotor_on_bearings(
        Shaft(length=0.3, diameter=0.04),
        discs=[Disc.cylinder(position=0.15, diameter=0.2, width=0.05, bore=0.04)],
        supports=[Support(position=at, bearing=one) for at in (0.03, 0.27)],
        axial=axial,
    )


@pytest.mark.long
@pytest.mark.parametrize("axial", [False, True])
def test_damping_below_zero_that_elements_leave_out_is_said_once(axial):
    """Numbers are those of the heaviest contact; the solver's C changes its sign at the frequency named."""
    rotor = starved_rotor(axial)
    with pytest.warns(OutsideValidityWarning, match="damping of a contact below zero") as caught:
        linear = linearise(rotor, 9000.0)
    assert len(caught) == 1 and caught[0].filename == __file__
    words = linear.damping_left_out[0]
    assert words in str(caught[0].message) and f"bearing 0: {words}" in str(linear)
    hz, least = (float(found) for found in re.findall(r"([-\d.e+]+) (?:Hz|N s)", words))
    one = rotor.ball_bearings[0].ball_bearing
    found = one.coefficients(linear.loads[0], speed_rpm=9000.0, hz=245.0)
    assert "decrements are too high" in str(found) and found.to_dict()["damping_left_out"]
    state = one.equilibrium(linear.loads[0], speed_rpm=9000.0)
    answers = [
        one.race(name).answer(load, 9000.0) for name, load in zip(RACES, state.force.max(axis=0), strict=True)
    ]
    signs = np.array([at.impedance(hz=[0.9 * hz, 1.1 * hz]).damping for at in answers])
    assert signs[:, 0].min() < 0.0 < signs[:, 1].min()
    assert least == pytest.approx(min(at.damping.min() for at in answers), rel=0.05)
    linearise(rotor, 9000.0)  # said already: another warning would be an error here


def test_runs_in_time_say_what_elements_leave_out():
    with pytest.warns(OutsideValidityWarning, match="below zero below") as caught:
        simulate_rotor(starved_rotor(False), speed_rpm=9000.0, dt=5e-5, until=1e-3)
    assert len(caught) == 1 and caught[0].filename == __file__


def test_export_to_ross_says_what_elements_leave_out(monkeypatch):
    """With something that takes the place of ROSS, which need not be installed."""
    ross = SimpleNamespace(BearingElement=lambda **entries: SimpleNamespace(**entries))
    monkeypatch.setattr(ross_bearing, "import_ross", lambda: ross)
    with pytest.warns(OutsideValidityWarning, match="6205: under this layer") as caught:
        bearing(OilLayer(over_flooded=1.0)).to_ross(0, speeds_rpm=[2000.0, 3000.0], load=1000.0)
    assert len(caught) == 1 and caught[0].filename == __file__
    assert bearing().to_ross(0, speeds_rpm=3000.0, load=1000.0).cyy > 0.0  # flooded: no warning


def test_flooded_and_well_fed_bearings_leave_nothing_out():
    for supply in (None, OilLayer(over_flooded=10.0)):
        assert bearing(supply).coefficients(LOAD, speed_rpm=3000.0, hz=50.0).damping_left_out == ""


def test_cubic_element_says_that_it_has_no_damper():
    point = bearing().race("inner").point(400.0, 3000.0)
    with pytest.warns(OutsideValidityWarning, match=r"\(-\d.* N s/m\); the cubic element leaves it out") as caught:
        assert Atlas().element(point, "cubic", rpm=3000.0, supply=OilLayer(over_flooded=1.0)).C1 == 0.0
    assert caught[0].filename == __file__


def test_heat_and_supply_together_are_a_product():
    """T S(r/T): the same oil, in m or over the isothermal film, is more of the film that heat leaves."""
    heated = bearing(thermal=True).race("inner").answer(400.0, 10000.0)
    flooded = bearing().race("inner").answer(400.0, 10000.0)
    less = heated.h_central / flooded.h_central
    assert less < 0.97
    for supply in (OilLayer(over_flooded=0.8), OilLayer(0.4e-6)):
        both = bearing(supply, thermal=True).race("inner").answer(400.0, 10000.0)
        cold = bearing(supply).race("inner").answer(400.0, 10000.0)
        more = bearing(OilLayer(over_flooded=cold.over_flooded / less)).race("inner").answer(400.0, 10000.0)
        assert both.h_central == pytest.approx(more.h_central * less, rel=1e-9)
        assert both.over_flooded == pytest.approx(cold.over_flooded, rel=1e-12)
        assert f"a layer of {cold.over_flooded:.4g} flooded isothermal films" in str(both)
        assert f"a layer of {cold.over_flooded:.4g} flooded films" in str(cold)


def test_joint_film_is_the_solved_one():
    """6305, 2 kN, 10 000 rev/min, r = 1: .622 um inside, solved with both (n = 256)."""
    ring = BallBearing.catalogue("6305", oil=OIL, supply=OilLayer(over_flooded=1.0), thermal=True)
    state = ring.equilibrium((0.0, -2000.0), speed_rpm=10000.0)
    assert 1e6 * state.h_central[state.heaviest, 0] == pytest.approx(0.622, rel=0.006)


def test_the_table_that_ends_is_named():
    for given, table in (({}, "the atlas"), ({"supply": OilLayer(over_flooded=1.0)}, "the table of oil supply")):
        one = BallBearing.catalogue("6205", oil=OIL, **given)
        with pytest.raises(InputError, match=f"where {table} ends"):
            one.equilibrium((0.0, -500.0), speed_rpm=1.01 * one.highest_speed)


def thin(layer, temperature=70.0):
    """A 6205 under a layer [m] as grease leaves, whose light balls the table of oil supply does not have."""
    return bearing(OilLayer(layer), oil=Lubricant.iso_vg(46, temperature=temperature))


def light_part(race, speed_rpm):
    """Loads [N] of the element that are lighter than those of the table, and approaches over the dry ones."""
    element = race.element(speed_rpm)
    loads, approach = np.array(element.loads), np.array(element.approach)
    unit, lightest = element.scales.force, lightest_load(race.point(1.0, speed_rpm).moes)
    light = unit * loads < lightest
    return unit * loads[light], (approach / loads ** (2.0 / 3.0))[light]


@pytest.mark.parametrize("layer", [1e-7, 2e-7])
def test_under_a_layer_in_metres_approaches_of_light_loads_rise_within_their_error_bars(layer):
    """At 300 rev/min, where errors of the table made the approach fall with the load and the race was refused."""
    race = thin(layer).race("inner")
    loads, approach = light_part(race, 300.0)
    assert np.all(np.diff(loads ** (2.0 / 3.0) * approach) > 0.0)
    answers = [race.answer(load, 300.0) for load in loads.tolist()]
    less = np.array([answer.dimensionless.approach for answer in answers]) - approach
    bars = np.array([answer.dimensionless.error_bars["approach"] for answer in answers])
    assert np.all((less > -1e-9) & (less < bars)) and 0 < np.count_nonzero(less > 1e-9) < loads.size


def test_a_light_load_under_a_layer_against_the_solver():
    """0.0268 N, M = 2.1, under 0.1 um: dry approach less approach is 13 % too small in the table alone."""
    race, load = thin(1e-7).race("inner"), 0.0268
    solved = 1.0 - solve_steady(race.point(load, 300.0), supply=OilLayer(1e-7)).dimensionless.approach
    loads, approach = light_part(race, 300.0)
    film = np.exp(np.interp(np.log(load), np.log(loads), np.log(1.0 - approach)))
    assert film == pytest.approx(solved, rel=0.08)
    assert 1.0 - race.answer(load, 300.0).approach < 0.89 * solved


def test_light_balls_under_a_layer_far_thinner_than_their_flooded_film():
    """The layer is .02 of the flooded film of balls without load, and .035 at least of any in the table."""
    state = thin(5e-8, 40.0).equilibrium(LOAD, speed_rpm=10000.0)
    carry = state.force > 1.0
    assert carry.any() and np.all(state.h_central[carry] < 5e-8) and np.isfinite(state.h_central).all()
    with pytest.raises(InputError, match=r"at least 0\.02 flooded films"):
        thin(1e-9, 40.0).equilibrium(LOAD, speed_rpm=10000.0)
