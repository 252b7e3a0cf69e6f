"""Rotors on 6205 bearings, with VG 68 at 50 C and dry."""

import numpy as np
import pytest
from beam_rotor import shaft

from ehlcontact import Lubricant
from reduced_models import BallBearing, BearingMount, Rotor, Unbalance

M, K, G = shaft([0.05] * 6, 0.04, [(3, 0.28, 0.07)])
NODES, DISC = (1, 5), 12  # of the bearings; first degree of freedom of the disc


@pytest.fixture(scope="package")
def oil():
    return Lubricant.iso_vg(68, temperature=50.0)


@pytest.fixture(scope="package")
def film(oil):
    return BallBearing.catalogue("6205", oil=oil)


@pytest.fixture(scope="package")
def dry():
    return BallBearing.catalogue("6205")


@pytest.fixture(scope="package")
def beam():
    """Maker of the beam: disc of 34 kg in the middle of a shaft, 500 N on either bearing."""

    def make(bearing, **changes):
        load = np.zeros(len(M))
        load[DISC + 1] = -1000.0
        mounts = tuple(BearingMount(bearing=bearing, x=4 * n, y=4 * n + 1) for n in NODES)
        heavy = (Unbalance(x=DISC, y=DISC + 1, amount=1e-4, phase=0.4),)
        given = {"mass": M, "stiffness": K, "gyroscopic": G, "load": load, "mounts": mounts, "unbalances": heavy}
        return Rotor(**(given | changes))

    return make


@pytest.fixture(scope="package")
def block():
    """Maker of a rigid mass on one bearing."""

    def make(bearing, mass=2.0, **changes):
        given = {"mass": mass * np.eye(2), "stiffness": np.zeros((2, 2)), "load": np.array([0.0, -300.0])}
        given |= {"mounts": (BearingMount(bearing=bearing, x=0, y=1),)}
        return Rotor(**(given | {"unbalances": (Unbalance(x=0, y=1, amount=1e-4),)} | changes))

    return make
