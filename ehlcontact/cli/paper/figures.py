"""What each figure of the paper needs, shows and says."""

from __future__ import annotations

from dataclasses import dataclass

from ehlcontact.cli.paper import numbers as n
from ehlcontact.cli.paper import pictures as p
from ehlcontact.cli.paper.data import FIRST_VALLEY
from ehlcontact.cli.paper.runs import CASES, FREE, HARMONIC

# What several captions say.
FRINGES = f"{p.FRINGES_AT_REST} fringes to the central film at rest"
ROOTS = "Dotted: approach at which the paper's cubics (Table {}) carry the static load."
INTEGRATED = "integrated by Bogacki-Shampine RK2(3) from the start of the fitted window"
# What there is of the paper in a figure.
CURVES = "its curves are a picture only, and not shown."
ELEMENT = "its curves are a picture only; dashed: its element, of Table {}, on our motion."


@dataclass(frozen=True)
class PaperFigure:
    """One figure; drawn only where all its cases converged."""

    number: int
    cases: tuple[str, ...]
    caption: str
    theirs: str  # what of the paper's figure is shown, and what is not
    draw: p.Draw
    numbers: n.Numbers = lambda fits: {}


FIGURES = {
    figure.number: figure
    for figure in (
        PaperFigure(
            2,
            (),
            "Approach at rest over M, for a circle, as the paper does not say for which ellipse. Points: our "
            "solves; lines: Wijnant's formula.",
            "its lines are this formula; its points are a picture only, and not shown.",
            p.static,
            n.static_numbers,
        ),
        PaperFigure(
            4,
            ("validation",),
            f"Pseudo-interferograms of the load ramp, {FRINGES}.",
            "its fringes are pictures only, and not shown. Its text gives the film at rest in micrometres, for "
            "scales that it does not state: only ratios compare.",
            p.fringes("validation"),
            n.films_at_rest,
        ),
        PaperFigure(
            5,
            ("2", "3"),
            f"Approach of two free vibrations. {ROOTS.format(3)}",
            CURVES,
            p.approaches(3, "2", "3"),
        ),
        PaperFigure(
            6,
            ("2",),
            f"Central and minimum film, {CASES['2'].title}.",
            f"{CURVES} Its text sees the first valley of the central film close to T = {FIRST_VALLEY:g}; a turn "
            f"counts here if its height is {100 * n.TURN:.0f} % of the film's range.",
            p.film("2"),
            n.first_turns,
        ),
        PaperFigure(
            7,
            ("2",),
            f"Pseudo-interferograms, {CASES['2'].title}, {FRINGES}.",
            "its fringes are pictures only, and not shown.",
            p.fringes("2"),
        ),
        PaperFigure(
            8,
            ("2",),
            "Linear element: force, and acceleration that follows from it.",
            ELEMENT.format(1),
            p.force_and_acceleration(1, "2"),
            n.rms(1, "2"),
        ),
        PaperFigure(
            9,
            ("2",),
            "Cubic element: force, and acceleration that follows from it.",
            ELEMENT.format(3),
            p.force_and_acceleration(3, "2"),
            n.rms(3, "2"),
        ),
        PaperFigure(
            10,
            ("2", "3"),
            f"Cubic elements: approach, {INTEGRATED}.",
            ELEMENT.format(3),
            p.of_cases(p.reduced, 3, "2", "3"),
            n.integrated(3, "2", "3"),
        ),
        PaperFigure(
            11,
            ("4", "5"),
            f"Approach under two harmonic loads. {ROOTS.format(5)}",
            CURVES,
            p.approaches(5, "4", "5"),
        ),
        PaperFigure(
            12,
            ("5",),
            f"Pseudo-interferograms, {CASES['5'].title}, {FRINGES}.",
            "its fringes are pictures only, and not shown.",
            p.fringes("5"),
        ),
        PaperFigure(
            13, ("5",), "Linear element: force.", ELEMENT.format(4), p.of_cases(p.force, 4, "5"), n.rms(4, "5")
        ),
        PaperFigure(
            14,
            ("4", "5"),
            "Cubic elements: force.",
            ELEMENT.format(5),
            p.of_cases(p.force, 5, "4", "5"),
            n.rms(5, "4", "5"),
        ),
        PaperFigure(
            15,
            ("4", "5"),
            f"Cubic elements: approach, {INTEGRATED}.",
            ELEMENT.format(5),
            p.of_cases(p.reduced, 5, "4", "5"),
            n.integrated(5, "4", "5"),
        ),
        PaperFigure(
            16,
            HARMONIC,
            "Stiffness polynomials of cases 4 to 6, continued outside the fitted interval (shaded), and our "
            "elements (dashed).",
            "left, the coefficients of Table 5.",
            p.springs,
            n.spring_numbers,
        ),
        PaperFigure(
            17,
            ("4",),
            f"Elements of cases 4, 5 and 6 under the load of case 4: approach, {INTEGRATED}.",
            "left, the elements of Table 5.",
            p.swapped("4", HARMONIC, 5),
            n.swapped("4", HARMONIC, 5),
        ),
        PaperFigure(
            18,
            ("3",),
            f"Elements of cases 1, 2 and 3 on the mass of case 3: approach, {INTEGRATED}.",
            "left, the elements of Table 3.",
            p.swapped("3", FREE, 3),
            n.swapped("3", FREE, 3),
        ),
        PaperFigure(
            19,
            ("validation",),
            f"Cubic element of the load ramp: force, and approach {INTEGRATED}.",
            ELEMENT.format(6),
            p.force_and_approach(6, "validation"),
            n.both(n.rms(6, "validation"), n.integrated(6, "validation")),
        ),
    )
}
# Simulations that a figure's elements come from, besides those it shows.
ELEMENTS_OF = {17: HARMONIC, 18: FREE}
