"""Squeeze film dampers of a study: the rotor of the library, its script, and what is no damper."""

from dataclasses import replace

import numpy as np
import pytest

from ehlcontact.cli.study.damper import too_long
from ehlcontact.cli.study.forecast import cautions
from ehlcontact.cli.study.machine import rotor_of
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.scripts import python_text
from reduced_models import Rotor, SqueezeFilmDamper

TEXT = """title = "in dampers"
[operation]
speed_rpm = 6000.0
[oil]
iso_vg = 46
temperature = 80.0
[shaft]
length_mm = 400.0
diameter_mm = 30.0
[[disc]]
position_mm = 200.0
mass = 4.0
[[support]]
position_mm = 20.0
bearing = "6205"
clearance = 5.0
housing_mass = 0.6
housing_stiffness = 1.5e7
[[support]]
position_mm = 380.0
bearing = "6205"
clearance = 5.0
housing_mass = 0.6
housing_stiffness = 1.5e7
[[damper]]
support = "right"
length_mm = 12.0
diameter_mm = 52.0
clearance_um = 100.0
seals = "sealed"
leakage = 0.2
"""
SECOND = '\n[[damper]]\nsupport = "{}"\nlength_mm = 12.0\ndiameter_mm = 52.0\nclearance_um = 100.0\n'


@pytest.fixture
def study(tmp_path):
    def write(*changes, more=""):
        text = TEXT
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new)
        path = tmp_path / "s.toml"
        path.write_text(text + more)
        return path

    return write


def test_the_damper_is_that_of_the_library(study):
    one = load_study(study())
    (mount,) = rotor_of(one).film_dampers
    wanted = SqueezeFilmDamper(
        length=0.012, diameter=0.052, clearance=1e-4, viscosity=one.lubricant.eta0, seals="sealed", leakage=0.2
    )
    own = [[getattr(one.structure, name) for name, _ in one.structure._fields_] for one in (mount.bearing, wanted)]
    assert own[0] == pytest.approx(own[1], rel=1e-12, abs=0.0) and mount.name == "damper 1"
    (thin,) = rotor_of(load_study(study(("leakage = 0.2", "viscosity = 0.003")))).film_dampers
    assert (thin.bearing.viscosity, thin.bearing.leakage) == (0.003, 0.0)


def test_the_script_makes_the_rotor(study):
    one = load_study(study())
    names = {"__name__": "script"}
    exec(compile(python_text(one), "machine.py", "exec"), names)
    made, own = names["rotor"], rotor_of(one)
    assert isinstance(made, Rotor) and np.array_equal(made.stiffness, own.stiffness)
    assert made.film_dampers[0].bearing.structure.sealed == pytest.approx(
        own.film_dampers[0].bearing.structure.sealed, rel=1e-10
    )


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("length_mm = 12.0", "", ("damper.length_mm = None", "given")),
        ("clearance_um = 100.0", "", ("damper.clearance_um = None", "given")),
        ("clearance_um = 100.0", "clearance_um = 1e-4", ("damper.clearance_um = 0.0001", "in m? then 100 um")),
        ("clearance_um = 100.0", "clearance_um = 4000.0", ("damper.clearance_um = 4000.0", "tenth of the radius")),
        (
            "diameter_mm = 52.0",
            "diameter_mm = 7.0",
            ("damper.diameter_mm = 7.0", "some 53 mm, or more"),
        ),
        ('"right"', '"middle"', ("damper.support = 'middle'", "left, right")),
        ("sealed", "open", ("damper.leakage = 0.2", "left out")),
        ("sealed", "shut", ("damper.seals = 'shut'", "'open' or 'sealed'")),
        ("leakage = 0.2", "groove = true", ("damper.groove = True", "open")),
        ("housing_mass = 0.6\nhousing_stiffness = 1.5e7\n", "", ("support.right.housing_stiffness", "[[damper]]")),
        ("iso_vg = 46\ntemperature = 80.0", "", ("oil",)),
        ("[oil]\niso_vg = 46\ntemperature = 80.0\n", "", ("damper.viscosity = None", "or [oil]")),
        ("leakage = 0.2", "leakage = 0.2\n[export]\nross = true", ("export.ross", "[[damper]]")),
        (
            "leakage = 0.2",
            "leakage = 0.2" + SECOND.format("right"),
            ("damper.2.support = 'right'", "no other damper"),
        ),
    ],
)
def test_mistakes(refused, study, tmp_path, old, new, words):
    refused(words, "validate", study((old, new)), "-o", tmp_path / "out")


def test_an_open_film_that_is_no_short_bearing(study):
    """By orbits in the middle, F of the open over that of the sealed film: (L/D)^2/3; a groove halves the film."""
    opened = ('seals = "sealed"\nleakage = 0.2\n', "")
    long = ("length_mm = 12.0", "length_mm = 78.0")
    assert too_long(load_study(study(opened))) == [] == too_long(load_study(study(long)))
    (said,) = cautions(one := load_study(study(opened, long)))[-1:]
    force = [replace(rotor_of(one).film_dampers[0].bearing, seals=seals) for seals in ("open", "sealed")]
    ratio = np.divide(*(damper.linear().damping[0, 0] for damper in force))
    assert ratio == pytest.approx(0.75, rel=1e-6) and "damper of right is 1.5 diameters long" in said
    assert "its force is 0.75 times that" in said
    assert "0.75 diameters" in too_long(load_study(study((opened[0], "groove = true\n"), long)))[0]


def test_a_damper_needs_a_shaft(refused, tmp_path):
    path = tmp_path / "s.toml"
    alone = '[operation]\nspeed_rpm = 6000.0\nradial_load = 50.0\n[[support]]\nbearing = "6205"\n'
    path.write_text(f"{alone}{SECOND.replace(chr(10) + 'support = ' + chr(34) + '{}' + chr(34), '')}")
    refused(("shaft = None", "[[damper]]"), "validate", path)
