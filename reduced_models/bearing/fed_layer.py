"""`FedLayer`: a layer of oil that a feed keeps on the tracks of a bearing, and what a contact takes off it.

The layer is `OilLayer(h)` wherever one is asked for. It holds beside that how oil comes back, so that linear
answers of a bearing can let the layer follow the passes of its balls while the feed is held (`oil_feedback`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import Any

from ehlcontact.checks import parts, require_between
from ehlcontact.checks.inputs import require_number
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import InputError
from ehlcontact.film_formulas import film_of_layer
from ehlcontact.supply import OilLayer


@fields_take(h=parts.LAYER)
@dataclass(frozen=True, slots=True)
class FedLayer(OilLayer):
    """Uniform layer [m] that a feed keeps, as `OilBalance.lasting_supply` finds it.

    Parameters
    ----------
    h : float
        Thickness on both surfaces together [m].
    returned : float
        Share of the oil pressed aside that returns to the tracks, from 0 to below 1.
    return_time : float
        Time constant of the return [s].
    sharpness : float, optional
        g of the film over its layer, by default that of each contact's ellipse; as of `OilBalance`.

    Raises
    ------
    InputError
        No thickness in metres, or a profile; a share or a time outside its range.
    """

    returned: float = 0.0
    return_time: float = inf
    sharpness: float | None = None

    def __post_init__(self) -> None:
        OilLayer.__post_init__(self)
        if self.h is None or self.y is not None:
            raise InputError("supply", "a profile, or no h", "a uniform layer h [m], where a feed keeps it")
        require_return(self.returned, self.return_time, self.sharpness)
        if self.returned == 1.0:
            raise InputError("returned", 1.0, "below 1: a layer that loses nothing needs no feed")

    def to_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        time = None if self.return_time == inf else self.return_time
        fed = {"returned": self.returned, "return_time": time, "sharpness": self.sharpness}
        return OilLayer.to_dict(self) | {"fed": fed}


def require_return(returned: float, return_time: float, sharpness: float | None) -> None:
    """Raise `InputError` unless these can be those of oil that returns, and g of a film over its layer."""
    require_between("returned", returned, 0.0, 1.0)
    require_number("return_time", return_time, "a time [s]")
    if not return_time > 0.0 or (returned > 0.0 and return_time == inf):
        raise InputError("return_time", return_time, "> 0 and finite [s], where oil returns")
    if sharpness is not None:
        require_between("sharpness", sharpness, 1.0, 30.0)


def layer_from(entries: Mapping[str, Any]) -> OilLayer:
    """Back from `OilLayer.to_dict` or `FedLayer.to_dict`."""
    own = dict(entries)
    fed = own.pop("fed", None)
    if fed is None:
        return OilLayer.from_dict(own)
    time = inf if fed["return_time"] is None else fed["return_time"]
    return FedLayer(**own, **(fed | {"return_time": time}))


def lost_share(ratio: Any, sharpness: Any, growth: Any) -> Any:
    """Share x of a layer that leaves the track in a pass; numbers or arrays.

    Parameters
    ----------
    ratio : float or ndarray
        r, the layer over what the flooded film lets through.
    sharpness : float or ndarray
        g of `ehlcontact.film_formulas.film_of_layer`.
    growth : float or ndarray
        By how much r^-2 grows in a pass by side flow: `ehlcontact.side_flow` times the square of that layer.
    """
    starved = 1.0 - film_of_layer(ratio, sharpness) / ratio
    aside = 1.0 - (1.0 + growth * ratio * ratio) ** -0.5
    return (starved**3 + aside**3) ** (1.0 / 3.0)
