"""Table of contact filters: its interpolation, points that it was not made of, and its build.

``held_out_waves.json`` has points of the same Sobol sequence beyond those of the table, solved in the same way;
``python tests/reduced_models/atlas/test_waves.py FOLDER`` writes it, from a work folder of 96 draws.
"""

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from ehlcontact import Geometry, Grid, InputError, Lubricant, MoesPoint, OperatingPoint, excitation
from ehlcontact.content_store import ContentStore
from reduced_models.atlas.build import entry_key
from reduced_models.atlas.surface import shipped
from reduced_models.atlas.waves import (
    BOX,
    RECIPE,
    WAVE_NUMBERS,
    contact_filter,
    dry_filter,
    film_over_dry,
    films_over_dry,
    filters_of,
)

HELD_OUT = Path(__file__).with_name("held_out_waves.json")
SOLVED = 96  # draws, of which the table has the first
K = np.array(WAVE_NUMBERS)


@pytest.fixture(scope="module")
def held_out():
    """Rows (M, L, kappa) and G/Z of points that the table was not made of."""
    entries = json.loads(HELD_OUT.read_text())
    return np.array(entries["points"]), np.array(entries["real"]) + 1j * np.array(entries["imag"])


def test_points_that_were_held_out_lie_inside_their_bars(held_out):
    """95 of 100, and the errors are a tenth of those of the dry filter, or of one for all contacts."""
    points, G = held_out
    table = shipped("waves").table
    contacts = filters_of(points)
    found, bars = (np.array(part).T for part in zip(*(contacts.at(k) for k in K), strict=True))
    error = np.abs(found - G)
    assert len(points) >= 20 and (error <= bars.real).mean() >= 0.95
    assert np.median(bars.real) < 0.02
    for lazy in (dry_filter(K), (table["real"] + 1j * table["imag"]).mean(axis=0)):
        assert np.sqrt(np.mean(error**2)) < 0.1 * np.sqrt(np.mean(np.abs(lazy - G) ** 2))


def test_the_table_at_its_own_points():
    table = shipped("waves").table
    for i in (0, 7, 31):
        M, L, kappa = table.points[i].tolist()
        found = contact_filter(MoesPoint(M, L, kappa), wavelength=2.0 * np.pi / K)
        np.testing.assert_allclose(found.ratio, table["real"][i] + 1j * table["imag"][i], atol=2e-6)
        np.testing.assert_array_equal(found.contact_filter, np.abs(found.ratio))


def test_between_wave_numbers_and_beyond():
    """A spline through the nodes and 1; long waves are an approach, shorter ones than those of the table 0."""
    contacts = filters_of(np.array([[300.0, 12.0, 0.11], [2000.0, 18.0, 0.4]]))
    nodes = np.array([contacts.at(k)[0] for k in (0.0, *K)])
    spline = CubicSpline([0.0, *K], nodes)
    for k in ([0.03, 5.5], [1.1, 2.9]):
        np.testing.assert_allclose(contacts.at(k)[0], [spline(k[0])[0], spline(k[1])[1]], atol=1e-12)
    np.testing.assert_array_equal(nodes[0], 1.0)
    value, bar = contacts.at(7.0)
    assert not value.any() and (bar == 0.03).all()
    assert abs(contact_filter(MoesPoint(300.0, 12.0, 0.11), wavelength=500.0).ratio[0] - 1.0) < 1e-3


def test_contacts_outside_have_the_filter_of_the_nearest_inside():
    light, least = (filters_of(np.array([[M, 12.0, 0.11]])).at(1.5) for M in (0.01, BOX.M[0]))
    np.testing.assert_array_equal(light, least)


def test_fewer_draws_are_among_more():
    few, many = RECIPE.sample(20, RECIPE.numbers["seed"]), RECIPE.sample(33, RECIPE.numbers["seed"])
    assert all(many[name] == point for name, point in few.items())
    assert set(few) <= set(many)
    for name in ("M", "L", "kappa"):
        low, high = getattr(BOX, name)
        assert all(low * (1 - 1e-9) <= getattr(point, name) <= high * (1 + 1e-9) for point in many.values())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (((1.0, 12.0, 0.11), 4.0), "M = 1.0: must be between 20 and 20000"),
        (((300.0, 12.0, 0.9), 4.0), "kappa = 0.9: must be between 0.06 and 0.5"),
        (((300.0, 12.0, 0.11), [4.0, 0.0]), "wavelength = .*finite and > 0"),
        (((300.0, 12.0, 0.11), float("nan")), "wavelength"),
        (((300.0, 12.0, 0.11), []), "wavelength"),
    ],
)
def test_bad_input_is_one_line(arguments, message):
    with pytest.raises(InputError, match=message):
        contact_filter(MoesPoint(*arguments[0]), wavelength=arguments[1])


def test_wavelengths_are_in_the_units_of_the_point():
    point = OperatingPoint(Geometry(3e-3, 60e-3), Lubricant(0.05, 2e-8), 200.0, 5.0)
    lengths = np.array([16.0, 4.0])
    found = contact_filter(point, wavelength=lengths * point.scales.a)
    plain = contact_filter(point.moes, wavelength=lengths)
    np.testing.assert_allclose(found.contact_filter, plain.contact_filter, rtol=1e-12, atol=0.0)
    np.testing.assert_allclose(found.wavelength, lengths * point.scales.a, rtol=1e-14, atol=0.0)
    np.testing.assert_allclose(found.dimensionless.wavelength, lengths, rtol=1e-14, atol=0.0)
    assert "µm" in repr(found) and "semi-axes" in repr(plain)
    with pytest.raises(InputError, match=r"^wavelength = 4\.0: must be at most 0\.179 m .*semi-axes"):
        contact_filter(point, wavelength=4.0)


def test_film_over_dry_filter():
    """Their ratio up to k = 2; smooth there, and a Gaussian beyond, where the dry filter has zeros."""
    point, k = MoesPoint(200.0, 10.0, 0.5), np.array([0.5, 1.0, 2.0])
    film = contact_filter(point, wavelength=2.0 * np.pi / k).ratio
    np.testing.assert_allclose(film_over_dry(point, k), film / dry_filter(k), rtol=1e-12)
    still, before, after, far = film_over_dry(point, [0.0, 2.0, 2.0 + 1e-9, 2.0 * np.sqrt(2.0)])
    assert still == pytest.approx(1.0) and after == pytest.approx(before, abs=1e-8)
    assert abs(far) == pytest.approx(abs(before) ** 2)
    with pytest.raises(InputError, match=r"k = .*finite and >= 0"):
        film_over_dry(point, [-1.0])


def test_films_over_dry_of_many_contacts():
    """One by one the same; outside the box that of its edge."""
    rows, k = (
        np.array([[1300.0, 14.5, 0.13], [60.0, 9.0, 0.3], [5.0, 9.0, 0.3], [20.0, 9.0, 0.3]]),
        np.linspace(0, 6, 5),
    )
    found = films_over_dry(rows, k[:, None] * np.ones(4))
    for row, own in zip(rows[:2].tolist(), found.T, strict=False):
        np.testing.assert_allclose(own, film_over_dry(MoesPoint(*row), k), rtol=1e-10)
    np.testing.assert_allclose(found[:, 2], found[:, 3], rtol=1e-10)
    assert np.abs(found[1] - found[1, 0]).max() > 0.1


@pytest.mark.parametrize(
    "row",
    [
        (200.0, 10.0, 0.5),
        *(
            pytest.param(row, marks=pytest.mark.long)
            for row in ((750.0, 18.3, 0.107), (60.0, 6.0, 0.12), (6000.0, 15.0, 0.1))
        ),
    ],
)
def test_against_finer_meshes(row):
    """Points of no sequence, n = 128: within 3 % of |Z| h at all wavelengths, within 3 % of G/Z from 4 a on."""
    waves = np.array([16.0, 8.0, 4.0, 3.0, 2.0])
    there = excitation(MoesPoint(*row), wavelength=waves, grid=Grid(n=128)).contact_filter
    here = contact_filter(MoesPoint(*row), wavelength=waves).contact_filter
    np.testing.assert_allclose(here, there, atol=0.015)
    np.testing.assert_allclose(here[:3], there[:3], rtol=0.03)


def hold_out(work):
    """Write the points beyond those of the table."""
    store, entries = ContentStore(work, "work folder"), []
    for name, point in RECIPE.sample(SOLVED, RECIPE.numbers["seed"]).items():
        if int(name.partition("-")[2]) >= RECIPE.numbers["draws"]:
            entries.append(json.loads(store.get(entry_key(RECIPE.solve, point))))
    good = [one for one in entries if one["status"] == "converged"]
    found = {"points": [[one["M"], one["L"], one["kappa"]] for one in good]}
    found |= {name: [[round(v, 5) for v in one[name]] for one in good] for name in ("real", "imag")}
    HELD_OUT.write_text(json.dumps(found) + "\n")


if __name__ == "__main__":
    hold_out(Path(sys.argv[1]))
