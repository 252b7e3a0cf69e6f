"""The numbers of a build against their neighbours, and the search for better ones."""

from dataclasses import replace

import numpy as np
import pytest
from programs import script

from ehlcontact import MoesPoint
from ehlcontact.store import save
from reduced_models.atlas.film import RECIPE
from reduced_models.atlas.surface import shipped as shipped_surface
from reduced_models.elements.film_response import FilterRates

tune = script("tests/benchmarks/tune_atlas.py")


@pytest.fixture(scope="module")
def shipped():
    return shipped_surface("film").table


@pytest.fixture(scope="module")
def few(shipped):
    """Every eighth point of the shipped table."""
    columns = {name: array if name == "factor" else array[::8] for name, array in shipped.columns.items()}
    return replace(shipped, points=shipped.points[::8], columns=columns)


KINDS = {  # name of the weights in the table, their error, the search for better ones
    "weights": (tune.weights_error, tune.best_weights),
    "lobe_weights": (tune.lobe_error, tune.best_lobe_weights),
}


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize("which", range(1, 4))
def test_half_and_twice_a_shipped_weight_are_worse(shipped, name, which):
    error, weights = KINDS[name][0], getattr(shipped.interpolation, name)
    own = error(shipped, weights)
    for factor in (0.5, 2.0):
        other = [w * (factor if i == which else 1.0) for i, w in enumerate(weights)]
        assert error(shipped, other) > own


def test_side_lobes_have_weights_of_their_own(shipped):
    numbers = shipped.interpolation
    assert tune.lobe_error(shipped, numbers.lobe_weights) < 0.8 * tune.lobe_error(shipped, numbers.weights[:4])


@pytest.mark.parametrize("name", KINDS)
def test_search_for_weights(few, name):
    error, search = KINDS[name]
    found = search(few, most=30)
    assert found.used == getattr(few.interpolation, name) and found.best[0] == found.used[0]
    assert found.error == error(few, found.used)
    assert found.least == error(few, found.best) < found.error


def test_only_ratios_of_weights_count(few):
    own = tune.weights_error(few, few.interpolation.weights)
    assert tune.weights_error(few, [3.0 * w for w in few.interpolation.weights]) == pytest.approx(own, rel=1e-4)


@pytest.mark.long
def test_shipped_rates_fit_nearly_best(shipped):
    rates, own = tune.rates_of(shipped), tune.rates_error(shipped, tune.rates_of(shipped))
    for factor in (0.5, 2.0):
        for name in ("lag_rate", "inlet_rate", "fast_rate"):
            assert tune.rates_error(shipped, replace(rates, **{name: factor * getattr(rates, name)})) > own
    found = tune.best_rates(shipped, most=20)
    assert 0.95 * own < found.least <= own * (1.0 + 1e-12)
    assert found.least == tune.rates_error(shipped, FilterRates(rates.lags, *found.best))


@pytest.mark.slow
def test_slopes_for_other_oils_cover_a_light_load(shipped):
    slopes = tune.oil_slopes([MoesPoint(8.0, 5.0, 0.5)])
    for kind, found in slopes.items():
        allowed = np.array(getattr(tune.OIL, kind)) * (2.0**0.5 if kind == "damping" else 1.0)
        assert np.all(np.array(found) <= allowed) and min(found) > 0.0


@pytest.mark.slow
def test_what_widens_the_bars_covers_other_oils(shipped):
    """Random oils at random points, by which no setting was chosen: 95 % of films, K, C and moment."""
    rng, inside = np.random.default_rng(77), []
    points = [p for p in RECIPE.sample(48, 24, seed=77).values() if p.inlet_width > 0.13 and p.L < 28.0]
    for k in rng.permutation(len(points))[:14].tolist():
        point = points[k]
        alpha, eta0 = np.exp(rng.uniform(np.log([1e-8, 0.002]), np.log([4e-8, 1.0]))).tolist()
        oil = replace(point, alpha=alpha, eta0=eta0)
        if oil.p_hertz > shipped.box.p_hertz:
            continue
        away = np.abs(np.log([alpha / point.alpha, eta0 / point.eta0]))
        own, other = tune.answers(tune.read_at(oil, point)), tune.answers(oil)
        for kind, (value, weight) in own.items():
            bar = weight * (getattr(tune.OIL, kind) @ away) * (2.0**0.5 if kind == "damping" else 1.0)
            inside += (np.abs(np.log(other[kind][0] / value)) <= bar)[weight > 0.0].tolist()
    assert len(inside) > 500 and np.mean(inside) >= 0.95


def test_command_line(few, tmp_path, capsys):
    save(few, tmp_path / "few.h5")
    tune.main(["--weights", "--atlas", str(tmp_path / "few.h5")])
    said = capsys.readouterr().out.splitlines()
    assert said[0].startswith("weights: 0.4 0.16 0.33 0.905 0.476 error") and said[1].split()[0] == "best:"
