"""Rotors with axial motion and tilts: equilibrium and modes against springs between groove centres in space."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
from axial_rotors import ACROSS, ARM, LIGHT, MASS, SPINDLE, motor, pair_force, pair_stiffness, rigid, ring_force
from scipy.linalg import eig

from ehlcontact import InputError, Lubricant
from reduced_models import (
    BallBearing,
    BearingMount,
    BearingSet,
    Disc,
    LinearBearing,
    Rotor,
    Shaft,
    Support,
    campbell,
    linearise,
    rotor_on_bearings,
    simulate_rotor,
    unbalance_response,
)
from reduced_models.rotor.equilibrium import static_supports


@pytest.mark.parametrize("apart", [False, True], ids=["back to back", "face to face"])
@pytest.mark.parametrize("rpm", [0.0, 20000.0])
def test_modes_of_a_rigid_rotor_on_a_preloaded_pair(apart, rpm):
    other = replace(LIGHT, contact_angle=radians(15.0), balls=11)
    load = np.array([40.0, -90.0, 120.0, 0.3, -0.2])
    rotor = rigid(LIGHT, other, load=load, apart=apart)
    q = rotor.equilibrium(rpm)
    np.testing.assert_allclose(pair_force(rotor, q), load, rtol=1e-7, atol=1e-7)
    K, omega = pair_stiffness(rotor, q), rpm * pi / 30.0
    lin = linearise(rotor, rpm, passage=False)
    found = lin.support_impedance(1.0).real
    np.testing.assert_allclose(found, K, atol=1e-7 * np.abs(K).max())
    scale = np.sqrt(np.outer(np.diag(found), np.diag(found)))
    assert np.abs((found - found.T) / scale).max() < 1e-9
    A = np.block([[np.zeros((5, 5)), np.eye(5)], [-np.linalg.solve(rotor.mass, K), np.zeros((5, 5))]])
    A[5:, 5:] = -omega * np.linalg.solve(rotor.mass, rotor.gyroscopic)
    values = eig(A, right=False)
    exact = np.sort(values.imag[values.imag > 0.0])
    np.testing.assert_allclose([mode.omega for mode in lin.modes(None)], exact, rtol=1e-6)


def test_six_modes_with_a_spring_that_preloads():
    """An outer ring that is free along the shaft is the sixth degree of freedom."""
    places = {"x": 0, "y": 1, "z": 2, "tilt_x": 3, "tilt_y": 4}
    mass, spring, preload = 0.1, 4e5, 250.0
    rotor = Rotor(
        mass=np.diag([MASS, MASS, MASS, ACROSS, ACROSS, mass]),
        stiffness=np.diag([0.0] * 5 + [spring]),
        load=np.array([0.0, -30.0, 0.0, 0.0, 0.0, preload]),
        mounts=(
            BearingMount(bearing=LIGHT, arm=-ARM, facing="+z", **places),
            BearingMount(bearing=LIGHT, arm=ARM, facing="-z", housing=(None, None, 5), **places),
        ),
    )
    q = rotor.equilibrium()

    def forces(q):
        first = ring_force(LIGHT, "+z", -ARM, 0.0, q[:5])
        second = ring_force(LIGHT, "-z", ARM, 0.0, q[:5] - q[5] * np.eye(5)[2])
        return np.append(first + second, spring * q[5] - second[2])

    np.testing.assert_allclose(forces(q), rotor.load, atol=1e-7)
    step = 1e-30
    K = np.array([forces(q + 1j * step * e).imag / step for e in np.eye(6)]).T
    exact = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(rotor.mass, K)).real))
    modes = linearise(rotor, 0.0, passage=False).modes(None)
    np.testing.assert_allclose([mode.omega for mode in modes], exact, rtol=1e-6)


def test_bearings_of_a_rotor_are_single_bearings_under_their_loads():
    """At speed, with heavy balls and films: loads of a rotor's bearings put each alone where it stands."""
    oil = Lubricant.iso_vg(46, temperature=70.0)
    bearing = BallBearing(**SPINDLE, oil=oil)
    rotor = rigid(bearing, bearing, load=np.array([60.0, -80.0, 100.0, 0.0, 0.0]))
    rpm = 12000.0
    q, lin = rotor.equilibrium(rpm), linearise(rotor, rpm, passage=False)
    for mount, load in zip(rotor.mounts, lin.loads, strict=True):
        alone = bearing.equilibrium(load, speed_rpm=rpm, cage_angle=mount.cage_angle)
        np.testing.assert_allclose(mount.rows(5) @ q + mount.shift, alone.displacement, rtol=1e-6, atol=1e-12)
    total = sum(mount.rows(5).T @ load for mount, load in zip(rotor.mounts, lin.loads, strict=True))
    np.testing.assert_allclose(total, rotor.load, atol=1e-6)
    mean = linearise(rotor, rpm)
    K, C = np.zeros((2, 5, 5))
    for mount, load in zip(rotor.mounts, mean.loads, strict=True):
        at = bearing.coefficients(load, speed_rpm=rpm, hz=200.0)
        K += mount.rows(5).T @ at.stiffness[0] @ mount.rows(5)
        C += mount.rows(5).T @ at.damping[0] @ mount.rows(5)
    Z, omega = mean.support_impedance(2j * pi * 200.0), 2.0 * pi * 200.0
    np.testing.assert_allclose(Z.real, K, atol=1e-7 * np.abs(K).max())
    np.testing.assert_allclose(Z.imag / omega, C, atol=1e-7 * np.abs(C).max())
    assert mean.stable and all(mode.decrement > 0.0 for mode in mean.modes(None))


def test_a_spring_presses_both_bearings_of_a_motor():
    bearing = BallBearing.catalogue("6305", clearance="CN", oil=Lubricant.iso_vg(46, temperature=70.0))
    rotor = motor(bearing, preload=200.0)
    lin = linearise(rotor, 12000.0)
    np.testing.assert_allclose(lin.loads[:, 2], 200.0, rtol=1e-7)
    weight = -9.81 * sum(rotor.mass[rotor.nodes["shaft"]["z"]])
    np.testing.assert_allclose(lin.loads[:, 1].sum(), weight, rtol=1e-7)
    modes = lin.modes(6)
    axial = [m for m in modes if abs(m.shape[rotor.nodes["shaft"]["z"]]) > 0.5]
    assert len(axial) == 1 and 0.001 < axial[0].decrement < 0.1
    diagram = campbell(rotor, [6000.0, 12000.0], count=4)
    assert diagram.hz.shape == (2, 4)
    response = unbalance_response(rotor, [11000.0, 12000.0])
    assert 0.0 < response.major.min()
    stiff = linearise(motor(bearing, preload=200.0, preload_stiffness=1e6), 12000.0)
    travel = rotor.equilibrium(12000.0)[rotor.nodes["outer ring 1"]["z"]]
    assert stiff.loads[0, 2] < 200.0 - 0.5e6 * abs(travel)  # its ring gives way, and the spring relaxes


def test_growth_of_the_shaft_is_an_offset():
    bearing = BallBearing(**SPINDLE)
    cold, grown = (linearise(motor(bearing, offset=offset), 0.0) for offset in (5e-6, 15e-6))
    assert grown.loads[0, 2] > 2.0 * cold.loads[0, 2] > 0.0
    np.testing.assert_allclose(grown.loads[0, 2], grown.loads[1, 2], rtol=1e-6)
    # half of the offset goes to either bearing
    alone = bearing.equilibrium(grown.loads[0]).displacement[2]
    np.testing.assert_allclose(alone, 7.5e-6, rtol=2e-3)


def test_without_preload_balls_above_are_off_their_races():
    """Clearance, weight and no axial load."""
    bearing = BallBearing.catalogue("6305", clearance="CN")
    rotor = motor(bearing, preload=0.0)
    with pytest.raises(InputError, match="without hold at bearing"):
        linearise(rotor, 0.0, passage=False)  # a single ball below carries the weight
    rotor = replace(rotor, load=40.0 * rotor.load)
    lin = linearise(rotor, 0.0, passage=False)
    np.testing.assert_allclose(lin.loads[:, 2], 0.0, atol=1e-6)
    weight = -40.0 * 9.81 * rotor.mass[(rotor.nodes["shaft"]["z"],) * 2]
    np.testing.assert_allclose(lin.loads[:, 1].sum(), weight, rtol=1e-7)
    alone = bearing.equilibrium(lin.loads[0, :2])
    q = rotor.mounts[0].rows(rotor.size) @ lin.rest
    np.testing.assert_allclose(q[1], alone.displacement[1], rtol=1e-3)


def test_an_upright_rotor_hangs_on_one_bearing():
    bearing = BallBearing(**SPINDLE)
    rotor = rotor_on_bearings(
        Shaft(length=0.2, diameter=0.02),
        discs=[Disc(position=0.1, mass=3.0, diametral_inertia=5e-3, polar_inertia=5e-3, load=(0.0, 0.0, -20.0))],
        supports=[Support(position=0.02, bearing=bearing, facing="-z"), Support(position=0.18, bearing=bearing,
                                                                              preload=30.0)],
        gravity=(0.0, 0.0, -9.81),
    )  # fmt: skip
    lin = linearise(rotor, 0.0)
    shaft, ring = rotor.nodes["shaft"]["z"], rotor.nodes["outer ring 1"]["z"]
    hangs = 9.81 * (rotor.mass[shaft, shaft] + rotor.mass[ring, ring]) + 20.0
    np.testing.assert_allclose(lin.loads[0, 2], hangs + 30.0, rtol=1e-7)


def test_matrices_of_five_degrees():
    K, C = np.diag([1e8, 1e8, 5e7, 1e4, 1e4]), np.diag([100.0, 100.0, 50.0, 0.1, 0.1])
    bearing = LinearBearing(K, C)
    lin = linearise(rigid(bearing, bearing, offset=0.0, apart=True), 0.0)
    axial = next(m for m in lin.modes(None) if abs(m.shape[2]) > 0.9)
    assert axial.hz == pytest.approx(np.sqrt(1e8 / MASS - (100.0 / (2.0 * MASS)) ** 2) / (2.0 * pi))
    assert axial.eigenvalue.real == pytest.approx(-100.0 / (2.0 * MASS))


def tandem(load):
    """Both bearings carry axial force in one direction only."""
    rotor = rigid(LIGHT, LIGHT, offset=0.0, load=load)
    return replace(rotor, mounts=tuple(replace(mount, facing="+z") for mount in rotor.mounts))


def floating(**both):
    """Both outer rings are free along the shaft."""
    supports = [Support(position=at, bearing=LIGHT, **both) for at in (0.02, 0.18)]
    return rotor_on_bearings(Shaft(length=0.2, diameter=0.02), supports=supports)


PLACES = {"x": 0, "y": 1, "z": 2, "tilt_x": 3, "tilt_y": 4}


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: BearingMount(bearing=LIGHT, x=0, y=1), ("contact_angle", "axial=True")),
        (lambda: BearingMount(bearing=LIGHT, x=0, y=1, z=2), ("z, tilt_x, tilt_y", "all given, or none")),
        (lambda: BearingMount(bearing=LIGHT, **PLACES, facing="z"), ("facing", "+z, -z")),
        (lambda: BearingMount(bearing=LIGHT, **PLACES, offset=5.0), ("offset", "in µm? then 5e-06 m")),
        (lambda: BearingMount(bearing=LIGHT, **PLACES, housing=(5, 6)), ("housing", "(x, y, z)")),
        (lambda: BearingMount(bearing=LIGHT, **PLACES, cage_angle=90.0), ("cage_angle", "radians")),
        (lambda: motor(LIGHT, preload=-5.0), ("preload", "0, or between")),
        (lambda: motor(LIGHT, preload=0.0), ("preload = 0", "angular contact bearing together")),
        (lambda: motor(LIGHT, preload=5.0, offset=1e-6), ("offset", "left out beside preload")),
        (lambda: floating(preload=5.0), ("preload", "nothing holds a shaft")),
        (
            lambda: linearise(motor(LIGHT, preload=5.0), 0.0).modes()[0]._node(np.zeros(9), "shaft"),
            ("one that moves across",),
        ),
        (
            lambda: motor(LIGHT, preload=5.0, housing_mass=1.0, housing_stiffness=1e8),
            ("preload", "left out with a housing"),
        ),
        (lambda: linearise(rigid(LIGHT, LIGHT, offset=0.0), 0.0), ("load", "bearing", "preload")),
        (lambda: tandem([0.0, 0.0, -100.0, 0.0, 0.0]).equilibrium(), ("load of bearing 0", "this direction only")),
        (
            lambda: rigid(LIGHT, LIGHT, load=[0.0, 0.0, 9e4, 0.0, 0.0]).equilibrium(),
            ("load of bearing 0", "a ball carries at most"),
        ),
    ],
)  # fmt: skip
def test_bad_input(make, words):
    with pytest.raises(InputError) as caught:
        make()
    line = str(caught.value)
    assert "\n" not in line and all(word in line for word in words), line


def test_tangents_of_a_rotor_against_differences():
    """At speed, where inertia makes them unsymmetric, and with balls off their races."""
    bearing = BallBearing(**{**SPINDLE, "contact_angle": None, "clearance": 2e-5})
    rotor = rigid(bearing, bearing, load=np.array([0.0, -300.0, 40.0, 0.0, 0.0]))
    lin = linearise(rotor, 12000.0, passage=False)

    for (at, support), mount in zip(static_supports(rotor.mounts, 12000.0), rotor.mounts, strict=True):
        r = mount.rows(5) @ lin.rest
        step = np.array([1e-9, 1e-9, 1e-9, 1e-7, 1e-7])
        differences = np.array(
            [
                (support.force(r + h * e) - support.force(r - h * e)) / (2.0 * h)
                for h, e in zip(step, np.eye(5), strict=True)
            ]
        ).T
        exact = support.tangent(r)
        np.testing.assert_allclose(differences, exact, atol=1e-6 * np.abs(exact).max())
        assert at.stop - at.start == 5


@pytest.mark.parametrize("kind", ["preload", "spring"])
@pytest.mark.parametrize("arrangement", ["back to back", "face to face"])
def test_a_set_under_a_shaft_is_the_set_under_its_load(kind, arrangement):
    """Static displacement and dynamic stiffness of a node are those of the `BearingSet` alone."""
    oil = Lubricant.iso_vg(68, temperature=70.0)
    first, second = (BallBearing(**SPINDLE | {"contact_angle": radians(a)}, oil=oil) for a in (25.0, 15.0))
    pair = BearingSet.pair(first, arrangement, other=second, distance=40e-3, **{kind: 300.0})
    shaft = Shaft(length=0.2, diameter=0.03, elements=2)
    pull, rpm, seen = (3.0, -9.81, 4.0), 9000.0, -pi / 2.0
    light = Support(position=0.1, bearing=pair, outer_ring_mass=1e-7)  # the pull along z is on the ring too
    rotor = rotor_on_bearings(shaft, supports=[light], gravity=pull)
    mass = 7800.0 * pi / 4.0 * 0.03**2 * 0.2
    state = pair.equilibrium((*(mass * np.array(pull)), 0.0, 0.0), speed_rpm=rpm, cage_angle=seen)
    node = rotor.nodes["bearing 0"] | rotor.nodes["shaft"]
    q = rotor.equilibrium(rpm)
    places = [node[name] for name in ("x", "y", "z", "tilt_x", "tilt_y")]
    np.testing.assert_allclose(q[places], state.displacement, rtol=1e-6, atol=1e-13)
    assert len(rotor.mounts) == 2
    w = 2.0 * pi * 300.0
    Z = linearise(rotor, rpm, passage=False).support_impedance(1j * w)
    if kind == "spring":  # the outer ring follows without its mass
        slide = rotor.nodes["outer ring 0"]["z"]
        Z = Z - np.outer(Z[:, slide], Z[slide]) / Z[slide, slide]
    alone = pair.coefficients(state.load, speed_rpm=rpm, cage_angle=seen, omega=w)
    wanted = alone.stiffness[0] + 1j * w * alone.damping[0]
    np.testing.assert_allclose(Z[np.ix_(places, places)], wanted, atol=1e-6 * np.abs(wanted).max())
    for name, value in (("facing", "-z"), ("offset", 1e-6), ("preload", 10.0)):
        with pytest.raises(InputError, match=f"{name} = .*the BearingSet has its own"):
            Support(position=0.1, bearing=pair, **{name: value})
    with pytest.raises(InputError, match=r"number of supports = 1.*or one BearingSet"):
        rotor_on_bearings(shaft, supports=[Support(position=0.1, bearing=first)])


@pytest.mark.parametrize(
    "preloads",
    [{0.15: "spring"}, pytest.param({0.05: "preload", 0.25: "spring"}, marks=pytest.mark.slow)],
    ids=["one", "two"],  # four bearings take 13 s to compile
)
def test_a_shaft_runs_on_sets(preloads):
    """A pair on a spring, whose outer ring slides; the same beside a pair with offsets on the left."""
    supports = [
        Support(position=z, bearing=BearingSet.pair(BallBearing(**SPINDLE), distance=20e-3, **{kind: 300.0}))
        for z, kind in preloads.items()
    ]
    rotor = rotor_on_bearings(Shaft(length=0.3, diameter=0.03), supports=supports)
    assert len(rotor.mounts) == 2 * len(supports) and any(name.startswith("outer ring") for name in rotor.nodes)
    run = simulate_rotor(rotor, speed_rpm=3000.0, dt=1e-4, until=5e-3)
    assert run.columns[::5][:2] == ("bearing 0 of support 0 x", "bearing 1 of support 0 x")
    assert np.ptp(run.displacement, axis=0).max() < 1e-6  # it stays at rest but for ball passage
