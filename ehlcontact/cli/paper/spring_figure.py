"""Figure 16: the stiffness polynomials inside and outside the interval they were fitted on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from ehlcontact.cli.paper.data import paper_fits
from ehlcontact.cli.paper.fits import Fits
from ehlcontact.cli.plots.style import BLUE, GREEN, GREY, ORANGE, new_figure

FARTHEST = 3.0  # approach up to which the polynomials are drawn


def polynomials(fits: Fits, cases: Sequence[str]) -> Figure:
    """Polynomials of Table 5, the paper's and ours, the extension of our elements, and the dry contact."""
    figure = new_figure(4.4)
    u = np.linspace(0.0, FARTHEST, 400)
    left, right = figure.subplots(1, 2, sharey=True)
    for case, colour in zip(cases, (BLUE, ORANGE, GREEN), strict=True):
        paper = paper_fits()[5, case]
        assert paper.K2 is not None and paper.K3 is not None
        left.plot(u, u * (paper.K1 + u * (paper.K2 + u * paper.K3)), color=colour, label=f"case {case}")
        found = fits.fit(case)
        if found is None:
            continue
        p = found.parameters
        right.plot(u, u * (p["K1"] + u * (p["K2"] + u * p["K3"])), color=colour, label=f"case {case}, polynomial")
        right.plot(u, np.asarray(found.element.spring(u)), "--", color=colour, label=f"case {case}, element")
        right.axvspan(found.valid["low"], found.valid["high"], color="#eaf3fa", zorder=0)
    for axes, title in ((left, "paper"), (right, "ours; shaded: fitted")):
        axes.plot(u, u**1.5, ":", color=GREY, label="dry Hertz")
        axes.set(title=title, xlabel="approach", ylabel="spring force", ylim=(-0.5, 6.0), xlim=(0.0, FARTHEST))
        axes.legend(loc="upper left")
    return figure


def spring_table(
    fits: Fits, cases: Sequence[str], approaches: Sequence[float] = (0.5, 1.5, 2.5)
) -> dict[str, float]:
    """Spring forces outside the fitted interval: polynomial and element."""
    values: dict[str, float] = {}
    for case in cases:
        found = fits.fit(case)
        if found is None:
            continue
        p = found.parameters
        for u in approaches:
            values[f"case {case}: polynomial at {u:g}"] = u * (p["K1"] + u * (p["K2"] + u * p["K3"]))
            values[f"case {case}: element at {u:g}"] = float(found.element.spring(u))
    return values
