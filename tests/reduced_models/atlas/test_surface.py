"""Radial functions and their errors; smooth variables of films there and back, and their slopes."""

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from reduced_models.atlas.film import RECIPE, from_smooth, published_films, to_smooth
from reduced_models.atlas.surface import Neighbours, Radial, error_factor, left_out_errors

INTERPOLATION = RECIPE.interpolation

POINTS = np.array([[200.0, 10.0, 0.5], [12.0, 4.0, 0.3], [2900.0, 19.0, 0.11]])
FILMS = published_films(POINTS)
APPROACH, CENTRAL, LEAST = np.array([0.87, -0.2, 0.95]), np.array([0.1, 0.5, 0.04]), np.array([0.06, 0.4, 0.03])
MOMENT = np.array([0.03, 1.4, 0.02])
STIFFNESS = np.array([[1.46, 1.5, 1.53], [1.0, 1.3, 1.6], [1.5, 1.52, 1.55]])
DAMPING = np.array([[0.1, 0.09, 0.002], [0.8, 0.7, 0.1], [0.05, 0.0476, 0.0]])
LOW = DAMPING[:, INTERPOLATION.reference]
ANSWERS = np.column_stack([APPROACH, CENTRAL, LEAST, LOW, MOMENT, STIFFNESS, DAMPING])


@pytest.fixture
def smooth():
    return to_smooth(FILMS, ANSWERS, INTERPOLATION)


def test_there_and_back(smooth):
    values, _ = from_smooth(FILMS, smooth, INTERPOLATION)
    np.testing.assert_allclose(values, ANSWERS, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("k", range(11))
def test_slopes_are_differences(smooth, k):
    """Of each answer to its own variable: where the damping is next to nothing too."""
    step = np.zeros(11)
    step[k] = 1e-5
    above, below = (from_smooth(FILMS, smooth + sign * step, INTERPOLATION)[0][:, k] for sign in (1.0, -1.0))
    slopes = from_smooth(FILMS, smooth, INTERPOLATION)[1][:, k]
    np.testing.assert_allclose(slopes, np.abs(above - below) / 2e-5, rtol=1e-8)


def test_errors_are_those_of_the_interpolation_without_a_point():
    draw = np.random.default_rng(2)
    x = draw.uniform(size=(40, 3))
    values = np.column_stack([np.sin(3.0 * x[:, 0]) * x[:, 1], x @ [1.0, 2.0, 3.0], np.exp(-x[:, 2])])
    errors = left_out_errors(x, values)
    for k in (0, 17, 39):
        rest = np.arange(40) != k
        found = Radial(x[rest], values[rest]).at(x[[k]], cdist(x[[k]], x[rest]))
        np.testing.assert_allclose(values[k] - found[0], errors[k], atol=1e-10)
    assert np.abs(errors[:, 1]).max() < 1e-10 < np.abs(errors[:, 0]).max()  # a plane is itself
    factor = error_factor(x, errors[:, :1], 5, 0.9)
    own = cdist(x, x)
    np.fill_diagonal(own, np.inf)
    _, local = Neighbours(x, errors[:, :1], 5).at(own)
    assert 0.85 <= np.mean(np.abs(errors[:, :1]) <= factor * local) <= 0.95


def test_bars_grow_where_nodes_lie_far_apart():
    x = np.linspace(0.0, 1.0, 21)[:, None]
    neighbours = Neighbours(x, np.full((21, 1), 0.1), 4)
    grown, local = neighbours.at(cdist([[0.5], [3.0]], x))
    np.testing.assert_allclose(local, 0.1)
    assert grown[0, 0] == 1.0
    assert grown[1, 0] == pytest.approx((2.15 / neighbours.usual_reach) ** 2)
