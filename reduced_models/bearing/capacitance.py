"""`BearingCapacitance`: capacitance of the films of a bearing, voltage across them, and films from a measurement.

Both contacts of a ball are in series, all balls are in parallel between the rings. A contact is a dry one that its
central film separates (`ehlcontact.capacitance.hertz_capacitance`): for contacts of bearings within -3 to +6 % of
their solved films (docs/notes/capacitance.md). An unloaded ball is a paraboloid at its gap, its film.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import exp, log
from typing import TYPE_CHECKING, Annotated, ClassVar

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.capacitance import OIL, DryGap, GapCapacitance, hertz_capacitance, require_permittivity
from ehlcontact.checks import require_nonnegative, require_positive
from ehlcontact.errors import InputError
from ehlcontact.quantities import LENGTH, NUMBER, Quantity
from ehlcontact.results.table import Display, QuantityTable
from reduced_models.bearing.race import RACES

if TYPE_CHECKING:
    from reduced_models.bearing.equilibrium_result import BearingState
    from reduced_models.life.internal_geometry import InternalGeometry

_Floats = NDArray[np.float64]

FARAD = Quantity("F")
FARTHEST = 30.0  # times thicker or thinner than computed: films that a measurement may ask for
VOLTS = 1e-6  # V/m in V/um
LARGEST = 1e-6  # F, of a bearing


@dataclass(frozen=True, eq=False, kw_only=True)
class BearingCapacitance(QuantityTable):
    """Capacitance of a bearing between its rings; SI.

    Attributes
    ----------
    contact : ndarray, shape (balls, 2)
        Of every contact, inner and outer race [F].
    ball : ndarray, shape (balls,)
        Of the two contacts of a ball in series [F].
    total, least, largest : float
        Of all balls [F]; with air in place of oil around the contacts; with oil in all gaps.
    permittivity : float
    h_min : ndarray, shape (balls, 2)
        Smallest film of every contact [m]; of an unloaded ball its gap.
    """

    contact: Annotated[_Floats, FARAD.over("ball race")]
    ball: Annotated[_Floats, FARAD.over("ball")]
    total: Annotated[float, FARAD]
    least: Annotated[float, FARAD]
    largest: Annotated[float, FARAD]
    permittivity: Annotated[float, NUMBER]
    h_min: Annotated[_Floats, LENGTH.over("ball race")]

    DISPLAY: ClassVar[Display] = Display(rows="ball", labels={"race": RACES}, first=0)

    def voltage(self, across: float) -> _Floats:
        """Voltage across every film [V], shape (balls, 2), where `across` [V] is that between the rings."""
        shared = require_positive("across", across) * self.ball
        return np.asarray(shared[:, None] / self.contact)

    def field_strength(self, across: float) -> float:
        """Largest field in a film [V/um] under a voltage between the rings [V].

        Films are said to break down from some 15 to 60 V/um on; no data here support a limit.

        Raises
        ------
        InputError
        """
        return float((self.voltage(across) / self.h_min).max()) * VOLTS

    def _summary_lines(self) -> list[str]:
        k = int(np.argmax(self.ball))
        inner, outer = (f"{1e12 * one:.4g}" for one in self.contact[k])
        return [
            f"{1e12 * self.total:.4g} pF between the rings, between {1e12 * self.least:.4g} and"
            f" {1e12 * self.largest:.4g} pF by where oil stands",
            f"most of ball {k}: {1e12 * self.ball[k]:.4g} pF, of inner {inner} and outer contact {outer} pF",
            f"1 V between the rings is up to {self.field_strength(1.0):.4g} V/µm",
            f"permittivity {self.permittivity:g}",
        ]


@dataclass(frozen=True, eq=False, kw_only=True)
class MeasuredFilm(QuantityTable):
    """Films of a bearing by its capacitance; SI.

    Attributes
    ----------
    capacitance : float
        That was measured [F].
    ratio : float
        Of all films, over the computed ones.
    low, high : float
        Of the interval of that ratio.
    h_min, h_min_low, h_min_high : float
        Smallest film of the bearing [m], with its interval.
    """

    capacitance: Annotated[float, FARAD]
    ratio: Annotated[float, NUMBER]
    low: Annotated[float, NUMBER]
    high: Annotated[float, NUMBER]
    h_min: Annotated[float, LENGTH]
    h_min_low: Annotated[float, LENGTH]
    h_min_high: Annotated[float, LENGTH]

    DISPLAY: ClassVar[Display] = Display(rows="")

    def _summary_lines(self) -> list[str]:
        film, thin, thick = (f"{1e6 * one:.3g}" for one in (self.h_min, self.h_min_low, self.h_min_high))
        return [
            f"{1e12 * self.capacitance:.4g} pF: films {self.ratio:.3g} times the computed ones,"
            f" between {self.low:.3g} and {self.high:.3g}",
            f"smallest film {film} µm, between {thin} and {thick} µm",
        ]


def capacitance_of(
    state: BearingState, permittivity: float = OIL, surroundings: float | None = None, films: float = 1.0
) -> BearingCapacitance:
    """See `BearingState.capacitance`; `films` makes all films thicker by a factor."""
    e = require_permittivity("permittivity", permittivity)
    beyond = e if surroundings is None else require_permittivity("surroundings", surroundings)
    own, central, smallest = state.internals, state.h_central, state.h_min
    if own is None or central is None or smallest is None:
        raise InputError("state", "dry", "one of a bearing with oil that turns: without films its rings touch")
    angle = np.full(state.force.shape, own.contact_angle) if state.contact_angles is None else state.contact_angles
    contacts = contact_capacitance(own, state.force, films * central, angle, e, beyond)
    ball = _series(contacts.total)
    return BearingCapacitance(
        contact=contacts.total,
        ball=ball,
        total=float(ball.sum()),
        least=float(_series(contacts.least).sum()),
        largest=float(_series(contacts.largest).sum()),
        permittivity=e,
        h_min=films * smallest,
    )


def joined(bearings: Iterable[BearingCapacitance]) -> BearingCapacitance:
    """Bearings in parallel as one, ball after ball."""
    every = list(bearings)
    return BearingCapacitance(
        contact=np.concatenate([one.contact for one in every]),
        ball=np.concatenate([one.ball for one in every]),
        total=sum(one.total for one in every),
        least=sum(one.least for one in every),
        largest=sum(one.largest for one in every),
        permittivity=every[0].permittivity,
        h_min=np.concatenate([one.h_min for one in every]),
    )


def film_from_capacitance(
    state: BearingState,
    capacitance: float,
    *,
    error: float = 0.0,
    permittivity: float = OIL,
    permittivity_error: float = 0.1,
    law_error: float = 0.06,
) -> MeasuredFilm:
    """See `BearingState.film_from_capacitance`."""
    measured = require_positive("capacitance", capacitance)
    if measured > LARGEST:
        guess = f"in pF? then {capacitance * 1e-12:g} F"
        raise InputError("capacitance", capacitance, f"at most {LARGEST:g} F ({guess})")
    spread = require_nonnegative("error", error)
    if spread >= measured:
        raise InputError("error", error, f"below the capacitance, {measured:g} F")
    doubt = require_nonnegative("permittivity_error", permittivity_error)
    e = require_permittivity("permittivity", permittivity)
    law = require_nonnegative("law_error", law_error)
    if law >= 1.0:
        raise InputError("law_error", law_error, "a share, below 1")
    ratio = _ratio(state, measured, e)
    thick = _ratio(state, (measured - spread) * (1.0 - law), e + doubt)
    thin = _ratio(state, (measured + spread) * (1.0 + law), max(e - doubt, 1.0))
    loaded = np.asarray(state.force) > 0.0
    assert state.h_min is not None
    least = float(state.h_min[loaded].min())
    return MeasuredFilm(
        capacitance=measured,
        ratio=ratio,
        low=thin,
        high=thick,
        h_min=ratio * least,
        h_min_low=thin * least,
        h_min_high=thick * least,
    )


def _ratio(state: BearingState, measured: float, e: float) -> float:
    """By how much films must be thicker for a capacitance [F]."""

    def miss(x: float) -> float:
        return log(capacitance_of(state, e, None, exp(x)).total / measured)

    low, high = -log(FARTHEST), log(FARTHEST)
    if miss(low) < 0.0 or miss(high) > 0.0:
        ends = (capacitance_of(state, e, None, exp(end)).total for end in (high, low))
        least, most = (f"{1e12 * one:.4g}" for one in ends)
        allowed = f"between {least} and {most} pF: films {FARTHEST:g} times thicker or thinner than computed"
        raise InputError("capacitance", measured, allowed)
    return exp(float(scipy.optimize.brentq(miss, low, high, xtol=1e-9)))


def _series(contacts: _Floats) -> _Floats:
    """Capacitance of balls [F], of that of their contacts, shape (..., 2)."""
    return np.asarray(1.0 / (1.0 / contacts).sum(axis=-1))


def contact_capacitance(
    own: InternalGeometry, load: _Floats, film: _Floats, angle: _Floats, permittivity: float, surroundings: float
) -> GapCapacitance:
    """Capacitance of contacts of balls under loads [N], with central films [m], at angles [rad], shape (..., 2).

    Columns are those of inner and outer race.
    """
    gamma = own.ball_diameter * np.cos(angle) / own.pitch_diameter
    along = 0.5 * own.ball_diameter * (1.0 + np.array([-1.0, 1.0]) * gamma)
    conformity = np.array([own.conformity_inner, own.conformity_outer])
    across = conformity * own.ball_diameter / (2.0 * conformity - 1.0)
    gap = DryGap.under(load, np.array(own.unit_pressures), along, across)
    return hertz_capacitance(gap, film, permittivity, surroundings, np.minimum(along, 0.5 * own.ball_diameter))


def between_rings(own: InternalGeometry, load: _Floats, film: _Floats, angle: _Floats, e: float) -> _Floats:
    """Capacitance of bearings [F], of what their contacts have, shape (..., balls, 2); oil in all gaps."""
    return np.asarray(_series(contact_capacitance(own, load, film, angle, e, e).total).sum(axis=-1))
