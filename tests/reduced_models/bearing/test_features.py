"""Features as part of a bearing: runs and equilibria against the linear answer, tables against their integral."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from refusals import refusals

from ehlcontact import Dent, InputError, Lubricant
from ehlcontact.hertz import hertz_contact
from fmu.bearing.model import BearingModel
from reduced_models import (
    BallBearing,
    BallDiameter,
    BallWaviness,
    BearingMount,
    Indentation,
    RaceWaviness,
    Rotor,
    Spall,
    simulate_rotor,
)
from reduced_models.bearing.contact_heights import table_height
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.height_tables import filtered, track_radius
from reduced_models.bearing.motion import BearingMotion

DRY = BallBearing.catalogue("6205", clearance=15e-6)
OILED = replace(DRY, oil=Lubricant.iso_vg(68, temperature=50.0))
SMALL = 2e-8  # m
AXIAL = (0.0, 0.0, 300.0)
CAGE = 0.7


def held(bearing, load, rpm, steps_per_turn, turns, at=None):
    """Force on the balls and forces of all balls with the ring held where `load` puts the smooth bearing."""
    smooth = replace(bearing, features=())
    q = smooth.equilibrium(load, speed_rpm=rpm, cage_angle=CAGE).displacement
    motion = BearingMotion(bearing, rpm, 60.0 / rpm / steps_per_turn, cage_angle=CAGE, directions=FIVE[: q.size])
    motion.rest(q)
    count = round(steps_per_turn * turns)
    return motion.drive(np.tile(q, (count, 1)), np.zeros((count, q.size)))


def unit(bearing, size):
    return np.append(np.ones(3), np.full(2, 0.5 * bearing.pitch_diameter))[:size]


WAVES = {
    "inner": RaceWaviness(race="inner", waves=10, amplitude=SMALL, phase=0.4),
    "outer": RaceWaviness(race="outer", waves=8, amplitude=SMALL, phase=-1.0),
    "axial": RaceWaviness(race="inner", waves=18, amplitude=SMALL),
    "short": RaceWaviness(race="inner", waves=226, amplitude=SMALL),
    "ball": BallWaviness(ball=3, waves=4, amplitude=SMALL, phase=0.3),
    "diameter": BallDiameter(ball=2, excess=2.0 * SMALL),
}


@pytest.mark.parametrize(
    ("bearing", "load", "rpm"),
    [
        pytest.param(DRY, (50.0, 0.0, 300.0), 60.0, id="dry", marks=pytest.mark.long),
        pytest.param(OILED, AXIAL, 1500.0, id="oil"),
        pytest.param(replace(OILED, turning="outer"), AXIAL, 1500.0, id="outer turns", marks=pytest.mark.long),
        pytest.param(
            replace(DRY, turning=(4.0, -1.0)), (50.0, 0.0, 300.0), 60.0, id="both turn", marks=pytest.mark.long
        ),
        pytest.param(replace(OILED, clearance=-10e-6), (0.0, -1e-3), 1500.0, id="planar", marks=pytest.mark.long),
    ],
)
@pytest.mark.parametrize(
    "name",
    ["ball", "diameter", *(pytest.param(name, marks=pytest.mark.long) for name in ("inner", "outer", "short"))],
)
def test_runs_with_small_features_are_linear(name, bearing, load, rpm):
    """Forces of a ring that is held within 1 % of the lines of `excitation`, in all freedoms."""
    feature, steps = WAVES[name], 2000
    forces = [held(one, load, rpm, steps, 1.0)[0] for one in (replace(bearing, features=[feature]), bearing)]
    found = forces[0] - forces[1]
    lines = bearing.excitation([feature], load, speed_rpm=rpm, cage_angle=CAGE)
    expected = -lines.force(np.arange(1, steps + 1) / steps)  # the ring's on the balls
    scale = unit(bearing, found.shape[1])
    largest = (np.abs(expected) / scale).max()
    assert largest > 0.02
    assert (np.abs(found - expected)[steps // 2 :] / scale).max() < 0.01 * largest


@pytest.mark.parametrize("turning", ["inner", pytest.param("outer", marks=pytest.mark.long)])
def test_waves_of_a_ball_whose_turns_vary_around_the_orbit(turning):
    """Within 1 % of a run; with one speed of the ball for all angles lines are off by 12 % of the largest."""
    bearing, load, steps = replace(DRY, clearance=8e-6, turning=turning), (0.0, -100.0, 200.0, 0.0, 0.0), 2500
    feature = BallWaviness(ball=2, waves=30, amplitude=SMALL)
    forces = [held(one, load, 60.0, steps, 1.0)[0] for one in (replace(bearing, features=[feature]), bearing)]
    lines = bearing.excitation([feature], load, speed_rpm=60.0, cage_angle=CAGE)
    found, scale = forces[0] - forces[1], unit(bearing, 5)
    expected = -lines.force(np.arange(1, steps + 1) / steps) / scale
    assert np.abs(expected).max() > 0.5
    assert np.abs(found / scale - expected)[100:].max() < 0.01 * np.abs(expected).max()


@pytest.mark.long
@pytest.mark.parametrize("turning", ["inner", "outer"])
@pytest.mark.parametrize("feature", [
    Spall(race="outer", angle=0.4, length=5e-4, depth=SMALL, edge=1e-4),
    Spall(race="inner", angle=0.4, length=5e-4, depth=SMALL, edge=1e-4),
    Indentation(ball=3, angle=0.4, length=5e-4, depth=SMALL),
])  # fmt: skip
def test_runs_with_small_defects_have_the_lines_of_films(feature, turning):
    """Within 0.8 % in oil; lines with the dry filter differ by 4 % and more."""
    rpm, steps, smooth = 1500.0, 5000, replace(OILED, turning=turning)
    forces = [held(one, AXIAL, rpm, steps, 0.6)[0] for one in (replace(smooth, features=[feature]), smooth)]
    found, after = forces[0] - forces[1], slice(steps // 10, None)
    off, scale = {}, unit(OILED, found.shape[1])
    for kind in ("film", "dry"):
        lines = smooth.excitation([feature], AXIAL, speed_rpm=rpm, cage_angle=CAGE, contact_filter=kind)
        expected = -lines.force(np.arange(1, len(found) + 1) / steps) / scale
        off[kind] = np.abs(found / scale - expected)[after].max() / np.abs(expected).max()
    assert off["film"] < 0.008 and off["dry"] > 0.04


def strip_height(profile, place, approach, strip):
    """H of a strip of springs, by quadrature, at a `place` along the track."""
    reach = sqrt(2.0 * strip * approach)
    at = np.linspace(-reach, reach, 40_001)
    overlap = np.maximum(approach - at * at / (2.0 * strip) + profile(place + at), 0.0)
    total = np.trapezoid(overlap, at)
    if total > 0.0:
        return (0.75 * total / sqrt(2.0 * strip)) ** (2.0 / 3.0) - approach
    wide = np.linspace(-2e-3, 2e-3, 40_001)
    return float((profile(place + wide) - wide * wide / (2.0 * strip)).max())


def strip_of(bearing, name):
    body = bearing.race(name).geometry
    one = hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced)
    return one.a**2 / (2.0 * one.approach), bearing.race(name).kn


@pytest.mark.parametrize("defect", [
    Spall(race="outer", angle=1.0, length=5e-4, depth=5e-6),
    Spall(race="outer", angle=1.0, length=2e-3, depth=30e-6, edge=2e-4),
    Indentation(race="outer", angle=1.0, length=4e-4, depth=8e-6, rim=1e-6),
])  # fmt: skip
def test_strip_of_springs_is_its_integral(defect):
    """Compressions within 2 % of the smooth contact's (6 % at 20 N), heights within 3 % of the depth."""
    strip, kn = strip_of(DRY, "outer")
    spacing = 5e-6
    at = spacing * (np.arange(-800, 800) + 0.5)
    for load, off in ((20.0, 0.06), (400.0, 0.02), (1500.0, 0.02)):
        approach = (load / kn) ** (2.0 / 3.0)
        table = filtered(defect.height(at), spacing, strip, sqrt(2.0 * strip * approach))[:, -1]
        for place in np.linspace(-1.6e-3, 1.6e-3, 33):
            found = np.interp(place, at, table)
            expected = strip_height(defect.height, place, approach, strip)
            pressed = max(approach + expected, 0.0)
            assert max(approach + found, 0.0) == pytest.approx(pressed, abs=off * approach), (load, place)
            assert found == pytest.approx(expected, abs=0.03 * defect.depth), (load, place)


def test_waves_are_filtered_by_the_length_of_the_contact():
    """sin(k)/k at every load, of waves from three contact lengths down to less than one."""
    strip, kn = strip_of(DRY, "inner")
    radius = track_radius(DRY, "inner")
    for waves in (150, 400, 600):
        bearing = replace(DRY, features=[RaceWaviness(race="inner", waves=waves, amplitude=1e-9)])
        for load in (50.0, 300.0, 1500.0):
            approach = (load / kn) ** (2.0 / 3.0)
            k = waves * sqrt(2.0 * strip * approach) / radius
            found = table_height(bearing.tables.heights, 1, 0.0, approach) / 1e-9
            assert found == pytest.approx(np.sinc(k / pi), abs=0.01), (waves, load)


@pytest.mark.parametrize("load", [(50.0, 0.0, 300.0), (0.0, -1000.0)], ids=["five", "planar"])
def test_a_ring_on_small_features_rests_where_their_forces_push_it(load):
    features = [WAVES["inner"], WAVES["ball"], BallDiameter(ball=2, excess=-3e-8)]
    bearing, (cage, shaft) = replace(DRY, features=features), (0.3, 1.1)
    smooth = DRY.equilibrium(load, cage_angle=cage)
    moved = bearing.equilibrium(load, cage_angle=cage, shaft_angle=shaft).displacement - smooth.displacement
    assert np.abs(moved).max() > 1e-9
    turns = shaft / (2.0 * pi)
    start = cage - 2.0 * pi * (smooth.orders if len(load) > 2 else DRY.orders).ftf_order * turns
    push = DRY.excitation(features, load, cage_angle=start).force(turns)
    free = len(load)
    expected = np.linalg.solve(smooth.stiffness[:free, :free], push[:free])
    assert np.abs(moved[:free] - expected).max() < 0.02 * np.abs(expected).max()


def test_a_ring_at_rest_carries_its_load_over_a_spall():
    """Balance of the forces of all balls, one of which has lost its load."""
    spall = Spall(race="outer", angle=-pi / 2, length=2e-3, depth=50e-6)
    bearing = replace(DRY, clearance=5e-6, features=[spall])
    found = bearing.equilibrium((0.0, -1000.0), cage_angle=-pi / 2)
    normal = np.stack([np.cos(found.angles), np.sin(found.angles)], axis=1)
    assert found.force[:, 1] @ normal == pytest.approx([0.0, -1000.0], abs=1e-3)
    smooth = replace(bearing, features=()).equilibrium((0.0, -1000.0), cage_angle=-pi / 2)
    assert found.force[0].max() == 0.0 and smooth.force[0].min() > 300.0
    assert found.displacement[1] < smooth.displacement[1] - 1e-6
    beside = bearing.equilibrium((0.0, -1000.0), cage_angle=-pi / 2 + 0.2)
    assert beside.displacement == pytest.approx(
        replace(bearing, features=()).equilibrium((0.0, -1000.0), cage_angle=-pi / 2 + 0.2).displacement, abs=1e-15
    )


@pytest.mark.parametrize("freedoms", [2, 5])
def test_a_ball_loses_its_load_where_the_spall_begins(freedoms):
    """Half of its force is lost behind the edges, half-way to where undeformed bodies part; all in the middle."""
    length, steps, ball = 2e-3, 40_000, 4
    bearing = replace(DRY, features=[Spall(race="outer", angle=-pi / 2, length=length, depth=50e-6)])
    load = (0.0, -800.0) if freedoms == 2 else (0.0, -800.0, 100.0)
    (_, balls), (_, smooth) = (
        held(one, load, 60.0, steps, 0.56) for one in (bearing, replace(bearing, features=()))
    )
    force, without = balls[:, ball, 1], smooth[:, ball, 1]
    low = np.flatnonzero((force < 0.5 * without) & (without > 100.0))
    ftf = (
        DRY.orders.ftf_order
        if freedoms == 2
        else DRY.equilibrium(load, speed_rpm=60.0, cage_angle=CAGE).orders.ftf_order
    )
    angle = CAGE + 2.0 * pi * (ball / 9 + ftf * (low[[0, -1]] + 1) / steps) - 1.5 * pi
    approach = sum((without[low[0]] / bearing.race(name).kn) ** (2.0 / 3.0) for name in ("inner", "outer"))
    parted = sqrt(2.0 * bearing.race("outer").geometry.radius_x * approach)
    behind = 0.5 * length + angle * track_radius(bearing, "outer") * [1.0, -1.0]
    assert (behind > 0.4 * parted).all() and (behind < 0.6 * parted).all()
    assert behind[0] == pytest.approx(behind[1], abs=0.02 * parted)
    assert force[low[low.size // 2]] < 1e-3 and (np.diff(low) == 1).all()


def test_waves_of_all_balls_excite_along_the_shaft():
    """kZ waves: axial at k BPFI, in a run as in the linear answer."""
    feature, steps = WAVES["axial"], 2000
    forces = [held(one, AXIAL, 60.0, steps, 1.0)[0] for one in (replace(DRY, features=[feature]), DRY)]
    found = (forces[0] - forces[1])[steps // 2 :]
    lines = DRY.excitation([feature], AXIAL, speed_rpm=60.0, cage_angle=CAGE)
    expected = -lines.force(np.arange(1, steps + 1) / steps)[steps // 2 :]
    assert lines.order.size == 1 and np.abs(expected[:, 2]).max() > 1.0
    np.testing.assert_allclose(found[:, 2], expected[:, 2], atol=0.01 * lines.amplitude[0, 2])
    assert np.abs(found[:, :2]).max() < 0.01 * lines.amplitude[0, 2]


@pytest.mark.long
def test_a_defect_of_a_ball_meets_both_races_once_in_a_turn_of_the_ball():
    """Least forces of the ball at its angle on the inner race, and half a turn later on the outer one."""
    angle, steps = 1.0, 20_000
    dent = Indentation(ball=2, angle=angle, length=5e-4, depth=2e-6)
    bearing = replace(DRY, clearance=-10e-6, features=[dent])
    _, balls = held(bearing, (0.0, -1e-3), 60.0, steps, 1.0)
    _, smooth = held(replace(bearing, features=()), (0.0, -1e-3), 60.0, steps, 1.0)
    lost = smooth[:, 2, 0] - balls[:, 2, 0]
    inside = lost[1:-1]
    peaks = np.flatnonzero((inside > lost[:-2]) & (inside >= lost[2:]) & (inside > 0.5 * lost.max())) + 2
    met = 2.0 * pi * DRY.orders.bsf_order * peaks / steps
    expected = angle + pi * np.arange(len(met))
    assert len(met) == int((2.0 * pi * DRY.orders.bsf_order - angle) / pi) + 1
    np.testing.assert_allclose(met, expected, atol=0.005)
    assert np.abs(np.delete(balls - smooth, 2, axis=1)).max() < 1e-6


@pytest.mark.long
@pytest.mark.parametrize("freedoms", [2, 5])
def test_steps_from_python_are_those_of_the_loop(freedoms):
    """Tried, then accepted one by one: the same bits."""
    bearing = replace(OILED, features=[Spall(race="inner", angle=-pi / 2, length=2e-3, depth=2e-5), WAVES["ball"]])
    load = (0.0, -500.0) if freedoms == 2 else (50.0, -100.0, 300.0)
    q = OILED.equilibrium(load, speed_rpm=1500.0).displacement
    found = []
    for driven in (True, False):
        motion = BearingMotion(bearing, 1500.0, 2e-5, directions=FIVE[: q.size])
        motion.rest(q)
        still = np.zeros((200, q.size))
        if driven:
            found.append(motion.drive(q + still, still)[0])
            continue
        forces = []
        for _ in still:
            forces.append(motion.forces(q, still[0])[0])
            motion.accept()
        found.append(np.array(forces))
    np.testing.assert_array_equal(*found)
    assert np.ptp(found[0], axis=0)[:2].max() > 10.0


def test_a_mass_on_a_spall_feels_both_edges():
    """Steepest fall and rise of the force of a run, from the times of geometry to those at which bodies part."""
    length, speed, dt = 2e-3, 1800.0, 1e-5
    spall = Spall(race="outer", angle=-pi / 2, length=length, depth=5e-5)
    bearing = replace(DRY, clearance=5e-6, features=[spall])
    mount = BearingMount(bearing=bearing, x=0, y=1)
    rotor = Rotor(
        mass=np.diag([5.0, 5.0]), damping=np.diag([2e3, 2e3]), stiffness=np.zeros((2, 2)),
        load=(0.0, -500.0), mounts=(mount,),
    )  # fmt: skip
    run = simulate_rotor(rotor, speed_rpm=speed, dt=dt, until=0.02)
    cage, radius = bearing.orders.ftf_order * speed * pi / 30.0, track_radius(bearing, "outer")
    force = -run.force[:, 1]
    ball = 1  # the second passage, with the first ball starting over the spall
    middle = 2.0 * pi / bearing.balls * ball / cage
    edges = middle + np.array([-0.5, 0.5]) * length / (cage * radius)
    halves = [np.flatnonzero(np.abs(run.t - edge) < 0.5 * length / (cage * radius)) for edge in edges]
    slope = np.gradient(force, dt)
    found = run.t[[halves[0][np.argmin(slope[halves[0]])], halves[1][np.argmax(slope[halves[1]])]]]
    body = bearing.race("outer").geometry
    approach = 2.0 * hertz_contact(float(force.max()), body.radius_x, body.radius_y, body.e_reduced).approach
    behind = (found - edges) * [1.0, -1.0] * cage * radius
    assert (behind > 0.0).all() and (behind < sqrt(2.0 * body.radius_x * approach)).all()
    assert mount.cage_angle == pytest.approx(-pi / 2) and force.max() > 900.0


LOST = BallBearing.catalogue("6205", clearance="C3", oil=Lubricant.iso_vg(68, temperature=40.0))


@pytest.mark.long
@pytest.mark.parametrize(
    ("load", "length", "depth", "until"),
    [
        ((0.0, -100.0, 100.0), 1e-3, 2e-4, 0.094),  # a ball crosses a deep pit, 20 um from both races
        ((0.0, -500.0, 50.0), 2e-3, 2e-4, 1e-3),  # and stands in one at the start
    ],
)
def test_a_ball_that_a_pit_has_taken_from_both_races_is_found(load, length, depth, until):
    """Newton's method loses it, for the centrifugal force alone has no slope: runs ended there."""
    features = [Spall(race="outer", angle=-pi / 2, length=length, depth=depth)]
    mount = BearingMount(bearing=replace(LOST, features=features), x=0, y=1, z=2, tilt_x=3, tilt_y=4)
    rotor = Rotor(
        mass=np.diag([5.0, 5.0, 5.0, 1e-3, 1e-3]),
        stiffness=np.diag([0.0, 0.0, 0.0, 1e5, 1e5]),
        load=np.array([*load, 0.0, 0.0]),
        mounts=(mount,),
    )
    run = simulate_rotor(rotor, speed_rpm=1797.0, dt=1 / 48000, until=until)
    assert run.status == "converged" and run.t[-1] >= until


@pytest.mark.parametrize("freedoms", [2, 5])
def test_features_without_height_change_no_bit(freedoms):
    load = (0.0, -500.0) if freedoms == 2 else (50.0, -100.0, 300.0)
    runs = [
        held(one, load, 1500.0, 500, 0.2)
        for one in (OILED, replace(OILED, features=[BallDiameter(ball=0, excess=0.0)]))
    ]
    for smooth, featured in zip(*runs, strict=True):
        np.testing.assert_array_equal(smooth, featured)
    assert OILED.tables.heights.size == 0


def test_a_dent_of_a_film_is_no_feature_of_a_bearing():
    with pytest.raises(InputError, match="a dent of a race or a ball is an Indentation"):
        replace(BallBearing.catalogue("6205"), features=[Dent(depth=0.1, radius=0.5)])


def test_features_are_written_and_read_with_the_bearing(tmp_path):
    from ehlcontact import read, save

    bearing = replace(OILED, features=[*WAVES.values(), Spall(ball=1, angle=0.2, length=1e-3, depth=1e-5)])
    assert BallBearing.from_dict(bearing.to_dict()) == bearing
    assert read(save(bearing, tmp_path / "bearing.json")) == bearing
    assert OILED.to_dict()["features"] == [] and BallBearing.from_dict(OILED.to_dict()) == OILED


SPALL = {"race": "outer", "angle": 0.0, "length": 1e-3, "depth": 1e-5}


test_bad_input_is_one_line = refusals(
    (lambda: Spall(**{**SPALL, "race": None}), "race, ball = 'neither'"),
    (lambda: Spall(**SPALL, ball=2), "race, ball = 'both'"),
    (lambda: Spall(**{**SPALL, "race": "cage"}), "race = 'cage'"),
    (lambda: Spall(**{**SPALL, "angle": 90.0}), "angle = 90.0: .*degrees"),
    (lambda: Spall(**{**SPALL, "angle": float("nan")}), "angle = nan"),
    (lambda: Spall(**{**SPALL, "length": 0.0}), "length = 0.0"),
    (lambda: Spall(**{**SPALL, "depth": -1e-6}), "depth = -1e-06"),
    (lambda: Spall(**SPALL, edge=6e-4), "edge = 0.0006: .*half"),
    (lambda: Indentation(**SPALL, rim=-1e-6), "rim = -1e-06"),
    (lambda: replace(DRY, features=[Spall(**{**SPALL, "length": 0.2})]), "length = 0.2: .* outer race"),
    (lambda: replace(DRY, features=[Spall(**{**SPALL, "length": 1e-6})]), "length = 1e-06"),
    (lambda: replace(DRY, features=[Spall(**{**SPALL, "depth": 5e-3})]), "depth = 0.005: .* ball's radius"),
    (lambda: replace(DRY, features=[BallDiameter(ball=9, excess=1e-7)]), "ball = 9: must be from 0 to 8"),
    (
        lambda: replace(DRY, features=[BallDiameter(ball=3, excess=-8e-3)]),
        "excess = -0.008: .* between -7.94e-05",
    ),
    (lambda: replace(DRY, features=[BallDiameter(ball=3, excess=5e-3)]), "excess = 0.005: .*given in um"),
    (lambda: replace(DRY, features=[BallWaviness(ball=3, waves=2, amplitude=5e-3)]), "amplitude = 0.005"),
    (
        lambda: DRY.excitation([RaceWaviness(race="inner", waves=10, amplitude=5e-3)], (0.0, -100.0)),
        "amplitude = 0.005: must be at most 7.94e-05 m",
    ),
    (lambda: replace(DRY, features=[Indentation(**SPALL, rim=1e-3)]), "rim = 0.001: must be at most"),
    (lambda: replace(DRY, features=["spall"]), "features = 'spall'"),
    (
        lambda: replace(DRY, features=[RaceWaviness(race="inner", waves=5000, amplitude=1e-9)]),
        "waves = 5000: must be at most 4096",
    ),
    (
        lambda: replace(DRY, race_control="shared", features=[Spall(ball=2, angle=0.0, length=1e-3, depth=1e-5)]),
        "ball = 2: .*shared",
    ),
    (
        lambda: replace(DRY, features=[WAVES["inner"]]).equilibrium(AXIAL, shaft_angle=90.0),
        "shaft_angle = 90.0: .*radians",
    ),
    (
        lambda: BearingModel(replace(DRY, features=[WAVES["inner"]]), 1500.0),
        "bearing.features = 1: must be none",
    ),
    (lambda: BallBearing.from_dict({**DRY.to_dict(), "features": [{"kind": "Hole"}]}), r"features\[0\].kind"),
    (
        lambda: BallBearing.from_dict({**DRY.to_dict(), "features": [{"kind": "Spall", "size": 1}]}),
        r"features\[0\].size",
    ),
)
