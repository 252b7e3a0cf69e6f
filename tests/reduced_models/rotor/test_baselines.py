"""Contacts that are there without an element: dry, undamped, linearised at one load."""

import numpy as np
import pytest
from rotor_twins import POINT, SCALES

from ehlcontact import InputError
from reduced_models import SpringContact
from reduced_models.rotor.baselines import dry_contact, local_contact, without_damper


def test_dry_contact_is_hertz():
    """At the dry approach it carries the load, with 3/2 of the secant as tangent, and nothing at any rate."""
    dry = dry_contact(SCALES)
    assert dry.units == "SI" and dry.spring(SCALES.length) == pytest.approx(SCALES.force, rel=1e-12)
    assert dry.spring_tangent(SCALES.length) == pytest.approx(1.5 * SCALES.stiffness, rel=1e-12)
    for share in (1e-5, 1e-3, 0.3, 2.0, 30.0):
        assert dry.spring(share * SCALES.length) == pytest.approx(SCALES.force * share**1.5, rel=1e-9)
    assert dry.spring(-1e-9) == 0.0
    assert dry.damping(SCALES.length, 0.1) == 0.0 and dry.force(SCALES.length, 5.0) == dry.spring(SCALES.length)


@pytest.mark.parametrize(
    "element",
    [
        SpringContact.cubic(2.2, -1.6, 1.1, 0.24, low=0.55, high=0.7),
        SpringContact.power(K=1.0, n=1.5, u0=0.1, F0=0.0, C1=0.3, low=0.5, high=0.8),
    ],
)
def test_without_damper(element):
    """The spring is the same to the last bit; what acted on the rate is gone."""
    lost = without_damper(element)
    u = np.linspace(0.2, 1.2, 40)
    assert np.array_equal(lost.spring(u), element.spring(u)) and type(lost) is type(element)
    assert np.array_equal(lost.force(u, 0.3), lost.force(u, -0.3))
    assert not np.array_equal(element.force(u, 0.3), element.force(u, -0.3))
    assert lost.validity == element.validity


def test_a_memory_cannot_lose_its_damper():
    from reduced_models import Atlas

    with pytest.raises(InputError, match="without memory"):
        without_damper(Atlas().element(POINT, "memory"))


def test_local_contact():
    """Load, stiffness and damping where they were asked for, Hertz-like around."""
    found = local_contact(48.7, 1.1e-6, 45e6, 107.0)
    assert found.approach_at(48.7) == pytest.approx(1.1e-6, rel=1e-12)
    assert found.stiffness(1.1e-6, 0.0) == pytest.approx(45e6) and found.damping(1.1e-6, 0.0) == 107.0
    curvature = (found.spring_tangent(1.1e-6 + 1e-10) - found.spring_tangent(1.1e-6 - 1e-10)) / 2e-10
    assert curvature == pytest.approx(45e6**2 / 48.7 / 3.0, rel=1e-3)
    assert local_contact(48.7, -3e-6, 45e6, 0.0).spring(-3e-6) == pytest.approx(48.7)
    with pytest.raises(InputError, match="approach"):
        local_contact(48.7, float("nan"), 45e6, 107.0)
