"""Heat in the atlas: contacts left out of the table, the 6305 of docs/notes/heat.md, limits, what it refuses."""

from dataclasses import replace

import numpy as np
import pytest

from ehlcontact import Heat, InputError, Lubricant, MoesPoint, OperatingPoint
from ehlcontact.hertz import most_loaded_ball
from reduced_models.atlas.gain_fit import heated_gains
from reduced_models.atlas.heat import (
    FASTEST,
    HEAT_OMEGAS,
    KNOWN,
    NUMBERS,
    RECIPE,
    changes_of,
    intervals_of,
    solve_heated,
    unit_of,
)
from reduced_models.atlas.surface import Surface
from reduced_models.atlas.surface import shipped as shipped_surface
from reduced_models.bearing.catalogue import deep_groove_row

OIL = Lubricant.iso_vg(68, temperature=50.0)
DISC = OperatingPoint.ball_on_flat(OIL, ball_diameter=0.02, entrainment_speed=1.0, load=50.0)


def ball(name, rpm, load, oil=OIL):
    """The most loaded ball on the inner race."""
    _, row = deep_groove_row(name)
    return OperatingPoint.ball_bearing(
        oil,
        ball_diameter=row.ball_diameter,
        pitch_diameter=row.pitch_diameter,
        conformity=row.conformity,
        speed_rpm=rpm,
        load=most_loaded_ball(load, row.balls),
    )


@pytest.fixture(scope="module")
def held_out():
    """Errors of contacts that a table does not have, their bars, and what heat changes there, (n, 4 + 2 k).

    All contacts are left out, a tenth of them at a time.
    """
    table = shipped_surface("heat").table
    g = RECIPE.unit(table, table.points)[:, None]
    changes = g * table["changes"]
    error, bars = np.zeros((2, *changes.shape))
    part = np.random.default_rng(1).permutation(len(table.points)) % 10
    for k in range(10):
        out = part == k
        columns = {"changes": table.columns["changes"][~out]}
        rest = Surface(replace(table, points=table.points[~out], columns=columns))
        found, bars[out] = rest.at(table.points[out])
        error[out] = found - changes[out]
    return error, bars, changes


def test_contacts_left_out_lie_in_their_bars(held_out):
    """Bars of the interpolation alone; answers have those of meshes beside them."""
    error, bars, _ = held_out
    inside = np.abs(error) <= bars
    assert len(inside) > 100 and inside.mean() >= 0.95
    for k in (*range(len(NUMBERS)), len(NUMBERS), len(NUMBERS) + len(HEAT_OMEGAS)):
        assert inside[:, k].mean() >= 0.93  # of a hundred, 2 is the standard deviation


def test_what_heat_changes_is_found_to_a_small_part(held_out):
    """The laziest table has no change at all, the next the factor of Wilson and Sheu for every film."""
    error, bars, change = held_out
    film, C = NUMBERS.index("h_central"), len(NUMBERS) + len(HEAT_OMEGAS)
    for k, most in ((film, 0.01), (C, 0.02)):
        assert np.sqrt(np.mean(error[:, k] ** 2)) < most
        assert np.sqrt(np.mean(error[:, k] ** 2)) < 0.1 * np.sqrt(np.mean(change[:, k] ** 2))
    assert np.median(bars[:, film]) < 0.02
    assert np.median(bars[:, C]) < 0.05


def test_6305_at_10000_rpm(shipped):
    """Solved with n = 128 in docs/notes/heat.md: film .827 -> .624 um, C 92.8 -> 57.2 N s/m, K 143.1."""
    point = ball("6305", 10_000.0, 2000.0)
    cold, warm = shipped.at(point), shipped.at(point, thermal=Heat())
    assert warm.h_central / cold.h_central == pytest.approx(0.624 / 0.827, abs=0.015)
    assert warm.damping[0] / cold.damping[0] == pytest.approx(57.2 / 92.8, abs=0.03)
    for name, solved in (("h_central", 0.624e-6), ("damping", 57.2), ("stiffness", 143.1e6)):
        value, bar = (np.ravel(part)[0] for part in (getattr(warm, name), warm.error_bars[name]))
        assert abs(value - solved) <= bar
    hot = shipped.at(point, thermal=Heat()).temperature
    assert hot.film_share == pytest.approx(warm.h_central / cold.h_central, rel=1e-12)
    assert hot.thermal_load == pytest.approx(1.387, abs=0.001)
    assert hot.inputs.temperature == 50.0


def test_element_follows_the_answer(shipped):
    point, Omega = ball("6305", 10_000.0, 2000.0), np.array([0.05, 0.3, 1.0, 2.0, 6.0])
    answer = shipped.at(point, thermal=Heat())
    for model in ("wide", "memory"):
        element = shipped.element(point, model, thermal=Heat())
        found = element.impedance(Omega=Omega)
        wanted = answer.impedance(Omega=Omega)
        np.testing.assert_allclose(found.damping, wanted.damping, rtol=0, atol=0.05 * wanted.damping[0])
        np.testing.assert_allclose(found.stiffness, wanted.stiffness, rtol=0.01)
    assert element.source["thermal"]["temperature"] == 50.0
    assert element.source["assumptions"]["isothermal"]["holds"] is None
    assert shipped.element(point).source["assumptions"]["isothermal"]["holds"] is False


def test_elements_damp_as_much_as_their_answers_where_heat_is_strong(shipped):
    """C over the answer's, root mean square of 20 contacts of another sample with Q > 1.

    3.7 % without heat at the first three frequencies and 1.5 to 1.6 % with it. The error of the isothermal gains
    added as it is makes 5.6 %, a fit without it and without weights 4.3 %, isothermal gains times what heat
    leaves of C at rest 3.3 %.
    """
    hz = np.array([20.0, 200.0, 2000.0, 6000.0])
    points = [one.point for one in RECIPE.sample(256, 5).values()]
    points = [point for point in points if Heat().at(point).load(point.moes, point.scales) > 1.0][:20]
    for heat, most in ((None, 0.04), (Heat(), 0.02)):
        ratios = []
        for point in points:
            found = shipped.element(point, "memory", thermal=heat).impedance(hz=hz)
            ratios.append(found.damping / shipped.at(point, thermal=heat).impedance(hz=hz).damping)
        assert np.sqrt(np.mean((np.array(ratios) - 1.0) ** 2, axis=0)).max() < most


def test_gains_stay_where_heat_changes_nothing(shipped):
    table, point = shipped._table, ball("6305", 10_000.0, 2000.0).moes
    answer = shipped.at(point)
    low, Z = answer.damping[table.interpolation.reference], answer.stiffness + 1j * answer.damping
    gains = np.array(shipped.element(point, "memory").gains) / low
    again = heated_gains(answer.omega, Z, Z, gains, shipped._rates, low)
    np.testing.assert_allclose(again, gains, rtol=0, atol=1e-9 * gains.max())
    hot = heated_gains(answer.omega, Z, Z.real + 0.6j * Z.imag, gains, shipped._rates, low)
    assert hot.min() >= 0.0
    assert hot.sum() == pytest.approx(0.6 * gains.sum(), rel=0.1)


def test_a_slow_contact_does_not_heat_up(shipped):
    point = ball("6305", 300.0, 300.0)
    cold, warm = shipped.at(point), shipped.at(point, thermal=Heat())
    assert warm.h_central == pytest.approx(cold.h_central, rel=0.01)
    assert warm.h_central < cold.h_central
    assert warm.damping[0] == pytest.approx(cold.damping[0], rel=0.02)


def test_bars_grow_where_the_sample_ends(shipped):
    inside, light = ball("6305", 10_000.0, 2000.0), ball("6305", 10_000.0, 2.0)
    for point in (inside, light):
        share = [shipped.at(point, thermal=heat) for heat in (None, Heat())]
        assert (
            share[1].error_bars["h_central"]
            >= share[1].h_central / share[0].h_central * share[0].error_bars["h_central"]
        )


@pytest.mark.parametrize(
    ("field", "given"),
    [
        ("slide_roll", (ball("6305", 1000.0, 500.0), Heat(slide_roll=0.05))),
        ("thermal load Q", (ball("6305", 22_000.0, 500.0), Heat())),
        ("thermal", (MoesPoint(300.0, 12.0, 0.2), Heat())),
        ("temperature_slope", (ball("6305", 1000.0, 500.0, Lubricant(0.04, 2e-8)), Heat())),
        ("temperature", (ball("6305", 1000.0, 500.0, Lubricant(0.04, 2e-8)), Heat(temperature_slope=0.04))),
        ("heat_capacity", (ball("6305", 1000.0, 500.0), Heat(heat_capacity=4e6))),
        ("effusivity", (ball("6305", 1000.0, 500.0), Heat(effusivity=(13_000.0, 1500.0)))),
        (
            "kappa",
            (OperatingPoint.ball_on_flat(OIL, ball_diameter=0.02, entrainment_speed=1.0, load=50.0), Heat()),
        ),
    ],
)
def test_refused(shipped, field, given):
    point, thermal = given
    for call in (shipped.at, shipped.element):
        with pytest.raises(InputError) as error:
            call(point, thermal=thermal)
        assert error.value.field == field
        assert "\n" not in str(error.value)


def test_sample_is_of_bearings_and_grows():
    few, more = RECIPE.sample(32, 3), RECIPE.sample(64, 3)
    assert few.items() <= more.items()
    for one in more.values():
        assert one.point.u_sum <= 2.0 * FASTEST * (1.0 + 1e-12)
        assert intervals_of(one.point) is not None
        assert 0.009 < one.heat.at(one.point).load(one.point.moes, one.point.scales) < 5.1


@pytest.mark.slow
def test_new_contacts_are_in_the_bars_of_the_shipped_table():
    """Eight contacts of another sample, solved here."""
    surface, inside = shipped_surface("heat"), []
    contacts = [c for c in RECIPE.sample(64, 99).values() if intervals_of(c.point) == 64][:8]
    for one in contacts:
        entry = solve_heated(one)
        row = np.array([[entry[name] for name in KNOWN]])
        found, bars = surface.at(row)
        change = unit_of(entry["thermal_load"]) * changes_of(entry)
        inside.append(np.abs(found[0] - change) <= bars[0])
    assert np.mean(inside) >= 0.9
