"""Stiffness and damping over frequency: against elements, against motions in time."""

from math import pi

import numpy as np
import pytest
from beam_rotor import still_motion, with_light_balls

from ehlcontact.errors import InputError
from reduced_models import BallBearing
from reduced_models.bearing.ball_states import bearing_system
from reduced_models.bearing.ring_statics import equilibrium_under, linear_balls

RPM = 3000.0


@pytest.mark.parametrize("race", ["inner", "outer"])
@pytest.mark.parametrize("load", [2.0, 60.0, 900.0])
def test_a_contact_has_the_impedance_of_its_element(film, race, load):
    """Of the heaviest ball."""
    element, omega = film.element(race, RPM), np.array([10.0, 1e3, 1e5])
    at = equilibrium_under(film, np.array([0.0, -5.0 * load]), RPM, -pi / 2.0)
    column = ("inner", "outer").index(race)
    k = int(np.argmax(at.force[:, column]))
    found = linear_balls(film, RPM, [at]).films.impedance(1j * omega[:, None, None])[:, column, k]
    expected = element.impedance(load=at.force[k, column], omega=omega).value
    np.testing.assert_allclose(found, expected, rtol=1e-6)


@pytest.mark.parametrize("changes", [{}, {"ball_inertia": True}, {"oil": None}, {"loss_factor": 0.05}])
@pytest.mark.parametrize(("name", "load"), [("6205", (0.0, -800.0)), ("7205", (0.0, -300.0, 400.0))])
def test_the_impedance_is_the_transfer_function_of_the_state_space(oil, name, load, changes):
    bearing = BallBearing.catalogue(name, **{"oil": oil} | changes)
    places = [equilibrium_under(bearing, np.array(load), RPM, angle) for angle in (0.1, 0.3)]
    balls = linear_balls(bearing, RPM, places)
    A, B, C, D = bearing_system(balls)
    n, unit = len(C), np.array([1.0, 1.0, 1.0, 1e-2, 1e-2])
    for s in 2j * pi * np.array([0.5, 50.0, 500.0, 5000.0]):
        G = C @ np.linalg.solve(s * np.eye(len(A)) - A, B) + D
        Z, scale = balls.impedance(s), np.outer(unit, unit)[:n, :n]
        assert np.abs((G[:, :n] + s * G[:, n:] - Z) * scale).max() < 1e-9 * np.abs(Z * scale).max()


@pytest.mark.parametrize(
    ("changes", "ways", "hz", "periods", "per_period", "within"),
    [
        ({}, (0, 1), 2000.0, 4, 500, 2e-4),
        ({"cutoff_gap": 8e-6}, (0, 1), 2000.0, 4, 500, 2e-4),
        ({"loss_factor": 0.05}, (1,), 400.0, 200, 200, 3e-4),
        ({"loss_factor": 0.05, "oil": None}, (1,), 400.0, 200, 200, 3e-4),
    ],
    ids=["film", "cutoff gap", "loss", "dry with loss"],
)
def test_small_motions_in_time(oil, changes, ways, hz, periods, per_period, within):
    """A ring that swings a little, its balls standing still: amplitude and phase of the force."""
    bearing = BallBearing.catalogue("6205", **{"oil": oil} | changes)
    still = with_light_balls(bearing)
    at = equilibrium_under(still, np.array([200.0, -1000.0]), RPM, 0.4)
    size, omega, dt = 1e-10, 2.0 * pi * hz, 1.0 / (hz * per_period)
    t = dt * np.arange(1, periods * per_period + 1)
    Z = linear_balls(still, RPM, [at]).impedance(1j * omega)
    for k in ways:
        direction = np.eye(2)[k]
        run = still_motion(bearing, RPM, dt, 0.4)
        start = run.rest(at.displacement)
        q = at.displacement + size * np.sin(omega * t)[:, None] * direction
        force, _ = run.drive(q, size * omega * np.cos(omega * t)[:, None] * direction)
        last = slice(-per_period, None)
        swing = 2.0 * np.mean((force[last] - start) * np.exp(-1j * omega * t[last])[:, None], axis=0) * 1j / size
        np.testing.assert_allclose(swing, Z[:, k], rtol=0.0, atol=within * abs(Z[k, k]))


def test_damping_falls_with_frequency_and_stiffness_rises(film):
    found = film.coefficients((0.0, -1000.0), speed_rpm=RPM, hz=[0.0, 100.0, 1e3, 1e4])
    assert np.all(np.diff(found.damping[:, 1, 1]) < 0.0)
    assert np.all(np.diff(found.stiffness[:, 1, 1]) > -1e3)
    np.testing.assert_allclose(found.hz, [0.0, 100.0, 1e3, 1e4])
    np.testing.assert_allclose(found.stiffness, found.stiffness.swapaxes(1, 2), rtol=1e-12, atol=1.0)


def test_stiffness_at_rest_is_the_slope_of_the_static_force(film):
    state = film.equilibrium((300.0, -1000.0), speed_rpm=RPM, cage_angle=0.1)
    at_zero = film.coefficients((300.0, -1000.0), speed_rpm=RPM, cage_angle=0.1, hz=0.0)
    np.testing.assert_allclose(at_zero.stiffness[0], state.stiffness, rtol=1e-6)
    np.testing.assert_allclose(at_zero.peak_to_peak, 0.0)
    more = [
        film.equilibrium((300.0, -1000.0 + d), speed_rpm=RPM, cage_angle=0.1).displacement for d in (-1.0, 1.0)
    ]
    np.testing.assert_allclose(state.stiffness @ (more[1] - more[0]), [0.0, 2.0], atol=2e-4)


def test_turned_loads_turn_the_matrices(film):
    down = film.coefficients((0.0, -800.0), speed_rpm=RPM, hz=300.0)
    across = film.coefficients((800.0, 0.0), speed_rpm=RPM, hz=300.0)
    for name in ("stiffness", "damping"):
        np.testing.assert_allclose(
            getattr(across, name)[0], getattr(down, name)[0][::-1, ::-1], rtol=1e-6, atol=1e-6 * 1e8
        )


def test_coefficients_as_impedance_and_as_a_system_of_control(film):
    found = film.coefficients((0.0, -500.0), speed_rpm=3000.0, hz=[50.0, 500.0])
    Z = found.stiffness + 1j * (2.0 * np.pi * np.array([50.0, 500.0]))[:, None, None] * found.damping
    np.testing.assert_allclose(found.value, Z, rtol=1e-14)
    system = found.to_control()
    assert system.input_labels == ["u_x", "u_y"] and system.output_labels == ["F_x", "F_y"]
    np.testing.assert_allclose(system(1j * found.omega[1]), found.value[1], rtol=1e-14)


def test_dry_bearings_do_not_damp(dry):
    found = dry.coefficients((0.0, -800.0), hz=[1.0, 1e4])
    assert np.all(found.damping == 0.0)
    np.testing.assert_allclose(found.stiffness[0], found.stiffness[1])


def test_a_frequency_needs_its_unit(film):
    with pytest.raises(InputError, match="frequency"):
        film.coefficients((0.0, -800.0), speed_rpm=RPM)
    with pytest.raises(InputError, match="frequency"):
        film.coefficients((0.0, -800.0), 50.0, speed_rpm=RPM)


@pytest.mark.parametrize(
    ("load", "low", "high"),
    [
        (1000.0, 3000.0, 3300.0),
        *(
            pytest.param(*case, marks=pytest.mark.long)
            for case in ((1000.0, 3300.0, 4000.0), (500.0, 7800.0, 8100.0))
        ),
    ],
)
@pytest.mark.parametrize("name", ["stiffness", "damping"])
def test_nothing_jumps_over_the_speed(film, load, low, high, name):
    """Elements go through the same loads at every speed: where the curve bends most, that is followed down."""

    def at(speed):
        found = film.coefficients((0.0, -load), speed_rpm=speed, cage_angle=0.3, hz=200.0)
        return np.log(np.diag(getattr(found, name)[0]))

    speeds = np.linspace(low, high, 16)
    values = np.array([at(speed) for speed in speeds.tolist()])
    k, way = np.unravel_index(np.argmax(np.abs(np.diff(values, n=2, axis=0))), (14, 2))
    ends = [(speeds[k + i], values[k + i, way]) for i in (0, 2)]
    slope = abs(ends[1][1] - ends[0][1]) / (ends[1][0] - ends[0][0])
    for _ in range(11):
        middle = 0.5 * (ends[0][0] + ends[1][0])
        ends.insert(1, (middle, at(middle)[way]))
        del ends[0 if abs(ends[2][1] - ends[1][1]) > abs(ends[1][1] - ends[0][1]) else 2]
    assert ends[1][0] - ends[0][0] < 0.1
    assert abs(ends[1][1] - ends[0][1]) < 3.0 * slope * (ends[1][0] - ends[0][0]) + 1e-7
