"""One look for all figures, without touching matplotlib's global state, and no window."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import matplotlib as mpl
from matplotlib.figure import Figure

from ehlcontact.files import write_bytes

# Okabe and Ito's colours, which stay apart for colour-blind eyes.
BLUE, ORANGE, GREEN, RED, PURPLE, GREY = "#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#7f7f7f"
WIDTH = 9.0  # inches
DPI, FILE_DPI = 110, 130  # of figures in pages, and of those in files of their own

Result = TypeVar("Result")

_STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 10.5,
    "axes.titlesize": 11,
    "axes.labelsize": 10.5,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#555555",
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "legend.fontsize": 9.5,
    "image.cmap": "viridis",
}


@contextmanager
def styled() -> Iterator[None]:
    """The figures' style for as long as they are drawn and saved."""
    with mpl.rc_context(_STYLE):
        yield


def new_figure(height: float, width: float = WIDTH) -> Figure:
    """Empty figure that arranges its axes itself; it belongs to no window system."""
    return Figure(figsize=(width, height), layout="constrained")


def legend_above(axes: Any, **options: Any) -> None:
    """Legend in one row above the axes, where it hides nothing."""
    handles = options.pop("handles", None) or axes.get_legend_handles_labels()[0]
    axes.legend(
        handles=handles,
        loc="lower right",
        bbox_to_anchor=(1.0, 0.98),
        ncols=len(handles),
        borderaxespad=0.2,
        **options,
    )


def embedded(figure: Figure) -> str:
    """The figure as a ``data:`` address for an image in a page that needs no other file."""
    image = _image(figure, "png", DPI, metadata={"Software": None})
    return "data:image/png;base64," + base64.b64encode(image).decode("ascii")


def write_figure(draw: Callable[[Result], Figure], result: Result, path: Path) -> None:
    """Draw `result` in the house style and write it to `path`, in the format that its ending says.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    with styled():
        figure = draw(result)
        image = _image(figure, path.suffix[1:].lower(), FILE_DPI)
    write_bytes(path, image, "--figure")


def _image(figure: Figure, kind: str, dpi: int, **options: Any) -> bytes:
    """The figure as the content of a file."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format=kind, dpi=dpi, facecolor="white", **options)
    return buffer.getvalue()
