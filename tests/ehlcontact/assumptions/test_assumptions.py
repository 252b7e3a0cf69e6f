"""What is assumed: every number computed a second time, published values, and what is not known left unjudged."""

import json
from dataclasses import replace
from math import e, pi, sqrt

import numpy as np
import pytest
from balls import OF_6205
from scipy.optimize import brentq

from ehlcontact import (
    Domain,
    Grid,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    assumptions,
    impedance,
    solve_steady,
)
from ehlcontact.assumptions import Assumptions
from ehlcontact.assumptions.contact import Contact
from ehlcontact.film_formulas import (
    flooding_distance,
    gupta_heating,
    starved_film,
    wilson_heating,
)
from ehlcontact.hertz import shape_factor
from reduced_models import Atlas, BallBearing

OIL = Lubricant.iso_vg(68, temperature=50.0)
NAMES = ["isothermal", "newtonian", "smooth", "fully flooded", "constant speed", "one direction", "elastic"]


def bearing(rpm=3000.0, oil=OIL, load=486.0):
    """A ball of a 6205 on its inner race."""
    return OperatingPoint.ball_bearing(oil, **OF_6205, speed_rpm=rpm, load=load)


# Each number a second time, from the SI inputs -------------------------------------------------------------------
def test_si_is_recovered_from_the_scales():
    """Rx, E' and the speed, which scales and Moes numbers hold only together."""
    point = bearing()
    _, radius, modulus, speed = Contact.of(point, None).require_si()
    assert radius == pytest.approx(point.geometry.radius_x, rel=1e-9)
    assert modulus == pytest.approx(point.geometry.e_reduced, rel=1e-9)
    assert speed == pytest.approx(point.u_sum / 2.0, rel=1e-12)


def test_numbers_of_a_bearing():
    point = bearing(6000.0)
    table = assumptions(point, domain=Domain(), roughness=(2e-8, 6e-8), vibration=0.05)
    assert [a.name for a in table] == NAMES
    u, rx, modulus = point.u_sum / 2.0, point.geometry.radius_x, point.geometry.e_reduced

    load = OIL.temperature_slope * OIL.eta0 * u**2 / 0.134
    p = point.scales.pressure / modulus
    expected = (1.0 - 13.2 * p * load**0.42) / (1.0 + 0.213 * load**0.64)
    assert table["isothermal"].value == pytest.approx(expected, rel=1e-9)
    assert table["isothermal"].details["thermal_load"] == pytest.approx(load, rel=1e-9)

    h_c = point.moes.expected_film * point.scales.length
    stress = 1.5 * e * OIL.eta0 * u / h_c
    assert table["newtonian"].value == pytest.approx(stress / 5e6, rel=1e-9)
    sliding = table["newtonian"].details["slide_roll_limit"]
    assert e * OIL.eta0 * sliding * u / h_c == pytest.approx(
        5e6, rel=1e-9
    )  # Couette stress at that slide-roll ratio

    k, U = 1.0 / point.moes.kappa, OIL.eta0 * u / (modulus * rx)
    h_min = rx * 3.63 * U**0.68 * (OIL.alpha * modulus) ** 0.49
    h_min *= (point.load / (modulus * rx**2)) ** -0.073 * (1.0 - np.exp(-0.68 * k))
    assert table["smooth"].details["h_min"] == pytest.approx(h_min, rel=1e-9)
    assert table["smooth"].value == pytest.approx(h_min / sqrt(2e-8**2 + 6e-8**2), rel=1e-9)

    m = 1.0 + 3.06 * ((rx / point.scales.a) ** 2 * h_c / rx) ** 0.58
    flooded = table["fully flooded"]
    assert (flooded.value, flooded.limit) == (4.5, pytest.approx(m, rel=1e-9))
    assert flooded.details["distance"] == pytest.approx((m - 1.0) * point.scales.a, rel=1e-9)

    assert table["constant speed"].value == pytest.approx(0.05 / u, rel=1e-12)
    assert table["constant speed"].details["crossing_time"] == pytest.approx(2.0 * point.scales.a / u, rel=1e-12)
    assert table["one direction"].value == pytest.approx(0.05 / u, rel=1e-12)
    assert table["elastic"].value == pytest.approx(point.scales.pressure, rel=1e-12)


def test_solved_film_replaces_the_expected_one(steady):
    film = steady(200, 10, 0.5, 64)
    table = assumptions(film.point, film=film)
    assert table["fully flooded"].value == -film.domain.x_in
    wanted = flooding_distance(film.h_central / (2.0 * shape_factor(0.5)))
    assert table["fully flooded"].limit == pytest.approx(wanted, rel=1e-12)
    point = bearing()
    given = assumptions(point, film=replace(film, point=point.moes).in_units_of(point), roughness=(1e-7, 1e-7))
    assert given["smooth"].details["h_min"] == pytest.approx(film.h_min * point.scales.length)
    with pytest.raises(InputError, match=r"^film = 'of the point M 200, .* one of this point, M "):
        assumptions(point, film=film)


def test_unknown_slope_is_that_of_a_typical_oil():
    bare = replace(OIL, temperature_slope=None)
    ours, typical = (assumptions(bearing(oil=oil))["isothermal"] for oil in (OIL, bare))
    assert typical.details["temperature_slope"] == pytest.approx(OIL.temperature_slope, rel=0.15)
    assert typical.value == pytest.approx(ours.value, abs=0.01)


# Verdicts --------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("name", "arguments", "words"),
    [
        ("isothermal", dict(point=bearing(10000.0)), "thinner"),
        ("newtonian", dict(point=bearing(), film_factor=0.1), "shears the inlet"),
        ("smooth", dict(point=bearing(), roughness=(1e-7, 1e-7)), "mixed"),
        ("smooth", dict(point=bearing(), roughness=(4e-7, 4e-7)), "boundary"),
        ("fully flooded", dict(point=bearing(), domain=Domain(-1.3)), "below the flooded one"),
        ("constant speed", dict(point=bearing(), vibration=0.1), "vibration"),
        ("one direction", dict(point=bearing(), vibration=1.0), "vibration"),
        ("elastic", dict(point=bearing(load=6000.0)), "dents"),
    ],
)
def test_out_of_range_is_said_in_the_headline(name, arguments, words):
    factor = arguments.pop("film_factor", None)
    if factor is not None:
        point = arguments["point"]

        class Film:
            h_central = h_min = factor * point.moes.expected_film
            domain = Domain()

        arguments["film"] = Film()
    table = assumptions(**arguments)
    assert table[name].holds is False and words in table[name].verdict
    assert name in table.headline and table.headline.startswith("Outside what is assumed: ")
    assert name in table.to_dict()["out_of_range"]


def test_what_is_not_covered_is_not_called_impossible():
    """A vibration faster than the rolling reverses it: no verdict may say that this does not happen."""
    found = assumptions(bearing(), vibration=30.0)
    said = found["one direction"].verdict
    assert not found["one direction"].holds and said.endswith("across; a reversal needs `speed=` of `simulate`")
    change, crossing = (found["constant speed"].details[name] for name in ("largest_change", "crossing_time"))
    claim = (
        f"a change of {change:.2g} m/s within the {crossing * 1e6:.2g} µs that the film takes to cross makes 1 %"
    )
    assert claim in found["constant speed"].verdict


def test_nothing_out_of_range_is_no_headline():
    table = assumptions(bearing(), domain=Domain(), roughness=(1e-8, 3e-8), vibration=1e-3)
    assert table.headline == "" and all(a.holds for a in table) and table.not_judged == ()


def test_dimensionless_point_is_judged_as_far_as_it_goes():
    table = assumptions(MoesPoint(200, 10, 0.5), domain=Domain(), roughness=(1e-8, 1e-8), vibration=0.1)
    assert [a.name for a in table if a.holds] == ["fully flooded", "elastic"]
    assert len(table.not_judged) == 5 and table.headline == ""
    assert assumptions(MoesPoint(200, 0, 0.5))["elastic"].holds is None  # L = 0: a limit, no pressure


def test_table_is_json_and_short_is_short():
    table = assumptions(bearing(), domain=Domain())
    document = json.loads(json.dumps(table.to_dict(), allow_nan=False))
    assert [row["name"] for row in document["table"]] == NAMES
    assert all(row["source"] and row["scatter"] and row["verdict"] for row in document["table"])
    short = json.loads(json.dumps(table.short(), allow_nan=False))
    assert list(short) == NAMES and short["smooth"] == {"value": None, "limit": 3.0, "holds": None}


# Published values ------------------------------------------------------------------------------------------------
@pytest.mark.literature
@pytest.mark.parametrize("rpm", [1000.0, 3000.0, 6000.0, 10000.0])
def test_heating_like_the_catalogue(rpm):
    """SKF, Rolling bearings (2018), friction: 1/(1 + 1.84e-9 (n dm)^1.28 nu^0.64), n in rpm, dm in mm."""
    nu = OIL.eta0 / 853.0 * 1e6
    catalogue = 1.0 / (1.0 + 1.84e-9 * (rpm * 38.5) ** 1.28 * nu**0.64)
    found = assumptions(bearing(rpm))["isothermal"]
    assert found.value == pytest.approx(catalogue, abs=0.08)
    assert found.value < catalogue < found.details["wilson"] + 0.02  # between two published formulas


@pytest.mark.literature
def test_heating_formulas():
    """Gupta et al. (1992) without pressure, and Wilson and Sheu (1983): 0.241 L^0.64 with the mean speed."""
    for load in (0.01, 0.1, 1.0, 10.0):
        assert gupta_heating(load, 0.0) == pytest.approx(1.0 / (1.0 + 0.213 * load**0.64), rel=1e-12)
        assert wilson_heating(load) == pytest.approx(1.0 / (1.0 + 0.241 * load**0.64), rel=5e-3)
    assert gupta_heating(1e4, 0.016) == 0.0


@pytest.mark.literature
@pytest.mark.parametrize(("kappa", "x_in"), [(0.5, -1.75), (0.5, -1.5), (1.0, -1.5)])
def test_starved_films_follow_hamrock_and_dowson(steady, kappa, x_in):
    """Their part IV (1977) against films solved here with oil from x_in on."""
    flooded = steady(200, 10, kappa, 64)
    n = 16 * round(64 * (1.5 - x_in) / 6.0 / 16)
    starved = solve_steady(flooded.point, grid=Grid(n=n, domain=Domain(x_in, 1.5, 3.0)))
    edge = flooding_distance(flooded.h_central / (2.0 * shape_factor(kappa)))
    assert starved.h_central / flooded.h_central == pytest.approx(starved_film(-x_in, edge), rel=0.06)


def grubin_film(eta, u, alpha, stress):
    """Film of Ertel and Grubin's inlet (line contact, a = 70 um, R = 3.3 mm, Barus) of an Eyring oil [m].

    The inlet ends where alpha p = 3, by when 95 % of the reduced pressure is there.
    """
    a, R, steps = 70e-6, 3.3e-3, 400
    X = -1.0 - 3.0 * (1.0 - np.linspace(0.0, 1.0, steps)) ** 2
    X = 0.5 * (X[1:] + X[:-1])
    dx = np.diff(-1.0 - 3.0 * (1.0 - np.linspace(0.0, 1.0, steps)) ** 2) * a
    gap = a * a / (2.0 * R) * (-X * np.sqrt(X * X - 1.0) - np.log(-X + np.sqrt(X * X - 1.0)))
    grid = np.concatenate([np.linspace(0.0, 1e-2, 50), np.geomspace(1.01e-2, 50.0, 4000)])
    flow = 3.0 * (grid * np.cosh(grid) - np.sinh(grid)) / np.maximum(grid, 1e-30) ** 2
    flow[grid < 1e-2] = grid[grid < 1e-2]

    def excess(log_film):
        h_star, p = np.exp(log_film), 0.0
        for g, d in zip(gap, dx, strict=True):
            h = h_star + g
            newton = 6.0 * eta * np.exp(min(alpha * p, 50.0)) * u * g / h**2
            wall = newton if stress is None else stress * np.interp(newton / stress, flow, grid)
            p += 2.0 * wall / h * d
            if alpha * p > 4.0:
                return 1.0
        return alpha * p - 3.0

    return float(np.exp(brentq(excess, np.log(1e-8), np.log(2e-5), xtol=1e-5)))


@pytest.mark.parametrize(("eta", "u", "loss"), [(0.0367, 9.8, 0.004), (0.15, 30.0, 0.017)])
def test_pure_rolling_hardly_thins_an_eyring_oil(eta, u, loss):
    """The number of `newtonian`, 0.28 and 0.73 here, against the film that it takes: 3 % where it is 1."""
    newton = grubin_film(eta, u, 2e-8, None)
    lost = 1.0 - grubin_film(eta, u, 2e-8, 5e6) / newton
    number = 1.5 * e * eta * u / newton / 5e6
    assert lost == pytest.approx(loss, abs=0.0015)
    assert lost < 0.04 * number


# Bad input -------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("point", dict(point="6205")),
        ("domain", dict(domain=(-4.5, 1.5, 3.0))),
        ("roughness", dict(roughness=0.1)),
        ("roughness", dict(roughness=(1e-7,))),
        ("roughness", dict(roughness=(1e-7, -1e-7))),
        ("roughness", dict(roughness=(0.05, 0.1))),  # um
        ("roughness", dict(roughness=(1e-7, float("nan")))),
        ("vibration", dict(vibration=-0.1)),
        ("vibration", dict(vibration="slow")),
        ("temperature_slope", dict(temperature_slope=0.0)),
        ("conductivity", dict(conductivity=float("inf"))),
        ("conductivity", dict(conductivity=None)),
    ],
)
def test_bad_input_is_named(field, arguments):
    with pytest.raises(InputError) as caught:
        assumptions(**({"point": bearing()} | arguments))
    assert caught.value.field == field and "\n" not in str(caught.value)


def test_unknown_assumption_is_named():
    with pytest.raises(InputError, match=r"^assumption = 'incompressible': must be one of isothermal"):
        assumptions(bearing())["incompressible"]


def test_hertz_pressure_by_hand():
    point = bearing()
    assert assumptions(point)["elastic"].value == pytest.approx(
        1.5 * point.load / (pi * point.scales.a * point.scales.b), rel=1e-12
    )


# In every answer -------------------------------------------------------------------------------------------------
def test_answers_name_what_does_not_hold():
    """Film, impedance and answer of the atlas: at the prompt and in JSON; nothing where all holds."""
    fast, grid = bearing(20000.0), Grid(n=64)
    for point, outside in ((fast, True), (bearing(1000.0, load=50.0), False)):
        for found in (solve_steady(point, grid=grid), impedance(point, hz=500.0, grid=grid), Atlas().at(point)):
            said = found.outside_assumptions
            film = getattr(found, "film", found)
            assert said == assumptions(found.point, film=film).headline
            assert found.to_dict()["outside_assumptions"] == said and ("isothermal" in said) is outside
            assert ("heats the inlet: film" in repr(found)) is outside and len(repr(found).splitlines()) <= 5
    lost = solve_steady(fast, grid=grid, max_cycles=1, throw=False)
    assert lost.outside_assumptions == "" and not lost.status.ok  # the film is not known


def test_a_bearing_names_what_does_not_hold_at_its_worst_contact():
    kind = BallBearing.catalogue("6205", oil=OIL, rq_race=0.5e-6)
    state, at = (
        kind.equilibrium((0.0, -1000.0), speed_rpm=20000.0),
        kind.coefficients((0.0, -1000.0), speed_rpm=20000.0, hz=100.0),
    )
    for found in (state, at):
        said = found.outside_assumptions
        assert "isothermal" in said and "smooth" in said and said in found.to_dict().values()
        assert "isothermal" in repr(found) and len(repr(found).splitlines()) <= 5
    contacts = []
    for k, name in enumerate(("inner", "outer")):
        point = kind.race(name).point(state.force[:, k].max(), 20000.0)
        contacts.append(assumptions(point, film=Atlas().at(point), roughness=(0.5e-6 / sqrt(2.0),) * 2))
    worst = min(contact["isothermal"].value for contact in contacts)
    assert Assumptions.worst_of(contacts)["isothermal"].value == worst
    assert state.outside_assumptions == Assumptions.worst_of(contacts).headline
    assert BallBearing.catalogue("6205").equilibrium((0.0, -1000.0)).outside_assumptions == ""  # dry


def test_the_worst_of_contacts_is_judged_before_one_that_is_not():
    rough, unknown = (assumptions(bearing(), roughness=rq) for rq in ((2e-7, 2e-7), None))
    assert Assumptions.worst_of([unknown, rough])["smooth"].value == rough["smooth"].value
    assert Assumptions.worst_of([unknown, unknown])["smooth"].value is None
