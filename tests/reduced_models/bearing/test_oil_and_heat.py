"""A bearing with heat and with a layer of oil beside flooded isothermal films: against solved contacts."""

from dataclasses import replace
from functools import partial
from math import cos, tau
from types import SimpleNamespace

import numpy as np
import pytest

import reduced_models.bearing.oil_and_heat as module
from ehlcontact import Grid, Heat, InputError, Lubricant, OilLayer, impedance
from ehlcontact.conditions import Conditions
from reduced_models import BallBearing, BearingSet
from reduced_models.bearing.oil_and_heat import BOTH, FLOODED, HEAT, HIGH, LAYER, oil_and_heat
from reduced_models.bearing.race import shared_atlas
from reduced_models.bearing.sliding import USUAL_LAW, bearing_friction, race_at

LOAD, SPEED = (0.0, -100.0), 6000.0
BEARING = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=60.0), rq_race=0.1e-6)
LINEAR = 2e-5  # relative tolerance of the linear solves of an impedance


@pytest.fixture
def coarse(monkeypatch):
    """Contacts on coarse grids: what is tested is what is made of them."""
    solve = partial(impedance, grid=Grid(48))
    monkeypatch.setattr(module, "impedance", solve)
    return partial(oil_and_heat, BEARING, LOAD, speed_rpm=SPEED, solve=True), solve


@pytest.mark.long
def test_conditions_are_those_of_the_bearing_with_heat_and_with_the_layer():
    supply, load, speed = OilLayer(over_flooded=0.8), (0.0, -1000.0), 3000.0
    found = oil_and_heat(BEARING, load, speed_rpm=speed, supply=supply, thermal=Heat(), band=[1000.0])
    assert not found.solved and found.hz.tolist() == [50.0, HIGH, 1000.0]
    share = found.conditions[HEAT].h_central[0] / found.conditions[FLOODED].h_central[0]
    thicker = OilLayer(over_flooded=0.8 / float(share.mean()))
    at = {}
    for key, given in (
        (FLOODED, {}),
        (HEAT, {"thermal": Heat()}),
        (LAYER, {"supply": supply}),
        ("thicker", {"supply": thicker}),
    ):
        one = replace(BEARING, **given)
        state = one.equilibrium(load, speed_rpm=speed)
        small = one.coefficients(load, speed_rpm=speed, hz=[50.0, HIGH, 1000.0])
        damping = small.damping if "supply" not in given else small.signed_damping
        at[key] = state.h_min, small.stiffness[:, 1, 1], damping[:, 1, 1], state.rolling_torque
    at[BOTH] = [a * b / c for a, b, c in zip(at[HEAT], at["thicker"], at[FLOODED], strict=True)]
    for key, one in found.conditions.items():
        own = one.h_min, one.stiffness[:, 1], one.damping[:, 1], one.rolling
        for value, expected in zip(own, at[key], strict=True):
            np.testing.assert_allclose(value, expected, rtol=1e-9)
    assert found.conditions[LAYER].damping[0, 1] < 0.0 < found.conditions[FLOODED].damping[0, 1]
    assert sum("below 0" in line for line in found.notes) == 1


def test_error_bars_are_those_of_the_heaviest_balls_contacts():
    """Against the ball with both contacts off by their bars, and as many such balls as the stiffness has."""
    found = oil_and_heat(BEARING, (0.0, -1000.0), speed_rpm=3000.0, thermal=Heat())
    state, contacts = found.at_rest, []
    for column, force in enumerate(state.force[state.heaviest].tolist()):
        race = race_at(BEARING, state, state.heaviest, column)
        answer = replace(race, conditions=Conditions(heat=Heat())).answer(force, 3000.0)
        contacts.append(answer.impedance(hz=found.hz))
        bar = answer.error_bars["h_min"]
        assert found.error_bars[HEAT].h_min[column] == pytest.approx(bar, rel=1e-12)
        name = f"smallest film, {('inner', 'outer')[column]}"
        assert found.bars[name][HEAT] == pytest.approx(1e6 * bar) and found.bars[name][FLOODED] < 1e6 * bar * 1.5
    w = tau * found.hz

    def ball(stiff=0.0, damp=0.0):
        K, C = (
            np.array([getattr(one, name) + off * one.error_bars[name] for one in contacts])
            for name, off in (("stiffness", stiff), ("damping", damp))
        )
        return 1.0 / (1.0 / (K + 1j * w * C)).sum(axis=0)

    count = found.conditions[HEAT].stiffness[:, 1] / ball().real
    bars = found.error_bars[HEAT]
    np.testing.assert_allclose(bars.stiffness[:, 1], count * (ball(stiff=1.0) - ball()).real, rtol=0.01)
    np.testing.assert_allclose(bars.damping[:, 1], count * (ball(damp=1.0) - ball()).imag / w, rtol=0.01)
    assert "±" not in str(found) and "error bars are those of the most loaded ball" in found.notes[0]


@pytest.fixture
def without_tables(monkeypatch):
    def beyond(*given):
        raise InputError("supply", 1.0, "one that the table of oil supply has")

    monkeypatch.setattr(module, "_from_tables", beyond)


@pytest.mark.parametrize(
    ("made", "load", "speed"),
    [
        pytest.param(
            lambda: BallBearing.catalogue("6305", clearance=-6e-6, oil=BEARING.oil),
            (0.0, -500.0),
            SPEED,
            id="6305",
            marks=pytest.mark.long,
        ),
        pytest.param(
            lambda: BearingSet.pair(BallBearing.catalogue("7205", oil=BEARING.oil), preload=150.0),
            (0.0, -300.0, 0.0),
            SPEED,
            id="pair",
            marks=pytest.mark.long,
        ),
    ],
)
def test_solved_contacts_correct_the_tables_of_preloaded_bearings(monkeypatch, made, load, speed):
    """Contacts as in the tables change nothing; errors of the tables with a layer are those of the bearing."""
    bearing, errors = made(), {}

    def answered(point, *, hz, supply=None, thermal=None):
        one = shared_atlas(None).at(point, supply=supply, thermal=thermal)
        Z = one.impedance(hz=hz)
        off = errors if supply is not None else {}
        scaled = {name: factor * getattr(one, name) for name, factor in off.items() if name != "stiffness"}
        K, C = Z.stiffness * off.get("stiffness", 1.0), Z.damping * off.get("stiffness", 1.0)
        films = {name: getattr(one, name) for name in ("h_central", "h_min", "moment")}
        return SimpleNamespace(stiffness=K, damping=C, film=SimpleNamespace(**films | scaled))

    monkeypatch.setattr(module, "impedance", answered)
    given = {"speed_rpm": speed, "supply": OilLayer(over_flooded=0.6), "thermal": Heat()}
    tables, same = (oil_and_heat(bearing, load, **given, solve=solve) for solve in (False, True))
    assert same.solved and not same.beyond_tables and "from tables, changed by" in same.notes[0]
    for key, one in tables.conditions.items():
        for name in ("h_central", "h_min", "stiffness", "damping", "rolling", "sliding"):
            np.testing.assert_allclose(getattr(same.conditions[key], name), getattr(one, name), rtol=1e-9)
    errors.update(stiffness=1.05, h_central=1.1, h_min=0.9, moment=1.2)
    off, flooded = oil_and_heat(bearing, load, **given, solve=True).conditions, tables.conditions[FLOODED]
    tabled = tables.conditions[LAYER]
    for name, factor in (("stiffness", 1.05), ("h_central", 1.1), ("h_min", 0.9), ("rolling", 1.2)):
        value, before = (getattr(one, name) for one in (off[LAYER], tabled))
        np.testing.assert_allclose(value, factor * before, rtol=1e-6)
    assert off[LAYER].sliding != tabled.sliding and np.all(off[LAYER].damping != tabled.damping)
    np.testing.assert_array_equal(off[FLOODED].stiffness, flooded.stiffness)
    share = (off[LAYER].damping - tabled.damping) / flooded.damping  # 5 % of the ball's C over its flooded one
    np.testing.assert_allclose(share, np.broadcast_to(share[:, :1], share.shape), rtol=1e-6)


@pytest.mark.long
def test_a_layer_as_thick_as_any_is_flooded_with_heat_too():
    found = oil_and_heat(BEARING, LOAD, speed_rpm=SPEED, supply=OilLayer(over_flooded=1e6), thermal=Heat())
    one, other = found.conditions[BOTH], found.conditions[HEAT]
    np.testing.assert_allclose(one.h_central, other.h_central, rtol=1e-6)
    assert any("of elements: up to 5 % apart" in line for line in found.notes)


@pytest.mark.long
def test_what_tables_do_not_have_is_solved(coarse, without_tables):
    """For a bearing, and for both of a pair."""
    pair, supply = BearingSet.tandem(BEARING), OilLayer(over_flooded=1.0)
    found, two = (
        oil_and_heat(one, (0.0, 0.0, force), speed_rpm=SPEED, supply=supply)
        for one, force in ((BEARING, 200.0), (pair, 400.0))
    )
    assert found.solved and list(found.conditions) == [FLOODED, LAYER]
    assert "solved contacts" in found.notes[0] and "one that the table of oil supply has" in found.notes[0]
    assert "without the change of preload" in found.notes[1]
    assert found.to_dict()["beyond_tables"].startswith("supply = 1.0")
    state = BEARING.equilibrium((0.0, 0.0, 200.0), speed_rpm=SPEED)
    assert found.conditions[FLOODED].rolling == pytest.approx(state.rolling_torque, rel=1e-12)
    for key, one in found.conditions.items():
        for name in ("damping", "rolling", "sliding"):
            np.testing.assert_allclose(getattr(two.conditions[key], name), 2.0 * getattr(one, name), rtol=1e-4)


@pytest.mark.long
def test_conditions_are_solved_ratios_times_flooded_values(coarse, without_tables):
    find, solve = coarse
    supply, calls = OilLayer(0.3e-6), []
    found = find(supply=supply, thermal=Heat(), callback=lambda *given: calls.append(given))
    assert list(found.conditions) == [FLOODED, HEAT, LAYER, BOTH] and not found.refused
    assert [done for done, total, _ in calls] == list(range(8)) and {total for _, total, _ in calls} == {8}
    state = BEARING.equilibrium(LOAD, speed_rpm=SPEED)
    small = BEARING.coefficients(LOAD, speed_rpm=SPEED, hz=[SPEED / 60.0, HIGH])
    flooded = found.conditions[FLOODED]
    np.testing.assert_array_equal(flooded.h_min, state.h_min)
    np.testing.assert_array_equal(flooded.damping, np.einsum("kii->ki", small.damping))
    assert flooded.rolling == pytest.approx(state.rolling_torque, rel=1e-12)
    own = bearing_friction(BEARING, LOAD, speed_rpm=SPEED, law=USUAL_LAW, heat=False)
    assert flooded.sliding == own.sliding

    points = [race_at(BEARING, state, 0, k).point(float(state.force[0, k]), SPEED) for k in (0, 1)]

    def contacts(layers, heat=None):
        answers = [
            solve(point, hz=[HIGH], supply=one, thermal=heat) for point, one in zip(points, layers, strict=True)
        ]
        ball = 1.0 / sum(1.0 / (a.stiffness[0] + 1j * a.damping[0] * tau * HIGH) for a in answers)
        return np.array([a.film.h_central for a in answers]), ball.real, ball.imag

    cold, warm, starved = contacts([None] * 2), contacts([None] * 2, Heat()), contacts([supply] * 2)
    share = warm[0] / cold[0]
    both = contacts([OilLayer(0.3e-6 / one) for one in share])
    for key, one, heated in ((HEAT, warm, cold), (LAYER, starved, cold), (BOTH, both, warm)):
        h, K, C = (a / b * c / b for a, b, c in zip(one, cold, heated, strict=True))
        at = found.conditions[key]
        np.testing.assert_allclose(at.h_central, state.h_central * h, rtol=1e-9)
        assert at.stiffness[1, 1] == pytest.approx(small.stiffness[1, 1, 1] * K, rel=LINEAR)
        assert at.damping[1, 1] == pytest.approx(small.damping[1, 1, 1] * C, rel=LINEAR)
        assert at.rolling < flooded.rolling
        np.testing.assert_allclose(at.lambda_ratio * 0.1e-6, at.h_min, rtol=1e-12)
    rows = {words: values for words, _, values in found.rows}
    assert rows["central film, outer"][BOTH] == pytest.approx(1e6 * found.conditions[BOTH].h_central[0, 1])
    assert rows["damping, 500 Hz"][LAYER] == found.conditions[LAYER].damping[1, 1]
    assert any("product" in line for line in found.notes) and "with both" in str(found)


@pytest.mark.long
def test_limits_of_much_oil_and_of_an_oil_that_heat_does_not_change(coarse):
    find, _ = coarse
    found = find(supply=OilLayer(over_flooded=1e3), thermal=Heat())
    for one, other in ((LAYER, FLOODED), (BOTH, HEAT)):
        for name in ("h_central", "h_min", "stiffness", "rolling"):
            a, b = (getattr(found.conditions[key], name) for key in (one, other))
            np.testing.assert_allclose(a, b, rtol=1e-4)
        # C is that of contacts under a layer, of elements without one: 2.7 % apart here (docs/notes/bearings.md)
        a, b = (found.conditions[key].damping for key in (one, other))
        np.testing.assert_allclose(a, b, rtol=0.03)
    cold = find(thermal=Heat(temperature_slope=0.0))
    np.testing.assert_allclose(cold.conditions[HEAT].damping, cold.conditions[FLOODED].damping, rtol=LINEAR)
    assert list(cold.conditions) == [FLOODED, HEAT]


@pytest.mark.long
def test_a_layer_without_a_film_is_refused_and_the_rest_is_there(coarse):
    find, _ = coarse
    found = find(supply=OilLayer(1e-10))
    assert list(found.conditions) == [FLOODED] and list(found.refused) == [LAYER]
    assert any(line.startswith("With the layer: ") for line in found.notes)


def test_damping_below_zero_has_its_line(coarse):
    find, _ = coarse
    found = find()
    assert not any("below 0" in line for line in found.notes)
    fed = replace(found.conditions[FLOODED], damping=-found.conditions[FLOODED].damping)
    line = next(line for line in replace(found, conditions={LAYER: fed}).notes if "below 0" in line)
    assert "with the layer at 100 Hz, with the layer at 500 Hz" in line


def test_axial_load_has_rows_of_its_own():
    found = oil_and_heat(BEARING, (0.0, 0.0, 200.0), speed_rpm=SPEED)
    assert not found.solved and found.ways == {"axially": 2}
    at = BEARING.coefficients((0.0, 0.0, 200.0), speed_rpm=SPEED, hz=[HIGH])
    rows = {words: values for words, _, values in found.rows}
    assert rows["damping, 500 Hz"][FLOODED] == pytest.approx(at.damping[0, 2, 2])


def test_what_has_no_films_is_refused():
    with pytest.raises(InputError, match="oil"):
        oil_and_heat(BallBearing.catalogue("6205"), LOAD, speed_rpm=SPEED, thermal=Heat())
    with pytest.raises(InputError, match="temperature_slope"):
        plain = BallBearing.catalogue("6205", oil=Lubricant(eta0=0.02, alpha=2e-8))
        oil_and_heat(plain, LOAD, speed_rpm=SPEED, thermal=Heat())


@pytest.mark.slow
def test_ratios_of_the_heaviest_ball_beside_those_of_all():
    """6205, 1000 N, 3000 rpm: all contacts that carry, solved and summed, a ball under the load."""
    bearing, load = BallBearing.catalogue("6205", oil=BEARING.oil), (0.0, -1000.0)
    supply = OilLayer(over_flooded=1.0)
    given = {"speed_rpm": 3000.0, "supply": supply, "thermal": Heat()}
    found, tables = oil_and_heat(bearing, load, **given, solve=True), oil_and_heat(bearing, load, **given)
    state, hz = bearing.equilibrium(load, speed_rpm=3000.0), np.array([50.0, HIGH])

    def ring(**given):
        total = 0.0
        for ball in range(3):
            points = [race_at(bearing, state, ball, k).point(float(state.force[ball, k]), 3000.0) for k in (0, 1)]
            answers = [impedance(point, hz=hz, **given) for point in points]
            springs = 1.0 / sum(1.0 / (a.stiffness + 1j * a.damping * tau * hz) for a in answers)
            total = total + (1 if ball == 0 else 2) * cos(ball * tau / 9) ** 2 * springs
        return total

    flooded = ring()
    heated, starved = ring(thermal=Heat()), ring(supply=supply)
    # Over C of the flooded contacts. With heat, C over that of flooded elements; under the layer C is that of
    # contacts, -3.5 at 50 Hz and 0.07 at 500, so 0.1 is 3 % of it.
    for answer, off in ((found, {HEAT: 0.003, LAYER: [0.08, 0.02]}), (tables, {HEAT: 0.005, LAYER: [0.1, 0.01]})):
        for key, all_balls in ((HEAT, heated), (LAYER, starved)):
            at, cold = answer.conditions[key], answer.conditions[FLOODED]
            K = at.stiffness[:, 1] / cold.stiffness[:, 1]
            C = at.damping[:, 1] / (cold.damping[:, 1] if key == HEAT else flooded.imag / (tau * hz))
            np.testing.assert_allclose(K, all_balls.real / flooded.real, atol=0.004)
            assert np.all(np.abs(C - all_balls.imag / flooded.imag) < off[key]), (key, C)  # over the flooded one
    np.testing.assert_allclose(
        tables.conditions[LAYER].h_central[0], found.conditions[LAYER].h_central[0], rtol=0.01
    )
    np.testing.assert_allclose(tables.conditions[LAYER].h_min[0], found.conditions[LAYER].h_min[0], rtol=0.05)
