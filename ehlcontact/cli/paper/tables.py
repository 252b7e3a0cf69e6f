"""Tables 1 to 6, the paper's numbers beside ours."""

from __future__ import annotations

from ehlcontact.cli.paper.cubic import cubic_table
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.paper.linear import linear_table
from ehlcontact.cli.paper.removal import sensitivity_table
from ehlcontact.cli.paper.table import Table


def make_table(number: int, fits: Fits) -> Table:
    """The table with this number."""
    if number == 2:
        return sensitivity_table(fits)
    return linear_table(number, fits) if number in (1, 4) else cubic_table(number, fits)
