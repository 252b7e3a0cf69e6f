"""``--figure FILE``: a figure of the result beside the numbers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from ehlcontact.cli.output import check_file
from ehlcontact.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = (".png", ".svg", ".pdf")
DPI = 130

FigureTo = Annotated[
    Path | None,
    typer.Option(
        "--figure", metavar="FILE", help="Draw the result as PNG, SVG or PDF.", rich_help_panel="Results"
    ),
]

Result = TypeVar("Result")


def check_figure(path: Path | None) -> None:
    """Make sure, before a long solve, that the figure can be written.

    Raises
    ------
    InputError
        A name that does not end in one of `FORMATS`, or a place that cannot be written to.
    """
    check_file("--figure", path, FORMATS)


def write_figure(draw: Callable[[Result], Figure], result: Result, path: Path) -> None:
    """Draw `result` in the house style and write it to `path`.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    from ehlcontact.cli.plots.style import styled

    with styled():
        figure = draw(result)
        try:
            figure.savefig(path, dpi=DPI, facecolor="white")
        except OSError as error:
            raise InputError("--figure", str(path), f"a file that can be written ({error.strerror})") from None
