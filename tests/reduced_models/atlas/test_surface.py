"""The smooth variables of the atlas: there and back, and what an error of one is of an answer."""

import numpy as np
import pytest

from reduced_models.atlas.build import INTERPOLATION
from reduced_models.atlas.interpolation import films, from_smooth, to_smooth

POINTS = np.array([[200.0, 10.0, 0.5], [12.0, 4.0, 0.3], [2900.0, 19.0, 0.11]])
FILMS = films(POINTS)
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
