"""Rotors on ball bearings as systems of python-control: forces on degrees of freedom in, displacements out.

States are differences from rest in um (um/s, urad), the films' memory among them, and their start is 0: so the
absolute tolerance of python-control's solvers, 1e-6, is a picometre. Films are fast: of the solvers, take one
for stiff equations (``solve_ivp_method="BDF"``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_instance, require_integer, require_nonnegative
from ehlcontact.errors import InputError
from reduced_models.bearing.ball_states import PER_METRE, bearing_system
from reduced_models.bearing.balls import (
    POSITION,
    Balls,
    SpeedState,
    begin_rest,
    directions,
    films_of,
    press_balls,
    speed_state,
)
from reduced_models.bearing.continuous_time import bearing_rates
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.elements.film_filters import DIRECT
from reduced_models.elements.small_motion import FILTERS
from reduced_models.rotor.linear_system import rotor_system
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.supports import BearingMount

_Floats = NDArray[np.float64]

Signals = Mapping[str, int] | Sequence[int] | None

UNIT = 1e-6  # m, of the states


def rings_of(rotor: Rotor) -> _Floats:
    """Motions of the rings of ball bearings, shape (2 bearings, N); `InputError` for a rotor on contacts."""
    if rotor.contacts:
        raise InputError("mounts", "with contacts", "ball bearings or linear bearings, for python-control")
    return rotor.geometry.points


def linear_block(
    rotor: Rotor, omega: float, about: Sequence[Any], inputs: Signals, outputs: Signals, name: str
) -> Any:
    """`LinearRotor.to_control`: of a rotor at a speed [rad/s], `about` what it finds in its ball bearings."""
    import control

    _require_planar(rotor)
    size = rotor.size
    ins, outs = _signals("inputs", inputs, "F", size), _signals("outputs", outputs, "q", size)
    A, driven = rotor_system(rotor.matrices(omega), rings_of(rotor), [bearing_system(balls) for balls in about])
    C = np.zeros((len(outs), len(A)))
    C[range(len(outs)), list(outs.values())] = UNIT
    shapes = []
    for b in about:
        inner, outer = (0 if c.rates is None else c.rates.lags for c in (b.inner, b.outer))
        shapes.append(_Shape(len(b.normals), inner, outer, b.loss.gains.size, b.inertia))
    return control.ss(
        A,
        driven[:, list(ins.values())] / UNIT,
        C,
        0.0,
        inputs=list(ins),
        outputs=list(outs),
        states=_states(size, shapes),
        name=name,
    )


def _require_planar(rotor: Rotor) -> None:
    if any(mount.z is not None for mount in rotor.ball_bearings):
        allowed = "planar ones, without z, tilt_x and tilt_y, in a block of python-control"
        raise InputError("ball bearings", "with five degrees of freedom", allowed)


def rotor_to_control(
    rotor: Rotor,
    speed_rpm: float,
    *,
    inputs: Signals = None,
    outputs: Signals = None,
    cage_turns: bool = True,
    name: str = "rotor",
) -> Any:
    """Rotor on ball bearings as one nonlinear python-control system, in continuous time.

    Forces in and displacements out are differences from rest under the rotor's own load: with no input and the
    cage held, it stays at 0. States: see `reduced_models.rotor.control`.

    Parameters
    ----------
    rotor : Rotor
        Its unbalances are not in it: they are forces, to be put in.
    speed_rpm : float
        Of the shaft.
    inputs, outputs : mapping of str to int, or sequence of int, optional
        Degrees of freedom by name; without names they are F0, F1, ... [N] and q0, q1, ... [m]. By default all.
    cage_turns : bool
        Whether balls go round with the cage as time goes on; they start at the angles of the mounts.
    name : str
        Of the system.

    Raises
    ------
    InputError
        A degree of freedom that is not there, a speed that a bearing does not take.
    """
    import control

    require_instance("rotor", rotor, Rotor, "a Rotor")
    _require_planar(rotor)
    ins, outs = _signals("inputs", inputs, "F", rotor.size), _signals("outputs", outputs, "q", rotor.size)
    motion = _Motion(rotor, require_nonnegative("speed_rpm", speed_rpm), cage_turns)
    pushed, seen = list(ins.values()), list(outs.values())

    def update(t: float, x: _Floats, u: _Floats, params: object) -> _Floats:
        force = np.zeros(rotor.size)
        np.add.at(force, pushed, u)
        return motion.rates(t, np.asarray(x, float) * UNIT, force) / UNIT

    def output(t: float, x: _Floats, u: _Floats, params: object) -> _Floats:
        return np.asarray(x, float)[seen] * UNIT

    states = _states(rotor.size, [ring.shape for ring in motion.rings])
    return control.nlsys(update, output, inputs=list(ins), outputs=list(outs), states=states, name=name)


def _signals(field: str, given: Signals, letter: str, size: int) -> dict[str, int]:
    chosen = range(size) if given is None else given
    named = dict(chosen) if isinstance(chosen, Mapping) else {f"{letter}{one}": one for one in chosen}
    allowed = f"degrees of freedom from 0 to {size - 1}, each once"
    if not named or (not isinstance(chosen, Mapping) and len(named) != len(chosen)):
        raise InputError(field, given, allowed)
    for name, value in named.items():
        if require_integer(f"{field}[{name!r}]", value, allowed, 0) >= size:
            raise InputError(f"{field}[{name!r}]", value, allowed)
    return named


class _Shape(NamedTuple):
    """How many states a bearing has: its balls, lags of both films (none: dry), filters of its seat."""

    balls: int
    inner: int
    outer: int
    seat: int
    inertia: float  # of a ball

    @property
    def own(self) -> int:
        """States of a ball's own place."""
        return 2 if self.inertia else int(self.inner > 0)

    @property
    def of_balls(self) -> int:
        """States of all balls."""
        return self.balls * (self.own + sum(lags + FILTERS for lags in (self.inner, self.outer) if lags))


def _states(size: int, bearings: Sequence[_Shape]) -> list[str]:
    """Names, in order."""
    names = [f"q{k}" for k in range(size)] + [f"v{k}" for k in range(size)]
    for b, shape in enumerate(bearings):
        for k in range(shape.balls):
            names += [f"b{b}_{k}_{one}" for one in ("w", "v")[: shape.own]]
            for race, count in zip(("i", "o"), (shape.inner, shape.outer), strict=True):
                lags = [f"q{j}" for j in range(1, count + 1)]
                names += [f"b{b}_{k}_{race}_{one}" for one in (("s", "y", *lags) if count else ())]
        names += [f"b{b}_seat_{one}{k}" for k in range(1, shape.seat + 1) for one in "xy"]
    return names


class _Ring:
    """One bearing: its balls about rest, with the ring at `r`."""

    def __init__(self, mount: BearingMount, speed: float, r: _Floats, cage_turns: bool) -> None:
        bearing, angle = mount.ball_bearing, mount.cage_angle
        held = bearing._static_balls(bearing.speed(speed), angle)
        self.balls: Balls = held.balls
        laws: SpeedState = speed_state(self.balls, speed * RPM_TO_RAD_S)
        self._at_speed = laws if cage_turns else laws._replace(cage=0.0)
        self._angle, self._normals = angle, np.zeros((self.balls.number, 2))
        self.force = held.force(r)
        races = self.balls.inner, self.balls.outer
        inner, outer = (law.gains.shape[2] - DIRECT if law.x.size else 0 for law in races)
        self.shape = _Shape(self.balls.number, inner, outer, self.balls.loss.gains.size, self.balls.inertia)
        self.films = self.shape.of_balls
        self.rest = np.concatenate([np.zeros(self.films), np.tile(self.force / PER_METRE, self.shape.seat)])
        if self.films:
            self.rest[: self.films : self.films // self.balls.number] = held.films.balls[:, POSITION]
        self._films, self._force = films_of(self.balls), np.zeros(2)
        begin_rest(self._films)

    def rates(self, t: float, x: _Floats, r: _Floats, v: _Floats) -> tuple[_Floats, _Floats]:
        """Rates of the states `x`, which are differences from rest; force of the ring on the balls."""
        directions(self.balls, self._angle + self._at_speed.cage * t, self._normals)
        states, rates = self.rest + x, np.zeros(x.size)
        if self.films:
            bearing_rates(self.balls, self._at_speed, self._normals, states, r, v, rates, self._force)
        else:
            out = self._force, np.zeros((2, 2)), np.zeros((2, 2))
            press_balls(self.balls, self._at_speed, self._films, self._normals, r, v, 0.0, out)
        gains, poles = self.balls.loss
        lost = self._force - PER_METRE * states[self.films :].reshape(-1, 2)
        rates[self.films :] = (poles[:, None] * lost).ravel() / PER_METRE
        return rates, self._force + gains @ lost


class _Motion:
    """Rates of all states, which are differences from rest [m]."""

    def __init__(self, rotor: Rotor, speed: float, cage_turns: bool) -> None:
        self._rest, self._to_rings = rotor.equilibrium(speed), rings_of(rotor)
        self._r = self._to_rings @ self._rest
        self._size = rotor.size
        self._inverse = np.linalg.inv(rotor.mass)
        _, self._damping, self._stiffness = rotor.matrices(speed * np.pi / 30.0)
        self.rings = [
            _Ring(mount, speed, self._r[2 * b : 2 * b + 2], cage_turns)
            for b, mount in enumerate(rotor.ball_bearings)
        ]

    def rates(self, t: float, x: _Floats, force: _Floats) -> _Floats:
        """Of q, q' and the states of the bearings, under a force beside the load [N]."""
        size, out = self._size, np.empty(x.size)
        q, v = x[:size], x[size : 2 * size]
        r, r_rate = self._r + self._to_rings @ q, self._to_rings @ v
        net = force - self._damping @ v - self._stiffness @ q
        at = 2 * size
        for b, ring in enumerate(self.rings):
            here, pair = slice(at, at + ring.rest.size), slice(2 * b, 2 * b + 2)
            out[here], pushed = ring.rates(t, x[here], r[pair], r_rate[pair])
            net -= self._to_rings[pair].T @ (pushed - ring.force)
            at = here.stop
        out[:size], out[size : 2 * size] = v, self._inverse @ net
        return out
