"""Contacts of a 6205 under 1 kN against the film itself, solved: small vibrations, and a ball on its way round."""

from math import pi

import numpy as np
import pytest

from ehlcontact import Domain, Grid, Lubricant, PrescribedApproach, TimeSteps, impedance, simulate, solve_steady
from reduced_models import BallBearing
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.bearing.loss import loss_of
from reduced_models.bearing.ring_statics import equilibrium_under

DOWN = (0.0, -1000.0)
OMEGA = np.array([0.0, 0.05, 0.25, 1.0, pi, 2.0 * pi, 12.0, 20.0])  # 1 is 4.2 kHz at 3000 rpm under 477 N
FAST = 1.0


def compared(film, rpm, race, ball):
    """Largest errors of the wide element: of Z over |Z|, of K, of C up to `FAST` and beyond, relative."""
    force = film.equilibrium(DOWN, speed_rpm=rpm).force[ball, ("inner", "outer").index(race)]
    point = film.race(race).point(force, rpm)
    solved, omega = impedance(point, Omega=OMEGA), OMEGA / point.scales.time
    wide = film.element(race, rpm).impedance(load=force, omega=np.maximum(omega, 1e-3 / point.scales.time))
    K, C = wide.stiffness, wide.damping
    Z = np.abs(K - solved.stiffness + 1j * omega * (C - solved.damping))
    of_Z = Z / np.hypot(solved.stiffness, omega * solved.damping)
    of_C = np.abs(C / solved.damping - 1.0)
    slow = OMEGA <= FAST
    return [float(v.max()) for v in (of_Z, np.abs(K / solved.stiffness - 1.0), of_C[slow], of_C[~slow])]


@pytest.mark.parametrize("race", ["inner", "outer"])
def test_impedance_of_a_light_contact(film, race):
    assert np.all(np.array(compared(film, 3000.0, race, 2)) < (0.02, 0.02, 0.07, 0.07))


@pytest.mark.slow
@pytest.mark.parametrize("ball", [0, 1, 2])  # 470 to 480 N, 330 N, 44 to 66 N
@pytest.mark.parametrize("race", ["inner", "outer"])
@pytest.mark.parametrize("rpm", [1000.0, 3000.0, 6000.0])
def test_impedance_of_every_loaded_contact(film, rpm, race, ball):
    """Issue 12: within 5 %. Z and K are within 3 %; C within 7 % up to 4 kHz and more, 11 % where it has faded."""
    of_Z, of_K, of_C, of_fast_C = compared(film, rpm, race, ball)
    assert of_Z < (0.03 if ball == 2 else 0.01) and of_K < (0.03 if ball == 2 else 0.01)
    assert of_C < (0.07 if ball == 2 else 0.045) and of_fast_C < 0.11


@pytest.fixture(scope="module")
def ball(film):
    """The ball under the load on its way out of it, its approach at the inner race that of the bearing at rest."""
    angles, rpm = np.radians(np.linspace(0.0, 92.0, 185)), 3000.0
    states = [film.equilibrium(DOWN, speed_rpm=rpm, cage_angle=a - pi / 2.0) for a in angles.tolist()]
    approach, force = (np.array([getattr(s, name)[0, 0] for s in states]) for name in ("approach", "force"))
    time = angles / (rpm * pi / 30.0 * film.orders.ftf_order)
    point = film.race("inner").point(force[0], rpm)
    s = point.scales
    full = simulate(point, PrescribedApproach(time / s.time, approach / s.length), time=TimeSteps(dt=s.time))
    t, u, v = full.t, full.approach, full.rate
    wide = film.element("inner", rpm).drive(t, u, v)
    return u, full.force, wide, film.element("inner", rpm).spring(u)


@pytest.mark.slow
def test_a_ball_on_its_way_out_of_the_load(ball):
    """Issue 12, of a prototype: wide element within 0.13 % of the peak rms, 2 N low where 11 N are left."""
    _, full, wide, still = ball
    assert full[0] == pytest.approx(476.5, abs=1.0) and full[-1] < 9.0
    assert np.sqrt(np.mean((wide - full) ** 2)) < 1.3e-3 * full.max()
    assert 1.5 < np.interp(-11.0, -full, full - wide) < 2.5
    # it is no memory: so slowly, films are nearly those at rest
    assert np.abs(wide - still).max() < 0.12  # N


@pytest.mark.slow
def test_what_a_light_ball_lacks_is_the_oil_further_out(ball, film):
    """Our region is 4.5 semi-axes of the heaviest load; elements know every load with 4.5 semi-axes of its own.

    At rest under 8.3 N the film of as much oil lifts the bodies 86 nm further; on the element's curve that is
    2.2 N, where it lacks 2.1 N.
    """
    u, full, wide, _ = ball
    load = full[-1]
    own = film.race("inner").point(load, 3000.0)
    far = (full[0] / load) ** (1.0 / 3.0)
    n = int(np.ceil(128 * far / 16)) * 16
    near, wider = (
        solve_steady(own, grid=Grid(n=n, domain=domain)).approach
        for n, domain in ((128, None), (n, Domain(-4.5 * far, 1.5 * far, 3.0 * far)))
    )
    assert wider == pytest.approx(u[-1], abs=0.05 * (near - wider))
    element = film.element("inner", 3000.0)
    lacking = element.spring(u[-1] + near - wider) - element.spring(u[-1])
    assert lacking == pytest.approx(full[-1] - wide[-1], rel=0.1)
    assert lacking > 2.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ball", "race"), [(0, "inner"), (0, "outer"), (3, "inner"), (6, "inner"), (6, "outer")]
)  # 79 to 271 N
def test_contacts_at_angles_of_a_7205(ball, race):
    """At each contact's own angle and speeds: Z within 3 %, h_central 1.5 %, h_min 1 %."""
    bearing = BallBearing(
        balls=13,
        ball_diameter=7.938e-3,
        pitch_diameter=38.5e-3,
        contact_angle=np.radians(25.0),
        oil=Lubricant.iso_vg(68, temperature=70.0),
    )
    load, rpm, column = np.array([500.0, -200.0, 1000.0]), 12000.0, ("inner", "outer").index(race)
    state = bearing.equilibrium(load, speed_rpm=rpm)
    at = equilibrium_under(bearing, load, rpm, state.cage_angle)
    angle, speed_sum = float(at.angles[ball, column]), float(at.speed_sum[ball, column])
    own = bearing.race(race).at_angle(bearing.pitch_diameter, angle, speed_sum)
    point = own.point(float(state.force[ball, column]), rpm)
    steady = solve_steady(point, grid=Grid(n=256))
    assert state.h_central[ball, column] == pytest.approx(steady.h_central, rel=0.015)
    assert state.h_min[ball, column] == pytest.approx(steady.h_min, rel=0.01)
    Omega = np.array([0.05, 0.5, pi])
    solved, omega = impedance(point, Omega=Omega, grid=Grid(n=128)), Omega / point.scales.time
    small = LinearBalls.of(bearing.tables.balls(rpm), [at], loss_of(0.0), 0.0)
    Z = small.films.impedance(1j * omega[:, None, None])[:, column, ball]
    full = solved.stiffness + 1j * omega * solved.damping
    assert np.all(np.abs(Z - full) < 0.03 * np.abs(full))
