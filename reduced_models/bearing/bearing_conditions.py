"""Oil, its supply and heat of the films of a bearing: which go together, and what they are in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ehlcontact import Lubricant
from ehlcontact.checks import require_instance, require_nonnegative
from ehlcontact.checks.admissible_range import INPUTS
from ehlcontact.conditions import Conditions
from ehlcontact.errors import InputError
from reduced_models.atlas.heat import require_rolling
from reduced_models.atlas.supply import require_uniform

if TYPE_CHECKING:
    from reduced_models.bearing.ball_bearing import BallBearing


def require_oil(oil: Any) -> None:
    """Raise `InputError` for an oil that is none."""
    if oil is not None:
        require_instance("oil", oil, Lubricant, "a Lubricant, as Lubricant.iso_vg(68, temperature=50.0)")


def conditions_of(bearing: BallBearing) -> Conditions:
    """Supply and heat of all films of a bearing; raises `InputError` for those that it does not take."""
    conditions = Conditions.of(supply=bearing.supply, thermal=bearing.thermal)
    if conditions.supply is not None:
        require_uniform(conditions.supply)
        if bearing.oil is None:
            raise InputError("supply", supply_words(bearing), "left out of a dry bearing, which has no oil")
        if conditions.supply.H is not None:
            raise InputError("supply", "H", "h [m] or over_flooded: dry approaches differ from ball to ball")
    if conditions.heat is not None:
        require_rolling(conditions.heat)
        if bearing.oil is None:
            raise InputError("thermal", "Heat", "left out of a dry bearing, which has no films")
    return conditions


def require_speed(bearing: BallBearing, speed_rpm: float) -> float:
    """The speed [rev/min] where the bearing can run at it; raises `InputError` where not."""
    speed = require_nonnegative("speed_rpm", speed_rpm)
    if speed > 0.0:
        INPUTS["speed_rpm"].require("speed_rpm", speed)
    if bearing.oil is None:
        return speed
    if speed == 0.0:
        raise InputError("speed_rpm", speed, "> 0 for a bearing with oil: without rolling there is no film")
    if speed > bearing.highest_speed:
        ending = bearing.tables.end[1]
        allowed = f"at most {bearing.highest_speed:.5g}, where {ending} ends for this bearing and oil"
        raise InputError("speed_rpm", speed, allowed)
    return speed


def supply_words(bearing: BallBearing) -> str:
    """The oil supply in words."""
    if bearing.supply is None:
        return "flooded"
    r, h = bearing.supply.over_flooded, bearing.supply.h
    films = "flooded films" if bearing.thermal is None else "flooded isothermal films"
    return f"a layer of {1e6 * h:.4g} µm" if r is None else f"a layer of {r:.4g} {films}"


def condition_lines(bearing: BallBearing) -> list[str]:
    """Lines of a summary about oil, supply and heat."""
    oil = bearing.oil
    if oil is None:
        return ["dry"]
    lines = [f"oil of {oil.eta0:.4g} Pa s, alpha {1e9 * oil.alpha:.4g} 1/GPa, {supply_words(bearing)}"]
    if bearing.thermal is not None:
        inlets = oil.temperature if bearing.thermal.temperature is None else bearing.thermal.temperature
        lines.append(f"films heat up, inlets at {inlets:.4g} degrees Celsius")
    return lines
