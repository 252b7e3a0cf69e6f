"""HTML pages that need no other file: a template, numbers and pictures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from matplotlib.figure import Figure

from ehlcontact.cli.numerals import numeral, percent
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
    environment.filters |= {"sig": numeral, "percent": percent, "cell": cell}
    with styled():
        images = {name: embedded(draw()) for name, draw in drawings.items()}
    return write_text(path, environment.get_template(template).render(images=images, **content), "file")


def cell(value: float | str | None, digits: int = 5) -> str:
    """A table cell in words: nothing for None, counts as they are."""
    if value is None:
        return ""
    return str(value) if isinstance(value, str | int) else numeral(value, digits)
