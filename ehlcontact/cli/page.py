"""HTML pages that need no other file: a template, numbers and pictures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from matplotlib.figure import Figure

from ehlcontact.cli.plots.style import embedded, styled
from ehlcontact.files import write_text


def write_page(path: Path, template: str, drawings: Mapping[Any, Callable[[], Figure]], **content: Any) -> Path:
    """Draw all figures, which the template finds under ``images``, and write the page.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    environment = Environment(
        loader=PackageLoader("ehlcontact.cli"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"sig": significant, "cell": cell}
    with styled():
        images = {name: embedded(draw()) for name, draw in drawings.items()}
    return write_text(path, environment.get_template(template).render(images=images, **content), "file")


def significant(value: float | None, digits: int = 4) -> str:
    """The number with so many significant digits, a dash for none."""
    return "-" if value is None else f"{value:.{digits}g}"


def cell(value: float | str | None) -> str:
    """A table cell in words: five significant digits, fewer for small errors."""
    if value is None:
        return ""
    if isinstance(value, str | int):
        return str(value)
    return f"{value:.5g}" if abs(value) >= 1e-3 or value == 0.0 else f"{value:.3e}"
