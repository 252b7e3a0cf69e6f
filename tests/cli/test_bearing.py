"""``ehlcontact bearing``: numbers of the library; files and options; mistakes in one line."""

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from ehlcontact import Lubricant
from ehlcontact.lubricant import LimitingShear
from reduced_models import BallBearing, Spall
from reduced_models.bearing.measured_order import angle_from_order, clearance_from_order
from reduced_models.bearing.sliding import bearing_friction
from reduced_models.rotor.machine_state import single_bearing_state

EXAMPLE = Path(__file__).parents[2] / "examples" / "bearing_6205.toml"
OIL = ("--oil", "68", "--temp", "50")

NAME = 'bearing = "6205"'
SIZES = "balls = {}\nball_diameter_mm = {}\npitch_diameter_mm = 39"


@pytest.fixture
def file(tmp_path):
    """``file(**{old: new})``: the example with some of its text changed."""

    def write(changes=()):
        text = EXAMPLE.read_text()
        for old, new in dict(changes).items():
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "b.toml"
        path.write_text(text)
        return path

    return write


def test_json_is_what_the_library_has(call):
    clean = ("--contamination", "0.5", "--reliability", "95")
    speeds = ("--speed-rpm", "3000", "--speed-rpm", "1000")
    result = call("bearing", "6205", *OIL, "--rq", "0.1", "--load", "1000", *speeds, *clean, "--json", "-")
    assert result.code == 0 and result.err == ""
    found = json.loads(result.out)
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0), rq_race=0.1e-6)
    assert found["speed_rpm"] == [1000.0, 3000.0] and found["highest_speed_rpm"] == bearing.highest_speed
    for k, speed in enumerate(found["speed_rpm"]):
        at = bearing.coefficients((0.0, -1000.0), speed_rpm=speed, rpm=speed)
        np.testing.assert_array_equal(found["coefficients"][k]["stiffness"], at.stiffness[0])
        np.testing.assert_array_equal(found["coefficients"][k]["damping"], at.damping[0])
        assert found["coefficients"][k]["frequency_hz"] == pytest.approx(speed / 60.0)
        np.testing.assert_array_equal(found["coefficients"][k]["mean_displacement"], at.displacement)
        state = bearing.equilibrium((0.0, -1000.0), speed_rpm=speed)
        assert found["states"][k]["rolling_torque"] == state.rolling_torque
        for name in ("force", "h_min", "lambda_ratio", "angles", "moment"):
            np.testing.assert_array_equal(found["states"][k][name], getattr(state, name))
        assert found["frequencies_hz"][k]["bpfo"] == bearing.frequencies(speed).bpfo
        life = state.life(contamination=0.5, reliability=95.0).to_dict() | {"name": "6205"}
        assert found["life"][k]["bearings"] == [life]
        assert found["life"][k]["lnmrh"] == pytest.approx(life["lnmrh"], rel=1e-12)
        assert {"l10rh", "equivalent_load", "viscosity_ratio", "a_iso", "least_load"} <= life.keys()
    assert found["orders"]["bpfi_order"] == pytest.approx(5.4152, abs=1e-4)


def test_the_answer_begins_with_the_tiles_of_the_library(call):
    """Those of a machine of one support, at rest too."""
    speeds = ("--speed-rpm", "3000", "--speed-rpm", "6000")
    given = ("bearing", "6205", *OIL, "--rq", "0.1", "--load", "1000", *speeds)
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0), rq_race=0.1e-6)
    lines, found = call(*given).out.splitlines(), json.loads(call(*given, "--json", "-").out)["tiles"]
    for k, speed in enumerate((3000.0, 6000.0)):
        tiles = single_bearing_state(bearing, (0.0, -1000.0), speed).tiles()
        assert found[k] == [tile._asdict() for tile in tiles] and len(tiles) >= 5
        first = next(n for n, line in enumerate(lines) if line.startswith(f"at {speed:.0f} rpm")) + 1
        assert lines[first].startswith("smallest film") and tiles[0].value in lines[first]
    (still,) = json.loads(call("bearing", "6205", "--load", "1000", "--speed-rpm", "0", "--json", "-").out)[
        "tiles"
    ]
    dry = single_bearing_state(BallBearing.catalogue("6205"), (0.0, -1000.0), 0.0).tiles()
    assert still == [tile._asdict() for tile in dry] and still[0]["name"] == "largest ball load"


def test_rating_life_with_a_contamination(call):
    """The modified one, of the library, and the basic one without."""
    given = ("bearing", "6205", *OIL, "--rq", "0.1", "--load", "1000", "--speed-rpm", "3000", "--json", "-")
    more = ("--contamination", "normal cleanliness", "--reliability", "95")
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0), rq_race=0.1e-6)
    state = bearing.equilibrium((0.0, -1000.0), speed_rpm=3000.0)
    for options, life in (
        ((), state.life().l10rh),
        (more, state.life(contamination="normal cleanliness", reliability=95.0).lnmrh),
    ):
        tiles = {tile["name"]: tile for tile in json.loads(call(*given, *options).out)["tiles"][0]}
        assert float(tiles["rating life"]["value"]) == pytest.approx(life, rel=5e-3)


def test_an_entry_of_a_bearing_has_its_option(call):
    """Grooves, oil and losses of a bearing by its name, with the numbers of the library."""
    given = ("--conformity", "0.515", "--eta0", "0.03", "--alpha", "2e-8", "--loss-factor", "0.01")
    at = ("--load", "500", "--speed-rpm", "3000", "--json", "-")
    found = json.loads(call("bearing", "6205", *given, *at).out)
    oil = Lubricant(eta0=0.03, alpha=2e-8)
    own = BallBearing.catalogue("6205", oil=oil, conformity_inner=0.515, conformity_outer=0.515, loss_factor=0.01)
    state = own.equilibrium((0.0, -500.0), speed_rpm=3000.0)
    np.testing.assert_allclose(found["states"][0]["h_min"], state.h_min, rtol=1e-12)
    assert found["bearing"]["conformity_inner"] == 0.515 and found["bearing"]["loss_factor"] == 0.01


def test_a_study_is_a_file_of_its_bearing(call, refused, file):
    """One speed or several, one load."""
    alone = json.loads(call("bearing", file({"[1000, 3000, 6000]": "3000"}), "--json", "-").out)
    assert alone["speed_rpm"] == [3000.0]
    several = file({"radial_load = 1000.0": "radial_load = [500.0, 1000.0]"})
    refused(("operation.radial_load = [500.0, 1000.0]", "one load here"), "bearing", several)
    last_week = file({"[[support]]": "[bearing]", NAME: 'catalogue = "6205"'})
    refused(("bearing", "[[support]] for the bearing"), "bearing", last_week)


@pytest.mark.parametrize(("given", "shown"), [("CN", "12.5 µm"), ("c3", "20.5 µm"), ("-2.5", "-2.5 µm")])
def test_clearance_by_number_or_class(call, given, shown):
    result = call("bearing", "6205", "--load", "500", "--speed-rpm", "0", "--clearance", given)
    assert result.code == 0 and shown in next(line for line in result.out.splitlines() if "clearance" in line)


def test_numbers_of_the_table(call):
    result = call("bearing", "6205", *OIL, "--rq", "0.1", "--load", "1000", "--speed-rpm", "3000")
    assert result.code == 0
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    at = bearing.coefficients((0.0, -1000.0), speed_rpm=3000.0, rpm=3000.0)
    for number in (at.stiffness[0, 1, 1] * 1e-6, at.damping[0, 0, 0], bearing.frequencies(3000.0).bpfo):
        assert f"{number:.4g}" in result.out
    for name, hz, order in (
        ("BPFO", "179.2", "3.5848"),
        ("BPFI", "270.8", "5.4152"),
        ("FTF", "19.92", "0.39831"),
        ("BSF", "117.8", "2.3567"),
    ):
        line = next(line for line in result.out.splitlines() if line.startswith(name))
        assert line.split()[1:6] == [hz, "Hz", order, "per", "turn:"]
    assert "lambda" in result.out and "320" in result.out and "21600 rev/min" in result.out
    assert any(line.split()[:4] == ["all", "at", "50", "Hz"] for line in result.out.splitlines())
    moved = next(line for line in result.out.splitlines() if line.startswith("along the load"))
    assert f"y = {1e6 * at.displacement[1]:.4g} µm" in moved


def test_the_torque_by_skf_stands_beside_that_of_the_films(call):
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    for speed in 3000.0, 6000.0:
        shown = call("bearing", "6205", *OIL, "--load", "1000", "--speed-rpm", f"{speed:.0f}").out
        line = next(line for line in shown.splitlines() if line.startswith("friction by SKF"))
        assert f"{1e3 * bearing.equilibrium((0.0, -1000.0), speed_rpm=speed).skf_torque:.4g} N mm" in line
        words = " ".join(shown.split())
        assert ("by SKF's model" in words) == (speed > 5000.0)
        other = "films and sliding, which count up to" if speed > 5000.0 else "SKF's model, which counts above"
        assert f"{other} 5000 rev/min: " in words


@pytest.mark.parametrize("more", [(), ("--axial", "500")], ids=["radial", "combined"])
def test_sliding_moment_beside_that_of_skf(call, more):
    given = ("bearing", "6205", *OIL, "--load", "1000", *more, "--speed-rpm", "3000")
    oil, load = Lubricant.iso_vg(68, temperature=50.0), (0.0, -1000.0, *map(float, more[1:]))
    at = bearing_friction(BallBearing.catalogue("6205", oil=oil), load, speed_rpm=3000.0, law=LimitingShear(0.07))
    found = json.loads(call(*given, "--json", "-").out)["friction"][0][0]
    assert [found[name] for name in ("rolling", "sliding", "skf_sliding")] == [
        at.rolling,
        at.sliding,
        at.skf_sliding,
    ]
    shown = " ".join(call(*given).out.split())
    line = shown[shown.index("sliding in contacts") : shown.index("FTF")]
    assert f"{1e3 * at.sliding:.4g} N mm" in line and f"and {1e3 * at.skf_sliding:.4g} N mm" in line


@pytest.mark.long
def test_sliding_moment_of_a_pair_is_that_of_both(call):
    given = ("bearing", "7205", *OIL, "--pair", "back-to-back", "--preload", "300", "--speed-rpm", "3000")
    both = json.loads(call(*given, "--json", "-").out)["friction"][0]
    assert both[0]["sliding"] > 0.0 and both[1]["sliding"] == pytest.approx(both[0]["sliding"], rel=1e-6)
    assert f"{2e3 * both[0]['sliding']:.4g} N mm" in call(*given).out


def test_a_dry_bearing_has_no_film_and_no_highest_speed(call):
    at = ("bearing", "209", "--load", "8900", "--speed-rpm", "0", "--clearance", "15")
    result = call(*at)
    assert result.code == 0 and "\n  dry\n" in result.out and "film" not in result.out
    found = json.loads(call(*at, "--json", "-").out)
    assert found["highest_speed_rpm"] is None and not np.any(found["coefficients"][0]["damping"])


@pytest.mark.long
def test_a_file_and_options_that_stand_in_for_its_entries(call, file):
    alone = json.loads(call("bearing", EXAMPLE, "--json", "-").out)
    assert alone["load"] == 1000.0 and alone["speed_rpm"] == [1000.0, 3000.0, 6000.0]
    assert alone["states"][0]["lambda_ratio"] is not None
    hot = json.loads(call("bearing", EXAMPLE, "--temp", "80", "--load", "500", "--json", "-").out)
    assert hot["load"] == 500.0 and hot["bearing"]["oil"]["eta0"] < 0.5 * alone["bearing"]["oil"]["eta0"]
    sizes = 'balls = 9\nball_diameter_mm = 7.94004\npitch_diameter_mm = 39.0398\nname = "mine"'
    own = json.loads(call("bearing", file({'bearing = "6205"': sizes}), "--json", "-").out)
    np.testing.assert_allclose(
        own["coefficients"][0]["stiffness"], alone["coefficients"][0]["stiffness"], rtol=1e-6, atol=1.0
    )
    assert own["bearing"]["name"] == "mine"
    heavy = json.loads(call("bearing", file({"# ball_inertia": "ball_inertia"}), "--json", "-").out)
    assert heavy["bearing"]["ball_inertia"] is True and alone["bearing"]["ball_inertia"] is False


def test_every_entry_with_a_unit_is_there_and_zero_has_no_sign(call):
    result = call("bearing", "6205", *OIL, "--rq", "0.1", "--load", "0", "--speed-rpm", "3000", "--json", "-")
    found = json.loads(result.out)
    assert found["coefficients"][0]["frequency_hz"] == 50.0
    inner = found["coefficients"][0].keys() | found["states"][0].keys()
    assert found["units"].keys() <= found.keys() | inner
    assert "-0 " not in call("bearing", "6205", *OIL, "--load", "0", "--speed-rpm", "3000").out


@pytest.mark.parametrize(
    ("speeds", "oil"), [(("3000",), OIL), pytest.param(("500", "6000"), OIL, marks=pytest.mark.long), (("0",), ())]
)
def test_a_figure(call, tmp_path, speeds, oil):
    chosen = [part for speed in speeds for part in ("--speed-rpm", speed)]
    result = call("bearing", "6205", *oil, "--load", "500", *chosen, "--figure", tmp_path / "b.png")
    assert result.code == 0 and (tmp_path / "b.png").read_bytes().startswith(b"\x89PNG")


def test_curves_pass_through_the_points():
    from ehlcontact.cli.commands.bearing import curve
    from ehlcontact.cli.study.bearing import load_job
    from reduced_models.bearing.picture import over_speed_picture

    entries = {"operation.radial_load": 500.0, "operation.speed_rpm": [1000.0, 4000.0]}
    job = load_job("6205", entries | {"oil.iso_vg": 68, "oil.temperature": 50.0})
    at = tuple(job.bearing.coefficients((0, -500), speed_rpm=s, rpm=s) for s in job.speeds)
    state = job.bearing.equilibrium((0, -500), speed_rpm=job.speeds[1])
    lines = over_speed_picture(state, at, curve(job)).panels[3].lines
    for curve_of, points in (lines[:2], lines[2:4]):
        np.testing.assert_allclose(np.array(curve_of.y)[[0, -1]], points.y, rtol=1e-9)
    np.testing.assert_allclose(lines[0].y[0], at[0].damping[0, 1, 1])


@pytest.mark.parametrize(
    ("changes", "words"),
    [  # of the text of the example
        ({NAME: SIZES.format(20, 7.94)}, ("support.balls = 20", "at most 15", "overlap")),
        ({NAME: SIZES.format(9, 0.0079)}, ("support.ball_diameter_mm", "in m? then 7.9 mm")),
        ({NAME: ""}, ("support.balls = None", 'bearing = "6205"')),
        ({NAME: 'bearing = "620"'}, ("support.bearing = '620'", "nearest", "6208")),
        ({"inner = 0.52": "inner = 0.5"}, ("support.conformity_inner = 0.5", "between 0.501")),
        ({"inner = 0.52": "inner = 0.502"}, ("support.conformity_inner = 0.502", "outside the atlas")),
        ({"clearance = 0": "clearances = 0"}, ("support.clearances = 0.0", "clearance?")),
        ({"clearance = 0.0": "loss_factor = 0.3"}, ("support.loss_factor = 0.3", "at most 0.2")),
        ({"e = 0.0": "e = -500.0"}, ("support.clearance = -500", "between -397 and 397 um")),
        ({"[1000, 3000, 6000]": "[3000, 3000]"}, ("operation.speed_rpm = 3000", "once in its list")),
        ({"[1000, 3000, 6000]": "[]"}, ("operation.speed_rpm", "a list of 1 to 100")),
        ({"[1000, 3000, 6000]": "[0]"}, ("operation.speed_rpm = 0.0", "no film")),
        ({"[1000, 3000, 6000]": "[30000]"}, ("operation.speed_rpm = 30000.0", "at most 2")),
        ({"radial_load = 1000.0 ": ""}, ("operation.radial_load = None", "or --load")),
        ({"radial_load": "thrust"}, ("operation.thrust = 1000.0", "left out")),
        ({"radial_load = 1000.0": "radial_load = true"}, ("operation.radial_load = True", "a number")),
        ({"radial_load = 1000.0": "radial_load = 1e7"}, ("operation.radial_load = 10000000.0", "the atlas")),
        ({"iso_vg = 68": "iso_vg = 68\neta0 = 0.03"}, ("oil.iso_vg = 68", "by its grade")),
        ({"rq_ball_um = 0.02": "rq_um = 0.1"}, ("surface.rq_race_um", "left out where surface.rq_um")),
        ({"[operation]": "[operation"}, ("file", "complete TOML")),
    ],
)  # fmt: skip
def test_mistakes_in_a_file(refused, file, changes, words):
    refused(("b.toml", *words), "bearing", file(changes))


@pytest.mark.parametrize("option", ["--speed-rpm", "--hz"])
def test_numbers_that_are_nearly_the_same(refused, option):
    more = () if option == "--speed-rpm" else ("--speed-rpm", "3000")
    given = (option, "50", option, "50.0000001")
    refused((f"{option} = 50.0000001", "further from 50.0"), "bearing", "6205", "--load", "100", *more, *given)


@pytest.mark.parametrize("film", [("--speed-rpm", "0"), (*OIL, "--speed-rpm", "3000")])
def test_a_load_beyond_all_balls_says_the_largest(refused, film):
    words = "--load, --axial = (1000000.0, 100.0)", "a ball carries at most", "1.111e+05 N in the mean of all"
    refused(words, "bearing", "6205", "--axial", "100", "--load", "1e6", *film)


def test_a_machine_is_no_bearing(refused):
    study = EXAMPLE.with_name("small_study.toml")
    refused(("shaft", "`ehlcontact run` is for a machine"), "bearing", study)


def test_nothing_takes_the_place_of_the_file(refused, file):
    path = file()
    refused(("--json", "which is read"), "bearing", path, "--json", path)
    assert path.read_text() == EXAMPLE.read_text()


def test_what_the_films_assume_and_does_not_hold_stands_in_the_answer(call):
    """30 000 rev/min in VG 68: formulas take half of the film away."""
    shown = call("bearing", "6205", *OIL, "--load", "1000", "--speed-rpm", "3000", "--speed-rpm", "20000").out
    slow, fast = shown.split("at 20000 rpm")
    assert "NOT AS ASSUMED" in fast and "isothermal: shear heats" in fast and "NOT AS ASSUMED" not in slow
    document = json.loads(
        call("bearing", "6205", *OIL, "--load", "1000", "--speed-rpm", "20000", "--json", "-").out
    )
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    state = bearing.equilibrium((0.0, -1000.0), speed_rpm=20000.0)
    assert document["states"][0]["outside_assumptions"] == state.outside_assumptions != ""


@pytest.mark.parametrize("command", [("steady",), ("element",)])
@pytest.mark.parametrize("option", ["--axial", "--preload", "--contact-angle", "--tilt", "--starvation"])
def test_what_is_not_in_the_model_is_said_in_one_line(call, command, option):
    for given in ((option, "100"), (f"{option}=100",)):
        result = call(*command, *OIL, *given)
        assert result.code == 2 and result.out == "" and len(result.err.splitlines()) == 1
        why = f"no option of `{command[0]}`" if option == "--starvation" else "not in the model"
        assert f"{option}: {why}; " in result.err
    assert ("--clearance" in result.err) == (option == "--preload")


def test_the_help_says_first_what_is_in_the_model(call):
    lines = call("bearing", "--help").out.splitlines()
    first = " ".join(lines[: next(k for k, line in enumerate(lines) if "Arguments" in line)])
    assert "In the model: radial and axial load" in first and "Not in it: flexible" in first


LOAD = "--radial", "100", "--axial", "200"


def test_json_of_an_axial_load_is_what_the_library_has(call):
    speeds = ("--speed-rpm", "6000", "--hz", "100", "--hz", "900")
    result = call("bearing", "7205", *OIL, *LOAD, *speeds, "--json", "-")
    assert result.code == 0 and result.err == ""
    found = json.loads(result.out)
    bearing = BallBearing.catalogue("7205 A", oil=Lubricant.iso_vg(68, temperature=50.0))
    at = bearing.coefficients((0.0, -100.0, 200.0), speed_rpm=6000.0, hz=(100.0, 900.0))
    state = bearing.equilibrium((0.0, -100.0, 200.0), speed_rpm=6000.0)
    assert (found["load"], found["axial_load"], found["moments"], found["tilt"]) == (100.0, 200.0, None, None)
    for k, hz in enumerate((100.0, 900.0)):
        assert found["coefficients"][k]["frequency_hz"] == pytest.approx(hz)
        np.testing.assert_array_equal(found["coefficients"][k]["stiffness"], at.stiffness[k])
        np.testing.assert_array_equal(found["coefficients"][k]["damping"], at.damping[k])
    for name in ("force", "h_min", "contact_angles", "spin_to_roll", "displacement"):
        np.testing.assert_array_equal(found["states"][0][name], getattr(state, name))
    assert found["orders_under_load"][0]["bpfo_order"] == state.orders.bpfo_order != found["orders"]["bpfo_order"]
    assert found["frequencies_hz"][0]["bpfo"] == pytest.approx(state.orders.bpfo_order * 100.0)
    inner = found["coefficients"][0].keys() | found["states"][0].keys()
    assert found["units"].keys() <= found.keys() | inner


def test_table_of_an_axial_load(call):
    result = call("bearing", "7205c", *LOAD, "--speed-rpm", "6000")
    assert result.code == 0
    bearing = BallBearing.catalogue("7205 C")
    state = bearing.equilibrium((0.0, -100.0, 200.0), speed_rpm=6000.0)
    at = bearing.coefficients((0.0, -100.0, 200.0), speed_rpm=6000.0, rpm=6000.0)
    lines = {line.split("  ")[0]: line for line in result.out.splitlines()}
    assert "7205 C, 100 N radially, 200 N axially" in lines and "contact angle 15 degrees" in result.out
    assert f"{at.stiffness[0, 1, 1] * 1e-6:.4g} N/µm" in lines["along the load"]
    assert f"{at.stiffness[0, 3, 3] * 1e-3:.4g} N m/mrad" in lines["tilt about x"]
    assert f"{at.stiffness[0, 2, 2] * 1e-6:.4g} N/µm" in result.out
    assert f"{state.orders.bpfo_order:.5g} per turn" in lines["BPFO"]
    assert "spin to roll" in result.out and f"{state.spin_to_roll.max():.3g}" in result.out


def test_moments_tilts_and_race_control(call):
    fast = ("bearing", "218", "--axial", "17800", "--speed-rpm", "10000", "--race-control", "harris")
    found = json.loads(call(*fast, "--moment-x", "20", "--json", "-").out)
    bearing = BallBearing.catalogue("218", race_control="harris")
    state = bearing.equilibrium((0.0, 0.0, 17800.0, 20.0, 0.0), speed_rpm=10000.0)
    np.testing.assert_array_equal(found["states"][0]["displacement"], state.displacement)
    assert found["moments"] == [20.0, 0.0]
    tilted = json.loads(call(*fast, "--tilt-y", "0.5", "--json", "-").out)
    held = bearing.equilibrium((0.0, 0.0, 17800.0), speed_rpm=10000.0, tilt=(0.0, 0.5e-3))
    np.testing.assert_array_equal(tilted["states"][0]["load"], held.load)
    mean = tilted["coefficients"][0]["mean_displacement"]
    assert tilted["tilt"] == [0.0, 0.5e-3] and mean[3:] == pytest.approx([0.0, 0.5e-3])


def test_an_outer_ring_that_turns(call, file):
    """By option and by entry of a file; the cage turns faster than with the inner ring turning."""
    given = "--load", "2000", "--speed-rpm", "3000", "--turning", "outer", "--json", "-"
    found = json.loads(call("bearing", "6206", *given).out)
    bearing = BallBearing.catalogue("6206", turning="outer")
    assert found["orders"] == asdict(bearing.orders) and found["orders"]["ftf_order"] > 0.6
    np.testing.assert_array_equal(
        found["states"][0]["force"], bearing.equilibrium((0.0, -2000.0), speed_rpm=3000.0).force
    )
    of_file = json.loads(call("bearing", file({"clearance = 0.0": 'turning = "outer"'}), "--json", "-").out)
    assert of_file["bearing"]["turning"] == "outer"
    assert "turning: outer" in call("bearing", "6206", *given[:-2]).out


def test_a_deep_groove_bearing_with_clearance_and_axial_load(call):
    """9.1 um and 30 N axially at rest: BPFO of an independent model."""
    changed = ("--clearance", "9.1", "--axial", "30", "--speed-rpm", "0")
    found = json.loads(call("bearing", "6205", *changed, "--json", "-").out)
    assert found["orders_under_load"][0]["bpfo_order"] == pytest.approx(3.6022, abs=1e-4)
    shown = call("bearing", "6205", *changed).out  # rounding reads 0
    assert "y = 0 µm, varies by 0 nm" in " ".join(shown.split()) and "e-" not in shown


def test_a_file_with_axial_load(call, file):
    changes = {
        "radial_load = 1000.0": "radial_load = 100.0\naxial_load = 200.0\nhz = [50]",
        NAME: 'bearing = "7205"',
    }
    changes["clearance = 0.0"] = 'contact_angle_deg = 25.0\nrace_control = "inner"'
    found = json.loads(call("bearing", file(changes), "--speed-rpm", "6000", "--json", "-").out)
    assert found["bearing"]["contact_angle"] == pytest.approx(np.radians(25.0))
    assert found["bearing"]["race_control"] == "inner" and found["axial_load"] == 200.0


@pytest.mark.long
def test_a_figure_of_an_axial_load(call, tmp_path):
    picture = tmp_path / "b.png"
    result = call("bearing", "7205", *LOAD, "--speed-rpm", "6000", "--figure", picture)
    assert result.code == 0 and picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"radial_load": "axial_load = -5.0\nradial_load"}, ("radial_load, operation.axial_load", "Fz > 0")),
        (
            {"radial_load": "tilt_x_mrad = 1e4\nradial_load"},
            ("operation.tilt_x_mrad", "between -100 and 100 mrad"),
        ),
        ({"clearance = 0.0": "contact_angle_deg = 0.44"}, ("contact_angle_deg = 0.44", "in rad? then 25.2")),
        ({"clearance = 0.0": 'race_control = "both"'}, ("race_control = 'both'", "outer")),
    ],
)
def test_mistakes_in_a_file_of_an_angular_contact_bearing(refused, file, changes, words):
    own = {NAME: 'bearing = "7205"'}
    if "radial_load" in changes:
        own["clearance = 0.0"] = ""
    refused(("b.toml", *words), "bearing", file(own | changes))


@pytest.mark.long
def test_lines_of_a_spall(call):
    """Those of the library; the table has the strongest, and names them by the orders of defect and shaft."""
    given = ("--axial", "32", "--load", "30", "--speed-rpm", "1800", "--spall", "inner,0.18,0.05")
    found = json.loads(call("bearing", "6205", *OIL, *given, "--json", "-").out)
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    pit = Spall(race="inner", angle=-np.pi / 2.0, length=0.18e-3, depth=0.05e-6)
    lines = bearing.excitation([pit], (0.0, -30.0, 32.0), speed_rpm=1800.0)
    (shown,) = found["spall"]["lines"]
    np.testing.assert_array_equal(shown["amplitude"], lines.amplitude)
    np.testing.assert_allclose(np.array(shown["hz"]), 30.0 * lines.order)
    assert {"spall", "lines", "amplitude", "hz"} <= set(found["units"])
    table = call("bearing", "6205", *OIL, *given).out
    order = bearing.equilibrium((0.0, -30.0, 32.0), speed_rpm=1800.0).orders.bpfi_order
    row = next(line for line in table.splitlines() if "BPFI - 1" in line and "2 BPFI" not in line)
    assert row.split()[0] == f"{order - 1.0:.5g}" and "NOT LINEAR" not in table
    slipping = bearing.orders_under((0.0, -30.0, 32.0), speed_rpm=1800.0, slip=0.01).bpfi_order
    row = next(
        line
        for line in call("bearing", "6205", *OIL, *given, "--slip", "1").out.splitlines()
        if "BPFI - 1" in line
    )
    assert row.split()[0] == f"{slipping - 1.0:.5g}"
    deep = call("bearing", "6205", *OIL, "--load", "500", "--speed-rpm", "1800", "--spall", "outer, 0.5, 3").out
    assert "NOT LINEAR" in deep and "BPFO" in deep
    wheel = ("6204", "--load", "500", "--speed-rpm", "1800", "--turning", "outer", "--spall", "outer,0.5,0.02")
    rows = call("bearing", *wheel, *OIL).out.splitlines()
    assert next(row for row in rows if " BPFO " in row and "2 BPFO" not in row).split()[3] == "0"


@pytest.mark.long
def test_orders_with_slip_and_from_a_measured_order(call):
    """Orders as in the library; angle and clearance of an order, with the interval of its error."""
    given = ("--axial", "20", "--load", "5", "--speed-rpm", "1800", "--slip", "0.5", "--clearance", "8")
    measured = ("--measured-order", "BPFI,5.4021,0.0005")
    printed = call("bearing", "6205", *given, *measured).out
    found = json.loads(call("bearing", "6205", *given, *measured, "--json", "-").out)
    bearing = BallBearing.catalogue("6205", clearance=8e-6)
    orders = bearing.orders_under(5.0, axial=20.0, speed_rpm=1800.0, slip=0.005)
    assert found["orders_under_load"][0] == pytest.approx(asdict(orders)) and found["cage_slip"] == 0.005
    assert f"{orders.bpfo_order:.5g} per turn" in printed and "0.5 %" in printed
    order = {"bpfi_order": 5.4021, "error": 5e-4, "slip": 0.005}
    angle, back = angle_from_order(bearing, **order), found["measured_order"]
    assert list(back["contact_angle"].values()) == pytest.approx(list(angle))
    clearance = clearance_from_order(bearing, [10.0, 20.0, 40.0], **order, radial=5.0, speed_rpm=1800.0)
    for name in ("value", "low", "high"):
        assert back["clearance"][name] == pytest.approx(getattr(clearance, name))
    assert f"{np.degrees(angle.value):.4g}°" in printed and f"{1e6 * clearance.value[1]:.3g}" in printed
    assert "8 µm of the bearing not used" in printed
    short = call("bearing", "6205", "--load", "5", "--speed-rpm", "9", "--axial", "-20", *measured).out
    assert "not searched without an --axial load above 0" in short
    planar = json.loads(call("bearing", "6205", "--load", "5", "--speed-rpm", "9", *measured, "--json", "-").out)
    assert "clearance" not in planar["measured_order"]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("--slip", "100"), ("--slip = 100", "below 100")),
        (("--slip", "nan"), ("--slip",)),
        (("--measured-order", "bsf,2.3,0"), ("--measured-order", "bpfo or bpfi")),
        (("--measured-order", "bpfo,nan"), ("--measured-order",)),
        (("--measured-order", "bpfo,3.5,0.001,2"), ("--measured-order", "its error")),
        (("--measured-order", "bpfo,3.4,0.001"), ("--measured-order = 3.4", "between 3.58")),
        (
            ("--measured-order", "bpfi,5.4021,0.5", "--axial", "5"),
            ("--measured-order, its error = 0.5", "at most 0.2"),
        ),
        (("--measured-order", "bpfi,162,0.5"), ("--measured-order = 162.0", "and 5.41")),
        (("--measured-order", "bpfo,3.6", "--axial", "5", "--moment-x", "1"), ("without --moment-x",)),
    ],
)
def test_mistakes_about_orders(refused, given, words):
    refused(words, "bearing", "6205", "--load", "500", "--speed-rpm", "1800", *given)


@pytest.mark.parametrize(
    ("spall", "more", "words"),
    [
        ("outer,0.5", (), "race,length,depth, as outer,0.5,3"),
        ("middle,1,1", (), "race: one of inner, outer"),
        ("outer,500,1", (), "length: from 0.14"),
        ("outer,500,1", (), "mm, the track around the outer race"),
        ("outer,500,1", (), "--spall = 'outer,500,1'"),
        ("outer,1,9000", (), "depth: at most 3970 um, a ball's radius"),
        ("outer,-1,1", (), "length: between 1e-09 and 100 m"),
        ("outer,1,nan", (), "depth: between 1e-13 and 0.1 m"),
        ("outer,1,1", ("--pair", "back-to-back", "--contact-angle", "25"), "beside --pair"),
        ("outer,1,1", ("--axial", "100", "--tilt-x", "0.1"), "beside --tilt-x"),
    ],
)
def test_a_spall_that_is_none(refused, spall, more, words):
    refused(("--spall = ", words), "bearing", "6205", "--load", "500", "--speed-rpm", "0", "--spall", spall, *more)
