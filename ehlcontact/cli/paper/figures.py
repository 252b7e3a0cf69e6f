"""What each figure of the paper needs, shows and says."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from matplotlib.figure import Figure

from ehlcontact.cli.paper import film_figures as film
from ehlcontact.cli.paper import response_figures as response
from ehlcontact.cli.paper import spring_figure as spring
from ehlcontact.cli.paper.cases import FREE, HARMONIC
from ehlcontact.cli.paper.data import paper_fits
from ehlcontact.cli.paper.fits import Fits
from reduced_models.elements.spring import MemorylessContact


@dataclass(frozen=True)
class PaperFigure:
    """One figure; drawn only where all its cases converged."""

    number: int
    cases: tuple[str, ...]
    caption: str
    draw: Callable[[Fits], Figure]
    numbers: Callable[[Fits], dict[str, Any]] = lambda fits: {}


def _fringes(case: str) -> Callable[[Fits], Figure]:
    def draw(fits: Fits) -> Figure:
        run = fits.runs.of(case)
        assert run is not None
        return film.fringes(run)

    return draw


def _film(fits: Fits) -> Figure:
    run = fits.runs.of("2")
    assert run is not None
    return film.minimum_and_central_film(run)


def _integrated(*cases: str) -> Callable[[Fits], dict[str, Any]]:
    """How far the cubic elements of the cases are from the full approach, and RK2(3) from Radau."""

    def numbers(fits: Fits) -> dict[str, Any]:
        found = {}
        for case in cases:
            fitted = fits.fit(case)
            if fitted is not None:
                found[f"case {case}"] = fits.difference(fitted.element, case)
        return found

    return numbers


def _rms(model: str, *cases: str) -> Callable[[Fits], dict[str, Any]]:
    def numbers(fits: Fits) -> dict[str, Any]:
        found = {case: fits.fit(case, model) for case in cases}
        return {f"case {case}: force rms": None if f is None else f.rms for case, f in found.items()}

    return numbers


def _swapped(motion: str, cases: tuple[str, ...], table: int) -> tuple[Callable[..., Figure], Callable[..., Any]]:
    """Elements of three cases under one motion: figure and numbers."""

    def elements() -> dict[str, MemorylessContact]:
        return {case: paper_fits()[table, case].cubic for case in cases}

    def numbers(fits: Fits) -> dict[str, Any]:
        found: dict[str, Any] = {f"paper's element {c}": fits.difference(e, motion) for c, e in elements().items()}
        for case in cases:
            fitted = fits.fit(case)
            if fitted is not None:
                found[f"our element {case}"] = fits.difference(fitted.element, motion)
        return found

    return lambda fits: response.one_motion(fits, motion, elements()), numbers


_FIG17, _NUM17 = _swapped("4", HARMONIC, 5)
_FIG18, _NUM18 = _swapped("3", FREE, 3)

FIGURES = {
    figure.number: figure
    for figure in (
        PaperFigure(
            2,
            (),
            "Approach at rest over M: points are solves, lines Wijnant's formula, which the paper compares with.",
            lambda fits: film.static_approach(fits.runs),
            lambda fits: {f"M = {M:g}, L = {L:g}": r.approach for (M, L), r in fits.runs.static.items()},
        ),
        PaperFigure(
            4, ("validation",), "Pseudo-interferograms of the load ramp, T = 0 to 5.6.", _fringes("validation")
        ),
        PaperFigure(
            5,
            ("2", "3"),
            "Approach of the free vibrations with Omega_n = 5.13 and 2.56.",
            lambda fits: response.approaches(fits.runs, ("2", "3")),
        ),
        PaperFigure(6, ("2",), "Central and minimum film of the free vibration, Omega_n = 5.13.", _film),
        PaperFigure(
            7,
            ("2",),
            "Pseudo-interferograms of the free vibration, Omega_n = 5.13: a wave runs through.",
            _fringes("2"),
        ),
        PaperFigure(
            8,
            ("2",),
            "Linear element, case 2: force and acceleration miss the amplitude.",
            lambda fits: response.forces(fits, ("2",), "linear", acceleration=True),
            _rms("linear", "2"),
        ),
        PaperFigure(
            9,
            ("2",),
            "Cubic element, case 2: force and acceleration.",
            lambda fits: response.forces(fits, ("2",), "cubic", acceleration=True),
            _rms("cubic", "2"),
        ),
        PaperFigure(
            10,
            ("2", "3"),
            "Approach of the cubic elements of cases 2 and 3, integrated by Bogacki-Shampine RK2(3) from the "
            "start of the fitted window.",
            lambda fits: response.reduced_approaches(fits, ("2", "3")),
            _integrated("2", "3"),
        ),
        PaperFigure(
            11,
            ("4", "5"),
            "Approach under harmonic load, Omega = pi and 2 pi.",
            lambda fits: response.approaches(fits.runs, ("4", "5")),
        ),
        PaperFigure(12, ("5",), "Pseudo-interferograms under harmonic load, Omega = 2 pi.", _fringes("5")),
        PaperFigure(
            13,
            ("5",),
            "Linear element, case 5: force.",
            lambda fits: response.forces(fits, ("5",), "linear"),
            _rms("linear", "5"),
        ),
        PaperFigure(
            14,
            ("4", "5"),
            "Cubic elements, cases 4 and 5: force.",
            lambda fits: response.forces(fits, ("4", "5"), "cubic"),
            _rms("cubic", "4", "5"),
        ),
        PaperFigure(
            15,
            ("4", "5"),
            "Approach of the cubic elements of cases 4 and 5, integrated by RK2(3).",
            lambda fits: response.reduced_approaches(fits, ("4", "5")),
            _integrated("4", "5"),
        ),
        PaperFigure(
            16,
            HARMONIC,
            "Stiffness polynomials of cases 4 to 6 continued outside the fitted interval: alike near force 1, "
            "apart and finally falling far from it. Our elements go on like a Hertz contact instead (dashed).",
            lambda fits: spring.polynomials(fits, HARMONIC),
            lambda fits: spring.spring_table(fits, HARMONIC),
        ),
        PaperFigure(
            17, ("4",), "Elements of cases 4, 5 and 6 under the load of case 4 (Omega = pi).", _FIG17, _NUM17
        ),
        PaperFigure(
            18, ("3",), "Elements of cases 1, 2 and 3 on the mass of case 3 (Omega_n = 2.56).", _FIG18, _NUM18
        ),
        PaperFigure(
            19,
            ("validation",),
            "Cubic element of the load ramp: force, and approach integrated by RK2(3).",
            lambda fits: response.ramp(fits, "validation"),
            _integrated("validation"),
        ),
    )
}
# Simulations that a figure's elements come from, besides those it shows.
ELEMENTS_OF = {17: HARMONIC, 18: FREE}
