"""Lift-off, impacts and time outside validity of constructed histories, counted by hand."""

import numpy as np
import pytest
from rotor_twins import run_of

from reduced_models import SpringContact
from reduced_models.rotor.events import contact_events, lift_offs

ELEMENT = SpringContact.cubic(
    2e7,
    0.0,
    1e18,
    100.0,
    low=1e-6,
    high=2e-6,
    rate=1e-3,
    load_range=(20.0, 50.0),
    omega_range=(300.0, 320.0),
    units="SI",
)


def run(approach, rate, force):
    return run_of(np.arange(len(force)) * 1e-4, approach, rate, force)


@pytest.mark.parametrize(
    ("force", "expected"),
    [
        ([40, 40, 40, 40], (0, 0, 0.0)),
        ([40, 0, 0, 40], (1, 1, 0.5)),
        ([40, 0.39, 0.41, 0.0], (2, 1, 0.5)),
        ([0, 40, 0, 40], (1, 2, 0.5)),
        ([40, 20, 1, 0], (1, 0, 0.25)),
        ([0, 0], (0, 0, 1.0)),
    ],
)
def test_lift_offs(force, expected):
    """Lost below a hundredth of the load at rest, 40 N."""
    assert lift_offs(force, 40.0) == expected


def test_shares_outside_the_box():
    """Ten samples: what lies beyond the margins of a twentieth, each bound by itself."""
    u = np.array([1.0, 1.2, 1.5, 1.8, 2.0, 2.04, 2.06, 2.2, 0.96, 0.94]) * 1e-6
    v = np.array([0.0, 1.0, -1.0, 1.04, -1.04, 1.06, -1.06, 2.0, 0.0, 0.0]) * 1e-3
    f = np.array([20.0, 30, 40, 50, 51, 51.6, 60, 18.6, 18.4, 0.0])
    found = contact_events(run(u, v, f), 40.0, [ELEMENT])[0]
    assert found.outside_approach == pytest.approx(0.3) and found.outside_rate == pytest.approx(0.3)
    assert found.outside_load == pytest.approx(0.4) and found.load_range == (0.0, 60.0)
    assert found.lift_offs == 1 and found.impacts == 0 and found.lost_share == pytest.approx(0.1)
    assert found.outside == max(found.outside_load, found.outside_omega)
    assert len(found.warnings) == 1 and all(word in found.warnings[0] for word in ("approach", "rate", "force"))
    # the element itself has not warned: it may still
    with pytest.warns(UserWarning, match="approach"):
        ELEMENT.copy().warn_outside(u)


@pytest.mark.parametrize(("omega", "share"), [(310.0, 0.0), (610.0, 0.0), (700.0, 1.0), (140.0, 1.0)])
def test_frequency_is_of_the_whole_run(omega, share):
    t = np.linspace(0.0, 2.0 * np.pi / omega, 400, endpoint=False)
    u, v = 1.5e-6 + 1e-7 * np.sin(omega * t), 1e-7 * omega * np.cos(omega * t)
    found = contact_events(run(u, v, np.full(400, 40.0)), 40.0, [ELEMENT])[0]
    assert found.outside_omega == share and bool(found.warnings) == bool(share)


def test_full_films_have_no_box():
    found = contact_events(run([1e-6] * 3, [0.0] * 3, [40.0, 0.0, 41.0]), 40.0)[0]
    assert found.outside_approach is None and found.outside == 0.0 and found.warnings == ()
    assert (found.lift_offs, found.impacts) == (1, 1)
    assert found.to_dict()["load_range"] == [0.0, 41.0] and found.to_dict()["warnings"] == []


def test_every_contact_for_itself():
    force = np.array([[40.0, 40.0], [40.0, 0.0], [40.0, 40.0]])
    first, second = contact_events(run(np.full((3, 2), 1.5e-6), np.zeros((3, 2)), force), 40.0, [ELEMENT, None])
    assert (first.lift_offs, second.lift_offs) == (0, 1)
    assert first.outside_approach == 0.0 and second.outside_approach is None
