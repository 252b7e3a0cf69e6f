"""What no solver is made for, and slips in a study file: exit 2, one line, at once; nothing is made or started."""

import subprocess
import time
from pathlib import Path

import pytest

SMALL = (Path(__file__).parents[2] / "examples" / "small_study.toml").read_text()
AT_ONCE = 2.0  # seconds
POINT = {"--M": "200", "--L": "10", "--kappa": "0.5"}
COMMANDS = {
    "steady": (),
    "simulate": ("--free", "5.13"),
    "impedance": ("--omega", "1"),
}


@pytest.fixture
def at_once(refused):
    """As `refused`, and within `AT_ONCE`."""

    def run(words, *arguments):
        started = time.perf_counter()
        refused(words, *arguments)
        assert time.perf_counter() - started < AT_ONCE

    return run


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("--M", "1e9", ("M = 1000000000.0", "between 0.1 and")),
        ("--M", "1e-3", ("M = 0.001", "between 0.1 and")),
        ("--M", "1e300", ("M = 1e+300",)),
        ("--L", "1e9", ("L = 1000000000.0", "between 0 and")),
        ("--L", "106", ("L = 106.0",)),
        ("--kappa", "20", ("kappa = 20.0",)),
        ("--kappa", "0.011", ("kappa = 0.011",)),
        ("--alpha", "20", ("alpha = 20.0", "in 1/GPa? then 2e-08 1/Pa")),
        ("--alpha", "0.02", ("alpha = 0.02", "in 1/MPa? then 2e-08 1/Pa")),
        ("--alpha", "1e-300", ("alpha = 1e-300",)),
        ("--eta0", "36.7", ("eta0 = 36.7", "in mPa s? then 0.0367 Pa s")),
        ("--eta0", "1e-4", ("ln(eta/eta0)", "at most")),
    ],
)
def test_points_on_the_command_line(at_once, command, option, value, words):
    options = POINT | {option: value}
    at_once(words, command, *(part for pair in options.items() for part in pair), *COMMANDS[command])


def test_pressures_on_the_command_line(at_once):
    at_once(("Hertz pressure in GPa", "at most 5"), "steady", "--M", "30000", "--L", "25", "--kappa", "0.9")
    ramp = ("--ramp", "1e4", "1", "--omega-n", "2.4")
    at_once(("M under the largest load",), "simulate", *(p for pair in POINT.items() for p in pair), *ramp)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        # numbers that are none
        ("ball_diameter_mm = 7.94", "ball_diameter_mm = true", ("bearing.ball_diameter_mm", "True", "a number")),
        (
            "ball_diameter_mm = 7.94",
            'ball_diameter_mm = "7.94"',
            ("bearing.ball_diameter_mm", "'7.94'", "a number"),
        ),
        (
            "ball_diameter_mm = 7.94",
            "ball_diameter_mm = [7.94]",
            ("bearing.ball_diameter_mm", "[7.94]", "a number"),
        ),
        ("ball_diameter_mm = 7.94", "ball_diameter_mm = {mm = 7.94}", ("bearing.ball_diameter_mm", "a number")),
        ("ball_diameter_mm = 7.94", "ball_diameter_mm = 2020-01-01", ("bearing.ball_diameter_mm", "a number")),
        ("ball_diameter_mm = 7.94", "ball_diameter_mm = nan", ("bearing.ball_diameter_mm", "nan", "finite")),
        ("ball_diameter_mm = 7.94", "ball_diameter_mm = -inf", ("bearing.ball_diameter_mm", "-inf", "finite")),
        ("ball_diameter_mm = 7.94", f"ball_diameter_mm = 1{'0' * 400}", ("bearing.ball_diameter_mm", "number")),
        ("ball_diameter_mm = 7.94", f"ball_diameter_mm = 1{'0' * 5000}", ("study", "complete TOML")),
        ("balls = 9", "balls = true", ("bearing.balls", "True", "whole number")),
        ("balls = 9", 'balls = "9"', ("bearing.balls", "'9'", "whole number")),
        ("balls = 9", "balls = 9.0", ("bearing.balls", "9.0", "whole number")),
        ("speed_rpm = 3000.0", "speed_rpm = false", ("bearing.speed_rpm", "False", "a number")),
        ("radial_load = 70.0", 'radial_load = "70 N"', ("bearing.radial_load", "'70 N'", "a number")),
        ("eta0 = 0.0367", "eta0 = true", ("oil.eta0", "True", "a number")),
        ("alpha = 2.0e-8", "alpha = '2e-8'", ("oil.alpha", "'2e-8'", "a number")),
        ('race = "inner"', "race = true", ("bearing.race", "True", "'inner' or 'outer'")),
        ("n = 64", "n = true", ("solver.n", "True", "whole number")),
        ("n = 64", "n = 64.0", ("solver.n", "64.0", "whole number")),
        ("n = 64", "n = 64\ndomain = [true, 2, 3]", ("solver.domain.0", "True", "a number")),
        ("n = 64", "n = 64\ndomain = ['-4.5', 1.5, 3]", ("solver.domain.0", "a number")),
        ("n = 64", "n = 64\ndomain = [-4.5, 1.5]", ("solver.domain", "list of three numbers")),
        ("n = 64", "n = 64\ndomain = [-4.5, 1.5, 3, 4]", ("solver.domain", "list of three numbers")),
        ("n = 64", "n = 64\ndomain = 3", ("solver.domain", "list of three numbers")),
        ("n = 64", "n = 64\ndomain = [-4.5, nan, 3]", ("solver.domain.1", "nan", "finite")),
        ("revolutions = 2", "revolutions = true", ("rotor.revolutions", "True", "a whole number")),
        ("revolutions = 2", "revolutions = 1", ("rotor.revolutions", "1", "between 2 and 100")),
        ("revolutions = 2", "check_revolutions = 1", ("rotor.check_revolutions", "1", "left out; revolutions?")),
        ("disc_mass = 1.5", "disc_mass = true", ("rotor.disc_mass", "True", "a number")),
        ("periods = 2", "periods = inf", ("harmonic.periods", "inf", "finite")),
        # keys
        ("ball_diameter_mm = 7.94", "ball_diameter = 7.94", ("bearing.ball_diameter ", "ball_diameter_mm?")),
        ("ball_diameter_mm = 7.94", "ball_diam_mm = 7.94", ("bearing.ball_diam_mm", "ball_diameter_mm?")),
        ("alpha = 2.0e-8", "alfa = 2e-8", ("oil.alfa", "alpha?")),
        ("disc_mass = 1.5", "discmass = 3.0", ("rotor.discmass", "disc_mass?")),
        ("[oil]", "[oli]", ("oli = ", "oil?")),
        ("[rotor]", "[[rotor]]", ("rotor = ", "a section, written [rotor]")),
        ("title =", "titel =", ("titel = ", "title?")),
        (
            "unbalance = 2.0e-5",
            "unbalance = 2.0e-5\nspeed_rpm = 3000",
            ("rotor.speed_rpm", "belongs to [bearing]"),
        ),
        ("[solver]", "", ("oil.n = 64", "belongs to [solver]")),
        ("[bearing]", f"x = {'[' * 3000}", ("study", "complete TOML")),
        # units
        (
            "ball_diameter_mm = 7.94",
            "ball_diameter_mm = 0.0079",
            ("bearing.ball_diameter_mm", "in m? then 7.9 mm"),
        ),
        ("ball_diameter_mm = 7.94", "ball_diameter_mm = 0.3125", ("bearing.ball_diameter_mm", "in inches?")),
        (
            "pitch_diameter_mm = 39.04",
            "pitch_diameter_mm = 0.03904",
            ("bearing.pitch_diameter_mm", "in m? then 39.04"),
        ),
        ("conformity = 0.52", "conformity = 52", ("bearing.conformity", "in %? then 0.52")),
        ("conformity = 0.52", "conformity = 0.500001", ("bearing.conformity", "0.501")),
        ('race = "inner"', "youngs_modulus = 206", ("bearing.youngs_modulus", "in GPa? then 2.06e+11 Pa")),
        ('race = "inner"', "youngs_modulus = 206e3", ("bearing.youngs_modulus", "in MPa? then 2.06e+11 Pa")),
        ("eta0 = 0.0367", "eta0 = 36.7", ("oil.eta0", "in mPa s? then 0.0367 Pa s")),
        ("eta0 = 0.0367", "eta0 = 4.29e-5", ("oil.eta0", "in m2/s? then 0.03732 Pa s")),
        ("eta0 = 0.0367", "eta0 = 5.0", ("L = 64.45", "oil.eta0 = 5 in mPa s?")),
        ("alpha = 2.0e-8", "alpha = 20", ("oil.alpha", "in 1/GPa? then 2e-08 1/Pa")),
        ("alpha = 2.0e-8", "alpha = 0.02", ("oil.alpha", "in 1/MPa? then 2e-08 1/Pa")),
        # what the contact comes to
        ("radial_load = 70.0", "radial_load = 7e7", ("M = ", "83 GPa")),
        ("radial_load = 70.0", "radial_load = 7e-5", ("M = ", "between 0.1")),
        ("radial_load = 70.0", "radial_load = 2e4", ("Hertz pressure in GPa", "at most 5")),
        ("radial_load = 70.0", "radial_load = 1e300", ("bearing.radial_load", "N")),
        ("speed_rpm = 3000.0", "speed_rpm = 3e9", ("bearing.speed_rpm", "rev/min")),
        ("speed_rpm = 3000.0", "speed_rpm = 0.5", ("M = ", "in rev/s? then 30 rev/min")),
    ],
)
@pytest.mark.parametrize("command", ["run", "validate"])
def test_slips_in_a_study(at_once, tmp_path, monkeypatch, command, old, new, words):
    monkeypatch.setattr(subprocess, "Popen", None)  # no worker is started
    assert old in SMALL
    file = tmp_path / "bad.toml"
    file.write_text(SMALL.replace(old, new, 1))
    at_once(("bad.toml", *words), command, file, "-o", tmp_path / "results")
    assert not (tmp_path / "results").exists()


def test_whole_numbers_are_numbers(call, tmp_path):
    file = tmp_path / "whole.toml"
    file.write_text(SMALL.replace("radial_load = 70.0", "radial_load = 70").replace("3000.0", "3_000"))
    assert call("validate", file, "-o", tmp_path / "none").code == 0
