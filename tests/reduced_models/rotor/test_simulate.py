"""The rotor integrator: exact linear motion, order, energy, contacts with memory, and how it fails."""

import numpy as np
import pytest
from rotor_twins import applied_force, carried, moving
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.status import Status
from reduced_models import OutsideValidityWarning, SpringContact, jeffcott_rotor, simulate_rotor

BODY = {"disc_mass": 20.0, "journal_mass": 1.0, "shaft_stiffness": 2e7, "shaft_damping": 200.0}
TURNING = BODY | {"unbalance": 1e-4, "speed_rpm": 6000.0}


@pytest.fixture
def rotor():
    return jeffcott_rotor(bearings=1, **TURNING, load=(0.0, -800.0))


def reference(rotor, contacts, state, times):
    """The equations of motion by an explicit integrator of high order."""
    (M, C, K), size, rows = rotor.matrices(0.0), rotor.size // 2, rotor.support_rows
    count = np.array([mount.count for mount in rotor.contacts])

    def rates(t, y):
        d, v = y[: 2 * size], y[2 * size :]
        u, w = rotor.approaches(d), rows @ v
        f = np.array([c.force(float(a), float(b)) for c, a, b in zip(contacts, u, w, strict=True)])
        p = applied_force(rotor, t) - C @ v - K @ d - rows.T @ (count * f)
        return np.concatenate([v, np.linalg.solve(M, p)])

    scale = np.repeat([1e-6, 1e-3], 2 * size)
    start = np.concatenate(state)
    solution = solve_ivp(rates, (0, times[-1]), start, "DOP853", times, rtol=1e-10, atol=1e-10 * scale)
    return solution.y[size : 2 * size].T


def test_static_start_stays_at_rest(contact):
    rotor = jeffcott_rotor(half_angle=0.6, **BODY, load=(100.0, -3000.0))
    result = simulate_rotor(rotor.on([contact, contact]), dt=1e-5, until=1e-3)
    assert result.status == "converged" and np.ptp(result.journal, axis=0).max() < 1e-14
    np.testing.assert_allclose(result.force[-1], carried(rotor), rtol=1e-8)
    assert not result.journal.flags.writeable and result.iterations[0] == 0


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize("vee", [False, True])
def test_second_order_towards_the_exact_motion(contact, rotor, vee):
    contacts = [contact]
    if vee:
        rotor = jeffcott_rotor(half_angle=0.6, **TURNING, load=(100.0, -3000.0))
        contacts = [contact, contact]
    kick = rotor.on(contacts).equilibrium(), moving(rotor, journal=(0.0, 1e-3))
    times = np.linspace(0.0, 2e-3, 11)
    exact = reference(rotor, contacts, kick, times)
    errors = []
    for steps in (200, 400, 800):
        r = simulate_rotor(rotor.on(contacts), dt=2e-3 / steps, until=2e-3, start=kick, tolerance=1e-9)
        errors.append(np.abs(r.journal[:: steps // 10, 2 - rotor.size // 2 :] - exact).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((orders > 1.85) & (orders < 2.2)), (errors, orders)
    assert errors[-1] < 5e-3 * np.ptp(exact)


def test_motion_through_lift_off_is_followed(contact):
    rotor = jeffcott_rotor(bearings=1, **BODY, load=(0.0, -800.0))
    kick = rotor.on([contact]).equilibrium(), moving(rotor, journal=(0.0, 0.2))
    times = np.linspace(0.0, 2e-3, 41)
    with pytest.warns(OutsideValidityWarning, match="approach"):
        r = simulate_rotor(rotor.on([contact]), dt=5e-7, until=2e-3, start=kick)
    assert (r.force == 0.0).any() and r.force.max() > 1500.0
    error = np.abs(r.journal[::100, 1] - reference(rotor, [contact], kick, times)[:, 0]).max()
    assert error < 2e-3 * np.ptp(r.journal[:, 1])
    assert r.iterations.max() <= 8


def test_average_acceleration_keeps_the_energy_of_a_linear_rotor():
    element = SpringContact.linear(2e8, 0.0, 1e-9, 1e-3, units="SI")
    rotor = jeffcott_rotor(bearings=1, disc_mass=20.0, journal_mass=1.0, shaft_stiffness=2e7)
    kick = rotor.on([element]).equilibrium(), np.full(2, 1e-4)
    r = simulate_rotor(rotor.on([element]), dt=2e-5, until=2e-2, start=kick, rho_inf=1.0, tolerance=1e-12)
    bend = r.disc[:, 1] - r.journal[:, 1]
    energy = 10.0 * r.disc_velocity[:, 1] ** 2 + 0.5 * r.journal_velocity[:, 1] ** 2 + 1e7 * bend**2
    energy += 1e8 * r.approach[:, 0] ** 2 + 9.81 * (20.0 * r.disc[:, 1] + r.journal[:, 1])
    kinetic = 10.0 * 1e-8
    assert np.ptp(energy) < 1e-6 * kinetic
    damped = simulate_rotor(rotor.on([element]), dt=2e-5, until=2e-2, start=kick, rho_inf=0.0)
    # The contact mode (2.2 kHz) is barely resolved: kept with rho_inf = 1, gone with 0.
    fast, gone = (np.ptp(np.diff(x.rate[-200:, 0])) for x in (r, damped))
    assert gone < 0.1 * fast


def test_energy_balance_with_damping(contact):
    rotor = jeffcott_rotor(bearings=1, **BODY, load=(0.0, -800.0))
    kick = rotor.on([contact]).equilibrium(), moving(rotor, journal=(0.0, 5e-3))
    r = simulate_rotor(rotor.on([contact]), dt=1e-6, until=2e-3, start=kick)
    work = np.trapezoid(r.force[:, 0] * r.rate[:, 0], r.t)  # into the contact
    shaft = 200.0 * np.trapezoid((r.disc_velocity[:, 1] - r.journal_velocity[:, 1]) ** 2, r.t)
    bend = r.disc[:, 1] - r.journal[:, 1]
    kinetic = 10.0 * r.disc_velocity[:, 1] ** 2 + 0.5 * r.journal_velocity[:, 1] ** 2
    stored = kinetic + 1e7 * bend**2 + (20.0 * 9.81 + 800.0) * r.disc[:, 1] + 9.81 * r.journal[:, 1]
    assert stored[0] - stored[-1] == pytest.approx(work + shaft, rel=2e-3)


def test_secants_give_what_tangents_give(contact, rotor, hidden):
    blind = hidden(contact)
    start = rotor.on([contact]).equilibrium(), np.zeros(2)
    by_tangent = simulate_rotor(rotor.on([contact]), dt=2e-5, until=0.02)
    by_secant = simulate_rotor(rotor.on([blind]), dt=2e-5, until=0.02, start=start)
    dynamic = np.ptp(by_tangent.force)
    assert np.abs(by_secant.force - by_tangent.force).max() < 1e-4 * dynamic
    assert blind.calls <= 2 * 1000 + 2


def maxwell_exact(rotor, branch, start, times):
    """Linear motion with the branch force z as one more state: exact by the matrix exponential."""
    (k, k2, c2), (M, C, K) = branch, rotor.matrices(0.0)
    A = np.zeros((6, 6))
    A[:2, 2:4] = np.eye(2)
    inverse = np.linalg.inv(M)
    A[2:4, :2], A[2:4, 2:4] = -inverse @ K, -inverse @ C
    # approach = -y of the journal; the contact pushes it up.
    A[3, 1] -= k / M[1, 1]
    A[3, 4] = 1.0 / M[1, 1]
    A[4, 3], A[4, 4] = -k2, -k2 / c2
    A[2:4, 5] = inverse @ applied_force(rotor, 0.0)
    y0 = np.concatenate([*start, [0.0, 1.0]])
    return np.array([(expm(A * t) @ y0)[1] for t in times])


def test_contact_with_memory_and_no_tangents_is_exact_in_the_limit(maxwell):
    rotor = jeffcott_rotor(bearings=1, **BODY)
    k, k2, c2 = 1e8, 6e7, 4e3
    kick = rotor.rest_at([-rotor.load.sum() / k]), moving(rotor, journal=(0.0, 2e-3))
    times = np.linspace(0.0, 4e-3, 21)
    exact = maxwell_exact(rotor, (k, k2, c2), kick, times)
    errors = []
    for steps in (400, 800):
        contact = maxwell(k, k2, c2, approach=-kick[0][1])
        r = simulate_rotor(rotor.on([contact]), dt=4e-3 / steps, until=4e-3, start=kick, tolerance=1e-8)
        errors.append(np.abs(r.journal[:: steps // 20, 1] - exact).max())
        # A linear contact has one slope: the probe finds it, and every step takes two calls at most.
        assert contact.calls <= 2 * steps + 2 and r.iterations.max() <= 2
        assert contact.u == r.approach[-1, 0]
    assert errors[1] < 2e-3 * np.ptp(exact) and 1.9 < np.log2(errors[0] / errors[1]) < 2.1


def test_contact_is_advanced_once_per_step_in_net(rotor, maxwell):
    """Whatever the iteration tries, the state moves from step to step only."""
    contact = maxwell(3e8, 1e8, 1e3, approach=-rotor.load.sum() / 3e8)
    start = rotor.rest_at([-rotor.load.sum() / 3e8]), np.zeros(2)
    r = simulate_rotor(rotor.on([contact]), dt=1e-5, until=2e-3, start=start)
    replay = maxwell(3e8, 1e8, 1e3, approach=r.approach[0, 0])
    forces = [replay.advance(1e-5, u, v) for u, v in zip(r.approach[1:, 0], r.rate[1:, 0], strict=True)]
    np.testing.assert_allclose(forces, r.force[1:, 0], rtol=1e-12)


def test_interrupt_returns_what_was_computed_and_a_clean_contact(rotor, maxwell):
    contact = maxwell(3e8, 1e8, 1e3, approach=-rotor.load.sum() / 3e8)
    start = rotor.rest_at([-rotor.load.sum() / 3e8]), np.zeros(2)

    def stop(step, steps):
        assert steps == 100
        if step == 40:
            raise KeyboardInterrupt

    r = simulate_rotor(rotor.on([contact]), dt=1e-5, until=1e-3, start=start, callback=stop)
    assert r.status == "interrupted" and r.t.size == 41 and r.t[-1] == pytest.approx(4e-4)
    assert contact.u == r.approach[-1, 0]


def at_rest(rotor, contact):
    return rotor.on([contact]).equilibrium(), np.zeros(2)


class Fails:
    """Raises in its own solver after some calls, in the middle of a step."""

    def __init__(self, element, calls, error):
        self.element, self.left, self.error, self.state = element, calls, error, 0

    def advance(self, dt, approach, rate):
        self.left -= 1
        self.state += 1
        if self.left < 0:
            raise self.error
        return self.element.advance(dt, approach, rate)

    def save_state(self):
        return self.state

    def restore_state(self, state):
        self.state = state


def test_failure_inside_a_contact_keeps_the_history(rotor, contact):
    broken = Fails(contact, 30, ConvergenceError("film diverged", None))
    with pytest.raises(ConvergenceError, match=r"rotor at t = .* film diverged") as caught:
        simulate_rotor(rotor.on([broken]), dt=1e-5, until=1e-3, start=at_rest(rotor, contact))
    partial = caught.value.result
    assert partial.status is Status.FAILED and 10 < partial.t.size <= 30
    assert broken.state == partial.iterations.sum() - (partial.iterations - 1).clip(0).sum()


def test_interrupt_inside_a_contact_rewinds_it(rotor, contact):
    broken = Fails(contact, 30, KeyboardInterrupt())
    r = simulate_rotor(rotor.on([broken]), dt=1e-5, until=1e-3, start=at_rest(rotor, contact))
    assert r.status == "interrupted" and broken.state == r.t.size - 1


def test_step_that_does_not_balance_is_an_error_with_the_partial_result(rotor, contact):
    with pytest.raises(ConvergenceError, match="force imbalance") as caught:
        simulate_rotor(rotor.on([contact]), dt=1e-4, until=0.1, tolerance=1e-15, max_iterations=2)
    assert caught.value.result.t.size >= 1


def test_not_a_number_from_a_contact_ends_the_run(rotor, contact, hidden):
    blind = hidden(contact)
    blind.advance = lambda dt, u, v: np.nan if blind.calls else contact.force(u, v)
    start = rotor.on([contact]).equilibrium(), np.zeros(2)

    def spoil(step, steps):
        blind.calls = step >= 20

    with pytest.raises(ConvergenceError) as caught:
        simulate_rotor(rotor.on([blind]), dt=1e-5, until=1e-3, start=start, callback=spoil)
    assert caught.value.result.t.size == 21


def test_bad_calls(rotor, contact, cubic, maxwell):
    def run(contacts=(contact,), **changes):
        return simulate_rotor(rotor.on(contacts), **({"dt": 1e-5, "until": 1e-4} | changes))

    for changes in (
        {"dt": 0.0},
        {"until": np.nan},
        {"until": 1e9},
        {"tolerance": -1.0},
        {"rho_inf": 1.5},
        {"max_iterations": 0},
        {"start": "rest"},
        {"start": ([0.0, np.nan], [0.0, 0.0])},
        {"start": ([0.0], [0.0, 0.0])},
        {"contacts": (contact, contact)},
        {"contacts": (object(),)},
        {"contacts": (cubic,)},
        {"contacts": (maxwell(1, 1, 1),)},
    ):
        with pytest.raises(InputError):
            run(**changes)


def test_unloaded_rotor_in_space_runs(contact):
    rotor = jeffcott_rotor(bearings=1, **BODY, gravity=(0, 0), offset=-1e-5)
    with pytest.warns(OutsideValidityWarning, match="approach"):
        r = simulate_rotor(rotor.on([contact]), dt=1e-5, until=1e-4, start=np.zeros((2, 2)))
    assert not r.journal.any() and not r.force.any()
