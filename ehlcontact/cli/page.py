"""HTML pages that need no other file: a template, numbers and pictures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from matplotlib.figure import Figure

from ehlcontact.cli.numerals import numeral, percent
from ehlcontact.cli.plots.live.bundle import bundle
from ehlcontact.cli.plots.live.scene import scene_of
from ehlcontact.cli.plots.style import embedded, styled
from ehlcontact.files import write_text


def write_page(
    path: Path,
    template: str,
    drawings: Mapping[Any, Callable[[], Figure]],
    scenes: Mapping[str, Callable[[], Any]] | None = None,
    **content: Any,
) -> Path:
    """Draw all figures, which the template finds under ``images``, and write the page.

    With `scenes` the page can be zoomed into: its template finds plotly.js and the scenes of all figures, those
    given or else those of `cli.plots.live`, under ``live``.

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
    images, found = {}, {}
    with styled():
        for name, draw in drawings.items():
            figure = draw()
            images[name] = embedded(figure)
            if scenes is not None:
                found[name] = scenes[name]() if name in scenes else scene_of(figure)
    live = None if scenes is None else bundle(found)
    return write_text(path, environment.get_template(template).render(images=images, live=live, **content), "file")


def cell(value: float | str | None, digits: int = 5) -> str:
    """A table cell in words: nothing for None, counts as they are."""
    if value is None:
        return ""
    return str(value) if isinstance(value, str | int) else numeral(value, digits)
