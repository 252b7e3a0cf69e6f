"""Result of a steady solve."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import nan, pi
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.assumptions.judge import judged
from ehlcontact.capacitance import OIL
from ehlcontact.conditions import Conditions
from ehlcontact.errors import InputError
from ehlcontact.origin import Origin
from ehlcontact.quantities import ACROSS, ALONG, FORCE, LENGTH, MOMENT, NUMBER, PRESSURE
from ehlcontact.results.asperity_contact import AsperityContact
from ehlcontact.results.capacitance import FilmCapacitance, capacitance_of
from ehlcontact.results.contact_map import ContactView, contact_panels, fields, maps_note
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.results.picture import Picture
from ehlcontact.results.table import Display, PointTable, QuantityTable
from ehlcontact.results.traction import Traction, traction_of
from ehlcontact.shear_thinning import ShearThinning
from ehlcontact.solver.error_estimate import ALL, ErrorEstimate
from ehlcontact.status import Status
from ehlcontact.store import stored
from ehlcontact.summary import contact_text, film_unit, note_line
from ehlcontact.supply import OilLayer, layer_on

if TYPE_CHECKING:
    from ehlcontact.lubricant.traction_laws import TractionLaw

Array = NDArray[np.float64]

DOUBTFUL = 0.1  # estimated error of a film, over it, from which a converged result says so in words


def grid_doubt(error: ErrorEstimate | None, when: str = "") -> str:
    """Say in words where a mesh does not show its film, `when` as in "at the start"; else empty."""
    if error is None:
        return ""
    films = {"central": error.h_central_relative, "smallest": error.h_min_relative}
    off = [
        f"the {name} film may be off by {'anything' if bar >= ALL else f'{100.0 * bar:.0f} %'}"
        for name, bar in films.items()
        if bar > DOUBTFUL
    ]
    return f"the grid is too coarse: {when and f'{when} '}{', '.join(off)}" if off else ""


def film_bars(error: ErrorEstimate) -> tuple[str, str]:
    """Errors of the central and the smallest film in words."""
    central, least = (
        f"± {float(f'{100.0 * e:.2g}'):g} %" for e in (error.h_central_relative, error.h_min_relative)
    )
    return central, least


@stored("result of solve_steady", 2)
@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SteadyResult(PointTable, Origin):
    """Steady film of a contact under constant load, or at a prescribed approach, in the units of its point.

    Units are those at an `OperatingPoint` and, after the semicolon, at a `MoesPoint`.

    Attributes
    ----------
    x, y : ndarray, shape (nx + 1,), (ny + 1,)
        Places along rolling and across [m; semi-axes a, b], y >= 0; fields are even in y.
    p, h : ndarray, shape (nx + 1, ny + 1)
        Pressure [Pa; Hertz pressure] and film [m; dry approach].
    approach : float
        Mutual approach [m; dry approach].
    force : float
        Force of the film and of asperities [N; static load].
    h_central, h_min : float
        Film at x = y = 0 and the smallest, between the nodes too [m; dry approach].
    p_max, pressure_error : float
        Largest pressure, and its largest change in further cycles [Pa; Hertz pressure].
    moment : float
        Moment of the pressure about the centre line [N m; static load times a].
    residuals : ndarray, shape (cycles + 1,)
        Mean absolute residual over p > 0: at the start after full multigrid, then after each cycle. It weighs a
        node by its Poiseuille coefficient, so it is most where pressure matters least: what is solved is judged by
        `pressure_error`.
    load_residuals : ndarray, shape (cycles + 1,)
        Residual of the load (or approach) equation, over the static load (or dry approach), after each cycle.
    approach_changes : ndarray, shape (cycles,)
        Change of the approach in each cycle [m; dry approach].
    pressure_changes : ndarray, shape (cycles,)
        Largest change of the pressure in each cycle [Pa; Hertz pressure].
    dry_residual : float
        Mean absolute residual of the dry Hertz start on this grid: the scale.
    status : Status
    error_estimate : ErrorEstimate or None
        How far approach [m; dry approach] and films may be from those of an endless fine mesh on the same region;
        None of a film that is not converged.
    supply : OilLayer or None
        As given to `solve_steady`; None of a flooded inlet, and with it the following three.
    content : ndarray or None, shape (nx + 1, ny + 1)
        Part of the gap that oil fills: 1 under pressure.
    layer, layer_behind : ndarray or None, shape (ny + 1,)
        Oil on both surfaces ahead of the contact and behind it [m; dry approach].
    sliding : ShearThinning or None
        As given to `solve_steady`; None of a Newtonian film.
    thinned_share : float or None
        Central film over the Newtonian one, on the same grid, where sliding thins the oil. With heat it is over
        the isothermal Newtonian film, as `temperature.film_share`: what both do together.
    temperature : FilmTemperature or None
        Of a film that was solved with heat: temperatures [K], and the film over the isothermal one.
    asperities : AsperityContact or None
        Of a film that was solved with them: their pressure beside that of the oil, and their share of the load.
    point, domain, n, seconds, version
        As in every result: `ehlcontact.origin.Origin`.
    """

    x: Annotated[Array, ALONG.over("x", listed=False)]
    y: Annotated[Array, ACROSS.over("y", listed=False)]
    p: Annotated[Array, PRESSURE.over("x y", listed=False)]
    h: Annotated[Array, LENGTH.over("x y", listed=False)]
    approach: Annotated[float, LENGTH]
    force: Annotated[float, FORCE]
    h_central: Annotated[float, LENGTH]
    h_min: Annotated[float, LENGTH]
    residuals: Annotated[Array, NUMBER.over("cycle", listed=False)]
    load_residuals: Annotated[Array, NUMBER.over("cycle", listed=False)]
    approach_changes: Annotated[Array, LENGTH.over("change", listed=False)]
    dry_residual: float
    status: Status
    pressure_changes: Annotated[Array, PRESSURE.over("change", listed=False)]
    error_estimate: ErrorEstimate | None = None
    supply: OilLayer | None = None
    content: Annotated[Array | None, NUMBER.over("x y", listed=False)] = None
    layer: Annotated[Array | None, LENGTH.over("y", listed=False)] = None
    layer_behind: Annotated[Array | None, LENGTH.over("y", listed=False)] = None

    temperature: FilmTemperature | None = None
    asperities: AsperityContact | None = None
    sliding: ShearThinning | None = None
    thinned_share: float | None = None

    DISPLAY: ClassVar[Display] = Display(rows="x y", panels=("p", "h"))

    def require_complete(self, **sizes: int) -> None:
        """Raise `ValueError` unless all arrays have the shapes of each other and of the grid."""
        QuantityTable.require_complete(self, x=self.n + 1, change=max(self.residuals.size, 1) - 1)

    @property
    def conditions(self) -> Conditions:
        """Conditions that it was solved under, with the data of the oil."""
        heat, rough = self.temperature, self.asperities
        return Conditions(
            supply=self.supply,
            heat=None if heat is None else heat.inputs,
            sliding=self.sliding,
            asperities=None if rough is None else rough.inputs,
        )

    @property
    def pressure_error(self) -> Annotated[float, PRESSURE]:
        """Largest change of the pressure in further cycles; over the Hertz pressure, `tol` is its limit.

        Infinite where the changes do not fall, NaN before the first cycle.
        """
        from ehlcontact.solver.iterate import pressure_error  # and all kernels, which a stored result needs not

        changes = self.pressure_changes.tolist()
        return pressure_error(changes) if changes else nan

    @property
    def moment(self) -> Annotated[float, MOMENT]:
        """Moment of the pressure about the centre line, ``-iint p x dx dy``.

        Positive where it resists rolling: pressure builds up before the contact. The film's rolling resistance is
        all in it. In pure rolling the flow that pressure drives shears both surfaces alike, by ``h/2 dp/dx``, and
        its sum over each is ``1/2 iint h dp/dx = -1/2 iint p dh/dx``. Of the slope of the film that of the elastic
        deflection does not count (half-spaces give back what they take: the kernel is even), which leaves x/Rx: a
        drag of ``-1/(2 Rx) iint p x`` on each surface. So the power lost at the speed u is
        ``2 u drag = moment u (1/R1 + 1/R2)``, the moment times the angular speed at which the bodies roll on each
        other, and body i needs the torque ``moment R_i/(2 Rx)`` about its own axis; what pressure itself exerts
        about that axis is 0 by the same evenness. Not in it: hysteresis of the materials, sliding and spin,
        adhesion. Houpert, Tribology Transactions 45 (2002) 345-353, has such a balance of forces and moments.
        Summed over the balls of a 6205 it is within a fifth of SKF's rolling frictional moment
        (`tests/reduced_models/atlas/test_atlas.py`).

        It depends on the oil further out, hence on the domain, by about lambda times the logarithm of its extent.
        Around very thin films `solve_steady` closes the region in: it is 7 to 13 % low there (five films).
        """
        # Trapezoids; twice the half of y >= 0, whose line in the middle counts half; p = 0 on the border.
        s = self.point.scales
        cell = (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])
        lines = self.p.sum(axis=1) - 0.5 * self.p[:, 0]
        unit = s.moment / (s.pressure * s.a * s.a * s.b)  # 1 in Moes units, where 2 pi/3 is the load
        return float(-1.5 / pi * 2.0 * cell * (self.x @ lines) * unit)

    def traction(self, slide_roll: ArrayLike, law: TractionLaw) -> Traction:
        """Traction, shear stress and power of this film while its surfaces slide (docs/traction.md).

        Parameters
        ----------
        slide_roll : float or array_like, shape (k,)
            Slide-to-roll ratios, difference over mean of the surface speeds: 0 to 2, where one surface stands
            still. Of a heated film its own: `traction_curve` solves one for each.
        law : TractionLaw
            `Eyring`, `Carreau` or `LimitingShear`.

        Raises
        ------
        InputError
            A ratio out of range, or another than that of the heated film; no law; a film that has not converged,
            or at a dimensionless point.
        """
        return traction_of(self, slide_roll, law)

    def capacitance(
        self, permittivity: float = OIL, *, surroundings: float | None = None, reach: float | None = None
    ) -> FilmCapacitance:
        """Capacitance between the bodies across this film and its surroundings (docs/capacitance.md).

        Parameters
        ----------
        permittivity : float
            Of the oil, relative: 2.0 to 2.5 of mineral and hydrocarbon oils.
        surroundings : float, optional
            Of what fills the gap beyond the region that was solved: 1 for air; the oil by default. Behind the
            contact the oil that left it stands in layers on both surfaces.
        reach : float, optional
            Radius [m] up to which the bodies face each other; by default the smaller radius of relative curvature.

        Raises
        ------
        InputError
            A permittivity below 1; a film that has not converged, or at a dimensionless point.
        """
        return capacitance_of(self, permittivity, surroundings, reach)

    @property
    def supply_behind(self) -> OilLayer:
        """What the surfaces carry away, as the supply of the next contact of the same size.

        Raises
        ------
        InputError
            The inlet is flooded: what leaves depends on what is added ahead of the next contact.
        """
        if self.layer_behind is None:
            raise InputError("supply", None, "given: what leaves a flooded contact is not known")
        return layer_on(self.point, self.layer_behind, self.y)

    @property
    def residual(self) -> Annotated[float, NUMBER]:
        """Last residual relative to that of the dry Hertz start."""
        return float(self.residuals[-1] / self.dry_residual)

    @property
    def load_residual(self) -> Annotated[float, NUMBER]:
        """Last residual of the load equation."""
        return float(self.load_residuals[-1])

    @property
    def cycles(self) -> Annotated[int, NUMBER]:
        """Number of V cycles on the finest grid."""
        return len(self.residuals) - 1

    @property
    def p_max(self) -> Annotated[float, PRESSURE]:
        """Largest pressure."""
        return float(self.p.max())

    @property
    def film_origin(self) -> str:
        """How the smallest film was found, and how sure it is, in words."""
        if not self.status.ok:
            return f"not solved: {self.status}"
        if self.error_estimate is None:
            return "solved"
        bar = self.error_estimate.h_min_relative
        return "solved, off by anything" if bar >= ALL else f"solved, ± {float(f'{100.0 * bar:.2g}'):g} %"

    @property
    def reservation(self) -> str:
        """What a converged film leaves open, in words: of its mesh, and of asperities; else empty."""
        if not self.status.ok:
            return ""
        rough = "" if self.asperities is None else self.asperities.reservation
        return "; ".join(filter(None, [grid_doubt(self.error_estimate), rough]))

    @property
    def outside_assumptions(self) -> str:
        """Assumptions that do not hold at this contact, in words (`ehlcontact.assumptions`); empty where none."""
        return judged(self).headline if self.status.ok else ""

    def picture(self) -> Picture:
        """Maps of pressure and film, and both along the mid-planes."""
        note = maps_note(ContactView.of(self.point, self.x, self.y))
        return Picture(self.panels(), self._title(), note=note)

    def _panels(self) -> Iterator[Any]:
        view, (p, h) = ContactView.of(self.point, self.x, self.y), fields(self.point, self.p, self.h)
        yield from contact_panels(view, p, h, self.h_central, self.point.scales.pressure, self.content)

    def _summary_lines(self) -> list[str]:
        bars = ["", ""]
        if self.error_estimate is not None:
            bars = [f" ({bar})" for bar in film_bars(self.error_estimate)]
        size, unit = film_unit(self.point)
        central, least = size * self.h_central, size * self.h_min
        largest = self.p_max / self.point.scales.pressure
        return [
            contact_text(self.point),
            f"{self.status} on n = {self.n}, p and h of {len(self.x)} x {len(self.y)} nodes",
            f"approach {size * self.approach:.5g} {unit}; largest pressure {largest:.4g} of the Hertz pressure",
            f"film {central:.4g}{bars[0]} in the centre, {least:.4g}{bars[1]} at least, {unit}",
            *([] if self.layer is None else [self._supply_line(size, unit)]),
            *([] if self.temperature is None else [self.temperature.summary(self.sliding is not None)]),
            *([] if self.asperities is None else [self.asperities.summary]),
            *([] if self.sliding is None else [self._sliding_line(self.sliding)]),
            *filter(None, [self.reservation]),
            *note_line(self.outside_assumptions),
        ]

    @property
    def front(self) -> float | None:
        """First node under pressure on y = 0, up to which an oil supply fills the gap in part only; as `x`.

        None for a flooded inlet.
        """
        return None if self.layer is None else float(self.x[int(np.argmax(self.p[:, 0] > 0.0))])

    def _supply_line(self, size: float, unit: str) -> str:
        """Layer that enters, and where the full film begins, in words."""
        assert self.layer is not None
        assert self.front is not None
        front = self.front / self.point.scales.a
        layers = sorted({f"{size * h:.4g}" for h in (self.layer.min(), self.layer.max())})
        return f"layer of oil {' to '.join(layers)} {unit}; the film is full from x/a = {front:.3g} on"

    def _sliding_line(self, sliding: ShearThinning) -> str:
        """Shear thinning by sliding, in words; with heat its share is that of both, in the line of the heat."""
        if self.temperature is not None:
            return f"slide-to-roll ratio {sliding.slide_roll:g}"
        assert self.thinned_share is not None
        share = 100.0 * self.thinned_share
        return f"slide-to-roll ratio {sliding.slide_roll:g}: central film {share:.4g} % of the Newtonian one"

    def to_dict(self) -> dict[str, Any]:
        """Numbers without the fields, status and origin, ready for JSON."""
        said: dict[str, Any] = {"status": str(self.status), "advice": self.status.advice}
        said |= {"reservation": self.reservation, "outside_assumptions": self.outside_assumptions}
        if self.supply is not None:
            said |= {"supply": self.supply.to_dict(), "front": self.front}
        if self.sliding is not None:
            said |= {"sliding": self.sliding.to_dict(), "thinned_share": self.thinned_share}
        if self.temperature is not None:
            said |= {"temperature": self.temperature.to_dict()}
        if self.asperities is not None:
            said |= {"asperities": self.asperities.to_dict()}
        return PointTable.to_dict(self) | said | self.origin_dict()
