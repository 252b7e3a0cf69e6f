"""Section "What a defect looks like" of a report: its numbers by the library, its picture and its page."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from tiny_study import ALONE

from ehlcontact.cli.page import write_page
from ehlcontact.cli.study.defect import defects_of
from ehlcontact.cli.study.forecast import cautions
from ehlcontact.cli.study.loads import ring_load
from ehlcontact.cli.study.machine import bearing_of
from ehlcontact.cli.study.schema import load_study
from reduced_models import Spall

LOAD = "radial_load = 20.0"
CASES = {  # entries of the defect, of the load and of the bearing
    "outer": ('spall = "outer,0.2,0.01"\ncage_slip_percent = 0.5', "", "clearance = 8.0"),
    "inner": ('spall = "inner, 0.2, 0.01"', "axial_load = 30.0", ""),
}


def study(folder, defect, load="", bearing="clearance = -1.0"):
    """A bearing alone with these entries."""
    text = ALONE.replace(LOAD, f"radial_load = 300.0\n{load}") + f"{bearing}\n"  # fewer lines
    path = folder / "study.toml"
    path.write_text(f"{text}[[defect]]\n{defect}\n" if defect else text)
    return load_study(path)


def section(folder, found):
    """The page of a section alone."""
    beside = {"found": found, "d": found.defects[0], "number": "", "picture": lambda name, text: text}
    return write_page(folder / "d.html", "defect.html.j2", {}, **beside)


@pytest.fixture(scope="module", params=["outer", pytest.param("inner", marks=pytest.mark.slow)])
def found(request, tmp_path_factory):
    """Study and defect, of a planar bearing and of one under axial load."""
    asked = study(tmp_path_factory.mktemp("defect"), *CASES[request.param])
    (one,) = defects_of(asked)
    return asked, one


def test_lines_and_orders_are_those_of_the_library(found):
    asked, one = found
    bearing, load = bearing_of(asked, 0), ring_load(asked, 0)
    pit = Spall(race=one.spall.race, angle=-np.pi / 2.0, length=0.2e-3, depth=0.01e-6)
    at = {"speed_rpm": 3000.0, "slip": 0.005 if one.spall.race == "outer" else 0.0}
    assert one.spall == pit and one.orders == bearing.orders_under(load, **at)
    lines = bearing.excitation([pit], load, **at)
    np.testing.assert_array_equal(one.lines["film"].order, lines.order)
    np.testing.assert_array_equal(one.lines["film"].amplitude, lines.amplitude)
    turns = one.turns[:700]
    force = lines.force(turns)[:, 1]
    np.testing.assert_allclose(
        one.force["film"][:700] + force.mean() - one.force["film"][:700].mean(), force, atol=1e-9
    )


def test_film_takes_the_edges_off(found):
    """Beyond waves of two semi-axes, a quarter of the highest line, films leave a tenth of the bare step."""
    _, one = found
    high = {}
    for name, lines in one.lines.items():
        beyond = lines.order > 0.3 * one.lines["none"].order.max()
        high[name] = np.sqrt(np.sum(lines.amplitude[beyond, 1] ** 2))
    assert 0.0 < high["film"] < 0.2 * high["none"]
    assert one.highest["film"] < one.highest["none"]
    for name in one.harmonics:
        assert min(one.harmonics[name]) > 0.0
    assert one.harmonics["film"][0] < one.harmonics["none"][0]


@pytest.mark.long
def test_bare_step_does_not_overshoot(tmp_path):
    """Its largest change is the height of the step; that of its series is 9 % of the jump above it."""
    (one,) = defects_of(study(tmp_path, 'spall = "outer,0.5,0.05"', bearing="clearance = 8.0"))
    step = one.force["none"]
    low, high = one.passage
    inside = step[(low <= one.turns) & (one.turns <= high) & (step < 0.5 * step.min())]
    assert one.highest["none"] == pytest.approx(-np.median(inside), rel=0.025)
    assert 0.96 < one.highest["film"] / one.highest["none"] < 0.99


def test_page_and_picture(found, tmp_path):
    asked, one = found
    lines = [line for panel in one.picture().panels for line in panel.lines]
    assert len(lines) == 8 and len({line.name for line in lines}) == 2
    over_time, passage, envelope, _ = one.picture().panels
    assert over_time.x == passage.x == ("time", "s") and over_time.lines[0].x[-1] == pytest.approx(0.03, rel=1e-3)
    assert envelope.x_ends == (0.0, 1000.0) and envelope.y[1] == "N" and one.envelope["film"].unit == "N"
    assert envelope.marks[0].text == one.name and envelope.marks[0].at == pytest.approx(
        50.0 * one.order, rel=1e-12
    )
    assert [round(mark.at / envelope.marks[0].at) for mark in envelope.marks] == list(
        range(1, len(envelope.marks) + 1)
    )
    assert one.to_dict()["frequencies_hz"]["bpfo"] == pytest.approx(50.0 * one.orders.bpfo_order, rel=1e-12)
    low, high = one.passage
    assert 0.0 < high - low < 0.2 and low < one.turns[np.abs(one.force["film"]).argmax()] % 20.0
    page = section(tmp_path, SimpleNamespace(defects=(one,), study=asked))
    text = re.sub(r"<[^>]*>|\s+", " ", page.read_text())
    assert "What a defect looks like" in text and f"multiples of {one.name}" in text
    assert f"{one.orders.bpfo_order:.5g}" in text and f"{one.highest['film']:.3g}" in text
    assert ("at the contact angles" in text) == (one.spall.race == "inner")
    assert ("with 0.5&nbsp;% slip" in text) == (one.spall.race == "outer") == (one.to_dict()["cage_slip"] > 0.0)
    assert one.to_dict()["envelope_harmonics"] == one.harmonics


@pytest.mark.slow
def test_a_deep_spall_is_named(tmp_path):
    asked = study(tmp_path, 'spall = "outer,0.5,20"')
    (deep,) = defects_of(asked)
    assert "not linear" in deep.reservation and "simulate_rotor" in deep.reservation
    assert deep.loses_load and deep.to_dict()["largest_force"] is None
    page = section(tmp_path, SimpleNamespace(defects=(deep,), study=asked))
    assert "forces are left out" in page.read_text() and "largest change" not in page.read_text()
    assert defects_of(study(tmp_path, "")) == ()


@pytest.mark.parametrize(("spall", "warned"), [("inner,1.0,60", True), ("inner,1.0,0.5", False)])
def test_validate_warns_of_a_spall_over_which_balls_lose_their_load(tmp_path, spall, warned):
    found = cautions(study(tmp_path, f'spall = "{spall}"', "axial_load = 50.0"))
    assert any("lose their load" in text and "simulate_rotor" in text for text in found) == warned


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ('spall = "outer,0.5"', ("defect.spall = 'outer,0.5'", "race,length,depth")),
        ('spall = "outer,500,1"', ("defect.spall = 'outer,500,1'", "length", "mm, the track")),
        ("cage_slip_percent = 1.0", ("defect.spall = None", "given")),
        ('spall = "outer,1,1"\ncage_slip_percent = 100.0', ("cage_slip_percent = 100", "above -50 and below 100")),
        ('spall = "cage,1,1"', ("defect.spall", "inner, outer")),
        ('spall = "outer,1,1"\nsupport = "left"', ("defect.support = 'left'", "the name of a support: 1")),
    ],
)
def test_mistakes_are_one_line(refused, tmp_path, entries, words):
    path = tmp_path / "s.toml"
    path.write_text(f"{ALONE}[[defect]]\n{entries}\n")
    refused(words, "run", path, "-o", tmp_path / "out")


def test_a_tilted_ring_has_no_lines_of_a_spall(refused, tmp_path):
    path = tmp_path / "s.toml"
    tilted = ALONE.replace(LOAD, f"{LOAD}\naxial_load = 30.0\ntilt_x_mrad = 0.1")
    path.write_text(f'{tilted}[[defect]]\nspall = "outer,1,1"\n')
    refused(("defect.spall", "left out beside operation.tilt_x_mrad"), "run", path, "-o", tmp_path / "out")
