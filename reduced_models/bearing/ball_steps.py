"""Time steps of the balls of a bearing, planar (`balls`) or at contact angles (`angular_steps`), by one interface.

In compiled code the kind is that of the parameters, `Balls` or `AngularBalls`; there is no cost at run time.
"""

from __future__ import annotations

from typing import Any

from numba.extending import overload

from reduced_models.bearing.angular_balls import AngularBalls
from reduced_models.bearing.angular_steps import accept_angular, begin_angular_step, press_angular
from reduced_models.bearing.balls import (
    accept_balls,
    begin_step,
    directions,
    press_balls,
    speed_state,
    turn_planar,
)

# Inlined, as `press_balls` is: a call hands over every array of a bearing, a sixth of the time of dry steps
_COMPILED: Any = {"jit_options": {"error_model": "numpy", "_nrt": False, "forceinline": True}}


def begin_balls(balls, films, normals, omega, angle, dt):
    """Begin a step of `dt`, at whose end the shaft turns at `omega` and the first planar ball is at `angle`.

    `normals`, shape (balls, 2), gets the directions of planar balls; others turn with the cage of their `films`.
    """
    kind = _begin_angular if isinstance(balls, AngularBalls) else _begin_planar
    kind(balls, films, normals, omega, angle, dt)


def press(balls, films, normals, omega, q, v, gain, out):
    """Force of the ring at `q`, moving at `v`, on the balls, and its derivatives by both, written into `out`."""
    kind = _press_angular if isinstance(balls, AngularBalls) else _press_planar
    kind(balls, films, normals, omega, q, v, gain, out)


def accept(balls, films, normals, omega, q, v, gain):
    """Move balls and films to the end of the step, with the ring where `press` was called last."""
    kind = _accept_angular if isinstance(balls, AngularBalls) else _accept_planar
    kind(balls, films, normals, omega, q, v, gain)


def _begin_planar(balls, films, normals, omega, angle, dt):
    directions(balls, angle, normals)
    turn_planar(balls, angle, films, 1.5 / dt)
    begin_step(balls, speed_state(balls, omega), dt, films)


def _begin_angular(balls, films, normals, omega, angle, dt):
    begin_angular_step(balls, omega, dt, films)


def _press_planar(balls, films, normals, omega, q, v, gain, out):
    press_balls(balls, speed_state(balls, omega), films, normals, q, v, gain, out)


def _press_angular(balls, films, normals, omega, q, v, gain, out):
    press_angular(balls, films, q, v, gain, out)


def _accept_planar(balls, films, normals, omega, q, v, gain):
    accept_balls(balls, speed_state(balls, omega), films, normals, q, v, gain)


def _accept_angular(balls, films, normals, omega, q, v, gain):
    accept_angular(balls, films, gain)


def _at_angles(balls: Any) -> bool:
    """Whether a type of numba is that of `AngularBalls`."""
    return "grooves" in balls.fields


@overload(begin_balls, **_COMPILED)
def _begin_compiled(balls, films, normals, omega, angle, dt):
    return _begin_angular if _at_angles(balls) else _begin_planar


@overload(press, **_COMPILED)
def _press_compiled(balls, films, normals, omega, q, v, gain, out):
    return _press_angular if _at_angles(balls) else _press_planar


@overload(accept, **_COMPILED)
def _accept_compiled(balls, films, normals, omega, q, v, gain):
    return _accept_angular if _at_angles(balls) else _accept_planar
