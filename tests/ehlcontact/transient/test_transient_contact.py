"""The full contact as an element: state, failure, and agreement with `simulate`."""

from dataclasses import fields
from math import pi

import numpy as np
import pytest

from ehlcontact import (
    ConvergenceError,
    Domain,
    Geometry,
    Grid,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedApproach,
    TimeSteps,
    TransientContact,
    simulate,
)
from ehlcontact.status import Status

POINT = MoesPoint(200, 10, 0.5)
NAN, INF = float("nan"), float("inf")


@pytest.fixture
def contact():
    return TransientContact(POINT, grid=Grid(n=32))


def test_starts_at_rest(contact, steady):
    assert contact.force == pytest.approx(1.0, abs=1e-5)
    assert contact.static_approach == pytest.approx(steady(200, 10, 0.5, 32).approach, abs=1e-5)
    assert contact.h_central == pytest.approx(steady(200, 10, 0.5, 32).h_central, rel=1e-3)
    assert 0.0 < contact.h_min < contact.h_central


def test_the_error_of_its_grid_is_that_of_the_film_at_rest(contact, steady, monkeypatch):
    """And nothing that steps go on from is changed by it."""
    assert contact.film_error.h_central_relative == pytest.approx(
        steady(200, 10, 0.5, 32).error_estimate.h_central_relative, rel=0.02
    )
    assert contact.reservation.startswith("the grid is too coarse: at rest the central film may be off by 75 %")
    assert contact.reservation in repr(contact)
    assert TransientContact(POINT, grid=Grid(n=128)).reservation == ""
    monkeypatch.setattr("ehlcontact.transient.transient_film.estimate_error", lambda multigrid, balance: None)
    silent = TransientContact(POINT, grid=Grid(n=32))
    assert silent.film_error is None and silent.reservation == ""
    assert [c.advance(0.1, 0.9) for c in (contact, contact)] == [silent.advance(0.1, 0.9) for _ in range(2)]


def test_rest_lasts(contact):
    for _ in range(3):
        assert contact.advance(0.5, contact.static_approach) == pytest.approx(1.0, abs=2e-4)


def test_save_and_restore_are_bit_identical(contact):
    """Also with steps of different length in between, which change the history terms."""
    u = contact.static_approach
    for k in range(3):
        contact.advance(0.1, u + 0.01 * k)
    state = contact.save_state()
    path = [(0.1, u + 0.03), (0.25, u + 0.05), (0.05, u - 0.02)]
    first = [contact.advance(dt, v) for dt, v in path]
    films = contact.h_central, contact.h_min
    for _ in range(2):
        contact.restore_state(state)
        assert contact.force == pytest.approx(first[0], abs=0.1)
        assert [contact.advance(dt, v) for dt, v in path] == first
        assert (contact.h_central, contact.h_min) == films


def test_restore_brings_back_force_and_film(contact):
    contact.advance(0.1, contact.static_approach + 0.02)
    force, film, state = contact.force, contact.h_min, contact.save_state()
    contact.advance(0.1, contact.static_approach + 0.10)
    assert contact.force != force
    contact.restore_state(state)
    assert contact.force == pytest.approx(force, rel=1e-14)
    assert contact.h_min == pytest.approx(film, rel=1e-12)


def test_saved_state_does_not_move_on(contact):
    state = contact.save_state()
    P = state.P.copy()
    for _ in range(3):
        contact.advance(0.2, contact.static_approach + 0.05)
    np.testing.assert_array_equal(state.P, P)


def same(one, other):
    """Equality of nested tuples of arrays, to the last bit."""
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(same, one, other))
    return np.array_equal(one, other)


def test_failed_step_leaves_it_unchanged(contact, monkeypatch):
    u = contact.static_approach
    contact.advance(0.1, u + 0.01)
    state, force = contact.save_state(), contact.force
    with monkeypatch.context() as patch:
        patch.setattr("ehlcontact.transient.transient_film.STEP_CYCLES", 0)
        with pytest.raises(ConvergenceError, match="EHL step max_cycles") as caught:
            contact.advance(0.1, u + 0.3)
    assert caught.value.result.status is Status.MAX_CYCLES
    assert contact.force == force
    after = contact.save_state()
    for f in fields(state):
        assert same(getattr(after, f.name), getattr(state, f.name)), f.name
    # and it goes on as if nothing had happened
    twin = TransientContact(POINT, grid=Grid(n=32))
    twin.advance(0.1, u + 0.01)
    assert contact.advance(0.1, u + 0.02) == twin.advance(0.1, u + 0.02)


def test_agrees_with_simulate(contact):
    """The same approach on the same steps gives the same force."""
    T = np.linspace(0.0, 1.0, 41)
    u = contact.static_approach + 0.08 * np.sin(2.0 * pi * T) ** 2
    record = simulate(POINT, PrescribedApproach(T, u), grid=Grid(n=32), time=TimeSteps(tol=1e-4))
    force = [contact.force] + [contact.advance(T[1], v) for v in u[1:]]
    assert np.ptp(force) > 0.1
    np.testing.assert_allclose(force, record.force, atol=2e-4)


def test_step_length_hardly_matters_where_motion_is_slow():
    """Implicit film: a load cycle of Omega = 0.05 in steps of 1 and of 0.5."""
    results = []
    for dt in (1.0, 0.5):
        contact = TransientContact(POINT, grid=Grid(n=32))
        u = contact.static_approach
        for k in range(round(40 / dt)):
            contact.advance(dt, u + 0.05 * np.sin(0.05 * (k + 1) * dt))
        results.append(contact.force)
    assert results[0] == pytest.approx(results[1], abs=1e-3)


@pytest.mark.slow
def test_rotor_frequency_in_long_steps():
    """The 6205 at 3000 rpm, Omega = 0.0119: steps of 8.8 and of 1.1 agree to 0.1 % of the force amplitude."""
    force = {}
    for steps in (30, 240):
        contact = TransientContact(MoesPoint(2975, 18.86, 0.1071), grid=Grid(n=64))
        start, T = contact.static_approach, np.linspace(0.0, 264.0, steps + 1)[1:]
        force[steps] = np.array([contact.advance(T[0], start + 0.1 * np.sin(0.01188 * t)) for t in T])
    difference = force[30] - force[240][7::8]
    assert np.sqrt(np.mean(difference**2)) < 1e-3 * np.ptp(force[240]) / 2.0


def test_largest_load_widens_the_domain():
    assert TransientContact(POINT, grid=Grid(n=32)).domain == Domain()
    assert TransientContact(POINT, grid=Grid(n=32), largest_load=3.0).domain == Domain.for_load(3.0)
    assert (
        TransientContact(POINT, grid=Grid(n=32, domain=Domain(-5.0, 2.0, 3.0)), largest_load=3.0).domain.x_out
        == 2.0
    )


def test_lift_off_and_return(contact):
    """The film carries less and less as the bodies part, and comes back."""
    u = contact.static_approach
    forces = [contact.advance(0.1, u - 0.06 * k) for k in range(1, 8)]
    assert all(np.diff(forces) < 0.0)
    assert forces[-1] > 0.0
    back = [contact.advance(0.1, u - 0.42 + 0.06 * k) for k in range(1, 8)]
    assert all(np.diff(back) > 0.0)


@pytest.mark.parametrize("value", [0.0, -0.1, NAN, INF, True, None, "soon"])
def test_bad_step_is_named(contact, value):
    force = contact.force
    with pytest.raises(InputError, match=r"^dt = "):
        contact.advance(value, 0.9)
    assert contact.force == force


def test_another_unit_of_approach_is_suspected_where_a_step_fails():
    ball = OperatingPoint(Geometry(0.01, 0.02), Lubricant(eta0=0.04, alpha=2.2e-8), load=50.0, u_sum=2.0)
    contact = TransientContact(ball, grid=Grid(n=64))
    with pytest.raises(ConvergenceError, match=r"Are the units right\? approach = 1\.2 m .*1\.\d+e-06 m at rest"):
        contact.advance(1e-5, 1.2)
    assert contact.force == pytest.approx(50.0, rel=1e-3)


@pytest.mark.parametrize("value", [NAN, INF, True, None, "deep"])
def test_bad_approach_is_named(contact, value):
    with pytest.raises(InputError, match=r"^approach = "):
        contact.advance(0.1, value)
