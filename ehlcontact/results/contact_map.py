"""Figure of a contact: pressure and film around the Hertz ellipse, and along its middle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ehlcontact.point import Scales
from ehlcontact.results.picture import Array, Panel, smooth

REACH = 1.5  # semi-axes on either side of the centre that are shown
DEEPEST = 2.5  # central films up to which the colours of a film go: beyond, the inlet would take all of them
FLATTEST = 4.0  # sides of a contact over each other up to which maps are to scale


@dataclass(frozen=True)
class ContactMap:
    """A field around the Hertz ellipse.

    Parameters
    ----------
    x, y : ndarray, shape (nx + 1,), (ny + 1,)
        Places along rolling and across; only y >= 0 of an even field, which is mirrored.
    field : ndarray, shape (nx + 1, ny + 1)
    labels : (str, str, str)
        Of x, y and the field.
    axes : (float, float)
        Semi-axes of the ellipse, in the units of x and y.
    colours : str
        Of matplotlib.
    limits : (float, float)
        Of the colours.
    """

    x: Array
    y: Array
    field: Array
    labels: tuple[str, str, str]
    axes: tuple[float, float]
    colours: str
    limits: tuple[float, float]

    def draw(self, axes: Any) -> None:
        """Into matplotlib axes."""
        y, field = self.y, self.field
        if y[0] == 0.0:
            y, field = np.concatenate([-y[:0:-1], y]), np.concatenate([field[:, :0:-1], field], axis=1)
        a, b = self.axes
        low, high = self.limits
        mesh = axes.pcolormesh(
            self.x, y, field.T, cmap=self.colours, vmin=low, vmax=high, shading=smooth(field), rasterized=True
        )
        beyond = "max" if field.max() > high else "neither"
        axes.figure.colorbar(mesh, ax=axes, label=self.labels[2], extend=beyond)
        turn = np.linspace(0.0, 2.0 * np.pi, 181)
        axes.plot(a * np.cos(turn), b * np.sin(turn), "--", color="white", linewidth=0.8)
        axes.set(xlabel=self.labels[0], ylabel=self.labels[1])
        axes.set_xlim(max(self.x[0], -REACH * a), min(self.x[-1], REACH * a))
        axes.set_ylim(max(y[0], -REACH * b), min(y[-1], REACH * b))
        if max(a, b) <= FLATTEST * min(a, b):
            axes.set_aspect("equal")


def contact_panels(
    places: tuple[Array, Array],
    fields: tuple[Array, Array],
    h_central: float,
    kappa: float | None,
    scales: Scales | None,
    content: Array | None = None,
) -> list[ContactMap | Panel]:
    """Maps of pressure, film and content, and the former along rolling and across; in SI where there are scales.

    Parameters
    ----------
    places : (ndarray, ndarray)
        X in semi-axes a, Y in b.
    fields : (ndarray, ndarray)
        P over the Hertz pressure and H over the dry approach, shape (nx + 1, ny + 1).
    h_central : float
        Film in the centre, as H.
    kappa : float or None
        a/b: with no scales both axes are in a, and where it is not known each in its own semi-axis.
    scales : Scales or None
    content : ndarray, optional
        Part of the gap that oil fills, shape (nx + 1, ny + 1).
    """
    (X, Y), (P, H) = places, fields
    if scales is None:
        a, b, pressure, film = 1.0, 1.0 if kappa is None else 1.0 / kappa, 1.0, 1.0
        labels = "x/a", "y/b" if kappa is None else "y/a", "pressure over Hertz's", "film over the dry approach"
    else:
        a, b, pressure, film = 1e6 * scales.a, 1e6 * scales.b, 1e-9 * scales.pressure, 1e6 * scales.length
        labels = "x along rolling [µm]", "y across [µm]", "pressure [GPa]", "film [µm]"
    p, h = pressure * P, film * H
    highest = DEEPEST * film * h_central
    maps = [
        ContactMap(a * X, b * Y, p, (*labels[:2], labels[2]), (a, b), "inferno", (0.0, float(p.max()))),
        ContactMap(a * X, b * Y, h, (*labels[:2], labels[3]), (a, b), "viridis", (float(h.min()), highest)),
    ]
    if content is not None:
        words = "part of the gap filled with oil"
        maps.append(ContactMap(a * X, b * Y, content, (*labels[:2], words), (a, b), "cividis", (0.0, 1.0)))
    i, j = (int(np.argmin(np.abs(place))) for place in (X, Y))
    along = _profiles(a, X, (p[:, j], h[:, j]), (labels[0], *labels[2:]), (pressure, highest))
    return [*maps, *along, *_profiles(b, Y, (p[i], h[i]), (labels[1], *labels[2:]), (pressure, highest))]


def _profiles(
    semi_axis: float,
    place: Array,
    lines: tuple[Array, Array],
    labels: tuple[str, str, str],
    most: tuple[float, float],
) -> list[Panel]:
    """Pressure with that of the dry contact, and film, over a place in semi-axes.

    `labels` are of place, pressure and film, `most` is the Hertz pressure and the thickest film that is shown.
    """
    near = np.abs(place) <= REACH
    p, h = (line[near] for line in lines)
    x = semi_axis * place[near], labels[0]
    dry = most[0] * np.sqrt(np.maximum(0.0, 1.0 - place[near] ** 2))
    film = np.where(h <= most[1], h, np.nan)
    return [
        Panel(x, [("film", p, None), ("dry", dry, None)], labels[1]),
        Panel(x, [("", film, None)], labels[2]),
    ]
