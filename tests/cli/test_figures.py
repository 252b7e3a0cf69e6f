"""Figures: what is drawn, in which units and words, files of them, notes of a map out of scale."""

import json
import re

import numpy as np
import pytest
from rotor_twins import run_of

from ehlcontact import (
    Geometry,
    Grid,
    HarmonicLoad,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    TimeSteps,
    simulate,
    solve_steady,
)
from ehlcontact.cli.paper.figures import FIGURES
from ehlcontact.cli.paper.page import reproduce
from ehlcontact.cli.plots.finish import finished
from ehlcontact.cli.plots.render import figure_of
from ehlcontact.film.over_time import film_wave
from ehlcontact.film.pictures import coloured_fringes
from ehlcontact.results.contact_map import convergence, film_picture
from ehlcontact.results.picture import BLUE, Map, Panel, Picture
from reduced_models.fitting.pictures import histories, loops

IN_SI = OperatingPoint(Geometry(12.7e-3, 20e-3), Lubricant(0.1), 20.0, 0.5)
PLAIN = MoesPoint(50.0, 5.0, 0.5)
SPELLED = re.compile(r"\bum\b|Omega|omega|kappa|\bpi\b|e[+-]\d\d")


def named(picture, name, number=0):
    """A line called `name`, in the units of pictures."""
    lines = [line for panel in picture.panels for line in panel.shown().lines]
    return [line for line in lines if line.name == name][number]


@pytest.mark.parametrize(("point", "si"), [(IN_SI, True), (PLAIN, False)], ids=["SI", "dimensionless"])
def test_mid_planes(point, si):
    result = solve_steady(point, grid=Grid(n=32))
    _, picture = film_picture(result)
    place, gap = (1e6, 1e6) if si else (1.0, 1.0)
    panel = picture.panels[0].shown()
    assert panel.y == ("pressure [GPa]" if si else "pressure [Hertz pressure]")
    assert panel.second == ("film [µm]" if si else "film [dry approach]")
    np.testing.assert_allclose(named(picture, "film").x, result.x * place)
    np.testing.assert_allclose(named(picture, "film").y, result.h[:, 0] * gap)
    np.testing.assert_allclose(named(picture, "dry Hertz").y.max(), point.scales.pressure * 1e-9 if si else 1.0)


@pytest.mark.parametrize(("point", "si"), [(IN_SI, True), (PLAIN, False)], ids=["SI", "dimensionless"])
def test_histories_and_film_wave(point, si):
    unit = IN_SI.scales.time if si else 1.0
    steps = TimeSteps(until=1.0 * unit, dt=0.1 * unit)
    run = simulate(point, HarmonicLoad(Omega=3.0), grid=Grid(n=32), time=steps)
    picture = histories(run, None)
    labels = {panel.shown().y for panel in picture.panels}
    assert (
        {"approach [µm]", "force [N]"} <= labels if si else {"approach [dry approach]", "force [load]"} <= labels
    )
    np.testing.assert_allclose(named(picture, "minimum").x, run.t * (1e3 if si else 1.0))
    unit = 1e6 if si else 1.0
    np.testing.assert_allclose(named(picture, "minimum").y, run.h_min * unit)
    (shown,) = film_wave(run).panels()
    (T, _), (X, _), (change, _) = shown.x, shown.y, shown.values
    assert (T[0], T[-1]) == (0.0, run.t[-1]) and np.abs(X).max() <= 1.1 * run.point.scales.a
    np.testing.assert_array_equal(change[0], 0.0)
    centre = (run.h_midplane[-1] - run.h_midplane[0])[np.argmin(np.abs(run.x))]
    assert change[-1, np.argmin(np.abs(X))] == centre


def test_loops_show_the_element_that_was_fitted():
    """In its window, in SI: its force along the record, and below, the damper's part alone."""
    from reduced_models import ContactRecord, fit

    unit = IN_SI.scales.time
    steps = TimeSteps(until=4.0 * unit, dt=0.05 * unit)
    run = simulate(IN_SI, HarmonicLoad(Omega=3.0), grid=Grid(n=32), time=steps)
    found = fit(ContactRecord.from_result(run), "cubic", (2.0 * unit, 4.0 * unit))
    picture = loops({"harmonic": run}, {"harmonic": found}, {"harmonic": "a title"})
    assert picture.panels[0].title == "a title"
    k, inside = found.parameters, run.t >= 2.0 * unit * (1.0 - 1e-12)
    u, damper = run.approach[inside], k["C1"] * run.rate[inside]
    spring = k["K1"] * u + k["K2"] * u**2 + k["K3"] * u**3
    element, film = named(picture, "cubic element"), named(picture, "film")
    np.testing.assert_allclose(element.x, u * 1e6)
    np.testing.assert_allclose(element.y, spring + damper)
    np.testing.assert_allclose(film.y, run.force[inside])
    element, film = named(picture, "cubic element", 1), named(picture, "film", 1)
    np.testing.assert_allclose(film.y, run.force[inside] - spring, atol=1e-12 * IN_SI.load)
    np.testing.assert_allclose(element.y, damper, atol=1e-12 * IN_SI.load)


def test_spectrum_shows_amplitudes():
    """Of a run with known ones, over its settled part: 3 um twice a revolution, 7 N once, whatever the means."""
    from reduced_models.rotor.model_pictures import settled_spectra
    from reduced_models.rotor.settling import Settling

    t = np.arange(3 * 40 + 1) / 2000.0
    turned = 2.0 * np.pi * 50.0 * t
    start = 1.0 + (t <= 0.02)  # the first of three revolutions is not settled
    moved = np.column_stack([np.zeros(t.size), 1e-6 * start * (20.0 + 3.0 * np.sin(2.0 * turned))])
    force = (100.0 + 7.0 * start * np.cos(turned))[:, None]
    once, places = np.zeros((t.size, 1)), {"names": ("disc x", "disc y"), "places": np.array([0, 1])}
    run = run_of(t, once, once, force, displacement=moved, **places)
    picture = settled_spectra(
        {"full": run}, Settling((0.5, 0.0), 0.01), {"full": (BLUE, "-")}, {"full": "full film"}
    )
    displacement, load = (np.array([line.x, line.y]) for panel in picture.panels for line in panel.shown().lines)
    for (hz, amplitude), (where, size) in ((displacement, (100.0, 3.0)), (load, (50.0, 7.0))):
        highest = np.argmax(amplitude)
        assert hz[highest] == pytest.approx(where) and amplitude[highest] == pytest.approx(size, rel=1e-12)
        assert np.delete(amplitude, highest).max() < 1e-9 * size


@pytest.mark.parametrize(
    "suffix", [".png", *(pytest.param(end, marks=pytest.mark.long) for end in (".svg", ".pdf"))]
)
def test_steady_command_draws(call, point, tmp_path, suffix):
    target = tmp_path / f"film{suffix}"
    result = call("steady", *point, "--n", "32", "--figure", target, "--json", "-")
    assert result.code == 0 and result.err == "" and result.out.startswith("{")
    head = target.read_bytes()[:5]
    assert head.startswith({".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}[suffix])


def test_simulate_command_draws(call, point, tmp_path):
    target = tmp_path / "run.png"
    options = ["--harmonic", "3", "--dt", "0.05", "--until", "0.5", "--json", "-"]
    result = call("simulate", *point, "--n", "32", *options, "--figure", target)
    assert result.code == 0 and result.err == "" and result.out.startswith("{")
    assert target.read_bytes().startswith(b"\x89PNG")


def test_drawing_leaves_matplotlib_alone(tmp_path):
    import matplotlib as mpl

    before = dict(mpl.rcParams)
    solve_steady(PLAIN, grid=Grid(n=32)).plot(tmp_path / "film.png")
    assert dict(mpl.rcParams) == before


def test_panels_of_several_results_in_one_figure():
    from ehlcontact.film import film_of, interferogram
    from ehlcontact.results.drawing import draw
    from ehlcontact.results.picture import Line

    film = solve_steady(IN_SI, grid=Grid(n=32))
    own = Panel([Line(film.x, film.h[:, 0])], "place", "gap")
    figure = draw(Picture([*film.panels(), *interferogram(film_of(film), 600e-9).panels(), own], "a title"))
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert len(labels) == len(film.plot().axes) + 3 and labels[-1] == "gap"  # fringes with their bar
    assert "intensity" in " ".join(labels)


def texts(picture):
    """All that a picture says: names, titles, labels, notes."""
    found = [picture.note]
    for panel in (panel.shown() for panel in picture.panels):
        axes = (
            [one[1] for one in (panel.x, panel.y, panel.values)] if isinstance(panel, Map) else [panel.x, panel.y]
        )
        found += [panel.title, *axes, *(line.name for line in panel.lines)]
        if isinstance(panel, Panel):
            found += [panel.second, *(mark.text for mark in panel.marks)]
    return [text for text in found if text]


@pytest.fixture(scope="module")
def reproduction(tmp_path_factory):
    return reproduce((), [n for n in FIGURES if n != 2], tmp_path_factory.mktemp("figures"), 32)


@pytest.mark.long
@pytest.mark.parametrize("number", [n for n in FIGURES if n != 2])
def test_figures_of_the_paper(reproduction, number):
    (figure,) = (figure for figure in reproduction.figures if figure.number == number)
    drawn = figure.draw(reproduction.fits)
    json.dumps(finished(figure_of(drawn)), allow_nan=False)
    said = [*texts(drawn), figure.caption, figure.paper]
    assert not [text for text in said if SPELLED.search(text)]
    # the paper's own values where there are any, and where there are none that is said
    shown = any("paper" in text for text in texts(drawn))
    assert shown or "not shown" in figure.paper
    assert ("The surfaces move" in " ".join(said)) == (number in (4, 7, 12))  # fringes


@pytest.mark.long
def test_the_papers_elements_are_drawn_as_printed(reproduction):
    """Fig. 19, left: K1 u + K2 u^2 + K3 u^3 + C1 u' of Table 6 along our motion."""
    (figure,) = (figure for figure in reproduction.figures if figure.number == 19)
    line = named(figure.draw(reproduction.fits), "paper's cubic")
    run = reproduction.fits.runs.cases["validation"]
    u = run.approach
    np.testing.assert_allclose(line.y, 0.8674 * u + 0.3823 * u**2 - 0.0185 * u**3 + 0.033 * run.rate)


def test_figures_of_films_and_motions():
    steady = solve_steady(IN_SI, grid=Grid(n=32))
    steps = TimeSteps(until=1.0 * IN_SI.scales.time, dt=0.1 * IN_SI.scales.time)
    run = simulate(IN_SI, HarmonicLoad(Omega=3.0), grid=Grid(n=32), time=steps)
    maps, midplanes = film_picture(steady)
    pictures = (maps, midplanes, convergence(steady), coloured_fringes(steady), histories(run, None))
    said = [text for picture in pictures for text in texts(picture)] + texts(Picture(film_wave(run).panels()))
    assert not [text for text in said if SPELLED.search(text)]
    assert any("[µm]" in text for text in texts(maps))


@pytest.mark.parametrize("kappa", [0.1, 0.5, 1.0, 3.0])
def test_note_on_an_ellipse_out_of_scale(kappa):
    """The note against the axes, dimensionless: pixels of a semi-axis along over those of one across."""
    picture, _ = film_picture(solve_steady(MoesPoint(20.0, 5.0, kappa), grid=Grid(n=64)))
    first = picture.panels[0]
    upwards = first.x[1][0] == "place across"
    assert upwards == (kappa < 1.0) and ("upwards" in first.title) == upwards
    ratio = figure_of(picture).layout.yaxis.scaleratio  # px of a unit upwards over those of one to the right
    stretch = (ratio if upwards else 1.0 / ratio) / kappa  # of x against y
    if abs(stretch - 1.0) < 0.02:
        assert "scale" not in picture.note
        return
    assert "White lines: 0.92, 1.08, 1.3, 1.8 of the central film." in picture.note
    longer, times = re.search(r"Not to scale: (x|y) stretched (\S+) times", picture.note).groups()
    assert float(times) == pytest.approx(stretch if longer == "x" else 1.0 / stretch, rel=0.06), picture.note
