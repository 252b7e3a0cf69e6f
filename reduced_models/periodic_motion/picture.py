"""Pictures of periodic answers: sizes over a parameter, multipliers in the plane, Poincare sections."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ehlcontact.results.picture import (
    BLUE,
    COLOURS,
    GREY,
    INK,
    ORANGE,
    RED,
    AnyPanel,
    Label,
    Line,
    Panel,
    Picture,
)

# Units of what a branch follows, as of its parameter
LABELS: dict[str, Label] = {
    "speed": ("speed", "rev/min"),
    "amplitude": "factor of the excitation",
    "clearance": ("clearance", "m"),
    "preload": ("preload", "m"),
    "frequency": ("frequency", "Hz"),
}
MOST_SHOWN = 4  # of the freedoms of a rotor without nodes
MARKS = {"fold": "o ", "branch point": "D ", "period doubling": "s ", "Neimark-Sacker": "^ "}
STATES = (True, "", "-"), (False, ", unstable", "--"), (None, "", ":")  # of the stability that is not known too


def freedoms(named: dict[str, dict[str, int]], size: int) -> list[tuple[str, int]]:
    """Names and places of what pictures show: x and y of all nodes, or the first freedoms."""
    found = [(f"{node} {axis}", at[axis]) for node, at in named.items() for axis in "xy" if axis in at]
    return found or [(f"q{k}", k) for k in range(min(size, MOST_SHOWN))]


def branch_picture(branch: Any) -> Picture:
    """Peak to peak over the parameter of a branch: stable answers solid, unstable ones dashed."""
    answers, over = branch.answers, LABELS[branch.over]
    value, sizes = branch.value, branch.peak_to_peak
    shown = freedoms(answers[0].run.nodes, sizes.shape[1])
    lines: list[Line] = []
    for k, (name, place) in enumerate(shown):
        for stable, word, dash in STATES:
            for part in _stretches([answer.stable is stable for answer in answers]):
                colour = COLOURS[k % len(COLOURS)]
                lines.append(Line(value[part], sizes[part, place], f"{name}{word}", colour, dash))
    known = [answer for answer in answers if answer.multipliers is not None]
    for one in branch.bifurcations() if known else ():
        at = [sizes[one.after : one.after + 2, place].mean() for _, place in shown]
        lines.append(Line(np.full(len(at), one.value), at, one.kind, INK, "", MARKS[one.kind]))
    panels: list[AnyPanel] = [Panel(lines, over, ("peak to peak", "m"), bottom=0.0)]
    if known:
        largest = [np.nan if a.multipliers is None else np.abs(a.multipliers).max(initial=0.0) for a in answers]
        ends = [float(value.min()), float(value.max())]
        circle = Line(ends, [1.0, 1.0], "", GREY, "--", width=1.0)
        panels.append(Panel([Line(value, largest, "", BLUE), circle], over, "largest multiplier"))
    return Picture(panels, f"periodic answers over {branch.over}", columns=1, heights=(330.0, 180.0), shared=True)


def _stretches(wanted: Sequence[bool]) -> Iterator[slice]:
    """Stretches of a branch whose answers are wanted, each with the answer before it, so that no gap is left."""
    first = None
    for k, one in enumerate([*wanted, False]):
        if one and first is None:
            first = max(k - 1, 0)
        if not one and first is not None:
            yield slice(first, k)
            first = None


def multipliers_picture(answer: Any) -> Picture:
    """Floquet multipliers of an answer in the complex plane, with the unit circle."""
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    found = answer.multipliers
    outside = np.abs(found) >= 1.0
    lines = [Line(np.cos(turn), np.sin(turn), "", GREY, "--", width=1.0)]
    for name, colour, here in (("within", BLUE, ~outside), ("outside", RED, outside)):
        if here.any():
            lines.append(Line(found.real[here], found.imag[here], name, colour, "", "o"))
    panel = Panel(lines, "real part", "imaginary part", title="Floquet multipliers", equal=True)
    return Picture([panel], "", columns=1, heights=(330.0,))


def diagram_picture(diagram: Any) -> Picture:
    """Samples at the starts of periods over the parameter, and the sizes of the motions."""
    kept = diagram.samples.shape[1]
    over, value = LABELS[diagram.over], np.repeat(diagram.value, kept)
    shown = freedoms(diagram.nodes, diagram.samples.shape[2])
    panels: list[AnyPanel] = []
    for k, (name, place) in enumerate(shown):
        points = Line(
            value, diagram.samples[:, :, place].ravel(), "", COLOURS[k % len(COLOURS)], "", "o", width=0.4
        )
        panels.append(Panel([points], over, (name, "m")))
    sizes = [Line(diagram.value, diagram.peak_to_peak[:, place], name) for name, place in shown]
    panels.append(Panel(sizes, over, ("peak to peak", "m"), bottom=0.0))
    return Picture(panels, "bifurcation diagram", columns=2)


def section_picture(section: Any) -> Picture:
    """Velocities over displacements of all nodes, at equal distances in time."""
    panels: list[AnyPanel] = []
    for name, place in freedoms(section.nodes, section.displacement.shape[1]):
        points = Line(section.displacement[:, place], section.velocity[:, place], "", ORANGE, "", "o")
        panels.append(Panel([points], (name, "m"), ("velocity", "m/s"), title=name))
    return Picture(panels, "Poincare section")
