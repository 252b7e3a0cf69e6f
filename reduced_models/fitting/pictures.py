"""Pictures of records beside the elements that were fitted to them: histories, loops, stiffness and damping."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ehlcontact.point import OperatingPoint
from ehlcontact.quantities import DAMPING, FREQUENCY, HERTZ, STIFFNESS
from ehlcontact.results.picture import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PALE_BLUE,
    RED,
    Band,
    Line,
    Mark,
    Panel,
    Picture,
    stiffness_and_damping,
)
from reduced_models.fitting.result import FitResult

STATIC = "static law of the element"
BEYOND = 0.3  # of the interval of approach, that the static law is drawn on either side of it
SMOOTH = 300  # frequencies of the curve of an element


def histories(run: Any, fitted: FitResult | None) -> Picture:
    """Approach, force and film of a `SimulationResult` over time, with the fitted force."""
    (t, time), (u, approach), (force, force_label) = (run.axis(name) for name in ("t", "approach", "force"))
    rest = run.static_approach
    above = [Line(t, u, "film", BLUE), Line(t[[0, -1]], [rest] * 2, "at rest", GREY, ":")]
    forces, bands = [Line(t, force, "film", BLUE)], list[tuple[Band, ...]]([()] * 3)
    if fitted is None:
        forces.append(Line(t, run.axis("load")[0], "load", GREY, ":"))
    else:
        window = fitted.window[0]
        element = np.asarray(fitted.element.force(run.approach, run.rate))
        forces.append(Line(t, element, "cubic element", RED, "--"))
        until = float(window[0])
        bands = [(Band(float(t[0]), until, text),) for text in ("", "not fitted", "")]
    films = film_lines(run)
    panels = [
        Panel(lines, time, label, x_ends=(float(t[0]), float(t[-1])), bands=band)
        for lines, label, band in zip(
            (above, forces, films),
            (("approach", approach[1]), ("force", force_label[1]), ("film", run.axis("h_min")[1][1])),
            bands,
            strict=True,
        )
    ]
    return Picture(panels, columns=1, heights=(150.0,), shared=True)


def film_lines(run: Any) -> list[Line]:
    """Central and minimum film over time."""
    t = run.axis("t")[0]
    return [
        Line(t, run.axis("h_central")[0], "centre", GREEN),
        Line(t, run.axis("h_min")[0], "minimum", ORANGE),
    ]


def loops(runs: Mapping[str, Any], fits: Mapping[str, FitResult], titles: Mapping[str, str]) -> Picture:
    """Force against approach of each record with its cubic element; below, the part that is not its spring."""
    above, below = [], []
    for name, run in runs.items():
        (u, approach), (force, label) = run.axis("approach"), run.axis("force")
        x, y = ("approach", approach[1]), ("force", label[1])
        loop, rest, valid = [Line(u, force, "film", BLUE)], list[Line](), tuple[Band, ...]()
        if name in fits:
            loop, rest, valid = _fitted_loop(run, fits[name])
        above.append(Panel(loop, x, y, title=titles[name], bands=valid))
        plain = [Band(band.low, band.high, "", band.colour) for band in valid]
        below.append(Panel(rest, x, ("less static law", label[1]), bands=plain))
    return Picture([*above, *below], columns=len(runs), heights=(290.0, 190.0), shared=True)


def _fitted_loop(run: Any, found: FitResult) -> tuple[list[Line], list[Line], tuple[Band, ...]]:
    """The part of a loop that was fitted, with the element; both less the element's static law; its validity."""
    element, window = found.element, found.window[0]
    part = (run.t >= window[0]) & (run.t <= window[1])
    u, rate = run.approach[part], run.rate[part]
    model, spring = (np.asarray(f) for f in (element.force(u, rate), element.spring(u)))
    low, high = element.low, element.high
    wide = np.linspace(low - BEYOND * (high - low), high + BEYOND * (high - low), 200)
    law = Line(wide, np.asarray(element.spring(wide)), STATIC, GREY, width=1.0)
    pairs = [
        [
            Line(u, run.force[part] - less, "film", BLUE),
            Line(u, model - less, "cubic element", RED, "--"),
        ]
        for less in (np.zeros_like(spring), spring)
    ]
    return [law, *pairs[0]], pairs[1], (Band(float(low), float(high), "valid", PALE_BLUE),)


def impedance(response: Any, memory: Any, cubics: Sequence[FitResult], frequencies: tuple[float, ...]) -> Picture:
    """K and C of the film, of the film-memory element where there is one, and of cubics at their frequency.

    Parameters
    ----------
    response : Response
        Of the film, to approach; all that follows is in its units.
    memory : element or None
    cubics : sequence of FitResult
        Those with a tangent are shown.
    frequencies : (float,) or (float, float)
        Angular frequencies of the rotor's speed and, where there is one, of its vertical mode.
    """
    film = response[response.omega > 0.0]
    found = [cubic for cubic in cubics if cubic.tangent is not None]
    at = [float(np.mean(cubic.valid["omega"])) for cubic in found]
    si = isinstance(film.point, OperatingPoint)
    w = np.geomspace(min(0.5 * frequencies[0], float(film.omega[0])), float(film.omega[-1]), SMOOTH)
    Z = None if memory is None else memory.impedance(**{"omega" if si else "Omega": w})
    known = {
        "stiffness": [cubic.tangent for cubic in found],
        "damping": [cubic.parameters["C1"] for cubic in found],
    }
    unit = 0.5 / np.pi if si else 1.0  # of the frequency in the picture

    def lines(name: str) -> Iterator[Line]:
        yield Line(unit * film.omega, getattr(film, name), "film", BLUE, "", "o", bars=film.error_bars[name])
        if Z is not None:
            yield Line(unit * w, getattr(Z, name), "film memory, one element", GREEN)
        if found:
            squares = np.array(known[name], dtype=float)
            yield Line(unit * np.array(at), squares, "cubic element of each record", RED, "", "s")

    marks = [Mark(unit * omega, name) for omega, name in zip(frequencies, ("speed", "mode"), strict=False)]
    frequency = ("frequency", HERTZ.unit) if si else ("angular frequency", FREQUENCY.moes)
    units = (STIFFNESS.unit, DAMPING.unit) if si else (STIFFNESS.moes, DAMPING.moes)
    return Picture(stiffness_and_damping(lines, frequency, units, marks=marks))
