"""Picture of a contact: maps of pressure and film around the Hertz ellipse, and both along its mid-planes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ehlcontact.point import MoesPoint, Point
from ehlcontact.quantities import ACROSS, ALONG, LENGTH, PRESSURE, words
from ehlcontact.results.picture import BLUE, GREY, ORANGE, RED, Array, Label, Line, Map, Panel, Picture

VIEW = (-1.8, 1.5, 1.5)  # along rolling from, to; across to: in semi-axes
MIDPLANE = 1.6  # semi-axes across, along which the film of one half is drawn
LEVELS = (0.92, 1.08, 1.3, 1.8)  # of the central film, where lines are drawn; the last ends the colours
DEEPEST = 5.0  # central films up to which a mid-plane shows the film
FLATTEST = 0.55  # height over width of a map: a flatter one is stretched
TALL = 420.0  # px of a page that a map may be high
MOVES = ("the surfaces move to the right", "the surfaces move upwards")


@dataclass(frozen=True)
class ContactView:
    """Places and fields of a contact in the units of its labels.

    Parameters
    ----------
    x, y : ndarray, shape (nx,), (ny,)
        Places along rolling and across; only y >= 0 of an even field, which is mirrored.
    axes : (float, float)
        Semi-axes of the Hertz ellipse, in the units of x and y.
    labels : (label, label)
        Of x and y.
    true : float
        True length of a unit of y over that of x.
    """

    x: Array
    y: Array
    axes: tuple[float, float]
    labels: tuple[Label, Label]
    true: float = 1.0

    @classmethod
    def of(cls, point: Point, x: Array, y: Array) -> ContactView:
        """From places of a result at a point."""
        s, moes = point.scales, isinstance(point, MoesPoint)
        labels = (words("x"), ALONG.unit_at(point)), (words("y"), ACROSS.unit_at(point))
        return cls(x, y, (s.a, s.b), labels, 1.0 / point.moes.kappa if moes else 1.0)

    @property
    def upwards(self) -> bool:
        """Whether the surfaces move upwards in maps: an ellipse that is wide across lies flat."""
        return self.true * self.axes[1] > 1.001 * self.axes[0]

    @property
    def view(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Ends along rolling and across of what maps show."""
        (a, b), (first, last, across) = self.axes, VIEW
        across = min(across * b, float(np.abs(self.y).max()))
        return (max(first * a, float(self.x[0])), min(last * a, float(self.x[-1]))), (-across, across)

    @property
    def stretch(self) -> float:
        """Of the shorter side of a map that would be too flat."""
        long, across = (float(np.ptp(ends)) for ends in self.view)
        across *= self.true
        return max(1.0, FLATTEST * max(long, across) / min(long, across))

    @property
    def note(self) -> str:
        """How far maps are from true proportions, in words; empty where they are to scale."""
        if self.stretch < 1.01:
            return ""
        long, across = (float(np.ptp(ends)) for ends in self.view)
        longer, shorter = ("x", "y") if long < self.true * across else ("y", "x")
        return f"Not to scale: {longer} stretched {self.stretch:.2g} times against {shorter}."

    def map(
        self, field: Array, label: Label, colours: str, limits: tuple[float, float] | None, **options: Any
    ) -> Map:
        """Map of a field of shape (nx, ny), or an image of shape (nx, ny, 3)."""
        y = self.y
        if y[0] == 0.0:
            y, field = np.concatenate([-y[:0:-1], y]), np.concatenate([field[:, :0:-1], field], axis=1)
        along, across = (self.x, self.labels[0]), (y, self.labels[1])
        lengthened = self.stretch if "x stretched" in self.note else 1.0 / self.stretch
        aspect = self.true / lengthened
        if self.upwards:
            turned = field.swapaxes(0, 1)
            places: Any = {"x": across, "y": along, "view": self.view[::-1], "axes": self.axes[::-1]}
            return Map(
                values=(turned, label), colours=colours, limits=limits, aspect=1.0 / aspect, **places, **options
            )
        places = {"x": along, "y": across, "view": self.view, "axes": self.axes}
        return Map(values=(field, label), colours=colours, limits=limits, aspect=aspect, **places, **options)

    def pressure(self, p: Array, label: Label, most: float | None = None) -> Map:
        """Map of the pressure, whose colours end at `most`."""
        limits, title = (0.0, float(p.max()) if most is None else most), f"pressure; {MOVES[self.upwards]}"
        return self.map(p, label, "inferno", limits, title=title)

    def film(self, h: Array, label: Label, central: float, ends: tuple[float, float] | None = None) -> Map:
        """Map of the film with lines at `LEVELS` of the central one, or with the ends of its colours given."""
        if ends is not None:
            return self.map(h, label, "viridis", ends, title="film")
        levels = [level * central for level in LEVELS]
        limits = float(h.min()), max(levels[-1], float(h.min()))
        return self.map(h, label, "viridis", limits, levels=levels, title="film")


def contact_panels(
    view: ContactView,
    p: tuple[Array, Label],
    h: tuple[Array, Label],
    central: float,
    hertz: float,
    content: Array | None = None,
) -> list[Map | Panel]:
    """Maps of pressure, film and content, and the first two along rolling and across.

    Parameters
    ----------
    view : ContactView
    p, h : (ndarray, label)
        Pressure and film, shape (nx, ny).
    central : float
        Film in the centre.
    hertz : float
        Largest pressure of the dry contact.
    content : ndarray, optional
        Part of the gap that oil fills, shape (nx, ny).
    """
    maps = [view.pressure(*p), view.film(*h, central)]
    if content is not None:
        maps.append(view.map(content, "share", "cividis", (0.0, 1.0), title="share of the gap filled with oil"))
    i, j = (int(np.argmin(np.abs(place))) for place in (view.x, view.y))
    along = midplane(view, (p[0][:, j], p[1]), (h[0][:, j], h[1]), central, hertz)
    across = midplane(view, (p[0][i], p[1]), (h[0][i], h[1]), central, hertz, across=True)
    return [*maps, along, across]


def midplane(
    view: ContactView,
    p: tuple[Array, Label],
    h: tuple[Array, Label],
    central: float,
    hertz: float,
    *,
    across: bool = False,
) -> Panel:
    """Pressure with that of the dry contact, and film, along a mid-plane; across over one half."""
    place, semi_axis = (view.y, view.axes[1]) if across else (view.x, view.axes[0])
    ends = (0.0, MIDPLANE * semi_axis) if across else (VIEW[0] * semi_axis, VIEW[1] * semi_axis)
    dry = np.linspace(-1.0, 1.0, 201)
    lines = [
        Line(semi_axis * dry, hertz * np.sqrt(1.0 - dry**2), "dry Hertz", GREY, "--"),
        Line(place, p[0], "pressure", RED),
        Line(place, h[0], "film", BLUE, second=True),
    ]
    highest = 1.05 * max(float(p[0].max()), hertz)
    label = view.labels[across]
    assert not isinstance(label, str)
    return Panel(
        lines,
        (f"{label[0]}, {'x' if across else 'y'} = 0", label[1]),
        p[1],
        x_ends=ends,
        y_ends=(0.0, highest),
        second=h[1],
        second_ends=(0.0, DEEPEST * central),
    )


def film_picture(result: Any) -> tuple[Picture, Picture]:
    """Maps of a `SteadyResult` one below another, and its mid-planes: two pictures of a page."""
    panels = result.panels()
    maps = [panel for panel in panels if isinstance(panel, Map)]
    view = ContactView.of(result.point, result.x, result.y)
    return (
        Picture(maps, columns=1, heights=(TALL,), note=maps_note(view)),
        Picture([panel for panel in panels if isinstance(panel, Panel)]),
    )


def convergence(result: Any) -> Picture:
    """Changes of the pressure, and residuals, of the multigrid cycles of a `SteadyResult`."""
    floor, cycles, result = 1e-17, np.arange(len(result.residuals)), result.dimensionless
    series: Sequence[tuple[str, str, str, Array]] = [
        ("residual of Reynolds, over the dry start's", "o", BLUE, result.residuals / result.dry_residual),
        ("residual of the load balance, over the load", "s", ORANGE, np.abs(result.load_residuals) + floor),
        ("change of approach, over the dry one", "^", GREY, result.approach_changes + floor),
        ("largest change of pressure, over Hertz's", "D", RED, result.pressure_changes + floor),
    ]
    lines = [
        Line(cycles[cycles.size - values.size :], values, name, colour, mark=mark)
        for name, mark, colour, values in series
    ]
    return Picture([Panel(lines, "cycle on the finest grid", "change or residual", logs="Y")], "convergence")


def fields(point: Point, p: Array, h: Array) -> tuple[tuple[Array, Label], tuple[Array, Label]]:
    """Pressure and film of a result at a point, with their labels."""
    return (p, (words("p"), PRESSURE.unit_at(point))), (h, (words("h"), LENGTH.unit_at(point)))


def maps_note(view: ContactView) -> str:
    """What maps of a contact have to say: how far they are from scale, and what their lines are."""
    levels = ", ".join(f"{level:g}" for level in LEVELS)
    return f"{view.note} White lines: {levels} of the central film.".lstrip()
