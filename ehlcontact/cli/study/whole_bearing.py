"""The bearing of a study with all its balls: made from its entries, refused by them before anything is computed.

`study` is a `Study` of `schema`, whose checks call this.
"""

from __future__ import annotations

from math import ceil, radians
from typing import Any

import numpy as np

from ehlcontact.cli.spall import require_fit, spall_of
from ehlcontact.cli.study.shared_entries import moments_of, pair_of, supply_and_heat, tilt_of
from ehlcontact.errors import ConvergenceError, InputError
from reduced_models import BallBearing, BearingSet, Spall
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.freedoms import PLANAR
from reduced_models.bearing.grooves import LARGEST_PLAY
from reduced_models.bearing.set_result import SetState
from reduced_models.rotor.prepared_run import LEAST_STEPS

ENTRIES = {  # of a study, where the library calls them otherwise
    "balls": "bearing.balls",
    "clearance": "whole_bearing.clearance_um",
    "load": "bearing.radial_load",
    "tilt": "whole_bearing.tilt_x_mrad",
    "speed_rpm": "bearing.speed_rpm",
    "arrangement": "whole_bearing.pair",
    "preload": "whole_bearing.preload",
}

OF_A_PAIR = ("pair", "preload", "distance_mm")
# Entries of [whole_bearing] that only a bearing with contact angles has.
AT_ANGLES = (
    "moment_x",
    "moment_y",
    "tilt_x_mrad",
    "tilt_y_mrad",
    "contact_angle_deg",
    "race_control",
    "span_mm",
    *OF_A_PAIR,
)


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
        contact_angle=None if whole.contact_angle_deg is None else radians(whole.contact_angle_deg),
        race_control=whole.race_control or "outer",
        oil=study.lubricant if oil else None,
        rq_ball=rough[0] if rough else None,
        rq_race=rough[1] if rough else None,
        youngs_modulus=b.youngs_modulus,
        poisson_ratio=b.poisson_ratio,
    )


def bearing_or_pair(study: Any, *, oil: bool) -> BallBearing | BearingSet:
    """What carries the load: the bearing, or the pair.

    Raises
    ------
    InputError
        As `whole_bearing`; bearings that are no pair.
    """
    bearing, whole = whole_bearing(study, oil=oil), study.whole_bearing
    if whole.pair is None:
        for name in OF_A_PAIR:
            if getattr(whole, name) is not None:
                raise InputError(
                    f"whole_bearing.{name}", getattr(whole, name), "left out without whole_bearing.pair"
                )
        return bearing
    return pair_of(bearing, whole.pair, preload=whole.preload, distance_mm=whole.distance_mm)


def ring_load(study: Any) -> tuple[float, ...]:
    """Load on the inner ring of a bearing [N], [N m]; of two components where it is planar.

    Raises
    ------
    InputError
        Entries that need an axial load, without one; moments beside tilts.
    """
    whole, radial = study.whole_bearing, (0.0, -study.bearing.radial_load)
    moments = moments_of(whole, "whole_bearing")
    if whole.axial_load is not None:
        return (*radial, whole.axial_load, *moments)
    for name in AT_ANGLES:
        if getattr(whole, name) is not None:
            allowed = "left out without whole_bearing.axial_load: a planar bearing has no contact angles"
            raise InputError(f"whole_bearing.{name}", getattr(whole, name), allowed)
    return radial


def heaviest_ball(study: Any) -> tuple[float, float]:
    """Load [N] and contact angle [rad] of the ball that presses most on the race of the study, without films."""
    load, race = ring_load(study), int(study.bearing.race == "outer")
    under: dict[str, Any] = {"speed_rpm": study.bearing.speed_rpm, "tilt": tilt_of(study.whole_bearing)}
    state = bearing_or_pair(study, oil=False).equilibrium(load, **under)
    most = max(bearings_of(state).values(), key=lambda one: float(one.force[:, race].max()))
    assert most.contact_angles is not None
    ball = int(np.argmax(most.force[:, race]))
    return float(most.force[ball, race]), float(most.contact_angles[ball, race])


def bearings_of(state: BearingState | SetState) -> dict[str, BearingState]:
    """The bearing of a state, or both of a pair by the words that tell them apart in messages."""
    if not isinstance(state, SetState):
        return {"": state}
    pairs = zip(state.facings, state.bearings, strict=True)
    return {f"bearing {k}, facing {facing}": one for k, (facing, one) in enumerate(pairs)}


def require_whole_bearing(study: Any) -> None:
    """Raise `InputError`, by the entry of the file, for a bearing that is none or has films beyond the atlas."""
    names = ENTRIES | {f"conformity_{race}": "bearing.conformity" for race in ("inner", "outer")}
    whole = study.whole_bearing
    if whole.conformity_other is not None:
        names["conformity_outer" if study.bearing.race == "inner" else "conformity_inner"] = (
            "whole_bearing.conformity_other"
        )
    load, steps = ring_load(study), whole.steps_per_revolution
    supply_and_heat(whole, "whole_bearing", study.lubricant)
    if len(load) > len(PLANAR):
        names["load"] = "bearing.radial_load, whole_bearing.axial_load"
    try:
        bearing = bearing_or_pair(study, oil=True)
        bearing.equilibrium(load, speed_rpm=study.bearing.speed_rpm, tilt=tilt_of(whole))
    except InputError as error:
        value, allowed = error.value, error.allowed.removesuffix(" (or may_lift_off=True)")
        if error.field == "load":
            value = (-load[1], *load[2:]) if len(load) > len(PLANAR) else -load[1]
        if error.field == "clearance":
            value = whole.clearance_um
            if whole.contact_angle_deg is None:
                most = 1e3 * LARGEST_PLAY * study.bearing.ball_diameter_mm
                allowed = f"between {-most:.3g} and {most:.3g} um"
        raise InputError(names.get(error.field, error.field), value, f"{allowed}, for [whole_bearing]") from None
    except ConvergenceError as error:
        raise InputError(
            names["load"], (-load[1], *load[2:]), f"one with a balance of all balls ({error})"
        ) from None
    least = 0 if isinstance(bearing, BearingSet) else ceil(LEAST_STEPS * bearing.orders.bpfo_order)
    if steps < least and len(load) == len(PLANAR):
        allowed = f"at least {least}, {LEAST_STEPS} while a ball passes"
        raise InputError("whole_bearing.steps_per_revolution", steps, allowed)
    spall_in(study)


def spall_in(study: Any) -> Spall | None:
    """The spall of a study; None where it has none.

    Raises
    ------
    InputError
        What is no spall, one that the bearing has no place for, or one beside a pair or a tilt; slip without one.
    """
    whole = study.whole_bearing
    if whole.spall is None:
        if whole.cage_slip_percent is not None:
            allowed = "left out without whole_bearing.spall, whose lines it moves"
            raise InputError("whole_bearing.cage_slip_percent", whole.cage_slip_percent, allowed)
        return None
    for name in ("pair", "tilt_x_mrad", "tilt_y_mrad"):
        if getattr(whole, name) is not None:
            raise InputError("whole_bearing.spall", whole.spall, f"left out beside whole_bearing.{name}")
    try:
        found = spall_of(whole.spall)
    except InputError as error:
        raise InputError("whole_bearing.spall", whole.spall, error.allowed) from None
    require_fit(found, whole_bearing(study, oil=False), "whole_bearing.spall", whole.spall)
    return found
