"""Entries of a study in terms of the library: pairs, moments and tilts of a ring, oil supply and heat."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.parts import Part
from ehlcontact.errors import InputError
from ehlcontact.heat import Heat
from ehlcontact.supply import OilLayer
from reduced_models import BallBearing, BearingSet

if TYPE_CHECKING:
    from ehlcontact import Lubricant

OIL_AND_HEAT = "layer_um", "layer_ratio", "thermal"


def pair_part(
    bearing: BallBearing,
    arrangement: str,
    *,
    preload: float | None = None,
    spring: float | None = None,
    distance_mm: float | None = None,
) -> Part:
    """The call that makes two such bearings in an arrangement of `ehlcontact.cli.entries.Arrangement`.

    Raises
    ------
    InputError
        Bearings without a contact angle; a preload of bearings in tandem, or by offsets and by a spring.
    """
    words = arrangement.replace("-", " ")
    if bearing.free_angle == 0.0:
        allowed = "left out: bearings of a pair need a contact angle, as 7205 has one (or --contact-angle)"
        raise InputError("arrangement", arrangement, allowed)
    keywords = {
        "distance": None if distance_mm is None else 1e-3 * distance_mm,
        "preload": preload,
        "spring": spring,
        "name": f"pair of {bearing.name or 'ball bearings'}, {words}",
    }
    return Part(BearingSet, keywords, "pair", (bearing, words))


def moments_of(given: Any, section: str) -> tuple[float, ...]:
    """Moments about x and y [N m], under which the ring tilts freely; empty where none is given.

    Parameters
    ----------
    given : Section
        With ``moment_x``, ``moment_y``, ``tilt_x_mrad`` and ``tilt_y_mrad``.
    section : str
        Its name, for the message.

    Raises
    ------
    InputError
        Moments beside tilts at which the ring is held.
    """
    if given.moment_x is given.moment_y is None:
        return ()
    if tilt_of(given) is not None:
        name = "tilt_y_mrad" if given.tilt_x_mrad is None else "tilt_x_mrad"
        allowed = "left out beside moments, under which the inner ring tilts freely"
        raise InputError(f"{section}.{name}", getattr(given, name), allowed)
    return given.moment_x or 0.0, given.moment_y or 0.0


def tilt_of(given: Any) -> tuple[float, float] | None:
    """Tilts about x and y at which the ring is held [rad]; None where they are not given."""
    if given.tilt_x_mrad is given.tilt_y_mrad is None:
        return None
    return 1e-3 * (given.tilt_x_mrad or 0.0), 1e-3 * (given.tilt_y_mrad or 0.0)


def supply_and_heat(given: Any, section: str, oil: Lubricant | None) -> tuple[OilLayer | None, Heat | None]:
    """The layer of oil and the data of heat that are given, each None where it is not.

    Parameters
    ----------
    given : Section
        With the entries `OIL_AND_HEAT`.
    section : str
        Its name, for messages.
    oil : Lubricant or None
        None of a dry bearing.

    Raises
    ------
    InputError
        Both thicknesses; any of the entries of a dry bearing; heat of an oil without its data.
    """
    asked = [name for name in OIL_AND_HEAT if getattr(given, name)]
    if not asked:
        return None, None
    field, value = f"{section}.{asked[0]}", getattr(given, asked[0])
    if oil is None:
        raise InputError(field, value, "left out: a dry bearing has no films")
    if len({"layer_um", "layer_ratio"}.intersection(asked)) > 1:
        raise InputError(field, value, "left out where the layer is given over the flooded film (layer_ratio)")
    if given.thermal and oil.temperature_slope is None:
        allowed = "given with an oil by its grade, which has the change of viscosity with temperature"
        raise InputError(f"{section}.thermal", True, allowed)
    layer, ratio = given.layer_um, given.layer_ratio
    supply = None if layer is None else OilLayer(1e-6 * layer)
    if ratio is not None:
        supply = OilLayer(over_flooded=ratio)
    return supply, Heat() if given.thermal else None


def supply_words(supply: OilLayer | None) -> str:
    """The layer in words."""
    if supply is None:
        return ""
    if supply.h is not None:
        return f"{numeral(1e6 * supply.h)} µm on both surfaces together"
    return f"r = {numeral(supply.over_flooded)} over what the flooded isothermal film of each contact lets through"
