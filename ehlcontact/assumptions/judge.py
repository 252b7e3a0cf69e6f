"""`assumptions`: judgement of all assumptions at an operating point."""

from __future__ import annotations

from math import hypot
from typing import Protocol

from ehlcontact.assumptions.bodies import constant_speed, elastic, one_direction
from ehlcontact.assumptions.contact import Contact, KnownFilm
from ehlcontact.assumptions.film import fully_flooded, isothermal, newtonian, smooth
from ehlcontact.assumptions.table import Assumptions
from ehlcontact.checks import require_instance, require_nonnegative, require_positive
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.lubricant.oil import typical_temperature_slope
from ehlcontact.point import OperatingPoint, Point
from ehlcontact.solver.domain import Domain


class Judged(KnownFilm, Protocol):
    """A result with films, and its contact."""

    @property
    def point(self) -> Point:
        """The contact."""


CONDUCTIVITY = 0.134  # W/(m K), measured of FVA 3 (Schwarz et al. 2023, table A1); mineral oils 0.12 to 0.15
ROUGHEST = 1e-4  # m: no rolling surface, but a slip of unit


@takes(roughness="m", vibration="m/s", temperature_slope="1/K", conductivity="W/(m K)")
def assumptions(
    point: Point,
    *,
    film: KnownFilm | None = None,
    domain: Domain | None = None,
    roughness: tuple[float, float] | None = None,
    vibration: float | None = None,
    temperature_slope: float | None = None,
    conductivity: float = CONDUCTIVITY,
) -> Assumptions:
    """Judge what a solve at this point assumes.

    Without a film the central one of Nijenbanning, Venner and Moes and the smallest one of Hamrock and Dowson are
    taken; of heavily loaded circles the latter is up to three times too high, and with it the lambda ratio
    (docs/assumptions.md). A dimensionless point says nothing about heat, roughness or stresses: those are not
    judged.

    Parameters
    ----------
    point : OperatingPoint or MoesPoint
    film : SteadyResult or AtlasAnswer, optional
        The film solved at this point, that of a `Response` too (``film=response.film``), or the answer of the
        atlas: ``film=Atlas().at(point)``. The region of a solved one counts as the flooded one, unless it was
        solved with an oil supply.
    domain : Domain, optional
        Region computed elsewhere, in place of that of `film`.
    roughness : (float, float), optional
        Rq of both surfaces [m].
    vibration : float, optional
        Largest speed that vibration adds along the surfaces [m/s].
    temperature_slope : float, optional
        -d ln(eta0)/dT [1/K]; that of the oil, and where it has none that of a typical mineral oil. Of a film that
        was solved with heat this and the next are its own.
    conductivity : float
        Of the oil [W/(m K)].

    Raises
    ------
    InputError
        An argument outside its range.
    """
    contact = Contact.of(point, film)
    if film is not None and domain is None:
        domain = getattr(film, "domain", None)
    if domain is not None:
        require_instance("domain", domain, Domain, "a Domain(x_in, x_out, y_max)")
    heated = getattr(film, "temperature", None)
    if heated is not None:
        temperature_slope, conductivity = heated.inputs.temperature_slope or None, heated.inputs.conductivity
    if temperature_slope is None and isinstance(point, OperatingPoint):
        temperature_slope = point.lubricant.temperature_slope
    if temperature_slope is None:
        temperature_slope = typical_temperature_slope(contact.moes.eta0)
    slope = require_positive("temperature_slope", temperature_slope)
    k = require_positive("conductivity", conductivity)
    flooded = getattr(film, "supply", None) is None  # a layer of oil is no assumption
    shaken = None if vibration is None else require_nonnegative("vibration", vibration)
    return Assumptions(
        (
            isothermal(contact, slope, k, None if heated is None else heated.film_share),
            newtonian(contact),
            smooth(contact, _composite(roughness)),
            *([fully_flooded(contact, domain)] if flooded else []),
            constant_speed(contact, shaken),
            one_direction(contact, shaken),
            elastic(contact),
        )
    )


def judged(result: Judged) -> Assumptions:
    """Judge what a result with films assumes at its own contact."""
    return assumptions(result.point, film=result)


def _composite(roughness: tuple[float, float] | None) -> float | None:
    if roughness is None:
        return None
    if not isinstance(roughness, tuple | list) or len(roughness) != 2:
        raise InputError("roughness", roughness, "a pair: Rq of both surfaces in m")
    for value in roughness:
        if require_positive("roughness", value) > ROUGHEST:
            raise InputError("roughness", value, f"above 0 and at most {ROUGHEST:g} m (given in um?)")
    return hypot(*roughness)
