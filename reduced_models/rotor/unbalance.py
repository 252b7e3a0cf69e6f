"""`unbalance_response`: amplitudes of a rotor under its unbalances, over the speed of the shaft.

The response at one speed is computed by `linearise`; here it is called at every speed.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, parts, require_positive
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.rotor.linearise import LinearRotor, linearise
from reduced_models.rotor.modes import UNDAMPED, RotorMode
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.unbalance_result import UnbalanceResponse

ROUND, POINTS = 1e-5, 8  # radius of a circle about an eigenvalue, over its size, and points on it


@takes(rotor=Object(Rotor, "a Rotor"), speeds_rpm=parts.SPEEDS)
def unbalance_response(
    rotor: Rotor, speeds_rpm: ArrayLike, *, passage: bool = True, signed_damping: bool = False
) -> UnbalanceResponse:
    """Steady response of a rotor to its unbalances at increasing speeds, each with the films of that speed.

    The response is computed only at the given speeds. A peak is about decrement/pi of its speed wide, for films
    and steel often less than a thousandth, so choose closely spaced speeds around those of
    `Campbell.critical_speeds`.

    Parameters
    ----------
    rotor : Rotor
    speeds_rpm : array_like, shape (k,)
        In rev/min, > 0.
    passage, signed_damping : bool
        Ball bearings as means over a ball passage, and with the signed damping of solved contacts, as in
        `linearise`.

    Raises
    ------
    InputError
        A rotor without unbalance, a speed that a bearing does not take.
    """
    speeds = as_column("speeds_rpm", speeds_rpm, increasing=True)
    if not rotor.unbalances:
        raise InputError("unbalances", (), "at least one Unbalance")
    if speeds[0] <= 0.0:
        raise InputError("speeds_rpm[0]", float(speeds[0]), "> 0")
    linear = [linearise(rotor, s, passage=passage, signed_damping=signed_damping) for s in speeds.tolist()]
    return response_of(rotor, linear)


@takes(mass=parts.MASS, speed_rpm=parts.SPEED)
def grade_unbalance(grade_mm_s: float, mass: float, speed_rpm: float) -> float:
    """Permissible residual unbalance [kg m] of a mass at a balance quality grade of ISO 21940-11.

    The grade is the product of permissible eccentricity and angular speed: G 2.5 is 2.5 mm/s.

    Parameters
    ----------
    grade_mm_s : float
        Grade [mm/s], > 0.
    mass : float
        Of the rotor, or of the part of it that the unbalance is of [kg].
    speed_rpm : float
        Highest speed in service [rev/min].

    Raises
    ------
    InputError
        A grade, a mass or a speed that is not above 0.
    """
    grade = require_positive("grade_mm_s", grade_mm_s)
    mass, speed = require_positive("mass", mass), require_positive("speed_rpm", speed_rpm)
    return 1e-3 * grade * mass / (speed * RPM_TO_RAD_S)


def response_of(rotor: Rotor, linear: Sequence[LinearRotor]) -> UnbalanceResponse:
    """The response of a rotor with unbalances that is linearised at increasing speeds above 0."""
    amplitudes = [one._unbalanced(one.speed_rpm * RPM_TO_RAD_S) for one in linear]
    return UnbalanceResponse.of(rotor, np.array([one.speed_rpm for one in linear]), np.array(amplitudes))


def amplification(linear: LinearRotor, mode: RotorMode) -> float:
    """Resonance of a mode over the rest of the response to unbalance at the frequency of the mode.

    Near an eigenvalue s0 the response T(s)^-1 f to the unbalances f is R/(s - s0) and what all other modes have,
    the means over a circle about s0 of (s - s0) and of 1 times the response. R is the shape of the mode times the
    work of f on its left vector: 0 of a mode that f does not excite, as one that whirls backward on supports alike
    in x and y, or one along the shaft that nothing couples to x and y. Both are compared by their largest orbits.
    A damping ratio below `modes.UNDAMPED` counts as that: such a mode has damping that the rotor leaves out.

    Parameters
    ----------
    linear : LinearRotor
        Without unbalances: with equal ones at all of its nodes.
    mode : RotorMode
        Of `linear`.
    """
    rotor, s = linear.rotor, mode.eigenvalue
    force = rotor.turning_unbalance if rotor.unbalances else _everywhere(rotor)
    steps = ROUND * abs(s) * np.exp(2j * np.pi * np.arange(POINTS) / POINTS)
    around = np.array([np.linalg.solve(linear.dynamic_stiffness(s + step), force) for step in steps.tolist()])
    rest, residue = around.mean(axis=0), (steps[:, None] * around).mean(axis=0)
    own = residue / max(abs(s.real), UNDAMPED * abs(s))
    sizes = UnbalanceResponse.of(rotor, np.ones(2), np.array([own, rest])).major.max(axis=1)
    return float(sizes[0] / sizes[1]) if sizes[1] > 0.0 else 0.0


def _everywhere(rotor: Rotor) -> NDArray[np.complex128]:
    """Amplitudes of a force that turns with the shaft, at every node that moves across it."""
    force = np.zeros(rotor.size, complex)
    for places in rotor.nodes.values():
        if "x" in places and "y" in places:
            force[[places["x"], places["y"]]] += 1.0, -1j
    return force
