"""``ehlcontact explore``: numbers of the page, in a browser and in node, against those of Python."""

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
from reduced_models.bearing.catalogue import DEEP_GROOVE, ROWS
from reduced_models.bearing.designation import designation, kind_of
from reduced_models.bearing.sliding import USUAL_LAW, friction_at
from reduced_models.elements.film_response import FilterRates
from reduced_models.life.life_modification import film_ratio

CLOSE = 1e-6  # of every number: what the issue asks for
NUMBERS = ("approach", "h_central", "h_min", "separation", "moment", "stiffness", "damping")
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
        assert here["rho0"] == pytest.approx(oil.rho0, rel=CLOSE)
    assert refusals == 5  # VG 10 at 120 C is too thin


BEARING = """
const bearing = new Bearing(asked.bearing, asked.oil, atlas), there = bearing.under(asked.load, asked.rpm);
const all = read => there.balls.map(read), films = read => there.films.map(row => row.map(read));
return { q: there.q, stiffness: there.stiffness, heaviest: there.heaviest,
  force: all(ball => ball.force), approach: all(ball => ball.approach), angle: all(ball => ball.angle),
  films: films(film => [film.h_central, film.h_min]), moment: films(film => film.moment),
  pressure: films(film => film.pressure),
  highest: bearing.highestSpeed, orders: bearing.withSlip(there.orders, asked.slip), torque: there.torque,
  outside: outsideAssumptions(there), beyond: beyondData(there), friction: there.frictionNote,
  life: ratingLife(there, 1e-7),
  both: there.coefficients(asked.hz.map(hz => 2 * Math.PI * hz)) };
"""


def case(name="6205", oil=(68, 50.0), rpm=3000.0, load=(0.0, -1000.0), **changes):
    """A bearing of the catalogue, or nearly, as the page has it."""
    row = ROWS[name]
    if isinstance(oil, tuple):
        oil = Lubricant.iso_vg(oil[0], temperature=oil[1])
    if isinstance(oil, Lubricant):
        names = "eta0", "alpha", "temperature_slope", "temperature"
        oil = {name: value for name in names if (value := getattr(oil, name)) is not None}
    bearing = {name: getattr(row, name) for name in ("balls", "ball_diameter", "pitch_diameter")}
    bearing |= {"conformity_inner": row.conformity, "conformity_outer": row.conformity, "clearance": 0.0}
    bearing |= {"contact_angle": row.contact_angle or 0.0, "name": name}
    asked = {"bearing": bearing, "oil": oil, "rpm": rpm, "load": load, "slip": 0.0}
    asked["hz"] = [0.0, rpm / 60.0, 3e3, 1e5]
    for key, value in changes.items():
        (bearing if key in bearing else asked)[key] = value
    return asked


def drawn(count, seed=3, axial=False):
    """Bearings, oils, speeds and loads over what people have; those that Python refuses too."""
    rng, cases = np.random.default_rng(seed), []
    while len(cases) < count:
        name = str(rng.choice(list(ROWS if axial else DEEP_GROOVE)))
        oil = int(rng.choice(GRADES)), rng.uniform(20.0, 100.0)
        radial, along = np.exp(rng.uniform(1.0, 8.0)), np.exp(rng.uniform(2.0, 7.0))
        load = (0.0, -float(radial), float(along)) if axial else (0.0, -float(radial))
        clearance = 0.0 if ROWS[name].contact_angle else rng.uniform(-5e-6, 3e-5)
        changes = {"clearance": clearance, "conformity_outer": rng.uniform(0.512, 0.55)}
        cases.append(case(name, oil, float(np.exp(rng.uniform(4.0, 9.6))), load, **changes))
    return cases


def bearing_of(asked):
    """The bearing of a case in Python."""
    angle = asked["bearing"]["contact_angle"] or None
    return BallBearing(**asked["bearing"] | {"contact_angle": angle}, oil=Lubricant(**asked["oil"]))


def python_of(asked):
    """What Python answers for a case: what it refuses, or state, coefficients and bearing."""
    load = tuple(asked["load"])
    try:
        bearing = bearing_of(asked)
        state = bearing.equilibrium(load, speed_rpm=asked["rpm"])
        return state, bearing.coefficients(load, speed_rpm=asked["rpm"], hz=asked["hz"]), bearing
    except InputError as error:
        return error


def require_equal(here, there, asked):
    """All numbers of a case: ring, balls, films, torque, K and C, defect frequencies, assumptions."""
    state, vibrations, bearing = there
    n = len(asked["load"])
    assert here["highest"] == pytest.approx(bearing.highest_speed, rel=CLOSE)
    orders = (state.orders or bearing.orders).with_slip(asked["slip"])
    assert here["orders"] == pytest.approx(
        {name.removesuffix("_order").upper(): one for name, one in asdict(orders).items()}, rel=CLOSE
    )
    films = np.stack([state.h_central, state.h_min], axis=-1)
    np.testing.assert_allclose(here["films"], films, rtol=CLOSE)
    np.testing.assert_allclose(here["moment"], state.moment, rtol=CLOSE)
    ring = ("q", state.displacement[:n]), ("stiffness", state.stiffness[:n, :n])
    angles = np.zeros_like(state.force) if state.contact_angles is None else state.contact_angles
    for name, values in (("force", state.force), ("approach", state.approach), ("angle", angles), *ring):
        np.testing.assert_allclose(here[name], values, rtol=0.0, atol=CLOSE * np.abs(values).max(), err_msg=name)
    assert here["heaviest"] == state.heaviest
    load, race = state.force[state.heaviest, 0], bearing.race("inner").at_angle(
        bearing.pitch_diameter, float(angles[state.heaviest, 0]), 1.0
    )  # fmt: skip
    assert here["pressure"][state.heaviest][0] == pytest.approx(race.point(load, 1.0).moes.p_hertz, rel=CLOSE)
    friction = friction_at(bearing, state, USUAL_LAW, heat=bearing.oil.temperature_slope is not None)
    torque = {"rolling": friction.rolling, "sliding": friction.sliding, "heat": friction.inlet_heat}
    skf = here["torque"].pop("skf")
    assert skf == (None if state.skf_torque is None else pytest.approx(state.skf_torque, rel=CLOSE))
    assert here["torque"] == pytest.approx(torque, rel=CLOSE)
    life = state.life()
    ratio = state.h_min[state.heaviest].min() / 1e-7
    found = {
        "rating": life.ratings.dynamic, "turns": life.l10r, "hours": life.l10rh, "kappa": life.viscosity_ratio,
        "film": film_ratio(ratio), "safety": life.pressure_safety,
    }  # fmt: skip
    assert here["life"].pop("printed") == ("NSK" in life.ratings.dynamic_source)
    assert here["life"] == pytest.approx(found, rel=10.0 * CLOSE)
    beyond = f"Beyond the data: {state.reservation}." if state.reservation else ""
    assert (here["outside"], here["beyond"]) == (state.outside_assumptions, beyond)
    assert here["friction"] == state.friction_note
    for name in ("stiffness", "damping"):
        for mine, matrix in zip((row[name] for row in here["both"]), getattr(vibrations, name), strict=True):
            whole = matrix[:n, :n]
            np.testing.assert_allclose(np.diagonal(mine), np.diagonal(whole), rtol=CLOSE, err_msg=name)
            np.testing.assert_allclose(mine, whole, rtol=0.0, atol=CLOSE * np.abs(whole).max(), err_msg=name)


def stood(ask, cases):
    """How many cases Python takes; all numbers of these are equal, and the others are refused alike."""
    count = 0
    for asked, here in zip(cases, ask(BEARING, cases), strict=True):
        there = python_of(asked)
        if isinstance(there, InputError):
            assert same_refusal(here.get("refused"), there), (here, there)
            continue
        count += 1
        require_equal(here, there, asked)
    return count


def test_bearings_stand_and_vibrate_as_in_python(ask):
    """Under radial load, under both, without load, and at contact angles that are given."""
    cases = [
        *drawn(2),
        case("209", clearance=-2e-6, load=(0.0, 0.0)),
        case(clearance=1.5e-5, load=(0.0, -20.0)),
        case(load=(0.0, -0.2)),
    ]
    cases += [case(clearance=8e-6, load=(0.0, -30.0, 200.0), slip=0.01), case("7206 C", load=(0.0, -150.0, 300.0))]
    assert stood(ask, cases) >= 6


def test_friction_that_the_outer_race_must_hold(ask):
    """Above what oils transmit, in the words of Python; below it nothing."""
    cases = [case("7206 B", (32, 80.0), rpm, (0.0, -100.0, 1000.0)) for rpm in (3000.0, 15000.0)]
    assert stood(ask, cases) == 2
    slow, fast = (python_of(one)[0].friction_note for one in cases)
    assert slow == "" and "the outer race must hold" in fast


TYPED = [
    "6205", "6205-2RS", "6203-2RS-JEM", "6205 ZZ", "SKF 6205", "6205/C3", "nsk6205ddu c4", "6205-2RSH/C3LHT23",
    "7205 BECBP", "7205-2RS", "7205", "S 6205 C/P4", "608ZZ", "62052RS", "6205C6", "6205 47", "7205 AC", "62205",
    "NU205", "30205", "x", "", "6205/C1", "ER16K", "218/C3", "6-205", "TIMKEN 6205 TIMKEN",
]  # fmt: skip


def test_names_are_read_as_in_python(ask):
    """Name, suffixes with meanings and class; kinds of bearings that are not there."""
    body = """const read = designation(asked);
    return read ? { ...read, words: wordsOf(read) } : allowedNames(asked);"""
    for typed, here in zip(TYPED, ask(body, TYPED), strict=True):
        there = designation(typed, ROWS)
        if there is None:
            assert isinstance(here, str) and kind_of(typed) in here, typed
            continue
        suffixes = [list(one) for one in there.suffixes]
        told = {"name": there.name, "suffixes": suffixes, "clearance": there.clearance}
        assert here == told | {"words": there.words}, typed


@pytest.mark.long
def test_ten_bearings_under_axial_load_and_more(ask):
    assert stood(ask, drawn(14, seed=11, axial=True)) >= 10
    assert stood(ask, drawn(10)) >= 6


def test_assumptions_that_do_not_hold_are_those_of_python(ask):
    """Heat of the inlet, for oils by grade and by viscosity; stress of thick oils; at both races."""
    oils = [Lubricant.iso_vg(grade, temperature=t) for grade, t in ((32, 45.0), (68, 60.0), (460, 50.0))]
    oils += [Lubricant(eta0=0.024, alpha=1.8e-8), Lubricant(eta0=0.1, alpha=1.05e-8)]
    cases = [case(oil=oil, rpm=rpm, clearance=2e-6) for oil in oils for rpm in (300.0, 1300.0)]
    cases += [case(oil=oils[4], rpm=9e4), *(case(oil=oils[1], rpm=rpm, load=(0.0, -300.0)) for rpm in (9e3, 3e4))]
    body = "return outsideAssumptions(new Bearing(asked.bearing, asked.oil, atlas).under(asked.load, asked.rpm));"
    headlines = [
        bearing_of(one).equilibrium(one["load"], speed_rpm=one["rpm"]).outside_assumptions for one in cases
    ]
    assert ask(body, cases) == headlines
    assert any("newtonian" in text for text in headlines) and sum(text == "" for text in headlines) > 3
    assert "isothermal (shear heats the inlet: film 5" in headlines[-1]


def same_refusal(here, there):
    """The same input, refused with the same words."""
    if here is None or here["field"] != there.field or here["allowed"] != there.allowed:
        return False
    return here["value"] == pytest.approx(there.value, rel=CLOSE)


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
OILS = [{"alpha": 9.9e-9}, {"alpha": 5e-8}, {"eta0": 1.01}, {"eta0": 4.9}, {"alpha": 4e-8, "eta0": 0.002}]


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
    {"clearance": 1e-3}, {"clearance": -4e-4}, {"rpm": 0.0}, {"rpm": 60000.0}, {"load": (0.0, -2e4)},
    {"load": (0.0, -100.0, 2e4)},
    {"oil": {"eta0": 1.2, "alpha": 2e-8}}, {"oil": {"eta0": 0.03, "alpha": 5e-8}},
    {"load": (0.0, 0.0), "clearance": -3.5e-4}, {"conformity_inner": 1.04},
]  # fmt: skip


def test_what_is_no_bearing_is_refused_as_in_python(ask):
    cases = [case(**changes) for changes in NO_BEARINGS]
    for one, here in zip(cases, ask(BEARING, cases), strict=True):
        there = python_of(one)
        assert isinstance(there, InputError) and same_refusal(here.get("refused"), there), (here, there)


def test_axial_load_that_an_angular_contact_bearing_wants(ask):
    """Named by the input of the page; in Python the load is one argument."""
    cases = [case("7205 B", load=load) for load in ((0.0, -100.0), (0.0, -100.0, -50.0))]
    for one, here in zip(cases, ask(BEARING, cases), strict=True):
        assert python_of(one).field == "load" and here["refused"]["field"] == "axial_load"


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
