"""Contacts, scales and records that several test files share."""

import numpy as np
import pytest

from ehlcontact import Lubricant
from ehlcontact.point import Scales
from reduced_models import Atlas, BallBearing, ContactRecord, FilmContact, SpringContact
from reduced_models.bearing import linear_balls

# Nonato and Cavalca (2010), Table 3 case 2 (free vibration, Omega_n = 5.13).
PAPER = {"K1": 0.806, "K2": 0.346, "K3": 0.054, "C1": 0.013}


@pytest.fixture(scope="session")
def shipped():
    """The atlas of the package."""
    return Atlas()


@pytest.fixture(scope="session")
def oil():
    return Lubricant.iso_vg(68, temperature=50.0)


@pytest.fixture(scope="session")
def film(oil):
    """6205 with VG 68 at 50 C."""
    return BallBearing.catalogue("6205", oil=oil)


@pytest.fixture
def friction_follows(monkeypatch):
    """Linear answers are slopes of runs and of static equilibria, where friction follows the place of a ball."""
    monkeypatch.setattr(linear_balls, "_of_a_potential", lambda geometric: geometric)


@pytest.fixture(scope="session")
def dry():
    return BallBearing.catalogue("6205")


@pytest.fixture
def scales():
    return Scales(force=1000.0, length=4e-6, time=2e-5, a=2e-4, b=1e-3, pressure=1.5e9)


@pytest.fixture
def cubic():
    return SpringContact.cubic(**PAPER, low=0.75, high=1.0)


@pytest.fixture
def linear():
    return SpringContact.linear(K1=1.15, C1=0.0124, low=0.75, high=1.0)


@pytest.fixture
def memory():
    """Fitted to M = 200, L = 10, kappa = 0.5 on n = 64."""
    return FilmContact.memory(
        film=0.129,
        exponent=0.13,
        inlet_saturation=0.25,
        lag_rate=5.4,
        inlet_rate=33.0,
        fast_rate=60.0,
        gains=(0.001, 0.002, 0.005, 0.013, 0.0, 0.009, 0.011, 0.0, 0.0, 0.0, 0.021),
        low=0.5,
        high=1.2,
        rate=2.0,
        load_range=(0.5, 1.5),
        omega_range=(0.0, 60.0),
    )


@pytest.fixture
def record():
    """A record that obeys PAPER exactly, with inertia."""
    T = np.linspace(0.0, 3.0, 301)
    u = 0.87 + 0.1 * np.cos(6.0 * T) * np.exp(-0.2 * T)
    v = np.gradient(u, T)
    f = PAPER["K1"] * u + PAPER["K2"] * u**2 + PAPER["K3"] * u**3 + PAPER["C1"] * v
    return ContactRecord(
        t=T, approach=u, rate=v, force=f, load=np.ones(T.size), acceleration=5.13**2 * (1.0 - f), mass=5.13**-2
    )


class Maxwell:
    """Spring k beside a spring k2 in series with a damper c2: a contact with memory and no tangents."""

    def __init__(self, k, k2, c2, approach=0.0):
        self.k, self.k2, self.rate_constant = k, k2, k2 / c2
        self.u, self.z, self.calls = approach, 0.0, 0  # z: force of the branch

    def advance(self, dt, approach, rate):
        """Trapezoidal rule for z' = k2 u' - z k2/c2."""
        self.calls += 1
        p = 0.5 * dt * self.rate_constant
        self.z = ((1.0 - p) * self.z + self.k2 * (approach - self.u)) / (1.0 + p)
        self.u = approach
        return self.k * approach + self.z

    def save_state(self):
        return self.u, self.z

    def restore_state(self, state):
        self.u, self.z = state


@pytest.fixture
def maxwell():
    return Maxwell


class Hidden:
    """A reduced element without its tangents, counting its calls."""

    def __init__(self, element):
        self.element, self.calls = element, 0

    def advance(self, dt, approach, rate):
        self.calls += 1
        return self.element.advance(dt, approach, rate)

    def save_state(self):
        return self.element.save_state()

    def restore_state(self, state):
        self.element.restore_state(state)


@pytest.fixture
def hidden():
    return Hidden
