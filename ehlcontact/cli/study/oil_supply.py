"""Oil supply and heat of a bearing: entries in the files of studies and of bearings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ehlcontact.cli.numerals import numeral
from ehlcontact.errors import InputError
from ehlcontact.heat import Heat
from ehlcontact.supply import OilLayer

if TYPE_CHECKING:
    from ehlcontact import Lubricant

ENTRIES = "layer_um", "layer_ratio", "thermal"


def supply_and_heat(given: Any, section: str, oil: Lubricant | None) -> tuple[OilLayer | None, Heat | None]:
    """The layer of oil and the data of heat that are given, each None where it is not.

    Parameters
    ----------
    given : Section
        With the entries `ENTRIES`.
    section : str
        Its name, for messages.
    oil : Lubricant or None
        None of a dry bearing.

    Raises
    ------
    InputError
        Both thicknesses; any of the entries of a dry bearing; heat of an oil without its data.
    """
    asked = [name for name in ENTRIES if getattr(given, name)]
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
