"""`jeffcott_rotor`: a disc on a shaft between bearings of contacts, as `Rotor`. SI units.

Four degrees of freedom: disc (x, y) and journal (x, y), y upwards. Both bearings are taken as identical and
move as one, so one journal stands for both: its mass is that of the two journals, and the contacts of one
bearing push on it ``bearings`` times.

    m_d q_d'' + d_d q_d' + c_s (q_d' - q_j') + k_s (q_d - q_j) = m_d g + W + m_e omega^2 (cos, sin)(omega t)
    m_j q_j'' - c_s (q_d' - q_j') - k_s (q_d - q_j)            = m_j g - bearings sum_i F_i n_i
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import (
    as_column,
    parts,
    require_choice,
    require_integer,
    require_nonnegative,
    require_positive,
)
from ehlcontact.checks.kinds import Count, Objects
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.point import Point
from reduced_models.rotor.nodes import PLANE
from reduced_models.rotor.rotor import Parameter, Rotor, Unbalance, require_unbalance
from reduced_models.rotor.supports import ContactMount

_Floats = NDArray[np.float64]

DOWN = -pi / 2.0  # direction of gravity [rad]
DISC, JOURNAL = np.diag([1.0, 0.0]), np.diag([0.0, 1.0])
BETWEEN = np.array([[1.0, -1.0], [-1.0, 1.0]])


@takes(
    disc_mass=parts.MASS, journal_mass=parts.MASS, shaft_stiffness=parts.SHAFT_STIFFNESS,
    shaft_damping=parts.DAMPING, disc_damping=parts.DAMPING, unbalance=parts.UNBALANCE, speed_rpm="rev/min",
    gravity=parts.GRAVITY, load=parts.FORCE, bearings=Count(1, 1000),
    mounts=Objects(ContactMount, "a ContactMount"), half_angle="rad", offset=parts.APPROACH,
)  # fmt: skip
def jeffcott_rotor(
    *,
    disc_mass: float,
    journal_mass: float,
    shaft_stiffness: float,
    shaft_damping: float = 0.0,
    disc_damping: float = 0.0,
    unbalance: float = 0.0,
    speed_rpm: float = 0.0,
    gravity: Sequence[float] = (0.0, -9.81),
    load: Sequence[float] = (0.0, 0.0),
    bearings: int = 2,
    mounts: Sequence[ContactMount] | None = None,
    half_angle: float | None = None,
    offset: float = 0.0,
    point: Point | None = None,
    directions: str | None = None,
) -> Rotor:
    """Jeffcott rotor on contacts, after the equations at the head of this module.

    Its contacts are those of `mounts`, two at +-`half_angle` from straight below, like two balls of a bearing, or
    one straight below. Elements, films or impedances are given with the mounts, or by `Rotor.on`. On ball
    bearings, with a disc anywhere, gyroscopic moments or housings: `rotor_on_bearings`.

    Parameters
    ----------
    disc_mass, journal_mass : float
        Of the disc, and of both journals together [kg].
    shaft_stiffness, shaft_damping : float
        Between disc and journal [N/m], [N s/m]; the damping acts in the fixed frame (external).
    disc_damping : float
        From the disc to the ground [N s/m].
    unbalance : float
        Mass times eccentricity of the disc [kg m].
    speed_rpm : float
        At which it runs unless another speed is given [rev/min].
    gravity : (float, float)
        Acceleration [m/s^2].
    load : (float, float)
        Constant force on the disc [N], to bring the contacts to the load they were reduced at.
    bearings : int
        How many identical bearings carry the rotor.
    mounts : sequence of ContactMount, optional
        Contacts of one bearing; their degrees of freedom and number are set here.
    half_angle : float, optional
        Of a vee of two contacts [rad], between 0 and pi/2.
    offset, point : optional
        Without `mounts`: approach with the journal at the origin [m], and the contact, as for `ContactMount`.
    directions : {"xy", "y"}, optional
        With "y", disc and journal move in y only: the default on one contact straight below.

    Returns
    -------
    Rotor
        With the nodes "disc" and "journal", one `Unbalance`, and masses, stiffness and dampers as `parameters`.

    Raises
    ------
    InputError
        A value outside its range; the message names it.
    """
    values = {"disc_mass": disc_mass, "journal_mass": journal_mass, "shaft_stiffness": shaft_stiffness}
    for name, value in values.items():
        require_positive(name, value)
    dampers = {"shaft_damping": shaft_damping, "disc_damping": disc_damping}
    for name, value in (dampers | {"unbalance": unbalance, "speed_rpm": speed_rpm}).items():
        require_nonnegative(name, value)
    require_unbalance("unbalance", unbalance, disc_mass)
    pull, push = (as_column(name, of, size=2) for name, of in (("gravity", gravity), ("load", load)))
    count = require_integer("bearings", bearings, "a whole number >= 1", 1)
    moving = ("y" if mounts is None and half_angle is None else "xy") if directions is None else directions
    axes = [PLANE.index(name) for name in require_choice("directions", moving, ("xy", "y"))]
    disc, journal = ({PLANE[axis]: k * len(axes) + i for i, axis in enumerate(axes)} for k in range(2))
    parameters = _parameters(values | dampers, pull[axes])
    mass, damping, stiffness, weight = (
        np.sum([own.value * own.parts[of] for own in parameters if of in own.parts], axis=0)
        for of in ("mass", "damping", "stiffness", "load")
    )
    return Rotor(
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        mounts=tuple(
            replace(mount, x=journal.get("x"), y=journal.get("y"), count=count)
            for mount in _mounts(mounts, half_angle, offset, point)
        ),
        load=weight + np.append(push[axes], np.zeros(len(axes))),
        unbalances=(Unbalance(x=disc.get("x"), y=disc.get("y"), amount=unbalance),),
        nodes={"disc": disc, "journal": journal},
        speed_rpm=speed_rpm,
        parameters=parameters,
    )


def _mounts(
    mounts: Sequence[ContactMount] | None, half_angle: float | None, offset: float, point: Point | None
) -> Sequence[ContactMount]:
    """Contacts of one bearing."""
    if mounts is not None:
        if half_angle is not None:
            raise InputError("half_angle", half_angle, "left out where mounts are given")
        if len(mounts) == 0:
            raise InputError("mounts", mounts, "at least one ContactMount")
        return mounts
    if half_angle is None:
        return (ContactMount(DOWN, offset, point),)
    if not 0.0 < require_positive("half_angle", half_angle) < pi / 2.0:
        raise InputError("half_angle", half_angle, "between 0 and pi/2")
    return tuple(ContactMount(DOWN + angle, offset, point) for angle in (-half_angle, half_angle))


def _parameters(values: dict[str, float], gravity: _Floats) -> tuple[Parameter, ...]:
    """Masses, stiffness and dampers with the matrices that they are factors of; order: disc, then journal."""

    def both(part: _Floats) -> _Floats:
        return np.asarray(np.kron(part, np.eye(gravity.size)), np.float64)

    def of_mass(body: _Floats) -> dict[str, _Floats]:
        return {"mass": both(body), "load": np.asarray(np.kron(np.diag(body), gravity), np.float64)}

    rows: tuple[tuple[str, str, str, dict[str, _Floats], bool], ...] = (
        ("disc_mass", "kg", "Mass of the disc", of_mass(DISC), True),
        ("journal_mass", "kg", "Mass of both journals", of_mass(JOURNAL), True),
        ("shaft_stiffness", "N/m", "Stiffness between disc and journal", {"stiffness": both(BETWEEN)}, True),
        ("shaft_damping", "N.s/m", "Damping between disc and journal", {"damping": both(BETWEEN)}, False),
        ("disc_damping", "N.s/m", "Damping from the disc to the ground", {"damping": both(DISC)}, False),
    )
    return tuple(
        Parameter(name=name, unit=unit, text=text, value=float(values[name]), parts=parts, positive=positive)
        for name, unit, text, parts, positive in rows
    )
