"""Oil supply in the atlas: the table gives back what it is made of, flooded is its limit, elements are passive."""

import numpy as np
import pytest
from atlas_stub import supplied

from ehlcontact import InputError, MoesPoint, OilLayer
from ehlcontact.film_formulas import film_of_layer, layer_sharpness
from ehlcontact.jit import plain
from ehlcontact.lubricant import density
from reduced_models import Atlas
from reduced_models.atlas.build import assemble
from reduced_models.atlas.supply import RECIPE, Supplied, changes_of, heaviest_load, lightest_load, solve_layers
from reduced_models.atlas.surface import shipped

POINT = MoesPoint(1000.0, 15.0, 0.2)
WIDE = MoesPoint(2933.0, 18.3, 0.107)  # inner contact of a 6205 under 1 kN at 3000 rev/min


def layer(r):
    return OilLayer(over_flooded=r)


def test_the_table_gives_back_its_points():
    table, surface = shipped("supply").table, shipped("supply")
    for k in (0, len(table.points) // 2, -1):
        for j in range(table["ratios"].size):
            rows, _ = surface.at(np.append(table.points[k], table["ratios"][j])[None, :])
            np.testing.assert_allclose(rows[0], table["changes"][k, j], rtol=0, atol=1e-6)


def test_entries_become_changes_of_what_was_solved():
    """Film, K and C of a made-up entry come out of a condition as they went in, over the same flooded contact."""
    points = list(RECIPE.sample(64, 5).values())
    table = assemble("supply", [supplied(p) for p in points], {"command": "none", "version": "0"})
    entry, j = supplied(points[3]), 4
    rows = changes_of(entry)
    np.testing.assert_allclose(table["changes"][3], rows, rtol=1e-14)
    assert np.exp(rows[j, 4]) == pytest.approx(entry["starved"][j]["stiffness"][0] / 1.5, rel=1e-12)


def test_thick_layers_whose_film_begins_ahead_of_the_region_fade():
    entry = supplied(POINT)
    whole = changes_of(entry)
    entry["starved"][-2:] = [None, None]
    cut = changes_of(entry)
    np.testing.assert_array_equal(cut[:-2], whole[:-2])
    assert np.all(np.abs(cut[-1]) <= np.abs(cut[-2])) and np.all(np.abs(cut[-2]) <= np.abs(cut[-3]))
    entry["starved"][0] = None
    assert changes_of(entry) is None


def test_flooded_is_the_limit_of_thick_layers():
    atlas = Atlas()
    flooded = atlas.at(POINT)
    away = []
    for r in (4.0, 40.0, 4000.0):
        found = atlas.at(POINT, supply=layer(r))
        away.append(abs(found.impedance(Omega=0.5).damping[0] / flooded.impedance(Omega=0.5).damping[0] - 1.0))
        assert found.over_flooded == r
    assert away[0] > 5.0 * away[1] and away[2] < 1e-3
    assert found.h_central == pytest.approx(flooded.h_central, rel=1e-4)
    assert found.approach == pytest.approx(flooded.approach, rel=1e-4)


def test_film_is_near_the_published_curve_and_continues_below_the_table():
    atlas = Atlas()
    flooded = atlas.at(POINT).h_central
    for r in (0.3, 0.6, 1.0, 1.5, 3.0):
        share = atlas.at(POINT, supply=layer(r)).h_central / flooded
        assert share == pytest.approx(film_of_layer(r, layer_sharpness(POINT.kappa)), rel=0.04)
        assert share < 1.01 * min(r, 1.0)
    thin = [atlas.at(POINT, supply=layer(r)) for r in (0.1, 0.2)]
    assert thin[1].h_central == pytest.approx(2.0 * thin[0].h_central, rel=1e-3)
    assert thin[1].separation == pytest.approx(2.0 * thin[0].separation, rel=1e-9)


def test_layer_in_dry_approaches_is_the_same_layer():
    atlas, H = Atlas(), 0.05
    squeezed = float(plain(density)(1.0, POINT.law)[0])
    r = H / (atlas.at(POINT).h_central * squeezed)
    one, other = atlas.at(POINT, supply=OilLayer(H=H)), atlas.at(POINT, supply=layer(r))
    assert one.over_flooded == pytest.approx(r, rel=1e-12)
    np.testing.assert_allclose(one.damping, other.damping, rtol=1e-9, atol=1e-12)


def test_starved_wide_contacts_have_negative_damping_at_low_frequency_only():
    found = Atlas().at(WIDE, supply=layer(1.0))
    low, high = found.impedance(Omega=0.0), found.impedance(Omega=0.5)
    assert low.damping[0] < -2.0 * Atlas().at(WIDE).damping[0] < 0.0 < high.damping[0]
    assert found.error_bars["damping"][0] > 0.0


@pytest.mark.parametrize("point", [WIDE, POINT, MoesPoint(30.0, 10.0, 1.0)])
@pytest.mark.parametrize("r", [0.3, 0.6, 0.9, 1.0, 1.3, 2.0, 6.0])
@pytest.mark.parametrize("model", ["wide", "memory"])
def test_elements_create_no_energy(point, r, model):
    """Damping at all frequencies is >= 0, and near the solver's where that is large and the motion not slow."""
    element, answer = Atlas().element(point, model, supply=layer(r)), Atlas().at(point, supply=layer(r))
    Omega = np.geomspace(1e-3, 60.0, 200)
    C = element.impedance(Omega=Omega).damping
    assert C.min() >= 0.0
    flooded = Atlas().at(point).damping[1]
    at = np.array([0.3, 0.5, 1.0])
    solver = answer.impedance(Omega=at).damping
    found = element.impedance(Omega=at).damping
    assert np.abs(found - solver).max() < 0.25 * flooded
    if model == "memory":
        first = answer.omega[np.argmax(answer.damping > -0.02 * flooded)]
        assert element.validity.omega[0] == pytest.approx(answer.omega[answer.omega < first].max(initial=0.0))


def test_a_flooded_atlas_is_what_it_was():
    assert Atlas().at(POINT).over_flooded is None
    assert Atlas().element(POINT).validity.omega[0] == 0.0


def test_lighter_loads_keep_the_change_of_the_lightest():
    atlas, light = Atlas(), MoesPoint(POINT.M * 0.5 * lightest_load(POINT), POINT.L, POINT.kappa)
    edge = MoesPoint(POINT.M * lightest_load(POINT) * (1 + 1e-9), POINT.L, POINT.kappa)
    shares = [atlas.at(p, supply=layer(0.8)).h_central / atlas.at(p).h_central for p in (light, edge)]
    assert shares[0] == pytest.approx(shares[1], rel=1e-6)


def test_bad_input_names_what_is_wrong():
    atlas = Atlas()
    beyond = MoesPoint(POINT.M * heaviest_load(POINT) * 1.01, POINT.L, POINT.kappa)
    for supply, point, words in (
        (OilLayer(over_flooded=[1.0, 2.0], y=[0.0, 1.0]), POINT, "profile"),
        (OilLayer(0.3e-6), POINT, "dimensionless"),
        (layer(0.01), POINT, "at least 0.02 flooded films"),
        (layer(1.0), beyond, "where the table of oil supply ends"),
        (layer(1.0), MoesPoint(1000.0, 15.0, 0.05), "kappa"),
        (layer(1.0), MoesPoint(1000.0, 28.0, 0.2), "between 4 and 26"),
        (0.3e-6, POINT, "OilLayer"),
    ):
        with pytest.raises(InputError) as caught:
            atlas.at(point, supply=supply)
        assert words in str(caught.value) and "\n" not in str(caught.value)


def test_a_condition_says_what_it_is():
    condition = Supplied(POINT, layer(1.5))
    assert condition.to_dict() == {"over_flooded": 1.5}
    assert Atlas().element(POINT, supply=layer(1.5)).source["supply"] == {"over_flooded": 1.5}
    assert Atlas().element(WIDE, supply=layer(1.0)).source["least_damping"] < -0.1
    assert Atlas().at(POINT, supply=layer(1.5)).supply == layer(1.5) and Atlas().at(POINT).supply is None


@pytest.mark.slow
def test_points_that_the_table_has_not_seen():
    """Solved anew, off the nodes of r and Omega: changes within their bars but for one of twenty."""
    inside = []
    Omega = np.array([0.0, 0.05, 0.3, 1.1])
    for point, r in ((MoesPoint(150.0, 12.0, 0.4), 0.9), (MoesPoint(400.0, 18.0, 0.15), 1.25)):
        entry = solve_layers(point, (r,), tuple(Omega))
        solved, flooded = entry["starved"][0], entry["flooded"]
        values = np.zeros((1, 5 + 2 * Omega.size))
        values[0, 1], values[0, 3], values[0, 5 + Omega.size :] = (
            flooded["h_central"],
            flooded["damping"][1],
            flooded["damping"],
        )
        change = Supplied(point, layer(r)).change(np.ones(1), values, Omega, values[:, 1])
        exact = [solved["h_central"] / flooded["h_central"], solved["h_min"] / flooded["h_min"]]
        inside += [abs(change.rows[0, 1 + k] - exact[k]) < change.bars[0, 1 + k] for k in range(2)]
        d = np.subtract(solved["damping"], flooded["damping"]) / flooded["damping"][1]
        inside += (np.abs(change.rows[0, 5 + Omega.size :] - d) < change.bars[0, 5 + Omega.size :]).tolist()
    assert shipped("supply").table.metadata["narrowest"] < 0.1 and np.mean(inside) > 0.8
