"""Every text of every picture: units as they are written, no symbol spelled, no map out of scale unsaid."""

import re

import numpy as np
import pytest
from matplotlib.text import Text

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
from ehlcontact.cli.plots import film, fringes, motion
from ehlcontact.cli.plots.style import styled

BALL = OperatingPoint(Geometry(12.7e-3, 20e-3), Lubricant(0.1), 20.0, 0.5)
SPELLED = re.compile(r"\bum\b|Omega|omega|kappa|\bpi\b|e[+-]\d\d")


def texts(figure):
    """All that a figure says, its ticks included."""
    figure.draw_without_rendering()
    return [text.get_text() for text in figure.findobj(Text) if text.get_visible() and text.get_text()]


@pytest.fixture(scope="module")
def reproduction(tmp_path_factory):
    return reproduce((), [n for n in FIGURES if n != 2], tmp_path_factory.mktemp("figures"), 32)


@pytest.mark.parametrize("number", [n for n in FIGURES if n != 2])
def test_figures_of_the_paper(reproduction, number):
    (figure,) = (figure for figure in reproduction.figures if figure.number == number)
    with styled():
        drawn = figure.draw(reproduction.fits)
    said = [*texts(drawn), figure.caption, figure.theirs]
    assert not [text for text in said if SPELLED.search(text)]
    # the paper's own values where there are any, and where there are none that is said
    shown = any("paper" in text for text in texts(drawn))
    assert shown or "not shown" in figure.theirs
    assert ("not to scale" in " ".join(said)) == (number in (7, 12))  # fringes of an ellipse; a circle is none


def test_the_papers_elements_are_drawn_as_printed(reproduction):
    """Fig. 19, left: K1 u + K2 u^2 + K3 u^3 + C1 u' of Table 6 along our motion."""
    (figure,) = (figure for figure in reproduction.figures if figure.number == 19)
    axes = figure.draw(reproduction.fits).axes[0]
    (line,) = (line for line in axes.get_lines() if line.get_label() == "paper's cubic")
    run = reproduction.fits.runs.cases["validation", 32]
    u = run.approach
    np.testing.assert_allclose(line.get_ydata(), 0.8674 * u + 0.3823 * u**2 - 0.0185 * u**3 + 0.033 * run.rate)


def test_figures_of_films_and_motions():
    steady = solve_steady(BALL, grid=Grid(n=32))
    steps = TimeSteps(until=1.0 * BALL.scales.time, dt=0.1 * BALL.scales.time)
    run = simulate(BALL, HarmonicLoad(Omega=3.0), grid=Grid(n=32), time=steps)
    draws = (film.steady_figure, film.film_maps, film.midplanes, film.convergence, fringes.three_lights)
    said = {draw.__name__: texts(draw(steady)) for draw in draws}
    said |= {"simulation": texts(motion.simulation_figure(run)), "wave": texts(motion.wave(run))}
    said["histories"] = texts(motion.histories(run, None))
    assert not [text for found in said.values() for text in found if SPELLED.search(text)]
    assert any("[µm]" in text for text in said["film_maps"])


@pytest.mark.parametrize("kappa", [0.1, 0.5, 1.0, 3.0])
def test_an_ellipse_out_of_scale_says_how_much(kappa):
    """The note against the drawing itself: pixels of a semi-axis along and across."""
    steady = solve_steady(MoesPoint(20.0, 5.0, kappa), grid=Grid(n=64))
    for draw, upwards in ((film.film_maps, True), (film.steady_figure, False)):
        figure = draw(steady)
        said = texts(figure)
        axes = next(axes for axes in figure.axes if axes.images)
        (x0, y0), (x1, y1) = axes.transData.transform([(0.0, 0.0), (1.0, 1.0)])
        across, along = (x1 - x0, y1 - y0) if upwards else (y1 - y0, x1 - x0)
        stretch = along / (kappa * across)  # of x against y
        notes = [text for text in said if "not to scale" in text]
        if abs(stretch - 1.0) < 0.02:
            assert notes == []
            continue
        (note,) = notes
        longer, times = re.search(r"(x|y) stretched (\S+) times", note).groups()
        assert float(times) == pytest.approx(stretch if longer == "x" else 1.0 / stretch, rel=0.06), note
