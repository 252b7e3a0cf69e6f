"""Loads on the supports of a study: of a bearing alone, or of the machine at rest; the most loaded ball; checks.

Everything here is refused by the entry of the file before anything long is computed.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from math import ceil, hypot
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.spall import require_fit, spall_of
from ehlcontact.cli.study.machine import (
    bearing_of,
    called,
    carrier_of,
    clearance_limits_of,
    dimensions_of,
    disc_of,
    is_angular,
    rotor_of,
    support_field,
)
from ehlcontact.cli.study.shared_entries import moments_of, supply_and_heat, tilt_of
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.hertz import most_loaded_ball
from reduced_models import BallBearing, BearingSet, Spall, linearise
from reduced_models.bearing.catalogue import catalogue_row
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.freedoms import PLANAR
from reduced_models.bearing.motion import LEAST_STEPS
from reduced_models.bearing.set_result import SetState
from reduced_models.life.load_ratings import LoadRatings

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study
    from ehlcontact.cli.study.sections import Defect

_Floats = NDArray[np.float64]

OF_A_ROTOR = ("position_mm", "facing", "spring", "offset_um", "housing_stiffness", "housing_mass")
AT_ANGLES = ("moment_x", "moment_y", "tilt_x_mrad", "tilt_y_mrad")  # of [operation]: of balls with contact angles
RADIAL = "between 1e-06 and 1e+08 N, or beside an axial load"
OF_BEARING = "load of bearing "  # a field of the library's errors, with the number of the bearing


def load_alone(study: Study) -> tuple[float, ...]:
    """Load on the inner ring of a bearing alone [N], [N m]; of two components where it is planar.

    Raises
    ------
    InputError
        No load; entries that need an axial load, without one; moments beside tilts; entries of a machine.
    """
    asked, one = study.operation, study.support[0]
    for name in OF_A_ROTOR:
        if (value := getattr(one, name)) is not None:
            raise InputError(
                f"support.{name}", value, "left out without [shaft]: it is of a bearing under a shaft"
            )
    moments, radial = moments_of(asked, "operation"), asked.radial_load or 0.0
    if asked.axial_load is not None or (one.pair is not None and one.pair != "tandem"):
        return (0.0, -radial, asked.axial_load or 0.0, *moments)
    if (angular := _angular(study)) is not None:
        allowed = f"given: {angular} is an angular contact bearing, which carries axial load in +z"
        raise InputError("operation.axial_load", None, allowed)
    for key in AT_ANGLES:
        if (value := getattr(asked, key)) is not None:
            allowed = "left out without operation.axial_load: a planar bearing has no contact angles"
            raise InputError(f"operation.{key}", value, allowed)
    if one.race_control is not None:
        allowed = "left out without operation.axial_load: a planar bearing has no contact angles"
        raise InputError("support.race_control", one.race_control, allowed)
    if asked.radial_load is None:
        raise InputError("operation.radial_load", None, "given, or an axial load")
    if not radial and study.contact is not None:
        raise InputError("operation.radial_load", radial, RADIAL)
    return 0.0, -radial


def _angular(study: Study) -> str | None:
    """Name of an angular contact bearing alone; None of a deep-groove one."""
    one = study.support[0]
    name = one.label if one.bearing is None else catalogue_row(one.bearing)[0]
    return name if is_angular(study, 0) else None


def ring_load(study: Study, k: int) -> _Floats:
    """Load on a support [N], [N m], of a bearing alone or of the machine at rest at its speed.

    Under a shaft that of a pair is a force along x, y and z, without the moments that the pair holds.
    """
    if study.shaft is None:
        return np.asarray(load_alone(study))
    pressed = _pressed(study, k)
    if len(pressed) == 1:
        return pressed[0][1]
    carrier = carrier_of(study, k, oil=False)
    assert isinstance(carrier, BearingSet)
    signs = [1.0 if facing == "+z" else -1.0 for facing in carrier.facings]
    return np.asarray(sum(load[:3] * (1.0, 1.0, sign) for (_, load), sign in zip(pressed, signs, strict=True)))


def loads_at_rest(study: Study) -> list[_Floats]:
    """Load on every ball bearing of the machine at rest at its speed [N], [N m].

    Raises
    ------
    InputError
        A machine without a place of rest, by the entry of the file.
    """
    with loaded(study):
        return list(linearise(rotor_of(study), study.speed_rpm).loads)


def _pressed(study: Study, k: int) -> list[tuple[BallBearing, _Floats]]:
    """The bearings at a support and the load on each, of the machine at rest at its speed."""
    loads, first = study.loads_at_rest, 0
    for place in range(len(study.support)):
        carrier = carrier_of(study, place)
        bearings = list(carrier.bearings) if isinstance(carrier, BearingSet) else [carrier]
        if place == k:
            return list(zip(bearings, loads[first : first + len(bearings)], strict=True))
        first += len(bearings)
    raise AssertionError(k)


def by_formula(study: Study) -> bool:
    """Whether the load of the most loaded ball is that of Stribeck: planar, without clearance and films."""
    return ring_load(study, study.at).size == len(PLANAR) and not study.carrier.clearance


def heaviest_ball(study: Study) -> tuple[float, float]:
    """Load [N] and contact angle [rad] of the ball that presses most on the race of the study.

    Of a bearing alone it is without films, of a machine that at which the machine rests; `by_formula` of a planar
    bearing without clearance.
    """
    race = int(study.contact is not None and study.contact.race == "outer")
    k = study.at
    load = ring_load(study, k)
    if by_formula(study):
        return most_loaded_ball(study.radial_load, dimensions_of(study, k).balls), 0.0
    with loaded(study):
        if study.shaft is None:
            carrier, tilt = carrier_of(study, k, oil=False), tilt_of(study.operation)
            under = list(bearings_of(carrier.equilibrium(load, speed_rpm=study.speed_rpm, tilt=tilt)).values())
        else:
            under = [one.equilibrium(own, speed_rpm=study.speed_rpm) for one, own in _pressed(study, k)]
    most = max(under, key=lambda state: float(state.force[:, race].max()))
    ball = int(np.argmax(most.force[:, race]))
    angle = 0.0 if most.contact_angles is None else float(most.contact_angles[ball, race])
    return float(most.force[ball, race]), angle


def bearings_of(state: BearingState | SetState) -> dict[str, BearingState]:
    """The bearing of a state, or both of a pair by the words that tell them apart in messages."""
    if not isinstance(state, SetState):
        return {"": state}
    pairs = zip(state.facings, state.bearings, strict=True)
    return {f"bearing {k}, facing {facing}": one for k, (facing, one) in enumerate(pairs)}


def places_of_bearings(study: Study) -> list[int]:
    """Place in the file of the support of every bearing: that of a pair stands twice."""
    return [k for k, one in enumerate(study.support) for _ in range(1 if one.pair is None else 2)]


def life_options(study: Study) -> dict[str, Any]:
    """What the life of a `MachineState` needs beside loads: contamination, reliability, limits of clearances."""
    places = [0] if study.shaft is None else places_of_bearings(study)
    return {
        "contamination": study.contamination,
        "reliability": study.operation.reliability,
        "clearances": tuple(clearance_limits_of(study, k) for k in places),
    }


@contextmanager
def loaded(study: Study) -> Iterator[None]:
    """Let what the library says of an equilibrium name the loads of the file.

    Raises
    ------
    InputError
        Loads without a balance of all balls, or beyond what the films are known for.
    """
    asked = study.operation
    names = [name for name in ("radial_load", "axial_load") if getattr(asked, name) is not None]
    values = tuple(getattr(asked, name) for name in names)
    field = ", ".join(f"operation.{name}" for name in names) or "support"
    value = None if not values else values[0] if len(values) == 1 else values
    try:
        yield
    except InputError as error:
        allowed = error.allowed.removesuffix(" (or may_lift_off=True)")
        if error.field == "load":
            raise InputError(field, value, allowed) from None
        if error.field.startswith(OF_BEARING):
            place = places_of_bearings(study)[int(error.field.removeprefix(OF_BEARING))]
            entry, carried, rating = _carried(study, place, error.value)
            raise InputError(entry, carried, allowed + rating) from None
        if error.field in ("speed_rpm", "tilt"):
            name = "speed_rpm" if error.field == "speed_rpm" else "tilt_x_mrad"
            raise InputError(f"operation.{name}", getattr(asked, name), allowed) from None
        raise
    except ConvergenceError as error:
        raise InputError(field, value, f"with a balance of all balls ({error})") from None


def _carried(study: Study, k: int, load: Any) -> tuple[str, Any, str]:
    """Entry and value that load a support most: the spring or preload of its axial load, else the load itself.

    Then the static rating in words, beside the load.

    A radial load above the axial one is no matter of what presses the bearing along the shaft.
    """
    axial = abs(load[2]) if len(load) > len(PLANAR) and abs(load[2]) >= hypot(*load[:2]) else 0.0
    for place, one in enumerate(study.support):
        for key in ("spring", "preload", "pair_spring"):
            force = getattr(one, key) or 0.0
            if 0.0 < axial < 2.0 * force and force < 2.0 * axial:
                return support_field(study, place, key), force, ""
    rating = LoadRatings.of(bearing_of(study, k).tables.internals).static
    told = f"{numeral(hypot(*load[:3]))} N"
    return f"support.{study.names[k]}", told, f"; its static rating is {numeral(rating)} N"


def require_machine(study: Study) -> None:
    """Raise `InputError`, by the entry of the file, for a machine that is none or has films beyond the atlas."""
    if study.shaft is not None:
        _require_films(study)
    else:
        load, tilt = load_alone(study), tilt_of(study.operation)
        carrier = carrier_of(study, 0)
        with called("support."), loaded(study):
            carrier.equilibrium(load, speed_rpm=study.speed_rpm, tilt=tilt)
    supply_and_heat(study.operation, "operation", study.lubricant)
    _require_in_time(study)
    for k in range(len(study.defect)):
        spall_in(study, k)


def _require_films(study: Study) -> None:
    """Raise `InputError` for a machine without a place of rest, or with loads beyond what films are known for."""
    loads = iter(study.loads_at_rest)
    for k in range(len(study.names)):
        carrier = carrier_of(study, k)
        for bearing in carrier.bearings if isinstance(carrier, BearingSet) else (carrier,):
            load = next(loads)
            try:
                bearing.equilibrium(load, speed_rpm=study.speed_rpm)
            except (InputError, ConvergenceError) as error:
                allowed = getattr(error, "allowed", f"loaded so that its balls are in balance ({error})")
                entry, carried, rating = _carried(study, k, load)
                raise InputError(entry, carried, allowed + rating) from None


def _require_in_time(study: Study) -> None:
    """Raise `InputError` for a machine that cannot be run in time on models of its bearings."""
    if study.in_time is None:
        return
    first, *others = study.support
    load = ring_load(study, 0)
    alike = all(
        one.model_copy(update={"name": None, "position_mm": None})
        == first.model_copy(update={"name": None, "position_mm": None})
        for one in others
    )
    if not alike or len(study.support) != 2 or load.size != len(PLANAR):
        allowed = "left out: it is for two bearings that are alike and carry no axial load"
        raise InputError("in_time", None, allowed)
    if len(study.disc) != 1 or not disc_of(study, 0).unbalance:
        raise InputError("disc.unbalance", None, "given, of one disc: what is run in time is its unbalance")
    bearing, steps = bearing_of(study, 0, oil=False), study.in_time.steps_per_revolution
    least = ceil(LEAST_STEPS * bearing.orders.bpfo_order)
    if steps < least:
        allowed = f"at least {least}, {LEAST_STEPS} while a ball passes"
        raise InputError("in_time.steps_per_revolution", steps, allowed)


def defect_field(study: Study, k: int, key: str) -> str:
    """Name of an entry of a defect, with its number where there are several."""
    return f"defect.{key}" if len(study.defect) == 1 else f"defect.{k + 1}.{key}"


def place_of(study: Study, defect: Defect, field: str) -> int:
    """Place in the file of the support that a defect is in."""
    return study.at if defect.support is None else study.index(defect.support, field)


def spall_in(study: Study, k: int) -> Spall:
    """A spall of a study.

    Raises
    ------
    InputError
        What is no spall, one that the bearing has no place for, or one beside a pair or a tilt.
    """
    one, field = study.defect[k], defect_field(study, k, "spall")
    place = place_of(study, one, defect_field(study, k, "support"))
    beside = {support_field(study, place, "pair"): study.support[place].pair}
    beside |= {f"operation.{name}": getattr(study.operation, name) for name in ("tilt_x_mrad", "tilt_y_mrad")}
    for name, value in beside.items():
        if value is not None:
            raise InputError(field, one.spall, f"left out beside {name}")
    try:
        found = spall_of(one.spall)
    except InputError as error:
        raise InputError(field, one.spall, error.allowed) from None
    require_fit(found, bearing_of(study, place, oil=False), field, one.spall)
    return found
