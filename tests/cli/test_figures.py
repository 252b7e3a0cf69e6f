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
from ehlcontact.cli.plots import film, motion
from ehlcontact.cli.plots.finish import finished

IN_SI = OperatingPoint(Geometry(12.7e-3, 20e-3), Lubricant(0.1), 20.0, 0.5)
PLAIN = MoesPoint(50.0, 5.0, 0.5)
SPELLED = re.compile(r"\bum\b|Omega|omega|kappa|\bpi\b|e[+-]\d\d")


def named(figure, name, number=0):
    """A trace called `name`."""
    return [trace for trace in figure.data if trace.name == name][number]


@pytest.mark.parametrize(("point", "si"), [(IN_SI, True), (PLAIN, False)], ids=["SI", "dimensionless"])
def test_mid_planes(point, si):
    result = solve_steady(point, grid=Grid(n=32))
    figure = film.midplanes(result)
    place, gap = (point.scales.a * 1e3, point.scales.length * 1e6) if si else (1.0, 1.0)
    assert ("[GPa]" in figure.layout.yaxis.title.text) == si
    np.testing.assert_allclose(named(figure, "film").x, result.X * place)
    np.testing.assert_allclose(named(figure, "film").y, result.H[:, 0] * gap)
    np.testing.assert_allclose(named(figure, "dry Hertz").y.max(), point.scales.pressure * 1e-9 if si else 1.0)


@pytest.mark.parametrize(("point", "si"), [(IN_SI, True), (PLAIN, False)], ids=["SI", "dimensionless"])
def test_histories_and_film_wave(point, si):
    unit = IN_SI.scales.time if si else 1.0
    steps = TimeSteps(until=1.0 * unit, dt=0.1 * unit)
    run = simulate(point, HarmonicLoad(Omega=3.0), grid=Grid(n=32), time=steps)
    figure = motion.histories(run, None)
    labels = {axis.title.text for axis in figure.select_yaxes()}
    assert {"approach [µm]", "force [N]"} <= labels if si else {"approach u", "force f/f0"} <= labels
    np.testing.assert_allclose(named(figure, "minimum").x, run.T * (run.scales.time * 1e3 if si else 1.0))
    unit = run.scales.length * 1e6 if si else 1.0
    np.testing.assert_allclose(named(figure, "minimum").y, run.h_min * unit)
    shown = motion.wave(run).data[0]
    assert (shown.x[0], shown.x[-1], shown.y[0], shown.y[-1]) == (0.0, run.T[-1], -1.1, 1.1)
    np.testing.assert_allclose(shown.z[:, 0], 0.0, atol=1e-12 * unit)
    centre = (run.h_midplane[-1] - run.h_midplane[0])[np.argmin(np.abs(run.X))]
    np.testing.assert_allclose(shown.z[shown.z.shape[0] // 2, -1], centre * unit, rtol=1e-6)


def test_loops_show_the_element_that_was_fitted():
    """In its window, in SI: its force along the record, and below, the damper's part alone."""
    from ehlcontact.cli.plots.motion import loops
    from reduced_models import ContactRecord, fit

    unit = IN_SI.scales.time
    steps = TimeSteps(until=4.0 * unit, dt=0.05 * unit)
    run = simulate(IN_SI, HarmonicLoad(Omega=3.0), grid=Grid(n=32), time=steps)
    found = fit(ContactRecord.from_result(run), "cubic", (2.0, 4.0))
    figure = loops({"harmonic": run}, {"harmonic": found}, {"harmonic": "a title"})
    assert "a title" in [note.text for note in figure.layout.annotations]
    k, inside = found.parameters, run.T >= 2.0
    u, damper = run.approach[inside], k["C1"] * run.rate[inside]
    spring = k["K1"] * u + k["K2"] * u**2 + k["K3"] * u**3
    element, film = named(figure, "cubic element"), named(figure, "film")
    np.testing.assert_allclose(element.x, u * run.scales.length * 1e6)
    np.testing.assert_allclose(element.y, (spring + damper) * run.scales.force)
    np.testing.assert_allclose(film.y, run.force[inside] * run.scales.force)
    element, film = named(figure, "cubic element", 1), named(figure, "film", 1)
    np.testing.assert_allclose(film.y, (run.force[inside] - spring) * run.scales.force, atol=1e-12)
    np.testing.assert_allclose(element.y, damper * run.scales.force, atol=1e-12)


def test_spectrum_shows_amplitudes():
    """Of a run with known ones, over its settled part: 3 um twice a revolution, 7 N once, whatever the means."""
    from ehlcontact.cli.plots.rotor import spectrum
    from reduced_models.rotor.settling import Settling

    t = np.arange(3 * 40 + 1) / 2000.0
    turned = 2.0 * np.pi * 50.0 * t
    start = 1.0 + (t <= 0.02)  # the first of three revolutions is not settled
    moved = np.column_stack([np.zeros(t.size), 1e-6 * start * (20.0 + 3.0 * np.sin(2.0 * turned))])
    force = (100.0 + 7.0 * start * np.cos(turned))[:, None]
    once, places = np.zeros((t.size, 1)), {"names": ("disc x", "disc y"), "places": np.array([0, 1])}
    run = run_of(t, once, once, force, displacement=moved, **places)
    figure = spectrum({"full": run}, Settling((0.5, 0.0), 0.01), {"full": "full film"})
    displacement, load = (np.array([trace.x, trace.y]) for trace in figure.data)
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
    from ehlcontact.results.picture import Panel, draw

    film = solve_steady(IN_SI, grid=Grid(n=32))
    own = Panel((film.X, "place"), [("", film.H[:, 0], None)], "gap")
    figure = draw("a title", [*film.panels(), *interferogram(film_of(film), 600e-9).panels(), own])
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert len(labels) == len(film.plot().axes) + 3 and labels[-1] == "gap"  # fringes with their bar
    assert "intensity" in " ".join(labels)


def texts(figure):
    """All that a figure says: names, titles, labels, notes, what the pointer shows."""
    layout = figure.layout
    found = [note.text for note in layout.annotations] + [trace.name for trace in figure.data]
    found += [axis.title.text for axes in (figure.select_xaxes(), figure.select_yaxes()) for axis in axes]
    found += [layout[name].colorbar.title.text for name in layout if name.startswith("coloraxis")]
    return [text for text in (*found, layout.meta.get("note", "")) if text]


@pytest.fixture(scope="module")
def reproduction(tmp_path_factory):
    return reproduce((), [n for n in FIGURES if n != 2], tmp_path_factory.mktemp("figures"), 32)


@pytest.mark.long
@pytest.mark.parametrize("number", [n for n in FIGURES if n != 2])
def test_figures_of_the_paper(reproduction, number):
    (figure,) = (figure for figure in reproduction.figures if figure.number == number)
    drawn = figure.draw(reproduction.fits)
    json.dumps(finished(drawn), allow_nan=False)
    said = [*texts(drawn), figure.caption, figure.theirs]
    assert not [text for text in said if SPELLED.search(text)]
    # the paper's own values where there are any, and where there are none that is said
    shown = any("paper" in text for text in texts(drawn))
    assert shown or "not shown" in figure.theirs
    assert ("Not to scale" in " ".join(said)) == (number in (7, 12))  # fringes of an ellipse; a circle is none


def test_the_papers_elements_are_drawn_as_printed(reproduction):
    """Fig. 19, left: K1 u + K2 u^2 + K3 u^3 + C1 u' of Table 6 along our motion."""
    (figure,) = (figure for figure in reproduction.figures if figure.number == 19)
    line = next(trace for trace in figure.draw(reproduction.fits).data if trace.name == "paper's cubic")
    run = reproduction.fits.runs.cases["validation"]
    u = run.approach
    np.testing.assert_allclose(line.y, 0.8674 * u + 0.3823 * u**2 - 0.0185 * u**3 + 0.033 * run.rate)


def test_figures_of_films_and_motions():
    steady = solve_steady(IN_SI, grid=Grid(n=32))
    steps = TimeSteps(until=1.0 * IN_SI.scales.time, dt=0.1 * IN_SI.scales.time)
    run = simulate(IN_SI, HarmonicLoad(Omega=3.0), grid=Grid(n=32), time=steps)
    draws = (film.film_maps, film.midplanes, film.convergence, film.interferogram_picture)
    said = {draw.__name__: texts(draw(steady)) for draw in draws}
    said |= {"wave": texts(motion.wave(run)), "histories": texts(motion.histories(run, None))}
    assert not [text for found in said.values() for text in found if SPELLED.search(text)]
    assert any("[µm]" in text for text in said["film_maps"])


@pytest.mark.parametrize("kappa", [0.1, 0.5, 1.0, 3.0])
def test_note_on_an_ellipse_out_of_scale(kappa):
    """The note against the axes, dimensionless: pixels of a semi-axis along over those of one across."""
    figure = film.film_maps(solve_steady(MoesPoint(20.0, 5.0, kappa), grid=Grid(n=64)))
    stretch = figure.layout.yaxis.scaleratio / kappa  # of x, which is upwards, against y
    note, _, lines = figure.layout.meta["note"].partition("White lines: ")
    assert lines == ", ".join(f"{level:g}" for level in film.CONTOURS) + " of the central film."
    if abs(stretch - 1.0) < 0.02:
        assert note == ""
        return
    longer, times = re.search(r"Not to scale: (x|y) stretched (\S+) times", note).groups()
    assert float(times) == pytest.approx(stretch if longer == "x" else 1.0 / stretch, rel=0.06), note
