"""The contact protocol and its SI face."""

import numpy as np
import pytest

from reduced_models import OutsideValidityWarning
from reduced_models.rotor.scaled_contact import Contact, ScaledContact, has_tangents


def test_scaled_contact_is_to_si(cubic, scales):
    wrapped, si = ScaledContact(cubic, scales), cubic.to_si(scales)
    u, v = 0.9 * scales.length, 0.4 * scales.rate
    assert isinstance(wrapped, Contact) and isinstance(si, Contact)
    assert wrapped.advance(1e-6, u, v) == pytest.approx(si.force(u, v), rel=1e-13)
    for name in ("rest", "spring", "spring_tangent"):
        assert getattr(wrapped, name)(u) == pytest.approx(getattr(si, name)(u), rel=1e-13)
    assert si.step_tangents(1e-6, u, v) == (si.force(u, v), si.stiffness(u, v), si.damping(u, v))
    assert wrapped.step_tangents(1e-6, u, v) == pytest.approx(si.step_tangents(1e-6, u, v), rel=1e-13)


def test_scaled_contact_scales_time_and_keeps_the_state_of_what_it_wraps(maxwell, scales):
    inner, twin = maxwell(1.0, 0.5, 0.1), maxwell(1.0, 0.5, 0.1)
    wrapped = ScaledContact(inner, scales)
    saved = wrapped.save_state()
    force = wrapped.advance(0.1 * scales.time, 0.8 * scales.length, 0.0)
    assert force == pytest.approx(scales.force * twin.advance(0.1, 0.8, 0.0), rel=1e-13)
    wrapped.restore_state(saved)
    assert inner.u == 0.0 and wrapped.advance(0.1 * scales.time, 0.8 * scales.length, 0.0) == force


def test_tangents_are_seen_through_the_wrapper(cubic, maxwell, scales):
    assert has_tangents(cubic) and has_tangents(ScaledContact(cubic, scales))
    assert not has_tangents(maxwell(1, 1, 1)) and not has_tangents(ScaledContact(maxwell(1, 1, 1), scales))


def test_box_of_a_wrapped_element_is_watched_in_si(cubic, maxwell, scales):
    u, v, f = (
        np.array([0.9, x]) * unit for x, unit in ((1.2, scales.length), (0.4, scales.rate), (1.0, scales.force))
    )
    with pytest.warns(OutsideValidityWarning, match="approach 1.2 "):
        ScaledContact(cubic, scales).warn_outside(u, v, force=f, omega=None)
    ScaledContact(maxwell(1, 1, 1), scales).warn_outside(u, v, force=f, omega=None)  # no box, nothing to say
