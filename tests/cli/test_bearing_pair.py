"""``ehlcontact bearing --pair``: numbers of the library, what a preload carries, mistakes in one line."""

import json
from pathlib import Path

import numpy as np
import pytest

from ehlcontact import Lubricant
from reduced_models import BallBearing, BearingSet

EXAMPLE = Path(__file__).parents[2] / "examples" / "bearing_6205.toml"
SPINDLE = ("7205", "--pair", "back-to-back", "--preload", "150", "--distance-mm", "60")
LOAD = ("--axial", "200", "--radial", "500")
FAST = ("--speed-rpm", "6000", "--oil", "46", "--temp", "60")


def test_json_is_what_the_library_has(call):
    result = call("bearing", *SPINDLE, *LOAD, *FAST, "--json", "-")
    assert result.code == 0 and result.err == ""
    found = json.loads(result.out)
    bearing = BallBearing.catalogue("7205", oil=Lubricant.iso_vg(46, temperature=60.0))
    pair = BearingSet.pair(bearing, preload=150.0, distance=0.06)
    state = pair.equilibrium((0.0, -500.0, 200.0), speed_rpm=6000.0)
    small = pair.coefficients((0.0, -500.0, 200.0), speed_rpm=6000.0, rpm=6000.0)
    np.testing.assert_array_equal(found["states"][0]["axial_forces"], state.axial_forces)
    np.testing.assert_array_equal(found["coefficients"][0]["damping"], small.damping[0])
    assert found["axial_rigidity"] == [state.stiffness[2, 2]]
    assert found["pair"]["positions"] == [-0.03, 0.03] and found["pair"]["preload"] == 150.0
    assert found["lift_off"] == [{way: pair.lift_off(way, speed_rpm=6000.0) for way in ("+z", "-z")}]
    for k, one in enumerate(state.bearings):
        np.testing.assert_array_equal(found["states"][0]["bearings"][k]["h_min"], one.h_min)
        assert found["frequencies_hz"][0][k]["bpfi"] == pytest.approx(100.0 * one.orders.bpfi_order)
    inner = found["coefficients"][0].keys() | found["states"][0].keys() | found["states"][0]["bearings"][0].keys()
    assert found["units"].keys() <= found.keys() | inner


def test_a_table_of_a_pair_at_rest(call):
    """The load is the difference of the axial forces; the lift-off load exceeds 2 sqrt(2) preloads a little."""
    result = call("bearing", *SPINDLE, *LOAD, "--speed-rpm", "0")
    assert result.code == 0
    lines = {line.split("  ")[0]: line for line in result.out.splitlines()}
    assert "pair of 7205 A, back to back, 500 N radially, 200 N axially" in lines
    first, second = (float(word) for word in lines["axial forces"].split("forces")[1].split(" N")[0].split(", "))
    assert first - second == pytest.approx(200.0, abs=0.1) and min(first, second) > 0.0
    assert 2.0 * np.sqrt(2.0) < float(lines["unloaded from"].split()[2]) / 150.0 < 3.1
    assert "bearing 1, facing -z" in lines and "bearing 1: 5.3402 per turn" in lines["BPFO"]
    assert "PRELOAD USED UP" not in result.out


def test_a_preload_that_is_used_up(call, refused):
    """At rest an error; at speed centrifugal force still presses the balls outward, and the answer says so."""
    words = "--axial = 500.0", "an axial load alone does so from 436.6 N in +z on"
    refused(words, "bearing", *SPINDLE, "--axial", "500", "--speed-rpm", "0")
    shown = call("bearing", *SPINDLE, "--axial", "500", "--speed-rpm", "12000").out
    assert "PRELOAD USED UP" in shown


def test_a_pair_without_preload_may_be_unloaded_on_one_side(call):
    given = ("7205", "--pair", "back-to-back", "--axial", "200", "--speed-rpm", "0")
    found = json.loads(call("bearing", *given, "--json", "-").out)
    np.testing.assert_allclose(found["states"][0]["axial_forces"], [200.0, 0.0], atol=1e-9)
    assert found["orders_under_load"][0][1] is None and found["lift_off_at_rest"] == {}
    assert call("bearing", *given).code == 0


def test_a_file_with_a_pair_on_a_spring_tilted(call, tmp_path):
    text = EXAMPLE.read_text().replace("clearance = 0.0", 'pair = "face-to-face"\npair_spring = 300.0')
    text = text.replace('bearing = "6205"', 'bearing = "7205"')
    path = tmp_path / "pair.toml"
    path.write_text(f"{text}axial_load = 0.0\ntilt_x_mrad = 0.2\n")
    found = json.loads(call("bearing", path, "--speed-rpm", "3000", "--json", "-").out)
    assert found["pair"]["spring"] == 300.0 and found["pair"]["facings"] == ["-z", "+z"]
    tilts = found["coefficients"][0]["mean_displacement"][3], found["states"][0]["displacement"][3]
    assert tilts == pytest.approx((2e-4, 2e-4))
    assert min(found["states"][0]["axial_forces"]) == pytest.approx(300.0, rel=0.01)


@pytest.mark.long
def test_a_figure_of_a_pair(call, tmp_path):
    picture = tmp_path / "pair.png"
    assert call("bearing", *SPINDLE, *LOAD, "--speed-rpm", "0", "--figure", picture).code == 0
    assert picture.read_bytes().startswith(b"\x89PNG")


PAIR = ("7205", "--pair", "back-to-back")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("6205", "--pair", "back-to-back"), ("--pair = 'back-to-back'", "need a contact angle")),
        ((*PAIR, "--preload", "-150"), ("--preload = -150", "between 1e-06 and 1e+08 N")),
        ((*PAIR, "--preload", "1e6"), ("--preload = 1000000.0", "contact angles stay below 60 degrees")),
        ((*PAIR, "--preload", "9", "--spring", "9"), ("--spring", "preload or spring, not together")),
        ((*PAIR, "--preload", "9", "--distance-mm", "0.06"), ("--distance-mm = 0.06", "in m? then 60 mm")),
        ((*PAIR, "--spring", "100", "--axial", "-150"), ("--axial = -150.0", "the spring carries 100 N in -z")),
        ((*PAIR,), ("--load, --axial = ", "nothing holds it in x; more axial load or preload would")),
        (("7205", "--pair", "o"), ("--pair = 'o'", "back-to-back, face-to-face, tandem")),
        (("7205", "--pair", "tandem", "--load", "200"), ("--axial = None", "an angular contact bearing")),
        (("7205", "--pair", "tandem", "--axial", "9", "--preload", "9"), ("--preload = 9", "do not press each")),
        (("7205", "--preload", "100", "--axial", "200"), ("--preload = 100", "left out without --pair")),
    ],
)
def test_mistakes(refused, given, words):
    refused(words, "bearing", *given, "--speed-rpm", "0")
