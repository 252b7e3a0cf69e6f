"""Options that several subcommands share, and the inputs they stand for."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ehlcontact.point import MoesPoint
from ehlcontact.solver.domain import Domain, check_intervals

_POINT, _GRID, _FILES = "Operating point", "Discretisation", "Results"

LoadM = Annotated[float, typer.Option("--M", help="Moes load parameter, > 0.", rich_help_panel=_POINT)]
OilL = Annotated[float, typer.Option("--L", help="Moes lubricant parameter, >= 0.", rich_help_panel=_POINT)]
Kappa = Annotated[float, typer.Option("--kappa", help="Ellipse ratio a/b, 0.01 to 100.", rich_help_panel=_POINT)]
Alpha = Annotated[
    float, typer.Option("--alpha", help="Pressure-viscosity coefficient, 1/Pa.", rich_help_panel=_POINT)
]
Eta0 = Annotated[float, typer.Option("--eta0", help="Ambient viscosity, Pa s.", rich_help_panel=_POINT)]
Viscosity = Annotated[
    str, typer.Option("--viscosity", help="roelands or barus.", rich_help_panel=_POINT, metavar="LAW")
]
Density = Annotated[
    str,
    typer.Option("--density", help="dowson-higginson or incompressible.", rich_help_panel=_POINT, metavar="LAW"),
]
Intervals = Annotated[int, typer.Option("--n", help="Intervals along X, a multiple of 16.", rich_help_panel=_GRID)]
ChosenIntervals = Annotated[
    int | None,
    typer.Option(
        "--n",
        show_default="what the film needs",
        help="Intervals along X, a multiple of 16.",
        rich_help_panel=_GRID,
    ),
]
Region = Annotated[
    tuple[float, float, float] | None,
    typer.Option(
        "--domain",
        metavar="XA XB YMAX",
        help="Computed region [[XA, XB] x [-YMAX, YMAX]] in Hertz semi-axes; -4.5 1.5 3 unless the load rises.",
        rich_help_panel=_GRID,
    ),
]
Save = Annotated[
    Path | None,
    typer.Option("--save", metavar="FILE", help="Save the result as HDF5.", rich_help_panel=_FILES),
]
JsonTo = Annotated[
    str | None,
    typer.Option(
        "--json",
        metavar="FILE",
        help="Write the result as JSON; - is stdout, with nothing else there.",
        rich_help_panel=_FILES,
    ),
]
FigureTo = Annotated[
    Path | None,
    typer.Option("--figure", metavar="FILE", help="Draw the result as PNG, SVG or PDF.", rich_help_panel=_FILES),
]

ALPHA, ETA0, VISCOSITY, DENSITY = 2.2e-8, 0.04, "roelands", "dowson-higginson"
HDF5 = (".h5", ".hdf5")
PICTURES = (".png", ".svg", ".pdf")


def region(domain: tuple[float, float, float] | None, n: int | None) -> Domain | None:
    """Check `n`, where given, and return the domain, None where the default is wanted."""
    if n is not None:
        check_intervals(n)
    return None if domain is None else Domain(*domain)


def point_rows(point: MoesPoint) -> list[tuple[str, str, str]]:
    """Rows of a table that say which contact this is."""
    return [("M, L, kappa", f"{point.M:g}, {point.L:g}, {point.kappa:g}", "")]


def domain_text(domain: Domain) -> str:
    """The region in words."""
    return f"[{domain.x_in:g}, {domain.x_out:g}] x [-{domain.y_max:g}, {domain.y_max:g}]"
