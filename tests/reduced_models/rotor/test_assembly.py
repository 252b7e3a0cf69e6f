"""Rotors of shaft, discs and supports on ball bearings: closed forms, and the Jeffcott rotor on contacts."""

from math import pi

import numpy as np
import pytest
from beam_rotor import still_run
from refusals import refusals

from ehlcontact.errors import InputError
from reduced_models import (
    BallBearing,
    ContactMount,
    Disc,
    Shaft,
    SpeedProfile,
    SpringContact,
    Support,
    campbell,
    jeffcott_rotor,
    linearise,
    rotor_on_bearings,
    simulate_rotor,
    unbalance_response,
)

RPM, DT = 3000.0, 2e-5
SPAN, OVER = 0.4, 0.15  # m, between bearings, and of a disc beyond them


def pair(left, right, span=SPAN, **both):
    return [Support(position=0.0, bearing=left, **both), Support(position=span, bearing=right, **both)]


def jeffcott(bearing, stiffness=2e8, **changes):
    """That of examples/deep_groove_6205.toml, pressed down."""
    disc = Disc(position=0.5 * SPAN, mass=2.0, damping=1.0, load=(0.0, -200.0), unbalance=4e-5)
    shaft = Shaft.jeffcott(stiffness, SPAN, damping=60.0)
    supports = pair(bearing, bearing, journal_mass=0.15)
    return rotor_on_bearings(shaft, **({"discs": [disc], "supports": supports} | changes))


def test_matrices_are_those_of_the_jeffcott_rotor(dry):
    """Half of it: both journals move as one."""
    rotor = jeffcott(dry)
    old = jeffcott_rotor(
        half_angle=0.3, disc_mass=2.0, journal_mass=0.3, shaft_stiffness=2e8, shaft_damping=60.0, disc_damping=1.0,
        load=(0.0, -200.0),
    )  # fmt: skip
    assert rotor.size == 6
    together = np.zeros((6, 4))
    for k in (0, 1):
        together[rotor.nodes["disc"]["xy"[k]], k] = 1.0
        for name in ("bearing 0", "bearing 1"):
            together[rotor.nodes[name]["xy"[k]], 2 + k] = 1.0
    for one, other in zip((rotor.mass, rotor.damping, rotor.stiffness), old.matrices(0.0), strict=True):
        np.testing.assert_allclose(together.T @ one @ together, other, rtol=1e-10, atol=1e-9 * np.abs(other).max())
    np.testing.assert_allclose(together.T @ rotor.load, old.load, atol=1e-12)
    assert not rotor.gyroscopic.any()


def test_in_time_it_is_the_jeffcott_rotor_on_contacts():
    """Dry balls that stand still, on both paths: nine contacts of two races in series, and the bearing."""
    still = BallBearing.catalogue("6205", density=1e-6)
    rotor = jeffcott(still)
    kn = sum(still.race(race).kn ** (-2.0 / 3.0) for race in ("inner", "outer")) ** -1.5
    ball = SpringContact.power(K=kn, n=1.5, u0=0.0, F0=0.0, C1=0.0, low=1e-9, high=1e-4, units="SI")
    angles = -pi / 2.0 + 2.0 * pi / 9.0 * np.arange(9)
    old = jeffcott_rotor(
        mounts=tuple(ContactMount(float(angle)) for angle in angles), disc_mass=2.0, journal_mass=0.3,
        shaft_stiffness=2e8, shaft_damping=60.0, disc_damping=1.0, load=(0.0, -200.0), unbalance=4e-5,
        speed_rpm=RPM,
    )  # fmt: skip
    contacts = simulate_rotor(old.on([ball.copy() for _ in angles]), dt=DT, until=0.02, tolerance=1e-9)
    _, moved = still_run(rotor, RPM, DT, 0.02)
    swing = np.ptp(contacts.disc, axis=0).max()
    for seen, at in ((contacts.disc, "disc"), (contacts.journal, "bearing 0"), (contacts.journal, "bearing 1")):
        off = np.abs(moved[:, [rotor.nodes[at][k] for k in "xy"]] - seen).max()
        assert off < 1e-5 * swing


@pytest.mark.parametrize("at", [0.5, 0.3])
def test_a_massless_shaft_bends_as_a_pinned_beam(dry, at):
    """3 E I L/(a^2 b^2) at a and b from its ends; the load goes to the bearings by levers."""
    shaft = Shaft(length=SPAN, diameter=0.02, density=0.0, shear=False)
    disc = Disc(position=at * SPAN, mass=3.0)
    rotor = rotor_on_bearings(shaft, discs=[disc], supports=pair(dry, dry, journal_mass=1.0))
    a, b = at * SPAN, (1.0 - at) * SPAN
    EI = shaft.youngs_modulus * pi / 64.0 * 0.02**4
    y = rotor.nodes["disc"]["y"]
    assert rotor.stiffness[y, y] == pytest.approx(3.0 * EI * SPAN / (a * b) ** 2, rel=1e-9)
    q = rotor.equilibrium()
    rings = simulate_rotor(rotor, speed_rpm=RPM, dt=DT, until=DT).ring_force[0, :, 1]
    np.testing.assert_allclose(rings, [-9.81 * (1.0 + 3.0 * (1.0 - at)), -9.81 * (1.0 + 3.0 * at)], rtol=1e-6)
    ends = [q[rotor.nodes[name]["y"]] for name in ("bearing 0", "bearing 1")]
    sag = (1.0 - at) * ends[0] + at * ends[1] - 3.0 * 9.81 * (a * b) ** 2 / (3.0 * EI * SPAN)
    assert q[y] == pytest.approx(sag, rel=1e-9)


@pytest.mark.parametrize("rpm", [0.0, 6000.0, 60000.0])
def test_whirl_of_an_overhung_disc_by_its_flexibilities(dry, rpm):
    """A disc beyond two pins on a massless shaft: flexibilities of the beam, moment (Id w^2 - Ip omega w).

    Gere and Goodno, Mechanics of Materials, table of beams with an overhang c; Genta, Dynamics of Rotating Systems
    (2005), sec. 2.6.
    """
    m, across, polar = 5.0, 0.02, 0.036
    shaft = Shaft(length=SPAN + OVER, diameter=0.03, density=0.0, shear=False)
    disc = Disc(position=SPAN + OVER, mass=m, diametral_inertia=across, polar_inertia=polar)
    rotor = rotor_on_bearings(shaft, discs=[disc], supports=pair(dry, dry, journal_mass=1e-3), gravity=(0.0, 0.0))
    omega, c, EI = rpm * pi / 30.0, OVER, shaft.youngs_modulus * pi / 64.0 * 0.03**4
    flexible = np.array([[c * c * (SPAN + c), c * (SPAN + 1.5 * c)], [c * (SPAN + 1.5 * c), SPAN + 3.0 * c]]) / (
        3.0 * EI
    )
    # stiffness z = m w^2 ..., (Id w^2 - Ip omega w) of the slope: a polynomial of the fourth degree in w
    k = np.linalg.inv(flexible)
    expected = np.roots([
        m * across, -m * polar * omega, -m * k[1, 1] - across * k[0, 0], polar * omega * k[0, 0], np.linalg.det(k),
    ])  # fmt: skip
    K = rotor.stiffness + 1e13 * rotor.support_rows.T @ rotor.support_rows
    size = rotor.size
    A = np.block([
        [np.zeros((size, size)), np.eye(size)],
        [-np.linalg.solve(rotor.mass, K), -omega * np.linalg.solve(rotor.mass, rotor.gyroscopic)],
    ])  # fmt: skip
    found = np.sort(np.linalg.eigvals(A).imag)[size:][:4]
    np.testing.assert_allclose(found, np.sort(np.abs(expected.real)), rtol=1e-6)
    values, vectors = np.linalg.eig(A)
    if omega:  # the fastest of them whirls forward: the disc stiffens it
        fastest = vectors[:size, np.argmin(np.abs(values - 1j * found[3]))]
        x, y = fastest[[rotor.nodes["disc"][k] for k in "xy"]]
        assert (np.conj(x) * y).imag < -0.9 * abs(x) * abs(y)
        assert found[3] == pytest.approx(expected.real.max(), rel=1e-6)


def test_a_rigid_rotor_on_two_different_bearings():
    """Bounce and tilt on two springs, with the gyroscopic moment of a disc (Friswell et al. 2010, ch. 3)."""
    left, right = (BallBearing.catalogue(name, clearance=-1e-5) for name in ("6205", "6010"))
    m, across, polar, a, b = 40.0, 0.6, 1.0, 0.12, 0.28
    shaft = Shaft(length=SPAN, diameter=0.5, density=0.0, youngs_modulus=2e16)
    disc = Disc(position=a, mass=m, diametral_inertia=across, polar_inertia=polar)
    rotor = rotor_on_bearings(
        shaft, discs=[disc], supports=pair(left, right, journal_mass=1e-4), gravity=(0.0, 0.0)
    )
    rpm = 9000.0
    k1, k2 = (
        float(np.trace(held.coefficients((0.0, 0.0), speed_rpm=rpm, hz=1.0).stiffness[0]) / 2.0)
        for held in (left, right)
    )
    assert k2 > 1.2 * k1
    kT, kC, kR, g = k1 + k2, b * k2 - a * k1, a * a * k1 + b * b * k2, polar * rpm * pi / 30.0
    expected = np.roots([m * across, -m * g, -m * kR - across * kT, g * kT, kT * kR - kC * kC])
    found = [mode.omega for mode in linearise(rotor, rpm).modes(4)]
    np.testing.assert_allclose(found, np.sort(np.abs(expected)), rtol=1e-3)


def test_a_housing_on_springs(film):
    """At rest its springs carry its weight and the bearing's load; very stiff ones are the ground."""
    soft = Support(position=0.0, bearing=film, housing_mass=3.0, housing_stiffness=(2e7, 1e7), journal_mass=0.2)
    stiff = Support(position=SPAN, bearing=film, journal_mass=0.2)
    shaft, disc = Shaft.jeffcott(1e8, SPAN), Disc(position=0.5 * SPAN, mass=20.0)
    rotor = rotor_on_bearings(shaft, discs=[disc], supports=[soft, stiff])
    x, y = rotor.nodes["housing 0"].values()
    q = rotor.equilibrium(RPM)
    assert "housing 1" not in rotor.nodes
    assert q[y] == pytest.approx(-9.81 * (10.0 + 0.2 + 3.0) / 1e7, rel=1e-9)
    assert q[rotor.nodes["bearing 0"]["y"]] - q[y] == pytest.approx(q[rotor.nodes["bearing 1"]["y"]], rel=1e-9)
    rigid = Support(position=0.0, bearing=film, housing_mass=1e6, housing_stiffness=1e15, journal_mass=0.2)
    plain = Support(position=0.0, bearing=film, journal_mass=0.2)
    one, other = (
        linearise(
            rotor_on_bearings(shaft, discs=[disc], supports=[first, stiff], gravity=(0.0, -9.81)), RPM
        ).modes(2)
        for first in (rigid, plain)
    )
    for a, b in zip(one, other, strict=True):
        assert (a.hz, a.decrement) == pytest.approx((b.hz, b.decrement), rel=1e-4)
    damped = Support(
        position=0.0,
        bearing=film,
        housing_mass=3.0,
        housing_stiffness=1e7,
        housing_damping=(0.0, 4e3),
        journal_mass=0.2,
    )
    calm = rotor_on_bearings(shaft, discs=[disc], supports=[damped, stiff])
    assert calm.damping[y, y] == 4e3 and calm.damping[x, x] == 0.0


def test_gravity_has_a_direction(dry):
    down, aside, none = (
        jeffcott(dry, gravity=g, discs=[Disc(position=0.5 * SPAN, mass=2.0)])
        for g in ((0.0, -9.81), (9.81, 0.0), (0.0, 0.0))
    )
    q, r = down.equilibrium(), aside.equilibrium()
    # with the first ball below the one, beside the other
    turned = jeffcott(
        dry, gravity=(9.81, 0.0), discs=[Disc(position=0.5 * SPAN, mass=2.0)],
        supports=[Support(position=z, bearing=dry, cage_angle=0.0, journal_mass=0.15) for z in (0.0, SPAN)],
    )  # fmt: skip
    np.testing.assert_allclose(turned.equilibrium()[0::2], -q[1::2], rtol=1e-9)
    assert r[0] > 0.0 and not none.load.any()


def test_a_beam_bends_under_its_own_weight(dry):
    """5 w L^4/(384 E I) in the middle of a pinned beam, and half the weight on either bearing."""
    shaft = Shaft(length=1.0, diameter=0.02, shear=False, elements=16)
    rotor = rotor_on_bearings(shaft, discs=[], supports=pair(dry, dry, span=1.0))
    w = shaft.density * 9.81 * pi / 4.0 * 0.02**2
    q = rotor.equilibrium()
    middle = 4 * 8 + 1
    ends = 0.5 * (q[1] + q[4 * 16 + 1])
    assert q[middle] - ends == pytest.approx(
        -5.0 * w / (384.0 * shaft.youngs_modulus * pi / 64.0 * 0.02**4), rel=1e-6
    )
    assert rotor.load.reshape(-1, 4)[:, 1].sum() == pytest.approx(-w, rel=1e-12)


@pytest.mark.slow  # `tests/examples` has a run-up and a coast-down that enclose the critical speeds
def test_run_up_and_coast_down_of_an_overhung_rotor(film):
    """Two kinds of bearing and a disc beyond them: its swing peaks after the crossing, on the way up and down."""
    other = BallBearing.catalogue("6204", oil=film.oil)
    shaft = Shaft(length=0.3, diameter=0.025, damping_time=2e-5)
    disc = Disc.cylinder(position=0.3, diameter=0.2, width=0.03, bore=0.025, unbalance=2e-6)
    supports = [Support(position=0.02, bearing=film), Support(position=0.17, bearing=other, cage_angle=0.4)]
    rotor = rotor_on_bearings(shaft, discs=[disc], supports=supports)
    diagram = campbell(rotor, np.linspace(2500.0, 6500.0, 5), count=4)
    forward = [one for one in diagram.critical_speeds() if one.whirl > -0.5]
    assert len(forward) >= 1
    response = unbalance_response(rotor, np.linspace(2500.0, 6500.0, 81))
    assert response.names == ("bearing 0", "bearing 1", "disc")
    peak = response.speed_rpm[np.argmax(response.major[:, 2])]
    assert min(abs(peak / one.speed_rpm - 1.0) for one in forward) < 0.015
    swings = []
    for ends in ((2500.0, 6500.0), (6500.0, 2500.0)):
        run = simulate_rotor(rotor, speed_rpm=SpeedProfile.ramp(*ends, 1.5), dt=5e-5, until=1.5)
        x = run.disc[:, 0]
        swings.append(run.speed_rpm[np.argmax(np.abs(x - x.mean()))])
    assert swings[1] < peak < swings[0]
    assert 0.5 * (swings[0] + swings[1]) == pytest.approx(peak, rel=0.02)


@pytest.mark.parametrize(
    ("match", "make"),
    [
        (r"length = -1.0: must be", lambda b: Shaft(length=-1.0, diameter=0.02)),
        (r"diameter\[1\] = 0.0: must be", lambda b: Shaft(length=[0.1, 0.1], diameter=[0.02, 0.0])),
        (r"length of bore = 3", lambda b: Shaft(length=[0.1, 0.1], diameter=0.02, bore=[0.0, 0.0, 0.0])),
        (r"bore = .*below the diameter", lambda b: Shaft(length=0.1, diameter=0.02, bore=0.02)),
        (r"poisson_ratio = 0.6", lambda b: Shaft(length=0.1, diameter=0.02, poisson_ratio=0.6)),
        (r"elements = 0: must be a whole number", lambda b: Shaft(length=0.1, diameter=0.02, elements=0)),
        (r"span = 0: must be|span = 0.0: must be", lambda b: Shaft.jeffcott(1e8, 0.0)),
        (r"damping = -1.0: must be", lambda b: Shaft.jeffcott(1e8, 0.1, damping=-1.0)),
        (r"mass = 0.0: must be", lambda b: Disc(position=0.1, mass=0.0)),
        (
            r"polar_inertia = 3.0: must be at most twice",
            lambda b: Disc(position=0.1, mass=1.0, diametral_inertia=1.0, polar_inertia=3.0),
        ),
        (r"phase = 90.0: .*radians", lambda b: Disc(position=0.1, mass=1.0, phase=90.0)),
        (r"bore = 0.3: must be below", lambda b: Disc.cylinder(position=0.1, diameter=0.2, width=0.1, bore=0.3)),
        (r"bearing = '6205'", lambda b: Support(position=0.0, bearing="6205")),
        (r"cage_angle = 90.0: .*radians", lambda b: Support(position=0.0, bearing=b, cage_angle=90.0)),
        (r"housing_stiffness = None: must be given", lambda b: Support(position=0.0, bearing=b, housing_mass=1.0)),
        (r"housing_mass = None: must be given", lambda b: Support(position=0.0, bearing=b, housing_stiffness=1e7)),
        (
            r"housing_stiffness\[1\] = 0.0",
            lambda b: Support(position=0.0, bearing=b, housing_mass=1.0, housing_stiffness=(1e7, 0.0)),
        ),
        (r"number of supports = 1: must be at least 2", lambda b: jeffcott(b, supports=pair(b, b)[:1])),
        (
            r"supports\[1\].position = 0.5: must be between 0 and 0.4 m",
            lambda b: jeffcott(b, supports=pair(b, b, span=0.5)),
        ),
        (
            r"supports\[1\].position = 0.0: must be that of no other",
            lambda b: jeffcott(b, supports=pair(b, b, span=0.0, journal_mass=1.0)),
        ),
        (r"supports\[0\].journal_mass = 0.0: must be > 0 on a shaft", lambda b: jeffcott(b, supports=pair(b, b))),
        (r"discs\[0\] = 2.0: must be a Disc", lambda b: jeffcott(b, discs=[2.0])),
        (r"length of gravity = 4", lambda b: jeffcott(b, gravity=(0.0, 0.0, 0.0, -9.81))),
        (r"seconds = 0.0: must be", lambda b: SpeedProfile.ramp(500.0, 9000.0, 0.0)),
    ],
)  # fmt: skip
def test_bad_input(dry, match, make):
    with pytest.raises(InputError, match=match):
        make(dry)


test_millimetres_are_no_metres = refusals(
    (
        lambda: Shaft(length=300, diameter=0.025),
        r"length = 300.0: must be between 1e-06 and 100 m \(in mm\? then 0.3 m\)",
    ),
    (
        lambda: Shaft(length=[0.1, 0.2], diameter=[0.02, 25]),
        r"diameter\[1\] = 25.0: must be between 1e-06 and 10 m \(in mm\? then 0.025 m\)",
    ),
    (
        lambda: Disc.cylinder(position=0.1, diameter=200, width=0.03),
        r"diameter = 200.0: must be between 1e-06 and 10 m",
    ),
    (lambda: Disc.cylinder(position=0.1, diameter=0.2, width=30), r"width = 30.0: must be .* then 0.03 m\)"),
)
