"""Sets of bearings on one shaft against balances and closed forms written here."""

from collections import Counter
from dataclasses import replace
from math import atan, cos, pi, radians, sin

import numpy as np
import pytest
from balls_in_balance import imbalance, races_by_hand, random_bearing
from refusals import refused
from scipy.optimize import brentq, root

from ehlcontact import Lubricant, read, save
from ehlcontact.errors import InputError
from reduced_models import BallBearing, BearingSet, linearise
from reduced_models.bearing.set_result import SetState

SPINDLE = BallBearing(balls=13, ball_diameter=7.938e-3, pitch_diameter=38.5e-3, contact_angle=radians(25.0))
OTHER = BallBearing(balls=10, ball_diameter=9.5e-3, pitch_diameter=46e-3, contact_angle=radians(15.0))
OIL = Lubricant.iso_vg(68, temperature=70.0)


def axial_force(bearing, z):
    """Of a dry angular contact bearing at rest whose ring is pressed by z, from its groove centres and Hertz."""
    inner, outer = (race[0] for race in races_by_hand(bearing))
    A, angle = (
        (bearing.conformity_inner + bearing.conformity_outer - 1.0) * bearing.ball_diameter,
        bearing.contact_angle,
    )
    turned = atan((A * sin(angle) + z) / (A * cos(angle)))
    pressed = max(A * (cos(angle) / cos(turned) - 1.0), 0.0)
    return bearing.balls * (inner ** (-2.0 / 3.0) + outer ** (-2.0 / 3.0)) ** -1.5 * pressed**1.5 * sin(turned)


def pressed_by(bearing, force):
    return brentq(lambda z: axial_force(bearing, z) - force, 0.0, 1e-4, xtol=1e-18, rtol=1e-15)


def require_balance(found, state, given):
    """All balls, the rings and the shaft in balance, moments about 0 by vectors."""
    total = np.zeros(6)
    for bearing, facing, position, one in zip(
        found.bearings, found.facings, found.positions, state.bearings, strict=True
    ):
        if one.load.any():
            assert imbalance(bearing, one, one.load) < 1e-8
        else:
            assert not one.force[:, 0].any()
        sign = np.array([1.0, 1.0, 1.0 if facing == "+z" else -1.0])
        force = sign * one.load[:3]
        moment = np.append(one.load[3:] * sign[2], 0.0) + np.cross([0.0, 0.0, position], force)
        total += [*force, *moment]
    given = np.asarray(given)
    size = max(np.abs(given).max(), state.axial_forces.max())
    np.testing.assert_allclose(total[:5], state.load, atol=1e-9 * size)
    np.testing.assert_allclose(state.load[: given.size], given, atol=1e-9 * size)


@pytest.mark.parametrize("arrangement", ["back to back", "face to face"])
def test_unequal_pair_under_axial_load(arrangement):
    pair = BearingSet.pair(SPINDLE, arrangement, other=OTHER, preload=200.0)
    first, second = (SPINDLE, OTHER) if arrangement == "back to back" else (OTHER, SPINDLE)  # of "+z", of "-z"
    offsets = pressed_by(first, 200.0), pressed_by(second, 200.0)
    still = pair.equilibrium((0.0, 0.0, 0.0))
    np.testing.assert_allclose(still.axial_forces, 200.0, rtol=1e-9)
    for force in (150.0, -150.0):

        def left(z, force=force):
            return axial_force(first, offsets[0] + z) - axial_force(second, offsets[1] - z) - force

        z = brentq(left, -offsets[0], offsets[1], xtol=1e-18)
        state = pair.equilibrium((0.0, 0.0, force))
        assert state.displacement[2] == pytest.approx(z, rel=1e-8)
        own = [axial_force(first, offsets[0] + z), axial_force(second, offsets[1] - z)]
        np.testing.assert_allclose(
            state.axial_forces, own[:: 1 if arrangement == "back to back" else -1], rtol=1e-8
        )
    assert pair.lift_off("+z") == pytest.approx(axial_force(first, sum(offsets)), rel=1e-8)
    assert pair.lift_off("-z") == pytest.approx(axial_force(second, sum(offsets)), rel=1e-8)


def test_lift_off_of_equal_pairs_is_near_three_preloads():
    """2.83 with a constant contact angle; more, for the angle of the loaded bearing grows."""
    ratios = []
    for degrees in (15.0, 25.0, 40.0):
        bearing = replace(SPINDLE, contact_angle=radians(degrees))
        ratios += [BearingSet.pair(bearing, preload=force).lift_off("+z") / force for force in (1.0, 100.0, 900.0)]
    assert np.all(np.diff(np.reshape(ratios, (3, 3)), axis=1) > 0.0)  # with the preload
    np.testing.assert_allclose(np.reshape(ratios, (3, 3))[:, 0], 2.0 * np.sqrt(2.0), rtol=0.02)
    loose = BearingSet.pair(SPINDLE, preload=200.0, may_lift_off=True)
    most = loose.lift_off("+z")
    before, after = (loose.equilibrium((0.0, 0.0, share * most)).axial_forces for share in (0.9999, 1.0001))
    assert 0.0 < before[1] < 1e-4 * most
    np.testing.assert_allclose(after, [1.0001 * most, 0.0], rtol=1e-12)


@pytest.mark.parametrize(("arrangement", "sign"), [("back to back", 1.0), ("face to face", -1.0)])
def test_tilt_stiffness_is_that_of_the_arms(arrangement, sign):
    """Of a ball k along its normal and Q/l across it: one arm of each to the plane between the bearings."""
    distance, preload = 30e-3, 300.0
    state = BearingSet.pair(SPINDLE, arrangement, distance=distance, preload=preload).equilibrium((0.0, 0.0, 0.0))
    D, f, free = SPINDLE.ball_diameter, SPINDLE.conformity_inner, SPINDLE.contact_angle
    angle = float(state.bearings[0].contact_angles[0, 0])
    Q = preload / SPINDLE.balls / sin(angle)
    slopes = [1.5 * race[0] ** (2.0 / 3.0) * Q ** (1.0 / 3.0) for race in races_by_hand(SPINDLE)]
    k, radius = 1.0 / (1.0 / slopes[0] + 1.0 / slopes[1]), 0.5 * SPINDLE.pitch_diameter + (f - 0.5) * D * cos(free)
    length = 2.0 * (f - 0.5) * D * cos(free) / cos(angle)
    arm = radius * sin(angle) + sign * 0.5 * distance * cos(angle)
    across = radius * cos(angle) - sign * 0.5 * distance * sin(angle)
    wanted = 2.0 * 0.5 * SPINDLE.balls * (k * arm**2 + Q / length * across**2)
    np.testing.assert_allclose(np.diag(state.stiffness)[3:], wanted, rtol=1e-8)
    assert state.stiffness[3, 3] == pytest.approx(wanted, rel=1e-8)


def test_bearings_in_tandem_carry_equal_shares():
    force, kwargs = np.array([60.0, -20.0, 900.0]), {"speed_rpm": 9000.0, "cage_angle": 0.2}
    places = [-1e-12, 0.0, 1e-12]  # next to one place, where all have the same motion
    tandem = BearingSet(bearings=[SPINDLE] * 3, facings=["+z"] * 3, positions=places)
    single = SPINDLE.equilibrium((*force / 3.0, 0.0, 0.0), **kwargs)
    state = tandem.equilibrium((*force, 0.0, 0.0), **kwargs)
    np.testing.assert_allclose(state.displacement, single.displacement, rtol=1e-8)
    np.testing.assert_allclose(state.stiffness, 3.0 * single.stiffness, rtol=1e-8, atol=1e-3)
    wet = replace(SPINDLE, oil=OIL)
    frequencies = {**kwargs, "hz": [0.0, 300.0]}
    for given in (tuple(force), (*force, 0.3, 0.2)):
        one = wet.coefficients(tuple(np.array(given) / 3.0), **frequencies)
        all_three = replace(tandem, bearings=(wet,) * 3).coefficients(given, **frequencies)
        for name in ("stiffness", "damping"):
            three = 3.0 * getattr(one, name)
            np.testing.assert_allclose(getattr(all_three, name), three, atol=1e-9 * np.abs(three).max())


def test_three_bearings_preloaded_by_one():
    """Two in tandem against one: each of the two bears half the preload."""
    rows = {"facings": ("+z", "+z", "-z"), "positions": (-14e-3, 0.0, 14e-3)}
    state = BearingSet(bearings=[SPINDLE] * 3, **rows).preloaded(300.0).equilibrium((0.0, 0.0, 0.0))
    np.testing.assert_allclose(state.axial_forces, [150.0, 150.0, 300.0], rtol=1e-9)


def test_loads_of_all_bearings_balance_that_of_the_shaft():
    wet, other = replace(SPINDLE, oil=OIL), replace(OTHER, oil=OIL, race_control="shared")
    given = (120.0, -300.0, 80.0, 1.5, -0.8)
    for found, rpm in (
        (BearingSet.pair(SPINDLE, other=OTHER, preload=250.0, distance=20e-3), 0.0),
        (BearingSet.pair(SPINDLE, "face to face", other=OTHER, preload=250.0, distance=60e-3), 15000.0),
        (BearingSet.pair(wet, other=other, offset=12e-6), 8000.0),
        (BearingSet.pair(SPINDLE, spring=250.0, distance=0.1), 12000.0),
        (BearingSet.pair(wet, "face to face", other=other, spring=300.0, distance=0.1), 8000.0),
    ):
        for force in (given, given[:3], given[:2]):
            require_balance(found, found.equilibrium(force, speed_rpm=rpm, cage_angle=0.3), force)
        tilted = found.equilibrium(given[:3], speed_rpm=rpm, tilt=(2e-4, -1e-4))
        np.testing.assert_array_equal(tilted.displacement[3:], [2e-4, -1e-4])
        require_balance(found, tilted, given[:3])


def moves_of_rings(found):
    """Rows by which the shaft and outer rings on a spring move each ring in its own frame, shape (5, 6) each."""
    rows = []
    for facing, position in zip(found.facings, found.positions, strict=True):
        sign = 1.0 if facing == "+z" else -1.0
        move = np.zeros((5, 6))
        move[:, :5] = np.diag([1.0, 1.0, sign, sign, sign])
        move[0, 4], move[1, 3] = position, -position
        move[2, 5] = float(facing == found.sprung)
        rows.append(move)
    return rows


@pytest.mark.parametrize("rpm", [0.0, pytest.param(12000.0, marks=pytest.mark.long)])
def test_three_unequal_bearings_on_a_spring_against_their_compliances(rpm):
    """Loads of bearings and place of the shaft by scipy: each bearing is displaced by its load as it is alone."""
    third = replace(SPINDLE, balls=11, contact_angle=radians(20.0))
    found = BearingSet(
        bearings=(SPINDLE, OTHER, third),
        facings=("+z", "+z", "-z"),
        positions=(-0.02, 0.01, 0.05),
        offsets=(3e-6, -2e-6, 0.0),
        spring=300.0,
    )
    given, under = np.array([80.0, -150.0, 60.0, 1.2, -0.6]), {"speed_rpm": rpm, "cage_angle": 0.4}
    rows, loads = moves_of_rings(found), np.array([1.0, 1.0, 1.0, 0.02, 0.02])
    lengths = np.array([1e-6, 1e-6, 1e-6, 5e-5, 5e-5])

    def forces_of(unknowns):
        """Of the bearings; logarithms of axial forces are unknown, for an angular contact bearing has them > 0."""
        own = unknowns[:15].reshape(3, 5).copy()
        own[:, 2] = np.exp(own[:, 2])
        return 100.0 * own * loads

    def left(unknowns):
        """Imbalance of the shaft and of the spring, and displacements that do not fit, over their sizes."""
        forces, q = forces_of(unknowns), unknowns[15:] * [*lengths, 1e-6]
        balance, apart = -np.append(given, 300.0), []
        for bearing, move, offset, force in zip(found.bearings, rows, found.offsets, forces, strict=True):
            balance += move.T @ force
            ring = move @ q + [0.0, 0.0, offset, 0.0, 0.0]
            apart.append((bearing.equilibrium(force, **under).displacement - ring) / lengths)
        return np.concatenate([balance / (100.0 * np.append(loads, 1.0)), *apart])

    first = np.array([0.3, -0.5, 0.5, 0.0, 0.0] * 2 + [0.2, -0.5, 1.0, 0.0, 0.0] + [0.0, 0.0, 3.0, 0.0, 0.0, 1.0])
    solved = root(left, first, tol=1e-12)
    state = found.equilibrium(given, **under)
    assert np.abs(left(solved.x)).max() < 1e-8
    np.testing.assert_allclose(state.displacement / lengths, solved.x[15:20], atol=1e-7)
    np.testing.assert_allclose([one.load for one in state.bearings], forces_of(solved.x), atol=1e-5)


@pytest.mark.parametrize("kind", ["preload", "spring"])
def test_a_set_is_a_rigid_rotor(kind):
    """Statics and impedance of the rotor that a set gives are those of the set."""
    wet, other = replace(SPINDLE, oil=OIL), replace(OTHER, oil=OIL)
    pair = BearingSet.pair(wet, other=other, distance=30e-3, **{kind: 250.0})
    given, rpm, w = (60.0, -200.0, 80.0, 1.0, -0.5), 9000.0, 2.0 * pi * np.array([50.0, 500.0])
    rotor = pair.rotor(given, mass=2.0 * np.eye(5 + (kind == "spring")), cage_angle=0.3)
    state = pair.equilibrium(given, speed_rpm=rpm, cage_angle=0.3)
    shaft = list(rotor.nodes["shaft"].values())
    np.testing.assert_allclose(rotor.equilibrium(rpm)[shaft], state.displacement, rtol=1e-9)
    linear = linearise(rotor, rpm, passage=False)
    Z = np.array([linear.support_impedance(1j * one) for one in w])
    if kind == "spring":
        Z = np.linalg.inv(np.linalg.inv(Z)[:, :5, :5])  # no force on the outer ring
    small = pair.coefficients(given, speed_rpm=rpm, cage_angle=0.3, omega=w)
    for wanted, part in ((small.stiffness, Z.real), (small.damping, Z.imag / w[:, None, None])):
        np.testing.assert_allclose(part, wanted, atol=1e-9 * np.abs(wanted).max())
    assert linear.stable


def test_spring_keeps_its_force():
    rigid, sprung = BearingSet.pair(SPINDLE, preload=200.0), BearingSet.pair(SPINDLE, spring=200.0)
    still = sprung.equilibrium((0.0, 0.0, 0.0))
    np.testing.assert_allclose(still.axial_forces, 200.0, rtol=1e-12)
    both = rigid.equilibrium((0.0, 0.0, 0.0))
    # the bearing on the spring adds no axial stiffness, but all of its radial one
    assert still.stiffness[2, 2] == pytest.approx(0.5 * both.stiffness[2, 2], rel=1e-9)
    np.testing.assert_allclose(
        np.diag(still.stiffness)[[0, 1, 3, 4]], np.diag(both.stiffness)[[0, 1, 3, 4]], rtol=1e-7
    )
    for force in (150.0, -150.0):
        state = sprung.equilibrium((0.0, 0.0, force))
        np.testing.assert_allclose(state.axial_forces, [200.0 + force, 200.0], rtol=1e-10)
        own = SPINDLE.equilibrium((0.0, 0.0, 200.0 + force)).stiffness[2, 2]
        assert state.stiffness[2, 2] == pytest.approx(own, rel=1e-9)
    assert sprung.lift_off("-z") == pytest.approx(200.0, rel=1e-12)
    assert sprung.lift_off("+z") == np.inf
    # centrifugal force changes a preload by offsets, not that of a spring
    at_speed = {"speed_rpm": 20000.0}
    assert rigid.equilibrium((0.0, 0.0, 0.0), **at_speed).axial_forces[0] > 250.0
    np.testing.assert_allclose(sprung.equilibrium((0.0, 0.0, 0.0), **at_speed).axial_forces, 200.0, rtol=1e-10)


@pytest.mark.parametrize(("arrangement", "sign"), [("back to back", -1.0), ("face to face", 1.0)])
def test_growth_of_the_shaft(arrangement, sign):
    pair = BearingSet.pair(SPINDLE, arrangement, preload=200.0, distance=50e-3)
    offset = pressed_by(SPINDLE, 200.0)
    for growth in (4e-6, -4e-6):
        wanted = axial_force(SPINDLE, offset + 0.5 * sign * growth)
        found = pair.grown(growth).equilibrium((0.0, 0.0, 0.0)).axial_forces
        np.testing.assert_allclose(found, wanted, rtol=1e-8)
    word = "below" if sign < 0.0 else "above"
    lost = f"{-sign * 2.0 * offset:.4g}".replace("+", r"\+")
    refused(
        f"growth = .*{word} {lost} m, where the set has lost its preload",
        lambda: pair.grown(-sign * 2.01 * offset),
    )
    assert pair.grown(-sign * 1.99 * offset).equilibrium((0.0, 0.0, 0.0)).axial_forces[0] > 0.0
    on_spring = BearingSet.pair(SPINDLE, arrangement, spring=200.0, distance=50e-3).grown(1e-5)
    np.testing.assert_allclose(on_spring.equilibrium((0.0, 0.0, 0.0)).axial_forces, 200.0, rtol=1e-10)


def test_table_of_pairs_in_the_documentation():
    rows = {
        15.0: (
            (100, 43.1, 21.5, 3.23, 41.9, 1.3, 208),
            (300, 72.0, 36.0, 3.57, 62.7, 2.0, 375),
            (600, 103.1, 51.5, 3.86, 81.7, 2.9, 652),
        ),
        25.0: (
            (150, 99.0, 49.5, 2.97, 59.6, 1.2, 435),
            (450, 151.8, 75.9, 3.10, 87.5, 2.7, 648),
            (900, 203.1, 101.6, 3.22, 112.4, 4.9, 1024),
        ),
    }
    in_oil = {15.0: (325, 562, 904), 25.0: (590, 899, 1374)}
    for degrees, columns in rows.items():
        bearing = replace(SPINDLE, contact_angle=radians(degrees), youngs_modulus=2.08e11)
        wet = replace(bearing, oil=OIL)
        for (force, *wanted), films in zip(columns, in_oil[degrees], strict=True):
            diverging, converging = (
                BearingSet.pair(bearing, one, preload=force, distance=15e-3)
                for one in ("back to back", "face to face")
            )
            still, other = (one.equilibrium((0.0, 0.0, 0.0)) for one in (diverging, converging))
            spring = BearingSet.pair(bearing, spring=force).equilibrium((0.0, 0.0, 0.0))
            turning, flooded = (
                BearingSet.pair(one, preload=force).equilibrium((0.0, 0.0, 0.0), speed_rpm=20000.0).axial_forces[0]
                for one in (bearing, wet)
            )
            found = [1e-6 * still.stiffness[2, 2], 1e-6 * spring.stiffness[2, 2], diverging.lift_off("+z") / force]
            found += [1e-3 * still.stiffness[3, 3], 1e-3 * other.stiffness[3, 3], turning, flooded]
            digits = [1, 1, 2, 1, 1, 0, 0]
            assert [round(float(one), n) for one, n in zip(found, digits, strict=True)] == [*wanted, films]


def compliance_error(found, given, rpm):
    """Of the inverse stiffness against displacements under changed loads, differences of fourth order."""
    kwargs = {"speed_rpm": rpm, "cage_angle": 0.2}
    state = found.equilibrium(given, **kwargs)
    exact, size = np.linalg.inv(state.stiffness), np.array([1.0, 1.0, 1.0, 0.02, 0.02])
    columns = []
    for j, step in enumerate(np.diag(0.02 * size)):
        moved = [found.equilibrium(np.array(given) + n * step, **kwargs).displacement for n in (-2, -1, 1, 2)]
        columns.append((moved[0] - 8.0 * moved[1] + 8.0 * moved[2] - moved[3]) / (12.0 * step[j]))
    scale = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    return np.abs((np.column_stack(columns) - exact) / scale).max(), state


@pytest.mark.parametrize("rpm", [0.0, pytest.param(15000.0, marks=pytest.mark.long)])
def test_tangents_of_sets(rpm):
    """With balls that have lifted off too."""
    sizes = {"other": OTHER, "distance": 20e-3}
    for found, radial, lifted in (
        (BearingSet.pair(SPINDLE, preload=250.0, **sizes), -300.0, False),
        (BearingSet.pair(SPINDLE, preload=80.0, **sizes), -5000.0, True),
        (BearingSet.pair(SPINDLE, spring=250.0, **sizes), -300.0, False),
        (BearingSet.pair(SPINDLE, spring=250.0, **sizes), -3000.0, True),
    ):
        error, state = compliance_error(found, (120.0, radial, 80.0, 1.5, -0.8), rpm)
        assert error < 1e-6
        assert any(np.any(one.force[:, 0] == 0.0) for one in state.bearings) == lifted
        scale = np.sqrt(np.abs(np.outer(np.diag(state.stiffness), np.diag(state.stiffness))))
        skew = np.abs((state.stiffness - state.stiffness.T) / scale).max()
        assert skew < 1e-9 if rpm == 0.0 else skew > 1e-6


@pytest.mark.usefixtures("friction_follows")
def test_coefficients_of_a_pair_are_those_of_its_bearings():
    wet = replace(SPINDLE, oil=OIL, loss_factor=0.01)
    given, kwargs = (100.0, -300.0, 80.0, 1.0, 0.5), {"speed_rpm": 12000.0, "cage_angle": 0.1}
    for found in (BearingSet.pair(wet, preload=250.0, distance=30e-3), BearingSet.pair(wet, spring=250.0)):
        state = found.equilibrium(given, **kwargs)
        K, C = np.zeros((6, 6)), np.zeros((6, 6))
        w = 2.0 * pi * 200.0
        for one, moves in zip(state.bearings, moves_of_rings(found), strict=True):
            own = wet.coefficients(one.load, **kwargs, hz=200.0)
            K += moves.T @ own.stiffness[0] @ moves
            C += moves.T @ own.damping[0] @ moves
        Z = K + 1j * w * C
        if found.sprung:
            Z = np.linalg.inv(np.linalg.inv(Z)[:5, :5])  # no force on the sixth
        coefficients = found.coefficients(given, **kwargs, hz=[0.0, 200.0])
        Z = Z[:5, :5]
        np.testing.assert_allclose(coefficients.stiffness[1], Z.real, atol=1e-7 * np.abs(Z).max())
        np.testing.assert_allclose(coefficients.damping[1], Z.imag / w, atol=1e-7 * np.abs(Z.imag).max() / w)
        quiet = replace(found, bearings=[replace(wet, loss_factor=0.0)] * 2)
        static = quiet.coefficients(given, **kwargs, hz=0.0).stiffness[0]
        np.testing.assert_allclose(static, state.stiffness, atol=1e-6 * np.abs(static).max())
        means = found.coefficients(given, speed_rpm=12000.0, hz=50.0)
        assert means.peak_to_peak[1] > 0.0 and means.cage_angle is None


def answers(seed, cases):
    """Random sets under random loads: how many answers, and refusals by their reason; every answer balances."""
    rng, found = np.random.default_rng(seed), Counter()
    for _ in range(cases):
        try:
            bearings = [BallBearing(**random_bearing(rng)) for _ in range(2)]
            if rng.random() < 0.5:
                bearings[1] = bearings[0]
            size = 1e6 * min(one.ball_diameter for one in bearings) ** 2 * 10.0 ** rng.uniform(0.0, 1.7)
            kind = str(rng.choice(["preload", "spring"]))
            arrangement = str(rng.choice(["back to back", "face to face"]))
            distance = 0.03 * 10.0 ** rng.uniform(-1.0, 1.0)
            options = {"other": bearings[1], "distance": distance, "may_lift_off": bool(rng.random() < 0.5)}
            one = BearingSet.pair(bearings[0], arrangement, **options, **{kind: size})
            scale = size * 10.0 ** rng.uniform(-2.0, 0.7)
            given = scale * rng.normal(size=5) * [1.0, 1.0, 0.5, 0.3 * distance, 0.3 * distance]
            given = given[: int(rng.choice([2, 3, 5]))]
            rpm = (
                0.0 if rng.random() < 0.3 else 1.2e3 / bearings[0].pitch_diameter * 10.0 ** rng.uniform(-2.0, 0.0)
            )
            state = one.equilibrium(given, speed_rpm=rpm)
        except InputError as error:
            found[" ".join(error.allowed.split()[:6])] += 1
        else:
            require_balance(one, state, given)
            found["balanced"] += 1
    return found


@pytest.mark.long
def test_random_sets():
    assert answers(1, 30)["balanced"] >= 20


@pytest.mark.slow
def test_many_random_sets():
    found = answers(2, 1000)
    assert found["balanced"] > 700, found


def test_files_and_tables(tmp_path):
    pair = BearingSet.pair(replace(SPINDLE, oil=OIL), other=OTHER, spring=200.0, name="motor")
    assert read(save(pair, tmp_path / "set.json"), BearingSet) == pair
    state = BearingSet.pair(replace(SPINDLE, oil=OIL), preload=200.0).equilibrium(
        (0.0, -50.0, 30.0), speed_rpm=6000.0
    )
    back = read(save(state, tmp_path / "state.h5"), SetState)
    assert back.to_dict() == state.to_dict()
    assert "facing +z, -z" in str(pair) and "spring of 200 N on those facing -z" in str(pair)
    assert "axial stiffness" in str(state) and "smallest film" in str(state)
    assert list(state.to_pandas()["axial_forces [N]"]) == state.axial_forces.tolist()
    assert len(state.plot(tmp_path / "set.png").axes) == 4
    assert pair.highest_speed == pair.bearings[0].highest_speed < np.inf


def test_bad_input():
    pair = BearingSet.pair
    refused("arrangement = 'O': must be one of back to back", lambda: pair(SPINDLE, "O"))
    refused("preload = 100.0: .*tandem do not press", lambda: pair(SPINDLE, "tandem", preload=100.0))
    refused(
        "preload and spring = .*preload or spring, not together",
        lambda: pair(SPINDLE, preload=100.0, spring=100.0),
    )
    refused("preload = -5.0: must be 0, or between 1e-06 and 1e[+]08 N", lambda: pair(SPINDLE, preload=-5.0))
    refused("preload = 1000000.0: must be one whose contact angles stay", lambda: pair(SPINDLE, preload=1e6))
    refused(r"offset.* = .*in µm\? then", lambda: pair(SPINDLE, offset=10.0))
    refused("bearing = '7205': must be a BallBearing", lambda: pair("7205"))
    same = {"bearings": [SPINDLE] * 2, "positions": (0.0, 0.02)}
    one_way = BearingSet(**same, facings=("+z", "+z"))
    refused(r"preload = 100.0: .*all bearings face \+z", lambda: one_way.preloaded(100.0))
    refused("facings = '1 of them': must be one for each of 2", lambda: BearingSet(**same, facings=("+z",)))
    refused(r"facing = 'z': must be one of \+z, -z", lambda: BearingSet(**same, facings=("+z", "z")))
    refused("number of bearings = 1", lambda: BearingSet(bearings=[SPINDLE], facings=["+z"], positions=[0.0]))
    refused(
        r"positions\[1\] = 20.0: .*in mm",
        lambda: BearingSet(bearings=[SPINDLE] * 2, facings=("+z", "-z"), positions=(0.0, 20.0)),
    )
    refused("sprung = '-z': .*not of all", lambda: BearingSet(**same, facings=("-z", "-z"), spring=10.0))
    refused(
        r"offsets\[1\] = 1e-06: .*on the spring",
        lambda: BearingSet(**same, facings=("+z", "-z"), offsets=(0.0, 1e-6), spring=10.0),
    )
    # axial loads that nothing carries
    for force in (-50.0, 0.0):
        refused(
            r"Fz above 0 N: no bearing carries axial load in -z",
            lambda f=force: one_way.equilibrium((9.0, 0.0, f)),
        )
    refused(
        "Fz above -200 N: the spring carries 200 N in -z",
        lambda: pair(SPINDLE, spring=200.0).equilibrium((0, 0, -250.0)),
    )
    # loads that unload one of a preloaded pair, and those that nothing holds
    preloaded = pair(SPINDLE, preload=200.0)
    refused(
        r"leaves no bearing of the preloaded set unloaded, here bearing 1: .*from 598.8 N in \+z on",
        lambda: preloaded.equilibrium((0.0, 0.0, 700.0)),
    )
    loose = pair(SPINDLE, offset=-1e-6)
    refused("nothing holds it in", lambda: loose.equilibrium((0.0, 0.0, 0.0)))
    assert loose.lift_off("+z") == 0.0
    at_one_place = {"bearings": [SPINDLE] * 2, "facings": ("+z", "-z"), "positions": (0.0, 0.0)}
    refused("positions = .*: must be different places", lambda: BearingSet(**at_one_place))
    wet = pair(replace(SPINDLE, oil=OIL), preload=200.0)
    refused("speed_rpm = 0.0: must be > 0", lambda: wet.equilibrium((0.0, 0.0, 0.0)))
    refused("speed_rpm = .*where the atlas ends", lambda: wet.equilibrium((0.0, 0.0, 0.0), speed_rpm=1e6))
    refused("a ball carries at most .* in bearing 0", lambda: wet.equilibrium((0.0, 0.0, 1e5), speed_rpm=6000.0))
    refused("tilt = .*rad", lambda: preloaded.equilibrium((0.0, 0.0, 0.0), tilt=(2.0, 0.0)))


def test_a_set_whose_preload_is_used_up_says_so(oil):
    pair = BearingSet.pair(BallBearing.catalogue("7205", oil=oil), "back to back", preload=300.0)
    unloads = pair.dry.lift_off("+z")
    for load, words in ((0.7 * unloads, ""), (1.3 * unloads, "has no preload left: only films")):
        state = pair.equilibrium((0.0, 0.0, load), speed_rpm=3000.0)
        assert words in state.reservation and bool(words) == bool(state.reservation)
        assert bool(words) == ("no preload left" in str(state))
