"""``ehlcontact explore``: a page that answers for ball bearings in any browser, without library or network."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ehlcontact.cli.output import check_new, say, write_to
from ehlcontact.files import require_writable


def explore(
    output: Annotated[Path, typer.Option("--output", "-o", metavar="PAGE.html", help="Page to write.")],
    force: Annotated[bool, typer.Option("--force", help="Replace the page if there is one.")] = False,
) -> None:
    """Write a page to explore ball bearings in: films, load zone, friction, stiffness and damping at any load.

    One file of 1.6 MB that needs no network: atlas and C core stand in it, and the browser computes what Python
    does, axial load and preload included.
    """
    require_writable("--output", output, (".html", ".htm"))
    check_new("--output", output, force)
    from ehlcontact.cli.explorer import write_explorer

    write_to("--output", output, write_explorer)
    say(f"{output}: open it in a browser")
