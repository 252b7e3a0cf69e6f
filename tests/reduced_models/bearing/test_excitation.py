"""Waviness of races and balls, and unequal balls: against balls pressed one by one, and the classical orders."""

from math import pi

import numpy as np
import pytest
from refusals import refusals
from scipy.optimize import fsolve

from ehlcontact import Grid, Lubricant, MoesPoint, excitation
from ehlcontact.hertz import hertz_contact
from reduced_models import BallBearing, BallDiameter, BallWaviness, RaceWaviness
from reduced_models.atlas.waves import contact_filter
from reduced_models.bearing.height_tables import track_radius

DRY = BallBearing.catalogue("6205", clearance=15e-6)
SLOW = 1.0  # rev/min: balls without inertia


def pressed(bearing, q, psi, heights):
    """Force of one ball on the ring at q, (5,): Hertz' springs between groove centres."""
    d, f = bearing.ball_diameter, (bearing.conformity_inner, bearing.conformity_outer)
    kn, free = [], [(one - 0.5) * d for one in f]
    for name in ("inner", "outer"):
        body = bearing.race(name).geometry
        kn.append(hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).approach ** -1.5)
    circle = 0.5 * bearing.pitch_diameter + free[0] * np.cos(bearing.free_angle)
    c = np.array([sum(free) - 0.5 * bearing.clearance + q[0] * np.cos(psi) + q[1] * np.sin(psi), q[2]])
    c[1] += circle * (q[3] * np.sin(psi) - q[4] * np.cos(psi))

    def contacts(b):
        to_ring, to_outer = c - b, b
        found = []
        for k, along in enumerate((to_ring, to_outer)):
            length = np.hypot(*along)
            compressed = max(length - free[k] + heights[k], 0.0)
            found.append(kn[k] * compressed**1.5 * along / length)
        return found

    def balance(x):
        return np.subtract(*contacts(1e-6 * x)) * 1e3

    found, _, _, _ = fsolve(balance, 1e6 * free[1] / sum(free) * c, xtol=1e-13, full_output=True)
    assert np.abs(balance(found)).max() < 1e-5
    radial, axial = -contacts(1e-6 * found)[0]
    across = np.array([np.cos(psi), np.sin(psi)])
    return np.concatenate([radial * across, [axial], circle * axial * across[::-1] * [1.0, -1.0]])


def heights_at(feature, bearing, ball, psi, turns, rotation):
    """Heights at both contacts of a ball."""
    n, at = getattr(feature, "waves", 0), 2.0 * pi * turns
    if isinstance(feature, RaceWaviness):
        angle = psi - (at if feature.race == "inner" else 0.0)
        height = feature.amplitude * np.cos(n * angle - feature.phase)
        return np.array([height, 0.0]) if feature.race == "inner" else np.array([0.0, height])
    if feature.ball != ball:
        return np.zeros(2)
    if isinstance(feature, BallDiameter):
        return np.full(2, 0.5 * feature.excess)
    return feature.amplitude * np.cos(n * rotation * at - feature.phase + np.array([0.0, n * pi]))


def one_by_one(bearing, features, load, turns, cage_angle):
    """Change of the force on the held ring by the features, by differences, (5,)."""
    Z, orders = bearing.balls, bearing.equilibrium(load, speed_rpm=SLOW).orders
    cage = cage_angle + 2.0 * pi * orders.ftf_order * turns
    q, total = bearing.equilibrium(load, speed_rpm=SLOW, cage_angle=cage).displacement, np.zeros(5)
    for k in range(Z):
        psi = cage + 2.0 * pi * k / Z
        h = sum(heights_at(one, bearing, k, psi, turns, orders.bsf_order) for one in features)
        if h.any():
            total += 0.5 * (pressed(bearing, q, psi, h) - pressed(bearing, q, psi, -h))
    return total


FEATURES = {
    "inner, radial": [RaceWaviness(race="inner", waves=10, amplitude=1e-7, phase=0.4)],
    "inner, axial": [RaceWaviness(race="inner", waves=18, amplitude=1e-7)],
    "outer": [RaceWaviness(race="outer", waves=8, amplitude=1e-7, phase=-1.0)],
    "between": [RaceWaviness(race="inner", waves=5, amplitude=1e-7)],
    "ball, even": [BallWaviness(ball=3, waves=2, amplitude=1e-7, phase=0.3)],
    "diameter": [BallDiameter(ball=2, excess=2e-7)],
    "all": [
        RaceWaviness(race="outer", waves=9, amplitude=5e-8),
        BallDiameter(ball=7, excess=-1e-7),
        RaceWaviness(race="inner", waves=1, amplitude=1e-7),
    ],
}


@pytest.mark.parametrize("load", [(0.0, 0.0, 300.0), (100.0, -150.0, 500.0, 0.5, 0.0)], ids=["axial", "combined"])
@pytest.mark.parametrize("name", FEATURES)
def test_forces_are_those_of_balls_pressed_one_by_one(name, load):
    """All five components within 1 % of the largest force, or of that at the pitch radius."""
    found = DRY.excitation(FEATURES[name], load, speed_rpm=SLOW, cage_angle=0.7)
    turns = [0.0, 0.13, 0.41]
    expected = np.array([one_by_one(DRY, FEATURES[name], load, t, 0.7) for t in turns])
    unit = np.array([1.0, 1.0, 1.0, 0.5 * DRY.pitch_diameter, 0.5 * DRY.pitch_diameter])
    off = np.abs(found.force(turns) - expected) / unit
    assert off.max() < 0.01 * (found.amplitude / unit).max(initial=0.02)


CLASSICAL = [
    *((("inner", k * 9 + d), d, k) for k in (1, 2) for d in (-1, 0, 1)),
    *((("outer", k * 9 + d), d, k) for k in (1, 2) for d in (-1, 0, 1)),
]


@pytest.mark.parametrize(("waves", "aside", "k"), CLASSICAL)
def test_orders_of_race_waviness_under_axial_load(waves, aside, k):
    """kZ: axial, at k BPFI or k BPFO; kZ +- 1: radial and tilts, at k BPFI +- 1 or k BPFO; no others."""
    race, n = waves
    load = (0.0, 0.0, 300.0)
    found = DRY.excitation([RaceWaviness(race=race, waves=n, amplitude=1e-7)], load, speed_rpm=SLOW)
    orders = DRY.equilibrium(load, speed_rpm=SLOW).orders
    expected = k * orders.bpfi_order + aside if race == "inner" else k * orders.bpfo_order
    assert found.order == pytest.approx([expected], abs=1e-6)
    forces = found.amplitude[0]
    if aside:
        assert forces[0] == pytest.approx(forces[1], rel=1e-6) and forces[0] > 1.0 and forces[2] < 1e-6 * forces[0]
        assert forces[3] == pytest.approx(forces[4], rel=1e-6) and forces[3] > 1e-3 * forces[0]
        whirl = np.angle(np.exp(1j * (found.phase[0, 1] - found.phase[0, 0])))
        forward = (race == "inner" and aside == 1) or (race == "outer" and aside == -1)
        assert whirl == pytest.approx(-pi / 2 if forward else pi / 2, abs=1e-6)
    else:
        assert forces[2] > 1.0 and np.delete(forces, 2).max() < 1e-6 * forces[2]


@pytest.mark.parametrize("n", [2, 3, 5, 7, 12, 15])
def test_other_waves_excite_nothing_under_axial_load(n):
    features = [RaceWaviness(race=race, waves=n, amplitude=1e-7) for race in ("inner", "outer")]
    assert DRY.excitation(features, (0.0, 0.0, 300.0), speed_rpm=SLOW).order.size == 0


def test_orders_of_balls_under_axial_load():
    """A larger ball at the cage's order; even waves at n BSF axially and n BSF +- FTF radially."""
    load = (0.0, 0.0, 300.0)
    orders = DRY.equilibrium(load, speed_rpm=SLOW).orders
    larger = DRY.excitation([BallDiameter(ball=0, excess=1e-7)], load, speed_rpm=SLOW)
    assert larger.order == pytest.approx([0.0, orders.ftf_order], abs=1e-6)
    wavy = DRY.excitation([BallWaviness(ball=0, waves=4, amplitude=1e-7)], load, speed_rpm=SLOW)
    centre = 4.0 * orders.bsf_order
    assert wavy.order == pytest.approx([centre - orders.ftf_order, centre, centre + orders.ftf_order], abs=1e-6)
    assert wavy.amplitude[1, 2] > 0.1 and wavy.amplitude[[0, 2], 0].min() > 0.1


def test_waves_around_an_inner_race_move_it_like_its_shaft():
    """One wave is an eccentric race: in a preloaded planar bearing its force is the stiffness times the height."""
    oil = Lubricant.iso_vg(68, temperature=50.0)
    bearing = BallBearing.catalogue("6205", oil=oil, clearance=-10e-6)
    eccentric, load = RaceWaviness(race="inner", waves=1, amplitude=1e-7), (0.0, -1e-3)
    found = bearing.excitation([eccentric], load, speed_rpm=3000.0)
    seen = 1.0 - bearing.orders.ftf_order  # the frequency at which a ball meets it
    K = bearing.coefficients(load, speed_rpm=3000.0, hz=50.0 * seen)
    Z = np.hypot(K.stiffness[0, 0, 0], K.omega[0] * K.damping[0, 0, 0])
    strongest = int(np.argmax(found.amplitude[:, 0]))
    assert found.order[strongest] == pytest.approx(1.0) and found.hz[strongest] == pytest.approx(50.0)
    assert found.amplitude[strongest, 0] == pytest.approx(1e-7 * Z, rel=1e-3)


def test_short_waves_are_filtered_by_the_contact():
    """Those of two semi-axes excite nothing of a dry contact; half that long they are past the first zero."""
    load, Q = (0.0, 0.0, 300.0), DRY.equilibrium((0.0, 0.0, 300.0), speed_rpm=SLOW).force[0, 0]
    body = DRY.race("inner").geometry
    a = hertz_contact(Q, body.radius_x, body.radius_y, body.e_reduced).a
    radius = 0.5 * (DRY.pitch_diameter - DRY.ball_diameter * np.cos(DRY.free_angle))

    def axial(waves):
        nearest = 9 * round(waves / 9)
        found = DRY.excitation([RaceWaviness(race="inner", waves=nearest, amplitude=1e-7)], load, speed_rpm=SLOW)
        return nearest * a / radius, found.amplitude[:, 2].max(initial=0.0)

    (k, short), (_, long) = axial(2.0 * radius / a), axial(9)
    assert short / long == pytest.approx(abs(np.sin(k) / k), rel=5e-3)
    assert axial(pi * radius / a)[1] < 0.02 * long


def filtered_lines(waves):
    """Axial line of waves on the inner race of a 6205 in oil, by filter; contact and wavelength over a."""
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0), clearance=15e-6)
    load, race = (0.0, 0.0, 300.0), bearing.race("inner")
    point = race.point(bearing.equilibrium(load, speed_rpm=3000.0).force[0, 0], 3000.0)
    body = point.geometry
    a = hertz_contact(point.load, body.radius_x, body.radius_y, body.e_reduced).a
    wavy = [RaceWaviness(race="inner", waves=waves, amplitude=1e-8)]
    forces = {
        kind: (found.amplitude[0, 2] * np.exp(1j * found.phase[0, 2]))
        for kind in ("film", "dry", "none")
        for found in [bearing.excitation(wavy, load, speed_rpm=3000.0, contact_filter=kind)]
    }
    return forces, point.moes, 2.0 * pi * track_radius(bearing, "inner") / waves / a


@pytest.mark.parametrize("waves", [90, 351])
def test_films_filter_more_than_dry_contacts(waves):
    """Of waves of 4 a, which are 351, a film lets through .41, a dry contact .64."""
    forces, point, wavelength = filtered_lines(waves)
    film, dry = (forces[kind] / forces["none"] for kind in ("film", "dry"))
    expected = contact_filter(MoesPoint(point.M, point.L, point.kappa), wavelength=wavelength).ratio[0]
    assert abs(film - expected) < 2e-3
    assert abs(dry) == pytest.approx(np.sinc(2.0 / wavelength), rel=1e-3)
    assert abs(film) < abs(dry) - (0.2 if waves == 351 else 0.0)


@pytest.mark.slow
def test_lines_of_waves_of_four_semi_axes_are_those_of_a_full_film():
    """Within 3 %, by G of the linearised full film at the contact of the balls."""
    forces, point, wavelength = filtered_lines(351)
    assert wavelength == pytest.approx(4.0, abs=0.01)
    there = excitation(MoesPoint(point.M, point.L, point.kappa), wavelength=wavelength, grid=Grid(n=128))
    assert abs(forces["film"] / forces["none"]) == pytest.approx(there.contact_filter[0], rel=0.03)


test_bad_input_is_one_line = refusals(
    (lambda: RaceWaviness(race="cage", waves=3, amplitude=1e-7), "race = 'cage'"),
    (lambda: RaceWaviness(race="inner", waves=0, amplitude=1e-7), "waves = 0"),
    (lambda: RaceWaviness(race="inner", waves=3, amplitude=-1e-7), "amplitude = -1e-07"),
    (lambda: RaceWaviness(race="inner", waves=3, amplitude=1e-7, phase=90.0), "phase = 90.0: .* rad"),
    (lambda: BallDiameter(ball=-1, excess=1e-7), "ball = -1"),
    (
        lambda: DRY.excitation([BallDiameter(ball=9, excess=1e-7)], (0, 0, 300.0)),
        "ball = 9: must be from 0 to 8",
    ),
    (lambda: DRY.excitation([], (0, 0, 300.0)), "features = .*at least one"),
    (
        lambda: DRY.excitation([BallDiameter(ball=1, excess=1e-7)], (0, 0, 300.0), contact_filter="wet"),
        "contact_filter = 'wet'",
    ),
    (lambda: DRY.excitation(["spall"], (0, 0, 300.0)), "features = 'spall'"),
)


@pytest.mark.parametrize("load", [(0.0, -100.0), (0.0, -30.0, 32.0)])
def test_slip_of_the_cage_moves_lines(load):
    """To the orders with slip: of the inner race j BPFI + k, of a ball twice its rotation and the cage."""
    given = {"speed_rpm": SLOW, "slip": 0.01}
    race, ball = (
        RaceWaviness(race="inner", waves=10, amplitude=1e-7),
        BallWaviness(ball=0, waves=2, amplitude=1e-7),
    )
    orders = DRY.orders_under(load, **given)
    found, turned = (DRY.excitation([one], load, **given).order for one in (race, ball))
    assert np.abs(found - (orders.bpfi_order + 1.0)).min() < 2e-4
    assert np.abs(turned - (2.0 * orders.bsf_order + orders.ftf_order)).min() < 2e-4
    assert (np.abs(DRY.excitation([race], load, speed_rpm=SLOW).order - (orders.bpfi_order + 1.0)) > 0.02).all()


def test_large_features_are_named():
    found = DRY.excitation([BallDiameter(ball=0, excess=5e-6)], (0.0, 0.0, 100.0), speed_rpm=SLOW)
    assert "not linear" in found.reservation and found.reservation in repr(found) and not found.loses_load
    deep = DRY.excitation([BallDiameter(ball=0, excess=40e-6)], (0.0, 0.0, 100.0), speed_rpm=SLOW)
    assert deep.loses_load and "mean nothing" in deep.reservation and "simulate_rotor" in deep.reservation


@pytest.mark.parametrize(
    ("contact_filter", "waves", "noted"), [("film", 2999, 1), ("film", 40, 0), ("dry", 2999, 0)]
)
def test_waves_shorter_than_the_table_are_named(contact_filter, waves, noted):
    """Their filter is taken as 0 +- .03: no lines, which the result says."""
    oiled = BallBearing.catalogue("6205", clearance=8e-6, oil=Lubricant.iso_vg(68, temperature=50.0))
    found = oiled.excitation(
        [RaceWaviness(race="outer", waves=waves, amplitude=1e-8)],
        (0.0, -300.0),
        speed_rpm=3000.0,
        contact_filter=contact_filter,
    )
    assert ("2999 waves are shorter" in found.reservation) == bool(noted)
    assert ("0 ± 0.03" in repr(found)) == bool(noted)
