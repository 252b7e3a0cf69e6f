"""Rings at contact angles, in five directions: published bearings, exact tangents; a radial load in two."""

from math import acos, atan2, cos, degrees, pi, radians, sin

import numpy as np
import pytest
from refusals import refused
from scipy.optimize import root

from ehlcontact import Lubricant, read, save
from ehlcontact.errors import InputError
from reduced_models import BallBearing, BearingSet
from reduced_models.bearing.contact_angles import CONTROLS
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.ring import STEEPEST, StaticRing

# Harris, Rolling Bearing Analysis: 218 angular contact bearing; steel of 206.8 GPa
HARRIS_218 = {
    "balls": 16,
    "ball_diameter": 22.23e-3,
    "pitch_diameter": 125.3e-3,
    "contact_angle": radians(40.0),
    "conformity_inner": 0.5232,
    "conformity_outer": 0.5232,
    "youngs_modulus": 2.068e11,
}
# Pairs of GMN spindle bearings back to back (catalogue 4000 0813 EN): dm [mm], D [mm], Z, degrees, preloads [N],
# axial rigidity as printed, and as computed by two other programs [N/um]
GMN = [
    (18.0, 4.762, 10, 15, (25, 80, 160), (17, 30, 43), (19, 33, 47)),
    (18.0, 4.762, 10, 25, (45, 130, 260), (42, 65, 87), (47, 71, 95)),
    (31.0, 6.35, 13, 15, (60, 180, 360), (33, 57, 84), (34, 56, 80)),
    (31.0, 6.35, 13, 25, (100, 300, 600), (78, 120, 165), (80, 123, 165)),
    (38.5, 7.938, 13, 15, (100, 300, 600), (45, 77, 112), (43, 72, 103)),
    (38.5, 7.938, 13, 25, (150, 450, 900), (104, 159, 216), (99, 152, 203)),
    (54.0, 7.938, 18, 15, (110, 330, 660), (53, 91, 130), (54, 89, 126)),
    (54.0, 7.938, 18, 25, (180, 530, 1100), (125, 190, 265), (130, 197, 267)),
    (65.0, 8.731, 19, 15, (140, 420, 840), (64, 110, 160), (63, 103, 147)),
    (65.0, 8.731, 19, 25, (220, 670, 1330), (145, 230, 310), (149, 228, 302)),
    (33.5, 4.762, 17, 15, (40, 120, 240), (29, 48, 67), (32, 52, 74)),
    (33.5, 4.762, 17, 25, (60, 180, 360), (70, 105, 138), (73, 112, 149)),
    (125.0, 15.081, 22, 15, (400, 1190, 2380), (118, 193, 275), (116, 188, 264)),
    (125.0, 15.081, 22, 25, (630, 1880, 3750), (285, 430, 570), (277, 420, 555)),
]
SPINDLE = {"balls": 13, "ball_diameter": 7.938e-3, "pitch_diameter": 38.5e-3, "contact_angle": radians(25.0)}


@pytest.mark.parametrize(
    ("rpm", "angles", "forces", "axial", "radial", "displacement"),
    [
        (0.0, (41.50, 41.50), (1679.0, 1679.0), 7.67e8, 4.86e8, 36.0e-6),
        (10000.0, (45.41, 37.41), (1562.0, 2021.0), 5.95e8, 3.72e8, 33.6e-6),
    ],
)
def test_218_under_thrust(rpm, angles, forces, axial, radial, displacement):
    """The model that these numbers are from takes the gyroscopic moment as a magnitude, as published tables do."""
    bearing = BallBearing(**HARRIS_218, race_control="harris")
    state = bearing.equilibrium((0.0, 0.0, 17800.0), speed_rpm=rpm)
    np.testing.assert_allclose(np.degrees(state.contact_angles), np.tile(angles, (16, 1)), rtol=5e-4)
    np.testing.assert_allclose(state.force, np.tile(forces, (16, 1)), rtol=5e-4)
    assert state.stiffness[2, 2] == pytest.approx(axial, rel=2e-3)
    assert state.stiffness[0, 0] == pytest.approx(radial, rel=2e-3)
    assert state.displacement[2] == pytest.approx(displacement, rel=1e-3)


def test_218_under_combined_load_with_its_tilt_held():
    state = BallBearing(**HARRIS_218).equilibrium((8900.0, 0.0, 17800.0))
    np.testing.assert_allclose(state.displacement[[2, 0]], [34.4e-6, 18.9e-6], rtol=2e-3)
    np.testing.assert_allclose([state.force.max(), state.force.min()], [3275.0, 356.0], rtol=2e-3)
    assert abs(state.load[4]) == pytest.approx(481.0, rel=2e-3)
    np.testing.assert_array_equal(state.load[:3], [8900.0, 0.0, 17800.0])


def test_friction_that_turns_the_axis_of_a_ball_pushes_it_outward_at_the_outer_race():
    """Change of the angular momentum of a ball that rolls in Cartesian coordinates, over a short time."""
    bearing = BallBearing(**HARRIS_218)
    state = bearing.equilibrium((0.0, 0.0, 17800.0), speed_rpm=10000.0, cage_angle=0.0)
    omega, angle = 10000.0 * pi / 30.0, state.contact_angles[0, 1]
    orbit = state.orbit[0] * omega
    D, mass = bearing.ball_diameter, bearing.density * pi / 6.0 * bearing.ball_diameter**3
    to_outer = 0.5 * D * np.array([cos(angle), 0.0, sin(angle)])
    # rolls on the outer ring, which stands still: no slip, no spin about the normal
    centre = orbit * np.array([0.0, 0.5 * bearing.pitch_diameter, 0.0])
    spin = np.cross(centre, to_outer) / (to_outer @ to_outer)
    np.testing.assert_allclose(centre + np.cross(spin, to_outer), 0.0, atol=1e-9 * np.linalg.norm(centre))
    np.testing.assert_allclose(np.linalg.norm(spin - [0.0, 0.0, orbit]), state.ball_rotation[0] * omega, rtol=0.01)
    short = 1e-7
    turned = np.array([spin[0] * cos(orbit * short), spin[0] * sin(orbit * short), spin[2]])
    torque = 0.1 * mass * D * D * (turned - spin) / short
    friction = np.array([sin(angle), 0.0, -cos(angle)])  # outward along the outer race
    assert np.cross(to_outer, friction) @ torque > 0.0
    # the forces of both contacts and of inertia balance with just this friction
    held = torque[1] / (0.5 * D)
    inner, outer = state.force[0]
    a = state.contact_angles[0, 0]
    along_shaft = inner * sin(a) - outer * sin(angle) + held * friction[2]
    outward = inner * cos(a) - outer * cos(angle) + held * friction[0] + mass * orbit**2 * 0.5 * 125.3e-3
    assert abs(along_shaft) < 1e-3 * held
    assert abs(outward) < 1e-3 * held


def test_axial_rigidity_of_preloaded_pairs():
    """Column of two independent models; the printed values are in whole N/um."""
    found, printed, computed = [], [], []
    for pitch, ball, balls, angle, preloads, rigidity, other in GMN:
        bearing = BallBearing(
            balls=balls,
            ball_diameter=1e-3 * ball,
            pitch_diameter=1e-3 * pitch,
            contact_angle=radians(angle),
            youngs_modulus=2.08e11,
        )
        pairs = [BearingSet.pair(bearing, preload=force).equilibrium((0.0, 0.0, 0.0)) for force in preloads]
        found.append([1e-6 * pair.stiffness[2, 2] for pair in pairs])
        printed.append(rigidity)
        computed.append(other)
    found, printed, computed = np.array(found), np.array(printed), np.array(computed)
    assert np.abs(found - computed).max() < 0.505  # these are whole numbers too
    assert abs(np.median(found / computed) - 1.0) < 2e-3
    np.testing.assert_allclose(np.median((found / printed)[::2], axis=0), [1.016, 0.979, 0.961], atol=3e-3)
    np.testing.assert_allclose(np.median((found / printed)[1::2], axis=0), [1.031, 1.029, 1.003], atol=3e-3)
    assert np.mean(np.abs(found / printed - 1.0) < 0.08) == pytest.approx(0.76, abs=0.005)


def test_orders_of_a_6205_with_clearance_and_axial_load():
    bearing = BallBearing(balls=9, ball_diameter=7.94e-3, pitch_diameter=39.04e-3, clearance=9.1e-6)
    assert degrees(bearing.free_angle) == pytest.approx(9.71, abs=5e-3)
    for axial, angle, bpfo, bpfi in (
        (5.0, 10.21, 3.5993, 5.4007),
        (15.0, 10.69, 3.6007, 5.3993),
        (30.0, 11.18, 3.6022, 5.3978),
        (60.0, 11.88, 3.6044, 5.3956),
    ):
        state = bearing.equilibrium((0.0, 0.0, axial))
        np.testing.assert_allclose(np.degrees(state.contact_angles), angle, atol=0.02)
        assert state.orders.bpfo_order == pytest.approx(bpfo, abs=1e-4)
        assert state.orders.bpfi_order == pytest.approx(bpfi, abs=1e-4)
        assert state.orders.bsf_order == pytest.approx(bearing.orders.bsf_order, rel=0.01)
    assert bearing.equilibrium((0.0, -1000.0)).orders is None


@pytest.mark.parametrize("name", ["7205 C", "7205", "7205 B"])
def test_spin_of_a_ball_at_a_contact_angle(name):
    """BSF = dm/(2 D) (1 - (D/dm cos a)^2); with control of a race a ball turns about an axis at b, and spins."""
    bearing = BallBearing.catalogue(name)
    ratio, a = bearing.ball_diameter / bearing.pitch_diameter, bearing.contact_angle
    by_hand = (1.0 - (ratio * np.cos(a)) ** 2) / (2.0 * ratio)
    assert bearing.orders.bsf_order == pytest.approx(by_hand, rel=1e-12)
    assert bearing.frequencies(3000.0).bsf == pytest.approx(50.0 * by_hand, rel=1e-12)
    for control, sign in (("outer", 1.0), ("inner", -1.0)):
        b = np.arctan2(np.sin(a), np.cos(a) + sign * ratio)
        state = BallBearing.catalogue(name, race_control=control).equilibrium((0.0, 0.0, 1.0))
        assert state.orders.bsf_order == pytest.approx(by_hand / np.cos(a - b), rel=3e-4)


@pytest.mark.parametrize("control", CONTROLS)
def test_balls_against_their_equations_written_out(control):
    """Four equations of a ball as in the books, by scipy's root."""
    bearing = BallBearing(**HARRIS_218, race_control=control)
    omega, D, dm = 10000.0 * pi / 30.0, bearing.ball_diameter, bearing.pitch_diameter
    state = bearing.equilibrium((1000.0, -700.0, 15000.0, 20.0, -10.0), speed_rpm=10000.0)
    mass = bearing.density * pi / 6.0 * D**3
    kn = [bearing.race(name).kn for name in ("inner", "outer")]
    grooves = bearing.tables.balls(10000.0).grooves
    torsion = grooves.inner_spin_moment, grooves.outer_spin_moment
    reach = (bearing.conformity_inner - 0.5) * D
    lever = 0.5 * dm + reach * cos(bearing.contact_angle)
    A, gamma = 2.0 * reach, D / dm
    x, y, z, tilt_x, tilt_y = state.displacement
    for k, psi in enumerate(state.angles.tolist()):
        far = A * cos(bearing.contact_angle) + x * cos(psi) + y * sin(psi)
        along = A * sin(bearing.contact_angle) + z + lever * (tilt_x * sin(psi) - tilt_y * cos(psi))

        def equations(v, far=far, along=along):
            r, s, di, do = v * np.array([1e-3, 1e-3, 1e-5, 1e-5])
            ai, ao = atan2(along - s, far - r), atan2(s, r)
            qi, qo = (k_n * abs(d) ** 1.5 * np.sign(d) for k_n, d in zip(kn, (di, do), strict=True))
            ratio = torsion[1] * do**2 / (torsion[0] * di**2)
            share = {"inner": 1.0 / (1.0 + (0.01 * ratio) ** 2), "shared": 1.0 / (1.0 + ratio)}.get(control, 0.0)
            by_o, by_i = sin(ao) / (cos(ao) + gamma), sin(ai) / (cos(ai) - gamma)
            beta = np.arctan((1.0 - share) * by_o + share * by_i)
            e_o = (cos(ao) + np.tan(beta) * sin(ao)) / (1.0 + gamma * cos(ao))
            e_i = (cos(ai) + np.tan(beta) * sin(ai)) / (1.0 - gamma * cos(ai))
            turn, orbit = omega / (gamma * np.cos(beta) * (e_o + e_i)), omega * e_o / (e_o + e_i)
            moment = 0.1 * mass * D * D * turn * orbit * np.sin(beta) * (-1.0 if control == "harris" else 1.0)
            fi, fo = 2.0 * share * moment / D, 2.0 * (1.0 - share) * moment / D
            return [
                (qi * sin(ai) - qo * sin(ao) + fi * cos(ai) - fo * cos(ao)) / 1e3,
                (qi * cos(ai) - qo * cos(ao) - fi * sin(ai) + fo * sin(ao) + mass * 0.5 * dm * orbit**2) / 1e3,
                (np.hypot(far - r, along - s) - reach - di) / 1e-5,
                (np.hypot(r, s) - reach - do) / 1e-5,
            ]

        length, at_outer = reach + state.approach[k, 1], state.contact_angles[k, 1] + 0.02
        first = [1e3 * length * cos(at_outer), 1e3 * length * sin(at_outer), 1.0, 1.0]
        solved = root(equations, first, method="lm", tol=1e-15)
        assert np.abs(equations(solved.x)).max() < 1e-8
        np.testing.assert_allclose(state.approach[k], solved.x[2:] * 1e-5, rtol=1e-8)


def ring(bearing, rpm, angle=0.3):
    return StaticRing(bearing.tables.balls(rpm), angle, 5, np.zeros(5))


def pressed(at, q):
    at.press(np.asarray(q, float))
    return at.load.copy(), at.stiffness.copy()


def tangent_error(bearing, rpm, q, h=(2e-9, 2e-9, 2e-9, 1e-7, 1e-7)):
    """Of the tangent against central differences of fourth order, over the roots of its diagonal."""
    at = ring(bearing, rpm)
    exact = pressed(at, q)[1]
    columns = []
    for j, step in enumerate(np.diag(h)):
        f = [pressed(at, np.asarray(q) + n * step)[0] for n in (-2, -1, 1, 2)]
        columns.append((f[0] - 8.0 * f[1] + 8.0 * f[2] - f[3]) / (12.0 * h[j]))
    size = np.sqrt(np.abs(np.diag(exact)))
    return float(np.abs((np.column_stack(columns) - exact) / np.outer(size, size)).max()), at


@pytest.mark.parametrize("control", CONTROLS)
def test_tangents_at_speed(control):
    error, at = tangent_error(
        BallBearing(**HARRIS_218, race_control=control), 10000.0, (20e-6, -10e-6, 20e-6, 1e-4, -2e-4)
    )
    assert error < 1e-6
    assert at.describe()[0]["load"][:, 0].min() > 50.0


@pytest.mark.parametrize("control", CONTROLS)
def test_tangents_where_balls_have_lifted_off(control):
    error, at = tangent_error(
        BallBearing(**SPINDLE, race_control=control), 18000.0, (30e-6, 5e-6, -50e-6, 5e-4, -5e-4)
    )
    carries = at.describe()[0]["load"][:, 0] > 0.0
    assert carries.sum() == 5
    assert error < 1e-6


def test_tangents_with_films():
    oil = Lubricant.iso_vg(68, temperature=70.0)
    for control in ("outer", "shared"):
        bearing = BallBearing(**SPINDLE, oil=oil, race_control=control)
        error, at = tangent_error(bearing, 12000.0, (5e-6, -3e-6, 2e-6, 1e-4, -1e-4))
        assert error < 1e-6
        assert np.ptp(at.describe()[0]["factor"]) > 0.01  # films at angles of their own


def test_stiffness_at_rest_is_symmetric():
    for bearing in (BallBearing(**HARRIS_218), BallBearing.catalogue("6205", clearance=1e-5)):
        K = bearing.equilibrium((900.0, -300.0, 800.0, 2.0, -3.0), cage_angle=0.2).stiffness
        assert np.abs(K - K.T).max() < 1e-9 * np.abs(K).max()
        assert np.linalg.eigvalsh(K).min() > 0.0


@pytest.mark.parametrize("oil", [None, Lubricant.iso_vg(68, temperature=50.0)])
@pytest.mark.parametrize("clearance", [8e-6, -4e-6])
def test_a_radial_load_is_carried_as_with_axial_motion_and_tilts_held(oil, clearance):
    """A seat of all five degrees of freedom has the forces of one that moves in x and y alone."""
    bearing = BallBearing.catalogue("6205", oil=oil, clearance=clearance)
    for force in ((0.0, -1000.0), (300.0, -500.0)):
        planar = bearing.equilibrium(force, speed_rpm=6000.0, cage_angle=0.3)
        whole = bearing.equilibrium((*force, 0.0), speed_rpm=6000.0, cage_angle=0.3)
        np.testing.assert_allclose(whole.displacement[:2], planar.displacement, rtol=1e-9)
        np.testing.assert_allclose(whole.force, planar.force, rtol=1e-9, atol=1e-9 * planar.force.max())
        at = StaticRing(bearing.tables.balls(6000.0), 0.3, 2, np.zeros(5))
        columns = []
        for step in 1e-9 * np.eye(2):
            ends = []
            for n in (-2, -1, 1, 2):
                at.press(planar.displacement + n * step)
                ends.append(at.load.copy())
            columns.append((ends[0] - 8.0 * ends[1] + 8.0 * ends[2] - ends[3]) / 12e-9)
        size = np.abs(planar.stiffness).max()
        np.testing.assert_allclose(np.column_stack(columns), planar.stiffness, rtol=0.0, atol=1e-6 * size)


def test_lifted_balls_are_held_by_the_outer_race_alone():
    bearing = BallBearing.catalogue("6205", clearance=12e-6)
    state = bearing.equilibrium((0.0, -300.0, 20.0), speed_rpm=15000.0)
    lifted = state.force[:, 0] == 0.0
    assert 2 <= lifted.sum() <= 6
    mass = bearing.density * pi / 6.0 * bearing.ball_diameter**3
    centrifugal = mass * 0.5 * bearing.pitch_diameter * (state.orbit * 15000.0 * pi / 30.0) ** 2
    np.testing.assert_allclose(state.force[lifted, 1], centrifugal[lifted], rtol=1e-9)
    np.testing.assert_allclose(state.contact_angles[lifted, 1], 0.0, atol=1e-9)


@pytest.mark.parametrize(
    "control", [*CONTROLS[:1], *(pytest.param(name, marks=pytest.mark.long) for name in CONTROLS[1:])]
)
def test_any_load_that_seats_a_bearing_is_found_without_a_guess(control):
    rng = np.random.default_rng(5)
    oil = Lubricant.iso_vg(68, temperature=50.0)
    bearings = (
        BallBearing(**SPINDLE, race_control=control),
        BallBearing.catalogue("6205", clearance=15e-6, oil=oil, race_control=control),
        BallBearing.catalogue("6205", clearance=-5e-6, race_control=control),
    )
    seated = 0
    for k in range(60):
        bearing = bearings[k % 3]
        force = np.append(10.0 ** rng.uniform(0.0, 3.0) * rng.normal(size=2), 10.0 ** rng.uniform(1.0, 3.0))
        moments = rng.normal(size=2)
        rpm = float(rng.choice([1000.0, 6000.0, 12000.0]))
        try:
            state = bearing.equilibrium((*force, *moments), speed_rpm=rpm)
        except InputError as error:
            assert error.field == "load"
            continue
        at = ring(bearing, rpm, state.cage_angle)
        found = pressed(at, state.displacement)[0]  # without the places that the search knew
        np.testing.assert_allclose(found, state.load, rtol=1e-9, atol=1e-8 * np.abs(state.load).max())
        seated += 1
    assert seated > 40


def test_tilt_of_a_misaligned_ring():
    bearing = BallBearing.catalogue("6205", clearance=10e-6)
    straight = bearing.equilibrium((0.0, -1000.0, 0.0))
    tilted = bearing.equilibrium((0.0, -1000.0, 0.0), tilt=(2e-3, 0.0))
    assert np.abs(straight.load[3:]).max() < 1e-9
    assert tilted.load[3] > 0.03  # it resists the tilt
    free = bearing.equilibrium((0.0, -1000.0, 0.0, *tilted.load[3:]))
    np.testing.assert_allclose(free.displacement, tilted.displacement, atol=1e-9)
    refused("tilt = .*left out unless", lambda: bearing.equilibrium((0.0, -1000.0), tilt=(1e-3, 0.0)))
    refused("tilt = .*rad", lambda: bearing.equilibrium((0.0, -1000.0, 0.0), tilt=(2.0, 0.0)))


def test_bad_input():
    sizes = {key: value for key, value in SPINDLE.items() if key != "contact_angle"}
    refused("contact_angle = 25.0: .*25 degrees are 0.4363 rad", lambda: BallBearing(**sizes, contact_angle=25.0))
    refused("contact_angle = 0.9: .*45 degrees", lambda: BallBearing(**sizes, contact_angle=0.9))
    refused("contact_angle = -0.1: must be above 0 .*facing=", lambda: BallBearing(**sizes, contact_angle=-0.1))
    refused("clearance = 1e-05: .*5.95e-05 m", lambda: BallBearing(**SPINDLE, clearance=1e-5))
    assert BallBearing(**SPINDLE, clearance=5.95e-5).free_angle == SPINDLE["contact_angle"]
    refused(
        "race_control = 'both': must be one of outer, inner", lambda: BallBearing(**SPINDLE, race_control="both")
    )
    bearing = BallBearing(**SPINDLE)
    refused("load = .*an angular contact bearing needs an axial load", lambda: bearing.equilibrium((0.0, -100.0)))
    refused("load = .*Fz > 0", lambda: bearing.equilibrium((0.0, -100.0, -50.0)))
    refused("load = .*more axial", lambda: bearing.equilibrium((0.0, -100.0, 2.0), tilt=(5e-3, 0.0)))
    refused("load = .*60 degrees", lambda: bearing.equilibrium((0.0, 0.0, 1000.0), tilt=(0.03, 0.0)))
    loose = BallBearing.catalogue("6205", clearance=1e-5)
    refused("load = .*nothing holds it in", lambda: loose.equilibrium((0.0, 0.0, 0.0)))


def test_free_angle_and_files(tmp_path):
    loose = BallBearing.catalogue("6205", clearance=1e-5)
    assert loose.free_angle == pytest.approx(acos(1.0 - 5e-6 / (0.04 * loose.ball_diameter)))
    assert BallBearing.catalogue("6205", clearance=-1e-5).free_angle == 0.0
    bearing = BallBearing(**SPINDLE, race_control="shared")
    assert read(save(bearing, tmp_path / "bearing.json"), BallBearing) == bearing
    state = bearing.equilibrium((50.0, 20.0, 300.0), speed_rpm=5000.0)
    back = read(save(state, tmp_path / "state.json"), BearingState)
    assert back.to_dict() == state.to_dict()
    assert "contact angle 25 degrees" in str(bearing)
    assert "300) N and (" in str(state) and "degrees" in str(state)
    assert f"spin up to {np.abs(state.spin_to_roll).max():.3g} of rolling" in str(state)
    names = state.to_xarray()["stiffness"]
    assert list(names["axis"].values) == ["x", "y", "z", "tilt_x", "tilt_y"]
    assert names.attrs["units"] == "N/m, N, N m"
    figure = state.plot(tmp_path / "state.png")
    assert [axes.get_ylabel() for axes in figure.axes][2:] == ["contact angle [degrees]", "spin over rolling"]
    assert "300 N axially" in figure.get_suptitle()


@pytest.mark.usefixtures("friction_follows")
def test_coefficients_are_the_tangent_at_rest_and_follow_the_films():
    oil = Lubricant.iso_vg(68, temperature=70.0)
    bearing, force = BallBearing(**SPINDLE, oil=oil), (300.0, -200.0, 900.0, 1.0, 0.5)
    state = bearing.equilibrium(force, speed_rpm=12000.0)
    still = bearing.coefficients(force, speed_rpm=12000.0, hz=0.0, cage_angle=state.cage_angle)
    size = np.sqrt(np.abs(np.outer(np.diag(state.stiffness), np.diag(state.stiffness))))
    assert np.abs((still.stiffness[0] - state.stiffness) / size).max() < 1e-6
    # mean over a ball passage: damping everywhere, and less of it at high frequencies
    means = bearing.coefficients(force, speed_rpm=12000.0, hz=[10.0, 20000.0])
    assert means.damping.shape == (2, 5, 5)
    assert np.all(np.linalg.eigvalsh(0.5 * (means.damping + means.damping.transpose(0, 2, 1))) > 0.0)
    assert np.all(np.diagonal(means.damping[1]) < 0.7 * np.diagonal(means.damping[0]))
    assert "tilt_y" in "".join(means.to_pandas().columns)
    assert means.to_control().noutputs == 5


def test_coefficients_with_axial_motion_held_are_those_of_the_planar_bearing():
    """A ring that is held has only the entries of the motions that it makes: x and y of both are the same."""
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0), loss_factor=0.02)
    for inertia in (False, True):
        balls = BallBearing.from_dict(bearing.to_dict() | {"ball_inertia": inertia})
        planar = balls.coefficients((0.0, -1000.0), speed_rpm=6000.0, hz=[5.0, 800.0])
        whole = balls.coefficients((0.0, -1000.0, 0.0), speed_rpm=6000.0, hz=[5.0, 800.0])
        for name in ("stiffness", "damping"):
            here, there = getattr(whole, name)[:, :2, :2], getattr(planar, name)
            np.testing.assert_allclose(here, there, atol=1e-9 * np.abs(there).max())


def test_gyroscopic_moments_that_no_friction_holds():
    bearing = BallBearing(**HARRIS_218, race_control="inner")
    refused(
        "load = .*friction holds the gyroscopic", lambda: bearing.equilibrium((0.0, 0.0, 200.0), speed_rpm=12000.0)
    )


def test_unloaded_balls_stand_at_any_angle():
    """Up to right angles, where there is no cone: they have the radii of the steepest angle of a groove."""
    bearing = BallBearing.catalogue("7205 B", oil=Lubricant.iso_vg(68, temperature=50.0))
    state = bearing.equilibrium((0.0, -900.0, 60.0), speed_rpm=3000.0)
    steep = state.contact_angles[:, 0] > STEEPEST
    assert degrees(state.contact_angles.max()) > 85.0 and steep.any()
    assert state.force[steep, 0].max() < 0.1 and np.isfinite(state.rolling_torque)
    own = bearing.race("inner").at_angle(bearing.pitch_diameter, 0.5 * pi, 0.04).geometry
    assert own == bearing.race("inner").at_angle(bearing.pitch_diameter, STEEPEST, 0.04).geometry
