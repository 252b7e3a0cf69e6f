"""Modes and responses over the speed; their files and figures."""

import pickle
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from ehlcontact import read, save
from ehlcontact.errors import ConvergenceError, InputError
from reduced_models import (
    Disc,
    Shaft,
    SpeedProfile,
    Support,
    campbell,
    linearise,
    rotor_on_bearings,
    simulate_rotor,
    unbalance_response,
)
from reduced_models.rotor.campbell import Campbell
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.picture import run_picture
from reduced_models.rotor.unbalance import amplification
from reduced_models.rotor.unbalance_result import UnbalanceResponse

SPEEDS = np.linspace(2000.0, 10000.0, 5)
PNG = b"\x89PNG"


@pytest.fixture(scope="module")
def diagram(film, beam):
    return campbell(beam(film), SPEEDS, count=4)


def test_columns_are_modes_of_the_speed(film, beam, diagram):
    assert diagram.omega.shape == diagram.growth.shape == diagram.whirl.shape == (5, 4)
    modes = linearise(beam(film), SPEEDS[3]).modes(8)
    for hz, decrement, whirl in zip(diagram.hz[3], diagram.decrement[3], diagram.whirl[3], strict=True):
        same = min(modes, key=lambda mode: abs(mode.hz - hz))
        assert (same.hz, same.decrement) == pytest.approx((hz, decrement), rel=1e-9)
        assert same.whirl == pytest.approx(whirl, abs=1e-9)


def test_from_rest_on_and_reversed(film, beam):
    """At rest bearings are dry and damp nothing; a reversed shaft has the modes mirrored, backward for forward."""
    found = campbell(beam(film), [-6000.0, 0.0, 6000.0], count=4)
    assert np.abs(found.decrement[1]).max() < 1e-12
    np.testing.assert_allclose(found.hz[1], campbell(beam(film.dry), [0.0], count=4).hz[0], rtol=1e-12)
    back, ahead = (found.hz[k, np.argsort(found.hz[k])] for k in (0, 2))
    np.testing.assert_allclose(back, ahead, rtol=1e-9)
    whirls = [found.whirl[k, np.argsort(found.hz[k])] for k in (0, 2)]
    np.testing.assert_allclose(whirls[0], -whirls[1], atol=1e-9)
    assert np.abs(whirls[0]).max() > 0.5


def test_a_speed_is_reversed_only_where_all_parts_are_symmetric(film, beam):
    rotor = beam(film)
    skew = np.zeros((rotor.size, rotor.size))
    skew[0, 1], skew[1, 0] = 1e6, -1e6
    linear = LinearBearing(1e8 * np.eye(2), np.eye(2))
    coupled = replace(rotor, stiffness=rotor.stiffness + skew)
    held = replace(rotor, mounts=[replace(mount, bearing=linear) for mount in rotor.mounts])
    for one_way in (coupled, held):
        with pytest.raises(InputError, match=r"speed_rpm = -3000.0: must be >= 0 .* one direction"):
            linearise(one_way, -3000.0)


def test_modes_are_followed_through_crossings(diagram):
    """The disc's backward whirl falls through both modes of bending, its forward whirl rises."""
    order = [np.argsort(row).tolist() for row in diagram.hz]
    assert order[0] == [0, 1, 2, 3] and order[-1] == [2, 0, 1, 3]
    assert np.all(np.diff(diagram.hz[:, 2]) < 0.0) and np.all(np.diff(diagram.hz[:, 3]) > 0.0)
    assert np.abs(diagram.whirl[:, :2]).max() < 0.05  # these bend to and fro, hardly changed by the speed
    assert diagram.whirl[-1, 2] < -0.9 and diagram.whirl[-1, 3] > 0.9


def test_critical_speeds_lie_where_a_mode_has_the_frequency_of_the_order(film, beam, diagram):
    bpfo = film.orders.bpfo_order
    found = diagram.critical_speeds(bpfo)
    assert [one.mode for one in found[:2]] == [0, 1]
    assert [one.speed_rpm for one in found] == sorted(one.speed_rpm for one in found)
    for one in found:
        assert one.hz == pytest.approx(bpfo * one.speed_rpm / 60.0, rel=1e-9)
    at = linearise(beam(film), found[0].speed_rpm).modes(1)[0]
    assert at.hz == pytest.approx(found[0].hz, rel=2e-3)  # straight between speeds 2000 rev/min apart
    assert diagram.critical_speeds(0.01) == ()


def test_no_critical_speed_has_the_range_that_was_searched(diagram):
    low, high = diagram.hz.min(), diagram.hz.max()
    none = diagram.critical_speeds(0.01)
    assert isinstance(none, tuple) and none == ()
    assert none.searched.startswith(f"between 2000 and 10000 rev/min: of 4 modes at {low:.4g}")
    assert "4 stay above 0.01 times the speed, 0.3333 to 1.667 Hz, and 0 below" in none.searched
    assert repr(none) == f"() no critical speed {none.searched}"
    beyond = diagram.critical_speeds(2.0 * 60.0 * high / SPEEDS[0])
    assert beyond == () and "0 stay above" in beyond.searched and beyond.searched.endswith("and 4 below")
    slow = replace(diagram, speed_rpm=diagram.speed_rpm / 1000.0)
    assert "above the speed, 0.03333 to 0.1667 Hz, and 0 below" in slow.critical_speeds().searched
    assert "no critical speed among them: 4 modes stay above the speed, 0 below" in repr(slow)
    some = diagram.critical_speeds(60.0 * np.median(diagram.hz) / SPEEDS[2])
    assert some and repr(some) == repr(tuple(some))
    assert pickle.loads(pickle.dumps(none)).searched == none.searched


@pytest.mark.long
def test_a_run_up_resonates_where_balls_pass_at_the_frequency_of_a_mode(film, beam, diagram):
    """Faster and faster balls: the largest swing comes a little after the crossing."""
    rotor, window = beam(film, unbalances=()), np.ones(400) / 400.0
    course = SpeedProfile(np.array([0.0, 2.0]), np.array([3000.0, 5000.0]))
    run = simulate_rotor(rotor, speed_rpm=course, dt=5e-5, until=2.0)
    for direction, one in enumerate(diagram.critical_speeds(film.orders.bpfo_order)[:2]):
        swing = run.displacement[:, 12 + direction]
        swing = np.convolve((swing - np.convolve(swing, window, "same")) ** 2, window, "same")[1000:-1000]
        peak = run.speed_rpm[1000:-1000][np.argmax(swing)]
        assert swing.max() > 6.0 * np.median(swing)
        assert 1.0 < peak / one.speed_rpm < 1.04


def test_tables_of_an_unbalance_response_have_names_and_units(dry, block):
    pytest.importorskip("pandas", reason="pandas is not installed: pip install 'ehlcontact[tables]'")
    rotor = block(dry, mass=200.0, damping=1e3 * np.eye(2))
    found = unbalance_response(rotor, [3000.0, 4000.0, 5000.0])
    named = replace(found, names=("drive end",) * len(found.nodes))
    x, y = found.nodes[0].tolist()
    for response, name in ((found, found.names[0] or "node_0"), (named, "drive_end")):
        table = response.to_pandas()
        assert table.index.name == "speed_rpm [rev/min]"
        waves = [f"{wave}_{name}_{axis} [m]" for axis in "xy" for wave in ("cosine", "sine")]
        assert list(table.columns) == [f"major_{name} [m]", *waves]
        assert np.array_equal(table[f"sine_{name}_y [m]"], found.sine[:, y])
        assert np.array_equal(table[f"cosine_{name}_x [m]"], found.cosine[:, x])
        assert table.attrs["result"] == "UnbalanceResponse"


@pytest.mark.long
def test_unbalance_peaks_at_the_critical_speed(dry, block):
    """A block that its bearing lets swing at about 100 Hz."""
    rotor = block(dry, mass=200.0, damping=1e3 * np.eye(2))
    speeds = np.linspace(3000.0, 12000.0, 121)
    peak = unbalance_response(rotor, speeds)
    critical = campbell(rotor, speeds[::10], count=2).critical_speeds()
    assert len(critical) == 2
    places = peak.peaks()
    assert len(places) == 2
    np.testing.assert_allclose(places, [one.speed_rpm for one in critical], rtol=0.015)


def test_response_over_the_speed_is_that_at_each_speed(film, beam):
    rotor = beam(film)
    found = unbalance_response(rotor, [2000.0, 3000.0])
    assert found.names == ("", "", "")
    at = linearise(rotor, 3000.0).unbalance_response(rpm=3000.0).amplitude[0]
    np.testing.assert_allclose(found.amplitude[1], at, rtol=1e-12)
    assert found.nodes.tolist() == [[4, 5], [20, 21], [12, 13]]
    t = np.linspace(0.0, 0.02, 2001)  # a turn
    q = np.real(at[[12, 13], None] * np.exp(1j * 100.0 * np.pi * t))
    assert found.major[1, 2] == pytest.approx(np.hypot(*q).max(), rel=1e-4)
    w = 3000.0 * np.pi / 30.0
    shown = found.cosine[1, 12] * np.cos(w * t) + found.sine[1, 12] * np.sin(w * t)
    np.testing.assert_allclose(shown, q[0], atol=1e-12 * np.abs(q[0]).max())


def test_files(film, block, diagram, tmp_path):
    again = read(save(diagram, tmp_path / "c.h5"), Campbell)
    response = unbalance_response(block(film), [2000.0, 3000.0, 4000.0])
    back = read(save(response, tmp_path / "u.h5"), UnbalanceResponse)
    for one, two in ((diagram, again), (response, back)):
        for name, values in vars(one).items():
            np.testing.assert_array_equal(getattr(two, name), values)
    with pytest.raises(InputError, match="Campbell diagram"):
        read(tmp_path / "u.h5", Campbell)


@pytest.mark.long
def test_figures(film, block, diagram, tmp_path):
    diagram.plot(tmp_path / "c.png")
    unbalance_response(block(film), [2000.0, 3000.0, 4000.0]).plot(tmp_path / "u.png")
    course = SpeedProfile(np.array([0.0, 0.05]), np.array([2000.0, 4000.0]))
    for speed in (3000.0, course):
        run = simulate_rotor(block(film), speed_rpm=speed, dt=5e-5, until=0.05)
        for kind in ("orbit", "spectrum", "waterfall"):
            figure = run.plot(tmp_path / f"{kind}.png", kind=kind)
            assert kind in figure.get_suptitle()
            assert (tmp_path / f"{kind}.png").read_bytes().startswith(PNG)
    for name in ("c", "u"):
        assert (tmp_path / f"{name}.png").read_bytes().startswith(PNG)


def test_figures_of_a_named_node(film, block):
    rotor = replace(block(film), nodes={"block": {"x": 0, "y": 1}})
    run = simulate_rotor(rotor, speed_rpm=3000.0, dt=5e-5, until=0.05)
    for node in ("block", (0, 1)):
        figure = run.plot(kind="orbit", node=node)
        assert figure.axes[0].get_title() == "block"
        np.testing.assert_array_equal(figure.axes[0].lines[0].get_xdata()[-1], run.displacement[-1, 0] * 1e6)
    with pytest.raises(InputError, match=r"node = 'disc'.*one of block"):
        run.plot(node="disc")
    with pytest.raises(InputError, match=r"node = 'disc'.*one of block"):
        rotor.nodes["disc"]
    assert "disc" not in rotor.nodes and rotor.nodes.get("disc") is None


def test_lines_of_a_spectrum_are_the_amplitudes(film, block):
    """A ring that is made to swing by 2 um at 400 Hz."""
    run = simulate_rotor(block(film), speed_rpm=3000.0, dt=5e-5, until=0.1)
    swing = np.zeros_like(run.ring)
    swing[:, 0, 0] = 2e-6 * np.sin(2.0 * np.pi * 400.0 * run.t)
    figure = type(run)(**(vars(run) | {"approach": (swing + 1e-5).reshape(swing.shape[0], -1)})).plot(
        kind="spectrum"
    )
    line = figure.axes[0].lines[0]
    top = np.argmax(line.get_ydata())
    assert line.get_xdata()[top] == pytest.approx(400.0, abs=20.0)
    assert line.get_ydata()[top] == pytest.approx(2.0, rel=0.05)


def test_a_line_that_follows_the_speed_is_sharp_in_a_waterfall(film, block):
    """Unit amplitude once per turn: it stands at the speed of its row, most of it in four lines."""
    course = SpeedProfile.ramp(2000.0, 5000.0, 1.0)
    run = simulate_rotor(block(film), speed_rpm=course, dt=1e-4, until=1.0)
    swing = np.zeros_like(run.ring)
    swing[:, 0, 1] = 1e-6 * np.sin(course.at(run.t)[1])
    (shown,) = run_picture(run, "waterfall", (None, 1000.0), [("y", swing[:, 0])]).panels
    (frequency, _), (middle, label), (level, _) = shown.x, shown.y, shown.values
    rows = 10.0**level.T
    assert label == ("speed", "rev/min")
    line = frequency[1] - frequency[0]
    assert line < 10.0
    np.testing.assert_allclose(frequency[rows.argmax(axis=1)], middle / 60.0, atol=line)
    assert np.all(rows.max(axis=1) > 0.6)
    assert np.all((rows > 0.3 * rows.max(axis=1, keepdims=True)).sum(axis=1) <= 4)


def test_another_node_than_the_rings(film, beam, tmp_path):
    run = simulate_rotor(beam(film), speed_rpm=3000.0, dt=5e-5, until=0.02)
    figure = run.plot(tmp_path / "disc.png", node=(12, 13))
    (axes,) = figure.axes
    assert axes.get_title() == "degrees of freedom 12, 13"
    np.testing.assert_allclose(axes.lines[0].get_xydata()[-1], run.displacement[-1, 12:14] * 1e6)
    for node in ((12, 28), (12,), (12, 13.5)):
        with pytest.raises(InputError, match="node"):
            run.plot(node=node)


@pytest.mark.parametrize(
    ("call", "match"),
    [
        (lambda rotor, path: campbell(rotor, [3e3, 2e3]), r"speeds_rpm\[1\] = 2000.0: must be above"),
        (lambda rotor, path: campbell(rotor, [3000.0], count=0), r"count = 0: must be a whole number >= 1"),
        (lambda rotor, path: campbell(rotor, [3000.0], count=3).plot(path / "no" / "c.png"), "no"),
        (lambda rotor, path: unbalance_response(rotor, [3e4]), r"speed_rpm = 30000.0: must be at most"),
        (lambda rotor, path: unbalance_response(rotor, [0.0, 1e3]), r"speeds_rpm\[0\] = 0.0: must be > 0"),
        (lambda rotor, path: unbalance_response(rotor, [2e3]).peaks(5), r"node = 5: must be from 0 to 0"),
        (
            lambda rotor, path: campbell(rotor, [2e3]).critical_speeds(0.0),
            r"order = 0.0: must be a finite number > 0",
        ),
    ],
)
def test_bad_input(film, block, tmp_path, call, match):
    with pytest.raises(InputError, match=match):
        call(block(film), tmp_path)


def test_bad_figures(film, block):
    run = simulate_rotor(block(film), speed_rpm=3000.0, dt=5e-5, until=2e-3)
    with pytest.raises(InputError, match=r"kind = 'orbits': must be one of histories, orbit, spectrum, waterfall"):
        run.plot(kind="orbits")
    with pytest.raises(InputError, match="most_hz"):
        run.plot(kind="spectrum", most_hz=0.0)
    short = simulate_rotor(block(film), speed_rpm=3000.0, dt=5e-5, until=2e-4)
    with pytest.raises(InputError, match="at least 16"):
        short.plot()


def test_a_mode_that_stops_to_oscillate(film, block, monkeypatch):
    """Damped far beyond critical damping at the second speed: dampers that know the speed, say."""
    module = import_module("reduced_models.rotor.campbell")
    damped = block(film, damping=np.diag([0.0, 1.5e5]))
    (left,) = linearise(damped, 3000.0).modes()
    assert abs(left.shape[0]) == pytest.approx(1.0, rel=1e-12)
    monkeypatch.setattr(
        module, "linearise", lambda rotor, rpm, **how: linearise(damped if rpm > 300.0 else rotor, rpm, **how)
    )
    with pytest.raises(ConvergenceError, match=r"only 1 of 2 modes oscillate at 3000 rev/min: ask for fewer"):
        campbell(block(film), [300.0, 3000.0])


def test_no_unbalance(film, block):
    with pytest.raises(InputError, match=r"unbalances = \(\): must be at least one"):
        unbalance_response(block(film, unbalances=()), [2e3])


def test_one_speed_has_no_critical_speeds(film, beam):
    """An empty answer would read as if there were none."""
    at_one = campbell(beam(film), [3000.0], count=2)
    with pytest.raises(InputError, match=r"speeds_rpm = \[\d+.0\]: must be at least two"):
        at_one.critical_speeds()


@pytest.mark.parametrize("upright, low, high", [(5e7, 0.0, 1e-6), (3e7, 30.0, 100.0)])
def test_unbalance_excites_a_backward_mode_on_supports_that_differ_in_x_and_y(upright, low, high):
    bearing = LinearBearing(np.diag([5e7, upright]), np.diag([200.0, 200.0]))
    disc = Disc.cylinder(position=0.12, diameter=0.2, width=0.03, bore=0.03, unbalance=1e-5)
    supports = [Support(position=place, bearing=bearing) for place in (0.0, 0.4)]
    linear = linearise(
        rotor_on_bearings(Shaft(length=0.4, diameter=0.03), discs=[disc], supports=supports), 6000.0
    )
    backward, forward = linear.modes(2)
    assert backward.whirl < -0.8 and forward.whirl > 0.8
    assert low <= amplification(linear, backward) <= high and amplification(linear, forward) > 1e3
    below, peak = linear.unbalance_response(omega=backward.omega * np.array([0.98, 1.0])).major.max(axis=1)
    assert (peak > 10.0 * below) == (amplification(linear, backward) > 1.0)
