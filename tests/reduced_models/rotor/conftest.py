"""Rotors on 6205 bearings."""

from functools import partial

import beam_rotor
import pytest


@pytest.fixture(scope="package")
def beam():
    """Maker of the beam of `beam_rotor` with an unbalance."""
    return partial(beam_rotor.beam, unbalance=1e-4, phase=0.4)


@pytest.fixture(scope="package")
def block():
    """Maker of a rigid mass on one bearing with an unbalance."""
    return partial(beam_rotor.block, unbalance=1e-4)


@pytest.fixture
def contact(cubic, scales):
    """A cubic contact in SI."""
    return cubic.to_si(scales)
