"""Every text of every picture: units as they are written, no symbol spelled, no map out of scale unsaid."""

import json
import re

import numpy as np
import pytest

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

BALL = OperatingPoint(Geometry(12.7e-3, 20e-3), Lubricant(0.1), 20.0, 0.5)
SPELLED = re.compile(r"\bum\b|Omega|omega|kappa|\bpi\b|e[+-]\d\d")


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
    run = reproduction.fits.runs.cases["validation", 32]
    u = run.approach
    np.testing.assert_allclose(line.y, 0.8674 * u + 0.3823 * u**2 - 0.0185 * u**3 + 0.033 * run.rate)


def test_figures_of_films_and_motions():
    steady = solve_steady(BALL, grid=Grid(n=32))
    steps = TimeSteps(until=1.0 * BALL.scales.time, dt=0.1 * BALL.scales.time)
    run = simulate(BALL, HarmonicLoad(Omega=3.0), grid=Grid(n=32), time=steps)
    draws = (film.film_maps, film.midplanes, film.convergence, film.interferogram_picture)
    said = {draw.__name__: texts(draw(steady)) for draw in draws}
    said |= {"wave": texts(motion.wave(run)), "histories": texts(motion.histories(run, None))}
    assert not [text for found in said.values() for text in found if SPELLED.search(text)]
    assert any("[µm]" in text for text in said["film_maps"])


@pytest.mark.parametrize("kappa", [0.1, 0.5, 1.0, 3.0])
def test_an_ellipse_out_of_scale_says_how_much(kappa):
    """The note against the axes, dimensionless: pixels of a semi-axis along over those of one across."""
    figure = film.film_maps(solve_steady(MoesPoint(20.0, 5.0, kappa), grid=Grid(n=64)))
    stretch = figure.layout.yaxis.scaleratio / kappa  # of x, which is upwards, against y
    note = figure.layout.meta["note"]
    if abs(stretch - 1.0) < 0.02:
        assert note == ""
        return
    longer, times = re.search(r"Not to scale: (x|y) stretched (\S+) times", note).groups()
    assert float(times) == pytest.approx(stretch if longer == "x" else 1.0 / stretch, rel=0.06), note
