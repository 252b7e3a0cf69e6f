"""`FilmCapacitance`: capacitance and field strength of a solved film."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import pi
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from ehlcontact.capacitance import EPS0, OIL, require_permittivity
from ehlcontact.checks import require_positive
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint
from ehlcontact.quantities import LENGTH, NUMBER, Quantity
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.summary import contact_text

if TYPE_CHECKING:
    from ehlcontact.results.steady_result import SteadyResult

Array = NDArray[np.float64]

FARAD = Quantity("F")
VOLTS_PER_METRE = 1e-6  # V/m in V/um
RAYS, PLACES = 24, 24  # of a sector of the surroundings; along each of them


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmCapacitance(QuantityTable):
    """Capacitance of a film, by its parts; SI.

    Attributes
    ----------
    point : OperatingPoint
    hertz_zone : float
        Under the contact ellipse [F].
    outlet : float
        Behind the contact, where the film has ruptured and oil fills a part of the gap [F].
    inlet : float
        Elsewhere in the region that was solved [F].
    surroundings : float
        Beyond that region, up to `reach` [F].
    least, largest : float
        With air wherever oil is not held by the film: in the surroundings and, in layers on both surfaces, behind
        the contact; and with oil in all gaps [F].
    plate : float
        Of a parallel plate with the area of the ellipse at the central film [F].
    permittivity, surroundings_permittivity : float
    reach : float
        Radius from the middle up to which the bodies face each other [m].
    h_min : float
        Smallest film [m].
    """

    point: OperatingPoint
    hertz_zone: Annotated[float, FARAD]
    outlet: Annotated[float, FARAD]
    inlet: Annotated[float, FARAD]
    surroundings: Annotated[float, FARAD]
    least: Annotated[float, FARAD]
    largest: Annotated[float, FARAD]
    plate: Annotated[float, FARAD]
    permittivity: Annotated[float, NUMBER]
    surroundings_permittivity: Annotated[float, NUMBER]
    reach: Annotated[float, LENGTH]
    h_min: Annotated[float, LENGTH]

    DISPLAY: ClassVar[Display] = Display(rows="")

    @property
    def total(self) -> Annotated[float, FARAD]:
        """All parts together [F]."""
        return self.hertz_zone + self.outlet + self.inlet + self.surroundings

    def field_strength(self, voltage: float) -> float:
        """Field [V/um] at the smallest film under a voltage [V] across it.

        Films are said to break down from some 15 to 60 V/um on; no data here support a limit.

        Raises
        ------
        InputError
        """
        return require_positive("voltage", voltage) / self.h_min * VOLTS_PER_METRE

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        return super().to_dict() | {"total": self.total}

    def _summary_lines(self) -> list[str]:
        hertz, outlet, inlet, around = (
            f"{1e12 * part:.4g}" for part in (self.hertz_zone, self.outlet, self.inlet, self.surroundings)
        )
        return [
            contact_text(self.point),
            f"{1e12 * self.total:.4g} pF, between {1e12 * self.least:.4g} and {1e12 * self.largest:.4g} pF by"
            " where oil stands",
            f"Hertz zone {hertz} pF, outlet {outlet} pF, inlet and sides {inlet} pF, surroundings {around} pF",
            f"a parallel plate has {1e12 * self.plate:.4g} pF; permittivity {self.permittivity:g}",
        ]


def capacitance_of(
    film: SteadyResult, permittivity: float = OIL, surroundings: float | None = None, reach: float | None = None
) -> FilmCapacitance:
    """See `SteadyResult.capacitance`."""
    point = film.point
    if not isinstance(point, OperatingPoint):
        raise InputError("film", "at a MoesPoint", "one at an OperatingPoint: capacitance needs lengths in metres")
    if not film.status.ok:
        raise InputError("film", str(film.status), "one that has converged")
    e = require_permittivity("permittivity", permittivity)
    beyond = e if surroundings is None else require_permittivity("surroundings", surroundings)
    body = point.geometry
    edge = min(body.radius_x, body.radius_y) if reach is None else require_positive("reach", reach)
    corner = float(np.hypot(np.abs(film.x).max(), film.y[-1]))
    if edge < corner:
        raise InputError("reach", edge, f"at least {corner:.4g} m, the corner of the region that was solved")
    content = _content(film)
    oil = content * film.h
    inside = (film.x[:, None] / point.scales.a) ** 2 + (film.y / point.scales.b) ** 2 <= 1.0
    area = _areas(film)
    layers = EPS0 * area / (oil / e + (film.h - oil))
    ruptured = (content < 1.0) & ~inside
    hertz, outlet = float(layers[inside].sum()), float(layers[ruptured].sum())
    inlet = float(layers[~inside & ~ruptured].sum())
    full = float((EPS0 * e * area / film.h).sum())
    around, wet, dry = _surroundings(film, oil, edge, e, beyond)
    return FilmCapacitance(
        point=point,
        hertz_zone=hertz,
        outlet=outlet,
        inlet=inlet,
        surroundings=around,
        least=hertz + outlet + inlet + dry,
        largest=full + wet,
        plate=EPS0 * e * pi * point.scales.a * point.scales.b / film.h_central,
        permittivity=e,
        surroundings_permittivity=beyond,
        reach=edge,
        h_min=film.h_min,
    )


def _content(film: SteadyResult) -> Array:
    """Part of the gap that oil fills: as solved, or behind a rupture what passed it."""
    if film.content is not None:
        return film.content
    content = np.ones_like(film.h)
    for j in range(film.y.size):
        pressed = np.flatnonzero(film.p[:, j] > 0.0)
        if pressed.size > 1:
            last = pressed[-1]
            passed = _at_rupture(film.p[:, j], film.h[:, j], last)
            content[last + 1 :, j] = np.minimum(passed / film.h[last + 1 :, j], 1.0)
    return content


def _at_rupture(p: Array, h: Array, last: int) -> float:
    """Film where the pressure ends, between the last node under pressure and the next: it ends like a square."""
    here, before = np.sqrt(p[last]), np.sqrt(p[last - 1])
    share = min(here / (before - here), 1.0) if before > here else 1.0
    return float((1.0 - share) * h[last] + share * h[min(last + 1, h.size - 1)])


def _areas(film: SteadyResult) -> Array:
    """Area of every node [m2], by trapezoids, of both halves: y >= 0 stands for y < 0 too."""
    across, along = (np.full(line.size, line[1] - line[0]) for line in (film.y, film.x))
    along[[0, -1]] *= 0.5
    across[-1] *= 0.5
    across *= 2.0
    across[0] *= 0.5
    return along[:, None] * across


def _surroundings(
    film: SteadyResult, oil: Array, edge: float, e: float, beyond: float
) -> tuple[float, float, float]:
    """Capacitance beyond the region that was solved [F]: as asked for, full of oil, and of air.

    Along a ray the gap is that of the undeformed bodies with the deflection at the rim, which falls like 1/r.
    Behind the region the oil that leaves it stands on the surfaces.
    """
    body = film.point.geometry  # type: ignore[union-attr]
    front, back, side = -film.x[0], film.x[-1], film.y[-1]
    corners = [0.0, np.arctan2(side, back), np.pi - np.arctan2(side, front), np.pi]
    nodes, weights = leggauss(RAYS)
    places, parts = leggauss(PLACES)
    sums = np.zeros(3)
    for low, high in pairwise(corners):
        phi = 0.5 * (high - low) * nodes + 0.5 * (high + low)
        cosine, sine = np.cos(phi), np.sin(phi)
        rim = np.minimum(np.where(cosine > 0.0, back, front) / np.abs(cosine), side / sine)
        x, y = np.clip(rim * cosine, film.x[0], film.x[-1]), np.minimum(rim * sine, side)
        h_rim = _at(film, film.h, x, y)
        curve = 0.5 * (cosine**2 / body.radius_x + sine**2 / body.radius_y)
        bent = h_rim - (curve * rim**2 - film.approach)
        s = 0.5 * (places + 1.0)
        ratio = (edge / rim)[:, None]
        r = rim[:, None] * ratio**s  # even in the logarithm
        measure = (high - low) * weights[:, None] * 0.5 * parts * np.log(ratio) * r * r  # twice the half plane
        gap = curve[:, None] * r * r - film.approach + (bent * rim)[:, None] / r
        across = r * sine[:, None]
        on_track = (r * cosine[:, None] > 0.0) & (across < side)
        layer = np.minimum(np.interp(across, film.y, oil[-1]), gap)
        layers, filled = measure / (layer / e + (gap - layer)), measure / gap
        sums += EPS0 * np.array(
            [
                np.where(on_track, layers, beyond * filled).sum(),
                e * filled.sum(),
                np.where(on_track, layers, filled).sum(),
            ]
        )
    return float(sums[0]), float(sums[1]), float(sums[2])


def _at(film: SteadyResult, values: Array, x: Array, y: Array) -> Array:
    """Values of nodes between them, linear."""
    i = np.clip(((x - film.x[0]) / (film.x[1] - film.x[0])).astype(int), 0, film.x.size - 2)
    j = np.clip((y / (film.y[1] - film.y[0])).astype(int), 0, film.y.size - 2)
    u = (x - film.x[i]) / (film.x[1] - film.x[0])
    v = (y - film.y[j]) / (film.y[1] - film.y[0])
    low = (1.0 - u) * values[i, j] + u * values[i + 1, j]
    high = (1.0 - u) * values[i, j + 1] + u * values[i + 1, j + 1]
    return np.asarray((1.0 - v) * low + v * high)
