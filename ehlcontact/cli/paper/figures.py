"""What each figure of the paper needs, shows and says."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.figure import Figure

from ehlcontact.cli.paper.data import paper_fits
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.runs import CASES, FREE, HARMONIC, STATIC_LOADS, STATIC_OILS
from ehlcontact.cli.plots import paper as plots
from ehlcontact.cli.plots.fringes import snapshots
from reduced_models import FitResult

Draw = Callable[[Fits], Figure]
Numbers = Callable[[Fits], dict[str, Any]]
OUTSIDE = (0.5, 1.5, 2.5)  # approaches at which Fig. 16 is also told in numbers


@dataclass(frozen=True)
class PaperFigure:
    """One figure; drawn only where all its cases converged."""

    number: int
    cases: tuple[str, ...]
    caption: str
    draw: Draw
    numbers: Numbers = lambda fits: {}


def _static(fits: Fits) -> Figure:
    found = {point: result.approach for point, result in fits.runs.static.items()}
    return plots.static_approach(found, STATIC_LOADS, STATIC_OILS)


def _fringes(case: str) -> Draw:
    return lambda fits: snapshots(fits.runs.cases[case, fits.runs.n])


def _approaches(*cases: str) -> Draw:
    return lambda fits: plots.approaches({CASES[case].title: fits.runs.cases[case, fits.runs.n] for case in cases})


def _force(fits: Fits, case: str, model: str = "cubic", **what: bool) -> plots.Panel:
    return plots.force(CASES[case].title, fits.record(case), fits.fit(case, model), **what)


def _force_and_acceleration(case: str, model: str) -> Draw:
    return lambda fits: plots.row(_force(fits, case, model), _force(fits, case, model, acceleration=True))


def _forces(model: str, *cases: str) -> Draw:
    return lambda fits: plots.row(*(_force(fits, case, model) for case in cases))


def _reduced(fits: Fits, case: str) -> plots.Panel:
    found = fits.fit(case)
    reduced = None if found is None else fits.integrated(found.element, case)
    return plots.approach(CASES[case].title, fits.record(case), reduced)


def _reduced_approaches(*cases: str) -> Draw:
    return lambda fits: plots.row(*(_reduced(fits, case) for case in cases))


def _integrated(*cases: str) -> Numbers:
    """How far the cubic elements of the cases are from the full approach, and RK2(3) from Radau."""
    return lambda fits: {
        f"case {case}": fits.difference(found.element, case) for case, found in _cubics(fits, cases).items()
    }


def _rms(model: str, *cases: str) -> Numbers:
    def numbers(fits: Fits) -> dict[str, Any]:
        found = {case: fits.fit(case, model) for case in cases}
        return {f"case {case}: force rms": None if f is None else f.rms for case, f in found.items()}

    return numbers


def _cubics(fits: Fits, cases: Sequence[str]) -> dict[str, FitResult]:
    """Our cubic fits of the cases, as far as there are any."""
    return {case: found for case in cases if (found := fits.fit(case)) is not None}


def _elements(fits: Fits, cases: Sequence[str], table: int) -> dict[str, dict[str, Any]]:
    """The paper's and our elements of the cases."""
    ours = {case: found.element for case, found in _cubics(fits, cases).items()}
    return {"paper's": {case: paper_fits()[table, case].cubic for case in cases}, "our": ours}


def _swapped(motion: str, cases: Sequence[str], table: int) -> tuple[Draw, Numbers]:
    """Elements of three cases under one motion: figure and numbers."""

    def draw(fits: Fits) -> Figure:
        runs = {
            whose: {case: fits.integrated(element, motion) for case, element in elements.items()}
            for whose, elements in _elements(fits, cases, table).items()
        }
        return plots.swapped(CASES[motion].title, fits.record(motion), runs)

    def numbers(fits: Fits) -> dict[str, Any]:
        return {
            f"{whose} element {case}": fits.difference(element, motion)
            for whose, elements in _elements(fits, cases, table).items()
            for case, element in elements.items()
        }

    return draw, numbers


def _springs(fits: Fits) -> Figure:
    paper = {case: paper_fits()[5, case].cubic.parameters for case in HARMONIC}
    return plots.springs(paper, _cubics(fits, HARMONIC))


def _spring_numbers(fits: Fits) -> dict[str, float]:
    """Spring forces outside the fitted interval: polynomial and element."""
    values: dict[str, float] = {}
    for case, found in _cubics(fits, HARMONIC).items():
        for u in OUTSIDE:
            values[f"case {case}: polynomial at {u:g}"] = plots.polynomial(found.parameters, u)
            values[f"case {case}: element at {u:g}"] = float(found.element.spring(u))
    return values


FIGURES = {
    figure.number: figure
    for figure in (
        PaperFigure(
            2,
            (),
            "Approach at rest over M: points are solves, lines Wijnant's formula, which the paper compares with.",
            _static,
            lambda fits: {f"M = {M:g}, L = {L:g}": r.approach for (M, L), r in fits.runs.static.items()},
        ),
        PaperFigure(
            4, ("validation",), "Pseudo-interferograms of the load ramp, T = 0 to 5.6.", _fringes("validation")
        ),
        PaperFigure(
            5,
            ("2", "3"),
            "Approach of the free vibrations with Omega_n = 5.13 and 2.56.",
            _approaches("2", "3"),
        ),
        PaperFigure(
            6,
            ("2",),
            "Central and minimum film of the free vibration, Omega_n = 5.13.",
            lambda fits: plots.film(fits.runs.cases["2", fits.runs.n]),
        ),
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
            _force_and_acceleration("2", "linear"),
            _rms("linear", "2"),
        ),
        PaperFigure(
            9,
            ("2",),
            "Cubic element, case 2: force and acceleration.",
            _force_and_acceleration("2", "cubic"),
            _rms("cubic", "2"),
        ),
        PaperFigure(
            10,
            ("2", "3"),
            "Approach of the cubic elements of cases 2 and 3, integrated by Bogacki-Shampine RK2(3) from the "
            "start of the fitted window.",
            _reduced_approaches("2", "3"),
            _integrated("2", "3"),
        ),
        PaperFigure(11, ("4", "5"), "Approach under harmonic load, Omega = pi and 2 pi.", _approaches("4", "5")),
        PaperFigure(12, ("5",), "Pseudo-interferograms under harmonic load, Omega = 2 pi.", _fringes("5")),
        PaperFigure(13, ("5",), "Linear element, case 5: force.", _forces("linear", "5"), _rms("linear", "5")),
        PaperFigure(
            14,
            ("4", "5"),
            "Cubic elements, cases 4 and 5: force.",
            _forces("cubic", "4", "5"),
            _rms("cubic", "4", "5"),
        ),
        PaperFigure(
            15,
            ("4", "5"),
            "Approach of the cubic elements of cases 4 and 5, integrated by RK2(3).",
            _reduced_approaches("4", "5"),
            _integrated("4", "5"),
        ),
        PaperFigure(
            16,
            HARMONIC,
            "Stiffness polynomials of cases 4 to 6 continued outside the fitted interval: alike near force 1, "
            "apart and finally falling far from it. Our elements go on like a Hertz contact instead (dashed).",
            _springs,
            _spring_numbers,
        ),
        PaperFigure(
            17,
            ("4",),
            "Elements of cases 4, 5 and 6 under the load of case 4 (Omega = pi).",
            *_swapped("4", HARMONIC, 5),
        ),
        PaperFigure(
            18,
            ("3",),
            "Elements of cases 1, 2 and 3 on the mass of case 3 (Omega_n = 2.56).",
            *_swapped("3", FREE, 3),
        ),
        PaperFigure(
            19,
            ("validation",),
            "Cubic element of the load ramp: force, and approach integrated by RK2(3).",
            lambda fits: plots.row(_force(fits, "validation"), _reduced(fits, "validation")),
            _integrated("validation"),
        ),
    )
}
# Simulations that a figure's elements come from, besides those it shows.
ELEMENTS_OF = {17: HARMONIC, 18: FREE}
