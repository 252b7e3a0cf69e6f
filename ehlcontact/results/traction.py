"""Traction of one film over the slide-to-roll ratio: shear stress by a traction law, its integral, and power.

`traction_curve`, with a heated film for each ratio, is in `ehlcontact.traction`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, log, pi
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column
from ehlcontact.errors import InputError
from ehlcontact.jit import plain
from ehlcontact.lubricant import TractionLaw, log_viscosity
from ehlcontact.lubricant.traction_laws import LARGEST_SLIDE_ROLL, require_law
from ehlcontact.origin import Origin
from ehlcontact.point import MoesPoint, Scales
from ehlcontact.quantities import NUMBER, Quantity
from ehlcontact.results.contact_map import ContactView
from ehlcontact.results.picture import Map
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.store import stored
from ehlcontact.summary import contact_text, span

if TYPE_CHECKING:
    from ehlcontact.results.steady_result import SteadyResult

Array = NDArray[np.float64]


@stored("traction of a film")
@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Traction(QuantityTable, Origin):
    """Traction of a film over the slide-to-roll ratio, in SI.

    Attributes
    ----------
    slide_roll : ndarray, shape (k,)
        Slide-to-roll ratio: difference over mean of the surface speeds.
    coefficient : ndarray, shape (k,)
        Traction over the load of the contact.
    force : ndarray, shape (k,)
        Traction [N]: integral of the shear stress over the area under pressure.
    mean_stress : ndarray, shape (k,)
        Traction over the Hertz ellipse [Pa].
    power : ndarray, shape (k,)
        Traction times sliding speed [W].
    limit : float
        Largest coefficient that the law allows on this film; infinite where it has no limit.
    x, y : ndarray, shape (nx + 1,), (ny + 1,)
        Places of `stress` [m]; y >= 0.
    stress : ndarray, shape (nx + 1, ny + 1)
        Shear stress at the last ratio [Pa]; 0 where there is no pressure.
    warming : ndarray, shape (k,), or None
        Largest mean temperature over the film above that of the inlet [K]; None of an isothermal film.
    law : TractionLaw
    point, domain, n, seconds, version
        As in every result: `ehlcontact.origin.Origin`.
    """

    slide_roll: Annotated[Array, NUMBER.over("slide_roll")]
    coefficient: Annotated[Array, NUMBER.over("slide_roll")]
    force: Annotated[Array, Quantity("N").over("slide_roll")]
    mean_stress: Annotated[Array, Quantity("Pa").over("slide_roll")]
    power: Annotated[Array, Quantity("W").over("slide_roll")]
    limit: float
    x: Annotated[Array, Quantity("m").over("x", listed=False)]
    y: Annotated[Array, Quantity("m").over("y", listed=False)]
    stress: Annotated[Array, Quantity("Pa").over("x y", listed=False)]
    warming: Annotated[Array | None, Quantity("K").over("slide_roll")] = None
    law: TractionLaw

    DISPLAY = Display(rows="slide_roll", panels=("coefficient", "power"), logs="x")

    def _panels(self) -> Iterator[Any]:
        yield from QuantityTable._panels(self)
        yield self.map()

    def map(self) -> Map:
        """Map of `stress`, for figures."""
        s, stress = self.point.scales, 1e-6 * self.stress
        view = ContactView(self.x, self.y, (s.a, s.b), (self._axis("x"), self._axis("y")))
        return view.map(stress, "shear stress [MPa]", "magma", (0.0, float(stress.max()) or 1.0))

    def _summary_lines(self) -> list[str]:
        most = f"; at most {self.limit:.4g} by its limiting stress" if self.limit < inf else ""
        return [
            contact_text(self.point),
            f"{self.law}, slide-to-roll ratio {span(self.slide_roll)}",
            f"coefficient {span(self.coefficient)}{most}",
            f"traction {span(self.force, 1.0, 'N')}, power {span(self.power, 1.0, 'W')}",
        ]

    def over_sliding(self, name: str) -> bool:
        """Whether a field has one value per ratio."""
        quantity = self._quantities().get(name)
        return quantity is not None and quantity.dims == ("slide_roll",) and getattr(self, name) is not None

    def to_dict(self) -> dict[str, Any]:
        """Numbers without the map, law and origin, ready for JSON; `limit` is None where there is none."""
        said = {"law": self.law.to_dict(), "limit": self.limit if self.limit < inf else None}
        return QuantityTable.to_dict(self) | said | self.origin_dict()


def traction_of(film: SteadyResult, slide_roll: ArrayLike, law: TractionLaw) -> Traction:
    """Traction of a film; arguments as of `SteadyResult.traction`."""
    require_law(law)
    ratios = slide_rolls(slide_roll)
    s = _scales(film)
    if film.temperature is not None and (ratios != abs(film.temperature.inputs.slide_roll)).any():
        its = abs(film.temperature.inputs.slide_roll)
        raise InputError(
            "slide_roll", _shown(ratios), f"{its:g}, as of this heated film; traction_curve solves one for each"
        )
    if film.asperities is not None:
        raise InputError("film", "with asperities", "one of smooth surfaces: friction of asperities is not known")
    if film.sliding is not None and ((ratios != film.sliding.slide_roll).any() or law != film.sliding.law):
        own = f"{film.sliding.slide_roll:g} and {film.sliding.law}, which thin this film"
        raise InputError("slide_roll and law", _shown(ratios), own)
    wet = film.p > 0.0
    p, at_unit, weights = film.p[wet], _log_newton(film, s)[wet], _weights(film)[wet]
    stresses = [law.of(at_unit + (log(ratio) if ratio else -inf), p) for ratio in ratios.tolist()]
    force = np.array([float(weights @ stress) for stress in stresses])
    field = np.zeros(film.p.shape)
    field[wet] = stresses[-1]
    most = law.limit(p)
    return Traction(
        slide_roll=ratios,
        coefficient=force / (film.force),
        force=force,
        mean_stress=force / (pi * s.a * s.b),
        power=force * ratios * (s.a / s.time),
        limit=float(weights @ most) / (film.force),
        x=film.x.copy(),
        y=film.y.copy(),
        stress=field,
        warming=None if film.temperature is None else np.full(ratios.shape, film.temperature.largest),
        law=law,
        **{name: getattr(film, name) for name in ("point", "domain", "n", "seconds", "version")},
    )


def slide_rolls(slide_roll: ArrayLike) -> Array:
    """Slide-to-roll ratios as an array, each from 0 to pure sliding."""
    ratios = as_column("slide_roll", np.atleast_1d(slide_roll) if np.isscalar(slide_roll) else slide_roll)
    outside = (ratios < 0.0) | (ratios > LARGEST_SLIDE_ROLL)
    if outside.any():
        value = float(ratios[int(np.argmax(outside))])
        percent = "; in per cent?" if value > LARGEST_SLIDE_ROLL else "; traction changes its sign with it"
        raise InputError("slide_roll", value, f"between 0 and 2 (one surface stands still){percent}")
    return ratios


def _shown(ratios: Array) -> Any:
    return float(ratios[0]) if ratios.size == 1 else ratios.tolist()


def _scales(film: SteadyResult) -> Scales:
    """Scales of a film that is solved, at an operating point in SI."""
    if not film.status.ok:
        raise InputError("film", str(film.status), "a film that has converged")
    if isinstance(film.point, MoesPoint):
        allowed = "at an OperatingPoint: a traction law has stresses in Pa, and a dimensionless point has no units"
        raise InputError("traction", "asked for", allowed)
    return film.point.scales


def _log_newton(film: SteadyResult, s: Scales) -> Array:
    """Logarithm of eta u_mean/h [Pa], of a slide-to-roll ratio of 1 (eqs. 1, 2); 0 where there is no pressure."""
    moes, wet = film.point.moes, film.p > 0.0
    law = moes.law
    found = np.zeros(film.p.shape)
    viscosity = plain(log_viscosity)
    log_eta = np.array([viscosity(P, law)[0] for P in (film.p[wet] / s.pressure).tolist()])
    if film.temperature is not None:
        numbers = film.temperature.inputs.numbers(moes, s)
        log_eta += numbers.heating(film.temperature.mean[wet]) * (log_eta + law.q)
    found[wet] = log_eta + log(moes.eta0 * s.surface_speed) - np.log(film.h[wet])
    return found


def _weights(film: SteadyResult) -> Array:
    """Area [m2] of each node, with that of its image in y < 0; the pressure is 0 on the border."""
    cell = (film.x[1] - film.x[0]) * (film.y[1] - film.y[0])
    weights = np.full(film.p.shape, 2.0 * cell)
    weights[:, 0] = cell
    return weights
