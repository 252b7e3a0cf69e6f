"""The search for equilibrium of springs that only push, against scipy's roots."""

import numpy as np
import pytest
from scipy.optimize import root

from ehlcontact.errors import ConvergenceError
from reduced_models.bearing.equilibrium import GUESS, OPEN, equilibrium


class Contacts:
    """Hertz contacts around a body, with gaps."""

    def __init__(self, normals, gaps, stiffness, load):
        self.normals, self.gaps, self.stiffness, self.load = normals, gaps, stiffness, load
        self.pressed, self.longest = 0.0, 5e-5

    def approaches(self, q):
        return np.maximum(self.normals @ q - self.gaps, 0.0)

    def imbalance(self, q):
        forces = self.stiffness * self.approaches(q) ** 1.5
        self.pressed = float(np.sum(forces))
        return self.normals.T @ forces - self.load

    def tangent(self, q):
        slopes = 1.5 * self.stiffness * np.sqrt(self.approaches(q))
        return (self.normals.T * slopes) @ self.normals + OPEN * np.eye(q.size)

    def too_long(self, step):
        return max(float(np.linalg.norm(step)) / self.longest, 1.0)

    def at_rest(self):
        first = self.load / GUESS
        return equilibrium(self, first / self.too_long(first), float(np.linalg.norm(self.load)))


@pytest.mark.parametrize("size", [2, 3, 5])
def test_contacts_with_gaps_and_preloads(size):
    """Gaps leave the body free at first; below 0 they press it from all sides, beside which a load is small."""
    rng = np.random.default_rng(size)
    for k in range(40):
        normals = rng.normal(size=(6 * size, size))
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        normals = np.concatenate([normals, -normals])  # any load meets some
        gaps = rng.uniform(-1.0, 1.0, len(normals)) * 1e-5 if k % 2 else rng.uniform(0.0, 3e-5, len(normals))
        load = rng.normal(size=size) * 10.0 ** rng.uniform(1.0, 4.0)
        contacts = Contacts(normals, gaps, 10.0 ** rng.uniform(9.0, 11.0, len(normals)), load)
        q = contacts.at_rest()
        there = root(
            lambda x, c=contacts: c.imbalance(1e-6 * x),
            1e6 * q + 0.02 * rng.normal(size=size),  # scipy finds it from nearby only, where gaps are wide
            jac=lambda x, c=contacts: 1e-6 * c.tangent(1e-6 * x),
            method="lm",
            options={"xtol": 1e-14, "ftol": 1e-14},
        )
        assert np.linalg.norm(there.fun) <= 1e-8 * np.linalg.norm(load) + 1e-10 * contacts.pressed
        np.testing.assert_allclose(1e6 * q, there.x, atol=1e-6)
        assert np.linalg.norm(contacts.imbalance(q)) <= 1e-9 * np.linalg.norm(load) + 1e-12 * contacts.pressed


def test_a_load_away_from_all_contacts_is_not_held():
    normals = np.array([[1.0, 0.0], [0.8, 0.6], [0.8, -0.6]])
    contacts = Contacts(normals, np.zeros(3), np.full(3, 1e10), np.array([-50.0, 0.0]))
    with pytest.raises(ConvergenceError, match="the contacts do not hold 50 N of a load of 50 N"):
        contacts.at_rest()
