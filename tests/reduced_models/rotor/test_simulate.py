"""The rotor integrator: exact linear motion, order, energy, contacts with memory, and how it fails."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.status import Status
from reduced_models import JeffcottRotor, OutsideValidityWarning, ScaledContact, SpringContact, simulate_rotor
from reduced_models.rotor.jeffcott import RotorState

BODY = {"disc_mass": 20.0, "journal_mass": 1.0, "shaft_stiffness": 2e7, "shaft_damping": 200.0}
TURNING = BODY | {"unbalance": 1e-4, "speed_rpm": 6000.0}


@pytest.fixture
def rotor():
    return JeffcottRotor.vertical(**TURNING, load=(0.0, -800.0))


def reference(rotor, contacts, state, times):
    """The equations of motion by an explicit integrator of high order."""
    M, C, K = rotor.matrices()
    axes, size = list(rotor.axes), len(rotor.axes)

    def rates(t, y):
        d, v = y[: 2 * size], y[2 * size :]
        u, w = rotor.normals @ d[size:] + rotor.offsets, rotor.normals @ v[size:]
        f = np.array([c.force(float(a), float(b)) for c, a, b in zip(contacts, u, w, strict=True)])
        p = rotor.applied_force(t) - C @ v - K @ d
        p[size:] -= rotor.bearings * rotor.normals.T @ f
        return np.concatenate([v, np.linalg.solve(M, p)])

    start = np.concatenate(
        [getattr(state, n)[axes] for n in ("disc", "journal", "disc_velocity", "journal_velocity")]
    )
    scale = np.repeat([1e-6, 1e-3], 2 * size)
    solution = solve_ivp(rates, (0, times[-1]), start, "DOP853", times, rtol=1e-10, atol=1e-10 * scale)
    return solution.y[size : 2 * size].T


def test_static_start_stays_at_rest(contact):
    rotor = JeffcottRotor.vee(half_angle=0.6, **BODY, load=(100.0, -3000.0))
    result = simulate_rotor(rotor, [contact, contact], dt=1e-5, until=1e-3)
    assert result.status == "converged" and np.ptp(result.journal, axis=0).max() < 1e-14
    np.testing.assert_allclose(result.force[-1], rotor.static_forces(), rtol=1e-8)
    assert not result.journal.flags.writeable and result.iterations[0] == 0


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize("vee", [False, True])
def test_second_order_towards_the_exact_motion(contact, rotor, vee):
    contacts = [contact]
    if vee:
        rotor = JeffcottRotor.vee(half_angle=0.6, **TURNING, load=(100.0, -3000.0))
        contacts = [contact, contact]
    rest = rotor.static_equilibrium(contacts)
    kick = replace(rest, journal_velocity=np.array([0.0, 1e-3]))
    times = np.linspace(0.0, 2e-3, 11)
    exact = reference(rotor, contacts, kick, times)
    errors = []
    for steps in (200, 400, 800):
        r = simulate_rotor(rotor, contacts, dt=2e-3 / steps, until=2e-3, start=kick, tolerance=1e-9)
        errors.append(np.abs(r.journal[:: steps // 10, list(rotor.axes)] - exact).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((orders > 1.85) & (orders < 2.2)), (errors, orders)
    assert errors[-1] < 5e-3 * np.ptp(exact)


def test_motion_through_lift_off_is_followed(contact):
    rotor = JeffcottRotor.vertical(**BODY, load=(0.0, -800.0))
    kick = replace(rotor.static_equilibrium([contact]), journal_velocity=np.array([0.0, 0.2]))
    times = np.linspace(0.0, 2e-3, 41)
    with pytest.warns(OutsideValidityWarning, match="approach"):
        r = simulate_rotor(rotor, [contact], dt=5e-7, until=2e-3, start=kick)
    assert (r.force == 0.0).any() and r.force.max() > 1500.0
    error = np.abs(r.journal[::100, 1] - reference(rotor, [contact], kick, times)[:, 0]).max()
    assert error < 2e-3 * np.ptp(r.journal[:, 1])
    assert r.iterations.max() <= 8


def test_average_acceleration_keeps_the_energy_of_a_linear_rotor():
    element = SpringContact.linear(2e8, 0.0, 1e-9, 1e-3, units="SI")
    rotor = JeffcottRotor.vertical(disc_mass=20.0, journal_mass=1.0, shaft_stiffness=2e7)
    moving = np.array([0.0, 1e-4])
    kick = replace(rotor.static_equilibrium([element]), disc_velocity=moving, journal_velocity=moving)
    r = simulate_rotor(rotor, [element], dt=2e-5, until=2e-2, start=kick, rho_inf=1.0, tolerance=1e-12)
    bend = r.disc[:, 1] - r.journal[:, 1]
    energy = 10.0 * r.disc_velocity[:, 1] ** 2 + 0.5 * r.journal_velocity[:, 1] ** 2 + 1e7 * bend**2
    energy += 1e8 * r.approach[:, 0] ** 2 + 9.81 * (20.0 * r.disc[:, 1] + r.journal[:, 1])
    kinetic = 10.0 * 1e-8
    assert np.ptp(energy) < 1e-6 * kinetic
    damped = simulate_rotor(rotor, [element], dt=2e-5, until=2e-2, start=kick, rho_inf=0.0)
    # The contact mode (2.2 kHz) is barely resolved: kept with rho_inf = 1, gone with 0.
    fast, gone = (np.ptp(np.diff(x.rate[-200:, 0])) for x in (r, damped))
    assert gone < 0.1 * fast


def test_energy_balance_with_damping(contact):
    rotor = JeffcottRotor.vertical(**BODY, load=(0.0, -800.0))
    kick = replace(rotor.static_equilibrium([contact]), journal_velocity=np.array([0.0, 5e-3]))
    r = simulate_rotor(rotor, [contact], dt=1e-6, until=2e-3, start=kick)
    work = np.trapezoid(r.force[:, 0] * r.rate[:, 0], r.t)  # into the contact
    shaft = 200.0 * np.trapezoid((r.disc_velocity[:, 1] - r.journal_velocity[:, 1]) ** 2, r.t)
    bend = r.disc[:, 1] - r.journal[:, 1]
    kinetic = 10.0 * r.disc_velocity[:, 1] ** 2 + 0.5 * r.journal_velocity[:, 1] ** 2
    stored = kinetic + 1e7 * bend**2 + (20.0 * 9.81 + 800.0) * r.disc[:, 1] + 9.81 * r.journal[:, 1]
    assert stored[0] - stored[-1] == pytest.approx(work + shaft, rel=2e-3)


def test_secants_give_what_tangents_give(contact, rotor, hidden):
    blind = hidden(contact)
    start = rotor.static_equilibrium([contact])
    by_tangent = simulate_rotor(rotor, [contact], dt=2e-5, until=0.02)
    by_secant = simulate_rotor(rotor, [blind], dt=2e-5, until=0.02, start=start)
    dynamic = np.ptp(by_tangent.force)
    assert np.abs(by_secant.force - by_tangent.force).max() < 1e-4 * dynamic
    assert blind.calls <= 2 * 1000 + 2


def test_scaled_contact_runs_as_the_si_element_does(cubic, contact, scales, rotor):
    a = simulate_rotor(rotor, [contact], dt=2e-5, until=4e-3)
    b = simulate_rotor(rotor, [ScaledContact(cubic, scales)], dt=2e-5, until=4e-3)
    np.testing.assert_allclose(b.journal, a.journal, rtol=1e-9)


def maxwell_exact(rotor, branch, start, times):
    """Linear motion with the branch force z as one more state: exact by the matrix exponential."""
    (k, k2, c2), (M, C, K) = branch, rotor.matrices()
    d0, v0 = ([getattr(start, b + n)[1] for b in ("disc", "journal")] for n in ("", "_velocity"))
    A = np.zeros((6, 6))
    A[:2, 2:4] = np.eye(2)
    inverse = np.linalg.inv(M)
    A[2:4, :2], A[2:4, 2:4] = -inverse @ K, -inverse @ C
    # approach = -y of the journal; the contact pushes it up.
    A[3, 1] -= k / M[1, 1]
    A[3, 4] = 1.0 / M[1, 1]
    A[4, 3], A[4, 4] = -k2, -k2 / c2
    A[2:4, 5] = inverse @ rotor.applied_force(0.0)
    y0 = np.concatenate([d0, v0, [0.0, 1.0]])
    return np.array([(expm(A * t) @ y0)[1] for t in times])


def test_contact_with_memory_and_no_tangents_is_exact_in_the_limit(maxwell):
    rotor = JeffcottRotor.vertical(**BODY)
    k, k2, c2 = 1e8, 6e7, 4e3
    start = rotor.rest_state(rotor.static_load / k)
    kick = replace(start, journal_velocity=np.array([0.0, 2e-3]))
    times = np.linspace(0.0, 4e-3, 21)
    exact = maxwell_exact(rotor, (k, k2, c2), kick, times)
    errors = []
    for steps in (400, 800):
        contact = maxwell(k, k2, c2, approach=-kick.journal[1])
        r = simulate_rotor(rotor, [contact], dt=4e-3 / steps, until=4e-3, start=kick, tolerance=1e-8)
        errors.append(np.abs(r.journal[:: steps // 20, 1] - exact).max())
        # A linear contact has one slope: the probe finds it, and every step takes two calls at most.
        assert contact.calls <= 2 * steps + 2 and r.iterations.max() <= 2
        assert contact.u == r.approach[-1, 0]
    assert errors[1] < 2e-3 * np.ptp(exact) and 1.9 < np.log2(errors[0] / errors[1]) < 2.1


def test_contact_is_advanced_once_per_step_in_net(rotor, maxwell):
    """Whatever the iteration tries, the state moves from step to step only."""
    contact = maxwell(3e8, 1e8, 1e3, approach=-rotor.static_load[0] / 3e8)
    start = rotor.rest_state(rotor.static_load / 3e8)
    r = simulate_rotor(rotor, [contact], dt=1e-5, until=2e-3, start=start)
    replay = maxwell(3e8, 1e8, 1e3, approach=r.approach[0, 0])
    forces = [replay.advance(1e-5, u, v) for u, v in zip(r.approach[1:, 0], r.rate[1:, 0], strict=True)]
    np.testing.assert_allclose(forces, r.force[1:, 0], rtol=1e-12)


def test_interrupt_returns_what_was_computed_and_a_clean_contact(rotor, maxwell):
    contact = maxwell(3e8, 1e8, 1e3, approach=-rotor.static_load[0] / 3e8)
    start = rotor.rest_state(rotor.static_load / 3e8)

    def stop(step, steps):
        assert steps == 100
        if step == 40:
            raise KeyboardInterrupt

    r = simulate_rotor(rotor, [contact], dt=1e-5, until=1e-3, start=start, callback=stop)
    assert r.status == "interrupted" and r.t.size == 41 and r.t[-1] == pytest.approx(4e-4)
    assert contact.u == r.approach[-1, 0]


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
        simulate_rotor(rotor, [broken], dt=1e-5, until=1e-3, start=rotor.static_equilibrium([contact]))
    partial = caught.value.result
    assert partial.status is Status.FAILED and 10 < partial.t.size <= 30
    assert broken.state == partial.iterations.sum() - (partial.iterations - 1).clip(0).sum()


def test_interrupt_inside_a_contact_rewinds_it(rotor, contact):
    broken = Fails(contact, 30, KeyboardInterrupt())
    r = simulate_rotor(rotor, [broken], dt=1e-5, until=1e-3, start=rotor.static_equilibrium([contact]))
    assert r.status == "interrupted" and broken.state == r.t.size - 1


def test_step_that_does_not_balance_is_an_error_with_the_partial_result(rotor, contact):
    with pytest.raises(ConvergenceError, match="force imbalance") as caught:
        simulate_rotor(rotor, [contact], dt=1e-4, until=0.1, tolerance=1e-15, max_iterations=2)
    assert caught.value.result.t.size >= 1


def test_not_a_number_from_a_contact_ends_the_run(rotor, contact, hidden):
    blind = hidden(contact)
    blind.advance = lambda dt, u, v: np.nan if blind.calls else contact.force(u, v)
    start = rotor.static_equilibrium([contact])

    def spoil(step, steps):
        blind.calls = step >= 20

    with pytest.raises(ConvergenceError) as caught:
        simulate_rotor(rotor, [blind], dt=1e-5, until=1e-3, start=start, callback=spoil)
    assert caught.value.result.t.size == 21


def test_bad_calls(rotor, contact, cubic, maxwell):
    def run(contacts=(contact,), **changes):
        return simulate_rotor(rotor, contacts, **({"dt": 1e-5, "until": 1e-4} | changes))

    for changes in (
        {"dt": 0.0},
        {"until": np.nan},
        {"until": 1e9},
        {"tolerance": -1.0},
        {"rho_inf": 1.5},
        {"max_iterations": 0},
        {"start": "rest"},
        {"contacts": (contact, contact)},
        {"contacts": (object(),)},
        {"contacts": (cubic,)},
        {"contacts": (maxwell(1, 1, 1),)},
    ):
        with pytest.raises(InputError):
            run(**changes)
    with pytest.raises(InputError, match="journal"):
        RotorState([0, 0], [0, np.nan], [0, 0], [0, 0])


def test_unloaded_rotor_in_space_runs(contact):
    rotor = JeffcottRotor.vertical(**BODY, gravity=(0, 0), offset=-1e-5)
    with pytest.warns(OutsideValidityWarning, match="approach"):
        r = simulate_rotor(rotor, [contact], dt=1e-5, until=1e-4, start=rotor.rest_state(np.zeros(1)))
    assert not r.journal.any() and not r.force.any()
