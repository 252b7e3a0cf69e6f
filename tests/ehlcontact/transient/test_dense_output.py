"""`SimulationResult.at`: order, continuity, and times outside the record."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from ehlcontact import Grid, HarmonicLoad, InputError, MoesPoint, PrescribedApproach, TimeSteps, simulate

POINT = MoesPoint(20, 5, 0.5)


@pytest.fixture(scope="module")
def record():
    return simulate(POINT, HarmonicLoad(Omega=pi), grid=Grid(n=16), time=TimeSteps(until=1.0, dt=0.1))


def smooth(record, steps):
    """The record with analytic histories in uneven steps: sin for the approach, cos for force and films."""
    s = np.linspace(0.0, 1.0, steps + 1)
    T = 2.0 * s + 0.2 * np.sin(2.0 * pi * s) / pi
    cosine = 2.0 + np.cos(3.0 * T)
    return replace(
        record,
        t=T,
        approach=np.sin(3.0 * T),
        rate=3.0 * np.cos(3.0 * T),
        force=cosine,
        h_central=cosine.copy(),
        h_min=cosine.copy(),
    )


def test_order(record):
    at = np.linspace(0.0, 2.0, 1001)
    errors = []
    for steps in (20, 40, 80):
        dense = smooth(record, steps).at(at)
        errors.append(
            [
                np.abs(dense.approach - np.sin(3.0 * at)).max(),
                np.abs(dense.rate - 3.0 * np.cos(3.0 * at)).max(),
                *(np.abs(x - 2.0 - np.cos(3.0 * at)).max() for x in (dense.force, dense.h_central, dense.h_min)),
            ]
        )
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert (orders[:, 0] > 3.8).all()
    assert (orders[:, 1] > 2.8).all()
    assert (orders[:, 2:] > 2.8).all()


def test_steps_are_reproduced_and_slopes_continuous(record):
    dense = record.at(record.t)
    for name in ("approach", "rate", "force", "load", "h_central", "h_min"):
        np.testing.assert_allclose(getattr(dense, name), getattr(record, name), atol=1e-13)
        assert not getattr(dense, name).flags.writeable
    d = 1e-7
    inner = record.t[1:-1]
    for name in ("approach", "force", "h_min"):
        left, middle, right = (getattr(record.at(inner + s), name) for s in (-d, 0.0, d))
        np.testing.assert_allclose(right - middle, middle - left, atol=1e-5 * d)


def test_shape_and_load(record):
    assert record.at(0.25).approach.shape == ()
    dense = record.at([[0.1, 0.25], [0.5, 0.77]])
    assert dense.force.shape == (2, 2)
    np.testing.assert_allclose(dense.load, 1.0 + 0.1 * np.sin(pi * dense.t), atol=1e-12)
    T = np.linspace(0.0, 0.3, 4)
    driven = simulate(POINT, PrescribedApproach(T, 0.6 + 0.1 * T), grid=Grid(n=16), time=TimeSteps(dt=0.1))
    np.testing.assert_array_equal(driven.at(T).load, driven.at(T).force)


@pytest.mark.parametrize("T", [-0.1, 1.1, float("nan"), [0.5, 2.0], "now"])
def test_outside_the_record(record, T):
    with pytest.raises(InputError, match=r"^t = .*: must be "):
        record.at(T)


def test_too_short_a_record(record):
    with pytest.raises(InputError, match=r"^steps = 1: must be at least 2"):
        simulate(POINT, HarmonicLoad(Omega=pi), grid=Grid(n=16), time=TimeSteps(until=0.1, dt=0.1)).at(0.05)
