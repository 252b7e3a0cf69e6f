"""HTML pages that need no other file: a template, numbers and pictures."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from html import escape
from pathlib import Path
from textwrap import shorten
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from ehlcontact.cli.numerals import numeral, percent
from ehlcontact.errors import warn_user
from ehlcontact.files import write_text
from ehlcontact.results.picture import Panel, Picture, Slides

# A number with its sign and its unit
UNITS = "%", "N/\u00b5m", "N s/m", "N m", "N", "W", "GPa", "Hz", "\u00b5m", "rev/min", "h"
MEASURE = re.compile(rf"(?:\u00b1 )?\d[\d.e+-]*(?: (?:{'|'.join(UNITS)})(?![\w/]))?")


def write_page(
    path: Path, template: str, drawings: Mapping[str, Callable[[], Picture | Slides]], **content: Any
) -> Path:
    """Draw all figures with plotly and write the page.

    The template finds the height of each figure [px] by its name in ``heights``, and plotly.js and the figures in
    ``bundle``, None where there are none.

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
    environment.filters |= {"sig": numeral, "percent": percent, "cell": cell, "together": together}
    heights, packed = {}, None
    if drawings:
        from ehlcontact.cli.plots.bundle import bundle
        from ehlcontact.cli.plots.finish import finished

        found = {name: finished(_drawn(name, draw)) for name, draw in drawings.items()}
        heights = {name: one["layout"]["height"] for name, one in found.items()}
        packed = bundle(found)
    page = environment.get_template(template).render(heights=heights, bundle=packed, **content)
    return write_text(path, page, "file")


def _drawn(name: str, describe: Callable[[], Picture | Slides]) -> Any:
    """The figure; where it fails one that says why, for the rest of the page is worth having."""
    from ehlcontact.cli.plots.render import figure_of

    try:
        return figure_of(describe())
    except Exception as error:
        reason = f"the figure {name!r} could not be drawn: {type(error).__name__}: {error}"
        warn_user(reason)
        return figure_of(Picture([Panel([], "", "", title=escape(shorten(reason, 100)))]))


def together(text: str) -> str:
    """A text whose numbers stay on a line with their signs and units."""
    return MEASURE.sub(lambda found: found[0].replace(" ", "\u00a0"), text)


def cell(value: float | str | None) -> str:
    """A table cell in words: nothing for None, counts as they are."""
    if value is None:
        return ""
    return str(value) if isinstance(value, str | int) else numeral(value, 5)
