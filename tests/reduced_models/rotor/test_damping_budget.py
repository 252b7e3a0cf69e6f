"""Shares of parts in the damping of modes: closed forms, sums that are exact, parts without their loss."""

import json
from dataclasses import replace

import numpy as np
import pytest
from rotor_twins import POINT, C, K, one_mass, spring

from ehlcontact import InputError, Lubricant, OilLayer, read, save
from reduced_models import (
    Atlas,
    BallBearing,
    BearingMount,
    Disc,
    LinearBearing,
    Rotor,
    Shaft,
    SqueezeFilmDamper,
    Support,
    jeffcott_rotor,
    linearise,
    machine_state,
    rotor_on_bearings,
)
from reduced_models.rotor.linear_contact import ContactImpedance

OIL = Lubricant.iso_vg(46, temperature=70.0)
SUM = 1e-9  # relative error of the sum of all shares: the bar of a budget is 1e-6


def linear(stiffness, damping, **more):
    """Planar bearing of matrices."""
    return LinearBearing(stiffness * np.eye(2), damping * np.eye(2), **more)


def motor(**changes):
    """Two 6305, one pressed by a spring; shaft, disc and bearings all take something."""
    held = BallBearing.catalogue("6305", clearance="CN", **({"oil": OIL, "loss_factor": 0.01} | changes))
    return rotor_on_bearings(
        Shaft(length=0.2, diameter=0.02, damping_time=1e-6),
        discs=[Disc.cylinder(position=0.1, diameter=0.08, width=0.06, bore=0.02, damping=20.0)],
        supports=[
            Support(position=0.02, bearing=held, facing="-z"),
            Support(position=0.18, bearing=held, facing="+z", preload=200.0),
        ],
    )


@pytest.fixture(scope="module")
def at_speed():
    return linearise(motor(), 12000.0)


def test_springs_and_dashpots_in_parallel():
    """A mass on two bearings and a damper: c_i/(2 sqrt(k m)) each, and what is left without one is the rest."""
    m, k, c, own = 2.0, 1e6, 150.0, 30.0
    mounts = tuple(
        BearingMount(bearing=linear(n * k, n * n * c), x=0, y=1, name=f"bearing {n}") for n in (1.0, 2.0)
    )
    rotor = Rotor(mass=m * np.eye(2), stiffness=np.zeros((2, 2)), damping=own * np.eye(2), mounts=mounts)
    found = linearise(rotor, 1000.0).damping_budget()
    by_hand = np.array([own, c, 4.0 * c]) / (2.0 * np.sqrt(3.0 * k * m))
    assert found.parts == ("rotor", "bearing 1.0", "bearing 2.0")
    np.testing.assert_allclose(found.contribution, np.tile(by_hand[:, None], 2), rtol=1e-9)
    np.testing.assert_allclose(found.remaining, found.damping_ratio - found.contribution, rtol=1e-9)
    np.testing.assert_allclose(found.share.sum(axis=0), 1.0, rtol=1e-12)


def test_springs_and_dashpots_in_series_with_large_damping():
    """Mass on a bearing in a housing on springs: dissipated power over twice the energy of the decaying motion."""
    m, h, k1, c1, k2, c2 = 3.0, 1.0, 2e6, 900.0, 1e6, 700.0
    rotor = Rotor(
        mass=np.diag([m, m, h, h]),
        stiffness=np.diag([0.0, 0.0, k2, k2]),
        damping=np.diag([0.0, 0.0, c2, c2]),
        damping_by_part={"housing": np.diag([0.0, 0.0, c2, c2])},
        mounts=(BearingMount(bearing=linear(k1, c1), x=0, y=1, housing=(2, 3)),),
    )
    found = linearise(rotor, 1000.0).damping_budget()
    # |m s^2 + Z1, -Z1; -Z1, h s^2 + Z1 + Z2| = 0
    z1, z2, s2 = np.poly1d([c1, k1]), np.poly1d([c2, k2]), np.poly1d([1.0, 0.0, 0.0])
    roots = ((m * s2 + z1) * (h * s2 + z1 + z2) - z1 * z1).roots
    roots = np.sort_complex(1j * roots[roots.imag > 0.0].conj())
    for k, s in enumerate(complex(root.imag, root.real) for root in np.repeat(roots, 2)):
        q = np.array([1.0, 1.0 + m * s * s / z1(s)])
        moved = np.abs([q[0] - q[1], q[1]]) ** 2
        energy = abs(s) ** 2 * (m * abs(q[0]) ** 2 + h * abs(q[1]) ** 2) + k1 * moved[0] + k2 * moved[1]
        by_hand = abs(s) * np.array([c2 * moved[1], c1 * moved[0]]) / energy
        assert found.damping_ratio[k] == pytest.approx(-s.real / abs(s), rel=1e-9)
        np.testing.assert_allclose(found.contribution[:, k], by_hand, rtol=1e-8)
    assert found.damping_ratio.max() > 0.4
    assert found.parts == ("housing", "bearing 0")
    assert np.abs(found.residual).max() < SUM


def test_cross_coupled_stiffness_feeds_forward_whirl():
    """K = k 1 + kappa J on one mass, gyroscopic force beside it: the part of kappa is below zero forward."""
    m, k, kappa, c, gyro = 2.0, 1e6, 3e3, 40.0, 0.3
    J = np.array([[0.0, 1.0], [-1.0, 0.0]])
    rotor = Rotor(
        mass=m * np.eye(2),
        stiffness=kappa * J,
        damping=c * np.eye(2),
        gyroscopic=gyro * J,
        mounts=(BearingMount(bearing=linear(k, 0.0), x=0, y=1),),
    )
    found = linearise(rotor, 3000.0).damping_budget()
    assert found.parts == ("rotor", "cross-coupled stiffness")
    assert np.abs(found.residual).max() < SUM
    backward, forward = found.contribution[1]
    omega = 100.0 * np.pi * gyro
    for k_mode, sign in ((0, -1.0), (1, 1.0)):  # q = (1, -+i): m s^2 + (c -+ i omega g) s + k -+ i kappa = 0
        roots = np.roots([m, c - sign * 1j * omega, k - sign * 1j * kappa])
        s = roots[roots.imag > 0.0][0]
        assert found.damping_ratio[k_mode] == pytest.approx(-s.real / abs(s), rel=1e-8)
    assert forward < 0.0 < backward
    without = linearise(rotor, 3000.0).without("cross-coupled stiffness")
    assert without.modes()[1].damping_ratio == pytest.approx(found.remaining[1, 1], rel=1e-9)
    assert without.modes()[1].damping_ratio > found.damping_ratio[1]


def test_shares_of_a_motor_add_up(at_speed):
    found = at_speed.damping_budget()
    assert found.parts[:3] == ("bearing 0, inner films", "bearing 0, outer films", "bearing 0, rings and fits")
    assert found.parts[-2:] == ("shaft", "disc")
    assert np.abs(found.residual).max() < SUM
    assert np.all(found.contribution >= 0.0)
    bends = found.parts.index("disc")  # the disc moves in the second and third mode
    assert found.share[bends, 1] > 0.3 and found.share[bends, 3] < 1e-6
    assert found.kinds.keys() == {"inner films", "outer films", "rings and fits", "shaft", "disc"}


@pytest.mark.parametrize(
    "changes",
    [
        {"ball_inertia": True},
        {"race_control": "shared"},
        {"race_control": "inner"},
        {"oil": None},
        {"loss_factor": 0.2},
    ],
)
def test_shares_of_every_kind_of_ball_bearing_add_up(changes):
    found = linearise(motor(**changes), 12000.0).damping_budget(4)
    assert np.abs(found.residual).max() < SUM and np.all(found.damping_ratio > 0.0)


def test_a_part_without_its_loss_keeps_its_stiffness(at_speed):
    found, part = at_speed.damping_budget(3), "bearing 0, rings and fits"
    rest = at_speed.without(part)
    assert part not in rest.losses and len(rest.losses) == len(at_speed.losses) - 1
    modes = rest.modes(3)
    np.testing.assert_allclose([mode.damping_ratio for mode in modes], found.remaining[2], rtol=1e-6)
    np.testing.assert_allclose([mode.hz for mode in modes], found.hz, rtol=1e-5)
    s = 2j * np.pi * 400.0
    for full, less in zip(at_speed.balls[0].impedance(s), rest.balls[0].impedance(s), strict=True):
        np.testing.assert_allclose(less.real, full.real, rtol=1e-3, atol=1e-6 * np.abs(full.real).max())
    assert rest.without(*rest.losses).modes(3)[1].damping_ratio == pytest.approx(0.0, abs=1e-12)
    with pytest.raises(InputError, match=r"^lossless = 'bearing 0, rings and fits': must be none"):
        rest.to_control()
    with pytest.raises(InputError, match=r"^parts = 'housing 7': must be one of 'bearing 0, inner films'"):
        at_speed.without("housing 7")


def test_the_rest_without_rings_and_fits_is_the_bearing_without_a_loss_factor():
    """Beside the stiffness that the filters add: small damping, so the contribution is what goes."""
    found = linearise(motor(), 12000.0).damping_budget(1)
    bare = linearise(motor(loss_factor=0.0), 12000.0).modes(1)[0]
    rings = sum(row[0] for part, row in zip(found.parts, found.contribution, strict=True) if "rings" in part)
    assert found.damping_ratio[0] - rings == pytest.approx(bare.damping_ratio, rel=0.05)
    assert rings == pytest.approx(0.5 * 0.01, rel=0.02)  # half the loss factor, for nothing else is strained


@pytest.mark.long
def test_starved_films_feed_vibration_and_rings_take_it():
    """Signed damping of solved contacts: below zero of films, and half a loss factor of rings beside it."""
    held = BallBearing.catalogue(
        "6205",
        oil=Lubricant.iso_vg(68, temperature=50.0),
        clearance=-4e-6,
        supply=OilLayer(over_flooded=1.0),
        loss_factor=0.005,
    )
    rotor = Rotor(
        mass=1500.0 * np.eye(2),
        stiffness=np.zeros((2, 2)),
        load=np.array([0.0, -1000.0]),
        mounts=(BearingMount(bearing=held, x=0, y=1),),
    )
    found = linearise(rotor, 3000.0, signed_damping=True).damping_budget()
    assert np.abs(found.residual).max() < SUM
    assert np.all(found.contribution[:2] < 0.0) and np.all(found.damping_ratio > 0.0)
    np.testing.assert_allclose(found.contribution[2], 0.0025, rtol=0.01)
    np.testing.assert_allclose(found.remaining[2], found.contribution[:2].sum(axis=0), rtol=0.01)


def test_contacts_of_elements_and_impedances():
    """Films with memory as elements, all their states; and a contact that is known by its impedance."""
    on = linearise(one_mass().on([spring])).damping_budget()
    assert on.parts == ("contact 0",)
    np.testing.assert_allclose(on.contribution[0], on.damping_ratio, rtol=1e-9)
    by_impedance = linearise(one_mass().on([lambda omega: K + 1j * np.asarray(omega) * C])).damping_budget()
    np.testing.assert_allclose(by_impedance.contribution, on.contribution, rtol=1e-6)
    assert isinstance(linearise(one_mass().on([lambda w: K + 0j * w])).contacts[0], ContactImpedance)


def test_what_a_rotor_is_damped_by():
    rotor = jeffcott_rotor(
        disc_mass=2.0, journal_mass=0.5, shaft_stiffness=1e7, shaft_damping=20.0, disc_damping=5.0
    )
    assert rotor.damping_parts.keys() == {"shaft damping", "disc damping"}
    np.testing.assert_array_equal(sum(rotor.damping_parts.values()), rotor.damping)
    shaft = rotor_on_bearings(
        Shaft(length=0.2, diameter=0.02, damping_time=1e-6),
        discs=[Disc(position=0.1, mass=2.0, damping=3.0)],
        supports=[Support(position=at, bearing=linear(1e8, 10.0)) for at in (0.0, 0.2)],
    )
    assert replace(shaft, speed_rpm=3000.0).damping_parts.keys() == {"shaft", "disc"}
    assert replace(shaft, damping=2.0 * shaft.damping).damping_parts.keys() == {"rotor"}
    for parts, line in (
        ({"a": np.eye(4)}, "^damping_by_part = 'parts off by 1': must be parts whose sum"),
        ({"a": np.eye(3)}, r"^shape of damping_by_part\['a'\] = \(3, 3\)"),
        ([np.eye(4)], "^damping_by_part = "),
    ):
        with pytest.raises(InputError, match=line):
            Rotor(mass=np.eye(4), stiffness=np.zeros((4, 4)), mounts=rotor.mounts, damping_by_part=parts)


@pytest.fixture(scope="module")
def in_a_damper():
    """The film of a damper, and a rotor whose right housing stands in it."""
    held = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0), loss_factor=0.01)
    film = SqueezeFilmDamper(length=0.015, diameter=0.08, clearance=1e-4, viscosity=0.04)
    return film, rotor_on_bearings(
        Shaft(length=0.3, diameter=0.025),
        discs=[Disc.cylinder(position=0.3, diameter=0.2, width=0.03, bore=0.025)],
        supports=[
            Support(position=0.02, bearing=held),
            Support(
                position=0.17,
                bearing=held,
                housing_mass=2.0,
                housing_stiffness=8e7,
                housing_damping=500.0,
                damper=film,
            ),
        ],
    )


def test_a_damper_under_a_housing_has_its_share(in_a_damper):
    film, rotor = in_a_damper
    at = linearise(rotor, 4500.0)
    found = at.damping_budget(3)
    assert found.parts[-2:] == ("housing 1", "damper 1")
    assert np.abs(found.residual).max() < SUM
    low, high = np.linalg.eigvalsh(film.linear(at.rest[list(rotor.nodes["housing 1"].values())]).damping) / 500.0
    ratio = found.contribution[-1] / found.contribution[-2]  # two dashpots side by side: as their C
    assert 1.0001 < high / low < 1.01 and np.all(ratio > low * (1.0 - SUM)) and np.all(ratio < high * (1.0 + SUM))


@pytest.mark.long
def test_a_machine_has_parts_by_the_labels_of_its_bearings(in_a_damper):
    _, rotor = in_a_damper
    found, state = (
        linearise(rotor, 4500.0).damping_budget(3),
        machine_state(rotor, 4500.0, names=("drive end", "fan end")),
    )
    assert state.budget.parts[0] == "drive end 6205, inner films"
    assert state.budget.parts[-2:] == ("housing of fan end 6205", "damper of fan end 6205")
    np.testing.assert_allclose(state.budget.contribution[:, :3], found.contribution, rtol=1e-9, atol=1e-15)
    assert "damped by" in str(state.tiles()[4])


def test_a_budget_as_table_text_and_file(at_speed, tmp_path):
    found = at_speed.damping_budget(2)
    assert "rings and fits 88.2 %, outer films 6.77 %, inner films 5.06 %" in str(found)
    again = read(save(found, tmp_path / "budget.h5"))
    np.testing.assert_array_equal(again.contribution, found.contribution)
    assert again.parts == found.parts
    numbers = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert numbers["parts"][0] == "bearing 0, inner films" and len(numbers["contribution"][0]) == 2
    names = found.renamed(lambda name: {"bearing 0": "drive end 6305"}.get(name, name)).parts
    assert names[0] == "drive end 6305, inner films" and names[-1] == "disc"
    stack = found.picture().panels[0].lines
    top = [max(line.base[k] + line.y[k] for line in stack) for k in range(2)]
    np.testing.assert_allclose(top, 100.0, rtol=1e-12)


def test_elements_with_memory_add_up():
    """Their roots are eigenvalues beside film states a million times as fast; shapes are polished."""
    element = Atlas().wide(POINT, np.geomspace(0.2, 5.0, 8))
    rotor = jeffcott_rotor(
        half_angle=0.5, disc_mass=4.0, journal_mass=0.5, shaft_stiffness=5e7, shaft_damping=200.0, speed_rpm=3000.0
    )
    found = linearise(rotor.on([element, element.copy()])).damping_budget(None)
    assert found.parts == ("contact 0", "contact 1", "shaft damping")
    assert found.hz.size == 4 and np.abs(found.residual).max() < 1e-6
    assert found.damping_ratio.max() > 0.02
