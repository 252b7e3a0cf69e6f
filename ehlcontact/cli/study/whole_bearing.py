"""The bearing of a study with all its balls: made from its entries, refused by them before anything is computed.

`study` is a `Study` of `schema`, whose checks call this.
"""

from __future__ import annotations

from math import ceil
from typing import Any

from ehlcontact.errors import InputError
from reduced_models import BallBearing
from reduced_models.bearing.ball_bearing import LARGEST_PLAY
from reduced_models.rotor.prepared_run import LEAST_STEPS

ENTRIES = {  # of a study, where the library calls them otherwise
    "balls": "bearing.balls",
    "clearance": "whole_bearing.clearance_um",
    "load": "bearing.radial_load",
    "speed_rpm": "bearing.speed_rpm",
}


def whole_bearing(study: Any, *, oil: bool) -> BallBearing:
    """The study's bearing with all its balls, in oil or dry.

    Raises
    ------
    InputError
        Balls that overlap, a clearance that is none, a race that the atlas does not have.
    """
    b, whole, rough = study.bearing, study.whole_bearing, study.roughness
    other = b.conformity if whole.conformity_other is None else whole.conformity_other
    inner, outer = (b.conformity, other) if b.race == "inner" else (other, b.conformity)
    return BallBearing(
        name=b.name,
        balls=b.balls,
        ball_diameter=b.ball_diameter_mm * 1e-3,
        pitch_diameter=b.pitch_diameter_mm * 1e-3,
        conformity_inner=inner,
        conformity_outer=outer,
        clearance=whole.clearance_um * 1e-6,
        oil=study.lubricant if oil else None,
        rq_ball=rough[0] if rough else None,
        rq_race=rough[1] if rough else None,
        youngs_modulus=b.youngs_modulus,
        poisson_ratio=b.poisson_ratio,
    )


def require_whole_bearing(study: Any) -> None:
    """Raise `InputError`, by the entry of the file, for a bearing that is none or has films beyond the atlas."""
    names = ENTRIES | {f"conformity_{race}": "bearing.conformity" for race in ("inner", "outer")}
    if study.whole_bearing.conformity_other is not None:
        names["conformity_outer" if study.bearing.race == "inner" else "conformity_inner"] = (
            "whole_bearing.conformity_other"
        )
    load, steps = study.bearing.radial_load, study.whole_bearing.steps_per_revolution
    try:
        bearing = whole_bearing(study, oil=True)
        bearing.equilibrium((0.0, -load), speed_rpm=study.bearing.speed_rpm)
    except InputError as error:
        value, allowed = load if error.field == "load" else error.value, error.allowed
        if error.field == "clearance":
            most = 1e3 * LARGEST_PLAY * study.bearing.ball_diameter_mm
            value, allowed = study.whole_bearing.clearance_um, f"between {-most:.3g} and {most:.3g} um"
        raise InputError(names.get(error.field, error.field), value, f"{allowed}, for [whole_bearing]") from None
    least = ceil(LEAST_STEPS * bearing.orders.bpfo)
    if steps < least:
        allowed = f"at least {least}, {LEAST_STEPS} while a ball passes"
        raise InputError("whole_bearing.steps_per_revolution", steps, allowed)
