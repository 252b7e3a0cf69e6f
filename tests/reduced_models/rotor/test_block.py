"""Rotors as blocks of python-control: against the linearised rotor, against each other, against runs in time."""

import numpy as np
import pytest
from control_blocks import response, slopes

from ehlcontact.errors import InputError
from reduced_models import BallBearing, linearise, rotor_to_control, simulate_rotor
from reduced_models.bearing import ring_statics
from reduced_models.bearing.ball_states import bearing_system
from reduced_models.bearing.linear_reduction import reduced_system

control = pytest.importorskip("control")

RPM, DISC = 3000.0, 12


def test_states_have_the_frequency_response_of_the_impedances(film, beam):
    at = linearise(beam(film), RPM, passage=False)
    block = at.to_control(tolerance=0.0)
    omega = np.geomspace(10.0, 1e6, 6)
    for w, expected in zip(omega, at.receptance(omega=omega), strict=True):
        np.testing.assert_allclose(response(block, w), expected, rtol=0.0, atol=1e-9 * abs(expected).max())


def test_eigenvalues_of_the_states_are_the_modes(film, beam):
    at = linearise(beam(film), RPM, passage=False)
    values = np.linalg.eigvals(at.to_control(tolerance=0.0).A)
    modes = at.modes(None)
    for mode in modes:
        assert np.abs(values - mode.eigenvalue).min() < 1e-9 * abs(mode.eigenvalue)
    assert values.real.max() == pytest.approx(at.growth, rel=1e-3)
    # and there are no others that oscillate slowly
    slow = values[(values.imag > 1.0) & (values.imag < 1.1 * modes[7].omega)]
    weak = slow[-slow.real < 0.5 * slow.imag]
    assert len(weak) == 8


def test_means_over_a_passage_have_all_positions_as_states(film, block, monkeypatch):
    monkeypatch.setattr(ring_statics, "POSITIONS", 2)
    at = linearise(block(film), RPM)
    found = at.to_control(tolerance=0.0)
    assert found.nstates == 4 + 2 * 9 * (1 + 2 * (film.element("inner", RPM).lags + 2))
    for w in (100.0, 1e4):
        expected = at.receptance(omega=w)[0]
        np.testing.assert_allclose(response(found, w), expected, rtol=0.0, atol=1e-9 * abs(expected).max())


@pytest.mark.parametrize("cutoff_gap", [None, 2e-6])
def test_linearize_is_the_state_space(film, block, cutoff_gap):
    """The nonlinear block, by differences of 1e-5 um (and um/s)."""
    rotor = block(BallBearing.catalogue("6205", oil=film.oil, cutoff_gap=cutoff_gap))
    at = linearise(rotor, RPM, passage=False)
    assert (cutoff_gap is None) == bool(np.all(at.balls[0].films.slope[0] > 0.0))  # the top balls are let go
    exact, moving = at.to_control(tolerance=0.0), rotor_to_control(rotor, RPM, cage_turns=False)
    rest = np.zeros(moving.nstates)
    rates = moving.dynamics(0.0, rest, np.zeros(2))
    assert np.abs(rates[2:4]).max() < 1e-3  # um/s2
    found = control.linearize(moving, rest, np.zeros(2), eps=1e-5)
    assert moving.state_labels == exact.state_labels
    for name in "ABCD":
        one, other = getattr(found, name), getattr(exact, name)
        scale = np.abs(other).max(axis=1, keepdims=True) if name in "AB" else np.abs(other).max()
        assert np.all(np.abs(one - other) <= 1e-4 * scale)
    for w in (10.0, 1e3, 1e4, 1e5):
        expected = response(exact, w)
        np.testing.assert_allclose(response(found, w), expected, rtol=0.0, atol=1e-4 * abs(expected).max())


@pytest.mark.parametrize("cutoff_gap", [None, 2e-6])
def test_the_state_space_is_that_of_differences(film, block, cutoff_gap):
    """Rates of rotor, balls and films by every state and input, to 1e-6 of those of the same row."""
    rotor = block(BallBearing.catalogue("6205", oil=film.oil, cutoff_gap=cutoff_gap))
    exact, moving = (
        linearise(rotor, RPM, passage=False).to_control(tolerance=0.0),
        rotor_to_control(rotor, RPM, cage_turns=False),
    )
    system = np.hstack([exact.A, exact.B])
    found = slopes(moving, lambda name: 10.0 if name.startswith("v") else 1e-4)  # um/s; um
    assert np.all(np.abs(found - system) <= 1e-6 * np.abs(system).max(axis=1, keepdims=True))


def test_linearize_of_a_beam(film, beam):
    rotor = beam(film)
    exact = linearise(rotor, RPM, passage=False).to_control([DISC], [DISC, 4], tolerance=0.0)
    moving = rotor_to_control(rotor, RPM, inputs=[DISC], outputs=[DISC, 4], cage_turns=False)
    found = control.linearize(moving, np.zeros(moving.nstates), [0.0], eps=1e-5)
    for w in (10.0, 1e3, 1e4):
        expected = response(exact, w)
        np.testing.assert_allclose(response(found, w), expected, rtol=0.0, atol=1e-4 * abs(expected).max())


# scipy's BDF subtracts room it has not written yet, in its first steps: a warning where that holds an infinity.
@pytest.mark.filterwarnings("ignore:invalid value encountered in subtract:RuntimeWarning:scipy")
def test_block_in_time_is_the_run(film, block):
    """A block that is pushed while balls go round, with the tolerances of python-control, against our own run."""
    rotor = block(film, damping=500.0 * np.eye(2), unbalances=())
    moving = rotor_to_control(rotor, RPM, inputs={"across": 0, "up": 1}, outputs={"x": 0, "y": 1})
    t = np.linspace(0.0, 0.004, 81)
    push = np.array([np.full(t.size, 20.0), np.zeros(t.size)])
    seen = control.input_output_response(moving, t, push, solve_ivp_method="BDF")
    assert seen.output_labels == ["x", "y"] and seen.input_labels == ["across", "up"]
    # the run is pushed by its load, from the block's rest
    start = rotor.equilibrium(RPM), np.zeros(2)
    pushed = block(film, damping=500.0 * np.eye(2), unbalances=(), load=np.array([20.0, -300.0]))
    run = simulate_rotor(pushed, speed_rpm=RPM, dt=1e-6, until=0.004, start=start)
    expected = (run.displacement[::50] - start[0]).T
    np.testing.assert_allclose(seen.outputs, expected, rtol=0.0, atol=0.01 * np.ptp(expected))


@pytest.mark.parametrize("oiled", [True, False])
@pytest.mark.parametrize(
    ("changes", "part", "labels", "omega", "share"),
    [
        ({"loss_factor": 0.05}, slice(-2, None), ["b0_seat_x8", "b0_seat_y8"], (30.0, 1e3, 2e4), 1e-4),
        ({"ball_inertia": True, "clearance": -4e-6}, slice(4, 6), ["b0_0_w", "b0_0_v"], (1e3, 1e5, 3e5), 3e-4),
    ],
    ids=["loss", "inertia"],
)
def test_states_of_losses_and_of_balls_with_inertia(oil, block, oiled, changes, part, labels, omega, share):
    rotor = block(BallBearing.catalogue("6205", oil=oil if oiled else None, **changes))
    at = linearise(rotor, RPM, passage=False)
    exact, moving = at.to_control(tolerance=0.0), rotor_to_control(rotor, RPM, cage_turns=False)
    assert exact.state_labels == moving.state_labels and exact.state_labels[part] == labels
    found = control.linearize(moving, np.zeros(moving.nstates), np.zeros(2), eps=1e-5)
    for w in omega:
        expected = at.receptance(omega=w)[0]
        for one in (exact, found):
            np.testing.assert_allclose(response(one, w), expected, rtol=0.0, atol=share * abs(expected).max())


def test_a_dry_ball_vibrates_on_its_two_contacts(block):
    at = linearise(block(BallBearing.catalogue("6205", ball_inertia=True, clearance=-4e-6)), RPM, passage=False)
    contact = at.balls[0]
    bounce = np.sqrt(contact.films.stiffness.sum(axis=0) / contact.inertia).max()
    assert np.linalg.eigvals(at.to_control(tolerance=0.0).A).imag.max() == pytest.approx(bounce, rel=0.02)
    assert 30e3 < bounce / (2.0 * np.pi) < 45e3


def test_dry_bearings_have_no_states(dry, block):
    rotor = block(dry)
    moving = rotor_to_control(rotor, RPM, cage_turns=False)
    exact = linearise(rotor, RPM, passage=False).to_control(tolerance=0.0)
    assert moving.nstates == exact.nstates == 4
    found = control.linearize(moving, np.zeros(4), np.zeros(2), eps=1e-5)
    np.testing.assert_allclose(found.A, exact.A, rtol=1e-4, atol=1e-4 * np.abs(exact.A).max())


def test_names(film, block):
    moving, exact = (
        rotor_to_control(block(film), RPM),
        linearise(block(film), RPM, passage=False).to_control(name="r", tolerance=0.0),
    )
    for one in (moving, exact):
        assert one.input_labels == ["F0", "F1"] and one.output_labels == ["q0", "q1"]
        assert one.state_labels[:6] == ["q0", "q1", "v0", "v1", "b0_0_w", "b0_0_i_s"]
        cage = int(one is moving)  # turns
        assert one.nstates == len(one.state_labels)
        assert one.nstates == 4 + 9 * (1 + 2 * (film.element("inner", RPM).lags + 2)) + cage
    assert moving.state_labels[-1] == "b0_cage"
    assert (moving.name, exact.name) == ("rotor", "r")


@pytest.mark.parametrize(
    ("given", "match"),
    [
        ({"inputs": [2]}, r"inputs\['F2'\] = 2: must be degrees of freedom from 0 to 1"),
        ({"outputs": {"up": -1}}, r"outputs\['up'\] = -1: must be degrees of freedom from 0 to 1"),
        ({"outputs": [0, 0]}, r"outputs = \[0, 0\]: must be degrees of freedom from 0 to 1, each once"),
        ({"inputs": []}, r"inputs = \[\]: must be"),
    ],
)
def test_bad_signals(film, block, given, match):
    with pytest.raises(InputError, match=match):
        rotor_to_control(block(film), RPM, **given)
    with pytest.raises(InputError, match=match):
        linearise(block(film), RPM, passage=False).to_control(**given)


def test_bad_speeds(film, block):
    with pytest.raises(InputError, match=r"speed_rpm = 30000.0: must be at most"):
        rotor_to_control(block(film), 3e4)
    with pytest.raises(InputError, match=r"rotor = 3: must be a Rotor"):
        rotor_to_control(3, RPM)


@pytest.mark.parametrize("tolerance", [1e-4, pytest.param(1e-6, marks=pytest.mark.long)])
def test_bearings_with_few_states_have_the_impedance_within_their_bound(block, film, tolerance):
    """Against the impedances of all balls at all positions of the cage; static stiffness is exact."""
    at = linearise(block(film), RPM)
    found = at.to_control(tolerance=tolerance)
    whole = sum(len(bearing_system(balls).A) for balls in at.balls)
    assert found.nstates < 0.05 * whole and 0.0 < found.reduction_error < tolerance
    assert np.all(found.poles().real < 0.0)
    for balls in at.balls:
        space, bound = reduced_system(balls, tolerance)
        K = np.sqrt(np.diag(balls.impedance(1e-3).real))
        for s in 1j * np.geomspace(1e-2, 1e6, 17):
            G = space.C @ np.linalg.solve(s * np.eye(len(space.A)) - space.A, space.B) + space.D
            off = (G[:, :2] + s * G[:, 2:] - balls.impedance(s)) / np.outer(K, K)
            assert np.linalg.norm(off, 2) < (bound if abs(s) > 1.0 else 1e-8)
    for mode in at.modes(2):
        pole = found.poles()[np.argmin(np.abs(found.poles() - mode.eigenvalue))]
        assert abs(pole - mode.eigenvalue) < tolerance * abs(mode.eigenvalue)


def test_a_tolerance_is_a_share(block, film):
    with pytest.raises(InputError, match=r"tolerance = 1.0: must be below 1"):
        linearise(block(film), RPM, passage=False).to_control(tolerance=1.0)
