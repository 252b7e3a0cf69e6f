"""``ehlcontact explore``: numbers of its JavaScript, in a browser and in node, against those of Python."""

import json
from dataclasses import asdict

import numpy as np
import pytest
from browsers import ENGINES

from ehlcontact import Lubricant, MoesPoint
from ehlcontact.checks.admissible_range import INPUTS
from ehlcontact.cli.explorer import COMPUTING, UNITS, script
from ehlcontact.errors import InputError
from reduced_models import Atlas, BallBearing
from reduced_models.bearing.catalogue import DEEP_GROOVE
from reduced_models.bearing.kinematics import DefectOrders
from reduced_models.elements.film_response import FilterRates

CLOSE = 1e-6  # of every number: what the issue asks for
NUMBERS = ("approach", "h_central", "h_min", "film_share", "moment", "stiffness", "damping")
GRADES = (10, 22, 32, 68, 150, 460)


@pytest.fixture(scope="module")
def computing():
    return script(COMPUTING)


@pytest.fixture(scope="module", params=[pytest.param("chromium", marks=pytest.mark.long), "node"])
def ask(request, computing, tmp_path_factory):
    """``ask(body, asked)``: ``body`` is a function of `atlas` and one entry; its values for all entries."""

    def run(body, asked):
        call = """
        const atlas = new Atlas(DATA.atlas);
        const one = (atlas, asked) => { BODY };
        const plain = (key, value) => (ArrayBuffer.isView(value) ? Array.from(value) : value);
        const told = asked => {
          try { return one(atlas, asked); }
          catch (error) { if (!(error instanceof InputError)) throw error; return { refused: { ...error } }; }
        };
        const answer = JSON.stringify(ASKED.map(told), plain);"""
        code = computing + call.replace("BODY", body).replace("ASKED", json.dumps(asked))
        return ENGINES[request.param](code, tmp_path_factory.mktemp("asked"))

    return run


def refused(body):
    """The refusal of a call as the page has it, or None."""
    try:
        body()
    except InputError as error:
        return {"field": error.field, "value": error.value, "allowed": error.allowed}
    return None


def inside(atlas, count, seed=14):
    """Points all over the box, half of them of other oils."""
    rng, box, points = np.random.default_rng(seed), atlas.box, []
    while len(points) < count:
        M, kappa = (np.exp(rng.uniform(*np.log(ends))) for ends in (box.M, box.kappa))
        oil = {} if len(points) % 2 else {"alpha": rng.uniform(1e-8, 4e-8), "eta0": np.exp(rng.uniform(-6.2, 0.0))}
        point = MoesPoint(M, rng.uniform(*box.L), kappa, **oil)
        if point.p_hertz <= box.p_hertz:
            points.append(point)
    return [*points[2:], MoesPoint(200.0, 0.0, 0.5), MoesPoint(box.M[0], box.L[1], box.kappa[1])]


def asked_of(point):
    return {name: getattr(point, name) for name in ("M", "L", "kappa", "alpha", "eta0")}


def test_atlas_answers_as_in_python(ask):
    atlas = Atlas()
    points = inside(atlas, 200)
    assert len(points) == 200
    found = ask("return atlas.at(asked);", [asked_of(point) for point in points])
    for point, here in zip(points, found, strict=True):
        there = atlas.at(point)
        for name in NUMBERS:
            np.testing.assert_allclose(here[name], getattr(there, name), rtol=CLOSE, atol=1e-12, err_msg=name)
            np.testing.assert_allclose(here["error"][name], there.error_bars[name], rtol=CLOSE, err_msg=name)


def test_between_the_frequencies_of_the_table(ask):
    atlas = Atlas()
    points, Omega = inside(atlas, 40, seed=7), [0.0, 1e-4, 0.02, 0.7, 3.3, 11.3, 47.0, 60.0]
    body = """
    const { stiffness, damping, error } = atlas.at(asked.point);
    const K = atlas.over(stiffness, error.stiffness), C = atlas.over(damping, error.damping);
    return asked.Omega.map(at => [...K(at), ...C(at)]);"""
    found = ask(body, [{"point": asked_of(point), "Omega": Omega} for point in points])
    for point, here in zip(points, found, strict=True):
        there = atlas.at(point).impedance(Omega=Omega).dimensionless
        columns = there.stiffness, there.error_bars["stiffness"], there.damping, there.error_bars["damping"]
        for column, values in zip(np.transpose(here), columns, strict=True):
            np.testing.assert_allclose(column, values, rtol=CLOSE, atol=1e-10)


def test_oils_by_grade_are_those_of_python(ask):
    asked = [{"grade": grade, "temperature": t} for grade in GRADES for t in (20, 40, 61.3, 100, 120)]
    asked += [{"grade": 68, "temperature": t} for t in (19.9, 333.15, 121)] + [{"grade": 47, "temperature": 50}]
    found = ask("return mineralOil(DATA.oil, asked.grade, asked.temperature);", asked)
    refusals = 0
    for one, here in zip(asked, found, strict=True):
        there = refused(lambda one=one: Lubricant.iso_vg(one["grade"], temperature=one["temperature"]))
        if there is not None:
            assert here["refused"] == there
            refusals += 1
            continue
        oil = Lubricant.iso_vg(one["grade"], temperature=one["temperature"])
        assert here["eta0"] == pytest.approx(oil.eta0, rel=CLOSE)
        assert here["alpha"] == pytest.approx(oil.alpha, rel=CLOSE)
        assert here["temperature_slope"] == pytest.approx(oil.temperature_slope, rel=CLOSE)
    assert refusals == 5  # VG 10 at 120 C is too thin


BEARING = """
const bearing = new Bearing(asked.bearing, asked.oil, atlas), atSpeed = bearing.speedState(asked.rpm);
const state = bearing.ringEquilibrium(atSpeed, asked.load), all = read => state.balls.map(read);
return { q: state.q, stiffness: state.stiffness,
  force: all(ball => ball.force), approach: all(ball => ball.approach),
  films: all(ball => bearing.films(atSpeed, ball).map(film => [film.h_central, film.h_min])),
  highest: bearing.highestSpeed, orders: bearing.orders(), angular: bearing.orders(12.5),
  both: bearing.coefficients(atSpeed, asked.load, asked.hz.map(hz => 2 * Math.PI * hz)) };
"""


def case(name="6205", oil=(68, 50.0), rpm=3000.0, load=1000.0, **changes):
    """A bearing of the catalogue, or nearly, as the page has it."""
    row = DEEP_GROOVE[name]
    if isinstance(oil, tuple):
        by_grade = Lubricant.iso_vg(oil[0], temperature=oil[1])
        oil = {"eta0": by_grade.eta0, "alpha": by_grade.alpha}
    bearing = {name: getattr(row, name) for name in ("balls", "ball_diameter", "pitch_diameter")}
    bearing |= {"conformity_inner": row.conformity, "conformity_outer": row.conformity, "clearance": 0.0}
    asked = {"bearing": bearing, "oil": oil, "rpm": rpm, "load": load, "hz": [0.0, rpm / 60.0, 3e3, 1e5]}
    for key, value in changes.items():
        (bearing if key in bearing else asked)[key] = value
    return asked


def drawn(count, seed=3):
    """Bearings, oils, speeds and loads over what people have; those that Python refuses too."""
    rng, cases = np.random.default_rng(seed), []
    for _ in range(count):
        oil = int(rng.choice(GRADES)), rng.uniform(20.0, 100.0)
        numbers = {"rpm": float(np.exp(rng.uniform(4.0, 9.6))), "load": float(np.exp(rng.uniform(1.0, 8.5)))}
        changes = {"clearance": rng.uniform(-5e-6, 3e-5), "conformity_outer": rng.uniform(0.512, 0.55)}
        cases.append(case(str(rng.choice(list(DEEP_GROOVE))), oil, **numbers, **changes))
    return cases


def python_of(asked):
    """What Python answers for a case: what it refuses, or state, coefficients and bearing."""
    weight = (0.0, -asked["load"])
    try:
        bearing = BallBearing(**asked["bearing"], oil=Lubricant(**asked["oil"]))
        state = bearing.equilibrium(weight, speed_rpm=asked["rpm"])
        return state, bearing.coefficients(weight, speed_rpm=asked["rpm"], hz=asked["hz"]), bearing
    except InputError as error:
        return error


@pytest.fixture(scope="module")
def bearings():
    """Cases, and what Python answers."""
    cases = [*drawn(18), case("209", clearance=-2e-6, load=0.0), case(clearance=1.5e-5, load=20.0)]
    return [(one, python_of(one)) for one in cases]


def test_bearings_stand_and_vibrate_as_in_python(ask, bearings):
    stood = 0
    for (_, there), here in zip(bearings, ask(BEARING, [one for one, _ in bearings]), strict=True):
        if isinstance(there, InputError):
            assert same_refusal(here.get("refused"), there), (here, there)
            continue
        stood += 1
        state, vibrations, bearing = there
        assert here["highest"] == pytest.approx(bearing.highest_speed, rel=CLOSE)
        orders = {name.removesuffix("_order").upper(): order for name, order in asdict(bearing.orders).items()}
        assert here["orders"] == pytest.approx(orders, rel=1e-12)
        steep = DefectOrders.of(bearing.balls, bearing.gamma, np.cos(np.radians(12.5)))
        angular = {name.removesuffix("_order").upper(): order for name, order in asdict(steep).items()}
        assert here["angular"] == pytest.approx(angular, rel=1e-12)
        films = np.stack([state.h_central, state.h_min], axis=-1)
        np.testing.assert_allclose(here["films"], films, rtol=CLOSE)
        for name, values in (("force", state.force), ("approach", state.approach), ("q", state.displacement)):
            np.testing.assert_allclose(
                here[name], values, rtol=0.0, atol=CLOSE * np.abs(values).max(), err_msg=name
            )
        stiff = CLOSE * np.abs(state.stiffness).max()
        np.testing.assert_allclose(here["stiffness"], state.stiffness, rtol=0.0, atol=stiff)
        for name in ("stiffness", "damping"):
            for k, way in enumerate(("across", "along")):
                mine = [row[way][name] for row in here["both"]]
                np.testing.assert_allclose(mine, getattr(vibrations, name)[:, k, k], rtol=CLOSE, err_msg=name)
    assert stood >= 12


OUTSIDE = """
const bearing = new Bearing(asked.bearing, asked.oil, atlas), atSpeed = bearing.speedState(asked.rpm);
return outsideAssumptions(bearing, atSpeed, bearing.ringEquilibrium(atSpeed, asked.load).balls);
"""


def test_assumptions_that_do_not_hold_are_those_of_python(ask):
    """Heat of the inlet, for oils by grade and by viscosity; stress of thick oils; at both races."""
    oils = [Lubricant.iso_vg(grade, temperature=t) for grade, t in ((32, 45.0), (68, 60.0), (460, 50.0))]
    oils += [Lubricant(eta0=0.024, alpha=1.8e-8), Lubricant(eta0=0.1, alpha=1.05e-8)]
    names = "eta0", "alpha", "temperature_slope"
    known = [{name: value for name in names if (value := getattr(oil, name)) is not None} for oil in oils]
    cases = [case(oil=oil, rpm=rpm, clearance=2e-6) for oil in known for rpm in (300.0, 1300.0)]
    cases += [case(oil=known[4], rpm=9e4), *(case(oil=known[1], rpm=rpm, load=300.0) for rpm in (9e3, 3e4))]
    headlines = []
    for one in cases:
        bearing = BallBearing(**one["bearing"], oil=Lubricant(**one["oil"]))
        state = bearing.equilibrium((0.0, -one["load"]), speed_rpm=one["rpm"])
        headlines.append(state.outside_assumptions)
    assert ask(OUTSIDE, cases) == headlines
    assert any("newtonian" in text for text in headlines) and sum(text == "" for text in headlines) > 3
    assert "isothermal (shear heats the inlet: film 5" in headlines[-1]


def same_refusal(here, there):
    """The same input, refused with the same words; a load is a vector in Python."""
    if here is None or here["field"] != there.field or here["allowed"] != there.allowed:
        return False
    return there.field == "load" or here["value"] == pytest.approx(there.value, rel=CLOSE)


def test_gains_that_would_feed_energy_are_found_as_in_python(ask):
    """Interpolated gains are raised by their least dissipation where that is negative: 3 % of the box."""
    rates, rng = FilterRates(**Atlas().metadata["rates"]), np.random.default_rng(5)
    rows = (rng.uniform(0.0, 1.0, (60, 3 + rates.lags)) ** 4).tolist()
    there = [rates.least_dissipation(row) for row in rows]
    assert 10 < sum(least < 0.0 for least in there) < 50
    assert ask("return leastDissipation(atlas.rates, asked);", rows) == pytest.approx(there, abs=1e-9)


BORDERS = {
    "on every border": [(1.0, 0.0, 0.045), (1.0, 30.0, 1.0), (30000.0, 0.0, 0.045), (30000.0, 0.0, 1.0)],
    "beyond M": [(0.999, 10.0, 0.1), (30001.0, 10.0, 0.5)],
    "beyond L": [(200.0, 30.01, 0.5)],
    "beyond kappa": [(200.0, 10.0, 0.0449), (200.0, 10.0, 1.001)],
    "pressed too hard": [(30000.0, 30.0, 0.5)],
}
OILS = [{"alpha": 9.9e-9}, {"alpha": 22.0}, {"eta0": 1.01}, {"eta0": 4.9}, {"alpha": 4e-8, "eta0": 0.002}]


def test_the_borders_of_the_atlas_are_those_of_python(ask):
    atlas, points = Atlas(), [MoesPoint(*at) for group in BORDERS.values() for at in group]
    points += [MoesPoint(200.0, 10.0, 0.5, **oil) for oil in OILS]
    found, refusals = ask("return atlas.at(asked);", [asked_of(point) for point in points]), 0
    for point, here in zip(points, found, strict=True):
        there = refused(lambda point=point: atlas.at(point))
        assert here.get("refused") == there
        refusals += there is not None
        if there is None:
            assert here["h_min"] == pytest.approx(atlas.at(point).h_min, rel=CLOSE)
    assert refusals == len(points) - len(BORDERS["on every border"]) - 1


NO_BEARINGS = [
    {"balls": 2}, {"balls": 16}, {"pitch_diameter": 7e-3}, {"conformity_inner": 0.5}, {"conformity_outer": 0.501},
    {"clearance": 1e-3}, {"clearance": -4e-4}, {"rpm": 0.0}, {"rpm": 60000.0}, {"load": 2e4},
    {"oil": {"eta0": 1.2, "alpha": 2e-8}}, {"oil": {"eta0": 0.03, "alpha": 5e-8}},
    {"load": 0.0, "clearance": -3.5e-4}, {"conformity_inner": 1.04},
]  # fmt: skip


def test_what_is_no_bearing_is_refused_as_in_python(ask):
    cases = [case(**changes) for changes in NO_BEARINGS]
    for one, here in zip(cases, ask(BEARING, cases), strict=True):
        there = python_of(one)
        assert isinstance(there, InputError) and same_refusal(here.get("refused"), there), (here, there)


def test_typed_numbers_are_checked_as_by_the_study(ask):
    """In the units of the page, with a guess at a slip of unit."""
    asked = [("ball_diameter", 0.00794), ("pitch_diameter", 1e5), ("conformity", 52.0), ("speed_rpm", 2e6)]
    asked += [("conformity", 1.04), ("conformity", 0.9615), ("conformity", 1.923)]
    asked += [("eta0", 0.037), ("eta0", 1e9), ("alpha", 2e-8), ("alpha", 22.0), ("ball_diameter", 7.94)]
    body = "return { kept: requireQuantity(asked[0], asked[1], DATA.quantities[asked[0]]) };"
    guesses = 0
    for (name, value), here in zip(asked, ask(body, asked), strict=True):
        quantity = INPUTS[name].in_unit(UNITS[name]) if name in UNITS else INPUTS[name]
        there = refused(lambda name=name, value=value, quantity=quantity: quantity.require(name, value))
        assert here == ({"kept": value} if there is None else {"refused": there})
        guesses += there is not None and "then" in there["allowed"]
    assert guesses >= 3


def test_orders_under_an_axial_load(ask):
    """Like those of five degrees of freedom; here a ball has the same angle at both races."""
    body = """
    const bearing = new Bearing(asked.bearing, asked.oil, atlas), atSpeed = bearing.speedState(asked.rpm);
    return bearing.ordersUnder(atSpeed, asked.load, asked.axial, asked.slip);"""
    loads = [(30.0, 32.0, 1797.0, 0.0), (0.0, 100.0, 1800.0, 0.01), (1000.0, 200.0, 3000.0, 0.0)]
    cases = [case(load=load, rpm=rpm, clearance=8e-6) | {"axial": axial, "slip": slip}
             for load, axial, rpm, slip in loads]  # fmt: skip
    steep = [case(clearance=1.5e-4) | {"axial": 1.2e4, "slip": 0.0}, case() | {"axial": 100.0, "slip": 1.0}]
    *found, beyond, slipping = ask(body, cases + steep)
    near = {"ftf_order": 5e-5, "bpfo_order": 3e-4, "bpfi_order": 3e-4, "bsf_order": 3e-4}
    for one, here, (load, axial, rpm, slip) in zip(cases, found, loads, strict=True):
        bearing = BallBearing(**one["bearing"], oil=Lubricant(**one["oil"]))
        state = bearing.equilibrium((0.0, -load, axial), speed_rpm=rpm)
        there = bearing.orders_under(load, axial=axial, speed_rpm=rpm, slip=slip)
        for name, order in asdict(there).items():
            assert here["orders"][name.removesuffix("_order").upper()] == pytest.approx(order, abs=near[name]), (
                name,
                one,
            )
        angle = np.average(state.contact_angles.mean(axis=1), weights=state.force[:, 0])
        assert here["angle"] == pytest.approx(np.degrees(angle), abs=0.02)
    assert "refused" in beyond and slipping["refused"]["field"] == "slip"
